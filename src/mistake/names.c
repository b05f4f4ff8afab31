/* SPDX-License-Identifier: MIT
 * Mistakes as words. */
#include "mistake/mistake.h"

#include "base/error.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const names[] = {
#define MISTAKE_NAME(constant, name, text) name,
    GLINT_MISTAKE_LIST(MISTAKE_NAME)
#undef MISTAKE_NAME
};

static const char *const texts[] = {
#define MISTAKE_TEXT(constant, name, text) text,
    GLINT_MISTAKE_LIST(MISTAKE_TEXT)
#undef MISTAKE_TEXT
};

_Static_assert(GLINT_MISTAKE_COUNT < 64, "a set of mistakes has 64 bits");

const char *glint_mistake_name(GlintMistake mistake) {
    return (unsigned)mistake < GLINT_MISTAKE_COUNT ? names[mistake] : NULL;
}

const char *glint_mistake_text(GlintMistake mistake) {
    return (unsigned)mistake < GLINT_MISTAKE_COUNT ? texts[mistake] : NULL;
}

bool glint_mistake_from_name(const char *name, GlintMistake *mistake) {
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        if (strcmp(name, names[i]) == 0) {
            *mistake = (GlintMistake)i;
            return true;
        }
    }
    return false;
}

const char *gi_mistake_check(const GlintMistakes *mistakes, int light_count) {
    enum { SHIFT_LIMIT = 4 };
    if (mistakes->set >> GLINT_MISTAKE_COUNT != 0) return "there is no such mistake";
    if (mistakes->light < 0 || mistakes->light > light_count) {
        return "the light that is to be missing is not there";
    }
    if (mistakes->shift_x < -SHIFT_LIMIT || mistakes->shift_x > SHIFT_LIMIT ||
        mistakes->shift_y < -SHIFT_LIMIT || mistakes->shift_y > SHIFT_LIMIT) {
        return "a picture can be shifted by -4 to 4 half pixels";
    }
    if (!(mistakes->factor >= 0 && mistakes->factor <= 1e30)) {
        return "the factor of brightness must be from 0 to 1e30";
    }
    return NULL;
}

/* ---------------------------------------------------------------- numbers */

#define BILLION 1e9

double gi_mistake_factor(const GlintMistakes *mistakes) {
    double factor = mistakes->factor > 0 ? mistakes->factor : 0.5;
    return factor < 1e6 ? floor(factor * BILLION + 0.5) / BILLION : factor;
}

void gi_mistake_shift(const GlintMistakes *mistakes, int *x, int *y) {
    bool usual = mistakes->shift_x == 0 && mistakes->shift_y == 0;
    *x = usual ? 1 : mistakes->shift_x;
    *y = usual ? -1 : mistakes->shift_y;
}

/* A whole number of at most nine digits, with a sign if it may have one. */
static bool take_whole(const char **text, bool may_be_negative, int *number) {
    bool negative = may_be_negative && **text == '-';
    const char *at = *text + negative;
    int count = 0;
    *number = 0;
    for (; at[count] >= '0' && at[count] <= '9'; count++) {
        if (count == 9) return false;
        *number = 10 * *number + (at[count] - '0');
    }
    if (negative) *number = -*number;
    *text = at + count;
    return count > 0;
}

/* Digits, and up to nine more behind a point; the same in every locale. */
static bool take_factor(const char **text, double *factor) {
    int whole, part = 0;
    if (!take_whole(text, false, &whole)) return false;
    const char *digits = *text + 1;
    int64_t unit = 1;
    if (**text == '.') {
        *text = digits;
        if (!take_whole(text, false, &part)) return false;
        for (ptrdiff_t i = *text - digits; i > 0; i--) unit *= 10;
    }
    *factor = ((double)whole * (double)unit + part) / (double)unit;
    return *factor > 0;
}

/* ---------------------------------------------------------------- text */

/* What follows the name; *text is behind "=". */
static bool take_extent(const char **text, GlintMistake mistake, GlintMistakes *mistakes) {
    switch (mistake) {
    case GLINT_MISTAKE_LIGHT_MISSING:
        return take_whole(text, false, &mistakes->light) && mistakes->light > 0;
    case GLINT_MISTAKE_SHIFTED:
        if (!take_whole(text, true, &mistakes->shift_x) || *(*text)++ != ':') return false;
        return take_whole(text, true, &mistakes->shift_y);
    case GLINT_MISTAKE_BRIGHTNESS: return take_factor(text, &mistakes->factor);
    default: return false;
    }
}

bool glint_mistakes_parse(const char *text, GlintMistakes *mistakes, const char **wrong) {
    for (;; text++) {
        char word[32];
        size_t size = strcspn(text, ",=");
        GlintMistake mistake;
        snprintf(word, sizeof word, "%.*s", (int)(size < 31 ? size : 31), text);
        *wrong = text;
        if (!glint_mistake_from_name(word, &mistake)) return false;
        mistakes->set |= GLINT_MISTAKE_BIT(mistake);
        text += size;
        if (*text == '=') {
            text++;
            if (!take_extent(&text, mistake, mistakes)) return false;
        }
        if (*text == '\0') return true;
        if (*text != ',') return false;
    }
}

typedef struct Text {
    char *buffer;
    size_t size, length;
} Text;

GI_PRINTF(2, 3) static void add(Text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    size_t left = text->length < text->size ? text->size - text->length : 0;
    int count = vsnprintf(left > 0 ? text->buffer + text->length : NULL, left, format, arguments);
    va_end(arguments);
    if (count > 0) text->length += (size_t)count;
}

size_t glint_mistakes_format(const GlintMistakes *mistakes, char *buffer, size_t size) {
    Text text = {buffer, size, 0};
    add(&text, "%s", "");
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        if ((mistakes->set >> i & 1) == 0) continue;
        add(&text, "%s%s", text.length > 0 ? "," : "", names[i]);
        if (i == GLINT_MISTAKE_LIGHT_MISSING && mistakes->light > 1) {
            add(&text, "=%d", mistakes->light);
        } else if (i == GLINT_MISTAKE_SHIFTED) {
            int x, y;
            gi_mistake_shift(mistakes, &x, &y);
            if (x != 1 || y != -1) add(&text, "=%d:%d", x, y);
        } else if (i == GLINT_MISTAKE_BRIGHTNESS) {
            double factor = gi_mistake_factor(mistakes);
            double whole = floor(factor), part = floor((factor - whole) * BILLION + 0.5);
            if (factor != 0.5) add(&text, "=%.0f.%09d", whole, (int)part);
        }
    }
    return text.length;
}
