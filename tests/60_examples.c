/* 60_examples - the programs as a person runs them: a short impact, quarter against full, oblique,
   hot, of two metals, of an ellipsoid; the scene they share (impact_case.h); and bad input, which must
   fail with a message and leave no summary behind. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_case.h"
#include "check.h"
#include "files.h"

static int run(const char *options)
{
    char command[500];
    snprintf(command, sizeof command,
             "build/impact --quiet --frames 0 %s >build/tests/impact.out 2>build/tests/impact.err", options);
    return system(command);
}

static void refused(const char *options, const char *value)
{
    char line[200], text[500];
    snprintf(line, sizeof line, "refused: impact %s", options);
    remove("build/tests/bad/summary.json");
    snprintf(text, sizeof text, "%s --out build/tests/bad", options);
    CHECK_TRUE(line, run(text) != 0);
    CHECK_TRUE("... with a message naming the value", strstr(text_of("build/tests/impact.err"), value) != NULL);
    CHECK_TRUE("... and no summary", isnan(number_in("build/tests/bad/summary.json", "steps")));
}

/* A coarse short impact with further options, into build/tests/NAME; returns its summary. */
static const char *coarse(const char *name, const char *options)
{
    static char path[2][80];
    static int turn;
    char line[300];
    snprintf(line, sizeof line, "--time 1 --spacing 0.75 --out build/tests/%s %s", name, options);
    CHECK_EQUAL(line, run(line), 0);
    turn = !turn;
    snprintf(path[turn], sizeof path[turn], "build/tests/%s/summary.json", name);
    return path[turn];
}

/* Contact on surfaces, a half space: pictures, outlines for ParaView, energy; what does not go together is refused. */
static void surfaces(void)
{
    const char *path = "build/tests/surface/summary.json";
    const char *at = "build/tests/surface/surface.pvd";
    static const char *const fields[] = {"contact pressure (MPa)", "gap (um)", "interface dissipation (J/m2)",
                                         "adhesion (J/m2)", "opening (um)", "traction of adhesion (MPa)"};
    int frames = 0, k;
    CHECK_EQUAL("contact on surfaces, shortly",
                run("--time 1 --geometry axisymmetric --contact surface --bond none --frames 3 --out "
                    "build/tests/surface"), 0);
    CHECK_EQUAL("contact on surfaces",
                run("--time 12 --geometry axisymmetric --functions cubic --contact surface --bond interface --springs "
                    "--scheme consistent --gap 0.1 --dt-factor 0.3 --frames 2 --out build/tests/surface"), 0);
    CHECK_NEAR("... energy unaccounted", number_in(path, "energy_unaccounted"), 0, 0.005);
    CHECK_NEAR("... momentum error", number_in(path, "momentum_error"), 0, 1e-12);
    CHECK_TRUE("... area that touched", number_in(path, "contact_area_um2") > 20);
    CHECK_TRUE("... dissipation of the interface", number_in(path, "interface_dissipation_J_m2") > 300);
    CHECK_TRUE("... series of outlines",
               strstr(text_of("build/tests/surface/surface.pvd"), "surface_0001.vtu") != NULL);
    for (at = text_of(at); (at = strstr(at, "<DataSet ")) != NULL; at++) frames++;
    CHECK_EQUAL("... begun anew", frames, 2);
    for (k = 0; k < 6; k++)
        CHECK_TRUE(fields[k], strstr(text_of("build/tests/surface/surface_0001.vtu"), fields[k]) != NULL);
    CHECK_EQUAL("... in three dimensions",
                run("--time 0.5 --functions cubic --contact surface --bond interface --springs --cell 2 --spacing 1 "
                    "--frames 2 --substrate-diameter 20 --substrate-height 10 --out build/tests/surface"), 0);
    CHECK_TRUE("... its surface in ParaView", strstr(text_of("build/tests/surface/surface_0001.vtu"),
                                                     "Name=\"adhesion (J/m2)\"") != NULL);
    CHECK_EQUAL("the method of surfaces: sizes by the diameter",
                run("--method surface --diameter 28 --time 0.2 --frames 0 --out build/tests/surface"), 0);
    CHECK_NEAR("... 28 cells in it", number_in(path, "cell"), 1, 1e-12);
    CHECK_NEAR("... a substrate of 2.5 diameters", number_in(path, "substrate-diameter"), 70, 1e-12);
    CHECK_NEAR("... what is given stays", number_in(path, "time"), 0.2, 1e-12);
    CHECK_TRUE("... cubic splines", strstr(text_of(path), "\"functions\": \"cubic\"") != NULL);
    refused("--contact surface", "--bond interface");
    refused("--bond interface", "--contact surface");
    refused("--contact surface --geometry axisymmetric --bond interface --adhesion-reach 0", "0");
    refused("--contact faces", "faces");
    refused("--surface-damping -1", "-1");
    refused("--checkpoint -1", "checkpoint -1");
    refused("--stop-after -3", "stop-after -3");
}

