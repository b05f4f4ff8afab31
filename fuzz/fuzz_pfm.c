/* SPDX-License-Identifier: MIT
 * Feeds bytes to the reader of PFM pictures, whole and in small pieces, with and without the size
 * of the file, and checks that all give the same outcome, that the picture is in the bytes and that
 * no memory is left. */
#include "image/pfm_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Input {
    const uint8_t *data;
    size_t size, position, piece;
} Input;

static int64_t read_input(void *user, void *buffer, size_t size) {
    Input *input = user;
    size_t left = input->size - input->position;
    if (size > left) size = left;
    if (size > input->piece) size = input->piece;
    memcpy(buffer, input->data + input->position, size);
    input->position += size;
    return (int64_t)size;
}

static void require(bool condition, const char *what) {
    if (condition) return;
    fprintf(stderr, "fuzz_pfm: %s\n", what);
    abort();
}

/* The pixels are the last that was read, in the machine's byte order (little-endian here). */
static void check_picture(const GiPfm *pfm, const Input *input) {
    size_t size = (size_t)pfm->width * (size_t)pfm->height * 3 * sizeof(float);
    require(pfm->width > 0 && pfm->height > 0, "a side of a picture is not positive");
    require(size <= input->position, "a picture is larger than what was read");
    require(memcmp(pfm->pixels, input->data + input->position - size, size) == 0, "other pixels");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const size_t pieces[] = {SIZE_MAX, 1, 7};
    GlintStatus first = GLINT_OK;
    for (int i = 0; i < 6; i++) {
        Input input = {.data = data, .size = size, .piece = pieces[i / 2]};
        bool size_known = i % 2 == 0;
        GiMemory memory;
        GiPfm pfm;
        GlintError error = {.status = GLINT_OK};
        /* Without the size a header that lies is believed until memory is short. */
        gi_memory_init(&memory, NULL, (size_t)1 << 20);
        GlintStatus status =
            gi_pfm_read(&pfm, &memory, read_input, &input, size_known ? (int64_t)size : -1, &error);
        if (status == GLINT_OK) {
            check_picture(&pfm, &input);
            gi_pfm_free(&pfm, &memory);
        } else {
            require(error.status == status && error.message[0] != '\0', "an error says nothing");
        }
        require(memory.used == 0, "memory is left");
        require(pfm.pixels == NULL, "a picture is left");
        if (i == 0) first = status;
        bool short_of_memory = !size_known && status == GLINT_ERROR_MEMORY;
        require(status == first || short_of_memory, "the outcome depends on the pieces");
    }
    return 0;
}
