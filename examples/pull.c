/* pull - how strong is the bond? An impact (impact_case.h), then the particle is drawn off its substrate.

   The bond stays as the impact left it: D neither grows nor falls, and a node that holds never lets go.
   So what gives way is the material around the bonded nodes: the strength is how much of the contact
   bonded, times the flow stress there, an upper bound for a bond as strong as the metal. Stress is nominal:
   tension between the bodies over the area where the grid has both at the end of the impact.

   Expect (defaults, axisymmetric, half a minute): 300 MPa at 810 m/s, of 296 um2 in contact 135 um2 at
   bonded nodes, a ring at the crater's wall; nothing at 700 m/s and with --bond none, where the particle
   has left. The answer is no number to design with: 501, 300, 230 MPa with cells of 1.5, 1, 0.7 um, for a
   bonded node binds a cell on either side; 131 MPa in 3D (cell 1.5 um: 28 um2 at bonded nodes, where in
   rings 130 bond at once); 259 and 470 MPa at 900 and 1000 m/s; and it rises with the grip's speed (448, 501,
   531 MPa at 10, 20, 40 m/s, cell 1.5 um), as the metal's strength does. Source A names bond strength as an
   aim (chapter 4) and prints no number.

   The loop in draw() is the method with a grip in it. Ctrl-C and SIGTERM end impact or pull with a checkpoint, from
   which --resume goes on to the same bytes. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_history.h"
#include "impact_options.h"
#include "output.h"
#include "restart.h"

/* What to do after the impact. */
typedef struct pull_case {
    double velocity, ramp, sample, distance; /* m/s, ns, ns, um */
    double grip;                             /* um: height of the particle's cap that is gripped */
    const char *folder;
    int quiet;
} pull_case;

/* A row of the table per sample: its columns. */
enum { TIME, WAY, FORCE, GRIP_FORCE, STRESS, NODES_MET, NODES_BONDED, NODES_HELD, COLUMNS };

typedef struct curve {
    double (*row)[COLUMNS];
    mpm_real *separation, *stress; /* um, MPa: two of the columns, to be drawn */
    size_t room;
} curve;

/* How far it is; with the world and the rows of the curve all that the next step asks for. */
typedef struct pull_state {
    int drawing;           /* 0: the impact; 1: the pull */
    int64_t rows;
    double gripped;        /* momentum that the grip gave the particle since the last row of the history */
    mpm_interface met;     /* at the end of the impact */
    impact_result struck;
    mpm_pull pull;
} pull_state;

/* Everything of a run. */
typedef struct job {
    const impact_case *impact_case;
    const pull_case *o;
    impact *s;
    curve c;
    history past;
    pull_state at;
    output out;
    restart again;
} job;

static int check(const pull_case *c, char *m, size_t n)
{
    return case_wants(c->velocity > 0 && c->velocity < 1e4, "pull-velocity", c->velocity, "must be > 0 m/s", m, n) &&
           case_wants(c->ramp >= 0 && c->ramp < 1e9, "ramp", c->ramp, "must be >= 0 ns", m, n) &&
           case_wants(c->sample > 0 && c->sample < 1e9, "sample", c->sample, "must be > 0 ns", m, n) &&
           case_wants(c->distance > 0 && c->distance < 1e6, "distance", c->distance, "must be > 0 um", m, n) &&
           case_wants((c->distance / c->velocity * 1e3 + c->ramp) / c->sample < 1e6, "sample", c->sample,
                      "too many of them", m, n) &&
           case_wants(c->grip > 0 && c->grip < 1e6, "grip", c->grip, "must be in (0, 1e6) um", m, n);
}

/* The pull that follows the impact s, whose bodies meet at `met`. */
static mpm_status describe(mpm_pull *p, const impact *s, const impact_case *c, const pull_case *o,
                           const mpm_interface *met, mpm_fault *fault)
{
    mpm_pull_desc d = mpm_pull_desc_default();
    d.upper = IMPACT_PARTICLE;
    d.lower = IMPACT_SUBSTRATE;
    d.above = (mpm_real)(mpm_splat_measure(&s->world, d.upper, d.lower, 60).top - o->grip);
    d.below = (mpm_real)(-c->substrate_height + c->cell);
    d.velocity = (mpm_real)o->velocity;
    d.ramp = (mpm_real)(o->ramp * 1e-3);
    d.sample = (mpm_real)(o->sample * 1e-3);
    d.area = met->area;
    return mpm_pull_begin(p, &s->world, &d, fault);
}

