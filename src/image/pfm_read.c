/* SPDX-License-Identifier: MIT
 * The header is read byte by byte, since what follows its last white space is data already; the
 * data go straight to where they stay, and are put into the machine's byte order there. */
#include "image/pfm_read.h"

#include "base/error.h"

#include <string.h>

enum { PIXEL_LIMIT = 1 << 28, TOKEN_SIZE = 64 };

typedef struct Input {
    GlintReadFn read;
    void *user;
    int64_t position;
    GlintError *error;
} Input;

static GlintStatus fault(const Input *input, const char *message) {
    return gi_error_set(input->error, GLINT_ERROR_FILE, "%s", message);
}

static GlintStatus fill(Input *input, void *buffer, size_t size) {
    for (size_t done = 0; done < size;) {
        int64_t count = input->read(input->user, (char *)buffer + done, size - done);
        if (count < 0) return fault(input, "the picture cannot be read");
        if (count == 0) return fault(input, "the picture ends too early");
        done += (size_t)count;
        input->position += count;
    }
    return GLINT_OK;
}

/* ---------------------------------------------------------------- header */

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* The next word, and the white space that ends it: one character, or CR and LF. */
static GlintStatus next_token(Input *input, char token[TOKEN_SIZE]) {
    int length = 0;
    for (;;) {
        char c;
        GlintStatus status = fill(input, &c, 1);
        if (status != GLINT_OK) return status;
        if (!is_space(c)) {
            if (length == TOKEN_SIZE - 1)
                return fault(input, "the header of the picture is broken");
            token[length++] = c;
        } else if (length > 0) {
            token[length] = '\0';
            return c == '\r' ? fill(input, &c, 1) : GLINT_OK;
        }
    }
}

static GlintStatus read_side(Input *input, int *side) {
    char token[TOKEN_SIZE];
    GlintStatus status = next_token(input, token);
    if (status != GLINT_OK) return status;
    int64_t value = 0;
    for (const char *c = token; *c != '\0'; c++) {
        if (*c < '0' || *c > '9') return fault(input, "width or height is not a number");
        value = 10 * value + (*c - '0');
        if (value > PIXEL_LIMIT) return fault(input, "the picture has more than 2^28 pixels");
    }
    if (value == 0) return fault(input, "width or height is zero");
    *side = (int)value;
    return GLINT_OK;
}

static GlintStatus read_header(Input *input, GiPfm *pfm) {
    char token[TOKEN_SIZE];
    char magic[3] = "";
    GlintStatus status = fill(input, magic, 2);
    if (status != GLINT_OK) return status;
    if (strcmp(magic, "Pf") == 0) return fault(input, "the PFM picture has no colour (\"Pf\")");
    if (strcmp(magic, "PF") != 0) return fault(input, "this is not a PFM picture");
    status = read_side(input, &pfm->width);
    if (status == GLINT_OK) status = read_side(input, &pfm->height);
    if (status == GLINT_OK) status = next_token(input, token);
    if (status == GLINT_OK && pfm->width > PIXEL_LIMIT / pfm->height) {
        status = fault(input, "the picture has more than 2^28 pixels");
    }
    return status;
}

/* ---------------------------------------------------------------- data */

static size_t data_size(const GiPfm *pfm) {
    return (size_t)pfm->width * (size_t)pfm->height * 3 * sizeof(float);
}

static void decode(float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint8_t from[4];
        memcpy(from, &values[i], 4);
        uint32_t bits =
            from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24;
        memcpy(&values[i], &bits, 4);
    }
}

GlintStatus gi_pfm_read(GiPfm *pfm, GiMemory *memory, GlintReadFn read, void *user,
    int64_t total_size, GlintError *error) {
    Input input = {.read = read, .user = user, .error = error};
    *pfm = (GiPfm){0};
    GlintStatus status = read_header(&input, pfm);
    if (status != GLINT_OK) return status;
    size_t size = data_size(pfm);
    if (total_size >= 0 && (int64_t)size > total_size - input.position) {
        return fault(&input, "the picture ends too early");
    }
    pfm->pixels = gi_memory_allocate(memory, size);
    if (pfm->pixels == NULL) return gi_error_memory(error);
    status = fill(&input, pfm->pixels, size);
    if (status == GLINT_OK) {
        decode(pfm->pixels, size / sizeof(float));
    } else {
        gi_pfm_free(pfm, memory);
    }
    return status;
}

void gi_pfm_free(GiPfm *pfm, GiMemory *memory) {
    gi_memory_free(memory, pfm->pixels, data_size(pfm));
    *pfm = (GiPfm){0};
}
