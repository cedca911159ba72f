/* critical_velocity - the lowest velocity at which a particle bonds (source A, 5.2.2, Table 5.4).

   Runs a range of impact velocities, halves the gap under the lowest one that bonds, and does so at several
   positions of the grid, since the answer of this method depends on it, and with --grids 2 on a coarser grid too:
   what is uncertain about it is printed. Axisymmetric by default: a few seconds a run at 14 um. Every finished run
   is kept in the output folder under its whole description and never repeated; delete the folder after changing the
   headers. Source A: 824, 809, 791, 776, 761 m/s for 14, 18, 22, 26, 30 um. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "critical.h"
#include "report.h"

#define OFFSETS 32
#define COARSER 1.4 /* cells of the second grid over those of the first */

typedef struct request {
    study s;
    impact_case c;
    const char *substrate;
    int64_t offsets, grids;
    critical_rule rule;
    critical_range range;
    int no_report;
    option o[IMPACT_OPTIONS];
    int n; /* options */
} request;

typedef struct findings {
    critical_curve curve;
    critical_answer answer[OFFSETS];
    critical_spread spread;
} findings;

/* How far the answer can be off, m/s: half the bracket (NaN: the range begins bonded), half the spread over positions,
   the way to the answer of the coarser grid (NaN without one), and the root of the sum of squares of those that are
   known. */
typedef struct uncertainty {
    double bracket, positions, grid, all;
} uncertainty;

static const char *const program = "examples/studies/critical_velocity.c";

/* ---- what is written --------------------------------------------------------------------------- */

/* Every run: offset by offset in the order of velocity. */
static int by_velocity(const void *a, const void *b)
{
    const critical_run *x = (const critical_run *)a, *y = (const critical_run *)b;
    if (x->offset != y->offset) return (x->offset > y->offset) - (x->offset < y->offset);
    return (x->velocity > y->velocity) - (x->velocity < y->velocity);
}

static int write_curve(const request *q, const critical_curve *curve, mpm_fault *fault)
{
    char path[PATH_BYTES], columns[1000] = "grid_offset_um,velocity_m_s,bonds";
    mpm_io_csv t;
    int k, v;
    for (v = 0; v < STUDY_CPU; v++) {
        strcat(columns, ",");
        strcat(columns, study_name[v]);
    }
    mpm_io_csv_begin(&t, file_in(q->s.folder, "curve.csv", path, sizeof path), columns, NULL, fault);
    for (k = 0; k < curve->runs; k++) {
        mpm_io_csv_real(&t, (mpm_real)curve->run[k].offset);
        mpm_io_csv_real(&t, (mpm_real)curve->run[k].velocity);
        mpm_io_csv_integer(&t, curve->run[k].bonds);
        for (v = 0; v < STUDY_CPU; v++) mpm_io_csv_real(&t, (mpm_real)curve->run[k].value[v]);
    }
    return mpm_io_csv_end(&t, fault) >= 0;
}

/* PBCP and rebound velocity over impact velocity, a curve per offset. */
static int draw_curve(const request *q, const critical_curve *curve, mpm_fault *fault)
{
    static mpm_real x[CRITICAL_RUNS], y[2][CRITICAL_RUNS];
    mpm_draw_curve line[2][OFFSETS];
    char name[OFFSETS][40], path[PATH_BYTES];
    mpm_draw_plot_desc d[2];
    int k, p, count = 0;
    for (k = 0; k < curve->runs; k++) {
        const critical_run *r = &curve->run[k];
        if (k == 0 || r->offset != curve->run[k - 1].offset) {
            snprintf(name[count], sizeof name[0], "grid at %.3g um", r->offset);
            for (p = 0; p < 2; p++) line[p][count] = plot_curve(name[count], x + k, y[p] + k, 0, MPM_DRAW_CURVE, count);
            count++;
        }
        x[k] = (mpm_real)r->velocity;
        y[0][k] = (mpm_real)r->value[STUDY_PBCP];
        y[1][k] = (mpm_real)r->value[STUDY_V_REST];
        for (p = 0; p < 2; p++) line[p][count - 1].count++;
    }
    d[0] = plot_of("PBCP", "impact velocity, m/s", "%", line[0], count);
    d[1] = plot_of("rebound velocity", "impact velocity, m/s", "m/s", line[1], count);
    return plots_png(file_in(q->s.folder, "curve.png", path, sizeof path), d, 2, 2, 440, program, fault) >= 0;
}

