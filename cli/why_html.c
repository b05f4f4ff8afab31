/* SPDX-License-Identifier: MIT
 * A page with the picture and the rays of its pixels. It cannot run Glint, so it holds the rays:
 * what glint_explain tells, in columns (why_columns.h), for every pixel of the region or, where
 * that would be too much, for every n-th; the page says which. What follows from the rest is left
 * to its script: points, n.v, levels. Numbers have five digits; exact ones are the text form's.
 *
 * The page itself is why_page.html; its script reads the columns by these names. */
#include "why.h"

#include "why_columns.h"
#include "why_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a page before they are compressed, which leaves about a sixth of them. */
static const double byte_limit = 64e6;

/* clang-format off */
#define COLUMNS(X) \
    X(pixel_rays, U16) X(pixel_layers, U16) X(pixel_dropped, U16) X(pixel_lights, U16) \
    X(pixel_red, F32) X(pixel_green, F32) X(pixel_blue, F32) \
    X(pixel_ox, F32) X(pixel_oy, F32) X(pixel_oz, F32) \
    X(ray_kind, U8) X(ray_end, U8) X(ray_parent, U16) X(ray_lit, U8) \
    X(ray_t, F32) X(ray_dx, F32) X(ray_dy, F32) X(ray_dz, F32) \
    X(ray_nx, F32) X(ray_ny, F32) X(ray_nz, F32) \
    X(ray_factor_r, F32) X(ray_factor_g, F32) X(ray_factor_b, F32) X(ray_density, F32) \
    X(ray_object, U32) X(ray_type, U8) X(ray_triangle, U32) X(ray_shader, U16) X(ray_local, U16) \
    X(ray_part_r, F32) X(ray_part_g, F32) X(ray_part_b, F32) \
    X(ray_kd_r, F32) X(ray_kd_g, F32) X(ray_kd_b, F32) \
    X(ray_own_r, F32) X(ray_own_g, F32) X(ray_own_b, F32) \
    X(layer_ray, U16) X(layer_shader, U16) X(layer_state, U8) \
    X(layer_cosine, F32) X(layer_behind, F32) X(layer_reflectance, F32) \
    X(dropped_ray, U16) X(dropped_kind, U8) X(dropped_fate, U8) X(dropped_weight, F32) \
    X(light_ray, U16) X(light_light, U16) X(light_fate, U8) \
    X(light_distance, F32) X(light_nl, F32) X(light_nh, F32) \
    X(light_strength_r, F32) X(light_strength_g, F32) X(light_strength_b, F32) \
    X(light_diffuse_r, F32) X(light_diffuse_g, F32) X(light_diffuse_b, F32) \
    X(light_highlight_r, F32) X(light_highlight_g, F32) X(light_highlight_b, F32) \
    X(light_share, F32) \
    X(light_adds_r, F32) X(light_adds_g, F32) X(light_adds_b, F32) \
    X(light_blocker, U32) X(light_blocker_type, U8) X(light_blocker_distance, F32)
/* clang-format on */

typedef enum Column {
#define COLUMN_ENUM(key, width) COLUMN_##key,
    COLUMNS(COLUMN_ENUM)
#undef COLUMN_ENUM
        COLUMN_COUNT
} Column;

typedef struct Page {
    CliWhy *why;
    const float *pixels; /* of the region, as they are drawn */
    CliColumn columns[COLUMN_COUNT];
    bool out_of_memory;
} Page;

static void page_begin(Page *page, CliWhy *why, const float *pixels) {
    static const CliColumn columns[COLUMN_COUNT] = {
#define COLUMN_ROW(key, width) {.name = #key, .type = CLI_COLUMN_##width},
        COLUMNS(COLUMN_ROW)
#undef COLUMN_ROW
    };
    *page = (Page){.why = why, .pixels = pixels};
    memcpy(page->columns, columns, sizeof columns);
}

static void put(Page *page, Column column, uint32_t value) {
    if (!cli_column_add(&page->columns[column], value)) page->out_of_memory = true;
}

static void put_number(Page *page, Column column, double value) {
    if (!cli_column_add_number(&page->columns[column], value)) page->out_of_memory = true;
}

/* Into this column and the two that follow. */
static void put_vec(Page *page, Column column, const double v[3]) {
    for (int i = 0; i < 3; i++) put_number(page, (Column)(column + i), v[i]);
}

/* ---------------------------------------------------------------- elements */

