/* SPDX-License-Identifier: MIT
 * Scenes from text and pictures of them, for tests that look at the library from outside. */
#pragma once

#include "glint/glint.h"

#include "math/vec.h"

/* Whether golden hashes are to be written instead of compared (glint-tests --update-golden). */
bool test_update_golden(void);

typedef struct Picture {
    int width, height;
    float *pixels; /* from malloc; null when drawing failed */
} Picture;

/* A committed scene, or null; a failure is a failure of the test. isa null: the fastest. */
GlintScene *scene_from_text(const char *xml, const char *isa, int thread_count);
GlintScene *scene_from_file(const char *path, const char *isa, int thread_count);

/* desc null: the whole picture in the scene's size. */
Picture picture_of_scene(GlintScene *scene, const GlintRenderDesc *desc);
Picture picture_of_text(const char *xml);
void picture_free(Picture *picture);

/* Column from the left, row from the top. */
GiVec picture_at(const Picture *picture, int x, int y);
bool picture_equal(const Picture *a, const Picture *b);

/* 64-bit FNV-1a. */
uint64_t hash_bytes(const void *bytes, size_t size);
