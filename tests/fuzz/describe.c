/* Every description of a world: grid, contact, bodies, clouds, material, bond, pull. What is accepted runs; what is
   not is refused by name. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "scene.h"

static int inside(void *context, const mpm_real x[3])
{
    (void)context;
    return x[0] + x[2] > 0;
}

static void change_contact(fuzz *f, mpm_contact *c)
{
    FUZZ_CHOICE(f, c->law);
    FUZZ_CHOICE(f, c->normal);
    FUZZ_REAL(f, c->friction);
    FUZZ_REAL(f, c->cutoff);
    FUZZ_CHOICE(f, c->touch);
}

static void change_desc(fuzz *f, mpm_desc *d)
{
    int a;
    FUZZ_CHOICE(f, d->mark);
    FUZZ_CHOICE(f, d->geometry);
    FUZZ_CHOICE(f, d->basis);
    FUZZ_CHOICE(f, d->scheme);
    fuzz_reals(f, d->origin, 3);
    FUZZ_REAL(f, d->cell);
    for (a = 0; a < 3; a++) d->cells[a] = fuzz_int(f, d->cells[a]);
    for (a = 0; a < 6; a++) FUZZ_CHOICE(f, d->side[a]);
    FUZZ_REAL(f, d->wall_friction);
    change_contact(f, &d->contact);
    fuzz_reals(f, d->gravity, 3);
    FUZZ_REAL(f, d->mass_cutoff);
    FUZZ_REAL(f, d->calm);
    d->points = fuzz_int(f, d->points);
    d->bodies = fuzz_int(f, d->bodies);
    d->rules = fuzz_int(f, d->rules);
    d->nodes = fuzz_int(f, d->nodes);
    FUZZ_CHOICE(f, d->user_fields);
}

static void change_body(fuzz *f, mpm_body_desc *b)
{
    FUZZ_CHOICE(f, b->mark);
    FUZZ_CHOICE(f, b->shape.kind);
    fuzz_reals(f, b->shape.center, 3);
    fuzz_reals(f, b->shape.half, 3);
    b->shape.inside = inside;
    FUZZ_REAL(f, b->spacing);
    FUZZ_REAL(f, b->density);
    fuzz_reals(f, b->velocity, 3);
    FUZZ_REAL(f, b->temperature);
    FUZZ_REAL(f, b->wave_p);
    FUZZ_REAL(f, b->wave_s);
    FUZZ_CHOICE(f, b->absorb);
    FUZZ_REAL(f, b->absorb_normal);
    FUZZ_REAL(f, b->absorb_shear);
    FUZZ_REAL(f, b->absorb_spring);
    FUZZ_REAL(f, b->shell);
    b->id = fuzz_int(f, b->id);
}

static void change_bond(fuzz *f, mpm_bond *b)
{
    FUZZ_CHOICE(f, b->mark);
    FUZZ_CHOICE(f, b->rule);
    FUZZ_CHOICE(f, b->average);
    FUZZ_REAL(f, b->critical);
    FUZZ_REAL(f, b->critical_rate);
    FUZZ_REAL(f, b->length);
    FUZZ_REAL(f, b->floor);
    FUZZ_REAL(f, b->width);
    FUZZ_REAL(f, b->strength);
    FUZZ_CHOICE(f, b->partner);
}

/* A few points as a body of their own, and as more of the first. */
static void clouds(fuzz *f, scene *s)
{
    mpm_real x[3][4], v[3][4], mass[4], volume[4];
    uint8_t flags[4];
    mpm_cloud c;
    int a, i;
    memset(&c, 0, sizeof c);
    for (i = 0; i < 4; i++) {
        for (a = 0; a < 3; a++) {
            x[a][i] = MPM_R(4.5) + (mpm_real)(i + a) / 8;
            v[a][i] = 0;
            FUZZ_REAL(f, x[a][i]);
            FUZZ_REAL(f, v[a][i]);
        }
        mass[i] = volume[i] = MPM_R(0.1);
        FUZZ_REAL(f, mass[i]);
        FUZZ_REAL(f, volume[i]);
        flags[i] = (uint8_t)fuzz_byte(f);
    }
    for (a = 0; a < 3; a++) {
        c.x[a] = fuzz_byte(f) < 240 ? x[a] : NULL;
        c.v[a] = fuzz_byte(f) < 128 ? v[a] : NULL;
    }
    c.count = fuzz_byte(f) % 5;
    if (fuzz_byte(f) < 128) c.mass = mass;
    if (fuzz_byte(f) < 128) c.volume = volume;
    if (fuzz_byte(f) < 128) c.flags = flags;
    mpm_body_add_points(&s->world, &s->ball, &c);
    mpm_points_add(&s->world, fuzz_int(f, 0), &c);
    mpm_point_take(&s->world, fuzz_int(f, 1));
}

