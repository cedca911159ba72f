/* 71_step - mpm_step beside the step as the textbook has it: examples/00_step.c, and for GIMP and rings the oracle of
   oracle.h. Same points, same stresses and velocities, to round-off, through a bounce. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"
#include "oracle.h"

#define DENSITY MPM_R(0.0027)

/* Hooke's law, the stress turned with the spin to first order. */
typedef struct hooke { double lambda, mu; } hooke;

static mpm_status hooke_stress(const void *material, const mpm_block *b)
{
    const hooke *h = (const hooke *)material;
    const mpm_real lambda = (mpm_real)h->lambda, mu = (mpm_real)h->mu;
    int p, c;
    for (p = 0; p < b->count; p++) {
        const mpm_real xx = b->stress[0][p], yy = b->stress[1][p], zz = b->stress[2][p];
        const mpm_real yz = b->stress[3][p], xz = b->stress[4][p], xy = b->stress[5][p];
        const mpm_real wx = b->spin[0][p], wy = b->spin[1][p], wz = b->spin[2][p];
        const mpm_real pressure = lambda * (b->strain[0][p] + b->strain[1][p] + b->strain[2][p]);
        for (c = 0; c < 6; c++) b->stress[c][p] += 2 * mu * b->strain[c][p] + (c < 3 ? pressure : 0);
        b->stress[0][p] += 2 * (wy * xz - wz * xy);
        b->stress[1][p] += 2 * (wz * xy - wx * yz);
        b->stress[2][p] += 2 * (wx * yz - wy * xz);
        b->stress[3][p] += wx * (yy - zz) - wy * xy + wz * xz;
        b->stress[4][p] += wy * (zz - xx) - wz * yz + wx * xy;
        b->stress[5][p] += wz * (xx - yy) - wx * xz + wy * yz;
    }
    return MPM_OK;
}

static mpm_body_desc elastic(const hooke *h, mpm_shape shape, double spacing, double vz)
{
    mpm_body_desc b = mpm_body_desc_default();
    b.shape = shape;
    b.spacing = (mpm_real)spacing;
    b.density = DENSITY;
    b.velocity[2] = (mpm_real)vz;
    b.stress = hooke_stress;
    b.material = h;
    return b;
}

/* How far apart two solutions are in velocity and stress; the largest stress. */
typedef struct apart { double velocity, stress, largest; } apart;

static void differ(apart *a, const mpm_world *w, int32_t i, const double *v, const double (*s)[3])
{
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    int c;
    for (c = 0; c < 3; c++) a->velocity = check_worst(a->velocity, fabs((double)w->points.v[c][i] - v[c]));
    for (c = 0; c < 6; c++) {
        const double wanted = s[row[c]][column[c]];
        a->stress = check_worst(a->stress, fabs((double)w->points.stress[c][i] - wanted));
        a->largest = check_worst(a->largest, fabs(wanted));
    }
}

static void agree(const char *name, const apart *a)
{
    const double tolerance = sizeof(mpm_real) == 8 ? 1e-11 : 2000 * (double)MPM_EPSILON;
    char line[120];
    snprintf(line, sizeof line, "%s: the bodies are under stress", name);
    CHECK_TRUE(line, a->largest > 100);
    snprintf(line, sizeof line, "%s: velocities apart, over that of the impact", name);
    CHECK_NEAR(line, a->velocity / 200, 0, tolerance);
    snprintf(line, sizeof line, "%s: stresses apart, over the largest", name);
    CHECK_NEAR(line, a->stress / a->largest, 0, tolerance);
}

/* ---- the oracle ----------------------------------------------------------------------------------------------- */

static oracle O;

static void oracle_takes(const mpm_world *w)
{
    int32_t b, i;
    int c;
    memset(O.point, 0, sizeof O.point);
    O.count = w->points.count;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].count; i++) {
            oracle_point *p = &O.point[w->points.id[i]];
            p->body = b;
            p->mass = (double)w->points.mass[i];
            p->density = (double)w->points.density[i];
            for (c = 0; c < 3; c++) p->x[c] = (double)w->points.x[c][i];
            for (c = 0; c < 3; c++) p->v[c] = (double)w->points.v[c][i];
        }
}

/* What the description says, for the oracle. */
static void oracle_like(const mpm_desc *d, const hooke *h)
{
    memset(&O, 0, sizeof O);
    O.gimp = d->basis == MPM_GIMP;
    O.rings = d->geometry == MPM_AXISYMMETRIC;
    O.mirror[0] = d->side[0] == MPM_SIDE_SYMMETRY;
    O.mirror[1] = d->side[2] == MPM_SIDE_SYMMETRY && !O.rings;
    O.friction = (double)d->contact.friction;
    O.cell = 1;
    O.spacing = 0.5;
    O.density = (double)DENSITY;
    O.lambda = h->lambda;
    O.mu = h->mu;
}

