/* particles_case.h - several particles on one substrate: scene, report, files and checkpoints that
   two_particles and many_particles share. The particles are bodies 0 .. count-1 in order, the substrate is
   the last. SPDX-License-Identifier: MIT */
#ifndef PARTICLES_CASE_H
#define PARTICLES_CASE_H

#include "impact_history.h"
#include "impact_options.h"
#include "report.h"
#include "restart.h"
#include "study.h"

#define PARTICLES (RESTART_BODIES - 1) /* the last body is the substrate */

typedef struct particles_case {
    impact_case base;            /* of every particle; its gap is not used */
    int64_t count;
    double center[PARTICLES][3]; /* um, over the substrate's face */
    int64_t stop_after;          /* steps made now, then a checkpoint; 0: never */
    output out;
    page sheet;
    int argc;                    /* the command line, for the report; 0: none */
    char **argv;
} particles_case;

/* Source A's model, aluminium as its results were reproduced with, a coarse 3D grid, 100 ns. */
static inline particles_case particles_default(const char *symmetry, const char *folder)
{
    particles_case q;
    memset(&q, 0, sizeof q);
    q.base = impact_case_default();
    q.base.material = "al-thesis";
    q.base.symmetry = symmetry;
    q.base.dt_factor = 0.2;
    q.base.time = 100;
    q.out = output_of(folder, "particles", "um", "ns", 1);
    q.out.frames = 4;
    return q;
}

/* With --method surface on the command line: contact and bond on surfaces, each particle with its own, in three
   dimensions, of the aluminium that the bond is calibrated for. */
static inline void particles_method(particles_case *q, int argc, char **argv)
{
    const impact_case usual = q->base;
    if (strcmp(impact_method(argc, argv, usual.method), "surface")) return;
    q->base = impact_case_surface();
    q->base.symmetry = usual.symmetry;
    q->base.geometry = usual.geometry;
    q->base.substrate_diameter = usual.substrate_diameter;
    q->base.substrate_height = usual.substrate_height;
    q->base.time = usual.time;
}