/* Indices on the page have sixteen bits; a tree with more rays is cut, and says so by its count. */
enum { MOST = 65534 };

static uint32_t least(size_t count) { return count < MOST ? (uint32_t)count : MOST; }

static uint32_t small(uint32_t index) { return index < MOST ? index : MOST + 1; }

static void put_ray(Page *page, const GlintExplainRay *ray, const double own[3]) {
    put(page, COLUMN_ray_kind, ray->kind);
    put(page, COLUMN_ray_end, ray->end);
    put(page, COLUMN_ray_parent, small(ray->parent));
    put(page, COLUMN_ray_lit, ray->lit);
    put_number(page, COLUMN_ray_t, ray->t);
    put_vec(page, COLUMN_ray_dx, ray->direction);
    put_vec(page, COLUMN_ray_nx, ray->normal);
    put_vec(page, COLUMN_ray_factor_r, ray->factor);
    put_number(page, COLUMN_ray_density, ray->density);
    put(page, COLUMN_ray_object,
        ray->end == GLINT_RAY_END_LIGHT ? ray->light : ray->surface.index1);
    put(page, COLUMN_ray_type, ray->surface_type);
    put(page, COLUMN_ray_triangle, ray->triangle + 1);
    put(page, COLUMN_ray_shader, small(ray->shader.index1));
    put(page, COLUMN_ray_local, small(ray->local_shader.index1));
    put_vec(page, COLUMN_ray_part_r, ray->local_factor);
    put_vec(page, COLUMN_ray_kd_r, ray->diffuse_color);
    put_vec(page, COLUMN_ray_own_r, own);
}

static void put_rays(Page *page, const GlintExplainSample *sample, uint32_t count) {
    double(*own)[3] = calloc(count, sizeof *own); /* what the ends of rays show by themselves */
    if (own == NULL) {
        page->out_of_memory = true;
        return;
    }
    for (size_t i = 0; i < sample->addition_count; i++) {
        const GlintExplainAddition *addition = &sample->additions[i];
        if (addition->light != GLINT_NONE || addition->ray >= count) continue;
        for (int k = 0; k < 3; k++) own[addition->ray][k] += addition->amount[k];
    }
    for (uint32_t i = 0; i < count; i++) put_ray(page, &sample->rays[i], own[i]);
    free(own);
}

static void put_layer(Page *page, const GlintExplainLayer *layer) {
    put(page, COLUMN_layer_ray, small(layer->ray));
    put(page, COLUMN_layer_shader, small(layer->shader.index1));
    put(page, COLUMN_layer_state, layer->behind ? 2 : layer->total ? 3 : layer->inside);
    put_number(page, COLUMN_layer_cosine, layer->cosine);
    put_number(page, COLUMN_layer_behind, layer->total ? 1 / layer->ratio : layer->cosine_behind);
    put_number(page, COLUMN_layer_reflectance, layer->reflectance);
}

static void put_dropped(Page *page, const GlintExplainBranch *branch) {
    put(page, COLUMN_dropped_ray, small(branch->ray));
    put(page, COLUMN_dropped_kind, branch->kind);
    put(page, COLUMN_dropped_fate, branch->fate);
    put_number(page, COLUMN_dropped_weight, branch->weight);
}

static void put_light(Page *page, const GlintExplainSample *s, const GlintExplainLight *light) {
    static const double nothing[3] = {0, 0, 0};
    put(page, COLUMN_light_ray, small(light->ray));
    put(page, COLUMN_light_light, small(light->light));
    put(page, COLUMN_light_fate, light->fate);
    put_number(page, COLUMN_light_distance, light->distance);
    put_number(page, COLUMN_light_nl, light->n_dot_l);
    put_number(page, COLUMN_light_nh, light->n_dot_h);
    put_vec(page, COLUMN_light_strength_r, light->strength);
    put_vec(page, COLUMN_light_diffuse_r, light->diffuse);
    put_vec(page, COLUMN_light_highlight_r, light->highlight);
    put_number(page, COLUMN_light_share, light->share);
    put_vec(page, COLUMN_light_adds_r,
        light->addition != GLINT_NONE ? s->additions[light->addition].amount : nothing);
    put(page, COLUMN_light_blocker,
        light->blocker_light != 0 ? light->blocker_light : light->blocker.index1);
    put(page, COLUMN_light_blocker_type, light->blocker_light != 0 ? 255 : light->blocker_type);
    put_number(page, COLUMN_light_blocker_distance, light->blocker_distance);
}

