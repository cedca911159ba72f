/* 11_update.c - the stress update of mpm_ptw.h, driven without a grid. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_ptw.h"
#include "check.h"
#include "stiffened.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define EPS ((double)MPM_EPSILON)
/* How well the consistent return meets the flow law: the promise in double, rounding in float. */
#define MET (sizeof(mpm_real) == 8 ? 1e-9 : 400 * EPS)

enum { MOST = 200 };

/* Points with the arrays a block needs. */
typedef struct points {
    mpm_real strain[6][MOST], spin[3][MOST], density[MOST], stress[6][MOST], energy[MOST];
    mpm_real temperature[MOST], plastic_strain[MOST], plastic_rate[MOST], plastic_work[MOST];
    mpm_real kept[MOST]; /* the user field */
} points;

static mpm_material preset(const char *name, const char *model, mpm_units units)
{
    mpm_material m = mpm_material_default();
    if (mpm_material_preset(&m, name, &units, NULL) != MPM_OK ||
        (*model && mpm_material_model(&m, model, NULL) != MPM_OK)) {
        printf("not ok 0 - no preset %s %s\n", name, model);
        exit(1);
    }
    m.flow_field = 0;
    return m;
}

static void reset(points *p, const mpm_material *m)
{
    int i;
    memset(p, 0, sizeof *p);
    for (i = 0; i < MOST; i++) {
        p->density[i] = m->density;
        p->temperature[i] = m->temperature;
    }
}

/* What the law counted, all blocks together. */
static int64_t counted[MPM_TALLIES];

/* Updates points first .. first+count-1. */
static mpm_status update(points *p, const mpm_material *m, int first, int count, double dt, mpm_fault *fault)
{
    mpm_block b;
    int j;
    memset(&b, 0, sizeof b);
    b.count = count;
    b.dt = (mpm_real)dt;
    b.cell = 1;
    for (j = 0; j < 6; j++) {
        b.strain[j] = p->strain[j] + first;
        b.stress[j] = p->stress[j] + first;
    }
    for (j = 0; j < 3; j++) b.spin[j] = p->spin[j] + first;
    b.density = p->density + first;
    b.energy = p->energy + first;
    b.temperature = p->temperature + first;
    b.plastic_strain = p->plastic_strain + first;
    b.plastic_rate = p->plastic_rate + first;
    b.plastic_work = p->plastic_work + first;
    b.user[0] = p->kept + first;
    b.tally = counted;
    b.fault = fault;
    return mpm_material_stress(m, &b);
}

/* Gives point i a strain increment and the density that follows from it (A 3.36). */
static void strain(points *p, int i, double xx, double yy, double zz, double yz, double xz, double xy)
{
    const double e[6] = {xx, yy, zz, yz, xz, xy};
    int j;
    for (j = 0; j < 6; j++) p->strain[j][i] = (mpm_real)e[j];
    p->density[i] /= 1 + (p->strain[0][i] + p->strain[1][i] + p->strain[2][i]);
}

static double mises(const points *p, int i)
{
    double s[6], mean, sum = 0;
    int j;
    for (j = 0; j < 6; j++) s[j] = (double)p->stress[j][i];
    mean = (s[0] + s[1] + s[2]) / 3;
    for (j = 0; j < 3; j++) sum += 1.5 * (s[j] - mean) * (s[j] - mean) + 3 * s[j + 3] * s[j + 3];
    return sqrt(sum);
}

/* A repeatable number in -1 .. 1. */
static double random_number(unsigned long *seed)
{
    *seed = (*seed * 1103515245ul + 12345ul) & 0x7ffffffful;
    return (double)(*seed >> 8) / (double)0x3fffff - 1;
}

/* ---- elasticity ----------------------------------------------------------------------------- */

static void test_elastic(void)
{
    mpm_material m = preset("al", "elastic", mpm_units_si());
    double G = 70e9 / (2 * 1.33), K = 70e9 / (3 * 0.34), e = 1e-4, mu;
    points p;
    int i;
    reset(&p, &m);
    for (i = 0; i < 10; i++) {
        strain(&p, 0, 0, 0, -e, 0, 0, 0);
        strain(&p, 1, 0, 0, 0, 0, e, 0);
        CHECK_EQUAL("elastic step, status", update(&p, &m, 0, 2, 1e-9, NULL), MPM_OK);
    }
    mu = (double)p.density[0] / 2700 - 1;
    CHECK_RELATIVE("uniaxial strain: axial stress", p.stress[2][0], -K * mu - 4.0 / 3 * G * 10 * e,
                   1e5 * EPS);
    CHECK_RELATIVE("uniaxial strain: lateral stress", p.stress[0][0], -K * mu + 2.0 / 3 * G * 10 * e,
                   1e5 * EPS);
    CHECK_RELATIVE("shear: 2 G eps", p.stress[4][1], 2 * G * 10 * e, 64 * EPS);
    CHECK_RELATIVE("shear: energy per volume is 2 G eps^2", 2700 * (double)p.energy[1],
                   2 * G * 100 * e * e, 256 * EPS);
    CHECK_TRUE("nothing plastic", p.plastic_strain[0] == 0 && p.plastic_rate[0] == 0 && p.plastic_work[0] == 0);
    CHECK_TRUE("nothing heated", p.temperature[0] == m.temperature);
}

/* ---- rotation ------------------------------------------------------------------------------- */

static void stressed(points *p, mpm_material *m)
{
    reset(p, m);
    p->stress[0][0] = (mpm_real)3e6;
    p->stress[1][0] = (mpm_real)-1e6;
    p->stress[2][0] = (mpm_real)-2e6;
    p->stress[3][0] = (mpm_real)5e5;
    p->stress[4][0] = (mpm_real)-7e5;
    p->stress[5][0] = (mpm_real)9e5;
}

