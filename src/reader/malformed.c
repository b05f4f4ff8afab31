/* SPDX-License-Identifier: MIT
 * What expat stopped at, in words that say what to do. The parser knows the kind of error and the
 * byte; the bytes round it tell the rest. */
#include "reader/state.h"

#include "reader/suggest.h"

#include <stdio.h>
#include <string.h>

static bool is_blank(unsigned unit) {
    return unit == ' ' || unit == '\t' || unit == '\n' || unit == '\r';
}

static bool is_name(unsigned unit) {
    return unit != GI_WINDOW_END &&
           (unit >= 0x80 || (unit >= 'a' && unit <= 'z') || (unit >= 'A' && unit <= 'Z') ||
               (unit >= '0' && unit <= '9') || unit == '_' || unit == '-' || unit == '.' ||
               unit == ':');
}

/* Characters of the word at an offset, as far as they are those of an XML name; at most 40. */
static int name_length(const GiWindow *window, int64_t offset) {
    int length = 0, unit = gi_window_unit(window);
    while (length < 40 && is_name(gi_window_at(window, offset + length * unit))) length++;
    return length;
}

/* `type=Sphere`: the place is just behind an equals sign. */
static bool report_unquoted(GiReader *reader, GiPlace place) {
    const GiWindow *window = &reader->window;
    int unit = gi_window_unit(window);
    int64_t p = place.offset - unit;
    while (is_blank(gi_window_at(window, p))) p -= unit;
    if (gi_window_at(window, p) != '=') return false;
    for (p -= unit; is_blank(gi_window_at(window, p));) p -= unit;
    int64_t end = p + unit;
    while (is_name(gi_window_at(window, p))) p -= unit;
    int64_t begin = p + unit;
    int name_size = (int)((end - begin) / unit), value_size = 0;
    if (name_size == 0 || name_size > 40) return false;
    for (;; value_size++) {
        unsigned c = gi_window_at(window, place.offset + value_size * unit);
        if (value_size >= 40 || c == GI_WINDOW_END || is_blank(c) || c == '>' || c == '<' ||
            c == '"' || c == '\'' ||
            (c == '/' && gi_window_at(window, place.offset + (value_size + 1) * unit) == '>')) {
            break;
        }
    }
    char name[GI_QUOTE_SIZE], value[GI_QUOTE_SIZE];
    gi_window_copy(window, begin, name_size, name, sizeof name);
    gi_window_copy(window, place.offset, value_size, value, sizeof value);
    if (value_size == 0) {
        gi_report_add(&reader->report, place, 1, "the attribute %s has no value", name);
    } else {
        gi_report_add(
            &reader->report, place, value_size, "quote the value: %s=\"%s\"", name, value);
    }
    return true;
}

/* Whether the bytes at the place are a character of UTF-8. */
static bool is_utf8(const GiWindow *window, int64_t offset) {
    char text[16];
    gi_window_copy(window, offset, 1, text, sizeof text);
    return text[0] != '?';
}

/* `name="a&b"`: the parser stops where the `;` of a reference should be. */
static bool report_ampersand(GiReader *reader, GiPlace place) {
    static const char *const known[] = {"lt", "gt", "amp", "quot", "apos"};
    const GiWindow *window = &reader->window;
    int unit = gi_window_unit(window);
    int64_t name = place.offset;
    while (is_name(gi_window_at(window, name - unit))) name -= unit;
    int64_t sign = name - unit;
    if (gi_window_at(window, sign) == '#') sign -= unit;
    if (gi_window_at(window, sign) != '&') return false;
    char text[GI_QUOTE_SIZE];
    int length = name_length(window, name);
    gi_window_copy(window, name, length, text, sizeof text);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (sign + unit != name || strcmp(text, known[i]) != 0) continue;
        gi_report_add(&reader->report, (GiPlace){.offset = sign}, length + 1,
            "a `;` is missing: write `&%s;`", text);
        return true;
    }
    gi_report_add(
        &reader->report, (GiPlace){.offset = sign}, 1, "write `&amp;` for the character `&`");
    return true;
}

