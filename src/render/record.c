/* SPDX-License-Identifier: MIT */
#include "render/record.h"

#include <string.h>

void gi_record_init(GiRecord *record, GiMemory *memory, const GlintExplainSink *sink) {
    memset(record, 0, sizeof *record);
    record->memory = memory;
    record->sink = sink;
}

void gi_record_reset(GiRecord *record) {
    gi_array_free(record->memory, &record->rays);
    gi_array_free(record->memory, &record->layers);
    gi_array_free(record->memory, &record->branches);
    gi_array_free(record->memory, &record->lights);
    gi_array_free(record->memory, &record->additions);
    gi_array_free(record->memory, &record->points);
    gi_array_free(record->memory, &record->beams);
}

/* Appends to an array of the record; short of memory, the record stays incomplete and says so. */
#define PUSH(record, array, ...)                                                                   \
    do {                                                                                           \
        if (!gi_array_push((record)->memory, &(record)->array, __VA_ARGS__))                       \
            (record)->out_of_memory = true;                                                        \
    } while (0)

/* Null: there was no memory for it. */
static GlintExplainRay *ray_at(GiRecord *record, uint32_t ray) {
    return ray < record->rays.count ? &record->rays.data[ray] : NULL;
}

static GlintExplainBranch *branch_at(GiRecord *record, uint32_t branch) {
    return branch < record->branches.count ? &record->branches.data[branch] : NULL;
}

/* ---------------------------------------------------------------- what a ray meets */

static GlintSurfaceType type_of(const GiShapes *shapes, GiShapeRef shape) {
    switch (gi_shape_kind(shape)) {
    case GI_SHAPE_BOX: return GLINT_SURFACE_BOX;
    case GI_SHAPE_CONE: {
        bool cylinder = shapes->cones[gi_shape_index(shape)].slope == 0;
        return cylinder ? GLINT_SURFACE_CYLINDER : GLINT_SURFACE_CONE;
    }
    case GI_SHAPE_DISC: return GLINT_SURFACE_DISC;
    case GI_SHAPE_PLANE: return GLINT_SURFACE_PLANE;
    case GI_SHAPE_TRIANGLE: return GLINT_SURFACE_MESH;
    default: return GLINT_SURFACE_SPHERE;
    }
}

/* Its number in its file: commit has brought triangles into another order. */
static uint32_t triangle_of(const GiShapes *shapes, GiShapeRef shape) {
    if (gi_shape_kind(shape) != GI_SHAPE_TRIANGLE) return GLINT_NONE;
    uint32_t place = gi_shape_index(shape);
    const GiMesh *mesh = &shapes->meshes[gi_shape_mesh(shapes, place)];
    const uint32_t *original = shapes->triangles.original;
    return (original != NULL ? original[place] : place) - mesh->first_triangle;
}

GiRecordThing gi_record_thing(const GiWorld *world, GiShapeRef shape, uint32_t instance) {
    const GiShapes *shapes = &world->shapes;
    const GiShapeInfo *info = gi_shape_info(shapes, shape, instance);
    GiShapeRef own = gi_shape_unplaced(shapes, shape);
    if (gi_shape_kind(own) == GI_SHAPE_RECTANGLE) {
        return (GiRecordThing){.triangle = GLINT_NONE, .light = info->shader + 1};
    }
    return (GiRecordThing){.surface = {info->order + 1},
        .type = type_of(shapes, own),
        .triangle = triangle_of(shapes, own),
        .shader = {info->shader}};
}

static void note_hit(
    const GiWorld *world, GlintExplainRay *ray, GiShapeRef shape, uint32_t instance, double t) {
    GiVec direction = gi_vec_from(ray->direction);
    GiSurfacePoint at = gi_shape_point(&world->shapes, shape, instance, gi_vec_from(ray->origin),
        direction, t, world->rules->cone_geometric);
    GiRecordThing thing = gi_record_thing(world, shape, instance);
    ray->end = thing.light != 0 ? GLINT_RAY_END_LIGHT : GLINT_RAY_END_SURFACE;
    ray->t = t;
    gi_record_vec(ray->point, at.point);
    gi_record_vec(ray->normal, at.normal);
    gi_record_vec(ray->geometric_normal, at.geometric);
    ray->n_dot_v = gi_dot(at.normal, gi_negate(direction));
    ray->surface = thing.surface;
    ray->surface_type = thing.type;
    ray->triangle = thing.triangle;
    ray->light = thing.light;
    ray->shader = thing.shader;
}

