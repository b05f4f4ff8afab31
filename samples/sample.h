/* SPDX-License-Identifier: MIT
 * Scenes that are computed, for the bench, the tests and the docs.
 *
 * A sample is a rule, not a list: the surface of an index is a function of kind, count and index,
 * so that a scene of millions costs no memory before somebody draws it. Everything is told in the
 * descs of the public header. The same sample can be built by calls (sample_build) or written as a
 * file for Glint or for its peers (write.h); all of these hold the same numbers:
 *
 *   - Every number is a whole multiple of 10^-6 below 1000 in size. Nine digits tell it exactly, so
 *     a reader that rounds correctly gets back the same double.
 *   - Coordinates are right-handed with z up. Lights have no falloff, nothing is ambient, the
 *     background is black: the common ground of all the programs.
 *   - The numbers are the same on every machine (splitmix64, one draw a statement). */
#pragma once

#include "glint/glint.h"

#include <stdbool.h>
#include <stdint.h>

/* Raised when any number of any sample changes, so that files of old ones are not mistaken. */
#define SAMPLE_VERSION 2

typedef enum SampleKind {
    SAMPLE_SPHERES, /* count random spheres in a slab over a ground box */
    SAMPLE_SOLIDS,  /* the same with spheres, boxes, cylinders, truncated and full cones */
    SAMPLE_HELICES, /* count spheres, 64 a group: double helices, turned and stretched */
    SAMPLE_TINY,    /* seven solids as in an assignment; count does not matter */
    SAMPLE_TORUS,   /* a torus covered with waves: one smooth mesh of about count triangles */
    SAMPLE_FOREST,  /* a tree of 200 solids, drawn count times */
    SAMPLE_GLASS,   /* the spheres, half of them of glass or glazed */
    SAMPLE_LIGHTS,  /* 10,000 solids under count point lights */
    SAMPLE_MIXED,   /* of the solids, the torus, the helices and the forest, count in all */
    SAMPLE_SHADOW,  /* the tiny scene under a large lamp; count samples a pixel, as from here on */
    SAMPLE_SKY,     /* the same under a sky with a sun */
    SAMPLE_ROOM,    /* a box after Cornell's, path traced */
    SAMPLE_KIND_COUNT
} SampleKind;

typedef struct Sample {
    SampleKind kind;
    uint64_t count; /* of surfaces besides the ground, or what the kind says */
    int width, height;
} Sample;

/* translate * rotate z * rotate y * rotate x * scale; degrees. */
typedef struct SampleGroup {
    double translate[3], rotate[3], scale[3];
} SampleGroup;

typedef struct SampleSurface {
    GlintSurfaceDesc desc; /* without shader, parent and mesh, which are ids of a scene */
    int shader_index;
    int64_t group_index; /* -1: in the scene itself; never falls from surface to surface */
} SampleSurface;

enum { SAMPLE_SHADER_LIMIT = 14 };

/* The name used in files and options ("spheres", ...). */
const char *sample_kind_name(SampleKind kind);

/* The dialect that the XML file is written for. The tiny scene is one of the course (2012). */
GlintDialect sample_dialect(const Sample *sample);

/* view_direction is as it is written, so only nearly of length 1; projection_normal is its
 * opposite. */
GlintCameraDesc sample_camera(const Sample *sample);

/* Size, samples and integrator. */
GlintImageDesc sample_image(const Sample *sample);

int sample_light_count(const Sample *sample);
GlintLightDesc sample_light(const Sample *sample, int index);

/* m0 to m7 in turn Blinn-Phong and Lambertian, and the ground; then what some kinds have besides.
 */
int sample_shader_count(const Sample *sample);
const char *sample_shader_name(int index);
GlintShaderDesc sample_shader(int index); /* without substrate */
int sample_shader_substrate(int index);   /* an earlier shader; -1: none */

/* With the ground, which is the first. */
uint64_t sample_surface_count(const Sample *sample);
SampleSurface sample_surface(const Sample *sample, uint64_t index);
uint64_t sample_group_count(const Sample *sample);
SampleGroup sample_group(const Sample *sample, uint64_t index);

/* The last group, with its own transform, is drawn once more under each of these. */
uint64_t sample_copy_count(const Sample *sample);
SampleGroup sample_copy(const Sample *sample, uint64_t index);

/* How many surfaces a ray may meet: copies and triangles count each. */
uint64_t sample_drawn_count(const Sample *sample);

/* The mesh of a sample that has one (mesh.c): counts of 0 where there is none. Triangles run
 * counterclockwise seen from outside; normals are of length 1 up to their last digit. */
uint64_t sample_vertex_count(const Sample *sample);
uint64_t sample_triangle_count(const Sample *sample);
void sample_vertex(const Sample *sample, uint64_t index, double position[3], double normal[3]);
void sample_triangle(const Sample *sample, uint64_t index, uint32_t corners[3]);

/* Whether there is an environment: a cube map as written by sample_write_sky. */
bool sample_has_sky(const Sample *sample);

/* Adds all of it but the sky to an empty scene; the caller commits. The sines of turned groups are
 * the C library's, so there the picture may differ from the file's in the last bits. */
GlintStatus sample_build(const Sample *sample, GlintScene *scene, GlintError *error);
