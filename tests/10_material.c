/* 10_material.c - the laws of mpm_ptw.h at single states, against independent evaluations in long
   double, published numbers and exact limits. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "strength_reference.h"
#include "stiffened.h"
#include "check.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* 1e-12 in double: the rounding of some dozens of operations and a few elementary functions. */
#define TIGHT (4500.0 * (double)MPM_EPSILON)

static const mpm_fault no_fault = {MPM_OK, "", 0, 0};

static mpm_material preset(const char *name, const char *model)
{
    mpm_units si = mpm_units_si();
    mpm_material m = mpm_material_default();
    if (mpm_material_preset(&m, name, &si, NULL) != MPM_OK ||
        (*model && mpm_material_model(&m, model, NULL) != MPM_OK)) {
        printf("not ok 0 - no preset %s %s\n", name, model);
        exit(1);
    }
    return m;
}

/* Largest relative difference over strains, rates 1e-3 .. 1e12 /s, temperatures through melting,
   and densities. */
static double worst_difference(const mpm_material *m)
{
    static const double strains[] = {0, 1e-4, 0.01, 0.1, 0.5, 1, 3};
    static const double etas[] = {0.95, 1, 1.02, 1.1};
    double worst = 0;
    int i, j, k, l;
    for (i = 0; i < 7; i++)
        for (j = -6; j <= 24; j++)
            for (k = 1; k <= 24; k++)
                for (l = 0; l < 4; l++) {
                    mpm_material_state s = state(strains[i], pow(10, j / 2.0), 50.0 * k,
                                                 etas[l] * (double)m->density, 3e10 * (etas[l] - 1));
                    real want = reference(m, &s), got = (real)mpm_material_flow_stress(m, &s);
                    double gap = (double)fabsl(got - want) / (want > 0 ? (double)want : 1.0);
                    if (!(gap <= worst)) worst = gap;
                }
    return worst;
}

static void test_flow_stress_against_long_double(void)
{
    static const char *const cases[][2] = {
        {"al", "ptw"}, {"cu", "ptw"}, {"ta", "ptw"}, {"304", "ptw"}, {"cu", "jc"}, {"al6061-t6", "jc"},
        {"304", "jc"}, {"4340", "jc"}, {"cu", "scg"}, {"al7075-t6", "scg"}, {"ti", "scg"}, {"cu", "linear"}};
    mpm_material m;
    int i;
    for (i = 0; i < 12; i++) {
        char what[80];
        m = preset(cases[i][0], cases[i][1]);
        sprintf(what, "flow stress of %s %s, worst of 20832 states", cases[i][0], cases[i][1]);
        CHECK_NEAR(what, worst_difference(&m), 0, TIGHT);
    }
    m = preset("al", "ptw");
    m.erf_literal = 1;
    CHECK_NEAR("flow stress of al with the argument of erf as printed", worst_difference(&m), 0, TIGHT);
}

/* ---- published and precomputed numbers ------------------------------------------------------- */

static double flow_MPa(const mpm_material *m, double strain, double rate, double T)
{
    mpm_material_state s = state(strain, rate, T, (double)m->density, 0);
    return 1e-6 * (double)mpm_material_flow_stress(m, &s);
}

static void test_numbers(void)
{
    mpm_material m = preset("al", "ptw"), k = preset("al6061-t6", "scg");
    mpm_material_state s = state(0.1, 1e6, 300, 2700, 0);
    /* Reference data computed elsewhere for c0 5386, s 1.339, rho0 2700 and Gamma0 1.99 (the page they
       come from labels them as al6061, whose closed form gives the second row). */
    const double mus[] = {0.05, 0.1, 0.2}, cold[] = {4.05344, 8.39594, 18.04440};
    const double cold_6061[] = {3.866803, 8.065237, 17.589921};
    int i;
    CHECK_NEAR("al, 1 /s, strain 0, MPa", flow_MPa(&m, 0, 1, 300), 102.22, 0.005);
    CHECK_NEAR("al, 1e3 /s, strain 0, MPa", flow_MPa(&m, 0, 1e3, 300), 102.22, 0.005);
    CHECK_NEAR("al, 1 /s, strain 0.1, MPa", flow_MPa(&m, 0.1, 1, 300), 133.12, 0.005);
    CHECK_NEAR("al, 1e3 /s, strain 1, MPa", flow_MPa(&m, 1, 1e3, 300), 143.86, 0.005);
    CHECK_NEAR("al, 1e6 /s, strain 0.1, MPa", flow_MPa(&m, 0.1, 1e6, 300), 259, 0.5);
    CHECK_RELATIVE("al, xidot at 300 K", mpm_material_attempt_rate(&m, &s), 9.714e12, 1e-4);
    CHECK_NEAR("al, shear modulus at 300 K, GPa", 1e-9 * (double)mpm_material_shear_modulus(&m, &s), 25.516,
               0.0005);
    m.ptw.atomic_mass = (mpm_real)4.48039e-23;
    CHECK_NEAR("al with the printed atomic mass, MPa", flow_MPa(&m, 0.1, 1e6, 300), 414, 0.5);
    for (i = 0; i < 3; i++) {
        mpm_real p = 0;
        CHECK_EQUAL("cold curve of al6061, status",
                    mpm_material_pressure(&k, (mpm_real)((double)k.density * (1 + mus[i])), 0, &p, NULL), MPM_OK);
        CHECK_RELATIVE("cold curve of al6061, GPa", 1e-9 * (double)p, cold_6061[i],
                       1e-6 + 100 * (double)MPM_EPSILON);
        m.gruneisen = (mpm_real)1.99;
        CHECK_EQUAL("cold curve with Gamma0 = 1.99, status",
                    mpm_material_pressure(&m, (mpm_real)(2700 * (1 + mus[i])), 0, &p, NULL), MPM_OK);
        CHECK_RELATIVE("cold curve with Gamma0 = 1.99, GPa", 1e-9 * (double)p, cold[i],
                       1e-6 + 100 * (double)MPM_EPSILON);
    }
}

