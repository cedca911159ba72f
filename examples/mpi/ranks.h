/* ranks.h - one world cut into slabs of cells, each the world of one rank: MPI on the public names of mpm.h alone.

   A rank owns the points in its slab and carries those of its neighbours within `halo` cells beside it, the ghosts. It
   steps them all by itself. Sums at the nodes that its own points touch are then complete, as is everything made of
   them: contact, bonds, the velocities of MUSL. After the step every point near a cut is sent, as it now is, by the
   rank that owned it, and takes the place of the ghosts. So each point's state is always that of one rank.

     MPI_Init(..); build the whole scene w; ranks_begin(&r, MPI_COMM_WORLD, &w, message, n);    w is now a part
     each step:  mpm_step(&w, dt); ranks_exchange(&r, &w);  now and then ranks_balance(&r, &w);
     ranks_end(&r);

   What it does not do: contact on surfaces and desc.calm, which need sums over all ranks within the step. The ledger
   counts nodes near a cut on both sides; ranks_sums are the sums of what is owned. SPDX-License-Identifier: MIT */
#ifndef RANKS_H
#define RANKS_H

#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mpm.h"

#define RANKS_GHOST 128 /* flag of a point that another rank owns */
#define RANKS_STALE 64  /* ... whose state is of the step before, or that is no longer needed */

/* Records of points, as they travel: body, id, flags, 0 as int32_t, then all real fields. */
typedef struct ranks_heap {
    unsigned char *data;
    int32_t count, room;
} ranks_heap;

typedef struct ranks {
    MPI_Comm comm;
    int rank, size;
    int axis;            /* across which the cuts lie */
    int32_t halo;        /* cells beside a cut whose points both ranks carry */
    int32_t *cut;        /* size + 1: rank k owns the cells cut[k] .. cut[k+1] - 1 along axis */
    mpm_desc whole;      /* the grid of the whole */
    mpm_body *body;      /* as in the whole */
    int32_t *active;     /* per body: points in use after the last exchange */
    int32_t bodies;
    size_t record;       /* bytes of one */
    MPI_Datatype kind;   /* of one: messages count records, since int counts no more than 2 GB of bytes */
    ranks_heap out[2], in[2]; /* to and from the neighbours below and above */
    ranks_heap gone;     /* owned points that left the grid */
    int64_t sent;        /* bytes, to neighbours */
    double uneven;       /* load of the heaviest slab over the mean from which on cuts move; 1.1 */
    int64_t moves;       /* times the cuts moved */
    double waited;       /* seconds in messages */
} ranks;

/* Whether all ranks did it: what one of them could not do ends for all, and none waits for it. */
static inline int ranks_all(const ranks *r, int ok)
{
    int all = 0;
    MPI_Allreduce(&ok, &all, 1, MPI_INT, MPI_MIN, r->comm);
    return all;
}

/* ---- records --------------------------------------------------------------------------------- */

/* Room for n more. 0 without memory. */
static inline int ranks_room(ranks_heap *h, int32_t n, size_t record)
{
    const int32_t want = h->count + n;
    void *data;
    if (want <= h->room) return 1;
    data = realloc(h->data, (size_t)(want + want / 4 + 64) * record);
    if (!data) return 0;
    h->data = (unsigned char *)data;
    h->room = want + want / 4 + 64;
    return 1;
}

static inline int ranks_push(ranks_heap *h, const mpm_world *w, int32_t body, int32_t i, size_t record)
{
    const int32_t head[4] = {body, w->points.id[i], w->points.flags[i] & ~(RANKS_GHOST | RANKS_STALE), 0};
    mpm_real *value;
    int f;
    if (!ranks_room(h, 1, record)) return 0;
    memcpy(h->data + (size_t)h->count * record, head, sizeof head);
    value = (mpm_real *)(void *)(h->data + (size_t)h->count * record + sizeof head);
    for (f = 0; f < w->fields; f++) value[f] = w->field[(size_t)f * w->stride + (size_t)i];
    h->count++;
    return 1;
}

static inline const int32_t *ranks_head(const ranks_heap *h, int32_t k, size_t record)
{
    return (const int32_t *)(const void *)(h->data + (size_t)k * record);
}

