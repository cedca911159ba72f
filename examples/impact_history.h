/* impact_history.h - the history of an impact: what history.csv says of particles and substrate. Of the whole model,
   whatever of it the mirrors leave to be computed; particles are all bodies but the last.
   SPDX-License-Identifier: MIT */
#ifndef IMPACT_HISTORY_H
#define IMPACT_HISTORY_H

#include "history.h"
#include "impact_case.h"

#define IMPACT_HISTORY(X)                                                                                           \
    X(IMPACT_TIME, "time", "ns", "since the start")                                                                 \
    X(IMPACT_KINETIC, "energy_kinetic", "pJ", "of all bodies")                                                      \
    X(IMPACT_ELASTIC, "energy_elastic", "pJ", "internal energy since the start that is no plastic work")            \
    X(IMPACT_PLASTIC, "energy_plastic", "pJ", "plastic work")                                                       \
    X(IMPACT_ABSORBED, "energy_absorbed", "pJ", "taken by the dampers at the substrate's faces")                    \
    X(IMPACT_CONTACT, "energy_contact", "pJ", "lost in contact")                                                    \
    X(IMPACT_BOND, "energy_bond", "pJ", "lost in the bond")                                                         \
    X(IMPACT_WALLS, "energy_walls", "pJ", "lost at rigid walls, less what grips brought in")                        \
    X(IMPACT_UNACCOUNTED, "energy_unaccounted", "pJ", "the sum of these, less that at the start")                   \
    X(IMPACT_MOMENTUM, "momentum_particle", "ng m/s", "of the particles, upwards")                                  \
    X(IMPACT_MOMENTUM_BELOW, "momentum_substrate", "ng m/s", "of the substrate, upwards")                           \
    X(IMPACT_V_MEAN, "v_mean", "m/s", "mean velocity of the particles, upwards")                                    \
    X(IMPACT_V_NOISE, "v_noise", "m/s", "of their points: root mean square about the mean of each particle")        \
    X(IMPACT_FORCE, "contact_force", "uN", "on the particles, upwards, mean since the row before")                  \
    X(IMPACT_AREA, "contact_area", "um2", "of the particles' surface that touched another body")                    \
    X(IMPACT_BONDED, "bonded_area", "um2", "... that bonded")                                                       \
    X(IMPACT_ABP, "bond_mean", "", "ABP: mean D of what touched; 0 with contact on surfaces")                       \
    X(IMPACT_G, "interface_dissipation", "J/m2", "mean G of what touched; 0 with contact at nodes")                 \
    X(IMPACT_HOT, "temperature_max", "K", "of the hottest point")                                                   \
    X(IMPACT_MISES, "mises_max", "MPa", "largest equivalent stress of a point")                                     \
    X(IMPACT_PRESSURE, "pressure_max", "MPa", "largest pressure of a point")

enum { IMPACT_HISTORY(HISTORY_NUMBER) IMPACT_HISTORY_COLUMNS };

/* Of a run of so many steps. */
static inline void impact_history_begin(history *h, int64_t steps)
{
    static const history_column column[] = {IMPACT_HISTORY(HISTORY_COLUMN)};
    history_begin(h, column, IMPACT_HISTORY_COLUMNS, steps);
}

/* Energies, from the sums over all bodies. */
static inline void impact_history_energy(const impact *s, const mpm_totals *all, double whole, double *row)
{
    const mpm_ledger *l = &s->world.ledger;
    row[IMPACT_KINETIC] = whole * all->kinetic;
    row[IMPACT_ELASTIC] = whole * (all->internal - s->start.internal - all->plastic);
    row[IMPACT_PLASTIC] = whole * all->plastic;
    row[IMPACT_ABSORBED] = whole * l->absorbed;
    row[IMPACT_CONTACT] = whole * l->contact;
    row[IMPACT_BOND] = whole * l->hold;
    row[IMPACT_WALLS] = whole * l->walls;
    row[IMPACT_UNACCOUNTED] = whole * (all->kinetic + all->internal + l->absorbed + l->contact + l->hold + l->walls -
                                       s->start.kinetic - s->start.internal);
}

