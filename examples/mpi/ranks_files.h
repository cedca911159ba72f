/* ranks_files.h - files of a world on several ranks: frames for ParaView, a piece per rank and one index; checkpoints
   that any number of ranks goes on from. SPDX-License-Identifier: MIT */
#ifndef RANKS_FILES_H
#define RANKS_FILES_H

#include "mpm_io.h"
#include "program.h"
#include "ranks.h"

/* ---- frames ---------------------------------------------------------------------------------- */

/* Columns of a piece: real fields in the order of their first numbers, then whole numbers. */
#define RANKS_REALS 16 /* place, velocity, stress, temperature, strain, bond, density */
static const char *const ranks_field_name[] = {"velocity (m/s)", "stress (MPa)", "density (g/cm3)", "temperature (K)",
                                               "plastic strain", "bond D", "body", "id"};
static const int ranks_field_components[] = {3, 6, 1, 1, 1, 1, 1, 1};
#define RANKS_FIELDS 8
#define RANKS_REAL_FIELDS 6

/* What a rank owns, as arrays without gaps. */
typedef struct ranks_columns {
    mpm_real *real; /* RANKS_REALS arrays of `room` values */
    int32_t *whole; /* two: body, id */
    size_t count, room;
} ranks_columns;

static inline int ranks_columns_of(const mpm_world *w, ranks_columns *c)
{
    const mpm_points *p = &w->points;
    const mpm_real *from[15];
    int32_t b, i;
    int k;
    for (k = 0; k < 3; k++) from[k] = p->x[k];
    for (k = 0; k < 3; k++) from[3 + k] = p->v[k];
    for (k = 0; k < 6; k++) from[6 + k] = p->stress[k];
    from[12] = p->temperature;
    from[13] = p->plastic_strain;
    from[14] = p->bond;
    c->count = 0;
    c->room = (size_t)p->count + 1;
    c->real = (mpm_real *)malloc(RANKS_REALS * c->room * sizeof *c->real);
    c->whole = (int32_t *)malloc(2 * c->room * sizeof *c->whole);
    if (!c->real || !c->whole) return 0;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            if (p->flags[i] & RANKS_GHOST) continue;
            for (k = 0; k < 15; k++) c->real[(size_t)k * c->room + c->count] = from[k][i];
            c->real[15 * c->room + c->count] = p->density[i] * 1000;
            c->whole[c->count] = b;
            c->whole[c->room + c->count] = p->id[i];
            c->count++;
        }
    return 1;
}

static inline mpm_status ranks_vtu(const char *path, const ranks_columns *c, double time, mpm_fault *fault)
{
    static const int column[RANKS_REAL_FIELDS] = {3, 6, 15, 12, 13, 14};
    mpm_io_field field[RANKS_FIELDS];
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    int f, k;
    memset(field, 0, sizeof field);
    for (f = 0; f < RANKS_FIELDS; f++) {
        field[f].name = ranks_field_name[f];
        field[f].components = ranks_field_components[f];
        field[f].scale = 1;
        for (k = 0; k < ranks_field_components[f] && f < RANKS_REAL_FIELDS; k++)
            field[f].data[k] = c->real + (size_t)(column[f] + k) * c->room;
    }
    for (f = RANKS_REAL_FIELDS; f < RANKS_FIELDS; f++)
        field[f].integers = c->whole + (size_t)(f - RANKS_REAL_FIELDS) * c->room;
    for (k = 0; k < 3; k++) d.x[k] = c->real + (size_t)k * c->room;
    d.count = c->count;
    d.fields = field;
    d.field_count = RANKS_FIELDS;
    d.time = time;
    d.float32 = 1;
    return mpm_io_vtu(path, &d, fault);
}

/* The index of a frame's pieces. */
static inline mpm_status ranks_index(const char *path, int64_t frame, int pieces, mpm_fault *fault)
{
    mpm_io_file f;
    char text[200];
    int k;
    if (mpm_io_open(&f, path, fault) < 0) return fault->status;
    mpm_io_put(&f, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\">\n"
                   "<PUnstructuredGrid GhostLevel=\"0\">\n"
                   "<PPoints><PDataArray type=\"Float32\" NumberOfComponents=\"3\"/></PPoints>\n<PPointData>\n");
    for (k = 0; k < RANKS_FIELDS; k++) {
        snprintf(text, sizeof text, "<PDataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"/>\n",
                 k < RANKS_REAL_FIELDS ? "Float32" : "Int32", ranks_field_name[k], ranks_field_components[k]);
        mpm_io_put(&f, text);
    }
    mpm_io_put(&f, "</PPointData>\n");
    for (k = 0; k < pieces; k++) {
        snprintf(text, sizeof text, "<Piece Source=\"points_%04lld_%04d.vtu\"/>\n", (long long)frame, k);
        mpm_io_put(&f, text);
    }
    mpm_io_put(&f, "</PUnstructuredGrid>\n</VTKFile>\n");
    return mpm_io_close(&f, fault);
}

