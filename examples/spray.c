/* spray - powder from a nozzle to a target: flight, collisions, deposition (source B, its Table 1).

   Run without options it is the paper's long run (its Fig. 6): 50 050 particles of median radius
   80 um, size shape 5, fed 50 per 0.5 ms into a jet of 50 m/s, released at 0 to 50 m/s, target at
   0.30 m. Expect about 76 % deposited at alpha 1e5 and an impact speed of about 29 m/s; it takes
   less than a minute. Everything goes into --out: summary.json, impacts.csv (one row per first
   impact: what is needed to simulate the impacts themselves), history.csv, a VTK series, and three pictures.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_spray.h"
#include "mpm_io.h"

#include "program.h"
#include "spray_history.h"
#include "spray_view.h"
#include "terminal.h"

/* ---- options ------------------------------------------------------------------------------- */

typedef struct settings {
    const char *gas, *release, *gamma12, *restitution, *contact, *deposit, *criterion, *out, *restart;
    double speed, alpha, friction, median_radius, shape, size_min, size_max, feed, dt, time, theta, box;
    double stand_off, critical, erosion, checkpoint;
    int64_t batch, particles, steps, seed, frames;
    int quiet, resume;
} settings;

static settings settings_default(void)
{
    settings o;
    memset(&o, 0, sizeof o);
    o.gas = "jet";
    o.speed = 50;
    o.release = "0:speed";
    o.alpha = 1e5;
    o.gamma12 = "dispersion";
    o.restitution = "johnson";
    o.friction = 0.55;
    o.median_radius = 80;
    o.shape = 5;
    o.size_min = 1;
    o.feed = 1e5;
    o.batch = 50;
    o.dt = 5e-6;
    o.time = 0.5005;
    o.theta = 0.5;
    o.contact = "swept";
    o.deposit = "stick";
    o.criterion = "adhesion";
    o.erosion = HUGE_VAL;
    o.box = 0.05;
    o.stand_off = 0.30;
    o.seed = 1;
    o.out = "build/spray-out";
    o.restart = "";
    o.frames = 20;
    return o;
}

#define OPTION_COUNT 33
#define CRITERIA "adhesion|window"

static int options_of(option *o, settings *s)
{
    int n = 0;
    option_add_word(o, &n, "gas", &s->gas, MPM_NAMES(MPM_SPRAY_GAS_LIST), "the flow");
    option_add(o, &n, "speed", OPTION_REAL, &s->speed, "of the gas at the nozzle, m/s");
    option_add(o, &n, "release", OPTION_TEXT, &s->release, "LOW:HIGH release velocity, uniform between, m/s");
    option_add(o, &n, "alpha", OPTION_REAL, &s->alpha, "adhesion factor alpha_ADH; inf: all stick");
    option_add(o, &n, "gamma12", OPTION_TEXT, &s->gamma12, "interface energy, J/m^2 | dispersion | difference");
    option_add(o, &n, "restitution", OPTION_TEXT, &s->restitution, "johnson | CONSTANT");
    option_add(o, &n, "friction", OPTION_REAL, &s->friction, "Coulomb coefficient");
    option_add(o, &n, "median-radius", OPTION_REAL, &s->median_radius, "um");
    option_add(o, &n, "shape", OPTION_REAL, &s->shape, "n of the size distribution");
    option_add(o, &n, "size-min", OPTION_REAL, &s->size_min, "smallest diameter, um");
    option_add(o, &n, "size-max", OPTION_REAL, &s->size_max, "largest diameter, um; 0: the nozzle radius");
    option_add(o, &n, "feed", OPTION_REAL, &s->feed, "particles/s");
    option_add(o, &n, "batch", OPTION_INTEGER, &s->batch, "particles injected together");
    option_add(o, &n, "particles", OPTION_INTEGER, &s->particles, "stop the feed after so many; 0: never");
    option_add(o, &n, "dt", OPTION_REAL, &s->dt, "time step, s");
    option_add(o, &n, "steps", OPTION_INTEGER, &s->steps, "how many; 0: as --time says");
    option_add(o, &n, "time", OPTION_REAL, &s->time, "end time, s");
    option_add(o, &n, "theta", OPTION_REAL, &s->theta, "0 explicit, 0.5 trapezoidal, 1 implicit");
    option_add_word(o, &n, "contact", &s->contact, MPM_NAMES(MPM_SPRAY_CONTACT_LIST), "along paths or at their end");
    option_add_word(o, &n, "deposit", &s->deposit, MPM_NAMES(MPM_SPRAY_DEPOSIT_LIST), "of one that hits the deposit");
    option_add_word(o, &n, "criterion", &s->criterion, CRITERIA, "window: of cold spray, aluminium");
    option_add(o, &n, "critical", OPTION_REAL, &s->critical, "window: critical velocity, m/s; 0: by size");
    option_add(o, &n, "erosion", OPTION_REAL, &s->erosion, "window: no bond above, m/s");
    option_add(o, &n, "stand-off", OPTION_REAL, &s->stand_off, "nozzle to target, m");
    option_add(o, &n, "box", OPTION_REAL, &s->box, "half width of the domain, m");
    option_add(o, &n, "seed", OPTION_INTEGER, &s->seed, "of the random numbers");
    option_add(o, &n, "out", OPTION_TEXT, &s->out, "folder for the results");
    option_add(o, &n, "frames", OPTION_INTEGER, &s->frames, "VTK files over the run; 0: none");
    option_add(o, &n, "restart", OPTION_TEXT, &s->restart, "go on from this checkpoint.bin to --steps or --time");
    option_add(o, &n, "resume", OPTION_FLAG, &s->resume, "go on from the one in the folder");
    option_add(o, &n, "checkpoint", OPTION_REAL, &s->checkpoint, "CPU seconds from one to the next; 0: at the end");
    option_add(o, &n, "quiet", OPTION_FLAG, &s->quiet, "no progress, no table");
    return n;
}

