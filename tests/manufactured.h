/* manufactured.h - motions that are exact because the body force is made to fit, for large deformation:
   Kamojjala, Brannon, Sadeghirad, Guilkey, Verification tests in solid mechanics, Eng. with Computers 31
   (2015) 193; the first also in Wallstedt, Guilkey, J. Comput. Phys. 227 (2008) 9628. The solid is their
   neo-Hookean one, sigma = lambda ln J/J I + mu/J (F F^T - I). SPDX-License-Identifier: MIT */
#ifndef MANUFACTURED_H
#define MANUFACTURED_H

#include "mpm.h"

#include <math.h>
#include <stdlib.h>

#define MANUFACTURED_PI 3.14159265358979323846

typedef enum manufactured_motion {
    MANUFACTURED_AXES,  /* unit square or cube: u_i = A sin(2 pi X_i) sin(c pi t + phase_i), slides on its sides */
    MANUFACTURED_VORTEX /* ring 0.75 < R < 1.25: turns by A sin(pi t) (1 - 16 (R - 1)^2)^2; both edges free */
} manufactured_motion;

/* One run: what moves, on which grid. */
typedef struct manufactured {
    manufactured_motion motion;
    mpm_geometry geometry;     /* MPM_PLANE_STRAIN, or for the axes MPM_3D */
    mpm_basis basis;
    double amplitude;          /* A: length, or angle */
    int cells;                 /* per unit length */
    int per_cell;              /* points per cell and direction */
    double factor;             /* share of the critical step */
    double time;               /* end */
    double young, poisson, density;
    double lambda, mu;         /* of these, for the stress */
} manufactured;

/* The numbers of the publications. */
static inline manufactured manufactured_default(manufactured_motion motion)
{
    manufactured m;
    m.motion = motion;
    m.geometry = MPM_PLANE_STRAIN;
    m.basis = MPM_GIMP;
    m.amplitude = motion == MANUFACTURED_AXES ? 0.05 : 1;
    m.cells = 16;
    m.per_cell = 2;
    m.factor = 0.1;
    m.time = motion == MANUFACTURED_AXES ? 0.02 : 1;
    m.young = motion == MANUFACTURED_AXES ? 1e7 : 1e3;
    m.poisson = 0.3;
    m.density = 1e3;
    m.lambda = m.young * m.poisson / ((1 + m.poisson) * (1 - 2 * m.poisson));
    m.mu = m.young / (2 * (1 + m.poisson));
    return m;
}

/* The stress, an mpm_stress_fn. The user fields carry F F^T - I, which F <- (I + grad v dt) F brings along. */
static inline mpm_status manufactured_stress(const void *material, const mpm_block *b)
{
    const manufactured *m = (const manufactured *)material;
    static const int at[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    int p, i, j, k;
    for (p = 0; p < b->count; p++) {
        const double wx = (double)b->spin[0][p], wy = (double)b->spin[1][p], wz = (double)b->spin[2][p];
        const double w[3][3] = {{0, -wz, wy}, {wz, 0, -wx}, {-wy, wx, 0}};
        double G[3][3], B[3][3], H[3][3], J;
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++) {
                G[i][j] = (i == j) + (double)b->strain[at[i][j]][p] + w[i][j];
                B[i][j] = (i == j) + (double)b->user[at[i][j]][p];
            }
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++)
                for (H[i][j] = 0, k = 0; k < 3; k++) H[i][j] += G[i][k] * B[k][j];
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++)
                for (B[i][j] = 0, k = 0; k < 3; k++) B[i][j] += H[i][k] * G[j][k];
        J = sqrt(B[0][0] * (B[1][1] * B[2][2] - B[1][2] * B[2][1]) + B[0][1] * (B[1][2] * B[2][0] - B[1][0] * B[2][2]) +
                 B[0][2] * (B[1][0] * B[2][1] - B[1][1] * B[2][0]));
        for (i = 0; i < 3; i++)
            for (j = i; j < 3; j++) {
                const double c = B[i][j] - (i == j);
                b->user[at[i][j]][p] = (mpm_real)c;
                b->stress[at[i][j]][p] = (mpm_real)(((i == j) * m->lambda * log(J) + m->mu * c) / J);
            }
        b->energy[p] = (mpm_real)((m->mu / 2 * (B[0][0] + B[1][1] + B[2][2] - 3 - 2 * log(J)) +
                                   m->lambda / 2 * log(J) * log(J)) / m->density);
    }
    return MPM_OK;
}

