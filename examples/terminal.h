/* terminal.h - manners of a program that takes its time: how far it is, how long it will take, an end when it is asked
   for one. SPDX-License-Identifier: MIT */
#ifndef TERMINAL_H
#define TERMINAL_H

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(_WIN32)
#include <io.h>
#elif defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

/* ---- how far it is --------------------------------------------------------------------------- */

/* A terminal shows one line, written over and over; anything else that messages go to gets a line at every tenth. */
typedef struct progress {
    int quiet, terminal, width; /* nothing at all; messages go to a terminal; its columns */
    int tenths;                 /* of the way, said so far */
    time_t begun, shown;
    clock_t cpu;                /* when it began */
} progress;

static inline int terminal_there(void)
{
#if defined(_WIN32)
    return _isatty(2);
#elif defined(__unix__) || defined(__APPLE__)
    return isatty(2);
#else
    return 0;
#endif
}

/* What a terminal says of itself in COLUMNS, if that can be, or 80. */
static inline int terminal_width(const char *columns)
{
    const long n = columns ? strtol(columns, NULL, 10) : 0;
    return n >= 20 && n <= 1000 ? (int)n : 80;
}

static inline void progress_begin(progress *p, int quiet)
{
    p->quiet = quiet;
    p->terminal = terminal_there();
    p->width = terminal_width(getenv("COLUMNS"));
    p->tenths = 0;
    p->begun = p->shown = time(NULL);
    p->cpu = clock();
}

/* Seconds by the clock on the wall, which counts them whole. CPU time tells them finer, as long as nothing else has
   used the processor; 0 in the first second, of which nothing can be said. */
static inline double progress_seconds(double wall, double cpu)
{
    const double seconds = cpu > wall - 1 && cpu < wall + 1 ? cpu : wall;
    return seconds < 1 ? 0 : seconds;
}

static inline double progress_elapsed(const progress *p)
{
    return progress_seconds(difftime(time(NULL), p->begun), (double)(clock() - p->cpu) / (double)CLOCKS_PER_SEC);
}

/* Whether a line is due, at this part of the way: once a second, or at the next tenth. */
static inline int progress_due(progress *p, double part)
{
    const time_t now = time(NULL);
    if (p->quiet) return 0;
    if (!p->terminal) {
        if (!(10 * part >= p->tenths + 1)) return 0;
        p->tenths = part < 1 ? (int)(10 * part) : 10;
        return 1;
    }
    if (now == p->shown) return 0;
    p->shown = now;
    return 1;
}

/* Shows it. The last column stays empty: some terminals go to the next line after it. */
static inline void progress_show(const progress *p, const char *line)
{
    if (p->terminal) fprintf(stderr, "\r%-*.*s", p->width - 1, p->width - 1, line);
    else fprintf(stderr, "%s\n", line);
    fflush(stderr);
}

/* "impact 35 %, left 0:12", if it is due. */
static inline void progress_part(progress *p, const char *what, double part)
{
    const double seconds = progress_elapsed(p), left = part > 0 && part < 1 ? seconds / part * (1 - part) : 0;
    char line[120];
    int n;
    if (!progress_due(p, part)) return;
    n = snprintf(line, sizeof line, "%.60s %d %%", what, (int)(100 * part));
    if (seconds > 0)
        snprintf(line + n, sizeof line - (size_t)n, ", left %ld:%02d", (long)left / 60, (int)((long)left % 60));
    progress_show(p, line);
}

/* Leaves an empty line. */
static inline void progress_end(const progress *p)
{
    if (!p->quiet && p->terminal) fprintf(stderr, "\r%*s\r", p->width - 1, "");
}

/* ---- an end when it is asked for ------------------------------------------------------------- */

static inline volatile sig_atomic_t *stop_flag(void)
{
    static volatile sig_atomic_t asked;
    return &asked;
}

/* A second signal ends the program at once. */
static inline void stop_note(int number)
{
    *stop_flag() = 1;
    signal(number, SIG_DFL);
}

/* From now on Ctrl-C and SIGTERM only ask. One that is ignored stays so. */
static inline void stop_listen(void)
{
    if (signal(SIGINT, stop_note) == SIG_IGN) signal(SIGINT, SIG_IGN);
    if (signal(SIGTERM, stop_note) == SIG_IGN) signal(SIGTERM, SIG_IGN);
}

/* Whether somebody has asked for the end. */
static inline int stop_asked(void) { return *stop_flag() != 0; }

#define STOPPED 3 /* what main returns then */

/* An argument as a shell takes it. */
static inline void print_argument(const char *a)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
    if (*a && a[strspn(a, plain)] == 0) {
        printf("%s", a);
        return;
    }
    printf("'");
    for (; *a; a++)
        if (*a == '\'') printf("'\\''");
        else printf("%c", *a);
    printf("'");
}

/* "stopped at step 12 of 40; it goes on with: PROGRAM OPTIONS", the last with `flag` ("" for none) if it is not among
   them. */
static inline void print_again(int argc, char **argv, const char *flag, long long step, long long steps)
{
    int a, there = *flag == 0;
    printf("stopped at step %lld of %lld; it goes on with:\n ", step, steps);
    for (a = 0; a < argc; a++) {
        printf(" ");
        print_argument(argv[a]);
        there = there || !strcmp(argv[a], flag);
    }
    printf("%s%s\n", there ? "" : " ", there ? "" : flag);
}

#endif