/* The staged return books what it takes from the motion, as the consistent one does. */
static void staged(void)
{
    const char *keys[] = {"energy_kinetic_fraction", "energy_plastic_fraction", "energy_elastic_fraction",
                          "energy_absorbed_fraction", "energy_contact_fraction"};
    const char *other = "--time 30 --geometry axisymmetric --bond none --out build/tests/consistent";
    const char *one = "build/tests/staged/summary.json", *two = "build/tests/consistent/summary.json";
    int i;
    CHECK_EQUAL("staged", run("--time 30 --geometry axisymmetric --bond none --plasticity staged "
                              "--out build/tests/staged"), 0);
    CHECK_EQUAL("consistent", run(other), 0);
    for (i = 0; i < 5; i++)
        CHECK_NEAR(keys[i], number_in(one, keys[i]), number_in(two, keys[i]), 0.01);
    CHECK_NEAR("staged: energy unaccounted", number_in(one, "energy_unaccounted"), 0, 0.01);
    CHECK_RELATIVE("staged: plastic strain", number_in(one, "eps_mean"), number_in(two, "eps_mean"), 0.1);
}

/* At 30 degrees from the normal: one mirror plane, momentum conserved along x too. */
static void oblique(void)
{
    const char *half = coarse("half", "--angle 30 --symmetry half");
    const char *whole = coarse("whole", "--angle 30 --symmetry full");
    const char *keys[] = {"v_rest_mean_m_s", "v_tangential_m_s", "eps_mean", "contact_area_um2", "crater_depth_um"};
    int i;
    CHECK_EQUAL("half: points", number_in(half, "points") * 2, number_in(whole, "points"));
    for (i = 0; i < 5; i++) CHECK_RELATIVE(keys[i], number_in(half, keys[i]), number_in(whole, keys[i]), 1e-9);
    CHECK_NEAR("momentum error, all axes", number_in(half, "momentum_error"), 0, 1e-12);
    CHECK_NEAR("without friction the particle keeps its tangential velocity", number_in(half, "v_tangential_m_s"),
               405, 0.001 * 405);
    CHECK_RELATIVE("the other way round", number_in(coarse("left", "--angle -30 --symmetry half"), "v_tangential_m_s"),
                   -number_in("build/tests/half/summary.json", "v_tangential_m_s"), 1e-9);
    half = coarse("rough", "--angle 30 --symmetry half --friction 0.5");
    CHECK_TRUE("friction slows it", number_in(half, "v_tangential_m_s") <
                                        number_in("build/tests/whole/summary.json", "v_tangential_m_s") - 1);
    CHECK_NEAR("and hands its momentum on", number_in(half, "momentum_error"), 0, 1e-12);
}

