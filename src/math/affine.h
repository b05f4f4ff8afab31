/* SPDX-License-Identifier: MIT
 * Affine maps p -> A p + b of space, as three rows of four doubles. */
#pragma once

#include "math/vec.h"

typedef struct GiAffine {
    double m[3][4];
} GiAffine;

extern const GiAffine gi_affine_identity;

GiAffine gi_affine_translate(GiVec by);
GiAffine gi_affine_scale(GiVec by);
/* Rz Ry Rx: x acts first. Multiples of 90 degrees give exact zeros and ones. */
GiAffine gi_affine_rotate_degrees(GiVec angles);

/* First b, then a. */
GiAffine gi_affine_multiply(const GiAffine *a, const GiAffine *b);

/* False, and *inverse untouched, when the map is singular or leaves the range of double. */
bool gi_affine_invert(const GiAffine *a, GiAffine *inverse);

bool gi_affine_is_identity(const GiAffine *a);

static inline GiVec gi_affine_point(const GiAffine *a, GiVec p) {
    return gi_vec(a->m[0][0] * p.x + a->m[0][1] * p.y + a->m[0][2] * p.z + a->m[0][3],
        a->m[1][0] * p.x + a->m[1][1] * p.y + a->m[1][2] * p.z + a->m[1][3],
        a->m[2][0] * p.x + a->m[2][1] * p.y + a->m[2][2] * p.z + a->m[2][3]);
}

static inline GiVec gi_affine_vector(const GiAffine *a, GiVec v) {
    return gi_vec(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
        a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
        a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}

/* The transposed linear part applied to v. Given the inverse of a map it carries normals. */
static inline GiVec gi_affine_transposed_vector(const GiAffine *a, GiVec v) {
    return gi_vec(a->m[0][0] * v.x + a->m[1][0] * v.y + a->m[2][0] * v.z,
        a->m[0][1] * v.x + a->m[1][1] * v.y + a->m[2][1] * v.z,
        a->m[0][2] * v.x + a->m[1][2] * v.y + a->m[2][2] * v.z);
}
