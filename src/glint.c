/* SPDX-License-Identifier: MIT
 * The public functions of scenes: they check arguments and call a room. Pictures are in
 * image/image.c, dialects in scene/dialect.c, instruction sets in kernel/dispatch.c. */
#include "glint/glint.h"

#include "base/assert.h"
#include "base/cookie.h"
#include "base/error.h"
#include "port/file.h"
#include "port/machine.h"
#include "reader/reader.h"
#include "render/render.h"
#include "sched/pool.h"

#include <stdlib.h>
#include <string.h>

struct GlintScene {
    GiMemory memory;
    GiScene model;
    GiWorld world;
    GiPool *pool; /* from commit on */
    const GiKernel *kernel;
    GlintDialect dialect; /* asked for */
    int thread_count;
    GlintDiagnosticFn diagnostic;
    void *diagnostic_user;
    bool committed, broken; /* broken: a load or commit failed */
    GlintStats stats;
};

#define TEXT(x)  TEXT_(x)
#define TEXT_(x) #x

const char *glint_version_text(void) {
    return TEXT(GLINT_VERSION_MAJOR) "." TEXT(GLINT_VERSION_MINOR) "." TEXT(GLINT_VERSION_PATCH);
}

const char *glint_status_text(GlintStatus status) {
    static const char *const texts[] = {
#define STATUS_TEXT(name, text) text,
        GLINT_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
    };
    return (size_t)status < sizeof texts / sizeof texts[0] ? texts[status] : "unknown status";
}

/* ---------------------------------------------------------------- create, destroy */

GlintSceneDesc glint_scene_desc_default(void) {
    return (GlintSceneDesc){.dialect = GLINT_DIALECT_AUTO, .cookie = GI_COOKIE};
}

#define ARGUMENT(error, ...) gi_error_set((error), GLINT_ERROR_ARGUMENT, __VA_ARGS__)
#define NO_DEFAULT(function) "the desc was not made by " function

GlintStatus glint_scene_create(const GlintSceneDesc *desc, GlintScene **result, GlintError *error) {
    if (desc == NULL || result == NULL) return ARGUMENT(error, "desc or scene is null");
    *result = NULL;
    if (desc->cookie != GI_COOKIE) return ARGUMENT(error, NO_DEFAULT("glint_scene_desc_default"));
    if (desc->thread_count < 0) return ARGUMENT(error, "thread_count is negative");
    if ((unsigned)desc->dialect >= GLINT_DIALECT_COUNT) return ARGUMENT(error, "no such dialect");
    const GiKernel *kernel = gi_kernel_find(desc->isa);
    if (kernel == NULL) {
        return ARGUMENT(error, "this machine or build has no instruction set '%s'", desc->isa);
    }
    GiMemory memory;
    size_t limit = desc->memory_limit != 0 ? desc->memory_limit : gi_machine_memory() / 10 * 9;
    gi_memory_init(&memory, desc->allocator, limit);
    GlintScene *scene = gi_memory_allocate(&memory, sizeof *scene);
    if (scene == NULL) return gi_error_memory(error);
    memset(scene, 0, sizeof *scene);
    gi_memory_init(&scene->memory, desc->allocator, limit);
    scene->kernel = kernel;
    scene->dialect = desc->dialect;
    scene->thread_count = desc->thread_count;
    scene->diagnostic = desc->diagnostic;
    scene->diagnostic_user = desc->diagnostic_user;
    scene->stats.isa = kernel->name;
    if (!gi_scene_init(&scene->model, &scene->memory)) {
        glint_scene_destroy(scene);
        return gi_error_memory(error);
    }
    *result = scene;
    return GLINT_OK;
}

void glint_scene_destroy(GlintScene *scene) {
    if (scene == NULL) return;
    gi_world_reset(&scene->world, &scene->memory);
    gi_pool_destroy(scene->pool);
    gi_scene_reset(&scene->model);
    GI_ASSERT(atomic_load(&scene->memory.used) == 0);
    GlintAllocator allocator = scene->memory.allocator;
    allocator.reallocate(allocator.user, scene, sizeof *scene, 0);
}

/* ---------------------------------------------------------------- load */

