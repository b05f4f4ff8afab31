/* SPDX-License-Identifier: MIT
 * What `glint watch` sends to a terminal, decoded again; what it understands of what comes back;
 * and the letters that it draws itself. No terminal is needed. */
#include "test.h"

#include "pictures.h"

#include "watch/encode.h"
#include "watch/letters.h"
#include "watch/picture.h"
#include "watch/screen.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A picture of 8-bit values with smooth parts and edges. Freed by the caller. */
static uint8_t *make_rgb(int width, int height) {
    uint8_t *rgb = malloc(3 * (size_t)width * (size_t)height);
    for (int i = 0; rgb != NULL && i < width * height; i++) {
        int x = i % width, y = i / width;
        rgb[3 * i] = (uint8_t)(255 * x / width);
        rgb[3 * i + 1] = (uint8_t)(255 * y / height);
        rgb[3 * i + 2] = (x / 8 + y / 8) % 2 == 0 ? 250 : 10;
    }
    return rgb;
}

/* ---------------------------------------------------------------- half blocks */

/* Puts the colours of a text of blocks back into pixels. Returns how many cells there are. */
static int read_blocks(const char *text, int columns, uint8_t *rgb) {
    int color[2][3] = {{0}}, cells = 0;
    while (*text != '\0') {
        int what, r, g, b, size = 0;
        if (sscanf(text, "\033[%d;2;%d;%d;%dm%n", &what, &r, &g, &b, &size) == 4 && size > 0) {
            memcpy(color[what == 48], (int[]){r, g, b}, sizeof color[0]);
            text += size;
        } else if (strncmp(text, "\342\226\200", 3) == 0) {
            int x = cells % columns, y = 2 * (cells / columns);
            for (int k = 0; k < 3; k++) {
                rgb[3 * (y * columns + x) + k] = (uint8_t)color[0][k];
                rgb[3 * ((y + 1) * columns + x) + k] = (uint8_t)color[1][k];
            }
            cells++;
            text += 3;
        } else {
            text++;
        }
    }
    return cells;
}

static void blocks(void) {
    enum { COLUMNS = 37, ROWS = 11 };
    uint8_t *rgb = make_rgb(COLUMNS, 2 * ROWS), back[3 * COLUMNS * 2 * ROWS] = {0};
    CliBytes out = {0};
    cli_encode_blocks(&out, rgb, COLUMNS, ROWS, true);
    CHECK_INT(read_blocks(cli_bytes_text(&out), COLUMNS, back), COLUMNS * ROWS);
    CHECK(memcmp(rgb, back, sizeof back) == 0);
    /* Of one colour it is said once a row. */
    memset(rgb, 77, sizeof back);
    cli_bytes_clear(&out);
    cli_encode_blocks(&out, rgb, COLUMNS, ROWS, true);
    CHECK(out.size < ROWS * (COLUMNS * 3 + 60));
    cli_bytes_clear(&out);
    cli_encode_blocks(&out, rgb, 1, 1, false);
    CHECK_TEXT(cli_bytes_text(&out), "\033[38;5;239m\033[48;5;239m\342\226\200\033[0m\033[K\r\n");
    cli_bytes_reset(&out);
    free(rgb);
}

/* Against all 240 colours, one by one. */
static void nearest_of_256(void) {
    static const int levels[6] = {0, 95, 135, 175, 215, 255};
    uint32_t state = 1;
    for (int i = 0; i < 3000; i++) {
        uint8_t rgb[3];
        for (int k = 0; k < 3; k++) rgb[k] = (uint8_t)(next_random(&state) >> 24);
        if (i % 3 == 0) rgb[1] = rgb[2] = rgb[0];
        int found = cli_encode_color256(rgb), least = 1 << 30, own = 0;
        for (int color = 16; color < 256; color++) {
            int c = color - 16, gray = 8 + 10 * (color - 232), away = 0;
            int value[3] = {levels[c / 36 % 6], levels[c / 6 % 6], levels[c % 6]};
            if (color >= 232) value[0] = value[1] = value[2] = gray;
            for (int k = 0; k < 3; k++) away += (value[k] - rgb[k]) * (value[k] - rgb[k]);
            if (away < least) least = away;
            if (color == found) own = away;
        }
        CHECK(found >= 16 && own <= least + 40); /* the mean of three may be the next gray */
    }
}

