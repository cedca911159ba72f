/* 64_search - what the searches make of finished runs, without any run: answers of a curve of velocities and their
   median, both rules, the substrates and tolerances of source A, the pairs of a sweep. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "calibration.h"
#include "check.h"

#include <float.h>

static critical_curve curve;

/* One more tested velocity. */
static void tested(double velocity, int bonds, double pbcp, double v_rest)
{
    critical_run *r = &curve.run[curve.runs++];
    r->velocity = velocity;
    r->bonds = bonds;
    r->value[STUDY_PBCP] = pbcp;
    r->value[STUDY_V_REST] = v_rest;
}

static void answers(void)
{
    critical_answer a;
    int first;
    tested(400, 1, 9, 0.1); /* of another offset */
    first = curve.runs;
    a = critical_read(&curve, first, 0.5);
    CHECK_TRUE("nothing tested: infinite", isinf(a.velocity) && a.velocity > 0);
    CHECK_NEAR("... with nothing under it", a.below, 0, 0);
    tested(500, 0, 1, 8);
    tested(600, 0, 2, 7);
    tested(550, 0, 3, 6);
    a = critical_read(&curve, first, 0.5);
    CHECK_TRUE("none bonds: infinite", isinf(a.velocity) && a.velocity > 0);
    CHECK_NEAR("... the highest that was tested under it", a.below, 600, 0);
    CHECK_TRUE("... no PBCP", isnan(a.pbcp));
    CHECK_TRUE("... no rebound", isnan(a.v_rest));
    CHECK_EQUAL("... none lost", a.lost, 0);
    CHECK_NEAR("... at its offset", a.offset, 0.5, 0);
    tested(700, 1, 6, 0.5);
    tested(800, 0, 4, 1.5);
    tested(900, 1, 8, -0.5);
    tested(850, 0, 4.5, 1.25);
    a = critical_read(&curve, first, 0.25);
    CHECK_NEAR("the lowest velocity that bonds", a.velocity, 700, 0);
    CHECK_NEAR("... the highest tested under it", a.below, 600, 0);
    CHECK_NEAR("... its PBCP", a.pbcp, 6, 0);
    CHECK_NEAR("... its rebound", a.v_rest, 0.5, 0);
    CHECK_EQUAL("... two above do not bond", a.lost, 2);
    CHECK_NEAR("... at its offset", a.offset, 0.25, 0);
    tested(650, 0, 4, 2);
    tested(675, 1, 5.5, 0.25);
    a = critical_read(&curve, first, 0.25);
    CHECK_NEAR("after two halvings", a.velocity, 675, 0);
    CHECK_NEAR("... under it", a.below, 650, 0);
    CHECK_NEAR("... PBCP", a.pbcp, 5.5, 0);
    CHECK_NEAR("... rebound", a.v_rest, 0.25, 0);
    CHECK_EQUAL("... lost", a.lost, 2);
    tested(450, 1, 7, -0.25);
    a = critical_read(&curve, first, 0.25);
    CHECK_NEAR("the range begins bonded", a.velocity, 450, 0);
    CHECK_NEAR("... nothing under it", a.below, 0, 0);
    CHECK_EQUAL("... all that did not bond is lost", a.lost, 6);
    CHECK_NEAR("from the start the other offset counts too", critical_read(&curve, 0, 0).velocity, 400, 0);
}

/* Fills in what a summary looks at: velocity and offset; from (velocity, offset) pairs. */
static void fill(critical_answer *a, int count, const double (*pair)[2])
{
    int k;
    memset(a, 0, (size_t)count * sizeof *a);
    for (k = 0; k < count; k++) {
        a[k].velocity = pair[k][0];
        a[k].offset = pair[k][1];
        a[k].lost = k;
    }
}

