/* 10_symmetry - one impact told in other ways: as a half and a quarter between mirrors, turned to other
   axes, in other units. Nothing but round-off may change. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "verify.h"

#include <stdlib.h>

/* How the impact is told. Axis a of the reference, whose particle flies along -z, becomes axis
   axis[a] here, reversed where sign[a] < 0. */
typedef struct telling {
    mpm_units units;
    int axis[3], sign[3];
    int mirrors;         /* 1: plane y = 0; 2: and x = 0, of the reference */
    int cylinder;        /* a cylinder with dampers, which stands along z only; or a free box */
    mpm_basis basis;
    mpm_normal_rule normal;
    double faster;       /* relative change of the impact speed */
} telling;

typedef struct scene {
    mpm_world world;
    mpm_material metal;
    mpm_bond bond;
    mpm_real *start[3];  /* positions at the start, by id */
    double length, speed; /* one um and the impact speed in its units */
} scene;

static telling whole(int cylinder)
{
    telling t = {mpm_units_um_us_ng(), {0, 1, 2}, {1, 1, 1}, 0, cylinder, MPM_LINEAR, MPM_NORMAL_RANKED,
                 0};
    return t;
}

/* The reference box low..high [um] in this telling's axes and units. */
static mpm_shape box_of(const telling *t, double length, const double *low, const double *high)
{
    double a[3], b[3];
    int i;
    for (i = 0; i < 3; i++) {
        a[t->axis[i]] = length * (t->sign[i] > 0 ? low[i] : -high[i]);
        b[t->axis[i]] = length * (t->sign[i] > 0 ? high[i] : -low[i]);
    }
    return mpm_box((mpm_real)a[0], (mpm_real)a[1], (mpm_real)a[2], (mpm_real)b[0], (mpm_real)b[1], (mpm_real)b[2]);
}

static mpm_desc grid_of(const telling *t, double length)
{
    const double low[3] = {t->mirrors > 1 ? 0 : -14, t->mirrors > 0 ? 0 : -14, -8}, high[3] = {14, 14, 12};
    const mpm_shape room = box_of(t, length, low, high);
    mpm_desc d = scene_grid(length, 1, 1, 1, 0, 0, 0);
    int a;
    for (a = 0; a < 3; a++) {
        d.origin[a] = room.center[a] - room.half[a];
        d.cells[a] = (int32_t)(2 * (double)room.half[a] / length + 0.5);
    }
    for (a = 0; a < 2; a++)
        if (t->mirrors > 1 - a) d.side[2 * t->axis[a] + (t->sign[a] < 0)] = MPM_SIDE_SYMMETRY;
    d.basis = t->basis;
    d.scheme = MPM_SCHEME_THESIS;
    d.contact.normal = t->normal;
    d.contact.friction = MPM_R(0.2);
    return d;
}

