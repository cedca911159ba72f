/* 26_extend - the door for extensions: supports, pushes, contact rules and laws of one's own, bodies from functions
   and points, points that come and go, memory that grows. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

#include <stdlib.h>
#include <string.h>

static const double eps = (double)MPM_EPSILON;
static const mpm_real step = MPM_R(2e-5); /* us */
static mpm_material metal;                /* elastic aluminium */

/* Everything a point carries, the flags and the id, of worlds whose points stand in the same order: 1 if the bits
   are the same. */
static int same_bits(const mpm_world *a, const mpm_world *b)
{
    int32_t i;
    int f, same = a->points.count == b->points.count && a->bodies == b->bodies;
    for (i = 0; same && i < a->points.count; i++) {
        for (f = 0; f < a->fields && f < b->fields; f++)
            same &= !memcmp(&a->field[(size_t)f * a->stride + (size_t)i], &b->field[(size_t)f * b->stride + (size_t)i],
                            sizeof *a->field);
        same &= a->points.id[i] == b->points.id[i] && a->points.flags[i] == b->points.flags[i];
    }
    return same;
}

/* Where the point of an id stands, or -1. */
static int32_t find(const mpm_world *w, int32_t id)
{
    int32_t i;
    for (i = 0; i < w->points.count; i++)
        if (w->points.id[i] == id) return i;
    return -1;
}

/* Largest difference of velocity of points of the same id, over `scale`; 1e9 where one is missing. */
static double velocity_difference(const mpm_world *a, const mpm_world *b, double scale)
{
    double worst = a->points.count == b->points.count ? 0 : 1e9;
    int32_t i;
    int d;
    for (i = 0; i < a->points.count; i++) {
        const int32_t j = find(b, a->points.id[i]);
        if (j < 0) return 1e9;
        for (d = 0; d < 3; d++)
            worst = check_worst(worst, fabs((double)a->points.v[d][i] - (double)b->points.v[d][j]) / scale);
    }
    return worst;
}

/* A step with something of one's own after the forces. */
static mpm_status push_step(mpm_world *w, void (*own)(mpm_world *w))
{
    if (mpm_locate(w, step) < 0) return w->fault.status;
    mpm_p2g(w);
    mpm_forces(w);
    own(w);
    mpm_grid_update(w);
    mpm_contact_find(w);
    mpm_contact_apply(w);
    mpm_g2p(w);
    mpm_musl(w);
    if (mpm_stress(w) < 0) return w->fault.status;
    mpm_move(w);
    return MPM_OK;
}

/* What the ledger says is kept. */
static double energy(const mpm_world *w)
{
    const mpm_totals t = mpm_body_totals(w, -1);
    const mpm_ledger *l = &w->ledger;
    return t.kinetic + t.internal + l->absorbed + l->contact + l->hold + l->walls - l->work;
}

/* ---- supports ------------------------------------------------------------------------------ */

/* Shape functions of all points: they sum to 1, give back the place, and their gradients the unit tensor; nodes
   across a mirror count at their images. */
static void support_of_points(const mpm_world *w, double *sum, double *place, double *slope, long *mirrors)
{
    int32_t r, i;
    int a, d, e;
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            double N = 0, x[3] = {0, 0, 0}, G[3][3] = {{0}}, zero[3] = {0, 0, 0};
            mpm_support s;
            mpm_support_of(w, &w->run[r], i, &s);
            for (a = 0; a < s.count; a++) {
                mpm_real at[3];
                mpm_node_position(w, &w->node[s.slot[a]], at);
                N += (double)s.N[a];
                for (d = 0; d < 3; d++) {
                    const double low = (double)w->desc.origin[d], high = low + w->desc.cells[d] * (double)w->desc.cell;
                    const double plane = (double)at[d] - low < high - (double)at[d] ? low : high;
                    const int mirrored = s.mirror[a] >> d & 1;
                    const double image = mirrored ? 2 * plane - (double)at[d] : (double)at[d];
                    *mirrors += mirrored;
                    x[d] += (double)s.N[a] * image;
                    zero[d] += (double)s.G[d][a];
                    for (e = 0; e < 3; e++) G[e][d] += (double)s.G[e][a] * image;
                }
            }
            *sum = check_worst(*sum, fabs(N - 1));
            for (d = 0; d < 3; d++) {
                if (d == 1 && w->desc.geometry != MPM_3D) continue;
                *place = check_worst(*place, fabs(x[d] - (double)w->points.x[d][i]));
                *sum = check_worst(*sum, fabs(zero[d]));
                for (e = 0; e < 3; e++)
                    if (e != 1 || w->desc.geometry == MPM_3D)
                        *slope = check_worst(*slope, fabs(G[e][d] - (d == e ? 1 : 0)));
            }
        }
}

/* Every slot is found from its node and body; no slot where there is none. */
static void nodes_found(const mpm_world *w)
{
    int32_t i;
    int found = 1, none = 1, flat = 1;
    for (i = 0; i < w->nodes; i++) {
        mpm_real x[3];
        mpm_node_position(w, &w->node[i], x);
        found &= mpm_node_find(w, w->node[i].index, w->node[i].body) == i;
        none &= mpm_node_find(w, w->node[i].index, w->node[i].body + 7) == -1;
        if (w->desc.geometry != MPM_3D) flat &= !(fabs((double)x[1]) > 0);
    }
    CHECK_TRUE("... every slot is found by its node and body", found && w->nodes > 10);
    CHECK_TRUE("... and no other", none && mpm_node_find(w, -1, 0) == -1 && mpm_node_find(w, 2147483647, 0) == -1);
    CHECK_TRUE("... y is 0 in two dimensions", flat);
}

/* The furthest that the grid's velocity at a point is from 10 down, what nodes give there; those across the mirror
   z = -1 go up, those on it rest. */
static double slowest(const mpm_world *w)
{
    double worst = 0;
    int32_t r, i;
    int a;
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            double N = 0;
            mpm_support s;
            mpm_real v[3];
            mpm_support_of(w, &w->run[r], i, &s);
            mpm_support_velocity(w, &s, v);
            for (a = 0; a < s.count; a++) {
                mpm_real at[3];
                mpm_node_position(w, &w->node[s.slot[a]], at);
                if (at[2] > -1 + MPM_R(0.01)) N += (s.mirror[a] & 4 ? -1 : 1) * (double)s.N[a];
            }
            worst = check_worst(worst, fabs((double)v[2] + 10 * N) + fabs((double)v[0]) + fabs((double)v[1]));
        }
    return worst;
}

/* The furthest that the support of a point's place is from the point's own; nothing is found off the grid. */
static double places(const mpm_world *w)
{
    mpm_real off[3] = {0, 0, 10};
    double worst = 0;
    mpm_support one, two;
    int32_t r, i;
    int a, b, d;
    CHECK_EQUAL("... none off the grid", mpm_support_at(w, 0, off, &two), 0);
    off[0] = MPM_R(-0.001), off[2] = MPM_R(-1.001);
    CHECK_EQUAL("... what lies behind mirrors is on them", mpm_support_at(w, 0, off, &two), 1);
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            mpm_real x[3], v[3], u[3];
            for (d = 0; d < 3; d++) x[d] = w->points.x[d][i];
            mpm_support_of(w, &w->run[r], i, &one);
            if (!mpm_support_at(w, 0, x, &two) || one.count != two.count) return 1;
            mpm_support_velocity(w, &one, v);
            mpm_support_velocity(w, &two, u);
            for (d = 0; d < 3; d++) worst = check_worst(worst, fabs((double)(v[d] - u[d])) / 10);
            for (a = b = 0; a < one.count; a++, b++)
                if (one.slot[a] != two.slot[b] || one.mirror[a] != two.mirror[b]) worst = 1;
        }
    return worst;
}

