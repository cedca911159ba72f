/* agree - a small bonded impact whose numbers are compared between compilers and levels.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"

#include <stdio.h>

int main(void)
{
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(0, u);
    mpm_bond bond = mpm_bond_default(&u);
    mpm_desc d = scene_grid(1.5, 10, 10, 14, 0, 0, -9);
    mpm_body_desc ball = scene_body(&m, mpm_sphere(0, 0, 3, 3), 0.75, -900);
    mpm_body_desc slab = scene_body(&m, mpm_cylinder(0, 0, -6, 7.5, 6), 0.75, 0);
    mpm_totals t;
    mpm_world w;
    int n;
    d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    slab.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK || mpm_body_add(&w, &ball) != MPM_OK || mpm_body_add(&w, &slab) != MPM_OK)
        return 1;
    for (n = 0; n < 600; n++)
        if (scene_step(&w, &bond, MPM_R(8e-6)) < 0) return 1;
    t = mpm_body_totals(&w, -1);
    printf("%.17g\n%.17g\n%.17g\n%.17g\n%.17g\n", t.kinetic, t.internal, t.momentum[2], t.plastic_strain_mean,
           mpm_bond_measure_body(&w, -1).abp);
    mpm_free(&w);
    return 0;
}
