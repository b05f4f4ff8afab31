/* SPDX-License-Identifier: MIT */
#include "render/record.h"
#include "shade/shade.h"
#include "texture/texture.h"

/* A ray with what it met. */
typedef struct Met {
    GiVec origin, direction, factor;
    double t;
    GiArrival arrival;
    GiShapeRef shape;
    uint32_t instance, pixel;
    uint32_t ray; /* in the record */
} Met;

/* ---------------------------------------------------------------- points */

static GiVec white(void) { return gi_vec(1, 1, 1); }

/* From here on points count differently; those that are there count 1. */
static void begin_weights(GiTileScratch *scratch) {
    if (scratch->weighted) return;
    scratch->weighted = true;
    for (int i = 0; i < scratch->points.count; i++) scratch->factors[i] = white();
}

/* What else there is to know of a point. */
typedef struct Place {
    uint32_t pixel, skip, skip_instance; /* as in GiPoints */
    GiSpot spot;
} Place;

static inline void add_point(
    GiTileScratch *scratch, const GiSurfacePoint *at, GiVec direction, const Place *place) {
    GiPoints *points = &scratch->points;
    int i = points->count++;
    points->px[i] = at->point.x, points->py[i] = at->point.y, points->pz[i] = at->point.z;
    points->nx[i] = at->normal.x, points->ny[i] = at->normal.y, points->nz[i] = at->normal.z;
    points->vx[i] = -direction.x, points->vy[i] = -direction.y, points->vz[i] = -direction.z;
    points->error[i] = at->error;
    const GiVec *color = &scratch->color[place->pixel];
    points->red[i] = color->x, points->green[i] = color->y, points->blue[i] = color->z;
    points->pixel[i] = place->pixel;
    points->skip[i] = points->own[i] = place->skip;
    points->skip_instance[i] = place->skip_instance;
    points->clear[i] = INFINITY;
    scratch->spots[i] = place->spot;
}

GiShading gi_surface_shading(const GiStage *stage, int i) {
    const GiTileScratch *scratch = stage->scratch;
    const GiPoints *points = &scratch->points;
    const GiScene *scene = stage->world->scene;
    const GiShader *shader = &scene->shaders.data[scratch->spots[i].shader];
    return (GiShading){
        .scene = scene,
        .rules = stage->world->rules,
        .shader = shader,
        .normal = gi_vec(points->nx[i], points->ny[i], points->nz[i]),
        .toward_viewer = gi_vec(points->vx[i], points->vy[i], points->vz[i]),
        .diffuse = shader->texture == GI_NONE ? shader->diffuse : scratch->diffuse[i],
    };
}

/* The next `count` points have this shader: goes on with the last segment, or begins another. */
static inline void extend_segment(GiTileScratch *scratch, uint32_t shader, int count) {
    int last = scratch->segment_count - 1, begin = scratch->points.count;
    if (last >= 0 && scratch->segments[last].shader == shader) {
        scratch->segments[last].end = begin + count;
    } else {
        scratch->segments[scratch->segment_count++] = (GiSegment){shader, begin, begin + count};
    }
}

/* ---------------------------------------------------------------- what shines by itself */

/* Light that a ray has brought, to a pixel. */
static inline void show(const GiStage *stage, uint32_t pixel, uint32_t ray, GiVec light) {
    GiVec *color = &stage->scratch->color[pixel];
    *color = gi_add(*color, light);
    if (gi_stage_records(stage)) gi_record_add(stage, ray, light);
}

/* The same of the camera's ray, which brings the first light there is. */
static inline void show_first(const GiStage *stage, uint32_t pixel, GiVec light) {
    stage->scratch->color[pixel] = light;
    if (gi_stage_records(stage)) gi_record_add(stage, 0, light);
}

/* The share of the light from a large source that falls to a ray that found it by its bsdf; light
 * drawn at the source has the rest. */
