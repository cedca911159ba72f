/* study.h - many impacts for one answer: a table of the options that make a case, one case run to its end
   and measured, and a store of finished runs, so that an interrupted study goes on where it stopped.
   SPDX-License-Identifier: MIT */
#ifndef STUDY_H
#define STUDY_H

#include "impact_options.h"
#include "plots.h"
#include "program.h"
#include "sweep.h"
#include "terminal.h"

/* ---- the case ------------------------------------------------------------------------------ */

/* The options of a case, with what 0 means in a study. Returns their number. */
static inline int study_case_options(impact_case *c, option *o)
{
    const int n = impact_options(c, o);
    o[option_find(o, n, "substrate-diameter")].help = "um; 0: by --substrate";
    o[option_find(o, n, "substrate-height")].help = "um; 0: by --substrate";
    o[option_find(o, n, "time")].help = "simulated time, ns; 0: 80, in proportion beyond 30 um";
    return n;
}

/* The case of the studies: source A's model, aluminium as its results were reproduced with, axisymmetric, 1.0/0.25 um,
   time step factor 0.2; sizes left to study_complete. */
static inline impact_case study_case_default(void)
{
    impact_case c = impact_case_default();
    c.material = "al-thesis";
    c.geometry = "axisymmetric";
    c.cell = 1;
    c.spacing = 0.25;
    c.dt_factor = 0.2;
    c.substrate_diameter = c.substrate_height = c.time = 0;
    return c;
}

#define STUDY_SUBSTRATES "thesis|large"

/* Source A's substrates (Table 5.3): its diameter between the listed sizes by interpolation, in proportion
   beyond them; 10 um high between 14 and 30 um, in proportion beyond. "large": 5 diameters wide, 2.5 high.
   Fills in what is 0; with method surface as impact_complete. */
static inline void study_complete(impact_case *c, const char *substrate)
{
    static const double size[5] = {14, 18, 22, 26, 30}, wide[5] = {30, 36, 44, 46, 50};
    const double d = c->diameter, near_size = d < 14 ? 14 : d > 30 ? 30 : d;
    double width = d * (d < 14 ? 30.0 / 14 : 50.0 / 30);
    int k;
    impact_complete(c);
    for (k = 0; k < 4; k++)
        if (d >= size[k] && d <= size[k + 1])
            width = wide[k] + (wide[k + 1] - wide[k]) * (d - size[k]) / (size[k + 1] - size[k]);
    if (!(fabs(c->substrate_diameter) > 0)) c->substrate_diameter = strcmp(substrate, "large") ? width : 5 * d;
    if (!(fabs(c->substrate_height) > 0))
        c->substrate_height = strcmp(substrate, "large") ? 10 * d / near_size : 2.5 * d;
    if (!(fabs(c->time) > 0)) c->time = d > 30 ? 80 * d / 30 : 80;
}

/* The case in words: version, whether it runs to its end, and every option with its value. To be freed; NULL
   without memory. */
static inline char *study_key(const impact_case *c, int whole)
{
    impact_case copy = *c;
    option o[IMPACT_OPTIONS];
    char number[OPTION_NUMBER], *key;
    int k, count = impact_options(&copy, o);
    size_t room = 100, used;
    for (k = 0; k < count; k++) room += strlen(o[k].name) + strlen(option_text(&o[k], number)) + 3;
    key = (char *)malloc(room);
    if (!key) return NULL;
    used = mpm_append(key, room, 0, "mpm " MPM_VERSION ", ");
    snprintf(number, sizeof number, "%d", MPM_DIGITS);
    used = mpm_append(key, room, used, number);
    used = mpm_append(key, room, used, whole ? " digits, full time" : " digits, early end");
    for (k = 0; k < count; k++) {
        used = mpm_append(key, room, used, ", ");
        used = mpm_append(key, room, used, o[k].name);
        used = mpm_append(key, room, used, " ");
        used = mpm_append(key, room, used, option_text(&o[k], number));
    }
    return key;
}

/* ---- one run ------------------------------------------------------------------------------- */

/* What is kept of a run, as X(number, "name in tables", "meaning"). Velocities along z, relative to the substrate's
   mean. */
