/* SPDX-License-Identifier: MIT */
#include "upgrade_compare.h"

#include "interrupt.h"
#include "message.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct Picture {
    int width, height;
    float *pixels;
} Picture;

static bool on_cancelled(void *user) {
    (void)user;
    return cli_interrupt_seen();
}

static GlintStatus draw(GlintScene *scene, const CliContent *text, const char *name,
    Picture *picture, GlintError *error) {
    const GlintMonitor monitor = {.cancelled = on_cancelled};
    GlintStatus status =
        glint_scene_load_memory(scene, text->data, text->size, name, &monitor, error);
    if (status == GLINT_OK) status = glint_scene_commit(scene, &monitor, error);
    if (status != GLINT_OK) return status;
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    int longest = info.width > info.height ? info.width : info.height;
    double factor = longest > CLI_COMPARE_SIDE ? (double)CLI_COMPARE_SIDE / longest : 1;
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = (int)ceil(info.width * factor);
    desc.height = (int)ceil(info.height * factor);
    desc.samples = 1;
    desc.monitor = &monitor;
    picture->width = desc.width;
    picture->height = desc.height;
    picture->pixels =
        malloc((size_t)desc.width * (size_t)desc.height * 3 * sizeof *picture->pixels);
    if (picture->pixels == NULL) {
        *error = (GlintError){.status = GLINT_ERROR_MEMORY, .message = "not enough memory"};
        return GLINT_ERROR_MEMORY;
    }
    return glint_render(scene, &desc, picture->pixels, error);
}

/* The scene's findings go to standard error, as when it is drawn. */
static CliStatus load(
    const CliJob *job, const CliContent *text, GlintDialect dialect, Picture *picture) {
    CliFindings findings = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.dialect = dialect;
    desc.diagnostic = cli_message_finding;
    desc.diagnostic_user = &findings;
    GlintScene *scene = NULL;
    GlintError error;
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK) status = draw(scene, text, cli_job_name(job), picture, &error);
    glint_scene_destroy(scene);
    if (status == GLINT_OK || cli_interrupt_seen()) return CLI_OK;
    return cli_message_failure(cli_job_name(job), &findings, &error);
}

static void tell(const CliJob *job, const Picture *old, const Picture *new) {
    int count = old->width * old->height, different = 0;
    double most = 0;
    for (int i = 0; i < count; i++) {
        double d = 0;
        for (int k = 3 * i; k < 3 * i + 3; k++) {
            double channel = fabs((double)old->pixels[k] - (double)new->pixels[k]);
            if (!(channel <= d)) d = channel;
        }
        different += d != 0;
        if (!(d <= most)) most = d;
    }
    fprintf(stderr, "%s: drawn with %d x %d pixels, ", cli_job_name(job), old->width, old->height);
    if (different == 0) {
        fputs("all are the same to the last bit\n", stderr);
    } else {
        fprintf(stderr, "%d %s, by at most %.2g\n", different,
            different == 1 ? "differs" : "differ", most);
    }
}

CliStatus cli_compare_scenes(
    const CliJob *job, const CliContent *old, GlintDialect dialect, const CliContent *new) {
    Picture before = {0}, after = {0};
    CliStatus status = load(job, old, dialect, &before);
    if (status == CLI_OK) status = load(job, new, GLINT_DIALECT_AUTO, &after);
    if (status == CLI_OK && !cli_interrupt_seen()) tell(job, &before, &after);
    free(before.pixels);
    free(after.pixels);
    return status;
}
