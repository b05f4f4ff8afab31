/* SPDX-License-Identifier: MIT
 * A committed scene with a list of all that stands in its trees, and what a ray meets of that list,
 * one shape after the other: what every kernel is held against. */
#pragma once

#include "render/world.h"

typedef struct Thing {
    GiShapeRef ref;
    uint32_t instance;
} Thing;

typedef struct Fixture {
    GiMemory memory;
    GiScene scene;
    GiWorld world;
    GiPool *pool;
    GI_ARRAY(Thing) things; /* all that stands in the trees, for brute force */
} Fixture;

/* An empty scene, to be filled; then its trees and the list. */
void fixture_begin(Fixture *fixture, GlintDialect dialect);
void fixture_commit(Fixture *fixture, const GiKernel *kernel);
void fixture_end(Fixture *fixture);

/* By shape/hit.h; of several at the same t the first in document order. */
bool brute_force(const Fixture *fixture, const GiTraceRay *r, GiTraceHit *hit);

/* Ray i of a bundle that is still to be traced, as one by itself. */
GiTraceRay ray_of_bundle(const GiBundle *bundle, bool any, int i);

/* Ray i of a bundle, for either use of bundles; what it looks for is without end. */
void bundle_put_ray(GiBundle *bundle, int i, GiVec origin, GiVec direction, double t_min);

/* Traces the bundle, and counts the rays whose answers are not those of brute force. */
int bundle_differs(const Fixture *fixture, const GiKernel *kernel, bool any, GiBundle *bundle);