/* Two metals: each body is of its own, the faster wave sets the step; heat softens. */
static void metals(void)
{
    const char *cu, *al, *hot;
    al = coarse("al", "");
    cu = coarse("al_on_cu", "--substrate-material cu");
    CHECK_TRUE("the denser substrate yields less", number_in(cu, "crater_depth_um") < number_in(al, "crater_depth_um"));
    CHECK_NEAR("momentum error of two metals", number_in(cu, "momentum_error"), 0, 1e-12);
    CHECK_NEAR("energy of two metals", number_in(cu, "energy_unaccounted"), 0, 0.03);
    CHECK_RELATIVE("dt follows the faster wave", number_in(cu, "dt_ns"), number_in(al, "dt_ns"), 1e-12);
    cu = coarse("cu_on_al", "--material cu --substrate-material al");
    al = "build/tests/al/summary.json";
    CHECK_RELATIVE("... whichever body it is in", number_in(cu, "dt_ns"), number_in(al, "dt_ns"), 1e-12);
    hot = coarse("hot", "--temperature 600 --substrate-temperature 298");
    CHECK_TRUE("a hot particle is hot", number_in(hot, "temperature_max_K") > 600);
    CHECK_TRUE("... flattens more", number_in(hot, "flattening") > number_in(al, "flattening"));
    CHECK_TRUE("... and leaves a shallower crater in a cold substrate",
               number_in(hot, "crater_depth_um") < number_in(al, "crater_depth_um"));
    al = coarse("strain", "--bond strain --eps-c 0.5 --bond-average weighted --shell 2 --model ptw");
    CHECK_TRUE("the strain bond grows", number_in(al, "abp") > 0);
}

/* Whether two files hold the same bytes, up to where a summary tells of the run's speed. */
static int same_file(const char *folder, const char *other, const char *name)
{
    char path[2][120];
    size_t n[2];
    unsigned char *file[2];
    const char *end;
    int k, good;
    snprintf(path[0], sizeof path[0], "build/tests/%s/%s", folder, name);
    snprintf(path[1], sizeof path[1], "build/tests/%s/%s", other, name);
    for (k = 0; k < 2; k++) file[k] = slurp(path[k], &n[k]);
    end = file[0] ? strstr((char *)file[0], "\"cpu_seconds\"") : NULL;
    if (end) n[0] = n[1] = (size_t)(end - (char *)file[0]);
    good = file[0] && file[1] && n[0] > 0 && n[0] == n[1] && !memcmp(file[0], file[1], n[0]);
    for (k = 0; k < 2; k++) free(file[k]);
    return good;
}

/* A run that was stopped and goes on leaves the files of one that was not: at nodes, on surfaces in rings and in three
   dimensions. */
static void restarts(void)
{
    static const char *const how[] = {"--spacing 0.75 --time 2", "--method surface --cell 1.4 --spacing 0.7 --time 12 "
                                      "--adhesion-critical 100",
                                      "--method surface --geometry 3d --cell 2 --spacing 1 --time 6 --margin 0.5 "
                                      "--substrate-diameter 24 --substrate-height 8 --adhesion-critical 100"};
    static const char *const file[] = {"summary.json", "impact.pvd", "points_0001.vtu", "points_0002.vtu",
                                       "history.csv", "history.png", "film.png", "surface.pvd", "surface_0002.vtu"};
    char line[400];
    int k, i;
    for (k = 0; k < 3; k++) {
        CHECK_EQUAL("an empty folder", system("rm -rf build/tests/whole build/tests/parts"), 0);
        snprintf(line, sizeof line, "%s --frames 3 --out build/tests/whole", how[k]);
        CHECK_EQUAL(how[k], run(line), 0);
        snprintf(line, sizeof line, "%s --frames 3 --stop-after 47 --checkpoint 1e-3 --out build/tests/parts", how[k]);
        CHECK_TRUE("... stopped", run(line) != 0 && strstr(text_of("build/tests/impact.out"), "goes on with:"));
        snprintf(line, sizeof line, "%s --frames 3 --velocity 811 --resume --out build/tests/parts", how[k]);
        CHECK_TRUE("... goes on with its own options alone", run(line) != 0);
        CHECK_TRUE("... which it says", strstr(text_of("build/tests/impact.err"), "velocity 811") != NULL);
        snprintf(line, sizeof line, "%s --frames 3 --resume --out build/tests/parts", how[k]);
        CHECK_EQUAL("... goes on", run(line), 0);
        for (i = 0; i < (k ? 9 : 7); i++) CHECK_TRUE(file[i], same_file("whole", "parts", file[i]));
        CHECK_TRUE("... after which the checkpoint goes", !exists("build/tests/parts/checkpoint.bin"));
    }
    CHECK_TRUE("... of a bond", number_in("build/tests/parts/summary.json", "bonded_area_um2") > 0);
    CHECK_TRUE("nothing to go on from", run("--resume --out build/tests/parts") != 0);
    CHECK_TRUE("... is said", strstr(text_of("build/tests/impact.err"), "checkpoint.bin") != NULL);
}

