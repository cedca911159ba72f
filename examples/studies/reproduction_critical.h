/* reproduction_critical.h - the critical velocity by size, other readings of the bond rule, and impacts that were
   not calibrated on. SPDX-License-Identifier: MIT */
#ifndef REPRODUCTION_CRITICAL_H
#define REPRODUCTION_CRITICAL_H

#include "reproduction.h"

/* ---- one search, repeated -------------------------------------------------------------------- */

/* What differs between the repetitions: all that a threshold worth its name would not notice. */
typedef enum variation {
    VARY_GRID, /* height of a grid plane over the interface, in equal parts of a cell */
    VARY_GAP,  /* that of the particle at the start; the substrate's face stays on a grid plane */
    VARY_STEP  /* time step, down to 9/10 */
} variation;

#define REPEATS 16

typedef struct critical_outcome {
    critical_spread spread;
    double each[REPEATS]; /* in order; the first: a grid plane on the interface */
    int lost;   /* tested velocities above the critical one that do not bond, all repetitions together */
    double cpu; /* s */
} critical_outcome;

/* As study_need. */
static inline int critical_repeat(work *w, impact_case c, variation vary, const char *rule_name, critical_range range,
                                  int times, critical_outcome *out)
{
    static critical_curve curve;
    critical_answer a[REPEATS];
    critical_rule rule = critical_rule_default();
    int k, status;
    rule.name = rule_name;
    curve.runs = 0;
    out->lost = 0;
    out->cpu = 0;
    for (k = 0; k < times; k++) {
        impact_case one = c;
        const double part = (double)k / times;
        if (vary == VARY_GRID) one.offset = c.cell * k / times;
        if (vary == VARY_GAP) one.gap = c.cell * part;
        if (vary == VARY_STEP) one.dt_factor = c.dt_factor * (1 - 0.1 * part);
        status = critical_search(&w->s, &one, &range, &rule, &curve, &a[k], w->message, sizeof w->message);
        if (status <= 0) return status;
        out->lost += a[k].lost;
        out->each[k] = a[k].velocity;
    }
    for (k = 0; k < curve.runs; k++) out->cpu += curve.run[k].value[STUDY_CPU];
    out->spread = critical_summary(a, times);
    return 1;
}

/* "753 | 725 - 938" */
static inline void say_spread(work *w, const critical_spread *s, double high)
{
    char text[3][40];
    say(w, "%s | %s - %s", velocity_text(s->median, high, text[0], sizeof text[0]),
        velocity_text(s->lowest, high, text[1], sizeof text[1]),
        velocity_text(s->highest, high, text[2], sizeof text[2]));
}

/* 500 to 1000 m/s by 100, then halved. */
static inline critical_range critical_budget(const work *w)
{
    critical_range r = critical_range_default();
    if (w->budget != FULL) r.scan = 100, r.step = 10;
    return r;
}

static inline int budget_times(const work *w) { return w->budget == QUICK ? 4 : 8; }

/* Source A's impact of 14 um on the budget's grid in axisymmetry. */
static inline impact_case budget_case(const work *w)
{
    impact_case c = study_case_default();
    if (w->budget == QUICK) c.cell = 1.5, c.spacing = 0.5;
    return c;
}

static inline const char *budget_grid(const work *w) { return w->budget == QUICK ? "1.5/0.5" : "1/0.25"; }

/* ---- A-crit -------------------------------------------------------------------------------- */

#define SIZES 5
static const double sizes[SIZES] = {14, 18, 22, 26, 30};
static const double said_critical[SIZES] = {824, 809, 791, 776, 761};

/* The bond's pair: source A's, and the one at which A-cal's edges of both sizes fall together at 0.7/0.175 um (the
   middle of the step, in ratio, between the last Gdot_c that bonds and the first that does not). */
typedef struct bond_pair {
    double gc, gdot; /* J/m2, J/(m2 us) */
} bond_pair;

enum { SOURCE_PAIR, OWN_PAIR };
static const bond_pair pairs[2] = {{1503.74, 2.271e5}, {2236.07, 2.8e5}};

/* A way to find the critical velocities: which sizes at how many positions of the grid (0: not), and on which
   budgets (bits). */
typedef struct critical_setting {
    double cell, spacing;
    int pair;
    const char *geometry, *substrate, *name;
    int times[SIZES], budgets;
} critical_setting;