/* ... and what is 0 then: cells of d/14 with two points along an edge, half as fine as for one particle. */
static inline void particles_complete(particles_case *q)
{
    const int surface = !strcmp(q->base.method, "surface");
    if (surface && !(fabs(q->base.cell) > 0)) q->base.cell = q->base.diameter / 14;
    if (surface && !(fabs(q->base.spacing) > 0)) q->base.spacing = q->base.cell / 2;
    impact_complete(&q->base);
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

/* The largest extent of a particle, um. */
static inline double particles_extent(const particles_case *q)
{
    return 2 * fmax(impact_half_width(&q->base), impact_half_height(&q->base));
}

/* Draws centres of particles at least `apart` from each other, in a cylinder that leans by `drift` as they fall. Gives
   up after 200,000 draws: returns 0. */
static inline int particles_scatter(particles_case *q, double spread, double height, double apart, double drift,
                                    int64_t seed)
{
    const double pi = (double)MPM_PI;
    uint64_t state = (uint64_t)seed;
    int64_t k, other, tries = 0;
    for (k = 0; k < q->count; k++) {
        double *x = q->center[k], r, phi, d2;
        do {
            if (tries++ > 200000) return 0;
            r = spread / 2 * sqrt(particles_draw(&state));
            phi = 2 * pi * particles_draw(&state);
            x[0] = r * cos(phi);
            x[1] = r * sin(phi);
            x[2] = height * particles_draw(&state);
            x[0] -= drift * x[2];
            for (other = 0, d2 = HUGE_VAL; other < k; other++) {
                const double *y = q->center[other];
                const double dx = x[0] - y[0], dy = x[1] - y[1], dz = x[2] - y[2];
                d2 = fmin(d2, dx * dx + dy * dy + dz * dz);
            }
        } while (d2 < apart * apart);
    }
    return 1;
}

/* Centres in a cylinder over the substrate, at least the largest extent of a particle and a cell apart, the lowest
   on the substrate; oblique ones start aside, so that they land where they would without the angle. Sets the
   substrate's width (spread and a particle) and the time (the fall and 40 ns) where they are 0. Returns 1, or 0
   with a message. Test: 63_particles. */
static inline int particles_place(particles_case *q, double spread, double height, int64_t seed, char *message,
                                  size_t n)
{
    const double tilt = q->base.angle * (double)MPM_PI / 180, drift = tan(tilt);
    const double down = q->base.velocity * cos(tilt);
    double least = HUGE_VAL, apart;
    int64_t k;
    if (!(fabs(q->base.substrate_diameter) > 0)) q->base.substrate_diameter = spread + 2 * impact_half_width(&q->base);
    if (!(fabs(q->base.time) > 0)) q->base.time = 1e3 * height / down + 40;
    particles_complete(q);
    if (!impact_check(&q->base, message, n)) return 0;
    apart = particles_extent(q) + q->base.cell;
    if (!particles_scatter(q, spread, height, apart, drift, seed)) {
        snprintf(message, n, "--count %lld: no room for so many at %g um (particle and cell) from centre to centre; "
                 "larger --spread or --height, or smaller --cell", (long long)q->count, apart);
        return 0;
    }
    for (k = 0; k < q->count; k++) least = fmin(least, q->center[k][2]);
    for (k = 0; k < q->count; k++) {
        q->center[k][0] += drift * least;
        q->center[k][2] += impact_half_height(&q->base) - least;
    }
    return 1;
}

/* A mirror may halve a particle, or have it whole on its side. Returns 1, or 0 with a message. */
static inline int particles_mirrored(const particles_case *q, char *message, size_t n)
{
    const int rings = !strcmp(q->base.geometry, "axisymmetric");
    const int mirrors = rings ? 0 : word_place(IMPACT_SYMMETRIES, q->base.symmetry); /* y = 0, then x = 0 too */
    int64_t k;
    int a;
    for (k = 0; k < q->count; k++)
        for (a = 0; a < 2; a++)
            if (mirrors >= 2 - a && fabs(q->center[k][a]) > 0 && q->center[k][a] < impact_half_width(&q->base)) {
                snprintf(message, n, "--symmetry %s: the mirror %c = 0 cuts particle %lld beside its middle",
                         q->base.symmetry, "xy"[a], (long long)k);
                return 0;
            }
    return 1;
}

/* Builds the scene. Returns 1, or 0 with a message; then nothing is left to free. The world points into
   *s: do not copy or move it. */
static inline int particles_begin(impact *s, const particles_case *q, char *message, size_t n)
{
    impact_case room = q->base; /* one case whose grid holds all */
    int64_t k;
    memset(s, 0, sizeof *s);
    if (!impact_check(&q->base, message, n)) return 0;
    if (!particles_mirrored(q, message, n)) return 0;
    if (!case_wants((double)q->count * pow(q->base.diameter / q->base.spacing, 3) < 1e9, "count", (double)q->count,
                    "makes more than 1e9 points", message, n))
        return 0;
    for (k = 0; k < q->count; k++) {
        const double *x = q->center[k], aside = fmax(fabs(x[0]), fabs(x[1]));
        const double reach = aside + impact_half_width(&q->base);
        if (!case_wants(!strcmp(q->base.geometry, "3d") || !(aside > 0), "offset", aside,
                        "beside the axis: needs geometry 3d", message, n))
            return 0;
        room.substrate_diameter = fmax(room.substrate_diameter, 2 * reach);
        room.gap = fmax(room.gap, x[2] - impact_half_height(&q->base));
    }
    if (!impact_build(s, &q->base, impact_grid(&room), q->center, q->count, message, n)) return 0;
    s->bond.partner = mpm_field_take(&s->world, "bonded to");
    if (s->bond.partner >= 0) return 1;
    snprintf(message, n, "no memory to note whom the points bond to");
    impact_end(s);
    return 0;
}

/* What became of a particle. */
typedef enum particle_fate {
    PARTICLE_ARRIVING,
    PARTICLE_BONDED,
    PARTICLE_RESTING,
    PARTICLE_REBOUNDED,
    PARTICLE_SHEARED,
    PARTICLE_FATES
} particle_fate;

static const char *const particle_fate_text[PARTICLE_FATES] = {"arriving", "bonded", "resting", "rebounded",
                                                               "sheared off"};

/* How two bodies meet: by points and nodes, or by their surfaces. */
typedef struct particles_meeting {
    int linked;             /* a bond that is not spent */
    int64_t contacted, bonded; /* points */
    int64_t nodes, held;    /* bonded ones; those of them that the last step held */
    double pbcp;            /* bonded share of what touched, by area, % */
    double touched, area;   /* that touched and that bonded, in the model, um2 */
} particles_meeting;

typedef struct particle_report {
    particle_fate fate;
    particles_meeting met;  /* with any other body */
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

/* Of a and b, or (-1) any other body. */
static inline particles_meeting particles_meet(const impact *s, int32_t a, int32_t b)
{
    const mpm_interface f = mpm_interface_of(&s->world, a, b);
    mpm_bond_measure m = mpm_bond_measure_body(&s->world, a);
    particles_meeting r;
    memset(&r, 0, sizeof r);
    if (s->surfaces.surfaces > 0) {
        const mpm_meeting met = mpm_surface_meets(&s->surfaces, &s->world, a, b);
        r.touched = met.touched > 0 ? met.touched : met.area; /* without adhesion: now */
        r.area = met.bonded;
        r.linked = met.bonded > 0;
        r.pbcp = 100 * case_share(r.area, r.touched);
        return r;
    }
    if (b >= 0) mpm_bond_measure_pair(&s->bond, &s->world, a, b, &m);
    r.contacted = m.contacted;
    r.bonded = m.bonded;
    r.pbcp = m.pbcp;
    r.touched = m.contacted_area;
    r.area = m.bonded_area;
    r.nodes = f.bonded;
    r.held = f.held;
    r.linked = f.bonded > 0;
    return r;
}

/* Which bodies a chain of bonds leads to from the substrate. */
static inline void particles_linked(const impact *s, int32_t substrate, int *linked)
{
    int changed = 1;
    int32_t a, b;
    memset(linked, 0, (size_t)substrate * sizeof *linked);
    linked[substrate] = 1;
    while (changed)
        for (changed = 0, a = 0; a < substrate; a++)
            for (b = 0; b <= substrate && !linked[a]; b++)
                if (b != a && linked[b] && particles_meet(s, a, b).linked) linked[a] = changed = 1;
}

/* Bonded: a chain of bonds leads to the substrate and it moves with the substrate to within 5 m/s; resting: so
   slow, without such a chain; rebounded: leaves faster upwards than along the face; sheared off: leaves faster along
   the face; arriving: on its way down. */
static inline particle_fate particles_fate(double v_z, double v_along, int linked)
{
    if (hypot(v_z, v_along) <= 5) return linked ? PARTICLE_BONDED : PARTICLE_RESTING;
    if (-v_z > v_along) return PARTICLE_ARRIVING;
    return v_z >= v_along ? PARTICLE_REBOUNDED : PARTICLE_SHEARED;
}

static inline double particles_center(const mpm_world *w, int32_t body)
{
    const mpm_body *b = &w->body[body];
    double mass = 0, high = 0;
    int32_t i;
    for (i = b->first; i < b->first + b->count; i++) {
        mass += (double)w->points.mass[i];
        high += (double)w->points.mass[i] * (double)w->points.x[2][i];
    }
    return high / mass;
}

/* Reports on every particle. */
static inline void particles_report(const impact *s, const particles_case *q, particle_report *r)
{
    const mpm_world *w = &s->world;
    const int32_t substrate = (int32_t)q->count;
    int linked[PARTICLES + 1];
    double still[3], v[3];
    int32_t a;
    particles_linked(s, substrate, linked);
    particles_velocity(w, substrate, still);
    for (a = 0; a < substrate; a++) {
        particles_velocity(w, a, v);
        r[a].met = particles_meet(s, a, -1);
        r[a].height = particles_center(w, a);
        r[a].v_z = v[2] - still[2];
        r[a].v_along = hypot(v[0] - still[0], v[1] - still[1]);
        r[a].fate = particles_fate(r[a].v_z, r[a].v_along, linked[a]);
        r[a].ejected = r[a].fate == PARTICLE_ARRIVING
                           ? 0 : mpm_rebound_of(w, a, 60).fast_mass / mpm_body_totals(w, a).mass;
    }
}

/* ---- files --------------------------------------------------------------------------------- */

/* "2 x al-thesis, 14 um at 810 m/s" */
static inline const char *particles_title(const particles_case *q, char *text, size_t n)
{
    snprintf(text, n, "%lld x %s, %g um at %g m/s", (long long)q->count, q->base.material, q->base.diameter,
             q->base.velocity);
    return text;
}

/* A frame: cuts through x-z at y = 0 with plastic strain and bodies; for ParaView also whom a point bonds to. */
static inline int particles_frame(const impact *s, particles_case *q)
{
    const mpm_points *p = &s->world.points;
    const double width = 2 * impact_half_width(&q->base), high = impact_half_height(&q->base);
    double edge = q->base.substrate_diameter / 2 + width / 2, top = 2 * high;
    int32_t *partner, i;
    output_picture picture;
    mpm_io_field field;
    int64_t k;
    int ok;
    if (!page_frame(&q->sheet, &q->out, &s->world, &s->surfaces)) return 0;
    partner = (int32_t *)malloc((size_t)p->count * sizeof *partner);
    if (!partner) return complain("no memory for output");
    for (i = 0; i < p->count; i++) partner[i] = (int32_t)p->user[s->bond.partner][i] - 1;
    field = mpm_io_int32(s->world.user_name[s->bond.partner], partner); /* the body; -1: none */
    for (k = 0; k < q->count; k++) {
        edge = fmax(edge, fabs(q->center[k][0]) + width);
        top = fmax(top, q->center[k][2] + high);
    }
    output_bodies(&q->out, &s->world, q->base.spacing, &picture);
    output_window(&picture, 1.05 * edge, -1.05 * q->base.substrate_height, 1.05 * top);
    picture.cut[1].title = "bodies";
    particles_title(q, picture.title, sizeof picture.title);
    ok = output_outline(&q->out, &picture, &s->world, &s->surfaces) &&
         output_surfaces(&q->out, &s->world, &s->surfaces) &&
         output_frame(&q->out, &s->world, &field, 1, &picture);
    output_picture_free(&picture);
    free(partner);
    return ok;
}

/* particles.csv */
static inline int particles_table(const particles_case *q, const particle_report *r)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_csv t;
    int64_t a;
    int k;
    mpm_io_csv_begin(&t, file_in(q->out.folder, "particles.csv", path, sizeof path),
                     "particle,x_um,y_um,z_um,fate,pbcp_percent,contacted_points,bonded_points,bonded_nodes,"
                     "v_z_m_s,v_along_m_s,ejected_mass_share,contact_um2,bonded_um2,height_um", NULL, &fault);
    for (a = 0; a < q->count; a++) {
        mpm_io_csv_integer(&t, a);
        for (k = 0; k < 3; k++) mpm_io_csv_real(&t, (mpm_real)q->center[a][k]);
        mpm_io_csv_text(&t, particle_fate_text[r[a].fate]);
        mpm_io_csv_real(&t, (mpm_real)r[a].met.pbcp);
        mpm_io_csv_integer(&t, r[a].met.contacted);
        mpm_io_csv_integer(&t, r[a].met.bonded);
        mpm_io_csv_integer(&t, r[a].met.nodes);
        mpm_io_csv_real(&t, (mpm_real)r[a].v_z);
        mpm_io_csv_real(&t, (mpm_real)r[a].v_along);
        mpm_io_csv_real(&t, (mpm_real)r[a].ejected);
        mpm_io_csv_real(&t, (mpm_real)r[a].met.touched);
        mpm_io_csv_real(&t, (mpm_real)r[a].met.area);
        mpm_io_csv_real(&t, (mpm_real)r[a].height);
    }
    return mpm_io_csv_end(&t, &fault) >= 0 || report(&fault, path);
}

/* pairs.csv */
static inline int particles_pairs(const impact *s, const particles_case *q)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_csv t;
    int32_t a, b;
    mpm_io_csv_begin(&t, file_in(q->out.folder, "pairs.csv", path, sizeof path),
                     "a,b,pbcp_percent,contacted_points,bonded_points,bonded_nodes,held_nodes,contact_um2,bonded_um2",
                     NULL, &fault);
    for (a = 0; a < (int32_t)q->count; a++)
        for (b = a + 1; b <= (int32_t)q->count; b++) {
            const particles_meeting m = particles_meet(s, a, b);
            if (!(m.touched > 0) && mpm_interface_of(&s->world, a, b).nodes == 0) continue;
            mpm_io_csv_integer(&t, a);
            mpm_io_csv_integer(&t, b);
            mpm_io_csv_real(&t, (mpm_real)m.pbcp);
            mpm_io_csv_integer(&t, m.contacted);
            mpm_io_csv_integer(&t, m.bonded);
            mpm_io_csv_integer(&t, m.nodes);
            mpm_io_csv_integer(&t, m.held);
            mpm_io_csv_real(&t, (mpm_real)m.touched);
            mpm_io_csv_real(&t, (mpm_real)m.area);
        }
    return mpm_io_csv_end(&t, &fault) >= 0 || report(&fault, path);
}

