/* 01_bar - an elastic bar that vibrates, and one thrown at a rigid wall. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "elastic.h"

/* The bar of the closed forms: stress E (rho0/rho - 1) along x is linear in the displacement gradient,
   at any amplitude, so that the wave equation holds exactly. */
static mpm_status bar_stress(const void *material, const mpm_block *b)
{
    const mpm_material *m = (const mpm_material *)material;
    int i;
    for (i = 0; i < b->count; i++) {
        const mpm_real s = m->young * (m->density / b->density[i] - 1);
        b->energy[i] += (b->stress[0][i] + s) / 2 * b->strain[0][i] / b->density[i];
        b->stress[0][i] = s;
    }
    return MPM_OK;
}

/* A bar of the given length and cells along x behind x = gap, one cell thick, two points per cell and
   direction, between sliding planes. */
static void bar_begin(mpm_world *w, mpm_material *m, double length, double gap, int cells, int spare,
                      mpm_basis basis, mpm_side end, mpm_stress_fn stress)
{
    const double cell = length / cells;
    mpm_desc d = scene_grid(cell, cells + spare, 1, 1, 0, 0, 0);
    mpm_shape box = mpm_box((mpm_real)gap, 0, 0, (mpm_real)(gap + length), 1, (mpm_real)cell);
    mpm_body_desc b = scene_body(m, box, cell / 2, 0);
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = basis;
    d.scheme = MPM_SCHEME_THESIS;
    d.side[0] = end;
    d.side[4] = d.side[5] = MPM_SIDE_SYMMETRY;
    b.stress = stress;
    mpm_init(w, &d, NULL, 0);
    mpm_body_add(w, &b);
}

/* ---- vibration ------------------------------------------------------------------------------- */

static const double length = 25, young = 100;
static const double omega = 0.62831853071795865; /* pi c / (2 L) with c = 10 */

typedef struct vibration {
    double omega;   /* from the first and the last zero of the mean velocity */
    double error;   /* root mean square of mean velocity minus the exact one, over its amplitude */
    double energy;  /* change of kinetic + internal energy over the first */
} vibration;

/* Five periods. The scheme is a leapfrog: the velocities it holds at t belong to t - dt/2. */
static vibration vibrate(mpm_basis basis, mpm_side end, mpm_stress_fn stress, int cells, double v0)
{
    const double dt = 0.02 * length / cells, amplitude = v0 * 2 / pi;
    mpm_material m = elastic(young, 0, 1);
    double v = 0, old, first = 0, last = 0, e0;
    vibration r = {0, 0, 0};
    mpm_totals t;
    mpm_world w;
    int32_t i;
    int zeros = 0;
    bar_begin(&w, &m, length, 0, cells, 2, basis, end, stress);
    for (i = 0; i < w.points.count; i++)
        w.points.v[0][i] = (mpm_real)(v0 * sin(pi * (double)w.points.x[0][i] / (2 * length)));
    e0 = mpm_body_totals(&w, -1).kinetic;
    while ((double)w.time < 10 * pi / omega && mpm_step(&w, (mpm_real)dt) >= 0) {
        const double time = (double)w.time - dt / 2;
        old = v;
        v = mean_velocity(&w, -1, 0);
        r.error += (v - amplitude * cos(omega * time)) * (v - amplitude * cos(omega * time));
        if (!(old * v < 0)) continue;
        last = time - dt * v / (v - old);
        if (zeros++ == 0) first = last;
    }
    r.omega = pi * (zeros - 1) / (last - first);
    r.error = sqrt(r.error / (double)w.steps) / amplitude;
    t = mpm_body_totals(&w, -1);
    r.energy = (t.kinetic + t.internal) / e0 - 1;
    mpm_free(&w);
    return r;
}

enum { GRIDS = 5 }; /* of 10, 20, 40, 80, 160 cells */

typedef struct series {
    const char *name;
    mpm_basis basis;
    mpm_side end;
    double v0;
    int second_order; /* claimed */
    vibration got[GRIDS];
    double order[2]; /* of the error of the mean velocity: from the first to the last grid; least of a halving */
} series;

static void series_run(series *s)
{
    int g;
    for (g = 0; g < GRIDS; g++) {
        double order;
        s->got[g] = vibrate(s->basis, s->end, bar_stress, 10 << g, s->v0);
        if (g == 0) continue;
        order = order_of(s->got[g - 1].error, s->got[g].error);
        s->order[0] += order / (GRIDS - 1);
        if (g == 1 || order < s->order[1]) s->order[1] = order;
    }
}