static bool is_empty(const GiScene *model) {
    return !model->has_camera && !model->has_image && model->shaders.count == 1 &&
           model->lights.count == 0 && model->shape_count == 0 && model->groups.count == 0;
}

static GlintStatus load(GlintScene *scene, GiReaderSource *source, GlintError *error) {
    if (scene->committed || scene->broken || !is_empty(&scene->model)) {
        return ARGUMENT(error, "a file can only be loaded into an empty scene");
    }
    source->diagnostic = scene->diagnostic;
    source->diagnostic_user = scene->diagnostic_user;
    source->dialect = scene->dialect;
    source->thread_count = scene->thread_count;
    double start = gi_machine_seconds();
    GiReaderResult result = {0};
    GlintStatus status = gi_reader_load(&scene->model, source, &result, error);
    scene->stats.read_seconds = gi_machine_seconds() - start;
    scene->stats.read_bytes = (uint64_t)result.byte_count;
    scene->broken = status != GLINT_OK;
    return status;
}

GlintStatus glint_scene_load_file(
    GlintScene *scene, const char *path, const GlintMonitor *monitor, GlintError *error) {
    if (scene == NULL || path == NULL) return ARGUMENT(error, "scene or path is null");
    GiFileReader file;
    GlintStatus status = gi_file_read_open(&file, path, error);
    if (status != GLINT_OK) return status;
    file.monitor = monitor;
    GiReaderSource source = {.read = gi_file_read,
        .user = &file,
        .name = path,
        .total_size = file.size,
        .monitor = monitor};
    status = load(scene, &source, error);
    /* The reader only knows that reading failed; the file knows why. */
    if (status == GLINT_ERROR_FILE) gi_file_read_status(&file, error);
    gi_file_read_close(&file);
    return status;
}

typedef struct Bytes {
    const char *next;
    size_t left;
} Bytes;

static int64_t read_bytes(void *user, void *buffer, size_t size) {
    Bytes *bytes = user;
    if (size > bytes->left) size = bytes->left;
    if (size > 0) memcpy(buffer, bytes->next, size);
    bytes->next += size;
    bytes->left -= size;
    return (int64_t)size;
}

GlintStatus glint_scene_load_memory(GlintScene *scene, const void *bytes, size_t size,
    const char *name, const GlintMonitor *monitor, GlintError *error) {
    if (scene == NULL || name == NULL || (bytes == NULL && size > 0)) {
        return ARGUMENT(error, "scene, bytes or name is null");
    }
    Bytes left = {bytes, size};
    GiReaderSource source = {.read = read_bytes,
        .user = &left,
        .name = name,
        .total_size = (int64_t)size,
        .monitor = monitor};
    return load(scene, &source, error);
}

GlintStatus glint_scene_load_stream(GlintScene *scene, GlintReadFn read, void *user,
    const char *name, const GlintMonitor *monitor, GlintError *error) {
    if (scene == NULL || read == NULL || name == NULL) {
        return ARGUMENT(error, "scene, read or name is null");
    }
    GiReaderSource source = {
        .read = read, .user = user, .name = name, .total_size = -1, .monitor = monitor};
    return load(scene, &source, error);
}

/* ---------------------------------------------------------------- build by calls */

GlintImageDesc glint_image_desc_default(void) {
    return (GlintImageDesc){
        .width = 512, .height = 512, .samples = 1, .exposure = 1, .cookie = GI_COOKIE};
}

GlintCameraDesc glint_camera_desc_default(void) {
    return (GlintCameraDesc){
        .view_direction = {0, 0, -1},
        .view_up = {0, 1, 0},
        .projection_distance = 1,
        .view_width = 1,
        .view_height = 1,
        .cookie = GI_COOKIE,
    };
}

GlintShaderDesc glint_shader_desc_default(void) {
    return (GlintShaderDesc){.diffuse_color = {1, 1, 1},
        .specular_color = {1, 1, 1},
        .exponent = 1,
        .cookie = GI_COOKIE};
}

GlintLightDesc glint_light_desc_default(void) {
    return (GlintLightDesc){.intensity = {1, 1, 1}, .cookie = GI_COOKIE};
}

