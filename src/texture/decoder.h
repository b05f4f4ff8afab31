/* SPDX-License-Identifier: MIT
 * What a module that decodes pictures exports, under the name GI_DECODER_SYMBOL. The module sees
 * nothing of the library but this header: memory for the pixels is asked of the target. */
#pragma once

#include "glint/glint.h"

#define GI_DECODER_SYMBOL  "glint_decoder"
#define GI_DECODER_VERSION 1 /* of this header; a module of another is refused */

#define GI_PICTURE_PIXEL_LIMIT (1 << 28)

typedef struct GiDecoderTarget {
    /* Memory for width * height * 3 bytes, which stay the target's whatever follows; null when
     * there is none. Called at most once. */
    uint8_t *(*begin)(void *user, int width, int height);
    void *user;
    char *message; /* for a sentence, when the picture is refused */
    size_t message_size;
} GiDecoderTarget;

typedef struct GiDecoder {
    int version;
    /* bytes is a whole file. Errors: FILE (with a message), MEMORY. */
    GlintStatus (*decode)(const uint8_t *bytes, size_t size, const GiDecoderTarget *target);
} GiDecoder;
