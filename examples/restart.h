/* restart.h - a run that can be stopped and goes on: checkpoint.bin in the output folder, after so much time, after so
   many steps, and when Ctrl-C or SIGTERM ask for the end. What comes out in the end is that of the run that was never
   stopped, byte for byte but CPU times. SPDX-License-Identifier: MIT */
#ifndef RESTART_H
#define RESTART_H

#include "history.h"
#include "output.h"

#define RESTART_BODIES 501 /* the most that a checkpoint holds */
#define RESTART_MORE 4     /* stretches of memory of the program's own, at most */

typedef struct restart {
    double every;           /* CPU seconds from one checkpoint to the next; 0: only when stopped */
    int64_t after;          /* steps made now, then a checkpoint and the end; 0: never */
    int resume;             /* go on from the one in the folder */
    double saved;           /* CPU seconds at the last */
    mpm_world *world;       /* these are set by restart_describe */
    mpm_surfaces *surfaces; /* NULL: none */
    output *out;
    mpm_totals *start;      /* what the run began with */
    history *past;
    mpm_blob more[RESTART_MORE]; /* by restart_also */
    int mores;
} restart;

static inline void restart_options(restart *r, option *o, int *n)
{
    option_add(o, n, "checkpoint", OPTION_REAL, &r->every,
               "CPU seconds from one checkpoint.bin in the output folder to the next; 0: when stopped");
    option_add(o, n, "stop-after", OPTION_INTEGER, &r->after, "write one after so many steps and stop; 0: never");
    option_add(o, n, "resume", OPTION_FLAG, &r->resume, "go on from it, with the options that it was written with");
}

static inline int restart_check(const restart *r, char *message, size_t n)
{
    return case_wants(r->every >= 0 && r->every < 1e9, "checkpoint", r->every, "must be >= 0 s", message, n) &&
           case_wants(r->after >= 0, "stop-after", (double)r->after, "must be >= 0", message, n);
}

/* What must be the same for a run that goes on: lines of options, time step and world. */
#define RESTART_TEXT (1000 * (RESTART_BODIES + 7))
static inline char *restart_text(void)
{
    static char text[RESTART_TEXT];
    return text;
}

/* A run: n options make it, and the time step dt does. surfaces may be NULL. */
static inline void restart_describe(restart *r, mpm_world *w, mpm_surfaces *surfaces, output *out, mpm_totals *start,
                                    history *past, mpm_real dt, const option *o, int n)
{
    char *text = restart_text(), number[OPTION_NUMBER];
    size_t used = 0;
    int k;
    r->world = w;
    r->surfaces = surfaces;
    r->out = out;
    r->start = start;
    r->past = past;
    for (k = 0; k < n; k++) used = mpm_io_line(text, RESTART_TEXT, used, o[k].name, option_text(&o[k], number));
    used = mpm_io_line_number(text, RESTART_TEXT, used, "frames", (double)out->frames);
    used = mpm_io_line(text, RESTART_TEXT, used, "fields", out->shown);
    used = mpm_io_line(text, RESTART_TEXT, used, "view", out->view);
    used = mpm_io_line_number(text, RESTART_TEXT, used, "dt", (double)dt);
    mpm_io_world_text(text + used, RESTART_TEXT - used, w);
}

#define RESTART_BLOBS \
    (MPM_BLOBS(RESTART_BODIES) + MPM_SURFACES_BLOBS(RESTART_BODIES) + HISTORY_BLOBS + 3 + RESTART_MORE)

/* What the program keeps beside the world: plain data without pointers, which stays where it is. */
static inline void restart_also(restart *r, const char *name, void *data, size_t bytes)
{
    r->more[r->mores++] = mpm_blob_of(name, data, bytes);
}

