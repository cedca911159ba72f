/* mpm_measure.h - what came out of an impact: rebound, splat, interface, strength of the bond, and what the
   literature would say. Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     #define MPM_IMPLEMENTATION in ONE file, then include "mpm_measure.h" there: it brings mpm.h with it. The same
     line without the macro everywhere else. Call the measures between steps, on any world. Link with -lm.

   A COMPLETE PROGRAM (what flies off without forces is seen to move as it began, at 3 m/s)
       #define MPM_IMPLEMENTATION
       #include "mpm.h"
       #include "mpm_measure.h"
       #include <stdio.h>
       int main(void) {
           mpm_body_desc b = mpm_body_desc_default();
           mpm_desc d = mpm_desc_default();
           mpm_world w;
           int n;
           d.cell = 1; d.cells[0] = d.cells[1] = d.cells[2] = 12; d.bodies = 1; d.points = 1000;
           b.shape = mpm_sphere(6, 6, 4, 2); b.spacing = 0.5; b.density = 1; b.velocity[2] = 3;
           if (mpm_init(&w, &d, NULL, 0) < 0 || mpm_body_add(&w, &b) < 0) return 1;
           for (n = 0; n < 10; n++)
               if (mpm_step(&w, 0.05) < 0) return 1;
           printf("%.3f m/s\n", mpm_rebound_of(&w, 0, 60).mean);
           mpm_free(&w);
           return 0;
       }

   CONTENTS
     rebound and shape     mpm_rebound_of, mpm_rebound_from, mpm_pieces_of, mpm_splat_measure
     the interface         mpm_interface_of
     pulling apart         mpm_grip_apply, mpm_pull_desc_default, mpm_pull_begin, mpm_pull_tension, _apply
     literature            mpm_bonded_fraction, mpm_relative_strength, mpm_critical_velocity_*
     calibration           mpm_logistic_*

   WHAT IT DOES NOT DO: the bond itself and its PBCP (mpm_bond.h); it changes a world only through grips.

   Equation numbers "A n" are those of source A (see mpm.h). Further sources:
     Shorshorov, Kharlamov, Physical and chemical foundations of detonation-gas spraying (in Russian), Nauka,
     Moscow (1978), as source A quotes them: bonded fraction and relative strength
     Assadi, Gaertner, Stoltenhoff, Kreye, Acta Mater. 51 (2003) 4379: critical velocity
     Assadi, Schmidt, Richter, Kliemann, Binder, Gaertner, Klassen, Kreye, J. Therm. Spray Technol. 20 (2011)
     1161: critical velocity over size */
#ifndef MPM_MEASURE_H
#define MPM_MEASURE_H

#include "mpm.h"
#if MPM_VERSION_NUMBER != 200
#error "mpm_measure.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_interface_of mpm_interface_of_f32
#define mpm_rebound_of mpm_rebound_of_f32
#define mpm_rebound_from mpm_rebound_from_f32
#define mpm_pieces_of mpm_pieces_of_f32
#define mpm_splat_measure mpm_splat_measure_f32
#define mpm_grip_apply mpm_grip_apply_f32
#define mpm_pull_desc_default mpm_pull_desc_default_f32
#define mpm_pull_begin mpm_pull_begin_f32
#define mpm_pull_apply mpm_pull_apply_f32
#define mpm_pull_tension mpm_pull_tension_f32
#define mpm_bonded_fraction mpm_bonded_fraction_f32
#define mpm_relative_strength mpm_relative_strength_f32
#define mpm_critical_velocity_2003 mpm_critical_velocity_2003_f32
#define mpm_critical_velocity_2011 mpm_critical_velocity_2011_f32
#define mpm_logistic_fit mpm_logistic_fit_f32
#define mpm_logistic_z mpm_logistic_z_f32
#define mpm_logistic_theta mpm_logistic_theta_f32
#define mpm_logistic_roots mpm_logistic_roots_f32
#define mpm_logistic_cross mpm_logistic_cross_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- rebound, shape, interface ------------------------------------------------------------------ */

/* The interface between two bodies as the grid sees it: the nodes where both weigh enough for contact
   (cutoff of their contact rule), in the last step.
   The area of a node is the smaller of the bodies' surfaces there, |sum m grad N . n| / initial density:
   the deformed surface, gaps below a cell included. In a quarter model it is a quarter. */
typedef struct mpm_interface {
    long nodes;               /* such nodes */
    long bonded;              /* ... that are held by half or more: with a bond, where D is 1 or more */
    long held;                /* ... where the hold gave force in the last step */
    double area, bonded_area; /* [length^2] */
    double impulse[3];        /* momentum that a got from b in the last step [mass length/time] */
} mpm_interface;

/* Between body a and body b (-1: all others). Until the next mpm_locate. Test: 30_bond. */
MPM_API mpm_interface mpm_interface_of(const mpm_world *w, int32_t a, int32_t b);

/* The rebound of a body (source A, section 5.2). Points faster than `filter` in any direction, which source A takes for
   ejected, are left out of `filtered` and counted; `mean` is mass-weighted over all points. Along z, retired points
   included. What has left the body is another question: mpm_pieces_of. */
typedef struct mpm_rebound {
    double filtered;     /* mass-weighted mean v_z of points with |v| <= filter [length/time] */
    double mean;         /* mass-weighted mean v_z */
    double noise;        /* standard deviation of v_z of the points up to the filter */
    long fast;           /* points with |v| > filter */
    double fast_mass;
} mpm_rebound;

/* filter [length/time] >= 0; body: one of the world's. Test: 30_bond. */
MPM_API mpm_rebound mpm_rebound_of(const mpm_world *w, int32_t body, mpm_real filter);

/* The same relative to another body: velocities less the mass-weighted mean of that body, which drifts
   where its faces are damped. Test: 30_bond. */
