/* SPDX-License-Identifier: MIT
 * The library as a stranger sees it: glint.h and nothing else of ours. */
#define _XOPEN_SOURCE 700 /* realpath, popen */
#include "test.h"

#include "random.h"
#include "scenes.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const small_scene =
    "<scene dialect='glint'><camera><viewPoint>0 0 6</viewPoint></camera><image>70 66</image>\n"
    "<light><position>3 4 5</position></light><light type='AmbientLight'/>\n"
    "<shader name='s' type='Phong'><exponent>5</exponent></shader>\n"
    "<surface type='Sphere'><shader ref='s'/></surface>\n"
    "<surface type='Group'><translate>1 1 0</translate><rotate>1 2 3</rotate>\n"
    "<surface type='Box'><maxPt>1 1 1</maxPt></surface>\n"
    "<surface type='Cone'><tipz>1</tipz></surface></surface></scene>\n";

static GlintScene *new_scene(void) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = 2;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    return scene;
}

static GlintStatus load_text(GlintScene *scene, const char *xml, GlintError *error) {
    return glint_scene_load_memory(scene, xml, strlen(xml), "x.xml", NULL, error);
}

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
    GlintShaderDesc shader = glint_shader_desc_default();
    CHECK(shader.type == GLINT_SHADER_LAMBERTIAN && shader.specular_color[0] == 1);
    CHECK(shader.exponent == 1);
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

