/* SPDX-License-Identifier: MIT
 * What the forms of `glint why` share: the scene that is asked about, how its objects are called,
 * and numbers as text. */
#pragma once

#include "glint/glint.h"

#include "status.h"

#include <stdio.h>

typedef enum CliWhyFormat { CLI_WHY_TEXT, CLI_WHY_JSON, CLI_WHY_OBJ, CLI_WHY_HTML } CliWhyFormat;

typedef struct CliWhy {
    GlintScene *scene; /* committed, with its sources */
    const char *name;  /* of the scene */
    GlintSceneInfo info;
    GlintRenderDesc desc; /* size and samples */
    int width, height;    /* of the picture */
    int x, y;             /* the pixel; -1: none is named */
    int samples;          /* of a pixel */
    int sample;           /* in detail; from 0 */
    int region[4];        /* left, top, width, height, of the page; width 0: all */
    GlintDialect dialect; /* asked for, or AUTO */
    int step;             /* every so many-th pixel, of the page; 0: as fits */
    GlintError error;
    FILE *out;
    /* What the forms that end with a pixel's sum have seen of it. */
    GlintExplainPixel pixel;
} CliWhy;

/* Each writes its form to why->out. Errors are those of glint_explain, and MEMORY. */
GlintStatus cli_why_text(CliWhy *why);
GlintStatus cli_why_json(CliWhy *why);
GlintStatus cli_why_obj(CliWhy *why);
GlintStatus cli_why_html(CliWhy *why);

/* Explains the one pixel; sample is called for each of its samples. */
GlintStatus cli_why_explain(
    CliWhy *why, void (*sample)(void *user, const GlintExplainSample *sample), void *user);

/* ---- names: what things are, in the words of the scene file */

enum { CLI_WHY_NAME_SIZE = 400 };

const char *cli_why_surface_type(GlintSurfaceType type);
const char *cli_why_shader_type(GlintShaderType type);
const char *cli_why_light_type(GlintLightType type);
const char *cli_why_ray_kind(GlintRayKind kind);
const char *cli_why_branch_fate(GlintBranchFate fate);
const char *cli_why_light_fate(GlintLightFate fate);

/* `surface 3, Sphere "ball" (line 22)`; of light: the rectangle light that is met instead. */
const char *cli_why_name_surface(const CliWhy *why, GlintSurfaceId surface, GlintSurfaceType type,
    uint32_t triangle, uint32_t light, char name[CLI_WHY_NAME_SIZE]);

/* `light 2, point "key" (line 40)`; 0: the environment. */
const char *cli_why_name_light(const CliWhy *why, uint32_t light, char name[CLI_WHY_NAME_SIZE]);

/* `Phong "red" (line 9)` */
const char *cli_why_name_shader(
    const CliWhy *why, GlintShaderId shader, char name[CLI_WHY_NAME_SIZE]);

/* The name attribute and line of an object; "" and 0 where there is none. */
GlintSource cli_why_source(const CliWhy *why, GlintObjectKind kind, uint32_t index1);

/* ---- JSON, of the form and of the page */

/* `"text"`, with what JSON wants escaped. Bytes that are no UTF-8 become question marks. */
void cli_why_json_text(FILE *out, const char *text);

/* A number that reads back as the same double; null for what JSON has no number for. */
void cli_why_json_number(FILE *out, double number);
