/* SPDX-License-Identifier: MIT */
#include "render/world.h"

#include "base/error.h"
#include "render/reorder.h"

#include <string.h>

/* ---------------------------------------------------------------- groups */

/* A group being walked: its children under its world matrix. */
typedef struct OpenGroup {
    uint32_t group;
    size_t next;
    GiAffine to_world;
    uint32_t transform; /* index, or GI_SHAPE_NONE while no shape needed it */
} OpenGroup;

typedef GI_ARRAY(OpenGroup) OpenGroups;

enum { STEP_LIMIT = 1 << 26 }; /* children looked at while groups are spread out */

static GlintStatus place_shape(
    GiWorld *world, GiMemory *memory, OpenGroup *group, GiShapeRef ref, GlintError *error) {
    if (world->refs.count >= GI_SHAPE_INDEX_LIMIT) {
        return gi_error_set(error, GLINT_ERROR_SCENE,
            "the scene has more than 2^28 surfaces once its groups are spread out");
    }
    if (group == NULL || gi_affine_is_identity(&group->to_world)) {
        return gi_array_push(memory, &world->refs, ref) ? GLINT_OK : gi_error_memory(error);
    }
    if (group->transform == GI_SHAPE_NONE) {
        GiTransform transform = {.to_world = group->to_world};
        if (!gi_affine_invert(&transform.to_world, &transform.to_object)) {
            return gi_error_set(
                error, GLINT_ERROR_SCENE, "the transforms of nested groups are singular");
        }
        group->transform = (uint32_t)world->transforms.count;
        if (!gi_array_push(memory, &world->transforms, transform)) return gi_error_memory(error);
    }
    GiShapeRef placed = gi_shape_ref(GI_SHAPE_PLACED, (uint32_t)world->placements.count);
    if (!gi_array_push(memory, &world->placements, (GiPlacement){ref, group->transform}) ||
        !gi_array_push(memory, &world->refs, placed)) {
        return gi_error_memory(error);
    }
    return GLINT_OK;
}

static GlintStatus open_group(
    GiWorld *world, const GiScene *scene, OpenGroups *open, uint32_t index, GlintError *error) {
    OpenGroup group = {.group = index, .transform = GI_SHAPE_NONE};
    GiAffine own;
    if (!gi_scene_group_matrix(scene, &scene->groups.data[index], world->rules, &own)) {
        return gi_error_set(error, GLINT_ERROR_SCENE, "the transform of a group is singular");
    }
    group.to_world =
        open->count == 0 ? own : gi_affine_multiply(&open->data[open->count - 1].to_world, &own);
    return gi_array_push(scene->memory, open, group) ? GLINT_OK : gi_error_memory(error);
}

/* Depth first, in document order, with a stack on the heap: groups may nest to any depth. */
static GlintStatus spread_groups(
    GiWorld *world, const GiScene *scene, const GlintMonitor *monitor, GlintError *error) {
    GiMemory *memory = scene->memory;
    OpenGroups open = {0};
    GlintStatus status = GLINT_OK;
    size_t next_root = 0, steps = 0;
    while (status == GLINT_OK) {
        OpenGroup *top = open.count > 0 ? &open.data[open.count - 1] : NULL;
        const GiGroup *group = top != NULL ? &scene->groups.data[top->group] : NULL;
        GiShapeRef ref;
        if (top == NULL) {
            if (next_root == scene->roots.count) break;
            ref = scene->roots.data[next_root++];
        } else if (top->next == group->children.count) {
            open.count--;
            continue;
        } else {
            ref = group->children.data[top->next++];
        }
        /* Groups may refer to groups that refer to groups ...: a short file can ask for more than
         * any machine can do, even without a single shape. */
        if (++steps > STEP_LIMIT) {
            status = gi_error_set(error, GLINT_ERROR_SCENE,
                "groups refer to groups so often that more than %d places would be looked at",
                STEP_LIMIT);
            break;
        }
        status = gi_shape_kind(ref) == GI_SHAPE_GROUP
                     ? open_group(world, scene, &open, gi_shape_index(ref), error)
                     : place_shape(world, memory, top, ref, error);
        if ((steps & 0xffff) == 0 && monitor != NULL && monitor->cancelled != NULL &&
            monitor->cancelled(monitor->user)) {
            status = gi_error_set(error, GLINT_CANCELLED, "cancelled");
        }
    }
    gi_array_free(memory, &open);
    return status;
}

