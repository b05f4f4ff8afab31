/* SPDX-License-Identifier: MIT
 * A ray, what it met, what each light did there, and then, one step further to the right, the rays
 * that went on. */
#include "why_tree.h"

#include <math.h>
#include <stdarg.h>

/* ---------------------------------------------------------------- lines */

void cli_why_line(const CliWhy *why, int indent, const char *format, ...) {
    enum { MOST = 60 }; /* a path may have thousands of rays */
    if (indent > MOST) indent = MOST;
    va_list arguments;
    fprintf(why->out, "%*s", indent, "");
    va_start(arguments, format);
    vfprintf(why->out, format, arguments);
    va_end(arguments);
    fputc('\n', why->out);
}

/* Minus zero is no news to a reader. */
static double plain(double x) { return x == 0 ? 0 : x; }

enum { SLOT_SIZE = 100 };

/* Lines have few numbers, so a few places are enough, taken in turn. */
static char *next_slot(void) {
    enum { SLOTS = 4 };
    static char slots[SLOTS][SLOT_SIZE];
    static int next;
    return slots[next++ % SLOTS];
}

const char *cli_why_vec(const double v[3]) {
    char *slot = next_slot();
    snprintf(slot, SLOT_SIZE, "%.6g %.6g %.6g", plain(v[0]), plain(v[1]), plain(v[2]));
    return slot;
}

const char *cli_why_part(const double v[3]) {
    if (!cli_why_is(v, v[0])) return cli_why_vec(v);
    char *slot = next_slot();
    snprintf(slot, SLOT_SIZE, "%.6g", plain(v[0]));
    return slot;
}

bool cli_why_is(const double v[3], double value) {
    return v[0] == value && v[1] == value && v[2] == value;
}

static double degrees(double cosine) {
    double within = cosine > 1 ? 1 : cosine < -1 ? -1 : cosine;
    return acos(within) * (180 / 3.14159265358979323846);
}

/* ---------------------------------------------------------------- lights */

/* Whether a is b, but for rounding. */
static bool is_near(double a, double b) { return fabs(a - b) <= 1e-9 * (fabs(a) + fabs(b)); }

/* How the diffuse part comes from the diffuse colour. */
static const char *diffuse_formula(const GlintExplainRay *at, const GlintExplainLight *light) {
    const double pi = 3.14159265358979323846;
    for (int i = 0; i < 3; i++) {
        double product = at->diffuse_color[i] * light->n_dot_l;
        if (product == 0) continue;
        if (is_near(light->diffuse[i], product)) return "diffuse colour x n.l";
        if (is_near(light->diffuse[i], product / pi)) return "diffuse colour / pi x n.l";
    }
    return "diffuse";
}

/* The shader's formula with its values: what it reflects of light of strength 1. */
static void print_reflected(
    const CliWhy *why, const GlintExplainRay *at, const GlintExplainLight *light, int indent) {
    GlintShaderDesc desc = glint_shader_desc_default();
    glint_scene_shader(why->scene, at->local_shader, &desc);
    const char *formula = diffuse_formula(at, light);
    if (desc.type == GLINT_SHADER_LAMBERTIAN) {
        cli_why_line(why, indent, "x reflected %s = %s", cli_why_vec(light->reflected), formula);
        return;
    }
    cli_why_line(why, indent, "x reflected %s, which is", cli_why_vec(light->reflected));
    cli_why_line(why, indent + 4, "%s = %s", cli_why_vec(light->diffuse), formula);
    if (desc.type == GLINT_SHADER_PHONG) {
        double plain = desc.specular_color[0] * pow(fmax(light->n_dot_h, 0), desc.exponent);
        bool cosine = !cli_why_is(light->highlight, 0) && !is_near(light->highlight[0], plain);
        cli_why_line(why, indent + 4, "+ %s = specular colour x (n.h)^%.6g%s",
            cli_why_vec(light->highlight), desc.exponent, cosine ? " x n.l" : "");
    } else {
        cli_why_line(why, indent + 4, "+ %s = highlight, by F = %.6g, D = %.6g, G = %.6g",
            cli_why_vec(light->highlight), light->fresnel, light->distribution, light->masking);
    }
}

