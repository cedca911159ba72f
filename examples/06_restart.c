/* 06_restart - a run is broken off half way and goes on from a file, to the same bits as if nothing had happened. A
   ball of aluminium hits a plate at 700 m/s and begins to bond. First the whole run; then a half,
   a checkpoint, and nothing more of that world; then a new world, set up as before, reads the checkpoint and goes on.
   Expected: 0 of 16400 numbers differ, 4.330 % of the touched surface has bonded in both. The file
   is written where the program is called, or to the path given, and removed at the end. Units um, us, ng.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_bond.h"
#include "mpm_io.h"
#include "mpm_ptw.h"

#include <stdio.h>
#include <string.h>

enum { STEPS = 1000 };

/* The world at the start. The same every time: a checkpoint holds how it is, not what it is made of. */
static int begin(mpm_world *w, const mpm_material *al)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    d.geometry = MPM_AXISYMMETRIC;
    d.side[0] = MPM_SIDE_SYMMETRY;
    d.cell = 1;
    d.cells[0] = 20;
    d.cells[2] = 30;
    d.origin[2] = -10;
    b.spacing = 0.5;
    b.density = al->density;
    b.temperature = al->temperature;
    b.stress = mpm_material_stress;
    b.material = al;
    mpm_material_wave_speeds(al, al->density, &b.wave_p, &b.wave_s);
    if (mpm_init(w, &d, NULL, 0) < 0) return 0;
    b.shape = mpm_sphere(0, 0, MPM_R(7.5), 7);
    b.velocity[2] = -700;
    if (mpm_body_add(w, &b) < 0) return 0;
    b.shape = mpm_cylinder(0, 0, -8, 16, 8);
    b.velocity[2] = 0;
    b.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    return mpm_body_add(w, &b) >= 0;
}

static int run(mpm_world *w, const mpm_bond *bond, int64_t until)
{
    const mpm_real dt = mpm_time_step(w, MPM_R(0.2));
    while (w->steps < until)
        if (mpm_bond_step(bond, w, dt) < 0) return 0;
    return 1;
}

/* Numbers of the points that differ in a bit. */
static int64_t differing(const mpm_world *a, const mpm_world *b)
{
    int64_t n = 0;
    int32_t i;
    int f;
    for (f = 0; f < a->fields; f++)
        for (i = 0; i < a->points.count; i++)
            if (memcmp(&a->field[(size_t)f * a->stride + (size_t)i], &b->field[(size_t)f * b->stride + (size_t)i],
                       sizeof *a->field))
                n++;
    return n;
}

int main(int argc, char **argv)
{
    const char *path = argc > 1 ? argv[1] : "06_restart.mpm";
    const mpm_units units = mpm_units_um_us_ng();
    const mpm_bond bond = mpm_bond_default(&units);
    mpm_blob blobs[MPM_BLOBS(2)];
    char text[4000];
    mpm_material al;
    mpm_world whole, first, second;
    mpm_fault fault;
    int n;

    if (mpm_material_preset(&al, "al", &units, NULL) < 0) return 1;
    if (!begin(&whole, &al) || !run(&whole, &bond, STEPS)) return 1;

    if (!begin(&first, &al) || !run(&first, &bond, STEPS / 2)) return 1;
    n = mpm_blobs(&first, blobs);
    mpm_io_world_text(text, sizeof text, &first);
    if (mpm_io_checkpoint_write(path, text, blobs, n, &fault) < 0) {
        printf("%s: %s\n", path, fault.field);
        return 1;
    }
    printf("broken off after %lld steps, %.2f ns\n", (long long)first.steps, 1e3 * (double)first.time);
    mpm_free(&first);

    if (!begin(&second, &al)) return 1;
    n = mpm_blobs(&second, blobs);
    mpm_io_world_text(text, sizeof text, &second); /* refused if it is not the same, line by line */
    if (mpm_io_checkpoint_read(path, text, blobs, n, &fault) < 0 || mpm_restored(&second, blobs) < 0) {
        printf("%s: %s\n", path, fault.field);
        return 1;
    }
    printf("goes on after %lld steps, %.2f ns\n", (long long)second.steps, 1e3 * (double)second.time);
    if (!run(&second, &bond, STEPS)) return 1;

    printf("bonded: %.3f and %.3f %% of the touched surface\n", mpm_bond_measure_body(&whole, -1).pbcp,
           mpm_bond_measure_body(&second, -1).pbcp);
    printf("the ledgers are %s\n",
           memcmp(&whole.ledger, &second.ledger, sizeof whole.ledger) ? "different" : "the same");
    printf("numbers that differ: %lld of %lld\n", (long long)differing(&whole, &second),
           (long long)whole.points.count * whole.fields);
    mpm_free(&whole);
    mpm_free(&second);
    remove(path);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
