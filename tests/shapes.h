/* SPDX-License-Identifier: MIT
 * Random shapes of all kinds, in arrays as a committed scene has them, for the tests of shapes. */
#pragma once

#include "random.h"
#include "shape/hit.h"

enum { SHAPES = 60, TRANSFORMS = 12, PLACEMENTS = 4 * SHAPES };

/* Arrays as a committed scene has them. */
typedef struct Fixture {
    GiSphere spheres[SHAPES];
    GiBox boxes[SHAPES];
    GiCone cones[2 * SHAPES]; /* the first half cylinders */
    GiDisc discs[SHAPES];
    GiPlane planes[SHAPES];
    GiPlacement placements[PLACEMENTS];
    GiTransform transforms[TRANSFORMS];
    GiShapes shapes;
    GiVec at;
    double size;
} Fixture;

/* Shapes round a point, of about a size, under the rule of 2011 and 2012 or without. */
void fixture_init(Fixture *f, uint64_t seed, GiVec at, double size, bool entering_only);

/* One of the shapes, the same for the same number. */
GiShapeRef shape_at(int i);

GiVec direction_of(Random *random);
bool is_solid(GiShapeKind kind);

typedef struct Tally {
    int hits, misses, wrong;
} Tally;

gi_hit_Ray hit_ray(GiVec o, GiVec d);

/* Counts what is wrong, and reports the first few. */
void complain(Tally *tally, const Fixture *f, GiShapeRef ref, GiVec o, GiVec d, const char *what,
    double a, double b);
