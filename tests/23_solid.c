/* 23_solid - bodies as a whole: a bar that vibrates, many bodies at one node in any order, bodies welded
   into one. The long versions are in tests/verify. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

static const double eps = (double)MPM_EPSILON;

/* A bar of 25, held at its lower end, in its first mode: swings with pi c / 2 L, and its error falls with
   the square of the cell. Returns frequency over the exact one, minus 1. */
static double bar(mpm_basis basis, int cells)
{
    const double length = 25, cell = length / cells, pi = 3.14159265358979323846, dt = 0.02 * cell;
    mpm_material m = mpm_material_default();
    mpm_desc d = scene_grid(cell, cells + 2, 1, 1, 0, 0, 0);
    mpm_body_desc b;
    mpm_world w;
    double v = 0, old, first = 0, last = 0;
    int32_t i;
    int zeros = 0;
    m.density = 1;
    m.young = 100; /* c = 10 */
    m.shear_modulus = 50;
    b = scene_body(&m, mpm_box(0, 0, 0, (mpm_real)length, 1, (mpm_real)cell), cell / 2, 0);
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = basis;
    d.side[0] = MPM_SIDE_FIXED;
    d.side[4] = d.side[5] = MPM_SIDE_SYMMETRY;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    for (i = 0; i < w.points.count; i++)
        w.points.v[0][i] = (mpm_real)(0.05 * sin(pi * (double)w.points.x[0][i] / (2 * length)));
    while ((double)w.steps * dt < 30 && mpm_step(&w, (mpm_real)dt) >= 0) {
        old = v;
        v = mpm_body_totals(&w, -1).momentum[0];
        if (!(old * v < 0)) continue;
        last = (double)w.steps * dt - dt * v / (v - old);
        if (zeros++ == 0) first = last;
    }
    mpm_free(&w);
    return zeros > 1 ? (zeros - 1) / (last - first) * length * 2 / 10 - 1 : 1;
}

static void bars(mpm_basis basis, const char *name)
{
    const double coarse = bar(basis, 10), fine = bar(basis, 20);
    char line[100];
    snprintf(line, sizeof line, "bar, %s: frequency with 20 cells", name);
    CHECK_NEAR(line, fine, 0, 0.0021);
    CHECK_NEAR("bar: its error is of second order in the cell", coarse / fine, 4, 0.8);
}

/* Four balls fly into one corner, added in the given order. Each one's momentum changes by what its pairs
   gave it and nothing else, and what one gets the other loses. */
