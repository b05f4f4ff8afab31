/* SPDX-License-Identifier: MIT
 * Turning a camera by hand. Each movement keeps the numbers of the camera short enough to be read
 * in a scene file (about seven digits), and what is drawn is drawn with these very numbers, so that
 * a camera that is written down shows the same picture to the last bit. */
#pragma once

#include "glint/glint.h"

/* Round the point that lies `distance` in front of the eye (of a parallel camera, of the middle of
 * its window), about what is up, and up or down; degrees. The camera stays upright: it stops short
 * of where up is in front. */
void cli_camera_orbit(
    GlintCameraDesc *camera, double distance, double right_degrees, double up_degrees);

/* Sideways, so that what is `distance` away moves by these parts of the picture, right and down. */
void cli_camera_pan(GlintCameraDesc *camera, double distance, double right, double down);

/* Towards what is `distance` away, to a distance of so many times as much; a parallel camera's
 * window shrinks instead. factor > 0. */
void cli_camera_zoom(GlintCameraDesc *camera, double distance, double factor);

/* Whether two cameras show the same. */
bool cli_camera_equal(const GlintCameraDesc *a, const GlintCameraDesc *b);

/* A number of a camera as text that reads back as the same number, as short as can be. */
enum { CLI_CAMERA_NUMBER_SIZE = 32 };
void cli_camera_number(double value, char text[CLI_CAMERA_NUMBER_SIZE]);
