/* 30_bond - growth of D against the law, its limits, rules of one's own, nodal averages, measures, estimates.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

#include <float.h>

static const double eps = (double)MPM_EPSILON;

static void growth(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_bond b = mpm_bond_default(&u);
    const double gc = 1503.74, gdot = 2.271e5, dt = 8e-6;
    int64_t tally[MPM_TALLIES] = {0};
    double x;
    CHECK_RELATIVE("G_c in J/m2 is G_c in um us ng", b.critical, gc, 8 * eps);
    CHECK_RELATIVE("Gdot_c in J/m2/us is Gdot_c in um us ng", b.critical_rate, gdot, 8 * eps);
    CHECK_NEAR("nothing dissipated adds nothing", mpm_bond_law(&b, 0, (mpm_real)dt, tally), 0, 0);
    CHECK_EQUAL("... and is no growth", tally[MPM_TALLY_BOND_GROWTH], 0);
    for (x = 1e-4; x < 2; x *= 3) { /* below e: the law itself */
        const double dG = x * gdot * dt;
        CHECK_RELATIVE("D against A 4.16, 4.17", mpm_bond_law(&b, (mpm_real)dG, (mpm_real)dt, tally),
                       dG / (gc * (1 - log(x))), 64 * eps);
    }
    CHECK_EQUAL("the floor has not acted", tally[MPM_TALLY_BOND_FLOOR], 0);
    CHECK_RELATIVE("beyond e Gdot_c the floor acts", mpm_bond_law(&b, (mpm_real)(3 * gdot * dt), (mpm_real)dt, tally),
                   3 * gdot * dt / (gc * 0.05), 64 * eps);
    CHECK_EQUAL("... and is counted", tally[MPM_TALLY_BOND_FLOOR], 1);
    b.critical = -1;
    CHECK_EQUAL("a negative G_c is refused", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
    b = mpm_bond_default(&u);
    b.rule = (mpm_bond_rule)(MPM_BOND_USER + 1);
    CHECK_EQUAL("no such rule", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
    b.rule = MPM_BOND_NONE;
    CHECK_EQUAL("no rule", mpm_bond_check(&b, NULL), MPM_OK);
    b.average = (mpm_bond_average)(MPM_BOND_LITERAL + 1);
    CHECK_EQUAL("no such average", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
}

static mpm_real never_asked(void *context, const mpm_world *w, int32_t point)
{
    (void)context;
    (void)w;
    (void)point;
    return 0;
}

/* The check fails with this status and names this field and its value. */
static void names(const mpm_bond *b, mpm_status status, const char *field, mpm_real value)
{
    mpm_fault f;
    memset(&f, 0, sizeof f);
    CHECK_EQUAL(field, mpm_bond_check(b, &f), status);
    CHECK_TRUE("... named, with its value",
               f.status == status && f.field && !strcmp(f.field, field) &&
                   (isnan((double)value) ? isnan((double)f.value) : f.value >= value && f.value <= value));
}

static void faults(void)
{
    static const char *const name[4] = {"bond critical", "bond critical_rate", "bond floor", "bond length"};
    mpm_units u = mpm_units_um_us_ng();
    mpm_bond b;
    mpm_fault f;
    int k, rule;
    for (rule = MPM_BOND_ENERGY; rule <= MPM_BOND_STRAIN; rule++)
        for (k = 0; k < 4; k++) {
            mpm_real *field[4];
            field[0] = &b.critical;
            field[1] = &b.critical_rate;
            field[2] = &b.floor;
            field[3] = &b.length;
            b = mpm_bond_default(&u);
            b.rule = (mpm_bond_rule)rule;
            CHECK_EQUAL("source A's pair", mpm_bond_check(&b, &f), MPM_OK);
            *field[k] = MPM_R(-2.5);
            names(&b, MPM_ERR_ARGUMENT, name[k], MPM_R(-2.5));
            *field[k] = (mpm_real)nan("");
            names(&b, MPM_ERR_NAN, name[k], (mpm_real)nan(""));
            *field[k] = (mpm_real)HUGE_VAL;
            names(&b, MPM_ERR_NAN, name[k], (mpm_real)HUGE_VAL);
            *field[k] = 0;
            if (k < 3) names(&b, MPM_ERR_ARGUMENT, name[k], 0);
            else CHECK_EQUAL("a length of 0 is the cell's", mpm_bond_check(&b, &f), MPM_OK);
        }
    memset(&b, 0, sizeof b);
    names(&b, MPM_ERR_ARGUMENT, "bond (not from mpm_bond_default)", 0);
    b = mpm_bond_default(&u);
    b.mark = 0;
    names(&b, MPM_ERR_ARGUMENT, "bond (not from mpm_bond_default)", 0);
    b.rule = MPM_BOND_NONE;
    names(&b, MPM_ERR_ARGUMENT, "bond (not from mpm_bond_default)", 0);
    b = mpm_bond_default(&u);
    b.partner = -2;
    names(&b, MPM_ERR_ARGUMENT, "bond partner", -2);
    b.partner = MPM_USER_FIELDS - 1;
    CHECK_EQUAL("the last user field", mpm_bond_check(&b, &f), MPM_OK);
    b.average = (mpm_bond_average)(MPM_BOND_LITERAL + 1);
    names(&b, MPM_ERR_ARGUMENT, "bond average", (mpm_real)(MPM_BOND_LITERAL + 1));
    b.rule = (mpm_bond_rule)(MPM_BOND_USER + 1);
    names(&b, MPM_ERR_ARGUMENT, "bond rule", (mpm_real)(MPM_BOND_USER + 1));
    b = mpm_bond_default(&u);
    b.rule = MPM_BOND_USER;
    names(&b, MPM_ERR_ARGUMENT, "bond grow", 0);
    b.grow = never_asked;
    b.critical = b.critical_rate = b.floor = b.length = -1;
    CHECK_EQUAL("a rule of one's own has other constants", mpm_bond_check(&b, &f), MPM_OK);
    b.rule = MPM_BOND_NONE;
    CHECK_EQUAL("no rule has none", mpm_bond_check(&b, &f), MPM_OK);
}

/* A ball on a slab, D set by hand: the three averages (A 4.6, 4.7). */
static void averages(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 10, 10, 12, -5, -5, -6);
    mpm_bond b = mpm_bond_default(&u);
    mpm_bond_average a;
    mpm_body_desc ball = scene_body(&m, mpm_box(-2, -2, 0, 2, 2, 2), 0.5, -10);
    mpm_body_desc slab = scene_body(&m, mpm_box(-4, -4, -4, 4, 4, 0), 0.5, 0);
    mpm_world w;
    int32_t i;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &ball);
    mpm_body_add(&w, &slab);
    for (i = 0; i < w.points.count; i++)
        if (w.points.flags[i] & MPM_POINT_SURFACE) w.points.bond[i] = i < w.body[1].first ? MPM_R(0.6) : MPM_R(0.2);
    for (a = MPM_BOND_MEAN; a <= MPM_BOND_LITERAL; a = (mpm_bond_average)(a + 1)) {
        double low = 9, high = -9;
        b.average = a;
        mpm_locate(&w, 1);
        mpm_p2g(&w);
        mpm_contact_find(&w);
        mpm_bond_nodes(&b, &w);
        for (i = 0; i < w.pairs; i++) {
            const double D = (double)mpm_bond_of_pair(&b, &w, &w.pair[i]);
            if (D < low) low = D;
            if (D > high) high = D;
        }
        if (a == MPM_BOND_LITERAL) CHECK_TRUE("A 4.6 literally: far below the mean", high < 0.2);
        else CHECK_NEAR("nodal D: mean of the bodies' means", low, 0.4, 16 * eps);
        if (a != MPM_BOND_LITERAL) CHECK_NEAR("... at every node", high, 0.4, 16 * eps);
    }
    mpm_free(&w);
}

