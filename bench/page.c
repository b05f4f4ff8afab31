/* SPDX-License-Identifier: MIT
 * A section for each machine, by the name of its file. What the page says beside numbers, above all
 * where Glint does not win, follows from the numbers by fixed rules, so that nobody has to have the
 * heart to write it. */
#define _POSIX_C_SOURCE 200809L
#include "page.h"

#include "contest.h"
#include "message.h"
#include "page_rays.h"
#include "plot.h"
#include "table.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MACHINE_MAX = 64, NONE = -1 };

/* ---------------------------------------------------------------- questions */

static bool is_row(const Table *table, int row, const char *program, int threads) {
    return strcmp(table_text(table, row, "program"), program) == 0 &&
           (int)table_number(table, row, "threads") == threads;
}

/* NONE: it was not measured. */
static int find(const Table *table, const char *scene, const char *program, int threads) {
    for (int row = 0; row < table->row_count; row++) {
        if (strcmp(table_text(table, row, "scene"), scene) != 0) continue;
        if (is_row(table, row, program, threads)) return row;
    }
    return NONE;
}

enum { PEER_TACHYON, PEER_POVRAY, PEER_COUNT };
static const char *const peer_names[PEER_COUNT] = {"Tachyon", "POV-Ray"};

/* Of POV-Ray the faster of its two trees. */
static int find_peer(const Table *table, const char *scene, int peer, int threads) {
    if (peer == PEER_TACHYON) return find(table, scene, "tachyon", threads);
    int one = find(table, scene, "povray +BM1", threads);
    int two = find(table, scene, "povray +BM2", threads);
    if (one == NONE || two == NONE) return one != NONE ? one : two;
    return table_number(table, one, "wall_ms") < table_number(table, two, "wall_ms") ? one : two;
}

/* The rows that begin a scene: Glint's with one thread. */
static bool is_scene(const Table *table, int row) {
    return is_row(table, row, "glint", 1) && table_number(table, row, "surfaces") > 0;
}

/* ---------------------------------------------------------------- tables */

static void write_number(FILE *file, const Table *table, int row, const char *column, int digits) {
    double number = row != NONE ? table_number(table, row, column) : 0;
    if (number > 0) {
        fprintf(file, " %.*f |", digits, number);
    } else {
        fputs(" |", file);
    }
}