/* "E x what the surface reflects = what arrives" */
static void print_term(const CliWhy *why, const GlintExplainSample *sample,
    const GlintExplainLight *light, int indent) {
    const GlintExplainRay *at = &sample->rays[light->ray];
    GlintLightDesc desc;
    bool known = glint_scene_light(why->scene, light->light, &desc);
    bool large = light->density > 0 || (known && desc.type == GLINT_LIGHT_RECTANGLE) || !known;
    if (large) {
        cli_why_line(why, indent, "radiance over density: %s", cli_why_vec(light->strength));
    } else if (known && light->falloff != 1) {
        cli_why_line(why, indent, "intensity %s x falloff 1/r^2 = %.6g: %s",
            cli_why_vec(desc.intensity), light->falloff, cli_why_vec(light->strength));
    } else {
        cli_why_line(why, indent, "intensity %s", cli_why_vec(light->strength));
    }
    print_reflected(why, at, light, indent);
    if (light->share != 1) cli_why_line(why, indent, "x share %.6g", light->share);
    const char *verb = light->fate == GLINT_LIGHT_BLOCKED ? "would add" : "adds";
    if (cli_why_is(at->local_factor, 1)) {
        cli_why_line(why, indent, "= %s %s", verb, cli_why_vec(light->term));
    } else if (light->addition == GLINT_NONE) {
        cli_why_line(why, indent, "= %s %s x the ray's part %s", verb, cli_why_vec(light->term),
            cli_why_part(at->local_factor));
    } else {
        cli_why_line(why, indent, "= %s x the ray's part %s = adds %s", cli_why_vec(light->term),
            cli_why_part(at->local_factor), cli_why_vec(sample->additions[light->addition].amount));
    }
}

static void print_fate(const CliWhy *why, const GlintExplainLight *light, int indent) {
    char name[CLI_WHY_NAME_SIZE];
    switch (light->fate) {
    case GLINT_LIGHT_ARRIVES: cli_why_line(why, indent, "arrives: nothing is in the way"); break;
    case GLINT_LIGHT_BLOCKED:
        cli_why_line(why, indent, "blocked by %s after %.6g: adds nothing",
            cli_why_name_surface(why, light->blocker, light->blocker_type, light->blocker_triangle,
                light->blocker_light, name),
            light->blocker_distance);
        break;
    case GLINT_LIGHT_BEHIND:
        cli_why_line(why, indent, "adds nothing: the light stands behind the surface (n.l <= 0)");
        break;
    case GLINT_LIGHT_UNSEEN_SIDE:
        cli_why_line(why, indent,
            "adds nothing: the surface is seen from behind (n.v < 0), and "
            "by the rules of this dialect it is black there");
        break;
    case GLINT_LIGHT_OFF: cli_why_line(why, indent, "adds nothing: it has no strength"); break;
    case GLINT_LIGHT_TURNED_AWAY:
        cli_why_line(why, indent, "adds nothing: it shines to its other side");
        break;
    case GLINT_LIGHT_ON_SURFACE:
        cli_why_line(why, indent, "adds nothing: it is at the point itself");
        break;
    case GLINT_LIGHT_ABSORBED:
        cli_why_line(why, indent, "adds nothing: the surface reflects none of it this way");
        break;
    case GLINT_LIGHT_EVERYWHERE: break;
    }
}

