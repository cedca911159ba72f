/* calibration.h - which pairs (G_c, Gdot_c), or (G_c, W0) of the bond of surfaces, bond two particle sizes at their
   critical velocities: a sweep over kept runs, the boundary of each size and where the two cross (source A, 4.1.2 and
   5.1; docs/prediction.md).
   SPDX-License-Identifier: MIT */
#ifndef CALIBRATION_H
#define CALIBRATION_H

#include "critical.h"

#define CALIBRATION_NODES 4000 /* of one size */

#define CALIBRATION_SCALES "log|linear"

/* The sweep: columns x rows pairs, for two sizes. Task number (size * rows + row) * columns + column. */
typedef struct calibration {
    impact_case base;               /* what both sizes share */
    const char *substrate, *scale, *rule; /* words of STUDY_SUBSTRATES, CALIBRATION_SCALES, CRITICAL_RULES */
    double gc[2], gdot[2];          /* ranges, J/m2, J/m2/us; with method surface of G_c and W0, J/m2 */
    int64_t columns, rows;          /* pairs along G_c, Gdot_c */
    int plain;                      /* 1: every pair; 0: only where the class changes */
    double diameter[2], velocity[2]; /* um, m/s */
    double pbcp[2], restitution[2]; /* bonded: PBCP at least [%], rebound/impact velocity at most; 0: source A's */
    double stays;                   /* rule stays, m/s */
    double ridge;                   /* of the fits: holds those of separable classes back */
} calibration;

/* Source A's tolerances (Table 5.2) for the grid nearest to this one. */
static inline void calibration_tolerances(double cell, double spacing, double pbcp[2], double restitution[2])
{
    static const double table[9][6] = {
        {1.5, 0.5, 8.5, 0.0031, 8.1, 0.002},  {1.5, 0.35, 8.0, 0.003, 9.2, 0.002},   {1.5, 0.3, 8.5, 0.003, 9.2, 0.002},
        {1.0, 0.35, 6.0, 0.003, 8.1, 0.003},  {1.0, 0.25, 6.1, 0.0031, 8.3, 0.002},  {1.0, 0.2, 6.1, 0.003, 8.3, 0.002},
        {0.7, 0.25, 4.7, 0.006, 4.9, 0.007},  {0.7, 0.175, 4.6, 0.003, 5.3, 0.0031},
        {0.7, 0.15, 4.8, 0.003, 5.3, 0.0031}};
    int k, best = 0;
    double least = HUGE_VAL;
    for (k = 0; k < 9; k++) {
        const double far = fabs(log(cell / table[k][0])) + 0.1 * fabs(log(spacing / table[k][1]));
        if (far >= least) continue;
        least = far;
        best = k;
    }
    for (k = 0; k < 2; k++) {
        if (!(pbcp[k] > 0)) pbcp[k] = table[best][2 + 2 * k];
        if (!(restitution[k] > 0)) restitution[k] = table[best][3 + 2 * k];
    }
}

static inline calibration calibration_default(void)
{
    calibration q;
    memset(&q, 0, sizeof q);
    q.base = study_case_default();
    q.substrate = "thesis";
    q.scale = "log";
    q.rule = "thesis";
    q.gc[0] = 500;
    q.gc[1] = 10000;
    q.gdot[0] = 1e5;
    q.gdot[1] = 2e6;
    q.columns = 25;
    q.rows = 15;
    q.diameter[0] = 14;
    q.diameter[1] = 30;
    q.velocity[0] = 810;
    q.velocity[1] = 770;
    q.stays = critical_rule_default().stays;
    q.ridge = 1e-4;
    return q;
}

/* The same for contact and bond on surfaces: what stays is bonded. */
static inline calibration calibration_of_surfaces(void)
{
    calibration q = calibration_default();
    q.base = impact_case_surface();
    q.rule = "stays";
    q.gc[0] = 500;
    q.gc[1] = 5000;
    q.gdot[0] = 10;
    q.gdot[1] = 150;
    q.columns = 13;
    q.rows = 9;
    return q;
}

static inline int calibration_surface(const calibration *q) { return !strcmp(q->base.method, "surface"); }

/* The name of the second parameter. */
static inline const char *calibration_second(const calibration *q) { return calibration_surface(q) ? "W0" : "Gdot_c"; }

static inline const char *calibration_unit(const calibration *q) { return calibration_surface(q) ? "J/m2" : "J/m2/us"; }

static inline int64_t calibration_nodes(const calibration *q) { return q->columns * q->rows; }

