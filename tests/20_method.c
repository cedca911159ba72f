/* 20_method - the step against what must be conserved and what waves must do.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

#include <string.h>

static const double eps = (double)MPM_EPSILON;

static double worst_stress(const mpm_world *w)
{
    double worst = 0;
    int32_t i;
    int c;
    for (i = 0; i < w->points.count; i++)
        for (c = 0; c < 6; c++)
            if (fabs((double)w->points.stress[c][i]) > worst) worst = fabs((double)w->points.stress[c][i]);
    return worst;
}

/* A sphere that nothing acts on crosses the grid as it was. */
static void free_flight(mpm_basis basis, const char *name)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 12, 12, 20, 0, 0, 0);
    mpm_body_desc b = scene_body(&m, mpm_sphere(4, 5, 15, 2), 0.5, -810);
    mpm_totals t0, t1;
    mpm_world w;
    char line[120];
    int i;
    b.velocity[0] = 300;
    d.basis = basis;
    CHECK_EQUAL(name, mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("free flight: body", mpm_body_add(&w, &b), MPM_OK);
    t0 = mpm_body_totals(&w, -1);
    for (i = 0; i < 200; i++) mpm_step(&w, MPM_R(5e-5));
    t1 = mpm_body_totals(&w, -1);
    snprintf(line, sizeof line, "free flight, %s: mass", name);
    CHECK_NEAR(line, t1.mass, t0.mass, 0);
    CHECK_RELATIVE("free flight: momentum", t1.momentum[2], t0.momentum[2], 100 * eps);
    CHECK_RELATIVE("free flight: kinetic energy", t1.kinetic, t0.kinetic, 200 * eps);
    CHECK_NEAR("free flight: distance", t1.low[2] - t0.low[2], -810 * 200 * 5e-5, 1e5 * eps);
    CHECK_NEAR("free flight: stress over E", worst_stress(&w) / (double)m.young, 0, 2000 * eps);
    mpm_free(&w);
}

/* Surface points exactly on grid planes: their far node carries nothing else. */
static void on_planes(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 20, 0, 0, 0);
    mpm_body_desc b = scene_body(&m, mpm_box(MPM_R(2.75), MPM_R(2.75), 12, MPM_R(5.25), MPM_R(5.25), 15), 0.5, -810);
    mpm_world w;
    int i;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_NEAR("on grid planes: so they are", mpm_body_totals(&w, -1).high[0], 5, 0);
    for (i = 0; i < 100; i++) mpm_step(&w, MPM_R(2e-5));
    CHECK_NEAR("on grid planes: stress over E", worst_stress(&w) / (double)m.young, 0, 2e4 * eps);
    mpm_free(&w);
}

/* A velocity field of rigid rotation on the nodes turns the stress and keeps its invariants. */
static void spin(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 10, -5, -5, -5);
    mpm_body_desc b = scene_body(&m, mpm_sphere(0, 0, 0, 2), 0.5, 0);
    const double omega = 2 * 3.14159265358979 / 1000;
    mpm_world w;
    int32_t i;
    int n;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    for (i = 0; i < w.points.count; i++) {
        w.points.stress[0][i] = 100;
        w.points.stress[1][i] = -100;
    }
    for (n = 0; n < 125; n++) { /* an eighth of a revolution about z, counter-clockwise */
        mpm_locate(&w, MPM_R(1.0));
        mpm_p2g(&w);
        for (i = 0; i < w.nodes; i++) {
            mpm_node *node = &w.node[i];
            const int32_t ix = node->index % w.nodes_per_axis[0],
                          iy = node->index / w.nodes_per_axis[0] % w.nodes_per_axis[1];
            const double x = -5.0 + ix, y = -5.0 + iy;
            node->velocity[0] = (mpm_real)(-omega * y);
            node->velocity[1] = (mpm_real)(omega * x);
            node->momentum[0] = node->mass * node->velocity[0];
            node->momentum[1] = node->mass * node->velocity[1];
        }
        mpm_stress(&w);
        mpm_move(&w);
    }
    i = w.points.count / 2;
    CHECK_NEAR("spin: xx after an eighth of a turn", w.points.stress[0][i], 0, 0.01);
    CHECK_NEAR("spin: xy after an eighth of a turn", w.points.stress[5][i], 100, 0.01);
    CHECK_NEAR("spin: second invariant",
               w.points.stress[0][i] * w.points.stress[0][i] + w.points.stress[5][i] * w.points.stress[5][i], 1e4,
               1e4 * 1e4 * eps);
    mpm_free(&w);
}

