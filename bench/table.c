/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "table.h"

#include "message.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LINE_SIZE = 2048 };

/* ---------------------------------------------------------------- reading */

/* Takes the cells of a line; whether there are as many as columns. */
static bool take_line(Table *table, const char *line) {
    size_t row_size = (size_t)table->column_count * sizeof table->cells[0];
    size_t end = (size_t)(table->row_count + 2) * row_size; /* the names count, too */
    void *cells = realloc(table->cells, end);
    if (cells == NULL) message_fail("not enough memory");
    table->cells = cells;
    int first = (table->row_count + 1) * table->column_count;
    for (int i = 0; i < table->column_count; i++) {
        size_t length = strcspn(line, ",");
        message_format(table->cells[first + i], sizeof table->cells[0], "%.*s", (int)length, line);
        line += length;
        bool last = i == table->column_count - 1;
        if (last != (*line == '\0')) return false;
        line += !last;
    }
    return true;
}

static bool read_line(FILE *file, char line[LINE_SIZE]) {
    if (fgets(line, LINE_SIZE, file) == NULL) return false;
    line[strcspn(line, "\r\n")] = '\0';
    return true;
}

bool table_read(const char *path, Table *table) {
    char line[LINE_SIZE];
    memset(table, 0, sizeof *table);
    FILE *file = fopen(path, "r");
    if (file == NULL) return false;
    bool good = read_line(file, line) && strncmp(line, "# ", 2) == 0;
    if (good) message_format(table->head, sizeof table->head, "%s", line + 2);
    good = good && read_line(file, line);
    table->row_count = -1;
    if (good) {
        table->column_count = 1;
        for (const char *c = line; *c != '\0'; c++) table->column_count += *c == ',';
        good = take_line(table, line);
    }
    for (table->row_count = 0; good && read_line(file, line); table->row_count++) {
        good = take_line(table, line);
    }
    fclose(file);
    if (!good) table_free(table);
    return good;
}

void table_free(Table *table) {
    free(table->cells);
    memset(table, 0, sizeof *table);
}

const char *table_text(const Table *table, int row, const char *column) {
    for (int i = 0; i < table->column_count; i++) {
        if (strcmp(table->cells[i], column) != 0) continue;
        return table->cells[(row + 1) * table->column_count + i];
    }
    return "";
}

double table_number(const Table *table, int row, const char *column) {
    return strtod(table_text(table, row, column), NULL);
}

/* ---------------------------------------------------------------- writing */

/* Whether a row is about the same scene as the line. */
static bool has_scene(const char *rows, const char *line) {
    size_t length = strcspn(line, ",") + 1;
    for (const char *row = rows; row != NULL; row = strchr(row, '\n')) {
        row += *row == '\n';
        if (strncmp(row, line, length) == 0) return true;
    }
    return false;
}

/* A text of the lines that stay; the caller frees it. */
static char *old_rows(const char *path, const char *rows) {
    char line[LINE_SIZE], *text = NULL;
    size_t size;
    FILE *from = fopen(path, "r"), *to = open_memstream(&text, &size);
    if (to == NULL) message_fail("not enough memory");
    bool same = from != NULL && fgets(line, sizeof line, from) != NULL &&
                fgets(line, sizeof line, from) != NULL && strncmp(rows, line, strlen(line)) == 0;
    while (same && fgets(line, sizeof line, from) != NULL) {
        if (!has_scene(rows, line)) fputs(line, to);
    }
    if (from != NULL) fclose(from);
    if (fclose(to) != 0) message_fail("not enough memory");
    return text;
}

void table_save(const char *path, const char *head, const char *rows, bool keep) {
    char *kept = keep ? old_rows(path, rows) : NULL;
    FILE *file = fopen(path, "w");
    if (file == NULL) message_fail("%s cannot be written", path);
    fprintf(file, "# %s\n%s%s", head, rows, kept != NULL ? kept : "");
    free(kept);
    bool good = !ferror(file);
    if (fclose(file) != 0 || !good) message_fail("%s cannot be written", path);
}

void table_date(char text[DATE_SIZE]) {
    time_t now = time(NULL);
    struct tm date;
    if (gmtime_r(&now, &date) == NULL || strftime(text, DATE_SIZE, "%Y-%m-%d", &date) == 0) {
        text[0] = '\0';
    }
}
