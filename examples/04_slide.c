/* 04_slide - a block slides down a slope. Coulomb: it accelerates with g (sin a - mu cos a) as long as that is
   positive, else it stays. Not the slope is inclined, but gravity, which rises over 0.2 s, so that nothing starts to
   swing: the block has then felt half of that time. Expected, for 30 degrees: 4.905 m/s^2 without friction and 2.356
   with friction 0.3, found to 0.1 %; with friction 0.7 (tan 30 is 0.577) it stays, and sways a little. Plane strain: a
   block of 1 m x 0.5 m, of soft rubber: its slow waves allow large steps. Units m, kg, s. SPDX-License-Identifier: MIT
*/
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"

#include <stdio.h>

static const double g = 9.81, angle = 0.523598775598299, rise = 0.2; /* m/s^2; 30 degrees; s */

/* Gravity leans, and comes slowly. */
static void lean(mpm_world *w)
{
    const double t = (double)w->time, s = t < rise ? sin((double)MPM_PI * t / (2 * rise)) : 1;
    w->desc.gravity[0] = (mpm_real)(s * s * g * sin(angle));
    w->desc.gravity[2] = (mpm_real)(s * s * -g * cos(angle));
}

/* Lets the block go for 0.6 s and returns its acceleration down the slope [m/s^2]; -1 on failure. */
static double slide(double friction)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_material rubber = mpm_material_default();
    double acceleration;
    mpm_totals t;
    mpm_world w;
    mpm_real dt;

    rubber.young = 1e6; /* Pa */
    rubber.poisson = MPM_R(0.3);
    rubber.shear_modulus = rubber.young / MPM_R(2.6);
    rubber.density = 1000;

    d.geometry = MPM_PLANE_STRAIN;
    d.basis = MPM_GIMP;
    d.cell = 0.0625;
    d.cells[0] = 48;
    d.cells[2] = 16;
    d.side[4] = MPM_SIDE_FIXED; /* the ground under the slope */
    d.contact.law = MPM_CONTACT_FRICTION;
    d.contact.friction = (mpm_real)friction;
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK) return -1;

    b.spacing = d.cell / 2;
    b.density = rubber.density;
    b.stress = mpm_material_stress;
    b.material = &rubber;
    b.wave_p = mpm_wave_speed_p(rubber.young, rubber.poisson, rubber.density);
    b.shape = mpm_box(0.5, -1, 0.25, 1.5, 1, 0.75); /* the block (in two dimensions y does not matter), upon ... */
    if (mpm_body_add(&w, &b) != MPM_OK) return -1;
    b.shape = mpm_box(0, -1, 0, 3, 1, 0.25);        /* ... the slope, added last: contact takes its normal */
    if (mpm_body_add(&w, &b) != MPM_OK) return -1;

    dt = mpm_time_step(&w, MPM_R(0.3));
    while (w.time < MPM_R(0.6)) {
        lean(&w);
        if (mpm_step(&w, dt) < 0) return -1;
    }
    t = mpm_body_totals(&w, 0);
    acceleration = t.momentum[0] / t.mass / ((double)w.time - rise / 2);
    mpm_free(&w);
    return acceleration;
}

int main(void)
{
    static const double friction[3] = {0, 0.3, 0.7};
    int i;
    for (i = 0; i < 3; i++) {
        const double free = g * (sin(angle) - friction[i] * cos(angle)), exact = free > 0 ? free : 0;
        const double found = slide(friction[i]);
        printf("friction %.1f: %.4f m/s^2, expected %.4f: error %.2f %% of g sin a\n", friction[i], found, exact,
               100 * (found - exact) / (g * sin(angle)));
    }
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
