/* The spray's models one by one, against numbers computed independently and against what must hold:
   contact, restitution, sticking, drag, jet, sizes, the order of the time scheme.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_spray.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

#ifdef MPM_FLOAT
#define SINGLE 1
#else
#define SINGLE 0
#endif
/* a printed number of five to six digits, or what the arithmetic can give */
#define PRINTED(digits) (SINGLE ? 3e-5 + (digits) : (digits))

static uint64_t dice = 42;

static mpm_real uniform(mpm_real low, mpm_real high) { return low + mpm_spray_random(&dice) * (high - low); }

static mpm_real mass_of(mpm_real radius)
{
    return MPM_R(5680.0) * 4 * MPM_R(3.14159265358979324) / 3 * radius * radius * radius;
}

/* ---- restitution and sticking -------------------------------------------------------------- */

/* What the paper's criterion says of a particle at this speed, alpha 1. */
static int sticks(mpm_real speed, mpm_real gamma, mpm_real radius, mpm_real yield)
{
    mpm_spray_touch t;
    memset(&t, 0, sizeof t);
    t.normal_speed = speed;
    t.alpha = 1;
    t.gamma = gamma;
    t.mass = mass_of(radius);
    t.radius_effective = radius;
    t.yield = yield;
    return mpm_spray_stick_adhesion(NULL, &t);
}

static void test_contact_numbers(void)
{
    static const mpm_real speed[5] = {5, 10, 20, 50, 100};
    static const double wall[5] = {0.77681, 0.65321, 0.54929, 0.43683, 0.36733};
    static const mpm_real pair_speed[3] = {5, 10, 50};
    static const double pair[3] = {0.65611, 0.55172, 0.36896};
    static const mpm_real radius[3] = {MPM_R(40e-6), MPM_R(80e-6), MPM_R(160e-6)};
    static const double critical[3] = {2.52413e-3, 1.26206e-3, 6.31032e-4};
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_real wall_e = mpm_spray_modulus(&d.particle, &d.target);
    mpm_real pair_e = mpm_spray_modulus(&d.particle, &d.particle);
    mpm_real r = MPM_R(80e-6), m = mass_of(r), y = d.target.yield, limit, gamma;
    int i;
    CHECK_RELATIVE("E* particle-target [Pa]", wall_e, 111.0048e9, PRINTED(1e-6));
    CHECK_RELATIVE("E* particle-particle [Pa]", pair_e, 110.0272e9, PRINTED(1e-6));
    limit = mpm_spray_limit_speed(m, r, y, wall_e);
    CHECK_RELATIVE("limit of elasticity at the wall [m/s]", limit, 0.067744, PRINTED(1e-5));
    CHECK_EQUAL("e is 1 just below 1.8206 m/s", mpm_spray_restitution(MPM_R(1.8205), m, r, y, wall_e) == 1, 1);
    CHECK_TRUE("e is below 1 just above 1.8206 m/s", mpm_spray_restitution(MPM_R(1.8208), m, r, y, wall_e) < 1);
    CHECK_EQUAL("e at rest is 1", mpm_spray_restitution(0, m, r, y, wall_e) == 1, 1);
    for (i = 0; i < 5; i++)
        CHECK_RELATIVE("e at the wall", mpm_spray_restitution(speed[i], m, r, y, wall_e), wall[i], PRINTED(1e-5));
    for (i = 0; i < 3; i++)
        CHECK_RELATIVE("e of an equal pair", mpm_spray_restitution(pair_speed[i], m / 2, r / 2, y, pair_e),
                       pair[i], PRINTED(1e-5));
    CHECK_RELATIVE("compression time [s]", mpm_spray_compression_time(m, r, y), 1.6996e-7, PRINTED(3e-5));
    CHECK_RELATIVE("elastic contact time at 1 m/s [s]", mpm_spray_elastic_time(1, m, r, wall_e),
                   2.87 * pow((double)m * (double)m / ((double)r * (double)wall_e * (double)wall_e), 0.2),
                   PRINTED(1e-12));
    gamma = mpm_spray_gamma12(MPM_SPRAY_MIXING_DISPERSION, d.target.surface_energy, d.particle.surface_energy);
    CHECK_RELATIVE("gamma_12, text [J/m^2]", gamma, 0.4499, 1e-4);
    CHECK_RELATIVE("gamma_12, B 31 [J/m^2]",
                   mpm_spray_gamma12(MPM_SPRAY_MIXING_DIFFERENCE, d.target.surface_energy, d.particle.surface_energy),
                   1.1 + 0.046 - 2 * sqrt(1.1 * 0.046), PRINTED(1e-12));
    for (i = 0; i < 3; i++) {
        mpm_real v = mpm_spray_stick_speed(1, gamma, mass_of(radius[i]), radius[i], y);
        CHECK_RELATIVE("sticking speed at alpha 1 [m/s]", v, critical[i], PRINTED(1e-5));
        CHECK_RELATIVE("... over alpha gamma/R", v * radius[i] / gamma, 2.2440e-7, 2e-4);
        CHECK_EQUAL("a little slower sticks", sticks(MPM_R(0.999) * v, gamma, radius[i], y), 1);
        CHECK_EQUAL("a little faster does not", sticks(MPM_R(1.001) * v, gamma, radius[i], y), 0);
    }
}

