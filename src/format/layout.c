/* SPDX-License-Identifier: MIT
 * One pass over the tokens. Each opens a line of its own or continues the one before; an element
 * that its author wrote on one line stays on one line where that fits. */
#include "format/layout.h"

#include <string.h>

/* Deeper elements are not indented further, and comments beyond COLUMN_LIMIT not moved: what is
 * written stays in proportion to what was read. */
enum { INDENT = 2, WIDTH = 160, TAB = 4, DEPTH_LIMIT = 50, COLUMN_LIMIT = 200 };

typedef struct Layout {
    const GiDocument *document;
    GiMemory *memory;
    GiText *text;
    size_t depth; /* elements that are open */
    bool inside;  /* of an element that stays on one line: no new lines */
    bool failed;  /* memory is short */
} Layout;

/* ---------------------------------------------------------------- writing */

static void put(Layout *layout, const char *text, size_t size) {
    if (layout->failed || !gi_array_reserve(layout->memory, layout->text, size)) {
        layout->failed = true;
        return;
    }
    memcpy(layout->text->data + layout->text->count, text, size);
    layout->text->count += size;
}

static void put_span(Layout *layout, GiSpan span) { put(layout, span.data, span.size); }
static void put_text(Layout *layout, const char *text) { put(layout, text, strlen(text)); }

static void put_blanks(Layout *layout, size_t count) {
    for (size_t i = 0; i < count && !layout->failed; i++) put(layout, " ", 1);
}

static void drop_blanks(Layout *layout) {
    GiText *text = layout->text;
    while (text->count > 0 &&
           (text->data[text->count - 1] == ' ' || text->data[text->count - 1] == '\t')) {
        text->count--;
    }
}

/* ---------------------------------------------------------------- lines of the source */

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n'; }

static size_t count_lines(GiSpan span) {
    size_t count = 0;
    for (size_t i = 0; i < span.size; i++) count += span.data[i] == '\n';
    return count;
}

/* Line feeds between a token and what stands before it. */
static size_t lines_before(const Layout *layout, size_t token) {
    const GiToken *tokens = layout->document->tokens.data;
    if (token == 0 || tokens[token - 1].kind != GI_TOKEN_TEXT || !tokens[token - 1].blank) return 0;
    return count_lines(gi_document_span(layout->document, token - 1));
}

/* Columns of white space, with tabs filled up. */
static size_t column_of(const char *text, size_t size) {
    size_t column = 0;
    for (size_t i = 0; i < size; i++)
        column = text[i] == '\t' ? column / TAB * TAB + TAB : column + 1;
    return column;
}

/* The column at which a text of one or more lines ends; of a very long line, a large one. */
static size_t end_column(const char *text, size_t size) {
    if (size == 0) return 0; /* an empty text may be a null pointer */
    size_t begin = size;
    while (begin > 0 && text[begin - 1] != '\n' && size - begin <= COLUMN_LIMIT) begin--;
    return column_of(text + begin, size - begin);
}

/* A comment's further lines keep their place relative to its beginning. */
static void put_comment(Layout *layout, size_t token) {
    GiSpan span = gi_document_span(layout->document, token);
    size_t from =
        end_column(layout->document->text.data, layout->document->tokens.data[token].begin);
    size_t to = end_column(layout->text->data, layout->text->count);
    if (to > COLUMN_LIMIT) from = to;
    for (size_t i = 0; i < span.size;) {
        const char *line = span.data + i;
        const char *end = memchr(line, '\n', span.size - i);
        size_t size = end != NULL ? (size_t)(end - line) : span.size - i;
        i += size + (end != NULL);
        if (line != span.data) {
            size_t blanks = 0;
            while (blanks < size && is_blank(line[blanks])) blanks++;
            size_t column = column_of(line, blanks) + to;
            if (blanks < size) put_blanks(layout, column > from ? column - from : 0);
            line += blanks;
            size -= blanks;
        }
        put(layout, line, size);
        if (end == NULL) break;
        drop_blanks(layout);
        put_text(layout, "\n");
    }
}

