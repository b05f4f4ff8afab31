/* SPDX-License-Identifier: MIT
 * Whole files: reading one into memory, and replacing one so that it is there in its old or in its
 * new form at any moment. */
#pragma once

#include "watch/bytes.h"

/* Puts the file's bytes into *bytes. False, with errno, when it cannot be read. */
bool cli_file_read(const char *path, CliBytes *bytes);

/* Replaces the file, or makes it. It is written beside the old one and renamed; the old one's
 * permissions are kept, and where a link leads is replaced, not the link. fresh: it must not exist
 * (EEXIST). False, with errno, on any failure; the old file is then as it was. */
bool cli_file_replace(const char *path, const CliBytes *bytes, bool fresh);

/* Writes the text of a scene after its camera was moved: into the scene file itself when that still
 * holds the text that was loaded, else into a new file beside it, a.camera.xml for a.xml (or
 * a.camera-2.xml, ...). Says in message what was done or why not; false: nothing was written. */
bool cli_scene_text_save(const char *path, const CliBytes *loaded, const CliBytes *changed,
    char *message, size_t message_size);