/* A number, the whole text. Returns 0, or -1 (no message). */
static int number(const char *text, const char *end_at, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end == text || end != end_at ? -1 : 0;
}

static int parse_release(const settings *o, mpm_real *release)
{
    const char *colon = strchr(o->release, ':');
    double low, high;
    release[0] = 0;
    release[1] = (mpm_real)o->speed;
    if (!strcmp(o->release, "0:speed")) return 0;
    if (!colon || number(o->release, colon, &low) || number(colon + 1, colon + strlen(colon), &high)) {
        fprintf(stderr, "error: --release needs LOW:HIGH, not '%s'\n", o->release);
        return -1;
    }
    release[0] = (mpm_real)low;
    release[1] = (mpm_real)high;
    return 0;
}

/* Words and numbers that share an option. */
static int parse_mixed(const settings *o, mpm_spray_desc *d)
{
    double v;
    if (!strcmp(o->gamma12, "difference")) {
        d->mixing = MPM_SPRAY_MIXING_DIFFERENCE;
    } else if (strcmp(o->gamma12, "dispersion")) {
        if (number(o->gamma12, o->gamma12 + strlen(o->gamma12), &v) || !(v > 0)) {
            fprintf(stderr, "error: --gamma12 must be dispersion, difference or above 0, not '%s'\n", o->gamma12);
            return -1;
        }
        d->gamma_target = (mpm_real)v;
    }
    if (strcmp(o->restitution, "johnson")) {
        if (number(o->restitution, o->restitution + strlen(o->restitution), &v) || !(v >= 0 && v <= 1)) {
            fprintf(stderr, "error: --restitution must be johnson or 0 to 1, not '%s'\n", o->restitution);
            return -1;
        }
        d->rebound = MPM_SPRAY_REBOUND_CONSTANT;
        d->restitution = (mpm_real)v;
    }
    return 0;
}

static void choose_criterion(const settings *o, mpm_spray_desc *d, mpm_spray_window *w)
{
    *w = mpm_spray_window_aluminium();
    w->erosion = (mpm_real)o->erosion;
    if (o->critical > 0) {
        w->critical = (mpm_real)o->critical;
        w->slope = 0;
    }
    if (word_place(CRITERIA, o->criterion) == 1) {
        d->stick = mpm_spray_stick_window;
        d->stick_user = w;
    }
}

static int bad_number(const char *name, double value, const char *want)
{
    fprintf(stderr, "error: --%s is %g, but must be %s\n", name, value, want);
    return -1;
}

/* The run's length in steps, and room for all that will be fed in it. */
static int parse_length(const settings *o, mpm_spray_desc *d, int64_t *steps)
{
    double count, most;
    if (strlen(o->out) + 64 > PATH_BYTES || strlen(o->restart) + 64 > PATH_BYTES) {
        fprintf(stderr, "error: --out and --restart must be shorter than %d bytes\n", PATH_BYTES - 64);
        return -1;
    }
    if (o->steps < 0) return bad_number("steps", (double)o->steps, "0 or more");
    if (o->steps == 0 && !(o->time > 0 && o->time < 1e9)) return bad_number("time", o->time, "above 0");
    if (o->frames < 0) return bad_number("frames", (double)o->frames, "0 or more");
    if (!(o->checkpoint >= 0)) return bad_number("checkpoint", o->checkpoint, "0 or more");
    if (o->batch < 1 || o->batch > 1000000) return bad_number("batch", (double)o->batch, "1 to 1e6");
    if (o->particles < 0) return bad_number("particles", (double)o->particles, "0 or more");
    if (!(o->dt > 0)) return bad_number("dt", o->dt, "above 0");
    if (!(o->feed > 0)) return bad_number("feed", o->feed, "above 0");
    if (!(o->box > 0)) return bad_number("box", o->box, "above 0");
    count = o->steps > 0 ? (double)o->steps : floor(o->time / o->dt + 0.5);
    most = count * o->dt * o->feed + 2.0 * (double)o->batch;
    if (o->particles > 0 && most > (double)o->particles) most = (double)o->particles;
    if (most > 1e9) return bad_number("feed", o->feed, "smaller: more than 1e9 particles in this run");
    if (count < 1 || count > 1e15) return bad_number("time", o->time, "at least one step");
    *steps = (int64_t)count;
    d->capacity = (int32_t)most;
    return 0;
}