/* Bonded share of all that touched, % */
static inline double particles_pbcp(const impact *s, const particles_case *q)
{
    double touched = 0, bonded = 0;
    int32_t a, b;
    if (s->surfaces.surfaces == 0) return mpm_bond_measure_body(&s->world, -1).pbcp;
    for (a = 0; a < (int32_t)q->count; a++)
        for (b = a + 1; b <= (int32_t)q->count; b++) {
            const particles_meeting m = particles_meet(s, a, b);
            touched += m.touched;
            bonded += m.area;
        }
    return 100 * case_share(bonded, touched);
}

/* history.csv, and history.png and film.png if pictures are wanted */
static inline int particles_history(particles_case *q, const history *past)
{
    char title[160];
    return history_csv(past, q->out.folder) &&
           (q->out.frames == 0 || (output_film(&q->out, particles_title(q, title, sizeof title)) &&
                                   impact_history_png(past, q->out.folder, title)));
}

/* The checksum of both tables, which the summary keeps. */
static inline const char *particles_sum(const particles_case *q, char sum[HASH_DIGITS])
{
    static const char *const name[2] = {"particles.csv", "pairs.csv"};
    char path[PATH_BYTES], one[2] = "";
    uint64_t h = HASH_NONE;
    int k, c;
    for (k = 0; k < 2; k++) {
        FILE *f = fopen(file_in(q->out.folder, name[k], path, sizeof path), "rb");
        while (f && (c = fgetc(f)) != EOF) {
            one[0] = (char)c;
            h = hash_text(h, one);
        }
        h = hash_text(h, f && !ferror(f) ? "\n" : "none");
        if (f) fclose(f);
    }
    return hash_digits(h, sum);
}

