/* mpm_bond.h - does it stick? Bonding inside the simulation, and the measures of it.
   Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     #define MPM_IMPLEMENTATION in ONE file, then include "mpm_bond.h" there: it brings mpm.h with it. The same
     line without the macro everywhere else. Put mpm_bond_grow and mpm_bond_nodes into your loop, between
     mpm_contact_find and mpm_contact_apply; or call mpm_bond_step. Link with -lm.

     A second model of bonding: bond.rule = MPM_BOND_USER with your bond.grow, which says by how much D of a
     point grew; and your bond.decide, which says whether a pair of bodies holds at a node.

   A COMPLETE PROGRAM (an aluminium particle of 14 um at 900 m/s on aluminium, half a cross-section of it; it
   stays, PBCP 10.5 %)
       #define MPM_IMPLEMENTATION
       #include "mpm.h"
       #include "mpm_ptw.h"
       #include "mpm_bond.h"
       #include "mpm_measure.h"
       #include <stdio.h>
       int main(void) {
           mpm_units units = mpm_units_um_us_ng();
           mpm_bond bond = mpm_bond_default(&units);
           mpm_body_desc b = mpm_body_desc_default();
           mpm_desc d = mpm_desc_default();
           mpm_shape ball = mpm_sphere(0, 0, 7, 7), plate = mpm_cylinder(0, 0, -10, 15, 10);
           mpm_material al;
           mpm_world w;
           mpm_real dt;
           d.geometry = MPM_AXISYMMETRIC; d.side[0] = MPM_SIDE_SYMMETRY;
           d.cell = 1; d.cells[0] = 29; d.cells[2] = 42; d.origin[2] = -14;
           if (mpm_material_preset(&al, "al", &units, NULL) < 0 || mpm_init(&w, &d, NULL, 0) < 0) return 1;
           b.spacing = 0.5; b.density = al.density; b.temperature = al.temperature;
           b.stress = mpm_material_stress; b.material = &al;
           mpm_material_wave_speeds(&al, al.density, &b.wave_p, &b.wave_s);
           b.shape = ball; b.velocity[2] = -900;
           if (mpm_body_add(&w, &b) < 0) return 1;
           b.shape = plate; b.velocity[2] = 0; b.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
           if (mpm_body_add(&w, &b) < 0) return 1;
           dt = 0.1 * d.cell / b.wave_p;
           while (w.time < 0.08) {
               if (mpm_locate(&w, dt) < 0) return 1;
               mpm_p2g(&w);
               mpm_forces(&w);
               mpm_grid_update(&w);
               mpm_contact_find(&w);
               mpm_bond_grow(&bond, &w);     // surface points in contact gather D
               mpm_bond_nodes(&bond, &w);    // D of the nodes where bodies meet: how far they are held
               mpm_contact_apply(&w);        // separating pairs are held together
               mpm_g2p(&w);
               mpm_musl(&w);
               if (mpm_stress(&w) < 0) return 1;
               mpm_move(&w);
           }
           printf("PBCP %.1f %%, rebound at %.1f m/s\n", mpm_bond_measure_body(&w, -1).pbcp,
                  mpm_rebound_from(&w, 0, 1, 60).mean);
           mpm_free(&w);
           return 0;
       }

   CONTENTS
     growth and decision   mpm_bond_default, _check, _law, _of_point, _grow, _of_pair, _nodes, _step
     measures              mpm_bond_measure_body, mpm_bond_measure_pair

   THE MODEL (source A, chapter 4). A surface point that is in contact and flows plastically dissipates
   sigma d(eps) per volume; times the cell edge that is an energy per area, dG. It bonds when enough
   has been dissipated fast enough: dD = dG / G_b, with G_b = G_c (1 - ln(dG / (Gdot_c dt))), and a
   node whose bodies' mean D reaches 1 carries tension.

   A KNOWN LIMIT of the thesis's scheme (MPM_SCHEME_THESIS). A held pair sticks while separating and slides while
   approaching; each change of sides costs or gives a little energy, in proportion to the step. Two elastic spheres
   bonded all over and left to vibrate for 120 ns gained 41 % of their energy at dt = 0.1 cell/c. In the consistent
   scheme a pair that is held wholly is held in both directions: such spheres move as one body does, to round-off.

   ANOTHER. With ranked normals those of the edge of a face are tilted, and mpm_pair_area is 0 there: a face of 4 x 4
   cells counts 9 of its 16, and a bond with a `strength` bears 58 % of it. With averaged normals it bears all.

   A THIRD. D belongs to a point, not to a pair of bodies: a surface that bonded to one body, with D of 2 or
   more, also holds the next one that touches it, even where that one's own D is 0: their mean is 1. With
   bond.partner, which remembers whom a point bonded to, your bond.decide can tell them apart.

   WHAT IT DOES NOT DO: oxide films, diffusion, damage of a bond once made (D never falls).

   UNITS of Gdot_c. Source A prints its pair as G_c = 1503.74 J/m^2 and Gdot_c = 2.271 "J/m^2 s" in one
   place and "J/m^2 us" in another. Points at the interface dissipate 1e4 - 6e5 J/(m^2 us), so that
   either reading puts the threshold below zero nearly everywhere. With the axis factor 1e5 that the
   print lost, 2.271e5 J/(m^2 us), the observed range lies inside the law.

   Equation numbers "A n" are those of source A (see mpm.h). */
