/* SPDX-License-Identifier: MIT */
#include "render/spread.h"

#include "base/error.h"

#include <string.h>

enum { STEP_LIMIT = 1 << 26 }; /* children looked at while groups are spread out */

/* Groups may refer to groups that refer to groups ...: counts stay where they cannot grow. */
#define MANY (UINT64_C(1) << 62)

static uint64_t add(uint64_t a, uint64_t b) { return a + b < MANY ? a + b : MANY; }

typedef struct Facts {
    uint64_t size;  /* shapes it spreads out to */
    uint64_t steps; /* children looked at on the way */
    uint64_t uses;  /* how often it is opened when the whole is spread out */
    uint32_t content;
    bool mesh;     /* there is one in it */
    bool instance; /* it is not opened but becomes one */
    bool large;    /* there is a group in it that could be one */
    bool known;
} Facts;

/* A group being walked: its children under its matrix. */
typedef struct OpenGroup {
    uint32_t group;
    size_t next;
    GiAffine to_world;
    uint32_t transform; /* index, or GI_NONE while nothing needed it */
} OpenGroup;

typedef struct Walk {
    const GiScene *scene;
    const GiRules *rules;
    const GlintMonitor *monitor;
    GiSpread *spread;
    GlintError *error;
    Facts *groups;          /* parallel to the scene's */
    uint64_t *mesh_uses;    /* parallel to the scene's meshes */
    uint32_t *mesh_content; /* the same; GI_NONE while there is none */
    uint32_t *order;        /* of groups: those inside before those outside */
    size_t order_count, steps;
    GI_ARRAY(OpenGroup) open;
} Walk;

/* ---------------------------------------------------------------- what is worth an instance */

typedef struct Visit {
    uint32_t group;
    size_t next;
} Visit;

static void learn(Walk *walk, uint32_t index) {
    const GiGroup *group = &walk->scene->groups.data[index];
    Facts *facts = &walk->groups[index];
    facts->content = GI_NONE;
    for (size_t i = 0; i < group->children.count; i++) {
        GiShapeRef ref = group->children.data[i];
        facts->steps = add(facts->steps, 1);
        if (gi_shape_kind(ref) != GI_SHAPE_GROUP) {
            facts->size = add(facts->size, 1);
            facts->mesh |= gi_shape_kind(ref) == GI_SHAPE_MESH;
            continue;
        }
        const Facts *child = &walk->groups[gi_shape_index(ref)];
        facts->size = add(facts->size, child->size);
        facts->steps = add(facts->steps, child->steps);
        facts->mesh |= child->mesh;
        facts->large |= child->large || (child->size > GI_SPREAD_LIMIT && !child->mesh);
    }
    facts->known = true;
    walk->order[walk->order_count++] = index;
}

/* Groups may nest to any depth, so the stack is on the heap. */
static bool learn_below(Walk *walk, uint32_t root) {
    GiMemory *memory = walk->scene->memory;
    GI_ARRAY(Visit) stack = {0};
    bool done = gi_array_push(memory, &stack, (Visit){root, 0});
    while (done && stack.count > 0) {
        Visit *top = &stack.data[stack.count - 1];
        const GiGroup *group = &walk->scene->groups.data[top->group];
        if (walk->groups[top->group].known || top->next == group->children.count) {
            if (!walk->groups[top->group].known) learn(walk, top->group);
            stack.count--;
            continue;
        }
        GiShapeRef ref = group->children.data[top->next++];
        if (gi_shape_kind(ref) != GI_SHAPE_GROUP) continue;
        uint32_t child = gi_shape_index(ref);
        if (!walk->groups[child].known) done = gi_array_push(memory, &stack, (Visit){child, 0});
    }
    gi_array_free(memory, &stack);
    return done;
}

static void use(Walk *walk, GiShapeRef ref, uint64_t times) {
    uint32_t index = gi_shape_index(ref);
    if (gi_shape_kind(ref) == GI_SHAPE_GROUP) {
        walk->groups[index].uses = add(walk->groups[index].uses, times);
    } else if (gi_shape_kind(ref) == GI_SHAPE_MESH) {
        uint32_t mesh = walk->scene->mesh_surfaces.data[index].mesh;
        walk->mesh_uses[mesh] = add(walk->mesh_uses[mesh], times);
    }
}