#define SETTINGS 10
static const critical_setting settings[SETTINGS] = {
    {1.5, 0.5, SOURCE_PAIR, "axisymmetric", "thesis", "1.5/0.5", {4, 4, 4, 4, 4}, 1 << QUICK},
    {1.0, 0.25, SOURCE_PAIR, "axisymmetric", "thesis", "1/0.25", {8, 8, 8, 8, 8}, 1 << DESK | 1 << FULL},
    {0.7, 0.175, SOURCE_PAIR, "axisymmetric", "thesis", "0.7/0.175", {8, 4, 4, 4, 4}, 1 << DESK},
    {0.7, 0.175, OWN_PAIR, "axisymmetric", "thesis", "0.7/0.175, own pair", {8, 4, 4, 4, 4}, 1 << DESK},
    {0.7, 0.175, SOURCE_PAIR, "axisymmetric", "thesis", "0.7/0.175", {8, 8, 8, 8, 8}, 1 << FULL},
    {0.7, 0.175, OWN_PAIR, "axisymmetric", "thesis", "0.7/0.175, own pair", {8, 8, 8, 8, 8}, 1 << FULL},
    {1.0, 0.25, SOURCE_PAIR, "axisymmetric", "large", "1/0.25, large substrate", {8, 0, 0, 0, 2}, 1 << DESK},
    {1.0, 0.25, SOURCE_PAIR, "axisymmetric", "large", "1/0.25, large substrate", {8, 8, 8, 8, 8}, 1 << FULL},
    {0.7, 0.175, SOURCE_PAIR, "3d", "thesis", "0.7/0.175, 3D", {1, 0, 0, 0, 0}, 1 << DESK},
    {0.7, 0.175, SOURCE_PAIR, "3d", "thesis", "0.7/0.175, 3D", {8, 8, 8, 8, 8}, 1 << FULL}};

/* One size by one setting and rule: a row of the table and of the file. As study_need. */
static inline int critical_row(work *w, mpm_io_csv *t, const critical_setting *g, int size, const char *rule_name,
                               critical_outcome *out)
{
    critical_range range = critical_budget(w);
    impact_case c = study_case_default();
    char difference[40] = "-", first[40], pbcp[40];
    int status;
    c.diameter = sizes[size];
    c.cell = g->cell;
    c.spacing = g->spacing;
    c.geometry = g->geometry;
    c.gc = pairs[g->pair].gc;
    c.gdot = pairs[g->pair].gdot;
    study_complete(&c, g->substrate);
    if (!strcmp(g->geometry, "3d") && w->budget == DESK) { /* a spot check: halving alone */
        range.low = 600;
        range.scan = 400;
        range.step = 25;
    }
    w->s.planned = w->s.done + g->times[size] * critical_cost(&range);
    status = critical_repeat(w, c, VARY_GRID, rule_name, range, g->times[size], out);
    if (status <= 0) return status;
    mpm_io_csv_real(t, (mpm_real)c.diameter);
    mpm_io_csv_real(t, (mpm_real)out->spread.median);
    mpm_io_csv_real(t, (mpm_real)out->spread.lowest);
    mpm_io_csv_real(t, (mpm_real)out->spread.highest);
    mpm_io_csv_integer(t, g->times[size]);
    mpm_io_csv_real(t, (mpm_real)out->spread.middle.pbcp);
    mpm_io_csv_real(t, (mpm_real)out->spread.middle.v_rest);
    mpm_io_csv_real(t, (mpm_real)c.cell);
    mpm_io_csv_real(t, (mpm_real)c.spacing);
    mpm_io_csv_text(t, c.geometry);
    mpm_io_csv_real(t, (mpm_real)c.substrate_diameter);
    mpm_io_csv_real(t, (mpm_real)c.substrate_height);
    mpm_io_csv_real(t, (mpm_real)c.gc);
    mpm_io_csv_real(t, (mpm_real)c.gdot);
    mpm_io_csv_text(t, rule_name);
    if (out->spread.median < HUGE_VAL)
        snprintf(difference, sizeof difference, "%+.0f", out->spread.median - said_critical[size]);
    say(w, "| %g | %s | %s, %g x %g | %d | %.0f | ", sizes[size], rule_name, g->name, c.substrate_diameter,
        c.substrate_height, g->times[size], said_critical[size]);
    say_spread(w, &out->spread, range.high);
    say(w, " | %s | %s | %s | %d | %.0f |\n", difference, velocity_text(out->each[0], range.high, first, sizeof first),
        measure_text(out->spread.middle.pbcp, pbcp, sizeof pbcp), out->lost, out->cpu);
    return 1;
}

