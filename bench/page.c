/* SPDX-License-Identifier: MIT
 * A section for each machine, by the name of its file. What the page says beside numbers, above all
 * where Glint does not win, follows from the numbers by fixed rules, so that nobody has to have the
 * heart to write it. */
#define _POSIX_C_SOURCE 200809L
#include "page.h"

#include "contest.h"
#include "message.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The columns, in the order of report_csv. */
typedef enum Column {
    COLUMN_SCENE,
    COLUMN_PROGRAM,
    COLUMN_THREADS,
    COLUMN_SURFACES,
    COLUMN_WIDTH,
    COLUMN_HEIGHT,
    COLUMN_RUNS,
    COLUMN_WALL,
    COLUMN_LEAST,
    COLUMN_MOST,
    COLUMN_CPU,
    COLUMN_PEAK,
    COLUMN_PEAK_EACH,
    COLUMN_TO_GLINT,
    COLUMN_ALLOCATED_EACH,
    COLUMN_READ,
    COLUMN_BUILD,
    COLUMN_TRACE,
    COLUMN_WRITE,
    COLUMN_READ_RATE,
    COLUMN_BUILD_RATE,
    COLUMN_TRACE_RATE,
    COLUMN_CAMERA_RATE,
    COLUMN_SHADOW_RATE,
    COLUMN_COUNT
} Column;

typedef struct Row {
    char scene[32], program[32];
    double numbers[COLUMN_COUNT]; /* 0: empty */
} Row;

enum { ROW_MAX = SCENE_MAX * PROGRAM_COUNT * THREADS_MAX + 1, MACHINE_MAX = 64 };

typedef struct Machine {
    char name[256];
    Row rows[ROW_MAX];
    int row_count;
} Machine;

static bool parse_row(char *line, Row *row) {
    memset(row, 0, sizeof *row);
    for (int column = 0; column < COLUMN_COUNT; column++) {
        size_t length = strcspn(line, ",\r\n");
        bool last = line[length] != ',';
        line[length] = '\0';
        if (column == COLUMN_SCENE) message_format(row->scene, sizeof row->scene, "%s", line);
        if (column == COLUMN_PROGRAM) message_format(row->program, sizeof row->program, "%s", line);
        row->numbers[column] = strtod(line, NULL);
        if (last) return column == COLUMN_COUNT - 1;
        line += length + 1;
    }
    return false;
}

/* False: not such a file. */
static bool read_machine(const char *path, Machine *machine) {
    FILE *file = fopen(path, "r");
    char line[1024];
    machine->row_count = 0;
    if (file == NULL) message_fail("%s cannot be read", path);
    bool good = fgets(line, sizeof line, file) != NULL && strncmp(line, "# ", 2) == 0;
    if (good) {
        line[strcspn(line, "\n")] = '\0';
        message_format(machine->name, sizeof machine->name, "%s", line + 2);
        good = fgets(line, sizeof line, file) != NULL; /* the heads of the columns */
    }
    while (good && machine->row_count < ROW_MAX && fgets(line, sizeof line, file) != NULL) {
        good = parse_row(line, &machine->rows[machine->row_count++]);
    }
    fclose(file);
    return good;
}

/* ---------------------------------------------------------------- questions */

static const Row *find(
    const Machine *machine, const char *scene, const char *program, int threads) {
    for (int i = 0; i < machine->row_count; i++) {
        const Row *row = &machine->rows[i];
        if (strcmp(row->scene, scene) == 0 && strcmp(row->program, program) == 0 &&
            (int)row->numbers[COLUMN_THREADS] == threads) {
            return row;
        }
    }
    return NULL;
}

enum { PEER_TACHYON, PEER_POVRAY, PEER_COUNT };
static const char *const peer_names[PEER_COUNT] = {"Tachyon", "POV-Ray"};

/* Of POV-Ray the faster of its two trees. Null: it did not run. */
static const Row *find_peer(const Machine *machine, const char *scene, int peer, int threads) {
    if (peer == PEER_TACHYON) return find(machine, scene, "tachyon", threads);
    const Row *one = find(machine, scene, "povray +BM1", threads);
    const Row *two = find(machine, scene, "povray +BM2", threads);
    if (one == NULL || two == NULL) return one != NULL ? one : two;
    return one->numbers[COLUMN_WALL] < two->numbers[COLUMN_WALL] ? one : two;
}

