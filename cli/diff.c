/* SPDX-License-Identifier: MIT
 * Myers 1986, "An O(ND) Difference Algorithm and Its Variations": the furthest point that d edits
 * reach on each diagonal, for d = 0, 1, ...; walked backwards, they are the shortest list of edits.
 * What both texts begin and end with is set aside first. Texts that differ in more than EDIT_LIMIT
 * lines are shown as one replacement. */
#include "diff.h"

#include "message.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CONTEXT = 3, EDIT_LIMIT = 1024 };

typedef struct Line {
    const char *text;
    size_t size;
    bool open; /* the last one, without a line feed */
} Line;

typedef struct Lines {
    Line *items;
    int count;
    bool *changed; /* removed from the old, or added in the new */
} Lines;

static bool split(const CliContent *bytes, Lines *lines) {
    size_t count = 0;
    for (size_t i = 0; i < bytes->size; i++) count += bytes->data[i] == '\n';
    lines->items = malloc((count + 1) * sizeof *lines->items);
    lines->changed = calloc(count + 1, sizeof *lines->changed);
    lines->count = 0;
    if (lines->items == NULL || lines->changed == NULL) return false;
    for (size_t i = 0; i < bytes->size;) {
        const char *end = memchr(bytes->data + i, '\n', bytes->size - i);
        size_t size = end != NULL ? (size_t)(end - bytes->data) - i : bytes->size - i;
        lines->items[lines->count++] = (Line){bytes->data + i, size, end == NULL};
        i += size + 1;
    }
    return true;
}

static void free_lines(Lines *lines) {
    free(lines->items);
    free(lines->changed);
}

static bool same(const Lines *old, int i, const Lines *new, int j) {
    const Line *a = &old->items[i], *b = &new->items[j];
    return a->size == b->size && a->open == b->open && memcmp(a->text, b->text, a->size) == 0;
}

/* ---------------------------------------------------------------- the shortest list of edits */

/* The part that differs: lines [first, old_end) of the old and [first, new_end) of the new. */
typedef struct Middle {
    const Lines *old, *new;
    int first, old_count, new_count;
} Middle;

static int slide(const Middle *m, int x, int y) {
    while (
        x < m->old_count && y < m->new_count && same(m->old, m->first + x, m->new, m->first + y)) {
        x++;
        y++;
    }
    return x;
}

/* reach[d * stride + limit + k]: the old line that d edits reach on diagonal k = x - y. */
static int find_edits(const Middle *m, int *reach, int limit) {
    int stride = 2 * limit + 1;
    for (int d = 0; d <= limit; d++) {
        int *now = reach + (size_t)d * (size_t)stride + limit;
        const int *before = d > 0 ? now - stride : now;
        for (int k = -d; k <= d; k += 2) {
            int x = 0;
            if (d > 0) {
                bool down = k == -d || (k != d && before[k - 1] < before[k + 1]);
                x = down ? before[k + 1] : before[k - 1] + 1;
            }
            now[k] = slide(m, x, x - k);
            if (now[k] >= m->old_count && now[k] - k >= m->new_count) return d;
        }
    }
    return -1;
}

static void mark_edits(const Middle *m, const int *reach, int limit, int edits) {
    int stride = 2 * limit + 1, k = m->old_count - m->new_count;
    for (int d = edits; d > 0; d--) {
        const int *before = reach + (size_t)(d - 1) * (size_t)stride + limit;
        bool down = k == -d || (k != d && before[k - 1] < before[k + 1]);
        k += down ? 1 : -1;
        int x = before[k], y = x - k;
        if (down && y < m->new_count) m->new->changed[m->first + y] = true;
        if (!down && x < m->old_count) m->old->changed[m->first + x] = true;
    }
}

