/* elastic.h - what the elastic sections of the verification share: a textbook solid and means over a
   body. SPDX-License-Identifier: MIT */
#ifndef ELASTIC_H
#define ELASTIC_H

#include "scene.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

/* Isotropic and linear in the logarithmic strain, whatever the units. */
static inline mpm_material elastic(double young, double poisson, double density)
{
    mpm_material m = mpm_material_default();
    m.density = (mpm_real)density;
    m.young = (mpm_real)young;
    m.poisson = (mpm_real)poisson;
    m.shear_modulus = (mpm_real)(young / (2 * (1 + poisson)));
    return m;
}

/* Mean velocity of a body (-1: of all) along an axis. */
static inline double mean_velocity(const mpm_world *w, int32_t body, int axis)
{
    const mpm_totals t = mpm_body_totals(w, body);
    return t.momentum[axis] / t.mass;
}

/* Order of convergence seen between two grids of which the second has half the cell. */
static inline double order_of(double coarse, double fine) { return log(fabs(coarse / fine)) / log(2); }

#endif
