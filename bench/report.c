/* SPDX-License-Identifier: MIT */
#include "report.h"

#include <inttypes.h>
#include <math.h>

/* How many times as long as Glint the other one takes; 0: unknown. */
static double ratio(const Contest *contest, const Entry *other, int threads) {
    const Entry *ours = &contest->entries[PROGRAM_GLINT][threads - 1];
    if (other == NULL || other->rep_count == 0 || ours->rep_count == 0) return 0;
    return other->spreads[MEASURE_WALL].median / ours->spreads[MEASURE_WALL].median;
}

/* Millions a second. */
static double rate(double amount, const Entry *entry, Measure measure) {
    double seconds = entry->spreads[measure].median;
    return seconds > 0 ? 1e-6 * amount / seconds : 0;
}

enum { RIVAL_TACHYON, RIVAL_POVRAY, RIVAL_OTHER_GLINT, RIVAL_COUNT };
static const char *const rival_names[] = {"Tachyon", "POV-Ray", "the other glint"};

static double rival_ratio(const Contest *contest, int rival, int threads) {
    switch (rival) {
    case RIVAL_TACHYON:
        return ratio(contest, &contest->entries[PROGRAM_TACHYON][threads - 1], threads);
    case RIVAL_POVRAY: return ratio(contest, contest_best_povray(contest, threads), threads);
    default: return ratio(contest, &contest->entries[PROGRAM_OTHER_GLINT][threads - 1], threads);
    }
}

/* ---------------------------------------------------------------- one scene */

static void print_entry(const Contest *contest, Program program, const Entry *entry) {
    const Spread *spreads = entry->spreads;
    if (entry->rep_count == 0) {
        if (entry->broken)
            printf("  %-11s %2d  broke down\n", contest_program_name(program), entry->threads);
        return;
    }
    char range[48];
    snprintf(range, sizeof range, "(%.1f-%.1f)", 1e3 * spreads[MEASURE_WALL].least,
        1e3 * spreads[MEASURE_WALL].most);
    printf("  %-11s %2d %10.1f %-19s %10.1f %8.1f", contest_program_name(program), entry->threads,
        1e3 * spreads[MEASURE_WALL].median, range, 1e3 * spreads[MEASURE_CPU].median,
        spreads[MEASURE_PEAK].median / 1048576);
    /* Of a small scene the program and the picture would be most of it. */
    if (contest->surface_count >= 100000) {
        printf(" %7.0f", spreads[MEASURE_PEAK].median / (double)contest->surface_count);
    } else {
        printf(" %7s", "-");
    }
    if (program <= PROGRAM_OTHER_GLINT) {
        double rays = entry->camera_rays + entry->shadow_rays;
        printf(" %8.0f %8.2f %8.2f", rate(entry->read_size, entry, MEASURE_READ),
            rate(entry->primitives, entry, MEASURE_BUILD), rate(rays, entry, MEASURE_TRACE));
        if (program == PROGRAM_GLINT && spreads[MEASURE_CAMERA].median > 0) {
            printf(" %8.2f %8.2f", rate(entry->camera_rays, entry, MEASURE_CAMERA),
                rate(entry->shadow_rays, entry, MEASURE_SHADOW));
        } else {
            printf(" %8s %8s", "-", "-");
        }
        printf(" %8.1f", 1e3 * spreads[MEASURE_WRITE].median);
    }
    putchar('\n');
}

/* Phase by phase; above 1 the one that is measured needs less. */
static void print_against(const Contest *contest) {
    const Entry *other = contest->entries[PROGRAM_OTHER_GLINT];
    if (other[0].broken) puts("  the other glint cannot draw this scene");
    if (other[0].rep_count == 0) return;
    for (int threads = 1; threads <= THREADS_MAX; threads++) {
        printf("  other / this, %d thread%s", threads, threads == 1 ? ": " : "s:");
        for (int measure = 0; measure < MEASURE_CAMERA; measure++) {
            double times = contest_against(contest, (Measure)measure, threads);
            if (times == 0) continue;
            printf("  %s %.3f%s", contest_measure_name((Measure)measure), times,
                times < SLOWER ? " SLOWER" : "");
        }
        putchar('\n');
    }
    if (contest->new_picture) puts("  the other glint draws another picture");
}

void report_scene(const Contest *contest) {
    printf("\n%s: %" PRIu64 " surfaces, %d x %d\n", contest->scene.name, contest->surface_count,
        contest->scene.sample.width, contest->scene.sample.height);
    printf("  %-14s %10s %-19s %10s %8s %7s %8s %8s %8s %8s %8s %8s\n", "program, threads",
        "wall ms", " (range)", "cpu ms", "peak MiB", "B/surf.", "read", "build", "trace", "camera",
        "shadow", "write");
    printf("  %79s %8s %8s %8s %8s %8s\n", "MB/s", "Mprim/s", "Mray/s", "Mray/s", "Mray/s", "ms");
    for (int program = 0; program < PROGRAM_COUNT; program++) {
        for (int i = 0; i < CREW_MAX; i++) {
            print_entry(contest, (Program)program, &contest->entries[program][i]);
        }
    }
    for (int rival = 0; rival < RIVAL_COUNT; rival++) {
        double one = rival_ratio(contest, rival, 1), two = rival_ratio(contest, rival, 2);
        if (one > 0 && two > 0) {
            printf("  %.3g times as fast as %s, with two threads each %.3g\n", one,
                rival_names[rival], two);
        }
    }
    print_against(contest);
    if (contest->fault_count > 0) printf("  WRONG PICTURES: %d\n", contest->fault_count);
    fflush(stdout);
}