MPM_API mpm_rebound mpm_rebound_from(const mpm_world *w, int32_t body, int32_t other, mpm_real filter);

/* The pieces that a body has fallen into: points in one cell of the grid, or in cells that touch, be it at a corner,
   are of one piece. What is not of the heaviest has left the body, however slow or fast. */
typedef struct mpm_pieces {
    int32_t pieces;      /* 0: a body without active points */
    int32_t apart;       /* points that are not of the heaviest piece, retired ones not counted */
    double mass;         /* theirs */
} mpm_pieces;

/* MPM_ERR_MEMORY: none for the search, 28 bytes a point at most. Test: 30_bond. */
MPM_API mpm_status mpm_pieces_of(const mpm_world *w, int32_t body, mpm_pieces *pieces);

/* The shape of a splat: a particle on a substrate whose upper face was flat, along z. Points faster than
   `filter` are left out. Extents are those of the points' cubes, half a spacing beyond centres. */
typedef struct mpm_splat {
    double top;           /* height above which the particle has no point [length] */
    double height, width; /* of the particle; width: twice the largest distance from its initial axis [length] */
    double flattening;    /* 1 - height / initial height */
    double spread;        /* width / initial width */
    double crater;        /* depth of the deepest point of the upper face below where it was [length] */
    double rim;           /* height of its highest point above it [length] */
} mpm_splat;

/* filter [length/time] >= 0; bodies of the world. What no point is slow enough for is 0.
   Test: 30_bond. */
MPM_API mpm_splat mpm_splat_measure(const mpm_world *w, int32_t particle, int32_t substrate, mpm_real filter);

/* ---- pulling apart ---------------------------------------------------------------------------- */

/* A grip: the nodes of one body between two heights get a prescribed velocity. The layer moves along. What
   the grip gives is in the ledger: its impulse in `impulse`, its work in `walls` (negative: brought in). */
typedef struct mpm_grip {
    int32_t body;
    mpm_real low, high;   /* heights [length] */
    mpm_real velocity[3]; /* [length/time] */
    int axes;             /* bit d: direction d is prescribed; 4: z alone, 7: all */
    long nodes;           /* how many it held in the last step */
    double impulse[3];    /* momentum it gave to the body in the last step [mass length/time] */
} mpm_grip;

/* Between mpm_contact_apply and mpm_g2p. Test: 32_pull. */
MPM_API void mpm_grip_apply(mpm_grip *g, mpm_world *w);

/* How strong is the bond? Two bodies, one upon the other, are drawn apart along z: the lower held fast
   below a height, the upper drawn up above another. Heights are moved to the middle between grid planes,
   so that they do not pass one soon. */
typedef struct mpm_pull_desc {
    unsigned mark;             /* set by mpm_pull_desc_default */
    int32_t upper, lower;      /* bodies */
    mpm_real above, below;     /* upper is gripped above, lower below; above > below [length] */
    int axes;                  /* directions the grips prescribe: 4: z alone, 7: all */
    mpm_real velocity, ramp;   /* of the upper grip, > 0, reached steadily within the time ramp >= 0 */
    mpm_real sample;           /* time over which a force is averaged, > 0: some transits of the waves */
    double area;               /* that stress is referred to [length^2], > 0 */
} mpm_pull_desc;

/* Body 0 off body 1, in all directions, without a ramp; heights, velocity, sample and area must be set.
   Test: 32_pull. */
MPM_API mpm_pull_desc mpm_pull_desc_default(void);

/* A pull under way, and what it has shown so far. */
typedef struct mpm_pull {
    mpm_pull_desc desc;
    mpm_grip grip[2];          /* of the upper and of the lower body */
    double time, separation;   /* since the start: time, way of the upper grip */
    double force, grip_force;  /* tension between the bodies, and in the upper grip: means of the last sample */
    double work;               /* of the upper grip, grip_force over the way [energy] */
    double peak_force, peak_stress, peak_separation; /* largest tension of a sample: it, over the area, where */
    int64_t samples;
    double sum[2], since;      /* impulses and time of the sample under way */
} mpm_pull;

/* MPM_ERR_ARGUMENT / NAN with the field. The world is only read. Test: 32_pull. */
MPM_API mpm_status mpm_pull_begin(mpm_pull *p, const mpm_world *w, const mpm_pull_desc *d, mpm_fault *fault);

/* As mpm_grip_apply, for both grips. Returns 1 when a sample is complete: force, grip_force and the peak
   are new; else 0. Test: 32_pull. */
MPM_API int mpm_pull_apply(mpm_pull *p, mpm_world *w);

/* A tension between the bodies [force] that this step has beside that at nodes, as on surfaces: what mpm_pull_apply
   counts then. Before it, in the same step. Test: 32_pull. */
MPM_API void mpm_pull_tension(mpm_pull *p, const mpm_world *w, double force);

/* ---- estimates from the literature ------------------------------------------------------------ */

/* The terms of Shorshorov and Kharlamov's rates, in SI units: lattice frequency [1/s] > 0, contact time [s]
   >= 0, activation energy of a bond [J] >= 0, contact temperature [K] > 0, atomic mass [kg], particle velocity
   [m/s]. */
typedef struct mpm_activation {
    double frequency, time, energy, temperature, atom_mass, velocity;
} mpm_activation;

/* Share of atoms that bond, 1 - exp(-nu t_c exp(-E_a / (k T_c + (1 - e_r) m v^2/2))) (A 2.10). recoil: e_r,
   here the share of the kinetic energy that elastic recoil gives back, the square of the velocity ratio, in
   [0, 1]. Times the energy of a full contact, area * atoms per area * bond energy, it is the adhesion energy.
   Test: 30_bond. */
MPM_API double mpm_bonded_fraction(const mpm_activation *a, double recoil);

