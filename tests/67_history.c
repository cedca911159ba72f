/* 67_history - what a run remembers, and the pictures of it: rows of a table, beside what is known of them; a model and
   its quarter; history.csv read back; film.png beside its frames; fields and views that are refused.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_history.h"
#include "spray_history.h"
#include "taylor_history.h"
#include "output.h"
#include "check.h"
#include "files.h"
#include "png.h"

#define FOLDER "build/tests/history"

static const history_column three[] = {{"time", "ns", "of the clock"}, {"way", "um", "along it"},
                                       {"v_mean", "m/s", "its rate"}};

/* ---- the table --------------------------------------------------------------------------------- */

/* A run of so many steps, each of two nanoseconds; the way is 3 t + 1. `again`: at that step the table is kept and
   taken up again, as a checkpoint does it. */
static void remember(history *h, int64_t steps, int64_t end, int64_t again)
{
    static history kept;
    mpm_blob from[HISTORY_BLOBS], to[HISTORY_BLOBS];
    int64_t step;
    int k;
    history_begin(h, three, 3, steps);
    for (step = 0; step <= end; step++) {
        if (history_due(h, step, steps)) {
            double *row = history_row(h, step);
            row[1] += 6.0 * (double)step + 1;
            row[0] += 2.0 * (double)step;
            row[2] = history_rate(h, 1);
        }
        if (step != again) continue;
        history_blobs(h, from);
        history_begin(&kept, three, 3, steps);
        history_blobs(&kept, to);
        for (k = 0; k < HISTORY_BLOBS; k++) memcpy(to[k].data, from[k].data, from[k].bytes);
        CHECK_TRUE("what was kept is whole", history_whole(&kept));
        step--; /* the step at which it was stopped is looked at again */
        again = -1;
        *h = kept;
    }
}

static double row_error(const history *h)
{
    double worst = 0;
    int64_t i;
    for (i = 0; i < h->rows; i++) {
        const double t = h->row[i][0];
        worst = check_worst(worst, fabs(h->row[i][1] - 3 * t - 1) + (i > 0 ? fabs(h->row[i][2] - 3) : h->row[i][2]));
        worst = check_worst(worst, i > 0 && !(t > h->row[i - 1][0]) ? 1 : 0);
    }
    return worst;
}

static void known_length(void)
{
    static const int64_t steps[] = {1, 7, 199, 200, 201, 400, 1000, 9917};
    static history h, other;
    char line[80];
    size_t k;
    for (k = 0; k < sizeof steps / sizeof *steps; k++) {
        snprintf(line, sizeof line, "a run of %ld steps", (long)steps[k]);
        remember(&h, steps[k], steps[k], -1);
        CHECK_NEAR(line, row_error(&h), 0, 1e-9);
        CHECK_TRUE("... about two hundred rows, or all", h.rows <= 201 && h.rows >= (steps[k] < 200 ? steps[k] : 100));
        CHECK_EQUAL("... from the start", h.row[0][0], 0);
        CHECK_EQUAL("... to the end", h.row[h.rows - 1][0], 2 * (double)steps[k]);
        remember(&other, steps[k], steps[k], steps[k] / 2);
        CHECK_TRUE("... the same when it was stopped", h.rows == other.rows && !memcmp(h.row, other.row, sizeof h.row));
    }
}

static void open_end(void)
{
    static const int64_t ends[] = {0, 5, 200, 201, 202, 403, 5000, 100100};
    static history h, other;
    char line[80];
    size_t k;
    int64_t i;
    int even = 1;
    for (k = 0; k < sizeof ends / sizeof *ends; k++) {
        snprintf(line, sizeof line, "without an end known, %ld steps", (long)ends[k]);
        remember(&h, 0, ends[k], -1);
        for (i = 0; i < h.rows; i++) {
            even = even && fabs(h.row[i][0] - 2 * (double)(i * h.every)) < 1e-9;
            even = even && fabs(h.row[i][1] - 3 * h.row[i][0] - 1) < 1e-9;
        }
        CHECK_TRUE(line, even);
        CHECK_TRUE("... to the last row due", h.row[h.rows - 1][0] > 2 * (double)(ends[k] - h.every));
        CHECK_TRUE("... a hundred to two hundred rows, or all",
                   h.rows <= 201 && h.rows >= (ends[k] < 200 ? ends[k] : 100));
        remember(&other, 0, ends[k], ends[k] / 3);
        CHECK_TRUE("... the same when it was stopped", h.rows == other.rows && !memcmp(h.row, other.row, sizeof h.row));
    }
    other.rows = HISTORY_ROWS + 2;
    CHECK_TRUE("a checkpoint of more rows than there can be is none", !history_whole(&other));
}

