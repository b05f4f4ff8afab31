/* SPDX-License-Identifier: MIT
 * Files: the only place where the system's file calls appear.
 *
 * Writing is whole or not at all. Bytes go to a file without a name in the target's folder; commit
 * gives it the name in one rename. Until then an old file of that name stays as it is, and a
 * process that dies leaves nothing behind. What is not a regular file (a pipe, /dev/null,
 * /dev/stdout) is written directly, since it cannot be replaced. */
#pragma once

#include "base/memory.h"

typedef struct GiFileWriter {
    const char *path; /* as the caller gave it, for messages; must outlive the writer */
    int fd;
    int folder;         /* of the target, links followed; -1 when the target is written directly */
    int error;          /* errno of the first failure, which is the one that is reported; 0: none */
    char name[256];     /* of the target, in its folder */
    char temporary[64]; /* in the same folder; empty while the file has no name */
} GiFileWriter;

/* Prepares to write path. A new file gets the usual permissions (0666 less the umask); a file that
 * is replaced keeps its own; a symbolic link is kept and what it points at is replaced. After
 * GLINT_ERROR_FILE there is nothing to undo; after GLINT_OK commit or abandon must follow. */
GlintStatus gi_file_write_begin(GiFileWriter *writer, const char *path, GlintError *error);

/* The same where nothing shows before commit, not even when the process dies meanwhile, so that
 * the file may be written for a long time. False: it cannot be done here, or at all, and there is
 * nothing to undo. */
bool gi_file_write_begin_hidden(GiFileWriter *writer, const char *path);

/* Appends. False after a failure, which commit reports. A GlintSinkFn, whose user is the
 * GiFileWriter. */
bool gi_file_write(void *writer, const void *bytes, size_t size);

/* Writes at a place of the file, for formats that do not come in order; not to be mixed with the
 * above. False after a failure, as above, and where there are no places (a pipe). */
bool gi_file_write_at(GiFileWriter *writer, const void *bytes, size_t size, uint64_t offset);

/* Puts the file in its place and ends the writer. On any failure, also an earlier one of
 * gi_file_write, nothing is left and *error tells it: GLINT_ERROR_FILE. */
GlintStatus gi_file_write_commit(GiFileWriter *writer, GlintError *error);

/* Ends the writer and leaves nothing (but what went to a pipe or device already). */
void gi_file_write_abandon(GiFileWriter *writer);

typedef struct GiFileReader {
    const char *path; /* as above */
    int fd;
    int error;
    int64_t size; /* bytes; -1 when it is not a regular file and the end is not known */
    const GlintMonitor *monitor; /* may be set after opening; null: none */
} GiFileReader;

/* Opens path for reading from its beginning. A folder is refused. Errors: FILE; there is nothing
 * to close then. */
GlintStatus gi_file_read_open(GiFileReader *reader, const char *path, GlintError *error);

/* At most size bytes, as many as there are at once; 0 at the end, negative on failure, or when a
 * signal comes while it waits and the monitor has been cancelled. A GlintReadFn, whose user is the
 * GiFileReader. */
int64_t gi_file_read(void *reader, void *buffer, size_t size);

/* GLINT_OK, or GLINT_ERROR_FILE and the reason when gi_file_read has failed. */
GlintStatus gi_file_read_status(const GiFileReader *reader, GlintError *error);

void gi_file_read_close(GiFileReader *reader);

/* The bytes of a whole file. What is mapped is read when it is touched, and only what was not
 * forgotten counts as memory in use. A file that another program cuts short meanwhile ends the
 * process, as with all mapped files. */
typedef struct GiFileBytes {
    const char *bytes;
    size_t size;
    size_t capacity; /* of an allocated copy; 0 when the file is mapped */
    size_t mapped;   /* bytes that are mapped */
} GiFileBytes;

/* Maps the file, or reads it where that cannot be done (a pipe). monitor may be null. Errors:
 * FILE, MEMORY, CANCELLED; there is nothing to release then. */
GlintStatus gi_file_bytes_load(GiFileBytes *file, GiMemory *memory, const char *path,
    const GlintMonitor *monitor, GlintError *error);

/* Maps the file that a reader has open, with a zero behind its last byte. False, and nothing has
 * happened, where that cannot be done. */
bool gi_file_bytes_map(GiFileBytes *file, const GiFileReader *reader);

/* The bytes [begin, end) are not needed soon; they stay readable. */
void gi_file_bytes_forget(const GiFileBytes *file, size_t begin, size_t end);

void gi_file_bytes_free(GiFileBytes *file, GiMemory *memory);
