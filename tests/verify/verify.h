/* verify.h - rows of docs/verification.md. Each program of tests/verify is one section of it: what is
   shown, a table, remarks. It prints markdown and ends with `return verify_end();`. A row that misses its
   tolerance says so in the table and is followed by a remark with the cause and its trend; it is never
   dropped. SPDX-License-Identifier: MIT */
#ifndef VERIFY_H
#define VERIFY_H

#include <math.h>
#include <stdio.h>

static int verify_held, verify_missed, verify_open;

/* Starts the section. `text`: what the case is, what it shows, what it does not. */
static inline void verify_begin(const char *title, const char *text) { printf("## %s\n\n%s\n\n", title, text); }

static inline void verify_head(void)
{
    if (!verify_open) printf("| case | source | expected | got | tolerance | holds |\n|---|---|---|---|---|---|\n");
    verify_open = 1;
}

static inline void verify_line(const char *what, const char *source, const char *expected, double got,
                               const char *tolerance, int ok)
{
    verify_head();
    printf("| %s | %s | %s | %.6g | %s | %s |\n", what, source, expected, got, tolerance, ok ? "yes" : "**no**");
    fflush(stdout);
    if (ok) verify_held++;
    else verify_missed++;
}

/* |got - expected| <= percent/100 |expected| */
static inline void verify_percent(const char *what, const char *source, double expected, double got, double percent)
{
    char e[32], t[32];
    snprintf(e, sizeof e, "%.6g", expected);
    snprintf(t, sizeof t, "%g %%", percent);
    verify_line(what, source, e, got, t, fabs(got - expected) <= 0.01 * percent * fabs(expected));
}

/* |got - expected| <= tolerance */
static inline void verify_near(const char *what, const char *source, double expected, double got, double tolerance)
{
    char e[32], t[32];
    snprintf(e, sizeof e, "%.6g", expected);
    snprintf(t, sizeof t, "%.3g", tolerance);
    verify_line(what, source, e, got, t, fabs(got - expected) <= tolerance);
}

/* low <= got <= high */
static inline void verify_range(const char *what, const char *source, double low, double high, double got)
{
    char e[64];
    snprintf(e, sizeof e, "%.6g .. %.6g", low, high);
    verify_line(what, source, e, got, "range", got >= low && got <= high);
}

/* The larger of two; once it is not a number it stays so, which fmax would forget. */
static inline double verify_worst(double a, double b) { return a >= b || isnan(a) ? a : b; }

/* A measured number that nothing is claimed about. */
static inline void verify_measured(const char *what, const char *source, double got)
{
    verify_head();
    printf("| %s | %s | - | %.6g | measured | - |\n", what, source, got);
    fflush(stdout);
}

/* A paragraph of text after (or between) the tables. */
static inline void verify_remark(const char *text)
{
    printf("%s%s\n\n", verify_open ? "\n" : "", text);
    verify_open = 0;
}

/* The closing count, hidden in the page, and main's return value: 0, since a miss is a result. */
static inline int verify_end(void)
{
    printf("%s<!-- %d hold, %d miss -->\n", verify_open ? "\n" : "", verify_held, verify_missed);
    return 0;
}

#endif
