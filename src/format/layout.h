/* SPDX-License-Identifier: MIT
 * The layout of docs/format-tools.md. What a file means is left alone: only white space where it
 * means nothing, the case of element names and the quotes of attributes change. */
#pragma once

#include "format/document.h"

/* Appends the document's canonical layout. Laid out again it stays the same. False when memory is
 * short. */
bool gi_layout_write(const GiDocument *document, GiText *text);
