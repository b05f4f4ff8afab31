/* SPDX-License-Identifier: MIT */
#include "image/png_extra.h"

#include "base/error.h"
#include "image/deflate.h"

#include <stdio.h>
#include <string.h>

enum { TITLE_LIMIT = 1 << 16, SIZE_ROOM = 8 };

static const char signature[] = "\x89PNG\r\n\x1a\n";

void gi_png_put32(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

size_t gi_png_finish_chunk(uint8_t *begin, const char *name, size_t data_size) {
    gi_png_put32(begin, (uint32_t)data_size);
    memcpy(begin + 4, name, 4);
    uint32_t crc = gi_deflate_crc32(0, begin + 4, 4 + data_size);
    gi_png_put32(begin + GI_PNG_CHUNK_HEAD + data_size, crc);
    return GI_PNG_CHUNK_HEAD + data_size + GI_PNG_CHUNK_TAIL;
}

static GlintStatus stopped(GlintError *error) {
    return gi_error_set(error, GLINT_ERROR_FILE, "the receiver of the picture's bytes stopped");
}

/* ---------------------------------------------------------------- texts */

/* Reads one character of UTF-8. Broken bytes and control characters become question marks. */
static uint32_t next_character(const char **text, const char *end) {
    const uint8_t *from = (const uint8_t *)*text;
    uint32_t first = from[0];
    int more = first < 0x80 ? 0 : first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
    static const uint32_t smallest[] = {0, 0x80, 0x800, 0x10000};
    uint32_t character = more == 0 ? first : first & (0x3fu >> more);
    bool good = (first < 0x80 || first >= 0xc2) && first < 0xf5 && end - *text > more;
    for (int i = 1; good && i <= more; i++) {
        good = (from[i] & 0xc0) == 0x80;
        character = character << 6 | (from[i] & 0x3f);
    }
    good = good && character >= smallest[more] && character < 0x110000 && character >> 11 != 0x1b;
    *text += good ? 1 + more : 1;
    bool control = (character < 32 && character != '\n') || (character >= 0x7f && character < 0xa0);
    return good && !control ? character : '?';
}

/* What a text chunk needs at most, keyword and all. */
static size_t text_bound(const char *keyword, size_t length) {
    return GI_PNG_CHUNK_HEAD + strlen(keyword) + 5 + length + GI_PNG_CHUNK_TAIL;
}

/* tEXt when Latin-1 can write it, else iTXt, which is UTF-8. */
static size_t write_text(uint8_t *to, const char *keyword, const char *text, size_t length) {
    const char *end = text + length;
    uint32_t highest = 0;
    for (const char *from = text; from < end;) {
        uint32_t character = next_character(&from, end);
        if (character > highest) highest = character;
    }
    bool latin1 = highest < 0x100;
    uint8_t *data = to + GI_PNG_CHUNK_HEAD;
    size_t size = strlen(keyword);
    memcpy(data, keyword, size);
    /* In iTXt there follow: not compressed, no language, no translated keyword. */
    memset(data + size, 0, 5);
    size += latin1 ? 1 : 5;
    for (const char *from = text; from < end;) {
        const char *begin = from;
        uint32_t character = next_character(&from, end);
        if (latin1 || character == '?') {
            data[size++] = (uint8_t)character;
        } else {
            for (; begin < from; begin++) data[size++] = (uint8_t)*begin;
        }
    }
    return gi_png_finish_chunk(to, latin1 ? "tEXt" : "iTXt", size);
}

GlintStatus gi_png_send_texts(
    GiMemory *memory, const GiPngExtras *extras, GlintSinkFn sink, void *user, GlintError *error) {
    char software[64];
    snprintf(software, sizeof software, "Glint %s", glint_version_text());
    size_t title = extras->title != NULL ? strlen(extras->title) : 0;
    if (title > TITLE_LIMIT) {
        /* Cut between characters. */
        title = TITLE_LIMIT;
        while (title > 0 && ((uint8_t)extras->title[title] & 0xc0) == 0x80) title--;
    }
    size_t recipe = extras->recipe != NULL ? strlen(extras->recipe) : 0;
    size_t room = text_bound("Software", sizeof software) + text_bound("Title", title) +
                  text_bound("Glint", recipe);
    uint8_t *chunks = gi_memory_allocate(memory, room);
    if (chunks == NULL) return gi_error_memory(error);
    size_t size = write_text(chunks, "Software", software, strlen(software));
    if (extras->title != NULL) size += write_text(chunks + size, "Title", extras->title, title);
    if (extras->recipe != NULL) size += write_text(chunks + size, "Glint", extras->recipe, recipe);
    bool taken = sink(user, chunks, size);
    gi_memory_free(memory, chunks, room);
    return taken ? GLINT_OK : stopped(error);
}

/* ---------------------------------------------------------------- files */

/* Returns the size of the chunk; 0: no memory. */
static size_t write_file(GiMemory *memory, const GiPngFile *file, uint8_t *to) {
    uint8_t *at = to + GI_PNG_CHUNK_HEAD;
    size_t name = strlen(file->name) + 1;
    memcpy(at, file->name, name);
    at += name;
    gi_png_put32(at, (uint32_t)((uint64_t)file->size >> 32));
    gi_png_put32(at + 4, (uint32_t)file->size);
    at += SIZE_ROOM;
    memcpy(at, "\x78\x01", 2);
    at += 2;
    if (file->size > 0) {
        GiDeflater *deflater = gi_deflate_create(memory);
        if (deflater == NULL) return 0;
        gi_deflate_learn(deflater, file->bytes, file->size);
        size_t packed = gi_deflate_piece(deflater, file->bytes, file->size, at);
        gi_deflate_destroy(deflater);
        if (packed == 0) return 0;
        at += packed;
    }
    memcpy(at, GI_DEFLATE_END, GI_DEFLATE_END_SIZE);
    at += GI_DEFLATE_END_SIZE;
    gi_png_put32(at, gi_deflate_adler32(file->bytes, file->size));
    at += 4;
    return gi_png_finish_chunk(to, "glFl", (size_t)(at - to) - GI_PNG_CHUNK_HEAD);
}

static GlintStatus send_file(
    GiMemory *memory, const GiPngFile *file, GlintSinkFn sink, void *user, GlintError *error) {
    size_t room = GI_PNG_CHUNK_HEAD + strlen(file->name) + 1 + SIZE_ROOM + 2 +
                  gi_deflate_bound(file->size) + GI_DEFLATE_END_SIZE + 4 + GI_PNG_CHUNK_TAIL;
    uint8_t *chunk = gi_memory_allocate(memory, room);
    if (chunk == NULL) return gi_error_memory(error);
    size_t size = write_file(memory, file, chunk);
    GlintStatus status = size == 0                 ? gi_error_memory(error)
                         : sink(user, chunk, size) ? GLINT_OK
                                                   : stopped(error);
    gi_memory_free(memory, chunk, room);
    return status;
}

GlintStatus gi_png_send_rest(GiMemory *memory, const GiPngExtras *extras, uint64_t digest,
    GlintSinkFn sink, void *user, GlintError *error) {
    if (extras->recipe != NULL) {
        char text[40];
        uint8_t chunk[100];
        int length = snprintf(text, sizeof text, "pixels %016llx\n", (unsigned long long)digest);
        size_t size = write_text(chunk, "Glint", text, (size_t)length);
        if (!sink(user, chunk, size)) return stopped(error);
    }
    for (int i = 0; i < extras->file_count; i++) {
        if (extras->files[i].bytes == NULL) continue;
        GlintStatus status = send_file(memory, &extras->files[i], sink, user, error);
        if (status != GLINT_OK) return status;
    }
    return GLINT_OK;
}

/* ---------------------------------------------------------------- reading */

static uint32_t get32(const uint8_t *from) {
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

typedef struct Visit {
    GiMemory *memory;
    bool (*visit)(void *user, const GiPngExtra *extra);
    void *user;
} Visit;

/* A text of ours, as UTF-8; others are passed over. False: no memory. */
static bool visit_text(const Visit *visit, const uint8_t *data, size_t size, bool latin1) {
    size_t head = latin1 ? 6 : 10;
    if (size < head || memcmp(data, "Glint\0\0\0\0\0", head) != 0) return true;
    size_t room = 2 * (size - head) + 1, length = 0;
    char *text = gi_memory_allocate(visit->memory, room);
    if (text == NULL) return false;
    for (size_t i = head; i < size; i++) {
        if (!latin1 || data[i] < 0x80) {
            text[length++] = (char)data[i];
        } else {
            text[length++] = (char)(0xc0 | data[i] >> 6);
            text[length++] = (char)(0x80 | (data[i] & 0x3f));
        }
    }
    text[length] = '\0';
    bool good = visit->visit(visit->user, &(GiPngExtra){.text = text});
    gi_memory_free(visit->memory, text, room);
    return good;
}

static GlintStatus visit_file(
    const Visit *visit, const uint8_t *data, size_t size, GlintError *error) {
    const uint8_t *zero = memchr(data, 0, size);
    size_t name = zero != NULL ? (size_t)(zero - data) + 1 : size;
    if (zero == NULL || size - name < SIZE_ROOM + 2 + 4) {
        return gi_error_set(error, GLINT_ERROR_FILE, "an embedded file is broken");
    }
    uint64_t length = (uint64_t)get32(data + name) << 32 | get32(data + name + 4);
    if (length > GI_PNG_FILE_LIMIT) {
        return gi_error_set(error, GLINT_ERROR_FILE, "an embedded file is larger than 1 GiB");
    }
    /* An empty file has a byte as well, so that it is not null. */
    uint8_t *bytes = gi_memory_allocate(visit->memory, (size_t)length + 1);
    if (bytes == NULL) return gi_error_memory(error);
    const uint8_t *stream = data + name + SIZE_ROOM;
    size_t stream_size = size - name - SIZE_ROOM;
    bool whole = gi_inflate(stream + 2, stream_size - 2 - 4, bytes, (size_t)length) &&
                 gi_deflate_adler32(bytes, (size_t)length) == get32(stream + stream_size - 4);
    if (!whole) {
        gi_memory_free(visit->memory, bytes, (size_t)length + 1);
        return gi_error_set(error, GLINT_ERROR_FILE, "an embedded file is broken");
    }
    GiPngExtra extra = {.file = {(const char *)data, bytes, (size_t)length}};
    return visit->visit(visit->user, &extra) ? GLINT_OK : gi_error_memory(error);
}

static GlintStatus visit_chunk(
    const Visit *visit, const uint8_t *chunk, size_t size, GlintError *error) {
    const uint8_t *data = chunk + GI_PNG_CHUNK_HEAD;
    bool text = memcmp(chunk + 4, "tEXt", 4) == 0, wide = memcmp(chunk + 4, "iTXt", 4) == 0;
    bool file = memcmp(chunk + 4, "glFl", 4) == 0;
    if (!text && !wide && !file) return GLINT_OK;
    if (gi_deflate_crc32(0, chunk + 4, 4 + size) != get32(data + size)) {
        return gi_error_set(error, GLINT_ERROR_FILE, "broken PNG picture: a checksum is wrong");
    }
    if (file) return visit_file(visit, data, size, error);
    return visit_text(visit, data, size, text) ? GLINT_OK : gi_error_memory(error);
}

GlintStatus gi_png_read_extras(GiMemory *memory, const void *bytes, size_t size,
    bool (*visit)(void *user, const GiPngExtra *extra), void *user, GlintError *error) {
    const Visit context = {memory, visit, user};
    const uint8_t *at = bytes, *end = at + size;
    if (size < 8 || memcmp(at, signature, 8) != 0) {
        return gi_error_set(error, GLINT_ERROR_FILE, "this is no PNG picture");
    }
    enum { FRAME = GI_PNG_CHUNK_HEAD + GI_PNG_CHUNK_TAIL };
    for (at += 8; (size_t)(end - at) >= FRAME;) {
        size_t length = get32(at);
        if (length > (size_t)(end - at) - FRAME) break;
        if (memcmp(at + 4, "IEND", 4) == 0) return GLINT_OK;
        GlintStatus status = visit_chunk(&context, at, length, error);
        if (status != GLINT_OK) return status;
        at += FRAME + length;
    }
    return gi_error_set(error, GLINT_ERROR_FILE, "broken PNG picture: it ends too early");
}
