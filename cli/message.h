/* SPDX-License-Identifier: MIT
 * What the program says on standard error. */
#pragma once

#include "glint/glint.h"

#include "status.h"

#if defined(__GNUC__)
#define CLI_PRINTF(format_index, first_index)                                                      \
    __attribute__((format(printf, format_index, first_index)))
#else
#define CLI_PRINTF(format_index, first_index)
#endif

/* Whether standard error is a terminal that understands control sequences. */
bool cli_message_on_terminal(void);

/* Whether what goes to standard output may be coloured. */
bool cli_message_output_in_colour(void);

/* "glint: message" */
CLI_PRINTF(1, 2) void cli_message_error(const char *format, ...);

/* Which verb the command line names: where usage messages point to; null: none. */
void cli_message_set_verb(const char *name);

/* The same, then where to find help. Returns CLI_USAGE. */
CLI_PRINTF(1, 2) CliStatus cli_message_usage(const char *format, ...);

/* A finding in a scene, in colour on a terminal unless NO_COLOR is set. */
void cli_message_diagnostic(const GlintDiagnostic *diagnostic);

/* The findings of one file. */
typedef struct CliFindings {
    int error_count;
} CliFindings;

/* Shows and counts a finding; a GlintDiagnosticFn, whose user is a CliFindings. */
void cli_message_finding(void *user, const GlintDiagnostic *diagnostic);

/* Ends a file that could not be used, by the number of its findings or, when it has none, by what
 * *error says. Returns what that means to the shell. */
CliStatus cli_message_failure(
    const char *name, const CliFindings *findings, const GlintError *error);

/* Writes out what standard output still holds. A reader that has gone away is no mistake; a full
 * disk is one, and is reported: CLI_MACHINE. */
CliStatus cli_message_flush_output(void);