static void test_rotation(void)
{
    mpm_material m = preset("al", "elastic", mpm_units_si());
    double pi = acos(-1.0), before, growth;
    points p;
    int i, j, steps = 1000;
    stressed(&p, &m);
    before = mises(&p, 0);
    for (j = 0; j < 3; j++) p.spin[j][0] = (mpm_real)(2 * pi / steps * (j == 0 ? 0.36 : j == 1 ? 0.48 : 0.8));
    for (i = 0; i < 10 * steps; i++)
        if (update(&p, &m, 0, 1, 1e-9, NULL) != MPM_OK) break;
    CHECK_EQUAL("ten revolutions run", i, 10 * steps);
    /* rounding errors of 1e4 steps, if they all add up */
    CHECK_RELATIVE("proper rotation keeps the von Mises stress", mises(&p, 0), before, 1e4 * 2 * EPS);
    CHECK_NEAR("... and the trace", p.stress[0][0] + p.stress[1][0] + p.stress[2][0], 0, before * 1e4 * EPS);

    /* a quarter turn about z, small steps: xx and yy change places, x turns to y */
    reset(&p, &m);
    p.stress[0][0] = (mpm_real)1e6;
    p.stress[4][0] = (mpm_real)2e5;
    p.spin[2][0] = (mpm_real)(pi / 2 / steps);
    for (i = 0; i < steps; i++)
        if (update(&p, &m, 0, 1, 1e-9, NULL) != MPM_OK) break;
    CHECK_EQUAL("quarter turn runs", i, steps);
    /* pressure is reset by the equation of state at once: the deviator of xx is 2/3 of it. The angle
       of one step is 2 atan(w/2), short of w by w^3/12: together 3e-7 of the turn. */
    CHECK_NEAR("quarter turn: yy - xx", p.stress[1][0] - p.stress[0][0], 1e6, 1e6 * (1e-5 + steps * EPS));
    CHECK_NEAR("quarter turn: xz became yz", p.stress[3][0], 2e5, 1e6 * (1e-5 + steps * EPS));

    m.rotation = MPM_ROTATION_JAUMANN;
    reset(&p, &m);
    p.stress[5][0] = (mpm_real)1e6;
    p.spin[2][0] = (mpm_real)(2 * pi / steps);
    before = mises(&p, 0);
    for (i = 0; i < steps; i++)
        if (update(&p, &m, 0, 1, 1e-9, NULL) != MPM_OK) break;
    growth = pow(1 + 16 * pi * pi / steps / steps, steps / 2.0);
    CHECK_RELATIVE("Jaumann A2 stretches an in-plane deviator as it must", mises(&p, 0) / before, growth,
                   steps * 4 * EPS);
    CHECK_NEAR("... by 1.082 in 1000 steps", growth, 1.082, 0.0005);
}

/* ---- the return ------------------------------------------------------------------------------ */

/* Random strains of very different sizes on a material, some steps, every state checked against the
   flow law. Returns the worst miss of the law, and counts plastic points. */
static double drive(mpm_material *m, double dt, int *plastic, int *wrong)
{
    points p, old;
    unsigned long seed = 7;
    double worst = 0;
    int i, j, k;
    *plastic = *wrong = 0;
    reset(&p, m);
    for (k = 0; k < 30; k++) {
        for (i = 0; i < MOST; i++) {
            double e[6], size = pow(10, -6 + 4.5 * i / MOST);
            for (j = 0; j < 6; j++) e[j] = size * (random_number(&seed) + (j == 5 ? 0.6 : 0));
            strain(&p, i, e[0], e[1], e[2], e[3], e[4], e[5]);
            for (j = 0; j < 3; j++) p.spin[j][i] = (mpm_real)(size * random_number(&seed));
        }
        old = p;
        if (update(&p, m, 0, MOST, dt, NULL) < 0) return HUGE_VAL;
        for (i = 0; i < MOST; i++) {
            mpm_material_state s;
            mpm_flow law;
            double flow, vm = mises(&p, i), pressure, mu, d, blur;
            s.plastic_strain = p.plastic_strain[i];
            s.plastic_rate = p.plastic_rate[i];
            s.temperature = old.temperature[i];
            s.density = p.density[i];
            s.pressure = -(old.stress[0][i] + old.stress[1][i] + old.stress[2][i]) / 3;
            law = mpm_material_flow(m, &s);
            flow = (double)law.stress;
            mu = (double)mpm_material_shear_modulus(m, &s);
            d = dt * (double)p.plastic_rate[i];
            pressure = fabs((double)p.stress[0][i] + (double)p.stress[1][i] + (double)p.stress[2][i]) / 3;
            /* The components hold the deviator only to the rounding of the pressure, and an increment
               is known only to the rounding of the elastic strain (below it, it is none). */
            if (3 * mu * d > 4 * EPS * vm) {
                ++*plastic;
                blur = 8 * EPS * pressure + (double)law.rate_slope * EPS * vm / (3 * mu * d);
                worst = check_worst(worst, check_worst(fabs(vm - flow) - blur, 0) / fmax(flow, 1e-9 * mu));
            } else {
                s.plastic_rate = (mpm_real)(4 * EPS * vm / (3 * mu * dt));
                flow = (double)mpm_material_flow_stress(m, &s);
                *wrong += vm > flow * (1 + MET) + 8 * EPS * pressure;
            }
        }
    }
    return worst;
}

static void test_consistent_return(void)
{
    static const char *const cases[][2] = {{"al", "ptw"}, {"cu", "ptw"}, {"ta", "ptw"}, {"304", "ptw"},
                                           {"al6061-t6", "jc"}, {"cu", "jc"}, {"cu", "scg"}, {"ti", "scg"},
                                           {"cu", "linear"}};
    static const double steps[] = {1e-3, 1e-8, 1e-12};
    int i, j, plastic, wrong;
    for (i = 0; i < 9; i++)
        for (j = 0; j < 3; j++) {
            mpm_material m = preset(cases[i][0], cases[i][1], mpm_units_si());
            char what[100];
            double worst = drive(&m, steps[j], &plastic, &wrong);
            sprintf(what, "%s %s, dt %g s, %s", cases[i][0], cases[i][1], steps[j],
                    "von Mises stress against the flow law");
            CHECK_NEAR(what, worst, 0, MET);
            CHECK_TRUE("... with elastic and plastic points", plastic > 100 && plastic < 30 * MOST);
            CHECK_EQUAL("... no point left above the static flow stress", wrong, 0);
            CHECK_EQUAL("... and no search at its cap", (long)counted[MPM_TALLY_ITERATION], 0);
        }
}

/* One block of MOST points must give the bits that MOST blocks of one point give. */
static void test_block_is_point(void)
{
    mpm_return_mapping maps[2] = {MPM_RETURN_CONSISTENT, MPM_RETURN_STAGED};
    int i, j, k, r, same;
    for (r = 0; r < 2; r++) {
        mpm_material m = preset("al", "ptw", mpm_units_si());
        points p, q;
        unsigned long seed = 99;
        m.mapping = maps[r];
        reset(&p, &m);
        for (k = 0, same = 1; k < 10; k++) {
            for (i = 0; i < MOST; i++) {
                double e[6];
                for (j = 0; j < 6; j++) e[j] = 2e-3 * random_number(&seed) * (i % 3);
                strain(&p, i, e[0], e[1], e[2], e[3], e[4], e[5]);
            }
            q = p;
            if (update(&p, &m, 0, MOST, 1e-9, NULL) < 0) same = 0;
            for (i = 0; i < MOST; i++)
                if (update(&q, &m, i, 1, 1e-9, NULL) < 0) same = 0;
            same = same && !memcmp(&p, &q, sizeof p);
        }
        CHECK_TRUE(r ? "staged: a block is its points, bit for bit" : "consistent: a block is its points, bit for bit",
                   same);
    }
}

/* Simple shear of al to a strain of 0.2 at 1e6 /s in n steps; returns the final von Mises stress. */
static double shear_test(mpm_return_mapping mapping, int n, points *p)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    double total = 0.2, dt = 0.2e-6 / n;
    int i;
    m.mapping = mapping;
    reset(p, &m);
    for (i = 0; i < n; i++) {
        strain(p, 0, 0, 0, 0, 0, total * sqrt(3.0) / 2 / n, 0);
        if (update(p, &m, 0, 1, dt, NULL) < 0) return 0;
    }
    return mises(p, 0);
}

