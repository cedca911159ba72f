/* output.h - what a run leaves behind while it goes: its points for ParaView, pictures, a progress line.
   SPDX-License-Identifier: MIT */
#ifndef OUTPUT_H
#define OUTPUT_H

#include "case.h"
#include "mpm.h"
#include "mpm_draw.h"
#include "mpm_hdf5.h"
#include "mpm_surface.h"
#include "program.h"
#include "terminal.h"

/* The output of one run. The first members are set by the program, the others by the routines below. */
typedef struct output {
    const char *folder, *name;  /* of the series: name.pvd */
    const char *length, *time;  /* units; a thousand of the unit of time are one of the world's */
    double rate;                /* a strain rate of the world, in 1/us */
    int64_t frames;             /* wanted, evenly in time, both ends included; 1: of the end */
    const char *shown, *view;   /* what pictures show, with commas between; from where */
    int quiet;
    int64_t hdf5;               /* all frames in one file too: how it is packed, 0 .. 9; -1: no */

    int64_t frame;              /* frames written */
    double cpu, earlier;        /* seconds without the writing: by output_cpu; when output_start was called */
    int64_t first;              /* steps when output_start was called */
    clock_t begun, writing;
    progress line;
} output;

static inline output output_of(const char *folder, const char *name, const char *length, const char *time, double rate)
{
    output o;
    memset(&o, 0, sizeof o);
    o.folder = folder;
    o.name = name;
    o.length = length;
    o.time = time;
    o.rate = rate;
    o.frames = 9;
    o.hdf5 = -1;
    o.shown = "strain,temperature";
    o.view = "cut";
    return o;
}

static inline void output_options(output *o, option *options, int *n)
{
    option_add(options, n, "frames", OPTION_INTEGER, &o->frames,
               "pictures and ParaView files, evenly in time, both ends included; 1: of the end alone");
    option_add(options, n, "hdf5", OPTION_INTEGER, &o->hdf5,
               "all frames in one file of HDF5 too, .vtkhdf with .xmf: gzip level 0 .. 9; -1: no");
    option_add(options, n, "out", OPTION_TEXT, &o->folder, "output folder");
    option_add(options, n, "quiet", OPTION_FLAG, &o->quiet, "no progress line, no table");
}

static inline int output_check(const output *o, char *message, size_t n)
{
    if (!case_wants(o->frames >= 0 && o->frames <= 9999, "frames", (double)o->frames, "must be 0 .. 9999", message,
                    n) ||
        !case_wants(o->hdf5 >= -1 && o->hdf5 <= 9, "hdf5", (double)o->hdf5, "must be -1 .. 9", message, n))
        return 0;
    return case_wants(o->hdf5 < 0 || mpm_hdf5_built(), "hdf5", (double)o->hdf5,
                      "needs a program built with the HDF5 library: `make hdf5` or `make HDF5=1`", message, n);
}

/* Makes the folder and begins the series. Returns 1, or 0 after a message, as all that write. */
static inline int output_begin(output *o)
{
    char name[64], path[PATH_BYTES];
    mpm_fault fault;
    o->frame = 0;
    o->cpu = 0;
    if (mpm_io_make_directory(o->folder, &fault) < 0) return report(&fault, o->folder);
    if (o->frames == 0) return 1;
    snprintf(name, sizeof name, "%s.pvd", o->name);
    return mpm_io_pvd_begin(file_in(o->folder, name, path, sizeof path), &fault) >= 0 || report(&fault, path);
}

/* Starts the clock, before the first step or where an earlier run was left. */
static inline void output_start(output *o, const mpm_world *w)
{
    progress_begin(&o->line, o->quiet);
    o->begun = clock();
    o->writing = 0;
    o->earlier = o->cpu;
    o->first = w->steps;
}

/* CPU seconds of the run, without the writing and with those before output_start. */
static inline double output_cpu(output *o)
{
    o->cpu = o->earlier + (double)(clock() - o->begun - o->writing) / (double)CLOCKS_PER_SEC;
    return o->cpu;
}

/* Whether the next frame is due, of a run of that many steps. Test: 60_examples. */
static inline int output_due(const output *o, const mpm_world *w, int64_t steps)
{
    if (o->frames <= 1) return o->frames == 1 && o->frame == 0 && w->steps >= steps;
    return w->steps * (o->frames - 1) >= o->frame * steps;
}

/* ---- pictures ------------------------------------------------------------------------------ */

