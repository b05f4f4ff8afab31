/* SPDX-License-Identifier: MIT */
#include "options.h"

#include "contest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: glint-bench [OPTIONS]\n"
    "\n"
    "Measures glint, and Tachyon and POV-Ray where these are installed, as whole processes.\n"
    "\n"
    "  --quick         small scenes, three runs each, less than a minute\n"
    "  --scenes A,B    these scenes: tiny, or with a count: spheres, solids, helices, torus (a\n"
    "                  mesh), forest (copies), glass, lights; with samples: shadow, sky, room\n"
    "  --reps N        runs that count, of each program with each scene (default: 5)\n"
    "  --glint PATH    measure this glint, not the one beside glint-bench\n"
    "  --against PATH  a second glint to compare with, in the place of Tachyon and POV-Ray\n"
    "  --csv FILE      write the numbers to FILE\n"
    "  --results DIR   write them to a file in DIR that is named for this machine\n"
    "  --page FILE     make the page of all that DIR holds\n"
    "  --noise         not times but the errors of pictures, with Sobol and random points\n"
    "  --pictures DIR  ... and two pictures of them\n"
    "\n"
    "Status: 0 good; 1 a wrong picture or nothing measured; 2 wrong use; 3 clearly slower than "
    "the\n"
    "glint of --against, in some phase of some scene.\n";

static _Noreturn void stop(int status, const char *problem, const char *argument) {
    FILE *file = status == 0 ? stdout : stderr;
    if (problem != NULL) fprintf(file, "glint-bench: %s '%s'\n\n", problem, argument);
    fputs(usage, file);
    exit(status);
}

Options options_parse(int argc, char **argv) {
    Options options = {
        .scenes = "tiny,spheres-1k,spheres-10k,spheres-100k,spheres-1m,"
                  "solids-1k,solids-10k,solids-100k,solids-1m,helices-100k,helices-1m,"
                  "torus-10k,torus-100k,torus-1m,torus-4m,forest-10k,forest-100k,glass-100,"
                  "lights-64,shadow-16,sky-16,room-4",
        .rep_count = 5,
        .edge = 1024,
    };
    const char *scenes = NULL, *reps = NULL;
    const struct {
        const char *name, **value;
    } with_value[] = {{"--scenes", &scenes}, {"--reps", &reps}, {"--glint", &options.glint},
        {"--against", &options.against}, {"--csv", &options.csv}, {"--results", &options.results},
        {"--page", &options.page}, {"--pictures", &options.pictures}};
    const size_t count = sizeof with_value / sizeof with_value[0];

    for (int i = 1; i < argc; i++) {
        size_t row = 0;
        while (row < count && strcmp(argv[i], with_value[row].name) != 0) row++;
        if (row < count) {
            if (i + 1 == argc) stop(2, "nothing follows", argv[i]);
            *with_value[row].value = argv[++i];
        } else if (strcmp(argv[i], "--quick") == 0) {
            options.scenes = "tiny,spheres-10k,solids-10k,helices-10k,torus-100k,shadow-4";
            options.rep_count = 3;
            options.edge = 512;
        } else if (strcmp(argv[i], "--noise") == 0) {
            options.noise = true;
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
        if (*end != '\0' || value < 1 || value > REP_MAX) stop(2, "not a number of runs:", reps);
        options.rep_count = (int)value;
    }
    return options;
}
