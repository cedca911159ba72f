/* impact_case.h - one particle on one substrate: the scene that the impact examples share.
   Describes it in um, m/s and ns, builds it in um, us and ng, and measures what came out.
   SPDX-License-Identifier: MIT */
#ifndef IMPACT_CASE_H
#define IMPACT_CASE_H

#include "case.h"
#include "mpm.h"
#include "mpm_ptw.h"
#include "mpm_bond.h"
#include "mpm_measure.h"
#include "mpm_surface.h"

/* The words of an option; of others the lists are the library's. */
#define IMPACT_SHAPES "sphere|ellipsoid"
#define IMPACT_MODELS "preset" MPM_STRENGTH_LIST(CASE_BAR)
#define IMPACT_SYMMETRIES "full|half|quarter"
#define IMPACT_GEOMETRIES "3d|axisymmetric"
#define IMPACT_CONTACTS "nodes|surface"
#define IMPACT_METHODS "thesis|surface"
#define IMPACT_BONDS "interface" MPM_BOND_RULE_LIST(CASE_BAR)

/* What to run. Every member is an option of examples/impact; the defaults are its main job. */
typedef struct impact_case {
    double diameter, velocity;                     /* um (of the sphere of equal volume), m/s */
    double angle;                                  /* degrees between velocity and surface normal; towards +x */
    double aspect;                                 /* of an ellipsoid: height along z over width */
    double temperature, substrate_temperature;     /* K, at the start; 0: substrate as particle */
    double cell, spacing;                          /* um */
    double substrate_diameter, substrate_height;   /* um */
    double time, dt_factor;                        /* ns; of the critical step of a 0.5 um cell */
    double calm;                                   /* ns in which what the grid does not see dies out; 0: never */
    double gc, gdot, floor;                        /* energy bond: J/m2, J/m2/us, 1 */
    double bond_length, bond_width;                /* its length, um (0: the cell); D from free to held */
    double eps_c, epsdot_c;                        /* strain bond: 1, 1/us */
    double shell;                                  /* thickness of the surface that contacts and bonds, spacings */
    double friction;
    int touch;                                     /* 1: bodies touch where their points do */
    int springs;                                   /* 1: the substrate's dampers have springs beside them */
    double surface_damping;                        /* of contact on surfaces, rho c */
    double adhesion, adhesion_critical;            /* bond of the interface: W0, G_c, J/m2 */
    double adhesion_depth, adhesion_reach;         /* its layer's depth, how far it is drawn open, um */
    double gap, offset;                            /* um: start distance; shift of the grid */
    double margin;                                 /* free grid around the bodies, particle diameters */
    const char *method;                            /* whose defaults these are */
    const char *shape, *material, *substrate_material, *model; /* "": substrate as particle */
    const char *bond, *bond_average, *symmetry, *geometry, *functions, *plasticity, *normal, *scheme,
        *contact;
} impact_case;

static inline impact_case impact_case_default(void)
{
    impact_case c;
    memset(&c, 0, sizeof c);
    c.diameter = 14;
    c.velocity = 810;
    c.aspect = 1;
    c.temperature = 298;
    c.cell = 1.5;
    c.spacing = 0.5;
    c.substrate_diameter = 30;
    c.substrate_height = 10;
    c.time = 80;
    c.dt_factor = 0.1;
    c.gc = 1503.74;
    c.gdot = 2.271e5;
    c.floor = 0.05;
    c.eps_c = 1.9;       /* A, section 5.3.1 */
    c.epsdot_c = 1350;
    c.shell = 1;
    c.margin = 1;
    c.method = "thesis";
    c.shape = "sphere";
    c.material = "al";
    c.substrate_material = "";
    c.model = "preset";
    c.bond = "energy";
    c.bond_average = "mean";
    c.symmetry = "quarter";
    c.geometry = "3d";
    c.functions = "linear";
    c.plasticity = "consistent";
    c.normal = "ranked";
    c.scheme = "thesis";
    c.contact = "nodes";
    c.surface_damping = 1;
    c.adhesion = 37; /* calibrated on 14 and 30 um alone: docs/prediction.md */
    c.adhesion_critical = 1640;
    c.adhesion_depth = 1.5;
    c.adhesion_reach = 0.2;
    return c;
}

