/* SPDX-License-Identifier: MIT
 * "did you mean": the nearest of a number of candidates, when one is near enough. */
#pragma once

#include <stddef.h>

typedef struct GiSuggestion {
    const char *word;
    size_t length;
    const char *best; /* null: none is near */
    size_t best_distance;
} GiSuggestion;

GiSuggestion gi_suggestion_begin(const char *word, size_t length);
void gi_suggestion_offer(GiSuggestion *suggestion, const char *candidate);

/* Insertions, deletions, replacements and swaps of neighbours that lead from a to b, without
 * regard to case; anything above limit is given as limit + 1. */
size_t gi_edit_distance(
    const char *a, size_t a_length, const char *b, size_t b_length, size_t limit);
