/* many_particles with MPI - the scene of examples/studies/many_particles.c, a slab of it per rank.

     mpirun -n 4 build/mpi/many_particles --count 10          with the options of build/many_particles

   The same fates and tables as the serial program writes; sums of mass, momentum and energy agree to round-off,
   whatever the number of ranks. Every rank builds the whole scene once and keeps its part, one rank after the other;
   the last step is made by rank 0 alone, on the whole. Contact at nodes only (--method thesis).
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "particles_case.h"
#include "ranks_files.h"

/* How the ranks work together. */
typedef struct many {
    ranks r;
    int64_t balance;    /* steps between looks at the balance */
    double uneven;      /* see ranks */
    double checkpoint;  /* seconds between checkpoints */
    int resume;
    double saved;       /* when the last was written */
    char text[40000];   /* what a checkpoint is of */
} many;

#define MANY_LOOK 16 /* steps between questions whether to stop or to save */

/* What must be the same for ranks that go on. */
static void describe(many *m, const particles_case *q, const particles_random *p, const impact *s)
{
    impact_case c = q->base;
    option o[IMPACT_OPTIONS];
    size_t used = 0;
    const int n = impact_options(&c, o);
    int k;
    for (k = 0; k < n; k++) {
        char number[OPTION_NUMBER];
        used = mpm_io_line(m->text, sizeof m->text, used, o[k].name, option_text(&o[k], number));
    }
    used = mpm_io_line_number(m->text, sizeof m->text, used, "count", (double)q->count);
    used = mpm_io_line_number(m->text, sizeof m->text, used, "spread", p->spread);
    used = mpm_io_line_number(m->text, sizeof m->text, used, "height", p->height);
    used = mpm_io_line_number(m->text, sizeof m->text, used, "seed", (double)p->seed);
    used = mpm_io_line_number(m->text, sizeof m->text, used, "frames", (double)q->out.frames);
    mpm_io_line_number(m->text, sizeof m->text, used, "dt", (double)s->dt);
}

/* Whether all ranks did it; if not, the first that did not has *mine 1: what it says is enough. */
static int all_did(int rank, int ok, int *mine)
{
    int size, failed;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    failed = ok ? size : rank;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    *mine = failed == rank;
    return failed == size;
}

/* Builds the scene and cuts it, one rank after the other: whole scenes need memory. Returns 1, or 0 on all ranks after
   a message of the first that could not. */
static int begin(many *m, particles_case *q, impact *s)
{
    char message[400] = "";
    int rank, size, k, ok = 1, mine;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    for (k = 0; k < size; k++) {
        if (k == rank)
            ok = particles_begin(s, q, message, sizeof message) &&
                 ranks_begin(&m->r, MPI_COMM_WORLD, &s->world, message, sizeof message);
        MPI_Barrier(MPI_COMM_WORLD);
    }
    return all_did(rank, ok, &mine) || (mine ? complain(message) : 0);
}

/* Rank 0 makes the folder or says what is wrong; all go on from a checkpoint, if there is one and it is wanted. */
static int prepare(many *m, particles_case *q, impact *s)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    int pieces = 0, found = ranks_saved(q->out.folder, &pieces) >= 0, mine;
    MPI_Bcast(&found, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (found && m->resume) {
        const int ok = ranks_resume(&m->r, &s->world, q->out.folder, m->text, &q->out.frame, &fault);
        if (!all_did(m->r.rank, ok, &mine)) return mine ? report(&fault, "checkpoint") : 0;
        if (m->r.rank == 0 && !q->out.quiet)
            printf("going on from step %lld of %lld, of %d ranks\n", (long long)s->world.steps, (long long)s->steps,
                   pieces);
        return 1;
    }
    if (m->r.rank > 0) return ranks_all(&m->r, 1);
    if (m->resume && !q->out.quiet) printf("no checkpoint in %s: from the start\n", q->out.folder);
    remove(file_in(q->out.folder, "ranks.json", path, sizeof path));
    return ranks_all(&m->r, output_begin(&q->out));
}