/* How the bodies meet: at nodes, or on their surfaces, where what once touched is the area. */
static mpm_interface meet(const impact *s)
{
    mpm_interface r;
    mpm_meeting m;
    if (s->surfaces.surfaces == 0) return mpm_interface_of(&s->world, IMPACT_PARTICLE, IMPACT_SUBSTRATE);
    m = mpm_surface_meets(&s->surfaces, &s->world, IMPACT_PARTICLE, IMPACT_SUBSTRATE);
    memset(&r, 0, sizeof r);
    r.area = m.touched;
    r.bonded_area = m.bonded;
    r.nodes = m.bonded > 0 || m.area > 0;
    r.bonded = m.bonded > 0;
    r.held = s->world.held > 0;
    return r;
}

/* Contact of this step on the grid; the bond is made, mpm_bond_grow is left out. What it draws at goes to the pull. */
static mpm_status hold(impact *s, mpm_pull *p)
{
    mpm_world *w = &s->world;
    mpm_meeting m;
    if (s->surfaces.surfaces > 0) {
        if (mpm_surface_contact(&s->surfaces, w) < 0) return (w->fault = s->surfaces.fault).status;
        m = mpm_surface_meets(&s->surfaces, w, IMPACT_PARTICLE, IMPACT_SUBSTRATE);
        mpm_pull_tension(p, w, -(m.force[2] + m.pull[2]));
        mpm_grid_update(w);
        return MPM_OK;
    }
    mpm_grid_update(w);
    mpm_contact_find(w);
    mpm_bond_nodes(&s->bond, w);
    mpm_contact_apply(w);
    return MPM_OK;
}

/* The sample that is complete becomes a row. Returns how many nodes, or contacts on surfaces, the bodies meet at. */
static long take_row(job *j)
{
    const mpm_pull *p = &j->at.pull;
    const int whole = impact_copies(j->s);
    const mpm_interface met = meet(j->s);
    double *row = j->c.row[j->at.rows++];
    row[TIME] = p->time * 1e3;
    row[WAY] = p->separation;
    row[FORCE] = p->force * whole;
    row[GRIP_FORCE] = p->grip_force * whole;
    row[STRESS] = p->force / p->desc.area;
    row[NODES_MET] = (double)met.nodes;
    row[NODES_BONDED] = (double)met.bonded;
    row[NODES_HELD] = (double)met.held;
    return met.nodes;
}

/* A row of the history, when it is due. */
static void remember_pull(job *j)
{
    if (!history_due(&j->past, j->s->world.steps, INT64_MAX)) return;
    impact_history_sample(&j->past, j->s);
    impact_history_push(&j->past, j->s, j->at.gripped);
    j->at.gripped = 0;
}

/* Draws the bodies apart until they have parted or the way is done. Returns as strike(). */
static int draw(job *j)
{
    impact *s = j->s;
    mpm_world *w = &s->world;
    mpm_pull *p = &j->at.pull;
    int status = 1;
    while (p->separation < j->o->distance && (size_t)j->at.rows < j->c.room) {
        if ((status = restart_goes_on(&j->again)) <= 0) break;
        progress_part(&j->out.line, "pull, if they do not part before:", p->separation / j->o->distance);
        remember_pull(j);
        if (mpm_locate(w, s->dt) < 0) return report(&w->fault, "locate");
        mpm_calm(w);
        mpm_p2g(w);
        mpm_forces(w);
        if (hold(s, p) < 0) return report(&w->fault, "contact");
        if (mpm_pull_apply(p, w) && take_row(j) == 0) break; /* the grips give their nodes their velocity */
        j->at.gripped += p->grip[0].impulse[2];
        mpm_g2p(w);
        mpm_musl(w);
        if (mpm_stress(w) < 0) return report(&w->fault, "stress");
        if (s->surfaces.surfaces > 0 && mpm_surface_move(&s->surfaces, w) < 0)
            return report(&s->surfaces.fault, "surfaces");
        mpm_move(w);
    }
    return status;
}

