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

/* The word of a basis. */
static inline const char *scene_basis(mpm_basis basis)
{
#define SCENE_WORD(name, word, text) word,
    static const char *const words[] = {MPM_BASIS_LIST(SCENE_WORD) "?"};
#undef SCENE_WORD
    return words[basis < MPM_BASES ? basis : MPM_BASES];
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

/* A step, with or without bonding. */
static inline mpm_status scene_step(mpm_world *w, const mpm_bond *b, mpm_real dt)
{
    return b ? mpm_bond_step(b, w, dt) : mpm_step(w, dt);
}

#endif
