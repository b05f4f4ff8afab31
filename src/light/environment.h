/* SPDX-License-Identifier: MIT
 * Radiance from all around, as a cube map: what a direction sees, and directions drawn where the
 * light comes from. */
#pragma once

#include "base/memory.h"
#include "math/vec.h"

/* The faces lie in a cross of 3 x 4 squares; docs/scene-format.md has the places. */
typedef struct GiEnvironment {
    int face;      /* side of a face in pixels; 0: there is none */
    float *pixels; /* the cross, RGB, row 0 as stored first; its unused squares hold anything */
    double scale;
} GiEnvironment;

/* Reads a PFM file. Errors, with *environment empty: FILE (unreadable, broken, no cross of squares,
 * a value that is not finite), MEMORY. */
GlintStatus gi_environment_load(GiEnvironment *environment, GiMemory *memory, const char *path,
    double scale, GlintError *error);

void gi_environment_free(GiEnvironment *environment, GiMemory *memory);

/* direction may have any length but zero. */
GiVec gi_environment_radiance(const GiEnvironment *environment, GiVec direction);

/* ---------------------------------------------------------------- sampling */

/* Chooses texels by brightness times size, and points evenly on a texel's square. Beside the sums
 * stand hints: for every so many-th part of the whole where it ends up. */
typedef struct GiEnvironmentSampler {
    const GiEnvironment *environment;
    double *rows;    /* 6 face + 1 sums of weights: face after face, row after row */
    double *columns; /* for each of these rows face + 1 sums */
    uint32_t *row_hints, *column_hints; /* 6 face, and for each of these rows face */
} GiEnvironmentSampler;

/* environment must not be empty and must outlive the sampler. False when memory is short. */
bool gi_environment_sampler_init(
    GiEnvironmentSampler *sampler, GiMemory *memory, const GiEnvironment *environment);

void gi_environment_sampler_reset(GiEnvironmentSampler *sampler, GiMemory *memory);

/* A unit direction, what it sees, and the density per solid angle with which it is drawn. 0, and
 * nothing else set, when all is black. */
double gi_environment_sample(
    const GiEnvironmentSampler *sampler, const double u[2], GiVec *direction, GiVec *radiance);

/* The density with which gi_environment_sample draws a direction of unit length. */
double gi_environment_density(const GiEnvironmentSampler *sampler, GiVec direction);
