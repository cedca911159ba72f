/* The logistic fit, its roots and crossings, over any tests and boxes. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "mpm.h"
#include "mpm_measure.h"

static mpm_status fit_of(fuzz *f, mpm_logistic *fit)
{
    double x[40], y[40], ridge;
    int outcome[40], i, steps;
    const long n = (long)fuzz_byte(f) % 41;
    for (i = 0; i < 40; i++) {
        x[i] = fuzz_double(f, (i * 37 % 40) / 8.0);
        y[i] = fuzz_double(f, i / 8.0);
        outcome[i] = fuzz_int(f, x[i] + y[i] > 5 || i % 7 == 0);
    }
    ridge = fuzz_double(f, 1e-6);
    steps = fuzz_int(f, 50);
    if (steps > 1000) steps = 1000;
    return mpm_logistic_fit(fit, x, y, outcome, n ? n : 40, ridge, steps, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    mpm_logistic a, b;
    double low[2] = {0, 0}, high[2] = {5, 5}, root[2], point[4][2], theta[6];
    int i, n;
    if (fit_of(&f, &a) < 0 || fit_of(&f, &b) < 0) return 0;
    for (i = 0; i < 6; i++) a.theta[i] = fuzz_double(&f, a.theta[i]);
    for (i = 0; i < 2; i++) {
        low[i] = fuzz_double(&f, low[i]);
        high[i] = fuzz_double(&f, high[i]);
        a.center[i] = fuzz_double(&f, a.center[i]);
        a.half[i] = fuzz_double(&f, a.half[i]);
    }
    mpm_logistic_z(&a, low[0], high[0]);
    mpm_logistic_theta(&a, theta);
    n = mpm_logistic_roots(&a, fuzz_double(&f, 1), low[1], high[1], root);
    FUZZ_WANT(n >= 0 && n <= 2);
    for (i = 0; i < n; i++) FUZZ_WANT(root[i] >= low[1] && root[i] <= high[1]);
    n = mpm_logistic_cross(&a, &b, low, high, point);
    FUZZ_WANT(n >= 0 && n <= 4);
    return 0;
}
