/* mpm_surface.h - bodies that meet where their surfaces are, not where they share a node. Version 0.2.0.
   SPDX-License-Identifier: MIT

   DO THIS
     #define MPM_IMPLEMENTATION in ONE file, then include mpm.h and mpm_surface.h there; "mpm_surface.h" alone
     everywhere else. Add the bodies to a world, then mpm_surface_add for each that shall touch others, and step with
     mpm_surface_step. Link with -lm. Two dimensions: plane strain and axisymmetry.

   A COMPLETE PROGRAM (two elastic bars meet head-on at 10 m/s each; prints what the upper one leaves with, in m/s)
       #define MPM_IMPLEMENTATION
       #include "mpm.h"
       #include "mpm_ptw.h"
       #include "mpm_surface.h"
       #include <stdio.h>
       int main(void) {
           mpm_units u = mpm_units_um_us_ng();
           mpm_body_desc b = mpm_body_desc_default();
           mpm_surfaces s = mpm_surfaces_default();
           mpm_desc d = mpm_desc_default();
           mpm_material al;
           mpm_world w;
           int32_t k;
           d.geometry = MPM_PLANE_STRAIN; d.basis = MPM_CUBIC; d.cell = 1;
           d.cells[0] = 2; d.cells[2] = 40; d.origin[2] = -20;
           d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
           if (mpm_material_preset(&al, "al", &u, NULL) < 0 || mpm_material_model(&al, "elastic", NULL) < 0) return 1;
           b.spacing = 0.5; b.density = al.density; b.stress = mpm_material_stress; b.material = &al;
           mpm_material_wave_speeds(&al, al.density, &b.wave_p, &b.wave_s);
           if (mpm_init(&w, &d, NULL, 0) < 0) return 1;
           for (k = 0; k < 2; k++) {
               b.shape = k ? mpm_box(0, 0, -10.1, 2, 1, -0.1) : mpm_box(0, 0, 0.1, 2, 1, 10.1);
               b.velocity[2] = k ? 10 : -10;
               if (mpm_body_add(&w, &b) < 0 || mpm_surface_add(&s, &w, k) < 0) return 1;
           }
           while (w.time < 0.03)
               if (mpm_surface_step(&s, &w, mpm_time_step(&w, 0.1)) < 0) return 1;
           printf("%.1f m/s\n", mpm_body_totals(&w, 0).momentum[2] / mpm_body_totals(&w, 0).mass);
           mpm_surfaces_free(&s);
           mpm_free(&w);
           return 0;
       }

   HOW IT WORKS
     Each body carries its outline: a chain of massless markers, moved by the body's own grid (mpm_surface_move). A
     marker finds the nearest place of another body's chain. Where the gap to it is negative, a pressure in proportion
     to it, and to the speed at which it closes, acts on both chains, from these on their own grids
     (mpm_surface_contact). Nothing is compared between two bodies' grids, so that next to nothing hangs on where their
     nodes lie. Contact at nodes takes no part: use splines (desc.basis = MPM_CUBIC), whose fields are smooth at a
     surface.

   CONTENTS
     describing      mpm_surfaces_default, mpm_surface_add, mpm_surface_add_chain, mpm_surface_wall_add
     the step        mpm_surface_step = the phases of mpm.h with mpm_surface_contact and mpm_surface_move
     looking at it   mpm_surface_meets: who touches whom, and how hard; mpm_surface_adhesion of one meeting

   ADHESION (on request: surfaces.adhesion > 0)
     Plastic work in a layer of a physical depth l under both surfaces, from the first touch on, is the interface's
     dissipation G of each marker's meeting:
       dG = l (d<w_p> of this body + d<w_p> of the other),  <w_p>: mean over the points of depth < l that were within l
       along the surface at first, weight (1 - q)^2 (1 + 2 q)                                                    (S4)
     Where it exceeds G_c it leaves an adhesion of W = W0 (G/G_c - 1) per area: a traction 2 W/delta_c at most, spent
     when drawn open by delta_c (S5). It belongs to the two bodies that met, and costs what it takes: ledger.hold.

   WHAT IT DOES NOT DO: surfaces of three-dimensional bodies; contact of a body with itself; more than two other bodies
   at a marker; checkpoints of surfaces.

   Sources: penalty between a surface's points and another's faces, taken both ways, and friction by a spring that
   slips: Wriggers, Computational Contact Mechanics, Springer (2006). */
#ifndef MPM_SURFACE_H
#define MPM_SURFACE_H

#include "mpm.h"
#if MPM_VERSION_NUMBER != 200
#error "mpm_surface.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_surfaces_default mpm_surfaces_default_f32
#define mpm_surfaces_check mpm_surfaces_check_f32
#define mpm_surfaces_free mpm_surfaces_free_f32
#define mpm_surface_add mpm_surface_add_f32
#define mpm_surface_add_chain mpm_surface_add_chain_f32
#define mpm_surface_wall_add mpm_surface_wall_add_f32
#define mpm_surface_contact mpm_surface_contact_f32
#define mpm_surface_move mpm_surface_move_f32
#define mpm_surface_step mpm_surface_step_f32
#define mpm_surface_meets mpm_surface_meets_f32
#define mpm_surface_adhesion mpm_surface_adhesion_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define MPM_SURFACE_MEETS 2  /* other bodies that a marker can touch at a time */
#define MPM_SURFACE_WALLS 4  /* rigid walls */

/* A marker's meeting with another body or a wall. */
typedef struct mpm_meet {
    int32_t other;        /* its surface's number; -1 - k: wall k; MPM_SURFACE_NONE: nobody */
    int32_t face;         /* nearest face of it, and where on that: (1 - u) first + u second marker */
    mpm_real u;
    mpm_real gap, rate;   /* from the other's surface, along its normal, > 0: apart [length]; its rate */
    mpm_real normal[3];   /* unit, out of the other */
    mpm_real pressure;    /* >= 0 */
    mpm_real slip[3];     /* what the spring of friction holds of the way that the marker has slid [length] */
    mpm_real drawn[3];    /* how far the marker has slid since it was pressed last, against adhesion [length] */
    int touched;          /* 1: it was pressed once (with adhesion) */
    mpm_real dissipated;  /* G: plastic work in the layer on both sides since then, over its area [energy/area] */
    mpm_real opened;      /* how far its adhesion was drawn open since it was pressed last, at most [length] */
    mpm_real tension[3];  /* traction of adhesion on the marker now [stress] */
} mpm_meet;

#define MPM_SURFACE_NONE (-1000)

/* A massless point of a surface. */
typedef struct mpm_marker {
    mpm_real x[3], v[3];  /* position, and velocity of its own body's grid there */
    mpm_real normal[3];   /* unit, out of the body */
    mpm_real area;        /* what of the surface it stands for, now [length^2; per depth in plane strain] */
    mpm_real along;       /* its place on the surface as it was at first: length of the way to it */
    mpm_real force[3];    /* contact with all other bodies in this step */
    mpm_real pull[3];     /* adhesion to them */
    mpm_real wall[3];     /* from walls */
    mpm_meet meet[MPM_SURFACE_MEETS];
} mpm_marker;

/* The layer under a surface whose plastic work makes adhesion: at stations, the first places of the markers, means over
   the points near them, in the body as it was at first. */
typedef struct mpm_layer {
    int32_t stations, points; /* 0: none */
    int32_t first_id;         /* of the body's points */
    mpm_real round;           /* length of a closed surface; 0: an open one */
    mpm_real *along;          /* per station: length of the way to it, rising */
    mpm_real *mean, *change;  /* plastic work per volume, and what it has grown by since the look before [stress] */
    int32_t *begin;           /* per station, and one more: its entries */
    int32_t *point;           /* per entry: number of the point, less first_id */
    mpm_real *weight;         /* of it; they sum to 1 */
    int32_t *where;           /* per point: its index now, -1: retired */
} mpm_layer;

/* The surface of one body: markers joined by faces. The body lies to the left of a face's way from its first to its
   second marker, with x to the right and z up. */
typedef struct mpm_surface {
    int32_t body;
    int32_t markers, faces;
    int32_t marker_capacity, face_capacity;
    mpm_marker *marker;
    int32_t (*face)[2];
    int32_t (*around)[2]; /* per marker: the faces that it ends and begins, -1: none */
    mpm_layer layer;
} mpm_surface;

/* A rigid half space. */
typedef struct mpm_surface_wall {
    mpm_real point[3], normal[3]; /* a place on it; unit, out of it */
    mpm_real velocity[3];
} mpm_surface_wall;

