/* scatter.c - where the scatter of the critical velocity comes from. SPDX-License-Identifier: MIT */
#include "reproduction.h"

/* ---- by the position of the grid ------------------------------------------------------------- */

/* How an impact began: the particle's surface points that are in contact (D > 0), a moment after the first touch. */
typedef struct touch {
    double gap; /* of the outer half of them to the other body, um: mean distance of the points less their spacing */
    double d;   /* mean D of all */
} touch;

/* Distance to the nearest point of the other body, um. */
static double touch_distance(const mpm_world *w, int32_t i)
{
    const mpm_body *b = &w->body[IMPACT_SUBSTRATE];
    const double r = study_radius(w, i), z = (double)w->points.x[2][i];
    double least = HUGE_VAL;
    int32_t j;
    for (j = b->first; j < b->first + b->active; j++)
        least = fmin(least, hypot(r - study_radius(w, j), z - (double)w->points.x[2][j]));
    return least;
}

static touch touch_measure(const mpm_world *w, double spacing)
{
    const mpm_points *p = &w->points;
    const mpm_body *b = &w->body[IMPACT_PARTICLE];
    const double inner = study_median_radius(w, 1e-12);
    double mass = 0;
    touch t;
    int32_t i;
    t.gap = 0;
    for (i = b->first; i < b->first + b->active; i++) {
        if (!(p->flags[i] & MPM_POINT_SURFACE) || !(p->bond[i] > 0) || study_radius(w, i) < inner) continue;
        t.gap += (double)p->mass[i] * (touch_distance(w, i) - spacing);
        mass += (double)p->mass[i];
    }
    t.gap = case_share(t.gap, mass);
    t.d = mpm_bond_measure_body(w, IMPACT_PARTICLE).abp;
    return t;
}

/* Runs a case for `ns` nanoseconds. Returns 1, or 0 with w->message. */
static int touch_after(work *w, impact_case c, double ns, touch *t)
{
    impact run;
    mpm_status status = MPM_OK;
    c.time = ns;
    if (!impact_begin(&run, &c, w->message, sizeof w->message)) return 0;
    while (status >= 0 && run.world.steps < run.steps) status = impact_step(&run);
    if (status < 0) mpm_io_fault_text(w->message, sizeof w->message, &run.world.fault);
    else *t = touch_measure(&run.world, c.spacing);
    impact_end(&run);
    return status >= 0;
}

#define POSITIONS 8
static const double early = 2; /* ns: a moment after the first touch */

/* One position: what is seen at the end, the critical velocity, and how the contact began. As need. */
static int position_row(work *w, impact_case c, double critical_velocity, double high)
{
    double none[STUDY_VALUES], value[STUDY_VALUES];
    touch t;
    int status;
    c.bond = "none";
    if ((status = need(w, c, none)) <= 0) return status;
    c.bond = "energy";
    if ((status = need(w, c, value)) <= 0) return status;
    if (!touch_after(w, c, early, &t)) return 0;
    say(w, "| %.3f | %.1f | %.3f | %.2f | %.1f | ", c.offset, none[STUDY_V_MEAN], value[STUDY_ABP], value[STUDY_PBCP],
        value[STUDY_V_MEAN]);
    say_velocity(w, critical_velocity, high);
    say(w, " | %.2f | %.2f |\n", t.gap, t.d);
    return 1;
}

/* One contact at eight positions of the grid. As need. */
static int positions(work *w, int where_points_touch)
{
    critical_range range = budget_range(w);
    critical_outcome out;
    impact_case c = case_on(budget_grid(w));
    int k, status;
    range.high = 1200;
    c.touch = where_points_touch;
    study_complete(&c, "thesis");
    plan(w, 1, 2 * POSITIONS + POSITIONS * critical_cost(&range));
    status = critical_repeat(w, c, VARY_GRID, "thesis", range, POSITIONS, &out);
    if (status <= 0) return status;
    w->s.whole = 1;
    say(w, "%s\n\n| grid plane over the interface, um | rebound without bond, m/s | mean D | PBCP, %% | rebound, m/s | "
           "critical velocity, m/s | after %g ns: gap, um | mean D of the particle |\n"
           "|---|---|---|---|---|---|---|---|\n", where_points_touch
               ? "Contact where the points touch:" : "Contact where bodies share a node, as in source A:", early);
    for (k = 0; k < POSITIONS; k++) {
        c.offset = c.cell * k / POSITIONS;
        if ((status = position_row(w, c, out.each[k], range.high)) <= 0) return status;
    }
    say(w, "\n");
    return 1;
}