/* ---------------------------------------------------------------- sixel */

/* What a terminal does with a sixel text. Returns false when it is none. */
static bool read_sixel(const char *text, int width, int height, uint8_t *rgb) {
    static uint8_t palette[256][3];
    int w = 0, h = 0, size = 0, color = 0, x = 0, y = 0, count = 1;
    if (sscanf(text, "\033P0;1q\"1;1;%d;%d%n", &w, &h, &size) != 2) return false;
    if (w != width || h != height) return false;
    for (text += size; *text != '\0' && *text != '\033'; text++) {
        int r, g, b;
        if (*text == '#') {
            if (sscanf(text, "#%d;2;%d;%d;%d%n", &color, &r, &g, &b, &size) == 4) {
                uint8_t values[3] = {(uint8_t)((r * 255 + 50) / 100),
                    (uint8_t)((g * 255 + 50) / 100), (uint8_t)((b * 255 + 50) / 100)};
                memcpy(palette[color & 255], values, 3);
            } else if (sscanf(text, "#%d%n", &color, &size) != 1) {
                return false;
            }
            text += size - 1;
        } else if (*text == '!') {
            if (sscanf(text, "!%d%n", &count, &size) != 1) return false;
            text += size - 1;
        } else if (*text == '$' || *text == '-') {
            x = 0;
            y += *text == '-' ? 6 : 0;
        } else if (*text >= '?' && *text <= '~') {
            for (; count > 0; count--, x++) {
                for (int bit = 0; bit < 6; bit++) {
                    if (((*text - '?') >> bit & 1) == 0) continue;
                    if (x >= width || y + bit >= height) return false;
                    memcpy(rgb + 3 * ((y + bit) * width + x), palette[color & 255], 3);
                }
            }
            count = 1;
        } else {
            return false;
        }
    }
    return strcmp(text, "\033\\") == 0;
}

/* The mean of a block of 8 x 8 pixels. */
static double mean_of(const uint8_t *rgb, int width, int x, int y, int k) {
    double sum = 0;
    for (int i = 0; i < 64; i++) sum += rgb[3 * ((y + i / 8) * width + x + i % 8) + k];
    return sum / 64;
}

/* Every pixel is there, and from a little further away it is the picture. */
static void sixel(void) {
    enum { WIDTH = 104, HEIGHT = 64 };
    uint8_t *rgb = make_rgb(WIDTH, HEIGHT), *back = calloc(WIDTH * HEIGHT, 3);
    CliBytes out = {0};
    if (rgb == NULL || back == NULL) return;
    cli_encode_sixel(&out, rgb, WIDTH, HEIGHT);
    CHECK(read_sixel(cli_bytes_text(&out), WIDTH, HEIGHT, back));
    for (int y = 0; y + 8 <= HEIGHT; y += 8) {
        for (int x = 0; x + 8 <= WIDTH; x += 8) {
            for (int k = 0; k < 3; k++) {
                CHECK_NEAR(mean_of(back, WIDTH, x, y, k), mean_of(rgb, WIDTH, x, y, k), 4);
            }
        }
    }
    cli_bytes_reset(&out);
    free(rgb);
    free(back);
}

/* ---------------------------------------------------------------- kitty */

static int base64_digit(char c) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = c != '\0' ? strchr(digits, c) : NULL;
    return at != NULL ? (int)(at - digits) : -1;
}

