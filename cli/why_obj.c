/* SPDX-License-Identifier: MIT
 * The rays as lines of an OBJ file (Wavefront Technologies, "Object Files"), for any viewer: a
 * group for each kind of ray, one for shadow rays that arrive and one for those that are blocked,
 * and one for normals. A ray that meets nothing ends somewhere; the longest that meets something
 * says where. */
#include "why.h"

#include <math.h>

typedef struct Lines {
    CliWhy *why;
    double reach; /* length of rays without an end */
} Lines;

/* The longest finite ray, or 1. */
static double reach_of(const GlintExplainSample *sample) {
    double reach = 0;
    for (size_t i = 0; i < sample->ray_count; i++) reach = fmax(reach, sample->rays[i].t);
    for (size_t i = 0; i < sample->light_count; i++) {
        if (isfinite(sample->lights[i].distance)) reach = fmax(reach, sample->lights[i].distance);
    }
    return reach > 0 ? reach : 1;
}

/* Vertices are counted from the end, so that no line needs to know of another. */
static void put_line(
    const Lines *lines, const double from[3], const double direction[3], double length) {
    FILE *out = lines->why->out;
    fprintf(out, "v %.9g %.9g %.9g\n", from[0], from[1], from[2]);
    fprintf(out, "v %.9g %.9g %.9g\n", from[0] + length * direction[0],
        from[1] + length * direction[1], from[2] + length * direction[2]);
    fputs("l -2 -1\n", out);
}

static void put_rays(const Lines *lines, const GlintExplainSample *sample, GlintRayKind kind) {
    bool begun = false;
    for (size_t i = 0; i < sample->ray_count; i++) {
        const GlintExplainRay *ray = &sample->rays[i];
        if (ray->kind != kind) continue;
        if (!begun) fprintf(lines->why->out, "g %s\n", cli_why_ray_kind(kind));
        begun = true;
        double length = ray->end == GLINT_RAY_END_NOTHING ? lines->reach : ray->t;
        put_line(lines, ray->origin, ray->direction, length);
    }
}

/* Up to the light, or up to what is in the way. */
static void put_shadows(
    const Lines *lines, const GlintExplainSample *sample, GlintLightFate fate, const char *group) {
    bool begun = false;
    for (size_t i = 0; i < sample->light_count; i++) {
        const GlintExplainLight *light = &sample->lights[i];
        if (light->fate != fate) continue;
        if (!begun) fprintf(lines->why->out, "g %s\n", group);
        begun = true;
        double length = fate == GLINT_LIGHT_BLOCKED ? light->blocker_distance
                        : isfinite(light->distance) ? light->distance
                                                    : lines->reach;
        put_line(lines, sample->rays[light->ray].point, light->direction, length);
    }
}

static void put_normals(const Lines *lines, const GlintExplainSample *sample) {
    bool begun = false;
    for (size_t i = 0; i < sample->ray_count; i++) {
        const GlintExplainRay *ray = &sample->rays[i];
        if (ray->end != GLINT_RAY_END_SURFACE) continue;
        if (!begun) fputs("g normal\n", lines->why->out);
        begun = true;
        put_line(lines, ray->point, ray->normal, 0.05 * lines->reach);
    }
}

static void put_sample(void *user, const GlintExplainSample *sample) {
    CliWhy *why = user;
    if (sample->sample != why->sample) return;
    const Lines lines = {why, reach_of(sample)};
    fprintf(why->out, "# glint why: pixel %d,%d of %d x %d, sample %d of %d\n", sample->x,
        sample->y, why->width, why->height, sample->sample + 1, sample->samples);
    fputs("# groups: camera mirrored refracted scattered probe, shadow (rays that arrive at a\n"
          "# light), blocked (up to what is in the way), normal\n",
        why->out);
    for (int kind = GLINT_RAY_CAMERA; kind <= GLINT_RAY_PROBE; kind++) {
        put_rays(&lines, sample, (GlintRayKind)kind);
    }
    put_shadows(&lines, sample, GLINT_LIGHT_ARRIVES, "shadow");
    put_shadows(&lines, sample, GLINT_LIGHT_BLOCKED, "blocked");
    put_normals(&lines, sample);
}

GlintStatus cli_why_obj(CliWhy *why) { return cli_why_explain(why, put_sample, why); }
