/* SPDX-License-Identifier: MIT
 * PLY: a header that says what follows, then the rows of its elements, as words or as bytes. The
 * body is gone through twice: first to count the triangles of its polygons and to find whether
 * the file holds what it declares, then to take the numbers. So nothing is allocated for what a
 * header only claims. */
#include "mesh/ply.h"

#include "mesh/decimal.h"

#include <float.h>
#include <string.h>

typedef struct Ply {
    GiMeshInput *input;
    GiPlyHeader header;
    const char *p, *end;
    size_t triangle_count; /* found; then, still to come */
    bool filling;          /* the second time */
    GiMeshRoom room;
    uint32_t first_position;
} Ply;

/* ---------------------------------------------------------------- values */

static bool refuse_end(Ply *ply) {
    return gi_mesh_refuse(ply->input, 0, ply->end, "the file ends before its last element");
}

/* Where the next value begins. */
static const char *next_value(Ply *ply) {
    if (ply->header.encoding == GI_PLY_ASCII) {
        while (ply->p < ply->end && gi_mesh_is_space(*ply->p)) ply->p++;
    }
    return ply->p;
}

/* Whether there is another word. */
static bool find_word(Ply *ply) { return next_value(ply) < ply->end || refuse_end(ply); }

/* A binary value in the order of this machine, low bytes first in *bits. */
static bool take_bits(Ply *ply, size_t size, uint64_t *bits) {
    if ((size_t)(ply->end - ply->p) < size) return refuse_end(ply);
    bool big = ply->header.encoding == GI_PLY_BIG_ENDIAN;
    *bits = 0;
    for (size_t i = 0; i < size; i++) {
        size_t shift = 8 * (big ? size - 1 - i : i);
        *bits |= (uint64_t)(unsigned char)ply->p[i] << shift;
    }
    ply->p += size;
    return true;
}

static int64_t integer_of(GiPlyType type, uint64_t bits) {
    switch (type) {
    case GI_PLY_INT8: return (int8_t)bits;
    case GI_PLY_INT16: return (int16_t)bits;
    case GI_PLY_INT32: return (int32_t)bits;
    default: return (int64_t)bits; /* at most 32 bits */
    }
}

static bool read_integer(Ply *ply, GiPlyType type, int64_t *value) {
    if (ply->header.encoding != GI_PLY_ASCII) {
        uint64_t bits = 0;
        if (!take_bits(ply, gi_ply_type_size(type), &bits)) return false;
        *value = integer_of(type, bits);
        return true;
    }
    if (!find_word(ply)) return false;
    const char *word = ply->p, *p = word;
    bool negative = *p == '-';
    p += negative;
    const char *digits = p;
    int64_t number = 0;
    for (; p < ply->end && (unsigned char)(*p - '0') <= 9; p++) {
        if (number < INT64_MAX / 20) number = number * 10 + (*p - '0');
    }
    if (p == digits || (p < ply->end && !gi_mesh_is_space(*p))) {
        return gi_mesh_refuse(ply->input, 0, word, "expected a whole number, found \"%s\"",
            gi_mesh_quote(word, ply->end).text);
    }
    *value = negative ? -number : number;
    ply->p = p;
    return true;
}

static float real_of(GiPlyType type, uint64_t bits) {
    if (type == GI_PLY_FLOAT) {
        uint32_t low = (uint32_t)bits;
        float value;
        memcpy(&value, &low, sizeof value);
        return value;
    }
    if (type != GI_PLY_DOUBLE) return (float)integer_of(type, bits);
    double value;
    memcpy(&value, &bits, sizeof value);
    return (float)value;
}

static bool read_real(Ply *ply, GiPlyType type, float *value) {
    if (ply->header.encoding == GI_PLY_ASCII) {
        if (!find_word(ply)) return false;
        const char *word = ply->p;
        const char *number_end = gi_mesh_number(ply->input, 0, word, ply->end, value);
        if (number_end == NULL) return false;
        ply->p = number_end;
        return number_end == ply->end || gi_mesh_is_space(*number_end) ||
               gi_mesh_no_number(ply->input, 0, word, ply->end);
    }
    uint64_t bits = 0;
    if (!take_bits(ply, gi_ply_type_size(type), &bits)) return false;
    *value = real_of(type, bits);
    return (*value >= -FLT_MAX && *value <= FLT_MAX) ||
           gi_mesh_refuse(ply->input, 0, ply->p, "a number of a vertex is not finite");
}

