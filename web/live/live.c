/* live.c - what the page in the browser runs: an impact, and one step of the worked point of docs/method.md, phase by
   phase. The impact is that of examples/impact_case.h, begun with the words of a command line of examples/impact.c;
   the step is the public phases of mpm.h. Here they only get an outside that a page can call: functions of numbers,
   and arrays. Messages go to stderr, as in the programs. One run and one lesson at a time.
   Built by `make web`; every function that is not static is exported. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_options.h"
#include "mpm_draw.h"
#include "program.h"

#include <stdarg.h>

#define LIVE_TEXT 16384
#define LIVE_WORDS 200 /* most words of a command line */

/* ---- what the page shares ------------------------------------------------------------------------------------ */

static char text[LIVE_TEXT]; /* words from the page, tables to it */

/* Room for a text from the page: words, each with a 0 behind it; and where tables stand. */
char *live_text(void) { return text; }

int live_text_bytes(void) { return LIVE_TEXT; }

static void say(const char *format, ...)
{
    const size_t n = strlen(text);
    va_list list;
    va_start(list, format);
    vsnprintf(text + n, sizeof text - n, format, list);
    va_end(list);
}

/* The version, then a line for each metal: its name and the strengths that it has a published set for. */
void live_metals(void)
{
#define STRENGTH(constant, name, text) name,
    static const char *const models[] = {MPM_STRENGTH_LIST(STRENGTH)};
#undef STRENGTH
    const mpm_units units = mpm_units_um_us_ng();
    int i;
    size_t k;
    text[0] = 0;
    say("%s\n", mpm_version());
    for (i = 0; i < mpm_material_preset_count(); i++) {
        const char *name = mpm_material_preset_name(i);
        mpm_material m;
        if (mpm_material_preset(&m, name, &units, NULL) != MPM_OK) continue;
        say("%s %s", name, models[m.strength]);
        for (k = 0; k < sizeof models / sizeof models[0]; k++)
            if (mpm_material_model(&m, models[k], NULL) == MPM_OK) say(" %s", models[k]);
        say("\n");
    }
}

/* 0xRRGGBB at t of a colour map of mpm_draw.h. */
int live_color(int map, double t) { return (int)mpm_draw_map_color((mpm_draw_map)map, t); }

/* ---- the impact ---------------------------------------------------------------------------------------------- */

static impact_case scene;
static impact run;
static int running;    /* run is to be ended */
static float *frame;   /* of live_frame */
static float *outline; /* of live_outline */

void live_end(void)
{
    if (running) impact_end(&run);
    free(frame);
    free(outline);
    frame = outline = NULL;
    running = 0;
}

/* Splits `count` words in the text's buffer into a program's arguments. */
static int words(int count, char **argument)
{
    static char name[] = "impact";
    char *p = text;
    int i, n = count < LIVE_WORDS ? count : LIVE_WORDS - 1;
    argument[0] = name;
    for (i = 1; i <= n; i++, p += strlen(p) + 1) argument[i] = p;
    return n + 1;
}

/* Begins the impact that so many words in the buffer of live_text describe, as build/impact does. 1, or 0 after a
   message. The text is read until the end of the run: the page writes to a copy. */
int live_begin(int count)
{
    static char kept[LIVE_TEXT];
    char message[300], *argument[LIVE_WORDS + 1];
    option options[IMPACT_OPTIONS];
    const size_t most = sizeof kept;
    int i, n = words(count, argument);
    live_end();
    memcpy(kept, text, most);
    for (i = 1; i < n; i++) argument[i] = kept + (argument[i] - text);
    scene = strcmp(impact_method(n, argument, "thesis"), "surface") ? impact_case_default() : impact_case_surface();
    if (options_parse(n, argument, "", options, impact_options(&scene, options))) return 0;
    impact_complete(&scene);
    running = impact_begin(&run, &scene, message, sizeof message);
    return running || complain(message);
}

/* Up to `steps` more. Returns how many are left to do, or -1 after a message. */
double live_advance(int steps)
{
    mpm_status status = MPM_OK;
    while (status >= 0 && steps-- > 0 && run.world.steps < run.steps) status = impact_step(&run);
    if (status < 0) return report(&run.world.fault, "step") - 1;
    return (double)(run.steps - run.world.steps);
}

/* ---- ... looked at ------------------------------------------------------------------------------------------- */

