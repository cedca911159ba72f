/* 61_taylor - the Taylor bar as a person runs it: a few microseconds of it, its files, 3D
   beside axisymmetry; what is measured; both walls; and bad input, which must fail with a message and
   leave nothing behind. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "taylor_case.h"
#include "check.h"
#include "files.h"

static int run(const char *options)
{
    char command[500];
    snprintf(command, sizeof command, "build/taylor --quiet %s >build/tests/taylor.out 2>build/tests/taylor.err",
             options);
    return system(command);
}

/* Option and value must be in the message, and the folder must not be made. */
static void refused(const char *name, const char *value)
{
    char line[300];
    const char *said;
    remove("build/tests/taylor-bad/summary.json"); /* of a time when it was not refused */
    snprintf(line, sizeof line, "%s %s --out build/tests/taylor-bad", name, value);
    CHECK_TRUE(line, run(line) != 0);
    said = text_of("build/tests/taylor.err");
    CHECK_TRUE("... with a message naming option and value", strstr(said, name) && strstr(said, value));
    CHECK_TRUE("... and nothing written", !*text_of("build/tests/taylor-bad/summary.json"));
}

/* Five microseconds, coarse: conserved sums, profile, and 3D close to axisymmetry. */
static void program(void)
{
    const char *a = "build/tests/taylor/summary.json", *b = "build/tests/taylor-3d/summary.json";
    CHECK_EQUAL("a short run", run("--time 5 --cell 0.8 --spacing 0.4 --frames 1 --out build/tests/taylor"), 0);
    CHECK_EQUAL("in three dimensions",
                run("--time 5 --cell 0.8 --spacing 0.4 --frames 0 --geometry 3d --out build/tests/taylor-3d"), 0);
    CHECK_TRUE("a frame with the places at the start", strstr(text_of("build/tests/taylor/points_0000.vtu"),
                                                              "Name=\"height at the start (mm)\"") != NULL);
    CHECK_EQUAL("points, 8 by 81", number_in(a, "points"), 8 * 81);
    CHECK_EQUAL("rows of the profile and a header", lines_in("build/tests/taylor/profile.csv"), 81 + 2 + 1);
    CHECK_NEAR("mass error", number_in(a, "mass_error"), 0, 0);
    CHECK_NEAR("momentum error", number_in(a, "momentum_error"), 0, 1e-12);
    CHECK_NEAR("energy unaccounted", number_in(a, "energy_unaccounted"), 0, 2e-3);
    CHECK_NEAR("momentum error, 3D", number_in(b, "momentum_error"), 0, 1e-12);
    CHECK_RELATIVE("length, 3D and axisymmetric", number_in(b, "final_length_mm"), number_in(a, "final_length_mm"),
                   2e-3);
    CHECK_RELATIVE("radius, 3D and axisymmetric", number_in(b, "final_radius_mm"), number_in(a, "final_radius_mm"),
                   0.03);
}

/* A bar that only moves: the measures give its length and radius back exactly, also where they are no
   whole number of spacings. */
static void measures(const char *geometry)
{
    taylor_case c = taylor_case_default();
    taylor_result r;
    taylor s;
    char message[300], line[80];
    int32_t i;
    c.length = 20.3;
    c.diameter = 6.5;
    c.cell = c.spacing = 0.4;
    c.geometry = geometry;
    CHECK_TRUE("begins", taylor_begin(&s, &c, message, sizeof message));
    for (i = 0; i < s.world.points.count; i++) s.world.points.x[2][i] += (mpm_real)1.5;
    CHECK_TRUE("measured", taylor_measure(&s, &c, NULL, &r));
    snprintf(line, sizeof line, "undeformed, %s: length", geometry);
    CHECK_RELATIVE(line, r.length, 20.3, 1e3 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... and radius", r.radius, 3.25, 1e3 * (double)MPM_EPSILON);
    for (i = 0; i < s.world.points.count; i++) { /* spread by 2, squeezed to a quarter */
        s.world.points.x[0][i] *= 2;
        s.world.points.x[1][i] *= 2;
        s.world.points.x[2][i] /= 4;
    }
    CHECK_TRUE("measured again", taylor_measure(&s, &c, NULL, &r));
    CHECK_RELATIVE("deformed: length", r.length, s.length / 4 + c.length - s.length, 1e3 * (double)MPM_EPSILON);
    CHECK_RELATIVE("... and radius", r.radius, 6.5, 1e3 * (double)MPM_EPSILON);
    mpm_free(&s.world);
}

/* A wall in contact lets an elastic bar go; a sliding one holds it. */
static void walls(void)
{
    taylor_case c = taylor_case_default();
    taylor_result r;
    taylor s;
    char message[300];
    int held, begun;
    c.length = 16;
    c.velocity = 20;
    c.model = "elastic";
    c.cell = 0.8;
    c.spacing = 0.4;
    c.time = 20; /* a wave there and back takes 9 us at the bar speed */
    for (held = 0; held < 2; held++) {
        c.wall = held ? "sliding" : "contact";
        begun = taylor_begin(&s, &c, message, sizeof message);
        CHECK_TRUE("an elastic bar begins", begun);
        if (!begun) return;
        while (s.world.steps < s.steps && taylor_step(&s) >= 0) {}
        taylor_measure(&s, &c, NULL, &r);
        if (!held) CHECK_NEAR("contact: an elastic bar bounces off", r.velocity / c.velocity, 1, 0.15);
        else CHECK_TRUE("sliding: it does not", r.velocity < 0.5 * c.velocity);
        CHECK_NEAR("momentum error", r.momentum_error, 0, 1e5 * (double)MPM_EPSILON);
        mpm_free(&s.world);
    }
}

static void refusals(void)
{
    refused("--length", "-3");
    refused("--diameter", "0");
    refused("--velocity", "-227");
    refused("--cell", "nan");
    refused("--spacing", "5");
    refused("--time", "-1");
    refused("--dt-factor", "2");
    refused("--dt-factor", "1e-300"); /* makes more steps than can be counted, not none */
    refused("--friction", "0.3"); /* of a sliding wall */
    refused("--frames", "-1");
    refused("--material", "unobtainium");
    refused("--model", "magic");
    refused("--wall", "soft");
    refused("--geometry", "4d");
    refused("--functions", "octic");
    CHECK_TRUE("unwritable folder", run("--time 1 --cell 0.8 --spacing 0.4 --out /proc/none") != 0);
}

int main(void)
{
    if (sizeof(mpm_real) == sizeof(double)) { /* the program is in double: a test in float leaves it to its twin */
        program();
        refusals();
    }
    measures("axisymmetric");
    measures("3d");
    walls();
    return check_end();
}
