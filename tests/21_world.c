/* 21_world - setting up: what is refused, memory, retirement, repetition, units.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static const double eps = (double)MPM_EPSILON;

static void refuses_desc(const char *field, mpm_desc d, mpm_status wanted)
{
    mpm_world w;
    char line[100];
    snprintf(line, sizeof line, "refused: %s", field);
    CHECK_EQUAL(line, mpm_init(&w, &d, NULL, 0), wanted);
    CHECK_TRUE("... the fault names the field", w.fault.field && !strcmp(w.fault.field, field));
    CHECK_EQUAL("... and no memory is wanted", mpm_bytes(&d), 0);
    mpm_free(&w);
}

static void bad_descriptions(void)
{
    const mpm_desc good = scene_grid(1, 10, 10, 10, 0, 0, 0);
    const mpm_real nan = (mpm_real)(strtod("nan", NULL));
    mpm_desc d = good;
    d.cell = -1;
    refuses_desc("cell", d, MPM_ERR_ARGUMENT);
    d.cell = nan;
    refuses_desc("cell", d, MPM_ERR_NAN);
    d = good;
    d.cells[1] = 0;
    refuses_desc("cells", d, MPM_ERR_ARGUMENT);
    d = good;
    d.cells[0] = d.cells[1] = d.cells[2] = 100000;
    refuses_desc("cells in all", d, MPM_ERR_ARGUMENT);
    d = good;
    d.contact.friction = -1;
    refuses_desc("contact.friction", d, MPM_ERR_ARGUMENT);
    d = good;
    d.contact.cutoff = -1;
    refuses_desc("contact.cutoff", d, MPM_ERR_ARGUMENT);
    d = good;
    d.user_fields = MPM_USER_FIELDS + 1;
    refuses_desc("user_fields", d, MPM_ERR_ARGUMENT);
    d = good;
    d.points = -1;
    refuses_desc("points", d, MPM_ERR_ARGUMENT);
    d = good;
    d.mark = 0;
    refuses_desc("desc (not from mpm_desc_default)", d, MPM_ERR_ARGUMENT);
    d = good;
    d.gravity[2] = nan;
    refuses_desc("gravity", d, MPM_ERR_NAN);
    d = good;
    d.geometry = MPM_AXISYMMETRIC;
    d.origin[0] = -1;
    refuses_desc("origin of r", d, MPM_ERR_ARGUMENT);
}

/* Numbers that name nothing, as uninitialised memory or another language would give them. */
static void bad_choices(void)
{
    const mpm_desc good = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_desc d = good;
    d.geometry = (mpm_geometry)(MPM_AXISYMMETRIC + 1);
    refuses_desc("geometry", d, MPM_ERR_ARGUMENT);
    d = good;
    d.basis = MPM_BASES;
    refuses_desc("basis", d, MPM_ERR_ARGUMENT);
    d = good;
    d.contact.law = (mpm_contact_law)(MPM_CONTACT_USER + 1);
    refuses_desc("contact.law", d, MPM_ERR_ARGUMENT);
    d = good;
    d.contact.normal = (mpm_normal_rule)(MPM_NORMAL_LOGISTIC + 1);
    refuses_desc("contact.normal", d, MPM_ERR_ARGUMENT);
    d = good;
    d.contact.touch = -1;
    refuses_desc("contact.touch", d, MPM_ERR_ARGUMENT);
    d = good;
    d.side[3] = (mpm_side)(MPM_SIDE_WALL + 1);
    refuses_desc("side", d, MPM_ERR_ARGUMENT);
    d = good;
    d.geometry = MPM_PLANE_STRAIN;
    d.cells[1] = 0;
    CHECK_EQUAL("in two dimensions cells[1] is ignored", mpm_desc_check(&d, NULL), MPM_OK);
    memset(&d, 0, sizeof d);
    CHECK_EQUAL("a description of zeros is none", mpm_desc_check(&d, NULL), MPM_ERR_ARGUMENT);
}

