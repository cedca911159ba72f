/* calibration.c - A-cal: which pairs G_c, Gdot_c bond both sizes. SPDX-License-Identifier: MIT */
#include "calibration.h"
#include "reproduction.h"

#define INNER 3 /* columns of the sweep that the table shows: all but the first and the last */

/* What the grids gave by one rule. */
typedef struct calibration_sum {
    extremes edge[INNER][2]; /* of column and size */
    int crossed;             /* grids on which the boundaries cross */
} calibration_sum;

static calibration calibration_of(grid g, const char *rule_name)
{
    calibration q = calibration_default();
    q.base.cell = g.cell;
    q.base.spacing = g.spacing;
    q.rule = rule_name;
    q.columns = INNER + 2;
    q.rows = 17;
    calibration_tolerances(g.cell, g.spacing, q.pbcp, q.restitution);
    return q;
}

/* The highest Gdot_c of a column of the sweep that bonds a size; 0: none. */
static double calibration_edge(const calibration *q, const calibration_side *side, int64_t column)
{
    int64_t row;
    for (row = q->rows - 1; row >= 0; row--)
        if (side->map.bonds[row * q->columns + column] == 1) return calibration_gdot(q, row * q->columns + column);
    return 0;
}

/* A row of the file for each column. */
static void calibration_record(mpm_io_csv *t, const calibration *q, const calibration_result *r)
{
    int64_t column;
    int k;
    for (column = 0; column < q->columns; column++) {
        mpm_io_csv_real(t, (mpm_real)q->base.cell);
        mpm_io_csv_real(t, (mpm_real)q->base.spacing);
        mpm_io_csv_text(t, q->rule);
        mpm_io_csv_real(t, (mpm_real)calibration_gc(q, column));
        for (k = 0; k < 2; k++) mpm_io_csv_real(t, (mpm_real)calibration_edge(q, &r->side[k], column));
    }
}

static void say_edges(work *w, const calibration *q, const calibration_result *r, calibration_sum *sum)
{
    int column, k;
    for (column = 0; column < INNER; column++) {
        for (k = 0; k < 2; k++) {
            const double edge = calibration_edge(q, &r->side[k], column + 1);
            widen(&sum->edge[column][k], edge);
            say(w, "%s%.3g", k ? ", " : " ", edge);
        }
        say(w, " |");
    }
}

/* G_c of the crossings by fits with other ridges: "2636; 3390; -". */
static void say_ridges(work *w, const calibration *q, const calibration_result *known)
{
    static const double ridge[3] = {1e-3, 1e-5, 1e-6};
    static calibration_result r;
    int i, k;
    r = *known;
    for (i = 0; i < 3; i++) {
        calibration other = *q;
        other.ridge = ridge[i];
        calibration_cross(&other, &r);
        say(w, "%s", i ? "; " : " | ");
        for (k = 0; k < r.points; k++) say(w, "%s%.0f", k ? ", " : "", r.point[k][0]);
        if (r.points == 0) say(w, "-");
    }
}

/* Pairs run at both sizes that bond only one: "3, 0". */
static void say_only(work *w, const calibration *q, const calibration_result *r)
{
    int64_t node, only[2] = {0, 0};
    int k;
    for (node = 0; node < calibration_nodes(q); node++)
        for (k = 0; k < 2; k++)
            only[k] += r->side[k].map.bonds[node] == 1 && r->side[1 - k].map.bonds[node] == 0;
    say(w, "%lld, %lld", (long long)only[0], (long long)only[1]);
}

/* A row of the table. */
static void say_calibration(work *w, const calibration *q, const calibration_result *r, const char *plot,
                            calibration_sum *sum)
{
    int k;
    say(w, "| %.3g/%.3g | %s | %lld | %lld, %lld |", q->base.cell, q->base.spacing, q->rule,
        (long long)(r->side[0].tests + r->side[1].tests),
        (long long)(r->side[0].status >= 0 ? r->side[0].fit.wrong : 0),
        (long long)(r->side[1].status >= 0 ? r->side[1].fit.wrong : 0));
    say_edges(w, q, r, sum);
    say(w, " [%s](data/%s)", r->points ? "crossing" : "none", plot);
    for (k = 0; k < r->points; k++) say(w, "%s%.0f, %.3g", k ? "; " : ": ", r->point[k][0], r->point[k][1]);
    say_ridges(w, q, r);
    say(w, " | ");
    say_only(w, q, r);
    say(w, " |\n");
}

