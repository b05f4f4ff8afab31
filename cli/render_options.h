/* SPDX-License-Identifier: MIT
 * The options of `glint render` as a struct. */
#pragma once

#include "glint/glint.h"

#include "verb.h"

typedef enum CliStatsFormat { CLI_STATS_NONE, CLI_STATS_TEXT, CLI_STATS_JSON } CliStatsFormat;

/* What --layers adds to a picture. */
typedef enum CliLayerKind {
    CLI_LAYER_DEPTH = 1 << 0,
    CLI_LAYER_NORMAL = 1 << 1,
    CLI_LAYER_ALBEDO = 1 << 2,
    CLI_LAYER_SURFACE = 1 << 3,
    CLI_LAYER_LIGHTS = 1 << 4
} CliLayerKind;

typedef struct CliRenderOptions {
    const char *output; /* null: beside the scene */
    GlintDialect dialect;
    int thread_count;                            /* 0: one per core */
    const char *isa;                             /* null: the fastest */
    int width, height;                           /* 0: the scene's */
    int crop_x, crop_y, crop_width, crop_height; /* crop_width 0: the whole picture */
    int samples;                                 /* 0: the scene's */
    unsigned layers;                             /* a set of CliLayerKind */
    GlintShow show;
    const char *light;          /* name or number of the one to show alone; null: all */
    const char *picture_ending; /* of a picture that is not named: ".png", ".normal.png" */
    GlintMistakes mistakes;
    CliStatsFormat stats;
    bool quiet, list_isa, list_mistakes;
    bool embed; /* the scene and its files into the PNG */
} CliRenderOptions;

enum { CLI_RENDER_OPTION_COUNT = 14 };
extern const CliOption cli_render_option_table[CLI_RENDER_OPTION_COUNT];
