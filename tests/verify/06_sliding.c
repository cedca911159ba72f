/* 06_sliding - contact and friction: a block on an inclined plane, rolling, the collision of elastic
   spheres (Hertz). SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "elastic.h"

/* What the moving body meets. */
typedef enum ground { WALL, NODES, POINTS } ground;
static const char *const ground_name[] = {"rigid wall", "another body, contact of nodes",
                                          "another body, contact of points"};

static void meet(mpm_desc *d, ground g)
{
    if (g != POINTS) return;
    d->contact.normal = MPM_NORMAL_LOGISTIC;
    d->contact.touch = 1;
}

/* ---- the inclined plane ---------------------------------------------------------------------- */

static const double g = 9.81, slope = 30, ramp = 0.3;

/* The plane is z = 0 and gravity leans. It rises over `ramp`, so that nothing starts to vibrate; then the
   body has felt it for time - ramp / 2. */
static void lean(mpm_world *w)
{
    const double t = (double)w->time, s = t < ramp ? sin(pi * t / (2 * ramp)) : 1, a = slope * pi / 180;
    w->desc.gravity[0] = (mpm_real)(g * s * s * sin(a));
    w->desc.gravity[2] = (mpm_real)(-g * s * s * cos(a));
}

typedef enum rider { BLOCK, DISK, BALL } rider; /* 2 x 1; radius 0.5; radius 0.5, half of it behind y = 0 */

/* The rider on the plane: a wall, or a slab four cells thick held at its lower side. */
static void incline_begin(mpm_world *w, mpm_material *m, rider what, ground on, double cell, double mu)
{
    const int below = on == WALL ? 0 : 4;
    const double far = 4.5;
    mpm_desc d = scene_grid(cell, (int)(far / cell + 0.5), what == BALL ? (int)(0.7 / cell) : 1,
                            (int)(1.5 / cell) + below, 0, 0, -below * cell);
    mpm_body_desc b = scene_body(m, mpm_box(MPM_R(0.5), 0, 0, MPM_R(2.5), 1, 1), cell / 2, 0), slab = b;
    d.geometry = what == BALL ? MPM_3D : MPM_PLANE_STRAIN;
    d.basis = MPM_GIMP;
    d.scheme = MPM_SCHEME_THESIS;
    d.side[2] = MPM_SIDE_SYMMETRY;
    d.side[4] = on == WALL ? MPM_SIDE_WALL : MPM_SIDE_FIXED;
    d.wall_friction = d.contact.friction = (mpm_real)mu;
    meet(&d, on);
    if (what != BLOCK) b.shape = mpm_sphere(1, 0, MPM_R(0.5), MPM_R(0.5));
    mpm_init(w, &d, NULL, 0);
    mpm_body_add(w, &b);
    if (on == WALL) return;
    slab.shape = mpm_box((mpm_real)cell, 0, (mpm_real)(-below * cell), (mpm_real)(far - cell), 1, 0);
    mpm_body_add(w, &slab);
}

typedef struct motion {
    double along, spin; /* acceleration along the plane; of the angle, times the radius */
} motion;

/* Mean angular velocity about y of a body: angular momentum over moment of inertia. */
static double spin_of(const mpm_world *w, int32_t body)
{
    const mpm_points *p = &w->points;
    const mpm_body *b = &w->body[body];
    double m = 0, x = 0, z = 0, momentum = 0, inertia = 0;
    int32_t i;
    for (i = b->first; i < b->first + b->active; i++) {
        m += (double)p->mass[i];
        x += (double)(p->mass[i] * p->x[0][i]);
        z += (double)(p->mass[i] * p->x[2][i]);
    }
    for (i = b->first; i < b->first + b->active; i++) {
        const double dx = (double)p->x[0][i] - x / m, dz = (double)p->x[2][i] - z / m;
        momentum += (double)p->mass[i] * (dz * (double)p->v[0][i] - dx * (double)p->v[2][i]);
        inertia += (double)p->mass[i] * (dx * dx + dz * dz);
    }
    return momentum / inertia;
}

static motion go_down(rider what, ground on, double cell, double young, double mu, double time)
{
    mpm_material m = elastic(young, 0.3, 1000);
    const double dt = 0.2 * cell / (double)mpm_wave_speed_p(m.young, m.poisson, m.density);
    mpm_world w;
    motion r;
    incline_begin(&w, &m, what, on, cell, mu);
    do lean(&w);
    while ((double)w.time < time && mpm_step(&w, (mpm_real)dt) >= 0);
    r.along = mean_velocity(&w, 0, 0) / ((double)w.time - ramp / 2);
    r.spin = 0.5 * spin_of(&w, 0) / ((double)w.time - ramp / 2);
    mpm_free(&w);
    return r;
}