/* A pressure pulse going down a column between sliding walls (uniaxial strain). Returns the energy
   left at the end over that at the start; *speed gets the speed of the pulse, from its centroid. */
static double pulse(mpm_basis basis, double a, double duration, double *speed)
{
    const double length = 120, width = 30, v0 = 1, dt = 0.2 / 6198;
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 2, 2, 140, 0, 0, -5);
    mpm_body_desc b = scene_body(&m, mpm_box(0, 0, 0, 2, 2, (mpm_real)length), 0.5, 0);
    double centroid[2] = {0, 0}, at[2] = {0, 0}, e0, e1;
    long n, steps = (long)(duration / 6198 / dt);
    mpm_totals t;
    mpm_world w;
    int32_t i;
    int s;
    d.basis = basis;
    for (s = 0; s < 4; s++) d.side[s] = MPM_SIDE_SYMMETRY;
    b.absorb = MPM_FACE_BOTTOM;
    b.absorb_normal = (mpm_real)a;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    for (i = 0; i < w.points.count; i++) {
        const double z = ((double)w.points.x[2][i] - 60) / width;
        const double c = sin(3.14159265358979 * z), v = fabs(z) < 0.5 ? v0 * (1 - c * c) : 0;
        w.points.v[2][i] = (mpm_real)-v;
        w.points.stress[2][i] = (mpm_real)(-(double)b.density * (double)b.wave_p * v);
        w.points.stress[0][i] = w.points.stress[1][i] = w.points.stress[2][i] * m.poisson / (1 - m.poisson);
        /* the equation of state is read from the density: compress accordingly */
        w.points.density[i] = (mpm_real)((double)b.density * (1 + v / (double)b.wave_p));
    }
    e0 = mpm_body_totals(&w, -1).kinetic;
    for (n = 0; n < steps; n++) {
        if (n == steps / 10 || n == steps / 3) {
            double sum = 0, moment = 0;
            for (i = 0; i < w.points.count; i++) {
                const double v2 = (double)w.points.v[2][i] * (double)w.points.v[2][i];
                sum += v2;
                moment += v2 * (double)w.points.x[2][i];
            }
            centroid[n > steps / 10] = moment / sum;
            at[n > steps / 10] = (double)w.time;
        }
        if (scene_step(&w, NULL, (mpm_real)dt) < 0) break;
    }
    if (speed) *speed = (centroid[0] - centroid[1]) / (at[1] - at[0]);
    t = mpm_body_totals(&w, -1);
    e1 = t.kinetic; /* of a single travelling pulse: half of its energy, as at the start */
    mpm_free(&w);
    return e1 / e0;
}

static void waves(void)
{
    const double c = (double)mpm_wave_speed_p(70000, MPM_R(0.33), MPM_R(0.0027));
    double speed, left;
    left = pulse(MPM_LINEAR, 1, 105, &speed);
    CHECK_RELATIVE("P wave: speed, linear", speed, c, 0.01);
    CHECK_NEAR("damper: energy reflected at normal incidence, linear", left, 0, 0.05);
    left = pulse(MPM_GIMP, 1, 105, &speed);
    CHECK_RELATIVE("P wave: speed, GIMP", speed, c, 0.01);
    CHECK_NEAR("damper: energy reflected at normal incidence, GIMP", left, 0, 0.05);
    left = pulse(MPM_LINEAR, 0.5, 105, &speed); /* R = (1 - a)/(1 + a) = 1/3, energy 1/9 */
    CHECK_NEAR("damper: half the impedance reflects 1/9 of the energy", left, 1.0 / 9, 0.02);
}

/* Two spheres with every surface point's D preset. Returns relative velocity after over before. */
static double collide(double preset, double *momentum, double *energy, double *distance)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_units u = mpm_units_um_us_ng();
    mpm_desc d = scene_grid(1.25, 8, 8, 24, 0, 0, -15);
    mpm_body_desc top = scene_body(&m, mpm_sphere(0, 0, 5, 5), 0.625, -20);
    mpm_body_desc low = scene_body(&m, mpm_sphere(0, 0, -5, 5), 0.625, 20);
    mpm_bond bond = mpm_bond_default(&u);
    mpm_totals t0, t1;
    mpm_world w;
    double before, after;
    int32_t i;
    int n;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    bond.rule = MPM_BOND_NONE;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &top);
    mpm_body_add(&w, &low);
    for (i = 0; i < w.points.count; i++)
        if (w.points.flags[i] & MPM_POINT_SURFACE) w.points.bond[i] = (mpm_real)preset;
    t0 = mpm_body_totals(&w, -1);
    before = mpm_body_totals(&w, 0).momentum[2] - mpm_body_totals(&w, 1).momentum[2];
    for (n = 0; n < 6000; n++)
        if (scene_step(&w, &bond, MPM_R(2e-5)) < 0) return -9;
    t1 = mpm_body_totals(&w, -1);
    after = mpm_body_totals(&w, 0).momentum[2] - mpm_body_totals(&w, 1).momentum[2];
    *momentum = (t1.momentum[2] - t0.momentum[2]) / before;
    *energy = (t1.kinetic + t1.internal + w.ledger.contact + w.ledger.hold - t0.kinetic) / t0.kinetic;
    *distance = (mpm_body_totals(&w, 0).low[2] - mpm_body_totals(&w, 1).high[2]) / 5;
    mpm_free(&w);
    return -after / before;
}

