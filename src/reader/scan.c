/* SPDX-License-Identifier: MIT
 * Each scan_ function begins at a token and returns its end, or null and leaves `fault` at the byte
 * that it could not take. When that is the zero behind the last byte, the token is not whole. What
 * is taken is a subset of XML 1.0 that needs no table of its characters: names are of ASCII,
 * everything else also of the UTF-8 that needs no second look; no references, no CDATA, no
 * instructions, no document type. */
#include "reader/scan.h"

#include "math/bytes.h"
#include "reader/number.h"

#include <string.h>

enum {
    TOKEN_LIMIT = UINT16_MAX,
    NAME_LIMIT = 80,
    DECLARATION_LIMIT = 40,
    COMMENT_LIMIT = 1024 * 1024
};

/* The most entries of one step of the scanner: a tag, its attributes and its numbers; or what is in
 * the holes of a pattern. */
enum {
    TAG_ENTRIES = 2 + 2 * GI_TAPE_ATTRIBUTE_LIMIT + 1 + GI_TAPE_NUMBER_LIMIT,
    LIKE_ENTRIES = 1 + GI_HOLE_LIMIT * (1 + GI_TAPE_NUMBER_LIMIT),
    STEP_LIMIT = TAG_ENTRIES > LIKE_ENTRIES ? TAG_ENTRIES : LIKE_ENTRIES
};

enum { GUESS_COUNT = 64, PATIENCE = 64 };

enum {
    NAME_FIRST = 1,
    NAME = 2,
    BLANK = 4,
    TEXT = 8,   /* and in a comment, when it is no hyphen */
    VALUE = 16, /* of an attribute */
    NUMBER = 32 /* may be the first of one */
};

typedef struct Scan {
    GiScanner *scanner;
    const uint8_t *classes;
    const char *bytes, *end, *fault;
    const char *stop; /* no token begins there or behind it */
    GiTape *tape;
    GiTapeEntry *entry; /* the next of the tape; there is room for a step */
    GiTokenKind last;   /* the token before it */
    bool out_of_memory;
    size_t container;       /* entry of the last start tag whose content is not just numbers, */
    size_t container_depth; /* and how many elements are open with it; 0: it is closed */
    int hits, misses;       /* of patterns */
    uint8_t guesses[GUESS_COUNT]; /* by the hash of the start tag: number of the pattern + 1 */
} Scan;

void gi_scanner_init(GiScanner *scanner, GiMemory *memory) {
    memset(scanner, 0, sizeof *scanner);
    scanner->memory = memory;
    for (int c = 0; c < 128; c++) {
        bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':';
        bool digit = c >= '0' && c <= '9', blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        bool inner = letter || digit || c == '-' || c == '.';
        bool text = (c >= ' ' || blank) && c != '<' && c != '&' && c != ']';
        bool value = c >= ' ' && c != '<' && c != '&' && c != '"' && c != '\'';
        bool number = digit || c == '-' || c == '+' || c == '.';
        scanner->classes[c] = (uint8_t)(NAME_FIRST * letter | NAME * inner | BLANK * blank |
                                        TEXT * text | VALUE * value | NUMBER * number);
    }
}

void gi_scanner_reset(GiScanner *scanner) {
    gi_array_free(scanner->memory, &scanner->open);
    gi_array_free(scanner->memory, &scanner->starts);
    gi_array_free(scanner->memory, &scanner->closed);
}

void gi_scanner_begin_inside(GiScanner *scanner, int64_t offset) {
    scanner->next = offset;
    scanner->open.count = scanner->starts.count = scanner->closed.count = 0;
    scanner->begun = scanner->inside = true;
}

/* ---------------------------------------------------------------- characters */

static bool is(const Scan *scan, char c, int classes) {
    return (scan->classes[(unsigned char)c] & classes) != 0;
}

static const char *fail(Scan *scan, const char *at) {
    scan->fault = at;
    return NULL;
}

/* A character of two or three bytes; of those with three, none that could be a half of a pair or no
 * character at all. */
static const char *skip_wide(Scan *scan, const char *p) {
    unsigned char c = (unsigned char)*p;
    int more = c >= 0xc2 && c <= 0xdf ? 1 : c >= 0xe1 && c <= 0xec ? 2 : 0;
    if (more == 0) return fail(scan, p);
    for (int i = 1; i <= more; i++) {
        if (((unsigned char)p[i] & 0xc0) != 0x80) return fail(scan, p + i);
    }
    return p + more + 1;
}

