/* SPDX-License-Identifier: MIT
 * Questions about the library's table of elements that the documentation and the schemas share. */
#pragma once

#include "glint/glint.h"

enum { CLI_IN_SCENE = -1 };

/* Whether what was made for these years belongs to a dialect's scenes; AUTO: to any. */
bool cli_elements_of_year(const char *years, GlintDialect dialect);

static inline bool cli_element_is_object(const GlintElement *element) {
    return element->kind >= GLINT_ELEMENT_SCENE;
}

/* The next type of a kind behind an index (-1: the first), or -1. */
int cli_elements_next_type(GlintElementKind kind, int type);

/* The next element that may stand in a type (CLI_IN_SCENE: the scene) behind an index, or -1. */
int cli_elements_next_child(int type, int element);

/* Whether a type, or the scene, takes any number of an element. */
bool cli_elements_repeats(const GlintElement *element);

/* Writes an example of an element of a type (CLI_IN_SCENE: a whole scene, with this in it); each
 * line begins with `before`. element: the one that is shown; its kind is that of the type. */
void cli_elements_print_example(const char *element, int type, const char *before);