static double share_of_flight(const GiStage *stage, const GiFlight *flight, double light_density) {
    return flight->density > 0
               ? gi_stage_share(stage, GI_TECHNIQUE_BSDF, flight->density, light_density)
               : 1;
}

/* What a surface shows without any light. */
static inline GiVec shine_of(const GiStage *stage, const GiShader *shader, GiVec normal) {
    return gi_stage_draws(stage, -1) ? gi_shade_emit(shader, normal) : gi_vec(0, 0, 0);
}

/* A visible rectangle light shines from its front and is black behind. */
static GiVec rectangle_emission(const GiStage *stage, const GiFlight *flight, const Met *met) {
    const GiWorld *world = stage->world;
    uint32_t light_index = gi_shape_info(&world->shapes, met->shape, met->instance)->shader;
    const GiLightRectangle *rectangle = &world->lights.data[light_index];
    GiVec point = gi_along(met->origin, met->direction, met->t);
    double density = gi_rectangle_density_angle(rectangle, met->origin, point);
    if (!(density > 0) || !gi_stage_draws(stage, (int)light_index)) return gi_vec(0, 0, 0);
    GiVec intensity = world->scene->lights.data[light_index].intensity;
    return flight == NULL ? intensity
                          : gi_scale(intensity, share_of_flight(stage, flight, density));
}

/* What a ray sees that meets nothing. */
static GiVec background(const GiStage *stage, const GiFlight *flight, GiVec direction) {
    const GiWorld *world = stage->world;
    const GiEnvironment *environment = &world->scene->environment;
    if (!gi_stage_draws(stage, -1)) return gi_vec(0, 0, 0);
    if (environment->face == 0) return world->scene->back_color;
    GiVec radiance = gi_environment_radiance(environment, direction);
    if (flight == NULL || !world->sky_lights) return radiance;
    double density = gi_environment_density(&world->sky, direction);
    return gi_scale(radiance, share_of_flight(stage, flight, density));
}

/* ---------------------------------------------------------------- what goes on */

bool gi_surface_probes(const GiWorld *world, const GiShader *shader) {
    const GiRules *rules = world->rules;
    if (world->scene->integrator == GLINT_INTEGRATOR_PATH) return true;
    if (!rules->area_light_visible && !rules->environment_lights) return false;
    return world->has_large_lights && shader->type != GLINT_SHADER_LAMBERTIAN &&
           shader->type != GLINT_SHADER_RGB_NORMALS;
}

static GiFlight flight_from(const Met *met, const GiSurfacePoint *at) {
    return (GiFlight){.origin = at->point,
        .t_min = at->error,
        .pixel = met->pixel,
        .ray = met->ray,
        .level = (uint32_t)met->arrival.level + 1};
}

/* The years' ray tree: all branches, down to the last level. */
static void add_branches(
    const GiStage *stage, const Met *met, const GiSurfacePoint *at, const GiScatter *scatter) {
    if (met->arrival.level >= stage->world->rules->last_level) return;
    for (int i = 0; i < scatter->count; i++) {
        const GiBranch *branch = &scatter->branch[i];
        GiFlight flight = flight_from(met, at);
        flight.direction = branch->direction;
        flight.factor = gi_multiply(met->factor, branch->factor);
        flight.weight = branch->weight;
        flight.inside = branch->inside;
        if (gi_stage_records(stage)) gi_record_choose(stage, i, 1);
        gi_flight_add(stage, &flight);
    }
}

/* A direction that the bsdf draws, for light from large sources and the rest of a path. False: it
 * draws none. */
