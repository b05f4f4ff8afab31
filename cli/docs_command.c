/* SPDX-License-Identifier: MIT
 * glint docs: what elements and types are. */
#include "docs_page.h"
#include "elements.h"
#include "message.h"
#include "suggest.h"
#include "value.h"
#include "verb.h"

#include <string.h>
#include <strings.h>

typedef struct Options {
    bool markdown;
} Options;

static const char *format_name_at(int index) {
    static const char *const names[] = {"text", "markdown", NULL};
    return names[index];
}

static CliStatus set_format(void *values, const char *value) {
    int index = 0;
    CliStatus status = cli_value_name("format", value, format_name_at, &index);
    ((Options *)values)->markdown = index == 1;
    return status;
}

/* Prints what has this name, in this case or any. False: nothing has. */
static bool print_named(
    const char *name, bool markdown, int (*compare)(const char *, const char *)) {
    GlintElement element;
    if (compare(name, "scene") == 0) {
        cli_docs_print_type(CLI_IN_SCENE, markdown);
        return true;
    }
    for (int i = 0; glint_element_at(i, &element); i++) {
        if (compare(name, element.name) != 0) continue;
        cli_docs_print_element(element.name, markdown);
        return true;
    }
    GlintElementType type;
    for (int i = 0; glint_element_type_at(i, &type); i++) {
        if (compare(name, type.name) != 0) continue;
        cli_docs_print_type(i, markdown);
        return true;
    }
    return false;
}

static CliStatus refuse(const char *name) {
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, name);
    /* Names are longer than options, and heard more often than read: Sfere. */
    if (strlen(name) >= 5 && suggestion.distance < 3) suggestion.distance = 3;
    GlintElement element;
    for (int i = 0; glint_element_at(i, &element); i++) {
        cli_suggestion_add(&suggestion, element.name);
    }
    GlintElementType type;
    for (int i = 0; glint_element_type_at(i, &type); i++) {
        cli_suggestion_add(&suggestion, type.name);
    }
    if (suggestion.best != NULL) {
        cli_message_error(
            "there is no element and no type '%s'; did you mean '%s'?", name, suggestion.best);
    } else {
        cli_message_error("there is no element and no type '%s'; glint docs lists them", name);
    }
    return CLI_USAGE;
}

static CliStatus run(void *values, const CliOperands *operands) {
    const Options *options = values;
    CliStatus status = CLI_OK;
    if (operands->count == 0 && options->markdown) cli_docs_print_reference();
    if (operands->count == 0 && !options->markdown) cli_docs_print_list();
    for (int i = 0; i < operands->count; i++) {
        const char *name = operands->items[i];
        if (!print_named(name, options->markdown, strcmp) &&
            !print_named(name, options->markdown, strcasecmp)) {
            status = refuse(name);
        }
    }
    return cli_status_worse(status, cli_message_flush_output());
}

static const CliOption options[] = {
    {0, "format", "text|markdown", CLI_FORM_REQUIRED, "The page", "for the screen, or for a file",
        set_format},
};

static Options defaults;

const CliVerb cli_verb_docs = {.name = "docs",
    .operands = "[NAME...]",
    .summary = "tell what an element or type of a scene is",
    .about = "Tells of an element or type where it may stand, what it takes, its default and\n"
             "range, the years it is from, and shows an example. Without a NAME it lists\n"
             "all.",
    .example_text = "what a cone takes",
    .example = "glint docs Cone",
    .options = options,
    .option_count = CLI_COUNT(options),
    .values = &defaults,
    .run = run};
