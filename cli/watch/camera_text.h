/* SPDX-License-Identifier: MIT
 * A camera in the text of a scene: the values that have changed are replaced, and every other byte
 * of the file stays as it is. */
#pragma once

#include "watch/bytes.h"
#include "watch/camera.h"

/* The text of a scene and the place of a camera's start tag in it, as glint_scene_source tells. */
typedef struct CliCameraText {
    const char *text;
    size_t size;
    int64_t line, column;
} CliCameraText;

/* The name that the camera element refers to (its attribute `ref`); false when it has none. */
bool cli_camera_text_ref(const CliCameraText *place, char *name, size_t size);

/* Puts the whole text into *result, with the camera turned from `before`, which it says now, into
 * `after`. An element that is missing is added behind the others, indented like them. False, with a
 * sentence in reason, when it cannot be done. */
bool cli_camera_text_replace(const CliCameraText *place, const GlintCameraDesc *before,
    const GlintCameraDesc *after, CliBytes *result, char *reason, size_t reason_size);