/* A ball in the corner of three mirrors, where supports reach through all of them. */
static void supports(mpm_geometry geometry, mpm_basis basis, const char *name)
{
    mpm_desc d = scene_grid(0.8, 9, 9, 9, 0, 0, -1);
    mpm_body_desc b = scene_body(&metal, mpm_ellipsoid(0, 0, -1, 3, 3, MPM_R(2.6)), 0.4, -10);
    double sum = 0, place = 0, slope = 0;
    long mirrors = 0;
    mpm_world w;
    d.geometry = geometry;
    d.basis = basis;
    d.side[0] = d.side[2] = d.side[4] = MPM_SIDE_SYMMETRY;
    CHECK_EQUAL(name, mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("... a body", mpm_body_add(&w, &b), MPM_OK);
    CHECK_EQUAL("... located", mpm_locate(&w, step), MPM_OK);
    mpm_p2g(&w);
    support_of_points(&w, &sum, &place, &slope, &mirrors);
    if (basis <= MPM_GIMP) /* splines feel a mirror from further off */
        CHECK_NEAR("... the grid moves as one with its points", slowest(&w), 0, 1000 * eps);
    CHECK_NEAR("... a place is supported as a point there", places(&w), 0, 100 * eps);
    CHECK_NEAR("... N sums to 1, gradients to 0", sum, 0, 64 * eps);
    CHECK_NEAR("... places come back, mirror images counted [um]", place, 0, (basis == MPM_LINEAR ? 1e5 : 64) * eps);
    CHECK_NEAR("... gradients of the place are 1", slope, 0, 256 * eps);
    CHECK_TRUE("... mirrors are told, but for linear functions", (mirrors > 0) == (basis != MPM_LINEAR));
    nodes_found(&w);
    mpm_free(&w);
}

/* ---- pushes -------------------------------------------------------------------------------- */

static const mpm_real pull_down[3] = {300, -200, -5000}; /* um/us^2 */

/* The force m g on every point. */
static void as_gravity(mpm_world *w)
{
    int32_t r, i;
    int d;
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            mpm_support s;
            mpm_real f[3];
            mpm_support_of(w, &w->run[r], i, &s);
            for (d = 0; d < 3; d++) f[d] = w->points.mass[i] * pull_down[d];
            mpm_push(w, &s, f);
        }
}

static void nothing(mpm_world *w) { (void)w; }

/* A force that is another at every point: it turns, squeezes and moves the body. */
static void uneven_at(const mpm_world *w, int32_t i, mpm_real *f)
{
    const mpm_real m = w->points.mass[i], z = w->points.x[2][i] - 5, x = w->points.x[0][i] - 5;
    f[0] = m * 4000 * z;
    f[1] = m * 1000;
    f[2] = m * (2000 - 9000 * x * z);
}

static void uneven(mpm_world *w)
{
    int32_t r, i;
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            mpm_support s;
            mpm_real f[3];
            mpm_support_of(w, &w->run[r], i, &s);
            uneven_at(w, i, f);
            mpm_push(w, &s, f);
        }
}

/* One more such step: the work of the forces, one by one, over what the ledger books for all. */
static double works(mpm_world *w)
{
    const double before = w->ledger.walls;
    double work = 0;
    int32_t r, i;
    mpm_locate(w, step);
    mpm_p2g(w);
    mpm_forces(w);
    uneven(w);
    mpm_grid_update(w);
    mpm_g2p(w);
    mpm_musl(w);
    for (r = 0; r < w->runs; r++)
        for (i = w->run[r].first; i < w->run[r].first + w->run[r].count; i++) {
            mpm_support s;
            mpm_real f[3];
            mpm_support_of(w, &w->run[r], i, &s);
            uneven_at(w, i, f);
            work += mpm_support_work(w, &s, f);
        }
    return work / (before - w->ledger.walls);
}

/* A ball of aluminium, elastic or without stress, flying. */
static mpm_world ball(mpm_geometry geometry, mpm_basis basis, mpm_side floor, int stress)
{
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(5, 5, floor ? MPM_R(2.1) : 5, 2), 0.5, -20);
    mpm_world w;
    d.geometry = geometry;
    d.basis = basis;
    d.side[4] = floor;
    b.velocity[0] = 10;
    if (!stress) b.stress = NULL;
    CHECK_EQUAL("a ball", mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("... added", mpm_body_add(&w, &b), MPM_OK);
    return w;
}

static void body_force(mpm_geometry geometry, mpm_basis basis, mpm_side floor)
{
    mpm_world pushed = ball(geometry, basis, floor, 1), heavy = ball(geometry, basis, floor, 1);
    double work;
    int n, d;
    for (d = 0; d < 3; d++) heavy.desc.gravity[d] = geometry != MPM_3D && d < 2 ? 0 : pull_down[d];
    for (n = 0; n < 100; n++)
        if (push_step(&pushed, as_gravity) < 0 || push_step(&heavy, nothing) < 0) break;
    CHECK_EQUAL("a force m g on every point: steps", n, 100);
    if (geometry == MPM_3D)
        CHECK_NEAR("... moves a body as gravity does", velocity_difference(&pushed, &heavy, 20), 0, 5000 * eps);
    CHECK_RELATIVE("... with the impulse of gravity", pushed.ledger.impulse[2], heavy.ledger.impulse[2], 1e4 * eps);
    work = heavy.ledger.work - heavy.ledger.walls;
    CHECK_RELATIVE("... and its work, less what is lost at walls", -pushed.ledger.walls, work, 1e4 * eps);
    mpm_free(&pushed);
    mpm_free(&heavy);
}

/* Momentum always, energy of a body without stress too: to round-off. With stress, the error of its work in time. */
static void outer_force(mpm_geometry geometry, mpm_basis basis, mpm_side floor, int stress)
{
    mpm_world w = ball(geometry, basis, floor, stress);
    const mpm_totals t0 = mpm_body_totals(&w, -1);
    const double e0 = energy(&w);
    mpm_totals t1;
    int n, d;
    for (n = 0; n < 100; n++)
        if (push_step(&w, uneven) < 0) break;
    t1 = mpm_body_totals(&w, -1);
    CHECK_EQUAL("a force uneven over the body: steps", n, 100);
    for (d = 0; d < 3; d++) /* along the radius hoop stress has no partner */
        if (d || geometry != MPM_AXISYMMETRIC)
            CHECK_NEAR("... momentum", t1.momentum[d] - t0.momentum[d], w.ledger.impulse[d], 1e3 * eps * t0.mass * 20);
    CHECK_TRUE("... energy is brought in", fabs(w.ledger.walls) > 1e-3 * t0.kinetic);
    CHECK_NEAR("... and none is missing", (energy(&w) - e0) / (t0.kinetic + t1.kinetic + t1.internal), 0,
               !stress ? 2e3 * eps : geometry == MPM_AXISYMMETRIC ? 2e-3 : 2e-4); /* in proportion to the step */
    if (floor != MPM_SIDE_WALL)
        CHECK_RELATIVE("... the work of each is its part of the ledger's", works(&w), 1, 1e5 * eps);
    mpm_free(&w);
}

/* A ball that is pushed evenly: what MUSL has mapped back at its points is the velocity after the push; the work is
   that of the force through the mean of it and the one before. */
static void mapped(mpm_basis basis)
{
    mpm_world w = ball(MPM_3D, basis, MPM_SIDE_OPEN, 0);
    double worst = 0, work = 0;
    mpm_support s;
    mpm_real v[3], f[3];
    int32_t r, i;
    int d, pass;
    mpm_locate(&w, step);
    mpm_p2g(&w);
    mpm_forces(&w);
    for (pass = 0; pass < 2; pass++) {
        for (r = 0; r < w.runs; r++)
            for (i = w.run[r].first; i < w.run[r].first + w.run[r].count; i++) {
                mpm_support_of(&w, &w.run[r], i, &s);
                for (d = 0; d < 3; d++) f[d] = w.points.mass[i] * pull_down[d];
                if (pass == 0) {
                    mpm_push(&w, &s, f);
                    continue;
                }
                mpm_support_mapped(&w, &s, v);
                worst = check_worst(worst, fabs((double)(v[0] - 10 - step * pull_down[0])));
                worst = check_worst(worst, fabs((double)(v[1] - step * pull_down[1])));
                worst = check_worst(worst, fabs((double)(v[2] + 20 - step * pull_down[2])));
                work += mpm_support_work(&w, &s, f);
            }
        if (pass == 0) {
            mpm_grid_update(&w);
            mpm_g2p(&w);
            mpm_musl(&w);
        }
    }
    CHECK_NEAR("pushed evenly: the velocity that MUSL has mapped back", worst / 20, 0, 1e3 * eps);
    CHECK_RELATIVE("... and the work of it all: m g . v dt", work,
                   (double)step * mpm_body_totals(&w, 0).mass *
                       ((double)pull_down[0] * (10 + 0.5 * (double)(step * pull_down[0])) +
                        (double)pull_down[1] * 0.5 * (double)(step * pull_down[1]) +
                        (double)pull_down[2] * (-20 + 0.5 * (double)(step * pull_down[2]))), 1e4 * eps);
    mpm_free(&w);
}

