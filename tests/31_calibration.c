/* 31_calibration - the logistic boundary between two outcomes: known coefficients, separable outcomes,
   units, crossings, refusals. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_measure.h"
#include "check.h"

#include <string.h>

enum { TESTS = 4000, BATCHES = 16 };

static uint64_t seed = 20260101;

/* Uniform in [0, 1): Knuth's MMIX generator. */
static double uniform(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) / 9007199254740992.0;
}

static const double truth[6] = {0.4, 1.5, -2.0, -1.2, 0.8, 0.6};

static double polynomial(const double *t, double u, double v)
{
    return t[0] + t[1] * u + t[2] * v + t[3] * u * u + t[4] * u * v + t[5] * v * v;
}

/* A fit whose boundary is the polynomial t itself. */
static mpm_logistic known(double t0, double t1, double t2, double t3, double t4, double t5)
{
    mpm_logistic f;
    memset(&f, 0, sizeof f);
    f.theta[0] = t0;
    f.theta[1] = t1;
    f.theta[2] = t2;
    f.theta[3] = t3;
    f.theta[4] = t4;
    f.theta[5] = t5;
    f.half[0] = f.half[1] = 1;
    return f;
}

/* Outcomes drawn with the probabilities of a known Z: the fits of independent batches scatter about its
   coefficients, and their mean is within four of its standard errors (a chance of 4e-4 in all to fail,
   settled once by the seed). */
static void recovers(void)
{
    static double x1[TESTS], x2[TESTS];
    static int y[TESTS];
    double sum[6] = {0}, square[6] = {0}, theta[6], score = 0;
    mpm_logistic f;
    int b, t, j;
    for (b = 0; b < BATCHES; b++) {
        for (t = 0; t < TESTS; t++) {
            x1[t] = 2 * uniform() - 1;
            x2[t] = 2 * uniform() - 1;
            y[t] = uniform() < 1 / (1 + exp(-polynomial(truth, x1[t], x2[t])));
        }
        CHECK_EQUAL("the fit converges", mpm_logistic_fit(&f, x1, x2, y, TESTS, 0, 50, NULL), MPM_OK);
        mpm_logistic_theta(&f, theta);
        for (j = 0; j < 6; j++) {
            sum[j] += theta[j] / BATCHES;
            square[j] += theta[j] * theta[j] / BATCHES;
        }
    }
    for (j = 0; j < 6; j++)
        CHECK_NEAR("known coefficients come back", sum[j], truth[j],
                   4 * sqrt((square[j] - sum[j] * sum[j]) / (BATCHES - 1)));
    CHECK_RELATIVE("Z is the polynomial", mpm_logistic_z(&f, 0.3, -0.7), polynomial(theta, 0.3, -0.7), 1e-12);
    for (j = 0; j < 6; j++) { /* A 4.14: at the greatest likelihood each sum of X (h - y) vanishes */
        double s = 0;
        for (t = 0; t < TESTS; t++) {
            const double X[6] = {1, x1[t], x2[t], x1[t] * x1[t], x1[t] * x2[t], x2[t] * x2[t]};
            s += X[j] * (1 / (1 + exp(-mpm_logistic_z(&f, x1[t], x2[t]))) - y[t]) / TESTS;
        }
        if (fabs(s) > score) score = fabs(s);
    }
    CHECK_NEAR("the gradient A 4.14 vanishes", score, 0, 1e-12);
}

/* A calibration's grid: outcome 1 inside G_c (1 + Gdot_c) < 3, without exception. */
static int grid(double *x1, double *x2, int *y, double unit1, double unit2)
{
    int i, j, n = 0;
    for (i = 0; i < 15; i++)
        for (j = 0; j < 25; j++, n++) {
            const double g = 0.2 + 0.2 * i, r = 0.1 + 0.1 * j;
            x1[n] = unit1 * g;
            x2[n] = unit2 * r;
            y[n] = g * (1 + r) < 3;
        }
    return n;
}