/* The end of a run of characters of a class. */
static const char *skip(Scan *scan, const char *p, int classes) {
    for (;;) {
        while (is(scan, *p, classes)) p++;
        if ((unsigned char)*p < 0x80) return p;
        p = skip_wide(scan, p);
        if (p == NULL) return NULL;
    }
}

static const char *skip_blank(const Scan *scan, const char *p) {
    while (is(scan, *p, BLANK)) p++;
    return p;
}

/* ---------------------------------------------------------------- tape */

static GiToken *put(Scan *scan, GiTokenKind kind, const char *begin, const char *end) {
    GiToken *token = &scan->entry++->token;
    scan->last = kind;
    *token = (GiToken){(uint32_t)(begin - scan->bytes), (uint16_t)(end - begin), (uint8_t)kind, 0};
    return token;
}

/* ---------------------------------------------------------------- tags */

/* The value of an element, from behind its start tag; null when it is something else. */
static const char *scan_numbers(Scan *scan, const char *p) {
    const char *q = skip_blank(scan, p);
    if (!is(scan, *q, NUMBER)) return NULL;
    GiTapeEntry *first = scan->entry;
    GiToken *token = put(scan, GI_TOKEN_NUMBERS, p, p);
    while (*q != '<') {
        size_t used;
        if (token->count == GI_TAPE_NUMBER_LIMIT || !is(scan, *q, NUMBER) ||
            gi_number_read(q, (size_t)(scan->end - q), &scan->entry->number, &used) !=
                GI_NUMBER_OK ||
            (q[used] != '<' && !is(scan, q[used], BLANK))) {
            scan->entry = first;
            return NULL;
        }
        scan->entry++;
        token->count++;
        q = skip_blank(scan, q + used);
    }
    if (q[1] != '/' || q - p > TOKEN_LIMIT) {
        scan->entry = first;
        return NULL;
    }
    token->size = (uint16_t)(q - p);
    return q;
}

/* ` name="value"` */
static const char *scan_attribute(Scan *scan, const char *p) {
    const char *name = p;
    if (!is(scan, *p, NAME_FIRST)) return fail(scan, p);
    while (is(scan, *p, NAME)) p++;
    if (*p != '=') return fail(scan, p);
    const char *name_end = p++, quote = *p;
    if (quote != '"' && quote != '\'') return fail(scan, p);
    const char *value = p + 1;
    p = skip(scan, value, VALUE);
    if (p == NULL) return NULL;
    if (*p != quote) return fail(scan, p);
    put(scan, GI_TOKEN_SPAN, name, name_end);
    put(scan, GI_TOKEN_SPAN, value, p);
    return p + 1;
}

/* Whether the last of the attributes behind a token has a name that another has. */
static bool repeats_name(const Scan *scan, const GiTapeEntry *attributes, int count) {
    GiToken last = attributes[2 * count - 2].token;
    for (int i = 0; i + 1 < count; i++) {
        GiToken token = attributes[2 * i].token;
        if (token.size == last.size &&
            memcmp(scan->bytes + token.at, scan->bytes + last.at, last.size) == 0) {
            return true;
        }
    }
    return false;
}

static bool push_open(Scan *scan, const char *tag, size_t size) {
    GiScanner *scanner = scan->scanner;
    if (scanner->open.count > UINT32_MAX / 2 ||
        !gi_array_reserve(scanner->memory, &scanner->open, size + 1) ||
        !gi_array_push(scanner->memory, &scanner->starts, (uint32_t)scanner->open.count)) {
        scan->out_of_memory = true;
        return false;
    }
    gi_span_copy((GiSpan){tag, size}, scanner->open.data + scanner->open.count);
    scanner->open.data[scanner->open.count + size] = '>';
    scanner->open.count += size + 1;
    return true;
}

