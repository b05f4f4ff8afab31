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

/* A bright room, so that paths are long. Its whole picture takes minutes. */
static const char *const long_paths =
    "<scene dialect='glint'><camera type='PerspectiveCamera'/><image>%s</image>"
    "<samples>65536</samples><integrator type='PathIntegrator'><maxDepth>4096</maxDepth>"
    "</integrator><light type='RectangleLight'><position>0 .9 0</position><normalDir>0 -1 0"
    "</normalDir><upDir>0 0 1</upDir></light>"
    "<surface type='Plane'><point>0 -1 0</point><normal>0 1 0</normal></surface>"
    "<surface type='Plane'><point>0 1 0</point><normal>0 -1 0</normal></surface></scene>";

typedef struct Stop {
    double start, after, asked; /* seconds; asked: when cancelled returned true first */
} Stop;

static bool stop_after(void *user) {
    Stop *stop = user;
    double now = gi_machine_seconds();
    if (now - stop->start < stop->after) return false;
    if (stop->asked == 0) stop->asked = now;
    return true;
}

static GlintScene *long_scene(const char *size, int threads) {
    char text[2000];
    snprintf(text, sizeof text, long_paths, size);
    return scene_from_text(text, NULL, threads);
}

/* Also where the picture is a single tile, of which no other is left to begin. The best of three
 * counts, as other programs may keep the processor. */
static void stops_soon(void) {
    static const char *const sizes[] = {"400 400", "30 20", "1 1"};
    for (int i = 0; i < 3; i++) {
        double least = INFINITY;
        for (int k = 0; k < 3; k++) {
            GlintScene *scene = long_scene(sizes[i], 1 + k);
            float *pixels = malloc(400 * 400 * 3 * sizeof *pixels);
            Stop stop = {gi_machine_seconds(), 0.05, 0};
            GlintMonitor monitor = {.cancelled = stop_after, .user = &stop};
            GlintRenderDesc desc = glint_render_desc_default();
            desc.monitor = &monitor;
            GlintError error = {0};
            CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_CANCELLED);
            CHECK_INT(error.status, GLINT_CANCELLED);
            double late = gi_machine_seconds() - stop.asked;
            if (late < least) least = late;
            free(pixels);
            glint_scene_destroy(scene);
        }
        if (!(least < 0.1)) {
            test_fail(__FILE__, __LINE__, "%s: stops %g seconds late", sizes[i], least);
        }
    }
}

const GiTest tests_flight[] = {TEST(stops_soon), TEST_END};