/* What --fields can show of the points. */
#define OUTPUT_SHOWN "strain|temperature|pressure|mises|velocity|bond"
enum { SHOWN_STRAIN, SHOWN_TEMPERATURE, SHOWN_PRESSURE, SHOWN_MISES, SHOWN_VELOCITY, SHOWN_BOND, OUTPUT_PANELS };
#define OUTPUT_VIEWS "cut|3d"

/* Ranges of colours, the same in all pictures of a run; pressure goes from -pressure to pressure. */
typedef struct output_range {
    double strain, cold, hot, pressure, mises, speed; /* 1, K, K, MPa, MPa, m/s */
} output_range;

/* The options of a program whose pictures can show several fields. */
static inline void output_picture_options(output *o, option *options, int *n)
{
    option_add(options, n, "fields", OPTION_TEXT, &o->shown,
               "what pictures show, with commas between: strain, temperature, pressure, mises, velocity, bond");
    option_add_word(options, n, "view", &o->view, OUTPUT_VIEWS, "a section, or the bodies from outside (geometry 3d)");
}

/* Number `k` of the fields to be shown: its place in the list; -1: there are not so many, -2: not in the list, with its
   name in word[]. */
static inline int output_shown(const output *o, int k, char word[32])
{
    const char *at = o->shown;
    size_t n;
    for (; k > 0 && at; k--) at = (at = strchr(at, ',')) != NULL ? at + 1 : NULL;
    if (!at) return -1;
    n = strcspn(at, ",");
    snprintf(word, 32, "%.*s", n < 31 ? (int)n : 31, at);
    return n < 31 && word_place(OUTPUT_SHOWN, word) >= 0 ? word_place(OUTPUT_SHOWN, word) : -2;
}

/* Checks them, of a run in that geometry. Test: 67_history. */
static inline int output_picture_check(const output *o, mpm_geometry geometry, char *message, size_t n)
{
    int seen[OUTPUT_PANELS] = {0}, k, field;
    char word[32] = "";
    for (k = 0; (field = output_shown(o, k, word)) != -1; k++) {
        if (field >= 0 && !seen[field]++) continue;
        snprintf(message, n, "--fields %s: '%s' is %s " OUTPUT_SHOWN, o->shown, word,
                 field < 0 ? "not one of" : "there twice; once each of");
        return 0;
    }
    if (!case_knows(OUTPUT_VIEWS, "view", o->view, message, n)) return 0;
    if (!strcmp(o->view, "cut") || geometry == MPM_3D) return 1;
    snprintf(message, n, "--view %s: needs --geometry 3d", o->view);
    return 0;
}

/* The surfaces of bodies as triangles, with the point nearest to each corner. */
typedef struct output_mesh {
    mpm_real *x[3], *value;
    int32_t *body, *near, (*triangle)[3];
    size_t places, triangles;
} output_mesh;

/* Sections of the whole, or views from outside. Do not copy: the cuts point to the texts. */
typedef struct output_picture {
    mpm_draw_cut_desc cut[OUTPUT_PANELS];
    int panels;
    char title[160], time[32];
    double (*outline)[4]; /* of output_outline */
    mpm_real *made;       /* values worked out for it */
    output_mesh mesh;     /* of output_outline, in a view from outside */
} output_picture;

static inline void output_picture_free(output_picture *p)
{
    free(p->outline);
    free(p->made);
    free(p->mesh.x[0]);
    free(p->mesh.near);
    p->outline = NULL;
    p->made = p->mesh.x[0] = NULL;
    p->mesh.near = NULL;
}

/* `panels` cuts, of which only the label, the values and their colours are left to be set. spacing: of the points; with
   a mirror at y = 0 the cut goes through the first layer of them. */
static inline void output_panels(const output *o, const mpm_world *w, double spacing, int panels, output_picture *p)
{
    int i;
    p->panels = panels;
    p->outline = NULL;
    p->made = NULL;
    p->title[0] = 0;
    memset(&p->mesh, 0, sizeof p->mesh);
    snprintf(p->time, sizeof p->time, "t = %.1f %s", (double)w->time * 1e3, o->time);
    for (i = 0; i < panels; i++) {
        p->cut[i] = mpm_draw_cut_of(w, NULL);
        p->cut[i].at = w->desc.geometry == MPM_3D && w->desc.side[2] == MPM_SIDE_SYMMETRY ? spacing / 2 : 0;
        p->cut[i].mirror = w->desc.side[0] == MPM_SIDE_SYMMETRY;
        p->cut[i].length_unit = o->length;
        p->cut[i].time = p->time;
    }
    p->cut[0].title = p->title;
}

