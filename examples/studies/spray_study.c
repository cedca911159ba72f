/* spray_study - what source B reports about its spray (its Figs. 6 to 10), run again.

   The paper shows its results as figures only, so trends are compared, not numbers; where its text
   is open, several readings are tried. Every finished run is a line of LOG: a study that was cut
   off goes on where it stopped. Ends with tables and pictures in --data and the section --report,
   paper and result side by side. Budget "quick": a few minutes, one seed, runs too short for
   more than a look; "full": about a quarter of an hour on one core, three seeds where scatter matters.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_spray.h"

#include <stdarg.h>

#include "plots.h"
#include "program.h"
#include "spray_view.h"
#include "terminal.h"

static const char *const program = "examples/studies/spray_study.c";

/* ---- cases and runs ------------------------------------------------------------------------ */

/* The readings of the paper's open points. In all of them V is the speed that is varied. */
enum { BOTH, ALWAYS, IGNORED, RELEASE, AXISYMMETRIC, READINGS };

static const char *const reading_text[READINGS] = {
    "gas V, release 0 to V; deposit sticks by the same criterion",
    "gas V, release 0 to V; deposit always sticks",
    "gas V, release 0 to V; deposit is not felt",
    "gas 50 m/s, release 0 to V; deposit sticks by the same criterion",
    "as the first, with the divergence-free axisymmetric jet"};

typedef struct run_case {
    int reading;
    double speed, alpha, shape, low, high; /* release between low and high */
    long seed;
    double time;
} run_case;

#define TIMES 20 /* deposited(t) is kept at so many equal times */
enum { FRACTION, RATE, SPREAD, SCATTER, THICKNESS, VOLUME, VOLUME5, VOLUME10, COLLISIONS, COLLIDED, IMPACT,
       IMPACT_SD, FIRST, INJECTED, DEPOSITED, WORK, CPU, COUNTS, VALUES = COUNTS + TIMES };

static const char *const value_name[COUNTS] = {
    "deposit_fraction", "late_rate_over_feed", "mean_spread_m", "scatter_m", "thickness_m", "volume_fraction",
    "volume_r5mm_m3", "volume_r10mm_m3", "collisions_per_particle", "collided_fraction", "impact_speed_mean_m_s",
    "impact_speed_sd_m_s", "first_hit_stuck_fraction", "injected", "deposited", "particle_steps", "cpu_s"};

typedef struct record {
    run_case c;
    double value[VALUES];
} record;

#define RECORDS 2000
#define ALPHAS 8
#define SPEEDS 3

static const double alphas[ALPHAS] = {2e3, 5e3, 1e4, 2e4, 5e4, 1e5, 2e5, 1e6};
static const double speeds[SPEEDS] = {30, 50, 80};

/* The study: its records, its budget, its places. */
typedef struct study {
    record *records;
    int count;
    double time;   /* of a run [s] */
    int seeds;
    const char *log, *data, *report, *budget;
    int quiet, planned, done, fresh;
    progress line;
} study;

static int same_case(const run_case *a, const run_case *b)
{
    return a->reading == b->reading && a->speed == b->speed && a->alpha == b->alpha && a->shape == b->shape &&
           a->low == b->low && a->high == b->high && a->seed == b->seed && a->time == b->time;
}

static mpm_spray_desc description(const run_case *c)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    d.gas_speed = c->reading == RELEASE ? 50 : (mpm_real)c->speed;
    d.release[0] = (mpm_real)c->low;
    d.release[1] = (mpm_real)c->high;
    d.alpha = (mpm_real)c->alpha;
    d.size_shape = (mpm_real)c->shape;
    d.seed = (uint64_t)c->seed;
    d.capacity = (int32_t)(c->time * (double)d.feed) + 200;
    if (c->reading == ALWAYS) d.deposit = MPM_SPRAY_DEPOSIT_ALWAYS;
    if (c->reading == IGNORED) d.deposit = MPM_SPRAY_DEPOSIT_IGNORE;
    if (c->reading == AXISYMMETRIC) d.gas = MPM_SPRAY_GAS_AXISYMMETRIC;
    return d;
}

/* The fault in words, of what is under way. */
static int fail(const mpm_fault *fault, const char *what)
{
    report(fault, what);
    return -1;
}

/* Begins a spray. Returns 0, or -1 after a message. */
static int begin(mpm_spray *s, const mpm_spray_desc *d)
{
    return mpm_spray_init(s, d, NULL, 0) < 0 ? fail(&s->fault, "spray") : 0;
}

/* Runs s to time t. Returns 0, or -1 after a message. */
static int run_to(mpm_spray *s, double t)
{
    int64_t steps = (int64_t)(t / (double)s->desc.dt + 0.5);
    while (s->tally.step < steps)
        if (mpm_spray_step(s) < 0) return fail(&s->fault, "spray");
    return 0;
}