/* All surfaces of a world and how they meet. Start from mpm_surfaces_default. */
typedef struct mpm_surfaces {
    unsigned mark;
    mpm_real stiffness;   /* of the penalty, in rho c_p^2 / cell of the softer body, > 0 */
    mpm_real damping;     /* in rho c_p, >= 0 */
    mpm_real friction;    /* Coulomb coefficient, >= 0 */
    mpm_real softening;   /* eps of (S1): weight of nodes whose mass is small beside rho cell^3, > 0 */
    mpm_real longest;     /* faces longer than this many cells are halved, > 0 */
    mpm_real adhesion;    /* W0 [energy/area]: W = W0 (G/G_c - 1) where G exceeds G_c; 0: none. Set before surfaces are
                             added: those added without it have no layer, and no share in G */
    mpm_real critical;    /* G_c [energy/area], > 0 with adhesion */
    mpm_real depth;       /* l: thickness of the layer on each side, and reach of its means along it [length] */
    mpm_real reach;       /* delta_c: how far adhesion is drawn open before it is spent [length] */
    int both;             /* 1: the markers of both bodies meet the other, with half the weight; 0: of the first */
    int renew;            /* steps from one full search to the next; in between neighbours are tried, >= 1 */
    mpm_surface *surface;
    int32_t surfaces, capacity;
    mpm_surface_wall wall[MPM_SURFACE_WALLS];
    int walls;
    int64_t steps;        /* since the first */
    int32_t *bucket, *next; /* search: first face of a cell, next face of the same */
    int32_t buckets, bucket_room, nexts;
    mpm_fault fault;
} mpm_surfaces;

/* Penalty 5 rho c^2/cell and damper rho c, both ways, no friction, no walls. Test: 33_surface. */
MPM_API mpm_surfaces mpm_surfaces_default(void);

/* MPM_ERR_ARGUMENT / NAN: a field out of its range, by name in fault (may be NULL). Test: 33_surface. */
MPM_API mpm_status mpm_surfaces_check(const mpm_surfaces *s, mpm_fault *fault);

/* Gives the memory back; s is then as from mpm_surfaces_default but for its parameters. Test: 33_surface. */
MPM_API void mpm_surfaces_free(mpm_surfaces *s);

/* The outline of a body's shape (ellipsoid, cylinder or box), with a marker every half spacing; what lies behind a
   symmetry plane is cut off. Before the body has moved. MPM_ERR_ARGUMENT: no such body, one of another shape, three
   dimensions, or the body has a surface; MPM_ERR_MEMORY. Test: 33_surface. */
MPM_API mpm_status mpm_surface_add(mpm_surfaces *s, const mpm_world *w, int32_t body);

/* A surface of the caller's: n places x, z [length], joined in order, the last with the first if closed, the body to
   the left. MPM_ERR_ARGUMENT / NAN: as above, fewer than two places, or a place that is not finite, its number in
   fault.index; MPM_ERR_MEMORY. Test: 33_surface. */
MPM_API mpm_status mpm_surface_add_chain(mpm_surfaces *s, const mpm_world *w, int32_t body, int32_t n,
                                         const mpm_real *x, const mpm_real *z, int closed);

/* A rigid half space: below a plane through `point` with the normal out of it. MPM_ERR_ARGUMENT: the normal has no
   length; MPM_ERR_FULL: there are MPM_SURFACE_WALLS. Test: 33_surface. */
MPM_API mpm_status mpm_surface_wall_add(mpm_surfaces *s, const mpm_real point[3], const mpm_real normal[3]);

/* Finds who meets whom and puts the forces on the nodes; world.held counts the markers' meetings that adhesion draws
   together. Between mpm_forces and mpm_grid_update. Errors as mpm_surfaces_check; MPM_ERR_MEMORY.
   Test: 33_surface. */
MPM_API mpm_status mpm_surface_contact(mpm_surfaces *s, mpm_world *w);

/* Moves the markers as their bodies' matter moves, with MUSL's velocity (with that of P(k+1) the penalty would take
   energy: light nodes at a surface are kicked in every step), books the work of contact (in ledger.contact: what it
   took, the penalty's stored part included) and halves long faces. Between mpm_musl and mpm_move. MPM_ERR_NAN: the
   place of a marker, its number in fault.index; MPM_ERR_MEMORY.
   Test: 33_surface. */
MPM_API mpm_status mpm_surface_move(mpm_surfaces *s, mpm_world *w);

/* The step of mpm.h, of dt [time] > 0, with contact on surfaces in place of contact at nodes. Errors as mpm_step,
   mpm_surface_contact and mpm_surface_move, with the fault in the world. Test: 33_surface. */
MPM_API mpm_status mpm_surface_step(mpm_surfaces *s, mpm_world *w, mpm_real dt);

/* How surface a meets surface b (-1: any other body), in the last step. */
typedef struct mpm_meeting {
    double area;         /* under pressure [length^2] */
    double force[3];     /* on a: pressure alone */
    double pull[3];      /* on a: adhesion */
    double pressure_max;
    double gap_min;      /* deepest (negative: penetration) or nearest; the cell if they are further apart */
    double touched;      /* with adhesion: area that was ever pressed, its mean G [energy/area], */
    double dissipated;
    double bonded;       /* ... the part of it with adhesion that is not spent; what it takes to part that [energy] */
    double adhesion;
} mpm_meeting;

/* Between steps, from the markers of a (one of the surfaces) and of b together. Test: 33_surface. */
MPM_API mpm_meeting mpm_surface_meets(const mpm_surfaces *s, const mpm_world *w, int32_t a, int32_t b);

/* W [energy/area], the adhesion of a marker's meeting: 0 where G is below G_c, or it is spent. Test: 33_surface. */
MPM_API mpm_real mpm_surface_adhesion(const mpm_surfaces *s, const mpm_meet *meet);

#ifdef __cplusplus
}
#endif

#endif /* MPM_SURFACE_H */

/* ================================================================================================ */

#if defined(MPM_IMPLEMENTATION) && !defined(MPM_SURFACE_IMPLEMENTED)
#define MPM_SURFACE_IMPLEMENTED

#include <string.h>

#define MPM__LAYER_STEPS 4 /* from one look at the layers to the next */