static const char *scan_start(Scan *scan, const char *tag) {
    const char *p = tag + 1;
    while (is(scan, *p, NAME)) p++;
    const char *name_end = p;
    if (p - tag > NAME_LIMIT) return fail(scan, p);
    const GiTapeEntry *first = scan->entry;
    GiToken *token = put(scan, GI_TOKEN_START, tag, name_end);
    while (*p != '>' && *p != '/') {
        const char *q = skip_blank(scan, p);
        if (q == p) return fail(scan, p);
        p = q;
        if (*p == '>' || *p == '/') break;
        if (token->count == GI_TAPE_ATTRIBUTE_LIMIT) return fail(scan, p);
        p = scan_attribute(scan, p);
        if (p == NULL) return NULL;
        if (repeats_name(scan, first + 1, ++token->count)) {
            return fail(scan, tag);
        }
    }
    if (*p == '/') {
        if (*++p != '>') return fail(scan, p);
        if (++p - tag > TOKEN_LIMIT) return fail(scan, tag);
        put(scan, GI_TOKEN_END, tag, p);
        return p;
    }
    if (++p - tag > TOKEN_LIMIT) return fail(scan, tag);
    if (!push_open(scan, tag, (size_t)(name_end - tag))) return NULL;
    const char *value_end = scan_numbers(scan, p);
    if (value_end != NULL) return value_end;
    scan->container = (size_t)(first - scan->tape->entries.data);
    scan->container_depth = scan->scanner->starts.count;
    return p;
}

/* ---------------------------------------------------------------- patterns */

/* Where the pattern of a start tag is noted, if there is one. It depends on the whole tag, or most
 * of it. Null when that is long, or the end is near. */
static uint8_t *find_guess(Scan *scan, const char *tag) {
    if (scan->end - tag < GI_BYTES) return NULL;
    uint64_t ends = gi_bytes_equal(gi_bytes_load(tag), '>');
    if (ends == 0) return NULL;
    int size = __builtin_ctzll(ends);
    uint64_t first = gi_eight_load(tag), last = first << (size < 8 ? 8 * (8 - size) : 0);
    if (size > 8) last = gi_eight_load(tag + size - 8) + first * 31;
    return &scan->guesses[last * UINT64_C(0x9e3779b97f4a7c15) >> 58];
}

/* The element that is closed now may be the first of many. */
static void learn_pattern(Scan *scan) {
    GiTape *tape = scan->tape;
    size_t first = scan->container, end = (size_t)(scan->entry - tape->entries.data);
    scan->container_depth = 0;
    if (tape->pattern_count == GI_PATTERN_LIMIT) return;
    GiPattern *pattern = &tape->patterns[tape->pattern_count];
    if (!gi_pattern_learn(pattern, tape->entries.data, first, end)) return;
    uint8_t *guess = find_guess(scan, scan->bytes + tape->entries.data[first].token.at);
    if (guess != NULL) *guess = (uint8_t)++tape->pattern_count;
}

static bool same_bytes(const char *a, const char *b, size_t size) {
    return gi_span_equals((GiSpan){a, size}, b);
}

/* What is in the holes of an element like the pattern; null, and the tape is as it was, when it is
 * not like that. */
static const char *scan_holes(Scan *scan, const GiPattern *pattern, const char *p) {
    const char *model = scan->bytes + scan->tape->entries.data[pattern->first].token.at;
    const GiHole *hole = pattern->holes, *holes_end = hole + pattern->hole_count;
    size_t from = 0;
    for (; hole < holes_end; from = (hole++)->end) {
        size_t size = hole->begin - from;
        if ((size_t)(scan->end - p) < size || !same_bytes(p, model + from, size)) return NULL;
        p += size;
        if (hole->count > 0) {
            const GiTapeEntry *numbers = scan->entry;
            p = scan_numbers(scan, p);
            if (p == NULL || numbers->token.count != hole->count) return NULL;
        } else {
            const char *value = p;
            while (is(scan, *p, VALUE)) p++;
            put(scan, GI_TOKEN_SPAN, value, p);
        }
    }
    size_t size = pattern->size - from;
    if ((size_t)(scan->end - p) < size || !same_bytes(p, model + from, size)) return NULL;
    return p + size;
}

/* An element like one before; null, and nothing has happened, when it is not. Where few are, it is
 * not tried for ever. */