/* The case of predictions: contact and bond on surfaces, splines, a half space, axisymmetric (docs/prediction.md). What
   is 0 goes by the particle's size, see impact_complete. */
static inline impact_case impact_case_surface(void)
{
    impact_case c = impact_case_default();
    c.method = c.contact = "surface";
    c.bond = "interface";
    c.geometry = "axisymmetric";
    c.functions = "cubic";
    c.scheme = "consistent";
    c.springs = 1;
    c.cell = c.spacing = c.substrate_diameter = c.substrate_height = c.time = c.dt_factor = 0;
    return c;
}

/* The method that a command line asks for: it sets the defaults of the other options. */
static inline const char *impact_method(int argc, char **argv, const char *usual)
{
    int a;
    for (a = 1; a + 1 < argc; a++)
        if (!strcmp(argv[a], "--method")) usual = argv[a + 1];
    return usual;
}

/* With method surface, what is 0: 28 cells in a diameter, points a quarter of a cell apart, a substrate of 2.5 by 1.25
   diameters, 60 ns at 14 um and in proportion, steps of 0.2 of the critical one, a gap of 0.02 diameters. */
static inline void impact_complete(impact_case *c)
{
    if (strcmp(c->method, "surface")) return;
    if (!(fabs(c->cell) > 0)) c->cell = c->diameter / 28;
    if (!(fabs(c->spacing) > 0)) c->spacing = c->cell / 4;
    if (!(fabs(c->substrate_diameter) > 0)) c->substrate_diameter = 2.5 * c->diameter;
    if (!(fabs(c->substrate_height) > 0)) c->substrate_height = 1.25 * c->diameter;
    if (!(fabs(c->time) > 0)) c->time = 60 * c->diameter / 14;
    if (!(fabs(c->dt_factor) > 0)) c->dt_factor = 0.2 * c->cell / 0.5;
    if (!(fabs(c->gap) > 0)) c->gap = 0.02 * c->diameter;
}

enum { IMPACT_PARTICLE = 0, IMPACT_SUBSTRATE = 1 };

/* A case being run: the world in um, us, ng, whose stress is MPa and velocity m/s. */
typedef struct impact {
    mpm_world world;
    mpm_material material[2]; /* of particle and substrate */
    mpm_bond bond;
    mpm_surfaces surfaces; /* with contact on surfaces; else none */
    mpm_real dt;          /* us */
    int64_t steps;
    mpm_totals start;
} impact;

/* Options that contradict each other. */
static inline int impact_agrees(const impact_case *c, char *m, size_t n)
{
    const int round_ball = !strcmp(c->shape, "sphere");
    const int surface = !strcmp(c->contact, "surface"), interface = !strcmp(c->bond, "interface");
    if (round_ball && (c->aspect < 1 || c->aspect > 1))
        return case_wants(0, "aspect", c->aspect, "a sphere has none: add --shape ellipsoid", m, n);
    if (surface && strcmp(c->bond, "none") && !interface) {
        snprintf(m, n, "--contact surface has a bond of its own: add --bond interface (or none)");
        return 0;
    }
    if (interface && !surface) {
        snprintf(m, n, "--bond interface is one of surfaces: add --contact surface");
        return 0;
    }
    if (!(fabs(c->angle) > 0)) return 1;
    if (!strcmp(c->geometry, "axisymmetric"))
        return case_wants(0, "angle", c->angle, "an oblique impact is not axisymmetric", m, n);
    return case_wants(strcmp(c->symmetry, "quarter") != 0, "angle", c->angle,
                        "an oblique impact has one mirror plane: add --symmetry half (or full)", m, n);
}

/* Half axes of the particle across and along z, um: the volume is that of the sphere. */
static inline double impact_half_width(const impact_case *c) { return c->diameter / 2 / cbrt(c->aspect); }
static inline double impact_half_height(const impact_case *c) { return impact_half_width(c) * c->aspect; }

