/* 13_lanes.c - the functions in lanes of mpm_ptw.h against long double, and the stress update of many points at once
   against the same points one by one. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_ptw.h"
#include "check.h"

#include <stdlib.h>
#include <string.h>

typedef mpm_real (*lane_fn)(mpm_real x);
typedef long double (*long_fn)(long double x);

static mpm_real lane_exp(mpm_real x) { return mpm_lane_exp(x); }
static mpm_real lane_expm1(mpm_real x) { return mpm_lane_expm1(x); }
static mpm_real lane_log(mpm_real x) { return mpm_lane_log(x); }
static mpm_real lane_cubic(mpm_real x) { return mpm_lane_pow(x, 3); }
static mpm_real lane_root(mpm_real x) { return mpm_lane_pow(x, MPM_R(0.5)); }
static long double long_cubic(long double x) { return x * x * x; }
static long double long_bell(long double x) { return expl(-x * x); }

static mpm_real lane_erf(mpm_real x)
{
    mpm_real bell;
    return mpm_lane_erf(x, &bell);
}

static mpm_real lane_bell(mpm_real x)
{
    mpm_real bell;
    mpm_lane_erf(x, &bell);
    return bell;
}

/* Largest error over 200001 places between low and high, in eps: of the value, or of 1. */
static double worst(lane_fn f, long_fn exact, double low, double high, int of_value)
{
    double most = 0;
    int i;
    for (i = 0; i <= 200000; i++) {
        const mpm_real x = (mpm_real)(low + (high - low) * i / 200000);
        const long double right = exact((long double)x), scale = of_value && fabsl(right) > 0 ? fabsl(right) : 1;
        most = check_worst(most, (double)(fabsl((long double)f(x) - right) / scale / (long double)MPM_EPSILON));
    }
    return most;
}

#define CHECK_WITHIN(what, f, exact, low, high, of_value, eps) \
    check_line(worst(f, exact, low, high, of_value) <= (eps), what, worst(f, exact, low, high, of_value), 0, eps)

static void test_accuracy(void)
{
    CHECK_WITHIN("exp, eps", lane_exp, expl, -80, 80, 1, 2);
    CHECK_WITHIN("exp near 0, eps", lane_exp, expl, -1, 1, 1, 2);
    CHECK_WITHIN("expm1, eps", lane_expm1, expm1l, -80, 80, 1, 3);
    CHECK_WITHIN("expm1 near 0, eps", lane_expm1, expm1l, -1, 1, 1, 3);
    CHECK_WITHIN("expm1 very near 0, eps", lane_expm1, expm1l, -1e-6, 1e-6, 1, 3);
    CHECK_WITHIN("log, eps", lane_log, logl, 1e-30, 1e-20, 1, 2);
    CHECK_WITHIN("log of large numbers, eps", lane_log, logl, 2, 1e9, 1, 2);
    CHECK_WITHIN("log near 1, eps", lane_log, logl, 0.5, 2, 1, 2);
    CHECK_WITHIN("log very near 1, eps", lane_log, logl, 0.999, 1.001, 1, 2);
    CHECK_WITHIN("x^3, eps", lane_cubic, long_cubic, 0.01, 5, 1, 2 * (1 + 3 * log(100)));
    CHECK_WITHIN("x^(1/2), eps", lane_root, sqrtl, 0.01, 5, 1, 2 * (1 + 0.5 * log(100)));
    CHECK_WITHIN("erf, eps of 1", lane_erf, erfl, -7, 7, 0, 3);
    CHECK_WITHIN("exp(-x^2), eps of 1", lane_bell, long_bell, -6, 6, 0, 2);
}

static void test_ends(void)
{
    const mpm_real endless = (mpm_real)HUGE_VAL, none = endless - endless;
    CHECK_TRUE("exp beyond all numbers is infinite", mpm_lane_exp(1000) >= endless);
    CHECK_EQUAL("... and 0 below them", mpm_lane_exp(-1000), 0);
    CHECK_EQUAL("expm1 goes to -1", mpm_lane_expm1(-endless), -1);
    CHECK_TRUE("... and to infinity", mpm_lane_expm1(endless) >= endless);
    CHECK_EQUAL("expm1 of 0", mpm_lane_expm1(0), 0);
    CHECK_EQUAL("log of 1", mpm_lane_log(1), 0);
    CHECK_TRUE("log of 0 is far below", mpm_lane_log(0) < -87);
    CHECK_EQUAL("0 to a power", mpm_lane_pow(0, 20), 0);
    CHECK_TRUE("no number stays none", !mpm_finite(mpm_lane_exp(none)) && !mpm_finite(mpm_lane_expm1(none)) &&
                                           !mpm_finite(mpm_lane_log(none)) && !mpm_finite(lane_erf(none)));
    CHECK_TRUE("nor has infinity a logarithm", !mpm_finite(mpm_lane_log(endless)));
    CHECK_EQUAL("erf far out is 1", lane_erf(40), 1);
    CHECK_EQUAL("... and -1", lane_erf(-40), -1);
}

