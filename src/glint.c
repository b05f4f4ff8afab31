/* SPDX-License-Identifier: MIT
 * The public functions of scenes: they check arguments and call a room. Building by calls is in
 * glint_build.c, pictures are in image/image.c, dialects in scene/dialect.c, instruction sets in
 * kernel/dispatch.c. */
#include "glint/glint.h"

#include "base/assert.h"
#include "check/check.h"
#include "base/cookie.h"
#include "base/error.h"
#include "port/file.h"
#include "glint_scene.h"
#include "image/image.h"
#include "render/show.h"
#include "port/machine.h"
#include "reader/reader.h"
#include "render/broken.h"

#include <stdlib.h>
#include <string.h>

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
    scene->keeps_sources = desc->keep_sources;
    scene->reverses_transforms = desc->reverse_transforms;
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
    if (scene->sources.memory != NULL) gi_sources_reset(&scene->sources);
    gi_file_names_reset(&scene->missing_files, &scene->memory);
    GI_ASSERT(atomic_load(&scene->memory.used) == 0);
    GlintAllocator allocator = scene->memory.allocator;
    allocator.reallocate(allocator.user, scene, sizeof *scene, 0);
}

/* ---------------------------------------------------------------- load */

static bool is_empty(const GiScene *model) {
    return !model->has_camera && !model->has_image && model->shaders.count == 1 &&
           model->lights.count == 0 && model->shape_count == 0 && model->groups.count == 0 &&
           model->meshes.meshes.count == 0 && model->textures.count == 0 &&
           model->environment.face == 0;
}

static GlintStatus load(GlintScene *scene, GiReaderSource *source, GlintError *error) {
    if (scene->committed || scene->broken || !is_empty(&scene->model)) {
        return ARGUMENT(error, "a file can only be loaded into an empty scene");
    }
    source->diagnostic = scene->diagnostic;
    source->diagnostic_user = scene->diagnostic_user;
    source->dialect = scene->dialect;
    source->thread_count = scene->thread_count;
    source->missing_files = &scene->missing_files;
    if (scene->keeps_sources) {
        scene->broken = !gi_sources_init(&scene->sources, &scene->memory, source->name);
        if (scene->broken) return gi_error_memory(error);
        source->sources = &scene->sources;
    }
    double start = gi_machine_seconds();
    GiReaderResult result = {0};
    GlintStatus status = gi_reader_load(&scene->model, source, &result, error);
    scene->stats.read_seconds = gi_machine_seconds() - start;
    scene->stats.read_bytes = (uint64_t)result.byte_count;
    scene->broken = status != GLINT_OK;
    return status;
}

enum { MAPPED_SIZE = 2 * 1024 * 1024 }; /* of a file that is not read but mapped */

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
    GiFileBytes mapped = {.bytes = NULL};
    bool large = file.size >= MAPPED_SIZE && !scene->keeps_sources;
    if (large && gi_file_bytes_map(&mapped, &file)) source.mapped = &mapped;
    status = load(scene, &source, error);
    gi_file_bytes_free(&mapped, &scene->memory);
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

/* ---------------------------------------------------------------- commit, render */

/* The pool, with as many workers as `jobs` jobs can keep busy and the scene may have. A thread
 * takes longer to start than a small scene takes to draw. */
static GlintStatus need_workers(GlintScene *scene, size_t jobs, GlintError *error) {
    int size = gi_pool_size(scene->thread_count);
    if (jobs < (size_t)size) size = (int)jobs;
    if (scene->pool != NULL && gi_pool_worker_count(scene->pool) >= size) return GLINT_OK;
    gi_pool_destroy(scene->pool);
    scene->pool = NULL;
    GlintStatus status = gi_pool_create(&scene->memory, size, &scene->pool);
    if (status == GLINT_OK) return status;
    return gi_error_set(error, status, "%s", glint_status_text(status));
}