static void print_light(const CliWhy *why, const GlintExplainSample *sample,
    const GlintExplainLight *light, int indent) {
    char name[CLI_WHY_NAME_SIZE];
    cli_why_name_light(why, light->light, name);
    if (light->fate == GLINT_LIGHT_EVERYWHERE) {
        const double *adds =
            light->addition == GLINT_NONE ? light->term : sample->additions[light->addition].amount;
        cli_why_line(why, indent, "%s: shines everywhere, adds %s", name, cli_why_vec(adds));
        return;
    }
    bool aimed = !cli_why_is(light->direction, 0);
    if (aimed && isfinite(light->distance)) {
        cli_why_line(why, indent, "%s: n.l = %.6g, n.h = %.6g, distance %.6g", name, light->n_dot_l,
            light->n_dot_h, light->distance);
    } else if (aimed) {
        cli_why_line(
            why, indent, "%s: n.l = %.6g, n.h = %.6g", name, light->n_dot_l, light->n_dot_h);
    } else {
        cli_why_line(why, indent, "%s:", name);
    }
    print_fate(why, light, indent + 2);
    if (light->fate == GLINT_LIGHT_ARRIVES || light->fate == GLINT_LIGHT_BLOCKED) {
        print_term(why, sample, light, indent + 2);
    }
    cli_why_print_light_hints(why, sample, light, indent + 2);
}

/* ---------------------------------------------------------------- surfaces */

static void print_shader(const CliWhy *why, const GlintExplainRay *ray, int indent) {
    char name[CLI_WHY_NAME_SIZE];
    GlintShaderDesc desc = glint_shader_desc_default();
    GlintShaderId id = ray->lit ? ray->local_shader : ray->shader;
    glint_scene_shader(why->scene, id, &desc);
    cli_why_name_shader(why, id, name);
    const char *under = ray->lit && id.index1 != ray->shader.index1 ? "under it: " : "shader: ";
    const char *kd = desc.texture.index1 != 0 ? "diffuse (texture)" : "diffuse";
    const double *diffuse = ray->lit ? ray->diffuse_color : desc.diffuse_color;
    switch (desc.type) {
    case GLINT_SHADER_LAMBERTIAN:
        cli_why_line(why, indent, "%s%s, %s %s", under, name, kd, cli_why_vec(diffuse));
        break;
    case GLINT_SHADER_PHONG:
        cli_why_line(why, indent, "%s%s, %s %s, specular %s, exponent %.6g", under, name, kd,
            cli_why_vec(diffuse), cli_why_vec(desc.specular_color), desc.exponent);
        break;
    case GLINT_SHADER_RGB_NORMALS:
        cli_why_line(why, indent, "%s%s, shows (normal + 1) / 2 and no lights", under, name);
        break;
    case GLINT_SHADER_GLAZED:
    case GLINT_SHADER_GLASS:
        cli_why_line(
            why, indent, "%s%s, refractive index %.6g", under, name, desc.refractive_index);
        break;
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX:
    case GLINT_SHADER_COOK_TORRANCE:
        cli_why_line(why, indent, "%s%s, %s %s, specular %s, roughness %.6g, index %.6g", under,
            name, kd, cli_why_vec(diffuse), cli_why_vec(desc.specular_color), desc.roughness,
            desc.refractive_index);
        break;
    }
}

/* Glass, glazing or a mirror coefficient: angles and how much is mirrored. */
static void print_layer(const CliWhy *why, const GlintExplainLayer *layer, int indent) {
    char name[CLI_WHY_NAME_SIZE];
    GlintShaderDesc desc = glint_shader_desc_default();
    glint_scene_shader(why->scene, layer->shader, &desc);
    cli_why_name_shader(why, layer->shader, name);
    bool glass = desc.type == GLINT_SHADER_GLASS, glazed = desc.type == GLINT_SHADER_GLAZED;
    const char *what = glass || glazed ? name : "mirrorCoefficient";
    if (layer->behind) {
        cli_why_line(why, indent, "%s: seen from behind (n.v = %.6g): mirrors nothing%s", what,
            layer->cosine, glass ? ", and is black by the rules of this dialect" : "");
    } else if (layer->total) {
        cli_why_line(why, indent,
            "%s, from inside: angle %.2f degrees (n.v = %.6g), beyond the critical %.2f: "
            "total internal reflection",
            what, degrees(layer->cosine), layer->cosine, 90 - degrees(1 / layer->ratio));
    } else if (glass) {
        cli_why_line(why, indent,
            "%s, from %s: angle %.2f degrees (n.v = %.6g), behind it %.2f (cosine %.6g): R = %.6g",
            what, layer->inside ? "inside" : "outside", degrees(layer->cosine), layer->cosine,
            degrees(layer->cosine_behind), layer->cosine_behind, layer->reflectance);
    } else {
        cli_why_line(why, indent, "%s: angle %.2f degrees (n.v = %.6g): R = %.6g", what,
            degrees(layer->cosine), layer->cosine, layer->reflectance);
    }
}

