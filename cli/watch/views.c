/* SPDX-License-Identifier: MIT
 * A view is a row of the table: its name, which output of the library it shows, and how the
 * output's numbers become colours. */
#include "watch/views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum Output {
    OUTPUT_NONE,
    OUTPUT_NORMAL,
    OUTPUT_DEPTH,
    OUTPUT_ALBEDO,
    OUTPUT_SURFACE
} Output;

typedef struct View {
    const char *name;
    Output output;
} View;

static const View views[] = {
    {"picture", OUTPUT_NONE},
    {"normal", OUTPUT_NORMAL},
    {"depth", OUTPUT_DEPTH},
    {"albedo", OUTPUT_ALBEDO},
    {"surface", OUTPUT_SURFACE},
};

enum { VIEW_COUNT = sizeof views / sizeof views[0] };

const char *cli_view_name(int view) {
    return view >= 0 && view < VIEW_COUNT ? views[view].name : NULL;
}

/* (normal + 1) / 2, as the shader RGBNormals; black where nothing is met. */
static void color_normal(const float *normal, float *pixels, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const float *n = normal + 3 * i;
        bool met = n[0] != 0 || n[1] != 0 || n[2] != 0;
        for (int k = 0; k < 3; k++) pixels[3 * i + (size_t)k] = met ? (n[k] + 1) / 2 : 0;
    }
}

/* From white for what is nearest to a dark gray for what is farthest; black where nothing is. */
static void color_depth(const float *depth, float *pixels, size_t count) {
    float least = INFINITY, most = 0;
    for (size_t i = 0; i < count; i++) {
        if (depth[i] > 0 && depth[i] < least) least = depth[i];
        if (depth[i] > most && depth[i] < INFINITY) most = depth[i];
    }
    float range = most > least ? most - least : 1;
    for (size_t i = 0; i < count; i++) {
        float value = depth[i] > 0 ? 1 - 0.97f * (depth[i] - least) / range : 0;
        for (size_t k = 0; k < 3; k++) pixels[3 * i + k] = value > 0 ? value : 0;
    }
}

/* A colour that neighbouring numbers do not share; the bits of a multiplicative hash (Knuth). */
static void color_surface(const uint32_t *surface, float *pixels, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t hash = surface[i] * UINT32_C(2654435761);
        for (int k = 0; k < 3; k++) {
            float part = (float)(hash >> (24 - 8 * k) & 0xff) / 255;
            pixels[3 * i + (size_t)k] = surface[i] == 0 ? 0 : 0.05f + 0.9f * part * part;
        }
    }
}

static void color(Output output, const void *values, float *pixels, size_t count) {
    switch (output) {
    case OUTPUT_NORMAL: color_normal(values, pixels, count); break;
    case OUTPUT_DEPTH: color_depth(values, pixels, count); break;
    case OUTPUT_SURFACE: color_surface(values, pixels, count); break;
    default: memcpy(pixels, values, 3 * count * sizeof *pixels); break;
    }
}

GlintStatus cli_view_render(
    GlintScene *scene, GlintRenderDesc *desc, int view, float *pixels, GlintError *error) {
    Output output = views[view].output;
    if (output == OUTPUT_NONE) return glint_render(scene, desc, pixels, error);
    size_t count = (size_t)desc->width * (size_t)desc->height;
    bool single = output == OUTPUT_DEPTH || output == OUTPUT_SURFACE;
    void *values = malloc(count * (single ? 1 : 3) * sizeof(float));
    if (values == NULL) {
        snprintf(
            error->message, sizeof error->message, "%s", glint_status_text(GLINT_ERROR_MEMORY));
        return GLINT_ERROR_MEMORY;
    }
    desc->depth = output == OUTPUT_DEPTH ? values : NULL;
    desc->normal = output == OUTPUT_NORMAL ? values : NULL;
    desc->albedo = output == OUTPUT_ALBEDO ? values : NULL;
    desc->surface = output == OUTPUT_SURFACE ? values : NULL;
    desc->light = -1; /* the least work: no light is asked for */
    GlintStatus status = glint_render(scene, desc, pixels, error);
    if (status == GLINT_OK) color(output, values, pixels, count);
    free(values);
    return status;
}
