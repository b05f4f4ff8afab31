/* SPDX-License-Identifier: MIT
 * Meshes made by rule, put into a scene as the readers of mesh files do it. */
#pragma once

#include "random.h"
#include "scene/scene.h"

/* An empty mesh behind the others; corners added next are its own. */
GiMesh *mesh_begin(GiScene *scene);
void mesh_position(GiScene *scene, GiVec p);
void mesh_triangle(GiScene *scene, uint32_t a, uint32_t b, uint32_t c); /* of this mesh */

/* The mesh as a surface, not yet placed. */
GiShapeRef mesh_surface(GiScene *scene);

/* A closed surface round `center`: rings x 2 rings quads, each of two triangles, with radius
 * size * (1 + bumps * noise). Smooth: with the sphere's normals. Random: the order of triangles. */
GiShapeRef mesh_sphere(GiScene *scene, GiVec center, double size, int rings, double bumps,
    bool smooth, bool shuffled, Random *random);

/* Triangles that have nothing to do with each other: needles, slivers, points, doubles. */
GiShapeRef mesh_soup(GiScene *scene, GiVec at, double size, int count, Random *random);
