/* reproduction.h - what the parts of build/reproduction share: the budget, the runs, the page under way, and the
   search of a critical velocity. SPDX-License-Identifier: MIT */
#ifndef REPRODUCTION_H
#define REPRODUCTION_H

#include "critical.h"

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

/* ---- the parts ----------------------------------------------------------------------------- */

/* Each says its section of the page. As study_need: 1; 0 with w->message; -1 when the limit of new runs is
   reached. */
int convergence(work *w);    /* impacts.c */
int substrates(work *w);
int jets(work *w);
int sites(work *w);
int time_steps(work *w);     /* critical.c */
int critical(work *w);
int rate_unit(work *w);      /* rule.c */
int regularisation(work *w);
int other_pairs(work *w);
int held_out(work *w);
int scatter(work *w);        /* scatter.c */
int steep_fall(work *w);     /* size.c */
int points_touch(work *w);
int calibrations(work *w);   /* calibration.c */
int two_particles(work *w);  /* particles.c */
int ten_particles(work *w);

/* ---- the page: page.c ------------------------------------------------------------------------ */

void say(work *w, const char *format, ...);
void say_velocity(work *w, double v, double high); /* of a search up to `high`: "812", "none up to 1000" */
void say_measure(work *w, double v);               /* "9.56"; "-" where nothing was measured */

/* Puts the text between its marks in the page, or at the page's end if it has none; the rest stays. The old
   page goes only when the new one is whole. Returns 1, or 0 with w->message. */
int write_page(work *w);

/* The fault as w->message; returns 0. */
int failed(work *w);

/* ---- the data folder: page.c ----------------------------------------------------------------- */

const char *data_file(const work *w, const char *name, char *path, size_t n);

/* Begins a table there, and ends it: kept if status > 0. Returns status, or 0 where it cannot be written. */
void table_begin(work *w, mpm_io_csv *t, const char *name, const char *columns, const char *note);
int table_end(work *w, mpm_io_csv *t, int status);

/* Plots as one picture there. Returns 1, or 0 with w->message. */
int picture(work *w, const char *name, const mpm_draw_plot_desc *d);

/* ---- cases and values: search.c -------------------------------------------------------------- */

typedef struct grid {
    double cell, spacing;
} grid;

/* The bond's pair: source A's, and the one at which A-cal's edges of both sizes fall together at 0.7/0.175 um (the
   middle of the step, in ratio, between the last Gdot_c that bonds and the first that does not). */
typedef struct bond_pair {
    double gc, gdot; /* J/m2, J/(m2 us) */
} bond_pair;

enum { SOURCE_PAIR, OWN_PAIR };
extern const bond_pair pairs[2];

/* What may count as bonded: see critical_rule. */
extern const char *const rule_names[2];

/* Source A's impact of 14 um on a grid, in axisymmetry. Sizes left to study_complete. */
impact_case case_on(grid g);

/* The budget's grid, positions of the grid, and search: 500 to 1000 m/s, then halved. */
grid budget_grid(const work *w);
int budget_times(const work *w);
critical_range budget_range(const work *w);

/* How the coming runs end (1: once the particle has left for good) and about how many they are. */
void plan(work *w, int early, int64_t runs);

/* study_need, on source A's substrate unless the case has one. */
int need(work *w, impact_case c, double *value);

/* The lowest and the highest of some values. */
typedef struct extremes {
    double low, high;
} extremes;

extern const extremes no_extremes; /* of none yet */
void widen(extremes *e, double v);

/* ---- one search, repeated: search.c ---------------------------------------------------------- */

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

/* As need. */
int critical_repeat(work *w, impact_case c, variation vary, const char *rule_name, critical_range range, int times,
                    critical_outcome *out);

/* "753 | 725 - 938" */
void say_spread(work *w, const critical_spread *s, double high);

#endif