/* An aluminium ball of 8 um before a block 18 um wide and 6 um high, at 700 m/s. Returns 1, or 0. */
static int begin(scene *s, const telling *t)
{
    const double low[3] = {-9, -9, -6}, high[3] = {9, 9, 0};
    mpm_desc d;
    mpm_body_desc ball, block;
    double center[3] = {0, 0, 0};
    int32_t i;
    int a;
    memset(s, 0, sizeof *s);
    s->length = 1e-6 / t->units.length;
    s->speed = 700 / mpm_units_velocity(&t->units);
    s->metal = scene_metal(0, t->units);
    s->bond = mpm_bond_default(&t->units);
    s->bond.critical /= 4; /* or so small a ball would not bond */
    d = grid_of(t, s->length);
    center[t->axis[2]] = t->sign[2] * 4 * s->length;
    ball = scene_body(&s->metal, mpm_sphere((mpm_real)center[0], (mpm_real)center[1], (mpm_real)center[2],
                                            (mpm_real)(4 * s->length)), 0.5 * s->length, 0);
    if (!t->cylinder) { /* obliquely: no axis like another */
        ball.velocity[t->axis[0]] = (mpm_real)(t->sign[0] * 0.3 * s->speed);
        ball.velocity[t->axis[1]] = (mpm_real)(t->sign[1] * 0.1 * s->speed);
    }
    ball.velocity[t->axis[2]] = (mpm_real)(-t->sign[2] * s->speed * (1 + t->faster));
    block = scene_body(&s->metal, box_of(t, s->length, low, high), 0.5 * s->length, 0);
    if (t->cylinder) {
        block.shape = mpm_cylinder(0, 0, (mpm_real)(-6 * s->length), (mpm_real)(9 * s->length),
                                   (mpm_real)(6 * s->length));
        block.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    }
    if (mpm_init(&s->world, &d, NULL, 0) != MPM_OK) return 0;
    if (mpm_body_add(&s->world, &ball) != MPM_OK || mpm_body_add(&s->world, &block) != MPM_OK) return 0;
    for (a = 0; a < 3; a++) {
        s->start[a] = (mpm_real *)malloc((size_t)s->world.points.count * sizeof(mpm_real));
        if (!s->start[a]) return 0;
        for (i = 0; i < s->world.points.count; i++) s->start[a][s->world.points.id[i]] = s->world.points.x[a][i];
    }
    return 1;
}

static void end(scene *s)
{
    int a;
    for (a = 0; a < 3; a++) free(s->start[a]);
    mpm_free(&s->world);
}

/* Tells it: 8 ns, steps of 0.2 cells of the fastest wave. Returns 1, or 0 when it failed. */
static int tell(scene *s, const telling *t)
{
    mpm_real dt;
    int n;
    if (!begin(s, t)) return 0;
    dt = mpm_time_step(&s->world, MPM_R(0.2));
    for (n = 0; n < 250; n++)
        if (scene_step(&s->world, &s->bond, dt) < 0) return 0;
    return 1;
}

/* The index in r of the point that started where point i of s did, told by t; -1 if there is none. */
static int32_t same_point(const scene *r, const int32_t *place, const scene *s, const telling *t, int32_t i)
{
    const int32_t id = s->world.points.id[i];
    int32_t j;
    int a;
    for (j = 0; j < r->world.points.count; j++) {
        for (a = 0; a < 3; a++) {
            const double x = t->sign[a] * (double)s->start[t->axis[a]][id] / s->length;
            if (fabs(x - (double)r->start[a][j] / r->length) > 0.1) break;
        }
        if (a == 3) return place[j];
    }
    return -1;
}

/* The largest difference between the two tellings of any point's velocity (over the impact speed),
   plastic strain and D. */
static double differ(const scene *r, const scene *s, const telling *t)
{
    const mpm_points *p = &s->world.points, *q = &r->world.points;
    int32_t *place = (int32_t *)malloc((size_t)q->count * sizeof *place); /* of the point with an id */
    double most = 0;
    int32_t i, j;
    int a;
    if (!place) return NAN;
    for (j = 0; j < q->count; j++) place[q->id[j]] = j;
    for (i = 0; i < p->count; i++) {
        if ((j = same_point(r, place, s, t, i)) < 0) {
            most = NAN;
            break;
        }
        for (a = 0; a < 3; a++) {
            const double v = t->sign[a] * (double)p->v[t->axis[a]][i] / s->speed;
            most = verify_worst(most, fabs(v - (double)q->v[a][j] / r->speed));
        }
        most = verify_worst(most, fabs((double)(p->plastic_strain[i] - q->plastic_strain[j])));
        most = verify_worst(most, fabs((double)(p->bond[i] - q->bond[j])));
    }
    free(place);
    return most;
}

/* Telling t beside the reference r; NAN when t fails. */
static double difference(const scene *r, const telling *t)
{
    scene s;
    const int told = tell(&s, t);
    const double d = told ? differ(r, &s, t) : NAN;
    end(&s);
    return d;
}

static void row(const scene *r, const telling *t, const char *what)
{
    verify_near(what, "the same", 0, difference(r, t), 1e-9);
}