/* Not of RGBNormals, on which lights are no news. */
static bool shows_lights(const CliWhy *why, const GlintExplainRay *ray) {
    GlintShaderDesc desc;
    return !glint_scene_shader(why->scene, ray->local_shader, &desc) ||
           desc.type != GLINT_SHADER_RGB_NORMALS;
}

static void put_sample(void *user, const GlintExplainSample *sample) {
    Page *page = user;
    if (sample->sample != page->why->sample) return;
    uint32_t rays = least(sample->ray_count), layers = least(sample->layer_count);
    uint32_t dropped = 0, lights = 0;
    put_rays(page, sample, rays);
    for (uint32_t i = 0; i < layers; i++) put_layer(page, &sample->layers[i]);
    for (size_t i = 0; i < sample->branch_count && dropped < MOST; i++) {
        GlintBranchFate fate = sample->branches[i].fate;
        if (fate == GLINT_BRANCH_FOLLOWED || fate == GLINT_BRANCH_NOT_CHOSEN) continue;
        put_dropped(page, &sample->branches[i]);
        dropped++;
    }
    for (size_t i = 0; i < sample->light_count && lights < MOST; i++) {
        if (!shows_lights(page->why, &sample->rays[sample->lights[i].ray])) continue;
        put_light(page, sample, &sample->lights[i]);
        lights++;
    }
    put_vec(page, COLUMN_pixel_ox, sample->rays[0].origin);
    put(page, COLUMN_pixel_rays, rays);
    put(page, COLUMN_pixel_layers, layers);
    put(page, COLUMN_pixel_dropped, dropped);
    put(page, COLUMN_pixel_lights, lights);
}

/* ---------------------------------------------------------------- pixels */

/* The linear colour of a pixel of the region, as it was drawn. */
static void put_color(Page *page, int x, int y) {
    const int *region = page->why->region;
    const float *color =
        page->pixels + 3 * ((size_t)(y - region[1]) * (size_t)region[2] + (size_t)(x - region[0]));
    for (int i = 0; i < 3; i++) {
        put_number(page, (Column)(COLUMN_pixel_red + i), (double)color[i]);
    }
}

static GlintStatus explain_grid(Page *page, int step) {
    CliWhy *why = page->why;
    const GlintExplainSink sink = {
        .sample = put_sample, .user = page, .only_sample = why->sample + 1};
    GlintRenderDesc desc = why->desc;
    GlintMonitor monitor = *why->desc.monitor;
    monitor.progress = NULL; /* that of a pixel */
    desc.monitor = &monitor;
    desc.crop_width = desc.crop_height = 1;
    for (int y = why->region[1]; y < why->region[1] + why->region[3]; y += step) {
        why->desc.monitor->progress(why->desc.monitor->user, GLINT_PHASE_TRACE,
            (double)(y - why->region[1]) / why->region[3]);
        for (int x = why->region[0]; x < why->region[0] + why->region[2]; x += step) {
            desc.crop_x = x, desc.crop_y = y;
            GlintStatus status = glint_explain(why->scene, &desc, &sink, &why->error);
            if (page->out_of_memory) status = GLINT_ERROR_MEMORY;
            if (status != GLINT_OK) return status;
            put_color(page, x, y);
        }
    }
    return GLINT_OK;
}

/* The smallest step with which the page stays within its limits, by a look at some pixels. */
static GlintStatus choose_step(const Page *page, int *step) {
    enum { LOOK = 24 }; /* pixels along a side */
    CliWhy *why = page->why;
    int side = why->region[2] > why->region[3] ? why->region[2] : why->region[3];
    int coarse = side / LOOK + 1;
    double pixels = (double)why->region[2] * why->region[3];
    Page look;
    page_begin(&look, why, page->pixels);
    GlintStatus status = explain_grid(&look, coarse);
    double seen = (double)look.columns[COLUMN_pixel_rays].count;
    double bytes = pixels / seen * (double)cli_columns_size(look.columns, COLUMN_COUNT);
    *step = 1;
    while (*step * *step < bytes / byte_limit) ++*step;
    cli_columns_reset(look.columns, COLUMN_COUNT);
    return status;
}

/* ---------------------------------------------------------------- the scene */