/* Momentum to one node of a ball. */
static void node_push(void)
{
    mpm_world w = ball(MPM_3D, MPM_LINEAR, MPM_SIDE_OPEN, 0), floor = ball(MPM_3D, MPM_LINEAR, MPM_SIDE_SYMMETRY, 0);
    const mpm_totals t0 = mpm_body_totals(&w, -1);
    const double e0 = energy(&w);
    mpm_real j[3];
    int32_t slot;
    int d;
    j[0] = MPM_R(0.2), j[1] = MPM_R(-0.1), j[2] = MPM_R(0.3);
    mpm_locate(&w, step);
    mpm_p2g(&w);
    mpm_forces(&w);
    mpm_grid_update(&w);
    slot = mpm_node_find(&w, (5 * 11 + 5) * 11 + 5, 0);
    CHECK_TRUE("a node in the middle of a ball", slot >= 0);
    mpm_node_push(&w, slot, j);
    mpm_g2p(&w);
    mpm_musl(&w);
    for (d = 0; d < 3; d++)
        CHECK_NEAR("... what it is given is the body's", mpm_body_totals(&w, -1).momentum[d] - t0.momentum[d],
                   (double)j[d], 1e3 * eps * t0.mass * 20);
    CHECK_NEAR("... its work is in the ledger", energy(&w) / e0, 1, 1e3 * eps);
    mpm_locate(&floor, step);
    mpm_p2g(&floor);
    mpm_grid_update(&floor);
    slot = mpm_node_find(&floor, 5 * 11 + 5, 0);
    CHECK_TRUE("a node on a sliding plane", slot >= 0);
    mpm_node_push(&floor, slot, j);
    CHECK_NEAR("... takes nothing through it", (double)j[2], 0, 0);
    CHECK_NEAR("... and the ledger knows", floor.ledger.impulse[2], 0, 0);
    CHECK_NEAR("... but along it", floor.ledger.impulse[0], 0.2, eps);
    mpm_free(&w);
    mpm_free(&floor);
}

/* ---- pairs --------------------------------------------------------------------------------- */

