/* oracle.h - the step of the method a second time, dense and slow: linear or GIMP, 3D or rings, a fixed floor, mirrors,
   Coulomb friction between two bodies. It shares nothing with mpm.h but the equations, and the shape functions not even
   in their form: they are integrals of the hat. For tests/71_step.c. SPDX-License-Identifier: MIT */
#ifndef ORACLE_H
#define ORACLE_H

#include <math.h>
#include <string.h>

enum { ORACLE_POINTS = 4000, ORACLE_EDGE = 12, ORACLE_NODES = ORACLE_EDGE * ORACLE_EDGE * ORACLE_EDGE };

typedef struct oracle_point { int body; double mass, density, x[3], v[3], s[3][3]; } oracle_point;
typedef struct oracle_node { double mass, P[3], f[3], v[3], g[3]; } oracle_node;

/* A node that a point reaches: where, N and grad N; turn[d] is -1 for vectors that a mirror turns around. */
typedef struct oracle_touch { int at[3]; double N, G[3], turn[3]; } oracle_touch;

typedef struct oracle {
    int gimp, rings, mirror[3]; /* mirror[d]: the plane where coordinate d is 0 is one */
    double cell, spacing, friction, lambda, mu, density;
    int count;
    oracle_point point[ORACLE_POINTS];
    oracle_node node[2][ORACLE_NODES];
} oracle;

static double oracle_hat(double u) { return fabs(u) < 1 ? 1 - fabs(u) : 0; }

/* The hat's integral from the left up to u. */
static double oracle_area(double u)
{
    if (u <= -1) return 0;
    return u < 0 ? (1 + u) * (1 + u) / 2 : u < 1 ? 1 - (1 - u) * (1 - u) / 2 : 1;
}

/* Along one axis, e cells from the node: the hat, or its mean over the point of half width l; *d its slope. */
static double oracle_weight(const oracle *o, double e, double *d)
{
    const double l = o->spacing / o->cell / 2, left = -fabs(e), sign = e < 0 ? 1 : -1;
    if (!o->gimp) {
        *d = fabs(e) < 1 ? sign / o->cell : 0;
        return oracle_hat(e);
    }
    *d = sign * (oracle_hat(left + l) - oracle_hat(left - l)) / (2 * l * o->cell);
    return (oracle_area(left + l) - oracle_area(left - l)) / (2 * l);
}

/* All nodes that x reaches; those beyond a mirror are their images on this side. Returns their number. */
static int oracle_touches(const oracle *o, const double *x, oracle_touch *t)
{
    double N[3][4], D[3][4];
    int i, d, n = 0;
    for (d = 0; d < 3; d++)
        for (i = 0; i < 4; i++) N[d][i] = oracle_weight(o, x[d] / o->cell - floor(x[d] / o->cell) - (i - 1), &D[d][i]);
    if (o->rings) N[1][0] = 1, N[1][1] = N[1][2] = N[1][3] = D[1][0] = 0; /* nothing depends on y */
    for (i = 0; i < 64; i++) {
        const int step[3] = {i % 4, i / 4 % 4, i / 16};
        t->N = N[0][step[0]] * N[1][step[1]] * N[2][step[2]];
        if (!(t->N > 0)) continue;
        t->G[0] = D[0][step[0]] * N[1][step[1]] * N[2][step[2]];
        t->G[1] = N[0][step[0]] * D[1][step[1]] * N[2][step[2]];
        t->G[2] = N[0][step[0]] * N[1][step[1]] * D[2][step[2]];
        for (d = 0; d < 3; d++) {
            const int at = d == 1 && o->rings ? 0 : (int)floor(x[d] / o->cell) + step[d] - 1;
            t->turn[d] = o->mirror[d] && at < 0 ? -1 : 1;
            t->at[d] = o->mirror[d] && at < 0 ? -at : at;
        }
        t++, n++;
    }
    return n;
}

