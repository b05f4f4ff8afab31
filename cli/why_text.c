/* SPDX-License-Identifier: MIT
 * The explanation of a pixel to read: its colour, the gist, the rays of one sample, and how their
 * light becomes a colour of 8 bits. */
#include "why_tree.h"

#include <math.h>
#include <stdlib.h>

/* ---------------------------------------------------------------- all samples */

enum { LISTED_SAMPLES = 16 };

/* A line a sample; of many samples, those that met the same thing in one. */
typedef struct Group {
    char name[CLI_WHY_NAME_SIZE];
    uint32_t surface, light; /* 0, 0: nothing was met */
    int count;
    double sum[3];
} Group;

typedef struct Summary {
    CliWhy *why;
    Group *groups;
    int count, capacity;
    bool out_of_memory;
} Summary;

static const char *end_of(const CliWhy *why, const GlintExplainRay *ray, char *name) {
    if (ray->end == GLINT_RAY_END_NOTHING) return "nothing";
    return cli_why_name_surface(why, ray->surface, ray->surface_type, GLINT_NONE, ray->light, name);
}

static Group *group_of(Summary *summary, const GlintExplainRay *ray) {
    for (int i = 0; i < summary->count; i++) {
        Group *group = &summary->groups[i];
        if (group->surface == ray->surface.index1 && group->light == ray->light) return group;
    }
    if (summary->count == summary->capacity) {
        int capacity = summary->capacity > 0 ? 2 * summary->capacity : 8;
        Group *groups = realloc(summary->groups, (size_t)capacity * sizeof *groups);
        if (groups == NULL) return NULL;
        summary->groups = groups;
        summary->capacity = capacity;
    }
    Group *group = &summary->groups[summary->count++];
    *group = (Group){.surface = ray->surface.index1, .light = ray->light};
    char name[CLI_WHY_NAME_SIZE];
    snprintf(group->name, sizeof group->name, "%s", end_of(summary->why, ray, name));
    return group;
}

static void summarize(void *user, const GlintExplainSample *sample) {
    Summary *summary = user;
    const CliWhy *why = summary->why;
    char name[CLI_WHY_NAME_SIZE];
    if (sample->samples <= LISTED_SAMPLES) {
        cli_why_line(why, 2, "%3d at %.3f, %.3f: %s  (meets %s)", sample->sample + 1,
            sample->film_x, sample->film_y, cli_why_vec(sample->color),
            end_of(why, &sample->rays[0], name));
        return;
    }
    Group *group = group_of(summary, &sample->rays[0]);
    if (group == NULL) {
        summary->out_of_memory = true;
        return;
    }
    group->count++;
    for (int i = 0; i < 3; i++) group->sum[i] += sample->color[i];
}

static GlintStatus print_samples(CliWhy *why) {
    Summary summary = {.why = why};
    cli_why_line(why, 0,
        "\nIts %d samples (place in the pixel from the lower left, colour):", why->pixel.samples);
    GlintStatus status = cli_why_explain(why, summarize, &summary);
    for (int i = 0; i < summary.count; i++) {
        Group *group = &summary.groups[i];
        for (int k = 0; k < 3; k++) group->sum[k] /= group->count;
        cli_why_line(why, 2, "%d meet %s: %s on average", group->count, group->name,
            cli_why_vec(group->sum));
    }
    free(summary.groups);
    return summary.out_of_memory ? GLINT_ERROR_MEMORY : status;
}

/* ---------------------------------------------------------------- the sum */

/* Where an addition comes from, in a word or two. */
static void name_addition(const CliWhy *why, const GlintExplainSample *sample,
    const GlintExplainAddition *addition, char *name, size_t size) {
    const GlintExplainRay *ray = &sample->rays[addition->ray];
    char from[80], what[40];
    if (ray->end == GLINT_RAY_END_NOTHING) {
        snprintf(from, sizeof from, "nothing met");
    } else if (ray->end == GLINT_RAY_END_LIGHT) {
        snprintf(from, sizeof from, "light %u", (unsigned)ray->light);
    } else {
        snprintf(from, sizeof from, "surface %u", (unsigned)ray->surface.index1);
    }
    if (addition->light == GLINT_NONE) {
        snprintf(what, sizeof what, "%s",
            ray->end == GLINT_RAY_END_NOTHING ? "background"
            : ray->end == GLINT_RAY_END_LIGHT ? "seen"
                                              : "normal");
    } else {
        uint32_t light = sample->lights[addition->light].light;
        if (light == 0) {
            snprintf(what, sizeof what, "environment");
        } else {
            snprintf(what, sizeof what, "light %u", (unsigned)light);
        }
    }
    (void)why;
    snprintf(name, size, "level %u, %s: %s", (unsigned)ray->level, from, what);
}

