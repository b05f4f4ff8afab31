/* SPDX-License-Identifier: MIT */
#include "rays_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: glint-bench-rays [OPTIONS]\n"
    "\n"
    "Measures how many rays a second are traced on one thread, and nothing else: by Glint's\n"
    "kernels and, where it is installed, by Embree in the best of its ways, on the same rays.\n"
    "\n"
    "  --scenes A,B    these scenes: files of scenes (.xml), or with a count: spheres, torus (a\n"
    "                  mesh), and for Glint alone the others of glint-bench\n"
    "  --reps N        passes that count, in turns (default: 5)\n"
    "  --isa NAME      the instruction set of both (avx512, avx2, sse2), not the best\n"
    "  --csv FILE      write the numbers to FILE\n"
    "  --results DIR   write them to a file in DIR that is named for this machine, where the\n"
    "                  numbers of other scenes stay\n"
    "  --quick         small scenes and pictures, three passes\n"
    "\n"
    "Status: 0 good; 1 nothing measured; 2 wrong use; 3 the hits of both differ.\n";

static _Noreturn void stop(int status, const char *problem, const char *argument) {
    FILE *file = status == 0 ? stdout : stderr;
    if (problem != NULL) fprintf(file, "glint-bench-rays: %s '%s'\n\n", problem, argument);
    fputs(usage, file);
    exit(status);
}

RaysOptions rays_options_parse(int argc, char **argv) {
    RaysOptions options = {
        .scenes = "spheres-1k,spheres-10k,spheres-100k,spheres-1m,torus-10k,torus-100k,torus-1m,"
                  "solids-100k,mixed-100k",
        .rep_count = 5,
        .edge = 1024,
    };
    const char *scenes = NULL, *reps = NULL;
    const struct {
        const char *name, **value;
    } with_value[] = {{"--scenes", &scenes}, {"--reps", &reps}, {"--isa", &options.isa},
        {"--csv", &options.csv}, {"--results", &options.results}};
    const size_t count = sizeof with_value / sizeof with_value[0];

    for (int i = 1; i < argc; i++) {
        size_t row = 0;
        while (row < count && strcmp(argv[i], with_value[row].name) != 0) row++;
        if (row < count) {
            if (i + 1 == argc) stop(2, "nothing follows", argv[i]);
            *with_value[row].value = argv[++i];
        } else if (strcmp(argv[i], "--quick") == 0) {
            options.scenes = "spheres-1k,torus-10k,mixed-1k";
            options.rep_count = 3;
            options.edge = 256;
        } else if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            stop(0, NULL, NULL);
        } else {
            stop(2, "there is no option", argv[i]);
        }
    }
    if (scenes != NULL) options.scenes = scenes;
    if (reps != NULL) {
        char *end;
        long value = strtol(reps, &end, 10);
        if (*end != '\0' || value < 1 || value > REP_MAX) stop(2, "not a number of passes:", reps);
        options.rep_count = (int)value;
    }
    return options;
}
