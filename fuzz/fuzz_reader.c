/* SPDX-License-Identifier: MIT
 * Feeds bytes to the reader, whole and in small chunks, and to expat alone, and checks that all
 * give the same outcome, that every finding is well formed and that no memory is left. clang
 * -fsanitize=fuzzer,address,undefined -Iinclude -Isrc fuzz/fuzz_reader.c ... -lexpat -lm */
#include "reader/reader.h"

#include <expat.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Input {
    const uint8_t *data;
    size_t size, position;
    uint32_t hash; /* of the findings */
    int64_t count;
} Input;

static int64_t read_input(void *user, void *buffer, size_t size) {
    Input *input = user;
    size_t left = input->size - input->position;
    if (size > left) size = left;
    memcpy(buffer, input->data + input->position, size);
    input->position += size;
    return (int64_t)size;
}

static void require(bool condition, const char *what) {
    if (condition) return;
    fprintf(stderr, "fuzz_reader: %s\n", what);
    abort();
}

static void on_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    Input *input = user;
    char text[2048];
    size_t length = glint_diagnostic_format(diagnostic, text, sizeof text);
    require(length < sizeof text, "a diagnostic is too long");
    require(diagnostic->message[0] != '\0', "a diagnostic says nothing");
    require((diagnostic->line > 0) == (diagnostic->column > 0), "line without column");
    for (const char *p = text; *p != '\0'; p++) {
        input->hash = (input->hash ^ (uint8_t)*p) * UINT32_C(16777619);
    }
    input->count++;
}

static GlintStatus load(
    Input *input, size_t chunk_size, bool expat_only, GiMemory *memory, GiScene *scene) {
    /* The last is read as a large file is: mapped, a copy with a zero behind it here. */
    char *copy = NULL;
    GiFileBytes bytes = {.capacity = 1};
    if (chunk_size == 300) {
        copy = malloc(input->size + 1);
        require(copy != NULL, "no memory for a copy");
        if (input->size > 0) memcpy(copy, input->data, input->size);
        copy[input->size] = '\0';
        bytes.bytes = copy;
        bytes.size = input->size;
    }
    GiReaderSource source = {.read = read_input,
        .user = input,
        .mapped = copy != NULL ? &bytes : NULL,
        .name = "fuzz.xml",
        .total_size = -1,
        .diagnostic = on_diagnostic,
        .diagnostic_user = input,
        .chunk_size = chunk_size,
        .thread_count = chunk_size == 7 || chunk_size == 300 ? 2 : 1,
        .without_files = true,
        .expat_only = expat_only};
    GlintError error = {.status = GLINT_OK};
    gi_memory_init(memory, NULL, (size_t)1 << 30);
    require(gi_scene_init(scene, memory), "no memory for a scene");
    GlintStatus status = gi_reader_load(scene, &source, NULL, &error);
    free(copy);
    if (status == GLINT_OK) {
        require(scene->has_camera && scene->has_image, "a good scene without camera or image");
        require(scene->dialect != GLINT_DIALECT_AUTO, "a good scene without dialect");
        require(input->count == 0, "a good scene with findings");
    } else {
        require(error.status == status && error.message[0] != '\0', "an error without a message");
        require(status != GLINT_ERROR_SCENE || input->count > 0, "an error without a finding");
    }
    return status;
}

/* In malformed text expat may or may not hand out the last piece before the place of the error,
 * depending on the chunks; only the outcome is compared then. */
static bool is_well_formed(const uint8_t *data, size_t size) {
    XML_Parser parser = XML_ParserCreate(NULL);
    bool good = XML_Parse(parser, (const char *)data, (int)size, 1) == XML_STATUS_OK;
    XML_ParserFree(parser);
    return good;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const size_t chunk_sizes[] = {0, 0, 1, 7, 300};
    bool compare_all = true;
    GlintStatus first_status = GLINT_OK;
    uint32_t first_hash = 0, first_shapes = 0;
    for (int i = 0; i < 5; i++) {
        Input input = {.data = data, .size = size};
        GiMemory memory;
        GiScene scene;
        GlintStatus status = load(&input, chunk_sizes[i], i == 0, &memory, &scene);
        uint32_t shapes = scene.shape_count;
        gi_scene_reset(&scene);
        require(memory.used == 0, "memory is left");
        if (i == 0) {
            first_status = status;
            first_hash = input.hash;
            first_shapes = shapes;
        }
        require(status == first_status, "the outcome depends on the chunk size");
        if (i == 1) {
            require(shapes == first_shapes, "the shapes depend on the scanner");
            require(input.hash == first_hash, "the findings depend on the scanner");
        }
        if (i == 1 && !is_well_formed(data, size)) compare_all = false;
        if (!compare_all) continue;
        require(shapes == first_shapes, "the shapes depend on the chunk size");
        require(input.hash == first_hash, "the findings depend on the chunk size");
    }
    return 0;
}
