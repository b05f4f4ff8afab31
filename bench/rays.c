/* SPDX-License-Identifier: MIT
 * glint-bench-rays: how many rays a second do the kernels trace, and how many does Embree? One
 * thread, the rays alone: no reading, no shading, no writing. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "glint/glint.h"
#include "machine.h"
#include "message.h"
#include "rays_contest.h"
#include "rays_embree.h"
#include "rays_report.h"
#include "table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require_isa(const char *isa) {
    const char *known;
    if (isa == NULL) return;
    for (int i = 0; (known = glint_isa_name(i)) != NULL; i++) {
        if (strcmp(known, isa) == 0) return;
    }
    message_fail("this machine has no '%s'", isa);
}

/* Where the numbers go: all into the file of --csv, with those of other scenes into that of
 * --results. */
static void save(const RaysOptions *options, const char *isa, const char *rows) {
    char machine[256], name[256], head[512], path[4096];
    machine_describe(machine, sizeof machine);
    message_format(head, sizeof head, "%s; kernels %s; %s", machine, isa, embree_version());
    if (options->csv != NULL) table_save(options->csv, head, rows, false);
    if (options->results == NULL) return;
    machine_file_name(name, sizeof name);
    message_format(path, sizeof path, "%s/%s-rays.csv", options->results, name);
    table_save(path, head, rows, true);
    printf("the numbers are in %s\n", path);
}

int main(int argc, char **argv) {
    message_program = "glint-bench-rays";
    RaysOptions options = rays_options_parse(argc, argv);
    require_isa(options.isa);
    char machine[512], date[DATE_SIZE], *rows = NULL;
    machine_describe(machine, sizeof machine);
    table_date(date);
    const char *isa = options.isa != NULL ? options.isa : glint_isa_name(0);
    printf("%s; kernels %s\n%s\n", machine, isa, embree_version());
    size_t size;
    FILE *csv = open_memstream(&rows, &size);
    if (csv == NULL) message_fail("not enough memory");
    rays_report_csv_head(csv);
    rays_report_head();
    int fault_count = 0;
    const char *names = options.scenes;
    while (*names != '\0') {
        char name[4096];
        size_t length = strcspn(names, ",");
        message_format(name, sizeof name, "%.*s", (int)length, names);
        names += length + (names[length] == ',');
        RaysResult result;
        rays_contest(&options, name, &result);
        fault_count += rays_report(&result);
        rays_report_csv(&result, date, csv);
    }
    if (fclose(csv) != 0) message_fail("not enough memory");
    save(&options, isa, rows);
    free(rows);
    return fault_count > 0 ? 3 : 0;
}