/* Whether to go on: 1; -1: stop here, with a checkpoint; 0 after a message. All ranks agree. */
static int goes_on(many *m, particles_case *q, impact *s)
{
    int ask[2] = {0, 0};
    const int64_t made = s->world.steps - q->out.first;
    if (made % MANY_LOOK && !(q->stop_after > 0 && made >= q->stop_after)) return 1;
    ask[0] = stop_asked() || (q->stop_after > 0 && made >= q->stop_after);
    ask[1] = m->r.rank == 0 && m->checkpoint > 0 && MPI_Wtime() - m->saved > m->checkpoint;
    MPI_Allreduce(MPI_IN_PLACE, ask, 2, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (!ask[0] && !ask[1]) return 1;
    m->saved = MPI_Wtime();
    if (!ranks_save(&m->r, &s->world, q->out.folder, m->text, q->out.frame)) return 0;
    return ask[0] ? -1 : 1;
}

/* One step of all ranks. An error on one of them ends the job. */
static void step(many *m, impact *s)
{
    mpm_world *w = &s->world;
    mpm_status status = impact_step(s);
    if (status < 0) {
        report(&w->fault, "step");
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    status = ranks_exchange(&m->r, w);
    if (status >= 0 && m->balance > 0 && w->steps % m->balance == 0) status = ranks_balance(&m->r, w);
    if (status >= 0) return;
    complain("no memory for the points of other ranks");
    MPI_Abort(MPI_COMM_WORLD, 1);
}

/* All steps but the last. Returns 1; 0 after a message; -1 when stopped before, with a checkpoint. */
static int run(many *m, particles_case *q, impact *s)
{
    mpm_world *w = &s->world;
    int status = 1;
    stop_listen();
    q->out.quiet |= m->r.rank > 0;
    output_start(&q->out, w);
    m->saved = MPI_Wtime();
    while (status > 0 && w->steps < s->steps - 1) {
        if (output_due(&q->out, w, s->steps) &&
            !ranks_frame(&m->r, w, q->out.folder, q->out.frame++, 1e3 * (double)w->time))
            return 0;
        if ((status = goes_on(m, q, s)) <= 0) break;
        step(m, s);
        output_progress(&q->out, w, s->steps);
    }
    output_progress_end(&q->out);
    output_cpu(&q->out);
    return status;
}

#define ACCOUNT 8 /* columns of ranks.csv behind the rank */

/* What this rank had to do. */
static void account(const many *m, const particles_case *q, const mpm_world *w, double row[ACCOUNT])
{
    const int64_t steps = w->steps - q->out.first;
    double carried = 0, ghosts = 0;
    int32_t i;
    for (i = 0; i < w->bodies; i++) carried += w->body[i].active;
    for (i = 0; i < w->points.count; i++) ghosts += (w->points.flags[i] & RANKS_GHOST) && w->points.mass[i] > 0;
    row[0] = m->r.cut[m->r.rank];
    row[1] = m->r.cut[m->r.rank + 1];
    row[2] = carried - ghosts;
    row[3] = ghosts;
    row[4] = (double)mpm_bytes_used(w);
    row[5] = q->out.cpu;
    row[6] = m->r.waited;
    row[7] = steps > 0 ? (double)m->r.sent / (double)steps : 0;
}

/* ranks.csv, by rank 0: what each rank had to do. Returns 1, or 0 after a message. */
static int ranks_table(const particles_case *q, const double *all, int size)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_csv c;
    int k, f;
    mpm_io_csv_begin(&c, file_in(q->out.folder, "ranks.csv", path, sizeof path),
                     "rank,first_cell,end_cell,points,ghosts,bytes,cpu_s,waited_s,sent_bytes_per_step",
                     NULL, &fault);
    for (k = 0; k < size; k++) {
        mpm_io_csv_integer(&c, k);
        for (f = 0; f < ACCOUNT; f++) mpm_io_csv_real(&c, (mpm_real)all[ACCOUNT * k + f]);
    }
    return mpm_io_csv_end(&c, &fault) >= 0 || report(&fault, path);
}

/* totals.json, by rank 0: the sums over all. Returns 1, or 0 after a message. */
static int totals(const many *m, const particles_case *q, const mpm_world *w, const ranks_totals *t)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_json j;
    mpm_io_json_begin(&j, file_in(q->out.folder, "totals.json", path, sizeof path), &fault);
    mpm_io_json_integer(&j, "ranks", m->r.size);
    mpm_io_json_integer(&j, "steps", w->steps);
    mpm_io_json_integer(&j, "cuts_moved", m->r.moves);
    mpm_io_json_number(&j, "points", t->points);
    mpm_io_json_number(&j, "ghosts", t->ghosts);
    mpm_io_json_number(&j, "mass_ng", t->mass);
    mpm_io_json_number(&j, "momentum_x_ng_m_s", t->momentum[0]);
    mpm_io_json_number(&j, "momentum_y_ng_m_s", t->momentum[1]);
    mpm_io_json_number(&j, "momentum_z_ng_m_s", t->momentum[2]);
    mpm_io_json_number(&j, "kinetic_pJ", t->kinetic);
    mpm_io_json_number(&j, "internal_pJ", t->internal);
    return mpm_io_json_end(&j, &fault) >= 0 || report(&fault, path);
}

/* Both files, all ranks together. Returns 1, or 0 on all ranks after a message of one. */
static int accounts(const many *m, const particles_case *q, const mpm_world *w)
{
    const ranks_totals t = ranks_sums(&m->r, w);
    const size_t size = m->r.rank == 0 ? (size_t)m->r.size : 1;
    double row[ACCOUNT], *all = (double *)malloc(size * sizeof row);
    int ok = ranks_all(&m->r, all || complain("no memory for ranks.csv"));
    if (ok) {
        account(m, q, w, row);
        MPI_Gather(row, ACCOUNT, MPI_DOUBLE, all, ACCOUNT, MPI_DOUBLE, 0, MPI_COMM_WORLD);
        if (m->r.rank == 0) ok = ranks_table(q, all, m->r.size) && totals(m, q, w, &t);
    }
    free(all);
    return ranks_all(&m->r, ok);
}

