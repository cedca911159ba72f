/* 01_drop - the first program that uses the headers. An aluminium ball of 14 um flies at 300 m/s onto a rigid wall.
   What does it do? It yields where it touches, stops after 18 ns and rebounds, slowly: its shape has taken the energy.
   Expected: it leaves the wall at 10.7 m/s, 11.31 um high. A quarter of the ball is enough: two planes through its
   axis are mirrors. Units um, us, ng: velocity in m/s, stress in MPa, energy in pJ. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"

#include <stdio.h>

int main(void)
{
    const mpm_units um_us_ng = mpm_units_um_us_ng();
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_totals start, now;
    mpm_material al;
    mpm_world w;
    mpm_real dt;

    /* The grid: 12 x 12 x 20 cells of 1 um, its corner at the origin. Mirrors at x = 0 and y = 0, the wall at z = 0. */
    d.cell = 1;
    d.cells[0] = d.cells[1] = 12;
    d.cells[2] = 20;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    d.side[4] = MPM_SIDE_WALL;

    /* The metal: strength after Preston, Tonks and Wallace, pressure after Mie and Grueneisen. */
    if (mpm_material_preset(&al, "al", &um_us_ng, NULL) != MPM_OK) return 1;

    /* The ball: points on a lattice of 0.5 um, eight in a cell. */
    b.shape = mpm_sphere(0, 0, 7, 7);
    b.spacing = 0.5;
    b.velocity[2] = -300;
    b.density = al.density;
    b.temperature = al.temperature;
    b.stress = mpm_material_stress;
    b.material = &al;
    mpm_material_wave_speeds(&al, al.density, &b.wave_p, &b.wave_s);

    /* Memory comes from malloc, and as much of it as the ball needs. */
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK || mpm_body_add(&w, &b) != MPM_OK) {
        printf("%s: %g\n", w.fault.field, (double)w.fault.value);
        return 1;
    }

    /* The loop. A step may not take longer than a wave through a cell: a fifth of that. */
    start = mpm_body_totals(&w, 0);
    dt = mpm_time_step(&w, MPM_R(0.2));
    printf("time [ns]   velocity [m/s]   height [um]   kinetic energy [%%]\n");
    while (w.time < MPM_R(0.04)) {
        if (w.steps % 150 == 0) {
            now = mpm_body_totals(&w, 0);
            printf("%9.1f %16.1f %13.2f %20.1f\n", 1e3 * (double)w.time, now.momentum[2] / now.mass,
                   now.high[2] - now.low[2] + 0.5, 100 * now.kinetic / start.kinetic);
        }
        if (mpm_step(&w, dt) < 0) {
            printf("%s: %g at point %lld\n", w.fault.field, (double)w.fault.value, (long long)w.fault.index);
            return 1;
        }
    }

    /* What came out of it. Nothing is lost: what the wall gave is all the momentum that changed. */
    now = mpm_body_totals(&w, 0);
    printf("points: %ld, steps: %lld\n", now.points, (long long)w.steps);
    printf("the ball gained, of the momentum the wall gave: %.6f\n",
           (now.momentum[2] - start.momentum[2]) / w.ledger.impulse[2]);
    printf("height of the ball: %.2f um\n", now.high[2] - now.low[2] + 0.5);
    printf("mean plastic strain: %.3f\n", now.plastic_strain_mean);
    printf("it leaves the wall at %.1f m/s\n", now.momentum[2] / now.mass);
    mpm_free(&w);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