static void measure(const mpm_spray *s, double cpu, double *v)
{
    mpm_spray_metrics m;
    mpm_spray_measure(s, &m);
    v[FRACTION] = m.deposit_fraction;
    v[RATE] = m.late_rate_over_feed;
    v[SPREAD] = m.mean_spread;
    v[SCATTER] = m.scatter;
    v[THICKNESS] = m.thickness;
    v[VOLUME] = m.volume_fraction;
    v[VOLUME5] = m.volume_r5mm;
    v[VOLUME10] = m.volume_r10mm;
    v[COLLISIONS] = m.collisions_per_particle;
    v[COLLIDED] = m.collided_fraction;
    v[IMPACT] = m.impact_speed_mean;
    v[IMPACT_SD] = m.impact_speed_sd;
    v[FIRST] = m.first_hit_stuck_fraction;
    v[INJECTED] = (double)m.injected;
    v[DEPOSITED] = (double)m.deposited;
    v[WORK] = (double)s->tally.particle_steps;
    v[CPU] = cpu;
}

/* Carries out one case. Returns 0, or -1 after a message. */
static int run_one(const run_case *c, double *value)
{
    mpm_spray s;
    mpm_spray_desc d = description(c);
    clock_t begun = clock();
    int k, failed = 0;
    if (begin(&s, &d)) return -1;
    for (k = 0; k < TIMES && !failed; k++) {
        failed = run_to(&s, c->time * (k + 1) / TIMES);
        value[COUNTS + k] = (double)s.tally.deposited;
    }
    measure(&s, (double)(clock() - begun) / CLOCKS_PER_SEC, value);
    mpm_spray_free(&s);
    return failed;
}

/* ---- the log ------------------------------------------------------------------------------- */

#define RECORD_BYTES (40 * (8 + VALUES) + 40)

static size_t put_number(char *line, size_t used, double value)
{
    char number[40];
    mpm_io_number_text(number, sizeof number, value);
    used = mpm_append(line, RECORD_BYTES, used, number);
    return mpm_append(line, RECORD_BYTES, used, " ");
}

static size_t put_sum(char *line, size_t used)
{
    char text[HASH_DIGITS];
    used = mpm_append(line, RECORD_BYTES, used, hash_digits(hash_text(HASH_NONE, line), text));
    return mpm_append(line, RECORD_BYTES, used, "\n");
}

/* A run as a line: the case, the values, and behind them the checksum of all that stands before it. */
static void record_line(const record *r, char line[RECORD_BYTES])
{
    const double of_case[8] = {r->c.reading, r->c.speed, r->c.alpha, r->c.shape,
                               r->c.low,     r->c.high,  (double)r->c.seed, r->c.time};
    size_t used = 0;
    int k;
    for (k = 0; k < 8; k++) used = put_number(line, used, of_case[k]);
    for (k = 0; k < VALUES; k++) used = put_number(line, used, r->value[k]);
    put_sum(line, used);
}

/* Reads such a line. Returns 1, or 0 if a byte of it is missing or another. */
static int record_of(const char *line, record *r)
{
    char again[RECORD_BYTES], *at = (char *)line;
    double c[8];
    int k;
    for (k = 0; k < 8; k++) c[k] = strtod(at, &at);
    for (k = 0; k < VALUES; k++) r->value[k] = strtod(at, &at);
    if (!(fabs(c[0]) < READINGS) || !(fabs(c[6]) < 1e9)) return 0;
    r->c.reading = (int)c[0];
    r->c.speed = c[1];
    r->c.alpha = c[2];
    r->c.shape = c[3];
    r->c.low = c[4];
    r->c.high = c[5];
    r->c.seed = (long)c[6];
    r->c.time = c[7];
    record_line(r, again);
    return strcmp(line, again) == 0;
}

/* Appends one finished run, on a line of its own also where the last one was cut short. Returns 0, or -1 after a
   message. */
static int log_write(const study *st, const record *r)
{
    FILE *f = fopen(st->log, "ab+");
    char line[RECORD_BYTES];
    int bad, cut = 0;
    if (!f) return fprintf(stderr, "error: cannot write %s\n", st->log), -1;
    if (fseek(f, -1, SEEK_END) == 0) cut = fgetc(f) != '\n';
    record_line(r, line);
    bad = fseek(f, 0, SEEK_END) != 0 || (cut && fputs("\n", f) == EOF) || fputs(line, f) == EOF;
    if (fclose(f) || bad) return fprintf(stderr, "error: cannot write %s\n", st->log), -1;
    return 0;
}

/* Takes a line of the log; one that is no record is left out, and its run made again. */
static void log_take(study *st, const char *line, size_t length)
{
    record *r = &st->records[st->count];
    if (strlen(line) == length && record_of(line, r)) st->count++;
    else fprintf(stderr, "%s: a line is damaged: what it held is run again\n", st->log);
}

/* Reads what earlier runs of the study have finished. Returns 0, or -1 after a message. */
static int log_read(study *st)
{
    char line[RECORD_BYTES];
    size_t n = 0;
    int c, bad;
    FILE *f;
    errno = 0;
    f = fopen(st->log, "rb");
    if (!f && errno == ENOENT) return 0;
    if (!f) return fprintf(stderr, "error: cannot read %s\n", st->log), -1;
    while (st->count < RECORDS && (c = fgetc(f)) != EOF) {
        if (n + 1 < sizeof line) line[n++] = (char)c; /* too long: no record either */
        line[n] = 0;
        if (c != '\n') continue;
        log_take(st, line, n);
        n = 0;
    }
    if (n > 0) log_take(st, line, n);
    bad = ferror(f);
    fclose(f);
    return bad ? fprintf(stderr, "error: cannot read %s\n", st->log), -1 : 0;
}