static bool draw_direction(
    const GiStage *stage, const Met *met, const GiScatter *scatter, GiFlight *flight) {
    GiSampler sampler = gi_stage_sampler(stage, met->pixel);
    uint32_t level = (uint32_t)met->arrival.level;
    double u[3];
    u[0] = gi_sample_1d(&sampler, gi_stage_dimension(level, GI_PURPOSE_LOBE));
    gi_sample_2d(&sampler, gi_stage_dimension(level, GI_PURPOSE_BSDF), u + 1);
    GiVec l;
    double density = gi_bsdf_sample(&scatter->local, u, &l);
    if (!(density > 0)) return false;
    GiVec value = gi_bsdf_evaluate(&scatter->local, l);
    double factor = gi_stage_radiance(&scatter->local) / density;
    flight->direction = l;
    flight->density = density;
    flight->factor =
        gi_multiply(gi_multiply(met->factor, scatter->local_factor), gi_scale(value, factor));
    return !gi_vec_is_zero(flight->factor);
}

static void add_probe(
    const GiStage *stage, const Met *met, const GiSurfacePoint *at, const GiScatter *scatter) {
    GiFlight flight = flight_from(met, at);
    flight.probe = true;
    if (gi_stage_records(stage)) gi_record_choose(stage, scatter->count, 1);
    if (draw_direction(stage, met, scatter, &flight)) gi_flight_add(stage, &flight);
}

/* Colours may be negative. */
static double brightness(GiVec color) {
    return (fabs(color.x) + fabs(color.y) + fabs(color.z)) / 3;
}

/* Goes on with a part p of all paths only, and lets each count 1 / p (Russian roulette). From the
 * level on at which a path has had its chance. */
static bool survives(const GiStage *stage, GiFlight *flight) {
    enum { SAFE_LEVELS = 4 };
    if (flight->level <= SAFE_LEVELS) return true;
    double p = gi_largest(flight->factor);
    if (p >= 1) return true;
    if (gi_stage_records(stage)) gi_record_roulette(stage, p);
    GiSampler sampler = gi_stage_sampler(stage, flight->pixel);
    uint64_t dimension = gi_stage_dimension(flight->level, GI_PURPOSE_ROULETTE);
    if (!(gi_sample_1d(&sampler, dimension) < p)) return false;
    flight->factor = gi_scale(flight->factor, 1 / p);
    return true;
}

/* A path goes on in one direction: along a branch, or where the bsdf draws it. */
static void add_path(
    const GiStage *stage, const Met *met, const GiSurfacePoint *at, const GiScatter *scatter) {
    double parts[GI_BRANCH_LIMIT + 1], sum = 0;
    bool last = met->arrival.level >= stage->world->scene->max_depth;
    for (int i = 0; i < scatter->count; i++)
        sum += parts[i] = brightness(scatter->branch[i].factor);
    parts[scatter->count] = scatter->local.shader != NULL ? brightness(scatter->local_factor) : 0;
    sum += parts[scatter->count];
    if (!(sum > 0)) return;
    GiSampler sampler = gi_stage_sampler(stage, met->pixel);
    double at_part = sum * gi_sample_1d(&sampler,
                               gi_stage_dimension((uint32_t)met->arrival.level, GI_PURPOSE_CHOICE));
    int chosen = 0;
    while (chosen < scatter->count && at_part >= parts[chosen]) at_part -= parts[chosen++];
    double chance = parts[chosen] / sum;
    if (!(chance > 0)) return;
    if (gi_stage_records(stage)) gi_record_choose(stage, chosen, chance);
    GiFlight flight = flight_from(met, at);
    if (chosen < scatter->count) {
        const GiBranch *branch = &scatter->branch[chosen];
        flight.direction = branch->direction;
        flight.factor = gi_multiply(met->factor, branch->factor);
        flight.weight = branch->weight;
        flight.inside = branch->inside;
    } else {
        if (!draw_direction(stage, met, scatter, &flight)) return;
        flight.weight = met->arrival.weight;
        flight.inside = met->arrival.inside;
    }
    flight.probe = last;
    flight.factor = gi_scale(flight.factor, 1 / chance);
    if (survives(stage, &flight)) gi_flight_add(stage, &flight);
}

/* ---------------------------------------------------------------- surfaces */

