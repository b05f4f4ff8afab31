/* SPDX-License-Identifier: MIT
 * What the program can do. A verb is described once, in a struct that stands in the verb's own
 * file: the parser of the command line, the help on the screen, the manual pages, the completion of
 * shells and the tables in the documentation are all made from it. */
#pragma once

#include "status.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum CliOptionForm {
    CLI_FORM_NONE,     /* --option */
    CLI_FORM_REQUIRED, /* --option VALUE, --option=VALUE, -oVALUE */
    CLI_FORM_OPTIONAL, /* --option, --option=VALUE */
    CLI_FORM_HIDDEN    /* the same, but the help does not mention the value */
} CliOptionForm;

typedef struct CliOption {
    char short_name; /* 0: none */
    const char *long_name;
    const char *argument; /* null: takes none. Words with | between them are all there are */
    CliOptionForm form;
    const char *group; /* heading in the help; the options of a group stand together */
    const char *help;  /* at most 52 characters */
    /* Puts the value (null when none is given) into the verb's values; says what is wrong. */
    CliStatus (*set)(void *values, const char *value);
} CliOption;

/* What stands on the command line besides options, in the order given. */
typedef struct CliOperands {
    char **items;
    int count;
} CliOperands;

typedef struct CliVerb {
    const char *name;
    const char *operands; /* as in the usage line: "SCENE..." */
    const char *summary;  /* a line of `glint --help`: lower case, no full stop */
    const char *about;    /* the paragraphs of its own help, lines of at most 78 characters */
    const char *notes;    /* what follows the options; null: nothing */
    const char *example_text, *example; /* what it does; the command */
    const CliOption *options;
    int option_count;
    void *values; /* of the options, with their defaults */
    CliStatus (*run)(void *values, const CliOperands *operands);
} CliVerb;

#define CLI_COUNT(array) (int)(sizeof(array) / sizeof *(array))

/* Every verb, in the order of the help. The first is what the program does when none is named. */
#define CLI_VERB_LIST(X)                                                                           \
    X(render)                                                                                      \
    X(check) X(why) X(grade) X(watch) X(verify) X(fmt) X(upgrade) X(schema) X(docs) X(completion)

#define CLI_VERB_DECLARE(name) extern const CliVerb cli_verb_##name;
CLI_VERB_LIST(CLI_VERB_DECLARE)
#undef CLI_VERB_DECLARE

/* The verb at an index, or null behind the last. */
const CliVerb *cli_verb_at(int index);

/* The verb of this name, or null. */
const CliVerb *cli_verb_find(const char *name);

/* The options that every verb has: --help, --version. Their set is null: the parser knows them. */
enum { CLI_COMMON_OPTION_COUNT = 2 };
extern const CliOption cli_common_options[CLI_COMMON_OPTION_COUNT];

/* The options of a verb and then the common ones; null behind the last. */
const CliOption *cli_verb_option_at(const CliVerb *verb, int index);
