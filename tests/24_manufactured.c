/* 24_manufactured - a user's law with its own history; motions of large deformation and shocks with a known answer.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "check.h"
#include "manufactured.h"
#include "shock.h"

/* A law without stress that carries the volume ratio less 1, and counts wrong pointers. */
static mpm_status carrying(const void *material, const mpm_block *b)
{
    int p, i;
    for (p = 0; p < b->count; p++)
        b->user[1][p] = (1 + b->user[1][p]) * (1 + (b->strain[0][p] + b->strain[1][p] + b->strain[2][p])) - 1;
    for (i = 0; i < MPM_USER_FIELDS; i++) b->tally[8] += (b->user[i] == NULL) != (i >= 2);
    (void)material;
    return MPM_OK;
}

/* A bar whose points fly apart at their own pace: each keeps its own history, however they are sorted. */
static void user_fields(void)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    double worst = 0;
    int n;
    mpm_world w;
    int32_t i;
    d.cell = 1;
    d.cells[0] = d.cells[1] = 6;
    d.cells[2] = 40;
    d.origin[2] = -20;
    d.bodies = 1;
    d.user_fields = 2;
    d.basis = MPM_GIMP;
    b.shape = mpm_box(1, 1, -5, 5, 5, 5);
    b.spacing = MPM_R(0.5);
    b.density = 1;
    b.stress = carrying;
    d.points = mpm_shape_count(&d, &b.shape, b.spacing);
    CHECK_EQUAL("user fields: world", mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("user fields: body", mpm_body_add(&w, &b), MPM_OK);
    for (i = 0; i < w.points.count; i++) w.points.v[2][i] = w.points.x[2][i] * w.points.x[2][i] / 5;
    for (n = 0; n < 200; n++)
        if (mpm_step(&w, MPM_R(0.005)) < 0) break;
    CHECK_EQUAL("user fields: steps", n, 200);
    CHECK_TRUE("user fields: points were sorted", w.sorts > 1);
    CHECK_EQUAL("user fields: those asked for are shown, no others", w.tally[8], 0);
    for (i = 0; i < w.points.count; i++) /* A 3.36: the density follows from the same increments */
        worst = check_worst(worst, fabs((1 + (double)w.points.user[1][i]) * (double)w.points.density[i] - 1));
    CHECK_NEAR("user fields: volume times density is 1", worst, 0, 400 * (double)MPM_EPSILON);
    CHECK_TRUE("user fields: untouched ones stay", w.points.user[0][0] == 0 && w.points.user[0][100] == 0);
    mpm_free(&w);
}

/* Errors of coarse runs, below which only a right law of motion gets (verification page, 03). */
static void motions(void)
{
    manufactured m = manufactured_default(MANUFACTURED_AXES);
    double coarse, fine;
    m.factor = 0.4;
    m.time = 0.005;
    m.cells = 8;
    coarse = manufactured_error(&m);
    m.cells = 16;
    fine = manufactured_error(&m);
    CHECK_NEAR("axes, GIMP: error at 1/16", fine, 0, 0.03);
    CHECK_TRUE("axes, GIMP: order above 1", fine > 0 && fine < coarse / 2);
    m.basis = MPM_CUBIC; /* the wide mass is lumped: of order 1.4 on grids as coarse as these */
    fine = manufactured_error(&m);
    m.cells = 8;
    coarse = manufactured_error(&m);
    CHECK_NEAR("axes, cubic: error at 1/16", fine, 0, 0.04);
    CHECK_NEAR("axes, cubic: error at 1/8", coarse, 0, 0.1);
    CHECK_TRUE("axes, cubic: order above 1.3", fine > 0 && fine < coarse / 2.46);
    m.basis = MPM_GIMP;
    m.cells = 8;
    m.geometry = MPM_3D;
    CHECK_NEAR("axes, GIMP, cube: error at 1/8", manufactured_error(&m), 0, 0.1);
    m = manufactured_default(MANUFACTURED_VORTEX);
    m.factor = 0.4;
    m.time = 0.5;
    m.amplitude = 0.1;
    CHECK_NEAR("vortex, GIMP: error at 1/16", manufactured_error(&m), 0, 0.035);
    m.basis = MPM_LINEAR;
    CHECK_NEAR("vortex, linear: error at 1/16", manufactured_error(&m), 0, 0.05);
}

/* Al on Al at 810 m/s, laboratory frame, two bodies, thin plates (verification page, 04). */
static void shocks(void)
{
    shock s = shock_default("al", 810);
    shock_state r;
    double excess;
    s.bodies = 2;
    s.cells = 80;
    r = shock_run(&s, 1);
    CHECK_RELATIVE("shock: particle velocity", r.velocity, 405, 0.01);
    CHECK_RELATIVE("shock: speed", r.speed, 5928.3, 0.01);
    CHECK_RELATIVE("shock: pressure", r.pressure, 6482.6, 0.015);
    CHECK_RELATIVE("shock: rho/rho0", r.ratio, 1.07333, 0.002);
    CHECK_RELATIVE("shock: energy", r.energy, 0.5 * 405 * 405, 0.015);
    CHECK_RELATIVE("shock: temperature", r.temperature, 346.81, 0.01);
    excess = (r.energy - 0.5 * 405 * 405) / 900; /* thin plates: too much energy near the interface, all of it heat */
    CHECK_RELATIVE("shock: heat less that of energy in excess", r.temperature - 298 - excess, 346.81 - 298, 0.01);
}

int main(void)
{
    user_fields();
    motions();
    shocks();
    return check_end();
}
