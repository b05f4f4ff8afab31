/* SPDX-License-Identifier: MIT
 * The command line as a struct. */
#pragma once

#include "glint/glint.h"

#include "status.h"

typedef enum CliAction {
    CLI_ACTION_RENDER,
    CLI_ACTION_HELP,
    CLI_ACTION_VERSION,
    CLI_ACTION_LIST_ISA
} CliAction;

typedef enum CliHelpFormat { CLI_HELP_SCREEN, CLI_HELP_MAN, CLI_HELP_MARKDOWN } CliHelpFormat;

typedef enum CliStatsFormat { CLI_STATS_NONE, CLI_STATS_TEXT, CLI_STATS_JSON } CliStatsFormat;

/* What --layers adds to a picture. */
typedef enum CliLayerKind {
    CLI_LAYER_DEPTH = 1 << 0,
    CLI_LAYER_NORMAL = 1 << 1,
    CLI_LAYER_ALBEDO = 1 << 2,
    CLI_LAYER_SURFACE = 1 << 3,
    CLI_LAYER_LIGHTS = 1 << 4
} CliLayerKind;

typedef struct CliOptions {
    CliAction action;
    CliHelpFormat help;
    const char *output; /* null: beside the scene */
    GlintDialect dialect;
    int thread_count;                            /* 0: one per core */
    const char *isa;                             /* null: the fastest */
    int width, height;                           /* 0: the scene's */
    int crop_x, crop_y, crop_width, crop_height; /* crop_width 0: the whole picture */
    int samples;                                 /* 0: the scene's */
    unsigned layers;                             /* a set of CliLayerKind */
    CliStatsFormat stats;
    bool quiet;
    char **scenes; /* as given; points into argv */
    int scene_count;
} CliOptions;

/* Reads the arguments into *options. argv is reordered, and must live as long as *options. When
 * something is wrong it says so on standard error and returns CLI_USAGE. */
CliStatus cli_options_parse(int argc, char **argv, CliOptions *options);
