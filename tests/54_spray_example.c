/* The program build/spray (made by make before the tests): it runs, its books balance, a restart
   gives the same bytes, bad input is refused. SPDX-License-Identifier: MIT */
#include "check.h"
#include "files.h"

#define FOLDER "build/tests/spray_example"

/* Exit status of build/spray with these options and this folder: 0 or not. */
static int spray_in(const char *folder, const char *options)
{
    char command[600];
    snprintf(command, sizeof command, "build/spray --quiet --out %s %s 2>" FOLDER ".err", folder, options);
    return system(command) != 0;
}

static int spray(const char *options) { return spray_in(FOLDER, options); }

static double summary(const char *key) { return number_in(FOLDER "/summary.json", key); }

/* The message of the last run names the value. */
static void refused(const char *options, const char *name)
{
    CHECK_EQUAL(options, spray(options), 1);
    CHECK_TRUE("... naming it", strstr(text_of(FOLDER ".err"), name) != NULL);
}

/* ---- a run that goes on -------------------------------------------------------------------- */

#define WHOLE "build/tests/spray_whole"
#define HOT "--speed 100 --release 50:100 --stand-off 0.05 --feed 2e5 --alpha inf --frames 8 "

/* The same file of both folders, but for the lines with CPU times. */
static int same_file(const char *name)
{
    char path[2][128], line[2][4096];
    FILE *f[2];
    int k, same = 1, more = 1;
    for (k = 0; k < 2; k++) {
        snprintf(path[k], sizeof path[k], "%s/%s", k ? WHOLE : FOLDER, name);
        if (!(f[k] = fopen(path[k], "rb"))) return 0;
    }
    while (same && more) {
        size_t n[2] = {0, 0};
        for (k = 0; k < 2; k++) {
            int c = 0;
            while (n[k] < sizeof line[k] - 1 && c != '\n' && (c = fgetc(f[k])) != EOF) line[k][n[k]++] = (char)c;
            line[k][n[k]] = 0;
        }
        more = n[0] > 0;
        if (strstr(line[0], "per_second\"") || strstr(line[0], "per_cpu_second\"")) continue;
        same = n[0] == n[1] && !memcmp(line[0], line[1], n[0]);
    }
    fclose(f[0]);
    fclose(f[1]);
    return same;
}

/* One changed byte of the checkpoint, at `part` of its length, is found. */
static void changed_byte(double part)
{
    size_t bytes;
    unsigned char *data = slurp(FOLDER "/checkpoint.bin", &bytes);
    CHECK_TRUE("a checkpoint", bytes > 0);
    if (bytes) data[(size_t)(part * (double)(bytes - 1))] ^= 4;
    write_file(FOLDER ".bin", data, bytes);
    free(data);
    CHECK_EQUAL("a checkpoint with a changed byte", spray_in(WHOLE, HOT "--time 0.004 --restart " FOLDER ".bin"), 1);
}

#define GO_ON HOT "--time 0.004 --restart " FOLDER "/checkpoint.bin"

/* A file of the folder is not what it was: going on is refused by its name, and the series and the table stay. */
static void beside(const char *what, const char *name, const char *damage)
{
    static const char *const kept[] = {"impacts.csv", "spray.pvd"};
    size_t n[2], m;
    unsigned char *before[2], *after;
    char command[400];
    int k;
    snprintf(command, sizeof command, "cd " FOLDER " && cp %s ../beside.kept && %s", name, damage);
    CHECK_EQUAL(what, system(command), 0);
    for (k = 0; k < 2; k++) {
        snprintf(command, sizeof command, FOLDER "/%s", kept[k]);
        before[k] = slurp(command, &n[k]);
    }
    refused(GO_ON, name);
    for (k = 0; k < 2; k++) {
        snprintf(command, sizeof command, FOLDER "/%s", kept[k]);
        after = slurp(command, &m);
        CHECK_TRUE("... and nothing is begun", m == n[k] && (m == 0 || !memcmp(before[k], after, m)));
        free(before[k]);
        free(after);
    }
    snprintf(command, sizeof command, "cd " FOLDER " && rm -f %s && mv ../beside.kept %s", name, name);
    CHECK_EQUAL("... until it is whole", system(command), 0);
}

/* What stands beside the checkpoint is what it was written with, and is there and to be read. */
static void test_beside(void)
{
    beside("no table of impacts", "impacts.csv", "rm impacts.csv");
    beside("a digit of it changed", "impacts.csv", "sed '9s/[1-8]\\([0-9]*,[01]\\)$/9\\1/' ../beside.kept >impacts.csv"
           " && ! cmp -s ../beside.kept impacts.csv");
    beside("its last row gone", "impacts.csv", "sed '$d' ../beside.kept >impacts.csv");
    beside("its last row cut", "impacts.csv", "head -c -3 ../beside.kept >impacts.csv");
    beside("... one that cannot be opened", "impacts.csv", "rm impacts.csv && ln -s impacts.csv impacts.csv");
    CHECK_TRUE("... which is said", strstr(text_of(FOLDER ".err"), "cannot be read") != NULL);
    beside("no frame of the series", "spray-000000100.vtu", "rm spray-000000100.vtu");
    beside("... one that cannot be opened", "spray-000000200.vtu",
           "rm spray-000000200.vtu && ln -s spray-000000200.vtu spray-000000200.vtu");
    CHECK_TRUE("... which is said", strstr(text_of(FOLDER ".err"), "cannot be read") != NULL);
}

static void test_resumed(void)
{
    static const char *const file[] = {"impacts.csv", "spray.pvd", "checkpoint.bin", "summary.json", "plume.png",
                                       "deposit.png", "spray-000000100.vtu", "spray-000000800.vtu"};
    int failed = spray_in(WHOLE, HOT "--time 0.004") || spray(HOT "--time 0.002"), k;
    CHECK_EQUAL("a run to 4 ms, and one to 2 ms", failed, 0);
    refused(HOT "--time 0.004 --dt 2.5e-6 --restart " FOLDER "/checkpoint.bin", "dt 2.5e-06");
    refused(HOT "--time 0.004 --seed 7 --restart " FOLDER "/checkpoint.bin", "seed 7");
    refused(HOT "--time 0.004 --median-radius 20 --restart " FOLDER "/checkpoint.bin", "median-radius 20");
    for (k = 0; k <= 8; k++) changed_byte(k / 8.0);
    test_beside();
    failed = spray(GO_ON);
    CHECK_EQUAL("it goes on in its folder", failed, 0);
    for (k = 0; k < 8; k++) CHECK_TRUE(file[k], same_file(file[k]));
    CHECK_TRUE("... with the frames of the first part", lines_in(FOLDER "/spray-000000050.vtu") > 0);
    refused(HOT "--steps 790 --restart " FOLDER "/checkpoint.bin", "step 800, past the end");
    failed = system("cp " WHOLE "/impacts.csv " FOLDER ".rows && rm " FOLDER "/spray-000000100.vtu") ||
             spray(HOT "--time 0.005 --frames 0 --restart " FOLDER "/checkpoint.bin");
    CHECK_EQUAL("without a series no frame is missed", failed, 0);
    CHECK_TRUE("... and the table grows", lines_in(FOLDER "/impacts.csv") > lines_in(FOLDER ".rows"));
    failed = spray(HOT "--time 0.006 --restart " FOLDER "/checkpoint.bin");
    CHECK_EQUAL("... nor of one that had none", failed, 0);
    failed = spray(HOT "--time 0.0005");
    CHECK_EQUAL("a run from the start in a used folder", failed, 0);
    CHECK_EQUAL("... begins its series anew", lines_in(FOLDER "/spray.pvd"), lines_in(WHOLE "/spray.pvd"));
}

int main(void)
{
    size_t whole_bytes, parts_bytes;
    unsigned char *whole, *parts;
    int failed = spray("--steps 4000 --frames 4");
    CHECK_EQUAL("4000 steps of the paper's spray", failed, 0);
    CHECK_EQUAL("40 batches of 50", summary("injected"), 2000);
    CHECK_EQUAL("the books balance", summary("deposited") + summary("escaped") + summary("in_flight"), 2000);
    CHECK_RELATIVE("deposit fraction", summary("deposit_fraction"), summary("deposited") / 2000, 1e-12);
    CHECK_TRUE("impact speed of the first to arrive [m/s]",
               summary("impact_speed_mean_m_s") > 25 && summary("impact_speed_mean_m_s") < 45);
    CHECK_TRUE("one row per first impact", lines_in(FOLDER "/impacts.csv") >= 1 + (long)summary("deposited"));
    whole = slurp(FOLDER "/checkpoint.bin", &whole_bytes);
    failed = spray("--steps 2000 --frames 2") || spray("--steps 4000 --frames 4 --restart " FOLDER "/checkpoint.bin");
    CHECK_EQUAL("half of it, and a restart from there", failed, 0);
    parts = slurp(FOLDER "/checkpoint.bin", &parts_bytes);
    CHECK_TRUE("give the same bytes", whole && parts && whole_bytes > 100000 && whole_bytes == parts_bytes &&
                                          !memcmp(whole, parts, whole_bytes));
    free(whole);
    free(parts);
    refused("--steps 5000 --alpha 2e4 --restart " FOLDER "/checkpoint.bin", "alpha 20000 (index 4)");
    failed = spray("--gas jet-axisymmetric --alpha inf --deposit always --contact overlap --steps 3000 --frames 0 "
                   "--shape 1 --restitution 0.8 --release 10:40 --gamma12 0.7 --theta 1");
    CHECK_EQUAL("the other choices run", failed, 0);
    CHECK_EQUAL("... and with alpha inf every first touch sticks", summary("first_hit_stuck_fraction"), 1);
    test_resumed();
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