/* ---------------------------------------------------------------- tags */

static void put_name(Layout *layout, size_t start) {
    const GiToken *token = &layout->document->tokens.data[start];
    if (token->element != NULL) {
        put_text(layout, token->element->name);
    } else {
        put_span(layout, gi_document_name(layout->document, start));
    }
}

static void put_start(Layout *layout, size_t start, bool empty) {
    put_text(layout, "<");
    put_name(layout, start);
    GiAttribute attribute;
    for (size_t at = 0; gi_document_attribute(layout->document, start, &at, &attribute);) {
        bool single = memchr(attribute.value.data, '"', attribute.value.size) != NULL;
        put_text(layout, " ");
        put_span(layout, attribute.name);
        put_text(layout, single ? "='" : "=\"");
        put_span(layout, attribute.value);
        put_text(layout, single ? "'" : "\"");
    }
    put_text(layout, empty ? "/>" : ">");
}

static void put_end(Layout *layout, size_t start) {
    put_text(layout, "</");
    put_name(layout, start);
    put_text(layout, ">");
}

/* ---------------------------------------------------------------- values */

/* White space of a value means nothing at its ends, and no more than one blank between numbers; in
 * a text, such as the name of a file, it may mean something. */
static void put_value_text(Layout *layout, size_t token, bool first, bool last, bool shrink) {
    GiSpan span = gi_document_span(layout->document, token);
    size_t begin = 0, end = span.size;
    while (first && begin < end && is_blank(span.data[begin])) begin++;
    while (last && end > begin && is_blank(span.data[end - 1])) end--;
    for (size_t i = begin; i < end;) {
        size_t run = i;
        while (run < end && is_blank(span.data[run])) run++;
        if (run > i && shrink) {
            put_text(layout, " ");
            i = run;
            continue;
        }
        put(layout, span.data + i, 1);
        i++;
    }
}

static void put_value(Layout *layout, size_t start) {
    const GiToken *token = &layout->document->tokens.data[start];
    bool shrink = token->element->kind != GI_KIND_STRING;
    put_start(layout, start, false);
    for (size_t i = start + 1; i < token->match; i++) {
        if (layout->document->tokens.data[i].kind == GI_TOKEN_TEXT) {
            put_value_text(layout, i, i == start + 1, i + 1 == token->match, shrink);
        } else {
            put_span(layout, gi_document_span(layout->document, i));
        }
    }
    put_end(layout, start);
}

/* Whether there are at most blanks between an element's tags. */
static bool holds_nothing(const GiDocument *document, size_t start) {
    size_t end = document->tokens.data[start].match;
    return end <= start + 1 || (end == start + 2 && document->tokens.data[start + 1].blank);
}

/* What nobody reads stays as it is. */
static void put_ignored(Layout *layout, size_t start) {
    const GiDocument *document = layout->document;
    const GiToken *token = &document->tokens.data[start];
    size_t begin = token->end, end = document->tokens.data[token->match].begin;
    put_start(layout, start, false);
    put(layout, document->text.data + begin, end - begin);
    put_end(layout, start);
}

/* ---------------------------------------------------------------- lines */

/* Whether its author wrote an element on one line, with nothing in it but elements and values. */
static bool stands_on_one_line(const Layout *layout, size_t start) {
    const GiDocument *document = layout->document;
    const GiToken *token = &document->tokens.data[start];
    size_t begin = token->begin, end = document->tokens.data[token->match].end;
    if (end - begin > 8 * WIDTH) return false;
    if (memchr(document->text.data + begin, '\n', end - begin) != NULL) return false;
    for (size_t i = start + 1; i < token->match; i++) {
        const GiToken *inner = &document->tokens.data[i];
        if (gi_token_opens(inner) || inner->kind == GI_TOKEN_END || inner->blank) continue;
        const GiToken *parent = &document->tokens.data[inner->parent];
        bool of_object = !inner->ignored && gi_kind_is_object(parent->element->kind);
        if (of_object) return false;
    }
    return true;
}

