/* SPDX-License-Identifier: MIT */
#include "contest.h"

#include "apart.h"
#include "message.h"
#include "picture.h"
#include "process.h"
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_glint(Program program) {
    return program == PROGRAM_GLINT || program == PROGRAM_OTHER_GLINT;
}

/* Told at once, and again by the status in the end: hours of measuring are not thrown away. */
static void complain(Contest *contest, const char *who, const char *what) {
    fprintf(stderr, "glint-bench: %s: WRONG: %s %s\n", contest->scene.name, who, what);
    contest->fault_count++;
}

/* The picture of the first round is linear float, which says most; those of the others are what
 * users write, and must be equal byte by byte. One that differs is kept for a closer look. */
static void check_picture(Contest *contest, const Command *command, bool warm_up, Entry *entry) {
    uint64_t hash = picture_hash(command->picture);
    uint64_t *known = warm_up ? &entry->pixel_hash : &entry->file_hash;
    if (*known == 0) *known = hash;
    if (*known == hash) return;
    char kept[PATH_SIZE];
    message_format(kept, sizeof kept, "%s.wrong.png", command->picture);
    bool good = rename(command->picture, kept) == 0;
    complain(contest, command->arguments[0], "drew another file than the run before");
    fprintf(stderr, "  kept as %s\n", good ? kept : "nothing");
}

/* A peer that has run for that long has said what it has to say: seconds. */
static const double peer_enough = 5;

static void run_once(const Field *field, Contest *contest, Program program, Entry *entry, int rep) {
    bool warm_up = rep < 0;
    Command command;
    program_command(field, &contest->scene, program, entry->threads, warm_up, &command);
    remove(command.picture);
    ProcessResult result = process_run(command.arguments, command.output, command.error);
    if (!result.good && program == PROGRAM_GLINT) {
        message_show_file(command.error);
        message_fail("%s: %s failed", contest->scene.name, command.arguments[0]);
    }
    if (!result.good) {
        entry->broken = true;
        return;
    }
    if (is_glint(program)) {
        check_picture(contest, &command, warm_up, entry);
    }
    entry->spent_seconds += result.wall_seconds;
    if (warm_up && (is_glint(program) || result.wall_seconds < peer_enough)) return;
    if (warm_up) rep = 0; /* the only one */
    entry->values[MEASURE_WALL][rep] = result.wall_seconds;
    entry->values[MEASURE_CPU][rep] = result.cpu_seconds;
    entry->values[MEASURE_PEAK][rep] = (double)result.peak_size;
    program_phases(program, command.output, entry, rep);
    if (is_glint(program)) {
        entry->read_size += (double)scenes_mesh_size(&contest->scene, field->cache);
    }
    entry->rep_count = rep + 1;
}

/* A thread more or less must not change a picture, and of another revision one wants to know. */
static void compare_pictures(Contest *contest) {
    for (int program = PROGRAM_GLINT; program <= PROGRAM_OTHER_GLINT; program++) {
        const Entry *one = &contest->entries[program][0];
        for (const Entry *more = one + 1; more < one + CREW_MAX; more++) {
            if (more->threads == 0) continue;
            if (one->pixel_hash != more->pixel_hash || one->file_hash != more->file_hash) {
                complain(contest, contest_program_name((Program)program),
                    "draws different pictures with one and with more threads");
            }
        }
    }
    const Entry *ours = contest->entries[PROGRAM_GLINT];
    const Entry *others = contest->entries[PROGRAM_OTHER_GLINT];
    if (others->rep_count > 0 && ours->pixel_hash != others->pixel_hash) {
        contest->new_picture = true;
    }
}

static void trace_apart(const Field *field, Contest *contest) {
    char path[PATH_SIZE];
    scenes_file(&contest->scene, FORMAT_XML, field->cache, path);
    for (int threads = 1; threads <= THREADS_MAX; threads++) {
        Entry *entry = &contest->entries[PROGRAM_GLINT][threads - 1];
        apart_measure(&contest->scene, path, threads, entry->rep_count,
            entry->values[MEASURE_CAMERA], entry->values[MEASURE_SHADOW]);
    }
}

/* ---------------------------------------------------------------- the other Glint */

const char *contest_measure_name(Measure measure) {
    static const char *const names[MEASURE_COUNT] = {
        [MEASURE_WALL] = "wall",
        [MEASURE_CPU] = "cpu",
        [MEASURE_PEAK] = "memory",
        [MEASURE_ALLOCATED] = "allocated",
        [MEASURE_READ] = "read",
        [MEASURE_BUILD] = "build",
        [MEASURE_TRACE] = "trace",
        [MEASURE_WRITE] = "write",
        [MEASURE_CAMERA] = "camera",
        [MEASURE_SHADOW] = "shadow",
    };
    return names[measure];
}

