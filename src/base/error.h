/* SPDX-License-Identifier: MIT
 * Filling a GlintError. */
#pragma once

#include "glint/glint.h"

#if defined(__GNUC__)
#define GI_PRINTF(format_index, first_index)                                                       \
    __attribute__((format(printf, format_index, first_index)))
#else
#define GI_PRINTF(format_index, first_index)
#endif

/* Sets status and message of *error (when it is not null) and returns status, so that a failing
 * function can end with `return gi_error_set(...)`. */
GI_PRINTF(3, 4)
GlintStatus gi_error_set(GlintError *error, GlintStatus status, const char *format, ...);

/* The same with a path; what does not fit loses its beginning, since the end tells more. */
GI_PRINTF(4, 5)
GlintStatus gi_error_set_path(
    GlintError *error, GlintStatus status, const char *path, const char *format, ...);

/* The usual message for GLINT_ERROR_MEMORY. */
GlintStatus gi_error_memory(GlintError *error);