/* history.csv as any program reads it: a line of names, then numbers with commas between. */
static void table(void)
{
    static history h;
    static const char head[] = "time_ns,way_um,v_mean_m_s\n";
    const char *text;
    char *at;
    double worst = 0;
    int64_t i;
    int k;
    remember(&h, 50, 50, -1);
    h.row[1][1] = 1.0 / 3;
    CHECK_TRUE("history.csv", history_csv(&h, FOLDER));
    text = text_of(FOLDER "/history.csv");
    CHECK_TRUE("... names with their units", !strncmp(text, head, sizeof head - 1));
    CHECK_EQUAL("... a line for each row", lines_of(text), (double)(h.rows + 1));
    at = (char *)(size_t)(text + sizeof head - 1);
    for (i = 0; i < h.rows; i++)
        for (k = 0; k < 3; k++, at++)
            worst = check_worst(worst, fabs(strtod(at, &at) - (double)(mpm_real)h.row[i][k]));
    CHECK_NEAR("... which come back", worst, 0, 0);
    CHECK_TRUE("nowhere to write it", !history_csv(&h, FOLDER "/none"));
}

static void curves(void)
{
    static const history_panel panel[3] = {{"way", {1, -1}}, {"both", {1, 2, -1}}, {"nothing", {2, -1}}};
    static history h;
    unsigned char *rgb;
    int x = 0, y = 0;
    int64_t i;
    remember(&h, 50, 50, -1);
    for (i = 0; i < h.rows; i++) h.row[i][2] = 0;
    CHECK_TRUE("of two curves, the one that is zero is left out", history_shows(&h, &panel[1], 0) &&
                                                                      !history_shows(&h, &panel[1], 1));
    CHECK_TRUE("... but not if it is alone", history_shows(&h, &panel[2], 0));
    CHECK_TRUE("history.png", history_png(&h, FOLDER, panel, 3, "a run"));
    rgb = read_png(FOLDER "/history.png", &x, &y);
    CHECK_TRUE("... two panels beside each other", rgb && x == 1500 && y == 880);
    free(rgb);
    h.rows = 1;
    remove(FOLDER "/history.png");
    CHECK_TRUE("of one row there is none",
               history_png(&h, FOLDER, panel, 3, "a run") && !exists(FOLDER "/history.png"));
}

/* ---- measures ---------------------------------------------------------------------------------- */

/* A coarse impact of a few nanoseconds, of that symmetry, with its history. Returns 1 when it came to its end. */
static int short_impact(history *h, const char *symmetry, double *impulse)
{
    impact_case c = impact_case_default();
    char message[300];
    impact s;
    c.symmetry = symmetry;
    c.cell = 2;
    c.spacing = 1;
    c.substrate_diameter = 20;
    c.substrate_height = 6;
    c.margin = 0.5;
    c.time = 3;
    c.dt_factor = 0.3;
    if (!impact_begin(&s, &c, message, sizeof message)) return 0;
    impact_history_begin(h, s.steps);
    for (;;) {
        if (history_due(h, s.world.steps, s.steps)) impact_history_sample(h, &s);
        if (s.world.steps >= s.steps || impact_step(&s) < 0) break;
    }
    *impulse = s.world.ledger.impulse[2] * impact_copies(&s);
    impact_end(&s);
    return h->rows > 100;
}

/* The books of each row, and what is known of the first. */
static void books(const history *h, double impulse)
{
    const double *first = h->row[0], *last = h->row[h->rows - 1];
    const double radius = 7, mass = 4 * (double)MPM_PI / 3 * radius * radius * radius * 2.7e-3;
    double worst = 0, force = 0;
    int64_t i;
    int k;
    for (i = 0; i < h->rows; i++) {
        double sum = -first[IMPACT_KINETIC];
        for (k = IMPACT_KINETIC; k < IMPACT_UNACCOUNTED; k++) sum += h->row[i][k];
        worst = check_worst(worst, fabs(sum - h->row[i][IMPACT_UNACCOUNTED]) / first[IMPACT_KINETIC]);
        if (i > 0) force += 1e-3 * h->row[i][IMPACT_FORCE] * (h->row[i][0] - h->row[i - 1][0]);
    }
    CHECK_NEAR("the energies of each row are all of them", worst, 0, 1e4 * (double)MPM_EPSILON);
    CHECK_NEAR("... nearly all accounted for", last[IMPACT_UNACCOUNTED] / first[IMPACT_KINETIC], 0, 0.03);
    CHECK_RELATIVE("the energy at the start", first[IMPACT_KINETIC], mass * 810 * 810 / 2, 0.05);
    CHECK_RELATIVE("... in um, us and ng: nJ by the thousand", first[IMPACT_MOMENTUM], -mass * 810, 0.05);
    CHECK_NEAR("momentum of both bodies, less what came from outside",
               (last[IMPACT_MOMENTUM] + last[IMPACT_MOMENTUM_BELOW] - impulse) / first[IMPACT_MOMENTUM], 1,
               1e4 * (double)MPM_EPSILON);
    CHECK_RELATIVE("the force makes the change of momentum", force, last[IMPACT_MOMENTUM] - first[IMPACT_MOMENTUM],
                   1e5 * (double)MPM_EPSILON);
    CHECK_RELATIVE("velocity at the start", first[IMPACT_V_MEAN], -810, 10 * (double)MPM_EPSILON);
    CHECK_NEAR("... without noise", first[IMPACT_V_NOISE], 0, 1e3 * (double)MPM_EPSILON);
    CHECK_NEAR("temperature at the start", first[IMPACT_HOT], 298, 1e-3);
    CHECK_TRUE("... higher in the end", last[IMPACT_HOT] > 310);
    CHECK_TRUE("a contact that grew", last[IMPACT_AREA] > 20 && last[IMPACT_BONDED] <= last[IMPACT_AREA]);
}