/* summary.json, which is written last */
static inline int particles_summary(const impact *s, const particles_case *q, const particle_report *r,
                                    const option *o, int n)
{
    const mpm_world *w = &s->world;
    const mpm_totals sums = mpm_body_totals(w, -1);
    int64_t fates[PARTICLE_FATES] = {0}, a;
    char path[PATH_BYTES], sum[HASH_DIGITS];
    mpm_fault fault;
    mpm_io_json j;
    int k;
    for (a = 0; a < q->count; a++) fates[r[a].fate]++;
    mpm_io_json_begin(&j, file_in(q->out.folder, "summary.json", path, sizeof path), &fault);
    mpm_io_json_integer(&j, "mpm_digits", MPM_DIGITS); /* of the number type */
    mpm_io_json_integer(&j, "particles", q->count);
    for (k = 0; k < PARTICLE_FATES; k++) mpm_io_json_integer(&j, particle_fate_text[k], fates[k]);
    mpm_io_json_number(&j, "pbcp_percent", particles_pbcp(s, q));
    mpm_io_json_integer(&j, "points", sums.points);
    mpm_io_json_integer(&j, "steps", w->steps);
    mpm_io_json_number(&j, "time_ns", (double)w->time * 1e3);
    mpm_io_json_number(&j, "mass_error", (sums.mass - s->start.mass) / s->start.mass);
    mpm_io_json_number(&j, "energy_unaccounted",
                       case_share(sums.kinetic + sums.internal + w->ledger.absorbed + w->ledger.contact +
                                      w->ledger.hold + w->ledger.walls - s->start.kinetic - s->start.internal,
                                  s->start.kinetic));
    mpm_io_json_integer(&j, "floor_hits", (long long)w->tally[MPM_TALLY_BOND_FLOOR]);
    mpm_io_json_integer(&j, "bond_increments", (long long)w->tally[MPM_TALLY_BOND_GROWTH]);
    mpm_io_json_number(&j, "cpu_seconds", q->out.cpu);
    mpm_io_json_string(&j, "tables", particles_sum(q, sum)); /* their checksum */
    options_json(&j, o, n);
    return mpm_io_json_end(&j, &fault) >= 0 || report(&fault, path);
}

