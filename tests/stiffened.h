/* stiffened.h - the equation of state that mpm_ptw.h prints as an example of one's own.
   SPDX-License-Identifier: MIT */
#ifndef STIFFENED_H
#define STIFFENED_H

#include "mpm_ptw.h"

/* A stiffened gas, p = (g - 1) rho e + g P (rho/rho0 - 1), as the header prints it. */
typedef struct stiffened { mpm_real g, P; } stiffened;

static inline mpm_pressure stiffened_gas(const void *context, const mpm_material *m, mpm_real density, mpm_real energy)
{
    const stiffened *c = (const stiffened *)context;
    mpm_pressure p;
    p.energy_slope = (c->g - 1) * density;
    p.pressure = p.energy_slope * energy + c->g * c->P * (density / m->density - 1);
    p.sound_speed = mpm_sqrt(c->g * (p.pressure + c->P) / density);
    return p;
}

#endif