static void of_impacts(void)
{
    static history quarter, full;
    double impulse[2], worst = 0;
    int64_t i;
    int k, same;
    CHECK_TRUE("a quarter", short_impact(&quarter, "quarter", &impulse[0]));
    CHECK_TRUE("the whole", short_impact(&full, "full", &impulse[1]));
    books(&quarter, impulse[0]);
    books(&full, impulse[1]);
    same = quarter.rows == full.rows;
    for (i = 0; i < quarter.rows && same; i++)
        for (k = 0; k < IMPACT_HISTORY_COLUMNS; k++)
            worst = check_worst(worst, fabs(quarter.row[i][k] - full.row[i][k]) /
                                           (fabs(full.row[full.rows / 2][k]) + 1e-3 * full.row[0][IMPACT_KINETIC]));
    CHECK_TRUE("a quarter tells of the whole", same);
    CHECK_NEAR("... the same", worst, 0, sizeof(mpm_real) < 8 ? 0.05 : 1e-6);
}

/* Spread and stresses of points that are set by hand; what pictures show of them. */
static void by_hand(void)
{
    mpm_desc g = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    double mises, pressure, mass;
    mpm_real *made;
    mpm_world w;
    int32_t i;
    g.cell = 1;
    g.cells[0] = g.cells[1] = g.cells[2] = 4;
    b.shape = mpm_box(1, 1, 1, 3, 3, 3);
    b.spacing = MPM_R(0.5);
    b.density = 2;
    CHECK_TRUE("a cube", mpm_init(&w, &g, NULL, 0) == MPM_OK && mpm_body_add(&w, &b) == MPM_OK);
    for (i = 0; i < w.points.count; i++) w.points.v[2][i] = i % 2 ? 7 : -1;
    mass = mpm_body_totals(&w, 0).mass;
    CHECK_RELATIVE("spread of two velocities", sqrt(history_spread(&w, 0, 3) / mass), 4, 1e2 * (double)MPM_EPSILON);
    w.points.stress[2][3] = -600;
    w.points.stress[4][5] = 100;
    history_stress(&w.points, &mises, &pressure);
    CHECK_RELATIVE("equivalent stress under pressure along z", mises, 600, 1e2 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... and pressure", pressure, 200, 1e2 * (double)MPM_EPSILON);
    made = (mpm_real *)malloc(3 * (size_t)w.points.count * sizeof *made);
    if (!made) return;
    output_make(&w.points, made);
    CHECK_RELATIVE("a picture shows it", made[w.points.count + 3], 600, 1e2 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... under shear", made[w.points.count + 5], 100 * sqrt(3.0), 1e2 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... pressure", made[3], 200, 1e2 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... speed", made[2 * w.points.count + 3], 7, 1e2 * (double)MPM_EPSILON);
    free(made);
    mpm_free(&w);
}

/* A bar that only moves, and what a wall's force makes of its momentum. */
static void of_bars(void)
{
    static history h;
    taylor_case c = taylor_case_default();
    char message[300];
    double sum = 0;
    int64_t i;
    taylor s;
    c.cell = 0.8;
    c.spacing = 0.4;
    c.time = 2;
    CHECK_TRUE("a bar", taylor_begin(&s, &c, message, sizeof message));
    taylor_history_begin(&h, &s);
    for (;;) {
        if (history_due(&h, s.world.steps, s.steps)) taylor_history_sample(&h, &s, &c);
        if (s.world.steps >= s.steps || taylor_step(&s) < 0) break;
    }
    for (i = 1; i < h.rows; i++) sum += h.row[i][TAYLOR_FORCE] * (h.row[i][0] - h.row[i - 1][0]);
    CHECK_RELATIVE("its energy at the start, J", h.row[0][TAYLOR_KINETIC],
                   0.25 * (double)MPM_PI * 6.4 * 6.4 * 32.4 * 8.93e-6 * 227 * 227 / 2, 0.02);
    CHECK_RELATIVE("force of the wall: momentum, g m/s", sum, s.world.ledger.impulse[2], 1e5 * (double)MPM_EPSILON);
    CHECK_RELATIVE("length at the start", h.row[0][TAYLOR_LENGTH], 32.4, 1e3 * (double)MPM_EPSILON);
    CHECK_TRUE("... it grows shorter", h.row[h.rows - 1][TAYLOR_LENGTH] < 32.2);
    mpm_free(&s.world);
}

/* ---- programs ---------------------------------------------------------------------------------- */

static int run(const char *options)
{
    char command[500];
    snprintf(command, sizeof command, "build/impact --quiet %s >" FOLDER "/out 2>" FOLDER "/err", options);
    return system(command);
}

static void refused(const char *options, const char *said)
{
    char line[300];
    remove(FOLDER "/bad/summary.json");
    snprintf(line, sizeof line, "%s --out " FOLDER "/bad", options);
    CHECK_TRUE(options, run(line) != 0);
    CHECK_TRUE("... with a message naming it", strstr(text_of(FOLDER "/err"), said) != NULL);
    CHECK_TRUE("... and no summary", !exists(FOLDER "/bad/summary.json"));
}

#define COARSE "--cell 2 --spacing 1 --substrate-diameter 20 --substrate-height 6 --margin 0.5 --time 2 "

/* Whether a text is in a file, among whatever else. */
static int says(const char *path, const char *text)
{
    const size_t length = strlen(text);
    size_t n, i;
    unsigned char *file = slurp(path, &n);
    int found = 0;
    for (i = 0; i + length <= n && !found; i++) found = !memcmp(file + i, text, length);
    free(file);
    return found;
}

/* The film shows the frames, each its field; the table has a row of the end. */
static void film(void)
{
    char path[PATH_BYTES];
    film_said said;
    double every;
    int k, x = 0, y = 0, wide = 0, high = 0, same;
    CHECK_EQUAL("fields in three frames",
                run(COARSE "--frames 3 --fields bond,velocity,mises --out " FOLDER "/film"), 0);
    for (k = 0; k < 3; k++) {
        unsigned char *one, *two;
        snprintf(path, sizeof path, FOLDER "/film/frame_%04d.png", k);
        one = read_png(path, &x, &y);
        two = read_picture(FOLDER "/film/film.png", k, &wide, &high, &said);
        same = one && two && x == wide && y == high && !memcmp(one, two, 3 * (size_t)x * (size_t)y);
        CHECK_TRUE("a frame is in the film", same);
        free(one);
        free(two);
    }
    CHECK_EQUAL("... of no more", said.pictures, 3);
    CHECK_EQUAL("three panels beside each other", wide, 2400);
    every = ceil(number_in(FOLDER "/film/summary.json", "steps") / 200);
    CHECK_EQUAL("a table of the run: names, the start, every so many steps", lines_in(FOLDER "/film/history.csv"),
                2 + ceil(number_in(FOLDER "/film/summary.json", "steps") / every));
    CHECK_TRUE("the verdict is in the title",
               says(FOLDER "/film/impact.png", "al, 14 um at 810 m/s: is still on its way in"));
    CHECK_TRUE("... of the last picture alone", says(FOLDER "/film/frame_0002.png", "al, 14 um at 810 m/s") &&
                                                    !says(FOLDER "/film/frame_0002.png", "rebounds"));
    CHECK_EQUAL("from outside", run(COARSE "--frames 1 --view 3d --fields strain --out " FOLDER "/solid"), 0);
    CHECK_TRUE("... one picture is no film", exists(FOLDER "/solid/impact.png") && !exists(FOLDER "/solid/film.png"));
    CHECK_EQUAL("from outside, by surfaces",
                run(COARSE "--method surface --geometry 3d --time 0.3 --frames 1 --view 3d --out " FOLDER "/solid"), 0);
}

int main(void)
{
    if (mpm_io_make_directory(FOLDER, NULL) < 0) return 1;
    known_length();
    open_end();
    table();
    curves();
    by_hand();
    of_impacts();
    of_bars();
    film();
    refused("--fields heat", "'heat'");
    refused("--fields strain,", "''");
    refused("--fields strain,bond,strain", "'strain'");
    refused("--method surface --fields bond", "bond");
    refused("--view above", "above");
    refused("--geometry axisymmetric --view 3d", "geometry 3d");
    return check_end();
}