/* Bond strength as a share of the full one, 1 - exp(-nu t_c exp(-E_a / (a_1 k T_c + a_2 m v^2/2))) (A 2.11);
   inner, kinetic: a_1 and a_2, the utilised shares of internal and kinetic energy. Test: 30_bond. */
MPM_API double mpm_relative_strength(const mpm_activation *a, double inner, double kinetic);

/* Critical velocity [m/s] of Assadi, Gaertner, Stoltenhoff, Kreye, Acta Mater. 51 (2003) 4379:
   667 - 14 rho + 0.08 T_m + 0.1 sigma_u - 0.4 T_i with density in g/cm^3, melting and initial temperature in
   deg C, tensile strength in MPa. Fitted around copper. Test: 30_bond. */
MPM_API double mpm_critical_velocity_2003(double density_g_cm3, double melt_C, double strength_MPa, double initial_C);

/* Critical velocity [m/s] of Assadi et al., J. Therm. Spray Technol. 20 (2011) 1161:
   k sqrt(c_p (T_m - T_p) + 16 (sigma_u/rho) (T_m - T_p)/(T_m - 293 K)), k = 0.64 (d/10 um)^-0.18.
   diameter [um] > 0, specific heat [J/(kg K)], melting and particle temperature [K], tensile strength at
   293 K [Pa], density [kg/m^3] > 0; T_m > 293 K. 0 for a molten particle. Test: 30_bond. */
MPM_API double mpm_critical_velocity_2011(double diameter_um, double specific_heat, double melt_K, double particle_K,
                                          double strength_Pa, double density);

/* ---- calibration ---------------------------------------------------------------------------- */

/* The boundary between two outcomes over two parameters, a second-order logistic regression (A 4.11):
       Z = t0 + t1 u1 + t2 u2 + t3 u1^2 + t4 u1 u2 + t5 u2^2,   probability of outcome 1 = 1/(1 + e^-Z)
   (A 4.10, whose print has a minus there), of the scaled parameters u = (x - center)/half in [-1, 1]. The
   boundary is Z = 0. Everything is double, in MPM_FLOAT too. Pass logarithms for a logarithmic scale. */
typedef struct mpm_logistic {
    double theta[6];            /* t0 .. t5 of the scaled parameters */
    double center[2], half[2];  /* middle and half width of the range of x1 and x2 */
    double cost;                /* J, mean negative log-likelihood (A 4.13), ridge excluded */
    int64_t wrong;              /* tests on the wrong side of the boundary */
    int iterations;             /* Newton steps taken */
} mpm_logistic;

/* Fits n tests by maximum likelihood: J + ridge/2 (t1^2 + .. + t5^2) least, by damped Newton steps. Where
   a boundary separates the outcomes without error the likelihood alone has no maximum at finite theta; a
   ridge > 0 gives it one (1e-6 hardly moves other fits).
   x1, x2: parameters, any units. outcome: 0 or 1. n >= 6. ridge >= 0. steps: most iterations, > 0 (50).
   MPM_NOT_CONVERGED: the steps did not suffice, or, with ridge 0, the outcomes are separable or the points
   lie on a conic; the fit is the last one. MPM_ERR_ARGUMENT / NAN with the field and the test: n, outcome
   (also when there is only one: index -1), a parameter that is not finite or the same in all tests.
   Test: 31_calibration. */
MPM_API mpm_status mpm_logistic_fit(mpm_logistic *fit, const double *x1, const double *x2, const int *outcome,
                                         int64_t n, double ridge, int steps, mpm_fault *fault);

/* Z at (x1, x2): positive where outcome 1 is the likelier. Test: 31_calibration. */
MPM_API double mpm_logistic_z(const mpm_logistic *fit, double x1, double x2);

/* theta of the parameters as they were passed (A 4.11), for printing. Test: 31_calibration. */
MPM_API void mpm_logistic_theta(const mpm_logistic *fit, double theta[6]);

/* The boundary at x1: the x2 in [low, high] with Z = 0, ascending. Returns how many: 0, 1 or 2.
   Test: 31_calibration. */
MPM_API int mpm_logistic_roots(const mpm_logistic *fit, double x1, double low, double high, double root[2]);

/* Where two boundaries cross inside the box low .. high of (x1, x2), low < high. Returns how many points
   it found, 0 .. 4, ordered by x1. The box is halved until neither boundary can be excluded from a part
   2^-20 of its width; Newton's method finishes. Points nearer than a 500th of the box count as one; boundaries
   that coincide give up to four points of what they share. 0 also for a box or fit that is not finite.
   Test: 31_calibration. */
MPM_API int mpm_logistic_cross(const mpm_logistic *a, const mpm_logistic *b, const double low[2],
                                    const double high[2], double point[4][2]);

#ifdef __cplusplus
}
#endif
#endif /* MPM_MEASURE_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__MEASURE_IMPLEMENTED)
#define MPM__MEASURE_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

/* ---- rebound, shape, interface ------------------------------------------------------------------ */

MPM_API mpm_interface mpm_interface_of(const mpm_world *w, int32_t a, int32_t b)
{
    mpm_interface f;
    int32_t i;
    int d;
    memset(&f, 0, sizeof f);
    for (i = 0; i < w->pairs; i++) {
        const mpm_pair *pair = &w->pair[i];
        const mpm_node *low = &w->node[pair->a], *high = &w->node[pair->b];
        const int forward = low->body == a && (b < 0 || high->body == b);
        const int backward = high->body == a && (b < 0 || low->body == b);
        double area;
        if (!forward && !backward) continue;
        for (d = 0; d < 3; d++) f.impulse[d] += (double)(forward ? pair->impulse[d] : -pair->impulse[d]);
        area = mpm_pair_area(w, pair);
        f.nodes++;
        f.held += pair->held;
        f.area += area;
        if (!(2 * pair->hold >= 1)) continue;
        f.bonded++;
        f.bonded_area += area;
    }
    return f;
}

