/* SPDX-License-Identifier: MIT
 * CRC-64/XZ (ECMA-182, reflected): tells whether bytes are still what they were, not who wrote
 * them. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Of bytes that follow those of digest; begin with 0. */
uint64_t gi_digest(uint64_t digest, const void *bytes, size_t size);

/* The same without the help of a library. */
uint64_t gi_digest_plain(uint64_t digest, const void *bytes, size_t size);
