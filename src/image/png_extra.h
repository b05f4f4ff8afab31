/* SPDX-License-Identifier: MIT
 * What a PNG holds besides its pixels: the chunks that say what it is and how it was made.
 *
 *     Software, Title    texts that every viewer knows
 *     Glint              the recipe, a text of lines (glint_recipe.c); after the pixels another
 * one, "pixels" and their digest glFl               a chunk of our own for each embedded file: its
 * name, a zero byte, its size as eight bytes (the highest first), and its content as a zlib stream
 */
#pragma once

#include "base/memory.h"

enum { GI_PNG_CHUNK_HEAD = 8, GI_PNG_CHUNK_TAIL = 4 }; /* length and name; CRC */

typedef struct GiPngFile {
    const char *name; /* UTF-8 */
    const void *bytes;
    size_t size; /* at most GI_PNG_FILE_LIMIT */
} GiPngFile;

#define GI_PNG_FILE_LIMIT ((size_t)1 << 30)

/* UTF-8; each may be null. */
typedef struct GiPngExtras {
    const char *title, *recipe;
    const GiPngFile *files; /* null elements of bytes are left out */
    int file_count;
} GiPngExtras;

/* ---------------------------------------------------------------- writing */

void gi_png_put32(uint8_t *to, uint32_t value);

/* Completes a chunk whose data is in place, GI_PNG_CHUNK_HEAD after begin. Returns the whole size.
 */
size_t gi_png_finish_chunk(uint8_t *begin, const char *name, size_t data_size);

/* Hands the texts that stand before the pixels to sink. Errors: FILE (the sink stopped), MEMORY. */
GlintStatus gi_png_send_texts(
    GiMemory *memory, const GiPngExtras *extras, GlintSinkFn sink, void *user, GlintError *error);

/* Those that stand after them: the digest of the pixels, if there is a recipe, and the files. */
GlintStatus gi_png_send_rest(GiMemory *memory, const GiPngExtras *extras, uint64_t digest,
    GlintSinkFn sink, void *user, GlintError *error);

/* ---------------------------------------------------------------- reading */

/* One finding of gi_png_read_extras; the pointers are good until visit returns. */
typedef struct GiPngExtra {
    const char *text; /* of a Glint text, zero-terminated; null: a file */
    GiPngFile file;   /* bytes: of gi_memory_allocate, visit's to free, also when it fails */
} GiPngExtra;

/* Calls visit for the Glint texts and embedded files of a PNG in memory, in order. When visit
 * returns false, memory was short. Errors: FILE (this is no PNG, or it is broken), MEMORY. */
GlintStatus gi_png_read_extras(GiMemory *memory, const void *bytes, size_t size,
    bool (*visit)(void *user, const GiPngExtra *extra), void *user, GlintError *error);