static GiVec texture_color(const GiWorld *world, const Met *met, GiVec point, uint32_t index) {
    const GiTexture *texture = &world->scene->textures.data[index];
    double uv[2];
    gi_shape_texcoord(&world->shapes, met->shape, met->instance, point, uv);
    if (world->rules->texture_flipped) uv[1] = 1 - uv[1];
    return gi_texture_color(
        &world->scene->pictures.data[texture->picture], texture->wrap, uv[0], uv[1]);
}

/* A surface that light sources cannot be seen on alone: it mirrors, refracts, or has a texture. */
static void meet_layers(const GiStage *stage, const Met *met, const GiSurfacePoint *at,
    const GiShader *shader, Place place) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    const GiScene *scene = world->scene;
    GiShading shading = {scene, world->rules, shader, at->normal, gi_negate(met->direction),
        shader->texture == GI_NONE ? shader->diffuse
                                   : texture_color(world, met, at->point, shader->texture)};
    GiScatter scatter;
    gi_bsdf_scatter(&shading, &met->arrival, &scatter, gi_record_notes(stage));
    if (gi_stage_records(stage)) gi_record_scatter(stage, met->ray, &scatter);
    GiShading *local = &scatter.local;
    if (local->shader != NULL && local->shader != shader && local->shader->texture != GI_NONE) {
        local->diffuse = texture_color(world, met, at->point, local->shader->texture);
    }
    if (scene->integrator == GLINT_INTEGRATOR_PATH) {
        add_path(stage, met, at, &scatter);
    } else if (scene->integrator != GLINT_INTEGRATOR_POINT_LIGHT) {
        add_branches(stage, met, at, &scatter);
        if (local->shader != NULL && gi_surface_probes(world, local->shader)) {
            add_probe(stage, met, at, &scatter);
        }
    }
    if (local->shader == NULL) return;
    begin_weights(scratch);
    place.spot.shader = (uint32_t)(local->shader - scene->shaders.data);
    int i = scratch->points.count;
    scratch->factors[i] = gi_multiply(met->factor, scatter.local_factor);
    scratch->diffuse[i] = local->diffuse;
    if (local->shader != shader) {
        GiVec shine = shine_of(stage, local->shader, at->normal);
        show(stage, met->pixel, met->ray, gi_multiply(scratch->factors[i], shine));
    }
    extend_segment(scratch, place.spot.shader, 1);
    add_point(scratch, at, met->direction, &place);
}

/* Whether points of the shader are only lit, and nothing goes on from them. */
static bool is_plain(const GiWorld *world, const GiShader *shader) {
    bool plain = shader->type == GLINT_SHADER_LAMBERTIAN || shader->type == GLINT_SHADER_PHONG ||
                 shader->type == GLINT_SHADER_RGB_NORMALS;
    return plain && shader->texture == GI_NONE && !gi_surface_probes(world, shader) &&
           gi_vec_is_zero(shader->mirror);
}

static inline GiSurfacePoint point_of(const GiWorld *world, const Met *met) {
    GiSurfacePoint at = gi_shape_point(&world->shapes, met->shape, met->instance, met->origin,
        met->direction, met->t, world->rules->cone_geometric);
    if (world->shapes.normal_faults != 0) {
        gi_shape_spoil_normal(
            &world->shapes, met->shape, met->instance, met->origin, met->direction, &at);
    }
    return at;
}

/* Keeps what a camera ray met, for pictures of it. */
static void note_seen(
    const GiStage *stage, const Met *met, const GiSurfacePoint *at, const GiShader *shader) {
    const GiWorld *world = stage->world;
    GiSeen *seen = &stage->scratch->seen[met->pixel];
    for (int i = 0; i < GI_SUBSTRATE_LIMIT && shader->substrate != GI_NONE; i++) {
        shader = &world->scene->shaders.data[shader->substrate];
    }
    GiVec albedo = shader->diffuse;
    if (shader->texture != GI_NONE) albedo = texture_color(world, met, at->point, shader->texture);
    if (shader->type == GLINT_SHADER_GLASS) albedo = gi_vec(0, 0, 0);
    seen->normal = gi_add(seen->normal, at->normal);
    seen->albedo = gi_add(seen->albedo, albedo);
    seen->depth += met->t;
    seen->count++;
    if (stage->sample == 0) {
        seen->surface = gi_shape_info(&world->shapes, met->shape, met->instance)->order + 1;
    }
}

