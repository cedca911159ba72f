/* kill DIR STEPS - a run that writes a checkpoint and a frame of a series every 20 steps, goes on from the checkpoint
   it finds, and at the end writes its state to DIR/end. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "../fuzz/scene.h"
#include <stdio.h>
#include <stdlib.h>

static int keep(scene *s, const char *folder, const char *name, const char *text)
{
    char path[300];
    mpm_blob blob[MPM_BLOBS(2)];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return mpm_io_checkpoint_write(path, text, blob, mpm_blobs(&s->world, blob), NULL) >= 0;
}

static int frame(scene *s, const char *folder)
{
    char path[300], name[40];
    mpm_io_vtu_desc v = mpm_io_vtu_desc_default();
    v.count = (size_t)s->world.points.count;
    v.x[2] = s->world.points.x[2];
    snprintf(name, sizeof name, "%06ld.vtu", (long)s->world.steps);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (mpm_io_vtu(path, &v, NULL) < 0) return 0;
    snprintf(path, sizeof path, "%s/series.pvd", folder);
    return mpm_io_pvd_add(path, name, (double)s->world.time, NULL) >= 0;
}

int main(int argc, char **argv)
{
    static scene s;
    char text[6000], path[300];
    mpm_blob blob[MPM_BLOBS(2)];
    FILE *there;
    long steps = argc > 2 ? strtol(argv[2], NULL, 10) : 0;
    if (argc < 3 || mpm_io_make_directory(argv[1], NULL) < 0) return 2;
    scene_describe(&s);
    if (!scene_begin(&s)) return 2;
    mpm_io_world_text(text, sizeof text, &s.world);
    snprintf(path, sizeof path, "%s/checkpoint", argv[1]);
    there = fopen(path, "rb");
    if (there) {
        fclose(there);
        if (mpm_io_checkpoint_read(path, text, blob, mpm_blobs(&s.world, blob), NULL) < 0) return 3;
        if (mpm_restored(&s.world, blob) < 0) return 4;
    }
    while (s.world.steps < steps) {
        if (s.world.steps % 20 == 0 && (!frame(&s, argv[1]) || !keep(&s, argv[1], "checkpoint", text))) return 5;
        if (mpm_bond_step(&s.bond, &s.world, mpm_time_step(&s.world, MPM_R(0.05))) < 0) return 6;
    }
    return keep(&s, argv[1], "end", text) ? 0 : 7;
}
