/* taylor_case.h - a cylinder hits a rigid wall end on (Taylor's test): the scene that examples/taylor
   and the verification share. Described in mm, m/s, us and K; built in mm, ms, g, whose stress is MPa
   and velocity m/s. SPDX-License-Identifier: MIT */
#ifndef TAYLOR_CASE_H
#define TAYLOR_CASE_H

#include "case.h"
#include "mpm.h"
#include "mpm_ptw.h"

#include <math.h>
#include <stdlib.h>

/* The words of an option; of others the lists are the library's. */
#define TAYLOR_WALLS "sliding|contact"
#define TAYLOR_GEOMETRIES "axisymmetric|3d"

/* What to run. Every member is an option of examples/taylor; the defaults are the benchmark that codes
   compare on: copper, flow stress 400 + 100 eps MPa, 80 us, a foot that slides on the wall.
   On the wall: as a symmetry plane, which the foot never leaves (the published computations do this:
   only so do finite elements give their radius); or as a wall in contact, from which a frictionless
   foot lifts its rim. */
typedef struct taylor_case {
    double length, diameter, velocity;  /* mm, mm, m/s */
    double temperature;                 /* at the start, K */
    double cell, spacing;               /* mm; both scaled to a whole number of spacings in the radius */
    double time, dt_factor;             /* us; of the critical step of the cell */
    double friction;                    /* Coulomb coefficient of the wall in contact */
    const char *wall, *material, *model, *geometry, *functions;
} taylor_case;

static inline taylor_case taylor_case_default(void)
{
    taylor_case c;
    c.length = 32.4;
    c.diameter = 6.4;
    c.velocity = 227;
    c.temperature = 298;
    c.cell = 0.2;
    c.spacing = 0.1;
    c.time = 80;
    c.dt_factor = 0.2;
    c.friction = 0;
    c.wall = "sliding";
    c.material = "cu";
    c.model = "linear";
    c.geometry = "axisymmetric";
    c.functions = "gimp";
    return c;
}

/* A case being run. */
typedef struct taylor {
    mpm_world world;
    mpm_material material;
    int first_radius, first_height;       /* user fields of the points: where they began */
    double spacing, cell, radius, length; /* as used, mm: multiples of the spacing */
    mpm_real dt;                          /* ms */
    int64_t steps;
    mpm_totals start;
} taylor;

/* Checks what the library cannot know. Returns 1, or 0 with a message. */
static inline int taylor_check(const taylor_case *c, char *m, size_t n)
{
    const double big = 1e6;
    return case_wants(c->length > 0 && c->length < big, "length", c->length, "must be > 0 mm", m, n) &&
           case_wants(c->diameter > 0 && c->diameter < big, "diameter", c->diameter, "must be > 0 mm", m, n) &&
           case_wants(c->velocity > 0 && c->velocity < 1e5, "velocity", c->velocity, "must be > 0 m/s", m, n) &&
           case_wants(c->temperature >= 0 && c->temperature < 1e5, "temperature", c->temperature, "must be >= 0 K",
                      m, n) &&
           case_wants(c->cell > 0 && c->cell < big, "cell", c->cell, "must be > 0 mm", m, n) &&
           case_wants(c->spacing > 0, "spacing", c->spacing, "must be > 0 mm", m, n) &&
           case_wants(c->spacing <= c->cell, "spacing", c->spacing, "must not be larger than the cell", m, n) &&
           case_wants(c->spacing * 1000 > c->diameter, "spacing", c->spacing, "too fine for the diameter", m, n) &&
           case_wants(c->spacing * 10000 > c->length, "spacing", c->spacing, "too fine for the length", m, n) &&
           case_wants(c->spacing <= c->diameter / 8, "spacing", c->spacing, "too coarse for the diameter", m, n) &&
           case_wants(c->spacing <= c->length / 8, "spacing", c->spacing, "too coarse for the length", m, n) &&
           case_wants(c->time > 0 && c->time < 1e9, "time", c->time, "must be > 0 us", m, n) &&
           case_wants(c->dt_factor > 0 && c->dt_factor <= 1, "dt-factor", c->dt_factor, "must be in (0, 1]", m, n) &&
           case_wants(c->friction >= 0 && c->friction < 1e30, "friction", c->friction, "must be >= 0", m, n) &&
           case_knows(TAYLOR_WALLS, "wall", c->wall, m, n) &&
           case_wants(!(c->friction > 0) || !strcmp(c->wall, "contact"), "friction", c->friction,
                      "a sliding wall has none: add --wall contact", m, n) &&
           case_knows(TAYLOR_GEOMETRIES, "geometry", c->geometry, m, n) &&
           case_knows(MPM_NAMES(MPM_BASIS_LIST), "functions", c->functions, m, n);
}

