/* SPDX-License-Identifier: MIT
 * Values of options that several verbs have. Each function says what is wrong, with what is
 * allowed, and then returns CLI_USAGE. */
#pragma once

#include "glint/glint.h"

#include "status.h"

/* A whole number from low to high at *text, which moves behind it; says nothing. */
bool cli_value_digits(const char **text, int low, int high, int *value);

/* One of these letters; likewise. */
bool cli_value_letter(const char **text, const char *letters);

/* "--OPTION takes a number from LOW to HIGH, not 'VALUE'" */
CliStatus cli_value_number(const char *option, const char *value, int low, int high, int *number);

/* One of the names that a function gives for 0, 1, ... up to a null. */
CliStatus cli_value_name(
    const char *option, const char *value, const char *(*name_at)(int index), int *index);

CliStatus cli_value_dialect(const char *value, GlintDialect *dialect);
CliStatus cli_value_isa(const char *value, const char **isa);
CliStatus cli_value_threads(const char *value, int *thread_count);

/* Names of mistakes with commas between them, as glint_mistakes_parse has them. */
CliStatus cli_value_mistakes(const char *option, const char *value, GlintMistakes *mistakes);

/* WxH pixels */
CliStatus cli_value_size(const char *option, const char *value, int *width, int *height);

enum { CLI_SIDE_LIMIT = 1 << 28, CLI_PIXEL_LIMIT = 1 << 28 };
