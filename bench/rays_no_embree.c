/* SPDX-License-Identifier: MIT
 * In the place of rays_embree.c where Embree is not installed. */
#include "rays_embree.h"

const char *embree_version(void) { return "Embree is not installed: no comparison with it"; }

Embree *embree_create(const GiWorld *world, const char **why) {
    (void)world;
    *why = "";
    return NULL;
}

void embree_destroy(Embree *embree) { (void)embree; }

int embree_tree_count(const Embree *embree) {
    (void)embree;
    return 0;
}

const char *embree_tree_name(const Embree *embree, int tree) {
    (void)embree, (void)tree;
    return "";
}

double embree_build_seconds(const Embree *embree, int tree) {
    (void)embree, (void)tree;
    return 0;
}

double embree_tree_bytes(const Embree *embree, int tree) {
    (void)embree, (void)tree;
    return 0;
}

int embree_mode_count(void) { return 0; }

const char *embree_mode_name(int mode) {
    (void)mode;
    return "";
}

void embree_load(Embree *embree, int mode, const RaySet *set) {
    (void)embree, (void)mode, (void)set;
}

RayPass embree_trace(Embree *embree, int tree, bool empty) {
    (void)embree, (void)tree, (void)empty;
    return (RayPass){0, 0};
}
