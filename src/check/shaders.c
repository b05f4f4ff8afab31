/* SPDX-License-Identifier: MIT
 * Rules of shaders, colours and textures. */
#include "check/inside.h"

/* ---------------------------------------------------------------- shaders that nothing has */

static void check_unused(GiCheck *check) {
    for (uint32_t i = 1; i < check->scene->shaders.count; i++) {
        if (check->shader_used[i]) continue;
        GlintSource source;
        bool named = gi_sources_find(check->input->sources, GLINT_OBJECT_SHADER, i, &source) &&
                     source.name[0] != '\0';
        int64_t place = gi_check_place(check, GLINT_OBJECT_SHADER, i);
        if (named) {
            gi_check_add(check, GI_CHECK_UNUSED_SHADER, place, "no surface has the shader `%.60s`",
                source.name);
        } else {
            gi_check_add(check, GI_CHECK_UNUSED_SHADER, place,
                "no surface has this shader: the last one in a surface counts");
        }
    }
    const GiSources *sources = check->input->sources;
    for (size_t i = 0; i < sources->idle.count; i++) {
        gi_check_add(check, GI_CHECK_IDLE_SHADER, sources->idle.data[i],
            "this shader has no name and no surface, so it has no effect\n"
            "put it into each surface, or give it a name and refer to it");
    }
}

/* ---------------------------------------------------------------- colours */

typedef struct Color {
    const char *name;
    GiVec value;
} Color;

enum { COLORS = 3 };

/* The colours that matter to a shader. */
static int colors_of(const GiShader *shader, Color colors[COLORS]) {
    int count = 0;
    bool glass = shader->type == GLINT_SHADER_GLASS || shader->type == GLINT_SHADER_GLAZED;
    if (glass || shader->type == GLINT_SHADER_RGB_NORMALS) return 0;
    if (shader->texture == GI_NONE) colors[count++] = (Color){"diffuseColor", shader->diffuse};
    colors[count++] = (Color){"mirrorCoefficient", shader->mirror};
    bool facets = shader->type == GLINT_SHADER_BECKMANN || shader->type == GLINT_SHADER_GGX;
    if (shader->type != GLINT_SHADER_LAMBERTIAN) {
        colors[count++] = (Color){facets ? "microfacetColor" : "specularColor", shader->specular};
    }
    return count;
}