static void test_melting_table(void)
{
    const char *names[] = {"al1100", "cu", "ti", "ta"};
    const double published[] = {1220, 1790, 2260, 4340}, melt[] = {1644.82, 2436.41, 2657.77, 5535.75};
    int i;
    for (i = 0; i < 4; i++) {
        mpm_material m = preset(names[i], "scg");
        m.melt_temperature = (mpm_real)published[i];
        CHECK_NEAR(names[i], mpm_material_melt_temperature(&m, (mpm_real)1.1 * m.density), melt[i], 0.006);
        CHECK_RELATIVE("at the reference density", mpm_material_melt_temperature(&m, m.density),
                       m.melt_temperature, 8 * (double)MPM_EPSILON);
    }
}

/* Zero pressure, heat alone, and the metal as the equation of state then has it: density and temperature at which its
   strength goes, halved in here with nothing of the library's melting point but the laws. */
static double melts(const mpm_material *m)
{
    double cold = (double)m->temperature, hot = 2 * (double)m->melt_temperature;
    while (hot - cold > 0.01) {
        const double T = (cold + hot) / 2, energy = (double)m->specific_heat * (T - (double)m->temperature);
        double low = 0.5, high = 1.1;
        int k;
        for (k = 0; k < 60; k++) {
            const double eta = (low + high) / 2;
            mpm_real p = 0;
            mpm_material_pressure(m, (mpm_real)(eta * (double)m->density), (mpm_real)energy, &p, NULL);
            if (p < 0) low = eta;
            else high = eta;
        }
        {
            const mpm_material_state s = state(0.1, 1e6, T, high * (double)m->density, 0);
            if (mpm_material_flow_stress(m, &s) > 0) cold = T;
            else hot = T;
        }
    }
    return hot;
}

