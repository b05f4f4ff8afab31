/* SPDX-License-Identifier: MIT
 * Nearness is the number of letters to insert, delete, replace or swap (Damerau 1964, in the form
 * where no letter is edited twice). A third of the letters may be wrong, and always one. */
#include "suggest.h"

#include <string.h>

enum { LENGTH_LIMIT = 31 };

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

static size_t edit_distance(const char *a, size_t a_count, const char *b, size_t b_count) {
    size_t rows[LENGTH_LIMIT + 1][LENGTH_LIMIT + 1];
    for (size_t j = 0; j <= b_count; j++) rows[0][j] = j;
    for (size_t i = 1; i <= a_count; i++) {
        rows[i][0] = i;
        for (size_t j = 1; j <= b_count; j++) {
            size_t replaced = rows[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            size_t moved = smaller(rows[i - 1][j], rows[i][j - 1]) + 1;
            rows[i][j] = smaller(replaced, moved);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                rows[i][j] = smaller(rows[i][j], rows[i - 2][j - 2] + 1);
            }
        }
    }
    return rows[a_count][b_count];
}

void cli_suggestion_begin(CliSuggestion *suggestion, const char *word) {
    size_t allowed = strlen(word) / 3;
    suggestion->word = word;
    suggestion->best = NULL;
    suggestion->distance = (allowed > 1 ? allowed : 1) + 1;
}

void cli_suggestion_add(CliSuggestion *suggestion, const char *candidate) {
    size_t word_count = strlen(suggestion->word), count = strlen(candidate);
    if (word_count > LENGTH_LIMIT || count > LENGTH_LIMIT || word_count == 0) return;
    size_t distance = edit_distance(suggestion->word, word_count, candidate, count);
    /* The beginning of a word is a good guess, too: --thr, --out. */
    if (word_count >= 2 && word_count < count &&
        strncmp(suggestion->word, candidate, word_count) == 0) {
        distance = 1;
    }
    if (distance < suggestion->distance) {
        suggestion->distance = distance;
        suggestion->best = candidate;
    }
}