/* Dampers stand on lower face and circumference: any other bit of `absorb` is refused, by its name. */
static void damped_faces(mpm_shape shape)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    const mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc b = scene_body(&m, shape, 0.5, 0);
    int bit, taken = 0, wrong = 0, unnamed = 0;
    mpm_world w;
    mpm_init(&w, &d, NULL, 0);
    for (bit = 0; bit < 32; bit++) {
        b.absorb = (bit < 31 ? 1 << bit : INT_MIN) | (bit % 2 ? MPM_FACE_BOTTOM : 0);
        if ((b.absorb & ~(MPM_FACE_BOTTOM | MPM_FACE_RIM)) == 0) continue;
        taken += mpm_body_add(&w, &b) != MPM_ERR_ARGUMENT;
        unnamed += !w.fault.field || strcmp(w.fault.field, "absorb (a face the body has not)") != 0;
        wrong += w.bodies != 0 || w.points.count != 0;
    }
    CHECK_EQUAL("unknown bits of absorb are refused", taken, 0);
    CHECK_EQUAL("... by name", unnamed, 0);
    CHECK_EQUAL("... and the world stays empty", wrong, 0);
    b.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    CHECK_EQUAL("... the two there are, together, are not", mpm_body_add(&w, &b), MPM_OK);
    mpm_free(&w);
}

