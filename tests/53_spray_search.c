/* The spray's contacts: bins against every pair, nothing passes through anything, energy in a box.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_spray.h"

#include <stdlib.h>

#include "check.h"
#include "spray_state.h"

static uint64_t dice = 11;

static mpm_real uniform(mpm_real low, mpm_real high) { return low + mpm_spray_random(&dice) * (high - low); }

/* A closed box of the given edge, from -edge/2 to edge/2 in y and z and 0 to edge in x, walls that
   only reflect; no gas, no feed. */
static mpm_spray_plane walls[6];

static mpm_spray_desc box_of(mpm_real edge)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    int k;
    memset(walls, 0, sizeof walls);
    for (k = 0; k < 6; k++) {
        int axis = k / 2;
        walls[k].normal[axis] = k % 2 ? -1 : 1;
        walls[k].point[axis] = (k % 2 ? 1 : -1) * edge / 2 + (axis == 0 ? edge / 2 : 0);
    }
    d.planes = walls;
    d.plane_count = 6;
    d.batch = 0;
    d.gas = MPM_SPRAY_GAS_STILL;
    d.gas_density = 0;
    d.rebound = MPM_SPRAY_REBOUND_CONSTANT;
    d.capacity = 2000;
    return d;
}

/* side^3 particles of mixed size on a loose lattice, in random motion. */
static void fill_box(mpm_spray *s, mpm_real edge, int count, mpm_real speed)
{
    int side = 1, n, k;
    while (side * side * side < count) side++;
    for (n = 0; n < count; n++) {
        mpm_spray_ball b;
        mpm_real cell = edge / (mpm_real)side;
        memset(&b, 0, sizeof b);
        b.x[0] = (MPM_R(0.5) + (mpm_real)(n % side)) * cell;
        b.x[1] = (MPM_R(0.5) + (mpm_real)(n / side % side)) * cell - edge / 2;
        b.x[2] = (MPM_R(0.5) + (mpm_real)(n / side / side)) * cell - edge / 2;
        for (k = 0; k < 3; k++) b.v[k] = uniform(-speed, speed);
        b.radius = cell * uniform(MPM_R(0.05), MPM_R(0.45));
        b.density = 5680;
        if (mpm_spray_add(s, &b) != MPM_OK) return;
    }
}

/* Deepest penetration of any two particles, over the smaller radius. */
static double deepest(const mpm_spray *s)
{
    double worst = 0;
    int32_t i, j;
    for (i = 0; i < s->live; i++)
        for (j = 0; j < i; j++) {
            double d2 = 0, a = (double)s->radius[i], b = (double)s->radius[j];
            int k;
            for (k = 0; k < 3; k++) {
                double d = (double)s->x[3 * i + k] - (double)s->x[3 * j + k];
                d2 += d * d;
            }
            worst = check_worst(worst, (a + b - sqrt(d2)) / fmin(a, b));
        }
    return worst;
}

static double energy(const mpm_spray *s)
{
    double sum = 0;
    int32_t i;
    int k;
    for (i = 0; i < s->live; i++) {
        double r = (double)s->radius[i], r3 = r * r * r;
        for (k = 0; k < 3; k++) {
            double v = (double)s->v[3 * i + k], w = (double)s->spin[3 * i + k] * r;
            sum += r3 * (v * v + 0.4 * w * w);
        }
    }
    return sum;
}

/* ---- bins against every pair --------------------------------------------------------------- */

static void test_dense(void)
{
    const mpm_real edge = MPM_R(0.01);
    mpm_spray a, b;
    mpm_spray_desc d = box_of(edge);
    uint64_t start = dice;
    double depth = 0;
    int n, same = 1, steps = sizeof(mpm_real) == 8 ? 1000 : 100; /* every pair takes its time */
    d.restitution = MPM_R(0.95);
    done("init", mpm_spray_init(&a, &d, NULL, 0));
    d.search = MPM_SPRAY_ALL_PAIRS;
    done("init, every pair", mpm_spray_init(&b, &d, NULL, 0));
    fill_box(&a, edge, 2000, 20);
    dice = start;
    fill_box(&b, edge, 2000, 20);
    for (n = 0; n < steps; n++) {
        mpm_spray_step(&a);
        mpm_spray_step(&b);
        if (n % 100 != 99) continue;
        same = same && same_state(&a, &b);
        depth = check_worst(depth, deepest(&a));
    }
    CHECK_TRUE("2000 particles, all steps: bins and every pair give the same bytes", same);
    CHECK_TRUE("... with thousands of collisions", a.tally.pair_hits > 10 * steps && a.tally.wall_hits > steps);
    CHECK_EQUAL("... equally many", a.tally.pair_hits, b.tally.pair_hits);
    CHECK_EQUAL("... and nobody lost", a.live, 2000);
    CHECK_NEAR("no two penetrate (of the smaller radius)", depth, 0, 1e5 * (double)MPM_EPSILON);
    mpm_spray_free(&a);
    mpm_spray_free(&b);
}

