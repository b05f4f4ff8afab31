/* SPDX-License-Identifier: MIT
 * The same rows twice: as columns of text, in colours on a terminal, and as tables of Markdown. */
#include "docs_page.h"

#include "elements.h"
#include "message.h"

#include <stdio.h>
#include <string.h>

static const char *bold(void) { return cli_message_output_in_colour() ? "\033[1m" : ""; }
static const char *plain(void) { return cli_message_output_in_colour() ? "\033[0m" : ""; }

/* "number" of "a number"; "text" has no article. */
static const char *noun(GlintElementKind kind) {
    const char *text = glint_element_kind_text(kind), *blank = strchr(text, ' ');
    return blank != NULL ? blank + 1 : text;
}

/* "2017, 2018 and 2019" */
static void print_years(const char *years) {
    if (years == NULL) {
        fputs("all", stdout);
        return;
    }
    for (const char *word = years; *word != '\0';) {
        size_t length = strcspn(word, " ");
        printf("%.*s, ", (int)length, word);
        word += length + (word[length] == ' ');
    }
    fputs("glint", stdout);
}

/* The types, and the scene, in which an element may stand. */
static void print_parents(int element) {
    const char *between = "";
    if (glint_element_fits(element, CLI_IN_SCENE)) {
        fputs("scene", stdout);
        between = ", ";
    }
    GlintElementType type;
    for (int i = 0; glint_element_type_at(i, &type); i++) {
        if (type.alias_of != NULL || !glint_element_fits(element, i)) continue;
        printf("%s%s", between, type.name);
        between = ", ";
    }
    if (between[0] == '\0') fputs("nothing: it is the root", stdout);
}

static void print_types(GlintElementKind kind, const char *before, const char *behind) {
    const char *between = "";
    GlintElementType type;
    for (int i = -1; (i = cli_elements_next_type(kind, i)) >= 0;) {
        glint_element_type_at(i, &type);
        printf("%s%s%s%s", between, before, type.name, behind);
        between = ", ";
    }
}

/* "0 0 0", "required", "(none)": what a child is when it is not given. */
static const char *default_of(const GlintElement *element, int type) {
    if (element->required && type != CLI_IN_SCENE) return "required";
    if (element->default_text != NULL) return element->default_text;
    bool image = element->kind == GLINT_ELEMENT_IMAGE_SIZE;
    bool needed = image || element->kind == GLINT_ELEMENT_CAMERA;
    return needed && type == CLI_IN_SCENE ? "required" : "";
}

/* ---------------------------------------------------------------- the screen */

static void print_child_row(int index, int type) {
    GlintElement child;
    glint_element_at(index, &child);
    const char *range = glint_element_range_text(child.range);
    printf("  %s%-18s%s%-13s%-10s%s", bold(), child.name, plain(), noun(child.kind),
        default_of(&child, type), child.help);
    if (range != NULL) printf(" (%s)", range);
    if (child.choices != NULL) printf(": %s", child.choices);
    putchar('\n');
}

static void print_children(int type) {
    if (cli_elements_next_child(type, -1) < 0) return;
    printf("\n  %-18s%-13s%s\n", "takes", "what", "default");
    for (int i = -1; (i = cli_elements_next_child(type, i)) >= 0;) print_child_row(i, type);
}

/* The element whose types are of a kind and that is not another word for one. */
static const char *element_of(GlintElementKind kind) {
    GlintElement element;
    for (int i = 0; glint_element_at(i, &element); i++) {
        if (element.kind == kind && element.alias_of == NULL) break;
    }
    return element.name;
}

static void print_type_text(int index) {
    GlintElementType type;
    glint_element_type_at(index, &type);
    printf("%s%s%s: %s type; %s\n", bold(), type.name, plain(), glint_element_kind_text(type.kind),
        type.help);
    if (type.alias_of != NULL) printf("  another word for %s\n", type.alias_of);
    fputs("  years: ", stdout);
    print_years(type.years);
    putchar('\n');
    print_children(index);
    puts("\nExample:");
    cli_elements_print_example(element_of(type.kind), index, "  ");
}

static void print_row_text(int index) {
    GlintElement element;
    glint_element_at(index, &element);
    printf("%s%s%s: %s; %s\n", bold(), element.name, plain(), glint_element_kind_text(element.kind),
        element.help);
    if (element.alias_of != NULL) printf("  another word for %s\n", element.alias_of);
    fputs("  in: ", stdout);
    print_parents(index);
    fputs("\n  years: ", stdout);
    print_years(element.years);
    putchar('\n');
    const char *range = glint_element_range_text(element.range);
    if (range != NULL) printf("  range: %s\n", range);
    if (element.choices != NULL) printf("  one of: %s\n", element.choices);
    if (element.required) puts("  required");
    if (element.default_text != NULL) printf("  default: %s\n", element.default_text);
    if (element.example != NULL) {
        printf("  example: <%s>%s</%s>\n", element.name, element.example, element.name);
    }
    if (!cli_element_is_object(&element) || element.kind == GLINT_ELEMENT_SCENE) return;
    fputs("  types: ", stdout);
    print_types(element.kind, "", "");
    puts(element.default_type != NULL ? "" : " (one must be given)");
    if (element.default_type != NULL)
        printf("  type when none is given: %s\n", element.default_type);
    puts("\nExample:");
    cli_elements_print_example(element.name, cli_elements_next_type(element.kind, -1), "  ");
}

/* ---------------------------------------------------------------- Markdown */

