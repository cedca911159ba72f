/* rule.c - other readings of the bond rule, and impacts that were not calibrated on. SPDX-License-Identifier: MIT */
#include "reproduction.h"

/* ---- what the rule's constants mean ---------------------------------------------------------- */

/* Source A prints 2.271 without a power of ten that makes sense: every power, one position. */
int rate_unit(work *w)
{
    const grid g = budget_grid(w);
    critical_range range = budget_range(w);
    critical_outcome out;
    int power, status;
    range.low = 300;
    range.high = 1200;
    plan(w, 1, 8 * critical_cost(&range));
    say(w, "### The unit of Gdot_c\n\nSource A prints 2.271 for it. Critical velocity of 14 um with G_c 1503.74 J/m2 "
           "by what it may mean, rule \"thesis\", %g/%g um, axisymmetric, one position of the grid, between %.0f and "
           "%.0f m/s. Experiment: 810 m/s.\n\n"
           "| Gdot_c, J/(m2 us) | critical velocity, m/s | PBCP there, %% |\n|---|---|---|\n",
        g.cell, g.spacing, range.low, range.high);
    for (power = 0; power < 8; power++) {
        impact_case c = case_on(g);
        c.gdot = 2.271 * pow(10, power);
        if ((status = critical_repeat(w, c, VARY_GRID, "thesis", range, 1, &out)) <= 0) return status;
        say(w, "| 2.271e%d | %s", power,
            out.spread.middle.below > 0 || !(out.spread.median < HUGE_VAL) ? "" : "at most ");
        say_velocity(w, out.spread.median, range.high);
        say(w, " | ");
        say_measure(w, out.spread.middle.pbcp);
        say(w, " |\n");
    }
    say(w, "\n");
    return 1;
}

/* The second half of a row: one length (0: the cell) on one grid. As need. */
static int length_cells(work *w, grid g, double length, critical_outcome *out)
{
    const critical_range range = budget_range(w);
    impact_case c = case_on(g);
    int status;
    c.bond_length = length;
    status = critical_repeat(w, c, VARY_GRID, "thesis", range, budget_times(w), out);
    if (status <= 0) return status;
    say(w, " | ");
    say_spread(w, &out->spread, range.high);
    say(w, " | ");
    say_velocity(w, out->each[0], range.high);
    say(w, " | ");
    say_measure(w, out->spread.middle.pbcp);
    return 1;
}

/* The energy rule's length: the cell (DCell), or the same 1 um on every grid. */
int regularisation(work *w)
{
    static const grid grids[3] = {{1.5, 0.5}, {1.0, 0.25}, {0.7, 0.175}};
    const int count = w->budget == QUICK ? 2 : 3, times = budget_times(w);
    const critical_range range = budget_range(w);
    extremes median[2];
    critical_outcome out;
    int g, k, status;
    median[0] = median[1] = no_extremes;
    plan(w, 1, 2 * count * times * critical_cost(&range));
    say(w, "### With and without DCell\n\nCritical velocity of 14 um, rule \"thesis\", axisymmetric, %d positions of "
           "the grid (\"on the plane\": the interface on a grid plane): the energy rule with the cell as its length "
           "(A 4.16), and with 1 um on every grid.\n\n"
           "| cell/spacing, um | with DCell: median, m/s | lowest - highest | on the plane | PBCP at the median, %% "
           "| 1 um: median, m/s | lowest - highest | on the plane | PBCP at the median, %% |\n"
           "|---|---|---|---|---|---|---|---|---|\n", times);
    for (g = 0; g < count; g++) {
        say(w, "| %.3g/%.3g", grids[g].cell, grids[g].spacing);
        for (k = 0; k < 2; k++) { /* at 1 um the cell is that length */
            if ((status = length_cells(w, grids[g], k == 1 && g != 1 ? 1 : 0, &out)) <= 0) return status;
            widen(&median[k], out.spread.median);
        }
        say(w, " |\n");
    }
    for (k = 0; k < 2; k++)
        if (median[k].high < HUGE_VAL)
            say(w, "%sFrom the lowest to the highest median %s DCell: %.0f m/s.\n", k ? "" : "\n",
                k ? "without" : "with", median[k].high - median[k].low);
    say(w, "\n");
    return 1;
}