static int describe(const settings *o, mpm_spray_desc *d, mpm_spray_window *w, int64_t *steps)
{
    *d = mpm_spray_desc_default();
    d->gas_speed = (mpm_real)o->speed;
    d->alpha = (mpm_real)o->alpha;
    d->friction = (mpm_real)o->friction;
    d->median_radius = (mpm_real)(o->median_radius * 1e-6);
    d->size_shape = (mpm_real)o->shape;
    d->diameter_min = (mpm_real)(o->size_min * 1e-6);
    d->diameter_max = (mpm_real)(o->size_max * 1e-6);
    d->feed = (mpm_real)o->feed;
    d->batch = (int32_t)o->batch;
    d->total = o->particles;
    d->dt = (mpm_real)o->dt;
    d->theta = (mpm_real)o->theta;
    d->stand_off = (mpm_real)o->stand_off;
    d->low[1] = d->low[2] = (mpm_real)-o->box;
    d->high[1] = d->high[2] = (mpm_real)o->box;
    d->high[0] = d->stand_off + MPM_R(0.02);
    d->seed = (uint64_t)o->seed;
    d->gas = (mpm_spray_gas)word_place(MPM_NAMES(MPM_SPRAY_GAS_LIST), o->gas);
    d->contact = (mpm_spray_contact)word_place(MPM_NAMES(MPM_SPRAY_CONTACT_LIST), o->contact);
    d->deposit = (mpm_spray_deposit)word_place(MPM_NAMES(MPM_SPRAY_DEPOSIT_LIST), o->deposit);
    choose_criterion(o, d, w);
    if (parse_release(o, d->release) || parse_mixed(o, d)) return -1;
    return parse_length(o, d, steps);
}

/* ---- output -------------------------------------------------------------------------------- */

static int failed(const mpm_fault *fault)
{
    char text[256];
    mpm_io_fault_text(text, sizeof text, fault);
    return !complain(text);
}

/* One row of impacts.csv per first touch. */
static void write_impact(void *user, const mpm_spray_touch *t)
{
    mpm_io_csv *csv = (mpm_io_csv *)user;
    int k;
    if (!t->first) return;
    mpm_io_csv_real(csv, t->time);
    for (k = 0; k < 3; k++) mpm_io_csv_real(csv, t->x[k]);
    for (k = 0; k < 3; k++) mpm_io_csv_real(csv, t->v[k]);
    mpm_io_csv_real(csv, 2 * t->radius);
    mpm_io_csv_integer(csv, t->stuck);
    mpm_io_csv_integer(csv, t->id);
    mpm_io_csv_integer(csv, t->host >= 0);
}

#define IMPACT_COLUMNS "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_m,stuck,id,on_deposit"

/* A frame is named by its step: a run that goes on writes the names of the uninterrupted one, and no other's. */
static void frame_name(char *name, size_t n, int64_t step) { snprintf(name, n, "spray-%09lld.vtu", (long long)step); }