/* One grid by one rule: a row of the table, some of the file, and a picture. As need. */
static int calibration_row(work *w, mpm_io_csv *t, grid g, const char *rule_name, calibration_sum *sum)
{
    static calibration_result result;
    const calibration q = calibration_of(g, rule_name);
    char path[PATH_BYTES], name[60];
    const int status = calibration_run(&q, &w->s, w->message, sizeof w->message);
    if (status <= 0) return status;
    calibration_collect(&q, &w->s, &result);
    snprintf(name, sizeof name, "calibration_%g_%g_%s.png", g.cell, g.spacing, rule_name);
    if (!calibration_draw(&q, &result, data_file(w, name, path, sizeof path), "A-cal", &w->fault)) return failed(w);
    calibration_record(t, &q, &result);
    say_calibration(w, &q, &result, name, sum);
    sum->crossed += result.points > 0;
    return 1;
}

/* All grids by one rule in a sentence. */
static void say_sum(work *w, const char *rule_name, const calibration_sum *sum, int grids)
{
    int k, column;
    say(w, "Rule \"%s\": the boundaries of the two sizes cross on %d of %d grids; over the grids the edge of 14 um "
           "lies at", rule_name, sum->crossed, grids);
    for (k = 0; k < 2; k++) {
        say(w, k ? ", that of 30 um at" : "");
        for (column = 0; column < INNER; column++)
            say(w, "%s %.3g - %.3g", column ? "," : "", sum->edge[column][k].low, sum->edge[column][k].high);
    }
    say(w, ".\n");
}

int calibrations(work *w)
{
    static const grid grids[9] = {{1.5, 0.5},  {1.5, 0.35}, {1.5, 0.3},   {1.0, 0.35}, {1.0, 0.25},
                                  {0.7, 0.25}, {1.0, 0.2},  {0.7, 0.175}, {0.7, 0.15}};
    const int count = w->budget == QUICK ? 1 : 9;
    calibration_sum sum[2];
    mpm_io_csv t;
    int k, status = 1;
    memset(sum, 0, sizeof sum);
    for (k = 0; k < 4 * INNER; k++) sum[k / 2 / INNER].edge[k / 2 % INNER][k % 2] = no_extremes;
    plan(w, 1, 0); /* each sweep counts its own */
    table_begin(w, &t, "calibration.csv", "cell_um,spacing_um,rule,gc,highest_gdot_14um,highest_gdot_30um",
                "A-cal; 0: none bonds");
    say(w, "### A-cal: calibration\n\n14 um at 810 m/s and 30 um at 770 m/s, axisymmetric, the interface on a grid "
           "plane, time step factor 0.2, runs where the class changes; Gdot_c in steps of %.0f %%. Source A: G_c "
           "1503.74 J/m2 and 2.271 (read as e5 J/(m2 us)) at 0.7/0.175, nearly the same on all grids. Rule \"thesis\": "
           "PBCP and restitution tolerances of its Table 5.2 for the grid. The fits have a ridge of %g: separable "
           "classes leave the boundary open without one.\n\n"
           "| cell/spacing, um | rule | runs | on the wrong side, 14, 30 um | highest Gdot_c that bonds 14, 30 um at "
           "G_c 1057 | 2236 | 4729 | crossings: G_c, Gdot_c | G_c with ridge 1e-3; 1e-5; 1e-6 | pairs run at both: "
           "only 14 um bonds, only 30 um |\n|---|---|---|---|---|---|---|---|---|---|\n",
        100 * (pow(20, 1.0 / 16) - 1), calibration_default().ridge);
    for (k = 0; k < 2 * count && status > 0; k++)
        status = calibration_row(w, &t, grids[k / 2], rule_names[k % 2], &sum[k % 2]);
    say(w, "\n");
    for (k = 0; k < 2; k++) say_sum(w, rule_names[k], &sum[k], count);
    say(w, "\n");
    return table_end(w, &t, status);
}