static inline const mpm_real *ranks_values(const ranks_heap *h, int32_t k, size_t record)
{
    return (const mpm_real *)(const void *)(h->data + (size_t)k * record + 4 * sizeof(int32_t));
}

/* Record k over point i. */
static inline void ranks_put(mpm_world *w, int32_t i, const ranks_heap *h, int32_t k, size_t record)
{
    const int32_t *head = ranks_head(h, k, record);
    const mpm_real *value = ranks_values(h, k, record);
    int f;
    for (f = 0; f < w->fields; f++) w->field[(size_t)f * w->stride + (size_t)i] = value[f];
    w->points.id[i] = head[1];
    w->points.flags[i] = (uint8_t)head[2];
}

/* Point j over point i. */
static inline void ranks_copy(mpm_world *w, int32_t j, int32_t i)
{
    int f;
    for (f = 0; f < w->fields; f++)
        w->field[(size_t)f * w->stride + (size_t)i] = w->field[(size_t)f * w->stride + (size_t)j];
    w->points.id[i] = w->points.id[j];
    w->points.flags[i] = w->points.flags[j];
}

/* A place behind the points in use: it weighs nothing. */
static inline void ranks_park(mpm_world *w, int32_t i)
{
    w->points.mass[i] = 0;
    w->points.flags[i] = RANKS_GHOST;
}

/* ---- who owns what --------------------------------------------------------------------------- */

/* The cell of a place along the axis of the cuts, in the whole grid; those outside count as the first and last. */
static inline int32_t ranks_cell(const ranks *r, mpm_real x)
{
    const double c = (double)(x - r->whole.origin[r->axis]) / (double)r->whole.cell;
    const int32_t last = r->whole.cells[r->axis] - 1;
    return !(c > 0) ? 0 : c > last ? last : (int32_t)c; /* cut off is rounded down, above 0 */
}

static inline int ranks_owns(const ranks *r, int rank, int32_t cell)
{
    return cell >= r->cut[rank] && cell < r->cut[rank + 1];
}

/* Whether a rank carries the points of a cell, as owner or ghosts. */
static inline int ranks_carries(const ranks *r, int rank, int32_t cell)
{
    return cell >= r->cut[rank] - r->halo && cell < r->cut[rank + 1] + r->halo;
}

/* How far beside a cut points matter for those at it. MUSL's velocities at the nodes that these touch are made of
   points whose new velocities need whole sums at their nodes, and contact with a bond there needs the D of points
   further out, which grows where these are at contact nodes: a chain of nodes, points, nodes, points, nodes, points.
   With linear functions and a layer less an impact is wrong in the eighth digit. */
static inline int32_t ranks_halo(mpm_basis basis)
{
    static const int32_t cells[MPM_BASES] = {3, 7, 7, 9};
    return cells[basis];
}

/* Cuts that share `load` (per cell) evenly, none nearer than `least` cells. */
static inline void ranks_share(const double *load, int32_t cells, int32_t least, int size, int32_t *cut)
{
    double all = 0, sum = 0;
    int32_t c = 0;
    int k;
    for (c = 0; c < cells; c++) all += load[c];
    cut[0] = 0;
    cut[size] = cells;
    for (k = 1, c = 0; k < size; k++) {
        const int32_t first = cut[k - 1] + least, last = cells - (size - k) * least;
        while (c < last && (c < first || sum + load[c] / 2 < all * k / size)) sum += load[c++];
        cut[k] = c;
    }
}

/* The heaviest slab's load over the mean. */
static inline double ranks_imbalance(const double *load, int size, const int32_t *cut)
{
    double all = 0, most = 0;
    int32_t c;
    int k;
    for (k = 0; k < size; k++) {
        double sum = 0;
        for (c = cut[k]; c < cut[k + 1]; c++) sum += load[c];
        all += sum;
        most = sum > most ? sum : most;
    }
    return all > 0 ? most / all * size : 1;
}

/* ---- the world of a rank --------------------------------------------------------------------- */