static Met met_of_bundle(const GiBundle *bundle, int i) {
    return (Met){gi_bundle_origin(bundle, i), gi_bundle_direction(bundle, i), {1, 1, 1},
        bundle->t[i], {1, 1, false}, {bundle->shape[i]}, bundle->instance[i], bundle->pixel[i], 0};
}

/* A camera ray's: its color is set, not added to. */
static void meet_surface(const GiStage *stage, const Met *met, uint32_t shader_index) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    const GiShader *shader = &world->scene->shaders.data[shader_index];
    GiSurfacePoint at = point_of(world, met);
    Place place = {met->pixel, gi_world_skip(world, met->shape), met->instance, {shader_index, 1}};
    show_first(stage, met->pixel, shine_of(stage, shader, at.normal));
    if (scratch->seen != NULL) note_seen(stage, met, &at, shader);
    meet_layers(stage, met, &at, shader, place);
}

/* The same for a surface that is only lit. Most are, so nothing is put together in memory that is
 * not needed. */
static inline void meet_plain(const GiStage *stage, int i, uint32_t shader_index) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    const GiBundle *bundle = &scratch->bundle;
    const GiShader *shader = &world->scene->shaders.data[shader_index];
    GiShapeRef shape = {bundle->shape[i]};
    GiVec origin = gi_bundle_origin(bundle, i), direction = gi_bundle_direction(bundle, i);
    GiSurfacePoint at = gi_shape_point(&world->shapes, shape, bundle->instance[i], origin,
        direction, bundle->t[i], world->rules->cone_geometric);
    if (world->shapes.normal_faults != 0) {
        gi_shape_spoil_normal(&world->shapes, shape, bundle->instance[i], origin, direction, &at);
    }
    uint32_t pixel = bundle->pixel[i];
    show_first(stage, pixel, shine_of(stage, shader, at.normal));
    if (scratch->seen != NULL) {
        Met met = met_of_bundle(bundle, i);
        note_seen(stage, &met, &at, shader);
    }
    if (scratch->weighted) scratch->factors[scratch->points.count] = white();
    extend_segment(scratch, shader_index, 1);
    const Place place = {
        pixel, gi_world_skip(world, shape), bundle->instance[i], {shader_index, 1}};
    add_point(scratch, &at, direction, &place);
}

/* What shadow rays do with the shape they start on. */
static GiOwn own_of(const GiRules *rules, GiShapeRef shape) {
    switch (gi_shape_kind(shape)) {
    case GI_SHAPE_SPHERE: return rules->sphere_shadows_itself ? GI_OWN_MET : GI_OWN_SPARED;
    case GI_SHAPE_TRIANGLE: return rules->shadow_distance > 0 ? GI_OWN_MET : GI_OWN_LEFT;
    default: return GI_OWN_MET;
    }
}

/* The same for surfaces of one kind that do not shine, many at a time. */
static void meet_dark(
    const GiStage *stage, const uint32_t *rays, int count, uint32_t shader_index) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    int begin = scratch->points.count;
    extend_segment(scratch, shader_index, count);
    world->kernel->points(&world->shapes, &scratch->bundle, rays, count,
        own_of(world->rules, (GiShapeRef){scratch->bundle.shape[rays[0]]}),
        world->rules->cone_geometric, &scratch->points);
    for (int i = begin; i < begin + count; i++) {
        scratch->spots[i] = (GiSpot){shader_index, 1};
        if (scratch->weighted) scratch->factors[i] = white();
    }
}

