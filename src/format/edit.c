/* SPDX-License-Identifier: MIT */
#include "format/edit.h"

#include <stdlib.h>
#include <string.h>

void gi_edits_reset(GiEdits *edits) {
    gi_array_free(edits->document->memory, &edits->list);
    gi_array_free(edits->document->memory, &edits->text);
}

static bool append(GiMemory *memory, GiText *text, const char *bytes, size_t size) {
    if (!gi_array_reserve(memory, text, size)) return false;
    if (size > 0) memcpy(text->data + text->count, bytes, size);
    text->count += size;
    return true;
}

/* ---------------------------------------------------------------- collecting */

/* An edit's text is put together piece by piece. */
static void begin_edit(GiEdits *edits, size_t begin, size_t end) {
    GiEdit edit = {begin, end, edits->text.count, 0, edits->list.count};
    if (!gi_array_push(edits->document->memory, &edits->list, edit)) edits->failed = true;
}

static void add(GiEdits *edits, const char *bytes, size_t size) {
    if (edits->failed) return;
    if (!append(edits->document->memory, &edits->text, bytes, size)) edits->failed = true;
    if (!edits->failed) edits->list.data[edits->list.count - 1].size += size;
}

static void add_text(GiEdits *edits, const char *text) { add(edits, text, strlen(text)); }

void gi_edit_replace(GiEdits *edits, size_t begin, size_t end, GiSpan text) {
    begin_edit(edits, begin, end);
    add(edits, text.data, text.size);
}

void gi_edit_element(GiEdits *edits, size_t begin, size_t end, const char *name, GiSpan content) {
    begin_edit(edits, begin, end);
    add_text(edits, "<");
    add_text(edits, name);
    add_text(edits, ">");
    add(edits, content.data, content.size);
    add_text(edits, "</");
    add_text(edits, name);
    add_text(edits, ">");
}

static void replace_span(GiEdits *edits, GiSpan old, const char *text) {
    size_t begin = (size_t)(old.data - edits->document->text.data);
    gi_edit_replace(edits, begin, begin + old.size, gi_span(text));
}

void gi_edit_rename(GiEdits *edits, size_t start, const char *name) {
    const GiToken *token = &edits->document->tokens.data[start];
    replace_span(edits, gi_document_name(edits->document, start), name);
    if (token->kind == GI_TOKEN_START) {
        replace_span(edits, gi_document_name(edits->document, token->match), name);
    }
}

void gi_edit_set_attribute(GiEdits *edits, size_t start, const char *name, const char *value) {
    const GiDocument *document = edits->document;
    GiSpan tag = gi_document_name(document, start);
    size_t behind_name = (size_t)(tag.data - document->text.data) + tag.size;
    GiAttribute attribute;
    for (size_t at = 0; gi_document_attribute(document, start, &at, &attribute);) {
        if (!gi_span_is(attribute.name, name)) continue;
        if (value != NULL) {
            replace_span(edits, attribute.value, value);
            return;
        }
        size_t begin = (size_t)(attribute.name.data - document->text.data);
        while (document->text.data[begin - 1] != '"' && document->text.data[begin - 1] != '\'' &&
               begin > behind_name) {
            begin--;
        }
        gi_edit_replace(edits, begin, document->tokens.data[start].begin + at, gi_span(""));
        return;
    }
    if (value == NULL) return;
    begin_edit(edits, behind_name, behind_name);
    add_text(edits, " ");
    add_text(edits, name);
    add_text(edits, "=\"");
    add_text(edits, value);
    add_text(edits, "\"");
}

/* ---------------------------------------------------------------- children */

static void append_to_empty(
    GiEdits *edits, size_t start, const char *name, const char *const *children, int count) {
    const GiToken *token = &edits->document->tokens.data[start];
    size_t begin = token->end - 2;
    const char *text = edits->document->text.data;
    while (text[begin - 1] == ' ' || text[begin - 1] == '\t' || text[begin - 1] == '\n') begin--;
    begin_edit(edits, begin, token->end);
    add_text(edits, ">");
    for (int i = 0; i < count; i++) add_text(edits, children[i]);
    add_text(edits, "</");
    add_text(edits, name);
    add_text(edits, ">");
}

/* The white space before a token, from its last line feed on; size 0: it begins no line. */
static GiSpan line_before(const GiDocument *document, size_t token) {
    GiSpan none = {NULL, 0};
    if (token == GI_NO_TOKEN || token == 0 || !document->tokens.data[token - 1].blank) return none;
    GiSpan blank = gi_document_span(document, token - 1);
    for (size_t i = blank.size; i-- > 0;) {
        if (blank.data[i] == '\n') return (GiSpan){blank.data + i, blank.size - i};
    }
    return none;
}

void gi_edit_append(
    GiEdits *edits, size_t start, const char *name, const char *const *children, int count) {
    const GiDocument *document = edits->document;
    const GiToken *token = &document->tokens.data[start];
    if (token->kind == GI_TOKEN_EMPTY) {
        append_to_empty(edits, start, name, children, count);
        return;
    }
    GiSpan line = line_before(document, gi_document_first_child(document, start));
    size_t at = document->tokens.data[token->match].begin;
    /* The end tag keeps what stands before it. */
    if (line.size > 0 && document->tokens.data[token->match - 1].blank) {
        at = document->tokens.data[token->match - 1].begin;
    }
    begin_edit(edits, at, at);
    for (int i = 0; i < count; i++) {
        add(edits, line.data, line.size);
        add_text(edits, children[i]);
    }
}

/* ---------------------------------------------------------------- making */

static int compare(const void *a, const void *b) {
    const GiEdit *left = a, *right = b;
    if (left->begin != right->begin) return left->begin < right->begin ? -1 : 1;
    return left->order < right->order ? -1 : 1;
}

bool gi_edits_apply(GiEdits *edits, GiText *text) {
    const GiDocument *document = edits->document;
    if (edits->failed) return false;
    if (edits->list.count > 0) {
        qsort(edits->list.data, edits->list.count, sizeof(GiEdit), compare);
    }
    size_t at = 0;
    for (size_t i = 0; i < edits->list.count; i++) {
        const GiEdit *edit = &edits->list.data[i], *next = edit + 1;
        /* Of two for the same part the later one counts; in a part that goes nothing does. */
        bool last = i + 1 == edits->list.count;
        bool again = !last && edit->begin < edit->end && next->begin == edit->begin &&
                     next->end == edit->end;
        if (again || edit->begin < at) continue;
        if (!append(document->memory, text, document->text.data + at, edit->begin - at) ||
            !append(document->memory, text, edits->text.data + edit->text, edit->size)) {
            return false;
        }
        at = edit->end;
    }
    return append(document->memory, text, document->text.data + at, document->text.count - at);
}
