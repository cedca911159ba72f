/* figures - draws the figures of docs/method.md: docs/data/method_point.png, method_contact.png, method_bond.png.
   Positions, weights, normals, slots and D in them are the library's own. Run from the top folder.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"
#include "mpm_bond.h"
#include "mpm_draw.h"
#include "mpm_io.h"

#include <stdio.h>

enum { INK = 0x222222, GREY = 0xaaaaaa, PALE = 0xc8c8c8, RED = 0xc0392b, BLUE = 0x2c5f9e, SAND = 0xd9a441 };

/* Where a plane of the model lies on a canvas: y of the picture points down. */
typedef struct view { mpm_draw_canvas *c; double x, y, scale; } view;

static double across(const view *v, double x) { return v->x + v->scale * x; }
static double down(const view *v, double z) { return v->y - v->scale * z; }

static void line(const view *v, double ax, double az, double bx, double bz, double width, mpm_draw_color color)
{
    mpm_draw_line(v->c, across(v, ax), down(v, az), across(v, bx), down(v, bz), width, color);
}

static void dashed(const view *v, double ax, double az, double bx, double bz, mpm_draw_color color)
{
    const int n = (int)(sqrt((bx - ax) * (bx - ax) + (bz - az) * (bz - az)) * v->scale / 9) + 1;
    int i;
    for (i = 0; i < n; i++) {
        const double s = (double)i / n, t = (i + 0.55) / n;
        line(v, ax + s * (bx - ax), az + s * (bz - az), ax + t * (bx - ax), az + t * (bz - az), 1, color);
    }
}

/* An arrow in pixels. */
static void arrow(mpm_draw_canvas *c, double ax, double ay, double bx, double by, double width, mpm_draw_color color)
{
    const double length = sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay)), ux = (bx - ax) / length;
    const double uy = (by - ay) / length, head = 5 + 2 * width;
    mpm_draw_line(c, ax, ay, bx, by, width, color);
    mpm_draw_line(c, bx, by, bx - head * ux + head / 2 * uy, by - head * uy - head / 2 * ux, width, color);
    mpm_draw_line(c, bx, by, bx - head * ux - head / 2 * uy, by - head * uy + head / 2 * ux, width, color);
}

static void label(mpm_draw_canvas *c, double x, double y, mpm_draw_color color, const char *text)
{
    mpm_draw_text(c, x, y, 10, MPM_DRAW_LEFT, color, text);
}

/* A square of the model, centred. */
static void square(const view *v, double x, double z, double edge, mpm_draw_color color)
{
    const double w = v->scale * edge;
    mpm_draw_rectangle(v->c, across(v, x) - w / 2, down(v, z) - w / 2, w, w, color);
}

/* Writes the picture and gives it back. */
static int finish(mpm_draw_canvas *c, const char *path, const char *note)
{
    mpm_fault fault;
    const mpm_status s = mpm_io_png(path, c->rgb, c->width, c->height, note, &fault);
    mpm_draw_canvas_free(c);
    if (s < 0) fprintf(stderr, "figures: %s: %s\n", path, mpm_status_text(s));
    return s >= 0;
}

/* ---- a point and its eight nodes ------------------------------------------------------------------------------ */

/* Oblique view: y runs to the back. */
static void oblique(const double *x, double *px, double *pz)
{
    *px = x[0] + 0.45 * x[1];
    *pz = x[2] + 0.32 * x[1];
}

/* The hat of one direction, and its mean over a point two of which lie in a cell. */
static double hat(double u) { return fabs(u) < 1 ? 1 - fabs(u) : 0; }
static double mean_hat(double u)
{
    double sum = 0;
    int i;
    for (i = 0; i < 200; i++) sum += hat(u - 0.25 + (i + 0.5) / 400);
    return sum / 200;
}

static void hats(mpm_draw_canvas *c, mpm_draw_rect where)
{
    static mpm_real u[301], linear[301], smooth[301];
    mpm_draw_curve curve[2];
    mpm_draw_plot_desc d = mpm_draw_plot_desc_default();
    int i;
    for (i = 0; i < 301; i++) {
        u[i] = (mpm_real)(-1.5 + 0.01 * i);
        linear[i] = (mpm_real)hat((double)u[i]);
        smooth[i] = (mpm_real)mean_hat((double)u[i]);
    }
    for (i = 0; i < 2; i++) {
        curve[i].name = i ? "GIMP, point half a cell wide" : "linear";
        curve[i].count = 301;
        curve[i].x = u;
        curve[i].y = i ? smooth : linear;
        curve[i].mark = i ? MPM_DRAW_DASHED : MPM_DRAW_CURVE;
        curve[i].color = i;
    }
    d.curves = curve;
    d.curve_count = 2;
    d.window[0] = -1.5;
    d.window[1] = 1.5;
    d.window[3] = 1.3;
    d.title = "N of a node along one axis";
    d.x_label = "distance from the node, cells";
    mpm_draw_plot(c, where, &d, NULL);
}

