/* 00_step - the step of the material point method as the textbook has it, standing alone: read this first. Dense
   arrays, one point after the other, eight nodes each. mpm_step does the same to round-off, as tests/71_step.c shows;
   docs/method.md walks through both. The story: an elastic ball of aluminium, 6 um wide, hits an elastic block on a
   fixed floor at 200 m/s. Expected: it leaves at 187.7 m/s, and ball and block have kept 100.0 % of the energy.
   No point may lie exactly on a grid plane. Units um, us, ng: stress in MPa. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NX = 11, NY = 11, NZ = 15, NODES = NX * NY * NZ, MOST = 4000 }; /* nodes along x, y, z; room for points */
static const double cell = 1, spacing = 0.5, cube = 0.125, dt = 8e-6, rho = 0.0027, lambda = 51084, mu = 26316;

typedef struct { int body; double mass, density, x[3], v[3], L[3][3], stress[3][3]; } point;
typedef struct { double mass, momentum[3], force[3], velocity[3], gradient[3]; } node;
typedef struct { double N, G[3]; } shape; /* shape function of a node at a point, and its gradient */
static point points[MOST];
static node nodes[2 * NODES]; /* every body has its own */
static int count;

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static void add(double *to, double f, const double *v) { for (int i = 0; i < 3; i++) to[i] += f * v[i]; }

/* The floor: the lowest layer of nodes does not move. */
static void hold(const node *n, double *v) { if ((n - nodes) % NODES < NX * NY) v[0] = v[1] = v[2] = 0; }

/* Calls phase(point, node, shape) for the eight nodes of every point: the sums of the textbook. */
static void each(void (*phase)(point *p, node *n, const shape *s))
{
    for (point *p = points; p < points + count; p++) {
        const double x[3] = {p->x[0] / cell, p->x[1] / cell, p->x[2] / cell}; /* level k in all phases */
        for (int c = 0; c < 8; c++) {
            const int at[3] = {(int)x[0] + (c & 1), (int)x[1] + (c >> 1 & 1), (int)x[2] + (c >> 2)};
            double N[3], d[3];
            for (int i = 0; i < 3; i++) N[i] = 1 - fabs(x[i] - at[i]), d[i] = (x[i] < at[i] ? 1 : -1) / cell;
            const shape s = {N[0] * N[1] * N[2], {d[0] * N[1] * N[2], N[0] * d[1] * N[2], N[0] * N[1] * d[2]}};
            phase(p, &nodes[p->body * NODES + (at[2] * NY + at[1]) * NX + at[0]], &s);
        }
    }
}

static void p2g(point *p, node *n, const shape *s) /* m_I = sum m_p N, P_I = sum m_p v_p N */
{
    n->mass += p->mass * s->N;
    add(n->momentum, p->mass * s->N, p->v);
    hold(n, n->momentum);
}

static void forces(point *p, node *n, const shape *s) /* f_I = - sum m_p / rho_p sigma_p grad N */
{
    for (int i = 0; i < 3; i++) n->force[i] -= p->mass / p->density * dot(p->stress[i], s->G);
    hold(n, n->force);
}

/* P_I += f_I dt */
static void grid_update(node *n) { add(n->momentum, dt, n->force); }

/* g_I = sum m_p grad N: out of the body */
static void gradient(point *p, node *n, const shape *s) { add(n->gradient, p->mass, s->G); }

static void contact(node *a, node *b) /* where ball a and block b approach: one velocity along the normal */
{
    const double light = 1e-3 * rho * cube, *g = b->gradient, size = -sqrt(dot(g, g)); /* n = -g_b / |g_b|, out of a */
    double j;
    if (!(a->mass > light && b->mass > light)) return;
    j = (b->mass * dot(a->momentum, g) - a->mass * dot(b->momentum, g)) / size / (a->mass + b->mass);
    if (!(j > 0)) return; /* they separate */
    add(a->momentum, -j / size, g), add(a->force, -j / size / dt, g);
    add(b->momentum, j / size, g), add(b->force, j / size / dt, g);
}