/* The grid of this rank: its slab, the halo, and a cell for ghosts to move in. */
static inline mpm_desc ranks_desc(const ranks *r)
{
    const int32_t cells = r->whole.cells[r->axis], beyond = r->halo + 1;
    const int32_t low = r->cut[r->rank] > beyond ? r->cut[r->rank] - beyond : 0;
    const int32_t high = r->cut[r->rank + 1] + beyond < cells ? r->cut[r->rank + 1] + beyond : cells;
    mpm_desc d = r->whole;
    d.origin[r->axis] += (mpm_real)low * d.cell;
    d.cells[r->axis] = high - low;
    if (low > 0) d.side[2 * r->axis] = MPM_SIDE_OPEN;
    if (high < cells) d.side[2 * r->axis + 1] = MPM_SIDE_OPEN;
    d.points = d.nodes = 0;
    return d;
}

/* n points of no meaning in the middle of the grid, for the body; they are told what they are later. */
static inline mpm_status ranks_blanks(mpm_world *w, int32_t body, const mpm_body_desc *b, int32_t n)
{
    mpm_real *x[3] = {NULL, NULL, NULL};
    mpm_cloud c;
    mpm_status s = MPM_ERR_MEMORY;
    int32_t i;
    int a;
    memset(&c, 0, sizeof c);
    c.count = n;
    for (a = 0; a < 3; a++) {
        const mpm_real middle = w->desc.origin[a] + (mpm_real)w->desc.cells[a] * w->desc.cell / 2;
        c.x[a] = x[a] = (mpm_real *)malloc((size_t)n * sizeof(mpm_real));
        for (i = 0; x[a] && i < n; i++) x[a][i] = middle;
    }
    if (x[0] && x[1] && x[2]) s = b ? mpm_body_add_points(w, b, &c) : mpm_points_add(w, body, &c);
    for (a = 0; a < 3; a++) free(x[a]);
    return s;
}

/* What a body is in the whole: its mass and faces are not those of the points here. */
static inline void ranks_bodies(const ranks *r, mpm_world *w)
{
    int32_t b;
    for (b = 0; b < w->bodies; b++) {
        mpm_body *of = &w->body[b];
        const int32_t first = of->first, count = of->count, active = of->active;
        *of = r->body[b];
        of->first = first;
        of->count = count;
        of->active = active;
    }
}

/* A body of the records h[from .. to - 1], and some places behind them. */
static inline mpm_status ranks_body(const ranks *r, mpm_world *w, int32_t body, const ranks_heap *h, int32_t from,
                                    int32_t to)
{
    mpm_body_desc d = r->body[body].desc;
    const int32_t n = to - from, count = n + n / 16 + 8;
    mpm_status s;
    int32_t i, first;
    d.absorb = 0; /* a body of given points has no faces of its own: ranks_bodies brings them */
    if ((s = ranks_blanks(w, body, &d, count)) != MPM_OK) return s;
    first = w->body[body].first;
    w->body[body].active = n;
    for (i = 0; i < count; i++)
        if (i < n) ranks_put(w, first + i, h, from + i, r->record);
        else ranks_park(w, first + i);
    return MPM_OK;
}

/* What the world counts, and what laws and user fields it has, from `old` to `w`. */
static inline mpm_status ranks_inherit(mpm_world *w, const mpm_world *old)
{
    mpm_status s = MPM_OK;
    int f;
    int32_t k;
    for (f = 0; f < MPM_USER_FIELDS; f++)
        if (old->user_name[f] && mpm_field_take(w, old->user_name[f]) < 0) s = w->fault.status;
    for (k = 0; k < old->rules && s == MPM_OK; k++)
        s = mpm_contact_set(w, old->rule[k].a, old->rule[k].b, &old->rule[k].contact);
    w->time = old->time;
    w->dt = old->dt;
    w->dt_last = old->dt_last;
    w->steps = old->steps;
    w->notices = old->notices;
    w->next_id = old->next_id;
    w->ledger = old->ledger;
    memcpy(w->tally, old->tally, sizeof w->tally);
    return s;
}

