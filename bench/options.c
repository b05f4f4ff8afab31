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
    "  --quick         small scenes, three runs each, about a minute\n"
    "  --full          all scenes, up to ten million surfaces: hours\n"
    "  --scenes A,B    these scenes: tiny, or with a count: spheres, solids, helices, torus (a\n"
    "                  mesh), forest (copies), glass, lights, mixed; with samples: shadow, sky,\n"
    "                  room\n"
    "  --reps N        runs that count, of each program with each scene (default: 5)\n"
    "  --threads N     measure glint also with 4, 8, ... N threads (default: the cores)\n"
    "  --glint PATH    measure this glint, not the one beside glint-bench\n"
    "  --against PATH  a second glint to compare with, in the place of Tachyon and POV-Ray\n"
    "  --alone         without Tachyon and POV-Ray\n"
    "  --csv FILE      write the numbers to FILE\n"
    "  --results DIR   write them to a file in DIR that is named for this machine, where the\n"
    "                  numbers of other scenes stay\n"
    "  --page FILE     make the page of all that DIR holds, and plots in a folder beside it\n"
    "  --only-page     measure nothing\n"
    "  --noise         not times but the errors of pictures, with Sobol and random points\n"
    "  --pictures DIR  ... and two pictures of them\n"
    "\n"
    "Without --quick and --full it takes a quarter of an hour. Peers that take seconds run less "
    "often.\n"
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

static int number(const char *text, int most) {
    char *end;
    long value = strtol(text, &end, 10);
    if (*end != '\0' || value < 1 || value > most) stop(2, "not such a number:", text);
    return (int)value;
}

Options options_parse(int argc, char **argv) {
    Options options = {
        .scenes = "tiny,spheres-1k,spheres-10k,spheres-100k,spheres-1m,"
                  "torus-1k,torus-10k,torus-100k,torus-1m,solids-10k,solids-100k,mixed-100k,"
                  "mixed-1m,helices-100k,forest-10k,glass-100,lights-16,shadow-16,sky-16,room-4",
        .rep_count = 5,
        .edge = 1024,
    };
    const char *scenes = NULL, *reps = NULL, *threads = NULL;
    const struct {
        const char *name, **value;
    } with_value[] = {{"--scenes", &scenes}, {"--reps", &reps}, {"--threads", &threads},
        {"--glint", &options.glint}, {"--against", &options.against}, {"--csv", &options.csv},
        {"--results", &options.results}, {"--page", &options.page},
        {"--pictures", &options.pictures}};
    const size_t count = sizeof with_value / sizeof with_value[0];

    for (int i = 1; i < argc; i++) {
        size_t row = 0;
        while (row < count && strcmp(argv[i], with_value[row].name) != 0) row++;
        if (row < count) {
            if (i + 1 == argc) stop(2, "nothing follows", argv[i]);
            *with_value[row].value = argv[++i];
        } else if (strcmp(argv[i], "--quick") == 0) {
            options.scenes = "tiny,spheres-1k,spheres-10k,solids-10k,helices-10k,torus-10k,"
                             "torus-100k,mixed-10k,shadow-4";
            options.rep_count = 3;
            options.edge = 512;
        } else if (strcmp(argv[i], "--full") == 0) {
            options.scenes =
                "tiny,spheres-1k,spheres-10k,spheres-100k,spheres-1m,spheres-10m,"
                "torus-1k,torus-10k,torus-100k,torus-1m,torus-10m,"
                "solids-1k,solids-10k,solids-100k,solids-1m,solids-10m,"
                "mixed-1k,mixed-10k,mixed-100k,mixed-1m,mixed-10m,helices-100k,helices-1m,"
                "forest-10k,forest-100k,glass-100,lights-16,lights-64,shadow-16,sky-16,room-4";
        } else if (strcmp(argv[i], "--alone") == 0) {
            options.alone = true;
        } else if (strcmp(argv[i], "--only-page") == 0) {
            options.only_page = true;
        } else if (strcmp(argv[i], "--noise") == 0) {
            options.noise = true;
        } else if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            stop(0, NULL, NULL);
        } else {
            stop(2, "there is no option", argv[i]);
        }
    }
    if (scenes != NULL) options.scenes = scenes;
    if (reps != NULL) options.rep_count = number(reps, REP_MAX);
    if (threads != NULL) options.threads_most = number(threads, 1024);
    if (options.only_page && (options.results == NULL || options.page == NULL)) {
        stop(2, "without results and a page there is no", "--only-page");
    }
    return options;
}