/* Where glazing or glass ends the matter. last: the lowest layer; null: none was looked at. */
static void print_end(
    const CliWhy *why, const GlintExplainRay *ray, const GlintExplainLayer *last, int indent) {
    GlintShaderDesc desc = glint_shader_desc_default();
    glint_scene_shader(why->scene, last != NULL ? last->shader : ray->shader, &desc);
    bool glazed = desc.type == GLINT_SHADER_GLAZED;
    if (last == NULL && (glazed || desc.type == GLINT_SHADER_GLASS)) {
        cli_why_line(why, indent,
            "black: this is the deepest level, and by the rules of this "
            "dialect glass and glazing are black there");
    } else if (last != NULL && glazed && last->behind) {
        cli_why_line(why, indent, "black: by the rules of this dialect glazing is, from behind");
    } else if (last != NULL && glazed) {
        cli_why_line(why, indent,
            "what lies under it is not looked at: its weight is below the "
            "limit of this dialect");
    }
}

static void print_surface(
    const CliWhy *why, const GlintExplainSample *sample, uint32_t index, int indent) {
    const GlintExplainRay *ray = &sample->rays[index];
    cli_why_line(why, indent, "point %s, normal %s, n.v = %.6g", cli_why_vec(ray->point),
        cli_why_vec(ray->normal), ray->n_dot_v);
    const GlintExplainLayer *last = NULL;
    for (size_t i = 0; i < sample->layer_count; i++) {
        if (sample->layers[i].ray != index) continue;
        print_layer(why, &sample->layers[i], indent);
        last = &sample->layers[i];
    }
    if (ray->lit || last == NULL) print_shader(why, ray, indent);
    if (!ray->lit) print_end(why, ray, last, indent);
    if (ray->n_dot_v < 0 && last == NULL) {
        cli_why_line(why, indent, "hint: n.v < 0: the ray meets the inside of the surface%s",
            ray->surface_type == GLINT_SURFACE_MESH
                ? ", or a triangle whose corners run clockwise as seen from here"
                : "");
    }
}

/* ---------------------------------------------------------------- rays */

static const char *reason(GlintBranchFate fate) {
    switch (fate) {
    case GLINT_BRANCH_NOTHING: return "it would add nothing";
    case GLINT_BRANCH_TOO_LIGHT: return "its weight is below the limit of this dialect";
    case GLINT_BRANCH_TOO_DEEP: return "it would lie behind the deepest level";
    case GLINT_BRANCH_NOT_CHOSEN: return "the path was drawn to go another way";
    case GLINT_BRANCH_ENDED: return "the path ends here by chance (Russian roulette)";
    case GLINT_BRANCH_NO_TREE: return "the integrator follows no mirrored or refracted rays";
    case GLINT_BRANCH_FOLLOWED: break;
    }
    return "";
}

static void print_ray(const CliWhy *why, const GlintExplainSample *sample, uint32_t index,
    const GlintExplainBranch *branch, int indent);

static void print_branch(const CliWhy *why, const GlintExplainSample *sample,
    const GlintExplainBranch *branch, int indent) {
    if (branch->fate == GLINT_BRANCH_FOLLOWED) {
        print_ray(why, sample, branch->child, branch, indent);
        return;
    }
    /* A path that could have gone elsewhere is no news, nor is a look for lights that led nowhere.
     */
    if (branch->layer == GLINT_NONE && branch->fate != GLINT_BRANCH_ENDED) return;
    if (branch->layer == GLINT_NONE) {
        cli_why_line(why, indent,
            "the path ends here by chance: it would have gone on with %.6g "
            "(Russian roulette)",
            branch->survival);
        return;
    }
    cli_why_line(why, indent, "%s ray (part %s, weight %.6g): not followed, %s",
        cli_why_ray_kind(branch->kind), cli_why_part(branch->factor), branch->weight,
        reason(branch->fate));
}

