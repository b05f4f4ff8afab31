/* SPDX-License-Identifier: MIT */
#include "why.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- words */

const char *cli_why_surface_type(GlintSurfaceType type) {
    static const char *const names[] = {
        "Sphere", "Box", "Cylinder", "Cone", "Plane", "Disc", "Group", "Mesh"};
    return names[type];
}

const char *cli_why_shader_type(GlintShaderType type) {
    static const char *const names[] = {"Lambertian", "Phong", "RGBNormals", "Glazed", "Glass",
        "Beckmann microfacets", "GGX microfacets", "CookTorrance"};
    return names[type];
}

const char *cli_why_light_type(GlintLightType type) {
    static const char *const names[] = {
        "point", "ambient", "constant", "normal", "directional", "rectangle"};
    return names[type];
}

const char *cli_why_ray_kind(GlintRayKind kind) {
    static const char *const names[] = {"camera", "mirrored", "refracted", "scattered", "probe"};
    return names[kind];
}

const char *cli_why_branch_fate(GlintBranchFate fate) {
    static const char *const names[] = {
        "followed", "nothing", "too light", "too deep", "not chosen", "ended", "no tree"};
    return names[fate];
}

const char *cli_why_light_fate(GlintLightFate fate) {
    static const char *const names[] = {"arrives", "blocked", "everywhere", "behind", "unseen side",
        "off", "turned away", "on surface", "absorbed"};
    return names[fate];
}

/* ---------------------------------------------------------------- objects */

GlintSource cli_why_source(const CliWhy *why, GlintObjectKind kind, uint32_t index1) {
    GlintSource source = {.path = why->name, .name = ""};
    if (!glint_scene_source(why->scene, kind, index1, &source)) source.line = 0;
    return source;
}

/* A scene from a stranger must not steer the terminal. */
static void disarm(char *text) {
    for (; *text != '\0'; text++) {
        unsigned char byte = (unsigned char)*text;
        if (byte < 0x20 || byte == 0x7f) *text = '?';
    }
}

/* Appends ` "name" (line N)`, as far as there is one. */
static void append_source(
    const CliWhy *why, GlintObjectKind kind, uint32_t index1, char name[CLI_WHY_NAME_SIZE]) {
    GlintSource source = cli_why_source(why, kind, index1);
    size_t used = strlen(name), room = CLI_WHY_NAME_SIZE - used;
    if (source.name[0] != '\0') snprintf(name + used, room, " \"%.200s\"", source.name);
    used = strlen(name);
    room = CLI_WHY_NAME_SIZE - used;
    if (source.line > 0) snprintf(name + used, room, " (line %lld)", (long long)source.line);
    disarm(name);
}

const char *cli_why_name_surface(const CliWhy *why, GlintSurfaceId surface, GlintSurfaceType type,
    uint32_t triangle, uint32_t light, char name[CLI_WHY_NAME_SIZE]) {
    if (light != 0) return cli_why_name_light(why, light, name);
    snprintf(name, CLI_WHY_NAME_SIZE, "surface %u, %s", (unsigned)surface.index1,
        cli_why_surface_type(type));
    append_source(why, GLINT_OBJECT_SURFACE, surface.index1, name);
    size_t used = strlen(name);
    if (triangle != GLINT_NONE) {
        snprintf(name + used, CLI_WHY_NAME_SIZE - used, ", triangle %u", (unsigned)triangle + 1);
    }
    return name;
}

const char *cli_why_name_light(const CliWhy *why, uint32_t light, char name[CLI_WHY_NAME_SIZE]) {
    GlintLightDesc desc;
    if (!glint_scene_light(why->scene, light, &desc)) {
        snprintf(name, CLI_WHY_NAME_SIZE, "environment");
        return name;
    }
    snprintf(
        name, CLI_WHY_NAME_SIZE, "light %u, %s", (unsigned)light, cli_why_light_type(desc.type));
    append_source(why, GLINT_OBJECT_LIGHT, light, name);
    return name;
}

const char *cli_why_name_shader(
    const CliWhy *why, GlintShaderId shader, char name[CLI_WHY_NAME_SIZE]) {
    GlintShaderDesc desc = glint_shader_desc_default();
    glint_scene_shader(why->scene, shader, &desc);
    snprintf(name, CLI_WHY_NAME_SIZE, "%s", cli_why_shader_type(desc.type));
    if (shader.index1 == 0) {
        strcat(name, ", the default shader");
    } else {
        append_source(why, GLINT_OBJECT_SHADER, shader.index1, name);
    }
    return name;
}

/* ---------------------------------------------------------------- JSON */

/* The length of the UTF-8 character that begins here; 0: none does. */
static int character_length(const unsigned char *text) {
    static const struct {
        unsigned char mask, lead;
        int length;
    } forms[] = {{0x80, 0x00, 1}, {0xe0, 0xc0, 2}, {0xf0, 0xe0, 3}, {0xf8, 0xf0, 4}};
    for (int i = 0; i < 4; i++) {
        if ((text[0] & forms[i].mask) != forms[i].lead) continue;
        for (int k = 1; k < forms[i].length; k++) {
            if ((text[k] & 0xc0) != 0x80) return 0;
        }
        return forms[i].length;
    }
    return 0;
}

void cli_why_json_text(FILE *out, const char *text) {
    const unsigned char *next = (const unsigned char *)text;
    fputc('"', out);
    while (*next != '\0') {
        int length = character_length(next);
        if (length == 0) {
            fputc('?', out);
            next++;
            continue;
        }
        /* The page keeps JSON inside of a script element, which "</" could end. */
        bool escaped = *next == '"' || *next == '\\' || *next < 0x20 || *next == '<';
        if (escaped) {
            fprintf(out, "\\u%04x", *next);
        } else {
            fwrite(next, 1, (size_t)length, out);
        }
        next += length;
    }
    fputc('"', out);
}

void cli_why_json_number(FILE *out, double number) {
    if (isfinite(number)) {
        fprintf(out, "%.17g", number);
    } else {
        fputs("null", out);
    }
}