/* Frames: points for ParaView with all fields, their series, pictures. */
static void frames(void)
{
    const char *series = "build/tests/frame/impact.pvd";
    static const char *const field[] = {"velocity (m/s)", "stress (MPa)", "density (g/cm3)", "temperature (K)",
                                        "plastic strain", "plastic strain rate (1/us)",
                                        "plastic energy density (MPa)", "bond D", "body", "id", "surface"};
    char line[80];
    int k;
    CHECK_EQUAL("two frames", run("--time 1 --spacing 0.75 --frames 2 --out build/tests/frames"), 0);
    CHECK_TRUE("the series names both", strstr(text_of("build/tests/frames/impact.pvd"), "\"points_0000.vtu\"") &&
                                            strstr(text_of("build/tests/frames/impact.pvd"), "\"points_0001.vtu\""));
    for (k = 0; k < 11; k++) {
        snprintf(line, sizeof line, "Name=\"%s\"", field[k]);
        CHECK_TRUE(line, strstr(text_of("build/tests/frames/points_0001.vtu"), line) != NULL);
    }
    CHECK_TRUE("pictures", !strncmp(text_of("build/tests/frames/frame_0001.png") + 1, "PNG", 3) &&
                               !strncmp(text_of("build/tests/frames/impact.png") + 1, "PNG", 3));
    CHECK_TRUE("... from the start on", strstr(text_of("build/tests/frames/impact.pvd"), "timestep=\"0\"") != NULL);
    CHECK_EQUAL("one frame", run("--time 1 --spacing 0.75 --frames 1 --out build/tests/frame"), 0);
    CHECK_TRUE("the series names one",
               strstr(text_of(series), "\"points_0000.vtu\"") && !strstr(text_of(series), "\"points_0001.vtu\""));
    CHECK_TRUE("... of the end", !strstr(text_of(series), "timestep=\"0\""));
}

/* The scene without a program: volumes, areas, and a step that is the example's loop. */
static void scene(void)
{
    impact_case c = impact_case_default();
    impact_result r;
    char message[300];
    const char *al;
    double ball;
    impact s;
    c.spacing = 0.35;
    CHECK_TRUE("a sphere", impact_begin(&s, &c, message, sizeof message));
    ball = mpm_body_totals(&s.world, IMPACT_PARTICLE).mass;
    CHECK_RELATIVE("mass of a quarter", ball, 2.7e-3 * 3.14159265358979 / 24 * 14 * 14 * 14, 0.01);
    mpm_free(&s.world);
    c.shape = "ellipsoid";
    c.aspect = 0.5;
    CHECK_TRUE("an ellipsoid", impact_begin(&s, &c, message, sizeof message));
    CHECK_RELATIVE("of the same volume", mpm_body_totals(&s.world, IMPACT_PARTICLE).mass, ball, 0.01);
    CHECK_RELATIVE("half as high as wide", impact_half_height(&c) / impact_half_width(&c), 0.5, 1e-12);
    CHECK_NEAR("resting on the surface", mpm_body_totals(&s.world, IMPACT_PARTICLE).low[2], 0, 0.35);
    mpm_free(&s.world);
    al = coarse("al", "");
    c = impact_case_default();
    c.spacing = 0.75;
    c.time = 1;
    CHECK_TRUE("the scene of a run", impact_begin(&s, &c, message, sizeof message));
    while (s.world.steps < s.steps)
        if (impact_step(&s) < 0) break;
    r = impact_measure(&s, &c);
    CHECK_EQUAL("impact_step takes the example's steps", s.world.steps, number_in(al, "steps"));
    CHECK_RELATIVE("... to the same end", r.rebound.mean, number_in(al, "v_rest_mean_m_s"),
                   sizeof(mpm_real) < 8 ? 1e-4 : 1e-9);
    mpm_free(&s.world);
}