static void bad_bodies(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    const mpm_body_desc good = scene_body(&m, mpm_sphere(3, 3, 3, 2), 0.5, 0);
    mpm_body_desc b = good;
    mpm_world w;
    mpm_init(&w, &d, NULL, 0);
    b.spacing = MPM_R(1.5);
    CHECK_EQUAL("spacing larger than the cell", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    CHECK_NEAR("... names the value", w.fault.value, 1.5, 0);
    b = good;
    b.density = 0;
    CHECK_EQUAL("no density", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    b = good;
    b.shape = mpm_sphere(3, 3, 3, -2);
    CHECK_EQUAL("negative radius", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    b.shape = mpm_sphere(9, 3, 3, 2);
    CHECK_EQUAL("outside the grid", mpm_body_add(&w, &b), MPM_ERR_OUTSIDE);
    CHECK_TRUE("... names the axis", !strcmp(w.fault.field, "x of a point") && w.fault.value >= 10);
    CHECK_EQUAL("the world is unchanged", w.points.count + w.bodies, 0);
    CHECK_EQUAL("a good one", mpm_body_add(&w, &good), MPM_OK);
    b.shape = mpm_box(4, 2, 2, 6, 4, 4);
    CHECK_EQUAL("overlap", mpm_body_add(&w, &b), MPM_ERR_OVERLAP);
    CHECK_EQUAL("... with the first body", w.fault.index, 0);
    b.shape = mpm_box(2, 2, 2, 4, 4, 4);
    CHECK_EQUAL("overlap, inside", mpm_body_add(&w, &b), MPM_ERR_OVERLAP);
    b.shape.kind = (mpm_shape_kind)(MPM_SHAPE_BOX + 1);
    CHECK_EQUAL("a shape of the user's without a function", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    b.shape.kind = (mpm_shape_kind)(MPM_SHAPE_USER + 1);
    CHECK_EQUAL("no such shape", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    memset(&b, 0, sizeof b);
    CHECK_EQUAL("a body of zeros is none", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... and told so", !strcmp(w.fault.field, "body (not from mpm_body_desc_default)"));
    b = good;
    b.absorb = MPM_FACE_BOTTOM;
    CHECK_EQUAL("a sphere has no face for a damper", mpm_body_add(&w, &b), MPM_ERR_ARGUMENT);
    mpm_free(&w);
    damped_faces(mpm_box(2, 2, 2, 8, 8, 8));
    damped_faces(mpm_cylinder(5, 5, 2, 3, 6));
    CHECK_EQUAL("more points than can be counted", mpm_shape_count(&d, &good.shape, MPM_R(1e-3)), 0);
    d.geometry = MPM_AXISYMMETRIC;
    mpm_init(&w, &d, NULL, 0);
    b = good;
    b.shape = mpm_box(MPM_R(-0.25), 0, 2, 2, 1, 4);
    CHECK_EQUAL("a ring at radius 0", mpm_body_add(&w, &b), MPM_ERR_OUTSIDE);
    mpm_free(&w);
}

/* The same world in caller's memory; too little of it; growing by hand. */
static void memory(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    const mpm_body_desc b = scene_body(&m, mpm_sphere(5, 5, 5, 3), 0.5, -100);
    mpm_world own, given;
    size_t bytes;
    void *block, *more = NULL;
    int n, full = 0;
    d.points = mpm_shape_count(&d, &b.shape, b.spacing);
    d.nodes = 100; /* too few on purpose */
    bytes = mpm_bytes(&d);
    block = malloc(bytes);
    CHECK_EQUAL("memory: one byte short", mpm_init(&given, &d, block, bytes - 1), MPM_ERR_MEMORY);
    CHECK_EQUAL("memory: given", mpm_init(&given, &d, block, bytes), MPM_OK);
    CHECK_EQUAL("memory: own", mpm_init(&own, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("memory: own grows for the body", mpm_body_add(&own, &b), MPM_OK);
    CHECK_EQUAL("memory: given cannot", mpm_body_add(&given, &b), MPM_ERR_FULL);
    while (given.bodies == 0 && full < 8) {
        void *next = malloc(mpm_reserve_bytes(&given));
        CHECK_EQUAL("memory: grow by hand", mpm_reserve(&given, next, mpm_reserve_bytes(&given)), MPM_OK);
        free(more);
        more = next;
        full++;
        mpm_body_add(&given, &b);
    }
    for (n = 0; n < 50; n++) {
        CHECK_TRUE("memory: step", scene_step(&own, NULL, MPM_R(1e-5)) >= 0 && mpm_step(&given, MPM_R(1e-5)) >= 0);
    }
    CHECK_EQUAL("memory: same bits",
                memcmp(own.points.v[2], given.points.v[2], (size_t)d.points * sizeof(mpm_real)), 0);
    mpm_free(&own);
    mpm_free(&given);
    free(block);
    free(more);
}

/* A sphere half of which flies out of the grid: counted, kept, its mass and momentum not lost. */
static void retirement(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    const mpm_body_desc b = scene_body(&m, mpm_sphere(5, 5, 3, 2), 0.5, -500);
    mpm_status s = MPM_OK, seen = MPM_OK;
    mpm_totals t0, t1;
    mpm_world w;
    int32_t i;
    int n, ids = 1;
    char *found;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    t0 = mpm_body_totals(&w, -1);
    for (n = 0; n < 300 && s >= 0; n++) {
        s = scene_step(&w, NULL, MPM_R(2e-5));
        if (s == MPM_RETIRED) seen = s;
    }
    t1 = mpm_body_totals(&w, -1);
    CHECK_EQUAL("retired: reported by the step", seen, MPM_RETIRED);
    CHECK_TRUE("retired: some, not all", w.retired > 0 && w.retired < t0.points);
    CHECK_EQUAL("retired: counted", t1.retired, w.retired);
    CHECK_NEAR("retired: mass kept", t1.mass, t0.mass, 0);
    found = (char *)calloc((size_t)w.points.count, 1);
    for (i = 0; i < w.points.count; i++) found[w.points.id[i]]++;
    for (i = 0; i < w.points.count; i++) ids = ids && found[i] == 1;
    CHECK_TRUE("retired: every point is there once", ids);
    free(found);
    w.points.x[1][w.body[0].first] = (mpm_real)strtod("nan", NULL);
    CHECK_EQUAL("a position that is no number", mpm_step(&w, MPM_R(2e-5)), MPM_ERR_NAN);
    mpm_free(&w);
}

/* A small bonded impact described in a unit system. Writes SI numbers. */
static void impact_in(mpm_units u, double out[5], mpm_real *bits)
{
    const double um = 1e-6 / u.length, ms = 1 / mpm_units_velocity(&u);
    mpm_material m = scene_metal(0, u);
    mpm_bond bond = mpm_bond_default(&u);
    mpm_desc d = scene_grid(1.5 * um, 10, 10, 14, 0, 0, -9 * um);
    mpm_body_desc ball = scene_body(&m, mpm_sphere(0, 0, (mpm_real)(3 * um), (mpm_real)(3 * um)), 0.75 * um, -900 * ms);
    mpm_body_desc slab = scene_body(&m, mpm_cylinder(0, 0, (mpm_real)(-6 * um), (mpm_real)(7.5 * um),
                                                     (mpm_real)(6 * um)), 0.75 * um, 0);
    const double dt = 8e-12 / u.time;
    mpm_world w;
    mpm_totals t;
    int32_t i;
    int n;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    slab.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &ball);
    mpm_body_add(&w, &slab);
    for (n = 0; n < 800; n++)
        if (scene_step(&w, &bond, (mpm_real)dt) < 0) break;
    t = mpm_body_totals(&w, -1);
    out[0] = n;
    out[1] = t.kinetic * mpm_units_energy(&u);
    out[2] = t.internal * mpm_units_energy(&u);
    out[3] = t.plastic_strain_mean;
    out[4] = mpm_bond_measure_body(&w, -1).abp;
    if (bits)
        for (i = 0; i < 100; i++) bits[i] = w.points.v[i % 3][i];
    mpm_free(&w);
}

static void units(void)
{
    const double loose = sizeof(mpm_real) == 4 ? 0.02 : 1e-9; /* float: round-off grown over 800 steps */
    double a[5], b[5], c[5];
    mpm_real first[100], again[100];
    int i;
    impact_in(mpm_units_um_us_ng(), a, first);
    impact_in(mpm_units_si(), b, NULL);
    impact_in(mpm_units_mm_ms_g(), c, NULL);
    CHECK_EQUAL("units: all steps", a[0], 800);
    CHECK_TRUE("units: it bonds somewhere", a[4] > 0.01);
    for (i = 1; i < 5; i++) {
        CHECK_RELATIVE("units: SI as um us ng", b[i], a[i], loose);
        CHECK_RELATIVE("units: mm ms g as um us ng", c[i], a[i], loose);
    }
    impact_in(mpm_units_um_us_ng(), b, again);
    CHECK_EQUAL("repeated: same bits", memcmp(first, again, sizeof first), 0);
}

/* Labels and dampers: the layers are where they should be and stand for the true area. */
static void labels(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1.5, 12, 12, 10, 0, 0, -10);
    mpm_body_desc slab = scene_body(&m, mpm_cylinder(0, 0, -6, 15, 6), 0.5, 0);
    const double pi = 3.14159265358979;
    long top = 0, bottom = 0, sides = 0, surface = 0;
    mpm_world w;
    int32_t i;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    slab.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &slab);
    for (i = 0; i < w.points.count; i++) {
        top += (w.points.flags[i] & MPM_FACE_TOP) != 0;
        bottom += (w.points.flags[i] & MPM_FACE_BOTTOM) != 0;
        sides += (w.points.flags[i] & MPM_FACE_RIM) != 0;
        surface += (w.points.flags[i] & MPM_POINT_SURFACE) != 0;
    }
    CHECK_EQUAL("labels: one layer at the top", top, w.points.count / 12);
    CHECK_EQUAL("labels: one layer at the bottom", bottom, w.points.count / 12);
    CHECK_EQUAL("labels: damped faces are no surface", surface, top);
    CHECK_RELATIVE("labels: circumference, one spacing thick", (double)sides * 0.25, pi / 2 * 15 * 6, 0.06);
    CHECK_RELATIVE("dampers: area of the bottom", w.body[0].area[0], pi * 225 / 4, 1e-5);
    CHECK_RELATIVE("dampers: area of the circumference", w.body[0].area[1], pi / 2 * 15 * 6, 1e-5);
    CHECK_NEAR("dampers: mass share of the bottom", w.body[0].mass[0], (double)bottom * (double)w.body[0].point_mass,
               1e4 * eps);
    mpm_free(&w);
}

static long asked; /* how often the shape below was */

static int round_of_10000(void *context, const mpm_real x[3])
{
    (void)context;
    asked++;
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < MPM_R(1e8);
}

/* A body far larger than the grid is refused at its first point outside, not walked through; what mirrors cut off is
   passed over row by row. */
static void huge(void)
{
    const mpm_real low[3] = {-10000, -1, -10000}, high[3] = {10000, 1, 10000};
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc b = mpm_body_desc_default();
    mpm_world w;
    size_t some;
    int a;
    b.shape = mpm_shape_user(round_of_10000, NULL, low, high);
    b.spacing = MPM_R(0.5);
    b.density = 1;
    d.geometry = MPM_PLANE_STRAIN;
    d.cells[1] = 2147483647; /* not read in the plane */
    CHECK_TRUE("in two dimensions cells[1] may be anything", mpm_bytes(&d) > 0);
    mpm_init(&w, &d, NULL, 0);
    CHECK_EQUAL("disc of 20,000 spacings in a grid of 20: refused", mpm_body_add(&w, &b), MPM_ERR_OUTSIDE);
    CHECK_TRUE("... after a few rows", asked > 0 && asked < 1000000);
    mpm_free(&w);
    for (a = 0; a < 6; a++) d.side[a] = MPM_SIDE_SYMMETRY;
    asked = 0;
    CHECK_EQUAL("between mirrors: what is left", mpm_shape_count(&d, &b.shape, b.spacing), 400);
    CHECK_TRUE("... nothing else was asked for", asked < 1000);
    d = mpm_desc_default();
    d.cell = 1;
    d.points = 1;
    d.side[0] = MPM_SIDE_WALL;
    d.nodes = 1000;
    some = mpm_bytes(&d);
    d.nodes = 2000000000;
    CHECK_TRUE("two thousand million nodes at walls are counted, or refused", mpm_bytes(&d) == 0 ||
               mpm_bytes(&d) / 1000000 > some / 1000);
}

static mpm_status silent(const void *material, const mpm_block *block)
{
    (void)material;
    (void)block;
    return MPM_ERR_STATE;
}

static mpm_status no_point(const void *material, const mpm_block *block)
{
    (void)material;
    return mpm_fail(block->fault, MPM_ERR_ARGUMENT, "law", 0, -1);
}

static mpm_status two_words(const void *material, const mpm_block *block)
{
    mpm_fail(block->fault, MPM_ERR_NAN, "two words", 7, 1);
    return silent(material, block);
}

/* What can be said without a world. */
static void small_ones(void)
{
    const mpm_shape ball = mpm_ellipsoid(1, 2, 3, 2, 3, 4), post = mpm_cylinder(0, 0, 1, 2, 3);
    CHECK_TRUE("an ellipsoid holds its centre and ends", mpm_shape_contains(&ball, 1, 2, 3) &&
               mpm_shape_contains(&ball, MPM_R(2.99), 2, 3) && mpm_shape_contains(&ball, 1, MPM_R(-0.99), 3));
    CHECK_TRUE("... and nothing beyond", !mpm_shape_contains(&ball, MPM_R(3.01), 2, 3) &&
               !mpm_shape_contains(&ball, MPM_R(2.5), MPM_R(4.5), 3));
    CHECK_TRUE("a cylinder too", mpm_shape_contains(&post, MPM_R(1.4), MPM_R(1.4), MPM_R(1.01)) &&
               !mpm_shape_contains(&post, MPM_R(1.5), MPM_R(1.5), 2) && !mpm_shape_contains(&post, 0, 0, MPM_R(4.01)));
    CHECK_RELATIVE("shear waves: sqrt(mu/rho)", mpm_wave_speed_s(MPM_R(70e9), MPM_R(0.25), 2700),
                   sqrt(28e9 / 2700), 8 * eps);
    CHECK_RELATIVE("longitudinal: sqrt((lambda + 2 mu)/rho)", mpm_wave_speed_p(MPM_R(70e9), MPM_R(0.25), 2700),
                   sqrt(84e9 / 2700), 8 * eps);
}

/* A law that fails stops the step with its status, whether it says why or not. */
static void laws_fail(void)
{
    mpm_desc d = scene_grid(1, 6, 6, 6, 0, 0, 0);
    mpm_body_desc b = mpm_body_desc_default();
    mpm_world w;
    b.shape = mpm_sphere(3, 3, 3, 1);
    b.spacing = MPM_R(0.5);
    b.density = 1;
    b.stress = silent;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("law without a fault: the step says so", mpm_step(&w, MPM_R(0.1)), MPM_ERR_STATE);
    CHECK_EQUAL("... and the world's fault", w.fault.status, MPM_ERR_STATE);
    CHECK_TRUE("... with a field", w.fault.field != NULL);
    w.body[0].desc.stress = two_words;
    CHECK_EQUAL("law with two answers: its status counts", mpm_step(&w, MPM_R(0.1)), MPM_ERR_STATE);
    CHECK_EQUAL("... its fault stays", w.fault.value, 7);
    b.shape = mpm_box(3, 3, MPM_R(4.5), 4, 4, MPM_R(5.5));
    mpm_body_add(&w, &b);
    w.body[0].desc.stress = NULL;
    w.body[1].desc.stress = no_point;
    CHECK_EQUAL("law that blames no point", mpm_step(&w, MPM_R(0.1)), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... blames none of the world either", w.fault.index, -1);
    w.body[1].desc.stress = two_words;
    mpm_step(&w, MPM_R(0.1));
    CHECK_EQUAL("law that blames its second", w.fault.index, w.body[1].first + 1);
    mpm_free(&w);
}

/* A strain that leaves a point no volume, or none that is a number, stops the step and names the point. */
static void flattened(void)
{
    const mpm_real speed[] = {MPM_R(-1e5), MPM_R(1e30)};
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 8, 8, 8, 0, 0, 0);
    mpm_body_desc b = scene_body(&m, mpm_box(3, 3, 3, 5, 5, 5), 0.5, 0);
    mpm_world w;
    int32_t i;
    int k;
    for (k = 0; k < 2; k++) {
        mpm_init(&w, &d, NULL, 0);
        mpm_body_add(&w, &b);
        for (i = 0; i < w.points.count; i++) w.points.v[0][i] = speed[k] * (w.points.x[0][i] - 4);
        CHECK_EQUAL("squeezed, or spread, beyond any volume", mpm_step(&w, MPM_R(1e-4)), MPM_ERR_STATE);
        CHECK_TRUE("... is named", !strcmp(w.fault.field, "volume ratio of point in one step"));
        CHECK_TRUE("... with its point", w.fault.index >= 0 && w.fault.index < w.points.count);
        mpm_free(&w);
    }
}

/* The second body in memory for one. */
static void one_body(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc b = scene_body(&m, mpm_box(1, 1, 1, 2, 2, 2), 0.5, 0);
    mpm_world w;
    void *block;
    d.bodies = 1;
    d.points = 100;
    block = malloc(mpm_bytes(&d));
    CHECK_EQUAL("memory for one body", mpm_init(&w, &d, block, mpm_bytes(&d)), MPM_OK);
    CHECK_EQUAL("... holds one", mpm_body_add(&w, &b), MPM_OK);
    b.shape = mpm_box(4, 4, 4, 5, 5, 5);
    CHECK_EQUAL("... and no second", mpm_body_add(&w, &b), MPM_ERR_FULL);
    CHECK_TRUE("... which is named", !strcmp(w.fault.field, "bodies"));
    CHECK_EQUAL("... and left out", w.bodies, 1);
    mpm_free(&w);
    free(block);
}

/* Memory that begins beside a number's place is refused, by how much; as aligned as malloc's it is taken. */
static void unaligned(void)
{
    const mpm_desc d = scene_grid(1, 4, 4, 4, 0, 0, 0);
    const size_t bytes = mpm_bytes(&d), more = 64;
    char *block = (char *)malloc(bytes + more);
    mpm_world w;
    CHECK_EQUAL("memory of malloc is aligned", mpm_unaligned(block), 0);
    CHECK_EQUAL("... one byte on it is one beside", mpm_unaligned(block + 1), 1);
    CHECK_EQUAL("memory that is not aligned", mpm_init(&w, &d, block + 1, bytes), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(w.fault.field, "memory (not aligned)"));
    CHECK_EQUAL("... with the bytes it is beside", w.fault.value, 1);
    CHECK_TRUE("... and nothing is taken", !w.memory && !w.owns_memory);
    CHECK_EQUAL("aligned memory is taken", mpm_init(&w, &d, block, bytes), MPM_OK);
    CHECK_EQUAL("more of it that is not aligned", mpm_reserve(&w, block + 1, bytes), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... leaves what there was", w.work == block + w.memory_bytes && w.work_bytes > 0);
    mpm_free(&w);
    free(block);
}

/* A moving block of a metal in the middle of a grid, and room for one more. */
static void moving_block(mpm_world *w, mpm_material *m, mpm_body_desc *b)
{
    const mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    *m = scene_metal(1, mpm_units_um_us_ng());
    *b = scene_body(m, mpm_box(2, 2, 2, 4, 4, 4), 0.5, 100);
    mpm_init(w, &d, NULL, 0);
    mpm_body_add(w, b);
}

/* A step that is none is refused before anything changes: the world is the same to the last byte, but for the fault. */
static void no_step(void)
{
    const mpm_real none = (mpm_real)strtod("nan", NULL), endless = (mpm_real)HUGE_VAL;
    const mpm_real bad[] = {0, MPM_R(-1e-5), none, endless, -endless};
    mpm_world w, before;
    mpm_material m;
    mpm_body_desc b;
    size_t k;
    char *memory;
    moving_block(&w, &m, &b);
    mpm_step(&w, MPM_R(1e-5));
    memory = (char *)malloc(w.memory_bytes);
    memcpy(memory, w.memory, w.memory_bytes);
    before = w;
    for (k = 0; k < sizeof bad / sizeof *bad; k++) {
        CHECK_EQUAL("a step that is none", mpm_step(&w, bad[k]), k < 2 ? MPM_ERR_ARGUMENT : MPM_ERR_NAN);
        CHECK_TRUE("... is named", !strcmp(w.fault.field, "dt"));
        w.fault = before.fault;
        CHECK_EQUAL("... and the world as it was", memcmp(&w, &before, sizeof w), 0);
        CHECK_EQUAL("... with its points and nodes", memcmp(w.memory, memory, w.memory_bytes), 0);
    }
    free(memory);
    mpm_free(&w);
}

/* The step by the fastest wave: of no body, of bodies with one; where one with a law tells none there is no step, and
   mpm_step says of which body. */
static void unknown_wave(void)
{
    mpm_world w;
    mpm_material m;
    mpm_body_desc b;
    moving_block(&w, &m, &b);
    CHECK_RELATIVE("time step: cell over the wave speed", mpm_time_step(&w, MPM_R(0.5)), 0.5 / (double)b.wave_p,
                   8 * eps);
    b.shape = mpm_box(6, 6, 6, 8, 8, 8);
    b.stress = NULL;
    b.wave_p = 0;
    mpm_body_add(&w, &b);
    CHECK_TRUE("... a body without stress needs no wave", mpm_time_step(&w, MPM_R(0.5)) > 0);
    b.shape = mpm_box(6, 6, 2, 8, 8, 4);
    b.stress = mpm_material_stress;
    mpm_body_add(&w, &b);
    CHECK_EQUAL("... of a law without one nothing is known", mpm_time_step(&w, MPM_R(0.5)), 0);
    CHECK_EQUAL("... which is no step", mpm_step(&w, mpm_time_step(&w, MPM_R(0.5))), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... the fault names the body", w.fault.index, 2);
    CHECK_TRUE("... and what it lacks", strstr(w.fault.field, "wave_p") != NULL);
    CHECK_EQUAL("... a step of one's own is taken", mpm_step(&w, MPM_R(1e-5)), MPM_OK);
    w.bodies = 0;
    CHECK_EQUAL("... 0 without bodies", mpm_time_step(&w, 1), 0);
    mpm_free(&w);
}

/* A step longer than a wave takes through a cell is noted as it begins, not again and again. */
static void unstable(void)
{
    mpm_real most;
    mpm_world w;
    mpm_material m;
    mpm_body_desc b;
    moving_block(&w, &m, &b);
    most = mpm_time_step(&w, 1);
    CHECK_EQUAL("as long as a wave takes: no notice", mpm_step(&w, most), MPM_OK);
    CHECK_EQUAL("a hair longer: a notice", mpm_step(&w, most * (1 + 8 * MPM_EPSILON)), MPM_UNSTABLE);
    CHECK_EQUAL("... counted", w.notices, 1);
    CHECK_EQUAL("... and the step is taken", w.steps, 2);
    CHECK_EQUAL("... not noted again", mpm_step(&w, 2 * most), MPM_OK);
    CHECK_EQUAL("a stable one between", mpm_step(&w, most / 2), MPM_OK);
    CHECK_EQUAL("... and it is", mpm_step(&w, 2 * most), MPM_UNSTABLE);
    CHECK_EQUAL("... counted too", w.notices, 2);
    w.body[0].desc.wave_p = 0;
    mpm_step(&w, most / 2);
    CHECK_EQUAL("where no wave is known, nothing is too long", mpm_step(&w, 2 * most), MPM_OK);
    mpm_free(&w);
}

int main(void)
{
    CHECK_TRUE("the version", !strcmp(mpm_version(), MPM_VERSION));
    bad_descriptions();
    bad_choices();
    bad_bodies();
    memory();
    retirement();
    units();
    labels();
    huge();
    small_ones();
    laws_fail();
    flattened();
    one_body();
    unaligned();
    no_step();
    unknown_wave();
    unstable();
    return check_end();
}
