/* SPDX-License-Identifier: MIT
 * A sample through the calls of the public header. */
#include "samples/sample.h"

#include <math.h>
#include <stdlib.h>
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

static GlintStatus add_mesh(
    const Sample *sample, GlintScene *scene, GlintMeshId *mesh, GlintError *error) {
    size_t vertex_count = (size_t)sample_vertex_count(sample);
    size_t triangle_count = (size_t)sample_triangle_count(sample);
    if (triangle_count == 0) return GLINT_OK;
    float *numbers = malloc(vertex_count * 6 * sizeof *numbers);
    uint32_t *corners = malloc(triangle_count * 3 * sizeof *corners);
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (numbers != NULL && corners != NULL) {
        float *normals = numbers + vertex_count * 3;
        for (size_t i = 0; i < vertex_count; i++) {
            double position[3], normal[3];
            sample_vertex(sample, i, position, normal);
            for (int k = 0; k < 3; k++) numbers[i * 3 + (size_t)k] = (float)position[k];
            for (int k = 0; k < 3; k++) normals[i * 3 + (size_t)k] = (float)normal[k];
        }
        for (size_t i = 0; i < triangle_count; i++) sample_triangle(sample, i, &corners[i * 3]);
        GlintMeshDesc desc = glint_mesh_desc_default();
        desc.positions = numbers;
        desc.normals = normals;
        desc.vertex_count = vertex_count;
        desc.triangles = corners;
        desc.triangle_count = triangle_count;
        status = glint_scene_add_mesh(scene, &desc, mesh, error);
    }
    free(numbers);
    free(corners);
    return status;
}

static GlintStatus add_copies(
    const Sample *sample, GlintScene *scene, GlintSurfaceId source, GlintError *error) {
    for (uint64_t i = 0; i < sample_copy_count(sample); i++) {
        GlintSurfaceDesc desc = glint_surface_desc_default(GLINT_SURFACE_GROUP);
        SampleGroup around = sample_copy(sample, i);
        group_transform(&around, desc.transform);
        desc.source = source;
        GlintStatus status = glint_scene_add_surface(scene, &desc, NULL, error);
        if (status != GLINT_OK) return status;
    }
    return GLINT_OK;
}

static GlintStatus add_surfaces(
    const Sample *sample, GlintScene *scene, const GlintShaderId *shaders, GlintError *error) {
    GlintSurfaceId group = {0};
    GlintMeshId mesh = {0};
    int64_t group_index = -1;
    uint64_t count = sample_surface_count(sample);
    GlintStatus status = add_mesh(sample, scene, &mesh, error);
    for (uint64_t i = 0; status == GLINT_OK && i < count; i++) {
        SampleSurface surface = sample_surface(sample, i);
        if (surface.group_index != group_index) {
            group_index = surface.group_index;
            GlintSurfaceDesc desc = glint_surface_desc_default(GLINT_SURFACE_GROUP);
            SampleGroup around = sample_group(sample, (uint64_t)group_index);
            group_transform(&around, desc.transform);
            status = glint_scene_add_surface(scene, &desc, &group, error);
            if (status != GLINT_OK) return status;
        }
        surface.desc.shader = shaders[surface.shader_index];
        surface.desc.parent = group;
        if (surface.desc.type == GLINT_SURFACE_MESH) surface.desc.mesh = mesh;
        status = glint_scene_add_surface(scene, &surface.desc, NULL, error);
    }
    return status == GLINT_OK ? add_copies(sample, scene, group, error) : status;
}

GlintStatus sample_build(const Sample *sample, GlintScene *scene, GlintError *error) {
    GlintImageDesc image = sample_image(sample);
    GlintCameraDesc camera = sample_camera(sample);
    GlintStatus status = glint_scene_set_image(scene, &image, error);
    if (status == GLINT_OK) status = glint_scene_set_camera(scene, &camera, error);
    for (int i = 0; status == GLINT_OK && i < sample_light_count(sample); i++) {
        GlintLightDesc light = sample_light(sample, i);
        status = glint_scene_add_light(scene, &light, error);
    }
    GlintShaderId shaders[SAMPLE_SHADER_LIMIT];
    for (int i = 0; status == GLINT_OK && i < sample_shader_count(sample); i++) {
        GlintShaderDesc shader = sample_shader(i);
        int substrate = sample_shader_substrate(i);
        if (substrate >= 0) shader.substrate = shaders[substrate];
        status = glint_scene_add_shader(scene, &shader, &shaders[i], error);
    }
    return status == GLINT_OK ? add_surfaces(sample, scene, shaders, error) : status;
}