/* The program as it is built, in double: a test in float leaves this to its twin in double. */
static void programs(void)
{
    const char *q = "build/tests/quarter/summary.json", *f = "build/tests/full/summary.json";
    const char *keys[] = {"v_rest_mean_m_s", "eps_mean", "plastic_energy_density_mean_MPa", "energy_error"};
    int i;
    CHECK_EQUAL("a short impact, quarter", run("--time 2 --out build/tests/quarter"), 0);
    CHECK_EQUAL("a short impact, full", run("--time 2 --symmetry full --out build/tests/full"), 0);
    CHECK_EQUAL("points", number_in(q, "points") * 4, number_in(f, "points"));
    for (i = 0; i < 4; i++) CHECK_RELATIVE(keys[i], number_in(q, keys[i]), number_in(f, keys[i]), 1e-6);
    CHECK_RELATIVE("pbcp", number_in(q, "pbcp_percent") + 1, number_in(f, "pbcp_percent") + 1, 1e-6);
    CHECK_NEAR("mass error", number_in(q, "mass_error"), 0, 0);
    CHECK_NEAR("momentum error", number_in(q, "momentum_error"), 0, 1e-12);
    CHECK_NEAR("kinetic, plastic, elastic, absorbed, contact, bond: all of the energy",
               number_in(q, "energy_kinetic_fraction") + number_in(q, "energy_plastic_fraction") +
                   number_in(q, "energy_elastic_fraction") + number_in(q, "energy_absorbed_fraction") +
                   number_in(q, "energy_contact_fraction") + number_in(q, "energy_bond_fraction"),
               1 + number_in(q, "energy_unaccounted"), 1e-9);
    CHECK_EQUAL("a short impact, rings", run("--time 2 --geometry axisymmetric --out build/tests/rings"), 0);
    CHECK_NEAR("... momentum error along the axis", number_in("build/tests/rings/summary.json", "momentum_error"), 0,
               1e-12);
    CHECK_NEAR("energy unaccounted", number_in(q, "energy_unaccounted"), 0, 0.03);
    frames();
    surfaces();
    restarts();
    staged();
    oblique();
    metals();
    refused("--diameter -14", "-14");
    refused("--velocity nan", "nan");
    refused("--cell 0", "0");
    refused("--dt-factor 1e-300", "1e-300");
    refused("--dt-factor 5e-324", "dt-factor");
    refused("--spacing 2", "2");
    refused("--gap -3", "overlap");
    refused("--margin -0.6", "outside");
    refused("--substrate-diameter 1e5", "cell 1.5");
    refused("--material unobtainium", "unobtainium");
    refused("--substrate-material unobtainium", "unobtainium");
    refused("--angle 30", "--symmetry half");
    refused("--angle 90 --symmetry half", "90");
    refused("--angle 30 --geometry axisymmetric", "axisymmetric");
    refused("--aspect 2", "--shape ellipsoid");
    refused("--shape ellipsoid --aspect 0", "--aspect 0");
    refused("--temperature 0", "--temperature 0");
    refused("--substrate-temperature -5", "-5");
    refused("--model jc", "no published set");
    refused("--bond strain --eps-c -1", "-1");
    refused("--bond glue", "glue");
    refused("--bond user", "none|energy|strain\n"); /* a rule of one's own is a program's */
    refused("--shell 0", "--shell 0");
    refused("--nonsense 1", "--nonsense");
    refused("--frames 10000", "--frames 10000");
    CHECK_TRUE("unwritable folder", run("--time 1 --out /proc/none") != 0);
}

int main(void)
{
    if (sizeof(mpm_real) == sizeof(double)) programs();
    scene();
    return check_end();
}