static void separable(void)
{
    double x1[375], x2[375], s1[375], s2[375], worst = 0, root[2], size = 0;
    int y[375], n = grid(x1, x2, y, 1, 1), t, wrong = 0;
    mpm_logistic f, g;
    CHECK_EQUAL("separable outcomes with a ridge", mpm_logistic_fit(&f, x1, x2, y, n, 1e-6, 100, NULL), MPM_OK);
    for (t = 0; t < 6; t++)
        if (!(fabs(f.theta[t]) < size)) size = fabs(f.theta[t]);
    CHECK_TRUE("... coefficients are finite", size > 1 && size < 1e6);
    for (t = 0; t < n; t++) wrong += (mpm_logistic_z(&f, x1[t], x2[t]) > 0) != y[t];
    CHECK_EQUAL("... every test on its side", wrong, 0);
    CHECK_EQUAL("... as reported", f.wrong, 0);
    CHECK_EQUAL("... one boundary at 1.5", mpm_logistic_roots(&f, 1.5, 0, 2.5, root), 1);
    CHECK_NEAR("... where the outcome changes", root[0], 1, 0.1);
    CHECK_EQUAL("without a ridge there is no greatest likelihood",
                mpm_logistic_fit(&g, x1, x2, y, n, 0, 100, NULL), MPM_NOT_CONVERGED);
    CHECK_TRUE("... the last fit is usable", g.cost < 1e-3 && g.wrong == 0);
    CHECK_EQUAL("too few steps", mpm_logistic_fit(&g, x1, x2, y, n, 1e-6, 2, NULL), MPM_NOT_CONVERGED);
    grid(s1, s2, y, 1503.74, 2.271e11);
    mpm_logistic_fit(&g, s1, s2, y, n, 1e-6, 100, NULL);
    for (t = 0; t < n; t++) {
        const double z = mpm_logistic_z(&f, x1[t], x2[t]);
        const double d = fabs(mpm_logistic_z(&g, s1[t], s2[t]) - z) / (1 + fabs(z));
        if (d > worst) worst = d;
    }
    CHECK_NEAR("Z does not depend on units", worst, 0, 1e-8);
}

