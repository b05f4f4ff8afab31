/* SPDX-License-Identifier: MIT */
#include "reader/suggest.h"

#include "reader/element.h"

#include <string.h>

enum { WORD_LIMIT = 63 }; /* longer words are not worth a suggestion */

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

/* Damerau (1964) and Levenshtein (1966), the variant in which no part is edited twice. Three rows
 * of the table are enough. */
size_t gi_edit_distance(
    const char *a, size_t a_length, const char *b, size_t b_length, size_t limit) {
    size_t rows[3][WORD_LIMIT + 1];
    size_t difference = a_length > b_length ? a_length - b_length : b_length - a_length;
    if (a_length > WORD_LIMIT || b_length > WORD_LIMIT || difference > limit) return limit + 1;
    for (size_t j = 0; j <= b_length; j++) rows[0][j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t *row = rows[i % 3], *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            char x = gi_lower(a[i - 1]), y = gi_lower(b[j - 1]);
            size_t best = smaller(smaller(above[j], row[j - 1]) + 1, above[j - 1] + (x != y));
            if (i > 1 && j > 1 && x == gi_lower(b[j - 2]) && gi_lower(a[i - 2]) == y) {
                best = smaller(best, two_above[j - 2] + 1);
            }
            row[j] = best;
        }
    }
    return smaller(rows[a_length % 3][b_length], limit + 1);
}

GiSuggestion gi_suggestion_begin(const char *word, size_t length) {
    return (GiSuggestion){.word = word, .length = length};
}

void gi_suggestion_offer(GiSuggestion *suggestion, const char *candidate) {
    size_t length = strlen(candidate);
    size_t longer = length > suggestion->length ? length : suggestion->length;
    size_t limit = (longer + 1) / 3;
    if (suggestion->best != NULL) {
        if (suggestion->best_distance == 0) return;
        limit = smaller(limit, suggestion->best_distance - 1);
    }
    size_t distance =
        gi_edit_distance(suggestion->word, suggestion->length, candidate, length, limit);
    if (distance > limit) return;
    suggestion->best = candidate;
    suggestion->best_distance = distance;
}
