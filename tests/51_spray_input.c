/* Bad input to the spray: every wrong value is refused with its name. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_spray.h"

#include <string.h>

#include "spray_state.h"

static mpm_real not_a_number(void)
{
    mpm_real zero = 0;
    return zero / zero;
}

/* The description d must be refused with `status`, naming `field` and holding `value`. */
static void refused(const mpm_spray_desc *d, mpm_status status, const char *field, mpm_real value)
{
    mpm_spray s;
    mpm_fault f;
    mpm_status got = mpm_spray_init(&s, d, NULL, 0);
    CHECK_EQUAL(field, got, status);
    CHECK_TRUE("... is named", s.fault.field && !strcmp(s.fault.field, field));
    CHECK_TRUE("... with its value", s.fault.value == value || (value != value && s.fault.value != s.fault.value));
    CHECK_EQUAL("... by the check alone too", mpm_spray_check(d, &f), status);
    CHECK_EQUAL("... and it has no size", mpm_spray_bytes(d), 0);
    mpm_spray_free(&s);
}

#define REFUSED(member, bad, status, name)             \
    do {                                               \
        mpm_spray_desc d = mpm_spray_desc_default();   \
        d.member = bad;                                \
        refused(&d, status, name, (mpm_real)d.member); \
    } while (0)
#define WRONG(member, bad) REFUSED(member, bad, MPM_ERR_ARGUMENT, #member)
#define NAN_IN(member) REFUSED(member, not_a_number(), MPM_ERR_NAN, #member)

static void test_values(void)
{
    WRONG(density, -1);
    WRONG(median_radius, MPM_R(-80e-6));
    WRONG(median_radius, 0);
    WRONG(size_shape, 0);
    WRONG(diameter_min, -1);
    WRONG(diameter_max, MPM_R(0.021)); /* wider than the nozzle */
    WRONG(nozzle_radius, 0);
    WRONG(feed, 0);
    WRONG(feed, -5);
    WRONG(feed, MPM_R(1e20));
    WRONG(batch, -1);
    WRONG(release[0], -1);
    WRONG(release[1], -1);
    WRONG(gas_speed, 0);
    WRONG(gas_density, -1);
    WRONG(gas_viscosity, 0);
    WRONG(core_length, -1);
    WRONG(core_blend, 0);
    WRONG(friction, -1);
    WRONG(friction_speed, 0);
    WRONG(restitution, MPM_R(1.5));
    WRONG(alpha, -1);
    WRONG(gamma_target, -1);
    WRONG(gamma_deposit, -1);
    WRONG(stand_off, MPM_R(-0.1));
    WRONG(stand_off, MPM_R(0.001)); /* inside the nozzle */
    WRONG(low[1], MPM_R(0.06));
    WRONG(dt, 0);
    WRONG(dt, MPM_R(1e-3)); /* 50 mm in one step: no straight path */
    WRONG(theta, MPM_R(1.5));
    WRONG(tolerance, 0);
    WRONG(iterations, 0);
    WRONG(contacts_max, 0);
    WRONG(capacity, 0);
    WRONG(total, -1);
    WRONG(target_radius, 0);
    WRONG(target_thickness, -1);
    WRONG(late, 0);
    WRONG(plane_count, 9);
    NAN_IN(median_radius);
    NAN_IN(feed);
    NAN_IN(release[1]);
    NAN_IN(gas_speed);
    NAN_IN(alpha);
    NAN_IN(stand_off);
    NAN_IN(dt);
    NAN_IN(high[2]);
    REFUSED(particle.shear, -1, MPM_ERR_ARGUMENT, "shear");
    REFUSED(target.yield, not_a_number(), MPM_ERR_NAN, "yield");
    REFUSED(gas, MPM_SPRAY_GAS_USER, MPM_ERR_ARGUMENT, "gas"); /* without a function */
}

