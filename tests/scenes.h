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

/* A scene without anything, for two threads, and one for all that needs a few lines of XML. */
GlintScene *new_scene(void);
extern const char *const small_scene;
GlintStatus load_text(GlintScene *scene, const char *xml, GlintError *error);

/* XML of many surfaces, so that every phase lasts. Freed by the caller. */
char *large_text(int count);

/* A source for glint_scene_load_stream: at most `step` bytes at once (0: all that are wanted), and
 * it fails when `fail_at` bytes are read. */
typedef struct Stream {
    const char *text;
    size_t at, size, step, fail_at;
} Stream;
int64_t read_stream(void *user, void *buffer, size_t size);

/* desc null: the whole picture in the scene's size. */
Picture picture_of_scene(GlintScene *scene, const GlintRenderDesc *desc);
Picture picture_of_text(const char *xml);
void picture_free(Picture *picture);

/* Column from the left, row from the top. */
GiVec picture_at(const Picture *picture, int x, int y);
bool picture_equal(const Picture *a, const Picture *b);

/* To the precision of float; `what` is for the message. */
void check_color(
    const char *file, int line, const char *what, GiVec actual, double r, double g, double b);
#define CHECK_COLOR(what, actual, r, g, b) check_color(__FILE__, __LINE__, what, actual, r, g, b)

/* 64-bit FNV-1a. */
uint64_t hash_bytes(const void *bytes, size_t size);