static void spreads(void)
{
    const double odd[5][2] = {{800, 0}, {HUGE_VAL, 0.2}, {700, 0.4}, {760, 0.6}, {740, 0.8}};
    const double even[4][2] = {{800, 0}, {760, 0.25}, {700, 0.5}, {740, 0.75}};
    const double split[2][2] = {{HUGE_VAL, 0}, {700, 0.5}}, never[2][2] = {{HUGE_VAL, 0.5}, {HUGE_VAL, 0}};
    const double same[3][2] = {{700, 0.75}, {700, 0.25}, {700, 0.5}};
    critical_answer a[5];
    critical_spread s;
    int k, sorted = 0;
    fill(a, 5, odd);
    s = critical_summary(a, 5);
    for (k = 1; k < 5; k++) sorted += a[k - 1].velocity < a[k].velocity;
    CHECK_EQUAL("answers in order", sorted, 4);
    CHECK_NEAR("... whole: their offsets with them", a[0].offset, 0.4, 0);
    CHECK_NEAR("median of five", s.median, 760, 0);
    CHECK_NEAR("... lowest", s.lowest, 700, 0);
    CHECK_TRUE("... highest: what never bonds", isinf(s.highest) && s.highest > 0);
    CHECK_EQUAL("... of which there is one", s.none, 1);
    CHECK_NEAR("... the answer in the middle", s.middle.velocity, 760, 0);
    CHECK_NEAR("... its offset", s.middle.offset, 0.6, 0);
    CHECK_EQUAL("... and the rest of it", s.middle.lost, 3);
    fill(a, 4, even);
    s = critical_summary(a, 4);
    CHECK_NEAR("median of four: between two", s.median, 750, 0);
    CHECK_NEAR("... the middle answer is the lower", s.middle.velocity, 740, 0);
    CHECK_NEAR("... lowest", s.lowest, 700, 0);
    CHECK_NEAR("... highest", s.highest, 800, 0);
    CHECK_EQUAL("... all bonded", s.none, 0);
    fill(a, 2, split);
    s = critical_summary(a, 2);
    CHECK_TRUE("median of a velocity and none: infinite", isinf(s.median) && s.median > 0);
    CHECK_NEAR("... the middle answer is the velocity", s.middle.velocity, 700, 0);
    CHECK_EQUAL("... none at one offset", s.none, 1);
    fill(a, 2, never);
    s = critical_summary(a, 2);
    CHECK_TRUE("never: all is infinite", isinf(s.median) && isinf(s.lowest) && isinf(s.highest));
    CHECK_EQUAL("... at both offsets", s.none, 2);
    CHECK_NEAR("... ordered by offset", s.middle.offset, 0, 0);
    fill(a, 3, same);
    s = critical_summary(a, 3);
    CHECK_NEAR("the same velocity thrice", s.median, 700, 0);
    CHECK_TRUE("... ordered by offset", a[0].offset < a[1].offset && a[1].offset < a[2].offset);
    s = critical_summary(a, 1);
    CHECK_NEAR("one alone is its median", s.median, 700, 0);
    CHECK_NEAR("... and its extremes", s.highest - s.lowest, 0, 0);
}

/* Whether a rule takes a run of these for bonded. */
static int thesis(const critical_rule *r, double diameter, double pbcp, double v_rest)
{
    double value[STUDY_VALUES] = {0};
    value[STUDY_PBCP] = pbcp;
    value[STUDY_V_REST] = v_rest;
    value[STUDY_V_LATE] = 50; /* only rule stays looks at it */
    return critical_bonds(r, diameter, value);
}

static int stays(const critical_rule *r, double v_late, double held_late)
{
    double value[STUDY_VALUES] = {0};
    value[STUDY_V_REST] = 50; /* only rule thesis looks at it */
    value[STUDY_V_LATE] = v_late;
    value[STUDY_HELD_LATE] = held_late;
    return critical_bonds(r, 14, value);
}