#define LIVE_FIELDS 8 /* of a point in a frame: x, z, body, strain, temperature, pressure, velocity, bond */

static void show(const mpm_points *p, int32_t i, int32_t body, float *out)
{
    const double pressure = -((double)p->stress[0][i] + (double)p->stress[1][i] + (double)p->stress[2][i]) / 3;
    out[0] = (float)p->x[0][i];
    out[1] = (float)p->x[2][i];
    out[2] = (float)body;
    out[3] = (float)p->plastic_strain[i];
    out[4] = (float)p->temperature[i];
    out[5] = (float)(1e-3 * pressure); /* GPa */
    out[6] = (float)p->v[2][i];
    out[7] = (float)p->bond[i];
}

/* The points on the grid now, LIVE_FIELDS numbers each; live_frame_count says how many. NULL without memory. */
float *live_frame(void)
{
    const mpm_world *w = &run.world;
    float *out;
    int32_t b, i;
    if (!frame) frame = (float *)malloc((size_t)w->points.count * LIVE_FIELDS * sizeof *frame);
    out = frame;
    for (b = 0; frame && b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++, out += LIVE_FIELDS)
            show(&w->points, i, b, out);
    return frame;
}

int live_frame_count(void)
{
    int32_t b, n = 0;
    for (b = 0; b < run.world.bodies; b++) n += run.world.body[b].active;
    return n;
}

int live_outline_count(void)
{
    int32_t a, n = 0;
    for (a = 0; a < run.surfaces.surfaces; a++) n += run.surfaces.surface[a].faces;
    return n;
}

/* Whether adhesion that is not spent acts at a marker. */
static int adheres(const mpm_marker *m)
{
    int k;
    for (k = 0; k < MPM_SURFACE_MEETS; k++)
        if (m->meet[k].other != MPM_SURFACE_NONE && mpm_surface_adhesion(&run.surfaces, &m->meet[k]) > 0) return 1;
    return 0;
}

/* The surfaces now, with contact on surfaces: live_outline_count lines of five numbers, x and z of both ends, 1 where
   it adheres. NULL without memory. */
float *live_outline(void)
{
    float *out;
    int32_t a, i;
    int k;
    free(outline);
    out = outline = (float *)malloc(((size_t)live_outline_count() * 5 + 1) * sizeof *outline);
    for (a = 0; outline && a < run.surfaces.surfaces; a++)
        for (i = 0; i < run.surfaces.surface[a].faces; i++, out += 5) {
            const mpm_surface *s = &run.surfaces.surface[a];
            const mpm_marker *end[2] = {&s->marker[s->face[i][0]], &s->marker[s->face[i][1]]};
            for (k = 0; k < 2; k++) {
                out[2 * k] = (float)end[k]->x[0];
                out[2 * k + 1] = (float)end[k]->x[2];
            }
            out[4] = (float)(adheres(end[0]) && adheres(end[1]));
        }
    return outline;
}

#define LIVE_SAMPLES 14

/* What the curves show: time (ns), mean velocity of the particle (m/s), shares of the energy at the start: kinetic,
   plastic, elastic, dampers, contact, bond; contact and bonded area (um2), highest temperature (K), time at the end
   (ns), steps, points. */
double *live_sample(void)
{
    static double s[LIVE_SAMPLES];
    const mpm_world *w = &run.world;
    const mpm_totals all = mpm_body_totals(w, -1), particle = mpm_body_totals(w, IMPACT_PARTICLE);
    const mpm_bond_measure bond = mpm_bond_measure_body(w, IMPACT_PARTICLE);
    const double start = run.start.kinetic;
    s[0] = (double)w->time * 1e3;
    s[1] = particle.momentum[2] / particle.mass;
    s[2] = case_share(all.kinetic, start);
    s[3] = case_share(all.plastic, start);
    s[4] = case_share(all.internal - run.start.internal - all.plastic, start);
    s[5] = case_share(w->ledger.absorbed, start);
    s[6] = case_share(w->ledger.contact, start);
    s[7] = case_share(w->ledger.hold, start);
    s[8] = bond.contacted_area;
    s[9] = bond.bonded_area;
    if (run.surfaces.surfaces > 0) {
        const mpm_meeting m = mpm_surface_meets(&run.surfaces, w, IMPACT_PARTICLE, IMPACT_SUBSTRATE);
        s[8] = m.touched > 0 ? m.touched : m.area;
        s[9] = m.bonded;
    }
    s[10] = all.temperature_max;
    s[11] = (double)run.steps * (double)run.dt * 1e3;
    s[12] = (double)run.steps;
    s[13] = (double)w->points.count;
    return s;
}

