/* 30_bond - growth of D against the law, its limits, and the nodal averages.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

static const double eps = (double)MPM_EPSILON;

static void growth(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_bond b = mpm_bond_default(&u);
    const double gc = 1503.74, gdot = 2.271e5, dt = 8e-6;
    double x;
    CHECK_RELATIVE("G_c in J/m2 is G_c in um us ng", b.critical, gc, 8 * eps);
    CHECK_RELATIVE("Gdot_c in J/m2/us is Gdot_c in um us ng", b.critical_rate, gdot, 8 * eps);
    CHECK_NEAR("nothing dissipated adds nothing", mpm_bond_increment(&b, 0, (mpm_real)dt), 0, 0);
    CHECK_EQUAL("... and is no increment", b.increments, 0);
    for (x = 1e-4; x < 2; x *= 3) { /* below e: the law itself */
        const double dG = x * gdot * dt;
        CHECK_RELATIVE("D against A 4.16, 4.17", mpm_bond_increment(&b, (mpm_real)dG, (mpm_real)dt),
                       dG / (gc * (1 - log(x))), 64 * eps);
    }
    CHECK_EQUAL("the floor has not acted", b.floor_hits, 0);
    CHECK_RELATIVE("beyond e Gdot_c the floor acts", mpm_bond_increment(&b, (mpm_real)(3 * gdot * dt), (mpm_real)dt),
                   3 * gdot * dt / (gc * 0.05), 64 * eps);
    CHECK_EQUAL("... and is counted", b.floor_hits, 1);
    b.critical = -1;
    CHECK_EQUAL("a negative G_c is refused", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
}

/* A ball on a slab, D set by hand: the three averages (A 4.6, 4.7). */
static void averages(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 10, 10, 12, -5, -5, -6);
    mpm_bond b = mpm_bond_default(&u);
    mpm_bond_average a;
    mpm_body_desc ball = scene_body(&m, mpm_box(-2, -2, 0, 2, 2, 2), 0.5, -10);
    mpm_body_desc slab = scene_body(&m, mpm_box(-4, -4, -4, 4, 4, 0), 0.5, 0);
    mpm_world w;
    int32_t i;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &ball);
    mpm_body_add(&w, &slab);
    for (i = 0; i < w.points.count; i++)
        if (w.points.flags[i] & MPM_SURFACE) w.points.bond[i] = i < w.body[1].first ? MPM_R(0.6) : MPM_R(0.2);
    for (a = MPM_BOND_MEAN; a <= MPM_BOND_LITERAL; a = (mpm_bond_average)(a + 1)) {
        double low = 9, high = -9;
        b.average = a;
        mpm_locate(&w);
        mpm_p2g(&w);
        mpm_contact_find(&w);
        mpm_bond_nodes(&b, &w);
        for (i = 0; i < w.pairs; i++) {
            if ((double)w.pair[i].bond < low) low = (double)w.pair[i].bond;
            if ((double)w.pair[i].bond > high) high = (double)w.pair[i].bond;
        }
        if (a == MPM_BOND_LITERAL) CHECK_TRUE("A 4.6 literally: far below the mean", high < 0.2);
        else CHECK_NEAR("nodal D: mean of the bodies' means", low, 0.4, 16 * eps);
        if (a != MPM_BOND_LITERAL) CHECK_NEAR("... at every node", high, 0.4, 16 * eps);
    }
    mpm_free(&w);
}

static void measures(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc ball = scene_body(&m, mpm_sphere(5, 5, 5, 2), 0.5, 20);
    mpm_bond_measure measure;
    mpm_rebound r;
    mpm_world w;
    int32_t i;
    int n = 0;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &ball);
    for (i = 0; i < w.points.count && n < 10; i++)
        if (w.points.flags[i] & MPM_SURFACE) w.points.bond[i] = n++ < 3 ? MPM_R(1.25) : MPM_R(0.25);
    measure = mpm_bond_measure_body(&w, 0);
    CHECK_NEAR("PBCP (A 5.1)", measure.pbcp, 30, 1e-12);
    CHECK_NEAR("ABP", measure.abp, (3 * 1.25 + 7 * 0.25) / 10, 1e-12);
    w.points.v[0][0] = 100;
    r = mpm_restitution(&w, 0, 60);
    CHECK_EQUAL("ejected points are counted", r.ejected, 1);
    CHECK_RELATIVE("rebound velocity, filtered", r.filtered, 20, 100 * eps);
    CHECK_RELATIVE("rebound velocity, mean", r.mean, 20, 100 * eps);
    mpm_free(&w);
}

int main(void)
{
    growth();
    averages();
    measures();
    return check_end();
}
