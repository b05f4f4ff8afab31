/* SPDX-License-Identifier: MIT
 * Puts the shapes of a committed scene into the order in which the trees' leaves name them. */
#pragma once

#include "render/world.h"

/* Moves shapes that stand in one block next to each other, so that rays find them in few cache
 * lines, and changes the refs of blocks and placements accordingly; likewise the vertices of a
 * leaf's triangles, and their rows. A shape keeps its document order. Short of memory, a kind or a
 * mesh stays as it is: only speed is lost. */
void gi_reorder(GiScene *scene, GiPool *pool, GiWorld *world);

/* Brings the triangles of every mesh to the places that the trees have given them (accel/tree.h),
 * and those without a place behind them. This is not a choice: the trees speak of the new places.
 * False when memory is short. */
bool gi_reorder_triangles(GiScene *scene, GiPool *pool, uint32_t *original, const uint32_t *placed);
