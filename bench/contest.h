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
} Field;

typedef enum Measure {
    MEASURE_WALL,  /* seconds */
    MEASURE_CPU,   /* seconds */
    MEASURE_PEAK,  /* bytes */
    MEASURE_READ,  /* bytes a second; this one and the rest: Glint only */
    MEASURE_BUILD, /* primitives a second */
    MEASURE_TRACE, /* rays a second */
    MEASURE_WRITE, /* seconds */
    MEASURE_COUNT
} Measure;

enum { THREADS_MAX = 2, REP_MAX = 100 };

typedef struct Entry {
    int rep_count; /* 0: did not run, or broke down */
    bool broken;
    uint64_t pixel_hash, file_hash; /* of the picture as .pfm and as .png */
    double values[MEASURE_COUNT][REP_MAX];
    Spread spreads[MEASURE_COUNT];
} Entry;

typedef struct Contest {
    BenchScene scene;
    uint64_t surface_count;
    int fault_count; /* pictures that are not the same although they should be */
    Entry entries[PROGRAM_COUNT][THREADS_MAX];
} Contest;

/* "glint", "tachyon", "povray +BM1", ... */
const char *contest_program_name(Program program);

/* Fills the contest. Every Glint run has to draw the same picture; each that does not is told on
 * standard error. A Glint that fails ends the program, a peer only leaves the contest. */
void contest_run(const Field *field, const BenchScene *scene, Contest *contest);

/* The entry with the shortest median among the program's relatives (POV-Ray has two trees). Null:
 * none ran. */
const Entry *contest_best_povray(const Contest *contest, int threads);
