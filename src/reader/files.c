/* SPDX-License-Identifier: MIT */
#include "reader/files.h"

#include "base/digest.h"
#include "port/file.h"
#include "reader/state.h"
#include "reader/suggest.h"

#include <stdio.h>
#include <string.h>

enum { PATH_LIMIT = 8192, FOLDER_LIMIT = 256, VISIT_LIMIT = 10000 };

void gi_files_reset(GiFiles *files, GiMemory *memory) { gi_array_free(memory, &files->loaded); }

/* ---------------------------------------------------------------- names */

const char *gi_file_names_at(const GiFileNames *names, size_t index) {
    return index < names->first.count ? names->text.data + names->first.data[index] : NULL;
}

bool gi_file_names_add(GiFileNames *names, GiMemory *memory, const char *path) {
    for (size_t i = 0; i < names->first.count; i++) {
        if (strcmp(gi_file_names_at(names, i), path) == 0) return true;
    }
    size_t first = names->text.count, size = strlen(path) + 1;
    if (!gi_array_reserve(memory, &names->text, size) ||
        !gi_array_push(memory, &names->first, first)) {
        return false;
    }
    memcpy(names->text.data + first, path, size);
    names->text.count += size;
    return true;
}

void gi_file_names_reset(GiFileNames *names, GiMemory *memory) {
    gi_array_free(memory, &names->text);
    gi_array_free(memory, &names->first);
}

/* ---------------------------------------------------------------- folders
 * A folder is a path without a slash at its end; "" is the current one, "/" the root. */

/* The path up to its last slash. */
static void folder_of(const char *path, char folder[PATH_LIMIT]) {
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : (size_t)(slash - path);
    if (length >= PATH_LIMIT) length = 0;
    while (length > 0 && path[length - 1] == '/') length--;
    memcpy(folder, path, length);
    folder[length] = '\0';
    if (length == 0 && slash != NULL) memcpy(folder, "/", 2);
}

static bool is_root(const char *folder) {
    GiFileId id, root;
    return gi_file_identify(folder[0] != '\0' ? folder : ".", &id) == GI_FILE_FOLDER &&
           gi_file_identify("/", &root) == GI_FILE_FOLDER && gi_file_same(id, root);
}

/* To the folder above; false in the root, which above a relative path is found by asking. */
static bool go_up(char folder[PATH_LIMIT]) {
    size_t length = strlen(folder);
    char *slash = strrchr(folder, '/');
    const char *last = slash != NULL ? slash + 1 : folder;
    bool dots = strcmp(last, "..") == 0 || strcmp(last, ".") == 0;
    if (strcmp(folder, "/") == 0 || (folder[0] != '/' && is_root(folder))) return false;
    if (length == 0) {
        memcpy(folder, "..", 3);
    } else if (dots) {
        if (length + 4 > PATH_LIMIT) return false;
        memcpy(folder + length, "/..", 4);
    } else if (slash == NULL) {
        folder[0] = '\0';
    } else {
        while (slash > folder && slash[-1] == '/') slash--;
        slash[slash == folder] = '\0';
    }
    return true;
}

static bool join(const char *folder, const char *name, char path[PATH_LIMIT]) {
    bool bare = folder[0] == '\0' || strcmp(folder, "/") == 0;
    int length = snprintf(path, PATH_LIMIT, "%s%s%s", folder, bare ? "" : "/", name);
    return length > 0 && length < PATH_LIMIT;
}

/* ---------------------------------------------------------------- finding */

/* The folders in which a relative name is looked for, one after the other. */
typedef struct Search {
    char folder[PATH_LIMIT];
    int count;
    bool current; /* the current folder, which comes last, has been given */
} Search;

static void begin_search(Search *search, const char *scene) {
    folder_of(scene, search->folder);
    search->count = 0;
    search->current = false;
}

static bool next_folder(Search *search) {
    if (search->current) return false;
    if (search->count++ == 0) return true;
    /* Folders that lead round in a circle do not exist, but who knows what a path contains. */
    if (search->count < FOLDER_LIMIT && go_up(search->folder)) return true;
    search->current = true;
    search->folder[0] = '\0';
    return true;
}

