/* SPDX-License-Identifier: MIT
 * The text of a value element: collected in pieces, read when the element ends. The numbers of a
 * correct value are read in one quick pass; a second pass finds out what is wrong with the rest. */
#include "reader/state.h"

#include "reader/number.h"
#include "reader/suggest.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/* ---------------------------------------------------------------- correct values */

static bool is_whole(const char *text, size_t size) {
    size_t i = size > 0 && (text[0] == '-' || text[0] == '+');
    if (i == size) return false;
    for (; i < size; i++) {
        if (text[i] < '0' || text[i] > '9') return false;
    }
    return true;
}

static double *component(GiVec *value, int index) {
    return index == 0 ? &value->x : index == 1 ? &value->y : &value->z;
}

/* False when anything is wrong. */
static bool read_quickly(const char *text, size_t size, GiKind kind, GiVec *value) {
    int count = gi_kind_count(kind);
    size_t i = 0;
    *value = gi_vec(0, 0, 0);
    for (int n = 0; n < count; n++) {
        size_t used;
        while (i < size && is_space(text[i])) i++;
        if (gi_number_read(text + i, size - i, component(value, n), &used) != GI_NUMBER_OK ||
            (i + used < size && !is_space(text[i + used]))) {
            return false;
        }
        if ((kind == GI_KIND_INTEGER || kind == GI_KIND_INTEGER_PAIR) &&
            (!is_whole(text + i, used) || fabs(*component(value, n)) > INT_MAX)) {
            return false;
        }
        i += used;
    }
    while (i < size && is_space(text[i])) i++;
    return i == size;
}

/* ---------------------------------------------------------------- collecting */

void gi_value_begin(GiReader *reader) {
    reader->text_size = 0;
    reader->segment_count = 0;
    reader->text_next = -1;
    reader->text_overflow = false;
    reader->value_ready = false;
}

static void append(GiReader *reader, const char *text, size_t size, int64_t offset) {
    if (offset != reader->text_next && reader->segment_count < GI_SEGMENT_LIMIT) {
        reader->segments[reader->segment_count++] =
            (GiSegment){reader->text_size, {.offset = offset}};
    }
    memcpy(reader->text + reader->text_size, text, size);
    reader->text_size += size;
    reader->text_next = offset + gi_window_span(&reader->window, text, size);
}

/* Where the character at an index of the text stands in the file. */
static GiPlace place_of(const GiReader *reader, const GiFrame *frame, size_t index) {
    const GiSegment *segment = NULL;
    for (size_t i = 0; i < reader->segment_count && reader->segments[i].index <= index; i++) {
        segment = &reader->segments[i];
    }
    if (segment == NULL) return frame->place;
    GiPlace place = segment->place;
    const char *text = reader->text + segment->index;
    size_t size = index - segment->index;
    place.offset += gi_window_span(&reader->window, text, size);
    if (place.line == 0) return place;
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '\n') {
            place.line++;
            place.column = 1;
        } else {
            place.column += ((unsigned char)text[i] & 0xc0) != 0x80;
        }
    }
    return place;
}

