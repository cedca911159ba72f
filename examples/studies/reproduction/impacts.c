/* impacts.c - single impacts: the grid without bonding, the size of the substrate, the jet, where it bonds.
   SPDX-License-Identifier: MIT */
#include "reproduction.h"

/* ---- A-conv -------------------------------------------------------------------------------- */

enum { STRAIN, ENERGY, MEASURES };

/* Over the grids, by return mapping. */
typedef struct convergence_sums {
    extremes of[2][MEASURES];
    double cpu;
} convergence_sums;

/* One grid by both return mappings: a row of the table, and two of the file. As need. */
static int convergence_row(work *w, mpm_io_csv *t, grid g, convergence_sums *sums)
{
    static const char *const mapping[2] = {"consistent", "staged"};
    double value[2][STUDY_VALUES];
    int k, status;
    for (k = 0; k < 2; k++) {
        impact_case c = case_on(g);
        c.bond = "none";
        c.dt_factor = 0.05;
        c.plasticity = mapping[k];
        if ((status = need(w, c, value[k])) <= 0) return status;
        widen(&sums->of[k][STRAIN], value[k][STUDY_EPS]);
        widen(&sums->of[k][ENERGY], value[k][STUDY_WORK]);
        sums->cpu += value[k][STUDY_CPU];
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

/* From the lowest to the highest, in percent. */
static double rise(extremes e) { return 100 * (e.high / e.low - 1); }

int convergence(work *w)
{
    static const grid grids[9] = {{1.5, 0.5}, {1.5, 0.4}, {1.5, 0.35}, {1.0, 0.4}, {1.0, 0.35}, {1.0, 0.25},
                                  {0.5, 0.2}, {0.5, 0.175}, {0.5, 0.15}};
    const int count = w->budget == QUICK ? 6 : 9;
    convergence_sums sums;
    mpm_io_csv t;
    int k, status = 1;
    for (k = 0; k < 2 * MEASURES; k++) sums.of[k / MEASURES][k % MEASURES] = no_extremes;
    sums.cpu = 0;
    plan(w, 0, 2 * count);
    table_begin(w, &t, "convergence.csv", "cell_um,spacing_um,return_mapping,eps_mean,plastic_energy_density_MPa,"
                                          "points,steps", "A-conv");
    say(w, "### A-conv: grids without bonding\n\n14 um at 810 m/s, frictionless, no bond, axisymmetric, time step "
           "factor 0.05, after 80 ns; with the consistent return mapping and with that of source A's appendix. Source "
           "A (figures): the mean plastic strain depends strongly on the cell, hardly on the spacing; the mean plastic "
           "energy density much less.\n\n| cell/spacing, um | mean plastic strain | plastic energy density, MPa | "
           "staged: strain | energy density, MPa | points |\n|---|---|---|---|---|---|\n");
    for (k = 0; k < count && status > 0; k++) status = convergence_row(w, &t, grids[k], &sums);
    say(w, "\nFrom the lowest to the highest of these grids: strain %+.1f %%, energy density %+.1f %%; staged %+.1f %% "
           "and %+.1f %%. Cost: %.0f CPU s.\n\n", rise(sums.of[0][STRAIN]), rise(sums.of[0][ENERGY]),
        rise(sums.of[1][STRAIN]), rise(sums.of[1][ENERGY]), sums.cpu);
    return table_end(w, &t, status);
}

/* ---- the substrate ------------------------------------------------------------------------- */

/* What the size of the substrate does to a rebound without bond, where no threshold blurs it. */
int substrates(work *w)
{
    static const double size[4][2] = {{30, 10}, {50, 20}, {70, 35}, {100, 50}};
    const grid g = budget_grid(w);
    double value[STUDY_VALUES];
    int k, status;
    plan(w, 0, 4);
    say(w, "### How large a substrate must be\n\n14 um at 810 m/s without bond, %g/%g um, axisymmetric, dampers at "
           "bottom and side, after 80 ns. Source A: 30 x 10 um; \"large\" below: 70 x 35.\n\n"
           "| substrate, um | rebound velocity, m/s | mean plastic strain | height lost, share |\n|---|---|---|---|\n",
        g.cell, g.spacing);
    for (k = 0; k < 4; k++) {
        impact_case c = case_on(g);
        c.bond = "none";
        c.substrate_diameter = size[k][0];
        c.substrate_height = size[k][1];
        if ((status = need(w, c, value)) <= 0) return status;
        say(w, "| %g x %g | %.1f | %.3f | %.3f |\n", size[k][0], size[k][1], value[STUDY_V_MEAN], value[STUDY_EPS],
            value[STUDY_FLATTENING]);
    }
    say(w, "\n");
    return 1;
}

/* ---- A-jet --------------------------------------------------------------------------------- */

/* An impact, and what source A says of it. */
typedef struct jet {
    double diameter, velocity;
    const char *said;
} jet;

/* One impact on one grid: a row of the table. As need. */
static int jet_row(work *w, const jet *j, grid g)
{
    double value[STUDY_VALUES];
    impact_case c = case_on(g);
    int status;
    c.diameter = j->diameter;
    c.velocity = j->velocity;
    if ((status = need(w, c, value)) <= 0) return status;
    say(w, "| %g um at %g m/s | %s | %.3g/%.3g | %.2f | %.2f | %.1f | %.2f | %.2f | %.3f | %.0f |\n", j->diameter,
        j->velocity, j->said, g.cell, g.spacing, value[STUDY_RIM], 100 * value[STUDY_SHEARED],
        100 * value[STUDY_EJECTED], value[STUDY_V_LATE], value[STUDY_PBCP], value[STUDY_FLATTENING],
        value[STUDY_CPU]);
    return 1;
}

int jets(work *w)
{
    static const grid grids[3] = {{1.5, 0.5}, {1.0, 0.25}, {0.7, 0.175}};
    static const jet both[2] = {{45, 550, "no jet, rebounds"}, {38, 780, "jet from the particle's rim, bonded"}};
    const int count = w->budget == QUICK ? 1 : 3;
    int k, status;
    plan(w, 0, 2 * count);
    say(w, "### A-jet: below and above the critical velocity\n\n| impact | source A | cell/spacing, um | rim of the "
           "substrate, um | both bodies strained beyond 3, %% of the particle | faster than 60 m/s, %% | mean velocity "
           "at the end, m/s | PBCP, %% | height lost, share | CPU s |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < 2 * count; k++)
        if ((status = jet_row(w, &both[k / count], grids[k % count])) <= 0) return status;
    say(w, "\nAt 0.7/0.175 um, by `make impacts`: [38 um](data/jet_38.png), [45 um](data/jet_45.png).\n\n");
    return 1;
}

/* ---- A-site -------------------------------------------------------------------------------- */

/* By both rules at one position of the grid. */
typedef struct site {
    double value[2][STUDY_VALUES];
    double strain; /* the strain rule's critical one */
} site;

/* The critical strain is halved in on the PBCP that the energy rule gives. As need. */
static int site_run(work *w, impact_case c, site *s)
{
    double tried[STUDY_VALUES], low = 0.5, high = 8, off, least = HUGE_VAL;
    int k, status;
    c.bond = "energy";
    if ((status = need(w, c, s->value[0])) <= 0) return status;
    c.bond = "strain";
    for (k = 0; k < 9; k++) {
        c.eps_c = (low + high) / 2;
        if ((status = need(w, c, tried)) <= 0) return status;
        if (tried[STUDY_PBCP] > s->value[0][STUDY_PBCP]) low = c.eps_c;
        else high = c.eps_c;
        off = fabs(tried[STUDY_PBCP] - s->value[0][STUDY_PBCP]);
        if (off >= least) continue;
        least = off;
        memcpy(s->value[1], tried, sizeof tried); /* the nearest so far */
        s->strain = c.eps_c;
    }
    return 1;
}

/* Distance of the bonded from the axis, over that of the contacted. */
static double site_distance(const double *value) { return case_share(value[STUDY_R_BONDED], value[STUDY_R_CONTACT]); }

static void say_site(work *w, double offset, const site *s)
{
    const double *energy = s->value[0], *strain = s->value[1];
    say(w, "| %.3f | %.3g | %.2f | %.2f | %.3f | %.3f | %.1f | %.1f |\n", offset, s->strain, energy[STUDY_PBCP],
        strain[STUDY_PBCP], site_distance(energy), site_distance(strain), 100 * energy[STUDY_INNER],
        100 * strain[STUDY_INNER]);
}

int sites(work *w)
{
    static const grid coarse = {1.5, 0.5}, fine = {0.7, 0.175};
    const int times = budget_times(w);
    double inner[2] = {0, 0};
    impact_case c = case_on(w->budget == QUICK ? coarse : fine);
    static site s;
    int k, r, nearer = 0, status;
    c.time = 30; /* as its Fig. 5.17 */
    plan(w, 0, 10 * times);
    say(w, "### A-site: where it bonds\n\n14 um at 810 m/s after 30 ns, %.3g/%.3g um, axisymmetric. Source A: at equal "
           "PBCP the energy rule bonds nearer the south pole, the strain rule at the rim. At each position of the grid "
           "the critical strain was halved in on the PBCP of the energy rule. Distance: median of the bonded points "
           "from the axis over that of the contacted ones; inner half: share of the bonded ones within half the "
           "contact radius (sqrt 2 of that median), a quarter if evenly spread.\n\n"
           "| grid plane over the interface, um | critical strain | PBCP, %%: energy | strain | distance: energy "
           "| strain | inner half, %%: energy | strain |\n|---|---|---|---|---|---|---|---|\n", c.cell, c.spacing);
    for (k = 0; k < times; k++) {
        c.offset = c.cell * k / times;
        if ((status = site_run(w, c, &s)) <= 0) return status;
        for (r = 0; r < 2; r++) inner[r] += s.value[r][STUDY_INNER] / times;
        nearer += site_distance(s.value[0]) < site_distance(s.value[1]);
        say_site(w, c.offset, &s);
    }
    say(w, "\nThe energy rule bonds nearer the axis at %d of %d positions; inner half on average %.1f %% (energy) and "
           "%.1f %% (strain).\n\n", nearer, times, 100 * inner[0], 100 * inner[1]);
    return 1;
}
