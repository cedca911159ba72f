/* 37_surface_motion - elastic bodies on surfaces that roll, slide and bounce as rigid ones do: a disk and a sphere down
   an incline, a disk thrown at a wall and at a block; the largest time step. SPDX-License-Identifier: MIT

   A body is turned, and its surface moves, as if it were touched 0.4 cells inside: a traction accelerates the nodes at
   a surface, and these the points around them, whose middle lies there. A disk of 10 cells' radius rolls 2 % slower
   than a rigid one, a ball of 6 cells 5 %, and friction turns the disk by 6 % less: the loss goes with the cell. */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "mpm_surface.h"
#include "check.h"

static const double pi = 3.14159265358979323846;
static mpm_material metal;

/* Velocity of a body's middle, and its rate of turning about y, forwards over the plane z = 0 for x to the right. */
typedef struct motion {
    double v[3], spin, mass;
} motion;

static motion motion_of(const mpm_world *w, int32_t body)
{
    const mpm_points *p = &w->points;
    const mpm_body *b = &w->body[body];
    double at[2] = {0, 0}, turn = 0, inertia = 0;
    const mpm_totals t = mpm_body_totals(w, body);
    motion m;
    int32_t i;
    int d;
    m.mass = t.mass;
    for (d = 0; d < 3; d++) m.v[d] = t.momentum[d] / t.mass;
    for (i = b->first; i < b->first + b->count; i++)
        for (d = 0; d < 2; d++) at[d] += (double)(p->mass[i] * p->x[2 * d][i]) / t.mass;
    for (i = b->first; i < b->first + b->count; i++) {
        const double x = (double)p->x[0][i] - at[0], z = (double)p->x[2][i] - at[1], mass = (double)p->mass[i];
        turn += mass * (z * ((double)p->v[0][i] - m.v[0]) - x * ((double)p->v[2][i] - m.v[2]));
        inertia += mass * (x * x + z * z);
    }
    m.spin = turn / inertia;
    return m;
}

/* ---- down an incline ------------------------------------------------------------------------------- */

/* A disk (plane strain) or a sphere (half of it) of radius R on an incline; gravity rises, so that it hardly bounces,
   over half of the time. Its motion, the mean over the last quarter. */
static motion rolled(mpm_geometry geometry, double R, double cell, double angle, double mu, double g, double end)
{
    const int deep = geometry == MPM_3D;
    const mpm_real point[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    const double way = 0.5 * g * sin(angle) * end * end;
    mpm_desc d = scene_grid(cell, (int)((2 * R + way) / cell) + 6, deep ? (int)(R / cell) + 3 : 1,
                            (int)(2 * R / cell) + 6, -R - 3 * cell, 0, -3 * cell);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(0, 0, (mpm_real)R, (mpm_real)R), cell / 2, 0);
    mpm_surfaces s = mpm_surfaces_default();
    motion m = {{0, 0, 0}, 0, 0};
    int samples = 0, k;
    mpm_world w;
    mpm_real dt;
    d.geometry = geometry;
    d.basis = MPM_CUBIC;
    if (deep) d.side[2] = MPM_SIDE_SYMMETRY;
    s.friction = (mpm_real)mu;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("a round body's surface", mpm_surface_add(&s, &w, 0), MPM_OK);
    CHECK_EQUAL("... an incline", mpm_surface_wall_add(&s, point, up), MPM_OK);
    dt = mpm_time_step(&w, MPM_R(0.3));
    while ((double)w.time < end) {
        const double turn = sin(pi / 2 * fmin(1, 2 * (double)w.time / end)), rise = turn * turn;
        w.desc.gravity[0] = (mpm_real)(rise * g * sin(angle));
        w.desc.gravity[2] = (mpm_real)(-rise * g * cos(angle));
        if (mpm_surface_step(&s, &w, dt) < 0) break;
        if ((double)w.time < 0.75 * end || w.steps % 4) continue;
        samples++;
        for (k = 0; k < 3; k++) m.v[k] += motion_of(&w, 0).v[k];
        m.spin += motion_of(&w, 0).spin;
    }
    for (k = 0; k < 3; k++) m.v[k] /= samples;
    m.spin /= samples;
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return m;
}

/* A rigid body with inertia j m R^2 rolls with a = g sin/(1 + j) while tan < mu (1 + 1/j); beyond it slides with
   a = g (sin - mu cos) and turns by mu g cos/(j R) (Landau and Lifshitz, Mechanics, section 32: j). Returns the share
   of its speed that is missing. */
static double incline(const char *what, mpm_geometry geometry, double cells, double mu, double near_v, double near_spin)
{
    const double angle = pi / 6, g = 6e3, end = 0.05, R = 5, t = end * 5 / 8, j = geometry == MPM_3D ? 0.4 : 0.5;
    const int rolls = tan(angle) < mu * (1 + 1 / j);
    const motion m = rolled(geometry, R, R / cells, angle, mu, g, end);
    const double speed = t * (rolls ? g * sin(angle) / (1 + j) : g * (sin(angle) - mu * cos(angle)));
    const double spin = rolls ? speed / R : t * mu * g * cos(angle) / (j * R);
    const double normal = g * cos(angle) * t + m.v[2], along = g * sin(angle) * t - m.v[0];
    printf("# %s, mu = %g, %g cells in its radius: speed %.4f, turning %.4f of a rigid one's, friction %.4f of mu N\n",
           what, mu, cells, m.v[0] / speed, m.spin / spin, along / (mu * normal));
    CHECK_RELATIVE(what, m.v[0], speed, near_v);
    CHECK_RELATIVE(rolls ? "... it rolls" : "... it slides, and turns", m.spin, spin, near_spin);
    CHECK_NEAR("... and stays on it", m.v[2], 0, 0.05 * speed);
    if (!rolls) CHECK_RELATIVE("... against mu N", along, mu * normal, 0.005);
    return 1 - m.v[0] / speed;
}

