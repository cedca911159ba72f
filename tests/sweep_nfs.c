/* sweep_nfs.c - put before libc (LD_PRELOAD), loses the answer to every other link and to every other renaming of a
   folder: it is done, and said to have failed, as by a request that NFS sent twice. Used by sweep_engines.sh.
   SPDX-License-Identifier: MIT */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

typedef int two_paths(const char *from, const char *to);

/* Does what libc does; every other success is told as a failure. */
static int lossy(const char *name, const char *from, const char *to, int error, int *turn)
{
    void *symbol = dlsym(RTLD_NEXT, name);
    two_paths *real;
    int result;
    memcpy(&real, &symbol, sizeof real);
    result = real(from, to);
    if (result != 0 || (*turn)++ % 2) return result;
    errno = error;
    return -1;
}

int link(const char *from, const char *to)
{
    static int turn;
    return lossy("link", from, to, EEXIST, &turn);
}

int rename(const char *from, const char *to)
{
    static int turn;
    struct stat s;
    int files = 1;
    if (stat(from, &s) == 0 && S_ISDIR(s.st_mode)) return lossy("rename", from, to, ENOENT, &turn);
    return lossy("rename", from, to, ENOENT, &files);
}