/* By what rays are sorted: the shader of what they met, and its kind where the kernels make points
 * of such; GI_SHAPE_PLACED stands for all the others. Or that they met nothing, or a light. */
enum { KEY_KIND_BITS = 3 };
#define KEY_NOTHING UINT32_MAX
#define KEY_LIGHT   (UINT32_MAX - 1)

static inline uint32_t key_of(const GiWorld *world, GiShapeRef shape, uint32_t instance) {
    GiShapeKind kind = gi_shape_kind(shape);
    bool known = kind <= GI_SHAPE_CONE || kind == GI_SHAPE_TRIANGLE;
    uint32_t shader = gi_shape_info(&world->shapes, shape, instance)->shader;
    return shader << KEY_KIND_BITS |
           (known && instance == GI_SHAPE_NONE ? (uint32_t)kind : GI_SHAPE_PLACED);
}

/* The key of all triangles of a mesh that is of no instance: neighbours are mostly of one. */
typedef struct MeshKey {
    uint32_t first, count; /* bits of the first triangle */
    uint32_t key;
} MeshKey;

static MeshKey mesh_key(const GiWorld *world, GiShapeRef triangle) {
    const GiShapes *shapes = &world->shapes;
    const GiMesh *mesh = &shapes->meshes[gi_shape_mesh(shapes, gi_shape_index(triangle))];
    return (MeshKey){gi_shape_ref(GI_SHAPE_TRIANGLE, mesh->first_triangle).bits,
        mesh->triangle_count, key_of(world, triangle, GI_SHAPE_NONE)};
}

/* The keys of the bundle's rays. Of solids and triangles they are looked up without asking whether
 * the ray before met the same one, which cannot be foretold. */
static void find_keys(const GiWorld *world, const GiBundle *bundle, uint32_t *keys) {
    uint32_t key = KEY_NOTHING, shape = GI_SHAPE_NONE, instance = GI_SHAPE_NONE;
    MeshKey mesh = {0, 0, 0};
    for (int i = 0; i < bundle->count; i++) {
        GiShapeRef ref = {bundle->shape[i]};
        GiShapeKind kind = gi_shape_kind(ref);
        bool unplaced = bundle->instance[i] == GI_SHAPE_NONE;
        if (unplaced && kind <= GI_SHAPE_CONE) {
            uint32_t shader = world->shapes.info[kind][gi_shape_index(ref)].shader;
            keys[i] = shader << KEY_KIND_BITS | (uint32_t)kind;
        } else if (unplaced && kind == GI_SHAPE_TRIANGLE) {
            if (ref.bits - mesh.first >= mesh.count) mesh = mesh_key(world, ref);
            keys[i] = mesh.key;
        } else {
            if (ref.bits != shape || bundle->instance[i] != instance) {
                shape = ref.bits, instance = bundle->instance[i];
                key = shape == GI_SHAPE_NONE       ? KEY_NOTHING
                      : kind == GI_SHAPE_RECTANGLE ? KEY_LIGHT
                                                   : key_of(world, ref, instance);
            }
            keys[i] = key;
        }
    }
}

/* Rays that met nothing. */
static void meet_nothing(const GiStage *stage, const uint32_t *rays, int count) {
    const GiBundle *bundle = &stage->scratch->bundle;
    bool plain = stage->world->scene->environment.face == 0;
    GiVec light = background(stage, NULL, gi_bundle_direction(bundle, (int)rays[0]));
    for (int i = 0; i < count; i++) {
        if (!plain) light = background(stage, NULL, gi_bundle_direction(bundle, (int)rays[i]));
        show_first(stage, bundle->pixel[rays[i]], light);
    }
}