/* Whether the whole model's grid and points can be counted. */
static inline int impact_fits(const impact_case *c, char *m, size_t n)
{
    const int rings = !strcmp(c->geometry, "axisymmetric");
    const double margin = fabs(c->margin) * c->diameter, high = 2 * impact_half_height(c);
    const double wide = fmax(c->substrate_diameter, 2 * impact_half_width(c));
    const double across = (wide + 2 * margin) / c->cell + 8, row = wide / c->spacing + 1;
    const double tall = (c->substrate_height + high + fabs(c->gap) + margin) / c->cell + 8;
    const double layers = fmax(c->substrate_height, high) / c->spacing + 1;
    return case_wants((rings ? 1 : across) * across * tall < 2e9, "cell", c->cell,
                        "makes a grid of more than 2e9 cells", m, n) &&
           case_wants((rings ? 1 : row) * row * layers < 1e9, "spacing", c->spacing,
                        "makes more than 1e9 points", m, n);
}

/* Checks what the library cannot know. Returns 1, or 0 with a message. */
static inline int impact_check(const impact_case *c, char *m, size_t n)
{
    const double big = 1e6;
    return case_wants(c->diameter > 0 && c->diameter < big, "diameter", c->diameter, "must be in (0, 1e6) um", m, n) &&
           case_wants(c->velocity > -1e5 && c->velocity < 1e5, "velocity", c->velocity, "must be within 1e5 m/s",
                        m, n) &&
           case_wants(c->angle > -90 && c->angle < 90, "angle", c->angle, "must be in (-90, 90) degrees", m, n) &&
           case_wants(c->aspect >= 0.1 && c->aspect <= 10, "aspect", c->aspect, "must be 0.1 .. 10", m, n) &&
           case_wants(c->temperature > 0 && c->temperature < 1e5, "temperature", c->temperature,
                        "must be > 0 K", m, n) &&
           case_wants(c->substrate_temperature >= 0 && c->substrate_temperature < 1e5, "substrate-temperature",
                        c->substrate_temperature, "must be > 0 K, or 0 for that of the particle", m, n) &&
           case_wants(c->cell > 0 && c->cell < big, "cell", c->cell, "must be in (0, 1e6) um", m, n) &&
           case_wants(c->spacing > 0, "spacing", c->spacing, "must be > 0 um", m, n) &&
           case_wants(c->spacing <= c->cell, "spacing", c->spacing, "must not be larger than the cell", m, n) &&
           case_wants(c->spacing * 1000 > c->diameter, "spacing", c->spacing, "too fine for the diameter", m, n) &&
           case_wants(c->spacing <= c->diameter / 2, "spacing", c->spacing, "too coarse for the diameter", m, n) &&
           case_wants(c->substrate_diameter > 0 && c->substrate_diameter < big, "substrate-diameter",
                        c->substrate_diameter, "must be in (0, 1e6) um", m, n) &&
           case_wants(c->substrate_height > 0 && c->substrate_height < big, "substrate-height",
                        c->substrate_height, "must be in (0, 1e6) um", m, n) &&
           case_wants(c->time > 0 && c->time < 1e9, "time", c->time, "must be > 0 ns", m, n) &&
           case_wants(c->dt_factor > 0 && c->dt_factor <= 1, "dt-factor", c->dt_factor, "must be in (0, 1]", m, n) &&
           case_wants(c->calm >= 0 && c->calm < 1e9, "calm", c->calm, "must be > 0 ns, or 0 for never", m, n) &&
           case_wants(c->gc > 0 && c->gc < 1e30, "gc", c->gc, "must be > 0 J/m2", m, n) &&
           case_wants(c->gdot > 0 && c->gdot < 1e30, "gdot", c->gdot, "must be > 0 J/m2/us", m, n) &&
           case_wants(c->floor > 0 && c->floor < 1e30, "floor", c->floor, "must be > 0", m, n) &&
           case_wants(c->bond_length >= 0 && c->bond_length < big, "bond-length", c->bond_length,
                        "must be > 0 um, or 0 for the cell", m, n) &&
           case_wants(c->bond_width >= 0 && c->bond_width <= 2, "bond-width", c->bond_width, "must be 0 .. 2", m, n) &&
           case_wants(c->eps_c > 0 && c->eps_c < 1e30, "eps-c", c->eps_c, "must be > 0", m, n) &&
           case_wants(c->epsdot_c > 0 && c->epsdot_c < 1e30, "epsdot-c", c->epsdot_c, "must be > 0 per us", m, n) &&
           case_wants(c->shell > 0 && c->shell < big, "shell", c->shell, "must be > 0 spacings", m, n) &&
           case_wants(c->friction >= 0 && c->friction < 1e30, "friction", c->friction, "must be >= 0", m, n) &&
           case_wants(c->gap > -big && c->gap < big, "gap", c->gap, "must be within 1e6 um", m, n) &&
           case_wants(c->margin > -big && c->margin < big, "margin", c->margin, "must be within 1e6", m, n) &&
           case_wants(c->offset > -big && c->offset < big, "grid-offset", c->offset, "must be within 1e6 um", m, n) &&
           case_knows(IMPACT_SHAPES, "shape", c->shape, m, n) &&
           case_knows(IMPACT_MODELS, "model", c->model, m, n) &&
           case_wants(c->adhesion > 0 && c->adhesion < 1e30, "adhesion", c->adhesion, "must be > 0 J/m2", m, n) &&
           case_wants(c->adhesion_critical > 0 && c->adhesion_critical < 1e30, "adhesion-critical",
                        c->adhesion_critical, "must be > 0 J/m2", m, n) &&
           case_wants(c->adhesion_depth > 0 && c->adhesion_depth < big, "adhesion-depth", c->adhesion_depth,
                        "must be in (0, 1e6) um", m, n) &&
           case_wants(c->adhesion_reach > 0 && c->adhesion_reach < big, "adhesion-reach", c->adhesion_reach,
                        "must be in (0, 1e6) um", m, n) &&
           case_knows(IMPACT_BONDS, "bond", c->bond, m, n) &&
           case_knows(MPM_NAMES(MPM_BOND_AVERAGE_LIST), "bond-average", c->bond_average, m, n) &&
           case_knows(IMPACT_SYMMETRIES, "symmetry", c->symmetry, m, n) &&
           case_knows(IMPACT_GEOMETRIES, "geometry", c->geometry, m, n) &&
           case_knows(MPM_NAMES(MPM_BASIS_LIST), "functions", c->functions, m, n) &&
           case_knows(MPM_NAMES(MPM_NORMAL_LIST), "normal", c->normal, m, n) &&
           case_knows(MPM_NAMES(MPM_SCHEME_LIST), "scheme", c->scheme, m, n) &&
           case_knows(IMPACT_METHODS, "method", c->method, m, n) &&
           case_knows(IMPACT_CONTACTS, "contact", c->contact, m, n) &&
           case_wants(c->surface_damping >= 0 && c->surface_damping < 1e6, "surface-damping", c->surface_damping,
                        "must be 0 .. 1e6", m, n) &&
           case_knows(MPM_NAMES(MPM_RETURN_LIST), "plasticity", c->plasticity, m, n) && impact_fits(c, m, n) &&
           impact_agrees(c, m, n);
}

