/* SPDX-License-Identifier: MIT
 * Schemas of scenes, made from the library's table of elements. They know the documented spelling
 * of names only, and say what can be said of text: docs/format-tools.md has what they leave out. */
#pragma once

#include "elements.h"

/* On standard output. dialect AUTO: of all years. */
void cli_schema_print_rng(GlintDialect dialect);
void cli_schema_print_xsd(GlintDialect dialect);

/* ---- schema_values.c: what both have in common */

/* A kind of value with its range, as a pattern for white space that is collapsed. */
typedef struct CliSchemaValue {
    const char *name;
    GlintElementKind kind;
    GlintElementRange range;
    const char *pattern;
} CliSchemaValue;

/* Null behind the last. */
const CliSchemaValue *cli_schema_value_at(int index);
const CliSchemaValue *cli_schema_value_of(const GlintElement *element);

/* A line, indented: printf behind two blanks a level. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void cli_schema_line(int depth, const char *format, ...);

/* The next type or child that belongs to a dialect, as cli_elements_next_type and -child. */
int cli_schema_next_type(GlintElementKind kind, int type, GlintDialect dialect);
int cli_schema_next_child(int type, int element, GlintDialect dialect);
