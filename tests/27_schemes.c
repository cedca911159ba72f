/* 27_schemes - contact and walls in the consistent scheme: no rebound faster than the impact, energy accounted for,
   nothing depends on how bodies are numbered, welds are one body, and bonds hold in both directions.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

static const double eps = (double)MPM_EPSILON;

/* What round-off may leave after hundreds of steps: of double, and of float, whose numbers of 7 digits leave no room
   for the same multiple of epsilon. */
static double roundoff(double of_double, double of_float) { return sizeof(mpm_real) == 8 ? of_double : of_float; }

/* ---- rebound ------------------------------------------------------------------------------- */

typedef struct rebound {
    double ratio, energy; /* speed after over before; what the ledger misses, over the kinetic energy before */
} rebound;

enum { WALL, MIRROR, BAR };

/* An elastic bar of 10 cells, or a disk as wide, thrown at a wall, at its own mirror image, or at an equal bar. */
static rebound thrown(int at, int round, mpm_basis basis, double speed, double factor)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, round ? 7 : 2, 1, 40, 0, 0, at == BAR ? -20 : 0);
    const mpm_real wide = round ? 5 : 2;
    mpm_body_desc b = scene_body(&m, mpm_box(0, 0, 1, wide, 1, 11), 0.5, -speed);
    mpm_totals before, t;
    rebound r;
    mpm_world w;
    mpm_real dt;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = basis;
    d.side[0] = MPM_SIDE_SYMMETRY;
    if (!round) d.side[1] = MPM_SIDE_SYMMETRY;
    d.side[4] = at == WALL ? MPM_SIDE_WALL : at == MIRROR ? MPM_SIDE_SYMMETRY : MPM_SIDE_OPEN;
    if (round) b.shape = mpm_ellipsoid(0, 0, 6, 5, 5, 5);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    if (at == BAR) {
        b.shape.center[2] = -b.shape.center[2];
        b.velocity[2] = (mpm_real)speed;
        mpm_body_add(&w, &b);
    }
    before = mpm_body_totals(&w, 0);
    dt = mpm_time_step(&w, (mpm_real)factor);
    while ((double)w.time < 1.6 / speed + 40 / (double)b.wave_p)
        if (mpm_step(&w, dt) < 0) break;
    t = mpm_body_totals(&w, 0);
    r.ratio = -t.momentum[2] / before.momentum[2];
    r.energy = mpm_body_totals(&w, -1).kinetic + mpm_body_totals(&w, -1).internal + w.ledger.walls + w.ledger.contact;
    r.energy = r.energy / (before.kinetic * (at == BAR ? 2 : 1)) - 1;
    mpm_free(&w);
    return r;
}

/* Walls and bars beside a mirror, whose only error is that of the stress work. Splines let bodies meet two cells apart
   and lose what the gap takes, and stick to a mirror as to themselves. */
static void rebounds(mpm_basis basis, double speed, double factor)
{
    static const char *const name[] = {"wall", "mirror", "bar"};
    const rebound mirror = thrown(MIRROR, 0, basis, speed, factor);
    int at;
    for (at = WALL; at <= BAR; at += BAR - WALL) {
        const rebound r = thrown(at, 0, basis, speed, factor);
        char line[120];
        snprintf(line, sizeof line, "%s on a %s, %g m/s, dt %g", scene_basis(basis), name[at], speed, factor);
        printf("# %s: %.4f of the speed back (mirror %.4f), energy missed %.4f (%.4f)\n", line, r.ratio, mirror.ratio,
               r.energy, mirror.energy);
        CHECK_TRUE(line, r.ratio <= 1 && r.ratio > (basis <= MPM_GIMP ? 0.9 * mirror.ratio : 0.59));
        CHECK_NEAR("... energy", r.energy, 0, 0.005 + fabs(mirror.energy));
    }
}

static void disks(mpm_basis basis)
{
    int at;
    for (at = WALL; at <= BAR; at += BAR - WALL) {
        const rebound r = thrown(at, 1, basis, 100, 0.3);
        printf("# disk on a %s: %.4f of the speed back, energy missed %.4f\n", at == WALL ? "wall" : "disk", r.ratio,
               r.energy);
        CHECK_TRUE("a disk is not faster after than before", r.ratio <= 1 && r.ratio > 0.8);
        CHECK_NEAR("... energy", r.energy, 0, 0.005);
    }
}

/* ---- three bodies at a node ------------------------------------------------------------------ */