#ifndef MPM_BOND_H
#define MPM_BOND_H

#include "mpm.h"

#if MPM_VERSION_NUMBER != 200
#error "mpm_bond.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_bond_default mpm_bond_default_f32
#define mpm_bond_check mpm_bond_check_f32
#define mpm_bond_law mpm_bond_law_f32
#define mpm_bond_grow mpm_bond_grow_f32
#define mpm_bond_of_point mpm_bond_of_point_f32
#define mpm_bond_nodes mpm_bond_nodes_f32
#define mpm_bond_of_pair mpm_bond_of_pair_f32
#define mpm_bond_step mpm_bond_step_f32
#define mpm_bond_measure_body mpm_bond_measure_body_f32
#define mpm_bond_measure_pair mpm_bond_measure_pair_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Each choice once, as X(constant, "word", "meaning"), as in mpm.h. */
#define MPM_BOND_RULE_LIST(X)                                  \
    X(MPM_BOND_NONE, "none", "D stays as it is")               \
    X(MPM_BOND_ENERGY, "energy", "A 4.16, 4.17")               \
    X(MPM_BOND_STRAIN, "strain", "A 4.3 - 4.5")                \
    X(MPM_BOND_USER, "user", "mpm_bond.grow")

/* The D of a body at a node, from its surface points with N_I > 0 there (A 4.6). */
#define MPM_BOND_AVERAGE_LIST(X)                                                      \
    X(MPM_BOND_MEAN, "mean", "their arithmetic mean: the thesis's text")              \
    X(MPM_BOND_WEIGHTED, "weighted", "their mean weighted with N_I")                  \
    X(MPM_BOND_LITERAL, "literal", "sum D_p N_I / n: A 4.6 as printed, which practically never reaches 1")

typedef enum mpm_bond_rule { MPM_BOND_RULE_LIST(MPM_LIST_ENUM) MPM_BOND_RULES } mpm_bond_rule;
typedef enum mpm_bond_average { MPM_BOND_AVERAGE_LIST(MPM_LIST_ENUM) MPM_BOND_AVERAGES } mpm_bond_average;

/* A growth rule of your own (the general A 4.1): by how much D of a surface point in contact grew in the
   last step, of length w->dt_last; everything known of the point is in w->points. What is not > 0 adds nothing. */
typedef mpm_real (*mpm_bond_fn)(void *context, const mpm_world *w, int32_t point);

/* A decision of your own whether a bond holds: what D the pair gets instead of D, that of A 4.7. At 1 or more it
   is held together in separation (see mpm_bond.width). */
typedef mpm_real (*mpm_bond_pair_fn)(void *context, const mpm_world *w, const mpm_pair *pair, mpm_real D);

