/* SPDX-License-Identifier: MIT
 * Floats are gathered in a buffer of BUFFER_FLOATS, in the byte order of the file whatever the
 * machine's is, and handed on when it is full: some hundred calls of the sink for a big picture. */
#include "image/pfm.h"

#include "base/error.h"

#include <stdio.h>
#include <string.h>

enum { BUFFER_FLOATS = 1 << 16 };

static void put_floats(uint8_t *to, const float *from, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &from[i], sizeof bits);
        for (int k = 0; k < 4; k++) to[4 * i + (size_t)k] = (uint8_t)(bits >> (8 * k));
    }
}

static GlintStatus encode(uint8_t *buffer, const GlintImage *image, const GlintMonitor *monitor,
    GlintSinkFn sink, void *user, GlintError *error) {
    static const char stopped[] = "the receiver of the picture's bytes stopped";
    size_t row = 3 * (size_t)image->width, done = 0, total = row * (size_t)image->height;
    size_t fill = 0; /* floats in the buffer */
    char head[64];
    int length = snprintf(head, sizeof head, "PF\n%d %d\n-1.0\n", image->width, image->height);
    if (!sink(user, head, (size_t)length)) return gi_error_set(error, GLINT_ERROR_FILE, stopped);
    while (done < total) {
        size_t x = done % row, y = (size_t)image->height - 1 - done / row;
        size_t room = BUFFER_FLOATS - fill, count = row - x < room ? row - x : room;
        put_floats(buffer + 4 * fill, image->pixels + y * row + x, count);
        fill += count;
        done += count;
        if (fill < BUFFER_FLOATS && done < total) continue;
        if (monitor != NULL && monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
            return gi_error_set(error, GLINT_CANCELLED, "cancelled");
        }
        if (!sink(user, buffer, 4 * fill)) return gi_error_set(error, GLINT_ERROR_FILE, stopped);
        fill = 0;
        if (monitor != NULL && monitor->progress != NULL) {
            monitor->progress(monitor->user, GLINT_PHASE_WRITE, (double)done / (double)total);
        }
    }
    return GLINT_OK;
}

GlintStatus gi_pfm_encode(GiMemory *memory, const GlintImage *image, const GlintMonitor *monitor,
    GlintSinkFn sink, void *user, GlintError *error) {
    uint8_t *buffer = gi_memory_allocate(memory, 4 * BUFFER_FLOATS);
    if (buffer == NULL) return gi_error_memory(error);
    GlintStatus status = encode(buffer, image, monitor, sink, user, error);
    gi_memory_free(memory, buffer, 4 * BUFFER_FLOATS);
    return status;
}