static void boundaries(void)
{
    const double low[2] = {-3, -3}, high[2] = {3, 3}, corner[2] = {0, 0}, half[2] = {0.5, 0.5};
    const mpm_logistic circle = known(-4, 0, 0, 1, 0, 1); /* x1^2 + x2^2 = 4 */
    const mpm_logistic hyperbola = known(-1, 0, 0, 0, 1, 0); /* x1 x2 = 1 */
    const mpm_logistic line = known(-1, 1, 1, 0, 0, 0);
    mpm_logistic up = known(0, -1, 1, 0, 0, 0), wide = circle;
    double p[4][2], root[2], wanted;
    int n, i, j;
    CHECK_EQUAL("two roots", mpm_logistic_roots(&circle, 1.2, -9, 9, root), 2);
    CHECK_NEAR("... ascending: -1.6", root[0], -1.6, 1e-14);
    CHECK_NEAR("... and 1.6", root[1], 1.6, 1e-14);
    CHECK_EQUAL("one root in range", mpm_logistic_roots(&circle, 1.2, 0, 9, root), 1);
    CHECK_EQUAL("none beyond the circle", mpm_logistic_roots(&circle, 2.1, -9, 9, root), 0);
    wide = known(1, 0, -2, 0, 0, 1); /* (x2 - 1)^2 = 0 */
    CHECK_EQUAL("a touching root counts once", mpm_logistic_roots(&wide, 2, -9, 9, root), 1);
    wide = circle;
    CHECK_EQUAL("a straight boundary", mpm_logistic_roots(&line, 0.25, -9, 9, root), 1);
    CHECK_NEAR("... at 0.75", root[0], 0.75, 1e-15);

    n = mpm_logistic_cross(&circle, &hyperbola, low, high, p);
    CHECK_EQUAL("circle and hyperbola cross four times", n, 4);
    for (i = 0; i < n; i++) { /* x1^2 = 2 -+ sqrt 3 */
        wanted = (i < 2 ? -1 : 1) * sqrt(2 + (i == 0 || i == 3 ? 1 : -1) * sqrt(3));
        CHECK_NEAR("... x1", p[i][0], wanted, 1e-14);
        CHECK_NEAR("... x2", p[i][1], 1 / wanted, 1e-13);
    }
    CHECK_EQUAL("two in the upper half", mpm_logistic_cross(&circle, &hyperbola, corner, high, p), 2);
    CHECK_EQUAL("none in a box without", mpm_logistic_cross(&circle, &hyperbola, corner, half, p), 0);
    CHECK_EQUAL("coinciding curves give what they share", mpm_logistic_cross(&circle, &wide, low, high, p), 4);
    wide.theta[0] = -4.001;
    CHECK_EQUAL("none between near circles", mpm_logistic_cross(&circle, &wide, low, high, p), 0);
    CHECK_EQUAL("two lines, once", mpm_logistic_cross(&line, &up, low, high, p), 1);
    CHECK_NEAR("... at a half", p[0][0], 0.5, 1e-15);
    wide = known(8, -6, 0, 1, 0, 1); /* (x1 - 3)^2 + x2^2 = 1 */
    CHECK_EQUAL("circles that touch, once", mpm_logistic_cross(&circle, &wide, low, high, p), 1);
    CHECK_NEAR("... at (2, 0)", hypot(p[0][0] - 2, p[0][1]), 0, 0.012);
    wide = known(0, -0.001, 1, 0, 0, 0);
    up = known(0, 0.001, 1, 0, 0, 0);
    CHECK_EQUAL("lines at a small angle, once", mpm_logistic_cross(&up, &wide, low, high, p), 1);
    CHECK_NEAR("... at 0", hypot(p[0][0], p[0][1]), 0, 1e-12);
    up = known(0, -1, 1, 0, 0, 0);
    wide = known(1, -2, 0, 1, 0, 0); /* (x1 - 1)^2 = 0 touches nothing but x1 = 1: a double line */
    n = mpm_logistic_cross(&wide, &up, low, high, p);
    CHECK_TRUE("a double line is found", n >= 1);
    for (j = 0; j < n; j++) CHECK_NEAR("... to the width of a part", p[j][0], 1, 1e-5);
    wide.theta[0] = NAN;
    CHECK_EQUAL("a boundary that is not a number", mpm_logistic_cross(&wide, &up, low, high, p), 0);
}

/* Two sizes, two boundaries: the calibrated pair lies where they cross, whatever the units. */
static void pair(void)
{
    double x1[375], x2[375], p[4][2], q[4][2];
    const double low[2] = {0.2, 0.1}, high[2] = {3, 2.5}, unit[2] = {1503.74, 2.271e11};
    double ulow[2], uhigh[2], u1[375], u2[375];
    int y[375], n, t;
    mpm_logistic a, b, ua, ub;
    n = grid(x1, x2, y, 1, 1);
    mpm_logistic_fit(&a, x1, x2, y, n, 1e-6, 100, NULL);
    for (t = 0; t < n; t++) y[t] = x1[t] + 0.3 * x2[t] < 1.8; /* crosses g (1 + r) = 3 at r = 1 */
    mpm_logistic_fit(&b, x1, x2, y, n, 1e-6, 100, NULL);
    CHECK_EQUAL("the boundaries cross once", mpm_logistic_cross(&a, &b, low, high, p), 1);
    CHECK_NEAR("... near G_c = 1.5", p[0][0], 1.5, 0.1);
    CHECK_NEAR("... and Gdot_c = 1", p[0][1], 1, 0.1);
    CHECK_NEAR("on the one", mpm_logistic_z(&a, p[0][0], p[0][1]), 0, 1e-9);
    CHECK_NEAR("and on the other", mpm_logistic_z(&b, p[0][0], p[0][1]), 0, 1e-9);
    for (t = 0; t < n; t++) {
        u1[t] = unit[0] * x1[t];
        u2[t] = unit[1] * x2[t];
    }
    mpm_logistic_fit(&ub, u1, u2, y, n, 1e-6, 100, NULL);
    grid(u1, u2, y, unit[0], unit[1]);
    mpm_logistic_fit(&ua, u1, u2, y, n, 1e-6, 100, NULL);
    for (t = 0; t < 2; t++) {
        ulow[t] = unit[t] * low[t];
        uhigh[t] = unit[t] * high[t];
    }
    CHECK_EQUAL("in other units too", mpm_logistic_cross(&ua, &ub, ulow, uhigh, q), 1);
    CHECK_RELATIVE("... at the same G_c", q[0][0] / unit[0], p[0][0], 1e-8);
    CHECK_RELATIVE("... and Gdot_c", q[0][1] / unit[1], p[0][1], 1e-8);
}