static inline void output_colors(mpm_draw_cut_desc *d, const mpm_real *value, const char *label, mpm_draw_map map,
                                 double low, double high)
{
    d->value = value;
    d->label = label;
    d->map = map;
    d->low = low;
    d->high = high;
}

/* Plastic strain and bodies. Title and window are left to be set. */
static inline void output_bodies(const output *o, const mpm_world *w, double spacing, output_picture *p)
{
    output_panels(o, w, spacing, 2, p);
    output_colors(&p->cut[0], w->points.plastic_strain, "effective plastic strain", MPM_DRAW_DEEP, 0, 4);
}

/* Pressure, equivalent stress and speed of all points, one array after the other. */
static inline void output_make(const mpm_points *p, mpm_real *made)
{
    const size_t n = (size_t)p->count;
    size_t i;
    for (i = 0; i < n; i++) {
        const mpm_real *const *s = (const mpm_real *const *)p->stress, *const *v = (const mpm_real *const *)p->v;
        const double a = (double)(s[0][i] - s[1][i]), b = (double)(s[1][i] - s[2][i]), c = (double)(s[2][i] - s[0][i]);
        const double shear = (double)(s[3][i] * s[3][i] + s[4][i] * s[4][i] + s[5][i] * s[5][i]);
        made[i] = -(s[0][i] + s[1][i] + s[2][i]) / 3;
        made[n + i] = (mpm_real)sqrt((a * a + b * b + c * c) / 2 + 3 * shear);
        made[2 * n + i] = (mpm_real)sqrt((double)(v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i]));
    }
}

/* The fields that were asked for. Title and window are left to be set. Returns 1, or 0 after a message. */
static inline int output_fields(const output *o, const mpm_world *w, double spacing, const output_range *r,
                                output_picture *p)
{
    const mpm_points *q = &w->points;
    const size_t n = (size_t)q->count;
    char word[32];
    int k, panels = 0;
    while (output_shown(o, panels, word) >= 0) panels++;
    output_panels(o, w, spacing, panels, p);
    p->made = (mpm_real *)malloc(3 * n * sizeof *p->made);
    if (!p->made) return complain("no memory for a picture");
    output_make(q, p->made);
    for (k = 0; k < panels; k++) {
        mpm_draw_cut_desc *d = &p->cut[k];
        switch (output_shown(o, k, word)) {
        case SHOWN_STRAIN:
            output_colors(d, q->plastic_strain, "effective plastic strain", MPM_DRAW_DEEP, 0, r->strain);
            break;
        case SHOWN_TEMPERATURE:
            output_colors(d, q->temperature, "temperature (K)", MPM_DRAW_HEAT, r->cold, r->hot);
            break;
        case SHOWN_PRESSURE:
            output_colors(d, p->made, "pressure (MPa)", MPM_DRAW_DIVERGING, -r->pressure, r->pressure);
            break;
        case SHOWN_MISES:
            output_colors(d, p->made + n, "equivalent stress (MPa)", MPM_DRAW_DEEP, 0, r->mises);
            break;
        case SHOWN_VELOCITY:
            output_colors(d, p->made + 2 * n, "speed (m/s)", MPM_DRAW_DEEP, 0, r->speed);
            break;
        default: output_colors(d, q->bond, "bond D", MPM_DRAW_HEAT, 0, 1); break;
        }
    }
    return 1;
}

static inline void output_window(output_picture *p, double edge, double bottom, double top)
{
    int i;
    for (i = 0; i < p->panels; i++) {
        p->cut[i].window[0] = -edge;
        p->cut[i].window[1] = edge;
        p->cut[i].window[2] = bottom;
        p->cut[i].window[3] = top;
    }
}

/* Where a face lies in the cut: a line as it is, a triangle where it crosses the plane y = at; 0 if it does not. */
static inline int output_crossing(const mpm_surface *c, int32_t face, double at, double *line)
{
    int k, n = 0;
    for (k = 0; k < c->corners && n < 2; k++) {
        const mpm_real *a = c->marker[c->face[face][k]].x, *b = c->marker[c->face[face][(k + 1) % c->corners]].x;
        const double from = (double)a[1] - at, to = (double)b[1] - at;
        const double u = c->corners == 2 ? 0 : from / (from - to);
        if (c->corners == 3 && (from > 0) == (to > 0)) continue;
        line[2 * n] = (1 - u) * (double)a[0] + u * (double)b[0];
        line[2 * n++ + 1] = (1 - u) * (double)a[2] + u * (double)b[2];
    }
    return n == 2;
}