static void write_answer(mpm_io_json *j, const critical_answer *a)
{
    char name[40];
    snprintf(name, sizeof name, "grid_offset_%.6g_um", a->offset);
    mpm_io_json_open(j, name);
    mpm_io_json_number(j, "critical_velocity_m_s", a->velocity);
    mpm_io_json_number(j, "not_bonded_below_m_s", a->below);
    mpm_io_json_number(j, "pbcp_percent", a->pbcp);
    mpm_io_json_number(j, "v_rest_m_s", a->v_rest);
    mpm_io_json_integer(j, "not_bonded_above", a->lost);
    mpm_io_json_close(j);
}

/* Of the findings f[0], and f[1] on the coarser grid. */
static uncertainty uncertainty_of(const request *q, const findings *f)
{
    const critical_spread *s = &f[0].spread;
    uncertainty u;
    u.bracket = s->middle.below > 0 ? (s->middle.velocity - s->middle.below) / 2 : NAN;
    u.positions = (s->highest - s->lowest) / 2;
    u.grid = q->grids > 1 ? fabs(s->median - f[1].spread.median) : NAN;
    u.all = sqrt(u.bracket * u.bracket + u.positions * u.positions + (q->grids > 1 ? u.grid * u.grid : 0));
    return u;
}

static void write_uncertainty(const request *q, const findings *f, mpm_io_json *j)
{
    const uncertainty u = uncertainty_of(q, f);
    mpm_io_json_number(j, "uncertainty_m_s", u.all);
    mpm_io_json_number(j, "uncertainty_of_bracket_m_s", u.bracket);
    mpm_io_json_number(j, "uncertainty_of_position_m_s", u.positions);
    mpm_io_json_number(j, "uncertainty_of_grid_m_s", u.grid);
    if (q->grids > 1) mpm_io_json_number(j, "coarser_grid_m_s", f[1].spread.median);
}

static int write_summary(const request *q, const findings *f, mpm_fault *fault)
{
    const critical_spread *s = &f->spread;
    char path[PATH_BYTES];
    mpm_io_json j;
    int k;
    mpm_io_json_begin(&j, file_in(q->s.folder, "summary.json", path, sizeof path), fault);
    /* null: nothing bonded at half of the positions or more */
    mpm_io_json_number(&j, "critical_velocity_m_s", s->median);
    mpm_io_json_number(&j, "not_bonded_below_m_s", s->middle.below);
    mpm_io_json_number(&j, "lowest_m_s", s->lowest);
    mpm_io_json_number(&j, "highest_m_s", s->highest);
    write_uncertainty(q, f, &j);
    mpm_io_json_integer(&j, "offsets_without_bond", s->none);
    mpm_io_json_number(&j, "pbcp_percent", s->middle.pbcp);
    mpm_io_json_number(&j, "v_rest_m_s", s->middle.v_rest);
    mpm_io_json_integer(&j, "runs", q->s.done);
    mpm_io_json_integer(&j, "runs_made_now", q->s.fresh);
    mpm_io_json_number(&j, "cpu_seconds_now", q->s.spent);
    mpm_io_json_open(&j, "by_offset");
    for (k = 0; k < q->offsets; k++) write_answer(&j, &f->answer[k]);
    mpm_io_json_close(&j);
    options_json(&j, q->o, q->n);
    return mpm_io_json_end(&j, fault) >= 0;
}

/* A velocity, or up to which nothing bonded. */
static const char *velocity_text(double velocity, const critical_range *range, char *text, size_t n)
{
    if (velocity < HUGE_VAL) snprintf(text, n, "%.4g m/s", velocity);
    else snprintf(text, n, "none up to %g m/s", range->low + (critical_scans(range) - 1) * range->scan);
    return text;
}

/* Every run as a place of the page's curves: y[0] rebound velocities, y[1] bonded shares; a curve per offset. */
typedef struct page_runs {
    double x[CRITICAL_RUNS], y[2][CRITICAL_RUNS], bonds[CRITICAL_RUNS];
    page_series series[2][OFFSETS];
    char name[OFFSETS][40];
    int count; /* offsets */
} page_runs;

