/* SPDX-License-Identifier: MIT
 * Pictures that explain a picture: each against what the renderer itself says of the same rays. */
#define _XOPEN_SOURCE 700
#include "scenes.h"
#include "test.h"

#include "render/paint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CAMERA                                                                                     \
    "<camera type='PerspectiveCamera'><viewPoint>0 0 5</viewPoint><viewDir>0 0 -1</viewDir>"       \
    "<viewWidth>1.2</viewWidth><viewHeight>0.8</viewHeight></camera><image>60 40</image>"

/* A sphere before a slanted box, and a group of two cylinders; %s: the shader of all. */
#define SURFACES                                                                                   \
    "<surface type='Sphere'><radius>0.8</radius>%s</surface>"                                      \
    "<surface type='Group'><rotate>0 30 20</rotate><surface type='Box'><minPt>-9 -9 -3</minPt>"    \
    "<maxPt>2 1 -2</maxPt>%s</surface></surface>"                                                  \
    "<surface type='Group'><translate>1.5 0 0</translate>"                                         \
    "<surface type='Cylinder'><radius>0.3</radius>%s</surface>"                                    \
    "<surface type='Cylinder'><center>0 1 0</center><radius>0.3</radius>%s</surface></surface>"

static GlintScene *scene_with(
    const char *shader, const char *lights, const char *isa, int threads) {
    static char text[8192];
    int length = snprintf(text, sizeof text, "<scene dialect='glint'>" CAMERA "%s", lights);
    length += snprintf(text + length, sizeof text - (size_t)length, SURFACES "</scene>", shader,
        shader, shader, shader);
    CHECK(length < (int)sizeof text);
    return scene_from_text(text, isa, threads);
}

static const char *const two_lights = "<light><position>3 3 5</position></light>"
                                      "<light><position>-3 3 5</position></light>";

static Picture shown(GlintScene *scene, GlintShow show, double range[2]) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.show = show;
    desc.shown_range = range;
    return picture_of_scene(scene, &desc);
}

/* What the renderer says beside a picture of one sample. */
typedef struct Beside {
    float depth[60 * 40];
    uint32_t surface[60 * 40];
} Beside;

static void look_beside(GlintScene *scene, Beside *beside) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.depth = beside->depth;
    desc.surface = beside->surface;
    Picture picture = picture_of_scene(scene, &desc);
    picture_free(&picture);
}

/* ---------------------------------------------------------------- what is shown */

static void normals_are_those_of_the_shader(void) {
    GlintScene *plain = scene_with("", two_lights, NULL, 2);
    GlintScene *normals = scene_with("<shader type='RGBNormals'/>", "", NULL, 1);
    Picture a = shown(plain, GLINT_SHOW_NORMAL, NULL), b = picture_of_scene(normals, NULL);
    int count = 0;
    for (int i = 0; i < 60 * 40 * 3; i += 3) {
        GiVec back = gi_vec((double)b.pixels[i], (double)b.pixels[i + 1], (double)b.pixels[i + 2]);
        if (gi_vec_is_zero(back)) continue; /* nothing is there */
        CHECK(memcmp(a.pixels + i, b.pixels + i, 3 * sizeof(float)) == 0);
        count++;
    }
    CHECK(count > 1000);
    picture_free(&a);
    picture_free(&b);
    glint_scene_destroy(plain);
    glint_scene_destroy(normals);
}

/* The byte that a PNG has. */
static int byte_of(float value) {
    float pixel[3] = {value, value, value};
    const GlintImage image = {1, 1, pixel};
    uint8_t rgb[3];
    glint_image_to_rgb8(&image, rgb);
    return rgb[0];
}