/* v_p += dt sum f_I N / m_I */
static void g2p(point *p, node *n, const shape *s) { add(p->v, dt * s->N / n->mass, n->force); }

static void musl(point *p, node *n, const shape *s) /* v_I = sum m_p v_p N / m_I: of the new v_p */
{
    add(n->velocity, p->mass * s->N / n->mass, p->v);
    hold(n, n->velocity);
}

static void strain(point *p, node *n, const shape *s) /* L_p = dt sum v_I grad N */
{
    for (int i = 0; i < 3; i++) add(p->L[i], dt * n->velocity[i], s->G);
}

static void stress(point *p) /* rho /= 1 + tr L; sigma += W sigma - sigma W + lambda tr(L) 1 + mu (L + L^T) */
{
    const double trace = p->L[0][0] + p->L[1][1] + p->L[2][2];
    double W[3][3], old[3][3]; /* W = (L - L^T)/2, hence -(sigma W)_ij = sum_k sigma_ik W_jk */
    memcpy(old, p->stress, sizeof old);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) W[i][j] = (p->L[i][j] - p->L[j][i]) / 2;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            p->stress[i][j] += dot(W[i], old[j]) + dot(old[i], W[j]) + mu * (p->L[i][j] + p->L[j][i]) +
                               (i == j ? lambda * trace : 0);
    p->density /= 1 + trace;
    memset(p->L, 0, sizeof p->L);
}

/* x_p += dt sum P_I N / m_I */
static void move(point *p, node *n, const shape *s) { add(p->x, dt * s->N / n->mass, n->momentum); }

static void step(void)
{
    memset(nodes, 0, sizeof nodes);
    each(p2g);
    each(forces);
    for (int n = 0; n < 2 * NODES; n++) grid_update(&nodes[n]);
    each(gradient);
    for (int n = 0; n < NODES; n++) contact(&nodes[n], &nodes[NODES + n]);
    each(g2p);
    each(musl);
    each(strain);
    for (int p = 0; p < count; p++) stress(&points[p]);
    each(move);
}

/* A lattice of points through the grid: those in the ball become body 0, those in the block body 1. */
static void fill(void)
{
    for (int body = count = 0; body < 2; body++)
        for (int k = 0; k < 28 * 20 * 20; k++) {
            const double x = (k % 20 + 0.5) * spacing, y = (k / 20 % 20 + 0.5) * spacing, z = (k / 400 + 0.5) * spacing;
            const double from[3] = {x - 5, y - 5, z - 7.5};
            const point p = {body, rho * cube, rho, {x, y, z}, {0, 0, body ? 0 : -200}, {{0}}, {{0}}};
            if (body ? x > 1 && x < 9 && y > 1 && y < 9 && z < 4 : dot(from, from) <= 9) points[count++] = p;
        }
}

/* Kinetic and elastic energy; *v gets the ball's mean velocity along z. */
static double energy(double *v)
{
    double sum = 0, vz = 0, ball = 0;
    for (const point *p = points; p < points + count; p++) {
        const double (*s)[3] = p->stress, square = dot(s[0], s[0]) + dot(s[1], s[1]) + dot(s[2], s[2]);
        const double trace = s[0][0] + s[1][1] + s[2][2], share = lambda / (3 * lambda + 2 * mu);
        sum += p->mass * dot(p->v, p->v) / 2 + p->mass / p->density * (square - share * trace * trace) / (4 * mu);
        if (p->body == 0) vz += p->v[2], ball++;
    }
    *v = vz / ball;
    return sum;
}

int main(void)
{
    double v, before;
    fill();
    before = energy(&v);
    for (int k = 0; k < 800; k++) step();
    printf("energy kept: %.1f %%\n", 100 * energy(&v) / before);
    printf("the ball leaves at %.1f m/s\n", v);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
