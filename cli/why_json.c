/* SPDX-License-Identifier: MIT
 * The structs of glint_explain as they are, so that whoever knows glint.h knows the keys. Numbers
 * read back to the same bits; what has no number in JSON (an infinite distance) is null, and so is
 * an index of nothing. */
#include "why.h"

#include <math.h>

/* ---------------------------------------------------------------- values */

/* A key begins a member of an object; the first has no comma before it. */
static void key(FILE *out, const char *name, bool first) {
    fprintf(out, "%s\"%s\":", first ? "" : ",", name);
}

static void put_vec(FILE *out, const char *name, const double v[3]) {
    key(out, name, false);
    for (int i = 0; i < 3; i++) {
        fputc(i == 0 ? '[' : ',', out);
        cli_why_json_number(out, v[i]);
    }
    fputc(']', out);
}

static void put_number(FILE *out, const char *name, double number) {
    key(out, name, false);
    cli_why_json_number(out, number);
}

static void put_index(FILE *out, const char *name, uint32_t index) {
    key(out, name, false);
    if (index == GLINT_NONE) {
        fputs("null", out);
    } else {
        fprintf(out, "%lu", (unsigned long)index);
    }
}

static void put_flag(FILE *out, const char *name, bool flag) {
    key(out, name, false);
    fputs(flag ? "true" : "false", out);
}

static void put_text(FILE *out, const char *name, const char *text) {
    key(out, name, false);
    cli_why_json_text(out, text);
}

/* Name and line of an object, if it has any. */
static void put_source(const CliWhy *why, const char *name, GlintObjectKind kind, uint32_t index1) {
    GlintSource source = cli_why_source(why, kind, index1);
    key(why->out, name, false);
    fprintf(why->out, "{\"id\":%lu,\"line\":%lld,\"name\":", (unsigned long)index1,
        (long long)source.line);
    cli_why_json_text(why->out, source.name);
    fputc('}', why->out);
}

/* ---------------------------------------------------------------- elements */

static void put_ray(const CliWhy *why, const GlintExplainRay *ray) {
    static const char *const ends[] = {"nothing", "surface", "light"};
    FILE *out = why->out;
    key(out, "kind", true);
    cli_why_json_text(out, cli_why_ray_kind(ray->kind));
    put_index(out, "parent", ray->parent);
    put_index(out, "level", ray->level);
    put_vec(out, "origin", ray->origin);
    put_vec(out, "direction", ray->direction);
    put_number(out, "t_min", ray->t_min);
    put_vec(out, "factor", ray->factor);
    put_number(out, "weight", ray->weight);
    put_number(out, "density", ray->density);
    put_flag(out, "inside", ray->inside);
    put_text(out, "end", ends[ray->end]);
    if (ray->end == GLINT_RAY_END_NOTHING) return;
    put_number(out, "t", ray->t);
    put_vec(out, "point", ray->point);
    put_vec(out, "normal", ray->normal);
    put_vec(out, "geometric_normal", ray->geometric_normal);
    put_number(out, "n_dot_v", ray->n_dot_v);
    if (ray->end == GLINT_RAY_END_LIGHT) {
        put_source(why, "light", GLINT_OBJECT_LIGHT, ray->light);
        return;
    }
    put_source(why, "surface", GLINT_OBJECT_SURFACE, ray->surface.index1);
    put_text(out, "surface_type", cli_why_surface_type(ray->surface_type));
    put_index(out, "triangle", ray->triangle);
    put_source(why, "shader", GLINT_OBJECT_SHADER, ray->shader.index1);
    put_flag(out, "lit", ray->lit);
    if (!ray->lit) return;
    put_source(why, "local_shader", GLINT_OBJECT_SHADER, ray->local_shader.index1);
    put_vec(out, "local_factor", ray->local_factor);
    put_vec(out, "diffuse_color", ray->diffuse_color);
}

static void put_layer(const CliWhy *why, const GlintExplainLayer *layer) {
    FILE *out = why->out;
    key(out, "ray", true);
    fprintf(out, "%lu", (unsigned long)layer->ray);
    put_source(why, "shader", GLINT_OBJECT_SHADER, layer->shader.index1);
    put_flag(out, "inside", layer->inside);
    put_flag(out, "behind", layer->behind);
    put_flag(out, "total", layer->total);
    put_number(out, "cosine", layer->cosine);
    put_number(out, "cosine_behind", layer->cosine_behind);
    put_number(out, "ratio", layer->ratio);
    put_number(out, "reflectance", layer->reflectance);
}

static void put_branch(const CliWhy *why, const GlintExplainBranch *branch) {
    FILE *out = why->out;
    key(out, "kind", true);
    cli_why_json_text(out, cli_why_ray_kind(branch->kind));
    put_text(out, "fate", cli_why_branch_fate(branch->fate));
    put_index(out, "ray", branch->ray);
    put_index(out, "layer", branch->layer);
    put_index(out, "child", branch->child);
    put_vec(out, "factor", branch->factor);
    put_number(out, "weight", branch->weight);
    put_number(out, "chance", branch->chance);
    put_number(out, "survival", branch->survival);
}