static void write_times(FILE *file, const Table *table) {
    fputs("| scene | surfaces | picture | ms, 1 thread | ms, 2 | Tachyon, 1 | 2 | POV-Ray, 1 | 2 "
          "| MiB, Glint | Tachyon | POV-Ray |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        file);
    for (int row = 0; row < table->row_count; row++) {
        if (!is_scene(table, row)) continue;
        const char *scene = table_text(table, row, "scene");
        fprintf(file, "| %s | %s | %s x %s |", scene, table_text(table, row, "surfaces"),
            table_text(table, row, "width"), table_text(table, row, "height"));
        write_number(file, table, row, "wall_ms", 1);
        write_number(file, table, find(table, scene, "glint", 2), "wall_ms", 1);
        for (int peer = 0; peer < PEER_COUNT; peer++) {
            for (int threads = 1; threads <= THREADS_MAX; threads++) {
                int other = find_peer(table, scene, peer, threads);
                write_number(file, table, other, "wall_to_glint", 2);
            }
        }
        write_number(file, table, row, "peak_mib", 1);
        for (int peer = 0; peer < PEER_COUNT; peer++) {
            write_number(file, table, find_peer(table, scene, peer, 1), "peak_mib", 1);
        }
        fputc('\n', file);
    }
}

static bool is_glint(const Table *table, int row) {
    return strcmp(table_text(table, row, "program"), "glint") == 0 &&
           table_number(table, row, "surfaces") > 0;
}

static const char *const phases[] = {"read_ms", "build_ms", "trace_ms", "write_ms"};
enum { PHASE_COUNT = sizeof phases / sizeof phases[0] };

static void write_phases(FILE *file, const Table *table) {
    fputs("\n### Phases\n\n| scene, threads | read ms | build ms | trace ms | write ms | read MB/s "
          "| build Mprim/s | camera Mray/s | shadow Mray/s | bytes per surface |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        file);
    for (int row = 0; row < table->row_count; row++) {
        if (!is_glint(table, row) || table_number(table, row, "threads") > THREADS_MAX) continue;
        fprintf(
            file, "| %s, %s |", table_text(table, row, "scene"), table_text(table, row, "threads"));
        for (int i = 0; i < PHASE_COUNT; i++) write_number(file, table, row, phases[i], 1);
        write_number(file, table, row, "read_mb_per_second", 0);
        write_number(file, table, row, "build_mprim_per_second", 2);
        write_number(file, table, row, "camera_mray_per_second", 2);
        write_number(file, table, row, "shadow_mray_per_second", 2);
        /* Of a small scene the program and the picture would be most of it. */
        bool large = table_number(table, row, "surfaces") >= 100000;
        write_number(file, table, large ? row : NONE, "peak_bytes_per_surface", 0);
        fputc('\n', file);
    }
}

/* How many times as fast as with one thread. What takes less than 20 ms says nothing. */
static void write_gain(FILE *file, const Table *table, int one, int row, const char *column) {
    double before = table_number(table, one, column), now = table_number(table, row, column);
    if (before >= 20 && now > 0) {
        fprintf(file, " %.2f |", before / now);
    } else {
        fputs(" |", file);
    }
}

static void write_scaling(FILE *file, const Table *table) {
    fputs("\n### Threads\n\nHow many times as fast as with one thread, as a whole and by phase; of "
          "what takes 20 ms and more with one.\n\n"
          "| scene, threads | whole | read | build | trace |\n"
          "| --- | --- | --- | --- | --- |\n",
        file);
    for (int row = 0; row < table->row_count; row++) {
        const char *scene = table_text(table, row, "scene");
        int one = find(table, scene, "glint", 1);
        if (!is_glint(table, row) || row == one || one == NONE) continue;
        if (table_number(table, one, "wall_ms") < 20) continue;
        fprintf(file, "| %s, %s |", scene, table_text(table, row, "threads"));
        write_gain(file, table, one, row, "wall_ms");
        for (int i = 0; i < PHASE_COUNT - 1; i++) write_gain(file, table, one, row, phases[i]);
        fputc('\n', file);
    }
}

/* ---------------------------------------------------------------- what does not win */

static int write_lost_time(FILE *file, const Table *table, const char *scene) {
    int count = 0;
    for (int peer = 0; peer < PEER_COUNT; peer++) {
        for (int threads = 1; threads <= THREADS_MAX; threads++) {
            int row = find_peer(table, scene, peer, threads);
            double times = row != NONE ? table_number(table, row, "wall_to_glint") : 1;
            if (times >= 1) continue;
            fprintf(file, "* %s, %d thread%s: %s needs %.2f of the time.\n", scene, threads,
                threads == 1 ? "" : "s", peer_names[peer], times);
            count++;
        }
    }
    return count;
}

static int write_lost_memory(FILE *file, const Table *table, int one) {
    int count = 0;
    const char *scene = table_text(table, one, "scene");
    for (int peer = 0; peer < PEER_COUNT; peer++) {
        int row = find_peer(table, scene, peer, 1);
        if (row == NONE) continue;
        double share = table_number(table, row, "peak_mib") / table_number(table, one, "peak_mib");
        if (share >= 1) continue;
        fprintf(file, "* %s: %s needs %.2f of the memory.\n", scene, peer_names[peer], share);
        count++;
    }
    return count;
}

static int write_lost_scaling(FILE *file, const Table *table, int one) {
    const char *scene = table_text(table, one, "scene");
    int two = find(table, scene, "glint", 2);
    if (two == NONE) return 0;
    double gain = table_number(table, one, "wall_ms") / table_number(table, two, "wall_ms");
    if (gain >= 1.5) return 0;
    fprintf(file, "* %s: a second thread makes it only %.2f times as fast.\n", scene, gain);
    return 1;
}

static bool has_peer(const Table *table, int row) {
    const char *scene = table_text(table, row, "scene");
    for (int peer = 0; peer < PEER_COUNT; peer++) {
        if (find_peer(table, scene, peer, 1) != NONE) return true;
    }
    return false;
}

static void write_losses(FILE *file, const Table *table, const Table *rays) {
    fputs("\n### What does not win\n\n", file);
    int count = page_rays_losses(file, rays), alone = 0;
    for (int row = 0; row < table->row_count; row++) {
        if (!is_scene(table, row)) continue;
        count += write_lost_time(file, table, table_text(table, row, "scene"));
        count += write_lost_memory(file, table, row);
        count += write_lost_scaling(file, table, row);
    }
    for (int row = 0; row < table->row_count; row++) {
        if (!is_scene(table, row) || has_peer(table, row)) continue;
        fprintf(file, "%s%s", alone++ == 0 ? "* Compared with no other program: " : ", ",
            table_text(table, row, "scene"));
    }
    if (alone > 0) fputs(".\n", file);
    if (count + alone == 0) fputs("Nothing of what was measured.\n", file);
}

/* ---------------------------------------------------------------- plot */

/* The largest picture of a kind of scenes: those of --quick would bend the curves of others. */
static double widest(const Table *table, const char *kind) {
    double width = 0;
    for (int row = 0; row < table->row_count; row++) {
        if (strncmp(table_text(table, row, "scene"), kind, strlen(kind)) != 0) continue;
        width = fmax(width, table_number(table, row, "width"));
    }
    return width;
}

/* The milliseconds of a program with one thread, against the surfaces of all scenes of a kind. */
static void add_curve(const Table *table, const char *kind, const char *program, const char *column,
    PlotPanel *panel, const char *label, int colour) {
    PlotCurve *curve = &panel->curves[panel->curve_count];
    size_t length = strlen(kind);
    *curve = (PlotCurve){.label = label, .colour = colour, .dashed = colour % 2 == 1};
    for (int row = 0; row < table->row_count && curve->count < PLOT_POINT_MAX; row++) {
        const char *scene = table_text(table, row, "scene");
        if (strncmp(scene, kind, length) != 0 || scene[length] != '-') continue;
        PlotPoint point = {
            table_number(table, row, "surfaces"), table_number(table, row, column) * 1e-3};
        if (!is_row(table, row, program, 1) || !(point.y > 0)) continue;
        if (table_number(table, row, "width") < widest(table, kind)) continue;
        curve->points[curve->count++] = point;
    }
    panel->curve_count += curve->count > 0;
}

/* False: two scenes of no kind. */
static bool write_plot(const char *path, const Table *table) {
    PlotPanel panels[] = {{.title = "spheres"}, {.title = "mesh (torus)"}};
    static const char *const kinds[] = {"spheres", "torus"};
    bool worth = false;
    for (int i = 0; i < 2; i++) {
        PlotPanel *panel = &panels[i];
        add_curve(table, kinds[i], "glint", "wall_ms", panel, "Glint, start to exit", 0);
        add_curve(table, kinds[i], "glint", "trace_ms", panel, "Glint, tracing", 1);
        add_curve(table, kinds[i], "tachyon", "wall_ms", panel, "Tachyon, start to exit", 2);
        add_curve(table, kinds[i], "tachyon", "trace_ms", panel, "Tachyon, tracing", 3);
        worth |= panel->curve_count > 0 && panel->curves[0].count > 1;
    }
    if (!worth) return false;
    FILE *file = fopen(path, "w");
    if (file == NULL) message_fail("%s cannot be written", path);
    plot_write(file, panels, 2, "surfaces", "seconds, one thread");
    bool good = !ferror(file);
    if (fclose(file) != 0 || !good) message_fail("%s cannot be written", path);
    return true;
}

/* docs/performance.md has its plots in docs/performance/. */
static void write_cost(FILE *file, const char *page, const char *name, const Table *table) {
    char folder[PATH_SIZE], path[PATH_SIZE];
    message_format(folder, sizeof folder, "%s", page);
    char *dot = strrchr(folder, '.');
    if (dot == NULL || strchr(dot, '/') != NULL) message_fail("%s has no extension", page);
    *dot = '\0';
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) message_fail("%s cannot be made", folder);
    message_format(path, sizeof path, "%s/%s.svg", folder, name);
    if (!write_plot(path, table)) return;
    const char *slash = strrchr(folder, '/');
    fprintf(file,
        "\n### Cost against the number of surfaces\n\n![Seconds against surfaces](%s/%s.svg)\n",
        slash != NULL ? slash + 1 : folder, name);
}

/* When it was measured, by the first and the last date, and how often. */
static void write_origin(FILE *file, const Table *table) {
    const char *first = "", *last = "";
    double least = INFINITY, most = 0;
    for (int row = 0; row < table->row_count; row++) {
        const char *date = table_text(table, row, "date");
        bool earlier = first[0] == '\0' || strcmp(date, first) < 0;
        if (date[0] != '\0' && earlier) first = date;
        if (strcmp(date, last) > 0) last = date;
        if (!is_glint(table, row)) continue;
        least = fmin(least, table_number(table, row, "runs"));
        most = fmax(most, table_number(table, row, "runs"));
    }
    if (least > most) return;
    fprintf(file, "Runs of Glint that count: %.0f", least);
    if (least < most) fprintf(file, " to %.0f", most);
    if (first[0] != '\0') fprintf(file, "; measured on %s", first);
    if (strcmp(first, last) != 0) fprintf(file, " and until %s", last);
    fputs(".\n\n", file);
}

static void write_machine(
    FILE *file, const char *page, const char *name, const Table *table, const Table *rays) {
    fprintf(file, "\n## %s\n\n", table->head);
    write_origin(file, table);
    write_times(file, table);
    write_cost(file, page, name, table);
    write_phases(file, table);
    write_scaling(file, table);
    page_rays(file, rays);
    write_losses(file, table, rays);
}

/* ---------------------------------------------------------------- the page */

static const char head[] =
    "# Performance\n"
    "\n"
    "This page is made by `./dev bench --save` of the files in [`bench/results`](../bench/results),"
    " two files for each machine. Nothing in it is written by hand.\n"
    "\n"
    "* Programs are measured as they are used, from start to exit; milliseconds are medians of"
    " several runs, in which all programs take turns. A peer that takes seconds runs less often. "
    "The numbers under Tachyon and POV-Ray (the"
    " better of its two trees) say how many times as long they take, each with as many threads as"
    " Glint. Below 1 they are faster. An empty field: that program cannot draw the scene, or it "
    "would take too long.\n"
    "* Memory is the largest resident size of the whole process. Bytes per surface are all of that"
    " divided by the surfaces, nothing taken away.\n"
    "* Reading counts the bytes of scene and mesh. The rates of camera and shadow rays come from"
    " drawing without lights and with them; what lights add is shading and shadow rays. There are"
    " none where rays go on from a surface or lights are large: counts of rays would not compare.\n"
    "* The scenes are computed ([`samples/`](../samples)): `spheres`, `solids` and `helices` are"
    " random solids, the latter in groups; `torus` is one smooth mesh, from OBJ; `forest` a tree of"
    " 200 solids, drawn many times; `mixed` is half solids, and the rest torus, helices and forest;"
    " `glass` has spheres of glass and glaze; `lights` 10,000 solids under many lights; `shadow` "
    "and"
    " `sky` are lit by a lamp and a sky, `room` is a box after Cornell's, path traced, with that"
    " many samples a pixel.\n"
    "* The table of rays is of the kernels alone, on one thread: Glint and Embree get the same rays"
    " in turns. Camera rays and shadow rays of point lights come by the thousand, bounces are drawn"
    " by the cosine from what camera rays meet. Embree decides in single precision, Glint in "
    "double."
    " Embree has spheres as points and as user geometry, trees of medium and high quality, and is"
    " called with single rays, packets of 4, 8 and 16, and streams (1M, NM); the best of all ways"
    " counts, without what it takes to hand over the rays. It is left out where it lacks shapes.\n"
    "* Nodes, leaves and shapes are how many of them are tested for each ray: a node is eight "
    "boxes,"
    " a leaf up to eight shapes, and rays that are traced together test them together, hence"
    " fractions. The last number counts exact tests of one ray and one shape.\n";

static int compare_names(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Whether a file holds times of whole programs; the names of others end differently. */
static bool is_machine(const char *name) {
    size_t length = strlen(name);
    if (length < 4 || strcmp(name + length - 4, ".csv") != 0) return false;
    if (length >= 9 && strcmp(name + length - 9, "-rays.csv") == 0) return false;
    return strcmp(name, "noise.csv") != 0;
}

/* The names without .csv, sorted; the caller frees them. */
static int list_machines(const char *results, char *names[MACHINE_MAX]) {
    int count = 0;
    DIR *folder = opendir(results);
    if (folder == NULL) message_fail("%s cannot be read", results);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL && count < MACHINE_MAX;) {
        if (!is_machine(entry->d_name)) continue;
        names[count] = strndup(entry->d_name, strlen(entry->d_name) - 4);
        if (names[count++] == NULL) message_fail("not enough memory");
    }
    closedir(folder);
    qsort(names, (size_t)count, sizeof names[0], compare_names);
    return count;
}

void page_write(const char *results, const char *path) {
    char *names[MACHINE_MAX], from[PATH_SIZE];
    int count = list_machines(results, names);
    FILE *file = fopen(path, "w");
    if (file == NULL) message_fail("%s cannot be written", path);
    fputs(head, file);
    for (int i = 0; i < count; i++) {
        Table table, rays;
        message_format(from, sizeof from, "%s/%s-rays.csv", results, names[i]);
        table_read(from, &rays); /* or it is empty */
        message_format(from, sizeof from, "%s/%s.csv", results, names[i]);
        if (table_read(from, &table)) {
            write_machine(file, path, names[i], &table, &rays);
        } else {
            fprintf(stderr, "glint-bench: %s is of another kind\n", from);
        }
        table_free(&table);
        table_free(&rays);
        free(names[i]);
    }
    bool good = !ferror(file);
    if (fclose(file) != 0 || !good) message_fail("%s cannot be written", path);
    printf("the page is %s\n", path);
}