static int point_and_nodes(void)
{
    const double x[3] = {0.7657, 0.2550, 0.6508}; /* the worked point of the page */
    mpm_draw_canvas c;
    mpm_draw_rect right = {470, 20, 420, 340};
    view v = {&c, 70, 325, 195};
    double px, pz;
    int a, d;
    if (mpm_draw_canvas_init(&c, 900, 380, NULL, 0) < 0) return 0;
    oblique(x, &px, &pz);
    for (a = 0; a < 8; a++) {
        const double at[3] = {a & 1, a >> 1 & 1, a >> 2};
        double qx, qz;
        oblique(at, &qx, &qz);
        for (d = 0; d < 3; d++) {
            double end[3] = {at[0], at[1], at[2]}, ex, ez;
            if (at[d] > 0) continue;
            end[d] = 1;
            oblique(end, &ex, &ez);
            line(&v, qx, qz, ex, ez, 1.5, GREY);
        }
        dashed(&v, px, pz, qx, qz, BLUE);
    }
    for (a = 0; a < 8; a++) {
        const double at[3] = {a & 1, a >> 1 & 1, a >> 2};
        double qx, qz, N = 1;
        char text[40];
        oblique(at, &qx, &qz);
        for (d = 0; d < 3; d++) N *= 1 - fabs(x[d] - at[d]);
        mpm_draw_disc(&c, across(&v, qx), down(&v, qz), 3 + 22 * sqrt(N), SAND);
        mpm_draw_disc(&c, across(&v, qx), down(&v, qz), 2.5, INK);
        snprintf(text, sizeof text, "%d %d %d: %.3f", 5 + (a & 1), 5 + (a >> 1 & 1), 4 + (a >> 2), N);
        px = across(&v, qx) - 34;
        pz = down(&v, qz) + (at[2] > 0 ? -22 : 30);
        mpm_draw_rectangle(&c, px - 2, pz - 13, mpm_draw_text_width(10, text) + 4, 16, 0xffffff);
        label(&c, px, pz, INK, text);
    }
    oblique(x, &px, &pz);
    mpm_draw_disc(&c, across(&v, px), down(&v, pz), 6, RED);
    label(&c, across(&v, px) + 10, down(&v, pz) + 4, RED, "x_p");
    hats(&c, right);
    return finish(&c, "docs/data/method_point.png", "a point and its eight nodes");
}

/* ---- two bodies at one node ----------------------------------------------------------------------------------- */

/* Points of body b of a plane world, as squares a little smaller than they are. */
static void squares(const view *v, const mpm_world *w, int32_t b, double edge, mpm_draw_color color)
{
    int32_t i;
    for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++)
        square(v, (double)w->points.x[0][i], (double)w->points.x[2][i], edge, color);
}

static void grid(const view *v, double x0, double z0, int nx, int nz)
{
    int i;
    for (i = 0; i <= nx; i++) line(v, x0 + i, z0, x0 + i, z0 + nz, 1, PALE);
    for (i = 0; i <= nz; i++) line(v, x0, z0 + i, x0 + nx, z0 + i, 1, PALE);
}

/* A box with two lines of text, for a record in memory. */
static void record(mpm_draw_canvas *c, double x, double y, mpm_draw_color color, const char *one, const char *two)
{
    mpm_draw_rectangle(c, x, y, 150, 46, color);
    mpm_draw_rectangle(c, x + 2, y + 2, 146, 42, 0xffffff);
    label(c, x + 10, y + 19, INK, one);
    label(c, x + 10, y + 36, INK, two);
}

static mpm_body_desc plain_body(mpm_shape shape, double vz)
{
    mpm_body_desc b = mpm_body_desc_default();
    b.shape = shape;
    b.spacing = MPM_R(0.5);
    b.density = 1;
    b.velocity[2] = (mpm_real)vz;
    return b;
}