static void report_token(GiReader *reader, GiPlace place) {
    const GiWindow *window = &reader->window;
    GiReport *report = &reader->report;
    int unit = gi_window_unit(window);
    unsigned c = gi_window_at(window, place.offset);
    unsigned before = gi_window_at(window, place.offset - unit);
    unsigned before2 = gi_window_at(window, place.offset - 2 * unit);
    if (c == 0) {
        gi_report_add(report, place, 1, "a zero byte: the file is damaged or is not text");
        return;
    }
    if (c != GI_WINDOW_END && c < 0x20 && !is_blank(c)) {
        gi_report_add(report, place, 1, "the control character 0x%02X is not allowed", c);
        return;
    }
    if (c >= 0x80 && window->encoding == GI_ENCODING_UTF8 && !is_utf8(window, place.offset)) {
        gi_report_add(report, place, 1,
            "the byte 0x%02X is not UTF-8: save the file as UTF-8, or name its encoding in the "
            "first line",
            c);
        return;
    }
    if (report_unquoted(reader, place)) return;
    if (before == '-' && before2 == '-') {
        gi_report_add(report, place, 1, "`--` is not allowed inside a comment");
        return;
    }
    if (report_ampersand(reader, place)) return;
    if (c == '&') {
        gi_report_add(report, place, 1, "write `&amp;` for the character `&`");
        return;
    }
    if (c == '<') {
        gi_report_add(report, place, 1,
            "`<` cannot stand here: a `>` or a closing quote is missing before it");
        return;
    }
    if (before == '<' && (is_blank(c) || (c >= '0' && c <= '9') || c == '=')) {
        gi_report_add(report, place, 1, "write `&lt;` for the character `<`");
        return;
    }
    if (before == '"' || before == '\'') {
        gi_report_add(report, place, 1, "white space is missing between two attributes");
        return;
    }
    char text[16];
    gi_window_copy(window, place.offset, 1, text, sizeof text);
    gi_report_add(report, place, 1, "not XML: the character `%s` cannot stand here", text);
}

/* "`camera`, which is opened at line 2", for the innermost open element. */
static void describe_open(GiReader *reader, char *buffer, size_t size) {
    GiFrame *frame = gi_reader_top(reader);
    char quote[GI_QUOTE_SIZE];
    const char *tag = reader->tags.data + frame->tag;
    gi_window_locate(&reader->window, &frame->place);
    snprintf(buffer, size, "`%s`, opened at line %lld", gi_quote(quote, tag, strlen(tag)),
        (long long)frame->place.line);
}

/* Whether an element that is still open has the tag. */
static bool is_open(const GiReader *reader, const char *tag) {
    for (size_t i = 0; i < reader->frames.count; i++) {
        if (strcmp(reader->tags.data + reader->frames.data[i].tag, tag) == 0) return true;
    }
    return false;
}

static void report_mismatch(GiReader *reader, GiPlace place) {
    char closed[GI_QUOTE_SIZE], open[GI_QUOTE_SIZE + 64], tag[GI_QUOTE_SIZE];
    int length = name_length(&reader->window, place.offset);
    gi_window_copy(&reader->window, place.offset, length, closed, sizeof closed);
    describe_open(reader, open, sizeof open);
    const char *top = reader->tags.data + gi_reader_top(reader)->tag;
    gi_quote(tag, top, strlen(top));
    GiSuggestion suggestion = gi_suggestion_begin(closed, strlen(closed));
    gi_suggestion_offer(&suggestion, top);
    if (suggestion.best != NULL && !is_open(reader, closed)) {
        gi_report_add(&reader->report, place, length,
            "`</%s>` does not close %s: did you mean `</%s>`?", closed, open, tag);
        return;
    }
    gi_report_add(&reader->report, place, length,
        "`</%s>` does not close %s: `</%s>` is missing before it", closed, open, tag);
}

static void report_end(GiReader *reader, GiPlace place, const char *inside) {
    if (reader->frames.count == 0) {
        gi_report_add(&reader->report, place, 1, "%s",
            inside != NULL ? inside : "the file has no element; a scene begins with <scene>");
        return;
    }
    char open[GI_QUOTE_SIZE + 64], tag[GI_QUOTE_SIZE];
    const char *top = reader->tags.data + gi_reader_top(reader)->tag;
    describe_open(reader, open, sizeof open);
    gi_report_add(&reader->report, place, 1, "%s inside %s: `</%s>` is missing",
        inside != NULL ? inside : "the file ends", open, gi_quote(tag, top, strlen(top)));
}

static bool begins_with(const GiWindow *window, int64_t offset, const char *text) {
    int unit = gi_window_unit(window);
    for (; *text != '\0'; text++, offset += unit) {
        if (gi_window_at(window, offset) != (unsigned char)*text) return false;
    }
    return true;
}

/* The first thing after the scene that is neither blank, comment nor instruction. The parser would
 * name one place or another, depending on how the file was cut into chunks. */