static void corner(const int *order, mpm_contact_law law, double *worst, double *total, int *most)
{
    static const mpm_real place[4][3] = {{-1, -1, -1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    mpm_material m = scene_metal(0, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 10, MPM_R(-4.9), MPM_R(-5.2), MPM_R(-5.1));
    mpm_totals t[4], all;
    mpm_world w;
    double scale = 0, sum[4][3];
    int32_t i;
    int n, k, a;
    d.contact.law = law;
    d.contact.friction = MPM_R(0.3);
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 4; k++) {
        const mpm_real *x = place[order[k]], r = MPM_R(1.2) + MPM_R(0.05) * (mpm_real)order[k];
        mpm_body_desc b = scene_body(&m, mpm_sphere(x[0], x[1], x[2], r), 0.5, 0);
        for (a = 0; a < 3; a++) b.velocity[a] = -(200 + 20 * (mpm_real)order[k]) * x[a];
        mpm_body_add(&w, &b);
        t[k] = mpm_body_totals(&w, k);
        scale += 200 * t[k].mass;
    }
    all = mpm_body_totals(&w, -1);
    for (n = 0; n < 40; n++) {
        memset(sum, 0, sizeof sum);
        if (scene_step(&w, NULL, MPM_R(5e-5)) < 0) break;
        for (i = 0; i < w.pairs; i++)
            for (a = 0; a < 3; a++) {
                sum[w.node[w.pair[i].a].body][a] += (double)w.pair[i].impulse[a];
                sum[w.node[w.pair[i].b].body][a] -= (double)w.pair[i].impulse[a];
            }
        for (k = 0; k < 4; k++) {
            const mpm_totals now = mpm_body_totals(&w, k);
            for (a = 0; a < 3; a++)
                *worst = check_worst(*worst, fabs(now.momentum[a] - t[k].momentum[a] - sum[k][a]) / scale);
            t[k] = now;
        }
        for (i = 0; i < w.pairs; i++) {
            int32_t s;
            int bodies = 0;
            if (!(fabs((double)w.pair[i].impulse[0]) > 0)) continue;
            for (s = w.head[w.node[w.pair[i].a].index]; s >= 0; s = w.node[s].next) bodies++;
            if (bodies > *most) *most = bodies;
        }
    }
    for (a = 0; a < 3; a++)
        *total = check_worst(*total, fabs(mpm_body_totals(&w, -1).momentum[a] - all.momentum[a]) / scale);
    if (n < 40) *worst = 1;
    mpm_free(&w);
}

static void corners(mpm_contact_law law, const char *name)
{
    double worst = 0, total = 0;
    int order[4], most = 0, n;
    char line[100];
    for (n = 0; n < 24; n++) { /* every order of the four */
        int k, j, code = n, left[4] = {0, 1, 2, 3};
        for (k = 0; k < 4; k++) {
            const int pick = code % (4 - k);
            code /= 4 - k;
            order[k] = left[pick];
            for (j = pick; j < 3 - k; j++) left[j] = left[j + 1];
        }
        corner(order, law, &worst, &total, &most);
    }
    snprintf(line, sizeof line, "four balls in 24 orders, %s: bodies in contact at one node", name);
    CHECK_EQUAL(line, most, 4);
    CHECK_NEAR("four balls: each one's momentum changes by its pairs' impulses", worst, 0, 100 * eps);
    CHECK_NEAR("four balls: momentum", total, 0, 1000 * eps);
}

/* Welded bodies have one velocity wherever both weigh anything, however little. */
static void weld(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 12, 6, 6, 0, -3, -3);
    mpm_body_desc a = scene_body(&m, mpm_sphere(MPM_R(4.2499), 0, 0, 2), 0.5, 0);
    mpm_body_desc b = scene_body(&m, mpm_sphere(MPM_R(8.25), 0, MPM_R(0.5), 2), 0.5, 0);
    mpm_world w;
    double worst = 0, least;
    int32_t i, other;
    int n, k, light = 0;
    a.velocity[0] = 20;
    b.velocity[0] = -20;
    d.contact.law = MPM_CONTACT_WELD;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &a);
    mpm_body_add(&w, &b);
    for (n = 0; n < 100 && scene_step(&w, NULL, MPM_R(2e-5)) >= 0; n++)
        for (i = 0; i < w.nodes; i++) {
            const mpm_node *p = &w.node[i], *q;
            if ((other = p->next) < 0) continue;
            q = &w.node[other];
            least = (double)((p->mass < q->mass ? p->mass : q->mass) / w.body[0].point_mass);
            if (!(least > 1e-6)) continue;
            if (least < 1e-3) light++;
            for (k = 0; k < 3; k++)
                worst = check_worst(worst, fabs((double)(p->momentum[k] / p->mass - q->momentum[k] / q->mass)) / 20);
        }
    CHECK_EQUAL("weld: steps", n, 100);
    CHECK_TRUE("weld: light nodes are met", light > 0);
    CHECK_NEAR("weld: difference of nodal velocities", worst, 0, 1e6 * eps);
    mpm_free(&w);
}

int main(void)
{
    int basis;
    for (basis = 0; basis < MPM_BASES; basis++) bars((mpm_basis)basis, scene_basis((mpm_basis)basis));
    corners(MPM_CONTACT_FRICTION, "friction");
    corners(MPM_CONTACT_STICK, "stick");
    corners(MPM_CONTACT_WELD, "weld");
    weld();
    return check_end();
}
