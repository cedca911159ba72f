/* 34_triangles - surfaces of bodies in three dimensions, and of shapes that a function gives: areas, volumes, normals,
   mirrors, dampers; the caller's own triangles; faces beside faces through refinement; layers; bars, and a ball on a
   block beside axisymmetry: gaps to the sphere, any size. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "mpm_surface.h"
#include "check.h"

static const double eps = (double)MPM_EPSILON;
static const double pi = 3.14159265358979323846;
static mpm_material metal;

static double dot(const mpm_real *a, const mpm_real *b)
{
    return (double)(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* Area of a face times its normal. */
static void face_vector(const mpm_surface *c, int32_t i, mpm_real *n)
{
    const mpm_real *x = c->marker[c->face[i][0]].x, *y = c->marker[c->face[i][1]].x;
    const mpm_real *z = c->marker[c->face[i][2]].x;
    int d;
    for (d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        n[d] = ((y[e] - x[e]) * (z[f] - x[f]) - (y[f] - x[f]) * (z[e] - x[e])) / 2;
    }
    if (c->corners == 3) return;
    n[0] = y[2] - x[2];
    n[1] = 0;
    n[2] = x[0] - y[0];
}

/* ---- what a surface encloses ---------------------------------------------------------------------- */

typedef struct measure {
    double area, volume, sum[3]; /* of the faces; volume by Gauss's theorem, sum of the area vectors */
    double markers;              /* sum of the markers' areas */
    double tilt;                 /* furthest that a marker's normal is from the way out of the origin */
    long gaps;                   /* places of `beside` without a face, or that the face there does not answer */
} measure;

static measure measured(const mpm_surface *c)
{
    measure r;
    int32_t i;
    int k, d, j;
    memset(&r, 0, sizeof r);
    for (i = 0; i < c->faces; i++) {
        const mpm_real *x = c->marker[c->face[i][0]].x;
        mpm_real n[3];
        face_vector(c, i, n);
        r.area += sqrt(dot(n, n));
        r.volume += dot(x, n) / c->corners;
        for (d = 0; d < 3; d++) r.sum[d] += (double)n[d];
        for (k = 0; k < c->corners; k++) {
            const int32_t g = c->beside[i][k];
            int answers = 0;
            for (j = 0; j < c->corners && g >= 0; j++) answers |= c->beside[g][j] == i;
            r.gaps += !answers;
        }
    }
    for (i = 0; i < c->markers; i++) {
        const mpm_marker *m = &c->marker[i];
        const double out = dot(m->x, m->normal) / sqrt(dot(m->x, m->x));
        r.markers += (double)m->area;
        r.tilt = check_worst(r.tilt, 1 - out);
    }
    return r;
}

