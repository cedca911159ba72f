/* impact_case.h - one particle on one substrate: the scene that the impact examples share.
   Describes it in um, m/s and ns, builds it in um, us and ng, and measures what came out.
   SPDX-License-Identifier: MIT */
#ifndef IMPACT_CASE_H
#define IMPACT_CASE_H

#include "mpm.h"
#include "mpm_ptw.h"
#include "mpm_bond.h"
#include "mpm_io.h"

#include <stdio.h>
#include <string.h>

/* What to run. Every member is an option of examples/impact; the defaults are its main job. */
typedef struct impact_case {
    double diameter, velocity;                     /* um, m/s */
    double cell, spacing;                          /* um */
    double substrate_diameter, substrate_height;   /* um */
    double time, dt_factor;                        /* ns; of the critical step of a 0.5 um cell */
    double gc, gdot, floor;                        /* J/m2, J/m2/us, 1 */
    double friction;
    double gap, offset;                            /* um: start distance; shift of the grid */
    double margin;                                 /* free grid around the bodies, particle diameters */
    const char *bond, *symmetry, *material, *geometry, *functions, *plasticity, *normal;
} impact_case;

static inline impact_case impact_case_default(void)
{
    impact_case c;
    memset(&c, 0, sizeof c);
    c.diameter = 14;
    c.velocity = 810;
    c.cell = 1.5;
    c.spacing = 0.5;
    c.substrate_diameter = 30;
    c.substrate_height = 10;
    c.time = 80;
    c.dt_factor = 0.1;
    c.gc = 1503.74;
    c.gdot = 2.271e5;
    c.floor = 0.05;
    c.margin = 1;
    c.bond = "energy";
    c.symmetry = "quarter";
    c.material = "al";
    c.geometry = "3d";
    c.functions = "linear";
    c.plasticity = "consistent";
    c.normal = "ranked";
    return c;
}

/* A case being run: the world in um, us, ng, whose stress is MPa and velocity m/s. */
typedef struct impact {
    mpm_world world;
    mpm_material material;
    mpm_bond bond;
    mpm_real dt;          /* us */
    long steps;
    mpm_totals start;
} impact;

enum { IMPACT_PARTICLE = 0, IMPACT_SUBSTRATE = 1 };

/* Looks a word up in a list "one|two|three". Returns its place, or -1. */
static inline int impact_word(const char *list, const char *word)
{
    size_t n = strlen(word);
    int place = 0;
    while (*list) {
        const char *end = strchr(list, '|');
        size_t m = end ? (size_t)(end - list) : strlen(list);
        if (m == n && !strncmp(list, word, n)) return place;
        place++;
        list += m + (end ? 1 : 0);
    }
    return -1;
}

/* One check of the description: on failure writes a message naming option and value. */
static inline int impact_wants(int ok, const char *option, double value, const char *rule, char *message, size_t n)
{
    char text[32];
    if (ok) return 1;
    mpm_io_number_text(text, sizeof text, value);
    snprintf(message, n, "--%s %s: %s", option, text, rule);
    return 0;
}

static inline int impact_knows(const char *list, const char *option, const char *word, char *message, size_t n)
{
    if (impact_word(list, word) >= 0) return 1;
    snprintf(message, n, "--%s %s: not one of %s", option, word, list);
    return 0;
}

/* Checks what the library cannot know. Returns 1, or 0 with a message. */
static inline int impact_check(const impact_case *c, char *m, size_t n)
{
    const double big = 1e6;
    return impact_wants(c->diameter > 0 && c->diameter < big, "diameter", c->diameter, "must be > 0 um", m, n) &&
           impact_wants(c->velocity > -1e5 && c->velocity < 1e5, "velocity", c->velocity, "must be finite", m, n) &&
           impact_wants(c->cell > 0 && c->cell < big, "cell", c->cell, "must be > 0 um", m, n) &&
           impact_wants(c->spacing > 0, "spacing", c->spacing, "must be > 0 um", m, n) &&
           impact_wants(c->spacing <= c->cell, "spacing", c->spacing, "must not be larger than the cell", m, n) &&
           impact_wants(c->spacing * 1000 > c->diameter, "spacing", c->spacing, "too fine for the diameter", m, n) &&
           impact_wants(c->spacing <= c->diameter / 2, "spacing", c->spacing, "too coarse for the diameter", m, n) &&
           impact_wants(c->substrate_diameter > 0 && c->substrate_diameter < big, "substrate-diameter",
                        c->substrate_diameter, "must be > 0 um", m, n) &&
           impact_wants(c->substrate_height > 0 && c->substrate_height < big, "substrate-height",
                        c->substrate_height, "must be > 0 um", m, n) &&
           impact_wants(c->time > 0 && c->time < 1e9, "time", c->time, "must be > 0 ns", m, n) &&
           impact_wants(c->dt_factor > 0 && c->dt_factor <= 1, "dt-factor", c->dt_factor, "must be in (0, 1]", m, n) &&
           impact_wants(c->gc > 0 && c->gc < 1e30, "gc", c->gc, "must be > 0 J/m2", m, n) &&
           impact_wants(c->gdot > 0 && c->gdot < 1e30, "gdot", c->gdot, "must be > 0 J/m2/us", m, n) &&
           impact_wants(c->floor > 0 && c->floor < 1e30, "floor", c->floor, "must be > 0", m, n) &&
           impact_wants(c->friction >= 0 && c->friction < 1e30, "friction", c->friction, "must be >= 0", m, n) &&
           impact_wants(c->gap > -big && c->gap < big, "gap", c->gap, "must be finite", m, n) &&
           impact_wants(c->margin > -big && c->margin < big, "margin", c->margin, "must be finite", m, n) &&
           impact_wants(c->offset > -big && c->offset < big, "grid-offset", c->offset, "must be finite", m, n) &&
           impact_knows("energy|none", "bond", c->bond, m, n) &&
           impact_knows("quarter|full", "symmetry", c->symmetry, m, n) &&
           impact_knows("3d|axisymmetric", "geometry", c->geometry, m, n) &&
           impact_knows("linear|gimp", "functions", c->functions, m, n) &&
           impact_knows("ranked|mvg|average|vertical", "normal", c->normal, m, n) &&
           impact_knows("consistent|staged", "plasticity", c->plasticity, m, n);
}

/* The grid: planes through the interface z = 0 (shifted by offset), reaching `margin` beyond the
   bodies on the free sides, where ejected material flies. */
static inline mpm_desc impact_grid(const impact_case *c)
{
    const double margin = c->margin * c->diameter;
    const double radius = (c->substrate_diameter > c->diameter ? c->substrate_diameter : c->diameter) / 2 + margin;
    const double shift = c->offset - c->cell * floor(c->offset / c->cell);
    const int32_t side = (int32_t)ceil(radius / c->cell - 1e-9);
    const int32_t below = (int32_t)ceil((c->substrate_height + shift) / c->cell - 1e-9) + (margin > 0 ? 3 : 0);
    const int32_t above = (int32_t)ceil((c->diameter + c->gap + margin - shift) / c->cell - 1e-9);
    const int full = !strcmp(c->symmetry, "full") && strcmp(c->geometry, "axisymmetric") != 0;
    mpm_desc d = mpm_desc_default();
    int a;
    d.geometry = strcmp(c->geometry, "axisymmetric") ? MPM_3D : MPM_AXISYMMETRIC;
    d.shape = strcmp(c->functions, "gimp") ? MPM_LINEAR : MPM_GIMP;
    d.cell = (mpm_real)c->cell;
    for (a = 0; a < 2; a++) {
        d.cells[a] = full ? 2 * side : side;
        d.origin[a] = full ? (mpm_real)(-side * c->cell) : 0;
        d.side[2 * a] = full ? MPM_SIDE_OPEN : MPM_SIDE_SYMMETRY;
    }
    d.cells[2] = above + below;
    d.origin[2] = (mpm_real)(shift - below * c->cell);
    d.friction = (mpm_real)c->friction;
    d.normal = (mpm_normal_rule)impact_word("ranked|mvg|average|vertical", c->normal);
    d.bodies = 2;
    return d;
}

