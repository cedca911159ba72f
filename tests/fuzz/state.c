/* A running world whose points were overwritten, as "plain data: write it if you know why" allows: steps, measures,
   pictures and files stay within memory whatever the numbers are. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "scene.h"

#define PATH "build/fuzz/state"

static void files(scene *s)
{
    mpm_world *w = &s->world;
    mpm_io_vtu_desc v = mpm_io_vtu_desc_default();
    mpm_io_field field[2];
    field[0] = mpm_io_vector("velocity", w->points.v[0], w->points.v[1], w->points.v[2], 1e-3);
    field[1] = mpm_io_uint8("flags", w->points.flags);
    v.count = (size_t)w->points.count;
    v.x[0] = w->points.x[0];
    v.x[2] = w->points.x[2];
    v.fields = field;
    v.field_count = 2;
    v.float32 = 1;
    mpm_io_vtu(PATH ".vtu", &v, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    scene s;
    mpm_real dt;
    int i;
    scene_describe(&s);
    s.desc.geometry = (mpm_geometry)(fuzz_byte(&f) % MPM_GEOMETRIES);
    s.desc.basis = (mpm_basis)(fuzz_byte(&f) % MPM_BASES);
    s.desc.scheme = (mpm_scheme)(fuzz_byte(&f) % MPM_SCHEMES);
    s.desc.contact.normal = (mpm_normal_rule)(fuzz_byte(&f) % MPM_NORMAL_RULES);
    s.desc.contact.touch = (int)(fuzz_byte(&f) & 1);
    s.desc.side[4] = (mpm_side)(fuzz_byte(&f) % MPM_SIDE_KINDS);
    FUZZ_WANT(scene_begin(&s));
    dt = mpm_time_step(&s.world, MPM_R(0.2));
    for (i = 0; i < 2; i++) FUZZ_WANT(mpm_bond_step(&s.bond, &s.world, dt) >= 0);
    while (f.left) {
        const int32_t point = (int32_t)((fuzz_byte(&f) | fuzz_byte(&f) << 8) % (unsigned)s.world.points.count);
        const unsigned what = fuzz_byte(&f) % (unsigned)(s.world.fields + 2);
        if (what < (unsigned)s.world.fields)
            s.world.field[(size_t)what * s.world.stride + (size_t)point] = (mpm_real)fuzz_any(&f);
        else if (what == (unsigned)s.world.fields)
            s.world.points.flags[point] = (uint8_t)fuzz_byte(&f);
        else
            s.world.points.id[point] = fuzz_int(&f, 0);
    }
    scene_measure(&s, 1);
    files(&s);
    for (i = 0; i < 3; i++)
        if (mpm_bond_step(&s.bond, &s.world, dt) < 0) break;
    scene_measure(&s, 1);
    files(&s);
    mpm_free(&s.world);
    return 0;
}
