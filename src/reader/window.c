/* SPDX-License-Identifier: MIT */
#include "reader/window.h"

#include "base/array.h"

#include <string.h>

void gi_window_init(GiWindow *window, GiMemory *memory) {
    *window = (GiWindow){.memory = memory, .start = {0, 1, 1}, .cursor = {0, 1, 1}};
}

void gi_window_reset(GiWindow *window) {
    gi_memory_free(window->memory, window->data, window->capacity);
    window->data = NULL;
    window->size = window->capacity = 0;
}

bool gi_window_reserve(GiWindow *window, size_t more) {
    return gi_array_reserve_bytes(
        window->memory, (void **)&window->data, &window->capacity, window->size, more, 1);
}

void gi_window_detect(GiWindow *window) {
    const unsigned char *d = window->data;
    size_t n = window->size;
    if (n >= 2 && ((d[0] == 0xff && d[1] == 0xfe) || (d[0] == '<' && d[1] == 0))) {
        window->encoding = GI_ENCODING_UTF16_LE;
    } else if (n >= 2 && ((d[0] == 0xfe && d[1] == 0xff) || (d[0] == 0 && d[1] == '<'))) {
        window->encoding = GI_ENCODING_UTF16_BE;
    }
    /* A byte order mark is no character of the first line. */
    if (gi_window_at(window, 0) == 0xfeff || (n >= 3 && memcmp(d, "\xef\xbb\xbf", 3) == 0)) {
        window->start.column = window->cursor.column = 0;
    }
}

int gi_window_unit(const GiWindow *window) {
    return window->encoding >= GI_ENCODING_UTF16_LE ? 2 : 1;
}

unsigned gi_window_at(const GiWindow *window, int64_t offset) {
    int unit = gi_window_unit(window);
    if (offset < window->base || offset + unit > window->base + (int64_t)window->size) {
        return GI_WINDOW_END;
    }
    const unsigned char *p = window->data + (offset - window->base);
    if (window->encoding == GI_ENCODING_UTF16_LE) return p[0] | (unsigned)p[1] << 8;
    if (window->encoding == GI_ENCODING_UTF16_BE) return p[1] | (unsigned)p[0] << 8;
    return p[0];
}

/* Whether the unit begins a character: not a UTF-8 continuation, not the second of a pair. */
static bool begins_character(const GiWindow *window, unsigned unit) {
    switch (window->encoding) {
    case GI_ENCODING_UTF8: return (unit & 0xc0) != 0x80;
    case GI_ENCODING_LATIN1: return true;
    default: return (unit & 0xfc00) != 0xdc00;
    }
}

/* ---------------------------------------------------------------- lines and columns */

static void count_units(const GiWindow *window, int64_t offset, GiPlace *place) {
    int unit = gi_window_unit(window);
    for (; place->offset < offset; place->offset += unit) {
        unsigned c = gi_window_at(window, place->offset);
        if (c == '\n' || (c == '\r' && gi_window_at(window, place->offset + unit) != '\n')) {
            place->line++;
            place->column = 1;
        } else {
            place->column += begins_character(window, c);
        }
    }
}

static int64_t count_byte(const unsigned char *p, const unsigned char *end, unsigned char byte) {
    int64_t count = 0;
    while (p < end) {
        /* As many as one byte can count: the compiler makes this sixteen at a time. */
        const unsigned char *stop = end - p > 255 ? p + 255 : end;
        unsigned char some = 0;
        for (; p < stop; p++) some = (unsigned char)(some + (*p == byte));
        count += some;
    }
    return count;
}

/* The same for one-byte units: this sees every byte of a large file once. */
static void count_bytes(const GiWindow *window, int64_t offset, GiPlace *place) {
    const unsigned char *p = window->data + (place->offset - window->base);
    const unsigned char *end = window->data + (offset - window->base);
    const unsigned char *limit = window->data + window->size, *line_start = NULL;
    int64_t lines = count_byte(p, end, '\n');
    if (lines > 0) {
        /* A mapped file may be another one by now. */
        for (line_start = end; line_start > p && line_start[-1] != '\n';) line_start--;
        place->line += lines;
    }
    for (const unsigned char *q = p; (q = memchr(q, '\r', (size_t)(end - q))) != NULL;) {
        q++;
        if (q < limit && *q == '\n') continue;
        place->line++;
        if (line_start == NULL || q > line_start) line_start = q;
    }
    if (line_start != NULL) {
        place->column = 1;
        p = line_start;
    }
    if (window->encoding == GI_ENCODING_LATIN1) {
        place->column += end - p;
    } else {
        int64_t characters = 0;
        for (; p < end; p++) characters += (*p & 0xc0) != 0x80;
        place->column += characters;
    }
    place->offset = offset;
}

void gi_window_advance(const GiWindow *window, GiPlace *place, int64_t offset) {
    if (gi_window_unit(window) == 2) {
        count_units(window, offset, place);
    } else {
        count_bytes(window, offset, place);
    }
}

void gi_window_locate(GiWindow *window, GiPlace *place) {
    if (place->line != 0 || !gi_window_holds(window, place->offset)) return;
    GiPlace from = place->offset >= window->cursor.offset ? window->cursor : window->start;
    gi_window_advance(window, &from, place->offset);
    place->line = from.line;
    place->column = from.column > 0 ? from.column : 1;
    if (from.offset > window->cursor.offset) window->cursor = from;
}

