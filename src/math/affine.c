/* SPDX-License-Identifier: MIT */
#include "math/affine.h"

#include "math/elementary.h"

const GiAffine gi_affine_identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

GiAffine gi_affine_translate(GiVec by) {
    return (GiAffine){{{1, 0, 0, by.x}, {0, 1, 0, by.y}, {0, 0, 1, by.z}}};
}

GiAffine gi_affine_scale(GiVec by) {
    return (GiAffine){{{by.x, 0, 0, 0}, {0, by.y, 0, 0}, {0, 0, by.z, 0}}};
}

GiAffine gi_affine_rotate_degrees(GiVec angles) {
    double sx, cx, sy, cy, sz, cz;
    gi_sincos_degrees(angles.x, &sx, &cx);
    gi_sincos_degrees(angles.y, &sy, &cy);
    gi_sincos_degrees(angles.z, &sz, &cz);
    return (GiAffine){{
        {cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx, 0},
        {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx, 0},
        {-sy, cy * sx, cy * cx, 0},
    }};
}

GiAffine gi_affine_multiply(const GiAffine *a, const GiAffine *b) {
    GiAffine product;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            product.m[row][column] = a->m[row][0] * b->m[0][column] +
                                     a->m[row][1] * b->m[1][column] +
                                     a->m[row][2] * b->m[2][column];
        }
        product.m[row][3] += a->m[row][3];
    }
    return product;
}

bool gi_affine_invert(const GiAffine *a, GiAffine *inverse) {
    /* Cramer's rule on rows scaled to unit length, so that the size of the entries cannot push the
     * determinant out of range; the scaling is undone on the columns of the result. */
    GiVec row[3];
    double scale[3];
    for (int i = 0; i < 3; i++) {
        GiVec r = gi_vec_from(a->m[i]);
        scale[i] = fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z)));
        if (!(scale[i] > 0 && isfinite(scale[i]))) return false;
        row[i] = gi_scale(r, 1 / scale[i]);
    }
    GiVec column[3] = {
        gi_cross(row[1], row[2]), gi_cross(row[2], row[0]), gi_cross(row[0], row[1])};
    double determinant = gi_dot(row[0], column[0]);
    double size = gi_length(row[0]) * gi_length(row[1]) * gi_length(row[2]);
    if (!(fabs(determinant) > 1e-14 * size)) return false;
    GiAffine result;
    for (int i = 0; i < 3; i++) {
        double factor = 1 / determinant / scale[i];
        result.m[0][i] = column[i].x * factor;
        result.m[1][i] = column[i].y * factor;
        result.m[2][i] = column[i].z * factor;
    }
    for (int i = 0; i < 3; i++) {
        result.m[i][3] = -(result.m[i][0] * a->m[0][3] + result.m[i][1] * a->m[1][3] +
                           result.m[i][2] * a->m[2][3]);
        for (int j = 0; j < 4; j++) {
            if (!isfinite(result.m[i][j])) return false;
        }
    }
    *inverse = result;
    return true;
}

bool gi_affine_is_identity(const GiAffine *a) {
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            if (a->m[row][column] != gi_affine_identity.m[row][column]) return false;
        }
    }
    return true;
}