/* Two blocks face on face at the plane z = 0, of 16 um2, moving as told [um/us]; contact found in the first step. */
static mpm_world blocks(mpm_basis basis, mpm_real upper_x, mpm_real upper_z, mpm_contact_law law, mpm_real friction)
{
    mpm_desc d = scene_grid(1, 12, 12, 12, -6, -6, -6);
    mpm_body_desc upper = scene_body(&metal, mpm_box(-2, -2, 0, 2, 2, 3), 0.5, (double)upper_z);
    mpm_body_desc lower = scene_body(&metal, mpm_box(-2, -2, -3, 2, 2, 0), 0.5, 0);
    mpm_world w;
    upper.velocity[0] = upper_x;
    d.basis = basis;
    d.contact.law = law;
    d.contact.friction = friction;
    d.contact.normal = MPM_NORMAL_AVERAGE; /* along z at the edges too */
    CHECK_EQUAL("two blocks", mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_TRUE("... added", mpm_body_add(&w, &upper) == MPM_OK && mpm_body_add(&w, &lower) == MPM_OK);
    return w;
}

static void find_pairs(mpm_world *w)
{
    mpm_locate(w, step);
    mpm_p2g(w);
    mpm_forces(w);
    mpm_grid_update(w);
    mpm_contact_find(w);
}

static void pairs(mpm_basis basis)
{
    mpm_world w = blocks(basis, 5, -10, MPM_CONTACT_NONE, 0);
    const mpm_totals t0 = mpm_body_totals(&w, -1);
    const double e0 = energy(&w);
    double area = 0, apart = 0, toward = 0;
    int32_t i;
    int d;
    find_pairs(&w);
    mpm_contact_apply(&w); /* no law: nothing */
    for (i = 0; i < w.pairs; i++) {
        mpm_pair *p = &w.pair[i];
        const mpm_node *a = &w.node[p->a], *b = &w.node[p->b];
        mpm_real j[3], approach = mpm_pair_stick(&w, p, j), along = 0;
        for (d = 0; d < 3; d++) along -= j[d] * p->normal[d];
        toward = check_worst(toward, fabs((double)(approach - along)));
        area += mpm_pair_area(&w, p);
        mpm_pair_push(&w, p, j);
        for (d = 0; d < 3; d++) {
            apart = check_worst(apart, fabs((double)(a->momentum[d] / a->mass - b->momentum[d] / b->mass)));
            apart = check_worst(apart, fabs((double)(p->impulse[d] - j[d])));
        }
    }
    CHECK_TRUE("pairs", w.pairs >= 25);
    CHECK_NEAR("... what sticks has one velocity", apart, 0, 1e3 * eps);
    CHECK_NEAR("... the approach is along the normal", toward, 0, 10 * eps);
    CHECK_RELATIVE("... areas of the pairs: the face", area, 16, basis <= MPM_GIMP ? 100 * eps : 0.17);
    mpm_g2p(&w);
    mpm_musl(&w);
    CHECK_NEAR("... momentum stays", mpm_body_totals(&w, -1).momentum[2] / t0.momentum[2], 1, 1e3 * eps);
    CHECK_TRUE("... energy is lost", w.ledger.contact > 0.01 * t0.kinetic);
    CHECK_NEAR("... and none is missing", energy(&w) / e0, 1, 1e3 * eps);
    mpm_free(&w);
}

/* Half of the two blocks: what a push would send through the mirror stays out. */
static void pair_at_mirror(void)
{
    mpm_desc d = scene_grid(1, 6, 12, 12, 0, -6, -6);
    mpm_body_desc b = scene_body(&metal, mpm_box(-2, -2, 0, 2, 2, 3), 0.5, -10);
    const mpm_real j[3] = {1, 2, 3};
    double wrong = 0;
    mpm_world w;
    int32_t i;
    int mirrors = 0;
    d.side[0] = MPM_SIDE_SYMMETRY;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    b.shape = mpm_box(-2, -2, -3, 2, 2, 0);
    mpm_body_add(&w, &b);
    find_pairs(&w);
    for (i = 0; i < w.pairs; i++) {
        const int mirror = w.node[w.pair[i].a].flags & 1;
        mpm_pair_push(&w, &w.pair[i], j);
        mirrors += mirror;
        wrong += fabs((double)w.pair[i].impulse[0] - (mirror ? 0 : 1)) + fabs((double)w.pair[i].impulse[2] - 3);
    }
    CHECK_TRUE("pairs on a mirror", mirrors >= 5);
    CHECK_NEAR("... get nothing through it", wrong, 0, 0);
    mpm_free(&w);
}

/* Coulomb's law once more, as a user writes it. */
static int coulomb(void *context, const mpm_world *w, const mpm_pair *p, mpm_real j[3])
{
    const mpm_real mu = *(const mpm_real *)context, approach = mpm_pair_stick(w, p, j);
    mpm_real along = 0, across = 0, keep;
    int d;
    if (!(approach > 0)) return 0;
    for (d = 0; d < 3; d++) along += j[d] * p->normal[d];
    for (d = 0; d < 3; d++) across += (j[d] - along * p->normal[d]) * (j[d] - along * p->normal[d]);
    across = mpm_sqrt(across);
    keep = across > -mu * along ? -mu * along / across : 1;
    for (d = 0; d < 3; d++) j[d] = along * p->normal[d] + keep * (j[d] - along * p->normal[d]);
    return 1;
}

static void own_law(void)
{
    mpm_world built_in = blocks(MPM_LINEAR, 30, -20, MPM_CONTACT_FRICTION, MPM_R(0.3));
    mpm_world own = blocks(MPM_LINEAR, 30, -20, MPM_CONTACT_NONE, 0);
    mpm_real mu = MPM_R(0.3);
    mpm_contact rule = own.desc.contact;
    int n;
    built_in.desc.scheme = own.desc.scheme = MPM_SCHEME_THESIS; /* laws of the user's act on P(k+1) alone */
    rule.law = MPM_CONTACT_USER;
    CHECK_EQUAL("a user's law without a function", mpm_contact_set(&own, 0, 1, &rule), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(own.fault.field, "contact.fn"));
    rule.fn = coulomb;
    rule.context = &mu;
    CHECK_EQUAL("Coulomb's law as a user's", mpm_contact_set(&own, 0, 1, &rule), MPM_OK);
    for (n = 0; n < 100; n++)
        if (mpm_step(&built_in, step) < 0 || mpm_step(&own, step) < 0) break;
    CHECK_EQUAL("... steps", n, 100);
    CHECK_TRUE("... there is contact", own.ledger.contact > 0);
    CHECK_NEAR("... is the built-in one", velocity_difference(&own, &built_in, 20), 0, 1e4 * eps);
    CHECK_RELATIVE("... in the ledger too", own.ledger.contact, built_in.ledger.contact, 1e4 * eps);
    mpm_free(&built_in);
    mpm_free(&own);
}

/* Two bonded blocks fly apart faster than the bond can bear: it pulls with all its strength, and no more. */
static void strength(mpm_basis basis)
{
    const mpm_units units = mpm_units_um_us_ng();
    mpm_world w = blocks(basis, 0, 40, MPM_CONTACT_FRICTION, 0);
    mpm_bond bond = mpm_bond_default(&units);
    double force, peak = 0, first = 0, area = 0;
    int32_t i;
    int n;
    bond.rule = MPM_BOND_NONE;
    bond.strength = 50; /* MPa */
    for (i = 0; i < w.points.count; i++) w.points.bond[i] = 1;
    for (n = 0; n < 40; n++) {
        if (mpm_bond_step(&bond, &w, step) < 0) break;
        force = mpm_interface_of(&w, 1, 0).impulse[2] / (double)step;
        if (n == 0) first = force;
        if (n == 0)
            for (i = 0; i < w.pairs; i++) area += mpm_pair_area(&w, &w.pair[i]);
        peak = check_worst(peak, force);
    }
    CHECK_EQUAL("a bond of 50 MPa: steps", n, 40);
    CHECK_RELATIVE("... bears its strength times the area of its pairs", first, 50 * area, 1e3 * eps);
    CHECK_RELATIVE("... bears 50 MPa on 16 um2 [uN]", peak, 800, 0.001);
    CHECK_TRUE("... its work is the hold's", w.ledger.hold > 0);
    mpm_free(&w);
}

/* A hold of 1/2 leaves half of the velocity at which two parts of a node fly apart; one with a limit takes no more. */
static void softened(mpm_scheme scheme, mpm_real limit)
{
    mpm_world w = blocks(MPM_LINEAR, 0, 40, MPM_CONTACT_FRICTION, 0);
    double before[64], taken = 0, left = 0;
    int32_t i;
    w.desc.scheme = scheme;
    mpm_locate(&w, step);
    mpm_p2g(&w);
    mpm_forces(&w);
    mpm_grid_update(&w);
    mpm_contact_find(&w);
    CHECK_TRUE("blocks that fly apart share nodes", w.pairs > 9 && w.pairs < 64);
    for (i = 0; i < w.pairs && i < 64; i++) {
        w.pair[i].hold = MPM_R(0.5);
        w.pair[i].limit = limit;
        before[i] = (double)w.node[w.pair[i].a].momentum[2];
    }
    mpm_contact_apply(&w);
    for (i = 0; i < w.pairs && i < 64; i++) {
        const mpm_node *a = &w.node[w.pair[i].a], *b = &w.node[w.pair[i].b];
        taken = check_worst(taken, fabs((double)a->momentum[2] - before[i]) / (double)(limit > 0 ? limit : 1));
        left = check_worst(left, fabs(fabs((double)(a->momentum[2] / a->mass - b->momentum[2] / b->mass)) - 20));
    }
    if (limit > 0) CHECK_NEAR("... as far as it can bear", taken, 1, 1e4 * eps);
    else CHECK_NEAR("... held by half: at half the velocity", left, 0, 20 * 1e3 * eps);
    mpm_free(&w);
}

/* ---- a rule per pair ------------------------------------------------------------------------ */

static mpm_contact rule_of(mpm_contact_law law, mpm_real friction)
{
    mpm_contact c = mpm_desc_default().contact;
    c.law = law;
    c.friction = friction;
    return c;
}

static double mu_of(const mpm_world *w, int32_t a, int32_t b) { return (double)mpm_contact_of(w, a, b)->friction; }

static void wildcards(void)
{
    mpm_desc d = scene_grid(1, 4, 4, 4, 0, 0, 0);
    mpm_contact c = rule_of(MPM_CONTACT_FRICTION, MPM_R(0.125));
    mpm_world w;
    d.rules = 0;
    CHECK_EQUAL("a world without rules", mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_NEAR("... has that of the description", mu_of(&w, 0, 1), 0, 0);
    CHECK_EQUAL("a rule for any with 2", mpm_contact_set(&w, -1, 2, &c), MPM_OK);
    CHECK_TRUE("... holds in any order", mu_of(&w, 0, 2) > 0.1 && mu_of(&w, 2, 0) > 0.1 && mu_of(&w, 2, 1) > 0.1);
    CHECK_NEAR("... and for no others", mu_of(&w, 0, 1), 0, 0);
    c.friction = MPM_R(0.25);
    CHECK_EQUAL("a rule for 2 and 1", mpm_contact_set(&w, 2, 1, &c), MPM_OK);
    CHECK_TRUE("... set last, wins", mu_of(&w, 1, 2) > 0.2 && mu_of(&w, 2, 1) > 0.2 && mu_of(&w, 0, 2) < 0.2);
    c.friction = MPM_R(0.5);
    CHECK_EQUAL("a rule for any two", mpm_contact_set(&w, -1, -1, &c), MPM_OK);
    CHECK_TRUE("... wins everywhere", mu_of(&w, 1, 2) > 0.4 && mu_of(&w, 0, 7) > 0.4);
    c.friction = MPM_R(0.25);
    CHECK_EQUAL("2 and 1 again", mpm_contact_set(&w, 1, 2, &c), MPM_OK);
    CHECK_TRUE("... wins again", mu_of(&w, 1, 2) < 0.3 && mu_of(&w, 0, 2) > 0.4);
    CHECK_EQUAL("... in place of the old one", w.rules, 3);
    c.friction = -1;
    CHECK_EQUAL("a bad rule", mpm_contact_set(&w, 0, 1, &c), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(w.fault.field, "contact.friction"));
    CHECK_EQUAL("... and not kept", w.rules, 3);
    c.friction = 0;
    CHECK_EQUAL("a rule for no body there can be", mpm_contact_set(&w, 0, -2, &c), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... which is named", !strcmp(w.fault.field, "body") && w.fault.value < MPM_R(-1.5));
    CHECK_EQUAL("... nor is that", w.rules, 3);
    mpm_free(&w);
}

/* Two blocks meet one plate aslant: one slides on it, the other sticks. */
static void slide_and_stick(void)
{
    mpm_desc d = scene_grid(1, 16, 8, 10, -8, -4, -5);
    mpm_body_desc b = scene_body(&metal, mpm_box(-6, -2, 0, -2, 2, 3), 0.5, -20);
    mpm_body_desc plate = scene_body(&metal, mpm_box(-7, -3, -3, 7, 3, 0), 0.5, 0);
    const mpm_contact slides = rule_of(MPM_CONTACT_FRICTION, 0), sticks = rule_of(MPM_CONTACT_STICK, 0);
    double before[2], after[2];
    mpm_world w;
    int n;
    b.velocity[0] = 30;
    d.contact.law = MPM_CONTACT_NONE;
    d.contact.normal = MPM_NORMAL_FIXED;
    mpm_init(&w, &d, NULL, 0);
    mpm_contact_set(&w, -1, 2, &slides); /* before there are bodies */
    mpm_contact_set(&w, 2, 1, &sticks);
    w.rule[0].contact.normal = w.rule[1].contact.normal = MPM_NORMAL_FIXED;
    mpm_body_add(&w, &b);
    b.shape = mpm_box(2, -2, 0, 6, 2, 3);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("two blocks on a plate", mpm_body_add(&w, &plate), MPM_OK);
    for (n = 0; n < 2; n++) before[n] = mpm_body_totals(&w, n).momentum[0];
    for (n = 0; n < 20; n++)
        if (mpm_step(&w, step) < 0) break;
    for (n = 0; n < 2; n++) after[n] = mpm_body_totals(&w, n).momentum[0];
    CHECK_NEAR("... the one slides", after[0] / before[0], 1, 1e3 * eps);
    CHECK_TRUE("... the other sticks", after[1] < 0.95 * before[1]);
    CHECK_TRUE("... both are stopped", mpm_body_totals(&w, 0).momentum[2] > -0.99 * 20 / 30 * before[0]);
    mpm_free(&w);
}

/* Logistic normals as the rule of a pair, in a world that has no room for their planes yet. */
static void logistic_later(void)
{
    mpm_desc d = scene_grid(1, 12, 12, 14, -6, -6, -7);
    const mpm_body_desc upper = scene_body(&metal, mpm_sphere(0, 0, MPM_R(2.6), MPM_R(2.5)), 0.5, -60);
    const mpm_body_desc lower = scene_body(&metal, mpm_sphere(1, 0, MPM_R(-2.6), MPM_R(2.5)), 0.5, 0);
    mpm_contact c = d.contact;
    mpm_world start, later;
    int n;
    c.normal = MPM_NORMAL_LOGISTIC;
    c.touch = 1;
    mpm_init(&later, &d, NULL, 0);
    d.contact = c;
    mpm_init(&start, &d, NULL, 0);
    mpm_body_add(&start, &upper);
    mpm_body_add(&start, &lower);
    mpm_body_add(&later, &upper);
    mpm_body_add(&later, &lower);
    CHECK_EQUAL("a logistic rule, set later", mpm_contact_set(&later, 1, 0, &c), MPM_OK);
    for (n = 0; n < 300; n++)
        if (mpm_step(&start, step) < 0 || mpm_step(&later, step) < 0) break;
    CHECK_EQUAL("... steps", n, 300);
    CHECK_TRUE("... they have met", start.ledger.contact > 0);
    CHECK_TRUE("... is the same as from the start", same_bits(&start, &later));
    mpm_free(&start);
    mpm_free(&later);
}

/* Memory of the caller's does not grow: what does not fit is refused. */
static void given_memory(void)
{
    mpm_desc d = scene_grid(1, 4, 4, 4, 0, 0, 0);
    const mpm_body_desc b = scene_body(&metal, mpm_box(1, 1, 1, 3, 3, 3), 0.5, 0);
    const mpm_contact plain = rule_of(MPM_CONTACT_STICK, 0);
    mpm_contact logistic = plain;
    mpm_world w;
    size_t bytes;
    void *block;
    logistic.normal = MPM_NORMAL_LOGISTIC;
    d.rules = 1;
    d.bodies = 1;
    d.points = 64;
    d.user_fields = 1;
    bytes = mpm_bytes(&d);
    block = malloc(bytes);
    CHECK_EQUAL("memory of the caller's", mpm_init(&w, &d, block, bytes), MPM_OK);
    CHECK_EQUAL("... no room for logistic normals", mpm_contact_set(&w, 0, 1, &logistic), MPM_ERR_FULL);
    CHECK_TRUE("... is told", !strcmp(w.fault.field, "planes of logistic normals"));
    CHECK_EQUAL("... room for a rule", mpm_contact_set(&w, 0, 1, &plain), MPM_OK);
    CHECK_EQUAL("... which may be set again", mpm_contact_set(&w, 1, 0, &plain), MPM_OK);
    CHECK_EQUAL("... not for two", mpm_contact_set(&w, 0, 2, &plain), MPM_ERR_FULL);
    CHECK_TRUE("... is told", !strcmp(w.fault.field, "rules"));
    CHECK_EQUAL("... room for a field", mpm_field_take(&w, "one"), 0);
    CHECK_EQUAL("... not for two", mpm_field_take(&w, "two"), -1);
    CHECK_EQUAL("... room for a body", mpm_body_add(&w, &b), MPM_OK);
    CHECK_EQUAL("... not for two", mpm_body_add(&w, &b), MPM_ERR_OVERLAP);
    w.body[0].desc.shape.kind = MPM_SHAPE_NONE;
    mpm_free(&w);
    free(block);
}

/* ---- shapes of the user's --------------------------------------------------------------------- */

typedef struct sphere { mpm_real x, y, z, radius; } sphere;

static int in_sphere(void *context, const mpm_real at[3])
{
    const sphere *s = (const sphere *)context;
    const mpm_real x = (at[0] - s->x) / s->radius, y = (at[1] - s->y) / s->radius, z = (at[2] - s->z) / s->radius;
    return x * x + y * y + z * z <= 1;
}

static int everywhere(void *context, const mpm_real at[3])
{
    (void)context;
    (void)at;
    return 1;
}

/* Points, and points whose surface flag is another, of two worlds with one body each. */
static void compare_shape(mpm_geometry geometry, mpm_shape built_in, mpm_shape own, const char *name)
{
    mpm_desc d = scene_grid(1, 12, 12, 12, 0, 0, 0);
    mpm_body_desc b = scene_body(&metal, built_in, 0.5, 0);
    mpm_world w[2];
    int32_t i;
    double far = 0;
    long differ = 0, surface = 0;
    int k, a;
    d.geometry = geometry;
    for (k = 0; k < 2; k++) {
        if (k) b.shape = own;
        mpm_init(&w[k], &d, NULL, 0);
        CHECK_EQUAL(name, mpm_body_add(&w[k], &b), MPM_OK);
    }
    CHECK_EQUAL("... as many points", w[1].points.count, w[0].points.count);
    for (i = 0; i < w[0].points.count && i < w[1].points.count; i++) {
        for (a = 0; a < 3; a++) far = check_worst(far, fabs((double)w[0].points.x[a][i] - (double)w[1].points.x[a][i]));
        surface += w[0].points.flags[i] & MPM_POINT_SURFACE;
        differ += (w[0].points.flags[i] & MPM_POINT_SURFACE) != (w[1].points.flags[i] & MPM_POINT_SURFACE);
    }
    CHECK_NEAR("... in the same places", far, 0, 16 * eps);
    CHECK_TRUE("... there is a surface", surface > 20);
    CHECK_EQUAL("... of the same points", differ, 0);
    for (k = 0; k < 2; k++) mpm_free(&w[k]);
}

static void own_shapes(void)
{
    static sphere s;
    const mpm_real low[3] = {2, 2, 2}, high[3] = {10, 10, 10}, flat_low[3] = {2, -4, 2}, flat_high[3] = {10, 4, 10};
    s.x = s.y = s.z = 6;
    s.radius = 4;
    compare_shape(MPM_3D, mpm_sphere(6, 6, 6, 4), mpm_shape_user(in_sphere, &s, low, high),
                  "a sphere of one's own");
    compare_shape(MPM_3D, mpm_box(2, 2, 2, 10, 10, 10), mpm_shape_user(everywhere, NULL, low, high),
                  "a box of one's own");
    s.y = 0;
    compare_shape(MPM_PLANE_STRAIN, mpm_sphere(6, 0, 6, 4), mpm_shape_user(in_sphere, &s, flat_low, flat_high),
                  "a disk of one's own");
}

/* ---- bodies from points ------------------------------------------------------------------------ */

enum { MANY = 40 };

/* A cloud of MANY points in rows, each of another mass, volume, velocity and flag. */
typedef struct rows { mpm_real x[3][MANY], v[3][MANY], mass[MANY], volume[MANY]; uint8_t flags[MANY]; } rows;

static mpm_cloud rows_of(rows *r, mpm_real z)
{
    mpm_cloud c;
    int i, d;
    memset(&c, 0, sizeof c);
    c.count = MANY;
    for (i = 0; i < MANY; i++) {
        r->x[0][i] = MPM_R(2.25) + MPM_R(0.5) * (mpm_real)(i % 4);
        r->x[1][i] = MPM_R(2.25) + MPM_R(0.5) * (mpm_real)(i / 4 % 5);
        r->x[2][i] = z + MPM_R(0.5) * (mpm_real)(i / 20);
        r->mass[i] = MPM_R(0.25) + (mpm_real)i / 64;
        r->volume[i] = MPM_R(0.0625) + (mpm_real)i / 1024;
        r->flags[i] = (uint8_t)(i % 2 ? MPM_POINT_SURFACE : 0);
        for (d = 0; d < 3; d++) r->v[d][i] = (mpm_real)(d * 3 + i % 7);
    }
    for (d = 0; d < 3; d++) c.x[d] = r->x[d];
    return c;
}

static mpm_world empty_world(mpm_geometry geometry)
{
    mpm_desc d = mpm_desc_default();
    mpm_world w;
    d.geometry = geometry;
    d.cell = 1;
    d.cells[0] = d.cells[1] = d.cells[2] = 10;
    CHECK_EQUAL("a world with room for nothing", mpm_init(&w, &d, NULL, 0), MPM_OK);
    return w;
}

/* The cloud's entries are those of the points. */
static void given(void)
{
    static rows r;
    mpm_world w = empty_world(MPM_3D);
    mpm_cloud c = rows_of(&r, MPM_R(2.25));
    mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, 0, 1, 1, 1), 0.5, -3);
    double mass = 0, wrong = 0;
    int i, d;
    b.id = 100;
    c.v[0] = r.v[0], c.v[1] = r.v[1], c.v[2] = r.v[2];
    c.mass = r.mass;
    c.flags = r.flags;
    CHECK_EQUAL("a body from points with masses", mpm_body_add_points(&w, &b, &c), MPM_OK);
    for (i = 0; i < MANY; i++) {
        const int32_t at = find(&w, 100 + i);
        mass += (double)r.mass[i];
        if (at < 0) { wrong = 1e9; break; }
        for (d = 0; d < 3; d++) {
            wrong += fabs((double)(w.points.x[d][at] - r.x[d][i]));
            wrong += fabs((double)(w.points.v[d][at] - r.v[d][i]));
        }
        wrong += fabs((double)(w.points.mass[at] - r.mass[i])) + (w.points.flags[at] != r.flags[i]);
    }
    CHECK_NEAR("... places, velocities, masses, flags, ids as given", wrong, 0, 0);
    CHECK_RELATIVE("... mass", mpm_body_totals(&w, 0).mass, mass, 10 * eps);
    CHECK_RELATIVE("... a mean point's", w.body[0].point_mass, mass / MANY, 10 * eps);
    c = rows_of(&r, MPM_R(5.25));
    c.volume = r.volume;
    b.id = -1;
    CHECK_EQUAL("another with volumes", mpm_body_add_points(&w, &b, &c), MPM_OK);
    CHECK_EQUAL("... goes on counting", find(&w, 100 + 2 * MANY - 1) >= MANY, 1);
    for (mass = 0, i = 0; i < MANY; i++) mass += (double)r.volume[i];
    CHECK_RELATIVE("... mass: volumes times density", mpm_body_totals(&w, 1).mass, mass * 0.0027, 10 * eps);
    CHECK_NEAR("... velocity of the body", mpm_body_totals(&w, 1).momentum[2], -3 * mass * 0.0027, eps * mass);
    c = rows_of(&r, MPM_R(8.25));
    b.id = 2147483647;
    CHECK_EQUAL("numbers that run out", mpm_body_add_points(&w, &b, &c), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... are named", !strcmp(w.fault.field, "id") && w.bodies == 2);
    b.id = -1;
    CHECK_EQUAL("a third of places alone", mpm_body_add_points(&w, &b, &c), MPM_OK);
    CHECK_RELATIVE("... mass: cubes of the spacing", mpm_body_totals(&w, 2).mass, MANY * 0.125 * 0.0027, 10 * eps);
    CHECK_EQUAL("a step", mpm_step(&w, step), MPM_OK);
    mpm_free(&w);
}

/* Mass and volume both say the density. */
static void both_given(void)
{
    static rows r;
    mpm_world w = empty_world(MPM_3D);
    mpm_cloud c = rows_of(&r, MPM_R(2.25));
    const mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, 0, 1, 1, 1), 0.5, 0);
    int32_t at;
    c.mass = r.mass;
    c.volume = r.volume;
    CHECK_EQUAL("points with masses and volumes", mpm_body_add_points(&w, &b, &c), MPM_OK);
    at = find(&w, 7);
    CHECK_RELATIVE("... density is the one over the other", w.points.density[at], r.mass[7] / r.volume[7], 4 * eps);
    mpm_free(&w);
}