/* Node `number` of n between low and high. */
static inline double calibration_at(const calibration *q, const double *range, int64_t number, int64_t n)
{
    const double t = n > 1 ? (double)number / (double)(n - 1) : 0;
    const double v = strcmp(q->scale, "log") ? range[0] + t * (range[1] - range[0])
                                             : range[0] * pow(range[1] / range[0], t);
    char text[32]; /* six digits, so that lists show what was run */
    snprintf(text, sizeof text, "%.6g", v);
    return strtod(text, NULL);
}

static inline double calibration_gc(const calibration *q, int64_t node)
{
    return calibration_at(q, q->gc, node % q->columns, q->columns);
}

static inline double calibration_gdot(const calibration *q, int64_t node)
{
    return calibration_at(q, q->gdot, node / q->columns, q->rows);
}

/* A number as the fit sees it. */
static inline double calibration_x(const calibration *q, double v) { return strcmp(q->scale, "log") ? v : log10(v); }
static inline double calibration_from(const calibration *q, double x)
{
    return strcmp(q->scale, "log") ? x : pow(10, x);
}

static inline impact_case calibration_case(const calibration *q, int size, int64_t node)
{
    impact_case c = q->base;
    c.diameter = q->diameter[size];
    c.velocity = q->velocity[size];
    *(calibration_surface(q) ? &c.adhesion_critical : &c.gc) = calibration_gc(q, node);
    *(calibration_surface(q) ? &c.adhesion : &c.gdot) = calibration_gdot(q, node);
    study_complete(&c, q->substrate);
    return c;
}

static inline double calibration_ratio(const calibration *q, int size, const double *value)
{
    return value[STUDY_V_REST] / q->velocity[size];
}

static inline int calibration_bonds(const calibration *q, int size, const double *value)
{
    critical_rule r = critical_rule_default();
    r.name = q->rule;
    r.stays = q->stays;
    r.pbcp = strcmp(q->rule, "stays") ? q->pbcp[size] : calibration_surface(q) ? CRITICAL_LEFT : 0;
    r.v_rest = q->restitution[size] * q->velocity[size];
    return critical_bonds(&r, q->diameter[size], value);
}

/* What is known of one size: the class of each node (-1: not run) and whether the sweep wants it. */
typedef struct calibration_map {
    signed char bonds[CALIBRATION_NODES], wanted[CALIBRATION_NODES];
} calibration_map;

/* Wants the corners of a part of the grid, and where its nodes are of both classes what lies in between. */
static inline void calibration_refine(const calibration *q, calibration_map *m, int64_t i0, int64_t i1, int64_t j0,
                                      int64_t j1)
{
    const int64_t im = (i0 + i1) / 2, jm = (j0 + j1) / 2;
    int64_t i, j;
    int seen[2] = {0, 0};
    m->wanted[j0 * q->columns + i0] = m->wanted[j0 * q->columns + i1] = 1;
    m->wanted[j1 * q->columns + i0] = m->wanted[j1 * q->columns + i1] = 1;
    for (j = j0; j <= j1; j++)
        for (i = i0; i <= i1; i++)
            if (m->bonds[j * q->columns + i] >= 0) seen[m->bonds[j * q->columns + i]] = 1;
    if (!seen[0] || !seen[1] || (i1 - i0 <= 1 && j1 - j0 <= 1)) return;
    calibration_refine(q, m, i0, i1 - i0 > 1 ? im : i1, j0, j1 - j0 > 1 ? jm : j1);
    if (i1 - i0 > 1) calibration_refine(q, m, im, i1, j0, j1 - j0 > 1 ? jm : j1);
    if (j1 - j0 > 1) calibration_refine(q, m, i0, i1 - i0 > 1 ? im : i1, jm, j1);
    if (i1 - i0 > 1 && j1 - j0 > 1) calibration_refine(q, m, im, i1, jm, j1);
}

/* Reads what is finished and decides what is wanted: everything, or a net of 5 x 3 nodes and from there
   wherever the class changes. Returns how many wanted nodes have not been run. */