#define STUDY_LIST(X)                                                                                                 \
    X(STUDY_PBCP, "pbcp_percent", "%")                                                                                \
    X(STUDY_ABP, "abp", "")                                                                                           \
    X(STUDY_CONTACTED, "contacted_points", "of the surface")                                                          \
    X(STUDY_V_REST, "v_rest_m_s", "mean over the particle's points up to 60 m/s (as seen from the ground), at the "   \
      "end; over all where more than half of its mass is faster")                                                     \
    X(STUDY_V_MEAN, "v_mean_m_s", "mass-weighted mean, at the end")                                                   \
    X(STUDY_V_LATE, "v_late_m_s", "the same averaged over the last eighth of the time")                               \
    X(STUDY_DRIFT, "substrate_drift_m_s", "the substrate's mean")                                                     \
    X(STUDY_HELD, "held_pairs", "node pairs held by the bond in the last step")                                       \
    X(STUDY_HELD_LATE, "held_late_share", "of the steps of the last eighth in which any was")                         \
    X(STUDY_FLATTENING, "flattening", "height lost by the particle, share")                                           \
    X(STUDY_EPS, "eps_mean", "mean plastic strain of the particle")                                                   \
    X(STUDY_WORK, "plastic_energy_density_MPa", "mean of the particle")                                               \
    X(STUDY_T_MAX, "temperature_max_K", "")                                                                           \
    X(STUDY_EJECTED, "ejected_mass_share", "of the particle, faster than 60 m/s")                                     \
    X(STUDY_RIM, "rim_um", "height of the substrate's rim over its face, of its points up to 60 m/s")                 \
    X(STUDY_SHEARED, "sheared_mass_share", "of both bodies, strained beyond 3, of the particle's mass")               \
    X(STUDY_R_CONTACT, "contact_radius_um", "median distance from the axis of the particle's points with D > 0")      \
    X(STUDY_R_BONDED, "bonded_radius_um", "... with D >= 1; 0 without any")                                           \
    X(STUDY_INNER, "bonded_inner_share", "of the bonded points (by mass) in the inner half of the contact radius, "   \
      "which is sqrt 2 of the median distance of those with D > 0; evenly spread ones: a quarter")                    \
    X(STUDY_UNACCOUNTED, "energy_unaccounted", "of the initial")                                                      \
    X(STUDY_END, "end_ns", "simulated")                                                                               \
    X(STUDY_STEPS, "steps", "")                                                                                       \
    X(STUDY_POINTS, "points", "")                                                                                     \
    X(STUDY_CPU, "cpu_s", "")

#define STUDY_NUMBER(number, name, text) number,
#define STUDY_NAME(number, name, text) name,
enum { STUDY_LIST(STUDY_NUMBER) STUDY_VALUES };
static const char *const study_name[STUDY_VALUES] = {STUDY_LIST(STUDY_NAME)};

#define STUDY_DEAD 120 /* seconds without a sign of life after which a run is another process's to make */

/* A study under way: where finished runs are kept, and what the progress line needs. */
typedef struct study {
    const char *folder;     /* finished runs: one file each, in folder/runs */
    int quiet, whole;       /* whole: do not end a run once the particle has left for good */
    int64_t limit;          /* new runs allowed; < 0: any number */
    int64_t planned, done, fresh; /* runs: in all (a guess at first), finished, of these made now */
    double spent;           /* CPU seconds of the fresh ones */
    int begun;              /* the clock of the line runs */
    const claim *claim;     /* of the run under way, where several processes share the folder, or NULL */
    time_t beat;            /* its last sign of life */
    char label[80];
    progress line;
} study;

static inline study study_of(const char *folder)
{
    study s;
    memset(&s, 0, sizeof s);
    s.folder = folder;
    s.limit = -1;
    return s;
}

static inline void study_options(study *s, option *o, int *n)
{
    option_add(o, n, "whole-time", OPTION_FLAG, &s->whole, "do not end a run early when the particle has left");
    option_add(o, n, "limit", OPTION_INTEGER, &s->limit, "stop after so many new runs; < 0: never");
    option_add(o, n, "out", OPTION_TEXT, &s->folder, "output folder");
    option_add(o, n, "quiet", OPTION_FLAG, &s->quiet, "no progress line, no table");
}

/* The end of a program: 3 after a message when the study was stopped. */
static inline int study_stopped(const study *s)
{
    printf("stopped after %lld new runs; %lld are done: run again to go on\n", (long long)s->fresh, (long long)s->done);
    return 3;
}

/* Starts the clock before the first new run; Ctrl-C and SIGTERM then ask for the end. */
static inline void study_start(study *s)
{
    if (s->begun) return;
    s->begun = 1;
    stop_listen();
    progress_begin(&s->line, s->quiet);
}