static const record *find(const study *st, const run_case *c)
{
    int k;
    for (k = 0; k < st->count; k++)
        if (same_case(&st->records[k].c, c)) return &st->records[k];
    return NULL;
}

/* "run 12 of 40, left 2:10", by the runs that were made now. */
static void show(study *st)
{
    const double left = progress_elapsed(&st->line) / st->fresh * (st->planned - st->done);
    char line[100];
    if (!progress_due(&st->line, (double)st->done / st->planned)) return;
    snprintf(line, sizeof line, "run %d of %d, left %.0f:%02d", st->done, st->planned, floor(left / 60),
             (int)fmod(left, 60));
    progress_show(&st->line, line);
}

/* Does a case unless it has been done. Returns 0, or -1 after a message. */
static int need(study *st, const run_case *c)
{
    record *r = &st->records[st->count];
    st->done++;
    if (find(st, c)) return 0;
    if (st->count == RECORDS) return fprintf(stderr, "error: %s is full\n", st->log), -1;
    r->c = *c;
    if (run_one(c, r->value) || log_write(st, r)) return -1;
    st->count++;
    st->fresh++;
    show(st);
    return 0;
}

/* ---- the plan ------------------------------------------------------------------------------ */

static run_case basic(const study *st, double speed, double alpha, long seed)
{
    run_case c;
    c.reading = BOTH;
    c.speed = speed;
    c.alpha = alpha;
    c.shape = 5;
    c.low = 0;
    c.high = speed;
    c.seed = seed;
    c.time = st->time;
    return c;
}

static const double shapes[5] = {1, 2, 3, 5, 10};
static const double half_ranges[3] = {0, 12.5, 25}; /* release velocity 25 +- this */

/* Every case of the study at this alpha: counted (count_only), or done. */
static int plan_alpha(study *st, double alpha, int count_only)
{
    int reading, k, n = 0;
    long seed;
    for (reading = 0; reading < READINGS; reading++)
        for (k = 0; k < SPEEDS; k++)
            for (seed = 1; seed <= (reading == BOTH ? st->seeds : 1); seed++, n++) {
                run_case c = basic(st, speeds[k], alpha, seed);
                c.reading = reading;
                if (!count_only && need(st, &c)) return -1;
            }
    for (k = 0; k < 5; k++, n++) {
        run_case c = basic(st, 50, alpha, 1);
        c.shape = shapes[k];
        if (!count_only && need(st, &c)) return -1;
    }
    for (k = 0; k < 3; k++)
        for (seed = 1; seed <= st->seeds; seed++, n++) {
            run_case c = basic(st, 50, alpha, seed);
            c.low = 25 - half_ranges[k];
            c.high = 25 + half_ranges[k];
            if (!count_only && need(st, &c)) return -1;
        }
    return n;
}

static int plan(study *st)
{
    int k;
    st->planned = ALPHAS * plan_alpha(st, alphas[0], 1);
    for (k = 0; k < ALPHAS; k++)
        if (plan_alpha(st, alphas[k], 0) < 0) return -1;
    progress_end(&st->line);
    return 0;
}

/* Mean of a value over the seeds of a case. */
static double mean(const study *st, run_case c, int seeds, int value)
{
    double sum = 0;
    for (c.seed = 1; c.seed <= seeds; c.seed++) {
        const record *r = find(st, &c);
        sum += r ? r->value[value] / seeds : 0;
    }
    return sum;
}

/* The main table: reading, speed and alpha by number. */
static double of(const study *st, int reading, int speed, int alpha, int value)
{
    run_case c = basic(st, speeds[speed], alphas[alpha], 1);
    c.reading = reading;
    return mean(st, c, reading == BOTH ? st->seeds : 1, value);
}

static double of_shape(const study *st, int shape, int alpha, int value)
{
    run_case c = basic(st, 50, alphas[alpha], 1);
    c.shape = shapes[shape];
    return mean(st, c, 1, value);
}

static double of_range(const study *st, int range, int alpha, int value)
{
    run_case c = basic(st, 50, alphas[alpha], 1);
    c.low = 25 - half_ranges[range];
    c.high = 25 + half_ranges[range];
    return mean(st, c, st->seeds, value);
}

/* ---- tables and plots ---------------------------------------------------------------------- */

static mpm_status write_table(const study *st, mpm_fault *fault)
{
    char path[PATH_BYTES],
         columns[1024] = "reading,speed_m_s,alpha,size_shape,release_low_m_s,release_high_m_s,seed,time_s";
    mpm_io_csv csv;
    mpm_status status;
    int k, n;
    for (k = 0; k < CPU; k++) { /* CPU time and what follows are not results */
        strcat(columns, ",");
        strcat(columns, value_name[k]);
    }
    file_in(st->data, "spray_runs.csv", path, sizeof path);
    if ((status = mpm_io_csv_begin(&csv, path, columns, program, fault)) < 0) return status;
    for (n = 0; n < st->count; n++) {
        const run_case *c = &st->records[n].c;
        if (c->time != st->time) continue;
        mpm_io_csv_text(&csv, reading_text[c->reading]);
        mpm_io_csv_real(&csv, (mpm_real)c->speed);
        mpm_io_csv_real(&csv, (mpm_real)c->alpha);
        mpm_io_csv_real(&csv, (mpm_real)c->shape);
        mpm_io_csv_real(&csv, (mpm_real)c->low);
        mpm_io_csv_real(&csv, (mpm_real)c->high);
        mpm_io_csv_integer(&csv, c->seed);
        mpm_io_csv_real(&csv, (mpm_real)c->time);
        for (k = 0; k < CPU; k++) mpm_io_csv_real(&csv, (mpm_real)st->records[n].value[k]);
    }
    return mpm_io_csv_end(&csv, fault);
}