GlintSurfaceDesc glint_surface_desc_default(GlintSurfaceType type) {
    return (GlintSurfaceDesc){
        .type = type,
        .radius = 1,
        .height = 1,
        .normal = {0, 0, 1},
        .transform = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
        .cookie = GI_COOKIE,
    };
}

static bool is_finite3(const double v[3]) {
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static bool is_zero3(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/* What every building call checks first. */
static GlintStatus check_open(
    const GlintScene *scene, const void *desc, int cookie, const char *made_by, GlintError *error) {
    if (scene == NULL || desc == NULL) return ARGUMENT(error, "scene or desc is null");
    if (cookie != GI_COOKIE) return ARGUMENT(error, "the desc was not made by %s", made_by);
    if (scene->committed) return ARGUMENT(error, "the scene is committed already");
    if (scene->broken) return ARGUMENT(error, "the scene failed to load");
    return GLINT_OK;
}

#define CHECK_OPEN(scene, desc, made_by, error)                                                    \
    do {                                                                                           \
        GlintStatus status_ =                                                                      \
            check_open(scene, desc, (desc) != NULL ? (desc)->cookie : 0, made_by, error);          \
        if (status_ != GLINT_OK) return status_;                                                   \
    } while (0)

GlintStatus glint_scene_set_image(
    GlintScene *scene, const GlintImageDesc *desc, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_image_desc_default", error);
    const char *fault = gi_scene_check_image_size(desc->width, desc->height);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    if (desc->samples < 1 || desc->samples > GI_SAMPLES_LIMIT) {
        return ARGUMENT(error, "samples must be from 1 to %d", GI_SAMPLES_LIMIT);
    }
    if (!is_finite3(desc->back_color)) return ARGUMENT(error, "back_color is not finite");
    if (!isfinite(desc->exposure)) return ARGUMENT(error, "exposure is not finite");
    GiScene *model = &scene->model;
    model->has_image = true;
    model->width = desc->width;
    model->height = desc->height;
    model->samples = desc->samples;
    model->back_color = gi_vec_from(desc->back_color);
    model->exposure = desc->exposure > 0 ? desc->exposure : 1;
    return GLINT_OK;
}

static bool is_positive(double value) { return value > 0 && isfinite(value); }

static const char *check_camera(const GlintCameraDesc *desc) {
    if ((unsigned)desc->type > GLINT_CAMERA_PARALLEL) return "no such camera type";
    if (!is_finite3(desc->view_point)) return "view_point is not finite";
    if (!is_finite3(desc->view_direction)) return "view_direction is not finite";
    if (is_zero3(desc->view_direction)) return "view_direction has no length";
    if (!is_finite3(desc->view_up)) return "view_up is not finite";
    if (is_zero3(desc->view_up)) return "view_up has no length";
    if (!is_finite3(desc->projection_normal)) return "projection_normal is not finite";
    if (!is_positive(desc->projection_distance)) {
        return "projection_distance must be positive and finite";
    }
    if (!is_positive(desc->view_width)) return "view_width must be positive and finite";
    if (!is_positive(desc->view_height)) return "view_height must be positive and finite";
    return NULL;
}

GlintStatus glint_scene_set_camera(
    GlintScene *scene, const GlintCameraDesc *desc, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_camera_desc_default", error);
    const char *fault = check_camera(desc);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    GiCamera camera = {
        .type = desc->type,
        .view_point = gi_vec_from(desc->view_point),
        .view_direction = gi_vec_from(desc->view_direction),
        .view_up = gi_vec_from(desc->view_up),
        .projection_normal = gi_vec_from(desc->projection_normal),
        .projection_distance = desc->projection_distance,
        .view_width = desc->view_width,
        .view_height = desc->view_height,
    };
    /* What is left is a matter of two vectors; the model's check names them as files do. */
    if (gi_scene_check_camera(&camera) != NULL) {
        return ARGUMENT(error, "view_up is parallel to the projection normal");
    }
    scene->model.camera = camera;
    scene->model.has_camera = true;
    return GLINT_OK;
}

GlintStatus glint_scene_add_light(
    GlintScene *scene, const GlintLightDesc *desc, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_light_desc_default", error);
    if ((unsigned)desc->type > GLINT_LIGHT_NORMAL) return ARGUMENT(error, "no such light type");
    if ((unsigned)desc->falloff > GLINT_FALLOFF_INVERSE_SQUARE) {
        return ARGUMENT(error, "no such falloff");
    }
    if (!is_finite3(desc->position)) return ARGUMENT(error, "position is not finite");
    if (!is_finite3(desc->intensity)) return ARGUMENT(error, "intensity is not finite");
    GiLight light = {
        .type = desc->type,
        .falloff = desc->falloff,
        .position = gi_vec_from(desc->position),
        .intensity = gi_vec_from(desc->intensity),
    };
    return gi_array_push(&scene->memory, &scene->model.lights, light) ? GLINT_OK
                                                                      : gi_error_memory(error);
}

GlintStatus glint_scene_add_shader(
    GlintScene *scene, const GlintShaderDesc *desc, GlintShaderId *id, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_shader_desc_default", error);
    if ((unsigned)desc->type > GLINT_SHADER_RGB_NORMALS) {
        return ARGUMENT(error, "no such shader type");
    }
    if (!is_finite3(desc->diffuse_color)) return ARGUMENT(error, "diffuse_color is not finite");
    if (!is_finite3(desc->specular_color)) return ARGUMENT(error, "specular_color is not finite");
    if (!isfinite(desc->exponent)) return ARGUMENT(error, "exponent is not finite");
    GiShader shader = {
        .texture = GI_NONE,
        .substrate = GI_NONE,
        .type = desc->type,
        .diffuse_given = true,
        .diffuse = gi_vec_from(desc->diffuse_color),
        .specular = gi_vec_from(desc->specular_color),
        .exponent = desc->exponent,
    };
    uint32_t index = (uint32_t)scene->model.shaders.count;
    if (!gi_array_push(&scene->memory, &scene->model.shaders, shader)) {
        return gi_error_memory(error);
    }
    /* Index 0 is the default shader, so the index is the id. */
    if (id != NULL) id->index1 = index;
    return GLINT_OK;
}

static const char *check_surface(const GiScene *model, const GlintSurfaceDesc *desc) {
    if ((unsigned)desc->type > GLINT_SURFACE_GROUP) return "no such surface type";
    if (desc->shader.index1 >= model->shaders.count) return "no such shader";
    if (desc->parent.index1 > 0 &&
        (desc->parent.index1 >> 28 != GI_SHAPE_GROUP ||
            (desc->parent.index1 & (GI_SHAPE_INDEX_LIMIT - 1)) >= model->groups.count)) {
        return "parent is not a group of this scene";
    }
    if (!is_finite3(desc->center)) return "center is not finite";
    if (!is_finite3(desc->point_a)) return "point_a is not finite";
    if (!is_finite3(desc->point_b)) return "point_b is not finite";
    if (!is_finite3(desc->normal)) return "normal is not finite";
    if (is_zero3(desc->normal)) return "normal has no length";
    if (!(desc->radius > 0 && isfinite(desc->radius))) return "radius must be positive and finite";
    if (!(desc->height > 0 && isfinite(desc->height))) return "height must be positive and finite";
    if (desc->type == GLINT_SURFACE_CONE) {
        if (!isfinite(desc->tip_z)) return "tip_z is not finite";
        return gi_scene_check_cone(desc->center[2], desc->tip_z);
    }
    return NULL;
}

static bool add_shape(GiScene *model, const GlintSurfaceDesc *desc, GiShapeRef *ref) {
    GiVec center = gi_vec_from(desc->center), normal = gi_vec_from(desc->normal);
    uint32_t shader = desc->shader.index1;
    switch (desc->type) {
    case GLINT_SURFACE_SPHERE: return gi_scene_add_sphere(model, center, desc->radius, shader, ref);
    case GLINT_SURFACE_BOX:
        return gi_scene_add_box(
            model, gi_vec_from(desc->point_a), gi_vec_from(desc->point_b), shader, ref);
    case GLINT_SURFACE_CYLINDER:
        return gi_scene_add_cylinder(model, center, desc->radius, desc->height, shader, ref);
    case GLINT_SURFACE_CONE:
        return gi_scene_add_cone(
            model, center, desc->radius, desc->height, desc->tip_z, shader, ref);
    case GLINT_SURFACE_PLANE:
        return gi_scene_add_plane(model, gi_vec_from(desc->point_a), normal, shader, ref);
    case GLINT_SURFACE_DISC:
        return gi_scene_add_disc(model, center, normal, desc->radius, shader, ref);
    default: return false;
    }
}

GlintStatus glint_scene_add_surface(
    GlintScene *scene, const GlintSurfaceDesc *desc, GlintSurfaceId *id, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_surface_desc_default", error);
    GiScene *model = &scene->model;
    const char *fault = check_surface(model, desc);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    GiShapeRef ref;
    uint32_t number = model->shape_count + 1;
    if (desc->type == GLINT_SURFACE_GROUP) {
        GiAffine matrix, inverse;
        memcpy(matrix.m, desc->transform, sizeof matrix.m);
        if (!gi_affine_invert(&matrix, &inverse)) {
            return ARGUMENT(error, "transform is singular or not finite");
        }
        if (!gi_scene_add_group(model, &ref)) return gi_error_memory(error);
        if (!gi_scene_add_matrix(model, gi_shape_index(ref), &matrix)) {
            return gi_error_memory(error);
        }
        number = ref.bits;
    } else if (!add_shape(model, desc, &ref)) {
        return gi_error_memory(error);
    }
    uint32_t parent =
        desc->parent.index1 == 0 ? GI_SHAPE_NONE : desc->parent.index1 & (GI_SHAPE_INDEX_LIMIT - 1);
    if (!gi_scene_place(model, parent, ref)) return gi_error_memory(error);
    if (id != NULL) id->index1 = number;
    return GLINT_OK;
}

/* ---------------------------------------------------------------- commit, render, trace */

GlintStatus glint_scene_commit(GlintScene *scene, const GlintMonitor *monitor, GlintError *error) {
    if (scene == NULL) return ARGUMENT(error, "scene is null");
    if (scene->committed) return ARGUMENT(error, "the scene is committed already");
    if (scene->broken) return ARGUMENT(error, "the scene failed to load");
    GiScene *model = &scene->model;
    if (!model->has_image) return ARGUMENT(error, "the scene has no image");
    if (!model->has_camera) return ARGUMENT(error, "the scene has no camera");
    if (model->dialect == GLINT_DIALECT_AUTO) {
        model->dialect =
            scene->dialect != GLINT_DIALECT_AUTO ? scene->dialect : GLINT_DIALECT_GLINT;
    }
    double start = gi_machine_seconds();
    GlintStatus status = gi_pool_create(&scene->memory, scene->thread_count, &scene->pool);
    if (status != GLINT_OK) {
        scene->broken = true;
        return gi_error_set(error, status, "%s", glint_status_text(status));
    }
    status = gi_world_commit(&scene->world, model, scene->kernel, scene->pool, monitor, error);
    scene->broken = status != GLINT_OK;
    if (status != GLINT_OK) return status;
    scene->committed = true;
    GlintStats *stats = &scene->stats;
    const GiTree *tree = &scene->world.store.tree;
    stats->build_seconds = gi_machine_seconds() - start;
    stats->thread_count = gi_pool_worker_count(scene->pool);
    stats->primitive_count = scene->world.primitive_count;
    stats->node_count = tree->node_count;
    stats->leaf_count = (uint64_t)tree->sphere_block_count + tree->box_block_count;
    stats->tree_bytes = (uint64_t)tree->node_count * sizeof(GiNode) +
                        (uint64_t)tree->sphere_block_count * sizeof(GiSphereBlock) +
                        (uint64_t)tree->box_block_count * sizeof(GiBoxBlock);
    stats->sah_cost = scene->world.store.sah_cost;
    return GLINT_OK;
}

void glint_scene_info(const GlintScene *scene, GlintSceneInfo *info) {
    GI_ASSERT(scene != NULL && info != NULL);
    const GiScene *model = &scene->model;
    *info = (GlintSceneInfo){
        .dialect = model->dialect,
        .width = model->width,
        .height = model->height,
        .samples = model->samples,
        .surface_count = scene->committed ? scene->world.primitive_count : model->shape_count,
        .light_count = (uint32_t)model->lights.count,
        .shader_count = (uint32_t)model->shaders.count - 1,
    };
}

void glint_scene_stats(const GlintScene *scene, GlintStats *stats) {
    GI_ASSERT(scene != NULL && stats != NULL);
    *stats = scene->stats;
    stats->memory_peak = atomic_load(&scene->memory.peak);
}

GlintRenderDesc glint_render_desc_default(void) { return (GlintRenderDesc){.cookie = GI_COOKIE}; }

GlintStatus glint_render(
    GlintScene *scene, const GlintRenderDesc *desc, float *pixels, GlintError *error) {
    if (scene == NULL || desc == NULL || pixels == NULL) {
        return ARGUMENT(error, "scene, desc or pixels is null");
    }
    if (desc->cookie != GI_COOKIE) return ARGUMENT(error, NO_DEFAULT("glint_render_desc_default"));
    if (!scene->committed) return ARGUMENT(error, "the scene is not committed");
    GiRenderArea area = {
        .width = desc->width != 0 ? desc->width : scene->model.width,
        .height = desc->height != 0 ? desc->height : scene->model.height,
        .x = desc->crop_x,
        .y = desc->crop_y,
    };
    const char *fault = gi_scene_check_image_size(area.width, area.height);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    if (area.x < 0 || area.y < 0 || area.x >= area.width || area.y >= area.height) {
        return ARGUMENT(error, "the corner of the crop lies outside of the picture");
    }
    area.crop_width = desc->crop_width != 0 ? desc->crop_width : area.width - area.x;
    area.crop_height = desc->crop_height != 0 ? desc->crop_height : area.height - area.y;
    if (area.crop_width < 1 || area.crop_width > area.width - area.x || area.crop_height < 1 ||
        area.crop_height > area.height - area.y) {
        return ARGUMENT(error, "the crop reaches outside of the picture");
    }
    if (desc->light < -1 || desc->light > (int)scene->model.lights.count) {
        return ARGUMENT(error, "there is no such light");
    }
    double start = gi_machine_seconds();
    GiRenderCounts counts = {0};
    const GiRenderTarget target = {
        pixels, desc->depth, desc->normal, desc->albedo, desc->surface, desc->light};
    GlintStatus status =
        gi_render(&scene->world, scene->pool, &area, desc->monitor, &target, &counts);
    scene->stats.trace_seconds = gi_machine_seconds() - start;
    scene->stats.camera_rays = counts.camera_rays;
    scene->stats.shadow_rays = counts.shadow_rays;
    return status == GLINT_OK ? status
                              : gi_error_set(error, status, "%s", glint_status_text(status));
}

static GiTraceRay trace_ray(const GlintRay *ray) {
    return (GiTraceRay){gi_vec_from(ray->origin), gi_vec_from(ray->direction), ray->t_min,
        ray->t_max, GI_SHAPE_NONE, GI_SHAPE_NONE};
}

bool glint_trace(const GlintScene *scene, const GlintRay *ray, GlintHit *hit) {
    GI_ASSERT(scene != NULL && scene->committed && ray != NULL && hit != NULL);
    GI_ASSERT(is_finite3(ray->origin) && is_finite3(ray->direction) && !is_zero3(ray->direction));
    const GiWorld *world = &scene->world;
    GiTraceRay inner = trace_ray(ray);
    GiTraceHit found;
    if (!scene->kernel->closest(&world->trace, &inner, &found)) return false;
    GiSurfacePoint at = gi_shape_point(&world->shapes, found.shape, found.instance, inner.origin,
        inner.direction, found.t, world->rules->cone_geometric);
    const GiShapeInfo *info = gi_shape_info(&world->shapes, found.shape, found.instance);
    *hit = (GlintHit){
        .t = found.t,
        .point = {at.point.x, at.point.y, at.point.z},
        .normal = {at.normal.x, at.normal.y, at.normal.z},
        .surface = {info->order + 1},
        .shader = {info->shader},
    };
    return true;
}

bool glint_occluded(const GlintScene *scene, const GlintRay *ray) {
    GI_ASSERT(scene != NULL && scene->committed && ray != NULL);
    GI_ASSERT(is_finite3(ray->origin) && is_finite3(ray->direction) && !is_zero3(ray->direction));
    GiTraceRay inner = trace_ray(ray);
    return scene->kernel->any(&scene->world.trace, &inner);
}
