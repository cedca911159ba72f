/* history.h - what a run was like while it went: a table in memory, a row every so many steps, from which history.csv
   and history.png are made.

   A program describes its columns once, then
       history_begin(&h, column, columns, steps);       two hundred rows of a run of that many steps
       if (history_due(&h, step, steps)) { row = history_row(&h, step); row[0] = ... }  before a step, after the last
       history_csv(&h, folder) && history_png(&h, folder, panel, panels, title)
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
    int open;                /* 1: the end is not known. When the table is full every second row goes */
    int64_t every, next;     /* steps from one row to the next; the step of the next */
    int64_t rows;
    double row[HISTORY_ROWS + 1][HISTORY_COLUMNS];
} history;

/* No rows yet, of a run of that many steps; 0: of as many as will come. Test: 67_history. */
static inline void history_begin(history *h, const history_column *column, int columns, int64_t steps)
{
    memset(h, 0, sizeof *h);
    h->column = column;
    h->columns = columns;
    h->open = steps == 0;
    h->every = (steps + HISTORY_ROWS - 1) / HISTORY_ROWS;
    if (h->every < 1) h->every = 1;
}

/* Leaves every second row, from the first on. */
static inline void history_thin(history *h)
{
    int64_t i;
    for (i = 1; 2 * i < h->rows; i++) memcpy(h->row[i], h->row[2 * i], sizeof h->row[i]);
    h->rows = i;
    h->next += h->every;
    h->every *= 2;
}

/* Whether a row is due after so many steps: every so often and, where the end is known, of that. Test: 67_history. */
static inline int history_due(history *h, int64_t step, int64_t steps)
{
    if (h->open && h->rows > HISTORY_ROWS) history_thin(h);
    if (h->open) return step >= h->next;
    return h->rows <= HISTORY_ROWS && (step >= h->next || (step >= steps && step + h->every > h->next));
}

/* The next row, to be filled, of the state after so many steps: all zero. Test: 67_history. */
static inline double *history_row(history *h, int64_t step)
{
    h->next = step + h->every;
    memset(h->row[h->rows], 0, sizeof h->row[0]); /* thinning leaves what was there */
    return h->row[h->rows++];
}

/* Rate of change of a column since the row before the one being filled, per unit of time; 0 in the first. Where rows
   are thinned out it is no longer that of the row before. */
static inline double history_rate(const history *h, int column)
{
    const double *now = h->row[h->rows - 1], *then = h->row[h->rows < 2 ? 0 : h->rows - 2];
    return now[0] > then[0] ? (now[column] - then[column]) / (now[0] - then[0]) : 0;
}

/* All that a checkpoint keeps of it. */
#define HISTORY_BLOBS 4
static inline int history_blobs(history *h, mpm_blob *blob)
{
    blob[0] = mpm_blob_of("history rows", &h->rows, sizeof h->rows);
    blob[1] = mpm_blob_of("history next", &h->next, sizeof h->next);
    blob[2] = mpm_blob_of("history every", &h->every, sizeof h->every);
    blob[3] = mpm_blob_of("history", h->row, sizeof h->row);
    return HISTORY_BLOBS;
}

/* Whether what was read of a checkpoint can be. */
static inline int history_whole(const history *h)
{
    return h->rows >= 0 && h->rows <= HISTORY_ROWS + 1 && h->next >= 0 && h->every >= 1;
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

/* ---- measures of a world ----------------------------------------------------------------------- */

/* Sum of m (v - mean)^2 of a body, along z. */
static inline double history_spread(const mpm_world *w, int32_t body, double mean)
{
    const mpm_body *b = &w->body[body];
    double sum = 0;
    int32_t i;
    for (i = b->first; i < b->first + b->count; i++) {
        const double v = (double)w->points.v[2][i] - mean;
        sum += (double)w->points.mass[i] * v * v;
    }
    return sum;
}

/* Pressure and von Mises' equivalent stress of a point. */
static inline double point_pressure(const mpm_points *p, int32_t i)
{
    return -((double)p->stress[0][i] + (double)p->stress[1][i] + (double)p->stress[2][i]) / 3;
}

static inline double point_mises(const mpm_points *p, int32_t i)
{
    const double xx = (double)p->stress[0][i], yy = (double)p->stress[1][i], zz = (double)p->stress[2][i];
    const double yz = (double)p->stress[3][i], xz = (double)p->stress[4][i], xy = (double)p->stress[5][i];
    return sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) / 2 +
                3 * (yz * yz + xz * xz + xy * xy));
}