static bool skip_values(Ply *ply, GiPlyType type, uint64_t count) {
    if (ply->header.encoding != GI_PLY_ASCII) {
        size_t size = gi_ply_type_size(type);
        if (count > (size_t)(ply->end - ply->p) / size) return refuse_end(ply);
        ply->p += count * size;
        return true;
    }
    for (; count > 0; count--) {
        if (!find_word(ply)) return false;
        ply->p = gi_mesh_word_end(ply->p, ply->end);
    }
    return true;
}

/* ---------------------------------------------------------------- rows */

static bool read_list_count(Ply *ply, const GiPlyProperty *property, uint64_t *count) {
    const char *at = next_value(ply);
    int64_t value;
    if (!read_integer(ply, property->count_type, &value)) return false;
    *count = (uint64_t)value;
    return value >= 0 ||
           gi_mesh_refuse(ply->input, 0, at, "a list has %lld entries", (long long)value);
}

static bool skip_property(Ply *ply, const GiPlyProperty *property) {
    uint64_t count = 1;
    if (property->count_type != GI_PLY_NO_TYPE && !read_list_count(ply, property, &count)) {
        return false;
    }
    return skip_values(ply, property->type, count);
}

static bool read_vertex_number(Ply *ply, const GiPlyProperty *property, size_t row) {
    float value;
    if (!read_real(ply, property->type, &value)) return false;
    GiPlyRole role = property->role;
    if (role <= GI_PLY_Z) {
        ply->room.positions[row][role - GI_PLY_X] = value;
    } else if (role <= GI_PLY_NZ) {
        if (ply->room.normals != NULL) ply->room.normals[row][role - GI_PLY_NX] = value;
    } else if (ply->room.texcoords != NULL) {
        ply->room.texcoords[row][role - GI_PLY_U] = value;
    }
    return true;
}

static bool read_corner(Ply *ply, GiPlyType type, size_t row, uint32_t *corner) {
    int64_t vertex;
    size_t vertex_count = ply->header.known[GI_PLY_VERTEX]->row_count;
    const char *at = next_value(ply);
    if (!read_integer(ply, type, &vertex)) return false;
    *corner = ply->first_position + (uint32_t)vertex;
    return (vertex >= 0 && (uint64_t)vertex < vertex_count) ||
           gi_mesh_refuse(ply->input, 0, at, "face %zu names vertex %lld, but there are %zu", row,
               (long long)vertex, vertex_count);
}

/* Counts the triangles of a polygon, or takes them. */
static bool read_polygon(Ply *ply, const GiPlyProperty *property, size_t row) {
    const char *at = next_value(ply);
    uint64_t count;
    if (!read_list_count(ply, property, &count)) return false;
    if (count < 3) {
        return gi_mesh_refuse(
            ply->input, 0, at, "face %zu has %d corners, which is less than 3", row, (int)count);
    }
    if (!ply->filling) {
        ply->triangle_count += (size_t)count - 2;
        return skip_values(ply, property->type, count);
    }
    uint32_t first, last, corner;
    if (!read_corner(ply, property->type, row, &first) ||
        !read_corner(ply, property->type, row, &last)) {
        return false;
    }
    for (uint64_t i = 2; i < count; i++, last = corner) {
        if (!read_corner(ply, property->type, row, &corner)) return false;
        /* Both passes count alike, unless another program writes to the file meanwhile. */
        if (ply->triangle_count == 0) {
            return gi_mesh_refuse(ply->input, 0, at, "the file changed while it was read");
        }
        ply->triangle_count--;
        GiCorners *triangle = ply->room.corners++;
        (*triangle)[0] = first;
        (*triangle)[1] = last;
        (*triangle)[2] = corner;
    }
    return true;
}

static bool read_row(Ply *ply, const GiPlyElement *element, size_t row) {
    const GiPlyProperty *property = ply->header.properties.data + element->first_property;
    const GiPlyProperty *end = property + element->property_count;
    for (; property < end; property++) {
        bool good;
        if (property->role == GI_PLY_INDICES) {
            good = read_polygon(ply, property, row);
        } else if (property->role == GI_PLY_SKIPPED || !ply->filling) {
            good = skip_property(ply, property);
        } else {
            good = read_vertex_number(ply, property, row);
        }
        if (!good) return false;
    }
    return true;
}

