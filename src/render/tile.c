/* SPDX-License-Identifier: MIT */
#include "render/tile.h"

#include "render/regroup.h"
#include "shade/shade.h"

enum {
    BLOCK_SIDE = 32, /* a bundle of camera rays: 32 x 32 pixels */
    PACKET_SIDE = 4, /* a packet: 4 x 4 */
    PACKETS_ACROSS = BLOCK_SIDE / PACKET_SIDE,
    STRIDE = GI_TILE_SIDE_LIMIT,
    PIXEL_COUNT = STRIDE * STRIDE
};

/* A camera ray that met something. */
typedef struct Hit {
    GiVec point, normal, toward_viewer;
    double error; /* distance within which a ray from here might meet its own surface */
    uint32_t pixel, shader;
    uint32_t skip, skip_instance; /* what shadow rays from here do not meet */
} Hit;

/* What a light will add to a hit unless something is in between: one struct with all that the
 * shadow ray needs, because rays are taken in another order than hits. */
typedef struct Pending {
    GiVec point, light;
    double t_min; /* of the ray from the point to the light, whose t is 1 there */
    uint32_t pixel, skip, skip_instance;
} Pending;

struct GiTileScratch {
    GiBundle bundle;
    GiRegroup regroup;
    Hit hits[PIXEL_COUNT];
    Pending pending[PIXEL_COUNT];
    double across[STRIDE], up[STRIDE]; /* window coordinates of columns and rows */
    GiVec color[PIXEL_COUNT];          /* of the sample being drawn */
    GiVec sum[PIXEL_COUNT];            /* of the samples before */
    int hit_count;
};

GiTileScratch *gi_tile_scratch_create(GiMemory *memory) {
    GiTileScratch *scratch = gi_memory_allocate_lines(memory, 1, sizeof *scratch);
    if (scratch != NULL) gi_regroup_init(&scratch->regroup);
    return scratch;
}

void gi_tile_scratch_destroy(GiMemory *memory, GiTileScratch *scratch) {
    gi_memory_free_lines(memory, scratch, 1, sizeof(GiTileScratch));
}

/* The tile's pixels that lie in the area. */
typedef struct Extent {
    int x, y, width, height;
} Extent;

/* ---------------------------------------------------------------- camera rays */

static bool stopped(const GiTileControl *control) {
    const GlintMonitor *monitor = control->monitor;
    if (monitor != NULL && monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
        atomic_store(control->stop, true);
    }
    return atomic_load_explicit(control->stop, memory_order_relaxed);
}

/* The same for the kernels. */
static bool ask(const void *control) { return stopped(control); }

static void keep_hit(const GiWorld *world, GiTileScratch *scratch, int i, uint32_t pixel) {
    const GiBundle *bundle = &scratch->bundle;
    GiShapeRef ref = {bundle->shape[i]};
    GiVec origin = {bundle->ox[i], bundle->oy[i], bundle->oz[i]};
    GiVec direction = {bundle->dx[i], bundle->dy[i], bundle->dz[i]};
    uint32_t instance = bundle->instance[i];
    GiSurfacePoint at = gi_shape_point(&world->shapes, ref, instance, origin, direction,
        bundle->t[i], world->rules->cone_geometric);
    GiShapeRef own = gi_shape_unplaced(&world->shapes, ref);
    bool skip = !world->rules->sphere_shadows_itself && gi_shape_kind(own) == GI_SHAPE_SPHERE;
    uint32_t shader = gi_shape_info(&world->shapes, ref, instance)->shader;
    scratch->hits[scratch->hit_count++] = (Hit){at.point, at.normal, gi_negate(direction), at.error,
        pixel, shader, skip ? ref.bits : GI_SHAPE_NONE, instance};
    scratch->color[pixel] = gi_shade_emit(&world->scene->shaders.data[shader], at.normal);
}

/* The rays of a parallel camera have no point in common. */
static void trace_apart(const GiWorld *world, GiBundle *bundle, const GiTileControl *control) {
    for (int i = 0; i < bundle->count; i++) {
        bundle->shape[i] = GI_SHAPE_NONE;
        if (i % 16 == 0 && stopped(control)) continue;
        GiTraceRay ray = {{bundle->ox[i], bundle->oy[i], bundle->oz[i]},
            {bundle->dx[i], bundle->dy[i], bundle->dz[i]}, bundle->t_min[i], bundle->t_max[i],
            bundle->skip[i], bundle->skip_instance[i]};
        GiTraceHit hit;
        bool any = world->kernel->closest(&world->trace, &ray, &hit);
        bundle->shape[i] = any ? hit.shape.bits : GI_SHAPE_NONE;
        if (!any) continue;
        bundle->t[i] = hit.t;
        bundle->instance[i] = hit.instance;
    }
}

