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

   The loop in draw() is the method with a grip in it. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_history.h"
#include "impact_options.h"
#include "output.h"

/* What to do after the impact. */
typedef struct pull_case {
    double velocity, ramp, sample, distance; /* m/s, ns, ns, um */
    double grip;                             /* um: height of the particle's cap that is gripped */
    const char *folder;
    int quiet;
} pull_case;

/* Samples of the pull, for the table and the curve. */
typedef struct curve {
    mpm_real *separation, *stress; /* um, MPa */
    size_t count, room;
} curve;

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

/* Draws the bodies apart until they have parted or the way is done, a row of the table per sample. */
static int draw(impact *s, const pull_case *o, mpm_pull *p, mpm_io_csv *table, curve *c, history *past)
{
    mpm_world *w = &s->world;
    const int whole = impact_copies(s);
    double gripped = 0; /* momentum that the grip gave the particle since the last row of the history */
    mpm_interface met;
    progress line;
    progress_begin(&line, o->quiet);
    do {
        progress_part(&line, "pull, if they do not part before:", p->separation / o->distance);
        if (history_due(past, w->steps, INT64_MAX)) {
            impact_history_sample(past, s);
            impact_history_push(past, s, gripped);
            gripped = 0;
        }
        if (mpm_locate(w, s->dt) < 0) return report(&w->fault, "locate");
        mpm_calm(w);
        mpm_p2g(w);
        mpm_forces(w);
        if (hold(s, p) < 0) return report(&w->fault, "contact");
        if (mpm_pull_apply(p, w)) { /* the grips give their nodes their velocity */
            met = meet(s);
            c->separation[c->count] = (mpm_real)p->separation;
            c->stress[c->count++] = (mpm_real)(p->force / p->desc.area);
            mpm_io_csv_real(table, (mpm_real)(p->time * 1e3));
            mpm_io_csv_real(table, (mpm_real)p->separation);
            mpm_io_csv_real(table, (mpm_real)(p->force * whole));
            mpm_io_csv_real(table, (mpm_real)(p->grip_force * whole));
            mpm_io_csv_real(table, (mpm_real)(p->force / p->desc.area));
            mpm_io_csv_integer(table, met.nodes);
            mpm_io_csv_integer(table, met.bonded);
            mpm_io_csv_integer(table, met.held);
            if (met.nodes == 0) break;
        }
        gripped += p->grip[0].impulse[2];
        mpm_g2p(w);
        mpm_musl(w);
        if (mpm_stress(w) < 0) return report(&w->fault, "stress");
        if (s->surfaces.surfaces > 0 && mpm_surface_move(&s->surfaces, w) < 0)
            return report(&s->surfaces.fault, "surfaces");
        mpm_move(w);
    } while (p->separation < o->distance && c->count < c->room);
    progress_end(&line);
    return 1;
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
static int write_picture(const impact *s, const impact_case *c, const pull_case *o, const mpm_pull *p, const curve *k)
{
    mpm_draw_plot_desc plot = mpm_draw_plot_desc_default();
    mpm_draw_curve line;
    mpm_draw_canvas canvas;
    output_picture section;
    mpm_fault fault;
    char path[PATH_BYTES];
    int ok;
    describe_picture(s, c, o, p, &section);
    line.name = NULL;
    line.count = k->count;
    line.x = k->separation;
    line.y = k->stress;
    line.mark = MPM_DRAW_CURVE;
    line.color = 0;
    plot.curves = &line;
    plot.curve_count = 1;
    plot.title = "nominal stress";
    plot.x_label = "way of the grip (um)";
    plot.y_label = "stress (MPa)";
    if (mpm_draw_canvas_init(&canvas, 1500, 700, NULL, 0) != MPM_OK) return complain("no memory for the picture");
    file_in(o->folder, "pull.png", path, sizeof path);
    ok = mpm_draw_cut(&canvas, mpm_draw_tile(&canvas, 2, 1, 0), &section.cut[0], &fault) >= 0 &&
         (k->count < 2 || mpm_draw_plot(&canvas, mpm_draw_tile(&canvas, 2, 1, 1), &plot, &fault) >= 0) &&
         mpm_io_png(path, canvas.rgb, canvas.width, canvas.height, "mpm.h examples/pull", &fault) >= 0;
    mpm_draw_canvas_free(&canvas);
    return ok || report(&fault, path);
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

/* The history of both, which ends when the grip's way is done; or before, when the bodies part. */
static void remember(history *past, const impact *s, const pull_case *o)
{
    const double ns = o->ramp + o->distance / o->velocity * 1e3;
    impact_history_begin(past, s->steps + (int64_t)(ns * 1e-3 / (double)s->dt));
}

/* The impact. Returns 1, or 0 after a message. */
static int strike(impact *s, const pull_case *o, history *past)
{
    progress line;
    progress_begin(&line, o->quiet);
    while (s->world.steps < s->steps) {
        if (history_due(past, s->world.steps, INT64_MAX)) impact_history_sample(past, s);
        if (impact_step(s) < 0) return report(&s->world.fault, "impact");
        progress_part(&line, "impact", (double)s->world.steps / (double)s->steps);
    }
    progress_end(&line);
    return 1;
}

/* Impact and pull. The world is that of s; c gets room for the samples. */
static int run(impact *s, const impact_case *ic, const pull_case *o, curve *c, const option *options, int n)
{
    mpm_interface met;
    impact_result r;
    mpm_io_csv table;
    mpm_fault fault;
    mpm_pull p;
    history past;
    char path[PATH_BYTES], grip[80];
    int drawn;
    remember(&past, s, o);
    if (!strike(s, o, &past)) return 0;
    r = impact_measure(s, ic);
    met = meet(s);
    memset(&p, 0, sizeof p);
    snprintf(grip, sizeof grip, "--grip %g, which leaves nothing to draw at", o->grip);
    if (met.area > 0 && describe(&p, s, ic, o, &met, &fault) != MPM_OK) return report(&fault, grip);
    if (mpm_io_csv_begin(&table, file_in(o->folder, "pull.csv", path, sizeof path),
                         "time_ns,way_um,force_uN,grip_force_uN,stress_MPa,nodes_met,nodes_bonded,nodes_held",
                         "pull: forces of the whole particle", &fault) < 0)
        return report(&fault, path);
    drawn = met.area > 0 ? draw(s, o, &p, &table, c, &past) : 1; /* without contact the particle has left: strength 0 */
    if (mpm_io_csv_end(&table, &fault) < 0) return report(&fault, path);
    if (!drawn) return 0;
    if (!write_summary(s, o, &r, &met, &p, options, n) || !write_picture(s, ic, o, &p, c)) return 0;
    if (!history_csv(&past, o->folder) || !impact_history_png(&past, o->folder, "impact and pull")) return 0;
    if (!o->quiet)
        printf("strength %.4g MPa: %.4g uN over %.4g um2 of contact (%.4g um2 at bonded nodes)\n"
               "PBCP %.3g %%, work %.4g pJ over %.3g um; see %s/summary.json, pull.csv, pull.png, history.csv\n",
               p.peak_stress, p.peak_force * impact_copies(s), met.area * impact_copies(s),
               met.bonded_area * impact_copies(s), r.bond.pbcp, p.work * impact_copies(s), p.separation, o->folder);
    return 1;
}

static int carry_out(int argc, char **argv)
{
    const int surface = !strcmp(impact_method(argc, argv, "thesis"), "surface");
    impact_case c = surface ? impact_case_surface() : impact_case_default();
    pull_case o = {20, 20, 5, 4, 3, "build/pull-out", 0};
    option options[IMPACT_OPTIONS];
    int n = impact_options(&c, options);
    char message[300];
    mpm_fault fault;
    curve k;
    impact s;
    int parsed, ok;
    option_add(options, &n, "pull-velocity", OPTION_REAL, &o.velocity, "of the upper grip, m/s");
    option_add(options, &n, "ramp", OPTION_REAL, &o.ramp, "time to reach it, ns");
    option_add(options, &n, "sample", OPTION_REAL, &o.sample, "time over which the force is averaged, ns");
    option_add(options, &n, "distance", OPTION_REAL, &o.distance, "way of the grip, unless the bodies part before, um");
    option_add(options, &n, "grip", OPTION_REAL, &o.grip, "height of the particle's cap that is gripped, um");
    option_add(options, &n, "out", OPTION_TEXT, &o.folder, "output folder");
    option_add(options, &n, "quiet", OPTION_FLAG, &o.quiet, "print nothing");
    c.geometry = "axisymmetric";
    if (!surface) {
        c.cell = 1;
        c.spacing = 0.25;
    }
    parsed = options_parse(argc, argv, "A metal particle hits a plate and is drawn off it again: the bond's strength.",
                           options, n);
    if (parsed) return parsed < 0 ? 1 : 0;
    impact_complete(&c);
    if (!check(&o, message, sizeof message) || !impact_begin(&s, &c, message, sizeof message)) {
        complain(message);
        return 1;
    }
    k.count = 0;
    k.room = (size_t)(o.distance / o.velocity * 1e3 / o.sample + o.ramp / o.sample) + 2;
    k.separation = (mpm_real *)malloc(k.room * sizeof *k.separation);
    k.stress = (mpm_real *)malloc(k.room * sizeof *k.stress);
    ok = (k.separation && k.stress) || complain("no memory");
    ok = ok && (mpm_io_make_directory(o.folder, &fault) >= 0 || report(&fault, o.folder));
    ok = ok && run(&s, &c, &o, &k, options, n);
    free(k.separation);
    free(k.stress);
    impact_end(&s);
    return ok ? 0 : 1;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