/* ---------------------------------------------------------------- the body */

/* Bytes of a row; 0 where rows differ. */
static size_t row_size(const Ply *ply, const GiPlyElement *element) {
    size_t size = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const GiPlyProperty *property = &ply->header.properties.data[element->first_property + i];
        if (property->count_type != GI_PLY_NO_TYPE) return 0;
        size += gi_ply_type_size(property->type);
    }
    return ply->header.encoding == GI_PLY_ASCII ? 0 : size;
}

static bool read_element(Ply *ply, const GiPlyElement *element) {
    enum { ROWS_AT_ONCE = 16384 };
    /* Rows of nothing may be declared in any number. */
    if (element->property_count == 0) return true;
    size_t size = row_size(ply, element);
    if (size > 0 && (!ply->filling || element->kind == GI_PLY_OTHER)) {
        if (element->row_count > (size_t)(ply->end - ply->p) / size) return refuse_end(ply);
        ply->p += element->row_count * size;
        return true;
    }
    const char *begin = ply->p;
    for (size_t row = 0; row < element->row_count; row++) {
        if (row % ROWS_AT_ONCE == 0) {
            if (gi_mesh_is_cancelled(ply->input)) return false;
            gi_mesh_forget(ply->input, begin, ply->p);
            begin = ply->p;
        }
        if (!read_row(ply, element, row)) return false;
    }
    gi_mesh_forget(ply->input, begin, ply->p);
    return true;
}

/* What follows the last element is refused where it can be seen. */
static bool read_end(Ply *ply) {
    if (ply->header.encoding != GI_PLY_ASCII || next_value(ply) == ply->end) return true;
    return gi_mesh_refuse(ply->input, 0, ply->p, "expected the end of the file, found \"%s\"",
        gi_mesh_quote(ply->p, ply->end).text);
}

static GlintStatus read_body(Ply *ply) {
    ply->p = ply->header.body;
    bool good = true;
    for (size_t i = 0; i < ply->header.elements.count && good; i++) {
        good = read_element(ply, &ply->header.elements.data[i]);
    }
    if (good) read_end(ply);
    if (good && ply->filling && ply->triangle_count > 0) {
        gi_mesh_refuse(ply->input, 0, ply->p, "the file changed while it was read");
    }
    return gi_mesh_input_status(ply->input);
}

static bool has_roles(const GiPlyElement *element, GiPlyRole first, GiPlyRole last) {
    for (unsigned role = first; role <= last; role++) {
        if ((element->roles >> role & 1) == 0) return false;
    }
    return true;
}

static GlintStatus build(Ply *ply, GiMeshStore *store, uint32_t *index) {
    GiMeshInput *input = ply->input;
    const GiPlyElement *vertices = ply->header.known[GI_PLY_VERTEX];
    bool smooth = has_roles(vertices, GI_PLY_NX, GI_PLY_NZ);
    bool textured = has_roles(vertices, GI_PLY_U, GI_PLY_V);
    size_t count = vertices->row_count;
    GiMeshCounts counts = {count, smooth ? count : 0, textured ? count : 0, ply->triangle_count};
    GiMesh mesh;
    GlintStatus status = gi_mesh_check_triangles(counts.triangles, input->fault);
    if (status == GLINT_OK) {
        status = gi_mesh_begin(store, input->memory, &counts, &mesh, &ply->room, input->fault);
    }
    if (status != GLINT_OK) return status;
    mesh.smooth = smooth;
    mesh.textured = textured;
    ply->first_position = mesh.first_position;
    ply->filling = true;
    status = read_body(ply);
    if (status == GLINT_OK) *index = gi_mesh_end(store, input->memory, &counts, &mesh);
    return status;
}

GlintStatus gi_mesh_parse_ply(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh) {
    Ply ply = {.input = input, .end = input->end};
    GlintStatus status = gi_ply_header_read(input, &ply.header);
    if (status == GLINT_OK) {
        input->has_lines = ply.header.encoding == GI_PLY_ASCII;
        status = read_body(&ply);
    }
    if (status == GLINT_OK) status = build(&ply, store, mesh);
    gi_ply_header_reset(&ply.header, input->memory);
    return status;
}