/* A cube of 4 um lies on a slab, both at rest; D grows under the state given by hand. */
static mpm_world cube_on_slab(mpm_material *m, int fields)
{
    mpm_desc d = scene_grid(1, 12, 12, 12, -6, -6, -6);
    mpm_body_desc cube = scene_body(m, mpm_box(-2, -2, 0, 2, 2, 4), 0.5, 0);
    mpm_body_desc slab = scene_body(m, mpm_box(-5, -5, -4, 5, 5, 0), 0.5, 0);
    mpm_world w;
    d.user_fields = fields;
    d.scheme = MPM_SCHEME_THESIS;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &cube);
    mpm_body_add(&w, &slab);
    return w;
}

static void find_contact(mpm_world *w)
{
    mpm_locate(w, MPM_R(8e-6));
    mpm_p2g(w);
    mpm_contact_find(w);
}

/* The cube's face (64 points) and the slab's points under it and one cell around (12 x 12) touch; all
   flow plastically at 425 / us under 200 MPa, one point backwards. */
static void state_by_hand(mpm_world *w)
{
    int32_t i;
    w->dt_last = MPM_R(8e-6);
    for (i = 0; i < w->points.count; i++) {
        w->points.plastic_rate[i] = 425;
        w->points.stress[2][i] = -150;
        w->points.stress[0][i] = w->points.stress[1][i] = 50; /* von Mises 200 */
    }
}

