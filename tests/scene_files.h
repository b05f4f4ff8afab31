/* SPDX-License-Identifier: MIT
 * All scene files that there are: scenes/, tests/golden, the fuzzer's corpus, and the course's
 * where these are at hand. */
#pragma once

#include "scenes.h"

typedef struct SceneFile {
    char path[1200];
    char *bytes; /* with a zero behind the last */
    size_t size;
} SceneFile;

/* Calls back for every *.xml in a folder of the sources and those below it, in the order of their
 * names, or of ../shared when `shared`. Returns how many there were. */
int each_scene_file(
    const char *folder, bool shared, void (*visit)(const SceneFile *file, void *user), void *user);

/* A picture of a scene text as if it stood at path, small and with one sample a pixel; no pixels
 * when it cannot be drawn, which is not a failure. */
Picture small_picture(
    const char *text, size_t size, const char *path, GlintDialect dialect, GlintDialect *in_force);

/* A growing text; a GlintSinkFn, whose user is the Text. */
typedef struct Text {
    char *bytes; /* from malloc; with a zero behind the last */
    size_t size;
} Text;
bool collect_text(void *text, const void *bytes, size_t size);