/* In two dimensions y is left out, and rings weigh with their radius. */
static void given_flat(void)
{
    static rows r;
    mpm_world w = empty_world(MPM_AXISYMMETRIC);
    mpm_cloud c = rows_of(&r, MPM_R(2.25));
    const mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, 0, 1, 1, 1), 0.5, 0);
    c.count = 4;
    c.x[1] = NULL;
    CHECK_EQUAL("rings from points", mpm_body_add_points(&w, &b, &c), MPM_OK);
    CHECK_RELATIVE("... mass", mpm_body_totals(&w, 0).mass,
                   0.0027 * 0.25 * 2 * 3.14159265358979324 * (2.25 + 2.75 + 3.25 + 3.75), 20 * eps);
    CHECK_EQUAL("... a step", mpm_step(&w, step), MPM_OK);
    r.x[0][2] = 0;
    c.x[2] = r.v[1];
    CHECK_EQUAL("a ring at radius 0", mpm_body_add_points(&w, &b, &c), MPM_ERR_OUTSIDE);
    CHECK_EQUAL("... is named", w.fault.index, 2);
    mpm_free(&w);
}

static void refuses(mpm_world *w, const mpm_body_desc *b, const mpm_cloud *c, mpm_status status, const char *field,
                    long index)
{
    char line[120];
    snprintf(line, sizeof line, "refused: %s", field);
    CHECK_EQUAL(line, mpm_body_add_points(w, b, c), status);
    CHECK_TRUE("... is named", w->fault.field && !strcmp(w->fault.field, field));
    CHECK_EQUAL("... with its number", w->fault.index, index);
    CHECK_EQUAL("... the world is as it was", w->points.count + 1000 * w->bodies + 100000 * w->next_id, 0);
}

