/* SPDX-License-Identifier: MIT
 * What a teacher would say who looks over a student's shoulder: the gist of a sample, and what is
 * likely behind a light that does not arrive. A hint states a fact of the scene or asks a question;
 * it guesses at nothing that could be traced. */
#include "why_tree.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- hints */

static bool is_solid(GlintSurfaceType type) {
    return type == GLINT_SURFACE_SPHERE || type == GLINT_SURFACE_BOX ||
           type == GLINT_SURFACE_CYLINDER || type == GLINT_SURFACE_CONE;
}

/* Whether the light looks at the inside of the solid that blocks it. */
static bool stands_inside(const CliWhy *why, const GlintExplainLight *light) {
    GlintLightDesc desc;
    if (!glint_scene_light(why->scene, light->light, &desc) || desc.type != GLINT_LIGHT_POINT ||
        !is_solid(light->blocker_type)) {
        return false;
    }
    GlintRay back = {.t_min = 0, .t_max = INFINITY};
    double cosine = 0;
    for (int i = 0; i < 3; i++) {
        back.origin[i] = desc.position[i];
        back.direction[i] = -light->direction[i];
    }
    GlintHit hit;
    if (!glint_trace(why->scene, &back, &hit)) return false;
    for (int i = 0; i < 3; i++) cosine += hit.normal[i] * back.direction[i];
    return hit.surface.index1 == light->blocker.index1 && cosine > 0;
}

static bool is_glass(const CliWhy *why, const GlintExplainRay *at, const GlintExplainLight *light) {
    GlintRay ray = {.t_min = light->shadow_begin, .t_max = light->shadow_end};
    memcpy(ray.origin, at->point, sizeof ray.origin);
    memcpy(ray.direction, light->direction, sizeof ray.direction);
    GlintHit hit;
    GlintShaderDesc desc;
    return glint_trace(why->scene, &ray, &hit) &&
           glint_scene_shader(why->scene, hit.shader, &desc) && desc.type == GLINT_SHADER_GLASS;
}

static void hint_blocked(
    const CliWhy *why, const GlintExplainRay *at, const GlintExplainLight *light, int indent) {
    double reach = isfinite(light->distance) ? light->distance : 1;
    bool near = light->blocker_distance < 1e-3 * reach;
    bool own = light->blocker.index1 != 0 && light->blocker.index1 == at->surface.index1;
    if (own && light->n_dot_l <= 0) {
        cli_why_line(why, indent,
            "hint: the surface turns its back to the light (n.l <= 0) and "
            "is in the way itself");
    } else if (own && near) {
        cli_why_line(why, indent,
            "hint: that is the surface of the point, right where the shadow "
            "ray begins: does it fold, or is it there twice?");
    } else if (own) {
        cli_why_line(why, indent, "hint: another part of the same surface is in the way");
    } else if (near) {
        cli_why_line(why, indent,
            "hint: that is right where the shadow ray begins: do the two "
            "surfaces overlap, or lie in one plane?");
    }
    if (stands_inside(why, light)) {
        cli_why_line(why, indent, "hint: the light stands inside of that surface");
    }
    if (is_glass(why, at, light)) {
        cli_why_line(why, indent,
            "hint: that is glass; by the rules of the format shadow rays "
            "do not pass it");
    }
}

void cli_why_print_light_hints(const CliWhy *why, const GlintExplainSample *sample,
    const GlintExplainLight *light, int indent) {
    const GlintExplainRay *at = &sample->rays[light->ray];
    if (light->fate == GLINT_LIGHT_BLOCKED) hint_blocked(why, at, light, indent);
    if (light->fate == GLINT_LIGHT_BEHIND && at->n_dot_v < 0) {
        cli_why_line(why, indent,
            "hint: the normal points away from the viewer and from the "
            "light: is the surface turned inside out?");
    }
    double most = fmax(light->term[0], fmax(light->term[1], light->term[2])) * why->pixel.exposure;
    if (light->fate == GLINT_LIGHT_ARRIVES && light->falloff < 0.01 && most < 1e-3) {
        cli_why_line(why, indent,
            "hint: in this dialect light falls off with 1/r^2, here to "
            "%.6g: an intensity of about r^2 = %.6g would do",
            light->falloff, 1 / light->falloff);
    }
}

/* ---------------------------------------------------------------- in short */

