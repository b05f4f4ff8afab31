/* SPDX-License-Identifier: MIT
 * The public functions for pictures: arguments are checked here, the work is done in png.c, pfm.c,
 * exr.c and gamma.c. */
#include "image/image.h"

#include "base/assert.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/memory.h"
#include "image/exr.h"
#include "image/pfm.h"
#include "image/png.h"
#include "math/gamma.h"
#include "port/file.h"

#include <string.h>

enum { PIXEL_LIMIT = 1 << 28 };

GlintSaveDesc glint_save_desc_default(void) { return (GlintSaveDesc){.cookie = GI_COOKIE}; }

static bool is_sound(const GlintImage *image) {
    return image != NULL && image->pixels != NULL && image->width >= 1 && image->height >= 1 &&
           image->width <= PIXEL_LIMIT / image->height;
}

GlintStatus gi_image_check_desc(const GlintSaveDesc *desc, GlintError *error) {
    const char *fault = NULL;
    if (desc == NULL || desc->cookie != GI_COOKIE) {
        fault = "the save desc was not made by glint_save_desc_default";
    } else if (desc->thread_count < 0) {
        fault = "thread_count is negative";
    }
    return fault == NULL ? GLINT_OK : gi_error_set(error, GLINT_ERROR_ARGUMENT, "%s", fault);
}

static GlintStatus check(const GlintImage *image, const GlintSaveDesc *desc, GlintError *error) {
    GlintStatus status = gi_image_check_desc(desc, error);
    if (status != GLINT_OK) return status;
    const char *fault = NULL;
    if (image == NULL || image->pixels == NULL) {
        fault = "there is no picture";
    } else if (!is_sound(image)) {
        fault = "width and height must be at least 1, their product at most 2^28";
    }
    return fault == NULL ? GLINT_OK : gi_error_set(error, GLINT_ERROR_ARGUMENT, "%s", fault);
}

typedef enum Format { FORMAT_NONE, FORMAT_PNG, FORMAT_PFM, FORMAT_EXR } Format;

/* From the extension, in letters of either case. */
static Format format_of(const char *path) {
    size_t length = strlen(path);
    if (length < 4) return FORMAT_NONE;
    char extension[5] = "";
    for (int i = 0; i < 4; i++) {
        char c = path[length - 4 + (size_t)i];
        extension[i] = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
    }
    return strcmp(extension, ".png") == 0   ? FORMAT_PNG
           : strcmp(extension, ".pfm") == 0 ? FORMAT_PFM
           : strcmp(extension, ".exr") == 0 ? FORMAT_EXR
                                            : FORMAT_NONE;
}

static GlintStatus check_format(const char *path, GlintError *error) {
    if (path == NULL) return gi_error_set(error, GLINT_ERROR_ARGUMENT, "there is no path");
    if (format_of(path) != FORMAT_NONE) return GLINT_OK;
    return gi_error_set_path(
        error, GLINT_ERROR_ARGUMENT, path, "the name of a picture must end in .png, .pfm or .exr");
}

static GlintStatus check_layers(
    const GlintImage *image, Format format, const GlintSaveDesc *desc, GlintError *error) {
    const char *fault = NULL;
    if (format == FORMAT_EXR) {
        fault = gi_exr_check_picture(image, desc);
    } else if (desc->layer_count != 0) {
        fault = "only EXR has layers";
    }
    return fault == NULL ? GLINT_OK : gi_error_set(error, GLINT_ERROR_ARGUMENT, "%s", fault);
}

GlintStatus glint_image_check_path(const char *path, GlintError *error) {
    GlintStatus status = check_format(path, error);
    return status == GLINT_OK && format_of(path) == FORMAT_EXR ? gi_exr_check(error) : status;
}

/* What a recipe puts into a PNG. *own is for the caller to free with gi_image_free_extras, also
 * when memory was short. */
