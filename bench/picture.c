/* SPDX-License-Identifier: MIT */
#include "picture.h"

#include "contest.h"
#include "message.h"
#include "process.h"
#include "samples/sample.h"

#include <stdio.h>
#include <stdlib.h>

uint64_t picture_hash(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) message_fail("%s was not drawn", path);
    uint64_t hash = 0xcbf29ce484222325u;
    unsigned char bytes[16384];
    size_t length;
    while ((length = fread(bytes, 1, sizeof bytes, file)) > 0) {
        for (size_t i = 0; i < length; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    }
    if (ferror(file)) message_fail("%s cannot be read", path);
    fclose(file);
    return hash != 0 ? hash : 1;
}

/* ---------------------------------------------------------------- encoding */

static void draw(const Sample *sample, float *pixels) {
    GlintScene *scene = NULL;
    GlintError error = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintRenderDesc render = glint_render_desc_default();
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK) status = sample_build(sample, scene, &error);
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, &error);
    if (status == GLINT_OK) status = glint_render(scene, &render, pixels, &error);
    if (status != GLINT_OK) message_fail("drawing in memory: %s", error.message);
    glint_scene_destroy(scene);
}

/* What a caller does at the least: count. */
static bool count_bytes(void *user, const void *bytes, size_t size) {
    (void)bytes;
    *(uint64_t *)user += size;
    return true;
}

EncodeResult picture_encode(int rep_count) {
    const Sample sample = {SAMPLE_SPHERES, 10000, ENCODE_EDGE, ENCODE_EDGE};
    float *pixels = malloc(sizeof(float) * 3 * ENCODE_EDGE * ENCODE_EDGE);
    if (pixels == NULL) message_fail("not enough memory");
    draw(&sample, pixels);
    GlintImage image = {ENCODE_EDGE, ENCODE_EDGE, pixels};
    GlintSaveDesc desc = glint_save_desc_default();
    desc.thread_count = 1;
    EncodeResult result = {.size = 0};
    double values[REP_MAX];
    for (int rep = -1; rep < rep_count; rep++) {
        GlintError error = {0};
        uint64_t size = 0;
        double start = process_seconds();
        GlintStatus status = glint_image_encode_png(&image, &desc, count_bytes, &size, &error);
        if (status != GLINT_OK) message_fail("encoding: %s", error.message);
        if (rep >= 0) values[rep] = process_seconds() - start;
        if (rep >= 0 && size != result.size) message_fail("encoding: two different pictures");
        result.size = size;
    }
    free(pixels);
    result.seconds = statistics_spread(values, rep_count);
    return result;
}
