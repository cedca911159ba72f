/* 32_pull - two bonded cubes are drawn apart: force against E eps A, the yield stress, nothing without a
   bond; the ledger of the grips; refusals; examples/pull. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "check.h"
#include "files.h"


static const double young = 70000; /* MPa */

/* A cube of 4 um on another, both of one simple material; D of all their surface points is `bond`. */
static mpm_world cubes(mpm_material *m, double bond)
{
    mpm_desc d = scene_grid(1, 8, 8, 12, -4, -4, -6);
    mpm_body_desc upper, lower;
    mpm_world w;
    int32_t i;
    *m = mpm_material_default();
    m->density = MPM_R(2.7);
    m->young = (mpm_real)young;
    m->poisson = 0; /* the grips do not hinder contraction */
    m->shear_modulus = (mpm_real)(young / 2);
    m->heat_fraction = 0;
    upper = scene_body(m, mpm_box(-2, -2, 0, 2, 2, 4), 0.5, 0);
    lower = scene_body(m, mpm_box(-2, -2, -4, 2, 2, 0), 0.5, 0);
    mpm_init(&w, &d, NULL, 0);
    mpm_body_add(&w, &upper);
    mpm_body_add(&w, &lower);
    for (i = 0; i < w.points.count; i++) w.points.bond[i] = (mpm_real)bond;
    return w;
}

/* Grips within one cell of the ends: the planes z = 3 and z = -3 and beyond, 6 um between them. */
static mpm_pull_desc pulling(double velocity)
{
    mpm_pull_desc d = mpm_pull_desc_default();
    d.above = MPM_R(2.5);
    d.below = MPM_R(-2.5);
    d.axes = 4;
    d.velocity = (mpm_real)velocity;
    d.ramp = MPM_R(0.05);
    d.sample = MPM_R(0.005);
    d.area = 16;
    return d;
}

/* A step of the pull; the bond stays as it is, and they bear `more` beside it. Returns 0, or -1 on failure. */
static int step(mpm_pull *p, mpm_world *w, const mpm_bond *b, mpm_real dt, double more)
{
    if (mpm_locate(w, dt) < 0) return -1;
    mpm_p2g(w);
    mpm_forces(w);
    mpm_grid_update(w);
    mpm_contact_find(w);
    mpm_bond_nodes(b, w);
    mpm_contact_apply(w);
    mpm_pull_tension(p, w, more);
    mpm_pull_apply(p, w);
    mpm_g2p(w);
    mpm_musl(w);
    if (mpm_stress(w) < 0) return -1;
    mpm_move(w);
    return 0;
}

/* Draws for a number of samples of 5 ns, and returns how it ended. */
static mpm_pull draw(mpm_world *w, double velocity, long samples, double more, int *ok)
{
    const mpm_units u = mpm_units_um_us_ng();
    const mpm_bond b = mpm_bond_default(&u);
    const mpm_pull_desc d = pulling(velocity);
    const mpm_real dt = mpm_time_step(w, MPM_R(0.2));
    mpm_pull p;
    *ok = mpm_pull_begin(&p, w, &d, NULL) == MPM_OK;
    while (*ok && p.samples < samples)
        if (step(&p, w, &b, dt, more) < 0) *ok = 0;
    return p;
}

/* Slowly enough that inertia takes 1 % of the force. Poisson's number is 0, so that the grips do not
   hinder contraction and the answer is exact. */
static void elastic(void)
{
    mpm_material m;
    mpm_world w = cubes(&m, 1);
    mpm_totals t;
    mpm_pull p;
    double strain, stored;
    int ok;
    p = draw(&w, 0.1, 40, 0, &ok);
    CHECK_TRUE("two bonded elastic cubes", ok);
    strain = (p.separation - 0.5 * 0.1 * 0.005) / 6; /* in the middle of the last sample */
    CHECK_RELATIVE("tension between the bodies is E eps A", p.force, young * strain * 16, 0.02);
    CHECK_RELATIVE("its stress is nominal", p.peak_stress, p.peak_force / 16, 1e-12);
    t = mpm_body_totals(&w, -1);
    stored = 0.5 * young / 6 * 16 * p.separation * p.separation;
    CHECK_RELATIVE("work: half the force times the way, and motion", p.work, stored + t.kinetic, 0.02);
    CHECK_RELATIVE("the ledger knows it", -w.ledger.walls, p.work, 0.01);
    CHECK_RELATIVE("... and closes", t.kinetic + t.internal + w.ledger.contact + w.ledger.hold, -w.ledger.walls, 0.01);
    CHECK_NEAR("momentum comes from the grips", t.momentum[2], w.ledger.impulse[2],
               1e4 * (double)MPM_EPSILON * fabs(p.force) * p.time);
    CHECK_EQUAL("the grip holds two planes", p.grip[0].nodes, 50);
    CHECK_RELATIVE("... and goes along", p.grip[0].low, 2.5 + p.separation, 1e4 * (double)MPM_EPSILON);
    mpm_free(&w);
}