/* The section at the end of the pull: room for the particle as it was, whatever its shape, and for its way. */
static void describe_picture(const impact *s, const impact_case *c, const pull_case *o, const mpm_pull *p,
                             output_picture *picture)
{
    const output out = output_of(o->folder, "pull", "um", "ns", 1);
    output_bodies(&out, &s->world, c->spacing, picture);
    output_window(picture, 1.1 * c->substrate_diameter / 2, -1.05 * c->substrate_height,
                  2.2 * impact_half_height(c) + p->separation);
    snprintf(picture->title, sizeof picture->title, "%g um at %g m/s, drawn off", c->diameter, c->velocity);
    snprintf(picture->time, sizeof picture->time, "at %.2f um", p->separation);
}

/* That section beside the curve of the pull. */
static int write_picture(job *j)
{
    mpm_draw_plot_desc plot = mpm_draw_plot_desc_default();
    mpm_draw_curve line;
    mpm_draw_canvas canvas;
    output_picture section;
    mpm_fault fault;
    char path[PATH_BYTES];
    int64_t i;
    int ok;
    describe_picture(j->s, j->impact_case, j->o, &j->at.pull, &section);
    for (i = 0; i < j->at.rows; i++) {
        j->c.separation[i] = (mpm_real)j->c.row[i][WAY];
        j->c.stress[i] = (mpm_real)j->c.row[i][STRESS];
    }
    line.name = NULL;
    line.count = (size_t)j->at.rows;
    line.x = j->c.separation;
    line.y = j->c.stress;
    line.mark = MPM_DRAW_CURVE;
    line.color = 0;
    plot.curves = &line;
    plot.curve_count = 1;
    plot.title = "nominal stress";
    plot.x_label = "way of the grip (um)";
    plot.y_label = "stress (MPa)";
    if (mpm_draw_canvas_init(&canvas, 1500, 700, NULL, 0) != MPM_OK) return complain("no memory for the picture");
    file_in(j->o->folder, "pull.png", path, sizeof path);
    ok = mpm_draw_cut(&canvas, mpm_draw_tile(&canvas, 2, 1, 0), &section.cut[0], &fault) >= 0 &&
         (j->at.rows < 2 || mpm_draw_plot(&canvas, mpm_draw_tile(&canvas, 2, 1, 1), &plot, &fault) >= 0) &&
         mpm_io_png(path, canvas.rgb, canvas.width, canvas.height, "mpm.h examples/pull", &fault) >= 0;
    mpm_draw_canvas_free(&canvas);
    return ok || report(&fault, path);
}

static int write_table(const job *j)
{
    mpm_io_csv table;
    mpm_fault fault;
    char path[PATH_BYTES];
    int64_t i;
    int k;
    if (mpm_io_csv_begin(&table, file_in(j->o->folder, "pull.csv", path, sizeof path),
                         "time_ns,way_um,force_uN,grip_force_uN,stress_MPa,nodes_met,nodes_bonded,nodes_held",
                         NULL, &fault) < 0)
        return report(&fault, path);
    for (i = 0; i < j->at.rows; i++)
        for (k = 0; k < COLUMNS; k++) {
            if (k < NODES_MET) mpm_io_csv_real(&table, (mpm_real)j->c.row[i][k]);
            else mpm_io_csv_integer(&table, (long long)j->c.row[i][k]);
        }
    return mpm_io_csv_end(&table, &fault) >= 0 || report(&fault, path);
}