/* A bond: its rule, its numbers, when a pair holds. */
typedef struct mpm_bond {
    unsigned mark;          /* set by mpm_bond_default */
    mpm_bond_rule rule;
    mpm_bond_average average;
    mpm_real critical;      /* energy rule: G_c [energy/area]; strain rule: eps_c */
    mpm_real critical_rate; /* energy rule: Gdot_c [energy/area/time]; strain rule: rate [1/time] */
    mpm_real length;        /* energy rule: regularising length; 0: the cell edge (thesis: DCell) */
    mpm_real floor;         /* least value of the factor 1 - ln(rate/critical rate), > 0 */
    mpm_real width;         /* 0: a pair is held from D = 1 on (A 4.7). > 0, up to 2: a softened threshold; each
                               step takes a share of the separating momentum, none at D = 1 - width/2, all at
                               1 + width/2 */
    mpm_real strength;      /* largest traction of a held pair [stress]: beyond it the pair slips; 0: no limit */
    int partner;            /* user field of the points (mpm_field_take) that remembers the body they bond to, or -1 */
    mpm_bond_fn grow;       /* the rule of MPM_BOND_USER */
    mpm_bond_pair_fn decide; /* NULL: A 4.7 decides */
    void *context;          /* passed to both */
} mpm_bond;

/* What is counted in the world's tally. */
enum {
    MPM_TALLY_BOND_FLOOR = 4, /* how often the floor acted */
    MPM_TALLY_BOND_GROWTH     /* how often D grew */
};

/* The energy rule with the pair of source A, 1503.74 J/m^2 and 2.271e5 J/(m^2 us), floor 0.05, in the given
   units. Test: 30_bond. */
MPM_API mpm_bond mpm_bond_default(const mpm_units *units);

/* MPM_ERR_ARGUMENT / NAN with the field and its value: rule and average of their lists; critical, critical_rate,
   floor > 0; length, strength >= 0; width 0 .. 2; with MPM_BOND_USER a grow that is not NULL; partner -1 or a
   user field. Test: 30_bond. */
MPM_API mpm_status mpm_bond_check(const mpm_bond *b, mpm_fault *fault);

/* Growth of D of one point in one step, amount / (critical (1 - ln(amount/(critical_rate dt)))) (A 4.3 - 4.5,
   4.16, 4.17).
   amount: energy rule dG [energy/area], strain rule the effective plastic strain increment; >= 0, and
   0 adds nothing. dt [time] > 0. The factor 1 - ln falls with the rate and would turn negative beyond e times the
   critical rate: it is kept at the floor there. tally: a world's, or NULL. Test: 30_bond. */
MPM_API mpm_real mpm_bond_law(const mpm_bond *b, mpm_real amount, mpm_real dt, int64_t *tally);

/* Growth of D of one surface point in contact by what it did in the last step, whatever the rule.
   Test: 30_bond. */
MPM_API mpm_real mpm_bond_of_point(const mpm_bond *b, mpm_world *w, int32_t point);

/* Lets D of the surface points grow by what the last step dissipated, where they are in contact:
   within the support of a node that carries two bodies. That is so with contact.touch too: D then also grows
   where bodies share a node and do not touch yet. With b->partner, a user field of the world, the
   point also remembers the number of the other body + 1; of several, the one with most mass at the contact
   node nearest to the point. After mpm_contact_find. Test: 30_bond. */
MPM_API void mpm_bond_grow(const mpm_bond *b, mpm_world *w);

/* D of a pair: the mean over the two bodies of their nodal values (A 4.6, 4.7), or what b->decide makes of it. A
   body without surface point at the node counts as 0. After mpm_bond_nodes. Test: 30_bond. */
MPM_API mpm_real mpm_bond_of_pair(const mpm_bond *b, const mpm_world *w, const mpm_pair *pair);

/* Nodal D, and from it how far each pair is held: pair.hold and pair.limit. After mpm_contact_find.
   Test: 30_bond. */
MPM_API void mpm_bond_nodes(const mpm_bond *b, mpm_world *w);

/* mpm_step with the bond in it, of dt [time] > 0. Returns MPM_OK, MPM_RETIRED; an error of mpm_locate, before the step
   began; or an error of mpm_stress, with the step incomplete. w->fault names it. Test: 30_bond. */
MPM_API mpm_status mpm_bond_step(const mpm_bond *b, mpm_world *w, mpm_real dt);

/* ---- measures ------------------------------------------------------------------------------- */

/* How much of the interface bonded, in surface points. An area is that of the undeformed surface: a point
   stands for mass / (initial density * spacing), which in a flat face is its share exactly; in a sphere the
   shell of one spacing adds up to the surface but for spacing/radius. */
