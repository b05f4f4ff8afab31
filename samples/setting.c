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
    [SAMPLE_TORUS] = "torus",
    [SAMPLE_FOREST] = "forest",
    [SAMPLE_GLASS] = "glass",
    [SAMPLE_LIGHTS] = "lights",
    [SAMPLE_MIXED] = "mixed",
    [SAMPLE_SHADOW] = "shadow",
    [SAMPLE_SKY] = "sky",
    [SAMPLE_ROOM] = "room",
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
static const View room_view = {{0, -7.6, 2}, {0, 0, 2}, 0.72};

static const View *view_of(const Sample *sample) {
    switch (sample->kind) {
    case SAMPLE_TINY:
    case SAMPLE_SHADOW:
    case SAMPLE_SKY: return &tiny_view;
    case SAMPLE_ROOM: return &room_view;
    default: return &slab_view;
    }
}

static double millionth(double value) { return floor(value * 1e6 + 0.5) / 1e6; }

GlintCameraDesc sample_camera(const Sample *sample) {
    const View *view = view_of(sample);
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

GlintImageDesc sample_image(const Sample *sample) {
    GlintImageDesc image = glint_image_desc_default();
    image.width = sample->width;
    image.height = sample->height;
    if (sample->kind >= SAMPLE_SHADOW) image.samples = (int)sample->count;
    if (sample->kind == SAMPLE_ROOM) image.integrator = GLINT_INTEGRATOR_PATH;
    return image;
}

/* ---------------------------------------------------------------- lights */

typedef struct Lamp {
    double position[3], intensity;
} Lamp;

static const Lamp slab_lamps[] = {{{-15, -11, 21}, 0.7}, {{12, -17, 14}, 0.45}};
static const Lamp tiny_lamps[] = {{{-6, -5, 8}, 0.5}, {{5, -7, 6}, 0.35}, {{0, 4, 9}, 0.25}};

int sample_light_count(const Sample *sample) {
    switch (sample->kind) {
    case SAMPLE_TINY: return 3;
    case SAMPLE_LIGHTS: return (int)sample->count;
    case SAMPLE_SHADOW:
    case SAMPLE_ROOM: return 1;
    case SAMPLE_SKY: return 0;
    default: return 2;
    }
}

bool sample_has_sky(const Sample *sample) { return sample->kind == SAMPLE_SKY; }

/* A rectangle of light that shines downward. */
static void put_lamp(GlintLightDesc *light, double z, double edge, double radiance) {
    light->type = GLINT_LIGHT_RECTANGLE;
    light->position[0] = light->position[1] = 0;
    light->position[2] = z;
    light->width = light->height = edge;
    for (int i = 0; i < 3; i++) light->intensity[i] = radiance;
}

/* On a spiral over the slab, as many to each area; together as bright as the two of others. */
static Lamp spiral_lamp(uint64_t index, uint64_t count) {
    double share = ((double)index + 0.5) / (double)count, turn = 2.399963 * (double)index;
    double reach = 18 * sqrt(share);
    Lamp lamp = {{millionth(reach * cos(turn)), millionth(reach * sin(turn)), 18},
        millionth(1.15 / (double)count)};
    return lamp;
}

GlintLightDesc sample_light(const Sample *sample, int index) {
    GlintLightDesc light = glint_light_desc_default();
    Lamp lamp = {{0, 0, 0}, 1};
    switch (sample->kind) {
    case SAMPLE_SHADOW: put_lamp(&light, 6, 4, 5); return light;
    case SAMPLE_ROOM: put_lamp(&light, 3.99, 1.2, 14); return light;
    case SAMPLE_TINY: lamp = tiny_lamps[index]; break;
    case SAMPLE_LIGHTS: lamp = spiral_lamp((uint64_t)index, sample->count); break;
    default: lamp = slab_lamps[index]; break;
    }
    memcpy(light.position, lamp.position, sizeof light.position);
    for (int i = 0; i < 3; i++) light.intensity[i] = lamp.intensity;
    return light;
}

/* ---------------------------------------------------------------- shaders */

typedef struct Colour {
    const char *name;
    double diffuse[3];
    double exponent; /* 0: Lambertian */
    double index;    /* of refraction; 0: neither glass nor glazed */
    int substrate;   /* of glaze; 0: none */
} Colour;

static const Colour colours[SAMPLE_SHADER_LIMIT] = {
    {"m0", {0.80, 0.26, 0.22}, 20, 0, 0},
    {"m1", {0.24, 0.58, 0.82}, 0, 0, 0},
    {"m2", {0.88, 0.72, 0.28}, 40, 0, 0},
    {"m3", {0.32, 0.72, 0.38}, 0, 0, 0},
    {"m4", {0.70, 0.42, 0.78}, 80, 0, 0},
    {"m5", {0.88, 0.54, 0.28}, 0, 0, 0},
    {"m6", {0.60, 0.64, 0.70}, 160, 0, 0},
    {"m7", {0.36, 0.80, 0.76}, 0, 0, 0},
    {"ground", {0.68, 0.68, 0.66}, 0, 0, 0},
    {"glass", {1, 1, 1}, 0, 1.5, 0},
    {"glazed", {1, 1, 1}, 0, 1.5, 5},
    {"red", {0.63, 0.06, 0.05}, 0, 0, 0},
    {"green", {0.14, 0.45, 0.09}, 0, 0, 0},
    {"white", {0.73, 0.71, 0.68}, 0, 0, 0},
};

int sample_shader_count(const Sample *sample) {
    switch (sample->kind) {
    case SAMPLE_GLASS: return 11;
    case SAMPLE_ROOM: return 14;
    default: return 9;
    }
}

const char *sample_shader_name(int index) { return colours[index].name; }

int sample_shader_substrate(int index) {
    return colours[index].substrate > 0 ? colours[index].substrate : -1;
}

static GlintShaderType type_of(const Colour *colour) {
    if (colour->substrate > 0) return GLINT_SHADER_GLAZED;
    if (colour->index > 0) return GLINT_SHADER_GLASS;
    return colour->exponent > 0 ? GLINT_SHADER_PHONG : GLINT_SHADER_LAMBERTIAN;
}

GlintShaderDesc sample_shader(int index) {
    const Colour *colour = &colours[index];
    GlintShaderDesc shader = glint_shader_desc_default();
    shader.type = type_of(colour);
    memcpy(shader.diffuse_color, colour->diffuse, sizeof shader.diffuse_color);
    for (int i = 0; i < 3; i++) shader.specular_color[i] = colour->exponent > 0 ? 0.4 : 0;
    shader.exponent = colour->exponent > 0 ? colour->exponent : 1;
    if (colour->index > 0) shader.refractive_index = colour->index;
    return shader;
}