/* report.html, if it is wanted. Without it the scene does not count as finished. Returns 1, or 0 after a message. */
static inline int particles_page(const impact *s, const particles_case *q, const particle_report *r,
                                 const history *past, const option *o, int n)
{
    static const page_row row[] = {
        {"bonded", "bonded", "particles", 0, 1, "a chain of bonds leads to the substrate; as slow as it to 5 m/s"},
        {"resting", "resting", "particles", 0, 0, "so slow, without such a chain"},
        {"rebounded", "rebounded", "particles", 0, 1, "leave faster upwards than along the face"},
        {"sheared off", "sheared off", "particles", 0, 1, "leave faster along the face"},
        {"arriving", "arriving", "particles", 0, 0, "on their way down"},
        {"pbcp_percent", "PBCP, bonded share", "%", 2, 1, "of all surface that touched, the part that bonded, by area"},
        {"energy_unaccounted", "energy unaccounted", "", 5, 0, "of that at the start, what no account explains"},
        {"points", "points", "", 0, 0, "material points of the model"}, {"steps", "steps", "", 0, 0, "of time"}};
    page_desc d = page_of(o, n, q->argc, q->argv);
    char verdict[80], lead[300], title[160], picture[40], path[PATH_BYTES];
    int64_t bonded = 0, k;
    if (!q->sheet.on) return 1;
    for (k = 0; k < q->count; k++) bonded += r[k].fate == PARTICLE_BONDED;
    snprintf(verdict, sizeof verdict, "%lld of %lld particles bonded.", (long long)bonded, (long long)q->count);
    snprintf(lead, sizeof lead, "Particles of %s, %g " PAGE_MU "m across, hit %s at %g m/s; this is after %.4g ns. "
             "What became of each is in particles.csv.", q->base.material, q->base.diameter,
             s->material[IMPACT_SUBSTRATE].name, q->base.velocity, (double)s->world.time * 1e3);
    d.program = q->out.name;
    d.title = particles_title(q, title, sizeof title);
    d.verdict = verdict;
    d.lead = lead;
    d.good = bonded == q->count;
    d.row = row;
    d.rows = (int)(sizeof row / sizeof *row);
    d.past = past;
    d.world = &s->world;
    d.length = q->out.length;
    d.time = q->out.time;
    d.spacing = q->base.spacing;
    snprintf(picture, sizeof picture, "frame_%04lld.png", (long long)q->out.frame - 1);
    if (q->out.frame > 0) d.picture = picture;
    if (page_write(&d, q->out.folder)) return 1;
    remove(file_in(q->out.folder, "summary.json", path, sizeof path));
    return 0;
}