/* Points of a body in lists, by the cells of the grid. */
typedef struct output_lists {
    const mpm_world *w;
    int32_t *head, *next; /* per cell: its last point, counted in the body, -1: none; per point: the one before it */
    size_t cells[3];
} output_lists;

static inline size_t output_cell(const output_lists *l, const mpm_real *x, int axis)
{
    const mpm_desc *g = &l->w->desc;
    const double at = ((double)x[axis] - (double)g->origin[axis]) / (double)g->cell;
    return at < 1 ? 0 : at < (double)l->cells[axis] ? (size_t)at : l->cells[axis] - 1;
}

static inline int32_t *output_list(const output_lists *l, size_t i, size_t j, size_t k)
{
    return &l->head[(k * l->cells[1] + j) * l->cells[0] + i];
}

/* Sorts a body's points into them. */
static inline void output_sort(output_lists *l, const mpm_body *b)
{
    mpm_real *const *x = (mpm_real *const *)l->w->points.x;
    int32_t i, *head;
    int k;
    memset(l->head, 0xff, l->cells[0] * l->cells[1] * l->cells[2] * sizeof *l->head); /* -1 */
    for (i = 0; i < b->active; i++) {
        mpm_real at[3];
        for (k = 0; k < 3; k++) at[k] = x[k][b->first + i];
        head = output_list(l, output_cell(l, at, 0), output_cell(l, at, 1), output_cell(l, at, 2));
        l->next[i] = *head;
        *head = i;
    }
}

/* The point nearest to a place, among those in its cell and around it; the body's first if there is none. */
static inline int32_t output_nearest(const output_lists *l, const mpm_body *b, const mpm_real x[3])
{
    const mpm_points *p = &l->w->points;
    double least = HUGE_VAL;
    int32_t best = b->first, i;
    size_t from[3], to[3], c[3];
    int k;
    for (k = 0; k < 3; k++) {
        const size_t at = output_cell(l, x, k);
        from[k] = at > 0 ? at - 1 : 0;
        to[k] = at + 1 < l->cells[k] ? at + 1 : at;
    }
    for (c[2] = from[2]; c[2] <= to[2]; c[2]++)
        for (c[1] = from[1]; c[1] <= to[1]; c[1]++)
            for (c[0] = from[0]; c[0] <= to[0]; c[0]++)
                for (i = *output_list(l, c[0], c[1], c[2]); i >= 0; i = l->next[i]) {
                    const int32_t q = b->first + i;
                    const double dx = (double)(p->x[0][q] - x[0]), dy = (double)(p->x[1][q] - x[1]);
                    const double dz = (double)(p->x[2][q] - x[2]), d = dx * dx + dy * dy + dz * dz;
                    if (d < least) least = d, best = q;
                }
    return best;
}

/* Room for all markers and triangles. Returns 1, or 0 without memory. */
static inline int output_mesh_room(output_mesh *m, const mpm_surfaces *s)
{
    int32_t a;
    for (a = 0; a < s->surfaces; a++) {
        m->places += (size_t)s->surface[a].markers;
        m->triangles += (size_t)s->surface[a].faces;
    }
    m->x[0] = (mpm_real *)malloc(4 * m->places * sizeof *m->x[0]);
    m->near = (int32_t *)malloc((2 * m->places + 3 * m->triangles) * sizeof *m->near);
    if (!m->x[0] || !m->near) return 0;
    m->x[1] = m->x[0] + m->places;
    m->x[2] = m->x[1] + m->places;
    m->value = m->x[2] + m->places;
    m->body = m->near + m->places;
    m->triangle = (int32_t(*)[3])(void *)(m->body + m->places);
    return 1;
}

/* Adds one surface behind those in front of it. */
static inline void output_mesh_add(output_mesh *m, output_lists *l, const mpm_surface *c, int32_t place, size_t face)
{
    const mpm_body *b = &l->w->body[c->body];
    int32_t i;
    int k;
    output_sort(l, b);
    for (i = 0; i < c->faces; i++)
        for (k = 0; k < 3; k++) m->triangle[face + (size_t)i][k] = place + c->face[i][k];
    for (i = 0; i < c->markers; i++) {
        for (k = 0; k < 3; k++) m->x[k][place + i] = c->marker[i].x[k];
        m->near[place + i] = output_nearest(l, b, c->marker[i].x);
        m->body[place + i] = c->body;
    }
}

