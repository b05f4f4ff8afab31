/* SPDX-License-Identifier: MIT
 * Loading a scene from text in memory, with its findings kept as text. For the tests of the
 * reader. */
#pragma once

#include "test.h"

#include "reader/reader.h"

#include <stdio.h>
#include <string.h>

/* Round the middle of a scene that is complete. */
#define BEGIN "<scene><camera/><image>4 2</image>"
#define END   "</scene>"

/* A source: text, then a filler repeated, then text again; so that huge files need no memory. */
typedef struct Input {
    const char *head, *filler, *tail;
    size_t head_size, filler_size, tail_size, filler_count, position;
    bool fails;
    const char *name; /* null: test.xml */
    int thread_count; /* 0: one */
    bool mapped;      /* head, which is all, and ends with a zero */
} Input;

static inline int64_t read_input(void *user, void *buffer, size_t size) {
    Input *input = user;
    char *out = buffer;
    size_t body = input->head_size + input->filler_size * input->filler_count, done = 0;
    if (input->fails) return -1;
    for (; done < size; done++, input->position++) {
        size_t p = input->position;
        if (p < input->head_size) {
            out[done] = input->head[p];
        } else if (p < body) {
            out[done] = input->filler[(p - input->head_size) % input->filler_size];
        } else if (p < body + input->tail_size) {
            out[done] = input->tail[p - body];
        } else {
            break;
        }
    }
    return (int64_t)done;
}

typedef struct Loaded {
    GiMemory memory;
    GiScene scene;
    GlintStatus status;
    GlintError error;
    char findings[20000]; /* "line:column: message\n" each */
    char printed[60000];  /* as glint_diagnostic_format has it */
    int count;
    size_t peak_extra; /* bytes in use at once beyond what the scene kept */
} Loaded;

static inline void on_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    Loaded *loaded = user;
    size_t length = strlen(loaded->findings), printed = strlen(loaded->printed);
    snprintf(loaded->findings + length, sizeof loaded->findings - length, "%lld:%lld: %s\n",
        (long long)diagnostic->line, (long long)diagnostic->column, diagnostic->message);
    glint_diagnostic_format(
        diagnostic, loaded->printed + printed, sizeof loaded->printed - printed);
    loaded->count++;
}

static Loaded loaded; /* one at a time */

static inline Loaded *load_by(Input input, size_t chunk_size, GlintDialect dialect,
    const GlintAllocator *allocator, bool expat_only) {
    memset(&loaded, 0, sizeof loaded);
    gi_memory_init(&loaded.memory, allocator, (size_t)4 << 30);
    if (!gi_scene_init(&loaded.scene, &loaded.memory)) {
        loaded.status = GLINT_ERROR_MEMORY;
        return &loaded;
    }
    GiFileBytes bytes = {.bytes = input.head, .size = input.head_size, .capacity = 1};
    GiReaderSource source = {.read = read_input,
        .user = &input,
        .mapped = input.mapped ? &bytes : NULL,
        .name = input.name != NULL ? input.name : "test.xml",
        .total_size = -1,
        .diagnostic = on_diagnostic,
        .diagnostic_user = &loaded,
        .dialect = dialect,
        .chunk_size = chunk_size,
        .thread_count = input.thread_count > 0 ? input.thread_count : 1,
        .expat_only = expat_only};
    loaded.status = gi_reader_load(&loaded.scene, &source, NULL, &loaded.error);
    loaded.peak_extra = loaded.memory.peak - loaded.memory.used;
    return &loaded;
}

static inline Loaded *load_input(
    Input input, size_t chunk_size, GlintDialect dialect, const GlintAllocator *allocator) {
    return load_by(input, chunk_size, dialect, allocator, false);
}

static inline Loaded *load_threaded(
    const char *bytes, size_t size, size_t chunk_size, int thread_count) {
    Input input = {.head = bytes, .head_size = size, .thread_count = thread_count};
    return load_input(input, chunk_size, GLINT_DIALECT_AUTO, NULL);
}

static inline Loaded *load_bytes(const char *bytes, size_t size, size_t chunk_size) {
    return load_threaded(bytes, size, chunk_size, 1);
}

static inline Loaded *load(const char *text) { return load_bytes(text, strlen(text), 0); }

static inline Loaded *load_filled(
    const char *head, const char *filler, size_t count, const char *tail) {
    /* Two threads: what is large enough for them is read by them. */
    Input input = {
        .head = head, .filler = filler, .tail = tail, .filler_count = count, .thread_count = 2};
    input.head_size = strlen(head);
    input.filler_size = strlen(filler);
    input.tail_size = strlen(tail);
    return load_input(input, 0, GLINT_DIALECT_AUTO, NULL);
}

static inline void unload(void) {
    gi_scene_reset(&loaded.scene);
    CHECK_INT(loaded.memory.used, 0);
}

/* Loads what stands between BEGIN and END, which must be right. */
static inline GiScene *good(const char *middle) {
    char text[4000];
    snprintf(text, sizeof text, "%s%s%s", BEGIN, middle, END);
    load(text);
    CHECK_INT(loaded.status, GLINT_OK);
    CHECK_TEXT(loaded.findings, "");
    return &loaded.scene;
}

static inline void check_vec(GiVec v, double x, double y, double z) {
    CHECK_NEAR(v.x, x, 0);
    CHECK_NEAR(v.y, y, 0);
    CHECK_NEAR(v.z, z, 0);
}
