/* SPDX-License-Identifier: MIT
 * The encodings that a scene may have, all to one: UTF-8 with line feeds. */
#pragma once

#include "base/array.h"
#include "reader/span.h"

typedef GI_ARRAY(char) GiText;

/* Appends the bytes of a whole file to an empty text. A byte order mark goes, a declaration names
 * the new encoding. False when memory is short. */
bool gi_encoding_to_utf8(GiMemory *memory, const void *bytes, size_t size, GiText *text);

/* Appends a character. */
bool gi_encoding_put(GiMemory *memory, GiText *text, uint32_t code);

/* The place of the encoding's name in the XML declaration that the text begins with; size 0: there
 * is none. */
GiSpan gi_encoding_declared(const char *text, size_t size);