static void inclines(void)
{
    const double coarse = incline("a disk down an incline", MPM_PLANE_STRAIN, 10, 0.3, 0.045, 0.03);
    const double fine = incline("a disk down an incline", MPM_PLANE_STRAIN, 16, 0.3, 0.03, 0.03);
    CHECK_TRUE("what rolling loses goes with the cell", fine < 0.75 * coarse);
    incline("a disk down an incline", MPM_PLANE_STRAIN, 10, 0.1, 0.02, 0.07);
    incline("a sphere down an incline", MPM_3D, 6, 0.3, 0.08, 0.05);
}

/* ---- thrown --------------------------------------------------------------------------------------- */

/* A disk of 10 cells' radius thrown at a wall or a block under an angle, so that it slides throughout: the impulse
   along is mu times that across, and turns it by R that over its inertia. */
static void thrown(int wall)
{
    const mpm_real point[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    const double R = 5, down = 20, along = 60, mu = 0.2, cell = 0.5;
    mpm_desc d = scene_grid(cell, 60, 1, wall ? 30 : 50, -10, 0, wall ? -2 : -12);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(0, 0, MPM_R(5.01), (mpm_real)R), cell / 2, -down);
    mpm_surfaces s = mpm_surfaces_default();
    double across, by;
    mpm_world w;
    mpm_real dt;
    motion m;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    s.friction = (mpm_real)mu;
    s.damping = 0;
    mpm_init(&w, &d, NULL, 0);
    b.velocity[0] = (mpm_real)along;
    mpm_body_add(&w, &b);
    b = scene_body(&metal, mpm_box(-9, 0, -10, 15, 1, 0), cell / 2, 0);
    if (!wall) mpm_body_add(&w, &b);
    CHECK_EQUAL(wall ? "a disk thrown at a wall" : "a disk thrown at a block", mpm_surface_add(&s, &w, 0), MPM_OK);
    if (wall) CHECK_EQUAL("... a wall", mpm_surface_wall_add(&s, point, up), MPM_OK);
    else CHECK_EQUAL("... a block", mpm_surface_add(&s, &w, 1), MPM_OK);
    dt = mpm_time_step(&w, MPM_R(0.2));
    while ((double)w.time < 0.03)
        if (mpm_surface_step(&s, &w, dt) < 0) break;
    m = motion_of(&w, 0);
    across = m.v[2] + down;
    by = along - m.v[0];
    printf("# thrown at a %s: %.4f of the speed back, friction %.4f of mu N, turning %.4f of a rigid one's\n",
           wall ? "wall" : "block", m.v[2] / down, by / (mu * across), m.spin * R / (2 * by));
    CHECK_TRUE("... it leaves", m.v[2] > 0.3 * down && m.v[2] <= down);
    CHECK_RELATIVE("... impulse along: mu times that across", by, mu * across, 0.01);
    CHECK_RELATIVE("... turned by it", m.spin, 2 * by / R, 0.07);
    if (!wall) CHECK_NEAR("... momentum", mpm_body_totals(&w, -1).momentum[0] / (m.mass * along), 1,
                          1e4 * (double)MPM_EPSILON);
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

/* ---- the largest time step -------------------------------------------------------------------------- */

/* Two bars head-on at 50 m/s with steps of `factor` of the critical one: the most energy there ever is, over what
   there was. */
static double most_energy(double stiffness, double factor)
{
    mpm_desc d = scene_grid(1, 2, 1, 30, 0, 0, -15);
    mpm_surfaces s = mpm_surfaces_default();
    double before, most = 0;
    mpm_world w;
    int32_t k;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    s.stiffness = (mpm_real)stiffness;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 2; k++) {
        const mpm_real low = k ? MPM_R(-10.1) : MPM_R(0.1);
        mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, low, 2, 1, low + 10), 0.5, k ? 50 : -50);
        mpm_body_add(&w, &b);
        CHECK_EQUAL("a bar's surface", mpm_surface_add(&s, &w, k), MPM_OK);
    }
    before = mpm_body_totals(&w, -1).kinetic;
    while ((double)w.time < 0.02) {
        if (mpm_surface_step(&s, &w, mpm_time_step(&w, (mpm_real)factor)) < 0) break;
        most = fmax(most, mpm_body_totals(&w, -1).kinetic + mpm_body_totals(&w, -1).internal);
    }
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return most / before;
}

/* With the damper, flat faces stand steps of 1.1/sqrt(stiffness) of the critical one, none of 1.6/sqrt(stiffness). */
static void largest_step(void)
{
    static const double stiffness[3] = {5, 20, 50};
    int k;
    for (k = 0; k < 3; k++) {
        const double good = most_energy(stiffness[k], 1.1 / sqrt(stiffness[k]));
        const double bad = most_energy(stiffness[k], 1.6 / sqrt(stiffness[k]));
        printf("# stiffness %g, step factors %.3f and %.3f: at most %.3f and %.3g of the energy\n", stiffness[k],
               1.1 / sqrt(stiffness[k]), 1.6 / sqrt(stiffness[k]), good, bad);
        CHECK_TRUE("the largest step: no energy is made", good < 1.01);
        CHECK_TRUE("... above it, it is", bad > 1.5);
    }
}

int main(void)
{
    metal = scene_metal(1, mpm_units_um_us_ng());
    inclines();
    thrown(1);
    thrown(0);
    largest_step();
    return check_end();
}
