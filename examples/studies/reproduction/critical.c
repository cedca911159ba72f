/* critical.c - the critical velocity: by time step, by size. SPDX-License-Identifier: MIT */
#include "reproduction.h"

/* ---- A-dt ---------------------------------------------------------------------------------- */

int time_steps(work *w)
{
    static const double factor[4] = {0.05, 0.1, 0.2, 0.4};
    const critical_range range = critical_range_default();
    critical_outcome out;
    int k, status;
    plan(w, 1, 4 * critical_cost(&range));
    say(w, "### A-dt: time step\n\nCritical velocity of 14 um, rule of source A, one grid position. Source A: factors "
           "up to 0.2 show no visible difference in the calibration boundary.\n\n| factor | cell/spacing, um | "
           "critical velocity, m/s | bracket from | PBCP, %% |\n|---|---|---|---|---|\n");
    for (k = 0; k < 4; k++) {
        impact_case c = case_on(budget_grid(w));
        c.dt_factor = factor[k];
        if ((status = critical_repeat(w, c, VARY_GRID, "thesis", range, 1, &out)) <= 0) return status;
        say(w, "| %g | %.3g/%.3g | ", factor[k], c.cell, c.spacing);
        say_velocity(w, out.spread.median, range.high);
        say(w, " | %.0f | %.2f |\n", out.spread.middle.below, out.spread.middle.pbcp);
    }
    say(w, "\n");
    return 1;
}

/* ---- A-crit -------------------------------------------------------------------------------- */

#define SIZES 5
static const double sizes[SIZES] = {14, 18, 22, 26, 30};
static const double said_critical[SIZES] = {824, 809, 791, 776, 761};

/* A way to find the critical velocities: which sizes at how many positions of the grid (0: not), and on which
   budgets (bits). */
typedef struct critical_setting {
    grid g;
    int pair;
    const char *geometry, *substrate, *name;
    int times[SIZES], budgets;
} critical_setting;

#define SETTINGS 10
static const critical_setting settings[SETTINGS] = {
    {{1.5, 0.5}, SOURCE_PAIR, "axisymmetric", "thesis", "1.5/0.5", {4, 4, 4, 4, 4}, 1 << QUICK},
    {{1.0, 0.25}, SOURCE_PAIR, "axisymmetric", "thesis", "1/0.25", {8, 8, 8, 8, 8}, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, SOURCE_PAIR, "axisymmetric", "thesis", "0.7/0.175", {8, 4, 4, 4, 4}, 1 << DESK},
    {{0.7, 0.175}, OWN_PAIR, "axisymmetric", "thesis", "0.7/0.175, own pair", {8, 4, 4, 4, 4}, 1 << DESK},
    {{0.7, 0.175}, SOURCE_PAIR, "axisymmetric", "thesis", "0.7/0.175", {8, 8, 8, 8, 8}, 1 << FULL},
    {{0.7, 0.175}, OWN_PAIR, "axisymmetric", "thesis", "0.7/0.175, own pair", {8, 8, 8, 8, 8}, 1 << FULL},
    {{1.0, 0.25}, SOURCE_PAIR, "axisymmetric", "large", "1/0.25, large substrate", {8, 0, 0, 0, 2}, 1 << DESK},
    {{1.0, 0.25}, SOURCE_PAIR, "axisymmetric", "large", "1/0.25, large substrate", {8, 8, 8, 8, 8}, 1 << FULL},
    {{0.7, 0.175}, SOURCE_PAIR, "3d", "thesis", "0.7/0.175, 3D", {1, 0, 0, 0, 0}, 1 << DESK},
    {{0.7, 0.175}, SOURCE_PAIR, "3d", "thesis", "0.7/0.175, 3D", {8, 8, 8, 8, 8}, 1 << FULL}};

static impact_case critical_case(const critical_setting *g, int size)
{
    impact_case c = case_on(g->g);
    c.diameter = sizes[size];
    c.geometry = g->geometry;
    c.gc = pairs[g->pair].gc;
    c.gdot = pairs[g->pair].gdot;
    study_complete(&c, g->substrate);
    return c;
}