/* What colours span: lowest and highest temperature of the bars (K), speed of the impact (m/s), its pressure in a
   plane (GPa); the picture's half width, lower and upper end (um), and the distance of points (um). */
double *live_scale(void)
{
    static double s[8];
    const mpm_material *a = &run.material[IMPACT_PARTICLE], *b = &run.material[IMPACT_SUBSTRATE];
    const mpm_body_desc *d = &run.world.body[IMPACT_PARTICLE].desc;
    const double cold = fmin((double)a->temperature, (double)b->temperature);
    const double melt = fmax((double)a->melt_temperature, (double)b->melt_temperature);
    s[0] = cold;
    s[1] = melt > cold ? melt : cold + 600;
    s[2] = fabs(scene.velocity);
    s[3] = 1e-3 * (double)d->density * (double)d->wave_p * fabs(scene.velocity) / 2;
    s[4] = 1.1 * scene.substrate_diameter / 2;
    s[5] = -1.05 * scene.substrate_height;
    s[6] = 1.1 * (2 * impact_half_height(&scene) + fmax(scene.gap, 0));
    s[7] = scene.spacing;
    return s;
}

/* A line of the table: what it is, its unit, its value. */
static void row(const char *what, const char *unit, double value) { say("%s\t%s\t%.17g\n", what, unit, value); }

/* The verdict, "stays" or "rebounds", then the numbers of build/impact's table, a row each. */
void live_result(void)
{
    const mpm_world *w = &run.world;
    const impact_result r = impact_measure(&run, &scene);
    const double start = run.start.kinetic;
    text[0] = 0;
    say("%s\n", impact_stays(&run, &r) ? "stays" : "rebounds");
    row("rebound velocity, mean", "m/s", r.rebound.mean);
    row("rebound velocity, |v| <= 60 m/s", "m/s", r.rebound.filtered);
    row("restitution", "", r.restitution);
    row("velocity noise in the particle", "m/s", r.rebound.noise);
    row("substrate drift", "m/s", r.substrate_drift);
    if (run.surfaces.surfaces > 0) {
        row("bonded share of what touched", "%", r.bond.pbcp);
        row("dissipated at the interface", "J/m2", r.meeting.dissipated);
        row("adhesion where bonded", "J/m2", case_share(r.meeting.adhesion, r.meeting.bonded));
    } else {
        row("PBCP", "%", r.bond.pbcp);
        row("ABP", "", r.bond.abp);
    }
    row("pairs held", "", (double)w->held);
    row("mean plastic strain", "", r.particle.plastic_strain_mean);
    row("flattening", "", r.flattening);
    row("crater depth", "um", r.crater);
    row("contact area", "um2", r.contact_area);
    row("bonded area", "um2", r.bonded_area);
    row("highest temperature", "K", r.all.temperature_max);
    row("points ejected", "", (double)r.pieces.apart);
    row("energy: kinetic", "%", 100 * case_share(r.all.kinetic, start));
    row("energy: plastic work", "%", 100 * case_share(r.all.plastic, start));
    row("energy: elastic", "%", 100 * case_share(r.all.internal - run.start.internal - r.all.plastic, start));
    row("energy: absorbed by dampers", "%", 100 * case_share(w->ledger.absorbed, start));
    row("energy: lost in contact", "%", 100 * case_share(w->ledger.contact, start));
    row("energy: in the bond", "%", 100 * case_share(w->ledger.hold, start));
    row("energy unaccounted", "%", 100 * r.energy_unaccounted);
    row("momentum error", "", r.momentum_error);
}

/* For the comparison of digits: kinetic, internal, plastic energy, momentum along z, sums of x and z, absorbed,
   contact, hold. */