/* The six orders in which three bodies are added, and the normals that treat the two bodies of a pair alike. */
static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
static const mpm_normal_rule alike[3] = {MPM_NORMAL_AVERAGE, MPM_NORMAL_LOGISTIC, MPM_NORMAL_MVG};
static const char *const alike_name[3] = {"average", "logistic", "mvg"};

enum { FOIL, RIM, STEPS = 150 };

/* A foil one cell thick between two blocks that close on it; or a substrate, a splat on it, and a disk that is squeezed
   into the corner at the splat's rim. */
static mpm_body_desc one_of_three(int scene, int k, mpm_material *m)
{
    const mpm_real half = MPM_R(0.5);
    mpm_body_desc b = scene_body(m, mpm_box(-3, 0, -half, 3, 1, half), 0.5, 0);
    if (scene == FOIL && k != 1) {
        b.shape = k == 0 ? mpm_box(-3, 0, MPM_R(-5.5), 3, 1, -half) : mpm_box(-3, 0, half, 3, 1, MPM_R(5.5));
        b.velocity[2] = (mpm_real)(100 - 100 * k);
    } else if (scene == RIM) {
        b.shape = k == 0   ? mpm_box(-6, 0, -4, 7, 1, 0)
                  : k == 1 ? mpm_box(-5, 0, 0, 0, 1, MPM_R(1.5))
                           : mpm_ellipsoid(2, 0, MPM_R(2.1), 2, 2, 2);
        b.velocity[0] = k == 2 ? -100 : 0;
        b.velocity[2] = k == 2 ? -100 : 0;
    }
    return b;
}

/* Velocities of the three bodies after 3 ns, x and z. Returns the largest number of bodies that met at a node. */
static int three(int scene, const mpm_contact *contact, mpm_basis basis, const int *order, double *v)
{
    mpm_material m = scene_metal(0, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 20, 1, 20, -10, 0, -10);
    int k, n, met = 0;
    mpm_world w;
    int32_t i;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = basis;
    d.contact = *contact;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 3; k++) {
        mpm_body_desc b = one_of_three(scene, order[k], &m);
        if (mpm_body_add(&w, &b) != MPM_OK) break;
    }
    for (n = 0; n < STEPS && k == 3; n++) {
        if (mpm_step(&w, MPM_R(2e-5)) < 0) break;
        for (i = 2; i < w.pairs; i++)
            if (w.node[w.pair[i].a].index == w.node[w.pair[i - 2].a].index) met = 3;
    }
    for (k = 0; k < 3; k++) {
        const mpm_totals t = mpm_body_totals(&w, k);
        v[2 * order[k]] = n == STEPS ? t.momentum[0] / t.mass : (double)NAN;
        v[2 * order[k] + 1] = n == STEPS ? t.momentum[2] / t.mass : (double)NAN;
    }
    mpm_free(&w);
    return met;
}

/* One scene in all six orders. v: the velocities in the first. */
static void renumbered(int scene, int rule, mpm_contact_law law, mpm_basis basis, double *v)
{
    mpm_contact c = mpm_desc_default().contact;
    double apart = 0, other[6];
    int order, k;
    c.law = law;
    c.friction = MPM_R(0.3);
    c.normal = alike[rule];
    CHECK_EQUAL("three bodies at a node", three(scene, &c, basis, orders[0], v), 3);
    for (order = 1; order < 6; order++) {
        three(scene, &c, basis, orders[order], other);
        for (k = 0; k < 6; k++) apart = check_worst(apart, fabs(other[k] - v[k]) / 100);
    }
    printf("# %s, %s, law %d, %s: %.2g apart\n", scene == FOIL ? "foil" : "rim", alike_name[rule], (int)law,
           scene_basis(basis), apart);
    CHECK_NEAR("... whatever their numbers", apart, 0, roundoff(1e-9, 1e-4));
}

static void three_bodies(void)
{
    double v[6];
    int law, basis, rule;
    for (basis = 0; basis < MPM_BASES; basis++)
        for (law = MPM_CONTACT_FRICTION; law <= MPM_CONTACT_WELD; law++)
            for (rule = 0; rule < (law == MPM_CONTACT_WELD ? 1 : 3); rule++) { /* a weld has no use for normals */
                renumbered(FOIL, rule, (mpm_contact_law)law, (mpm_basis)basis, v);
                CHECK_NEAR("... the foil stays in the middle", v[3] / 100, 0, roundoff(1e-9, 1e-4));
                CHECK_NEAR("... and the blocks are mirror images", (v[1] + v[5]) / 100, 0, roundoff(1e-9, 1e-4));
                if (law == MPM_CONTACT_FRICTION || rule == 0)
                    renumbered(RIM, rule, (mpm_contact_law)law, (mpm_basis)basis, v);
            }
}

