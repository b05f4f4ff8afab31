/* SPDX-License-Identifier: MIT
 * PLY in three steps: the header says which elements follow, each with its number of rows and the
 * properties that a row has; the body is cut into parts at borders of rows; the parts are read. */
#pragma once

#include "mesh/input.h"

/* ---------------------------------------------------------------- the header */

typedef enum GiPlyEncoding { GI_PLY_ASCII, GI_PLY_LITTLE_ENDIAN, GI_PLY_BIG_ENDIAN } GiPlyEncoding;

typedef enum GiPlyType {
    GI_PLY_INT8,
    GI_PLY_UINT8,
    GI_PLY_INT16,
    GI_PLY_UINT16,
    GI_PLY_INT32,
    GI_PLY_UINT32,
    GI_PLY_FLOAT,
    GI_PLY_DOUBLE,
    GI_PLY_NO_TYPE
} GiPlyType;

/* What a property is to the mesh. The first eight are numbers of a vertex. */
typedef enum GiPlyRole {
    GI_PLY_X,
    GI_PLY_Y,
    GI_PLY_Z,
    GI_PLY_NX,
    GI_PLY_NY,
    GI_PLY_NZ,
    GI_PLY_U,
    GI_PLY_V,
    GI_PLY_INDICES, /* the list of a face's corners */
    GI_PLY_SKIPPED
} GiPlyRole;

typedef struct GiPlyProperty {
    GiPlyType count_type; /* of a list; otherwise GI_PLY_NO_TYPE */
    GiPlyType type;
    GiPlyRole role;
} GiPlyProperty;

typedef enum GiPlyKind {
    GI_PLY_VERTEX,
    GI_PLY_FACE,
    GI_PLY_OTHER,
    GI_PLY_KIND_COUNT = GI_PLY_OTHER
} GiPlyKind;

typedef struct GiPlyElement {
    GiPlyKind kind;
    size_t row_count;
    size_t first_property, property_count;
    size_t row_size; /* of each row, in bytes, or in words for ascii; 0 where rows differ */
    unsigned roles;  /* bits of those that it has */
} GiPlyElement;

typedef struct GiPlyHeader {
    GiPlyEncoding encoding;
    GI_ARRAY(GiPlyElement) elements;
    GI_ARRAY(GiPlyProperty) properties;
    const GiPlyElement *known[GI_PLY_KIND_COUNT]; /* the vertices, the faces */
    const char *body;                             /* what follows the header */
} GiPlyHeader;

/* Bytes of a value of that type. */
static inline size_t gi_ply_type_size(GiPlyType type) {
    static const unsigned char sizes[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};
    return sizes[type];
}

/* Reads the header and checks that it describes a mesh. gi_ply_header_reset must follow, also after
 * a failure. */
GlintStatus gi_ply_header_read(GiMeshInput *input, GiPlyHeader *header);
void gi_ply_header_reset(GiPlyHeader *header, GiMemory *memory);

/* ---------------------------------------------------------------- rows */

/* A border between two rows of the body. */
typedef struct GiPlyPlace {
    const char *at;      /* where the next row begins */
    size_t element, row; /* which one that is; behind the last: the number of elements, and 0 */
    size_t triangle;     /* how many come before */
} GiPlyPlace;

typedef struct GiPly {
    GiMeshInput *input;
    GiPlyHeader header;
    GiMeshRoom room;
    uint32_t first_position;
} GiPly;

/* Moves a place by `count` rows, up to the last, but not its address. The rows of an element
 * without properties hold nothing and do not count. */
void gi_ply_move(const GiPlyHeader *header, GiPlyPlace *place, size_t count);

/* Moves *place over rows, and adds their triangles, until it comes to *stop or is at least `size`
 * bytes on. False when the file does not hold these rows, which is refused. */
bool gi_ply_count_rows(
    const GiPly *ply, int worker, const GiPlyPlace *stop, size_t size, GiPlyPlace *place);

/* Takes the numbers of the rows between two places, which gi_ply_count_rows has found. */
bool gi_ply_read_rows(const GiPly *ply, int worker, const GiPlyPlace *from, const GiPlyPlace *to);