static inline int64_t calibration_look(const calibration *q, const study *s, int size, calibration_map *m)
{
    const int64_t all = calibration_nodes(q);
    double value[STUDY_VALUES];
    int64_t k, j, missing = 0;
    for (k = 0; k < all; k++) {
        const impact_case c = calibration_case(q, size, k);
        m->bonds[k] = (signed char)(study_find(s, &c, value) ? calibration_bonds(q, size, value) : -1);
        m->wanted[k] = (signed char)(q->plain != 0);
    }
    for (j = 0; j < 2 && !q->plain; j++)
        for (k = 0; k < 4; k++)
            calibration_refine(q, m, k * (q->columns - 1) / 4, (k + 1) * (q->columns - 1) / 4, j * (q->rows - 1) / 2,
                               (j + 1) * (q->rows - 1) / 2);
    for (k = 0; k < all; k++) missing += m->wanted[k] && m->bonds[k] < 0;
    return missing;
}

/* The boundary of one size. */
typedef struct calibration_side {
    calibration_map map;
    mpm_logistic fit;
    mpm_status status;  /* of the fit */
    const char *why;    /* its status in words */
    int64_t tests, bonded;
} calibration_side;

typedef struct calibration_result {
    calibration_side side[2];
    double point[4][2];  /* crossings: G_c, Gdot_c */
    int points;
    int same;            /* 1: both sizes have the same class everywhere, and one boundary: no crossing is named */
} calibration_result;

/* The boundary between the classes of a size's map. */
static inline void calibration_fit(const calibration *q, calibration_side *side)
{
    static double x1[CALIBRATION_NODES], x2[CALIBRATION_NODES];
    static int outcome[CALIBRATION_NODES];
    int64_t k;
    side->tests = side->bonded = 0;
    for (k = 0; k < calibration_nodes(q); k++) {
        if (side->map.bonds[k] < 0) continue;
        x1[side->tests] = calibration_x(q, calibration_gc(q, k));
        x2[side->tests] = calibration_x(q, calibration_gdot(q, k));
        outcome[side->tests++] = side->map.bonds[k];
        side->bonded += side->map.bonds[k];
    }
    side->status = mpm_logistic_fit(&side->fit, x1, x2, outcome, side->tests, q->ridge, 200, NULL);
    side->why = mpm_status_text(side->status);
    if (side->bonded == 0 || side->bonded == side->tests) side->why = "one class only";
    if (side->tests < 6) side->why = "fewer than six runs";
}

/* Fits both sizes' maps and crosses their boundaries. */
static inline void calibration_cross(const calibration *q, calibration_result *r)
{
    double low[2], high[2];
    int size, k, fitted;
    for (size = 0; size < 2; size++) calibration_fit(q, &r->side[size]);
    low[0] = calibration_x(q, q->gc[0]);
    low[1] = calibration_x(q, q->gdot[0]);
    high[0] = calibration_x(q, q->gc[1]);
    high[1] = calibration_x(q, q->gdot[1]);
    fitted = r->side[0].status >= 0 && r->side[1].status >= 0;
    r->same = fitted && !memcmp(r->side[0].map.bonds, r->side[1].map.bonds, (size_t)calibration_nodes(q));
    r->points = fitted && !r->same ? mpm_logistic_cross(&r->side[0].fit, &r->side[1].fit, low, high, r->point) : 0;
    for (k = 0; k < r->points; k++)
        for (size = 0; size < 2; size++) r->point[k][size] = calibration_from(q, r->point[k][size]);
}

/* The same of what has been run so far. */
static inline void calibration_collect(const calibration *q, const study *s, calibration_result *r)
{
    int size;
    for (size = 0; size < 2; size++) calibration_look(q, s, size, &r->side[size].map);
    calibration_cross(q, r);
}

/* Makes the wanted runs of a size that are missing and that no other process makes. As study_need. */
static inline int calibration_pass(const calibration *q, study *s, int size, const calibration_map *map, int *made,
                                   char *message, size_t n)
{
    double value[STUDY_VALUES];
    int64_t k;
    int status;
    *made = 0;
    for (k = 0; k < calibration_nodes(q); k++) {
        const impact_case c = calibration_case(q, size, k);
        if (!map->wanted[k] || map->bonds[k] >= 0) continue;
        if ((status = study_share(s, &c, value, message, n)) <= 0) return status;
        *made += status == 1;
    }
    return 1;
}

/* Runs everything the sweep wants, one task after the other; several processes share the work. As study_need. */
static inline int calibration_run(const calibration *q, study *s, char *message, size_t n)
{
    static calibration_map map;
    int size, status, made;
    int64_t missing;
    for (size = 0; size < 2; size++)
        while ((missing = calibration_look(q, s, size, &map)) > 0) {
            s->planned = s->done + missing;
            if ((status = calibration_pass(q, s, size, &map, &made, message, n)) <= 0) return status;
            if (stop_asked()) return -1;
            if (!made) claim_wait();
        }
    return 1;
}