#define NODES 1024 /* of the grid below */

/* Normals out of a disk into the slab under it, one per grid node, with the disk added first or last; those of the two
   bodies' own gradients. Returns the number of nodes. */
static int into_slab(mpm_normal_rule rule, int last, double n[NODES][3], double of_disk[NODES][3],
                     double of_slab[NODES][3])
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 14, 1, 14, -7, 0, -7);
    const mpm_body_desc disk = scene_body(&m, mpm_ellipsoid(MPM_R(0.3), 0, 2, 2, 2, 2), 0.5, 0);
    const mpm_body_desc slab = scene_body(&m, mpm_box(-4, 0, -4, 4, 1, 0), 0.5, 0);
    mpm_world w;
    int32_t i;
    int c, count;
    d.geometry = MPM_PLANE_STRAIN;
    d.contact.normal = rule;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, last ? &slab : &disk);
    mpm_body_add(&w, last ? &disk : &slab);
    mpm_locate(&w, 1);
    mpm_p2g(&w);
    mpm_contact_find(&w);
    for (i = 0; i < w.pairs; i++) {
        const mpm_node *a = &w.node[w.pair[i].a], *b = &w.node[w.pair[i].b];
        const mpm_real *g[2];
        double size[2] = {0, 0};
        g[last] = w.touch[a->touch].gradient; /* 0: of the disk, 1: of the slab */
        g[!last] = w.touch[b->touch].gradient;
        for (c = 0; c < 6; c++) size[c / 3] += (double)(g[c / 3][c % 3] * g[c / 3][c % 3]);
        for (c = 0; c < 3; c++) {
            n[a->index][c] = (double)w.pair[i].normal[c] * (last ? -1 : 1);
            of_disk[a->index][c] = (double)g[0][c] / sqrt(size[0]);
            of_slab[a->index][c] = -(double)g[1][c] / sqrt(size[1]);
        }
    }
    count = w.pairs;
    mpm_free(&w);
    return count;
}

static double largest_gap(double a[NODES][3], double b[NODES][3])
{
    double gap = 0;
    int i, c;
    for (i = 0; i < NODES; i++)
        for (c = 0; c < 3; c++) gap = check_worst(gap, fabs(a[i][c] - b[i][c]));
    return gap;
}

/* Which rules go by the numbers of the bodies, and how: as the list of them says. */
static void numbered_normals(void)
{
    static double n[2][NODES][3], disk[NODES][3], slab[NODES][3];
    mpm_normal_rule rule;
    int last, i;
    for (rule = MPM_NORMAL_RANKED; rule <= MPM_NORMAL_LOGISTIC; rule = (mpm_normal_rule)(rule + 1)) {
        const int by_number = rule == MPM_NORMAL_RANKED || rule == MPM_NORMAL_FIXED;
        for (last = 0; last < 2; last++) {
            memset(n[last], 0, sizeof n[last]);
            CHECK_TRUE("a disk on a slab", into_slab(rule, last, n[last], disk, slab) > 3);
            if (rule == MPM_NORMAL_RANKED)
                CHECK_NEAR("ranked: of the body added last", largest_gap(n[last], last ? disk : slab), 0, 64 * eps);
            for (i = 0; i < NODES && rule == MPM_NORMAL_FIXED; i++)
                if (fabs(n[last][i][2]) > 0) CHECK_EQUAL("vertical: it lies below", n[last][i][2], last ? 1 : -1);
        }
        if (by_number) CHECK_TRUE("... so that the order matters", largest_gap(n[0], n[1]) > 0.1);
        else CHECK_NEAR("the order does not matter", largest_gap(n[0], n[1]), 0, 1e5 * eps);
    }
}

