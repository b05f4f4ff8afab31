/* SPDX-License-Identifier: MIT */
#include "reader/source.h"

#include <string.h>

static bool append(GiMemory *memory, GiSources *sources, const char *name, uint32_t *index) {
    size_t first = sources->names.count;
    if (first + strlen(name) >= UINT32_MAX) return false;
    *index = (uint32_t)first;
    for (;; name++) {
        if (!gi_array_push(memory, &sources->names, *name)) return false;
        if (*name == '\0') return true;
    }
}

bool gi_sources_init(GiSources *sources, GiMemory *memory, const char *path) {
    memset(sources, 0, sizeof *sources);
    sources->memory = memory;
    gi_window_init(&sources->window, memory);
    for (;; path++) {
        if (!gi_array_push(memory, &sources->path, *path)) return false;
        if (*path == '\0') break;
    }
    uint32_t none;
    return append(memory, sources, "", &none);
}

void gi_sources_reset(GiSources *sources) {
    for (int kind = 0; kind < GLINT_OBJECT_KIND_COUNT; kind++) {
        gi_array_free(sources->memory, &sources->objects[kind]);
    }
    gi_array_free(sources->memory, &sources->idle);
    gi_array_free(sources->memory, &sources->names);
    gi_array_free(sources->memory, &sources->path);
    gi_window_reset(&sources->window);
}

bool gi_sources_add(GiSources *sources, GlintObjectKind kind, int64_t offset, const char *name) {
    GiSource source = {.offset = offset};
    if (name[0] != '\0' && !append(sources->memory, sources, name, &source.name)) return false;
    return gi_array_push(sources->memory, &sources->objects[kind], source);
}

static const GiSource *find(const GiSources *sources, GlintObjectKind kind, uint32_t index1) {
    if (index1 == 0 || index1 > sources->objects[kind].count) return NULL;
    return &sources->objects[kind].data[index1 - 1];
}

bool gi_sources_find(
    GiSources *sources, GlintObjectKind kind, uint32_t index1, GlintSource *source) {
    const GiSource *object = find(sources, kind, index1);
    if (object == NULL) return false;
    GiPlace place = {.offset = object->offset};
    gi_window_locate(&sources->window, &place);
    *source = (GlintSource){.path = sources->path.data,
        .name = sources->names.data + object->name,
        .line = place.line,
        .column = place.column};
    return true;
}

/* Characters of "<surface", up to what cannot be in a name. */
static int tag_length(const GiWindow *window, int64_t offset) {
    int unit = gi_window_unit(window), length = 1;
    for (;; length++) {
        unsigned letter = gi_window_at(window, offset + length * unit);
        if (letter <= ' ' || letter == '>' || letter == '/' || letter >= GI_WINDOW_END) break;
    }
    return length;
}

int64_t gi_sources_offset(const GiSources *sources, GlintObjectKind kind, uint32_t index1) {
    const GiSource *object = find(sources, kind, index1);
    return object != NULL ? object->offset : -1;
}

void gi_sources_point_at(
    GiSources *sources, int64_t offset, char buffer[GI_EXCERPT_SIZE], GlintDiagnostic *diagnostic) {
    GiPlace place = {.offset = offset};
    gi_window_locate(&sources->window, &place);
    diagnostic->path = sources->path.data;
    diagnostic->line = place.line;
    diagnostic->column = place.column;
    gi_window_excerpt(&sources->window, offset, buffer, &diagnostic->caret);
    diagnostic->excerpt = buffer;
    diagnostic->caret_length = tag_length(&sources->window, offset);
}

void gi_sources_point(GiSources *sources, GlintObjectKind kind, uint32_t index1,
    char buffer[GI_EXCERPT_SIZE], GlintDiagnostic *diagnostic) {
    diagnostic->path = sources->path.data;
    diagnostic->line = diagnostic->column = 0;
    diagnostic->excerpt = NULL;
    diagnostic->caret_length = 1;
    int64_t offset = gi_sources_offset(sources, kind, index1);
    if (offset >= 0) gi_sources_point_at(sources, offset, buffer, diagnostic);
}
