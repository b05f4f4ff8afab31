/* SPDX-License-Identifier: MIT
 * Each function makes the mistakes of one kind and says whether anything in the scene depends on
 * them. */
#include "render/broken.h"

#include "camera/camera.h"

#include <string.h>

#define HAS(NAME) GI_MISTAKE_HAS(mistakes, NAME)

/* What the scene has that mistakes can be made with. */
typedef struct Contents {
    bool phong, glossy, diffuse, recursive, textured;
    bool point, falling, steady, shadowing;
    bool smooth, transformed;
} Contents;

static bool is_placeless(const GiLight *light) {
    return light->type == GLINT_LIGHT_AMBIENT || light->type == GLINT_LIGHT_CONSTANT ||
           light->type == GLINT_LIGHT_NORMAL;
}

static bool falls(const GiLight *light, const GiRules *rules) {
    return light->falloff == GLINT_FALLOFF_INVERSE_SQUARE ||
           (light->falloff == GLINT_FALLOFF_DIALECT && rules->falloff);
}

static Contents contents_of(const GiWorld *world) {
    const GiScene *scene = world->scene;
    Contents has = {.transformed = world->spread.transforms.count > 0};
    for (size_t i = 0; i < scene->shaders.count; i++) {
        const GiShader *shader = &scene->shaders.data[i];
        has.phong |= shader->type == GLINT_SHADER_PHONG;
        has.diffuse |=
            shader->type == GLINT_SHADER_LAMBERTIAN || shader->type == GLINT_SHADER_PHONG;
        has.glossy |= shader->type == GLINT_SHADER_PHONG || shader->type == GLINT_SHADER_BECKMANN ||
                      shader->type == GLINT_SHADER_GGX ||
                      shader->type == GLINT_SHADER_COOK_TORRANCE;
        has.recursive |= shader->type == GLINT_SHADER_GLASS ||
                         shader->type == GLINT_SHADER_GLAZED || !gi_vec_is_zero(shader->mirror);
        has.textured |= shader->texture != GI_NONE;
    }
    for (size_t i = 0; i < scene->lights.count; i++) {
        const GiLight *light = &scene->lights.data[i];
        has.shadowing |= !is_placeless(light);
        if (light->type != GLINT_LIGHT_POINT) continue;
        has.point = true;
        has.falling |= falls(light, world->rules);
        has.steady |= !falls(light, world->rules);
    }
    for (size_t i = 0; i < scene->meshes.meshes.count; i++) {
        has.smooth |= scene->meshes.meshes.data[i].smooth;
    }
    has.shadowing |= world->sky_lights;
    has.recursive |= scene->integrator == GLINT_INTEGRATOR_PATH;
    return has;
}

/* ---------------------------------------------------------------- rules */

static bool spoil_shading(GiRules *rules, const Contents *has, const GlintMistakes *mistakes) {
    rules->falloff_linear = HAS(FALLOFF_LINEAR) && has->falling;
    rules->diffuse_behind = HAS(DIFFUSE_BEHIND) && has->diffuse;
    rules->specular_behind = HAS(SPECULAR_BEHIND) && has->phong;
    rules->reflected_highlight = HAS(REFLECTED_HIGHLIGHT) && has->phong;
    rules->texture_flipped = HAS(TEXTURE_FLIPPED) && has->textured;
    rules->odd_shading = rules->falloff_linear || rules->diffuse_behind || rules->specular_behind ||
                         rules->reflected_highlight;
    bool differs = rules->odd_shading || rules->texture_flipped;
    if (rules->specular_behind) rules->highlight_needs_light = false;
    if (HAS(SPECULAR_COSINE) && has->phong) {
        rules->phong_cosine = !rules->phong_cosine;
        differs = true;
    }
    if (HAS(DIFFUSE_PI) && has->diffuse) {
        rules->diffuse_over_pi = !rules->diffuse_over_pi;
        differs = true;
    }
    return differs;
}

static bool spoil_rays(GiRules *rules, const Contents *has, const GlintMistakes *mistakes) {
    bool differs = false;
    if (has->shadowing) {
        if (HAS(SHADOW_BEYOND)) rules->shadows = GI_SHADOWS_BEYOND;
        if (HAS(SHADOW_REVERSED)) rules->shadows = GI_SHADOWS_REVERSED;
        if (HAS(NO_SHADOWS)) rules->shadows = GI_SHADOWS_MISSING;
        differs = rules->shadows != GI_SHADOWS_CAST;
        if (HAS(SHADOW_ACNE)) {
            rules->shadow_distance = 1e-300; /* 0 stands for the error bound */
            rules->sphere_shadows_itself = true;
            differs = true;
        }
    }
    if (HAS(NO_RECURSION) && has->recursive) {
        rules->last_level = 1;
        differs = true;
    }
    if (HAS(FIRST_HIT)) rules->hit = GI_HIT_FIRST;
    if (HAS(LAST_HIT)) rules->hit = GI_HIT_LAST;
    return differs || rules->hit != GI_HIT_NEAREST;
}

static bool spoil_normals(GiShapes *shapes, const Contents *has, const GlintMistakes *mistakes) {
    unsigned faults = 0;
    if (HAS(NORMALS_INWARD)) faults |= GI_NORMAL_INWARD;
    if (HAS(NORMALS_FACING)) faults |= GI_NORMAL_FACING;
    if (HAS(NORMALS_LENGTH)) faults |= GI_NORMAL_LENGTH;
    if (HAS(NORMALS_FLAT) && has->smooth) faults |= GI_NORMAL_FLAT;
    if (HAS(NORMALS_MATRIX) && has->transformed) faults |= GI_NORMAL_MATRIX;
    shapes->normal_faults = faults;
    return faults != 0;
}

