/* spray_history.h - the history of a spray: what history.csv says of it. SPDX-License-Identifier: MIT */
#ifndef SPRAY_HISTORY_H
#define SPRAY_HISTORY_H

#include "history.h"
#include "mpm_spray.h"

#define SPRAY_HISTORY(X)                                                                        \
    X(SPRAY_TIME, "time", "ms", "since the start")                                              \
    X(SPRAY_INJECTED, "injected", "", "particles that left the nozzle")                         \
    X(SPRAY_FLYING, "flying", "", "particles in flight")                                        \
    X(SPRAY_LANDED, "landed", "", "particles on the target")                                    \
    X(SPRAY_ESCAPED, "escaped", "", "particles that left the domain")                           \
    X(SPRAY_BONDED, "bonded_share", "", "of the first touches, those that stuck")               \
    X(SPRAY_SHARE, "deposit_fraction", "", "landed over injected")                              \
    X(SPRAY_MASS, "mass_on_target", "mg", "of what has landed")                                 \
    X(SPRAY_HITS, "collisions", "", "in flight, so far")                                        \
    X(SPRAY_TOUCHES, "touches", "", "of target, deposit and walls, so far")                     \
    X(SPRAY_ENERGY, "energy_kinetic", "mJ", "of the particles in flight, along their way")      \
    X(SPRAY_SPEED, "speed_mean", "m/s", "of the particles in flight")                           \
    X(SPRAY_IMPACT, "impact_speed_mean", "m/s", "at the first touch, over all so far")          \
    X(SPRAY_THICKNESS, "thickness", "mm", "of the deposit, from its lowest centre to its highest")

enum { SPRAY_HISTORY(HISTORY_NUMBER) SPRAY_HISTORY_COLUMNS };

static inline void spray_history_begin(history *h)
{
    static const history_column column[] = {SPRAY_HISTORY(HISTORY_COLUMN)};
    history_begin(h, column, SPRAY_HISTORY_COLUMNS, 0);
}

/* Energy and mean speed of what flies. */
static inline void spray_history_flight(const mpm_spray *s, double *row)
{
    int32_t i;
    for (i = 0; i < s->live; i++) {
        const double x = (double)s->v[3 * i], y = (double)s->v[3 * i + 1], z = (double)s->v[3 * i + 2];
        const double r = (double)s->radius[i], mass = 4 * (double)MPM_PI / 3 * r * r * r * (double)s->density[i];
        row[SPRAY_ENERGY] += 1e3 * mass * (x * x + y * y + z * z) / 2;
        row[SPRAY_SPEED] += sqrt(x * x + y * y + z * z) / s->live;
    }
}

/* The next row. Test: 67_history. */
static inline void spray_history_sample(history *h, const mpm_spray *s)
{
    const mpm_spray_tally *t = &s->tally;
    double *row = history_row(h, t->step), cubes = 0;
    int32_t i;
    row[SPRAY_TIME] = (double)mpm_spray_time(s) * 1e3;
    row[SPRAY_INJECTED] = (double)t->injected;
    row[SPRAY_FLYING] = s->live;
    row[SPRAY_LANDED] = (double)t->deposited;
    row[SPRAY_ESCAPED] = (double)t->escaped;
    row[SPRAY_BONDED] = t->first_hits ? (double)t->first_hits_stuck / (double)t->first_hits : 0;
    row[SPRAY_SHARE] = t->injected ? (double)t->deposited / (double)t->injected : 0;
    for (i = 0; i < s->deposited; i++) cubes += pow((double)s->deposit_radius[i], 3);
    row[SPRAY_MASS] = 1e6 * 4 * (double)MPM_PI / 3 * cubes * (double)s->desc.density;
    row[SPRAY_HITS] = (double)t->pair_hits;
    row[SPRAY_TOUCHES] = (double)(t->wall_hits + t->target_hits + t->deposit_hits);
    row[SPRAY_IMPACT] = t->speed_mean;
    if (s->deposited > 0) row[SPRAY_THICKNESS] = 1e3 * (double)(s->deposit_high[0] - s->deposit_low[0]);
    spray_history_flight(s, row);
}

/* The history with a row of the state as it stands, which the run itself may not come by. */
static inline history spray_history_end(const history *past, const mpm_spray *s)
{
    history h = *past;
    history_due(&h, s->tally.step, 0);
    if (h.next != s->tally.step + h.every) spray_history_sample(&h, s);
    return h;
}

static inline int spray_history_png(const history *h, const char *folder, const char *title)
{
    const history_panel panel[8] = {
        {"particles", {SPRAY_INJECTED, SPRAY_FLYING, SPRAY_LANDED, SPRAY_ESCAPED, -1}},
        {"share that bonded", {SPRAY_BONDED, SPRAY_SHARE, -1}},
        {"mass on the target", {SPRAY_MASS, -1}},
        {"contacts so far", {SPRAY_HITS, SPRAY_TOUCHES, -1}},
        {"kinetic energy in flight", {SPRAY_ENERGY, -1}},
        {"speed", {SPRAY_SPEED, SPRAY_IMPACT, -1}},
        {"thickness of the deposit", {SPRAY_THICKNESS, -1}},
        {"particles in flight", {SPRAY_FLYING, -1}}};
    return history_png(h, folder, panel, 8, title);
}

#endif
