/* SPDX-License-Identifier: MIT */
#include "watch/encode.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- half blocks */

/* The cube's levels: 0, 95, 135, ... 255 (xterm's, which all have taken over). */
static int level_value(int level) { return level == 0 ? 0 : 55 + 40 * level; }

static int nearest_level(int value) { return value < 48 ? 0 : value < 115 ? 1 : (value - 35) / 40; }

static int distance(const uint8_t rgb[3], int r, int g, int b) {
    int dr = rgb[0] - r, dg = rgb[1] - g, db = rgb[2] - b;
    return dr * dr + dg * dg + db * db;
}

int cli_encode_color256(const uint8_t rgb[3]) {
    enum { CUBE = 16, GRAYS = 232, GRAY_COUNT = 24 };
    int r = nearest_level(rgb[0]), g = nearest_level(rgb[1]), b = nearest_level(rgb[2]);
    int mean = (rgb[0] + rgb[1] + rgb[2]) / 3;
    int gray = mean < 8 ? 0 : mean > 238 ? GRAY_COUNT - 1 : (mean - 3) / 10;
    int gray_value = 8 + 10 * gray;
    bool is_gray = distance(rgb, gray_value, gray_value, gray_value) <
                   distance(rgb, level_value(r), level_value(g), level_value(b));
    return is_gray ? GRAYS + gray : CUBE + 36 * r + 6 * g + b;
}

/* 38: the letters' colour, 48: what is behind them. */
static void set_color(CliBytes *out, int what, const uint8_t rgb[3], bool fine) {
    if (fine) {
        cli_bytes_format(out, "\033[%d;2;%d;%d;%dm", what, rgb[0], rgb[1], rgb[2]);
    } else {
        cli_bytes_format(out, "\033[%d;5;%dm", what, cli_encode_color256(rgb));
    }
}

void cli_encode_blocks(CliBytes *out, const uint8_t *rgb, int columns, int rows, bool fine) {
    for (int row = 0; row < rows; row++) {
        const uint8_t *upper = rgb + 3 * (size_t)columns * 2 * (size_t)row;
        const uint8_t *lower = upper + 3 * (size_t)columns;
        for (int x = 0; x < columns; x++, upper += 3, lower += 3) {
            /* A colour that is set already is not sent again. */
            if (x == 0 || memcmp(upper, upper - 3, 3) != 0) set_color(out, 38, upper, fine);
            if (x == 0 || memcmp(lower, lower - 3, 3) != 0) set_color(out, 48, lower, fine);
            cli_bytes_add_text(out, "\342\226\200"); /* U+2580 */
        }
        cli_bytes_add_text(out, "\033[0m\033[K\r\n");
    }
}

/* ---------------------------------------------------------------- sixel */

enum { RED_LEVELS = 6, GREEN_LEVELS = 7, BLUE_LEVELS = 6, COLOR_COUNT = 252 };

/* The level of a value, rounded up where the pattern at this pixel says so (Bayer's 8 x 8). */
static int mixed_level(int value, int levels, int x, int y) {
    static const uint8_t pattern[8][8] = {
        {0, 32, 8, 40, 2, 34, 10, 42},
        {48, 16, 56, 24, 50, 18, 58, 26},
        {12, 44, 4, 36, 14, 46, 6, 38},
        {60, 28, 52, 20, 62, 30, 54, 22},
        {3, 35, 11, 43, 1, 33, 9, 41},
        {51, 19, 59, 27, 49, 17, 57, 25},
        {15, 47, 7, 39, 13, 45, 5, 37},
        {63, 31, 55, 23, 61, 29, 53, 21},
    };
    /* In 64ths of a level. */
    int scaled = value * (levels - 1) * 64 / 255;
    return (scaled + pattern[y & 7][x & 7]) / 64;
}

static int mixed_color(const uint8_t rgb[3], int x, int y) {
    int r = mixed_level(rgb[0], RED_LEVELS, x, y);
    int g = mixed_level(rgb[1], GREEN_LEVELS, x, y);
    int b = mixed_level(rgb[2], BLUE_LEVELS, x, y);
    return (r * GREEN_LEVELS + g) * BLUE_LEVELS + b;
}

static int percent(int level, int levels) {
    return (level * 100 + (levels - 1) / 2) / (levels - 1);
}

