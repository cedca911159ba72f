/* 08_drive - what is prescribed from outside, all with public calls. A block of aluminium in a square channel between
   mirrors. First a rigid punch comes down on it along a prescribed path, and stays: the force on the punch is that of
   uniaxial strain, (lambda + 2 mu) area way / height. The lower end of the block is held at the velocity 0, and must
   bear the same force. Then a block that is free, with a traction on its upper face: it gains traction x area x time.
   Expected: 2074.3 uN, both forces to 0.4 %; the momentum to round-off; and the ledger knows the work, to 0.1 %.
   The punch is a body without stress, whose nodes are given its velocity twice in a step, before contact and after it:
   what the second takes is the force. A contact law of this page treats it as infinitely heavy. What is approximated:
   its face is felt where both bodies share nodes, up to a cell before it is there; here it starts on the block, on a
   grid plane. mpm_node_push sets momentum and force, which move the points; 09_shear sets what strains them too, the
   velocity of MUSL. Units um, us, ng: stress in MPa, force in uN, energy in pJ. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"

#include <stdio.h>

static const double height = 8, area = 4;       /* um, um^2 */
static const double depth = 0.04, stop = 0.02;  /* way of the punch [um], and when it is done [us] */
static const double pull = 10;                  /* MPa */

/* Velocity of the punch: down by `depth` within `stop`, smoothly, then at rest. */
static mpm_real path(const mpm_world *w)
{
    const double t = (double)w->time / stop;
    return (mpm_real)(t < 1 ? -depth / stop * (1 - cos(2 * (double)MPM_PI * t)) : 0);
}

/* Gives the nodes of a body up to a height the velocity v along z, and returns the force that takes [uN]. A layer that
   moves along with what it drives is mpm_grip of mpm_measure.h. */
static double drive(mpm_world *w, int body, double below, mpm_real v)
{
    double force = 0;
    int32_t i;
    for (i = 0; i < w->nodes; i++) {
        mpm_real x[3], j[3] = {0, 0, 0};
        if (w->node[i].body != body) continue;
        mpm_node_position(w, &w->node[i], x);
        if ((double)x[2] > below) continue;
        j[2] = w->node[i].mass * v - w->node[i].momentum[2];
        mpm_node_push(w, i, j);
        force += (double)(j[2] / w->dt);
    }
    return force;
}

/* Contact with a body that nothing turns aside, the higher-numbered one: the other takes its velocity along the
   normal, where they approach. */
static int rigid(void *context, const mpm_world *w, const mpm_pair *p, mpm_real j[3])
{
    const mpm_node *a = &w->node[p->a], *b = &w->node[p->b];
    mpm_real approach = 0;
    int d;
    for (d = 0; d < 3; d++) approach += (a->momentum[d] / a->mass - b->momentum[d] / b->mass) * p->normal[d];
    for (d = 0; d < 3; d++) j[d] = -approach * a->mass * p->normal[d];
    (void)context;
    return approach > 0;
}

/* A traction [MPa] on the points of the upper face of body 0, along z: each has its share of the area. */
static void press(mpm_world *w, double traction)
{
    const double share = (double)(w->body[0].desc.spacing * w->body[0].desc.spacing);
    int32_t r, i;
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            mpm_real f[3] = {0, 0, 0};
            mpm_support s;
            if (w->run[r].body != 0 || !(w->points.flags[i] & MPM_FACE_TOP)) continue;
            mpm_support_of(w, &w->run[r], i, &s);
            f[2] = (mpm_real)(traction * share);
            mpm_push(w, &s, f);
        }
}

/* A step with a traction; and with a punch, if there is one, and the lower end held: *up, *down get their forces. */
static int step(mpm_world *w, double traction, double *up, double *down)
{
    if (mpm_locate(w, mpm_time_step(w, MPM_R(0.2))) < 0) return 0;
    mpm_p2g(w);
    mpm_forces(w);
    press(w, traction);
    mpm_grid_update(w);
    mpm_contact_find(w);
    if (w->bodies > 1) drive(w, 1, 1e9, path(w));
    mpm_contact_apply(w);
    if (w->bodies > 1) *up = drive(w, 1, 1e9, path(w)), *down = drive(w, 0, 0.5, 0);
    mpm_g2p(w);
    mpm_musl(w);
    if (mpm_stress(w) < 0) return 0;
    mpm_move(w);
    return 1;
}

static int begin(mpm_world *w, mpm_material *al, int punch)
{
    const mpm_units units = mpm_units_um_us_ng();
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    int i;
    if (mpm_material_preset(al, "al", &units, NULL) < 0 || mpm_material_model(al, "elastic", NULL) < 0) return 0;
    d.cell = 1;
    d.cells[0] = d.cells[1] = 2;
    d.cells[2] = 12;
    for (i = 0; i < 4; i++) d.side[i] = MPM_SIDE_SYMMETRY;
    d.contact.law = MPM_CONTACT_USER;
    d.contact.fn = rigid;
    b.spacing = 0.5;
    b.density = al->density;
    b.stress = mpm_material_stress;
    b.material = al;
    mpm_material_wave_speeds(al, al->density, &b.wave_p, &b.wave_s);
    b.shape = mpm_box(0, 0, 0, 2, 2, (mpm_real)height);
    if (mpm_init(w, &d, NULL, 0) < 0 || mpm_body_add(w, &b) < 0) return 0;
    b.shape = mpm_box(0, 0, (mpm_real)height, 2, 2, 10);
    b.stress = NULL;
    return !punch || mpm_body_add(w, &b) >= 0;
}

int main(void)
{
    double up = 0, down = 0, sum[2] = {0, 0}, exact, samples = 0;
    mpm_material al;
    mpm_totals t;
    mpm_world w;
    if (!begin(&w, &al, 1)) return 1;
    exact = (double)(al.young * (1 - al.poisson) / ((1 + al.poisson) * (1 - 2 * al.poisson))) * area * depth / height;
    while (w.time < MPM_R(0.04)) {
        if (!step(&w, 0, &up, &down)) return 1;
        if ((double)w.time < stop) continue;
        sum[0] -= up; /* means, since the block rings a little */
        sum[1] += down;
        samples++;
    }
    t = mpm_body_totals(&w, 0);
    printf("force on the punch %.2f uN, on the lower end %.2f uN, expected %.2f uN\n", sum[0] / samples,
           sum[1] / samples, exact);
    printf("work of the punch %.3f pJ, energy of the block and lost in contact %.3f pJ, expected %.3f pJ\n",
           -w.ledger.walls, t.kinetic + t.internal + w.ledger.contact, exact * depth / 2);
    mpm_free(&w);

    if (!begin(&w, &al, 0)) return 1;
    while (w.time < MPM_R(0.01))
        if (!step(&w, pull, &up, &down)) return 1;
    t = mpm_body_totals(&w, 0);
    printf("momentum %.6f ng m/s, traction x area x time %.6f ng m/s\n", t.momentum[2], pull * area * (double)w.time);
    printf("work of the traction %.4f pJ, energy of the free block %.4f pJ\n", -w.ledger.walls, t.kinetic + t.internal);
    mpm_free(&w);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