/* The grid: planes through the interface z = 0 (shifted by offset), reaching `margin` beyond the
   bodies on the free sides, where ejected material flies. */
static inline mpm_desc impact_grid(const impact_case *c)
{
    const double margin = c->margin * c->diameter, width = 2 * impact_half_width(c);
    const double radius = (c->substrate_diameter > width ? c->substrate_diameter : width) / 2 + margin;
    const double shift = c->offset - c->cell * floor(c->offset / c->cell);
    const int32_t side = (int32_t)ceil(radius / c->cell - 1e-9);
    const int32_t below = (int32_t)ceil((c->substrate_height + shift) / c->cell - 1e-9) + (margin > 0 ? 3 : 0);
    const int32_t above = (int32_t)ceil((2 * impact_half_height(c) + c->gap + margin - shift) / c->cell - 1e-9);
    const int rings = !strcmp(c->geometry, "axisymmetric");
    const int mirrors = word_place(IMPACT_SYMMETRIES, c->symmetry); /* y = 0, then x = 0 too */
    mpm_desc d = mpm_desc_default();
    int a;
    d.geometry = (mpm_geometry)word_place(MPM_NAMES(MPM_GEOMETRY_LIST), c->geometry);
    d.basis = (mpm_basis)word_place(MPM_NAMES(MPM_BASIS_LIST), c->functions);
    d.cell = (mpm_real)c->cell;
    for (a = 0; a < 2; a++) {
        const int whole = !rings && mirrors < 2 - a;
        d.cells[a] = whole ? 2 * side : side;
        d.origin[a] = whole ? (mpm_real)(-side * c->cell) : 0;
        d.side[2 * a] = whole ? MPM_SIDE_OPEN : MPM_SIDE_SYMMETRY;
    }
    d.cells[2] = above + below;
    d.origin[2] = (mpm_real)(shift - below * c->cell);
    d.contact.friction = (mpm_real)c->friction;
    d.contact.touch = c->touch;
    d.contact.normal = (mpm_normal_rule)word_place(MPM_NAMES(MPM_NORMAL_LIST), c->normal);
    d.scheme = (mpm_scheme)word_place(MPM_NAMES(MPM_SCHEME_LIST), c->scheme);
    d.calm = (mpm_real)(c->calm * 1e-3);
    return d;
}