static void sliding(void)
{
    static const double mu[] = {0, 0.3, 0.7};
    const double a = slope * pi / 180;
    char line[200];
    int on, i;
    for (on = WALL; on <= POINTS; on++)
        for (i = 0; i < 3; i++) {
            const double pull = g * (sin(a) - mu[i] * cos(a)), exact = pull > 0 ? pull : 0;
            const motion r = go_down(BLOCK, (ground)on, 0.1, 1e7, mu[i], 1);
            snprintf(line, sizeof line, "block on %s, mu %g: acceleration", ground_name[on], mu[i]);
            verify_near(line, exact > 0 ? "g (sin a - mu cos a)" : "sticks", exact, r.along, 0.02 * g * sin(a));
        }
}

static void rolling(void)
{
    const double a = slope * pi / 180, disk = 2.0 / 3 * g * sin(a), ball = 5.0 / 7 * g * sin(a);
    char line[200];
    motion r;
    int on, n;
    for (on = WALL; on <= POINTS; on++)
        for (n = 10; n <= 20; n *= 2) {
            r = go_down(DISK, (ground)on, 0.5 / n, 1e6, 0.6, 0.8);
            snprintf(line, sizeof line, "disk of %d cells' radius on %s, mu 0.6: acceleration", n, ground_name[on]);
            verify_percent(line, "2/3 g sin a", disk, r.along, 5);
            verify_percent("... of its rotation, times the radius", "2/3 g sin a", disk, r.spin, 5);
        }
    r = go_down(DISK, POINTS, 0.5 / 20, 1e6, 0.1, 0.6);
    verify_percent("the same disk, contact of points, mu 0.1: acceleration", "g (sin a - mu cos a)",
                   g * (sin(a) - 0.1 * cos(a)), r.along, 5);
    verify_measured("... of its rotation, times the radius (rigid: 2 mu g cos a = 1.699)", "rigid body", r.spin);
    for (n = 5; n <= 10; n *= 2) {
        r = go_down(BALL, WALL, 0.5 / n, 1e6, 0.6, 0.8);
        snprintf(line, sizeof line, "ball of %d cells' radius on rigid wall, mu 0.6: acceleration", n);
        verify_percent(line, "5/7 g sin a", ball, r.along, 5);
    }
}

/* ---- Hertz ------------------------------------------------------------------------------------ */

/* Hertz's collision in units of depth and approach speed: u' = -(5/4) x^(3/2). The time in which 5 % to
   95 % of the impulse are exchanged; all of it takes 2.943. */
static double hertz_core(void)
{
    const double dt = 1e-5;
    double x = 0, u = 1, time = 0, low = 0, high = 0;
    do {
        u -= dt * 1.25 * x * sqrt(x);
        x += dt * u;
        time += dt;
        if ((1 - u) / 2 < 0.05) low = time;
        if ((1 - u) / 2 < 0.95) high = time;
    } while (x > 0);
    return high - low;
}

typedef struct impact {
    double duration, force, velocity; /* over Hertz's; velocity after over before */
    double early;                     /* contact begins before the spheres touch, by so many cells */
    double depth;                     /* Hertz's, in radii */
} impact;

/* A sphere (R 1, E 1, nu 0.3, rho 1) hits a rigid wall or its like at the relative speed v; axisymmetric. */
static impact hertz(ground on, int n, double v)
{
    enum { MOMENTS = 20000 };
    static double history[MOMENTS];
    const double cell = 1.0 / n, stiff = 1 / (1 - 0.3 * 0.3), mass = 4 * pi / 3;
    const double spacing = cell / (on == POINTS ? 4 : 2); /* contact of points sees their lattice */
    const double E = on == WALL ? stiff : stiff / 2, R = on == WALL ? 1 : 0.5, m = on == WALL ? mass : mass / 2;
    const double depth = pow(15 * m * v * v / (16 * sqrt(R) * E), 0.4), force = 4.0 / 3 * E * sqrt(R) * pow(depth, 1.5);
    mpm_material solid = elastic(1, 0.3, 1);
    const double dt = 0.2 * cell / (double)mpm_wave_speed_p(1, MPM_R(0.3), 1);
    const int below = on == WALL ? 0 : 2 * n + 4, window = (int)(2.943 * depth / v / 20 / dt);
    mpm_desc d = scene_grid(cell, n + 4, 1, 2 * n + 6 + below, 0, 0, -below * cell);
    mpm_body_desc b = scene_body(&solid, mpm_sphere(0, 0, (mpm_real)(1 + cell), 1), spacing, on == WALL ? -v : -v / 2);
    double low = 0, high = 0, first = 0, start, weight, part;
    impact r = {0, 0, 0, 0, depth};
    mpm_world w;
    int i, last = 0;
    d.geometry = MPM_AXISYMMETRIC;
    d.basis = MPM_GIMP;
    d.scheme = MPM_SCHEME_THESIS;
    d.side[0] = MPM_SIDE_SYMMETRY;
    if (on == WALL) d.side[4] = MPM_SIDE_WALL;
    meet(&d, on);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    if (on != WALL) {
        b.shape = mpm_sphere(0, 0, -1, 1);
        b.velocity[2] = (mpm_real)(v / 2);
        mpm_body_add(&w, &b);
    }
    weight = mpm_body_totals(&w, 0).mass;
    start = mean_velocity(&w, 0, 2);
    while ((double)w.time < 1.5 * cell / v + 1.3 * 2.943 * depth / v && last < MOMENTS &&
           mpm_step(&w, (mpm_real)dt) >= 0)
        history[last++] = mean_velocity(&w, 0, 2) - start;
    if (last == 0) history[last++] = NAN; /* it failed: so do the rows */
    for (i = 0; i < last; i++) {
        part = history[i] / history[last - 1];
        if (part < 0.001) first = dt * (i + 1);
        if (part < 0.05) low = dt * (i + 1);
        if (part < 0.95) high = dt * (i + 1);
        if (i < window) continue;
        part = weight * (history[i] - history[i - window]) / (window * dt) / force;
        r.force = part > r.force ? part : r.force;
    }
    r.duration = (high - low) / (hertz_core() * depth / v);
    r.velocity = history[last - 1] / -start - 1;
    r.early = (cell / v - first) * v / cell;
    mpm_free(&w);
    return r;
}