/* What the reference is: there must be something to differ in. */
static void describe(const scene *r)
{
    const mpm_bond_measure m = mpm_bond_measure_body(&r->world, -1);
    const mpm_totals t = mpm_body_totals(&r->world, 0);
    verify_range("reference: surface points in contact", "there must be contact", 10, 1e6, (double)m.contacted);
    verify_range("reference: points bonded", "and bonds", 1, 1e6, (double)m.bonded);
    verify_range("reference: mean plastic strain of the ball", "and flow", 0.1, 10, t.plastic_strain_mean);
}

/* Mirrors and units, on the scene with dampers. */
static void mirrored(mpm_basis basis, mpm_normal_rule normal)
{
    telling t = whole(1);
    scene r;
    t.basis = basis;
    t.normal = normal;
    if (!tell(&r, &t)) {
        verify_near("reference", "runs", 0, NAN, 0);
        end(&r);
        return;
    }
    describe(&r);
    t.mirrors = 1;
    row(&r, &t, "half: mirror y = 0");
    t.mirrors = 2;
    row(&r, &t, "quarter: mirrors x = 0 and y = 0");
    t.units = mpm_units_si();
    row(&r, &t, "quarter, m s kg");
    t.units = mpm_units_mm_ms_g();
    row(&r, &t, "quarter, mm ms g");
    t = whole(1);
    t.basis = basis;
    t.normal = normal;
    t.faster = 1e-9;
    verify_measured("for scale: speed raised by 1e-9", "", difference(&r, &t));
    end(&r);
}

/* Turned and reversed, on the free block. */
static void turned(mpm_basis basis, mpm_normal_rule normal)
{
    static const struct { const char *name; int axis[3], sign[3]; } way[] = {
        {"along x (x and z change places)", {2, 1, 0}, {1, 1, 1}},
        {"along y (y and z change places)", {0, 2, 1}, {1, 1, 1}},
        {"along -x (turned by 90 degrees about y)", {2, 1, 0}, {1, 1, -1}},
        {"upside down", {0, 1, 2}, {1, 1, -1}},
        {"all axes in turn, reversed", {1, 2, 0}, {-1, -1, -1}}};
    telling t = whole(0);
    scene r;
    int i;
    t.basis = basis;
    t.normal = normal;
    if (!tell(&r, &t)) {
        verify_near("reference", "runs", 0, NAN, 0);
        end(&r);
        return;
    }
    describe(&r);
    for (i = 0; i < 5; i++) {
        memcpy(t.axis, way[i].axis, sizeof t.axis);
        memcpy(t.sign, way[i].sign, sizeof t.sign);
        row(&r, &t, way[i].name);
    }
    end(&r);
}

int main(void)
{
    verify_begin("One impact told in other ways",
                 "An aluminium ball of 8 um hits an aluminium block at 700 m/s: 8 ns, cell 1 um, two points per cell "
                 "and direction, PTW, friction 0.2, bonding at a quarter of source A's G_c. Told again as a half and a "
                 "quarter between mirrors, along other axes and in other units, every point must do the same. Given is "
                 "the largest difference of any point in velocity over impact speed, plastic strain or D. The steps "
                 "are 250, so that round-off of 2e-16 grows; tolerance 1e-9. Thresholds inside the method (light "
                 "nodes, contact, bonding) are dimensionless: one that is not would show here as a contact lost in SI. "
                 "Not shown: that the answer is right.");
    mirrored(MPM_LINEAR, MPM_NORMAL_RANKED);
    verify_remark("Cylindrical block with dampers; linear functions, ranked normals: the defaults.");
    mirrored(MPM_GIMP, MPM_NORMAL_MVG);
    verify_remark("The same with GIMP functions and MVG normals.");
    turned(MPM_LINEAR, MPM_NORMAL_RANKED);
    verify_remark("Free square block, hit obliquely; linear functions, ranked normals.");
    turned(MPM_GIMP, MPM_NORMAL_LOGISTIC);
    verify_remark("The same with GIMP functions and normals by logistic regression.");
    return verify_end();
}
