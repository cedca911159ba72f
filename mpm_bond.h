/* mpm_bond.h - does it stick? Bonding inside the simulation, and the measures of it.
   Part of mpm.h 0.1.0. SPDX-License-Identifier: MIT

   DO THIS
     #define MPM_IMPLEMENTATION in ONE file, then include mpm.h and mpm_bond.h there. In the loop,
     between contact_find and contact_apply:
         mpm_contact_find(&w);
         mpm_bond_grow(&bond, &w, dt);     surface points in contact gather D
         mpm_bond_nodes(&bond, &w);        D of the nodes where bodies meet
         mpm_contact_apply(&w, dt);        separating pairs with D >= 1 are held together

   THE MODEL (source A, chapter 4). A surface point that is in contact and flows plastically dissipates
   sigma d(eps) per volume; times the cell edge that is an energy per area, dG. It bonds when enough
   has been dissipated fast enough: dD = dG / G_b, with G_b = G_c (1 - ln(dG / (Gdot_c dt))), and a
   node whose bodies' mean D reaches 1 carries tension.

   A KNOWN LIMIT. A held pair sticks while separating and slides while approaching; each change of
   sides costs or gives a little energy, in proportion to the step. Two elastic spheres bonded all over
   and left to vibrate for 120 ns gained 41 % of their energy at dt = 0.1 cell/c and lost 11 % at a
   quarter of it. Plastic impacts are short and stiff in comparison; the ledger shows the amount.

   WHAT IT DOES NOT DO: oxide films, diffusion, damage of a bond once made (D never falls).

   UNITS of Gdot_c. Source A prints its pair as G_c = 1503.74 J/m^2 and Gdot_c = 2.271 "J/m^2 s" in one
   place and "J/m^2 us" in another. Points at the interface dissipate 1e4 - 6e5 J/(m^2 us), so that
   either reading puts the threshold below zero nearly everywhere. With the axis factor 1e5 that the
   print lost, 2.271e5 J/(m^2 us), the observed range lies inside the law. */
#ifndef MPM_BOND_H
#define MPM_BOND_H

#include "mpm.h"

#ifdef MPM_FLOAT
#define mpm_bond_default mpm_bond_default_f32
#define mpm_bond_check mpm_bond_check_f32
#define mpm_bond_increment mpm_bond_increment_f32
#define mpm_bond_grow mpm_bond_grow_f32
#define mpm_bond_nodes mpm_bond_nodes_f32
#define mpm_bond_measure_body mpm_bond_measure_body_f32
#define mpm_restitution mpm_restitution_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mpm_bond_rule {
    MPM_BOND_NONE = 0, /* D stays as it is */
    MPM_BOND_ENERGY,   /* A 4.16, 4.17 */
    MPM_BOND_STRAIN    /* A 4.3 - 4.5 */
} mpm_bond_rule;

/* The D of a body at a node, from its surface points with N_I > 0 there (A 4.6). */
typedef enum mpm_bond_average {
    MPM_BOND_MEAN = 0, /* their arithmetic mean: the thesis's text */
    MPM_BOND_WEIGHTED, /* their mean weighted with N_I */
    MPM_BOND_LITERAL   /* sum D_p N_I / n: A 4.6 as printed, which practically never reaches 1 */
} mpm_bond_average;

typedef struct mpm_bond {
    mpm_bond_rule rule;
    mpm_bond_average average;
    mpm_real critical;      /* energy rule: G_c [energy/area]; strain rule: eps_c */
    mpm_real critical_rate; /* energy rule: Gdot_c [energy/area/time]; strain rule: rate [1/time] */
    mpm_real length;        /* energy rule: regularising length; 0: the cell edge (thesis: DCell) */
    mpm_real floor;         /* least value of the factor 1 - ln(rate/critical rate), > 0 */
    long floor_hits;        /* how often the floor acted */
    long increments;        /* how often D grew */
} mpm_bond;

/* The energy rule with the pair of source A, 1503.74 J/m^2 and 2.271e5 J/(m^2 us), floor 0.05. */
MPM_API mpm_bond mpm_bond_default(const mpm_units *units);

/* MPM_ERR_ARGUMENT / NAN with the field and its value: critical, critical_rate, floor > 0; length >= 0. */
MPM_API mpm_status mpm_bond_check(const mpm_bond *b, mpm_fault *fault);

/* Growth of D of one point in one step (A 4.3 - 4.5, 4.16, 4.17).
   amount: energy rule dG [energy/area], strain rule the effective plastic strain increment; >= 0, and
   0 adds nothing. dt [time] > 0. The factor 1 - ln(amount/(critical_rate dt)) falls with the rate and
   would turn negative beyond e times the critical rate: it is kept at the floor there, and the hit is
   counted. Test: 30_bond. */