/* The material of a body at its temperature. Heating softens; density and pressure start as at 298 K, and it melts
   at the same point as metal that was heated from there. Returns 1, or 0 with a message. */
static inline int impact_metal(mpm_material *m, const impact_case *c, int body, char *message, size_t n)
{
    const mpm_units units = mpm_units_um_us_ng();
    const int other = body == IMPACT_SUBSTRATE && *c->substrate_material;
    const char *name = other ? c->substrate_material : c->material;
    const double kelvin = body == IMPACT_SUBSTRATE && c->substrate_temperature > 0 ? c->substrate_temperature
                                                                                   : c->temperature;
    mpm_status status = mpm_material_preset(m, name, &units, NULL);
    if (status != MPM_OK) {
        snprintf(message, n, "--%smaterial %s: %s (build/material --list shows them)", other ? "substrate-" : "", name,
                 mpm_status_text(status));
        return 0;
    }
    if (strcmp(c->model, "preset") && mpm_material_model(m, c->model, NULL) != MPM_OK) {
        snprintf(message, n, "--model %s: %s has no published set for it", c->model, name);
        return 0;
    }
    m->mapping = (mpm_return_mapping)word_place(MPM_NAMES(MPM_RETURN_LIST), c->plasticity);
    case_heat(m, kelvin);
    return 1;
}

static inline mpm_bond impact_bond(const impact_case *c)
{
    const mpm_units units = mpm_units_um_us_ng();
    mpm_bond b = mpm_bond_default(&units);
    b.rule = MPM_BOND_NONE; /* one of the interface is the surfaces' */
    if (strcmp(c->bond, "interface")) b.rule = (mpm_bond_rule)word_place(MPM_NAMES(MPM_BOND_RULE_LIST), c->bond);
    b.average = (mpm_bond_average)word_place(MPM_NAMES(MPM_BOND_AVERAGE_LIST), c->bond_average);
    b.critical = (mpm_real)(b.rule == MPM_BOND_STRAIN ? c->eps_c : c->gc);
    b.critical_rate = (mpm_real)(b.rule == MPM_BOND_STRAIN ? c->epsdot_c : c->gdot);
    b.floor = (mpm_real)c->floor;
    b.length = (mpm_real)c->bond_length;
    b.width = (mpm_real)c->bond_width;
    return b;
}