/* ---------------------------------------------------------------- commit */

/* Before and after the build, which itself asks only where it is large. False: to stop. */
static bool report(const GlintMonitor *monitor, double fraction) {
    if (monitor == NULL) return true;
    if (monitor->progress != NULL) monitor->progress(monitor->user, GLINT_PHASE_BUILD, fraction);
    return monitor->cancelled == NULL || !monitor->cancelled(monitor->user);
}

static void point_shapes(GiWorld *world, const GiScene *scene) {
    world->shapes = (GiShapes){
        .spheres = scene->spheres.data,
        .boxes = scene->boxes.data,
        .cones = scene->cones.data,
        .discs = scene->discs.data,
        .planes = scene->planes.data,
        .placements = world->placements.data,
        .transforms = world->transforms.data,
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
        if (!gi_array_push(scene->memory, &world->rectangles, rectangle)) {
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

GlintStatus gi_world_commit(GiWorld *world, GiScene *scene, const GiKernel *kernel, GiPool *pool,
    const GlintMonitor *monitor, GlintError *error) {
    memset(world, 0, sizeof *world);
    world->scene = scene;
    world->rules = gi_dialect_rules(scene->dialect);
    world->kernel = kernel;
    if (!report(monitor, 0)) return gi_error_set(error, GLINT_CANCELLED, "cancelled");
    for (size_t i = 0; i < scene->shaders.count; i++) {
        GiShader *shader = &scene->shaders.data[i];
        double diffuse = world->rules->default_diffuse;
        if (shader->type == GLINT_SHADER_LAMBERTIAN && !shader->diffuse_given) {
            shader->diffuse = gi_vec(diffuse, diffuse, diffuse);
        }
    }
    const GiShapeRef *refs = scene->roots.data;
    world->primitive_count = scene->roots.count;
    if (scene->groups.count > 0) {
        GlintStatus status = spread_groups(world, scene, monitor, error);
        if (status != GLINT_OK) return status;
        refs = world->refs.data;
        world->primitive_count = world->refs.count;
    }
    point_shapes(world, scene);
    GlintStatus status = gi_tree_build(
        scene->memory, pool, &world->shapes, refs, world->primitive_count, monitor, &world->store);
    if (status != GLINT_OK) {
        return status == GLINT_ERROR_MEMORY ? gi_error_memory(error)
                                            : gi_error_set(error, status, "cancelled");
    }
    status = prepare_lights(world, scene, error);
    if (status != GLINT_OK) return status;
    if (!report(monitor, 1)) return gi_error_set(error, GLINT_CANCELLED, "cancelled");
    gi_array_free(scene->memory, &world->refs);
    gi_array_free(scene->memory, &scene->roots);
    gi_reorder(scene, &world->store, world->placements.data, world->placements.count);
    point_shapes(world, scene);
    world->trace = (GiTrace){&world->store.tree, &world->shapes};
    world->view = gi_view_of(&scene->camera);
    /* The surface is not known yet, so the scene's size stands for its own. */
    world->eye_error =
        (gi_largest(world->view.eye) + 1 / world->store.tree.scale) * GI_SURFACE_ERROR;
    return GLINT_OK;
}

void gi_world_reset(GiWorld *world, GiMemory *memory) {
    gi_tree_free(memory, &world->store);
    gi_array_free(memory, &world->refs);
    gi_array_free(memory, &world->placements);
    gi_array_free(memory, &world->transforms);
    gi_array_free(memory, &world->rectangles);
    if (world->sky_lights) gi_environment_sampler_reset(&world->sky, memory);
}
