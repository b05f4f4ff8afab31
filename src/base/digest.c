/* SPDX-License-Identifier: MIT
 * ISA-L folds 64 bytes at a time with carry-less products, some 10 GB/s. Without it a table for
 * each value of a byte is made on the stack for every call; who calls has many bytes. */
#include "base/digest.h"

#ifdef GI_HAVE_ISAL
#include <isa-l/crc64.h>
#endif

uint64_t gi_digest_plain(uint64_t digest, const void *bytes, size_t size) {
    const uint64_t polynomial = UINT64_C(0xc96c5795d7870f42);
    uint64_t table[256];
    for (uint64_t i = 0; i < 256; i++) {
        uint64_t rest = i;
        for (int bit = 0; bit < 8; bit++) rest = rest >> 1 ^ ((rest & 1) != 0 ? polynomial : 0);
        table[i] = rest;
    }
    digest = ~digest;
    for (const uint8_t *byte = bytes; size > 0; size--, byte++) {
        digest = digest >> 8 ^ table[(digest ^ *byte) & 0xff];
    }
    return ~digest;
}

uint64_t gi_digest(uint64_t digest, const void *bytes, size_t size) {
#ifdef GI_HAVE_ISAL
    return size == 0 ? digest : crc64_ecma_refl(digest, bytes, size);
#else
    return gi_digest_plain(digest, bytes, size);
#endif
}