static void rules(void)
{
    critical_rule r = critical_rule_default();
    CHECK_TRUE("the rule is source A's unless told", !strcmp(r.name, "thesis"));
    CHECK_EQUAL("14 um at 4.8 % and 0.9 m/s", thesis(&r, 14, 4.8, 0.9), 1);
    CHECK_EQUAL("... less PBCP", thesis(&r, 14, 4.79, 0.9), 0);
    CHECK_EQUAL("... faster", thesis(&r, 14, 4.8, 0.91), 0);
    CHECK_EQUAL("... neither makes up for the other", thesis(&r, 14, 90, 0.91) + thesis(&r, 14, 4.79, 0), 0);
    CHECK_EQUAL("a smaller one", thesis(&r, 9, 4.8, 0.9), 1);
    CHECK_EQUAL("14.1 um at 5 % and 0.6 m/s", thesis(&r, 14.1, 5, 0.6), 1);
    CHECK_EQUAL("... less PBCP", thesis(&r, 14.1, 4.99, 0.6), 0);
    CHECK_EQUAL("... faster", thesis(&r, 14.1, 5, 0.61), 0);
    CHECK_EQUAL("30 um", thesis(&r, 30, 5, 0.6), 1);
    CHECK_EQUAL("... as much as would do for 14 um", thesis(&r, 30, 4.8, 0.6) + thesis(&r, 30, 5, 0.9), 0);
    CHECK_EQUAL("into the substrate is no rebound", thesis(&r, 30, 5, -7), 1);
    CHECK_EQUAL("what is not a number did not bond", thesis(&r, 30, NAN, 0) + thesis(&r, 30, 5, NAN), 0);
    r.pbcp = 3;
    CHECK_EQUAL("a PBCP of one's own", thesis(&r, 30, 3, 0.6), 1);
    CHECK_EQUAL("... less", thesis(&r, 30, 2.99, 0.6), 0);
    CHECK_EQUAL("... with source A's velocity", thesis(&r, 30, 3, 0.61), 0);
    CHECK_EQUAL("... for 14 um too", thesis(&r, 14, 3, 0.9) + thesis(&r, 14, 2.99, 0.9), 1);
    r.pbcp = 0;
    r.v_rest = 2;
    CHECK_EQUAL("a velocity of one's own", thesis(&r, 30, 5, 2), 1);
    CHECK_EQUAL("... faster", thesis(&r, 30, 5, 2.01), 0);
    CHECK_EQUAL("... with source A's PBCP", thesis(&r, 30, 4.99, 2), 0);
    CHECK_EQUAL("... for 14 um too", thesis(&r, 14, 4.8, 2) + thesis(&r, 14, 4.8, 2.01), 1);

    r = critical_rule_default();
    r.name = "stays";
    CHECK_EQUAL("stays: slow and held", stays(&r, 1.99, 0.01), 1);
    CHECK_EQUAL("... slow, not held", stays(&r, 1.99, 0), 0);
    CHECK_EQUAL("... held, too fast", stays(&r, 2, 1), 0);
    CHECK_EQUAL("... slow downwards", stays(&r, -1.99, 1), 1);
    CHECK_EQUAL("... drawn back by its bond", stays(&r, -2, 1), 1);
    CHECK_EQUAL("... slow downwards, not held", stays(&r, -1.99, 0), 0);
    CHECK_EQUAL("... at rest", stays(&r, 0, 1), 1);
    CHECK_EQUAL("... not a number", stays(&r, NAN, 1), 0);
    r.stays = 0.5;
    CHECK_EQUAL("... a velocity of one's own", stays(&r, 0.49, 1), 1);
    CHECK_EQUAL("... at that", stays(&r, 0.5, 1), 0);
    r.pbcp = CRITICAL_LEFT;
    CHECK_EQUAL("... with less of it bonded than has to be", stays(&r, 0.49, 1), 0);
}

static critical_range range(double low, double high, double scan, double step)
{
    critical_range r;
    r.low = low;
    r.high = high;
    r.scan = scan;
    r.step = step;
    return r;
}

