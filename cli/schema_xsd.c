/* SPDX-License-Identifier: MIT
 * XML Schema 1.0. It cannot let an attribute decide what an element takes, nor have any order and
 * repetition together. So a kind of element takes what any of its types takes, in any order; that
 * it comes once is only said of the kinds that take values alone. */
#include "schema.h"

#include <stdio.h>
#include <string.h>

static void print_help(int depth, const char *help) {
    cli_schema_line(
        depth, "<xs:annotation><xs:documentation>%s</xs:documentation></xs:annotation>", help);
}

/* "surface" of "a surface" */
static const char *noun(GlintElementKind kind) {
    return strchr(glint_element_kind_text(kind), ' ') + 1;
}

/* A value may be empty: it may have a ref instead. */
static void print_value_types(void) {
    const CliSchemaValue *value;
    for (int i = 0; (value = cli_schema_value_at(i)) != NULL; i++) {
        cli_schema_line(1, "<xs:simpleType name=\"text.%s\">", value->name);
        cli_schema_line(2, "<xs:restriction base=\"xs:token\">");
        cli_schema_line(3, "<xs:pattern value=\"(%s)?\"/>", value->pattern);
        cli_schema_line(2, "</xs:restriction>");
        cli_schema_line(1, "</xs:simpleType>");
        cli_schema_line(1, "<xs:complexType name=\"value.%s\">", value->name);
        cli_schema_line(2, "<xs:simpleContent>");
        cli_schema_line(3, "<xs:extension base=\"text.%s\">", value->name);
        cli_schema_line(4, "<xs:attribute name=\"name\" type=\"xs:string\"/>");
        cli_schema_line(4, "<xs:attribute name=\"ref\" type=\"xs:string\"/>");
        cli_schema_line(3, "</xs:extension>");
        cli_schema_line(2, "</xs:simpleContent>");
        cli_schema_line(1, "</xs:complexType>");
    }
}

/* The first type of a kind, or the scene, in which an element stands. */
static bool stands_in_kind(int element, GlintElementKind kind, GlintDialect dialect) {
    if (kind == GLINT_ELEMENT_SCENE) return glint_element_fits(element, CLI_IN_SCENE);
    for (int i = -1; (i = cli_schema_next_type(kind, i, dialect)) >= 0;) {
        if (glint_element_fits(element, i)) return true;
    }
    return false;
}

/* The next element of a kind's types behind an index; one of each name, since those mean the same
 * kind of thing. */
static int next_in_kind(GlintElementKind kind, int element, GlintDialect dialect) {
    GlintElement row, other;
    for (int i = element + 1; glint_element_at(i, &row); i++) {
        if (!cli_elements_of_year(row.years, dialect) || !stands_in_kind(i, kind, dialect))
            continue;
        bool again = false;
        for (int k = 0; k < i && !again; k++) {
            glint_element_at(k, &other);
            again = strcmp(row.name, other.name) == 0 && stands_in_kind(k, kind, dialect) &&
                    cli_elements_of_year(other.years, dialect);
        }
        if (!again) return i;
    }
    return -1;
}

static void print_child(int depth, int index, const char *times) {
    GlintElement child;
    glint_element_at(index, &child);
    bool object = cli_element_is_object(&child);
    cli_schema_line(depth, "<xs:element name=\"%s\" type=\"%s%s\"%s>", child.name,
        object ? "object." : "value.",
        object ? noun(child.kind) : cli_schema_value_of(&child)->name, times);
    print_help(depth + 1, child.help);
    cli_schema_line(depth, "</xs:element>");
}

static void print_children(GlintElementKind kind, GlintDialect dialect) {
    int first = next_in_kind(kind, -1, dialect);
    if (first < 0) return;
    bool values_only = true;
    GlintElement child;
    for (int i = first; i >= 0; i = next_in_kind(kind, i, dialect)) {
        glint_element_at(i, &child);
        values_only = values_only && !cli_element_is_object(&child);
    }
    const char *group = values_only ? "all" : "choice";
    cli_schema_line(
        2, "<xs:%s%s>", group, values_only ? "" : " minOccurs=\"0\" maxOccurs=\"unbounded\"");
    for (int i = first; i >= 0; i = next_in_kind(kind, i, dialect)) {
        print_child(3, i, values_only ? " minOccurs=\"0\"" : "");
    }
    cli_schema_line(2, "</xs:%s>", group);
}