/* A ball of radius 2 and a block on the floor, from the axis on or around (4, 4). Returns 1 when they are in. */
static int scene(mpm_world *w, mpm_desc *d, const hooke *h)
{
    const mpm_real c = d->side[0] == MPM_SIDE_SYMMETRY ? 0 : 4, low = c - MPM_R(3.5), high = c + MPM_R(3.5);
    mpm_body_desc ball = elastic(h, mpm_sphere(c, c, MPM_R(5.2), 2), 0.5, -200);
    mpm_body_desc block = elastic(h, mpm_box(low, low, MPM_R(0.1), high, high, MPM_R(3.1)), 0.5, 0);
    ball.velocity[0] = c > 0 ? 50 : 0; /* so that it rubs */
    d->scheme = MPM_SCHEME_THESIS;
    return mpm_init(w, d, NULL, 0) == MPM_OK && mpm_body_add(w, &ball) == MPM_OK && mpm_body_add(w, &block) == MPM_OK;
}

/* The bounce with both, whole or a quarter; in rings the quarter is a half section. */
static void beside_oracle(const char *name, mpm_geometry geometry, mpm_basis basis, int quarter,
                          double friction)
{
    const hooke metal = {51084, 26316};
    const mpm_real dt = MPM_R(1e-5);
    mpm_desc d = scene_grid(1, quarter ? 6 : 8, quarter ? 6 : 8, 10, 0, 0, 0);
    apart a = {0, 0, 0};
    double back = 0;
    mpm_world w;
    int32_t i;
    int k;
    d.geometry = geometry;
    d.basis = basis;
    d.contact.friction = (mpm_real)friction;
    d.side[4] = MPM_SIDE_FIXED;
    if (quarter) d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    CHECK_TRUE("oracle: ball and block", scene(&w, &d, &metal));
    oracle_like(&d, &metal);
    oracle_takes(&w);
    for (k = 0; k < 400 && scene_step(&w, NULL, dt) == MPM_OK; k++) oracle_step(&O, (double)dt);
    for (i = 0; i < w.points.count; i++) {
        const oracle_point *p = &O.point[w.points.id[i]];
        differ(&a, &w, i, p->v, (const double (*)[3])p->s);
        if (p->body == 0 && p->v[2] > 0) back += 1.0 / w.body[0].count;
    }
    CHECK_TRUE("oracle: most of the ball is on its way back", back > 0.5);
    agree(name, &a);
    mpm_free(&w);
}

/* ---- the textbook --------------------------------------------------------------------------------------------- */

#define main step_main
#include "00_step.c"
#undef main

static void beside_textbook(void)
{
    const hooke metal = {lambda, mu};
    mpm_desc d = scene_grid(1, NX - 1, NY - 1, NZ - 1, 0, 0, 0);
    mpm_body_desc ball = elastic(&metal, mpm_sphere(5, 5, MPM_R(7.5), 3), 0.5, -200);
    mpm_body_desc block = elastic(&metal, mpm_box(1, 1, 0, 9, 9, 4), 0.5, 0);
    double v, before;
    mpm_world w;
    int32_t i;
    int k;
    d.scheme = MPM_SCHEME_THESIS;
    d.side[4] = MPM_SIDE_FIXED;
    mpm_init(&w, &d, NULL, 0);
    CHECK_EQUAL("textbook: the ball", mpm_body_add(&w, &ball), MPM_OK);
    CHECK_EQUAL("textbook: the block", mpm_body_add(&w, &block), MPM_OK);
    fill();
    CHECK_EQUAL("textbook: as many points", w.points.count, count);
    before = energy(&v);
    for (k = 1; k <= 800 && scene_step(&w, NULL, (mpm_real)dt) == MPM_OK; k++) {
        apart a = {0, 0, 0};
        step();
        for (i = 0; i < w.points.count && (k == 300 || k == 800); i++) {
            const point *p = &points[w.points.id[i]];
            differ(&a, &w, i, p->v, (const double (*)[3])p->stress);
        }
        if (k == 300) agree("textbook, in contact", &a);
        if (k == 800) agree("textbook, after it", &a);
    }
    CHECK_NEAR("textbook: share of the energy kept", energy(&v) / before, 1, 1e-3);
    CHECK_NEAR("textbook: the ball leaves", v, 187.7, 0.05);
    mpm_free(&w);
}

/* ---- two phases in a sweep ------------------------------------------------------------------------------------- */