static void series_rows(const series *s)
{
    char line[200];
    snprintf(line, sizeof line, "%s: frequency, 80 cells", s->name);
    verify_percent(line, "closed form", omega, s->got[3].omega, 0.1);
    verify_near("... change of energy in five periods, 160 cells", "conserved", 0, s->got[4].energy, 1e-3);
    if (s->second_order) {
        verify_near("... order of the mean velocity's error, 10 to 160 cells", "second order", 2, s->order[0], 0.3);
        verify_near("... least order in any halving of the cell", "second order", 2, s->order[1], 0.3);
    }
}

static void vibrations(void)
{
    series s[] = {
        {"linear, v0 = 0.001", MPM_LINEAR, MPM_SIDE_FIXED, 1e-3, 1, {{0, 0, 0}}, {0, 0}},
        {"GIMP, v0 = 0.001", MPM_GIMP, MPM_SIDE_FIXED, 1e-3, 1, {{0, 0, 0}}, {0, 0}},
        {"GIMP, v0 = 0.1, held by a symmetry plane", MPM_GIMP, MPM_SIDE_SYMMETRY, 0.1, 1, {{0, 0, 0}}, {0, 0}},
        {"GIMP, v0 = 0.1", MPM_GIMP, MPM_SIDE_FIXED, 0.1, 1, {{0, 0, 0}}, {0, 0}},
        {"linear, v0 = 0.1", MPM_LINEAR, MPM_SIDE_FIXED, 0.1, 0, {{0, 0, 0}}, {0, 0}},
        {"quadratic, v0 = 0.001", MPM_QUADRATIC, MPM_SIDE_FIXED, 1e-3, 1, {{0, 0, 0}}, {0, 0}},
        {"quadratic, v0 = 0.1", MPM_QUADRATIC, MPM_SIDE_FIXED, 0.1, 1, {{0, 0, 0}}, {0, 0}},
        {"cubic, v0 = 0.001", MPM_CUBIC, MPM_SIDE_FIXED, 1e-3, 1, {{0, 0, 0}}, {0, 0}},
        {"cubic, v0 = 0.1", MPM_CUBIC, MPM_SIDE_FIXED, 0.1, 1, {{0, 0, 0}}, {0, 0}},
    };
    enum { ALL = sizeof s / sizeof s[0] };
    char table[2000];
    size_t used;
    vibration r;
    int i, g;
    for (i = 0; i < ALL; i++) {
        series_run(&s[i]);
        series_rows(&s[i]);
    }
    r = vibrate(MPM_GIMP, MPM_SIDE_FIXED, mpm_material_stress, 80, 0.1);
    verify_percent("GIMP, v0 = 0.1, solid of mpm_ptw.h: frequency, 80 cells", "closed form", omega, r.omega, 0.1);
    verify_measured("... rms error of the mean velocity over its amplitude", "closed form", r.error);
    used = (size_t)snprintf(table, sizeof table, "Root mean square error of the mean velocity over its amplitude:\n\n"
                            "| cells | 10 | 20 | 40 | 80 | 160 |\n|---|---|---|---|---|---|");
    for (i = 0; i < ALL; i++) {
        used += (size_t)snprintf(table + used, sizeof table - used, "\n| %s |", s[i].name);
        for (g = 0; g < GRIDS; g++)
            used += (size_t)snprintf(table + used, sizeof table - used, " %.2e |", s[i].got[g].error);
    }
    verify_remark(table);
}

/* ---- impact on a wall ------------------------------------------------------------------------ */

static const double rod = 10, gap = 0.01, speed = 202.2, wave = 6410.6; /* sqrt(3e7 / 0.73) */

typedef struct bounce {
    double start, release, velocity;
} bounce;

/* Contact begins and ends where the straight line through 2 % and 98 % of the wall's impulse, of which
   the exact one is 2 m v, meets none and all of it. */
