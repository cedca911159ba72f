/* reproduction - the results of source A's chapters 4 and 5 again, beside its numbers.

   Runs the cases A-conv, A-dt, A-jet, A-crit, A-cal, A-site, A-two and A-ten, and what explains them, at a stated
   budget: "quick" on the coarsest grid (an hour of one core), "desk" at 1.0/0.25 um in axisymmetry with
   checks at 0.7/0.175 um and in 3D (some nine hours), "full" with every row of the tables (days). Writes tables and
   plots into --data and replaces its part of --page.
   Every finished run is kept in --out and never repeated (but for the first nanoseconds of sixteen impacts, which take
   a second or two); delete the folder after changing the headers.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "calibration.h"
#include "particles_case.h"
#include "reproduction_scatter.h"

/* ---- A-conv -------------------------------------------------------------------------------- */

/* One grid by both return mappings: a row of the table and of the file; low and high [strain, energy][mapping]
   follow. As study_need. */
static int convergence_row(work *w, mpm_io_csv *t, grid g, double low[2][2], double high[2][2], double *cpu)
{
    static const char *const mapping[2] = {"consistent", "staged"};
    double value[2][STUDY_VALUES];
    int k, v, status;
    for (k = 0; k < 2; k++) {
        impact_case c = study_case_default();
        c.cell = g.cell;
        c.spacing = g.spacing;
        c.bond = "none";
        c.dt_factor = 0.05;
        c.plasticity = mapping[k];
        study_complete(&c, "thesis");
        if ((status = study_need(&w->s, &c, value[k], w->message, sizeof w->message)) <= 0) return status;
        for (v = 0; v < 2; v++) {
            low[v][k] = fmin(low[v][k], value[k][v ? STUDY_WORK : STUDY_EPS]);
            high[v][k] = fmax(high[v][k], value[k][v ? STUDY_WORK : STUDY_EPS]);
        }
        *cpu += value[k][STUDY_CPU];
        mpm_io_csv_real(t, (mpm_real)g.cell);
        mpm_io_csv_real(t, (mpm_real)g.spacing);
        mpm_io_csv_text(t, mapping[k]);
        mpm_io_csv_real(t, (mpm_real)value[k][STUDY_EPS]);
        mpm_io_csv_real(t, (mpm_real)value[k][STUDY_WORK]);
        mpm_io_csv_integer(t, (long)value[k][STUDY_POINTS]);
        mpm_io_csv_integer(t, (long)value[k][STUDY_STEPS]);
    }
    say(w, "| %.3g/%.3g | %.4f | %.1f | %.4f | %.1f | %.0f |\n", g.cell, g.spacing, value[0][STUDY_EPS],
        value[0][STUDY_WORK], value[1][STUDY_EPS], value[1][STUDY_WORK], value[0][STUDY_POINTS]);
    return 1;
}

