/* SPDX-License-Identifier: MIT
 * EXR: linear floats, compressed without loss, with any number of layers. The work is done by a
 * module. */
#pragma once

#include "base/memory.h"
#include "port/file.h"

/* GLINT_OK when the module is there. Errors: FILE. */
GlintStatus gi_exr_check(GlintError *error);

/* Null, or what is wrong with the layers of desc, or with this picture as an EXR file. */
const char *gi_exr_check_picture(const GlintImage *image, const GlintSaveDesc *desc);

/* Writes image, which has been checked, to a file that is begun; the caller ends the file. Errors:
 * FILE (the file, then file->error is set; the module), MEMORY, CANCELLED. */
GlintStatus gi_exr_write(GiMemory *memory, const GlintImage *image, const GlintSaveDesc *desc,
    GiFileWriter *file, GlintError *error);
