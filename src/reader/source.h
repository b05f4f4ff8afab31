/* SPDX-License-Identifier: MIT
 * Where the objects of a scene stand in its file. Drawing needs none of it, so it is kept only when
 * asked for: then the whole file stays in memory, with an offset for each object. */
#pragma once

#include "base/array.h"
#include "glint/glint.h"
#include "reader/window.h"

typedef struct GiSource {
    int64_t offset; /* of its `<` */
    uint32_t name;  /* into names */
} GiSource;

typedef struct GiSources {
    GiMemory *memory;
    GiWindow window; /* the file, from its first byte to its last */
    GI_ARRAY(char) path;
    GI_ARRAY(char) names; /* each with its zero; the first is empty */
    GI_ARRAY(GiSource) objects[GLINT_OBJECT_KIND_COUNT]; /* in the order of their ids */
    GI_ARRAY(int64_t) idle; /* offsets of shaders that nothing has and nothing can refer to */
    int64_t root;           /* offset of `<scene` */
    unsigned evidence;      /* a set of GiEvidence */
    bool guessed;           /* the dialect is what the evidence points to, and nobody said it */
} GiSources;

/* False when memory is short; *sources can be reset all the same. */
bool gi_sources_init(GiSources *sources, GiMemory *memory, const char *path);
void gi_sources_reset(GiSources *sources);

/* The next object of a kind. False when memory is short. */
bool gi_sources_add(GiSources *sources, GlintObjectKind kind, int64_t offset, const char *name);

/* The place of the object with this id (from 1); false: none is kept. The strings in *source live
 * as long as *sources. */
bool gi_sources_find(
    GiSources *sources, GlintObjectKind kind, uint32_t index1, GlintSource *source);

/* Where the object's start tag begins, or -1. */
int64_t gi_sources_offset(const GiSources *sources, GlintObjectKind kind, uint32_t index1);

/* Points a finding at the start tag at an offset, with its line as the excerpt, which is put into
 * buffer. */
void gi_sources_point_at(
    GiSources *sources, int64_t offset, char buffer[GI_EXCERPT_SIZE], GlintDiagnostic *diagnostic);

/* Turns the place of an object into a finding's, with its line as the excerpt, which is put into
 * buffer; the length of the caret is that of the start tag's name. An object without a place makes
 * the finding one of the whole file. */
void gi_sources_point(GiSources *sources, GlintObjectKind kind, uint32_t index1,
    char buffer[GI_EXCERPT_SIZE], GlintDiagnostic *diagnostic);