/* Makes *w anew of records that this rank carries, sorted by body. On failure *w is as it was. */
static inline mpm_status ranks_build(ranks *r, mpm_world *w, const ranks_heap *h)
{
    const mpm_desc d = ranks_desc(r);
    mpm_world fresh;
    mpm_status s = mpm_init(&fresh, &d, NULL, 0);
    int32_t b, k = 0, from;
    if (s == MPM_OK) s = ranks_inherit(&fresh, w);
    for (b = 0; b < r->bodies && s == MPM_OK; b++) {
        for (from = k; k < h->count && ranks_head(h, k, r->record)[0] == b; k++) {}
        s = ranks_body(r, &fresh, b, h, from, k);
    }
    if (s != MPM_OK) {
        w->fault = fresh.fault;
        mpm_free(&fresh);
        return s;
    }
    fresh.next_id = w->next_id;
    ranks_bodies(r, &fresh);
    for (b = 0; b < r->bodies; b++) r->active[b] = fresh.body[b].active;
    for (k = 0; k < fresh.points.count; k++)
        if (!ranks_owns(r, r->rank, ranks_cell(r, fresh.points.x[r->axis][k]))) fresh.points.flags[k] |= RANKS_GHOST;
    mpm_free(w);
    *w = fresh;
    return MPM_OK;
}

/* ---- setting up ------------------------------------------------------------------------------ */

/* Why a scene cannot be cut so; NULL: it can. */
static inline const char *ranks_refuse(const ranks *r, const mpm_world *w)
{
    if (w->desc.calm > 0) return "desc.calm solves for the whole grid: not with several ranks";
    if ((int64_t)r->size * r->halo > w->desc.cells[r->axis]) return "slabs would be thinner than the halo: fewer ranks";
    return NULL;
}

/* Points per cell of the axis, of all ranks. */
static inline void ranks_load(const ranks *r, const mpm_world *w, double *load)
{
    int32_t b, i;
    memset(load, 0, (size_t)r->whole.cells[r->axis] * sizeof *load);
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++)
            if (!(w->points.flags[i] & RANKS_GHOST)) load[ranks_cell(r, w->points.x[r->axis][i])] += 1;
}

static inline void ranks_end(ranks *r)
{
    int k;
    for (k = 0; k < 2; k++) {
        free(r->out[k].data);
        free(r->in[k].data);
    }
    free(r->gone.data);
    free(r->cut);
    free(r->body);
    free(r->active);
    MPI_Type_free(&r->kind);
    memset(r, 0, sizeof *r);
}

/* Records of all that this rank carries, out of a world; all of it with every = 1. 0 without memory. */
static inline int ranks_take(const ranks *r, const mpm_world *w, int every, ranks_heap *h)
{
    int32_t b, i;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++)
            if (!(w->points.flags[i] & RANKS_GHOST) &&
                (every || ranks_carries(r, r->rank, ranks_cell(r, w->points.x[r->axis][i]))) &&
                !ranks_push(h, w, b, i, r->record))
                return 0;
    return 1;
}

/* Room for the cuts and the bodies of the whole. */
static inline int ranks_hold(ranks *r, const mpm_world *w)
{
    const size_t bodies = (size_t)w->bodies;
    r->cut = (int32_t *)malloc((size_t)(r->size + 1) * sizeof *r->cut);
    r->body = (mpm_body *)malloc(bodies * sizeof *r->body);
    r->active = (int32_t *)malloc(bodies * sizeof *r->active);
    if (!r->cut || !r->body || !r->active) return 0;
    memcpy(r->body, w->body, bodies * sizeof *r->body);
    return 1;
}

/* Cuts a whole world, the same on every rank, before its first step: *w becomes this rank's part. Cuts lie across the
   longest direction. Returns 1, or 0 with a message; then *w is as it was. */
