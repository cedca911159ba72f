/* particles_case.h - several particles on one substrate: scene, report and pictures that two_particles and
   many_particles share. The particles are bodies 0 .. count-1 in order, the substrate is the last.
   SPDX-License-Identifier: MIT */
#ifndef PARTICLES_CASE_H
#define PARTICLES_CASE_H

#include "study.h"

#define PARTICLES 500

typedef struct particles_case {
    impact_case base;            /* of every particle; its gap is not used */
    long count;
    double center[PARTICLES][3]; /* um, over the substrate's face */
    long frames;
    const char *folder;
    int quiet;
} particles_case;

/* A coarse 3D grid, 100 ns. */
static inline particles_case particles_default(const char *symmetry, const char *folder)
{
    particles_case q;
    memset(&q, 0, sizeof q);
    q.base = impact_case_default();
    q.base.symmetry = symmetry;
    q.base.dt_factor = 0.2;
    q.base.time = 100;
    q.frames = 4;
    q.folder = folder;
    return q;
}

/* The next number in [0, 1): splitmix64. */
static inline double particles_draw(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

/* The height in which that many particles fill a fifth of a cylinder of width `spread`. */
static inline double particles_height(const particles_case *q, double spread)
{
    const double d = q->base.diameter;
    return (double)q->count * d * d * d / 6 / 0.2 / (spread * spread / 4);
}

/* Centres in a cylinder over the substrate, at least a diameter and a cell apart, the lowest on the
   substrate. Sets the substrate's width (spread and a diameter) and the time (the fall and 40 ns) where they
   are 0. Returns 1, or 0 when there is no room. */
static inline int particles_place(particles_case *q, double spread, double height, long seed)
{
    const double apart = q->base.diameter + q->base.cell, pi = 3.14159265358979323846;
    uint64_t state = (uint64_t)seed;
    double least = HUGE_VAL;
    long k, other, tries = 0;
    for (k = 0; k < q->count; k++) {
        double *x = q->center[k], r, phi, d2 = HUGE_VAL;
        do {
            if (tries++ > 200000) return 0;
            r = spread / 2 * sqrt(particles_draw(&state));
            phi = 2 * pi * particles_draw(&state);
            x[0] = r * cos(phi);
            x[1] = r * sin(phi);
            x[2] = height * particles_draw(&state);
            for (other = 0, d2 = HUGE_VAL; other < k; other++) {
                const double *y = q->center[other];
                const double dx = x[0] - y[0], dy = x[1] - y[1], dz = x[2] - y[2];
                d2 = fmin(d2, dx * dx + dy * dy + dz * dz);
            }
        } while (d2 < apart * apart);
        least = fmin(least, x[2]);
    }
    for (k = 0; k < q->count; k++) q->center[k][2] += q->base.diameter / 2 - least;
    if (!(fabs(q->base.substrate_diameter) > 0)) q->base.substrate_diameter = spread + q->base.diameter;
    if (!(fabs(q->base.time) > 0)) q->base.time = 1e3 * height / q->base.velocity + 40;
    return 1;
}

/* A mirror may halve a particle, or have it whole on its side. Returns 1, or 0 with a message. */
static inline int particles_mirrored(const particles_case *q, char *message, size_t n)
{
    const int rings = !strcmp(q->base.geometry, "axisymmetric");
    const int mirrors = rings ? 0 : case_word("full|half|quarter", q->base.symmetry); /* y = 0, then x = 0 too */
    long k;
    int a;
    for (k = 0; k < q->count; k++)
        for (a = 0; a < 2; a++)
            if (mirrors >= 2 - a && fabs(q->center[k][a]) > 0 && q->center[k][a] < impact_half_width(&q->base)) {
                snprintf(message, n, "--symmetry %s: the mirror %c = 0 cuts particle %ld beside its middle",
                         q->base.symmetry, "xy"[a], k);
                return 0;
            }
    return 1;
}

/* Builds the scene. Returns 1, or 0 with a message; then nothing is left to free. The world points into
   *s: do not copy or move it. */
static inline int particles_begin(impact *s, const particles_case *q, char *message, size_t n)
{
    impact_case room = q->base; /* one case whose grid holds all */
    mpm_body_desc particle, substrate;
    mpm_status status;
    mpm_desc d;
    long k;
    int a;
    memset(s, 0, sizeof *s);
    if (!impact_check(&q->base, message, n)) return 0;
    if (!particles_mirrored(q, message, n)) return 0;
    if (!case_wants((double)q->count * pow(q->base.diameter / q->base.spacing, 3) < 1e9, "count", (double)q->count,
                    "makes more than 1e9 points", message, n))
        return 0;
    for (k = 0; k < q->count; k++) {
        const double *x = q->center[k], aside = fmax(fabs(x[0]), fabs(x[1])), reach = aside + q->base.diameter / 2;
        if (!case_wants(!strcmp(q->base.geometry, "3d") || !(aside > 0), "offset", aside,
                        "beside the axis: needs geometry 3d", message, n))
            return 0;
        room.substrate_diameter = fmax(room.substrate_diameter, 2 * reach);
        room.gap = fmax(room.gap, x[2] - q->base.diameter / 2);
    }
    for (a = 0; a < 2; a++)
        if (!impact_metal(&s->material[a], &q->base, a, message, n)) return 0;
    particle = impact_body(&s->material[0], &q->base, IMPACT_PARTICLE);
    substrate = impact_body(&s->material[1], &q->base, IMPACT_SUBSTRATE);
    d = impact_grid(&room);
    d.bodies = (int32_t)q->count + 1;
    d.user_fields = 1; /* whom a point bonded to */
    d.points = mpm_shape_count(&d, &substrate.shape, substrate.spacing);
    for (k = 0; k < q->count; k++) {
        for (a = 0; a < 3; a++) particle.shape.center[a] = (mpm_real)q->center[k][a];
        d.points += mpm_shape_count(&d, &particle.shape, particle.spacing);
    }
    s->bond = impact_bond(&q->base);
    s->bond.partner = 0;
    status = mpm_init(&s->world, &d, NULL, 0);
    for (k = 0; k < q->count && status == MPM_OK; k++) {
        for (a = 0; a < 3; a++) particle.shape.center[a] = (mpm_real)q->center[k][a];
        status = mpm_body_add(&s->world, &particle);
    }
    if (status == MPM_OK) status = mpm_body_add(&s->world, &substrate);
    if (status != MPM_OK) {
        mpm_io_fault_text(message, n, &s->world.fault);
        mpm_free(&s->world);
        return 0;
    }
    s->dt = (mpm_real)(q->base.dt_factor * 0.5) /
            (particle.wave_p > substrate.wave_p ? particle.wave_p : substrate.wave_p);
    s->steps = (long)ceil(q->base.time * 1e-3 / (double)s->dt - 1e-9);
    s->start = mpm_body_totals(&s->world, -1);
    return 1;
}

/* What became of a particle. */
typedef enum particle_fate {
    PARTICLE_ARRIVING,
    PARTICLE_BONDED,
    PARTICLE_RESTING,
    PARTICLE_REBOUNDED,
    PARTICLE_SHEARED
} particle_fate;

static const char *const particle_fate_text[5] = {"arriving", "bonded", "resting", "rebounded", "sheared off"};

typedef struct particle_report {
    particle_fate fate;
    mpm_bond_measure bond;  /* of its own points */
    long nodes;             /* bonded nodes to any other body */
    double v_z, v_along;    /* of its points up to 60 m/s, from the substrate's mean: up, along the face [m/s] */
    double ejected;         /* share of its mass faster than 60 m/s; 0 on its way down */
    double height;          /* of its centre of mass, um */
} particle_report;

/* Mean velocity of the points of a body up to 60 m/s (of all, when fewer than half are that slow). */
static inline void particles_velocity(const mpm_world *w, int32_t body, double v[3])
{
    const mpm_points *p = &w->points;
    const mpm_body *b = &w->body[body];
    double all[4] = {0, 0, 0, 0}, slow[4] = {0, 0, 0, 0};
    const double *use;
    int32_t i;
    int a;
    for (i = b->first; i < b->first + b->count; i++) {
        const double m = (double)p->mass[i], x = (double)p->v[0][i], y = (double)p->v[1][i], z = (double)p->v[2][i];
        double *sum[2];
        int k, kinds = x * x + y * y + z * z <= 3600 ? 2 : 1;
        sum[0] = all;
        sum[1] = slow;
        for (k = 0; k < kinds; k++) {
            sum[k][0] += m * x;
            sum[k][1] += m * y;
            sum[k][2] += m * z;
            sum[k][3] += m;
        }
    }
    use = 2 * slow[3] >= all[3] ? slow : all;
    for (a = 0; a < 3; a++) v[a] = use[3] > 0 ? use[a] / use[3] : 0;
    if (w->desc.side[2] == MPM_SIDE_SYMMETRY) v[1] = 0;
    if (w->desc.side[0] == MPM_SIDE_SYMMETRY) v[0] = 0;
}

/* Reports on every particle. Bonded: a chain of bonded nodes leads to the substrate and it moves with the
   substrate to within 5 m/s; resting: so slow, without such a chain; rebounded: leaves faster upwards
   than along the face; sheared off: leaves faster along the face; arriving: on its way down. */
static inline void particles_report(const impact *s, const particles_case *q, particle_report *r)
{
    const mpm_world *w = &s->world;
    const int32_t substrate = (int32_t)q->count;
    int linked[PARTICLES + 1], changed = 1;
    double still[3], v[3];
    int32_t a, b;
    memset(linked, 0, sizeof linked);
    linked[substrate] = 1;
    while (changed) /* the bonded spread from the substrate */
        for (changed = 0, a = 0; a < substrate; a++)
            for (b = 0; b <= substrate && !linked[a]; b++)
                if (b != a && linked[b] && mpm_bond_interface(w, a, b).bonded > 0) linked[a] = changed = 1;
    particles_velocity(w, substrate, still);
    for (a = 0; a < substrate; a++) {
        const mpm_body *body = &w->body[a];
        double mass = 0, high = 0;
        int32_t i;
        r[a].bond = mpm_bond_measure_body(w, a);
        r[a].nodes = mpm_bond_interface(w, a, -1).bonded;
        r[a].ejected = mpm_restitution(w, a, 60).ejected_mass / mpm_body_totals(w, a).mass;
        for (i = body->first; i < body->first + body->count; i++) {
            mass += (double)w->points.mass[i];
            high += (double)w->points.mass[i] * (double)w->points.x[2][i];
        }
        r[a].height = high / mass;
        particles_velocity(w, a, v);
        r[a].v_z = v[2] - still[2];
        r[a].v_along = hypot(v[0] - still[0], v[1] - still[1]);
        if (hypot(r[a].v_z, r[a].v_along) <= 5) r[a].fate = linked[a] ? PARTICLE_BONDED : PARTICLE_RESTING;
        else if (-r[a].v_z > r[a].v_along) r[a].fate = PARTICLE_ARRIVING;
        else r[a].fate = r[a].v_z >= r[a].v_along ? PARTICLE_REBOUNDED : PARTICLE_SHEARED;
        if (r[a].fate == PARTICLE_ARRIVING) r[a].ejected = 0;
    }
}

/* Cuts through x-z at y = 0: plastic strain and bodies. */
static inline int particles_picture(const impact *s, const particles_case *q, const char *path, char *message, size_t n)
{
    const mpm_world *w = &s->world;
    mpm_io_cut_desc cut[2];
    mpm_fault fault;
    char time[32], title[96];
    double edge = q->base.substrate_diameter / 2 + q->base.diameter / 2, top = q->base.diameter;
    long k;
    int i;
    snprintf(time, sizeof time, "t = %.1f ns", (double)w->time * 1e3);
    snprintf(title, sizeof title, "%ld x %s, %g um at %g m/s", q->count, q->base.material, q->base.diameter,
             q->base.velocity);
    for (k = 0; k < q->count; k++) {
        edge = fmax(edge, fabs(q->center[k][0]) + q->base.diameter);
        top = fmax(top, q->center[k][2] + q->base.diameter / 2);
    }
    for (i = 0; i < 2; i++) {
        cut[i] = mpm_io_cut_of(w, i ? NULL : w->points.plastic_strain);
        cut[i].at = w->desc.geometry == MPM_3D ? q->base.spacing / 2 : 0;
        cut[i].mirror = w->desc.side[0] == MPM_SIDE_SYMMETRY;
        cut[i].window[0] = -1.05 * edge;
        cut[i].window[1] = 1.05 * edge;
        cut[i].window[2] = -1.05 * q->base.substrate_height;
        cut[i].window[3] = 1.05 * top;
        cut[i].length_unit = "um";
        cut[i].time = time;
        cut[i].title = i ? "bodies" : title;
    }
    cut[0].label = "effective plastic strain";
    cut[0].low = 0;
    cut[0].high = 4;
    if (mpm_io_cut_png(path, cut, 2, 2, 800, &fault) >= 0) return 1;
    mpm_io_fault_text(message, n, &fault);
    return 0;
}

/* particles.csv, pairs.csv and summary.json. */
static inline int particles_write(const impact *s, const particles_case *q, const particle_report *r,
                                  const option *o, int n, double cpu, mpm_fault *fault)
{
    const mpm_world *w = &s->world;
    const mpm_bond_measure all = mpm_bond_measure_body(w, -1);
    const mpm_totals sums = mpm_body_totals(w, -1);
    char path[MPM_IO_PATH];
    long fates[5] = {0, 0, 0, 0, 0};
    mpm_io_csv t;
    mpm_io_json j;
    int32_t a, b;
    int k;
    snprintf(path, sizeof path, "%s/particles.csv", q->folder);
    mpm_io_csv_begin(&t, path, "particle,x_um,y_um,z_um,fate,pbcp_percent,contacted_points,bonded_points,bonded_nodes,"
                               "v_z_m_s,v_along_m_s,ejected_mass_share,height_um", "one row per particle", fault);
    for (a = 0; a < (int32_t)q->count; a++) {
        mpm_io_csv_integer(&t, a);
        for (k = 0; k < 3; k++) mpm_io_csv_real(&t, (mpm_real)q->center[a][k]);
        mpm_io_csv_text(&t, particle_fate_text[r[a].fate]);
        mpm_io_csv_real(&t, (mpm_real)r[a].bond.pbcp);
        mpm_io_csv_integer(&t, r[a].bond.contacted);
        mpm_io_csv_integer(&t, r[a].bond.bonded);
        mpm_io_csv_integer(&t, r[a].nodes);
        mpm_io_csv_real(&t, (mpm_real)r[a].v_z);
        mpm_io_csv_real(&t, (mpm_real)r[a].v_along);
        mpm_io_csv_real(&t, (mpm_real)r[a].ejected);
        mpm_io_csv_real(&t, (mpm_real)r[a].height);
        fates[r[a].fate]++;
    }
    if (mpm_io_csv_end(&t, fault) < 0) return 0;
    snprintf(path, sizeof path, "%s/pairs.csv", q->folder);
    mpm_io_csv_begin(&t, path, "a,b,pbcp_percent,contacted_points,bonded_points,bonded_nodes,held_nodes",
                     "surfaces between two bodies; the last body is the substrate", fault);
    for (a = 0; a < (int32_t)q->count; a++)
        for (b = a + 1; b <= (int32_t)q->count; b++) {
            mpm_bond_measure m;
            const mpm_interface f = mpm_bond_interface(w, a, b);
            if (mpm_bond_measure_pair(&s->bond, w, a, b, &m) < 0 || (m.contacted == 0 && f.nodes == 0)) continue;
            mpm_io_csv_integer(&t, a);
            mpm_io_csv_integer(&t, b);
            mpm_io_csv_real(&t, (mpm_real)m.pbcp);
            mpm_io_csv_integer(&t, m.contacted);
            mpm_io_csv_integer(&t, m.bonded);
            mpm_io_csv_integer(&t, f.bonded);
            mpm_io_csv_integer(&t, f.held);
        }
    if (mpm_io_csv_end(&t, fault) < 0) return 0;
    snprintf(path, sizeof path, "%s/summary.json", q->folder);
    mpm_io_json_begin(&j, path, fault);
    mpm_io_json_integer(&j, "particles", q->count);
    for (k = 0; k < 5; k++) mpm_io_json_integer(&j, particle_fate_text[k], fates[k]);
    mpm_io_json_number(&j, "pbcp_percent", all.pbcp);
    mpm_io_json_integer(&j, "points", sums.points);
    mpm_io_json_integer(&j, "steps", w->steps);
    mpm_io_json_number(&j, "time_ns", (double)w->time * 1e3);
    mpm_io_json_number(&j, "mass_error", (sums.mass - s->start.mass) / s->start.mass);
    mpm_io_json_number(&j, "energy_unaccounted",
                       case_share(sums.kinetic + sums.internal + w->ledger.absorbed + w->ledger.contact +
                                      w->ledger.bond + w->ledger.walls - s->start.kinetic - s->start.internal,
                                  s->start.kinetic));
    mpm_io_json_number(&j, "cpu_seconds", cpu);
    options_json(&j, o, n);
    return mpm_io_json_end(&j, fault) >= 0;
}

static inline void particles_print(const particles_case *q, const particle_report *r, const impact *s)
{
    const long shown = q->count < 40 ? q->count : 40;
    long k;
    printf("\n  particle   fate          PBCP %%   bonded nodes   v_z m/s   along m/s   ejected %%\n");
    for (k = 0; k < shown; k++)
        printf("  %8ld   %-11s   %6.2f   %12ld   %7.2f   %9.2f   %9.1f\n", k, particle_fate_text[r[k].fate],
               r[k].bond.pbcp, r[k].nodes, r[k].v_z, r[k].v_along, 100 * r[k].ejected);
    printf("\n  PBCP of all surfaces %.2f %%; %s/particles.csv, pairs.csv, frames, summary.json\n",
           mpm_bond_measure_body(&s->world, -1).pbcp, q->folder);
}

/* The rest of main(): runs the scene, with a progress line, and writes everything. Returns 0, or 1 after
   a message. */
static inline int particles_main(const particles_case *q, const option *o, int n)
{
    static particle_report report[PARTICLES];
    char message[400], path[MPM_IO_PATH];
    clock_t begun = clock();
    study progress = study_of(q->folder);
    impact s;
    mpm_fault fault = {MPM_OK, NULL, 0, -1};
    long frame = 0;
    if (!particles_begin(&s, q, message, sizeof message)) return fprintf(stderr, "error: %s\n", message), 1;
    progress.quiet = q->quiet;
    progress.planned = 1;
    snprintf(progress.label, sizeof progress.label, "%ld particles, %ld points", q->count, (long)s.world.points.count);
    if (mpm_io_make_directory(q->folder, &fault) < 0) goto fail;
    for (;;) {
        if (q->frames > 0 && s.world.steps * (q->frames > 1 ? q->frames - 1 : 1) >= frame * s.steps) {
            snprintf(path, sizeof path, "%s/frame_%04ld.png", q->folder, frame++);
            if (!particles_picture(&s, q, path, message, sizeof message)) goto say;
        }
        if (s.world.steps >= s.steps) break;
        if (impact_step(&s) < 0) {
            fault = s.world.fault;
            goto fail;
        }
        if (s.world.steps % 16 == 0)
            study_progress(&progress, (double)s.world.steps / (double)s.steps,
                           (double)(clock() - begun) / CLOCKS_PER_SEC);
    }
    study_progress_end(&progress);
    particles_report(&s, q, report);
    if (!particles_write(&s, q, report, o, n, (double)(clock() - begun) / CLOCKS_PER_SEC, &fault)) goto fail;
    if (!q->quiet) particles_print(q, report, &s);
    mpm_free(&s.world);
    return 0;
fail:
    mpm_io_fault_text(message, sizeof message, &fault);
say:
    fprintf(stderr, "error: %s\n", message);
    mpm_free(&s.world);
    return 1;
}

/* The options that both programs have. */
static inline int particles_options(particles_case *q, option *o)
{
    int n = impact_options(&q->base, o);
    option_drop(o, &n, "gap"); /* by the places of the particles */
    option_add(o, &n, "frames", OPTION_LONG, &q->frames, "pictures, evenly in time");
    option_add(o, &n, "out", OPTION_TEXT, &q->folder, "output folder");
    option_add(o, &n, "quiet", OPTION_FLAG, &q->quiet, "no progress line, no table");
    return n;
}

#endif
