/* SPDX-License-Identifier: MIT
 * glint-bench-rays: how many rays a second do the kernels trace, and how many does Embree? One
 * thread, the rays alone: no reading, no shading, no writing. */
#include "glint/glint.h"
#include "machine.h"
#include "message.h"
#include "rays_contest.h"
#include "rays_embree.h"
#include "rays_report.h"

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

static FILE *open_csv(const char *path, const char *isa) {
    if (path == NULL) return NULL;
    FILE *file = fopen(path, "w");
    if (file == NULL) message_fail("%s cannot be written", path);
    char machine[512];
    machine_describe(machine, sizeof machine);
    fprintf(file, "# %s; kernels %s; %s\n", machine, isa, embree_version());
    rays_report_csv_head(file);
    return file;
}

int main(int argc, char **argv) {
    message_program = "glint-bench-rays";
    RaysOptions options = rays_options_parse(argc, argv);
    require_isa(options.isa);
    char machine[512];
    machine_describe(machine, sizeof machine);
    const char *isa = options.isa != NULL ? options.isa : glint_isa_name(0);
    printf("%s; kernels %s\n%s\n", machine, isa, embree_version());
    FILE *csv = open_csv(options.csv, isa);
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
        if (csv != NULL) rays_report_csv(&result, csv);
    }
    if (csv != NULL) {
        bool good = !ferror(csv);
        if (fclose(csv) != 0 || !good) message_fail("%s cannot be written", options.csv);
    }
    return fault_count > 0 ? 3 : 0;
}
