/* SPDX-License-Identifier: MIT
 * The public functions of scene files as text: they check arguments and call src/format. */
#include "base/cookie.h"
#include "base/error.h"
#include "format/layout.h"
#include "port/file.h"
#include "port/machine.h"

#include <string.h>

#define ARGUMENT(error, ...) gi_error_set((error), GLINT_ERROR_ARGUMENT, __VA_ARGS__)

GlintFormatDesc glint_format_desc_default(void) { return (GlintFormatDesc){.cookie = GI_COOKIE}; }

static void init_memory(GiMemory *memory, const GlintAllocator *allocator) {
    gi_memory_init(memory, allocator, gi_machine_memory() / 10 * 9);
}

static GlintStatus hand_out(GiSpan bytes, GlintSinkFn sink, void *user, GlintError *error) {
    if (sink(user, bytes.data, bytes.size)) return GLINT_OK;
    return gi_error_set(error, GLINT_ERROR_FILE, "the text could not be written");
}

GlintStatus glint_format(const void *bytes, size_t size, const char *name,
    const GlintFormatDesc *desc, GlintSinkFn sink, void *user, GlintError *error) {
    if ((bytes == NULL && size > 0) || name == NULL || desc == NULL || sink == NULL) {
        return ARGUMENT(error, "bytes, name, desc or sink is null");
    }
    if (desc->cookie != GI_COOKIE) {
        return ARGUMENT(error, "the desc was not made by glint_format_desc_default");
    }
    GiMemory memory;
    init_memory(&memory, desc->allocator);
    GiDocument document = {.memory = &memory};
    GiText text = {0};
    const GiDocumentSource source = {.bytes = bytes,
        .size = size,
        .name = name,
        .diagnostic = desc->diagnostic,
        .diagnostic_user = desc->diagnostic_user};
    GlintStatus status = gi_document_load(&document, &source, error);
    if (status == GLINT_OK && !gi_layout_write(&document, &text)) status = gi_error_memory(error);
    if (status == GLINT_OK) {
        status = hand_out((GiSpan){text.data, text.count}, sink, user, error);
    }
    gi_array_free(&memory, &text);
    gi_document_reset(&document);
    return status;
}

GlintStatus glint_file_save(const char *path, const void *bytes, size_t size, GlintError *error) {
    if (path == NULL || (bytes == NULL && size > 0)) {
        return ARGUMENT(error, "path or bytes is null");
    }
    GiFileWriter writer;
    GlintStatus status = gi_file_write_begin(&writer, path, error);
    if (status != GLINT_OK) return status;
    gi_file_write(&writer, bytes, size);
    return gi_file_write_commit(&writer, error);
}
