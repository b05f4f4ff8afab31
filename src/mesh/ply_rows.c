/* SPDX-License-Identifier: MIT
 * The rows of a PLY file, as words or as bytes: passed over to count their triangles and to find
 * whether the file holds what it declares, then read for their numbers. A row ends where its last
 * value does; ends of lines are white space like any other. */
#include "math/digits.h"
#include "mesh/ply.h"

#include <float.h>
#include <string.h>

typedef struct Rows {
    const GiPly *ply;
    GiMeshInput *input;
    int worker;
    GiPlyEncoding encoding;
    const char *p, *end;
    size_t triangle, triangle_limit;
} Rows;

static Rows begin_rows(const GiPly *ply, int worker, const GiPlyPlace *place) {
    return (Rows){.ply = ply,
        .input = ply->input,
        .worker = worker,
        .encoding = ply->header.encoding,
        .p = place->at,
        .end = ply->input->end,
        .triangle = place->triangle};
}

/* ---------------------------------------------------------------- values */

static bool refuse_end(Rows *rows) {
    return gi_mesh_refuse(
        rows->input, rows->worker, rows->end, "the file ends before its last element");
}

/* Where the next value begins. */
static inline const char *next_value(Rows *rows) {
    if (rows->encoding == GI_PLY_ASCII) {
        while (rows->p < rows->end && gi_mesh_is_space(*rows->p)) rows->p++;
    }
    return rows->p;
}

/* Whether there is another word. */
static inline bool find_word(Rows *rows) {
    return next_value(rows) < rows->end || refuse_end(rows);
}

/* Two, four or eight bytes as a number; compilers make one load of it. */
static inline uint32_t load_2(const unsigned char *p, bool big) {
    return big ? (uint32_t)p[0] << 8 | p[1] : (uint32_t)p[1] << 8 | p[0];
}