static void page_runs_of(page_runs *t, const critical_curve *curve)
{
    int k, p;
    memset(t, 0, sizeof *t);
    for (k = 0; k < curve->runs; k++) {
        const critical_run *r = &curve->run[k];
        if (k == 0 || r->offset != curve->run[k - 1].offset)
            snprintf(t->name[t->count++], sizeof t->name[0], "grid at %.3g " PAGE_MU "m", r->offset);
        t->x[k] = r->velocity;
        t->bonds[k] = r->bonds;
        t->y[0][k] = r->value[STUDY_V_REST];
        t->y[1][k] = r->value[STUDY_PBCP];
        for (p = 0; p < 2; p++) {
            page_series *s = &t->series[p][t->count - 1];
            if (s->count++ > 0) continue;
            s->name = t->name[t->count - 1];
            s->x = t->x + k;
            s->y = t->y[p] + k;
            s->full = t->bonds + k;
            s->line = 1;
        }
    }
}

static page_panel page_panel_of(const page_runs *t, int p, const critical_spread *s)
{
    page_panel panel;
    panel.title = p ? "bonded share" : "rebound velocity";
    panel.x = "impact velocity, m/s";
    panel.y = p ? "%" : "m/s";
    panel.band = "Filled: the run bonds. The band goes from the lowest to the highest critical velocity over the "
                 "positions of the grid; the broken line is their median.";
    panel.series = t->series[p];
    panel.count = t->count;
    panel.low = s->lowest;
    panel.high = s->highest;
    panel.at = s->median;
    return panel;
}

/* report.html: what was found and how sure it is, with every run. */
static int write_page(const request *q, const findings *f, int argc, char **argv)
{
    static const page_row row[] = {
        {"critical_velocity_m_s", "critical velocity", "m/s", 1, 1, "median over the positions of the grid"},
        {"lowest_m_s", "lowest", "m/s", 1, 1, "of all positions"},
        {"highest_m_s", "highest", "m/s", 1, 1, "of all positions"},
        {"not_bonded_below_m_s", "not bonded at", "m/s", 1, 0,
         "the velocity next below that was tried: the search goes no finer than that"},
        {"offsets_without_bond", "positions without a bond", "", 0, 0, "where nothing bonded at any velocity"},
        {"pbcp_percent", "PBCP", "%", 2, 0,
         "bonded share of the surface that touched, at the critical velocity of the middle position"},
        {"v_rest_m_s", "rebound velocity", "m/s", 3, 0, "there"}, {"runs", "runs", "", 0, 0, "of the search"}};
    static page_runs runs;
    const critical_spread *s = &f->spread;
    page_panel panel[2];
    page_desc d = page_of(q->o, q->n, argc, argv);
    char verdict[120], lead[300], title[120], text[3][60];
    int p;
    page_runs_of(&runs, &f->curve);
    for (p = 0; p < 2; p++) panel[p] = page_panel_of(&runs, p, s);
    d.good = s->median < HUGE_VAL;
    snprintf(verdict, sizeof verdict, d.good ? "It bonds from %s on." : "It bonds at %s.",
             velocity_text(s->median, &q->range, text[0], sizeof text[0]));
    snprintf(lead, sizeof lead, "A particle of %s, %g " PAGE_MU "m across: the lowest velocity that bonds is %s to %s "
             "at %lld positions of the grid, each found to within %g m/s.", q->c.material, q->c.diameter,
             velocity_text(s->lowest, &q->range, text[1], sizeof text[1]),
             velocity_text(s->highest, &q->range, text[2], sizeof text[2]), (long long)q->offsets, q->range.step);
    snprintf(title, sizeof title, "Critical velocity of %s, %g " PAGE_MU "m", q->c.material, q->c.diameter);
    d.program = "critical_velocity";
    d.title = title;
    d.verdict = verdict;
    d.lead = lead;
    d.row = row;
    d.rows = (int)(sizeof row / sizeof *row);
    d.panel = panel;
    d.panels = 2;
    d.picture = "curve.png";
    return page_write(&d, q->s.folder);
}

/* The answer with what is uncertain about it; nothing where half of the positions do not bond, or nothing is below. */
static void print_uncertainty(const request *q, const findings *f)
{
    const uncertainty u = uncertainty_of(q, f);
    if (!(u.all < HUGE_VAL)) return;
    printf("  %.4g m/s, uncertain by %.3g: bracket %.3g, positions %.3g", f->spread.median, u.all, u.bracket,
           u.positions);
    if (q->grids > 1)
        printf(", grid %.3g (cells of %.3g um: %.4g)\n", u.grid, COARSER * q->c.cell, f[1].spread.median);
    else
        printf("; add --grids 2 for what the cells do\n");
}

