/* SPDX-License-Identifier: MIT
 * What stands round the surfaces: camera, lights and colours, all of it tables. */
#include "samples/sample.h"

#include <math.h>
#include <string.h>

static const char *const kind_names[SAMPLE_KIND_COUNT] = {
    [SAMPLE_SPHERES] = "spheres",
    [SAMPLE_SOLIDS] = "solids",
    [SAMPLE_HELICES] = "helices",
    [SAMPLE_TINY] = "tiny",
};

const char *sample_kind_name(SampleKind kind) { return kind_names[kind]; }

GlintDialect sample_dialect(const Sample *sample) {
    return sample->kind == SAMPLE_TINY ? GLINT_DIALECT_2012 : GLINT_DIALECT_GLINT;
}

/* ---------------------------------------------------------------- camera */

typedef struct View {
    double eye[3], target[3];
    double view_height; /* at distance 1 */
} View;

static const View slab_view = {{2.5, -25, 17.5}, {0, -0.3, 0.6}, 0.6};
static const View tiny_view = {{3, -9, 5}, {0, 0, 0.8}, 0.72};

static double millionth(double value) { return floor(value * 1e6 + 0.5) / 1e6; }

GlintCameraDesc sample_camera(const Sample *sample) {
    const View *view = sample->kind == SAMPLE_TINY ? &tiny_view : &slab_view;
    GlintCameraDesc camera = glint_camera_desc_default();
    double toward[3], square = 0;
    for (int i = 0; i < 3; i++) {
        toward[i] = view->target[i] - view->eye[i];
        square += toward[i] * toward[i];
    }
    for (int i = 0; i < 3; i++) {
        camera.view_point[i] = view->eye[i];
        camera.view_direction[i] = millionth(toward[i] / sqrt(square));
        camera.projection_normal[i] = -camera.view_direction[i];
        camera.view_up[i] = i == 2;
    }
    camera.projection_distance = 1;
    camera.view_height = view->view_height;
    camera.view_width = millionth(view->view_height * sample->width / sample->height);
    return camera;
}

/* ---------------------------------------------------------------- lights */

typedef struct Lamp {
    double position[3], intensity;
} Lamp;

static const Lamp slab_lamps[] = {{{-15, -11, 21}, 0.7}, {{12, -17, 14}, 0.45}};
static const Lamp tiny_lamps[] = {{{-6, -5, 8}, 0.5}, {{5, -7, 6}, 0.35}, {{0, 4, 9}, 0.25}};

int sample_light_count(const Sample *sample) { return sample->kind == SAMPLE_TINY ? 3 : 2; }

GlintLightDesc sample_light(const Sample *sample, int index) {
    const Lamp *lamp = &(sample->kind == SAMPLE_TINY ? tiny_lamps : slab_lamps)[index];
    GlintLightDesc light = glint_light_desc_default();
    memcpy(light.position, lamp->position, sizeof light.position);
    for (int i = 0; i < 3; i++) light.intensity[i] = lamp->intensity;
    return light;
}

/* ---------------------------------------------------------------- shaders */

typedef struct Colour {
    const char *name;
    double diffuse[3];
    double exponent; /* 0: Lambertian */
} Colour;

static const Colour colours[SAMPLE_SHADER_COUNT] = {
    {"m0", {0.80, 0.26, 0.22}, 20},
    {"m1", {0.24, 0.58, 0.82}, 0},
    {"m2", {0.88, 0.72, 0.28}, 40},
    {"m3", {0.32, 0.72, 0.38}, 0},
    {"m4", {0.70, 0.42, 0.78}, 80},
    {"m5", {0.88, 0.54, 0.28}, 0},
    {"m6", {0.60, 0.64, 0.70}, 160},
    {"m7", {0.36, 0.80, 0.76}, 0},
    {"ground", {0.68, 0.68, 0.66}, 0},
};

const char *sample_shader_name(int index) { return colours[index].name; }

GlintShaderDesc sample_shader(int index) {
    const Colour *colour = &colours[index];
    GlintShaderDesc shader = glint_shader_desc_default();
    shader.type = colour->exponent > 0 ? GLINT_SHADER_PHONG : GLINT_SHADER_LAMBERTIAN;
    memcpy(shader.diffuse_color, colour->diffuse, sizeof shader.diffuse_color);
    for (int i = 0; i < 3; i++) shader.specular_color[i] = colour->exponent > 0 ? 0.4 : 0;
    shader.exponent = colour->exponent > 0 ? colour->exponent : 1;
    return shader;
}