/* Counts, decides, and refuses what would never end. */
static GlintStatus plan(Walk *walk) {
    const GiScene *scene = walk->scene;
    for (size_t i = 0; i < scene->roots.count; i++) {
        GiShapeRef ref = scene->roots.data[i];
        if (gi_shape_kind(ref) == GI_SHAPE_GROUP && !learn_below(walk, gi_shape_index(ref))) {
            return gi_error_memory(walk->error);
        }
    }
    uint64_t steps = scene->roots.count;
    for (size_t i = 0; i < scene->roots.count; i++) use(walk, scene->roots.data[i], 1);
    for (size_t k = walk->order_count; k-- > 0;) {
        Facts *facts = &walk->groups[walk->order[k]];
        if (facts->uses == 0) continue; /* only in instances */
        const GiGroup *group = &scene->groups.data[walk->order[k]];
        bool balanced = facts->size / GI_SPREAD_LIMIT <= facts->uses;
        facts->instance = facts->uses > 1 && facts->size > GI_SPREAD_LIMIT && !facts->mesh &&
                          (balanced || !facts->large);
        if (facts->instance) {
            steps = add(steps, facts->steps);
            continue;
        }
        for (size_t i = 0; i < group->children.count; i++) {
            use(walk, group->children.data[i], facts->uses);
            steps = add(steps, facts->uses);
        }
    }
    if (steps <= STEP_LIMIT) return GLINT_OK;
    return gi_error_set(walk->error, GLINT_ERROR_SCENE,
        "groups refer to groups so often that more than %d places would be looked at", STEP_LIMIT);
}

/* ---------------------------------------------------------------- the walk */

static GlintStatus add_transform(Walk *walk, const GiAffine *to_world, uint32_t *index) {
    GiTransform transform = {.to_world = *to_world};
    if (!gi_affine_invert(&transform.to_world, &transform.to_object)) {
        return gi_error_set(
            walk->error, GLINT_ERROR_SCENE, "the transforms of nested groups are singular");
    }
    *index = (uint32_t)walk->spread->transforms.count;
    return gi_array_push(walk->scene->memory, &walk->spread->transforms, transform)
               ? GLINT_OK
               : gi_error_memory(walk->error);
}

/* The transform of the innermost open group; of the scene itself the identity. */
static GlintStatus need_transform(Walk *walk, uint32_t *index) {
    if (walk->open.count == 0) return add_transform(walk, &gi_affine_identity, index);
    OpenGroup *top = &walk->open.data[walk->open.count - 1];
    if (top->transform == GI_NONE) {
        GlintStatus status = add_transform(walk, &top->to_world, &top->transform);
        if (status != GLINT_OK) return status;
    }
    *index = top->transform;
    return GLINT_OK;
}

static bool at_identity(const Walk *walk) {
    return walk->open.count == 0 ||
           gi_affine_is_identity(&walk->open.data[walk->open.count - 1].to_world);
}

static GlintStatus place_shape(Walk *walk, GiShapeRef ref) {
    GiMemory *memory = walk->scene->memory;
    GiSpread *spread = walk->spread;
    if (spread->refs.count >= GI_SHAPE_INDEX_LIMIT) {
        return gi_error_set(walk->error, GLINT_ERROR_SCENE,
            "the scene has more than 2^28 surfaces once its groups are spread out");
    }
    if (!at_identity(walk)) {
        uint32_t transform;
        GlintStatus status = need_transform(walk, &transform);
        if (status != GLINT_OK) return status;
        GiPlacement placement = {ref, transform};
        ref = gi_shape_ref(GI_SHAPE_PLACED, (uint32_t)spread->placements.count);
        if (!gi_array_push(memory, &spread->placements, placement)) {
            return gi_error_memory(walk->error);
        }
    }
    return gi_array_push(memory, &spread->refs, ref) ? GLINT_OK : gi_error_memory(walk->error);
}