#define CURVES 8

/* One panel: up to CURVES curves over common points. */
typedef struct panel {
    mpm_real x[TIMES], y[CURVES][TIMES];
    mpm_draw_curve curve[CURVES];
    char name[CURVES][40];
    mpm_draw_plot_desc d;
} panel;

static void panel_begin(panel *p, const char *title, const char *x_label, const char *y_label)
{
    memset(p, 0, sizeof *p);
    p->d = plot_of(title, x_label, y_label, p->curve, 0);
}

static void panel_curve(panel *p, int points, const char *format, double number)
{
    int k = p->d.curve_count++;
    snprintf(p->name[k], sizeof p->name[k], format, number);
    p->curve[k] = plot_curve(p->name[k], p->x, p->y[k], (size_t)points, MPM_DRAW_CURVE, k);
}

/* A value over alpha, one curve per speed. */
static void panel_of_speeds(panel *p, const study *st, int value, double scale, const char *title, const char *label)
{
    int k, a;
    panel_begin(p, title, "alpha", label);
    p->d.log_x = 1;
    for (k = 0; k < SPEEDS; k++) {
        for (a = 0; a < ALPHAS; a++) {
            p->x[a] = (mpm_real)alphas[a];
            p->y[k][a] = (mpm_real)(of(st, BOTH, k, a, value) * scale);
        }
        panel_curve(p, ALPHAS, "%g m/s", speeds[k]);
    }
}

#define PANELS 6

static mpm_status draw_panels(const char *path, const panel *p, int count, mpm_fault *fault)
{
    mpm_draw_plot_desc d[PANELS];
    int k;
    for (k = 0; k < count; k++) d[k] = p[k].d;
    return plots_png(path, d, count, 2, 420, program, fault);
}

static mpm_status plot_b7(const study *st, mpm_fault *fault)
{
    static panel p[4];
    char path[PATH_BYTES];
    panel_of_speeds(&p[0], st, VOLUME, 1, "volume fraction", "of the pellet");
    panel_of_speeds(&p[1], st, THICKNESS, 1 / 80e-6, "thickness", "/ median radius");
    panel_of_speeds(&p[2], st, SPREAD, 1e3, "mean spread", "mm");
    panel_of_speeds(&p[3], st, SCATTER, 1e3, "scatter in spread", "mm");
    file_in(st->data, "spray_b7.png", path, sizeof path);
    return draw_panels(path, p, 4, fault);
}

static void panel_of_times(panel *p, const study *st, const char *title)
{
    int k;
    panel_begin(p, title, "time, ms", "deposited");
    for (k = 0; k < TIMES; k++) p->x[k] = (mpm_real)(st->time * 1e3 * (k + 1) / TIMES);
}

static mpm_status plot_b9(const study *st, mpm_fault *fault)
{
    static panel p[PANELS];
    char path[PATH_BYTES];
    int k, a, t;
    panel_of_speeds(&p[0], st, FRACTION, 1, "deposit fraction, by speed", "deposited / injected");
    panel_begin(&p[1], "deposit fraction, by size shape n", "alpha", "deposited / injected");
    panel_begin(&p[2], "deposit fraction, by release velocity", "alpha", "deposited / injected");
    for (k = 0; k < 5; k++) {
        for (a = 0; a < ALPHAS; a++) p[1].y[k][a] = (mpm_real)of_shape(st, k, a, FRACTION);
        panel_curve(&p[1], ALPHAS, "n = %g", shapes[k]);
    }
    for (k = 0; k < 3; k++) {
        for (a = 0; a < ALPHAS; a++) p[2].y[k][a] = (mpm_real)of_range(st, k, a, FRACTION);
        panel_curve(&p[2], ALPHAS, "25 +- %g m/s", half_ranges[k]);
    }
    for (a = 0; a < ALPHAS; a++) p[1].x[a] = p[2].x[a] = (mpm_real)alphas[a];
    p[1].d.log_x = p[2].d.log_x = 1;
    panel_of_times(&p[3], st, "deposited over time, by n, alpha 1e5");
    for (k = 0; k < 5; k++) {
        for (t = 0; t < TIMES; t++) p[3].y[k][t] = (mpm_real)of_shape(st, k, 5, COUNTS + t);
        panel_curve(&p[3], TIMES, "n = %g", shapes[k]);
    }
    panel_of_speeds(&p[4], st, RATE, 1, "growth rate / feed, late", "");
    panel_of_times(&p[5], st, "deposited over time, by alpha, 50 m/s");
    for (a = 0; a < ALPHAS; a++) {
        for (t = 0; t < TIMES; t++) p[5].y[a][t] = (mpm_real)of(st, BOTH, 1, a, COUNTS + t);
        panel_curve(&p[5], TIMES, "alpha %g", alphas[a]);
    }
    file_in(st->data, "spray_b9.png", path, sizeof path);
    return draw_panels(path, p, 6, fault);
}

