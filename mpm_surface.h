/* mpm_surface.h - bodies that meet where their surfaces are, not where they share a node. Version 0.2.0.
   SPDX-License-Identifier: MIT

   DO THIS
     #define MPM_IMPLEMENTATION in ONE file, then include mpm.h and mpm_surface.h there; "mpm_surface.h" alone
     everywhere else. Add the bodies to a world, then mpm_surface_add for each that shall touch others, and step with
     mpm_surface_step. Link with -lm.

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
     Each body carries its surface: massless markers, joined to a chain in two dimensions and by triangles in three,
     moved by the body's own grid (mpm_surface_move). A marker finds the nearest place of another body's surface. Where
     the gap to it is negative, a pressure in proportion to it, and to the speed at which it closes, acts on both, from
     these on their own grids
     (mpm_surface_contact). Nothing is compared between two bodies' grids, so that next to nothing hangs on where their
     nodes lie. Contact at nodes takes no part: use splines (desc.basis = MPM_CUBIC), whose fields are smooth at a
     surface.

   CONTENTS
     describing      mpm_surfaces_default, mpm_surface_add, mpm_surface_add_chain, mpm_surface_add_triangles,
                     mpm_surface_wall_add
     the step        mpm_surface_step = the phases of mpm.h with mpm_surface_contact and mpm_surface_move
     looking at it   mpm_surface_meets: who touches whom, and how hard; mpm_surface_adhesion of one meeting
     restart         mpm_surfaces_blobs, _make_room, _restored

   ADHESION (on request: surfaces.adhesion > 0)
     Plastic work in a layer of a physical depth l under both surfaces, from the first touch on, is the interface's
     dissipation G of each marker's meeting:
       dG = l (d<w_p> of this body + d<w_p> of the other),  <w_p>: mean over the points of depth < l whose feet on the
       surface were q l < l from the marker at first, weight (1 - q)^2 (1 + 2 q)                                 (S4)
     Where it exceeds G_c it leaves an adhesion of W = W0 (G/G_c - 1) per area: a traction 2 W/delta_c at most, spent
     when drawn open by delta_c (S5). It belongs to the two bodies that met, and costs what it takes: ledger.hold.

   HOW GOOD IT IS (splines, the default penalty; h: the cell)
     Time step     with the damper stable up to 1.1/sqrt(stiffness) of mpm_time_step's factor, 0.5 at the default: above
                   it contact makes energy without bound. Without the damper some is made below it too, of bars that
                   meet 5 % at most at 0.2, and more the stiffer the penalty (37_surface_motion)
     Normal force  an elastic sphere bounces with the force and in the time of its own theory to 2 % where two cells or
                   more lie in the contact radius a; Hertz's half space is softer by 0.6 a/R (33_surface)
     Friction      bodies that slide take mu times the normal impulse, to 0.2 % (37_surface_motion)
     Turning       a body is turned, and rolls, as if it were touched 0.4 h inside, for that is where the points around
                   surface nodes are: a disk of 10 cells' radius rolls 2 % too slow (37_surface_motion)

   WHAT IT DOES NOT DO: contact of a body with itself; more than two other bodies at a marker.

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
#define mpm_surface_add_triangles mpm_surface_add_triangles_f32
#define mpm_surface_wall_add mpm_surface_wall_add_f32
#define mpm_surface_contact mpm_surface_contact_f32
#define mpm_surface_move mpm_surface_move_f32
#define mpm_surface_step mpm_surface_step_f32
#define mpm_surface_meets mpm_surface_meets_f32
#define mpm_surface_adhesion mpm_surface_adhesion_f32
#define mpm_surfaces_blobs mpm_surfaces_blobs_f32
#define mpm_surfaces_make_room mpm_surfaces_make_room_f32
#define mpm_surfaces_restored mpm_surfaces_restored_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define MPM_SURFACE_MEETS 2  /* other bodies that a marker can touch at a time */
#define MPM_SURFACE_WALLS 4  /* rigid walls */

/* A marker's meeting with another body or a wall. */
typedef struct mpm_meet {
    int32_t other;        /* its surface's number; -1 - k: wall k; MPM_SURFACE_NONE: nobody */
    int32_t face;         /* nearest face of it, and where on that: the shares of its markers */
    mpm_real share[3];
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

#define MPM_SURFACE_NONE (-1000) /* no surface, no meeting */

/* A massless point of a surface. */
typedef struct mpm_marker {
    mpm_real x[3], v[3];  /* position, and velocity of its own body's grid there */
    mpm_real normal[3];   /* unit, out of the body */
    mpm_real area;        /* what of the surface it stands for, now [length^2; per depth in plane strain] */
    int32_t parent[2];    /* the markers between which it was put when they had grown apart; -1: one of the first */
    mpm_real worked;      /* what the layer's plastic work per volume has grown by since the look before [stress] */
    mpm_real force[3];    /* contact with all other bodies in this step */
    mpm_real pull[3];     /* adhesion to them */
    mpm_real wall[3];     /* from walls */
    mpm_meet meet[MPM_SURFACE_MEETS];
} mpm_marker;

/* The layer under a surface whose plastic work makes adhesion: for each of its first markers a mean over the points
   near it, in the body as it was at first. */
typedef struct mpm_layer {
    int32_t markers, points;  /* 0: none */
    int32_t first_id;         /* of the body's points */
    mpm_real *mean;           /* per marker: plastic work per volume at the last look [stress] */
    int32_t *begin;           /* per marker, and one more: its entries */
    int32_t *point;           /* per entry: number of the point, less first_id */
    mpm_real *weight;         /* of it; they sum to 1 */
    int32_t *where;           /* per point: its index now, -1: retired */
} mpm_layer;

/* The surface of one body: markers joined by faces. In two dimensions a face is the line from its first to its second
   marker, the body to the left, with x to the right and z up. In three it is a triangle, its markers counter-clockwise
   for who looks at the body from outside. */
typedef struct mpm_surface {
    int32_t body;
    int corners;           /* of a face: 2 or 3 */
    int32_t markers, faces;
    int32_t marker_capacity, face_capacity;
    mpm_marker *marker;
    int32_t (*face)[3];
    int32_t (*beside)[3];  /* per face: those that share its corner k, or in three dimensions its edge from corner k to
                              the next; -1: none */
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
    int32_t *bucket, *next; /* search: first face or marker of a cell, next one of the same */
    int32_t *around;        /* what was found close to a place */
    int32_t buckets, bucket_room, nexts, around_room;
    mpm_fault fault;
} mpm_surfaces;

/* Penalty 5 rho c^2/cell and damper rho c, both ways, no friction, no walls. Test: 33_surface. */
MPM_API mpm_surfaces mpm_surfaces_default(void);

/* MPM_ERR_ARGUMENT / NAN: a field out of its range, by name in fault (may be NULL). Test: 33_surface. */
MPM_API mpm_status mpm_surfaces_check(const mpm_surfaces *s, mpm_fault *fault);

/* Gives the memory back; s is then as from mpm_surfaces_default but for its parameters. Test: 33_surface. */
MPM_API void mpm_surfaces_free(mpm_surfaces *s);

/* The surface of a body's shape, with a marker every half spacing, in three dimensions every quarter of a cell; of a
   shape of your own through where `inside` changes, to a thousandth of that. What lies behind a symmetry plane is cut
   off, and faces with dampers have none: the body goes on there. Before the body has moved. MPM_ERR_ARGUMENT: no such
   body, one without a shape, or it has a surface; MPM_ERR_MEMORY. Test: 33_surface, 34_triangles. */
MPM_API mpm_status mpm_surface_add(mpm_surfaces *s, const mpm_world *w, int32_t body);

/* A surface of the caller's: n places x, z [length], joined in order, the last with the first if closed, the body to
   the left; in two dimensions. MPM_ERR_ARGUMENT / NAN: as above, fewer than two places, or a place that is not finite,
   its number in fault.index; MPM_ERR_MEMORY. Test: 33_surface. */
MPM_API mpm_status mpm_surface_add_chain(mpm_surfaces *s, const mpm_world *w, int32_t body, int32_t n,
                                         const mpm_real *x, const mpm_real *z, int closed);

/* The same in three dimensions: n places x[0], x[1], x[2] [length], and triangles of their numbers, counter-clockwise
   from outside. MPM_ERR_ARGUMENT also: a number that is none, its triangle in fault.index. Test: 34_triangles. */
MPM_API mpm_status mpm_surface_add_triangles(mpm_surfaces *s, const mpm_world *w, int32_t body, int32_t n,
                                             const mpm_real *const x[3], int32_t triangles,
                                             const int32_t (*triangle)[3]);

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

/* The step of mpm.h, of dt [time] > 0, with contact on surfaces in place of contact at nodes: the
   largest: HOW GOOD IT IS. Errors as mpm_step, mpm_surface_contact and mpm_surface_move, with the fault in the world.
   Test: 33_surface, 37_surface_motion. */
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

/* ---- restart -------------------------------------------------------------------------------- */

/* The state of all surfaces and walls: what the next step depends on beside the world and the parameters. Fills blob[],
   at most MPM_SURFACES_BLOBS(s->surfaces) of them, and returns how many. To go on from stored ones, set world and
   surfaces up as before, in the same order and before a step; look how much is stored (mpm_io_checkpoint_sizes: faces
   were halved), make room for it, read, and call mpm_restored, then mpm_surfaces_restored:
       mpm_surfaces_blobs(&s, blob);
       if (mpm_io_checkpoint_sizes(path, text, blob, n, &fault) < 0 || mpm_surfaces_make_room(&s, blob) < 0 ||
           mpm_io_checkpoint_read(path, text, blob, n, &fault) < 0 || mpm_surfaces_restored(&s, &w, blob) < 0) ...
   Parameters are description: lines of the checkpoint's text. Test: 35_surface_restart, bit for bit. */
#define MPM_SURFACES_BLOBS(surfaces) (2 + 5 * (surfaces))
MPM_API int mpm_surfaces_blobs(mpm_surfaces *s, mpm_blob *blob);

/* Memory for markers and faces of as many bytes as blob[] now says, which then leads there. MPM_ERR_ARGUMENT: a size
   that is none of whole markers or faces; MPM_ERR_MEMORY. Test: 35_surface_restart. */
MPM_API mpm_status mpm_surfaces_make_room(mpm_surfaces *s, mpm_blob *blob);

/* Checks what was read into the blobs of mpm_surfaces_blobs, before anything of it is used: counts, numbers of markers
   and faces, places, of the restored world. MPM_ERR_ARGUMENT / NAN, named by s->fault: s is then as after
   mpm_surfaces_free. Test: 35_surface_restart. */
MPM_API mpm_status mpm_surfaces_restored(mpm_surfaces *s, const mpm_world *w, const mpm_blob *blob);

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
    mpm__surface_release(c->beside);
    mpm__surface_release(c->layer.mean);
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
    mpm__surface_release(s->around);
    s->surface = NULL;
    s->bucket = s->next = s->around = NULL;
    s->surfaces = s->capacity = s->buckets = s->bucket_room = s->nexts = s->around_room = 0;
    s->walls = 0;
    s->steps = 0;
}

