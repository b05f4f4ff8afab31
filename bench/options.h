/* SPDX-License-Identifier: MIT
 * The command line of glint-bench. */
#pragma once

#include <stdbool.h>

typedef struct Options {
    const char *scenes;   /* comma-separated */
    const char *glint;    /* null: beside this program */
    const char *against;  /* null: no second one */
    const char *csv;      /* null: none */
    const char *results;  /* folder for the CSV named for the machine; null: none */
    const char *page;     /* made of the folder of results; null: none */
    const char *pictures; /* folder for the pictures of noise; null: none */
    bool alone;           /* no peers */
    bool noise;           /* measure that instead */
    bool only_page;       /* measure nothing */
    int threads_most;     /* of Glint; 0: as many as there are cores */
    int rep_count;
    int edge; /* of a picture, pixels */
} Options;

/* Ends the program on --help and on wrong use. */
Options options_parse(int argc, char **argv);
