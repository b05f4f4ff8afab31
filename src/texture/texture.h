/* SPDX-License-Identifier: MIT
 * Pictures on surfaces. */
#pragma once

#include "base/memory.h"
#include "math/vec.h"

/* 8-bit RGB, top row first, as the file has it. */
typedef struct GiPicture {
    int width, height;
    uint8_t *rgb; /* width * height * 3 */
} GiPicture;

typedef enum GiWrap { GI_WRAP_REPEAT, GI_WRAP_CLAMP } GiWrap;

/* Reads a PNG or JPEG file; its first bytes tell which it is. Gray becomes colour, 16 bits become
 * 8, transparency is dropped, and profiles are not heeded. Errors, with *picture empty: FILE (also
 * when the module that reads this format is missing), MEMORY. */
GlintStatus gi_picture_load(
    GiPicture *picture, GiMemory *memory, const char *path, GlintError *error);

/* The same of a file's bytes. The message has no path. */
GlintStatus gi_picture_decode(
    GiPicture *picture, GiMemory *memory, const void *bytes, size_t size, GlintError *error);

void gi_picture_free(GiPicture *picture, GiMemory *memory);

/* The colour at u (to the right) and v (up), with no filter; bytes 0 to 255 become 0 to 1, linear.
 */
GiVec gi_texture_color(const GiPicture *picture, GiWrap wrap, double u, double v);
