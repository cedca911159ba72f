/* The spray as a whole: bookkeeping, injection, measures, determinism, restart, dust, outcomes of
   touches. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_spray.h"

#include <stdlib.h>

#include "check.h"
#include "spray_state.h"

static int books_balance(const mpm_spray *s)
{
    const mpm_spray_tally *t = &s->tally;
    return t->injected == s->live + t->deposited + t->escaped && t->deposited == s->deposited;
}

/* A short, crowded, mixed case: much is hit, much bounces, some escapes. */
static mpm_spray_desc crowded(void)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    d.stand_off = MPM_R(0.05);
    d.feed = MPM_R(5e5);
    d.alpha = MPM_R(1e4);
    d.release[0] = 10;
    d.low[1] = d.low[2] = MPM_R(-0.02);
    d.high[1] = d.high[2] = MPM_R(0.02);
    d.size_shape = 2;
    return d;
}

static void run_to(mpm_spray *s, int64_t step)
{
    while (s->tally.step < step)
        if (mpm_spray_step(s) < 0) return;
}

/* ---- injection ----------------------------------------------------------------------------- */

/* Gap between particle i and the nearest other in flight, over the sum of their radii. */
static double tightest(const mpm_spray *s, int32_t first)
{
    double least = 1e9;
    int32_t i, j;
    for (i = first; i < s->live; i++)
        for (j = 0; j < s->live; j++) {
            double d2 = 0, reach = (double)s->radius[i] + (double)s->radius[j];
            int k;
            for (k = 0; k < 3; k++) {
                double d = (double)s->x[3 * i + k] - (double)s->x[3 * j + k];
                d2 += d * d;
            }
            if (j != i) least = fmin(least, sqrt(d2) / reach - 1);
        }
    return least;
}

static void test_injection(void)
{
    mpm_spray s;
    mpm_spray_desc d = crowded();
    double least = 1e9;
    int inside = 1, n = 0, balanced = 1, k;
    d.release[0] = 0; /* slow ones stay in the way */
    d.batch = 200;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    for (n = 0; n < 2000; n++) { /* the step, phase by phase */
        int32_t before = s.live;
        if (mpm_spray_inject(&s) < 0 || mpm_spray_fly(&s) < 0) break;
        least = fmin(least, tightest(&s, before));
        for (k = before; k < s.live; k++)
            inside = inside && s.x[3 * k] == 0 &&
                     hypot((double)s.x[3 * k + 1], (double)s.x[3 * k + 2]) + (double)s.radius[k] <=
                         0.01 * (1 + 4 * (double)MPM_EPSILON);
        mpm_spray_bin(&s);
        mpm_spray_find(&s);
        mpm_spray_resolve(&s);
        mpm_spray_move(&s);
        mpm_spray_escape(&s);
        s.tally.step++;
        balanced = balanced && books_balance(&s);
    }
    CHECK_EQUAL("2000 steps", n, 2000);
    CHECK_EQUAL("5e5 per second over 10 ms in batches of 200", s.tally.injected, 5000);
    CHECK_TRUE("no particle is injected into another", least > 0 && least < 0.2);
    CHECK_TRUE("all are injected inside the nozzle", inside);
    CHECK_TRUE("injected = in flight + deposited + escaped after every step", balanced);
    CHECK_TRUE("... with all of them at work", s.live > 100 && s.deposited > 100 && s.tally.escaped > 100);
    mpm_spray_free(&s);

    d = crowded();
    d.median_radius = MPM_R(0.003); /* three to a nozzle */
    d.size_shape = 50;
    d.release[0] = d.release[1] = 1;
    d.stand_off = MPM_R(0.3);
    d.feed = MPM_R(1e5);
    d.diameter_max = MPM_R(0.01);
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    run_to(&s, 50);
    CHECK_TRUE("what finds no room waits", s.tally.pending > 0 && s.live + s.tally.pending == 50 && s.live <= 7);
    CHECK_TRUE("... without overlap", tightest(&s, 0) > 0);
    mpm_spray_free(&s);

    d = mpm_spray_desc_default();
    d.total = 120;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    run_to(&s, 99);
    CHECK_EQUAL("the first batch comes at t = 0", s.tally.injected, 50);
    run_to(&s, 201);
    CHECK_EQUAL("the feed ends at the total", s.tally.injected, 120);
    run_to(&s, 301);
    CHECK_EQUAL("... for good", s.tally.injected, 120);
    mpm_spray_free(&s);
}