static void depth_runs_from_white_to_black(void) {
    static Beside beside;
    double range[2], least = INFINITY, most = 0;
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    look_beside(scene, &beside);
    Picture picture = shown(scene, GLINT_SHOW_DEPTH, range);
    for (int i = 0; i < 60 * 40; i++) {
        if (beside.surface[i] == 0) continue;
        least = fmin(least, (double)beside.depth[i]);
        most = fmax(most, (double)beside.depth[i]);
    }
    CHECK_NEAR(range[0], least, 1e-6);
    CHECK_NEAR(range[1], most, 1e-6);
    for (int i = 0; i < 60 * 40; i++) {
        if (beside.surface[i] == 0) continue;
        double white = 1 - ((double)beside.depth[i] - least) / (most - least);
        CHECK_NEAR(byte_of(picture.pixels[3 * i]), 255 * white, 0.51);
    }
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* A plane that runs to the horizon leaves grey to what is near. */
static void depth_of_a_horizon(void) {
    double range[2];
    GlintScene *scene = scene_from_text("<scene dialect='glint'>" CAMERA
                                        "<surface type='Plane'><point>0 -1 0</point>"
                                        "<normal>0 1 0</normal></surface></scene>",
        NULL, 1);
    Picture picture = shown(scene, GLINT_SHOW_DEPTH, range);
    CHECK(range[0] > 2 && range[0] < 3);
    CHECK(range[1] > 8 && range[1] < 60);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

static void each_surface_has_a_colour(void) {
    static Beside beside;
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    look_beside(scene, &beside);
    Picture picture = shown(scene, GLINT_SHOW_ID, NULL);
    bool seen[5] = {false};
    for (int i = 0; i < 60 * 40; i++) {
        CHECK(beside.surface[i] < 5);
        if (beside.surface[i] == 0 || beside.surface[i] > 4) continue;
        seen[beside.surface[i]] = true;
        GiVec color = gi_paint_number(beside.surface[i]);
        CHECK(picture.pixels[3 * i] == (float)color.x);
        CHECK(picture.pixels[3 * i + 1] == (float)color.y);
        CHECK(picture.pixels[3 * i + 2] == (float)color.z);
    }
    for (int i = 1; i < 5; i++) CHECK(seen[i]);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

static void numbers_look_different(void) {
    enum { COUNT = 200 };
    GiVec colors[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        colors[i] = gi_paint_number(i);
        CHECK(gi_largest(colors[i]) > 0.2);
        for (uint32_t k = 0; k < i; k++) {
            double apart = gi_length(gi_sub(colors[i], colors[k]));
            CHECK(apart > (i - k < 5 ? 0.05 : 0.001));
        }
    }
}

/* A square that fills the window, its lower left corner at (0.5, 0), its width 1 in u. */
static void texture_coordinates(void) {
    static const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const float texcoords[] = {0.5f, 0, 1.5f, 0, 1.5f, 1, 0.5f, 1};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    GlintScene *scene = new_scene();
    GlintError error;
    GlintImageDesc image = glint_image_desc_default();
    image.width = image.height = 20;
    CHECK_INT(glint_scene_set_image(scene, &image, &error), GLINT_OK);
    GlintCameraDesc camera = glint_camera_desc_default();
    camera.type = GLINT_CAMERA_PARALLEL;
    camera.view_point[2] = 5;
    camera.view_width = camera.view_height = 2;
    CHECK_INT(glint_scene_set_camera(scene, &camera, &error), GLINT_OK);
    GlintMeshDesc mesh = glint_mesh_desc_default();
    mesh.positions = positions, mesh.texcoords = texcoords, mesh.triangles = triangles;
    mesh.vertex_count = 4, mesh.triangle_count = 2;
    GlintSurfaceDesc surface = glint_surface_desc_default(GLINT_SURFACE_MESH);
    CHECK_INT(glint_scene_add_mesh(scene, &mesh, &surface.mesh, &error), GLINT_OK);
    CHECK_INT(glint_scene_add_surface(scene, &surface, NULL, &error), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
    Picture picture = shown(scene, GLINT_SHOW_UV, NULL);
    for (int y = 0; y < 20; y++) {
        for (int x = 0; x < 20; x++) {
            const float *pixel = picture.pixels + 3 * (y * 20 + x);
            double u = fmod(0.5 + (x + 0.5) / 20, 1), v = (19.5 - y) / 20;
            CHECK_NEAR(byte_of(pixel[0]), 255 * u, 0.51);
            CHECK_NEAR(byte_of(pixel[1]), 255 * v, 0.51);
            CHECK(pixel[2] == 0);
        }
    }
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* On a floor under two lights a ball hides one, the other, both or none; the sides of the ball see
 * one. Compared with pictures of each light alone. */
static void shadows(void) {
    enum { PIXELS = 60 * 40 };
    static float alone[3][PIXELS * 3];
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    Picture picture = shown(scene, GLINT_SHOW_SHADOW, NULL);
    static Beside beside;
    int counts[3] = {0};
    look_beside(scene, &beside);
    for (int light = 1; light <= 2; light++) {
        GlintRenderDesc desc = glint_render_desc_default();
        GlintError error;
        desc.light = light;
        CHECK_INT(glint_render(scene, &desc, alone[light], &error), GLINT_OK);
    }
    for (int i = 0; i < PIXELS; i++) {
        if (beside.surface[i] == 0) continue;
        int seen = (alone[1][3 * i] > 0) + (alone[2][3 * i] > 0);
        counts[seen]++;
        CHECK_NEAR(byte_of(picture.pixels[3 * i]), 127.5 * seen, 0.51);
    }
    for (int i = 0; i < 3; i++) CHECK(counts[i] > 20);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- cost */

static void cost_is_the_same_everywhere(void) {
    double first_range[2] = {0, 0}, range[2] = {0, 0};
    GlintScene *scene = scene_with("", two_lights, NULL, 1);
    Picture first = shown(scene, GLINT_SHOW_COST, first_range);
    glint_scene_destroy(scene);
    CHECK(first_range[1] > 4 && first_range[1] < 1000);
    CHECK(first_range[0] == 0);
    for (int i = 0; glint_isa_name(i) != NULL; i++) {
        scene = scene_with("", two_lights, glint_isa_name(i), i + 1);
        Picture picture = shown(scene, GLINT_SHOW_COST, range);
        CHECK(picture_equal(&first, &picture));
        CHECK(range[1] == first_range[1]);
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
    picture_free(&first);
}

/* Four samples a pixel are four times the work, but for what pixels at an outline meet. */
static void cost_of_samples(void) {
    double one[2], four[2];
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.show = GLINT_SHOW_COST;
    desc.shown_range = four;
    desc.samples = 4;
    Picture a = shown(scene, GLINT_SHOW_COST, one), b = picture_of_scene(scene, &desc);
    CHECK(four[1] > 3 * one[1] && four[1] < 5 * one[1]);
    picture_free(&a);
    picture_free(&b);
    glint_scene_destroy(scene);
}

/* The bar of the legend ends in white, and the numbers under it are there. */
static void legend(void) {
    enum { WIDTH = 200, HEIGHT = 100, SMALL = 30 };
    static float pixels[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) pixels[i] = 0.5f;
    gi_paint_legend(pixels, WIDTH, HEIGHT, 120);
    int white = 0, kept = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        white += pixels[3 * i] == 1 && pixels[3 * i + 1] == 1 && pixels[3 * i + 2] == 1;
        kept += pixels[3 * i] == 0.5f;
    }
    CHECK(white > 50 && white < 200);
    CHECK_INT(kept, WIDTH * HEIGHT - 126 * 21);
    for (int i = 0; i < SMALL * SMALL * 3; i++) pixels[i] = 0.5f;
    gi_paint_legend(pixels, SMALL, SMALL, 120);
    for (int i = 0; i < SMALL * SMALL * 3; i++) CHECK(pixels[i] == 0.5f);
}

/* ---------------------------------------------------------------- the call */

static void crops(void) {
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    Picture whole = shown(scene, GLINT_SHOW_ID, NULL);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.show = GLINT_SHOW_ID;
    desc.crop_x = 13, desc.crop_y = 7, desc.crop_width = 30, desc.crop_height = 20;
    Picture part = picture_of_scene(scene, &desc);
    for (int y = 0; y < 20; y++) {
        const float *row = whole.pixels + 3 * ((y + 7) * 60 + 13);
        CHECK(memcmp(part.pixels + 3 * 30 * y, row, 3 * 30 * sizeof(float)) == 0);
    }
    picture_free(&whole);
    picture_free(&part);
    glint_scene_destroy(scene);
}

/* Another camera shows what a scene with that camera would. */
static void cameras(void) {
    static const char *const moved =
        "<camera type='PerspectiveCamera'><viewPoint>1 0.5 4</viewPoint>"
        "<viewDir>-1 0 -4</viewDir><viewWidth>1.2</viewWidth>"
        "<viewHeight>0.8</viewHeight></camera>";
    static char lights[1024];
    snprintf(lights, sizeof lights, "%s%s", moved, two_lights); /* the last camera counts */
    GlintScene *first = scene_with("", two_lights, NULL, 2);
    GlintScene *second = scene_with("", lights, NULL, 2);
    GlintCameraDesc camera = glint_camera_desc_default();
    camera.view_point[0] = 1, camera.view_point[1] = 0.5, camera.view_point[2] = 4;
    camera.view_direction[0] = -1, camera.view_direction[2] = -4;
    camera.view_width = 1.2, camera.view_height = 0.8;
    for (int show = GLINT_SHOW_NORMAL; show < GLINT_SHOW_COUNT; show++) {
        GlintRenderDesc desc = glint_render_desc_default();
        desc.show = (GlintShow)show;
        Picture a = picture_of_scene(second, &desc);
        desc.camera = &camera;
        Picture b = picture_of_scene(first, &desc);
        CHECK(picture_equal(&a, &b));
        picture_free(&a);
        picture_free(&b);
    }
    glint_scene_destroy(first);
    glint_scene_destroy(second);
}

static bool always(void *user) {
    (void)user;
    return true;
}

static void refused_and_cancelled(void) {
    static float pixels[60 * 40 * 3], depth[60 * 40];
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    const GlintMonitor monitor = {.cancelled = always};
    GlintRenderDesc desc = glint_render_desc_default();
    GlintError error;
    desc.show = GLINT_SHOW_COUNT;
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_ERROR_ARGUMENT);
    desc.show = GLINT_SHOW_ID;
    desc.light = 1;
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_ERROR_ARGUMENT);
    desc.light = 0;
    desc.depth = depth;
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_ERROR_ARGUMENT);
    desc.depth = NULL;
    desc.monitor = &monitor;
    for (int show = GLINT_SHOW_NORMAL; show < GLINT_SHOW_COUNT; show++) {
        desc.show = (GlintShow)show;
        CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_CANCELLED);
    }
    glint_scene_destroy(scene);
}

static size_t read_bytes(const char *path, uint8_t *bytes, size_t size) {
    FILE *file = fopen(path, "rb");
    size_t count = file != NULL ? fread(bytes, 1, size, file) : 0;
    if (file != NULL) fclose(file);
    return count;
}

/* The file that is drawn at once is that of the picture. */
static void saved(void) {
    char at_once[1024], afterwards[1024];
    GlintScene *scene = scene_with("", two_lights, NULL, 2);
    GlintRenderDesc desc = glint_render_desc_default();
    GlintSaveDesc save = glint_save_desc_default();
    GlintError error;
    static uint8_t first[65536], second[65536];
    desc.show = GLINT_SHOW_COST;
    snprintf(at_once, sizeof at_once, "%s/cost.png", test_scratch_dir());
    snprintf(afterwards, sizeof afterwards, "%s/cost2.png", test_scratch_dir());
    CHECK_INT(glint_render_save(scene, &desc, at_once, &save, &error), GLINT_OK);
    Picture picture = picture_of_scene(scene, &desc);
    const GlintImage image = {60, 40, picture.pixels};
    CHECK_INT(glint_image_save(&image, afterwards, &save, &error), GLINT_OK);
    size_t size = read_bytes(at_once, first, sizeof first);
    CHECK(size > 100);
    CHECK_INT(read_bytes(afterwards, second, sizeof second), size);
    CHECK(memcmp(first, second, size) == 0);
    picture_free(&picture);
    glint_scene_destroy(scene);
}

const GiTest tests_show[] = {TEST(normals_are_those_of_the_shader),
    TEST(depth_runs_from_white_to_black), TEST(depth_of_a_horizon), TEST(each_surface_has_a_colour),
    TEST(numbers_look_different), TEST(texture_coordinates), TEST(shadows),
    TEST(cost_is_the_same_everywhere), TEST(cost_of_samples), TEST(legend), TEST(crops),
    TEST(cameras), TEST(refused_and_cancelled), TEST(saved), TEST_END};