typedef struct critical_line {
    mpm_real x[REPEATS], y[REPEATS];
    size_t count;
    char name[60];
} critical_line;

static inline void critical_point(critical_line *l, double x, double v)
{
    if (!(v < HUGE_VAL)) return;
    l->x[l->count] = (mpm_real)x;
    l->y[l->count++] = (mpm_real)v;
}

/* Critical velocity over the position of the grid, by size, as a file. */
static inline int position_table(work *w, const critical_line *size)
{
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    size_t i;
    int k;
    mpm_io_csv_begin(&t, data_file(w, "position.csv", path, sizeof path),
                     "diameter_um,grid_plane_over_interface_cells,critical_velocity_m_s",
                     "A-crit; positions at which nothing bonded are left out", &w->fault);
    for (k = 0; k < SIZES; k++)
        for (i = 0; i < size[k].count; i++) {
            mpm_io_csv_real(&t, (mpm_real)sizes[k]);
            mpm_io_csv_real(&t, size[k].x[i]);
            mpm_io_csv_real(&t, size[k].y[i]);
        }
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

/* The same as a picture, a curve per size. */
static inline int position_plot(work *w, const critical_line *size)
{
    mpm_draw_curve line[SIZES];
    mpm_draw_plot_desc d = mpm_draw_plot_desc_default();
    char path[MPM_IO_PATH];
    int k;
    memset(line, 0, sizeof line);
    for (k = 0; k < SIZES; k++) {
        line[k].x = size[k].x;
        line[k].y = size[k].y;
        line[k].count = size[k].count;
        line[k].mark = MPM_DRAW_CURVE;
        line[k].color = k;
        line[k].name = size[k].name;
    }
    d.curves = line;
    d.curve_count = SIZES;
    d.title = "critical velocity over the position of the grid";
    d.x_label = "height of a grid plane over the interface, cells";
    d.y_label = "m/s";
    return study_plots(data_file(w, "position.png", path, sizeof path), &d, 1, 1, "A-crit", &w->fault) || failed(w);
}

/* Critical velocities over size: by setting, source A's, the experiment. */
static inline int critical_plot(work *w, const critical_line *ours, int count)
{
    static const mpm_real two_sizes[2] = {14, 30}, measured[2] = {810, 770};
    mpm_real x[SIZES], said[SIZES];
    mpm_draw_curve line[SETTINGS + 3];
    mpm_draw_plot_desc d = mpm_draw_plot_desc_default();
    char path[MPM_IO_PATH];
    int k;
    memset(line, 0, sizeof line);
    for (k = 0; k < SIZES; k++) {
        x[k] = (mpm_real)sizes[k];
        said[k] = (mpm_real)said_critical[k];
    }
    for (k = 0; k < count + 2; k++) {
        const int own = k < count;
        line[k].x = own ? ours[k].x : k == count ? x : two_sizes;
        line[k].y = own ? ours[k].y : k == count ? said : measured;
        line[k].count = own ? ours[k].count : k == count ? SIZES : 2;
        line[k].mark = own && ours[k].count > 1 ? MPM_DRAW_CURVE : !own && k == count ? MPM_DRAW_DASHED : MPM_DRAW_DOTS;
        line[k].color = k;
        line[k].name = own ? ours[k].name : k == count ? "source A" : "experiment";
    }
    d.curves = line;
    d.curve_count = count + 2;
    d.title = "critical velocity, rule of source A, median over grid positions";
    d.window[2] = 500; /* with room for the legend */
    d.window[3] = 1150;
    d.x_label = "particle diameter, um";
    d.y_label = "m/s";
    return study_plots(data_file(w, "critical_velocity.png", path, sizeof path), &d, 1, 1, "A-crit", &w->fault) ||
           failed(w);
}

/* The table, and the curves of both pictures: by setting over size (medians; the last one the own pair's on a grid
   plane), and of the first setting by size over the position of the grid. As study_need. */
static inline int critical_rows(work *w, mpm_io_csv *t, critical_line *setting, int *count, critical_line *size)
{
    static critical_line plane; /* the own pair's, with the interface on a grid plane */
    critical_outcome out;
    int g, r, k, i, status;
    *count = 0;
    plane.count = 0;
    for (g = 0; g < SETTINGS; g++) {
        if (!(settings[g].budgets & 1 << w->budget)) continue;
        setting[*count].count = 0;
        snprintf(setting[*count].name, sizeof setting[*count].name, "%s", settings[g].name);
        for (r = 0; r < 2; r++)
            for (k = 0; k < SIZES; k++) {
                if (settings[g].times[k] == 0) continue;
                if ((status = critical_row(w, t, &settings[g], k, rule_names[r], &out)) <= 0) return status;
                if (r > 0) continue;
                critical_point(&setting[*count], sizes[k], out.spread.median);
                if (settings[g].pair == OWN_PAIR) {
                    critical_point(&plane, sizes[k], out.each[0]);
                    snprintf(plane.name, sizeof plane.name, "%.40s, on a grid plane", settings[g].name);
                }
                if (*count > 0) continue;
                size[k].count = 0;
                snprintf(size[k].name, sizeof size[k].name, "%g um", sizes[k]);
                for (i = 0; i < settings[g].times[k]; i++)
                    critical_point(&size[k], (double)i / settings[g].times[k], out.each[i]);
            }
        ++*count;
    }
    if (plane.count > 0) setting[(*count)++] = plane;
    return 1;
}

static inline int critical(work *w)
{
    const critical_range range = critical_budget(w);
    static critical_line setting[SETTINGS + 1], size[SIZES];
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int count, k, status;
    w->s.early = 1;
    mpm_io_csv_begin(&t, data_file(w, "critical_velocity.csv", path, sizeof path),
                     "diameter_um,critical_velocity_m_s,lowest_m_s,highest_m_s,offsets,pbcp_percent,v_rest_m_s,cell_um,"
                     "spacing_um,geometry,substrate_diameter_um,substrate_height_um,gc,gdot,rule",
                     "A-crit", &w->fault);
    say(w, "### A-crit: critical velocity\n\nG_c 1503.74 J/m2, Gdot_c 2.271e5 J/(m2 us), as source A, and an own pair, "
           "%.2f and %.4g, at which both sizes of A-cal just bond at 0.7/0.175 um, the interface on a grid plane; "
           "axisymmetric unless 3D is said, time step factor 0.2. Median and extremes over so many positions of the "
           "grid in the cell of the lowest velocity found to bond, by steps of %.0f between %.0f and %.0f m/s and "
           "halving to %.0f m/s (3D at the desk budget: one position, halved between 600 and 1000 m/s). Rule "
           "\"thesis\": PBCP at least 5.0 %% and rebound at most 0.6 m/s, 4.8 %% and 0.9 m/s at 14 um, relative to the "
           "substrate; \"stays\": late mean velocity under 2 m/s and the bond at work. \"Not above\": tested "
           "velocities above the critical one that do not bond, all positions together. \"On the plane\": the "
           "interface on a grid plane. Source A ran one position, not stated, at 0.7/0.175. Experiment: 810 m/s "
           "(14 um), 770 (30 um).\n\n"
           "| um | rule | cell/spacing, substrate, um | positions | source A | here | lowest - highest | difference "
           "| on the plane | PBCP, %% | not above | CPU s |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        pairs[OWN_PAIR].gc, pairs[OWN_PAIR].gdot, range.scan, range.low, range.high, range.step);
    status = critical_rows(w, &t, setting, &count, size);
    if (status <= 0) {
        mpm_io_csv_drop(&t);
        return status;
    }
    say(w, "\n![Critical velocity](data/critical_velocity.png) ![By position](data/position.png)\n\nFor "
           "comparison, formulas fitted to many metals (Assadi et al.): 2003, without size, %.0f m/s; 2011, for",
        mpm_critical_velocity_2003(2.7, 660, 110, 20));
    for (k = 0; k < SIZES; k++)
        say(w, "%s %g um %.0f", k ? "," : "", sizes[k],
            mpm_critical_velocity_2011(sizes[k], 900, 933, 293, 110e6, 2700));
    say(w, " m/s (tensile strength 110 MPa, 20 C).\n\n");
    if (mpm_io_csv_end(&t, &w->fault) < 0) return failed(w);
    status = critical_plot(w, setting, count);
    return status > 0 && position_table(w, size) && position_plot(w, size);
}

/* ---- what the rule's constants mean ---------------------------------------------------------- */

/* Source A prints 2.271 without a power of ten that makes sense: every power, one position. */
static inline int rate_unit(work *w)
{
    critical_range range = critical_budget(w);
    critical_outcome out;
    int power, status;
    range.low = 300;
    range.high = 1200;
    w->s.early = 1;
    w->s.planned = w->s.done + 8 * critical_cost(&range);
    say(w, "### The unit of Gdot_c\n\nSource A prints 2.271 for it. Critical velocity of 14 um with G_c 1503.74 J/m2 "
           "by what it may mean, rule \"thesis\", %s um, axisymmetric, one position of the grid, between %.0f and %.0f "
           "m/s. Experiment: 810 m/s.\n\n"
           "| Gdot_c, J/(m2 us) | critical velocity, m/s | PBCP there, %% |\n|---|---|---|\n",
        budget_grid(w), range.low, range.high);
    for (power = 0; power < 8; power++) {
        impact_case c = budget_case(w);
        char text[40], pbcp[40];
        c.gdot = 2.271 * pow(10, power);
        study_complete(&c, "thesis");
        if ((status = critical_repeat(w, c, VARY_GRID, "thesis", range, 1, &out)) <= 0) return status;
        say(w, "| 2.271e%d | %s%s | %s |\n", power,
            out.spread.middle.below > 0 || !(out.spread.median < HUGE_VAL) ? "" : "at most ",
            velocity_text(out.spread.median, range.high, text, sizeof text),
            measure_text(out.spread.middle.pbcp, pbcp, sizeof pbcp));
    }
    say(w, "\n");
    return 1;
}

/* The energy rule's length: the cell (DCell), or the same 1 um on every grid. */
static inline int regularisation(work *w)
{
    static const grid grids[3] = {{1.5, 0.5}, {1.0, 0.25}, {0.7, 0.175}};
    const int count = w->budget == QUICK ? 2 : 3, times = budget_times(w);
    critical_range range = critical_budget(w);
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {0, 0};
    critical_outcome out;
    char number[40];
    int g, k, status;
    w->s.early = 1;
    w->s.planned = w->s.done + 2 * count * times * critical_cost(&range);
    say(w, "### With and without DCell\n\nCritical velocity of 14 um, rule \"thesis\", axisymmetric, %d positions of "
           "the grid (\"on the plane\": the interface on a grid plane): the energy rule with the cell as its length "
           "(A 4.16), and with 1 um on every grid.\n\n"
           "| cell/spacing, um | with DCell: median, m/s | lowest - highest | on the plane | PBCP at the median, %% "
           "| 1 um: median, m/s | lowest - highest | on the plane | PBCP at the median, %% |\n"
           "|---|---|---|---|---|---|---|---|---|\n", times);
    for (g = 0; g < count; g++) {
        say(w, "| %.3g/%.3g", grids[g].cell, grids[g].spacing);
        for (k = 0; k < 2; k++) {
            impact_case c = study_case_default();
            c.cell = grids[g].cell;
            c.spacing = grids[g].spacing;
            if (k == 1 && g != 1) c.bond_length = 1; /* there it is the cell */
            study_complete(&c, "thesis");
            if ((status = critical_repeat(w, c, VARY_GRID, "thesis", range, times, &out)) <= 0) return status;
            say(w, " | ");
            say_spread(w, &out.spread, range.high);
            say(w, " | %s", velocity_text(out.each[0], range.high, number, sizeof number));
            say(w, " | %s", measure_text(out.spread.middle.pbcp, number, sizeof number));
            low[k] = fmin(low[k], out.spread.median);
            high[k] = fmax(high[k], out.spread.median);
        }
        say(w, " |\n");
    }
    for (k = 0; k < 2; k++)
        if (high[k] < HUGE_VAL)
            say(w, "%sFrom the lowest to the highest median %s DCell: %.0f m/s.\n", k ? "" : "\n",
                k ? "without" : "with", high[k] - low[k]);
    say(w, "\n");
    return 1;
}

/* Other pairs G_c, Gdot_c: what they do to the fall with size and to PBCP at onset. */
static inline int other_pairs(work *w)
{
    static const double pair[3][2] = {{500, 1.35e6}, {1503.74, 2.271e5}, {5000, 2.6e5}};
    critical_range range = critical_budget(w);
    const grid g = {w->budget == FULL ? 1.0 : 1.5, w->budget == FULL ? 0.25 : 0.5};
    critical_outcome out;
    char pbcp[40];
    int p, k, status;
    range.high = 1400;
    w->s.early = 1;
    w->s.planned = w->s.done + 6 * 4 * critical_cost(&range);
    say(w, "### Other pairs\n\nRule \"stays\", %.3g/%.3g um, axisymmetric, four positions of the grid.\n\n"
           "| G_c, J/m2 | Gdot_c, J/(m2 us) | 14 um: median, m/s | lowest - highest | PBCP there, %% | 30 um: median, "
           "m/s | lowest - highest | PBCP there, %% |\n|---|---|---|---|---|---|---|---|\n", g.cell, g.spacing);
    for (p = 0; p < 3; p++) {
        say(w, "| %g | %.4g", pair[p][0], pair[p][1]);
        for (k = 0; k < 2; k++) {
            impact_case c = study_case_default();
            c.cell = g.cell;
            c.spacing = g.spacing;
            c.diameter = k ? 30 : 14;
            c.gc = pair[p][0];
            c.gdot = pair[p][1];
            study_complete(&c, "thesis");
            if ((status = critical_repeat(w, c, VARY_GRID, "stays", range, 4, &out)) <= 0) return status;
            say(w, " | ");
            say_spread(w, &out.spread, range.high);
            say(w, " | %s", measure_text(out.spread.middle.pbcp, pbcp, sizeof pbcp));
        }
        say(w, " |\n");
    }
    say(w, "\n");
    return 1;
}

/* ---- impacts that were not calibrated on ----------------------------------------------------- */

/* One pair and grid: a row for each impact. As study_need. */
static inline int held_rows(work *w, int pair, grid g, int times)
{
    static const struct {
        double diameter, velocity;
        int bonds;
    } row[4] = {{45, 550, 0}, {38, 780, 1}, {22, 752, 0}, {22, 1066, 1}};
    double value[STUDY_VALUES];
    int k, i, r, status;
    for (k = 0; k < 4; k++) {
        int right[2] = {0, 0};
        for (i = 0; i < times; i++) {
            impact_case c = study_case_default();
            c.cell = g.cell;
            c.spacing = g.spacing;
            c.gc = pairs[pair].gc;
            c.gdot = pairs[pair].gdot;
            c.diameter = row[k].diameter;
            c.velocity = row[k].velocity;
            c.offset = c.cell * i / times;
            study_complete(&c, "thesis");
            if ((status = study_need(&w->s, &c, value, w->message, sizeof w->message)) <= 0) return status;
            for (r = 0; r < 2; r++) {
                critical_rule rule = critical_rule_default();
                rule.name = rule_names[r];
                right[r] += critical_bonds(&rule, c.diameter, value) == row[k].bonds;
            }
        }
        say(w, "| %g um at %g m/s | %s | %s, %.3g/%.3g | %d of %d | %d of %d |\n", row[k].diameter, row[k].velocity,
            row[k].bonds ? "bonds" : "rebounds", pair == OWN_PAIR ? "own" : "source A's", g.cell, g.spacing, right[0],
            times, right[1], times);
    }
    return 1;
}

static inline int held_out(work *w)
{
    static const grid fine = {0.7, 0.175};
    const int times = budget_times(w);
    const impact_case c = budget_case(w);
    const grid g = {c.cell, c.spacing};
    int status;
    w->s.early = 1;
    w->s.planned = w->s.done + 4 * times + (w->budget == QUICK ? 0 : 2 * times);
    say(w, "### Impacts that were not calibrated on\n\nHow many positions of the grid come out as the experiment.\n\n"
           "| impact | experiment | pair, cell/spacing | right by rule \"thesis\" | right by rule \"stays\" |\n"
           "|---|---|---|---|---|\n");
    status = held_rows(w, SOURCE_PAIR, g, times);
    if (status > 0 && w->budget != QUICK) status = held_rows(w, OWN_PAIR, fine, times / 2);
    say(w, "\n");
    return status;
}

#endif
