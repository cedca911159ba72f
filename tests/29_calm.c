/* 29_calm - mpm_calm: what the grid does not see of velocities and pressures dies out, in the time asked for; what it
   sees stays, and so do mass, momentum, volume and energy. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"
#include <string.h>

static const double eps = (double)MPM_EPSILON;

enum { CELLS = 12 };

/* A number in -1 .. 1 from another: the same everywhere. */
static double noise_of(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 8388608.0 - 1;
}

/* An elastic block of 6 cells, or 4 in three dimensions, with noise of 100 m/s and 1 GPa, amid a grid or on a mirror.
   It turns by `spin` about y. */
static void begin(mpm_world *w, mpm_material *m, mpm_geometry geometry, mpm_basis basis, int mirror, double spin,
                  double calm)
{
    const mpm_real wide = geometry == MPM_3D ? 4 : 6, from = mirror ? 0 : 3;
    mpm_desc d = scene_grid(1, CELLS, geometry == MPM_3D ? CELLS : 1, CELLS, 0, 0, 0);
    mpm_body_desc b;
    uint32_t seed = 7;
    int32_t i;
    int a;
    *m = scene_metal(1, mpm_units_um_us_ng());
    b = scene_body(m, mpm_box(from, 3, 3, from + wide, 3 + wide, 3 + wide), 0.25, 0);
    if (geometry == MPM_3D) b.spacing = MPM_R(0.5);
    d.geometry = geometry;
    d.basis = basis;
    d.calm = (mpm_real)calm;
    if (mirror) d.side[0] = MPM_SIDE_SYMMETRY;
    mpm_init(w, &d, NULL, 0);
    mpm_body_add(w, &b);
    for (i = 0; i < w->points.count; i++) {
        const mpm_real p = (mpm_real)(1000 * noise_of(&seed));
        w->points.v[0][i] = (mpm_real)spin * (w->points.x[2][i] - b.shape.center[2]);
        w->points.v[2][i] = (mpm_real)-spin * (w->points.x[0][i] - b.shape.center[0]);
        for (a = 0; a < 3; a++) {
            if (a != 1 || geometry == MPM_3D) w->points.v[a][i] += (mpm_real)(100 * noise_of(&seed));
            w->points.stress[a][i] = -p;
        }
        w->points.density[i] *= 1 + p / MPM_R(7e4);
    }
}

/* One call of mpm_calm in a step of dt, without the rest of the step; then time goes on. */
static void calm(mpm_world *w, double dt)
{
    mpm_locate(w, (mpm_real)dt);
    mpm_calm(w);
    w->time += w->dt;
}

typedef struct sums {
    mpm_totals t;
    double volume, angular;
} sums;

static sums sums_of(const mpm_world *w)
{
    const mpm_points *q = &w->points;
    sums s;
    int32_t i;
    s.t = mpm_body_totals(w, -1);
    s.volume = s.angular = 0;
    for (i = 0; i < q->count; i++) {
        s.volume += (double)q->mass[i] / (double)q->density[i];
        s.angular += (double)q->mass[i] * (double)q->x[2][i] * (double)q->v[0][i];
        s.angular -= (double)q->mass[i] * (double)q->x[0][i] * (double)q->v[2][i];
    }
    return s;
}

/* Nothing is lost. Momentum across a mirror is the mirror's, and in the ledger. Conjugate gradients amplify round-off:
   energy is good to half the digits. Angular momentum is as good as they have converged: of a single step it would miss
   0.4 to 2.2 %. */