/* ---- by the choices of the method -------------------------------------------------------------- */

typedef struct choice {
    const char *what;
    variation vary;
    const char *functions, *normal, *average, *substrate;
    int where_points_touch;
    double width, friction;
} choice;

#define CHOICES 13
static const choice choices[CHOICES] = {
    {"as source A", VARY_GRID, "linear", "ranked", "mean", "thesis", 0, 0, 0},
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

static impact_case choice_case(const work *w, const choice *k)
{
    impact_case c = case_on(budget_grid(w));
    c.functions = k->functions;
    c.normal = k->normal;
    c.bond_average = k->average;
    c.touch = k->where_points_touch;
    c.bond_width = k->width;
    c.friction = k->friction;
    study_complete(&c, k->substrate);
    return c;
}

/* A row of the table and of the file. As need. */
static int choice_row(work *w, mpm_io_csv *t, const choice *k, critical_range range)
{
    const int times = budget_times(w);
    critical_outcome out;
    const int status = critical_repeat(w, choice_case(w, k), k->vary, "thesis", range, times, &out);
    if (status <= 0) return status;
    mpm_io_csv_text(t, k->what);
    mpm_io_csv_real(t, (mpm_real)out.spread.median);
    mpm_io_csv_real(t, (mpm_real)out.spread.lowest);
    mpm_io_csv_real(t, (mpm_real)out.spread.highest);
    mpm_io_csv_integer(t, times);
    mpm_io_csv_integer(t, out.lost);
    say(w, "| %s | ", k->what);
    say_spread(w, &out.spread, range.high);
    say(w, " | %d | %.0f |\n", out.lost, out.cpu);
    return 1;
}

/* The critical velocity of 14 um over grid positions, one choice of the method changed at a time. As need. */
static int choice_table(work *w)
{
    const grid g = budget_grid(w);
    const int times = budget_times(w);
    critical_range range = budget_range(w);
    mpm_io_csv t;
    int k, status = 1;
    range.high = 1200;
    plan(w, 1, CHOICES * times * critical_cost(&range));
    table_begin(w, &t, "scatter.csv", "choice,critical_velocity_m_s,lowest_m_s,highest_m_s,offsets,not_bonded_above",
                "scatter");
    say(w, "Critical velocity of 14 um, rule \"thesis\", %d positions of the grid, %g/%g um, one choice changed, or "
           "several as named. The pair G_c, Gdot_c is source A's throughout: a choice that moves the median would need "
           "its own.\n\n"
           "| choice | median, m/s | lowest - highest | not above | CPU s |\n|---|---|---|---|---|\n",
        times, g.cell, g.spacing);
    for (k = 0; k < CHOICES && status > 0; k++) status = choice_row(w, &t, &choices[k], range);
    say(w, "\n");
    return table_end(w, &t, status);
}

int scatter(work *w)
{
    const grid g = budget_grid(w);
    int k, status;
    say(w, "### Where the scatter comes from\n\n14 um at 810 m/s, %g/%g um, axisymmetric, by the position of the grid: "
           "the rebound without bond, and with it mean D of the contacted points, PBCP, and the rebound; the critical "
           "velocity; and how the contact begins: the mean gap between the surfaces at the outer half of the "
           "particle's contacted points, and the mean D of all of them. A node is felt a cell away: the higher the "
           "highest plane that the substrate's top reaches, the wider the gap across which it slows the particle, and "
           "the less the surfaces are strained when they meet.\n\n", g.cell, g.spacing);
    for (k = 0; k < 2; k++)
        if ((status = positions(w, k)) <= 0) return status;
    return choice_table(w);
}
