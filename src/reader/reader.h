/* SPDX-License-Identifier: MIT
 * From XML to the model, in one pass over a stream. */
#pragma once

#include "port/file.h"
#include "reader/files.h"
#include "reader/source.h"
#include "scene/scene.h"

typedef struct GiReaderSource {
    GlintReadFn read;
    void *user;
    const GiFileBytes *mapped;    /* null; or the whole file, a zero behind it: nothing is read
                                     then, and no source may be kept */
    const char *name;             /* for messages; files that the scene names are looked for from
                                     the folder of this path */
    int64_t total_size;           /* bytes, for progress; -1: not known */
    const GlintMonitor *monitor;  /* null: none */
    GlintDiagnosticFn diagnostic; /* null: none */
    void *diagnostic_user;
    GlintDialect dialect;       /* AUTO: what the file says or shows */
    size_t chunk_size;          /* bytes handed to the parser at once; 0: a good size */
    int thread_count;           /* for scanning and for loading meshes; 0: one per core */
    bool without_files;         /* other files are not opened: each counts as found and empty */
    GiSources *sources;         /* null; or filled with what is known of the places of objects */
    GiFileNames *missing_files; /* null; or filled with those that are not found */
    bool expat_only; /* the scanner is not used, which must make no difference but in time */
} GiReaderSource;

typedef struct GiReaderResult {
    int64_t byte_count; /* read from the source */
} GiReaderResult;

/* Fills an empty scene. All memory, that of the scene and that of reading, comes from
 * scene->memory; only the scene's is still in use afterwards. Errors:
 *   SCENE      the file has errors: all are given to the diagnostic callback (on this thread, after
 *              reading, in the order of the file), the first in *error
 *   FILE       read failed
 *   MEMORY, CANCELLED
 * After an error the scene holds a part of the file and can only be reset. All of the source's
 * functions are called on this thread. Nothing but the time depends on thread_count. */
GlintStatus gi_reader_load(
    GiScene *scene, const GiReaderSource *source, GiReaderResult *result, GlintError *error);