static void test_planes(void)
{
    mpm_spray_plane p;
    mpm_spray_desc d = mpm_spray_desc_default();
    memset(&p, 0, sizeof p);
    d.planes = &p;
    d.plane_count = 1;
    refused(&d, MPM_ERR_ARGUMENT, "normal of plane", 0);
    p.normal[0] = -2;
    p.velocity[1] = 3;
    p.target = 1; /* a moving target */
    refused(&d, MPM_ERR_ARGUMENT, "velocity of plane", 3);
}

static void bad_gas(void *user, mpm_real time, const mpm_real x[3], mpm_real u[3])
{
    (void)user;
    (void)x;
    u[0] = time > MPM_R(1e-4) ? not_a_number() : 50;
    u[1] = u[2] = 0;
}

static void test_run(void)
{
    static double memory[1000];
    mpm_spray s;
    mpm_spray_ball b;
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_status status = MPM_OK;
    CHECK_EQUAL("caller's memory too small", mpm_spray_init(&s, &d, memory, sizeof memory), MPM_ERR_MEMORY);
    CHECK_EQUAL("... that is not aligned", mpm_spray_init(&s, &d, (char *)memory + 1, 64), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "memory (not aligned)") && s.fault.value == 1);
    d.capacity = 60;
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    while (status >= 0 && s.tally.step < 1000) status = mpm_spray_step(&s);
    CHECK_EQUAL("more particles than the capacity", status, MPM_ERR_FULL);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "capacity") && s.fault.value == 60);
    CHECK_EQUAL("... with all that fitted in flight", s.live, 60);
    mpm_spray_free(&s);

    d = mpm_spray_desc_default();
    d.gas = MPM_SPRAY_GAS_USER;
    d.gas_fn = bad_gas;
    status = mpm_spray_init(&s, &d, NULL, 0);
    while (status >= 0 && s.tally.step < 1000) status = mpm_spray_step(&s);
    CHECK_EQUAL("a gas that is not a number stops the run", status, MPM_ERR_NAN);
    CHECK_TRUE("... at its time", s.tally.step >= 19 && s.tally.step <= 21);

    memset(&b, 0, sizeof b);
    b.density = 1;
    CHECK_EQUAL("a particle without radius", mpm_spray_add(&s, &b), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "radius of particle"));
    b.radius = 1;
    b.v[2] = not_a_number();
    CHECK_EQUAL("a particle with a velocity that is not a number", mpm_spray_add(&s, &b), MPM_ERR_NAN);
    mpm_spray_free(&s);
}

/* ---- a state from elsewhere ---------------------------------------------------------------- */

/* States that no step leaves, and would lead out of the memory or never end: case k, and what the fault names. */
static const char *const crafted[] = {
    "live", "live", "deposited", "tally.deposited", "tally.escaped", "tally.injected", "tally.step", "tally.batches",
    "tally.pending", "tally.wait_radius", "tally.wait_speed", "velocity of particle", "radius of particle",
    "position in deposit", "radius in deposit", "point of plane", "x", "deposit time"};
#define CRAFTED ((int)(sizeof crafted / sizeof *crafted))

static void spoil(mpm_spray *s, mpm_blob *blob, int k)
{
    switch (k) {
    case 0: s->live = -1; break;
    case 1: s->live = 2147483647; break;
    case 2: s->deposited = -2147483647 - 1; break;
    case 3: s->tally.deposited++; break;
    case 4: s->tally.escaped = INT64_MAX; break;
    case 5: s->tally.injected = -INT64_MAX; break;
    case 6: s->tally.step = INT64_MAX; break;
    case 7: s->tally.batches = -INT64_MAX; break;
    case 8: s->tally.pending = INT64_MAX; break;
    case 9: s->tally.wait_radius = 1; break;
    case 10: s->tally.wait_speed = (double)not_a_number(); break;
    case 11: s->v[1] = not_a_number(); break;
    case 12: s->radius[0] = 0; break;
    case 13: s->deposit_x[2] = not_a_number(); break;
    case 14: s->deposit_radius[0] = -1; break;
    case 15: s->plane[0].point[1] = not_a_number(); break;
    case 16: blob[0].bytes--; break;
    case 17: blob[12].bytes += sizeof(mpm_real); break;
    default: break;
    }
}

