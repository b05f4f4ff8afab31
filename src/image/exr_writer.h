/* SPDX-License-Identifier: MIT
 * What the module that writes EXR exports, under the name GI_EXR_WRITER_SYMBOL. The module sees
 * nothing of the library but this header. */
#pragma once

#include "glint/glint.h"

#define GI_EXR_WRITER_SYMBOL  "glint_exr_writer"
#define GI_EXR_WRITER_VERSION 1 /* of this header; a module of another is refused */

typedef struct GiExrChannel {
    const char *name;    /* "R", "normal.X" */
    const float *values; /* of the first pixel, top left */
    int stride;          /* from pixel to pixel, in floats; rows follow each other */
} GiExrChannel;

typedef struct GiExrPicture {
    int width, height;
    const GiExrChannel *channels;
    int channel_count;
    const char *software, *title; /* of the header; title may be null */
} GiExrPicture;

typedef struct GiExrTarget {
    /* Writes at a place of the file; not always in order. False to stop. */
    bool (*write)(void *user, const void *bytes, size_t size, uint64_t offset);
    /* Is called from time to time, fraction from 0 to 1. False to stop. */
    bool (*step)(void *user, double fraction);
    /* Calls job(context, i) for all i below count, on several threads at once. */
    void (*run)(void *user, size_t count, void (*job)(void *context, size_t index), void *context);
    size_t batch_size; /* the largest count, at least 1 */
    void *user;
    char *message; /* for a sentence, when it fails on its own account */
    size_t message_size;
} GiExrTarget;

typedef enum GiExrOutcome {
    GI_EXR_GOOD,
    GI_EXR_STOPPED, /* by the target */
    GI_EXR_MEMORY,
    GI_EXR_FAILED /* with a message */
} GiExrOutcome;

typedef struct GiExrWriter {
    int version;
    GiExrOutcome (*write)(const GiExrPicture *picture, const GiExrTarget *target);
} GiExrWriter;
