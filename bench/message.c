/* SPDX-License-Identifier: MIT */
#include "message.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

const char *message_program = "glint-bench";

void message_fail(const char *format, ...) {
    va_list arguments;
    fflush(stdout);
    fprintf(stderr, "%s: ", message_program);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(1);
}

void message_format(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= size) message_fail("a path is too long: %s", text);
}

void message_show_file(const char *path) {
    FILE *file = fopen(path, "r");
    if (file == NULL) return;
    char text[1024];
    size_t length;
    while ((length = fread(text, 1, sizeof text, file)) > 0) fwrite(text, 1, length, stderr);
    fclose(file);
}
