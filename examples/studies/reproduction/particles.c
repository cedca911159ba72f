/* particles.c - A-two and A-ten: scenes of several particles. SPDX-License-Identifier: MIT */
#include "particles_case.h"
#include "reproduction.h"

/* ---- finished scenes --------------------------------------------------------------------------- */

typedef struct particle_row {
    char fate[20];
    double pbcp, v_z, v_along, ejected;
} particle_row;

/* Reads the report of a finished scene of `count` particles; that of its pairs must be there too. Returns 1, or 0
   with w->message. */
static int read_particles(work *w, const char *folder, particle_row *row, int count)
{
    char path[PATH_BYTES], line[400];
    int n = 0, id;
    FILE *f = fopen(file_in(folder, "particles.csv", path, sizeof path), "rb");
    while (f && n < count && fgets(line, sizeof line, f))
        if (sscanf(line, "%d,%*f,%*f,%*f,%19[^,],%lf,%*d,%*d,%*d,%lf,%lf,%lf", &id, row[n].fate, &row[n].pbcp,
                   &row[n].v_z, &row[n].v_along, &row[n].ejected) == 6)
            n++;
    if (f) fclose(f);
    if (n != count) {
        snprintf(w->message, sizeof w->message, "%.300s has not %d rows", path, count);
        return 0;
    }
    f = fopen(file_in(folder, "pairs.csv", path, sizeof path), "rb"); /* for read_pair */
    if (!f) snprintf(w->message, sizeof w->message, "%.300s cannot be read", path);
    else fclose(f);
    return f != NULL;
}

/* A pair of bodies of a finished scene. */
typedef struct pair_row {
    double pbcp; /* %; 0 if they never met */
    int held;    /* node pairs that the bond held in the last step */
} pair_row;

/* Of bodies a < b; with b < 0 of a and any other: then the sum of the held. */
static pair_row read_pair(const char *folder, int a, int b)
{
    char path[PATH_BYTES], line[400];
    pair_row r = {0, 0};
    double pbcp;
    int i, j, held;
    FILE *f = fopen(file_in(folder, "pairs.csv", path, sizeof path), "rb");
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "%d,%d,%lf,%*d,%*d,%*d,%d", &i, &j, &pbcp, &held) == 4 &&
            (b < 0 ? i == a || j == a : i == a && j == b)) {
            r.pbcp = pbcp;
            r.held += held;
        }
    if (f) fclose(f);
    return r;
}

/* A number of a finished scene's summary; -1 if there is none. */
static double read_summary(const char *folder, const char *key)
{
    static char text[20000];
    char path[PATH_BYTES];
    const char *at = json_value(text_in(file_in(folder, "summary.json", path, sizeof path), text, sizeof text), key);
    return at ? strtod(at, NULL) : -1;
}

/* Runs a scene unless the folder holds it. As need. */
static int need_particles(work *w, particles_case *q, const char *folder)
{
    option o[IMPACT_OPTIONS];
    const int n = particles_options(q, o);
    int status;
    q->out.folder = folder;
    q->out.quiet = w->s.quiet;
    if (particles_finished(q)) return 1;
    if (w->s.limit >= 0 && w->s.fresh >= w->s.limit) return -1;
    w->s.fresh++;
    if ((status = particles_main(q, o, n)) == STOPPED) return -1;
    if (status) {
        snprintf(w->message, sizeof w->message, "the scene of %.300s failed", folder);
        return 0;
    }
    return 1;
}