/* The rays of one key. */
static void meet_group(const GiStage *stage, uint32_t key, const uint32_t *rays, int count) {
    const GiTileScratch *scratch = stage->scratch;
    if (key == KEY_NOTHING) {
        meet_nothing(stage, rays, count);
        return;
    }
    if (key == KEY_LIGHT) {
        for (int i = 0; i < count; i++) {
            const Met met = met_of_bundle(&scratch->bundle, (int)rays[i]);
            show_first(stage, met.pixel, rectangle_emission(stage, NULL, &met));
        }
        return;
    }
    uint32_t index = key >> KEY_KIND_BITS, kind = key & ((1 << KEY_KIND_BITS) - 1);
    const GiShader *shader = &stage->world->scene->shaders.data[index];
    bool plain = is_plain(stage->world, shader);
    bool dark = plain && shader->type != GLINT_SHADER_RGB_NORMALS && scratch->seen == NULL &&
                stage->world->shapes.normal_faults == 0;
    if (dark && kind != GI_SHAPE_PLACED) {
        meet_dark(stage, rays, count, index);
        return;
    }
    for (int i = 0; i < count; i++) {
        if (plain) {
            meet_plain(stage, (int)rays[i], index);
        } else {
            const Met met = met_of_bundle(&scratch->bundle, (int)rays[i]);
            meet_surface(stage, &met, index);
        }
    }
}

/* Points of one shader come to stand side by side, so that kernels can shade many at a time. The
 * order among a bundle's points does not matter, as each belongs to another pixel. */
void gi_surface_bundle(const GiStage *stage) {
    const GiWorld *world = stage->world;
    GiTileScratch *scratch = stage->scratch;
    const GiBundle *bundle = &scratch->bundle;
    uint32_t keys[GI_BUNDLE_ROOM], rays[GI_BUNDLE_ROOM];
    int ends[GI_BUNDLE_SIZE];
    if (gi_stage_records(stage)) gi_record_camera(stage);
    find_keys(world, bundle, keys);
    int count = world->kernel->group(keys, bundle->count, rays, ends);
    for (int k = 0, begin = 0; k < count; begin = ends[k++]) {
        meet_group(stage, keys[rays[begin]], rays + begin, ends[k] - begin);
    }
    if (gi_stage_records(stage)) gi_record_points(stage, 0);
}

void gi_surface_flight(const GiStage *stage, const GiFlight *flight, const GiTraceHit *hit) {
    const GiWorld *world = stage->world;
    if (gi_stage_records(stage)) gi_record_hit(stage, flight->ray, hit);
    if (hit == NULL) {
        GiVec light = background(stage, flight, flight->direction);
        bool path = world->scene->integrator == GLINT_INTEGRATOR_PATH;
        if (flight->probe && !world->sky_lights && !path) return;
        show(stage, flight->pixel, flight->ray, gi_multiply(flight->factor, light));
        return;
    }
    const Met met = {flight->origin, flight->direction, flight->factor, hit->t,
        {(int)flight->level, flight->weight, flight->inside}, hit->shape, hit->instance,
        flight->pixel, flight->ray};
    if (gi_shape_kind(hit->shape) == GI_SHAPE_RECTANGLE) {
        GiVec light = rectangle_emission(stage, flight, &met);
        show(stage, flight->pixel, flight->ray, gi_multiply(flight->factor, light));
        return;
    }
    if (flight->probe) return;
    uint32_t index = gi_shape_info(&world->shapes, hit->shape, hit->instance)->shader;
    const GiShader *shader = &world->scene->shaders.data[index];
    GiSurfacePoint at = point_of(world, &met);
    GiVec shine = shine_of(stage, shader, at.normal);
    show(stage, flight->pixel, flight->ray, gi_multiply(flight->factor, shine));
    Place place = {
        flight->pixel, gi_world_skip(world, hit->shape), hit->instance, {index, flight->level}};
    meet_layers(stage, &met, &at, shader, place);
    if (gi_stage_records(stage)) gi_record_points(stage, flight->ray);
}