/* The end table; `files` that were written beside the tables. */
static inline void particles_print(const particles_case *q, const particle_report *r, const impact *s,
                                   const char *files)
{
    const int64_t shown = q->count < 40 ? q->count : 40;
    int64_t k;
    printf("\n  particle   fate          PBCP %%   bonded um2   v_z m/s   along m/s   ejected %%\n");
    for (k = 0; k < shown; k++)
        printf("  %8lld   %-11s   %6.2f   %10.3f   %7.2f   %9.2f   %9.1f\n", (long long)k,
               particle_fate_text[r[k].fate], r[k].met.pbcp, r[k].met.area, r[k].v_z, r[k].v_along,
               100 * r[k].ejected);
    printf("\n  PBCP of all surfaces %.2f %%; %s/particles.csv, pairs.csv, summary.json, %s%s\n", particles_pbcp(s, q),
           q->out.folder, files, q->out.frames > 0 ? ", particles.pvd" : "");
}

/* Whether a summary is of this version and number type; one that does not name the type is of double. */
static inline int particles_same_build(const char *summary)
{
    const char *version = json_value(summary, "mpm_version"), *digits = json_value(summary, "mpm_digits");
    return version && !strncmp(version, "\"" MPM_VERSION "\"", sizeof MPM_VERSION + 1) &&
           (digits ? strtol(digits, NULL, 10) : 17) == MPM_DIGITS;
}

/* Whether the tables are those that the summary was written with; else says so. */
static inline int particles_whole(const particles_case *q, const char *summary)
{
    char sum[HASH_DIGITS];
    const char *at = json_value(summary, "tables");
    if (at && *at == '"' && !strncmp(at + 1, particles_sum(q, sum), HASH_DIGITS - 1)) return 1;
    fprintf(stderr, "%s: the tables are damaged: the scene is run again\n", q->out.folder);
    return 0;
}

/* Whether the folder holds this very scene, finished: version, number type and options in its summary, the centres
   in its table; *frames: of that run. */