static void test_staged(void)
{
    points p;
    mpm_material m = preset("al", "ptw", mpm_units_si());
    double exact = shear_test(MPM_RETURN_CONSISTENT, 16000, &p), flowed = (double)p.plastic_strain[0];
    double staged[3], consistent[3];
    int i, n = 125;
    for (i = 0; i < 3; i++, n *= 2) {
        staged[i] = shear_test(MPM_RETURN_STAGED, n, &p) - exact;
        consistent[i] = shear_test(MPM_RETURN_CONSISTENT, n, &p) - exact;
    }
    printf("# error in MPa at 125, 250, 500 steps: staged %.4g %.4g %.4g, consistent %.4g %.4g %.4g\n",
           1e-6 * staged[0], 1e-6 * staged[1], 1e-6 * staged[2], 1e-6 * consistent[0],
           1e-6 * consistent[1], 1e-6 * consistent[2]);
    if (sizeof(mpm_real) == 8) {
        CHECK_NEAR("consistent: first order, 125 to 250 steps", consistent[0] / consistent[1], 2, 0.2);
        CHECK_NEAR("consistent: first order, 250 to 500 steps", consistent[1] / consistent[2], 2, 0.2);
    }
    for (i = 0; i < 3; i++) CHECK_NEAR("both agree to 0.1 %", (staged[i] - consistent[i]) / exact, 0, 1e-3);
    (void)shear_test(MPM_RETURN_STAGED, 16000, &p);
    CHECK_TRUE("staged: at 16000 steps it goes by leaps, and plastic strain is lost",
               (double)p.plastic_strain[0] < 0.97 * flowed && (double)p.plastic_strain[0] > 0.5 * flowed);
    m.mapping = MPM_RETURN_STAGED;
    reset(&p, &m);
    strain(&p, 0, 0, 0, 0, 0, 0.01, 0);
    CHECK_EQUAL("staged, one large step", update(&p, &m, 0, 1, 1e-12, NULL), MPM_OK);
    CHECK_TRUE("the factor is capped at 1",
               mises(&p, 0) <= sqrt(3.0) * 2 * (double)m.shear_modulus * 0.01 * (1 + 16 * EPS));
}

/* One point in shear, by A6 - A8 as they are printed. */
typedef struct stages {
    mpm_material_state at;
    double shear, kept, work; /* stress, flow stress of the last return, plastic work */
} stages;

static void stage(stages *s, const mpm_material *m, double de, double dt)
{
    double mu = (double)mpm_material_shear_modulus(m, &s->at), old = s->shear, trial = old + 2 * mu * de;
    double mises = sqrt(3.0) * fabs(trial), y, d;
    mpm_flow f;
    if (!(s->at.plastic_rate > 0)) s->at.plastic_rate = (mpm_real)(2 / sqrt(3.0) * fabs(de) / dt);
    f = mpm_material_flow(m, &s->at);
    y = s->kept > 0 ? s->kept : (double)f.stress;
    s->shear = trial;
    s->at.plastic_rate = 0;
    if (mises <= y) return;
    d = (mises - y) / (3 * mu + (double)f.strain_slope);
    s->at.plastic_strain += (mpm_real)d;
    s->at.plastic_rate = (mpm_real)(d / dt);
    s->kept = (double)mpm_material_flow_stress(m, &s->at);
    s->shear *= fmin(s->kept / mises, 1);
    d = (old + s->shear) * (trial - s->shear) / (2 * mu);
    s->work += d;
    s->at.temperature += (mpm_real)((double)m->heat_fraction * d / ((double)m->density * (double)m->specific_heat));
}

/* Strain at rates between 1e5 and 1e7 /s, each kept for some steps, forth and back, never twice to the same stress. */
static double uneven(int k)
{
    return (k / 60 % 2 ? -1 : 1) * 1e-5 * pow(10, 2 * (k / 7 % 5) / 4.0) * (k % 11 == 10 ? -0.37 : 1);
}

static void test_staged_path(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    const double close = sizeof(mpm_real) == 8 ? 1e-9 : 0.02; /* an error in d grows through its logarithm */
    points p;
    stages s;
    int k;
    memset(&s, 0, sizeof s);
    m.mapping = MPM_RETURN_STAGED;
    reset(&p, &m);
    s.at.density = m.density;
    s.at.temperature = m.temperature;
    for (k = 0; k < 100; k++) {
        strain(&p, 0, 0, 0, 0, 0, 0, uneven(k));
        CHECK_EQUAL("staged path, status", update(&p, &m, 0, 1, 1e-10, NULL), MPM_OK);
        stage(&s, &m, uneven(k), 1e-10);
    }
    CHECK_TRUE("staged path: much flow", s.at.plastic_strain > 0.003);
    CHECK_RELATIVE("staged path: plastic strain as A6 prints it", p.plastic_strain[0], s.at.plastic_strain, close);
    CHECK_RELATIVE("... shear stress", p.stress[5][0], s.shear, close);
    CHECK_RELATIVE("... plastic work", p.plastic_work[0], s.work, close);
    CHECK_RELATIVE("... temperature", p.temperature[0], s.at.temperature, close);
    CHECK_RELATIVE("... the flow stress kept", p.kept[0], s.kept, close);
}

/* Plastic work and elastic energy add up to what the strain put in, by random strains of all directions. */
static void test_staged_energy(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    double elastic, given, mu;
    points p;
    unsigned long seed = 5;
    mpm_material_state cold = {0, 0, 298, 2700, 0};
    int k, j;
    m.mapping = MPM_RETURN_STAGED;
    m.heat_fraction = 0; /* one shear modulus */
    mu = (double)mpm_material_shear_modulus(&m, &cold);
    reset(&p, &m);
    for (k = 0; k < 400; k++) {
        double e[6];
        for (j = 0; j < 6; j++) e[j] = 2e-3 * random_number(&seed) * (k % 5 == 0 ? 1 : 0.1);
        strain(&p, 0, e[0], e[1], -e[0] - e[1], e[3], e[4], e[5]);
        CHECK_EQUAL("staged energy, status", update(&p, &m, 0, 1, 1e-10, NULL), MPM_OK);
    }
    elastic = mises(&p, 0) * mises(&p, 0) / (6 * mu);
    given = 2700 * (double)p.energy[0];
    CHECK_TRUE("much of it plastic", (double)p.plastic_work[0] > 10 * elastic && p.plastic_strain[0] > 0);
    CHECK_RELATIVE("staged: plastic + elastic = given", (double)p.plastic_work[0] + elastic, given, 1e4 * EPS);
}

