/* SPDX-License-Identifier: MIT
 * The public function that grades: it loads the reference, and draws what src/grade asks for. */
#include "glint/glint.h"

#include "base/cookie.h"
#include "compare/compare.h"
#include "compare/load.h"
#include "glint_scene.h"
#include "grade/grade.h"
#include "render/broken.h"

#include <stdio.h>
#include <string.h>

GlintGradeDesc glint_grade_desc_default(void) {
    return (GlintGradeDesc){.scene = glint_scene_desc_default(),
        .compare = glint_compare_desc_default(),
        .pairs = true,
        .cookie = GI_COOKIE};
}

typedef struct Grading {
    GiMemory memory;
    const GlintGradeDesc *desc;
    const GlintImage *image;
    const char *path;  /* of the reference */
    GlintScene *scene; /* null: the reference is a picture */
    GlintScene
        *reversed; /* the scene with its transforms in reverse order, when it was asked for */
    float *right;
    size_t size;         /* of right */
    GlintMonitor inside; /* of drawings while mistakes are tried: cancels only */
} Grading;

/* ---------------------------------------------------------------- scenes */

static GlintStatus open_scene(
    const Grading *grading, bool reversed, GlintScene **scene, GlintError *error) {
    GlintSceneDesc desc = grading->desc->scene;
    desc.reverse_transforms = reversed;
    if (reversed) desc.diagnostic = NULL; /* what there is to say has been said */
    const GlintMonitor *monitor = reversed ? &grading->inside : grading->desc->monitor;
    GlintStatus status = glint_scene_create(&desc, scene, error);
    if (status == GLINT_OK) status = glint_scene_load_file(*scene, grading->path, monitor, error);
    if (status == GLINT_OK) status = glint_scene_commit(*scene, monitor, error);
    return status;
}

static GlintRenderDesc render_desc(const Grading *grading) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = grading->image->width;
    desc.height = grading->image->height;
    desc.samples = grading->desc->samples;
    desc.monitor = &grading->inside;
    return desc;
}

/* Whether anything in the scene depends on these mistakes. */
static GlintStatus makes_difference(
    const Grading *grading, const GlintMistakes *mistakes, bool *differs, GlintError *error) {
    GlintScene *scene = grading->scene;
    const GiRenderArea area = {.width = grading->image->width, .height = grading->image->height};
    GiBroken *broken = gi_memory_allocate(&scene->memory, sizeof *broken);
    bool good = broken != NULL &&
                gi_broken_init(broken, &scene->world, &scene->model.camera, mistakes, &area);
    *differs = good && broken->differs;
    if (good) gi_broken_reset(broken);
    gi_memory_free(&scene->memory, broken, sizeof *broken);
    int samples = grading->desc->samples != 0 ? grading->desc->samples : scene->model.samples;
    if (GI_MISTAKE_HAS(mistakes, ONE_SAMPLE) && samples > 1) *differs = true;
    if (GI_MISTAKE_HAS(mistakes, TRANSFORMS_REVERSED) && scene->world.spread.transforms.count > 0) {
        *differs = true;
    }
    return good ? GLINT_OK : gi_error_memory(error);
}

static GlintStatus draw_scene(void *user, const GlintMistakes *mistakes,
    const GiGradeWindow *window, float *pixels, bool *differs, GlintError *error) {
    Grading *grading = user;
    GlintStatus status = makes_difference(grading, mistakes, differs, error);
    if (status != GLINT_OK || !*differs) return status;
    GlintScene *scene = grading->scene;
    if (GI_MISTAKE_HAS(mistakes, TRANSFORMS_REVERSED)) {
        if (grading->reversed == NULL) {
            status = open_scene(grading, true, &grading->reversed, error);
            if (status != GLINT_OK) return status;
        }
        scene = grading->reversed;
    }
    GlintRenderDesc desc = render_desc(grading);
    desc.mistakes = *mistakes;
    desc.crop_x = window->x;
    desc.crop_y = window->y;
    desc.crop_width = window->width;
    desc.crop_height = window->height;
    return glint_render(scene, &desc, pixels, error);
}

static GlintStatus draw_light(void *user, int light, float *pixels, GlintError *error) {
    const Grading *grading = user;
    GlintRenderDesc desc = render_desc(grading);
    desc.light = light;
    return glint_render(grading->scene, &desc, pixels, error);
}

/* ---------------------------------------------------------------- pictures */

static int clamp(int i, int count) { return i < 0 ? 0 : i < count ? i : count - 1; }

