/* 09_shear - a whole law of one's own, with rotation, in a block whose motion is prescribed. A law that keeps a stress
   has to turn it with the material, or it stays where it was in space: mpm_rotate does that, by the rotation increment
   of the block, before the strain adds to it. Here it is Hooke's law in rates (Jaumann's): d stress = turn +
   lambda tr(d eps) + 2 mu d eps, its energy stress : d eps/density. A block is sheared, v_x = rate z, by gamma = 3.
   Expected: its stresses follow the closed answer for this law, xz: mu sin(gamma), xx: mu (1 - cos(gamma)), zz: -xx
   (Dienes, Acta Mech. 32 (1979) 217), to 0.2 % of mu, which is the shear of one step; its energy mu (1 - cos(gamma))
   per volume, to 0.01 %. The same law without mpm_rotate gives mu gamma and no xx: at the end it is 2.86 mu off.
   What to set to prescribe the motion of a node, and when:
     momentum, force  by mpm_node_push after mpm_grid_update (and contact): points move with P/m and gain f dt/m;
     velocity         in world.node after mpm_musl: it strains the points. MUSL maps it from the points, which at the
                      rim of a body is not what was prescribed. In 08_drive nothing is strained there: it is left alone.
   Plane strain. Units um, us, ng: stress in MPa. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"

#include <stdio.h>

typedef struct hooke { mpm_real lambda, mu; int turns; } hooke; /* MPa, MPa; 0: without mpm_rotate */

static const double rate = 100, farthest = 3; /* 1/us; gamma at the end */

/* The law: brings the points of a block from level k to k+1. */
static mpm_status hooke_stress(const void *material, const mpm_block *b)
{
    const hooke *m = (const hooke *)material;
    int i, d;
    for (i = 0; i < b->count; i++) {
        const mpm_real volume = b->strain[0][i] + b->strain[1][i] + b->strain[2][i];
        mpm_real w[3], s[6], work = 0;
        for (d = 0; d < 3; d++) w[d] = b->spin[d][i];
        for (d = 0; d < 6; d++) s[d] = b->stress[d][i];
        if (m->turns) mpm_rotate(w, s); /* first the old stress turns with the material */
        for (d = 0; d < 6; d++) {
            const mpm_real now = s[d] + 2 * m->mu * b->strain[d][i] + (d < 3 ? m->lambda * volume : 0);
            work += (d < 3 ? 1 : 2) * (s[d] + now) / 2 * b->strain[d][i];
            b->stress[d][i] = now;
        }
        b->energy[i] += work / b->density[i];
        if (!mpm_finite(b->energy[i])) return mpm_fail(b->fault, MPM_ERR_NAN, "energy of point", b->energy[i], i);
    }
    return MPM_OK;
}

/* Gives every node of the block the velocity rate z along x, and none along z. */
static void prescribe_momentum(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->nodes; i++) {
        const mpm_node *n = &w->node[i];
        mpm_real x[3], j[3] = {0, 0, 0};
        mpm_node_position(w, n, x);
        j[0] = n->mass * (mpm_real)rate * x[2] - n->momentum[0];
        j[2] = -n->momentum[2];
        mpm_node_push(w, i, j);
    }
}

static void prescribe_velocity(mpm_world *w)
{
    int32_t i;
    for (i = 0; i < w->nodes; i++) {
        mpm_real x[3];
        mpm_node_position(w, &w->node[i], x);
        w->node[i].velocity[0] = (mpm_real)rate * x[2];
        w->node[i].velocity[2] = 0;
    }
}

static int step(mpm_world *w, mpm_real dt)
{
    if (mpm_locate(w, dt) < 0) return 0;
    mpm_p2g(w);
    mpm_forces(w);
    mpm_grid_update(w);
    prescribe_momentum(w);
    mpm_g2p(w);
    mpm_musl(w);
    prescribe_velocity(w);
    if (mpm_stress(w) < 0) return 0;
    mpm_move(w);
    return 1;
}

static int begin(mpm_world *w, const hooke *law)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    d.geometry = MPM_PLANE_STRAIN;
    d.cell = 1;
    d.cells[0] = 20;
    d.cells[2] = 6;
    b.shape = mpm_box(1, 0, 1, 5, 1, 5);
    b.spacing = 0.5;
    b.density = MPM_R(0.0027);
    b.stress = hooke_stress;
    b.material = law;
    b.wave_p = mpm_sqrt((law->lambda + 2 * law->mu) / b.density); /* of one's own law too: mpm_time_step asks for it */
    return mpm_init(w, &d, NULL, 0) >= 0 && mpm_body_add(w, &b) >= 0;
}

/* The largest distance of a point's stresses from the closed answer, in mu. */
static double off(const mpm_world *w, const hooke *law)
{
    const double gamma = rate * (double)w->time, mu = (double)law->mu;
    const double wanted[6] = {1 - cos(gamma), 0, cos(gamma) - 1, 0, sin(gamma), 0};
    double most = 0;
    int32_t i;
    int d;
    for (i = 0; i < w->points.count; i++)
        for (d = 0; d < 6; d++) {
            const double away = fabs((double)w->points.stress[d][i] / mu - wanted[d]);
            if (away > most) most = away;
        }
    return most;
}

/* The shear, with or without rotation: *most gets what off() found in any step. */
static int shear(mpm_world *w, const hooke *law, double *most)
{
    *most = 0;
    if (!begin(w, law)) return 0;
    while (rate * (double)w->time < farthest) {
        double now;
        if (!step(w, mpm_time_step(w, MPM_R(0.1)))) return 0;
        if ((now = off(w, law)) > *most) *most = now;
    }
    return 1;
}

int main(void)
{
    hooke law = {51084, 26316, 1};
    double most, gamma;
    mpm_world w;
    if (!shear(&w, &law, &most)) return 1;
    gamma = rate * (double)w.time;
    printf("sheared by %.3f: off the closed answer by %.5f mu at most\n", gamma, most);
    printf("energy %.5f of the closed answer's\n", /* per volume, of 16 um^2 */
           mpm_body_totals(&w, 0).internal / (16 * (double)law.mu * (1 - cos(gamma))));
    mpm_free(&w);
    law.turns = 0;
    if (!shear(&w, &law, &most)) return 1;
    printf("without mpm_rotate: off by %.3f mu\n", most);
    mpm_free(&w);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