void gi_value_append(GiReader *reader, GiSpan piece, int64_t offset) {
    const char *text = piece.data;
    size_t size = piece.size;
    if (reader->text_overflow) return;
    /* The common case: short text, kept as it is. Mostly the first piece is all there is; it is
     * read here, since reading the copy would have to wait for the copy. */
    if (size <= GI_TEXT_LIMIT / 2 && reader->text_size <= GI_TEXT_LIMIT / 2 - size) {
        GiKind kind = gi_reader_top(reader)->element->kind;
        reader->value_ready =
            reader->text_size == 0 && read_quickly(text, size, kind, &reader->value);
        append(reader, text, size, offset);
        return;
    }
    reader->value_ready = false;
    /* Otherwise white space shrinks to one blank, so that any amount of it is bounded. */
    for (size_t i = 0; i < size;) {
        size_t begin = i;
        bool space = is_space(text[i]);
        while (i < size && is_space(text[i]) == space) i++;
        bool after_space = reader->text_size == 0 || is_space(reader->text[reader->text_size - 1]);
        if (space && after_space) continue;
        size_t length = space ? 1 : i - begin;
        int64_t at = offset + gi_window_span(&reader->window, text, begin);
        if (length > GI_TEXT_LIMIT - reader->text_size) {
            reader->text_overflow = true;
            GiFrame *frame = gi_reader_top(reader);
            size_t first = 0;
            while (first < reader->text_size && is_space(reader->text[first])) first++;
            frame->broken = true;
            gi_report_add(&reader->report,
                first < reader->text_size ? place_of(reader, frame, first) : (GiPlace){at, 0, 0}, 1,
                "the value of %s is too long: more than %d characters", frame->element->name,
                GI_TEXT_LIMIT);
            return;
        }
        append(reader, text + begin, length, at);
    }
}

/* ---------------------------------------------------------------- tokens */

typedef struct Token {
    size_t begin, end;
} Token;

static bool next_token(const GiReader *reader, size_t *position, Token *token) {
    size_t i = *position;
    while (i < reader->text_size && is_space(reader->text[i])) i++;
    token->begin = i;
    while (i < reader->text_size && !is_space(reader->text[i])) i++;
    token->end = *position = i;
    return token->begin < token->end;
}

static int token_length(const GiReader *reader, Token token) {
    return gi_text_length(reader->text + token.begin, token.end - token.begin);
}

/* One number that is the whole token; null, or what is wrong with it. */
static const char *read_number(const char *text, size_t size, GiKind kind, double *value) {
    size_t used;
    GiNumberStatus status = gi_number_read(text, size, value, &used);
    bool whole = kind == GI_KIND_INTEGER || kind == GI_KIND_INTEGER_PAIR;
    if (status == GI_NUMBER_MALFORMED || used != size) {
        if (size >= 3 && memchr(text, ',', size) != NULL) {
            return "is not a number: write a point in it and white space between numbers, no comma";
        }
        size_t sign = text[0] == '-' || text[0] == '+';
        static const char *const words[] = {"inf", "infinity", "nan"};
        for (int i = 0; i < 3; i++) {
            size_t length = strlen(words[i]);
            if (size - sign == length &&
                gi_edit_distance(text + sign, length, words[i], length, 0) == 0) {
                return "is not a finite number";
            }
        }
        if (size - sign > 2 && text[sign] == '0' && gi_lower(text[sign + 1]) == 'x') {
            return "is not a number: hexadecimal is not allowed";
        }
        return whole ? "is not a whole number" : "is not a number";
    }
    if (whole && *value != floor(*value)) return "is not a whole number";
    if (whole && fabs(*value) > INT_MAX) return "is too large: the limit is 2147483647";
    if (whole && !is_whole(text, size)) return "is whole: write it without a point or exponent";
    if (status == GI_NUMBER_TOO_LARGE) return "is too large: the limit is about 1.8e308";
    return NULL;
}

/* ---------------------------------------------------------------- errors */

static void report_count(GiReader *reader, const GiFrame *frame, int wanted) {
    Token token, surplus = {0, 0}, first = {0, 0}, last = {0, 0};
    size_t position = 0;
    int found = 0;
    while (next_token(reader, &position, &token)) {
        if (found == 0) first = token;
        if (found == wanted) surplus = token;
        last = token;
        found++;
    }
    char number[16];
    snprintf(number, sizeof number, found == 0 ? "none" : "%d", found);
    GiPlace place = found == 0       ? frame->place
                    : found > wanted ? place_of(reader, frame, surplus.begin)
                                     : place_of(reader, frame, first.begin);
    int length = found == 0       ? 1 + gi_text_length(reader->tags.data + frame->tag,
                                            strlen(reader->tags.data + frame->tag))
                 : found > wanted ? token_length(reader, surplus)
                                  : token_length(reader, (Token){first.begin, last.end});
    const char *meaning = frame->element->kind == GI_KIND_INTEGER_PAIR ? ", width and height" : "";
    gi_report_add(&reader->report, place, length, "%s needs %d number%s%s; found %s",
        frame->element->name, wanted, wanted == 1 ? "" : "s", meaning, number);
}

