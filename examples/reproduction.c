/* reproduction - the results of source A's chapters 4 and 5 again, beside its numbers.

   Runs the cases A-conv, A-cal, A-dt, A-jet, A-crit, A-two, A-ten and A-site at a stated budget: "quick" on the
   coarsest grid (about half an hour of one core), "desk" at 1.0/0.25 um in axisymmetry (hours), "full" source A's
   grids throughout (days). Writes tables and plots into --data and replaces its part of --page.
   Every finished run is kept in --out and never repeated; delete the folder after changing the headers.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "calibration.h"
#include "particles_case.h"

#include <stdarg.h>

enum { QUICK, DESK, FULL };

typedef struct work {
    study s;
    int budget;
    const char *budget_name, *data, *page, *only, *desk;
    char *text;       /* the part of the page */
    size_t used, room;
    char message[400];
    mpm_fault fault;
} work;

typedef struct grid {
    double cell, spacing;
} grid;

/* ---- the page ------------------------------------------------------------------------------ */

static void say(work *w, const char *format, ...)
{
    va_list list;
    int n;
    va_start(list, format);
    n = vsnprintf(w->text + w->used, w->room - w->used, format, list);
    va_end(list);
    if (n > 0) w->used += (size_t)n < w->room - w->used ? (size_t)n : w->room - w->used - 1;
}

/* "812", "none up to 1000": a velocity of a search. */
static const char *velocity_text(double v, double high, char *text, size_t n)
{
    if (v < HUGE_VAL) snprintf(text, n, "%.0f", v);
    else snprintf(text, n, "none up to %.0f", high);
    return text;
}

static int failed(work *w)
{
    mpm_io_fault_text(w->message, sizeof w->message, &w->fault);
    return 0;
}

static const char *data_file(const work *w, const char *name, char *path, size_t n)
{
    snprintf(path, n, "%s/%s", w->data, name);
    return path;
}

#define BEGIN_MARK "<!-- made by build/reproduction: begin -->\n"
#define END_MARK "<!-- made by build/reproduction: end -->\n"

/* Puts the text between its marks in the page, or at the page's end if it has none; the rest stays. */
static int write_page(work *w)
{
    static char old[400000];
    const char *from, *to;
    size_t n = 0, kept;
    FILE *f = fopen(w->page, "rb");
    if (f) {
        n = fread(old, 1, sizeof old - 1, f);
        fclose(f);
    }
    old[n] = 0;
    from = strstr(old, BEGIN_MARK);
    to = from ? strstr(from, END_MARK) : NULL;
    kept = to ? (size_t)(from - old) : n;
    f = fopen(w->page, "wb");
    if (f) {
        fwrite(old, 1, kept, f);
        fprintf(f, "%s%s%s%s%s", to ? "" : "\n", BEGIN_MARK, w->text, END_MARK, to ? to + strlen(END_MARK) : "");
        if (fclose(f) == 0) return 1;
    }
    snprintf(w->message, sizeof w->message, "cannot write %.300s", w->page);
    return 0;
}

/* ---- A-conv -------------------------------------------------------------------------------- */

