/* SPDX-License-Identifier: MIT
 * glint-bench: how fast is glint, from start to exit, and how fast are its peers on the same
 * scenes? The scenes come from samples/ and are kept in the folder bench-scenes beside this
 * program. While it measures, it checks that every run draws the same picture. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "contest.h"
#include "machine.h"
#include "message.h"
#include "noise.h"
#include "options.h"
#include "page.h"
#include "picture.h"
#include "process.h"
#include "report.h"
#include "table.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The folder that this program lies in. */
static void own_folder(const char *name, char folder[PATH_SIZE]) {
    char path[PATH_SIZE];
    if (strchr(name, '/') != NULL) {
        message_format(path, sizeof path, "%s", name);
    } else if (!process_find(name, path, sizeof path)) {
        message_fail("where am I?");
    }
    char *slash = strrchr(path, '/');
    *slash = '\0';
    char *whole = realpath(slash == path ? "/" : path, NULL);
    if (whole == NULL) message_fail("where am I?");
    message_format(folder, PATH_SIZE, "%s", whole);
    free(whole);
}

static void require(const char *path) {
    if (access(path, X_OK) != 0) message_fail("%s is not a program", path);
}

static void find_programs(const Options *options, const char *folder, Field *field) {
    char(*paths)[PATH_SIZE] = field->paths;
    if (options->glint != NULL) {
        message_format(paths[PROGRAM_GLINT], PATH_SIZE, "%s", options->glint);
    } else {
        message_format(paths[PROGRAM_GLINT], PATH_SIZE, "%s/glint", folder);
    }
    require(paths[PROGRAM_GLINT]);
    if (options->against != NULL) {
        message_format(paths[PROGRAM_OTHER_GLINT], PATH_SIZE, "%s", options->against);
        require(paths[PROGRAM_OTHER_GLINT]);
        return; /* the question is another one, and peers would make the answer late */
    }
    if (options->alone) return;
    if (!process_find("tachyon", paths[PROGRAM_TACHYON], PATH_SIZE)) {
        paths[PROGRAM_TACHYON][0] = '\0';
        puts("Tachyon is not installed: no comparison with it");
    }
    if (!process_find("povray", paths[PROGRAM_POVRAY_BM1], PATH_SIZE)) {
        paths[PROGRAM_POVRAY_BM1][0] = '\0';
        puts("POV-Ray is not installed: no comparison with it");
    }
    memcpy(paths[PROGRAM_POVRAY_BM2], paths[PROGRAM_POVRAY_BM1], PATH_SIZE);
}

static void report_details(const Contest *contests, int count, const EncodeResult *encode) {
    putchar('\n');
    for (int i = 0; i < count; i++) {
        if (contests[i].scene.sample.kind != SAMPLE_TINY) continue;
        const Spread *wall = &contests[i].entries[PROGRAM_GLINT][0].spreads[MEASURE_WALL];
        printf("tiny scene, start to exit: %.2f ms (%.2f-%.2f)\n", 1e3 * wall->median,
            1e3 * wall->least, 1e3 * wall->most);
    }
    printf("PNG of %d x %d on one core: %.2f ms (%.2f-%.2f), %.0f kB\n", ENCODE_EDGE, ENCODE_EDGE,
        1e3 * encode->seconds.median, 1e3 * encode->seconds.least, 1e3 * encode->seconds.most,
        1e-3 * (double)encode->size);
}

static void save(
    const Options *options, const Contest *contests, int count, const EncodeResult *encode) {
    char machine[256], name[256], date[DATE_SIZE], path[PATH_SIZE], *rows = NULL;
    size_t size;
    FILE *file = open_memstream(&rows, &size);
    if (file == NULL) message_fail("not enough memory");
    table_date(date);
    report_csv(contests, count, encode, date, file);
    if (fclose(file) != 0) message_fail("not enough memory");
    machine_describe(machine, sizeof machine);
    if (options->csv != NULL) table_save(options->csv, machine, rows, false);
    if (options->results != NULL) {
        machine_file_name(name, sizeof name);
        message_format(path, sizeof path, "%s/%s.csv", options->results, name);
        table_save(path, machine, rows, true);
        printf("the numbers are in %s\n", path);
    }
    free(rows);
}

/* To the terminal: what is measured may be piped elsewhere. */
static void tell_progress(const BenchScene *scene, int index, int count, double start) {
    int seconds = (int)(process_seconds() - start);
    fprintf(stderr, "glint-bench: %s, %d of %d, after %d:%02d minutes\n", scene->name, index + 1,
        count, seconds / 60, seconds % 60);
}

int main(int argc, char **argv) {
    static Field field;
    static BenchScene scenes[SCENE_MAX];
    Options options = options_parse(argc, argv);
    if (options.only_page) {
        page_write(options.results, options.page);
        return 0;
    }
    int count = scenes_parse(options.scenes, options.edge, scenes);
    Contest *contests = calloc((size_t)count, sizeof contests[0]);
    if (contests == NULL) message_fail("not enough memory");

    char text[PATH_SIZE], folder[PATH_SIZE];
    machine_describe(text, sizeof text);
    puts(text);
    own_folder(argv[0], folder);
    message_format(field.cache, PATH_SIZE, "%s/bench-scenes", folder);
    if (mkdir(field.cache, 0777) != 0 && errno != EEXIST) {
        message_fail("%s cannot be made", field.cache);
    }
    if (options.noise) {
        noise_run(field.cache, options.results, options.pictures);
        free(contests);
        return 0;
    }
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    field.rep_count = options.rep_count;
    field.threads_most = options.threads_most > 0 ? options.threads_most : (int)cores;
    find_programs(&options, folder, &field);

    int fault_count = 0, slower_count = 0;
    double start = process_seconds();
    for (int i = 0; i < count; i++) {
        tell_progress(&scenes[i], i, count, start);
        contest_run(&field, &scenes[i], &contests[i]);
        report_scene(&contests[i]);
        fault_count += contests[i].fault_count;
        slower_count += contests[i].slower_count;
    }
    if (count > 1) report_summary(contests, count);
    EncodeResult encode = picture_encode(options.rep_count);
    report_details(contests, count, &encode);

    save(&options, contests, count, &encode);
    if (options.results != NULL && options.page != NULL) page_write(options.results, options.page);
    free(contests);
    if (fault_count > 0) message_fail("%d wrong pictures, see above", fault_count);
    if (slower_count > 0) printf("slower than the other glint in %d cases\n", slower_count);
    return slower_count > 0 ? 3 : 0;
}
