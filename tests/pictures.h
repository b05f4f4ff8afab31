/* SPDX-License-Identifier: MIT
 * A picture to write and files to write it to, for the tests of pictures and files. */
#pragma once

#include "glint/glint.h"

/* Something of everything: smooth, flat, noise, values out of range. Freed by the caller. */
GlintImage make_image(int width, int height, uint32_t seed);
uint32_t next_random(uint32_t *state);

typedef struct Bytes {
    uint8_t *data;
    size_t size, capacity;
    size_t limit; /* refuse to grow beyond; 0: none */
} Bytes;

/* A sink that appends to a Bytes. */
bool collect(void *user, const void *bytes, size_t size);

Bytes read_whole(const char *path);

/* An empty folder of its own for each test, so that what is left in it can be counted. */
const char *make_folder(const char *name);
int count_entries(const char *folder);
