/* SPDX-License-Identifier: MIT
 * The scenes of the bench: samples by name, and their files in a cache folder. */
#pragma once

#include "samples/sample.h"

#include <stdbool.h>
#include <stdint.h>

enum { PATH_SIZE = 4096, SCENE_MAX = 32 };

typedef enum SceneFormat { FORMAT_XML, FORMAT_TACHYON, FORMAT_POVRAY, FORMAT_COUNT } SceneFormat;

typedef struct BenchScene {
    char name[32]; /* "spheres-100k" */
    Sample sample;
} BenchScene;

/* Comma-separated names KIND-COUNT, where COUNT may end with k or m; "tiny" has none. Every size
 * of a picture is edge x edge, but the tiny scene's is 300 x 300. Returns how many; a name that
 * says nothing ends the program. */
int scenes_parse(const char *names, int edge, BenchScene scenes[SCENE_MAX]);

/* Whether a sample can be told in the format. */
bool scenes_has(const BenchScene *scene, SceneFormat format);

/* The path in the folder cache, and the file too, with the one that it names: they are written when
 * there are none. */
void scenes_file(
    const BenchScene *scene, SceneFormat format, const char *cache, char path[PATH_SIZE]);

/* Bytes of the mesh that the XML file names; 0: none. */
uint64_t scenes_mesh_size(const BenchScene *scene, const char *cache);
