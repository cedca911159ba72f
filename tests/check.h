/* check.h - the tests' only tool: numbered lines, a closing count. SPDX-License-Identifier: MIT
   Each test file is one program: CHECK(...) lines in main(), then `return check_end();`. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdio.h>

static int check_passed, check_failed;

/* Records one result. `ok` decides; the rest is the line a person reads. */
static inline void check_line(int ok, const char *what, double got, double wanted, double tolerance)
{
    int number = check_passed + check_failed + 1;
    printf("%s %d - %s: got %.9g, wanted %.9g within %.3g\n", ok ? "ok" : "not ok", number, what, got,
           wanted, tolerance);
    if (ok) check_passed++;
    else check_failed++;
}

/* |got - wanted| <= tolerance * |wanted| */
static inline void check_relative(const char *what, double got, double wanted, double tolerance)
{
    check_line(fabs(got - wanted) <= tolerance * fabs(wanted), what, got, wanted, tolerance);
}
#define CHECK_RELATIVE(what, got, wanted, tolerance) \
    check_relative(what, (double)(got), (double)(wanted), (double)(tolerance))

/* |got - wanted| <= tolerance */
static inline void check_near(const char *what, double got, double wanted, double tolerance)
{
    check_line(fabs(got - wanted) <= tolerance, what, got, wanted, tolerance);
}
#define CHECK_NEAR(what, got, wanted, tolerance) \
    check_near(what, (double)(got), (double)(wanted), (double)(tolerance))

/* Two whole numbers (counts, statuses) are the same. As doubles: what is not a number, because there was none to read,
   equals nothing. */
static inline void check_equal(const char *what, double got, double wanted)
{
    check_line(got >= wanted && got <= wanted, what, got, wanted, 0);
}
#define CHECK_EQUAL(what, got, wanted) check_equal(what, (double)(got), (double)(wanted))

/* a condition holds */
#define CHECK_TRUE(what, condition) CHECK_EQUAL(what, (condition) ? 1 : 0, 1)

/* The larger of two; once it is not a number it stays so, which fmax would forget. */
static inline double check_worst(double a, double b) { return a >= b || isnan(a) ? a : b; }

/* The closing line, and main's return value. */
static inline int check_end(void)
{
    printf("%d passed, %d failed\n", check_passed, check_failed);
    return check_failed ? 1 : 0;
}

#endif
