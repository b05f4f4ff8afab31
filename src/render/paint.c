/* SPDX-License-Identifier: MIT */
#include "render/paint.h"

#include "math/elementary.h"

#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------- colours */

static double clamp(double x) { return x > 0 ? (x < 1 ? x : 1) : 0; }

GiVec gi_paint_shown(double red, double green, double blue) {
    const double gamma = 2.2; /* of the PNG, see math/gamma.h */
    return gi_vec(
        gi_pow(clamp(red), gamma), gi_pow(clamp(green), gamma), gi_pow(clamp(blue), gamma));
}

GiVec gi_paint_heat(double part) {
    static const double stops[][3] = {{0, 0, 0}, {0.15, 0.1, 0.55}, {0.55, 0.1, 0.6},
        {0.9, 0.2, 0.25}, {1, 0.6, 0.1}, {1, 0.95, 0.4}, {1, 1, 1}};
    enum { LAST = sizeof stops / sizeof *stops - 1 };
    double at = clamp(part) * LAST;
    int i = at < LAST ? (int)at : LAST - 1;
    double rest = at - i, shown[3];
    for (int k = 0; k < 3; k++) {
        shown[k] = stops[i][k] + rest * (stops[i + 1][k] - stops[i][k]);
    }
    return gi_paint_shown(shown[0], shown[1], shown[2]);
}

/* Hues a golden section apart, so that neighbouring numbers look different. */
GiVec gi_paint_number(uint32_t number) {
    uint32_t turned = number * UINT32_C(2654435769);
    double hue = turned * 0x1p-32 * 6, shown[3];
    double value = number % 3 == 0 ? 1 : number % 3 == 1 ? 0.8 : 0.6;
    double pale = number % 2 == 0 ? 0.15 : 0.4;
    for (int k = 0; k < 3; k++) {
        double from = fabs(fmod(hue + 2 * k, 6) - 3) - 1; /* below 0 and above 1 it is cut off */
        shown[k] = value * (pale + (1 - pale) * clamp(from));
    }
    return gi_paint_shown(shown[0], shown[1], shown[2]);
}

/* ---------------------------------------------------------------- digits */

enum { DIGIT_WIDTH = 5, DIGIT_HEIGHT = 7 };

static const char *const digits[10] = {
    ".###."
    "#...#"
    "#..##"
    "#.#.#"
    "##..#"
    "#...#"
    ".###.",
    "..#.."
    ".##.."
    "..#.."
    "..#.."
    "..#.."
    "..#.."
    ".###.",
    ".###."
    "#...#"
    "....#"
    "...#."
    "..#.."
    ".#..."
    "#####",
    ".###."
    "#...#"
    "....#"
    "..##."
    "....#"
    "#...#"
    ".###.",
    "...#."
    "..##."
    ".#.#."
    "#..#."
    "#####"
    "...#."
    "...#.",
    "#####"
    "#...."
    "####."
    "....#"
    "....#"
    "#...#"
    ".###.",
    ".###."
    "#...."
    "#...."
    "####."
    "#...#"
    "#...#"
    ".###.",
    "#####"
    "....#"
    "...#."
    "..#.."
    "..#.."
    ".#..."
    ".#...",
    ".###."
    "#...#"
    "#...#"
    ".###."
    "#...#"
    "#...#"
    ".###.",
    ".###."
    "#...#"
    "#...#"
    ".####"
    "....#"
    "....#"
    ".###.",
};

typedef struct Canvas {
    float *pixels;
    int width;
    int scale;     /* pixels a dot, across and down */
    int left, top; /* of the legend */
} Canvas;

/* A dot of the legend. */
static void put(const Canvas *canvas, int x, int y, GiVec color) {
    for (int down = 0; down < canvas->scale; down++) {
        for (int across = 0; across < canvas->scale; across++) {
            size_t row = (size_t)(canvas->top + y * canvas->scale + down);
            size_t column = (size_t)(canvas->left + x * canvas->scale + across);
            float *pixel = canvas->pixels + 3 * (row * (size_t)canvas->width + column);
            pixel[0] = (float)color.x, pixel[1] = (float)color.y, pixel[2] = (float)color.z;
        }
    }
}

static int text_width(const char *text) { return (int)strlen(text) * (DIGIT_WIDTH + 1) - 1; }

static void put_text(const Canvas *canvas, int x, int y, const char *text) {
    for (; *text != '\0'; text++, x += DIGIT_WIDTH + 1) {
        for (int i = 0; i < DIGIT_WIDTH * DIGIT_HEIGHT; i++) {
            if (digits[*text - '0'][i] != '#') continue;
            put(canvas, x + i % DIGIT_WIDTH, y + i / DIGIT_WIDTH, gi_vec(1, 1, 1));
        }
    }
}

/* ---------------------------------------------------------------- the legend
 *
 *     .........................       margin
 *     .#######################.       the bar
 *     .0          60       120.       numbers
 */

enum { MARGIN = 3, BAR_WIDTH = 120, BAR_HEIGHT = 6, GAP = 2 };

void gi_paint_legend(float *pixels, int width, int height, double top) {
    enum { WIDTH = BAR_WIDTH + 2 * MARGIN };
    enum { HEIGHT = MARGIN + BAR_HEIGHT + GAP + DIGIT_HEIGHT + MARGIN };
    int scale = height / 400 + 1;
    while (scale > 1 && WIDTH * scale * 2 > width) scale--;
    if (WIDTH * scale > width || HEIGHT * scale * 2 > height) return;
    const Canvas canvas = {pixels, width, scale, 0, height - HEIGHT * scale};
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            bool bar =
                x >= MARGIN && x < MARGIN + BAR_WIDTH && y >= MARGIN && y < MARGIN + BAR_HEIGHT;
            double part = (x - MARGIN) / (double)(BAR_WIDTH - 1);
            put(&canvas, x, y, bar ? gi_paint_heat(part) : gi_vec(0, 0, 0));
        }
    }
    char text[32];
    int row = MARGIN + BAR_HEIGHT + GAP;
    put_text(&canvas, MARGIN, row, "0");
    snprintf(text, sizeof text, "%.0f", top / 2);
    put_text(&canvas, MARGIN + BAR_WIDTH / 2 - text_width(text) / 2, row, text);
    snprintf(text, sizeof text, "%.0f", top);
    put_text(&canvas, MARGIN + BAR_WIDTH - text_width(text), row, text);
}
