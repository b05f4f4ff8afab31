/* SPDX-License-Identifier: MIT
 * Rules of lights. */
#include "check/inside.h"

#include <stdio.h>
#include <string.h>

bool gi_check_needs_light(const GiCheck *check, uint32_t shader) {
    const GiShader *at = &check->scene->shaders.data[shader];
    for (int i = 0; i < GI_SUBSTRATE_LIMIT && at->substrate != GI_NONE; i++) {
        at = &check->scene->shaders.data[at->substrate];
    }
    return at->type != GLINT_SHADER_GLASS && at->type != GLINT_SHADER_RGB_NORMALS;
}

static bool any_needs_light(const GiCheck *check) {
    for (size_t i = 0; i < check->scene->shaders.count; i++) {
        if (check->shader_used[i] && gi_check_needs_light(check, (uint32_t)i)) return true;
    }
    return false;
}

static int64_t place_of(const GiCheck *check, size_t light) {
    return gi_check_place(check, GLINT_OBJECT_LIGHT, (uint32_t)light + 1);
}

/* ---------------------------------------------------------------- intensity */

/* False: there is nothing more to be said of the light. */
static bool check_intensity(GiCheck *check, size_t index) {
    GiVec intensity = check->scene->lights.data[index].intensity;
    if (gi_vec_is_zero(intensity)) {
        gi_check_add(
            check, GI_CHECK_LIGHT_DARK, place_of(check, index), "the light has no intensity");
        return false;
    }
    if (intensity.x < 0 || intensity.y < 0 || intensity.z < 0) {
        gi_check_add(check, GI_CHECK_LIGHT_NEGATIVE, place_of(check, index),
            "the intensity %.4g %.4g %.4g takes light away", intensity.x, intensity.y, intensity.z);
    }
    return true;
}

/* ---------------------------------------------------------------- lights in solids */

static bool is_among(const GiSolid *solids, int count, uint32_t order) {
    for (int i = 0; i < count; i++) {
        if (solids[i].order == order) return true;
    }
    return false;
}

/* Whether a solid that holds the middle of a light holds all of it: of a rectangle the corners. */
static bool holds_corners(const GiCheck *check, size_t index, uint32_t order) {
    const GiLightRectangle *rectangle = &check->world->lights.data[index];
    if (check->scene->lights.data[index].type != GLINT_LIGHT_RECTANGLE) return true;
    for (int corner = 0; corner < 4; corner++) {
        GiSolid solids[GI_SOLID_LIMIT];
        GiVec p = gi_along(rectangle->center, rectangle->across, corner & 1 ? 0.5 : -0.5);
        p = gi_along(p, rectangle->upward, corner & 2 ? 0.5 : -0.5);
        int count = gi_check_solids(check, p, -1e-7, solids);
        if (!is_among(solids, count, order)) return false;
    }
    return true;
}

/* A solid that the camera is in too is a room. Whether a parallel camera is in one is a question
 * for each of its rays, so it is asked in the middle. */
static bool check_inside(GiCheck *check, size_t index) {
    const GiLight *light = &check->scene->lights.data[index];
    if (light->type != GLINT_LIGHT_POINT && light->type != GLINT_LIGHT_RECTANGLE) return false;
    GiSolid round_light[GI_SOLID_LIMIT], round_eye[GI_SOLID_LIMIT];
    int light_count = gi_check_solids(check, light->position, -1e-7, round_light);
    if (light_count == 0) return false;
    int eye_count = gi_check_solids(check, check->world->view.eye, 1e-7, round_eye);
    for (int i = 0; i < light_count; i++) {
        if (!holds_corners(check, index, round_light[i].order)) continue;
        const GiSolid *solid = &round_light[i];
        char name[GI_CHECK_NAME];
        if (is_among(round_eye, eye_count, solid->order)) continue;
        if (!gi_check_needs_light(check, solid->shader)) continue;
        gi_check_name(check, GLINT_OBJECT_SURFACE, solid->order + 1, name);
        gi_check_add(check, GI_CHECK_LIGHT_INSIDE, place_of(check, index),
            "the light stands inside the %s %s, which lets none of it out",
            gi_check_word(check, solid->ref), name);
        return true;
    }
    return false;
}