/* The names of a kind's types, with any package before them. */
static void print_type_names(GlintElementKind kind, GlintDialect dialect) {
    GlintElementType type;
    cli_schema_line(1, "<xs:simpleType name=\"type.%s\">", noun(kind));
    cli_schema_line(2, "<xs:union>");
    cli_schema_line(3, "<xs:simpleType>");
    cli_schema_line(4, "<xs:restriction base=\"xs:token\">");
    for (int i = -1; (i = cli_schema_next_type(kind, i, dialect)) >= 0;) {
        glint_element_type_at(i, &type);
        cli_schema_line(5, "<xs:enumeration value=\"%s\">", type.name);
        print_help(6, type.help);
        cli_schema_line(5, "</xs:enumeration>");
    }
    cli_schema_line(4, "</xs:restriction>");
    cli_schema_line(3, "</xs:simpleType>");
    cli_schema_line(3, "<xs:simpleType>");
    cli_schema_line(4, "<xs:restriction base=\"xs:token\">");
    for (int i = -1; (i = cli_schema_next_type(kind, i, dialect)) >= 0;) {
        glint_element_type_at(i, &type);
        cli_schema_line(5, "<xs:pattern value=\".*\\.%s\"/>", type.name);
    }
    cli_schema_line(4, "</xs:restriction>");
    cli_schema_line(3, "</xs:simpleType>");
    cli_schema_line(2, "</xs:union>");
    cli_schema_line(1, "</xs:simpleType>");
}

static void print_object(GlintElementKind kind, GlintDialect dialect) {
    print_type_names(kind, dialect);
    cli_schema_line(1, "<xs:complexType name=\"object.%s\">", noun(kind));
    print_children(kind, dialect);
    cli_schema_line(2, "<xs:attribute name=\"type\" type=\"type.%s\"/>", noun(kind));
    cli_schema_line(2, "<xs:attribute name=\"name\" type=\"xs:string\"/>");
    cli_schema_line(2, "<xs:attribute name=\"ref\" type=\"xs:string\"/>");
    cli_schema_line(1, "</xs:complexType>");
}

static void print_scene(GlintDialect dialect) {
    cli_schema_line(1, "<xs:complexType name=\"object.scene\">");
    print_children(GLINT_ELEMENT_SCENE, dialect);
    cli_schema_line(2, "<xs:attribute name=\"dialect\">");
    cli_schema_line(3, "<xs:simpleType>");
    cli_schema_line(4, "<xs:restriction base=\"xs:token\">");
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        cli_schema_line(5, "<xs:enumeration value=\"%s\"/>", glint_dialect_name((GlintDialect)i));
    }
    cli_schema_line(4, "</xs:restriction>");
    cli_schema_line(3, "</xs:simpleType>");
    cli_schema_line(2, "</xs:attribute>");
    cli_schema_line(2, "<xs:attribute name=\"name\" type=\"xs:string\"/>");
    cli_schema_line(1, "</xs:complexType>");
}

void cli_schema_print_xsd(GlintDialect dialect) {
    puts("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">");
    cli_schema_line(1, "<xs:element name=\"scene\" type=\"object.scene\">");
    print_help(2, "the root element");
    cli_schema_line(1, "</xs:element>");
    print_value_types();
    print_scene(dialect);
    for (int kind = GLINT_ELEMENT_CAMERA; kind <= GLINT_ELEMENT_INTEGRATOR; kind++) {
        bool any = cli_schema_next_type((GlintElementKind)kind, -1, dialect) >= 0;
        if (any) print_object((GlintElementKind)kind, dialect);
    }
    puts("</xs:schema>");
}
