/* SPDX-License-Identifier: MIT
 * The library as a stranger sees it: glint.h and nothing else of ours. Names, arguments, scenes
 * built by calls, and the program in the documentation. */
#define _XOPEN_SOURCE 700 /* popen */
#include "test.h"

#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- names and defaults */

static void names(void) {
    CHECK_TEXT(glint_version_text(), "0.1.0");
    CHECK_TEXT(glint_status_text(GLINT_OK), "no error");
    CHECK_TEXT(glint_status_text(GLINT_ERROR_MEMORY), "not enough memory");
    CHECK(glint_status_text((GlintStatus)99) != NULL && glint_status_text((GlintStatus)-1) != NULL);
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        GlintDialect dialect = GLINT_DIALECT_COUNT;
        const char *name = glint_dialect_name((GlintDialect)i);
        CHECK(name != NULL && glint_dialect_from_name(name, &dialect) && (int)dialect == i);
    }
    CHECK(glint_dialect_name(GLINT_DIALECT_COUNT) == NULL);
    CHECK(glint_dialect_name((GlintDialect)-1) == NULL);
    GlintDialect dialect = GLINT_DIALECT_2018;
    CHECK(!glint_dialect_from_name("2014", &dialect) && !glint_dialect_from_name("", &dialect));
    CHECK(!glint_dialect_from_name("Glint", &dialect) && dialect == GLINT_DIALECT_2018);
    int count = 0;
    bool portable = false;
    while (glint_isa_name(count) != NULL) {
        portable = strcmp(glint_isa_name(count++), "portable") == 0;
    }
    CHECK(portable); /* it is the last one */
    CHECK(glint_isa_name(count + 1) == NULL && glint_isa_name(-1) == NULL);
    glint_scene_destroy(NULL);
}

static void defaults(void) {
    GlintImageDesc image = glint_image_desc_default();
    CHECK(image.width == 512 && image.height == 512 && image.samples == 1 && image.exposure == 1);
    GlintCameraDesc camera = glint_camera_desc_default();
    CHECK(camera.type == GLINT_CAMERA_PERSPECTIVE && camera.view_direction[2] == -1);
    CHECK(camera.view_up[1] == 1 && camera.projection_distance == 1 && camera.view_width == 1);
    GlintLightDesc light = glint_light_desc_default();
    CHECK(light.type == GLINT_LIGHT_POINT && light.intensity[2] == 1);
    CHECK(light.falloff == GLINT_FALLOFF_DIALECT);
    CHECK(light.direction[2] == -1 && light.up[1] == 1 && light.width == 1 && light.height == 1);
    GlintShaderDesc shader = glint_shader_desc_default();
    CHECK(shader.type == GLINT_SHADER_LAMBERTIAN && shader.specular_color[0] == 1);
    CHECK(shader.exponent == 1 && shader.roughness == 0.5 && shader.refractive_index == 1.5);
    CHECK(
        shader.texture.index1 == 0 && shader.substrate.index1 == 0 && shader.mirror_color[0] == 0);
    GlintSurfaceDesc surface = glint_surface_desc_default(GLINT_SURFACE_CONE);
    CHECK(surface.type == GLINT_SURFACE_CONE && surface.radius == 1 && surface.height == 1);
    CHECK(surface.normal[2] == 1 && surface.transform[1][1] == 1 && surface.transform[1][0] == 0);
    GlintRenderDesc render = glint_render_desc_default();
    CHECK(render.width == 0 && render.crop_width == 0 && render.monitor == NULL);
    GlintSaveDesc save = glint_save_desc_default();
    CHECK(save.title == NULL && save.thread_count == 0);
    GlintSceneDesc scene = glint_scene_desc_default();
    CHECK(scene.dialect == GLINT_DIALECT_AUTO && scene.isa == NULL && scene.memory_limit == 0);
}

