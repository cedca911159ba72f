/* sweep_table.h - a table of tasks: a CSV file whose first line names the columns. SPDX-License-Identifier: MIT */
#ifndef SWEEP_TABLE_H
#define SWEEP_TABLE_H

#include "program.h"

typedef struct table {
    char *text;        /* the file, cut into cells */
    char **cell;       /* row by row */
    int *line;         /* of the file, in which a row stands */
    int rows, columns; /* row 0: the names */
} table;

static inline void table_free(table *t)
{
    free(t->text);
    free(t->cell);
    free(t->line);
    memset(t, 0, sizeof *t);
}

static inline const char *table_cell(const table *t, int row, int column)
{
    return t->cell[(size_t)row * (size_t)t->columns + (size_t)column];
}

/* The column of that name, or -1. */
static inline int table_column(const table *t, const char *name)
{
    int k = 0;
    while (k < t->columns && strcmp(table_cell(t, 0, k), name)) k++;
    return k < t->columns ? k : -1;
}

/* All of a file, to be freed; NULL if it cannot be read or holds a zero. */
static inline char *table_text(const char *path)
{
    FILE *f = fopen(path, "rb");
    const long n = f && fseek(f, 0, SEEK_END) == 0 ? ftell(f) : -1;
    char *text = n >= 0 && fseek(f, 0, SEEK_SET) == 0 ? (char *)malloc((size_t)n + 1) : NULL;
    const int whole = text && fread(text, 1, (size_t)n, f) == (size_t)n;
    if (f) fclose(f);
    if (text) text[whole ? n : 0] = 0;
    if (whole && strlen(text) == (size_t)n) return text;
    free(text);
    return NULL;
}

/* Takes the words of a quoted cell, "" for ", to where it began. Returns what stands behind it; NULL if the quote is
   not closed on its line. */
static inline char *table_unquote(char *p, char **end)
{
    char *to = p++;
    while (*p != '"' || p[1] == '"') {
        if (!*p || *p == '\n') return NULL;
        p += *p == '"';
        *to++ = *p++;
    }
    *end = to;
    p++;
    return p + strspn(p, " \t");
}

/* Cuts the next cell out, blanks at its ends left out. Returns what ends it: a comma, '\n', 0, or -1 if it is none. */
static inline int table_cut(char **at, char **cell)
{
    char *p = *at + strspn(*at, " \t"), *end, by;
    *cell = p;
    if (*p == '"') {
        p = table_unquote(p, &end);
        if (!p) return -1;
    } else {
        end = p += strcspn(p, ",\r\n");
        while (end > *cell && strchr(" \t", end[-1])) end--;
    }
    p += *p == '\r';
    by = *p;
    *at = p + (by != 0);
    *end = 0;
    return !by || strchr(",\n", by) ? by : -1;
}

/* The next row, in line `line`. Returns 1, or 0 after a message. */
static inline int table_row(table *t, const char *path, char **at, int line)
{
    const size_t first = (size_t)t->rows * (size_t)t->columns;
    int n = 0, by;
    do {
        char *cell;
        by = table_cut(at, &cell);
        if (by < 0) return fprintf(stderr, "error: %s, line %d: cell %d is no CSV\n", path, line, n + 1), 0;
        if (t->rows == 0 || n < t->columns) t->cell[first + (size_t)n] = cell;
        n++;
    } while (by == ',');
    if (t->rows == 0) t->columns = n;
    t->line[t->rows++] = line;
    if (n == t->columns) return 1;
    fprintf(stderr, "error: %s, line %d: %d cells, the first row has %d\n", path, line, n, t->columns);
    return 0;
}

/* Reads a table; empty lines and those that begin with # are left out. Returns 1, or 0 after a message. */
static inline int table_read(table *t, const char *path)
{
    size_t commas = 0, lines = 1;
    char *at;
    int line, good = 1;
    memset(t, 0, sizeof *t);
    t->text = table_text(path);
    if (!t->text) return fprintf(stderr, "error: %s cannot be read\n", path), 0;
    for (at = t->text; *at; at++) commas += *at == ',', lines += *at == '\n';
    t->cell = (char **)malloc((commas + lines) * sizeof *t->cell);
    t->line = (int *)malloc(lines * sizeof *t->line);
    if (!t->cell || !t->line) return complain("no memory for the table");
    at = t->text + 3 * !strncmp(t->text, "\xef\xbb\xbf", 3); /* how some spreadsheets begin */
    for (line = 1; *at && good; line++) {
        const size_t length = strcspn(at, "\n");
        if (*at == '#' || strspn(at, " \t\r") == length) at += length + (at[length] != 0);
        else good = table_row(t, path, &at, line);
    }
    if (good && t->rows < 2) return fprintf(stderr, "error: %s has no task\n", path), 0;
    return good;
}

#endif
