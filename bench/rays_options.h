/* SPDX-License-Identifier: MIT
 * The command line of glint-bench-rays. */
#pragma once

typedef struct RaysOptions {
    const char *scenes;  /* comma-separated */
    const char *isa;     /* null: the fastest */
    const char *csv;     /* null: none */
    const char *results; /* folder for the CSV named for the machine; null: none */
    int rep_count;
    int edge; /* of pictures of computed scenes, pixels */
} RaysOptions;

enum { REP_MAX = 99 };

/* Ends the program on --help and on wrong use. */
RaysOptions rays_options_parse(int argc, char **argv);