static mpm_real tenth(void *context, const mpm_world *w, int32_t point)
{
    long *calls = (long *)context;
    ++*calls;
    return w->points.x[0][point] > 0 ? MPM_R(0.1) : MPM_R(-0.1);
}

static mpm_real never(void *context, const mpm_world *w, const mpm_pair *pair, mpm_real D)
{
    (void)context;
    return w->node[pair->a].mass > 0 ? D / 1000 : 2;
}

static void rules(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_bond b = mpm_bond_default(&u);
    mpm_world w = cube_on_slab(&m, 0);
    mpm_points *p = &w.points;
    long calls = 0, grown = 0, lower = 0, i;
    mpm_real top = 0;
    state_by_hand(&w);
    find_contact(&w);

    b.rule = MPM_BOND_STRAIN; /* d_eps = 425 * 8e-6 = 0.0034; eps_b = 1.4 (1 + ln 2) = 2.370406 */
    b.critical = MPM_R(1.4);
    b.critical_rate = 850;
    mpm_bond_grow(&b, &w);
    for (i = 0; i < p->count; i++) {
        const int touches = i < w.body[1].first ? p->x[2][i] < 1 : p->x[2][i] > -1;
        grown += p->bond[i] > 0;
        if (p->bond[i] > 0 && !touches) lower++;
        if (p->bond[i] > top) top = p->bond[i];
    }
    CHECK_RELATIVE("strain rule, A 4.3 - 4.5", top, 0.001434354, 1e-6);
    CHECK_EQUAL("surface points in contact grow", grown, w.tally[MPM_TALLY_BOND_GROWTH]);
    CHECK_EQUAL("... all near the interface", lower, 0);
    /* the face: 8 x 8; the walls' next layer, within the cell: 28; the slab: 12 x 12 */
    CHECK_EQUAL("... 64 of the face, 28 above, 144 of the slab", grown, 64 + 28 + 144);

    for (i = 0; i < p->count; i++) p->bond[i] = 0;
    b = mpm_bond_default(&u); /* dG = 200 * 0.0034 * 1 um = 0.68 J/m2; x = 0.68/(2.271e5 * 8e-6) = 0.3742845 */
    CHECK_RELATIVE("energy rule, A 4.16, 4.17", mpm_bond_of_point(&b, &w, 0),
                   0.68 / (1503.74 * (1 + 0.98273908)), 1e-6);
    b.length = 2;
    CHECK_RELATIVE("... its length in place of the cell", mpm_bond_of_point(&b, &w, 0),
                   1.36 / (1503.74 * (1 + 0.28959190)), 1e-6);

    b.rule = MPM_BOND_USER;
    CHECK_EQUAL("a rule of one's own must be given", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
    b.grow = tenth;
    b.context = &calls;
    CHECK_EQUAL("... then needs no constants", mpm_bond_check(&b, NULL), MPM_OK);
    w.tally[MPM_TALLY_BOND_GROWTH] = 0;
    mpm_bond_grow(&b, &w);
    mpm_bond_grow(&b, &w);
    for (i = 0, lower = 0, top = 0; i < p->count; i++) {
        if (p->bond[i] > top) top = p->bond[i];
        lower += p->bond[i] < 0;
    }
    CHECK_EQUAL("... is asked for each point in contact", calls, 2 * grown);
    CHECK_EQUAL("... and counted where D grew", w.tally[MPM_TALLY_BOND_GROWTH], grown);
    CHECK_RELATIVE("... D is its sum", top, 0.2, 4 * eps);
    CHECK_EQUAL("... D never falls", lower, 0);

    for (i = 0; i < p->count; i++) p->bond[i] = MPM_R(1.5);
    mpm_bond_nodes(&b, &w);
    CHECK_RELATIVE("A 4.7 decides", mpm_bond_of_pair(&b, &w, &w.pair[0]), 1.5, 4 * eps);
    b.decide = never;
    find_contact(&w);
    mpm_bond_nodes(&b, &w);
    CHECK_RELATIVE("or a decision of one's own, told A 4.7", mpm_bond_of_pair(&b, &w, &w.pair[0]), 0.0015, 4 * eps);
    b.partner = MPM_USER_FIELDS;
    CHECK_EQUAL("a partner field beyond the user fields", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
    mpm_free(&w);
}

/* The interface of a 4 um cube on a slab is 16 um2, of which the half x > 0 is bonded by hand. */
static void interface(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_bond b = mpm_bond_default(&u);
    mpm_world w = cube_on_slab(&m, 1);
    mpm_bond_measure measure;
    mpm_interface f, back;
    int32_t i;
    b.partner = 0;
    for (i = 0; i < w.points.count; i++) {
        w.points.bond[i] = w.points.x[0][i] > 0 ? MPM_R(2.0) : 0;
        if (i < w.body[1].first) w.points.v[2][i] = 3;
    }
    find_contact(&w);
    mpm_bond_nodes(&b, &w);
    mpm_contact_apply(&w);
    f = mpm_interface_of(&w, 0, 1);
    back = mpm_interface_of(&w, 1, 0);
    CHECK_EQUAL("nodes of the interface", f.nodes, 25);
    CHECK_EQUAL("... with D >= 1: mean at x = 0 is 1", f.bonded, 15);
    CHECK_EQUAL("... all held, for the cube leaves", f.held, 15);
    CHECK_RELATIVE("area of the face", f.area, 16, 64 * eps);
    CHECK_RELATIVE("... of its bonded nodes: 2.5 of 4", f.bonded_area, 10, 64 * eps);
    CHECK_TRUE("the bond pulls the cube down", f.impulse[2] < 0);
    CHECK_NEAR("... and the slab up", back.impulse[2], -f.impulse[2], 0);
    CHECK_EQUAL("a body meets itself nowhere", mpm_interface_of(&w, 0, 0).nodes, 0);
    CHECK_EQUAL("-1: all others", mpm_interface_of(&w, 0, -1).nodes, 25);

    state_by_hand(&w);
    for (i = 0; i < w.points.count; i++) w.points.bond[i] = 0;
    b.rule = MPM_BOND_STRAIN;
    b.critical = MPM_R(0.001);
    b.critical_rate = 1000;
    mpm_bond_grow(&b, &w);
    CHECK_EQUAL("measure of a pair", mpm_bond_measure_pair(&b, &w, 0, 1, &measure), MPM_OK);
    CHECK_EQUAL("... counts both bodies' points", measure.contacted, 64 + 28 + 144);
    CHECK_RELATIVE("... PBCP", measure.pbcp, 100, 4 * eps);
    CHECK_RELATIVE("... area a quarter um2 each", measure.bonded_area, (64 + 28 + 144) * 0.25, 64 * eps);
    for (i = 0; i < w.points.count; i++)
        if (w.points.x[0][i] > 0) w.points.user[0][i] = 9;
    mpm_bond_measure_pair(&b, &w, 1, 0, &measure);
    CHECK_EQUAL("... only of that pair", measure.contacted, (64 + 28 + 144) / 2);
    CHECK_EQUAL("a pair is two bodies", mpm_bond_measure_pair(&b, &w, 1, 1, &measure), MPM_ERR_ARGUMENT);
    b.partner = -1;
    CHECK_EQUAL("without partner no pairs", mpm_bond_measure_pair(&b, &w, 0, 1, &measure), MPM_ERR_ARGUMENT);
    mpm_free(&w);
}

/* The cube leaves the slab at 3 m/s; D is the same everywhere. Returns what the bond gives to the cube. */
static double held_by(double D, double width)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_bond b = mpm_bond_default(&u);
    mpm_world w = cube_on_slab(&m, 0);
    double impulse;
    int32_t i;
    b.width = (mpm_real)width;
    for (i = 0; i < w.points.count; i++) {
        w.points.bond[i] = (mpm_real)D;
        if (i < w.body[1].first) w.points.v[2][i] = 3;
    }
    find_contact(&w);
    mpm_bond_nodes(&b, &w);
    mpm_contact_apply(&w);
    impulse = mpm_interface_of(&w, 0, 1).impulse[2];
    mpm_free(&w);
    return impulse;
}

static void widths(void)
{
    const double whole = held_by(1.0001, 0);
    const mpm_units u = mpm_units_um_us_ng();
    mpm_bond b = mpm_bond_default(&u);
    CHECK_TRUE("held at D = 1 (A 4.7)", whole < 0);
    CHECK_NEAR("free below", held_by(0.9999, 0), 0, 0);
    CHECK_NEAR("width 1: free up to 1/2", held_by(0.5, 1), 0, 0);
    CHECK_RELATIVE("... a quarter at 3/4", held_by(0.75, 1), whole / 4, 64 * eps);
    CHECK_RELATIVE("... half at 1", held_by(1, 1), whole / 2, 64 * eps);
    CHECK_RELATIVE("... all beyond 3/2", held_by(1.75, 1), whole, 64 * eps);
    b.width = MPM_R(2.5);
    CHECK_EQUAL("a width beyond 2 would hold without any bond", mpm_bond_check(&b, NULL), MPM_ERR_ARGUMENT);
}

/* A disc of radius 2 um in rings, by both shape functions: its area is pi 2^2. */
static void rings(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_body_desc disc = scene_body(&m, mpm_cylinder(0, 0, 0, 2, 4), 0.5, 0);
    mpm_body_desc slab = scene_body(&m, mpm_cylinder(0, 0, -4, 6, 4), 0.5, 0);
    int gimp;
    for (gimp = 0; gimp < 2; gimp++) {
        mpm_desc d = scene_grid(1, 8, 8, 12, 0, 0, -6);
        mpm_world w;
        d.geometry = MPM_AXISYMMETRIC;
        d.basis = gimp ? MPM_GIMP : MPM_LINEAR;
        d.side[0] = MPM_SIDE_SYMMETRY;
        mpm_init(&w, &d, NULL, 0);
        mpm_body_add(&w, &disc);
        mpm_body_add(&w, &slab);
        find_contact(&w);
        CHECK_RELATIVE(gimp ? "area in rings, GIMP" : "area in rings, linear", mpm_interface_of(&w, 0, 1).area,
                       3.14159265358979 * 4, 1e3 * eps);
        mpm_free(&w);
    }
}

static mpm_real quarter(void *context, const mpm_world *w, int32_t point)
{
    (void)context;
    (void)w;
    (void)point;
    return MPM_R(0.25);
}

/* The point of a body at (x, 0.25, z). */
static int32_t point_at(const mpm_world *w, int32_t body, double x, double z)
{
    const mpm_points *p = &w->points;
    int32_t i;
    for (i = w->body[body].first; i < w->body[body].first + w->body[body].count; i++)
        if (fabs((double)p->x[0][i] - x) + fabs((double)p->x[1][i] - 0.25) + fabs((double)p->x[2][i] - z) < 0.01) break;
    return i;
}

/* Two cubes side by side on one slab: each bonds to the slab, and to its neighbour where they touch. */
static void partners(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 12, 12, 12, -6, -6, -6);
    mpm_body_desc left = scene_body(&m, mpm_box(-4, -2, 0, 0, 2, 4), 0.5, 0);
    mpm_body_desc right = scene_body(&m, mpm_box(0, -2, 0, 4, 2, 4), 0.5, 0);
    mpm_body_desc slab = scene_body(&m, mpm_box(-5, -5, -4, 5, 5, 0), 0.5, 0);
    mpm_bond b = mpm_bond_default(&u);
    mpm_bond_measure both, one, two;
    mpm_world w;
    d.user_fields = 2;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &left);
    mpm_body_add(&w, &right);
    mpm_body_add(&w, &slab);
    b.rule = MPM_BOND_USER;
    b.grow = quarter;
    b.partner = 1;
    find_contact(&w);
    mpm_bond_grow(&b, &w);
    CHECK_EQUAL("on the slab: partner the slab", w.points.user[1][point_at(&w, 0, -2.75, 0.25)], 3);
    CHECK_EQUAL("beside the neighbour: partner the neighbour", w.points.user[1][point_at(&w, 0, -0.25, 2.25)], 2);
    CHECK_EQUAL("under the right cube: partner that", w.points.user[1][point_at(&w, 2, 2.25, -0.25)], 2);
    CHECK_EQUAL("under the left cube: partner that", w.points.user[1][point_at(&w, 2, -2.25, -0.25)], 1);
    CHECK_EQUAL("at the edge of three: the one with most mass", w.points.user[1][point_at(&w, 0, -0.25, 0.25)], 3);
    CHECK_EQUAL("touching nothing: none", w.points.user[1][point_at(&w, 0, -3.75, 3.75)], 0);
    mpm_bond_measure_pair(&b, &w, 0, 1, &both);
    mpm_bond_measure_pair(&b, &w, 0, 2, &one);
    mpm_bond_measure_pair(&b, &w, 1, 2, &two);
    CHECK_TRUE("left and slab, left and right", one.contacted > 64 && both.contacted > 64);
    CHECK_NEAR("mean D of a pair", both.abp, 0.25, 4 * eps);
    CHECK_EQUAL("every grown point has one partner", both.contacted + one.contacted + two.contacted,
                mpm_bond_measure_body(&w, -1).contacted);
    mpm_free(&w);
}

