/* SPDX-License-Identifier: MIT
 * One scene, all programs. They run in turn, round after round, so that whatever else the machine
 * does hits all of them alike; the first round warms up and is not counted. */
#pragma once

#include "scenes.h"
#include "statistics.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum Program {
    PROGRAM_GLINT,
    PROGRAM_OTHER_GLINT, /* --against */
    PROGRAM_TACHYON,
    PROGRAM_POVRAY_BM1, /* bounding boxes in a hierarchy */
    PROGRAM_POVRAY_BM2, /* the BSP tree */
    PROGRAM_COUNT
} Program;

/* Where the programs are; an empty path: not there. */
typedef struct Field {
    char paths[PROGRAM_COUNT][PATH_SIZE];
    char cache[PATH_SIZE]; /* folder of scenes and pictures */
    int rep_count;
    int threads_most; /* of Glint */
} Field;

typedef enum Measure {
    MEASURE_WALL, /* seconds */
    MEASURE_CPU,
    MEASURE_PEAK,      /* resident bytes of the process */
    MEASURE_ALLOCATED, /* bytes asked for, touched or not; this one and the rest: Glint only */
    MEASURE_READ,      /* seconds, as those that follow */
    MEASURE_BUILD,
    MEASURE_TRACE,
    MEASURE_WRITE,
    MEASURE_CAMERA, /* camera rays alone, without lights; this one and the next: see apart.h */
    MEASURE_SHADOW, /* what lights add to that: shading and shadow rays */
    MEASURE_COUNT
} Measure;

/* All programs run with one thread and with two, the Glint that is measured also with 4, 8, ... */
enum { THREADS_MAX = 2, CREW_MAX = 12, REP_MAX = 100 };

typedef struct Entry {
    int threads;
    double spent_seconds; /* by all runs, also the first */
    int rep_count;        /* 0: did not run, or broke down */
    bool broken;
    uint64_t pixel_hash, file_hash;                         /* of the picture as .pfm and as .png */
    double read_size, primitives, camera_rays, shadow_rays; /* what the seconds were spent on */
    double values[MEASURE_COUNT][REP_MAX];
    Spread spreads[MEASURE_COUNT];
} Entry;

typedef struct Contest {
    BenchScene scene;
    uint64_t surface_count;
    int fault_count;  /* pictures that are not the same although they should be */
    int slower_count; /* phases in which the other Glint is clearly faster */
    bool new_picture; /* the other Glint draws another one */
    Entry entries[PROGRAM_COUNT][CREW_MAX]; /* 1 thread, 2, 4, ... */
} Contest;

/* "glint", "tachyon", "povray +BM1", ... */
const char *contest_program_name(Program program);

/* Below this the other Glint's time divided by ours says that we have become slower. */
#define SLOWER 0.97

/* Fills the contest. Every run of a Glint has to draw the same picture; each that does not is told
 * on standard error. A Glint that fails ends the program; the other one, which may not know what
 * the scene has, and peers only leave the contest. */
void contest_run(const Field *field, const BenchScene *scene, Contest *contest);

const char *contest_measure_name(Measure measure);

/* How many times as long the other Glint's measure takes: of the medians, or of the least when that
 * is nearer to 1, so that one disturbed program is no verdict. 0: unknown, or too short to tell. */
double contest_against(const Contest *contest, Measure measure, int threads);

/* The entry with the shortest median among the program's relatives (POV-Ray has two trees). Null:
 * none ran. */
const Entry *contest_best_povray(const Contest *contest, int threads);