/* The bytes of all chunks; false when the protocol is broken. */
static bool read_kitty(const char *text, Bytes *png) {
    bool more = true;
    for (int chunk = 0; more; chunk++) {
        const char *semicolon = strchr(text, ';'), *m = strstr(text, "m=");
        bool begins = chunk == 0 ? strncmp(text, "\033_Ga=T,f=100,i=", 15) == 0
                                 : strncmp(text, "\033_Gm=", 5) == 0;
        if (!begins || semicolon == NULL || m == NULL || m > semicolon) return false;
        more = m[2] == '1';
        const char *end = strstr(semicolon, "\033\\");
        if (end == NULL || end - semicolon > 4097) return false;
        for (text = semicolon + 1; text < end; text += 4) {
            int a = base64_digit(text[0]), b = base64_digit(text[1]);
            int c = text[2] == '=' ? 0 : base64_digit(text[2]);
            int d = text[3] == '=' ? 0 : base64_digit(text[3]);
            if (a < 0 || b < 0 || c < 0 || d < 0) return false;
            uint8_t three[3] = {
                (uint8_t)(a << 2 | b >> 4), (uint8_t)(b << 4 | c >> 2), (uint8_t)(c << 6 | d)};
            collect(png, three, text[2] == '=' ? 1 : text[3] == '=' ? 2 : 3);
        }
        text = end + 2;
    }
    return *text == '\0';
}

/* The picture arrives as glint_image_to_rgb8 has it. */
static void kitty(void) {
    GlintImage image = make_image(97, 61, 5);
    CliTerminal terminal = {.graphics = CLI_GRAPHICS_KITTY, .interactive = true};
    CliFrame frame = {.pixels = (float *)image.pixels, .width = 97, .height = 61};
    CliBytes out = {0};
    Bytes png = {0};
    CHECK(cli_screen_encode(&terminal, &frame, 97, 61, &out));
    CHECK(read_kitty(cli_bytes_text(&out), &png));
    png_image header = {.version = PNG_IMAGE_VERSION};
    static uint8_t expected[3 * 97 * 61], actual[3 * 97 * 61];
    glint_image_to_rgb8(&image, expected);
    CHECK(png_image_begin_read_from_memory(&header, png.data, png.size));
    header.format = PNG_FORMAT_RGB;
    CHECK(header.width == 97 && header.height == 61);
    CHECK(png_image_finish_read(&header, NULL, actual, 0, NULL));
    CHECK(memcmp(expected, actual, sizeof actual) == 0);
    cli_bytes_reset(&out);
    free(png.data);
    free((float *)image.pixels);
}

/* ---------------------------------------------------------------- sizes */

static void sizes(void) {
    int width, height;
    cli_picture_fit(800, 400, 100, 100, false, &width, &height);
    CHECK(width == 100 && height == 50);
    cli_picture_fit(80, 40, 1000, 1000, false, &width, &height);
    CHECK(width == 80 && height == 40);
    cli_picture_fit(80, 40, 1000, 1000, true, &width, &height);
    CHECK(width == 1000 && height == 500);
    cli_picture_fit(10000, 1, 10, 10, false, &width, &height);
    CHECK(width == 10 && height == 1);
    /* Fewer pixels are means, and the sum of all stays; more are the nearest. */
    static const float small[] = {0, 0, 0, 1, 2, 3, 4, 4, 4, 8, 8, 8};
    float one[3], more[3 * 16];
    cli_picture_resize(small, 2, 2, one, 1, 1);
    CHECK(one[0] == 3.25f && one[1] == 3.5f && one[2] == 3.75f);
    cli_picture_resize(small, 2, 2, more, 4, 4);
    CHECK(more[0] == 0 && more[3 * 3] == 1 && more[3 * 15 + 1] == 8 && more[3 * 5] == 0);
    GlintImage image = make_image(31, 17, 9);
    float *some = calloc(3 * 7 * 5, sizeof *some);
    double sums[2] = {0};
    for (int i = 0; i < 31 * 17; i++) {
        float *pixel = (float *)image.pixels + 3 * i;
        pixel[0] = (float)(i % 13);
        sums[0] += (double)pixel[0] / (31 * 17);
    }
    cli_picture_resize(image.pixels, 31, 17, some, 7, 5);
    for (int i = 0; i < 35; i++) sums[1] += (double)some[3 * i] / 35;
    CHECK_NEAR(sums[1], sums[0], 1e-5);
    free(some);
    free((float *)image.pixels);
}