static inline int ranks_begin(ranks *r, MPI_Comm comm, mpm_world *w, char *message, size_t n)
{
    ranks_heap mine = {NULL, 0, 0};
    const char *why;
    double *load;
    int a, ok = 0;
    memset(r, 0, sizeof *r);
    r->comm = comm;
    MPI_Comm_rank(comm, &r->rank);
    MPI_Comm_size(comm, &r->size);
    r->whole = w->desc;
    r->bodies = w->bodies;
    r->halo = ranks_halo(w->desc.basis);
    r->uneven = 1.1;
    r->record = 4 * sizeof(int32_t) + (size_t)w->fields * sizeof(mpm_real);
    MPI_Type_contiguous((int)r->record, MPI_BYTE, &r->kind);
    MPI_Type_commit(&r->kind);
    for (a = 0; a < 3; a++)
        if (w->desc.cells[a] > w->desc.cells[r->axis] && (a != 1 || w->desc.geometry == MPM_3D)) r->axis = a;
    why = ranks_refuse(r, w);
    load = (double *)malloc((size_t)r->whole.cells[r->axis] * sizeof *load);
    if (!why && load && ranks_hold(r, w)) {
        ranks_load(r, w, load);
        ranks_share(load, r->whole.cells[r->axis], r->halo, r->size, r->cut);
        ok = ranks_take(r, w, 0, &mine) && ranks_build(r, w, &mine) == MPM_OK;
    }
    snprintf(message, n, "%s", why ? why : ok ? "" : "no memory for the parts");
    free(load);
    free(mine.data);
    if (!ok) ranks_end(r);
    return ok;
}

/* ---- after a step ---------------------------------------------------------------------------- */

/* Points that mpm_locate has retired lie behind those in use: what was owned is kept in `gone`. */
static inline int ranks_retired(ranks *r, mpm_world *w)
{
    int32_t b, i;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first + w->body[b].active; i < w->body[b].first + r->active[b]; i++) {
            if (!(w->points.flags[i] & RANKS_GHOST) && !ranks_push(&r->gone, w, b, i, r->record)) return 0;
            ranks_park(w, i);
        }
    return 1;
}

/* The neighbour below (0) or above (1), or nobody. */
static inline int ranks_neighbour(const ranks *r, int side)
{
    const int other = r->rank + 2 * side - 1;
    return other >= 0 && other < r->size ? other : MPI_PROC_NULL;
}

/* Marks what is stale, and packs for the neighbours what they carry of the points owned here. */
static inline int ranks_pack(ranks *r, mpm_world *w)
{
    uint8_t *flags = w->points.flags;
    int32_t b, i;
    int side;
    r->out[0].count = r->out[1].count = 0;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            const int32_t cell = ranks_cell(r, w->points.x[r->axis][i]);
            if (flags[i] & RANKS_GHOST) {
                flags[i] |= RANKS_STALE;
                continue;
            }
            for (side = 0; side < 2; side++) {
                const int other = ranks_neighbour(r, side);
                if (other != MPI_PROC_NULL && ranks_carries(r, other, cell) &&
                    !ranks_push(&r->out[side], w, b, i, r->record))
                    return 0;
            }
            if (!ranks_owns(r, r->rank, cell)) flags[i] |= RANKS_GHOST;
            if (!ranks_carries(r, r->rank, cell)) flags[i] |= RANKS_STALE;
        }
    return 1;
}

/* Tells the neighbours how many records will come, and makes room for theirs. 0 without memory. */
static inline int ranks_announce(ranks *r)
{
    int32_t coming[2] = {0, 0};
    MPI_Request wait[4];
    int side, ok = 1;
    for (side = 0; side < 2; side++) {
        MPI_Irecv(&coming[side], 1, MPI_INT32_T, ranks_neighbour(r, side), 0, r->comm, &wait[2 * side]);
        MPI_Isend(&r->out[side].count, 1, MPI_INT32_T, ranks_neighbour(r, side), 0, r->comm, &wait[2 * side + 1]);
    }
    MPI_Waitall(4, wait, MPI_STATUSES_IGNORE);
    for (side = 0; side < 2; side++) {
        r->in[side].count = 0;
        ok = ranks_room(&r->in[side], coming[side], r->record) && ok;
        r->in[side].count = coming[side];
    }
    return ok;
}

/* Sends out[] to the neighbours, gets in[] from them: numbers first, then records. */
static inline int ranks_swap(ranks *r)
{
    const double begun = MPI_Wtime();
    MPI_Request wait[4];
    int side;
    if (!ranks_announce(r)) return 0;
    for (side = 0; side < 2; side++) {
        const ranks_heap *in = &r->in[side], *out = &r->out[side];
        MPI_Irecv(in->data, in->count, r->kind, ranks_neighbour(r, side), 1, r->comm, &wait[2 * side]);
        MPI_Isend(out->data, out->count, r->kind, ranks_neighbour(r, side), 1, r->comm, &wait[2 * side + 1]);
        r->sent += (int64_t)out->count * (int64_t)r->record;
    }
    MPI_Waitall(4, wait, MPI_STATUSES_IGNORE);
    r->waited += MPI_Wtime() - begun;
    return 1;
}