/* The same with feed, gas and a growing deposit. */
static void test_spray(void)
{
    mpm_spray a, b;
    mpm_spray_desc d = mpm_spray_desc_default();
    int n, same = 1;
    d.feed = MPM_R(2e5);
    d.stand_off = MPM_R(0.02);
    d.release[0] = 5;
    d.alpha = MPM_R(2e4);
    d.size_shape = 2;
    done("init", mpm_spray_init(&a, &d, NULL, 0));
    d.search = MPM_SPRAY_ALL_PAIRS;
    done("init, every pair", mpm_spray_init(&b, &d, NULL, 0));
    for (n = 0; n < 1200; n++) {
        mpm_spray_step(&a);
        mpm_spray_step(&b);
        if (n % 300 == 299) same = same && same_state(&a, &b);
    }
    CHECK_TRUE("spray with deposit: bins and every pair give the same bytes", same);
    CHECK_TRUE("... with hits of all kinds",
               a.tally.pair_hits > 50 && a.tally.target_hits > 500 && a.tally.deposit_hits > 20);
    mpm_spray_free(&a);
    mpm_spray_free(&b);
}

/* An inlet with more to place than it has room for: the places found are the same, and none overlaps. */
static void test_crowded(void)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray a, b;
    d.capacity = d.batch = 1000;
    d.nozzle_radius = 12 * d.median_radius;
    done("init", mpm_spray_init(&a, &d, NULL, 0));
    d.search = MPM_SPRAY_ALL_PAIRS;
    done("init, every pair", mpm_spray_init(&b, &d, NULL, 0));
    done("inject", mpm_spray_inject(&a));
    done("inject, every pair", mpm_spray_inject(&b));
    CHECK_TRUE("a crowded inlet: the others wait", a.live > 20 && a.live < 500 && a.tally.pending == 1000 - a.live);
    CHECK_TRUE("... bins and every pair give the same bytes", same_state(&a, &b));
    CHECK_TRUE("... nobody overlaps", deepest(&a) < 1e2 * (double)MPM_EPSILON);
    mpm_spray_free(&a);
    mpm_spray_free(&b);
}

/* ---- energy in the box --------------------------------------------------------------------- */

static void test_energy(void)
{
    const mpm_real edge = MPM_R(0.005);
    mpm_spray s;
    mpm_spray_desc d = box_of(edge);
    double before, least, rise = 0, now;
    int n;
    d.restitution = 1;
    d.friction = 0;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    fill_box(&s, edge, 300, 40);
    before = energy(&s);
    for (n = 0; n < 1000; n++) mpm_spray_step(&s);
    CHECK_TRUE("thousands of elastic collisions", s.tally.pair_hits > 3000);
    CHECK_RELATIVE("... keep the energy", energy(&s), before, 3e4 * (double)MPM_EPSILON);
    mpm_spray_free(&s);

    d.restitution = MPM_R(0.9);
    d.friction = MPM_R(0.55);
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    fill_box(&s, edge, 300, 40);
    least = before = energy(&s);
    for (n = 0; n < 1000; n++) {
        mpm_spray_step(&s);
        now = energy(&s);
        rise = check_worst(rise, now / least - 1);
        least = fmin(least, now);
    }
    CHECK_NEAR("with friction and loss it never rises", rise, 0, 300 * (double)MPM_EPSILON);
    CHECK_TRUE("... and falls", least < 0.9 * before);
    mpm_spray_free(&s);
}

/* ---- nothing passes through anything ------------------------------------------------------- */

static mpm_spray_ball flying(mpm_real x, mpm_real y, mpm_real v)
{
    mpm_spray_ball b;
    memset(&b, 0, sizeof b);
    b.x[0] = x;
    b.x[1] = y;
    b.v[0] = v;
    b.radius = MPM_R(80e-6);
    b.density = 5680;
    return b;
}

/* Head-on pairs at +-80 m/s, each step 5 diameters of approach, met at every phase of the step.
   Returns how many of 200 pairs have passed through each other. */
static int passed_pairs(mpm_spray_contact contact)
{
    mpm_spray s;
    mpm_spray_desc d = box_of(1);
    int k, passed = 0;
    d.contact = contact;
    for (k = 0; k < 3; k++) {
        d.low[k] = -1;
        d.high[k] = 1;
    }
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    for (k = 0; k < 200; k++) {
        mpm_real y = MPM_R(0.001) * (mpm_real)(k - 100), gap = MPM_R(0.01) + MPM_R(4e-6) * (mpm_real)k;
        mpm_spray_ball a = flying(MPM_R(0.1), y, 80), b = flying(MPM_R(0.1) + gap, y + MPM_R(40e-6), -80);
        if (mpm_spray_add(&s, &a) != MPM_OK || mpm_spray_add(&s, &b) != MPM_OK) break;
    }
    for (k = 0; k < 60; k++) mpm_spray_step(&s);
    for (k = 0; k < 200; k++) passed += s.x[6 * k] > s.x[6 * k + 3];
    mpm_spray_free(&s);
    return passed;
}

