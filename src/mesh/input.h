/* SPDX-License-Identifier: MIT
 * What the three formats share: the text, its parts for several threads, the words of a line, the
 * first fault, and room in the store. */
#pragma once

#include "base/error.h"
#include "mesh/mesh.h"
#include "port/file.h"
#include "sched/pool.h"

/* ---------------------------------------------------------------- faults */

/* A fault at a place of the text; of several threads' faults the first in the text counts. */
typedef struct GiMeshFinding {
    const char *at; /* null: none */
    char message[256];
} GiMeshFinding;

typedef struct GiMeshInput {
    GiMemory *memory;
    const char *text, *end;
    size_t chunk_size;
    GiPool *pool;
    int worker_count;
    const GlintMonitor *monitor;
    GiMeshFault *fault;
    GiMeshFinding *findings; /* one a worker */
    const GiFileBytes *file; /* that the text is of, or null */
    bool has_lines;          /* false: lines mean nothing to the reader of a message */
    _Atomic int stop;        /* a GlintStatus; parsing ends soon unless it is OK */
} GiMeshInput;

/* Notes a fault unless the worker knows an earlier one. False, so that a parser can return it. */
GI_PRINTF(4, 5)
bool gi_mesh_refuse(GiMeshInput *input, int worker, const char *at, const char *format, ...);

/* Fills *fault, without a line. Returns status. */
GI_PRINTF(3, 4)
GlintStatus gi_mesh_fault(GiMeshFault *fault, GlintStatus status, const char *format, ...);

/* The outcome so far: OK, or what stopped the parsing, with *fault filled. */
GlintStatus gi_mesh_input_status(GiMeshInput *input);

/* ---------------------------------------------------------------- chunks */

/* Asks the monitor; on the caller's thread only. */
bool gi_mesh_is_cancelled(GiMeshInput *input);

/* Calls function for the chunks 0 .. count - 1, on all workers, each claimed in turn; when it
 * returns false, no further chunks are begun. Those before it are completed, so that the first
 * fault of the text is found whatever the number of workers. */
typedef bool (*GiMeshChunkFn)(void *context, size_t chunk, int worker);
void gi_mesh_run(GiMeshInput *input, size_t count, GiMeshChunkFn function, void *context);

/* Where chunks begin, and the end after the last. */
typedef struct GiMeshChunks {
    const char **begin; /* count + 1 */
    size_t count, capacity;
} GiMeshChunks;

/* Cuts [from, end): is_border says whether a chunk may begin at p, where from < p < end. */
GlintStatus gi_mesh_chunks_init(GiMeshChunks *chunks, const GiMeshInput *input, const char *from,
    bool (*is_border)(const GiMeshInput *input, const char *p));
void gi_mesh_chunks_reset(GiMeshChunks *chunks, const GiMeshInput *input);

/* A chunk has been parsed: its bytes need no memory. */
void gi_mesh_forget(const GiMeshInput *input, const char *begin, const char *end);

/* ---------------------------------------------------------------- words */

static inline bool gi_mesh_is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
static inline bool gi_mesh_is_space(char c) { return gi_mesh_is_blank(c) || c == '\n'; }

static inline const char *gi_mesh_word_end(const char *p, const char *end) {
    while (p < end && !gi_mesh_is_space(*p)) p++;
    return p;
}

/* The end of the count-th word from p, which lies between words; null when there are fewer. */
const char *gi_mesh_skip_words(const char *p, const char *end, uint64_t count);

/* A word for a message, printable and cut to fit. */
typedef struct GiMeshQuote {
    char text[44];
} GiMeshQuote;
GiMeshQuote gi_mesh_quote(const char *p, const char *end);

/* Reads a finite number and returns its end, which the caller checks to be the word's. Refuses, and
 * returns null, when there is none. */
const char *gi_mesh_number(
    GiMeshInput *input, int worker, const char *p, const char *end, float *value);

/* Refuses the word at p as something else than a number. */
bool gi_mesh_no_number(GiMeshInput *input, int worker, const char *p, const char *end);

/* ---------------------------------------------------------------- store */

typedef struct GiMeshCounts {
    size_t positions, normals, texcoords, triangles;
} GiMeshCounts;

/* A mesh has at least one triangle. */
GlintStatus gi_mesh_check_triangles(size_t count, GiMeshFault *fault);

/* Where the numbers of a mesh go. Null where there are none. */
typedef struct GiMeshRoom {
    GiFloat3 *positions, *normals;
    GiFloat2 *texcoords;
    GiCorners *corners;
} GiMeshRoom;

/* Makes exactly the room that is needed, behind what the store holds, and fills in where the mesh
 * begins and how much it has. */
GlintStatus gi_mesh_begin(GiMeshStore *store, GiMemory *memory, const GiMeshCounts *counts,
    GiMesh *mesh, GiMeshRoom *room, GiMeshFault *fault);

/* Adds the mesh to what the store holds. Cannot fail. */
uint32_t gi_mesh_end(
    GiMeshStore *store, GiMemory *memory, const GiMeshCounts *counts, const GiMesh *mesh);

/* ---------------------------------------------------------------- formats */

GlintStatus gi_mesh_parse_msh(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh);
GlintStatus gi_mesh_parse_obj(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh);
GlintStatus gi_mesh_parse_ply(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh);