static void put_object(const CliWhy *why, GlintObjectKind kind, uint32_t index1, const char *type) {
    GlintSource source = cli_why_source(why, kind, index1);
    FILE *out = why->out;
    fprintf(out, "\"%u\":{\"type\":", (unsigned)index1);
    cli_why_json_text(out, type);
    fputs(",\"name\":", out);
    cli_why_json_text(out, source.name);
    fprintf(out, ",\"line\":%lld", (long long)source.line);
}

static void put_shader_values(const CliWhy *why, const GlintShaderDesc *desc) {
    const double values[] = {desc->exponent, desc->roughness, desc->refractive_index};
    static const char *const names[] = {"exponent", "roughness", "index"};
    const double *colors[] = {desc->diffuse_color, desc->specular_color};
    static const char *const color_names[] = {"kd", "ks"};
    for (int i = 0; i < 3; i++) fprintf(why->out, ",\"%s\":%.9g", names[i], values[i]);
    for (int i = 0; i < 2; i++) {
        fprintf(why->out, ",\"%s\":[%.9g,%.9g,%.9g]", color_names[i], colors[i][0], colors[i][1],
            colors[i][2]);
    }
}

static void put_shaders(const CliWhy *why) {
    GlintShaderDesc desc;
    fputs("\"shaders\":{", why->out);
    for (uint32_t i = 0; glint_scene_shader(why->scene, (GlintShaderId){i}, &desc); i++) {
        if (i > 0) fputc(',', why->out);
        put_object(why, GLINT_OBJECT_SHADER, i, cli_why_shader_type(desc.type));
        put_shader_values(why, &desc);
        fputc('}', why->out);
    }
    fputs("},\n", why->out);
}

static void put_lights(const CliWhy *why) {
    GlintLightDesc desc;
    fputs("\"lights\":{", why->out);
    for (uint32_t i = 1; glint_scene_light(why->scene, i, &desc); i++) {
        if (i > 1) fputc(',', why->out);
        put_object(why, GLINT_OBJECT_LIGHT, i, cli_why_light_type(desc.type));
        fprintf(why->out, ",\"intensity\":[%.9g,%.9g,%.9g]}", desc.intensity[0], desc.intensity[1],
            desc.intensity[2]);
    }
    fputs("},\n", why->out);
}

static int compare_ids(const void *a, const void *b) {
    const uint32_t *first = a, *second = b;
    return (*first > *second) - (*first < *second);
}

/* Of those surfaces alone that are spoken of: a scene may have millions. */
static bool put_surfaces(const Page *page) {
    const CliColumn *met = &page->columns[COLUMN_ray_object];
    const CliColumn *ends = &page->columns[COLUMN_ray_end];
    const CliColumn *blockers = &page->columns[COLUMN_light_blocker];
    const CliColumn *types = &page->columns[COLUMN_light_blocker_type];
    uint32_t *ids = malloc((met->count + blockers->count + 1) * sizeof *ids);
    if (ids == NULL) return false;
    size_t count = 0;
    for (size_t i = 0; i < met->count; i++) {
        if (ends->values[i] == GLINT_RAY_END_SURFACE) ids[count++] = met->values[i];
    }
    for (size_t i = 0; i < blockers->count; i++) {
        if (types->values[i] != 255 && blockers->values[i] > 0) ids[count++] = blockers->values[i];
    }
    qsort(ids, count, sizeof *ids, compare_ids);
    fputs("\"surfaces\":{", page->why->out);
    bool first = true;
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && ids[i] == ids[i - 1]) continue;
        if (!first) fputc(',', page->why->out);
        first = false;
        put_object(page->why, GLINT_OBJECT_SURFACE, ids[i], "");
        fputc('}', page->why->out);
    }
    fputs("},\n", page->why->out);
    free(ids);
    return true;
}

/* ---------------------------------------------------------------- the picture */

/* Base64 takes three bytes at a time; what is over waits for the next call. */
typedef struct Tail {
    FILE *out;
    uint8_t bytes[3];
    size_t count;
} Tail;

static bool put_base64(void *user, const void *bytes, size_t size) {
    Tail *tail = user;
    const uint8_t *next = bytes;
    for (; size > 0 && tail->count > 0 && tail->count < 3; size--) {
        tail->bytes[tail->count++] = *next++;
    }
    if (tail->count == 3) {
        cli_base64_write(tail->out, tail->bytes, 3);
        tail->count = 0;
    }
    if (tail->count > 0) return true;
    size_t whole = size / 3 * 3;
    cli_base64_write(tail->out, next, whole);
    tail->count = size - whole;
    memcpy(tail->bytes, next + whole, tail->count);
    return true;
}