static void report_tokens(GiReader *reader, const GiFrame *frame, int count) {
    Token token;
    size_t position = 0;
    bool bad = false;
    while (next_token(reader, &position, &token) && !gi_report_is_full(&reader->report)) {
        double value;
        const char *text = reader->text + token.begin;
        size_t size = token.end - token.begin;
        const char *fault = read_number(text, size, frame->element->kind, &value);
        if (fault == NULL) continue;
        char quote[GI_QUOTE_SIZE];
        gi_report_add(&reader->report, place_of(reader, frame, token.begin),
            token_length(reader, token), "%s: %s %s", frame->element->name,
            gi_quote(quote, text, size), fault);
        bad = true;
        break; /* one error a value: prose where numbers belong is one mistake */
    }
    if (!bad) report_count(reader, frame, count);
}

static bool read_choice(GiReader *reader, const GiFrame *frame, GiVec *value) {
    size_t position = 0;
    Token token, second;
    const char *choices = frame->element->choices;
    bool one = next_token(reader, &position, &token);
    bool more = one && next_token(reader, &position, &second);
    size_t size = token.end - token.begin;
    int number = 0;
    for (const char *word = choices; one && !more && *word != '\0'; number++) {
        size_t length = strcspn(word, " ");
        if (length == size && memcmp(word, reader->text + token.begin, size) == 0) {
            *value = gi_vec(number, 0, 0);
            return true;
        }
        word += length + strspn(word + length, " ");
    }
    char quote[GI_QUOTE_SIZE];
    size_t end = more ? second.end : token.end;
    gi_report_add(&reader->report, one ? place_of(reader, frame, token.begin) : frame->place,
        one ? token_length(reader, (Token){token.begin, end}) : 1,
        "%s must be one of the words: %s; found %s", frame->element->name, choices,
        one ? gi_quote(quote, reader->text + token.begin, end - token.begin) : "nothing");
    return false;
}

/* The text without the white space round it. */
static Token trim(const GiReader *reader) {
    Token all = {0, reader->text_size};
    while (all.begin < all.end && is_space(reader->text[all.begin])) all.begin++;
    while (all.begin < all.end && is_space(reader->text[all.end - 1])) all.end--;
    return all;
}

/* The value is the number of the text among the strings, and its length in characters. */
static bool read_string(GiReader *reader, const GiFrame *frame, GiVec *value) {
    Token all = trim(reader);
    if (all.begin == all.end) {
        const char *tag = reader->tags.data + frame->tag;
        gi_report_add(&reader->report, frame->place, 1 + gi_text_length(tag, strlen(tag)),
            "%s is empty: it is %s", frame->element->name, frame->element->help);
        return false;
    }
    GiSpan text = {reader->text + all.begin, all.end - all.begin};
    uint32_t number;
    if (!gi_names_intern(&reader->strings, text, &number)) {
        gi_reader_out_of_memory(reader);
        return false;
    }
    *value = gi_vec(number, gi_text_length(text.data, text.size), 0);
    return true;
}

/* ---------------------------------------------------------------- checks */