/* The last picture of a scene into the folder of data; an old one there goes only when there is a new one. */
static int keep_picture(work *w, const particles_case *q, const char *folder, const char *name)
{
    char from[PATH_BYTES], to[PATH_BYTES], frame[40];
    unsigned char part[4096];
    mpm_io_file out;
    size_t n;
    FILE *in;
    int ok;
    snprintf(frame, sizeof frame, "frame_%04lld.png", (long long)q->out.frames - 1);
    in = fopen(file_in(folder, frame, from, sizeof from), "rb");
    ok = in && mpm_io_open(&out, data_file(w, name, to, sizeof to), &w->fault) >= 0;
    while (ok && (n = fread(part, 1, sizeof part, in)) > 0) mpm_io_put_bytes(&out, part, n);
    if (ok && ferror(in)) {
        mpm_io_drop(&out);
        ok = 0;
    }
    if (ok) ok = mpm_io_close(&out, &w->fault) >= 0;
    if (in) fclose(in);
    if (!ok) snprintf(w->message, sizeof w->message, "cannot copy %.150s to %.100s/%.50s", from, w->data, name);
    return ok;
}

/* ---- A-two --------------------------------------------------------------------------------- */

/* Two particles of 14 um, the second aside and its centre 30 um up: on which grid and how whole, by whose normals, with
   which pair, at which offsets and on which budgets (bits). */
typedef struct two_runs {
    grid g;
    const char *geometry, *symmetry;
    int normal, pair;     /* their numbers */
    int offsets, budgets; /* bits */
} two_runs;

#define OFFSETS 4
static const double two_offset[OFFSETS] = {0, 2.5, 5, 7.5};

/* Whose gradient the normal of the particles' contact follows: source A numbered its bodies by chance and took the
   higher one's. */
enum { BY_TOP, BY_BOTTOM, BY_BOTH };
static const char *const normal_of[3] = {"top", "bottom", "both"};

#define TWO_SETS 13
static const two_runs two_sets[TWO_SETS] = {
    {{1.5, 0.5}, "3d", "half", BY_TOP, SOURCE_PAIR, 15, 1 << QUICK},
    {{1.0, 0.35}, "3d", "half", BY_TOP, SOURCE_PAIR, 15, 1 << DESK},
    {{1.0, 0.35}, "3d", "half", BY_BOTTOM, SOURCE_PAIR, 15, 1 << DESK},
    {{1.0, 0.35}, "3d", "half", BY_BOTH, SOURCE_PAIR, 15, 1 << DESK},
    {{0.7, 0.175}, "3d", "quarter", BY_TOP, SOURCE_PAIR, 1, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "3d", "half", BY_TOP, SOURCE_PAIR, 8, 1 << DESK},
    {{0.7, 0.175}, "3d", "half", BY_TOP, SOURCE_PAIR, 14, 1 << FULL},
    {{0.7, 0.175}, "3d", "quarter", BY_BOTH, SOURCE_PAIR, 1, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "3d", "half", BY_BOTH, SOURCE_PAIR, 8, 1 << DESK},
    {{0.7, 0.175}, "3d", "half", BY_BOTH, SOURCE_PAIR, 14, 1 << FULL},
    {{0.7, 0.175}, "3d", "quarter", BY_TOP, OWN_PAIR, 1, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "3d", "half", BY_TOP, OWN_PAIR, 8, 1 << DESK | 1 << FULL},
    {{0.7, 0.175}, "axisymmetric", "quarter", BY_TOP, SOURCE_PAIR, 1, 1 << QUICK | 1 << DESK | 1 << FULL}};

/* The number of the top particle: the higher one leads. */
static int two_top(const two_runs *r) { return r->normal == BY_BOTTOM ? 0 : 1; }

static void two_scene(particles_case *q, const two_runs *r, int at)
{
    const int top = two_top(r);
    *q = particles_default(r->symmetry, "");
    q->base.geometry = r->geometry;
    q->base.cell = r->g.cell;
    q->base.spacing = r->g.spacing;
    q->base.gc = pairs[r->pair].gc;
    q->base.gdot = pairs[r->pair].gdot;
    if (r->normal == BY_BOTH) q->base.normal = "average";
    q->count = 2;
    q->center[1 - top][2] = q->base.diameter / 2;
    q->center[top][0] = two_offset[at];
    q->center[top][2] = 30;
}

/* What became of it. */
typedef struct two_result {
    particle_row top, bottom;
    pair_row both, base;      /* the particles; the bottom one and the substrate */
    double pbcp, cpu_seconds; /* of all surfaces */
} two_result;