static void put_light(const CliWhy *why, const GlintExplainLight *light) {
    FILE *out = why->out;
    key(out, "fate", true);
    cli_why_json_text(out, cli_why_light_fate(light->fate));
    put_index(out, "ray", light->ray);
    put_source(why, "light", GLINT_OBJECT_LIGHT, light->light);
    put_vec(out, "direction", light->direction);
    put_number(out, "distance", light->distance);
    put_number(out, "n_dot_l", light->n_dot_l);
    put_number(out, "n_dot_h", light->n_dot_h);
    put_number(out, "falloff", light->falloff);
    put_vec(out, "strength", light->strength);
    put_vec(out, "diffuse", light->diffuse);
    put_vec(out, "highlight", light->highlight);
    put_vec(out, "reflected", light->reflected);
    put_number(out, "fresnel", light->fresnel);
    put_number(out, "distribution", light->distribution);
    put_number(out, "masking", light->masking);
    put_number(out, "density", light->density);
    put_number(out, "share", light->share);
    put_vec(out, "term", light->term);
    put_number(out, "shadow_begin", light->shadow_begin);
    put_number(out, "shadow_end", light->shadow_end);
    put_index(out, "addition", light->addition);
    if (light->fate != GLINT_LIGHT_BLOCKED) return;
    if (light->blocker_light != 0) {
        put_source(why, "blocker_light", GLINT_OBJECT_LIGHT, light->blocker_light);
    } else {
        put_source(why, "blocker", GLINT_OBJECT_SURFACE, light->blocker.index1);
        put_text(out, "blocker_type", cli_why_surface_type(light->blocker_type));
        put_index(out, "blocker_triangle", light->blocker_triangle);
    }
    put_number(out, "blocker_distance", light->blocker_distance);
    put_vec(out, "blocker_point", light->blocker_point);
}

static void put_addition(const CliWhy *why, const GlintExplainAddition *addition) {
    FILE *out = why->out;
    key(out, "ray", true);
    fprintf(out, "%lu", (unsigned long)addition->ray);
    put_index(out, "light", addition->light);
    put_vec(out, "amount", addition->amount);
    put_vec(out, "sum", addition->sum);
}

/* ---------------------------------------------------------------- samples */

/* An array of objects, a line each. */
#define PUT_ALL(name, sample, array, count, put)                                                   \
    do {                                                                                           \
        fprintf(why->out, ",\n\"%s\":[", name);                                                    \
        for (size_t i_ = 0; i_ < (sample)->count; i_++) {                                          \
            fputs(i_ == 0 ? "\n{" : ",\n{", why->out);                                             \
            put(why, &(sample)->array[i_]);                                                        \
            fputc('}', why->out);                                                                  \
        }                                                                                          \
        fputs("]", why->out);                                                                      \
    } while (0)

static void put_sample(void *user, const GlintExplainSample *sample) {
    const CliWhy *why = user;
    FILE *out = why->out;
    fprintf(out, "%s\n{\"sample\":%d,\"film\":[%.17g,%.17g]", sample->sample == 0 ? "" : ",",
        sample->sample + 1, sample->film_x, sample->film_y);
    put_vec(out, "color", sample->color);
    if (sample->sample == why->sample) {
        PUT_ALL("rays", sample, rays, ray_count, put_ray);
        PUT_ALL("layers", sample, layers, layer_count, put_layer);
        PUT_ALL("branches", sample, branches, branch_count, put_branch);
        PUT_ALL("lights", sample, lights, light_count, put_light);
        PUT_ALL("additions", sample, additions, addition_count, put_addition);
    }
    fputc('}', out);
}

GlintStatus cli_why_json(CliWhy *why) {
    FILE *out = why->out;
    fputs("{\"scene\":", out);
    cli_why_json_text(out, why->name);
    fprintf(out, ",\"dialect\":\"%s\",\"size\":[%d,%d],\"pixel\":[%d,%d],\n\"samples\":[",
        glint_dialect_name(why->info.dialect), why->width, why->height, why->x, why->y);
    GlintStatus status = cli_why_explain(why, put_sample, why);
    if (status != GLINT_OK) return status;
    const GlintExplainPixel *pixel = &why->pixel;
    const double color[3] = {
        (double)pixel->color[0], (double)pixel->color[1], (double)pixel->color[2]};
    fputs("]", out);
    put_vec(out, "sum", pixel->sum);
    put_number(out, "exposure", pixel->exposure);
    put_vec(out, "color", color);
    fprintf(out, ",\"rgb\":[%d,%d,%d]}\n", pixel->rgb[0], pixel->rgb[1], pixel->rgb[2]);
    return GLINT_OK;
}
