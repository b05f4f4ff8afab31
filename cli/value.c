/* SPDX-License-Identifier: MIT
 * From the text of an option's value to what it means. */
#include "value.h"

#include "message.h"
#include "suggest.h"

#include <stdio.h>
#include <string.h>

bool cli_value_digits(const char **text, int low, int high, int *value) {
    const char *digit = *text;
    int64_t number = 0;
    for (; *digit >= '0' && *digit <= '9'; digit++) {
        number = number * 10 + (*digit - '0');
        if (number > high) return false;
    }
    if (digit == *text || number < low) return false;
    *text = digit;
    *value = (int)number;
    return true;
}

bool cli_value_letter(const char **text, const char *letters) {
    if (**text == '\0' || strchr(letters, **text) == NULL) return false;
    ++*text;
    return true;
}

CliStatus cli_value_number(const char *option, const char *value, int low, int high, int *number) {
    const char *text = value;
    if (cli_value_digits(&text, low, high, number) && *text == '\0') return CLI_OK;
    return cli_message_usage(
        "--%s takes a number from %d to %d, not '%s'", option, low, high, value);
}

/* "a, b or c" */
static void list_names(const char *(*name_at)(int index), char *buffer, size_t size) {
    buffer[0] = '\0';
    size_t used = 0;
    for (int i = 0; name_at(i) != NULL && used < size; i++) {
        const char *between = i == 0 ? "" : name_at(i + 1) == NULL ? " or " : ", ";
        used += (size_t)snprintf(buffer + used, size - used, "%s%s", between, name_at(i));
    }
}

static CliStatus refuse_name(
    const char *option, const char *value, const char *(*name_at)(int index)) {
    char allowed[512];
    list_names(name_at, allowed, sizeof allowed);
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, value);
    for (int i = 0; name_at(i) != NULL; i++) cli_suggestion_add(&suggestion, name_at(i));
    if (suggestion.best != NULL) {
        return cli_message_usage(
            "--%s takes %s, not '%s'; did you mean '%s'?", option, allowed, value, suggestion.best);
    }
    return cli_message_usage("--%s takes %s, not '%s'", option, allowed, value);
}

CliStatus cli_value_name(
    const char *option, const char *value, const char *(*name_at)(int index), int *index) {
    for (int i = 0; name_at(i) != NULL; i++) {
        if (strcmp(value, name_at(i)) == 0) {
            *index = i;
            return CLI_OK;
        }
    }
    return refuse_name(option, value, name_at);
}

static const char *dialect_name_at(int index) {
    return index < GLINT_DIALECT_COUNT ? glint_dialect_name((GlintDialect)index) : NULL;
}

CliStatus cli_value_dialect(const char *value, GlintDialect *dialect) {
    int index = 0;
    CliStatus status = cli_value_name("dialect", value, dialect_name_at, &index);
    if (status == CLI_OK) *dialect = (GlintDialect)index;
    return status;
}

CliStatus cli_value_isa(const char *value, const char **isa) {
    int index = 0;
    CliStatus status = cli_value_name("isa", value, glint_isa_name, &index);
    if (status == CLI_OK) *isa = glint_isa_name(index);
    return status;
}

CliStatus cli_value_threads(const char *value, int *thread_count) {
    enum { THREAD_LIMIT = 1024 };
    return cli_value_number("threads", value, 1, THREAD_LIMIT, thread_count);
}

CliStatus cli_value_size(const char *option, const char *value, int *width, int *height) {
    const char *text = value;
    if (cli_value_digits(&text, 1, CLI_SIDE_LIMIT, width) && cli_value_letter(&text, "xX") &&
        cli_value_digits(&text, 1, CLI_SIDE_LIMIT, height) && *text == '\0' &&
        (int64_t)*width * *height <= CLI_PIXEL_LIMIT) {
        return CLI_OK;
    }
    return cli_message_usage(
        "--%s takes two numbers of pixels, such as 640x480, at most 2^28 together, not '%s'",
        option, value);
}

CliStatus cli_value_mistakes(const char *option, const char *value, GlintMistakes *mistakes) {
    const char *wrong;
    if (glint_mistakes_parse(value, mistakes, &wrong)) return CLI_OK;
    char word[32];
    GlintMistake known;
    snprintf(word, sizeof word, "%.*s", (int)strcspn(wrong, ",="), wrong);
    if (glint_mistake_from_name(word, &known)) {
        return cli_message_usage(
            "--%s: what follows '%s' is not understood in '%s'", option, word, wrong);
    }
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, word);
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        cli_suggestion_add(&suggestion, glint_mistake_name((GlintMistake)i));
    }
    if (suggestion.best == NULL) {
        return cli_message_usage(
            "--%s knows no mistake '%s'; --%s list names them", option, word, option);
    }
    return cli_message_usage(
        "--%s knows no mistake '%s'; did you mean '%s'?", option, word, suggestion.best);
}
