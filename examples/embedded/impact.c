/* impact - a cold spray impact on a microcontroller: float, a static array for memory, no malloc, no files, one hook
   for text (board.h). An aluminium ball of 14 um hits aluminium at 810 m/s and stays; rings about its axis, 1268
   points. `make embedded` builds it for a Cortex-M4 with 128 KiB of flash and 256 KiB of RAM and for the machine at
   hand, runs both, the first under qemu-system-arm, and holds one to the other: their numbers are the same to 1e-4.
   What makes it small: MPM_FLOAT (memory), MPM_BLOCK 8 (stack), MPM_NO_INLINE, MPM_STATIC and -Os (code), a
   description whose points are counted before memory is asked for, and structs that are static, not on the stack.
   Expected: 68 KiB of flash, a stack of 6 KiB, 20 % of the ball's surface bonded. Units um, us, ng: velocity in m/s,
   energy in pJ. SPDX-License-Identifier: MIT */
#define MPM_MALLOC(n) ((void)(n), (void *)0) /* there is none: whoever asks for memory is told so */
#define MPM_FREE(p) ((void)(p))
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"
#include "mpm_bond.h"

#include "board.h"

static union {
    double aligned; /* as mpm_init wants it */
    char byte[222 * 1024];
} memory;

static mpm_world world; /* these too would take much of a small stack */
static mpm_material al;
static mpm_body_desc ball, slab;
static mpm_totals all, one;

/* A line with a name and a number to nine digits, without printf: -1.23456789e-02. */
static void say(const char *name, double value)
{
    char text[24];
    int n = 0, exponent = 0, digit;
    double rest = value < 0 ? -value : value;
    board_put(name);
    if (value < 0) text[n++] = '-';
    for (; rest >= 10; exponent++) rest /= 10;
    for (; rest > 0 && rest < 1; exponent--) rest *= 10;
    for (digit = 0; digit < 9; digit++) {
        const int now = (int)rest;
        text[n++] = (char)('0' + now);
        if (digit == 0) text[n++] = '.';
        rest = 10 * (rest - now);
    }
    text[n++] = 'e';
    text[n++] = exponent < 0 ? '-' : '+';
    if (exponent < 0) exponent = -exponent;
    text[n++] = (char)('0' + exponent / 10 % 10);
    text[n++] = (char)('0' + exponent % 10);
    text[n++] = '\n';
    text[n] = 0;
    board_put(text);
}

/* What went wrong, and 1 for main to return. */
static int fails(const mpm_fault *f)
{
    board_put(mpm_status_text(f->status));
    board_put(": ");
    board_put(f->field);
    say(" ", (double)f->value);
    return 1;
}

static mpm_body_desc body(mpm_shape shape, mpm_real velocity)
{
    mpm_body_desc b = mpm_body_desc_default();
    b.shape = shape;
    b.spacing = MPM_R(0.5);
    b.density = al.density;
    b.velocity[2] = velocity;
    b.stress = mpm_material_stress;
    b.material = &al;
    mpm_material_wave_speeds(&al, al.density, &b.wave_p, &b.wave_s);
    return b;
}

/* Grid, memory, bodies; 1 or 0. */
static int begin(const mpm_units *units, mpm_fault *fault)
{
    mpm_desc d = mpm_desc_default();
    if (mpm_material_preset(&al, "al", units, fault) < 0) return 0;
    ball = body(mpm_sphere(0, 0, 7, 7), -810);
    slab = body(mpm_cylinder(0, 0, -12, 20, 12), 0);
    slab.absorb = MPM_FACE_BOTTOM | MPM_FACE_RIM;
    d.geometry = MPM_AXISYMMETRIC;
    d.cell = 1;
    d.cells[0] = 22;
    d.cells[2] = 30;
    d.origin[2] = -14;
    d.side[0] = MPM_SIDE_SYMMETRY;
    d.bodies = 2;
    d.points = mpm_shape_count(&d, &ball.shape, ball.spacing) + mpm_shape_count(&d, &slab.shape, slab.spacing);
    d.nodes = 480;
    say("# bytes needed    ", (double)mpm_bytes(&d)); /* known before any is taken; pointers count in it */
    if (mpm_init(&world, &d, memory.byte, sizeof memory) >= 0 && mpm_body_add(&world, &ball) >= 0 &&
        mpm_body_add(&world, &slab) >= 0)
        return 1;
    *fault = world.fault;
    return 0;
}

static void report(void)
{
    all = mpm_body_totals(&world, -1);
    one = mpm_body_totals(&world, 0);
    say("points            ", (double)all.points);
    say("steps             ", (double)world.steps);
    say("velocity lost     ", one.momentum[2] / one.mass + 810);
    say("height            ", one.high[2] - one.low[2]);
    say("plastic strain    ", one.plastic_strain_mean);
    say("temperature       ", one.temperature_max);
    say("kinetic           ", all.kinetic);
    say("internal          ", all.internal);
    say("absorbed          ", world.ledger.absorbed);
    say("bonded, per cent  ", mpm_bond_measure_body(&world, 0).pbcp);
    board_end();
}

int main(void)
{
    const mpm_units units = mpm_units_um_us_ng();
    const mpm_bond bond = mpm_bond_default(&units);
    mpm_fault fault;
    mpm_real dt;
    if (!begin(&units, &fault)) return fails(&fault);
    dt = mpm_time_step(&world, MPM_R(0.2));
    while (world.time < MPM_R(0.04))
        if (mpm_bond_step(&bond, &world, dt) < 0) return fails(&world.fault);
    report();
    return 0;
}
