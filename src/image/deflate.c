/* SPDX-License-Identifier: MIT
 * Measured on one core of a 2023 Xeon, 1024 x 1024 RGB, pieces of 64 rows, milliseconds and
 * kilobytes; three renders from smooth to busy, and one with noise added:
 *
 *                         solids        spheres 1k     spheres 10k    noise          load
 *     ISA-L 2.30   1      1.3 /  158     4.6 /  790     5.6 / 1259     8.9 / 1908    +0.04 ms
 *     ISA-L 2.30   2      1.3 /  157     4.8 /  787     6.1 / 1247     9.8 / 1902
 *     ISA-L 2.30   3      4.6 /  161     7.2 /  808     8.1 / 1266     8.5 / 1898
 *     libdeflate   1      7.2 /  166    12.3 /  762    16.5 / 1221    19.5 / 1891    +0.03 ms
 *     libdeflate   2      7.1 /  160    15.7 /  743    21.1 / 1202    30.9 / 1900
 *     zlib 1.2.13  1      8.0 /  197    22.3 /  820    30.3 / 1249    41.9 / 1962    +0.02 ms
 *     zlib RLE     1     11.4 /  391    20.3 /  793    23.0 / 1272    30.6 / 1808
 *
 * all with the Paeth filter (png.c). Only ISA-L is well inside the 15 ms that a small scene has in
 * all; libdeflate can neither flush nor be told that a piece is not the last.
 *
 * But ISA-L's levels 1 and 2 leave a stale register in their hash table: about one piece in a
 * thousand comes out a few bytes longer, depending on the address of the stream. Level 3 differs
 * between processors. Level 0 has neither fault, and with a Huffman code made for the bytes
 * instead of its built-in one it is as small as level 1 and as fast:
 *
 *     ISA-L 2.30   0      2.2 / 276                    7.3 / 1528
 *     code of the picture 2.4 / 233                    8.6 / 1308
 *     code of each piece  2.4 / 232                    8.5 / 1314
 *
 * Its bytes were compared at thirty thousand addresses, and on AVX-512 (native), Haswell and
 * Nehalem (emulated): the same. Another version of a library may of course choose other bytes. */
#include "image/deflate.h"

#include <string.h>

#ifdef GI_HAVE_ISAL

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

struct GiDeflater {
    GiMemory *memory;
    struct isal_zstream stream;
    struct isal_huff_histogram counts;
    struct isal_hufftables code;
};

GiDeflater *gi_deflate_create(GiMemory *memory) {
    GiDeflater *deflater = gi_memory_allocate(memory, sizeof *deflater);
    if (deflater == NULL) return NULL;
    memset(deflater, 0, sizeof *deflater);
    deflater->memory = memory;
    return deflater;
}

void gi_deflate_destroy(GiDeflater *deflater) {
    if (deflater != NULL) gi_memory_free(deflater->memory, deflater, sizeof *deflater);
}

void gi_deflate_learn(GiDeflater *deflater, const uint8_t *bytes, size_t size) {
    memset(&deflater->counts, 0, sizeof deflater->counts);
    /* Only read, though not declared so. */
    isal_update_histogram((uint8_t *)(uintptr_t)bytes, (int)size, &deflater->counts);
    isal_create_hufftables(&deflater->code, &deflater->counts);
}

/* ISA-L stores what does not shrink, in blocks of at most 65535 bytes with 5 bytes before each. */
size_t gi_deflate_bound(size_t size) { return size + (size / 65535 + 1) * 5 + 512; }

size_t gi_deflate_piece(GiDeflater *deflater, const uint8_t *bytes, size_t size, uint8_t *out) {
    struct isal_zstream *stream = &deflater->stream;
    isal_deflate_stateless_init(stream);
    stream->hist_bits = 0; /* the full window; the call above forgets this field */
    stream->level = 0;
    stream->hufftables = &deflater->code;
    stream->flush = FULL_FLUSH;
    stream->end_of_stream = 0;
    stream->next_in = (uint8_t *)(uintptr_t)bytes; /* only read */
    stream->avail_in = (uint32_t)size;
    stream->next_out = out;
    stream->avail_out = (uint32_t)gi_deflate_bound(size);
    return isal_deflate_stateless(stream) == COMP_OK ? stream->total_out : 0;
}

bool gi_inflate(const uint8_t *bytes, size_t size, uint8_t *out, size_t out_size) {
    struct inflate_state state;
    isal_inflate_init(&state);
    state.next_in = (uint8_t *)(uintptr_t)bytes; /* only read */
    state.avail_in = (uint32_t)size;
    state.next_out = out;
    state.avail_out = (uint32_t)out_size;
    return size <= UINT32_MAX && out_size <= UINT32_MAX &&
           isal_inflate_stateless(&state) == ISAL_DECOMP_OK && state.avail_out == 0;
}