/* Particle (its centre is left to be set) or substrate as a body of its material. */
static inline mpm_body_desc impact_body(mpm_material *m, const impact_case *c, int body)
{
    const double radians = c->angle * (double)MPM_PI / 180;
    const double a = impact_half_width(c), h = impact_half_height(c);
    mpm_body_desc b = mpm_body_desc_default();
    b.spacing = (mpm_real)c->spacing;
    b.shell = (mpm_real)c->shell;
    b.density = m->density;
    b.temperature = m->temperature;
    b.stress = mpm_material_stress;
    b.material = m;
    mpm_material_wave_speeds(m, m->density, &b.wave_p, &b.wave_s);
    if (body == IMPACT_PARTICLE) {
        b.shape = mpm_ellipsoid(0, 0, 0, (mpm_real)a, (mpm_real)a, (mpm_real)h);
        b.velocity[0] = (mpm_real)(c->velocity * sin(radians));
        b.velocity[2] = (mpm_real)(-c->velocity * cos(radians));
    } else {
        b.shape = mpm_cylinder(0, 0, (mpm_real)-c->substrate_height, (mpm_real)(c->substrate_diameter / 2),
                               (mpm_real)c->substrate_height);
        b.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
        b.absorb_spring = (mpm_real)c->springs;
    }
    return b;
}

/* Outlines for all bodies, where they are to meet by them. Returns 1, or 0 with a message; then nothing is left. */
static inline int impact_surfaces(impact *s, const impact_case *c, char *message, size_t n)
{
    int32_t b;
    s->surfaces = mpm_surfaces_default();
    s->surfaces.damping = (mpm_real)c->surface_damping;
    s->surfaces.friction = (mpm_real)c->friction;
    s->surfaces.adhesion = (mpm_real)(strcmp(c->bond, "interface") ? 0 : c->adhesion);
    s->surfaces.critical = (mpm_real)c->adhesion_critical;
    s->surfaces.depth = (mpm_real)c->adhesion_depth;
    s->surfaces.reach = (mpm_real)c->adhesion_reach;
    for (b = 0; b < s->world.bodies && !strcmp(c->contact, "surface"); b++)
        if (mpm_surface_add(&s->surfaces, &s->world, b) != MPM_OK) {
            mpm_io_fault_text(message, n, &s->surfaces.fault);
            mpm_surfaces_free(&s->surfaces);
            mpm_free(&s->world);
            return 0;
        }
    return 1;
}

/* Builds `count` particles at these centres (um) and the substrate, as the last body, in the grid d. Returns 1, or 0
   with a message; then nothing is left to free. */
static inline int impact_build(impact *s, const impact_case *c, mpm_desc d, const double (*center)[3], int64_t count,
                               char *message, size_t n)
{
    mpm_body_desc particle, substrate;
    mpm_status status;
    double steps;
    int64_t k;
    int a;
    for (a = 0; a < 2; a++)
        if (!impact_metal(&s->material[a], c, a, message, n)) return 0;
    particle = impact_body(&s->material[IMPACT_PARTICLE], c, IMPACT_PARTICLE);
    substrate = impact_body(&s->material[IMPACT_SUBSTRATE], c, IMPACT_SUBSTRATE);
    status = mpm_init(&s->world, &d, NULL, 0);
    if (status == MPM_OK && !strcmp(c->plasticity, "staged")) {
        const int field = mpm_field_take(&s->world, "flow stress");
        for (a = 0; a < 2; a++) s->material[a].flow_field = field;
        if (field < 0) status = s->world.fault.status;
    }
    for (k = 0; k < count && status == MPM_OK; k++) {
        for (a = 0; a < 3; a++) particle.shape.center[a] = (mpm_real)center[k][a];
        status = mpm_body_add(&s->world, &particle);
    }
    if (status == MPM_OK) status = mpm_body_add(&s->world, &substrate); /* the last leads the normals */
    if (status != MPM_OK) {
        mpm_io_fault_text(message, n, &s->world.fault);
        mpm_free(&s->world);
        return 0;
    }
    s->bond = impact_bond(c);
    s->dt = (mpm_real)(c->dt_factor * 0.5) / (particle.wave_p > substrate.wave_p ? particle.wave_p : substrate.wave_p);
    steps = ceil(c->time * 1e-3 / (double)s->dt - 1e-9); /* dt may be 0 or tiny: then this is huge, or infinite */
    if (!case_wants(steps < 1e9, "dt-factor", c->dt_factor, "makes more than 1e9 steps", message, n)) {
        mpm_free(&s->world);
        return 0;
    }
    s->steps = (int64_t)steps;
    s->start = mpm_body_totals(&s->world, -1);
    return impact_surfaces(s, c, message, n);
}

