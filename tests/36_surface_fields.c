/* 36_surface_fields - what ParaView is shown of surfaces is what mpm_surface_meets tells: pressure, gap, G, adhesion,
   opening and traction of two blocks, pressed and drawn, in plane strain and three dimensions.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "output.h"
#include "check.h"
#include "files.h"

#define FOLDER "build/tests/fields"

static const double single = 1.2e-7; /* the file's numbers: half a unit of the last place is 6e-8 */

/* The fields of a file's markers; vectors have three numbers a marker. */
typedef struct fields {
    unsigned char *file;
    size_t bytes;
    int missing;
    const unsigned char *place, *velocity, *tension, *pressure, *gap, *dissipated, *adhesion, *opening, *body;
} fields;

static const unsigned char *field(fields *f, const char *name, const char *type, size_t numbers)
{
    uint64_t bytes = 0;
    const unsigned char *a = f->file ? vtu_array(f->file, f->bytes, name, type, &bytes) : NULL;
    if (a && bytes == 4 * (uint64_t)numbers) return a;
    printf("# no field %s of %lu numbers\n", name, (unsigned long)numbers);
    f->missing++;
    return f->file;
}

static fields fields_of(const char *path, size_t n)
{
    fields f;
    memset(&f, 0, sizeof f);
    f.file = slurp(path, &f.bytes);
    f.place = field(&f, "Points", "Float32", 3 * n);
    f.velocity = field(&f, "velocity (m/s)", "Float32", 3 * n);
    f.tension = field(&f, "traction of adhesion (MPa)", "Float32", 3 * n);
    f.pressure = field(&f, "contact pressure (MPa)", "Float32", n);
    f.gap = field(&f, "gap (um)", "Float32", n);
    f.dissipated = field(&f, "interface dissipation (J/m2)", "Float32", n);
    f.adhesion = field(&f, "adhesion (J/m2)", "Float32", n);
    f.opening = field(&f, "opening (um)", "Float32", n);
    f.body = field(&f, "body", "Int32", n);
    return f;
}

static double number(const unsigned char *a, size_t i)
{
    float v;
    memcpy(&v, a + 4 * i, 4);
    return (double)v;
}

/* The sums that mpm_surface_meets makes, from the file: of the markers' values, with their areas. */
static mpm_meeting summed(const mpm_surfaces *s, const mpm_world *w, const fields *f, double *opened, double *off)
{
    mpm_meeting r;
    int32_t a, i, body;
    size_t k = 0;
    int d;
    memset(&r, 0, sizeof r);
    r.gap_min = (double)w->desc.cell;
    *opened = *off = 0;
    for (a = 0; a < s->surfaces; a++)
        for (i = 0; i < s->surface[a].markers; i++, k++) {
            const mpm_marker *m = &s->surface[a].marker[i];
            const double area = (double)m->area / 2, p = number(f->pressure, k), W = number(f->adhesion, k);
            for (d = 0; d < 3; d++) {
                *off = check_worst(*off, fabs(number(f->place, 3 * k + (size_t)d) - (double)m->x[d]));
                *off = check_worst(*off, fabs(number(f->velocity, 3 * k + (size_t)d) - (double)m->v[d]) / 100);
                r.pull[d] += (a ? -1 : 1) * area * number(f->tension, 3 * k + (size_t)d);
            }
            memcpy(&body, f->body + 4 * k, 4);
            *off = check_worst(*off, body != a);
            r.area += p > 0 ? area : 0;
            r.pressure_max = fmax(r.pressure_max, p);
            r.gap_min = fmin(r.gap_min, number(f->gap, k));
            r.dissipated += area * number(f->dissipated, k);
            r.adhesion += area * W;
            r.bonded += W > 0 ? area : 0;
            *opened = fmax(*opened, number(f->opening, k));
        }
    return r;
}

