/* SPDX-License-Identifier: MIT
 * PNG: 8-bit RGB, gamma 2.2. */
#pragma once

#include "base/memory.h"

/* Encodes image, which has been checked, and hands the bytes to sink in order. title (UTF-8) and
 * monitor may be null; thread_count 0 is one per core. The bytes do not depend on thread_count.
 * Errors: FILE (the sink stopped), MEMORY, CANCELLED. */
GlintStatus gi_png_encode(GiMemory *memory, const GlintImage *image, const char *title,
    int thread_count, const GlintMonitor *monitor, GlintSinkFn sink, void *user, GlintError *error);
