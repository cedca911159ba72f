/* bench_impact - how fast, on a job that other codes can run too: a copper sphere, R = 12 mm, hits a copper block of
   30 x 30 x 20 mm at 500 m/s. Nothing is written, so what is timed is the method.

   Cells of 1 mm, points 0.5 mm apart: 57 856 + 144 000 of them. Johnson and Cook's copper (A 90, B 292 MPa, n 0.31, C
   0.025, m 1.09, melting at 1356 K, from 293 K), Mie and Grueneisen's pressure (3940 m/s, 1.489, 1.99), bulk viscosity
   1.5 and 0.06, friction 0.2, 19.6 us. Expect: no momentum lost beyond round-off, 0.2 % of the energy unaccounted for,
   3 to 4 million point-steps per CPU second, of which the law takes more than half. A quarter of a minute.

   The loop in run() is the method, one call per phase. --sweeps takes mpm_step instead, which does the same bits with
   two phases in a sweep over the points. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_ptw.h"
#include "output.h"

#define LAWS "jc|elastic|ptw"

typedef struct settings {
    double radius, width, height, velocity; /* mm, m/s */
    double cell, spacing, margin;           /* mm */
    double friction, time, dt_factor;       /* 1, us, 1 */
    const char *law, *functions, *contact;
    int sweeps;
} settings;

static settings settings_default(void)
{
    settings c;
    memset(&c, 0, sizeof c);
    c.radius = 12;
    c.width = 30;
    c.height = 20;
    c.velocity = 500;
    c.cell = 1;
    c.spacing = 0.5;
    c.margin = 6;
    c.friction = 0.2;
    c.time = 19.6;
    c.dt_factor = 0.4;
    c.law = "jc";
    c.functions = "linear";
    c.contact = "friction";
    return c;
}

static int options_of(settings *c, option *o)
{
    int n = 0;
    option_add_word(o, &n, "law", &c->law, LAWS, "strength");
    option_add_word(o, &n, "functions", &c->functions, MPM_NAMES(MPM_BASIS_LIST), "shape functions");
    option_add_word(o, &n, "contact", &c->contact, MPM_NAMES(MPM_CONTACT_LIST), "of the bodies; weld: a single field");
    option_add(o, &n, "friction", OPTION_REAL, &c->friction, "Coulomb coefficient");
    option_add(o, &n, "velocity", OPTION_REAL, &c->velocity, "of the sphere, m/s");
    option_add(o, &n, "cell", OPTION_REAL, &c->cell, "grid cell edge, mm");
    option_add(o, &n, "spacing", OPTION_REAL, &c->spacing, "distance of material points, mm");
    option_add(o, &n, "time", OPTION_REAL, &c->time, "simulated time, us");
    option_add(o, &n, "dt-factor", OPTION_REAL, &c->dt_factor, "time step over the critical step of the cell");
    option_add(o, &n, "sweeps", OPTION_FLAG, &c->sweeps, "two phases in a sweep, by mpm_step: the whole step is timed");
    return n;
}

static int check(const settings *c, char *m, size_t n)
{
    return case_wants(c->friction >= 0 && c->friction < 1e30, "friction", c->friction, "must be >= 0", m, n) &&
           case_wants(c->velocity > 0 && c->velocity < 1e5, "velocity", c->velocity, "must be in (0, 1e5) m/s", m, n) &&
           case_wants(c->cell >= 0.05 && c->cell <= 10, "cell", c->cell, "must be 0.05 .. 10 mm", m, n) &&
           case_wants(c->spacing >= 0.05 && c->spacing <= c->cell, "spacing", c->spacing,
                      "must be 0.05 mm .. the cell", m, n) &&
           case_wants(c->time > 0 && c->time < 1e6, "time", c->time, "must be in (0, 1e6) us", m, n) &&
           case_wants(c->dt_factor > 0 && c->dt_factor <= 1, "dt-factor", c->dt_factor, "must be in (0, 1]", m, n);
}

/* ---- the scene: mm, ms, g; velocity m/s, stress MPa ------------------------------------------ */

