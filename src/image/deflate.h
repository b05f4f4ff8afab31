/* SPDX-License-Identifier: MIT
 * Deflate, and the two checksums of PNG, by a library chosen when Glint is built: ISA-L
 * (GI_HAVE_ISAL) or else zlib. Pieces are compressed independently of each other, in any order and
 * on any thread, and end on a byte, so that pieces put one after another are one deflate stream. */
#pragma once

#include "base/memory.h"

typedef struct GiDeflater GiDeflater;

/* A deflater works on one piece at a time; every thread needs its own. Null: no memory. */
GiDeflater *gi_deflate_create(GiMemory *memory);
void gi_deflate_destroy(GiDeflater *deflater); /* null is allowed */

/* What a piece of size bytes needs at most. */
size_t gi_deflate_bound(size_t size);

/* Makes a code for bytes like these, for the pieces that follow. */
void gi_deflate_learn(GiDeflater *deflater, const uint8_t *bytes, size_t size);

/* Compresses size bytes (1 .. 2^30) to out, which has room for gi_deflate_bound(size), after
 * something was learned. Returns the compressed size; 0 when the library fails, which takes a lack
 * of memory. The result depends on these bytes and what was learned last alone. */
size_t gi_deflate_piece(GiDeflater *deflater, const uint8_t *bytes, size_t size, uint8_t *out);

/* What ends the stream after the last piece: an empty last block. */
#define GI_DEFLATE_END      "\x03\x00"
#define GI_DEFLATE_END_SIZE 2

/* Unpacks a whole deflate stream to out; false unless it is whole and of this size. */
bool gi_inflate(const uint8_t *bytes, size_t size, uint8_t *out, size_t out_size);

/* CRC-32 of bytes that follow those of crc; begin with 0. */
uint32_t gi_deflate_crc32(uint32_t crc, const uint8_t *bytes, size_t size);

/* Adler-32 of bytes alone; and of two stretches of bytes, the second second_size long. The one of
 * nothing is 1. */
uint32_t gi_deflate_adler32(const uint8_t *bytes, size_t size);
uint32_t gi_deflate_adler32_join(uint32_t first, uint32_t second, uint64_t second_size);
