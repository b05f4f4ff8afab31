/* SPDX-License-Identifier: MIT
 * Lays out whatever the reader takes for a scene, and checks that laid out again it does not
 * change, and that the scene is taken for the same dialect and has as many surfaces. */
#include "format/layout.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require(bool condition, const char *what) {
    if (condition) return;
    fprintf(stderr, "fuzz_format: %s\n", what);
    abort();
}

/* False when the reader refuses it. */
static bool lay_out(
    GiMemory *memory, GiDocument *document, const void *bytes, size_t size, GiText *text) {
    *document = (GiDocument){.memory = memory};
    const GiDocumentSource source = {.bytes = bytes, .size = size, .name = "fuzz.xml"};
    GlintStatus status = gi_document_load(document, &source, NULL);
    require(status == GLINT_OK || status == GLINT_ERROR_SCENE, "another status");
    if (status == GLINT_OK) require(gi_layout_write(document, text), "no memory");
    return status == GLINT_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    GiMemory memory;
    GiDocument first, second;
    GiText once = {0}, twice = {0};
    gi_memory_init(&memory, NULL, (size_t)1 << 30);
    if (lay_out(&memory, &first, data, size, &once)) {
        require(lay_out(&memory, &second, once.data, once.count, &twice), "no scene any more");
        bool same = once.count == twice.count && memcmp(once.data, twice.data, once.count) == 0;
        require(same, "laid out again it changes");
        require(first.scene.dialect == second.scene.dialect, "another dialect");
        require(first.scene.shape_count == second.scene.shape_count, "other surfaces");
        require(first.scene.lights.count == second.scene.lights.count, "other lights");
        gi_document_reset(&second);
    }
    gi_document_reset(&first);
    gi_array_free(&memory, &once);
    gi_array_free(&memory, &twice);
    require(memory.used == 0, "memory is left");
    return 0;
}
