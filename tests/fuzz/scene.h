/* scene.h - a small impact for the fuzz targets: ball and plate of aluminium, bonding. SPDX-License-Identifier: MIT */
#ifndef FUZZ_SCENE_H
#define FUZZ_SCENE_H

#include "mpm.h"
#include "mpm_bond.h"
#include "mpm_draw.h"
#include "mpm_io.h"
#include "mpm_measure.h"
#include "mpm_ptw.h"

typedef struct scene {
    mpm_desc desc;
    mpm_body_desc ball, plate;
    mpm_material material;
    mpm_bond bond;
    mpm_world world;
} scene;

static inline void scene_describe(scene *s)
{
    const mpm_units units = mpm_units_um_us_ng();
    mpm_material_preset(&s->material, "al", &units, NULL);
    s->bond = mpm_bond_default(&units);
    s->desc = mpm_desc_default();
    s->desc.cell = 1;
    s->desc.cells[0] = s->desc.cells[1] = 6;
    s->desc.cells[2] = 8;
    s->desc.origin[2] = -3;
    s->desc.side[0] = s->desc.side[2] = MPM_SIDE_SYMMETRY;
    s->desc.user_fields = 1;
    s->ball = mpm_body_desc_default();
    s->ball.spacing = MPM_R(0.5);
    s->ball.density = s->material.density;
    s->ball.stress = mpm_material_stress;
    s->ball.material = &s->material;
    mpm_material_wave_speeds(&s->material, s->material.density, &s->ball.wave_p, &s->ball.wave_s);
    s->plate = s->ball;
    s->ball.shape = mpm_sphere(0, 0, MPM_R(1.5), MPM_R(1.5));
    s->ball.velocity[2] = -800;
    s->plate.shape = mpm_cylinder(0, 0, -2, 3, 2);
    s->plate.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
}

static inline int scene_begin(scene *s)
{
    if (mpm_init(&s->world, &s->desc, NULL, 0) < 0) return 0;
    return mpm_body_add(&s->world, &s->ball) >= 0 && mpm_body_add(&s->world, &s->plate) >= 0;
}

/* Everything that looks at a world, whatever its state. */
static inline void scene_measure(scene *s, int files)
{
    mpm_world *w = &s->world;
    mpm_bond_measure m;
    mpm_pieces apart;
    mpm_draw_canvas canvas;
    mpm_draw_cut_desc cut = mpm_draw_cut_of(w, w->points.temperature);
    mpm_fault fault;
    char text[6000];
    mpm_body_totals(w, -1);
    mpm_bond_measure_body(w, -1);
    mpm_io_world_text(text, sizeof text, w);
    if (w->bodies < 2) return;
    mpm_rebound_of(w, 0, 60);
    mpm_pieces_of(w, 0, &apart);
    mpm_rebound_from(w, 0, 1, 60);
    mpm_splat_measure(w, 0, 1, 1000);
    mpm_interface_of(w, 0, -1);
    mpm_bond_measure_pair(&s->bond, w, 0, 1, &m);
    if (files && mpm_draw_cuts(&canvas, &cut, 1, 1, 120, &fault) == MPM_OK) mpm_draw_canvas_free(&canvas);
}

#endif