/* The pair whose node is nearest to (x, z). */
static const mpm_pair *nearest(const mpm_world *w, double x, double z)
{
    const mpm_pair *best = NULL;
    double least = 1e30;
    int32_t i;
    for (i = 0; i < w->pairs; i++) {
        mpm_real q[3];
        double far;
        mpm_node_position(w, &w->node[w->pair[i].a], q);
        far = ((double)q[0] - x) * ((double)q[0] - x) + ((double)q[2] - z) * ((double)q[2] - z);
        if (far < least) least = far, best = &w->pair[i];
    }
    return best;
}

static void chain(mpm_draw_canvas *c, const mpm_world *w, const mpm_pair *pair)
{
    char one[80], two[80];
    int k;
    snprintf(one, sizeof one, "head[%d] = %d", (int)w->node[pair->a].index, (int)w->head[w->node[pair->a].index]);
    record(c, 520, 40, INK, one, "first slot of the node");
    for (k = 0; k < 2; k++) {
        const int32_t s = k ? pair->a : pair->b;
        const mpm_node *n = &w->node[s];
        snprintf(one, sizeof one, "slot %d: body %d", (int)s, (int)n->body);
        snprintf(two, sizeof two, "m %.3f, next %d", (double)n->mass, (int)n->next);
        record(c, 520, 120 + 80 * k, k ? BLUE : SAND, one, two);
        arrow(c, 595, 90 + 80 * k, 595, 117 + 80 * k, 2, INK);
    }
    record(c, 720, 160, RED, "pair of slots a, b", "normal, impulse");
    snprintf(one, sizeof one, "a = %d, b = %d", (int)pair->a, (int)pair->b);
    label(c, 722, 226, INK, one);
    snprintf(two, sizeof two, "n = %.2f 0 %.2f", (double)pair->normal[0], (double)pair->normal[2]);
    label(c, 722, 244, INK, two);
    arrow(c, 718, 175, 673, 148, 1.5, RED);
    arrow(c, 718, 190, 673, 218, 1.5, RED);
}

static int two_bodies(void)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc ball = plain_body(mpm_sphere(MPM_R(5.5), 0, MPM_R(6.4), MPM_R(2.6)), -1);
    mpm_body_desc hill = plain_body(mpm_sphere(MPM_R(3.5), 0, MPM_R(1.0), MPM_R(2.8)), 0);
    mpm_draw_canvas c;
    view v = {&c, 10, 370, 46};
    const mpm_pair *pair;
    mpm_real at[3];
    mpm_world w;
    int i;
    d.geometry = MPM_PLANE_STRAIN;
    d.cell = 1;
    d.cells[0] = 10;
    d.cells[2] = 12;
    d.origin[2] = -3;
    if (mpm_init(&w, &d, NULL, 0) < 0 || mpm_body_add(&w, &ball) < 0 || mpm_body_add(&w, &hill) < 0) return 0;
    if (mpm_locate(&w, 1) < 0) return 0;
    mpm_p2g(&w);
    mpm_contact_find(&w);
    if (!(pair = nearest(&w, 4, 4)) || mpm_draw_canvas_init(&c, 900, 380, NULL, 0) < 0) return 0;
    c.clip[2] = 490; /* the scene; records stand beside it */
    grid(&v, 0, 0, 10, 8);
    squares(&v, &w, 0, 0.42, 0xb9cde6);
    squares(&v, &w, 1, 0.42, 0xf2dcb3);
    for (i = 0; i < w.pairs; i++) {
        mpm_node_position(&w, &w.node[w.pair[i].a], at);
        mpm_draw_disc(&c, across(&v, (double)at[0]), down(&v, (double)at[2]), 4, INK);
    }
    mpm_node_position(&w, &w.node[pair->a], at);
    mpm_draw_disc(&c, across(&v, (double)at[0]), down(&v, (double)at[2]), 7, RED);
    arrow(&c, across(&v, (double)at[0]), down(&v, (double)at[2]),
          across(&v, (double)at[0] + 1.2 * (double)pair->normal[0]),
          down(&v, (double)at[2] + 1.2 * (double)pair->normal[2]), 3, RED);
    c.clip[2] = 900;
    label(&c, 210, 30, BLUE, "body 0, a");
    label(&c, 180, 360, 0x9a6b10, "body 1, b");
    label(&c, across(&v, (double)at[0]) + 12, down(&v, (double)at[2]) - 8, RED, "the node");
    label(&c, across(&v, (double)at[0] + 1.3 * (double)pair->normal[0]) - 14,
          down(&v, (double)at[2] + 1.3 * (double)pair->normal[2]) + 14, RED, "n");
    mpm_draw_disc(&c, 530, 300, 4, INK);
    label(&c, 545, 304, INK, "nodes that carry both: contact");
    chain(&c, &w, pair);
    mpm_free(&w);
    return finish(&c, "docs/data/method_contact.png", "two bodies at one node");
}