/* ---- same bytes ---------------------------------------------------------------------------- */

static void test_determinism(void)
{
    mpm_spray a, b, c;
    mpm_spray_desc d = crowded();
    size_t bytes = mpm_spray_bytes(&d);
    void *memory = malloc(bytes);
    done("init", mpm_spray_init(&a, &d, NULL, 0));
    done("init in the caller's memory", mpm_spray_init(&b, &d, memory, bytes));
    d.capacity += 1000;
    done("init for the restart, with more room", mpm_spray_init(&c, &d, NULL, 0));
    run_to(&a, 2000);
    run_to(&b, 1000);
    done("the state at half time", copy_state(&b, &c));
    CHECK_EQUAL("... which is step 1000", c.tally.step, 1000);
    run_to(&b, 2000);
    CHECK_TRUE("same seed, same bytes", same_state(&a, &b));
    CHECK_RELATIVE("the time of step 2000 [s]", mpm_spray_time(&b), 2000 * 5e-6, 4 * (double)MPM_EPSILON);
    run_to(&c, 2000);
    CHECK_TRUE("restart at half time gives the bytes of the uninterrupted run", same_state(&a, &c));
    CHECK_TRUE("... of a run with deposit, bounces and collisions",
               a.deposited > 100 && a.tally.pair_hits > 100 && a.tally.deposit_hits > 100);
    mpm_spray_free(&c);
    d.seed = 2;
    done("init with another seed", mpm_spray_init(&c, &d, NULL, 0));
    run_to(&c, 2000);
    CHECK_TRUE("another seed, other bytes", !same_state(&a, &c));
    mpm_spray_free(&a);
    mpm_spray_free(&b);
    mpm_spray_free(&c);
    free(memory);
}

/* ---- dust ---------------------------------------------------------------------------------- */

static void test_dust(void)
{
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray_ball b;
    mpm_status worst = MPM_OK;
    int32_t i;
    int finite = 1, k;
    d.size_shape = 1;
    d.diameter_min = MPM_R(1e-8);
    d.feed = MPM_R(2e5);
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    memset(&b, 0, sizeof b);
    b.density = 5680;
    for (k = 0; k < 8; k++) { /* 10 nm to 0.1 mm */
        b.radius = MPM_R(5e-9) * (mpm_real)pow(4, k);
        b.x[1] = MPM_R(0.0005) * (mpm_real)k;
        if (mpm_spray_add(&s, &b) != MPM_OK) worst = MPM_ERR_FULL;
    }
    while (s.tally.step < 3000 && worst >= 0) {
        mpm_status status = mpm_spray_step(&s);
        if (status < 0) worst = status;
    }
    for (i = 0; i < 3 * s.live; i++) finite = finite && s.x[i] - s.x[i] == 0 && s.v[i] - s.v[i] == 0;
    for (i = 0; i < 3 * s.deposited; i++) finite = finite && s.deposit_x[i] - s.deposit_x[i] == 0;
    CHECK_EQUAL("n = 1 with dust runs", worst, MPM_OK);
    CHECK_TRUE("... without NaN", finite);
    CHECK_TRUE("... books balance", books_balance(&s));
    CHECK_TRUE("dust takes the exponential update", s.tally.exponential > 1000);
    CHECK_EQUAL("... so that every iteration converges", s.tally.not_converged, 0);
    mpm_spray_free(&s);
}

