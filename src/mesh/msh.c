/* SPDX-License-Identifier: MIT
 * The course's own format: words separated by white space. The first pass counts the words of each
 * chunk and notes those that begin with a letter. By these the place of every number is known, so
 * that the second pass parses all chunks at once. */
#include "mesh/input.h"

#include <string.h>

typedef enum SectionKind { VERTICES, TRIANGLES, NORMALS, TEXCOORDS, SECTION_COUNT } SectionKind;

static const struct {
    const char *name;
    int width; /* numbers a row */
} sections[SECTION_COUNT] = {{"vertices", 3}, {"triangles", 3}, {"normals", 3}, {"texcoords", 2}};

typedef struct Keyword {
    size_t index; /* among the words of the file */
    const char *at;
} Keyword;

/* No good file has more than one keyword a section, so further ones need not be known. */
enum { KEYWORD_LIMIT = SECTION_COUNT + 3, HEADER_WORDS = 2 };

typedef struct Words {
    size_t first; /* index of the chunk's first word; while counting: how many it has */
    Keyword keywords[KEYWORD_LIMIT];
    int keyword_count;
} Words;

/* Words [begin, end) are the numbers of a section. */
typedef struct Section {
    SectionKind kind;
    size_t begin, end;
} Section;

typedef struct Msh {
    GiMeshInput *input;
    GiMeshChunks chunks;
    Words *words; /* one a chunk, and one more for the end */
    Keyword keywords[KEYWORD_LIMIT];
    int keyword_count;
    size_t vertex_count, triangle_count;
    Section sections[SECTION_COUNT + 1]; /* in the order of the file; the last is behind its end */
    int section_count;
    float *numbers[SECTION_COUNT]; /* where they go; none for triangles */
    GiCorners *corners;
    uint32_t first_position;
} Msh;

/* ---------------------------------------------------------------- counting */

