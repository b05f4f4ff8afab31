/* SPDX-License-Identifier: MIT
 * What the module that reads EXR exports, under the name GI_EXR_READER_SYMBOL. The module sees
 * nothing of the library but this header. */
#pragma once

#include "glint/glint.h"

#define GI_EXR_READER_SYMBOL  "glint_exr_reader"
#define GI_EXR_READER_VERSION 1 /* of this header; a module of another is refused */

typedef struct GiExrSource {
    const void *bytes; /* a whole file */
    size_t size;
    /* Memory for width * height * 3 floats, which stay the caller's whatever follows; null when
     * there is none. Called at most once. */
    float *(*begin)(void *user, int width, int height);
    void *user;
    char *message; /* for a sentence, when the file is refused */
    size_t message_size;
} GiExrSource;

typedef struct GiExrReader {
    int version;
    /* Channels R, G and B of the first part, or Y for all three; the top row first. Errors: FILE
     * (with a message), MEMORY. */
    GlintStatus (*read)(const GiExrSource *source);
} GiExrReader;
