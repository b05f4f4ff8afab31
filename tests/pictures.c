/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* mkdir */
#include "pictures.h"

#include "port/file.h"
#include "test.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

uint32_t next_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

GlintImage make_image(int width, int height, uint32_t seed) {
    float *pixels = malloc(sizeof *pixels * 3 * (size_t)width * (size_t)height);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            for (int c = 0; c < 3; c++) {
                float noise = (float)next_random(&seed) / (1 << 24);
                float value = (float)(x + y) / (float)(width + height);
                if ((x / 50 + y / 30) % 3 == 1) value = 0.25f * (float)c;
                if ((x / 50 + y / 30) % 3 == 2) value = 1.4f * noise - 0.2f;
                pixels[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] = value;
            }
        }
    }
    pixels[0] = NAN;
    return (GlintImage){.width = width, .height = height, .pixels = pixels};
}

bool collect(void *user, const void *bytes, size_t size) {
    Bytes *to = user;
    if (to->limit != 0 && to->size + size > to->limit) return false;
    if (to->size + size > to->capacity) {
        to->capacity = 2 * (to->size + size);
        to->data = realloc(to->data, to->capacity);
    }
    memcpy(to->data + to->size, bytes, size);
    to->size += size;
    return true;
}

Bytes read_whole(const char *path) {
    Bytes bytes = {0};
    GiFileReader reader;
    GlintError error;
    if (gi_file_read_open(&reader, path, &error) != GLINT_OK) return bytes;
    uint8_t buffer[4096];
    int64_t count;
    while ((count = gi_file_read(&reader, buffer, sizeof buffer)) > 0) {
        collect(&bytes, buffer, (size_t)count);
    }
    CHECK_INT(gi_file_read_status(&reader, &error), GLINT_OK);
    CHECK_INT(reader.size, bytes.size);
    gi_file_read_close(&reader);
    return bytes;
}

const char *make_folder(const char *name) {
    static char path[512];
    snprintf(path, sizeof path, "%s/image-%s", test_scratch_dir(), name);
    CHECK_INT(mkdir(path, 0777), 0);
    return path;
}

int count_entries(const char *folder) {
    DIR *directory = opendir(folder);
    if (directory == NULL) return -1;
    int count = -2; /* . and .. */
    while (readdir(directory) != NULL) count++;
    closedir(directory);
    return count;
}