/* The step phase by phase. */
static mpm_status phases(mpm_world *w, mpm_real h)
{
    mpm_status s = mpm_locate(w, h), stressed;
    if (s < 0) return s;
    mpm_p2g(w);
    mpm_forces(w);
    mpm_grid_update(w);
    mpm_contact_find(w);
    mpm_contact_apply(w);
    mpm_g2p(w);
    mpm_musl(w);
    stressed = mpm_stress(w);
    if (stressed < 0) return stressed;
    mpm_move(w);
    return s;
}

/* A ball on a damped and sprung block under gravity, above a wall, beside a mirror, until it is on its way back. */
static int begin(mpm_world *w, const hooke *h, mpm_geometry geometry, mpm_basis basis, mpm_scheme scheme)
{
    mpm_desc d = scene_grid(1, 8, 8, 10, 0, 0, 0);
    mpm_body_desc ball = elastic(h, mpm_sphere(0, 0, MPM_R(6.2), 2), 0.4, -200);
    mpm_body_desc block = elastic(h, mpm_cylinder(0, 0, MPM_R(0.1), 5, 4), 0.4, 0);
    d.geometry = geometry;
    d.basis = basis;
    d.scheme = scheme;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    d.side[4] = MPM_SIDE_WALL;
    d.contact.friction = d.wall_friction = MPM_R(0.3);
    d.gravity[2] = -50;
    d.user_fields = 3;
    block.absorb = MPM_FACE_RIM;
    block.absorb_spring = 1;
    block.wave_p = MPM_R(6000.0);
    block.wave_s = MPM_R(3000.0);
    return mpm_init(w, &d, NULL, 0) == MPM_OK && mpm_body_add(w, &ball) == MPM_OK && mpm_body_add(w, &block) == MPM_OK;
}

/* Two worlds, one by mpm_step and one phase by phase: the same bits in every field of every point and in the ledger. */
static void same_bits(const char *name, mpm_geometry geometry, mpm_basis basis, mpm_scheme scheme)
{
    const hooke metal = {51084, 26316};
    mpm_world a, b;
    char line[120];
    int k, back = 0, ok = begin(&a, &metal, geometry, basis, scheme);
    ok = begin(&b, &metal, geometry, basis, scheme) && ok;
    snprintf(line, sizeof line, "%s: ball and block", name);
    CHECK_TRUE(line, ok);
    for (k = 0; ok && k < 120; k++)
        ok = mpm_step(&a, MPM_R(1e-5)) == MPM_OK && phases(&b, MPM_R(1e-5)) == MPM_OK;
    snprintf(line, sizeof line, "%s: in contact", name);
    CHECK_TRUE(line, ok && a.pairs > 0);
    for (k = 0; k < a.points.count; k++) back += a.points.v[2][k] > -150 && k < a.body[0].count;
    snprintf(line, sizeof line, "%s: the ball is slowed down", name);
    CHECK_TRUE(line, back > a.body[0].count / 4);
    for (k = 0; ok && k < a.fields; k++)
        ok = !memcmp(a.field + (size_t)k * a.stride, b.field + (size_t)k * b.stride,
                     (size_t)a.points.count * sizeof(mpm_real));
    snprintf(line, sizeof line, "%s: the same bits in one sweep and in two", name);
    CHECK_TRUE(line, ok && !memcmp(&a.ledger, &b.ledger, sizeof a.ledger));
    mpm_free(&a);
    mpm_free(&b);
}

static void sweeps(void)
{
#define GEOMETRY(name, word, text) {name, word},
    static const struct { mpm_geometry value; const char *word; } geometry[] = {MPM_GEOMETRY_LIST(GEOMETRY)};
#undef GEOMETRY
    char name[80];
    int g, basis;
    for (g = 0; g < MPM_GEOMETRIES; g++)
        for (basis = 0; basis < MPM_BASES; basis++) {
            snprintf(name, sizeof name, "%s, %s", geometry[g].word, scene_basis((mpm_basis)basis));
            same_bits(name, geometry[g].value, (mpm_basis)basis, MPM_SCHEME_CONSISTENT);
        }
    same_bits("scheme of the thesis", MPM_3D, MPM_LINEAR, MPM_SCHEME_THESIS);
}

int main(void)
{
    sweeps();
    beside_textbook();
    beside_oracle("linear with friction", MPM_3D, MPM_LINEAR, 0, 0.3);
    beside_oracle("GIMP with friction", MPM_3D, MPM_GIMP, 0, 0.3);
    beside_oracle("GIMP quarter", MPM_3D, MPM_GIMP, 1, 0);
    beside_oracle("rings", MPM_AXISYMMETRIC, MPM_LINEAR, 1, 0);
    beside_oracle("rings with GIMP", MPM_AXISYMMETRIC, MPM_GIMP, 1, 0.3);
    return check_end();
}