/* Returns 1, or 0 with w->message. */
static int two_read(work *w, const two_runs *r, const char *folder, two_result *out)
{
    const int top = two_top(r);
    particle_row row[2];
    if (!read_particles(w, folder, row, 2)) return 0;
    out->top = row[top];
    out->bottom = row[1 - top];
    out->both = read_pair(folder, 0, 1);
    out->base = read_pair(folder, 1 - top, 2);
    out->pbcp = read_summary(folder, "pbcp_percent");
    out->cpu_seconds = read_summary(folder, "cpu_seconds");
    return 1;
}

/* A row of the file. */
static void two_record(mpm_io_csv *t, const two_runs *r, int at, const two_result *out)
{
    mpm_io_csv_real(t, (mpm_real)two_offset[at]);
    mpm_io_csv_text(t, normal_of[r->normal]);
    mpm_io_csv_real(t, (mpm_real)out->pbcp);
    mpm_io_csv_real(t, (mpm_real)out->both.pbcp);
    mpm_io_csv_real(t, (mpm_real)out->base.pbcp);
    mpm_io_csv_integer(t, out->both.held);
    mpm_io_csv_integer(t, out->base.held);
    mpm_io_csv_real(t, (mpm_real)out->top.v_z);
    mpm_io_csv_real(t, (mpm_real)out->bottom.v_z);
    mpm_io_csv_text(t, out->top.fate);
    mpm_io_csv_text(t, out->bottom.fate);
    mpm_io_csv_real(t, (mpm_real)r->g.cell);
    mpm_io_csv_real(t, (mpm_real)r->g.spacing);
    mpm_io_csv_text(t, r->geometry);
    mpm_io_csv_real(t, (mpm_real)pairs[r->pair].gc);
    mpm_io_csv_real(t, (mpm_real)pairs[r->pair].gdot);
}

/* A row of the table. */
static void say_two(work *w, const two_runs *r, int at, const two_result *out, const char *name)
{
    static const double said[3][OFFSETS] = {{5.73, 5.47, 4.71, 3.91}, {2.02, 1.65, 6.06, 16.24},
                                            {1.24, 0.92, 0.94, -0.53}};
    say(w, "| %g | %.3g/%.3g%s%s | %s | %.2f | [%.2f](data/%s.png) | ", two_offset[at], r->g.cell, r->g.spacing,
        strcmp(r->geometry, "3d") ? ", axisymmetric" : "", r->pair == OWN_PAIR ? ", own pair" : "",
        normal_of[r->normal], said[0][at], out->pbcp, name);
    say(w, "%.2f, %.2f | %d, %d | ", out->both.pbcp, out->base.pbcp, out->both.held, out->base.held);
    say(w, "%.2f | %.2f | %.2f | %.2f | %s | %s | %.0f |\n", said[1][at], out->top.v_z, said[2][at], out->bottom.v_z,
        out->top.fate, out->bottom.fate, out->cpu_seconds);
}

/* One scene: a row of the table and of the file, and a picture. As need. */
static int two_row(work *w, mpm_io_csv *t, const two_runs *r, int at)
{
    static particles_case q;
    two_result out;
    char folder[PATH_BYTES], name[60], plot[64];
    int status;
    two_scene(&q, r, at);
    snprintf(name, sizeof name, "two_%s_%g_%g_by_%s%s", r->geometry, r->g.cell, two_offset[at], normal_of[r->normal],
             r->pair == OWN_PAIR ? "_own" : "");
    snprintf(plot, sizeof plot, "%s.png", name);
    file_in(w->s.folder, name, folder, sizeof folder);
    if ((status = need_particles(w, &q, folder)) <= 0) return status;
    if (!two_read(w, r, folder, &out)) return 0;
    say_two(w, r, at, &out, name);
    two_record(t, r, at, &out);
    return keep_picture(w, &q, folder, plot);
}

