/* SPDX-License-Identifier: MIT
 * Places and rays that are easily got wrong, made from the shapes of a scene: corners, edges, rims,
 * apexes and poles; rays through them, along them, within faces and from the very surface. */
#pragma once

#include "brute.h"
#include "random.h"

/* A thing of the scene by chance; the scene has one. */
Thing nasty_thing(const Fixture *fixture, Random *random);

/* A place on or in the thing, up to rounding. */
GiVec nasty_point(const Fixture *fixture, Thing thing, Random *random);

/* Along an axis, in a coordinate plane (with zeros of both signs), nearly so, or any; of about
 * length one. */
GiVec nasty_direction(Random *random);

/* A ray through a scene that fills about the cube of half side `size` round `at`. Never without
 * direction. */
GiTraceRay nasty_ray(const Fixture *fixture, GiVec at, double size, Random *random);

/* Limits exactly at, just before or just behind what the ray meets first; or the shape left out
 * (`skips`). Rays that meet nothing stay as they are. */
void nasty_limits(const Fixture *fixture, bool skips, Random *random, GiTraceRay *ray);