/* A failed call says ARGUMENT and a sentence that holds the word. */
static void expect_argument(
    int line, GlintStatus status, const GlintError *error, const char *word) {
    if (status != GLINT_ERROR_ARGUMENT || error->status != GLINT_ERROR_ARGUMENT) {
        test_fail(__FILE__, line, "status %d for %s", status, word);
    } else if (strstr(error->message, word) == NULL) {
        test_fail(__FILE__, line, "\"%s\" does not name %s", error->message, word);
    }
}
#define EXPECT_ARGUMENT(call, word)                                                                \
    do {                                                                                           \
        GlintError error = {0};                                                                    \
        GlintStatus status_ = (call);                                                              \
        expect_argument(__LINE__, status_, &error, word);                                          \
    } while (0)

static void missing_defaults(void) {
    GlintScene *scene = new_scene(), *other = scene;
    float pixels[3] = {0};
    GlintImage picture = {1, 1, pixels};
    EXPECT_ARGUMENT(glint_scene_create(&(GlintSceneDesc){0}, &other, &error), "scene_desc_default");
    CHECK(other == NULL);
    EXPECT_ARGUMENT(
        glint_scene_set_image(scene, &(GlintImageDesc){.width = 1, .height = 1}, &error),
        "image_desc_default");
    EXPECT_ARGUMENT(
        glint_scene_set_camera(scene, &(GlintCameraDesc){0}, &error), "camera_desc_default");
    EXPECT_ARGUMENT(
        glint_scene_add_light(scene, &(GlintLightDesc){0}, &error), "light_desc_default");
    EXPECT_ARGUMENT(
        glint_scene_add_shader(scene, &(GlintShaderDesc){0}, NULL, &error), "shader_desc_default");
    EXPECT_ARGUMENT(glint_scene_add_surface(scene, &(GlintSurfaceDesc){0}, NULL, &error),
        "surface_desc_default");
    EXPECT_ARGUMENT(
        glint_scene_add_mesh(scene, &(GlintMeshDesc){0}, NULL, &error), "mesh_desc_default");
    EXPECT_ARGUMENT(glint_scene_add_texture(scene, &(GlintTextureDesc){0}, NULL, &error),
        "texture_desc_default");
    EXPECT_ARGUMENT(
        glint_render(scene, &(GlintRenderDesc){0}, pixels, &error), "render_desc_default");
    EXPECT_ARGUMENT(
        glint_image_save(&picture, "a.png", &(GlintSaveDesc){0}, &error), "save_desc_default");
    GlintSceneDesc desc = glint_scene_desc_default();
    CHECK_INT(glint_scene_create(NULL, &other, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_create(&desc, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_set_image(NULL, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_set_camera(scene, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_load_file(scene, NULL, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_load_memory(scene, NULL, 3, "x", NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_load_stream(scene, NULL, NULL, "x", NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_load_mesh(NULL, "a.obj", NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_load_mesh(scene, NULL, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(
        glint_scene_load_texture(scene, NULL, GLINT_WRAP_CLAMP, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_load_environment(scene, NULL, 1, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_commit(NULL, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render(scene, NULL, pixels, NULL), GLINT_ERROR_ARGUMENT);
    /* None of this has spoilt the scene. */
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_OK);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- arguments out of range */

/* Sets one member of a default desc and expects to be refused with the member's name. */
#define REFUSED(Type, make, member, value, call, word)                                             \
    do {                                                                                           \
        Type desc = make;                                                                          \
        desc.member = (value);                                                                     \
        EXPECT_ARGUMENT(call, word);                                                               \
    } while (0)
#define IMAGE(member, value, word)                                                                 \
    REFUSED(GlintImageDesc, glint_image_desc_default(), member, value,                             \
        glint_scene_set_image(scene, &desc, &error), word)
#define CAMERA(member, value, word)                                                                \
    REFUSED(GlintCameraDesc, glint_camera_desc_default(), member, value,                           \
        glint_scene_set_camera(scene, &desc, &error), word)
#define LIGHT(member, value, word)                                                                 \
    REFUSED(GlintLightDesc, glint_light_desc_default(), member, value,                             \
        glint_scene_add_light(scene, &desc, &error), word)
#define SHADER(member, value, word)                                                                \
    REFUSED(GlintShaderDesc, glint_shader_desc_default(), member, value,                           \
        glint_scene_add_shader(scene, &desc, NULL, &error), word)
#define SURFACE(type, member, value, word)                                                         \
    REFUSED(GlintSurfaceDesc, glint_surface_desc_default(GLINT_SURFACE_##type), member, value,     \
        glint_scene_add_surface(scene, &desc, NULL, &error), word)

#define MESH(member, value, word)                                                                  \
    REFUSED(GlintMeshDesc, triangle_desc(), member, value,                                         \
        glint_scene_add_mesh(scene, &desc, NULL, &error), word)
#define TEXTURE(member, value, word)                                                               \
    REFUSED(GlintTextureDesc, dot_desc(), member, value,                                           \
        glint_scene_add_texture(scene, &desc, NULL, &error), word)

static GlintMeshDesc triangle_desc(void) {
    static const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t triangles[3] = {0, 1, 2};
    GlintMeshDesc desc = glint_mesh_desc_default();
    desc.positions = positions;
    desc.vertex_count = 3;
    desc.triangles = triangles;
    desc.triangle_count = 1;
    return desc;
}

static GlintTextureDesc dot_desc(void) {
    static const uint8_t rgb[3] = {1, 2, 3};
    GlintTextureDesc desc = glint_texture_desc_default();
    desc.width = desc.height = 1;
    desc.rgb = rgb;
    return desc;
}

static void arguments(void) {
    GlintScene *scene = new_scene();
    IMAGE(width, 0, "width");
    IMAGE(height, -1, "height");
    IMAGE(samples, 0, "samples");
    IMAGE(back_color[1], NAN, "back_color");
    IMAGE(exposure, INFINITY, "exposure");
    IMAGE(integrator, (GlintIntegrator)4, "integrator");
    IMAGE(max_depth, 0, "max_depth");
    GlintImageDesc large = glint_image_desc_default();
    large.width = large.height = 1 << 15;
    CHECK_INT(glint_scene_set_image(scene, &large, NULL), GLINT_ERROR_ARGUMENT);
    CAMERA(type, (GlintCameraType)7, "type");
    CAMERA(view_point[0], NAN, "view_point");
    CAMERA(view_direction[2], 0, "view_direction");
    CAMERA(view_direction[1], INFINITY, "view_direction");
    CAMERA(view_up[1], 0, "view_up");
    CAMERA(projection_normal[0], NAN, "projection_normal");
    CAMERA(projection_normal[1], 4, "view_up");
    CAMERA(projection_distance, 0, "projection_distance");
    CAMERA(projection_distance, NAN, "projection_distance");
    CAMERA(view_width, -1, "view_width");
    CAMERA(view_height, INFINITY, "view_height");
    LIGHT(type, (GlintLightType)9, "type");
    LIGHT(position[0], NAN, "position");
    LIGHT(intensity[1], INFINITY, "intensity");
    LIGHT(falloff, (GlintFalloff)5, "falloff");
    LIGHT(direction[2], 0, "direction");
    LIGHT(direction[0], NAN, "direction");
    LIGHT(up[1], 0, "up");
    LIGHT(up[2], INFINITY, "up");
    LIGHT(width, 0, "width");
    LIGHT(height, -1, "height");
    GlintLightDesc area = glint_light_desc_default();
    area.type = GLINT_LIGHT_RECTANGLE;
    area.up[1] = 0, area.up[2] = 3;
    EXPECT_ARGUMENT(glint_scene_add_light(scene, &area, &error), "parallel");
    SHADER(type, (GlintShaderType)-1, "type");
    SHADER(diffuse_color[0], NAN, "diffuse_color");
    SHADER(specular_color[2], NAN, "specular_color");
    SHADER(exponent, INFINITY, "exponent");
    SHADER(mirror_color[1], NAN, "mirror_color");
    SHADER(roughness, 0, "roughness");
    SHADER(refractive_index, -1, "refractive_index");
    SHADER(substrate.index1, 1, "substrate");
    SHADER(texture.index1, 1, "texture");
    MESH(positions, NULL, "positions");
    MESH(triangles, NULL, "triangles");
    MESH(triangle_count, 0, "no triangles");
    MESH(vertex_count, 2, "vertex");
    TEXTURE(rgb, NULL, "rgb");
    TEXTURE(width, 0, "width");
    TEXTURE(height, -3, "height");
    TEXTURE(wrap, (GlintWrap)2, "wrap");
    TEXTURE(width, 1 << 29, "2^28");
    EXPECT_ARGUMENT(glint_scene_load_environment(scene, "a.pfm", NAN, &error), "scale");
    EXPECT_ARGUMENT(glint_scene_load_texture(scene, "a.png", (GlintWrap)7, NULL, &error), "wrap");
    SURFACE(SPHERE, type, (GlintSurfaceType)99, "type");
    SURFACE(SPHERE, radius, 0, "radius");
    SURFACE(SPHERE, center[1], NAN, "center");
    SURFACE(SPHERE, shader.index1, 1, "shader");
    SURFACE(SPHERE, parent.index1, 1, "parent");
    SURFACE(SPHERE, parent.index1, UINT32_MAX, "parent");
    SURFACE(BOX, point_a[0], INFINITY, "point_a");
    SURFACE(BOX, point_b[2], NAN, "point_b");
    SURFACE(CYLINDER, height, -1, "height");
    SURFACE(CYLINDER, radius, NAN, "radius");
    SURFACE(CONE, tip_z, 0, "apex");
    SURFACE(CONE, tip_z, NAN, "tip_z");
    SURFACE(PLANE, normal[2], 0, "normal");
    SURFACE(DISC, normal[0], NAN, "normal");
    SURFACE(MESH, mesh.index1, 0, "mesh");
    SURFACE(MESH, mesh.index1, 1, "mesh");
    SURFACE(GROUP, source.index1, 1, "source");
    SURFACE(GROUP, transform[1][1], 0, "transform");
    SURFACE(GROUP, transform[0][3], INFINITY, "transform");
    EXPECT_ARGUMENT(glint_scene_commit(scene, NULL, &error), "image");
    GlintImageDesc image = glint_image_desc_default();
    CHECK_INT(glint_scene_set_image(scene, &image, NULL), GLINT_OK);
    EXPECT_ARGUMENT(glint_scene_commit(scene, NULL, &error), "camera");
    /* Whatever was refused has left nothing behind. */
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    CHECK(info.surface_count == 0 && info.light_count == 0 && info.shader_count == 0);
    CHECK_INT(info.dialect, GLINT_DIALECT_AUTO);
    glint_scene_destroy(scene);
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = -1;
    EXPECT_ARGUMENT(glint_scene_create(&desc, &scene, &error), "thread_count");
    desc = glint_scene_desc_default();
    desc.isa = "8086";
    EXPECT_ARGUMENT(glint_scene_create(&desc, &scene, &error), "8086");
    desc = glint_scene_desc_default();
    desc.dialect = GLINT_DIALECT_COUNT;
    EXPECT_ARGUMENT(glint_scene_create(&desc, &scene, &error), "dialect");
}

static void crops_out_of_range(void) {
    static const int bad[][6] = {{0, 0, -1, 0, 0, 0}, {0, 0, 0, 66, 0, 0}, {0, 0, 70, 0, 0, 0},
        {0, 0, 0, 0, 71, 0}, {0, 0, 60, 0, 11, 1}, {0, 0, 0, 0, 0, -3}, {-5, 0, 0, 0, 0, 0},
        {0, -5, 0, 0, 0, 0}, {1 << 15, 1 << 15, 0, 0, 0, 0}, {0, 0, 1, 0, INT32_MAX, 1},
        {0, 0, 0, 1, 1, INT32_MAX}};
    GlintScene *scene = new_scene();
    static float pixels[3 * 70 * 66];
    GlintRenderDesc desc = glint_render_desc_default();
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_OK);
    EXPECT_ARGUMENT(glint_render(scene, &desc, pixels, &error), "committed");
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        desc.width = bad[i][0], desc.height = bad[i][1];
        desc.crop_x = bad[i][2], desc.crop_y = bad[i][3];
        desc.crop_width = bad[i][4], desc.crop_height = bad[i][5];
        CHECK_INT(glint_render(scene, &desc, pixels, NULL), GLINT_ERROR_ARGUMENT);
    }
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- building by calls */

static GlintScene *scene_by_calls(GlintSurfaceId ids[4]) {
    GlintScene *scene = new_scene();
    GlintImageDesc image = glint_image_desc_default();
    image.width = image.height = 40;
    CHECK_INT(glint_scene_set_image(scene, &image, NULL), GLINT_OK);
    GlintCameraDesc camera = glint_camera_desc_default();
    camera.view_point[2] = 9;
    CHECK_INT(glint_scene_set_camera(scene, &camera, NULL), GLINT_OK);
    GlintShaderDesc shader = glint_shader_desc_default();
    shader.type = GLINT_SHADER_RGB_NORMALS;
    GlintShaderId normals = {0};
    CHECK_INT(glint_scene_add_shader(scene, &shader, &normals, NULL), GLINT_OK);
    CHECK(normals.index1 != 0);
    GlintSurfaceDesc sphere = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    sphere.shader = normals;
    CHECK_INT(glint_scene_add_surface(scene, &sphere, &ids[0], NULL), GLINT_OK);
    GlintSurfaceDesc group = glint_surface_desc_default(GLINT_SURFACE_GROUP);
    group.transform[0][3] = 2;
    CHECK_INT(glint_scene_add_surface(scene, &group, &ids[1], NULL), GLINT_OK);
    GlintSurfaceDesc inner = group;
    inner.parent = ids[1];
    CHECK_INT(glint_scene_add_surface(scene, &inner, &ids[3], NULL), GLINT_OK);
    sphere.parent = ids[3]; /* at x = 4 */
    sphere.radius = 0.5;
    CHECK_INT(glint_scene_add_surface(scene, &sphere, &ids[2], NULL), GLINT_OK);
    GlintSurfaceDesc box = glint_surface_desc_default(GLINT_SURFACE_BOX);
    box.parent = ids[1];
    for (int i = 0; i < 3; i++) box.point_a[i] = 0.3, box.point_b[i] = -0.3;
    CHECK_INT(glint_scene_add_surface(scene, &box, &ids[3], NULL), GLINT_OK);
    return scene;
}

static void ids_and_groups(void) {
    GlintSurfaceId ids[4];
    GlintScene *scene = scene_by_calls(ids);
    GlintError error = {0};
    CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_ERROR_ARGUMENT);
    CHECK(strstr(error.message, "committed") != NULL);
    GlintSurfaceDesc late = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    CHECK_INT(glint_scene_add_surface(scene, &late, NULL, &error), GLINT_ERROR_ARGUMENT);
    CHECK(strstr(error.message, "committed") != NULL);
    CHECK_INT(load_text(scene, small_scene, &error), GLINT_ERROR_ARGUMENT);
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    CHECK_INT(info.dialect, GLINT_DIALECT_GLINT);
    CHECK(info.surface_count == 3 && info.shader_count == 1 && info.light_count == 0);
    CHECK(info.width == 40 && info.height == 40 && info.samples == 1);
    const struct {
        double x;
        uint32_t surface, shader;
    } places[] = {{0, ids[0].index1, 1}, {4, ids[2].index1, 1}, {2, ids[3].index1, 0}};
    CHECK(ids[0].index1 == 1 && ids[2].index1 == 2 && ids[3].index1 == 3);
    for (int i = 0; i < 3; i++) {
        GlintRay ray = {{places[i].x, 0, 9}, {0, 0, -2}, 0, INFINITY};
        GlintHit hit = {0};
        CHECK(glint_trace(scene, &ray, &hit) && glint_occluded(scene, &ray));
        CHECK_INT(hit.surface.index1, places[i].surface);
        CHECK_INT(hit.shader.index1, places[i].shader);
        CHECK_NEAR(hit.point[2], 9 - 2 * hit.t, 1e-14);
        CHECK_NEAR(hit.normal[2], 1, 1e-14);
        /* The interval is open, and a miss leaves the hit alone. */
        ray.t_max = hit.t;
        GlintHit same = hit;
        CHECK(!glint_trace(scene, &ray, &same) && !glint_occluded(scene, &ray));
        CHECK(memcmp(&same, &hit, sizeof hit) == 0);
        ray.t_min = hit.t, ray.t_max = INFINITY;
        CHECK(
            glint_trace(scene, &ray, &same) && same.t > hit.t && same.normal[2] == -hit.normal[2]);
    }
    glint_scene_destroy(scene);
}

static GlintSurfaceId add_group(
    GlintScene *scene, GlintSurfaceId parent, GlintSurfaceId source, double x) {
    GlintSurfaceDesc group = glint_surface_desc_default(GLINT_SURFACE_GROUP);
    group.parent = parent;
    group.source = source;
    group.transform[0][3] = x;
    GlintSurfaceId id = {0};
    CHECK_INT(glint_scene_add_surface(scene, &group, &id, NULL), GLINT_OK);
    return id;
}

static const GlintSurfaceId nowhere = {0};

/* A row of pairs of spheres: one sphere, two groups of it, three of these. */
static void groups_again(void) {
    GlintScene *scene = new_scene();
    GlintImageDesc image = glint_image_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    CHECK_INT(glint_scene_set_image(scene, &image, NULL), GLINT_OK);
    CHECK_INT(glint_scene_set_camera(scene, &camera, NULL), GLINT_OK);
    GlintSurfaceId pair = add_group(scene, nowhere, nowhere, 0);
    GlintSurfaceId single = add_group(scene, pair, nowhere, 0);
    GlintSurfaceId other = add_group(scene, pair, single, 3);
    for (int i = 1; i < 3; i++) add_group(scene, nowhere, pair, 10.0 * i);
    /* What is added later belongs to all. */
    GlintSurfaceDesc sphere = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    sphere.parent = single;
    CHECK_INT(glint_scene_add_surface(scene, &sphere, NULL, NULL), GLINT_OK);
    GlintSurfaceDesc cycle = glint_surface_desc_default(GLINT_SURFACE_GROUP);
    cycle.source = pair;
    cycle.parent = pair;
    EXPECT_ARGUMENT(glint_scene_add_surface(scene, &cycle, NULL, &error), "contain itself");
    cycle.parent = other;
    EXPECT_ARGUMENT(glint_scene_add_surface(scene, &cycle, NULL, &error), "contain itself");
    cycle.parent = single;
    EXPECT_ARGUMENT(glint_scene_add_surface(scene, &cycle, NULL, &error), "contain itself");
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    CHECK_INT(info.surface_count, 6);
    for (int i = 0; i < 6; i++) {
        GlintRay ray = {{10 * (i / 2) + 3 * (i % 2), 0, 9}, {0, 0, -1}, 0, INFINITY};
        GlintHit hit = {0};
        CHECK(glint_trace(scene, &ray, &hit) && hit.surface.index1 == 1);
        CHECK_NEAR(hit.t, 8, 1e-14);
    }
    glint_scene_destroy(scene);
}

/* Each thing that can be added, and what stands on it. */
static void everything_by_calls(void) {
    GlintScene *scene = new_scene();
    GlintTextureDesc dot = dot_desc();
    GlintTextureId texture = {0};
    CHECK_INT(glint_scene_add_texture(scene, &dot, &texture, NULL), GLINT_OK);
    GlintShaderId below = {0};
    for (int type = 0; type <= GLINT_SHADER_COOK_TORRANCE; type++) {
        GlintShaderDesc shader = glint_shader_desc_default();
        shader.type = (GlintShaderType)type;
        shader.texture = texture;
        shader.substrate = below;
        CHECK_INT(glint_scene_add_shader(scene, &shader, &below, NULL), GLINT_OK);
    }
    GlintShaderDesc glaze = glint_shader_desc_default();
    glaze.type = GLINT_SHADER_GLAZED;
    for (int i = 0; i < 8; i++) {
        glaze.substrate = below;
        CHECK_INT(glint_scene_add_shader(scene, &glaze, &below, NULL), GLINT_OK);
    }
    glaze.substrate = below;
    EXPECT_ARGUMENT(glint_scene_add_shader(scene, &glaze, NULL, &error), "8 deep");
    for (int type = 0; type <= GLINT_LIGHT_RECTANGLE; type++) {
        GlintLightDesc light = glint_light_desc_default();
        light.type = (GlintLightType)type;
        CHECK_INT(glint_scene_add_light(scene, &light, NULL), GLINT_OK);
    }
    GlintMeshDesc triangle = triangle_desc();
    GlintMeshId mesh = {0};
    CHECK_INT(glint_scene_add_mesh(scene, &triangle, &mesh, NULL), GLINT_OK);
    GlintSurfaceDesc surface = glint_surface_desc_default(GLINT_SURFACE_MESH);
    surface.mesh = mesh;
    GlintSurfaceId id = {0};
    for (uint32_t i = 1; i <= 2; i++) {
        CHECK_INT(glint_scene_add_surface(scene, &surface, &id, NULL), GLINT_OK);
        CHECK_INT(id.index1, i);
    }
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_ERROR_ARGUMENT); /* not empty */
    glint_scene_destroy(scene);
}

static void write_text(char path[500], const char *name, const char *text) {
    snprintf(path, 500, "%s/%s", test_scratch_dir(), name);
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL && fputs(text, file) >= 0 && fclose(file) == 0);
}

static void files_by_calls(void) {
    GlintScene *scene = new_scene();
    GlintError error = {0};
    GlintMeshId mesh = {0};
    char path[500];
    write_text(path, "api.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK_INT(glint_scene_load_mesh(scene, path, &mesh, &error), GLINT_OK);
    CHECK_INT(mesh.index1, 1);
    write_text(path, "broken.obj", "v 0 0 0\nf 1 2 3\n");
    CHECK_INT(glint_scene_load_mesh(scene, path, &mesh, &error), GLINT_ERROR_SCENE);
    CHECK_TEXT(error.path, path);
    CHECK_INT(error.line, 2);
    CHECK_INT(
        glint_scene_load_texture(scene, path, GLINT_WRAP_CLAMP, NULL, &error), GLINT_ERROR_FILE);
    CHECK_INT(glint_scene_load_environment(scene, path, 1, &error), GLINT_ERROR_FILE);
    CHECK_INT(glint_scene_load_mesh(scene, "/nowhere/a.obj", NULL, &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.path, "/nowhere/a.obj");
    /* None of this has spoilt the scene. */
    GlintSurfaceDesc surface = glint_surface_desc_default(GLINT_SURFACE_MESH);
    surface.mesh.index1 = 1;
    CHECK_INT(glint_scene_add_surface(scene, &surface, NULL, NULL), GLINT_OK);
    glint_scene_destroy(scene);
}

/* Of two calls nothing of the first remains; an exposure that is not positive counts as 1. */
static void last_image_counts(void) {
    GlintScene *scene = new_scene();
    GlintImageDesc image = glint_image_desc_default();
    image.width = image.height = 3;
    image.back_color[0] = 0.25;
    image.exposure = 4;
    CHECK_INT(glint_scene_set_image(scene, &image, NULL), GLINT_OK);
    image.height = 1;
    image.exposure = -1;
    CHECK_INT(glint_scene_set_image(scene, &image, NULL), GLINT_OK);
    GlintCameraDesc camera = glint_camera_desc_default();
    CHECK_INT(glint_scene_set_camera(scene, &camera, NULL), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    Picture picture = picture_of_scene(scene, NULL);
    CHECK(picture.width == 3 && picture.height == 1);
    CHECK_COLOR("background", picture_at(&picture, 0, 0), 0.25, 0, 0);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* The traced normal at every pixel is the colour of the picture. */
static void trace_agrees_with_picture(void) {
    GlintSurfaceId ids[4];
    GlintScene *scene = scene_by_calls(ids);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = 130, desc.height = 90;
    Picture picture = picture_of_scene(scene, &desc);
    int hits = 0;
    for (int i = 0; i < 130 * 90 && picture.pixels != NULL; i++) {
        int x = i % 130, y = i / 130;
        GlintRay ray = {{0, 0, 9}, {(x + 0.5) / 130 - 0.5, 0.5 - (y + 0.5) / 90, -1}, 0, INFINITY};
        GlintHit hit;
        GiVec color = picture_at(&picture, x, y), expected = {0, 0, 0};
        bool any = glint_trace(scene, &ray, &hit);
        CHECK(any == glint_occluded(scene, &ray));
        if (any && hit.shader.index1 == 1) {
            hits++;
            expected = gi_scale(gi_add(gi_vec_from(hit.normal), gi_vec(1, 1, 1)), 0.5);
        }
        double off = gi_length(gi_sub(color, expected));
        if (!(off < 1e-6)) test_fail(__FILE__, __LINE__, "pixel %d %d is off by %g", x, y, off);
    }
    CHECK(hits > 100);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- the program in the docs */

static int shell(const char *format, const char *a, const char *b, const char *c) {
    char command[9000];
    snprintf(command, sizeof command, format, a, b, c);
    return system(command);
}

static void example(void) {
    const char *to = test_scratch_dir();
    char line[200] = "", command[9000];
    snprintf(command, sizeof command, "cd %s && '%s'", to, GI_TEST_EXAMPLE);
    FILE *said = popen(command, "r");
    CHECK(said != NULL);
    if (said == NULL) return;
    CHECK(fgets(line, sizeof line, said) != NULL);
    CHECK_INT(pclose(said), 0);
    CHECK_TEXT(line, "surface 1 at t = 5, normal 0 0 1\n");
    CHECK_INT(shell("test -s %s/example.png%s%s", to, "", ""), 0);
}

static void example_as_cpp(void) {
    if (shell("%s%s%s >/dev/null 2>&1", "${CXX:-g++}", " --version", "") != 0) {
        test_skip("there is no C++ compiler");
        return;
    }
    const char *from = test_source_dir();
    CHECK_INT(shell("${CXX:-g++} -x c++ -std=c++11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only "
                    "-I'%s/include' '%s/docs/example.c'%s",
                  from, from, ""),
        0);
}

const GiTest tests_api[] = {TEST(names), TEST(defaults), TEST(missing_defaults), TEST(arguments),
    TEST(crops_out_of_range), TEST(ids_and_groups), TEST(groups_again), TEST(everything_by_calls),
    TEST(files_by_calls), TEST(last_image_counts), TEST(trace_agrees_with_picture), TEST(example),
    TEST(example_as_cpp), TEST_END};
