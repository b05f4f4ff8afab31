/* SPDX-License-Identifier: MIT
 * The public functions that tell why: the explanation of pixels, and what shaders and lights of a
 * scene are. */
#include "glint/glint.h"

#include "base/assert.h"
#include "glint_scene.h"
#include "render/explain.h"

GlintStatus glint_explain(GlintScene *scene, const GlintRenderDesc *desc,
    const GlintExplainSink *sink, GlintError *error) {
    if (sink == NULL) return ARGUMENT(error, "sink is null");
    if (sink->only_sample < 0) return ARGUMENT(error, "only_sample is negative");
    GiRenderArea area;
    GiRenderTarget target;
    GiView view;
    GlintStatus status = gi_scene_plan_render(scene, desc, &area, &target, &view, error);
    if (status != GLINT_OK) return status;
    if (desc->mistakes.set != 0) {
        return ARGUMENT(error, "only pictures without mistakes are explained");
    }
    status = gi_explain(&scene->world, &area, desc->monitor, &target, sink);
    return status == GLINT_OK ? status
                              : gi_error_set(error, status, "%s", glint_status_text(status));
}

static void put(double to[3], GiVec v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

bool glint_scene_shader(const GlintScene *scene, GlintShaderId id, GlintShaderDesc *desc) {
    GI_ASSERT(scene != NULL && desc != NULL);
    if (id.index1 >= scene->model.shaders.count) return false;
    const GiShader *shader = &scene->model.shaders.data[id.index1];
    *desc = glint_shader_desc_default();
    desc->type = shader->type;
    put(desc->diffuse_color, shader->diffuse);
    put(desc->specular_color, shader->specular);
    put(desc->mirror_color, shader->mirror);
    desc->exponent = shader->exponent;
    desc->roughness = shader->roughness;
    desc->refractive_index = shader->index;
    if (shader->substrate != GI_NONE) desc->substrate.index1 = shader->substrate;
    if (shader->texture != GI_NONE) desc->texture.index1 = shader->texture + 1;
    return true;
}

bool glint_scene_light(const GlintScene *scene, uint32_t light_number, GlintLightDesc *desc) {
    GI_ASSERT(scene != NULL && desc != NULL);
    if (light_number == 0 || light_number > scene->model.lights.count) return false;
    const GiLight *light = &scene->model.lights.data[light_number - 1];
    *desc = glint_light_desc_default();
    desc->type = light->type;
    put(desc->position, light->position);
    put(desc->intensity, light->intensity);
    desc->falloff = light->falloff;
    put(desc->direction, light->direction);
    put(desc->up, light->up);
    desc->width = light->width;
    desc->height = light->height;
    return true;
}

bool glint_scene_background(const GlintScene *scene, double back_color[3]) {
    GI_ASSERT(scene != NULL && back_color != NULL);
    put(back_color, scene->model.back_color);
    return scene->model.environment.face != 0;
}
