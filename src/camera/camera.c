/* SPDX-License-Identifier: MIT */
#include "camera/camera.h"

#include "mistake/mistake.h"

GiView gi_view_of(const GiCamera *camera) {
    GiVec d = gi_normalize(camera->view_direction);
    GiVec w = gi_vec_is_zero(camera->projection_normal) ? gi_negate(d)
                                                        : gi_normalize(camera->projection_normal);
    if (gi_dot(w, d) > 0) w = gi_negate(w);
    GiVec u = gi_normalize(gi_cross(gi_normalize(camera->view_up), w));
    GiVec v = gi_cross(w, u);
    bool parallel = camera->type == GLINT_CAMERA_PARALLEL;
    return (GiView){
        .parallel = parallel,
        .eye = camera->view_point,
        .center = parallel ? d : gi_scale(d, camera->projection_distance),
        .across = gi_scale(u, camera->view_width),
        .up = gi_scale(v, camera->view_height),
    };
}

/* ---------------------------------------------------------------- mistakes */

/* What is wrong with the values of the scene. */
static GiCamera spoil_values(GiCamera camera, const GlintMistakes *mistakes, double pixel_aspect) {
    double width = camera.view_width;
    if (GI_MISTAKE_HAS(mistakes, WINDOW_SWAPPED)) {
        camera.view_width = camera.view_height;
        camera.view_height = width;
    }
    if (GI_MISTAKE_HAS(mistakes, WINDOW_SQUARE)) camera.view_height = camera.view_width;
    if (GI_MISTAKE_HAS(mistakes, WINDOW_PIXELS)) {
        camera.view_height = camera.view_width * pixel_aspect;
    }
    if (GI_MISTAKE_HAS(mistakes, WINDOW_TILT)) camera.projection_normal = gi_vec(0, 0, 0);
    if (GI_MISTAKE_HAS(mistakes, WINDOW_DISTANCE)) camera.projection_distance = 1;
    return camera;
}

/* What is wrong with the basis. */
static void spoil_basis(GiView *view, const GiCamera *camera, const GlintMistakes *mistakes) {
    GiVec w = gi_normalize(gi_cross(view->across, view->up));
    GiVec up = camera->view_up;
    if (GI_MISTAKE_HAS(mistakes, UP_LENGTH)) {
        GiVec u = gi_cross(up, w);
        view->across = gi_scale(u, camera->view_width);
        view->up = gi_scale(gi_cross(w, u), camera->view_height);
    }
    if (GI_MISTAKE_HAS(mistakes, UP_SKEWED)) {
        view->up = gi_scale(gi_normalize(up), camera->view_height);
    }
    if (GI_MISTAKE_HAS(mistakes, VIEW_LENGTH) && !view->parallel) {
        view->center = gi_scale(camera->view_direction, camera->projection_distance);
    }
}

GiView gi_view_spoiled(
    const GiCamera *camera, const GlintMistakes *mistakes, int width, int height) {
    const GiCamera own = spoil_values(*camera, mistakes, (double)height / width);
    GiView view = gi_view_of(&own);
    spoil_basis(&view, &own, mistakes);
    if (GI_MISTAKE_HAS(mistakes, PIXEL_SPAN)) {
        /* x / (width - 1) for (x + 1/2) / width is a window that is wider about its centre. */
        if (width > 1) view.across = gi_scale(view.across, width / (width - 1.0));
        if (height > 1) view.up = gi_scale(view.up, height / (height - 1.0));
    }
    if (!GI_MISTAKE_HAS(mistakes, SHIFTED)) return view;
    int x, y;
    gi_mistake_shift(mistakes, &x, &y);
    /* The picture goes right and down where the window goes left and up. */
    GiVec move =
        gi_add(gi_scale(view.across, -0.5 * x / width), gi_scale(view.up, 0.5 * y / height));
    GiVec *center = view.parallel ? &view.eye : &view.center;
    *center = gi_add(*center, move);
    return view;
}
