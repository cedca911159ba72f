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

/* Writes the old page with the new part into a file. Returns 1, or 0. */
static int write_around(const work *w, const char *old, const char *path)
{
    const char *from = strstr(old, BEGIN_MARK), *to = from ? strstr(from, END_MARK) : NULL;
    FILE *f = fopen(path, "wb");
    int ok;
    if (!f) return 0;
    fwrite(old, 1, to ? (size_t)(from - old) : strlen(old), f);
    if (!to) fputs("\n", f);
    fputs(BEGIN_MARK, f);
    fputs(w->text, f);
    fputs(END_MARK, f);
    if (to) fputs(to + strlen(END_MARK), f);
    ok = !ferror(f);
    return fclose(f) == 0 && ok;
}

int write_page(work *w)
{
    static char old[400000];
    char part[MPM_IO_PATH];
    text_in(w->page, old, sizeof old);
    if (strlen(old) == sizeof old - 1) {
        snprintf(w->message, sizeof w->message, "%.300s: longer than %lu characters", w->page,
                 (unsigned long)sizeof old - 1);
        return 0;
    }
    snprintf(part, sizeof part, "%.500s.part", w->page);
    if (write_around(w, old, part)) {
        remove(w->page); /* rename() need not replace */
        if (rename(part, w->page) == 0) return 1;
    }
    snprintf(w->message, sizeof w->message, "cannot write %.300s", w->page);
    return 0;
}

/* ---- the data folder ------------------------------------------------------------------------- */

const char *data_file(const work *w, const char *name, char *path, size_t n) { return file_in(w->data, name, path, n); }

void table_begin(work *w, mpm_io_csv *t, const char *name, const char *columns, const char *note)
{
    char path[MPM_IO_PATH];
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
    char path[MPM_IO_PATH];
    return plots_png(data_file(w, name, path, sizeof path), d, 1, 1, 440, "A-crit", &w->fault) >= 0 || failed(w);
}