static int write_summary(const impact *s, const pull_case *o, const impact_result *r, const mpm_interface *met,
                         const mpm_pull *p, const option *options, int n)
{
    const int whole = impact_copies(s);
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_json j;
    mpm_io_json_begin(&j, file_in(o->folder, "summary.json", path, sizeof path), &fault);
    mpm_io_json_number(&j, "strength_MPa", p->peak_stress);
    mpm_io_json_number(&j, "peak_force_uN", p->peak_force * whole);
    mpm_io_json_number(&j, "peak_way_um", p->peak_separation);
    mpm_io_json_number(&j, "contact_area_um2", met->area * whole);
    mpm_io_json_number(&j, "bonded_node_area_um2", met->bonded_area * whole);
    mpm_io_json_number(&j, "work_pJ", p->work * whole);
    mpm_io_json_number(&j, "end_way_um", p->separation);
    mpm_io_json_number(&j, "end_stress_MPa", p->desc.area > 0 ? p->force / p->desc.area : 0);
    mpm_io_json_integer(&j, "samples", p->samples);
    mpm_io_json_integer(&j, "steps", s->world.steps);
    mpm_io_json_open(&j, "impact");
    mpm_io_json_number(&j, "pbcp_percent", r->bond.pbcp);
    mpm_io_json_number(&j, "v_rest_relative_m_s", r->relative);
    mpm_io_json_number(&j, "contacted_surface_um2", r->contact_area);
    mpm_io_json_number(&j, "bonded_surface_um2", r->bonded_area);
    mpm_io_json_integer(&j, "nodes_met", met->nodes);
    mpm_io_json_integer(&j, "nodes_bonded", met->bonded);
    mpm_io_json_close(&j);
    options_json(&j, options, n);
    return mpm_io_json_end(&j, &fault) >= 0 || report(&fault, path);
}

/* Steps of both; fewer when the bodies part before the grip's way is done. */
static int64_t planned(const impact *s, const pull_case *o)
{
    const double ns = o->ramp + o->distance / o->velocity * 1e3;
    return s->steps + (int64_t)(ns * 1e-3 / (double)s->dt);
}

/* The impact. Returns 1; 0 after a message; -1 when stopped before its end, with a checkpoint. */
static int strike(job *j)
{
    impact *s = j->s;
    int status;
    while (s->world.steps < s->steps) {
        if ((status = restart_goes_on(&j->again)) <= 0) return status;
        if (history_due(&j->past, s->world.steps, INT64_MAX)) impact_history_sample(&j->past, s);
        if (impact_step(s) < 0) return report(&s->world.fault, "impact");
        progress_part(&j->out.line, "impact", (double)s->world.steps / (double)s->steps);
    }
    return 1;
}

/* From the impact to the pull. */
static int grip(job *j)
{
    mpm_fault fault;
    char name[80];
    j->at.struck = impact_measure(j->s, j->impact_case);
    j->at.met = meet(j->s);
    j->at.drawing = 1;
    snprintf(name, sizeof name, "--grip %g, which leaves nothing to draw at", j->o->grip);
    if (!(j->at.met.area > 0)) return 1; /* without contact the particle has left: strength 0 */
    return describe(&j->at.pull, j->s, j->impact_case, j->o, &j->at.met, &fault) == MPM_OK || report(&fault, name);
}

/* Impact and pull, or what is left of them. Returns as strike(). */
static int run(job *j)
{
    int status = 1;
    output_start(&j->out, &j->s->world);
    if (!j->at.drawing) {
        status = strike(j);
        progress_end(&j->out.line);
        if (status <= 0) return status;
        if (!grip(j)) return 0;
        progress_begin(&j->out.line, j->o->quiet);
    }
    if (j->at.met.area > 0) status = draw(j);
    progress_end(&j->out.line);
    return status;
}

/* Everything that is written at the end, or where the run is stopped. */
static int finish(job *j, const option *options, int n)
{
    const mpm_pull *p = &j->at.pull;
    const int whole = impact_copies(j->s);
    if (!j->at.drawing) j->at.struck = impact_measure(j->s, j->impact_case);
    if (!write_table(j) || !write_summary(j->s, j->o, &j->at.struck, &j->at.met, p, options, n) || !write_picture(j) ||
        !history_csv(&j->past, j->o->folder) || !impact_history_png(&j->past, j->o->folder, "impact and pull"))
        return 0;
    if (j->o->quiet || !j->at.drawing) return 1;
    printf("strength %.4g MPa: %.4g uN over %.4g um2 of contact (%.4g um2 at bonded nodes)\n"
           "PBCP %.3g %%, work %.4g pJ over %.3g um; see %s/summary.json, pull.csv, pull.png, history.csv\n",
           p->peak_stress, p->peak_force * whole, j->at.met.area * whole, j->at.met.bonded_area * whole,
           j->at.struck.bond.pbcp, p->work * whole, p->separation, j->o->folder);
    return 1;
}