/* ---- one particle against the wall --------------------------------------------------------- */

/* A description without gas or feed: particles are added by hand. */
static mpm_spray_desc bare(void)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    d.batch = 0;
    d.gas = MPM_SPRAY_GAS_STILL;
    d.gas_density = 0;
    d.capacity = 16;
    return d;
}

static mpm_spray_ball ball_at(mpm_real x, mpm_real v, mpm_real radius)
{
    mpm_spray_ball b;
    memset(&b, 0, sizeof b);
    b.x[0] = x;
    b.v[0] = v;
    b.radius = radius;
    b.density = 5680;
    return b;
}

/* Sends one particle of radius 80 um at the target and returns its velocity after `steps`, or 1e9 if
   it has stuck. */
static mpm_real sent_at_target(mpm_spray_desc *d, mpm_real speed, int steps)
{
    mpm_spray s;
    mpm_spray_ball b = ball_at(MPM_R(0.299), speed, MPM_R(80e-6));
    mpm_real v;
    if (mpm_spray_init(&s, d, NULL, 0) != MPM_OK || mpm_spray_add(&s, &b) != MPM_OK) return 1e8;
    while (s.tally.step < steps) mpm_spray_step(&s);
    v = s.live ? s.v[0] : MPM_R(1e9);
    if (s.deposited)
        CHECK_NEAR("a stuck particle touches the plane", s.deposit_x[0], 0.3 - 80e-6, 0.3 * 2 * (double)MPM_EPSILON);
    mpm_spray_free(&s);
    return v;
}

static void test_wall(void)
{
    static const mpm_real theta[3] = {0, MPM_R(0.5), 1};
    mpm_spray_desc d = bare();
    mpm_real critical, e, m = mass_of(MPM_R(80e-6));
    int i;
    d.alpha = 0;
    d.rebound = MPM_SPRAY_REBOUND_CONSTANT;
    for (i = 0; i < 3; i++) {
        d.theta = theta[i];
        CHECK_RELATIVE("10 m/s with e = 0.8 rebounds at 8, whatever theta", sent_at_target(&d, 10, 100), -8,
                       10 * (double)MPM_EPSILON);
        d.contact = MPM_SPRAY_OVERLAP;
        CHECK_RELATIVE("... found by overlap too", sent_at_target(&d, 10, 100), -8, 10 * (double)MPM_EPSILON);
        d.contact = MPM_SPRAY_SWEPT;
    }
    d = bare();
    d.alpha = MPM_R(1e4);
    critical = mpm_spray_stick_speed(d.alpha, MPM_R(0.449888875), m, MPM_R(80e-6), d.target.yield);
    CHECK_EQUAL("0.999 of the sticking speed sticks", sent_at_target(&d, MPM_R(0.999) * critical, 100) > 1e8, 1);
    e = mpm_spray_restitution(MPM_R(1.001) * critical, m, MPM_R(80e-6), d.target.yield,
                              mpm_spray_modulus(&d.particle, &d.target));
    CHECK_RELATIVE("1.001 of it rebounds at e v", sent_at_target(&d, MPM_R(1.001) * critical, 100),
                   -e * MPM_R(1.001) * critical, 100 * (double)MPM_EPSILON);
}

