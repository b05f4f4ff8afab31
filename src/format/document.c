/* SPDX-License-Identifier: MIT */
#include "format/document.h"

#include "base/error.h"

#include <string.h>

/* ---------------------------------------------------------------- looking */

GiSpan gi_document_span(const GiDocument *document, size_t token) {
    const GiToken *t = &document->tokens.data[token];
    return (GiSpan){document->text.data + t->begin, t->end - t->begin};
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

GiSpan gi_document_name(const GiDocument *document, size_t token) {
    GiSpan span = gi_document_span(document, token);
    size_t begin = span.size > 1 && span.data[1] == '/' ? 2 : 1, end = begin;
    while (end < span.size && !is_blank(span.data[end]) && span.data[end] != '>' &&
           span.data[end] != '/') {
        end++;
    }
    return (GiSpan){span.data + begin, end - begin};
}

bool gi_document_attribute(
    const GiDocument *document, size_t token, size_t *at, GiAttribute *attribute) {
    GiSpan span = gi_document_span(document, token);
    GiSpan tag = gi_document_name(document, token);
    size_t i = *at > 0 ? *at : (size_t)(tag.data - span.data) + tag.size;
    while (i < span.size && is_blank(span.data[i])) i++;
    size_t name = i;
    while (i < span.size && !is_blank(span.data[i]) && strchr("=/>", span.data[i]) == NULL) i++;
    attribute->name = (GiSpan){span.data + name, i - name};
    while (i < span.size && (is_blank(span.data[i]) || span.data[i] == '=')) i++;
    if (attribute->name.size == 0 || i >= span.size) return false;
    const char *end = memchr(span.data + i + 1, span.data[i], span.size - i - 1);
    if (end == NULL) return false;
    attribute->value = (GiSpan){span.data + i + 1, (size_t)(end - span.data) - i - 1};
    *at = (size_t)(end - span.data) + 1;
    return true;
}

GiSpan gi_document_attribute_value(const GiDocument *document, size_t token, const char *name) {
    GiAttribute attribute;
    for (size_t at = 0; gi_document_attribute(document, token, &at, &attribute);) {
        if (gi_span_is(attribute.name, name)) return attribute.value;
    }
    return (GiSpan){NULL, 0};
}

/* The character that a reference stands for, between its & and ; */
static uint32_t decode_reference(GiSpan name) {
    static const struct {
        const char *name;
        uint32_t code;
    } known[] = {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (gi_span_is(name, known[i].name)) return known[i].code;
    }
    uint32_t code = 0;
    bool hexadecimal = name.size > 1 && name.data[1] == 'x';
    for (size_t i = hexadecimal ? 2 : 1; i < name.size && code <= 0x10ffff; i++) {
        unsigned char c = (unsigned char)name.data[i];
        uint32_t digit = c <= '9' ? c - (uint32_t)'0' : (c | 0x20u) - 'a' + 10u;
        code = code * (hexadecimal ? 16 : 10) + digit;
    }
    return code;
}

bool gi_document_decode(const GiDocument *document, GiSpan *value, GiText *plain) {
    bool itself = true;
    for (size_t i = 0; i < value->size && itself; i++) {
        itself = value->data[i] != '&' && value->data[i] != '\n' && value->data[i] != '\t';
    }
    if (itself) return true;
    plain->count = 0;
    for (size_t i = 0; i < value->size; i++) {
        const char *end = memchr(value->data + i, ';', value->size - i);
        char c = value->data[i];
        if (c == '&' && end != NULL) {
            GiSpan name = {value->data + i + 1, (size_t)(end - value->data) - i - 1};
            if (!gi_encoding_put(document->memory, plain, decode_reference(name))) return false;
            i += name.size + 1;
        } else if (!gi_array_push(document->memory, plain, is_blank(c) ? ' ' : c)) {
            return false;
        }
    }
    *value = (GiSpan){plain->data, plain->count};
    return true;
}

static size_t opening_from(const GiDocument *document, size_t i) {
    for (; i < document->tokens.count; i++) {
        if (gi_token_opens(&document->tokens.data[i])) return i;
        if (document->tokens.data[i].kind == GI_TOKEN_END) break;
    }
    return GI_NO_TOKEN;
}

size_t gi_document_first_child(const GiDocument *document, size_t token) {
    if (document->tokens.data[token].kind != GI_TOKEN_START) return GI_NO_TOKEN;
    return opening_from(document, token + 1);
}

size_t gi_document_next_child(const GiDocument *document, size_t token) {
    return opening_from(document, document->tokens.data[token].match + 1);
}

void gi_document_place(const GiDocument *document, size_t offset, int64_t *line, int64_t *column) {
    *line = *column = 1;
    for (size_t i = 0; i < offset; i++) {
        char c = document->text.data[i];
        if (c == '\n') {
            ++*line;
            *column = 1;
        } else {
            *column += ((unsigned char)c & 0xc0) != 0x80;
        }
    }
}

/* ---------------------------------------------------------------- taking apart */

/* Behind the next occurrence of a mark; the end of the text when there is none. */
static size_t find_behind(const GiDocument *document, size_t from, const char *mark) {
    const char *text = document->text.data;
    size_t size = strlen(mark), count = document->text.count;
    for (size_t i = from; i + size <= count; i++) {
        const char *next = memchr(text + i, mark[0], count - size + 1 - i);
        if (next == NULL) break;
        i = (size_t)(next - text);
        if (memcmp(next, mark, size) == 0) return i + size;
    }
    return count;
}

/* Behind the `>` of a tag or DOCTYPE, which may have quotes, and this also brackets. */
static size_t find_close(const GiDocument *document, size_t from) {
    const char *text = document->text.data;
    size_t count = document->text.count, i = from;
    int depth = 0;
    while (i < count) {
        char c = text[i];
        if (c == '"' || c == '\'') {
            const char *end = memchr(text + i + 1, c, count - i - 1);
            i = end != NULL ? (size_t)(end - text) + 1 : count;
        } else if (c == '<' && count - i >= 4 && memcmp(text + i, "<!--", 4) == 0) {
            i = find_behind(document, i + 4, "-->");
        } else if (c == '<' && count - i >= 2 && text[i + 1] == '?') {
            i = find_behind(document, i + 2, "?>");
        } else {
            depth += (c == '[') - (c == ']');
            i++;
            if (c == '>' && depth <= 0) return i;
            if (c == '<') i = find_close(document, i);
        }
    }
    return count;
}

static bool begins(const GiDocument *document, size_t at, const char *mark) {
    size_t size = strlen(mark);
    return document->text.count - at >= size && memcmp(document->text.data + at, mark, size) == 0;
}

/* The token that begins here, without its place in the tree. */
static GiToken cut(const GiDocument *document, size_t at) {
    GiToken token = {.begin = at, .parent = GI_NO_TOKEN};
    const char *text = document->text.data;
    if (text[at] != '<') {
        const char *end = memchr(text + at, '<', document->text.count - at);
        token.kind = GI_TOKEN_TEXT;
        token.end = end != NULL ? (size_t)(end - text) : document->text.count;
        token.blank = true;
        for (size_t i = at; i < token.end && token.blank; i++) token.blank = is_blank(text[i]);
    } else if (begins(document, at, "<!--")) {
        token.kind = GI_TOKEN_COMMENT;
        token.end = find_behind(document, at + 4, "-->");
    } else if (begins(document, at, "<![CDATA[")) {
        token.kind = GI_TOKEN_OTHER;
        token.end = find_behind(document, at + 9, "]]>");
    } else if (begins(document, at, "<?")) {
        token.kind = GI_TOKEN_OTHER;
        token.end = find_behind(document, at + 2, "?>");
    } else if (begins(document, at, "<!")) {
        token.kind = GI_TOKEN_OTHER;
        token.end = find_close(document, at + 2);
    } else {
        token.end = find_close(document, at + 1);
        token.kind = text[at + 1] == '/'          ? GI_TOKEN_END
                     : text[token.end - 2] == '/' ? GI_TOKEN_EMPTY
                                                  : GI_TOKEN_START;
    }
    return token;
}

/* What the table has on an element, as tree.c finds it. False when memory is short. */
static bool recognise(
    GiDocument *document, const GiElementIndex *index, size_t at, GiToken *token) {
    const GiToken *parent =
        token->parent != GI_NO_TOKEN ? &document->tokens.data[token->parent] : NULL;
    token->ignored = parent != NULL && (parent->ignored || parent->refers);
    if (token->ignored || !gi_token_opens(token)) return true;
    if (parent == NULL) {
        token->element = &gi_elements[0];
        return true;
    }
    GiContexts contexts = parent->type != NULL ? parent->type->context : GI_IN_SCENE;
    token->element = gi_element_find(index, gi_document_name(document, at), contexts);
    if (token->element == NULL) {
        token->ignored = true;
        return true;
    }
    token->refers = gi_document_attribute_value(document, at, "ref").data != NULL;
    if (!gi_kind_is_object(token->element->kind)) return true;
    GiSpan type = gi_document_attribute_value(document, at, "type");
    GiText plain = {0};
    bool good = gi_document_decode(document, &type, &plain);
    if (type.data == NULL && token->element->type != NULL) type = gi_span(token->element->type);
    for (size_t i = type.size; i-- > 0;) {
        if (type.data[i] != '.') continue;
        type = (GiSpan){type.data + i + 1, type.size - i - 1};
        break;
    }
    token->type = gi_type_find(type, token->element->kind);
    gi_array_free(document->memory, &plain);
    return good;
}

static bool take_apart(GiDocument *document) {
    GiElementIndex index;
    gi_element_index_init(&index);
    size_t open = GI_NO_TOKEN;
    for (size_t at = 0; at < document->text.count;) {
        size_t i = document->tokens.count;
        GiToken token = cut(document, at);
        token.match = i;
        token.parent = open;
        if (token.kind == GI_TOKEN_END && open != GI_NO_TOKEN) {
            GiToken *start = &document->tokens.data[open];
            start->match = i;
            token.match = open;
            token.ignored = start->ignored;
            open = token.parent = start->parent;
        }
        if (!gi_array_push(document->memory, &document->tokens, token)) return false;
        GiToken *kept = &document->tokens.data[i];
        if (kept->kind != GI_TOKEN_END && !recognise(document, &index, i, kept)) return false;
        if (kept->kind == GI_TOKEN_START) open = i;
        at = token.end;
    }
    return true;
}

/* ---------------------------------------------------------------- load */

typedef struct Bytes {
    const char *next;
    size_t left;
} Bytes;

static int64_t read_bytes(void *user, void *buffer, size_t size) {
    Bytes *bytes = user;
    if (size > bytes->left) size = bytes->left;
    if (size > 0) memcpy(buffer, bytes->next, size);
    bytes->next += size;
    bytes->left -= size;
    return (int64_t)size;
}

GlintStatus gi_document_load(
    GiDocument *document, const GiDocumentSource *source, GlintError *error) {
    GiMemory *memory = document->memory;
    memset(document, 0, sizeof *document);
    document->memory = memory;
    if (!gi_scene_init(&document->scene, memory)) return gi_error_memory(error);
    Bytes bytes = {source->bytes, source->size};
    const GiReaderSource reading = {.read = read_bytes,
        .user = &bytes,
        .name = source->name,
        .total_size = (int64_t)source->size,
        .dialect = source->dialect,
        .diagnostic = source->diagnostic,
        .diagnostic_user = source->diagnostic_user,
        .thread_count = 1,
        .without_files = true};
    GlintStatus status = gi_reader_load(&document->scene, &reading, NULL, error);
    if (status != GLINT_OK) return status;
    bool good = gi_encoding_to_utf8(memory, source->bytes, source->size, &document->text);
    return good && take_apart(document) ? GLINT_OK : gi_error_memory(error);
}

void gi_document_reset(GiDocument *document) {
    gi_array_free(document->memory, &document->text);
    gi_array_free(document->memory, &document->tokens);
    gi_scene_reset(&document->scene);
}
