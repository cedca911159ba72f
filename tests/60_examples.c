/* 60_examples - the programs as a person runs them: a short impact, quarter against full, and bad
   input, which must fail with a message and leave no summary behind. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "check.h"

#include <stdlib.h>
#include <string.h>

/* The number behind "key": in a JSON file; -1e300 if there is none. */
static double number_in(const char *path, const char *key)
{
    static char text[20000];
    FILE *f = fopen(path, "rb");
    char quoted[64];
    const char *at;
    size_t n;
    if (!f) return -1e300;
    n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    text[n] = 0;
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    at = strstr(text, quoted);
    return at ? strtod(at + strlen(quoted), NULL) : -1e300;
}

static int run(const char *options)
{
    char command[500];
    snprintf(command, sizeof command, "build/impact --quiet --frames 0 %s >build/tests/impact.out 2>build/tests/impact.err",
             options);
    return system(command);
}

static void refused(const char *options, const char *value)
{
    char line[200], text[500];
    size_t n = 0;
    FILE *f;
    snprintf(line, sizeof line, "refused: impact %s", options);
    remove("build/tests/bad/summary.json");
    snprintf(text, sizeof text, "%s --out build/tests/bad", options);
    CHECK_TRUE(line, run(text) != 0);
    f = fopen("build/tests/impact.err", "rb");
    if (f) {
        n = fread(text, 1, sizeof text - 1, f);
        fclose(f);
    }
    text[n] = 0;
    CHECK_TRUE("... with a message naming the value", strstr(text, value) != NULL);
    CHECK_TRUE("... and no summary", number_in("build/tests/bad/summary.json", "steps") < -1e299);
}

int main(void)
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
    CHECK_NEAR("energy unaccounted", number_in(q, "energy_unaccounted"), 0, 0.03);
    refused("--diameter -14", "-14");
    refused("--velocity nan", "nan");
    refused("--cell 0", "0");
    refused("--spacing 2", "2");
    refused("--gap -3", "overlap");
    refused("--margin -0.6", "outside");
    refused("--material unobtainium", "unobtainium");
    refused("--nonsense 1", "--nonsense");
    CHECK_TRUE("unwritable folder", run("--time 1 --out /proc/none") != 0);
    return check_end();
}