typedef struct mpm_bond_measure {
    long contacted;      /* surface points with D > 0 */
    long bonded;         /* ... with D >= 1 */
    double pbcp;         /* bonded / contacted [%] (A 5.1), by area: in axisymmetry a point is a ring; 0
                            without contact */
    double abp;          /* mean D over contacted points, by area */
    double bonded_mass, contacted_mass;  /* [mass] */
    double bonded_area, contacted_area; /* [length^2]; in plane strain per depth */
} mpm_bond_measure;

/* Of one body, which must be one of the world's, or (-1) of all. Test: 30_bond. */
MPM_API mpm_bond_measure mpm_bond_measure_body(const mpm_world *w, int32_t body);

/* The same for the surface between two bodies: points of the one that bonded to the other last. Needs the
   partner that mpm_bond_grow noted: MPM_ERR_ARGUMENT without such a user field, or for bodies that are not
   two of the world's. Test: 30_bond. */
MPM_API mpm_status mpm_bond_measure_pair(const mpm_bond *rule, const mpm_world *w, int32_t a, int32_t b,
                                         mpm_bond_measure *measure);

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

MPM_API mpm_bond mpm_bond_default(const mpm_units *u)
{
    mpm_bond b;
    memset(&b, 0, sizeof b);
    b.rule = MPM_BOND_ENERGY;
    b.critical = (mpm_real)(1503.74 / mpm_units_area_energy(u));
    b.critical_rate = (mpm_real)(2.271e11 / (mpm_units_area_energy(u) / u->time));
    b.mark = MPM_MARK;
    b.floor = MPM_R(0.05);
    b.partner = -1;
    return b;
}

MPM_API mpm_status mpm_bond_check(const mpm_bond *b, mpm_fault *f)
{
    const int rule = (int)b->rule, mean = (int)b->average;
    mpm_status s = mpm_want(b->mark == MPM_MARK, f, "bond (not from mpm_bond_default)", (mpm_real)b->mark, -1);
    if (s == MPM_OK)
        s = mpm_want(b->partner >= -1 && b->partner < MPM_USER_FIELDS, f, "bond partner", (mpm_real)b->partner, -1);
    if (s == MPM_OK) s = mpm_want(rule >= 0 && rule < MPM_BOND_RULES, f, "bond rule", (mpm_real)rule, -1);
    if (s == MPM_OK) s = mpm_want(mean >= 0 && mean < MPM_BOND_AVERAGES, f, "bond average", (mpm_real)mean, -1);
    if (s == MPM_OK) s = mpm_want(b->width >= 0 && b->width <= 2, f, "bond width", b->width, -1);
    if (s == MPM_OK) s = mpm_want(b->strength >= 0, f, "bond strength", b->strength, -1);
    if (s != MPM_OK || b->rule == MPM_BOND_NONE) return s;
    if (b->rule == MPM_BOND_USER) return mpm_want(b->grow != NULL, f, "bond grow", 0, -1);
    if ((s = mpm_want(b->critical > 0, f, "bond critical", b->critical, -1)) != MPM_OK) return s;
    if ((s = mpm_want(b->critical_rate > 0, f, "bond critical_rate", b->critical_rate, -1)) != MPM_OK) return s;
    if ((s = mpm_want(b->floor > 0, f, "bond floor", b->floor, -1)) != MPM_OK) return s;
    return mpm_want(b->length >= 0, f, "bond length", b->length, -1);
}

static inline void mpm__bond_count(int64_t *tally, int what)
{
    if (tally) tally[what]++;
}

MPM_API mpm_real mpm_bond_law(const mpm_bond *b, mpm_real amount, mpm_real dt, int64_t *tally)
{
    mpm_real factor;
    if (!(amount > 0)) return 0;
    factor = 1 - mpm_log(amount / (b->critical_rate * dt));
    if (factor < b->floor) {
        factor = b->floor;
        mpm__bond_count(tally, MPM_TALLY_BOND_FLOOR);
    }
    mpm__bond_count(tally, MPM_TALLY_BOND_GROWTH);
    return amount / (b->critical * factor);
}

/* sqrt(3/2 s:s) of a point's stress. */
static inline mpm_real mpm__von_mises(const mpm_points *q, int32_t i)
{
    const mpm_real xx = q->stress[0][i], yy = q->stress[1][i], zz = q->stress[2][i];
    const mpm_real yz = q->stress[3][i], xz = q->stress[4][i], xy = q->stress[5][i];
    const mpm_real d = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
    return mpm_sqrt(d / 2 + 3 * (yz * yz + xz * xz + xy * xy));
}

