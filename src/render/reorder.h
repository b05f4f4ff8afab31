/* SPDX-License-Identifier: MIT
 * Puts the shapes of a committed scene into the order in which the tree's blocks name them. */
#pragma once

#include "accel/tree.h"
#include "scene/scene.h"

/* Moves shapes that stand in one block next to each other, so that rays find them in few cache
 * lines, and changes the refs of blocks and placements accordingly. A shape keeps its document
 * order. Short of memory, a kind stays as it is: only speed is lost. */
void gi_reorder(
    GiScene *scene, GiTreeStore *store, GiPlacement *placements, size_t placement_count);
