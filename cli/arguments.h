/* SPDX-License-Identifier: MIT
 * The command line, read by the table of a verb. */
#pragma once

#include "verb.h"

typedef enum CliAnswer {
    CLI_ANSWER_RUN, /* do what the verb does */
    CLI_ANSWER_HELP,
    CLI_ANSWER_MAN,
    CLI_ANSWER_MARKDOWN,
    CLI_ANSWER_VERSION
} CliAnswer;

typedef struct CliArguments {
    const CliVerb *verb;
    bool named;           /* the verb stands on the command line */
    CliAnswer answer;     /* the last option that asks for one */
    CliOperands operands; /* point into argv */
} CliArguments;

/* Reads the arguments: options into the values of the verb, the rest into operands. argv is
 * reordered, and must live as long as *arguments. When something is wrong it says so on standard
 * error, by name and with what is allowed, and returns CLI_USAGE. */
CliStatus cli_arguments_parse(int argc, char **argv, CliArguments *arguments);
