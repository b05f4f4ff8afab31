/* SPDX-License-Identifier: MIT
 * glint-jpeg.so: JPEG to 8-bit RGB, with libjpeg-turbo. Everything that could let pixels differ
 * between machines and versions is set: the exact integer transform, the triangle filter for
 * chroma, no smoothing of blocks. libjpeg's working memory is its own, at most MEMORY_LIMIT. */
#include "texture/decoder.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

enum { MEMORY_LIMIT = 1 << 30, SCAN_LIMIT = 500 };

typedef struct Reader {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf jump;
    const GiDecoderTarget *target;
} Reader;

static void refuse(Reader *reader, const char *reason) {
    snprintf(
        reader->target->message, reader->target->message_size, "broken JPEG picture: %s", reason);
    longjmp(reader->jump, 1);
}

/* libjpeg keeps a pointer to the struct that stands first in ours. */
static void on_error(j_common_ptr jpeg) {
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    refuse((Reader *)(void *)jpeg, text);
}

/* libjpeg fills up with gray what is missing, and only warns; here that is an error. */
static void on_message(j_common_ptr jpeg, int level) {
    int code = jpeg->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) on_error(jpeg);
}

/* Some bytes can ask for a pass over the whole picture, thousands of times. */
static void on_progress(j_common_ptr jpeg) {
    Reader *reader = (Reader *)(void *)jpeg;
    if (reader->jpeg.input_scan_number > SCAN_LIMIT) refuse(reader, "it has too many scans");
}

static GlintStatus read_picture(Reader *reader, const uint8_t *bytes, size_t size) {
    struct jpeg_decompress_struct *jpeg = &reader->jpeg;
    jpeg_create_decompress(jpeg);
    jpeg->mem->max_memory_to_use = MEMORY_LIMIT;
    jpeg->progress = &reader->progress;
    jpeg_mem_src(jpeg, bytes, (unsigned long)size);
    jpeg_read_header(jpeg, TRUE);
    if (jpeg->num_components != 1 && jpeg->num_components != 3) {
        refuse(reader, "its colours are not gray or RGB (CMYK is not read)");
    }
    if (jpeg->image_width > GI_PICTURE_PIXEL_LIMIT / jpeg->image_height) {
        refuse(reader, "it has more than 2^28 pixels");
    }
    jpeg->out_color_space = JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    jpeg->do_fancy_upsampling = TRUE;
    jpeg->do_block_smoothing = FALSE;
    jpeg_start_decompress(jpeg);
    size_t row_size = 3 * (size_t)jpeg->output_width;
    uint8_t *rgb = reader->target->begin(
        reader->target->user, (int)jpeg->output_width, (int)jpeg->output_height);
    if (rgb == NULL) return GLINT_ERROR_MEMORY;
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = rgb + row_size * jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_decompress(jpeg);
    return GLINT_OK;
}

static GlintStatus decode(const uint8_t *bytes, size_t size, const GiDecoderTarget *target) {
    /* On the heap, so that nothing of it can be lost in a register when libjpeg jumps. */
    Reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL) return GLINT_ERROR_MEMORY;
    reader->target = target;
    reader->jpeg.err = jpeg_std_error(&reader->errors);
    reader->errors.error_exit = on_error;
    reader->errors.emit_message = on_message;
    reader->progress.progress_monitor = on_progress;
    volatile GlintStatus status = GLINT_ERROR_FILE;
    if (setjmp(reader->jump) == 0) status = read_picture(reader, bytes, size);
    jpeg_destroy_decompress(&reader->jpeg);
    free(reader);
    return status;
}

GLINT_API extern const GiDecoder glint_decoder;
const GiDecoder glint_decoder = {GI_DECODER_VERSION, decode};