/* Where there is no scene to draw, a picture can still be shifted: by half pixels between two. */
static GlintStatus shift_picture(void *user, const GlintMistakes *mistakes,
    const GiGradeWindow *window, float *pixels, bool *differs, GlintError *error) {
    const Grading *grading = user;
    (void)window; /* only pairs of a scene's mistakes ask for less than all */
    (void)error;
    int width = grading->image->width, height = grading->image->height;
    *differs = true;
    for (int y = 0; y < height; y++) {
        /* What stands here came from the left and from above, when the picture moved right and
         * down; an odd number of half pixels is the mean of two. */
        int y2 = 2 * y - mistakes->shift_y, rows[2] = {y2 >> 1, (y2 + 1) >> 1};
        for (int x = 0; x < width; x++, pixels += 3) {
            int x2 = 2 * x - mistakes->shift_x, columns[2] = {x2 >> 1, (x2 + 1) >> 1};
            float sum[3] = {0, 0, 0};
            for (int k = 0; k < 4; k++) {
                size_t row = (size_t)clamp(rows[k / 2], height) * (size_t)width;
                const float *from =
                    grading->right + 3 * (row + (size_t)clamp(columns[k % 2], width));
                for (int i = 0; i < 3; i++) sum[i] += from[i];
            }
            for (int i = 0; i < 3; i++) pixels[i] = sum[i] / 4;
        }
    }
    return GLINT_OK;
}

static GlintStatus no_light(void *user, int light, float *pixels, GlintError *error) {
    (void)user;
    (void)light;
    (void)pixels;
    (void)error;
    return GLINT_OK;
}

/* The values at a place counted in pixels, between the four pixels that are next; added to sum. */
static void add_between(
    const float *from, int width, int height, double u, double v, double sum[3]) {
    int column = (int)floor(u), row = (int)floor(v);
    for (int k = 0; k < 4; k++) {
        size_t at_row = (size_t)clamp(row + k / 2, height);
        const float *pixel =
            from + 3 * (at_row * (size_t)width + (size_t)clamp(column + k % 2, width));
        double across = k % 2 == 0 ? column + 1 - u : u - column;
        double down = k / 2 == 0 ? row + 1 - v : v - row;
        for (int i = 0; i < 3; i++) sum[i] += across * down * (double)pixel[i];
    }
}

/* Another size: each pixel is the mean over its square, of as many places as the reference has
 * pixels there. */
static void resize(
    const float *from, int from_width, int from_height, const GlintImage *like, float *to) {
    int across = (from_width - 1) / like->width + 1, down = (from_height - 1) / like->height + 1;
    for (int y = 0; y < like->height; y++) {
        for (int x = 0; x < like->width; x++, to += 3) {
            double sum[3] = {0, 0, 0};
            for (int k = 0; k < across * down; k++) {
                double u = (x + (k % across + 0.5) / across) * from_width / like->width - 0.5;
                double v = (y + (k / across + 0.5) / down) * from_height / like->height - 0.5;
                add_between(from, from_width, from_height, u, v, sum);
            }
            for (int i = 0; i < 3; i++) to[i] = (float)(sum[i] / (across * down));
        }
    }
}

/* ---------------------------------------------------------------- the reference */

static bool names_picture(const char *path) {
    static const char *const endings[] = {".png", ".pfm", ".exr", ".jpg", ".jpeg"};
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        size_t count = strlen(endings[i]), k = 0;
        if (length < count) continue;
        for (const char *c = path + length - count; k < count; k++) {
            char lower = c[k] >= 'A' && c[k] <= 'Z' ? (char)(c[k] - 'A' + 'a') : c[k];
            if (lower != endings[i][k]) break;
        }
        if (k == count) return true;
    }
    return false;
}

static void note_size(GlintGrade *grade, const GlintImage *image, int width, int height) {
    grade->width = width;
    grade->height = height;
    grade->size_differs = image->width != width || image->height != height;
}

static GlintStatus load_picture(Grading *grading, GlintGrade *grade, GlintError *error) {
    int width, height;
    float *pixels;
    GlintStatus status =
        gi_compare_load(&grading->memory, grading->path, &width, &height, &pixels, error);
    if (status != GLINT_OK) return status;
    note_size(grade, grading->image, width, height);
    if (grade->size_differs) {
        resize(pixels, width, height, grading->image, grading->right);
    } else {
        memcpy(grading->right, pixels, grading->size);
    }
    size_t size = (size_t)width * (size_t)height * 3 * sizeof(float);
    gi_memory_free(&grading->memory, pixels, size);
    return GLINT_OK;
}

