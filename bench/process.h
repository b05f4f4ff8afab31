/* SPDX-License-Identifier: MIT
 * Programs run as a user runs them: from start to exit, as a process of their own. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ProcessResult {
    double wall_seconds, cpu_seconds; /* start to exit; user and system of all threads */
    uint64_t peak_size;               /* resident bytes; at least those of this program */
    bool good;                        /* ended by itself with status 0 */
} ProcessResult;

/* Runs arguments[0] (a path) to its end. Its standard output and error replace the files; its
 * input is empty. A program that cannot be started is not good. */
ProcessResult process_run(char *const arguments[], const char *output_path, const char *error_path);

/* Calls the function in a process of its own, so that the memory it takes does not count as this
 * one's, and hands back what it left in result. False: it did not end well. */
typedef void (*ProcessFn)(const void *context, void *result);
bool process_call(ProcessFn function, const void *context, void *result, size_t size);

/* The path of a program in PATH. */
bool process_find(const char *name, char *path, size_t size);

/* A clock that only goes forward. */
double process_seconds(void);
