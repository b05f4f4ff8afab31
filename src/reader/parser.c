/* SPDX-License-Identifier: MIT
 * Expat: its events become those of tree.c, its memory comes from the scene's, and what a scene may
 * not have of XML is refused. */
#include "reader/state.h"

#include <string.h>

/* ---------------------------------------------------------------- memory of the parser */

/* Expat's allocator has no user pointer: the memory is found through the thread, and each block
 * notes where it came from and how large it is. */
static _Thread_local GiMemory *parser_memory;

typedef union Header {
    struct {
        GiMemory *memory;
        size_t size;
    } block;
    max_align_t align;
} Header;

static void *resize_block(void *pointer, size_t size) {
    if (size > SIZE_MAX - sizeof(Header)) return NULL;
    Header *old = pointer != NULL ? (Header *)pointer - 1 : NULL;
    GiMemory *memory = old != NULL ? old->block.memory : parser_memory;
    Header *header = gi_memory_resize(
        memory, old, old != NULL ? old->block.size + sizeof(Header) : 0, size + sizeof(Header));
    if (header == NULL) return NULL;
    header->block.memory = memory;
    header->block.size = size;
    return header + 1;
}

static void *allocate_block(size_t size) { return resize_block(NULL, size); }

static void free_block(void *pointer) {
    if (pointer == NULL) return;
    Header *header = (Header *)pointer - 1;
    gi_memory_free(header->block.memory, header, header->block.size + sizeof(Header));
}

/* ---------------------------------------------------------------- what a scene may not have */

static GiPlace current_place(const GiReader *reader) {
    return (GiPlace){.offset = gi_parser_offset(reader)};
}

/* Entities can stand for gigabytes, or for other files; no scene needs them. */
static void XMLCALL on_entity(void *user, const XML_Char *name, int is_parameter,
    const XML_Char *value, int value_length, const XML_Char *base, const XML_Char *system_id,
    const XML_Char *public_id, const XML_Char *notation) {
    GiReader *reader = user;
    (void)is_parameter, (void)value, (void)value_length, (void)base;
    (void)system_id, (void)public_id, (void)notation;
    if (reader->stopped) return;
    char quote[GI_QUOTE_SIZE];
    gi_report_add(&reader->report, current_place(reader), 1,
        "a scene cannot declare entities: `%s`", gi_quote(quote, name, strlen(name)));
    gi_reader_stop(reader);
}

/* Default attributes are attributes that nobody wrote. */
static void XMLCALL on_attribute_list(void *user, const XML_Char *element, const XML_Char *name,
    const XML_Char *type, const XML_Char *value, int required) {
    GiReader *reader = user;
    (void)name, (void)type, (void)value, (void)required;
    if (reader->stopped) return;
    char quote[GI_QUOTE_SIZE];
    gi_report_add(&reader->report, current_place(reader), 1,
        "a scene cannot declare attributes: those of `%s`",
        gi_quote(quote, element, strlen(element)));
    gi_reader_stop(reader);
}

static void XMLCALL on_skipped_entity(void *user, const XML_Char *name, int is_parameter) {
    GiReader *reader = user;
    if (reader->stopped || is_parameter) return;
    char quote[GI_QUOTE_SIZE];
    gi_report_add(&reader->report, current_place(reader), 1,
        "unknown entity `&%s;`: only &lt; &gt; &amp; &quot; and &apos; are known",
        gi_quote(quote, name, strlen(name)));
}

static void XMLCALL on_declaration(
    void *user, const XML_Char *version, const XML_Char *encoding, int standalone) {
    GiReader *reader = user;
    (void)version, (void)standalone;
    if (encoding == NULL) return;
    size_t i = 0;
    for (; i + 1 < sizeof reader->encoding && encoding[i] != '\0'; i++) {
        reader->encoding[i] = gi_lower(encoding[i]);
    }
    if (strcmp(reader->encoding, "iso-8859-1") == 0) {
        reader->window.encoding = GI_ENCODING_LATIN1;
    }
    memcpy(reader->encoding, encoding, i);
}

/* ---------------------------------------------------------------- events */

static void XMLCALL on_start(void *user, const XML_Char *tag, const XML_Char **list) {
    GiReader *reader = user;
    if (reader->stopped) return;
    reader->attributes.count = 0;
    for (; list[0] != NULL; list += 2) {
        GiAttribute attribute = {gi_span(list[0]), gi_span(list[1])};
        if (gi_array_push(reader->memory, &reader->attributes, attribute)) continue;
        gi_reader_out_of_memory(reader);
        return;
    }
    gi_tree_start(reader, gi_span(tag), reader->attributes.data, (int)reader->attributes.count,
        gi_parser_offset(reader));
}

static void XMLCALL on_end(void *user, const XML_Char *tag) {
    GiReader *reader = user;
    (void)tag;
    gi_tree_end(reader, gi_parser_offset(reader) + XML_GetCurrentByteCount(reader->parser));
}

static void XMLCALL on_text(void *user, const XML_Char *text, int size) {
    GiReader *reader = user;
    gi_tree_text(reader, (GiSpan){text, (size_t)size}, gi_parser_offset(reader));
}

/* ---------------------------------------------------------------- the parser */

bool gi_parser_open(GiReader *reader) {
    XML_Memory_Handling_Suite suite = {allocate_block, resize_block, free_block};
    parser_memory = reader->memory;
    reader->parser = XML_ParserCreate_MM(NULL, &suite, NULL);
    if (reader->parser == NULL) return false;
    XML_SetUserData(reader->parser, reader);
    /* Expat gets into the state that it would be in by the tags of the open elements, or by one
     * element that is closed. Without handlers, they make no events. */
    const GiScanner *scanner = &reader->scanner;
    GiSpan open = gi_scanner_is_complete(scanner)
                      ? gi_span("<scene/>")
                      : (GiSpan){scanner->open.data, scanner->open.count};
    reader->parser_shift = scanner->next - (int64_t)open.size;
    if (open.size > 0 && !gi_parser_feed(reader, open.data, open.size, false)) return false;
    XML_SetElementHandler(reader->parser, on_start, on_end);
    XML_SetCharacterDataHandler(reader->parser, on_text);
    XML_SetEntityDeclHandler(reader->parser, on_entity);
    XML_SetAttlistDeclHandler(reader->parser, on_attribute_list);
    XML_SetSkippedEntityHandler(reader->parser, on_skipped_entity);
    XML_SetXmlDeclHandler(reader->parser, on_declaration);
    return true;
}

void gi_parser_close(GiReader *reader) {
    if (reader->parser != NULL) XML_ParserFree(reader->parser);
    gi_array_free(reader->memory, &reader->attributes);
}

int64_t gi_parser_offset(const GiReader *reader) {
    return XML_GetCurrentByteIndex(reader->parser) + reader->parser_shift;
}

bool gi_parser_feed(GiReader *reader, const void *bytes, size_t size, bool last) {
    parser_memory = reader->memory;
    return XML_Parse(reader->parser, bytes, (int)size, last) != XML_STATUS_ERROR;
}