static void collisions(void)
{
    double p, e, gap, r = collide(0, &p, &e, &gap);
    CHECK_TRUE("elastic spheres separate with a restitution above 0.9", r > 0.9 && r <= 1);
    CHECK_TRUE("elastic spheres: a gap opens", gap > 0.3);
    CHECK_NEAR("elastic spheres: momentum", p, 0, 5000 * eps);
    CHECK_NEAR("elastic spheres: energy with contact loss counted", e, 0, 0.01);
    r = collide(1, &p, &e, &gap); /* undamped, they go on vibrating: together means no gap */
    CHECK_NEAR("fully bonded spheres stay together: gap over radius", gap, 0.1, 0.05);
    CHECK_NEAR("fully bonded spheres: momentum", p, 0, 5000 * eps);
}

/* Centre of mass along an axis, times the mass. */
static double moment(const mpm_world *w, int axis)
{
    double sum = 0;
    int32_t i;
    for (i = 0; i < w->points.count; i++) sum += (double)w->points.mass[i] * (double)w->points.x[axis][i];
    return sum;
}

/* Three bodies meet at the same nodes, with friction, off centre: nothing may come from nowhere. */
static void three_bodies(mpm_contact_law law, const char *name)
{
    mpm_material m = scene_metal(0, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 12, 12, 12, -6, -6, -6);
    mpm_body_desc a = scene_body(&m, mpm_sphere(-2, 0, MPM_R(0.3), MPM_R(1.9)), 0.5, 0);
    mpm_body_desc b = scene_body(&m, mpm_sphere(2, MPM_R(0.2), 0, MPM_R(1.9)), 0.5, 0);
    mpm_body_desc c = scene_body(&m, mpm_sphere(0, 0, MPM_R(3.5), MPM_R(1.9)), 0.5, -300);
    mpm_totals t0, t1;
    mpm_world w;
    double scale;
    double start[3];
    int n, k, meeting = 0;
    char line[100];
    a.velocity[0] = 300;
    b.velocity[0] = -250;
    d.contact.law = law;
    d.contact.friction = MPM_R(0.3);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &a);
    mpm_body_add(&w, &b);
    mpm_body_add(&w, &c);
    t0 = mpm_body_totals(&w, -1);
    scale = mpm_body_totals(&w, 0).mass * 300;
    for (k = 0; k < 3; k++) start[k] = moment(&w, k);
    for (n = 0; n < 250; n++) {
        if (scene_step(&w, NULL, MPM_R(2e-5)) < 0) break;
        if (w.pairs > 2) meeting = 1;
    }
    t1 = mpm_body_totals(&w, -1);
    snprintf(line, sizeof line, "three bodies, %s: they meet", name);
    CHECK_TRUE(line, meeting && n == 250);
    for (k = 0; k < 3; k++)
        CHECK_NEAR("three bodies: momentum", (t1.momentum[k] - t0.momentum[k]) / scale, 0, 2000 * eps);
    for (k = 0; k < 3; k++)
        CHECK_NEAR("three bodies: the centre of mass moves with the momentum",
                   (moment(&w, k) - start[k] - t0.momentum[k] * (double)w.time) / (scale * (double)w.time), 0,
                   2e4 * eps);
    CHECK_NEAR("three bodies: mass", t1.mass, t0.mass, 0);
    CHECK_NEAR("three bodies: energy with contact loss counted",
               (t1.kinetic + t1.internal + w.ledger.contact - t0.kinetic) / t0.kinetic, 0, 0.01);
    if (law == MPM_CONTACT_WELD) CHECK_NEAR("three bodies: a weld loses none", w.ledger.contact / t0.kinetic, 0, 0.002);
    else CHECK_TRUE("three bodies: contact loses energy", w.ledger.contact > 0.02 * t0.kinetic);
    mpm_free(&w);
}