MPM_API mpm_real mpm_bond_increment(mpm_bond *b, mpm_real amount, mpm_real dt);

/* Lets D of the surface points grow by what the last step dissipated, where they are in contact:
   within the support of a node that carries two bodies. After mpm_contact_find. */
MPM_API void mpm_bond_grow(mpm_bond *b, mpm_world *w, mpm_real dt);

/* Nodal D into the pairs: the mean over the two bodies of their nodal values (A 4.6, 4.7). A body
   without surface point at the node counts as 0. After mpm_contact_find. */
MPM_API void mpm_bond_nodes(const mpm_bond *b, mpm_world *w);

/* How much of the interface bonded. */
typedef struct mpm_bond_measure {
    long contacted;      /* surface points with D > 0 */
    long bonded;         /* ... with D >= 1 */
    double pbcp;         /* bonded / contacted [%] (A 5.1); 0 without contact */
    double abp;          /* mean D over contacted points */
    double bonded_mass, contacted_mass;
} mpm_bond_measure;

MPM_API mpm_bond_measure mpm_bond_measure_body(const mpm_world *w, int32_t body); /* body -1: all */

/* The rebound of a body (A 5.2). Ejected points, faster than `filter` in any direction, are left out
   of `filtered` and counted; `mean` is mass-weighted over all points. Along z, retired points included. */
typedef struct mpm_rebound {
    double filtered;     /* mean v_z of points with |v| <= filter [length/time] */
    double mean;         /* mass-weighted mean v_z */
    double noise;        /* standard deviation of v_z about the filtered mean */
    long ejected;        /* points with |v| > filter */
    double ejected_mass;
} mpm_rebound;

MPM_API mpm_rebound mpm_restitution(const mpm_world *w, int32_t body, mpm_real filter);

#ifdef __cplusplus
}
#endif
#endif /* MPM_BOND_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__BOND_IMPLEMENTED)
#define MPM__BOND_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

static inline mpm_real mpm__bond_log(mpm_real a)
{
#ifdef MPM_FLOAT
    return logf(a);
#else
    return log(a);
#endif
}

MPM_API mpm_bond mpm_bond_default(const mpm_units *u)
{
    mpm_bond b;
    memset(&b, 0, sizeof b);
    b.rule = MPM_BOND_ENERGY;
    b.critical = (mpm_real)(1503.74 / mpm_units_area_energy(u));
    b.critical_rate = (mpm_real)(2.271e11 / (mpm_units_area_energy(u) / u->time));
    b.floor = MPM_R(0.05);
    return b;
}

MPM_API mpm_status mpm_bond_check(const mpm_bond *b, mpm_fault *f)
{
    mpm_status s;
    if (b->rule == MPM_BOND_NONE) return MPM_OK;
    if ((s = mpm__want(b->critical > 0, f, "bond critical", b->critical, -1)) != MPM_OK) return s;
    if ((s = mpm__want(b->critical_rate > 0, f, "bond critical_rate", b->critical_rate, -1)) != MPM_OK) return s;
    if ((s = mpm__want(b->floor > 0, f, "bond floor", b->floor, -1)) != MPM_OK) return s;
    return mpm__want(b->length >= 0, f, "bond length", b->length, -1);
}

MPM_API mpm_real mpm_bond_increment(mpm_bond *b, mpm_real amount, mpm_real dt)
{
    mpm_real factor;
    if (!(amount > 0)) return 0;
    factor = 1 - mpm__bond_log(amount / (b->critical_rate * dt));
    if (factor < b->floor) {
        factor = b->floor;
        b->floor_hits++;
    }
    b->increments++;
    return amount / (b->critical * factor);
}

/* sqrt(3/2 s:s) of a point's stress. */
static inline mpm_real mpm__von_mises(const mpm_points *q, int32_t i)
{
    const mpm_real xx = q->stress[0][i], yy = q->stress[1][i], zz = q->stress[2][i];
    const mpm_real yz = q->stress[3][i], xz = q->stress[4][i], xy = q->stress[5][i];
    const mpm_real d = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
    return mpm__sqrt(d / 2 + 3 * (yz * yz + xz * xz + xy * xy));
}

/* The surface points of a run in contact: with `grow` their D grows, with `nodes` it is added to the
   contact nodes around them. */