int two_particles(work *w)
{
    mpm_io_csv t;
    int k, at, status = 1;
    table_begin(w, &t, "two_particles.csv",
                "offset_um,normal_of,pbcp_percent,pbcp_top_bottom_percent,pbcp_bottom_substrate_percent,"
                "held_nodes_top_bottom,held_nodes_bottom_substrate,top_v_z_m_s,bottom_v_z_m_s,top,bottom,cell_um,"
                "spacing_um,geometry,gc,gdot", "A-two");
    say(w, "### A-two: one particle on another\n\nTwo of 14 um at 810 m/s, 3D unless said, after 100 ns; velocities of "
           "points up to 60 m/s, from the substrate's mean. Normals between the two: of the top particle, of the "
           "bottom one, or of both averaged; source A's followed numbers given by chance. It ran 0.7/0.175 in 3D. Own "
           "pair: as in A-crit.\n\n| offset, um | cell/spacing, um | normals of | PBCP, %%: source A | here | between "
           "the two, bottom on substrate | held nodes there | top v_z, m/s: source A | here | bottom v_z: source A "
           "| here | top | bottom | CPU s |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (k = 0; k < TWO_SETS; k++)
        for (at = 0; at < OFFSETS && status > 0; at++)
            if (two_sets[k].budgets & 1 << w->budget && two_sets[k].offsets & 1 << at)
                status = two_row(w, &t, &two_sets[k], at);
    say(w, "\nSource A: the one at 7.5 um rebounds, the others stay.\n\n");
    return table_end(w, &t, status);
}

/* ---- A-ten --------------------------------------------------------------------------------- */

/* The scene, at random places. Returns 1, or 0 with w->message. */
static int ten_scene(work *w, particles_case *q, grid g, double spread)
{
    *q = particles_default("full", "");
    q->base.cell = g.cell;
    q->base.spacing = g.spacing;
    q->count = 10;
    q->base.substrate_diameter = q->base.time = 0;
    return particles_place(q, spread, particles_height(q, spread), 1, w->message, sizeof w->message);
}

int ten_particles(work *w)
{
    static particles_case q;
    static const grid coarse = {1.5, 0.5}, fine = {1.0, 0.35};
    const grid g = w->budget == QUICK ? coarse : fine;
    const double spread = 60;
    particle_row row[10];
    char folder[PATH_BYTES], name[100];
    int k, status;
    if (!ten_scene(w, &q, g, spread)) return 0;
    snprintf(name, sizeof name, "ten_%g_%g_%g", g.cell, g.spacing, spread);
    file_in(w->s.folder, name, folder, sizeof folder);
    if ((status = need_particles(w, &q, folder)) <= 0) return status;
    if (!read_particles(w, folder, row, 10)) return 0;
    say(w, "### A-ten: ten particles\n\nTen of 14 um at 810 m/s at random places and heights, 3D, %.3g/%.3g um, after "
           "%.0f ns. Source A (1.0/0.35): most bond, one is prevented by ejected material.\n\n"
           "| particle | fate | PBCP, %% | v_z, m/s | along the face, m/s | ejected, %% | held nodes: to the "
           "substrate | to other particles |\n|---|---|---|---|---|---|---|---|\n",
        g.cell, g.spacing, read_summary(folder, "time_ns"));
    for (k = 0; k < 10; k++) {
        const int on_substrate = read_pair(folder, k, 10).held;
        say(w, "| %d | %s | %.2f | %.2f | %.2f | %.1f | %d | %d |\n", k, row[k].fate, row[k].pbcp, row[k].v_z,
            row[k].v_along, 100 * row[k].ejected, on_substrate, read_pair(folder, k, -1).held - on_substrate);
    }
    say(w, "\n%.0f of 10 bonded; PBCP of all surfaces %.2f %%. Cost: %.0f CPU s.\n\n"
           "![Ten particles](data/ten_particles.png)\n\n", read_summary(folder, "bonded"),
        read_summary(folder, "pbcp_percent"), read_summary(folder, "cpu_seconds"));
    return keep_picture(w, &q, folder, "ten_particles.png");
}
