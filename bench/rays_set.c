/* SPDX-License-Identifier: MIT */
#include "rays_set.h"

#include "message.h"
#include "render/stage.h"
#include "shade/lobe.h"

#include <stdlib.h>

/* What a camera ray met: the point beside the surface, and the normal toward the eye. */
typedef struct Found {
    GiVec point, normal;
    GiShapeRef shape;
    uint32_t instance;
    uint32_t x, y;
} Found;

typedef struct Maker {
    const GiWorld *world;
    RaySet *sets;
    double offset;
    Found found[GI_TILE_PIXELS]; /* of a tile */
    int found_count;
} Maker;

const char *rays_kind_name(RayKind kind) {
    static const char *const names[RAY_KIND_COUNT] = {"camera", "shadow", "bounce"};
    return names[kind];
}

void *rays_allocate(size_t count, size_t size) {
    void *memory = calloc(count > 0 ? count : 1, size);
    if (memory == NULL) message_fail("not enough memory");
    return memory;
}

static GiVec rounded(GiVec v) { return gi_vec((float)v.x, (float)v.y, (float)v.z); }

static void add_ray(RaySet *set, GiVec origin, GiVec direction, double t_min, double t_max) {
    set->rays[set->count++] =
        (GiTraceRay){origin, direction, t_min, t_max, GI_SHAPE_NONE, GI_SHAPE_NONE};
}

static void add_camera_ray(Maker *maker, uint32_t x, uint32_t y) {
    const GiWorld *world = maker->world;
    const GiScene *scene = world->scene;
    GiVec origin, direction;
    gi_view_ray(&world->view, (x + 0.5) / scene->width,
        (scene->height - 1 - (double)y + 0.5) / scene->height, &origin, &direction);
    RaySet *set = &maker->sets[RAYS_CAMERA];
    add_ray(set, origin, direction, gi_world_eye_error(world, world->view.eye), INFINITY);
    GiTraceHit hit;
    if (!world->kernel->closest(&world->trace, &set->rays[set->count - 1], &hit)) return;
    GiSurfacePoint at =
        gi_shape_point(&world->shapes, hit.shape, hit.instance, origin, direction, hit.t, true);
    GiVec normal = gi_dot(at.geometric, direction) > 0 ? gi_negate(at.geometric) : at.geometric;
    maker->found[maker->found_count++] = (Found){
        rounded(gi_along(at.point, normal, maker->offset)), normal, hit.shape, hit.instance, x, y};
}

/* What the renderer knows of a shadow ray: the shape it begins beside, and leaves. */
static void note_own(GiTraceRay *ray, const Found *found) {
    GiShapeKind kind = gi_shape_kind(found->shape);
    bool solid = kind <= GI_SHAPE_CONE, triangle = kind == GI_SHAPE_TRIANGLE;
    double along = gi_dot(ray->direction, found->normal);
    if (found->instance != GI_SHAPE_NONE || !(solid || triangle)) return;
    if (solid && !(along > 0x1p-5 * gi_length(ray->direction))) return;
    ray->skip = found->shape.bits;
    ray->skip_instance = triangle ? GI_LEFT : GI_SHAPE_NONE;
}

static void add_shadow_rays(Maker *maker, GiVec light) {
    RaySet *set = &maker->sets[RAYS_SHADOW];
    RayPart part = {.first = set->count, .light = light};
    for (int i = 0; i < maker->found_count; i++) {
        const Found *found = &maker->found[i];
        GiVec direction = gi_sub(light, found->point);
        if (!(gi_dot(direction, found->normal) > 0)) continue;
        add_ray(set, found->point, direction, 0, 1);
        note_own(&set->rays[set->count - 1], found);
    }
    part.count = (int)(set->count - part.first);
    if (part.count > 0) set->parts[set->part_count++] = part;
}

static void add_bounces(Maker *maker) {
    for (int i = 0; i < maker->found_count; i++) {
        const Found *found = &maker->found[i];
        GiSampler sampler = gi_sampler(found->x, found->y, 0);
        double u[2];
        gi_sample_2d(&sampler, 0, u);
        GiVec direction = rounded(gi_lobe_cosine_draw(found->normal, u[0], u[1]));
        add_ray(&maker->sets[RAYS_BOUNCE], found->point, direction, 0, INFINITY);
    }
}

/* The pixel of a square that comes at a place of the order: Z within Z (Morton). */
static uint32_t every_second_bit(uint32_t place) {
    uint32_t bits = 0;
    for (int i = 0; i < 16; i++) bits |= (place >> 2 * i & 1) << i;
    return bits;
}

static void add_tile(Maker *maker, int tile_x, int tile_y) {
    const GiScene *scene = maker->world->scene;
    maker->found_count = 0;
    for (uint32_t place = 0; place < GI_TILE_PIXELS; place++) {
        uint32_t x = (uint32_t)tile_x + every_second_bit(place);
        uint32_t y = (uint32_t)tile_y + every_second_bit(place >> 1);
        if (x < (uint32_t)scene->width && y < (uint32_t)scene->height) add_camera_ray(maker, x, y);
    }
    for (size_t i = 0; i < scene->lights.count; i++) {
        const GiLight *light = &scene->lights.data[i];
        if (light->type == GLINT_LIGHT_POINT) add_shadow_rays(maker, light->position);
    }
    add_bounces(maker);
}

void rays_make(const GiWorld *world, RaySet sets[RAY_KIND_COUNT]) {
    const GiScene *scene = world->scene;
    size_t pixels = (size_t)scene->width * (size_t)scene->height, lights = 0;
    for (size_t i = 0; i < scene->lights.count; i++) {
        lights += scene->lights.data[i].type == GLINT_LIGHT_POINT;
    }
    size_t columns = ((size_t)scene->width + GI_TILE_STRIDE - 1) / GI_TILE_STRIDE;
    size_t rows = ((size_t)scene->height + GI_TILE_STRIDE - 1) / GI_TILE_STRIDE;
    for (int kind = 0; kind < RAY_KIND_COUNT; kind++) {
        size_t room = kind == RAYS_SHADOW ? pixels * lights : pixels;
        sets[kind] =
            (RaySet){.kind = (RayKind)kind, .rays = rays_allocate(room, sizeof(GiTraceRay))};
    }
    sets[RAYS_SHADOW].parts = rays_allocate(columns * rows * lights, sizeof(RayPart));
    Maker *maker = rays_allocate(1, sizeof *maker);
    maker->world = world;
    maker->sets = sets;
    maker->offset = 0x1p-17 / world->store.tree.scale;
    for (int y = 0; y < scene->height; y += GI_TILE_STRIDE) {
        for (int x = 0; x < scene->width; x += GI_TILE_STRIDE) add_tile(maker, x, y);
    }
    free(maker);
}

void rays_free(RaySet sets[RAY_KIND_COUNT]) {
    for (int kind = 0; kind < RAY_KIND_COUNT; kind++) {
        free(sets[kind].rays);
        free(sets[kind].parts);
    }
}
