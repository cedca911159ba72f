/* Contact on surfaces in all geometries: every field of mpm_surfaces, shapes, functions, chains and triangles of any
   places, walls, points and markers that were overwritten; steps and meetings stay within memory.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "scene.h"
#include "mpm_surface.h"

enum { CHAIN = 7 };

static void describe(fuzz *f, mpm_surfaces *s)
{
    FUZZ_REAL(f, s->stiffness);
    FUZZ_REAL(f, s->damping);
    FUZZ_REAL(f, s->friction);
    FUZZ_REAL(f, s->softening);
    FUZZ_REAL(f, s->longest);
    FUZZ_REAL(f, s->adhesion);
    FUZZ_REAL(f, s->critical);
    FUZZ_REAL(f, s->depth);
    if (s->depth > 3) s->depth = 3; /* deeper than the bodies: all points under all markers, seconds with sanitizers */
    FUZZ_REAL(f, s->reach);
    FUZZ_CHOICE(f, s->both);
    FUZZ_CHOICE(f, s->renew);
}

/* A chain of the caller's in place of the outline of body k: around the ball, over the plate, or anywhere. */
static mpm_status chain(fuzz *f, mpm_surfaces *s, const mpm_world *w, int32_t k)
{
    static const mpm_real ball[2][CHAIN] = {{0, 1, MPM_R(1.5), MPM_R(1.4), MPM_R(0.7), MPM_R(0.3), 0},
                                            {0, MPM_R(0.4), MPM_R(1.5), 2, MPM_R(2.8), MPM_R(2.9), 3}};
    mpm_real x[CHAIN], z[CHAIN];
    int i;
    for (i = 0; i < CHAIN; i++) {
        x[i] = k ? 3 - (mpm_real)i / 2 : ball[0][i];
        z[i] = k ? 0 : ball[1][i];
        FUZZ_REAL(f, x[i]);
        FUZZ_REAL(f, z[i]);
    }
    return mpm_surface_add_chain(s, w, k, fuzz_int(f, CHAIN) % (CHAIN + 1), x, z, (int)fuzz_byte(f) & 1);
}

/* Triangles of the caller's in three dimensions: a tetrahedron, or whatever. */
static mpm_status triangles(fuzz *f, mpm_surfaces *s, const mpm_world *w, int32_t k)
{
    mpm_real x[3][4] = {{0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 2}};
    int32_t triangle[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const mpm_real *at[3];
    int i, d;
    for (d = 0; d < 3; d++) {
        at[d] = x[d];
        fuzz_reals(f, x[d], 4);
        for (i = 0; i < 4; i++) triangle[i][d] = fuzz_int(f, triangle[i][d]);
    }
    return mpm_surface_add_triangles(s, w, k, 4, at, fuzz_int(f, 4) % 5, (const int32_t(*)[3])triangle);
}

/* A shape that changes with every question. */
static int inside(void *context, const mpm_real x[3])
{
    return (fuzz_byte((fuzz *)context) > 40) ^ (x[0] * x[0] + x[1] * x[1] + (x[2] - 1) * (x[2] - 1) > 2);
}

static mpm_status surface(fuzz *f, mpm_surfaces *s, mpm_world *w, int32_t k)
{
    const unsigned how = fuzz_byte(f);
    if (how < 180) return mpm_surface_add(s, w, k);
    if (how < 220) return w->desc.geometry == MPM_3D ? triangles(f, s, w, k) : chain(f, s, w, k);
    w->body[k].desc.shape.kind = MPM_SHAPE_USER;
    w->body[k].desc.shape.inside = inside;
    w->body[k].desc.shape.context = f;
    return mpm_surface_add(s, w, k);
}

static mpm_status wall(fuzz *f, mpm_surfaces *s)
{
    mpm_real point[3] = {0, 0, MPM_R(-2.5)}, normal[3] = {0, 0, 1};
    fuzz_reals(f, point, 3);
    fuzz_reals(f, normal, 3);
    return mpm_surface_wall_add(s, point, normal);
}

static void overwrite(fuzz *f, mpm_surfaces *s, mpm_world *w)
{
    const unsigned n = fuzz_byte(f) % 8u;
    unsigned i;
    for (i = 0; i < n; i++) {
        const unsigned at = fuzz_byte(f) | fuzz_byte(f) << 8, what = fuzz_byte(f);
        mpm_surface *c = &s->surface[at % (unsigned)s->surfaces];
        mpm_marker *m = &c->marker[at / 2 % (unsigned)c->markers];
        if (what < 128) w->field[(what % (unsigned)w->fields) * w->stride + at % (unsigned)w->points.count] =
            (mpm_real)fuzz_any(f);
        else if (what < 192) m->x[what % 3] = (mpm_real)fuzz_any(f);
        else m->v[what % 3] = (mpm_real)fuzz_any(f);
    }
}

static void steps(fuzz *f, mpm_surfaces *s, mpm_world *w)
{
    const mpm_real dt = mpm_time_step(w, MPM_R(0.1));
    const int n = w->desc.geometry == MPM_3D ? 2 : 6;
    int i;
    for (i = 0; i < n; i++) {
        if (i == n / 2) overwrite(f, s, w);
        if (mpm_surface_step(s, w, dt) < 0) break;
        mpm_surface_meets(s, w, 0, i % 2 ? -1 : 1);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    mpm_surfaces s = mpm_surfaces_default();
    mpm_fault fault;
    scene c;
    int32_t k;
    unsigned geometry;
    scene_describe(&c);
    geometry = fuzz_byte(&f) % 8; /* three dimensions cost twenty times as much: one in eight */
    c.desc.geometry = geometry == 7 ? MPM_3D : geometry & 1 ? MPM_PLANE_STRAIN : MPM_AXISYMMETRIC;
    c.desc.basis = (mpm_basis)((fuzz_byte(&f) + MPM_CUBIC) % MPM_BASES);
    FUZZ_WANT(scene_begin(&c));
    s.adhesion = 43;
    s.critical = 50;
    s.depth = MPM_R(1.5);
    s.reach = MPM_R(0.2);
    describe(&f, &s);
    if (mpm_surfaces_check(&s, &fault) < 0) FUZZ_WANT(mpm_surface_add(&s, &c.world, 0) < 0);
    for (k = 0; k < 2; k++)
        if (surface(&f, &s, &c.world, k) < 0) break;
    if (fuzz_byte(&f) > 160) wall(&f, &s);
    if (s.surfaces > 0) steps(&f, &s, &c.world);
    mpm_surfaces_free(&s);
    mpm_free(&c.world);
    return 0;
}
