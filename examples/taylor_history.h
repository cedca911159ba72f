/* taylor_history.h - the history of a Taylor bar: what history.csv says of it. Of the whole bar.
   SPDX-License-Identifier: MIT */
#ifndef TAYLOR_HISTORY_H
#define TAYLOR_HISTORY_H

#include "history.h"
#include "taylor_case.h"

#define TAYLOR_HISTORY(X)                                                                                 \
    X(TAYLOR_TIME, "time", "us", "since the start")                                                       \
    X(TAYLOR_KINETIC, "energy_kinetic", "J", "of the bar")                                                \
    X(TAYLOR_ELASTIC, "energy_elastic", "J", "internal energy since the start that is no plastic work")   \
    X(TAYLOR_PLASTIC, "energy_plastic", "J", "plastic work")                                              \
    X(TAYLOR_WALL, "energy_walls", "J", "lost at the wall")                                               \
    X(TAYLOR_UNACCOUNTED, "energy_unaccounted", "J", "the sum of these, less that at the start")          \
    X(TAYLOR_MOMENTUM, "momentum", "g m/s", "of the bar, away from the wall")                             \
    X(TAYLOR_V_MEAN, "v_mean", "m/s", "mean velocity, away from the wall")                                \
    X(TAYLOR_V_NOISE, "v_noise", "m/s", "of the points: root mean square about the mean, along the axis") \
    X(TAYLOR_FORCE, "wall_force", "kN", "on the bar, mean since the row before")                          \
    X(TAYLOR_LENGTH, "length", "mm", "of the bar")                                                        \
    X(TAYLOR_RADIUS, "radius", "mm", "largest of the side")                                               \
    X(TAYLOR_HOT, "temperature_max", "K", "of the hottest point")                                         \
    X(TAYLOR_STRAIN, "plastic_strain_max", "", "of any point")                                            \
    X(TAYLOR_MISES, "mises_max", "MPa", "largest equivalent stress of a point")                           \
    X(TAYLOR_PRESSURE, "pressure_max", "MPa", "largest pressure of a point")

enum { TAYLOR_HISTORY(HISTORY_NUMBER) TAYLOR_HISTORY_COLUMNS };

static inline void taylor_history_begin(history *h, const taylor *s)
{
    static const history_column column[] = {TAYLOR_HISTORY(HISTORY_COLUMN)};
    history_begin(h, column, TAYLOR_HISTORY_COLUMNS, s->steps);
}

/* The next row. Returns 1, or 0 after a message. Test: 67_history. */
static inline int taylor_history_sample(history *h, const taylor *s, const taylor_case *c)
{
    const mpm_world *w = &s->world;
    const double whole = w->desc.geometry == MPM_3D ? 4 : 1, joule = 1e-3 * whole; /* of g (m/s)^2 */
    double *row = history_row(h, w->steps);
    taylor_result r;
    if (!taylor_measure(s, c, NULL, &r)) return complain("no memory for the history");
    row[TAYLOR_TIME] = (double)w->time * 1e3;
    row[TAYLOR_KINETIC] = joule * r.totals.kinetic;
    row[TAYLOR_ELASTIC] = joule * (r.totals.internal - s->start.internal - r.totals.plastic);
    row[TAYLOR_PLASTIC] = joule * r.totals.plastic;
    row[TAYLOR_WALL] = joule * w->ledger.walls;
    row[TAYLOR_UNACCOUNTED] = joule * (r.totals.kinetic + r.totals.internal + w->ledger.walls - s->start.kinetic -
                                       s->start.internal);
    row[TAYLOR_MOMENTUM] = whole * r.totals.momentum[2];
    row[TAYLOR_V_MEAN] = r.velocity;
    row[TAYLOR_V_NOISE] = sqrt(history_spread(w, 0, r.velocity) / r.totals.mass);
    row[TAYLOR_FORCE] = history_rate(h, TAYLOR_MOMENTUM); /* g m/s per us */
    row[TAYLOR_LENGTH] = r.length;
    row[TAYLOR_RADIUS] = r.radius;
    row[TAYLOR_HOT] = r.temperature_max;
    row[TAYLOR_STRAIN] = r.eps_max;
    history_stress(&w->points, &row[TAYLOR_MISES], &row[TAYLOR_PRESSURE]);
    return 1;
}

static inline int taylor_history_png(const history *h, const char *folder, const char *title)
{
    const history_panel panel[8] = {
        {"energy", {TAYLOR_KINETIC, TAYLOR_ELASTIC, TAYLOR_PLASTIC, TAYLOR_WALL, TAYLOR_UNACCOUNTED, -1}},
        {"velocity of the bar", {TAYLOR_V_MEAN, TAYLOR_V_NOISE, -1}},
        {"length of the bar", {TAYLOR_LENGTH, -1}},
        {"force of the wall", {TAYLOR_FORCE, -1}},
        {"largest radius", {TAYLOR_RADIUS, -1}},
        {"largest plastic strain", {TAYLOR_STRAIN, -1}},
        {"highest temperature", {TAYLOR_HOT, -1}},
        {"largest stress", {TAYLOR_MISES, TAYLOR_PRESSURE, -1}}};
    return history_png(h, folder, panel, 8, title);
}

#endif
