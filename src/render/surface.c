/* SPDX-License-Identifier: MIT */
#include "render/stage.h"
#include "shade/shade.h"

/* A ray with what it met. */
typedef struct Met {
    GiVec origin, direction;
    double t;
    GiShapeRef shape;
    uint32_t instance, pixel;
} Met;

GiVec gi_surface_background(const GiWorld *world, GiVec direction) {
    (void)direction;
    return world->scene->back_color;
}

/* Writes the point after the last one. */
static void add_point(
    GiTileScratch *scratch, const GiSurfacePoint *at, GiVec direction, const GiSpot *spot) {
    int i = scratch->point_count++;
    GiPoints *points = &scratch->points;
    points->px[i] = at->point.x, points->py[i] = at->point.y, points->pz[i] = at->point.z;
    points->nx[i] = at->normal.x, points->ny[i] = at->normal.y, points->nz[i] = at->normal.z;
    points->vx[i] = -direction.x, points->vy[i] = -direction.y, points->vz[i] = -direction.z;
    points->error[i] = at->error;
    scratch->spots[i] = *spot;
}

/* What shadow rays from a point of the shape do not meet. */
static uint32_t skip_of(const GiWorld *world, GiShapeRef shape) {
    if (world->rules->sphere_shadows_itself) return GI_SHAPE_NONE;
    GiShapeRef own = gi_shape_unplaced(&world->shapes, shape);
    return gi_shape_kind(own) == GI_SHAPE_SPHERE ? shape.bits : GI_SHAPE_NONE;
}

/* Begins a segment of points of one shader, or goes on with the last. */
static void begin_segment(GiTileScratch *scratch, uint32_t shader) {
    int count = scratch->segment_count;
    if (count > 0 && scratch->segments[count - 1].shader == shader) return;
    scratch->segments[scratch->segment_count++] =
        (GiSegment){shader, scratch->point_count, scratch->point_count};
}

static void end_segment(GiTileScratch *scratch) {
    scratch->segments[scratch->segment_count - 1].end = scratch->point_count;
}

static inline void meet_surface(const GiStage *stage, const Met *met, uint32_t shader_index) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    const GiShader *shader = &world->scene->shaders.data[shader_index];
    GiSurfacePoint at = gi_shape_point(&world->shapes, met->shape, met->instance, met->origin,
        met->direction, met->t, world->rules->cone_geometric);
    GiSpot spot = {met->pixel, shader_index, skip_of(world, met->shape), met->instance};
    scratch->color[met->pixel] = gi_shade_emit(shader, at.normal);
    add_point(scratch, &at, met->direction, &spot);
}

/* Points of one shader come to stand side by side, so that kernels can shade many at a time. The
 * order among a bundle's points does not matter, as each belongs to another pixel. */
void gi_surface_bundle(const GiStage *stage, const uint32_t *pixels) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    const GiBundle *bundle = &scratch->bundle;
    uint32_t next[GI_BUNDLE_SIZE], shaders[GI_BUNDLE_SIZE];
    int shader_count = 0;
    for (int i = bundle->count - 1; i >= 0; i--) {
        if (bundle->shape[i] == GI_SHAPE_NONE) {
            GiVec direction = {bundle->dx[i], bundle->dy[i], bundle->dz[i]};
            scratch->color[pixels[i]] = gi_surface_background(world, direction);
            continue;
        }
        GiShapeRef ref = {bundle->shape[i]};
        uint32_t shader = gi_shape_info(&world->shapes, ref, bundle->instance[i])->shader;
        uint32_t *head = &scratch->head[shader];
        if (*head == GI_NONE) shaders[shader_count++] = shader;
        next[i] = *head;
        *head = (uint32_t)i;
    }
    for (int k = 0; k < shader_count; k++) {
        begin_segment(scratch, shaders[k]);
        uint32_t *head = &scratch->head[shaders[k]];
        for (uint32_t i = *head; i != GI_NONE; i = next[i]) {
            const Met met = {{bundle->ox[i], bundle->oy[i], bundle->oz[i]},
                {bundle->dx[i], bundle->dy[i], bundle->dz[i]}, bundle->t[i], {bundle->shape[i]},
                bundle->instance[i], pixels[i]};
            meet_surface(stage, &met, shaders[k]);
        }
        *head = GI_NONE;
        end_segment(scratch);
    }
}
