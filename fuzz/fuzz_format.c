/* SPDX-License-Identifier: MIT
 * Lays out whatever the reader takes for a scene, and checks that laid out again it does not
 * change, and that the scene is taken for the same dialect and has as many surfaces. Upgraded from
 * some dialect it must be a scene with as many surfaces again, of which nothing is left to do. */
#include "format/layout.h"
#include "format/upgrade.h"

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
static bool load(
    GiMemory *memory, GiDocument *document, const void *bytes, size_t size, GlintDialect dialect) {
    *document = (GiDocument){.memory = memory};
    const GiDocumentSource source = {
        .bytes = bytes, .size = size, .name = "fuzz.xml", .dialect = dialect};
    GlintStatus status = gi_document_load(document, &source, NULL);
    require(status == GLINT_OK || status == GLINT_ERROR_SCENE, "another status");
    return status == GLINT_OK;
}

static void require_same(const GiDocument *first, const GiDocument *second) {
    require(first->scene.shape_count == second->scene.shape_count, "other surfaces");
    require(first->scene.lights.count == second->scene.lights.count, "other lights");
    require(first->scene.groups.count == second->scene.groups.count, "other groups");
}

static void lay_out(GiMemory *memory, const GiDocument *first) {
    GiDocument second;
    GiText once = {0}, twice = {0};
    require(gi_layout_write(first, &once), "no memory");
    bool good = load(memory, &second, once.data, once.count, GLINT_DIALECT_AUTO);
    require(good && gi_layout_write(&second, &twice), "no scene any more");
    bool same = once.count == twice.count && memcmp(once.data, twice.data, once.count) == 0;
    require(same, "laid out again it changes");
    require(first->scene.dialect == second.scene.dialect, "another dialect");
    require_same(first, &second);
    gi_document_reset(&second);
    gi_array_free(memory, &once);
    gi_array_free(memory, &twice);
}

static void on_change(void *user, const GlintChange *change) {
    int *counts = user;
    counts[change->kind]++;
    require(change->line > 0 && change->column > 0 && change->message[0] != '\0', "no change");
}

static void upgrade(GiMemory *memory, const void *bytes, size_t size, GlintDialect dialect) {
    GiDocument first, second;
    if (load(memory, &first, bytes, size, dialect)) {
        GiText once = {0}, twice = {0};
        int counts[3] = {0}, again[3] = {0};
        require(gi_upgrade_write(&first, on_change, counts, &once, NULL) == GLINT_OK, "memory");
        bool good = load(memory, &second, once.data, once.count, GLINT_DIALECT_AUTO);
        /* Numbers may overflow in another order, which is told. */
        require(good || counts[GLINT_CHANGE_DIFFERENT] > 0, "no scene any more");
        if (good) {
            require(second.scene.dialect == GLINT_DIALECT_GLINT, "not upgraded");
            require_same(&first, &second);
            require(
                gi_upgrade_write(&second, on_change, again, &twice, NULL) == GLINT_OK, "memory");
            require(again[0] + again[1] + again[2] == 0, "something is left to do");
        }
        gi_document_reset(&second);
        gi_array_free(memory, &once);
        gi_array_free(memory, &twice);
    }
    gi_document_reset(&first);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    GiMemory memory;
    GiDocument document;
    gi_memory_init(&memory, NULL, (size_t)1 << 30);
    if (load(&memory, &document, data, size, GLINT_DIALECT_AUTO)) lay_out(&memory, &document);
    gi_document_reset(&document);
    upgrade(&memory, data, size, (GlintDialect)(size % GLINT_DIALECT_COUNT));
    require(memory.used == 0, "memory is left");
    return 0;
}