static oracle_node *oracle_at(oracle *o, int body, const int *at)
{
    return &o->node[body][((at[2] + 1) * ORACLE_EDGE + at[1] + 1) * ORACLE_EDGE + at[0] + 1];
}

/* What mirrors and the floor leave of a vector of a node. */
static void oracle_constrain(const oracle *o, const int *at, double *v)
{
    int d;
    for (d = 0; d < 3; d++)
        if ((o->mirror[d] && at[d] == 0) || at[2] <= 0) v[d] = 0;
}

/* Runs over the points p, the nodes they reach and how: n and t. */
#define ORACLE_EACH(o, p, t, n)                                                     \
    for (p = (o)->point; p < (o)->point + (o)->count; p++)                          \
        for (t = touch, end = touch + oracle_touches(o, p->x, touch);               \
             t < end && ((n = oracle_at(o, p->body, t->at)) != 0); t++)

/* ... and over the nodes of the grid, at[]. */
#define ORACLE_GRID(at)                                    \
    for (at[2] = -1; at[2] < ORACLE_EDGE - 1; at[2]++)     \
        for (at[1] = -1; at[1] < ORACLE_EDGE - 1; at[1]++) \
            for (at[0] = -1; at[0] < ORACLE_EDGE - 1; at[0]++)

/* Mass, momentum, force and mass gradient of the nodes; then the new momentum. */
static void oracle_to_grid(oracle *o, double dt)
{
    oracle_touch touch[64], *t, *end;
    oracle_point *p;
    oracle_node *n;
    int at[3], d, e, body;
    memset(o->node, 0, sizeof o->node);
    ORACLE_EACH(o, p, t, n) {
        const double ring = o->rings ? 1 / p->x[0] : 0, V = p->mass / p->density;
        n->mass += p->mass * t->N;
        for (d = 0; d < 3; d++) {
            double pull = d == 0 ? p->s[1][1] * t->N * ring : 0;
            for (e = 0; e < 3; e++) pull += p->s[d][e] * t->G[e];
            n->P[d] += t->turn[d] * p->mass * p->v[d] * t->N;
            n->f[d] -= t->turn[d] * V * pull;
            n->g[d] += t->turn[d] * p->mass * (t->G[d] + (d == 0 ? t->N * ring : 0));
        }
    }
    for (body = 0; body < 2; body++)
        ORACLE_GRID(at) {
            n = oracle_at(o, body, at);
            oracle_constrain(o, at, n->P);
            oracle_constrain(o, at, n->f);
            oracle_constrain(o, at, n->g);
            for (d = 0; d < 3; d++) n->P[d] += n->f[d] * dt;
        }
}

/* Whether a node weighs enough for contact: a thousandth of a point there. */
static int oracle_heavy(const oracle *o, const oracle_node *n, const int *at)
{
    double one = o->density * o->spacing * o->spacing * o->spacing, r = at[0] * o->cell;
    int d;
    if (o->rings) one = o->density * o->spacing * o->spacing * 2 * 3.14159265358979323846 * (r > 0 ? r : o->cell / 2);
    for (d = 0; d < 3 && !o->rings; d++)
        if (o->mirror[d] && at[d] == 0) one /= 2;
    return n->mass > 1e-3 * one;
}

