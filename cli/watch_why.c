/* SPDX-License-Identifier: MIT
 * What `glint why` has to say in short about a pixel that was clicked. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "watch_why.h"

#include "why_tree.h"

#include <stdlib.h>

static void print_sample(void *user, const GlintExplainSample *sample) {
    const CliWhy *why = user;
    if (sample->sample == why->sample) cli_why_print_short(why, sample);
}

static void keep_nothing(void *user, const GlintExplainSample *sample) {
    (void)user;
    (void)sample;
}

void cli_watch_explain(GlintScene *scene, const GlintRenderDesc *desc, const char *name, int x,
    int y, CliBytes *text) {
    char *written = NULL;
    size_t size = 0;
    GlintMonitor monitor = {NULL, NULL, NULL};
    CliWhy why = {.scene = scene,
        .name = name,
        .desc = *desc,
        .width = desc->width,
        .height = desc->height,
        .x = x,
        .y = y,
        .out = open_memstream(&written, &size)};
    if (why.out == NULL) return;
    glint_scene_info(scene, &why.info);
    if (why.desc.monitor == NULL) why.desc.monitor = &monitor;
    /* Two passes, as in cli_why_text: the short form knows the colour of the whole pixel. */
    bool good = cli_why_explain(&why, keep_nothing, &why) == GLINT_OK &&
                cli_why_explain(&why, print_sample, &why) == GLINT_OK;
    if (fclose(why.out) == 0 && good) cli_bytes_add(text, written, size);
    free(written);
}
