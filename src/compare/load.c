/* SPDX-License-Identifier: MIT
 * The first bytes tell the format. Bytes of 8-bit pictures become the linear values that are
 * written as these bytes again: (byte / 255)^2.2. */
#include "compare/load.h"

#include "base/error.h"
#include "image/exr_reader.h"
#include "image/pfm_read.h"
#include "math/elementary.h"
#include "port/file.h"
#include "port/module.h"
#include "texture/texture.h"

#include <string.h>

typedef struct Loading {
    GiMemory *memory;
    const GiFileBytes *file;
    size_t position; /* of the next byte to read */
    int width, height;
    float *pixels;
} Loading;

static size_t size_of(const Loading *loading) {
    return (size_t)loading->width * (size_t)loading->height * 3 * sizeof(float);
}

static float *allocate(void *user, int width, int height) {
    Loading *loading = user;
    loading->width = width;
    loading->height = height;
    loading->pixels = gi_memory_allocate(loading->memory, size_of(loading));
    return loading->pixels;
}

/* ---------------------------------------------------------------- PFM */

static int64_t read_bytes(void *user, void *buffer, size_t size) {
    Loading *loading = user;
    size_t left = loading->file->size - loading->position;
    if (size > left) size = left;
    memcpy(buffer, loading->file->bytes + loading->position, size);
    loading->position += size;
    return (int64_t)size;
}

/* The third word of the header is a number whose sign tells the order of bytes. */
static bool is_big_endian(const GiFileBytes *file) {
    size_t i = 0;
    for (int word = 0; word < 3; word++) {
        while (i < file->size && strchr(" \t\r\n", file->bytes[i]) == NULL) i++;
        while (i < file->size && strchr(" \t\r\n", file->bytes[i]) != NULL) i++;
    }
    return i < file->size && file->bytes[i] != '-';
}

static void swap_bytes(float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        bits = bits << 24 | (bits & 0xff00) << 8 | (bits >> 8 & 0xff00) | bits >> 24;
        memcpy(&values[i], &bits, sizeof bits);
    }
}

/* The row that is stored first is the lowest. */
static GlintStatus load_pfm(Loading *loading, GlintError *error) {
    GiPfm pfm;
    GlintStatus status = gi_pfm_read(
        &pfm, loading->memory, read_bytes, loading, (int64_t)loading->file->size, error);
    if (status != GLINT_OK) return status;
    if (allocate(loading, pfm.width, pfm.height) != NULL) {
        size_t row = 3 * (size_t)pfm.width;
        for (int y = 0; y < pfm.height; y++) {
            memcpy(loading->pixels + row * (size_t)(pfm.height - 1 - y),
                pfm.pixels + row * (size_t)y, row * sizeof(float));
        }
        if (is_big_endian(loading->file)) swap_bytes(loading->pixels, row * (size_t)pfm.height);
    } else {
        status = gi_error_memory(error);
    }
    gi_pfm_free(&pfm, loading->memory);
    return status;
}

/* ---------------------------------------------------------------- EXR, PNG, JPEG */

static GlintStatus load_exr(Loading *loading, GlintError *error) {
    GiModule module;
    GlintStatus status =
        gi_module_open(&module, "exr", GI_EXR_READER_SYMBOL, "read EXR pictures", error);
    if (status != GLINT_OK) return status;
    const GiExrReader *reader = module.interface;
    if (reader->version == GI_EXR_READER_VERSION) {
        char message[200] = "";
        GiExrSource source = {
            loading->file->bytes, loading->file->size, allocate, loading, message, sizeof message};
        status = reader->read(&source);
        if (status == GLINT_ERROR_MEMORY) gi_error_memory(error);
        if (status == GLINT_ERROR_FILE) gi_error_set(error, status, "%s", message);
    } else {
        status = gi_error_set(error, GLINT_ERROR_FILE,
            "Glint cannot read EXR pictures: its module is of another version");
    }
    gi_module_close(&module);
    return status;
}

static GlintStatus load_bytes(Loading *loading, GlintError *error) {
    GiPicture picture;
    GlintStatus status = gi_picture_decode(
        &picture, loading->memory, loading->file->bytes, loading->file->size, error);
    if (status != GLINT_OK) return status;
    if (allocate(loading, picture.width, picture.height) != NULL) {
        float linear[256];
        for (int i = 0; i < 256; i++) linear[i] = (float)gi_pow(i / 255.0, 2.2);
        size_t count = size_of(loading) / sizeof(float);
        for (size_t i = 0; i < count; i++) loading->pixels[i] = linear[picture.rgb[i]];
    } else {
        status = gi_error_memory(error);
    }
    gi_picture_free(&picture, loading->memory);
    return status;
}

/* ---------------------------------------------------------------- the whole */

static bool begins_with(const GiFileBytes *file, const char *magic) {
    size_t length = strlen(magic);
    return file->size >= length && memcmp(file->bytes, magic, length) == 0;
}

GlintStatus gi_compare_load(GiMemory *memory, const char *path, int *width, int *height,
    float **pixels, GlintError *error) {
    GiFileBytes file;
    GlintStatus status = gi_file_bytes_load(&file, memory, path, NULL, error);
    if (status != GLINT_OK) return status;
    Loading loading = {.memory = memory, .file = &file};
    GlintError reason = {.status = GLINT_OK};
    if (begins_with(&file, "PF") || begins_with(&file, "Pf")) {
        status = load_pfm(&loading, &reason);
    } else if (begins_with(&file, "\x76\x2f\x31\x01")) {
        status = load_exr(&loading, &reason);
    } else {
        status = load_bytes(&loading, &reason);
    }
    gi_file_bytes_free(&file, memory);
    if (status == GLINT_OK) {
        *width = loading.width;
        *height = loading.height;
        *pixels = loading.pixels;
        return GLINT_OK;
    }
    gi_memory_free(memory, loading.pixels, size_of(&loading));
    return gi_error_set_path(error, status, path, "%s", reason.message);
}