static int convergence(work *w)
{
    static const grid grids[9] = {{1.5, 0.5}, {1.5, 0.4}, {1.5, 0.35}, {1.0, 0.4}, {1.0, 0.35}, {1.0, 0.25},
                                  {0.5, 0.2}, {0.5, 0.175}, {0.5, 0.15}};
    const int count = w->budget == QUICK ? 6 : 9;
    double value[STUDY_VALUES], low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {0, 0}, cpu = 0;
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int k, v, status;
    w->s.early = 0;
    w->s.planned = w->s.done + count;
    mpm_io_csv_begin(&t, data_file(w, "convergence.csv", path, sizeof path),
                     "cell_um,spacing_um,eps_mean,plastic_energy_density_MPa,flattening,points,steps", "A-conv",
                     &w->fault);
    say(w, "### A-conv: grids without bonding\n\n14 um at 810 m/s, frictionless, no bond, axisymmetric, time step "
           "factor 0.05, after "
           "80 ns. Source A (figures): the mean plastic strain depends strongly on the cell, hardly on the spacing; "
           "the mean "
           "plastic energy density much less.\n\n| cell/spacing, um | mean plastic strain | plastic energy density, "
           "MPa | points |\n|---|---|---|---|\n");
    for (k = 0; k < count; k++) {
        impact_case c = study_case_default();
        c.cell = grids[k].cell;
        c.spacing = grids[k].spacing;
        c.bond = "none";
        c.dt_factor = 0.05;
        study_complete(&c, "thesis");
        if ((status = study_need(&w->s, &c, value, w->message, sizeof w->message)) <= 0) {
            mpm_io_csv_end(&t, NULL);
            return status;
        }
        mpm_io_csv_real(&t, (mpm_real)c.cell);
        mpm_io_csv_real(&t, (mpm_real)c.spacing);
        mpm_io_csv_real(&t, (mpm_real)value[STUDY_EPS]);
        mpm_io_csv_real(&t, (mpm_real)value[STUDY_WORK]);
        mpm_io_csv_real(&t, (mpm_real)value[STUDY_FLATTENING]);
        mpm_io_csv_integer(&t, (long)value[STUDY_POINTS]);
        mpm_io_csv_integer(&t, (long)value[STUDY_STEPS]);
        say(w, "| %.3g/%.3g | %.4f | %.1f | %.0f |\n", c.cell, c.spacing, value[STUDY_EPS], value[STUDY_WORK],
            value[STUDY_POINTS]);
        for (v = 0; v < 2; v++) {
            low[v] = fmin(low[v], value[v ? STUDY_WORK : STUDY_EPS]);
            high[v] = fmax(high[v], value[v ? STUDY_WORK : STUDY_EPS]);
        }
        cpu += value[STUDY_CPU];
    }
    say(w,
        "\nFrom the lowest to the highest of these grids: strain %+.1f %%, energy density %+.1f %%. Cost: %.0f CPU "
        "s.\n\n",
        100 * (high[0] / low[0] - 1), 100 * (high[1] / low[1] - 1), cpu);
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

/* ---- A-dt ---------------------------------------------------------------------------------- */

static int time_steps(work *w)
{
    static const double factor[4] = {0.05, 0.1, 0.2, 0.4};
    static critical_curve curve;
    const critical_rule rule = critical_rule_default();
    const critical_range range = critical_range_default();
    char text[40];
    int k, status;
    w->s.early = 1;
    w->s.planned = w->s.done + 4 * critical_cost(&range);
    say(w, "### A-dt: time step\n\nCritical velocity of 14 um, rule of source A, one grid position. Source A: factors "
           "up to 0.2 show no "
           "visible difference in the calibration boundary.\n\n| factor | cell/spacing, um | critical velocity, m/s | "
           "bracket from | PBCP, %% |\n"
           "|---|---|---|---|---|\n");
    for (k = 0; k < 4; k++) {
        impact_case c = study_case_default();
        critical_answer a;
        if (w->budget == QUICK) c.cell = 1.5, c.spacing = 0.5;
        c.dt_factor = factor[k];
        study_complete(&c, "thesis");
        curve.runs = 0;
        status = critical_search(&w->s, &c, &range, &rule, &curve, &a, w->message, sizeof w->message);
        if (status <= 0) return status;
        say(w, "| %g | %.3g/%.3g | %s | %.0f | %.2f |\n", factor[k], c.cell, c.spacing,
            velocity_text(a.velocity, range.high, text, sizeof text), a.below, a.pbcp);
    }
    say(w, "\n");
    return 1;
}

/* ---- A-jet --------------------------------------------------------------------------------- */

static int jets(work *w)
{
    static const double size[2] = {45, 38}, speed[2] = {550, 780};
    static const char *const said[2] = {"no jet, rebounds", "jet from the particle's rim, bonded"};
    double value[STUDY_VALUES];
    int k, status;
    w->s.early = 0;
    w->s.planned = w->s.done + 2;
    say(w, "### A-jet: below and above the critical velocity\n\n| impact | source A | mass beyond 1.5 radii of the "
           "axis, %% | faster than 60 m/s, %% | mean velocity at the "
           "end, m/s | PBCP, %% | flattening | cell/spacing, um | CPU s |\n|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < 2; k++) {
        impact_case c = study_case_default();
        c.diameter = size[k];
        c.velocity = speed[k];
        if (w->budget == QUICK) c.cell = 1.5, c.spacing = 0.5;
        if (w->budget == FULL) c.cell = 0.7, c.spacing = 0.175;
        study_complete(&c, "thesis");
        if ((status = study_need(&w->s, &c, value, w->message, sizeof w->message)) <= 0) return status;
        say(w, "| %g um at %g m/s | %s | %.2f | %.1f | %.2f | %.2f | %.3f | %.3g/%.3g | %.0f |\n", size[k], speed[k],
            said[k], 100 * value[STUDY_JET], 100 * value[STUDY_EJECTED], value[STUDY_V_LATE], value[STUDY_PBCP],
            value[STUDY_FLATTENING], c.cell, c.spacing, value[STUDY_CPU]);
    }
    say(w, "\n");
    return 1;
}

/* ---- A-crit -------------------------------------------------------------------------------- */

#define SIZES 5
static const double sizes[SIZES] = {14, 18, 22, 26, 30};
static const double said_critical[SIZES] = {824, 809, 791, 776, 761};

/* How finely a budget searches, and at how many positions of the grid. */
static critical_range critical_budget(const work *w, int *offsets)
{
    critical_range r = critical_range_default();
    *offsets = w->budget == QUICK ? 4 : 8;
    if (w->budget != FULL) r.scan = 100, r.step = 10;
    return r;
}

/* The search at several positions of the grid. `lost`: tested velocities above the critical one that do
   not bond. As study_need. */
static int critical_offsets(work *w, impact_case c, const char *rule_name, critical_range range, int offsets,
                            critical_spread *out, int *lost, double *cpu)
{
    static critical_curve curve;
    critical_answer a[16];
    critical_rule rule = critical_rule_default();
    int k, status;
    rule.name = rule_name;
    curve.runs = 0;
    *lost = 0;
    *cpu = 0;
    for (k = 0; k < offsets; k++) {
        c.offset = c.cell * k / offsets;
        status = critical_search(&w->s, &c, &range, &rule, &curve, &a[k], w->message, sizeof w->message);
        if (status <= 0) return status;
        *lost += a[k].lost;
    }
    for (k = 0; k < curve.runs; k++) *cpu += curve.run[k].value[STUDY_CPU];
    *out = critical_summary(a, offsets);
    return 1;
}

/* One size on one grid by one rule: a row of the table and of the file. */
static int critical_row(work *w, mpm_io_csv *t, int size, grid g, const char *rule_name, critical_spread *out)
{
    int offsets, lost, status;
    const critical_range range = critical_budget(w, &offsets);
    impact_case c = study_case_default();
    char middle[40], low[40], high[40], difference[40] = "-";
    double cpu;
    c.diameter = sizes[size];
    c.cell = g.cell;
    c.spacing = g.spacing;
    study_complete(&c, "thesis");
    w->s.planned = w->s.done + offsets * critical_cost(&range);
    status = critical_offsets(w, c, rule_name, range, offsets, out, &lost, &cpu);
    if (status <= 0) return status;
    mpm_io_csv_real(t, (mpm_real)c.diameter);
    mpm_io_csv_real(t, (mpm_real)out->median);
    mpm_io_csv_real(t, (mpm_real)out->lowest);
    mpm_io_csv_real(t, (mpm_real)out->highest);
    mpm_io_csv_integer(t, offsets);
    mpm_io_csv_real(t, (mpm_real)out->middle.pbcp);
    mpm_io_csv_real(t, (mpm_real)out->middle.v_rest);
    mpm_io_csv_real(t, (mpm_real)c.cell);
    mpm_io_csv_real(t, (mpm_real)c.spacing);
    mpm_io_csv_text(t, c.geometry);
    mpm_io_csv_real(t, (mpm_real)c.substrate_diameter);
    mpm_io_csv_real(t, (mpm_real)c.substrate_height);
    mpm_io_csv_real(t, (mpm_real)c.gc);
    mpm_io_csv_real(t, (mpm_real)c.gdot);
    mpm_io_csv_text(t, rule_name);
    if (out->median < HUGE_VAL) snprintf(difference, sizeof difference, "%+.0f", out->median - said_critical[size]);
    say(w, "| %g | %s | %.3g/%.3g | %.0f | %s | %s | %s - %s | %.2f | %d | %.0f |\n", sizes[size], rule_name, g.cell,
        g.spacing, said_critical[size], velocity_text(out->median, range.high, middle, sizeof middle), difference,
        velocity_text(out->lowest, range.high, low, sizeof low),
        velocity_text(out->highest, range.high, high, sizeof high), out->middle.pbcp, lost, cpu);
    return 1;
}

/* Critical velocity over size: ours by grid, source A's, the experiment. */
static int critical_plot(work *w, mpm_real ours[][SIZES], const grid *grids, int count)
{
    static const mpm_real two_sizes[2] = {14, 30}, measured[2] = {810, 770};
    mpm_real x[SIZES], said[SIZES];
    mpm_io_curve line[5];
    mpm_io_plot_desc d = mpm_io_plot_desc_default();
    char name[3][60], path[MPM_IO_PATH];
    int k;
    memset(line, 0, sizeof line);
    for (k = 0; k < SIZES; k++) {
        x[k] = (mpm_real)sizes[k];
        said[k] = (mpm_real)said_critical[k];
    }
    for (k = 0; k < count + 2; k++) {
        line[k].x = k == count + 1 ? two_sizes : x;
        line[k].count = k == count + 1 ? 2 : SIZES;
        line[k].y = k < count ? ours[k] : k == count ? said : measured;
        line[k].mark = k < count ? MPM_IO_CURVE : k == count ? MPM_IO_DASHED : MPM_IO_DOTS;
        line[k].color = k;
        if (k < count) snprintf(name[k], sizeof name[k], "here, %.3g/%.3g um, median", grids[k].cell, grids[k].spacing);
        line[k].name = k < count ? name[k] : k == count ? "source A" : "experiment";
    }
    d.curves = line;
    d.curve_count = count + 2;
    d.title = "critical velocity, rule of source A";
    d.x_label = "particle diameter, um";
    d.y_label = "m/s";
    return study_plots(data_file(w, "critical_velocity.png", path, sizeof path), &d, 1, 1, "A-crit", &w->fault) ||
           failed(w);
}

static int critical(work *w)
{
    static const grid grids[3] = {{1.5, 0.5}, {1.0, 0.25}, {0.7, 0.175}};
    static const char *const rules[2] = {"thesis", "stays"};
    const int first = w->budget == DESK ? 1 : 0, count = w->budget == QUICK ? 1 : w->budget == DESK ? 2 : 3;
    int offsets;
    const critical_range range = critical_budget(w, &offsets);
    mpm_real ours[3][SIZES];
    critical_spread spread;
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int g, r, k, status;
    w->s.early = 1;
    mpm_io_csv_begin(&t, data_file(w, "critical_velocity.csv", path, sizeof path),
                     "diameter_um,critical_velocity_m_s,lowest_m_s,highest_m_s,offsets,pbcp_percent,v_rest_m_s,cell_um,"
                     "spacing_um,geometry,"
                     "substrate_diameter_um,substrate_height_um,gc,gdot,rule",
                     "A-crit", &w->fault);
    say(w,
        "### A-crit: critical velocity\n\nG_c 1503.74 J/m2, Gdot_c 2.271e5 J/(m2 us), not recalibrated here; "
        "axisymmetric, source A's "
        "substrates, time step factor 0.2, %d positions of the grid in the cell. Median and extremes of the lowest "
        "velocity that bonds, "
        "between %.0f and %.0f m/s to %.0f m/s. Rule \"thesis\": PBCP at least 5.0 %% and rebound at most 0.6 m/s, 4.8 "
        "%% and 0.9 m/s at 14 um, relative to the "
        "substrate; \"stays\": late mean velocity under 2 m/s and the bond at work. \"Not above\": tested velocities "
        "above the "
        "critical one that do not bond, all positions together. Source A ran one position at 0.7/0.175. Experiment: "
        "810 m/s (14 um), 770 (30 um).\n\n"
        "| um | rule | cell/spacing, um | source A | here | difference | lowest - highest | PBCP, %% | not above | CPU "
        "s |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        offsets, range.low, range.high, range.step);
    for (g = first; g < count; g++)
        for (r = 0; r < 2; r++)
            for (k = 0; k < SIZES; k++) {
                status = critical_row(w, &t, k, grids[g], rules[r], &spread);
                if (status <= 0) {
                    mpm_io_csv_end(&t, NULL);
                    return status;
                }
                if (r == 0) ours[g][k] = (mpm_real)(spread.median < HUGE_VAL ? spread.median : nan(""));
            }
    say(w, "\n![Critical velocity](data/critical_velocity.png)\n\n");
    if (mpm_io_csv_end(&t, &w->fault) < 0) return failed(w);
    return critical_plot(w, ours + first, grids + first, count - first);
}

/* ---- where the scatter comes from ------------------------------------------------------------ */

/* The critical velocity of 14 um over grid positions, one choice of the method changed at a time. */
static int scatter(work *w)
{
    static const struct {
        const char *what, *functions, *normal, *average, *substrate;
        int separation;
        double friction;
    } row[] = {{"as source A", "linear", "ranked", "mean", "thesis", 0, 0},
               {"GIMP", "gimp", "ranked", "mean", "thesis", 0, 0},
               {"logistic normals", "linear", "logistic", "mean", "thesis", 0, 0},
               {"averaged normals", "linear", "average", "mean", "thesis", 0, 0},
               {"nodal D weighted with N", "linear", "ranked", "weighted", "thesis", 0, 0},
               {"GIMP, logistic normals", "gimp", "logistic", "mean", "thesis", 0, 0},
               {"contact where points touch", "linear", "ranked", "mean", "thesis", 1, 0},
               {"GIMP, logistic, where points touch", "gimp", "logistic", "mean", "thesis", 1, 0},
               {"friction 0.2", "linear", "ranked", "mean", "thesis", 0, 0.2},
               {"substrate 70 x 35 um", "linear", "ranked", "mean", "large", 0, 0}};
    const int rows = (int)(sizeof row / sizeof row[0]);
    int offsets, lost, k, status;
    critical_range range = critical_budget(w, &offsets);
    critical_spread spread;
    char middle[40], low[40], high[40], path[MPM_IO_PATH];
    double cpu;
    mpm_io_csv t;
    range.high = 1200;
    w->s.early = 1;
    w->s.planned = w->s.done + rows * offsets * critical_cost(&range);
    mpm_io_csv_begin(&t, data_file(w, "scatter.csv", path, sizeof path),
                     "choice,critical_velocity_m_s,lowest_m_s,highest_m_s,offsets,not_bonded_above", "scatter",
                     &w->fault);
    say(w,
        "### Where the scatter comes from\n\nCritical velocity of 14 um, rule \"thesis\", %d positions of the grid, %s "
        "um, one choice "
        "changed at a time. The pair G_c, Gdot_c is source A's throughout: a choice that moves the median would need "
        "its own.\n\n"
        "| choice | median, m/s | lowest - highest | not above | CPU s |\n|---|---|---|---|---|\n",
        offsets, w->budget == QUICK ? "1.5/0.5" : "1/0.25");
    for (k = 0; k < rows; k++) {
        impact_case c = study_case_default();
        if (w->budget == QUICK) c.cell = 1.5, c.spacing = 0.5;
        c.functions = row[k].functions;
        c.normal = row[k].normal;
        c.bond_average = row[k].average;
        c.separation = row[k].separation;
        c.friction = row[k].friction;
        study_complete(&c, row[k].substrate);
        status = critical_offsets(w, c, "thesis", range, offsets, &spread, &lost, &cpu);
        if (status <= 0) {
            mpm_io_csv_end(&t, NULL);
            return status;
        }
        mpm_io_csv_text(&t, row[k].what);
        mpm_io_csv_real(&t, (mpm_real)spread.median);
        mpm_io_csv_real(&t, (mpm_real)spread.lowest);
        mpm_io_csv_real(&t, (mpm_real)spread.highest);
        mpm_io_csv_integer(&t, offsets);
        mpm_io_csv_integer(&t, lost);
        say(w, "| %s | %s | %s - %s | %d | %.0f |\n", row[k].what,
            velocity_text(spread.median, range.high, middle, sizeof middle),
            velocity_text(spread.lowest, range.high, low, sizeof low),
            velocity_text(spread.highest, range.high, high, sizeof high), lost, cpu);
    }
    say(w, "\n");
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

/* ---- impacts that were not calibrated on ----------------------------------------------------- */

static int held_out(work *w)
{
    static const struct {
        double diameter, velocity;
        int bonds;
    } row[4] = {{45, 550, 0}, {38, 780, 1}, {22, 752, 0}, {22, 1066, 1}};
    static const char *const names[2] = {"thesis", "stays"};
    double value[STUDY_VALUES];
    int offsets, k, i, r, status;
    (void)critical_budget(w, &offsets);
    w->s.early = 1;
    w->s.planned = w->s.done + 4 * offsets;
    say(w,
        "### Impacts that were not calibrated on\n\nSource A's pair, %s um, %d positions of the grid: how many come "
        "out as in the "
        "experiment.\n\n| impact | experiment | right by rule \"thesis\" | right by rule \"stays\" "
        "|\n|---|---|---|---|\n",
        w->budget == QUICK ? "1.5/0.5" : "1/0.25", offsets);
    for (k = 0; k < 4; k++) {
        int right[2] = {0, 0};
        for (i = 0; i < offsets; i++) {
            impact_case c = study_case_default();
            if (w->budget == QUICK) c.cell = 1.5, c.spacing = 0.5;
            c.diameter = row[k].diameter;
            c.velocity = row[k].velocity;
            c.offset = c.cell * i / offsets;
            study_complete(&c, "thesis");
            if ((status = study_need(&w->s, &c, value, w->message, sizeof w->message)) <= 0) return status;
            for (r = 0; r < 2; r++) {
                critical_rule rule = critical_rule_default();
                rule.name = names[r];
                right[r] += critical_bonds(&rule, c.diameter, value) == row[k].bonds;
            }
        }
        say(w, "| %g um at %g m/s | %s | %d of %d | %d of %d |\n", row[k].diameter, row[k].velocity,
            row[k].bonds ? "bonds" : "rebounds", right[0], offsets, right[1], offsets);
    }
    say(w, "\n");
    return 1;
}

/* ---- A-cal --------------------------------------------------------------------------------- */

static int calibrations(work *w)
{
    static const grid grids[9] = {{1.5, 0.5},  {1.0, 0.25}, {0.7, 0.175}, {1.5, 0.35}, {1.5, 0.3},
                                  {1.0, 0.35}, {1.0, 0.2},  {0.7, 0.25},  {0.7, 0.15}};
    static const char *const rules[2] = {"thesis", "stays"};
    static calibration_result result;
    const int count = w->budget == QUICK ? 1 : w->budget == DESK ? 2 : 9;
    char path[MPM_IO_PATH], name[60], points[200];
    int g, r, k, status;
    long node;
    w->s.early = 1;
    say(w, "### A-cal: calibration\n\n14 um at 810 m/s and 30 um at 770 m/s, axisymmetric, one grid position, runs "
           "where the class changes. Source "
           "A: G_c 1503.74 J/m2 and 2.271 (read as e5 J/(m2 us)) at 0.7/0.175, nearly the same on all grids. Rule "
           "\"thesis\": PBCP and "
           "restitution tolerances of its Table 5.2 for the grid.\n\n| cell/spacing, um | rule | runs | bonded, 14 and "
           "30 um | on the wrong side | "
           "crossings: G_c, Gdot_c | "
           "pairs run at both: only 14 um bonds, only 30 um |\n|---|---|---|---|---|---|---|\n");
    for (g = 0; g < count; g++)
        for (r = 0; r < 2; r++) {
            calibration q = calibration_default();
            size_t at = 0;
            long only[2] = {0, 0};
            q.base.cell = grids[g].cell;
            q.base.spacing = grids[g].spacing;
            q.rule = rules[r];
            if (w->budget == QUICK) q.columns = 9, q.rows = 9;
            calibration_tolerances(q.base.cell, q.base.spacing, q.pbcp, q.restitution);
            if ((status = calibration_run(&q, &w->s, w->message, sizeof w->message)) <= 0) return status;
            calibration_collect(&q, &w->s, &result);
            snprintf(name, sizeof name, "calibration_%g_%g_%s.png", grids[g].cell, grids[g].spacing, rules[r]);
            if (!calibration_draw(&q, &result, data_file(w, name, path, sizeof path), "A-cal", &w->fault))
                return failed(w);
            snprintf(points, sizeof points, "none");
            for (k = 0; k < result.points && at < sizeof points; k++)
                at += (size_t)snprintf(points + at, sizeof points - at, "%s%.0f, %.3g", k ? "; " : "",
                                       result.point[k][0], result.point[k][1]);
            for (node = 0; node < calibration_nodes(&q); node++)
                for (k = 0; k < 2; k++)
                    only[k] += result.side[k].map.bonds[node] == 1 && result.side[1 - k].map.bonds[node] == 0;
            say(w, "| %.3g/%.3g | %s | %ld | %ld, %ld | %ld, %ld | [%s](data/%s) | %ld, %ld |\n", grids[g].cell,
                grids[g].spacing, rules[r], result.side[0].tests + result.side[1].tests, result.side[0].bonded,
                result.side[1].bonded, result.side[0].status >= 0 ? result.side[0].fit.wrong : 0,
                result.side[1].status >= 0 ? result.side[1].fit.wrong : 0, points, name, only[0], only[1]);
        }
    say(w, "\n");
    return 1;
}

/* ---- A-site -------------------------------------------------------------------------------- */

/* The strain rule's critical strain is halved in on the PBCP that the energy rule gives. */
static int sites(work *w)
{
    double value[2][STUDY_VALUES], low = 0.5, high = 8;
    impact_case c = study_case_default();
    int k, status;
    w->s.early = 0;
    w->s.planned = w->s.done + 8;
    if (w->budget != QUICK) c.cell = 0.7, c.spacing = 0.175;
    c.time = 30;
    study_complete(&c, "thesis");
    if ((status = study_need(&w->s, &c, value[0], w->message, sizeof w->message)) <= 0) return status;
    c.bond = "strain";
    for (k = 0; k < 7; k++) {
        c.eps_c = (low + high) / 2;
        if ((status = study_need(&w->s, &c, value[1], w->message, sizeof w->message)) <= 0) return status;
        if (value[1][STUDY_PBCP] > value[0][STUDY_PBCP]) low = c.eps_c;
        else high = c.eps_c;
    }
    say(w,
        "### A-site: where it bonds\n\n14 um at 810 m/s after 30 ns, %.3g/%.3g um, axisymmetric. Source A: at equal "
        "PBCP the energy rule bonds nearer "
        "the south pole, the strain rule at the rim. The strain rule's critical strain was halved in on the PBCP of "
        "the energy rule.\n\n"
        "| rule | PBCP, %% | median distance of bonded points from the axis, um | of contacted points, um | ratio "
        "|\n|---|---|---|---|---|\n",
        c.cell, c.spacing);
    for (k = 0; k < 2; k++)
        say(w, "| %s | %.2f | %.3f | %.3f | %.3f |\n", k ? "strain" : "energy", value[k][STUDY_PBCP],
            value[k][STUDY_R_BONDED], value[k][STUDY_R_CONTACT], value[k][STUDY_R_BONDED] / value[k][STUDY_R_CONTACT]);
    say(w, "\nCritical strain %.3g at 1350 per us. %s\n\n", c.eps_c,
        value[0][STUDY_R_BONDED] < value[1][STUDY_R_BONDED] ? "The statement comes back."
                                                            : "The statement does not come back.");
    return 1;
}

/* ---- A-two, A-ten -------------------------------------------------------------------------- */

typedef struct particle_row {
    char fate[20];
    double pbcp, v_z, v_along, ejected;
} particle_row;

/* Reads the report of a finished scene. Returns how many particles it has. */
static int read_particles(const char *folder, particle_row *row, int room)
{
    char path[MPM_IO_PATH], line[400];
    int n = 0, id;
    FILE *f;
    snprintf(path, sizeof path, "%s/particles.csv", folder);
    f = fopen(path, "rb");
    while (f && n < room && fgets(line, sizeof line, f))
        if (sscanf(line, "%d,%*f,%*f,%*f,%19[^,],%lf,%*d,%*d,%*d,%lf,%lf,%lf", &id, row[n].fate, &row[n].pbcp,
                   &row[n].v_z, &row[n].v_along, &row[n].ejected) == 6)
            n++;
    if (f) fclose(f);
    return n;
}

/* A number of a finished scene's summary; -1 if there is none. */
static double read_summary(const char *folder, const char *key)
{
    static char text[20000];
    char path[MPM_IO_PATH], quoted[64];
    const char *at;
    size_t n = 0;
    FILE *f;
    snprintf(path, sizeof path, "%s/summary.json", folder);
    f = fopen(path, "rb");
    if (f) {
        n = fread(text, 1, sizeof text - 1, f);
        fclose(f);
    }
    text[n] = 0;
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    at = strstr(text, quoted);
    return at ? strtod(at + strlen(quoted), NULL) : -1;
}

/* Two particles of 14 um, the second `offset` aside and its centre 30 um up. */
static void two_scene(particles_case *q, grid g, const char *geometry, double offset)
{
    *q = particles_default("half", "");
    q->base.geometry = geometry;
    q->base.cell = g.cell;
    q->base.spacing = g.spacing;
    q->count = 2;
    q->center[0][2] = q->base.diameter / 2;
    q->center[1][0] = offset;
    q->center[1][2] = 30;
}

/* Runs a scene unless its summary, which is written last, is there. As study_need. */
static int need_particles(work *w, particles_case *q, const char *folder)
{
    option o[IMPACT_OPTIONS];
    const int n = particles_options(q, o);
    if (read_summary(folder, "particles") > 0) return 1;
    if (w->s.limit >= 0 && w->s.fresh >= w->s.limit) return -1;
    q->folder = folder;
    q->quiet = w->s.quiet;
    w->s.fresh++;
    if (particles_main(q, o, n)) {
        snprintf(w->message, sizeof w->message, "the scene of %.300s failed", folder);
        return 0;
    }
    return 1;
}

static grid particles_grid(const work *w, grid full)
{
    static const grid coarse[2] = {{1.5, 0.5}, {1.0, 0.35}};
    return w->budget == FULL ? full : coarse[w->budget];
}

static int two_particles(work *w)
{
    static const double offset[4] = {0, 2.5, 5, 7.5},
                        said[3][4] = {{5.73, 5.47, 4.71, 3.91}, {2.02, 1.65, 6.06, 16.24}, {1.24, 0.92, 0.94, -0.53}};
    static particles_case q;
    const grid fine = {0.7, 0.175}, g = particles_grid(w, fine);
    particle_row row[2];
    char folder[MPM_IO_PATH], path[MPM_IO_PATH];
    mpm_io_csv t;
    int k, status;
    mpm_io_csv_begin(&t, data_file(w, "two_particles.csv", path, sizeof path),
                     "offset_um,pbcp_percent,top_v_z_m_s,bottom_v_z_m_s,top,bottom,cell_um,spacing_um,geometry",
                     "A-two", &w->fault);
    say(w,
        "### A-two: one particle on another\n\nTwo of 14 um at 810 m/s, 3D (half), %.3g/%.3g um, after 100 ns; "
        "velocities of points up to 60 m/s, from the "
        "substrate's mean.\n\n| offset, um | PBCP, %%: source A | here | top v_z, m/s: source A | here | bottom v_z: "
        "source A | here | top | bottom | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        g.cell, g.spacing);
    for (k = 0; k < 5; k++) { /* the last: the first once more, on source A's grid */
        const int rings = k == 4, at = k % 4;
        const grid here = rings ? fine : g;
        two_scene(&q, here, rings ? "axisymmetric" : "3d", offset[at]);
        snprintf(folder, sizeof folder, "%s/two_%s_%g_%g_%g", w->s.folder, q.base.geometry, here.cell, here.spacing,
                 offset[at]);
        status = need_particles(w, &q, folder);
        if (status <= 0 || read_particles(folder, row, 2) != 2) {
            mpm_io_csv_end(&t, NULL);
            if (status > 0) snprintf(w->message, sizeof w->message, "%.300s/particles.csv has not two rows", folder);
            return status > 0 ? 0 : status;
        }
        say(w, "| %g%s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %s | %s | %.0f |\n", offset[at],
            rings ? ", axisymmetric, 0.7/0.175" : "", said[0][at], read_summary(folder, "pbcp_percent"), said[1][at],
            row[1].v_z, said[2][at], row[0].v_z, row[1].fate, row[0].fate, read_summary(folder, "cpu_seconds"));
        mpm_io_csv_real(&t, (mpm_real)offset[at]);
        mpm_io_csv_real(&t, (mpm_real)read_summary(folder, "pbcp_percent"));
        mpm_io_csv_real(&t, (mpm_real)row[1].v_z);
        mpm_io_csv_real(&t, (mpm_real)row[0].v_z);
        mpm_io_csv_text(&t, row[1].fate);
        mpm_io_csv_text(&t, row[0].fate);
        mpm_io_csv_real(&t, (mpm_real)here.cell);
        mpm_io_csv_real(&t, (mpm_real)here.spacing);
        mpm_io_csv_text(&t, q.base.geometry);
    }
    say(w, "\nSource A, 0.7/0.175 in 3D: the one at 7.5 um rebounds.\n\n");
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

static int ten_particles(work *w)
{
    static particles_case q;
    const grid fine = {1.0, 0.35}, g = particles_grid(w, fine);
    const double spread = 60;
    particle_row row[10];
    char folder[MPM_IO_PATH];
    int k, status;
    q = particles_default("full", "");
    q.base.cell = g.cell;
    q.base.spacing = g.spacing;
    q.count = 10;
    q.base.substrate_diameter = q.base.time = 0;
    if (!particles_place(&q, spread, particles_height(&q, spread), 1)) return 0;
    snprintf(folder, sizeof folder, "%s/ten_%g_%g_%g", w->s.folder, g.cell, g.spacing, spread);
    if ((status = need_particles(w, &q, folder)) <= 0) return status;
    say(w,
        "### A-ten: ten particles\n\nTen of 14 um at 810 m/s at random places and heights, 3D, %.3g/%.3g um, after "
        "%.0f ns. Source A (1.0/0.35): most bond, one is "
        "prevented by ejected material.\n\n| particle | fate | PBCP, %% | v_z, m/s | along the face, m/s | ejected, %% "
        "|\n|---|---|---|---|---|---|\n",
        g.cell, g.spacing, read_summary(folder, "time_ns"));
    for (k = 0; k < read_particles(folder, row, 10); k++)
        say(w, "| %d | %s | %.2f | %.2f | %.2f | %.1f |\n", k, row[k].fate, row[k].pbcp, row[k].v_z, row[k].v_along,
            100 * row[k].ejected);
    say(w, "\n%.0f of 10 bonded; PBCP of all surfaces %.2f %%. Cost: %.0f CPU s.\n\n", read_summary(folder, "bonded"),
        read_summary(folder, "pbcp_percent"), read_summary(folder, "cpu_seconds"));
    return 1;
}

/* ---- main ---------------------------------------------------------------------------------- */

typedef int (*part_fn)(work *w);

/* All parts, or those that --only names. As study_need. */
static int parts(work *w)
{
    static const struct {
        const char *name;
        part_fn run;
    } part[] = {{"conv", convergence},  {"dt", time_steps},    {"jet", jets},         {"crit", critical},
                {"scatter", scatter},   {"held", held_out},    {"cal", calibrations}, {"site", sites},
                {"two", two_particles}, {"ten", ten_particles}};
    const int count = (int)(sizeof part / sizeof part[0]), budget = w->budget;
    int k, status;
    say(w,
        "## Source A's results again\n\nMade by `make reproduction BUDGET=%s` (mpm.h %s); the tables are in "
        "[data](data).%s%s\n\n",
        w->budget_name, MPM_VERSION, *w->desk ? " At the desk budget: " : "", w->desk);
    for (k = 0; k < count; k++) {
        if (*w->only && !strstr(w->only, part[k].name)) continue;
        if (!w->s.quiet) fprintf(stderr, "\rA-%-97s\n", part[k].name);
        w->budget = budget == QUICK && strstr(w->desk, part[k].name) ? DESK : budget;
        status = part[k].run(w);
        study_progress_end(&w->s);
        if (status <= 0) return status;
    }
    return 1;
}

int main(int argc, char **argv)
{
    static char text[200000];
    static work w;
    option o[9];
    int n = 0, parsed, status;
    w.s = study_of("build/reproduction-out");
    w.text = text;
    w.room = sizeof text;
    w.budget_name = "quick";
    w.data = "docs/data";
    w.page = "docs/reproduction.md";
    w.only = w.desk = "";
    option_add(o, &n, "budget", OPTION_TEXT, &w.budget_name, "quick|desk|full");
    option_add(o, &n, "only", OPTION_TEXT, &w.only,
               "parts: of conv,dt,jet,crit,scatter,held,cal,site,two,ten; empty: all");
    option_add(o, &n, "desk", OPTION_TEXT, &w.desk, "parts that a quick budget runs as desk does");
    option_add(o, &n, "limit", OPTION_LONG, &w.s.limit, "stop after so many new runs; < 0: never");
    option_add(o, &n, "out", OPTION_TEXT, &w.s.folder, "finished runs, to go on from");
    option_add(o, &n, "data", OPTION_TEXT, &w.data, "folder for tables and plots");
    option_add(o, &n, "page", OPTION_TEXT, &w.page, "the page whose part is replaced");
    option_add(o, &n, "quiet", OPTION_FLAG, &w.s.quiet, "no progress");
    parsed = options_parse(
        argc, argv, "Source A's results again, beside its numbers; run again after an interruption, it goes on.", o, n);
    if (parsed) return parsed < 0;
    w.budget = case_word("quick|desk|full", w.budget_name);
    if (!case_knows("quick|desk|full", "budget", w.budget_name, w.message, sizeof w.message))
        return !complain(w.message);
    if (mpm_io_make_directory(w.data, &w.fault) < 0) return !report(&w.fault, w.data);
    status = parts(&w);
    if (status > 0) status = write_page(&w);
    if (status == 0) return !complain(w.message);
    if (status < 0) printf("stopped after %ld new runs; run again to go on\n", w.s.fresh);
    return status < 0 ? 3 : 0;
}