/* Six cubes around an edge and their neighbours, welded, each at its own velocity: one velocity at every node. */
static void six_welded(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 12, 12, 12, -6, -6, -6);
    double apart = 0, momentum[3] = {0, 0, 0};
    mpm_totals t;
    mpm_world w;
    int32_t i;
    int k, c;
    d.contact.law = MPM_CONTACT_WELD;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 6; k++) {
        const mpm_real x = k % 2 ? 0 : -2, y = k / 2 % 2 ? 0 : -2, z = k / 4 ? 0 : -2;
        mpm_body_desc b = scene_body(&m, mpm_box(x, y, z, x + 2, y + 2, z + 2), 0.5, 37 * k - 50);
        b.velocity[0] = (mpm_real)(20 * k);
        mpm_body_add(&w, &b);
    }
    t = mpm_body_totals(&w, -1);
    for (c = 0; c < 3; c++) momentum[c] = t.momentum[c];
    mpm_locate(&w, MPM_R(1e-5));
    mpm_p2g(&w);
    mpm_forces(&w);
    mpm_grid_update(&w);
    mpm_contact_find(&w);
    mpm_contact_apply(&w);
    for (i = 0; i < w.pairs; i++)
        for (c = 0; c < 3; c++) {
            const mpm_node *a = &w.node[w.pair[i].a], *b = &w.node[w.pair[i].b];
            apart = check_worst(apart, fabs((double)(a->momentum[c] / a->mass - b->momentum[c] / b->mass)) / 100);
        }
    CHECK_TRUE("six bodies meet", w.pairs > 15 * 3);
    CHECK_NEAR("welded, they have one velocity at every node", apart, 0, 1e3 * eps);
    mpm_g2p(&w);
    mpm_musl(&w);
    t = mpm_body_totals(&w, -1);
    for (c = 0; c < 3; c++)
        CHECK_NEAR("... and their momentum", (t.momentum[c] - momentum[c]) / fabs(t.momentum[0]), 0, 1e3 * eps);
    mpm_free(&w);
}

/* ---- bonded ---------------------------------------------------------------------------------- */

static int in_spheres(void *context, const mpm_real x[3])
{
    const mpm_real r2 = x[0] * x[0] + x[1] * x[1], up = x[2] - MPM_R(3.9), down = x[2] + MPM_R(4.1);
    (void)context;
    return r2 + up * up <= 16 || r2 + down * down <= 16;
}

/* Two elastic spheres pressed together at 10 m/s, bonded all over or made as one body: the largest share by which
   kinetic and internal energy drift within a microsecond. */
static double vibrates(int bonded)
{
    const mpm_units u = mpm_units_um_us_ng();
    const mpm_real low[3] = {-4, -4, MPM_R(-8.1)}, high[3] = {4, 4, MPM_R(7.9)};
    mpm_material m = scene_metal(1, u);
    mpm_bond bond = mpm_bond_default(&u);
    mpm_desc d = scene_grid(1, 6, 1, 22, 0, 0, -11);
    mpm_body_desc upper = scene_body(&m, mpm_sphere(0, 0, MPM_R(3.9), 4), 0.5, 0);
    mpm_body_desc lower = scene_body(&m, mpm_sphere(0, 0, MPM_R(-4.1), 4), 0.5, 0);
    double start, worst = 0;
    mpm_totals t;
    mpm_world w;
    mpm_real dt;
    int32_t i;
    bond.rule = MPM_BOND_NONE;
    d.geometry = MPM_AXISYMMETRIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    mpm_init(&w, &d, NULL, 0);
    if (!bonded) upper.shape = mpm_shape_user(in_spheres, NULL, low, high);
    mpm_body_add(&w, &upper);
    if (bonded) mpm_body_add(&w, &lower);
    for (i = 0; i < w.points.count; i++) {
        w.points.bond[i] = 2;
        w.points.v[2][i] = w.points.x[2][i] > MPM_R(-0.1) ? -5 : 5;
    }
    start = mpm_body_totals(&w, -1).kinetic;
    dt = mpm_time_step(&w, MPM_R(0.1));
    while (w.time < 1) {
        if (mpm_bond_step(&bond, &w, dt) < 0) return 1e9;
        t = mpm_body_totals(&w, -1);
        worst = check_worst(worst, fabs((t.kinetic + t.internal) / start - 1));
    }
    CHECK_TRUE("bonded spheres: held to the end", w.held > 0 || !bonded);
    mpm_free(&w);
    return worst;
}

static void bonded_spheres(void)
{
    const double two = vibrates(1), one = vibrates(0);
    printf("# energy drifts by %.5f bonded, %.5f as one body\n", two, one);
    CHECK_NEAR("bonded spheres: energy over a microsecond", two, 0, 0.01);
    CHECK_NEAR("... as of one body", two, one, roundoff(1e7 * eps, 1e-5));
}

int main(void)
{
    int b;
    for (b = 0; b < MPM_BASES; b++) {
        if (b <= MPM_GIMP) rebounds((mpm_basis)b, 10, 0.1);
        rebounds((mpm_basis)b, 50, 0.1);
        rebounds((mpm_basis)b, 50, 0.5);
        rebounds((mpm_basis)b, 1000, 0.5);
        disks((mpm_basis)b);
    }
    three_bodies();
    numbered_normals();
    six_welded();
    bonded_spheres();
    return check_end();
}
