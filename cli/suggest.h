/* SPDX-License-Identifier: MIT
 * "Did you mean ...?" */
#pragma once

#include <stddef.h>

/* The best candidate so far for a word that is not known. */
typedef struct CliSuggestion {
    const char *word; /* what was typed */
    const char *best; /* null: nothing is near enough */
    size_t distance;
} CliSuggestion;

void cli_suggestion_begin(CliSuggestion *suggestion, const char *word);
void cli_suggestion_add(CliSuggestion *suggestion, const char *candidate);
