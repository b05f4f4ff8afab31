/* SPDX-License-Identifier: MIT
 * The files of results: a line about the machine that begins with "# ", the names of the columns,
 * and rows of numbers and plain words. The first column is the scene, the last one the date. */
#pragma once

#include <stdbool.h>

typedef struct Table {
    char head[512]; /* without "# " */
    int column_count, row_count;
    char (*cells)[32]; /* the names of the columns, then row after row */
} Table;

/* False: there is no such file, or it holds something else. */
bool table_read(const char *path, Table *table);
void table_free(Table *table);

/* Empty, or 0, where there is no such column. */
const char *table_text(const Table *table, int row, const char *column);
double table_number(const Table *table, int row, const char *column);

/* Writes the head and the rows (a text, the names of the columns its first line). keep: rows that
 * the file has of other scenes stay, behind the new ones, unless their columns are others. A
 * failure ends the program. */
void table_save(const char *path, const char *head, const char *rows, bool keep);

/* "2031-04-30", today. */
enum { DATE_SIZE = 11 };
void table_date(char text[DATE_SIZE]);