/* Rank 0 puts the parts together, makes the last step alone, and writes what the serial program writes. The ledger's
   energies are not known there. */
static int finish(many *m, particles_case *q, impact *s, const option *o, int n)
{
    static particle_report r[PARTICLES];
    ranks_heap all = {NULL, 0, 0};
    char message[400], path[PATH_BYTES];
    impact whole;
    int ok;
    if (!accounts(m, q, &s->world)) return 0;
    if (!ranks_collect(&m->r, &s->world, &all))
        return m->r.rank == 0 ? complain("no memory to collect the parts") : 0;
    if (m->r.rank > 0) return 1;
    if (!particles_begin(&whole, q, message, sizeof message)) return complain(message);
    ranks_into(&m->r, &all, &whole.world);
    free(all.data);
    whole.world.steps = s->world.steps;
    whole.world.time = s->world.time;
    whole.world.dt_last = s->world.dt_last;
    whole.world.ledger.absorbed = (double)NAN;
    ok = impact_step(&whole) >= 0 || report(&whole.world.fault, "step");
    if (ok) {
        particles_report(&whole, q, r);
        ok = particles_table(q, r) && particles_pairs(&whole, q) && particles_summary(&whole, q, r, o, n);
    }
    if (ok && q->out.frames > 0) ok = particles_frame(&whole, q);
    if (ok && !q->out.quiet) particles_print(q, r, &whole, "ranks.csv, totals.json");
    if (ok) remove(file_in(q->out.folder, "ranks.json", path, sizeof path));
    impact_end(&whole);
    return ok;
}

static int scene(many *m, particles_case *q, const particles_random *p, const option *o, int n)
{
    impact s;
    int status;
    if (!begin(m, q, &s)) return 1;
    m->r.uneven = m->uneven;
    describe(m, q, p, &s);
    status = prepare(m, q, &s) ? run(m, q, &s) : 0;
    if (status < 0 && m->r.rank == 0)
        printf("stopped at step %lld of %lld; it goes on with --resume, on any number of ranks\n",
               (long long)s.world.steps, (long long)s.steps);
    if (status > 0) status = finish(m, q, &s, o, n);
    ranks_end(&m->r);
    impact_end(&s);
    return status > 0 ? 0 : status < 0 ? STOPPED : 1;
}

static int carry_out(int argc, char **argv, int rank)
{
    static const char about[] =
        "mpirun -n RANKS build/mpi/many_particles: the scene of build/many_particles, a slab per rank.\n"
        "Writes particles.csv, pairs.csv, summary.json, ranks.csv (what each rank had to do), totals.json\n"
        "and particles.pvd (ParaView).";
    static particles_case q;
    static many m;
    static const char *const serial[3] = {"report", "no-report", "hdf5"}; /* of the serial program alone */
    particles_random places = particles_random_default();
    option o[IMPACT_OPTIONS];
    char message[300];
    int n, parsed, k;
    q = particles_many(argc, argv, "build/mpi/many_particles-out");
    m.balance = 200;
    m.uneven = 1.1;
    m.checkpoint = 60;
    n = particles_many_options(&q, &places, o);
    for (k = 0; k < 3; k++) option_drop(o, &n, serial[k]);
    option_add(o, &n, "balance", OPTION_INTEGER, &m.balance,
               "steps between looks at the balance of the slabs; 0: never");
    option_add(o, &n, "uneven", OPTION_REAL, &m.uneven, "points of the fullest slab over the mean at which cuts move");
    option_add(o, &n, "checkpoint", OPTION_REAL, &m.checkpoint, "seconds between checkpoints; 0: none");
    option_add(o, &n, "resume", OPTION_FLAG, &m.resume, "go on from a checkpoint, of any number of ranks");
    parsed = rank == 0 ? options_parse(argc, argv, about, o, n) : 0;
    MPI_Bcast(&parsed, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (parsed || (rank > 0 && options_parse(argc, argv, about, o, n))) return parsed < 0;
    if (strcmp(q.base.method, "thesis")) {
        snprintf(message, sizeof message, "--method %s: contact on surfaces is not cut into ranks", q.base.method);
        return rank == 0 ? !complain(message) : 1;
    }
    if (!case_wants(m.balance >= 0, "balance", (double)m.balance, "must be >= 0", message, sizeof message) ||
        !case_wants(m.uneven >= 1 && m.uneven < 1e3, "uneven", m.uneven, "must be >= 1", message, sizeof message) ||
        !case_wants(m.checkpoint >= 0 && m.checkpoint < 1e9, "checkpoint", m.checkpoint, "must be >= 0 s", message,
                    sizeof message) ||
        !particles_many_place(&q, &places, message, sizeof message))
        return rank == 0 ? !complain(message) : 1;
    return scene(&m, &q, &places, o, n);
}

int main(int argc, char **argv)
{
    int rank = 0, status;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    status = program_end(carry_out(argc, argv, rank));
    MPI_Finalize();
    return status;
}