static void ranges(void)
{
    critical_range r = critical_range_default();
    CHECK_EQUAL("500 to 1000 m/s by 50", critical_scans(&r), 11);
    CHECK_EQUAL("... and 25, 12.5, 6.25, 3.125", critical_cost(&r), 15);
    r = range(500, 680, 100, 50);
    CHECK_EQUAL("the end of a range between two", critical_scans(&r), 2);
    CHECK_EQUAL("... and one halving", critical_cost(&r), 3);
    r = range(700, 700, 50, 50);
    CHECK_EQUAL("one velocity", critical_scans(&r), 1);
    CHECK_EQUAL("... is one run", critical_cost(&r), 1);
    r = range(1.1, 1.4, 0.1, 0.1); /* (1.4 - 1.1)/0.1 = 2.999999999999998 */
    CHECK_EQUAL("the end of a range despite rounding", critical_scans(&r), 4);
    r = range(1, 1, 536870912, 1); /* log(2^29)/log(2) = 29.000000000000004 */
    CHECK_EQUAL("29 halvings despite rounding", critical_cost(&r), 30);
}

static impact_case completed(double diameter, const char *substrate)
{
    impact_case c = study_case_default();
    c.diameter = diameter;
    study_complete(&c, substrate);
    return c;
}

static void substrates(void)
{
    /* Table 5.3; half way between its sizes; in proportion beyond: diameter, width, height, time */
    static const double row[13][4] = {
        {14, 30, 10, 80}, {18, 36, 10, 80}, {22, 44, 10, 80}, {26, 46, 10, 80}, {30, 50, 10, 80},
        {16, 33, 10, 80}, {20, 40, 10, 80}, {24, 45, 10, 80}, {28, 48, 10, 80},
        {7, 15, 5, 80},   {3.5, 7.5, 2.5, 80}, {60, 100, 20, 160}, {45, 75, 15, 120}};
    impact_case c;
    char what[80];
    int k;
    for (k = 0; k < 13; k++) {
        c = completed(row[k][0], "thesis");
        snprintf(what, sizeof what, "substrate of %g um: width", row[k][0]);
        CHECK_RELATIVE(what, c.substrate_diameter, row[k][1], 4 * DBL_EPSILON);
        CHECK_RELATIVE("... height", c.substrate_height, row[k][2], 4 * DBL_EPSILON);
        CHECK_RELATIVE("... time", c.time, row[k][3], 4 * DBL_EPSILON);
        CHECK_NEAR("... the particle as it was", c.diameter, row[k][0], 0);
    }
    c = completed(17, "thesis");
    CHECK_RELATIVE("three quarters between 14 and 18 um", c.substrate_diameter, 34.5, 4 * DBL_EPSILON);
    c = completed(20, "large");
    CHECK_RELATIVE("large: 5 diameters wide", c.substrate_diameter, 100, 4 * DBL_EPSILON);
    CHECK_RELATIVE("... 2.5 high", c.substrate_height, 50, 4 * DBL_EPSILON);
    CHECK_RELATIVE("... time", c.time, 80, 4 * DBL_EPSILON);
    c = completed(60, "large");
    CHECK_RELATIVE("large, of 60 um: width", c.substrate_diameter, 300, 4 * DBL_EPSILON);
    CHECK_RELATIVE("... height", c.substrate_height, 150, 4 * DBL_EPSILON);
    CHECK_RELATIVE("... time", c.time, 160, 4 * DBL_EPSILON);
    for (k = 0; k < 2; k++) {
        const char *substrate = k ? "large" : "thesis";
        c = study_case_default();
        c.diameter = 60;
        c.substrate_diameter = 33;
        c.substrate_height = 12;
        c.time = 7;
        study_complete(&c, substrate);
        CHECK_NEAR("a width of one's own stays", c.substrate_diameter, 33, 0);
        CHECK_NEAR("... a height", c.substrate_height, 12, 0);
        CHECK_NEAR("... a time", c.time, 7, 0);
        c.substrate_diameter = 0;
        c.substrate_height = -12; /* refused later */
        study_complete(&c, substrate);
        CHECK_RELATIVE("one that is 0 is filled in", c.substrate_diameter, k ? 300 : 100, 4 * DBL_EPSILON);
        CHECK_NEAR("... the others stay, wrong ones too", c.substrate_height, -12, 0);
        CHECK_NEAR("... the time", c.time, 7, 0);
    }
}

