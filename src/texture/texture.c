/* SPDX-License-Identifier: MIT
 * Reading goes in three steps: the file to memory, its format to a module, the module's pixels to
 * memory of ours. */
#include "texture/texture.h"

#include "base/error.h"
#include "port/file.h"
#include "port/module.h"
#include "texture/decoder.h"

#include <string.h>

/* ---------------------------------------------------------------- lookup */

/* The pixel at `place`, counted in pixels. What is no number is in the first. */
static int index_of(double place, int count, GiWrap wrap) {
    double whole = place < 0 ? -floor(-place) : floor(place); /* toward zero */
    if (wrap == GI_WRAP_REPEAT) {
        whole -= count * floor(whole / count);
    } else if (whole > count - 1) {
        whole = count - 1;
    }
    return whole >= 0 && whole < count ? (int)whole : 0;
}

GiVec gi_texture_color(const GiPicture *picture, GiWrap wrap, double u, double v) {
    int x = index_of(u * picture->width + 0.5, picture->width, wrap);
    int y = index_of((1 - v) * picture->height + 0.5, picture->height, wrap);
    const uint8_t *rgb = picture->rgb + 3 * ((size_t)y * (size_t)picture->width + (size_t)x);
    return gi_vec(rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
}

/* ---------------------------------------------------------------- files */

typedef struct Bytes {
    uint8_t *data;
    size_t size, capacity;
} Bytes;

/* The end of a file is where reading says so, whatever size the system tells. */
static GlintStatus read_file(Bytes *bytes, GiMemory *memory, const char *path, GlintError *error) {
    GiFileReader file;
    GlintStatus status = gi_file_read_open(&file, path, error);
    if (status != GLINT_OK) return status;
    int64_t count = file.size > 0 ? file.size : 1 << 16;
    do {
        if (bytes->size == bytes->capacity) {
            size_t more = bytes->capacity > 0 ? 2 * bytes->capacity : (size_t)count + 1;
            void *grown = gi_memory_resize(memory, bytes->data, bytes->capacity, more);
            if (grown == NULL) {
                status = gi_error_memory(error);
                break;
            }
            bytes->data = grown;
            bytes->capacity = more;
        }
        count = gi_file_read(&file, bytes->data + bytes->size, bytes->capacity - bytes->size);
        if (count > 0) bytes->size += (size_t)count;
    } while (count > 0);
    if (status == GLINT_OK) status = gi_file_read_status(&file, error);
    gi_file_read_close(&file);
    return status;
}

/* ---------------------------------------------------------------- modules */

typedef struct Format {
    const char *module, *purpose, *magic;
} Format;

static const Format formats[] = {
    {"png", "read PNG pictures", "\x89PNG"},
    {"jpeg", "read JPEG pictures", "\xff\xd8\xff"},
};

static const Format *format_of(const void *bytes, size_t size) {
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        size_t length = strlen(formats[i].magic);
        if (size >= length && memcmp(bytes, formats[i].magic, length) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

typedef struct Target {
    GiPicture *picture;
    GiMemory *memory;
} Target;

static size_t picture_size(const GiPicture *picture) {
    return (size_t)picture->width * (size_t)picture->height * 3;
}

static uint8_t *begin_picture(void *user, int width, int height) {
    Target *target = user;
    GiPicture picture = {.width = width, .height = height};
    picture.rgb = gi_memory_allocate(target->memory, picture_size(&picture));
    if (picture.rgb != NULL) *target->picture = picture;
    return picture.rgb;
}

GlintStatus gi_picture_decode(
    GiPicture *picture, GiMemory *memory, const void *bytes, size_t size, GlintError *error) {
    const Format *format = format_of(bytes, size);
    *picture = (GiPicture){0};
    if (format == NULL) {
        return gi_error_set(error, GLINT_ERROR_FILE, "this is neither a PNG nor a JPEG picture");
    }
    GiModule module;
    GlintStatus status =
        gi_module_open(&module, format->module, GI_DECODER_SYMBOL, format->purpose, error);
    if (status != GLINT_OK) return status;
    const GiDecoder *decoder = module.interface;
    if (decoder->version == GI_DECODER_VERSION) {
        char message[200] = "";
        Target target = {picture, memory};
        GiDecoderTarget there = {begin_picture, &target, message, sizeof message};
        status = decoder->decode(bytes, size, &there);
        if (status == GLINT_ERROR_MEMORY) gi_error_memory(error);
        if (status == GLINT_ERROR_FILE) gi_error_set(error, status, "%s", message);
    } else {
        status = gi_error_set(error, GLINT_ERROR_FILE,
            "Glint cannot %s: its module is of another version", format->purpose);
    }
    gi_module_close(&module);
    if (status != GLINT_OK) gi_picture_free(picture, memory);
    return status;
}

GlintStatus gi_picture_load(
    GiPicture *picture, GiMemory *memory, const char *path, GlintError *error) {
    Bytes bytes = {0};
    GlintError reason = {.status = GLINT_OK};
    *picture = (GiPicture){0};
    GlintStatus status = read_file(&bytes, memory, path, error);
    if (status == GLINT_OK) {
        status = gi_picture_decode(picture, memory, bytes.data, bytes.size, &reason);
        if (status != GLINT_OK) gi_error_set_path(error, status, path, "%s", reason.message);
    }
    gi_memory_free(memory, bytes.data, bytes.capacity);
    return status;
}

void gi_picture_free(GiPicture *picture, GiMemory *memory) {
    gi_memory_free(memory, picture->rgb, picture_size(picture));
    *picture = (GiPicture){0};
}