/* A row of the file. */
static void critical_record(mpm_io_csv *t, const impact_case *c, const critical_spread *s, int times,
                            const char *rule_name)
{
    mpm_io_csv_real(t, (mpm_real)c->diameter);
    mpm_io_csv_real(t, (mpm_real)s->median);
    mpm_io_csv_real(t, (mpm_real)s->lowest);
    mpm_io_csv_real(t, (mpm_real)s->highest);
    mpm_io_csv_integer(t, times);
    mpm_io_csv_real(t, (mpm_real)s->middle.pbcp);
    mpm_io_csv_real(t, (mpm_real)s->middle.v_rest);
    mpm_io_csv_real(t, (mpm_real)c->cell);
    mpm_io_csv_real(t, (mpm_real)c->spacing);
    mpm_io_csv_text(t, c->geometry);
    mpm_io_csv_real(t, (mpm_real)c->substrate_diameter);
    mpm_io_csv_real(t, (mpm_real)c->substrate_height);
    mpm_io_csv_real(t, (mpm_real)c->gc);
    mpm_io_csv_real(t, (mpm_real)c->gdot);
    mpm_io_csv_text(t, rule_name);
}

/* One size by one setting and rule: a row of the table and of the file. As need. */
static int critical_row(work *w, mpm_io_csv *t, const critical_setting *g, int size, const char *rule_name,
                        critical_outcome *out)
{
    const impact_case c = critical_case(g, size);
    const critical_spread *s = &out->spread;
    critical_range range = budget_range(w);
    int status;
    if (!strcmp(g->geometry, "3d") && w->budget == DESK) { /* a spot check: halving alone */
        range.low = 600;
        range.scan = 400;
        range.step = 25;
    }
    plan(w, 1, g->times[size] * critical_cost(&range));
    status = critical_repeat(w, c, VARY_GRID, rule_name, range, g->times[size], out);
    if (status <= 0) return status;
    critical_record(t, &c, s, g->times[size], rule_name);
    say(w, "| %g | %s | %s, %g x %g | %d | %.0f | ", sizes[size], rule_name, g->name, c.substrate_diameter,
        c.substrate_height, g->times[size], said_critical[size]);
    say_spread(w, s, range.high);
    if (s->median < HUGE_VAL) say(w, " | %+.0f | ", s->median - said_critical[size]);
    else say(w, " | - | ");
    say_velocity(w, out->each[0], range.high);
    say(w, " | ");
    say_measure(w, s->middle.pbcp);
    say(w, " | %d | %.0f |\n", out->lost, out->cpu);
    return 1;
}

/* ---- its pictures ---------------------------------------------------------------------------- */

typedef struct critical_line {
    mpm_real x[REPEATS], y[REPEATS];
    size_t count;
    char name[60];
} critical_line;

static void critical_point(critical_line *l, double x, double v)
{
    if (!(v < HUGE_VAL)) return;
    l->x[l->count] = (mpm_real)x;
    l->y[l->count++] = (mpm_real)v;
}

static mpm_draw_curve critical_curve_of(const critical_line *l, mpm_draw_mark mark, int color)
{
    return plot_curve(l->name, l->x, l->y, l->count, mark, color);
}

/* Critical velocity over the position of the grid, by size, as a file. */
static int position_table(work *w, const critical_line *size)
{
    mpm_io_csv t;
    size_t i;
    int k;
    table_begin(w, &t, "position.csv", "diameter_um,grid_plane_over_interface_cells,critical_velocity_m_s",
                "A-crit; positions at which nothing bonded are left out");
    for (k = 0; k < SIZES; k++)
        for (i = 0; i < size[k].count; i++) {
            mpm_io_csv_real(&t, (mpm_real)sizes[k]);
            mpm_io_csv_real(&t, size[k].x[i]);
            mpm_io_csv_real(&t, size[k].y[i]);
        }
    return table_end(w, &t, 1);
}

/* The same as a picture, a curve per size. */
static int position_plot(work *w, const critical_line *size)
{
    mpm_draw_curve line[SIZES];
    const mpm_draw_plot_desc d = plot_of("critical velocity over the position of the grid",
                                         "height of a grid plane over the interface, cells", "m/s", line, SIZES);
    int k;
    for (k = 0; k < SIZES; k++) line[k] = critical_curve_of(&size[k], MPM_DRAW_CURVE, k);
    return picture(w, "position.png", &d);
}