MPM_API mpm_real mpm_bond_of_point(const mpm_bond *b, mpm_world *w, int32_t i)
{
    mpm_real amount;
    if (b->rule == MPM_BOND_NONE) return 0;
    if (b->rule == MPM_BOND_USER) {
        amount = b->grow(b->context, w, i);
        if (!(amount > 0)) return 0;
        mpm__bond_count(w->tally, MPM_TALLY_BOND_GROWTH);
        return amount;
    }
    amount = w->points.plastic_rate[i] * w->dt_last;
    if (b->rule == MPM_BOND_ENERGY)
        amount *= mpm__von_mises(&w->points, i) * (b->length > 0 ? b->length : w->desc.cell);
    return mpm_bond_law(b, amount, w->dt_last, w->tally);
}

/* The body other than `body` with most mass at a contact node. */
static inline int32_t mpm__bond_partner(const mpm_world *w, const mpm_node *node, int32_t body)
{
    int32_t n, best = -1;
    for (n = w->head[node->index]; n >= 0; n = w->node[n].next)
        if (w->node[n].body != body && (best < 0 || w->node[n].mass > w->node[best].mass)) best = n;
    return best < 0 ? -1 : w->node[best].body;
}

/* The contact node nearest to a point, as a place in its support, or -1. */
static inline int mpm__bond_nearest(const mpm_world *w, const mpm_support *s)
{
    int a, nearest = -1;
    for (a = 0; a < s->count; a++)
        if ((w->node[s->slot[a]].flags & MPM_NODE_CONTACT) && s->N[a] > (nearest < 0 ? 0 : s->N[nearest])) nearest = a;
    return nearest;
}

/* D of a surface point grows if it is in contact. */
static inline void mpm__bond_point(const mpm_bond *b, mpm_world *w, const mpm_run *r, int32_t i, mpm_real *partner)
{
    mpm_support s;
    mpm_real growth;
    int nearest;
    mpm_support_of(w, r, i, &s);
    nearest = mpm__bond_nearest(w, &s);
    if (nearest < 0) return;
    growth = mpm_bond_of_point(b, w, i);
    w->points.bond[i] += growth;
    if (partner && growth > 0)
        partner[i] = (mpm_real)(1 + mpm__bond_partner(w, &w->node[s.slot[nearest]], r->body));
}

MPM_API void mpm_bond_grow(const mpm_bond *b, mpm_world *w)
{
    const int noted = b->partner >= 0 && b->partner < w->desc.user_fields;
    mpm_real *partner = noted ? w->points.user[b->partner] : NULL;
    int32_t n, i;
    if (b->rule == MPM_BOND_NONE || w->pairs == 0) return;
    for (n = 0; n < w->runs; n++) {
        const mpm_run *r = &w->run[n];
        if (!(r->flags & MPM_NODE_CONTACT)) continue;
        for (i = r->first; i < r->first + r->count; i++)
            if (w->points.flags[i] & MPM_POINT_SURFACE) mpm__bond_point(b, w, r, i, partner);
    }
}

/* D of a surface point to the contact nodes around it. */
static inline void mpm__bond_spread(const mpm_bond *b, mpm_world *w, const mpm_run *r, int32_t i)
{
    const mpm_real D = w->points.bond[i];
    mpm_support s;
    int a;
    mpm_support_of(w, r, i, &s);
    for (a = 0; a < s.count; a++) {
        const mpm_node *n = &w->node[s.slot[a]];
        const int32_t touch = n->touch;
        if (!(n->flags & MPM_NODE_CONTACT) || !(s.N[a] > 0)) continue;
        w->touch[touch].work[0] += b->average == MPM_BOND_MEAN ? D : D * s.N[a];
        w->touch[touch].work[1] += b->average == MPM_BOND_WEIGHTED ? s.N[a] : 1;
    }
}

MPM_API mpm_real mpm_bond_of_pair(const mpm_bond *b, const mpm_world *w, const mpm_pair *pair)
{
    const mpm_real *a = w->touch[w->node[pair->a].touch].work, *c = w->touch[w->node[pair->b].touch].work;
    const mpm_real D = ((a[1] > 0 ? a[0] / a[1] : 0) + (c[1] > 0 ? c[0] / c[1] : 0)) / 2;
    return b->decide ? b->decide(b->context, w, pair, D) : D;
}