/* The surfaces of all bodies. Returns 1, or 0 after a message. */
static inline int output_mesh_of(output_mesh *m, const mpm_world *w, const mpm_surfaces *s)
{
    output_lists l;
    size_t face = 0;
    int32_t a, place = 0;
    int k, ok;
    l.w = w;
    for (k = 0; k < 3; k++) l.cells[k] = (size_t)w->desc.cells[k];
    l.head = (int32_t *)malloc(l.cells[0] * l.cells[1] * l.cells[2] * sizeof *l.head);
    l.next = (int32_t *)malloc((size_t)w->points.count * sizeof *l.next);
    ok = (output_mesh_room(m, s) && l.head && l.next) || complain("no memory for surfaces");
    for (a = 0; a < s->surfaces && ok; a++) {
        output_mesh_add(m, &l, &s->surface[a], place, face);
        place += s->surface[a].markers;
        face += (size_t)s->surface[a].faces;
    }
    free(l.head);
    free(l.next);
    return ok;
}

/* Draws the surfaces of bodies over all cuts; in a view from outside they are the bodies. Returns 1, or 0 after a
   message. */
static inline int output_outline(const output *o, output_picture *p, const mpm_world *w, const mpm_surfaces *s)
{
    const double at = p->cut[0].at + 1e-4 * (double)w->desc.cell; /* a mirror is no place to look at triangles from */
    int32_t a, i;
    size_t n = 0;
    int k;
    for (a = 0; a < s->surfaces; a++) n += (size_t)s->surface[a].faces;
    if (n == 0) return 1;
    if (strcmp(o->view, "cut")) return output_mesh_of(&p->mesh, w, s);
    p->outline = (double(*)[4])malloc(n * sizeof *p->outline);
    if (!p->outline) return complain("no memory for outlines");
    for (a = 0, n = 0; a < s->surfaces; a++)
        for (i = 0; i < s->surface[a].faces; i++) n += (size_t)output_crossing(&s->surface[a], i, at, p->outline[n]);
    for (k = 0; k < p->panels; k++) {
        p->cut[k].line_count = n;
        p->cut[k].lines = (const double(*)[4])p->outline;
    }
    return 1;
}

/* A panel's view from outside: of surfaces if there are any, else of the points as balls. */
static inline mpm_draw_solid_desc output_solid(const output_picture *p, int panel)
{
    const mpm_draw_cut_desc *cut = &p->cut[panel];
    const output_mesh *m = &p->mesh;
    mpm_draw_solid_desc d = mpm_draw_solid_of(cut->world, cut->value);
    size_t i;
    int k;
    d.mirror[2] = 0; /* the floor is a wall, not a mirror */
    for (k = 0; k < 4; k++) d.box[k] = cut->window[k % 2];
    for (k = 4; k < 6; k++) d.box[k] = cut->window[k - 2];
    d.map = cut->map;
    d.low = cut->low;
    d.high = cut->high;
    d.label = cut->label;
    d.title = cut->title;
    d.time = cut->time;
    d.length_unit = cut->length_unit;
    if (m->triangles == 0) return d;
    for (i = 0; i < m->places && cut->value; i++) m->value[i] = cut->value[m->near[i]];
    for (k = 0; k < 3; k++) d.x[k] = m->x[k];
    d.world = NULL;
    d.count = m->places;
    d.body = m->body;
    d.triangles = m->triangles;
    d.triangle = (const int32_t(*)[3])m->triangle;
    d.value = cut->value ? m->value : NULL;
    return d;
}

/* All panels on a canvas of their own: up to three beside each other. */
static inline mpm_status output_draw(const output *o, const output_picture *p, mpm_draw_canvas *c, mpm_fault *fault)
{
    const int columns = p->panels <= 3 ? p->panels : (p->panels + 1) / 2, rows = (p->panels - 1) / columns + 1;
    const double *window = p->cut[0].window, wide = window[1] - window[0], high = window[3] - window[2];
    const int tall = (int)fmin(fmax(800 * (0.66 * high + 0.42 * wide) / wide, 500), 1100); /* room for what is seen */
    mpm_status status;
    int k;
    if (!strcmp(o->view, "cut")) return mpm_draw_cuts(c, p->cut, p->panels, columns, 800, fault);
    status = mpm_draw_canvas_init(c, 800 * columns, tall * rows, NULL, 0);
    if (status < 0) return mpm_fail(fault, status, "size of picture", (mpm_real)tall, -1);
    for (k = 0; k < p->panels && status >= 0; k++) {
        const mpm_draw_solid_desc d = output_solid(p, k);
        status = mpm_draw_solid(c, mpm_draw_tile(c, columns, rows, k), &d, fault);
    }
    if (status < 0) mpm_draw_canvas_free(c);
    return status;
}

