/* impact_restart.h - runs of impacts that are stopped and go on: the checkpoint of a world of particles and its
   surfaces, and of what is counted beside it. SPDX-License-Identifier: MIT */
#ifndef IMPACT_RESTART_H
#define IMPACT_RESTART_H

#include "impact_options.h"
#include "output.h"

#define IMPACT_BODIES 501 /* the most that a checkpoint holds */

/* When to write checkpoints. */
typedef struct impact_stops {
    double seconds; /* CPU time from one to the next; 0: none */
    int64_t after;  /* steps made now, then a checkpoint and the end; 0: never */
    double saved;   /* CPU time at the last */
} impact_stops;

static inline int impact_stops_check(const impact_stops *k, char *message, size_t n)
{
    return case_wants(k->seconds >= 0 && k->seconds < 1e9, "checkpoint", k->seconds, "must be >= 0 s", message, n) &&
           case_wants(k->after >= 0, "stop-after", (double)k->after, "must be >= 0", message, n);
}

/* What must be the same for a run that goes on: options, frames, time step, the world. Test: 63_particles. */
static inline const char *impact_text(const impact *s, const impact_case *of, int64_t frames)
{
    static char text[1000 * (IMPACT_BODIES + 7)];
    impact_case c = *of;
    option o[IMPACT_OPTIONS];
    size_t used = 0;
    int n = impact_options(&c, o), k;
    for (k = 0; k < n; k++) {
        char number[OPTION_NUMBER];
        used = mpm_io_line(text, sizeof text, used, o[k].name, option_text(&o[k], number));
    }
    used = mpm_io_line_number(text, sizeof text, used, "frames", (double)frames);
    used = mpm_io_line_number(text, sizeof text, used, "dt", (double)s->dt);
    mpm_io_world_text(text + used, sizeof text - used, &s->world);
    return text;
}

/* Writes the checkpoint, or reads it (nothing is changed if it is none of this scene). */
static inline mpm_status impact_checkpoint(impact *s, const impact_case *c, output *out, int write, const char *path,
                                           mpm_fault *fault)
{
    static mpm_blob blob[MPM_BLOBS(IMPACT_BODIES) + MPM_SURFACES_BLOBS(IMPACT_BODIES) + 3];
    const char *text = impact_text(s, c, out->frames);
    const int world = mpm_blobs(&s->world, blob);
    mpm_status status;
    int n = world + mpm_surfaces_blobs(&s->surfaces, blob + world);
    blob[n++] = mpm_blob_of("start", &s->start, sizeof s->start);
    blob[n++] = mpm_blob_of("frame", &out->frame, sizeof out->frame);
    blob[n++] = mpm_blob_of("cpu seconds", &out->cpu, sizeof out->cpu);
    if (write) return mpm_io_checkpoint_write(path, text, blob, n, fault);
    status = mpm_io_checkpoint_sizes(path, text, blob, n, fault);
    if (status >= 0 && (status = mpm_surfaces_make_room(&s->surfaces, blob + world)) < 0) *fault = s->surfaces.fault;
    if (status >= 0) status = mpm_io_checkpoint_read(path, text, blob, n, fault);
    if (status >= 0 && (status = mpm_restored(&s->world, blob)) < 0) *fault = s->world.fault;
    if (status >= 0 && (status = mpm_surfaces_restored(&s->surfaces, &s->world, blob + world)) < 0)
        *fault = s->surfaces.fault;
    return status;
}

/* Writes checkpoint.bin into the output folder. Returns 1, or 0 after a message, as all that write. */
static inline int impact_save(impact *s, const impact_case *c, output *out)
{
    const clock_t mark = clock();
    char path[PATH_BYTES];
    mpm_fault fault;
    const int ok = impact_checkpoint(s, c, out, 1, file_in(out->folder, "checkpoint.bin", path, sizeof path),
                                     &fault) >= 0;
    out->writing += clock() - mark;
    return ok || report(&fault, path);
}

/* Before a step: a checkpoint, if one is due or the end is asked for. Returns 1; 0 after a message; -1: stop here, with
   one. */
static inline int impact_goes_on(impact *s, const impact_case *c, output *out, impact_stops *k)
{
    if (stop_asked() || (k->after > 0 && s->world.steps - out->first >= k->after)) {
        output_cpu(out);
        return impact_save(s, c, out) ? -1 : 0;
    }
    if (!(k->seconds > 0) || output_cpu(out) - k->saved < k->seconds) return 1;
    k->saved = out->cpu;
    return impact_save(s, c, out);
}

static inline void impact_resumed(const impact *s, const output *out)
{
    if (!out->quiet) printf("going on from step %lld of %lld\n", (long long)s->world.steps, (long long)s->steps);
}

#endif
