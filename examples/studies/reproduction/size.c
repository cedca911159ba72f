/* size.c - the steep fall of the critical velocity with size. SPDX-License-Identifier: MIT */
#include "reproduction.h"

/* ---- the fall with size ------------------------------------------------------------------------ */

/* 14 and 30 um, each on a grid of its own. */
typedef struct fall {
    const char *what;
    grid g[2];
    double length; /* the energy rule's for 30 um; 0: the cell */
    int times[2];  /* positions */
    int budgets;   /* bits */
} fall;

#define FALLS 9
static const fall falls[FALLS] = {
    {"one grid", {{1.5, 0.5}, {1.5, 0.5}}, 0, {4, 4}, 1 << QUICK},
    {"as many cells across", {{1.5, 0.5}, {1.5 * 15 / 7, 0.5 * 15 / 7}}, 0, {4, 4}, 1 << QUICK},
    {"... and DCell kept", {{1.5, 0.5}, {1.5 * 15 / 7, 0.5 * 15 / 7}}, 1.5, {4, 4}, 1 << QUICK},
    {"one grid", {{1, 0.25}, {1, 0.25}}, 0, {8, 8}, 1 << DESK | 1 << FULL},
    {"as many cells across", {{1, 0.25}, {2.142857, 0.535714}}, 0, {8, 8}, 1 << DESK | 1 << FULL},
    {"... and DCell kept", {{1, 0.25}, {2.142857, 0.535714}}, 1, {8, 8}, 1 << DESK | 1 << FULL},
    {"one grid", {{0.7, 0.175}, {0.7, 0.175}}, 0, {8, 4}, 1 << DESK | 1 << FULL},
    {"as many cells across", {{0.7, 0.175}, {1.5, 0.375}}, 0, {8, 8}, 1 << DESK | 1 << FULL},
    {"... and DCell kept", {{0.7, 0.175}, {1.5, 0.375}}, 0.7, {8, 8}, 1 << DESK | 1 << FULL}};

/* A row of the table. As need. */
static int fall_row(work *w, const fall *f, critical_range range)
{
    critical_outcome out;
    double median[2];
    int i, status;
    say(w, "| %s", f->what);
    for (i = 0; i < 2; i++) {
        impact_case c = case_on(f->g[i]);
        c.diameter = i ? 30 : 14;
        c.bond_length = i ? f->length : 0;
        if ((status = critical_repeat(w, c, VARY_GRID, "thesis", range, f->times[i], &out)) <= 0) return status;
        median[i] = out.spread.median;
        say(w, " | %.3g/%.3g", c.cell, c.spacing);
        if (i) say(w, " | %.3g", f->length > 0 ? f->length : c.cell);
        say(w, " | ");
        say_spread(w, &out.spread, range.high);
    }
    if (median[1] < HUGE_VAL) say(w, " | %.0f |\n", median[0] - median[1]);
    else say(w, " | - |\n");
    return 1;
}

/* 14 and 30 um on one grid, and with as many cells across: what of the fall with size is the grid's. */
int steep_fall(work *w)
{
    const critical_range range = budget_range(w);
    int k, status;
    plan(w, 1, 6 * 16 * critical_cost(&range));
    say(w, "### The fall with size\n\nRule \"thesis\", source A's pair, axisymmetric: both sizes on one grid as in "
           "A-crit; 30 um on a grid as much coarser as it is larger; and so, with the energy rule's length left that "
           "of the small cell, where only the rate of straining tells the sizes apart.\n\n"
           "| 30 um has | 14 um: cell/spacing, um | median, m/s | lowest - highest | 30 um: cell/spacing, um "
           "| DCell, um | median, m/s | lowest - highest | fall, m/s |\n|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < FALLS; k++) {
        if (!(falls[k].budgets & 1 << w->budget)) continue;
        if ((status = fall_row(w, &falls[k], range)) <= 0) return status;
    }
    say(w, "\n");
    return 1;
}

/* ---- contact where the points touch ---------------------------------------------------------- */

/* One size by one rule. As need. */
static int touch_row(work *w, double diameter, const char *rule_name, int times)
{
    const critical_range range = budget_range(w);
    critical_outcome out;
    impact_case c = case_on(budget_grid(w));
    int status;
    c.diameter = diameter;
    c.functions = "gimp";
    c.normal = "logistic";
    c.touch = 1;
    c.gdot = 1.35e5;
    if ((status = critical_repeat(w, c, VARY_GRID, rule_name, range, times, &out)) <= 0) return status;
    say(w, "| %g | %s | %d | ", diameter, rule_name, times);
    say_spread(w, &out.spread, range.high);
    say(w, " | ");
    say_velocity(w, out.each[0], range.high);
    say(w, " | ");
    say_measure(w, out.spread.middle.pbcp);
    say(w, " | %d | %.0f |\n", out.lost, out.cpu);
    return 1;
}

/* With GIMP and logistic normals, and G_c 1503.74 with the Gdot_c that brings 14 um near the experiment: what is left
   of the scatter, and the fall with size. */
int points_touch(work *w)
{
    static const double diameter[2] = {14, 30};
    static const int times[2] = {8, 4};
    const critical_range range = budget_range(w);
    const grid g = budget_grid(w);
    int k, status;
    plan(w, 1, 12 * critical_cost(&range));
    say(w, "### Contact where the points touch\n\nWith GIMP, logistic normals, G_c 1503.74 J/m2 and Gdot_c 1.35e5 "
           "J/(m2 us); %g/%g um, axisymmetric. Experiment: 810 m/s at 14 um, 770 at 30.\n\n"
           "| um | rule | positions | median, m/s | lowest - highest | on the plane | PBCP, %% | not above | CPU s "
           "|\n|---|---|---|---|---|---|---|---|---|\n", g.cell, g.spacing);
    for (k = 0; k < 4; k++)
        if ((status = touch_row(w, diameter[k / 2], rule_names[k % 2], times[k / 2])) <= 0) return status;
    say(w, "\n");
    return 1;
}