double *live_digits(void)
{
    static double s[9];
    const mpm_world *w = &run.world;
    const mpm_totals all = mpm_body_totals(w, -1);
    int32_t i;
    memset(s, 0, sizeof s);
    s[0] = all.kinetic;
    s[1] = all.internal;
    s[2] = all.plastic;
    s[3] = all.momentum[2];
    for (i = 0; i < w->points.count; i++) {
        s[4] += (double)w->points.x[0][i];
        s[5] += (double)w->points.x[2][i];
    }
    s[6] = w->ledger.absorbed;
    s[7] = w->ledger.contact;
    s[8] = w->ledger.hold;
    return s;
}

/* ---- the lesson: one step ------------------------------------------------------------------------------------ */

#define LESSON_POINT 17 /* number, body, x, v, mass, density, stress */
#define LESSON_NODE 19  /* grid node's place along x, y, z, body, mass, momentum, force, velocity, gradient, whether it
                           has one, slot */
#define LESSON_PAIR 8   /* slots a, b, normal, impulse on a */

static const double lambda = 51084, mu = 26316; /* MPa */
static mpm_world lesson;
static int32_t chosen;          /* number of the worked point */
static double strains[9];       /* its strain and rotation increments */
static double *table;           /* of points, nodes or pairs */

/* Hooke's law, the stress turned with the spin to first order: that of examples/00_step.c. */
static mpm_status hooke(const void *material, const mpm_block *b)
{
    int p, c;
    (void)material;
    for (p = 0; p < b->count; p++) {
        const double s[6] = {b->stress[0][p], b->stress[1][p], b->stress[2][p],
                             b->stress[3][p], b->stress[4][p], b->stress[5][p]};
        const double x = b->spin[0][p], y = b->spin[1][p], z = b->spin[2][p];
        const double trace = b->strain[0][p] + b->strain[1][p] + b->strain[2][p];
        for (c = 0; c < 6; c++) b->stress[c][p] += 2 * mu * b->strain[c][p] + (c < 3 ? lambda * trace : 0);
        b->stress[0][p] += 2 * (y * s[4] - z * s[5]);
        b->stress[1][p] += 2 * (z * s[5] - x * s[3]);
        b->stress[2][p] += 2 * (x * s[3] - y * s[4]);
        b->stress[3][p] += x * (s[1] - s[2]) - y * s[5] + z * s[4];
        b->stress[4][p] += y * (s[2] - s[0]) - z * s[3] + x * s[5];
        b->stress[5][p] += z * (s[0] - s[1]) - x * s[4] + y * s[3];
        if (lesson.points.id[b->density + p - lesson.points.density] != chosen) continue;
        for (c = 0; c < 6; c++) strains[c] = b->strain[c][p];
        for (c = 0; c < 3; c++) strains[6 + c] = b->spin[c][p];
    }
    return MPM_OK;
}

static int lesson_body(mpm_shape shape, double vz)
{
    mpm_body_desc b = mpm_body_desc_default();
    b.shape = shape;
    b.spacing = 0.5;
    b.density = 0.0027;
    b.velocity[2] = vz;
    b.stress = hooke;
    return mpm_body_add(&lesson, &b) == MPM_OK;
}

/* Where the worked point is now; -1 if there is none. */
static int32_t lesson_place(void)
{
    int32_t i = lesson.points.count - 1;
    while (i >= 0 && lesson.points.id[i] != chosen) i--;
    return i;
}

/* The ball and the block of examples/00_step.c after 100 steps. 1, or 0 after a message. */
int live_lesson(void)
{
    const mpm_points *q = &lesson.points;
    mpm_desc d = mpm_desc_default();
    mpm_status status = MPM_OK;
    int32_t i;
    int k;
    mpm_free(&lesson);
    d.cell = 1;
    d.cells[0] = d.cells[1] = 10;
    d.cells[2] = 14;
    d.scheme = MPM_SCHEME_THESIS;
    d.side[4] = MPM_SIDE_FIXED;
    if (mpm_init(&lesson, &d, NULL, 0) != MPM_OK || !lesson_body(mpm_sphere(5, 5, 7.5, 3), -200) ||
        !lesson_body(mpm_box(1, 1, 0, 9, 9, 4), 0))
        return report(&lesson.fault, "lesson");
    for (i = 0; i < q->count; i++)
        if (hypot(hypot(q->x[0][i] - 5.75, q->x[1][i] - 5.25), q->x[2][i] - 4.75) < 1e-9) chosen = q->id[i];
    for (k = 0; k < 100 && status >= 0; k++) status = mpm_step(&lesson, 8e-6);
    return status >= 0 || report(&lesson.fault, "lesson");
}