static void test_tunnels(void)
{
    mpm_spray s;
    mpm_spray_desc d;
    int k, crossed = 0, passed = passed_pairs(MPM_SPRAY_SWEPT), missed = passed_pairs(MPM_SPRAY_OVERLAP);
    CHECK_EQUAL("no pair at 80 m/s passes through each other", passed, 0);
    CHECK_TRUE("(by overlap at the ends of steps most do)", missed > 100);
    d = box_of(MPM_R(0.01));
    d.restitution = 1;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    for (k = 0; k < 100; k++) {
        mpm_spray_ball b = flying(MPM_R(0.005), MPM_R(9e-4) * ((mpm_real)(k % 10) - MPM_R(4.5)),
                                  80 + MPM_R(0.37) * (mpm_real)k);
        b.x[2] = MPM_R(9e-4) * ((mpm_real)(k / 10) - MPM_R(4.5));
        if (mpm_spray_add(&s, &b) != MPM_OK) break;
    }
    for (k = 0; k < 2000; k++) {
        int32_t i;
        mpm_spray_step(&s);
        for (i = 0; i < s.live; i++)
            crossed += (double)s.x[3 * i] < 80e-6 - 0.01 * 4 * (double)MPM_EPSILON ||
                       (double)s.x[3 * i] > 0.01 - 80e-6 + 0.01 * 4 * (double)MPM_EPSILON;
    }
    CHECK_EQUAL("no wall is entered at 80 to 117 m/s", crossed, 0);
    CHECK_TRUE("... though hit often", s.tally.wall_hits > 5000);
    mpm_spray_free(&s);
}

/* ---- several contacts within one step ------------------------------------------------------ */

static void test_chain(void)
{
    mpm_spray s;
    mpm_spray_desc d = box_of(1);
    int k;
    d.restitution = 1;
    d.friction = 0;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    for (k = 0; k < 5; k++) { /* a moving ball and a row of four with 1 um between them */
        mpm_spray_ball b = flying(MPM_R(0.5) + MPM_R(161e-6) * (mpm_real)k, 0, k == 0 ? 40 : 0);
        done("add", mpm_spray_add(&s, &b));
    }
    mpm_spray_step(&s);
    CHECK_EQUAL("a row of five is struck through in one step", s.tally.pair_hits, 4);
    CHECK_RELATIVE("the last one leaves with the speed of the first", s.v[12], 40, 1e5 * (double)MPM_EPSILON);
    CHECK_NEAR("... and has gone the rest of the way", s.x[12], 0.5 + 4 * 161e-6 + 40 * 5e-6 - 4e-6,
               8 * (double)MPM_EPSILON);
    CHECK_NEAR("the first one rests", s.v[0], 0, 4e6 * (double)MPM_EPSILON);
    mpm_spray_free(&s);
}

static void test_moving_wall(void)
{
    mpm_spray s;
    mpm_spray_plane p[2];
    mpm_spray_desc d = box_of(1);
    mpm_spray_ball b = flying(MPM_R(0.001), 0, -10);
    int k, inside = 1;
    memset(p, 0, sizeof p);
    p[0].normal[0] = 1;
    p[0].velocity[0] = 5;
    p[1].normal[0] = -1;
    p[1].point[0] = MPM_R(0.002);
    d.planes = p;
    d.plane_count = 1;
    d.restitution = MPM_R(0.8);
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    done("add", mpm_spray_add(&s, &b));
    for (k = 0; k < 30; k++) mpm_spray_step(&s);
    CHECK_RELATIVE("a wall coming at 5 m/s throws it back at (1 + e) 5 + e 10", s.v[0], 17, 20 * (double)MPM_EPSILON);
    mpm_spray_free(&s);

    d.plane_count = 2; /* now squeezed between the two: the wall arrives after 0.37 ms */
    d.contacts_max = 8;
    b.v[0] = 0;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    done("add", mpm_spray_add(&s, &b));
    for (k = 0; k < 74; k++) {
        mpm_spray_step(&s);
        inside = inside && s.x[0] >= 0 && s.x[0] <= MPM_R(0.002) && s.x[0] - s.x[0] == 0;
    }
    CHECK_TRUE("a particle squeezed between walls ends the step", s.tally.step == 74 && s.tally.capped > 0);
    CHECK_TRUE("... where it was", inside);
    mpm_spray_free(&s);
}

int main(void)
{
    test_dense();
    test_spray();
    test_crowded();
    test_energy();
    test_tunnels();
    test_chain();
    test_moving_wall();
    return check_end();
}