/* The rebound seen from a frame that moves with `frame`. */
static inline mpm_rebound mpm__rebound(const mpm_world *w, int32_t body, const double *frame, mpm_real filter)
{
    const mpm_points *q = &w->points;
    const mpm_body *b = &w->body[body];
    double mass = 0, kept = 0, square = 0;
    mpm_rebound r;
    int32_t i;
    memset(&r, 0, sizeof r);
    for (i = b->first; i < b->first + b->count; i++) {
        const double m = (double)q->mass[i], vx = (double)q->v[0][i] - frame[0];
        const double vy = (double)q->v[1][i] - frame[1], vz = (double)q->v[2][i] - frame[2];
        mass += m;
        r.mean += m * vz;
        if (vx * vx + vy * vy + vz * vz > (double)filter * (double)filter) {
            r.fast++;
            r.fast_mass += m;
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

MPM_API mpm_rebound mpm_rebound_of(const mpm_world *w, int32_t body, mpm_real filter)
{
    const double rest[3] = {0, 0, 0};
    return mpm__rebound(w, body, rest, filter);
}

MPM_API mpm_rebound mpm_rebound_from(const mpm_world *w, int32_t body, int32_t other, mpm_real filter)
{
    const mpm_totals t = mpm_body_totals(w, other);
    double frame[3];
    int d;
    for (d = 0; d < 3; d++) frame[d] = t.mass > 0 ? t.momentum[d] / t.mass : 0;
    return mpm__rebound(w, body, frame, filter);
}

/* Cells of a body's points: by chance of their place in `table`, a power of two long, the first point of each cell;
   -1: none. `parent` leads from point to point of the same piece, up to one that is its own. */
typedef struct mpm__clusters {
    const mpm_world *w;
    const mpm_body *b;
    int32_t *table, *parent;
    uint32_t size;
} mpm__clusters;

static inline void mpm__cluster_cell(const mpm__clusters *q, int32_t point, int32_t *cell)
{
    int d;
    for (d = 0; d < 3; d++) { /* active points lie on the grid, unless somebody has overwritten them */
        const mpm_real at = (q->w->points.x[d][q->b->first + point] - q->w->desc.origin[d]) / q->w->desc.cell;
        cell[d] = at >= 0 && at < MPM_R(1e9) ? (int32_t)at : -2;
    }
}

/* Where a cell stands in the table, or would. */
static inline uint32_t mpm__cluster_find(const mpm__clusters *q, const int32_t *cell)
{
    uint32_t k = (uint32_t)cell[0] * 73856093u ^ (uint32_t)cell[1] * 19349663u ^ (uint32_t)cell[2] * 83492791u;
    for (k &= q->size - 1; q->table[k] >= 0; k = (k + 1) & (q->size - 1)) {
        int32_t other[3];
        mpm__cluster_cell(q, q->table[k], other);
        if (other[0] == cell[0] && other[1] == cell[1] && other[2] == cell[2]) break;
    }
    return k;
}

static inline int32_t mpm__cluster_root(const mpm__clusters *q, int32_t point)
{
    while (q->parent[point] != point) point = q->parent[point] = q->parent[q->parent[point]];
    return point;
}

/* Joins the first point of a cell with those of the cells around. */
static inline void mpm__cluster_join(const mpm__clusters *q, int32_t point)
{
    const int deep = q->w->desc.geometry == MPM_3D;
    int32_t at[3], cell[3];
    int i, j, k;
    mpm__cluster_cell(q, point, at);
    for (k = -1; k <= 1; k++)
        for (j = -deep; j <= deep; j++)
            for (i = -1; i <= 1; i++) {
                int32_t other;
                cell[0] = at[0] + i;
                cell[1] = at[1] + j;
                cell[2] = at[2] + k;
                other = q->table[mpm__cluster_find(q, cell)];
                if (other >= 0) q->parent[mpm__cluster_root(q, other)] = mpm__cluster_root(q, point);
            }
}

/* Masses of the pieces, at their roots, and what is not of the heaviest. */
static inline void mpm__cluster_weigh(const mpm__clusters *q, double *mass, mpm_pieces *r)
{
    int32_t i, heaviest = 0;
    for (i = 0; i < q->b->active; i++) mass[i] = 0;
    for (i = 0; i < q->b->active; i++)
        mass[mpm__cluster_root(q, i)] += (double)q->w->points.mass[q->b->first + i];
    for (i = 0; i < q->b->active; i++) {
        r->pieces += q->parent[i] == i;
        if (mass[i] > mass[heaviest]) heaviest = i;
    }
    for (i = 0; i < q->b->active; i++) {
        if (mpm__cluster_root(q, i) == heaviest) continue;
        r->apart++;
        r->mass += (double)q->w->points.mass[q->b->first + i];
    }
}

MPM_API mpm_status mpm_pieces_of(const mpm_world *w, int32_t body, mpm_pieces *r)
{
    mpm__clusters q;
    double *mass;
    int32_t i, n;
    uint32_t k;
    memset(r, 0, sizeof *r);
    q.w = w;
    q.b = &w->body[body];
    n = q.b->active;
    for (q.size = 16; q.size < 2 * (uint32_t)n; q.size *= 2) continue;
    mass = (double *)MPM_MALLOC((size_t)n * (sizeof *mass + sizeof *q.parent) + q.size * sizeof *q.table);
    if (!mass) return MPM_ERR_MEMORY;
    q.parent = (int32_t *)(mass + n);
    q.table = q.parent + n;
    for (k = 0; k < q.size; k++) q.table[k] = -1;
    for (i = 0; i < n; i++) {
        int32_t cell[3];
        mpm__cluster_cell(&q, i, cell);
        k = mpm__cluster_find(&q, cell);
        if (q.table[k] < 0) q.table[k] = i;
        q.parent[i] = q.table[k];
    }
    for (k = 0; k < q.size; k++)
        if (q.table[k] >= 0) mpm__cluster_join(&q, q.table[k]);
    if (n > 0) mpm__cluster_weigh(&q, mass, r);
    MPM_FREE(mass);
    return MPM_OK;
}

/* 1 if a point is slower than `filter`. */
static inline int mpm__slow(const mpm_points *q, int32_t i, mpm_real filter)
{
    return q->v[0][i] * q->v[0][i] + q->v[1][i] * q->v[1][i] + q->v[2][i] * q->v[2][i] <= filter * filter;
}

MPM_API mpm_splat mpm_splat_measure(const mpm_world *w, int32_t particle, int32_t substrate, mpm_real filter)
{
    const mpm_points *q = &w->points;
    const mpm_body *b = &w->body[particle], *s = &w->body[substrate];
    const mpm_shape *ball = &b->desc.shape, *slab = &s->desc.shape;
    const double face = (double)(slab->center[2] + slab->half[2] - s->desc.spacing / 2);
    double low = 0, high = 0, radius = 0;
    mpm_splat r;
    int32_t i;
    int first = 1;
    memset(&r, 0, sizeof r);
    for (i = b->first; i < b->first + b->active; i++) {
        const double x = (double)(q->x[0][i] - ball->center[0]), z = (double)q->x[2][i];
        const double y = w->desc.geometry != MPM_3D ? 0 : (double)(q->x[1][i] - ball->center[1]);
        if (!mpm__slow(q, i, filter)) continue;
        if (first || z < low) low = z;
        if (first || z > high) high = z;
        if (x * x + y * y > radius) radius = x * x + y * y;
        first = 0;
    }
    if (!first) {
        r.top = high + (double)b->desc.spacing / 2;
        r.height = high - low + (double)b->desc.spacing;
        r.width = 2 * sqrt(radius) + (double)b->desc.spacing;
        r.flattening = 1 - r.height / (double)(2 * ball->half[2]);
        r.spread = r.width / (double)(2 * ball->half[0]);
    }
    for (i = s->first; i < s->first + s->active; i++) {
        const double rise = (double)q->x[2][i] - face;
        if (!(q->flags[i] & MPM_FACE_TOP) || !mpm__slow(q, i, filter)) continue;
        if (-rise > r.crater) r.crater = -rise;
        if (rise > r.rim) r.rim = rise;
    }
    return r;
}

/* ---- pulling apart ---------------------------------------------------------------------------- */

/* 1 if the grip holds this node. */
static inline int mpm__gripped(const mpm_grip *g, const mpm_world *w, const mpm_node *n)
{
    mpm_real x[3];
    mpm_node_position(w, n, x);
    return n->body == g->body && n->mass > 0 && x[2] >= g->low && x[2] <= g->high;
}

MPM_API void mpm_grip_apply(mpm_grip *g, mpm_world *w)
{
    int32_t i;
    int d;
    g->nodes = 0;
    g->impulse[0] = g->impulse[1] = g->impulse[2] = 0;
    for (i = 0; i < w->nodes; i++) {
        const mpm_node *n = &w->node[i];
        mpm_real j[3];
        if (!mpm__gripped(g, w, n)) continue;
        for (d = 0; d < 3; d++) j[d] = g->axes >> d & 1 ? n->mass * g->velocity[d] - n->momentum[d] : 0;
        mpm_node_push(w, i, j);
        for (d = 0; d < 3; d++) g->impulse[d] += (double)j[d];
        g->nodes++;
    }
    g->low += g->velocity[2] * w->dt;
    g->high += g->velocity[2] * w->dt;
}

/* The middle between grid planes nearest to a height. */
static inline mpm_real mpm__between_planes(const mpm_world *w, mpm_real z)
{
    const double cell = (double)w->desc.cell, origin = (double)w->desc.origin[2];
    return (mpm_real)(origin + cell * (floor(((double)z - origin) / cell) + 0.5));
}

MPM_API mpm_pull_desc mpm_pull_desc_default(void)
{
    mpm_pull_desc d;
    memset(&d, 0, sizeof d);
    d.mark = MPM_MARK;
    d.lower = 1;
    d.axes = 7;
    return d;
}

static inline mpm_status mpm__pull_check(const mpm_pull_desc *d, const mpm_world *w, mpm_fault *f)
{
    const int known = d->upper >= 0 && d->upper < w->bodies && d->lower >= 0 && d->lower < w->bodies;
    mpm_status s = mpm_want(d->mark == MPM_MARK, f, "desc (not from mpm_pull_desc_default)", (mpm_real)d->mark, -1);
    if (s != MPM_OK) return s;
    if ((s = mpm_want(known && d->upper != d->lower, f, "pull bodies", (mpm_real)d->lower, d->upper)) != MPM_OK)
        return s;
    if ((s = mpm_want(1, f, "pull below", d->below, -1)) != MPM_OK) return s;
    if ((s = mpm_want(d->above > d->below, f, "pull above", d->above, -1)) != MPM_OK) return s;
    if ((s = mpm_want(d->axes > 0 && d->axes < 8, f, "pull axes", (mpm_real)d->axes, -1)) != MPM_OK) return s;
    if ((s = mpm_want(d->velocity > 0, f, "pull velocity", d->velocity, -1)) != MPM_OK) return s;
    if ((s = mpm_want(d->ramp >= 0, f, "pull ramp", d->ramp, -1)) != MPM_OK) return s;
    if ((s = mpm_want(d->sample > 0, f, "pull sample", d->sample, -1)) != MPM_OK) return s;
    return mpm_want(d->area > 0, f, "pull area", (mpm_real)d->area, -1);
}

MPM_API mpm_status mpm_pull_begin(mpm_pull *p, const mpm_world *w, const mpm_pull_desc *d, mpm_fault *f)
{
    const mpm_real reach = (mpm_real)w->nodes_per_axis[2] * w->desc.cell; /* more than the grid */
    const mpm_status s = mpm__pull_check(d, w, f);
    memset(p, 0, sizeof *p);
    if (s != MPM_OK) return s;
    p->desc = *d;
    p->grip[0].body = d->upper;
    p->grip[0].low = mpm__between_planes(w, d->above);
    p->grip[0].high = p->grip[0].low + 2 * reach;
    p->grip[1].body = d->lower;
    p->grip[1].high = mpm__between_planes(w, d->below);
    p->grip[1].low = p->grip[1].high - 2 * reach;
    p->grip[0].axes = p->grip[1].axes = d->axes;
    return MPM_OK;
}

MPM_API void mpm_pull_tension(mpm_pull *p, const mpm_world *w, double force) { p->sum[0] += force * (double)w->dt; }

MPM_API int mpm_pull_apply(mpm_pull *p, mpm_world *w)
{
    const double t = p->time + (double)w->dt, ramp = (double)p->desc.ramp;
    p->grip[0].velocity[2] = t < ramp ? (mpm_real)(t / ramp) * p->desc.velocity : p->desc.velocity;
    mpm_grip_apply(&p->grip[0], w);
    mpm_grip_apply(&p->grip[1], w);
    p->sum[0] -= mpm_interface_of(w, p->desc.upper, p->desc.lower).impulse[2];
    p->sum[1] += p->grip[0].impulse[2];
    p->work += p->grip[0].impulse[2] * (double)p->grip[0].velocity[2];
    p->separation += (double)(p->grip[0].velocity[2] * w->dt);
    p->time = t;
    p->since += (double)w->dt;
    if (p->since < (double)p->desc.sample * (1 - 1e-9)) return 0;
    p->force = p->sum[0] / p->since;
    p->grip_force = p->sum[1] / p->since;
    p->sum[0] = p->sum[1] = p->since = 0;
    p->samples++;
    if (p->force > p->peak_force) {
        p->peak_force = p->force;
        p->peak_stress = p->force / p->desc.area;
        p->peak_separation = p->separation;
    }
    return 1;
}

/* ---- estimates from the literature ------------------------------------------------------------ */

/* 1 - exp(-nu t exp(-E/(inner k T + kinetic m v^2/2))); expm1 keeps the digits of small shares. */
static inline double mpm__activated(const mpm_activation *a, double inner, double kinetic)
{
    const double heat = 1.380649e-23 * a->temperature; /* k in J/K, exact in SI */
    const double motion = a->atom_mass * a->velocity * a->velocity / 2;
    return -expm1(-a->frequency * a->time * exp(-a->energy / (inner * heat + kinetic * motion)));
}

MPM_API double mpm_bonded_fraction(const mpm_activation *a, double recoil) { return mpm__activated(a, 1, 1 - recoil); }

MPM_API double mpm_relative_strength(const mpm_activation *a, double inner, double kinetic)
{
    return mpm__activated(a, inner, kinetic);
}

MPM_API double mpm_critical_velocity_2003(double density_g_cm3, double melt_C, double strength_MPa, double initial_C)
{
    return 667 - 14 * density_g_cm3 + 0.08 * melt_C + 0.1 * strength_MPa - 0.4 * initial_C;
}

MPM_API double mpm_critical_velocity_2011(double diameter_um, double specific_heat, double melt_K, double particle_K,
                                          double strength_Pa, double density)
{
    const double below = melt_K - particle_K; /* the melting point */
    if (!(below > 0)) return 0;
    return 0.64 * pow(diameter_um / 10, -0.18) *
           sqrt(specific_heat * below + 16 * (strength_Pa / density) * below / (melt_K - 293));
}

/* ---- calibration ---------------------------------------------------------------------------- */

enum { MPM__TERMS = 6 };

/* The terms of A 4.11 at the scaled point (u1, u2). */
static inline void mpm__terms(double u1, double u2, double *X)
{
    X[0] = 1;
    X[1] = u1;
    X[2] = u2;
    X[3] = u1 * u1;
    X[4] = u1 * u2;
    X[5] = u2 * u2;
}

static inline double mpm__poly(const double *theta, double u1, double u2)
{
    return theta[0] + u1 * (theta[1] + theta[3] * u1 + theta[4] * u2) + u2 * (theta[2] + theta[5] * u2);
}

static inline double mpm__scaled(const mpm_logistic *f, int axis, double x)
{
    return (x - f->center[axis]) / f->half[axis];
}

/* Solves H d = g for a symmetric positive definite H by Cholesky; H is overwritten. 0 if it is not. */
static inline int mpm__cholesky(double H[MPM__TERMS][MPM__TERMS], const double *g, double *d)
{
    int i, j, k;
    for (j = 0; j < MPM__TERMS; j++) {
        const double whole = H[j][j];
        for (k = 0; k < j; k++) H[j][j] -= H[j][k] * H[j][k];
        if (!(H[j][j] > 1e-14 * whole) || !(whole > 0)) return 0;
        H[j][j] = sqrt(H[j][j]);
        for (i = j + 1; i < MPM__TERMS; i++) {
            for (k = 0; k < j; k++) H[i][j] -= H[i][k] * H[j][k];
            H[i][j] /= H[j][j];
        }
    }
    for (i = 0; i < MPM__TERMS; i++) {
        d[i] = g[i];
        for (k = 0; k < i; k++) d[i] -= H[i][k] * d[k];
        d[i] /= H[i][i];
    }
    for (i = MPM__TERMS - 1; i >= 0; i--) {
        for (k = i + 1; k < MPM__TERMS; k++) d[i] -= H[k][i] * d[k];
        d[i] /= H[i][i];
    }
    return 1;
}

/* J (A 4.13), and with gradient g (A 4.14) and Hessian H where asked. Sets fit->cost and fit->wrong. */
static inline double mpm__logistic_cost(mpm_logistic *f, const double *x1, const double *x2, const int *outcome,
                                        int64_t n, double ridge, double *g, double (*H)[MPM__TERMS])
{
    double X[MPM__TERMS], penalty = 0;
    int64_t t;
    int i, j;
    f->cost = 0;
    f->wrong = 0;
    for (i = 0; g && i < MPM__TERMS; i++) {
        g[i] = i ? ridge * f->theta[i] : 0;
        for (j = 0; j <= i; j++) H[i][j] = i && i == j ? ridge : 0;
    }
    for (t = 0; t < n; t++) {
        double z, toward, tiny, h;
        mpm__terms(mpm__scaled(f, 0, x1[t]), mpm__scaled(f, 1, x2[t]), X);
        z = mpm__poly(f->theta, X[1], X[2]);
        toward = outcome[t] ? z : -z;
        tiny = exp(-fabs(z)); /* of h = 1/(1 + e^-z), whichever way it does not overflow */
        h = (z > 0 ? 1 : tiny) / (1 + tiny);
        f->cost += ((toward > 0 ? 0 : -toward) + log(1 + tiny)) / (double)n;
        f->wrong += !(toward > 0);
        for (i = 0; g && i < MPM__TERMS; i++) {
            g[i] += X[i] * (h - outcome[t]) / (double)n;
            for (j = 0; j <= i; j++) H[i][j] += X[i] * X[j] * h * (1 - h) / (double)n;
        }
    }
    for (i = 1; i < MPM__TERMS; i++) penalty += ridge / 2 * f->theta[i] * f->theta[i];
    return f->cost + penalty;
}

/* The range of a parameter. */
static inline mpm_status mpm__logistic_scale(mpm_logistic *f, int axis, const double *x, int64_t n, const char *field,
                                             mpm_fault *fault)
{
    double low = x[0], high = x[0];
    int64_t t;
    for (t = 0; t < n; t++) {
        if (!(x[t] - x[t] >= 0)) return mpm_fail(fault, MPM_ERR_NAN, field, (mpm_real)x[t], t); /* inf too */
        if (x[t] < low) low = x[t];
        if (x[t] > high) high = x[t];
    }
    f->center[axis] = low + (high - low) / 2;
    f->half[axis] = (high - low) / 2;
    if (!(f->half[axis] > 0)) return mpm_fail(fault, MPM_ERR_ARGUMENT, field, (mpm_real)low, -1);
    return MPM_OK;
}

static inline mpm_status mpm__logistic_check(const int *outcome, int64_t n, double ridge, int steps, mpm_fault *fault)
{
    int64_t t, ones = 0;
    mpm_status s = mpm_want(n >= MPM__TERMS, fault, "logistic n", (mpm_real)n, -1);
    if (s == MPM_OK) s = mpm_want(ridge >= 0, fault, "logistic ridge", (mpm_real)ridge, -1);
    if (s == MPM_OK) s = mpm_want(steps > 0, fault, "logistic steps", (mpm_real)steps, -1);
    if (s != MPM_OK) return s;
    for (t = 0; t < n; t++) {
        if (outcome[t] != 0 && outcome[t] != 1)
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "logistic outcome", (mpm_real)outcome[t], t);
        ones += outcome[t];
    }
    return mpm_want(ones > 0 && ones < n, fault, "logistic outcome", (mpm_real)outcome[0], -1);
}

MPM_API mpm_status mpm_logistic_fit(mpm_logistic *fit, const double *x1, const double *x2, const int *outcome,
                                         int64_t n, double ridge, int steps, mpm_fault *fault)
{
    double g[MPM__TERMS], d[MPM__TERMS], H[MPM__TERMS][MPM__TERMS], from[MPM__TERMS], now, gain, share;
    mpm_status s = mpm__logistic_check(outcome, n, ridge, steps, fault);
    int i;
    memset(fit, 0, sizeof *fit);
    if (s == MPM_OK) s = mpm__logistic_scale(fit, 0, x1, n, "logistic x1", fault);
    if (s == MPM_OK) s = mpm__logistic_scale(fit, 1, x2, n, "logistic x2", fault);
    if (s != MPM_OK) return s;
    while (fit->iterations < steps) {
        now = mpm__logistic_cost(fit, x1, x2, outcome, n, ridge, g, H);
        if (!mpm__cholesky(H, g, d)) return MPM_NOT_CONVERGED;
        fit->iterations++;
        for (gain = 0, i = 0; i < MPM__TERMS; i++) {
            gain += g[i] * d[i];
            from[i] = fit->theta[i];
        }
        for (share = 1; share > 1e-12; share /= 2) { /* the cost must fall, unless nothing is left to gain */
            for (i = 0; i < MPM__TERMS; i++) fit->theta[i] = from[i] - share * d[i];
            if (mpm__logistic_cost(fit, x1, x2, outcome, n, ridge, NULL, NULL) <= now - 1e-4 * share * gain ||
                gain <= 1e-12 * now)
                break;
        }
        if (gain <= 1e-12 * now) return MPM_OK;
    }
    return MPM_NOT_CONVERGED;
}

MPM_API double mpm_logistic_z(const mpm_logistic *f, double x1, double x2)
{
    return mpm__poly(f->theta, mpm__scaled(f, 0, x1), mpm__scaled(f, 1, x2));
}

/* theta of new parameters w, where x = middle + width * w. */
static inline void mpm__rescaled(const mpm_logistic *f, const double *middle, const double *width, double *theta)
{
    const double *t = f->theta;
    const double c1 = mpm__scaled(f, 0, middle[0]), c2 = mpm__scaled(f, 1, middle[1]);
    const double k1 = width[0] / f->half[0], k2 = width[1] / f->half[1];
    theta[0] = mpm__poly(t, c1, c2);
    theta[1] = k1 * (t[1] + 2 * t[3] * c1 + t[4] * c2);
    theta[2] = k2 * (t[2] + t[4] * c1 + 2 * t[5] * c2);
    theta[3] = k1 * k1 * t[3];
    theta[4] = k1 * k2 * t[4];
    theta[5] = k2 * k2 * t[5];
}

MPM_API void mpm_logistic_theta(const mpm_logistic *f, double theta[6])
{
    const double zero[2] = {0, 0}, one[2] = {1, 1};
    mpm__rescaled(f, zero, one, theta);
}

MPM_API int mpm_logistic_roots(const mpm_logistic *f, double x1, double low, double high, double root[2])
{
    const double *t = f->theta, u = mpm__scaled(f, 0, x1);
    const double a = t[5], b = t[2] + t[4] * u, c = t[0] + u * (t[1] + t[3] * u);
    const double square = b * b - 4 * a * c;
    double q, x;
    int n = 0;
    if (!(square >= 0)) return 0;
    q = -(b + (b < 0 ? -sqrt(square) : sqrt(square))) / 2; /* without cancellation */
    if (fabs(a) > 0) {
        x = f->center[1] + f->half[1] * (q / a);
        if (x >= low && x <= high) root[n++] = x;
    }
    if (fabs(q) > 0) {
        x = f->center[1] + f->half[1] * (c / q);
        if (x >= low && x <= high && !(n && square <= 0)) root[n++] = x;
    }
    if (n == 2 && root[1] < root[0]) {
        x = root[0];
        root[0] = root[1];
        root[1] = x;
    }
    return n;
}

/* Can the polynomial vanish within r of (u, v) in both directions? No by its Taylor terms, exactly. */
static inline int mpm__may_vanish(const double *t, double u, double v, double r)
{
    const double du = t[1] + 2 * t[3] * u + t[4] * v, dv = t[2] + t[4] * u + 2 * t[5] * v;
    return fabs(mpm__poly(t, u, v)) <= r * (fabs(du) + fabs(dv) + r * (fabs(t[3]) + fabs(t[4]) + fabs(t[5])));
}

/* Newton's method for both polynomials vanishing; stays put where it leads away by more than `reach`, or no nearer. */
static inline void mpm__polish(const double *a, const double *b, double reach, double *u, double *v)
{
    double x = *u, y = *v;
    int i;
    for (i = 0; i < 4; i++) {
        const double ax = a[1] + 2 * a[3] * x + a[4] * y, ay = a[2] + a[4] * x + 2 * a[5] * y;
        const double bx = b[1] + 2 * b[3] * x + b[4] * y, by = b[2] + b[4] * x + 2 * b[5] * y;
        const double fa = mpm__poly(a, x, y), fb = mpm__poly(b, x, y), det = ax * by - ay * bx;
        x -= (fa * by - fb * ay) / det;
        y -= (fb * ax - fa * bx) / det;
    }
    if (!(fabs(x - *u) <= reach && fabs(y - *v) <= reach)) return;
    if (fabs(mpm__poly(a, x, y)) > fabs(mpm__poly(a, *u, *v)) || fabs(mpm__poly(b, x, y)) > fabs(mpm__poly(b, *u, *v)))
        return;
    *u = x;
    *v = y;
}

/* Crossings in the square of half width r about (u, v); n were found before. Returns how many now. */
static inline int mpm__crossings(const double *a, const double *b, double u, double v, double r,
                                 double (*point)[2], int n)
{
    const double closest = 0.004; /* boundaries at a small angle meet in a strip, not in a part */
    int i;
    if (n == 4 || !mpm__may_vanish(a, u, v, r) || !mpm__may_vanish(b, u, v, r)) return n;
    if (r > 1e-6) {
        for (i = 0; i < 4; i++)
            n = mpm__crossings(a, b, u + (i & 2 ? r : -r) / 2, v + (i & 1 ? r : -r) / 2, r / 2, point, n);
        return n;
    }
    mpm__polish(a, b, closest, &u, &v);
    for (i = 0; i < n; i++)
        if (fabs(point[i][0] - u) <= closest && fabs(point[i][1] - v) <= closest) return n;
    point[n][0] = u;
    point[n][1] = v;
    return n + 1;
}

MPM_API int mpm_logistic_cross(const mpm_logistic *a, const mpm_logistic *b, const double low[2],
                                    const double high[2], double point[4][2])
{
    double middle[2], width[2], ta[MPM__TERMS], tb[MPM__TERMS];
    int n, i, j;
    for (i = 0; i < 2; i++) {
        middle[i] = low[i] + (high[i] - low[i]) / 2;
        width[i] = (high[i] - low[i]) / 2;
    }
    mpm__rescaled(a, middle, width, ta);
    mpm__rescaled(b, middle, width, tb);
    n = mpm__crossings(ta, tb, 0, 0, 1, point, 0);
    for (i = 0; i < n; i++)
        for (j = 0; j < 2; j++) point[i][j] = middle[j] + width[j] * point[i][j];
    for (i = 1; i < n; i++)
        for (j = i; j > 0 && point[j][0] < point[j - 1][0]; j--) {
            const double x = point[j][0], y = point[j][1];
            point[j][0] = point[j - 1][0];
            point[j][1] = point[j - 1][1];
            point[j - 1][0] = x;
            point[j - 1][1] = y;
        }
    return n;
}

#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */
