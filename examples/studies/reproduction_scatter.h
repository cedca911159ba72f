/* reproduction_scatter.h - where the scatter of the critical velocity comes from, and its steep fall with size.
   SPDX-License-Identifier: MIT */
#ifndef REPRODUCTION_SCATTER_H
#define REPRODUCTION_SCATTER_H

#include "reproduction_critical.h"

/* ---- where the scatter comes from ------------------------------------------------------------ */

/* How an impact began: the particle's surface points that are in contact (D > 0), a moment after the first touch. */
typedef struct touch {
    double gap; /* of the outer half of them to the other body, um: mean distance of the points less their spacing */
    double d;   /* mean D of all */
} touch;

/* Distance to the nearest point of the other body, um. */
static inline double touch_distance(const mpm_world *w, int32_t i)
{
    const mpm_body *b = &w->body[IMPACT_SUBSTRATE];
    const double r = study_radius(w, i), z = (double)w->points.x[2][i];
    double least = HUGE_VAL;
    int32_t j;
    for (j = b->first; j < b->first + b->active; j++)
        least = fmin(least, hypot(r - study_radius(w, j), z - (double)w->points.x[2][j]));
    return least;
}

/* Runs a case for `ns` nanoseconds. Returns 1, or 0 with a message. */
static inline int touch_after(impact_case c, double ns, touch *t, char *message, size_t n)
{
    impact run;
    mpm_status status = MPM_OK;
    const mpm_points *p = &run.world.points;
    const mpm_body *b;
    double inner, mass = 0;
    int32_t i;
    c.time = ns;
    t->gap = 0;
    if (!impact_begin(&run, &c, message, n)) return 0;
    while (status >= 0 && run.world.steps < run.steps) status = impact_step(&run);
    if (status < 0) mpm_io_fault_text(message, n, &run.world.fault);
    b = &run.world.body[IMPACT_PARTICLE];
    inner = study_median_radius(&run.world, 1e-12);
    for (i = b->first; status >= 0 && i < b->first + b->active; i++) {
        if (!(p->flags[i] & MPM_POINT_SURFACE) || !(p->bond[i] > 0) || study_radius(&run.world, i) < inner) continue;
        t->gap += (double)p->mass[i] * (touch_distance(&run.world, i) - c.spacing);
        mass += (double)p->mass[i];
    }
    t->gap = case_share(t->gap, mass);
    t->d = mpm_bond_measure_body(&run.world, IMPACT_PARTICLE).abp;
    mpm_free(&run.world);
    return status >= 0;
}

#define POSITIONS 8

/* One contact at eight positions of the grid: what is seen at the end of an impact at 810 m/s, the critical velocity,
   and how the contact began. As study_need. */
static inline int positions(work *w, int separation)
{
    static const double early = 2; /* ns */
    critical_range range = critical_budget(w);
    critical_outcome out;
    double value[2][STUDY_VALUES];
    char text[40];
    impact_case c = budget_case(w);
    touch t;
    int k, b, status;
    range.high = 1200;
    c.separation = separation;
    study_complete(&c, "thesis");
    w->s.early = 1;
    w->s.planned = w->s.done + 2 * POSITIONS + POSITIONS * critical_cost(&range);
    status = critical_repeat(w, c, VARY_GRID, "thesis", range, POSITIONS, &out);
    if (status <= 0) return status;
    w->s.early = 0;
    say(w, "%s\n\n| grid plane over the interface, um | rebound without bond, m/s | mean D | PBCP, %% | rebound, m/s | "
           "critical velocity, m/s | after %g ns: gap, um | mean D of the particle |\n"
           "|---|---|---|---|---|---|---|---|\n",
        separation ? "Contact where the points touch:" : "Contact where bodies share a node, as in source A:", early);
    for (k = 0; k < POSITIONS; k++) {
        c.offset = c.cell * k / POSITIONS;
        for (b = 0; b < 2; b++) {
            c.bond = b ? "energy" : "none";
            if ((status = study_need(&w->s, &c, value[b], w->message, sizeof w->message)) <= 0) return status;
        }
        if (!touch_after(c, early, &t, w->message, sizeof w->message)) return 0;
        say(w, "| %.3f | %.1f | %.3f | %.2f | %.1f | %s | %.2f | %.2f |\n", c.offset, value[0][STUDY_V_MEAN],
            value[1][STUDY_ABP], value[1][STUDY_PBCP], value[1][STUDY_V_MEAN],
            velocity_text(out.each[k], range.high, text, sizeof text), t.gap, t.d);
    }
    say(w, "\n");
    return 1;
}

/* The critical velocity of 14 um over grid positions, one choice of the method changed at a time. */
static inline int scatter(work *w)
{
    static const struct {
        const char *what;
        variation vary;
        const char *functions, *normal, *average, *substrate;
        int separation;
        double width, friction;
    } row[] = {{"as source A", VARY_GRID, "linear", "ranked", "mean", "thesis", 0, 0, 0},
               {"grid kept, start gap varied", VARY_GAP, "linear", "ranked", "mean", "thesis", 0, 0, 0},
               {"grid kept, time step varied", VARY_STEP, "linear", "ranked", "mean", "thesis", 0, 0, 0},
               {"GIMP", VARY_GRID, "gimp", "ranked", "mean", "thesis", 0, 0, 0},
               {"logistic normals", VARY_GRID, "linear", "logistic", "mean", "thesis", 0, 0, 0},
               {"GIMP, logistic normals", VARY_GRID, "gimp", "logistic", "mean", "thesis", 0, 0, 0},
               {"nodal D weighted with N", VARY_GRID, "linear", "ranked", "weighted", "thesis", 0, 0, 0},
               {"threshold softened, from D 0.5", VARY_GRID, "linear", "ranked", "mean", "thesis", 0, 1, 0},
               {"GIMP, logistic, weighted, softened", VARY_GRID, "gimp", "logistic", "weighted", "thesis", 0, 1, 0},
               {"contact where points touch", VARY_GRID, "linear", "ranked", "mean", "thesis", 1, 0, 0},
               {"GIMP, logistic, where points touch", VARY_GRID, "gimp", "logistic", "mean", "thesis", 1, 0, 0},
               {"friction 0.2", VARY_GRID, "linear", "ranked", "mean", "thesis", 0, 0, 0.2},
               {"substrate 70 x 35 um", VARY_GRID, "linear", "ranked", "mean", "large", 0, 0, 0}};
    const int rows = (int)(sizeof row / sizeof row[0]), times = budget_times(w);
    critical_range range = critical_budget(w);
    critical_outcome out;
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int k, status;
    say(w, "### Where the scatter comes from\n\n14 um at 810 m/s, %s um, axisymmetric, by the position of the grid: "
           "the rebound without bond, and with it mean D of the contacted points, PBCP, and the rebound; the critical "
           "velocity; and how the contact begins: the mean gap between the surfaces at the outer half of the "
           "particle's contacted points, and the mean D of all of them. A node is felt a cell away: the higher the "
           "highest plane that the substrate's top reaches, the wider the gap across which it slows the particle, and "
           "the less the surfaces are strained when they meet.\n\n", budget_grid(w));
    for (k = 0; k < 2; k++)
        if ((status = positions(w, k)) <= 0) return status;
    range.high = 1200;
    w->s.early = 1;
    w->s.planned = w->s.done + rows * times * critical_cost(&range);
    mpm_io_csv_begin(&t, data_file(w, "scatter.csv", path, sizeof path),
                     "choice,critical_velocity_m_s,lowest_m_s,highest_m_s,offsets,not_bonded_above", "scatter",
                     &w->fault);
    say(w, "Critical velocity of 14 um, rule \"thesis\", %d positions of the grid, %s um, one choice changed, or "
           "several as named. The pair G_c, Gdot_c is source A's throughout: a choice that moves the median would need "
           "its own.\n\n"
           "| choice | median, m/s | lowest - highest | not above | CPU s |\n|---|---|---|---|---|\n",
        times, budget_grid(w));
    for (k = 0; k < rows; k++) {
        impact_case c = budget_case(w);
        c.functions = row[k].functions;
        c.normal = row[k].normal;
        c.bond_average = row[k].average;
        c.separation = row[k].separation;
        c.bond_width = row[k].width;
        c.friction = row[k].friction;
        study_complete(&c, row[k].substrate);
        status = critical_repeat(w, c, row[k].vary, "thesis", range, times, &out);
        if (status <= 0) {
            mpm_io_csv_drop(&t);
            return status;
        }
        mpm_io_csv_text(&t, row[k].what);
        mpm_io_csv_real(&t, (mpm_real)out.spread.median);
        mpm_io_csv_real(&t, (mpm_real)out.spread.lowest);
        mpm_io_csv_real(&t, (mpm_real)out.spread.highest);
        mpm_io_csv_integer(&t, times);
        mpm_io_csv_integer(&t, out.lost);
        say(w, "| %s | ", row[k].what);
        say_spread(w, &out.spread, range.high);
        say(w, " | %d | %.0f |\n", out.lost, out.cpu);
    }
    say(w, "\n");
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

/* ---- the fall with size ------------------------------------------------------------------------ */

/* 14 and 30 um on one grid, and with as many cells across: what of the fall with size is the grid's. */
static inline int steep_fall(work *w)
{
    static const struct {
        const char *what;
        grid small, large;
        double length; /* the energy rule's for 30 um; 0: the cell */
        int times[2];  /* positions: 14, 30 um */
        int budgets;   /* bits */
    } row[] = {{"one grid", {1.5, 0.5}, {1.5, 0.5}, 0, {4, 4}, 1 << QUICK},
               {"as many cells across", {1.5, 0.5}, {1.5 * 15 / 7, 0.5 * 15 / 7}, 0, {4, 4}, 1 << QUICK},
               {"... and DCell kept", {1.5, 0.5}, {1.5 * 15 / 7, 0.5 * 15 / 7}, 1.5, {4, 4}, 1 << QUICK},
               {"one grid", {1, 0.25}, {1, 0.25}, 0, {8, 8}, 1 << DESK | 1 << FULL},
               {"as many cells across", {1, 0.25}, {2.142857, 0.535714}, 0, {8, 8}, 1 << DESK | 1 << FULL},
               {"... and DCell kept", {1, 0.25}, {2.142857, 0.535714}, 1, {8, 8}, 1 << DESK | 1 << FULL},
               {"one grid", {0.7, 0.175}, {0.7, 0.175}, 0, {8, 4}, 1 << DESK | 1 << FULL},
               {"as many cells across", {0.7, 0.175}, {1.5, 0.375}, 0, {8, 8}, 1 << DESK | 1 << FULL},
               {"... and DCell kept", {0.7, 0.175}, {1.5, 0.375}, 0.7, {8, 8}, 1 << DESK | 1 << FULL}};
    const critical_range range = critical_budget(w);
    critical_outcome out;
    int k, i, status;
    w->s.early = 1;
    w->s.planned = w->s.done + 6 * 16 * critical_cost(&range);
    say(w, "### The fall with size\n\nRule \"thesis\", source A's pair, axisymmetric: both sizes on one grid as in "
           "A-crit; 30 um on a grid as much coarser as it is larger; and so, with the energy rule's length left that "
           "of the small cell, where only the rate of straining tells the sizes apart.\n\n"
           "| 30 um has | 14 um: cell/spacing, um | median, m/s | lowest - highest | 30 um: cell/spacing, um "
           "| DCell, um | median, m/s | lowest - highest | fall, m/s |\n|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < (int)(sizeof row / sizeof row[0]); k++) {
        double median[2];
        if (!(row[k].budgets & 1 << w->budget)) continue;
        say(w, "| %s", row[k].what);
        for (i = 0; i < 2; i++) {
            const grid g = i ? row[k].large : row[k].small;
            impact_case c = study_case_default();
            c.diameter = i ? 30 : 14;
            c.cell = g.cell;
            c.spacing = g.spacing;
            c.bond_length = i ? row[k].length : 0;
            study_complete(&c, "thesis");
            status = critical_repeat(w, c, VARY_GRID, "thesis", range, row[k].times[i], &out);
            if (status <= 0) return status;
            median[i] = out.spread.median;
            say(w, " | %.3g/%.3g", g.cell, g.spacing);
            if (i) say(w, " | %.3g", row[k].length > 0 ? row[k].length : g.cell);
            say(w, " | ");
            say_spread(w, &out.spread, range.high);
        }
        if (median[1] < HUGE_VAL) say(w, " | %.0f |\n", median[0] - median[1]);
        else say(w, " | - |\n");
    }
    say(w, "\n");
    return 1;
}

/* Contact where the points touch, with GIMP and logistic normals, and G_c 1503.74 with the Gdot_c that brings 14 um
   near the experiment: what is left of the scatter, and the fall with size. */
static inline int points_touch(work *w)
{
    static const double diameter[2] = {14, 30};
    const int times[2] = {8, 4};
    const critical_range range = critical_budget(w);
    critical_outcome out;
    char number[40];
    int k, r, status;
    w->s.early = 1;
    w->s.planned = w->s.done + 12 * critical_cost(&range);
    say(w, "### Contact where the points touch\n\nWith GIMP, logistic normals, G_c 1503.74 J/m2 and Gdot_c 1.35e5 "
           "J/(m2 us); %s um, axisymmetric. Experiment: 810 m/s at 14 um, 770 at 30.\n\n"
           "| um | rule | positions | median, m/s | lowest - highest | on the plane | PBCP, %% | not above | CPU s "
           "|\n|---|---|---|---|---|---|---|---|---|\n", budget_grid(w));
    for (k = 0; k < 2; k++)
        for (r = 0; r < 2; r++) {
            impact_case c = budget_case(w);
            c.diameter = diameter[k];
            c.functions = "gimp";
            c.normal = "logistic";
            c.separation = 1;
            c.gdot = 1.35e5;
            study_complete(&c, "thesis");
            if ((status = critical_repeat(w, c, VARY_GRID, rule_names[r], range, times[k], &out)) <= 0) return status;
            say(w, "| %g | %s | %d | ", diameter[k], rule_names[r], times[k]);
            say_spread(w, &out.spread, range.high);
            say(w, " | %s", velocity_text(out.each[0], range.high, number, sizeof number));
            say(w, " | %s | %d | %.0f |\n", measure_text(out.spread.middle.pbcp, number, sizeof number), out.lost,
                out.cpu);
        }
    say(w, "\n");
    return 1;
}

#endif