/* A cube of 4 um at 12 on a slab. */
static void splat_scene(mpm_world *w, mpm_material *m)
{
    const mpm_desc d = scene_grid(1, 12, 12, 12, -6, -6, -6);
    const mpm_body_desc cube = scene_body(m, mpm_box(-2, -2, 0, 2, 2, 4), 0.5, 12);
    const mpm_body_desc slab = scene_body(m, mpm_box(-5, -5, -4, 5, 5, 0), 0.5, 2);
    mpm_init(w, &d, NULL, 0);
    mpm_body_add(w, &cube);
    mpm_body_add(w, &slab);
}

/* The cube on the slab, of which points are moved by hand. */
static void splats(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_rebound r;
    mpm_splat s;
    mpm_world w;
    int32_t i;
    splat_scene(&w, &m);
    s = mpm_splat_measure(&w, 0, 1, 60);
    CHECK_RELATIVE("a cube as it was: height", s.height, 4, 8 * eps);
    CHECK_RELATIVE("... top", s.top, 4, 8 * eps);
    CHECK_NEAR("... flattening", s.flattening, 0, 8 * eps);
    CHECK_NEAR("... crater", s.crater, 0, 16 * eps);
    for (i = 0; i < w.body[0].count; i++) { /* three quarters of the height, twice the width */
        w.points.x[2][i] *= MPM_R(0.75);
        w.points.x[0][i] *= 2;
        w.points.x[1][i] = 0;
    }
    w.points.x[2][0] = 5; /* ejected */
    w.points.v[0][0] = 61;
    for (i = w.body[1].first; i < w.points.count; i++) {
        if (!(w.points.flags[i] & MPM_FACE_TOP)) continue;
        if (w.points.x[0][i] < -4) w.points.x[2][i] += MPM_R(0.25);
        else w.points.x[2][i] -= MPM_R(1.5);
    }
    s = mpm_splat_measure(&w, 0, 1, 60);
    CHECK_RELATIVE("height: 0.75 * 3.5 + 0.5", s.height, 3.125, 16 * eps);
    CHECK_RELATIVE("top: 0.75 * 3.75 + 0.25, the ejected point left out", s.top, 3.0625, 16 * eps);
    CHECK_RELATIVE("flattening", s.flattening, 1 - 3.125 / 4, 64 * eps);
    CHECK_RELATIVE("width: 2 * 3.5 + 0.5, twice the lattice's", s.width, 7.5, 16 * eps);
    CHECK_RELATIVE("spread", s.spread, 7.5 / 4, 16 * eps);
    CHECK_RELATIVE("crater", s.crater, 1.5, 64 * eps);
    CHECK_RELATIVE("rim", s.rim, 0.25, 256 * eps);
    r = mpm_rebound_of(&w, 0, 60);
    CHECK_RELATIVE("rebound as seen from the ground", r.filtered, 12, 100 * eps);
    r = mpm_rebound_from(&w, 0, 1, 60);
    CHECK_RELATIVE("... from the moving slab", r.filtered, 10, 100 * eps);
    CHECK_EQUAL("... one point ejected", r.fast, 1);
    CHECK_RELATIVE("... of its mass", r.fast_mass, w.points.mass[0], 4 * eps);
    mpm_free(&w);
}