/* "run 12 of 40, 14 um at 810 m/s, 35 %, left 2:10". */
static inline void study_progress(study *s, double part)
{
    const double runs = (double)(s->planned > s->done ? s->planned : s->done + 1), fresh = (double)s->fresh + part;
    double left;
    char line[200];
    if (!progress_due(&s->line, ((double)s->done + part) / runs)) return;
    left = fresh > 0 ? progress_elapsed(&s->line) / fresh * (runs - (double)s->done - part) : 0;
    snprintf(line, sizeof line, "run %lld of %.0f, %s, %.0f %%, left %.0f:%02d", (long long)s->done + 1, runs, s->label,
             100 * part, floor(left / 60), (int)fmod(left, 60));
    progress_show(&s->line, line);
}

static inline void study_progress_end(const study *s)
{
    if (s->begun) progress_end(&s->line);
}

/* Mean height and velocity of the particle over those of the substrate, of the points still in the grid. */
static inline void study_distance(const mpm_world *w, double *height, double *velocity)
{
    double sum[2][3] = {{0, 0, 0}, {0, 0, 0}};
    int b;
    int32_t i;
    for (b = 0; b < 2; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            const double m = (double)w->points.mass[i];
            sum[b][0] += m;
            sum[b][1] += m * (double)w->points.x[2][i];
            sum[b][2] += m * (double)w->points.v[2][i];
        }
    for (b = 0; b < 2; b++)
        if (!(sum[b][0] > 0)) sum[b][0] = 1;
    *height = sum[0][1] / sum[0][0] - sum[1][1] / sum[1][0];
    *velocity = sum[0][2] / sum[0][0] - sum[1][2] / sum[1][0];
}

static inline double study_radius(const mpm_world *w, int32_t i)
{
    const double x = (double)w->points.x[0][i], y = (double)w->points.x[1][i];
    return w->desc.geometry == MPM_3D ? hypot(x, y) : x;
}

/* Mass of both bodies strained beyond that. */
static inline double study_sheared(const mpm_world *w, double strain)
{
    double mass = 0;
    int32_t i;
    for (i = 0; i < w->points.count; i++)
        if ((double)w->points.plastic_strain[i] > strain) mass += (double)w->points.mass[i];
    return mass;
}

/* Mass of the particle within a distance of the axis; with a floor > 0 only of surface points whose D is at
   least that. */
static inline double study_within(const mpm_world *w, double radius, double floor)
{
    const mpm_body *b = &w->body[IMPACT_PARTICLE];
    const mpm_points *p = &w->points;
    double mass = 0;
    int32_t i;
    for (i = b->first; i < b->first + b->count; i++)
        if (study_radius(w, i) <= radius &&
            (!(floor > 0) || ((p->flags[i] & MPM_POINT_SURFACE) && (double)p->bond[i] >= floor)))
            mass += (double)p->mass[i];
    return mass;
}

/* The radius within which half of the mass of such points lies; a median, since what is ejected is far. */
static inline double study_median_radius(const mpm_world *w, double floor)
{
    const double half = study_within(w, HUGE_VAL, floor) / 2;
    double low = 0, high = 1e6;
    int k;
    if (!(half > 0)) return 0;
    for (k = 0; k < 50; k++) {
        if (study_within(w, (low + high) / 2, floor) < half) low = (low + high) / 2;
        else high = (low + high) / 2;
    }
    return high;
}

/* Whether the particle's points up to 60 m/s leave the ground at more than 5 m/s, or most of it is faster than 60. */
static inline int study_leaves(const mpm_world *w)
{
    const mpm_rebound r = mpm_rebound_of(w, IMPACT_PARTICLE, 60);
    return r.filtered > 5 || r.fast_mass > 0.5 * mpm_body_totals(w, IMPACT_PARTICLE).mass;
}

/* What is watched while a case runs: the bond, and the particle's way. */
typedef struct study_watch {
    int64_t late, part;      /* steps: where the last eighth begins; a twentieth */
    int64_t held, held_late; /* steps in which a pair was held: of this twentieth; of the last eighth */
    double before;         /* the particle's velocity a twentieth ago */
    double height, time;   /* of the particle where the last eighth begins */
} study_watch;

