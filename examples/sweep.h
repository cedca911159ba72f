/* sweep.h - the engine under studies and sweeps: finished runs kept under their whole description, and claims, by which
   workers who share nothing but a folder agree on who runs what. SPDX-License-Identifier: MIT */
#ifndef SWEEP_H
#define SWEEP_H

#include "program.h"

#include <time.h>

/* ---- finished runs ------------------------------------------------------------------------- */

/* folder/NAME/<hash of the key>ENDING, or "" where that is too long; name and ending are short. Returns path. */
static inline const char *kept_path(const char *folder, const char *name, const char *key, const char *ending,
                                    char *path, size_t n)
{
    char file[100], hash[HASH_DIGITS];
    snprintf(file, sizeof file, "%s/%s%s", name, hash_digits(hash_text(HASH_NONE, key), hash), ending);
    return file_in(folder, file, path, n);
}

/* The checksum of a record: of what goes before it (`h`, or HASH_NONE), of its key and of every value as written. */
static inline const char *kept_sum(uint64_t h, const char *key, const double *value, int n, char text[HASH_DIGITS])
{
    char number[OPTION_NUMBER];
    int k;
    h = hash_text(h, key);
    for (k = 0; k < n; k++) {
        h = hash_text(h, isfinite(value[k]) ? " " : " null");
        if (!isfinite(value[k])) continue;
        mpm_io_number_text(number, sizeof number, value[k]);
        h = hash_text(h, number);
    }
    return hash_digits(h, text);
}

/* Whether a record has that string, which needs no escapes, behind that name. */
static inline int kept_is(const char *record, const char *name, const char *text)
{
    const char *at = json_value(record, name);
    return at && *at == '"' && !strncmp(at + 1, text, strlen(text)) && at[1 + strlen(text)] == '"';
}

/* Takes the n values out of the text of a record. Returns 1 if it is whole and of this key. */
static inline int kept_take(const char *record, uint64_t h, const char *key, const char *const *name, double *value,
                            int n)
{
    char sum[HASH_DIGITS], *end;
    int k;
    if (!kept_is(record, "case", key)) return 0;
    for (k = 0; k < n; k++) {
        const char *at = json_value(record, name[k]);
        if (!at) return 0;
        value[k] = strtod(at, &end);
        if (end == at) value[k] = NAN; /* null */
    }
    return kept_is(record, "checksum", kept_sum(h, key, value, n, sum));
}

/* Adds the bytes of a file to a hash. Returns 1; 0 if it cannot be read. */
static inline int kept_file(const char *path, uint64_t *h)
{
    FILE *f = fopen(path, "rb");
    int c, good;
    if (!f) return 0;
    while ((c = fgetc(f)) != EOF) *h = (*h ^ (uint64_t)(unsigned char)c) * UINT64_C(1099511628211);
    good = !ferror(f);
    fclose(f);
    return good;
}

/* Writes a record, whole or not at all. */
static inline int kept_write(const char *path, uint64_t h, const char *key, const char *const *name,
                             const double *value, int n, mpm_fault *fault)
{
    char sum[HASH_DIGITS];
    mpm_io_json j;
    int k;
    if (mpm_io_json_begin(&j, path, fault) < 0) return 0;
    mpm_io_json_string(&j, "case", key);
    for (k = 0; k < n; k++) mpm_io_json_number(&j, name[k], value[k]);
    mpm_io_json_string(&j, "checksum", kept_sum(h, key, value, n, sum));
    return mpm_io_json_end(&j, fault) >= 0;
}

/* ---- claims -------------------------------------------------------------------------------- */

/* A task has claims folder/claims/<hash>.1, .2, ...: the last one counts. Its owner sets its time again and again; one
   that has grown old belongs to a worker that is dead, and whoever makes the next one has the task. A claim is made by
   link(), of which one succeeds, on NFS too; nothing is removed, so that no worker can remove what is another's.
   Ages are told by the times that the file system gives, never by two machines' clocks. The folder claims is there. */
typedef struct claim {
    const char *folder, *key;
    int number; /* of claims so far: 0, 1, .. */
    int alive;  /* the last one is younger than what is dead */
} claim;

#if defined(__unix__) || defined(__APPLE__)
#define SWEEP_CLAIMS 1
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <utime.h>

