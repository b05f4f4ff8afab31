/* SPDX-License-Identifier: MIT
 * Places and curves. Curves act on linear values v; what a correct program writes is
 * 255 v^(1/2.2), rounded. */
#include "mistake/mistake.h"

#include "math/elementary.h"
#include "math/gamma.h"

#include <math.h>

/* ---------------------------------------------------------------- places */

void gi_mistake_place(const GlintMistakes *mistakes, int width, int height, int *x, int *y) {
    if (GI_MISTAKE_HAS(mistakes, MIRRORED)) *x = width - 1 - *x;
    if (GI_MISTAKE_HAS(mistakes, FLIPPED)) *y = height - 1 - *y;
    if (GI_MISTAKE_HAS(mistakes, TRANSPOSED) && width == height) {
        int old = *x;
        *x = *y, *y = old;
    }
}

/* ---------------------------------------------------------------- curves */

/* From 0 to 1; what is no number becomes 0, as in a correct picture. */
static double clamp(double v) { return v > 0 ? (v < 1 ? v : 1) : 0; }

static double encode(double v) { return gi_pow(v, 1 / 2.2); }
static double decode(double c) { return gi_pow(c, 2.2); }

/* IEC 61966-2-1. */
static double encode_srgb(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * gi_pow(v, 1 / 2.4) - 0.055;
}

/* The byte of a value beyond 1, which a program that does not clamp cuts to its low eight bits. */
static double wrap(double c, double rounding) {
    double whole = floor(255 * c + rounding);
    return whole < 1e15 ? whole - 256 * floor(whole / 256) : 255;
}

/* The value whose byte the mistakes want, 0 to 255, as a whole number. */
static double written(const GlintMistakes *mistakes, double v) {
    v = v > 0 ? v : 0;
    double c;
    if (GI_MISTAKE_HAS(mistakes, GAMMA_MISSING)) {
        c = v;
    } else if (GI_MISTAKE_HAS(mistakes, SRGB)) {
        c = encode_srgb(v);
    } else {
        c = encode(v);
    }
    if (GI_MISTAKE_HAS(mistakes, GAMMA_TWICE)) c = encode(c);
    double rounding = GI_MISTAKE_HAS(mistakes, TRUNCATED) ? 0 : 0.5;
    return GI_MISTAKE_HAS(mistakes, WRAPPED) ? wrap(c, rounding) : floor(255 * clamp(c) + rounding);
}

/* Whether the byte is not simply that of a linear value. */
static bool writes_wrongly(const GlintMistakes *mistakes) {
    const uint64_t wrong =
        GLINT_MISTAKE_BIT(GLINT_MISTAKE_GAMMA_MISSING) |
        GLINT_MISTAKE_BIT(GLINT_MISTAKE_GAMMA_TWICE) | GLINT_MISTAKE_BIT(GLINT_MISTAKE_SRGB) |
        GLINT_MISTAKE_BIT(GLINT_MISTAKE_TRUNCATED) | GLINT_MISTAKE_BIT(GLINT_MISTAKE_WRAPPED);
    return (mistakes->set & wrong) != 0;
}

static void exchange(const GlintMistakes *mistakes, const float linear[3], float color[3]) {
    bool bgr = GI_MISTAKE_HAS(mistakes, BGR);
    double factor = GI_MISTAKE_HAS(mistakes, BRIGHTNESS) ? gi_mistake_factor(mistakes) : 1;
    for (int i = 0; i < 3; i++) color[i] = (float)((double)linear[bgr ? 2 - i : i] * factor);
}

void gi_mistake_bytes(const GlintMistakes *mistakes, const float linear[3], uint8_t bytes[3]) {
    float color[3];
    exchange(mistakes, linear, color);
    if (!writes_wrongly(mistakes)) {
        gi_gamma_encode(color, 3, bytes);
        return;
    }
    for (int i = 0; i < 3; i++) bytes[i] = (uint8_t)written(mistakes, (double)color[i]);
}

void gi_mistake_apply(
    const GlintMistakes *mistakes, int width, int height, const float *from, float *to) {
    bool wrong = writes_wrongly(mistakes);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++, to += 3) {
            int from_x = x, from_y = y;
            gi_mistake_place(mistakes, width, height, &from_x, &from_y);
            exchange(mistakes, from + 3 * ((size_t)from_y * (size_t)width + (size_t)from_x), to);
            for (int i = 0; wrong && i < 3; i++) {
                to[i] = (float)decode(written(mistakes, (double)to[i]) / 255);
            }
        }
    }
}