double contest_against(const Contest *contest, Measure measure, int threads) {
    static const double too_short = 0.02; /* seconds of a part that say nothing */
    const Entry *ours = &contest->entries[PROGRAM_GLINT][threads - 1];
    const Entry *other = &contest->entries[PROGRAM_OTHER_GLINT][threads - 1];
    const Spread *a = &ours->spreads[measure], *b = &other->spreads[measure];
    if (ours->rep_count == 0 || other->rep_count == 0 || !(a->least > 0) || !(b->least > 0)) {
        return 0;
    }
    bool is_phase = measure == MEASURE_CPU || measure >= MEASURE_READ;
    if (is_phase && a->median < too_short && b->median < too_short) return 0;
    double of_medians = b->median / a->median, of_least = b->least / a->least;
    return fabs(log(of_medians)) < fabs(log(of_least)) ? of_medians : of_least;
}

static void summarise(Contest *contest) {
    for (int program = 0; program < PROGRAM_COUNT; program++) {
        for (int i = 0; i < CREW_MAX; i++) {
            Entry *entry = &contest->entries[program][i];
            if (entry->broken) entry->rep_count = 0;
            for (int measure = 0; measure < MEASURE_COUNT; measure++) {
                entry->spreads[measure] =
                    statistics_spread(entry->values[measure], entry->rep_count);
            }
        }
    }
    contest->slower_count = 0;
    for (int measure = 0; measure < MEASURE_CAMERA; measure++) {
        for (int threads = 1; threads <= THREADS_MAX; threads++) {
            double ratio = contest_against(contest, (Measure)measure, threads);
            if (ratio > 0 && ratio < SLOWER) contest->slower_count++;
        }
    }
}

/* ---------------------------------------------------------------- the whole */

/* Runs the programs before `end` once each. */
static void run_round(const Field *field, Contest *contest, Program end, int rep) {
    for (int program = 0; program < (int)end; program++) {
        if (field->paths[program][0] == '\0') continue;
        if (!scenes_has(&contest->scene, program_format((Program)program))) continue;
        for (int i = 0; i < CREW_MAX; i++) {
            Entry *entry = &contest->entries[program][i];
            bool enough = !is_glint((Program)program) && entry->spent_seconds >= peer_enough;
            if (entry->threads == 0 || entry->broken || (enough && entry->rep_count > 0)) continue;
            run_once(field, contest, (Program)program, entry, rep);
        }
    }
}

static void set_threads(const Field *field, Contest *contest) {
    for (int program = 0; program < PROGRAM_COUNT; program++) {
        Entry *entry = contest->entries[program];
        for (int i = 0; i < THREADS_MAX; i++) entry[i].threads = i + 1;
    }
    Entry *entry = &contest->entries[PROGRAM_GLINT][THREADS_MAX];
    const Entry *end = &contest->entries[PROGRAM_GLINT][CREW_MAX];
    for (int threads = 2; threads < field->threads_most && entry < end; entry++) {
        threads = 2 * threads < field->threads_most ? 2 * threads : field->threads_most;
        entry->threads = threads;
    }
}

void contest_run(const Field *field, const BenchScene *scene, Contest *contest) {
    enum { MORE = 4 };
    memset(contest, 0, sizeof *contest);
    contest->scene = *scene;
    contest->surface_count = sample_drawn_count(&scene->sample);
    set_threads(field, contest);
    for (int rep = -1; rep < field->rep_count; rep++) {
        run_round(field, contest, PROGRAM_COUNT, rep);
    }
    summarise(contest);
    /* No verdict by chance: what looks slower is measured again, several times as often. */
    int limit = field->rep_count * MORE < REP_MAX ? field->rep_count * MORE : REP_MAX;
    for (int rep = field->rep_count; rep < limit && contest->slower_count > 0; rep++) {
        run_round(field, contest, PROGRAM_OTHER_GLINT + 1, rep);
        summarise(contest);
    }
    trace_apart(field, contest);
    summarise(contest);
    compare_pictures(contest);
}

const Entry *contest_best_povray(const Contest *contest, int threads) {
    const Entry *best = NULL;
    for (int program = PROGRAM_POVRAY_BM1; program <= PROGRAM_POVRAY_BM2; program++) {
        const Entry *entry = &contest->entries[program][threads - 1];
        if (entry->rep_count == 0) continue;
        if (best == NULL ||
            entry->spreads[MEASURE_WALL].median < best->spreads[MEASURE_WALL].median) {
            best = entry;
        }
    }
    return best;
}
