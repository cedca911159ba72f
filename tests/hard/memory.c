/* memory - every allocation fails in turn: setting up, bodies, clouds, rules, user fields, growth during steps, a
   picture, its file, a solid, a film, surfaces of two and three dimensions, a spray. A failure is a status, what was
   there goes on, nothing is lost. One line at the end. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static long count, failing; /* allocations of this attempt; which of them fails */
static void *hard_malloc(size_t n) { return ++count == failing ? NULL : malloc(n); }
#define MPM_MALLOC(n) hard_malloc(n)
#define MPM_FREE(p) free(p)
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_draw.h"
#include "mpm_io.h"
#include "mpm_measure.h"
#include "mpm_spray.h"
#include "mpm_surface.h"

static long wrong;

static void want(int ok, const char *what)
{
    if (ok) return;
    wrong++;
    printf("memory: wrong at allocation %ld: %s\n", failing, what);
}

/* A status from something that allocates: good, or MPM_ERR_MEMORY; what failed is tried once more. */
#define TRY(call) do { \
    const mpm_status first = (call); \
    if (first < 0) { \
        want(first == MPM_ERR_MEMORY, #call); \
        want((call) >= 0, "again: " #call); \
    } } while (0)

/* A film of a canvas, twice. */
static mpm_status film(const mpm_draw_canvas *c, mpm_fault *fault)
{
    mpm_io_film f;
    mpm_io_film_begin(&f, "build/hard/film.png", 1, NULL, fault);
    mpm_io_film_add(&f, c->rgb, c->width, c->height, fault);
    mpm_io_film_add(&f, c->rgb, c->width, c->height, fault);
    return mpm_io_film_end(&f, fault);
}

/* Balls, and triangles between the places. */
static void solids(const mpm_world *w)
{
    static const int32_t corner[1][3] = {{0, 40, 90}};
    mpm_draw_solid_desc d = mpm_draw_solid_of(w, w->points.temperature);
    mpm_draw_canvas c;
    mpm_fault fault;
    TRY(mpm_draw_canvas_init(&c, 60, 40, NULL, 0));
    TRY(mpm_draw_solid(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &fault));
    d.triangles = 1;
    d.triangle = corner;
    TRY(mpm_draw_solid(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &fault));
    TRY(film(&c, &fault));
    mpm_draw_canvas_free(&c);
}

static void world(void)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_contact rule = d.contact;
    mpm_real x[2] = {MPM_R(1.2), MPM_R(1.4)};
    mpm_draw_canvas c;
    mpm_draw_cut_desc cut;
    mpm_pieces pieces;
    mpm_fault fault;
    mpm_cloud cloud;
    mpm_world w;
    int i, field;
    d.cell = 1;
    d.cells[0] = d.cells[1] = d.cells[2] = 16;
    b.spacing = MPM_R(0.5);
    b.density = 1;
    TRY(mpm_init(&w, &d, NULL, 0));
    b.shape = mpm_sphere(4, 4, 10, 2);
    b.velocity[2] = -1;
    TRY(mpm_body_add(&w, &b));
    b.shape = mpm_box(2, 2, 4, 9, 9, 7);
    TRY(mpm_body_add(&w, &b));
    memset(&cloud, 0, sizeof cloud);
    cloud.count = 2;
    cloud.x[0] = cloud.x[1] = cloud.x[2] = x;
    TRY(mpm_body_add_points(&w, &b, &cloud));
    TRY(mpm_points_add(&w, 2, &cloud));
    rule.normal = MPM_NORMAL_LOGISTIC;
    TRY(mpm_contact_set(&w, 0, 1, &rule));
    field = mpm_field_take(&w, "mine");
    if (field < 0) field = mpm_field_take(&w, "mine");
    want(field >= 0, "mpm_field_take, twice");
    for (i = 0; i < w.points.count; i++) w.points.v[i % 3][i] += (mpm_real)(i % 7) - 3; /* apart: more and more nodes */
    for (i = 0; i < 20; i++) TRY(mpm_step(&w, MPM_R(0.02)));
    TRY(mpm_pieces_of(&w, 0, &pieces));
    cut = mpm_draw_cut_of(&w, NULL);
    cut.at = 4;
    TRY(mpm_draw_cuts(&c, &cut, 1, 1, 120, &fault));
    TRY(mpm_io_png("build/hard/memory.png", c.rgb, c.width, c.height, "memory", &fault));
    mpm_draw_canvas_free(&c);
    solids(&w);
    mpm_free(&w);
}

/* A ball over a block, by their shapes; the ball in three dimensions as a function says. */
static int inside(void *context, const mpm_real x[3])
{
    (void)context;
    return (x[0] - 8) * (x[0] - 8) + (x[1] - 8) * (x[1] - 8) + (x[2] - 10) * (x[2] - 10) < 4;
}

static void surfaces(mpm_geometry geometry)
{
    const mpm_real low[3] = {5, 5, 7}, high[3] = {11, 11, 13};
    const int deep = geometry == MPM_3D;
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_surfaces s = mpm_surfaces_default();
    mpm_world w;
    int32_t k, i, before;
    d.geometry = geometry;
    d.basis = MPM_CUBIC;
    d.cell = 1;
    d.cells[0] = d.cells[1] = d.cells[2] = 16;
    b.spacing = MPM_R(0.5);
    b.density = b.wave_p = b.wave_s = 1;
    s.adhesion = s.critical = s.depth = s.reach = 1;
    TRY(mpm_init(&w, &d, NULL, 0));
    for (k = 0; k < 2; k++) {
        b.shape = deep ? mpm_shape_user(inside, NULL, low, high) : mpm_sphere(8, 0, 10, 2);
        if (k) b.shape = deep ? mpm_box(6, 6, 5, 10, 10, 8) : mpm_box(4, 0, 2, 12, 1, 8);
        TRY(mpm_body_add(&w, &b));
        TRY(mpm_surface_add(&s, &w, k));
    }
    before = s.surface[1].markers;
    for (i = 0; i < w.points.count; i++) w.points.v[0][i] = (w.points.x[0][i] - 8) / 2; /* faces grow */
    for (i = 0; i < (deep ? 8 : 20); i++) TRY(mpm_surface_step(&s, &w, deep ? MPM_R(0.3) : MPM_R(0.1)));
    want(s.surface[1].markers > before, "halved");
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

static void spray(void)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray s;
    d.capacity = 100;
    d.batch = 10;
    TRY(mpm_spray_init(&s, &d, NULL, 0));
    want(mpm_spray_step(&s) >= 0, "mpm_spray_step");
    mpm_spray_free(&s);
}

int main(void)
{
    for (failing = 1;; failing++) {
        count = 0;
        world();
        surfaces(MPM_PLANE_STRAIN);
        surfaces(MPM_3D);
        spray();
        if (count < failing) break;
    }
    printf("memory: %ld allocations failed in turn, %ld wrong\n", failing - 1, wrong);
    return wrong > 0;
}