/* One bundle: the pixels of a block, packet by packet. */
static void trace_block(const GiWorld *world, const Extent *extent, int block_x, int block_y,
    GiTileScratch *scratch, const GiTileControl *control) {
    GiBundle *bundle = &scratch->bundle;
    uint32_t pixels[GI_BUNDLE_SIZE];
    int count = 0;
    for (int packet = 0; packet < GI_PACKET_COUNT; packet++) {
        int packet_x = block_x + packet % PACKETS_ACROSS * PACKET_SIDE;
        int packet_y = block_y + packet / PACKETS_ACROSS * PACKET_SIDE;
        for (int i = 0; i < GI_PACKET_SIZE; i++) {
            int x = packet_x + i % PACKET_SIDE, y = packet_y + i / PACKET_SIDE;
            if (x >= extent->width || y >= extent->height) continue;
            GiVec origin, direction;
            gi_view_ray(&world->view, scratch->across[x], scratch->up[y], &origin, &direction);
            bundle->ox[count] = origin.x, bundle->oy[count] = origin.y,
            bundle->oz[count] = origin.z;
            bundle->dx[count] = direction.x, bundle->dy[count] = direction.y;
            bundle->dz[count] = direction.z;
            bundle->t_min[count] = world->eye_error;
            bundle->t_max[count] = INFINITY;
            bundle->skip[count] = bundle->skip_instance[count] = GI_SHAPE_NONE;
            pixels[count++] = (uint32_t)(y * STRIDE + x);
        }
    }
    if (count == 0) return;
    bundle->count = count;
    bundle->apex = world->view.eye;
    bundle->side = world->view.across;
    bundle->stop = ask;
    bundle->stop_context = control;
    if (world->view.parallel) {
        trace_apart(world, bundle, control);
    } else {
        world->kernel->bundle_closest(&world->trace, bundle);
    }
    for (int i = 0; i < count; i++) {
        if (bundle->shape[i] != GI_SHAPE_NONE) {
            keep_hit(world, scratch, i, pixels[i]);
        } else {
            scratch->color[pixels[i]] = world->scene->back_color;
        }
    }
}

/* ---------------------------------------------------------------- lights */

/* Traces the shadow rays, in an order of the kernels' liking, and adds what arrives. */
static void trace_pending(const GiWorld *world, const GiLight *light, int count,
    GiTileScratch *scratch, const GiTileControl *control) {
    GiBundle *bundle = &scratch->bundle;
    gi_regroup(&scratch->regroup, count);
    for (int begin = 0; begin < count && !stopped(control); begin += GI_BUNDLE_SIZE) {
        const uint16_t *order = scratch->regroup.order + begin;
        bundle->count = count - begin < GI_BUNDLE_SIZE ? count - begin : GI_BUNDLE_SIZE;
        bundle->apex = light->position;
        bundle->side = gi_vec(0, 0, 0);
        bundle->stop = ask;
        bundle->stop_context = control;
        for (int i = 0; i < bundle->count; i++) {
            const Pending *pending = &scratch->pending[order[i]];
            bundle->ox[i] = pending->point.x;
            bundle->oy[i] = pending->point.y;
            bundle->oz[i] = pending->point.z;
            bundle->dx[i] = light->position.x - pending->point.x;
            bundle->dy[i] = light->position.y - pending->point.y;
            bundle->dz[i] = light->position.z - pending->point.z;
            bundle->t_min[i] = pending->t_min;
            bundle->t_max[i] = 1;
            bundle->skip[i] = pending->skip;
            bundle->skip_instance[i] = pending->skip_instance;
        }
        world->kernel->bundle_any(&world->trace, bundle);
        for (int i = 0; i < bundle->count; i++) {
            if (bundle->shape[i] != GI_SHAPE_NONE) continue;
            const Pending *pending = &scratch->pending[order[i]];
            GiVec *color = &scratch->color[pending->pixel];
            *color = gi_add(*color, pending->light);
        }
    }
}

static void add_ambient(const GiWorld *world, const GiLight *light, GiTileScratch *scratch) {
    for (int i = 0; i < scratch->hit_count; i++) {
        const Hit *hit = &scratch->hits[i];
        const GiShader *shader = &world->scene->shaders.data[hit->shader];
        GiVec *color = &scratch->color[hit->pixel];
        *color = gi_add(*color, gi_shade_ambient(shader, light, hit->normal));
    }
}

