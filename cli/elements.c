/* SPDX-License-Identifier: MIT */
#include "elements.h"

#include <stdio.h>
#include <string.h>

bool cli_elements_of_year(const char *years, GlintDialect dialect) {
    if (years == NULL || dialect == GLINT_DIALECT_AUTO || dialect == GLINT_DIALECT_GLINT)
        return true;
    const char *name = glint_dialect_name(dialect);
    size_t size = strlen(name);
    for (const char *word = years; *word != '\0';) {
        size_t length = strcspn(word, " ");
        if (length == size && memcmp(word, name, size) == 0) return true;
        word += length + (word[length] == ' ');
    }
    return false;
}

int cli_elements_next_type(GlintElementKind kind, int type) {
    GlintElementType row;
    for (int i = type + 1; glint_element_type_at(i, &row); i++) {
        if (row.kind == kind) return i;
    }
    return -1;
}

int cli_elements_next_child(int type, int element) {
    GlintElement row;
    for (int i = element + 1; glint_element_at(i, &row); i++) {
        if (glint_element_fits(i, type)) return i;
    }
    return -1;
}

bool cli_elements_repeats(const GlintElement *element) {
    static const char *const words[] = {"surface", "shader", "material", "bsdf", "brdf", "texture",
        "light", "translate", "rotate", "scale"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(element->name, words[i]) == 0) return true;
    }
    return false;
}

/* ---------------------------------------------------------------- examples */

static void print_object(const char *name, int type, const char *before, int depth);

/* What belongs in an example: values, and what the type cannot do without. What may as well stand
 * in the scene would only distract. */
static bool is_shown(int index, const GlintElement *child, int type) {
    if (child->alias_of != NULL) return false;
    GlintElementType row;
    bool group = glint_element_type_at(type, &row) && strcmp(row.name, "Group") == 0;
    if (group && child->kind == GLINT_ELEMENT_SURFACE) return true;
    if (child->required) return true;
    return !cli_element_is_object(child) && !glint_element_fits(index, CLI_IN_SCENE);
}

static void print_child(const GlintElement *child, const char *before, int depth) {
    if (cli_element_is_object(child)) {
        print_object(child->name, cli_elements_next_type(child->kind, -1), before, depth);
    } else {
        printf(
            "%s%*s<%s>%s</%s>\n", before, 2 * depth, "", child->name, child->example, child->name);
    }
}

static void print_object(const char *name, int type, const char *before, int depth) {
    GlintElementType row;
    glint_element_type_at(type, &row);
    printf("%s%*s<%s type=\"%s\"", before, 2 * depth, "", name, row.name);
    bool empty = true;
    /* A child without a type to be seen is enough of an example. */
    bool brief = depth > 0 && row.kind != GLINT_ELEMENT_BRDF;
    for (int i = -1; !brief && (i = cli_elements_next_child(type, i)) >= 0;) {
        GlintElement child;
        glint_element_at(i, &child);
        if (!is_shown(i, &child, type)) continue;
        if (empty) puts(">");
        empty = false;
        print_child(&child, before, depth + 1);
    }
    if (empty) {
        puts("/>");
    } else {
        printf("%s%*s</%s>\n", before, 2 * depth, "", name);
    }
}

void cli_elements_print_example(const char *element, int type, const char *before) {
    if (type != CLI_IN_SCENE) {
        print_object(element, type, before, 0);
        return;
    }
    printf("%s<scene dialect=\"glint\">\n%s  <image>640 480</image>\n", before, before);
    printf("%s  <camera><viewPoint>0 0 4</viewPoint></camera>\n", before);
    printf("%s  <surface type=\"Sphere\"/>\n", before);
    printf("%s  <light><position>4 5 6</position></light>\n%s</scene>\n", before, before);
}