/* Writes the surfaces as they are and compares. */
static void shown(const char *what, output *o, const mpm_surfaces *s, const mpm_world *w)
{
    const mpm_meeting m = mpm_surface_meets(s, w, 0, 1);
    double opened, off, most = 0;
    char path[80];
    mpm_meeting r;
    int32_t a, i;
    size_t n = 0;
    fields f;
    for (a = 0; a < 2; a++)
        for (i = 0; i < s->surface[a].markers; i++, n++)
            most = fmax(most, (double)s->surface[a].marker[i].meet[0].opened);
    CHECK_EQUAL(what, output_surfaces(o, w, s), 1);
    snprintf(path, sizeof path, FOLDER "/surface_%04d.vtu", (int)o->frame++);
    f = fields_of(path, n);
    CHECK_EQUAL("... all fields of all markers are there", f.missing, 0);
    if (f.missing) return;
    r = summed(s, w, &f, &opened, &off);
    printf("# %s: p %.4g MPa on %.4g um2, gap %.4g um, G %.4g J/m2, W %.4g pJ on %.4g um2, drawn %.4g um, %.4g uN\n",
           what, m.pressure_max, m.area, m.gap_min, m.dissipated, m.adhesion, m.bonded, opened, m.pull[2]);
    CHECK_NEAR("... places, velocities, bodies", off, 0, 10 * single);
    CHECK_RELATIVE("... highest pressure", r.pressure_max, m.pressure_max, single);
    CHECK_RELATIVE("... area under pressure", r.area, m.area, 100 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... least gap", r.gap_min, m.gap_min, single);
    CHECK_RELATIVE("... G, its mean over what touched", r.dissipated / m.touched, m.dissipated, 10 * single);
    CHECK_RELATIVE("... adhesion", r.adhesion, m.adhesion, 10 * single);
    CHECK_RELATIVE("... area that it holds", r.bonded, m.bonded, 100 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... pull", r.pull[2], m.pull[2], 10 * single);
    CHECK_RELATIVE("... opening", opened, most, single);
    free(f.file);
}

/* Two blocks are pressed together while plastic work grows, more on one side; then drawn apart. */
static void blocks(mpm_geometry geometry, mpm_material *metal)
{
    const int deep = geometry == MPM_3D;
    mpm_desc d = scene_grid(1, 3, deep ? 2 : 1, 12, 0, 0, -6);
    mpm_surfaces s = mpm_surfaces_default();
    output o = output_of(FOLDER, "fields", "um", "ns", 1);
    mpm_world w;
    int32_t k, i;
    int n;
    d.geometry = geometry;
    d.basis = MPM_CUBIC;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    if (deep) d.side[2] = d.side[3] = MPM_SIDE_SYMMETRY;
    s.adhesion = 40;
    s.critical = 2000;
    s.depth = MPM_R(1.5);
    s.reach = MPM_R(0.2);
    CHECK_EQUAL("a world", mpm_init(&w, &d, NULL, 0), MPM_OK);
    for (k = 0; k < 2; k++) {
        const mpm_real low = k ? -3 : MPM_R(0.001);
        mpm_body_desc b = scene_body(metal, mpm_box(0, 0, low, 3, deep ? 2 : 1, low + 3), 0.5, k ? 5 : -5);
        b.stress = NULL;
        mpm_body_add(&w, &b);
        CHECK_EQUAL("... a block and its surface", mpm_surface_add(&s, &w, k), MPM_OK);
    }
    for (n = 0; n < 52; n++) {
        for (i = 0; i < w.points.count && n == 20; i++) w.points.plastic_work[i] = 400 * (1 + w.points.x[0][i]);
        for (i = 0; i < w.points.count && n >= 40; i++) w.points.v[2][i] = i < w.body[1].first ? -5 : 5;
        if (mpm_surface_step(&s, &w, MPM_R(1e-5)) < 0) break;
    }
    shown("pressed", &o, &s, &w);
    CHECK_TRUE("... by a pressure, with a bond on a part", mpm_surface_meets(&s, &w, 0, 1).pressure_max > 0 &&
               mpm_surface_meets(&s, &w, 0, 1).bonded < mpm_surface_meets(&s, &w, 0, 1).touched);
    for (n = 0; n < 400; n++) {
        for (i = 0; i < w.points.count; i++) w.points.v[2][i] = i < w.body[1].first ? 10 : -10;
        if (mpm_surface_step(&s, &w, MPM_R(1e-5)) < 0) break;
    }
    shown("drawn", &o, &s, &w);
    CHECK_TRUE("... against adhesion", mpm_surface_meets(&s, &w, 0, 1).pull[2] < -10);
    mpm_surfaces_free(&s);
    mpm_free(&w);
}

int main(void)
{
    mpm_material metal = scene_metal(1, mpm_units_um_us_ng());
    mpm_fault fault;
    CHECK_EQUAL("a folder", mpm_io_make_directory(FOLDER, &fault), MPM_OK);
    blocks(MPM_PLANE_STRAIN, &metal);
    blocks(MPM_3D, &metal);
    return check_end();
}