/* All particles, in flight and deposited, as one VTK file. */
static mpm_status write_frame(const char *folder, const mpm_spray *s, spray_columns *c, const char *note,
                              mpm_fault *fault)
{
    static const mpm_real none[3] = {0, 0, 0};
    char path[PATH_BYTES], name[64];
    mpm_io_field field[4];
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    int32_t i, n = s->live + s->deposited;
    mpm_status status;
    int k;
    for (i = 0; i < n; i++) {
        int32_t j = i - s->live;
        const mpm_real *x = j < 0 ? s->x + 3 * i : s->deposit_x + 3 * j;
        const mpm_real *v = j < 0 ? s->v + 3 * i : none;
        for (k = 0; k < 3; k++) {
            c->column[k][i] = x[k];
            c->column[3 + k][i] = v[k];
        }
        c->column[6][i] = 2 * (j < 0 ? s->radius[i] : s->deposit_radius[j]);
        c->column[7][i] = j < 0 ? -1 : s->deposit_time[j];
        c->state[i] = j >= 0;
    }
    field[0] = mpm_io_vector("velocity", c->column[3], c->column[4], c->column[5], 1);
    field[1] = mpm_io_scalar("diameter", c->column[6], 1);
    field[2] = mpm_io_scalar("arrival", c->column[7], 1);
    field[3] = mpm_io_int32("deposited", c->state);
    d.count = (size_t)n;
    for (k = 0; k < 3; k++) d.x[k] = c->column[k];
    d.fields = field;
    d.field_count = 4;
    d.time = (double)mpm_spray_time(s);
    d.float32 = 1;
    d.note = note;
    frame_name(name, sizeof name, s->tally.step);
    file_in(folder, name, path, sizeof path);
    if ((status = mpm_io_vtu(path, &d, fault)) < 0) return status;
    file_in(folder, "spray.pvd", path, sizeof path);
    return mpm_io_pvd_add(path, name, d.time, fault);
}

static mpm_status write_pictures(const char *folder, const mpm_spray *s, spray_columns *c, const char *note,
                                 mpm_fault *fault)
{
    char path[PATH_BYTES];
    mpm_draw_canvas canvas;
    mpm_status status = MPM_OK;
    if (s->live + s->deposited > 0) {
        if ((status = mpm_draw_canvas_init(&canvas, 1500, 640, NULL, 0)) < 0) return status;
        status = spray_draw_plume(&canvas, mpm_draw_tile(&canvas, 1, 1, 0), s, c, (double)s->desc.gas_speed,
                                  "plume, from the side", fault);
        file_in(folder, "plume.png", path, sizeof path);
        if (status >= 0) status = mpm_io_png(path, canvas.rgb, canvas.width, canvas.height, note, fault);
        mpm_draw_canvas_free(&canvas);
    }
    if (s->deposited > 0 && status >= 0) {
        if ((status = mpm_draw_canvas_init(&canvas, 1100, 1200, NULL, 0)) < 0) return status;
        status = spray_draw_deposit(&canvas, mpm_draw_tile(&canvas, 1, 1, 0), s, c, 25, "deposit, from above", fault);
        file_in(folder, "deposit.png", path, sizeof path);
        if (status >= 0) status = mpm_io_png(path, canvas.rgb, canvas.width, canvas.height, note, fault);
        mpm_draw_canvas_free(&canvas);
    }
    return status;
}

/* ---- restart ------------------------------------------------------------------------------- */

/* The options that do not make the spray: a run that goes on may have others. */
static int is_free(const char *name)
{
    static const char *const word[] = {"steps", "time", "out", "restart", "resume", "checkpoint", "frames", "quiet"};
    size_t k;
    for (k = 0; k < sizeof word / sizeof *word; k++)
        if (!strcmp(name, word[k])) return 1;
    return 0;
}

#define TEXT_ROOM (OPTION_COUNT * 320)

/* What must be the same for a run that goes on, one option a line. */
static const char *spray_text(const option *o, int n)
{
    static char text[TEXT_ROOM];
    size_t used = 0;
    int i;
    for (i = 0; i < n; i++) {
        char number[OPTION_NUMBER];
        if (is_free(o[i].name)) continue;
        used = mpm_io_line(text, sizeof text, used, o[i].name, option_text(&o[i], number));
    }
    return text;
}

/* What the files beside a checkpoint hold of the run so far. */
typedef struct files {
    uint64_t impacts;     /* checksum of impacts.csv to the last first touch */
    int64_t since, every; /* the frames of all steps above `since` that `every` divides; every 0: of none */
} files;

#define BLOBS (MPM_SPRAY_BLOBS + HISTORY_BLOBS + 1)

static int spray_blobs(mpm_spray *s, files *past, history *h, mpm_blob blob[BLOBS])
{
    int n = mpm_spray_blobs(s, blob);
    n += history_blobs(h, blob + n);
    blob[n] = mpm_blob_of("files beside it", past, sizeof *past);
    return n + 1;
}

static mpm_status write_checkpoint(const char *path, mpm_spray *s, files *past, history *h, const option *o,
                                   int options, mpm_fault *fault)
{
    mpm_blob blob[BLOBS];
    return mpm_io_checkpoint_write(path, spray_text(o, options), blob, spray_blobs(s, past, h, blob), fault);
}

static mpm_status read_checkpoint(const char *path, mpm_spray *s, files *past, history *h, const option *o,
                                  int options, mpm_fault *fault)
{
    mpm_blob blob[BLOBS];
    const int n = spray_blobs(s, past, h, blob);
    mpm_status status = mpm_io_checkpoint_read(path, spray_text(o, options), blob, n, fault);
    if (status >= 0 && (status = mpm_spray_restored(s, blob)) < 0) *fault = s->fault;
    if (status >= 0 && !history_whole(h))
        status = mpm_fail(fault, MPM_ERR_ARGUMENT, "history rows", (mpm_real)h->rows, -1);
    return status;
}