static const char *scan_like(Scan *scan, const char *tag) {
    if (scan->tape->pattern_count == 0 || scan->misses > scan->hits + PATIENCE) return NULL;
    const uint8_t *guess = find_guess(scan, tag);
    if (guess == NULL || *guess == 0) return NULL;
    const GiPattern *pattern = &scan->tape->patterns[*guess - 1];
    GiTapeEntry *like = scan->entry++;
    const char *end = scan_holes(scan, pattern, tag);
    if (end == NULL || end > scan->stop || end - tag > TOKEN_LIMIT) {
        scan->entry = like;
        scan->misses++;
        return NULL;
    }
    like->token = (GiToken){
        (uint32_t)(tag - scan->bytes), (uint16_t)(*guess - 1), GI_TOKEN_LIKE, pattern->hole_count};
    scan->last = GI_TOKEN_END;
    scan->hits++;
    return end;
}

/* ---------------------------------------------------------------- ends, comments */

/* The end of an element that was open where the scanner began; which, is told later. */
static const char *scan_foreign_end(Scan *scan, const char *tag) {
    GiScanner *scanner = scan->scanner;
    const char *p = tag + 2;
    while (is(scan, *p, NAME)) p++;
    if (*p != '>' || p - tag > NAME_LIMIT) return fail(scan, p);
    GiSpan name = {tag + 2, (size_t)(p - tag) - 2};
    if (!gi_array_push(scanner->memory, &scanner->closed, name)) {
        scan->out_of_memory = true;
        return NULL;
    }
    put(scan, GI_TOKEN_END, tag, p + 1);
    return p + 1;
}

static const char *scan_end(Scan *scan, const char *tag) {
    GiScanner *scanner = scan->scanner;
    if (scanner->starts.count == 0) return scan_foreign_end(scan, tag);
    size_t start = scanner->starts.data[scanner->starts.count - 1];
    size_t size = scanner->open.count - start - 1; /* of the name and > */
    if ((size_t)(scan->end - tag) < size + 2) return fail(scan, scan->end);
    if (!gi_span_equals((GiSpan){tag + 2, size}, scanner->open.data + start + 1)) {
        return fail(scan, tag);
    }
    put(scan, GI_TOKEN_END, tag, tag + 2 + size);
    if (scanner->starts.count == scan->container_depth) learn_pattern(scan);
    scanner->open.count = start;
    scanner->starts.count--;
    return tag + 2 + size;
}

/* Long ones are left to expat, in mapped files as in others: the reader bounds what may wait for
 * its end. */
static const char *scan_comment(Scan *scan, const char *p) {
    const char *begin = p;
    for (int i = 2; i < 4; i++) {
        if (p[i] != '-') return fail(scan, p + i);
    }
    for (p += 4;; p++) {
        while (*p != '-' && is(scan, *p, TEXT)) p++;
        if (*p == '-') {
            if (p[1] != '-') continue;
            if (p[2] != '>') return fail(scan, p + 2);
            return p - begin > COMMENT_LIMIT ? fail(scan, begin) : p + 3;
        }
        if (*p == '<' || *p == '&' || *p == ']') continue;
        p = (unsigned char)*p < 0x80 ? fail(scan, p) : skip_wide(scan, p);
        if (p == NULL) return NULL;
        p--;
    }
}

/* ---------------------------------------------------------------- the whole */

/* From the beginning of the file to its root element: an XML declaration in one of its usual forms,
 * comments and white space. */
static const char *scan_prologue(Scan *scan, const char *p) {
    static const char *const declarations[] = {"<?xml version=\"1.0\"?>",
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>", "<?xml version=\"1.0\" encoding=\"utf-8\"?>"};
    if (strncmp(p, "\xef\xbb\xbf", 3) == 0) p += 3; /* a byte order mark */
    for (int i = 0; i < 3; i++) {
        size_t size = strlen(declarations[i]);
        if (strncmp(p, declarations[i], size) != 0) continue;
        p += size;
        break;
    }
    for (;;) {
        p = skip_blank(scan, p);
        if (*p != '<') return fail(scan, p);
        if (is(scan, p[1], NAME_FIRST)) return scan_start(scan, p);
        if (p[1] != '!') {
            bool cut = p[1] == '?' && scan->end - p < DECLARATION_LIMIT;
            return fail(scan, cut ? scan->end : p + 1);
        }
        p = scan_comment(scan, p);
        if (p == NULL) return NULL;
    }
}

