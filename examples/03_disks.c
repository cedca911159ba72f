/* 03_disks - two elastic disks meet: the first problem the material point method was shown with (Sulsky, Chen,
   Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179). Radius 0.2 m, E 1000 Pa, nu 0.3, 1000 kg/m^3, in a
   square of 1 m, along its diagonal at 0.1 m/s along each axis. They squeeze each other until nine tenths of their
   energy are elastic, part again, and swing. Contact is where the points touch, its direction that of the line which
   parts them best. Expected: they touch after 1.095 s ((sqrt(1/2) - 0.4) / (0.2 sqrt(2)) = 1.0858), leave with 88.0 %
   of their speed, and 99.97 % of the energy is found again. Plane strain: per metre of depth, in the plane x-z. Units
   m, kg, s. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"

#include <stdio.h>

/* Speed of body k along the diagonal [m/s]. */
static double along(const mpm_world *w, int k)
{
    const mpm_totals t = mpm_body_totals(w, k);
    return (t.momentum[0] + t.momentum[2]) / t.mass * sqrt(0.5);
}

int main(void)
{
    const double speed = 0.1 * sqrt(2.0);
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_material rubber = mpm_material_default();
    double start, touched = 0;
    mpm_totals t;
    mpm_world w;
    mpm_real dt;

    rubber.young = 1000;
    rubber.poisson = MPM_R(0.3);
    rubber.shear_modulus = rubber.young / MPM_R(2.6);
    rubber.density = 1000;

    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_GIMP; /* disks cross many cells */
    d.cell = MPM_R(0.025);
    d.cells[0] = d.cells[2] = 40;
    d.contact.normal = MPM_NORMAL_LOGISTIC;
    d.contact.touch = 1;
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK) return 1;

    b.spacing = d.cell / 2;
    b.density = rubber.density;
    b.stress = mpm_material_stress;
    b.material = &rubber;
    b.wave_p = mpm_wave_speed_p(rubber.young, rubber.poisson, rubber.density);
    b.shape = mpm_sphere(0.25, 0, 0.25, MPM_R(0.2)); /* a sphere's section: a disk */
    b.velocity[0] = b.velocity[2] = MPM_R(0.1);
    if (mpm_body_add(&w, &b) != MPM_OK) return 1;
    b.shape = mpm_sphere(0.75, 0, 0.75, MPM_R(0.2));
    b.velocity[0] = b.velocity[2] = MPM_R(-0.1);
    if (mpm_body_add(&w, &b) != MPM_OK) return 1;

    start = mpm_body_totals(&w, -1).kinetic;
    dt = mpm_time_step(&w, MPM_R(0.2));
    printf("time [s]   speed [m/s]   kinetic, elastic, lost in contact [%%]\n");
    while (w.time < 3) {
        if (mpm_step(&w, dt) < 0) return 1;
        if (!(touched > 0) && along(&w, 0) < 0.999 * speed) touched = (double)w.time;
        if (w.steps % 50) continue;
        t = mpm_body_totals(&w, -1);
        printf("%8.3f %13.4f %16.2f %8.2f %8.3f\n", (double)w.time, along(&w, 0), 100 * t.kinetic / start,
               100 * t.internal / start, 100 * w.ledger.contact / start);
    }
    t = mpm_body_totals(&w, -1);
    printf("they touch after %.3f s\n", touched);
    printf("they leave with %.1f %% of their speed\n", -100 * along(&w, 0) / speed);
    printf("they mirror each other to %.1e\n", fabs(along(&w, 0) + along(&w, 1)) / speed);
    printf("energy kept, with what is elastic and what contact took: %.2f %%\n",
           100 * (t.kinetic + t.internal + w.ledger.contact) / start);
    mpm_free(&w);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
