/* SPDX-License-Identifier: MIT
 * What a picture can hold beside its colours: where the camera rays ended, and the light of each
 * source apart. In an EXR file these are layers, otherwise they are files beside the picture. */
#pragma once

#include "render_options.h"

typedef struct CliLayer {
    char name[24];          /* "depth", "light.2" */
    const char *components; /* "Z", "XYZ", "RGB" */
    int light;              /* as in GlintRenderDesc, of layers that are drawn for one; else 0 */
    float *pixels;
} CliLayer;

typedef struct CliLayers {
    CliLayer *items;
    int count;
    uint32_t *surface; /* the ids before they are numbers in a layer */
    size_t pixel_count;
} CliLayers;

/* Makes the layers asked for by --layers (a set of CliLayerKind), for a picture of so many pixels
 * and a scene of so many lights. False: not enough memory. */
bool cli_layers_init(CliLayers *layers, unsigned kinds, size_t pixel_count, int light_count);
void cli_layers_reset(CliLayers *layers);

/* Has them drawn: what camera rays meet together with the picture, by this desc, ... */
void cli_layers_aim(const CliLayers *layers, GlintRenderDesc *desc);
/* ... and then the lights, one after the other, with the same desc. */
GlintStatus cli_layers_render(
    CliLayers *layers, GlintScene *scene, const GlintRenderDesc *desc, GlintError *error);

/* Writes the picture with its layers. */
GlintStatus cli_layers_save(const CliLayers *layers, const GlintImage *image, const char *path,
    const GlintSaveDesc *desc, GlintError *error);