/* White space before a child or behind one stands where text means nothing, and is left out: most
 * text is of that kind. */
static const char *scan_text(Scan *scan, const char *text) {
    const char *first = skip_blank(scan, text), *p = skip(scan, first, TEXT);
    if (p == NULL) return NULL;
    if (*p != '<' || p - text > TOKEN_LIMIT) return fail(scan, p);
    bool beside_child = scan->last == GI_TOKEN_END || is(scan, p[1], NAME_FIRST);
    if (p > first || !beside_child) put(scan, GI_TOKEN_TEXT, text, p);
    return p;
}

static const char *scan_one(Scan *scan, const char *p) {
    if (*p == '<' && p[1] == '!') return scan_comment(scan, p);
    if (scan->scanner->starts.count == 0 && !scan->scanner->inside) { /* behind the root element */
        const char *q = skip_blank(scan, p);
        return q > p ? q : fail(scan, q);
    }
    if (*p != '<') return scan_text(scan, p);
    if (is(scan, p[1], NAME_FIRST)) {
        const char *end = scan_like(scan, p);
        return end != NULL ? end : scan_start(scan, p);
    }
    return p[1] == '/' ? scan_end(scan, p) : fail(scan, p + 1);
}

GiScanStatus gi_scan(
    GiScanner *scanner, const char *bytes, size_t size, size_t part, GiTape *tape) {
    Scan scan = {.scanner = scanner,
        .classes = scanner->classes,
        .bytes = bytes,
        .end = bytes + size,
        .stop = bytes + part,
        .tape = tape};
    const char *p = bytes;
    tape->begin = scanner->next;
    tape->entries.count = 0;
    tape->pattern_count = 0;
    scan.fault = scan.end;
    while (p < scan.stop) {
        if (!gi_array_reserve(scanner->memory, &tape->entries, STEP_LIMIT)) return GI_SCAN_MEMORY;
        scan.entry = tape->entries.data + tape->entries.count;
        const char *next = scanner->begun ? scan_one(&scan, p) : scan_prologue(&scan, p);
        if (next == NULL) break;
        tape->entries.count = (size_t)(scan.entry - tape->entries.data);
        scanner->begun = true;
        p = next;
    }
    scanner->next += p - bytes;
    if (scan.out_of_memory) return GI_SCAN_MEMORY;
    bool whole = scan.fault < scan.end || scan.end - p > TOKEN_LIMIT;
    return p < scan.stop && whole ? GI_SCAN_STRANGE : GI_SCAN_MORE;
}

/* Closes the elements that the other has closed, but never the root. False when it has others. */
static bool close_elements(GiScanner *scanner, const GiScanner *next) {
    for (size_t i = 0; i < next->closed.count; i++) {
        if (scanner->starts.count < 2) return false;
        size_t start = scanner->starts.data[scanner->starts.count - 1];
        size_t size = scanner->open.count - start - 2; /* of the name */
        GiSpan name = next->closed.data[i];
        if (name.size != size || !gi_span_equals(name, scanner->open.data + start + 1)) {
            return false;
        }
        scanner->open.count = start;
        scanner->starts.count--;
    }
    return true;
}

bool gi_scanner_join(GiScanner *scanner, const GiScanner *next) {
    size_t open_count = scanner->open.count, start_count = scanner->starts.count;
    bool fits = start_count > 0 && close_elements(scanner, next) &&
                scanner->open.count < UINT32_MAX / 2 &&
                gi_array_reserve(scanner->memory, &scanner->open, next->open.count) &&
                gi_array_reserve(scanner->memory, &scanner->starts, next->starts.count);
    if (!fits) {
        scanner->open.count = open_count;
        scanner->starts.count = start_count;
        return false;
    }
    for (size_t i = 0; i < next->starts.count; i++) {
        uint32_t start = (uint32_t)scanner->open.count + next->starts.data[i];
        scanner->starts.data[scanner->starts.count + i] = start;
    }
    if (next->open.count > 0) {
        memcpy(scanner->open.data + scanner->open.count, next->open.data, next->open.count);
    }
    scanner->open.count += next->open.count;
    scanner->starts.count += next->starts.count;
    scanner->next = next->next;
    return true;
}
