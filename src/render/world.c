/* SPDX-License-Identifier: MIT */
#include "render/world.h"

#include "base/error.h"
#include "render/reorder.h"

#include <string.h>

/* ---------------------------------------------------------------- commit */

/* Before and after the build, which itself asks only where it is large. False: to stop. */
static bool report(const GlintMonitor *monitor, double fraction) {
    if (monitor == NULL) return true;
    if (monitor->progress != NULL) monitor->progress(monitor->user, GLINT_PHASE_BUILD, fraction);
    return monitor->cancelled == NULL || !monitor->cancelled(monitor->user);
}

static void point_shapes(GiWorld *world, const GiScene *scene) {
    const GiMeshStore *meshes = &scene->meshes;
    world->shapes = (GiShapes){
        .spheres = scene->spheres.data,
        .boxes = scene->boxes.data,
        .cones = scene->cones.data,
        .discs = scene->discs.data,
        .planes = scene->planes.data,
        .rectangles = world->rectangles.data,
        .triangles =
            {
                .positions = (const float(*)[3])meshes->positions.data,
                .normals = (const float(*)[3])meshes->normals.data,
                .texcoords = (const float(*)[2])meshes->texcoords.data,
                .corners = (const uint32_t(*)[3])meshes->corners.data,
                .original = world->original,
            },
        .meshes = meshes->meshes.data,
        .mesh_count = (uint32_t)meshes->meshes.count,
        .mesh_info = world->spread.mesh_info,
        .placements = world->spread.placements.data,
        .transforms = world->spread.transforms.data,
        .instances = world->spread.instances.data,
        .entering_only = world->rules->entering_only,
    };
    for (int kind = 0; kind < GI_SHAPE_KIND_COUNT; kind++) {
        world->shapes.info[kind] = scene->info[kind].data;
    }
}

/* ---------------------------------------------------------------- lights */

static GlintStatus prepare_lights(GiWorld *world, const GiScene *scene, GlintError *error) {
    const GiRules *rules = world->rules;
    bool sampled = scene->integrator != GLINT_INTEGRATOR_POINT_LIGHT;
    for (size_t i = 0; i < scene->lights.count; i++) {
        const GiLight *light = &scene->lights.data[i];
        GiLightRectangle rectangle = {.area = 0};
        if (light->type == GLINT_LIGHT_RECTANGLE) {
            if (!gi_rectangle_init(&rectangle, light->position, light->direction, light->up,
                    light->width, light->height)) {
                return gi_error_set(
                    error, GLINT_ERROR_SCENE, "the upDir of a light is parallel to its normalDir");
            }
            if (rules->area_light_visible && sampled) world->has_large_lights = true;
        }
        if (!gi_array_push(scene->memory, &world->lights, rectangle)) {
            return gi_error_memory(error);
        }
    }
    world->sky_lights = rules->environment_lights && scene->environment.face > 0 && sampled;
    if (!world->sky_lights) return GLINT_OK;
    world->has_large_lights = true;
    return gi_environment_sampler_init(&world->sky, scene->memory, &scene->environment)
               ? GLINT_OK
               : gi_error_memory(error);
}

/* Lights that can be seen become rectangles of the scene, numbered after all surfaces. */
static bool add_light_rectangles(GiWorld *world, GiScene *scene) {
    GiShapeInfos *infos = &scene->info[GI_SHAPE_RECTANGLE];
    infos->count = 0;
    if (!world->rules->area_light_visible) return true;
    if (scene->integrator == GLINT_INTEGRATOR_POINT_LIGHT) return true;
    for (size_t i = 0; i < scene->lights.count; i++) {
        const GiLight *light = &scene->lights.data[i];
        if (light->type != GLINT_LIGHT_RECTANGLE) continue;
        GiVec w = gi_normalize(light->direction), u = gi_normalize(gi_cross(light->up, w));
        uint32_t index = (uint32_t)world->rectangles.count;
        GiRectangle rectangle = {light->position, gi_scale(u, light->width / 2),
            gi_scale(gi_cross(w, u), light->height / 2), w};
        GiShapeInfo info = {(uint32_t)i, scene->shape_count + index};
        if (!gi_array_push(scene->memory, &world->rectangles, rectangle) ||
            !gi_array_push(scene->memory, infos, info) ||
            !gi_array_push(scene->memory, &scene->roots, gi_shape_ref(GI_SHAPE_RECTANGLE, index))) {
            return false;
        }
    }
    return true;
}

/* The kernels read a position or a normal as four numbers (kernel/wide.h), so one more row follows
 * the last. */