void gi_record_camera(const GiStage *stage) {
    const GiBundle *bundle = &stage->scratch->bundle;
    GiRecord *record = stage->record;
    record->rays.count = record->layers.count = record->branches.count = 0;
    record->lights.count = record->additions.count = 0;
    record->points.count = record->beams.count = record->next_beam = 0;
    GiVec o = gi_bundle_origin(bundle, 0), d = gi_bundle_direction(bundle, 0);
    GlintExplainRay ray = {.kind = GLINT_RAY_CAMERA,
        .parent = GLINT_NONE,
        .level = 1,
        .origin = {o.x, o.y, o.z},
        .direction = {d.x, d.y, d.z},
        .t_min = bundle->start,
        .factor = {1, 1, 1},
        .weight = 1,
        .triangle = GLINT_NONE};
    GiShapeRef shape = {bundle->shape[0]};
    if (shape.bits != GI_SHAPE_NONE) {
        note_hit(stage->world, &ray, shape, bundle->instance[0], bundle->t[0]);
    }
    PUSH(record, rays, ray);
}

uint32_t gi_record_flight(const GiStage *stage, const GiFlight *flight) {
    GiRecord *record = stage->record;
    GlintExplainBranch *branch = branch_at(record, record->chosen);
    if (branch == NULL) return GLINT_NONE;
    GlintExplainRay ray = {.kind = branch->kind,
        .parent = flight->ray,
        .level = flight->level,
        .t_min = flight->t_min,
        .weight = flight->weight,
        .density = flight->density,
        .inside = flight->inside,
        .triangle = GLINT_NONE};
    gi_record_vec(ray.origin, flight->origin);
    gi_record_vec(ray.direction, flight->direction);
    gi_record_vec(ray.factor, flight->factor);
    branch->fate = GLINT_BRANCH_FOLLOWED;
    branch->child = (uint32_t)record->rays.count;
    PUSH(record, rays, ray);
    return branch->child;
}

void gi_record_hit(const GiStage *stage, uint32_t index, const GiTraceHit *hit) {
    GlintExplainRay *ray = ray_at(stage->record, index);
    if (ray == NULL || hit == NULL) return;
    note_hit(stage->world, ray, hit->shape, hit->instance, hit->t);
}

void gi_record_points(const GiStage *stage, uint32_t index) {
    const GiTileScratch *scratch = stage->scratch;
    GiRecord *record = stage->record;
    GlintExplainRay *ray = ray_at(record, index);
    for (int i = (int)record->points.count; i < scratch->points.count; i++) {
        PUSH(record, points, index);
        if (ray == NULL || record->out_of_memory) return;
        GiShading at = gi_surface_shading(stage, i);
        ray->lit = true;
        ray->local_shader = (GlintShaderId){scratch->spots[i].shader};
        GiVec factor = scratch->weighted ? scratch->factors[i] : gi_vec(1, 1, 1);
        gi_record_vec(ray->local_factor, factor);
        gi_record_vec(ray->diffuse_color, at.diffuse);
    }
}

/* ---------------------------------------------------------------- what goes on */

static GlintBranchFate fate_of(GiBranchOutcome outcome, GlintBranchFate listed) {
    return outcome == GI_BRANCH_LISTED    ? listed
           : outcome == GI_BRANCH_NOTHING ? GLINT_BRANCH_NOTHING
                                          : GLINT_BRANCH_TOO_LIGHT;
}

static void add_branch(GiRecord *record, uint32_t ray, GlintRayKind kind, const GiBranchNote *note,
    GlintBranchFate listed) {
    if (note->outcome == GI_BRANCH_NONE) return;
    if (note->outcome == GI_BRANCH_LISTED) {
        record->listed[note->index] = (uint32_t)record->branches.count;
    }
    GlintExplainBranch branch = {.kind = kind,
        .fate = fate_of(note->outcome, listed),
        .ray = ray,
        .layer = (uint32_t)record->layers.count,
        .child = GLINT_NONE,
        .weight = note->weight,
        .chance = 1,
        .survival = 1};
    gi_record_vec(branch.factor, note->factor);
    PUSH(record, branches, branch);
}

/* What the bsdf may draw: the rest of a path, or a look for large lights. */
static void add_drawn(const GiStage *stage, uint32_t ray, const GiScatter *scatter) {
    GiRecord *record = stage->record;
    const GiWorld *world = stage->world;
    bool path = world->scene->integrator == GLINT_INTEGRATOR_PATH;
    if (scatter->local.shader == NULL || !gi_surface_probes(world, scatter->local.shader)) return;
    record->listed[scatter->count] = (uint32_t)record->branches.count;
    GlintExplainBranch branch = {.kind = path ? GLINT_RAY_SCATTERED : GLINT_RAY_PROBE,
        .fate = path ? GLINT_BRANCH_NOT_CHOSEN : GLINT_BRANCH_NOTHING,
        .ray = ray,
        .layer = GLINT_NONE,
        .child = GLINT_NONE,
        .chance = 1,
        .survival = 1};
    gi_record_vec(branch.factor, scatter->local_factor);
    PUSH(record, branches, branch);
}