/* ---------------------------------------------------------------- lights that reach nothing */

static bool is_dark(GiCheck *check, size_t index, int side) {
    GiSurvey survey;
    bool dark = gi_survey_draw(check, side, (int)index + 1, &survey);
    size_t values = (size_t)survey.width * (size_t)survey.height * 3;
    for (size_t i = 0; dark && i < values; i++) dark = survey.color[i] == 0;
    gi_survey_free(check, &survey);
    return dark;
}

/* Whether a rectangle shines away from all surfaces. */
static bool faces_away(const GiCheck *check, const GiLight *light) {
    GiVec front = gi_normalize(light->direction);
    for (size_t i = 0; i < check->census.count; i++) {
        const GiBox *box = &check->census.data[i].bounds;
        for (int corner = 0; corner < 8; corner++) {
            GiVec p = gi_vec(corner & 1 ? box->high.x : box->low.x,
                corner & 2 ? box->high.y : box->low.y, corner & 4 ? box->high.z : box->low.z);
            if (!(gi_dot(gi_sub(p, light->position), front) <= 0)) return false;
        }
    }
    return true;
}

static void report_reach(GiCheck *check, size_t index) {
    const GiLight *light = &check->scene->lights.data[index];
    int64_t place = place_of(check, index);
    if (light->type == GLINT_LIGHT_RECTANGLE) {
        if (check->scene->integrator == GLINT_INTEGRATOR_POINT_LIGHT) {
            gi_check_add(check, GI_CHECK_LIGHT_REACHES, place,
                "the light adds nothing: PointLightIntegrator leaves rectangles out\n"
                "take LightSamplingIntegrator");
            return;
        }
        if (faces_away(check, light)) {
            GiVec d = light->direction;
            gi_check_add(check, GI_CHECK_LIGHT_REACHES, place,
                "the light adds nothing: it shines away from all surfaces\n"
                "turn it round: <normalDir>%.4g %.4g %.4g</normalDir>",
                0 - d.x, 0 - d.y, 0 - d.z);
            return;
        }
    }
    gi_check_add(check, GI_CHECK_LIGHT_REACHES, place,
        "the light adds nothing: what the camera sees turns its back to it or lies in its shadow");
}

/* Each light alone, very small; where that is black, once more and larger. Of very many lights the
 * first are looked at. */
static void check_reach(GiCheck *check, const bool *settled) {
    static const int sides[] = {16, 64, 384};
    enum { SIDES = sizeof sides / sizeof *sides, LOOKS = 256 };
    size_t count = check->scene->lights.count;
    if (!check->in_view || !any_needs_light(check)) return;
    for (size_t i = 0; i < count && i < LOOKS && !gi_check_stopped(check); i++) {
        if (settled[i] || gi_check_is_full(check, GI_CHECK_LIGHT_REACHES)) continue;
        bool dark = true;
        for (int k = 0; k < SIDES && dark; k++) dark = is_dark(check, i, sides[k]);
        if (dark) report_reach(check, i);
    }
}

/* ---------------------------------------------------------------- the whole */

static void check_none(GiCheck *check) {
    if (check->scene->lights.count > 0 || check->world->sky_lights) return;
    if (!check->in_view || !any_needs_light(check)) return;
    GiVec eye = check->world->view.eye;
    gi_check_add(check, GI_CHECK_NO_LIGHT, check->root,
        "the scene has no light, so its surfaces are black\n"
        "add one, for example at the camera: <light><position>%.4g %.4g %.4g</position></light>",
        eye.x, eye.y, eye.z);
}

void gi_check_lights(GiCheck *check) {
    size_t count = check->scene->lights.count;
    check_none(check);
    if (count == 0) return;
    bool *settled = gi_memory_allocate(check->memory, count * sizeof *settled);
    if (settled == NULL) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    for (size_t i = 0; i < count; i++) {
        settled[i] = !check_intensity(check, i) || check_inside(check, i);
    }
    check_reach(check, settled);
    gi_memory_free(check->memory, settled, count * sizeof *settled);
}
