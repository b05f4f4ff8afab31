/* SPDX-License-Identifier: MIT */
#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static GlintStatus set(GlintError *error, GlintStatus status, const char *path, const char *format,
    va_list arguments) {
    if (error == NULL) return status;
    memset(error, 0, sizeof *error);
    error->status = status;
    vsnprintf(error->message, sizeof error->message, format, arguments);
    if (path != NULL) {
        size_t length = strlen(path);
        size_t room = sizeof error->path - 1;
        const char *from = length > room ? path + (length - room) : path;
        memcpy(error->path, from, strlen(from) + 1);
    }
    return status;
}

GlintStatus gi_error_set(GlintError *error, GlintStatus status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, status, NULL, format, arguments);
    va_end(arguments);
    return status;
}

GlintStatus gi_error_set_path(
    GlintError *error, GlintStatus status, const char *path, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, status, path, format, arguments);
    va_end(arguments);
    return status;
}

GlintStatus gi_error_memory(GlintError *error) {
    return gi_error_set(error, GLINT_ERROR_MEMORY, "not enough memory");
}
