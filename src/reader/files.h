/* SPDX-License-Identifier: MIT
 * The files that a scene names: where they are looked for (docs/scene-format.md, 1.3), and that
 * each is loaded once, however often and by whatever path it is named. */
#pragma once

#include "base/array.h"
#include "math/vec.h"
#include "port/folder.h"
#include "reader/element.h"
#include "reader/window.h"

typedef struct GiLoadedFile {
    GiFileId id;
    GiKind kind;    /* SURFACE: a mesh; TEXTURE: a picture */
    uint32_t index; /* of the scene's meshes or pictures */
    bool broken;    /* what is wrong with it has been said */
} GiLoadedFile;

typedef struct GiFiles {
    GI_ARRAY(GiLoadedFile) loaded;
    GiFileId environment; /* the file of the scene's environment, when it has one */
} GiFiles;

/* The paths of files, one after the other. All zero is an empty list. */
typedef struct GiFileNames {
    GI_ARRAY(char) text; /* each with its zero */
    GI_ARRAY(size_t) first;
} GiFileNames;

/* Adds a path unless it is there already. False when memory is short. */
bool gi_file_names_add(GiFileNames *names, GiMemory *memory, const char *path);
/* Null behind the last. */
const char *gi_file_names_at(const GiFileNames *names, size_t index);
void gi_file_names_reset(GiFileNames *names, GiMemory *memory);

struct GiReader;

void gi_files_reset(GiFiles *files, GiMemory *memory);

/* Each takes a file's name (the value of a string element) and the place of that value. False, with
 * the error reported, when the file cannot be found or loaded. */
bool gi_files_mesh(struct GiReader *reader, GiVec name, GiPlace place, uint32_t *mesh);
bool gi_files_picture(struct GiReader *reader, GiVec name, GiPlace place, uint32_t *picture);
/* Takes the place of the scene's environment; name.z is the factor. */
bool gi_files_environment(struct GiReader *reader, GiVec name, GiPlace place);