/* How many can help to build the tree. */
static size_t build_jobs(const GiScene *model) {
    enum { FEW = 1024 };
    bool small =
        model->shape_count < FEW && model->groups.count == 0 && model->meshes.meshes.count == 0;
    return small ? 1 : SIZE_MAX;
}

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
    model->reverse_transforms = scene->reverses_transforms;
    double start = gi_machine_seconds();
    GlintStatus status = need_workers(scene, build_jobs(model), error);
    if (status == GLINT_OK) {
        status = gi_world_commit(&scene->world, model, scene->kernel, scene->pool, monitor, error);
    }
    scene->broken = status != GLINT_OK;
    if (status != GLINT_OK) return status;
    scene->committed = true;
    GlintStats *stats = &scene->stats;
    const GiWorld *world = &scene->world;
    stats->build_seconds = gi_machine_seconds() - start;
    stats->thread_count = gi_pool_size(scene->thread_count);
    stats->primitive_count = world->primitive_count;
    stats->node_count = world->node_count;
    stats->leaf_count = world->leaf_count;
    stats->tree_bytes = world->tree_bytes;
    stats->sah_cost = world->store.sah_cost;
    return GLINT_OK;
}

/* A check draws pictures so small that few workers are of use. */
GlintStatus glint_scene_check(GlintScene *scene, const GlintMonitor *monitor, GlintError *error) {
    enum { JOBS = 16 };
    if (scene == NULL) return ARGUMENT(error, "scene is null");
    if (!scene->committed) return ARGUMENT(error, "the scene is not committed");
    GlintStatus status = need_workers(scene, JOBS, error);
    if (status != GLINT_OK) return status;
    const GiCheckInput input = {.world = &scene->world,
        .pool = scene->pool,
        .sources = &scene->sources,
        .monitor = monitor,
        .diagnostic = scene->diagnostic,
        .diagnostic_user = scene->diagnostic_user};
    return gi_check(&input, error);
}

bool glint_scene_file(const GlintScene *scene, int index, GlintSceneFile *file) {
    GI_ASSERT(scene != NULL && file != NULL && index >= 0);
    const GiScene *model = &scene->model;
    if ((size_t)index >= model->files.count) return false;
    const GiSceneFile *found = &model->files.data[index];
    *file = (GlintSceneFile){.kind = found->kind,
        .name = model->file_names.data + found->name,
        .path = model->file_names.data + found->path,
        .size = found->size,
        .digest = found->digest};
    return true;
}

bool glint_scene_source(
    GlintScene *scene, GlintObjectKind kind, uint32_t index1, GlintSource *source) {
    GI_ASSERT(scene != NULL && source != NULL && (unsigned)kind < GLINT_OBJECT_KIND_COUNT);
    return gi_sources_find(&scene->sources, kind, index1, source);
}

