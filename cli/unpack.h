/* SPDX-License-Identifier: MIT
 * The scene inside a picture that was drawn with --embed, put into a temporary folder in which its
 * files are found under the names that the scene has for them. */
#pragma once

#include "glint/glint.h"

#include "status.h"

typedef struct CliUnpacked {
    char *folder; /* null: nothing is unpacked */
    char *scene;  /* path of the scene file in it */
} CliUnpacked;

/* Whether a file begins like a PNG. */
bool cli_unpack_is_picture(const char *path);

/* Whether the scene's content is in the recipe. */
bool cli_unpack_is_embedded(const GlintRecipe *recipe);

/* A name under which no file can be unpacked, since it is absolute; null: all can be. */
const char *cli_unpack_bad_name(const GlintRecipe *recipe);

/* Writes the embedded files of a recipe; picture is its name in messages. Says what is wrong. */
CliStatus cli_unpack(CliUnpacked *unpacked, const GlintRecipe *recipe, const char *picture);

/* Removes the folder and all that is in it. */
void cli_unpack_remove(CliUnpacked *unpacked);
