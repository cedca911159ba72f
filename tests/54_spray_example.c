/* The program build/spray (made by make before the tests): it runs, its books balance, a restart
   gives the same bytes, bad input is refused. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

#define FOLDER "build/tests/spray_example"

/* Exit status of build/spray with these options: 0 or not. */
static int spray(const char *options)
{
    char command[512];
    snprintf(command, sizeof command, "build/spray --quiet --out " FOLDER " %s 2>" FOLDER ".err", options);
    return system(command) != 0;
}

static long count_lines(const char *path)
{
    FILE *f = fopen(path, "r");
    long lines = 0;
    int c;
    if (!f) return -1;
    while ((c = fgetc(f)) != EOF) lines += c == '\n';
    fclose(f);
    return lines;
}

/* The whole file, or NULL. */
static char *contents(const char *path, size_t *bytes)
{
    FILE *f = fopen(path, "rb");
    size_t room = 1 << 22;
    char *text = (char *)calloc(1, room);
    *bytes = f && text ? fread(text, 1, room - 1, f) : 0;
    if (f) fclose(f);
    return text;
}

/* A number of summary.json. */
static double summary(const char *key)
{
    size_t bytes;
    char *text = contents(FOLDER "/summary.json", &bytes), quoted[80], *at;
    double value = -1;
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    at = text ? strstr(text, quoted) : NULL;
    if (at) value = strtod(at + strlen(quoted), NULL);
    free(text);
    return value;
}

/* The message of the last run names the value. */
static void refused(const char *options, const char *name)
{
    size_t bytes;
    char *text;
    int failed = spray(options);
    CHECK_EQUAL(options, failed, 1);
    text = contents(FOLDER ".err", &bytes);
    CHECK_TRUE("... naming it", text && strstr(text, name));
    free(text);
}

int main(void)
{
    size_t whole_bytes, parts_bytes;
    char *whole, *parts;
    int failed = spray("--steps 4000 --frames 4");
    CHECK_EQUAL("4000 steps of the paper's spray", failed, 0);
    CHECK_EQUAL("40 batches of 50", summary("injected"), 2000);
    CHECK_EQUAL("the books balance", summary("deposited") + summary("escaped") + summary("in_flight"), 2000);
    CHECK_RELATIVE("deposit fraction", summary("deposit_fraction"), summary("deposited") / 2000, 1e-12);
    CHECK_TRUE("impact speed of the first to arrive [m/s]",
               summary("impact_speed_mean_m_s") > 25 && summary("impact_speed_mean_m_s") < 45);
    CHECK_TRUE("one row per first impact", count_lines(FOLDER "/impacts.csv") >= 2 + (long)summary("deposited"));
    whole = contents(FOLDER "/checkpoint.bin", &whole_bytes);
    failed = spray("--steps 2000 --frames 0") || spray("--steps 4000 --frames 0 --restart " FOLDER "/checkpoint.bin");
    CHECK_EQUAL("half of it, and a restart from there", failed, 0);
    parts = contents(FOLDER "/checkpoint.bin", &parts_bytes);
    CHECK_TRUE("give the same bytes", whole && parts && whole_bytes > 100000 && whole_bytes == parts_bytes &&
                                          !memcmp(whole, parts, whole_bytes));
    free(whole);
    free(parts);
    refused("--steps 5000 --alpha 2e4 --restart " FOLDER "/checkpoint.bin", "alpha 20000 (index 4)");
    failed = spray("--gas jet-axisymmetric --alpha inf --deposit always --contact overlap --steps 3000 --frames 0 "
                   "--shape 1 --restitution 0.8 --release 10:40 --gamma12 0.7 --theta 1");
    CHECK_EQUAL("the other choices run", failed, 0);
    CHECK_EQUAL("... and with alpha inf every first touch sticks", summary("first_hit_stuck_fraction"), 1);
    refused("--median-radius -3", "median_radius");
    refused("--feed 0 --steps 100", "feed");
    refused("--stand-off -0.1", "stand_off");
    refused("--dt 1e-3", "dt");
    refused("--dt nan", "dt");
    refused("--gas wind", "wind");
    refused("--release 5", "release");
    refused("--restitution 2", "restitution");
    refused("--restart build/no-such-file", "no-such-file");
    return check_end();
}
