/* SPDX-License-Identifier: MIT
 * The part of glint-exr.so that reads: colour of the first part, stored in rows, whatever the
 * compression; half and whole numbers become floats. Other layers are left where they are. */
#include "image/exr_reader.h"

#include <stdio.h>
#include <string.h>

#include <openexr.h>

enum { PART = 0, PIXEL_LIMIT = 1 << 28 };

typedef struct Reader {
    const GiExrSource *source;
    exr_context_t context;
    exr_decode_pipeline_t pipeline;
    bool has_pipeline;
    int width, height, first_row, first_column;
    float *pixels;
    const char *fault; /* a sentence of ours, in the place of OpenEXR's */
} Reader;

static void on_error(exr_const_context_t context, exr_result_t code, const char *text) {
    (void)context;
    (void)code;
    (void)text;
}

static int64_t on_read(exr_const_context_t context, void *user, void *buffer, uint64_t size,
    uint64_t offset, exr_stream_error_func_ptr_t error) {
    const GiExrSource *source = user;
    (void)context;
    (void)error;
    if (offset >= source->size) return 0;
    if (size > source->size - offset) size = source->size - offset;
    memcpy(buffer, (const char *)source->bytes + offset, (size_t)size);
    return (int64_t)size;
}

static int64_t on_size(exr_const_context_t context, void *user) {
    const GiExrSource *source = user;
    (void)context;
    return (int64_t)source->size;
}

#define TRY(call)                                                                                  \
    do {                                                                                           \
        exr_result_t result_ = (call);                                                             \
        if (result_ != EXR_ERR_SUCCESS) return result_;                                            \
    } while (0)

static exr_result_t refuse(Reader *reader, const char *fault) {
    reader->fault = fault;
    return EXR_ERR_INVALID_ATTR;
}

/* ---------------------------------------------------------------- header */

static exr_result_t read_header(Reader *reader) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.read_fn = on_read;
    setup.size_fn = on_size;
    setup.user_data = (void *)reader->source;
    TRY(exr_start_read(&reader->context, "picture.exr", &setup));
    exr_storage_t storage;
    TRY(exr_get_storage(reader->context, PART, &storage));
    if (storage != EXR_STORAGE_SCANLINE) return refuse(reader, "it is not stored in rows");
    exr_attr_box2i_t window;
    TRY(exr_get_data_window(reader->context, PART, &window));
    int64_t width = (int64_t)window.max.x - window.min.x + 1;
    int64_t height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1 || width > PIXEL_LIMIT || height > PIXEL_LIMIT / width) {
        return refuse(reader, "it has no pixels, or more than 2^28");
    }
    reader->width = (int)width;
    reader->height = (int)height;
    reader->first_column = window.min.x;
    reader->first_row = window.min.y;
    return EXR_ERR_SUCCESS;
}

/* ---------------------------------------------------------------- rows */

/* 0 to 2 for R, G and B; -1 for others. */
static int component_of(const char *name) {
    static const char *const names[] = {"R", "G", "B"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(name, names[i]) == 0) return i;
    }
    return -1;
}

/* Where the colour of the rows from y on goes. Y is put in the place of red. Returns how many
 * components there are. */
static int aim(Reader *reader, int y) {
    exr_decode_pipeline_t *pipeline = &reader->pipeline;
    float *rows = reader->pixels + 3 * (size_t)reader->width * (size_t)(y - reader->first_row);
    int found = 0;
    for (int i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        int component = component_of(channel->channel_name);
        if (strcmp(channel->channel_name, "Y") == 0) component = 0;
        bool whole = channel->x_samples == 1 && channel->y_samples == 1;
        channel->decode_to_ptr = NULL;
        if (component < 0 || !whole) continue;
        found++;
        channel->decode_to_ptr = (uint8_t *)(rows + component);
        channel->user_pixel_stride = 3 * (int32_t)sizeof(float);
        channel->user_line_stride = 3 * (int32_t)sizeof(float) * reader->width;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    return found;
}

static void spread_gray(Reader *reader) {
    size_t count = (size_t)reader->width * (size_t)reader->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = reader->pixels + 3 * i;
        pixel[1] = pixel[2] = pixel[0];
    }
}

static exr_result_t read_rows(Reader *reader) {
    int rows, components = 0, last = reader->first_row + reader->height - 1;
    exr_decode_pipeline_t *pipeline = &reader->pipeline;
    TRY(exr_get_scanlines_per_chunk(reader->context, PART, &rows));
    for (int y = reader->first_row; y <= last; y += rows) {
        exr_chunk_info_t chunk;
        TRY(exr_read_scanline_chunk_info(reader->context, PART, y, &chunk));
        if (reader->has_pipeline) {
            TRY(exr_decoding_update(reader->context, PART, &chunk, pipeline));
            aim(reader, y);
        } else {
            TRY(exr_decoding_initialize(reader->context, PART, &chunk, pipeline));
            reader->has_pipeline = true;
            components = aim(reader, y);
            if (components != 3 && components != 1) {
                return refuse(reader, "it has neither the channels R, G and B nor Y");
            }
            TRY(exr_decoding_choose_default_routines(reader->context, PART, pipeline));
        }
        TRY(exr_decoding_run(reader->context, PART, pipeline));
    }
    if (components == 1) spread_gray(reader);
    return EXR_ERR_SUCCESS;
}

static exr_result_t read_picture(Reader *reader) {
    TRY(read_header(reader));
    reader->pixels = reader->source->begin(reader->source->user, reader->width, reader->height);
    if (reader->pixels == NULL) return EXR_ERR_OUT_OF_MEMORY;
    return read_rows(reader);
}

static GlintStatus read_exr(const GiExrSource *source) {
    Reader reader = {.source = source};
    exr_result_t result = read_picture(&reader);
    if (reader.has_pipeline) exr_decoding_destroy(reader.context, &reader.pipeline);
    if (reader.context != NULL) exr_finish(&reader.context);
    if (result == EXR_ERR_SUCCESS) return GLINT_OK;
    if (result == EXR_ERR_OUT_OF_MEMORY) return GLINT_ERROR_MEMORY;
    snprintf(source->message, source->message_size, "broken or unusual EXR picture: %s",
        reader.fault != NULL ? reader.fault : exr_get_default_error_message(result));
    return GLINT_ERROR_FILE;
}

GLINT_API extern const GiExrReader glint_exr_reader;
const GiExrReader glint_exr_reader = {GI_EXR_READER_VERSION, read_exr};