static void rules(fuzz *f, scene *s)
{
    int i;
    for (i = 0; i < 2; i++) {
        mpm_contact c = s->desc.contact;
        const int32_t a = fuzz_int(f, 0), b = fuzz_int(f, 1);
        change_contact(f, &c);
        mpm_contact_set(&s->world, a, b, &c);
    }
    s->bond.partner = mpm_field_take(&s->world, "partner");
    change_bond(f, &s->bond);
}

static int pulls(fuzz *f, scene *s, mpm_pull *p)
{
    mpm_pull_desc d = mpm_pull_desc_default();
    d.lower = 1;
    d.above = 2;
    d.below = -1;
    d.axes = 7;
    d.velocity = 100;
    d.sample = MPM_R(1e-3);
    d.area = 1;
    d.upper = fuzz_int(f, d.upper);
    d.lower = fuzz_int(f, d.lower);
    FUZZ_REAL(f, d.above);
    FUZZ_REAL(f, d.below);
    FUZZ_CHOICE(f, d.axes);
    FUZZ_REAL(f, d.velocity);
    FUZZ_REAL(f, d.ramp);
    FUZZ_REAL(f, d.sample);
    d.area = fuzz_double(f, d.area);
    return mpm_pull_begin(p, &s->world, &d, NULL) == MPM_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    scene s;
    mpm_pull pull;
    mpm_real dt;
    int i, pulled, bonds;
    scene_describe(&s);
    change_desc(&f, &s.desc);
    if (mpm_init(&s.world, &s.desc, NULL, 0) < 0) {
        FUZZ_WANT(s.world.fault.field && s.world.fault.status < 0);
        mpm_free(&s.world);
        return 0;
    }
    FUZZ_WANT(mpm_bytes(&s.desc) > 0);
    change_body(&f, &s.ball);
    change_body(&f, &s.plate);
    mpm_body_add(&s.world, &s.ball);
    mpm_body_add(&s.world, &s.plate);
    rules(&f, &s);
    clouds(&f, &s);
    bonds = mpm_bond_check(&s.bond, NULL) == MPM_OK;
    pulled = pulls(&f, &s, &pull);
    dt = mpm_time_step(&s.world, MPM_R(0.2));
    FUZZ_REAL(&f, dt);
    for (i = 0; i < 3; i++) {
        const mpm_real before = s.world.time;
        mpm_status status = MPM_OK;
        if (pulled) {
            if ((status = mpm_locate(&s.world, dt)) < 0) break;
            mpm_calm(&s.world);
            mpm_p2g(&s.world);
            mpm_forces(&s.world);
            mpm_grid_update(&s.world);
            mpm_contact_find(&s.world);
            mpm_contact_apply(&s.world);
            mpm_pull_apply(&pull, &s.world);
            mpm_g2p(&s.world);
            mpm_musl(&s.world);
            if (mpm_stress(&s.world) < 0) break;
            mpm_move(&s.world);
        } else if ((status = bonds ? mpm_bond_step(&s.bond, &s.world, dt) : mpm_step(&s.world, dt)) < 0) {
            FUZZ_WANT(s.world.fault.status < 0 && s.world.fault.field);
            break;
        }
        FUZZ_WANT(!(s.world.time < before));
    }
    scene_measure(&s, 1);
    mpm_free(&s.world);
    return 0;
}