/* The k-th phase of step 101. 1, or 0 after a message. */
int live_lesson_phase(int k)
{
    static void (*const phase[])(mpm_world *) = {mpm_p2g, mpm_forces, mpm_grid_update, mpm_contact_find,
                                                 mpm_contact_apply, mpm_g2p, mpm_musl};
    const int last = (int)(sizeof phase / sizeof phase[0]);
    if (k == 0 && mpm_locate(&lesson, 8e-6) < 0) return report(&lesson.fault, "locate");
    if (k > 0 && k <= last) phase[k - 1](&lesson);
    if (k == last + 1 && mpm_stress(&lesson) < 0) return report(&lesson.fault, "stress");
    if (k == last + 2) mpm_move(&lesson);
    return 1;
}

/* Room for n rows of a table: NULL without memory. */
static double *rows(int32_t n, int columns)
{
    free(table);
    table = (double *)malloc(((size_t)n + 1) * (size_t)columns * sizeof *table);
    return table;
}

int live_lesson_point_count(void) { return lesson.points.count; }

int live_lesson_node_count(void) { return lesson.nodes; }

int live_lesson_pair_count(void) { return lesson.pairs; }

int live_lesson_chosen(void) { return chosen; }

/* All points, LESSON_POINT numbers each. As the next two, of the state now, until the next such call. */
double *live_lesson_points(void)
{
    const mpm_points *q = &lesson.points;
    double *out = rows(q->count, LESSON_POINT);
    int32_t i;
    int c;
    for (i = 0; out && i < q->count; i++) {
        *out++ = q->id[i];
        *out++ = i >= lesson.body[1].first;
        for (c = 0; c < 3; c++) *out++ = q->x[c][i];
        for (c = 0; c < 3; c++) *out++ = q->v[c][i];
        *out++ = q->mass[i];
        *out++ = q->density[i];
        for (c = 0; c < 6; c++) *out++ = q->stress[c][i];
        *out++ = i;
    }
    return table;
}

static void three(double **out, const mpm_real *v)
{
    int c;
    for (c = 0; c < 3; c++) *(*out)++ = v[c];
}

/* All slots, LESSON_NODE numbers each. */
double *live_lesson_nodes(void)
{
    const mpm_real none[3] = {0, 0, 0};
    double *out = rows(lesson.nodes, LESSON_NODE);
    int32_t s;
    for (s = 0; out && s < lesson.nodes; s++) {
        const mpm_node *n = &lesson.node[s];
        mpm_real x[3];
        mpm_node_position(&lesson, n, x);
        three(&out, x);
        *out++ = n->body;
        *out++ = n->mass;
        three(&out, n->momentum);
        three(&out, n->force);
        three(&out, n->velocity);
        three(&out, n->touch < 0 ? none : lesson.touch[n->touch].gradient);
        *out++ = n->touch >= 0;
        *out++ = s;
    }
    return table;
}

/* All pairs, LESSON_PAIR numbers each. After the phase that finds contact. */
double *live_lesson_pairs(void)
{
    double *out = rows(lesson.pairs, LESSON_PAIR);
    int32_t k;
    for (k = 0; out && k < lesson.pairs; k++) {
        const mpm_pair *p = &lesson.pair[k];
        *out++ = p->a;
        *out++ = p->b;
        three(&out, p->normal);
        three(&out, p->impulse);
    }
    return table;
}

/* The eight nodes of the worked point: slot, N and grad N of each. After the first phase, before the last. */
double *live_lesson_support(void)
{
    static double out[8 * 5];
    const int32_t i = lesson_place();
    mpm_support s;
    int32_t r = 0;
    int a, c;
    while (r < lesson.runs - 1 && (i < lesson.run[r].first || i >= lesson.run[r].first + lesson.run[r].count)) r++;
    mpm_support_of(&lesson, &lesson.run[r], i, &s);
    for (a = 0; a < 8; a++) {
        out[5 * a] = s.slot[a];
        out[5 * a + 1] = s.N[a];
        for (c = 0; c < 3; c++) out[5 * a + 2 + c] = s.G[c][a];
    }
    return out;
}

/* Its strain increment, xx yy zz yz xz xy, and rotation about x, y, z, as the law got them. */
double *live_lesson_strain(void) { return strains; }