static inline int particles_kept(const particles_case *q, long *frames)
{
    static char text[200000];
    impact_case base = q->base, usual = impact_case_default();
    option o[IMPACT_OPTIONS], plain[IMPACT_OPTIONS];
    int n = impact_options(&base, o), plain_n = impact_options(&usual, plain), a;
    char path[PATH_BYTES], *row;
    const char *count, *pictures;
    int64_t k;
    option_drop(o, &n, "gap"); /* by the places of the particles */
    option_drop(plain, &plain_n, "gap");
    text_in(file_in(q->out.folder, "summary.json", path, sizeof path), text, sizeof text);
    count = json_value(text, "particles");
    if (!count || strtol(count, NULL, 10) != q->count || !particles_same_build(text) ||
        !options_match(text, o, plain, n) || !particles_whole(q, text))
        return 0;
    pictures = json_value(text, "frames");
    *frames = pictures ? strtol(pictures, NULL, 10) : -1;
    text_in(file_in(q->out.folder, "particles.csv", path, sizeof path), text, sizeof text);
    row = strstr(text, "height_um\n"); /* ends the line of the names */
    for (k = 0; k < q->count; k++) {
        row = row ? strchr(row, '\n') : NULL;
        if (!row || strtol(row + 1, &row, 10) != k) return 0;
        for (a = 0; a < 3; a++) {
            const mpm_real centre = (mpm_real)q->center[k][a];
            if (*row != ',' || fabs((double)((mpm_real)strtod(row + 1, &row) - centre)) > 0) return 0;
        }
    }
    return 1;
}

static inline int particles_finished(const particles_case *q)
{
    long frames;
    return particles_kept(q, &frames);
}

/* The same, with as many frames as wanted: then says so. Test: 63_particles. */
static inline int particles_done(const particles_case *q)
{
    long frames;
    if (!particles_kept(q, &frames) || (q->out.frames > 0 && q->out.frames != frames)) return 0;
    printf("%s holds this scene, finished: delete the folder to run it again\n", q->out.folder);
    return 1;
}

/* ---- interruptions ------------------------------------------------------------------------- */

#define PARTICLES_CHECKPOINT 60 /* CPU seconds from one to the next */

/* Goes on where an earlier run of this scene was left, or begins the output. Returns 1, or 0 after a message. */
static inline int particles_resume(const impact *s, particles_case *q, restart *again)
{
    char path[PATH_BYTES], text[200];
    mpm_fault fault;
    const int found = is_there(file_in(q->out.folder, "checkpoint.bin", path, sizeof path));
    if (found < 0) return 0; /* what it holds must not be lost */
    if (found) {
        if (restart_read(again, path, &fault) >= 0) {
            restart_said(again, s->steps);
            return 1;
        }
        if (s->world.points.count == 0 || s->world.steps > 0) return report(&fault, path);
        mpm_io_fault_text(text, sizeof text, &fault);
        fprintf(stderr, "%s is of other options or damaged (%s): starting afresh\n", path, text);
    }
    remove(file_in(q->out.folder, "summary.json", path, sizeof path)); /* it would stand for this run */
    return output_begin(&q->out);
}

/* ---- main ---------------------------------------------------------------------------------- */

/* Steps to the end. Returns 1; 0 after a message; -1 when stopped before, with a checkpoint. */
static inline int particles_run(impact *s, particles_case *q, restart *again)
{
    const mpm_world *w = &s->world;
    int status = 1;
    stop_listen();
    output_start(&q->out, w);
    for (;;) {
        if (history_due(again->past, w->steps, s->steps)) impact_history_sample(again->past, s);
        if (output_due(&q->out, w, s->steps) && !particles_frame(s, q)) return 0;
        if (w->steps >= s->steps) break;
        if ((status = restart_goes_on(again)) <= 0) break;
        if (impact_step(s) < 0) return report(&w->fault, "step");
        output_progress(&q->out, w, s->steps);
    }
    output_progress_end(&q->out);
    output_cpu(&q->out);
    return status;
}

/* What a checkpoint of the scene is of. */
static inline void particles_again(restart *again, impact *s, particles_case *q, history *past)
{
    impact_case base = q->base;
    option o[IMPACT_OPTIONS];
    const int n = impact_options(&base, o);
    memset(again, 0, sizeof *again);
    again->every = PARTICLES_CHECKPOINT;
    again->after = q->stop_after;
    impact_history_begin(past, s->steps);
    restart_describe(again, &s->world, &s->surfaces, &q->out, &s->start, past, s->dt, o, n);
}