const char *glint_scene_missing_file(const GlintScene *scene, size_t index) {
    GI_ASSERT(scene != NULL);
    return gi_file_names_at(&scene->missing_files, index);
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

GlintStatus gi_scene_plan_render(GlintScene *scene, const GlintRenderDesc *desc, GiRenderArea *area,
    GiRenderTarget *target, GiView *view, GlintError *error) {
    if (scene == NULL || desc == NULL) return ARGUMENT(error, "scene or desc is null");
    if (desc->cookie != GI_COOKIE) return ARGUMENT(error, NO_DEFAULT("glint_render_desc_default"));
    if (!scene->committed) return ARGUMENT(error, "the scene is not committed");
    *area = (GiRenderArea){
        .width = desc->width != 0 ? desc->width : scene->model.width,
        .height = desc->height != 0 ? desc->height : scene->model.height,
        .x = desc->crop_x,
        .y = desc->crop_y,
    };
    const char *fault = gi_scene_check_image_size(area->width, area->height);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    if (area->x < 0 || area->y < 0 || area->x >= area->width || area->y >= area->height) {
        return ARGUMENT(error, "the corner of the crop lies outside of the picture");
    }
    area->crop_width = desc->crop_width != 0 ? desc->crop_width : area->width - area->x;
    area->crop_height = desc->crop_height != 0 ? desc->crop_height : area->height - area->y;
    if (area->crop_width < 1 || area->crop_width > area->width - area->x || area->crop_height < 1 ||
        area->crop_height > area->height - area->y) {
        return ARGUMENT(error, "the crop reaches outside of the picture");
    }
    if (desc->samples < 0 || desc->samples > GI_SAMPLES_LIMIT) {
        return ARGUMENT(error, "samples must be from 1 to %d", GI_SAMPLES_LIMIT);
    }
    if ((unsigned)desc->sampling > GLINT_SAMPLING_RANDOM) {
        return ARGUMENT(error, "no such sampling");
    }
    if (desc->light < -1 || desc->light > (int)scene->model.lights.count) {
        return ARGUMENT(error, "there is no such light");
    }
    if ((unsigned)desc->show >= GLINT_SHOW_COUNT) return ARGUMENT(error, "no such thing to show");
    bool outputs = desc->depth != NULL || desc->normal != NULL || desc->albedo != NULL ||
                   desc->surface != NULL || desc->light != 0;
    if (desc->show != GLINT_SHOW_PICTURE && desc->mistakes.set != 0) {
        return ARGUMENT(error, "only pictures are drawn with mistakes");
    }
    if (desc->show != GLINT_SHOW_PICTURE && outputs) {
        return ARGUMENT(error, "what is shown has no light and no outputs beside the pixels");
    }
    fault = gi_mistake_check(&desc->mistakes, (int)scene->model.lights.count);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    int samples = desc->samples != 0 ? desc->samples : scene->model.samples;
    GiCamera camera = scene->model.camera;
    if (desc->camera != NULL) {
        GlintStatus status = gi_glint_camera(desc->camera, &camera, error);
        if (status != GLINT_OK) return status;
    }
    *view = gi_view_of(&camera);
    *target = (GiRenderTarget){
        .samples = GI_MISTAKE_HAS(&desc->mistakes, ONE_SAMPLE) ? 1 : samples,
        .view = view,
        .depth = desc->depth,
        .normal = desc->normal,
        .albedo = desc->albedo,
        .surface = desc->surface,
        .light = desc->light,
        .sampling = desc->sampling,
    };
    size_t across = (size_t)(area->crop_width - 1) / GI_RENDER_TILE_LEAST + 1;
    size_t down = (size_t)(area->crop_height - 1) / GI_RENDER_TILE_LEAST + 1;
    return need_workers(scene, across * down, error);
}

static void end_render(GlintScene *scene, double start, const GiRenderCounts *counts) {
    scene->stats.trace_seconds = gi_machine_seconds() - start;
    scene->stats.camera_rays = counts->camera_rays;
    scene->stats.shadow_rays = counts->shadow_rays;
    scene->stats.other_rays = counts->other_rays;
}

static GlintStatus render(GlintScene *scene, const GiWorld *world, const GiRenderArea *area,
    const GlintMonitor *monitor, const GiRenderTarget *target, GlintError *error) {
    double start = gi_machine_seconds();
    GiRenderCounts counts = {0};
    GlintStatus status = gi_render(world, scene->pool, area, monitor, target, &counts);
    end_render(scene, start, &counts);
    return status == GLINT_OK ? status
                              : gi_error_set(error, status, "%s", glint_status_text(status));
}

/* Something else than the picture. */
static GlintStatus show(GlintScene *scene, const GiRenderArea *area, const GlintRenderDesc *desc,
    const GiView *view, float *pixels, GlintError *error) {
    double start = gi_machine_seconds();
    GiRenderCounts counts;
    int samples = desc->samples != 0 ? desc->samples : 1;
    GiShow shown = {.what = desc->show, .samples = samples, .view = view, .color = pixels};
    GlintStatus status = gi_show(&scene->world, scene->pool, area, desc->monitor, &shown, &counts);
    end_render(scene, start, &counts);
    bool has_range = desc->show == GLINT_SHOW_DEPTH || desc->show == GLINT_SHOW_COST;
    if (desc->shown_range != NULL && has_range)
        memcpy(desc->shown_range, shown.range, sizeof shown.range);
    return status == GLINT_OK ? status
                              : gi_error_set(error, status, "%s", glint_status_text(status));
}

/* With the mistakes of the desc: first those of the scene, then those of the finished picture. */
static GlintStatus render_broken(GlintScene *scene, const GiRenderArea *area,
    const GlintRenderDesc *desc, GiRenderTarget *target, GlintError *error) {
    bool second = (desc->mistakes.set & GI_MISTAKES_OF_PICTURE) != 0;
    size_t size = 3 * sizeof(float) * (size_t)area->crop_width * (size_t)area->crop_height;
    float *pixels = target->color, *first = pixels;
    GlintStatus status = GLINT_ERROR_MEMORY;
    GiCamera camera = scene->model.camera;
    if (desc->camera != NULL)
        gi_glint_camera(desc->camera, &camera, NULL); /* it has been checked */
    target->view = NULL;                              /* but the broken world's */
    GiBroken *broken = gi_memory_allocate(&scene->memory, sizeof *broken);
    if (second) first = gi_memory_allocate(&scene->memory, size);
    if (broken != NULL && first != NULL &&
        gi_broken_init(broken, &scene->world, &camera, &desc->mistakes, area)) {
        target->color = first;
        status = render(scene, &broken->world, area, desc->monitor, target, error);
        gi_broken_reset(broken);
    } else {
        gi_error_memory(error);
    }
    if (status == GLINT_OK && second) {
        gi_mistake_apply(&desc->mistakes, area->crop_width, area->crop_height, first, pixels);
    }
    if (second) gi_memory_free(&scene->memory, first, size);
    gi_memory_free(&scene->memory, broken, sizeof *broken);
    return status;
}

GlintStatus glint_render(
    GlintScene *scene, const GlintRenderDesc *desc, float *pixels, GlintError *error) {
    if (pixels == NULL) return ARGUMENT(error, "pixels is null");
    GiRenderArea area;
    GiRenderTarget target;
    GiView view;
    GlintStatus status = gi_scene_plan_render(scene, desc, &area, &target, &view, error);
    if (status != GLINT_OK) return status;
    if (desc->show != GLINT_SHOW_PICTURE) {
        return show(scene, &area, desc, &view, pixels, error);
    }
    target.color = pixels;
    if (desc->mistakes.set != 0) return render_broken(scene, &area, desc, &target, error);
    return render(scene, &scene->world, &area, desc->monitor, &target, error);
}

/* ---------------------------------------------------------------- render and save */

static GlintStatus save_afterwards(GlintScene *scene, const GiRenderArea *area,
    const GlintRenderDesc *desc, const char *path, const GlintSaveDesc *save, GlintError *error) {
    size_t size = 3 * sizeof(float) * (size_t)area->crop_width * (size_t)area->crop_height;
    float *pixels = gi_memory_allocate(&scene->memory, size);
    if (pixels == NULL) return gi_error_memory(error);
    const GlintImage image = {area->crop_width, area->crop_height, pixels};
    GlintStatus status = glint_render(scene, desc, pixels, error);
    if (status == GLINT_OK) status = glint_image_save(&image, path, save, error);
    gi_memory_free(&scene->memory, pixels, size);
    return status;
}

/* The PNG grows with the picture, in a file that shows only when it is whole. */
static GlintStatus save_meanwhile(GlintScene *scene, const GiRenderArea *area,
    GiRenderTarget *target, const GlintMonitor *monitor, const GlintSaveDesc *save,
    const GiPngExtras *extras, GiFileWriter *file, GlintError *error) {
    const GiPngDesc desc = {.width = area->crop_width,
        .height = area->crop_height,
        .worker_count = gi_pool_worker_count(scene->pool),
        .gamma = scene->kernel->encode,
        .extras = *extras,
        .sink = gi_file_write,
        .user = file};
    GlintStatus status = gi_png_create(&scene->memory, &desc, &target->png, error);
    if (status == GLINT_OK) {
        status = render(scene, &scene->world, area, monitor, target, error);
    }
    if (status == GLINT_OK) status = gi_png_finish(target->png, error);
    gi_png_destroy(target->png);
    if (status == GLINT_OK && save->monitor != NULL && save->monitor->progress != NULL) {
        save->monitor->progress(save->monitor->user, GLINT_PHASE_WRITE, 1);
    }
    /* Of a failure of the file commit knows the reason. */
    if (status == GLINT_OK || file->error != 0) return gi_file_write_commit(file, error);
    gi_file_write_abandon(file);
    return status;
}

static GlintStatus save_png(GlintScene *scene, const GiRenderArea *area, GiRenderTarget *target,
    const GlintRenderDesc *desc, const char *path, const GlintSaveDesc *save, GlintError *error) {
    GiFileWriter file;
    if (save->layer_count > 0 || desc->mistakes.set != 0 ||
        !gi_file_write_begin_hidden(&file, path)) {
        return save_afterwards(scene, area, desc, path, save, error);
    }
    GiImageExtras extras;
    GlintStatus status;
    if (gi_image_make_extras(&scene->memory, save, &extras)) {
        status =
            save_meanwhile(scene, area, target, desc->monitor, save, &extras.extras, &file, error);
    } else {
        gi_file_write_abandon(&file);
        status = gi_error_memory(error);
    }
    gi_image_free_extras(&scene->memory, &extras);
    return status;
}

GlintStatus glint_render_save(GlintScene *scene, const GlintRenderDesc *desc, const char *path,
    const GlintSaveDesc *save, GlintError *error) {
    GiRenderArea area;
    GiRenderTarget target;
    GiView view;
    GlintStatus status = gi_scene_plan_render(scene, desc, &area, &target, &view, error);
    if (status == GLINT_OK) status = gi_image_check_desc(save, error);
    if (status == GLINT_OK) status = glint_image_check_path(path, error);
    if (status != GLINT_OK) return status;
    /* A recipe is that of a picture. */
    if (!gi_image_is_png(path) || desc->show != GLINT_SHOW_PICTURE) {
        return save_afterwards(scene, &area, desc, path, save, error);
    }
    GlintRecipe *made = NULL;
    GlintSaveDesc own = *save;
    /* A recipe has no word for a camera that is not the scene's. */
    bool makes = save->recipe == NULL && desc->camera == NULL;
    if (makes) status = glint_scene_recipe(scene, desc, false, &made, error);
    if (made != NULL) own.recipe = made;
    if (status == GLINT_OK) status = save_png(scene, &area, &target, desc, path, &own, error);
    glint_recipe_destroy(made);
    return status;
}

/* ---------------------------------------------------------------- single rays */

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
    bool is_light = gi_shape_kind(found.shape) == GI_SHAPE_RECTANGLE;
    *hit = (GlintHit){
        .t = found.t,
        .point = {at.point.x, at.point.y, at.point.z},
        .normal = {at.normal.x, at.normal.y, at.normal.z},
        .surface = {is_light ? 0 : info->order + 1},
        .shader = {is_light ? 0 : info->shader},
    };
    return true;
}

bool glint_occluded(const GlintScene *scene, const GlintRay *ray) {
    GI_ASSERT(scene != NULL && scene->committed && ray != NULL);
    GI_ASSERT(is_finite3(ray->origin) && is_finite3(ray->direction) && !is_zero3(ray->direction));
    GiTraceRay inner = trace_ray(ray);
    return scene->kernel->any(&scene->world.trace, &inner);
}