/* Against the formulas evaluated with 30 digits outside this program. */
static void literature(void)
{
    mpm_activation a;
    a.frequency = 1e13;
    a.time = 5e-8;
    a.energy = 3 * 1.602176634e-19;
    a.temperature = 900;
    a.atom_mass = 4.4804e-26;
    a.velocity = 810;
    CHECK_RELATIVE("bonded fraction (A 2.10)", mpm_bonded_fraction(&a, 0.04), 0.006776046111328383, 1e-12);
    CHECK_RELATIVE("relative strength (A 2.11)", mpm_relative_strength(&a, 0.5, 0.8), 1.211983984420970e-6, 1e-12);
    a.time = 1;
    CHECK_RELATIVE("all atoms bond in the end", mpm_bonded_fraction(&a, 0.04), 1, 1e-15);
    a.time = 0;
    CHECK_NEAR("none without contact", mpm_bonded_fraction(&a, 0.04), 0, 0);
    /* 667 - 14 * 2.7 + 0.08 * 660 + 0.1 * 110 - 0.4 * 20 */
    CHECK_NEAR("critical velocity of aluminium, 2003", mpm_critical_velocity_2003(2.7, 660, 110, 20), 685, 1e-9);
    /* 0.64 sqrt(900 * 640 + 16 * 110e6/2700), and with 1.4^-0.18 = 0.9412326 */
    CHECK_RELATIVE("... 2011, 10 um", mpm_critical_velocity_2011(10, 900, 933, 293, 110e6, 2700),
                   709.1742511671716, 1e-12);
    CHECK_RELATIVE("... 2011, 14 um", mpm_critical_velocity_2011(14, 900, 933, 293, 110e6, 2700),
                   667.4979132673243, 1e-12);
    CHECK_NEAR("... of a melt", mpm_critical_velocity_2011(14, 900, 933, 940, 110e6, 2700), 0, 0);
}