/* Where in[side] has the records of a body that are not put yet: at[side] .. end[side] - 1. */
typedef struct ranks_queue {
    int32_t at[2], end[2];
} ranks_queue;

static inline void ranks_next(const ranks *r, int32_t body, ranks_queue *q)
{
    int side;
    for (side = 0; side < 2; side++)
        for (q->at[side] = q->end[side];
             q->end[side] < r->in[side].count && ranks_head(&r->in[side], q->end[side], r->record)[0] == body;)
            q->end[side]++;
}

/* The next record of the queue over point i, of that side if there is one. 0: there is none. */
static inline int ranks_fill(const ranks *r, mpm_world *w, int32_t i, int side, ranks_queue *q)
{
    if (q->at[side] == q->end[side]) side = 1 - side;
    if (q->at[side] == q->end[side]) return 0;
    ranks_put(w, i, &r->in[side], q->at[side]++, r->record);
    if (!ranks_owns(r, r->rank, ranks_cell(r, w->points.x[r->axis][i]))) w->points.flags[i] |= RANKS_GHOST;
    return 1;
}

/* Opens places behind the points of a body for what will not fit. */
static inline mpm_status ranks_widen(ranks *r, mpm_world *w, int32_t body, int32_t want)
{
    mpm_body *b = &w->body[body];
    const int32_t free_ones = b->count - b->active, more = want + b->count / 16 + 8, active = b->active;
    const int32_t next = w->next_id;
    mpm_status s;
    int32_t i;
    if (want <= free_ones) return MPM_OK;
    if ((s = ranks_blanks(w, body, NULL, more)) != MPM_OK) return s;
    b = &w->body[body];
    for (i = b->first + active; i < b->first + active + more; i++) ranks_park(w, i);
    b->active = active;
    w->next_id = next;
    ranks_bodies(r, w);
    return MPM_OK;
}

/* Records over stale points, on the side where they lie; then behind the others; stale ones that are left make room. */
static inline void ranks_unpack(ranks *r, mpm_world *w, int32_t body, ranks_queue *q)
{
    mpm_body *b = &w->body[body];
    const int32_t middle = (r->cut[r->rank] + r->cut[r->rank + 1]) / 2;
    int32_t i, last;
    for (i = b->first; i < b->first + b->active; i++)
        if (w->points.flags[i] & RANKS_STALE)
            ranks_fill(r, w, i, ranks_cell(r, w->points.x[r->axis][i]) >= middle, q);
    while (ranks_fill(r, w, b->first + b->active, 0, q)) b->active++;
    for (i = b->first; i < b->first + b->active; i++)
        while (i < b->first + b->active && (w->points.flags[i] & RANKS_STALE)) {
            last = b->first + --b->active;
            if (i < last) ranks_copy(w, last, i);
            ranks_park(w, last);
        }
    r->active[body] = b->active;
}

/* After each step. MPM_ERR_MEMORY, here alone: end with MPI_Abort. */
static inline mpm_status ranks_exchange(ranks *r, mpm_world *w)
{
    ranks_queue q;
    mpm_status s = MPM_OK;
    int32_t b;
    if (r->size == 1) return MPM_OK;
    if (!ranks_retired(r, w) || !ranks_pack(r, w) || !ranks_swap(r)) return MPM_ERR_MEMORY;
    memset(&q, 0, sizeof q);
    for (b = 0; b < w->bodies && s == MPM_OK; b++) {
        ranks_next(r, b, &q);
        s = ranks_widen(r, w, b, q.end[0] - q.at[0] + q.end[1] - q.at[1]);
        if (s == MPM_OK) ranks_unpack(r, w, b, &q);
    }
    return s;
}

/* ---- moving the cuts ------------------------------------------------------------------------- */