static void define_color(CliBytes *out, int color) {
    int b = color % BLUE_LEVELS, g = color / BLUE_LEVELS % GREEN_LEVELS;
    int r = color / (BLUE_LEVELS * GREEN_LEVELS);
    cli_bytes_format(out, "#%d;2;%d;%d;%d", color, percent(r, RED_LEVELS), percent(g, GREEN_LEVELS),
        percent(b, BLUE_LEVELS));
}

/* A run of equal columns: six pixels each, the lowest bit on top. */
static void add_run(CliBytes *out, int bits, int count) {
    enum { WORTH = 3 };
    char letter[2] = {(char)('?' + bits), '\0'};
    if (count > WORTH) {
        cli_bytes_format(out, "!%d%s", count, letter);
        return;
    }
    for (int i = 0; i < count; i++) cli_bytes_add(out, letter, 1);
}

/* The pixels of one colour in a band. */
static void add_color(CliBytes *out, const uint8_t *band, int width, int rows, int color) {
    int bits = 0, count = 0;
    cli_bytes_format(out, "#%d", color);
    for (int x = 0; x < width; x++) {
        int now = 0;
        for (int row = 0; row < rows; row++) now |= (band[row * width + x] == color) << row;
        if (now != bits && count > 0) {
            add_run(out, bits, count);
            count = 0;
        }
        bits = now;
        count++;
    }
    if (bits != 0) add_run(out, bits, count); /* what is empty at the end need not be said */
}

void cli_encode_sixel(CliBytes *out, const uint8_t *rgb, int width, int height) {
    uint8_t *band = malloc(6 * (size_t)width);
    bool defined[COLOR_COUNT] = {false};
    if (band == NULL) {
        out->failed = true;
        return;
    }
    /* Pixels that no colour sets stay as they are; 1:1, and the size. */
    cli_bytes_format(out, "\033P0;1q\"1;1;%d;%d", width, height);
    for (int y = 0; y < height; y += 6) {
        int rows = height - y < 6 ? height - y : 6;
        bool used[COLOR_COUNT] = {false};
        for (int i = 0; i < rows * width; i++) {
            int row = i / width, x = i % width;
            const uint8_t *pixel = rgb + 3 * ((size_t)(y + row) * (size_t)width + (size_t)x);
            band[i] = (uint8_t)mixed_color(pixel, x, y + row);
            used[band[i]] = true;
        }
        for (int color = 0; color < COLOR_COUNT; color++) {
            if (!used[color]) continue;
            if (!defined[color]) define_color(out, color);
            defined[color] = true;
            add_color(out, band, width, rows, color);
            cli_bytes_add_text(out, "$"); /* back to the beginning of the band */
        }
        cli_bytes_add_text(out, "-");
    }
    cli_bytes_add_text(out, "\033\\");
    free(band);
}

/* ---------------------------------------------------------------- kitty */

/* As text, for the constant below. */
#define KITTY_ID "7463"

enum { KITTY_CHUNK = 4096 };

const char cli_encode_kitty_remove[] = "\033_Ga=d,d=I,i=" KITTY_ID ",q=2\033\\";

static void add_base64(CliBytes *out, const uint8_t *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t word = (uint32_t)bytes[i] << 16;
        if (left > 1) word |= (uint32_t)bytes[i + 1] << 8;
        if (left > 2) word |= bytes[i + 2];
        char four[4] = {digits[word >> 18], digits[word >> 12 & 63],
            left > 1 ? digits[word >> 6 & 63] : '=', left > 2 ? digits[word & 63] : '='};
        cli_bytes_add(out, four, 4);
    }
}

void cli_encode_kitty(CliBytes *out, const CliBytes *png, bool stay) {
    const size_t chunk = KITTY_CHUNK / 4 * 3;
    for (size_t at = 0; at < png->size; at += chunk) {
        size_t size = png->size - at < chunk ? png->size - at : chunk;
        bool more = at + size < png->size;
        if (at == 0) {
            /* PNG, shown at once, and no answers. */
            cli_bytes_format(out, "\033_Ga=T,f=100,i=" KITTY_ID ",p=1,C=%d,q=2,m=%d;", stay, more);
        } else {
            cli_bytes_format(out, "\033_Gm=%d;", more);
        }
        add_base64(out, (const uint8_t *)png->data + at, size);
        cli_bytes_add_text(out, "\033\\");
    }
}
