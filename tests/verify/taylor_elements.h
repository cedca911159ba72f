/* taylor_elements.h - the copper Taylor bar with finite elements that move with the material: a second answer
   that shares nothing with the library. Axisymmetric four-node elements with one integration point, lumped
   mass, central differences, Jaumann rate, radial return, bulk viscosity, viscous hourglass control.
   SPDX-License-Identifier: MIT */
#ifndef TAYLOR_ELEMENTS_H
#define TAYLOR_ELEMENTS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct elements_result {
    double length, radius, lift; /* mm; lift: height of the rim over the wall */
} elements_result;

/* The benchmark's numbers, in mm, ms, g, MPa. */
static const double el_length = 32.4, el_radius = 3.2, el_speed = 227, el_density = 8.93e-3, el_young = 117e3,
                    el_poisson = 0.35, el_yield = 400, el_hardening = 100, el_time = 0.08;

typedef struct element {
    int node[4];
    double volume, strain, s[4]; /* at the start; plastic; deviator rr zz tt rz */
} element;

/* Stress of one element over dt and its forces on f; returns its stable step. x, v, f: r and z per node. */
static inline double element_force(element *e, const double *x, const double *v, double *f, double dt)
{
    static const double glass[4] = {1, -1, 1, -1};
    const double G = el_young / (2 * (1 + el_poisson)), K = el_young / (3 * (1 - 2 * el_poisson));
    const double c = sqrt((K + 4 * G / 3) / el_density), pi = 3.14159265358979323846;
    double r[4], z[4], u[4], w[4], br[4], bz[4], g[4], area, rc = 0, longest = 0, hr = 0, hz = 0, qr = 0, qz = 0;
    double rr = 0, zz = 0, rz = 0, zr = 0, tt = 0, trace, turn, s[4], mises, over, rho, p, size, volume, hourglass;
    int a, b;
    for (a = 0; a < 4; a++) {
        r[a] = x[2 * e->node[a]];
        z[a] = x[2 * e->node[a] + 1];
        u[a] = v[2 * e->node[a]];
        w[a] = v[2 * e->node[a] + 1];
        rc += r[a] / 4;
    }
    area = 0.5 * ((r[2] - r[0]) * (z[3] - z[1]) + (r[1] - r[3]) * (z[2] - z[0]));
    for (a = 0; a < 4; a++) {
        br[a] = 0.5 / area * (z[(a + 1) % 4] - z[(a + 3) % 4]);
        bz[a] = 0.5 / area * (r[(a + 3) % 4] - r[(a + 1) % 4]);
        for (b = 0; b < a; b++) longest = fmax(longest, hypot(r[a] - r[b], z[a] - z[b]));
        rr += br[a] * u[a];
        zz += bz[a] * w[a];
        rz += bz[a] * u[a];
        zr += br[a] * w[a];
        tt += u[a] / (4 * rc);
        hr += glass[a] * r[a];
        hz += glass[a] * z[a];
    }
    trace = rr + zz + tt;
    turn = 0.5 * (rz - zr) * dt;
    s[0] = e->s[0] + 2 * turn * e->s[3] + 2 * G * dt * (rr - trace / 3);
    s[1] = e->s[1] - 2 * turn * e->s[3] + 2 * G * dt * (zz - trace / 3);
    s[2] = e->s[2] + 2 * G * dt * (tt - trace / 3);
    s[3] = e->s[3] + turn * (e->s[1] - e->s[0]) + G * dt * (rz + zr);
    mises = sqrt(1.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2 * s[3] * s[3]));
    over = mises - el_yield - el_hardening * e->strain;
    if (over > 0) {
        over /= 3 * G + el_hardening;
        e->strain += over;
    }
    for (a = 0; a < 4; a++) e->s[a] = over > 0 ? s[a] * (1 - 3 * G * over / mises) : s[a];
    volume = 2 * pi * rc * area;
    rho = el_density * e->volume / volume;
    size = sqrt(area);
    p = K * (e->volume / volume - 1);
    if (trace < 0) p += rho * -trace * size * (0.06 * c + 1.5 * size * -trace);
    hourglass = 0.06 * el_density * c * size * pi * rc / 2;
    for (a = 0; a < 4; a++) {
        g[a] = glass[a] - hr * br[a] - hz * bz[a];
        qr += g[a] * u[a];
        qz += g[a] * w[a];
    }
    for (a = 0; a < 4; a++) {
        f[2 * e->node[a]] -= volume * ((e->s[0] - p) * br[a] + e->s[3] * bz[a] + (e->s[2] - p) / (4 * rc)) +
                             hourglass * qr * g[a];
        f[2 * e->node[a] + 1] -= volume * ((e->s[1] - p) * bz[a] + e->s[3] * br[a]) + hourglass * qz * g[a];
    }
    return 0.35 * area / longest / c;
}

/* Nodes in rows of n + 1 from the axis outwards, elements of n per row; masses of the nodes. */
static inline void elements_begin(int n, int rows, double *x, double *v, double *mass, element *e)
{
    int i, j, a;
    for (j = 0; j <= rows; j++)
        for (i = 0; i <= n; i++) {
            x[2 * (j * (n + 1) + i)] = el_radius * i / n;
            x[2 * (j * (n + 1) + i) + 1] = el_length * j / rows;
            v[2 * (j * (n + 1) + i) + 1] = -el_speed;
        }
    for (j = 0; j < rows; j++)
        for (i = 0; i < n; i++, e++) {
            const int k = j * (n + 1) + i;
            e->node[0] = k;
            e->node[1] = k + 1;
            e->node[2] = k + n + 2;
            e->node[3] = k + n + 1;
            e->volume = 2 * 3.14159265358979323846 * el_radius * (i + 0.5) / n * (el_radius / n) * (el_length / rows);
            for (a = 0; a < 4; a++) mass[e->node[a]] += el_density * e->volume / 4;
        }
}

/* The bar with n elements on the radius; held: the foot stays on the wall. All zero without memory. */
static inline elements_result elements_run(int n, int held)
{
    const int rows = (int)(el_length / el_radius * n + 0.5), nodes = (n + 1) * (rows + 1);
    double *x = (double *)calloc((size_t)nodes * 7, sizeof *x), *v, *f, *mass;
    element *e = (element *)calloc((size_t)(n * rows), sizeof *e);
    elements_result r = {0, 0, 0};
    double time = 0, dt = 1e-7, next;
    int i, a;
    if (x && e) {
        v = x + 2 * nodes;
        f = v + 2 * nodes;
        mass = f + 2 * nodes;
        elements_begin(n, rows, x, v, mass, e);
        while (time < el_time) {
            next = 1;
            memset(f, 0, (size_t)nodes * 2 * sizeof *f);
            for (i = 0; i < n * rows; i++) next = fmin(next, element_force(&e[i], x, v, f, dt));
            for (i = 0; i < nodes; i++)
                for (a = 0; a < 2; a++) v[2 * i + a] += dt * f[2 * i + a] / mass[i];
            for (i = 0; i < nodes; i += n + 1) v[2 * i] = 0;
            for (i = 0; i <= n; i++) { /* the wall */
                if (held) v[2 * i + 1] = 0;
                else if (x[2 * i + 1] + dt * v[2 * i + 1] < 0) v[2 * i + 1] = -x[2 * i + 1] / dt;
            }
            for (i = 0; i < 2 * nodes; i++) x[i] += dt * v[i];
            time += dt;
            dt = next;
        }
        r.length = x[2 * (nodes - n - 1) + 1];
        r.radius = x[2 * n];
        r.lift = x[2 * n + 1];
    }
    free(x);
    free(e);
    return r;
}

#endif
