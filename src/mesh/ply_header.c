/* SPDX-License-Identifier: MIT */
#include "mesh/ply.h"

#include <string.h>

/* A line in words; what has more is not of a header. */
enum { WORD_LIMIT = 6 };

typedef struct Line {
    const char *word[WORD_LIMIT];
    const char *end; /* of the text that words lie in */
    int count;
} Line;

static const char *take_line(const char *p, const char *end, Line *line) {
    const char *newline = memchr(p, '\n', (size_t)(end - p));
    line->end = newline != NULL ? newline : end;
    line->count = 0;
    while (line->count < WORD_LIMIT) {
        while (p < line->end && gi_mesh_is_blank(*p)) p++;
        if (p == line->end) break;
        line->word[line->count++] = p;
        p = gi_mesh_word_end(p, line->end);
    }
    return newline != NULL ? newline + 1 : end;
}

static bool is_word(const Line *line, int i, const char *text) {
    if (i >= line->count) return false;
    size_t length = (size_t)(gi_mesh_word_end(line->word[i], line->end) - line->word[i]);
    return strlen(text) == length && memcmp(text, line->word[i], length) == 0;
}

static bool refuse_word(GiMeshInput *input, const Line *line, int i, const char *expected) {
    if (i >= line->count) {
        return gi_mesh_refuse(input, 0, line->end, "expected %s, found nothing", expected);
    }
    return gi_mesh_refuse(input, 0, line->word[i], "expected %s, found \"%s\"", expected,
        gi_mesh_quote(line->word[i], line->end).text);
}

/* ---------------------------------------------------------------- properties */