static bool passes(GiCheck check, GiVec value) {
    switch (check) {
    case GI_CHECK_NONE: break;
    case GI_CHECK_POSITIVE: return value.x > 0;
    case GI_CHECK_SAMPLES: return value.x >= 0 && value.x <= GI_SAMPLES_LIMIT;
    case GI_CHECK_LENGTH: return !gi_vec_is_zero(value);
    case GI_CHECK_NO_ZERO: return value.x != 0 && value.y != 0 && value.z != 0;
    case GI_CHECK_ANGLE: return value.x > 0 && value.x < 180;
    case GI_CHECK_BIT: return value.x == 0 || value.x == 1;
    case GI_CHECK_DEPTH: return value.x >= 1 && value.x <= GI_PATH_LIMIT;
    case GI_CHECK_IMAGE_SIZE: return gi_scene_check_image_size(value.x, value.y) == NULL;
    }
    return true;
}

bool gi_value_fits(const GiElement *element, GiVec value, int count) {
    bool real = element->kind == GI_KIND_REAL || gi_kind_count(element->kind) == 3;
    return real && count == gi_kind_count(element->kind) && passes(element->check, value);
}

bool gi_value_take(GiReader *reader, const GiElement *element, GiVec value, int count) {
    if (!gi_value_fits(element, value, count)) return false;
    reader->value = value;
    reader->value_ready = true;
    return true;
}

bool gi_value_check(
    GiReader *reader, const GiElement *element, GiVec value, GiPlace place, int length) {
    if (passes(element->check, value)) return true;
    GiReport *report = &reader->report;
    const char *name = element->name;
    switch (element->check) {
    case GI_CHECK_NONE: break;
    case GI_CHECK_POSITIVE:
        gi_report_add(report, place, length, "%s must be positive; found %g", name, value.x);
        break;
    case GI_CHECK_SAMPLES:
        gi_report_add(report, place, length, "%s must be from 1 to %d; found %.0f", name,
            GI_SAMPLES_LIMIT, value.x);
        break;
    case GI_CHECK_LENGTH:
        gi_report_add(
            report, place, length, "%s must not be the zero vector: it has no direction", name);
        break;
    case GI_CHECK_NO_ZERO:
        gi_report_add(report, place, length,
            "%s must have no zero in it: the group would be flat; found %g %g %g (1 keeps a size)",
            name, value.x, value.y, value.z);
        break;
    case GI_CHECK_ANGLE:
        gi_report_add(report, place, length,
            "%s must be an angle between 0 and 180 degrees, both excluded; found %g", name,
            value.x);
        break;
    case GI_CHECK_BIT:
        gi_report_add(report, place, length, "%s must be 0 or 1; found %.0f", name, value.x);
        break;
    case GI_CHECK_DEPTH:
        gi_report_add(report, place, length, "%s must be from 1 to %d; found %.0f", name,
            GI_PATH_LIMIT, value.x);
        break;
    case GI_CHECK_IMAGE_SIZE:
        gi_report_add(report, place, length, "%s; found %.0f x %.0f",
            gi_scene_check_image_size(value.x, value.y), value.x, value.y);
        break;
    }
    return false;
}

bool gi_value_finish(GiReader *reader, const GiFrame *frame, GiVec *value) {
    const GiElement *element = frame->element;
    if (element->kind == GI_KIND_CHOICE) return read_choice(reader, frame, value);
    if (element->kind == GI_KIND_STRING) return read_string(reader, frame, value);
    if (!reader->value_ready &&
        !read_quickly(reader->text, reader->text_size, element->kind, &reader->value)) {
        report_tokens(reader, frame, gi_kind_count(element->kind));
        return false;
    }
    *value = reader->value;
    if (passes(element->check, *value)) return true;
    Token all = trim(reader);
    return gi_value_check(
        reader, element, *value, place_of(reader, frame, all.begin), token_length(reader, all));
}

GiPlace gi_value_place(const GiReader *reader, const GiFrame *frame) {
    return place_of(reader, frame, trim(reader).begin);
}

GiVec gi_value_parse_default(const char *text) {
    GiVec value = {0, 0, 0};
    for (int n = 0; n < 3 && *text != '\0'; n++) {
        size_t used;
        gi_number_read(text, strlen(text), component(&value, n), &used);
        text += used;
        text += strspn(text, " ");
    }
    return value;
}