/* Sorts records by body, in order. 0 without memory. */
static inline int ranks_sort(ranks_heap *h, int32_t bodies, size_t record)
{
    ranks_heap sorted = {NULL, 0, 0};
    int32_t b, k;
    if (!ranks_room(&sorted, h->count, record)) return 0;
    for (b = 0; b < bodies; b++)
        for (k = 0; k < h->count; k++)
            if (ranks_head(h, k, record)[0] == b)
                memcpy(sorted.data + (size_t)sorted.count++ * record, h->data + (size_t)k * record, record);
    free(h->data);
    *h = sorted;
    return 1;
}

/* Owned points for each rank that carries them by the cuts: count[k] records for rank k, from record at[k] on. 0
   without memory. */
static inline int ranks_pack_all(const ranks *r, const mpm_world *w, ranks_heap *out, int *count, int *at)
{
    int32_t b, i;
    int k;
    for (k = 0; k < r->size; k++) {
        at[k] = out->count;
        for (b = 0; b < w->bodies; b++)
            for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++)
                if (!(w->points.flags[i] & RANKS_GHOST) &&
                    ranks_carries(r, k, ranks_cell(r, w->points.x[r->axis][i])) && !ranks_push(out, w, b, i, r->record))
                    return 0;
        count[k] = out->count - at[k];
    }
    return 1;
}

/* Every owned point to all ranks that carry it by the cuts: *mine gets what this one does. 0 without memory: end with
   MPI_Abort, since the others wait. */
static inline int ranks_spread(ranks *r, const mpm_world *w, ranks_heap *mine)
{
    const size_t size = (size_t)r->size;
    int *count = (int *)calloc(4 * size, sizeof *count);
    ranks_heap out = {NULL, 0, 0};
    int k, ok = count && ranks_pack_all(r, w, &out, count, count + size);
    if (ok) {
        int *from = count + 2 * size, *to = count + 3 * size, sum = 0;
        MPI_Alltoall(count, 1, MPI_INT, from, 1, MPI_INT, r->comm);
        for (k = 0; k < r->size; k++) {
            to[k] = sum;
            sum += from[k];
        }
        if ((ok = ranks_room(mine, sum, r->record)) != 0)
            MPI_Alltoallv(out.data, count, count + size, r->kind, mine->data, from, to, r->kind, r->comm);
        mine->count = ok ? sum : 0;
    }
    free(out.data);
    free(count);
    return ok && ranks_sort(mine, w->bodies, r->record);
}

/* Moves the cuts where a slab has too many points and new cuts do better. All ranks together. */
static inline mpm_status ranks_balance(ranks *r, mpm_world *w)
{
    const int32_t cells = r->whole.cells[r->axis];
    double *load = (double *)malloc((size_t)cells * sizeof *load), now, then;
    double *all = (double *)malloc((size_t)cells * sizeof *all);
    int32_t *cut = (int32_t *)malloc((size_t)(r->size + 1) * sizeof *cut), *old = r->cut;
    ranks_heap mine = {NULL, 0, 0};
    mpm_status s = load && all && cut ? MPM_OK : MPM_ERR_MEMORY;
    if (s == MPM_OK) {
        ranks_load(r, w, load);
        MPI_Allreduce(load, all, cells, MPI_DOUBLE, MPI_SUM, r->comm);
        ranks_share(all, cells, r->halo, r->size, cut);
        now = ranks_imbalance(all, r->size, r->cut);
        then = ranks_imbalance(all, r->size, cut);
        if (now > r->uneven && then < 0.99 * now) {
            r->cut = cut;
            cut = old;
            r->moves++;
            s = ranks_spread(r, w, &mine) ? ranks_build(r, w, &mine) : MPM_ERR_MEMORY;
        }
    }
    free(mine.data);
    free(cut);
    free(load);
    free(all);
    return s;
}

/* ---- sums and collecting --------------------------------------------------------------------- */

/* What the whole world has: sums over owned points, and those that left the grid. */
typedef struct ranks_totals {
    double mass, momentum[3], kinetic, internal, points, ghosts;
} ranks_totals;
#define RANKS_SUMS 8 /* of them */

/* Adds a value to a sum and its rounding error (Neumaier). */
static inline void ranks_add(double *sum, double value)
{
    const double t = sum[0] + value;
    sum[1] += fabs(sum[0]) >= fabs(value) ? sum[0] - t + value : value - t + sum[0];
    sum[0] = t;
}