/* ---- D of surface points and the nodes it reaches ------------------------------------------------------------- */

/* The program in mpm_bond.h, for a time. */
static int impact(mpm_world *w, mpm_bond *bond, mpm_material *al, double time)
{
    const mpm_shape ball = mpm_sphere(0, 0, 7, 7), plate = mpm_cylinder(0, 0, -10, 15, 10);
    const mpm_units units = mpm_units_um_us_ng();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_desc d = mpm_desc_default();
    mpm_real dt;
    *bond = mpm_bond_default(&units);
    d.geometry = MPM_AXISYMMETRIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    d.cell = 1;
    d.cells[0] = 29;
    d.cells[2] = 42;
    d.origin[2] = -14;
    if (mpm_material_preset(al, "al", &units, NULL) < 0 || mpm_init(w, &d, NULL, 0) < 0) return 0;
    b.spacing = MPM_R(0.5);
    b.density = al->density;
    b.temperature = al->temperature;
    b.stress = mpm_material_stress;
    b.material = al;
    mpm_material_wave_speeds(al, al->density, &b.wave_p, &b.wave_s);
    b.shape = ball;
    b.velocity[2] = -900;
    if (mpm_body_add(w, &b) < 0) return 0;
    b.shape = plate;
    b.velocity[2] = 0;
    b.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    if (mpm_body_add(w, &b) < 0) return 0;
    dt = MPM_R(0.1) * d.cell / b.wave_p;
    while ((double)w->time < time)
        if (mpm_bond_step(bond, w, dt) < 0) return 0;
    return 1;
}

static void bond_points(const view *v, const mpm_world *w)
{
    const mpm_points *q = &w->points;
    int32_t b, i;
    for (b = 0; b < 2; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            const double D = (double)q->bond[i];
            const double edge = sqrt((double)(q->mass[i] / q->density[i] / q->x[0][i]) / 6.2832);
            mpm_draw_color color = b ? 0xd8d0c0 : 0xe3e8ee;
            if (D > 0) color = mpm_draw_map_color(MPM_DRAW_HEAT, D / 2);
            square(v, (double)q->x[0][i], (double)q->x[2][i], 0.8 * edge, color);
        }
}

/* A node where bodies meet: full if its pair is held. */
static void contact_node(mpm_draw_canvas *c, double x, double y, int held)
{
    mpm_draw_disc(c, x, y, 6.5, INK);
    if (!held) mpm_draw_disc(c, x, y, 4.5, 0xffffff);
}

static int bonded(void)
{
    mpm_draw_canvas c;
    mpm_draw_rect bar = {620, 190, 240, 60};
    view v = {&c, 20, 125, 48};
    mpm_material al;
    mpm_bond bond;
    mpm_world w;
    int32_t i;
    if (!impact(&w, &bond, &al, 0.008) || mpm_draw_canvas_init(&c, 900, 380, NULL, 0) < 0) return 0;
    c.clip[2] = 590;
    bond_points(&v, &w);
    grid(&v, 0, -6, 12, 9);
    for (i = 0; i < w.pairs; i++) {
        mpm_real at[3];
        mpm_node_position(&w, &w.node[w.pair[i].a], at);
        contact_node(&c, across(&v, (double)at[0]), down(&v, (double)at[2]), w.pair[i].hold > 0);
    }
    c.clip[2] = 900;
    label(&c, 620, 60, INK, "nodes where both bodies meet:");
    contact_node(&c, 630, 84, 1);
    label(&c, 650, 88, INK, "mean D is 1 or more: held");
    contact_node(&c, 630, 110, 0);
    label(&c, 650, 114, INK, "below: free to part");
    label(&c, 620, 160, INK, "surface points in contact, by D:");
    mpm_draw_color_bar(&c, bar, MPM_DRAW_HEAT, 0, 2, "D");
    mpm_free(&w);
    return finish(&c, "docs/data/method_bond.png", "D of surface points and the nodes it reaches");
}

int main(void)
{
    return point_and_nodes() && two_bodies() && bonded() ? 0 : 1;
}
