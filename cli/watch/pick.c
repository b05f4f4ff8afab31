/* SPDX-License-Identifier: MIT */
#include "watch/pick.h"

#include <stdint.h>

bool cli_pick_ray(
    const GlintCameraDesc *camera, int width, int height, double x, double y, GlintRay *ray) {
    double a = (x + 0.5) / width, b = 1 - (y + 0.5) / height;
    return glint_camera_ray(camera, a, b, ray, NULL) == GLINT_OK;
}

/* "surface 3 "ball", scene.xml:12:5" */
static void add_surface(GlintScene *scene, const GlintHit *hit, CliBytes *text) {
    GlintSource source;
    if (hit->surface.index1 == 0) {
        cli_bytes_add_text(text, "  surface   the rectangle of a light\n");
        return;
    }
    cli_bytes_format(text, "  surface   %u", (unsigned)hit->surface.index1);
    if (glint_scene_source(scene, GLINT_OBJECT_SURFACE, hit->surface.index1, &source)) {
        if (source.name[0] != '\0') cli_bytes_format(text, " \"%s\"", source.name);
        cli_bytes_format(
            text, ", %s:%lld:%lld", source.path, (long long)source.line, (long long)source.column);
    }
    cli_bytes_add_text(text, "\n");
}

void cli_pick_describe(GlintScene *scene, const CliPicked *picked, CliBytes *text) {
    const GlintImage pixel = {1, 1, picked->color};
    uint8_t rgb[3];
    glint_image_to_rgb8(&pixel, rgb);
    cli_bytes_format(text, "pixel %d,%d\n", picked->x, picked->y);
    cli_bytes_format(text, "  colour    %.6g %.6g %.6g, as bytes %d %d %d\n",
        (double)picked->color[0], (double)picked->color[1], (double)picked->color[2], rgb[0],
        rgb[1], rgb[2]);
    GlintRay ray;
    GlintHit hit;
    if (!cli_pick_ray(picked->camera, picked->width, picked->height, picked->x, picked->y, &ray) ||
        !glint_trace(scene, &ray, &hit)) {
        cli_bytes_add_text(text, "  surface   none: the background\n");
        return;
    }
    add_surface(scene, &hit, text);
    cli_bytes_format(
        text, "  point     %.9g %.9g %.9g\n", hit.point[0], hit.point[1], hit.point[2]);
    cli_bytes_format(
        text, "  normal    %.6g %.6g %.6g\n", hit.normal[0], hit.normal[1], hit.normal[2]);
    cli_bytes_format(text, "  distance  %.9g\n", hit.t);
}