/* The outward normal points out of the particle, into the substrate below. */
static void normals(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 12, -5, -5, -6);
    mpm_body_desc ball = scene_body(&m, mpm_sphere(0, 0, 2, 2), 0.5, -10);
    mpm_body_desc slab = scene_body(&m, mpm_box(-4, -4, -4, 4, 4, 0), 0.5, 0);
    mpm_normal_rule rule;
    for (rule = MPM_NORMAL_RANKED; rule <= MPM_NORMAL_LOGISTIC; rule = (mpm_normal_rule)(rule + 1)) {
        mpm_world w;
        int32_t i;
        int down = 1;
        d.contact.normal = rule;
        mpm_init(&w, &d, NULL, 0);
        mpm_body_add(&w, &ball);
        mpm_body_add(&w, &slab);
        mpm_locate(&w, 1);
        mpm_p2g(&w);
        mpm_contact_find(&w);
        for (i = 0; i < w.pairs; i++) {
            const mpm_real *n = w.pair[i].normal;
            down = down && n[2] < MPM_R(-0.5) && fabs((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1) < 8 * eps;
        }
        CHECK_TRUE("normals: unit, out of the ball, into the slab", down && w.pairs > 4);
        mpm_free(&w);
    }
}

/* The matrix that turns by an angle about a unit axis (Rodrigues), applied to a tensor: R s R^T, all in full. */
static void turned(const double *axis, double angle, const mpm_real s[6], double out[3][3])
{
    const double S[3][3] = {{(double)s[0], (double)s[5], (double)s[4]},
                            {(double)s[5], (double)s[1], (double)s[3]},
                            {(double)s[4], (double)s[3], (double)s[2]}};
    const double K[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
    double R[3][3];
    int i, j, k, l;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) {
            R[i][j] = (i == j ? cos(angle) : 0) + sin(angle) * K[i][j] + (1 - cos(angle)) * axis[i] * axis[j];
            out[i][j] = 0;
        }
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            for (k = 0; k < 3; k++)
                for (l = 0; l < 3; l++) out[i][j] += R[i][k] * S[k][l] * R[j][l];
}

/* mpm_rotate by an increment of 2 tan(angle/2) turns by the angle, however large, right-handed about its axis; and
   small ones add up. */
static void rotate(void)
{
    const double axis[3] = {2.0 / 7, -3.0 / 7, 6.0 / 7};
    const mpm_real start[6] = {3, -1, 2, MPM_R(0.5), MPM_R(-2.5), 1};
    const double angles[] = {1e-3, 0.3, 1.5, 3};
    double wanted[3][3], worst;
    mpm_real s[6], w[3];
    size_t k;
    int d, n;
    for (k = 0; k < sizeof angles / sizeof *angles; k++) {
        for (d = 0; d < 3; d++) w[d] = (mpm_real)(2 * tan(angles[k] / 2) * axis[d]);
        memcpy(s, start, sizeof s);
        mpm_rotate(w, s);
        turned(axis, angles[k], start, wanted);
        worst = fabs((double)s[0] - wanted[0][0]) + fabs((double)s[1] - wanted[1][1]) +
                fabs((double)s[2] - wanted[2][2]) + fabs((double)s[3] - wanted[1][2]) +
                fabs((double)s[4] - wanted[0][2]) + fabs((double)s[5] - wanted[0][1]);
        CHECK_NEAR("rotate: as the matrix of the angle does", worst, 0, 200 * eps);
    }
    memcpy(s, start, sizeof s);
    for (d = 0; d < 3; d++) w[d] = (mpm_real)(axis[d] * 1e-3);
    for (n = 0; n < 1000; n++) mpm_rotate(w, s);
    turned(axis, 1, start, wanted); /* each step falls short by angle^3/12 */
    CHECK_NEAR("rotate: a thousand small ones", s[0], wanted[0][0], 1e-6 + 1e4 * eps);
    CHECK_RELATIVE("... keep the trace", s[0] + s[1] + s[2], 4, 1e4 * eps);
}

int main(void)
{
    int basis;
    for (basis = 0; basis < MPM_BASES; basis++) free_flight((mpm_basis)basis, scene_basis((mpm_basis)basis));
    on_planes();
    spin();
    waves();
    collisions();
    three_bodies(MPM_CONTACT_FRICTION, "friction");
    three_bodies(MPM_CONTACT_STICK, "stick");
    three_bodies(MPM_CONTACT_WELD, "weld");
    normals();
    rotate();
    return check_end();
}
