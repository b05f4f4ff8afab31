/* SPDX-License-Identifier: MIT
 * Rays that go on for long: that they can be stopped, that memory may end, and that a pixel is the
 * same whatever it shares its tile with. */
#include "test.h"

#include "port/machine.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- stopping */

/* A bright room, so that paths are long: its whole picture takes minutes, but for the left half,
 * where there is something that shines by itself. */
static const char *const long_paths =
    "<scene dialect='glint'><camera type='PerspectiveCamera'/><image>%s</image>"
    "<samples>%d</samples><integrator type='PathIntegrator'><maxDepth>4096</maxDepth>"
    "</integrator><light type='RectangleLight'><position>0 .9 0</position><normalDir>0 -1 0"
    "</normalDir><upDir>0 0 1</upDir></light>"
    "<surface type='Box'><minPt>-9 -1 -2</minPt><maxPt>0 1 -1</maxPt><shader type='RGBNormals'/>"
    "</surface><surface type='Plane'><point>0 -1 0</point><normal>0 1 0</normal></surface>"
    "<surface type='Plane'><point>0 1 0</point><normal>0 -1 0</normal></surface></scene>";

typedef struct Stop {
    double start, after; /* seconds */
} Stop;

static bool stop_after(void *user) {
    Stop *stop = user;
    return gi_machine_seconds() - stop->start > stop->after;
}

static GlintScene *long_scene(const char *size, int samples, int threads) {
    char text[2000];
    snprintf(text, sizeof text, long_paths, size, samples);
    return scene_from_text(text, NULL, threads);
}

/* Seconds from the wish to the end. */
static double lateness(const char *size, int samples, int threads) {
    GlintScene *scene = long_scene(size, samples, threads);
    float *pixels = malloc(400 * 400 * 3 * sizeof *pixels);
    Stop stop = {gi_machine_seconds(), 0.05};
    GlintMonitor monitor = {.cancelled = stop_after, .user = &stop};
    GlintRenderDesc desc = glint_render_desc_default();
    desc.monitor = &monitor;
    GlintError error = {0};
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_CANCELLED);
    CHECK_INT(error.status, GLINT_CANCELLED);
    double late = gi_machine_seconds() - stop.start - stop.after;
    free(pixels);
    glint_scene_destroy(scene);
    return late;
}

/* Also where the picture is a single tile, and where the caller's thread has nothing left to draw
 * while another is busy. The best of three counts, as other programs may keep the processor. */
static void stops_soon(void) {
    static const struct {
        const char *size;
        int samples, threads;
    } cases[] = {{"400 400", 65536, 1}, {"400 400", 65536, 3}, {"30 20", 65536, 2},
        {"1 1", 65536, 1}, {"64 2", 400, 2}};
    for (int i = 0; i < 5; i++) {
        double least = INFINITY;
        for (int k = 0; k < 3 && !(least < 0.1); k++) {
            double late = lateness(cases[i].size, cases[i].samples, cases[i].threads);
            if (late < least) least = late;
        }
        if (!(least < 0.1)) {
            test_fail(__FILE__, __LINE__, "%s: stops %g seconds late", cases[i].size, least);
        }
    }
}

const GiTest tests_flight[] = {TEST(stops_soon), TEST_END};