MPM__KERNEL void mpm__bond_run(mpm_bond *grow, const mpm_bond *nodes, mpm_world *w, const mpm_run *r, int k, int ky,
                               mpm_real dt)
{
    mpm_points *q = &w->points;
    const int32_t *slot = mpm__run_nodes(w, r);
    mpm_real N[MPM__SUPPORT];
    mpm__weights s;
    int32_t at;
    int n, p, a;
    if (!(r->flags & MPM_NODE_CONTACT)) return;
    MPM__EACH_PIECE(r, at, n) {
        mpm__weigh(w, r, at, n, k, ky, &s);
        for (p = 0; p < n; p++) {
            const int32_t i = at + p;
            int touching = 0;
            if (!(q->flags[i] & MPM_SURFACE)) continue;
            mpm__products(&s, p, k, ky, N);
            for (a = 0; a < k * ky * k; a++) {
                mpm_node *node = &w->node[slot[a]];
                if (!(node->sides & MPM_NODE_CONTACT) || !(N[a] > 0)) continue;
                touching = 1;
                if (!nodes) continue;
                node->bond[0] += nodes->average == MPM_BOND_MEAN ? q->bond[i] : q->bond[i] * N[a];
                node->bond[1] += nodes->average == MPM_BOND_WEIGHTED ? N[a] : 1;
            }
            if (grow && touching && q->plastic_rate[i] > 0) {
                mpm_real amount = q->plastic_rate[i] * dt;
                if (grow->rule == MPM_BOND_ENERGY)
                    amount *= mpm__von_mises(q, i) * (grow->length > 0 ? grow->length : w->desc.cell);
                q->bond[i] += mpm_bond_increment(grow, amount, dt);
            }
        }
    }
}

MPM_API void mpm_bond_grow(mpm_bond *b, mpm_world *w, mpm_real dt)
{
    if (b->rule == MPM_BOND_NONE || w->pairs == 0) return;
#define MPM__CALL(k, ky, hoop) mpm__bond_run(b, NULL, w, run, k, ky, dt)
    MPM__EACH_RUN(w, MPM__CALL);
#undef MPM__CALL
}

MPM_API void mpm_bond_nodes(const mpm_bond *b, mpm_world *w)
{
    int32_t i;
    if (w->pairs == 0) return;
#define MPM__CALL(k, ky, hoop) mpm__bond_run(NULL, b, w, run, k, ky, 0)
    MPM__EACH_RUN(w, MPM__CALL);
#undef MPM__CALL
    for (i = 0; i < w->pairs; i++) {
        const mpm_real *a = w->node[w->pair[i].a].bond, *c = w->node[w->pair[i].b].bond;
        w->pair[i].bond = ((a[1] > 0 ? a[0] / a[1] : 0) + (c[1] > 0 ? c[0] / c[1] : 0)) / 2;
    }
}

MPM_API mpm_bond_measure mpm_bond_measure_body(const mpm_world *w, int32_t body)
{
    const mpm_points *q = &w->points;
    const int32_t from = body < 0 ? 0 : body, to = body < 0 ? w->bodies : body + 1;
    mpm_bond_measure m;
    int32_t b, i;
    memset(&m, 0, sizeof m);
    for (b = from; b < to; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].count; i++) {
            if (!(q->flags[i] & MPM_SURFACE) || !(q->bond[i] > 0)) continue;
            m.contacted++;
            m.contacted_mass += (double)q->mass[i];
            m.abp += (double)q->bond[i];
            if (q->bond[i] < 1) continue;
            m.bonded++;
            m.bonded_mass += (double)q->mass[i];
        }
    if (m.contacted) {
        m.pbcp = 100.0 * (double)m.bonded / (double)m.contacted;
        m.abp /= (double)m.contacted;
    }
    return m;
}

MPM_API mpm_rebound mpm_restitution(const mpm_world *w, int32_t body, mpm_real filter)
{
    const mpm_points *q = &w->points;
    const mpm_body *b = &w->body[body];
    double mass = 0, kept = 0, square = 0;
    mpm_rebound r;
    int32_t i;
    memset(&r, 0, sizeof r);
    for (i = b->first; i < b->first + b->count; i++) {
        const double m = (double)q->mass[i], vz = (double)q->v[2][i];
        const mpm_real v2 = q->v[0][i] * q->v[0][i] + q->v[1][i] * q->v[1][i] + q->v[2][i] * q->v[2][i];
        mass += m;
        r.mean += m * vz;
        if (v2 > filter * filter) {
            r.ejected++;
            r.ejected_mass += m;
        } else {
            kept += m;
            r.filtered += m * vz;
            square += m * vz * vz;
        }
    }
    if (mass > 0) r.mean /= mass;
    if (kept > 0) {
        r.filtered /= kept;
        square = square / kept - r.filtered * r.filtered;
        r.noise = square > 0 ? sqrt(square) : 0;
    }
    return r;
}

#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */
