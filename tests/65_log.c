/* 65_log - the log of finished sprays: a line that lost or changed a byte is no record, and harms no other one.
   SPDX-License-Identifier: MIT */
#define main spray_study_main
#include "spray_study.c"
#undef main
#include "check.h"
#include "files.h"

#define LOG "build/test-log"

#define SAID LOG ".said"

static char said[1 << 20];
static record kept[RECORDS + 1];

static record example(long seed)
{
    record r;
    int k;
    memset(&r, 0, sizeof r);
    r.c.reading = 1;
    r.c.speed = 500;
    r.c.alpha = 1e4;
    r.c.shape = 1.0 / 3;
    r.c.high = 1e-5;
    r.c.seed = seed;
    r.c.time = 0.01;
    for (k = 0; k < VALUES; k++) r.value[k] = 0.1 + k / 7.0;
    return r;
}

static study study_of_log(void)
{
    study s;
    memset(&s, 0, sizeof s);
    s.log = LOG;
    s.records = kept;
    return s;
}

/* How many records the log gives back; -1000 if one is not as it was written. */
static int records(void)
{
    study s = study_of_log();
    int k, bad = log_read(&s);
    for (k = 0; k < s.count; k++) {
        const record wanted = example(kept[k].c.seed);
        bad |= memcmp(wanted.value, kept[k].value, sizeof wanted.value) != 0 || !same_case(&wanted.c, &kept[k].c);
    }
    return bad ? -1000 : s.count;
}

int main(void)
{
    study s = study_of_log();
    record r[3];
    char line[RECORD_BYTES], other[2 * RECORD_BYTES];
    size_t n, cut;
    int k, accepted = 0, lost = 0, changed = 0;
    if (mpm_io_make_directory("build", NULL) < 0) return 1;
    remove(LOG);
    CHECK_TRUE("FNV-1a of its authors' example",
               strcmp(hash_digits(hash_text(HASH_NONE, "foobar"), line), "85944171f73967e8") == 0);
    CHECK_EQUAL("no log holds no record", records(), 0);
    for (k = 0; k < 3; k++) {
        r[k] = example(k + 1);
        CHECK_EQUAL("a run is written", log_write(&s, &r[k]), 0);
    }
    CHECK_EQUAL("three come back bit for bit", records(), 3);
    record_line(&r[0], line);
    n = strlen(line);
    if (!freopen(SAID, "w", stderr)) return 1; /* a notice for each */
    for (cut = 1; cut < n; cut++) {
        write_file(LOG, line, n - cut);
        accepted += records() != 0;
        if (log_write(&s, &r[1]) || log_write(&s, &r[2])) lost++;
        lost += records() != (cut == 1 ? 3 : 2); /* only the end of the line gone: put back */
    }
    CHECK_EQUAL("lines cut short that count", accepted, 0);
    CHECK_EQUAL("... or spoil those written behind", lost, 0);
    for (cut = 0; cut < n - 1; cut++) {
        strcpy(other, line);
        other[cut] = (char)(other[cut] ^ 1);
        strcat(other, line);
        write_file(LOG, other, 2 * n);
        changed += records() != 1;
    }
    CHECK_EQUAL("lines with a bit changed that count, or spoil the next", changed, 0);
    remove(LOG);
    CHECK_TRUE("a log that cannot be read is not a new one",
               mpm_io_make_directory(LOG "/x", NULL) == MPM_OK && records() == -1000);
    remove(LOG "/x");
    remove(LOG);
    s.data = LOG "/nowhere";
    s.time = 0.002;
    fflush(stderr);
    CHECK_EQUAL("pictures that cannot be written", pictures(&s), -1);
    fflush(stderr);
    text_in(SAID, said, sizeof said);
    CHECK_TRUE("... are said to be so", strstr(said, LOG "/nowhere/spray_b8.png: ") != NULL);
    return check_end();
}