static int64_t steps_per_frame(const settings *o, int64_t steps)
{
    return o->frames > 0 ? (steps + o->frames - 1) / o->frames : steps + 1;
}

/* Whether the frames are there that the run before is known to have written and this one would have, too. Those of
   a run that was itself a restart may be missing. Returns 1, or 0 after a message. */
static int has_frames(const settings *o, const mpm_spray *s, const files *past, int64_t every)
{
    char path[PATH_BYTES], name[64];
    int64_t step;
    for (step = every; step <= s->tally.step; step += every) {
        int found;
        frame_name(name, sizeof name, step);
        if ((found = is_there(file_in(o->out, name, path, sizeof path))) < 0) return 0;
        if (found || past->every <= 0 || step <= past->since || step % past->every) continue;
        fprintf(stderr, "error: there is no %s, which the run before wrote: the series would lack it; --frames 0 goes "
                "on without one\n", path);
        return 0;
    }
    return 1;
}

/* Begins the series with those of them in the folder. Returns 1, or 0 after a message. */
static int begin_series(const settings *o, const mpm_spray *s, int64_t every)
{
    char path[PATH_BYTES], frame[PATH_BYTES], name[64];
    mpm_status status;
    mpm_fault fault;
    int64_t step;
    status = mpm_io_pvd_begin(file_in(o->out, "spray.pvd", path, sizeof path), &fault);
    for (step = every; step <= s->tally.step && status >= 0; step += every) {
        frame_name(name, sizeof name, step);
        if (is_there(file_in(o->out, name, frame, sizeof frame)) <= 0) continue;
        status = mpm_io_pvd_add(path, name, (double)(mpm_real)((double)step * (double)s->desc.dt), &fault);
    }
    return status >= 0 || report(&fault, path);
}

/* ... and what the checkpoint at its end will say of them. */
static void note_series(files *past, const settings *o, const mpm_spray *s, int64_t every)
{
    const int all = s->tally.step == 0 || (past->every > 0 && every % past->every == 0);
    if (!all) past->since = s->tally.step;
    past->every = o->frames > 0 ? every : 0;
}

#define IMPACT_HEAD 1 /* lines before the rows */

/* Opens the table of impacts in a folder if its rows are those that the checkpoint knows; f then stands at the first.
   Returns 1; 0 if there is no such table, -1 after a message if it cannot be read. */
static int open_impacts(FILE **f, const char *folder, const files *past, int64_t rows)
{
    char path[PATH_BYTES];
    uint64_t sum;
    const int found = is_there(file_in(folder, "impacts.csv", path, sizeof path));
    if (found <= 0) return found;
    if (!(*f = fopen(path, "rb"))) return 0;
    if (hash_lines(*f, IMPACT_HEAD + rows, &sum) && sum == past->impacts && fseek(*f, 0, SEEK_SET) == 0 &&
        hash_lines(*f, IMPACT_HEAD, &sum))
        return 1;
    fclose(*f);
    return 0;
}

/* The table of impacts before the restart, beside the checkpoint or in --out, or NULL after a message. */
static FILE *earlier_impacts(const settings *o, const files *past, int64_t rows)
{
    const char *slash = strrchr(o->restart, '/');
    char beside[PATH_BYTES] = ".";
    FILE *f = NULL;
    int found;
    if (slash) memcpy(beside, o->restart, (size_t)(slash - o->restart)); /* shorter, says parse_length */
    if (slash) beside[slash - o->restart] = 0;
    found = open_impacts(&f, beside, past, rows);
    if (found == 0) found = open_impacts(&f, o->out, past, rows);
    if (found == 0)
        fprintf(stderr, "error: --restart %s: neither beside it nor in --out is an impacts.csv with the %lld impacts "
                "that it was written with\n", o->restart, (long long)rows);
    return found > 0 ? f : NULL;
}

/* Begins impacts.csv with the rows of the first touches that the checkpoint has counted. Returns 1, or 0 after a
   message; then there is no new table. */