static void spheres(void)
{
    char line[200];
    impact r;
    int on, n;
    for (on = WALL; on <= POINTS; on++)
        for (n = 20; n <= 40; n *= 2) {
            r = hertz((ground)on, n, 0.01);
            snprintf(line, sizeof line, "sphere of %d cells' radius on %s: duration over Hertz's", n, ground_name[on]);
            verify_percent(line, "2.943 d / v", 1, r.duration, 3);
            verify_percent("... greatest force over Hertz's", "4/3 E* sqrt(R d^3)", 1, r.force, 3);
            verify_percent("... velocity afterwards over before", "elastic", 1, r.velocity, 3);
            verify_measured("... contact begins early, cells", "geometry", r.early);
        }
    r = hertz(WALL, 20, 0.03);
    verify_measured("20 cells on rigid wall, three times as fast (depth 0.1 R): duration over Hertz's", "2.943 d / v",
                    r.duration);
    verify_measured("... greatest force over Hertz's", "4/3 E* sqrt(R d^3)", r.force);
}

int main(void)
{
    verify_begin("Sliding, rolling, Hertz",
                 "An elastic block (2 x 1, ten cells high), disk or ball (R 0.5) on a plane inclined by 30 degrees,\n"
                 "GIMP; the grid follows the plane, gravity leans and rises over 0.3 s so that the elastic body does\n"
                 "not start to bounce. The ground is a rigid wall (a side of the grid) or an elastic slab, met\n"
                 "through contact of nodes (the default) or of points (logistic normals, `touch`). Rigid bodies\n"
                 "accelerate by g (sin a - mu cos a), or by 2/3 (disk) and 5/7 (ball) of g sin a while friction\n"
                 "suffices. Then two elastic spheres, or one and a rigid wall, collide slowly, axisymmetric: with d\n"
                 "= (15 m* v^2 / (16 sqrt(R) E*))^(2/5) Hertz has them touch for 2.943 d / v. The duration is\n"
                 "measured between 5 % and 95 % of the impulse, the force over a twentieth of it. v is 0.01 of\n"
                 "sqrt(E/rho); d is 0.042 R at the wall, 0.048 R between spheres: one or two cells.");
    sliding();
    rolling();
    verify_remark("Sliding and sticking are right to 1 %. Rolling loses: what a disk touches in front is stopped node\n"
                  "by node, and on standard contact it is held up to a cell above the plane. The loss falls in\n"
                  "proportion to the cell or faster (wall 21, 7 %; nodes 18, 7 %; points 9, 3 %; ball 29, 10 %), so 5\n"
                  "% wants 20 cells per radius with contact of points and some 30 without. A slipping disk of 20\n"
                  "cells gets a third too little spin.");
    spheres();
    verify_remark("Hertz is met to 3 % by some rows, not by all. Contact of points, with 4 x 4 points per cell,\n"
                  "begins when the spheres touch, returns the velocity to 1 % and is too stiff in proportion to the\n"
                  "cell: 16 and 7 % in duration, 15 and 8 % in force, for 20 and 40 cells per radius, so that 3 %\n"
                  "wants about 100. With 2 x 2 points it sees the lattice: 0.85, 0.96, 0.95 and 1.12, 1.00, 1.07 for\n"
                  "20, 40, 60 cells. Contact of nodes and walls begins most of a cell early and returns 2 to 8 % more\n"
                  "velocity than came in, a share that halves with the cell. Part of the shorter duration is not the\n"
                  "grid's: Hertz's contact is shallow, a deep one (0.1 R, last rows) is stiffer.");
    return verify_end();
}
