/* SPDX-License-Identifier: MIT */
#include "rays_shapes.h"

#include "rays_set.h"

#include <stdlib.h>
#include <string.h>

/* Corner i has the high x where bit 0 of i is set, the high y for bit 1, the high z for bit 2. */
static const uint32_t box_corners[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5},
    {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

static RaysTriangles triangles_of_boxes(const GiScene *scene) {
    size_t count = scene->boxes.count;
    float(*positions)[3] = rays_allocate(8 * count + 1, sizeof *positions);
    uint32_t(*corners)[3] = rays_allocate(12 * count, sizeof *corners);
    for (size_t i = 0; i < count; i++) {
        const GiBox *box = &scene->boxes.data[i];
        for (size_t k = 0; k < 8; k++) {
            positions[8 * i + k][0] = (float)(k & 1 ? box->high.x : box->low.x);
            positions[8 * i + k][1] = (float)(k & 2 ? box->high.y : box->low.y);
            positions[8 * i + k][2] = (float)(k & 4 ? box->high.z : box->low.z);
        }
        for (size_t k = 0; k < 36; k++) {
            corners[12 * i + k / 3][k % 3] = (uint32_t)(8 * i) + box_corners[k / 3][k % 3];
        }
    }
    return (RaysTriangles){
        (const float(*)[3])positions, (const uint32_t(*)[3])corners, 8 * count, 12 * count};
}

const char *rays_shapes_of(const GiWorld *world, RaysShapes *shapes) {
    const GiScene *scene = world->scene;
    memset(shapes, 0, sizeof *shapes);
    if (world->spread.placements.count > 0 || world->spread.instances.count > 0) {
        return "transforms";
    }
    if (scene->cones.count > 0 || scene->discs.count > 0 || scene->planes.count > 0 ||
        world->rectangles.count > 0) {
        return "cylinders, cones, discs, planes or visible lights";
    }
    shapes->triangles =
        (RaysTriangles){world->shapes.triangles.positions, world->shapes.triangles.corners,
            scene->meshes.positions.count, scene->meshes.corners.count};
    shapes->box_triangles = triangles_of_boxes(scene);
    shapes->sphere_count = scene->spheres.count;
    shapes->spheres = rays_allocate(shapes->sphere_count, sizeof *shapes->spheres);
    for (size_t i = 0; i < shapes->sphere_count; i++) {
        const GiSphere *sphere = &scene->spheres.data[i];
        shapes->spheres[i][0] = (float)sphere->center.x;
        shapes->spheres[i][1] = (float)sphere->center.y;
        shapes->spheres[i][2] = (float)sphere->center.z;
        shapes->spheres[i][3] = (float)sphere->radius;
    }
    return NULL;
}

void rays_shapes_free(RaysShapes *shapes) {
    free((void *)(uintptr_t)shapes->box_triangles.positions);
    free((void *)(uintptr_t)shapes->box_triangles.corners);
    free(shapes->spheres);
}