static int begin_impacts(mpm_io_csv *csv, const settings *o, const mpm_spray *s, const files *past)
{
    const int64_t rows = s->tally.first_hits;
    char path[PATH_BYTES], line[1024];
    FILE *old = NULL;
    mpm_fault fault;
    int64_t k = 0;
    if (rows > 0 && !(old = earlier_impacts(o, past, rows))) return 0;
    if (mpm_io_csv_begin(csv, file_in(o->out, "impacts.csv", path, sizeof path), IMPACT_COLUMNS, NULL, &fault) < 0)
        report(&fault, path);
    else
        for (; k < rows && fgets(line, sizeof line, old); k++) mpm_io_put(&csv->file, line);
    if (old) fclose(old);
    if (k == rows && csv->status >= 0) return 1;
    if (csv->status >= 0) complain("impacts.csv of the run before cannot be read");
    mpm_io_csv_drop(csv);
    return 0;
}

/* Begins table and series where the run before ended; what there is stays until all of it is known to be good.
   Returns 1, or 0 after a message. */
static int begin_files(mpm_io_csv *csv, const settings *o, const mpm_spray *s, files *past, int64_t steps)
{
    const int64_t every = steps_per_frame(o, steps);
    mpm_fault fault;
    if (mpm_io_make_directory(o->out, &fault) < 0) return report(&fault, o->out);
    if (o->frames > 0 && !has_frames(o, s, past, every)) return 0;
    if (!begin_impacts(csv, o, s, past)) return 0;
    if (o->frames > 0 && !begin_series(o, s, every)) return mpm_io_csv_drop(csv), 0;
    note_series(past, o, s, every);
    return 1;
}

/* The checksum of the table, now that it is written, for the checkpoint. */
static mpm_status note_impacts(files *past, const settings *o, const mpm_spray *s, mpm_fault *fault)
{
    char path[PATH_BYTES];
    FILE *f = fopen(file_in(o->out, "impacts.csv", path, sizeof path), "rb");
    const int whole = f && hash_lines(f, IMPACT_HEAD + s->tally.first_hits, &past->impacts);
    if (f) fclose(f);
    return whole ? MPM_OK : mpm_fail(fault, MPM_ERR_FILE, "impacts.csv, just written: cannot be read", 0, -1);
}

/* ---- results ------------------------------------------------------------------------------- */

typedef struct result { const char *key, *text, *unit; double value; } result;

#define RESULTS 21

static void result_row(result *r, int *n, const char *key, const char *text, double value, const char *unit)
{
    r[*n].key = key;
    r[*n].text = text;
    r[*n].unit = unit;
    r[(*n)++].value = value;
}

/* cpu: seconds of the particle-steps since `before` of them, where this run began. */
static int results(result *r, const mpm_spray *s, int64_t before, double cpu)
{
    mpm_spray_metrics m;
    double rate = cpu > 0 ? (double)(s->tally.particle_steps - before) / cpu : 0;
    int n = 0;
    mpm_spray_measure(s, &m);
    result_row(r, &n, "injected", "injected", (double)m.injected, "");
    result_row(r, &n, "deposited", "deposited", (double)m.deposited, "");
    result_row(r, &n, "escaped", "escaped", (double)m.escaped, "");
    result_row(r, &n, "in_flight", "in flight", (double)m.in_flight, "");
    result_row(r, &n, "deposit_fraction", "deposit fraction", m.deposit_fraction, "");
    result_row(r, &n, "late_rate_over_feed", "growth at the end / feed", m.late_rate_over_feed, "");
    result_row(r, &n, "mean_spread_m", "mean distance from the axis", m.mean_spread, "m");
    result_row(r, &n, "scatter_m", "its standard deviation", m.scatter, "m");
    result_row(r, &n, "thickness_m", "thickness of the deposit", m.thickness, "m");
    result_row(r, &n, "volume_fraction", "volume fraction of the pellet", m.volume_fraction, "");
    result_row(r, &n, "volume_r5mm_m3", "volume within 5 mm", m.volume_r5mm, "m^3");
    result_row(r, &n, "volume_r10mm_m3", "volume within 10 mm", m.volume_r10mm, "m^3");
    result_row(r, &n, "collisions_per_particle", "collisions per particle", m.collisions_per_particle, "");
    result_row(r, &n, "collided_fraction", "particles that collided", m.collided_fraction, "");
    result_row(r, &n, "impact_speed_mean_m_s", "impact speed, mean", m.impact_speed_mean, "m/s");
    result_row(r, &n, "impact_speed_sd_m_s", "impact speed, deviation", m.impact_speed_sd, "m/s");
    result_row(r, &n, "first_hit_stuck_fraction", "stuck at first impact", m.first_hit_stuck_fraction, "");
    result_row(r, &n, "fixed_point_not_converged", "iterations not converged", (double)s->tally.not_converged, "");
    result_row(r, &n, "particle_steps_per_second", "particle-steps per CPU second", rate, "1/s");
    result_row(r, &n, "simulated_particle_seconds_per_cpu_second", "simulated particle-seconds per CPU second",
               rate * (double)s->desc.dt, "");
    result_row(r, &n, "end_time_s", "end time", (double)mpm_spray_time(s), "s");
    return n;
}

