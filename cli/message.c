/* SPDX-License-Identifier: MIT
 * Messages. The library lays a diagnostic out; here it only gets its colours. */
#define _POSIX_C_SOURCE 200809L
#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define BOLD  "\033[1m"
#define RED   "\033[1;31m"
#define AMBER "\033[1;33m"
#define CYAN  "\033[1;36m"
#define GREEN "\033[1;32m"
#define PLAIN "\033[0m"

static const char *named_verb = "";

void cli_message_set_verb(const char *name) { named_verb = name != NULL ? name : ""; }

static bool is_terminal(int fd) {
    const char *terminal = getenv("TERM");
    return isatty(fd) && terminal != NULL && strcmp(terminal, "dumb") != 0;
}

bool cli_message_on_terminal(void) { return is_terminal(STDERR_FILENO); }

/* https://no-color.org: set and not empty. */
static bool takes_colours(int fd) {
    const char *no_color = getenv("NO_COLOR");
    return is_terminal(fd) && (no_color == NULL || no_color[0] == '\0');
}

bool cli_message_output_in_colour(void) { return takes_colours(STDOUT_FILENO); }

CLI_PRINTF(1, 0) static void say(const char *format, va_list arguments) {
    fputs("glint: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

void cli_message_error(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
}

CliStatus cli_message_usage(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
    fprintf(stderr, "try 'glint %s%s--help'\n", named_verb, named_verb[0] != '\0' ? " " : "");
    return CLI_USAGE;
}

static void put_coloured(const char *colour, const char *text, size_t size) {
    fputs(colour, stderr);
    fwrite(text, 1, size, stderr);
    fputs(PLAIN, stderr);
}

static const struct {
    const char *word, *colour;
} severities[] = {[GLINT_SEVERITY_ERROR] = {"error:", RED},
    [GLINT_SEVERITY_WARNING] = {"warning:", AMBER},
    [GLINT_SEVERITY_NOTE] = {"note:", CYAN}};

/* "path:line:column: error: message": the place bold, the severity in its colour. */
static void put_heading(const GlintDiagnostic *diagnostic, const char *line, size_t size) {
    const char *word = severities[diagnostic->severity].word;
    size_t place = strlen(diagnostic->path), word_size = strlen(word);
    /* The path may itself contain the word, so the search begins behind it. */
    while (place + word_size <= size && strncmp(line + place, word, word_size) != 0) place++;
    if (place + word_size > size) {
        fwrite(line, 1, size, stderr);
        return;
    }
    put_coloured(BOLD, line, place);
    put_coloured(severities[diagnostic->severity].colour, line + place, word_size);
    fwrite(line + place + word_size, 1, size - place - word_size, stderr);
}

static void put_in_colour(const GlintDiagnostic *diagnostic, const char *text) {
    for (int row = 0; *text != '\0'; row++) {
        size_t size = strcspn(text, "\n");
        if (row == 0) {
            put_heading(diagnostic, text, size);
        } else if (row == 2) { /* the caret, behind the excerpt */
            put_coloured(GREEN, text, size);
        } else {
            fwrite(text, 1, size, stderr);
        }
        fputc('\n', stderr);
        text += size + (text[size] == '\n');
    }
}

/* A scene from a stranger must not steer the terminal. */
static void disarm(char *text) {
    for (; *text != '\0'; text++) {
        unsigned char byte = (unsigned char)*text;
        if ((byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f) *text = '?';
    }
}

void cli_message_diagnostic(const GlintDiagnostic *diagnostic) {
    size_t size = glint_diagnostic_format(diagnostic, NULL, 0) + 1;
    char *text = malloc(size);
    if (text == NULL) {
        fprintf(stderr, "%s: %s\n", diagnostic->path, diagnostic->message);
        return;
    }
    glint_diagnostic_format(diagnostic, text, size);
    if (takes_colours(STDERR_FILENO)) {
        disarm(text);
        put_in_colour(diagnostic, text);
    } else {
        fputs(text, stderr);
    }
    free(text);
}

void cli_message_finding(void *user, const GlintDiagnostic *diagnostic) {
    CliFindings *findings = user;
    findings->error_count++;
    cli_message_diagnostic(diagnostic);
}

CliStatus cli_message_failure(
    const char *name, const CliFindings *findings, const GlintError *error) {
    int count = findings->error_count;
    if (count > 0) {
        fprintf(stderr, "%s: %d %s\n", name, count, count == 1 ? "error" : "errors");
    } else {
        cli_message_error("%s: %s", name, error->message);
    }
    return error->status == GLINT_ERROR_SCENE ? CLI_INPUT : CLI_MACHINE;
}

CliStatus cli_message_flush_output(void) {
    if (fflush(stdout) == 0 && !ferror(stdout)) return CLI_OK;
    int reason = errno;
    clearerr(stdout);
    if (reason == EPIPE) return CLI_OK;
    cli_message_error("cannot write to standard output: %s", strerror(reason));
    return CLI_MACHINE;
}