static GlintStatus draw_right(Grading *grading, GlintGrade *grade, GlintError *error) {
    GlintStatus status = open_scene(grading, false, &grading->scene, error);
    if (status != GLINT_OK) return status;
    const GlintGradeDesc *desc = grading->desc;
    const GiScene *model = &grading->scene->model;
    note_size(grade, grading->image, desc->width != 0 ? desc->width : model->width,
        desc->height != 0 ? desc->height : model->height);
    GlintRenderDesc render = render_desc(grading);
    return glint_render(grading->scene, &render, grading->right, error);
}

/* ---------------------------------------------------------------- the whole */

static void report(void *user, double fraction) {
    const Grading *grading = user;
    const GlintMonitor *monitor = grading->desc->monitor;
    if (monitor == NULL || monitor->progress == NULL) return;
    monitor->progress(monitor->user, GLINT_PHASE_TRACE, fraction);
}

static GlintStatus search(Grading *grading, GlintGrade *grade, GlintError *error) {
    enum { CHEAP_SAMPLES = 600 * 600 };
    const GlintImage *image = grading->image;
    GiGradeTask task = {.memory = &grading->memory,
        .width = image->width,
        .height = image->height,
        .mine = image->pixels,
        .right = grading->right,
        .tolerance = grading->desc->compare.tolerance,
        .from_scene = grade->from_scene,
        .pairs = grading->desc->pairs,
        .draw = grade->from_scene ? draw_scene : shift_picture,
        .draw_light = grade->from_scene ? draw_light : no_light,
        .progress = report,
        .user = grading};
    if (grade->from_scene) {
        const GiScene *model = &grading->scene->model;
        int samples = grading->desc->samples != 0 ? grading->desc->samples : model->samples;
        int64_t all = (int64_t)image->width * image->height * samples;
        task.many_pairs = all <= CHEAP_SAMPLES && model->integrator != GLINT_INTEGRATOR_PATH;
        task.light_count = (int)model->lights.count;
        for (int i = 0; i < task.light_count && i < GI_GRADE_LIGHT_LIMIT; i++) {
            GlintLightType type = model->lights.data[i].type;
            task.placed[i] = type == GLINT_LIGHT_POINT || type == GLINT_LIGHT_DIRECTIONAL ||
                             type == GLINT_LIGHT_RECTANGLE;
        }
    }
    return gi_grade_search(&task, grade, error);
}

static GlintStatus grade_picture(Grading *grading, GlintGrade *grade, GlintError *error) {
    const GlintImage *image = grading->image;
    grade->from_scene = !names_picture(grading->path);
    grading->size = (size_t)image->width * (size_t)image->height * 3 * sizeof(float);
    grading->right = gi_memory_allocate(&grading->memory, grading->size);
    if (grading->right == NULL) return gi_error_memory(error);
    GlintStatus status =
        grade->from_scene ? draw_right(grading, grade, error) : load_picture(grading, grade, error);
    if (status != GLINT_OK) return status;
    const GlintImage reference = {image->width, image->height, grading->right};
    status =
        glint_image_compare(image, &reference, &grading->desc->compare, &grade->comparison, error);
    if (status == GLINT_OK) status = search(grading, grade, error);
    if (status != GLINT_OK) return status;
    grade->reference = reference;
    grading->right = NULL;
    return GLINT_OK;
}

static const char *check(
    const GlintImage *image, const char *reference, const GlintGradeDesc *desc, GlintGrade *grade) {
    if (reference == NULL || grade == NULL) return "reference or grade is null";
    if (!gi_compare_is_picture(image))
        return "there is no picture, or one of more than 2^28 pixels";
    if (desc == NULL || desc->cookie != GI_COOKIE) {
        return "the grade desc was not made by glint_grade_desc_default";
    }
    if (desc->width < 0 || desc->height < 0) return "width or height is negative";
    return gi_compare_check(&desc->compare);
}

GlintStatus glint_grade(const GlintImage *image, const char *reference, const GlintGradeDesc *desc,
    GlintGrade *grade, GlintError *error) {
    const char *fault = check(image, reference, desc, grade);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    Grading grading = {.desc = desc, .image = image, .path = reference};
    gi_memory_init(&grading.memory, NULL, 0);
    if (desc->monitor != NULL) {
        grading.inside =
            (GlintMonitor){.cancelled = desc->monitor->cancelled, .user = desc->monitor->user};
    }
    *grade = (GlintGrade){0};
    GlintStatus status = grade_picture(&grading, grade, error);
    gi_memory_free(&grading.memory, grading.right, grading.size);
    glint_scene_destroy(grading.reversed);
    glint_scene_destroy(grading.scene);
    return status;
}
