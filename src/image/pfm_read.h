/* SPDX-License-Identifier: MIT
 * Reading PFM: colour, float. */
#pragma once

#include "base/memory.h"

typedef struct GiPfm {
    int width, height;
    float *pixels; /* width * height * 3, the row that is stored first comes first */
} GiPfm;

/* Reads a picture from its first byte to its last pixel; what follows is left unread. total_size is
 * that of the whole file, or -1; with it a header that lies is found out before memory is asked
 * for. The third line, which should tell the byte order, is skipped: cube maps are little-endian
 * whatever they say. Values may be anything, also NaN. Errors: FILE (the message has no path; also
 * when read fails), MEMORY; there is nothing to free then. */
GlintStatus gi_pfm_read(GiPfm *pfm, GiMemory *memory, GlintReadFn read, void *user,
    int64_t total_size, GlintError *error);

void gi_pfm_free(GiPfm *pfm, GiMemory *memory);