void gi_window_discard(GiWindow *window, int64_t offset) {
    int unit = gi_window_unit(window);
    offset -= (offset - window->base) % unit;
    /* The two halves of a line end stay together, so that no state is needed to count them. */
    while (offset > window->base && gi_window_at(window, offset - unit) == '\r') offset -= unit;
    if (offset <= window->base) return;
    GiPlace start = {.offset = offset};
    gi_window_locate(window, &start);
    size_t gone = (size_t)(offset - window->base);
    memmove(window->data, window->data + gone, window->size - gone);
    window->size -= gone;
    window->base = offset;
    window->start = start;
    if (window->cursor.offset < offset) window->cursor = start;
}

int64_t gi_window_span(const GiWindow *window, const char *text, size_t size) {
    if (window->encoding == GI_ENCODING_UTF8) return (int64_t)size;
    int64_t units = 0;
    for (size_t i = 0; i < size; i++) {
        unsigned char c = (unsigned char)text[i];
        bool pair = c >= 0xf0 && window->encoding != GI_ENCODING_LATIN1;
        units += (c & 0xc0) == 0x80 ? 0 : pair ? 2 : 1;
    }
    return units * gi_window_unit(window);
}

/* ---------------------------------------------------------------- excerpts */

/* Decodes the character at *offset and moves past it. Broken and control characters are '?'. */
static uint32_t next_character(const GiWindow *window, int64_t *offset) {
    int unit = gi_window_unit(window);
    uint32_t c = gi_window_at(window, *offset);
    *offset += unit;
    if (unit == 2) {
        uint32_t low = gi_window_at(window, *offset);
        if (c >= 0xd800 && c < 0xdc00 && low >= 0xdc00 && low < 0xe000) {
            *offset += unit;
            return 0x10000 + ((c - 0xd800) << 10) + (low - 0xdc00);
        }
        if (c >= 0xd800 && c < 0xe000) return '?';
    } else if (window->encoding == GI_ENCODING_UTF8 && c >= 0x80) {
        int more = c >= 0xf0 && c < 0xf5 ? 3 : c >= 0xe0 && c < 0xf0 ? 2 : c >= 0xc2 && c < 0xe0;
        uint32_t code = c & (0x3fu >> more);
        for (int i = 0; i < more; i++) {
            uint32_t next = gi_window_at(window, *offset + i);
            if (next > 0xff || (next & 0xc0) != 0x80) more = 0;
            code = code << 6 | (next & 0x3f);
        }
        *offset += more;
        if (more == 0 || code < 0x80 || (code >= 0xd800 && code < 0xe000)) return '?';
        c = code;
    }
    return (c < 0x20 && c != '\t') || (c >= 0x7f && c < 0xa0) || c > 0x10ffff ? '?' : c;
}

static int encode(uint32_t c, char *out) {
    if (c < 0x80) {
        out[0] = (char)c;
        return 1;
    }
    static const unsigned lead[] = {0, 0xc0, 0xe0, 0xf0};
    int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    out[0] = (char)(lead[more] | c >> (6 * more));
    for (int i = 1; i <= more; i++) out[i] = (char)(0x80 | (c >> (6 * (more - i)) & 0x3f));
    return more + 1;
}

int gi_window_copy(const GiWindow *window, int64_t offset, int count, char *buffer, size_t size) {
    size_t length = 0;
    int copied = 0;
    while (copied < count && length + 5 <= size) {
        unsigned c = gi_window_at(window, offset);
        if (c == GI_WINDOW_END || c == '\n' || c == '\r') break;
        length += (size_t)encode(next_character(window, &offset), buffer + length);
        copied++;
    }
    buffer[length] = '\0';
    return copied;
}

void gi_window_excerpt(
    const GiWindow *window, int64_t offset, char buffer[GI_EXCERPT_SIZE], int *caret) {
    enum { BEFORE_LIMIT = 80, BEFORE_CUT = 60, TOTAL = 120 };
    int unit = gi_window_unit(window), before = 0;
    int64_t from = offset, cut = offset;
    while (before <= BEFORE_LIMIT) {
        unsigned c = gi_window_at(window, from - unit);
        if (c == GI_WINDOW_END || c == '\n' || c == '\r') break;
        /* Invalid UTF-8 must not lead further back than any message may look. */
        if (offset - from >= GI_WINDOW_CONTEXT) break;
        from -= unit;
        if (!begins_character(window, c)) continue;
        if (++before == BEFORE_CUT) cut = from;
    }
    size_t length = 0;
    if (before > BEFORE_LIMIT) {
        memcpy(buffer, "...", 3);
        length = 3;
        from = cut;
        before = BEFORE_CUT;
    }
    if (from == 0 && gi_window_at(window, 0) == 0xfeff) from += unit, before--;
    if (from == 0 && window->size >= 3 && window->base == 0 &&
        memcmp(window->data, "\xef\xbb\xbf", 3) == 0) {
        from += 3, before--;
    }
    *caret = (int)length + (before > 0 ? before : 0);
    int64_t p = from;
    for (int i = 0; i < TOTAL; i++) {
        unsigned c = gi_window_at(window, p);
        if (c == GI_WINDOW_END || c == '\n' || c == '\r') break;
        length += (size_t)encode(next_character(window, &p), buffer + length);
    }
    unsigned c = gi_window_at(window, p);
    if (c != GI_WINDOW_END && c != '\n' && c != '\r') {
        memcpy(buffer + length, "...", 3);
        length += 3;
    }
    buffer[length] = '\0';
}