static int64_t find_junk(const GiReader *reader, int64_t fallback) {
    const GiWindow *window = &reader->window;
    int unit = gi_window_unit(window);
    int64_t p = reader->scene_end;
    if (!gi_window_holds(window, p)) return fallback;
    for (;;) {
        while (is_blank(gi_window_at(window, p))) p += unit;
        const char *end = begins_with(window, p, "<!--") ? "-->"
                          : begins_with(window, p, "<?") ? "?>"
                                                         : NULL;
        if (end == NULL) return p;
        int64_t begin = p;
        while (!begins_with(window, p, end)) {
            if (gi_window_at(window, p) == GI_WINDOW_END) return begin;
            p += unit;
        }
        p += (int64_t)strlen(end) * unit;
    }
}

void gi_malformed_report(GiReader *reader) {
    GiReport *report = &reader->report;
    report->rule = GI_RULE_SYNTAX;
    enum XML_Error code = XML_GetErrorCode(reader->parser);
    int64_t offset = gi_parser_offset(reader);
    int64_t end = reader->window.base + (int64_t)reader->window.size;
    if (offset < reader->window.base) offset = reader->window.base;
    if (offset > end) offset = end;
    GiPlace place = {.offset = offset};
    char quote[GI_QUOTE_SIZE];
    if (reader->frames.count == 0 && reader->report.root.line != 0 && code != XML_ERROR_NO_MEMORY) {
        place.offset = find_junk(reader, offset);
        gi_report_add(report, place, 1, "nothing may follow the end of the scene");
        return;
    }
    switch (code) {
    case XML_ERROR_NO_MEMORY: gi_reader_out_of_memory(reader); break;
    case XML_ERROR_NO_ELEMENTS: report_end(reader, (GiPlace){.offset = end}, NULL); break;
    case XML_ERROR_UNCLOSED_TOKEN: {
        bool comment = begins_with(&reader->window, offset, "<!--");
        gi_report_add(report, place, 1, "this %s is not closed by `%s` before the end of the file",
            comment ? "comment" : "tag", comment ? "-->" : ">");
        break;
    }
    case XML_ERROR_PARTIAL_CHAR:
        report_end(reader, place, "the file ends in the middle of a character");
        break;
    case XML_ERROR_UNCLOSED_CDATA_SECTION:
        gi_report_add(report, place, 1, "this CDATA section is not closed by ]]>");
        break;
    case XML_ERROR_INVALID_TOKEN:
    case XML_ERROR_SYNTAX:
        if (reader->frames.count == 0 && gi_window_at(&reader->window, offset) != '<' &&
            gi_window_at(&reader->window, offset) >= 0x20 &&
            gi_window_at(&reader->window, offset - gi_window_unit(&reader->window)) != '<' &&
            code == XML_ERROR_SYNTAX) {
            gi_report_add(report, place, 1, "not XML: a scene begins with <scene>");
        } else {
            report_token(reader, place);
        }
        break;
    case XML_ERROR_TAG_MISMATCH: report_mismatch(reader, place); break;
    case XML_ERROR_DUPLICATE_ATTRIBUTE: {
        int length = name_length(&reader->window, offset);
        gi_window_copy(&reader->window, offset, length, quote, sizeof quote);
        gi_report_add(report, place, length, "the attribute `%s` is given twice", quote);
        break;
    }
    case XML_ERROR_UNDEFINED_ENTITY: {
        int64_t name = offset + gi_window_unit(&reader->window);
        int length = name_length(&reader->window, name);
        gi_window_copy(&reader->window, name, length, quote, sizeof quote);
        gi_report_add(report, place, length + 2,
            "unknown entity `&%s;`: only &lt; &gt; &amp; &quot; and &apos; are known", quote);
        break;
    }
    case XML_ERROR_BAD_CHAR_REF:
        gi_report_add(report, place, 1, "this number is not that of a character of XML");
        break;
    case XML_ERROR_MISPLACED_XML_PI:
        gi_report_add(report, place, 1,
            "<?xml ...?> must be at the very beginning of the file, with nothing before it");
        break;
    case XML_ERROR_XML_DECL:
        gi_report_add(report, place, 1,
            "the first line should read <?xml version=\"1.0\" encoding=\"UTF-8\"?>");
        break;
    case XML_ERROR_UNKNOWN_ENCODING:
        gi_report_add(report, place, 1, "the encoding \"%s\" is not known: save the file as UTF-8",
            gi_quote(quote, reader->encoding, strlen(reader->encoding)));
        break;
    case XML_ERROR_INCORRECT_ENCODING:
        gi_report_add(report, place, 1,
            "the encoding \"%s\" is declared, but the file is in another: save it as UTF-8",
            gi_quote(quote, reader->encoding, strlen(reader->encoding)));
        break;
    default: gi_report_add(report, place, 1, "malformed XML: %s", XML_ErrorString(code)); break;
    }
}