static bool pad(GiMemory *memory, GiFloat3 **rows, size_t count, size_t *capacity) {
    if (*capacity > count) return true;
    GiFloat3 *data =
        gi_memory_resize(memory, *rows, count * sizeof *data, (count + 1) * sizeof *data);
    if (data == NULL) return false;
    *rows = data;
    *capacity = count + 1;
    return true;
}

static bool pad_meshes(GiScene *scene) {
    GiMeshStore *meshes = &scene->meshes;
    return pad(scene->memory, &meshes->positions.data, meshes->positions.count,
               &meshes->positions.capacity) &&
           pad(scene->memory, &meshes->normals.data, meshes->normals.count,
               &meshes->normals.capacity);
}

static GlintStatus prepare(
    GiWorld *world, GiScene *scene, const GlintMonitor *monitor, GlintError *error) {
    for (size_t i = 0; i < scene->shaders.count; i++) {
        GiShader *shader = &scene->shaders.data[i];
        double diffuse = world->rules->default_diffuse;
        if (shader->type == GLINT_SHADER_LAMBERTIAN && !shader->diffuse_given) {
            shader->diffuse = gi_vec(diffuse, diffuse, diffuse);
        }
    }
    if (scene->meshes.corners.count > GI_TRIANGLE_LIMIT) {
        return gi_error_set(
            error, GLINT_ERROR_SCENE, "the scene's meshes have more than 2^27 triangles");
    }
    if (!add_light_rectangles(world, scene)) return gi_error_memory(error);
    if (scene->meshes.corners.count > 0 && !pad_meshes(scene)) return gi_error_memory(error);
    return gi_spread(scene, world->rules, monitor, &world->spread, error);
}

/* ---------------------------------------------------------------- trees */

/* Several trees are built one after the other; what each reports is a part of the whole. */
typedef struct Part {
    const GlintMonitor *monitor;
    double begin, end;
} Part;

static void report_part(void *user, GlintPhase phase, double fraction) {
    const Part *part = user;
    part->monitor->progress(
        part->monitor->user, phase, part->begin + (part->end - part->begin) * fraction);
}

static bool part_cancelled(void *user) {
    const Part *part = user;
    return part->monitor->cancelled(part->monitor->user);
}

static GlintStatus build_tree(GiWorld *world, GiMemory *memory, GiPool *pool,
    const GiTreeInput *input, const GlintMonitor *monitor, size_t *done, GiTreeStore *store) {
    size_t count = input->ref_count;
    for (size_t i = 0; i < input->mesh_count; i++) {
        count += world->shapes.meshes[input->meshes[i]].triangle_count;
    }
    double all = world->primitive_count > 0 ? (double)world->primitive_count : 1;
    Part part = {monitor, (double)*done / all, (double)(*done + count) / all};
    GlintMonitor inner = {.user = &part};
    if (monitor != NULL && monitor->progress != NULL) inner.progress = report_part;
    if (monitor != NULL && monitor->cancelled != NULL) inner.cancelled = part_cancelled;
    *done += count;
    GlintStatus status = gi_tree_build(memory, pool, &world->shapes, input, &inner, store);
    if (status != GLINT_OK) return status;
    world->node_count += store->tree.node_count;
    world->leaf_count += store->leaf_count;
    world->tree_bytes += store->tree.node_count * sizeof(GiNode) +
                         store->tree.sphere_block_count * sizeof(GiSphereBlock) +
                         store->tree.box_block_count * sizeof(GiBoxBlock);
    return GLINT_OK;
}

/* First the trees of what instances share, whose bounds the scene's own tree needs. */
static GlintStatus build_trees(
    GiWorld *world, GiScene *scene, GiPool *pool, const GlintMonitor *monitor, uint32_t *placed) {
    GiSpread *spread = &world->spread;
    size_t done = 0;
    for (size_t i = 0; i < spread->contents.count; i++) {
        const GiContent *content = &spread->contents.data[i];
        GiTreeInput input = {.refs = content->count > 0 ? spread->all + content->first : NULL,
            .ref_count = content->count,
            .meshes = &content->mesh,
            .mesh_count = content->mesh != GI_NONE,
            .original = world->original,
            .placed = placed};
        GlintStatus status =
            build_tree(world, scene->memory, pool, &input, monitor, &done, &world->inner[i]);
        if (status != GLINT_OK) return status;
    }
    for (size_t i = 0; i < spread->instances.count; i++) {
        const GiTree *tree = &world->inner[spread->content_of.data[i]].tree;
        spread->instances.data[i].tree = tree;
        spread->instances.data[i].bounds = &tree->bounds;
    }
    GiTreeInput input = {.refs = spread->all,
        .ref_count = spread->ref_count,
        .meshes = spread->meshes.data,
        .mesh_count = spread->meshes.count,
        .original = world->original,
        .placed = placed};
    return build_tree(world, scene->memory, pool, &input, monitor, &done, &world->store);
}