/* Gives back what a run that began holds. */
static inline void impact_end(impact *s)
{
    mpm_surfaces_free(&s->surfaces);
    mpm_free(&s->world);
}

/* Builds the scene. Returns 1, or 0 with a message; then nothing is left to free. The world points
   into *s: do not copy or move it. */
static inline int impact_begin(impact *s, const impact_case *c, char *message, size_t n)
{
    const double center[1][3] = {{0, 0, c->gap + impact_half_height(c)}};
    memset(s, 0, sizeof *s);
    return impact_check(c, message, n) && impact_build(s, c, impact_grid(c), center, 1, message, n);
}

/* One whole step with bonding: the loop of examples/impact.c for programs that need not show it.
   Returns MPM_OK, MPM_RETIRED, or an error with world.fault. */
static inline mpm_status impact_step(impact *s)
{
    if (s->surfaces.surfaces > 0) return mpm_surface_step(&s->surfaces, &s->world, s->dt);
    return mpm_bond_step(&s->bond, &s->world, s->dt);
}

/* What came out. Velocities are along z (m/s), lengths in um; areas are those of the whole particle. */
typedef struct impact_result {
    mpm_bond_measure bond, particle_bond;              /* of both bodies; of the particle alone. With contact on
                                                          surfaces pbcp alone: bonded share of what touched, by area */
    mpm_rebound rebound;
    mpm_totals particle, substrate, all;
    double restitution;                                /* filtered rebound / impact speed */
    double substrate_drift;                            /* mean v_z of the substrate */
    double relative, filtered_relative;                /* rebound less that drift; filtered as seen from the ground,
                                                          as source A does: mpm_rebound_from filters in its frame */
    double tangential;                                 /* mean v_x of the particle */
    double quiet_velocity, quiet_pressure;             /* share of its points within 5 m/s of its mean velocity; within
                                                          0.5 GPa of no pressure */
    double flattening;                                 /* see mpm_splat; of the points within 60 m/s of the mean:
                                                          ejected ones fly far */
    double crater;                                     /* see mpm_splat */
    double contact_area, bonded_area;                  /* of the whole particle: see mpm_bond_measure */
    mpm_meeting meeting;                               /* of contact on surfaces */
    double fast_fraction;                              /* of the particle's mass, faster than 60 m/s */
    mpm_pieces pieces;                                 /* of the particle: what has left it */
    double ejected_fraction;                           /* of its mass */
    double mass_error, momentum_error, energy_error;   /* relative; energy: kinetic + internal + absorbed */
    double energy_unaccounted;                         /* the same with contact and bond losses */
} impact_result;

/* Of how many copies of the model the whole consists: mirror planes at the axis. */
static inline int impact_copies(const impact *s)
{
    const mpm_side *side = s->world.desc.side;
    if (s->world.desc.geometry != MPM_3D) return 1;
    return (side[0] == MPM_SIDE_SYMMETRY ? 2 : 1) * (side[2] == MPM_SIDE_SYMMETRY ? 2 : 1);
}

/* How quiet the particle is. */
static inline void impact_quiet(const mpm_world *w, impact_result *r)
{
    const mpm_points *q = &w->points;
    const mpm_body *b = &w->body[IMPACT_PARTICLE];
    int32_t i, slow = 0, free_of = 0;
    int a;
    for (i = b->first; i < b->first + b->active; i++) {
        double speed = 0, stress = 0;
        for (a = 0; a < 3; a++) {
            const int mirror = w->desc.side[2 * a] == MPM_SIDE_SYMMETRY;
            const double mean = r->particle.momentum[a] / r->particle.mass;
            speed = hypot(speed, (double)q->v[a][i] - (mirror ? 0 : mean));
            stress += (double)q->stress[a][i];
        }
        slow += speed <= 5;
        free_of += fabs(stress / 3) <= 500;
    }
    r->quiet_velocity = case_share(slow, b->active);
    r->quiet_pressure = case_share(free_of, b->active);
}