/* *content: of the mesh or group; set here when it has none yet. */
static GlintStatus place_instance(
    Walk *walk, uint32_t transform, GiContent of, GiShapeInfo info, uint32_t *content) {
    GiMemory *memory = walk->scene->memory;
    GiSpread *spread = walk->spread;
    if (*content == GI_NONE) {
        *content = (uint32_t)spread->contents.count;
        if (!gi_array_push(memory, &spread->contents, of)) return gi_error_memory(walk->error);
    }
    GiInstance instance = {.info = info, .transform = transform};
    GiShapeRef ref = gi_shape_ref(GI_SHAPE_INSTANCE, (uint32_t)spread->instances.count);
    if (!gi_array_push(memory, &spread->instances, instance) ||
        !gi_array_push(memory, &spread->content_of, *content) ||
        !gi_array_push(memory, &spread->refs, ref)) {
        return gi_error_memory(walk->error);
    }
    return GLINT_OK;
}

static GlintStatus place_mesh(Walk *walk, const GiMeshSurface *surface) {
    uint32_t mesh = surface->mesh;
    if (walk->mesh_uses[mesh] == 1 && at_identity(walk)) {
        walk->spread->mesh_info[mesh] = surface->info;
        return gi_array_push(walk->scene->memory, &walk->spread->meshes, mesh)
                   ? GLINT_OK
                   : gi_error_memory(walk->error);
    }
    uint32_t transform;
    GlintStatus status = need_transform(walk, &transform);
    if (status != GLINT_OK) return status;
    GiContent of = {.mesh = mesh, .group = GI_NONE};
    return place_instance(walk, transform, of, surface->info, &walk->mesh_content[mesh]);
}

static GlintStatus open_group(Walk *walk, uint32_t index, bool inside) {
    const GiScene *scene = walk->scene;
    OpenGroup group = {.group = index, .transform = GI_NONE};
    GiAffine own;
    if (!gi_scene_group_matrix(scene, &scene->groups.data[index], walk->rules, &own)) {
        return gi_error_set(walk->error, GLINT_ERROR_SCENE, "the transform of a group is singular");
    }
    size_t depth = walk->open.count;
    group.to_world =
        depth == 0 ? own : gi_affine_multiply(&walk->open.data[depth - 1].to_world, &own);
    Facts *facts = &walk->groups[index];
    if (inside || !facts->instance) {
        return gi_array_push(scene->memory, &walk->open, group) ? GLINT_OK
                                                                : gi_error_memory(walk->error);
    }
    uint32_t transform;
    GlintStatus status = add_transform(walk, &group.to_world, &transform);
    if (status != GLINT_OK) return status;
    GiContent of = {.mesh = GI_NONE, .group = index};
    return place_instance(walk, transform, of, (GiShapeInfo){0}, &facts->content);
}

static GlintStatus place(Walk *walk, GiShapeRef ref, bool inside) {
    uint32_t index = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_GROUP: return open_group(walk, index, inside);
    case GI_SHAPE_MESH: return place_mesh(walk, &walk->scene->mesh_surfaces.data[index]);
    default: return place_shape(walk, ref);
    }
}

/* Depth first, in document order. `inside` a content all groups are opened. */
static GlintStatus walk_children(
    Walk *walk, const GiShapeRef *children, size_t count, bool inside) {
    GlintStatus status = GLINT_OK;
    for (size_t next_child = 0; status == GLINT_OK;) {
        OpenGroup *top = walk->open.count > 0 ? &walk->open.data[walk->open.count - 1] : NULL;
        const GiGroup *group = top != NULL ? &walk->scene->groups.data[top->group] : NULL;
        if (top == NULL && next_child == count) break;
        if (top != NULL && top->next == group->children.count) {
            walk->open.count--;
            continue;
        }
        status = place(
            walk, top == NULL ? children[next_child++] : group->children.data[top->next++], inside);
        const GlintMonitor *monitor = walk->monitor;
        if ((++walk->steps & 0xffff) == 0 && monitor != NULL && monitor->cancelled != NULL &&
            monitor->cancelled(monitor->user)) {
            status = gi_error_set(walk->error, GLINT_CANCELLED, "cancelled");
        }
    }
    return status;
}