static void test_restored(void)
{
    mpm_blob blob[MPM_SPRAY_BLOBS];
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    int k, n;
    d.stand_off = MPM_R(0.03);
    d.release[0] = d.release[1] = 50;
    d.alpha = (mpm_real)HUGE_VAL;
    for (k = -1; k < CRAFTED; k++) {
        mpm_status status = mpm_spray_init(&s, &d, NULL, 0);
        while (status >= 0 && s.tally.step < 200) status = mpm_spray_step(&s);
        CHECK_TRUE("a spray in flight, with deposit", status >= 0 && s.live > 0 && s.deposited > 0);
        n = mpm_spray_blobs(&s, blob);
        CHECK_EQUAL("blobs", n, MPM_SPRAY_BLOBS - MPM_SPRAY_PLANES + 1);
        spoil(&s, blob, k);
        status = mpm_spray_restored(&s, blob);
        if (k < 0) {
            CHECK_EQUAL("a state as it was", status, MPM_OK);
            mpm_spray_free(&s);
            continue;
        }
        CHECK_TRUE(crafted[k], status == MPM_ERR_ARGUMENT || status == MPM_ERR_NAN);
        CHECK_TRUE("... is named", !strcmp(s.fault.field, crafted[k]));
        CHECK_TRUE("... and the spray is empty", s.live == 0 && s.deposited == 0 && s.tally.injected == 0);
        CHECK_TRUE("... and goes on", mpm_spray_step(&s) >= 0);
        mpm_spray_free(&s);
    }
    memset(&d, 0, sizeof d);
    CHECK_EQUAL("a description of zeros", mpm_spray_check(&d, &s.fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "desc (not from mpm_spray_desc_default)"));
}

/* A spray that was never prepared answers with a status; a description that is not there too; a feed of a thousand
   million particles a step takes no longer than another. */
static void test_unprepared(void)
{
    mpm_spray_ball b;
    mpm_blob blob[MPM_SPRAY_BLOBS];
    mpm_spray_metrics m;
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray s;
    memset(&b, 0, sizeof b);
    CHECK_EQUAL("no description", mpm_spray_check(NULL, NULL), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... has no size", mpm_spray_bytes(NULL), 0);
    CHECK_EQUAL("... makes no spray", mpm_spray_init(&s, NULL, NULL, 0), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "desc (NULL)"));
    CHECK_EQUAL("a step of it", mpm_spray_step(&s), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "spray (not from mpm_spray_init)"));
    CHECK_EQUAL("a particle for it", mpm_spray_add(&s, &b), MPM_ERR_ARGUMENT);
    mpm_spray_blobs(&s, blob);
    CHECK_EQUAL("a state for it", mpm_spray_restored(&s, blob), MPM_ERR_ARGUMENT);
    mpm_spray_bin(&s);
    mpm_spray_measure(&s, &m);
    CHECK_EQUAL("it holds nothing", m.injected + m.in_flight, 0);
    d.capacity = 100;
    d.batch = 1;
    d.feed = MPM_R(1.9e14);
    done("init", mpm_spray_init(&s, &d, NULL, 0));
    s.tally.step = 1000000; /* 1e15 batches are due */
    CHECK_EQUAL("a huge feed fills it", mpm_spray_step(&s), MPM_ERR_FULL);
    mpm_spray_free(&s);
    CHECK_EQUAL("a step of a freed one", mpm_spray_step(&s), MPM_ERR_ARGUMENT);
}

int main(void)
{
    test_unprepared();
    test_values();
    test_planes();
    test_run();
    test_restored();
    return check_end();
}