/* Critical velocities over size: by setting, source A's, the experiment. */
static int critical_plot(work *w, const critical_line *ours, int count)
{
    static const mpm_real two_sizes[2] = {14, 30}, measured[2] = {810, 770};
    mpm_real x[SIZES], said[SIZES];
    mpm_draw_curve line[SETTINGS + 3];
    mpm_draw_plot_desc d = plot_of("critical velocity, rule of source A, median over grid positions",
                                   "particle diameter, um", "m/s", line, count + 2);
    int k;
    for (k = 0; k < SIZES; k++) {
        x[k] = (mpm_real)sizes[k];
        said[k] = (mpm_real)said_critical[k];
    }
    for (k = 0; k < count; k++)
        line[k] = critical_curve_of(&ours[k], ours[k].count > 1 ? MPM_DRAW_CURVE : MPM_DRAW_DOTS, k);
    line[count] = plot_curve("source A", x, said, SIZES, MPM_DRAW_DASHED, count);
    line[count + 1] = plot_curve("experiment", two_sizes, measured, 2, MPM_DRAW_DOTS, count + 1);
    d.window[2] = 500; /* with room for the legend */
    d.window[3] = 1150;
    return picture(w, "critical_velocity.png", &d);
}

/* The curves of both pictures, by rule "thesis". */
typedef struct critical_lines {
    critical_line setting[SETTINGS + 1]; /* medians over size; the last one the own pair's on a grid plane */
    critical_line plane;
    critical_line size[SIZES];           /* of the first setting, over the position of the grid */
    int count;                           /* of settings */
} critical_lines;

/* One size of a setting into the curves. */
static void critical_note(critical_lines *l, const critical_setting *g, int size, const critical_outcome *out)
{
    critical_line *now = &l->setting[l->count], *here = &l->size[size];
    int i;
    snprintf(now->name, sizeof now->name, "%s", g->name);
    critical_point(now, sizes[size], out->spread.median);
    if (g->pair == OWN_PAIR) {
        critical_point(&l->plane, sizes[size], out->each[0]);
        snprintf(l->plane.name, sizeof l->plane.name, "%.40s, on a grid plane", g->name);
    }
    if (l->count > 0) return;
    snprintf(here->name, sizeof here->name, "%g um", sizes[size]);
    for (i = 0; i < g->times[size]; i++) critical_point(here, (double)i / g->times[size], out->each[i]);
}

/* The table, and the curves. As need. */
static int critical_rows(work *w, mpm_io_csv *t, critical_lines *l)
{
    critical_outcome out;
    int g, r, k, status;
    memset(l, 0, sizeof *l);
    for (g = 0; g < SETTINGS; g++) {
        if (!(settings[g].budgets & 1 << w->budget)) continue;
        for (r = 0; r < 2; r++)
            for (k = 0; k < SIZES; k++) {
                if (settings[g].times[k] == 0) continue;
                if ((status = critical_row(w, t, &settings[g], k, rule_names[r], &out)) <= 0) return status;
                if (r == 0) critical_note(l, &settings[g], k, &out);
            }
        l->count++;
    }
    if (l->plane.count > 0) l->setting[l->count++] = l->plane;
    return 1;
}

static void say_formulas(work *w)
{
    int k;
    say(w, "\n![Critical velocity](data/critical_velocity.png) ![By position](data/position.png)\n\nFor "
           "comparison, formulas fitted to many metals (Assadi et al.): 2003, without size, %.0f m/s; 2011, for",
        mpm_critical_velocity_2003(2.7, 660, 110, 20));
    for (k = 0; k < SIZES; k++)
        say(w, "%s %g um %.0f", k ? "," : "", sizes[k],
            mpm_critical_velocity_2011(sizes[k], 900, 933, 293, 110e6, 2700));
    say(w, " m/s (tensile strength 110 MPa, 20 C).\n\n");
}

int critical(work *w)
{
    const critical_range range = budget_range(w);
    static critical_lines l;
    mpm_io_csv t;
    int status;
    table_begin(w, &t, "critical_velocity.csv",
                "diameter_um,critical_velocity_m_s,lowest_m_s,highest_m_s,offsets,pbcp_percent,v_rest_m_s,cell_um,"
                "spacing_um,geometry,substrate_diameter_um,substrate_height_um,gc,gdot,rule", "A-crit");
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
    status = table_end(w, &t, critical_rows(w, &t, &l));
    if (status <= 0) return status;
    say_formulas(w);
    return critical_plot(w, l.setting, l.count) && position_table(w, l.size) && position_plot(w, l.size);
}