static void bad_points(void)
{
    static rows r;
    mpm_world w = empty_world(MPM_3D);
    const mpm_real nan = (mpm_real)strtod("nan", NULL);
    mpm_cloud c = rows_of(&r, MPM_R(2.25));
    mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, 0, 1, 1, 1), 0.5, 0);
    c.count = 0;
    refuses(&w, &b, &c, MPM_ERR_ARGUMENT, "points", -1);
    c = rows_of(&r, MPM_R(2.25));
    c.x[1] = NULL;
    refuses(&w, &b, &c, MPM_ERR_ARGUMENT, "x (missing)", 1);
    c = rows_of(&r, MPM_R(2.25));
    r.x[1][5] = nan;
    refuses(&w, &b, &c, MPM_ERR_NAN, "x of a point", 5);
    c = rows_of(&r, MPM_R(2.25));
    r.x[1][6] = 10;
    refuses(&w, &b, &c, MPM_ERR_OUTSIDE, "y of a point", 6);
    c = rows_of(&r, MPM_R(2.25));
    c.v[2] = r.v[2];
    r.v[2][39] = nan;
    refuses(&w, &b, &c, MPM_ERR_NAN, "v of a point", 39);
    c = rows_of(&r, MPM_R(2.25));
    c.mass = r.mass;
    r.mass[3] = 0;
    refuses(&w, &b, &c, MPM_ERR_ARGUMENT, "mass of a point", 3);
    c = rows_of(&r, MPM_R(2.25));
    c.volume = r.volume;
    r.volume[4] = -1;
    refuses(&w, &b, &c, MPM_ERR_ARGUMENT, "volume of a point", 4);
    c = rows_of(&r, MPM_R(2.25));
    b.absorb = MPM_FACE_BOTTOM;
    refuses(&w, &b, &c, MPM_ERR_ARGUMENT, "absorb (a face the body has not)", -1);
    b.absorb = 0;
    b.mark = 0;
    refuses(&w, &b, &c, MPM_ERR_ARGUMENT, "body (not from mpm_body_desc_default)", -1);
    b.mark = MPM_MARK;
    b.shape = mpm_box(3, 3, 0, 6, 6, 5);
    CHECK_EQUAL("a box", mpm_body_add(&w, &b), MPM_OK);
    CHECK_EQUAL("points in it", mpm_body_add_points(&w, &b, &c), MPM_ERR_OVERLAP);
    CHECK_EQUAL("... name the body", w.fault.index, 0);
    mpm_free(&w);
}

/* ---- points that come and go ------------------------------------------------------------------- */

/* Bodies lie behind each other, every id once. */
static int in_order(const mpm_world *w)
{
    int32_t b, i, at = 0;
    int ok = 1;
    for (b = 0; b < w->bodies; at += w->body[b++].count)
        ok &= w->body[b].first == at && w->body[b].active <= w->body[b].count && w->body[b].active >= 0;
    for (i = 0; i < w->points.count; i++) ok &= find(w, w->points.id[i]) == i;
    return ok && at == w->points.count;
}

