/* SPDX-License-Identifier: MIT
 * The same rays through Embree, in all its ways: with spheres as points and as user geometry,
 * trees of medium and high quality, single rays, packets and streams. */
#pragma once

#include "rays_glint.h"

typedef struct Embree Embree;

/* "Embree 3.13.5", or why there is none. */
const char *embree_version(void);

/* Builds all trees, with the instruction set of Glint's kernels. The scene is read again from the
 * world, which must outlive it. Null: there is no Embree, or the scene has shapes for which it
 * needs too much help (*why says so). */
Embree *embree_create(const GiWorld *world, const char **why);
void embree_destroy(Embree *embree);

/* Trees: kinds of spheres times qualities. */
int embree_tree_count(const Embree *embree);
const char *embree_tree_name(const Embree *embree, int tree);
double embree_build_seconds(const Embree *embree, int tree); /* of the process */
double embree_tree_bytes(const Embree *embree, int tree);    /* without the shapes themselves */

/* Modes: kinds of calls. */
int embree_mode_count(void);
const char *embree_mode_name(int mode);

/* Sets out all rays as the mode wants them; this is not measured. */
void embree_load(Embree *embree, int mode, const RaySet *set);

/* Takes the rays that are set out, a call's at a time, to where the call finds them, calls, and
 * counts the hits. empty: all of this but the call, which is what the harness costs. */
RayPass embree_trace(Embree *embree, int tree, bool empty);