static void print_answers(const request *q, const findings *f)
{
    const critical_spread *s = &f->spread;
    char text[3][60];
    int k;
    printf("\n  %s, %g um, rule %s; lowest velocity that bonds\n\n", q->c.material, q->c.diameter, q->rule.name);
    printf("  grid offset um   critical m/s   not below   PBCP %%   rebound m/s   not bonded above\n");
    for (k = 0; k < q->offsets; k++) {
        const critical_answer *a = &f->answer[k];
        if (a->velocity < HUGE_VAL)
            printf("  %14.4g   %12.4g   %9.4g   %6.2f   %11.3f   %16d\n", a->offset, a->velocity, a->below, a->pbcp,
                   a->v_rest, a->lost);
        else
            printf("  %14.4g   %s\n", a->offset, velocity_text(HUGE_VAL, &q->range, text[0], sizeof text[0]));
    }
    printf("\n  median %s, lowest %s, highest %s; %s/%scurve.csv, curve.png, summary.json\n",
           velocity_text(s->median, &q->range, text[0], sizeof text[0]),
           velocity_text(s->lowest, &q->range, text[1], sizeof text[1]),
           velocity_text(s->highest, &q->range, text[2], sizeof text[2]), q->s.folder,
           q->no_report ? "" : "report.html, ");
    print_uncertainty(q, f);
}

/* ---- main ---------------------------------------------------------------------------------- */

static void options(request *q)
{
    option *o = q->o;
    int n = study_case_options(&q->c, o);
    option_drop(o, &n, "velocity");    /* what is looked for */
    option_drop(o, &n, "grid-offset"); /* by --offsets */
    option_add_word(o, &n, "substrate", &q->substrate, STUDY_SUBSTRATES, "source A's sizes, or 5 x 2.5 diameters");
    option_add_word(o, &n, "rule", &q->rule.name, CRITICAL_RULES, "what counts as bonded");
    option_add(o, &n, "pbcp", OPTION_REAL, &q->rule.pbcp, "least PBCP, %; 0 with rule thesis: 5, up to 14 um 4.8");
    option_add(o, &n, "v-rest", OPTION_REAL, &q->rule.v_rest,
               "rule thesis: highest rebound, m/s; 0: 0.6, up to 14 um 0.9");
    option_add(o, &n, "stays", OPTION_REAL, &q->rule.stays, "rule stays: the late mean velocity is below, m/s");
    option_add(o, &n, "low", OPTION_REAL, &q->range.low, "lowest velocity, m/s");
    option_add(o, &n, "high", OPTION_REAL, &q->range.high, "highest velocity, m/s");
    option_add(o, &n, "scan", OPTION_REAL, &q->range.scan, "distance of the first velocities, m/s");
    option_add(o, &n, "step", OPTION_REAL, &q->range.step, "width of the bracket at the end, m/s");
    option_add(o, &n, "offsets", OPTION_INTEGER, &q->offsets, "grid offsets: k/N of a cell, k = 0 .. N-1");
    option_add(o, &n, "grids", OPTION_INTEGER, &q->grids,
               "1, or 2: once more with cells, spacing and step 1.4 times as large, for the uncertainty");
    study_options(&q->s, o, &n);
    option_add(o, &n, "no-report", OPTION_FLAG, &q->no_report, "no report.html");
    q->n = n;
}

