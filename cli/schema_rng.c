/* SPDX-License-Identifier: MIT
 * RELAX NG (OASIS 2001), in XML: a pattern for each row of the table and each type. The type
 * attribute decides what an element takes, and the order of children is free. What the reader lets
 * the last of several win is allowed once only: a second one is a slip. */
#include "schema.h"

#include <stdio.h>
#include <string.h>

static void print_help(int depth, const char *help) {
    cli_schema_line(depth, "<a:documentation>%s</a:documentation>", help);
}

static void print_head(void) {
    puts("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<grammar xmlns=\"http://relaxng.org/ns/structure/1.0\"\n"
         "    xmlns:a=\"http://relaxng.org/ns/compatibility/annotations/1.0\"\n"
         "    datatypeLibrary=\"http://www.w3.org/2001/XMLSchema-datatypes\">\n"
         "  <start><ref name=\"element.0\"/></start>\n"
         "  <define name=\"name\">\n"
         "    <optional>\n"
         "      <attribute name=\"name\">\n"
         "        <a:documentation>to be referred to by ref, further down</a:documentation>\n"
         "      </attribute>\n"
         "    </optional>\n"
         "  </define>\n"
         "  <define name=\"ref\">\n"
         "    <attribute name=\"ref\">\n"
         "      <a:documentation>the name of what stands here; all else is ignored"
         "</a:documentation>\n"
         "    </attribute>\n"
         "    <ref name=\"name\"/>\n"
         "    <ref name=\"anything\"/>\n"
         "  </define>\n"
         "  <define name=\"anything\">\n"
         "    <zeroOrMore>\n"
         "      <choice>\n"
         "        <text/>\n"
         "        <element>\n"
         "          <anyName/>\n"
         "          <zeroOrMore><attribute><anyName/></attribute></zeroOrMore>\n"
         "          <ref name=\"anything\"/>\n"
         "        </element>\n"
         "      </choice>\n"
         "    </zeroOrMore>\n"
         "  </define>");
    const CliSchemaValue *value;
    for (int i = 0; (value = cli_schema_value_at(i)) != NULL; i++) {
        if (value->kind == GLINT_ELEMENT_WORD) continue;
        cli_schema_line(1, "<define name=\"value.%s\">", value->name);
        cli_schema_line(
            2, "<data type=\"token\"><param name=\"pattern\">%s</param></data>", value->pattern);
        cli_schema_line(1, "</define>");
    }
}

static void print_child(int depth, int index, int type) {
    GlintElement child;
    glint_element_at(index, &child);
    bool in_scene = type == CLI_IN_SCENE;
    bool once = in_scene ? child.kind == GLINT_ELEMENT_CAMERA : child.required;
    const char *times =
        cli_elements_repeats(&child) ? (once ? "oneOrMore" : "zeroOrMore") : "optional";
    if (once && !cli_elements_repeats(&child)) {
        cli_schema_line(depth, "<ref name=\"element.%d\"/>", index);
    } else {
        cli_schema_line(depth, "<%s><ref name=\"element.%d\"/></%s>", times, index, times);
    }
}

static void print_children(int depth, int type, GlintDialect dialect) {
    int first = cli_schema_next_child(type, -1, dialect);
    if (first < 0) {
        cli_schema_line(depth, "<empty/>");
        return;
    }
    if (cli_schema_next_child(type, first, dialect) < 0) {
        /* libxml2 2.9 fails on an interleave of one. */
        print_child(depth, first, type);
        return;
    }
    cli_schema_line(depth, "<interleave>");
    for (int i = first; i >= 0; i = cli_schema_next_child(type, i, dialect)) {
        print_child(depth + 1, i, type);
    }
    cli_schema_line(depth, "</interleave>");
}