#ifdef __cplusplus
extern "C" {
#endif

/* ---- parameters and memory --------------------------------------------------------------------- */

MPM_API mpm_surfaces mpm_surfaces_default(void)
{
    mpm_surfaces s;
    memset(&s, 0, sizeof s);
    s.mark = MPM_MARK;
    s.stiffness = 5;
    s.damping = 1;
    s.softening = MPM_R(0.002);
    s.longest = MPM_R(0.5);
    s.both = 1;
    s.renew = 20;
    return s;
}

MPM_API mpm_status mpm_surfaces_check(const mpm_surfaces *s, mpm_fault *f)
{
    mpm_status st = mpm_want(s->mark == MPM_MARK, f, "surfaces (not from mpm_surfaces_default)", 0, -1);
    if (st == MPM_OK) st = mpm_want(s->stiffness > 0, f, "stiffness", s->stiffness, -1);
    if (st == MPM_OK) st = mpm_want(s->damping >= 0, f, "damping", s->damping, -1);
    if (st == MPM_OK) st = mpm_want(s->friction >= 0, f, "friction", s->friction, -1);
    if (st == MPM_OK) st = mpm_want(s->softening > 0, f, "softening", s->softening, -1);
    if (st == MPM_OK) st = mpm_want(s->longest > 0, f, "longest", s->longest, -1);
    if (st == MPM_OK) st = mpm_want(s->adhesion >= 0, f, "adhesion", s->adhesion, -1);
    if (st == MPM_OK && s->adhesion > 0) st = mpm_want(s->critical > 0, f, "critical", s->critical, -1);
    if (st == MPM_OK && s->adhesion > 0) st = mpm_want(s->depth > 0, f, "depth", s->depth, -1);
    if (st == MPM_OK && s->adhesion > 0) st = mpm_want(s->reach > 0, f, "reach", s->reach, -1);
    return st != MPM_OK ? st : mpm_want(s->renew >= 1, f, "renew", (mpm_real)s->renew, -1);
}

static inline void mpm__surface_release(void *p)
{
    if (p) MPM_FREE(p);
}

/* Gives back what a surface holds. */
static inline mpm_status mpm__surface_drop(mpm_surface *c, mpm_status st)
{
    mpm__surface_release(c->marker);
    mpm__surface_release(c->face);
    mpm__surface_release(c->around);
    mpm__surface_release(c->layer.along);
    mpm__surface_release(c->layer.begin);
    mpm__surface_release(c->layer.point);
    mpm__surface_release(c->layer.weight);
    return st;
}

MPM_API void mpm_surfaces_free(mpm_surfaces *s)
{
    int32_t i;
    for (i = 0; i < s->surfaces; i++) mpm__surface_drop(&s->surface[i], MPM_OK);
    mpm__surface_release(s->surface);
    mpm__surface_release(s->bucket);
    mpm__surface_release(s->next);
    s->surface = NULL;
    s->bucket = s->next = NULL;
    s->surfaces = s->capacity = s->buckets = s->bucket_room = s->nexts = 0;
    s->walls = 0;
    s->steps = 0;
}

/* Memory for n entries of `size` bytes, with those of `old` that are in use; `old` itself if it has the room, NULL if
   there is none to be had. */
static inline void *mpm__surface_room(void *old, int32_t *capacity, int32_t used, int32_t n, size_t size)
{
    const int32_t room = n + n / 2 + 16;
    void *more;
    if (n <= *capacity) return old;
    more = MPM_MALLOC((size_t)room * size);
    if (!more) return NULL;
    if (used > 0) memcpy(more, old, (size_t)used * size);
    mpm__surface_release(old);
    *capacity = room;
    return more;
}

static inline mpm_status mpm__surface_full(mpm_fault *f, int32_t n)
{
    return mpm_fail(f, MPM_ERR_MEMORY, "room for markers of a surface", (mpm_real)n, -1);
}

/* Room in one surface; there are as many `around` as markers. */
static inline mpm_status mpm__surface_grow(mpm_surface *c, int32_t markers, int32_t faces, mpm_fault *f)
{
    int32_t capacity = c->marker_capacity;
    void *p = mpm__surface_room(c->marker, &capacity, c->markers, markers, sizeof c->marker[0]);
    if (!p) return mpm__surface_full(f, markers);
    c->marker = (mpm_marker *)p;
    p = mpm__surface_room(c->around, &c->marker_capacity, c->markers, markers, sizeof c->around[0]);
    if (!p) return mpm__surface_full(f, markers);
    c->around = (int32_t(*)[2])p;
    p = mpm__surface_room(c->face, &c->face_capacity, c->faces, faces, sizeof c->face[0]);
    if (!p) return mpm__surface_full(f, faces);
    c->face = (int32_t(*)[2])p;
    return MPM_OK;
}

/* ---- making a chain ------------------------------------------------------------------------------ */

/* Marker i of n, and the face from it to the next. */
static inline void mpm__surface_put(mpm_surface *c, int32_t i, int32_t n, mpm_real x, mpm_real z)
{
    mpm_marker *m = &c->marker[i];
    int k;
    memset(m, 0, sizeof *m);
    m->x[0] = x;
    m->x[2] = z;
    for (k = 0; k < MPM_SURFACE_MEETS; k++) m->meet[k].other = MPM_SURFACE_NONE;
    c->face[i][0] = i;
    c->face[i][1] = i + 1 < n ? i + 1 : 0;
}

/* Which faces end and begin at each marker. */
static inline void mpm__surface_join(mpm_surface *c)
{
    int32_t i;
    for (i = 0; i < c->markers; i++) c->around[i][0] = c->around[i][1] = -1;
    for (i = 0; i < c->faces; i++) {
        c->around[c->face[i][0]][1] = i;
        c->around[c->face[i][1]][0] = i;
    }
}

/* What a ring at radius r is longer than a marker; 1 in plane strain. */
static inline mpm_real mpm__surface_ring(const mpm_world *w, mpm_real r)
{
    return w->desc.geometry == MPM_AXISYMMETRIC ? 2 * MPM_PI * r : 1;
}

/* Where side d of the grid lies, and whether x is on it. */
static inline mpm_real mpm__surface_side(const mpm_world *w, int d)
{
    const int axis = d / 2;
    return w->desc.origin[axis] + (d & 1 ? (mpm_real)w->desc.cells[axis] * w->desc.cell : 0);
}

static inline int mpm__surface_on_side(const mpm_world *w, int d, const mpm_real *x)
{
    const mpm_real from = x[d / 2] - mpm__surface_side(w, d), hair = MPM_R(1e-5) * w->desc.cell;
    return from < hair && from > -hair;
}

/* Area and normal of all markers, from the faces as they lie: linear along each. */
static inline void mpm__surface_measure(const mpm_world *w, mpm_surface *c)
{
    int32_t i;
    int k, d;
    for (i = 0; i < c->markers; i++) {
        c->marker[i].area = 0;
        for (d = 0; d < 3; d++) c->marker[i].normal[d] = 0;
    }
    for (i = 0; i < c->faces; i++) {
        mpm_marker *a = &c->marker[c->face[i][0]], *b = &c->marker[c->face[i][1]];
        const mpm_real tx = b->x[0] - a->x[0], tz = b->x[2] - a->x[2], length = mpm_sqrt(tx * tx + tz * tz);
        const mpm_real ra = mpm__surface_ring(w, a->x[0]), rb = mpm__surface_ring(w, b->x[0]);
        a->area += length * (2 * ra + rb) / 6;
        b->area += length * (ra + 2 * rb) / 6;
        for (k = 0; k < 2; k++) {
            c->marker[c->face[i][k]].normal[0] += tz;
            c->marker[c->face[i][k]].normal[2] -= tx;
        }
    }
    for (i = 0; i < c->markers; i++) {
        mpm_marker *m = &c->marker[i];
        mpm_real length;
        for (d = 0; d < 6; d++) /* on a mirror the other half takes that component away */
            if (w->desc.side[d] == MPM_SIDE_SYMMETRY && mpm__surface_on_side(w, d, m->x)) m->normal[d / 2] = 0;
        length = mpm_sqrt(m->normal[0] * m->normal[0] + m->normal[2] * m->normal[2]);
        for (d = 0; d < 3; d++) m->normal[d] = length > 0 ? m->normal[d] / length : 0;
    }
}

/* A new surface of body `body`, still empty, in `s`. */
static inline mpm_surface *mpm__surface_new(mpm_surfaces *s, const mpm_world *w, int32_t body, mpm_status *st)
{
    mpm_fault *f = &s->fault;
    void *more;
    int32_t i;
    *st = mpm_surfaces_check(s, f);
    if (*st == MPM_OK)
        *st = mpm_want(w->desc.geometry != MPM_3D, f, "geometry (surfaces are of two dimensions)", 0, -1);
    if (*st == MPM_OK) *st = mpm_want(body >= 0 && body < w->bodies, f, "body", (mpm_real)body, -1);
    for (i = 0; i < s->surfaces && *st == MPM_OK; i++)
        *st = mpm_want(s->surface[i].body != body, f, "body (it has a surface)", (mpm_real)body, -1);
    if (*st == MPM_OK)
        *st = mpm_want(w->body[body].desc.wave_p > 0, f, "wave_p of body (its contact would have no stiffness)",
                       w->body[body].desc.wave_p, body);
    if (*st != MPM_OK) return NULL;
    more = mpm__surface_room(s->surface, &s->capacity, s->surfaces, s->surfaces + 1, sizeof s->surface[0]);
    if (!more) {
        *st = mpm__surface_full(f, s->surfaces + 1);
        return NULL;
    }
    s->surface = (mpm_surface *)more;
    memset(&s->surface[s->surfaces], 0, sizeof s->surface[0]);
    s->surface[s->surfaces].body = body;
    return &s->surface[s->surfaces];
}

/* Takes off what lies behind side d of the grid: faces on the plane or beyond; one that crosses it ends there. */
static inline void mpm__surface_cut(const mpm_world *w, mpm_surface *c, int d)
{
    const int axis = d / 2;
    const mpm_real inward = d & 1 ? MPM_R(-1.0) : MPM_R(1.0), plane = mpm__surface_side(w, d);
    const mpm_real hair = MPM_R(1e-5) * w->desc.cell;
    int32_t i, n = 0;
    for (i = 0; i < c->faces; i++) {
        mpm_marker *a = &c->marker[c->face[i][0]], *b = &c->marker[c->face[i][1]];
        const mpm_real ha = inward * (a->x[axis] - plane), hb = inward * (b->x[axis] - plane);
        const mpm_real u = ha / (ha - hb);
        if (ha < hair && hb < hair) continue;
        if (ha < 0 || hb < 0) { /* the marker behind moves along the face to the plane */
            mpm_marker *out = ha < 0 ? a : b;
            out->x[2 - axis] = (1 - u) * a->x[2 - axis] + u * b->x[2 - axis];
            out->x[axis] = plane;
        }
        c->face[n][0] = c->face[i][0];
        c->face[n++][1] = c->face[i][1];
    }
    c->faces = n;
}

/* Drops markers that no face has, the others in their order. */
static inline void mpm__surface_pack(mpm_surface *c)
{
    int32_t i, n = 0;
    mpm__surface_join(c);
    for (i = 0; i < c->markers; i++) {
        if (c->around[i][0] < 0 && c->around[i][1] < 0) continue;
        if (c->around[i][0] >= 0) c->face[c->around[i][0]][1] = n;
        if (c->around[i][1] >= 0) c->face[c->around[i][1]][0] = n;
        c->marker[n++] = c->marker[i];
    }
    c->markers = n;
    mpm__surface_join(c);
}

/* The place on a face nearest to x: u, and the distance squared. */
static inline mpm_real mpm__surface_nearest(const mpm_surface *c, int32_t face, const mpm_real *x, mpm_real *u)
{
    const mpm_real *a = c->marker[c->face[face][0]].x, *b = c->marker[c->face[face][1]].x;
    const mpm_real tx = b[0] - a[0], tz = b[2] - a[2], square = tx * tx + tz * tz;
    mpm_real at = square > 0 ? ((x[0] - a[0]) * tx + (x[2] - a[2]) * tz) / square : 0, dx, dz;
    at = at < 0 ? 0 : at > 1 ? 1 : at;
    dx = a[0] + at * tx - x[0];
    dz = a[2] + at * tz - x[2];
    *u = at;
    return dx * dx + dz * dz;
}

/* ---- the layer under a surface ------------------------------------------------------------------- */

/* Numbers the way along a part of the surface from marker `from` on. Returns the way at its end; the layer is round if
   it leads back to where it began. */
static inline mpm_real mpm__layer_part(mpm_surface *c, int32_t from, mpm_real way)
{
    while (c->marker[from].along < 0) {
        const int32_t face = c->around[from][1], to = face < 0 ? from : c->face[face][1];
        const mpm_real x = c->marker[to].x[0] - c->marker[from].x[0], z = c->marker[to].x[2] - c->marker[from].x[2];
        c->marker[from].along = way;
        way += mpm_sqrt(x * x + z * z);
        from = to;
    }
    if (c->around[from][1] >= 0) c->layer.round = way;
    return way;
}

/* Numbers all parts: from open ends, a reach of the means apart, or a closed one from its first marker. */
static inline void mpm__layer_way(mpm_surface *c, mpm_real depth)
{
    mpm_real way = 0;
    int32_t i;
    for (i = 0; i < c->markers; i++) c->marker[i].along = -1;
    for (i = 0; i < c->markers; i++)
        if (c->around[i][0] < 0) way = mpm__layer_part(c, i, way) + depth;
    if (c->marker[0].along < 0) mpm__layer_part(c, 0, 0);
}

/* Distance along the surface. */
static inline mpm_real mpm__layer_apart(const mpm_layer *y, mpm_real a, mpm_real b)
{
    const mpm_real d = a > b ? a - b : b - a;
    return y->round > 0 && d > y->round / 2 ? y->round - d : d;
}

/* The place between two neighbours; at the seam of a closed surface the nearer of them. */
static inline mpm_real mpm__layer_between(const mpm_layer *y, mpm_real a, mpm_real b, mpm_real u)
{
    const mpm_real d = a > b ? a - b : b - a;
    if (y->round > 0 && d > y->round / 2) return u < MPM_R(0.5) ? a : b;
    return (1 - u) * a + u * b;
}

/* Where the point at x has its foot on the surface, and how deep it lies below. */
static inline mpm_real mpm__layer_foot(const mpm_surface *c, const mpm_real *x, mpm_real *along)
{
    mpm_real nearest = 0, u = 0, square;
    int32_t i, best = -1;
    for (i = 0; i < c->faces; i++) {
        square = mpm__surface_nearest(c, i, x, &u);
        if (best >= 0 && !(square < nearest)) continue;
        nearest = square;
        best = i;
        *along = c->marker[c->face[i][u < MPM_R(0.5) ? 0 : 1]].along; /* good to half a face */
    }
    return mpm_sqrt(nearest);
}

/* Weight of a point at q reaches from a station: (1 - q)^2 (1 + 2 q). */
static inline mpm_real mpm__layer_weight(mpm_real q) { return q < 1 ? (1 - q) * (1 - q) * (1 + 2 * q) : 0; }

/* The stations of a new layer: the markers' ways, rising. They come so but for where parts begin. */
static inline mpm_status mpm__layer_stations(mpm_surface *c, mpm_fault *f)
{
    mpm_layer *y = &c->layer;
    const size_t n = (size_t)c->markers;
    int32_t i, k;
    y->along = (mpm_real *)MPM_MALLOC(3 * n * sizeof *y->along);
    y->begin = (int32_t *)MPM_MALLOC((n + 1) * sizeof *y->begin);
    if (!y->along || !y->begin) return mpm__surface_full(f, c->markers);
    y->stations = c->markers;
    y->mean = y->along + n;
    y->change = y->mean + n;
    memset(y->mean, 0, 2 * n * sizeof *y->mean);
    for (i = 0; i < c->markers; i++) {
        for (k = i; k > 0 && y->along[k - 1] > c->marker[i].along; k--) y->along[k] = y->along[k - 1];
        y->along[k] = c->marker[i].along;
    }
    return MPM_OK;
}

/* Visits the points of a body that lie within the layer: counts their entries at all stations, or writes them. */
static inline int32_t mpm__layer_visit(const mpm_surfaces *s, const mpm_world *w, mpm_surface *c, const mpm_real *foot,
                                       int write)
{
    const mpm_body *b = &w->body[c->body];
    mpm_layer *y = &c->layer;
    int32_t k, i, n = 0;
    for (k = 0; k < y->stations; k++) {
        mpm_real sum = 0;
        const int32_t from = n;
        for (i = 0; i < b->count; i++) {
            mpm_real part = 0;
            if (foot[i] >= 0) part = mpm__layer_weight(mpm__layer_apart(y, foot[i], y->along[k]) / s->depth);
            if (!(part > 0)) continue;
            if (write) {
                y->point[n] = w->points.id[b->first + i] - y->first_id;
                y->weight[n] = w->points.mass[b->first + i] * part;
                sum += y->weight[n];
            }
            n++;
        }
        if (!write) continue;
        y->begin[k] = from;
        for (i = from; i < n; i++) y->weight[i] /= sum;
    }
    if (write) y->begin[y->stations] = n;
    return n;
}

/* The points' feet on the surface: how far along it, -1 where they lie deeper than the layer; and their numbers. */
static inline void mpm__layer_feet(const mpm_surfaces *s, const mpm_world *w, mpm_surface *c, mpm_real *foot)
{
    const mpm_body *b = &w->body[c->body];
    int32_t i;
    int d;
    c->layer.points = b->count;
    c->layer.first_id = b->count > 0 ? w->points.id[b->first] : 0;
    for (i = 0; i < b->count; i++) {
        mpm_real x[3];
        if (w->points.id[b->first + i] < c->layer.first_id) c->layer.first_id = w->points.id[b->first + i];
        for (d = 0; d < 3; d++) x[d] = w->points.x[d][b->first + i];
        if (!(mpm__layer_foot(c, x, &foot[i]) < s->depth)) foot[i] = -1;
    }
}

/* The layer of a new surface, from the points as they lie. */
static inline mpm_status mpm__layer_make(mpm_surfaces *s, const mpm_world *w, mpm_surface *c)
{
    const size_t points = (size_t)w->body[c->body].count;
    mpm_layer *y = &c->layer;
    mpm_real *foot = (mpm_real *)MPM_MALLOC((points + 1) * sizeof *foot);
    mpm_status st = foot ? MPM_OK : mpm__surface_full(&s->fault, (int32_t)points);
    mpm__layer_way(c, s->depth);
    if (st == MPM_OK) st = mpm__layer_stations(c, &s->fault);
    if (st == MPM_OK) {
        size_t entries;
        mpm__layer_feet(s, w, c, foot);
        entries = (size_t)mpm__layer_visit(s, w, c, foot, 0);
        y->point = (int32_t *)MPM_MALLOC((entries + points + 1) * sizeof *y->point);
        y->weight = (mpm_real *)MPM_MALLOC((entries + 1) * sizeof *y->weight);
        if (!y->point || !y->weight) st = mpm__surface_full(&s->fault, (int32_t)entries);
        else y->where = y->point + entries;
    }
    if (st == MPM_OK) mpm__layer_visit(s, w, c, foot, 1);
    mpm__surface_release(foot);
    return st;
}

/* The means of a layer now, and what they have grown by since they were taken last. */
static inline void mpm__layer_update(const mpm_world *w, mpm_surface *c)
{
    const mpm_body *b = &w->body[c->body];
    mpm_layer *y = &c->layer;
    int32_t i, k;
    for (i = 0; i < y->points; i++) y->where[i] = -1;
    for (i = b->first; i < b->first + b->active; i++) {
        const int32_t number = w->points.id[i] - y->first_id;
        if (number >= 0 && number < y->points) y->where[number] = i;
    }
    for (k = 0; k < y->stations; k++) {
        mpm_real sum = 0;
        for (i = y->begin[k]; i < y->begin[k + 1]; i++)
            if (y->where[y->point[i]] >= 0) sum += y->weight[i] * w->points.plastic_work[y->where[y->point[i]]];
        y->change[k] = sum - y->mean[k];
        y->mean[k] = sum;
    }
}

/* What the layer has grown by at a place along it: linear between stations. */
static inline mpm_real mpm__layer_change(const mpm_layer *y, mpm_real along)
{
    int32_t low = 0, high = y->stations - 1;
    mpm_real u;
    if (y->stations == 0) return 0;
    while (high - low > 1) {
        const int32_t middle = (low + high) / 2;
        if (y->along[middle] > along) high = middle;
        else low = middle;
    }
    u = y->along[high] > y->along[low] ? (along - y->along[low]) / (y->along[high] - y->along[low]) : 0;
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    return (1 - u) * y->change[low] + u * y->change[high];
}

/* G of all meetings that have touched: dG = l (d<w_p> of this body + d<w_p> of the other where it is met). */
static inline void mpm__layer_grow(mpm_surfaces *s)
{
    int32_t a, i;
    int k;
    for (a = 0; a < s->surfaces; a++)
        for (i = 0; i < s->surface[a].markers; i++)
            for (k = 0; k < MPM_SURFACE_MEETS; k++) {
                mpm_marker *m = &s->surface[a].marker[i];
                mpm_meet *meet = &m->meet[k];
                const mpm_surface *c;
                mpm_real from, to;
                if (meet->other < 0 || !meet->touched) continue;
                c = &s->surface[meet->other];
                from = c->marker[c->face[meet->face][0]].along;
                to = c->marker[c->face[meet->face][1]].along;
                to = mpm__layer_between(&c->layer, from, to, meet->u);
                meet->dissipated += s->depth * (mpm__layer_change(&s->surface[a].layer, m->along) +
                                                mpm__layer_change(&c->layer, to));
            }
}

/* ---- making a surface whole ------------------------------------------------------------------------ */

/* Cuts a new surface at the mirrors, gives its markers the body's velocity and counts it in. */
static inline mpm_status mpm__surface_finish(mpm_surfaces *s, const mpm_world *w)
{
    mpm_surface *c = &s->surface[s->surfaces];
    mpm_status st;
    int32_t i;
    int d;
    for (d = 0; d < 6; d++)
        if (d / 2 != 1 && w->desc.side[d] == MPM_SIDE_SYMMETRY) mpm__surface_cut(w, c, d);
    mpm__surface_pack(c);
    st = mpm_want(c->markers >= 2, &s->fault, "markers of a surface", (mpm_real)c->markers, -1);
    if (st != MPM_OK) return mpm__surface_drop(c, st);
    for (i = 0; i < c->markers; i++)
        for (d = 0; d < 3; d++) c->marker[i].v[d] = w->body[c->body].desc.velocity[d];
    mpm__surface_measure(w, c);
    if (s->adhesion > 0 && (st = mpm__layer_make(s, w, c)) != MPM_OK) return mpm__surface_drop(c, st);
    s->surfaces++;
    return MPM_OK;
}

MPM_API mpm_status mpm_surface_add_chain(mpm_surfaces *s, const mpm_world *w, int32_t body, int32_t n,
                                         const mpm_real *x, const mpm_real *z, int closed)
{
    mpm_status st;
    mpm_surface *c = mpm__surface_new(s, w, body, &st);
    int32_t i;
    if (!c) return st;
    if ((st = mpm_want(n >= 2, &s->fault, "markers of a surface", (mpm_real)n, -1)) != MPM_OK) return st;
    for (i = 0; i < n; i++)
        if (!mpm_finite(x[i]) || !mpm_finite(z[i]))
            return mpm_fail(&s->fault, MPM_ERR_NAN, "place of a marker", mpm_finite(x[i]) ? z[i] : x[i], i);
    if ((st = mpm__surface_grow(c, n, n, &s->fault)) != MPM_OK) return mpm__surface_drop(c, st);
    for (i = 0; i < n; i++) mpm__surface_put(c, i, n, x[i], z[i]);
    c->markers = n;
    c->faces = closed ? n : n - 1;
    return mpm__surface_finish(s, w);
}

/* Marker i on the outline of a box, counter-clockwise from its lower left corner: na below and above, nb at a side. */
static inline void mpm__surface_box(const mpm_shape *b, int32_t i, int32_t na, int32_t nb, mpm_real *x, mpm_real *z)
{
    static const int right[5] = {-1, 1, 1, -1, -1}, up[5] = {-1, -1, 1, 1, -1};
    int side = 0;
    mpm_real u;
    for (; i >= (side % 2 ? nb : na); side++) i -= side % 2 ? nb : na;
    u = (mpm_real)i / (mpm_real)(side % 2 ? nb : na);
    *x = b->center[0] + b->half[0] * ((1 - u) * (mpm_real)right[side] + u * (mpm_real)right[side + 1]);
    *z = b->center[2] + b->half[2] * ((1 - u) * (mpm_real)up[side] + u * (mpm_real)up[side + 1]);
}

MPM_API mpm_status mpm_surface_add(mpm_surfaces *s, const mpm_world *w, int32_t body)
{
    mpm_status st;
    mpm_surface *c = mpm__surface_new(s, w, body, &st);
    const mpm_shape *b;
    mpm_real apart, turn;
    int32_t i, na, nb, n;
    if (!c) return st;
    b = &w->body[body].desc.shape;
    apart = w->body[body].desc.spacing / 2;
    st = mpm_want(b->kind != MPM_SHAPE_USER && b->half[0] > 0 && b->half[2] > 0, &s->fault,
                  "shape of body (not an ellipsoid, a cylinder or a box)", (mpm_real)b->kind, body);
    if (st != MPM_OK) return st;
    na = 1 + (int32_t)(2 * b->half[0] / apart * (1 - 64 * MPM_EPSILON));
    nb = 1 + (int32_t)(2 * b->half[2] / apart * (1 - 64 * MPM_EPSILON));
    n = 2 * (na + nb);
    if (b->kind == MPM_SHAPE_ELLIPSOID) n = 4 * (1 + (int32_t)(MPM_PI / 4 * (b->half[0] + b->half[2]) / apart));
    if ((st = mpm__surface_grow(c, n, n, &s->fault)) != MPM_OK) return mpm__surface_drop(c, st);
    for (i = 0; i < n; i++) {
        mpm_real x, z;
        turn = 2 * MPM_PI * ((mpm_real)i / (mpm_real)n - MPM_R(0.25)); /* from the lower pole to the right */
        if (b->kind == MPM_SHAPE_ELLIPSOID) {
            x = i % (n / 2) ? b->center[0] + b->half[0] * (mpm_real)cos((double)turn) : b->center[0];
            z = b->center[2] + b->half[2] * (mpm_real)sin((double)turn);
        } else {
            mpm__surface_box(b, i, na, nb, &x, &z);
        }
        mpm__surface_put(c, i, n, x, z);
    }
    c->markers = c->faces = n;
    return mpm__surface_finish(s, w);
}

MPM_API mpm_status mpm_surface_wall_add(mpm_surfaces *s, const mpm_real point[3], const mpm_real normal[3])
{
    const mpm_real length = mpm_sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    mpm_surface_wall *p = &s->wall[s->walls];
    mpm_status st = mpm_want(length > 0, &s->fault, "normal of a wall", length, -1);
    int d;
    if (st == MPM_OK && s->walls == MPM_SURFACE_WALLS)
        st = mpm_fail(&s->fault, MPM_ERR_FULL, "walls", (mpm_real)s->walls, -1);
    if (st != MPM_OK) return st;
    memset(p, 0, sizeof *p);
    for (d = 0; d < 3; d++) {
        p->point[d] = point[d];
        p->normal[d] = normal[d] / length;
    }
    s->walls++;
    return MPM_OK;
}

/* ---- who meets whom ------------------------------------------------------------------------------ */

/* Whether a marker can touch a face: it looks towards the marker, and the marker at it. */
static inline int mpm__surface_faces(const mpm_surface *c, int32_t face, const mpm_marker *m)
{
    const mpm_real *a = c->marker[c->face[face][0]].x, *b = c->marker[c->face[face][1]].x;
    return m->normal[0] * (b[2] - a[2]) - m->normal[2] * (b[0] - a[0]) < 0;
}

/* Takes face `face` for a meeting if it is nearer than what stands there. */
static inline void mpm__surface_try(const mpm_surface *c, int32_t face, const mpm_marker *m, mpm_meet *meet,
                                    mpm_real *nearest)
{
    mpm_real u, square;
    if (face < 0 || !mpm__surface_faces(c, face, m)) return;
    square = mpm__surface_nearest(c, face, m->x, &u);
    if (!(square < *nearest)) return;
    *nearest = square;
    meet->face = face;
    meet->u = u;
}

static inline uint32_t mpm__surface_bucket(const mpm_surfaces *s, int32_t ix, int32_t iz)
{
    return ((uint32_t)ix * 73856093u ^ (uint32_t)iz * 83492791u) & (uint32_t)(s->buckets - 1);
}

/* The cell of x in direction d; what lies far off the grid is in its last, on either side. */
static inline int32_t mpm__surface_cell(const mpm_world *w, const mpm_real *x, int d)
{
    const mpm_real cell = (x[d] - w->desc.origin[d]) / w->desc.cell + 8, far = MPM_R(1e9);
    return cell > far ? (int32_t)far : cell > -far ? (int32_t)cell : -(int32_t)far;
}

/* Puts the faces of a surface, by the cells of their middles, into buckets. */
static inline mpm_status mpm__surface_sort(mpm_surfaces *s, const mpm_world *w, const mpm_surface *c)
{
    int32_t i, buckets = 64;
    void *p;
    while (buckets < c->faces) buckets *= 2;
    p = mpm__surface_room(s->bucket, &s->bucket_room, 0, buckets, sizeof s->bucket[0]);
    if (!p) return mpm__surface_full(&s->fault, buckets);
    s->bucket = (int32_t *)p;
    p = mpm__surface_room(s->next, &s->nexts, 0, c->faces, sizeof s->next[0]);
    if (!p) return mpm__surface_full(&s->fault, c->faces);
    s->next = (int32_t *)p;
    s->buckets = buckets;
    for (i = 0; i < buckets; i++) s->bucket[i] = -1;
    for (i = c->faces - 1; i >= 0; i--) {
        const mpm_real *a = c->marker[c->face[i][0]].x, *b = c->marker[c->face[i][1]].x;
        mpm_real x[3];
        uint32_t k;
        int d;
        for (d = 0; d < 3; d++) x[d] = (a[d] + b[d]) / 2;
        k = mpm__surface_bucket(s, mpm__surface_cell(w, x, 0), mpm__surface_cell(w, x, 2));
        s->next[i] = s->bucket[k];
        s->bucket[k] = i;
    }
    return MPM_OK;
}

/* The meeting of a marker with `other`, made if there is room for one and `make` says so; or NULL. */
static inline mpm_meet *mpm__surface_meet(mpm_marker *m, int32_t other, int make)
{
    mpm_meet *spare = NULL;
    int k;
    for (k = 0; k < MPM_SURFACE_MEETS; k++) {
        if (m->meet[k].other == other) return &m->meet[k];
        if (m->meet[k].other == MPM_SURFACE_NONE && !spare) spare = &m->meet[k];
    }
    if (!make || !spare) return NULL;
    memset(spare, 0, sizeof *spare);
    spare->other = other;
    return spare;
}

/* Looks for the nearest face of surface b, now in the buckets, to each marker of a. */
static inline void mpm__surface_search(mpm_surfaces *s, const mpm_world *w, int32_t a, int32_t b)
{
    const mpm_surface *other = &s->surface[b];
    int32_t i, face, ix, iz;
    for (i = 0; i < s->surface[a].markers; i++) {
        mpm_marker *m = &s->surface[a].marker[i];
        const int32_t cx = mpm__surface_cell(w, m->x, 0), cz = mpm__surface_cell(w, m->x, 2);
        mpm_real nearest = w->desc.cell * w->desc.cell;
        mpm_meet found, *meet;
        found.face = -1;
        found.u = 0;
        for (iz = cz - 1; iz <= cz + 1; iz++)
            for (ix = cx - 1; ix <= cx + 1; ix++)
                for (face = s->bucket[mpm__surface_bucket(s, ix, iz)]; face >= 0; face = s->next[face])
                    mpm__surface_try(other, face, m, &found, &nearest);
        meet = mpm__surface_meet(m, b, found.face >= 0);
        if (!meet || (found.face < 0 && meet->touched)) continue; /* what once touched is kept: its G is asked for */
        if (found.face < 0) meet->other = MPM_SURFACE_NONE;
        meet->face = found.face;
        meet->u = found.u;
    }
}

/* Follows a meeting from the face it had to its neighbours, as long as they are nearer. */
static inline void mpm__surface_follow(const mpm_surface *c, const mpm_marker *m, mpm_meet *meet)
{
    mpm_real nearest = mpm__surface_nearest(c, meet->face, m->x, &meet->u);
    int32_t from;
    do {
        from = meet->face;
        mpm__surface_try(c, c->around[c->face[from][0]][0], m, meet, &nearest);
        mpm__surface_try(c, c->around[c->face[from][1]][1], m, meet, &nearest);
    } while (meet->face != from);
}

/* Meetings with the walls, of all markers within a cell of them. */
static inline void mpm__surface_meet_walls(mpm_surfaces *s, const mpm_world *w, mpm_surface *c)
{
    int32_t i;
    int k, d;
    for (i = 0; i < c->markers; i++)
        for (k = 0; k < s->walls; k++) {
            const mpm_surface_wall *p = &s->wall[k];
            mpm_marker *m = &c->marker[i];
            mpm_real gap = 0, rate = 0;
            mpm_meet *meet;
            for (d = 0; d < 3; d++) {
                gap += (m->x[d] - p->point[d]) * p->normal[d];
                rate += (m->v[d] - p->velocity[d]) * p->normal[d];
            }
            meet = mpm__surface_meet(m, -1 - k, gap < w->desc.cell);
            if (!meet) continue;
            if (gap >= w->desc.cell) meet->other = MPM_SURFACE_NONE;
            meet->gap = gap;
            meet->rate = rate;
            for (d = 0; d < 3; d++) meet->normal[d] = p->normal[d];
        }
}

/* Velocity of what a marker meets, where it meets it. */
static inline void mpm__surface_velocity(const mpm_surfaces *s, const mpm_meet *meet, mpm_real *v)
{
    int d;
    if (meet->other < 0) {
        for (d = 0; d < 3; d++) v[d] = s->wall[-1 - meet->other].velocity[d];
    } else {
        const mpm_surface *c = &s->surface[meet->other];
        const mpm_marker *a = &c->marker[c->face[meet->face][0]], *b = &c->marker[c->face[meet->face][1]];
        for (d = 0; d < 3; d++) v[d] = (1 - meet->u) * a->v[d] + meet->u * b->v[d];
    }
}

/* Gap, its rate and the normal of a meeting with a surface: the normal goes evenly from one marker's to the next. */
static inline void mpm__surface_gap(const mpm_surfaces *s, const mpm_marker *m, mpm_meet *meet)
{
    const mpm_surface *c = &s->surface[meet->other];
    const mpm_marker *a = &c->marker[c->face[meet->face][0]], *b = &c->marker[c->face[meet->face][1]];
    mpm_real v[3], length = 0;
    int d;
    for (d = 0; d < 3; d++) {
        meet->normal[d] = (1 - meet->u) * a->normal[d] + meet->u * b->normal[d];
        length += meet->normal[d] * meet->normal[d];
    }
    length = mpm_sqrt(length);
    mpm__surface_velocity(s, meet, v);
    meet->gap = meet->rate = 0;
    for (d = 0; d < 3; d++) {
        meet->normal[d] = length > 0 ? meet->normal[d] / length : 0;
        meet->gap += (m->x[d] - (1 - meet->u) * a->x[d] - meet->u * b->x[d]) * meet->normal[d];
        meet->rate += (m->v[d] - v[d]) * meet->normal[d];
    }
}

/* All meetings of this step: searched anew now and then, else followed. */
static inline mpm_status mpm__surface_find(mpm_surfaces *s, const mpm_world *w)
{
    int32_t a, b, i;
    int k;
    mpm_status st;
    for (b = 0; b < s->surfaces && s->steps % s->renew == 0; b++) {
        if ((st = mpm__surface_sort(s, w, &s->surface[b])) != MPM_OK) return st;
        for (a = 0; a < s->surfaces; a++)
            if (a != b && (s->both || a < b)) mpm__surface_search(s, w, a, b);
    }
    for (a = 0; a < s->surfaces; a++) {
        mpm__surface_meet_walls(s, w, &s->surface[a]);
        for (i = 0; i < s->surface[a].markers; i++)
            for (k = 0; k < MPM_SURFACE_MEETS; k++) {
                mpm_marker *m = &s->surface[a].marker[i];
                if (m->meet[k].other < 0) continue;
                mpm__surface_follow(&s->surface[m->meet[k].other], m, &m->meet[k]);
                mpm__surface_gap(s, m, &m->meet[k]);
            }
    }
    return MPM_OK;
}

/* ---- pressure and friction ------------------------------------------------------------------------ */

/* The nodes that carry a place of a surface, with weights that leave out those of next to no mass:
     w_I = N_I m_I / (m_I + eps m_ref), normalised to sum 1;  m_ref = rho h^3, in rings rho h^2 2 pi r_I         (S1)
   Velocities are sums of w_I v_I, forces go to the nodes in the same shares (S2). 0 if the body has no node there. */
static inline int mpm__surface_support(const mpm_surfaces *s, const mpm_world *w, int32_t body, const mpm_real *x,
                                       mpm_support *at)
{
    const mpm_real h = w->desc.cell, reference = s->softening * w->body[body].desc.density * h * h;
    mpm_real sum = 0;
    int a;
    if (!mpm_support_at(w, body, x, at)) return 0;
    for (a = 0; a < at->count; a++) {
        const mpm_node *n = &w->node[at->slot[a]];
        mpm_real place[3], length = 1;
        if (w->desc.geometry == MPM_AXISYMMETRIC) {
            mpm_node_position(w, n, place);
            length = 2 * MPM_PI * (place[0] > h / 8 ? place[0] : h / 8);
        }
        at->N[a] *= n->mass > 0 ? n->mass / (n->mass + reference * length) : 0;
        sum += at->N[a];
    }
    for (a = 0; a < at->count && sum > 0; a++) at->N[a] /= sum;
    return sum > 0;
}

/* Stiffness [stress/length] and damper [stress time/length] of a pair of bodies: the softer's; b < 0: of a alone. */
static inline void mpm__surface_penalty(const mpm_surfaces *s, const mpm_world *w, int32_t a, int32_t b, mpm_real *k,
                                        mpm_real *c)
{
    const mpm_body_desc *p = &w->body[a].desc, *q = &w->body[b < 0 ? a : b].desc;
    const mpm_real sa = p->density * p->wave_p * p->wave_p, sb = q->density * q->wave_p * q->wave_p;
    const mpm_real za = p->density * p->wave_p, zb = q->density * q->wave_p;
    *k = s->stiffness * (sa < sb ? sa : sb) / w->desc.cell;
    *c = s->damping * (za < zb ? za : zb);
}

/* Adds the way that a marker slides over the other in this step to `slip`, which stays along the surface. */
static inline void mpm__surface_slide(const mpm_surfaces *s, const mpm_marker *m, const mpm_meet *meet, mpm_real dt,
                                      mpm_real *slip)
{
    mpm_real v[3], along = 0;
    int d;
    mpm__surface_velocity(s, meet, v);
    for (d = 0; d < 3; d++) {
        slip[d] += dt * (m->v[d] - v[d]);
        along += slip[d] * meet->normal[d];
    }
    for (d = 0; d < 3; d++) slip[d] -= along * meet->normal[d];
}

static inline mpm_real mpm__surface_length(const mpm_real *v)
{
    return mpm_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Coulomb's law by a spring that slips: traction t = -k slip, its length at most mu p. */
static inline void mpm__surface_friction(const mpm_surfaces *s, const mpm_marker *m, mpm_meet *meet, mpm_real k,
                                         mpm_real dt, mpm_real *t)
{
    const mpm_real most = s->friction * meet->pressure / k;
    mpm_real length;
    int d;
    mpm__surface_slide(s, m, meet, dt, meet->slip);
    length = mpm__surface_length(meet->slip);
    for (d = 0; d < 3; d++) {
        if (length > most) meet->slip[d] *= most / length;
        t[d] = -k * meet->slip[d];
    }
}

/* Adhesion, of W = W0 (G/G_c - 1): pressed, the marker follows the other. Drawn open by o, normal and along the
   surface, a traction k o against it up to 2 W/delta_c, then falling to none at delta_c, and back to the origin when o
   falls: it never gives energy. Pressed again, it is whole again. */
static inline void mpm__surface_adhere(const mpm_surfaces *s, const mpm_marker *m, mpm_meet *meet, mpm_real k,
                                       mpm_real dt)
{
    const mpm_real most = 2 * mpm_surface_adhesion(s, meet) / s->reach;
    mpm_real open[3], length, bears;
    int d;
    memset(meet->tension, 0, sizeof meet->tension);
    if (meet->pressure > 0) {
        meet->touched = 1;
        meet->drawn[0] = meet->drawn[1] = meet->drawn[2] = meet->opened = 0;
    }
    if (meet->pressure > 0 || !meet->touched) return;
    mpm__surface_slide(s, m, meet, dt, meet->drawn);
    for (d = 0; d < 3; d++) open[d] = meet->drawn[d] + (meet->gap > 0 ? meet->gap : 0) * meet->normal[d];
    length = mpm__surface_length(open);
    if (length > meet->opened) meet->opened = length;
    if (!(most > 0) || !(length > 0) || meet->opened >= s->reach) return; /* none, closed, spent */
    bears = k * meet->opened;
    if (bears > most) bears = most * (s->reach - meet->opened) / (s->reach - most / k);
    for (d = 0; d < 3; d++) meet->tension[d] = -bears * open[d] / meet->opened;
}

/* Adds what a marker gets from a meeting to it, and what it gives to the other's markers. */
static inline void mpm__surface_give(mpm_surfaces *s, mpm_marker *m, mpm_meet *meet, mpm_real k, mpm_real dt,
                                     mpm_real share)
{
    mpm_surface *c = meet->other < 0 ? NULL : &s->surface[meet->other];
    mpm_marker *a = c ? &c->marker[c->face[meet->face][0]] : NULL, *b = c ? &c->marker[c->face[meet->face][1]] : NULL;
    mpm_real t[3] = {0, 0, 0};
    int d;
    if (s->friction > 0) mpm__surface_friction(s, m, meet, k, dt, t);
    if (s->adhesion > 0 && c) mpm__surface_adhere(s, m, meet, k, dt);
    for (d = 0; d < 3; d++) {
        const mpm_real f = share * m->area * (meet->pressure * meet->normal[d] + t[d]);
        const mpm_real pull = share * m->area * meet->tension[d];
        if (!c) {
            m->wall[d] += f;
            continue;
        }
        m->force[d] += f;
        a->force[d] -= (1 - meet->u) * f;
        b->force[d] -= meet->u * f;
        m->pull[d] += pull;
        a->pull[d] -= (1 - meet->u) * pull;
        b->pull[d] -= meet->u * pull;
    }
}

/* Pressures p = max(0, -k g - c g') (S3) and forces of surface a against `other`. */
static inline void mpm__surface_press(mpm_surfaces *s, mpm_world *w, int32_t a, int32_t other)
{
    mpm_surface *own = &s->surface[a];
    const mpm_real share = other >= 0 && s->both ? MPM_R(0.5) : 1;
    mpm_real k, c;
    int32_t i;
    mpm__surface_penalty(s, w, own->body, other < 0 ? -1 : s->surface[other].body, &k, &c);
    for (i = 0; i < own->markers; i++) {
        mpm_meet *meet = mpm__surface_meet(&own->marker[i], other, 0);
        mpm_real p;
        if (!meet) continue;
        p = -k * meet->gap - c * meet->rate;
        meet->pressure = p > 0 ? p : 0;
        mpm__surface_give(s, &own->marker[i], meet, k, w->dt, share);
        w->held += mpm__surface_length(meet->tension) > 0;
    }
}

MPM_API mpm_status mpm_surface_contact(mpm_surfaces *s, mpm_world *w)
{
    int32_t a, b, i;
    int d;
    mpm_support at;
    mpm_status st = mpm_surfaces_check(s, &s->fault);
    if (st == MPM_OK) st = mpm__surface_find(s, w);
    if (st != MPM_OK) return st;
    w->held = 0;
    for (a = 0; a < s->surfaces; a++)
        for (i = 0; i < s->surface[a].markers; i++)
            for (d = 0; d < 3; d++) {
                mpm_marker *m = &s->surface[a].marker[i];
                m->force[d] = m->pull[d] = m->wall[d] = 0;
            }
    for (a = 0; a < s->surfaces; a++)
        for (b = -(int32_t)s->walls; b < s->surfaces; b++)
            if (b < 0 || (a != b && (s->both || a < b))) mpm__surface_press(s, w, a, b);
    for (a = 0; a < s->surfaces; a++)
        for (i = 0; i < s->surface[a].markers; i++) {
            const mpm_marker *m = &s->surface[a].marker[i];
            mpm_real f[3];
            for (d = 0; d < 3; d++) f[d] = m->force[d] + m->pull[d] + m->wall[d];
            if (!(f[0] * f[0] + f[2] * f[2] > 0)) continue;
            if (mpm__surface_support(s, w, s->surface[a].body, m->x, &at)) mpm_push(w, &at, f);
        }
    return MPM_OK;
}

/* ---- moving along -------------------------------------------------------------------------------- */

/* Halves the face: a marker between its two, moving as they do, meeting what the first meets. */
static inline mpm_status mpm__surface_halve(mpm_surfaces *s, mpm_surface *c, int32_t face)
{
    mpm_status st = mpm__surface_grow(c, c->markers + 1, c->faces + 1, &s->fault);
    int32_t n = c->markers, b;
    mpm_marker *m;
    int d;
    if (st != MPM_OK) return st;
    b = c->face[face][1];
    m = &c->marker[n];
    *m = c->marker[c->face[face][0]];
    for (d = 0; d < 3; d++) {
        m->x[d] = (m->x[d] + c->marker[b].x[d]) / 2;
        m->v[d] = (m->v[d] + c->marker[b].v[d]) / 2;
        m->force[d] = m->pull[d] = m->wall[d] = 0;
    }
    m->along = mpm__layer_between(&c->layer, m->along, c->marker[b].along, MPM_R(0.5));
    c->face[c->faces][0] = n;
    c->face[c->faces][1] = b;
    c->face[face][1] = n;
    c->around[n][0] = face;
    c->around[n][1] = c->around[b][0] = c->faces;
    c->markers++;
    c->faces++;
    return MPM_OK;
}

static inline mpm_status mpm__surface_refine(mpm_surfaces *s, const mpm_world *w, mpm_surface *c)
{
    const mpm_real most = s->longest * w->desc.cell;
    const int32_t faces = c->faces;
    int32_t i;
    for (i = 0; i < faces; i++) {
        const mpm_real *a = c->marker[c->face[i][0]].x, *b = c->marker[c->face[i][1]].x;
        const mpm_real x = b[0] - a[0], z = b[2] - a[2];
        mpm_status st = MPM_OK;
        if (x * x + z * z > most * most) st = mpm__surface_halve(s, c, i);
        if (st != MPM_OK) return st;
    }
    return MPM_OK;
}

MPM_API mpm_status mpm_surface_move(mpm_surfaces *s, mpm_world *w)
{
    mpm_support at;
    int32_t a, i;
    int d;
    mpm_status st = MPM_OK;
    for (a = 0; a < s->surfaces && st == MPM_OK; a++) {
        mpm_surface *c = &s->surface[a];
        for (i = 0; i < c->markers; i++) {
            mpm_marker *m = &c->marker[i];
            if (mpm__surface_support(s, w, c->body, m->x, &at)) {
                const double work = mpm_support_work(w, &at, m->force);
                const double pulled = s->adhesion > 0 ? mpm_support_work(w, &at, m->pull) : 0;
                w->ledger.walls += work + pulled; /* where mpm_push has booked it */
                w->ledger.contact -= work;
                w->ledger.hold -= pulled;
                mpm_support_mapped(w, &at, m->v);
            }
            for (d = 0; d < 3 && st == MPM_OK; d++) {
                m->x[d] += w->dt * m->v[d];
                if (!mpm_finite(m->x[d])) st = mpm_fail(&s->fault, MPM_ERR_NAN, "place of a marker", m->x[d], i);
            }
        }
        if (st == MPM_OK) st = mpm__surface_refine(s, w, c);
        mpm__surface_measure(w, c);
    }
    if (s->adhesion > 0 && s->steps % MPM__LAYER_STEPS == 0) {
        for (a = 0; a < s->surfaces; a++) mpm__layer_update(w, &s->surface[a]);
        mpm__layer_grow(s);
    }
    s->steps++;
    return st;
}

MPM_API mpm_status mpm_surface_step(mpm_surfaces *s, mpm_world *w, mpm_real dt)
{
    mpm_status st = mpm_locate(w, dt), later;
    if (st < 0) return st;
    mpm_p2g(w);
    mpm_forces(w);
    if ((later = mpm_surface_contact(s, w)) < 0) {
        w->fault = s->fault;
        return later;
    }
    mpm_grid_update(w);
    mpm_g2p(w);
    mpm_musl(w);
    if ((later = mpm_stress(w)) < 0) return later;
    if ((later = mpm_surface_move(s, w)) < 0) {
        w->fault = s->fault;
        return later;
    }
    mpm_move(w);
    return st;
}

/* ---- looking at it ------------------------------------------------------------------------------- */

MPM_API mpm_real mpm_surface_adhesion(const mpm_surfaces *s, const mpm_meet *meet)
{
    if (!(s->adhesion > 0) || !(meet->dissipated > s->critical) || meet->opened >= s->reach) return 0;
    return s->adhesion * (meet->dissipated / s->critical - 1);
}

/* Adds what adhesion has made of a meeting. */
static inline void mpm__surface_collect_adhesion(const mpm_surfaces *s, const mpm_meet *meet, double area,
                                                 mpm_meeting *r)
{
    const mpm_real bond = mpm_surface_adhesion(s, meet);
    if (!meet->touched) return;
    r->touched += area;
    r->dissipated += area * (double)meet->dissipated;
    if (!(bond > 0)) return;
    r->bonded += area;
    r->adhesion += area * (double)bond;
}

/* Adds the meetings of a's markers with b (-1: any body), force on a. */
static inline void mpm__surface_collect(const mpm_surfaces *s, int32_t a, int32_t b, double share, double sign,
                                        mpm_meeting *r)
{
    int32_t i;
    int k, d;
    for (i = 0; i < s->surface[a].markers; i++)
        for (k = 0; k < MPM_SURFACE_MEETS; k++) {
            const mpm_marker *m = &s->surface[a].marker[i];
            const mpm_meet *meet = &m->meet[k];
            const double area = share * (double)m->area;
            if (meet->other < 0 || (b >= 0 && meet->other != b)) continue;
            if ((double)meet->gap < r->gap_min) r->gap_min = (double)meet->gap;
            mpm__surface_collect_adhesion(s, meet, area, r);
            for (d = 0; d < 3; d++) r->pull[d] += sign * area * (double)meet->tension[d];
            if (!(meet->pressure > 0)) continue;
            if ((double)meet->pressure > r->pressure_max) r->pressure_max = (double)meet->pressure;
            r->area += area;
            for (d = 0; d < 3; d++) r->force[d] += sign * area * (double)(meet->pressure * meet->normal[d]);
        }
}

MPM_API mpm_meeting mpm_surface_meets(const mpm_surfaces *s, const mpm_world *w, int32_t a, int32_t b)
{
    const double share = s->both ? 0.5 : 1;
    mpm_meeting r;
    int32_t i;
    memset(&r, 0, sizeof r);
    r.gap_min = (double)w->desc.cell;
    mpm__surface_collect(s, a, b, share, 1, &r);
    for (i = 0; i < s->surfaces; i++)
        if (i != a && (b < 0 || i == b)) mpm__surface_collect(s, i, a, share, -1, &r);
    if (r.touched > 0) r.dissipated /= r.touched;
    return r;
}

#ifdef __cplusplus
}
#endif

#endif /* MPM_SURFACE_IMPLEMENTED */