/* The pictures of Figs. 8 and 10, and what they are drawn from. */
typedef struct gallery {
    mpm_draw_canvas plume, top;
    spray_columns columns;
} gallery;

/* One case in both pictures. Returns 0, or -1 after a message. */
static int draw_case(const study *st, gallery *g, int k, int low)
{
    run_case c = basic(st, speeds[k], low ? 1e6 : 1e4, 1);
    mpm_spray_desc d = description(&c);
    mpm_spray s;
    mpm_fault fault;
    char title[80];
    int failed;
    if (begin(&s, &d)) return -1;
    snprintf(title, sizeof title, "%g m/s, alpha %g", speeds[k], c.alpha);
    failed = run_to(&s, c.time);
    if (!failed && s.deposited > 0 &&
        spray_draw_deposit(&g->top, mpm_draw_tile(&g->top, SPEEDS, 2, low * SPEEDS + k), &s, &g->columns, 20, title,
                           &fault) < 0)
        failed = fail(&fault, "picture of the deposit");
    if (!failed && low &&
        spray_draw_plume(&g->plume, mpm_draw_tile(&g->plume, 1, SPEEDS, k), &s, &g->columns, speeds[k], title,
                         &fault) < 0)
        failed = fail(&fault, "picture of the plume");
    mpm_spray_free(&s);
    return failed;
}

static int write_picture(const study *st, const char *name, const mpm_draw_canvas *c)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    file_in(st->data, name, path, sizeof path);
    return mpm_io_png(path, c->rgb, c->width, c->height, program, &fault) < 0 ? fail(&fault, path) : 0;
}

/* These pictures need the particles: the runs are made again, short of resumable. Returns 0, or -1 after a message. */
static int pictures(const study *st)
{
    gallery g;
    int k, failed = 0;
    memset(&g, 0, sizeof g);
    if (mpm_draw_canvas_init(&g.plume, 1300, 1560, NULL, 0) < 0 ||
        mpm_draw_canvas_init(&g.top, 1560, 1160, NULL, 0) < 0 || spray_columns_init(&g.columns, 60000))
        failed = complain("no memory for pictures") - 1;
    for (k = 0; k < 2 * SPEEDS && !failed; k++) failed = draw_case(st, &g, k / 2, k % 2);
    if (!failed) failed = write_picture(st, "spray_b8.png", &g.plume);
    if (!failed) failed = write_picture(st, "spray_b10.png", &g.top);
    mpm_draw_canvas_free(&g.plume);
    mpm_draw_canvas_free(&g.top);
    spray_columns_free(&g.columns);
    return failed;
}

/* ---- the long run and the cost ------------------------------------------------------------- */

typedef struct long_run {
    double cpu, megabytes, per_second;
    double inside_10mm, beyond_20mm; /* parts of the deposit */
    mpm_spray_metrics m;
    int64_t not_converged;
} long_run;

/* What the spray of the long run shows at its end. */
static void measure_long(const mpm_spray *s, double cpu, long_run *r)
{
    int32_t i;
    r->cpu = cpu;
    r->megabytes = (double)s->bytes / 1e6;
    r->per_second = (double)s->tally.particle_steps * (double)s->desc.dt / cpu;
    r->not_converged = s->tally.not_converged;
    r->inside_10mm = r->beyond_20mm = 0;
    mpm_spray_measure(s, &r->m);
    for (i = 0; i < s->deposited; i++) {
        double distance = hypot((double)s->deposit_x[3 * i + 1], (double)s->deposit_x[3 * i + 2]);
        r->inside_10mm += (distance <= 0.0105) / (double)s->deposited;
        r->beyond_20mm += (distance > 0.02) / (double)s->deposited;
    }
}

/* B-6: 50 050 particles at alpha 1e5. Returns 0, or -1 after a message. */
static int run_long(long_run *r)
{
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    clock_t begun;
    int failed;
    if (begin(&s, &d)) return -1;
    begun = clock();
    failed = run_to(&s, 0.5005);
    if (!failed) measure_long(&s, (double)(clock() - begun) / CLOCKS_PER_SEC, r);
    mpm_spray_free(&s);
    return failed;
}

/* Nanoseconds per particle-step between 20 and 30 ms, when the plume has filled; NaN after a message. */
static double cost(double feed)
{
    mpm_spray s;
    mpm_spray_desc d = mpm_spray_desc_default();
    clock_t begun;
    double work = 0, cpu = 0;
    int failed;
    d.feed = (mpm_real)feed;
    d.capacity = 40000;
    if (begin(&s, &d)) return NAN;
    failed = run_to(&s, 0.02);
    if (!failed) {
        work = (double)s.tally.particle_steps;
        begun = clock();
        failed = run_to(&s, 0.03);
        cpu = (double)(clock() - begun) / CLOCKS_PER_SEC;
        work = (double)s.tally.particle_steps - work;
    }
    mpm_spray_free(&s);
    return failed ? NAN : 1e9 * cpu / work;
}