/* ---------------------------------------------------------------- all scenes */

void report_summary(const Contest *contests, int count) {
    printf("\n%-16s %19s  %s\n", "", "glint, wall ms", "times as fast as, threads each");
    printf("%-16s %9s %9s", "scene", "1", "2");
    for (int rival = 0; rival < RIVAL_COUNT; rival++) printf(" %15s 1 %6d", rival_names[rival], 2);
    putchar('\n');
    double logs[RIVAL_COUNT][THREADS_MAX] = {{0}};
    int known[RIVAL_COUNT][THREADS_MAX] = {{0}};
    for (int i = 0; i < count; i++) {
        const Entry *ours = contests[i].entries[PROGRAM_GLINT];
        printf("%-16s %9.1f %9.1f", contests[i].scene.name,
            1e3 * ours[0].spreads[MEASURE_WALL].median, 1e3 * ours[1].spreads[MEASURE_WALL].median);
        for (int rival = 0; rival < RIVAL_COUNT; rival++) {
            for (int threads = 1; threads <= THREADS_MAX; threads++) {
                double times = rival_ratio(&contests[i], rival, threads);
                int width = threads == 1 ? 17 : 6;
                if (times > 0) {
                    printf(" %*.3g", width, times);
                    logs[rival][threads - 1] += log(times);
                    known[rival][threads - 1]++;
                } else {
                    printf(" %*s", width, "-");
                }
            }
        }
        putchar('\n');
    }
    printf("%-16s %19s", "geometric mean", "");
    for (int rival = 0; rival < RIVAL_COUNT; rival++) {
        for (int i = 0; i < THREADS_MAX; i++) {
            int width = i == 0 ? 17 : 6;
            if (known[rival][i] > 0) {
                printf(" %*.3g", width, exp(logs[rival][i] / known[rival][i]));
            } else {
                printf(" %*s", width, "-");
            }
        }
    }
    putchar('\n');
}

/* ---------------------------------------------------------------- CSV */

static void write_row(
    const Contest *contest, Program program, const Entry *entry, const char *date, FILE *file) {
    const Spread *spreads = entry->spreads;
    const Sample *sample = &contest->scene.sample;
    if (entry->rep_count == 0) return;
    fprintf(file, "%s,%s,%d,%" PRIu64 ",%d,%d,%d,%.3f,%.3f,%.3f,%.3f,%.3f,%.1f,%.4g",
        contest->scene.name, contest_program_name(program), entry->threads, contest->surface_count,
        sample->width, sample->height, entry->rep_count, 1e3 * spreads[MEASURE_WALL].median,
        1e3 * spreads[MEASURE_WALL].least, 1e3 * spreads[MEASURE_WALL].most,
        1e3 * spreads[MEASURE_CPU].median, spreads[MEASURE_PEAK].median / 1048576,
        spreads[MEASURE_PEAK].median / (double)contest->surface_count,
        entry->threads <= THREADS_MAX ? ratio(contest, entry, entry->threads) : 1);
    if (program <= PROGRAM_OTHER_GLINT) {
        fprintf(file, ",%.1f", spreads[MEASURE_ALLOCATED].median / (double)contest->surface_count);
    } else {
        fputs(",", file);
    }
    for (int measure = MEASURE_READ; measure <= MEASURE_WRITE; measure++) {
        if (spreads[measure].median > 0) fprintf(file, ",%.3f", 1e3 * spreads[measure].median);
        if (!(spreads[measure].median > 0)) fputs(",", file);
    }
    if (program <= PROGRAM_OTHER_GLINT) {
        double rays = entry->camera_rays + entry->shadow_rays;
        fprintf(file, ",%.1f,%.3f,%.3f,%.3f,%.3f,%s\n", rate(entry->read_size, entry, MEASURE_READ),
            rate(entry->primitives, entry, MEASURE_BUILD), rate(rays, entry, MEASURE_TRACE),
            rate(entry->camera_rays, entry, MEASURE_CAMERA),
            rate(entry->shadow_rays, entry, MEASURE_SHADOW), date);
    } else {
        fprintf(file, ",,,,,,%s\n", date);
    }
}

void report_csv(
    const Contest *contests, int count, const EncodeResult *encode, const char *date, FILE *file) {
    fputs("scene,program,threads,surfaces,width,height,runs,wall_ms,wall_ms_least,wall_ms_most,"
          "cpu_ms,peak_mib,peak_bytes_per_surface,wall_to_glint,allocated_bytes_per_surface,"
          "read_ms,build_ms,trace_ms,write_ms,read_mb_per_second,build_mprim_per_second,"
          "trace_mray_per_second,camera_mray_per_second,shadow_mray_per_second,date\n",
        file);
    for (int i = 0; i < count; i++) {
        for (int program = 0; program < PROGRAM_COUNT; program++) {
            for (int k = 0; k < CREW_MAX; k++) {
                write_row(
                    &contests[i], (Program)program, &contests[i].entries[program][k], date, file);
            }
        }
    }
    fprintf(file, "png-encode,glint,1,,%d,%d,,%.3f,%.3f,%.3f,,,,,,,,,%.3f,,,,,,%s\n", ENCODE_EDGE,
        ENCODE_EDGE, 1e3 * encode->seconds.median, 1e3 * encode->seconds.least,
        1e3 * encode->seconds.most, 1e3 * encode->seconds.median, date);
}