/* Adds one point light to all hits. */
static void add_light(const GiWorld *world, const GiLight *light, GiTileScratch *scratch,
    GiRenderCounts *counts, const GiTileControl *control) {
    const GiRules *rules = world->rules;
    GiRegroup *regroup = &scratch->regroup;
    int count = 0;
    for (int i = 0; i < scratch->hit_count; i++) {
        const Hit *hit = &scratch->hits[i];
        GiVec d = gi_sub(light->position, hit->point);
        double square = gi_dot(d, d);
        if (!(square > 0)) continue; /* the light is on the surface */
        double inverse = 1 / sqrt(square);
        const GiShader *shader = &world->scene->shaders.data[hit->shader];
        GiVec factor =
            gi_shade_reflect(shader, rules, hit->normal, hit->toward_viewer, gi_scale(d, inverse));
        GiVec adds = gi_multiply(gi_shade_light(light, rules, square), factor);
        if (gi_vec_is_zero(adds)) continue;
        double away = rules->shadow_distance > 0 ? rules->shadow_distance : hit->error;
        scratch->pending[count] =
            (Pending){hit->point, adds, away * inverse, hit->pixel, hit->skip, hit->skip_instance};
        /* Of unit length, since scenes may be larger or smaller than a float can be. */
        regroup->x[count] = (float)(d.x * inverse);
        regroup->y[count] = (float)(d.y * inverse);
        regroup->z[count] = (float)(d.z * inverse);
        count++;
    }
    if (count > 0) trace_pending(world, light, count, scratch, control);
    counts->shadow_rays += (uint64_t)count;
}

/* ---------------------------------------------------------------- the tile */

/* One of the n x n samples of every pixel. */
static void draw_sample(const GiWorld *world, const GiRenderArea *area, const Extent *extent,
    double offset_x, double offset_y, GiTileScratch *scratch, GiRenderCounts *counts,
    const GiTileControl *control) {
    scratch->hit_count = 0;
    for (int x = 0; x < extent->width; x++) {
        scratch->across[x] = (extent->x + x + offset_x) / area->width;
    }
    for (int y = 0; y < extent->height; y++) {
        /* Rows of the picture run down, the window's coordinate runs up. */
        scratch->up[y] = (area->height - 1 - (extent->y + y) + offset_y) / area->height;
    }
    for (int y = 0; y < extent->height; y += BLOCK_SIDE) {
        for (int x = 0; x < extent->width; x += BLOCK_SIDE) {
            if (stopped(control)) return;
            trace_block(world, extent, x, y, scratch, control);
        }
    }
    counts->camera_rays += (uint64_t)extent->width * (uint64_t)extent->height;
    const GiScene *scene = world->scene;
    for (size_t i = 0; i < scene->lights.count && !stopped(control); i++) {
        const GiLight *light = &scene->lights.data[i];
        if (light->type == GLINT_LIGHT_POINT) {
            add_light(world, light, scratch, counts, control);
        } else {
            add_ambient(world, light, scratch);
        }
    }
}

void gi_tile_draw(const GiWorld *world, const GiRenderArea *area, int x, int y, int side,
    float *pixels, GiTileScratch *scratch, GiRenderCounts *counts, const GiTileControl *control) {
    Extent extent = {area->x + x, area->y + y, area->crop_width - x, area->crop_height - y};
    if (extent.width > side) extent.width = side;
    if (extent.height > side) extent.height = side;
    const GiScene *scene = world->scene;
    int n = (int)floor(sqrt((double)scene->samples) + 0.5);
    if (n < 1) n = 1;
    for (int row = 0; row < extent.height; row++) {
        for (int i = 0; i < extent.width; i++) scratch->sum[row * STRIDE + i] = gi_vec(0, 0, 0);
    }
    for (int sample = 0; sample < n * n; sample++) {
        draw_sample(world, area, &extent, (sample % n + 0.5) / n, (sample / n + 0.5) / n, scratch,
            counts, control);
        if (stopped(control)) return;
        for (int row = 0; row < extent.height; row++) {
            for (int i = row * STRIDE; i < row * STRIDE + extent.width; i++) {
                scratch->sum[i] = gi_add(scratch->sum[i], scratch->color[i]);
            }
        }
    }
    double exposure = scene->exposure > 0 ? scene->exposure : 1;
    for (int row = 0; row < extent.height; row++) {
        float *to = pixels + 3 * ((size_t)(y + row) * (size_t)area->crop_width + (size_t)x);
        for (int column = 0; column < extent.width; column++) {
            GiVec sum = scratch->sum[row * STRIDE + column];
            *to++ = (float)(sum.x / (n * n) * exposure);
            *to++ = (float)(sum.y / (n * n) * exposure);
            *to++ = (float)(sum.z / (n * n) * exposure);
        }
    }
}