/* The largest of all points: equivalent stress, and pressure, at least 0. */
static inline void history_stress(const mpm_points *p, double *mises, double *pressure)
{
    int32_t i;
    *mises = *pressure = 0;
    for (i = 0; i < p->count; i++) {
        const double stress = point_mises(p, i), deep = point_pressure(p, i);
        if (stress > *mises) *mises = stress;
        if (deep > *pressure) *pressure = deep;
    }
}

/* ---- the picture ----------------------------------------------------------------------------- */

/* Curves that share axes: up to HISTORY_CURVES columns of one unit, ended by -1. */
#define HISTORY_CURVES 8
typedef struct history_panel {
    const char *title;
    int column[HISTORY_CURVES + 1];
} history_panel;

/* The largest value of a column, whatever its sign. */
static inline double history_most(const history *h, int column)
{
    double most = 0;
    int64_t i;
    for (i = 0; i < h->rows; i++) most = fmax(most, fabs(h->row[i][column]));
    return most;
}

/* "v mean" of v_mean; "kinetic" of energy_kinetic in a panel called energy. */
static inline const char *history_name(const char *name, const char *title, char text[HISTORY_KEY])
{
    const size_t n = strlen(title);
    char *at;
    snprintf(text, HISTORY_KEY, "%s", !strncmp(name, title, n) && name[n] == '_' ? name + n + 1 : name);
    for (at = text; *at; at++)
        if (*at == '_') *at = ' ';
    return text;
}

/* Whether a curve of a panel can be told from zero: of those that cannot, one is drawn if all are so. */
static inline int history_shows(const history *h, const history_panel *p, int curve)
{
    double most = 0;
    int k;
    for (k = 0; p->column[k] >= 0; k++) most = fmax(most, history_most(h, p->column[k]));
    return history_most(h, p->column[curve]) > 1e-6 * most || (curve == 0 && !(most > 0));
}

/* One panel. y: room for all its curves. */
static inline mpm_status history_panel_draw(const history *h, const history_panel *p, const char *note,
                                            mpm_draw_canvas *c, mpm_draw_rect where, const mpm_real *x, mpm_real *y,
                                            mpm_fault *fault)
{
    char name[HISTORY_CURVES][HISTORY_KEY], label[40];
    mpm_draw_curve curve[HISTORY_CURVES];
    mpm_draw_plot_desc d = mpm_draw_plot_desc_default();
    int64_t i;
    int k, n = 0;
    for (k = 0; p->column[k] >= 0; k++) {
        if (!history_shows(h, p, k)) continue;
        for (i = 0; i < h->rows; i++) y[i] = (mpm_real)h->row[i][p->column[k]];
        curve[n].name = p->column[1] < 0 ? NULL : history_name(h->column[p->column[k]].name, p->title, name[n]);
        curve[n].count = (size_t)h->rows;
        curve[n].x = x;
        curve[n].y = y;
        curve[n].mark = MPM_DRAW_CURVE;
        curve[n++].color = k;
        y += h->rows;
    }
    snprintf(label, sizeof label, "%s (%s)", h->column[0].name, h->column[0].unit);
    d.curves = curve;
    d.curve_count = n;
    d.title = p->title;
    d.note = note;
    d.x_label = label;
    d.y_label = h->column[p->column[0]].unit;
    return mpm_draw_plot(c, where, &d, fault);
}

/* Writes folder/history.png: the panels, two beside each other; what the run was goes into the first. Without two rows
   there is none. Test: 67_history. */
static inline int history_png(const history *h, const char *folder, const history_panel *panel, int panels,
                              const char *title)
{
    const size_t room = (size_t)h->rows * (HISTORY_CURVES + 1);
    mpm_real *x = h->rows < 2 ? NULL : (mpm_real *)malloc(room * sizeof *x);
    const int high = (panels + 1) / 2;
    mpm_status status;
    mpm_draw_canvas c;
    char path[PATH_BYTES];
    mpm_fault fault;
    int64_t i;
    int k;
    if (h->rows < 2) return 1;
    if (!x || mpm_draw_canvas_init(&c, 1500, 440 * high, NULL, 0) < 0)
        return free(x), complain("no memory: history.png");
    for (i = 0; i < h->rows; i++) x[i] = (mpm_real)h->row[i][0];
    for (status = MPM_OK, k = 0; k < panels && status >= 0; k++)
        status = history_panel_draw(h, &panel[k], k ? NULL : title, &c, mpm_draw_tile(&c, 2, high, k), x, x + h->rows,
                                    &fault);
    file_in(folder, "history.png", path, sizeof path);
    if (status >= 0) status = mpm_io_png(path, c.rgb, c.width, c.height, title, &fault);
    mpm_draw_canvas_free(&c);
    free(x);
    return status >= 0 || report(&fault, path);
}

#endif