static inline int output_png(output *o, const output_picture *p, const char *name)
{
    const clock_t mark = clock();
    char path[PATH_BYTES];
    mpm_draw_canvas c;
    mpm_fault fault;
    int ok = output_draw(o, p, &c, &fault) >= 0;
    file_in(o->folder, name, path, sizeof path);
    if (ok) {
        ok = mpm_io_png(path, c.rgb, c.width, c.height, p->title, &fault) >= 0;
        mpm_draw_canvas_free(&c);
    }
    o->writing += clock() - mark;
    return ok || report(&fault, path);
}

/* All pictures of frames so far as one film, film.png; of one picture there is none. */
static inline int output_film(output *o, const char *note)
{
    const clock_t mark = clock();
    char path[PATH_BYTES], frame[PATH_BYTES], name[64];
    mpm_io_film film;
    mpm_fault fault;
    int64_t k;
    if (o->frame < 2) return 1;
    file_in(o->folder, "film.png", path, sizeof path);
    mpm_io_film_begin(&film, path, o->frame > 40 ? 4.0 / (double)o->frame : 0.1 + 3.0 / (double)o->frame, note, &fault);
    for (k = 0; k < o->frame && film.status >= 0; k++) {
        snprintf(name, sizeof name, "frame_%04lld.png", (long long)k);
        if (k + 1 == o->frame) film.seconds = 2; /* the end is looked at */
        mpm_io_film_add_png(&film, file_in(o->folder, name, frame, sizeof frame), &fault);
    }
    o->writing += clock() - mark;
    return mpm_io_film_end(&film, &fault) >= 0 || report(&fault, k > 0 && film.pictures < o->frame ? frame : path);
}

/* ---- frames -------------------------------------------------------------------------------- */

#define OUTPUT_FIELDS 11 /* of every run */
#define OUTPUT_MORE 4    /* room for its own */

/* With --hdf5: the frame that a .vtu was written of, into folder/series.vtkhdf, and series.xmf of all so far. */
static inline int output_hdf5(const output *o, const mpm_io_vtu_desc *v, const char *series)
{
    mpm_hdf5_field field[OUTPUT_FIELDS + OUTPUT_MORE];
    mpm_hdf5_desc d = mpm_hdf5_desc_default();
    char name[64], path[PATH_BYTES], xmf[PATH_BYTES];
    mpm_fault fault;
    int k;
    if (o->hdf5 < 0) return 1;
    for (k = 0; k < v->field_count; k++) {
        const mpm_io_field *f = &v->fields[k];
        field[k] = mpm_hdf5_scalar(f->name, NULL, f->scale);
        field[k].components = f->components;
        memcpy(field[k].data, f->data, sizeof field[k].data);
        field[k].bytes = f->bytes;
        field[k].integers = f->integers;
    }
    d.count = v->count;
    memcpy(d.x, v->x, sizeof d.x);
    d.fields = field;
    d.field_count = v->field_count;
    d.time = v->time;
    d.float32 = v->float32;
    d.gzip = (int)o->hdf5;
    d.note = v->note;
    d.cell_count = v->cell_count;
    d.cell_points = v->cell_points;
    d.cells = v->cells;
    snprintf(name, sizeof name, "%s.vtkhdf", series);
    file_in(o->folder, name, path, sizeof path);
    snprintf(name, sizeof name, "%s.xmf", series);
    return (mpm_hdf5_frame(path, o->frame, &d, &fault) >= 0 &&
            mpm_hdf5_xdmf(path, file_in(o->folder, name, xmf, sizeof xmf), &fault) >= 0) || report(&fault, path);
}

