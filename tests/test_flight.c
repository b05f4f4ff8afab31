/* SPDX-License-Identifier: MIT
 * Rays that go on for long: that they can be stopped, that memory may end, and that a pixel is the
 * same whatever it shares its tile with. */
#include "test.h"

#include "port/machine.h"
#include "render/stage.h"
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

/* ---------------------------------------------------------------- many rays */

/* Two walls that face each other, each with three coats of glaze: every surface that is met sends
 * three rays on, up to 3^11 of a level for one pixel and so more than are followed together. A
 * third wall sends on one ray, so that pixels differ in their numbers. Light is taken away again by
 * lights that are negative: what is left is what was rounded, which tells the order of sums. */
static const char *const many_rays =
    "<scene dialect='%s'><camera type='PerspectiveCamera'><viewPoint>0 0 3</viewPoint>"
    "<viewDir>.7 .1 -.4</viewDir><viewWidth>.8</viewWidth></camera><image>8 4</image>"
    "<samples>%d</samples>%s<light><position>.1 .5 2</position></light><light><position>-.2 -.3 -2"
    "</position></light><light><position>.1 .5 2</position><intensity>-1 -1 -1</intensity></light>"
    "<light><position>-.2 -.3 -2</position><intensity>-1 -1 -1</intensity></light>"
    "<shader name='one' type='Glazed'><refractiveIndex>1.5</refractiveIndex><substrate "
    "type='Phong'><exponent>7</exponent></substrate></shader>"
    "<shader name='two' type='Glazed'><refractiveIndex>1.7</refractiveIndex><substrate ref='one'/>"
    "</shader><shader name='three' type='Glazed'><refractiveIndex>2</refractiveIndex><substrate "
    "ref='two'/></shader>"
    "<surface type='Box'><minPt>.5 -2 -3</minPt><maxPt>.6 2 4</maxPt><shader ref='three'/>"
    "</surface><surface type='Box'><minPt>-.6 -2 -2</minPt><maxPt>-.5 2 4</maxPt>"
    "<shader ref='three'/></surface>"
    "<surface type='Box'><minPt>-2 -3 -4</minPt><maxPt>2 -.4 3</maxPt><shader ref='one'/></surface>"
    "</scene>";

/* Each pixel alone is what it is among the others, so its light is summed up in the same order. */
static void pixels_alone(void) {
    static const char *const dialects[] = {"glint", "glint", "2012"};
    static const char *const integrators[] = {
        "", "<integrator type='PathIntegrator'><maxDepth>30</maxDepth></integrator>", ""};
    for (int k = 0; k < 3; k++) {
        static char text[4000];
        snprintf(text, sizeof text, many_rays, dialects[k], k == 1 ? 16 : 1, integrators[k]);
        GlintScene *scene = scene_from_text(text, NULL, 2);
        Picture whole = picture_of_scene(scene, NULL);
        int left = 0;
        for (int i = 0; i < 8 * 4 && whole.pixels != NULL; i++) {
            GlintRenderDesc desc = glint_render_desc_default();
            desc.crop_x = i % 8, desc.crop_y = i / 8, desc.crop_width = desc.crop_height = 1;
            Picture alone = picture_of_scene(scene, &desc);
            if (memcmp(alone.pixels, whole.pixels + 3 * i, 3 * sizeof(float)) != 0) {
                test_fail(__FILE__, __LINE__, "scene %d, pixel %d", k, i);
            }
            left += whole.pixels[3 * i] != 0;
            picture_free(&alone);
        }
        CHECK(left > 8 * 4 / 2);
        picture_free(&whole);
        glint_scene_destroy(scene);
    }
}

/* No two uses of random numbers share a dimension, however many lights there are. */
static void dimensions(void) {
    static const uint32_t purposes[] = {GI_PURPOSE_CHOICE, GI_PURPOSE_LIGHT, 65535, 65536,
        65536 + GI_PURPOSE_BSDF, 2 * 65536, 1u << 28, UINT32_MAX};
    enum { PURPOSES = sizeof purposes / sizeof purposes[0], LEVELS = 70 };
    for (uint32_t a = 0; a < PURPOSES * LEVELS; a++) {
        for (uint32_t b = 0; b < a; b++) {
            uint64_t first = gi_stage_dimension(a / PURPOSES, purposes[a % PURPOSES]);
            if (first == gi_stage_dimension(b / PURPOSES, purposes[b % PURPOSES])) {
                test_fail(__FILE__, __LINE__, "levels %u and %u", a / PURPOSES, b / PURPOSES);
            }
        }
    }
}

const GiTest tests_flight[] = {TEST(stops_soon), TEST(pixels_alone), TEST(dimensions), TEST_END};