/* The copper of the job, with the strength that is asked for. */
static mpm_status copper(mpm_material *m, const char *law, mpm_fault *fault)
{
    const mpm_units units = mpm_units_mm_ms_g();
    const int place = word_place(LAWS, law);
    mpm_status status = mpm_material_preset(m, "cu", &units, fault);
    if (status == MPM_OK && place < 2) status = mpm_material_model(m, "jc", fault);
    if (status != MPM_OK) return status;
    m->density = MPM_R(8.96e-3);
    m->temperature = m->jc.temperature = 293;
    m->gruneisen = MPM_R(1.99); /* c0 3940 m/s and s 1.489 are the preset's */
    m->eos = MPM_EOS_MIE_GRUENEISEN;
    m->viscosity_quadratic = MPM_R(1.5);
    m->viscosity_linear = MPM_R(0.06);
    if (place < 2) {
        m->young = 124000;
        m->poisson = MPM_R(0.34);
        m->shear_modulus = m->young / (2 * (1 + m->poisson));
    }
    if (place == 1) {
        m->strength = MPM_STRENGTH_ELASTIC;
        m->melt = MPM_MELT_NONE;
    }
    return mpm_material_check(m, fault);
}

/* The block's upper face is z = 0; `margin` around the bodies is free. */
static mpm_desc grid(const settings *c)
{
    const int side = (int)ceil((c->width / 2 + c->margin) / c->cell);
    const int below = (int)ceil((c->height + c->margin) / c->cell);
    mpm_desc d = mpm_desc_default();
    d.basis = (mpm_basis)word_place(MPM_NAMES(MPM_BASIS_LIST), c->functions);
    d.cell = (mpm_real)c->cell;
    d.cells[0] = d.cells[1] = 2 * side;
    d.cells[2] = below + (int)ceil((2 * c->radius + c->margin) / c->cell);
    d.origin[0] = d.origin[1] = (mpm_real)(-side * c->cell);
    d.origin[2] = (mpm_real)(-below * c->cell);
    d.contact.law = (mpm_contact_law)word_place(MPM_NAMES(MPM_CONTACT_LIST), c->contact);
    d.contact.friction = (mpm_real)c->friction;
    return d;
}

static mpm_status build(mpm_world *w, const settings *c, const mpm_material *m)
{
    const mpm_real half = (mpm_real)(c->width / 2);
    const mpm_desc d = grid(c);
    mpm_body_desc b = mpm_body_desc_default();
    mpm_status status = mpm_init(w, &d, NULL, 0);
    b.spacing = (mpm_real)c->spacing;
    b.density = m->density;
    b.temperature = m->temperature;
    b.stress = mpm_material_stress;
    b.material = m;
    mpm_material_wave_speeds(m, m->density, &b.wave_p, &b.wave_s);
    b.shape = mpm_sphere(0, 0, (mpm_real)c->radius, (mpm_real)c->radius);
    b.velocity[2] = (mpm_real)-c->velocity;
    if (status == MPM_OK) status = mpm_body_add(w, &b);
    b.shape = mpm_box(-half, -half, (mpm_real)-c->height, half, half, 0);
    b.velocity[2] = 0;
    if (status == MPM_OK) status = mpm_body_add(w, &b);
    return status;
}

/* ---- the run --------------------------------------------------------------------------------- */

enum { LOCATE, P2G, FORCES, GRID, CONTACT, G2P, MUSL, STRESS, MOVE, STEP, PHASES };
static const char *const phase_name[PHASES] = {"locate", "p2g", "forces", "grid update", "contact",
                                               "g2p", "musl", "stress", "move", "mpm_step"};

/* CPU time of the phases. */
typedef struct laps {
    clock_t at, spent[PHASES];
} laps;

static void lap(laps *l, int phase)
{
    const clock_t now = clock();
    l->spent[phase] += now - l->at;
    l->at = now;
}

static int run(mpm_world *w, const settings *c, mpm_real dt, int64_t steps, laps *l, output *o)
{
    stop_listen();
    output_start(o, w);
    memset(l, 0, sizeof *l);
    while (w->steps < steps && !stop_asked()) { /* then the table is of the steps so far */
        output_progress(o, w, steps);
        l->at = clock();
        if (c->sweeps) {
            if (mpm_step(w, dt) < 0) return report(&w->fault, "step");
            lap(l, STEP);
            continue;
        }
        if (mpm_locate(w, dt) < 0) return report(&w->fault, "locate"); /* points in cell order, their nodes */
        lap(l, LOCATE);
        mpm_p2g(w);          /* mass and momentum to the nodes */
        lap(l, P2G);
        mpm_forces(w);       /* of the stress */
        lap(l, FORCES);
        mpm_grid_update(w);  /* nodal momentum */
        lap(l, GRID);
        mpm_contact_find(w);
        mpm_contact_apply(w);
        lap(l, CONTACT);
        mpm_g2p(w);          /* velocity of the points */
        lap(l, G2P);
        mpm_musl(w);         /* nodal velocity from it */
        lap(l, MUSL);
        if (mpm_stress(w) < 0) return report(&w->fault, "stress"); /* strain, density, stress */
        lap(l, STRESS);
        mpm_move(w);         /* position of the points */
        lap(l, MOVE);
    }
    output_progress_end(o);
    return 1;
}