/* What light does at the end of the camera's ray. */
static void say_light(const CliWhy *why, const GlintExplainLight *light) {
    char name[CLI_WHY_NAME_SIZE], other[CLI_WHY_NAME_SIZE];
    cli_why_name_light(why, light->light, name);
    switch (light->fate) {
    case GLINT_LIGHT_ARRIVES:
    case GLINT_LIGHT_EVERYWHERE: cli_why_line(why, 2, "%s: lights it", name); break;
    case GLINT_LIGHT_BLOCKED:
        cli_why_line(why, 2, "%s: blocked by %s", name,
            cli_why_name_surface(why, light->blocker, light->blocker_type, light->blocker_triangle,
                light->blocker_light, other));
        break;
    case GLINT_LIGHT_BEHIND: cli_why_line(why, 2, "%s: behind the surface", name); break;
    case GLINT_LIGHT_UNSEEN_SIDE:
        cli_why_line(why, 2, "%s: lights a side that is not seen", name);
        break;
    case GLINT_LIGHT_OFF: cli_why_line(why, 2, "%s: has no strength", name); break;
    case GLINT_LIGHT_TURNED_AWAY: cli_why_line(why, 2, "%s: shines elsewhere", name); break;
    case GLINT_LIGHT_ON_SURFACE: cli_why_line(why, 2, "%s: lies in the surface", name); break;
    case GLINT_LIGHT_ABSORBED: cli_why_line(why, 2, "%s: is not reflected", name); break;
    }
}

/* What the rays that went on from the first surface have brought, and how many these are. */
static size_t add_others(const GlintExplainSample *sample, double sum[3]) {
    sum[0] = sum[1] = sum[2] = 0;
    for (size_t i = 0; i < sample->addition_count; i++) {
        if (sample->additions[i].ray == 0) continue;
        for (int k = 0; k < 3; k++) sum[k] += sample->additions[i].amount[k];
    }
    return sample->ray_count - 1;
}

/* Rays that were not followed though they would have brought something. */
static void say_dropped(const CliWhy *why, const GlintExplainSample *sample) {
    int light = 0, deep = 0;
    for (size_t i = 0; i < sample->branch_count; i++) {
        light += sample->branches[i].fate == GLINT_BRANCH_TOO_LIGHT;
        deep += sample->branches[i].fate == GLINT_BRANCH_TOO_DEEP;
    }
    if (light > 0) {
        cli_why_line(why, 2, "not followed since they weigh too little: %d ray%s", light,
            light == 1 ? "" : "s");
    }
    if (deep > 0) {
        cli_why_line(
            why, 2, "not followed since they lie too deep: %d ray%s", deep, deep == 1 ? "" : "s");
    }
}

static void say_background(const CliWhy *why) {
    double color[3];
    if (glint_scene_background(why->scene, color)) {
        cli_why_line(why, 2, "it meets nothing, and shows the cube map");
    } else {
        cli_why_line(why, 2, "it meets nothing, and shows the background, %s", cli_why_vec(color));
    }
}

static void say_surface(const CliWhy *why, const GlintExplainSample *sample) {
    const GlintExplainRay *ray = &sample->rays[0];
    GlintShaderDesc desc = glint_shader_desc_default();
    glint_scene_shader(why->scene, ray->lit ? ray->local_shader : ray->shader, &desc);
    bool normals = desc.type == GLINT_SHADER_RGB_NORMALS;
    if (normals) cli_why_line(why, 2, "its shader shows the normal, and no lights");
    for (size_t i = 0; i < sample->light_count && !normals; i++) {
        if (sample->lights[i].ray == 0) say_light(why, &sample->lights[i]);
    }
    if (ray->lit && why->info.light_count == 0 && sample->light_count == 0 && !normals) {
        cli_why_line(why, 2, "there is no light in the scene");
    }
    double sum[3];
    size_t others = add_others(sample, sum);
    if (others > 0) {
        cli_why_line(why, 2, "%zu further ray%s bring%s %s", others, others == 1 ? "" : "s",
            others == 1 ? "s" : "", cli_why_is(sum, 0) ? "nothing" : cli_why_vec(sum));
    }
    say_dropped(why, sample);
}

void cli_why_print_short(const CliWhy *why, const GlintExplainSample *sample) {
    const GlintExplainRay *ray = &sample->rays[0];
    char name[CLI_WHY_NAME_SIZE];
    if (ray->end == GLINT_RAY_END_NOTHING) {
        cli_why_line(why, 0, "In short: the camera's ray");
        say_background(why);
    } else {
        cli_why_line(why, 0, "In short: the camera's ray meets %s",
            cli_why_name_surface(
                why, ray->surface, ray->surface_type, ray->triangle, ray->light, name));
        if (ray->end == GLINT_RAY_END_SURFACE) say_surface(why, sample);
    }
    double most = fmax(sample->color[0], fmax(sample->color[1], sample->color[2]));
    if (most > 0 && why->pixel.rgb[0] + why->pixel.rgb[1] + why->pixel.rgb[2] == 0) {
        cli_why_line(why, 2, "what arrives is too little for 8 bits");
    } else if (sample->addition_count == 0) {
        cli_why_line(why, 2, "so nothing is added: black");
    }
}
