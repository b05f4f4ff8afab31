/* SPDX-License-Identifier: MIT
 * Numbers as the reader takes them: 2, .5, 1., 1e-3, +2. XML Schema's own types would let in INF
 * and NaN and, depending on the checker, refuse "1.". */
#include "schema.h"

#include <stdarg.h>
#include <stdio.h>

#define EXPONENT "([eE][+\\-]?[0-9]+)?"
#define NUMBER   "[+\\-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)" EXPONENT
/* Digits of which one is not zero. */
#define SOME     "([0-9]*[1-9][0-9]*\\.?[0-9]*|[0-9]*\\.[0-9]*[1-9][0-9]*)" EXPONENT
#define NOT_ZERO "[+\\-]?" SOME
#define COUNT    "\\+?0*[1-9][0-9]*"

static const CliSchemaValue values[] = {
    {"number", GLINT_ELEMENT_NUMBER, GLINT_RANGE_ANY, NUMBER},
    {"number.positive", GLINT_ELEMENT_NUMBER, GLINT_RANGE_POSITIVE, "\\+?" SOME},
    {"number.angle", GLINT_ELEMENT_NUMBER, GLINT_RANGE_ANGLE, "\\+?" SOME},
    {"whole.samples", GLINT_ELEMENT_WHOLE_NUMBER, GLINT_RANGE_SAMPLES, "\\+?0*[0-9]{1,5}"},
    {"whole.bit", GLINT_ELEMENT_WHOLE_NUMBER, GLINT_RANGE_BIT, "\\+?0*[01]"},
    {"whole.depth", GLINT_ELEMENT_WHOLE_NUMBER, GLINT_RANGE_DEPTH, "\\+?0*[1-9][0-9]{0,3}"},
    {"size", GLINT_ELEMENT_IMAGE_SIZE, GLINT_RANGE_PIXELS, COUNT " " COUNT},
    {"vector", GLINT_ELEMENT_VECTOR, GLINT_RANGE_ANY, NUMBER " " NUMBER " " NUMBER},
    {"vector.long", GLINT_ELEMENT_VECTOR, GLINT_RANGE_NOT_ZERO,
        "(" NOT_ZERO " " NUMBER " " NUMBER "|" NUMBER " " NOT_ZERO " " NUMBER "|" NUMBER " " NUMBER
        " " NOT_ZERO ")"},
    {"vector.full", GLINT_ELEMENT_VECTOR, GLINT_RANGE_NO_ZEROS, NOT_ZERO " " NOT_ZERO " " NOT_ZERO},
    {"point", GLINT_ELEMENT_POINT, GLINT_RANGE_ANY, NUMBER " " NUMBER " " NUMBER},
    {"colour", GLINT_ELEMENT_COLOR, GLINT_RANGE_ANY, NUMBER " " NUMBER " " NUMBER},
    {"falloff", GLINT_ELEMENT_WORD, GLINT_RANGE_ANY, "none|inverse-square"},
    {"text", GLINT_ELEMENT_TEXT, GLINT_RANGE_ANY, ".+"},
};

const CliSchemaValue *cli_schema_value_at(int index) {
    return index < (int)(sizeof values / sizeof *values) ? &values[index] : NULL;
}

const CliSchemaValue *cli_schema_value_of(const GlintElement *element) {
    const CliSchemaValue *value;
    for (int i = 0; (value = cli_schema_value_at(i)) != NULL; i++) {
        if (value->kind == element->kind && value->range == element->range) return value;
    }
    return NULL;
}

void cli_schema_line(int depth, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    printf("%*s", 2 * depth, "");
    vprintf(format, arguments);
    putchar('\n');
    va_end(arguments);
}

int cli_schema_next_type(GlintElementKind kind, int type, GlintDialect dialect) {
    GlintElementType row;
    while ((type = cli_elements_next_type(kind, type)) >= 0) {
        glint_element_type_at(type, &row);
        if (cli_elements_of_year(row.years, dialect)) break;
    }
    return type;
}

int cli_schema_next_child(int type, int element, GlintDialect dialect) {
    GlintElement row;
    while ((element = cli_elements_next_child(type, element)) >= 0) {
        glint_element_at(element, &row);
        if (cli_elements_of_year(row.years, dialect)) break;
    }
    return element;
}