/* ---- the report ---------------------------------------------------------------------------- */

/* Whether the value falls from 30 over 50 to 80 m/s at one alpha. */
static int falls(const study *st, int reading, int alpha, int value)
{
    return of(st, reading, 0, alpha, value) > of(st, reading, 1, alpha, value) &&
           of(st, reading, 1, alpha, value) > of(st, reading, 2, alpha, value);
}

/* At how many of the alphas the value goes down (sign -1) or up (+1) from 30 over 50 to 80 m/s, by
   more than 1 % between the ends. */
static int ordered(const study *st, int reading, int value, int sign)
{
    int a, n = 0;
    for (a = 0; a < ALPHAS; a++) {
        double v30 = of(st, reading, 0, a, value), v50 = of(st, reading, 1, a, value),
               v80 = of(st, reading, 2, a, value);
        n += sign * (v50 - v30) >= 0 && sign * (v80 - v50) >= 0 && sign * (v80 - v30) > 0.01 * fabs(v30);
    }
    return n;
}

/* At how many of the alphas 50 m/s has the highest value of the three. */
static int moderate_highest(const study *st, int reading, int value)
{
    int a, n = 0;
    for (a = 0; a < ALPHAS; a++)
        n += of(st, reading, 1, a, value) > of(st, reading, 0, a, value) &&
             of(st, reading, 1, a, value) > of(st, reading, 2, a, value);
    return n;
}

static const char *verdict(int good, int all)
{
    return good == all ? "comes back" : 2 * good < all ? "does not come back" : "comes back in part";
}

/* One row of the section's table. */
static void row(FILE *f, const char *id, const char *statement, const char *result, const char *judgement)
{
    fprintf(f, "| %s | %s | %s | %s |\n", id, statement, result, judgement);
}

static char *words(const char *format, ...)
{
    static char buffer[8][1000];
    static int next;
    char *b = buffer[next++ % 8];
    va_list list;
    va_start(list, format);
    vsnprintf(b, sizeof buffer[0], format, list);
    va_end(list);
    return b;
}

/* "30.1 / 50.2 / 80.3": a value at the three speeds. */
static char *three(const study *st, int reading, int alpha, int value, double scale)
{
    return words("%.3g / %.3g / %.3g", of(st, reading, 0, alpha, value) * scale,
                 of(st, reading, 1, alpha, value) * scale, of(st, reading, 2, alpha, value) * scale);
}

static void report_b7(FILE *f, const study *st)
{
    int k, n = ordered(st, BOTH, FRACTION, -1), all = ALPHAS;
    row(f, "B-7", "slower streams: deposition is more probable",
        words("at alpha 1e4 %s %% of the injected are deposited at 30 / 50 / 80 m/s; in this order at %d of %d alphas. "
              "Of the first touches %s %% stick, in this order at %d",
              three(st, BOTH, 2, FRACTION, 100), n, all, three(st, BOTH, 2, FIRST, 100), ordered(st, BOTH, FIRST, -1)),
        verdict(ordered(st, BOTH, FIRST, -1), all));
    n = ordered(st, BOTH, SCATTER, -1);
    row(f, "B-7", "slower streams: more scatter",
        words("standard deviation of the spread at alpha 1e4 %s mm, at 1e6 %s mm; falls with speed at %d of %d alphas",
              three(st, BOTH, 2, SCATTER, 1e3), three(st, BOTH, 7, SCATTER, 1e3), n, all), verdict(n, all));
    for (k = 0; k < READINGS; k++) {
        n = moderate_highest(st, k, VOLUME);
        row(f, "B-7", words("volume fraction highest at the moderate speed; reading: %s", reading_text[k]),
            words("50 m/s is highest at %d of %d alphas (volume within 10 mm: at %d); at 1e4 %s, at 1e5 %s, at 1e6 %s "
                  "(x 1e-3)", n, all, moderate_highest(st, k, VOLUME10), three(st, k, 2, VOLUME, 1e3),
                  three(st, k, 5, VOLUME, 1e3), three(st, k, 7, VOLUME, 1e3)), verdict(n, all));
    }
    row(f, "B-7", "thickness and mean spread over alpha (figure only)",
        words("thickness / median radius at 1e4 %s, at 1e6 %s; mean spread at 1e4 %s mm, at 1e6 %s mm",
              three(st, BOTH, 2, THICKNESS, 1 / 80e-6), three(st, BOTH, 7, THICKNESS, 1 / 80e-6),
              three(st, BOTH, 2, SPREAD, 1e3), three(st, BOTH, 7, SPREAD, 1e3)), "no statement to compare");
}