/* All pixels of the region, on all threads. */
static GlintStatus draw(CliWhy *why, float **pixels) {
    size_t count = (size_t)why->region[2] * (size_t)why->region[3];
    *pixels = malloc(count * 3 * sizeof **pixels);
    if (*pixels == NULL) return GLINT_ERROR_MEMORY;
    GlintRenderDesc desc = why->desc;
    desc.crop_x = why->region[0], desc.crop_y = why->region[1];
    desc.crop_width = why->region[2], desc.crop_height = why->region[3];
    return glint_render(why->scene, &desc, *pixels, &why->error);
}

static GlintStatus put_picture(CliWhy *why, const float *pixels) {
    Tail tail = {.out = why->out};
    const GlintImage image = {why->region[2], why->region[3], pixels};
    GlintSaveDesc save = glint_save_desc_default();
    fputs("\"picture\":\"data:image/png;base64,", why->out);
    GlintStatus status = glint_image_encode_png(&image, &save, put_base64, &tail, &why->error);
    cli_base64_write(why->out, tail.bytes, tail.count);
    fputs("\",\n", why->out);
    return status;
}

/* ---------------------------------------------------------------- the page */

/* The options with which `glint why` tells of the same picture. */
static void put_options(const CliWhy *why) {
    FILE *out = why->out;
    fputs("\"options\":\"", out);
    if (why->desc.width > 0) fprintf(out, " --size %dx%d", why->width, why->height);
    if (why->desc.samples > 0) fprintf(out, " --samples %d", why->desc.samples);
    if (why->sample > 0) fprintf(out, " --sample %d", why->sample + 1);
    if (why->dialect != GLINT_DIALECT_AUTO) {
        fprintf(out, " --dialect %s", glint_dialect_name(why->dialect));
    }
    fputs("\",\n", out);
}

static void put_facts(const CliWhy *why, int step) {
    FILE *out = why->out;
    double background[3];
    bool sky = glint_scene_background(why->scene, background);
    int x = why->x >= 0 ? why->x : why->region[0] + why->region[2] / 2;
    int y = why->y >= 0 ? why->y : why->region[1] + why->region[3] / 2;
    fputs("{\"scene\":", out);
    cli_why_json_text(out, why->name);
    fprintf(out, ",\"dialect\":\"%s\",\"size\":[%d,%d],\"region\":[%d,%d,%d,%d],\"step\":%d,",
        glint_dialect_name(why->info.dialect), why->width, why->height, why->region[0],
        why->region[1], why->region[2], why->region[3], step);
    fprintf(out, "\"samples\":%d,\"sample\":%d,\"sky\":%s,\"start\":[%d,%d],\n", why->samples,
        why->sample + 1, sky ? "true" : "false", x, y);
}

/* The picture, then the columns: what is largest stands last. */
static GlintStatus put_page(const Page *page, int step) {
    CliWhy *why = page->why;
    fwrite(cli_why_page_head, 1, cli_why_page_head_size, why->out);
    put_facts(why, step);
    put_options(why);
    put_shaders(why);
    put_lights(why);
    if (!put_surfaces(page)) return GLINT_ERROR_MEMORY;
    GlintStatus status = put_picture(why, page->pixels);
    if (status != GLINT_OK) return status;
    if (!cli_columns_write(why->out, page->columns, COLUMN_COUNT)) return GLINT_ERROR_MEMORY;
    fputs("}\n", why->out);
    fwrite(cli_why_page_tail, 1, cli_why_page_tail_size, why->out);
    return GLINT_OK;
}

GlintStatus cli_why_html(CliWhy *why) {
    int step = why->step;
    float *pixels = NULL;
    if (why->region[2] == 0) {
        why->region[2] = why->width;
        why->region[3] = why->height;
    }
    GlintStatus status = draw(why, &pixels);
    Page page;
    page_begin(&page, why, pixels);
    if (status == GLINT_OK && step == 0) status = choose_step(&page, &step);
    if (status == GLINT_OK) status = explain_grid(&page, step);
    if (status == GLINT_OK) status = put_page(&page, step);
    cli_columns_reset(page.columns, COLUMN_COUNT);
    free(pixels);
    return status;
}