static void measures(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc ball = scene_body(&m, mpm_sphere(5, 5, 5, 2), 0.5, 20);
    mpm_bond_measure measure;
    mpm_rebound r;
    mpm_world w;
    int32_t i;
    int n = 0;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &ball);
    for (i = 0; i < w.points.count && n < 10; i++)
        if (w.points.flags[i] & MPM_POINT_SURFACE) w.points.bond[i] = n++ < 3 ? MPM_R(1.25) : MPM_R(0.25);
    measure = mpm_bond_measure_body(&w, 0);
    CHECK_NEAR("PBCP (A 5.1)", measure.pbcp, 30, 1e-12);
    CHECK_NEAR("ABP", measure.abp, (3 * 1.25 + 7 * 0.25) / 10, 1e-12);
    w.points.v[0][0] = 100;
    r = mpm_rebound_of(&w, 0, 60);
    CHECK_EQUAL("fast points are counted", r.fast, 1);
    CHECK_RELATIVE("rebound velocity, filtered", r.filtered, 20, 100 * eps);
    CHECK_RELATIVE("rebound velocity, mean", r.mean, 20, 100 * eps);
    mpm_free(&w);
}

/* A ball is one piece, and stays one when its points move within it, however fast; what lies two cells away is another,
   what lies in the next cell is not. Retired points are of none. */