/* Grips hinder plastic contraction, which raises the stress by a few percent, never lowers it. */
static void yields(void)
{
    mpm_material m;
    mpm_world w = cubes(&m, 1);
    mpm_pull p;
    int ok;
    m.strength = MPM_STRENGTH_LINEAR;
    m.linear_yield = 150;
    p = draw(&w, 0.25, 40, 0, &ok);
    CHECK_TRUE("two bonded cubes that yield at 150 MPa", ok);
    CHECK_NEAR("bear the yield stress at most", p.peak_stress, 157, 7);
    CHECK_NEAR("... and keep bearing it", p.force / 16, 157, 7);
    CHECK_TRUE("... reached at the yield strain", p.peak_separation > 6 * 150 / young);
    mpm_free(&w);
}

static void unbonded(void)
{
    mpm_material m;
    mpm_world w = cubes(&m, 0.99);
    mpm_pull p;
    mpm_totals upper, lower;
    int ok;
    p = draw(&w, 0.1, 40, 0, &ok);
    CHECK_TRUE("two cubes that have nearly bonded", ok);
    upper = mpm_body_totals(&w, 0);
    lower = mpm_body_totals(&w, 1);
    CHECK_NEAR("bear nothing", p.peak_stress, 0, 1e-6 * young);
    CHECK_NEAR("the upper one goes along", upper.low[2] - 0.25, p.separation, 0.05 * p.separation);
    CHECK_NEAR("the lower one stays", lower.high[2] + 0.25, 0, 1e-3 * p.separation);
    mpm_free(&w);
    w = cubes(&m, 0.99);
    p = draw(&w, 0.1, 5, 48, &ok);
    CHECK_RELATIVE("... but what is told of besides", p.force, 48, 1e4 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... as a stress", p.peak_stress, 3, 1e4 * (double)MPM_EPSILON);
    mpm_free(&w);
}

/* A grip alone, through both cubes: it takes the nodes of its body only, in its directions only. */
static void grip(void)
{
    mpm_material m;
    mpm_world w = cubes(&m, 0);
    const mpm_real dt = MPM_R(1e-5);
    mpm_grip g;
    memset(&g, 0, sizeof g);
    g.body = 1;
    g.low = MPM_R(-9.0);
    g.high = MPM_R(-0.5);
    g.velocity[0] = 5;
    g.velocity[2] = 2;
    g.axes = 4;
    mpm_locate(&w, dt);
    mpm_p2g(&w);
    mpm_grip_apply(&g, &w);
    CHECK_EQUAL("below the interface: four planes of 25 nodes", g.nodes, 100);
    CHECK_RELATIVE("momentum of 3.5 layers of 16 um2", g.impulse[2], 2 * 2.7 * 16 * 3.5, 1e3 * (double)MPM_EPSILON);
    CHECK_NEAR("nothing across", g.impulse[0], 0, 0);
    g.high = 9;
    g.axes = 1;
    mpm_grip_apply(&g, &w);
    CHECK_EQUAL("through both: its body's planes", g.nodes, 125);
    CHECK_RELATIVE("... the whole body", g.impulse[0], 5 * 2.7 * 64, 1e3 * (double)MPM_EPSILON);
    mpm_free(&w);
}

static void refusals(void)
{
    mpm_material m;
    mpm_world w = cubes(&m, 1);
    mpm_pull_desc d = pulling(1);
    mpm_fault f;
    mpm_pull p;
    CHECK_EQUAL("a pull", mpm_pull_begin(&p, &w, &d, &f), MPM_OK);
    CHECK_NEAR("grips between planes", p.grip[0].low, 2.5, 1e-6);
    d.mark = 0;
    CHECK_EQUAL("a description made by hand", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", strstr(f.field, "mpm_pull_desc_default") != NULL);
    d = mpm_pull_desc_default();
    CHECK_EQUAL("one that is not filled in", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named by its field", !strcmp(f.field, "pull above"));
    CHECK_EQUAL("body 0 off body 1", d.upper + 10 * d.lower, 10);
    CHECK_EQUAL("... in all directions", d.axes, 7);
    d = pulling(1);
    d.upper = 1;
    CHECK_EQUAL("a body from itself", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_ARGUMENT);
    d = pulling(1);
    d.above = -3;
    CHECK_EQUAL("grips that overlap", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_ARGUMENT);
    d = pulling(0);
    CHECK_EQUAL("no velocity", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_ARGUMENT);
    d = pulling(1);
    d.area = NAN;
    CHECK_EQUAL("an area that is no number", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_NAN);
    CHECK_TRUE("... is named", !strcmp(f.field, "pull area"));
    d = pulling(1);
    d.sample = 0;
    CHECK_EQUAL("no time to average over", mpm_pull_begin(&p, &w, &d, &f), MPM_ERR_ARGUMENT);
    mpm_free(&w);
}

static int pull(const char *options)
{
    char command[300];
    snprintf(command, sizeof command,
             "build/pull --cell 1.5 --spacing 0.5 --out build/tests/pull %s >build/tests/pull.out 2>&1", options);
    return system(command);
}

/* A short coarse impact is drawn at; the same without a bond lets go. */
static void example(void)
{
    const char *summary = "build/tests/pull/summary.json";
    double stress, force, area;
    CHECK_EQUAL("examples/pull", pull("--time 60 --distance 0.4 --dt-factor 0.2"), 0);
    stress = number_in(summary, "strength_MPa");
    force = number_in(summary, "peak_force_uN");
    area = number_in(summary, "contact_area_um2");
    CHECK_TRUE("bears a metal's stress", stress > 50 && stress < 2000);
    CHECK_RELATIVE("... force over area", force / area, stress, 1e-9);
    CHECK_TRUE("... a contact of the particle's size", area > 50 && area < 400);
    CHECK_EQUAL("without bond", pull("--time 80 --distance 0.4 --dt-factor 0.2 --bond none"), 0);
    CHECK_NEAR("... nothing", number_in(summary, "strength_MPa"), 0, 0);
    CHECK_EQUAL("on surfaces", pull("--method surface --adhesion-critical 1000 --pull-velocity 10 --sample 2"), 0);
    stress = number_in(summary, "strength_MPa");
    area = number_in(summary, "bonded_node_area_um2") / number_in(summary, "contact_area_um2");
    CHECK_TRUE("... adhesion bears something", stress > 5);
    CHECK_TRUE("... on a part of what touched", area > 0.1 && area < 1);
    CHECK_TRUE("... and lets go when it is drawn open", number_in(summary, "end_way_um") < 1);
    CHECK_NEAR("... all of it", number_in(summary, "end_stress_MPa") / stress, 0, 0.05);
    force = number_in(summary, "work_pJ") / (number_in(summary, "peak_force_uN") * 0.2);
    CHECK_TRUE("... at the cost of its force over its reach, about", force > 0.4 && force < 1.4);
    CHECK_TRUE("no cap to grip", pull("--time 1 --grip -1") != 0);
    CHECK_TRUE("... is named", strstr(text_of("build/tests/pull.out"), "--grip -1") != NULL);
    CHECK_TRUE("no sample", pull("--time 1 --sample 0") != 0);
    CHECK_TRUE("more samples than there is room for", pull("--time 1 --ramp 1e8") != 0);
    CHECK_TRUE("a grip over the whole pile", pull("--time 1 --grip 100") != 0);
    CHECK_TRUE("... is named as given", strstr(text_of("build/tests/pull.out"), "--grip 100,") != NULL);
}

/* Pull into a folder, quietly; the exit status. */
static int pull_to(const char *folder, const char *options)
{
    char command[500];
    snprintf(command, sizeof command, "build/pull --cell 1.5 --spacing 0.75 --quiet --out build/tests/%s %s "
             ">build/tests/pull.out 2>&1", folder, options);
    return system(command);
}

static int same_files(const char *a, const char *b)
{
    char command[300];
    snprintf(command, sizeof command, "diff -r -I '\"out\"' build/tests/%s build/tests/%s >build/tests/pull.out", a, b);
    return system(command) == 0;
}

/* Stopped in the impact and in the pull: what comes out is the same, byte by byte. */
static void stopped(const char *method)
{
    char whole[200], parts[300];
    int steps;
    snprintf(whole, sizeof whole, "--dt-factor 0.2 --distance 0.3 --sample 2 %s", method);
    CHECK_TRUE(method, system("rm -rf build/tests/pull_whole build/tests/pull_parts") == 0);
    CHECK_EQUAL("... from start to end", pull_to("pull_whole", whole), 0);
    snprintf(parts, sizeof parts, "%s --stop-after 300", whole);
    CHECK_TRUE("stopped in the impact", pull_to("pull_parts", parts) != 0);
    CHECK_TRUE("... says how it goes on", strstr(text_of("build/tests/pull.out"), "stopped at step 300 of ") != NULL);
    snprintf(parts, sizeof parts, "%s --resume --distance 0.2", whole);
    CHECK_TRUE("... not with another way of the grip", pull_to("pull_parts", parts) != 0);
    CHECK_TRUE("... which is named", strstr(text_of("build/tests/pull.out"), "distance") != NULL);
    steps = (int)number_in("build/tests/pull_whole/summary.json", "steps"); /* stop 100 before the end */
    snprintf(parts, sizeof parts, "%s --resume --stop-after %d", whole, steps - 400);
    CHECK_TRUE("stopped in the pull", pull_to("pull_parts", parts) != 0);
    CHECK_TRUE("... which had begun", number_in("build/tests/pull_parts/summary.json", "end_way_um") > 0);
    snprintf(parts, sizeof parts, "%s --resume", whole);
    CHECK_EQUAL("... it goes on to its end", pull_to("pull_parts", parts), 0);
    CHECK_TRUE("... and leaves the same files", same_files("pull_whole", "pull_parts"));
    CHECK_TRUE("... without a checkpoint that is left to go on from", pull_to("pull_parts", parts) != 0);
}

int main(void)
{
    example();
    stopped("--time 40");
    stopped("--method surface --adhesion-critical 1000 --time 40");
    elastic();
    yields();
    unbonded();
    grip();
    refusals();
    return check_end();
}