static bool is_border(const GiMeshInput *input, const char *p) {
    (void)input;
    return gi_mesh_is_space(p[-1]);
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

static const char *skip_space(const char *p, const char *end) {
    while (p < end && gi_mesh_is_space(*p)) p++;
    return p;
}

static bool count_chunk(void *context, size_t chunk, int worker) {
    Msh *msh = context;
    Words *words = &msh->words[chunk];
    const char *begin = msh->chunks.begin[chunk], *end = msh->chunks.begin[chunk + 1];
    *words = (Words){0};
    for (const char *p = begin; (p = skip_space(p, end)) < end; words->first++) {
        if (is_letter(*p) && words->keyword_count < KEYWORD_LIMIT) {
            words->keywords[words->keyword_count++] = (Keyword){words->first, p};
        }
        p = gi_mesh_word_end(p, end);
    }
    gi_mesh_forget(msh->input, begin, end);
    (void)worker;
    return true;
}

/* From counts to indices, and from the keywords of chunks to those of the file. */
static void add_up(Msh *msh) {
    size_t sum = 0;
    for (size_t i = 0; i < msh->chunks.count; i++) {
        Words *words = &msh->words[i];
        for (int k = 0; k < words->keyword_count && msh->keyword_count < KEYWORD_LIMIT; k++) {
            Keyword keyword = words->keywords[k];
            keyword.index += sum;
            if (keyword.index >= HEADER_WORDS) msh->keywords[msh->keyword_count++] = keyword;
        }
        size_t count = words->first;
        words->first = sum;
        sum += count;
    }
    msh->words[msh->chunks.count].first = sum;
}

/* ---------------------------------------------------------------- the plan */

/* The word of that index, or the end of the text. */
static const char *find_word(const Msh *msh, size_t index) {
    size_t chunk = 0;
    while (chunk < msh->chunks.count && msh->words[chunk + 1].first <= index) chunk++;
    const char *end = msh->input->end, *p = skip_space(msh->chunks.begin[chunk], end);
    for (size_t i = msh->words[chunk].first; i < index && p < end; i++) {
        p = skip_space(gi_mesh_word_end(p, end), end);
    }
    return p;
}

/* A whole number without a sign; what is too large for any file is cut. False when it is none. */
static bool read_count(const char *p, const char *end, size_t *value) {
    const char *first = p;
    size_t count = 0;
    for (; p < end && (unsigned char)(*p - '0') <= 9; p++) {
        if (count < SIZE_MAX / 1000) count = count * 10 + (size_t)(*p - '0');
    }
    *value = count;
    return p > first && (p == end || gi_mesh_is_space(*p));
}

static bool read_header(Msh *msh) {
    static const char *const names[HEADER_WORDS] = {"vertices", "triangles"};
    size_t *const counts[HEADER_WORDS] = {&msh->vertex_count, &msh->triangle_count};
    const char *end = msh->input->end;
    for (int i = 0; i < HEADER_WORDS; i++) {
        const char *word = find_word(msh, (size_t)i);
        if (read_count(word, end, counts[i])) continue;
        if (word == end) {
            return gi_mesh_refuse(
                msh->input, 0, end, "the file ends before the number of %s", names[i]);
        }
        return gi_mesh_refuse(msh->input, 0, word, "expected the number of %s, found \"%s\"",
            names[i], gi_mesh_quote(word, end).text);
    }
    return true;
}

static SectionKind find_section(const char *p, const char *end) {
    size_t length = (size_t)(gi_mesh_word_end(p, end) - p);
    int kind = 0;
    while (kind < SECTION_COUNT &&
           (strlen(sections[kind].name) != length || memcmp(sections[kind].name, p, length) != 0)) {
        kind++;
    }
    return (SectionKind)kind;
}

/* A section has `found` numbers and should have more; `at` is what follows. */
static bool refuse_short(Msh *msh, SectionKind kind, size_t found, size_t wanted, const char *at) {
    const char *end = msh->input->end;
    if (at < end && find_section(at, end) == SECTION_COUNT) {
        return gi_mesh_no_number(msh->input, 0, at, end);
    }
    return gi_mesh_refuse(msh->input, 0, at, "%s ends after %zu of the %zu numbers of \"%s\"",
        at < end ? "the section" : "the file", found, wanted, sections[kind].name);
}

/* Finds the sections and checks that the file holds them and nothing else. */
static bool plan(Msh *msh) {
    const char *end = msh->input->end;
    size_t next = HEADER_WORDS, total = msh->words[msh->chunks.count].first;
    bool seen[SECTION_COUNT] = {false};
    for (int i = 0; next < total; i++) {
        const Keyword *keyword = &msh->keywords[i];
        if (i == msh->keyword_count || keyword->index > next) {
            const char *word = find_word(msh, next);
            return gi_mesh_refuse(msh->input, 0, word, "expected a keyword, found \"%s\"",
                gi_mesh_quote(word, end).text);
        }
        SectionKind kind = find_section(keyword->at, end);
        if (kind == SECTION_COUNT || seen[kind]) {
            return gi_mesh_refuse(msh->input, 0, keyword->at,
                kind == SECTION_COUNT ? "unknown keyword \"%s\"" : "a second section \"%s\"",
                gi_mesh_quote(keyword->at, end).text);
        }
        seen[kind] = true;
        size_t row_count = kind == TRIANGLES ? msh->triangle_count : msh->vertex_count;
        size_t wanted = row_count * (size_t)sections[kind].width;
        bool is_last = i + 1 == msh->keyword_count;
        size_t found = (is_last ? total : keyword[1].index) - keyword->index - 1;
        if (found < wanted) {
            return refuse_short(msh, kind, found, wanted, is_last ? end : keyword[1].at);
        }
        next += 1 + wanted;
        msh->sections[msh->section_count++] =
            (Section){kind, keyword->index + 1, keyword->index + 1 + wanted};
    }
    msh->sections[msh->section_count] = (Section){VERTICES, SIZE_MAX, SIZE_MAX};
    for (int kind = VERTICES; kind <= TRIANGLES; kind++) {
        if (seen[kind]) continue;
        return gi_mesh_refuse(
            msh->input, 0, end, "there is no section \"%s\"", sections[kind].name);
    }
    return true;
}

static bool has_section(const Msh *msh, SectionKind kind) {
    for (int i = 0; i < msh->section_count; i++) {
        if (msh->sections[i].kind == kind) return true;
    }
    return false;
}

/* ---------------------------------------------------------------- parsing */

/* Reads the word at p as number `place` of a section; its end, or null. */
static const char *read_number(
    Msh *msh, int worker, SectionKind kind, size_t place, const char *p, const char *end) {
    if (kind != TRIANGLES) {
        p = gi_mesh_number(msh->input, worker, p, end, &msh->numbers[kind][place]);
        return p;
    }
    size_t vertex;
    if (!read_count(p, end, &vertex)) {
        gi_mesh_refuse(msh->input, worker, p, "expected a vertex index, found \"%s\"",
            gi_mesh_quote(p, end).text);
        return NULL;
    }
    if (vertex >= msh->vertex_count) {
        gi_mesh_refuse(msh->input, worker, p,
            "triangle %zu names vertex %s, but the last of %zu is %zu", place / 3,
            gi_mesh_quote(p, end).text, msh->vertex_count, msh->vertex_count - 1);
        return NULL;
    }
    msh->corners[place / 3][place % 3] = msh->first_position + (uint32_t)vertex;
    return gi_mesh_word_end(p, end);
}

static bool parse_chunk(void *context, size_t chunk, int worker) {
    Msh *msh = context;
    const char *p = msh->chunks.begin[chunk], *end = msh->chunks.begin[chunk + 1];
    size_t index = msh->words[chunk].first, limit = msh->words[chunk + 1].first;
    const Section *section = msh->sections;
    for (; (p = skip_space(p, end)) < end && index < limit; index++) {
        while (index >= section->end) section++;
        if (index < section->begin) {
            p = gi_mesh_word_end(p, end);
            continue;
        }
        const char *word = p;
        p = read_number(msh, worker, section->kind, index - section->begin, p, end);
        if (p == NULL) return false;
        if (p < end && !gi_mesh_is_space(*p)) {
            return gi_mesh_no_number(msh->input, worker, word, end);
        }
    }
    gi_mesh_forget(msh->input, msh->chunks.begin[chunk], end);
    /* Both passes count alike, unless another program writes to the file meanwhile. */
    return (p == end && index == limit) ||
           gi_mesh_refuse(msh->input, worker, p, "the file changed while it was read");
}

static GlintStatus build(Msh *msh, GiMeshStore *store, uint32_t *index) {
    GiMeshInput *input = msh->input;
    bool smooth = has_section(msh, NORMALS), textured = has_section(msh, TEXCOORDS);
    GiMeshCounts counts = {msh->vertex_count, smooth ? msh->vertex_count : 0,
        textured ? msh->vertex_count : 0, msh->triangle_count};
    GiMesh mesh;
    GiMeshRoom room;
    GlintStatus status = gi_mesh_check_triangles(counts.triangles, input->fault);
    if (status == GLINT_OK) {
        status = gi_mesh_begin(store, input->memory, &counts, &mesh, &room, input->fault);
    }
    if (status != GLINT_OK) return status;
    mesh.smooth = smooth;
    mesh.textured = textured;
    msh->numbers[VERTICES] = (float *)room.positions;
    msh->numbers[NORMALS] = (float *)room.normals;
    msh->numbers[TEXCOORDS] = (float *)room.texcoords;
    msh->corners = room.corners;
    msh->first_position = mesh.first_position;
    gi_mesh_run(input, msh->chunks.count, parse_chunk, msh);
    status = gi_mesh_input_status(input);
    if (status == GLINT_OK) *index = gi_mesh_end(store, input->memory, &counts, &mesh);
    return status;
}

GlintStatus gi_mesh_parse_msh(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh) {
    Msh msh = {.input = input};
    GlintStatus status = gi_mesh_chunks_init(&msh.chunks, input, input->text, is_border);
    if (status != GLINT_OK) return status;
    size_t size = (msh.chunks.count + 1) * sizeof *msh.words;
    msh.words = gi_memory_allocate(input->memory, size);
    if (msh.words == NULL) {
        status = gi_mesh_fault(input->fault, GLINT_ERROR_MEMORY, "not enough memory");
    } else {
        gi_mesh_run(input, msh.chunks.count, count_chunk, &msh);
        status = gi_mesh_input_status(input);
        if (status == GLINT_OK) {
            add_up(&msh);
            if (!read_header(&msh) || !plan(&msh)) status = gi_mesh_input_status(input);
        }
        if (status == GLINT_OK) status = build(&msh, store, mesh);
    }
    gi_memory_free(input->memory, msh.words, size);
    gi_mesh_chunks_reset(&msh.chunks, input);
    return status;
}
