/* SPDX-License-Identifier: MIT
 * Cameras that a scene is drawn with in the place of its own: the picture is the one of a scene
 * with that camera, to the last bit. */
#include "scenes.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* One of everything that asks for the camera: a highlight, a mirror, and the eye on a surface. */
static const char content[] =
    "<image>61 43</image><samples>4</samples>"
    "<light><position>4 5 6</position></light>"
    "<surface type='Sphere'><shader type='Phong'><exponent>20</exponent>"
    "<mirrorCoefficient>0.3 0.3 0.3</mirrorCoefficient></shader></surface>"
    "<surface type='Box'><minPt>-3 -2 -3</minPt><maxPt>3 -1 3</maxPt></surface></scene>";

static const char *const cameras[] = {
    "<camera type='PerspectiveCamera'><viewPoint>0 0 4</viewPoint></camera>",
    "<camera type='PerspectiveCamera'><viewPoint>5 4 3</viewPoint><viewDir>-5 -4 -3</viewDir>"
    "<viewUp>0 1 0.1</viewUp><projDistance>2.5</projDistance><viewWidth>1.5</viewWidth></camera>",
    "<camera type='PerspectiveCamera'><viewPoint>5 4 3</viewPoint><viewDir>-5 -4 -3</viewDir>"
    "<projNormal>0 0 1</projNormal></camera>",
    "<camera type='ParallelCamera'><viewPoint>5 4 3</viewPoint><viewDir>-5 -4 -3</viewDir>"
    "<viewWidth>5</viewWidth><viewHeight>4</viewHeight></camera>",
    "<camera type='PerspectiveCamera'><viewPoint>0 0 1</viewPoint><viewDir>1 -1 2</viewDir>"
    "</camera>",
};
enum { CAMERA_COUNT = sizeof cameras / sizeof cameras[0] };

static GlintScene *scene_with(const char *camera) {
    char text[2048];
    snprintf(text, sizeof text, "<scene dialect='glint'>%s%s", camera, content);
    return scene_from_text(text, NULL, 2);
}

static void same_picture(void) {
    for (int i = 0; i < CAMERA_COUNT; i++) {
        GlintScene *own = scene_with(cameras[i]);
        GlintScene *other = scene_with(cameras[(i + 1) % CAMERA_COUNT]);
        GlintCameraDesc camera;
        CHECK(own != NULL && other != NULL && glint_scene_camera(own, &camera));
        Picture expected = picture_of_scene(own, NULL), before = picture_of_scene(other, NULL);
        GlintRenderDesc desc = glint_render_desc_default();
        desc.camera = &camera;
        Picture actual = picture_of_scene(other, &desc), after = picture_of_scene(other, NULL);
        CHECK(picture_equal(&expected, &actual));
        CHECK(!picture_equal(&before, &actual));
        CHECK(picture_equal(&before, &after)); /* nothing of it stays behind */
        picture_free(&expected);
        picture_free(&before);
        picture_free(&actual);
        picture_free(&after);
        glint_scene_destroy(own);
        glint_scene_destroy(other);
    }
}

#ifdef GI_BUILT_PNG /* which reads the files again */
/* In a file, too; but it says nothing of how it was drawn, which holds for the scene's own. */
static void same_file(void) {
    GlintScene *own = scene_with(cameras[1]), *other = scene_with(cameras[0]);
    char path[256];
    uint64_t digests[2] = {0};
    GlintCameraDesc camera;
    GlintRecipe *recipe = NULL;
    CHECK(own != NULL && other != NULL && glint_scene_camera(own, &camera));
    GlintRenderDesc desc = glint_render_desc_default();
    GlintSaveDesc save = glint_save_desc_default();
    snprintf(path, sizeof path, "%s/camera.png", test_scratch_dir());
    for (int i = 0; i < 2; i++) {
        if (i == 1) desc.camera = &camera;
        CHECK_INT(glint_render_save(i == 0 ? own : other, &desc, path, &save, NULL), GLINT_OK);
        CHECK_INT(glint_picture_digest(path, &digests[i], NULL), GLINT_OK);
        CHECK_INT(glint_recipe_load(path, &recipe, NULL), i == 0 ? GLINT_OK : GLINT_ERROR_FILE);
        glint_recipe_destroy(recipe);
        recipe = NULL;
    }
    CHECK(digests[0] == digests[1] && digests[0] != 0);
    CHECK_INT(glint_scene_recipe(other, &desc, false, &recipe, NULL), GLINT_ERROR_ARGUMENT);
    glint_scene_destroy(own);
    glint_scene_destroy(other);
}
#endif