/* Preset and model. Returns 1, or 0 with a message. */
static inline int taylor_material(mpm_material *material, const taylor_case *c, char *message, size_t n)
{
    const mpm_units units = mpm_units_mm_ms_g();
    mpm_fault fault;
    if (mpm_material_preset(material, c->material, &units, &fault) != MPM_OK) {
        snprintf(message, n, "--material %s: %s (build/material --list shows them)", c->material,
                 mpm_status_text(MPM_ERR_UNKNOWN));
        return 0;
    }
    if (!case_knows(MPM_NAMES(MPM_STRENGTH_LIST), "model", c->model, message, n)) return 0;
    if (mpm_material_model(material, c->model, &fault) != MPM_OK) {
        snprintf(message, n, "--model %s: no published set for --material %s", c->model, c->material);
        return 0;
    }
    case_heat(material, c->temperature);
    return 1;
}

/* The grid: the wall is its lower side, the axis its inner; room to spread to four radii. */
static inline mpm_desc taylor_grid(const taylor *s, const taylor_case *c)
{
    mpm_desc d = mpm_desc_default();
    d.geometry = (mpm_geometry)word_place(MPM_NAMES(MPM_GEOMETRY_LIST), c->geometry);
    d.basis = (mpm_basis)word_place(MPM_NAMES(MPM_BASIS_LIST), c->functions);
    d.cell = (mpm_real)s->cell;
    d.cells[0] = d.cells[1] = (int32_t)ceil(4 * s->radius / s->cell) + 4;
    d.cells[2] = (int32_t)ceil((s->length + 4 * s->radius) / s->cell) + 4;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    d.side[4] = strcmp(c->wall, "contact") ? MPM_SIDE_SYMMETRY : MPM_SIDE_WALL;
    d.wall_friction = (mpm_real)c->friction;
    return d;
}

static inline mpm_body_desc taylor_bar(taylor *s, const taylor_case *c)
{
    mpm_body_desc bar = mpm_body_desc_default();
    bar.shape = mpm_cylinder(0, 0, 0, (mpm_real)s->radius, (mpm_real)s->length);
    bar.spacing = (mpm_real)s->spacing;
    bar.density = s->material.density;
    bar.temperature = s->material.temperature;
    bar.velocity[2] = (mpm_real)-c->velocity;
    bar.stress = mpm_material_stress;
    bar.material = &s->material;
    mpm_material_wave_speeds(&s->material, s->material.density, &bar.wave_p, &bar.wave_s);
    return bar;
}

/* Notes in each point where it begins. */
static inline mpm_status taylor_note(taylor *s)
{
    const mpm_points *p = &s->world.points;
    int32_t i;
    s->first_radius = mpm_field_take(&s->world, "radius at the start (mm)");
    s->first_height = mpm_field_take(&s->world, "height at the start (mm)");
    if (s->first_radius < 0 || s->first_height < 0) return MPM_ERR_MEMORY;
    for (i = 0; i < p->count; i++) {
        p->user[s->first_radius][i] = (mpm_real)sqrt((double)(p->x[0][i] * p->x[0][i] + p->x[1][i] * p->x[1][i]));
        p->user[s->first_height][i] = p->x[2][i];
    }
    return MPM_OK;
}

