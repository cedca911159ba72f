/* history.h - what a run was like while it went: a table in memory, a row every so many steps, from which history.csv
   and history.png are made.

   A program describes its columns once, then
       history_begin(&h, column, columns, steps);       two hundred rows of a run of that many steps
       if (history_due(&h, step, steps)) { row = history_row(&h); row[0] = ... }   before a step, and after the last
       history_csv(&h, folder, &fault); history_png(&h, folder, ...);
   Who reads it takes h.row[i][k] of row i < h.rows and column k < h.columns, with h.column[k].name and .unit.
   Column 0 is the time. A checkpoint keeps it by history_blobs: a run that goes on ends with the rows of one that was
   never stopped.
   Columns of impacts and how they are filled: impact_history.h. SPDX-License-Identifier: MIT */
#ifndef HISTORY_H
#define HISTORY_H

#include "mpm.h"
#include "mpm_draw.h"
#include "mpm_io.h"
#include "program.h"

#include <string.h>

#define HISTORY_ROWS 200    /* about as many of a run */
#define HISTORY_COLUMNS 24  /* at most */

typedef struct history_column {
    const char *name, *unit; /* "energy_kinetic" and "pJ": the key of the table is energy_kinetic_pJ; unit "": none */
    const char *about;       /* in words */
} history_column;

/* A line of a list X(constant, "name", "unit", "about") as such a column, and as a number of it. */
#define HISTORY_COLUMN(constant, name, unit, about) {name, unit, about},
#define HISTORY_NUMBER(constant, name, unit, about) constant,

typedef struct history {
    const history_column *column;
    int columns;
    int64_t every, next;     /* steps from one row to the next; the step of the next */
    int64_t rows;
    double row[HISTORY_ROWS + 1][HISTORY_COLUMNS];
} history;

/* No rows yet, of a run of that many steps. Test: 67_history. */
static inline void history_begin(history *h, const history_column *column, int columns, int64_t steps)
{
    memset(h, 0, sizeof *h);
    h->column = column;
    h->columns = columns;
    h->every = (steps + HISTORY_ROWS - 1) / HISTORY_ROWS;
    if (h->every < 1) h->every = 1;
}

/* Whether a row is due after so many steps: every so often, and of the end. Test: 67_history. */
static inline int history_due(const history *h, int64_t step, int64_t steps)
{
    return h->rows <= HISTORY_ROWS && (step >= h->next || (step >= steps && step + h->every > h->next));
}

/* The next row, to be filled, of the state after so many steps: all zero. Test: 67_history. */
static inline double *history_row(history *h, int64_t step)
{
    h->next = step + h->every;
    return h->row[h->rows++];
}

/* Rate of change of a column since the row before the one being filled, per unit of time; 0 in the first. */
static inline double history_rate(const history *h, int column)
{
    const double *now = h->row[h->rows - 1], *then = h->row[h->rows < 2 ? 0 : h->rows - 2];
    return now[0] > then[0] ? (now[column] - then[column]) / (now[0] - then[0]) : 0;
}

/* All that a checkpoint keeps of it. */
#define HISTORY_BLOBS 3
static inline int history_blobs(history *h, mpm_blob *blob)
{
    blob[0] = mpm_blob_of("history rows", &h->rows, sizeof h->rows);
    blob[1] = mpm_blob_of("history next", &h->next, sizeof h->next);
    blob[2] = mpm_blob_of("history", h->row, sizeof h->row);
    return HISTORY_BLOBS;
}

/* Whether what was read of a checkpoint can be. */
static inline int history_whole(const history *h)
{
    return h->rows >= 0 && h->rows <= HISTORY_ROWS + 1 && h->next >= 0;
}

/* The key of a column: "v_mean_m_s" of v_mean in m/s. */
#define HISTORY_KEY 64
static inline const char *history_key(const history_column *c, char key[HISTORY_KEY])
{
    char *at;
    snprintf(key, HISTORY_KEY, "%s%s%s", c->name, *c->unit ? "_" : "", c->unit);
    for (at = key; *at; at++)
        if (*at == '/' || *at == ' ') *at = '_';
    return key;
}

/* Writes folder/history.csv. Returns 1, or 0 after a message, as all that write. Test: 67_history. */
static inline int history_csv(const history *h, const char *folder)
{
    char head[HISTORY_COLUMNS * HISTORY_KEY], key[HISTORY_KEY], path[PATH_BYTES];
    size_t used = 0;
    mpm_fault fault;
    mpm_io_csv t;
    int64_t i;
    int k;
    for (k = 0; k < h->columns; k++) {
        if (k) used = mpm_append(head, sizeof head, used, ",");
        used = mpm_append(head, sizeof head, used, history_key(&h->column[k], key));
    }
    mpm_io_csv_begin(&t, file_in(folder, "history.csv", path, sizeof path), head, NULL, &fault);
    for (i = 0; i < h->rows; i++)
        for (k = 0; k < h->columns; k++) mpm_io_csv_real(&t, (mpm_real)h->row[i][k]);
    return mpm_io_csv_end(&t, &fault) >= 0 || report(&fault, path);
}

#endif