/* Contents of groups, spread out relative to the group; meshes are as they are. */
static GlintStatus walk_contents(Walk *walk) {
    GiSpread *spread = walk->spread;
    GlintStatus status = GLINT_OK;
    size_t outside = spread->refs.count;
    for (size_t i = 0; i < spread->contents.count && status == GLINT_OK; i++) {
        GiContent *content = &spread->contents.data[i];
        if (content->group == GI_NONE) continue;
        const GiGroup *group = &walk->scene->groups.data[content->group];
        content->first = spread->refs.count;
        status = walk_children(walk, group->children.data, group->children.count, true);
        content->count = spread->refs.count - content->first;
    }
    spread->all = spread->refs.data;
    spread->all_count = spread->refs.count;
    spread->ref_count = outside;
    return status;
}

static bool allocate(Walk *walk) {
    const GiScene *scene = walk->scene;
    GiMemory *memory = scene->memory;
    size_t groups = scene->groups.count, meshes = scene->meshes.meshes.count;
    walk->groups = gi_memory_allocate(memory, groups * sizeof *walk->groups);
    walk->order = gi_memory_allocate(memory, groups * sizeof *walk->order);
    walk->mesh_uses = gi_memory_allocate(memory, meshes * sizeof *walk->mesh_uses);
    walk->mesh_content = gi_memory_allocate(memory, meshes * sizeof *walk->mesh_content);
    GiShapeInfo *info = gi_memory_allocate(memory, meshes * sizeof *info);
    walk->spread->mesh_info = info;
    if (groups > 0 && (walk->groups == NULL || walk->order == NULL)) return false;
    if (meshes > 0 && (walk->mesh_uses == NULL || walk->mesh_content == NULL || info == NULL)) {
        return false;
    }
    if (groups > 0) memset(walk->groups, 0, groups * sizeof *walk->groups);
    for (size_t i = 0; i < meshes; i++) {
        walk->mesh_uses[i] = 0;
        walk->mesh_content[i] = GI_NONE;
        info[i] = (GiShapeInfo){0};
    }
    return true;
}

GlintStatus gi_spread(const GiScene *scene, const GiRules *rules, const GlintMonitor *monitor,
    GiSpread *spread, GlintError *error) {
    memset(spread, 0, sizeof *spread);
    if (scene->groups.count == 0 && scene->mesh_surfaces.count == 0) {
        spread->all = scene->roots.data;
        spread->ref_count = spread->all_count = scene->roots.count;
        return GLINT_OK;
    }
    Walk walk = {
        .scene = scene, .rules = rules, .monitor = monitor, .spread = spread, .error = error};
    GlintStatus status = allocate(&walk) ? plan(&walk) : gi_error_memory(error);
    if (status == GLINT_OK) {
        status = walk_children(&walk, scene->roots.data, scene->roots.count, false);
    }
    if (status == GLINT_OK) status = walk_contents(&walk);
    GiMemory *memory = scene->memory;
    size_t groups = scene->groups.count, meshes = scene->meshes.meshes.count;
    gi_memory_free(memory, walk.groups, groups * sizeof *walk.groups);
    gi_memory_free(memory, walk.order, groups * sizeof *walk.order);
    gi_memory_free(memory, walk.mesh_uses, meshes * sizeof *walk.mesh_uses);
    gi_memory_free(memory, walk.mesh_content, meshes * sizeof *walk.mesh_content);
    gi_array_free(memory, &walk.open);
    return status;
}

void gi_spread_free_lists(GiSpread *spread, const GiScene *scene) {
    spread->all = NULL;
    gi_array_free(scene->memory, &spread->refs);
    gi_array_free(scene->memory, &spread->meshes);
    gi_array_free(scene->memory, &spread->contents);
    gi_array_free(scene->memory, &spread->content_of);
}

void gi_spread_reset(GiSpread *spread, const GiScene *scene) {
    if (scene == NULL) return;
    gi_spread_free_lists(spread, scene);
    gi_array_free(scene->memory, &spread->instances);
    gi_array_free(scene->memory, &spread->placements);
    gi_array_free(scene->memory, &spread->transforms);
    gi_memory_free(
        scene->memory, spread->mesh_info, scene->meshes.meshes.count * sizeof *spread->mesh_info);
    spread->mesh_info = NULL;
}
