/* SPDX-License-Identifier: MIT
 * Lights: how they weaken with distance, and what the large ones do. */
#include "format/upgrade.h"

/* In the years whose diffuse term is kd, also for light that is given as radiance, a rectangle is
 * pi times as bright as the same one in `glint`. */
static void upgrade_rectangle(GiUpgrade *upgrade, size_t token) {
    const GiRules *from = upgrade->from, *to = upgrade->to;
    if (upgrade->document->scene.integrator == GLINT_INTEGRATOR_POINT_LIGHT) return;
    bool dimmer = !from->diffuse_over_pi && !from->radiance_over_pi && to->radiance_over_pi;
    if (dimmer) {
        static const double white[3] = {1, 1, 1}, pi = 3.1415926535897931;
        bool scaled = gi_upgrade_scale(upgrade, token, GI_SLOT_INTENSITY, "intensity", white, pi);
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            scaled ? "the intensity of a rectangle of light times pi, since its diffuse term is "
                     "now kd / pi: highlights and facets get too much of it"
                   : "the diffuse term of a rectangle of light is now kd / pi: multiply its "
                     "intensity by pi");
    }
    if (from->area_light_visible != to->area_light_visible) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "a rectangle of light can now be seen, is black from behind, and casts shadows");
    }
}

void gi_upgrade_light(GiUpgrade *upgrade, size_t token) {
    const GiType *type = upgrade->document->tokens.data[token].type;
    if (type->context == GI_IN_RECTANGLE_LIGHT) upgrade_rectangle(upgrade, token);
    if (type->context != GI_IN_POINT_LIGHT || upgrade->from->falloff == upgrade->to->falloff ||
        gi_upgrade_child(upgrade, token, GI_SLOT_FALLOFF) != GI_NO_TOKEN) {
        return;
    }
    const char *const children[] = {
        upgrade->from->falloff ? "<falloff>inverse-square</falloff>" : "<falloff>none</falloff>"};
    gi_edit_append(&upgrade->edits, token, gi_upgrade_name(upgrade, token), children, 1);
    gi_upgrade_note(upgrade, GLINT_CHANGE_SAME, token,
        "the light falls off with the square of the distance, which is now said");
}