static bool is_file(const char *path, GiFileId *id) {
    return gi_file_identify(path, id) >= GI_FILE_REGULAR;
}

static bool find(const char *scene, const char *name, char path[PATH_LIMIT], GiFileId *id) {
    if (name[0] == '/') return join("", name, path) && is_file(path, id);
    Search search;
    for (begin_search(&search, scene); next_folder(&search);) {
        if (join(search.folder, name, path) && is_file(path, id)) return true;
    }
    return false;
}

/* Tells whoever asked where a file that is not there was looked for first. */
static void note_missing(GiReader *reader, const char *name) {
    GiFileNames *names = reader->source->missing_files;
    char folder[PATH_LIMIT], path[PATH_LIMIT];
    folder_of(reader->source->name, folder);
    if (names == NULL || !join(name[0] == '/' ? "" : folder, name, path)) return;
    if (!gi_file_names_add(names, reader->memory, path)) gi_reader_out_of_memory(reader);
}

/* ---------------------------------------------------------------- what is said */

/* The end of a path tells more than its beginning. */
static const char *quote_path(char quote[GI_QUOTE_SIZE], const char *path) {
    enum { SHOWN = 36 };
    size_t length = strlen(path), skip = length > SHOWN ? length - SHOWN : 0;
    if (skip == 0) return gi_quote(quote, path, length);
    while (((unsigned char)path[skip] & 0xc0) == 0x80) skip++;
    char cut[SHOWN + 4];
    snprintf(cut, sizeof cut, "...%s", path + skip);
    return gi_quote(quote, cut, strlen(cut));
}

typedef struct NearMiss {
    GiSuggestion suggestion;
    char best[256];
    int left; /* names still looked at */
} NearMiss;

static bool offer_name(void *user, const char *name) {
    NearMiss *near = user;
    bool same = strcmp(name, near->suggestion.word) == 0; /* a folder, or no use here */
    if (same || name[0] == '.' || strlen(name) >= sizeof near->best) return near->left-- > 0;
    gi_suggestion_offer(&near->suggestion, name);
    if (near->suggestion.best == name) {
        memcpy(near->best, name, strlen(name) + 1);
        near->suggestion.best = near->best;
    }
    return near->left-- > 0;
}

/* A file of nearly that name, in the first folder that has one. */
static bool find_near(const char *scene, const char *name, NearMiss *near) {
    char folder[PATH_LIMIT], inner[PATH_LIMIT];
    const char *slash = strrchr(name, '/'), *last = slash != NULL ? slash + 1 : name;
    folder_of(name, inner);
    *near = (NearMiss){.suggestion = gi_suggestion_begin(last, strlen(last)), .left = VISIT_LIMIT};
    if (name[0] == '/') {
        gi_folder_visit(inner, offer_name, near);
        return near->suggestion.best != NULL;
    }
    Search search;
    for (begin_search(&search, scene); near->suggestion.best == NULL && next_folder(&search);) {
        if (!join(search.folder, inner, folder)) continue;
        gi_folder_visit(folder[0] != '\0' ? folder : ".", offer_name, near);
    }
    return near->suggestion.best != NULL;
}

static void report_missing(GiReader *reader, const char *name, GiPlace place, int length) {
    GiReport *report = &reader->report;
    note_missing(reader, name);
    if (gi_report_is_full(report)) {
        report->error_count++;
        return;
    }
    char quote[GI_QUOTE_SIZE], other[GI_QUOTE_SIZE], folder[PATH_LIMIT];
    NearMiss near;
    quote_path(quote, name);
    if (find_near(reader->source->name, name, &near)) {
        gi_report_add(report, place, length, "there is no file `%s`: did you mean `%s`?", quote,
            gi_quote(other, near.best, strlen(near.best)));
        return;
    }
    if (name[0] == '/') {
        gi_report_add(report, place, length, "there is no file `%s`", quote);
        return;
    }
    folder_of(reader->source->name, folder);
    gi_report_add(report, place, length,
        "there is no file `%s`: neither from %s, nor from a folder above it, nor from the current "
        "folder",
        quote, folder[0] != '\0' ? quote_path(other, folder) : "the scene's folder");
}

