/* SPDX-License-Identifier: MIT
 * Pictures as terminals take them. Each appends to `out` what draws a picture with its top left
 * corner at the cursor. */
#pragma once

#include "watch/bytes.h"

#include <stdint.h>

/* Two pixels a cell, one above the other: the upper half block in the colour of the upper one, on
 * the colour of the lower one. rgb: columns * 2 rows. fine: 24-bit colours; otherwise the nearest
 * of the 256 that all terminals share. The cursor ends below the picture. */
void cli_encode_blocks(CliBytes *out, const uint8_t *rgb, int columns, int rows, bool fine);

/* Sixel (DEC STD 070, chapter 9): bands of six rows, in 252 colours, 6 x 7 x 6, that are mixed by
 * an ordered pattern. */
void cli_encode_sixel(CliBytes *out, const uint8_t *rgb, int width, int height);

/* The kitty graphics protocol (https://sw.kovidgoyal.net/kitty/graphics-protocol): a PNG in chunks
 * of base64, shown pixel by pixel in the place of the picture before. stay: the cursor does not
 * move; otherwise it ends behind the picture. */
void cli_encode_kitty(CliBytes *out, const CliBytes *png, bool stay);

/* Takes the picture of cli_encode_kitty away. */
extern const char cli_encode_kitty_remove[];

/* The number of the nearest of the 240 colours behind the first 16, which users choose themselves.
 */
int cli_encode_color256(const uint8_t rgb[3]);