/* Builds the scene. Returns 1, or 0 with a message; then nothing is left to free. */
static inline int taylor_begin(taylor *s, const taylor_case *c, char *message, size_t n)
{
    mpm_body_desc bar;
    mpm_desc d;
    mpm_status status;
    double steps;
    memset(s, 0, sizeof *s);
    if (!taylor_check(c, message, n) || !taylor_material(&s->material, c, message, n)) return 0;
    s->radius = c->diameter / 2;
    s->spacing = s->radius / floor(s->radius / c->spacing + 0.5);
    s->cell = c->cell / c->spacing * s->spacing;
    s->length = s->spacing * floor(c->length / s->spacing + 0.5);
    bar = taylor_bar(s, c);
    d = taylor_grid(s, c);
    status = mpm_material_check(&s->material, &s->world.fault);
    if (status == MPM_OK) status = mpm_init(&s->world, &d, NULL, 0);
    if (status == MPM_OK) status = mpm_body_add(&s->world, &bar);
    if (status == MPM_OK) status = taylor_note(s);
    if (status != MPM_OK) {
        mpm_io_fault_text(message, n, &s->world.fault);
        mpm_free(&s->world);
        return 0;
    }
    s->dt = mpm_time_step(&s->world, (mpm_real)c->dt_factor);
    steps = ceil(c->time * 1e-3 / (double)s->dt - 1e-9); /* dt may be 0 or tiny: then this is huge, or infinite */
    if (!case_wants(steps < 1e9, "dt-factor", c->dt_factor, "makes more than 1e9 steps", message, n)) {
        mpm_free(&s->world);
        return 0;
    }
    s->steps = (int64_t)steps;
    s->start = mpm_body_totals(&s->world, -1);
    return 1;
}

static inline mpm_status taylor_step(taylor *s) { return mpm_step(&s->world, s->dt); }

/* ---- measures -------------------------------------------------------------------------------- */

/* The side of the bar: where the material that was at height `start` is now. */
typedef struct taylor_row {
    double start, z, radius; /* mm */
} taylor_row;

/* Sums over the points of one layer: those near the rim for a straight line over the starting radius,
   and all of them for the mean height. */
typedef struct taylor_layer {
    double n, r0, r0r0, r, r0r, z, r0z;
    double mass, mass_z, low;
} taylor_layer;

static inline void taylor_layer_add(taylor_layer *l, double r0, double r, double z, double mass, int near_rim)
{
    if (!(l->mass > 0) || z < l->low) l->low = z;
    l->mass += mass;
    l->mass_z += mass * z;
    if (!near_rim) return;
    l->n += 1;
    l->r0 += r0;
    l->r0r0 += r0 * r0;
    l->r += r;
    l->r0r += r0 * r;
    l->z += z;
    l->r0z += r0 * z;
}

/* The value at starting radius `rim` of the straight line with the sums y and r0 y. */
static inline double taylor_at_rim(const taylor_layer *l, double y, double r0y, double rim)
{
    double spread = l->r0r0 - l->r0 * l->r0 / l->n;
    double slope = spread > 1e-9 * l->r0r0 ? (r0y - l->r0 * y / l->n) / spread : 0;
    return y / l->n + slope * (rim - l->r0 / l->n);
}

/* What came out. The surface lies half a spacing of the undeformed bar outside the outermost points:
   their places are carried on to it along straight lines in the undeformed bar, through the two
   outermost rings of a layer (in 3D: through all its points there) and through the two outermost
   layers. */
typedef struct taylor_result {
    double length, radius;                /* mm: height of the far end, largest radius of the side */
    double eps_max, eps_mean, temperature_max, velocity; /* 1, 1, K; mean v_z, m/s */
    double mass_error, momentum_error, energy_error; /* relative; energy: kinetic + internal */
    double energy_unaccounted;            /* the same with the loss at the wall */
    mpm_totals totals;
} taylor_result;