static mpm_status write_summary(const char *folder, const result *r, int count, const option *o, int options,
                                mpm_fault *fault)
{
    char path[PATH_BYTES], number[OPTION_NUMBER];
    mpm_io_json j;
    mpm_status status;
    int k;
    file_in(folder, "summary.json", path, sizeof path);
    if ((status = mpm_io_json_begin(&j, path, fault)) < 0) return status;
    for (k = 0; k < count; k++) {
        if (r[k].value == floor(r[k].value) && fabs(r[k].value) < 1e15)
            mpm_io_json_integer(&j, r[k].key, (long long)r[k].value);
        else
            mpm_io_json_number(&j, r[k].key, r[k].value);
    }
    mpm_io_json_open(&j, "options");
    for (k = 0; k < options; k++) {
        static const char places[] = "out|restart|resume|checkpoint|quiet";
        if (word_place(places, o[k].name) >= 0) continue;
        mpm_io_json_string(&j, o[k].name, option_text(&o[k], number));
    }
    mpm_io_json_close(&j);
    return mpm_io_json_end(&j, fault);
}

/* ---- the run ------------------------------------------------------------------------------- */

/* What a run writes into, and what its files say of it. */
typedef struct records {
    mpm_io_csv *impacts;
    files *past;
    history *history;
    const option *row;
    int rows;
    const char *note;
} records;

/* A checkpoint between two steps. The table must be whole beside it: it is ended, and begun again with its rows. */
static mpm_status save(mpm_spray *s, const settings *o, const records *r, mpm_fault *fault)
{
    char path[PATH_BYTES];
    mpm_status status = mpm_io_csv_end(r->impacts, fault);
    if (status >= 0) status = note_impacts(r->past, o, s, fault);
    file_in(o->out, "checkpoint.bin", path, sizeof path);
    if (status >= 0) status = write_checkpoint(path, s, r->past, r->history, r->row, r->rows, fault);
    if (status < 0 || begin_impacts(r->impacts, o, s, r->past)) return status;
    return mpm_fail(fault, MPM_ERR_FILE, "impacts.csv: cannot be begun again", 0, -1);
}

static void show_progress(const progress *line, const mpm_spray *s, int64_t first, int64_t steps)
{
    mpm_io_progress p;
    char text[160];
    memset(&p, 0, sizeof p);
    p.step = s->tally.step;
    p.first_step = first;
    p.steps = steps;
    p.time = (double)mpm_spray_time(s) * 1e3;
    p.time_unit = "ms";
    p.points = s->live;
    p.elapsed = progress_elapsed(line);
    mpm_io_progress_text(text, sizeof text, &p);
    progress_show(line, text);
}

static double seconds(clock_t since) { return (double)(clock() - since) / (double)CLOCKS_PER_SEC; }

/* Steps to the end, or until asked to stop; a frame and a checkpoint every so often. *cpu: seconds spent in steps.
   Returns the status. */
static mpm_status run(mpm_spray *s, const settings *o, int64_t steps, spray_columns *c, const records *r, double *cpu,
                      mpm_fault *fault)
{
    const int64_t first = s->tally.step, every = steps_per_frame(o, steps);
    mpm_status status = MPM_OK;
    progress line;
    clock_t begin = clock();
    double saved = 0;
    stop_listen();
    progress_begin(&line, o->quiet);
    if (history_due(r->history, first, 0)) spray_history_sample(r->history, s);
    while (s->tally.step < steps && status >= 0 && !stop_asked()) {
        int64_t step;
        if ((status = mpm_spray_step(s)) < 0) *fault = s->fault;
        step = s->tally.step;
        if (status >= 0 && history_due(r->history, step, 0)) spray_history_sample(r->history, s);
        if (status >= 0 && (step % every == 0 || (step == steps && o->frames > 0))) {
            *cpu += seconds(begin);
            status = write_frame(o->out, s, c, r->note, fault);
            begin = clock();
        }
        if (status >= 0 && o->checkpoint > 0 && *cpu + seconds(begin) - saved >= o->checkpoint) {
            saved = *cpu += seconds(begin);
            status = save(s, o, r, fault);
            begin = clock();
        }
        if (progress_due(&line, (double)step / (double)steps)) show_progress(&line, s, first, steps);
    }
    *cpu += seconds(begin);
    progress_end(&line);
    return status;
}

/* What made these files: the options that make the spray, as one line. */
static void describe_in_words(const option *o, int n, char *note, size_t room)
{
    size_t at = 0;
    int k;
    note[0] = 0;
    for (k = 0; k < n; k++) {
        char number[OPTION_NUMBER];
        if (is_free(o[k].name)) continue;
        at = mpm_append(note, room, at, at ? " --" : "spray --");
        at = mpm_append(note, room, at, o[k].name);
        at = mpm_append(note, room, at, " ");
        at = mpm_append(note, room, at, option_text(&o[k], number));
    }
}

