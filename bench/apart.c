/* SPDX-License-Identifier: MIT */
#include "apart.h"

#include "contest.h"
#include "glint/glint.h"
#include "message.h"
#include "process.h"

#include <stdlib.h>
#include <string.h>

typedef struct Job {
    const char *path;
    int threads, rep_count, width, height;
} Job;

typedef struct Seconds {
    double camera[REP_MAX], shadow[REP_MAX];
} Seconds;

static double draw(GlintScene *scene, int light, float *pixels) {
    GlintError error = {0};
    GlintRenderDesc desc = glint_render_desc_default();
    desc.light = light;
    double start = process_seconds();
    if (glint_render(scene, &desc, pixels, &error) != GLINT_OK) message_fail("%s", error.message);
    return process_seconds() - start;
}

static void run(const void *context, void *result) {
    const Job *job = context;
    Seconds *seconds = result;
    GlintScene *scene = NULL;
    GlintError error = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = job->threads;
    float *pixels = malloc(sizeof *pixels * 3 * (size_t)job->width * (size_t)job->height);
    if (pixels == NULL) message_fail("not enough memory");
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK) status = glint_scene_load_file(scene, job->path, NULL, &error);
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, &error);
    if (status != GLINT_OK) message_fail("%s: %s", job->path, error.message);
    draw(scene, -1, pixels);
    for (int rep = 0; rep < job->rep_count; rep++) {
        seconds->camera[rep] = draw(scene, -1, pixels);
        double more = draw(scene, 0, pixels) - seconds->camera[rep];
        seconds->shadow[rep] = more > 0 ? more : 0;
    }
    glint_scene_destroy(scene);
    free(pixels);
}

void apart_measure(const BenchScene *scene, const char *path, int threads, int rep_count,
    double *camera_seconds, double *shadow_seconds) {
    SampleKind kind = scene->sample.kind;
    if (rep_count == 0 || kind == SAMPLE_GLASS || kind >= SAMPLE_SHADOW) return;
    static Seconds seconds;
    Job job = {path, threads, rep_count, scene->sample.width, scene->sample.height};
    if (!process_call(run, &job, &seconds, sizeof seconds)) return;
    memcpy(camera_seconds, seconds.camera, (size_t)rep_count * sizeof *camera_seconds);
    memcpy(shadow_seconds, seconds.shadow, (size_t)rep_count * sizeof *shadow_seconds);
}
