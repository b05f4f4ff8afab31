/* SPDX-License-Identifier: MIT
 * What the public functions for pictures ask, for those who write a picture while it is drawn. */
#pragma once

#include "base/memory.h"
#include "image/png_extra.h"

/* Errors: ARGUMENT. */
GlintStatus gi_image_check_desc(const GlintSaveDesc *desc, GlintError *error);

/* The texts and files of a PNG, as the encoder wants them. */
typedef struct GiImageExtras {
    GiPngExtras extras;
    char *text;
    size_t text_size;
    GiPngFile *files;
    size_t file_count;
} GiImageExtras;

/* Makes them of the desc's title and recipe. False when memory is short; *own can be
 * freed all the same. */
bool gi_image_make_extras(GiMemory *memory, const GlintSaveDesc *desc, GiImageExtras *own);
void gi_image_free_extras(GiMemory *memory, GiImageExtras *own);

/* By its extension. */
bool gi_image_is_png(const char *path);