/* Three cubes in a row; the middle one and the last have lost points through the open side. */
static mpm_world three(void)
{
    mpm_world w = empty_world(MPM_3D);
    mpm_body_desc b = scene_body(&metal, mpm_box(1, 1, 1, 3, 3, 3), 0.5, 0);
    int k, i;
    for (k = 0; k < 3; k++) {
        b.shape = mpm_box(1, 1, (mpm_real)(1 + 3 * k), 3, 3, (mpm_real)(3 + 3 * k));
        b.velocity[0] = (mpm_real)(1 + k);
        CHECK_EQUAL("a cube of 64 points", mpm_body_add(&w, &b), MPM_OK);
    }
    for (i = 0; i < 5; i++) w.points.x[0][w.body[1].first + 7 * i] = -1;
    for (i = 0; i < 3; i++) w.points.x[0][w.body[2].first + 9 * i] = 11;
    CHECK_EQUAL("... eight of them leave", mpm_locate(&w, step), MPM_RETIRED);
    CHECK_EQUAL("... are counted", mpm_body_totals(&w, -1).retired, 8);
    return w;
}

/* Takes the point of an id: every other one of all bodies is as it was. */
static void take(mpm_world *w, int32_t body, int32_t i)
{
    static double before[200][3];
    const mpm_totals t = mpm_body_totals(w, -1), of_body = mpm_body_totals(w, body);
    const double m = (double)w->points.mass[i], p = m * (double)w->points.v[0][i];
    const int32_t id = w->points.id[i];
    int32_t k;
    int kept = 1;
    for (k = 0; k < w->points.count; k++) {
        double *is = before[w->points.id[k]];
        is[0] = (double)w->points.x[2][k];
        is[1] = (double)w->points.v[0][k];
        is[2] = (double)w->points.mass[k];
    }
    CHECK_EQUAL("a point is taken", mpm_point_take(w, i), MPM_OK);
    for (k = 0; k < w->points.count; k++) {
        const double *was = before[w->points.id[k]];
        kept &= was[0] == (double)w->points.x[2][k] && was[1] == (double)w->points.v[0][k];
        kept &= was[2] == (double)w->points.mass[k];
    }
    CHECK_TRUE("... it is gone, the others are as they were", find(w, id) < 0 && kept);
    CHECK_TRUE("... bodies stand behind each other", in_order(w));
    CHECK_NEAR("... mass", mpm_body_totals(w, -1).mass, t.mass - m, 10 * eps * t.mass);
    CHECK_NEAR("... momentum", mpm_body_totals(w, -1).momentum[0], t.momentum[0] - p, 10 * eps * t.momentum[0]);
    CHECK_EQUAL("... of this body", mpm_body_totals(w, body).points, of_body.points - 1);
}

static void come_and_go(void)
{
    static rows r;
    mpm_world w = three();
    mpm_cloud c = rows_of(&r, MPM_R(3.5));
    const int32_t before = w.points.count;
    mpm_totals t;
    int i, active[3];
    for (i = 0; i < 3; i++) active[i] = w.body[i].active;
    take(&w, 1, w.body[1].first + 3);
    take(&w, 1, w.body[1].first + w.body[1].count - 1); /* a retired one */
    take(&w, 0, 0);
    take(&w, 2, w.points.count - 1);
    CHECK_TRUE("active points are counted", w.body[0].active == active[0] - 1 && w.body[1].active == active[1] - 1 &&
                                                w.body[2].active == active[2]);
    CHECK_EQUAL("there is no such point", mpm_point_take(&w, w.points.count), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... nor this one", mpm_point_take(&w, -1), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("there is no such body", mpm_points_add(&w, 3, &c), MPM_ERR_ARGUMENT);
    c.count = 16;
    c.v[0] = r.v[0], c.v[1] = r.v[1], c.v[2] = r.v[2];
    c.mass = r.mass;
    t = mpm_body_totals(&w, 1);
    CHECK_EQUAL("points for the middle body", mpm_points_add(&w, 1, &c), MPM_OK);
    for (i = 0; i < 16; i++) t.mass += (double)r.mass[i], t.momentum[2] += (double)(r.mass[i] * r.v[2][i]);
    CHECK_EQUAL("... are there", w.points.count, before - 4 + 16);
    CHECK_TRUE("... bodies stand behind each other", in_order(&w));
    CHECK_RELATIVE("... mass", mpm_body_totals(&w, 1).mass, t.mass, 10 * eps);
    CHECK_RELATIVE("... momentum", mpm_body_totals(&w, 1).momentum[2], t.momentum[2], 10 * eps);
    CHECK_RELATIVE("... a mean point's mass", w.body[1].point_mass, t.mass / w.body[1].count, 10 * eps);
    CHECK_EQUAL("... with new numbers", find(&w, 3 * 64 + 15) >= w.body[1].first, 1);
    r.x[2][2] = 20;
    CHECK_EQUAL("points outside the grid", mpm_points_add(&w, 1, &c), MPM_ERR_OUTSIDE);
    CHECK_EQUAL("... change nothing", w.points.count, before - 4 + 16);
    CHECK_EQUAL("the run goes on", mpm_step(&w, step), MPM_OK);
    while (w.body[0].count > 0) mpm_point_take(&w, w.body[0].first);
    CHECK_EQUAL("... with an empty body too", mpm_step(&w, step), MPM_OK);
    CHECK_TRUE("... bodies stand behind each other", in_order(&w));
    c = rows_of(&r, MPM_R(1.25));
    CHECK_EQUAL("... which is filled again", mpm_points_add(&w, 0, &c), MPM_OK);
    CHECK_EQUAL("... and steps", mpm_step(&w, step), MPM_OK);
    CHECK_TRUE("... in order", in_order(&w) && w.body[0].count == MANY);
    mpm_free(&w);
}

/* Half of a ball's points are added later, one is taken and put back: the same run as the whole ball's. */
static void in_parts(void)
{
    mpm_desc d = scene_grid(1, 10, 10, 14, 0, 0, 0);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(5, 5, 7, 2), 0.5, -50);
    const mpm_body_desc plate = scene_body(&metal, mpm_box(1, 1, 1, 9, 9, 4), 0.5, 0);
    mpm_real *x[3];
    mpm_world whole, parts;
    mpm_cloud c;
    int32_t i, n;
    int a;
    memset(&c, 0, sizeof c);
    mpm_init(&whole, &d, NULL, 0);
    mpm_body_add(&whole, &b);
    n = whole.points.count;
    for (a = 0; a < 3; a++) {
        x[a] = (mpm_real *)malloc((size_t)n * sizeof **x);
        memcpy(x[a], whole.points.x[a], (size_t)n * sizeof **x);
        c.x[a] = x[a];
    }
    mpm_body_add(&whole, &plate);
    d.points = d.bodies = 0;
    mpm_init(&parts, &d, NULL, 0);
    c.count = n / 2;
    CHECK_EQUAL("half a ball from points", mpm_body_add_points(&parts, &b, &c), MPM_OK);
    mpm_body_add(&parts, &plate);
    for (a = 0; a < 3; a++) c.x[a] = x[a] + c.count;
    c.count = n - c.count;
    CHECK_EQUAL("... and the other half", mpm_points_add(&parts, 0, &c), MPM_OK);
    i = parts.body[0].first + 11;
    for (a = 0; a < 3; a++) {
        x[a][0] = parts.points.x[a][i];
        c.x[a] = x[a];
    }
    c.count = 1;
    CHECK_EQUAL("... a point is taken", mpm_point_take(&parts, i), MPM_OK);
    CHECK_EQUAL("... and put back", mpm_points_add(&parts, 0, &c), MPM_OK);
    CHECK_RELATIVE("... mass", mpm_body_totals(&parts, 0).mass, mpm_body_totals(&whole, 0).mass, 10 * eps);
    for (i = 0; i < 300; i++)
        if (mpm_step(&whole, step) < 0 || mpm_step(&parts, step) < 0) break;
    CHECK_EQUAL("... steps", i, 300);
    CHECK_TRUE("... they have hit the plate", whole.ledger.contact < 0 || whole.ledger.contact > 0);
    for (a = 0; a < 3; a++) free(x[a]);
    for (a = 0; a < 2; a++)
        CHECK_NEAR("... momentum as the whole ball's", mpm_body_totals(&parts, a).momentum[2],
                   mpm_body_totals(&whole, a).momentum[2], 1e5 * eps * mpm_body_totals(&whole, 0).mass * 50);
    CHECK_RELATIVE("... energy as the whole ball's", mpm_body_totals(&parts, -1).internal,
                   mpm_body_totals(&whole, -1).internal, 1e6 * eps);
    mpm_free(&whole);
    mpm_free(&parts);
}