/* A staged return needs its field. */
static void test_staged_field(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    mpm_block b;
    mpm_fault fault;
    m.mapping = MPM_RETURN_STAGED;
    memset(&b, 0, sizeof b);
    b.dt = 1;
    b.fault = &fault;
    CHECK_EQUAL("staged without a user field", mpm_material_stress(&m, &b), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... says so", !strncmp(fault.field, "user_fields", 11));
    m.flow_field = mpm_material_default().flow_field;
    CHECK_EQUAL("... with none chosen", mpm_material_stress(&m, &b), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... names the choice", fault.value < 0);
}

/* ---- energy and heat -------------------------------------------------------------------------- */

static void test_heat(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    points p;
    double heat, elastic, vm;
    int i, n = 2000;
    (void)shear_test(MPM_RETURN_CONSISTENT, n, &p);
    heat = (double)(p.temperature[0] - m.temperature) * 2700 * 900;
    CHECK_RELATIVE("heat is chi times plastic work", heat, 0.9 * (double)p.plastic_work[0], 3.0 * n * EPS);
    vm = mises(&p, 0);
    elastic = vm * vm / (6 * 25.5e9);
    /* the trapezoid of the work and the end point of the plastic part differ by half a step */
    CHECK_RELATIVE("internal energy is plastic work plus elastic energy", 2700 * (double)p.energy[0],
                   (double)p.plastic_work[0] + elastic, 2.0 / n + 3.0 * n * EPS);
    CHECK_RELATIVE("plastic strain is the total less the elastic", p.plastic_strain[0],
                   0.2 - vm / (3 * 25.5e9), 1e-4 + n * EPS);

    m = preset("cu", "linear", mpm_units_si());
    reset(&p, &m);
    for (i = 0; i < 100; i++) {
        strain(&p, 0, 0, 0, 0, 0, 0, 1e-3);
        if (update(&p, &m, 0, 1, 1e-6, NULL) != MPM_OK) break;
    }
    CHECK_EQUAL("linear hardening runs", i, 100);
    {
        double G = 117e9 / 2.7, e = 0.2 / sqrt(3.0), plastic = (3 * G * e - 400e6) / (3 * G + 100e6);
        CHECK_RELATIVE("linear hardening in closed form: strain", p.plastic_strain[0], plastic, 400 * EPS);
        CHECK_RELATIVE("linear hardening in closed form: stress", mises(&p, 0), 400e6 + 100e6 * plastic,
                       400 * EPS);
    }
}

static void test_melting(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    points p;
    reset(&p, &m);
    p.temperature[0] = 1100; /* over T_m0 */
    p.stress[0][0] = (mpm_real)1e8;
    p.stress[5][0] = (mpm_real)3e7;
    p.temperature[1] = 1100;
    strain(&p, 0, 0, 0, 0, 0, 1e-3, 0);
    CHECK_EQUAL("melted: status", update(&p, &m, 0, 2, 1e-9, NULL), MPM_OK);
    CHECK_TRUE("melted: no deviator", mises(&p, 0) == 0 && p.stress[4][0] == 0);
    CHECK_TRUE("melted: it flowed, without heat", p.plastic_strain[0] > 0 && p.temperature[0] == 1100 &&
                                                   p.plastic_work[0] == 0);
    CHECK_TRUE("melted at rest: nothing happens", p.plastic_strain[1] == 0 && p.stress[0][1] == 0);
    p.density[2] = 2700 / (mpm_real)0.98;
    p.temperature[2] = 1100;
    p.stress[5][2] = (mpm_real)1e7;
    CHECK_EQUAL("compressed: status", update(&p, &m, 2, 1, 1e-9, NULL), MPM_OK);
    CHECK_TRUE("compression raises the melting point: solid at 1100 K", p.stress[5][2] == (mpm_real)1e7);
    m.melt = MPM_MELT_NONE;
    counted[MPM_TALLY_SHEAR_FLOOR] = 0;
    p.temperature[3] = 1950;
    CHECK_EQUAL("beyond the zero of mu(T): clamped", update(&p, &m, 3, 1, 1e-9, NULL), MPM_CLAMPED);
    CHECK_EQUAL("... and counted", (long)counted[MPM_TALLY_SHEAR_FLOOR], 1);
}

/* dE/dv = -p along the isentrope of al from rest, by Runge-Kutta in long double: the pressure at a
   relative volume. */
static double isentrope(const mpm_material *m, double v_end, double *energy)
{
    long double E = 0, v = 1, h;
    long double K = (long double)m->density * m->sound_speed * m->sound_speed;
    long double G = (long double)m->gruneisen, s = (long double)m->hugoniot_slope;
    int i, n = 2000;
    h = ((long double)v_end - 1) / n;
#define PRESSURE(w, e) \
    (K * (1 / (w) - 1) * (1 / (w)) / ((1 - (s - 1) * (1 / (w) - 1)) * (1 - (s - 1) * (1 / (w) - 1))) * \
     (1 - G * (1 - (w)) / 2) + G * (e))
    for (i = 0; i < n; i++) {
        long double k1 = -PRESSURE(v, E), k2 = -PRESSURE(v + h / 2, E + h / 2 * k1);
        long double k3 = -PRESSURE(v + h / 2, E + h / 2 * k2), k4 = -PRESSURE(v + h, E + h * k3);
        E += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        v += h;
    }
    *energy = (double)E;
    return (double)PRESSURE(v, E);
#undef PRESSURE
}

static void test_isentrope(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    points p;
    double error[2], energy, want, got, trace;
    int r, i, n;
    for (r = 0, n = 20; r < 2; r++, n *= 2) {
        double dv = -0.1 / n, v = 1;
        reset(&p, &m);
        for (i = 0; i < n; i++, v += dv) {
            strain(&p, 0, dv / v / 3, dv / v / 3, dv / v / 3, 0, 0, 0);
            if (update(&p, &m, 0, 1, 1e-9, NULL) != MPM_OK) break;
        }
        want = isentrope(&m, 2700 / (double)p.density[0], &energy);
        trace = (double)p.stress[0][0] + (double)p.stress[1][0] + (double)p.stress[2][0];
        got = -trace / 3;
        error[r] = 2700 * (double)p.energy[0] / energy - 1;
        CHECK_RELATIVE("adiabatic compression by 10 % in few steps: pressure", got, want, 1e-4);
    }
    if (sizeof(mpm_real) == 8)
        CHECK_NEAR("... second order in the step: error ratio of energy", error[0] / error[1], 4, 0.1);
    else
        CHECK_NEAR("... energy", error[1], 0, 1e-3);
    for (i = 0; i < n / 2; i++) { /* and back out again, by the same path */
        double v = 2700 / (double)p.density[0], dv = 0.1 / (n / 2);
        strain(&p, 0, dv / v / 3, dv / v / 3, dv / v / 3, 0, 0, 0);
        if (update(&p, &m, 0, 1, 1e-9, NULL) != MPM_OK) break;
    }
    CHECK_NEAR("reversible: no energy left", 2700 * (double)p.energy[0] / energy, 0, 1e-10 + 2e3 * EPS);
}

/* With compression_heating the temperature follows the isentrope, and the viscosity heats. */
static void test_compression(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    double v = 1, q, T;
    points p;
    int i;
    reset(&p, &m);
    strain(&p, 0, -0.1 / 3, -0.1 / 3, -0.1 / 3, 0, 0, 0);
    CHECK_EQUAL("compression without its heat", update(&p, &m, 0, 1, 1, NULL), MPM_OK);
    CHECK_TRUE("... leaves the temperature", p.temperature[0] == m.temperature);
    m.compression_heating = 1;
    reset(&p, &m);
    for (i = 0; i < 10; i++, v -= 0.01) {
        strain(&p, 0, -0.01 / v / 3, -0.01 / v / 3, -0.01 / v / 3, 0, 0, 0);
        if (update(&p, &m, 0, 1, 1, NULL) != MPM_OK) break;
    }
    v = 2700 / (double)p.density[0];
    CHECK_RELATIVE("compression: T0 exp(Gamma0 (1 - V/V0))", p.temperature[0], 298 * exp(1.97 * (1 - v)), 100 * EPS);
    strain(&p, 0, 0.05, 0.05, 0.05, 0, 0, 0);
    update(&p, &m, 0, 1, 1, NULL);
    v = 2700 / (double)p.density[0];
    CHECK_RELATIVE("expansion beyond the start: the same curve", p.temperature[0], 298 * exp(1.97 * (1 - v)),
                   100 * EPS);
    m.viscosity_linear = 1;
    m.strength = MPM_STRENGTH_ELASTIC;
    reset(&p, &m);
    strain(&p, 0, 0, 0, -1e-3, 0, 0, 0);
    CHECK_EQUAL("with viscosity", update(&p, &m, 0, 1, 1e-6, NULL), MPM_OK);
    q = (double)p.density[0] * 1e3 * 5386; /* the cell is 1, the rate 1e3 */
    T = 298 * exp(1.97e-3) + q * 1e-3 / (2700 * 900);
    CHECK_RELATIVE("compression: with the work of the viscosity", p.temperature[0], T, 100 * EPS);
    m.specific_heat = 0;
    CHECK_EQUAL("compression: needs a specific heat", mpm_material_check(&m, NULL), MPM_ERR_ARGUMENT);
}

static void test_viscosity(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    points p, q;
    double dt = 1e-6, D, rho, add;
    reset(&p, &m);
    strain(&p, 0, 0, 0, -1e-3, 0, 0, 0);
    strain(&p, 1, 0, 0, 1e-3, 0, 0, 0);
    q = p;
    CHECK_EQUAL("without viscosity", update(&p, &m, 0, 2, dt, NULL), MPM_OK);
    m.viscosity_linear = (mpm_real)0.06;
    m.viscosity_quadratic = (mpm_real)1.5;
    CHECK_EQUAL("with viscosity", update(&q, &m, 0, 2, dt, NULL), MPM_OK);
    D = 1e-3 / dt;
    rho = (double)p.density[0];
    add = rho * D * (1.5 * D + 0.06 * 5386); /* the cell is 1 */
    /* its work heats too: Gamma0 times the energy, some thousandths of q */
    CHECK_RELATIVE("viscous pressure in compression", p.stress[2][0] - q.stress[2][0], add, 2e-3 + 2e5 * EPS);
    CHECK_TRUE("none in tension", p.stress[2][1] == q.stress[2][1]);
    CHECK_TRUE("it dissipates", q.energy[0] > p.energy[0]);
}

/* ---- units, faults, user strength --------------------------------------------------------------- */

static void test_units(void)
{
    mpm_units systems[3];
    double stress[3] = {0}, temperature[3] = {0}, plastic[3] = {0}, energy[3] = {0};
    points p;
    int i, k;
    systems[0] = mpm_units_si();
    systems[1] = mpm_units_um_us_ng();
    systems[2] = mpm_units_mm_ms_g();
    for (k = 0; k < 3; k++) {
        mpm_material m = preset("al", "ptw", systems[k]);
        reset(&p, &m);
        for (i = 0; i < 400; i++) {
            strain(&p, 0, 1e-5, 2e-5, -1.2e-4, 3e-5, 4e-4, -1e-4);
            if (update(&p, &m, 0, 1, 1e-10 / systems[k].time, NULL) != MPM_OK) break;
        }
        CHECK_EQUAL("runs in every unit system", i, 400);
        stress[k] = (double)p.stress[4][0] * mpm_units_stress(&systems[k]);
        energy[k] = (double)p.energy[0] * mpm_units_specific_energy(&systems[k]);
        temperature[k] = (double)p.temperature[0];
        plastic[k] = (double)p.plastic_strain[0];
    }
    for (k = 1; k < 3; k++) {
        /* rounding of 400 steps; the density loses an ulp each, which K/Y magnifies a hundredfold */
        double same = 400 * 100 * EPS;
        CHECK_RELATIVE("same stress as in SI", stress[k], stress[0], same);
        CHECK_RELATIVE("same energy", energy[k], energy[0], same);
        CHECK_RELATIVE("same temperature", temperature[k], temperature[0], same);
        CHECK_RELATIVE("same plastic strain", plastic[k], plastic[0], same);
    }
}

static int all_finite(const points *p, int i)
{
    double sum = 0;
    int j;
    for (j = 0; j < 6; j++) sum += (double)p->stress[j][i] * 0;
    return sum + (double)p->energy[i] * 0 + (double)p->temperature[i] * 0 + (double)p->plastic_strain[i] * 0 +
               (double)p->plastic_rate[i] * 0 + (double)p->plastic_work[i] * 0 == 0;
}

/* One number of a point that flows, set to a size: finite numbers come out, or a status that names a field and the
   block as it was. Returns whether so; *refused counts the latter. */
static int holds(const mpm_material *m, int field, mpm_real size, int *refused)
{
    mpm_fault f = {MPM_OK, "", 0, 0};
    points p, before;
    mpm_real *fields[11];
    mpm_status status;
    reset(&p, m);
    fields[0] = p.strain[4]; fields[1] = p.spin[1]; fields[2] = p.density; fields[3] = p.stress[5];
    fields[4] = p.energy; fields[5] = p.temperature; fields[6] = p.plastic_strain;
    fields[7] = p.plastic_rate; fields[8] = p.plastic_work; fields[9] = p.strain[0]; fields[10] = p.stress[0];
    strain(&p, 1, 1e-3, -2e-3, 0, 0, 0, 4e-2);
    fields[field][1] = size;
    before = p;
    status = update(&p, m, 0, 3, 1e-9, &f);
    if (status >= 0) return all_finite(&p, 0) && all_finite(&p, 1) && all_finite(&p, 2);
    ++*refused;
    return *f.field && f.index == 1 && !memcmp(&p, &before, sizeof p);
}

/* Numbers of any finite size, in every field, by every law and return. */
static void test_extremes(void)
{
    static const char *const models[] = {"elastic", "linear", "jc", "scg", "ptw"};
    const mpm_real big = sizeof(mpm_real) == 8 ? (mpm_real)DBL_MAX : (mpm_real)FLT_MAX;
    const mpm_real tiny = sizeof(mpm_real) == 8 ? (mpm_real)DBL_MIN : (mpm_real)FLT_MIN;
    mpm_real sizes[10];
    int n, i, j, k, wrong = 0, refused = 0, laws = 0;
    mpm_units si = mpm_units_si();
    sizes[0] = big;
    sizes[1] = big / 2;
    sizes[2] = tiny;
    sizes[3] = tiny * 3;
    sizes[4] = (mpm_real)sqrt((double)big);
    sizes[5] = 1 / sizes[4];
    for (k = 6; k < 10; k++) sizes[k] = -sizes[k - 6];
    for (n = 0; n < mpm_material_preset_count(); n++)
        for (i = 0; i < 10; i++) {
            mpm_material m = preset(mpm_material_preset_name(n), "", si);
            if (mpm_material_model(&m, models[i / 2], NULL) != MPM_OK) continue;
            m.mapping = i % 2 ? MPM_RETURN_STAGED : MPM_RETURN_CONSISTENT;
            m.compression_heating = i % 2;
            laws++;
            for (j = 0; j < 11; j++)
                for (k = 0; k < 10; k++) wrong += !holds(&m, j, sizes[k], &refused);
        }
    CHECK_EQUAL("extreme numbers: none comes out infinite, no block half done", wrong, 0);
    CHECK_TRUE("... many refused, by many laws", refused > 1000 && laws > 40);
}

/* The number at fault is the one that is named. */
static void test_extreme_names(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    mpm_fault f = {MPM_OK, "", 0, 0};
    points p;
    reset(&p, &m);
    p.density[2] = sizeof(mpm_real) == 8 ? (mpm_real)DBL_MIN : (mpm_real)FLT_MIN;
    p.strain[0][2] = (mpm_real)1e-3;
    CHECK_EQUAL("a density far too small", update(&p, &m, 0, 3, 1e-9, &f), MPM_ERR_STATE);
    CHECK_TRUE("... named, with the index", !strcmp(f.field, "density of point") && f.index == 2);
    reset(&p, &m);
    p.strain[5][2] = (sizeof(mpm_real) == 8 ? (mpm_real)DBL_MAX : (mpm_real)FLT_MAX) / 4;
    CHECK_EQUAL("a strain far too large", update(&p, &m, 0, 3, 1e-9, &f), MPM_ERR_STATE);
    CHECK_TRUE("... named, with the index", !strcmp(f.field, "strain increment of point") && f.index == 2);
}

static void test_faults(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    mpm_fault f = {MPM_OK, "", 0, 0};
    points p, before;
    mpm_real *fields[9], nan = (mpm_real)NAN, old;
    const char *names[9] = {"strain", "rotation", "density", "stress", "energy", "temperature",
                            "plastic strain", "plastic rate", "plastic work"};
    int i;
    reset(&p, &m);
    fields[0] = p.strain[4]; fields[1] = p.spin[1]; fields[2] = p.density; fields[3] = p.stress[5];
    fields[4] = p.energy; fields[5] = p.temperature; fields[6] = p.plastic_strain;
    fields[7] = p.plastic_rate; fields[8] = p.plastic_work;
    for (i = 0; i < 9; i++) {
        old = fields[i][17];
        fields[i][17] = nan;
        before = p;
        CHECK_EQUAL(names[i], update(&p, &m, 0, 64, 1e-9, &f), MPM_ERR_NAN);
        CHECK_TRUE("... named, with the index", strstr(f.field, names[i]) && f.index == 17);
        CHECK_TRUE("... and the block as it was", !memcmp(&p, &before, sizeof p));
        fields[i][17] = old;
    }
    p.density[3] = 0;
    CHECK_EQUAL("zero density", update(&p, &m, 0, 64, 1e-9, &f), MPM_ERR_STATE);
    p.density[3] = 2700 * 4;
    CHECK_EQUAL("past the Hugoniot's range", update(&p, &m, 0, 64, 1e-9, &f), MPM_ERR_STATE);
    CHECK_EQUAL("... index", f.index, 3);
    p.density[3] = 2700;
    p.temperature[5] = -1;
    CHECK_EQUAL("negative temperature", update(&p, &m, 0, 64, 1e-9, &f), MPM_ERR_STATE);
    p.temperature[5] = 298;
    p.strain[0][6] = -1;
    CHECK_EQUAL("a volume strained to nothing", update(&p, &m, 0, 64, 1e-9, &f), MPM_ERR_STATE);
    p.strain[0][6] = 0;
    CHECK_EQUAL("dt = 0", update(&p, &m, 0, 64, 0, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("second group of a long block", (p.energy[100] = nan, update(&p, &m, 0, MOST, 1e-9, &f)),
                MPM_ERR_NAN);
    CHECK_EQUAL("... index within the block", f.index, 100);
    p.energy[100] = 0;
    CHECK_EQUAL("and all is well again", update(&p, &m, 0, MOST, 1e-9, NULL), MPM_OK);
    memset(&m, 0, sizeof m);
    CHECK_EQUAL("a zeroed material", update(&p, &m, 0, 1, 1e-9, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... named", !strcmp(f.field, "material (not from mpm_material_default)"));
}

/* A flow stress of the caller's: constant, or NaN on request. */
static mpm_flow constant_strength(const void *context, const mpm_material *m, const mpm_material_state *s)
{
    mpm_flow f;
    (void)m;
    (void)s;
    f.stress = *(const mpm_real *)context;
    f.strain_slope = f.rate_slope = 0;
    return f;
}

/* Strongly and awkwardly rate dependent, with slopes that lie: the search must still return. */
static mpm_flow awkward_strength(const void *context, const mpm_material *m, const mpm_material_state *s)
{
    mpm_flow f;
    double rate = (double)s->plastic_rate;
    (void)context;
    (void)m;
    f.stress = (mpm_real)(1e7 * (1 + floor(log10(1 + rate))) + 1e8 * pow(rate / 1e9, 0.01));
    f.strain_slope = 0;
    f.rate_slope = (mpm_real)1e3;
    return f;
}

/* Zerilli and Armstrong's law as the header prints it, with their numbers for OFHC copper [MPa, 1/s]. */
typedef struct zerilli { mpm_real c0, c2, c3, c4; } zerilli;

static mpm_flow zerilli_flow(const void *context, const mpm_material *m, const mpm_material_state *s)
{
    const zerilli *c = (const zerilli *)context;
    mpm_real heat = s->temperature * (c->c4 * mpm_log(s->plastic_rate) - c->c3);
    mpm_real hard = s->plastic_rate > 0 ? c->c2 * mpm_sqrt(s->plastic_strain) * mpm_exp(heat) : 0;
    mpm_flow f;
    (void)m;
    f.stress = c->c0 + hard;
    f.strain_slope = s->plastic_strain > 0 ? hard / (2 * s->plastic_strain) : 0;
    f.rate_slope = hard * c->c4 * s->temperature;
    return f;
}

/* Sheared to a strain: the stress is the law's at the strain, rate and temperature it ended with. */
static void test_zerilli(void)
{
    const zerilli copper = {MPM_R(65e6), MPM_R(890e6), MPM_R(0.0028), MPM_R(0.000115)};
    mpm_material m = preset("cu", "jc", mpm_units_si());
    mpm_fault f = {MPM_OK, "", 0, 0};
    double want, heat;
    points p;
    int i;
    m.strength = MPM_STRENGTH_USER;
    m.strength_fn = zerilli_flow;
    m.strength_context = &copper;
    CHECK_EQUAL("Zerilli-Armstrong, check", mpm_material_check(&m, &f), MPM_OK);
    m.heat_fraction = 0; /* the law is met at the temperature before a step's heat */
    reset(&p, &m);
    for (i = 0; i < 200; i++) {
        strain(&p, 0, 0, 0, 0, 1e-3, 0, 0);
        if (update(&p, &m, 0, 1, 1e-7, &f) < 0) break;
    }
    CHECK_EQUAL("Zerilli-Armstrong, steps", i, 200);
    heat = (double)p.temperature[0] * (0.000115 * log((double)p.plastic_rate[0]) - 0.0028);
    want = 65e6 + 890e6 * sqrt((double)p.plastic_strain[0]) * exp(heat);
    CHECK_RELATIVE("Zerilli-Armstrong, stress", mises(&p, 0), want, MET);
    CHECK_RELATIVE("Zerilli-Armstrong, strain", p.plastic_strain[0], 0.2 * 2 / sqrt(3), 0.02);
}

static void test_user_strength(void)
{
    mpm_material m = preset("al", "ptw", mpm_units_si());
    mpm_fault f = {MPM_OK, "", 0, 0};
    mpm_real y = (mpm_real)1e8;
    points p;
    int i;
    m.strength = MPM_STRENGTH_USER;
    m.strength_fn = constant_strength;
    m.strength_context = &y;
    reset(&p, &m);
    strain(&p, 0, 0, 0, 0, 0.01, 0, 0);
    CHECK_EQUAL("user strength, check", mpm_material_check(&m, &f), MPM_OK);
    CHECK_EQUAL("user strength, status", update(&p, &m, 0, 1, 1e-9, &f), MPM_OK);
    CHECK_RELATIVE("user strength, stress", mises(&p, 0), 1e8, MET);
    y = (mpm_real)NAN;
    strain(&p, 0, 0, 0, 0, 0.01, 0, 0);
    CHECK_EQUAL("a NaN from it stops the update", update(&p, &m, 0, 1, 1e-9, &f), MPM_ERR_NAN);
    m.strength_fn = awkward_strength;
    reset(&p, &m);
    for (i = 0; i < 100; i++) {
        strain(&p, 0, 0, 0, 0, 1e-4, 0, 0);
        if (update(&p, &m, 0, 1, 1e-9, &f) < 0) break;
    }
    CHECK_EQUAL("an awkward one with lying slopes still returns", i, 100);
    CHECK_TRUE("... to a stress below the trial", mises(&p, 0) < 2e8 && mises(&p, 0) > 1e8);
}

/* ---- an equation of state of one's own -------------------------------------------------------- */

/* Murnaghan's: p = K/n ((rho/rho0)^n - 1), whatever the energy. */
static mpm_pressure murnaghan(const void *context, const mpm_material *m, mpm_real density, mpm_real energy)
{
    const mpm_real *K = (const mpm_real *)context;
    const double eta = (double)density / (double)m->density;
    mpm_pressure p;
    (void)energy;
    p.energy_slope = 0;
    p.pressure = (mpm_real)((double)K[0] / (double)K[1] * (pow(eta, (double)K[1]) - 1));
    p.sound_speed = (mpm_real)sqrt((double)K[0] / (double)m->density * pow(eta, (double)K[1] - 1));
    return p;
}

/* The material's own Mie-Grueneisen pressure, handed in from outside. */
static mpm_pressure grueneisen(const void *context, const mpm_material *m, mpm_real density, mpm_real energy)
{
    const mpm_material *own = (const mpm_material *)context;
    mpm_pressure p;
    (void)m;
    if (mpm_material_pressure(own, density, energy, &p.pressure, NULL) < 0) p.pressure = (mpm_real)NAN;
    p.energy_slope = own->gruneisen * own->density;
    p.sound_speed = own->sound_speed;
    return p;
}

/* Not linear in energy, with a slope that is `context` times the true one; NaN beyond twice the density. */
static mpm_pressure bent(const void *context, const mpm_material *m, mpm_real density, mpm_real energy)
{
    const double e = (double)energy, rho = (double)density, rho0 = (double)m->density;
    mpm_pressure p;
    p.pressure = (mpm_real)(rho < 2 * rho0 ? 7e10 * (rho / rho0 - 1) + 1e4 * e + 0.002 * e * fabs(e) : (double)NAN);
    p.energy_slope = (mpm_real)((1e4 + 0.004 * fabs(e)) * (double)*(const mpm_real *)context);
    p.sound_speed = 5000;
    return p;
}

static mpm_material with_eos(mpm_eos_fn fn, const void *context)
{
    mpm_material m = preset("al", "elastic", mpm_units_si());
    m.eos = MPM_EOS_USER;
    m.eos_fn = fn;
    m.eos_context = context;
    CHECK_EQUAL("an equation of state of one's own, check", mpm_material_check(&m, NULL), MPM_OK);
    return m;
}

static double pressure_of(const points *p, int i)
{
    return -((double)p->stress[0][i] + (double)p->stress[1][i] + (double)p->stress[2][i]) / 3;
}

/* Squeezes a point from V0 to `end` V0 in n steps. Returns the work -sum (p + p')/2 dV/V0 of the pressures. */
static double squeeze(points *p, const mpm_material *m, double end, int n)
{
    double work = 0, dv = (end - 1) / n, v = 1, last = 0, was = 1;
    int i;
    reset(p, m);
    for (i = 0; i < n; i++, v += dv) {
        strain(p, 0, dv / v / 3, dv / v / 3, dv / v / 3, 0, 0, 0);
        if (update(p, m, 0, 1, 1e-9, NULL) != MPM_OK) return (double)NAN;
        work -= (pressure_of(p, 0) + last) / 2 * ((double)m->density / (double)p->density[0] - was);
        last = pressure_of(p, 0);
        was = (double)m->density / (double)p->density[0];
    }
    return work;
}

/* Closed forms: p + P = P eta^g along the isentrope of a stiffened gas, and Murnaghan's curve with
   e = K/(rho0 n) ((eta^(n-1) - 1)/(n - 1) + 1/eta - 1). */
static void test_user_eos(void)
{
    const stiffened gas = {MPM_R(4.0), MPM_R(2e9)};
    const mpm_real K[2] = {MPM_R(70e9), MPM_R(4.0)};
    mpm_material m = with_eos(stiffened_gas, &gas);
    double error[2], eta, want;
    points p;
    int r;
    for (r = 0; r < 2; r++) {
        double work = squeeze(&p, &m, 0.9, 20 << r);
        want = 2e9 * (pow((double)p.density[0] / 2700, 4) - 1);
        error[r] = pressure_of(&p, 0) / want - 1;
        CHECK_RELATIVE("stiffened gas: the energy is the work of the pressures", 2700 * (double)p.energy[0], work,
                       2000 * EPS);
    }
    CHECK_NEAR("stiffened gas: the isentrope in closed form", error[1], 0, 1e-4);
    if (sizeof(mpm_real) == 8)
        CHECK_NEAR("... second order in the step", error[0] / error[1], 4, 0.1);
    m = with_eos(murnaghan, K);
    (void)squeeze(&p, &m, 0.9, 100);
    eta = (double)p.density[0] / 2700;
    want = 70e9 / 4 * (pow(eta, 4) - 1);
    CHECK_RELATIVE("Murnaghan: the pressure in closed form", pressure_of(&p, 0), want, 32 * EPS);
    want = 70e9 / 4 * ((pow(eta, 3) - 1) / 3 + 1 / eta - 1);
    CHECK_RELATIVE("Murnaghan: the energy in closed form", 2700 * (double)p.energy[0], want, 1e-4 + 2000 * EPS);
}

/* Strength, heat of compression and viscosity with it: as with the equation of state built in, to rounding. */
static void test_grueneisen_through_callback(void)
{
    mpm_material own = preset("al", "ptw", mpm_units_si()), m;
    /* an ulp of eta moves the pressure by K eps, and the energy by the work of that over a strain of 0.01 */
    const double work = 0.01 * 5386.0 * 5386.0;
    double gap[3] = {0, 0, 0};
    unsigned long seed = 11;
    points p, q;
    int i, j, k, failed = 0;
    own.compression_heating = 1;
    own.viscosity_linear = MPM_R(0.06);
    own.viscosity_quadratic = MPM_R(1.5);
    m = own;
    m.eos = MPM_EOS_USER;
    m.eos_fn = grueneisen;
    m.eos_context = &own;
    reset(&p, &own);
    for (k = 0; k < 20; k++) {
        for (i = 0; i < MOST; i++) {
            double e[6];
            for (j = 0; j < 6; j++) e[j] = 3e-3 * random_number(&seed) - (j < 3 ? 5e-4 * (i % 5) : 0);
            strain(&p, i, e[0], e[1], e[2], e[3], e[4], e[5]);
        }
        q = p;
        failed += update(&p, &own, 0, MOST, 1e-4, NULL) != MPM_OK;
        failed += update(&q, &m, 0, MOST, 1e-4, NULL) != MPM_OK;
        for (i = 0; i < MOST; i++) {
            gap[0] = check_worst(gap[0], fabs(pressure_of(&q, i) - pressure_of(&p, i)) / 7e10);
            gap[1] = check_worst(gap[1], fabs((double)q.energy[i] - (double)p.energy[i]) / work);
            gap[2] = check_worst(gap[2], fabs((double)q.temperature[i] / (double)p.temperature[i] - 1));
        }
    }
    CHECK_EQUAL("Mie-Grueneisen built in and through the callback: updates that failed", failed, 0);
    CHECK_NEAR("Mie-Grueneisen through the callback: pressure over the bulk modulus", gap[0], 0, 8 * EPS);
    CHECK_NEAR("... energy over that of the bulk modulus at a strain of 0.01", gap[1], 0, 8 * EPS);
    CHECK_NEAR("... temperature", gap[2], 0, 8 * EPS);
}

/* Curved in energy: energy and pressure still agree, with a slope half as large or twice, and with one that is far
   off the work is still that of the pressures and the cap is told. What fails leaves the block as it was. */
static void test_awkward_eos(void)
{
    const mpm_real factor[] = {1, MPM_R(0.5), 2};
    mpm_real far = 1000;
    mpm_material m;
    mpm_fault f = {MPM_OK, "", 0, 0};
    points p, before;
    int i;
    for (i = 0; i < 3; i++) {
        double work, e, want;
        m = with_eos(bent, &factor[i]);
        work = squeeze(&p, &m, 0.8, 40);
        e = (double)p.energy[0];
        want = 7e10 * ((double)p.density[0] / 2700 - 1) + 1e4 * e + 0.002 * e * e;
        CHECK_RELATIVE("a pressure curved in energy", pressure_of(&p, 0), want, 64 * EPS);
        CHECK_RELATIVE("... closes the energy", 2700 * e, work, 2000 * EPS);
    }
    m = with_eos(bent, &far);
    before = p;
    counted[MPM_TALLY_ITERATION] = 0;
    strain(&p, 0, 0.01, 0.01, 0.01, 0, 0, 0);
    CHECK_EQUAL("a slope far too steep ends at the cap", update(&p, &m, 0, 1, 1e-9, &f), MPM_NOT_CONVERGED);
    CHECK_EQUAL("... counted", (long)counted[MPM_TALLY_ITERATION], 1);
    counted[MPM_TALLY_ITERATION] = 0;
    CHECK_RELATIVE("... with the work of its pressures", 2700 * ((double)p.energy[0] - (double)before.energy[0]),
                   -(pressure_of(&p, 0) + pressure_of(&before, 0)) / 2 *
                       (2700 / (double)p.density[0] - 2700 / (double)before.density[0]), 2000 * EPS);
    strain(&p, 3, -0.2, -0.2, -0.2, 0, 0, 0);
    before = p;
    CHECK_EQUAL("its NaN stops the update", update(&p, &m, 0, 5, 1e-9, &f), MPM_ERR_NAN);
    CHECK_TRUE("... named, with the index", !strcmp(f.field, "pressure of point") && f.index == 3);
    CHECK_TRUE("... and the block as it was", !memcmp(&p, &before, sizeof p));
    p.density[3] = 5000;
    before = p;
    CHECK_EQUAL("squeezed too far at once", update(&p, &m, 0, 5, 1e-9, &f), MPM_ERR_STATE);
    CHECK_TRUE("... named, with the index", !strcmp(f.field, "volume increment of point") && f.index == 3);
    CHECK_TRUE("... and the block as it was", !memcmp(&p, &before, sizeof p));
}

/* A material is read only: two worlds may share one. */
static void test_material_is_const(void)
{
    mpm_material m = preset("cu", "ptw", mpm_units_si()), before;
    points p;
    memcpy(&before, &m, sizeof m);
    reset(&p, &m);
    strain(&p, 0, 0, 0, -1e-2, 0, 1e-2, 0);
    CHECK_EQUAL("a step of a shared material", update(&p, &m, 0, MOST, 1e-9, NULL), MPM_OK);
    CHECK_TRUE("... with plastic flow", p.plastic_strain[0] > 0);
    CHECK_TRUE("... leaves it as it was", !memcmp(&before, &m, sizeof m));
}

int main(void)
{
    test_elastic();
    test_rotation();
    test_consistent_return();
    test_block_is_point();
    test_staged();
    test_staged_path();
    test_staged_energy();
    test_staged_field();
    test_heat();
    test_melting();
    test_isentrope();
    test_compression();
    test_viscosity();
    test_units();
    test_faults();
    test_extremes();
    test_extreme_names();
    test_user_strength();
    test_zerilli();
    test_user_eos();
    test_grueneisen_through_callback();
    test_awkward_eos();
    test_material_is_const();
    return check_end();
}