/* Writes frame number `frame` at time [ns]: all ranks together. Returns 1, or 0 on all ranks after a message of one. */
static inline int ranks_frame(const ranks *r, const mpm_world *w, const char *folder, int64_t frame, double time)
{
    ranks_columns c = {NULL, NULL, 0, 0};
    char path[PATH_BYTES], name[64];
    mpm_fault fault;
    int ok = ranks_columns_of(w, &c) || complain("no memory for output");
    snprintf(name, sizeof name, "points_%04lld_%04d.vtu", (long long)frame, r->rank);
    if (ok) ok = ranks_vtu(file_in(folder, name, path, sizeof path), &c, time, &fault) >= 0 || report(&fault, path);
    free(c.real);
    free(c.whole);
    ok = ranks_all(r, ok);
    snprintf(name, sizeof name, "points_%04lld.pvtu", (long long)frame);
    if (ok && r->rank == 0)
        ok = (ranks_index(file_in(folder, name, path, sizeof path), frame, r->size, &fault) >= 0 &&
              mpm_io_pvd_add(file_in(folder, "particles.pvd", path, sizeof path), name, time, &fault) >= 0) ||
             report(&fault, path);
    return ranks_all(r, ok);
}

/* ---- checkpoints ------------------------------------------------------------------------------ */

/* What all ranks share, beside the records of points. */
typedef struct ranks_state {
    int64_t steps, notices, frame, pieces, tally[MPM_TALLIES];
    double time, dt, dt_last; /* as double, which holds each mpm_real exactly */
    int64_t next_id;
} ranks_state;

static inline const char *ranks_piece_path(const char *folder, int set, int rank, char *path, size_t n)
{
    char name[64];
    snprintf(name, sizeof name, "ranks_%c_%04d.bin", "ab"[set], rank);
    return file_in(folder, name, path, n);
}

/* The set of pieces that is whole, 0 or 1, and its number of pieces; -1: there is none. */
static inline int ranks_saved(const char *folder, int *pieces)
{
    static char text[4000];
    char path[PATH_BYTES];
    const char *set, *count;
    if (is_there(file_in(folder, "ranks.json", path, sizeof path)) <= 0) return -1;
    text_in(path, text, sizeof text);
    set = json_value(text, "set");
    count = json_value(text, "pieces");
    if (!set || !count) return -1;
    *pieces = (int)strtol(count, NULL, 10);
    return strtol(set, NULL, 10) == 1;
}

/* What goes with the records of a checkpoint. */
static inline ranks_state ranks_state_of(const ranks *r, const mpm_world *w, int64_t frame)
{
    ranks_state s;
    memset(&s, 0, sizeof s);
    s.steps = w->steps;
    s.notices = w->notices;
    s.frame = frame;
    s.pieces = r->size;
    s.time = (double)w->time;
    s.dt = (double)w->dt;
    s.dt_last = (double)w->dt_last;
    s.next_id = w->next_id;
    memcpy(s.tally, w->tally, sizeof s.tally);
    return s;
}

/* Says which set of pieces is whole. Returns 1, or 0 after a message. */
static inline int ranks_name_set(const ranks *r, const mpm_world *w, const char *folder, int set)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_json j;
    mpm_io_json_begin(&j, file_in(folder, "ranks.json", path, sizeof path), &fault);
    mpm_io_json_integer(&j, "set", set);
    mpm_io_json_integer(&j, "pieces", r->size);
    mpm_io_json_integer(&j, "step", w->steps);
    return mpm_io_json_end(&j, &fault) >= 0 || report(&fault, path);
}

/* Every rank writes its piece of the set that is not in use; when all are there, ranks.json names it. Until then the
   one before is good. All ranks together. Returns 1, or 0 on all ranks after a message of one. */
