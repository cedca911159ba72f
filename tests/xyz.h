/* xyz.h - an output format added from outside the library: extended XYZ, which OVITO and ASE read. Any
   other format goes the same way. SPDX-License-Identifier: MIT */
#ifndef XYZ_H
#define XYZ_H

#include "mpm_io.h"

/* All points of a world: id, position, velocity, temperature. MPM_ERR_FILE, MPM_ERR_ARGUMENT. */
static inline mpm_status write_xyz(const char *path, const mpm_world *w, mpm_fault *fault)
{
    const mpm_points *p = &w->points;
    mpm_io_file f;
    mpm_status s = mpm_io_open(&f, path, fault);
    int32_t i;
    int a;
    if (s < 0) return s;
    mpm_io_put_integer(&f, p->count);
    mpm_io_put(&f, "\nProperties=id:I:1:pos:R:3:velo:R:3:temperature:R:1 Time=");
    mpm_io_put_real(&f, w->time);
    mpm_io_put(&f, "\n");
    for (i = 0; i < p->count; i++) {
        const mpm_real *const column[7] = {p->x[0], p->x[1], p->x[2], p->v[0], p->v[1], p->v[2], p->temperature};
        mpm_io_put_integer(&f, p->id[i]);
        for (a = 0; a < 7; a++) {
            mpm_io_put(&f, " ");
            mpm_io_put_real(&f, column[a][i]);
        }
        mpm_io_put(&f, "\n");
    }
    return mpm_io_close(&f, fault);
}

#endif
