/* 12_material_program - build/material as a person runs it: numbers, list, curve, refusals.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_ptw.h"
#include "check.h"
#include "files.h"

#include <stdlib.h>
#include <string.h>

static char out[20000], err[2000];

static int run(const char *options)
{
    char command[400];
    int status;
    snprintf(command, sizeof command, "build/material %s >build/tests/material.out 2>build/tests/material.err",
             options);
    status = system(command);
    contents("build/tests/material.out", out, sizeof out);
    contents("build/tests/material.err", err, sizeof err);
    return status;
}

/* The number behind "key = " in the output; not a number if there is none. */
static double printed(const char *key)
{
    char sign[80];
    snprintf(sign, sizeof sign, "%s = ", key);
    return number_behind(out, sign);
}

static void refused(const char *options, const char *value)
{
    CHECK_TRUE(options, run(options) != 0);
    CHECK_TRUE("... with a message naming it", strstr(err, value) != NULL);
}

/* Last row of the curve: strain, isothermal and adiabatic stress, temperature. */
static void curve(void)
{
    double v[4] = {0, 0, 0, 0}, isothermal, per_stress = 0.9 * 0.5 * 1e6 / (8930 * 383.0);
    static char text[40000];
    char *at;
    int i;
    CHECK_EQUAL("curve of cu jc",
                run("--material cu --model jc --strain 0.5 --rate 1e4 --curve build/tests/curve.csv"), 0);
    isothermal = printed("flow_stress_MPa");
    contents("build/tests/curve.csv", text, sizeof text);
    CHECK_EQUAL("header and 201 rows", lines_of(text), 202);
    at = text + strlen(text) - 1;
    while (at > text && at[-1] != '\n') at--;
    for (i = 0; i < 4; i++) {
        v[i] = strtod(at, &at);
        at++;
    }
    CHECK_RELATIVE("last row: strain", v[0], 0.5, 1e-6);
    CHECK_RELATIVE("... the isothermal stress is the one printed", v[1], isothermal, 1e-6);
    CHECK_TRUE("... softer when heated", v[2] < v[1] && v[2] > 0.8 * v[1]);
    CHECK_TRUE("... by about chi sigma eps/(rho Cp)",
               v[3] - 300 < per_stress * v[1] && v[3] - 300 > 0.7 * per_stress * v[2]);
}

int main(void)
{
    int lines = 0;
    const char *at;
    CHECK_EQUAL("without options", run(""), 0);
    CHECK_NEAR("aluminium of source A, strain 0.1, 1e6 /s, 300 K: MPa", printed("flow_stress_MPa"), 259.09, 0.01);
    CHECK_RELATIVE("... xidot", printed("xidot_per_s"), 9.714e12, 1e-3);
    CHECK_EQUAL("at its own density", run("--material cu"), 0);
    CHECK_NEAR("... without pressure", printed("pressure_MPa"), 0, 0);
    CHECK_EQUAL("list", run("--list"), 0);
    for (at = out; (at = strchr(at, '\n')) != NULL; at++) lines++;
    CHECK_EQUAL("... one line per preset and per model", lines, mpm_material_preset_count() + 5);
    CHECK_TRUE("... the models of cu", strstr(out, "\ncu         elastic linear jc scg ptw\n") != NULL);
    CHECK_TRUE("... what a model is", strstr(out, "\njc: Johnson-Cook\n") != NULL);
    curve();
    refused("--material cheese", "cheese");
    refused("--model magic", "magic");
    refused("--material ni --model ptw", "ptw");
    refused("--strain -1", "strain");
    refused("--temperature nan", "temperature");
    refused("--density -5", "density");
    refused("--model elastic --curve build/tests/none.csv", "elastic");
    refused("--curve /proc/none/curve.csv", "/proc/none");
    return check_end();
}