static inline int ranks_save(const ranks *r, const mpm_world *w, const char *folder, const char *text, int64_t frame)
{
    ranks_heap mine = {NULL, 0, 0};
    ranks_state s = ranks_state_of(r, w, frame);
    mpm_blob blob[2];
    mpm_fault fault;
    char path[PATH_BYTES];
    int pieces = 0, set = r->rank == 0 && ranks_saved(folder, &pieces) == 0, ok;
    MPI_Bcast(&set, 1, MPI_INT, 0, r->comm);
    ok = ranks_owned(r, w, &mine) || complain("no memory for the checkpoint");
    blob[0] = mpm_blob_of("state", &s, sizeof s);
    blob[1] = mpm_blob_of("records", mine.data, (size_t)mine.count * r->record);
    ranks_piece_path(folder, set, r->rank, path, sizeof path);
    if (ok) ok = mpm_io_checkpoint_write(path, text, blob, 2, &fault) >= 0 || report(&fault, path);
    free(mine.data);
    ok = ranks_all(r, ok);
    if (ok && r->rank == 0) ok = ranks_name_set(r, w, folder, set);
    return ranks_all(r, ok);
}

/* The records of one piece, behind those that are there. */
static inline mpm_status ranks_read(const char *path, const char *text, size_t record, ranks_state *s, ranks_heap *h,
                                    mpm_fault *fault)
{
    mpm_blob blob[2];
    mpm_status status;
    blob[0] = mpm_blob_of("state", s, sizeof *s);
    if (!ranks_room(h, 1, record)) return MPM_ERR_MEMORY;
    blob[1] = mpm_blob_array("records", h->data, 0, 1, record); /* of any size */
    if ((status = mpm_io_checkpoint_sizes(path, text, blob, 2, fault)) < 0) return status;
    if (!ranks_room(h, (int32_t)(blob[1].bytes / record) + 1, record)) return MPM_ERR_MEMORY;
    h->count = (int32_t)(blob[1].bytes / record);
    blob[1] = mpm_blob_of("records", h->data, (size_t)h->count * record);
    return mpm_io_checkpoint_read(path, text, blob, 2, fault);
}

/* Of the records of one piece those that this rank carries, to *mine; points beyond the grid among them: the next step
   finds them again. 0 without memory. */
static inline int ranks_sift(const ranks *r, const mpm_world *w, const ranks_heap *h, ranks_heap *mine)
{
    const size_t along = (size_t)(w->points.x[r->axis] - w->field) / w->stride;
    int32_t k;
    for (k = 0; k < h->count; k++)
        if (ranks_carries(r, r->rank, ranks_cell(r, ranks_values(h, k, r->record)[along]))) {
            if (!ranks_room(mine, 1, r->record)) return 0;
            memcpy(mine->data + (size_t)mine->count++ * r->record, h->data + (size_t)k * r->record, r->record);
        }
    return 1;
}

static inline void ranks_restore(mpm_world *w, const ranks_state *s)
{
    w->steps = s->steps;
    w->notices = s->notices;
    w->time = (mpm_real)s->time;
    w->dt = (mpm_real)s->dt;
    w->dt_last = (mpm_real)s->dt_last;
    w->next_id = (int32_t)s->next_id;
    memcpy(w->tally, s->tally, sizeof s->tally);
}

/* Goes on from the pieces of any number of ranks: *w is made anew. Returns 1, or 0 with the fault. */
static inline int ranks_resume(ranks *r, mpm_world *w, const char *folder, const char *text, int64_t *frame,
                               mpm_fault *fault)
{
    ranks_heap piece = {NULL, 0, 0}, mine = {NULL, 0, 0};
    ranks_state s;
    char path[PATH_BYTES];
    int pieces = 0, k, ok;
    const int set = ranks_saved(folder, &pieces);
    memset(&s, 0, sizeof s);
    mpm_fail(fault, MPM_ERR_FILE, "ranks.json", set, -1);
    ok = set >= 0 && pieces > 0;
    for (k = 0; k < pieces && ok; k++) {
        piece.count = 0;
        mpm_fail(fault, MPM_ERR_MEMORY, "records of piece", 0, k);
        ok = ranks_read(ranks_piece_path(folder, set, k, path, sizeof path), text, r->record, &s, &piece, fault) >= 0 &&
             ranks_sift(r, w, &piece, &mine);
    }
    if (ok) {
        ranks_restore(w, &s);
        *frame = s.frame;
        ok = ranks_sort(&mine, w->bodies, r->record);
        if (ok && (ok = ranks_build(r, w, &mine) == MPM_OK) == 0) *fault = w->fault;
    }
    free(piece.data);
    free(mine.data);
    return ok;
}

#endif