static inline uint32_t load_4(const unsigned char *p, bool big) {
    return big ? (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]
               : (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

static inline uint64_t load_8(const unsigned char *p, bool big) {
    uint64_t first = load_4(p, big), second = load_4(p + 4, big);
    return big ? first << 32 | second : second << 32 | first;
}

/* The address of a binary value, which is moved past; null at the end of the file. */
static inline const unsigned char *take_value(Rows *rows, GiPlyType type) {
    size_t size = gi_ply_type_size(type);
    if ((size_t)(rows->end - rows->p) < size) {
        refuse_end(rows);
        return NULL;
    }
    rows->p += size;
    return (const unsigned char *)rows->p - size;
}

static inline int64_t load_integer(const unsigned char *p, GiPlyType type, bool big) {
    switch (type) {
    case GI_PLY_INT8: return (int8_t)*p;
    case GI_PLY_UINT8: return *p;
    case GI_PLY_INT16: return (int16_t)load_2(p, big);
    case GI_PLY_UINT16: return load_2(p, big);
    case GI_PLY_INT32: return (int32_t)load_4(p, big);
    default: return load_4(p, big);
    }
}

static inline float load_real(const unsigned char *p, GiPlyType type, bool big) {
    if (type == GI_PLY_FLOAT) {
        uint32_t bits = load_4(p, big);
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    if (type != GI_PLY_DOUBLE) return (float)load_integer(p, type, big);
    uint64_t bits = load_8(p, big);
    double value;
    memcpy(&value, &bits, sizeof value);
    return (float)value;
}

/* Of digits that may be too many; what is cut here is more than any file holds. */
static int64_t cut_integer(const char *p, const char *end) {
    int64_t number = 0;
    for (; p < end; p++) {
        if (number < INT64_MAX / 20) number = number * 10 + (*p - '0');
    }
    return number;
}

static inline bool read_integer_word(Rows *rows, int64_t *value) {
    if (!find_word(rows)) return false;
    const char *word = rows->p, *digits = word + (*word == '-');
    uint64_t number = 0;
    const char *p = gi_digits_read(digits, rows->end, &number);
    if (p == digits || (p < rows->end && !gi_mesh_is_space(*p))) {
        return gi_mesh_refuse(rows->input, rows->worker, word,
            "expected a whole number, found \"%s\"", gi_mesh_quote(word, rows->end).text);
    }
    *value = p - digits > 18 ? cut_integer(digits, p) : (int64_t)number;
    if (*word == '-') *value = -*value;
    rows->p = p;
    return true;
}

static inline bool read_integer(Rows *rows, GiPlyType type, int64_t *value) {
    if (rows->encoding == GI_PLY_ASCII) return read_integer_word(rows, value);
    const unsigned char *p = take_value(rows, type);
    if (p == NULL) return false;
    *value = load_integer(p, type, rows->encoding == GI_PLY_BIG_ENDIAN);
    return true;
}

static inline bool read_real(Rows *rows, GiPlyType type, float *value) {
    if (rows->encoding == GI_PLY_ASCII) {
        if (!find_word(rows)) return false;
        const char *word = rows->p;
        const char *number_end = gi_mesh_number(rows->input, rows->worker, word, rows->end, value);
        if (number_end == NULL) return false;
        rows->p = number_end;
        return number_end == rows->end || gi_mesh_is_space(*number_end) ||
               gi_mesh_no_number(rows->input, rows->worker, word, rows->end);
    }
    const unsigned char *p = take_value(rows, type);
    if (p == NULL) return false;
    *value = load_real(p, type, rows->encoding == GI_PLY_BIG_ENDIAN);
    return (*value >= -FLT_MAX && *value <= FLT_MAX) ||
           gi_mesh_refuse(rows->input, rows->worker, rows->p, "a number of a vertex is not finite");
}

static inline bool skip_values(Rows *rows, GiPlyType type, uint64_t count) {
    if (rows->encoding == GI_PLY_ASCII) {
        const char *p = gi_mesh_skip_words(rows->p, rows->end, count);
        if (p == NULL) return refuse_end(rows);
        rows->p = p;
        return true;
    }
    size_t size = gi_ply_type_size(type);
    if (count > (size_t)(rows->end - rows->p) / size) return refuse_end(rows);
    rows->p += count * size;
    return true;
}

/* ---------------------------------------------------------------- counting */

static inline bool read_list_count(Rows *rows, const GiPlyProperty *property, uint64_t *count) {
    const char *at = next_value(rows);
    /* Of one digit nearly always, by which the processor can guess where the next word is. */
    if (rows->encoding == GI_PLY_ASCII && rows->end - at >= 2 && gi_is_digit(at[0]) &&
        gi_mesh_is_space(at[1])) {
        *count = (uint64_t)(at[0] - '0');
        rows->p = at + 1;
        return true;
    }
    int64_t value = 0;
    if (!read_integer(rows, property->count_type, &value)) return false;
    *count = (uint64_t)value;
    return value >= 0 || gi_mesh_refuse(rows->input, rows->worker, at, "a list has %lld entries",
                             (long long)value);
}

static inline bool read_corner_count(
    Rows *rows, const GiPlyProperty *property, size_t row, uint64_t *count) {
    const char *at = next_value(rows);
    if (!read_list_count(rows, property, count)) return false;
    return *count >= 3 || gi_mesh_refuse(rows->input, rows->worker, at,
                              "face %zu has %d corners, which is less than 3", row, (int)*count);
}

static inline bool skip_property(Rows *rows, const GiPlyProperty *property) {
    uint64_t count = 1;
    if (property->count_type != GI_PLY_NO_TYPE && !read_list_count(rows, property, &count)) {
        return false;
    }
    return skip_values(rows, property->type, count);
}

static bool skip_row(Rows *rows, const GiPlyElement *element, size_t row) {
    const GiPlyProperty *property = rows->ply->header.properties.data + element->first_property;
    const GiPlyProperty *end = property + element->property_count;
    for (; property < end; property++) {
        if (property->role != GI_PLY_INDICES) {
            if (!skip_property(rows, property)) return false;
            continue;
        }
        uint64_t count;
        if (!read_corner_count(rows, property, row, &count) ||
            !skip_values(rows, property->type, count)) {
            return false;
        }
        rows->triangle += (size_t)count - 2;
    }
    return true;
}

/* Rows of one size, at once. */
static bool skip_rows(Rows *rows, const GiPlyElement *element, size_t count) {
    return skip_values(rows, GI_PLY_UINT8, (uint64_t)count * element->row_size);
}

void gi_ply_move(const GiPlyHeader *header, GiPlyPlace *place, size_t count) {
    for (; place->element < header->elements.count; place->element++, place->row = 0) {
        const GiPlyElement *element = &header->elements.data[place->element];
        size_t left = element->property_count > 0 ? element->row_count - place->row : 0;
        if (count < left) {
            place->row += count;
            return;
        }
        count -= left;
    }
}

/* The rows of the element at *place that come before *stop end with this one. */
static size_t find_row_end(const GiPly *ply, const GiPlyPlace *place, const GiPlyPlace *stop) {
    if (place->element < stop->element) return ply->header.elements.data[place->element].row_count;
    return place->element == stop->element ? stop->row : 0;
}

bool gi_ply_count_rows(
    const GiPly *ply, int worker, const GiPlyPlace *stop, size_t size, GiPlyPlace *place) {
    enum { WORD_SIZE = 16 }; /* a guess; where words are longer it goes further than it should */
    Rows rows = begin_rows(ply, worker, place);
    const char *begin = place->at;
    size_t scale = rows.encoding == GI_PLY_ASCII ? WORD_SIZE : 1, done, row_end;
    bool good = true;
    while (good && (row_end = find_row_end(ply, place, stop)) > place->row &&
           (done = (size_t)(rows.p - begin)) < size) {
        const GiPlyElement *element = &ply->header.elements.data[place->element];
        size_t row = place->row;
        if (element->row_size > 0) {
            size_t count = (size - done) / (element->row_size * scale) + 1;
            if (count > row_end - row) count = row_end - row;
            good = skip_rows(&rows, element, count);
            row += count;
        } else {
            do good = skip_row(&rows, element, row++);
            while (good && row < row_end && (size_t)(rows.p - begin) < size);
        }
        gi_ply_move(&ply->header, place, row - place->row);
    }
    place->at = next_value(&rows);
    place->triangle = rows.triangle;
    return good;
}

/* ---------------------------------------------------------------- reading */

static bool read_vertex_number(Rows *rows, const GiPlyProperty *property, size_t row) {
    const GiMeshRoom *room = &rows->ply->room;
    GiPlyRole role = property->role;
    float value;
    if (!read_real(rows, property->type, &value)) return false;
    if (role <= GI_PLY_Z) {
        room->positions[row][role - GI_PLY_X] = value;
    } else if (role <= GI_PLY_NZ) {
        if (room->normals != NULL) room->normals[row][role - GI_PLY_NX] = value;
    } else if (room->texcoords != NULL) {
        room->texcoords[row][role - GI_PLY_U] = value;
    }
    return true;
}

static inline bool read_corner(Rows *rows, GiPlyType type, size_t row, uint32_t *corner) {
    int64_t vertex = 0;
    size_t vertex_count = rows->ply->header.known[GI_PLY_VERTEX]->row_count;
    const char *at = next_value(rows);
    if (!read_integer(rows, type, &vertex)) return false;
    *corner = rows->ply->first_position + (uint32_t)vertex;
    return (vertex >= 0 && (uint64_t)vertex < vertex_count) ||
           gi_mesh_refuse(rows->input, rows->worker, at,
               "face %zu names vertex %lld, but there are %zu", row, (long long)vertex,
               vertex_count);
}

/* What was counted is read once more, and differs only if another program writes to the file. */
static bool refuse_change(Rows *rows) {
    return gi_mesh_refuse(rows->input, rows->worker, rows->p, "the file changed while it was read");
}

static bool read_polygon(Rows *rows, const GiPlyProperty *property, size_t row) {
    uint64_t count;
    uint32_t first = 0, last = 0, corner;
    if (!read_corner_count(rows, property, row, &count)) return false;
    if (count - 2 > rows->triangle_limit - rows->triangle) return refuse_change(rows);
    for (uint64_t i = 0; i < count; i++) {
        if (!read_corner(rows, property->type, row, &corner)) return false;
        if (i == 0) first = corner;
        if (i >= 2) {
            GiCorners *triangle = &rows->ply->room.corners[rows->triangle++];
            (*triangle)[0] = first;
            (*triangle)[1] = last;
            (*triangle)[2] = corner;
        }
        last = corner;
    }
    return true;
}

static bool read_row(Rows *rows, const GiPlyElement *element, size_t row) {
    const GiPlyProperty *property = rows->ply->header.properties.data + element->first_property;
    const GiPlyProperty *end = property + element->property_count;
    for (; property < end; property++) {
        bool good;
        if (property->role == GI_PLY_SKIPPED) {
            good = skip_property(rows, property);
        } else if (property->role == GI_PLY_INDICES) {
            good = read_polygon(rows, property, row);
        } else {
            good = read_vertex_number(rows, property, row);
        }
        if (!good) return false;
    }
    return true;
}

bool gi_ply_read_rows(const GiPly *ply, int worker, const GiPlyPlace *from, const GiPlyPlace *to) {
    Rows rows = begin_rows(ply, worker, from);
    rows.triangle_limit = to->triangle;
    GiPlyPlace place = *from;
    size_t row_end;
    while ((row_end = find_row_end(ply, &place, to)) > place.row) {
        const GiPlyElement *element = &ply->header.elements.data[place.element];
        size_t count = row_end - place.row, row = place.row;
        if (element->kind == GI_PLY_OTHER && element->row_size > 0) {
            if (!skip_rows(&rows, element, count)) return false;
        } else {
            for (; row < row_end; row++) {
                if (!read_row(&rows, element, row)) return false;
            }
        }
        gi_ply_move(&ply->header, &place, count);
    }
    return (next_value(&rows) == to->at && rows.triangle == to->triangle) || refuse_change(&rows);
}