static void print_additions(const CliWhy *why, const GlintExplainSample *sample) {
    cli_why_line(why, 0, "\nThe sum, in the order in which it was made:");
    if (sample->addition_count == 0) cli_why_line(why, 2, "nothing was added");
    for (size_t i = 0; i < sample->addition_count; i++) {
        const GlintExplainAddition *addition = &sample->additions[i];
        char name[160];
        name_addition(why, sample, addition, name, sizeof name);
        fprintf(why->out, "  %-40s + %-32s = %s\n", name, cli_why_vec(addition->amount),
            cli_why_vec(addition->sum));
    }
}

/* Linear to 8 bits: a power and a product, told for each channel. */
static void print_bytes(const CliWhy *why) {
    static const char *const channels[] = {"red", "green", "blue"};
    const GlintExplainPixel *pixel = &why->pixel;
    for (int i = 0; i < 3; i++) {
        double color = (double)pixel->color[i];
        const char *clamp = color > 1 ? " (above 1: cut to 1)" : color < 0 ? " (below 0: cut)" : "";
        double within = color > 1 ? 1 : color > 0 ? color : 0;
        cli_why_line(why, 2, "%-5s 255 x %.9g^(1/2.2) = %.2f -> %d%s", channels[i], color,
            255 * pow(within, 1 / 2.2), pixel->rgb[i], clamp);
    }
}

static void print_color(const CliWhy *why) {
    const GlintExplainPixel *pixel = &why->pixel;
    cli_why_line(why, 0, "\nThe colour:");
    if (pixel->samples > 1) {
        double mean[3];
        for (int i = 0; i < 3; i++) mean[i] = pixel->sum[i] / pixel->samples;
        cli_why_line(why, 2, "sum of %d samples %s, mean %s", pixel->samples,
            cli_why_vec(pixel->sum), cli_why_vec(mean));
    }
    if (pixel->exposure != 1) cli_why_line(why, 2, "x exposure %.6g", pixel->exposure);
    cli_why_line(why, 2, "linear %.9g %.9g %.9g", (double)pixel->color[0], (double)pixel->color[1],
        (double)pixel->color[2]);
    print_bytes(why);
}

/* ---------------------------------------------------------------- the whole */

static void print_detail(void *user, const GlintExplainSample *sample) {
    const CliWhy *why = user;
    if (sample->sample != why->sample) return;
    cli_why_print_short(why, sample);
    fputc('\n', why->out);
    if (sample->samples > 1) {
        cli_why_line(why, 0, "Sample %d of %d, at %.3f, %.3f of the pixel:", sample->sample + 1,
            sample->samples, sample->film_x, sample->film_y);
    }
    cli_why_print_tree(why, sample);
    print_additions(why, sample);
}

static void keep_nothing(void *user, const GlintExplainSample *sample) {
    (void)user;
    (void)sample;
}

/* The colour comes first, and is known last: so the pixel is drawn more than once. */
GlintStatus cli_why_text(CliWhy *why) {
    GlintStatus status = cli_why_explain(why, keep_nothing, NULL);
    if (status != GLINT_OK) return status;
    const uint8_t *rgb = why->pixel.rgb;
    cli_why_line(why, 0, "%s, pixel %d,%d of %d x %d, dialect %s: #%02x%02x%02x (%d %d %d)\n",
        why->name, why->x, why->y, why->width, why->height, glint_dialect_name(why->info.dialect),
        rgb[0], rgb[1], rgb[2], rgb[0], rgb[1], rgb[2]);
    status = cli_why_explain(why, print_detail, why);
    if (status == GLINT_OK && why->pixel.samples > 1) status = print_samples(why);
    if (status == GLINT_OK) print_color(why);
    return status;
}
