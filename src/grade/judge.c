/* SPDX-License-Identifier: MIT
 * From numbers to a verdict, and to words. */
#include "grade/grade.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------- verdict */

/* Less than this is not "most". */
#define LEAST_EXPLAINED 0.75

/* Whether the second leaves clearly more unexplained than the first: twice as much, and not only a
 * trace of the whole. What fits to the last pixel needs less of a lead. */
static bool is_rival(double first, double second) {
    double a = 1 - first, b = 1 - second, lead = a < 0.001 ? 0.005 : 0.02;
    return !(b >= 2 * a && b - a >= lead);
}

void gi_grade_judge(GlintGrade *grade) {
    const GlintHypothesis *list = grade->hypotheses;
    double best = grade->hypothesis_count > 0 ? list[0].explains : 0;
    grade->rivals = 0;
    if (best < LEAST_EXPLAINED) {
        bool isolated = grade->comparison.percent <= GI_GRADE_ISOLATED;
        grade->verdict = isolated ? GLINT_VERDICT_ROUNDING : GLINT_VERDICT_UNCLEAR;
        if (isolated) grade->hypothesis_count = 0;
        return;
    }
    for (int i = 0; i < grade->hypothesis_count; i++) {
        grade->rivals += is_rival(best, list[i].explains);
    }
    grade->verdict = grade->rivals == 1 ? GLINT_VERDICT_EXPLAINED : GLINT_VERDICT_UNCLEAR;
}

const char *glint_verdict_name(GlintVerdict verdict) {
    static const char *const names[] = {"same", "rounding", "explained", "unclear"};
    return (unsigned)verdict < sizeof names / sizeof names[0] ? names[verdict] : NULL;
}

/* ---------------------------------------------------------------- words */

typedef struct Text {
    char *buffer;
    size_t size, length;
} Text;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
add(Text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    size_t used = text->length < text->size ? text->length : text->size;
    char *to = text->size > 0 ? text->buffer + used : NULL;
    int count = vsnprintf(to, text->size - used, format, arguments);
    va_end(arguments);
    if (count > 0) text->length += (size_t)count;
}

static void add_half_pixels(Text *text, int count, const char *forward, const char *backward) {
    int size = count < 0 ? -count : count;
    static const char *const sizes[] = {"", "half a pixel", "a pixel", "1.5 pixels", "2 pixels"};
    if (count != 0) add(text, " %s %s", sizes[size], count > 0 ? forward : backward);
}

static void add_mistake(Text *text, GlintMistake mistake, const GlintMistakes *mistakes) {
    if (mistake == GLINT_MISTAKE_SHIFTED && (mistakes->shift_x != 0 || mistakes->shift_y != 0)) {
        add(text, "the picture is shifted:");
        add_half_pixels(text, mistakes->shift_x, "to the right", "to the left");
        if (mistakes->shift_x != 0 && mistakes->shift_y != 0) add(text, " and");
        add_half_pixels(text, mistakes->shift_y, "down", "up");
    } else if (mistake == GLINT_MISTAKE_LIGHT_MISSING) {
        add(text, "light %d is missing", mistakes->light > 0 ? mistakes->light : 1);
    } else if (mistake == GLINT_MISTAKE_BRIGHTNESS) {
        double factor = mistakes->factor > 0 ? mistakes->factor : 0.5;
        const char *known = fabs(factor * 3.14159265358979 - 1) < 1e-6   ? " (1/pi)"
                            : fabs(factor / 3.14159265358979 - 1) < 1e-6 ? " (pi)"
                                                                         : "";
        add(text, "all light has the factor %.3g%s", factor, known);
    } else {
        add(text, "%s", glint_mistake_text(mistake));
    }
    add(text, " (%s)", glint_mistake_name(mistake));
}

static void add_hypothesis(Text *text, const GlintHypothesis *hypothesis) {
    bool first = true;
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        if ((hypothesis->mistakes.set >> i & 1) == 0) continue;
        if (!first) add(text, ", and ");
        add_mistake(text, (GlintMistake)i, &hypothesis->mistakes);
        first = false;
    }
}

/* Rounded down, so that 100 % means all of it. */
static int percent_of(const GlintHypothesis *hypothesis) {
    double percent = floor(100 * hypothesis->explains + 1e-9);
    return percent > 0 ? (int)percent : 0;
}

static void add_rounding(Text *text, const GlintGrade *grade) {
    if (grade->comparison.percent > 0) {
        add(text, "the same but for isolated pixels (%.2g %%)%s", grade->comparison.percent,
            grade->tried > 0 ? ", which no mistake that was tried explains" : "");
        return;
    }
    add(text, "the same up to rounding: no value differs by more than %d", grade->comparison.max);
    if (grade->hypothesis_count == 0) return;
    add(text, "; ");
    add_hypothesis(text, &grade->hypotheses[0]);
}

static void add_unclear(Text *text, const GlintGrade *grade) {
    const GlintHypothesis *list = grade->hypotheses;
    if (grade->rivals < 2) {
        add(text, "unclear: no mistake that was tried explains most of the difference");
        if (grade->hypothesis_count == 0 || percent_of(&list[0]) < 10) return;
        add(text, "; the nearest explains %d %%: ", percent_of(&list[0]));
        add_hypothesis(text, &list[0]);
        return;
    }
    add(text, "unclear: ");
    for (int i = 0; i < grade->rivals; i++) {
        if (i > 0) add(text, "; or ");
        add_hypothesis(text, &list[i]);
        add(text, ": %d %%", percent_of(&list[i]));
    }
}

static void add_verdict(Text *text, const GlintGrade *grade) {
    if (grade->size_differs) {
        const GlintImage *own = &grade->reference;
        bool exchanged = own->width == grade->height && own->height == grade->width;
        add(text, "the size is wrong, it should be %d x %d%s; apart from that: ", grade->width,
            grade->height, exchanged ? " (width and height are exchanged)" : "");
    }
    switch (grade->verdict) {
    case GLINT_VERDICT_SAME: add(text, "the same"); break;
    case GLINT_VERDICT_ROUNDING: add_rounding(text, grade); break;
    case GLINT_VERDICT_EXPLAINED:
        add_hypothesis(text, &grade->hypotheses[0]);
        add(text, ": explains %d %% of the difference", percent_of(&grade->hypotheses[0]));
        break;
    case GLINT_VERDICT_UNCLEAR: add_unclear(text, grade); break;
    }
}

static size_t finish(Text *text) {
    if (text->size > 0 && text->length == 0) text->buffer[0] = '\0';
    return text->length;
}

size_t glint_grade_format(const GlintGrade *grade, char *buffer, size_t size) {
    Text text = {buffer, size, 0};
    add_verdict(&text, grade);
    return finish(&text);
}

size_t glint_hypothesis_format(const GlintHypothesis *hypothesis, char *buffer, size_t size) {
    Text text = {buffer, size, 0};
    add_hypothesis(&text, hypothesis);
    return finish(&text);
}