static inline study_watch study_watch_of(int64_t steps)
{
    study_watch k;
    memset(&k, 0, sizeof k);
    k.late = steps - steps / 8;
    k.part = steps / 20 > 0 ? steps / 20 : 1;
    return k;
}

/* Whether the outcome is decided, looked at after each twentieth: in it no pair was held, and the particle leaves the
   substrate at more than 5 m/s, all points or only those up to 60 m/s, with a mean that changed by less than 1 %. */
static inline int study_decided(study_watch *k, const mpm_world *w)
{
    double height, velocity;
    int decided;
    if (w->steps % k->part) return 0;
    study_distance(w, &height, &velocity);
    decided = k->held == 0 && w->steps < k->late && velocity > 5 && fabs(velocity - k->before) < 0.01 * velocity &&
              study_leaves(w);
    k->before = velocity;
    k->held = 0;
    return decided;
}

/* One step, watched. */
static inline mpm_status study_step(study_watch *k, impact *run)
{
    const mpm_world *w = &run->world;
    double velocity;
    mpm_status status;
    if (w->steps == k->late) {
        study_distance(w, &k->height, &velocity);
        k->time = (double)w->time;
    }
    status = impact_step(run);
    k->held += w->held > 0;
    if (w->steps > k->late) k->held_late += w->held > 0;
    return status;
}

/* Mean velocity over the last eighth; the last one in a run that ended before. */
static inline double study_late(const study_watch *k, const mpm_world *w, double last)
{
    double height, velocity;
    study_distance(w, &height, &velocity);
    return k->time > 0 && (double)w->time > k->time ? (height - k->height) / ((double)w->time - k->time) : last;
}

/* All values but the CPU time. */
static inline void study_measure(const impact *run, const impact_case *c, const study_watch *k, double *value)
{
    const mpm_world *w = &run->world;
    const impact_result r = impact_measure(run, c);
    value[STUDY_PBCP] = r.bond.pbcp;
    value[STUDY_ABP] = r.bond.abp;
    value[STUDY_CONTACTED] = (double)r.bond.contacted;
    value[STUDY_V_REST] = r.fast_fraction > 0.5 ? r.relative : r.filtered_relative;
    value[STUDY_V_MEAN] = r.relative;
    value[STUDY_V_LATE] = study_late(k, w, r.relative);
    value[STUDY_DRIFT] = r.substrate_drift;
    value[STUDY_HELD] = (double)w->held;
    value[STUDY_HELD_LATE] = w->steps > k->late ? (double)k->held_late / (double)(w->steps - k->late) : 0;
    value[STUDY_FLATTENING] = r.flattening;
    value[STUDY_EPS] = r.particle.plastic_strain_mean;
    value[STUDY_WORK] = r.particle.plastic_work_mean;
    value[STUDY_T_MAX] = r.all.temperature_max;
    value[STUDY_EJECTED] = r.fast_fraction;
    value[STUDY_RIM] = mpm_splat_measure(w, IMPACT_PARTICLE, IMPACT_SUBSTRATE, 60).rim;
    value[STUDY_SHEARED] = study_sheared(w, 3) / r.particle.mass;
    value[STUDY_R_CONTACT] = study_median_radius(w, 1e-12);
    value[STUDY_R_BONDED] = study_median_radius(w, 1);
    value[STUDY_INNER] = case_share(study_within(w, value[STUDY_R_CONTACT] / sqrt(2.0), 1),
                                    study_within(w, HUGE_VAL, 1));
    value[STUDY_UNACCOUNTED] = r.energy_unaccounted;
    value[STUDY_END] = (double)w->time * 1e3;
    value[STUDY_STEPS] = (double)w->steps;
    value[STUDY_POINTS] = (double)r.all.points;
}

static inline double study_seconds(clock_t since) { return (double)(clock() - since) / (double)CLOCKS_PER_SEC; }

/* A sign of life to the others who work in this folder, every now and then. */
static inline void study_beat(study *s)
{
    const time_t now = time(NULL);
    if (!s->claim || difftime(now, s->beat) < STUDY_DEAD / 6) return;
    s->beat = now;
    claim_beat(s->claim);
}

/* Runs a case to its end, or unless s->whole until its outcome is decided. Returns 1; 0 with a message; -1 when asked
   to stop. */
