/* SPDX-License-Identifier: MIT
 * The parser of the command line. It knows verbs and options only through their tables; what a
 * value means is decided by the option's own function. The first mistake is reported. */
#define _POSIX_C_SOURCE 200809L
#include "arguments.h"

#include "message.h"
#include "suggest.h"
#include "value.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* The arguments still to be read; an option may take the one after it as its value. */
typedef struct Cursor {
    int argc, index;
    char **argv;
} Cursor;

static const char *help_name_at(int index) {
    static const char *const names[] = {"man", "markdown", NULL};
    return names[index];
}

static CliStatus ask_for_help(CliArguments *arguments, const char *value) {
    arguments->answer = CLI_ANSWER_HELP;
    if (value == NULL) return CLI_OK;
    int index;
    CliStatus status = cli_value_name("help", value, help_name_at, &index);
    if (status == CLI_OK) arguments->answer = index == 0 ? CLI_ANSWER_MAN : CLI_ANSWER_MARKDOWN;
    return status;
}

static CliStatus apply(CliArguments *arguments, const CliOption *option, const char *value) {
    if (option->set != NULL) return option->set(arguments->verb->values, value);
    if (option->short_name == 'h') return ask_for_help(arguments, value);
    arguments->answer = CLI_ANSWER_VERSION;
    return CLI_OK;
}

static CliStatus refuse_long(const CliVerb *verb, const char *name, size_t size) {
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)size, name);
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, word);
    const CliOption *option;
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        cli_suggestion_add(&suggestion, option->long_name);
    }
    if (suggestion.best != NULL) {
        return cli_message_usage(
            "unknown option '--%s'; did you mean '--%s'?", word, suggestion.best);
    }
    return cli_message_usage("unknown option '--%s'", word);
}

static CliStatus missing_value(const CliOption *option) {
    return cli_message_usage(
        "--%s needs a value: --%s %s", option->long_name, option->long_name, option->argument);
}

/* --name, --name=value or --name value */
static CliStatus parse_long(Cursor *cursor, CliArguments *arguments) {
    const char *name = cursor->argv[cursor->index] + 2;
    size_t size = strcspn(name, "=");
    const char *value = name[size] == '=' ? name + size + 1 : NULL;
    const CliOption *option;
    for (int i = 0; (option = cli_verb_option_at(arguments->verb, i)) != NULL; i++) {
        if (strlen(option->long_name) != size || strncmp(option->long_name, name, size) != 0)
            continue;
        if (option->form == CLI_FORM_NONE && value != NULL) {
            return cli_message_usage("--%s takes no value", option->long_name);
        }
        if (option->form == CLI_FORM_REQUIRED && value == NULL) {
            if (cursor->index + 1 == cursor->argc) return missing_value(option);
            value = cursor->argv[++cursor->index];
        }
        return apply(arguments, option, value);
    }
    return refuse_long(arguments->verb, name, size);
}

static const CliOption *find_letter(const CliVerb *verb, char letter) {
    const CliOption *option;
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        if (option->short_name == letter) return option;
    }
    return NULL;
}

/* -q, -t4, -t 4, and several letters together: -qt4 */
static CliStatus parse_short(Cursor *cursor, CliArguments *arguments) {
    const char *letters = cursor->argv[cursor->index] + 1;
    while (*letters != '\0') {
        const CliOption *option = find_letter(arguments->verb, *letters);
        if (option == NULL) {
            int length = 1; /* a letter outside of ASCII is several bytes */
            while (((unsigned char)letters[length] & 0xc0) == 0x80) length++;
            return cli_message_usage("unknown option '-%.*s'", length, letters);
        }
        letters++;
        const char *value = NULL;
        if (option->form == CLI_FORM_REQUIRED) {
            value = letters;
            if (*value == '\0') {
                if (cursor->index + 1 == cursor->argc) return missing_value(option);
                value = cursor->argv[++cursor->index];
            }
            letters = "";
        }
        CliStatus status = apply(arguments, option, value);
        if (status != CLI_OK) return status;
    }
    return CLI_OK;
}

/* The first word names the verb, if it does; a word that nearly does, and is no file, is a slip. */
static CliStatus choose_verb(CliArguments *arguments, Cursor *cursor) {
    arguments->verb = cli_verb_at(0);
    if (cursor->argc < 2) return CLI_OK;
    const char *word = cursor->argv[1];
    const CliVerb *verb = cli_verb_find(word);
    if (verb != NULL) {
        arguments->verb = verb;
        arguments->named = true;
        cli_message_set_verb(verb->name);
        cursor->index++;
        return CLI_OK;
    }
    if (strpbrk(word, "-./") != NULL || access(word, F_OK) == 0) return CLI_OK;
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, word);
    for (int i = 0; cli_verb_at(i) != NULL; i++) {
        cli_suggestion_add(&suggestion, cli_verb_at(i)->name);
    }
    if (suggestion.best == NULL) return CLI_OK;
    return cli_message_usage(
        "there is no verb and no file '%s'; did you mean 'glint %s'?", word, suggestion.best);
}

CliStatus cli_arguments_parse(int argc, char **argv, CliArguments *arguments) {
    *arguments = (CliArguments){.operands.items = argv};
    Cursor cursor = {.argc = argc, .index = 1, .argv = argv};
    CliStatus status = choose_verb(arguments, &cursor);
    bool options_ended = false;
    for (; status == CLI_OK && cursor.index < argc; cursor.index++) {
        char *argument = argv[cursor.index];
        if (options_ended || argument[0] != '-' || argument[1] == '\0') {
            arguments->operands.items[arguments->operands.count++] = argument;
        } else if (argument[1] != '-') {
            status = parse_short(&cursor, arguments);
        } else if (argument[2] != '\0') {
            status = parse_long(&cursor, arguments);
        } else {
            options_ended = true;
        }
    }
    return status;
}