/* What a file says comes out again, and what it does not say as the default. */
static void asked_for(void) {
    GlintScene *scene = scene_with(cameras[1]);
    GlintCameraDesc camera;
    CHECK(glint_scene_camera(scene, &camera));
    CHECK(camera.type == GLINT_CAMERA_PERSPECTIVE && camera.view_point[0] == 5);
    CHECK(camera.view_direction[1] == -4 && camera.view_up[2] == 0.1);
    CHECK(camera.projection_normal[0] == 0 && camera.projection_normal[2] == 0);
    CHECK(camera.projection_distance == 2.5 && camera.view_width == 1.5 && camera.view_height == 1);
    glint_scene_destroy(scene);
    scene = new_scene();
    CHECK(!glint_scene_camera(scene, &camera)); /* none is set */
    GlintCameraDesc desc = glint_camera_desc_default();
    desc.type = GLINT_CAMERA_PARALLEL;
    desc.projection_normal[2] = -1;
    CHECK_INT(glint_scene_set_camera(scene, &desc, NULL), GLINT_OK);
    CHECK(glint_scene_camera(scene, &camera) && camera.type == desc.type);
    /* What lies between the members is anything. */
    size_t numbers = offsetof(GlintCameraDesc, cookie) - offsetof(GlintCameraDesc, view_point);
    CHECK(memcmp(camera.view_point, desc.view_point, numbers) == 0);
    glint_scene_destroy(scene);
}

/* A camera that a scene could not have is refused, and the scene keeps its own. */
static void refused(void) {
    GlintScene *scene = scene_with(cameras[0]);
    GlintRenderDesc desc = glint_render_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    GlintError error;
    GlintRay ray;
    static float pixels[3 * 61 * 43];
    desc.camera = &camera;
    camera.view_up[1] = 0;
    camera.view_up[2] = 7;
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.message, "view_up is parallel to the projection normal");
    CHECK_INT(glint_camera_ray(&camera, 0, 0, &ray, &error), GLINT_ERROR_ARGUMENT);
    camera = glint_camera_desc_default();
    camera.view_width = NAN;
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.message, "view_width must be positive and finite");
    memset(&camera, 0, sizeof camera);
    CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.message, "the desc was not made by glint_camera_desc_default");
    CHECK_INT(glint_camera_ray(NULL, 0, 0, &ray, &error), GLINT_ERROR_ARGUMENT);
    glint_scene_destroy(scene);
}

/* The ray of a pixel meets what the picture shows there. */
static void rays(void) {
    enum { WIDTH = 61, HEIGHT = 43 };
    for (int i = 0; i < CAMERA_COUNT; i++) {
        GlintScene *scene = scene_with(cameras[i]);
        static float pixels[3 * WIDTH * HEIGHT], depth[WIDTH * HEIGHT];
        static uint32_t surface[WIDTH * HEIGHT];
        GlintRenderDesc desc = glint_render_desc_default();
        desc.samples = 1;
        desc.depth = depth;
        desc.surface = surface;
        CHECK_INT(glint_render(scene, &desc, pixels, NULL), GLINT_OK);
        GlintCameraDesc camera;
        CHECK(glint_scene_camera(scene, &camera));
        for (int pixel = 0; pixel < WIDTH * HEIGHT; pixel += 17) {
            double a = (pixel % WIDTH + 0.5) / WIDTH, b = 1 - (pixel / WIDTH + 0.5) / HEIGHT;
            GlintRay ray;
            GlintHit hit = {0};
            CHECK_INT(glint_camera_ray(&camera, a, b, &ray, NULL), GLINT_OK);
            ray.t_min = 1e-9; /* one of the eyes lies on a surface */
            bool met = glint_trace(scene, &ray, &hit);
            CHECK_INT(met ? hit.surface.index1 : 0, surface[pixel]);
            CHECK_NEAR(met ? hit.t : 0, depth[pixel], 1e-5);
        }
        glint_scene_destroy(scene);
    }
}

const GiTest tests_camera[] = {TEST(same_picture), TEST(asked_for), TEST(refused), TEST(rays),
#ifdef GI_BUILT_PNG
    TEST(same_file),
#endif
    TEST_END};