static GiPlyType find_type(const Line *line, int i) {
    static const char names[][2][8] = {{"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},
        {"ushort", "uint16"}, {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"},
        {"double", "float64"}};
    int type = 0;
    while (type < GI_PLY_NO_TYPE && !is_word(line, i, names[type][0]) &&
           !is_word(line, i, names[type][1])) {
        type++;
    }
    return (GiPlyType)type;
}

/* The role by name; of two properties with one role the first has it. */
static GiPlyRole find_role(const GiPlyElement *element, const Line *line, int i, bool is_list) {
    static const struct {
        char name[15];
        GiPlyRole role;
    } roles[] = {{"x", GI_PLY_X}, {"y", GI_PLY_Y}, {"z", GI_PLY_Z}, {"nx", GI_PLY_NX},
        {"ny", GI_PLY_NY}, {"nz", GI_PLY_NZ}, {"u", GI_PLY_U}, {"v", GI_PLY_V}, {"s", GI_PLY_U},
        {"t", GI_PLY_V}, {"texture_u", GI_PLY_U}, {"texture_v", GI_PLY_V},
        {"vertex_indices", GI_PLY_INDICES}, {"vertex_index", GI_PLY_INDICES}};
    for (size_t k = 0; k < sizeof roles / sizeof roles[0]; k++) {
        GiPlyRole role = roles[k].role;
        bool fits = role == GI_PLY_INDICES ? is_list && element->kind == GI_PLY_FACE
                                           : !is_list && element->kind == GI_PLY_VERTEX;
        if (fits && (element->roles >> role & 1) == 0 && is_word(line, i, roles[k].name)) {
            return role;
        }
    }
    return GI_PLY_SKIPPED;
}

/* property TYPE NAME, or property list TYPE TYPE NAME. */
static bool read_property(GiMeshInput *input, GiPlyHeader *header, const Line *line) {
    if (header->elements.count == 0) {
        return gi_mesh_refuse(input, 0, line->word[0], "a property without an element");
    }
    GiPlyElement *element = &header->elements.data[header->elements.count - 1];
    bool is_list = is_word(line, 1, "list");
    int last = is_list ? 4 : 2;
    GiPlyProperty property = {.count_type = is_list ? find_type(line, 2) : GI_PLY_NO_TYPE,
        .type = find_type(line, last - 1),
        .role = find_role(element, line, last, is_list)};
    if (is_list && property.count_type >= GI_PLY_FLOAT) {
        return refuse_word(input, line, 2, "the type of a whole number");
    }
    if (property.type == GI_PLY_NO_TYPE) return refuse_word(input, line, last - 1, "a type");
    if (line->count < last + 1) return refuse_word(input, line, last, "the name of a property");
    if (line->count > last + 1) return refuse_word(input, line, last + 1, "the end of the line");
    if (property.role == GI_PLY_INDICES && property.type >= GI_PLY_FLOAT) {
        return refuse_word(input, line, last - 1, "the type of a whole number");
    }
    element->property_count++;
    if (property.role != GI_PLY_SKIPPED) element->roles |= 1u << property.role;
    if (gi_array_push(input->memory, &header->properties, property)) return true;
    atomic_store(&input->stop, GLINT_ERROR_MEMORY);
    return false;
}

/* ---------------------------------------------------------------- elements */

/* element NAME COUNT */
static bool read_element(GiMeshInput *input, GiPlyHeader *header, const Line *line) {
    GiPlyElement element = {.kind = is_word(line, 1, "vertex") ? GI_PLY_VERTEX
                                    : is_word(line, 1, "face") ? GI_PLY_FACE
                                                               : GI_PLY_OTHER,
        .first_property = header->properties.count};
    if (line->count < 2) return refuse_word(input, line, 1, "the name of an element");
    const char *p = line->count > 2 ? line->word[2] : line->end;
    const char *word_end = gi_mesh_word_end(p, line->end);
    for (; p < word_end && (unsigned char)(*p - '0') <= 9; p++) {
        /* What is cut here is more than any file holds. */
        if (element.row_count < SIZE_MAX / 1000) {
            element.row_count = element.row_count * 10 + (size_t)(*p - '0');
        }
    }
    if (line->count < 3 || p < word_end) return refuse_word(input, line, 2, "a number of elements");
    if (line->count > 3) return refuse_word(input, line, 3, "the end of the line");
    for (size_t i = 0; element.kind != GI_PLY_OTHER && i < header->elements.count; i++) {
        if (header->elements.data[i].kind != element.kind) continue;
        return gi_mesh_refuse(input, 0, line->word[1], "a second element \"%s\"",
            gi_mesh_quote(line->word[1], line->end).text);
    }
    if (gi_array_push(input->memory, &header->elements, element)) return true;
    atomic_store(&input->stop, GLINT_ERROR_MEMORY);
    return false;
}

/* format NAME 1.0 */
static bool read_format(GiMeshInput *input, GiPlyHeader *header, const Line *line, bool *known) {
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    if (*known) return gi_mesh_refuse(input, 0, line->word[0], "a second format");
    int encoding = 0;
    while (encoding < 3 && !is_word(line, 1, names[encoding])) encoding++;
    if (encoding == 3) {
        return refuse_word(input, line, 1, "ascii, binary_little_endian or binary_big_endian");
    }
    if (!is_word(line, 2, "1.0")) return refuse_word(input, line, 2, "1.0");
    header->encoding = (GiPlyEncoding)encoding;
    *known = true;
    return true;
}

static bool read_line(
    GiMeshInput *input, GiPlyHeader *header, const Line *line, bool *format_known) {
    if (line->count == 0 || is_word(line, 0, "comment") || is_word(line, 0, "obj_info")) {
        return true;
    }
    if (is_word(line, 0, "property")) return read_property(input, header, line);
    if (is_word(line, 0, "element")) return read_element(input, header, line);
    if (is_word(line, 0, "format")) return read_format(input, header, line, format_known);
    return refuse_word(input, line, 0, "a line of a header");
}

static bool read_lines(GiMeshInput *input, GiPlyHeader *header) {
    Line line;
    bool format_known = false;
    const char *p = take_line(input->text, input->end, &line);
    if (!is_word(&line, 0, "ply")) return refuse_word(input, &line, 0, "\"ply\"");
    for (;;) {
        if (p == input->end) {
            return gi_mesh_refuse(input, 0, p, "the file ends within its header");
        }
        p = take_line(p, input->end, &line);
        if (is_word(&line, 0, "end_header")) break;
        if (!read_line(input, header, &line, &format_known)) return false;
    }
    header->body = p;
    if (format_known) return true;
    return gi_mesh_refuse(input, 0, line.word[0], "the header names no format");
}

static size_t row_size(const GiPlyHeader *header, const GiPlyElement *element) {
    size_t size = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const GiPlyProperty *property = &header->properties.data[element->first_property + i];
        if (property->count_type != GI_PLY_NO_TYPE) return 0;
        size += header->encoding == GI_PLY_ASCII ? 1 : gi_ply_type_size(property->type);
    }
    return size;
}

/* Whether there are vertices with a place and faces with corners. */
static bool check(GiMeshInput *input, GiPlyHeader *header) {
    static const char *const names[] = {"vertex", "face"};
    for (size_t i = 0; i < header->elements.count; i++) {
        GiPlyElement *element = &header->elements.data[i];
        element->row_size = row_size(header, element);
        if (element->kind != GI_PLY_OTHER) header->known[element->kind] = element;
    }
    const char *at = header->body - 1; /* in the last line of the header */
    for (int kind = 0; kind < GI_PLY_KIND_COUNT; kind++) {
        if (header->known[kind] != NULL) continue;
        return gi_mesh_refuse(input, 0, at, "there is no element \"%s\"", names[kind]);
    }
    unsigned place = 1u << GI_PLY_X | 1u << GI_PLY_Y | 1u << GI_PLY_Z;
    if ((header->known[GI_PLY_VERTEX]->roles & place) != place) {
        return gi_mesh_refuse(input, 0, at, "a vertex lacks x, y or z");
    }
    if (header->known[GI_PLY_FACE]->roles >> GI_PLY_INDICES == 0) {
        return gi_mesh_refuse(input, 0, at, "a face lacks its list vertex_indices");
    }
    return true;
}

GlintStatus gi_ply_header_read(GiMeshInput *input, GiPlyHeader *header) {
    *header = (GiPlyHeader){.encoding = GI_PLY_ASCII};
    if (read_lines(input, header)) check(input, header);
    return gi_mesh_input_status(input);
}

void gi_ply_header_reset(GiPlyHeader *header, GiMemory *memory) {
    gi_array_free(memory, &header->elements);
    gi_array_free(memory, &header->properties);
}