/* A body joins where another one was: only what is there now is in its way. */
static void joins_later(void)
{
    mpm_world w = empty_world(MPM_3D);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(2, 2, 7, MPM_R(1.5)), 0.5, -100);
    int n;
    b.velocity[0] = 100;
    b.stress = NULL;
    CHECK_EQUAL("a ball", mpm_body_add(&w, &b), MPM_OK);
    for (n = 0; n < 40; n++) mpm_step(&w, MPM_R(1e-3));
    CHECK_NEAR("... has flown 4 um down", mpm_body_totals(&w, 0).low[2], 7 - 1.25 - 4, 1e4 * eps);
    CHECK_EQUAL("another is added where it was", mpm_body_add(&w, &b), MPM_OK);
    b.shape = mpm_sphere(6, 2, 3, 1);
    CHECK_EQUAL("... but not where it is", mpm_body_add(&w, &b), MPM_ERR_OVERLAP);
    for (n = 0; n < 15; n++) mpm_step(&w, MPM_R(1e-3));
    w.points.x[2][w.body[0].first] = -1;
    b.shape = mpm_sphere(2, 7, 7, MPM_R(1.5));
    CHECK_EQUAL("... a point that has just left does no harm", mpm_body_add(&w, &b), MPM_OK);
    CHECK_EQUAL("... it is retired", w.retired, 1);
    mpm_free(&w);
}

/* ---- growth, fields, refusals ------------------------------------------------------------------- */

/* Two balls and a plate, once with room for all from the start, once with none; fields taken in between. */
static mpm_world scene_of_three(int tiny, int *ok)
{
    mpm_desc d = scene_grid(1, 12, 12, 16, -6, -6, -8);
    const mpm_real low[3] = {MPM_R(-1.5), MPM_R(-1.5), 1}, high[3] = {MPM_R(1.5), MPM_R(1.5), 4};
    const mpm_contact stick = rule_of(MPM_CONTACT_STICK, 0);
    mpm_body_desc b = scene_body(&metal, mpm_shape_user(everywhere, NULL, low, high), 0.5, -80);
    mpm_world w;
    if (tiny) d.points = d.bodies = d.rules = d.nodes = 0;
    else d.points = 20000, d.bodies = 8, d.rules = 8, d.nodes = 20000;
    d.user_fields = tiny ? 0 : 3;
    *ok = mpm_init(&w, &d, NULL, 0) == MPM_OK && mpm_body_add(&w, &b) == MPM_OK;
    *ok &= mpm_field_take(&w, "first") == 0;
    b.shape = mpm_sphere(0, 0, MPM_R(6.25), MPM_R(1.5));
    *ok &= mpm_body_add(&w, &b) == MPM_OK && mpm_contact_set(&w, 0, -1, &stick) == MPM_OK;
    b.shape = mpm_box(-4, -4, -4, 4, 4, MPM_R(0.5));
    b.velocity[2] = 0;
    *ok &= mpm_body_add(&w, &b) == MPM_OK && mpm_field_take(&w, "second") == 1 && mpm_field_take(&w, "third") == 2;
    return w;
}

static void growth(void)
{
    int ok[2], n;
    mpm_world tiny = scene_of_three(1, &ok[0]), large = scene_of_three(0, &ok[1]);
    CHECK_TRUE("a world that grows, and one that need not", ok[0] && ok[1]);
    CHECK_TRUE("... of different sizes", mpm_bytes_used(&tiny) < mpm_bytes_used(&large));
    for (n = 0; n < 300; n++)
        if (mpm_step(&tiny, step) < 0 || mpm_step(&large, step) < 0) break;
    CHECK_EQUAL("... steps", n, 300);
    CHECK_TRUE("... end with the same bits", same_bits(&tiny, &large));
    CHECK_TRUE("... and ledger", !memcmp(&tiny.ledger, &large.ledger, sizeof tiny.ledger));
    CHECK_TRUE("... they have met", fabs(tiny.ledger.contact) > 1);
    mpm_free(&tiny);
    mpm_free(&large);
}

static void fields(void)
{
    static const char *const name[MPM_USER_FIELDS] = {"a", "b", "c", "d", "e", "f", "g", "h"};
    mpm_world w = empty_world(MPM_3D);
    mpm_body_desc b = scene_body(&metal, mpm_box(1, 1, 1, 3, 3, 3), 0.5, 0);
    int f, right = 1;
    int32_t i;
    CHECK_EQUAL("a cube", mpm_body_add(&w, &b), MPM_OK);
    for (f = 0; f < MPM_USER_FIELDS; f++) {
        right &= mpm_field_take(&w, name[f]) == f;
        for (i = 0; i < w.points.count; i++) {
            right &= !(w.points.user[f][i] > 0 || w.points.user[f][i] < 0);
            w.points.user[f][i] = (mpm_real)(100 * f + w.points.id[i]);
        }
    }
    CHECK_TRUE("fields by name: eight, 0 in all points", right);
    CHECK_EQUAL("... a ninth: none", mpm_field_take(&w, "i"), -1);
    CHECK_EQUAL("... the same again", mpm_field_take(&w, "c"), 2);
    b.shape = mpm_box(5, 5, 5, 8, 8, 8);
    CHECK_EQUAL("... the arrays grow", mpm_body_add(&w, &b), MPM_OK);
    for (i = 0; i < w.points.count; i++)
        for (f = 0; f < MPM_USER_FIELDS; f++) {
            const int32_t id = w.points.id[i];
            right &= w.points.user[f][i] == (mpm_real)(id < 64 ? 100 * f + id : 0);
        }
    CHECK_TRUE("... and keep their values", right);
    mpm_free(&w);
}

static void refusals(void)
{
    mpm_world w = ball(MPM_3D, MPM_LINEAR, MPM_SIDE_OPEN, 1), twin = ball(MPM_3D, MPM_LINEAR, MPM_SIDE_OPEN, 1);
    const mpm_real bad[4] = {0, -1, (mpm_real)strtod("nan", NULL), (mpm_real)HUGE_VAL};
    mpm_desc d = mpm_desc_default();
    int i;
    for (i = 0; i < 4; i++) {
        CHECK_EQUAL("a step that is none", mpm_locate(&w, bad[i]), i < 2 ? MPM_ERR_ARGUMENT : MPM_ERR_NAN);
        CHECK_TRUE("... is named", !strcmp(w.fault.field, "dt"));
        CHECK_TRUE("... by mpm_step too", mpm_step(&w, bad[i]) < 0);
    }
    CHECK_TRUE("... points and time are as they were", same_bits(&w, &twin) && !(w.time > 0) && w.steps == 0);
    mpm_free(&w);
    d.cell = 1;
    d.mark = 0;
    CHECK_EQUAL("a description without its mark", mpm_init(&w, &d, NULL, 0), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(w.fault.field, "desc (not from mpm_desc_default)"));
    mpm_free(&w);
    mpm_free(&twin);
}

int main(void)
{
    static const mpm_geometry geometry[3] = {MPM_3D, MPM_PLANE_STRAIN, MPM_AXISYMMETRIC};
    static const mpm_side floor[3] = {MPM_SIDE_SYMMETRY, MPM_SIDE_FIXED, MPM_SIDE_WALL};
    int g, k;
    metal = scene_metal(1, mpm_units_um_us_ng());
    for (g = 0; g < MPM_BASES; g++) {
        const mpm_basis basis = (mpm_basis)g;
        for (k = 0; k < 3; k++) supports(geometry[k], basis, scene_basis(basis));
        body_force(MPM_3D, basis, MPM_SIDE_OPEN);
        body_force(MPM_3D, basis, MPM_SIDE_FIXED);
        body_force(MPM_3D, basis, MPM_SIDE_WALL);
        for (k = 0; k < 6; k++) outer_force(geometry[k / 2], basis, MPM_SIDE_OPEN, k % 2);
        for (k = 0; k < 3; k++) outer_force(MPM_3D, basis, floor[k], 0);
        mapped(basis);
        pairs(basis);
        if (basis <= MPM_GIMP) strength(basis);
    }
    for (k = 0; k < MPM_SCHEMES; k++) {
        softened((mpm_scheme)k, 0);
        softened((mpm_scheme)k, MPM_R(1e-3));
    }
    node_push();
    pair_at_mirror();
    own_law();
    wildcards();
    slide_and_stick();
    logistic_later();
    given_memory();
    own_shapes();
    given();
    both_given();
    given_flat();
    bad_points();
    come_and_go();
    in_parts();
    joins_later();
    growth();
    fields();
    refusals();
    return check_end();
}