/* Behind those of the world, and of the surfaces if there are any. Returns how many there are. */
static inline int restart_blobs(restart *r, mpm_blob *blob, int *world)
{
    int n = *world = mpm_blobs(r->world, blob), i;
    if (r->surfaces) n += mpm_surfaces_blobs(r->surfaces, blob + n);
    n += history_blobs(r->past, blob + n);
    blob[n++] = mpm_blob_of("start", r->start, sizeof *r->start);
    blob[n++] = mpm_blob_of("frame", &r->out->frame, sizeof r->out->frame);
    blob[n++] = mpm_blob_of("cpu seconds", &r->out->cpu, sizeof r->out->cpu);
    for (i = 0; i < r->mores; i++) blob[n++] = r->more[i];
    return n;
}

static inline mpm_status restart_write(restart *r, const char *path, mpm_fault *fault)
{
    static mpm_blob blob[RESTART_BLOBS];
    int world, n = restart_blobs(r, blob, &world);
    return mpm_io_checkpoint_write(path, restart_text(), blob, n, fault);
}

/* Reads the checkpoint; nothing is changed if it is none of this run. */
static inline mpm_status restart_read(restart *r, const char *path, mpm_fault *fault)
{
    static mpm_blob blob[RESTART_BLOBS];
    const char *text = restart_text();
    int world, n = restart_blobs(r, blob, &world);
    mpm_status status = mpm_io_checkpoint_sizes(path, text, blob, n, fault);
    if (status >= 0 && r->surfaces && (status = mpm_surfaces_make_room(r->surfaces, blob + world)) < 0)
        *fault = r->surfaces->fault;
    if (status >= 0) status = mpm_io_checkpoint_read(path, text, blob, n, fault);
    if (status >= 0 && (status = mpm_restored(r->world, blob)) < 0) *fault = r->world->fault;
    if (status >= 0 && r->surfaces && (status = mpm_surfaces_restored(r->surfaces, r->world, blob + world)) < 0)
        *fault = r->surfaces->fault;
    if (status >= 0 && !history_whole(r->past))
        status = mpm_fail(fault, MPM_ERR_ARGUMENT, "history rows", (mpm_real)r->past->rows, -1);
    r->saved = r->out->cpu;
    return status;
}

static inline void restart_said(const restart *r, int64_t steps)
{
    if (!r->out->quiet) printf("going on from step %lld of %lld\n", (long long)r->world->steps, (long long)steps);
}

/* Begins the output, or with --resume goes on from the checkpoint, to a run of so many steps. From now on Ctrl-C and
   SIGTERM ask for the end. Returns 1, or 0 after a message, as all that write. */
static inline int restart_begin(restart *r, int64_t steps)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    stop_listen();
    if (!r->resume) return output_begin(r->out);
    if (restart_read(r, file_in(r->out->folder, "checkpoint.bin", path, sizeof path), &fault) < 0)
        return report(&fault, path);
    restart_said(r, steps);
    return 1;
}

/* Writes the checkpoint. */
static inline int restart_save(restart *r)
{
    const clock_t mark = clock();
    char path[PATH_BYTES];
    mpm_fault fault;
    int ok;
    r->saved = output_cpu(r->out);
    ok = restart_write(r, file_in(r->out->folder, "checkpoint.bin", path, sizeof path), &fault) >= 0;
    r->out->writing += clock() - mark;
    return ok || report(&fault, path);
}

/* Before a step: a checkpoint, if one is due. Returns 1; 0 after a message; -1: stop here, there is a checkpoint. */
static inline int restart_goes_on(restart *r)
{
    if (stop_asked() || (r->after > 0 && r->world->steps - r->out->first >= r->after)) return restart_save(r) ? -1 : 0;
    if (!(r->every > 0) || output_cpu(r->out) - r->saved < r->every) return 1;
    return restart_save(r);
}

/* After the end the checkpoint is of no more use. */
static inline void restart_end(const restart *r)
{
    char path[PATH_BYTES];
    remove(file_in(r->out->folder, "checkpoint.bin", path, sizeof path));
}

#endif