/* A fixed point that is not given enough iterations says so and stays sane, in either jet. */
static void test_not_converged(mpm_spray_gas gas)
{
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_status status;
    d.gas = gas;
    d.tolerance = MPM_R(1e-15);
    d.iterations = 1;
    d.median_radius = MPM_R(2e-6);
    d.dt = MPM_R(2e-5);
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    status = mpm_spray_step(&s);
    if (sizeof(mpm_real) == 8) {
        CHECK_EQUAL("too few iterations are reported", status, MPM_NOT_CONVERGED);
        CHECK_TRUE("... and counted", s.tally.not_converged > 0);
    }
    CHECK_TRUE("... and the velocity is between the particle's and the gas's", s.v[0] > 0 && s.v[0] < 51);
    mpm_spray_free(&s);
}

/* ---- measures and outcomes ----------------------------------------------------------------- */

static mpm_spray_desc still_air(void)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    d.batch = 0;
    d.gas = MPM_SPRAY_GAS_STILL;
    d.gas_density = 0;
    d.capacity = 64;
    return d;
}

static void throw_one(mpm_spray *s, mpm_real y, mpm_real z, mpm_real radius, mpm_real speed)
{
    mpm_spray_ball b;
    memset(&b, 0, sizeof b);
    b.x[0] = MPM_R(0.29);
    b.x[1] = y;
    b.x[2] = z;
    b.v[0] = speed;
    b.radius = radius;
    b.density = 5680;
    done("add", mpm_spray_add(s, &b));
}

static void test_measures(void)
{
    const double eps = (double)MPM_EPSILON, pi = 3.14159265358979324;
    mpm_spray s;
    mpm_spray_metrics m;
    mpm_spray_desc d = still_air();
    double ball = 4 * pi / 3 * 1e-12, end;
    d.alpha = (mpm_real)HUGE_VAL;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    throw_one(&s, MPM_R(0.003), MPM_R(0.004), MPM_R(1e-4), 10); /* r = 5 mm, just within */
    throw_one(&s, MPM_R(-0.008), 0, MPM_R(1e-4), 20);
    throw_one(&s, 0, MPM_R(-0.012), MPM_R(2e-4), 30);
    throw_one(&s, MPM_R(0.06), 0, MPM_R(1e-4), 0); /* outside the box */
    throw_one(&s, 0, 0, MPM_R(1e-4), 0);           /* stays where it is */
    s.x[2] -= MPM_R(1e-6);
    run_to(&s, 400);
    mpm_spray_measure(&s, &m);
    CHECK_EQUAL("injected", m.injected, 5);
    CHECK_EQUAL("deposited", m.deposited, 3);
    CHECK_EQUAL("escaped", m.escaped, 1);
    CHECK_EQUAL("in flight", m.in_flight, 1);
    CHECK_RELATIVE("deposit fraction", m.deposit_fraction, 0.6, 4 * eps);
    CHECK_RELATIVE("mean spread", m.mean_spread, 25e-3 / 3, 1e-3);
    CHECK_RELATIVE("scatter", m.scatter, sqrt(74.0 / 3 * 1e-6 * 1.0 / 3.0), 1e-3);
    CHECK_RELATIVE("thickness is that of the centres", m.thickness, 1e-4, 3e4 * eps);
    CHECK_RELATIVE("volume within 5 mm", m.volume_r5mm, ball, 10 * eps);
    CHECK_RELATIVE("volume within 10 mm", m.volume_r10mm, 2 * ball, 10 * eps);
    CHECK_RELATIVE("volume fraction of the pellet", m.volume_fraction, ball / (pi * 25e-6 * 0.01), 10 * eps);
    CHECK_RELATIVE("mean impact speed", m.impact_speed_mean, 20, 10 * eps);
    CHECK_RELATIVE("its standard deviation", m.impact_speed_sd, sqrt(200.0 / 3), 10 * eps);
    CHECK_EQUAL("all stuck at first touch", m.first_hit_stuck_fraction == 1, 1);
    end = (double)mpm_spray_time(&s);
    s.desc.batch = 1; /* as if they had been fed, so many in a second */
    s.desc.feed = 1000;
    s.desc.late = (mpm_real)(1 - (double)(s.deposit_time[1] + s.deposit_time[2]) / (2 * end));
    mpm_spray_measure(&s, &m);
    CHECK_RELATIVE("one of three arrives late", m.late_rate_over_feed * 1000 * end * (double)s.desc.late, 1, 10 * eps);
    mpm_spray_free(&s);
}

