/* SPDX-License-Identifier: MIT */
#include "layers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- which there are */

static const struct {
    CliLayerKind kind;
    const char *name, *components;
} values[] = {
    {CLI_LAYER_DEPTH, "depth", "Z"},
    {CLI_LAYER_NORMAL, "normal", "XYZ"},
    {CLI_LAYER_ALBEDO, "albedo", "RGB"},
    {CLI_LAYER_SURFACE, "surface", "I"},
};
enum { VALUE_COUNT = sizeof values / sizeof values[0] };

static void add(CliLayers *layers, const char *name, const char *components, int light) {
    CliLayer *layer = &layers->items[layers->count++];
    snprintf(layer->name, sizeof layer->name, "%s", name);
    layer->components = components;
    layer->light = light;
    layer->pixels = NULL;
}

bool cli_layers_init(CliLayers *layers, unsigned kinds, size_t pixel_count, int light_count) {
    *layers = (CliLayers){.pixel_count = pixel_count};
    layers->items = malloc((VALUE_COUNT + 1 + (size_t)light_count) * sizeof *layers->items);
    if (layers->items == NULL) return false;
    for (int i = 0; i < VALUE_COUNT; i++) {
        if (kinds & values[i].kind) add(layers, values[i].name, values[i].components, 0);
    }
    for (int light = 1; light <= light_count && (kinds & CLI_LAYER_LIGHTS); light++) {
        char name[24];
        snprintf(name, sizeof name, "light.%d", light);
        add(layers, name, "RGB", light);
    }
    if (kinds & CLI_LAYER_LIGHTS) add(layers, "light.none", "RGB", -1);
    for (int i = 0; i < layers->count; i++) {
        size_t width = strlen(layers->items[i].components);
        layers->items[i].pixels = malloc(pixel_count * width * sizeof(float));
        if (layers->items[i].pixels == NULL) return false;
    }
    if (!(kinds & CLI_LAYER_SURFACE)) return true;
    layers->surface = malloc(pixel_count * sizeof *layers->surface);
    return layers->surface != NULL;
}

void cli_layers_reset(CliLayers *layers) {
    for (int i = 0; i < layers->count; i++) free(layers->items[i].pixels);
    free(layers->items);
    free(layers->surface);
    *layers = (CliLayers){.items = NULL};
}

/* ---------------------------------------------------------------- drawing */

static float *pixels_of(const CliLayers *layers, const char *name) {
    for (int i = 0; i < layers->count; i++) {
        if (strcmp(layers->items[i].name, name) == 0) return layers->items[i].pixels;
    }
    return NULL;
}

void cli_layers_aim(const CliLayers *layers, GlintRenderDesc *desc) {
    desc->depth = pixels_of(layers, "depth");
    desc->normal = pixels_of(layers, "normal");
    desc->albedo = pixels_of(layers, "albedo");
    desc->surface = layers->surface;
}

GlintStatus cli_layers_render(
    CliLayers *layers, GlintScene *scene, const GlintRenderDesc *desc, GlintError *error) {
    float *ids = pixels_of(layers, "surface");
    for (size_t i = 0; ids != NULL && i < layers->pixel_count; i++) {
        ids[i] = (float)layers->surface[i];
    }
    GlintStatus status = GLINT_OK;
    for (int i = 0; i < layers->count && status == GLINT_OK; i++) {
        if (layers->items[i].light == 0) continue;
        GlintRenderDesc one = *desc;
        one.light = layers->items[i].light;
        one.depth = one.normal = one.albedo = NULL;
        one.surface = NULL;
        status = glint_render(scene, &one, layers->items[i].pixels, error);
    }
    return status;
}

/* ---------------------------------------------------------------- writing */

/* A file of its own: "a.xml.depth.pfm" beside "a.xml.png". Lights are pictures like the picture,
 * numbers are kept as they are. */
static GlintStatus save_apart(const CliLayers *layers, const CliLayer *layer,
    const GlintImage *image, const char *path, const GlintSaveDesc *desc, GlintError *error) {
    const char *ending = path + strlen(path) - 4;
    char *name = malloc(strlen(path) + sizeof layer->name + 8);
    float *triples = NULL;
    GlintImage part = *image;
    part.pixels = layer->pixels;
    GlintSaveDesc own = *desc;
    GlintRecipe recipe;
    if (desc->recipe != NULL) {
        recipe = *desc->recipe;
        recipe.light = layer->light;
        own.recipe = &recipe;
    }
    if (strlen(layer->components) == 1) {
        part.pixels = triples = malloc(layers->pixel_count * 3 * sizeof(float));
        for (size_t i = 0; triples != NULL && i < layers->pixel_count; i++) {
            triples[3 * i] = triples[3 * i + 1] = triples[3 * i + 2] = layer->pixels[i];
        }
    }
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (name != NULL && part.pixels != NULL) {
        sprintf(name, "%.*s.%s%s", (int)(ending - path), path, layer->name,
            layer->light != 0 ? ending : ".pfm");
        status = glint_image_save(&part, name, &own, error);
    }
    free(triples);
    free(name);
    return status;
}

static GlintStatus save_together(const CliLayers *layers, const GlintImage *image, const char *path,
    const GlintSaveDesc *desc, GlintError *error) {
    GlintLayer *list = malloc((size_t)layers->count * sizeof *list);
    if (list == NULL) return GLINT_ERROR_MEMORY;
    for (int i = 0; i < layers->count; i++) {
        const CliLayer *layer = &layers->items[i];
        list[i] = (GlintLayer){layer->name, layer->components, layer->pixels};
    }
    GlintSaveDesc with = *desc;
    with.layers = list;
    with.layer_count = layers->count;
    GlintStatus status = glint_image_save(image, path, &with, error);
    free(list);
    return status;
}

GlintStatus cli_layers_save(const CliLayers *layers, const GlintImage *image, const char *path,
    const GlintSaveDesc *desc, GlintError *error) {
    if (layers->count > 0 && strcmp(path + strlen(path) - 4, ".exr") == 0) {
        return save_together(layers, image, path, desc, error);
    }
    GlintStatus status = glint_image_save(image, path, desc, error);
    for (int i = 0; i < layers->count && status == GLINT_OK; i++) {
        status = save_apart(layers, &layers->items[i], image, path, desc, error);
    }
    return status;
}
