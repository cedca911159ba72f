/* 05_law - laws of one's own, on one page: a strength, a bond rule, a contact law (09_shear: a whole law, which must
   turn its stress). Two blocks of a metal are thrown
   against each other at 100 m/s each. They yield by a law of this page; where they touch they bond as they yield; and
   when they spring apart, what has bonded is drawn off by a cohesive law: traction grows with the opening up to a
   strength of 100 MPa and falls to nothing again, so that 10 J/m^2 are spent. Each law is held to its number.
   Expected: points that flow bear Voce's stress to 1e-6; D is the plastic strain over 0.02, to 0.1 %; the traction
   reaches 99.6 MPa; and the blocks lose 10.09 J/m^2 of their energy while they are drawn apart (10.2 with twice the
   step). They move in a channel of 2 um x 2 um between mirrors, so that all depends on z alone. Units um, us, ng:
   stress in MPa, energy per area in J/m^2. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_bond.h"
#include "mpm_ptw.h"

#include <stdio.h>

enum { SIDE = 2, HEIGHT = 12, NODES = (SIDE + 1) * (SIDE + 1) * (HEIGHT + 1) }; /* cells, nodes of the grid */

/* ---- a strength: Voce's law, Y = a - b exp(-c eps) --------------------------------------------- */

typedef struct voce { mpm_real a, b, c; } voce; /* MPa, MPa, 1 */

static mpm_flow voce_flow(const void *context, const mpm_material *m, const mpm_material_state *s)
{
    const voce *v = (const voce *)context;
    const mpm_real soft = v->b * mpm_exp(-v->c * s->plastic_strain);
    mpm_flow f;
    f.stress = v->a - soft;
    f.strain_slope = v->c * soft; /* guides the solution */
    f.rate_slope = 0;
    (void)m;
    return f;
}

/* ---- a bond rule: D grows with the plastic strain of surface points in contact ------------------ */

static mpm_real strain_bond(void *context, const mpm_world *w, int32_t i)
{
    return w->points.plastic_rate[i] * w->dt_last / *(const mpm_real *)context;
}

/* ---- a contact law: what has bonded is cohesive ------------------------------------------------- */

typedef struct glue {
    mpm_real strength, energy, rise;   /* MPa; J/m^2; share of the last opening at which the strength is reached */
    mpm_real open[NODES], most[NODES]; /* at each node: the opening now, and the widest there was [um] */
} glue;

/* Up to the strength and down to nothing as it opens; where it was wider before, straight back to 0. */
static mpm_real traction(const glue *g, int32_t at)
{
    const mpm_real last = 2 * g->energy / g->strength, peak = g->rise * last;
    const mpm_real widest = g->most[at] > peak ? g->most[at] : peak;
    return widest < last ? g->strength * (last - widest) / (last - peak) * g->open[at] / widest : 0;
}

/* The momentum that draws a after b, along the normal out of a; negative where they push each other. */
static int cohesive(void *context, const mpm_world *w, const mpm_pair *p, mpm_real j[3])
{
    glue *g = (glue *)context;
    const int32_t at = w->node[p->a].index;
    const mpm_real ma = w->node[p->a].mass, mb = w->node[p->b].mass, mass = ma * mb / (ma + mb);
    const mpm_real stick = -mpm_pair_stick(w, p, j); /* would give both one velocity: negative as they approach */
    mpm_real draw = stick;
    int d;
    if (g->open[at] > 0 || stick > 0) {
        draw = p->hold * traction(g, at) * (mpm_real)mpm_pair_area(w, p) * w->dt;
        g->open[at] += (stick - draw) / mass * w->dt;
        if (g->open[at] < 0) g->open[at] = 0;
        if (g->open[at] > g->most[at]) g->most[at] = g->open[at];
    }
    for (d = 0; d < 3; d++) j[d] = draw * p->normal[d];
    return 1;
}

/* ---- the run --------------------------------------------------------------------------------------- */

static double energy(const mpm_world *w) { return mpm_body_totals(w, -1).kinetic + mpm_body_totals(w, -1).internal; }

int main(void)
{
    static glue g = {100, 10, MPM_R(0.1), {0}, {0}};
    const voce law = {200, 100, 20};
    const mpm_units units = mpm_units_um_us_ng();
    mpm_real strain = MPM_R(0.02); /* at which D is 1 */
    double force, peak = 0, off = 0, before = 0, grown = 0, flowed = 0;
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_bond bond = mpm_bond_default(&units);
    mpm_material al;
    mpm_world w;
    int32_t i;

    if (mpm_material_preset(&al, "al", &units, NULL) < 0 || mpm_material_model(&al, "elastic", NULL) < 0) return 1;
    al.strength = MPM_STRENGTH_USER; /* here the three laws are put to use */
    al.strength_fn = voce_flow;
    al.strength_context = &law;
    bond.rule = MPM_BOND_USER;
    bond.grow = strain_bond;
    bond.context = &strain;
    d.contact.law = MPM_CONTACT_USER;
    d.contact.fn = cohesive;
    d.contact.context = &g;

    d.cell = 1;
    d.cells[0] = d.cells[1] = SIDE;
    d.cells[2] = HEIGHT;
    for (i = 0; i < 4; i++) d.side[i] = MPM_SIDE_SYMMETRY;
    b.spacing = 0.5;
    b.density = al.density;
    b.stress = mpm_material_stress;
    b.material = &al;
    mpm_material_wave_speeds(&al, al.density, &b.wave_p, &b.wave_s);
    if (mpm_init(&w, &d, NULL, 0) < 0) return 1;
    for (i = 0; i < 2; i++) { /* the upper block falls, the lower one rises */
        b.shape = mpm_box(0, 0, i ? 2 : 6, SIDE, SIDE, i ? 6 : 10);
        b.velocity[2] = i ? 100 : -100;
        if (mpm_body_add(&w, &b) < 0) return 1;
    }
    while (w.time < MPM_R(0.008)) {
        if (mpm_bond_step(&bond, &w, mpm_time_step(&w, MPM_R(0.05))) < 0) return 1;
        for (force = 0, i = 0; i < w.pairs; i++) force -= (double)(w.pair[i].impulse[2] / w.dt);
        if (force > peak) peak = force;
        if (!(peak > 0)) before = energy(&w); /* until they pull for the first time */
        for (i = 0; i < w.points.count; i++) {
            const double shear = fabs((double)(w.points.stress[2][i] - w.points.stress[0][i])); /* von Mises' */
            const double eps = (double)w.points.plastic_strain[i], voce_stress = 200 - 100 * exp(-20 * eps);
            const double away = fabs(shear / voce_stress - 1);
            if (w.points.plastic_rate[i] > 0 && away > off) off = away;
        }
    }
    for (i = 0; i < w.points.count; i++)
        if (w.points.bond[i] > 0 && (w.points.flags[i] & (MPM_FACE_TOP | MPM_FACE_BOTTOM))) { /* where they met */
            grown += (double)w.points.bond[i];
            flowed += (double)w.points.plastic_strain[i];
        }
    printf("strength: points that flow are off the law by %.1e at most\n", off);
    printf("bond: D is the plastic strain over %.5f, %.1f %% of the surface holds\n", flowed / grown,
           mpm_bond_measure_body(&w, -1).pbcp);
    printf("contact: peak traction %.2f MPa\n", peak / (SIDE * SIDE));
    printf("contact: spent in drawing apart %.3f J/m^2\n", (before - energy(&w)) / (SIDE * SIDE));
    mpm_free(&w);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
