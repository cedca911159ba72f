/* 02_bar - a bar swings. An aluminium bar of 1 m, held at one end and free at the other, rings in its first mode: a
   quarter of a wave fits into it, so that it swings c / 4 L times a second, c the speed of longitudinal waves. Its
   sides slide along walls: it cannot bulge. Expected: the frequency is right to 0.083 % with 20 cells and to 0.021 %
   with 40: the error falls with the square of the cell. Units m, kg, s. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"

#include <stdio.h>

/* Hooke's law, the plainest of the materials in mpm_ptw.h. */
static mpm_material hooke(double young, double poisson, double density)
{
    mpm_material m = mpm_material_default();
    m.strength = MPM_STRENGTH_ELASTIC;
    m.young = (mpm_real)young;
    m.poisson = (mpm_real)poisson;
    m.shear_modulus = (mpm_real)(young / (2 + 2 * poisson));
    m.density = (mpm_real)density;
    return m;
}

/* Lets a bar with so many cells swing for five periods and returns its frequency [1/s]; 0 on failure. */
static double frequency(const mpm_material *m, double length, int cells)
{
    const double c = (double)mpm_wave_speed_p(m->young, m->poisson, m->density), cell = length / cells;
    double old = 0, now = 0, first = 0, last = 0;
    int32_t i;
    int zeros = 0;
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_world w;
    mpm_real dt;

    d.cell = (mpm_real)cell;
    d.cells[0] = cells + 2; /* room to swing */
    d.basis = MPM_GIMP;
    d.side[0] = MPM_SIDE_FIXED;
    d.side[2] = d.side[3] = d.side[4] = d.side[5] = MPM_SIDE_SYMMETRY;
    b.shape = mpm_box(0, 0, 0, (mpm_real)length, d.cell, d.cell);
    b.spacing = d.cell / 2;
    b.density = m->density;
    b.stress = mpm_material_stress;
    b.material = m;
    b.wave_p = (mpm_real)c;
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK || mpm_body_add(&w, &b) != MPM_OK) return 0;

    /* The first mode: at rest at x = 0, fastest at x = L; small enough that the bar stays straight. */
    for (i = 0; i < w.points.count; i++)
        w.points.v[0][i] = (mpm_real)(1e-4 * c * sin((double)MPM_PI * (double)w.points.x[0][i] / (2 * length)));

    /* Its momentum passes zero twice in a period. */
    dt = mpm_time_step(&w, MPM_R(0.2));
    while (zeros < 11) {
        if (mpm_step(&w, dt) < 0) return 0;
        old = now;
        now = mpm_body_totals(&w, 0).momentum[0];
        if (!(old * now < 0)) continue;
        last = (double)w.time - (double)dt * now / (now - old); /* between two steps: on a straight line */
        if (zeros++ == 0) first = last;
    }
    mpm_free(&w);
    return (zeros - 1) / 2.0 / (last - first);
}

int main(void)
{
    const double length = 1;                          /* m */
    const mpm_material al = hooke(70e9, 0.33, 2700);  /* Pa, 1, kg/m^3 */
    const double c = (double)mpm_wave_speed_p(al.young, al.poisson, al.density), exact = c / (4 * length);
    int cells;
    printf("waves run at %.1f m/s: the bar swings at %.2f Hz\n", c, exact);
    for (cells = 10; cells <= 40; cells *= 2) {
        const double f = frequency(&al, length, cells);
        printf("%2d cells: error %.4f %%, %.2f Hz\n", cells, 100 * (f / exact - 1), f);
    }
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
