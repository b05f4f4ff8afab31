/* SPDX-License-Identifier: MIT
 * Takes a surface apart into the local part under all glazing and the rays that go on from it. Each
 * layer adds its branches and hands on what is left of the light. */
#include "shade/bsdf.h"
#include "shade/dielectric.h"

static GiVec gray(double x) { return gi_vec(x, x, x); }

/* What is left for the layers below. */
typedef struct Rest {
    GiVec factor;
    double weight;
} Rest;

static Rest weaken(Rest rest, double part) {
    return (Rest){gi_scale(rest.factor, part), rest.weight * part};
}

/* A branch that adds nothing, or too little by the year's rule, is not listed. */
static bool counts(const GiShading *at, Rest rest) {
    return !gi_vec_is_zero(rest.factor) && rest.weight >= at->rules->least_weight;
}

static GiBranchNote add(const GiShading *at, GiScatter *scatter, GiVec direction, Rest rest,
    bool inside, bool through) {
    GiBranchNote note = {GI_BRANCH_LISTED, scatter->count, rest.factor, rest.weight};
    if (!counts(at, rest) || scatter->count == GI_BRANCH_LIMIT) {
        note.outcome = gi_vec_is_zero(rest.factor) ? GI_BRANCH_NOTHING : GI_BRANCH_TOO_LIGHT;
        return note;
    }
    scatter->branch[scatter->count++] =
        (GiBranch){direction, rest.factor, rest.weight, inside, through};
    return note;
}

static void note_layer(GiScatter *scatter, GiLayerNote note) {
    if (scatter->notes != NULL) scatter->notes->layers[scatter->notes->count++] = note;
}

/* ---------------------------------------------------------------- glazing */

/* Mirrors R and leaves the rest. False when nothing is left. */
static bool scatter_glazed(
    const GiShading *at, const GiArrival *arrival, GiScatter *scatter, Rest *rest) {
    const GiRules *rules = at->rules;
    GiVec n = at->normal, v = at->toward_viewer;
    double c = gi_dot(n, v), m = at->shader->index;
    GiLayerNote note = {.shader = at->shader, .behind = c < 0, .cosine = c};
    if (c < 0) {
        note_layer(scatter, note);
        return rules->glazed_behind; /* R = 0 there, or all is black */
    }
    double r = rules->schlick ? gi_dielectric_schlick(c, m) : gi_dielectric_fresnel(c, m);
    note.reflectance = r;
    note.mirrored =
        add(at, scatter, gi_dielectric_mirror(n, v, c), weaken(*rest, r), arrival->inside, false);
    note_layer(scatter, note);
    if (!rules->glazed_adds) *rest = weaken(*rest, 1 - r);
    return counts(at, *rest);
}

/* ---------------------------------------------------------------- glass */

static void scatter_glass(
    const GiShading *at, const GiArrival *arrival, GiScatter *scatter, Rest rest) {
    const GiRules *rules = at->rules;
    GiVec n = at->normal, v = at->toward_viewer;
    bool inside = rules->glass_by_flag ? arrival->inside : gi_dot(n, v) < 0;
    if (inside) n = gi_negate(n);
    double c = gi_dot(n, v), m = at->shader->index;
    GiLayerNote note = {.shader = at->shader, .inside = inside, .behind = c < 0, .cosine = c};
    if (c < 0) { /* the flag is wrong about the side: black */
        note_layer(scatter, note);
        return;
    }
    double e = inside ? m : 1 / m, ct;
    GiVec mirrored = gi_dielectric_mirror(n, v, c);
    note.ratio = e;
    if (!gi_dielectric_cosine_behind(c, e, &ct)) {
        note.total = true;
        note.reflectance = 1;
        note.mirrored = add(at, scatter, mirrored, rest, inside, false);
        note_layer(scatter, note);
        return;
    }
    /* Schlick's formula wants the cosine on the side of the air. */
    double r = rules->schlick ? gi_dielectric_schlick(inside ? ct : c, m)
                              : gi_dielectric_reflectance(c, ct, 1 / e);
    GiVec through = gi_dielectric_refract(n, v, c, ct, e);
    note.cosine_behind = ct;
    note.reflectance = r;
    note.refracted = add(at, scatter, through, weaken(rest, 1 - r), !inside, true);
    note.mirrored = add(at, scatter, mirrored, weaken(rest, r), inside, false);
    note_layer(scatter, note);
}

/* ---------------------------------------------------------------- mirror coefficient */

/* k + (1 - k) (1 - c)^5, Schlick's formula from a colour k at normal incidence. It weakens nothing
 * else. */
static void scatter_mirror(
    const GiShading *at, const GiArrival *arrival, GiScatter *scatter, Rest rest) {
    GiVec k = at->shader->mirror;
    GiVec n = at->normal, v = at->toward_viewer;
    double c = gi_dot(n, v);
    if (!(k.x > 0 || k.y > 0 || k.z > 0)) return;
    GiLayerNote note = {.shader = at->shader, .behind = c < 0, .cosine = c};
    if (c < 0) {
        note_layer(scatter, note);
        return;
    }
    double x = 1 - c, power = x * x * x * x * x;
    GiVec factor = gi_add(k, gi_scale(gi_sub(gray(1), k), power));
    Rest mirrored = {gi_multiply(rest.factor, factor), rest.weight * gi_largest(factor)};
    note.reflectance = gi_largest(factor);
    note.mirrored =
        add(at, scatter, gi_dielectric_mirror(n, v, c), mirrored, arrival->inside, false);
    note_layer(scatter, note);
}

/* ---------------------------------------------------------------- layers */

static bool is_transparent(const GiShader *shader) {
    return shader->type == GLINT_SHADER_GLAZED || shader->type == GLINT_SHADER_GLASS;
}

static bool takes_mirror(const GiShader *shader) {
    return shader->type == GLINT_SHADER_LAMBERTIAN || shader->type == GLINT_SHADER_PHONG ||
           shader->type == GLINT_SHADER_BECKMANN || shader->type == GLINT_SHADER_GGX;
}

/* Steps down to the substrate. False when there is none. */
static bool step_down(GiShading *layer) {
    uint32_t substrate = layer->shader->substrate;
    if (substrate == GI_NONE) return false;
    layer->shader = &layer->scene->shaders.data[substrate];
    layer->diffuse = layer->shader->diffuse;
    return true;
}

void gi_bsdf_scatter(
    const GiShading *at, const GiArrival *arrival, GiScatter *scatter, GiScatterNotes *notes) {
    const GiRules *rules = at->rules;
    GiShading layer = *at;
    Rest rest = {gray(1), arrival->weight};
    scatter->local = *at;
    scatter->local.shader = NULL;
    scatter->local_factor = gray(0);
    scatter->count = 0;
    scatter->notes = notes;
    if (notes != NULL) notes->count = 0;
    if (is_transparent(layer.shader) && rules->glass_ends && arrival->level >= rules->last_level) {
        return;
    }
    for (int depth = 0; layer.shader->type == GLINT_SHADER_GLAZED; depth++) {
        if (depth > GI_SUBSTRATE_LIMIT) return;
        if (!scatter_glazed(&layer, arrival, scatter, &rest) || !step_down(&layer)) return;
    }
    if (layer.shader->type == GLINT_SHADER_GLASS) {
        scatter_glass(&layer, arrival, scatter, rest);
        return;
    }
    if (takes_mirror(layer.shader)) scatter_mirror(&layer, arrival, scatter, rest);
    scatter->local = layer;
    scatter->local_factor = rest.factor;
}