/* ---------------------------------------------------------------- loading */

typedef struct Loading {
    GiReader *reader;
    const char *path;
    GiPlace place;
    int length; /* of the name in the scene, in characters */
} Loading;

/* What a loader has to say, told at the place that names the file. line 0: no line. */
static bool report_loader(
    const Loading *loading, GlintStatus status, const char *message, uint64_t line) {
    GiReader *reader = loading->reader;
    char quote[GI_QUOTE_SIZE], at[24] = "";
    if (status == GLINT_OK) return true;
    if (status == GLINT_ERROR_MEMORY) {
        gi_reader_out_of_memory(reader);
    } else if (status == GLINT_CANCELLED || status == GLINT_ERROR_THREAD) {
        reader->file_status = status;
        gi_reader_stop(reader);
    } else {
        if (line > 0) snprintf(at, sizeof at, ":%llu", (unsigned long long)line);
        reader->report.rule = GI_RULE_FILE;
        gi_report_add(&reader->report, loading->place, loading->length, "%s%s: %s",
            quote_path(quote, loading->path), at, message);
        reader->report.rule = GI_RULE_SCENE;
    }
    return false;
}

/* Notes a file among those of the scene, with what its content is before it is loaded. *bytes is
 * then that content, as far as it could be had: a pipe cannot be read twice, and what cannot be
 * read is told by its loader. */
static bool note_file(
    const Loading *loading, GlintFileKind kind, const char *name, GiFileBytes *bytes) {
    GiReader *reader = loading->reader;
    GiSceneFile *file = gi_scene_add_file(reader->scene, kind, name, loading->path);
    *bytes = (GiFileBytes){.bytes = NULL};
    if (file == NULL) {
        gi_reader_out_of_memory(reader);
        return false;
    }
    GiFileId id;
    if (gi_file_identify(loading->path, &id) != GI_FILE_REGULAR) return true;
    if (gi_file_bytes_load(bytes, reader->memory, loading->path, NULL, NULL) != GLINT_OK) {
        return true;
    }
    file->size = bytes->size;
    file->digest = gi_digest(0, bytes->bytes, bytes->size);
    return true;
}

static bool load_mesh(const Loading *loading, const GiFileBytes *bytes, uint32_t *index) {
    GiReader *reader = loading->reader;
    const GiReaderSource *source = reader->source;
    GiMeshFault fault = {0};
    GlintStatus status = gi_mesh_load(&reader->scene->meshes, reader->memory, source->thread_count,
        loading->path, bytes->bytes != NULL ? bytes : NULL, source->monitor, index, &fault);
    return report_loader(loading, status, fault.message, fault.line);
}

static bool load_picture(const Loading *loading, uint32_t *index) {
    GiReader *reader = loading->reader;
    GiPicture picture = {0};
    GlintError error = {0};
    GlintStatus status = gi_picture_load(&picture, reader->memory, loading->path, &error);
    if (!report_loader(loading, status, error.message, 0)) return false;
    *index = (uint32_t)reader->scene->pictures.count;
    if (gi_array_push(reader->memory, &reader->scene->pictures, picture)) return true;
    gi_picture_free(&picture, reader->memory);
    gi_reader_out_of_memory(reader);
    return false;
}

/* What a file is taken for when none is opened. */
static bool add_empty(GiReader *reader, GiKind kind, uint32_t *index) {
    GiScene *scene = reader->scene;
    bool mesh = kind == GI_KIND_SURFACE;
    *index = (uint32_t)(mesh ? scene->meshes.meshes.count : scene->pictures.count);
    bool added = mesh ? gi_array_push(reader->memory, &scene->meshes.meshes, (GiMesh){0})
                      : gi_array_push(reader->memory, &scene->pictures, (GiPicture){0});
    if (!added) gi_reader_out_of_memory(reader);
    return added;
}

