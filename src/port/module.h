/* SPDX-License-Identifier: MIT
 * Modules: parts of the library that need another library, in shared objects of their own. They are
 * loaded when first needed, so a program that does not need them starts without them, and a machine
 * that lacks the other library does without them only.
 *
 * A module is looked for beside the file that this code is in (the program, or libglint): where it
 * is built, where it is installed, and at last in the folder of the installation that the build was
 * prepared for. The environment has no say. */
#pragma once

#include "glint/glint.h"

typedef struct GiModule {
    void *handle;
    const void *interface; /* the struct that the module exports */
} GiModule;

/* Loads module `name` ("png" is the file glint-png.so) and finds the struct it exports as symbol.
 * purpose completes "Glint cannot ..." when the module is missing. Errors: FILE, with a sentence
 * and no path. */
GlintStatus gi_module_open(
    GiModule *module, const char *name, const char *symbol, const char *purpose, GlintError *error);

void gi_module_close(GiModule *module);
