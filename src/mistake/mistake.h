/* SPDX-License-Identifier: MIT
 * Mistakes of finished pictures: each pixel is some pixel of the right picture, put through a curve
 * that is wrong. Those of the scene are made by render/broken.h. A picture is drawn with mistakes,
 * and tested for them, by the same functions. */
#pragma once

#include "glint/glint.h"

#define GI_MISTAKE_HAS(mistakes, NAME)                                                             \
    (((mistakes)->set & GLINT_MISTAKE_BIT(GLINT_MISTAKE_##NAME)) != 0)

/* The set of those that concern the finished picture alone. */
#define GI_MISTAKES_OF_PICTURE                                                                     \
    ((GLINT_MISTAKE_BIT(GLINT_MISTAKE_COUNT) - 1) & ~(GLINT_MISTAKE_BIT(GLINT_MISTAKE_FLIPPED) - 1))

/* Null, or what is wrong with these numbers; light_count: of the scene. */
const char *gi_mistake_check(const GlintMistakes *mistakes, int light_count);

/* How far they go, where it is not said. */
double gi_mistake_factor(const GlintMistakes *mistakes);
void gi_mistake_shift(const GlintMistakes *mistakes, int *x, int *y);

/* The pixel of the right picture that a wrong one of the same size shows at (*x, *y). */
void gi_mistake_place(const GlintMistakes *mistakes, int width, int height, int *x, int *y);

/* The three bytes that stand in the wrong picture for this linear colour. */
void gi_mistake_bytes(const GlintMistakes *mistakes, const float linear[3], uint8_t bytes[3]);

/* The picture with the mistakes: linear values again, whose bytes are those of gi_mistake_bytes
 * where a mistake is one of writing bytes. from and to, width * height * 3, are not the same. */
void gi_mistake_apply(
    const GlintMistakes *mistakes, int width, int height, const float *from, float *to);