/* Memory for n entries of `size` bytes, with those of `old` that are in use; `old` itself if it has the room, NULL if
   there is none to be had. */
static inline void *mpm__surface_room(void *old, int32_t *capacity, int32_t used, int32_t n, size_t size)
{
    const int32_t room = n + n / 2 + 16;
    void *more;
    if (old && n <= *capacity) return old;
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

/* Room in one surface; there are as many `beside` as faces. */
static inline mpm_status mpm__surface_grow(mpm_surface *c, int32_t markers, int32_t faces, mpm_fault *f)
{
    int32_t capacity = c->face_capacity;
    void *p = mpm__surface_room(c->marker, &c->marker_capacity, c->markers, markers, sizeof c->marker[0]);
    if (!p) return mpm__surface_full(f, markers);
    c->marker = (mpm_marker *)p;
    p = mpm__surface_room(c->face, &capacity, c->faces, faces, sizeof c->face[0]);
    if (!p) return mpm__surface_full(f, faces);
    c->face = (int32_t(*)[3])p;
    p = mpm__surface_room(c->beside, &c->face_capacity, c->faces, faces, sizeof c->beside[0]);
    if (!p) return mpm__surface_full(f, faces);
    c->beside = (int32_t(*)[3])p;
    return MPM_OK;
}

/* Room for n buckets, a power of two that is returned, and m items in them; 0 if there is none to be had. All empty. */
static inline int32_t mpm__surface_buckets(mpm_surfaces *s, int32_t n, int32_t m)
{
    int32_t i, buckets = 64;
    void *p;
    while (buckets < n) buckets *= 2;
    p = mpm__surface_room(s->bucket, &s->bucket_room, 0, buckets, sizeof s->bucket[0]);
    if (p) s->bucket = (int32_t *)p;
    if (p) p = mpm__surface_room(s->next, &s->nexts, 0, m, sizeof s->next[0]);
    if (!p) return 0;
    s->next = (int32_t *)p;
    for (i = 0; i < buckets; i++) s->bucket[i] = -1;
    s->buckets = buckets;
    p = mpm__surface_room(s->around, &s->around_room, 0, m, sizeof s->around[0]);
    if (!p) return 0;
    s->around = (int32_t *)p;
    return buckets;
}

/* ---- faces and markers --------------------------------------------------------------------------- */

static inline mpm_real mpm__surface_dot(const mpm_real *a, const mpm_real *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline mpm_real mpm__surface_length(const mpm_real *a) { return mpm_sqrt(mpm__surface_dot(a, a)); }

static inline void mpm__surface_cross(const mpm_real *a, const mpm_real *b, mpm_real *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void mpm__surface_way(const mpm_real *from, const mpm_real *to, mpm_real *way)
{
    int d;
    for (d = 0; d < 3; d++) way[d] = to[d] - from[d];
}

/* The area of a face times its normal out of the body; of a line the area is its length, for a depth of 1 along -y. */
static inline void mpm__surface_vector(const mpm_surface *c, int32_t face, mpm_real *n)
{
    const int32_t *f = c->face[face];
    mpm_real a[3], b[3] = {0, -2, 0};
    int d;
    mpm__surface_way(c->marker[f[0]].x, c->marker[f[1]].x, a);
    if (c->corners == 3) mpm__surface_way(c->marker[f[0]].x, c->marker[f[2]].x, b);
    mpm__surface_cross(a, b, n);
    for (d = 0; d < 3; d++) n[d] /= 2;
}

/* Marker i, at x, meeting nobody. */
static inline void mpm__surface_put(mpm_surface *c, int32_t i, mpm_real x, mpm_real y, mpm_real z)
{
    mpm_marker *m = &c->marker[i];
    int k;
    memset(m, 0, sizeof *m);
    m->x[0] = x;
    m->x[1] = y;
    m->x[2] = z;
    m->parent[0] = m->parent[1] = -1;
    for (k = 0; k < MPM_SURFACE_MEETS; k++) m->meet[k].other = MPM_SURFACE_NONE;
}

static inline void mpm__surface_face(mpm_surface *c, int32_t face, int32_t a, int32_t b, int32_t third)
{
    c->face[face][0] = a;
    c->face[face][1] = b;
    c->face[face][2] = third;
}

/* What a ring at radius r is longer than a marker; 1 in plane strain and in three dimensions. */
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

static inline mpm_real mpm__surface_hair(const mpm_world *w) { return MPM_R(1e-5) * w->desc.cell; }

/* Whether side d mirrors: in two dimensions there is no y. */
static inline int mpm__surface_mirrors(const mpm_world *w, int d)
{
    return w->desc.side[d] == MPM_SIDE_SYMMETRY && (d / 2 != 1 || w->desc.geometry == MPM_3D);
}

/* Area and normal of all markers, from the faces as they lie: linear along each. */
static inline void mpm__surface_measure(const mpm_world *w, mpm_surface *c)
{
    const int n = c->corners;
    int32_t i;
    int k, d;
    for (i = 0; i < c->markers; i++) {
        c->marker[i].area = 0;
        for (d = 0; d < 3; d++) c->marker[i].normal[d] = 0;
    }
    for (i = 0; i < c->faces; i++) {
        mpm_real out[3], ring[3], sum = 0, part;
        mpm__surface_vector(c, i, out);
        for (k = 0; k < n; k++) sum += ring[k] = mpm__surface_ring(w, c->marker[c->face[i][k]].x[0]);
        part = mpm__surface_length(out) / (mpm_real)(n * (n + 1));
        for (k = 0; k < n; k++) {
            mpm_marker *m = &c->marker[c->face[i][k]];
            m->area += part * (ring[k] + sum);
            for (d = 0; d < 3; d++) m->normal[d] += out[d];
        }
    }
    for (i = 0; i < c->markers; i++) {
        mpm_marker *m = &c->marker[i];
        mpm_real length;
        for (d = 0; d < 6; d++) { /* on a mirror the other half takes that component away */
            const mpm_real from = m->x[d / 2] - mpm__surface_side(w, d), hair = mpm__surface_hair(w);
            if (mpm__surface_mirrors(w, d) && from < hair && from > -hair) m->normal[d / 2] = 0;
        }
        length = mpm__surface_length(m->normal);
        for (d = 0; d < 3; d++) m->normal[d] = length > 0 ? m->normal[d] / length : 0;
    }
}

/* The place on a line nearest to x: u of the way from a to b, and the distance squared. */
static inline mpm_real mpm__surface_on_line(const mpm_real *a, const mpm_real *b, const mpm_real *x, mpm_real *u)
{
    mpm_real t[3], off[3], square;
    int d;
    mpm__surface_way(a, b, t);
    mpm__surface_way(a, x, off);
    square = mpm__surface_dot(t, t);
    *u = square > 0 ? mpm__surface_dot(off, t) / square : 0;
    *u = *u < 0 ? 0 : *u > 1 ? 1 : *u;
    for (d = 0; d < 3; d++) off[d] -= *u * t[d];
    return mpm__surface_dot(off, off);
}

/* The place on a triangle nearest to x: its corners' shares, and the distance squared. Beside the triangle it is on an
   edge that x lies beyond. */
static inline mpm_real mpm__surface_on_triangle(const mpm_real *const corner[3], const mpm_real *x, mpm_real *share)
{
    mpm_real b[3], c[3], off[3], n[3], across[3], square, nearest = -1, inside[3], u;
    int k;
    mpm__surface_way(corner[0], corner[1], b);
    mpm__surface_way(corner[0], corner[2], c);
    mpm__surface_way(corner[0], x, off);
    mpm__surface_cross(b, c, n);
    square = mpm__surface_dot(n, n);
    mpm__surface_cross(off, c, across);
    inside[1] = square > 0 ? mpm__surface_dot(across, n) / square : -1;
    mpm__surface_cross(b, off, across);
    inside[2] = square > 0 ? mpm__surface_dot(across, n) / square : -1;
    inside[0] = 1 - inside[1] - inside[2];
    if (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) {
        const mpm_real height = mpm__surface_dot(off, n);
        for (k = 0; k < 3; k++) share[k] = inside[k];
        return height * height / square;
    }
    for (k = 0; k < 3; k++) {
        const int from = (k + 1) % 3, to = (k + 2) % 3; /* the edge across from corner k */
        if (inside[k] >= 0) continue;
        square = mpm__surface_on_line(corner[from], corner[to], x, &u);
        if (nearest >= 0 && !(square < nearest)) continue;
        nearest = square;
        share[k] = 0;
        share[from] = 1 - u;
        share[to] = u;
    }
    return nearest;
}

/* The place on a face nearest to x: its markers' shares, and the distance squared. */
static inline mpm_real mpm__surface_nearest(const mpm_surface *c, int32_t face, const mpm_real *x, mpm_real *share)
{
    const int32_t *f = c->face[face];
    const mpm_real *corner[3];
    mpm_real square;
    int k;
    for (k = 0; k < c->corners; k++) corner[k] = c->marker[f[k]].x;
    if (c->corners == 3) return mpm__surface_on_triangle(corner, x, share);
    square = mpm__surface_on_line(corner[0], corner[1], x, &share[1]);
    share[0] = 1 - share[1];
    share[2] = 0;
    return square;
}

/* How far the surface stands out over a face, at the place x that its corners' shares make: a curve through the corners
   at right angles to their normals n_k, of height sum_k share_k (x_k - x).n_k / 2, exact to the second order of the
   face's size. A corner whose normal is tilted by more than 18 degrees is an edge of the body: the face is flat. */
static inline mpm_real mpm__surface_rise(const mpm_surface *c, int32_t face, const mpm_real *share, const mpm_real *x)
{
    mpm_real out[3], way[3], length, rise = 0;
    int k;
    mpm__surface_vector(c, face, out);
    length = mpm__surface_length(out);
    for (k = 0; k < c->corners; k++) {
        const mpm_marker *m = &c->marker[c->face[face][k]];
        if (!(mpm__surface_dot(m->normal, out) > MPM_R(0.95) * length)) return 0;
        mpm__surface_way(x, m->x, way);
        rise += share[k] * mpm__surface_dot(way, m->normal) / 2;
    }
    return rise;
}

/* ---- faces beside faces, and their halving ---------------------------------------------------------- */

/* Drops markers that no face has, the others in their order, and finds which faces lie beside which. */
static inline mpm_status mpm__surface_join(mpm_surfaces *s, mpm_surface *c)
{
    const int n = c->corners;
    int32_t i, g, item, markers = 0;
    int k;
    if (!mpm__surface_buckets(s, c->markers, 3 * c->faces)) return mpm__surface_full(&s->fault, c->faces);
    for (i = 0; i < c->faces; i++)
        for (k = 0; k < n; k++) s->bucket[c->face[i][k]] = 0;
    for (i = 0; i < c->markers; i++)
        if (s->bucket[i] == 0) {
            s->bucket[i] = markers;
            c->marker[markers++] = c->marker[i];
        }
    c->markers = markers;
    for (i = 0; i < c->faces; i++)
        for (k = 0; k < n; k++) c->face[i][k] = s->bucket[c->face[i][k]];
    for (i = 0; i < s->buckets; i++) s->bucket[i] = -1; /* from here on a marker's list of corners: 3 face + k */
    for (item = 0; item < 3 * c->faces; item++) {
        c->beside[item / 3][item % 3] = -1;
        if (item % 3 >= n) continue;
        s->next[item] = s->bucket[c->face[item / 3][item % 3]];
        s->bucket[c->face[item / 3][item % 3]] = item;
    }
    for (i = 0; i < c->faces; i++)
        for (k = 0; k < n; k++) {
            const int32_t a = c->face[i][k], b = n == 3 ? c->face[i][(k + 1) % 3] : a;
            for (item = s->bucket[b]; item >= 0; item = s->next[item]) {
                g = item / 3;
                if (n == 3 ? c->face[g][(item + 1) % 3] == a : g != i && item % 3 != k) c->beside[i][k] = g;
            }
        }
    return MPM_OK;
}

/* A new marker between two, u of the way from a to b: it moves as they do, and meets what the first meets. */
static inline int32_t mpm__surface_between(mpm_surface *c, int32_t a, int32_t b, mpm_real u)
{
    const mpm_marker *p = &c->marker[a], *q = &c->marker[b];
    mpm_marker *m = &c->marker[c->markers];
    int d;
    *m = *p;
    for (d = 0; d < 3; d++) {
        m->x[d] = (1 - u) * p->x[d] + u * q->x[d];
        m->v[d] = (1 - u) * p->v[d] + u * q->v[d];
        m->force[d] = m->pull[d] = m->wall[d] = 0;
    }
    m->parent[0] = a;
    m->parent[1] = b;
    return c->markers++;
}

/* Edge of a triangle that goes from marker `from` to `to`; -1: none does. */
static inline int mpm__surface_edge(const mpm_surface *c, int32_t face, int32_t from, int32_t to)
{
    int k;
    for (k = 0; k < 3 && face >= 0; k++)
        if (c->face[face][k] == from && c->face[face][(k + 1) % 3] == to) return k;
    return -1;
}

/* Cuts a triangle from marker m, on its edge k, to the corner across: it keeps what lies at corner k. Returns the
   number of the rest: m, corner k + 1, the one across. */
static inline int32_t mpm__surface_cleave(mpm_surface *c, int32_t face, int k, int32_t m)
{
    const int next = (k + 1) % 3, across = (k + 2) % 3;
    const int32_t n = c->faces++, beyond = c->beside[face][next];
    const int edge = mpm__surface_edge(c, beyond, c->face[face][across], c->face[face][next]);
    mpm__surface_face(c, n, m, c->face[face][next], c->face[face][across]);
    c->beside[n][0] = -1;
    c->beside[n][1] = beyond;
    c->beside[n][2] = face;
    if (edge >= 0) c->beside[beyond][edge] = n;
    c->face[face][next] = m;
    c->beside[face][next] = n;
    return n;
}

/* Cuts a line at marker m: it keeps what lies at its first. */
static inline void mpm__surface_cleave_line(mpm_surface *c, int32_t face, int32_t m)
{
    const int32_t n = c->faces++, after = c->beside[face][1];
    mpm__surface_face(c, n, m, c->face[face][1], m);
    c->beside[n][0] = face;
    c->beside[n][1] = after;
    c->beside[n][2] = -1;
    if (after >= 0) c->beside[after][0] = n;
    c->face[face][1] = m;
    c->beside[face][1] = n;
}

/* Puts a marker u of the way along edge k of a face, and cuts there the faces that share the edge. */
static inline mpm_status mpm__surface_split(mpm_surfaces *s, mpm_surface *c, int32_t face, int k, mpm_real u)
{
    const mpm_status st = mpm__surface_grow(c, c->markers + 1, c->faces + 2, &s->fault);
    int32_t a, b, m, n, other, rest;
    int edge;
    if (st != MPM_OK) return st;
    a = c->face[face][k];
    b = c->face[face][(k + 1) % c->corners];
    m = mpm__surface_between(c, a, b, u);
    if (c->corners == 2) {
        mpm__surface_cleave_line(c, face, m);
        return MPM_OK;
    }
    other = c->beside[face][k];
    edge = mpm__surface_edge(c, other, b, a);
    n = mpm__surface_cleave(c, face, k, m);
    c->beside[face][k] = -1;
    if (edge < 0) return MPM_OK;
    rest = mpm__surface_cleave(c, other, edge, m);
    c->beside[face][k] = rest;
    c->beside[rest][0] = face;
    c->beside[n][0] = other;
    c->beside[other][edge] = n;
    return MPM_OK;
}

/* Takes off what lies behind side d of the grid: faces that cross it are cut there. */
static inline mpm_status mpm__surface_cut(mpm_surfaces *s, const mpm_world *w, mpm_surface *c, int d)
{
    const int axis = d / 2, edges = c->corners == 3 ? 3 : 1;
    const mpm_real inward = d & 1 ? MPM_R(-1.0) : MPM_R(1.0), plane = mpm__surface_side(w, d);
    const mpm_real hair = mpm__surface_hair(w);
    int32_t i, n = 0;
    int k;
    for (i = 0; i < c->faces; i++)
        for (k = 0; k < edges; k++) {
            const int32_t a = c->face[i][k], b = c->face[i][(k + 1) % c->corners];
            const mpm_real from = c->marker[a].x[axis] - plane, to = c->marker[b].x[axis] - plane;
            mpm_status st;
            if (!((from < -hair && to > hair) || (from > hair && to < -hair))) continue;
            if ((st = mpm__surface_split(s, c, i, k, from / (from - to))) != MPM_OK) return st;
            c->marker[c->markers - 1].x[axis] = plane;
            k = -1; /* its edges are others now */
        }
    for (i = 0; i < c->faces; i++) {
        int ahead = 0;
        for (k = 0; k < c->corners; k++) ahead += inward * (c->marker[c->face[i][k]].x[axis] - plane) >= hair;
        if (ahead) mpm__surface_face(c, n++, c->face[i][0], c->face[i][1], c->face[i][2]);
    }
    c->faces = n;
    return mpm__surface_join(s, c);
}

/* ---- neighbours ------------------------------------------------------------------------------------ */

/* Where a face (its middle) or a marker lies. */
static inline void mpm__surface_place(const mpm_surface *c, int markers, int32_t i, mpm_real *x)
{
    int k, d;
    for (d = 0; d < 3; d++) {
        x[d] = markers ? c->marker[i].x[d] : 0;
        for (k = 0; k < c->corners && !markers; k++) x[d] += c->marker[c->face[i][k]].x[d] / (mpm_real)c->corners;
    }
}

/* The cell of x; what lies far off the grid is in its last, on either side. */
static inline void mpm__surface_cell(const mpm_world *w, const mpm_real *x, int32_t *cell)
{
    const mpm_real most = MPM_R(1e9);
    int d;
    for (d = 0; d < 3; d++) {
        const mpm_real at = (x[d] - w->desc.origin[d]) / w->desc.cell + 8;
        cell[d] = at > most ? (int32_t)most : at > -most ? (int32_t)at : -(int32_t)most;
    }
}

static inline uint32_t mpm__surface_bucket(const mpm_surfaces *s, int32_t ix, int32_t iy, int32_t iz)
{
    return ((uint32_t)ix * 73856093u ^ (uint32_t)iy * 19349663u ^ (uint32_t)iz * 83492791u) &
           (uint32_t)(s->buckets - 1);
}

/* Puts the faces of a surface, or its markers, into buckets by the cells that they lie in. */
static inline mpm_status mpm__surface_sort(mpm_surfaces *s, const mpm_world *w, const mpm_surface *c, int markers)
{
    const int32_t n = markers ? c->markers : c->faces;
    int32_t i, cell[3];
    if (!mpm__surface_buckets(s, n, n)) return mpm__surface_full(&s->fault, n);
    for (i = n - 1; i >= 0; i--) {
        mpm_real x[3];
        uint32_t k;
        mpm__surface_place(c, markers, i, x);
        mpm__surface_cell(w, x, cell);
        k = mpm__surface_bucket(s, cell[0], cell[1], cell[2]);
        s->next[i] = s->bucket[k];
        s->bucket[k] = i;
    }
    return MPM_OK;
}

/* Those of a surface that lie within `range` cells of the cell of x: numbers to s->around, each once. From the buckets
   of these cells, or, where the cells are more than the faces or markers, by looking at all of those. */
static inline int32_t mpm__surface_around(mpm_surfaces *s, const mpm_world *w, const mpm_surface *c, int markers,
                                          const mpm_real *x, int32_t range)
{
    const int32_t deep = c->corners == 3 ? range : 0, all = markers ? c->markers : c->faces;
    const int64_t wide = 2 * (int64_t)range + 1, cells = wide * wide * (2 * (int64_t)deep + 1);
    int32_t at[3], cell[3], ix, iy, iz, i, n = 0;
    mpm_real place[3];
    mpm__surface_cell(w, x, at);
    for (i = 0; i < all && cells > all; i++) {
        mpm__surface_place(c, markers, i, place);
        mpm__surface_cell(w, place, cell);
        for (ix = 0; ix < 3 && cell[ix] >= at[ix] - range && cell[ix] <= at[ix] + range; ix++) continue;
        if (ix == 3) s->around[n++] = i;
    }
    if (cells > all) return n;
    for (iz = at[2] - range; iz <= at[2] + range; iz++)
        for (iy = at[1] - deep; iy <= at[1] + deep; iy++)
            for (ix = at[0] - range; ix <= at[0] + range; ix++)
                for (i = s->bucket[mpm__surface_bucket(s, ix, iy, iz)]; i >= 0; i = s->next[i]) {
                    mpm__surface_place(c, markers, i, place);
                    mpm__surface_cell(w, place, cell);
                    if (cell[0] == ix && cell[1] == iy && cell[2] == iz) s->around[n++] = i;
                }
    return n;
}

/* ---- the layer under a surface ------------------------------------------------------------------- */

/* A point's foot on the surface, if it lies in the layer. */
typedef struct mpm__foot {
    int within;
    mpm_real x[3], normal[3]; /* of the face there: its area times its normal */
} mpm__foot;

/* How many cells away a face can be whose nearest place is within the layer's depth. */
static inline int32_t mpm__layer_range(const mpm_surfaces *s, const mpm_world *w)
{
    const mpm_real cells = s->depth / w->desc.cell;
    return cells < 100 ? (int32_t)(cells + MPM_R(1.5)) : 101;
}

static inline mpm__foot mpm__layer_foot(mpm_surfaces *s, const mpm_world *w, const mpm_surface *c, const mpm_real *x)
{
    const int32_t n = mpm__surface_around(s, w, c, 0, x, mpm__layer_range(s, w));
    mpm_real nearest = s->depth * s->depth, share[3], square;
    mpm__foot foot;
    int32_t i;
    int k, d;
    memset(&foot, 0, sizeof foot);
    for (i = 0; i < n; i++) {
        square = mpm__surface_nearest(c, s->around[i], x, share);
        if (!(square < nearest)) continue;
        nearest = square;
        foot.within = 1;
        mpm__surface_vector(c, s->around[i], foot.normal);
        for (d = 0; d < 3; d++)
            for (k = 0, foot.x[d] = 0; k < c->corners; k++)
                foot.x[d] += share[k] * c->marker[c->face[s->around[i]][k]].x[d];
    }
    return foot;
}

/* Weight of a point whose foot is q depths from a marker: (1 - q)^2 (1 + 2 q). Not through a thin body: the foot's face
   may not look away from the marker's. */
static inline mpm_real mpm__layer_weight(const mpm_marker *m, const mpm__foot *foot, mpm_real depth)
{
    mpm_real way[3], q;
    mpm__surface_way(m->x, foot->x, way);
    q = mpm__surface_length(way) / depth;
    if (!(q < 1) || mpm__surface_dot(m->normal, foot->normal) < mpm__surface_length(foot->normal) / -2) return 0;
    return (1 - q) * (1 - q) * (1 + 2 * q);
}

/* Visits the markers near one foot, of point `number` with mass: counts their entries, or writes them. */
static inline void mpm__layer_near(mpm_surfaces *s, const mpm_world *w, mpm_surface *c, const mpm__foot *foot,
                                   int32_t number, mpm_real mass, int write)
{
    const int32_t n = mpm__surface_around(s, w, c, 1, foot->x, mpm__layer_range(s, w));
    int32_t i;
    for (i = 0; i < n; i++) {
        const mpm_real part = mpm__layer_weight(&c->marker[s->around[i]], foot, s->depth);
        int32_t *end = &c->layer.begin[s->around[i] + 1];
        if (!(part > 0)) continue;
        if (write) {
            c->layer.point[*end] = number;
            c->layer.weight[*end] = mass * part;
        }
        ++*end;
    }
}

/* Visits them for all points of the layer, and for their images in the mirrors close by. */
static inline void mpm__layer_visit(mpm_surfaces *s, const mpm_world *w, mpm_surface *c, const mpm__foot *foot,
                                    int write)
{
    const mpm_body *b = &w->body[c->body];
    int32_t i;
    int image, d;
    for (i = 0; i < b->count; i++)
        for (image = 0; image < 64 && foot[i].within; image++) { /* bit d: mirrored at side d */
            mpm__foot at = foot[i];
            for (d = 0; d < 6; d++) {
                const mpm_real plane = mpm__surface_side(w, d);
                if (!(image >> d & 1)) continue;
                if (!mpm__surface_mirrors(w, d) || mpm_fabs(at.x[d / 2] - plane) > s->depth) break;
                at.x[d / 2] = 2 * plane - at.x[d / 2];
                at.normal[d / 2] = -at.normal[d / 2];
            }
            if (d == 6)
                mpm__layer_near(s, w, c, &at, w->points.id[b->first + i] - c->layer.first_id,
                                w->points.mass[b->first + i], write);
        }
}

/* From counts behind each marker to where its entries begin: begin[k + 1] is where those of k are put next, and in the
   end where they end. */
static inline size_t mpm__layer_begin(mpm_layer *y)
{
    size_t sum = 0;
    int32_t k;
    for (k = 0; k < y->markers; k++) {
        const int32_t n = y->begin[k + 1];
        y->begin[k + 1] = (int32_t)sum;
        sum += (size_t)n;
    }
    return sum;
}

/* The points' feet on the surface, and their numbers. */
static inline mpm_status mpm__layer_feet(mpm_surfaces *s, const mpm_world *w, mpm_surface *c, mpm__foot *foot)
{
    const mpm_body *b = &w->body[c->body];
    const mpm_status st = mpm__surface_sort(s, w, c, 0);
    int32_t i;
    int d;
    c->layer.points = b->count;
    c->layer.first_id = b->count > 0 ? w->points.id[b->first] : 0;
    for (i = 0; i < b->count && st == MPM_OK; i++) {
        mpm_real x[3];
        if (w->points.id[b->first + i] < c->layer.first_id) c->layer.first_id = w->points.id[b->first + i];
        for (d = 0; d < 3; d++) x[d] = w->points.x[d][b->first + i];
        foot[i] = mpm__layer_foot(s, w, c, x);
    }
    return st;
}

/* The entries of all markers, from the feet. */
static inline mpm_status mpm__layer_fill(mpm_surfaces *s, const mpm_world *w, mpm_surface *c, const mpm__foot *foot)
{
    mpm_layer *y = &c->layer;
    size_t entries;
    int32_t k, i;
    mpm_status st = mpm__surface_sort(s, w, c, 1);
    if (st != MPM_OK) return st;
    mpm__layer_visit(s, w, c, foot, 0);
    entries = mpm__layer_begin(y);
    y->point = (int32_t *)MPM_MALLOC((entries + (size_t)y->points + 1) * sizeof *y->point);
    y->weight = (mpm_real *)MPM_MALLOC((entries + 1) * sizeof *y->weight);
    if (!y->point || !y->weight) return mpm__surface_full(&s->fault, (int32_t)entries);
    y->where = y->point + entries;
    mpm__layer_visit(s, w, c, foot, 1);
    for (k = 0; k < y->markers; k++) {
        mpm_real sum = 0;
        for (i = y->begin[k]; i < y->begin[k + 1]; i++) sum += y->weight[i];
        for (i = y->begin[k]; i < y->begin[k + 1]; i++) y->weight[i] /= sum;
    }
    return MPM_OK;
}

/* The layer of a new surface, from the points as they lie. */
static inline mpm_status mpm__layer_make(mpm_surfaces *s, const mpm_world *w, mpm_surface *c)
{
    const size_t n = (size_t)c->markers, points = (size_t)w->body[c->body].count;
    mpm_layer *y = &c->layer;
    mpm__foot *foot = (mpm__foot *)MPM_MALLOC((points + 1) * sizeof *foot);
    mpm_status st = foot ? MPM_OK : mpm__surface_full(&s->fault, (int32_t)points);
    y->mean = (mpm_real *)MPM_MALLOC(n * sizeof *y->mean);
    y->begin = (int32_t *)MPM_MALLOC((n + 1) * sizeof *y->begin);
    if (!y->mean || !y->begin) st = mpm__surface_full(&s->fault, c->markers);
    if (st == MPM_OK) {
        y->markers = c->markers;
        memset(y->mean, 0, n * sizeof *y->mean);
        memset(y->begin, 0, (n + 1) * sizeof *y->begin);
        st = mpm__layer_feet(s, w, c, foot);
    }
    if (st == MPM_OK) st = mpm__layer_fill(s, w, c, foot);
    mpm__surface_release(foot);
    return st;
}

/* The means of a layer now, and at every marker what they have grown by since they were taken last: at one that was put
   between two others, the mean of theirs. */
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
    for (k = 0; k < c->markers && y->markers > 0; k++) {
        mpm_marker *m = &c->marker[k];
        mpm_real sum = 0;
        if (k >= y->markers) {
            m->worked = (c->marker[m->parent[0]].worked + c->marker[m->parent[1]].worked) / 2;
            continue;
        }
        for (i = y->begin[k]; i < y->begin[k + 1]; i++)
            if (y->where[y->point[i]] >= 0) sum += y->weight[i] * w->points.plastic_work[y->where[y->point[i]]];
        m->worked = sum - y->mean[k];
        y->mean[k] = sum;
    }
}

/* G of all meetings that have touched: dG = l (d<w_p> of this body + d<w_p> of the other where it is met). */
static inline void mpm__layer_grow(mpm_surfaces *s)
{
    int32_t a, i;
    int k, j;
    for (a = 0; a < s->surfaces; a++)
        for (i = 0; i < s->surface[a].markers; i++)
            for (k = 0; k < MPM_SURFACE_MEETS; k++) {
                const mpm_marker *m = &s->surface[a].marker[i];
                mpm_meet *meet = &s->surface[a].marker[i].meet[k];
                const mpm_surface *c;
                mpm_real worked = m->worked;
                if (meet->other < 0 || !meet->touched) continue;
                c = &s->surface[meet->other];
                for (j = 0; j < c->corners; j++)
                    worked += meet->share[j] * c->marker[c->face[meet->face][j]].worked;
                meet->dissipated += s->depth * worked;
            }
}

/* ---- making a surface whole ------------------------------------------------------------------------ */

/* A new surface of body `body`, still empty, in `s`, of the world's geometry. */
static inline mpm_surface *mpm__surface_new(mpm_surfaces *s, const mpm_world *w, int32_t body, mpm_status *st)
{
    mpm_fault *f = &s->fault;
    mpm_surface *c;
    void *more;
    int32_t i;
    *st = mpm_surfaces_check(s, f);
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
    c = &s->surface[s->surfaces];
    memset(c, 0, sizeof *c);
    c->body = body;
    c->corners = w->desc.geometry == MPM_3D ? 3 : 2;
    return c;
}

/* Takes off faces with dampers: the body goes on there. */
static inline void mpm__surface_open(const mpm_world *w, mpm_surface *c)
{
    const mpm_body_desc *b = &w->body[c->body].desc;
    int32_t i, n = 0;
    for (i = 0; i < c->faces; i++) {
        mpm_real out[3], up, area;
        mpm__surface_vector(c, i, out);
        area = mpm__surface_length(out);
        up = area > 0 ? out[2] / area : 0;
        if (b->absorb & MPM_FACE_BOTTOM && up < MPM_R(-0.9)) continue;
        if (b->absorb & MPM_FACE_RIM && up > MPM_R(-0.1) && up < MPM_R(0.1)) continue;
        mpm__surface_face(c, n++, c->face[i][0], c->face[i][1], c->face[i][2]);
    }
    c->faces = n;
}

/* Joins the faces of a new surface, cuts it at the mirrors, gives its markers the body's velocity and counts it in. */
static inline mpm_status mpm__surface_finish(mpm_surfaces *s, const mpm_world *w)
{
    mpm_surface *c = &s->surface[s->surfaces];
    mpm_status st = mpm__surface_join(s, c);
    int32_t i;
    int d;
    for (d = 0; d < 6 && st == MPM_OK; d++)
        if (mpm__surface_mirrors(w, d)) st = mpm__surface_cut(s, w, c, d);
    if (st == MPM_OK) st = mpm_want(c->markers >= 2, &s->fault, "markers of a surface", (mpm_real)c->markers, -1);
    if (st != MPM_OK) return mpm__surface_drop(c, st);
    for (i = 0; i < c->markers; i++) {
        c->marker[i].parent[0] = c->marker[i].parent[1] = -1;
        for (d = 0; d < 3; d++) c->marker[i].v[d] = w->body[c->body].desc.velocity[d];
    }
    mpm__surface_measure(w, c);
    if (s->adhesion > 0 && (st = mpm__layer_make(s, w, c)) != MPM_OK) return mpm__surface_drop(c, st);
    s->surfaces++;
    return MPM_OK;
}

/* Room for the n places of a caller's, checked, and put as markers. */
static inline mpm_status mpm__surface_places(mpm_surfaces *s, mpm_surface *c, int32_t n, int32_t faces,
                                             const mpm_real *const x[3])
{
    mpm_status st = mpm_want(n >= 2 && faces >= 1, &s->fault, "markers of a surface", (mpm_real)n, -1);
    int32_t i;
    int d;
    for (i = 0; i < n && st == MPM_OK; i++)
        for (d = 0; d < 3; d++)
            if (x[d] && !mpm_finite(x[d][i])) return mpm_fail(&s->fault, MPM_ERR_NAN, "place of a marker", x[d][i], i);
    if (st == MPM_OK) st = mpm__surface_grow(c, n, faces, &s->fault);
    if (st != MPM_OK) return mpm__surface_drop(c, st);
    for (i = 0; i < n; i++) mpm__surface_put(c, i, x[0][i], x[1] ? x[1][i] : 0, x[2][i]);
    c->markers = n;
    c->faces = faces;
    return MPM_OK;
}

MPM_API mpm_status mpm_surface_add_chain(mpm_surfaces *s, const mpm_world *w, int32_t body, int32_t n,
                                         const mpm_real *x, const mpm_real *z, int closed)
{
    const mpm_real *place[3];
    mpm_status st;
    mpm_surface *c = mpm__surface_new(s, w, body, &st);
    int32_t i;
    if (!c) return st;
    st = mpm_want(c->corners == 2, &s->fault, "geometry (a chain is of two dimensions)", MPM_3D, -1);
    if (st != MPM_OK) return st;
    place[0] = x;
    place[1] = NULL;
    place[2] = z;
    if ((st = mpm__surface_places(s, c, n, closed ? n : n - 1, place)) != MPM_OK) return st;
    for (i = 0; i < c->faces; i++) mpm__surface_face(c, i, i, i + 1 < n ? i + 1 : 0, i);
    return mpm__surface_finish(s, w);
}

MPM_API mpm_status mpm_surface_add_triangles(mpm_surfaces *s, const mpm_world *w, int32_t body, int32_t n,
                                             const mpm_real *const x[3], int32_t triangles,
                                             const int32_t (*triangle)[3])
{
    mpm_status st;
    mpm_surface *c = mpm__surface_new(s, w, body, &st);
    int32_t i;
    int k;
    if (!c) return st;
    st = mpm_want(c->corners == 3, &s->fault, "geometry (triangles are of three dimensions)",
                  (mpm_real)w->desc.geometry, -1);
    for (i = 0; i < triangles && st == MPM_OK; i++)
        for (k = 0; k < 3 && st == MPM_OK; k++)
            st = mpm_want(triangle[i][k] >= 0 && triangle[i][k] < n, &s->fault, "place of triangle",
                          (mpm_real)triangle[i][k], i);
    if (st != MPM_OK) return st;
    if ((st = mpm__surface_places(s, c, n, triangles, x)) != MPM_OK) return st;
    for (i = 0; i < triangles; i++) mpm__surface_face(c, i, triangle[i][0], triangle[i][1], triangle[i][2]);
    return mpm__surface_finish(s, w);
}

/* ---- surfaces of shapes ------------------------------------------------------------------------------ */

/* Intervals of a way, an even number, none longer than `apart`. */
static inline int32_t mpm__outline_count(mpm_real way, mpm_real apart)
{
    return 2 * (1 + (int32_t)(way / (2 * apart) * (1 - 64 * MPM_EPSILON)));
}

/* Marker i on the outline of a box, counter-clockwise from its lower left corner: na below and above, nb at a side. */
static inline void mpm__outline_box(const mpm_shape *b, int32_t i, int32_t na, int32_t nb, mpm_real *x, mpm_real *z)
{
    static const int right[5] = {-1, 1, 1, -1, -1}, up[5] = {-1, -1, 1, 1, -1};
    int side = 0;
    mpm_real u;
    for (; i >= (side % 2 ? nb : na); side++) i -= side % 2 ? nb : na;
    u = (mpm_real)i / (mpm_real)(side % 2 ? nb : na);
    *x = b->center[0] + b->half[0] * ((1 - u) * (mpm_real)right[side] + u * (mpm_real)right[side + 1]);
    *z = b->center[2] + b->half[2] * ((1 - u) * (mpm_real)up[side] + u * (mpm_real)up[side + 1]);
}

/* The chain around an ellipsoid, from its lower pole to the right, or around a cylinder or box. */
static inline mpm_status mpm__outline_chain(mpm_surfaces *s, mpm_surface *c, const mpm_shape *b, mpm_real apart)
{
    const int32_t na = 1 + (int32_t)(2 * b->half[0] / apart * (1 - 64 * MPM_EPSILON));
    const int32_t nb = 1 + (int32_t)(2 * b->half[2] / apart * (1 - 64 * MPM_EPSILON));
    const int round = b->kind == MPM_SHAPE_ELLIPSOID;
    const int32_t quarter = 1 + (int32_t)(MPM_PI / 4 * (b->half[0] + b->half[2]) / apart);
    const int32_t n = round ? 4 * quarter : 2 * (na + nb);
    mpm_status st = mpm__surface_grow(c, n, n, &s->fault);
    int32_t i;
    for (i = 0; i < n && st == MPM_OK; i++) {
        const double turn = (double)(2 * MPM_PI * ((mpm_real)i / (mpm_real)n - MPM_R(0.25)));
        mpm_real x, z;
        if (round) {
            x = i % (n / 2) ? b->center[0] + b->half[0] * (mpm_real)cos(turn) : b->center[0];
            z = b->center[2] + b->half[2] * (mpm_real)sin(turn);
        } else {
            mpm__outline_box(b, i, na, nb, &x, &z);
        }
        mpm__surface_put(c, i, x, 0, z);
        mpm__surface_face(c, i, i, i + 1 < n ? i + 1 : 0, i);
    }
    c->markers = c->faces = st == MPM_OK ? n : 0;
    return st;
}

/* The surface of a cube as a lattice of n[0] x n[1] x n[2] intervals: the number of its place (i, j, k). The lower face
   row by row, then rings around the sides, then the upper face. */
static inline int32_t mpm__outline_number(const int32_t *n, const int32_t *at)
{
    const int32_t face = (n[0] + 1) * (n[1] + 1), ring = 2 * (n[0] + n[1]), i = at[0], j = at[1], k = at[2];
    if (k == 0) return j * (n[0] + 1) + i;
    if (k == n[2]) return face + (k - 1) * ring + j * (n[0] + 1) + i;
    return face + (k - 1) * ring + (j == 0 ? i : i == n[0] ? n[0] + j : j == n[1] ? 2 * n[0] + n[1] - i : ring - j);
}

/* Where a place u of the cube -1 .. 1 lies on the shape: a box as it is; an ellipsoid by equal angles from the middle
   of each face; a cylinder with squares turned into circles (Shirley and Chiu, J. Graphics Tools 2, 45, 1997). */
static inline void mpm__outline_map(const mpm_shape *b, mpm_real *u)
{
    int d;
    if (b->kind == MPM_SHAPE_ELLIPSOID) {
        mpm_real length;
        for (d = 0; d < 3; d++) u[d] = (mpm_real)tan((double)(MPM_PI / 4 * u[d]));
        length = mpm__surface_length(u);
        for (d = 0; d < 3; d++) u[d] /= length;
    } else if (b->kind == MPM_SHAPE_CYLINDER && (u[0] != 0 || u[1] != 0)) {
        const int steep = mpm_fabs(u[1]) > mpm_fabs(u[0]);
        const mpm_real radius = steep ? u[1] : u[0], turn = MPM_PI / 4 * (steep ? u[0] : u[1]) / radius;
        u[steep ? 1 : 0] = radius * (mpm_real)cos((double)turn);
        u[steep ? 0 : 1] = radius * (mpm_real)sin((double)turn);
    }
    for (d = 0; d < 3; d++) u[d] = b->center[d] + b->half[d] * u[d];
}

/* Two triangles for each square of one face of the cube, across `axis`, at its upper end or the lower. Diagonals lead
   away from the middle, so that what the shape mirrors the triangles mirror. */
static inline void mpm__outline_face(mpm_surface *c, const int32_t *n, int axis, int upper)
{
    const int b = (axis + 1) % 3, e = (axis + 2) % 3;
    int32_t p, q, corner[4];
    int k;
    for (q = 0; q < n[e]; q++)
        for (p = 0; p < n[b]; p++) {
            const int along = (2 * p + 1 < n[b]) == (2 * q + 1 < n[e]);
            for (k = 0; k < 4; k++) { /* around the square, counter-clockwise from outside */
                int32_t at[3];
                at[axis] = upper ? n[axis] : 0;
                at[b] = p + (upper ? k == 1 || k == 2 : k == 2 || k == 3);
                at[e] = q + (upper ? k == 2 || k == 3 : k == 1 || k == 2);
                corner[k] = mpm__outline_number(n, at);
            }
            mpm__surface_face(c, c->faces++, corner[0], corner[1], corner[along ? 2 : 3]);
            mpm__surface_face(c, c->faces++, corner[2], corner[3], corner[along ? 0 : 1]);
        }
}

/* The triangles of an ellipsoid, cylinder or box. */
static inline mpm_status mpm__outline_triangles(mpm_surfaces *s, mpm_surface *c, const mpm_shape *b, mpm_real apart)
{
    const mpm_real arc = b->kind == MPM_SHAPE_ELLIPSOID ? MPM_PI / 2 : 2;
    int32_t n[3], at[3], faces;
    double count = 0;
    mpm_status st;
    int d;
    for (d = 0; d < 3; d++) n[d] = mpm__outline_count(arc * b->half[d], apart);
    for (d = 0; d < 3; d++) count += 4.0 * (double)n[d] * (double)n[(d + 1) % 3];
    if (count > 1e9) return mpm__surface_full(&s->fault, INT32_MAX);
    faces = (int32_t)count;
    if ((st = mpm__surface_grow(c, faces / 2 + 2, faces, &s->fault)) != MPM_OK) return st;
    for (at[2] = 0; at[2] <= n[2]; at[2]++)
        for (at[1] = 0; at[1] <= n[1]; at[1]++)
            for (at[0] = 0; at[0] <= n[0]; at[0]++) {
                mpm_real u[3];
                int inner = 1;
                for (d = 0; d < 3; d++) {
                    inner &= at[d] > 0 && at[d] < n[d];
                    u[d] = (mpm_real)(2 * at[d] - n[d]) / (mpm_real)n[d];
                }
                if (inner) continue;
                mpm__outline_map(b, u);
                mpm__surface_put(c, mpm__outline_number(n, at), u[0], u[1], u[2]);
            }
    c->markers = faces / 2 + 2; /* Euler: of any closed surface of triangles without a hole through it */
    for (d = 0; d < 3; d++) {
        mpm__outline_face(c, n, d, 0);
        mpm__outline_face(c, n, d, 1);
    }
    return MPM_OK;
}

/* ---- surfaces of shapes that a function gives ---------------------------------------------------------- */

/* A lattice is walked upwards, two of its layers at a time. Each of its squares or cubes falls into triangles or
   tetrahedra along the paths from its first corner to the last (Kuhn, IBM J. Res. Dev. 4, 518, 1960); where inside
   meets outside along an edge of those there is a marker. Corner bits: 1 x, 2 y, 4 z. */
typedef struct mpm__march {
    const mpm_shape *shape;
    int32_t n[3];         /* places of the lattice */
    mpm_real low[3], step[3];
    uint8_t *in[2];       /* per place of the layers k and k + 1 */
    int32_t *marker[2];   /* per place, 8 of them: on the edge towards the corner with these bits; -1: none yet */
} mpm__march;

static inline void mpm__march_place(const mpm__march *q, const int32_t *at, mpm_real *x)
{
    int d;
    for (d = 0; d < 3; d++) x[d] = q->low[d] + (mpm_real)at[d] * q->step[d];
}

static inline int mpm__march_inside(const mpm__march *q, const mpm_real *x)
{
    return mpm_shape_contains(q->shape, x[0], x[1], x[2]);
}

/* Layer k of the lattice, as the lower (0) or upper (1) of the two. */
static inline void mpm__march_layer(mpm__march *q, int32_t k, int upper)
{
    int32_t at[3], i = 0;
    at[2] = k;
    for (at[1] = 0; at[1] < q->n[1]; at[1]++)
        for (at[0] = 0; at[0] < q->n[0]; at[0]++, i++) {
            mpm_real x[3];
            mpm__march_place(q, at, x);
            q->in[upper][i] = (uint8_t)mpm__march_inside(q, x);
            memset(&q->marker[upper][8 * i], -1, 8 * sizeof **q->marker);
        }
}

/* Moves a corner of the square or cube at `at` to its place. */
static inline void mpm__march_corner(const int32_t *at, int bits, int32_t *corner)
{
    int d;
    for (d = 0; d < 3; d++) corner[d] = at[d] + (bits >> d & 1);
}

static inline int32_t mpm__march_index(const mpm__march *q, const int32_t *at, int bits)
{
    return (at[1] + (bits >> 1 & 1)) * q->n[0] + at[0] + (bits & 1);
}

/* The marker between two corners, one inside and one outside, made if there is none yet; -1: no memory. */
static inline int32_t mpm__march_marker(mpm_surfaces *s, mpm_surface *c, mpm__march *q, const int32_t *at, int a, int b)
{
    const int from = a & b, to = a | b; /* one of them has all bits of the other */
    int32_t *known = &q->marker[from >> 2][8 * mpm__march_index(q, at, from) + (to & ~from)], corner[3];
    mpm_real x[3], y[3], middle[3];
    int k, d;
    if (*known >= 0) return *known;
    if (mpm__surface_grow(c, c->markers + 1, c->faces, &s->fault) != MPM_OK) return -1;
    mpm__march_corner(at, a, corner);
    mpm__march_place(q, corner, x);
    mpm__march_corner(at, b, corner);
    mpm__march_place(q, corner, y);
    for (k = 0; k < 10; k++) { /* x stays inside */
        for (d = 0; d < 3; d++) middle[d] = (x[d] + y[d]) / 2;
        memcpy(mpm__march_inside(q, middle) ? x : y, middle, sizeof middle);
    }
    mpm__surface_put(c, c->markers, (x[0] + y[0]) / 2, (x[1] + y[1]) / 2, (x[2] + y[2]) / 2);
    return *known = c->markers++;
}

/* A face of markers m, turned so that it looks along `out`. */
static inline mpm_status mpm__march_face(mpm_surfaces *s, mpm_surface *c, const int32_t *m, const mpm_real *out)
{
    const mpm_status st = mpm__surface_grow(c, c->markers, c->faces + 1, &s->fault);
    mpm_real n[3];
    if (st != MPM_OK) return st;
    mpm__surface_face(c, c->faces, m[0], m[1], m[c->corners - 1]);
    mpm__surface_vector(c, c->faces, n);
    if (mpm__surface_dot(n, out) < 0) mpm__surface_face(c, c->faces, m[1], m[0], m[c->corners - 1]);
    c->faces++;
    return MPM_OK;
}

/* The faces in one triangle or tetrahedron, whose corners have these bits: between `ins` of them that lie inside and
   the others. */
static inline mpm_status mpm__march_simplex(mpm_surfaces *s, mpm_surface *c, mpm__march *q, const int32_t *at,
                                            const int *corner)
{
    const int corners = c->corners + 1;
    int list[4], ins = 0, outs = 0, k, d, i, j;
    int32_t m[4];
    mpm_real out[3] = {0, 0, 0};
    mpm_status st;
    for (k = 0; k < corners; k++) { /* inside from the front, outside from the back */
        const int in = q->in[corner[k] >> 2][mpm__march_index(q, at, corner[k])];
        list[in ? ins++ : corners - ++outs] = corner[k];
    }
    if (!ins || !outs) return MPM_OK;
    for (i = 0; i < ins; i++)
        for (j = ins; j < corners; j++)
            for (d = 0; d < 3; d++) out[d] += (mpm_real)((list[j] >> d & 1) - (list[i] >> d & 1)) * q->step[d];
    for (k = 0; k < ins * outs; k++) { /* around the face: of a square of markers, each shares a corner with the next */
        i = k / outs;
        j = i % 2 ? outs - 1 - k % outs : k % outs;
        if ((m[k] = mpm__march_marker(s, c, q, at, list[i], list[ins + j])) < 0) return MPM_ERR_MEMORY;
    }
    if ((st = mpm__march_face(s, c, m, out)) != MPM_OK || ins * outs < 4) return st;
    m[1] = m[0];
    return mpm__march_face(s, c, m + 1, out);
}

/* All paths through the square or cube at `at`. */
static inline mpm_status mpm__march_cube(mpm_surfaces *s, mpm_surface *c, mpm__march *q, const int32_t *at)
{
    static const int path[6][2] = {{1, 4}, {4, 1}, {1, 2}, {2, 1}, {2, 4}, {4, 2}};
    int k;
    for (k = 0; k < (c->corners == 3 ? 6 : 2); k++) {
        int corner[4];
        mpm_status st;
        corner[0] = 0;
        corner[1] = path[k][0];
        corner[2] = path[k][0] | path[k][1];
        corner[3] = 7;
        if ((st = mpm__march_simplex(s, c, q, at, corner)) != MPM_OK) return st;
    }
    return MPM_OK;
}

/* The surface of what the body's function says is inside. */
static inline mpm_status mpm__march_shape(mpm_surfaces *s, mpm_surface *c, const mpm_shape *b, mpm_real apart)
{
    mpm__march q;
    mpm_status st = MPM_OK;
    int32_t at[3];
    double places = 1;
    void *room;
    int d;
    q.shape = b;
    for (d = 0; d < 3; d++) { /* half a step beyond the box, where nothing is inside; flat in two dimensions */
        const int flat = d == 1 && c->corners == 2;
        const mpm_real steps = 2 * b->half[d] / apart;
        if (!(steps < 30000)) return mpm__surface_full(&s->fault, INT32_MAX);
        q.n[d] = flat ? 1 : (int32_t)steps + 3;
        q.step[d] = 2 * b->half[d] / (mpm_real)((int32_t)steps + 1);
        q.low[d] = flat ? 0 : b->center[d] - b->half[d] - q.step[d] / 2;
        if (d < 2) places *= (double)q.n[d];
    }
    if (places > 1e8) return mpm__surface_full(&s->fault, INT32_MAX);
    room = MPM_MALLOC((size_t)places * 2 * (8 * sizeof **q.marker + 1));
    if (!room) return mpm__surface_full(&s->fault, (int32_t)places);
    q.marker[0] = (int32_t *)room;
    q.marker[1] = q.marker[0] + 8 * (size_t)places;
    q.in[0] = (uint8_t *)(q.marker[1] + 8 * (size_t)places);
    q.in[1] = q.in[0] + (size_t)places;
    mpm__march_layer(&q, 0, 0);
    for (at[2] = 0; at[2] < q.n[2] - 1 && st == MPM_OK; at[2]++) {
        int32_t *marker = q.marker[0];
        uint8_t *in = q.in[0];
        mpm__march_layer(&q, at[2] + 1, 1);
        for (at[1] = 0; at[1] < (q.n[1] > 1 ? q.n[1] - 1 : 1) && st == MPM_OK; at[1]++)
            for (at[0] = 0; at[0] < q.n[0] - 1 && st == MPM_OK; at[0]++) st = mpm__march_cube(s, c, &q, at);
        q.marker[0] = q.marker[1];
        q.marker[1] = marker;
        q.in[0] = q.in[1];
        q.in[1] = in;
    }
    MPM_FREE(room);
    return st;
}

MPM_API mpm_status mpm_surface_add(mpm_surfaces *s, const mpm_world *w, int32_t body)
{
    mpm_status st;
    mpm_surface *c = mpm__surface_new(s, w, body, &st);
    const mpm_body_desc *b;
    mpm_real apart;
    int d;
    if (!c) return st;
    b = &w->body[body].desc;
    for (d = 0; d < 3 && st == MPM_OK; d++)
        if (d != 1 || c->corners == 3)
            st = mpm_want(b->shape.kind != MPM_SHAPE_NONE && b->shape.half[d] > 0 &&
                              (b->shape.kind != MPM_SHAPE_USER || b->shape.inside), &s->fault,
                          "shape of body (it has none)", (mpm_real)b->shape.kind, body);
    if (st != MPM_OK) return st;
    apart = c->corners == 3 ? w->desc.cell / 4 : b->spacing / 2;
    if (b->shape.kind == MPM_SHAPE_USER) st = mpm__march_shape(s, c, &b->shape, apart);
    else if (c->corners == 3) st = mpm__outline_triangles(s, c, &b->shape, apart);
    else st = mpm__outline_chain(s, c, &b->shape, apart);
    if (st != MPM_OK) return mpm__surface_drop(c, st);
    mpm__surface_open(w, c);
    return mpm__surface_finish(s, w);
}

MPM_API mpm_status mpm_surface_wall_add(mpm_surfaces *s, const mpm_real point[3], const mpm_real normal[3])
{
    const mpm_real length = mpm__surface_length(normal);
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
    mpm_real n[3];
    mpm__surface_vector(c, face, n);
    return mpm__surface_dot(m->normal, n) < 0;
}

/* Takes face `face` for a meeting if it is nearer than what stands there. */
static inline void mpm__surface_try(const mpm_surface *c, int32_t face, const mpm_marker *m, mpm_meet *meet,
                                    mpm_real *nearest)
{
    mpm_real share[3], square;
    int k;
    if (face < 0 || !mpm__surface_faces(c, face, m)) return;
    square = mpm__surface_nearest(c, face, m->x, share);
    if (!(square < *nearest)) return;
    *nearest = square;
    meet->face = face;
    for (k = 0; k < 3; k++) meet->share[k] = share[k];
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

/* The box around a surface, and a cell more on every side. */
static inline void mpm__surface_bounds(const mpm_world *w, const mpm_surface *c, mpm_real *low, mpm_real *high)
{
    int32_t i;
    int d;
    for (d = 0; d < 3; d++) {
        low[d] = high[d] = c->marker[0].x[d];
        for (i = 1; i < c->markers; i++) {
            if (c->marker[i].x[d] < low[d]) low[d] = c->marker[i].x[d];
            if (c->marker[i].x[d] > high[d]) high[d] = c->marker[i].x[d];
        }
        low[d] -= w->desc.cell;
        high[d] += w->desc.cell;
    }
}

/* Looks for the nearest face of surface b, now in the buckets, to each marker of a. */
static inline void mpm__surface_search(mpm_surfaces *s, const mpm_world *w, int32_t a, int32_t b)
{
    const mpm_surface *other = &s->surface[b];
    mpm_real low[3], high[3];
    int32_t i, k;
    int d;
    mpm__surface_bounds(w, other, low, high);
    for (i = 0; i < s->surface[a].markers; i++) {
        mpm_marker *m = &s->surface[a].marker[i];
        mpm_real nearest = w->desc.cell * w->desc.cell;
        mpm_meet found, *meet;
        int32_t n = 0;
        int apart = 0;
        memset(&found, 0, sizeof found);
        found.face = -1;
        for (d = 0; d < 3; d++) apart |= m->x[d] < low[d] || m->x[d] > high[d];
        if (!apart) n = mpm__surface_around(s, w, other, 0, m->x, 1);
        for (k = 0; k < n; k++) mpm__surface_try(other, s->around[k], m, &found, &nearest);
        meet = mpm__surface_meet(m, b, found.face >= 0);
        if (!meet || (found.face < 0 && meet->touched)) continue; /* what once touched is kept: its G is asked for */
        if (found.face < 0) meet->other = MPM_SURFACE_NONE;
        meet->face = found.face;
        for (k = 0; k < 3; k++) meet->share[k] = found.share[k];
    }
}

/* Follows a meeting from the face it had to its neighbours, as long as they are nearer. */
static inline void mpm__surface_follow(const mpm_surface *c, const mpm_marker *m, mpm_meet *meet)
{
    mpm_real nearest = mpm__surface_nearest(c, meet->face, m->x, meet->share);
    int32_t from;
    int k;
    do {
        from = meet->face;
        for (k = 0; k < c->corners; k++) mpm__surface_try(c, c->beside[from][k], m, meet, &nearest);
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

/* A marker of the face that a meeting is with, k < corners. */
static inline mpm_marker *mpm__surface_met(const mpm_surfaces *s, const mpm_meet *meet, int k)
{
    const mpm_surface *c = &s->surface[meet->other];
    return &c->marker[c->face[meet->face][k]];
}

/* Velocity of what a marker meets, where it meets it. */
static inline void mpm__surface_velocity(const mpm_surfaces *s, const mpm_meet *meet, mpm_real *v)
{
    int k, d;
    for (d = 0; d < 3; d++) {
        v[d] = meet->other < 0 ? s->wall[-1 - meet->other].velocity[d] : 0;
        for (k = 0; meet->other >= 0 && k < s->surface[meet->other].corners; k++)
            v[d] += meet->share[k] * mpm__surface_met(s, meet, k)->v[d];
    }
}

/* Gap, its rate and the normal of a meeting with a surface: the normal goes evenly from one marker's to the next, and
   the gap is that to the curve. */
static inline void mpm__surface_gap(const mpm_surfaces *s, const mpm_marker *m, mpm_meet *meet)
{
    mpm_real x[3] = {0, 0, 0}, v[3], length;
    int k, d;
    for (d = 0; d < 3; d++) meet->normal[d] = 0;
    for (k = 0; k < s->surface[meet->other].corners; k++)
        for (d = 0; d < 3; d++) {
            meet->normal[d] += meet->share[k] * mpm__surface_met(s, meet, k)->normal[d];
            x[d] += meet->share[k] * mpm__surface_met(s, meet, k)->x[d];
        }
    length = mpm__surface_length(meet->normal);
    mpm__surface_velocity(s, meet, v);
    meet->gap = -mpm__surface_rise(&s->surface[meet->other], meet->face, meet->share, x);
    meet->rate = 0;
    for (d = 0; d < 3; d++) {
        meet->normal[d] = length > 0 ? meet->normal[d] / length : 0;
        meet->gap += (m->x[d] - x[d]) * meet->normal[d];
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
        if ((st = mpm__surface_sort(s, w, &s->surface[b], 0)) != MPM_OK) return st;
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
     w_I = N_I m_I / (m_I + eps m_ref), normalised to sum 1;  m_ref = rho h^3, in rings rho h^2 2 pi r_I, in plane
     strain rho h^2                                                                                             (S1)
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
        mpm_real place[3], length = w->desc.geometry == MPM_3D ? h : 1;
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
    const int corners = meet->other < 0 ? 0 : s->surface[meet->other].corners;
    mpm_real t[3] = {0, 0, 0};
    int d, j;
    if (s->friction > 0) mpm__surface_friction(s, m, meet, k, dt, t);
    if (s->adhesion > 0 && meet->other >= 0) mpm__surface_adhere(s, m, meet, k, dt);
    for (d = 0; d < 3; d++) {
        const mpm_real f = share * m->area * (meet->pressure * meet->normal[d] + t[d]);
        const mpm_real pull = share * m->area * meet->tension[d];
        if (meet->other < 0) {
            m->wall[d] += f;
            continue;
        }
        m->force[d] += f;
        m->pull[d] += pull;
        for (j = 0; j < corners; j++) {
            mpm__surface_met(s, meet, j)->force[d] -= meet->share[j] * f;
            mpm__surface_met(s, meet, j)->pull[d] -= meet->share[j] * pull;
        }
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
            if (!(mpm__surface_dot(f, f) > 0)) continue;
            if (mpm__surface_support(s, w, s->surface[a].body, m->x, &at)) mpm_push(w, &at, f);
        }
    return MPM_OK;
}

/* ---- moving along -------------------------------------------------------------------------------- */

/* Halves an edge of a face: the new marker is on the curve. */
static inline mpm_status mpm__surface_halve(mpm_surfaces *s, mpm_surface *c, int32_t face, int k)
{
    const int next = (k + 1) % c->corners;
    const mpm_marker *a = &c->marker[c->face[face][k]], *b = &c->marker[c->face[face][next]];
    mpm_real share[3] = {0, 0, 0}, middle[3], out[3], rise, length;
    mpm_status st;
    int d;
    share[k] = share[next] = MPM_R(0.5);
    for (d = 0; d < 3; d++) {
        middle[d] = (a->x[d] + b->x[d]) / 2;
        out[d] = a->normal[d] + b->normal[d];
    }
    rise = mpm__surface_rise(c, face, share, middle);
    length = mpm__surface_length(out);
    st = mpm__surface_split(s, c, face, k, MPM_R(0.5));
    for (d = 0; d < 3 && st == MPM_OK && length > 0; d++) {
        c->marker[c->markers - 1].normal[d] = out[d] / length;
        c->marker[c->markers - 1].x[d] += rise * out[d] / length;
    }
    return st;
}

/* Halves the longest edges of faces that have grown too long. */
static inline mpm_status mpm__surface_refine(mpm_surfaces *s, const mpm_world *w, mpm_surface *c)
{
    const int edges = c->corners == 3 ? 3 : 1;
    const mpm_real most = s->longest * w->desc.cell;
    const int32_t faces = c->faces;
    int32_t i;
    int k;
    for (i = 0; i < faces; i++) {
        mpm_real longest = most * most;
        int worst = -1;
        mpm_status st;
        for (k = 0; k < edges; k++) {
            mpm_real way[3], square;
            mpm__surface_way(c->marker[c->face[i][k]].x, c->marker[c->face[i][(k + 1) % c->corners]].x, way);
            square = mpm__surface_dot(way, way);
            if (!(square > longest)) continue;
            longest = square;
            worst = k;
        }
        if (worst >= 0 && (st = mpm__surface_halve(s, c, i, worst)) != MPM_OK) return st;
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
                const int pressed = mpm__surface_dot(m->force, m->force) > 0;
                const int drawn = mpm__surface_dot(m->pull, m->pull) > 0;
                const double work = pressed ? mpm_support_work(w, &at, m->force) : 0;
                const double pulled = drawn ? mpm_support_work(w, &at, m->pull) : 0;
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
    mpm_calm(w);
    mpm_to_nodes(w);
    if ((later = mpm_surface_contact(s, w)) < 0) {
        w->fault = s->fault;
        return later;
    }
    mpm_grid_update(w);
    mpm_to_points(w);
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

/* ---- restart --------------------------------------------------------------------------------- */

#define MPM__SURFACE_ARRAYS 3 /* of each surface, first among its blobs: markers, faces, those beside them */

MPM_API int mpm_surfaces_blobs(mpm_surfaces *s, mpm_blob *blob)
{
    int32_t a;
    int n = 0;
    for (a = 0; a < s->surfaces; a++) {
        mpm_surface *c = &s->surface[a];
        const size_t faces = (size_t)c->faces, room = (size_t)c->face_capacity;
        blob[n++] = mpm_blob_array("markers of surface", c->marker, (size_t)c->markers, (size_t)c->marker_capacity,
                                   sizeof *c->marker);
        blob[n++] = mpm_blob_array("faces of surface", c->face, faces, room, sizeof *c->face);
        blob[n++] = mpm_blob_array("faces beside them", c->beside, faces, room, sizeof *c->beside);
        blob[n++] = mpm_blob_of("size of surface", &c->markers, 2 * sizeof c->markers); /* and faces, side by side */
        blob[n++] = mpm_blob_of("means of layer", c->layer.mean, (size_t)c->layer.markers * sizeof *c->layer.mean);
    }
    blob[n++] = mpm_blob_of("walls", s->wall, (size_t)s->walls * sizeof s->wall[0]);
    blob[n++] = mpm_blob_of("steps of surfaces", &s->steps, sizeof s->steps);
    return n;
}

MPM_API mpm_status mpm_surfaces_make_room(mpm_surfaces *s, mpm_blob *blob)
{
    const size_t most = INT32_MAX / 2;
    mpm_status st = MPM_OK;
    int32_t a;
    for (a = 0; a < s->surfaces && st == MPM_OK; a++) {
        mpm_surface *c = &s->surface[a];
        mpm_blob *of = blob + 5 * a;
        const size_t markers = of[0].bytes / sizeof *c->marker, faces = of[1].bytes / sizeof *c->face;
        st = mpm_want(markers < most && of[0].bytes % sizeof *c->marker == 0, &s->fault, of[0].name,
                      (mpm_real)of[0].bytes, a);
        if (st == MPM_OK)
            st = mpm_want(faces < most && of[1].bytes % sizeof *c->face == 0, &s->fault, of[1].name,
                          (mpm_real)of[1].bytes, a);
        if (st == MPM_OK) st = mpm__surface_grow(c, (int32_t)markers, (int32_t)faces, &s->fault);
    }
    mpm_surfaces_blobs(s, blob);
    return st;
}

/* As many bytes were read as the sizes of the surfaces say. */
static inline mpm_status mpm__surface_restored_sizes(mpm_surfaces *s, const mpm_blob *blob)
{
    mpm_status st = mpm_want(s->steps >= 0, &s->fault, "steps of surfaces", (mpm_real)s->steps, -1);
    int32_t a;
    int k;
    for (a = 0; a < s->surfaces && st == MPM_OK; a++) {
        const mpm_surface *c = &s->surface[a];
        const size_t one[MPM__SURFACE_ARRAYS] = {sizeof *c->marker, sizeof *c->face, sizeof *c->beside};
        st = mpm_want(c->markers >= c->layer.markers && c->markers >= 2 && c->faces >= 1, &s->fault, "size of surface",
                      (mpm_real)c->markers, a);
        for (k = 0; k < MPM__SURFACE_ARRAYS && st == MPM_OK; k++)
            st = mpm_want(blob[5 * a + k].bytes == one[k] * (size_t)(k ? c->faces : c->markers), &s->fault,
                          blob[5 * a + k].name, (mpm_real)blob[5 * a + k].bytes, a);
    }
    return st;
}

/* Faces of markers that there are, beside faces that there are. */
static inline mpm_status mpm__surface_restored_faces(const mpm_surface *c, mpm_fault *f)
{
    mpm_status st = MPM_OK;
    int32_t i;
    int k;
    for (i = 0; i < c->faces && st == MPM_OK; i++)
        for (k = 0; k < c->corners && st == MPM_OK; k++) {
            const int32_t m = c->face[i][k], g = c->beside[i][k];
            st = mpm_want(m >= 0 && m < c->markers, f, "marker of face", (mpm_real)m, i);
            if (st == MPM_OK) st = mpm_want(g >= -1 && g < c->faces, f, "face beside face", (mpm_real)g, i);
        }
    return st;
}

/* A meeting with a wall or another surface that there is, at a face of it. */
static inline mpm_status mpm__surface_restored_meet(mpm_surfaces *s, int32_t a, int32_t i, const mpm_meet *meet)
{
    const int32_t other = meet->other;
    mpm_status st = mpm_want(other == MPM_SURFACE_NONE || (other >= -s->walls && other < s->surfaces && other != a),
                             &s->fault, "other of meeting", (mpm_real)other, i);
    if (st == MPM_OK && other >= 0)
        st = mpm_want(meet->face >= 0 && meet->face < s->surface[other].faces, &s->fault, "face of meeting",
                      (mpm_real)meet->face, i);
    return st;
}

/* Markers that lie somewhere, between markers that were there before them. */
static inline mpm_status mpm__surface_restored_markers(mpm_surfaces *s, int32_t a)
{
    const mpm_surface *c = &s->surface[a];
    mpm_status st = MPM_OK;
    int32_t i;
    int k;
    for (i = 0; i < c->markers && st == MPM_OK; i++) {
        const mpm_marker *m = &c->marker[i];
        for (k = 0; k < 3 && st == MPM_OK; k++) st = mpm_want(1, &s->fault, "place of a marker", m->x[k], i);
        for (k = 0; k < 2 && st == MPM_OK; k++)
            st = mpm_want(m->parent[k] < i && m->parent[k] >= (i < c->layer.markers ? -1 : 0), &s->fault,
                          "parent of marker", (mpm_real)m->parent[k], i);
        for (k = 0; k < MPM_SURFACE_MEETS && st == MPM_OK; k++) st = mpm__surface_restored_meet(s, a, i, &m->meet[k]);
    }
    return st;
}

MPM_API mpm_status mpm_surfaces_restored(mpm_surfaces *s, const mpm_world *w, const mpm_blob *blob)
{
    mpm_status st = mpm__surface_restored_sizes(s, blob);
    int32_t a;
    for (a = 0; a < s->surfaces && st == MPM_OK; a++) {
        st = mpm_want(s->surface[a].body < w->bodies, &s->fault, "body of surface", (mpm_real)s->surface[a].body, a);
        if (st == MPM_OK) st = mpm__surface_restored_faces(&s->surface[a], &s->fault);
    }
    for (a = 0; a < s->surfaces && st == MPM_OK; a++) st = mpm__surface_restored_markers(s, a);
    if (st == MPM_OK) return st;
    for (a = 0; a < s->surfaces; a++) s->surface[a].markers = s->surface[a].faces = 0;
    mpm_surfaces_free(s);
    return st;
}

#ifdef __cplusplus
}
#endif

#endif /* MPM_SURFACE_IMPLEMENTED */