bool gi_image_make_extras(GiMemory *memory, const GlintSaveDesc *desc, GiImageExtras *own) {
    const GlintRecipe *recipe = desc->recipe;
    *own = (GiImageExtras){.extras.title = desc->title};
    if (recipe == NULL) return true;
    own->text_size = glint_recipe_format(recipe, NULL, 0) + 1;
    own->text = gi_memory_allocate(memory, own->text_size);
    own->file_count = (size_t)recipe->file_count;
    size_t size = own->file_count * sizeof *own->files;
    own->files = size > 0 ? gi_memory_allocate(memory, size) : NULL;
    if (own->text == NULL || (size > 0 && own->files == NULL)) return false;
    glint_recipe_format(recipe, own->text, own->text_size);
    for (size_t i = 0; i < own->file_count; i++) {
        const GlintRecipeFile *file = &recipe->files[i];
        own->files[i] = (GiPngFile){file->name, file->bytes, (size_t)file->size};
    }
    own->extras.recipe = own->text;
    own->extras.files = own->files;
    own->extras.file_count = recipe->file_count;
    return true;
}

void gi_image_free_extras(GiMemory *memory, GiImageExtras *own) {
    gi_memory_free(memory, own->text, own->text_size);
    gi_memory_free(memory, own->files, own->file_count * sizeof *own->files);
}

static GlintStatus write_png(const GlintImage *image, const GlintSaveDesc *desc, GlintSinkFn sink,
    void *user, GlintError *error) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiImageExtras own;
    GlintStatus status = GLINT_OK;
    if (!gi_image_make_extras(&memory, desc, &own)) status = gi_error_memory(error);
    if (status == GLINT_OK) {
        status = gi_png_encode(
            &memory, image, &own.extras, desc->thread_count, desc->monitor, sink, user, error);
    }
    gi_image_free_extras(&memory, &own);
    return status;
}

/* On failure the reason may be the file's, which gi_file_write_commit tells. */
static GlintStatus write_format(const GlintImage *image, Format format, const GlintSaveDesc *desc,
    GiFileWriter *file, GlintError *error) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    switch (format) {
    case FORMAT_NONE: break;
    case FORMAT_PNG: return write_png(image, desc, gi_file_write, file, error);
    case FORMAT_PFM:
        return gi_pfm_encode(&memory, image, desc->monitor, gi_file_write, file, error);
    case FORMAT_EXR: return gi_exr_write(&memory, image, desc, file, error);
    }
    return GLINT_OK;
}

bool gi_image_is_png(const char *path) { return format_of(path) == FORMAT_PNG; }

GlintStatus glint_image_save(
    const GlintImage *image, const char *path, const GlintSaveDesc *desc, GlintError *error) {
    GlintStatus status = check(image, desc, error);
    if (status == GLINT_OK) status = check_format(path, error);
    if (status != GLINT_OK) return status;
    Format format = format_of(path);
    status = check_layers(image, format, desc, error);
    if (status != GLINT_OK) return status;
    GiFileWriter file;
    status = gi_file_write_begin(&file, path, error);
    if (status != GLINT_OK) return status;
    status = write_format(image, format, desc, &file, error);
    if (status == GLINT_OK || (status == GLINT_ERROR_FILE && file.error != 0)) {
        /* Commit knows better than the encoder why the file stopped it. */
        return gi_file_write_commit(&file, error);
    }
    gi_file_write_abandon(&file);
    return status;
}

GlintStatus glint_image_encode_png(const GlintImage *image, const GlintSaveDesc *desc,
    GlintSinkFn sink, void *user, GlintError *error) {
    GlintStatus status = check(image, desc, error);
    if (status != GLINT_OK) return status;
    if (sink == NULL) return gi_error_set(error, GLINT_ERROR_ARGUMENT, "there is no sink");
    status = check_layers(image, FORMAT_PNG, desc, error);
    if (status != GLINT_OK) return status;
    return write_png(image, desc, sink, user, error);
}

void glint_image_to_rgb8(const GlintImage *image, uint8_t *rgb) {
    GI_ASSERT(is_sound(image) && rgb != NULL);
    gi_gamma_encode(image->pixels, 3 * (size_t)image->width * (size_t)image->height, rgb);
}