static double component(GiVec v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

/* Bits of the components below 0, or above 1. */
static unsigned outside(GiVec color, bool above) {
    unsigned bits = 0;
    for (int i = 0; i < 3; i++) {
        double c = component(color, i);
        bits |= (unsigned)(above ? c > 1 : c < 0) << i;
    }
    return bits;
}

/* For each shader the components that are seen to be cut off: pixels that are brighter than 1. */
static void find_clipped(const GiCheck *check, uint8_t *clipped) {
    const GiSurvey *survey = &check->survey;
    for (size_t i = 0; i < check->census.count; i++) {
        /* Only the shaders that surfaces of the scene's own tree have. */
        if (check->census.data[i].shader == GI_NONE) continue;
        clipped[check->census.data[i].shader] = 0;
    }
    size_t pixels = (size_t)survey->width * (size_t)survey->height;
    for (size_t i = 0; i < pixels; i++) {
        if (survey->surface[i] == 0) continue;
        /* The census is in the order of the file: halve. */
        uint32_t order = survey->surface[i] - 1;
        size_t low = 0, high = check->census.count;
        while (low < high) {
            size_t middle = low + (high - low) / 2;
            if (check->census.data[middle].order < order) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        if (low == check->census.count || check->census.data[low].order != order) continue;
        uint32_t shader = check->census.data[low].shader;
        if (shader == GI_NONE) continue;
        for (int c = 0; c < 3; c++) {
            if (survey->color[3 * i + (size_t)c] > 1.0f) clipped[shader] |= (uint8_t)(1 << c);
        }
    }
}

static void check_shader_colors(GiCheck *check, uint32_t index, unsigned clipped) {
    Color colors[COLORS];
    int count = colors_of(&check->scene->shaders.data[index], colors);
    int64_t place = gi_check_place(check, GLINT_OBJECT_SHADER, index);
    for (int i = 0; i < count; i++) {
        GiVec v = colors[i].value;
        if (outside(v, false) != 0) {
            gi_check_add(check, GI_CHECK_COLOR_NEGATIVE, place,
                "%s %.4g %.4g %.4g has a component below 0, which takes light away", colors[i].name,
                v.x, v.y, v.z);
        }
        if ((outside(v, true) & clipped) == 0) continue;
        if (gi_largest(v) > 2) {
            gi_check_add(check, GI_CHECK_COLOR_CLIPS, place,
                "%s %.4g %.4g %.4g is more than 1, and the picture is cut off there\n"
                "colours run from 0 to 1: if 255 was meant for 1, write %.3g %.3g %.3g",
                colors[i].name, v.x, v.y, v.z, v.x / 255, v.y / 255, v.z / 255);
        } else {
            gi_check_add(check, GI_CHECK_COLOR_CLIPS, place,
                "%s %.4g %.4g %.4g is more than 1, and the picture is cut off there",
                colors[i].name, v.x, v.y, v.z);
        }
    }
}

static bool shows_background(const GiSurvey *survey) {
    return survey->seen < (size_t)survey->width * (size_t)survey->height;
}

static void check_background(GiCheck *check) {
    const GiScene *scene = check->scene;
    GiVec v = scene->back_color, drawn = gi_scale(v, scene->exposure > 0 ? scene->exposure : 1);
    if (scene->environment.face > 0) return;
    int64_t root = check->root;
    if (outside(v, false) != 0) {
        gi_check_add(check, GI_CHECK_COLOR_NEGATIVE, root,
            "backColor %.4g %.4g %.4g has a component below 0", v.x, v.y, v.z);
    }
    /* A bright sky may be meant; 255 for 1 is not. */
    if (gi_largest(v) > 2 && outside(drawn, true) != 0 && shows_background(&check->survey)) {
        gi_check_add(check, GI_CHECK_COLOR_CLIPS, root,
            "backColor %.4g %.4g %.4g is more than 1, and the picture is cut off there", v.x, v.y,
            v.z);
    }
}

static void check_colors(GiCheck *check) {
    size_t count = check->scene->shaders.count;
    uint8_t *clipped = gi_memory_allocate(check->memory, count);
    if (clipped == NULL) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    for (size_t i = 0; i < count; i++) clipped[i] = 0;
    find_clipped(check, clipped);
    for (uint32_t i = 1; i < count; i++) {
        if (check->shader_used[i]) check_shader_colors(check, i, clipped[i]);
    }
    check_background(check);
    gi_memory_free(check->memory, clipped, count);
}

/* ---------------------------------------------------------------- exponents, textures */

static void check_exponents(GiCheck *check) {
    for (uint32_t i = 1; i < check->scene->shaders.count; i++) {
        const GiShader *shader = &check->scene->shaders.data[i];
        if (!check->shader_used[i] || shader->type != GLINT_SHADER_PHONG) continue;
        if (shader->exponent > 0 || gi_vec_is_zero(shader->specular)) continue;
        gi_check_add(check, GI_CHECK_EXPONENT, gi_check_place(check, GLINT_OBJECT_SHADER, i),
            shader->exponent == 0
                ? "with the exponent 0 the highlight covers all of the surface"
                : "with the exponent %.4g the highlight grows away from its middle",
            shader->exponent);
    }
}

/* Whether the shader, or what is under its glaze, has a texture. */
static bool is_textured(const GiCheck *check, uint32_t shader) {
    const GiShader *at = &check->scene->shaders.data[shader];
    for (int i = 0; i < GI_SUBSTRATE_LIMIT && at->substrate != GI_NONE; i++) {
        at = &check->scene->shaders.data[at->substrate];
    }
    return at->texture != GI_NONE;
}

static void report_texture(GiCheck *check, uint32_t order, const char *text) {
    gi_check_add(check, GI_CHECK_TEXCOORDS, gi_check_place(check, GLINT_OBJECT_SURFACE, order + 1),
        "%s: all of it shows one point of the texture", text);
}

static void check_textures(GiCheck *check) {
    const GiScene *scene = check->scene;
    if (scene->textures.count == 0) return;
    for (int kind = GI_SHAPE_SPHERE + 1; kind < GI_SHAPE_RECTANGLE; kind++) {
        for (size_t i = 0; i < scene->info[kind].count; i++) {
            const GiShapeInfo *info = &scene->info[kind].data[i];
            if (!is_textured(check, info->shader)) continue;
            report_texture(check, info->order, "only spheres and meshes have texture coordinates");
        }
    }
    for (size_t i = 0; i < scene->mesh_surfaces.count; i++) {
        const GiMeshSurface *surface = &scene->mesh_surfaces.data[i];
        if (scene->meshes.meshes.data[surface->mesh].textured) continue;
        if (!is_textured(check, surface->info.shader)) continue;
        report_texture(check, surface->info.order, "the mesh has no texture coordinates");
    }
}

void gi_check_shaders(GiCheck *check) {
    check_unused(check);
    check_colors(check);
    check_exponents(check);
    check_textures(check);
}