/* Room for the samples. */
static int begin_curve(curve *c, const pull_case *o)
{
    c->room = (size_t)(o->distance / o->velocity * 1e3 / o->sample + o->ramp / o->sample) + 2;
    c->row = (double (*)[COLUMNS])calloc(c->room, sizeof *c->row);
    c->separation = (mpm_real *)malloc(c->room * sizeof *c->separation);
    c->stress = (mpm_real *)malloc(c->room * sizeof *c->stress);
    return (c->row && c->separation && c->stress) || complain("no memory");
}

/* What a checkpoint holds; of_case options make the run. */
static void describe_restart(job *j, const option *options, int of_case)
{
    restart_describe(&j->again, &j->s->world, &j->s->surfaces, &j->out, &j->s->start, &j->past, j->s->dt, options,
                     of_case);
    restart_also(&j->again, "pull", &j->at, sizeof j->at);
    restart_also(&j->again, "samples", j->c.row, j->c.room * sizeof *j->c.row);
}

/* A checkpoint is of this run, but is what stands in it possible? */
static int goes_on(const job *j)
{
    const int64_t rows = j->at.rows;
    return (rows >= 0 && (size_t)rows <= j->c.room) ||
           complain("checkpoint.bin: its samples are more than there can be");
}

/* The run that is described. Returns as strike(). */
static int carry_on(job *j, const option *options, int of_case, int of_run)
{
    int status;
    impact_history_begin(&j->past, planned(j->s, j->o));
    describe_restart(j, options, of_case);
    status = restart_begin(&j->again, planned(j->s, j->o)) && goes_on(j) ? run(j) : 0;
    if (status != 0 && !finish(j, options, of_run)) status = 0;
    if (status > 0) restart_end(&j->again);
    return status;
}

static int carry_out(int argc, char **argv)
{
    const int surface = !strcmp(impact_method(argc, argv, "thesis"), "surface");
    static job j; /* it holds the history */
    impact_case c = surface ? impact_case_surface() : impact_case_default();
    pull_case o = {20, 20, 5, 4, 3, "build/pull-out", 0};
    option options[IMPACT_OPTIONS];
    int n = impact_options(&c, options), of_case, of_run, parsed, status;
    char message[300];
    impact s;
    option_add(options, &n, "pull-velocity", OPTION_REAL, &o.velocity, "of the upper grip, m/s");
    option_add(options, &n, "ramp", OPTION_REAL, &o.ramp, "time to reach it, ns");
    option_add(options, &n, "sample", OPTION_REAL, &o.sample, "time over which the force is averaged, ns");
    option_add(options, &n, "distance", OPTION_REAL, &o.distance, "way of the grip, unless the bodies part before, um");
    option_add(options, &n, "grip", OPTION_REAL, &o.grip, "height of the particle's cap that is gripped, um");
    of_case = n;
    option_add(options, &n, "out", OPTION_TEXT, &o.folder, "output folder");
    option_add(options, &n, "quiet", OPTION_FLAG, &o.quiet, "print nothing");
    of_run = n;
    restart_options(&j.again, options, &n);
    c.geometry = "axisymmetric";
    if (!surface) {
        c.cell = 1;
        c.spacing = 0.25;
    }
    parsed = options_parse(argc, argv, "A metal particle hits a plate and is drawn off it again: the bond's strength.\n"
                           "Writes summary.json, pull.csv, pull.png, history.csv and history.png into the output\n"
                           "folder.", options, n);
    if (parsed) return parsed < 0 ? 1 : 0;
    impact_complete(&c);
    if (!check(&o, message, sizeof message) || !restart_check(&j.again, message, sizeof message) ||
        !impact_begin(&s, &c, message, sizeof message))
        return !complain(message);
    j.impact_case = &c;
    j.o = &o;
    j.s = &s;
    j.out = output_of(o.folder, "pull", "um", "ns", 1);
    j.out.frames = 0;
    j.out.quiet = o.quiet;
    status = begin_curve(&j.c, &o) ? carry_on(&j, options, of_case, of_run) : 0;
    if (status < 0) print_again(argc, argv, "--resume", (long long)s.world.steps, (long long)planned(&s, &o));
    free(j.c.row);
    free(j.c.separation);
    free(j.c.stress);
    impact_end(&s);
    return status > 0 ? 0 : status < 0 ? STOPPED : 1;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
