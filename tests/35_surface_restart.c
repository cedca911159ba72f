/* 35_surface_restart - surfaces through a checkpoint: a run that went on from one ends with the bits of one that was
   not stopped, axisymmetric and in three dimensions, with faces halved, adhesion, friction and walls; damaged and
   spoilt files are refused. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "mpm_io.h"
#include "mpm_surface.h"
#include "check.h"
#include "files.h"

#define FOLDER "build/tests"
#define BLOBS (MPM_BLOBS(2) + MPM_SURFACES_BLOBS(2))

static mpm_material metal;

/* A ball that flattens on a block over a wall: within a hundred steps both touch, work and are bonded. */
typedef struct scene {
    mpm_world w;
    mpm_surfaces s;
    mpm_real dt;
} scene;

static void begin(scene *q, mpm_geometry geometry)
{
    const int deep = geometry == MPM_3D;
    const mpm_real point[3] = {0, 0, MPM_R(-3.02)}, up[3] = {0, 0, 1};
    mpm_desc d = scene_grid(1, 6, deep ? 6 : 1, 14, 0, 0, -5);
    mpm_body_desc b = scene_body(&metal, mpm_sphere(0, 0, MPM_R(3.05), 3), 0.5, -800);
    mpm_body_desc base = scene_body(&metal, mpm_cylinder(0, 0, -3, 5, 3), 0.5, 0);
    int32_t k;
    d.geometry = geometry;
    d.basis = MPM_CUBIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    if (deep) d.side[2] = MPM_SIDE_SYMMETRY;
    q->s = mpm_surfaces_default();
    q->s.longest = deep ? MPM_R(0.37) : MPM_R(0.27);
    q->s.friction = MPM_R(0.2);
    q->s.adhesion = 30;
    q->s.critical = 10;
    q->s.depth = 1;
    q->s.reach = MPM_R(0.2);
    CHECK_EQUAL("a world", mpm_init(&q->w, &d, NULL, 0), MPM_OK);
    CHECK_EQUAL("... a ball", mpm_body_add(&q->w, &b), MPM_OK);
    CHECK_EQUAL("... a block", mpm_body_add(&q->w, &base), MPM_OK);
    for (k = 0; k < 2; k++) CHECK_EQUAL("... a surface", mpm_surface_add(&q->s, &q->w, k), MPM_OK);
    CHECK_EQUAL("... a wall", mpm_surface_wall_add(&q->s, point, up), MPM_OK);
    q->dt = mpm_time_step(&q->w, MPM_R(0.2));
}

static void end(scene *q)
{
    mpm_surfaces_free(&q->s);
    mpm_free(&q->w);
}

static int run(scene *q, int64_t steps)
{
    while (q->w.steps < steps)
        if (mpm_surface_step(&q->s, &q->w, q->dt) < 0) return 0;
    return 1;
}

static int blobs(scene *q, mpm_blob *blob, int *world)
{
    *world = mpm_blobs(&q->w, blob);
    return *world + mpm_surfaces_blobs(&q->s, blob + *world);
}

static mpm_status save(scene *q, const char *path)
{
    mpm_blob blob[BLOBS];
    mpm_fault f;
    int world;
    const int n = blobs(q, blob, &world);
    return mpm_io_checkpoint_write(path, "a scene\n", blob, n, &f);
}

static mpm_status load(scene *q, const char *path, mpm_fault *f)
{
    mpm_blob blob[BLOBS];
    int world;
    const int n = blobs(q, blob, &world);
    mpm_status st = mpm_io_checkpoint_sizes(path, "a scene\n", blob, n, f);
    if (st == MPM_OK && (st = mpm_surfaces_make_room(&q->s, blob + world)) != MPM_OK) *f = q->s.fault;
    if (st == MPM_OK) st = mpm_io_checkpoint_read(path, "a scene\n", blob, n, f);
    if (st == MPM_OK && (st = mpm_restored(&q->w, blob)) != MPM_OK) *f = q->w.fault;
    if (st == MPM_OK && (st = mpm_surfaces_restored(&q->s, &q->w, blob + world)) != MPM_OK) *f = q->s.fault;
    return st;
}

/* Whether two scenes hold the same bits. */
static int same(scene *a, scene *b)
{
    mpm_blob of_a[BLOBS], of_b[BLOBS];
    int world, k, good;
    const int n = blobs(a, of_a, &world);
    good = blobs(b, of_b, &world) == n;
    for (k = 0; k < n && good; k++)
        good = of_a[k].bytes == of_b[k].bytes && !memcmp(of_a[k].data, of_b[k].data, of_a[k].bytes);
    return good;
}