static void arguments(void) {
    GlintScene *scene = new_scene();
    IMAGE(width, 0, "width");
    IMAGE(height, -1, "height");
    IMAGE(samples, 0, "samples");
    IMAGE(back_color[1], NAN, "back_color");
    IMAGE(exposure, INFINITY, "exposure");
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
    SHADER(type, (GlintShaderType)-1, "type");
    SHADER(diffuse_color[0], NAN, "diffuse_color");
    SHADER(specular_color[2], NAN, "specular_color");
    SHADER(exponent, INFINITY, "exponent");
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

/* ---------------------------------------------------------------- loading */

typedef struct Stream {
    const char *text;
    size_t at, size, step, fail_at;
} Stream;

static int64_t read_stream(void *user, void *buffer, size_t size) {
    Stream *stream = user;
    if (stream->at >= stream->fail_at) return -1;
    size_t left = stream->size - stream->at;
    if (size > left) size = left;
    if (stream->step > 0 && size > stream->step) size = stream->step;
    memcpy(buffer, stream->text + stream->at, size);
    stream->at += size;
    return (int64_t)size;
}

static void load_three_ways(void) {
    Picture expected = picture_of_text(small_scene);
    char path[500];
    snprintf(path, sizeof path, "%s/small.xml", test_scratch_dir());
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL && fputs(small_scene, file) >= 0 && fclose(file) == 0);
    for (int way = 0; way < 4; way++) {
        GlintScene *scene = new_scene();
        GlintError error = {0};
        GlintStatus status;
        Stream stream = {small_scene, 0, strlen(small_scene), way == 2 ? 1 : 0, SIZE_MAX};
        if (way == 0) {
            status = glint_scene_load_file(scene, path, NULL, &error);
        } else if (way == 1) {
            status = load_text(scene, small_scene, &error);
        } else {
            status = glint_scene_load_stream(scene, read_stream, &stream, "s", NULL, &error);
        }
        CHECK_INT(status, GLINT_OK);
        CHECK_INT(load_text(scene, small_scene, &error), GLINT_ERROR_ARGUMENT); /* not empty */
        CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
        GlintStats stats;
        glint_scene_stats(scene, &stats);
        CHECK_INT(stats.read_bytes, strlen(small_scene));
        Picture picture = picture_of_scene(scene, NULL);
        CHECK(picture_equal(&picture, &expected));
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
    picture_free(&expected);
}

typedef struct Findings {
    int errors;
    int64_t line, column;
    char text[1000];
} Findings;

static void keep_finding(void *user, const GlintDiagnostic *diagnostic) {
    Findings *findings = user;
    if (diagnostic->severity != GLINT_SEVERITY_ERROR) return;
    if (findings->errors++ > 0) return;
    findings->line = diagnostic->line;
    findings->column = diagnostic->column;
    size_t length = glint_diagnostic_format(diagnostic, findings->text, sizeof findings->text);
    CHECK_INT(length, strlen(findings->text));
    char cut[20];
    CHECK_INT(glint_diagnostic_format(diagnostic, cut, sizeof cut), length);
    CHECK(strlen(cut) == 19 && strncmp(cut, findings->text, 19) == 0);
    CHECK_INT(glint_diagnostic_format(diagnostic, NULL, 0), length);
}

static void errors_as_data(void) {
    const char *text =
        "<scene>\n<camera/>\n  <image>0 5</image>\n<surface type='Spere'/>\n</scene>\n";
    Findings findings = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.diagnostic = keep_finding;
    desc.diagnostic_user = &findings;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    GlintError error = {0};
    CHECK_INT(load_text(scene, text, &error), GLINT_ERROR_SCENE);
    CHECK_INT(error.status, GLINT_ERROR_SCENE);
    CHECK_INT(error.line, 3);
    CHECK_TEXT(error.path, "x.xml");
    CHECK_INT(findings.errors, 2); /* all of them */
    CHECK(findings.line == error.line && findings.column == error.column && error.column > 0);
    CHECK(strncmp(findings.text, "x.xml:3:", 8) == 0 && strstr(findings.text, ": error: ") != NULL);
    CHECK(strstr(findings.text, error.message) != NULL && strchr(findings.text, '^') != NULL);
    /* Such a scene can only be destroyed. */
    GlintSurfaceDesc sphere = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    CHECK_INT(glint_scene_add_surface(scene, &sphere, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_ERROR_ARGUMENT);
    glint_scene_destroy(scene);
    scene = new_scene();
    CHECK_INT(glint_scene_load_file(scene, "/nowhere/a.xml", NULL, &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.path, "/nowhere/a.xml");
    glint_scene_destroy(scene);
    scene = new_scene();
    Stream broken = {small_scene, 0, strlen(small_scene), 10, 50};
    CHECK_INT(
        glint_scene_load_stream(scene, read_stream, &broken, "s", NULL, &error), GLINT_ERROR_FILE);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- progress and cancel */

/* A scene of many surfaces, so that every phase lasts. */
static char *large_text(int count) {
    char *text = malloc((size_t)count * 120 + 500), *to = text;
    if (text == NULL) return NULL;
    to += sprintf(to, "<scene dialect='glint'><camera><viewPoint>0 0 9</viewPoint></camera>"
                      "<image>200 200</image><light><position>5 6 7</position></light>\n");
    Random random = {8};
    for (int i = 0; i < count; i++) {
        GiVec p = random_vec(&random, -4, 4);
        to += sprintf(to,
            "<surface type='Sphere'><center>%.3f %.3f %.3f</center><radius>.05</radius>"
            "</surface>\n",
            p.x, p.y, p.z);
    }
    sprintf(to, "</scene>");
    return text;
}

typedef struct Watch {
    pthread_t owner;
    int phases[4]; /* calls of progress */
    double last[4];
    int asked, cancel_at; /* cancel_at 0: never */
    bool wrong;
} Watch;

static void watch_progress(void *user, GlintPhase phase, double fraction) {
    Watch *watch = user;
    if (!pthread_equal(watch->owner, pthread_self()) || (unsigned)phase > GLINT_PHASE_WRITE) {
        watch->wrong = true;
        return;
    }
    if (!(fraction >= watch->last[phase] && fraction <= 1)) watch->wrong = true;
    watch->phases[phase]++;
    watch->last[phase] = fraction;
}

static bool watch_cancelled(void *user) {
    Watch *watch = user;
    if (!pthread_equal(watch->owner, pthread_self())) watch->wrong = true;
    return ++watch->asked == watch->cancel_at;
}

static bool take_bytes(void *user, const void *bytes, size_t size) {
    (void)bytes;
    *(size_t *)user += size;
    return true;
}

/* The whole life; of the phases only `cancel` is ever told to stop, at its first question. */
static void watch_life(const char *text, bool stream, int cancel) {
    static float pixels[200 * 200 * 3];
    GlintMonitor monitors[4];
    Watch watches[4];
    for (int i = 0; i < 4; i++) {
        watches[i] = (Watch){.owner = pthread_self(), .last = {-1, -1, -1, -1}};
        watches[i].cancel_at = i == cancel ? 1 : 0;
        monitors[i] = (GlintMonitor){watch_progress, watch_cancelled, &watches[i]};
    }
    GlintScene *scene = new_scene();
    GlintError error = {0};
    Stream source = {text, 0, strlen(text), 0, SIZE_MAX};
    GlintStatus status =
        stream ? glint_scene_load_stream(scene, read_stream, &source, "s", &monitors[0], &error)
               : glint_scene_load_memory(scene, text, strlen(text), "m", &monitors[0], &error);
    int phase = 0;
    if (status == GLINT_OK) phase = 1, status = glint_scene_commit(scene, &monitors[1], &error);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.monitor = &monitors[2];
    if (status == GLINT_OK) phase = 2, status = glint_render(scene, &desc, pixels, &error);
    GlintSaveDesc save = glint_save_desc_default();
    save.monitor = &monitors[3];
    GlintImage image = {200, 200, pixels};
    size_t size = 0;
    if (status == GLINT_OK) {
        phase = 3;
        status = glint_image_encode_png(&image, &save, take_bytes, &size, &error);
    }
    CHECK_INT(status, cancel >= 0 ? GLINT_CANCELLED : GLINT_OK);
    CHECK_INT(phase, cancel >= 0 ? cancel : 3);
    if (status == GLINT_CANCELLED) CHECK_INT(error.status, GLINT_CANCELLED);
    for (int i = 0; i <= phase; i++) {
        CHECK(!watches[i].wrong && watches[i].asked > 0);
        if (i == cancel) continue;
        for (int k = 0; k < 4; k++) CHECK((watches[i].phases[k] > 0) == (i == k));
        if (i > 0 || !stream) CHECK(watches[i].last[i] > 0.5);
        if (i == 0 && stream) CHECK(watches[i].last[0] < 0);
    }
    /* What was cancelled while it was drawn can be drawn again. */
    if (cancel == 2) {
        desc.monitor = NULL;
        CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_OK);
    }
    glint_scene_destroy(scene);
}

static void progress_and_cancel(void) {
    char *text = large_text(30000);
    CHECK(text != NULL);
    for (int cancel = -1; text != NULL && cancel < 4; cancel++) {
        watch_life(text, false, cancel);
        watch_life(text, true, cancel);
    }
    free(text);
}

static void statistics(void) {
    GlintScene *scene = new_scene();
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    CHECK(info.surface_count == 3 && info.light_count == 2 && info.shader_count == 1);
    Picture picture = picture_of_scene(scene, NULL);
    GlintStats stats;
    glint_scene_stats(scene, &stats);
    CHECK_INT(stats.camera_rays, 70 * 66);
    int lit = 0;
    for (int i = 0; i < 70 * 66; i++) lit += picture_at(&picture, i % 70, i / 70).x > 0;
    CHECK(stats.shadow_rays > 0 && stats.shadow_rays <= (uint64_t)lit);
    CHECK_INT(stats.primitive_count, 3);
    CHECK(stats.leaf_count >= 1 && stats.tree_bytes >= 3 * 6 * sizeof(float));
    CHECK(isfinite(stats.sah_cost) && stats.sah_cost > 0);
    CHECK(stats.memory_peak > stats.tree_bytes && stats.memory_peak < 1u << 28);
    CHECK_INT(stats.thread_count, 2);
    CHECK_TEXT(stats.isa, glint_isa_name(0));
    CHECK(stats.read_seconds >= 0 && stats.build_seconds >= 0 && stats.trace_seconds > 0);
    CHECK_INT(stats.read_bytes, strlen(small_scene));
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- memory */

/* Refuses the requests from number `fail_at` on, or only that one; knows every block's size. */
typedef struct Ledger {
    _Atomic long requests, live, wrong;
    long fail_at; /* from 1; 0: never */
    bool fail_on; /* all further ones too */
} Ledger;

enum { HEAD = 32 };

static void *ledger_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    Ledger *ledger = user;
    char *block = pointer != NULL ? (char *)pointer - HEAD : NULL;
    size_t known = 0;
    if (block != NULL) memcpy(&known, block, sizeof known);
    if (known != old_size) atomic_fetch_add(&ledger->wrong, 1);
    if (new_size == 0) {
        if (block != NULL) atomic_fetch_sub(&ledger->live, 1);
        free(block);
        return NULL;
    }
    long number = atomic_fetch_add(&ledger->requests, 1) + 1;
    if (ledger->fail_at > 0 && number >= ledger->fail_at &&
        (ledger->fail_on || number == ledger->fail_at)) {
        return NULL;
    }
    char *grown = realloc(block, new_size + HEAD);
    if (grown == NULL) return NULL;
    if (block == NULL) atomic_fetch_add(&ledger->live, 1);
    memcpy(grown, &new_size, sizeof new_size);
    return grown + HEAD;
}

static GlintStatus live(const char *text, const GlintSceneDesc *desc, uint64_t *peak) {
    static float pixels[200 * 200 * 3];
    GlintScene *scene = NULL;
    GlintError error = {0};
    GlintStatus status = glint_scene_create(desc, &scene, &error);
    if (status == GLINT_OK) status = load_text(scene, text, &error);
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, &error);
    GlintRenderDesc render = glint_render_desc_default();
    if (status == GLINT_OK) status = glint_render(scene, &render, pixels, &error);
    CHECK_INT(error.status, status);
    if (status != GLINT_OK) CHECK(error.message[0] != '\0');
    if (scene != NULL && peak != NULL) {
        GlintStats stats;
        glint_scene_stats(scene, &stats);
        *peak = stats.memory_peak;
    }
    glint_scene_destroy(scene);
    return status;
}

/* Every request in turn is refused: the whole life ends with MEMORY or gets along without. */
static void fail_every_request(const char *text, const char *what) {
    for (int fail_on = 0; fail_on < 2; fail_on++) {
        long failed = 0;
        for (long n = 1;; n++) {
            Ledger ledger = {.fail_at = n, .fail_on = fail_on};
            GlintAllocator allocator = {ledger_reallocate, &ledger};
            GlintSceneDesc desc = glint_scene_desc_default();
            desc.allocator = &allocator;
            desc.thread_count = 3;
            GlintStatus status = live(text, &desc, NULL);
            bool reached = atomic_load(&ledger.requests) >= n;
            bool good =
                reached ? status == GLINT_OK || status == GLINT_ERROR_MEMORY : status == GLINT_OK;
            if (!good || atomic_load(&ledger.live) != 0 || atomic_load(&ledger.wrong) != 0) {
                test_fail(__FILE__, __LINE__,
                    "%s, request %ld: status %d, %ld blocks live, %ld sizes "
                    "wrong",
                    what, n, status, atomic_load(&ledger.live), atomic_load(&ledger.wrong));
            }
            failed += status == GLINT_ERROR_MEMORY;
            if (!reached || n > 3000) break;
        }
        CHECK(failed > 10);
    }
}

static void failing_allocator(void) {
    fail_every_request(small_scene, "small scene");
    char *text = large_text(3000);
    CHECK(text != NULL);
    if (text != NULL) fail_every_request(text, "large scene");
    free(text);
}

static void *build_by_calls(void *user) {
    GlintAllocator allocator = {ledger_reallocate, user};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.allocator = &allocator;
    desc.thread_count = 1;
    GlintScene *scene = NULL;
    GlintStatus status = glint_scene_create(&desc, &scene, NULL);
    GlintSurfaceId group = {0};
    for (int i = 0; i < 40 && status == GLINT_OK; i++) {
        GlintSurfaceDesc surface =
            glint_surface_desc_default((GlintSurfaceType)(i % (GLINT_SURFACE_GROUP + 1)));
        surface.tip_z = 3;
        surface.parent = group;
        GlintSurfaceId id;
        status = glint_scene_add_surface(scene, &surface, &id, NULL);
        if (status == GLINT_OK && surface.type == GLINT_SURFACE_GROUP) group = id;
        GlintShaderDesc shader = glint_shader_desc_default();
        if (status == GLINT_OK) status = glint_scene_add_shader(scene, &shader, NULL, NULL);
        GlintLightDesc light = glint_light_desc_default();
        if (status == GLINT_OK) status = glint_scene_add_light(scene, &light, NULL);
    }
    GlintImageDesc image = glint_image_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    if (status == GLINT_OK) status = glint_scene_set_image(scene, &image, NULL);
    if (status == GLINT_OK) status = glint_scene_set_camera(scene, &camera, NULL);
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, NULL);
    CHECK(status == GLINT_OK || status == GLINT_ERROR_MEMORY);
    glint_scene_destroy(scene);
    return NULL;
}

static void failing_allocator_by_calls(void) {
    for (long n = 0; n < 1000; n++) {
        Ledger ledger = {.fail_at = n};
        build_by_calls(&ledger);
        CHECK_INT(atomic_load(&ledger.live), 0);
        CHECK_INT(atomic_load(&ledger.wrong), 0);
        if (n > 0 && atomic_load(&ledger.requests) < n) return;
    }
    test_fail(__FILE__, __LINE__, "there is no end of requests");
}

static void memory_limits(void) {
    char *text = large_text(3000);
    CHECK(text != NULL);
    int refused = 0;
    GlintStatus status = GLINT_ERROR_MEMORY;
    for (size_t limit = 100; text != NULL && limit < 1u << 30; limit += limit / 6) {
        GlintSceneDesc desc = glint_scene_desc_default();
        desc.thread_count = 2;
        desc.memory_limit = limit;
        uint64_t peak = 0;
        status = live(text, &desc, &peak);
        CHECK(status == GLINT_OK || status == GLINT_ERROR_MEMORY);
        CHECK(peak <= limit);
        if (status == GLINT_OK) break;
        refused++;
    }
    CHECK_INT(status, GLINT_OK);
    CHECK(refused > 20);
    free(text);
}

/* ---------------------------------------------------------------- threads */

typedef struct Work {
    const char *text;
    Picture expected;
    const GlintScene *shared;
    int wrong;
} Work;

static void *draw_alone(void *user) {
    Work *work = user;
    for (int i = 0; i < 6; i++) {
        GlintScene *scene = scene_from_text(work->text, NULL, 2);
        Picture picture = picture_of_scene(scene, NULL);
        work->wrong += !picture_equal(&picture, &work->expected);
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
    return NULL;
}

static void two_scenes_at_once(void) {
    char *large = large_text(500);
    Work work[2] = {{.text = small_scene}, {.text = large}};
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) work[i].expected = picture_of_text(work[i].text);
    for (int i = 0; i < 2; i++) CHECK(pthread_create(&threads[i], NULL, draw_alone, &work[i]) == 0);
    for (int i = 0; i < 2; i++) {
        pthread_join(threads[i], NULL);
        CHECK_INT(work[i].wrong, 0);
        picture_free(&work[i].expected);
    }
    free(large);
}

/* A number that depends on every hit. */
static uint64_t trace_all(const GlintScene *scene) {
    Random random = {77};
    uint64_t hash = 0;
    for (int i = 0; i < 4000; i++) {
        GiVec p = random_vec(&random, -6, 6), d = random_vec(&random, -1, 1);
        GlintRay ray = {{p.x, p.y, p.z}, {d.x, d.y, d.z}, 0, INFINITY};
        GlintHit hit = {0};
        bool any = glint_trace(scene, &ray, &hit);
        hash = hash * 31 + hash_bytes(&hit.t, sizeof hit.t) +
               hash_bytes(hit.normal, sizeof hit.normal);
        hash += hit.surface.index1 + (any == glint_occluded(scene, &ray));
    }
    return hash;
}

static void *trace_shared(void *user) {
    Work *work = user;
    uint64_t hash = trace_all(work->shared);
    for (int i = 0; i < 3; i++) work->wrong += trace_all(work->shared) != hash;
    work->expected.width = (int)(hash & 0x7fffffff);
    return NULL;
}

static void one_scene_from_many_threads(void) {
    char *text = large_text(500);
    GlintScene *scene = scene_from_text(text, NULL, 1);
    int expected = (int)(trace_all(scene) & 0x7fffffff);
    Work work[4];
    pthread_t threads[4];
    for (int i = 0; i < 4; i++) {
        work[i] = (Work){.shared = scene};
        CHECK(pthread_create(&threads[i], NULL, trace_shared, &work[i]) == 0);
    }
    for (int i = 0; i < 4; i++) {
        pthread_join(threads[i], NULL);
        CHECK(work[i].wrong == 0 && work[i].expected.width == expected);
    }
    glint_scene_destroy(scene);
    free(text);
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
    TEST(crops_out_of_range), TEST(ids_and_groups), TEST(trace_agrees_with_picture),
    TEST(load_three_ways), TEST(errors_as_data), TEST(progress_and_cancel), TEST(statistics),
    TEST(failing_allocator), TEST(failing_allocator_by_calls), TEST(memory_limits),
    TEST(two_scenes_at_once), TEST(one_scene_from_many_threads), TEST(example),
    TEST(example_as_cpp), TEST_END};