/* The rest of main(): runs the scene and writes everything. Returns 0; 1 after a message; 3 when stopped. */
static inline int particles_main(particles_case *q, const option *o, int n)
{
    static particle_report r[PARTICLES];
    char message[400];
    restart again;
    history past;
    impact s;
    int status;
    if (!particles_begin(&s, q, message, sizeof message)) return !complain(message);
    particles_again(&again, &s, q, &past);
    status = particles_resume(&s, q, &again) && page_begin(&q->sheet, &q->out, q->base.spacing)
                 ? particles_run(&s, q, &again) : 0;
    if (status < 0)
        printf("stopped at step %lld of %lld; run again to go on\n", (long long)s.world.steps, (long long)s.steps);
    if (status > 0) {
        particles_report(&s, q, r);
        status = particles_table(q, r) && particles_pairs(&s, q) && particles_history(q, &past) &&
                 particles_summary(&s, q, r, o, n) && particles_page(&s, q, r, &past, o, n);
    }
    if (status > 0) {
        restart_end(&again);
        page_end(&q->sheet, q->out.folder);
        if (!q->out.quiet) particles_print(q, r, &s, q->out.frames > 0 ? "history.csv, history.png" : "history.csv");
    }
    impact_end(&s);
    return status > 0 ? 0 : status < 0 ? STOPPED : 1;
}

/* The options that both programs have. */
static inline int particles_options(particles_case *q, option *o)
{
    int n = impact_options(&q->base, o);
    option_drop(o, &n, "gap"); /* by the places of the particles */
    output_options(&q->out, o, &n);
    page_options(&q->sheet, o, &n);
    option_add(o, &n, "stop-after", OPTION_INTEGER, &q->stop_after,
               "write a checkpoint after so many steps and stop; 0: never");
    return n;
}

/* ... and what they may be. */
static inline int particles_check(const particles_case *q, char *message, size_t n)
{
    return output_check(&q->out, message, n) && page_check(&q->sheet, message, n) &&
           case_wants(q->stop_after >= 0, "stop-after", (double)q->stop_after, "must be >= 0", message, n);
}

/* ---- many at random: many_particles and its twin with MPI ------------------------------------- */

/* Where particles are drawn. */
typedef struct particles_random {
    double spread, height; /* um */
    int64_t seed;
} particles_random;

static inline particles_random particles_random_default(void)
{
    particles_random p = {60, 0, 1};
    return p;
}

/* Ten of them. */
static inline particles_case particles_many(int argc, char **argv, const char *folder)
{
    particles_case q = particles_default("full", folder);
    q.count = 10;
    q.base.substrate_diameter = q.base.time = 0;
    particles_method(&q, argc, argv);
    q.argc = argc;
    q.argv = argv;
    return q;
}

static inline int particles_many_options(particles_case *q, particles_random *p, option *o)
{
    int n = particles_options(q, o);
    option_add(o, &n, "count", OPTION_INTEGER, &q->count, "particles, 1 .. 500");
    option_add(o, &n, "spread", OPTION_REAL, &p->spread, "width of the region of their centres, um");
    option_add(o, &n, "height", OPTION_REAL, &p->height, "of that region, um; 0: particles fill a fifth of it");
    option_add(o, &n, "seed", OPTION_INTEGER, &p->seed, "of the places");
    return n;
}

/* Checks the options and draws the places. Returns 1, or 0 with a message. */
static inline int particles_many_place(particles_case *q, particles_random *p, char *message, size_t n)
{
    if (!case_wants(q->count >= 1 && q->count <= PARTICLES, "count", (double)q->count, "must be 1 .. 500", message,
                    n) ||
        !particles_check(q, message, n) ||
        !case_wants(p->spread > 0 && p->spread < 1e4, "spread", p->spread, "must be > 0 um", message, n) ||
        !case_wants(p->height >= 0 && p->height < 1e4, "height", p->height, "must be >= 0 um", message, n) ||
        !case_wants(q->base.velocity > 0, "velocity", q->base.velocity, "must be > 0 m/s", message, n))
        return 0;
    if (!(p->height > 0)) p->height = particles_height(q, p->spread);
    return particles_place(q, p->spread, p->height, p->seed, message, n);
}

#endif
