/* threads - two worlds in two threads, of one material and one bond: no data race, and the same bits as alone.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "../fuzz/scene.h"
#include <pthread.h>
#include <stdio.h>

static mpm_material shared;
static mpm_bond bond;

static void *run(void *context)
{
    scene *s = (scene *)context;
    int i;
    scene_describe(s);
    s->ball.material = s->plate.material = &shared;
    if (!scene_begin(s)) return NULL;
    for (i = 0; i < 60; i++)
        if (mpm_bond_step(&bond, &s->world, mpm_time_step(&s->world, MPM_R(0.2))) < 0) return NULL;
    return s;
}

int main(void)
{
    static scene s[3];
    const mpm_units units = mpm_units_um_us_ng();
    pthread_t thread[2];
    void *done[2];
    int i;
    size_t f;
    mpm_material_preset(&shared, "al", &units, NULL);
    bond = mpm_bond_default(&units);
    for (i = 0; i < 2; i++) pthread_create(&thread[i], NULL, run, &s[i]);
    for (i = 0; i < 2; i++) pthread_join(thread[i], &done[i]);
    if (!done[0] || !done[1] || !run(&s[2])) return 1;
    for (f = 0; f < (size_t)s[0].world.fields; f++)
        for (i = 1; i < 3; i++)
            if (memcmp(s[0].world.field + f * s[0].world.stride, s[i].world.field + f * s[i].world.stride,
                       (size_t)s[0].world.points.count * sizeof(mpm_real)))
                return 1;
    for (i = 0; i < 3; i++) mpm_free(&s[i].world);
    return 0;
}