static inline const char *claim_path(const claim *c, int number, char *path, size_t n)
{
    char ending[20];
    snprintf(ending, sizeof ending, ".%d", number);
    return kept_path(c->folder, "claims", c->key, ending, path, n);
}

/* When a file was touched, in seconds; -1 if there is none. Opening it makes NFS look again. */
static inline double claim_time(const char *path)
{
    struct stat s;
    const int file = open(path, O_RDONLY), good = file >= 0 && fstat(file, &s) == 0;
    if (file >= 0) close(file);
    return good ? (double)s.st_mtime : -1;
}

/* The time now on the clock of the file system: of folder/clock, touched; this machine's, if the folder is not to be
   written. */
static inline double claim_now(const char *folder)
{
    char path[PATH_BYTES];
    int file;
    file_in(folder, "clock", path, sizeof path);
    if (utime(path, NULL) != 0 && (file = open(path, O_WRONLY | O_CREAT, 0666)) >= 0) close(file);
    if (utime(path, NULL) != 0) return (double)time(NULL);
    return claim_time(path);
}

/* Looks for the last claim of a task. */
static inline claim claim_look(const char *folder, const char *key, double dead)
{
    char path[PATH_BYTES];
    claim c = {NULL, NULL, 0, 0};
    double last = -1, at;
    c.folder = folder;
    c.key = key;
    while ((at = claim_time(claim_path(&c, c.number + 1, path, sizeof path))) >= 0) {
        c.number++;
        last = at;
    }
    c.alive = c.number > 0 && claim_now(folder) - last <= dead;
    return c;
}

/* The name of this worker: machine, process and time, which is that of no other one. */
static inline const char *claim_worker(char *name, size_t n)
{
    struct utsname host;
    char *p;
    if (uname(&host) < 0) host.nodename[0] = 0;
    snprintf(name, n, "%.60s.%ld.%lx", host.nodename, (long)getpid(), (unsigned long)time(NULL));
    for (p = name; *p; p++)
        if (*p == '/') *p = '-';
    return name;
}

/* Takes the task behind a claim that is dead, or that nobody has claimed: 1 if it is ours now; 0 if another one was
   faster; -1 if the folder cannot be written. */
static inline int claim_take(claim *c)
{
    char name[120] = "claims/", mine[PATH_BYTES], path[PATH_BYTES];
    struct stat s;
    FILE *f;
    int linked;
    claim_worker(name + strlen(name), sizeof name - strlen(name));
    f = fopen(file_in(c->folder, name, mine, sizeof mine), "wb");
    if (!f) return -1;
    fprintf(f, "%s\n", strchr(name, '/') + 1);
    if (fclose(f)) return remove(mine), -1;
    linked = link(mine, claim_path(c, c->number + 1, path, sizeof path)) == 0;
    /* an answer that got lost on its way: the link counts */
    if (!linked) linked = stat(mine, &s) == 0 && s.st_nlink == 2;
    remove(mine);
    c->number += linked;
    c->alive = linked;
    return linked;
}

/* The owner's sign of life. Returns 0 if the task is another's by now: this worker had been taken for dead. */
static inline int claim_beat(const claim *c)
{
    char path[PATH_BYTES];
    utime(claim_path(c, c->number, path, sizeof path), NULL);
    return claim_time(claim_path(c, c->number + 1, path, sizeof path)) < 0;
}

/* Gives a task back that was not finished: anybody may take it at once. */
static inline void claim_release(const claim *c)
{
    char path[PATH_BYTES];
    struct utimbuf old = {0, 0};
    utime(claim_path(c, c->number, path, sizeof path), &old);
}

/* While others work: a second. */
static inline void claim_wait(void) { sleep(1); }
#else
/* Without such calls a worker is the only one. */
static inline claim claim_look(const char *folder, const char *key, double dead)
{
    claim c = {NULL, NULL, 0, 0};
    c.folder = dead > 0 ? folder : NULL;
    c.key = key;
    return c;
}

static inline int claim_take(claim *c) { return c->alive = 1; }
static inline int claim_beat(const claim *c) { return c->alive; }
static inline void claim_release(const claim *c) { (void)c; }
static inline void claim_wait(void) {}
#endif

#endif