static void begin_line(Layout *layout, size_t token) {
    if (layout->inside) return;
    const GiToken *tokens = layout->document->tokens.data;
    bool first = layout->text->count == 0;
    bool end = tokens[token].kind == GI_TOKEN_END;
    size_t before = token > 0 && tokens[token - 1].blank ? token - 1 : token;
    bool after_start = before > 0 && tokens[before - 1].kind == GI_TOKEN_START;
    if (!first) put_text(layout, "\n");
    if (!first && !end && !after_start && lines_before(layout, token) > 1) put_text(layout, "\n");
    put_blanks(layout, INDENT * (layout->depth < DEPTH_LIMIT ? layout->depth : DEPTH_LIMIT));
}

static void put_element(Layout *layout, size_t *token);

/* Tries an element on one line; takes it back when it is too long. */
static bool put_on_one_line(Layout *layout, size_t *token) {
    if (!stands_on_one_line(layout, *token)) return false;
    const GiToken *tokens = layout->document->tokens.data;
    size_t count = layout->text->count, depth = layout->depth, next = *token;
    size_t begin = count - end_column(layout->text->data, count); /* of the line */
    layout->inside = true;
    for (size_t last = tokens[*token].match; next <= last;) {
        if (gi_token_opens(&tokens[next])) {
            put_element(layout, &next);
        } else {
            if (tokens[next].kind == GI_TOKEN_END) {
                layout->depth--;
                put_end(layout, tokens[next].match);
            }
            next++;
        }
    }
    layout->inside = false;
    size_t characters = 0;
    for (size_t i = begin; i < layout->text->count; i++) {
        characters += ((unsigned char)layout->text->data[i] & 0xc0) != 0x80;
    }
    if (characters <= WIDTH) {
        *token = next;
        return true;
    }
    layout->text->count = count;
    layout->depth = depth;
    return false;
}

/* From a start tag on: a value or what is ignored as a whole, of an object its start tag. *token
 * becomes what is to be written next. */
static void put_element(Layout *layout, size_t *token) {
    const GiToken *start = &layout->document->tokens.data[*token];
    bool ignored = start->refers || start->element == NULL;
    bool object = !ignored && gi_kind_is_object(start->element->kind);
    if (holds_nothing(layout->document, *token) && (object || ignored)) {
        put_start(layout, *token, true);
        *token = start->match + 1;
    } else if (ignored) {
        put_ignored(layout, *token);
        *token = start->match + 1;
    } else if (!object) {
        put_value(layout, *token);
        *token = start->match + 1;
    } else if (layout->inside || !put_on_one_line(layout, token)) {
        put_start(layout, *token, false);
        layout->depth++;
        *token += 1;
    }
}

/* A comment behind something on the same line stays there. */
static void put_aside(Layout *layout, size_t token) {
    const GiToken *this = &layout->document->tokens.data[token];
    if (this->parent != GI_NO_TOKEN && lines_before(layout, token) == 0) {
        put_text(layout, " ");
    } else {
        begin_line(layout, token);
    }
    if (this->kind == GI_TOKEN_TEXT) {
        /* White space by character references, where any other text is an error. */
        put_value_text(layout, token, true, true, true);
    } else if (this->kind == GI_TOKEN_COMMENT) {
        put_comment(layout, token);
    } else {
        put_span(layout, gi_document_span(layout->document, token));
    }
}

bool gi_layout_write(const GiDocument *document, GiText *text) {
    Layout layout = {.document = document, .memory = document->memory, .text = text};
    for (size_t i = 0; i < document->tokens.count && !layout.failed;) {
        const GiToken *token = &document->tokens.data[i];
        if (gi_token_opens(token)) {
            begin_line(&layout, i);
            put_element(&layout, &i);
        } else if (token->kind == GI_TOKEN_END) {
            layout.depth--;
            begin_line(&layout, i);
            put_end(&layout, token->match);
            i++;
        } else {
            if (!token->blank) put_aside(&layout, i);
            i++;
        }
    }
    put_text(&layout, "\n");
    return !layout.failed;
}
