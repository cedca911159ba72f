/* 25_contact - when and in which direction bodies touch: normals by logistic regression, separation,
   nodes too light for contact. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

static const double eps = (double)MPM_EPSILON;

/* Two bodies in a world, their contact found. */
static void meet(mpm_world *w, const mpm_desc *d, const mpm_body_desc *a, const mpm_body_desc *b)
{
    CHECK_EQUAL("a world of two bodies", mpm_init(w, d, NULL, 0), MPM_OK);
    CHECK_EQUAL("... the first", mpm_body_add(w, a), MPM_OK);
    CHECK_EQUAL("... the second", mpm_body_add(w, b), MPM_OK);
    mpm_locate(w, MPM_R(1e-5));
    mpm_p2g(w);
    mpm_contact_find(w);
}

/* Mean angle in degrees between the normals found at the nodes of two spheres and the line of their
   centres, over twelve directions and grid positions. */
static double angle(mpm_basis basis, mpm_normal_rule rule)
{
    const double R = 4;
    double sum = 0;
    long n = 0;
    int k;
    for (k = 0; k < 12; k++) {
        mpm_material m = scene_metal(1, mpm_units_um_us_ng());
        const double t = 0.3 + 0.21 * k, f = 0.5 * k;
        const double x = sin(t) * cos(f), y = sin(t) * sin(f), z = cos(t);
        mpm_desc d = scene_grid(1, 24, 24, 24, -12 + 0.083 * k, -12 + 0.05 * k, -12 - 0.03 * k);
        const mpm_real cx = (mpm_real)(R * x), cy = (mpm_real)(R * y), cz = (mpm_real)(R * z);
        mpm_body_desc a = scene_body(&m, mpm_sphere(-cx, -cy, -cz, 4), 0.5, 0);
        mpm_body_desc b = scene_body(&m, mpm_sphere(cx, cy, cz, 4), 0.5, 0);
        mpm_world w;
        int32_t i;
        d.basis = basis;
        d.contact.normal = rule;
        meet(&w, &d, &a, &b);
        for (i = 0; i < w.pairs; i++, n++) {
            const mpm_real *q = w.pair[i].normal;
            const double along = (double)q[0] * x + (double)q[1] * y + (double)q[2] * z;
            sum += acos(along > 1 ? 1 : along) * 57.29578;
        }
        mpm_free(&w);
    }
    return n > 100 ? sum / (double)n : 180;
}

/* The sphere is a lattice: a plane can follow it to some ten degrees. */
static void logistic(void)
{
    const double linear = angle(MPM_LINEAR, MPM_NORMAL_LOGISTIC), gimp = angle(MPM_GIMP, MPM_NORMAL_LOGISTIC);
    CHECK_NEAR("logistic normal: degrees off the line of centres, linear", linear, 0, 13);
    CHECK_NEAR("logistic normal: degrees off the line of centres, GIMP", gimp, 0, 13);
    CHECK_TRUE("logistic normal: half the error of the gradient's", 2 * linear < angle(MPM_LINEAR, MPM_NORMAL_RANKED));
}

/* Flat faces: the plane is exact, also in the quarter and where a body is only a corner. */
static void flat_faces(mpm_geometry geometry, mpm_basis basis, const char *name)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 20, 0, 0, -10);
    mpm_body_desc top = scene_body(&m, mpm_box(-3, -3, 0, 3, 3, 4), 0.5, -10);
    mpm_body_desc low = scene_body(&m, mpm_box(-5, -5, -4, 5, 5, 0), 0.5, 0);
    mpm_world w;
    int32_t i;
    double tilt = 0, gap = 0;
    int covered = 0;
    char line[100];
    d.geometry = geometry;
    d.basis = basis;
    d.contact.normal = MPM_NORMAL_LOGISTIC;
    d.contact.touch = 1;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    meet(&w, &d, &top, &low);
    for (i = 0; i < w.pairs; i++) {
        const int32_t index = w.node[w.pair[i].a].index, nx = w.nodes_per_axis[0], ny = w.nodes_per_axis[1];
        const double t = 1 + (double)w.pair[i].normal[2], g = fabs((double)w.pair[i].separation);
        if (index % nx - w.ghost > 1 || (ny > 1 && index / nx % ny - w.ghost > 1)) continue; /* covers it */
        covered++;
        tilt = check_worst(tilt, t);
        gap = check_worst(gap, g);
    }
    snprintf(line, sizeof line, "flat faces, %s: normals where the top covers the node", name);
    CHECK_NEAR(line, tilt, 0, 1e4 * eps);
    CHECK_TRUE("flat faces: pairs", covered > 1);
    CHECK_NEAR("flat faces: faces that touch are separated by nothing", gap, 0, 100 * eps);
    mpm_free(&w);
}

/* A block crosses a gap and meets a block: returns when the velocity first changes. */
static double touch(int separation, double gap)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 4, 4, 24, 0, 0, MPM_R(-11.5));
    mpm_body_desc top = scene_body(&m, mpm_box(0, 0, (mpm_real)gap, 4, 4, (mpm_real)(gap + 4)), 0.5, -20);
    mpm_body_desc low = scene_body(&m, mpm_box(0, 0, -4, 4, 4, 0), 0.5, 0);
    mpm_world w;
    int s;
    double when;
    d.contact.touch = separation;
    for (s = 0; s < 4; s++) d.side[s] = MPM_SIDE_SYMMETRY;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &top);
    mpm_body_add(&w, &low);
    while (w.time < 0.2 && mpm_body_totals(&w, 1).momentum[2] > -1e-6 * mpm_body_totals(&w, 0).mass)
        if (scene_step(&w, NULL, MPM_R(2e-5)) < 0) break;
    when = (double)w.time;
    mpm_free(&w);
    return when;
}

static void separation(void)
{
    CHECK_NEAR("separation: bodies touch when the gap has closed", touch(1, 1.5), 1.5 / 20, 0.02 / 20);
    CHECK_TRUE("without it they feel each other almost a cell early", touch(0, 1.5) < 0.9 / 20);
}

/* A point that reaches a node with a hair's breadth must not be in contact there. */
static void light_nodes(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 6, 6, 12, 0, 0, -6);
    mpm_body_desc top = scene_body(&m, mpm_box(1, 1, MPM_R(0.7501), 3, 3, MPM_R(2.7501)), 0.5, 0);    /* from 1.0001 */
    mpm_body_desc low = scene_body(&m, mpm_box(1, 1, MPM_R(-1.7499), 3, 3, MPM_R(0.2501)), 0.5, 0); /* to 0.0001 */
    mpm_world w;
    int k;
    for (k = 0; k < 2; k++) {
        d.contact.cutoff = k ? 0 : MPM_R(1e-3);
        meet(&w, &d, &top, &low);
        if (k) CHECK_TRUE("light nodes: without a cutoff they have contact", w.pairs > 0);
        else CHECK_EQUAL("light nodes: below the cutoff they have none", w.pairs, 0);
        mpm_free(&w);
    }
}

int main(void)
{
    logistic();
    flat_faces(MPM_3D, MPM_LINEAR, "3D linear");
    flat_faces(MPM_3D, MPM_GIMP, "3D GIMP");
    flat_faces(MPM_AXISYMMETRIC, MPM_LINEAR, "axisymmetric linear");
    flat_faces(MPM_AXISYMMETRIC, MPM_GIMP, "axisymmetric GIMP");
    separation();
    light_nodes();
    return check_end();
}