/* All that ParaView can show, with `count` fields of the run's own, into folder/name. */
static inline int output_points(const output *o, const mpm_world *w, const mpm_io_field *more, int count,
                                const char *name)
{
    const mpm_points *p = &w->points;
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_io_field field[OUTPUT_FIELDS + OUTPUT_MORE];
    mpm_fault fault;
    char path[PATH_BYTES], note[80];
    int32_t *body = (int32_t *)malloc((size_t)p->count * sizeof *body);
    int a, ok;
    if (!body) return complain("no memory for output");
    mpm_io_body_numbers(w, body);
    field[0] = mpm_io_vector("velocity (m/s)", p->v[0], p->v[1], p->v[2], 1);
    field[1] = mpm_io_tensor("stress (MPa)", p->stress[0], p->stress[1], p->stress[2], p->stress[3], p->stress[4],
                             p->stress[5], 1);
    field[2] = mpm_io_scalar("density (g/cm3)", p->density, 1e3);
    field[3] = mpm_io_scalar("temperature (K)", p->temperature, 1);
    field[4] = mpm_io_scalar("plastic strain", p->plastic_strain, 1);
    field[5] = mpm_io_scalar("plastic strain rate (1/us)", p->plastic_rate, o->rate);
    field[6] = mpm_io_scalar("plastic energy density (MPa)", p->plastic_work, 1);
    field[7] = mpm_io_scalar("bond D", p->bond, 1);
    field[8] = mpm_io_int32("body", body);
    field[9] = mpm_io_int32("id", p->id);
    field[10] = mpm_io_uint8("surface", p->flags);
    for (a = 0; a < count && a < OUTPUT_MORE; a++) field[OUTPUT_FIELDS + a] = more[a];
    snprintf(note, sizeof note, "%s: lengths %s, time %s", o->name, o->length, o->time);
    d.count = (size_t)p->count;
    for (a = 0; a < 3; a++) d.x[a] = p->x[a];
    d.fields = field;
    d.field_count = OUTPUT_FIELDS + (count < OUTPUT_MORE ? count : OUTPUT_MORE);
    d.time = (double)w->time * 1e3;
    d.float32 = 1;
    d.note = note;
    ok = mpm_io_vtu(file_in(o->folder, name, path, sizeof path), &d, &fault) >= 0 || report(&fault, path);
    ok = ok && output_hdf5(o, &d, o->name);
    free(body);
    return ok;
}

#define OUTPUT_MARKER 14 /* values of a marker: place, velocity, traction of adhesion, pressure, gap, G, W, opening */

/* What a marker's meetings are together: sums of pressure and traction, of the others the one that tells most. */
static inline void output_meets(const mpm_surfaces *s, const mpm_marker *m, mpm_real cell, mpm_real *value)
{
    int k, d;
    memset(value, 0, 8 * sizeof *value);
    value[4] = cell;
    for (k = 0; k < MPM_SURFACE_MEETS; k++) {
        const mpm_meet *meet = &m->meet[k];
        const mpm_real bond = mpm_surface_adhesion(s, meet);
        if (meet->other == MPM_SURFACE_NONE) continue;
        for (d = 0; d < 3; d++) value[d] += meet->tension[d];
        value[3] += meet->pressure;
        if (meet->gap < value[4]) value[4] = meet->gap;
        if (meet->dissipated > value[5]) value[5] = meet->dissipated;
        if (bond > value[6]) value[6] = bond;
        if (meet->opened > value[7]) value[7] = meet->opened;
    }
}

/* All markers' values, one array after the other, n long each; their bodies, and the faces between them. */
static inline void output_markers(const mpm_world *w, const mpm_surfaces *s, int32_t n, mpm_real *value, int32_t *body,
                                  int32_t *cell)
{
    int32_t a, i, from = 0;
    int k;
    for (a = 0; a < s->surfaces; from += s->surface[a++].markers) {
        const mpm_surface *c = &s->surface[a];
        for (i = 0; i < c->faces; i++)
            for (k = 0; k < c->corners; k++) *cell++ = from + c->face[i][k];
        for (i = 0; i < c->markers; i++) {
            const mpm_marker *p = &c->marker[i];
            mpm_real one[OUTPUT_MARKER];
            for (k = 0; k < 3; k++) {
                one[k] = p->x[k];
                one[3 + k] = p->v[k];
            }
            output_meets(s, p, w->desc.cell, one + 6);
            for (k = 0; k < OUTPUT_MARKER; k++) value[(size_t)k * (size_t)n + (size_t)(from + i)] = one[k];
            body[from + i] = c->body;
        }
    }
}

