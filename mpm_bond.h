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
#define mpm_bond_logistic_fit mpm_bond_logistic_fit_f32
#define mpm_bond_logistic_z mpm_bond_logistic_z_f32
#define mpm_bond_logistic_theta mpm_bond_logistic_theta_f32
#define mpm_bond_logistic_roots mpm_bond_logistic_roots_f32
#define mpm_bond_logistic_cross mpm_bond_logistic_cross_f32
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

/* ---- calibration ---------------------------------------------------------------------------- */

/* The boundary between two outcomes over two parameters, a second-order logistic regression (A 4.11):
       Z = t0 + t1 u1 + t2 u2 + t3 u1^2 + t4 u1 u2 + t5 u2^2,   probability of outcome 1 = 1/(1 + e^-Z)
   (A 4.10, whose print has a minus there), of the scaled parameters u = (x - center)/half in [-1, 1]. The
   boundary is Z = 0. Everything is double, in MPM_FLOAT too. Pass logarithms for a logarithmic scale. */
typedef struct mpm_logistic {
    double theta[6];            /* t0 .. t5 of the scaled parameters */
    double center[2], half[2];  /* middle and half width of the range of x1 and x2 */
    double cost;                /* J, mean negative log-likelihood (A 4.13), ridge excluded */
    long wrong;                 /* tests on the wrong side of the boundary */
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
MPM_API mpm_status mpm_bond_logistic_fit(mpm_logistic *fit, const double *x1, const double *x2, const int *outcome,
                                         long n, double ridge, int steps, mpm_fault *fault);

/* Z at (x1, x2): positive where outcome 1 is the likelier. */
MPM_API double mpm_bond_logistic_z(const mpm_logistic *fit, double x1, double x2);

/* theta of the parameters as they were passed (A 4.11), for printing. */
MPM_API void mpm_bond_logistic_theta(const mpm_logistic *fit, double theta[6]);

/* The boundary at x1: the x2 in [low, high] with Z = 0, ascending. Returns how many: 0, 1 or 2. */
MPM_API int mpm_bond_logistic_roots(const mpm_logistic *fit, double x1, double low, double high, double root[2]);

/* Where two boundaries cross inside the box low .. high of (x1, x2), low < high. Returns how many points
   it found, 0 .. 4, ordered by x1. The box is halved until neither boundary can be excluded from a part
   2^-20 of its width; Newton's method finishes. Boundaries that touch or coincide give up to four points
   of what they share. 0 also for a box or fit that is not finite. */
MPM_API int mpm_bond_logistic_cross(const mpm_logistic *a, const mpm_logistic *b, const double low[2],
                                    const double high[2], double point[4][2]);

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
static inline double mpm__logistic_cost(mpm_logistic *f, const double *x1, const double *x2, const int *outcome, long n,
                                        double ridge, double *g, double (*H)[MPM__TERMS])
{
    double X[MPM__TERMS], penalty = 0;
    long t;
    int i, j;
    f->cost = 0;
    f->wrong = 0;
    for (i = 0; g && i < MPM__TERMS; i++) {
        g[i] = i ? ridge * f->theta[i] : 0;
        for (j = 0; j <= i; j++) H[i][j] = i && i == j ? ridge : 0;
    }
    for (t = 0; t < n; t++) {
        double z, toward, small, h;
        mpm__terms(mpm__scaled(f, 0, x1[t]), mpm__scaled(f, 1, x2[t]), X);
        z = mpm__poly(f->theta, X[1], X[2]);
        toward = outcome[t] ? z : -z;
        small = exp(-fabs(z)); /* of h = 1/(1 + e^-z), whichever way it does not overflow */
        h = (z > 0 ? 1 : small) / (1 + small);
        f->cost += ((toward > 0 ? 0 : -toward) + log(1 + small)) / (double)n;
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
static inline mpm_status mpm__logistic_scale(mpm_logistic *f, int axis, const double *x, long n, const char *field,
                                             mpm_fault *fault)
{
    double low = x[0], high = x[0];
    long t;
    for (t = 0; t < n; t++) {
        if (!(x[t] - x[t] >= 0)) return mpm__fail(fault, MPM_ERR_NAN, field, (mpm_real)x[t], t); /* inf too */
        if (x[t] < low) low = x[t];
        if (x[t] > high) high = x[t];
    }
    f->center[axis] = low + (high - low) / 2;
    f->half[axis] = (high - low) / 2;
    if (!(f->half[axis] > 0)) return mpm__fail(fault, MPM_ERR_ARGUMENT, field, (mpm_real)low, -1);
    return MPM_OK;
}

static inline mpm_status mpm__logistic_check(const int *outcome, long n, double ridge, int steps, mpm_fault *fault)
{
    long t, ones = 0;
    mpm_status s = mpm__want(n >= MPM__TERMS, fault, "logistic n", (mpm_real)n, -1);
    if (s == MPM_OK) s = mpm__want(ridge >= 0, fault, "logistic ridge", (mpm_real)ridge, -1);
    if (s == MPM_OK) s = mpm__want(steps > 0, fault, "logistic steps", (mpm_real)steps, -1);
    if (s != MPM_OK) return s;
    for (t = 0; t < n; t++) {
        if (outcome[t] != 0 && outcome[t] != 1)
            return mpm__fail(fault, MPM_ERR_ARGUMENT, "logistic outcome", (mpm_real)outcome[t], t);
        ones += outcome[t];
    }
    return mpm__want(ones > 0 && ones < n, fault, "logistic outcome", (mpm_real)outcome[0], -1);
}

MPM_API mpm_status mpm_bond_logistic_fit(mpm_logistic *fit, const double *x1, const double *x2, const int *outcome,
                                         long n, double ridge, int steps, mpm_fault *fault)
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
                gain <= 1e-14 * now)
                break;
        }
        if (gain <= 1e-14 * now) return MPM_OK;
    }
    return MPM_NOT_CONVERGED;
}

MPM_API double mpm_bond_logistic_z(const mpm_logistic *f, double x1, double x2)
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

MPM_API void mpm_bond_logistic_theta(const mpm_logistic *f, double theta[6])
{
    const double zero[2] = {0, 0}, one[2] = {1, 1};
    mpm__rescaled(f, zero, one, theta);
}

MPM_API int mpm_bond_logistic_roots(const mpm_logistic *f, double x1, double low, double high, double root[2])
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

/* Newton's method for both polynomials vanishing; stays put where it leads away by more than `reach`. */
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
    *u = x;
    *v = y;
}

/* Crossings in the square of half width r about (u, v); n were found before. Returns how many now. */
static inline int mpm__crossings(const double *a, const double *b, double u, double v, double r,
                                 double (*point)[2], int n)
{
    int i;
    if (n == 4 || !mpm__may_vanish(a, u, v, r) || !mpm__may_vanish(b, u, v, r)) return n;
    if (r > 1e-6) {
        for (i = 0; i < 4; i++)
            n = mpm__crossings(a, b, u + (i & 2 ? r : -r) / 2, v + (i & 1 ? r : -r) / 2, r / 2, point, n);
        return n;
    }
    mpm__polish(a, b, 4 * r, &u, &v);
    for (i = 0; i < n; i++)
        if (fabs(point[i][0] - u) <= 16 * r && fabs(point[i][1] - v) <= 16 * r) return n;
    point[n][0] = u;
    point[n][1] = v;
    return n + 1;
}

MPM_API int mpm_bond_logistic_cross(const mpm_logistic *a, const mpm_logistic *b, const double low[2],
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