/* The tolerances of a grid are these. */
static void tolerates(double cell, double spacing, const double *wanted)
{
    double pbcp[2] = {0, 0}, restitution[2] = {0, 0};
    char what[80];
    calibration_tolerances(cell, spacing, pbcp, restitution);
    snprintf(what, sizeof what, "grid %g/%g, 14 um: PBCP", cell, spacing);
    CHECK_NEAR(what, pbcp[0], wanted[0], 0);
    CHECK_NEAR("... restitution", restitution[0], wanted[1], 0);
    CHECK_NEAR("... 30 um: PBCP", pbcp[1], wanted[2], 0);
    CHECK_NEAR("... restitution", restitution[1], wanted[3], 0);
}

static void tolerances(void)
{
    static const double grid[9][2] = {{1.5, 0.5},  {1.5, 0.35}, {1.5, 0.3},   {1.0, 0.35}, {1.0, 0.25},
                                      {1.0, 0.2},  {0.7, 0.25}, {0.7, 0.175}, {0.7, 0.15}};
    static const double table[9][4] = {/* Table 5.2: 14 um, 30 um */
        {8.5, 0.0031, 8.1, 0.002}, {8.0, 0.003, 9.2, 0.002},  {8.5, 0.003, 9.2, 0.002},
        {6.0, 0.003, 8.1, 0.003},  {6.1, 0.0031, 8.3, 0.002}, {6.1, 0.003, 8.3, 0.002},
        {4.7, 0.006, 4.9, 0.007},  {4.6, 0.003, 5.3, 0.0031}, {4.8, 0.003, 5.3, 0.0031}};
    double pbcp[2] = {7, 0}, restitution[2] = {0, 0.01};
    int k;
    for (k = 0; k < 9; k++) tolerates(grid[k][0], grid[k][1], table[k]);
    tolerates(0.8, 0.2, table[7]);   /* between 0.7 and 1.0, between 0.175 and 0.25 */
    tolerates(0.9, 0.25, table[4]);  /* the cell counts first: not 0.7/0.25 */
    tolerates(1.2, 0.5, table[3]);   /* ... not 1.5/0.5 */
    tolerates(1.4, 0.33, table[1]);
    tolerates(0.5, 0.1, table[8]);   /* finer than any */
    tolerates(3, 1, table[0]);       /* coarser */
    calibration_tolerances(1.5, 0.5, pbcp, restitution);
    CHECK_NEAR("a PBCP of one's own stays", pbcp[0], 7, 0);
    CHECK_NEAR("... and leaves the other", pbcp[1], 8.1, 0);
    CHECK_NEAR("a restitution of one's own stays", restitution[1], 0.01, 0);
    CHECK_NEAR("... and leaves the other", restitution[0], 0.0031, 0);
    calibration_tolerances(0.7, 0.25, pbcp, restitution);
    CHECK_NEAR("what was filled in is one's own then", pbcp[1], 8.1, 0);
}

static void pairs(void)
{
    calibration q = calibration_default(); /* G_c 500 .. 10000, Gdot_c 1e5 .. 2e6 */
    const double third[2] = {100, 200};
    q.columns = 5;
    q.rows = 3;
    CHECK_NEAR("log: the low end", calibration_at(&q, q.gc, 0, 5), 500, 0);
    CHECK_NEAR("... 500 * 20^(1/4) to six digits", calibration_at(&q, q.gc, 1, 5), 1057.37, 0);
    CHECK_NEAR("... the middle, sqrt(500 * 10000)", calibration_at(&q, q.gc, 2, 5), 2236.07, 0);
    CHECK_NEAR("... 500 * 20^(3/4)", calibration_at(&q, q.gc, 3, 5), 4728.71, 0);
    CHECK_NEAR("... the high end", calibration_at(&q, q.gc, 4, 5), 10000, 0);
    CHECK_NEAR("... the middle of the rate, sqrt(2e11)", calibration_at(&q, q.gdot, 1, 3), 447214, 0);
    CHECK_NEAR("... one node is the low end", calibration_at(&q, q.gc, 0, 1), 500, 0);
    CHECK_NEAR("node 8 of five columns: G_c", calibration_gc(&q, 8), 4728.71, 0);
    CHECK_NEAR("... Gdot_c", calibration_gdot(&q, 8), 447214, 0);
    CHECK_NEAR("... of the last: G_c", calibration_gc(&q, 14), 10000, 0);
    CHECK_NEAR("... Gdot_c", calibration_gdot(&q, 14), 2e6, 0);
    q.scale = "linear";
    CHECK_NEAR("linear: the low end", calibration_at(&q, q.gc, 0, 5), 500, 0);
    CHECK_NEAR("... the middle", calibration_at(&q, q.gc, 2, 5), 5250, 0);
    CHECK_NEAR("... the high end", calibration_at(&q, q.gc, 4, 5), 10000, 0);
    CHECK_NEAR("... a third to six digits", calibration_at(&q, third, 1, 4), 133.333, 0);
    CHECK_NEAR("... two thirds", calibration_at(&q, third, 2, 4), 166.667, 0);
    CHECK_NEAR("... one node is the low end", calibration_at(&q, q.gdot, 0, 1), 1e5, 0);
}