/* Rows of the profile: one per layer of points, and the two end faces. */
static inline long taylor_rows(const taylor *s) { return (long)(s->length / s->spacing + 0.5) + 2; }

static inline void taylor_layers(const taylor *s, taylor_layer *layer, long layers)
{
    const mpm_points *p = &s->world.points;
    int32_t i;
    memset(layer, 0, (size_t)layers * sizeof *layer);
    for (i = 0; i < p->count; i++) {
        double x = (double)p->x[0][i], y = (double)p->x[1][i], r0 = (double)p->user[s->first_radius][i];
        long k = (long)((double)p->user[s->first_height][i] / s->spacing);
        if (k >= layers) k = layers - 1;
        taylor_layer_add(&layer[k], r0, sqrt(x * x + y * y), (double)p->x[2][i], (double)p->mass[i],
                         r0 > s->radius - 2.1 * s->spacing);
    }
}

/* Fills `row` (taylor_rows of them, from the foot up; may be NULL). Returns 0 without memory. */
static inline int taylor_measure(const taylor *s, const taylor_case *c, taylor_row *row, taylor_result *r)
{
    const mpm_world *w = &s->world;
    const mpm_points *p = &w->points;
    const long n = taylor_rows(s) - 2;
    const double energy = s->start.kinetic + s->start.internal, cut = c->length - s->length;
    taylor_layer *layer = (taylor_layer *)malloc((size_t)n * sizeof *layer);
    taylor_row *own = (taylor_row *)malloc((size_t)(n + 2) * sizeof *own), *q = row ? row : own;
    double mean[4];
    const long at[4] = {0, 1, n - 2, n - 1};
    long k;
    int32_t i;
    memset(r, 0, sizeof *r);
    if (!layer || !own) {
        free(layer);
        free(own);
        return 0;
    }
    taylor_layers(s, layer, n);
    for (k = 0; k < n; k++) {
        q[k + 1].start = ((double)k + 0.5) * s->spacing;
        q[k + 1].z = taylor_at_rim(&layer[k], layer[k].z, layer[k].r0z, s->radius);
        q[k + 1].radius = taylor_at_rim(&layer[k], layer[k].r, layer[k].r0r, s->radius);
    }
    q[0].start = 0;
    q[0].z = 1.5 * q[1].z - 0.5 * q[2].z;
    q[0].radius = 1.5 * q[1].radius - 0.5 * q[2].radius;
    q[n + 1].start = s->length;
    q[n + 1].z = 1.5 * q[n].z - 0.5 * q[n - 1].z;
    q[n + 1].radius = 1.5 * q[n].radius - 0.5 * q[n - 1].radius;
    for (k = 0; k < 4; k++) mean[k] = layer[at[k]].mass_z / layer[at[k]].mass;
    r->length = 1.5 * mean[3] - 0.5 * mean[2] + cut - (layer[0].low - (mean[1] - mean[0]) / 2);
    for (k = 0; k < n + 2; k++)
        if (q[k].radius > r->radius) r->radius = q[k].radius;
    for (i = 0; i < p->count; i++)
        if ((double)p->plastic_strain[i] > r->eps_max) r->eps_max = (double)p->plastic_strain[i];
    r->totals = mpm_body_totals(w, 0);
    r->eps_mean = r->totals.plastic_strain_mean;
    r->temperature_max = r->totals.temperature_max;
    r->velocity = r->totals.momentum[2] / r->totals.mass;
    r->mass_error = (r->totals.mass - s->start.mass) / s->start.mass;
    r->momentum_error = (r->totals.momentum[2] - s->start.momentum[2] - w->ledger.impulse[2]) /
                        fabs(s->start.momentum[2]);
    r->energy_error = (r->totals.kinetic + r->totals.internal - energy) / energy;
    r->energy_unaccounted = r->energy_error + w->ledger.walls / energy;
    free(layer);
    free(own);
    return 1;
}

#endif
