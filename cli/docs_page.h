/* SPDX-License-Identifier: MIT
 * What there is to say about elements and types, for the screen or as Markdown. */
#pragma once

#include "glint/glint.h"

/* A list of all elements and types. */
void cli_docs_print_list(void);

/* One element: every place where it may stand. */
void cli_docs_print_element(const char *name, bool markdown);

/* One type; CLI_IN_SCENE: the scene. */
void cli_docs_print_type(int type, bool markdown);

/* The whole reference, docs/elements.md. */
void cli_docs_print_reference(void);