static void print_cost(const mpm_world *w, const laps *l)
{
    const double points = (double)w->points.count, point_steps = points * (double)w->steps;
    double whole = 0, spent;
    int k;
    for (k = 0; k < PHASES; k++) whole += (double)l->spent[k] / (double)CLOCKS_PER_SEC;
    for (k = 0; k < PHASES; k++) {
        spent = (double)l->spent[k] / (double)CLOCKS_PER_SEC;
        if (spent > 0) printf("  %-12s %8.2f ns per point-step %6.1f %%\n", phase_name[k], 1e9 * spent / point_steps,
               100 * case_share(spent, whole));
    }
    printf("  %-12s %8.2f ns per point-step, %.2f s CPU\n\n", "whole step", 1e9 * whole / point_steps, whole);
    printf("  point-steps per CPU second %14.0f\n", case_share(point_steps, whole));
    printf("  bytes per point            %14.0f\n", (double)mpm_bytes_used(w) / points);
}

/* What must stay the same: all of it, but what the ledger books. */
static void print_books(const mpm_world *w, const mpm_totals *start)
{
    const mpm_totals now = mpm_body_totals(w, -1), sphere = mpm_body_totals(w, 0);
    const double before = start->kinetic + start->internal;
    double error = 0;
    int k;
    for (k = 0; k < 3; k++)
        error = fmax(error, fabs(now.momentum[k] - start->momentum[k] - w->ledger.impulse[k]));
    printf("  mass error                 %14.1e\n", now.mass / start->mass - 1);
    printf("  momentum error             %14.1e of the sphere's\n", case_share(error, fabs(start->momentum[2])));
    printf("  energy: kinetic            %14.3f %%, plastic work %.3f %%, lost in contact %.3f %%\n",
           100 * case_share(now.kinetic, before), 100 * case_share(now.plastic, before),
           100 * case_share(w->ledger.contact, before));
    printf("  energy unaccounted         %14.3f %%\n",
           100 * case_share(now.kinetic + now.internal + w->ledger.contact - before, before));
    printf("  sphere: mean velocity      %14.2f m/s, highest temperature %.1f K\n", sphere.momentum[2] / sphere.mass,
           sphere.temperature_max);
}

/* Builds, runs, prints. Returns 1, or 0 after a message. */
static int measure(mpm_world *w, const settings *c, const mpm_material *m, output *o)
{
    mpm_totals start;
    laps l;
    mpm_real dt;
    double steps;
    if (build(w, c, m) != MPM_OK) return report(&w->fault, "bodies");
    dt = mpm_time_step(w, (mpm_real)c->dt_factor);
    steps = ceil(c->time * 1e-3 / (double)dt);
    if (!(steps < 1e9)) return complain("--time and --dt-factor make more than 1e9 steps");
    start = mpm_body_totals(w, -1);
    printf("sphere %d points, block %d points, %.0f steps of %.4g ns\n", (int)w->body[0].count, (int)w->body[1].count,
           steps, 1e6 * (double)dt);
    if (!run(w, c, dt, (int64_t)steps, &l, o)) return 0;
    if (w->steps < (int64_t)steps) printf("stopped after %lld of them\n", (long long)w->steps);
    if (w->steps == 0) return 1;
    print_cost(w, &l);
    print_books(w, &start);
    return 1;
}

static int carry_out(int argc, char **argv)
{
    settings c = settings_default();
    output o = output_of("", "bench_impact", "mm", "us", 1e-3);
    option options[20];
    char message[300];
    mpm_fault fault;
    mpm_material m;
    mpm_world w;
    int n = options_of(&c, options), parsed, ok;
    option_add(options, &n, "quiet", OPTION_FLAG, &o.quiet, "no progress");
    parsed = options_parse(argc, argv, "A copper sphere hits a copper block: point-steps per CPU second, ns per phase.",
                           options, n);
    if (parsed) return parsed < 0 ? 1 : 0;
    if (!check(&c, message, sizeof message)) return !complain(message);
    if (copper(&m, c.law, &fault) != MPM_OK) return !report(&fault, c.law);
    memset(&w, 0, sizeof w);
    ok = measure(&w, &c, &m, &o);
    mpm_free(&w);
    return ok ? 0 : 1;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
