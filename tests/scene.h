/* scene.h - small worlds for the tests of the method, in um, us, ng. SPDX-License-Identifier: MIT */
#ifndef SCENE_H
#define SCENE_H

#include "mpm.h"
#include "mpm_ptw.h"
#include "mpm_bond.h"
#include "mpm_measure.h"

/* Aluminium, elastic or as it is. */
static inline mpm_material scene_metal(int elastic, mpm_units u)
{
    mpm_material m;
    mpm_fault f;
    mpm_material_preset(&m, "al", &u, &f);
    if (elastic) mpm_material_model(&m, "elastic", &f);
    return m;
}

static inline mpm_body_desc scene_body(mpm_material *m, mpm_shape shape, double spacing, double vz)
{
    mpm_body_desc b = mpm_body_desc_default();
    b.shape = shape;
    b.spacing = (mpm_real)spacing;
    b.density = m->density;
    b.temperature = m->temperature;
    b.velocity[2] = (mpm_real)vz;
    b.stress = mpm_material_stress;
    b.material = m;
    mpm_material_wave_speeds(m, m->density, &b.wave_p, &b.wave_s);
    return b;
}

/* A grid of nx, ny, nz cells whose lowest corner is (x, y, z). */
static inline mpm_desc scene_grid(double cell, int nx, int ny, int nz, double x, double y, double z)
{
    mpm_desc d = mpm_desc_default();
    d.cell = (mpm_real)cell;
    d.cells[0] = nx;
    d.cells[1] = ny;
    d.cells[2] = nz;
    d.origin[0] = (mpm_real)x;
    d.origin[1] = (mpm_real)y;
    d.origin[2] = (mpm_real)z;
    d.points = 40000;
    d.bodies = 4;
    return d;
}

/* A step with bonding, growing the grid's memory when it must. */
static inline mpm_status scene_step(mpm_world *w, mpm_bond *b, mpm_real dt)
{
    mpm_status s;
    while ((s = mpm_locate(w)) == MPM_ERR_FULL)
        if (mpm_reserve(w, NULL, 0) != MPM_OK) return MPM_ERR_MEMORY;
    if (s < 0) return s;
    mpm_p2g(w);
    mpm_forces(w, dt);
    mpm_grid_update(w, dt);
    mpm_contact_find(w);
    if (b) {
        mpm_bond_grow(b, w, dt);
        mpm_bond_nodes(b, w);
    }
    mpm_contact_apply(w, dt);
    mpm_g2p(w, dt);
    mpm_musl(w, dt);
    if (mpm_stress(w, dt) < 0) return w->fault.status;
    mpm_move(w, dt);
    return s;
}

#endif