static void layouts(void) {
    CliTerminal terminal = {.columns = 80, .rows = 24, .cell_width = 10, .cell_height = 20};
    static float pixels[3];
    CliFrame frame = {.pixels = pixels, .width = 1, .height = 1, .full_width = 1600};
    frame.full_height = 900;
    terminal.graphics = CLI_GRAPHICS_BLOCKS;
    CliLayout layout = cli_screen_layout(&terminal, &frame);
    CHECK(layout.width == 80 && layout.height == 45 && layout.status_row == 23);
    CHECK_INT(layout.findings_rows, 0);
    terminal.graphics = CLI_GRAPHICS_SIXEL;
    layout = cli_screen_layout(&terminal, &frame);
    CHECK(layout.width == 800 && layout.height == 450);
    /* Errors get their lines, but no more than half of the screen. */
    cli_bytes_add_text(&frame.findings, "a\nb\nc\n");
    layout = cli_screen_layout(&terminal, &frame);
    CHECK(layout.findings_row == 20 && layout.findings_rows == 3 && layout.height == 400);
    for (int i = 0; i < 100; i++) cli_bytes_add_text(&frame.findings, "more\n");
    layout = cli_screen_layout(&terminal, &frame);
    CHECK(layout.findings_row == 12 && layout.findings_rows == 11);
    frame.pixels = NULL; /* there never was a picture */
    layout = cli_screen_layout(&terminal, &frame);
    CHECK(layout.findings_row == 0 && layout.findings_rows == 23 && layout.width == 0);
    cli_bytes_reset(&frame.findings);
    terminal.rows = terminal.columns = 1;
    layout = cli_screen_layout(&terminal, &frame);
    CHECK(layout.width == 0 && layout.status_row == 0);
}

/* A text from a scene cannot steer the terminal, and no line is longer than the screen. */
static void lines(void) {
    CliBytes out = {0};
    const char *next = cli_screen_line("a\033[2J\tb\302\233c\303\244 and so on\nsecond", 12, &out);
    CHECK_TEXT(cli_bytes_text(&out), "a?[2J b?c\303\244 a");
    CHECK_TEXT(next, "second");
    cli_bytes_clear(&out);
    CHECK_TEXT(cli_screen_line(next, 80, &out), "");
    CHECK_TEXT(cli_bytes_text(&out), "second");
    cli_bytes_reset(&out);
}

/* ---------------------------------------------------------------- what the terminal sends */

static void keys(void) {
    static const struct {
        const char *text;
        int key;
        bool shift;
    } all[] = {{"q", 'q', false}, {"+", '+', false}, {"\033[A", CLI_KEY_UP, false},
        {"\033[D", CLI_KEY_LEFT, false}, {"\033OC", CLI_KEY_RIGHT, false},
        {"\033[1;2B", CLI_KEY_DOWN, true}, {"\033[1;5B", CLI_KEY_DOWN, false},
        {"\033[1;6C", CLI_KEY_RIGHT, true}, {"\033[3~", 0, false}, {"\033[200~", 0, false},
        {"\003", 0, false}, {"\033x", 0, false}, {"\377", 0, false}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        char text[32];
        size_t length, size = strlen(all[i].text);
        snprintf(text, sizeof text, "%sq", all[i].text);
        CliInput input = cli_terminal_key(text, size + 1, true, &length);
        CHECK_INT(length, size);
        CHECK_INT(input.kind, all[i].key != 0 ? CLI_INPUT_KEY : CLI_INPUT_NONE);
        CHECK(input.key == all[i].key && input.shift == all[i].shift);
        /* A part of it waits for the rest. */
        for (size_t part = 1; part < size; part++) {
            cli_terminal_key(text, part, true, &length);
            CHECK_INT(length, 0);
        }
    }
    size_t length;
    CHECK_INT(cli_terminal_key("\033", 1, true, &length).kind, CLI_INPUT_NONE);
    CHECK_INT(length, 0);
    CHECK_INT(cli_terminal_key("\033", 1, false, &length).key, CLI_KEY_ESCAPE);
    CHECK_INT(length, 1);
    cli_terminal_key("\033[1;", 4, false, &length);
    CHECK_INT(length, 4); /* nothing more will come */
    cli_terminal_key("", 0, true, &length);
    CHECK_INT(length, 0);
}

