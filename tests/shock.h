/* shock.h - two plates collide in uniaxial strain: the state behind the shock, beside the Hugoniot's.
   In um, us, ng. SPDX-License-Identifier: MIT */
#ifndef SHOCK_H
#define SHOCK_H

#include "mpm.h"
#include "mpm_ptw.h"

#include <math.h>
#include <stdlib.h>

/* What is shot at what. Plate 0 comes from below; the interface is at z = 0 when they meet. */
typedef struct shock {
    mpm_material plate[2];
    mpm_basis basis;
    double speed;   /* of plate 0 against plate 1 [m/s] */
    double rest;    /* velocity of plate 1: 0 laboratory frame, -speed/2 centre frame of equal plates */
    int bodies;     /* 1: one body whose velocity jumps (of plate[0]); 2: two bodies in contact */
    int cells;      /* per plate */
    int per_cell;   /* points per cell and direction */
    double factor;  /* share of the critical step */
} shock;

/* The state behind the shock in one plate: mean over the layers, and their standard deviation. */
typedef struct shock_state {
    double velocity, pressure, stress, ratio, energy, temperature; /* stress: along z, compression positive */
    double velocity_noise, pressure_noise;
    double speed;   /* of the shock through the undeformed plate */
    int layers;
} shock_state;

/* A metal as a fluid with a Mie-Grueneisen equation of state: a yield stress of 1 kPa. */
static inline mpm_material shock_fluid(const char *name)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = mpm_material_default();
    mpm_material_preset(&m, name, &u, NULL);
    m.strength = MPM_STRENGTH_LINEAR;
    m.linear_yield = MPM_R(1e-3);
    m.shear = MPM_SHEAR_CONSTANT;
    m.shear_modulus = m.young / (2 * (1 + m.poisson));
    m.melt = MPM_MELT_NONE;
    return m;
}

/* The usual bulk viscosity, and heat wherever energy goes. */
static inline void shock_settings(mpm_material *m)
{
    m->viscosity_linear = MPM_R(0.2);
    m->viscosity_quadratic = MPM_R(1.5);
    m->compression_heating = 1;
    m->heat_fraction = 1;
}

static inline shock shock_default(const char *metal, double speed)
{
    shock s;
    s.plate[0] = s.plate[1] = shock_fluid(metal);
    shock_settings(&s.plate[0]);
    shock_settings(&s.plate[1]);
    s.basis = MPM_GIMP;
    s.speed = speed;
    s.rest = 0;
    s.bodies = 1;
    s.cells = 200;
    s.per_cell = 4;
    s.factor = 0.2;
    return s;
}

/* Exact answers: U = c0 + s u, p = rho0 U u, rho/rho0 = U/(U - u), e = u^2/2 (Rankine-Hugoniot). */
static inline double shock_hugoniot_speed(const mpm_material *m, double u)
{
    return (double)m->sound_speed + (double)m->hugoniot_slope * u;
}

/* Temperature on the Hugoniot at particle velocity u:
   rho0 Cp dT = -rho0 Cp Gamma0 T dx' + ((1 - x') dp + p dx')/2 along x' = V/V0, by the midpoint rule. */
static inline double shock_hugoniot_temperature(const mpm_material *m, double u)
{
    const double end = u / shock_hugoniot_speed(m, u), heat = (double)m->density * (double)m->specific_heat;
    const double stiff = (double)m->density * (double)m->sound_speed * (double)m->sound_speed;
    double T = (double)m->temperature, p = 0;
    int i, n = 20000;
    for (i = 1; i <= n; i++) { /* x = 1 - V/V0 */
        const double x = end * i / n, dx = end / n, was = p, a = 1 - (double)m->hugoniot_slope * x;
        p = stiff * x / (a * a);
        T *= (1 + (double)m->gruneisen * dx / 2) / (1 - (double)m->gruneisen * dx / 2);
        T += ((x - dx / 2) * (p - was) - (p + was) / 2 * dx) / 2 / heat;
    }
    return T;
}

/* Particle velocity in plate 1 where the pressures of two unequal plates match (bisection). */
static inline double shock_match(const shock *s)
{
    double low = 0, high = s->speed;
    int i;
    for (i = 0; i < 200; i++) {
        const double u = (low + high) / 2, w = s->speed - u;
        const double p1 = (double)s->plate[1].density * shock_hugoniot_speed(&s->plate[1], u) * u;
        const double p0 = (double)s->plate[0].density * shock_hugoniot_speed(&s->plate[0], w) * w;
        if (p1 < p0) low = u;
        else high = u;
    }
    return (low + high) / 2;
}

static inline mpm_status shock_begin(shock *s, mpm_world *w)
{
    const mpm_real L = (mpm_real)s->cells, top = s->bodies == 1 ? L : 0;
    const int margin = s->cells / 2;
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_status e;
    int32_t i;
    int k;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = s->basis;
    d.scheme = MPM_SCHEME_THESIS;
    d.cell = 1;
    d.cells[2] = 2 * (s->cells + margin);
    d.origin[2] = -(mpm_real)(s->cells + margin);
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    d.contact.normal = MPM_NORMAL_FIXED;
    d.bodies = 2;
    d.points = 2 * s->cells * s->per_cell * s->per_cell;
    if ((e = mpm_init(w, &d, NULL, 0)) < 0) return e;
    for (k = s->bodies - 1; k >= 0; k--) { /* fixed normals want the lower body last */
        mpm_material *m = &s->plate[k];
        b.shape = k == 0 ? mpm_box(0, 0, -L, 1, 1, top) : mpm_box(0, 0, 0, 1, 1, L);
        b.spacing = 1 / (mpm_real)s->per_cell;
        b.density = m->density;
        b.temperature = m->temperature;
        b.stress = mpm_material_stress;
        b.material = m;
        mpm_material_wave_speeds(m, m->density, &b.wave_p, &b.wave_s);
        if ((e = mpm_material_check(m, &w->fault)) < 0 || (e = mpm_body_add(w, &b)) < 0) return e;
    }
    for (i = 0; i < w->points.count; i++)
        w->points.v[2][i] = (mpm_real)(s->rest + (w->points.x[2][i] < 0 ? s->speed : 0));
    return MPM_OK;
}

