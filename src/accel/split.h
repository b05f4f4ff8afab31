/* SPDX-License-Identifier: MIT
 * One step of the builder: items, or clusters of items, sorted to the two sides of the best plane.
 */
#pragma once

#include "accel/build.h"

/* The box round items, and the one round their centres. count > 0. */
GiBounds gi_bounds_of(const GiBuildItem *items, size_t count);
GiBounds gi_centers_of(const GiBuildItem *items, size_t count);

/* Sorts the items to two sides, and gives the box round each. Returns how many went left; 0: no
 * plane parts the centres. weights: of clusters, by id, how many items each stands for; null for
 * plain items. */
size_t gi_split(GiBuildItem *items, size_t count, const uint32_t *weights, GiBounds sides[2]);
