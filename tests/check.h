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
#define CHECK_RELATIVE(what, got, wanted, tolerance)                                              \
    check_line(fabs((double)(got) - (double)(wanted)) <= (tolerance)*fabs((double)(wanted)), what, \
               (double)(got), (double)(wanted), (tolerance))

/* |got - wanted| <= tolerance */
#define CHECK_NEAR(what, got, wanted, tolerance)                                       \
    check_line(fabs((double)(got) - (double)(wanted)) <= (tolerance), what, (double)(got), \
               (double)(wanted), (tolerance))

/* two whole numbers (counts, statuses) are the same */
#define CHECK_EQUAL(what, got, wanted) \
    check_line((long)(got) == (long)(wanted), what, (double)(got), (double)(wanted), 0.0)

/* a condition holds */
#define CHECK_TRUE(what, condition) CHECK_EQUAL(what, (condition) ? 1 : 0, 1)

/* The closing line, and main's return value. */
static inline int check_end(void)
{
    printf("%d passed, %d failed\n", check_passed, check_failed);
    return check_failed ? 1 : 0;
}

#endif