/* Whether a sweep takes such a run of one size for bonded. */
static int bonds(const calibration *q, int size, double pbcp, double v_rest, double v_late, double held_late)
{
    double value[STUDY_VALUES] = {0};
    value[STUDY_PBCP] = pbcp;
    value[STUDY_V_REST] = v_rest;
    value[STUDY_V_LATE] = v_late;
    value[STUDY_HELD_LATE] = held_late;
    return calibration_bonds(q, size, value);
}

static void classes(void)
{
    calibration q = calibration_default();
    q.velocity[0] = 800;
    q.velocity[1] = 400;
    q.pbcp[0] = 6;
    q.pbcp[1] = 8;
    q.restitution[0] = 1.0 / 256; /* 3.125 m/s */
    q.restitution[1] = 1.0 / 512; /* 0.78125 m/s */
    CHECK_EQUAL("first size at its limits", bonds(&q, 0, 6, 3.125, 50, 0), 1);
    CHECK_EQUAL("... less PBCP", bonds(&q, 0, 5.99, 3.125, 50, 0), 0);
    CHECK_EQUAL("... faster", bonds(&q, 0, 6, 3.126, 50, 0), 0);
    CHECK_EQUAL("second size at its limits", bonds(&q, 1, 8, 0.78125, 50, 0), 1);
    CHECK_EQUAL("... less PBCP", bonds(&q, 1, 7.99, 0.78125, 50, 0), 0);
    CHECK_EQUAL("... faster", bonds(&q, 1, 8, 0.782, 50, 0), 0);
    CHECK_EQUAL("... into the substrate is no rebound", bonds(&q, 1, 8, -7, 50, 0), 1);
    CHECK_EQUAL("... not a number", bonds(&q, 1, 8, NAN, 50, 0) + bonds(&q, 1, NAN, 0, 50, 0), 0);
    q.rule = "stays";
    CHECK_EQUAL("rule stays: slow and held, whatever the PBCP", bonds(&q, 0, 0, 50, 1.99, 0.1), 1);
    CHECK_EQUAL("... downwards", bonds(&q, 1, 0, 50, -1.99, 0.1), 1);
    CHECK_EQUAL("... not held", bonds(&q, 0, 9, 0, 0, 0), 0);
    CHECK_EQUAL("... too fast", bonds(&q, 0, 9, 0, 2, 1), 0);
    q.stays = 1;
    CHECK_EQUAL("... a velocity of one's own", bonds(&q, 0, 0, 50, 0.99, 0.1), 1);
    CHECK_EQUAL("... at that", bonds(&q, 0, 0, 50, 1, 0.1), 0);
    q.base.method = "surface";
    CHECK_EQUAL("... on surfaces a tenth has to be bonded", bonds(&q, 0, 9.9, 50, 0.99, 0.1), 0);
    CHECK_EQUAL("... and is", bonds(&q, 0, 10, 50, 0.99, 0.1), 1);
}

int main(void)
{
    answers();
    spreads();
    rules();
    ranges();
    substrates();
    tolerances();
    pairs();
    classes();
    return check_end();
}