/* Two particles, one behind the other on the axis: what the second does on the first. */
static void second_lands(mpm_spray_deposit how, mpm_real alpha, int deposited, const char *what)
{
    mpm_spray s;
    mpm_spray_desc d = still_air();
    d.alpha = alpha;
    d.deposit = how;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    throw_one(&s, 0, 0, MPM_R(80e-6), 30);
    run_to(&s, 80);
    throw_one(&s, 0, 0, MPM_R(80e-6), 30);
    run_to(&s, 200);
    CHECK_EQUAL(what, s.deposited, deposited);
    if (deposited == 2 && how != MPM_SPRAY_DEPOSIT_IGNORE)
        CHECK_RELATIVE("... touching it", s.deposit_x[0] - s.deposit_x[3], 160e-6, 3e4 * (double)MPM_EPSILON);
    if (deposited == 2 && how == MPM_SPRAY_DEPOSIT_IGNORE)
        CHECK_RELATIVE("... at the same place", s.deposit_x[0], s.deposit_x[3], 0);
    if (deposited == 1) CHECK_TRUE("... flying back", s.live == 1 && s.v[0] < 0);
    mpm_spray_free(&s);
}

static int refuse(void *user, const mpm_spray_touch *t)
{
    *(int *)user += t->host < 0 && t->plane == 0 && t->first && t->normal_speed == 30;
    return 0;
}

static void test_outcomes(void)
{
    mpm_spray s;
    mpm_spray_desc d = still_air();
    mpm_spray_plane tilted;
    mpm_real infinite = (mpm_real)HUGE_VAL;
    int asked = 0;
    /* sticking speeds at 80 um: 1.262e-3 alpha on the target, 0.1446 times that on an equal particle */
    second_lands(MPM_SPRAY_DEPOSIT_STICK, infinite, 2, "infinite alpha sticks to the deposit");
    second_lands(MPM_SPRAY_DEPOSIT_STICK, MPM_R(3e4), 1,
                 "a particle that sticks to the target bounces off the deposit");
    second_lands(MPM_SPRAY_DEPOSIT_STICK, MPM_R(3e5), 2, "ten times alpha: it sticks there too");
    second_lands(MPM_SPRAY_DEPOSIT_ALWAYS, MPM_R(3e4), 2, "always: it sticks");
    second_lands(MPM_SPRAY_DEPOSIT_BOUNCE, infinite, 1, "bounce: it does not");
    second_lands(MPM_SPRAY_DEPOSIT_IGNORE, MPM_R(3e4), 2, "ignore: it passes through");

    d.stick = refuse;
    d.stick_user = &asked;
    d.alpha = infinite;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    throw_one(&s, 0, 0, MPM_R(80e-6), 30);
    run_to(&s, 100);
    CHECK_TRUE("the caller's criterion is asked and obeyed", asked == 1 && s.deposited == 0 && s.v[0] < 0);
    mpm_spray_free(&s);

    memset(&tilted, 0, sizeof tilted);
    tilted.point[0] = MPM_R(0.3);
    tilted.normal[0] = -3;
    tilted.normal[1] = 4;
    tilted.target = 1;
    d = still_air();
    d.planes = &tilted;
    d.plane_count = 1;
    d.alpha = infinite;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    throw_one(&s, 0, 0, MPM_R(80e-6), 30);
    run_to(&s, 100);
    CHECK_EQUAL("a tilted target collects", s.deposited, 1);
    CHECK_NEAR("... at contact", (s.deposit_x[0] - MPM_R(0.3)) * MPM_R(-0.6) + s.deposit_x[1] * MPM_R(0.8), 80e-6,
               4 * (double)MPM_EPSILON);
    mpm_spray_free(&s);
}

int main(void)
{
    test_injection();
    test_determinism();
    test_dust();
    test_not_converged(MPM_SPRAY_GAS_JET);
    test_not_converged(MPM_SPRAY_GAS_AXISYMMETRIC);
    test_measures();
    test_outcomes();
    return check_end();
}
