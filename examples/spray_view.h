/* spray_view.h - pictures of a spray, shared by spray.c and spray_study.c: the plume from the side
   and the deposit from above. SPDX-License-Identifier: MIT */
#ifndef SPRAY_VIEW_H
#define SPRAY_VIEW_H

#include "mpm_draw.h"
#include "mpm_spray.h"

#include <stdlib.h>

/* Columns for pictures and files: room for every particle of one spray. */
typedef struct spray_columns {
    mpm_real *memory, *column[9];
    int32_t *state;
    size_t room;
} spray_columns;

static inline int spray_columns_init(spray_columns *c, size_t room)
{
    int k;
    c->room = room;
    c->memory = (mpm_real *)malloc((room + 1) * 9 * sizeof(mpm_real));
    c->state = (int32_t *)malloc((room + 1) * sizeof(int32_t));
    for (k = 0; k < 9 && c->memory; k++) c->column[k] = c->memory + (size_t)k * room;
    return c->memory && c->state ? 0 : -1;
}

static inline void spray_columns_free(spray_columns *c)
{
    free(c->memory);
    free(c->state);
}

static inline mpm_real spray_speed(const mpm_spray *s, int32_t i)
{
    const mpm_real *v = s->v + 3 * i;
    return (mpm_real)sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
}

/* The plume: along the jet to the right, y upwards [mm], coloured by speed up to `fastest`. */
static inline mpm_status spray_draw_plume(mpm_draw_canvas *canvas, mpm_draw_rect where, const mpm_spray *s,
                                          spray_columns *c, double fastest, const char *title, mpm_fault *fault)
{
    mpm_draw_scatter_desc d = mpm_draw_scatter_desc_default();
    int32_t i, n = 0;
    for (i = 0; i < s->live; i++, n++) {
        c->column[0][n] = s->x[3 * i] * 1000;
        c->column[1][n] = s->x[3 * i + 1] * 1000;
        c->column[2][n] = spray_speed(s, i);
    }
    for (i = 0; i < s->deposited; i++, n++) {
        c->column[0][n] = s->deposit_x[3 * i] * 1000;
        c->column[1][n] = s->deposit_x[3 * i + 1] * 1000;
        c->column[2][n] = 0;
    }
    d.count = (size_t)n;
    d.x = c->column[0];
    d.y = c->column[1];
    d.value = c->column[2];
    d.dot = 2.5;
    d.window[0] = (double)s->desc.low[0] * 1000;
    d.window[1] = (double)s->plane[0].point[0] * 1000 + 5;
    d.window[2] = (double)s->desc.low[1] * 1000;
    d.window[3] = (double)s->desc.high[1] * 1000;
    d.low = 0;
    d.high = fastest;
    d.map = MPM_DRAW_DEEP;
    d.label = "speed, m/s";
    d.title = title;
    d.x_label = "x, mm";
    d.y_label = "y, mm";
    return mpm_draw_scatter(canvas, where, &d, fault);
}

/* The deposit: y to the right, z upwards [mm], every particle at its true size, coloured by the
   time of its arrival [ms]; `half` is half the window [mm]. */
static inline mpm_status spray_draw_deposit(mpm_draw_canvas *canvas, mpm_draw_rect where, const mpm_spray *s,
                                            spray_columns *c, double half, const char *title, mpm_fault *fault)
{
    mpm_draw_scatter_desc d = mpm_draw_scatter_desc_default();
    int32_t i;
    for (i = 0; i < s->deposited; i++) {
        c->column[0][i] = s->deposit_x[3 * i + 1] * 1000;
        c->column[1][i] = s->deposit_x[3 * i + 2] * 1000;
        c->column[2][i] = s->deposit_time[i] * 1000;
        c->column[3][i] = s->deposit_radius[i] * 2000;
    }
    d.count = (size_t)s->deposited;
    d.x = c->column[0];
    d.y = c->column[1];
    d.value = c->column[2];
    d.size = c->column[3];
    d.window[0] = d.window[2] = -half;
    d.window[1] = d.window[3] = half;
    d.low = 0;
    d.high = (double)mpm_spray_time(s) * 1000;
    d.map = MPM_DRAW_HEAT;
    d.label = "arrival, ms";
    d.title = title;
    d.x_label = "y, mm";
    d.y_label = "z, mm";
    return mpm_draw_scatter(canvas, where, &d, fault);
}

#endif
