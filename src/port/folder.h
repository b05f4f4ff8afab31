/* SPDX-License-Identifier: MIT
 * What stands where in the file system, without opening it. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* The same for all names of one file. */
typedef struct GiFileId {
    uint64_t device, number;
} GiFileId;

typedef enum GiFileKind {
    GI_FILE_MISSING,
    GI_FILE_FOLDER,
    GI_FILE_REGULAR,
    GI_FILE_OTHER /* a pipe, a device */
} GiFileKind;

/* What the path names; *id is set unless it is missing. */
GiFileKind gi_file_identify(const char *path, GiFileId *id);

static inline bool gi_file_same(GiFileId a, GiFileId b) {
    return a.device == b.device && a.number == b.number;
}

/* Calls visit for the names in a folder, in no order, until it returns false. Nothing happens when
 * the folder cannot be read. */
void gi_folder_visit(const char *path, bool (*visit)(void *user, const char *name), void *user);
