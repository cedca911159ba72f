/* reproduction.h - what the parts of examples/studies/reproduction.c share: the budget, the runs, and the page under
   way. SPDX-License-Identifier: MIT */
#ifndef REPRODUCTION_H
#define REPRODUCTION_H

#include "critical.h"

#include <stdarg.h>

enum { QUICK, DESK, FULL };

typedef struct work {
    study s;
    int budget;
    const char *budget_name, *data, *page, *only, *desk;
    char *text;       /* the part of the page */
    size_t used, room;
    char message[400];
    mpm_fault fault;
} work;

typedef struct grid {
    double cell, spacing;
} grid;

/* What may count as bonded: see critical_rule. */
static const char *const rule_names[2] = {"thesis", "stays"};

/* ---- the page ------------------------------------------------------------------------------ */

static inline void say(work *w, const char *format, ...)
{
    va_list list;
    int n;
    va_start(list, format);
    n = vsnprintf(w->text + w->used, w->room - w->used, format, list);
    va_end(list);
    if (n > 0) w->used += (size_t)n < w->room - w->used ? (size_t)n : w->room - w->used - 1;
}

/* "812", "none up to 1000": a velocity of a search. */
static inline const char *velocity_text(double v, double high, char *text, size_t n)
{
    if (v < HUGE_VAL) snprintf(text, n, "%.0f", v);
    else snprintf(text, n, "none up to %.0f", high);
    return text;
}

/* "9.56"; "-" where nothing was measured. */
static inline const char *measure_text(double v, char *text, size_t n)
{
    if (fabs(v) < HUGE_VAL) snprintf(text, n, "%.2f", v);
    else snprintf(text, n, "-");
    return text;
}

/* Whether a word is in a list "conv,dt,jet". */
static inline int listed(const char *list, const char *word)
{
    const size_t n = strlen(word);
    while (*list) {
        const size_t length = strcspn(list, ",");
        if (length == n && !strncmp(list, word, n)) return 1;
        list += length + (list[length] == ',');
    }
    return 0;
}

static inline int failed(work *w)
{
    mpm_io_fault_text(w->message, sizeof w->message, &w->fault);
    return 0;
}

static inline const char *data_file(const work *w, const char *name, char *path, size_t n)
{
    snprintf(path, n, "%s/%s", w->data, name);
    return path;
}

#define BEGIN_MARK "<!-- made by build/reproduction: begin -->\n"
#define END_MARK "<!-- made by build/reproduction: end -->\n"

/* Puts the text between its marks in the page, or at the page's end if it has none; the rest stays. The old
   page goes only when the new one is whole. */
static inline int write_page(work *w)
{
    static char old[400000];
    char part[MPM_IO_PATH];
    const char *from, *to;
    size_t n = 0, kept;
    int ok;
    FILE *f = fopen(w->page, "rb");
    if (f) {
        n = fread(old, 1, sizeof old, f);
        fclose(f);
    }
    if (n == sizeof old) {
        snprintf(w->message, sizeof w->message, "%.300s: longer than %lu characters", w->page,
                 (unsigned long)sizeof old - 1);
        return 0;
    }
    old[n] = 0;
    from = strstr(old, BEGIN_MARK);
    to = from ? strstr(from, END_MARK) : NULL;
    kept = to ? (size_t)(from - old) : n;
    snprintf(part, sizeof part, "%.500s.part", w->page);
    f = fopen(part, "wb");
    if (f) {
        fwrite(old, 1, kept, f);
        fprintf(f, "%s%s%s%s%s", to ? "" : "\n", BEGIN_MARK, w->text, END_MARK, to ? to + strlen(END_MARK) : "");
        ok = !ferror(f);
        if (fclose(f) == 0 && ok) {
            remove(w->page); /* rename() need not replace */
            if (rename(part, w->page) == 0) return 1;
        }
    }
    snprintf(w->message, sizeof w->message, "cannot write %.300s", w->page);
    return 0;
}

#endif
