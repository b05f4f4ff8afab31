/* SPDX-License-Identifier: MIT
 * A committed scene in single precision, for a program that knows triangles and spheres. */
#pragma once

#include "render/world.h"

typedef struct RaysTriangles {
    const float (*positions)[3]; /* with room for one more number behind */
    const uint32_t (*corners)[3];
    size_t position_count, count;
} RaysTriangles;

typedef struct RaysShapes {
    RaysTriangles triangles;     /* the scene's own arrays */
    RaysTriangles box_triangles; /* twelve a box */
    float (*spheres)[4];         /* centre and radius */
    size_t sphere_count;
} RaysShapes;

/* Null, or what the scene has that is neither; *shapes can be freed in any case. */
const char *rays_shapes_of(const GiWorld *world, RaysShapes *shapes);
void rays_shapes_free(RaysShapes *shapes);