static void count_primitives(GiWorld *world, const GiScene *scene) {
    const GiSpread *spread = &world->spread;
    world->primitive_count = spread->all_count;
    for (size_t i = 0; i < spread->meshes.count; i++) {
        world->primitive_count += scene->meshes.meshes.data[spread->meshes.data[i]].triangle_count;
    }
    for (size_t i = 0; i < spread->contents.count; i++) {
        uint32_t mesh = spread->contents.data[i].mesh;
        if (mesh == GI_NONE) continue;
        world->primitive_count += scene->meshes.meshes.data[mesh].triangle_count;
    }
}

static GlintStatus build(
    GiWorld *world, GiScene *scene, GiPool *pool, const GlintMonitor *monitor, GlintError *error) {
    GiMemory *memory = scene->memory;
    size_t meshes = scene->meshes.meshes.count, triangles = scene->meshes.corners.count;
    count_primitives(world, scene);
    GlintStatus status = GLINT_ERROR_MEMORY;
    uint32_t *placed = gi_memory_allocate(memory, meshes * sizeof *placed);
    if (triangles > 0) {
        world->original_count = triangles;
        world->original = gi_memory_allocate(memory, triangles * sizeof *world->original);
    }
    if (world->spread.contents.count > 0) {
        world->inner_count = world->spread.contents.count;
        world->inner = gi_memory_allocate(memory, world->inner_count * sizeof *world->inner);
    }
    if (world->inner != NULL) memset(world->inner, 0, world->inner_count * sizeof *world->inner);
    if ((world->inner != NULL || world->inner_count == 0) && (placed != NULL || meshes == 0) &&
        (world->original != NULL || triangles == 0)) {
        if (placed != NULL) memset(placed, 0, meshes * sizeof *placed);
        status = build_trees(world, scene, pool, monitor, placed);
    }
    if (status == GLINT_OK && !gi_reorder_triangles(scene, pool, world->original, placed)) {
        status = GLINT_ERROR_MEMORY;
    }
    gi_memory_free(memory, placed, meshes * sizeof *placed);
    if (status == GLINT_OK) return status;
    return status == GLINT_ERROR_MEMORY ? gi_error_memory(error)
                                        : gi_error_set(error, status, "cancelled");
}

/* ---------------------------------------------------------------- the whole */

GlintStatus gi_world_commit(GiWorld *world, GiScene *scene, const GiKernel *kernel, GiPool *pool,
    const GlintMonitor *monitor, GlintError *error) {
    memset(world, 0, sizeof *world);
    world->scene = scene;
    world->rules = gi_dialect_rules(scene->dialect);
    world->kernel = kernel;
    if (!report(monitor, 0)) return gi_error_set(error, GLINT_CANCELLED, "cancelled");
    GlintStatus status = prepare(world, scene, monitor, error);
    if (status != GLINT_OK) return status;
    point_shapes(world, scene);
    status = prepare_lights(world, scene, error);
    if (status == GLINT_OK) status = build(world, scene, pool, monitor, error);
    if (status != GLINT_OK) return status;
    if (!report(monitor, 1)) return gi_error_set(error, GLINT_CANCELLED, "cancelled");
    gi_spread_free_lists(&world->spread, scene);
    gi_array_free(scene->memory, &scene->roots);
    gi_reorder(scene, pool, world);
    point_shapes(world, scene);
    world->trace = (GiTrace){&world->store.tree, &world->shapes};
    world->view = gi_view_of(&scene->camera);
    return GLINT_OK;
}

double gi_world_eye_error(const GiWorld *world, GiVec eye) {
    /* The surface is not known yet, so the scene's size stands for its own. */
    return (gi_largest(eye) + 1 / world->store.tree.scale) * GI_SURFACE_ERROR;
}

void gi_world_reset(GiWorld *world, GiMemory *memory) {
    gi_tree_free(memory, &world->store);
    for (size_t i = 0; i < world->inner_count && world->inner != NULL; i++) {
        gi_tree_free(memory, &world->inner[i]);
    }
    gi_memory_free(memory, world->inner, world->inner_count * sizeof *world->inner);
    gi_memory_free(memory, world->original, world->original_count * sizeof *world->original);
    gi_array_free(memory, &world->rectangles);
    gi_array_free(memory, &world->lights);
    if (world->sky_lights) gi_environment_sampler_reset(&world->sky, memory);
    gi_spread_reset(&world->spread, world->scene);
    memset(world, 0, sizeof *world);
}