static void report_b8_b10(FILE *f, const study *st)
{
    row(f, "B-8", words("slower release: more collisions, particles scatter more; reading: %s", reading_text[BOTH]),
        words("particles that collided on the way, alpha 1e6 (nothing comes back from the target): %s %%",
              three(st, BOTH, 7, COLLIDED, 100)), verdict(falls(st, BOTH, 7, COLLIDED), 1));
    row(f, "B-8", words("the same; reading: %s", reading_text[RELEASE]),
        words("%s %%", three(st, RELEASE, 7, COLLIDED, 100)), verdict(falls(st, RELEASE, 7, COLLIDED), 1));
    row(f, "B-10", "low deposition factor: faster streams rebound more",
        words("stuck at first touch, alpha 5e3: %s %%", three(st, BOTH, 1, FIRST, 100)),
        verdict(falls(st, BOTH, 1, FIRST), 1));
    row(f, "B-10", "high factor: the pattern becomes more uniform with speed",
        words("scatter of the spread, alpha 1e6: %s mm", three(st, BOTH, 7, SCATTER, 1e3)),
        verdict(falls(st, BOTH, 7, SCATTER), 1));
}

/* What the deposit fraction at one speed gains between two alphas. */
static double gain(const study *st, int speed, int from, int to)
{
    return of(st, BOTH, speed, to, FRACTION) - of(st, BOTH, speed, from, FRACTION);
}

static void report_threshold(FILE *f, const study *st)
{
    int k, flat = 0;
    for (k = 0; k < SPEEDS; k++) flat += gain(st, k, 0, 3) > 2 * gain(st, k, 5, 7); /* per decade */
    row(f, "B-9", "deposit fraction rises fast below the threshold alpha and flattens above",
        words("gained from 2e3 to 2e4 %.3g / %.3g / %.3g, from 1e5 to 1e6 %.3g / %.3g / %.3g at 30 / 50 / 80 m/s",
              gain(st, 0, 0, 3), gain(st, 1, 0, 3), gain(st, 2, 0, 3), gain(st, 0, 5, 7), gain(st, 1, 5, 7),
              gain(st, 2, 5, 7)), verdict(flat, SPEEDS));
}

/* By the width of the distributions of size and of release velocity. */
static void report_widths(FILE *f, const study *st)
{
    int a, fewer = 0, more = 0;
    double near_mono = 0, far_from_mono = 0;
    for (a = 0; a < ALPHAS; a++) {
        near_mono += fabs(of_shape(st, 3, a, FRACTION) - of_shape(st, 4, a, FRACTION)) / ALPHAS;
        far_from_mono += fabs(of_shape(st, 0, a, FRACTION) - of_shape(st, 3, a, FRACTION)) / ALPHAS;
        fewer += of_range(st, 2, a, FRACTION) < of_range(st, 0, a, FRACTION);
        more += of_range(st, 2, a, COLLISIONS) > of_range(st, 0, a, COLLISIONS);
    }
    row(f, "B-9", "narrower sizes behave more like a single size",
        words("deposit fractions of n = 1 and 5 differ by %.3g on average, those of n = 5 and 10 by %.3g; collided at "
              "alpha 1e6: %.3g %% for n = 1, %.3g %% for 5, %.3g %% for 10", far_from_mono, near_mono,
              100 * of_shape(st, 0, 7, COLLIDED), 100 * of_shape(st, 3, 7, COLLIDED),
              100 * of_shape(st, 4, 7, COLLIDED)), verdict(near_mono < far_from_mono, 1));
    row(f, "B-9", "more varied release velocities: more collisions, fewer deposited in a fixed time",
        words("release 25 m/s against 0 to 50 m/s: collisions per particle %.3g against %.3g at alpha 1e6 (more at "
              "%d of %d alphas), deposit fraction %.3g against %.3g (less at %d)",
              of_range(st, 0, 7, COLLISIONS), of_range(st, 2, 7, COLLISIONS), more, ALPHAS,
              of_range(st, 0, 7, FRACTION), of_range(st, 2, 7, FRACTION), fewer),
        verdict((more == ALPHAS) + (fewer == ALPHAS), 2));
}

/* What the late rate at 50 m/s gains from an alpha to the next. */
static double rate_step(const study *st, int alpha)
{
    return of(st, BOTH, 1, alpha + 1, RATE) - of(st, BOTH, 1, alpha, RATE);
}

static void report_rate(FILE *f, const study *st)
{
    int a, steepest = 0;
    for (a = 1; a < ALPHAS - 1; a++)
        if (rate_step(st, a) > rate_step(st, steepest)) steepest = a;
    row(f, "B-9", "the growth rate changes most in one range of alpha, the threshold",
        words("late rate over feed at 50 m/s: %.3g, %.3g, %.3g, %.3g, %.3g, %.3g, %.3g, %.3g from 2e3 to 1e6; the "
              "largest step is from %g to %g",
              of(st, BOTH, 1, 0, RATE), of(st, BOTH, 1, 1, RATE), of(st, BOTH, 1, 2, RATE),
              of(st, BOTH, 1, 3, RATE), of(st, BOTH, 1, 4, RATE), of(st, BOTH, 1, 5, RATE), of(st, BOTH, 1, 6, RATE),
              of(st, BOTH, 1, 7, RATE), alphas[steepest], alphas[steepest + 1]),
        verdict(rate_step(st, steepest) > (of(st, BOTH, 1, 7, RATE) - of(st, BOTH, 1, 0, RATE)) / 4, 1));
}

