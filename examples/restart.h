/* restart.h - a run of one world that can be stopped and goes on: checkpoint.bin in the output folder, after so much
   time and when Ctrl-C or SIGTERM ask for the end. What comes out in the end is that of the run that was never stopped,
   byte for byte but CPU times. SPDX-License-Identifier: MIT */
#ifndef RESTART_H
#define RESTART_H

#include "output.h"

#define RESTART_BODIES 2 /* the most that a checkpoint holds */

typedef struct restart {
    double every;       /* CPU seconds from one checkpoint to the next; 0: only when stopped */
    int resume;         /* go on from the one in the folder */
    double saved;       /* CPU seconds at the last */
    mpm_world *world;   /* these are set by restart_begin */
    output *out;
    mpm_totals *start;  /* what the run began with */
    char text[8000];    /* what must be the same for a run that goes on */
} restart;

static inline void restart_options(restart *r, option *o, int *n)
{
    option_add(o, n, "checkpoint", OPTION_REAL, &r->every,
               "CPU seconds from one checkpoint.bin in the output folder to the next; 0: when stopped");
    option_add(o, n, "resume", OPTION_FLAG, &r->resume, "go on from it, with the options that it was written with");
}

static inline int restart_check(const restart *r, char *message, size_t n)
{
    return case_wants(r->every >= 0 && r->every < 1e9, "checkpoint", r->every, "must be >= 0 s", message, n);
}

static inline mpm_status restart_file(restart *r, int write, const char *path, mpm_fault *fault)
{
    mpm_blob blob[MPM_BLOBS(RESTART_BODIES) + 3];
    int n = mpm_blobs(r->world, blob);
    mpm_status status;
    blob[n++] = mpm_blob_of("start", r->start, sizeof *r->start);
    blob[n++] = mpm_blob_of("frame", &r->out->frame, sizeof r->out->frame);
    blob[n++] = mpm_blob_of("cpu seconds", &r->out->cpu, sizeof r->out->cpu);
    if (write) return mpm_io_checkpoint_write(path, r->text, blob, n, fault);
    status = mpm_io_checkpoint_read(path, r->text, blob, n, fault);
    if (status >= 0 && (status = mpm_restored(r->world, blob)) < 0) *fault = r->world->fault;
    return status;
}

/* Writes the checkpoint. Returns 1, or 0 after a message, as all that write. */
static inline int restart_save(restart *r)
{
    const clock_t mark = clock();
    char path[PATH_BYTES];
    mpm_fault fault;
    int ok;
    r->saved = output_cpu(r->out);
    file_in(r->out->folder, "checkpoint.bin", path, sizeof path);
    ok = restart_file(r, 1, path, &fault) >= 0;
    r->out->writing += clock() - mark;
    return ok || report(&fault, path);
}

/* Begins the output, or with --resume goes on from the checkpoint. n options make the run, and the time step dt does.
   From now on Ctrl-C and SIGTERM ask for the end. */
static inline int restart_begin(restart *r, mpm_world *w, output *out, mpm_totals *start, mpm_real dt, const option *o,
                                int n)
{
    char path[PATH_BYTES], number[OPTION_NUMBER];
    size_t used = 0;
    mpm_fault fault;
    int k;
    r->world = w;
    r->out = out;
    r->start = start;
    for (k = 0; k < n; k++)
        used = mpm_io_line(r->text, sizeof r->text, used, o[k].name, option_text(&o[k], number));
    used = mpm_io_line_number(r->text, sizeof r->text, used, "frames", (double)out->frames);
    used = mpm_io_line_number(r->text, sizeof r->text, used, "dt", (double)dt);
    mpm_io_world_text(r->text + used, sizeof r->text - used, w);
    stop_listen();
    if (!r->resume) return output_begin(out);
    file_in(out->folder, "checkpoint.bin", path, sizeof path);
    if (restart_file(r, 0, path, &fault) < 0) return report(&fault, path);
    r->saved = out->cpu;
    if (!out->quiet) printf("going on from step %lld\n", (long long)w->steps);
    return 1;
}

/* Before a step: a checkpoint, if one is due. Returns 1; 0 after a message; -1: stop here, there is a checkpoint. */
static inline int restart_goes_on(restart *r)
{
    if (stop_asked()) return restart_save(r) ? -1 : 0;
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