static void conserves(mpm_geometry geometry, mpm_basis basis, int mirror)
{
    static const char *const place[] = {"3d", "plane", "axisymmetric"};
    mpm_material m;
    mpm_world w;
    sums before, after;
    double scale;
    int a;
    begin(&w, &m, geometry, basis, mirror, mirror ? 0 : 30, 1);
    before = sums_of(&w);
    calm(&w, 0.5);
    after = sums_of(&w);
    printf("# %s, %s%s: noise of %.3g pJ less %.3g, heat %.3g\n", place[geometry], scene_basis(basis),
           mirror ? ", mirror" : "", before.t.kinetic, before.t.kinetic - after.t.kinetic, w.ledger.calm);
    scale = 100 * before.t.mass;
    CHECK_TRUE("noise dies", after.t.kinetic < 0.95 * before.t.kinetic);
    for (a = 0; a < 3; a++)
        CHECK_NEAR("... momentum stays", after.t.momentum[a] - w.ledger.impulse[a], before.t.momentum[a],
                   64 * eps * scale);
    if (!mirror) CHECK_NEAR("... without help", w.ledger.impulse[0], 0, 64 * eps * scale);
    if (!mirror) CHECK_NEAR("... and angular momentum", after.angular, before.angular, 0.002 * fabs(before.angular));
    CHECK_RELATIVE("... volume", after.volume, before.volume, 64 * eps);
    CHECK_NEAR("... energy", after.t.kinetic + after.t.internal, before.t.kinetic + before.t.internal,
               sqrt(eps) * before.t.kinetic);
    CHECK_TRUE("... and it is in the ledger", w.ledger.calm > before.t.kinetic - after.t.kinetic);
    mpm_free(&w);
}

/* The momentum of every node, but for what ten steps of conjugate gradients leave: a single step misses a quarter. */
static void grid_stays(void)
{
    mpm_material m;
    mpm_world w, quiet;
    double worst = 0, most = 0;
    int32_t i;
    int d;
    begin(&w, &m, MPM_PLANE_STRAIN, MPM_CUBIC, 0, 0, 0);
    begin(&quiet, &m, MPM_PLANE_STRAIN, MPM_CUBIC, 0, 0, 1);
    mpm_locate(&w, 1);
    mpm_calm(&w);
    mpm_p2g(&w);
    mpm_locate(&quiet, 1);
    mpm_calm(&quiet);
    mpm_p2g(&quiet);
    for (i = 0; i < w.nodes; i++)
        for (d = 0; d < 3; d++) {
            most = fmax(most, fabs((double)w.node[i].momentum[d]));
            worst = check_worst(worst, fabs((double)(quiet.node[i].momentum[d] - w.node[i].momentum[d])));
        }
    printf("# the grid's momentum: %.2g of its greatest\n", worst / most);
    CHECK_EQUAL("as many nodes", quiet.nodes, w.nodes);
    CHECK_NEAR("the grid sees the same", worst / most, 0, 0.1);
    mpm_free(&w);
    mpm_free(&quiet);
}

/* The norm of all points' difference in velocity. */
static double apart(const mpm_world *a, const mpm_world *b)
{
    double sum = 0;
    int32_t i;
    int d;
    for (i = 0; i < a->points.count; i++)
        for (d = 0; d < 3; d++) sum += pow((double)(a->points.v[d][i] - b->points.v[d][i]), 2);
    return sqrt(sum);
}

/* In the time desc.calm it falls to 1/e, in steps that are short, or to e^-3 in one of three times that. */
static void dies_in_time(double step, double until)
{
    mpm_material m;
    mpm_world w, seen;
    double first;
    begin(&w, &m, MPM_PLANE_STRAIN, MPM_CUBIC, 0, 0, 1);
    begin(&seen, &m, MPM_PLANE_STRAIN, MPM_CUBIC, 0, 0, 1);
    calm(&seen, 100); /* nothing is left of it */
    first = apart(&w, &seen);
    while ((double)w.time < until - step / 2) calm(&w, step);
    CHECK_RELATIVE("it dies in its time", apart(&w, &seen) / first, exp(-until), 0.01);
    mpm_free(&w);
    mpm_free(&seen);
}