/* The surface of a shape in a cube of 16 cells around the origin, or in the quarter of it with x, y > 0. */
static measure surface_of(mpm_geometry geometry, mpm_shape shape, int quarter, int absorb)
{
    mpm_desc d = scene_grid(1, quarter ? 8 : 16, quarter ? 8 : 16, 16, quarter ? 0 : -8, quarter ? 0 : -8, -8);
    mpm_body_desc b = scene_body(&metal, shape, 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    mpm_world w;
    measure r;
    d.geometry = geometry;
    if (geometry != MPM_3D) d.cells[1] = 1, d.origin[1] = 0;
    if (quarter) d.side[0] = MPM_SIDE_SYMMETRY;
    if (quarter && geometry == MPM_3D) d.side[2] = MPM_SIDE_SYMMETRY;
    b.absorb = absorb;
    CHECK_EQUAL("a world", mpm_init(&w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("... a body", mpm_body_add(&w, &b), MPM_OK);
    CHECK_EQUAL("... its surface", mpm_surface_add(&s, &w, 0), MPM_OK);
    r = measured(&s.surface[0]);
    CHECK_RELATIVE("... the markers share its area", r.markers, r.area, 1e4 * eps);
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return r;
}

static void closed(const char *what, const measure *r, double area, double volume, double near)
{
    CHECK_RELATIVE(what, r->area, area, near);
    CHECK_RELATIVE("... encloses its volume", r->volume, volume, near);
    CHECK_NEAR("... closed", hypot(hypot(r->sum[0], r->sum[1]), r->sum[2]) / area, 0, 1e4 * eps);
    CHECK_EQUAL("... every face has all neighbours", r->gaps, 0);
}

static void shapes(void)
{
    measure r = surface_of(MPM_3D, mpm_sphere(0, 0, 0, 3), 0, 0);
    closed("a sphere", &r, 36 * pi, 36 * pi, 0.01);
    CHECK_NEAR("... its normals along the radii", r.tilt, 0, 1e-4);
    r = surface_of(MPM_3D, mpm_cylinder(0, 0, -2, 3, 4), 0, 0);
    closed("a cylinder", &r, 2 * pi * 9 + 6 * pi * 4, 36 * pi, 0.01);
    r = surface_of(MPM_3D, mpm_box(-2, -1, -3, 2, 1, 3), 0, 0);
    closed("a box", &r, 2 * (4 * 2 + 4 * 6 + 2 * 6), 48, 1e4 * eps);
    r = surface_of(MPM_3D, mpm_sphere(0, 0, 0, 3), 1, 0);
    CHECK_RELATIVE("a quarter of a sphere", r.area, 9 * pi, 0.01);
    CHECK_RELATIVE("... open at the mirrors: what it encloses with them", r.volume, 9 * pi, 0.01);
    r = surface_of(MPM_3D, mpm_cylinder(0, 0, -4, 5, 4), 1, MPM_FACE_BOTTOM | MPM_FACE_RIM);
    CHECK_RELATIVE("a substrate with dampers: the upper face", r.area, 25 * pi / 4, 0.01);
    CHECK_RELATIVE("... and no other", r.sum[2], r.area, 1e4 * eps);
    r = surface_of(MPM_PLANE_STRAIN, mpm_box(-4, 0, -4, 4, 1, 0), 0, MPM_FACE_BOTTOM | MPM_FACE_RIM);
    CHECK_RELATIVE("... and in two dimensions", r.area, 8, 1e4 * eps);
}

/* ---- shapes that a function gives -------------------------------------------------------------------- */

/* A ball of radius 3 with a hole of radius 1 along z. */
static int ring(void *context, const mpm_real x[3])
{
    const mpm_real r2 = x[0] * x[0] + x[1] * x[1];
    (void)context;
    return r2 > 1 && r2 + x[2] * x[2] < 9;
}

static int ball(void *context, const mpm_real x[3])
{
    (void)context;
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 9;
}

static void functions(void)
{
    const mpm_real low[3] = {MPM_R(-3.1), MPM_R(-3.1), MPM_R(-3.1)}, high[3] = {MPM_R(3.1), MPM_R(3.1), MPM_R(3.1)};
    const double h = sqrt(8.0); /* half the hole's length */
    measure r = surface_of(MPM_3D, mpm_shape_user(ball, NULL, low, high), 0, 0);
    closed("a ball by a function", &r, 36 * pi, 36 * pi, 0.01);
    CHECK_NEAR("... its normals along the radii", r.tilt, 0, 0.01);
    r = surface_of(MPM_3D, mpm_shape_user(ring, NULL, low, high), 0, 0);
    closed("a ball with a hole", &r, 4 * pi * 3 * h + 2 * pi * 2 * h, 4 * pi / 3 * h * h * h, 0.02);
    r = surface_of(MPM_3D, mpm_shape_user(ball, NULL, low, high), 1, 0);
    CHECK_RELATIVE("... a quarter of it", r.area, 9 * pi, 0.01);
    CHECK_NEAR("... cut at the mirrors: normals along the radii", r.tilt, 0, 0.01);
    r = surface_of(MPM_PLANE_STRAIN, mpm_shape_user(ball, NULL, low, high), 0, 0);
    closed("a disk by a function", &r, 6 * pi, 9 * pi, 0.002);
    r = surface_of(MPM_PLANE_STRAIN, mpm_shape_user(ball, NULL, low, high), 1, 0);
    CHECK_RELATIVE("... half of it", r.area, 3 * pi, 0.002);
}

/* ---- the caller's own ---------------------------------------------------------------------------------- */

static void own(void)
{
    static const mpm_real corner[3][4] = {{0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 2}};
    static const int32_t triangle[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    static const int32_t wrong[2][3] = {{0, 2, 1}, {0, 4, 1}};
    const mpm_real *const x[3] = {corner[0], corner[1], corner[2]};
    mpm_desc d = scene_grid(1, 8, 8, 8, -1, -1, -1);
    mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, 0, 2, 2, 2), 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    mpm_real hole[4] = {0, 0, (mpm_real)NAN, 0};
    const mpm_real *const bad[3] = {corner[0], hole, corner[2]};
    measure r;
    mpm_world w;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("triangles of places that are none", mpm_surface_add_triangles(&s, &w, 0, 4, x, 2, wrong),
                MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... the second", s.fault.index, 1);
    CHECK_EQUAL("a place that is no number", mpm_surface_add_triangles(&s, &w, 0, 4, bad, 4, triangle), MPM_ERR_NAN);
    CHECK_EQUAL("a chain", mpm_surface_add_chain(&s, &w, 0, 4, x[0], x[2], 1), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("no triangles", mpm_surface_add_triangles(&s, &w, 0, 4, x, 0, triangle), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("a tetrahedron", mpm_surface_add_triangles(&s, &w, 0, 4, x, 4, triangle), MPM_OK);
    r = measured(&s.surface[0]);
    closed("... as it was given", &r, 6 + 2 * sqrt(3.0), 8.0 / 6, 1e4 * eps);
    mpm_surfaces_free(&s);
    mpm_free(&w);
    d.geometry = MPM_PLANE_STRAIN;
    d.cells[1] = 1;
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    CHECK_EQUAL("triangles in two dimensions", mpm_surface_add_triangles(&s, &w, 0, 4, x, 4, triangle),
                MPM_ERR_ARGUMENT);
    mpm_free(&w);
}

/* ---- following ------------------------------------------------------------------------------------------ */

/* A ball without stress whose points fly apart along x, to 1.6 times its length: its triangles are halved and stay
   joined, and enclose what the ball then fills. */
static void stretched(void)
{
    mpm_desc d = scene_grid(1, 16, 10, 10, -8, -5, -5);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(0, 0, 0, 3), 0.5, 0);
    mpm_surfaces s = mpm_surfaces_default();
    int32_t i, before;
    measure r;
    mpm_world w;
    int n;
    d.basis = MPM_CUBIC;
    b.stress = NULL;
    s.longest = MPM_R(0.4);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &b);
    mpm_surface_add(&s, &w, 0);
    before = s.surface[0].markers;
    for (n = 0; n < 60; n++) {
        for (i = 0; i < w.points.count; i++) w.points.v[0][i] = w.points.x[0][i];
        if (mpm_surface_step(&s, &w, MPM_R(0.47) / 60) < 0) break;
    }
    r = measured(&s.surface[0]);
    printf("# stretched: markers %d to %d, volume %.4f of the ball's\n", (int)before, (int)s.surface[0].markers,
           r.volume / (36 * pi));
    CHECK_EQUAL("a ball that stretches", n, 60);
    CHECK_TRUE("... triangles are halved", s.surface[0].markers > before);
    CHECK_RELATIVE("... it encloses what the ball fills", r.volume, 36 * pi * exp(0.47), 0.1);
    CHECK_NEAR("... closed", hypot(hypot(r.sum[0], r.sum[1]), r.sum[2]) / r.area, 0, 1e4 * eps);
    CHECK_EQUAL("... every face has all neighbours", r.gaps, 0);
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

/* ---- contact ---------------------------------------------------------------------------------------------- */

/* Two elastic bars head-on at 50 m/s, between four mirrors, in three dimensions or plane strain; the speed that comes
   back over theirs, and the sum of momenta over one's. */
static double bars(mpm_geometry geometry, int order, double *momentum)
{
    mpm_desc d = scene_grid(1, 2, geometry == MPM_3D ? 2 : 1, 30, 0, 0, -15);
    mpm_surfaces s = mpm_surfaces_default();
    double unit, back;
    mpm_world w;
    int32_t k;
    d.geometry = geometry;
    d.basis = MPM_CUBIC;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    if (geometry == MPM_3D) d.side[2] = d.side[3] = MPM_SIDE_SYMMETRY;
    s.damping = 0;
    mpm_init(&w, &d, NULL, 0);
    for (k = 0; k < 2; k++) {
        const int low = k != order;
        const mpm_real bottom = low ? MPM_R(-8.1) : MPM_R(0.1);
        mpm_body_desc b = scene_body(&metal, mpm_box(0, 0, bottom, 2, 2, bottom + 8), 0.5, low ? 50 : -50);
        mpm_body_add(&w, &b);
        CHECK_EQUAL("a bar's surface", mpm_surface_add(&s, &w, k), MPM_OK);
    }
    unit = mpm_body_totals(&w, 0).mass * 50;
    while ((double)w.time < 0.004 + 32 / (double)w.body[0].desc.wave_p)
        if (mpm_surface_step(&s, &w, mpm_time_step(&w, MPM_R(0.1))) < 0) break;
    *momentum = mpm_body_totals(&w, -1).momentum[2] / unit;
    back = mpm_body_totals(&w, order).momentum[2] / unit;
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return back;
}

/* A ball of radius 3 cells of this size, a quarter in three dimensions or axisymmetric, 0.05 cells over a block, at
   200 m/s, elastic. */
static void begin(mpm_surfaces *s, mpm_world *w, mpm_geometry geometry, mpm_real size)
{
    const int deep = geometry == MPM_3D;
    mpm_desc d = scene_grid(size, 6, deep ? 6 : 1, 16, 0, 0, -6 * size);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(0, 0, MPM_R(3.05) * size, 3 * size), size / 2, -200);
    mpm_body_desc base = scene_body(&metal, mpm_cylinder(0, 0, -5 * size, 5 * size, 5 * size), size / 2, 0);
    d.geometry = geometry;
    d.basis = MPM_CUBIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    if (deep) d.side[2] = MPM_SIDE_SYMMETRY;
    *s = mpm_surfaces_default();
    s->adhesion = 1;
    s->depth = size;
    s->critical = 1000;
    s->reach = size / 5;
    base.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    mpm_init(w, &d, NULL, 0);
    mpm_body_add(w, &b);
    mpm_body_add(w, &base);
    CHECK_EQUAL("a ball's surface", mpm_surface_add(s, w, 0), MPM_OK);
    CHECK_EQUAL("... a block's", mpm_surface_add(s, w, 1), MPM_OK);
}

/* What comes back of it, and G in sizes, over the area that touched, of one unit of plastic work everywhere once they
   are apart. */
static double hit(mpm_geometry geometry, double size, double *dissipated)
{
    mpm_surfaces s;
    double back;
    mpm_world w;
    int32_t i;
    begin(&s, &w, geometry, (mpm_real)size);
    while ((double)w.time < 0.012 * size) {
        if ((double)w.time > 0.0115 * size)
            for (i = 0; i < w.points.count; i++) w.points.plastic_work[i] = 1;
        if (mpm_surface_step(&s, &w, mpm_time_step(&w, MPM_R(0.1))) < 0) break;
    }
    *dissipated = mpm_surface_meets(&s, &w, 0, 1).dissipated / size;
    back = mpm_body_totals(&w, 0).momentum[2] / mpm_body_totals(&w, 0).mass;
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return back;
}

/* The gaps of the block's markers to the ball, up to a quarter of a cell, after a first step of next to no time, beside
   those to the sphere: the furthest off. Flat faces would be off by their sagitta, 0.0026 cells. */
static double gaps(mpm_geometry geometry)
{
    double worst = 0;
    mpm_surfaces s;
    mpm_world w;
    long met = 0;
    int32_t i;
    begin(&s, &w, geometry, 1);
    CHECK_TRUE("... a step", mpm_surface_step(&s, &w, MPM_R(1e-9)) >= 0);
    for (i = 0; i < s.surface[1].markers; i++) {
        const mpm_marker *m = &s.surface[1].marker[i];
        const double over = 3.05 - (double)m->x[2];
        if (m->meet[0].other != 0 || m->meet[0].gap > MPM_R(0.25)) continue;
        worst = check_worst(worst, fabs((double)m->meet[0].gap + 3 -
                                        sqrt((double)(m->x[0] * m->x[0] + m->x[1] * m->x[1]) + over * over)));
        met++;
    }
    CHECK_TRUE("... of markers that met", met > 3);
    mpm_surfaces_free(&s);
    mpm_free(&w);
    return worst;
}

static void contact(void)
{
    double momentum, flat, back, again, ring_back, G, ring_G;
    flat = bars(MPM_PLANE_STRAIN, 0, &momentum);
    back = bars(MPM_3D, 0, &momentum);
    again = bars(MPM_3D, 1, &momentum);
    printf("# bars: %.5f of the speed back in plane strain, %.5f in three dimensions\n", flat, back);
    CHECK_NEAR("bars in three dimensions: momentum", momentum, 0, 1e4 * eps);
    CHECK_NEAR("... as in plane strain", back, flat, 0.01);
    CHECK_TRUE("... back with 0.9 of the speed", back > 0.9 && back <= 1);
    CHECK_NEAR("... however they are numbered", again, back, 1e6 * eps);
    CHECK_NEAR("gaps to a ball of lines are those to a sphere [cells]", gaps(MPM_AXISYMMETRIC), 0, 3e-4);
    CHECK_NEAR("... of triangles", gaps(MPM_3D), 0, 3e-4);
    ring_back = hit(MPM_AXISYMMETRIC, 1, &ring_G);
    back = hit(MPM_3D, 1, &G);
    printf("# ball on a block: axisymmetric %.3f m/s, G %.4f; in three dimensions %.3f m/s, G %.4f\n", ring_back,
           ring_G, back, G);
    CHECK_NEAR("a quarter of a ball, 3 cells in its radius: back as the axisymmetric one [m/s]", back, ring_back, 10);
    CHECK_RELATIVE("... G: all that is worked in both layers, 2 l w", G, 2, 1e4 * eps);
    CHECK_RELATIVE("... as there", ring_G, 2, 1e4 * eps);
    CHECK_RELATIVE("... everything a thousand times as large", hit(MPM_3D, 1024, &G), back, 1e6 * eps);
}

int main(void)
{
    metal = scene_metal(1, mpm_units_um_us_ng());
    shapes();
    functions();
    own();
    stretched();
    contact();
    return check_end();
}
