/* page.c - the page under way, and the folder of tables and pictures. SPDX-License-Identifier: MIT */
#include "reproduction.h"

#include <stdarg.h>

/* ---- the page ------------------------------------------------------------------------------ */

void say(work *w, const char *format, ...)
{
    va_list list;
    int n;
    va_start(list, format);
    n = vsnprintf(w->text + w->used, w->room - w->used, format, list);
    va_end(list);
    if (n > 0) w->used += (size_t)n < w->room - w->used ? (size_t)n : w->room - w->used - 1;
}

void say_velocity(work *w, double v, double high)
{
    if (v < HUGE_VAL) say(w, "%.0f", v);
    else say(w, "none up to %.0f", high);
}

void say_measure(work *w, double v)
{
    if (fabs(v) < HUGE_VAL) say(w, "%.2f", v);
    else say(w, "-");
}

int failed(work *w)
{
    mpm_io_fault_text(w->message, sizeof w->message, &w->fault);
    return 0;
}

#define BEGIN_MARK "<!-- made by build/reproduction: begin -->\n"
#define END_MARK "<!-- made by build/reproduction: end -->\n"

/* The old page, with the new part in the place of the one before or at its end. */
static void put_page(mpm_io_file *f, const work *w, const char *old)
{
    const char *from = strstr(old, BEGIN_MARK), *to = from ? strstr(from, END_MARK) : NULL;
    mpm_io_put_bytes(f, old, to ? (size_t)(from - old) : strlen(old));
    if (!to) mpm_io_put(f, "\n");
    mpm_io_put(f, BEGIN_MARK);
    mpm_io_put(f, w->text);
    mpm_io_put(f, END_MARK);
    if (to) mpm_io_put(f, to + strlen(END_MARK));
}

int write_page(work *w)
{
    static char old[400000];
    mpm_io_file f;
    if (!text_read(w->page, old, sizeof old)) {
        snprintf(w->message, sizeof w->message, "%.300s: cannot be read, or is longer than %lu characters", w->page,
                 (unsigned long)sizeof old - 1);
        return 0;
    }
    if (mpm_io_open(&f, w->page, &w->fault) < 0) return failed(w);
    put_page(&f, w, old);
    return mpm_io_close(&f, &w->fault) >= 0 || failed(w);
}

/* ---- the data folder ------------------------------------------------------------------------- */

const char *data_file(const work *w, const char *name, char *path, size_t n) { return file_in(w->data, name, path, n); }

void table_begin(work *w, mpm_io_csv *t, const char *name, const char *columns, const char *note)
{
    char path[PATH_BYTES];
    mpm_io_csv_begin(t, data_file(w, name, path, sizeof path), columns, note, &w->fault);
}

int table_end(work *w, mpm_io_csv *t, int status)
{
    if (status <= 0) mpm_io_csv_drop(t);
    else if (mpm_io_csv_end(t, &w->fault) < 0) return failed(w);
    return status;
}

int picture(work *w, const char *name, const mpm_draw_plot_desc *d)
{
    char path[PATH_BYTES];
    return plots_png(data_file(w, name, path, sizeof path), d, 1, 1, 440, "A-crit", &w->fault) >= 0 || failed(w);
}