enum { POINTS = 64, FIELDS = 11 };

/* Points of many kinds in one block: elastic and yielding, cold, hot and molten, at rest and overdriven. */
static void fill(const mpm_material *m, mpm_real field[FIELDS][POINTS], mpm_real strain[6][POINTS],
                 mpm_real spin[3][POINTS], mpm_real density[POINTS])
{
    unsigned seed = 7;
    int i, j;
    for (i = 0; i < POINTS; i++) {
        mpm_real u[20], size;
        for (j = 0; j < 20; j++) {
            seed = seed * 1664525u + 1013904223u;
            u[j] = (mpm_real)(seed >> 8) / 16777216;
        }
        size = i % 4 == 0 ? MPM_R(1e-5) : i % 4 == 1 ? MPM_R(1e-3) : MPM_R(2e-2);
        for (j = 0; j < 6; j++) strain[j][i] = size * (u[j] - MPM_R(0.5));
        for (j = 0; j < 3; j++) spin[j][i] = size * (u[6 + j] - MPM_R(0.5));
        for (j = 0; j < 6; j++) field[j][i] = m->young * MPM_R(2e-3) * (u[9 + j] - MPM_R(0.5));
        field[6][i] = 0;
        field[7][i] = i % 7 == 6 ? 4000 : i % 3 ? 300 + 300 * u[15] : 300;
        field[8][i] = i % 5 ? u[16] : 0;
        field[9][i] = i % 3 ? MPM_R(1e7) * u[17] : 0;
        field[10][i] = 0;
        density[i] = m->density * (1 + MPM_R(0.05) * u[18]);
    }
}

static mpm_block block_of(mpm_real field[FIELDS][POINTS], mpm_real strain[6][POINTS], mpm_real spin[3][POINTS],
                          mpm_real density[POINTS], int first, int count, mpm_real dt)
{
    mpm_block b;
    int j;
    memset(&b, 0, sizeof b);
    b.count = count;
    b.dt = dt;
    b.cell = MPM_R(1e-6);
    b.density = density + first;
    for (j = 0; j < 6; j++) b.strain[j] = strain[j] + first;
    for (j = 0; j < 3; j++) b.spin[j] = spin[j] + first;
    for (j = 0; j < 6; j++) b.stress[j] = field[j] + first;
    b.energy = field[6] + first;
    b.temperature = field[7] + first;
    b.plastic_strain = field[8] + first;
    b.plastic_rate = field[9] + first;
    b.plastic_work = field[10] + first;
    return b;
}

/* Side by side and one by one: a point's update must not depend on its neighbours, but for the last places, where
   several at a time may be rounded otherwise than one. */
static void test_neighbours(const char *metal, const char *model, int staged)
{
    static mpm_real one[FIELDS][POINTS], all[FIELDS][POINTS], strain[6][POINTS], spin[3][POINTS], density[POINTS];
    static mpm_real left[2][POINTS];
    mpm_units si = mpm_units_si();
    mpm_material m;
    double most = 0;
    int i, j, yielding = 0;
    mpm_block b;
    if (mpm_material_preset(&m, metal, &si, NULL) != MPM_OK || mpm_material_model(&m, model, NULL) != MPM_OK) return;
    m.mapping = staged ? MPM_RETURN_STAGED : MPM_RETURN_CONSISTENT;
    m.flow_field = staged ? 0 : -1;
    m.compression_heating = 1;
    fill(&m, one, strain, spin, density);
    memcpy(all, one, sizeof all);
    memset(left, 0, sizeof left);
    b = block_of(all, strain, spin, density, 0, POINTS, MPM_R(1e-10));
    b.user[0] = left[0];
    CHECK_TRUE(model, mpm_material_stress(&m, &b) >= MPM_OK); /* hot points meet the bound of the shear modulus */
    for (i = 0; i < POINTS; i++) {
        b = block_of(one, strain, spin, density, i, 1, MPM_R(1e-10));
        b.user[0] = left[1] + i;
        if (mpm_material_stress(&m, &b) < MPM_OK) most = 1;
    }
    for (j = 0; j < FIELDS; j++) {
        double scale = 0;
        for (i = 0; i < POINTS; i++) scale = check_worst(scale, fabs((double)one[j][i]));
        for (i = 0; i < POINTS; i++) most = check_worst(most, fabs((double)(all[j][i] - one[j][i])) / (scale + 1e-300));
    }
    for (i = 0; i < POINTS; i++) yielding += all[9][i] > 0;
    CHECK_NEAR("... side by side and one by one", most, 0, 2000 * (double)MPM_EPSILON);
    CHECK_TRUE("... of which some yield and some do not", yielding > 10 && yielding < POINTS);
}

int main(void)
{
    test_accuracy();
    test_ends();
    test_neighbours("al", "ptw", 0);
    test_neighbours("ta", "ptw", 0);
    test_neighbours("al", "ptw", 1);
    test_neighbours("cu", "jc", 0);
    test_neighbours("cu", "scg", 0);
    test_neighbours("cu", "linear", 0);
    return check_end();
}