/* The rows that begin a scene: Glint's with one thread. */
static bool is_scene(const Row *row) {
    return strcmp(row->program, "glint") == 0 && (int)row->numbers[COLUMN_THREADS] == 1 &&
           row->numbers[COLUMN_SURFACES] > 0;
}

/* ---------------------------------------------------------------- tables */

static void write_number(FILE *file, const Row *row, Column column, int digits) {
    if (row != NULL && row->numbers[column] > 0) {
        fprintf(file, " %.*f |", digits, row->numbers[column]);
    } else {
        fputs(" |", file);
    }
}

static void write_times(FILE *file, const Machine *machine) {
    fputs("| scene | surfaces | picture | ms, 1 thread | ms, 2 | Tachyon, 1 | 2 | POV-Ray, 1 | 2 "
          "| MiB, Glint | Tachyon | POV-Ray |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        file);
    for (int i = 0; i < machine->row_count; i++) {
        const Row *one = &machine->rows[i];
        if (!is_scene(one)) continue;
        fprintf(file, "| %s | %.0f | %.0f x %.0f |", one->scene, one->numbers[COLUMN_SURFACES],
            one->numbers[COLUMN_WIDTH], one->numbers[COLUMN_HEIGHT]);
        write_number(file, one, COLUMN_WALL, 1);
        write_number(file, find(machine, one->scene, "glint", 2), COLUMN_WALL, 1);
        for (int peer = 0; peer < PEER_COUNT; peer++) {
            for (int threads = 1; threads <= THREADS_MAX; threads++) {
                const Row *row = find_peer(machine, one->scene, peer, threads);
                write_number(file, row, COLUMN_TO_GLINT, 2);
            }
        }
        write_number(file, one, COLUMN_PEAK, 1);
        for (int peer = 0; peer < PEER_COUNT; peer++) {
            write_number(file, find_peer(machine, one->scene, peer, 1), COLUMN_PEAK, 1);
        }
        fputc('\n', file);
    }
}

static void write_phases(FILE *file, const Machine *machine) {
    fputs("\n| scene, threads | read ms | build ms | trace ms | write ms | read MB/s | "
          "build Mprim/s | camera Mray/s | shadow Mray/s | bytes per surface |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        file);
    for (int i = 0; i < machine->row_count; i++) {
        const Row *row = &machine->rows[i];
        if (strcmp(row->program, "glint") != 0 || !(row->numbers[COLUMN_SURFACES] > 0)) continue;
        fprintf(file, "| %s, %.0f |", row->scene, row->numbers[COLUMN_THREADS]);
        for (int column = COLUMN_READ; column <= COLUMN_WRITE; column++) {
            write_number(file, row, (Column)column, 1);
        }
        write_number(file, row, COLUMN_READ_RATE, 0);
        write_number(file, row, COLUMN_BUILD_RATE, 2);
        write_number(file, row, COLUMN_CAMERA_RATE, 2);
        write_number(file, row, COLUMN_SHADOW_RATE, 2);
        bool large = row->numbers[COLUMN_SURFACES] >= 100000;
        write_number(file, large ? row : NULL, COLUMN_PEAK_EACH, 0);
        fputc('\n', file);
    }
}

/* ---------------------------------------------------------------- what does not win */

static int write_lost_time(FILE *file, const Machine *machine, const Row *one) {
    int count = 0;
    for (int peer = 0; peer < PEER_COUNT; peer++) {
        for (int threads = 1; threads <= THREADS_MAX; threads++) {
            const Row *row = find_peer(machine, one->scene, peer, threads);
            if (row == NULL || row->numbers[COLUMN_TO_GLINT] >= 1) continue;
            fprintf(file, "* %s, %d thread%s: %s needs %.2f of the time.\n", one->scene, threads,
                threads == 1 ? "" : "s", peer_names[peer], row->numbers[COLUMN_TO_GLINT]);
            count++;
        }
    }
    return count;
}

static int write_lost_memory(FILE *file, const Machine *machine, const Row *one) {
    int count = 0;
    for (int peer = 0; peer < PEER_COUNT; peer++) {
        const Row *row = find_peer(machine, one->scene, peer, 1);
        if (row == NULL) continue;
        double share = row->numbers[COLUMN_PEAK] / one->numbers[COLUMN_PEAK];
        if (share >= 1) continue;
        fprintf(file, "* %s: %s needs %.2f of the memory.\n", one->scene, peer_names[peer], share);
        count++;
    }
    return count;
}

static int write_lost_scaling(FILE *file, const Machine *machine, const Row *one) {
    const Row *two = find(machine, one->scene, "glint", 2);
    if (two == NULL) return 0;
    double gain = one->numbers[COLUMN_WALL] / two->numbers[COLUMN_WALL];
    if (gain >= 1.5) return 0;
    fprintf(file, "* %s: a second thread makes it only %.2f times as fast.\n", one->scene, gain);
    return 1;
}

static void write_losses(FILE *file, const Machine *machine) {
    int count = 0, alone = 0;
    fputs("\n**What does not win**\n\n", file);
    for (int i = 0; i < machine->row_count; i++) {
        const Row *one = &machine->rows[i];
        if (!is_scene(one)) continue;
        count += write_lost_time(file, machine, one);
        count += write_lost_memory(file, machine, one);
        count += write_lost_scaling(file, machine, one);
    }
    for (int i = 0; i < machine->row_count; i++) {
        const Row *one = &machine->rows[i];
        if (!is_scene(one) || find_peer(machine, one->scene, PEER_TACHYON, 1) != NULL) continue;
        if (find_peer(machine, one->scene, PEER_POVRAY, 1) != NULL) continue;
        fprintf(
            file, "%s%s", alone++ == 0 ? "* Compared with no other program: " : ", ", one->scene);
    }
    if (alone > 0) fputs(".\n", file);
    if (count + alone == 0) fputs("Nothing of what was measured.\n", file);
}

static void write_machine(FILE *file, const Machine *machine) {
    fprintf(file, "\n## %s\n\n", machine->name);
    write_times(file, machine);
    write_phases(file, machine);
    write_losses(file, machine);
}

/* ---------------------------------------------------------------- the page */

static const char head[] =
    "# Performance\n"
    "\n"
    "This page is made by `./dev bench --save` of the files in [`bench/results`](../bench/results),"
    " a file for each machine. Nothing in it is written by hand.\n"
    "\n"
    "* Programs are measured as they are used, from start to exit; milliseconds are medians of"
    " several runs, in which all programs take turns. The numbers under Tachyon and POV-Ray (the"
    " better of its two trees) say how many times as long they take, each with as many threads as"
    " Glint. Below 1 they are faster. An empty field: that program cannot draw the scene.\n"
    "* Memory is the largest resident size of the whole process. Bytes per surface are all of that"
    " divided by the surfaces, nothing taken away.\n"
    "* Reading counts the bytes of scene and mesh. The rates of camera and shadow rays come from"
    " drawing without lights and with them; what lights add is shading and shadow rays. There are"
    " none where rays go on from a surface or lights are large: counts of rays would not compare.\n"
    "* The scenes are computed ([`samples/`](../samples)): `spheres`, `solids` and `helices` are"
    " random solids, the latter in groups; `torus` is one smooth mesh, from OBJ; `forest` a tree of"
    " 200 solids, drawn many times; `glass` has spheres of glass and glaze; `lights` 10,000 solids"
    " under many lights; `shadow` and `sky` are lit by a lamp and a sky, `room` is path traced, "
    "with"
    " that many samples a pixel.\n";

static int compare_names(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

void page_write(const char *results, const char *path) {
    char *names[MACHINE_MAX], from[PATH_SIZE];
    int count = 0;
    DIR *folder = opendir(results);
    if (folder == NULL) message_fail("%s cannot be read", results);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL && count < MACHINE_MAX;) {
        size_t length = strlen(entry->d_name);
        if (length < 4 || strcmp(entry->d_name + length - 4, ".csv") != 0) continue;
        if (strcmp(entry->d_name, "noise.csv") == 0) continue;
        names[count] = strdup(entry->d_name);
        if (names[count++] == NULL) message_fail("not enough memory");
    }
    closedir(folder);
    qsort(names, (size_t)count, sizeof names[0], compare_names);
    FILE *file = fopen(path, "w");
    Machine *machine = malloc(sizeof *machine);
    if (file == NULL) message_fail("%s cannot be written", path);
    if (machine == NULL) message_fail("not enough memory");
    fputs(head, file);
    for (int i = 0; i < count; i++) {
        message_format(from, sizeof from, "%s/%s", results, names[i]);
        if (read_machine(from, machine)) {
            write_machine(file, machine);
        } else {
            fprintf(stderr, "glint-bench: %s is of another version\n", from);
        }
        free(names[i]);
    }
    free(machine);
    bool good = !ferror(file);
    if (fclose(file) != 0 || !good) message_fail("%s cannot be written", path);
    printf("the page is %s\n", path);
}
