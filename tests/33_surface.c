/* 33_surface - contact on surfaces: outlines, their areas and normals, how they follow their bodies and are refined;
   bars, spheres beside Hertz and the finite sphere, sliding, three bodies; momentum, energy, refusals.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "mpm_surface.h"
#include "check.h"
#include "sphere.h"

static const double eps = (double)MPM_EPSILON;
static const double pi = 3.14159265358979323846;
static mpm_material metal;

static double area_of(const mpm_surface *c)
{
    double area = 0;
    int32_t i;
    for (i = 0; i < c->markers; i++) area += (double)c->marker[i].area;
    return area;
}

/* ---- outlines ------------------------------------------------------------------------------ */

/* Area of a shape's outline, and the furthest that a normal is from `want`'s. */
static double outline(mpm_geometry geometry, mpm_shape shape, int mirror, double *area, double *sum)
{
    mpm_desc d = scene_grid(1, 10, 1, 20, mirror ? 0 : -5, 0, -10);
    mpm_body_desc b = scene_body(&metal, shape, 0.5, -3);
    mpm_surfaces s = mpm_surfaces_default();
    double worst = 0;
    mpm_world w;
    int32_t i;
    d.geometry = geometry;
    if (mirror) d.side[0] = MPM_SIDE_SYMMETRY;
    CHECK_EQUAL("a world", mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("... a body", mpm_body_add(&w, &b), MPM_OK);
    CHECK_EQUAL("... its outline", mpm_surface_add(&s, &w, 0), MPM_OK);
    *area = area_of(&s.surface[0]);
    *sum = 0;
    for (i = 0; i < s.surface[0].markers; i++) {
        const mpm_marker *m = &s.surface[0].marker[i];
        const double x = (double)(m->x[0] - shape.center[0]), z = (double)(m->x[2] - shape.center[2]);
        const double out = (x * (double)m->normal[0] + z * (double)m->normal[2]) / hypot(x, z);
        *sum += (double)(m->area * m->normal[2]);
        worst = check_worst(worst, 1 - out);
        CHECK_TRUE("... a marker moves with its body", !(m->v[2] > -3) && !(m->v[2] < -3));
    }
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return worst;
}

static void outlines(void)
{
    double area, sum, tilt;
    tilt = outline(MPM_AXISYMMETRIC, mpm_sphere(0, 0, 0, 3), 1, &area, &sum);
    CHECK_RELATIVE("a sphere's outline: its area", area, 36 * pi, 0.001);
    CHECK_NEAR("... along its radii", tilt, 0, 1e-3);
    CHECK_NEAR("... closed", sum / area, 0, 1e-6);
    tilt = outline(MPM_PLANE_STRAIN, mpm_sphere(0, 0, 0, 3), 0, &area, &sum);
    CHECK_RELATIVE("a disk's: its circumference", area, 6 * pi, 0.001);
    CHECK_NEAR("... along its radii", tilt, 0, 1e-3);
    outline(MPM_AXISYMMETRIC, mpm_cylinder(0, 0, -2, 3, 4), 1, &area, &sum);
    CHECK_RELATIVE("a cylinder's", area, 2 * pi * 9 + 2 * pi * 3 * 4, 1e4 * eps);
    outline(MPM_PLANE_STRAIN, mpm_box(0, 0, -2, 3, 1, 2), 1, &area, &sum);
    CHECK_RELATIVE("half a box's, open at the mirror", area, 3 + 4 + 3, 1e4 * eps);
}

static void refusals(void)
{
    const mpm_real x[3] = {0, 1, 2}, z[3] = {0, MPM_R(0.5), 0}, none[3] = {0, 0, 0};
    mpm_real bad[3] = {0, 1, 2};
    mpm_desc d = scene_grid(1, 10, 1, 10, 0, 0, 0);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(5, 0, 5, 2), 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    mpm_world w, cube;
    bad[1] = (mpm_real)NAN;
    mpm_init(&cube, &d, NULL, 0);
    d.geometry = MPM_PLANE_STRAIN;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("no such body", mpm_surface_add(&s, &w, 1), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("three dimensions", mpm_surface_add(&s, &cube, 0), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("one place", mpm_surface_add_chain(&s, &w, 0, 1, x, z, 0), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("no place", mpm_surface_add_chain(&s, &w, 0, 3, bad, z, 0), MPM_ERR_NAN);
    CHECK_EQUAL("... is number 1", s.fault.index, 1);
    CHECK_EQUAL("a wall without a normal", mpm_surface_wall_add(&s, x, none), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("a chain of one's own", mpm_surface_add_chain(&s, &w, 0, 3, x, z, 1), MPM_OK);
    CHECK_EQUAL("... once", mpm_surface_add(&s, &w, 0), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... one surface", s.surfaces, 1);
    s.stiffness = 0;
    CHECK_EQUAL("no stiffness", mpm_surfaces_check(&s, &s.fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(s.fault.field, "stiffness"));
    s.stiffness = 5;
    s.surface[0].marker[0].x[0] = MPM_R(1e30);
    CHECK_EQUAL("a marker far off", mpm_surface_step(&s, &w, MPM_R(1e-6)), MPM_OK);
    s.surface[0].marker[2].v[2] = s.surface[0].marker[2].x[2] = (mpm_real)NAN;
    CHECK_EQUAL("a marker that is nowhere", mpm_surface_step(&s, &w, MPM_R(1e-6)), MPM_ERR_NAN);
    CHECK_EQUAL("... is number 2", w.fault.index, 2);
    mpm_surfaces_free(&s);
    CHECK_EQUAL("given back", s.surfaces, 0);
    w.body[0].desc.wave_p = 0;
    s = mpm_surfaces_default();
    CHECK_EQUAL("a body without a wave speed", mpm_surface_add(&s, &w, 0), MPM_ERR_ARGUMENT);
    w.body[0].desc.shape.kind = MPM_SHAPE_USER;
    w.body[0].desc.wave_p = 1;
    CHECK_EQUAL("a shape without an outline", mpm_surface_add(&s, &w, 0), MPM_ERR_ARGUMENT);
    s.mark = 0;
    CHECK_EQUAL("not from its default", mpm_surface_add(&s, &w, 0), MPM_ERR_ARGUMENT);
    mpm_free(&w);
    mpm_free(&cube);
}

/* ---- following ------------------------------------------------------------------------------ */

/* A block without stress whose points fly apart, to twice its width and half its height: its outline stretches with it
   and is halved. Nodes beyond a face know but the points within, so that it lags by a part of a cell. */
static void stretched(mpm_basis basis)
{
    mpm_desc d = scene_grid(1, 16, 1, 16, -8, 0, -8);
    mpm_body_desc b = scene_body(&metal, mpm_box(-2, 0, -2, 2, 1, 2), 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    double worst = 0, longest = 0;
    mpm_world w;
    int32_t i, before;
    b.stress = NULL;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = basis;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("an outline", mpm_surface_add(&s, &w, 0), MPM_OK);
    for (i = 0; i < w.points.count; i++) {
        w.points.v[0][i] = w.points.x[0][i];
        w.points.v[2][i] = -w.points.x[2][i] / 2;
    }
    before = s.surface[0].markers;
    while (w.time < 1)
        if (mpm_surface_step(&s, &w, MPM_R(0.005)) < 0) break;
    for (i = 0; i < s.surface[0].faces; i++) {
        const mpm_real *p = s.surface[0].marker[s.surface[0].face[i][0]].x;
        const mpm_real *q = s.surface[0].marker[s.surface[0].face[i][1]].x;
        longest = fmax(longest, hypot((double)(p[0] - q[0]), (double)(p[2] - q[2])));
    }
    for (i = 0; i < s.surface[0].markers; i++) { /* now on a box of 8 by 2 */
        const mpm_real *x = s.surface[0].marker[i].x;
        worst = check_worst(worst, fabs(fmax(fabs((double)x[0]) - 4, fabs((double)x[2]) - 1)));
    }
    printf("# %s: markers %d to %d, furthest off the box %.3f cells, longest face %.3f cells\n", scene_basis(basis),
           (int)before, (int)s.surface[0].markers, worst, longest);
    CHECK_TRUE("a stretched outline is refined", s.surface[0].markers > before && longest < 0.52);
    CHECK_EQUAL("... closed as before", s.surface[0].faces, s.surface[0].markers);
    CHECK_NEAR("... and follows its body [cells]", worst, 0, 0.5);
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

/* ---- bars ----------------------------------------------------------------------------------- */

typedef struct result {
    double speed, contact, missed, momentum, walls; /* what came back; energies over the kinetic one before */
} result;

/* Two elastic bars head-on, or one on a wall, at a place of the grid; order: who is added first. */
static result bars(int wall, double offset, double speed, double factor, int order, mpm_real damping)
{
    const mpm_real floor[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    mpm_desc d = scene_grid(1, 2, 1, 40, 0, 0, -20 - offset);
    mpm_surfaces s = mpm_surfaces_default();
    mpm_totals t;
    double before, unit;
    int32_t k;
    result r;
    mpm_world w;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    s.damping = damping;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < (wall ? 1 : 2); k++) {
        const int low = k != order;
        const mpm_real bottom = low ? MPM_R(-10.1) : MPM_R(0.1);
        const mpm_shape shape = mpm_box(0, 0, bottom, 2, 1, bottom + 10);
        mpm_body_desc b = scene_body(&metal, shape, 0.5, low ? speed : -speed);
        mpm_body_add(&w, &b);
        CHECK_EQUAL("a bar's outline", mpm_surface_add(&s, &w, k), MPM_OK);
    }
    if (wall) CHECK_EQUAL("a wall", mpm_surface_wall_add(&s, floor, up), MPM_OK);
    before = mpm_body_totals(&w, -1).kinetic;
    unit = mpm_body_totals(&w, 0).mass * speed;
    while ((double)w.time < 0.2 / speed + 40 / (double)w.body[0].desc.wave_p)
        if (mpm_surface_step(&s, &w, mpm_time_step(&w, (mpm_real)factor)) < 0) break;
    t = mpm_body_totals(&w, -1);
    r.momentum = wall ? 0 : t.momentum[2] / unit;
    r.speed = mpm_body_totals(&w, wall ? 0 : order).momentum[2] / unit;
    r.contact = w.ledger.contact / before;
    r.walls = w.ledger.walls / before;
    r.missed = (t.kinetic + t.internal) / before + r.contact + r.walls - 1;
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return r;
}

static void bars_meet(void)
{
    static const double offset[3] = {0, 0.3, 0.5}, factor[3] = {0.05, 0.1, 0.2};
    double low = 9, high = 0;
    int k;
    for (k = 0; k < 3; k++) {
        const result r = bars(0, offset[k], 50, 0.1, 0, 0), again = bars(0, offset[k], 50, 0.1, 1, 0);
        printf("# bars, grid moved by %.1f: %.4f of the speed back, contact took %.4f, missed %.4f\n", offset[k],
               r.speed, r.contact, r.missed);
        low = fmin(low, r.speed);
        high = fmax(high, r.speed);
        CHECK_NEAR("bars: momentum", r.momentum, 0, 1e4 * eps);
        CHECK_NEAR("... energy", r.missed, 0, 0.005);
        CHECK_NEAR("... none lost in contact without a damper", r.contact, 0, 0.01);
        CHECK_TRUE("... back with 0.9 of the speed", r.speed > 0.9 && r.speed <= 1);
        CHECK_NEAR("... however they are numbered", again.speed, r.speed, 1e6 * eps);
    }
    CHECK_NEAR("bars: wherever the grid lies", high - low, 0, 0.02);
    for (k = 0; k < 3; k++) {
        const result r = bars(1, 0, 50, factor[k], 0, 0);
        printf("# bar on a wall, dt %.2f: %.4f of the speed back, walls took %.4f, missed %.4f\n", factor[k], r.speed,
               r.walls, r.missed);
        CHECK_TRUE("bar on a wall: back with 0.9 of the speed", r.speed > 0.9 && r.speed <= 1);
        CHECK_NEAR("... energy", r.missed, 0, 0.01);
    }
    CHECK_TRUE("a damper takes energy", bars(0, 0, 50, 0.1, 0, 1).contact > 0.05);
}

/* ---- spheres, planes, stacks ------------------------------------------------------------------ */

/* An elastic sphere on its like or on a wall, beside Hertz: largest force (a mean that fades within a fiftieth of the
   contact) and duration over his, speed that comes back; his greatest contact radius over the sphere's. */
static double hertz(int wall, int cells, double v, double factor, double *force, double *duration, double *back)
{
    const mpm_real floor[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    const double R = 10, cell = R / cells, high = R * 1.0005;
    mpm_desc d = scene_grid(cell, cells + 4, 1, (int)(4.2 * cells) + 4, 0, 0, -2.1 * R);
    mpm_surfaces s = mpm_surfaces_default();
    const double reduced = (double)metal.young / (1 - (double)(metal.poisson * metal.poisson)) / (wall ? 1 : 2);
    double mass, most, time, radius, mean = 0, first = -1, last = 0;
    mpm_real dt;
    mpm_world w;
    int32_t k;
    d.geometry = MPM_AXISYMMETRIC;
    d.basis = MPM_CUBIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    s.damping = 0;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < (wall ? 1 : 2); k++) {
        const mpm_shape ball = mpm_sphere(0, 0, (mpm_real)(k ? -high : high), (mpm_real)R);
        mpm_body_desc b = scene_body(&metal, ball, cell / 2, k ? v : -v);
        mpm_body_add(&w, &b);
        mpm_surface_add(&s, &w, k);
    }
    if (wall) mpm_surface_wall_add(&s, floor, up);
    mass = mpm_body_totals(&w, 0).mass / (wall ? 1 : 2);
    time = pow(15 * mass * v * v * (wall ? 1 : 4) / (16 * reduced * sqrt(wall ? R : R / 2)), 0.4); /* approach */
    radius = sqrt(time * (wall ? R : R / 2)) / R;
    most = 4.0 / 3 * reduced * sqrt(wall ? R : R / 2) * pow(time, 1.5);
    time *= 2.94327 / (v * (wall ? 1 : 2));
    dt = mpm_time_step(&w, (mpm_real)factor);
    *force = 0;
    while ((double)w.time < 1.2 * time) {
        const double before = mpm_body_totals(&w, 0).momentum[2];
        double now;
        if (mpm_surface_step(&s, &w, dt) < 0) break;
        now = (mpm_body_totals(&w, 0).momentum[2] - before) / (double)dt;
        mean += (now - mean) * (double)dt / (time / 50);
        *force = fmax(*force, mean / most);
        if (now > 1e-3 * most) last = (double)w.time;
        if (now > 1e-3 * most && first < 0) first = (double)w.time;
    }
    *duration = (last - first) / time;
    *back = mpm_body_totals(&w, 0).momentum[2] / (v * mpm_body_totals(&w, 0).mass);
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return radius;
}

/* Beside the sphere of finite size (sphere.h), which is stiffer than Hertz's by kappa a/R: the more cells in the
   contact radius, the nearer. */
static void spheres(void)
{
    static const struct {
        int wall, cells;
        double speed, dt, within;
    } row[3] = {{0, 14, 20, 0.1, 0.03}, {1, 14, 20, 0.1, 0.03}, {0, 28, 5, 0.3, 0.02}};
    int k;
    for (k = 0; k < 3; k++) {
        double force, duration, back, want_force, want_duration;
        const double a = hertz(row[k].wall, row[k].cells, row[k].speed, row[k].dt, &force, &duration, &back);
        sphere_impact((double)metal.poisson, a, &want_force, &want_duration);
        printf("# sphere on a %s at %g m/s, %.1f cells in the contact radius: force %.4f, duration %.4f of Hertz's, "
               "which a finite sphere has %.4f and %.4f of; %.4f of the speed\n", row[k].wall ? "wall" : "sphere",
               row[k].speed, a * row[k].cells, force, duration, want_force, want_duration, back);
        CHECK_RELATIVE("a sphere: force", force, want_force, row[k].within);
        CHECK_RELATIVE("... duration", duration, want_duration, row[k].within);
        CHECK_TRUE("... speed", back > 0.98 && back <= 1);
    }
}

/* A block on a rigid incline of 30 degrees, pulled down by gravity: it stays or slides as Coulomb says. */
static void incline(double mu)
{
    const double angle = pi / 6, g = 1e4, end = 0.02;
    const mpm_real point[3] = {0, 0, 0}, normal[3] = {0, 0, 1};
    mpm_desc d = scene_grid(1, 20, 1, 8, -8, 0, -2);
    mpm_body_desc b = scene_body(&metal, mpm_box(-3, 0, 0, 3, 1, 3), 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    const double want = fmax(0, g * (sin(angle) - mu * cos(angle)) * end);
    char line[120];
    mpm_totals t;
    mpm_world w;
    mpm_real dt;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    d.gravity[0] = (mpm_real)(g * sin(angle));
    d.gravity[2] = (mpm_real)(-g * cos(angle));
    s.friction = (mpm_real)mu;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    mpm_surface_add(&s, &w, 0);
    mpm_surface_wall_add(&s, point, normal);
    dt = mpm_time_step(&w, MPM_R(0.2));
    while ((double)w.time < end)
        if (mpm_surface_step(&s, &w, dt) < 0) break;
    t = mpm_body_totals(&w, 0);
    snprintf(line, sizeof line, "incline, mu = %g: speed down it", mu);
    CHECK_NEAR(line, t.momentum[0] / t.mass, want, 0.02 * g * sin(angle) * end);
    CHECK_NEAR("... and none off it", t.momentum[2] / t.mass, 0, 0.02 * g * cos(angle) * end);
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

/* A block falls on two others that lie close to a wall, added in one of three orders: velocities after. */
static void stack(int order, double *v)
{
    static const int place[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}}; /* of the k-th body added */
    mpm_desc d = scene_grid(1, 12, 1, 18, -6, 0, -1);
    const mpm_real point[3] = {0, 0, 0}, normal[3] = {0, 0, 1};
    mpm_surfaces s = mpm_surfaces_default();
    mpm_world w;
    mpm_real dt;
    int32_t k;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 3; k++) {
        const int high = place[order][k];
        const mpm_real z = (mpm_real)(0.02 + 4.02 * high), half = high == 1 ? 3 : 2;
        mpm_body_desc b = scene_body(&metal, mpm_box(-half, 0, z, half, 1, z + 4), 0.5, high == 2 ? -50 : 0);
        mpm_body_add(&w, &b);
        mpm_surface_add(&s, &w, k);
    }
    mpm_surface_wall_add(&s, point, normal);
    dt = mpm_time_step(&w, MPM_R(0.1));
    while ((double)w.time < 0.006)
        if (mpm_surface_step(&s, &w, dt) < 0) break;
    for (k = 0; k < 3; k++) {
        const mpm_totals t = mpm_body_totals(&w, k);
        v[place[order][k]] = t.momentum[2] / t.mass;
    }
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

static void stacks(void)
{
    double v[3][3], apart = 0;
    int order, k;
    for (order = 0; order < 3; order++) stack(order, v[order]);
    for (order = 1; order < 3; order++)
        for (k = 0; k < 3; k++) apart = check_worst(apart, fabs(v[order][k] - v[0][k]) / 50);
    printf("# a stack of three: %.3f, %.3f, %.3f m/s\n", v[0][0], v[0][1], v[0][2]);
    CHECK_NEAR("three bodies: however they are numbered", apart, 0, 1e7 * eps);
    CHECK_TRUE("... each moves", fabs(v[0][0]) > 0.1 && fabs(v[0][1]) > 0.1);
}

/* ---- adhesion ---------------------------------------------------------------------------------- */

/* Two blocks of two cells' width, pressed together at 5 m/s while the plastic work of all points rises to w, then drawn
   apart at 10 m/s each, rigidly: what the bond took, over the area, and the largest pull. */
static void drawn(double work, double critical, double *energy, double *pull, double *dissipated)
{
    mpm_desc d = scene_grid(1, 2, 1, 12, 0, 0, -6);
    mpm_surfaces s = mpm_surfaces_default();
    double before, most;
    mpm_world w;
    int32_t k, i;
    int n;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_CUBIC;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    s.adhesion = 40;
    s.critical = (mpm_real)critical;
    s.depth = MPM_R(1.5);
    s.reach = MPM_R(0.2);
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 2; k++) {
        const mpm_real low = k ? -3 : MPM_R(0.001);
        mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, low, 2, 1, low + 3), 0.5, k ? 5 : -5);
        b.stress = NULL;
        mpm_body_add(&w, &b);
        CHECK_EQUAL("a block's outline and layer", mpm_surface_add(&s, &w, k), MPM_OK);
    }
    for (n = 0; n < 40; n++) {
        for (i = 0; i < w.points.count; i++) w.points.plastic_work[i] = (mpm_real)(n < 20 ? 0 : work);
        if (mpm_surface_step(&s, &w, MPM_R(1e-5)) < 0) break;
    }
    *dissipated = mpm_surface_meets(&s, &w, 0, 1).dissipated;
    for (most = 0, i = 0; i < s.surface[0].markers; i++)
        most = fmax(most, (double)mpm_surface_adhesion(&s, &s.surface[0].marker[i].meet[0]));
    CHECK_NEAR("... of a marker: W0 (G/G_c - 1) or none", most, fmax(0, 40 * (*dissipated / critical - 1)), 1e6 * eps);
    before = w.ledger.hold;
    *pull = 0;
    for (n = 0; n < 1500; n++) {
        mpm_meeting m;
        for (i = 0; i < w.points.count; i++) w.points.v[2][i] = i < w.body[1].first ? 10 : -10;
        if (mpm_surface_step(&s, &w, MPM_R(1e-5)) < 0) break;
        m = mpm_surface_meets(&s, &w, 0, 1);
        *pull = fmax(*pull, -m.pull[2]);
    }
    *energy = (w.ledger.hold - before) / 2;
    CHECK_EQUAL("... spent at last", mpm_surface_meets(&s, &w, 0, 1).bonded > 0, 0);
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

/* A layer's means know no point of a thin body's other face, are right where plastic work grows evenly, and know what
   lies behind a mirror. */
static void layers(void)
{
    mpm_desc d = scene_grid(1, 10, 1, 20, 0, 0, -10);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(0, 0, 5, 3), 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    const mpm_layer *y;
    double worst = 0, weight = 0, at_mirror = 0;
    int32_t k, i;
    mpm_world w;
    d.geometry = MPM_PLANE_STRAIN;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    s.adhesion = s.critical = 1;
    s.depth = MPM_R(1.5);
    s.reach = MPM_R(0.2);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    b.shape = mpm_sphere(5, 0, -5, 3);
    mpm_body_add(&w, &b);
    b.shape = mpm_box(0, 0, -1, 10, 1, 1);
    mpm_body_add(&w, &b);
    for (k = 0; k < 3; k++) CHECK_EQUAL("a layer", mpm_surface_add(&s, &w, k), MPM_OK);
    y = &s.surface[2].layer;
    for (k = 0; k < y->markers; k++) {
        const int up = s.surface[2].marker[k].x[2] > 0;
        for (i = y->begin[k]; i < y->begin[k + 1]; i++) {
            const int32_t at = w.body[2].first + y->point[i];
            weight += (double)y->weight[i];
            if ((double)w.points.x[2][at] * (up ? 1 : -1) < -0.5) worst = check_worst(worst, (double)y->weight[i]);
        }
    }
    CHECK_RELATIVE("a slab's: weights sum to 1 at every marker", weight, y->markers, 1e3 * eps);
    CHECK_NEAR("... points of the other face have none", worst, 0, 0);
    for (i = 0; i < w.points.count; i++) w.points.plastic_work[i] = w.points.x[0][i]; /* grows to the right */
    for (k = 0; k < 5; k++) CHECK_EQUAL("... a step", mpm_surface_step(&s, &w, MPM_R(1e-9)), MPM_OK);
    for (i = 0; i < s.surface[2].markers; i++) {
        const mpm_marker *m = &s.surface[2].marker[i];
        const double x = (double)m->x[0];
        if (x > 1.6 && x < 8.4) worst = check_worst(worst, (double)y->mean[i] - x);
        if (x == 0) at_mirror = (double)y->mean[i];
    }
    CHECK_NEAR("... means of what grows evenly", worst, 0, 0.03);
    CHECK_NEAR("... at a mirror: |x| with weight (1 - q)^2 (1 + 2 q), 3/20 l/(1/2)", at_mirror, 0.3 * 1.5, 0.03);
    mpm_surfaces_free(&s);
    s = mpm_surfaces_default();
    CHECK_EQUAL("a surface without a layer", mpm_surface_add(&s, &w, 0), MPM_OK);
    CHECK_EQUAL("... and another", mpm_surface_add(&s, &w, 1), MPM_OK);
    s.adhesion = s.critical = s.depth = s.reach = 1;
    CHECK_EQUAL("... has no share in G", mpm_surface_step(&s, &w, MPM_R(1e-5)), MPM_OK);
    s.renew = 0;
    CHECK_EQUAL("a parameter spoilt later", mpm_surface_step(&s, &w, MPM_R(1e-5)), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(w.fault.field, "renew"));
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

/* G = l (w + w) = 3 w; W = W0 (G/G_c - 1); at most 2 W/delta_c. */
static void adhesion(void)
{
    double energy, pull, G;
    drawn(1000, 2000, &energy, &pull, &G);
    CHECK_RELATIVE("adhesion: G of two layers [J/m2]", G, 3000, 1e5 * eps);
    CHECK_RELATIVE("... takes W0 (G/G_c - 1) [J/m2]", energy, 20, 0.03);
    CHECK_RELATIVE("... at most 2 W/delta_c on the area [uN]", pull, 2 * 200, 0.03);
    drawn(500, 2000, &energy, &pull, &G);
    CHECK_NEAR("below G_c there is none", energy + pull, 0, 1e5 * eps);
}

int main(void)
{
    metal = scene_metal(1, mpm_units_um_us_ng());
    outlines();
    refusals();
    stretched(MPM_LINEAR);
    stretched(MPM_CUBIC);
    bars_meet();
    spheres();
    incline(0);
    incline(0.3);
    incline(0.7);
    stacks();
    layers();
    adhesion();
    return check_end();
}
