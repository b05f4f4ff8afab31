/* SPDX-License-Identifier: MIT */
#include "brute.h"

#include "shape/hit.h"
#include "test.h"

#include <string.h>

static void collect(Fixture *fixture, const GiTree *tree, uint32_t instance);

static void add_thing(Fixture *fixture, GiShapeRef ref, uint32_t instance) {
    if (ref.bits == GI_SHAPE_NONE) return;
    if (gi_shape_kind(ref) == GI_SHAPE_INSTANCE) {
        uint32_t index = gi_shape_index(ref);
        CHECK(instance == GI_SHAPE_NONE);
        collect(fixture, fixture->world.shapes.instances[index].tree, index);
        return;
    }
    CHECK(gi_array_push(&fixture->memory, &fixture->things, (Thing){ref, instance}));
}

static void add_child(Fixture *fixture, const GiTree *tree, uint32_t child, uint32_t instance) {
    if (child == GI_CHILD_NONE) return;
    uint32_t index = gi_child_index(child);
    switch (gi_child_kind(child)) {
    case GI_CHILD_NODE: break;
    case GI_CHILD_TRIANGLES:
        for (uint32_t i = 0; i < gi_child_count(child); i++) {
            add_thing(
                fixture, gi_shape_ref(GI_SHAPE_TRIANGLE, gi_child_first(child) + i), instance);
        }
        break;
    case GI_CHILD_BOXES:
        for (int i = 0; i < 8; i++) {
            add_thing(fixture, tree->box_blocks[index].shape[i], instance);
        }
        break;
    case GI_CHILD_SPHERES:
        for (int i = 0; i < 8; i++) {
            add_thing(fixture, tree->sphere_blocks[index].shape[i], instance);
        }
    }
}

/* The order does not matter: ties go by document order. */
static void collect(Fixture *fixture, const GiTree *tree, uint32_t instance) {
    for (uint32_t i = 0; i < tree->unbounded_count; i++) {
        add_thing(fixture, tree->unbounded[i], instance);
    }
    add_child(fixture, tree, tree->root, instance);
    for (uint32_t i = 0; i < tree->node_count; i++) {
        for (int k = 0; k < 8; k++) add_child(fixture, tree, tree->nodes[i].child[k], instance);
    }
}

void fixture_commit(Fixture *fixture, const GiKernel *kernel) {
    GiScene *scene = &fixture->scene;
    scene->has_camera = scene->has_image = true;
    scene->width = scene->height = 16;
    GlintError error;
    CHECK_INT(gi_pool_create(&fixture->memory, 2, &fixture->pool), GLINT_OK);
    CHECK_INT(
        gi_world_commit(&fixture->world, scene, kernel, fixture->pool, NULL, &error), GLINT_OK);
    collect(fixture, &fixture->world.store.tree, GI_SHAPE_NONE);
}

void fixture_begin(Fixture *fixture, GlintDialect dialect) {
    memset(fixture, 0, sizeof *fixture);
    gi_memory_init(&fixture->memory, NULL, 0);
    CHECK(gi_scene_init(&fixture->scene, &fixture->memory));
    fixture->scene.dialect = dialect;
}

void fixture_end(Fixture *fixture) {
    gi_array_free(&fixture->memory, &fixture->things);
    gi_world_reset(&fixture->world, &fixture->memory);
    gi_pool_destroy(fixture->pool);
    gi_scene_reset(&fixture->scene);
    CHECK_INT(atomic_load(&fixture->memory.used), 0);
}

bool brute_force(const Fixture *fixture, const GiTraceRay *r, GiTraceHit *hit) {
    const GiShapes *shapes = &fixture->world.shapes;
    gi_hit_Ray ray = gi_hit_ray(
        r->origin.x, r->origin.y, r->origin.z, r->direction.x, r->direction.y, r->direction.z);
    *hit = (GiTraceHit){INFINITY, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    for (size_t i = 0; i < fixture->things.count; i++) {
        Thing thing = fixture->things.data[i];
        if (thing.ref.bits == r->skip && thing.instance == r->skip_instance) continue;
        gi_hit_Ray inner = ray;
        if (thing.instance != GI_SHAPE_NONE) {
            uint32_t transform = shapes->instances[thing.instance].transform;
            inner = gi_hit_to_object(&ray, &shapes->transforms[transform].to_object);
        }
        double t;
        if (!gi_hit_shape(shapes, thing.ref, &inner, r->t_min, r->t_max, &t)) continue;
        if (t < hit->t || (t == hit->t && gi_shape_before(shapes, thing.ref, thing.instance,
                                              hit->shape, hit->instance))) {
            *hit = (GiTraceHit){t, thing.ref, thing.instance};
        }
    }
    return hit->shape.bits != GI_SHAPE_NONE;
}

GiTraceRay ray_of_bundle(const GiBundle *bundle, bool any, int i) {
    if (!any) {
        return (GiTraceRay){bundle->apex, gi_bundle_direction(bundle, i), bundle->start,
            bundle->t[i], GI_SHAPE_NONE, GI_SHAPE_NONE};
    }
    GiVec origin = {bundle->ox[i], bundle->oy[i], bundle->oz[i]};
    return (GiTraceRay){origin, gi_sub(bundle->apex, origin), bundle->t_min[i], bundle->end,
        bundle->skip[i], bundle->skip_instance[i]};
}

void bundle_put_ray(GiBundle *bundle, int i, GiVec o, GiVec d, double t_min) {
    bundle->ox[i] = o.x, bundle->oy[i] = o.y, bundle->oz[i] = o.z;
    bundle->dx[i] = d.x, bundle->dy[i] = d.y, bundle->dz[i] = d.z;
    bundle->t_min[i] = t_min;
    bundle->t[i] = INFINITY;
    bundle->skip[i] = bundle->skip_instance[i] = GI_SHAPE_NONE;
}

int bundle_differs(const Fixture *fixture, const GiKernel *kernel, bool any, GiBundle *bundle) {
    static GiTraceRay rays[GI_BUNDLE_SIZE];
    int wrong = 0;
    for (int i = 0; i < bundle->count; i++) {
        bundle->t[i] = INFINITY;
        rays[i] = ray_of_bundle(bundle, any, i);
    }
    (any ? kernel->bundle_any : kernel->bundle_closest)(&fixture->world.trace, bundle);
    for (int i = 0; i < bundle->count; i++) {
        GiTraceHit hit;
        bool meets = brute_force(fixture, &rays[i], &hit);
        bool same = (bundle->shape[i] != GI_SHAPE_NONE) == meets;
        if (meets && !any) {
            same &= bundle->shape[i] == hit.shape.bits && bundle->instance[i] == hit.instance;
            same &= bundle->without_t || memcmp(&bundle->t[i], &hit.t, sizeof hit.t) == 0;
        }
        wrong += !same;
    }
    return wrong;
}
