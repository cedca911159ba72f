/* The same input gives the same bits: the state after nine runs, one number each. A change that means to move
   bits says so and records new numbers (the program prints them). `70_bits quick` leaves the long run out, `70_bits
   elastic` all but the two that are the same on any machine, whatever its libm, byte order and word.
   Seven of the runs call libm's exp, log, pow, erf, cbrt or tanh, whose last bits are a libm's own: where this
   libm is not the recorded one they are skipped, with a reason. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_case.h"
#include "scene.h"
#include "taylor_case.h"
#include "mpm_spray.h"

#include "check.h"

#include <string.h>

/* ---- the number ---------------------------------------------------------------------------- */

/* Fowler, Noll and Vo's hash of the eight bytes of a whole number. */
static uint64_t mix(uint64_t hash, uint64_t value)
{
    int i;
    for (i = 0; i < 8; i++) hash = (hash ^ (value >> 8 * i & 255)) * UINT64_C(1099511628211);
    return hash;
}

static uint64_t mix_double(uint64_t hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return mix(hash, bits);
}

static const uint64_t empty = UINT64_C(14695981039346656037);

/* Everything a point carries, in the order of the points' ids, and the ledger. */
static uint64_t world_bits(const mpm_world *w)
{
    const mpm_points *p = &w->points;
    const mpm_ledger *l = &w->ledger;
    int32_t *at = (int32_t *)malloc((size_t)p->count * sizeof *at), i, k;
    uint64_t hash = empty;
    int d;
    if (!at) return 0;
    for (i = 0; i < p->count; i++) at[p->id[i]] = i;
    for (k = 0; k < p->count; k++) {
        i = at[k];
        for (d = 0; d < 3; d++) hash = mix_double(mix_double(hash, (double)p->x[d][i]), (double)p->v[d][i]);
        for (d = 0; d < 6; d++) hash = mix_double(hash, (double)p->stress[d][i]);
        hash = mix_double(mix_double(hash, (double)p->mass[i]), (double)p->density[i]);
        hash = mix_double(mix_double(hash, (double)p->energy[i]), (double)p->temperature[i]);
        hash = mix_double(mix_double(hash, (double)p->plastic_strain[i]), (double)p->plastic_work[i]);
        hash = mix(mix_double(hash, (double)p->bond[i]), p->flags[i]);
    }
    free(at);
    hash = mix_double(mix_double(mix_double(hash, l->absorbed), l->contact), l->hold);
    hash = mix_double(mix_double(hash, l->walls), l->work);
    for (d = 0; d < 3; d++) hash = mix_double(hash, l->impulse[d]);
    return hash;
}

static uint64_t spray_bits(const mpm_spray *s)
{
    uint64_t hash = mix(mix(empty, (uint64_t)s->live), (uint64_t)s->deposited);
    int32_t i;
    for (i = 0; i < 3 * s->live; i++)
        hash = mix_double(mix_double(hash, (double)s->x[i]), (double)s->v[i]);
    return hash;
}

/* What this libm answers: to know it again. */
static uint64_t libm_bits(void)
{
    volatile mpm_real step = MPM_R(0.0371); /* asked when run, not by the compiler */
    uint64_t hash = empty;
    int i;
    for (i = 1; i <= 400; i++) {
        const mpm_real x = (mpm_real)i * step;
#ifdef MPM_FLOAT
        const float y[] = {expf(-x), expm1f(-x), logf(x), powf(x, 0.37f), erff(x / 5), cbrtf(x), tanhf(x / 3), sinf(x)};
#else
        const double y[] = {exp(-x), expm1(-x), log(x), pow(x, 0.37), erf(x / 5), cbrt(x), tanh(x / 3), sin(x)};
#endif
        size_t k;
        for (k = 0; k < sizeof y / sizeof *y; k++) hash = mix_double(hash, (double)y[k]);
    }
    return hash;
}

/* ---- the runs ------------------------------------------------------------------------------ */

static uint64_t run_impact(const impact_case *c, int64_t steps)
{
    char message[300];
    uint64_t hash = 0;
    impact s;
    if (!impact_begin(&s, c, message, sizeof message)) return 0;
    if (steps > s.steps) steps = s.steps;
    while (s.world.steps < steps)
        if (impact_step(&s) < 0) break;
    if (s.world.steps == steps) hash = world_bits(&s.world);
    mpm_free(&s.world);
    return hash;
}

/* The impact of examples/impact with the aluminium that source A's results were reproduced with. */
static impact_case source_a(void)
{
    impact_case c = impact_case_default();
    c.material = "al-thesis";
    return c;
}

/* ... to its end. */
static uint64_t bits_default(void)
{
    const impact_case c = source_a();
    return run_impact(&c, 1000000);
}

static uint64_t bits_default_early(void)
{
    const impact_case c = source_a();
    return run_impact(&c, 400);
}

/* GIMP, normals by logistic regression, contact where the points touch, friction. */
static uint64_t bits_logistic(void)
{
    impact_case c = source_a();
    c.functions = "gimp";
    c.normal = "logistic";
    c.touch = 1;
    c.friction = 0.2;
    c.spacing = 0.75;
    c.bond_width = 0.5;
    return run_impact(&c, 900);
}

static uint64_t bits_axisymmetric(void)
{
    impact_case c = impact_case_default();
    c.geometry = "axisymmetric";
    c.material = "cu";
    c.bond = "strain";
    c.bond_average = "weighted";
    return run_impact(&c, 4000);
}

