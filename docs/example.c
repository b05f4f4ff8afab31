/* SPDX-License-Identifier: MIT
 * The smallest whole program with Glint: a sphere on a box in one light, drawn, saved, and asked
 * what lies in the middle of the picture.
 *
 *     cc docs/example.c -o example $(pkg-config --cflags --libs glint) && ./example */
#include <glint/glint.h>

#include <math.h>
#include <stdio.h>

enum { WIDTH = 320, HEIGHT = 240 };
static float pixels[WIDTH * HEIGHT * 3];

static GlintStatus build(GlintScene *scene, GlintError *error) {
    GlintImageDesc image = glint_image_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    GlintLightDesc light = glint_light_desc_default();
    GlintSurfaceDesc sphere = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    GlintSurfaceDesc box = glint_surface_desc_default(GLINT_SURFACE_BOX);
    image.width = WIDTH, image.height = HEIGHT;
    camera.view_point[2] = 6; /* it looks along -z */
    camera.projection_distance = 3, camera.view_width = 2, camera.view_height = 1.5;
    light.position[0] = 3, light.position[1] = 4, light.position[2] = 5;
    box.point_a[0] = -1.5, box.point_a[1] = -1.3, box.point_a[2] = -1.5;
    box.point_b[0] = 1.5, box.point_b[1] = -1, box.point_b[2] = 1.5;
    GlintStatus status = glint_scene_set_image(scene, &image, error);
    if (status == GLINT_OK) status = glint_scene_set_camera(scene, &camera, error);
    if (status == GLINT_OK) status = glint_scene_add_light(scene, &light, error);
    if (status == GLINT_OK) status = glint_scene_add_surface(scene, &sphere, NULL, error);
    if (status == GLINT_OK) status = glint_scene_add_surface(scene, &box, NULL, error);
    return status == GLINT_OK ? glint_scene_commit(scene, NULL, error) : status;
}

static GlintStatus draw(GlintScene *scene, const char *path, GlintError *error) {
    GlintRenderDesc desc = glint_render_desc_default();
    GlintStatus status = glint_render(scene, &desc, pixels, error);
    if (status != GLINT_OK) return status;
    GlintSaveDesc save = glint_save_desc_default();
    GlintImage image = {WIDTH, HEIGHT, pixels};
    return glint_image_save(&image, path, &save, error);
}

int main(void) {
    GlintError error;
    GlintScene *scene = NULL;
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK) status = build(scene, &error);
    if (status == GLINT_OK) status = draw(scene, "example.png", &error);
    if (status == GLINT_OK) {
        GlintRay ray = {{0, 0, 6}, {0, 0, -1}, 0, INFINITY};
        GlintHit hit;
        if (glint_trace(scene, &ray, &hit)) {
            printf("surface %u at t = %g, normal %g %g %g\n", (unsigned)hit.surface.index1, hit.t,
                hit.normal[0], hit.normal[1], hit.normal[2]);
        }
    } else {
        fprintf(stderr, "%s%s%s\n", error.path, error.path[0] != '\0' ? ": " : "", error.message);
    }
    glint_scene_destroy(scene);
    return status == GLINT_OK ? 0 : 1;
}
