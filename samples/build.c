/* SPDX-License-Identifier: MIT
 * A sample through the calls of the public header. */
#include "samples/sample.h"

#include <math.h>
#include <string.h>

static void group_transform(const SampleGroup *group, double transform[3][4]) {
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        double angle = group->rotate[i] * 3.14159265358979323846 / 180;
        s[i] = sin(angle);
        c[i] = cos(angle);
    }
    const double rotation[3][3] = {
        {c[2] * c[1], c[2] * s[1] * s[0] - s[2] * c[0], c[2] * s[1] * c[0] + s[2] * s[0]},
        {s[2] * c[1], s[2] * s[1] * s[0] + c[2] * c[0], s[2] * s[1] * c[0] - c[2] * s[0]},
        {-s[1], c[1] * s[0], c[1] * c[0]},
    };
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            transform[row][column] = rotation[row][column] * group->scale[column];
        }
        transform[row][3] = group->translate[row];
    }
}

static GlintStatus add_surfaces(
    const Sample *sample, GlintScene *scene, const GlintShaderId *shaders, GlintError *error) {
    GlintSurfaceId group = {0};
    int64_t group_index = -1;
    uint64_t count = sample_surface_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        SampleSurface surface = sample_surface(sample, i);
        if (surface.group_index != group_index) {
            group_index = surface.group_index;
            GlintSurfaceDesc desc = glint_surface_desc_default(GLINT_SURFACE_GROUP);
            SampleGroup around = sample_group(sample, (uint64_t)group_index);
            group_transform(&around, desc.transform);
            GlintStatus status = glint_scene_add_surface(scene, &desc, &group, error);
            if (status != GLINT_OK) return status;
        }
        surface.desc.shader = shaders[surface.shader_index];
        surface.desc.parent = group;
        GlintStatus status = glint_scene_add_surface(scene, &surface.desc, NULL, error);
        if (status != GLINT_OK) return status;
    }
    return GLINT_OK;
}

GlintStatus sample_build(const Sample *sample, GlintScene *scene, GlintError *error) {
    GlintImageDesc image = glint_image_desc_default();
    image.width = sample->width;
    image.height = sample->height;
    GlintCameraDesc camera = sample_camera(sample);
    GlintStatus status = glint_scene_set_image(scene, &image, error);
    if (status == GLINT_OK) status = glint_scene_set_camera(scene, &camera, error);
    for (int i = 0; status == GLINT_OK && i < sample_light_count(sample); i++) {
        GlintLightDesc light = sample_light(sample, i);
        status = glint_scene_add_light(scene, &light, error);
    }
    GlintShaderId shaders[SAMPLE_SHADER_COUNT];
    for (int i = 0; status == GLINT_OK && i < SAMPLE_SHADER_COUNT; i++) {
        GlintShaderDesc shader = sample_shader(i);
        status = glint_scene_add_shader(scene, &shader, &shaders[i], error);
    }
    return status == GLINT_OK ? add_surfaces(sample, scene, shaders, error) : status;
}
