/* SPDX-License-Identifier: MIT
 * Reading a picture of any format that Glint writes, and JPEG, to linear values. */
#pragma once

#include "base/memory.h"

/* *pixels: width * height * 3 floats of memory, freed by the caller. Errors: FILE, MEMORY; there is
 * nothing to free then. */
GlintStatus gi_compare_load(
    GiMemory *memory, const char *path, int *width, int *height, float **pixels, GlintError *error);
