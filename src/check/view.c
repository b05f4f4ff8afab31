/* SPDX-License-Identifier: MIT
 * Rules of the camera: what it sees, and what it misses. */
#include "check/inside.h"

#include <stdio.h>

/* ---------------------------------------------------------------- where things are in the window
 */

/* From points of space to the window: s is 1 at the window's distance (of a perspective camera) and
 * below 0 behind the eye; a and b are as in gi_view_ray. */
typedef struct Lens {
    bool parallel;
    GiAffine to_window;
    double pixel; /* the shorter side of a pixel where s is 1 */
} Lens;

static bool lens_init(const GiCheck *check, Lens *lens) {
    const GiView *view = &check->world->view;
    const GiAffine to_world = {{{view->center.x, view->across.x, view->up.x, view->eye.x},
        {view->center.y, view->across.y, view->up.y, view->eye.y},
        {view->center.z, view->across.z, view->up.z, view->eye.z}}};
    double across = gi_length(view->across) / check->scene->width;
    double up = gi_length(view->up) / check->scene->height;
    *lens = (Lens){.parallel = view->parallel, .pixel = across < up ? across : up};
    return gi_affine_invert(&to_world, &lens->to_window);
}

/* The part of the window that a box may cover. */
typedef struct Patch {
    bool behind;    /* all of it */
    bool whole;     /* some of it is behind the eye, or it has no bounds: it may be anywhere */
    double nearest; /* s of the corner that is nearest to the eye */
    double low[2], high[2];
} Patch;

static Patch patch_of(const Lens *lens, const GiBox *box) {
    Patch patch = {.behind = true, .nearest = INFINITY};
    patch.low[0] = patch.low[1] = INFINITY;
    patch.high[0] = patch.high[1] = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        GiVec p = gi_vec(corner & 1 ? box->high.x : box->low.x,
            corner & 2 ? box->high.y : box->low.y, corner & 4 ? box->high.z : box->low.z);
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
            patch.behind = false;
            patch.whole = true;
            continue;
        }
        GiVec q = gi_affine_point(&lens->to_window, p);
        patch.behind &= q.x <= 0;
        patch.whole |= q.x <= 0;
        patch.nearest = fmin(patch.nearest, q.x);
        double at[2] = {q.y, q.z};
        for (int i = 0; i < 2; i++) {
            double x = (lens->parallel ? at[i] : at[i] / q.x) + 0.5;
            patch.low[i] = fmin(patch.low[i], x);
            patch.high[i] = fmax(patch.high[i], x);
        }
    }
    for (int i = 0; i < 2; i++) {
        if (patch.whole || patch.low[i] < 0) patch.low[i] = 0;
        if (patch.whole || patch.high[i] > 1) patch.high[i] = 1;
    }
    return patch;
}

static bool misses_window(const Patch *patch) {
    return patch->behind || patch->low[0] > patch->high[0] || patch->low[1] > patch->high[1];
}

/* ---------------------------------------------------------------- nothing in view */

/* The rays of the pixels of a patch; of many pixels those of a grid. */
static bool finds(const GiCheck *check, const Patch *patch) {
    enum { GRID = 64 };
    const int size[2] = {check->scene->width, check->scene->height};
    double first[2], step[2];
    int count[2];
    for (int i = 0; i < 2; i++) {
        double begin = floor(patch->low[i] * size[i]), end = ceil(patch->high[i] * size[i]);
        if (end < begin + 1) end = begin + 1;
        count[i] = end - begin < GRID ? (int)(end - begin) : GRID;
        step[i] = (end - begin) / count[i];
        first[i] = begin;
    }
    GiSight sight;
    for (int y = 0; y < count[1]; y++) {
        for (int x = 0; x < count[0]; x++) {
            double a = (first[0] + floor(x * step[0]) + 0.5) / size[0];
            double b = (first[1] + floor(y * step[1]) + 0.5) / size[1];
            if (gi_survey_look(check, a, b, &sight)) return true;
        }
    }
    return false;
}

/* The survey has seen nothing: is there something small? */
static bool sees_something(GiCheck *check, const Lens *lens) {
    enum { TRIES = 4096 };
    const Patch window = {.high = {1, 1}};
    int tries = 0;
    if (finds(check, &window)) return true; /* a light */
    for (size_t i = 0; i < check->census.count; i++) {
        Patch patch = patch_of(lens, &check->census.data[i].bounds);
        if (misses_window(&patch)) continue;
        if (++tries > TRIES || finds(check, &patch)) return true;
        if (tries % 16 == 0 && gi_check_stopped(check)) return true;
    }
    return false;
}

static GiBox whole_bounds(const GiCheck *check) {
    GiBox all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < check->census.count; i++) {
        const GiBox *box = &check->census.data[i].bounds;
        all.low = gi_vec(
            fmin(all.low.x, box->low.x), fmin(all.low.y, box->low.y), fmin(all.low.z, box->low.z));
        all.high = gi_vec(fmax(all.high.x, box->high.x), fmax(all.high.y, box->high.y),
            fmax(all.high.z, box->high.z));
    }
    return all;
}