/* A type twice: with its attribute, and its content alone, for where it is meant without one. */
static void print_type(int index, GlintDialect dialect) {
    GlintElementType type;
    glint_element_type_at(index, &type);
    cli_schema_line(1, "<define name=\"type.%s\">", type.name);
    cli_schema_line(2, "<attribute name=\"type\">");
    print_help(3, type.help);
    cli_schema_line(3, "<choice>");
    cli_schema_line(4, "<value>%s</value>", type.name);
    cli_schema_line(
        4, "<data type=\"token\"><param name=\"pattern\">.*\\.%s</param></data>", type.name);
    cli_schema_line(3, "</choice>");
    cli_schema_line(2, "</attribute>");
    cli_schema_line(2, "<ref name=\"content.%s\"/>", type.name);
    cli_schema_line(1, "</define>");
    cli_schema_line(1, "<define name=\"content.%s\">", type.name);
    cli_schema_line(2, "<ref name=\"name\"/>");
    print_children(2, index, dialect);
    cli_schema_line(1, "</define>");
}

static void print_scene(GlintDialect dialect) {
    cli_schema_line(3, "<optional>");
    cli_schema_line(4, "<attribute name=\"dialect\">");
    print_help(5, "the year whose rules hold; glint: none's, for new scenes");
    cli_schema_line(5, "<choice>");
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        cli_schema_line(6, "<value>%s</value>", glint_dialect_name((GlintDialect)i));
    }
    cli_schema_line(5, "</choice>");
    cli_schema_line(4, "</attribute>");
    cli_schema_line(3, "</optional>");
    cli_schema_line(3, "<ref name=\"name\"/>");
    print_children(3, CLI_IN_SCENE, dialect);
}

static void print_object(const GlintElement *element, GlintDialect dialect) {
    cli_schema_line(3, "<choice>");
    cli_schema_line(4, "<group>");
    cli_schema_line(5, "<optional><attribute name=\"type\"/></optional>");
    cli_schema_line(5, "<ref name=\"ref\"/>");
    cli_schema_line(4, "</group>");
    GlintElementType type;
    for (int i = -1; (i = cli_schema_next_type(element->kind, i, dialect)) >= 0;) {
        glint_element_type_at(i, &type);
        cli_schema_line(4, "<ref name=\"type.%s\"/>", type.name);
        bool meant = element->default_type != NULL && strcmp(type.name, element->default_type) == 0;
        if (meant) cli_schema_line(4, "<ref name=\"content.%s\"/>", type.name);
    }
    cli_schema_line(3, "</choice>");
}

static void print_word(const GlintElement *element) {
    cli_schema_line(5, "<choice>");
    for (const char *word = element->choices; *word != '\0';) {
        int size = (int)strcspn(word, " ");
        cli_schema_line(6, "<value>%.*s</value>", size, word);
        word += size + (word[size] == ' ');
    }
    cli_schema_line(5, "</choice>");
}

static void print_value(const GlintElement *element) {
    cli_schema_line(3, "<choice>");
    cli_schema_line(4, "<ref name=\"ref\"/>");
    cli_schema_line(4, "<group>");
    cli_schema_line(5, "<ref name=\"name\"/>");
    if (element->choices != NULL) {
        print_word(element);
    } else {
        cli_schema_line(5, "<ref name=\"value.%s\"/>", cli_schema_value_of(element)->name);
    }
    cli_schema_line(4, "</group>");
    cli_schema_line(3, "</choice>");
}

static void print_element(int index, GlintDialect dialect) {
    GlintElement element;
    glint_element_at(index, &element);
    cli_schema_line(1, "<define name=\"element.%d\">", index);
    cli_schema_line(2, "<element name=\"%s\">", element.name);
    print_help(3, element.help);
    if (element.kind == GLINT_ELEMENT_SCENE) {
        print_scene(dialect);
    } else if (cli_element_is_object(&element)) {
        print_object(&element, dialect);
    } else {
        print_value(&element);
    }
    cli_schema_line(2, "</element>");
    cli_schema_line(1, "</define>");
}

void cli_schema_print_rng(GlintDialect dialect) {
    print_head();
    GlintElement element;
    for (int i = 0; glint_element_at(i, &element); i++) {
        if (cli_elements_of_year(element.years, dialect)) print_element(i, dialect);
    }
    GlintElementType type;
    for (int i = 0; glint_element_type_at(i, &type); i++) {
        if (cli_elements_of_year(type.years, dialect)) print_type(i, dialect);
    }
    puts("</grammar>");
}
