/* SPDX-License-Identifier: MIT
 * A program of somebody else, in what C and C++ have in common: one sphere, one light, one ray.
 *
 *     ball                    draws ball.png and traces a ray
 *     ball SCENE PICTURE      draws the scene */
#include <glint/glint.h>

#include <stdio.h>

static int fail(const GlintError *error) {
    fprintf(stderr, "%s: %s\n", error->path, error->message);
    return 1;
}

static int draw_file(GlintScene *scene, const char *path, const char *picture) {
    GlintError error;
    GlintRenderDesc render = glint_render_desc_default();
    GlintSaveDesc save = glint_save_desc_default();
    render.width = 40;
    render.height = 30;
    render.samples = 1;
    if (glint_scene_load_file(scene, path, NULL, &error) != GLINT_OK ||
        glint_scene_commit(scene, NULL, &error) != GLINT_OK ||
        glint_render_save(scene, &render, picture, &save, &error) != GLINT_OK) {
        return fail(&error);
    }
    return 0;
}

static int draw_ball(GlintScene *scene) {
    static float pixels[16 * 16 * 3];
    GlintError error;
    GlintImageDesc image = glint_image_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    GlintLightDesc light = glint_light_desc_default();
    GlintSurfaceDesc ball = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    GlintRenderDesc render = glint_render_desc_default();
    GlintSaveDesc save = glint_save_desc_default();
    GlintImage picture = {16, 16, pixels};
    GlintRay ray = {{0, 0, 5}, {0, 0, -1}, 0, 100};
    GlintHit hit;
    image.width = image.height = 16;
    camera.view_point[2] = 5;
    light.position[2] = 5;
    if (glint_scene_set_image(scene, &image, &error) != GLINT_OK ||
        glint_scene_set_camera(scene, &camera, &error) != GLINT_OK ||
        glint_scene_add_light(scene, &light, &error) != GLINT_OK ||
        glint_scene_add_surface(scene, &ball, NULL, &error) != GLINT_OK ||
        glint_scene_commit(scene, NULL, &error) != GLINT_OK ||
        glint_render(scene, &render, pixels, &error) != GLINT_OK ||
        glint_image_save(&picture, "ball.png", &save, &error) != GLINT_OK) {
        return fail(&error);
    }
    return glint_trace(scene, &ray, &hit) && hit.t > 3.999999 && hit.t < 4.000001 ? 0 : 2;
}

int main(int count, char **arguments) {
    GlintError error;
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintScene *scene = NULL;
    int status;
    if (glint_scene_create(&desc, &scene, &error) != GLINT_OK) return fail(&error);
    status = count == 3 ? draw_file(scene, arguments[1], arguments[2]) : draw_ball(scene);
    glint_scene_destroy(scene);
    return status;
}