static void report_nothing(GiCheck *check, const Lens *lens, int64_t camera) {
    size_t behind = 0, count = check->census.count;
    for (size_t i = 0; i < count; i++) {
        behind += patch_of(lens, &check->census.data[i].bounds).behind;
    }
    GiBox all = whole_bounds(check);
    GiVec d = gi_sub(gi_scale(gi_add(all.low, all.high), 0.5), check->world->view.eye);
    char hint[120] = "";
    if (isfinite(d.x + d.y + d.z) && !gi_vec_is_zero(d)) {
        snprintf(hint, sizeof hint,
            "\nthe middle of the scene is seen with <viewDir>%.4g %.4g %.4g"
            "</viewDir>",
            d.x, d.y, d.z);
    }
    gi_check_add(check, GI_CHECK_NOTHING_IN_VIEW, camera, "the camera sees nothing: %s%s",
        behind == count ? "everything lies behind it"
        : behind == 0   ? "everything lies beside its window, or between its rays"
                        : "everything lies behind it, beside its window, or between its rays",
        hint);
}

/* ---------------------------------------------------------------- what is not seen */

/* How long the second of three sides is: what is thinner in two directions has no pixels. */
static double second_side(double a, double b, double c) {
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

/* How large a shape is in its second largest direction; of a mesh or group in its largest. */
static double thickness_of(const GiCheck *check, const GiCheckItem *item) {
    const GiShapes *shapes = check->world->trace.shapes;
    double stretch[3] = {1, 1, 1};
    uint32_t i = gi_shape_index(item->ref);
    if (gi_shape_kind(item->ref) == GI_SHAPE_PLACED) {
        const GiAffine *m = &shapes->transforms[shapes->placements[i].transform].to_world;
        for (int k = 0; k < 3; k++) {
            stretch[k] = gi_length(gi_vec(m->m[0][k], m->m[1][k], m->m[2][k]));
        }
    } else if (gi_shape_kind(item->ref) > GI_SHAPE_PLACED) {
        GiVec size = gi_sub(item->bounds.high, item->bounds.low);
        return fmax(size.x, fmax(size.y, size.z));
    }
    GiShapeRef own = gi_shape_unplaced(shapes, item->ref);
    if (gi_shape_kind(own) == GI_SHAPE_DISC) {
        double radius = shapes->discs[gi_shape_index(own)].radius;
        return 2 * radius * fmax(stretch[0], fmax(stretch[1], stretch[2]));
    }
    GiBox box = gi_shape_bounds(shapes, own, GI_SHAPE_NONE);
    GiVec size = gi_sub(box.high, box.low);
    return second_side(size.x * stretch[0], size.y * stretch[1], size.z * stretch[2]);
}

static void check_sizes(GiCheck *check, const Lens *lens) {
    const double least = 0.01; /* pixels */
    for (size_t i = 0; i < check->census.count; i++) {
        const GiCheckItem *item = &check->census.data[i];
        if (i % 4096 == 0 && gi_check_stopped(check)) return;
        Patch patch = patch_of(lens, &item->bounds);
        int64_t place = gi_check_place(check, GLINT_OBJECT_SURFACE, item->order + 1);
        const char *word = gi_check_word(check, item->ref);
        if (misses_window(&patch)) {
            gi_check_add(check, GI_CHECK_OUT_OF_VIEW, place,
                "the camera does not see this %s: it "
                "lies %s",
                word, patch.behind ? "behind the camera" : "outside of the window");
            continue;
        }
        if (patch.whole) continue;
        double thickness = thickness_of(check, item);
        double pixels = thickness / ((lens->parallel ? 1 : patch.nearest) * lens->pixel);
        if (!(pixels < least)) continue;
        if (thickness == 0) {
            gi_check_add(check, GI_CHECK_TOO_SMALL, place,
                "this %s has no extent, so nothing can "
                "meet it%s",
                word,
                word[0] == 'b' ? "\ngive it two opposite corners, minPt and "
                                 "maxPt"
                               : "");
        } else {
            gi_check_add(check, GI_CHECK_TOO_SMALL, place,
                "this %s is %.1g pixels thick, less "
                "than a hundredth, so hardly any ray meets it",
                word, pixels);
        }
    }
}

/* ---------------------------------------------------------------- the camera in a solid */

static bool shines_anywhere(const GiCheck *check) {
    for (size_t i = 0; i < check->scene->lights.count; i++) {
        GlintLightType type = check->scene->lights.data[i].type;
        if (type == GLINT_LIGHT_AMBIENT || type == GLINT_LIGHT_CONSTANT ||
            type == GLINT_LIGHT_NORMAL) {
            return true;
        }
    }
    return false;
}

/* Whether a light stands in the solid, as in a room; on its wall counts. */
static bool has_light(const GiCheck *check, uint32_t order) {
    for (size_t i = 0; i < check->scene->lights.count; i++) {
        const GiLight *light = &check->scene->lights.data[i];
        GiSolid solids[GI_SOLID_LIMIT];
        if (light->type != GLINT_LIGHT_POINT && light->type != GLINT_LIGHT_RECTANGLE) continue;
        int count = gi_check_solids(check, light->position, 1e-7, solids);
        for (int k = 0; k < count; k++) {
            if (solids[k].order == order) return true;
        }
    }
    return false;
}

/* A box of the early years lets rays out that begin in it, so it is not there for the camera. */
static bool lets_out(const GiCheck *check, const GiSolid *solid) {
    GiShapeRef own = gi_shape_unplaced(check->world->trace.shapes, solid->ref);
    return check->world->rules->entering_only && gi_shape_kind(own) == GI_SHAPE_BOX;
}

static bool check_eye(GiCheck *check, GiVec eye, int64_t camera) {
    GiSolid solids[GI_SOLID_LIMIT];
    int count = gi_check_solids(check, eye, -1e-7, solids);
    for (int i = 0; i < count; i++) {
        char name[GI_CHECK_NAME];
        GlintShaderType type = check->scene->shaders.data[solids[i].shader].type;
        bool outward = lets_out(check, &solids[i]);
        bool bright = type == GLINT_SHADER_GLASS || type == GLINT_SHADER_RGB_NORMALS ||
                      shines_anywhere(check) || has_light(check, solids[i].order);
        if (bright && !outward) continue;
        gi_check_name(check, GLINT_OBJECT_SURFACE, solids[i].order + 1, name);
        gi_check_add(check, GI_CHECK_CAMERA_INSIDE, camera,
            "the camera stands inside the %s %s, %s", gi_check_word(check, solids[i].ref), name,
            outward ? "which is not seen from inside by the rules of 2011 and 2012"
                    : "where no light is");
        return true;
    }
    return false;
}

/* Each ray of a parallel camera has an eye of its own. */
static void check_eyes(GiCheck *check, int64_t camera) {
    enum { GRID = 8 };
    GiVec origin, direction;
    for (int i = 0; i < (GRID + 1) * (GRID + 1); i++) {
        gi_view_ray(&check->world->view, (double)(i % (GRID + 1)) / GRID,
            (double)(i / (GRID + 1)) / GRID, &origin, &direction);
        if (check_eye(check, origin, camera) || !check->world->view.parallel) return;
    }
}

/* ---------------------------------------------------------------- the window */

static void check_window(GiCheck *check, int64_t camera) {
    const double tolerance = 0.02;
    const GiScene *scene = check->scene;
    double width = scene->camera.view_width, height = scene->camera.view_height;
    double stretch = (double)scene->width / scene->height * (height / width);
    if (fabs(stretch - 1) <= tolerance || fabs(1 / stretch - 1) <= tolerance) return;
    bool wide = stretch > 1;
    gi_check_add(check, GI_CHECK_STRETCHED, camera,
        "the window is %.4g by %.4g, but the picture %d by %d: everything is drawn %.3g times as "
        "%s as it is\nmake %s %.4g",
        width, height, scene->width, scene->height, wide ? stretch : 1 / stretch,
        wide ? "wide" : "high", wide ? "viewWidth" : "viewHeight",
        wide ? width * stretch : height / stretch);
}

/* Of several cameras the last counts. */
static void check_cameras(GiCheck *check, uint32_t count) {
    char name[GI_CHECK_NAME];
    for (uint32_t i = 1; i < count; i++) {
        gi_check_add(check, GI_CHECK_CAMERA_REPLACED, gi_check_place(check, GLINT_OBJECT_CAMERA, i),
            "the camera %s takes the place of this one",
            gi_check_name(check, GLINT_OBJECT_CAMERA, count, name));
    }
}

void gi_check_view(GiCheck *check) {
    uint32_t cameras = (uint32_t)check->input->sources->objects[GLINT_OBJECT_CAMERA].count;
    int64_t camera = gi_check_place(check, GLINT_OBJECT_CAMERA, cameras);
    check_cameras(check, cameras);
    check_window(check, camera);
    Lens lens;
    check->in_view = check->survey.seen > 0;
    if (!lens_init(check, &lens)) {
        check->in_view = true; /* a window at the end of the world: nothing is said of it */
        return;
    }
    check->in_view = check->in_view || sees_something(check, &lens);
    if (gi_check_stopped(check)) return;
    if (!check->in_view && check->scene->environment.face == 0) {
        if (check->census.count > 0) {
            report_nothing(check, &lens, camera);
        } else {
            gi_check_add(check, GI_CHECK_NOTHING_IN_VIEW, check->root, "the scene has no surface");
        }
    }
    check_eyes(check, camera);
    check_sizes(check, &lens);
}
