/* 28_planes - lattices cut by symmetry planes weigh what is left of the shape, wherever the points lie, and nothing
   leaves through a closed side. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"

static const double eps = (double)MPM_EPSILON;

/* What a shape weighs at density 1 in a grid of 20 cells of 2 whose first `mirrors` axes begin (or, with `high`, end)
   in a mirror at 0. *area: of its damped rim. */
static double weigh(mpm_shape s, double spacing, int mirrors, int high, mpm_geometry geometry, double *area)
{
    mpm_desc d = scene_grid(2, 20, 20, 20, -20, -20, -20);
    mpm_body_desc b = mpm_body_desc_default();
    double mass = -1;
    mpm_world w;
    int k;
    d.geometry = geometry;
    d.points = d.bodies = 0;
    for (k = 0; k < mirrors; k++) {
        d.cells[k] = 10;
        d.origin[k] = (mpm_real)(high ? -20 : 0);
        d.side[2 * k + high] = MPM_SIDE_SYMMETRY;
    }
    if (geometry == MPM_AXISYMMETRIC) d.origin[0] = 0;
    b.shape = s;
    b.spacing = (mpm_real)spacing;
    b.density = 1;
    if (s.kind != MPM_SHAPE_ELLIPSOID) b.absorb = MPM_FACE_RIM;
    mpm_init(&w, &d, NULL, 0);
    if (mpm_body_add(&w, &b) == MPM_OK) {
        mass = mpm_body_totals(&w, 0).mass;
        *area = (double)w.body[0].area[1];
        CHECK_EQUAL("as many points as were counted", w.points.count, mpm_shape_count(&w.desc, &s, b.spacing));
    }
    mpm_free(&w);
    return mass;
}

/* Halves, quarters and eighths of shapes about 0 weigh just that, with points on the planes or beside them. */
static void shares(void)
{
    static const double wide[] = {10, 9, 3};
    double whole, area, part, cut;
    int k, mirrors, high, shape;
    for (k = 0; k < 3; k++)
        for (shape = 0; shape < 3; shape++)
            for (mirrors = 1; mirrors <= 3; mirrors++)
                for (high = 0; high < 2; high++) {
                    const mpm_real h = (mpm_real)(wide[k] / 2);
                    const mpm_shape s = shape == 0   ? mpm_box(-h, -h, -h, h, h, h)
                                        : shape == 1 ? mpm_cylinder(0, 0, -h, h, 2 * h)
                                                     : mpm_sphere(0, 0, 0, h);
                    whole = weigh(s, 1, 0, 0, MPM_3D, &area);
                    part = weigh(s, 1, mirrors, high, MPM_3D, &cut);
                    CHECK_RELATIVE("its share of the whole", part * (1 << mirrors), whole, 1e3 * eps);
                    if (shape < 2) CHECK_RELATIVE("... of the damped face too", cut * (1 << mirrors), area, 1e3 * eps);
                }
}

/* A box that the mirror cuts anywhere in its lattice: what is left of it, exactly. */
static void anywhere(void)
{
    double shift, area;
    for (shift = 0; shift < 1.01; shift += 0.125) {
        const mpm_real c = (mpm_real)shift;
        const mpm_shape s = mpm_box(c - 4, c - 4, c - 4, c + 5, c + 5, c + 5);
        CHECK_RELATIVE("a quarter cut anywhere", weigh(s, 1, 2, 0, MPM_3D, &area), (5 + shift) * (5 + shift) * 9,
                       1e3 * eps);
        CHECK_RELATIVE("an eighth", weigh(s, 1, 3, 0, MPM_3D, &area), pow(5 + shift, 3), 1e3 * eps);
        CHECK_RELATIVE("half in the plane", weigh(s, 1, 1, 0, MPM_PLANE_STRAIN, &area), (5 + shift) * 9, 1e3 * eps);
        CHECK_RELATIVE("... cut from above", weigh(s, 1, 1, 1, MPM_PLANE_STRAIN, &area), (4 - shift) * 9, 1e3 * eps);
        CHECK_RELATIVE("rings to the axis: a disc", weigh(s, 1, 1, 0, MPM_AXISYMMETRIC, &area),
                       3.14159265358979 * (5 + shift) * (5 + shift) * 9, 1e3 * eps);
    }
}

/* A bar with a layer of points on a side is squeezed onto it. Returns how many points leave. */
static int64_t squeezed(mpm_side side, mpm_basis basis, int high, double speed)
{
    mpm_material m = scene_metal(1, mpm_units_um_us_ng());
    mpm_desc d = scene_grid(1, 10, 1, 10, high ? -10 : 0, 0, 0);
    mpm_body_desc b = scene_body(&m, mpm_box(MPM_R(-4.25), 0, 0, MPM_R(4.25), 1, 10), 0.5, 0);
    int64_t on = 0, left;
    mpm_world w;
    int32_t i;
    int n;
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = basis;
    d.side[high ? 1 : 0] = side;
    d.side[4] = d.side[5] = MPM_SIDE_SYMMETRY;
    b.velocity[0] = (mpm_real)(high ? speed : -speed);
    if (side != MPM_SIDE_SYMMETRY && high) b.shape = mpm_box(MPM_R(-4.25), 0, 0, MPM_R(0.25), 1, 10);
    if (side != MPM_SIDE_SYMMETRY && !high) b.shape = mpm_box(MPM_R(-0.25), 0, 0, MPM_R(4.25), 1, 10);
    mpm_init(&w, &d, NULL, 0);
    CHECK_EQUAL("a bar with points on a side", mpm_body_add(&w, &b), MPM_OK);
    for (i = 0; i < w.points.count; i++) on += fabs((double)w.points.x[0][i]) < 1e-6;
    CHECK_EQUAL("... a layer of them", on, 20);
    for (n = 0; n < 1000; n++)
        if (mpm_step(&w, MPM_R(1e-5)) < 0) break;
    CHECK_EQUAL("... steps", n, 1000);
    left = w.retired;
    mpm_free(&w);
    return left;
}

static void closed(void)
{
    static const mpm_side side[] = {MPM_SIDE_SYMMETRY, MPM_SIDE_FIXED, MPM_SIDE_WALL};
    int k, basis, high;
    for (k = 0; k < 3; k++)
        for (basis = MPM_LINEAR; basis < MPM_BASES; basis++)
            for (high = 0; high < 2; high++) {
                CHECK_EQUAL("nothing leaves through a closed side", squeezed(side[k], (mpm_basis)basis, high, 100), 0);
                CHECK_EQUAL("... gently", squeezed(side[k], (mpm_basis)basis, high, 1), 0);
            }
}

int main(void)
{
    shares();
    anywhere();
    closed();
    return check_end();
}
