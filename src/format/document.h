/* SPDX-License-Identifier: MIT
 * A scene file as its author wrote it: every comment and blank is there, as a list of tokens over
 * the text. A document is only made of a file that the reader accepts, so that nothing has to be
 * said about malformed XML here, and the tokens know which element of the table they are. */
#pragma once

#include "format/encoding.h"
#include "reader/element.h"
#include "reader/reader.h"

typedef enum GiTokenKind {
    GI_TOKEN_START, /* <a ...> */
    GI_TOKEN_EMPTY, /* <a ... /> */
    GI_TOKEN_END,   /* </a> */
    GI_TOKEN_TEXT,  /* character references are left as they are */
    GI_TOKEN_COMMENT,
    GI_TOKEN_OTHER /* CDATA, a processing instruction, the XML declaration, DOCTYPE */
} GiTokenKind;

typedef struct GiToken {
    GiTokenKind kind;
    bool blank;               /* a text of white space only */
    bool ignored;             /* inside of an element with a ref: the reader does not look at it */
    bool refers;              /* the start of an element with a ref */
    size_t begin, end;        /* into the text */
    size_t match;             /* of a start the index of its end, and the reverse; else its own */
    size_t parent;            /* the start of the element it stands in; GI_NO_TOKEN: none */
    const GiElement *element; /* of a start or empty token; null when ignored or not known */
    const GiType *type;       /* likewise; null when it has none */
} GiToken;

#define GI_NO_TOKEN SIZE_MAX

typedef struct GiDocument {
    GiMemory *memory;
    GiText text; /* UTF-8, lines end with a line feed; without a byte order mark */
    GI_ARRAY(GiToken) tokens;
    GiScene scene; /* what the reader made of it, without the files that it names */
} GiDocument;

typedef struct GiDocumentSource {
    const void *bytes;
    size_t size;
    const char *name;     /* for messages */
    GlintDialect dialect; /* AUTO: what the file says or shows */
    GlintDiagnosticFn diagnostic;
    void *diagnostic_user;
} GiDocumentSource;

/* Reads and takes apart. document->memory is set; all else is filled here and can be reset whatever
 * the outcome. Errors: SCENE, MEMORY. */
GlintStatus gi_document_load(
    GiDocument *document, const GiDocumentSource *source, GlintError *error);
void gi_document_reset(GiDocument *document);

static inline bool gi_token_opens(const GiToken *token) {
    return token->kind == GI_TOKEN_START || token->kind == GI_TOKEN_EMPTY;
}

GiSpan gi_document_span(const GiDocument *document, size_t token);

/* The name of a tag, as it is written. */
GiSpan gi_document_name(const GiDocument *document, size_t token);

/* The next attribute of a start tag: *at begins as 0. False behind the last. The value is as it is
 * written, without its quotes. */
bool gi_document_attribute(
    const GiDocument *document, size_t token, size_t *at, GiAttribute *attribute);

/* What a value means: references replaced, white space as blanks. Put into plain, unless the value
 * means itself. False when memory is short. */
bool gi_document_decode(const GiDocument *document, GiSpan *value, GiText *plain);

/* The value of an attribute; data null: it is not given. */
GiSpan gi_document_attribute_value(const GiDocument *document, size_t token, const char *name);

/* The first token in an element, or behind a sibling, that opens an element; GI_NO_TOKEN: there is
 * none. */
size_t gi_document_first_child(const GiDocument *document, size_t token);
size_t gi_document_next_child(const GiDocument *document, size_t token);

/* From 1; the column in characters. */
void gi_document_place(const GiDocument *document, size_t offset, int64_t *line, int64_t *column);