/* Sums over the points of each layer of a plate, layers counted from the interface. */
typedef struct shock_layers {
    int count;
    double *pressure, *stress, *velocity, *volume, *energy, *temperature;
} shock_layers;

/* The layers of plate k; layer[] is the layer of every point by id, negative in plate 0. */
static inline void shock_gather(const shock *s, const mpm_world *w, const int *layer, int k, shock_layers *l)
{
    const mpm_points *q = &w->points;
    int32_t i;
    int j;
    for (j = 0; j < 6 * l->count; j++) l->pressure[j] = 0;
    for (i = 0; i < q->count; i++) {
        const int at = k == 0 ? -1 - layer[q->id[i]] : layer[q->id[i]];
        const double share = 1.0 / s->per_cell;
        if (at < 0) continue;
        l->pressure[at] -= share * (double)(q->stress[0][i] + q->stress[1][i] + q->stress[2][i]) / 3;
        l->stress[at] -= share * (double)q->stress[2][i];
        l->velocity[at] += share * (double)q->v[2][i];
        l->volume[at] += share / (double)q->density[i];
        l->energy[at] += share * (double)q->energy[i];
        l->temperature[at] += share * (double)q->temperature[i];
    }
}

/* Velocity that plate k gains in the shock, from the velocity v behind it; and what it should be. */
static inline double shock_gained(const shock *s, int k, double v) { return k ? v - s->rest : s->rest + s->speed - v; }
static inline double shock_gain(const shock *s, int k) { return k ? shock_match(s) : s->speed - shock_match(s); }

/* Depth of the front: where, from outside, half of the velocity is gained first; interpolated. */
static inline double shock_front(const shock *s, const shock_layers *l, int k)
{
    const double half = shock_gain(s, k) / 2;
    int j = l->count - 1;
    double in, out;
    while (j > 0 && shock_gained(s, k, l->velocity[j]) < half) j--;
    if (j == l->count - 1) return 0;
    in = shock_gained(s, k, l->velocity[j]);
    out = shock_gained(s, k, l->velocity[j + 1]);
    return (j + 0.5 + (in > out ? (in - half) / (in - out) : 0)) / s->per_cell;
}

static inline double shock_mean(const double *a, int from, int to, double *noise)
{
    double mean = 0, square = 0;
    int j;
    for (j = from; j < to; j++) mean += a[j] / (to - from);
    for (j = from; j < to; j++) square += (a[j] - mean) * (a[j] - mean) / (to - from);
    if (noise) *noise = sqrt(square);
    return mean;
}

/* Means over the layers between 12 cells from the interface and 12 behind the front. */
static inline shock_state shock_read(const shock *s, const shock_layers *l, const mpm_material *m, double front)
{
    const int from = 12 * s->per_cell, to = (int)((front - 12) * s->per_cell);
    shock_state r = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    if (!(to - from >= 10)) return r;
    r.layers = to - from;
    r.velocity = shock_mean(l->velocity, from, to, &r.velocity_noise);
    r.pressure = shock_mean(l->pressure, from, to, &r.pressure_noise);
    r.stress = shock_mean(l->stress, from, to, NULL);
    r.ratio = 1 / (shock_mean(l->volume, from, to, NULL) * (double)m->density);
    r.energy = shock_mean(l->energy, from, to, NULL);
    r.temperature = shock_mean(l->temperature, from, to, NULL);
    return r;
}

/* Runs until the shock in plate k has gone through three quarters of it and reads the state there.
   layers = 0 tells of a failure. */
static inline shock_state shock_run(shock *s, int k)
{
    const int points = 2 * s->cells * s->per_cell * s->per_cell, layers = s->cells * s->per_cell;
    shock_state r = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    int *layer = (int *)malloc((size_t)points * sizeof *layer), n;
    double *data = (double *)malloc((size_t)(6 * layers) * sizeof *data), front[2] = {0, 0}, at[2] = {0, 0}, end;
    shock_layers l;
    mpm_world w;
    mpm_real dt;
    int32_t i;
    l.count = layers;
    l.pressure = data;
    if (layer && data && shock_begin(s, &w) == MPM_OK) {
        l.stress = data + layers;
        l.velocity = data + 2 * layers;
        l.volume = data + 3 * layers;
        l.energy = data + 4 * layers;
        l.temperature = data + 5 * layers;
        for (i = 0; i < points; i++)
            layer[w.points.id[i]] = (int)floor((double)w.points.x[2][i] * s->per_cell);
        dt = mpm_time_step(&w, (mpm_real)s->factor);
        end = 0.75 * s->cells / shock_hugoniot_speed(&s->plate[k], shock_gain(s, k));
        for (n = 0; n < 2; n++) {
            while ((double)w.time < (n == 0 ? end / 2 : end))
                if (mpm_step(&w, dt) < 0) break;
            shock_gather(s, &w, layer, k, &l);
            front[n] = shock_front(s, &l, k);
            at[n] = (double)w.time;
        }
        if (at[1] >= end) r = shock_read(s, &l, &s->plate[k], front[1]);
        r.speed = (front[1] - front[0]) / (at[1] - at[0]);
        mpm_free(&w);
    }
    free(layer);
    free(data);
    return r;
}

#endif