/* Displacement u, velocity v and body force f per mass at the place X of the undeformed body. */
static inline void manufactured_axes(const manufactured *m, const double *X, double t, double *u, double *v, double *f)
{
    const double c = sqrt(m->young / m->density) * MANUFACTURED_PI, phase[3] = {0, 0, MANUFACTURED_PI};
    double F[3] = {1, 1, 1}, log_J = 0;
    int d;
    for (d = 0; d < 3; d++) {
        const double k = 2 * MANUFACTURED_PI, A = d == 1 && m->geometry != MPM_3D ? 0 : m->amplitude;
        u[d] = A * sin(k * X[d]) * sin(c * t + phase[d]);
        v[d] = A * sin(k * X[d]) * cos(c * t + phase[d]) * c;
        F[d] = 1 + A * k * cos(k * X[d]) * sin(c * t + phase[d]);
        log_J += log(F[d]);
        f[d] = -c * c * u[d];
    }
    /* rho0 f = rho0 u'' - div P,  P_dd = lambda ln J/F + mu (F - 1/F),  dF/dX = -4 pi^2 u */
    for (d = 0; d < 3; d++)
        f[d] += 4 * MANUFACTURED_PI * MANUFACTURED_PI * u[d] / m->density *
                (m->lambda * (1 - log_J) / (F[d] * F[d]) + m->mu * (1 + 1 / (F[d] * F[d])));
}

static inline void manufactured_vortex(const manufactured *m, const double *X, double t, double *u, double *v,
                                       double *f)
{
    const double R = sqrt(X[0] * X[0] + X[2] * X[2]), s = R - 1, hat = 1 - 16 * s * s;
    const double g = m->amplitude * sin(MANUFACTURED_PI * t);
    const double g1 = m->amplitude * MANUFACTURED_PI * cos(MANUFACTURED_PI * t);
    const double h = hat * hat, h1 = -64 * s * hat, h2 = -64 * hat + 2048 * s * s;
    const double turn = g * h, rate = g1 * h;
    const double ex = (cos(turn) * X[0] - sin(turn) * X[2]) / R, ez = (sin(turn) * X[0] + cos(turn) * X[2]) / R;
    /* J = 1; in polar components sigma_rt = mu R turn', sigma_tt = mu (R turn')^2, the others 0 */
    const double outward = -R * rate * rate + m->mu / m->density * R * g * h1 * g * h1;
    const double along = -MANUFACTURED_PI * MANUFACTURED_PI * R * turn - m->mu / m->density * g * (3 * h1 + R * h2);
    u[0] = R * ex - X[0];
    u[2] = R * ez - X[2];
    v[0] = -R * rate * ez;
    v[2] = R * rate * ex;
    f[0] = outward * ex - along * ez;
    f[2] = outward * ez + along * ex;
    u[1] = v[1] = f[1] = 0;
}

static inline void manufactured_at(const manufactured *m, const double *X, double t, double *u, double *v, double *f)
{
    if (m->motion == MANUFACTURED_AXES) manufactured_axes(m, X, t, u, v, f);
    else manufactured_vortex(m, X, t, u, v, f);
}

/* The world of a run. The hole of the ring: its points are put outside, where they are retired. */
static inline mpm_status manufactured_begin(manufactured *m, mpm_world *w)
{
    const int axes = m->motion == MANUFACTURED_AXES, margin = 2;
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_status s;
    int32_t i;
    int a;
    d.geometry = m->geometry;
    d.basis = m->basis;
    d.cell = (mpm_real)(1.0 / m->cells);
    d.user_fields = 6;
    for (a = 0; a < 3; a++) d.cells[a] = axes ? m->cells : 2 * (5 * m->cells / 4 + margin);
    for (a = 0; a < 3; a++) d.origin[a] = axes ? 0 : (mpm_real)(-0.5 * d.cells[a] / m->cells);
    for (a = 0; a < 6 && axes; a++) d.side[a] = MPM_SIDE_SYMMETRY;
    b.shape = axes ? mpm_box(0, 0, 0, 1, 1, 1) : mpm_sphere(0, 0, 0, MPM_R(1.25));
    b.spacing = d.cell / (mpm_real)m->per_cell;
    b.density = (mpm_real)m->density;
    b.wave_p = mpm_wave_speed_p((mpm_real)m->young, (mpm_real)m->poisson, b.density);
    b.stress = manufactured_stress;
    b.material = m;
    d.points = mpm_shape_count(&d, &b.shape, b.spacing);
    d.bodies = 1;
    if ((s = mpm_init(w, &d, NULL, 0)) < 0 || (s = mpm_body_add(w, &b)) < 0) return s;
    for (i = 0; i < w->points.count && !axes; i++)
        if (hypot((double)w->points.x[0][i], (double)w->points.x[2][i]) < 0.75) w->points.x[0][i] = -10;
    return MPM_OK;
}