static void restart(mpm_geometry geometry, int64_t half, int64_t all)
{
    const char *path = FOLDER "/surface.mpm", *damaged = FOLDER "/surface_damaged.mpm";
    scene whole, first, second;
    unsigned char *file;
    mpm_meeting m;
    mpm_fault f;
    size_t n, i, undetected = 0;
    int32_t before;
    begin(&whole, geometry);
    begin(&first, geometry);
    begin(&second, geometry);
    before = first.s.surface[0].markers;
    CHECK_TRUE("run in one", run(&whole, all));
    CHECK_TRUE("run to a part", run(&first, half));
    m = mpm_surface_meets(&first.s, &first.w, 0, 1);
    printf("# %s: markers %d to %d, touched %.2f, bonded %.2f\n", geometry == MPM_3D ? "3d" : "rings", (int)before,
           (int)first.s.surface[0].markers, m.touched, m.bonded);
    CHECK_TRUE("... by when faces are halved", first.s.surface[0].markers > before);
    CHECK_TRUE("... and a bond grows", m.dissipated > 10 && m.bonded > 0);
    CHECK_EQUAL("... between two searches", first.s.steps % first.s.renew == 0, 0);
    CHECK_TRUE("they differ", !same(&whole, &first));
    CHECK_EQUAL("saved", save(&first, path), MPM_OK);
    file = slurp(path, &n);
    for (i = 0; i < n; i += n / 40) { /* a bit here and there, and cut short */
        file[i] ^= 16;
        write_file(damaged, file, n);
        undetected += load(&second, damaged, &f) >= 0;
        file[i] ^= 16;
        write_file(damaged, file, i);
        undetected += load(&second, damaged, &f) >= 0;
    }
    free(file);
    CHECK_EQUAL("damage not detected", (long)undetected, 0);
    CHECK_EQUAL("loaded", load(&second, path, &f), MPM_OK);
    CHECK_TRUE("... all of it", same(&first, &second));
    CHECK_TRUE("run on", run(&second, all));
    CHECK_TRUE("... to more markers", second.s.surface[0].markers > first.s.surface[0].markers);
    CHECK_TRUE("the same bits in everything", same(&whole, &second));
    end(&whole);
    end(&first);
    end(&second);
}

/* Numbers that would lead out of the memory, in files whose checksums are right. */
static const char *const spoilt[] = {"steps of surfaces",  "size of surface",  "markers of surface", "faces of surface",
                                     "marker of face",     "face beside face", "place of a marker",  "parent of marker",
                                     "other of meeting",   "other of meeting", "other of meeting",   "face of meeting",
                                     "size of surface",    "faces beside them"};

static void spoil(scene *q, mpm_blob *of, int k)
{
    mpm_surface *c = &q->s.surface[1];
    switch (k) {
    case 0: q->s.steps = -1; break;
    case 1: c->markers = 1; break;
    case 2: c->markers++; break;
    case 3: c->faces--; break;
    case 4: c->face[3][1] = c->markers; break;
    case 5: c->beside[2][0] = -2; break;
    case 6: c->marker[5].x[2] = (mpm_real)NAN; break;
    case 7: c->marker[c->markers - 1].parent[1] = c->markers; break;
    case 8: c->marker[4].meet[0].other = 1; break;
    case 9: c->marker[4].meet[1].other = -2; break;
    case 10: c->marker[4].meet[0].other = 2; break;
    case 11: c->marker[4].meet[0].other = 0, c->marker[4].meet[0].face = q->s.surface[0].faces; break;
    case 12: c->faces = 0; break;
    default: of[7].bytes -= sizeof c->beside[0]; break;
    }
}

static void crafted(void)
{
    const char *path = FOLDER "/surface_crafted.mpm";
    scene q, again;
    mpm_blob blob[BLOBS];
    mpm_fault f;
    int k, n, world;
    for (k = 0; k < 14; k++) {
        begin(&q, MPM_AXISYMMETRIC);
        begin(&again, MPM_AXISYMMETRIC);
        n = blobs(&q, blob, &world);
        spoil(&q, blob + world, k);
        CHECK_EQUAL(spoilt[k], mpm_io_checkpoint_write(path, "a scene\n", blob, n, &f), MPM_OK);
        CHECK_EQUAL("... is refused", load(&again, path, &f), k == 6 ? MPM_ERR_NAN : MPM_ERR_ARGUMENT);
        CHECK_TRUE("... by name", !strcmp(f.field, spoilt[k]));
        CHECK_EQUAL("... without surfaces", again.s.surfaces, 0);
        CHECK_EQUAL("... it steps", mpm_surface_step(&again.s, &again.w, again.dt), MPM_OK);
        end(&q);
        end(&again);
    }
    begin(&q, MPM_AXISYMMETRIC);
    n = mpm_surfaces_blobs(&q.s, blob);
    CHECK_EQUAL("as many blobs as are promised", n, MPM_SURFACES_BLOBS(2));
    blob[5].bytes++;
    CHECK_EQUAL("room for a part of a marker", mpm_surfaces_make_room(&q.s, blob), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", !strcmp(q.s.fault.field, "markers of surface") && q.s.fault.index == 1);
    CHECK_EQUAL("... and the surfaces are as they were", q.s.surfaces, 2);
    end(&q);
}

int main(void)
{
    metal = scene_metal(0, mpm_units_um_us_ng());
    restart(MPM_AXISYMMETRIC, 53, 130);
    restart(MPM_3D, 47, 90);
    crafted();
    return check_end();
}