static void test_melting_points(void)
{
    /* Solidus and liquidus of handbooks at p = 0; pure metals: the melting point, ITS-90 and CRC Handbook. */
    static const struct { const char *name; double solidus, liquidus; } metal[] = {
        {"al", 933.5, 933.5}, {"al1100", 916, 930}, {"al6061-t6", 855, 925}, {"al7075-t6", 750, 908},
        {"cu", 1357.8, 1357.8}, {"ni", 1728, 1728}, {"ti", 1941, 1941}, {"ti-6al-4v", 1877, 1933},
        {"ta", 3290, 3290}, {"zn", 692.7, 692.7}, {"304", 1673, 1723}, {"4340", 1700, 1773}};
    static const char *const models[] = {"jc", "scg", "ptw"};
    const mpm_units u = mpm_units_um_us_ng();
    mpm_material m, n;
    mpm_fault f;
    size_t i, k;
    for (i = 0; i < sizeof metal / sizeof *metal; i++)
        for (k = 0; k < 3; k++) {
            const double low = 0.98 * metal[i].solidus, high = 1.02 * metal[i].liquidus;
            if (mpm_material_preset(&m, metal[i].name, &u, NULL) < 0) break;
            if (mpm_material_model(&m, models[k], NULL) < 0) continue;
            CHECK_NEAR(metal[i].name, melts(&m), (low + high) / 2, (high - low) / 2);
            CHECK_RELATIVE("... and it says so", mpm_material_melting_point(&m), melts(&m), 1e-4);
        }
    m = preset("al-thesis", "ptw");
    CHECK_NEAR("source A's results: 933.5 K at rho0", m.melt_temperature, 933.5, 1e-4);
    CHECK_NEAR("... is 835 K at p = 0", melts(&m), 835, 1);
    m = preset("al", "ptw");
    CHECK_NEAR("al: at rho0", m.melt_temperature, 1066, 2);
    n = m;
    n.temperature = 600;
    CHECK_TRUE("begun hot without the heat's energy: too high", melts(&n) > 970);
    CHECK_EQUAL("... unless told", mpm_material_melts_at(&n, mpm_material_melting_point(&m), NULL), MPM_OK);
    CHECK_NEAR("... as the cold one", melts(&n), (double)mpm_material_melting_point(&m), 0.1);
    n = m;
    m.eos = MPM_EOS_LINEAR;
    CHECK_EQUAL("without expansion", mpm_material_melts_at(&m, 900, NULL), MPM_OK);
    CHECK_RELATIVE("... at rho0", m.melt_temperature, 900, 8 * (double)MPM_EPSILON);
    m = n;
    CHECK_EQUAL("not a temperature", mpm_material_melts_at(&m, 0, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... by name", !strcmp(f.field, "melting point"));
    CHECK_EQUAL("so hot that nothing is left", mpm_material_melts_at(&m, 20000, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... by name", !strcmp(f.field, "melt_temperature"));
    CHECK_EQUAL("NaN", mpm_material_melts_at(&m, (mpm_real)NAN, NULL), MPM_ERR_NAN);
    CHECK_TRUE("... the material as it was", m.melt_temperature == n.melt_temperature);
    m = preset("al", "elastic");
    CHECK_TRUE("what never melts", !mpm_finite(mpm_material_melting_point(&m)));
}

/* ---- limits ---------------------------------------------------------------------------------- */

static void test_rate_limits(void)
{
    mpm_material m = preset("al", "ptw");
    mpm_material_state s = state(0, 0, 300, 2700, 0), fast, one;
    double mu = (double)mpm_material_shear_modulus(&m, &s);
    double r1 = (double)m.ptw.gamma * (double)mpm_material_attempt_rate(&m, &s);
    int i;
    CHECK_RELATIVE("rate 0: the lower plateau of the yield stress", mpm_material_flow_stress(&m, &s),
                   2 * mu * (double)m.ptw.yinf, 16 * (double)MPM_EPSILON);
    one = state(0.3, 1, 300, 2700, 0);
    s.plastic_strain = one.plastic_strain;
    CHECK_TRUE("rate 0 is the limit of slow rates, bit for bit",
               mpm_material_flow_stress(&m, &s) == mpm_material_flow_stress(&m, &one));
    for (i = 0; i < 3; i++) {
        fast = state(0.7, r1 * pow(10, i + 1), 300, 2700, 0);
        one = fast;
        one.plastic_strain = 0;
        CHECK_TRUE("overdriven: no hardening, bit for bit",
                   mpm_material_flow_stress(&m, &fast) == mpm_material_flow_stress(&m, &one));
        CHECK_RELATIVE("overdriven: 2 mu s0 r^s1", mpm_material_flow_stress(&m, &fast),
                       2 * mu * (double)m.ptw.s0 * pow(pow(10, i + 1), (double)m.ptw.s1),
                       64 * (double)MPM_EPSILON);
    }
    for (i = 0; i < 2; i++) {
        double h = i ? 1e-3 : 1e-5;
        fast = state(0.1, r1 * (1 + h), 300, 2700, 0);
        one = state(0.1, r1 * (1 - h), 300, 2700, 0);
        /* both sides rise like r^s1 here, so the gap is 2 h s1 of the stress, and no more */
        CHECK_NEAR("continuous across r = 1", mpm_material_flow_stress(&m, &fast) /
                   mpm_material_flow_stress(&m, &one) - 1, 2 * h * (double)m.ptw.s1,
                   h * h + 64 * (double)MPM_EPSILON);
    }
    m.erf_literal = 1;
    fast = state(0.1, r1 * 100, 800, 2700, 0);
    one = state(0.1, r1 * 100, 300, 2700, 0);
    CHECK_TRUE("literal erf hardens with temperature beyond r = 1, over 2 mu",
               mpm_material_flow_stress(&m, &fast) / mpm_material_shear_modulus(&m, &fast) >
                   mpm_material_flow_stress(&m, &one) / mpm_material_shear_modulus(&m, &one));
}

static void test_temperature_limits(void)
{
    mpm_material m = preset("al", "ptw");
    mpm_material_state s = state(0.1, 1e6, 0, 2700, 0);
    CHECK_TRUE("T = 0: mu0 exactly", mpm_material_shear_modulus(&m, &s) == m.shear_modulus);
    s.plastic_strain = 0;
    s.plastic_rate = 0;
    CHECK_TRUE("T = 0: y0 at any rate, bit for bit",
               mpm_material_flow_stress(&m, &s) == 2 * m.shear_modulus * m.ptw.y0);
    s = state(0.1, 1e6, (double)m.melt_temperature, 2700, 0);
    CHECK_TRUE("at melting: no strength", mpm_material_flow_stress(&m, &s) == 0);
    s.temperature = (mpm_real)0.9999 * m.melt_temperature;
    CHECK_TRUE("just below melting: strength", mpm_material_flow_stress(&m, &s) > 0);
    s = state(0.1, 1e6, 2500, 4000, 0);
    CHECK_RELATIVE("far beyond 1906 K: mu at its floor", mpm_material_shear_modulus(&m, &s),
                   (double)m.shear_floor * (double)m.shear_modulus, 4 * (double)MPM_EPSILON);
    CHECK_TRUE("... and a finite positive strength if compressed enough not to melt",
               mpm_material_flow_stress(&m, &s) > 0 && mpm_material_flow_stress(&m, &s) < m.shear_modulus);
}

static void test_hardening_limits(void)
{
    mpm_material m = preset("al", "ptw");
    mpm_material_state s = state(0.05, 1e4, 300, 2700, 0);
    double voce, small, gap = 0;
    int i;
    m.ptw.d = 0;
    voce = (double)mpm_material_flow_stress(&m, &s);
    CHECK_RELATIVE("d = 0 against the Voce law", voce, (double)ref_ptw(&m, &s), TIGHT);
    m.ptw.d = (mpm_real)1e-4;
    small = (double)mpm_material_flow_stress(&m, &s);
    /* alpha grows like 1/d, and rounding with it */
    CHECK_NEAR("d -> 0 tends to it", small / voce, 1, 1e-4 + 1e4 * (double)MPM_EPSILON);
    CHECK_TRUE("... without being it", small != voce || sizeof(mpm_real) < 8);
    /* alpha < 0: the yield stress passes s0 before saturation */
    m = preset("al", "ptw");
    m.ptw.y1 = (mpm_real)0.9 * m.ptw.s0;
    m.ptw.y2 = (mpm_real)0.6;
    for (i = 0; i < 50; i++) {
        double xi = (double)m.ptw.gamma * (double)mpm_material_attempt_rate(&m, &s);
        s = state(0.002 * i, xi * pow(10, 0.081 + 0.001 * i), 300, 2700, 0);
        gap = check_worst(gap, fabs((double)mpm_material_flow_stress(&m, &s) / (double)ref_ptw(&m, &s) - 1));
    }
    CHECK_NEAR("alpha < 0 against the printed form", gap, 0, TIGHT);
    /* alpha = 0: yield stress exactly s0, saturation above */
    m.ptw.y0 = m.ptw.yinf = m.ptw.s0;
    m.ptw.y1 = m.ptw.s0 / 4;
    s = state(0.1, 1e9, 300, 2700, 0);
    CHECK_RELATIVE("alpha = 0 stays at the yield stress", mpm_material_flow_stress(&m, &s),
                   2 * (double)mpm_material_shear_modulus(&m, &s) * (double)m.ptw.s0,
                   8 * (double)MPM_EPSILON);
}

/* ---- shape: slopes, monotonicity -------------------------------------------------------------- */

static void test_slopes(void)
{
    static const char *const cases[][2] = {{"al", "ptw"}, {"cu", "ptw"}, {"ta", "ptw"}, {"304", "ptw"},
                                           {"cu", "jc"}, {"cu", "scg"}};
    /* Central differences are good to h^2 and eps/h: the best h is eps^(1/3). */
    double h = cbrt((double)MPM_EPSILON), strain_gap, rate_gap;
    mpm_material_state s = state(0, 1e5, 300, 2700, 0);
    mpm_material m;
    int i, j;
    for (i = 0; i < 6; i++) {
        m = preset(cases[i][0], cases[i][1]);
        strain_gap = rate_gap = 0;
        for (j = 0; j < 40; j++) {
            double strain = 0.02 + 0.01 * j, rate = 3e2 * pow(10, 0.2 * j), f;
            mpm_material_state c = state(strain, rate, 350, (double)m.density, 0), a = c, b = c;
            mpm_flow v = mpm_material_flow(&m, &c);
            f = (double)v.stress;
            a.plastic_strain = (mpm_real)(strain * (1 - h));
            b.plastic_strain = (mpm_real)(strain * (1 + h));
            strain_gap = check_worst(strain_gap, fabs((double)(mpm_material_flow_stress(&m, &b) -
                                                         mpm_material_flow_stress(&m, &a)) / (2 * h) -
                                               strain * (double)v.strain_slope) / f);
            a = b = c;
            a.plastic_rate = (mpm_real)(rate * (1 - h));
            b.plastic_rate = (mpm_real)(rate * (1 + h));
            rate_gap = check_worst(rate_gap, fabs((double)(mpm_material_flow_stress(&m, &b) -
                                                     mpm_material_flow_stress(&m, &a)) / (2 * h) -
                                           (double)v.rate_slope) / f);
        }
        CHECK_NEAR("hardening slope against central differences", strain_gap, 0, 50 * h * h);
        CHECK_NEAR("rate slope against central differences", rate_gap, 0, 50 * h * h);
    }
    m = preset("al", "ptw");
    CHECK_RELATIVE("hardening at zero strain is 2 mu theta", mpm_material_flow(&m, &s).strain_slope,
                   2 * (double)mpm_material_shear_modulus(&m, &s) * (double)m.ptw.theta,
                   64 * (double)MPM_EPSILON);
}

/* Counts falls along strain, rate and (with the sign turned) temperature. */
static void test_monotone(void)
{
    static const char *const names[] = {"al", "cu", "ta", "304"};
    int n, i, j, falls;
    double slack = 1 - 64 * (double)MPM_EPSILON;
    for (n = 0; n < 4; n++) {
        mpm_material m = preset(names[n], "ptw");
        falls = 0;
        for (i = 0; i <= 200; i++) {
            double rate = pow(10, -3 + 0.075 * i), last = 0;
            for (j = 0; j <= 100; j++) {
                double f = flow_MPa(&m, 0.01 * j, rate, 300);
                falls += f < last * slack;
                last = f;
            }
        }
        CHECK_EQUAL("never falls with strain", falls, 0);
        falls = 0;
        for (j = 0; j <= 20; j++) {
            double last = 0;
            for (i = 0; i <= 1500; i++) {
                double f = flow_MPa(&m, 0.05 * j, pow(10, -3 + 0.01 * i), 300);
                falls += f < last * slack;
                last = f;
            }
        }
        CHECK_EQUAL("never falls with rate", falls, 0);
        falls = 0;
        for (i = 0; i <= 150; i++) {
            double last = HUGE_VAL;
            for (j = 0; j <= 500; j++) {
                double f = flow_MPa(&m, 0.1, pow(10, -3 + 0.1 * i), 2.0 * j);
                falls += f * slack > last;
                last = f;
            }
        }
        CHECK_EQUAL("never rises with temperature", falls, 0);
    }
}

/* ---- pressure and waves ------------------------------------------------------------------------ */

static void test_hugoniot(void)
{
    mpm_material m = preset("al", "ptw");
    double worst = 0, worst_curve = 0, up;
    mpm_real p = 0, q = 0;
    for (up = 100; up <= 4000; up += 100) {
        double c0 = (double)m.sound_speed, slope = (double)m.hugoniot_slope, rho0 = (double)m.density;
        double us = c0 + slope * up, want = rho0 * us * up;
        mpm_real rho = (mpm_real)(rho0 * us / (us - up));
        /* an ulp of density moves the pressure by about K eps: allow for it at weak shocks */
        double scale = want + rho0 * c0 * c0 / 1e4;
        if (mpm_material_pressure(&m, rho, (mpm_real)(up * up / 2), &p, NULL) < 0) p = 0;
        if (mpm_material_hugoniot_pressure(&m, rho, &q, NULL) < 0) q = 0;
        worst = check_worst(worst, fabs((double)p - want) / scale);
        worst_curve = check_worst(worst_curve, fabs((double)q - want) / scale);
    }
    CHECK_NEAR("pressure on the Hugoniot is rho0 Us up", worst, 0, 450000 * (double)MPM_EPSILON);
    CHECK_NEAR("hugoniot_pressure likewise", worst_curve, 0, 450000 * (double)MPM_EPSILON);
    CHECK_EQUAL("plate impact at 810 m/s: status",
                mpm_material_hugoniot_pressure(&m, (mpm_real)(2700 * 5928.295 / (5928.295 - 405)), &p, NULL), MPM_OK);
    CHECK_NEAR("plate impact at 810 m/s, GPa", 1e-9 * (double)p, 6.483, 0.0005);
    CHECK_EQUAL("reference density: status", mpm_material_pressure(&m, 2700, 0, &p, NULL), MPM_OK);
    CHECK_TRUE("reference density: no pressure", p == 0);
    CHECK_EQUAL("tension with energy: status", mpm_material_pressure(&m, 2600, 1000, &p, NULL), MPM_OK);
    CHECK_RELATIVE("tension with energy: rho0 c0^2 mu + Gamma0 rho0 e", p,
                   2700 * 5386.0 * 5386.0 * (2600 / 2700.0 - 1) + 1.97 * 2700 * 1000, 100 * (double)MPM_EPSILON);
}

/* A finite density of which the linear law makes an infinite pressure. */
static void test_eos_extreme(void)
{
    mpm_material m = preset("al", "elastic");
    const mpm_real huge = sizeof(mpm_real) == 8 ? (mpm_real)DBL_MAX : (mpm_real)FLT_MAX;
    mpm_fault f = no_fault;
    mpm_real p = 7;
    CHECK_EQUAL("a density far too large", mpm_material_hugoniot_pressure(&m, huge, &p, &f), MPM_ERR_STATE);
    CHECK_TRUE("... names it", strstr(f.field, "density") && f.value == huge);
    CHECK_TRUE("... refused for the energy's pressure too", mpm_material_pressure(&m, huge, 0, &p, &f) < 0);
    CHECK_TRUE("... and leaves the pressure alone", p == 7);
}

static void test_eos_faults(void)
{
    mpm_material m = preset("al", "ptw");
    mpm_fault f = no_fault;
    mpm_real p = 7, limit = (mpm_real)(2700 * (1 + 1 / 0.339));
    CHECK_EQUAL("past the Hugoniot's range", mpm_material_pressure(&m, limit * (mpm_real)1.001, 0, &p, &f),
                MPM_ERR_STATE);
    CHECK_TRUE("... names the density", strstr(f.field, "density") && f.value == limit * (mpm_real)1.001);
    CHECK_TRUE("... and leaves the pressure alone", p == 7);
    CHECK_EQUAL("within it", mpm_material_pressure(&m, limit * (mpm_real)0.99, 0, &p, &f), MPM_OK);
    CHECK_EQUAL("zero density", mpm_material_pressure(&m, 0, 0, &p, &f), MPM_ERR_STATE);
    CHECK_EQUAL("NaN density", mpm_material_pressure(&m, (mpm_real)NAN, 0, &p, &f), MPM_ERR_NAN);
    CHECK_EQUAL("infinite energy", mpm_material_pressure(&m, 2700, (mpm_real)HUGE_VAL, &p, &f), MPM_ERR_NAN);
}

static void test_waves(void)
{
    mpm_material m = preset("al", "ptw"), k = preset("cu", "ptw");
    mpm_real vp = 0, vs = 0;
    double bulk, shear;
    mpm_material_wave_speeds(&m, 2700, &vp, &vs);
    CHECK_RELATIVE("longitudinal", vp, sqrt(0.67 * 70e9 / (0.34 * 1.33 * 2700)), 32 * (double)MPM_EPSILON);
    CHECK_RELATIVE("shear", vs, sqrt(70e9 / (2 * 1.33 * 2700)), 32 * (double)MPM_EPSILON);
    mpm_material_wave_speeds(&k, 8930, &vp, &vs);
    bulk = 8930 * ((double)vp * (double)vp - 4.0 / 3 * (double)vs * (double)vs);
    shear = 8930 * (double)vs * (double)vs;
    CHECK_RELATIVE("computed moduli give back rho c0^2", bulk, 8930 * 3940.0 * 3940.0, 64 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... and G0", shear, 47.7e9, 64 * (double)MPM_EPSILON);
}

/* The shock of a stiffened gas in closed form: c0^2 = g P/rho0, Us^2 - (g + 1)/2 up Us = c0^2, p = rho0 Us up. */
static void test_user_eos(void)
{
    const stiffened water = {MPM_R(6.1), MPM_R(2e9)};
    stiffened broken = water;
    mpm_material m = preset("al", "elastic");
    mpm_fault f = no_fault;
    double worst = 0, up, c2;
    mpm_real p = 7;
    m.density = 1000;
    m.eos = MPM_EOS_USER;
    CHECK_EQUAL("a user equation of state needs its function", mpm_material_check(&m, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... named", !strcmp(f.field, "eos_fn"));
    m.eos_fn = stiffened_gas;
    m.eos_context = &water;
    CHECK_EQUAL("... has it", mpm_material_check(&m, &f), MPM_OK);
    CHECK_EQUAL("pressure of a stiffened gas, status", mpm_material_pressure(&m, 1100, 5000, &p, &f), MPM_OK);
    CHECK_RELATIVE("pressure of a stiffened gas", p, 5.1 * 1100 * 5000 + 6.1 * 2e9 * 0.1, 40 * (double)MPM_EPSILON);
    c2 = 6.1 * 2e9 / 1000;
    for (up = 100; up <= 3000; up += 100) {
        double us = 7.1 / 4 * up + sqrt(7.1 / 4 * up * (7.1 / 4 * up) + c2), want = 1000 * us * up;
        mpm_real rho = (mpm_real)(1000 * us / (us - up));
        if (mpm_material_hugoniot_pressure(&m, rho, &p, &f) != MPM_OK) p = 0;
        /* an ulp of density moves the pressure by rho c^2 eps in weak shocks, and by far more in strong ones */
        worst = check_worst(worst, fabs((double)p - want) / (want + 1000 * c2) * (1.392 - (double)rho / 1000));
    }
    CHECK_NEAR("its shock in closed form", worst, 0, 40 * (double)MPM_EPSILON);
    CHECK_EQUAL("in tension, status", mpm_material_hugoniot_pressure(&m, 900, &p, &f), MPM_OK);
    CHECK_RELATIVE("... the pressure without energy", p, -6.1 * 2e8, 40 * (double)MPM_EPSILON);
    p = 7;
    CHECK_EQUAL("denser than any shock makes it", mpm_material_hugoniot_pressure(&m, 1393, &p, &f), MPM_ERR_STATE);
    CHECK_TRUE("... names the density", strstr(f.field, "density") && f.value == 1393 && p == 7);
    broken.P = (mpm_real)NAN;
    m.eos_context = &broken;
    CHECK_EQUAL("its NaN: pressure", mpm_material_pressure(&m, 1100, 0, &p, &f), MPM_ERR_NAN);
    CHECK_TRUE("... named", !strcmp(f.field, "pressure of point") && p == 7);
    f = no_fault;
    CHECK_EQUAL("its NaN: reference curve", mpm_material_hugoniot_pressure(&m, 1100, &p, &f), MPM_ERR_NAN);
    CHECK_TRUE("... named", !strcmp(f.field, "pressure of point") && p == 7);
}

/* ---- presets ------------------------------------------------------------------------------------ */

static void test_presets(void)
{
    static const char *const models[] = {"elastic", "linear", "jc", "scg", "ptw"};
    mpm_units systems[3];
    mpm_fault f = no_fault;
    mpm_material m, before;
    int i, j, k, sets = 0, bad = 0, differ = 0;
    systems[0] = mpm_units_si();
    systems[1] = mpm_units_um_us_ng();
    systems[2] = mpm_units_mm_ms_g();
    for (i = 0; i < mpm_material_preset_count(); i++)
        for (j = 0; j < 5; j++) {
            double stress[3] = {0, 0, 0};
            for (k = 0; k < 3; k++) {
                mpm_material_state s;
                if (mpm_material_preset(&m, mpm_material_preset_name(i), &systems[k], &f) != MPM_OK) bad++;
                if (mpm_material_model(&m, models[j], &f) != MPM_OK) break;
                if (mpm_material_check(&m, &f) != MPM_OK) bad++;
                sets++;
                s = state(0.1, 1e6 * systems[k].time, 350, 1.01 * (double)m.density, 0);
                stress[k] = (double)mpm_material_flow_stress(&m, &s) * mpm_units_stress(&systems[k]);
            }
            if (k < 3 || j == 0) continue;
            for (k = 1; k < 3; k++) differ += !(fabs(stress[k] / stress[0] - 1) <= TIGHT);
        }
    CHECK_EQUAL("every preset and model passes the check", bad, 0);
    CHECK_EQUAL("number of published sets, in three unit systems", sets, 3 * 35);
    CHECK_EQUAL("same stress in SI, um-us-ng and mm-ms-g", differ, 0);
    CHECK_TRUE("no name beyond the last",
               !mpm_material_preset_name(mpm_material_preset_count()) && !mpm_material_preset_name(-1));
    m = before = preset("al", "ptw");
    CHECK_EQUAL("unknown material", mpm_material_preset(&m, "cheese", &systems[0], &f), MPM_ERR_UNKNOWN);
    CHECK_EQUAL("unknown model", mpm_material_model(&m, "magic", &f), MPM_ERR_UNKNOWN);
    CHECK_TRUE("... says model", !strcmp(f.field, "model"));
    CHECK_EQUAL("no Johnson-Cook set for al", mpm_material_model(&m, "jc", &f), MPM_ERR_UNKNOWN);
    CHECK_TRUE("... says model of material", !strcmp(f.field, "model of material"));
    CHECK_TRUE("failure leaves the material alone",
               m.strength == before.strength && m.shear_modulus == before.shear_modulus);
    systems[0].mass = 0;
    CHECK_EQUAL("zero unit of mass", mpm_material_preset(&m, "al", &systems[0], &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... says units.mass", !strcmp(f.field, "units.mass"));
}

/* Sets one field to a bad value and expects the check to name it. */
static void expect_fault(mpm_real *member, const mpm_material *m, mpm_real value,
                         const char *field, mpm_status status)
{
    mpm_fault f = no_fault;
    mpm_real old = *member;
    *member = value;
    CHECK_EQUAL(field, mpm_material_check(m, &f), status);
    CHECK_TRUE("... named, with its value",
               !strcmp(f.field, field) && (f.value == value || value != value));
    *member = old;
}

static void test_check(void)
{
    mpm_material m = preset("al", "ptw"), bare = mpm_material_default();
    mpm_fault f = no_fault;
    mpm_real nan = (mpm_real)NAN;
    expect_fault(&m.density, &m, 0, "density", MPM_ERR_ARGUMENT);
    expect_fault(&m.young, &m, nan, "young", MPM_ERR_NAN);
    expect_fault(&m.poisson, &m, (mpm_real)0.5, "poisson", MPM_ERR_ARGUMENT);
    expect_fault(&m.heat_fraction, &m, 2, "heat_fraction", MPM_ERR_ARGUMENT);
    expect_fault(&m.specific_heat, &m, 0, "specific_heat", MPM_ERR_ARGUMENT);
    expect_fault(&m.shear_floor, &m, 0, "shear_floor", MPM_ERR_ARGUMENT);
    expect_fault(&m.sound_speed, &m, -1, "sound_speed", MPM_ERR_ARGUMENT);
    expect_fault(&m.melt_temperature, &m, nan, "melt_temperature", MPM_ERR_NAN);
    expect_fault(&m.ptw.y0, &m, 1, "ptw.y0", MPM_ERR_ARGUMENT);
    expect_fault(&m.ptw.gamma, &m, nan, "ptw.gamma", MPM_ERR_NAN);
    expect_fault(&m.ptw.atomic_mass, &m, 0, "ptw.atomic_mass", MPM_ERR_ARGUMENT);
    expect_fault(&m.viscosity_linear, &m, -1, "viscosity_linear", MPM_ERR_ARGUMENT);
    CHECK_EQUAL("an unset material fails", mpm_material_check(&bare, &f), MPM_ERR_ARGUMENT);
    m.strength = MPM_STRENGTH_USER;
    CHECK_EQUAL("a user strength needs its function", mpm_material_check(&m, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... named", !strcmp(f.field, "strength_fn"));
    m = preset("cu", "jc");
    expect_fault(&m.melt_temperature, &m, m.jc.temperature, "melt_temperature", MPM_ERR_ARGUMENT);
    m = preset("cu", "ptw");
    CHECK_TRUE("cu has y0 = yinf, and passes", m.ptw.y0 == m.ptw.yinf && mpm_material_check(&m, &f) == MPM_OK);
    m = preset("ta", "ptw");
    CHECK_TRUE("ta has y1 = s0, and passes", m.ptw.y1 == m.ptw.s0 && mpm_material_check(&m, &f) == MPM_OK);
}

/* A choice outside its list, and a material that was never filled, are refused by name. */
static void test_choices(void)
{
    static const char *const fields[] = {"strength", "shear", "melt", "eos", "mapping", "rotation"};
    mpm_material m[6], zero;
    mpm_fault f = no_fault;
    int i;
    for (i = 0; i < 6; i++) m[i] = preset("al", "ptw");
    m[0].strength = (mpm_strength)7;
    m[1].shear = (mpm_shear)3;
    m[2].melt = (mpm_melt)3;
    m[3].eos = (mpm_eos)3;
    m[4].mapping = (mpm_return_mapping)2;
    m[5].rotation = (mpm_rotation)2;
    for (i = 0; i < 6; i++) {
        CHECK_EQUAL(fields[i], mpm_material_check(&m[i], &f), MPM_ERR_ARGUMENT);
        CHECK_TRUE("... named", !strcmp(f.field, fields[i]));
    }
    memset(&zero, 0, sizeof zero);
    CHECK_EQUAL("a zeroed material", mpm_material_check(&zero, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... named", !strcmp(f.field, "material (not from mpm_material_default)"));
    f = no_fault;
    CHECK_EQUAL("... has no model either", mpm_material_model(&zero, "jc", &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... named", !strcmp(f.field, "material (not from mpm_material_default)"));
    zero = mpm_material_default();
    CHECK_EQUAL("one without a name", mpm_material_model(&zero, "jc", &f), MPM_ERR_UNKNOWN);
    CHECK_TRUE("... is no metal", !strcmp(f.field, "material"));
}

/* The names of the lists, in the order of their enums. */
static void test_lists(void)
{
    CHECK_TRUE("strengths", !strcmp(MPM_NAMES(MPM_STRENGTH_LIST), "elastic|linear|jc|scg|ptw|user"));
    CHECK_TRUE("shear moduli", !strcmp(MPM_NAMES(MPM_SHEAR_LIST), "constant|mts|scg"));
    CHECK_TRUE("melting laws", !strcmp(MPM_NAMES(MPM_MELT_LIST), "none|constant|scg"));
    CHECK_TRUE("equations of state", !strcmp(MPM_NAMES(MPM_EOS_LIST), "linear|mie-grueneisen|user"));
    CHECK_TRUE("return mappings", !strcmp(MPM_NAMES(MPM_RETURN_LIST), "consistent|staged"));
    CHECK_TRUE("rotations", !strcmp(MPM_NAMES(MPM_ROTATION_LIST), "proper|jaumann"));
    CHECK_EQUAL("the default is the first of each", MPM_STRENGTH_ELASTIC + MPM_SHEAR_CONSTANT + MPM_MELT_NONE +
                MPM_EOS_LINEAR + MPM_RETURN_CONSISTENT + MPM_ROTATION_PROPER, 0);
}

int main(void)
{
    test_flow_stress_against_long_double();
    test_numbers();
    test_melting_table();
    test_melting_points();
    test_rate_limits();
    test_temperature_limits();
    test_hardening_limits();
    test_slopes();
    test_monotone();
    test_hugoniot();
    test_eos_faults();
    test_eos_extreme();
    test_waves();
    test_user_eos();
    test_presets();
    test_check();
    test_choices();
    test_lists();
    return check_end();
}
