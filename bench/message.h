/* SPDX-License-Identifier: MIT
 * Text for people and for the system. */
#pragma once

#include <stddef.h>

/* "glint-bench", unless the program says otherwise. */
extern const char *message_program;

/* "glint-bench: ..." on standard error, then the program ends with 1. */
_Noreturn void message_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Like snprintf, but a text that does not fit ends the program: half a path is a wrong path. */
void message_format(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Copies a text file to standard error, for what a program said before it failed. */
void message_show_file(const char *path);
