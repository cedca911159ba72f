/* 75_ladder - the ladder of examples, 00 to 09, as a person runs them: each says its number, its leading comment the
   same one; each file is one page. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "check.h"
#include "files.h"

static char source[20000], out[20000];

/* The program is one page, ends well, and writes its output to be read. */
static void run(const char *name, int most)
{
    char text[200];
    snprintf(text, sizeof text, "examples/%s.c", name);
    contents(text, source, sizeof source);
    snprintf(text, sizeof text, "%s: a page", name);
    CHECK_TRUE(text, lines_of(source) > 50 && lines_of(source) < most);
    snprintf(text, sizeof text, "build/%s build/tests/ladder.file >build/tests/ladder.out", name);
    CHECK_EQUAL("... ends well", system(text), 0);
    contents("build/tests/ladder.out", out, sizeof out);
}

static double behind(const char *key) { return number_behind(out, key); }

/* The number behind `key` in the output is `wanted` within `tolerance`; the leading comment says `claim`. */
static void says(const char *key, double wanted, double tolerance, const char *claim)
{
    const char *end = strstr(source, "*/"), *claimed = strstr(source, claim);
    CHECK_NEAR(key, behind(key), wanted, tolerance);
    CHECK_TRUE("... as its comment says", claimed && claimed < end);
}

static void laws(void)
{
    run("05_law", 150);
    says("off the law by ", 0, 1e-6, "bear Voce's stress to 1e-6");
    says("plastic strain over ", 0.02, 2e-5, "plastic strain over 0.02, to 0.1 %");
    says("peak traction ", 99.59, 0.1, "reaches 99.6 MPa");
    says("spent in drawing apart ", 10.09, 0.05, "10.09 J/m^2");
    says("peak traction ", 100, 1, "strength of 100 MPa");             /* what was set */
    says("spent in drawing apart ", 10, 0.2, "10 J/m^2 are spent");
}

static void points(void)
{
    run("07_body_from_points", 150);
    says("ring: ", 97.787, 0.001, "97.787 %");
    says("grains: ", 100, 1e-4, "100 % (grains");
    says("ball, after 0.1 s: ", 104.445, 0.001, "104.445 %");
    says("in all: ", 30.88379 + 7.35656 + 8.54492, 2e-5, "nothing is lost");
    CHECK_TRUE("... no point either", strstr(out, " kg, 0 points have left\n") != NULL);
}

static void driven(void)
{
    run("08_drive", 150);
    says("force on the punch ", 2074.3, 0.004 * 2074.3, "2074.3 uN, both forces to 0.4 %");
    says("on the lower end ", 2074.3, 0.004 * 2074.3, "both forces to 0.4 %");
    says("work of the punch ", behind("lost in contact "), 0.001 * 41.4, "work, to 0.1 %");
    says("momentum ", behind("x time "), 2e-6, "momentum to round-off");
    says("work of the traction ", behind("energy of the free block "), 0.001, "work, to 0.1 %");
}

int main(void)
{
    run("00_step", 160);
    says("energy kept: ", 100, 0.1, "100.0 % of the energy");
    says("leaves at ", 187.7, 0.05, "leaves at 187.7 m/s");
    run("01_drop", 150);
    says("leaves the wall at ", 10.7, 0.15, "leaves the wall at 10.7 m/s");
    says("height of the ball: ", 11.31, 0.02, "11.31 um high");
    says("of the momentum the wall gave: ", 1, 1e-6, "rigid wall");
    run("02_bar", 150);
    says("20 cells: error ", -0.083, 0.002, "0.083 % with 20 cells");
    says("40 cells: error ", -0.021, 0.001, "0.021 %");
    run("03_disks", 150);
    says("they touch after ", 1.0858, 0.011, "1.0858");
    says("they leave with ", 88.0, 0.2, "88.0 %");
    says("contact took: ", 99.97, 0.05, "99.97 %");
    run("04_slide", 150);
    says("friction 0.0: ", 4.905, 0.001 * 4.905, "4.905 m/s^2 without friction");
    says("friction 0.3: ", 2.356, 0.0013 * 4.905, "2.356\n   with friction 0.3, found to 0.1 %");
    says("friction 0.7: ", 0, 0.02, "it stays, and sways a little");
    laws();
    run("06_restart", 150);
    says("numbers that differ: ", 0, 0, "0 of 16400 numbers differ");
    says("bonded: ", 4.330, 0.01, "4.330 %");
    points();
    driven();
    run("09_shear", 150);
    says("off the closed answer by ", 0, 0.002, "to 0.2 % of mu");
    says("energy ", 1, 1e-4, "to 0.01 %");
    says("without mpm_rotate: off by ", 2.86, 0.005, "2.86 mu off");
    return check_end();
}