/* Refuses what makes no search. */
static int check(const request *q, char *m, size_t n)
{
    return impact_check(&q->c, m, n) &&
           case_wants(q->offsets >= 1 && q->offsets <= OFFSETS, "offsets", (double)q->offsets, "must be 1 .. 32", m,
                      n) &&
           case_wants(q->grids >= 1 && q->grids <= 2, "grids", (double)q->grids, "must be 1 or 2", m, n) &&
           case_wants(q->rule.pbcp >= 0, "pbcp", q->rule.pbcp, "must be >= 0 %", m, n) &&
           case_wants(q->rule.v_rest >= 0, "v-rest", q->rule.v_rest, "must be >= 0 m/s", m, n) &&
           case_wants(q->rule.stays > 0, "stays", q->rule.stays, "must be > 0 m/s", m, n) &&
           case_wants(q->range.low > 0, "low", q->range.low, "must be > 0 m/s", m, n) &&
           case_wants(q->range.high >= q->range.low && q->range.high < 1e5, "high", q->range.high,
                      "must not be under --low", m, n) &&
           case_wants(q->range.step >= 1e-6, "step", q->range.step, "must be 1e-6 m/s or more", m, n) &&
           case_wants(q->range.scan >= q->range.step && q->range.scan < 1e5, "scan", q->range.scan,
                      "must be in [--step, 1e5) m/s", m, n) &&
           case_wants((q->range.high - q->range.low) / q->range.scan < CRITICAL_RUNS &&
                          critical_cost(&q->range) * q->offsets <= CRITICAL_RUNS,
                      "scan", q->range.scan, "makes more than 2000 runs", m, n);
}

/* All offsets of the grid of q->c. As study_need. */
static int search_grid(request *q, findings *f, char *message, size_t n)
{
    const int surface = !strcmp(q->c.method, "surface");
    const double middle = (q->range.low + q->range.high) / 2;
    critical_answer guess;
    int k, status = 1;
    memset(&guess, 0, sizeof guess);
    guess.below = middle - q->range.scan / 2;
    guess.velocity = middle + q->range.scan / 2;
    q->s.planned = q->s.done + (surface ? critical_cost_near(&q->range) : critical_cost(&q->range)) * q->offsets;
    for (k = 0; k < q->offsets && status > 0; k++) {
        q->c.offset = q->c.cell * k / (double)q->offsets;
        status = critical_search(&q->s, &q->c, &q->range, &q->rule, surface ? &guess : NULL, &f->curve, &f->answer[k],
                                 message, n);
        if (f->answer[k].velocity < HUGE_VAL && f->answer[k].below > 0) guess = f->answer[k]; /* the next one's */
        study_progress_end(&q->s);
    }
    if (status <= 0) return status;
    f->spread = critical_summary(f->answer, (int)q->offsets);
    qsort(f->curve.run, (size_t)f->curve.runs, sizeof f->curve.run[0], by_velocity);
    return 1;
}

/* All grids. As study_need. */
static int search(request *q, findings *f, char *message, size_t n)
{
    const impact_case given = q->c;
    int status = search_grid(q, &f[0], message, n);
    if (status <= 0 || q->grids < 2) return status;
    q->c.cell *= COARSER;
    q->c.spacing *= COARSER;
    q->c.dt_factor *= COARSER;
    status = impact_check(&q->c, message, n) ? search_grid(q, &f[1], message, n) : 0;
    q->c = given;
    return status;
}

static int carry_out(int argc, char **argv)
{
    static findings f[2]; /* with cells as asked for; coarser */
    const int surface = !strcmp(impact_method(argc, argv, "surface"), "surface");
    request q;
    char message[400];
    mpm_fault fault;
    int status;
    q.no_report = 0;
    q.s = study_of("build/critical_velocity-out");
    q.c = surface ? impact_case_surface() : study_case_default();
    q.substrate = "thesis";
    q.offsets = surface ? 4 : 1;
    q.grids = 1;
    q.rule = critical_rule_default();
    q.range = critical_range_default();
    if (surface) {
        q.rule.name = "stays";
        q.rule.stays = 5;
        q.rule.pbcp = CRITICAL_LEFT;
        q.range.low = 600;
    }
    options(&q);
    status = options_parse(argc, argv, "The lowest impact velocity that bonds (source A, 5.2.2). Writes report.html,\n"
                           "curve.csv, curve.png and summary.json into the output folder; run again after an\n"
                           "interruption, it goes on.", q.o, q.n);
    if (status) return status < 0;
    study_complete(&q.c, q.substrate);
    status = check(&q, message, sizeof message) ? search(&q, f, message, sizeof message) : 0;
    if (status == 0) return !complain(message);
    if (status < 0) return study_stopped(&q.s);
    if (!write_curve(&q, &f->curve, &fault) || !draw_curve(&q, &f->curve, &fault) || !write_summary(&q, f, &fault))
        return !report(&fault, q.s.folder);
    if (!q.no_report && !write_page(&q, f, argc, argv)) return 1;
    if (!q.s.quiet) print_answers(&q, f);
    return 0;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
