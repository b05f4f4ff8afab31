/* SPDX-License-Identifier: MIT
 * glint-exr.so: EXR with OpenEXRCore, the C library of OpenEXR: one part, rows from top to bottom
 * in chunks of 16, 32-bit floats, ZIP. Chunks are compressed in batches, by many threads, and
 * written by the caller's, so that the file does not depend on the number of threads. The working
 * memory, a few chunks, comes from malloc. */
#include "image/exr_writer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <openexr.h>

/* Noise in the lower bits of a float cannot be compressed; a higher level only costs time. */
enum { ZIP_LEVEL = 2, PART = 0 };

/* A chunk on its way. */
typedef struct Slot {
    exr_encode_pipeline_t pipeline;
    bool has_pipeline;
    exr_result_t result;
} Slot;

typedef struct Writer {
    const GiExrPicture *picture;
    const GiExrTarget *target;
    exr_context_t context;
    Slot *slots;
    int first, rows; /* row of the first slot, rows of a chunk */
    bool stopped;
} Writer;

/* OpenEXR would print it; results tell enough. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *text) {
    (void)context;
    (void)code;
    (void)text;
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
static void set_rows(exr_encode_pipeline_t *pipeline, const GiExrPicture *picture, int y) {
    for (int i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *to = &pipeline->channels[i];
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

/* In the place of writing: the chunk stays in the pipeline. */
static exr_result_t keep(exr_encode_pipeline_t *pipeline) {
    (void)pipeline;
    return EXR_ERR_SUCCESS;
}

static exr_result_t compress(Writer *writer, Slot *slot, int y) {
    exr_encode_pipeline_t *pipeline = &slot->pipeline;
    exr_chunk_info_t chunk;
    TRY(exr_write_scanline_chunk_info(writer->context, PART, y, &chunk));
    if (slot->has_pipeline) {
        TRY(exr_encoding_update(writer->context, PART, &chunk, pipeline));
        set_rows(pipeline, writer->picture, y);
    } else {
        TRY(exr_encoding_initialize(writer->context, PART, &chunk, pipeline));
        slot->has_pipeline = true;
        set_rows(pipeline, writer->picture, y);
        TRY(exr_encoding_choose_default_routines(writer->context, PART, pipeline));
        pipeline->yield_until_ready_fn = keep;
        pipeline->write_fn = keep;
    }
    return exr_encoding_run(writer->context, PART, pipeline);
}

static void compress_slot(void *context, size_t index) {
    Writer *writer = context;
    Slot *slot = &writer->slots[index];
    slot->result = compress(writer, slot, writer->first + (int)index * writer->rows);
}

static exr_result_t write_batch(Writer *writer, size_t count) {
    writer->target->run(writer->target->user, count, compress_slot, writer);
    for (size_t i = 0; i < count; i++) {
        const exr_encode_pipeline_t *pipeline = &writer->slots[i].pipeline;
        TRY(writer->slots[i].result);
        TRY(exr_write_scanline_chunk(writer->context, PART, writer->first,
            pipeline->compressed_buffer, pipeline->compressed_bytes));
        writer->first += writer->rows;
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t write_picture(Writer *writer) {
    const GiExrTarget *target = writer->target;
    int height = writer->picture->height;
    writer->slots = calloc(target->batch_size, sizeof *writer->slots);
    if (writer->slots == NULL) return EXR_ERR_OUT_OF_MEMORY;
    TRY(write_header(writer));
    TRY(exr_get_scanlines_per_chunk(writer->context, PART, &writer->rows));
    while (writer->first < height) {
        size_t left = (size_t)((height - 1 - writer->first) / writer->rows + 1);
        TRY(write_batch(writer, left < target->batch_size ? left : target->batch_size));
        double fraction = writer->first < height ? (double)writer->first / height : 1;
        if (!target->step(target->user, fraction)) {
            writer->stopped = true;
            return EXR_ERR_UNKNOWN;
        }
    }
    return EXR_ERR_SUCCESS;
}

static void release(Writer *writer) {
    for (size_t i = 0; writer->slots != NULL && i < writer->target->batch_size; i++) {
        Slot *slot = &writer->slots[i];
        if (slot->has_pipeline) exr_encoding_destroy(writer->context, &slot->pipeline);
    }
    free(writer->slots);
}

static GiExrOutcome write_exr(const GiExrPicture *picture, const GiExrTarget *target) {
    Writer writer = {.picture = picture, .target = target};
    exr_result_t result = write_picture(&writer);
    release(&writer);
    /* The end of the file is written here, and may fail as well. */
    if (writer.context != NULL) {
        exr_result_t end = exr_finish(&writer.context);
        if (result == EXR_ERR_SUCCESS) result = end;
    }
    if (writer.stopped) return GI_EXR_STOPPED;
    if (result == EXR_ERR_SUCCESS) return GI_EXR_GOOD;
    if (result == EXR_ERR_OUT_OF_MEMORY) return GI_EXR_MEMORY;
    snprintf(target->message, target->message_size, "OpenEXR: %s",
        exr_get_default_error_message(result));
    return GI_EXR_FAILED;
}

GLINT_API extern const GiExrWriter glint_exr_writer;
const GiExrWriter glint_exr_writer = {GI_EXR_WRITER_VERSION, write_exr};