/* Other pairs G_c, Gdot_c: what they do to the fall with size and to PBCP at onset. */
int other_pairs(work *w)
{
    static const bond_pair pair[3] = {{500, 1.35e6}, {1503.74, 2.271e5}, {5000, 2.6e5}};
    critical_range range = budget_range(w);
    const grid g = {w->budget == FULL ? 1.0 : 1.5, w->budget == FULL ? 0.25 : 0.5};
    critical_outcome out;
    int p, k, status;
    range.high = 1400;
    plan(w, 1, 6 * 4 * critical_cost(&range));
    say(w, "### Other pairs\n\nRule \"stays\", %.3g/%.3g um, axisymmetric, four positions of the grid.\n\n"
           "| G_c, J/m2 | Gdot_c, J/(m2 us) | 14 um: median, m/s | lowest - highest | PBCP there, %% | 30 um: median, "
           "m/s | lowest - highest | PBCP there, %% |\n|---|---|---|---|---|---|---|---|\n", g.cell, g.spacing);
    for (p = 0; p < 3; p++) {
        say(w, "| %g | %.4g", pair[p].gc, pair[p].gdot);
        for (k = 0; k < 2; k++) {
            impact_case c = case_on(g);
            c.diameter = k ? 30 : 14;
            c.gc = pair[p].gc;
            c.gdot = pair[p].gdot;
            if ((status = critical_repeat(w, c, VARY_GRID, "stays", range, 4, &out)) <= 0) return status;
            say(w, " | ");
            say_spread(w, &out.spread, range.high);
            say(w, " | ");
            say_measure(w, out.spread.middle.pbcp);
        }
        say(w, " |\n");
    }
    say(w, "\n");
    return 1;
}

/* ---- impacts that were not calibrated on ----------------------------------------------------- */

typedef struct held_impact {
    double diameter, velocity;
    int bonds; /* in the experiment */
} held_impact;

/* At how many positions of the grid either rule says what the experiment does. As need. */
static int held_right(work *w, const held_impact *h, int pair, grid g, int times, int right[2])
{
    critical_rule rule = critical_rule_default();
    double value[STUDY_VALUES];
    impact_case c = case_on(g);
    int i, r, status;
    c.gc = pairs[pair].gc;
    c.gdot = pairs[pair].gdot;
    c.diameter = h->diameter;
    c.velocity = h->velocity;
    right[0] = right[1] = 0;
    for (i = 0; i < times; i++) {
        c.offset = c.cell * i / times;
        if ((status = need(w, c, value)) <= 0) return status;
        for (r = 0; r < 2; r++) {
            rule.name = rule_names[r];
            right[r] += critical_bonds(&rule, c.diameter, value) == h->bonds;
        }
    }
    return 1;
}

/* One pair and grid: a row for each impact. As need. */
static int held_rows(work *w, int pair, grid g, int times)
{
    static const held_impact impacts[4] = {{45, 550, 0}, {38, 780, 1}, {22, 752, 0}, {22, 1066, 1}};
    int k, right[2], status;
    for (k = 0; k < 4; k++) {
        const held_impact *h = &impacts[k];
        if ((status = held_right(w, h, pair, g, times, right)) <= 0) return status;
        say(w, "| %g um at %g m/s | %s | %s, %.3g/%.3g | %d of %d | %d of %d |\n", h->diameter, h->velocity,
            h->bonds ? "bonds" : "rebounds", pair == OWN_PAIR ? "own" : "source A's", g.cell, g.spacing, right[0],
            times, right[1], times);
    }
    return 1;
}

int held_out(work *w)
{
    static const grid fine = {0.7, 0.175};
    const int times = budget_times(w);
    int status;
    plan(w, 1, 4 * times + (w->budget == QUICK ? 0 : 2 * times));
    say(w, "### Impacts that were not calibrated on\n\nHow many positions of the grid come out as the experiment.\n\n"
           "| impact | experiment | pair, cell/spacing | right by rule \"thesis\" | right by rule \"stays\" |\n"
           "|---|---|---|---|---|\n");
    status = held_rows(w, SOURCE_PAIR, budget_grid(w), times);
    if (status > 0 && w->budget != QUICK) status = held_rows(w, OWN_PAIR, fine, times / 2);
    say(w, "\n");
    return status;
}