static const GiLoadedFile *find_loaded(const GiFiles *files, GiKind kind, GiFileId id) {
    for (size_t i = 0; i < files->loaded.count; i++) {
        const GiLoadedFile *file = &files->loaded.data[i];
        if (file->kind == kind && gi_file_same(file->id, id)) return file;
    }
    return NULL;
}

static bool load_found(
    const Loading *loading, GiKind kind, const char *name, GiFileId id, uint32_t *index) {
    GiReader *reader = loading->reader;
    const GiLoadedFile *known = find_loaded(&reader->files, kind, id);
    if (known != NULL) {
        *index = known->index;
        return !known->broken;
    }
    /* Room first: what is loaded is then known to be. */
    if (!gi_array_reserve(reader->memory, &reader->files.loaded, 1)) {
        gi_reader_out_of_memory(reader);
        return false;
    }
    *index = 0;
    bool mesh = kind == GI_KIND_SURFACE;
    GiFileBytes bytes;
    if (!note_file(loading, mesh ? GLINT_FILE_MESH : GLINT_FILE_TEXTURE, name, &bytes))
        return false;
    if (!mesh) gi_file_bytes_free(&bytes, reader->memory);
    bool good = mesh ? load_mesh(loading, &bytes, index) : load_picture(loading, index);
    gi_file_bytes_free(&bytes, reader->memory);
    reader->files.loaded.data[reader->files.loaded.count++] =
        (GiLoadedFile){id, kind, *index, !good};
    return good;
}

static bool load(GiReader *reader, GiKind kind, GiVec name, GiPlace place, uint32_t *index) {
    GiNamed *entry = &reader->strings.entries.data[(size_t)name.x];
    const char *text = reader->strings.text.data + entry->text;
    if (entry->kind == kind) {
        *index = entry->index;
        return !entry->broken;
    }
    char path[PATH_LIMIT];
    Loading loading = {reader, path, place, (int)name.y};
    GiFileId id;
    bool good;
    if (reader->source->without_files) {
        good = add_empty(reader, kind, index);
    } else if (find(reader->source->name, text, path, &id)) {
        good = load_found(&loading, kind, text, id, index);
    } else {
        reader->report.rule = GI_RULE_FILE;
        report_missing(reader, text, place, (int)name.y);
        reader->report.rule = GI_RULE_SCENE;
        return false; /* and again at its next use, since that is another line to mend */
    }
    entry->kind = (uint8_t)kind;
    entry->index = *index;
    entry->broken = !good;
    return good;
}

bool gi_files_mesh(GiReader *reader, GiVec name, GiPlace place, uint32_t *mesh) {
    return load(reader, GI_KIND_SURFACE, name, place, mesh);
}

bool gi_files_picture(GiReader *reader, GiVec name, GiPlace place, uint32_t *picture) {
    return load(reader, GI_KIND_TEXTURE, name, place, picture);
}

/* A scene keeps the last environment only, so there is one that may be loaded already. */
bool gi_files_environment(GiReader *reader, GiVec name, GiPlace place) {
    GiEnvironment *environment = &reader->scene->environment, loaded = {0};
    const char *text =
        reader->strings.text.data + reader->strings.entries.data[(size_t)name.x].text;
    if (reader->source->without_files) return true;
    char path[PATH_LIMIT];
    GiFileId id;
    if (!find(reader->source->name, text, path, &id)) {
        reader->report.rule = GI_RULE_FILE;
        report_missing(reader, text, place, (int)name.y);
        reader->report.rule = GI_RULE_SCENE;
        return false;
    }
    if (environment->face > 0 && gi_file_same(id, reader->files.environment)) {
        environment->scale = name.z;
        return true;
    }
    Loading loading = {reader, path, place, (int)name.y};
    GiFileBytes bytes;
    if (!note_file(&loading, GLINT_FILE_ENVIRONMENT, text, &bytes)) return false;
    gi_file_bytes_free(&bytes, reader->memory);
    GlintError error = {0};
    GlintStatus status = gi_environment_load(&loaded, reader->memory, path, name.z, &error);
    if (!report_loader(&loading, status, error.message, 0)) return false;
    gi_environment_free(environment, reader->memory);
    *environment = loaded;
    reader->files.environment = id;
    return true;
}