/* The body force to the nodes, sum m f N (A 3.26). X: first places of the points, by id. */
static inline void manufactured_force(const manufactured *m, mpm_world *w, const double *X)
{
    double u[3], v[3], f[3];
    mpm_support s;
    mpm_real push[3];
    int32_t k, i;
    int d;
    for (k = 0; k < w->runs; k++)
        for (i = w->run[k].first; i < w->run[k].first + w->run[k].count; i++) {
            manufactured_at(m, X + 3 * w->points.id[i], (double)w->time, u, v, f);
            for (d = 0; d < 3; d++) push[d] = w->points.mass[i] * (mpm_real)f[d];
            mpm_support_of(w, &w->run[k], i, &s);
            mpm_push(w, &s, push);
        }
}

static inline mpm_status manufactured_step(const manufactured *m, mpm_world *w, const double *X, mpm_real dt)
{
    mpm_status s = mpm_locate(w, dt);
    if (s < 0) return s;
    mpm_p2g(w);
    mpm_forces(w);
    manufactured_force(m, w, X);
    mpm_grid_update(w);
    mpm_g2p(w);
    mpm_musl(w);
    if (mpm_stress(w) < 0) return w->fault.status;
    mpm_move(w);
    return s;
}

/* Root mean square of the points' displacement less the exact one. */
static inline double manufactured_distance(const manufactured *m, const mpm_world *w, const double *X)
{
    double u[3], v[3], f[3], sum = 0, mass = 0;
    int32_t i;
    int d;
    for (i = 0; i < w->body[0].active; i++) {
        const double *at = X + 3 * w->points.id[i];
        manufactured_at(m, at, m->time, u, v, f);
        for (d = 0; d < 3; d++)
            sum += (double)w->points.mass[i] * pow((double)w->points.x[d][i] - at[d] - u[d], 2);
        mass += (double)w->points.mass[i];
    }
    return sqrt(sum / mass);
}

/* Runs it. Returns the error at the end per amplitude; negative where a step failed or points were lost.
   Velocities stand between the positions in time (leapfrog), so that the error of the step is of second
   order too. */
static inline double manufactured_error(manufactured *m)
{
    double *X = NULL, u[3], v[3], f[3], error = -1;
    mpm_real dt;
    mpm_world w;
    int32_t i, whole = 0;
    long n = 0, steps = 0;
    int d;
    if (manufactured_begin(m, &w) == MPM_OK) X = (double *)malloc((size_t)w.points.count * 3 * sizeof *X);
    if (X) {
        steps = (long)ceil(m->time / (double)mpm_time_step(&w, (mpm_real)m->factor));
        dt = (mpm_real)(m->time / (double)steps);
        for (i = 0; i < w.points.count; i++) {
            double *at = X + 3 * w.points.id[i];
            for (d = 0; d < 3; d++) at[d] = (double)w.points.x[d][i];
            manufactured_at(m, at, -(double)dt / 2, u, v, f);
            for (d = 0; d < 3; d++) w.points.v[d][i] = (mpm_real)v[d];
        }
        for (n = 0; n < steps; n++) {
            if (manufactured_step(m, &w, X, dt) < 0) break;
            if (n == 0) whole = w.body[0].active;
        }
        if (n == steps && w.body[0].active == whole) error = manufactured_distance(m, &w, X) / m->amplitude;
    }
    free(X);
    mpm_free(&w);
    return error;
}

#endif