/* Writes them as folder/name. */
static inline int output_cells(const output *o, const mpm_world *w, int32_t n, const mpm_real *value,
                               const int32_t *body, const int32_t *cell, int32_t cells, const char *name)
{
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_io_field field[8];
    const mpm_real *at[OUTPUT_MARKER];
    char path[PATH_BYTES], note[80];
    mpm_fault fault;
    int k;
    for (k = 0; k < OUTPUT_MARKER; k++) at[k] = value + (size_t)k * (size_t)n;
    field[0] = mpm_io_vector("velocity (m/s)", at[3], at[4], at[5], 1);
    field[1] = mpm_io_vector("traction of adhesion (MPa)", at[6], at[7], at[8], 1);
    field[2] = mpm_io_scalar("contact pressure (MPa)", at[9], 1);
    field[3] = mpm_io_scalar("gap (um)", at[10], 1);
    field[4] = mpm_io_scalar("interface dissipation (J/m2)", at[11], 1);
    field[5] = mpm_io_scalar("adhesion (J/m2)", at[12], 1);
    field[6] = mpm_io_scalar("opening (um)", at[13], 1);
    field[7] = mpm_io_int32("body", body);
    snprintf(note, sizeof note, "%s: lengths %s, time %s", o->name, o->length, o->time);
    d.count = (size_t)n;
    for (k = 0; k < 3; k++) d.x[k] = at[k];
    d.fields = field;
    d.field_count = 8;
    d.cells = cell;
    d.cell_points = w->desc.geometry == MPM_3D ? 3 : 2;
    d.cell_count = (size_t)cells;
    d.time = (double)w->time * 1e3;
    d.float32 = 1;
    d.note = note;
    if (mpm_io_vtu(file_in(o->folder, name, path, sizeof path), &d, &fault) < 0) return report(&fault, path);
    return output_hdf5(o, &d, "surface");
}

/* The surfaces of the frame to come, surface_NNNN.vtu, and its entry in a series of their own, surface.pvd. */
static inline int output_surfaces(output *o, const mpm_world *w, const mpm_surfaces *s)
{
    const clock_t mark = clock();
    mpm_real *value;
    int32_t *cell, *body, a, n = 0, cells = 0;
    char name[64], path[PATH_BYTES];
    mpm_fault fault;
    int ok;
    for (a = 0; a < s->surfaces; a++) n += s->surface[a].markers, cells += s->surface[a].faces;
    if (n == 0) return 1;
    value = (mpm_real *)malloc((size_t)n * OUTPUT_MARKER * sizeof *value);
    body = (int32_t *)malloc((size_t)n * sizeof *body);
    cell = (int32_t *)malloc((size_t)cells * 3 * sizeof *cell);
    snprintf(name, sizeof name, "surface_%04lld.vtu", (long long)o->frame);
    ok = (value && body && cell) || complain("no memory for surfaces");
    if (ok) output_markers(w, s, n, value, body, cell);
    ok = ok && output_cells(o, w, n, value, body, cell, cells, name);
    file_in(o->folder, "surface.pvd", path, sizeof path);
    if (ok && ((o->frame == 0 && mpm_io_pvd_begin(path, &fault) < 0) ||
               mpm_io_pvd_add(path, name, (double)w->time * 1e3, &fault) < 0))
        ok = report(&fault, path);
    free(value);
    free(body);
    free(cell);
    o->writing += clock() - mark;
    return ok;
}

/* The next frame: points_NNNN.vtu, its entry in the series, and frame_NNNN.png. */
static inline int output_frame(output *o, const mpm_world *w, const mpm_io_field *more, int count,
                               const output_picture *p)
{
    const clock_t mark = clock();
    char series[64], name[64], path[PATH_BYTES];
    mpm_fault fault;
    snprintf(series, sizeof series, "%s.pvd", o->name);
    snprintf(name, sizeof name, "points_%04lld.vtu", (long long)o->frame);
    if (!output_points(o, w, more, count, name)) return 0;
    if (mpm_io_pvd_add(file_in(o->folder, series, path, sizeof path), name, (double)w->time * 1e3, &fault) < 0)
        return report(&fault, path);
    o->writing += clock() - mark;
    snprintf(name, sizeof name, "frame_%04lld.png", (long long)o->frame++);
    return output_png(o, p, name);
}

/* ---- progress ------------------------------------------------------------------------------ */

/* The progress line, once a second. */
static inline void output_progress(output *o, const mpm_world *w, int64_t steps)
{
    mpm_io_progress p;
    char line[160];
    if (!progress_due(&o->line, (double)w->steps / (double)steps)) return;
    memset(&p, 0, sizeof p);
    p.step = w->steps;
    p.first_step = o->first;
    p.steps = steps;
    p.time = (double)w->time * 1e3;
    p.time_unit = o->time;
    p.points = (double)w->points.count;
    p.elapsed = progress_elapsed(&o->line);
    mpm_io_progress_text(line, sizeof line, &p);
    progress_show(&o->line, line);
}

static inline void output_progress_end(const output *o) { progress_end(&o->line); }

#endif