/* ---- the picture ------------------------------------------------------------------------------- */

enum { CALIBRATION_STEPS = 200, CALIBRATION_LINE = 2 * CALIBRATION_STEPS + 1 };

/* The boundary of a size: the lower roots, a break, the upper roots. */
typedef struct calibration_line {
    mpm_real x[CALIBRATION_LINE], y[CALIBRATION_LINE];
    char name[40];
} calibration_line;

static inline void calibration_trace(const calibration *q, const calibration_side *side, calibration_line *l)
{
    const double left = calibration_x(q, q->gc[0]), right = calibration_x(q, q->gc[1]);
    const double low = calibration_x(q, q->gdot[0]), high = calibration_x(q, q->gdot[1]);
    double root[2];
    int which, t;
    l->x[CALIBRATION_STEPS] = l->y[CALIBRATION_STEPS] = (mpm_real)nan("");
    for (t = 0; t < CALIBRATION_STEPS; t++) {
        const double x = left + t * (right - left) / (CALIBRATION_STEPS - 1);
        const int roots = side->status >= 0 ? mpm_logistic_roots(&side->fit, x, low, high, root) : 0;
        for (which = 0; which < 2; which++) {
            const int at = which * (CALIBRATION_STEPS + 1) + t;
            l->x[at] = (mpm_real)calibration_from(q, x);
            l->y[at] = (mpm_real)(which < roots ? calibration_from(q, root[which]) : nan(""));
        }
    }
}

/* The pairs that were run, of one class (1: bonded). */
typedef struct calibration_dots {
    mpm_real x[CALIBRATION_NODES], y[CALIBRATION_NODES];
} calibration_dots;

static inline mpm_draw_curve calibration_class(const calibration *q, const calibration_map *m, int bonded,
                                               calibration_dots *dots)
{
    size_t count = 0;
    int64_t k;
    for (k = 0; k < calibration_nodes(q); k++) {
        if (m->bonds[k] != bonded) continue;
        dots->x[count] = (mpm_real)calibration_gc(q, k);
        dots->y[count++] = (mpm_real)calibration_gdot(q, k);
    }
    return plot_curve(bonded ? "bonded" : "not bonded", dots->x, dots->y, count, MPM_DRAW_DOTS, bonded);
}

/* The classes of both sizes (of those that have any) in the plane of the parameters, with both boundaries and their
   crossings. */
static inline int calibration_draw(const calibration *q, const calibration_result *r, const char *path,
                                   const char *note, mpm_fault *fault)
{
    static calibration_dots dots[2][2];
    static calibration_line line[2];
    mpm_real px[4], py[4];
    mpm_draw_curve curve[2][5];
    mpm_draw_plot_desc d[2];
    char title[2][80], second[40];
    int size, k, plots = 0;
    snprintf(second, sizeof second, "%s, %s", calibration_second(q), calibration_unit(q));
    for (k = 0; k < 2; k++) {
        calibration_trace(q, &r->side[k], &line[k]);
        snprintf(line[k].name, sizeof line[k].name, "boundary, %g um", q->diameter[k]);
    }
    for (k = 0; k < r->points; k++) {
        px[k] = (mpm_real)r->point[k][0];
        py[k] = (mpm_real)r->point[k][1];
    }
    for (size = 0; size < 2; size++) {
        mpm_draw_curve *c = curve[size];
        if (r->side[size].tests == 0) continue;
        for (k = 0; k < 2; k++) c[k] = calibration_class(q, &r->side[size].map, k, &dots[size][k]);
        for (k = 0; k < 2; k++)
            c[2 + k] = plot_curve(r->side[k].status >= 0 ? line[k].name : NULL, line[k].x, line[k].y, CALIBRATION_LINE,
                                  k == size ? MPM_DRAW_CURVE : MPM_DRAW_DASHED, 2 + k);
        c[4] = plot_curve(r->points > 0 ? "crossing" : NULL, px, py, (size_t)r->points, MPM_DRAW_DOTS, 5);
        snprintf(title[size], sizeof title[size], "%g um at %g m/s", q->diameter[size], q->velocity[size]);
        d[plots] = plot_of(title[size], "G_c, J/m2", second, c, 5);
        d[plots].log_x = d[plots].log_y = !strcmp(q->scale, "log");
        plots++;
    }
    return plots_png(path, d, plots, plots, 440, note, fault) >= 0;
}

#endif
