/* The spray: every number of its description, some steps, its state overwritten as from a damaged store, and on.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "mpm.h"
#include "mpm_spray.h"

static void change_desc(fuzz *f, mpm_spray_desc *d, mpm_spray_plane *plane)
{
    FUZZ_CHOICE(f, d->mark);
    fuzz_reals(f, &d->particle.shear, 4);
    fuzz_reals(f, &d->target.shear, 4);
    fuzz_reals(f, &d->density, 5);
    FUZZ_REAL(f, d->nozzle_radius);
    FUZZ_REAL(f, d->feed);
    d->batch = fuzz_int(f, d->batch);
    d->total = fuzz_int(f, 0);
    fuzz_reals(f, d->release, 2);
    FUZZ_CHOICE(f, d->gas);
    fuzz_reals(f, &d->gas_speed, 5);
    fuzz_reals(f, d->gravity, 3);
    fuzz_reals(f, &d->friction, 2);
    FUZZ_CHOICE(f, d->rebound);
    FUZZ_REAL(f, d->restitution);
    FUZZ_CHOICE(f, d->contact);
    FUZZ_REAL(f, d->alpha);
    FUZZ_CHOICE(f, d->mixing);
    fuzz_reals(f, &d->gamma_target, 2);
    FUZZ_CHOICE(f, d->deposit);
    FUZZ_REAL(f, d->stand_off);
    fuzz_reals(f, d->low, 3);
    fuzz_reals(f, d->high, 3);
    fuzz_reals(f, &d->dt, 3);
    FUZZ_CHOICE(f, d->iterations);
    FUZZ_CHOICE(f, d->contacts_max);
    if (d->iterations > 1000) d->iterations = 1000; /* as many loops as are asked for */
    if (d->contacts_max > 100) d->contacts_max = 100;
    FUZZ_CHOICE(f, d->search);
    d->capacity = fuzz_int(f, d->capacity);
    if (d->capacity > 1000) d->capacity = 1000; /* all in one place are as many pairs as it squared */
    fuzz_reals(f, &d->target_radius, 3);
    if (fuzz_byte(f) < 128) return;
    memset(plane, 0, sizeof *plane);
    plane->point[0] = d->stand_off;
    plane->normal[0] = -1;
    plane->target = 1;
    fuzz_reals(f, plane->point, 9);
    d->planes = plane;
    d->plane_count = fuzz_int(f, 1) > 1 ? 0 : 1;
}

/* Bytes of the state changed, then taken as read from a file. */
static void damage(fuzz *f, mpm_spray *s)
{
    mpm_blob blob[MPM_SPRAY_BLOBS];
    const int n = mpm_spray_blobs(s, blob);
    int k;
    for (k = 0; k < 6; k++) {
        const mpm_blob *b = &blob[fuzz_byte(f) % (unsigned)n];
        const size_t at = fuzz_byte(f) | (size_t)fuzz_byte(f) << 8, length = fuzz_byte(f) % 12;
        if (at < b->bytes) fuzz_bytes(f, (char *)b->data + at, at + length < b->bytes ? length : b->bytes - at);
    }
    if (mpm_spray_restored(s, blob) < 0) FUZZ_WANT(s->fault.field);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    mpm_spray_desc d = mpm_spray_desc_default();
    mpm_spray_plane plane;
    mpm_spray_metrics m;
    mpm_spray_ball ball;
    mpm_spray s;
    int i;
    d.capacity = 300;
    d.batch = 20;
    change_desc(&f, &d, &plane);
    if (mpm_spray_init(&s, &d, NULL, 0) < 0) {
        FUZZ_WANT(s.fault.field);
        mpm_spray_free(&s);
        return 0;
    }
    memset(&ball, 0, sizeof ball);
    ball.x[0] = d.stand_off / 2;
    ball.v[0] = 500;
    ball.radius = d.median_radius;
    ball.density = d.density;
    fuzz_reals(&f, ball.x, 11);
    mpm_spray_add(&s, &ball);
    for (i = 0; i < 4; i++)
        if (mpm_spray_step(&s) < 0) break;
    mpm_spray_measure(&s, &m);
    if (fuzz_byte(&f) < 128) damage(&f, &s);
    for (i = 0; i < 4; i++)
        if (mpm_spray_step(&s) < 0) break;
    mpm_spray_measure(&s, &m);
    mpm_spray_free(&s);
    return 0;
}