static bool compare(Lines *old, Lines *new) {
    Middle m = {.old = old, .new = new};
    int old_end = old->count, new_end = new->count;
    while (m.first < old_end && m.first < new_end && same(old, m.first, new, m.first)) m.first++;
    while (old_end > m.first && new_end > m.first && same(old, old_end - 1, new, new_end - 1)) {
        old_end--;
        new_end--;
    }
    m.old_count = old_end - m.first;
    m.new_count = new_end - m.first;
    /* More and more edits are tried, since the table grows with their square. */
    int all = m.old_count + m.new_count;
    for (int limit = 64;; limit *= 4) {
        if (limit > all) limit = all;
        if (limit > EDIT_LIMIT) break;
        size_t rows = (size_t)limit + 1;
        int *reach = calloc(rows * (2 * rows), sizeof *reach);
        if (reach == NULL) return false;
        int edits = find_edits(&m, reach, limit);
        if (edits >= 0) mark_edits(&m, reach, limit, edits);
        free(reach);
        if (edits >= 0) return true;
    }
    for (int i = 0; i < m.old_count; i++) old->changed[m.first + i] = true;
    for (int i = 0; i < m.new_count; i++) new->changed[m.first + i] = true;
    return true;
}

/* ---------------------------------------------------------------- printing */

static void print_line(const char *mark, const Line *line) {
    bool colour = cli_message_output_in_colour() && mark[0] != ' ';
    if (colour) fputs(mark[0] == '-' ? "\033[31m" : "\033[32m", stdout);
    fputs(mark, stdout);
    for (size_t i = 0; i < line->size; i++) {
        unsigned char byte = (unsigned char)line->text[i];
        bool harmful = (byte < 0x20 && byte != '\t') || byte == 0x7f;
        putchar(harmful && cli_message_output_in_colour() ? '?' : byte);
    }
    if (colour) fputs("\033[0m", stdout);
    putchar('\n');
    if (line->open) puts("\\ No newline at end of file");
}

/* From old line i and new line j on: the same, until the end of a change's context. Prints one hunk
 * and moves both behind it. */
static void print_hunk(const Lines *old, const Lines *new, int *i, int *j) {
    int x = *i, y = *j, quiet = 0;
    while ((x < old->count || y < new->count) && quiet <= 2 * CONTEXT) {
        bool minus = x < old->count && old->changed[x], plus = y < new->count &&new->changed[y];
        quiet = minus || plus ? 0 : quiet + 1;
        x += minus || !plus;
        y += !minus;
    }
    int spare = quiet > CONTEXT ? quiet - CONTEXT : 0;
    x -= spare;
    y -= spare;
    printf("@@ -%d,%d +%d,%d @@\n", x > *i ? *i + 1 : *i, x - *i, y > *j ? *j + 1 : *j, y - *j);
    while (*i < x || *j < y) {
        if (*i < x && old->changed[*i]) {
            print_line("-", &old->items[(*i)++]);
        } else if (*j < y && new->changed[*j]) {
            print_line("+", &new->items[(*j)++]);
        } else {
            print_line(" ", &old->items[*i]);
            ++*i;
            ++*j;
        }
    }
}

static void print(const char *name, const Lines *old, const Lines *new) {
    printf("--- %s\n+++ %s\n", name, name);
    for (int i = 0, j = 0; i < old->count || j < new->count;) {
        bool change = (i < old->count && old->changed[i]) || (j < new->count &&new->changed[j]);
        if (!change) {
            /* A hunk begins with the context of the change that comes next. */
            int ahead = 0;
            while (ahead <= CONTEXT && i + ahead < old->count && j + ahead < new->count &&
                   !old->changed[i + ahead] && !new->changed[j + ahead]) {
                ahead++;
            }
            bool ends = i + ahead == old->count && j + ahead == new->count;
            if (ends) return;
            if (ahead > CONTEXT) {
                i++;
                j++;
                continue;
            }
        }
        print_hunk(old, new, &i, &j);
    }
}

CliStatus cli_diff_print(
    const char *name, const CliContent *old_bytes, const CliContent *new_bytes) {
    if (cli_content_equal(old_bytes, new_bytes)) return CLI_OK;
    Lines old = {0}, new = {0};
    CliStatus status = CLI_OK;
    if (!split(old_bytes, &old) || !split(new_bytes, &new) || !compare(&old, &new)) {
        cli_message_error("%s", glint_status_text(GLINT_ERROR_MEMORY));
        status = CLI_MACHINE;
    } else {
        print(name, &old, &new);
    }
    free_lines(&old);
    free_lines(&new);
    return status;
}