static void answers(void) {
    static const char kitty_says[] = "\033_Gi=31;OK\033\\\033[6;20;10t\033[?62;c";
    static const char xterm_says[] = "\033[6;17;9t\033[?63;1;2;4;6;9;15;22c";
    static const char others_say[] = "\033[?1;2c", wrong[] = "\033_Gi=31;ENOTSUP\033\\\033[?64;14c";
    CliTerminalAnswer answer = cli_terminal_read_answer(kitty_says, sizeof kitty_says - 1);
    CHECK(answer.complete && answer.kitty && !answer.sixel);
    CHECK(answer.cell_width == 10 && answer.cell_height == 20);
    answer = cli_terminal_read_answer(xterm_says, sizeof xterm_says - 1);
    CHECK(answer.complete && !answer.kitty && answer.sixel && answer.cell_width == 9);
    answer = cli_terminal_read_answer(others_say, sizeof others_say - 1);
    CHECK(answer.complete && !answer.kitty && !answer.sixel && answer.cell_width == 0);
    answer = cli_terminal_read_answer(wrong, sizeof wrong - 1);
    CHECK(answer.complete && !answer.kitty && !answer.sixel);
    char part[64];
    snprintf(part, sizeof part, "%.*s", (int)sizeof xterm_says - 2, xterm_says);
    CHECK(!cli_terminal_read_answer(part, strlen(part)).complete);
}

/* ---------------------------------------------------------------- letters */

static int count_ink(const CliSheet *sheet) {
    int ink = 0;
    for (int i = 0; i < sheet->width * sheet->height; i++) ink += sheet->rgba[4 * i + 3] == 255;
    return ink;
}

static void letters(void) {
    CHECK_INT(cli_letters_rows("", 10), 0);
    CHECK_INT(cli_letters_rows("one\n", 10), 1);
    CHECK_INT(cli_letters_rows("one\n\nthree", 10), 3);
    CHECK_INT(cli_letters_rows("word word word", 10), 2);
    CHECK_INT(cli_letters_rows("   spaces are not cut", 10), 3); /* an excerpt */
    CHECK_INT(cli_letters_rows("abcdefghijkl", 10), 2);
    enum { WIDTH = 100, HEIGHT = 60 };
    CliSheet sheet = {calloc(4, WIDTH * HEIGHT), WIDTH, HEIGHT};
    if (sheet.rgba == NULL) return;
    CHECK_INT(cli_letters_draw(&sheet, "", 1), 0);
    CHECK_INT(count_ink(&sheet), 0);
    int height = cli_letters_draw(&sheet, "i", 1);
    int once = count_ink(&sheet);
    CHECK(height == CLI_LETTER_HEIGHT + 8 && once == 9);
    CHECK_INT(cli_letters_draw(&sheet, "i", 2), 2 * CLI_LETTER_HEIGHT + 8);
    CHECK_INT(count_ink(&sheet), 4 * once);
    /* Every letter is another, and more than fits is cut. */
    CliBytes seen = {0};
    for (char c = '!'; c <= '~'; c++) {
        char text[2] = {c, '\0'};
        memset(sheet.rgba, 0, 4 * WIDTH * HEIGHT);
        cli_letters_draw(&sheet, text, 1);
        for (size_t at = 0; at + 4 * WIDTH * 20 <= seen.size; at += 4 * WIDTH * 20) {
            CHECK(memcmp(seen.data + at, sheet.rgba, 4 * WIDTH * 20) != 0);
        }
        cli_bytes_add(&seen, sheet.rgba, 4 * WIDTH * 20);
    }
    cli_bytes_reset(&seen);
    CHECK_INT(cli_letters_draw(&sheet, "a\nb\nc\nd\ne\nf\ng\nh\ni\n", 2), HEIGHT);
    free(sheet.rgba);
}

const GiTest tests_watch_screen[] = {TEST(blocks), TEST(nearest_of_256), TEST(sixel), TEST(kitty),
    TEST(sizes), TEST(layouts), TEST(lines), TEST(keys), TEST(answers), TEST(letters), TEST_END};