static void print_child_markdown(int index, int type) {
    GlintElement child;
    glint_element_at(index, &child);
    const char *range = glint_element_range_text(child.range), *value = default_of(&child, type);
    printf("| `%s` | %s | %s | ", child.name, noun(child.kind), value);
    fputs(child.help, stdout);
    if (range != NULL) printf("; %s", range);
    if (child.choices != NULL) printf(": `%s`", child.choices);
    if (child.alias_of != NULL) printf("; means `%s`", child.alias_of);
    fputs(" | ", stdout);
    print_years(child.years);
    puts(" |");
}

static void print_children_markdown(int type) {
    if (cli_elements_next_child(type, -1) < 0) {
        puts("It takes no elements.\n");
        return;
    }
    puts("| takes | what | default | meaning | years |\n| --- | --- | --- | --- | --- |");
    for (int i = -1; (i = cli_elements_next_child(type, i)) >= 0;) print_child_markdown(i, type);
    putchar('\n');
}

static void print_type_markdown(int index) {
    GlintElementType type;
    glint_element_type_at(index, &type);
    printf("### `%s`\n\n", type.name);
    if (type.alias_of != NULL) {
        printf("Another word for `%s`. Years: ", type.alias_of);
        print_years(type.years);
        puts(".\n");
        return;
    }
    printf("The type of %s: %s. Years: ", glint_element_kind_text(type.kind), type.help);
    print_years(type.years);
    puts(".\n");
    print_children_markdown(index);
    puts("```xml");
    cli_elements_print_example(element_of(type.kind), index, "");
    puts("```\n");
}

static void print_row_markdown(int index) {
    GlintElement element;
    glint_element_at(index, &element);
    printf("`%s`: %s; %s.", element.name, glint_element_kind_text(element.kind), element.help);
    if (element.alias_of != NULL) printf(" Means `%s`.", element.alias_of);
    fputs(" It stands in: ", stdout);
    print_parents(index);
    fputs(". Years: ", stdout);
    print_years(element.years);
    fputs(".", stdout);
    if (element.default_type != NULL) printf(" Without a type it is a `%s`.", element.default_type);
    puts("\n");
}

static void print_scene(bool markdown) {
    if (markdown) {
        puts("## `scene`\n");
        print_children_markdown(CLI_IN_SCENE);
        puts("```xml");
        cli_elements_print_example("scene", CLI_IN_SCENE, "");
        puts("```\n");
        return;
    }
    printf("%sscene%s: the root element; its attribute dialect says which year's rules hold\n",
        bold(), plain());
    print_children(CLI_IN_SCENE);
    puts("\nExample:");
    cli_elements_print_example("scene", CLI_IN_SCENE, "  ");
}

/* ---------------------------------------------------------------- pages */

void cli_docs_print_type(int type, bool markdown) {
    if (type == CLI_IN_SCENE) {
        print_scene(markdown);
    } else if (markdown) {
        print_type_markdown(type);
    } else {
        print_type_text(type);
    }
}

void cli_docs_print_element(const char *name, bool markdown) {
    GlintElement element;
    bool first = true;
    for (int i = 0; glint_element_at(i, &element); i++) {
        if (strcmp(element.name, name) != 0) continue;
        if (!first && !markdown) putchar('\n');
        first = false;
        if (markdown) {
            print_row_markdown(i);
        } else {
            print_row_text(i);
        }
    }
}

void cli_docs_print_reference(void) {
    puts("# Elements and types\n\n"
         "What a scene file may hold, as the program's tables have it; `glint docs` says the same\n"
         "on the screen. [scene-format.md](scene-format.md) tells what it means.\n\n"
         "This page is made by `glint docs --format markdown`; a test holds it against the\n"
         "program. Years are the dialects that something was made for. Every dialect understands\n"
         "all of it.\n");
    print_scene(true);
    for (int kind = GLINT_ELEMENT_CAMERA; kind <= GLINT_ELEMENT_INTEGRATOR; kind++) {
        printf("## `%s`\n\n", element_of((GlintElementKind)kind));
        GlintElement element;
        for (int i = 0; glint_element_at(i, &element); i++) {
            if (element.kind == (GlintElementKind)kind) print_row_markdown(i);
        }
        for (int i = -1; (i = cli_elements_next_type((GlintElementKind)kind, i)) >= 0;) {
            print_type_markdown(i);
        }
    }
}

/* Words in lines of at most 78 columns, each line two blanks in. */
static void print_wrapped(const char *word, size_t *column) {
    size_t size = strlen(word) + 1;
    bool first = *column == 0, full = *column + size > 78;
    printf("%s%s", first ? "  " : full ? "\n  " : " ", word);
    *column = (first || full ? 1 : *column) + size;
}

/* Whether an element of this name came before. */
static bool is_again(int index, const char *name) {
    GlintElement other;
    for (int i = 0; i < index; i++) {
        glint_element_at(i, &other);
        if (strcmp(other.name, name) == 0) return true;
    }
    return false;
}

void cli_docs_print_list(void) {
    printf("%sElements%s\n", bold(), plain());
    GlintElement element;
    size_t column = 0;
    for (int i = 0; glint_element_at(i, &element); i++) {
        if (!is_again(i, element.name)) print_wrapped(element.name, &column);
    }
    putchar('\n');
    for (int kind = GLINT_ELEMENT_CAMERA; kind <= GLINT_ELEMENT_INTEGRATOR; kind++) {
        printf("\n%sTypes of %s%s\n", bold(), element_of((GlintElementKind)kind), plain());
        GlintElementType type;
        for (int i = -1; (i = cli_elements_next_type((GlintElementKind)kind, i)) >= 0;) {
            glint_element_type_at(i, &type);
            printf("  %-25s %s\n", type.name, type.help);
        }
    }
    puts("\nglint docs NAME tells what an element or type takes.");
}
