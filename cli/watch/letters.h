/* SPDX-License-Identifier: MIT
 * Text in pictures, with letters of 5 x 9 pixels of our own, so that a window needs no fonts. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* A cell, with the space to the next letter and the next line. */
enum { CLI_LETTER_WIDTH = 6, CLI_LETTER_HEIGHT = 11 };

/* Pixels with their opacity: red, green, blue, alpha, top row first. */
typedef struct CliSheet {
    uint8_t *rgba;
    int width, height;
} CliSheet;

/* How many rows of cells the text needs when lines that are longer than `columns` are broken. */
int cli_letters_rows(const char *text, int columns);

/* Draws a text over a dark band across the sheet, from its top: each pixel of a letter is a square
 * of `scale` pixels. Lines with a caret below them, and the caret, have colours of their own. What
 * is no ASCII is a box. Returns the height of the band. */
int cli_letters_draw(CliSheet *sheet, const char *text, int scale);