static inline impact_result impact_measure(const impact *s, const impact_case *c)
{
    const mpm_world *w = &s->world;
    const mpm_ledger *l = &w->ledger;
    impact_result r;
    double energy, error = 0, momentum = 0;
    int a;
    memset(&r, 0, sizeof r);
    r.bond = mpm_bond_measure_body(w, -1);
    r.particle_bond = mpm_bond_measure_body(w, IMPACT_PARTICLE);
    r.rebound = mpm_rebound_of(w, IMPACT_PARTICLE, 60);
    r.particle = mpm_body_totals(w, IMPACT_PARTICLE);
    r.substrate = mpm_body_totals(w, IMPACT_SUBSTRATE);
    r.all = mpm_body_totals(w, -1);
    r.restitution = case_share(r.rebound.filtered, fabs(c->velocity));
    r.substrate_drift = r.substrate.momentum[2] / r.substrate.mass;
    r.relative = r.rebound.mean - r.substrate_drift;
    r.filtered_relative = r.rebound.filtered - r.substrate_drift;
    r.tangential = w->desc.side[0] == MPM_SIDE_SYMMETRY ? 0 : r.particle.momentum[0] / r.particle.mass;
    impact_quiet(w, &r);
    r.flattening = mpm_splat_measure(w, IMPACT_PARTICLE, IMPACT_SUBSTRATE,
                                     (mpm_real)(60 + fabs(r.rebound.mean))).flattening;
    r.crater = mpm_splat_measure(w, IMPACT_PARTICLE, IMPACT_SUBSTRATE, MPM_R(1e15)).crater; /* deep points move */
    r.contact_area = r.particle_bond.contacted_area * impact_copies(s);
    r.bonded_area = r.particle_bond.bonded_area * impact_copies(s);
    if (s->surfaces.surfaces > 0) {
        r.meeting = mpm_surface_meets(&s->surfaces, w, IMPACT_PARTICLE, IMPACT_SUBSTRATE);
        r.meeting.area *= impact_copies(s);
        r.meeting.touched *= impact_copies(s);
        r.meeting.bonded *= impact_copies(s);
        r.meeting.adhesion *= impact_copies(s);
        r.contact_area = r.meeting.touched > 0 ? r.meeting.touched : r.meeting.area;
        r.bonded_area = r.meeting.bonded;
        r.bond.pbcp = r.particle_bond.pbcp = 100 * case_share(r.meeting.bonded, r.meeting.touched);
    }
    r.fast_fraction = r.rebound.fast_mass / r.particle.mass;
    mpm_pieces_of(w, IMPACT_PARTICLE, &r.pieces); /* without memory: none */
    r.ejected_fraction = r.pieces.mass / r.particle.mass;
    energy = s->start.kinetic + s->start.internal;
    r.mass_error = (r.all.mass - s->start.mass) / s->start.mass;
    for (a = w->desc.geometry == MPM_AXISYMMETRIC ? 2 : 0; a < 3; a++) { /* hoop stress makes radial momentum */
        error = fmax(error, fabs(r.all.momentum[a] - s->start.momentum[a] - l->impulse[a]));
        momentum = hypot(momentum, s->start.momentum[a]);
    }
    r.momentum_error = error / (momentum > 0 ? momentum : 1);
    r.energy_error = (r.all.kinetic + r.all.internal + l->absorbed - energy) / (energy > 0 ? energy : 1);
    r.energy_unaccounted = r.energy_error + (l->contact + l->hold + l->walls) / (energy > 0 ? energy : 1);
    return r;
}

/* Whether the particle stays: it moves with the substrate to 5 m/s, and something holds it. */
static inline int impact_stays(const impact *s, const impact_result *r)
{
    return fabs(r->relative) <= 5 && (s->world.held > 0 || r->meeting.bonded > 0);
}

/* Runs a case to its end and measures. Returns 1, or 0 with a message. */
static inline int impact_run(const impact_case *c, impact_result *r, char *message, size_t n)
{
    mpm_status status = MPM_OK;
    impact s;
    memset(r, 0, sizeof *r);
    if (!impact_begin(&s, c, message, n)) return 0;
    while (status >= 0 && s.world.steps < s.steps) status = impact_step(&s);
    if (status < 0) mpm_io_fault_text(message, n, &s.world.fault);
    else *r = impact_measure(&s, c);
    impact_end(&s);
    return status >= 0;
}

#endif
