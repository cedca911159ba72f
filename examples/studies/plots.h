/* plots.h - several plots in one picture, as the studies draw their results. SPDX-License-Identifier: MIT */
#ifndef PLOTS_H
#define PLOTS_H

#include "mpm_draw.h"
#include "mpm_io.h"

static inline mpm_draw_curve plot_curve(const char *name, const mpm_real *x, const mpm_real *y, size_t count,
                                        mpm_draw_mark mark, int color)
{
    mpm_draw_curve c;
    c.name = name;
    c.count = count;
    c.x = x;
    c.y = y;
    c.mark = mark;
    c.color = color;
    return c;
}

/* Linear axes, fitted. */
static inline mpm_draw_plot_desc plot_of(const char *title, const char *x_label, const char *y_label,
                                         const mpm_draw_curve *curves, int count)
{
    mpm_draw_plot_desc d = mpm_draw_plot_desc_default();
    d.title = title;
    d.x_label = x_label;
    d.y_label = y_label;
    d.curves = curves;
    d.curve_count = count;
    return d;
}

/* `count` plots in one picture, each 620 pixels wide. */
static inline mpm_status plots_png(const char *path, const mpm_draw_plot_desc *d, int count, int columns, int height,
                                   const char *note, mpm_fault *fault)
{
    mpm_draw_canvas canvas;
    const int rows = (count + columns - 1) / columns;
    int k;
    mpm_status status = mpm_draw_canvas_init(&canvas, 620 * columns, height * rows, NULL, 0);
    for (k = 0; k < count && status >= 0; k++)
        status = mpm_draw_plot(&canvas, mpm_draw_tile(&canvas, columns, rows, k), &d[k], fault);
    if (status >= 0) status = mpm_io_png(path, canvas.rgb, canvas.width, canvas.height, note, fault);
    mpm_draw_canvas_free(&canvas);
    return status;
}

#endif