static inline int study_run(study *s, const impact_case *c, double *value, char *message, size_t n)
{
    const clock_t begun = clock();
    mpm_status status = MPM_OK;
    study_watch watch;
    impact run;
    if (!impact_begin(&run, c, message, n)) return 0;
    watch = study_watch_of(run.steps);
    while (status >= 0 && run.world.steps < run.steps && !stop_asked()) {
        status = study_step(&watch, &run);
        if (run.world.steps % 64 == 0) study_progress(s, (double)run.world.steps / (double)run.steps);
        if (run.world.steps % 64 == 0) study_beat(s);
        if (status >= 0 && study_decided(&watch, &run.world) && !s->whole) break;
    }
    if (status < 0) mpm_io_fault_text(message, n, &run.world.fault);
    else study_measure(&run, c, &watch, value);
    value[STUDY_CPU] = study_seconds(begun);
    impact_end(&run);
    return status < 0 ? 0 : stop_asked() ? -1 : 1;
}

/* ---- finished runs ------------------------------------------------------------------------- */

/* folder/runs/<hash of the key>.json, or "" where that is too long. Returns path. */
static inline const char *study_path(const study *s, const char *key, char *path, size_t n)
{
    return kept_path(s->folder, "runs", key, ".json", path, n);
}

/* Reads a finished run. Returns 1 if it is there, whole and of this very case; -1 if its file is there and is not. */
static inline int study_look(const study *s, const impact_case *c, double *value)
{
    char path[PATH_BYTES], text[12000], *key = study_key(c, s->whole);
    int whole, found;
    if (!key) return 0;
    study_path(s, key, path, sizeof path);
    whole = text_read(path, text, sizeof text);
    found = kept_take(text, HASH_NONE, key, study_name, value, STUDY_VALUES);
    free(key);
    return found ? 1 : whole && !*text ? 0 : -1;
}

static inline int study_find(const study *s, const impact_case *c, double *value)
{
    return study_look(s, c, value) > 0;
}

static inline int study_keep(const study *s, const impact_case *c, const double *value, char *message, size_t n)
{
    char path[PATH_BYTES], *key = study_key(c, s->whole);
    mpm_fault fault;
    int kept = key != NULL && mpm_io_make_directory(file_in(s->folder, "runs", path, sizeof path), &fault) >= 0;
    if (kept) {
        study_path(s, key, path, sizeof path);
        kept = kept_write(path, HASH_NONE, key, study_name, value, STUDY_VALUES, &fault);
    }
    free(key);
    if (!kept) snprintf(message, n, "cannot write %.300s", *path ? path : "a path that is too long");
    return kept;
}

/* The values of a case: from the store, or by running it now. Returns 1; 0 with a message; -1 when the
   limit of new runs is reached, or when asked to stop: the run under way is then lost, the finished ones are kept. */
static inline int study_need(study *s, const impact_case *c, double *value, char *message, size_t n)
{
    const int found = study_look(s, c, value);
    clock_t begun;
    int status;
    if (found > 0) {
        s->done++;
        return 1;
    }
    if (s->limit >= 0 && s->fresh >= s->limit) return -1;
    if (found < 0)
        fprintf(stderr, "%s/runs: the record of %g um at %g m/s is damaged or of another case: run again\n", s->folder,
                c->diameter, c->velocity);
    begun = clock();
    study_start(s);
    snprintf(s->label, sizeof s->label, "%g um at %g m/s", c->diameter, c->velocity);
    if ((status = study_run(s, c, value, message, n)) <= 0) return status;
    if (!study_keep(s, c, value, message, n)) return 0;
    s->spent += study_seconds(begun);
    s->fresh++;
    s->done++;
    return 1;
}

/* The same, but for a run that another process is making in this folder: then it returns 2, and nothing is done. */
static inline int study_share(study *s, const impact_case *c, double *value, char *message, size_t n)
{
    char path[PATH_BYTES], *key = study_look(s, c, value) == 0 ? study_key(c, s->whole) : NULL;
    mpm_fault fault;
    claim k;
    int status = 2;
    if (!key) return study_need(s, c, value, message, n);
    mpm_io_make_directory(file_in(s->folder, "claims", path, sizeof path), &fault);
    k = claim_look(s->folder, key, STUDY_DEAD);
    if (!k.alive && claim_take(&k) != 0) { /* where nothing can be written the run says so itself */
        s->claim = &k;
        s->beat = time(NULL);
        status = study_need(s, c, value, message, n);
        s->claim = NULL;
        if (status <= 0) claim_release(&k);
    }
    free(key);
    return status;
}

#endif