/* ---------------------------------------------------------------- lights and shaders */

/* Without light, but still in its place: numbers of lights and of samples stay. */
static bool darken(GiLight *light) {
    bool differs = !gi_vec_is_zero(light->intensity) || light->type == GLINT_LIGHT_CONSTANT ||
                   light->type == GLINT_LIGHT_NORMAL;
    if (is_placeless(light)) light->type = GLINT_LIGHT_AMBIENT;
    light->intensity = gi_vec(0, 0, 0);
    return differs;
}

static bool spoil_lights(GiScene *scene, const GiRules *rules, const GlintMistakes *mistakes) {
    bool differs = false;
    size_t missing = mistakes->light > 0 ? (size_t)mistakes->light - 1 : 0, last = SIZE_MAX;
    for (size_t i = 0; i < scene->lights.count; i++) {
        if (!is_placeless(&scene->lights.data[i])) last = i;
    }
    for (size_t i = 0; i < scene->lights.count; i++) {
        GiLight *light = &scene->lights.data[i];
        bool dark = is_placeless(light) ? HAS(NO_AMBIENT) : HAS(LAST_LIGHT) && i != last;
        if (dark || (HAS(LIGHT_MISSING) && i == missing)) differs |= darken(light);
        if (light->type != GLINT_LIGHT_POINT) continue;
        bool fell = falls(light, rules);
        if (HAS(NO_FALLOFF)) light->falloff = GLINT_FALLOFF_NONE;
        if (HAS(FALLOFF)) light->falloff = GLINT_FALLOFF_INVERSE_SQUARE;
        differs |= falls(light, rules) != fell;
    }
    return differs;
}

static bool spoil_shaders(GiScene *scene, const Contents *has, const GlintMistakes *mistakes) {
    if (!HAS(NO_SPECULAR) || !has->glossy) return false;
    for (size_t i = 0; i < scene->shaders.count; i++) {
        scene->shaders.data[i].specular = gi_vec(0, 0, 0);
    }
    return true;
}

static bool spoil_picture(GiScene *scene, const GlintMistakes *mistakes) {
    bool differs = false;
    if (HAS(NO_BACKGROUND) && scene->environment.face == 0) {
        differs |= !gi_vec_is_zero(scene->back_color);
        scene->back_color = gi_vec(0, 0, 0);
    }
    if (HAS(NO_EXPOSURE)) {
        differs |= scene->exposure > 0 && scene->exposure != 1;
        scene->exposure = 1;
    }
    if (HAS(NO_RECURSION)) scene->max_depth = 1;
    return differs;
}

/* ---------------------------------------------------------------- the whole */

/* Copies of the arrays that are changed, in the place of the scene's own. */
static bool own_arrays(GiScene *scene, const GiScene *right) {
    size_t shaders_size = right->shaders.count * sizeof *right->shaders.data;
    size_t lights_size = right->lights.count * sizeof *right->lights.data;
    scene->shaders.data = gi_memory_allocate(scene->memory, shaders_size);
    scene->lights.data = NULL;
    if (lights_size > 0) scene->lights.data = gi_memory_allocate(scene->memory, lights_size);
    if (scene->shaders.data == NULL || (lights_size > 0 && scene->lights.data == NULL)) {
        gi_memory_free(scene->memory, scene->shaders.data, shaders_size);
        gi_memory_free(scene->memory, scene->lights.data, lights_size);
        return false;
    }
    memcpy(scene->shaders.data, right->shaders.data, shaders_size);
    if (lights_size > 0) memcpy(scene->lights.data, right->lights.data, lights_size);
    return true;
}

bool gi_broken_init(GiBroken *broken, const GiWorld *world, const GiCamera *camera,
    const GlintMistakes *mistakes, const GiRenderArea *area) {
    broken->world = *world;
    broken->scene = *world->scene;
    broken->rules = *world->rules;
    if (!own_arrays(&broken->scene, world->scene)) return false;
    const Contents has = contents_of(world);
    GiWorld *own = &broken->world;
    own->scene = &broken->scene;
    own->rules = &broken->rules;
    own->trace = (GiTrace){&world->store.tree, &own->shapes};
    own->view = gi_view_spoiled(camera, mistakes, area->width, area->height);
    bool differs = memcmp(&own->view.eye, &world->view.eye, sizeof(GiView) - offsetof(GiView, eye));
    differs |= spoil_lights(&broken->scene, &broken->rules, mistakes);
    differs |= spoil_shading(&broken->rules, &has, mistakes);
    differs |= spoil_rays(&broken->rules, &has, mistakes);
    differs |= spoil_normals(&own->shapes, &has, mistakes);
    differs |= spoil_shaders(&broken->scene, &has, mistakes);
    differs |= spoil_picture(&broken->scene, mistakes);
    broken->differs = differs;
    return true;
}

void gi_broken_reset(GiBroken *broken) {
    GiScene *scene = &broken->scene;
    gi_memory_free(
        scene->memory, scene->shaders.data, scene->shaders.count * sizeof *scene->shaders.data);
    gi_memory_free(
        scene->memory, scene->lights.data, scene->lights.count * sizeof *scene->lights.data);
}