/* Mass, momentum and energies of one point, given as its fields one after another, to the sums. */
static inline void ranks_count(const mpm_world *w, const mpm_real *value, double sum[RANKS_SUMS][2])
{
    const mpm_points *p = &w->points;
    const double m = (double)value[(size_t)(p->mass - w->field) / w->stride];
    double v2 = 0;
    int k;
    for (k = 0; k < 3; k++) {
        const double v = (double)value[(size_t)(p->v[k] - w->field) / w->stride];
        ranks_add(sum[1 + k], m * v);
        v2 += v * v;
    }
    ranks_add(sum[0], m);
    ranks_add(sum[4], m * v2 / 2);
    ranks_add(sum[5], m * (double)value[(size_t)(p->energy - w->field) / w->stride]);
    sum[6][0] += 1;
}

/* Of all ranks together, the same on each. The order of the sums depends on the ranks: equal to round-off. */
static inline ranks_totals ranks_sums(const ranks *r, const mpm_world *w)
{
    double sum[RANKS_SUMS][2], one[RANKS_SUMS], all[RANKS_SUMS];
    mpm_real *value = (mpm_real *)malloc(r->record);
    ranks_totals t;
    int32_t b, i;
    int k;
    memset(sum, 0, sizeof sum);
    for (b = 0; b < w->bodies && value; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            for (k = 0; k < w->fields; k++) value[k] = w->field[(size_t)k * w->stride + (size_t)i];
            if (w->points.flags[i] & RANKS_GHOST) sum[7][0] += 1;
            else ranks_count(w, value, sum);
        }
    for (i = 0; i < r->gone.count; i++) ranks_count(w, ranks_values(&r->gone, i, r->record), sum);
    free(value);
    for (k = 0; k < RANKS_SUMS; k++) one[k] = sum[k][0] + sum[k][1];
    MPI_Allreduce(one, all, RANKS_SUMS, MPI_DOUBLE, MPI_SUM, r->comm);
    t.mass = all[0];
    for (k = 0; k < 3; k++) t.momentum[k] = all[1 + k];
    t.kinetic = all[4];
    t.internal = all[5];
    t.points = all[6];
    t.ghosts = all[7];
    return t;
}

/* Every point that this rank owns, those that left the grid behind the others. 0 without memory. */
static inline int ranks_owned(const ranks *r, const mpm_world *w, ranks_heap *mine)
{
    if (!ranks_take(r, w, 1, mine) || !ranks_room(mine, r->gone.count + 1, r->record)) return 0;
    if (r->gone.count > 0)
        memcpy(mine->data + (size_t)mine->count * r->record, r->gone.data, (size_t)r->gone.count * r->record);
    mine->count += r->gone.count;
    return 1;
}

/* These of all ranks to rank 0: *all there, nothing elsewhere. 0, on all ranks, where one of them has no memory. */
static inline int ranks_collect(const ranks *r, const mpm_world *w, ranks_heap *all)
{
    ranks_heap mine = {NULL, 0, 0};
    int *count = (int *)calloc(2 * (size_t)r->size, sizeof *count), *at = NULL, k, sum = 0;
    int ok = ranks_all(r, count && ranks_owned(r, w, &mine));
    if (ok) {
        const int n = mine.count;
        at = count + r->size;
        MPI_Gather(&n, 1, MPI_INT, count, 1, MPI_INT, 0, r->comm);
        for (k = 0; k < r->size; k++) { /* all 0 but on rank 0 */
            at[k] = sum;
            sum += count[k];
        }
        ok = ranks_all(r, ranks_room(all, sum, r->record));
    }
    if (ok) MPI_Gatherv(mine.data, mine.count, r->kind, all->data, count, at, r->kind, 0, r->comm);
    all->count = ok ? sum : 0;
    free(mine.data);
    free(count);
    return ok;
}

/* Records over the points of the same number in a whole world as it was built. */
static inline void ranks_into(const ranks *r, const ranks_heap *h, mpm_world *w)
{
    int32_t k;
    for (k = 0; k < h->count; k++) ranks_put(w, ranks_head(h, k, r->record)[1], h, k, r->record);
}

#endif