static int write_report(const study *st, const long_run *l, double once, double eightfold)
{
    mpm_io_file file;
    mpm_fault fault;
    FILE *f;
    if (mpm_io_open(&file, st->report, &fault) < 0)
        return fprintf(stderr, "error: cannot write %s\n", st->report), -1;
    f = file.stream;
    fprintf(f, "# The spray: source B beside ours\n\n"
               "Made by `build/spray_study --budget %s` (mpm.h %s). Each run lasts %g s of spray; %d seed%s for the "
               "first reading and for the release velocities, one elsewhere. The paper prints these results as "
               "figures, so trends are compared; what its text leaves open is settled in "
               "[spray_model.md](spray_model.md). All runs: `%s/spray_runs.csv`.\n\n",
            st->budget, MPM_VERSION, st->time, st->seeds, st->seeds > 1 ? "s" : "", st->data);
    fprintf(f, "| id | the paper says | here | verdict |\n|---|---|---|---|\n");
    row(f, "B-6", "50 050 particles: the run completes; scatter around a dense core",
        words("%lld injected, %lld deposited, %.3g %% of them within the nozzle's radius, %.3g %% beyond twice that",
              (long long)l->m.injected, (long long)l->m.deposited, 100 * l->inside_10mm, 100 * l->beyond_20mm),
        verdict(l->m.injected == 50050 && l->inside_10mm > 0.5 && l->beyond_20mm > 0, 1));
    report_b7(f, st);
    report_b8_b10(f, st);
    report_threshold(f, st);
    report_widths(f, st);
    report_rate(f, st);
    fprintf(f, "\n\"In part\" means: at half of the alphas or more, but not at every one. Pictures: "
               "[B-7](data/spray_b7.png), [B-8](data/spray_b8.png), "
               "[B-9](data/spray_b9.png), [B-10](data/spray_b10.png).\n\n");
    fprintf(f, "## Cost\n\n| what | asked | measured |\n|---|---|---|\n"
               "| the run of 50 050 particles, CPU s | < 120 | %.1f |\n| its memory, MB | < 100 | %.1f |\n"
               "| simulated particle-seconds per CPU second | >= 40 | %.1f |\n"
               "| iterations that did not converge | - | %lld |\n"
               "| ns per particle-step, feed 1e5 /s | - | %.0f |\n"
               "| the same at feed 8e5 /s | < 1.15 times | %.0f, %.2f times |\n",
            l->cpu, l->megabytes, l->per_second, (long long)l->not_converged, once, eightfold, eightfold / once);
    fprintf(f, "\nA particle-step is one particle moved by one step of %g us. It costs one evaluation of the gas and "
               "of the drag where the particle will be, for the fixed point starts so well, and the search for what it "
               "meets. Particles fly in blocks, so that a processor has several of these long chains of arithmetic in "
               "hand. Every step they are sorted into rows of bins, and the bins around a path are read without asking "
               "how many are in them; only where two are is a contact looked for. At eight times the feed there are "
               "eight times as many neighbours, still less than one for most, and more memory to walk through. "
               "Contacts are exact: `tests/53_spray_search.c` compares with every pair, byte by byte.\n",
            1e6 * (double)mpm_spray_desc_default().dt);
    if (mpm_io_close(&file, &fault) >= 0) return 0;
    return fprintf(stderr, "error: cannot write %s\n", st->report), -1;
}

/* ---- main ---------------------------------------------------------------------------------- */

/* Reads the command line: as options_parse. */
static int options(study *st, int argc, char **argv)
{
    option o[5];
    int n = 0;
    st->budget = "full";
    st->log = "build/spray_study.log";
    st->data = "docs/data";
    st->report = "docs/spray.md";
    option_add_word(o, &n, "budget", &st->budget, "quick|full", "a look, or a quarter of an hour");
    option_add(o, &n, "log", OPTION_TEXT, &st->log, "finished runs, to go on from");
    option_add(o, &n, "data", OPTION_TEXT, &st->data, "folder for tables and plots");
    option_add(o, &n, "report", OPTION_TEXT, &st->report, "the section to write");
    option_add(o, &n, "quiet", OPTION_FLAG, &st->quiet, "no progress");
    return options_parse(argc, argv, "Runs source B's results again and compares.", o, n);
}

static int carry_out(int argc, char **argv)
{
    static record records[RECORDS + 1];
    study st;
    mpm_fault fault = {MPM_OK, NULL, 0, -1};
    long_run l;
    double once, eightfold;
    int parsed;
    memset(&st, 0, sizeof st);
    st.records = records;
    if ((parsed = options(&st, argc, argv)) != 0) return parsed < 0;
    st.time = st.budget[0] == 'q' ? 0.02 : 0.06;
    st.seeds = st.budget[0] == 'q' ? 1 : 3;
    progress_begin(&st.line, st.quiet);
    if (mpm_io_make_directory(st.data, &fault) < 0) goto fail;
    if (log_read(&st) || plan(&st) || run_long(&l)) return 1;
    once = fmin(cost(1e5), cost(1e5));
    eightfold = fmin(cost(8e5), cost(8e5));
    if (isnan(once) || isnan(eightfold)) return 1;
    if (write_table(&st, &fault) < 0 || plot_b7(&st, &fault) < 0 || plot_b9(&st, &fault) < 0) goto fail;
    if (pictures(&st)) return 1;
    return write_report(&st, &l, once, eightfold) ? 1 : 0;
fail:
    report(&fault, st.data);
    return 1;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