/* What the end of a ray shows by itself, if anything. */
static void print_own(
    const CliWhy *why, const GlintExplainSample *sample, uint32_t index, int indent) {
    for (size_t i = 0; i < sample->addition_count; i++) {
        const GlintExplainAddition *addition = &sample->additions[i];
        if (addition->ray != index || addition->light != GLINT_NONE) continue;
        const char *what = sample->rays[index].end == GLINT_RAY_END_NOTHING ? "background"
                           : sample->rays[index].end == GLINT_RAY_END_LIGHT ? "the light it sees"
                                                                            : "its normal";
        cli_why_line(why, indent, "adds %s (%s)", cli_why_vec(addition->amount), what);
    }
}

static void print_heading(
    const CliWhy *why, const GlintExplainRay *ray, const GlintExplainBranch *branch, int indent) {
    if (branch == NULL) {
        cli_why_line(why, indent, "camera ray from %s along %s", cli_why_vec(ray->origin),
            cli_why_vec(ray->direction));
        return;
    }
    char drawn[60] = "", chosen[60] = "", kept[60] = "";
    if (ray->density > 0) snprintf(drawn, sizeof drawn, ", drawn with density %.6g", ray->density);
    if (branch->chance < 1) snprintf(chosen, sizeof chosen, ", chosen by %.6g", branch->chance);
    if (branch->survival < 1) snprintf(kept, sizeof kept, ", kept by %.6g", branch->survival);
    const char *kind = ray->kind == GLINT_RAY_PROBE ? "probe (looks for large lights only)"
                                                    : cli_why_ray_kind(ray->kind);
    cli_why_line(why, indent, "%s ray, level %u, along %s, part %s%s%s%s", kind,
        (unsigned)ray->level, cli_why_vec(ray->direction), cli_why_part(ray->factor), drawn, chosen,
        kept);
}

/* branch: that it goes along; null: the camera's. */
static void print_ray(const CliWhy *why, const GlintExplainSample *sample, uint32_t index,
    const GlintExplainBranch *branch, int indent) {
    const GlintExplainRay *ray = &sample->rays[index];
    char name[CLI_WHY_NAME_SIZE];
    print_heading(why, ray, branch, indent);
    indent += 2;
    if (ray->end == GLINT_RAY_END_NOTHING) {
        cli_why_line(why, indent, "meets nothing");
        print_own(why, sample, index, indent);
        return;
    }
    cli_why_line(why, indent, "meets %s after %.6g",
        cli_why_name_surface(why, ray->surface, ray->surface_type, ray->triangle, ray->light, name),
        ray->t);
    int detail = indent + 2; /* of the surface; rays that go on stand under "meets" */
    bool looks_only = ray->kind == GLINT_RAY_PROBE || ray->end == GLINT_RAY_END_LIGHT;
    if (!looks_only) print_surface(why, sample, index, detail);
    print_own(why, sample, index, detail);
    bool shows_lights = true;
    GlintShaderDesc desc;
    if (ray->lit && glint_scene_shader(why->scene, ray->local_shader, &desc)) {
        shows_lights = desc.type != GLINT_SHADER_RGB_NORMALS;
    }
    for (size_t i = 0; i < sample->light_count && shows_lights; i++) {
        if (sample->lights[i].ray == index) print_light(why, sample, &sample->lights[i], detail);
    }
    for (size_t i = 0; i < sample->branch_count; i++) {
        if (sample->branches[i].ray == index) {
            print_branch(why, sample, &sample->branches[i], indent);
        }
    }
}

void cli_why_print_tree(const CliWhy *why, const GlintExplainSample *sample) {
    print_ray(why, sample, 0, NULL, 0);
}