static void pieces(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    static const mpm_geometry geometry[3] = {MPM_3D, MPM_PLANE_STRAIN, MPM_AXISYMMETRIC};
    int k;
    for (k = 0; k < 3; k++) {
        mpm_desc d = scene_grid(1, 12, geometry[k] == MPM_3D ? 12 : 1, 12, 0, 0, 0);
        mpm_body_desc ball = scene_body(&m, mpm_sphere(5, geometry[k] == MPM_3D ? 5 : 0, 5, 2), 0.5, 20);
        mpm_pieces r;
        mpm_world w;
        d.geometry = geometry[k];
        mpm_init(&w, &d, NULL, 0);
        CHECK_EQUAL("a ball", mpm_body_add(&w, &ball), MPM_OK);
        w.points.v[0][3] = 1000;
        CHECK_EQUAL("its pieces", mpm_pieces_of(&w, 0, &r), MPM_OK);
        CHECK_EQUAL("... one, however noisy", r.pieces, 1);
        CHECK_EQUAL("... nothing apart", r.apart, 0);
        w.points.x[2][0] = MPM_R(0.2);
        w.points.x[2][1] = MPM_R(0.4);
        w.points.x[0][1] = w.points.x[0][0];
        w.points.x[2][2] = MPM_R(11.5);
        mpm_pieces_of(&w, 0, &r);
        CHECK_EQUAL("two points below, one above: three pieces", r.pieces, 3);
        CHECK_EQUAL("... three points apart", r.apart, 3);
        CHECK_RELATIVE("... of their mass", r.mass, w.points.mass[0] + w.points.mass[1] + w.points.mass[2], 8 * eps);
        w.points.x[2][2] = MPM_R(7.1);
        mpm_pieces_of(&w, 0, &r);
        CHECK_EQUAL("in the next cell it belongs to the ball", r.pieces, 2);
        mpm_free(&w);
    }
}

/* Four fifths of the mass at 10, one fifth at 15: mean 11, standard deviation 5 sqrt(4/5 1/5) = 2. All sums are
   double. The variance 4 is a difference of two squares, 125 - 121, each from sums of 512 terms: it is known to
   512 * 1.1e-16 * (2 * 125 + 4 * 121), the deviation to 5e-12 of itself. */
static void noise(void)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_rebound r;
    mpm_world w;
    int32_t i;
    splat_scene(&w, &m);
    r = mpm_rebound_of(&w, 0, 60);
    CHECK_NEAR("all points move alike: no noise", r.noise, 0, 12 * sqrt(1024 * DBL_EPSILON));
    for (i = 0; i < w.body[0].count; i++) {
        w.points.v[2][i] = i % 2 ? 15 : 10;
        if (i % 2 == 0) w.points.mass[i] *= 4;
    }
    r = mpm_rebound_of(&w, 0, 60);
    CHECK_RELATIVE("two velocities: mean by mass", r.filtered, 11, 1e-12);
    CHECK_RELATIVE("... standard deviation by mass", r.noise, 2, 1e-11);
    w.points.v[2][0] = w.points.v[2][1] = 71; /* one of each is ejected: the rest in the same proportion */
    r = mpm_rebound_of(&w, 0, 60);
    CHECK_RELATIVE("... without what was ejected", r.noise, 2, 1e-11);
    CHECK_RELATIVE("... which counts in the mean: 60 more in 1 of 256", r.mean, 11 + 60.0 / 256, 1e-12);
    r = mpm_rebound_from(&w, 0, 1, 60);
    CHECK_RELATIVE("... and the same from the moving slab", r.noise, 2, 1e-11);
    mpm_free(&w);
}