void gi_record_scatter(const GiStage *stage, uint32_t ray, const GiScatter *scatter) {
    GiRecord *record = stage->record;
    const GiScatterNotes *notes = &record->notes;
    GlintIntegrator integrator = stage->world->scene->integrator;
    GlintBranchFate listed = integrator == GLINT_INTEGRATOR_PATH          ? GLINT_BRANCH_NOT_CHOSEN
                             : integrator == GLINT_INTEGRATOR_POINT_LIGHT ? GLINT_BRANCH_NO_TREE
                                                                          : GLINT_BRANCH_TOO_DEEP;
    for (int i = 0; i < notes->count; i++) {
        const GiLayerNote *note = &notes->layers[i];
        GlintExplainLayer layer = {.ray = ray,
            .shader = {(uint32_t)(note->shader - stage->world->scene->shaders.data)},
            .inside = note->inside,
            .behind = note->behind,
            .total = note->total,
            .cosine = note->cosine,
            .cosine_behind = note->cosine_behind,
            .ratio = note->ratio,
            .reflectance = note->reflectance};
        add_branch(record, ray, GLINT_RAY_REFRACTED, &note->refracted, listed);
        add_branch(record, ray, GLINT_RAY_MIRRORED, &note->mirrored, listed);
        PUSH(record, layers, layer);
    }
    if (integrator != GLINT_INTEGRATOR_POINT_LIGHT) add_drawn(stage, ray, scatter);
}

void gi_record_choose(const GiStage *stage, int index, double chance) {
    GiRecord *record = stage->record;
    record->chosen = record->listed[index];
    GlintExplainBranch *branch = branch_at(record, record->chosen);
    if (branch == NULL) return;
    branch->chance = chance;
    branch->fate = GLINT_BRANCH_NOTHING;
    if (branch->kind == GLINT_RAY_SCATTERED &&
        (int)record->rays.data[branch->ray].level >= stage->world->scene->max_depth) {
        branch->kind = GLINT_RAY_PROBE;
    }
}

void gi_record_roulette(const GiStage *stage, double p) {
    GiRecord *record = stage->record;
    GlintExplainBranch *branch = branch_at(record, record->chosen);
    if (branch == NULL) return;
    branch->survival = p;
    branch->fate = GLINT_BRANCH_ENDED;
}

/* ---------------------------------------------------------------- sums */

uint32_t gi_record_sum(GiRecord *record, uint32_t ray, uint32_t light, GiVec amount) {
    if (gi_vec_is_zero(amount)) return GLINT_NONE;
    uint32_t index = (uint32_t)record->additions.count;
    record->color = index == 0 ? amount : gi_add(record->color, amount);
    GlintExplainAddition addition = {.ray = ray, .light = light};
    gi_record_vec(addition.amount, amount);
    gi_record_vec(addition.sum, record->color);
    PUSH(record, additions, addition);
    return index;
}

void gi_record_add(const GiStage *stage, uint32_t ray, GiVec amount) {
    gi_record_sum(stage->record, ray, GLINT_NONE, amount);
}

void gi_record_choose_samples(const GiRecord *record, int *first, int *end) {
    int only = record->sink->only_sample;
    if (only == 0) return;
    if (only < *end) *end = only;
    *first = only - 1;
}

static int grid_of(int samples) {
    int n = 1;
    while (n * n < samples) n++;
    return n;
}

void gi_record_end(const GiStage *stage, int samples) {
    GiRecord *record = stage->record;
    int n = grid_of(samples), i = (int)stage->sample;
    GiVec color = record->additions.count > 0 ? record->color : gi_vec(0, 0, 0);
    bool first = i == 0 || record->sink->only_sample > 0;
    record->sum = first ? color : gi_add(record->sum, color);
    record->samples = samples;
    if (record->out_of_memory) {
        stage->scratch->out_of_memory = true;
        atomic_store(stage->control->stop, true);
        return;
    }
    if (record->sink->sample == NULL) return;
    GlintExplainSample sample = {.x = (int)stage->x,
        .y = (int)stage->y,
        .sample = i,
        .samples = samples,
        .film_x = (i % n + 0.5) / n,
        .film_y = (i / n + 0.5) / n,
        .rays = record->rays.data,
        .layers = record->layers.data,
        .branches = record->branches.data,
        .lights = record->lights.data,
        .additions = record->additions.data,
        .ray_count = record->rays.count,
        .layer_count = record->layers.count,
        .branch_count = record->branches.count,
        .light_count = record->lights.count,
        .addition_count = record->additions.count};
    gi_record_vec(sample.color, color);
    gi_record_vec(sample.sum, record->sum);
    record->sink->sample(record->sink->user, &sample);
}