/* Found by search: whole Newton steps run away from these nine tests. */
static void stubborn(void)
{
    const double x1[] = {0.000983, 0.307, 1e-13, 0.00111, 0.473, 0.00611, 0.403, 0.0223, 0.00341};
    const double x2[] = {2.3e-06, 0.00552, 0.0146, 0.000575, 0.0359, 0.353, 1.28e-08, 0.00262, 0.417};
    const int y[] = {0, 0, 1, 0, 0, 1, 1, 1, 0};
    mpm_logistic f;
    CHECK_EQUAL("where whole steps diverge", mpm_logistic_fit(&f, x1, x2, y, 9, 1e-6, 50, NULL), MPM_OK);
    CHECK_TRUE("... damped ones settle", f.cost < 0.6931);
}

static void refusals(void)
{
    double x1[6] = {0, 1, 2, 0, 1, 2}, x2[6] = {0, 0, 1, 1, 3, 2};
    int y[6] = {0, 1, 0, 1, 0, 1};
    mpm_logistic f;
    mpm_fault fault;
    CHECK_EQUAL("five tests are too few", mpm_logistic_fit(&f, x1, x2, y, 5, 1, 50, &fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... names n", !strcmp(fault.field, "logistic n"));
    CHECK_EQUAL("a negative ridge", mpm_logistic_fit(&f, x1, x2, y, 6, -1, 50, &fault), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("no steps", mpm_logistic_fit(&f, x1, x2, y, 6, 1, 0, &fault), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("a ridge that is no number", mpm_logistic_fit(&f, x1, x2, y, 6, NAN, 50, &fault), MPM_ERR_NAN);
    x2[4] = NAN;
    CHECK_EQUAL("a parameter that is no number", mpm_logistic_fit(&f, x1, x2, y, 6, 1, 50, &fault), MPM_ERR_NAN);
    CHECK_TRUE("... names x2", !strcmp(fault.field, "logistic x2"));
    CHECK_EQUAL("... of test 4", fault.index, 4);
    x2[4] = INFINITY;
    CHECK_EQUAL("an infinite one", mpm_logistic_fit(&f, x1, x2, y, 6, 1, 50, &fault), MPM_ERR_NAN);
    x2[4] = 3;
    y[2] = 7;
    CHECK_EQUAL("an outcome of 7", mpm_logistic_fit(&f, x1, x2, y, 6, 1, 50, &fault), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... of test 2", fault.index, 2);
    y[2] = y[0] = y[4] = 1;
    CHECK_EQUAL("one outcome only", mpm_logistic_fit(&f, x1, x2, y, 6, 1, 50, &fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is told as such", !strcmp(fault.field, "logistic outcome") && fault.index == -1);
    y[0] = 0;
    x1[0] = x1[1] = x1[2] = x1[3] = x1[4] = x1[5] = 2;
    CHECK_EQUAL("a parameter that does not vary", mpm_logistic_fit(&f, x1, x2, y, 6, 1, 50, &fault),
                MPM_ERR_ARGUMENT);
    CHECK_TRUE("... names x1", !strcmp(fault.field, "logistic x1"));
}

int main(void)
{
    recovers();
    separable();
    boundaries();
    pair();
    stubborn();
    refusals();
    return check_end();
}
