/* SPDX-License-Identifier: MIT
 * glint-png.so: PNG to 8-bit RGB, with libpng. Values are taken as they stand, with no regard to
 * gamma and profiles. libpng's own working memory, some hundred kilobytes, is its own. */
#include "texture/decoder.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    const uint8_t *bytes;
    size_t size, position;
    const GiDecoderTarget *target;
    png_structp png;
    png_infop info;
    png_bytep *rows;
} Reader;

/* libpng's error handling ends in a jump; the message is kept before. */
static void on_error(png_structp png, png_const_charp message) {
    const Reader *reader = png_get_error_ptr(png);
    snprintf(
        reader->target->message, reader->target->message_size, "broken PNG picture: %s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void on_read(png_structp png, png_bytep to, size_t size) {
    Reader *reader = png_get_io_ptr(png);
    if (size > reader->size - reader->position) png_error(png, "it ends too early");
    memcpy(to, reader->bytes + reader->position, size);
    reader->position += size;
}

/* Palettes, gray and few bits become RGB with 8 bits. */
static void set_transforms(Reader *reader) {
    png_structp png = reader->png;
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_scale_16(png);
    png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, reader->info);
}

static GlintStatus read_picture(Reader *reader) {
    png_structp png = reader->png;
    png_set_read_fn(png, reader, on_read);
    png_set_user_limits(png, GI_PICTURE_PIXEL_LIMIT, GI_PICTURE_PIXEL_LIMIT);
    png_read_info(png, reader->info);
    size_t width = png_get_image_width(png, reader->info);
    size_t height = png_get_image_height(png, reader->info);
    if (width > GI_PICTURE_PIXEL_LIMIT / height) png_error(png, "it has more than 2^28 pixels");
    set_transforms(reader);
    if (png_get_rowbytes(png, reader->info) != 3 * width) png_error(png, "unknown kind of pixel");
    uint8_t *rgb = reader->target->begin(reader->target->user, (int)width, (int)height);
    reader->rows = malloc(height * sizeof *reader->rows);
    if (rgb == NULL || reader->rows == NULL) return GLINT_ERROR_MEMORY;
    for (size_t y = 0; y < height; y++) reader->rows[y] = rgb + 3 * width * y;
    png_read_image(png, reader->rows);
    png_read_end(png, NULL);
    return GLINT_OK;
}

static GlintStatus decode(const uint8_t *bytes, size_t size, const GiDecoderTarget *target) {
    /* On the heap, so that nothing of it can be lost in a register when libpng jumps. */
    Reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL) return GLINT_ERROR_MEMORY;
    *reader = (Reader){.bytes = bytes, .size = size, .target = target};
    reader->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, reader, on_error, on_warning);
    if (reader->png != NULL) reader->info = png_create_info_struct(reader->png);
    volatile GlintStatus status = GLINT_ERROR_MEMORY;
    if (reader->info != NULL) {
        status = GLINT_ERROR_FILE;
        if (setjmp(png_jmpbuf(reader->png)) == 0) status = read_picture(reader);
    }
    png_destroy_read_struct(&reader->png, &reader->info, NULL);
    free(reader->rows);
    free(reader);
    return status;
}

GLINT_API extern const GiDecoder glint_decoder;
const GiDecoder glint_decoder = {GI_DECODER_VERSION, decode};
