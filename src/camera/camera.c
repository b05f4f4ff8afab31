/* SPDX-License-Identifier: MIT */
#include "camera/camera.h"

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