/* Builds the scene. Returns 1, or 0 with a message; then nothing is left to free. */
static inline int impact_begin(impact *s, const impact_case *c, char *message, size_t n)
{
    const mpm_units units = mpm_units_um_us_ng();
    mpm_desc d;
    mpm_body_desc particle = mpm_body_desc_default(), substrate;
    mpm_fault fault;
    mpm_status status;
    memset(s, 0, sizeof *s);
    if (!impact_check(c, message, n)) return 0;
    status = mpm_material_preset(&s->material, c->material, &units, &fault);
    if (status != MPM_OK) {
        snprintf(message, n, "--material %s: %s", c->material, mpm_io_status_text(status));
        return 0;
    }
    if (!strcmp(c->plasticity, "staged")) s->material.mapping = MPM_RETURN_STAGED;
    s->bond = mpm_bond_default(&units);
    s->bond.rule = strcmp(c->bond, "none") ? MPM_BOND_ENERGY : MPM_BOND_NONE;
    s->bond.critical = (mpm_real)c->gc;
    s->bond.critical_rate = (mpm_real)c->gdot;
    s->bond.floor = (mpm_real)c->floor;

    particle.spacing = (mpm_real)c->spacing;
    particle.density = s->material.density;
    particle.temperature = s->material.temperature;
    particle.stress = mpm_material_stress;
    particle.material = &s->material;
    mpm_material_wave_speeds(&s->material, s->material.density, &particle.wave_p, &particle.wave_s);
    substrate = particle;
    particle.shape = mpm_sphere(0, 0, (mpm_real)(c->gap + c->diameter / 2), (mpm_real)(c->diameter / 2));
    particle.velocity[2] = (mpm_real)-c->velocity;
    substrate.shape = mpm_cylinder(0, 0, (mpm_real)-c->substrate_height, (mpm_real)(c->substrate_diameter / 2),
                                   (mpm_real)c->substrate_height);
    substrate.absorb = MPM_BOTTOM | MPM_SIDES;

    d = impact_grid(c);
    d.points = mpm_shape_count(&d, &particle.shape, particle.spacing) +
               mpm_shape_count(&d, &substrate.shape, substrate.spacing);
    status = mpm_init(&s->world, &d, NULL, 0);
    if (status == MPM_OK) status = mpm_body_add(&s->world, &particle);
    if (status == MPM_OK) status = mpm_body_add(&s->world, &substrate); /* last: it leads the normals */
    if (status != MPM_OK) {
        mpm_io_fault_text(message, n, &s->world.fault);
        mpm_free(&s->world);
        return 0;
    }
    s->dt = (mpm_real)(c->dt_factor * 0.5) / particle.wave_p;
    s->steps = (long)ceil(c->time * 1e-3 / (double)s->dt - 1e-9);
    s->start = mpm_body_totals(&s->world, -1);
    return 1;
}

/* What came out. */
typedef struct impact_result {
    mpm_bond_measure bond;
    mpm_rebound rebound;
    mpm_totals particle, substrate, all;
    double restitution;                                /* filtered rebound / impact velocity */
    double substrate_drift;                            /* mean v_z of the substrate */
    double flattening;                                 /* 1 - height / diameter */
    double mass_error, momentum_error, energy_error;   /* relative; energy: kinetic + internal + absorbed */
    double energy_unaccounted;                         /* the same with contact and bond losses */
} impact_result;

static inline impact_result impact_measure(const impact *s, const impact_case *c)
{
    const mpm_world *w = &s->world;
    const mpm_ledger *l = &w->ledger;
    impact_result r;
    double energy, momentum = fabs(s->start.momentum[2]);
    r.bond = mpm_bond_measure_body(w, -1);
    r.rebound = mpm_restitution(w, IMPACT_PARTICLE, 60);
    r.particle = mpm_body_totals(w, IMPACT_PARTICLE);
    r.substrate = mpm_body_totals(w, IMPACT_SUBSTRATE);
    r.all = mpm_body_totals(w, -1);
    r.restitution = fabs(c->velocity) > 0 ? r.rebound.filtered / fabs(c->velocity) : 0;
    r.substrate_drift = r.substrate.momentum[2] / r.substrate.mass;
    r.flattening = 1 - (r.particle.high[2] - r.particle.low[2] + c->spacing) / c->diameter;
    energy = s->start.kinetic + s->start.internal;
    r.mass_error = (r.all.mass - s->start.mass) / s->start.mass;
    r.momentum_error = (r.all.momentum[2] - s->start.momentum[2] - l->impulse[2]) / (momentum > 0 ? momentum : 1);
    r.energy_error = (r.all.kinetic + r.all.internal + l->absorbed - energy) / (energy > 0 ? energy : 1);
    r.energy_unaccounted = r.energy_error + (l->contact + l->bond + l->walls) / (energy > 0 ? energy : 1);
    return r;
}

#endif
