/* SPDX-License-Identifier: MIT
 * What a click in the picture tells. */
#pragma once

#include "watch/bytes.h"

/* A picture as it is shown. */
typedef struct CliPicked {
    int width, height;             /* of the whole picture, in pixels */
    int x, y;                      /* the pixel, from the top left */
    const float *color;            /* its linear colour */
    const GlintCameraDesc *camera; /* that it was drawn with */
} CliPicked;

/* Appends lines about a pixel: its place and colour, the surface that is met there, where that
 * stands in the file, the point, the normal, the distance. The scene keeps its sources. */
void cli_pick_describe(GlintScene *scene, const CliPicked *picked, CliBytes *text);

/* The ray through the middle of a pixel. False when the camera is none. */
bool cli_pick_ray(
    const GlintCameraDesc *camera, int width, int height, double x, double y, GlintRay *ray);