/* Contact at the nodes that carry both bodies: with the normal of body 1, or of body 0 where that has none. */
static void oracle_contact(oracle *o, double dt)
{
    int at[3], d;
    ORACLE_GRID(at) {
        oracle_node *a = oracle_at(o, 0, at), *b = oracle_at(o, 1, at);
        double size = sqrt(b->g[0] * b->g[0] + b->g[1] * b->g[1] + b->g[2] * b->g[2]), n[3], j[3], jn = 0, jt = 0;
        if (!(oracle_heavy(o, a, at) && oracle_heavy(o, b, at))) continue;
        for (d = 0; d < 3; d++) n[d] = -b->g[d] / size;
        if (size < 1e-12 * b->mass / o->cell) {
            size = sqrt(a->g[0] * a->g[0] + a->g[1] * a->g[1] + a->g[2] * a->g[2]);
            for (d = 0; d < 3; d++) n[d] = a->g[d] / size;
        }
        for (d = 0; d < 3; d++) j[d] = (a->mass * b->P[d] - b->mass * a->P[d]) / (a->mass + b->mass);
        for (d = 0; d < 3; d++) jn += j[d] * n[d];
        if (jn >= 0) continue;
        for (d = 0; d < 3; d++) jt += (j[d] - jn * n[d]) * (j[d] - jn * n[d]);
        jt = sqrt(jt);
        for (d = 0; d < 3; d++) {
            const double limit = -o->friction * jn, slip = (j[d] - jn * n[d]) * (jt > limit ? limit / jt : 1);
            j[d] = jn * n[d] + slip;
        }
        oracle_constrain(o, at, j);
        for (d = 0; d < 3; d++) {
            a->P[d] += j[d], b->P[d] -= j[d];
            a->f[d] += j[d] / dt, b->f[d] -= j[d] / dt;
        }
    }
}

/* Velocities of the points, and from them those of the nodes. */
static void oracle_velocities(oracle *o, double dt)
{
    oracle_touch touch[64], *t, *end;
    oracle_point *p;
    oracle_node *n;
    int at[3], d, body;
    ORACLE_EACH(o, p, t, n)
        for (d = 0; d < 3 && n->mass > 0; d++) p->v[d] += t->turn[d] * dt * n->f[d] * t->N / n->mass;
    ORACLE_EACH(o, p, t, n)
        for (d = 0; d < 3 && n->mass > 0; d++) n->v[d] += t->turn[d] * p->mass * p->v[d] * t->N / n->mass;
    for (body = 0; body < 2; body++)
        ORACLE_GRID(at) oracle_constrain(o, at, oracle_at(o, body, at)->v);
}

/* sigma <- sigma + W sigma - sigma W + lambda tr(e) + 2 mu e, from dt grad v. */
static void oracle_stress(const oracle *o, oracle_point *p, double L[3][3])
{
    double e[3][3], W[3][3], s[3][3];
    int i, j, k;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) {
            e[i][j] = (L[i][j] + L[j][i]) / 2;
            W[i][j] = (L[i][j] - L[j][i]) / 2;
            s[i][j] = p->s[i][j];
        }
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) {
            p->s[i][j] += 2 * o->mu * e[i][j] + (i == j ? o->lambda * (e[0][0] + e[1][1] + e[2][2]) : 0);
            for (k = 0; k < 3; k++) p->s[i][j] += W[i][k] * s[k][j] - s[i][k] * W[k][j];
        }
    p->density /= 1 + e[0][0] + e[1][1] + e[2][2];
}

/* Stress and position of the points. */
static void oracle_update(oracle *o, double dt)
{
    oracle_touch touch[64];
    oracle_point *p;
    int i, j, k;
    for (p = o->point; p < o->point + o->count; p++) {
        const int reached = oracle_touches(o, p->x, touch);
        double L[3][3] = {{0}}, u[3] = {0, 0, 0}, vr = 0;
        for (k = 0; k < reached; k++) {
            const oracle_touch *t = &touch[k];
            const oracle_node *n = oracle_at(o, p->body, t->at);
            if (!(n->mass > 0)) continue;
            vr += t->turn[0] * n->v[0] * t->N;
            for (i = 0; i < 3; i++) {
                for (j = 0; j < 3; j++) L[i][j] += dt * t->turn[i] * n->v[i] * t->G[j];
                u[i] += t->turn[i] * n->P[i] * t->N / n->mass;
            }
        }
        if (o->rings) L[1][1] = dt * vr / p->x[0];
        oracle_stress(o, p, L);
        for (i = 0; i < 3; i++) p->x[i] += dt * u[i];
    }
}

static void oracle_step(oracle *o, double dt)
{
    oracle_to_grid(o, dt);
    oracle_contact(o, dt);
    oracle_velocities(o, dt);
    oracle_update(o, dt);
}

#endif