static int convergence(work *w)
{
    static const grid grids[9] = {{1.5, 0.5}, {1.5, 0.4}, {1.5, 0.35}, {1.0, 0.4}, {1.0, 0.35}, {1.0, 0.25},
                                  {0.5, 0.2}, {0.5, 0.175}, {0.5, 0.15}};
    const int count = w->budget == QUICK ? 6 : 9;
    double low[2][2] = {{HUGE_VAL, HUGE_VAL}, {HUGE_VAL, HUGE_VAL}}, high[2][2] = {{0, 0}, {0, 0}}, cpu = 0;
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int k, status = 1;
    w->s.early = 0;
    w->s.planned = w->s.done + 2 * count;
    mpm_io_csv_begin(&t, data_file(w, "convergence.csv", path, sizeof path),
                     "cell_um,spacing_um,return_mapping,eps_mean,plastic_energy_density_MPa,points,steps",
                     "A-conv", &w->fault);
    say(w, "### A-conv: grids without bonding\n\n14 um at 810 m/s, frictionless, no bond, axisymmetric, time step "
           "factor 0.05, after 80 ns; with the consistent return mapping and with that of source A's appendix. Source "
           "A (figures): the mean plastic strain depends strongly on the cell, hardly on the spacing; the mean plastic "
           "energy density much less.\n\n| cell/spacing, um | mean plastic strain | plastic energy density, MPa | "
           "staged: strain | energy density, MPa | points |\n|---|---|---|---|---|---|\n");
    for (k = 0; k < count && status > 0; k++) status = convergence_row(w, &t, grids[k], low, high, &cpu);
    if (status <= 0) {
        mpm_io_csv_drop(&t);
        return status;
    }
    say(w, "\nFrom the lowest to the highest of these grids: strain %+.1f %%, energy density %+.1f %%; staged %+.1f %% "
           "and %+.1f %%. Cost: %.0f CPU s.\n\n", 100 * (high[0][0] / low[0][0] - 1),
        100 * (high[1][0] / low[1][0] - 1), 100 * (high[0][1] / low[0][1] - 1), 100 * (high[1][1] / low[1][1] - 1),
        cpu);
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

/* ---- the substrate ------------------------------------------------------------------------- */

/* What the size of the substrate does to a rebound without bond, where no threshold blurs it. */
static int substrates(work *w)
{
    static const double size[4][2] = {{30, 10}, {50, 20}, {70, 35}, {100, 50}};
    double value[STUDY_VALUES];
    int k, status;
    w->s.early = 0;
    w->s.planned = w->s.done + 4;
    say(w, "### How large a substrate must be\n\n14 um at 810 m/s without bond, %s um, axisymmetric, dampers at bottom "
           "and side, after 80 ns. Source A: 30 x 10 um; \"large\" below: 70 x 35.\n\n"
           "| substrate, um | rebound velocity, m/s | mean plastic strain | height lost, share |\n|---|---|---|---|\n",
        budget_grid(w));
    for (k = 0; k < 4; k++) {
        impact_case c = budget_case(w);
        c.bond = "none";
        c.substrate_diameter = size[k][0];
        c.substrate_height = size[k][1];
        study_complete(&c, "thesis");
        if ((status = study_need(&w->s, &c, value, w->message, sizeof w->message)) <= 0) return status;
        say(w, "| %g x %g | %.1f | %.3f | %.3f |\n", size[k][0], size[k][1], value[STUDY_V_MEAN], value[STUDY_EPS],
            value[STUDY_FLATTENING]);
    }
    say(w, "\n");
    return 1;
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
    static const grid grids[3] = {{1.5, 0.5}, {1.0, 0.25}, {0.7, 0.175}};
    static const double size[2] = {45, 38}, speed[2] = {550, 780};
    static const char *const said[2] = {"no jet, rebounds", "jet from the particle's rim, bonded"};
    const int count = w->budget == QUICK ? 1 : 3;
    double value[STUDY_VALUES];
    int g, k, status;
    w->s.early = 0;
    w->s.planned = w->s.done + 2 * count;
    say(w, "### A-jet: below and above the critical velocity\n\n| impact | source A | cell/spacing, um | rim of the "
           "substrate, um | both bodies strained beyond 3, %% of the particle | faster than 60 m/s, %% | mean velocity "
           "at the end, m/s | PBCP, %% | height lost, share | CPU s |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < 2; k++)
        for (g = 0; g < count; g++) {
            impact_case c = study_case_default();
            c.diameter = size[k];
            c.velocity = speed[k];
            c.cell = grids[g].cell;
            c.spacing = grids[g].spacing;
            study_complete(&c, "thesis");
            if ((status = study_need(&w->s, &c, value, w->message, sizeof w->message)) <= 0) return status;
            say(w, "| %g um at %g m/s | %s | %.3g/%.3g | %.2f | %.2f | %.1f | %.2f | %.2f | %.3f | %.0f |\n", size[k],
                speed[k], said[k], c.cell, c.spacing, value[STUDY_RIM], 100 * value[STUDY_SHEARED],
                100 * value[STUDY_EJECTED], value[STUDY_V_LATE], value[STUDY_PBCP], value[STUDY_FLATTENING],
                value[STUDY_CPU]);
        }
    say(w, "\nAt 0.7/0.175 um, by `make impacts`: [38 um](data/jet_38.png), [45 um](data/jet_45.png).\n\n");
    return 1;
}

/* ---- A-cal --------------------------------------------------------------------------------- */

/* The highest Gdot_c of a column of the sweep that bonds a size; 0: none. */
static double calibration_edge(const calibration *q, const calibration_side *side, long column)
{
    long row;
    for (row = q->rows - 1; row >= 0; row--)
        if (side->map.bonds[row * q->columns + column] == 1) return calibration_gdot(q, row * q->columns + column);
    return 0;
}

/* The extremes of an edge over the grids. */
typedef struct edge_range {
    double low, high;
} edge_range;

/* G_c of the crossings by fits with other ridges: "2636; 3390; -". */
static void say_ridges(work *w, const calibration *q)
{
    static const double ridge[3] = {1e-3, 1e-5, 1e-6};
    static calibration_result r;
    int i, k;
    for (i = 0; i < 3; i++) {
        calibration other = *q;
        other.ridge = ridge[i];
        calibration_collect(&other, &w->s, &r);
        say(w, "%s", i ? "; " : " | ");
        for (k = 0; k < r.points; k++) say(w, "%s%.0f", k ? ", " : "", r.point[k][0]);
        if (r.points == 0) say(w, "-");
    }
}

/* A row of the table, and of the file one per column; the edges at the inner columns go into
   range[column][size]. */
static void calibration_row(work *w, mpm_io_csv *t, const calibration *q, const calibration_result *r,
                            const char *picture, edge_range range[][2])
{
    long column, node, only[2] = {0, 0};
    int k;
    say(w, "| %.3g/%.3g | %s | %ld | %ld, %ld |", q->base.cell, q->base.spacing, q->rule,
        r->side[0].tests + r->side[1].tests, r->side[0].status >= 0 ? r->side[0].fit.wrong : 0,
        r->side[1].status >= 0 ? r->side[1].fit.wrong : 0);
    for (column = 0; column < q->columns; column++) {
        mpm_io_csv_real(t, (mpm_real)q->base.cell);
        mpm_io_csv_real(t, (mpm_real)q->base.spacing);
        mpm_io_csv_text(t, q->rule);
        mpm_io_csv_real(t, (mpm_real)calibration_gc(q, column));
        for (k = 0; k < 2; k++) mpm_io_csv_real(t, (mpm_real)calibration_edge(q, &r->side[k], column));
    }
    for (column = 1; column < q->columns - 1; column++) {
        for (k = 0; k < 2; k++) {
            const double edge = calibration_edge(q, &r->side[k], column);
            range[column - 1][k].low = fmin(range[column - 1][k].low, edge);
            range[column - 1][k].high = fmax(range[column - 1][k].high, edge);
            say(w, "%s%.3g", k ? ", " : " ", edge);
        }
        say(w, " |");
    }
    for (node = 0; node < calibration_nodes(q); node++)
        for (k = 0; k < 2; k++)
            only[k] += r->side[k].map.bonds[node] == 1 && r->side[1 - k].map.bonds[node] == 0;
    say(w, " [%s](data/%s)", r->points ? "crossing" : "none", picture);
    for (k = 0; k < r->points; k++) say(w, "%s%.0f, %.3g", k ? "; " : ": ", r->point[k][0], r->point[k][1]);
    say_ridges(w, q);
    say(w, " | %ld, %ld |\n", only[0], only[1]);
}

#define INNER 3 /* columns of the sweep that the table shows: all but the first and the last */

/* All grids by both rules. As study_need. */
static int calibration_rows(work *w, mpm_io_csv *t, int count, edge_range range[2][INNER][2], int crossed[2])
{
    static const grid grids[9] = {{1.5, 0.5},  {1.5, 0.35}, {1.5, 0.3},   {1.0, 0.35}, {1.0, 0.25},
                                  {0.7, 0.25}, {1.0, 0.2},  {0.7, 0.175}, {0.7, 0.15}};
    static calibration_result result;
    char path[MPM_IO_PATH], name[60];
    int g, r, status;
    for (g = 0; g < count; g++)
        for (r = 0; r < 2; r++) {
            calibration q = calibration_default();
            q.base.cell = grids[g].cell;
            q.base.spacing = grids[g].spacing;
            q.rule = rule_names[r];
            q.columns = INNER + 2;
            q.rows = 17;
            calibration_tolerances(q.base.cell, q.base.spacing, q.pbcp, q.restitution);
            if ((status = calibration_run(&q, &w->s, w->message, sizeof w->message)) <= 0) return status;
            calibration_collect(&q, &w->s, &result);
            snprintf(name, sizeof name, "calibration_%g_%g_%s.png", grids[g].cell, grids[g].spacing, rule_names[r]);
            if (!calibration_draw(&q, &result, data_file(w, name, path, sizeof path), "A-cal", &w->fault))
                return failed(w);
            calibration_row(w, t, &q, &result, name, range[r]);
            crossed[r] += result.points > 0;
        }
    return 1;
}

static int calibrations(work *w)
{
    edge_range range[2][INNER][2]; /* of rule, column, size */
    const int count = w->budget == QUICK ? 1 : 9;
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int r, k, column, crossed[2] = {0, 0}, status;
    w->s.early = 1;
    for (k = 0; k < 4 * INNER; k++) {
        edge_range *e = &range[k / 2 / INNER][k / 2 % INNER][k % 2];
        e->low = HUGE_VAL;
        e->high = 0;
    }
    mpm_io_csv_begin(&t, data_file(w, "calibration.csv", path, sizeof path),
                     "cell_um,spacing_um,rule,gc,highest_gdot_14um,highest_gdot_30um", "A-cal; 0: none bonds",
                     &w->fault);
    say(w, "### A-cal: calibration\n\n14 um at 810 m/s and 30 um at 770 m/s, axisymmetric, the interface on a grid "
           "plane, time step factor 0.2, runs where the class changes; Gdot_c in steps of %.0f %%. Source A: G_c "
           "1503.74 J/m2 and 2.271 (read as e5 J/(m2 us)) at 0.7/0.175, nearly the same on all grids. Rule \"thesis\": "
           "PBCP and restitution tolerances of its Table 5.2 for the grid. The fits have a ridge of %g: separable "
           "classes leave the boundary open without one.\n\n"
           "| cell/spacing, um | rule | runs | on the wrong side, 14, 30 um | highest Gdot_c that bonds 14, 30 um at "
           "G_c 1057 | 2236 | 4729 | crossings: G_c, Gdot_c | G_c with ridge 1e-3; 1e-5; 1e-6 | pairs run at both: "
           "only 14 um bonds, only 30 um |\n|---|---|---|---|---|---|---|---|---|---|\n",
        100 * (pow(20, 1.0 / 16) - 1), calibration_default().ridge);
    if ((status = calibration_rows(w, &t, count, range, crossed)) <= 0) {
        mpm_io_csv_drop(&t);
        return status;
    }
    for (r = 0; r < 2; r++) {
        say(w, "%sRule \"%s\": the boundaries of the two sizes cross on %d of %d grids; over the grids the edge of 14 "
               "um lies at", r ? "" : "\n", rule_names[r], crossed[r], count);
        for (k = 0; k < 2; k++) {
            say(w, k ? ", that of 30 um at" : "");
            for (column = 0; column < INNER; column++)
                say(w, "%s %.3g - %.3g", column ? "," : "", range[r][column][k].low, range[r][column][k].high);
        }
        say(w, ".\n");
    }
    say(w, "\n");
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

/* ---- A-site -------------------------------------------------------------------------------- */

/* One position of the grid by both rules; the strain rule's critical strain is halved in on the PBCP that the energy
   rule gives. As study_need. */
static int site(work *w, impact_case c, double value[2][STUDY_VALUES], double *strain)
{
    double tried[STUDY_VALUES], low = 0.5, high = 8, off, least = HUGE_VAL;
    int k, status;
    c.bond = "energy";
    if ((status = study_need(&w->s, &c, value[0], w->message, sizeof w->message)) <= 0) return status;
    c.bond = "strain";
    for (k = 0; k < 9; k++) {
        c.eps_c = (low + high) / 2;
        if ((status = study_need(&w->s, &c, tried, w->message, sizeof w->message)) <= 0) return status;
        if (tried[STUDY_PBCP] > value[0][STUDY_PBCP]) low = c.eps_c;
        else high = c.eps_c;
        off = fabs(tried[STUDY_PBCP] - value[0][STUDY_PBCP]);
        if (off >= least) continue;
        least = off;
        memcpy(value[1], tried, sizeof tried); /* the nearest so far */
        *strain = c.eps_c;
    }
    return 1;
}

static int sites(work *w)
{
    const int times = budget_times(w);
    double value[2][STUDY_VALUES], strain = 0, inner[2] = {0, 0};
    impact_case c = budget_case(w);
    int k, r, nearer = 0, status;
    if (w->budget != QUICK) c.cell = 0.7, c.spacing = 0.175;
    c.time = 30; /* as its Fig. 5.17 */
    study_complete(&c, "thesis");
    w->s.early = 0;
    w->s.planned = w->s.done + 10 * times;
    say(w, "### A-site: where it bonds\n\n14 um at 810 m/s after 30 ns, %.3g/%.3g um, axisymmetric. Source A: at equal "
           "PBCP the energy rule bonds nearer the south pole, the strain rule at the rim. At each position of the grid "
           "the critical strain was halved in on the PBCP of the energy rule. Distance: median of the bonded points "
           "from the axis over that of the contacted ones; inner half: share of the bonded ones within half the "
           "contact radius (sqrt 2 of that median), a quarter if evenly spread.\n\n"
           "| grid plane over the interface, um | critical strain | PBCP, %%: energy | strain | distance: energy "
           "| strain | inner half, %%: energy | strain |\n|---|---|---|---|---|---|---|---|\n", c.cell, c.spacing);
    for (k = 0; k < times; k++) {
        double ratio[2];
        c.offset = c.cell * k / times;
        if ((status = site(w, c, value, &strain)) <= 0) return status;
        for (r = 0; r < 2; r++) {
            ratio[r] = case_share(value[r][STUDY_R_BONDED], value[r][STUDY_R_CONTACT]);
            inner[r] += value[r][STUDY_INNER] / times;
        }
        nearer += ratio[0] < ratio[1];
        say(w, "| %.3f | %.3g | %.2f | %.2f | %.3f | %.3f | %.1f | %.1f |\n", c.offset, strain, value[0][STUDY_PBCP],
            value[1][STUDY_PBCP], ratio[0], ratio[1], 100 * value[0][STUDY_INNER], 100 * value[1][STUDY_INNER]);
    }
    say(w, "\nThe energy rule bonds nearer the axis at %d of %d positions; inner half on average %.1f %% (energy) and "
           "%.1f %% (strain).\n\n", nearer, times, 100 * inner[0], 100 * inner[1]);
    return 1;
}

/* ---- A-two, A-ten -------------------------------------------------------------------------- */

typedef struct particle_row {
    char fate[20];
    double pbcp, v_z, v_along, ejected;
} particle_row;

/* Reads the report of a finished scene of `count` particles; that of its pairs must be there too. Returns 1, or 0
   with a message. */
static int read_particles(work *w, const char *folder, particle_row *row, int count)
{
    char path[MPM_IO_PATH], line[400];
    int n = 0, id;
    FILE *f = fopen(file_in(folder, "particles.csv", path, sizeof path), "rb");
    while (f && n < count && fgets(line, sizeof line, f))
        if (sscanf(line, "%d,%*f,%*f,%*f,%19[^,],%lf,%*d,%*d,%*d,%lf,%lf,%lf", &id, row[n].fate, &row[n].pbcp,
                   &row[n].v_z, &row[n].v_along, &row[n].ejected) == 6)
            n++;
    if (f) fclose(f);
    if (n != count) {
        snprintf(w->message, sizeof w->message, "%.300s has not %d rows", path, count);
        return 0;
    }
    f = fopen(file_in(folder, "pairs.csv", path, sizeof path), "rb"); /* for read_pair */
    if (!f) snprintf(w->message, sizeof w->message, "%.300s cannot be read", path);
    else fclose(f);
    return f != NULL;
}

/* A pair of bodies of a finished scene. */
typedef struct pair_row {
    double pbcp; /* %; 0 if they never met */
    int held;    /* node pairs that the bond held in the last step */
} pair_row;

/* Of bodies a < b; with b < 0 of a and any other: then the sum of the held. */
static pair_row read_pair(const char *folder, int a, int b)
{
    char path[MPM_IO_PATH], line[400];
    pair_row r = {0, 0};
    double pbcp;
    int i, j, held;
    FILE *f = fopen(file_in(folder, "pairs.csv", path, sizeof path), "rb");
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "%d,%d,%lf,%*d,%*d,%*d,%d", &i, &j, &pbcp, &held) == 4 &&
            (b < 0 ? i == a || j == a : i == a && j == b)) {
            r.pbcp = pbcp;
            r.held += held;
        }
    if (f) fclose(f);
    return r;
}

/* A number of a finished scene's summary; -1 if there is none. */
static double read_summary(const char *folder, const char *key)
{
    static char text[20000];
    char path[MPM_IO_PATH];
    const char *at = json_value(text_in(file_in(folder, "summary.json", path, sizeof path), text, sizeof text), key);
    return at ? strtod(at, NULL) : -1;
}

/* Two particles of 14 um, the second aside and its centre 30 um up: on which grid and how whole, by whose normals, with
   which pair, at which offsets and on which budgets (bits). */
typedef struct two_runs {
    grid g;
    const char *geometry, *symmetry;
    int normal, pair;     /* their numbers */
    int offsets, budgets; /* bits */
} two_runs;

#define OFFSETS 4
static const double two_offset[OFFSETS] = {0, 2.5, 5, 7.5};

/* Whose gradient the normal of the particles' contact follows: source A numbered its bodies by chance and took the
   higher one's. */
enum { BY_TOP, BY_BOTTOM, BY_BOTH };
static const char *const normal_of[3] = {"top", "bottom", "both"};

#define TWO_SETS 13
static const two_runs two_sets[TWO_SETS] = {
    {{1.5, 0.5}, "3d", "half", BY_TOP, SOURCE_PAIR, 15, 1 << QUICK},
    {{1.0, 0.35}, "3d", "half", BY_TOP, SOURCE_PAIR, 15, 1 << DESK},
    {{1.0, 0.35}, "3d", "half", BY_BOTTOM, SOURCE_PAIR, 15, 1 << DESK},
    {{1.0, 0.35}, "3d", "half", BY_BOTH, SOURCE_PAIR, 15, 1 << DESK},
    {{0.7, 0.175}, "3d", "quarter", BY_TOP, SOURCE_PAIR, 1, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "3d", "half", BY_TOP, SOURCE_PAIR, 8, 1 << DESK},
    {{0.7, 0.175}, "3d", "half", BY_TOP, SOURCE_PAIR, 14, 1 << FULL},
    {{0.7, 0.175}, "3d", "quarter", BY_BOTH, SOURCE_PAIR, 1, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "3d", "half", BY_BOTH, SOURCE_PAIR, 8, 1 << DESK},
    {{0.7, 0.175}, "3d", "half", BY_BOTH, SOURCE_PAIR, 14, 1 << FULL},
    {{0.7, 0.175}, "3d", "quarter", BY_TOP, OWN_PAIR, 1, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "3d", "half", BY_TOP, OWN_PAIR, 8, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "axisymmetric", "quarter", BY_TOP, SOURCE_PAIR, 1, 1 << QUICK | 1 << DESK | 1 << FULL}};

static void two_scene(particles_case *q, const two_runs *r, int offset)
{
    const int top = r->normal == BY_BOTTOM ? 0 : 1; /* the higher number leads */
    *q = particles_default(r->symmetry, "");
    q->base.geometry = r->geometry;
    q->base.cell = r->g.cell;
    q->base.spacing = r->g.spacing;
    q->base.gc = pairs[r->pair].gc;
    q->base.gdot = pairs[r->pair].gdot;
    if (r->normal == BY_BOTH) q->base.normal = "average";
    q->count = 2;
    q->center[1 - top][2] = q->base.diameter / 2;
    q->center[top][0] = two_offset[offset];
    q->center[top][2] = 30;
}

/* Runs a scene unless the folder holds it. As study_need. */
static int need_particles(work *w, particles_case *q, const char *folder)
{
    option o[IMPACT_OPTIONS];
    const int n = particles_options(q, o);
    q->out.folder = folder;
    q->out.quiet = w->s.quiet;
    if (particles_finished(q)) return 1;
    if (w->s.limit >= 0 && w->s.fresh >= w->s.limit) return -1;
    w->s.fresh++;
    if (particles_main(q, o, n)) {
        snprintf(w->message, sizeof w->message, "the scene of %.300s failed", folder);
        return 0;
    }
    return 1;
}

/* The last picture of a scene into the folder of data; an old one there goes only when there is a new one. */
static int keep_picture(work *w, const particles_case *q, const char *folder, const char *name)
{
    char from[MPM_IO_PATH], to[MPM_IO_PATH];
    unsigned char part[4096];
    size_t n;
    FILE *in, *out;
    int ok;
    snprintf(from, sizeof from, "%s/frame_%04ld.png", folder, q->out.frames - 1);
    in = fopen(from, "rb");
    out = in ? fopen(data_file(w, name, to, sizeof to), "wb") : NULL;
    while (out && (n = fread(part, 1, sizeof part, in)) > 0) fwrite(part, 1, n, out);
    ok = out && !ferror(in) && !ferror(out);
    if (in) fclose(in);
    if (out && fclose(out)) ok = 0;
    if (!ok) snprintf(w->message, sizeof w->message, "cannot copy %.150s to %.100s/%.50s", from, w->data, name);
    return ok;
}

/* One scene: a row of the table and of the file. As study_need. */
static int two_row(work *w, mpm_io_csv *t, const two_runs *r, int at)
{
    static const double said[3][OFFSETS] = {{5.73, 5.47, 4.71, 3.91}, {2.02, 1.65, 6.06, 16.24},
                                            {1.24, 0.92, 0.94, -0.53}};
    static particles_case q;
    const int rings = strcmp(r->geometry, "3d") != 0, top = r->normal == BY_BOTTOM ? 0 : 1;
    particle_row row[2];
    pair_row both, base;
    char folder[MPM_IO_PATH], name[60], picture[64];
    int status;
    two_scene(&q, r, at);
    snprintf(name, sizeof name, "two_%s_%g_%g_by_%s%s", r->geometry, r->g.cell, two_offset[at], normal_of[r->normal],
             r->pair == OWN_PAIR ? "_own" : "");
    snprintf(folder, sizeof folder, "%s/%s", w->s.folder, name);
    if ((status = need_particles(w, &q, folder)) <= 0) return status;
    if (!read_particles(w, folder, row, 2)) return 0;
    both = read_pair(folder, 0, 1);
    base = read_pair(folder, 1 - top, 2);
    say(w, "| %g | %.3g/%.3g%s%s | %s | %.2f | [%.2f](data/%s.png) | %.2f, %.2f | %d, %d | ", two_offset[at], r->g.cell,
        r->g.spacing, rings ? ", axisymmetric" : "", r->pair == OWN_PAIR ? ", own pair" : "", normal_of[r->normal],
        said[0][at], read_summary(folder, "pbcp_percent"), name, both.pbcp, base.pbcp, both.held, base.held);
    say(w, "%.2f | %.2f | %.2f | %.2f | %s | %s | %.0f |\n", said[1][at], row[top].v_z, said[2][at], row[1 - top].v_z,
        row[top].fate, row[1 - top].fate, read_summary(folder, "cpu_seconds"));
    mpm_io_csv_real(t, (mpm_real)two_offset[at]);
    mpm_io_csv_text(t, normal_of[r->normal]);
    mpm_io_csv_real(t, (mpm_real)read_summary(folder, "pbcp_percent"));
    mpm_io_csv_real(t, (mpm_real)both.pbcp);
    mpm_io_csv_real(t, (mpm_real)base.pbcp);
    mpm_io_csv_integer(t, both.held);
    mpm_io_csv_integer(t, base.held);
    mpm_io_csv_real(t, (mpm_real)row[top].v_z);
    mpm_io_csv_real(t, (mpm_real)row[1 - top].v_z);
    mpm_io_csv_text(t, row[top].fate);
    mpm_io_csv_text(t, row[1 - top].fate);
    mpm_io_csv_real(t, (mpm_real)r->g.cell);
    mpm_io_csv_real(t, (mpm_real)r->g.spacing);
    mpm_io_csv_text(t, r->geometry);
    mpm_io_csv_real(t, (mpm_real)q.base.gc);
    mpm_io_csv_real(t, (mpm_real)q.base.gdot);
    snprintf(picture, sizeof picture, "%s.png", name);
    return keep_picture(w, &q, folder, picture);
}

static int two_particles(work *w)
{
    char path[MPM_IO_PATH];
    mpm_io_csv t;
    int k, at, status = 1;
    mpm_io_csv_begin(&t, data_file(w, "two_particles.csv", path, sizeof path),
                     "offset_um,normal_of,pbcp_percent,pbcp_top_bottom_percent,pbcp_bottom_substrate_percent,"
                     "held_nodes_top_bottom,held_nodes_bottom_substrate,top_v_z_m_s,bottom_v_z_m_s,top,bottom,cell_um,"
                     "spacing_um,geometry,gc,gdot",
                     "A-two", &w->fault);
    say(w, "### A-two: one particle on another\n\nTwo of 14 um at 810 m/s, 3D unless said, after 100 ns; velocities of "
           "points up to 60 m/s, from the substrate's mean. Normals between the two: of the top particle, of the "
           "bottom one, or of both averaged; source A's followed numbers given by chance. It ran 0.7/0.175 in 3D. Own "
           "pair: as in A-crit.\n\n| offset, um | cell/spacing, um | normals of | PBCP, %%: source A | here | between "
           "the two, bottom on substrate | held nodes there | top v_z, m/s: source A | here | bottom v_z: source A "
           "| here | top | bottom | CPU s |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < TWO_SETS; k++)
        for (at = 0; at < OFFSETS && status > 0; at++)
            if (two_sets[k].budgets & 1 << w->budget && two_sets[k].offsets & 1 << at)
                status = two_row(w, &t, &two_sets[k], at);
    if (status <= 0) {
        mpm_io_csv_drop(&t);
        return status;
    }
    say(w, "\nSource A: the one at 7.5 um rebounds, the others stay.\n\n");
    return mpm_io_csv_end(&t, &w->fault) >= 0 || failed(w);
}

static int ten_particles(work *w)
{
    static particles_case q;
    static const grid coarse = {1.5, 0.5}, fine = {1.0, 0.35};
    const grid g = w->budget == QUICK ? coarse : fine;
    const double spread = 60;
    particle_row row[10];
    char folder[MPM_IO_PATH];
    int k, status;
    q = particles_default("full", "");
    q.base.cell = g.cell;
    q.base.spacing = g.spacing;
    q.count = 10;
    q.base.substrate_diameter = q.base.time = 0;
    if (!particles_place(&q, spread, particles_height(&q, spread), 1, w->message, sizeof w->message)) return 0;
    snprintf(folder, sizeof folder, "%s/ten_%g_%g_%g", w->s.folder, g.cell, g.spacing, spread);
    if ((status = need_particles(w, &q, folder)) <= 0) return status;
    if (!read_particles(w, folder, row, 10)) return 0;
    say(w, "### A-ten: ten particles\n\nTen of 14 um at 810 m/s at random places and heights, 3D, %.3g/%.3g um, after "
           "%.0f ns. Source A (1.0/0.35): most bond, one is prevented by ejected material.\n\n"
           "| particle | fate | PBCP, %% | v_z, m/s | along the face, m/s | ejected, %% | held nodes: to the "
           "substrate | to other particles |\n|---|---|---|---|---|---|---|---|\n",
        g.cell, g.spacing, read_summary(folder, "time_ns"));
    for (k = 0; k < 10; k++) {
        const int on_substrate = read_pair(folder, k, 10).held;
        say(w, "| %d | %s | %.2f | %.2f | %.2f | %.1f | %d | %d |\n", k, row[k].fate, row[k].pbcp, row[k].v_z,
            row[k].v_along, 100 * row[k].ejected, on_substrate, read_pair(folder, k, -1).held - on_substrate);
    }
    say(w, "\n%.0f of 10 bonded; PBCP of all surfaces %.2f %%. Cost: %.0f CPU s.\n\n"
           "![Ten particles](data/ten_particles.png)\n\n", read_summary(folder, "bonded"),
        read_summary(folder, "pbcp_percent"), read_summary(folder, "cpu_seconds"));
    return keep_picture(w, &q, folder, "ten_particles.png");
}

/* ---- main ---------------------------------------------------------------------------------- */

typedef int (*part_fn)(work *w);

#define PARTS "conv,dt,jet,substrate,crit,scatter,held,unit,length,pairs,size,points,cal,site,two,ten"

/* Whether a list names parts only, or "none". */
static int parts_known(work *w, const char *name, const char *list)
{
    char word[40];
    while (*list) {
        const size_t n = strcspn(list, ",");
        snprintf(word, sizeof word, "%.*s", n < sizeof word ? (int)n : (int)sizeof word - 1, list);
        if (!listed(PARTS ",none", word)) {
            snprintf(w->message, sizeof w->message, "--%s %s: no such part; there are " PARTS, name, word);
            return 0;
        }
        list += n + (list[n] == ',');
    }
    return 1;
}

/* All parts, or those that --only names. As study_need. */
static int parts(work *w)
{
    static const struct {
        const char *name;
        part_fn run;
    } part[] = {{"conv", convergence},  {"dt", time_steps},       {"jet", jets},          {"substrate", substrates},
                {"crit", critical},     {"scatter", scatter},     {"held", held_out},     {"unit", rate_unit},
                {"length", regularisation}, {"pairs", other_pairs}, {"size", steep_fall},
                {"points", points_touch}, {"cal", calibrations},
                {"site", sites},        {"two", two_particles},   {"ten", ten_particles}};
    const int count = (int)(sizeof part / sizeof part[0]), budget = w->budget;
    int k, status;
    say(w,
        "## Source A's results again\n\nMade by `build/reproduction --budget %s%s%s%s%s` (mpm.h %s). Pictures, and the "
        "tables of A-conv, A-crit, the scatter, A-cal and A-two as CSV, are in [data](data).\n\n",
        w->budget_name, *w->desk ? " --desk " : "", w->desk, *w->only ? " --only " : "", w->only, MPM_VERSION);
    for (k = 0; k < count; k++) {
        if (*w->only && !listed(w->only, part[k].name)) continue;
        if (!w->s.quiet) fprintf(stderr, "\rA-%-97s\n", part[k].name);
        w->budget = budget == QUICK && listed(w->desk, part[k].name) ? DESK : budget;
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
               "parts that the page then holds, of " PARTS "; empty: all");
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
    if (!case_knows("quick|desk|full", "budget", w.budget_name, w.message, sizeof w.message) ||
        !parts_known(&w, "only", w.only) || !parts_known(&w, "desk", w.desk))
        return !complain(w.message);
    if (mpm_io_make_directory(w.data, &w.fault) < 0) return !report(&w.fault, w.data);
    status = parts(&w);
    if (status > 0) status = write_page(&w);
    if (status == 0) return !complain(w.message);
    if (status < 0) printf("stopped after %ld new runs; run again to go on\n", w.s.fresh);
    return status < 0 ? 3 : 0;
}