/* history.csv and history.png. Returns 1, or 0 after a message. */
static int write_history(const mpm_spray *s, const settings *o, const history *past)
{
    const history all = spray_history_end(past, s);
    char title[100];
    snprintf(title, sizeof title, "median radius %g um, gas at %g m/s", o->median_radius, o->speed);
    return history_csv(&all, o->out) && spray_history_png(&all, o->out, title);
}

static mpm_status write_all(mpm_spray *s, const settings *o, const records *of, spray_columns *c, int64_t before,
                            double cpu, mpm_fault *fault)
{
    char path[PATH_BYTES];
    result r[RESULTS];
    int n = results(r, s, before, cpu), k;
    mpm_status status = write_summary(o->out, r, n, of->row, of->rows, fault);
    if (status >= 0) status = write_pictures(o->out, s, c, of->note, fault);
    if (status >= 0) status = note_impacts(of->past, o, s, fault);
    file_in(o->out, "checkpoint.bin", path, sizeof path);
    if (status >= 0) status = write_checkpoint(path, s, of->past, of->history, of->row, of->rows, fault);
    if (status < 0 || o->quiet) return status;
    for (k = 0; k < n; k++) printf("%-44s %14.6g %s\n", r[k].text, r[k].value, r[k].unit);
    printf("%-44s %14.6g %s\n", "memory", (double)s->bytes / 1e6, "MB");
    printf("results are in %s\n", o->out);
    return status;
}

static int carry_out(int argc, char **argv)
{
    static const char about[] = "Powder from a nozzle to a target: flight, collisions, deposition.\n"
                                "Writes summary.json, impacts.csv, history.csv, history.png, plume.png, deposit.png,\n"
                                "spray.pvd (ParaView) with its frames and checkpoint.bin into the output folder.";
    static char note[TEXT_ROOM];
    settings o = settings_default();
    option row[OPTION_COUNT];
    int rows = options_of(row, &o), parsed = options_parse(argc, argv, about, row, rows);
    mpm_spray s;
    mpm_spray_desc d;
    mpm_spray_window window;
    mpm_io_csv impacts;
    mpm_fault fault = {MPM_OK, NULL, 0, -1};
    files past = {0, 0, 0};
    char path[PATH_BYTES];
    spray_columns columns;
    history past_rows;
    records of;
    mpm_status status;
    int64_t before, steps = 0;
    double cpu = 0;
    int stopped;
    if (parsed) return parsed > 0 ? 0 : 1;
    if (o.resume) o.restart = file_in(o.out, "checkpoint.bin", path, sizeof path);
    if (describe(&o, &d, &window, &steps)) return 1;
    d.touch = write_impact;
    d.touch_user = &impacts;
    describe_in_words(row, rows, note, sizeof note);
    if (mpm_spray_init(&s, &d, NULL, 0) < 0) return failed(&s.fault);
    spray_history_begin(&past_rows);
    if (o.restart[0] && read_checkpoint(o.restart, &s, &past, &past_rows, row, rows, &fault) < 0) {
        fprintf(stderr, "error: --restart %s\n", o.restart);
        return failed(&fault);
    }
    before = s.tally.particle_steps;
    if (s.tally.step > steps) {
        fprintf(stderr, "error: --restart %s is at step %lld, past the end\n", o.restart, (long long)s.tally.step);
        return 1;
    }
    if (spray_columns_init(&columns, (size_t)d.capacity)) return fprintf(stderr, "error: no memory\n"), 1;
    if (!begin_files(&impacts, &o, &s, &past, steps)) return 1;
    of.impacts = &impacts;
    of.past = &past;
    of.history = &past_rows;
    of.row = row;
    of.rows = rows;
    of.note = note;
    status = run(&s, &o, steps, &columns, &of, &cpu, &fault);
    if (mpm_io_csv_end(&impacts, status < 0 ? NULL : &fault) < 0 && status >= 0) return failed(&fault);
    if (status >= 0 && !write_history(&s, &o, &past_rows)) return 1;
    if (status >= 0) status = write_all(&s, &o, &of, &columns, before, cpu, &fault);
    if (status < 0) failed(&fault);
    stopped = status >= 0 && s.tally.step < steps;
    if (stopped) print_again(argc, argv, "--resume", (long long)s.tally.step, (long long)steps);
    spray_columns_free(&columns);
    mpm_spray_free(&s);
    return status < 0 ? 1 : stopped ? STOPPED : 0;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
