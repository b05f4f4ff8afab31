/* SPDX-License-Identifier: MIT
 * What a surface sends toward the viewer. The code reads as docs/scene-format.md does; what differs
 * between years is asked of GiRules. */
#pragma once

#include "scene/scene.h"

/* The part of light that comes from direction l (unit) and leaves toward v (unit), times the cosine
 * n.l: light of irradiance-like strength E adds E * this. */
GiVec gi_shade_reflect(
    const GiShader *shader, const GiRules *rules, GiVec normal, GiVec toward_viewer, GiVec l);

/* What is there without any light. */
GiVec gi_shade_emit(const GiShader *shader, GiVec normal);

/* What lights without a place add: ambient, constant and normal lights. */
GiVec gi_shade_ambient(const GiShader *shader, const GiLight *light, GiVec normal);

/* (n + 1) / 2 */
GiVec gi_shade_normal_color(GiVec normal);

/* E of a point light at the given squared distance. */
GiVec gi_light_strength(const GiLight *light, const GiRules *rules, double distance_square);