static uint64_t bits_taylor(void)
{
    taylor_case c = taylor_case_default();
    char message[300];
    uint64_t hash = 0;
    taylor s;
    long n = 0;
    c.cell = 0.4;
    c.spacing = 0.2;
    c.model = "jc";
    c.wall = "contact";
    c.friction = 0.1;
    if (!taylor_begin(&s, &c, message, sizeof message)) return 0;
    while (n < 1500 && taylor_step(&s) >= 0) n++;
    if (n == 1500) hash = world_bits(&s.world);
    mpm_free(&s.world);
    return hash;
}

static uint64_t bits_spray(void)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    uint64_t hash = 0;
    mpm_spray s;
    d.alpha = MPM_R(1e4);
    d.capacity = 4000;
    if (mpm_spray_init(&s, &d, NULL, 0) != MPM_OK) return 0;
    while (s.tally.step < 6000)
        if (mpm_spray_step(&s) < 0) break;
    if (s.tally.step == 6000) hash = spray_bits(&s);
    mpm_spray_free(&s);
    return hash;
}

/* Elastic bodies meeting askew, rough, above a wall: sums, products, quotients and roots only. In the thesis's scheme
   and in the consistent one. */
static uint64_t elastic(mpm_scheme scheme)
{
    const mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 16, 12, 16, 0, 0, 0);
    mpm_body_desc a = scene_body(&m, mpm_box(5, 3, 9, 10, 8, 14), 0.5, -300);
    mpm_body_desc b = scene_body(&m, mpm_box(4, 2, 1, 12, 9, 8), 0.5, -40);
    uint64_t hash = 0;
    mpm_world w;
    int n;
    d.contact.friction = d.wall_friction = MPM_R(0.3);
    d.side[4] = MPM_SIDE_WALL;
    d.side[0] = MPM_SIDE_FIXED;
    d.contact.normal = MPM_NORMAL_AVERAGE;
    d.scheme = scheme;
    a.velocity[0] = 80;
    b.absorb = MPM_FACE_RIM;
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK || mpm_body_add(&w, &a) != MPM_OK || mpm_body_add(&w, &b) != MPM_OK)
        return 0;
    for (n = 0; n < 500; n++)
        if (scene_step(&w, NULL, MPM_R(1.5e-5)) < 0) break;
    if (n == 500) hash = world_bits(&w);
    mpm_free(&w);
    return hash;
}

static uint64_t bits_elastic(void) { return elastic(MPM_SCHEME_THESIS); }
static uint64_t bits_elastic_consistent(void) { return elastic(MPM_SCHEME_CONSISTENT); }

/* The default impact with bonds in the consistent scheme of contact. */
static uint64_t bits_consistent(void)
{
    impact_case c = source_a();
    c.scheme = "consistent";
    c.spacing = 0.75;
    c.friction = 0.3;
    return run_impact(&c, 900);
}

/* ---- what is recorded ---------------------------------------------------------------------- */

typedef struct recorded {
    const char *name;
    uint64_t (*run)(void);
    int libm, slow;
    uint64_t hash[2]; /* double, float */
} recorded;

int main(int argc, char **argv)
{
    static const recorded table[] = {
        {"elastic", bits_elastic, 0, 0, {UINT64_C(0x9591c038c37b59a5), UINT64_C(0x5fe164c4806b5286)}},
        {"elastic, consistent", bits_elastic_consistent, 0, 0,
         {UINT64_C(0x6555b2a7ace79a0e), UINT64_C(0x47fe55ce4b3ab8cf)}},
        {"default, 400 steps", bits_default_early, 1, 0, {UINT64_C(0x234642c8e471a98c), UINT64_C(0xe4f89df24fd3dae1)}},
        {"gimp, logistic", bits_logistic, 1, 0, {UINT64_C(0x7794de1bf34d5210), UINT64_C(0x229766585293621b)}},
        {"axisymmetric", bits_axisymmetric, 1, 0, {UINT64_C(0xb0b4748217afcdd4), UINT64_C(0x7646fc80e6ba647c)}},
        {"consistent", bits_consistent, 1, 0, {UINT64_C(0x6e494f8b8cad7d31), UINT64_C(0xc0dbe6c8efc0b16d)}},
        {"taylor", bits_taylor, 1, 0, {UINT64_C(0x532bbec3722405ca), UINT64_C(0xae7d514e50c83cf4)}},
        {"spray", bits_spray, 1, 0, {UINT64_C(0xcdb2d9be37320c1c), UINT64_C(0x44671a3a950d43b5)}},
        {"default", bits_default, 1, 1, {UINT64_C(0xf14dd4c03fe9fd1e), UINT64_C(0x562aa2dcd77ff25b)}},
    };
    const uint64_t libm[2] = {UINT64_C(0xb1aa056693a88028), UINT64_C(0x0349026f05df3184)}; /* glibc 2.36, x86-64 */
    const int quick = argc > 1 && !strcmp(argv[1], "quick"), real = sizeof(mpm_real) == sizeof(float);
    const int elastic_only = argc > 1 && !strcmp(argv[1], "elastic");
    const int same_libm = !elastic_only && libm_bits() == libm[real];
    size_t i;
    if (!same_libm && !elastic_only)
        printf("skip - runs that call libm: its numbers (%016llx) are not those recorded\n",
               (unsigned long long)libm_bits());
    for (i = 0; i < sizeof table / sizeof *table; i++) {
        uint64_t hash;
        if (table[i].slow && quick) continue;
        if (table[i].libm && !same_libm) continue;
        hash = table[i].run();
        printf("# %-24s %016llx\n", table[i].name, (unsigned long long)hash);
        CHECK_TRUE(table[i].name, hash == table[i].hash[real]);
    }
    return check_end();
}