static bounce throw_rod(mpm_basis basis, int cells)
{
    const double cell = rod / cells, dt = 0.3 * cell / wave, full = 2 * 0.73 * rod * cell * speed;
    mpm_material m = elastic(3e7, 0, 0.73);
    double low = 0, high = 0;
    bounce r;
    mpm_world w;
    int32_t i;
    bar_begin(&w, &m, rod, gap, cells, 4 + cells / 20, basis, MPM_SIDE_WALL, bar_stress);
    for (i = 0; i < w.points.count; i++) w.points.v[0][i] = (mpm_real)-speed;
    while ((double)w.time < 3.6e-3 && mpm_step(&w, (mpm_real)dt) >= 0) {
        if (w.ledger.impulse[0] < 0.02 * full) low = (double)w.time;
        if (w.ledger.impulse[0] < 0.98 * full) high = (double)w.time;
    }
    r.start = low - (high - low) / 48;
    r.release = high + (high - low) / 48;
    r.velocity = mean_velocity(&w, -1, 0) / speed;
    mpm_free(&w);
    return r;
}

static void rod_rows(mpm_basis basis, int cells)
{
    const double contact = gap / speed, cell = rod / cells;
    static const char *const name[MPM_BASES] = {"linear", "GIMP", "quadratic", "cubic"};
    const bounce r = throw_rod(basis, cells);
    char line[200];
    snprintf(line, sizeof line, "rod on a wall, %s, %d cells: contact begins", name[basis], cells);
    verify_near(line, "gap / v, a cell early at most", contact, r.start, cell / speed);
    verify_percent("... contact lasts", "2 L / c", 2 * rod / wave, r.release - r.start, 1);
    verify_percent("... release", "gap / v + 2 L / c", contact + 2 * rod / wave, r.release, 1);
    verify_percent("... velocity afterwards over that before", "elastic", 1, r.velocity, 1);
}

int main(void)
{
    verify_begin("An elastic bar",
                 "A bar (L 25, E 100, rho 1: c = 10) held at one end, free at the other, starts with v0 sin(pi x / 2\n"
                 "L) and swings with omega = pi c / 2 L; its mean velocity is (2/pi) v0 cos(omega t). Stress E\n"
                 "(rho0/rho - 1) makes the wave equation exact at any amplitude. Two points per cell and direction,\n"
                 "dt = 0.2 cell / c, five periods; the held end is a fixed side unless said otherwise. The scheme is\n"
                 "a leapfrog: its velocities at t are compared with the exact ones at t - dt/2. With v0 = 0.001\n"
                 "points stay in their cells, with v0 = 0.1 the free end moves 0.16: a cell at 160 cells. A rod (L\n"
                 "10, E 3e7, rho 0.73) then flies over a gap of 0.01 at 202.2 into a rigid wall: contact from\n"
                 "4.95e-5 for 2 L / c, velocity reversed.");
    vibrations();
    verify_remark("GIMP and splines are of second order with points crossing cells; GIMP's order sinks to 1.86 there,\n"
                  "that of splines stays 2, from an error 1.9 and 2.4 times GIMP's at v0 = 0.001. A fixed side has an\n"
                  "odd image behind it: here the same as a symmetry plane. Linear functions are as good until points\n"
                  "cross cells, here from 80 cells on; the stress then jumps with every crossing, the error grows\n"
                  "with refinement, and the rows of linear functions at v0 = 0.1 miss for that reason. With the solid\n"
                  "of mpm_ptw.h, linear in another strain, a strain of 1 % leaves a second harmonic of 0.4 %.");
    rod_rows(MPM_GIMP, 250);
    rod_rows(MPM_GIMP, 1000);
    rod_rows(MPM_GIMP, 2000);
    rod_rows(MPM_LINEAR, 250);
    rod_rows(MPM_LINEAR, 1000);
    rod_rows(MPM_QUADRATIC, 250);
    rod_rows(MPM_QUADRATIC, 1000);
    rod_rows(MPM_CUBIC, 250);
    rod_rows(MPM_CUBIC, 1000);
    verify_remark("A wall acts on nodes, hence from up to one cell away: contact begins and ends early by up to cell\n"
                  "/ v, which is why the release misses 1 % on the coarser grids; its duration is right from 250\n"
                  "cells on. Splines, although they reach further, do as GIMP. Linear functions lose more the finer\n"
                  "the grid (velocity afterwards 0.977, 0.972, 0.944 of 250, 500, 1000 cells): the rod's end moves\n"
                  "by 0.3 while it bounces, over 8 cells or over 30, and each crossing leaves noise. Impact at high\n"
                  "speed wants GIMP or splines, or cells that are large beside the elastic motion.");
    return verify_end();
}