uint32_t gi_deflate_crc32(uint32_t crc, const uint8_t *bytes, size_t size) {
    return crc32_gzip_refl(crc, bytes, size);
}

uint32_t gi_deflate_adler32(const uint8_t *bytes, size_t size) {
    return isal_adler32(1, bytes, size);
}

#else /* zlib */

#define ZLIB_CONST
#include <zlib.h>

struct GiDeflater {
    GiMemory *memory;
    z_stream stream;
};

/* zlib frees without telling the size, so it is kept before the block. */
enum { SIZE_ROOM = 16 };

static voidpf allocate(voidpf user, uInt count, uInt size) {
    size_t bytes = (size_t)count * size + SIZE_ROOM;
    char *block = gi_memory_allocate(user, bytes);
    if (block == NULL) return Z_NULL;
    memcpy(block, &bytes, sizeof bytes);
    return block + SIZE_ROOM;
}

static void release(voidpf user, voidpf pointer) {
    char *block = (char *)pointer - SIZE_ROOM;
    size_t bytes;
    memcpy(&bytes, block, sizeof bytes);
    gi_memory_free(user, block, bytes);
}

GiDeflater *gi_deflate_create(GiMemory *memory) {
    GiDeflater *deflater = gi_memory_allocate(memory, sizeof *deflater);
    if (deflater == NULL) return NULL;
    memset(deflater, 0, sizeof *deflater);
    deflater->memory = memory;
    deflater->stream.zalloc = allocate;
    deflater->stream.zfree = release;
    deflater->stream.opaque = memory;
    /* A negative window means deflate without zlib's own header, which spans all the pieces. */
    if (deflateInit2(&deflater->stream, 1, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
        gi_memory_free(memory, deflater, sizeof *deflater);
        return NULL;
    }
    return deflater;
}

void gi_deflate_destroy(GiDeflater *deflater) {
    if (deflater == NULL) return;
    deflateEnd(&deflater->stream);
    gi_memory_free(deflater->memory, deflater, sizeof *deflater);
}

/* zlib makes a code for every block by itself. */
void gi_deflate_learn(GiDeflater *deflater, const uint8_t *bytes, size_t size) {
    (void)deflater;
    (void)bytes;
    (void)size;
}

/* zlib's own conservative bound and the flush. */
size_t gi_deflate_bound(size_t size) { return size + size / 8 + size / 64 + 512; }

size_t gi_deflate_piece(GiDeflater *deflater, const uint8_t *bytes, size_t size, uint8_t *out) {
    z_stream *stream = &deflater->stream;
    size_t room = gi_deflate_bound(size);
    deflateReset(stream);
    stream->next_in = bytes;
    stream->avail_in = (uInt)size;
    stream->next_out = out;
    stream->avail_out = (uInt)room;
    int result = deflate(stream, Z_FULL_FLUSH);
    bool good = result == Z_OK && stream->avail_in == 0 && stream->avail_out > 0;
    return good ? room - stream->avail_out : 0;
}

bool gi_inflate(const uint8_t *bytes, size_t size, uint8_t *out, size_t out_size) {
    z_stream stream = {
        .next_in = bytes, .avail_in = (uInt)size, .next_out = out, .avail_out = (uInt)out_size};
    if (size > UINT32_MAX || out_size > UINT32_MAX || inflateInit2(&stream, -15) != Z_OK) {
        return false;
    }
    bool whole = inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    return whole;
}

/* zlib counts in uInt. */
enum { PART = 1 << 30 };

uint32_t gi_deflate_crc32(uint32_t crc, const uint8_t *bytes, size_t size) {
    for (; size > PART; bytes += PART, size -= PART) crc = (uint32_t)crc32(crc, bytes, PART);
    return (uint32_t)crc32(crc, bytes, (uInt)size);
}

uint32_t gi_deflate_adler32(const uint8_t *bytes, size_t size) {
    uLong sum = 1;
    for (; size > PART; bytes += PART, size -= PART) sum = adler32(sum, bytes, PART);
    return (uint32_t)adler32(sum, bytes, (uInt)size);
}

#endif

/* With a = 1 + sum of bytes and b = sum of all values of a on the way, both modulo 65521, the first
 * a - 1 counts again in each of the second's steps. */
uint32_t gi_deflate_adler32_join(uint32_t first, uint32_t second, uint64_t second_size) {
    const uint64_t base = 65521;
    uint64_t carried = ((first & 0xffff) + base - 1) % base;
    uint64_t a = (carried + (second & 0xffff)) % base;
    uint64_t b = ((first >> 16) + (second >> 16) + second_size % base * carried) % base;
    return (uint32_t)(b << 16 | a);
}