/* The share of its separating momentum by which a pair of nodal D is held. */
static inline mpm_real mpm__bond_share(mpm_real D, mpm_real width)
{
    mpm_real share;
    if (!(width > 0)) return D >= 1 ? MPM_R(1.0) : MPM_R(0.0);
    share = (D - 1) / width + MPM_R(0.5);
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

MPM_API void mpm_bond_nodes(const mpm_bond *b, mpm_world *w)
{
    int32_t n, i;
    if (w->pairs == 0) return;
    for (n = 0; n < w->runs; n++) {
        const mpm_run *r = &w->run[n];
        if (!(r->flags & MPM_NODE_CONTACT)) continue;
        for (i = r->first; i < r->first + r->count; i++)
            if (w->points.flags[i] & MPM_POINT_SURFACE) mpm__bond_spread(b, w, r, i);
    }
    for (i = 0; i < w->pairs; i++) {
        mpm_pair *pair = &w->pair[i];
        pair->hold = mpm__bond_share(mpm_bond_of_pair(b, w, pair), b->width);
        if (!(b->strength > 0)) continue;
        pair->limit = b->strength * (mpm_real)mpm_pair_area(w, pair) * w->dt;
        if (!(pair->limit > 0)) pair->hold = 0;
    }
}

MPM_API mpm_status mpm_bond_step(const mpm_bond *b, mpm_world *w, mpm_real dt)
{
    mpm_status s = mpm_locate(w, dt), stressed;
    if (s < 0) return s;
    mpm_calm(w);
    mpm_to_nodes(w);
    mpm_grid_update(w);
    mpm_contact_find(w);
    mpm_bond_grow(b, w);
    mpm_bond_nodes(b, w);
    mpm_contact_apply(w);
    mpm_to_points(w);
    stressed = mpm_stress_and_move(w);
    return stressed < 0 ? stressed : s;
}

/* ---- measures ------------------------------------------------------------------------------- */

/* Adds the contacted surface points of a body, all or those whose partner is `other`. */
static inline void mpm__measure_add(const mpm_world *w, int32_t body, const mpm_real *partner, int32_t other,
                                    mpm_bond_measure *m)
{
    const mpm_points *q = &w->points;
    const mpm_body *b = &w->body[body];
    const double column = (double)(b->desc.density * b->desc.spacing);
    int32_t i;
    for (i = b->first; i < b->first + b->count; i++) {
        const double mass = (double)q->mass[i];
        if (!(q->flags[i] & MPM_POINT_SURFACE) || !(q->bond[i] > 0)) continue;
        if (partner && (int32_t)partner[i] != other + 1) continue;
        m->contacted++;
        m->contacted_mass += mass;
        m->contacted_area += mass / column;
        m->abp += mass / column * (double)q->bond[i];
        if (q->bond[i] < 1) continue;
        m->bonded++;
        m->bonded_mass += mass;
        m->bonded_area += mass / column;
    }
}

/* Sums to means. */
static inline void mpm__measure_end(mpm_bond_measure *m)
{
    if (!m->contacted) return;
    m->pbcp = 100.0 * m->bonded_area / m->contacted_area;
    m->abp /= m->contacted_area;
}

MPM_API mpm_bond_measure mpm_bond_measure_body(const mpm_world *w, int32_t body)
{
    const int32_t from = body < 0 ? 0 : body, to = body < 0 ? w->bodies : body + 1;
    mpm_bond_measure m;
    int32_t b;
    memset(&m, 0, sizeof m);
    for (b = from; b < to; b++) mpm__measure_add(w, b, NULL, 0, &m);
    mpm__measure_end(&m);
    return m;
}

MPM_API mpm_status mpm_bond_measure_pair(const mpm_bond *rule, const mpm_world *w, int32_t a, int32_t b,
                                         mpm_bond_measure *m)
{
    memset(m, 0, sizeof *m);
    if (rule->partner < 0 || rule->partner >= w->desc.user_fields) return MPM_ERR_ARGUMENT;
    if (a < 0 || b < 0 || a >= w->bodies || b >= w->bodies || a == b) return MPM_ERR_ARGUMENT;
    mpm__measure_add(w, a, w->points.user[rule->partner], b, m);
    mpm__measure_add(w, b, w->points.user[rule->partner], a, m);
    mpm__measure_end(m);
    return MPM_OK;
}

#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */
