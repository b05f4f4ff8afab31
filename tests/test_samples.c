/* SPDX-License-Identifier: MIT
 * The computed scenes: built by calls and written as files they are the same pictures, and the mesh
 * is closed and looks outward. */
#include "samples/sample.h"
#include "samples/write.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { EDGE = 48, NUMBER_COUNT = EDGE * EDGE * 3 };

static void write_beside(const Sample *sample, const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", test_scratch_dir(), name);
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    if (file == NULL) return;
    if (sample_has_sky(sample)) {
        sample_write_sky(file);
    } else {
        sample_write_obj(sample, file);
    }
    fclose(file);
}

/* path null: by calls. */
static bool draw(const Sample *sample, const char *path, float *pixels) {
    GlintScene *scene = NULL;
    GlintError error = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintRenderDesc render = glint_render_desc_default();
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK) {
        status = path != NULL ? glint_scene_load_file(scene, path, NULL, &error)
                              : sample_build(sample, scene, &error);
    }
    if (status == GLINT_OK && path == NULL && sample_has_sky(sample)) {
        char sky[1024];
        snprintf(sky, sizeof sky, "%s/beside.pfm", test_scratch_dir());
        status = glint_scene_load_environment(scene, sky, 1, &error);
    }
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, &error);
    if (status == GLINT_OK) status = glint_render(scene, &render, pixels, &error);
    if (status != GLINT_OK) {
        test_fail(__FILE__, __LINE__, "%s: %s", sample_kind_name(sample->kind), error.message);
    }
    glint_scene_destroy(scene);
    return status == GLINT_OK;
}

static void samples_alike(void) {
    static const uint64_t counts[SAMPLE_KIND_COUNT] = {
        100, 100, 200, 1, 2000, 50, 40, 7, 1000, 4, 4, 4};
    static float built[NUMBER_COUNT], loaded[NUMBER_COUNT];
    for (int kind = 0; kind < SAMPLE_KIND_COUNT; kind++) {
        Sample sample = {(SampleKind)kind, counts[kind], EDGE, EDGE};
        const char *beside = sample_has_sky(&sample) ? "beside.pfm" : "beside.obj";
        char path[1024];
        snprintf(path, sizeof path, "%s/sample.xml", test_scratch_dir());
        FILE *file = fopen(path, "w");
        CHECK(file != NULL);
        if (file == NULL) return;
        sample_write_xml(&sample, beside, file);
        fclose(file);
        write_beside(&sample, beside);
        /* The tiny scene is one of 2012, where calls would need the dialect too. */
        if (kind == SAMPLE_TINY) continue;
        if (!draw(&sample, path, loaded) || !draw(&sample, NULL, built)) continue;
        int different = 0;
        double sum = 0;
        for (int i = 0; i < NUMBER_COUNT; i++) {
            sum += (double)built[i];
            different += fabs((double)built[i] - (double)loaded[i]) > 1e-3;
        }
        /* Sines of groups are computed in two ways, so an outline may move by a rounding. */
        if (different > 30 || !(sum > NUMBER_COUNT * 0.01)) {
            test_fail(__FILE__, __LINE__, "%s: %d numbers differ, sum %g",
                sample_kind_name(sample.kind), different, sum);
        }
    }
}

/* The volume inside, by the divergence theorem, is that of the torus up to its waves only when all
 * triangles are turned the same way; and each looks where its normals look. */
static void samples_mesh(void) {
    Sample sample = {SAMPLE_TORUS, 60000, EDGE, EDGE};
    uint64_t count = sample_triangle_count(&sample);
    CHECK(count > 59000 && count < 61000);
    double volume = 0;
    int turned = 0;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t corners[3];
        double p[3][3], n[3][3], cross[3], toward = 0;
        sample_triangle(&sample, i, corners);
        for (int k = 0; k < 3; k++) {
            CHECK(corners[k] < sample_vertex_count(&sample));
            sample_vertex(&sample, corners[k], p[k], n[k]);
        }
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            cross[k] = (p[1][a] - p[0][a]) * (p[2][b] - p[0][b]) -
                       (p[1][b] - p[0][b]) * (p[2][a] - p[0][a]);
            toward += cross[k] * (n[0][k] + n[1][k] + n[2][k]);
        }
        turned += toward <= 0;
        for (int k = 0; k < 3; k++) volume += p[0][k] * cross[k] / 6;
    }
    CHECK_INT(turned, 0);
    double pi = 3.14159265358979323846;
    CHECK_NEAR(volume / (2 * pi * pi * 6.2 * 4), 1, 0.03);
}

const GiTest tests_samples[] = {TEST(samples_alike), TEST(samples_mesh), TEST_END};