/* How the particles touch: areas, and G or D of what touched on the mean. */
static inline void impact_history_meeting(const impact *s, double whole, double *row)
{
    const mpm_world *w = &s->world;
    int32_t a;
    for (a = 0; a < w->bodies - 1; a++) {
        if (s->surfaces.surfaces > 0) {
            const mpm_meeting m = mpm_surface_meets(&s->surfaces, w, a, -1);
            const double touched = m.touched > 0 ? m.touched : m.area;
            row[IMPACT_AREA] += whole * touched;
            row[IMPACT_BONDED] += whole * m.bonded;
            row[IMPACT_G] += whole * touched * m.dissipated;
        } else {
            const mpm_bond_measure m = mpm_bond_measure_body(w, a);
            row[IMPACT_AREA] += whole * m.contacted_area;
            row[IMPACT_BONDED] += whole * m.bonded_area;
            row[IMPACT_ABP] += whole * m.contacted_area * m.abp;
        }
    }
    row[IMPACT_G] = case_share(row[IMPACT_G], row[IMPACT_AREA]);
    row[IMPACT_ABP] = case_share(row[IMPACT_ABP], row[IMPACT_AREA]);
}

/* Adds what a body adds to the sums over all. */
static inline void impact_history_add(mpm_totals *all, const mpm_totals *t)
{
    all->kinetic += t->kinetic;
    all->internal += t->internal;
    all->plastic += t->plastic;
    if (t->temperature_max > all->temperature_max) all->temperature_max = t->temperature_max;
}

/* The next row: the run as it stands, between two steps. Test: 67_history. */
static inline void impact_history_sample(history *h, const impact *s)
{
    const mpm_world *w = &s->world;
    const double whole = impact_copies(s);
    double *row = history_row(h, w->steps), mass = 0, noise = 0;
    mpm_totals all;
    int32_t a;
    memset(&all, 0, sizeof all);
    row[IMPACT_TIME] = (double)w->time * 1e3;
    for (a = 0; a < w->bodies; a++) {
        const mpm_totals t = mpm_body_totals(w, a);
        impact_history_add(&all, &t);
        row[a < w->bodies - 1 ? IMPACT_MOMENTUM : IMPACT_MOMENTUM_BELOW] += whole * t.momentum[2];
        if (a == w->bodies - 1) continue;
        mass += t.mass;
        noise += history_spread(w, a, t.momentum[2] / t.mass);
    }
    impact_history_energy(s, &all, whole, row);
    impact_history_meeting(s, whole, row);
    row[IMPACT_V_MEAN] = row[IMPACT_MOMENTUM] / (whole * mass);
    row[IMPACT_V_NOISE] = sqrt(noise / mass);
    row[IMPACT_FORCE] = 1e3 * history_rate(h, IMPACT_MOMENTUM); /* ng m/s per ns */
    row[IMPACT_HOT] = all.temperature_max;
    history_stress(&w->points, &row[IMPACT_MISES], &row[IMPACT_PRESSURE]);
}

/* Takes what others than the substrate gave the particles since the row before, momentum of the model, out of the force
   of the last row. */
static inline void impact_history_push(history *h, const impact *s, double momentum)
{
    double *row = h->row[h->rows - 1];
    const double since = h->rows > 1 ? row[IMPACT_TIME] - h->row[h->rows - 2][IMPACT_TIME] : 0;
    if (since > 0) row[IMPACT_FORCE] -= 1e3 * impact_copies(s) * momentum / since;
}

/* Its picture: of the bond G on surfaces, and D at nodes. */
static inline int impact_history_png(const history *h, const char *folder, const char *title)
{
    const int bond = history_most(h, IMPACT_G) > 0 ? IMPACT_G : IMPACT_ABP;
    history_panel panel[8] = {
        {"energy", {IMPACT_KINETIC, IMPACT_ELASTIC, IMPACT_PLASTIC, IMPACT_ABSORBED, IMPACT_CONTACT, IMPACT_BOND,
                    IMPACT_WALLS, IMPACT_UNACCOUNTED, -1}},
        {"velocity of the particle", {IMPACT_V_MEAN, IMPACT_V_NOISE, -1}},
        {"momentum", {IMPACT_MOMENTUM, IMPACT_MOMENTUM_BELOW, -1}},
        {"contact force", {IMPACT_FORCE, -1}},
        {"area", {IMPACT_AREA, IMPACT_BONDED, -1}},
        {"bond: mean D of what touched", {IMPACT_ABP, -1}},
        {"highest temperature", {IMPACT_HOT, -1}},
        {"largest stress", {IMPACT_MISES, IMPACT_PRESSURE, -1}}};
    panel[5].column[0] = bond;
    if (bond == IMPACT_G) panel[5].title = "dissipation G of what touched";
    return history_png(h, folder, panel, 8, title);
}

#endif