/* Mass of the surface points of a body inside a radius whose D is at least that. */
static double mass_of(const mpm_world *w, int32_t body, double radius, double least)
{
    const mpm_points *p = &w->points;
    double sum = 0;
    int32_t i;
    for (i = w->body[body].first; i < w->body[body].first + w->body[body].count; i++)
        if ((p->flags[i] & MPM_POINT_SURFACE) && (double)p->x[0][i] < radius && (double)p->bond[i] >= least)
            sum += (double)p->mass[i];
    return sum;
}

/* Rings, which weigh more outside: a disc of radius 2 bonded all over its face and in contact one layer above, on a
   slab bonded up to radius 1, in contact up to 2, and from there to 3 bonded to a body that is neither. */
static void masses(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(1, u);
    mpm_desc d = scene_grid(1, 8, 8, 12, 0, 0, -6);
    mpm_body_desc disc = scene_body(&m, mpm_cylinder(0, 0, 0, 2, 4), 0.5, 0);
    mpm_body_desc slab = scene_body(&m, mpm_cylinder(0, 0, -4, 6, 4), 0.5, 0);
    const double layer = 0.5 * 3.14159265358979 * (double)m.density; /* of radius 1, a spacing thick */
    mpm_bond b = mpm_bond_default(&u);
    mpm_bond_measure one, two, all, pair;
    mpm_world w;
    int32_t i;
    d.geometry = MPM_AXISYMMETRIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    d.user_fields = 1;
    b.partner = 0;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &disc);
    mpm_body_add(&w, &slab);
    for (i = 0; i < w.points.count; i++) {
        const double x = (double)w.points.x[0][i], z = (double)w.points.x[2][i];
        if (i < w.body[1].first) w.points.bond[i] = z < 0.5 ? 1 : z < 1 ? MPM_R(0.5) : 0;
        else if (z > -0.5) w.points.bond[i] = x < 1 ? 1 : x < 2 ? MPM_R(0.5) : x < 3 ? 2 : 0;
        w.points.user[0][i] = i < w.body[1].first ? 2 : x < 2 ? 1 : 3;
    }
    one = mpm_bond_measure_body(&w, 0);
    two = mpm_bond_measure_body(&w, 1);
    all = mpm_bond_measure_body(&w, -1);
    CHECK_EQUAL("mass of a pair", mpm_bond_measure_pair(&b, &w, 0, 1, &pair), MPM_OK);
    CHECK_RELATIVE("mass bonded: the face of a disc", one.bonded_mass, 4 * layer, 64 * eps);
    CHECK_RELATIVE("... and of the slab", two.bonded_mass, (1 + 9 - 4) * layer, 64 * eps);
    CHECK_RELATIVE("... of the pair", pair.bonded_mass, (4 + 1) * layer, 64 * eps);
    CHECK_RELATIVE("... by points: disc", one.bonded_mass, mass_of(&w, 0, 9, 1), 1e-13);
    CHECK_RELATIVE("... slab", two.bonded_mass, mass_of(&w, 1, 9, 1), 1e-13);
    CHECK_RELATIVE("... all", all.bonded_mass, mass_of(&w, 0, 9, 1) + mass_of(&w, 1, 9, 1), 1e-13);
    CHECK_RELATIVE("... pair", pair.bonded_mass, mass_of(&w, 0, 9, 1) + mass_of(&w, 1, 2, 1), 1e-13);
    CHECK_TRUE("mass in contact: the wall's next layer too, not what is inside",
               one.contacted_mass > 4.1 * layer && one.contacted_mass < 7.9 * layer);
    CHECK_RELATIVE("... the face of the slab", two.contacted_mass, 9 * layer, 64 * eps);
    CHECK_RELATIVE("... by points: disc", one.contacted_mass, mass_of(&w, 0, 9, 0.5), 1e-13);
    CHECK_RELATIVE("... slab", two.contacted_mass, mass_of(&w, 1, 9, 0.5), 1e-13);
    CHECK_RELATIVE("... all", all.contacted_mass, mass_of(&w, 0, 9, 0.5) + mass_of(&w, 1, 9, 0.5), 1e-13);
    CHECK_RELATIVE("... pair", pair.contacted_mass, mass_of(&w, 0, 9, 0.5) + mass_of(&w, 1, 2, 0.5), 1e-13);
    mpm_free(&w);
}

int main(void)
{
    growth();
    faults();
    averages();
    rules();
    interface();
    widths();
    rings();
    partners();
    splats();
    literature();
    measures();
    noise();
    pieces();
    masses();
    return check_end();
}
