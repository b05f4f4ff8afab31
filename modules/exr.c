/* SPDX-License-Identifier: MIT
 * glint-exr.so: EXR with OpenEXRCore, the C library of OpenEXR: one part, rows from top to bottom
 * in chunks of 16, 32-bit floats, ZIP. The library's working memory, a chunk or two, is its own. */
#include "image/exr_writer.h"

#include <stdio.h>
#include <string.h>

#include <openexr.h>

/* Noise in the lower bits of a float cannot be compressed; a higher level only costs time. */
enum { ZIP_LEVEL = 2, PART = 0 };

typedef struct Writer {
    const GiExrPicture *picture;
    const GiExrTarget *target;
    exr_context_t context;
    exr_encode_pipeline_t pipeline;
    bool has_pipeline, stopped;
} Writer;

static void on_error(exr_const_context_t context, exr_result_t code, const char *text) {
    void *user = NULL;
    (void)code;
    if (context == NULL || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || user == NULL) {
        return;
    }
    const GiExrTarget *target = ((Writer *)user)->target;
    snprintf(target->message, target->message_size, "OpenEXR: %s", text);
}

static int64_t on_write(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
    uint64_t offset, exr_stream_error_func_ptr_t error) {
    Writer *writer = user;
    (void)context;
    (void)error;
    if (writer->target->write(writer->target->user, bytes, (size_t)size, offset)) {
        return (int64_t)size;
    }
    writer->stopped = true;
    return -1;
}

/* The first thing that fails ends a list of calls. */
#define TRY(call)                                                                                  \
    do {                                                                                           \
        exr_result_t result_ = (call);                                                             \
        if (result_ != EXR_ERR_SUCCESS) return result_;                                            \
    } while (0)

static exr_result_t write_header(Writer *writer) {
    const GiExrPicture *picture = writer->picture;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t *context = &writer->context;
    int part = PART;
    setup.error_handler_fn = on_error;
    setup.write_fn = on_write;
    setup.user_data = writer;
    setup.zip_level = ZIP_LEVEL;
    TRY(exr_start_write(context, "picture.exr", EXR_WRITE_FILE_DIRECTLY, &setup));
    TRY(exr_add_part(*context, "", EXR_STORAGE_SCANLINE, &part));
    TRY(exr_initialize_required_attr_simple(
        *context, PART, picture->width, picture->height, EXR_COMPRESSION_ZIP));
    for (int i = 0; i < picture->channel_count; i++) {
        TRY(exr_add_channel(*context, PART, picture->channels[i].name, EXR_PIXEL_FLOAT,
            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    }
    TRY(exr_attr_set_string(*context, PART, "software", picture->software));
    if (picture->title != NULL) {
        TRY(exr_attr_set_string(*context, PART, "title", picture->title));
    }
    return exr_write_header(*context);
}

/* Tells the pipeline, whose channels are sorted by name, where the rows from y on lie. */
static void set_rows(Writer *writer, int y) {
    const GiExrPicture *picture = writer->picture;
    for (int i = 0; i < writer->pipeline.channel_count; i++) {
        exr_coding_channel_info_t *to = &writer->pipeline.channels[i];
        const GiExrChannel *from = picture->channels;
        while (strcmp(from->name, to->channel_name) != 0) from++;
        size_t row = (size_t)picture->width * (size_t)from->stride;
        const float *values = from->values + row * (size_t)y;
        to->encode_from_ptr = (const uint8_t *)values;
        to->user_pixel_stride = from->stride * (int32_t)sizeof(float);
        to->user_line_stride = (int32_t)(row * sizeof(float));
        to->user_bytes_per_element = sizeof(float);
        to->user_data_type = EXR_PIXEL_FLOAT;
    }
}

static exr_result_t write_chunk(Writer *writer, int y) {
    exr_chunk_info_t chunk;
    TRY(exr_write_scanline_chunk_info(writer->context, PART, y, &chunk));
    if (writer->has_pipeline) {
        TRY(exr_encoding_update(writer->context, PART, &chunk, &writer->pipeline));
        set_rows(writer, y);
    } else {
        TRY(exr_encoding_initialize(writer->context, PART, &chunk, &writer->pipeline));
        writer->has_pipeline = true;
        set_rows(writer, y);
        TRY(exr_encoding_choose_default_routines(writer->context, PART, &writer->pipeline));
    }
    return exr_encoding_run(writer->context, PART, &writer->pipeline);
}

static exr_result_t write_picture(Writer *writer) {
    int rows = 0, height = writer->picture->height;
    TRY(write_header(writer));
    TRY(exr_get_scanlines_per_chunk(writer->context, PART, &rows));
    for (int y = 0; y < height; y += rows) {
        TRY(write_chunk(writer, y));
        double fraction = y + rows < height ? (double)(y + rows) / height : 1;
        if (!writer->target->step(writer->target->user, fraction)) {
            writer->stopped = true;
            return EXR_ERR_UNKNOWN;
        }
    }
    return EXR_ERR_SUCCESS;
}

static GiExrOutcome write(const GiExrPicture *picture, const GiExrTarget *target) {
    Writer writer = {.picture = picture, .target = target};
    exr_result_t result = write_picture(&writer);
    if (writer.has_pipeline) exr_encoding_destroy(writer.context, &writer.pipeline);
    /* The end of the file is written here, and may fail as well. */
    if (writer.context != NULL) {
        exr_result_t end = exr_finish(&writer.context);
        if (result == EXR_ERR_SUCCESS) result = end;
    }
    if (writer.stopped) return GI_EXR_STOPPED;
    if (result == EXR_ERR_SUCCESS) return GI_EXR_GOOD;
    if (result == EXR_ERR_OUT_OF_MEMORY) return GI_EXR_MEMORY;
    if (target->message[0] == '\0') {
        snprintf(target->message, target->message_size, "OpenEXR: %s",
            exr_get_default_error_message(result));
    }
    return GI_EXR_FAILED;
}

GLINT_API extern const GiExrWriter glint_exr_writer;
const GiExrWriter glint_exr_writer = {GI_EXR_WRITER_VERSION, write};
