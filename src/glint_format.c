/* SPDX-License-Identifier: MIT
 * The public functions of scene files as text, which call src/format, and of what may stand in
 * them, which show the tables of the reader. */
#include "base/cookie.h"
#include "base/error.h"
#include "format/layout.h"
#include "format/upgrade.h"
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

GlintUpgradeDesc glint_upgrade_desc_default(void) {
    return (GlintUpgradeDesc){.dialect = GLINT_DIALECT_AUTO, .cookie = GI_COOKIE};
}

GlintStatus glint_upgrade(const void *bytes, size_t size, const char *name,
    const GlintUpgradeDesc *desc, GlintSinkFn sink, void *user, GlintDialect *dialect,
    GlintError *error) {
    if ((bytes == NULL && size > 0) || name == NULL || desc == NULL || sink == NULL) {
        return ARGUMENT(error, "bytes, name, desc or sink is null");
    }
    if (desc->cookie != GI_COOKIE) {
        return ARGUMENT(error, "the desc was not made by glint_upgrade_desc_default");
    }
    if ((unsigned)desc->dialect >= GLINT_DIALECT_COUNT) return ARGUMENT(error, "no such dialect");
    GiMemory memory;
    init_memory(&memory, desc->allocator);
    GiDocument document = {.memory = &memory};
    GiText text = {0};
    const GiDocumentSource source = {.bytes = bytes,
        .size = size,
        .name = name,
        .dialect = desc->dialect,
        .diagnostic = desc->diagnostic,
        .diagnostic_user = desc->diagnostic_user};
    GlintStatus status = gi_document_load(&document, &source, error);
    if (status == GLINT_OK && dialect != NULL) *dialect = document.scene.dialect;
    if (status == GLINT_OK) {
        status = gi_upgrade_write(&document, desc->change, desc->change_user, &text, error);
    }
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

/* ---------------------------------------------------------------- tables */

_Static_assert((int)GLINT_ELEMENT_NUMBER == GI_KIND_REAL &&
                   (int)GLINT_ELEMENT_SCENE == GI_KIND_SCENE &&
                   (int)GLINT_ELEMENT_INTEGRATOR == GI_KIND_INTEGRATOR,
    "the public kinds are the reader's");
_Static_assert((int)GLINT_RANGE_POSITIVE == GI_CHECK_POSITIVE &&
                   (int)GLINT_RANGE_ANGLE == GI_CHECK_ANGLE &&
                   (int)GLINT_RANGE_PIXELS == GI_CHECK_IMAGE_SIZE,
    "the public ranges are the reader's");

/* Whether an index lies before the null name that ends a table. */
static bool has_element(int index) {
    for (int i = 0; i <= index; i++) {
        if (gi_elements[i].name == NULL) return false;
    }
    return index >= 0;
}

static bool has_type(int index) {
    for (int i = 0; i <= index; i++) {
        if (gi_types[i].name == NULL) return false;
    }
    return index >= 0;
}

bool glint_element_at(int index, GlintElement *element) {
    if (!has_element(index)) return false;
    const GiElement *row = &gi_elements[index];
    *element = (GlintElement){.name = row->name,
        .kind = (GlintElementKind)row->kind,
        .range = (GlintElementRange)row->check,
        .required = row->required,
        .default_text = row->default_text,
        .example = row->example != NULL ? row->example : row->default_text,
        .choices = row->choices,
        .alias_of = row->alias_of,
        .default_type = row->type,
        .years = row->years,
        .help = row->help};
    return true;
}

bool glint_element_type_at(int index, GlintElementType *type) {
    if (!has_type(index)) return false;
    const GiType *row = &gi_types[index];
    *type = (GlintElementType){.name = row->name,
        .kind = (GlintElementKind)row->kind,
        .alias_of = row->alias_of,
        .years = row->years,
        .help = row->help};
    return true;
}

bool glint_element_fits(int element, int type) {
    if (!has_element(element) || (type != -1 && !has_type(type))) return false;
    GiContexts place = type == -1 ? GI_IN_SCENE : gi_types[type].context;
    return (gi_elements[element].contexts & place) != 0;
}

const char *glint_element_kind_text(GlintElementKind kind) { return gi_kind_text((GiKind)kind); }

const char *glint_element_range_text(GlintElementRange range) {
    switch (range) {
    case GLINT_RANGE_ANY: break;
    case GLINT_RANGE_POSITIVE: return "greater than 0";
    case GLINT_RANGE_SAMPLES: return "0 to 65536";
    case GLINT_RANGE_NOT_ZERO: return "not 0 0 0";
    case GLINT_RANGE_NO_ZEROS: return "no number 0";
    case GLINT_RANGE_ANGLE: return "greater than 0, less than 180";
    case GLINT_RANGE_BIT: return "0 or 1";
    case GLINT_RANGE_DEPTH: return "1 to 4096";
    case GLINT_RANGE_PIXELS: return "each at least 1, together at most 2^28";
    }
    return NULL;
}