/* Oblique impact with spin: against the wall nothing is gained, sticking friction ends the slip. */
static void test_wall_friction(void)
{
    static const mpm_real n[3] = {-1, 0, 0}, still[3] = {0, 0, 0};
    mpm_spray_ball b = ball_at(0, 10, MPM_R(80e-6)), c;
    mpm_real slip;
    b.v[1] = 1;
    c = b;
    mpm_spray_collide_fixed(&b, n, still, MPM_R(0.8), MPM_R(0.55), MPM_R(1e-4));
    slip = b.v[1] - b.radius * b.spin[2] * n[0];
    CHECK_NEAR("grazing slip of 1 m/s is stopped, not reversed", slip, 0, 8 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... leaving 5/7 of the velocity along the wall", b.v[1], 5.0 / 7, 8 * (double)MPM_EPSILON);
    c.v[1] = 100;
    mpm_spray_collide_fixed(&c, n, still, MPM_R(0.8), MPM_R(0.1), MPM_R(1e-4));
    CHECK_RELATIVE("large slip loses mu (1 + e) v_n", c.v[1], 100 - 0.1 * 1.8 * 10, 8 * (double)MPM_EPSILON);
}

/* ---- pairs --------------------------------------------------------------------------------- */

typedef struct sums {
    double p[3], l[3], energy, p_scale, l_scale;
} sums;

static void add_ball(sums *s, const mpm_spray_ball *b)
{
    double m = (double)mass_of(b->radius), inertia = 0.4 * m * (double)b->radius * (double)b->radius;
    int k;
    for (k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        double lever = m * ((double)b->x[y] * (double)b->v[z] - (double)b->x[z] * (double)b->v[y]);
        s->p[k] += m * (double)b->v[k];
        s->l[k] += lever + inertia * (double)b->spin[k];
        s->energy += m / 2 * (double)b->v[k] * (double)b->v[k] + inertia / 2 * (double)b->spin[k] * (double)b->spin[k];
        s->p_scale += fabs(m * (double)b->v[k]);
        s->l_scale += fabs(lever) + fabs(inertia * (double)b->spin[k]);
    }
}

/* Two touching balls of different size in random motion. */
static void random_pair(mpm_spray_ball *a, mpm_spray_ball *b)
{
    mpm_real n[3], length = 0;
    int k;
    *a = ball_at(0, 0, uniform(MPM_R(20e-6), MPM_R(200e-6)));
    *b = ball_at(0, 0, uniform(MPM_R(20e-6), MPM_R(200e-6)));
    do {
        for (k = 0; k < 3; k++) n[k] = uniform(-1, 1);
        length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    } while (length > 1 || length < MPM_R(0.01));
    for (k = 0; k < 3; k++) {
        a->x[k] = n[k] / (mpm_real)sqrt((double)length) * (a->radius + b->radius);
        a->v[k] = uniform(-50, 50);
        b->v[k] = uniform(-50, 50);
        a->spin[k] = uniform(MPM_R(-1e6), MPM_R(1e6));
        b->spin[k] = uniform(MPM_R(-1e6), MPM_R(1e6));
    }
}

static double approach(const mpm_spray_ball *a, const mpm_spray_ball *b)
{
    double sum = 0, length = 0;
    int k;
    for (k = 0; k < 3; k++) {
        double n = (double)a->x[k] - (double)b->x[k];
        sum += n * ((double)b->v[k] - (double)a->v[k]);
        length += n * n;
    }
    return sum / sqrt(length);
}

static void test_pairs(void)
{
    const double eps = (double)MPM_EPSILON;
    double worst_p = 0, worst_l = 0, worst_e = 0, worst_gain = 0, lost = 0;
    long i, hits = 0;
    for (i = 0; i < 100000; i++) {
        mpm_spray_ball a, b;
        sums before = {{0}, {0}, 0, 0, 0}, after = {{0}, {0}, 0, 0, 0};
        mpm_real e = uniform(0, 1), mu = uniform(0, 1);
        double speed;
        int k;
        random_pair(&a, &b);
        add_ball(&before, &a);
        add_ball(&before, &b);
        speed = approach(&a, &b);
        hits += mpm_spray_collide(&a, &b, e, mu, MPM_R(1e-4)) > 0;
        add_ball(&after, &a);
        add_ball(&after, &b);
        for (k = 0; k < 3; k++) {
            worst_p = check_worst(worst_p, fabs(after.p[k] - before.p[k]) / before.p_scale);
            worst_l = check_worst(worst_l, fabs(after.l[k] - before.l[k]) / before.l_scale);
        }
        if (speed > 0) worst_e = check_worst(worst_e, fabs(approach(&a, &b) + (double)e * speed));
        worst_gain = check_worst(worst_gain, after.energy / before.energy - 1);
        lost += 1 - after.energy / before.energy;
    }
    CHECK_TRUE("half of 1e5 random pairs collide", hits > 45000 && hits < 55000);
    CHECK_NEAR("linear momentum kept (relative)", worst_p, 0, SINGLE ? 16 * eps : 1e-12);
    CHECK_NEAR("angular momentum kept (relative)", worst_l, 0, SINGLE ? 16 * eps : 1e-12);
    CHECK_NEAR("separation speed is e times approach [m/s]", worst_e, 0, SINGLE ? 5000 * eps : 1e-9);
    CHECK_NEAR("kinetic energy never rises (largest relative gain)", worst_gain, 0, 8 * eps);
    CHECK_TRUE("... and falls on the whole", lost > 1000);
}

/* ---- drag and the time scheme -------------------------------------------------------------- */

typedef struct arrival { mpm_spray_touch touch; int count; } arrival;

static void note_arrival(void *user, const mpm_spray_touch *t)
{
    arrival *a = (arrival *)user;
    a->touch = *t;
    a->count++;
}

/* From rest in a uniform stream of 50 m/s: time and speed at 0.30 m. */
static void test_transit(void)
{
    static const mpm_real radius[4] = {MPM_R(5e-6), MPM_R(40e-6), MPM_R(80e-6), MPM_R(160e-6)};
    static const double time[4] = {6.67664e-3, 15.68857e-3, 23.48616e-3, 35.57758e-3};
    static const double speed[4] = {49.95682, 30.90024, 22.15136, 15.31553};
    int i;
    for (i = 0; i < 4; i++) {
        arrival a;
        mpm_spray s;
        mpm_spray_desc d = mpm_spray_desc_default();
        mpm_spray_ball b = ball_at(0, 0, radius[i]);
        memset(&a, 0, sizeof a);
        d.batch = 0;
        d.gas = MPM_SPRAY_GAS_UNIFORM;
        d.stand_off = MPM_R(0.30) + radius[i];
        d.dt = MPM_R(1e-6); /* the velocity of a touch is that of the end of its step */
        d.touch = note_arrival;
        d.touch_user = &a;
        d.capacity = 1;
        if (mpm_spray_init(&s, &d, NULL, 0) != MPM_OK || mpm_spray_add(&s, &b) != MPM_OK) s.tally.step = 50000;
        while (a.count == 0 && s.tally.step < 50000) mpm_spray_step(&s);
        CHECK_RELATIVE("transit time to 0.30 m [s]", a.touch.time, time[i], SINGLE ? 1e-3 : 1e-4);
        CHECK_RELATIVE("speed there [m/s]", a.touch.v[0], speed[i], SINGLE ? 1e-3 : 1e-4);
        CHECK_EQUAL("the fixed point always converged", s.tally.not_converged, 0);
        mpm_spray_free(&s);
    }
    CHECK_RELATIVE("drag at rest is Stokes' 9 mu / (2 rho R^2) [1/s]",
                   mpm_spray_drag_rate(0, MPM_R(80e-6), 5680, MPM_R(1.1), MPM_R(25e-6)),
                   4.5 * 1.1 * 25e-6 / (5680 * 80e-6 * 80e-6), PRINTED(1e-12));
    CHECK_EQUAL("Cd Re at rest is Stokes' 24", mpm_spray_drag_cd_re(0), 24);
    CHECK_RELATIVE("Cd Re at 100", mpm_spray_drag_cd_re(100),
                   24 * (1 + 0.1806 * pow(100, 0.6459)) + 0.4251 * 1e4 / 6980.95, PRINTED(1e-12));
}

static void test_terminal_speed(void)
{
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray_ball b = ball_at(0, 0, MPM_R(80e-6));
    d.batch = 0;
    d.gas = MPM_SPRAY_GAS_STILL;
    d.gravity[0] = MPM_R(9.81);
    d.stand_off = 100;
    d.high[0] = 100;
    d.release[1] = 1;
    d.dt = MPM_R(1e-3);
    d.capacity = 1;
    if (mpm_spray_init(&s, &d, NULL, 0) != MPM_OK || mpm_spray_add(&s, &b) != MPM_OK) s.tally.step = 5000;
    while (s.tally.step < 5000) mpm_spray_step(&s);
    CHECK_RELATIVE("terminal speed [m/s]", s.live ? s.v[0] : 0, 1.592694, PRINTED(1e-6));
    mpm_spray_free(&s);
}

/* Speed at 6.4 ms of a particle of 40 um set free in the stream, with steps of dt. */
static mpm_real speed_after(mpm_real theta, mpm_real dt, int steps)
{
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray_ball b = ball_at(0, 0, MPM_R(40e-6));
    mpm_real v;
    d.batch = 0;
    d.gas = MPM_SPRAY_GAS_UNIFORM;
    d.dt = dt;
    d.theta = theta;
    d.tolerance = MPM_R(1e-14);
    d.capacity = 1;
    if (mpm_spray_init(&s, &d, NULL, 0) != MPM_OK) return 0;
    mpm_spray_add(&s, &b);
    while (s.tally.step < steps) mpm_spray_step(&s);
    v = s.v[0];
    mpm_spray_free(&s);
    return v;
}

static void test_orders(void)
{
    static const mpm_real theta[3] = {0, MPM_R(0.5), 1};
    static const double order[3] = {1, 2, 1};
    mpm_real exact = speed_after(MPM_R(0.5), MPM_R(1e-6), 6400);
    int i;
    if (SINGLE) return; /* rounding hides the error of the second-order scheme */
    for (i = 0; i < 3; i++) {
        double coarse = fabs((double)(speed_after(theta[i], MPM_R(1.6e-4), 40) - exact));
        double fine = fabs((double)(speed_after(theta[i], MPM_R(0.8e-4), 80) - exact));
        CHECK_NEAR("order of the theta scheme in v", log2(coarse / fine), order[i], 0.06);
    }
}

/* ---- the jet ------------------------------------------------------------------------------- */

/* Divergence at (x, r) by central differences: planar, or axisymmetric. */
static double divergence(const mpm_spray_jet *j, int axisymmetric, double x, double r)
{
    double h = 1e-6, sum = 0, u[4][2];
    int k;
    for (k = 0; k < 4; k++) {
        mpm_real at[3], v[3];
        at[0] = (mpm_real)(x + (k == 0 ? -h : k == 1 ? h : 0));
        at[1] = (mpm_real)(r + (k == 2 ? -h : k == 3 ? h : 0));
        at[2] = 0;
        mpm_spray_jet_velocity(j, axisymmetric, at, v);
        u[k][0] = (double)v[0];
        u[k][1] = (double)v[1] * (axisymmetric ? (double)at[1] : 1);
    }
    sum = (u[1][0] - u[0][0]) / (2 * h);
    return sum + (u[3][1] - u[2][1]) / (2 * h) / (axisymmetric ? r : 1);
}

static void test_jet(void)
{
    mpm_spray_jet j = mpm_spray_jet_make(50, MPM_R(0.01), MPM_R(0.12), MPM_R(0.0025));
    mpm_real x[3] = {MPM_R(0.30), 0, 0}, u[3], w[3];
    double worst[2] = {0, 0}, jump = 0;
    int i, a;
    CHECK_RELATIVE("C1", j.c1, 24.662, 3e-5);
    CHECK_RELATIVE("C2", j.c2, 0.38338, 3e-5);
    CHECK_RELATIVE("C3", j.c3, 21.443, 3e-5);
    mpm_spray_jet_velocity(&j, 0, x, u);
    CHECK_RELATIVE("centreline at 0.30 m [m/s]", u[0], 36.840, 3e-5);
    x[0] = MPM_R(0.05);
    x[1] = MPM_R(0.006);
    x[2] = MPM_R(0.008);
    mpm_spray_jet_velocity(&j, 0, x, u);
    CHECK_RELATIVE("half the speed at the nozzle radius, in the core", u[0], 25, 10 * (double)MPM_EPSILON);
    CHECK_TRUE("no entrainment in the core", u[1] == 0 && u[2] == 0);
    x[0] = MPM_R(0.25);
    x[1] = MPM_R(0.03);
    x[2] = MPM_R(-0.04);
    mpm_spray_jet_velocity(&j, 0, x, u);
    CHECK_TRUE("entrainment is inwards outside the jet", u[1] < 0 && u[2] > 0);
    CHECK_RELATIVE("... and radial", u[2] * 3, u[1] * -4, 10 * (double)MPM_EPSILON);
    if (SINGLE) return; /* no room for difference quotients */
    for (a = 0; a < 2; a++)
        for (i = 0; i < 20000; i++)
            worst[a] = check_worst(worst[a], fabs(divergence(&j, a, (double)uniform(0, MPM_R(0.3)),
                                                      (double)uniform(MPM_R(1e-5), MPM_R(0.05)))));
    /* against 50 m/s over 1 cm = 5000 1/s; where the parabola of the core's end begins and ends a
       difference quotient errs by h times the second derivative */
    CHECK_NEAR("planar jet has no sources [1/s]", worst[0], 0, 0.3);
    CHECK_NEAR("axisymmetric jet has no sources [1/s]", worst[1], 0, 0.3);
    CHECK_TRUE("(the planar one used axisymmetrically has)", fabs(divergence(&j, 0, 0.2, 0.01) +
               (mpm_spray_jet_velocity(&j, 0, x, u), (double)u[1]) / 0.03) > 10);
    for (i = 0; i < 30000; i++) { /* along the path x, steps of 10 um */
        x[0] = MPM_R(1e-5) * (mpm_real)i;
        x[1] = MPM_R(0.004);
        x[2] = 0;
        mpm_spray_jet_velocity(&j, i % 2, x, u);
        x[0] += MPM_R(1e-5);
        mpm_spray_jet_velocity(&j, i % 2, x, w);
        jump = check_worst(jump, fabs((double)(w[0] - u[0])) + fabs((double)(w[1] - u[1])));
    }
    CHECK_NEAR("no jumps over 10 um [m/s]", jump, 0, 0.01);
}

/* ---- sizes --------------------------------------------------------------------------------- */

static int by_size(const void *a, const void *b)
{
    mpm_real x = *(const mpm_real *)a, y = *(const mpm_real *)b;
    return (x > y) - (x < y);
}

static void test_sizes(void)
{
    static const int shape[5] = {1, 2, 3, 5, 10};
    static mpm_real sample[1000000];
    const int n = 1000000;
    uint64_t state = 7;
    int i, k;
    for (k = 0; k < 5; k++) {
        double mean = 0, square = 0;
        mpm_real scale = mpm_spray_size_scale(MPM_R(160e-6), (mpm_real)shape[k]);
        for (i = 0; i < n; i++) {
            sample[i] = mpm_spray_size(mpm_spray_random(&state), scale, (mpm_real)shape[k], 0, 1);
            mean += (double)sample[i] / n;
        }
        for (i = 0; i < n; i++) square += ((double)sample[i] - mean) * ((double)sample[i] - mean) / n;
        qsort(sample, (size_t)n, sizeof *sample, by_size);
        CHECK_RELATIVE("median of 1e6 diameters [m]", sample[n / 2], 160e-6, 0.003);
        if (shape[k] != 5) continue;
        CHECK_RELATIVE("scale for n = 5 [m]", scale, 172.169e-6, 1e-5);
        CHECK_RELATIVE("mean for n = 5 [m]", mean, 158.080e-6, 5e-4);
        CHECK_RELATIVE("standard deviation for n = 5 [m]", sqrt(square), 36.209e-6, 3e-3);
    }
    for (i = 0; i < n; i++)
        sample[i] = mpm_spray_size(mpm_spray_random(&state), MPM_R(230e-6), 1, MPM_R(100e-6), MPM_R(300e-6));
    qsort(sample, (size_t)n, sizeof *sample, by_size);
    CHECK_TRUE("truncated sizes keep to their limits", sample[0] >= MPM_R(100e-6) && sample[n - 1] <= MPM_R(300e-6));
    /* the median d of the truncated law: exp(-d/230) is the mean of exp(-100/230) and exp(-300/230) */
    CHECK_RELATIVE("median of the truncated law [m]", sample[n / 2],
                   -230e-6 * log((exp(-100.0 / 230) + exp(-300.0 / 230)) / 2), 0.003);
}

/* The law of a sieved powder by a sum over its density, written so that nothing underflows. */
typedef struct sieve {
    double scale, n, least, most, top; /* above `top` the density is e^-40 of its start */
} sieve;

/* The part of the window below `to`; *mean: the mean diameter in it. */
static double sieve_part(const sieve *w, double to, double *mean)
{
    const double start = pow(w->least / w->scale, w->n);
    double inside = 0, below = 0, moment = 0;
    long i, cells = 100000;
    for (i = 0; i < cells; i++) {
        double size = w->least + (w->top - w->least) * ((double)i + 0.5) / (double)cells;
        double f = pow(size / w->top, w->n - 1) * exp(start - pow(size / w->scale, w->n));
        inside += f;
        moment += size * f;
        if (size < to) below += f;
    }
    *mean = moment / inside;
    return below / inside;
}

/* Median 40 um, shape n, sieved: mean and quantiles are those of the truncated law. */
static void check_sieve(double n, double least, double most)
{
    static const double part[5] = {0.001, 0.1, 0.5, 0.9, 0.999};
    const mpm_real scale = mpm_spray_size_scale(40, (mpm_real)n);
    sieve w = {(double)scale, n, least, most, 0};
    double mean = 0, wanted, skip;
    int i, draws = 20000, right = 0;
    w.top = fmin(most, w.scale * pow(pow(least / w.scale, n) + 40, 1 / n));
    sieve_part(&w, 0, &wanted);
    for (i = 0; i < draws; i++) {
        mpm_real u = ((mpm_real)i + MPM_R(0.5)) / (mpm_real)draws;
        mean += (double)mpm_spray_size(u, scale, (mpm_real)n, (mpm_real)least, (mpm_real)most) / draws;
    }
    for (i = 0; i < 5; i++) {
        double d = (double)mpm_spray_size((mpm_real)part[i], scale, (mpm_real)n, (mpm_real)least, (mpm_real)most);
        right += sieve_part(&w, 0.997 * d, &skip) <= part[i] && sieve_part(&w, 1.003 * d, &skip) >= part[i];
    }
    CHECK_RELATIVE("mean of a sieved powder [um]", mean, wanted, 0.0005);
    CHECK_NEAR("... above the lower edge [um]", mean - least, wanted - least, 0.003 * (wanted - least) + 4e-6 * least);
    CHECK_EQUAL("... and five quantiles within 0.3 %", right, 5);
}

static void test_sieves(void)
{
    static const double window[][3] = {
        {5, 1, 1000}, {5, 60, 90}, {5, 110, 150}, {5, 140, 1000}, {20, 60, 90}, {20, 5, 10}, {10, 75, 106},
        {3, 0.001, 0.01}, {1, 0.001, 0.002}, {1, 10000, 40000}, {600, 10, 11}};
    size_t k;
    for (k = 0; k < sizeof window / sizeof *window; k++) check_sieve(window[k][0], window[k][1], window[k][2]);
    CHECK_EQUAL("a tail beyond all numbers is at its start", mpm_spray_size(MPM_R(0.5), 1, 300, 1000, 2000), 1000);
    CHECK_EQUAL("all sizes may be in it", mpm_spray_size(MPM_R(0.5), 1, 1, 0, (mpm_real)HUGE_VAL) > MPM_R(0.693), 1);
}

/* ---- the cold-spray window ----------------------------------------------------------------- */

static void test_window(void)
{
    mpm_spray_window w = mpm_spray_window_aluminium();
    mpm_spray_touch t;
    memset(&t, 0, sizeof t);
    CHECK_RELATIVE("critical velocity at 14 um [m/s]", mpm_spray_window_critical(&w, MPM_R(14e-6)), 824, PRINTED(1e-9));
    CHECK_RELATIVE("critical velocity at 30 um [m/s]", mpm_spray_window_critical(&w, MPM_R(30e-6)), 761, PRINTED(1e-9));
    w.erosion = 1600;
    t.radius = MPM_R(11e-6);
    t.normal_speed = 790;
    CHECK_EQUAL("22 um at 790 m/s rebounds", mpm_spray_stick_window(&w, &t), 0);
    t.normal_speed = 795;
    CHECK_EQUAL("22 um at 795 m/s bonds", mpm_spray_stick_window(&w, &t), 1);
    t.normal_speed = 1601;
    CHECK_EQUAL("above the erosion velocity it does not", mpm_spray_stick_window(&w, &t), 0);
}

int main(void)
{
    test_contact_numbers();
    test_wall();
    test_wall_friction();
    test_pairs();
    test_transit();
    test_terminal_speed();
    test_orders();
    test_jet();
    test_sizes();
    test_sieves();
    test_window();
    return check_end();
}