/* Velocity and pressure that are the same everywhere stay, to the last digits; with desc.calm 0 every bit stays. */
static void stays(void)
{
    mpm_material m;
    mpm_world w, other;
    double worst = 0;
    int32_t i;
    begin(&w, &m, MPM_3D, MPM_CUBIC, 0, 0, 1);
    for (i = 0; i < w.points.count; i++) {
        w.points.v[0][i] = 300;
        w.points.v[1][i] = w.points.v[2][i] = 0;
        w.points.stress[0][i] = w.points.stress[1][i] = w.points.stress[2][i] = 1000;
    }
    calm(&w, 100);
    for (i = 0; i < w.points.count; i++) {
        worst = check_worst(worst, fabs((double)w.points.v[0][i] / 300 - 1));
        worst = check_worst(worst, fabs((double)w.points.stress[1][i] / 1000 - 1));
    }
    CHECK_NEAR("what is alike stays", worst, 0, 256 * eps);
    mpm_free(&w);
    begin(&w, &m, MPM_PLANE_STRAIN, MPM_CUBIC, 0, 0, 0);
    begin(&other, &m, MPM_PLANE_STRAIN, MPM_CUBIC, 0, 0, 0);
    calm(&w, 100);
    CHECK_EQUAL("0: never", memcmp(w.points.v[0], other.points.v[0], sizeof(mpm_real) * (size_t)w.points.count), 0);
    CHECK_EQUAL("... pressures too",
                memcmp(w.points.stress[0], other.points.stress[0], sizeof(mpm_real) * (size_t)w.points.count), 0);
    mpm_free(&w);
    mpm_free(&other);
}

/* A standing wave of 16 cells in a bar between mirrors, ten periods in 2.6 times desc.calm: energy that became heat. */
static void wave(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 2, 1, 16, 0, 0, 0);
    mpm_body_desc b = scene_body(&m, mpm_box(0, 0, 0, 2, 1, 16), 0.25, 0);
    const double until = 160 / (double)b.wave_p;
    mpm_totals before;
    mpm_world w;
    mpm_real dt;
    int32_t i;
    int s;
    for (s = 0; s < 6; s++)
        if (s / 2 != 1) d.side[s] = MPM_SIDE_SYMMETRY;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    d.calm = MPM_R(0.01);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    for (i = 0; i < w.points.count; i++) w.points.v[2][i] = (mpm_real)sin((double)(MPM_PI * w.points.x[2][i]) / 8);
    before = mpm_body_totals(&w, -1);
    dt = mpm_time_step(&w, MPM_R(0.2));
    while ((double)w.time < until)
        if (mpm_step(&w, dt) < 0) break;
    printf("# a wave of 16 cells after ten periods: %.2g of its energy are heat\n", w.ledger.calm / before.kinetic);
    CHECK_TRUE("the wave has run", (double)w.time >= until);
    CHECK_NEAR("... and is left alone", w.ledger.calm / before.kinetic, 0, 1e-4);
    CHECK_RELATIVE("... its energy is there", mpm_body_totals(&w, -1).kinetic + mpm_body_totals(&w, -1).internal,
                   before.kinetic, 0.01);
    mpm_free(&w);
}

static void refusals(void)
{
    mpm_desc d = scene_grid(1, 2, 2, 2, 0, 0, 0);
    mpm_fault f;
    d.calm = -1;
    CHECK_EQUAL("a negative time", mpm_desc_check(&d, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... is named", strcmp(f.field, "calm"), 0);
    d.calm = (mpm_real)NAN;
    CHECK_EQUAL("no number", mpm_desc_check(&d, &f), MPM_ERR_NAN);
}

int main(void)
{
    conserves(MPM_PLANE_STRAIN, MPM_CUBIC, 0);
    conserves(MPM_PLANE_STRAIN, MPM_QUADRATIC, 0);
    conserves(MPM_PLANE_STRAIN, MPM_LINEAR, 0);
    conserves(MPM_3D, MPM_CUBIC, 0);
    conserves(MPM_3D, MPM_GIMP, 1);
    conserves(MPM_AXISYMMETRIC, MPM_CUBIC, 1);
    grid_stays();
    dies_in_time(0.03125, 1);
    dies_in_time(0.05, 1);
    dies_in_time(3, 3);
    stays();
    wave();
    refusals();
    return check_end();
}
