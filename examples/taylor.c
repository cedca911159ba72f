/* taylor - a metal cylinder hits a rigid wall end on (Taylor's test).

   The defaults are the benchmark that codes compare on: copper, 32.4 mm long, 6.4 mm in diameter, at
   227 m/s, flow stress 400 + 100 eps MPa, 80 us. Published: length 21.42 - 21.43 mm, foot radius
   7.12 - 7.23 mm. Expect 21.43 and 7.19 mm in about a quarter of a minute. The OFHC copper of Johnson
   and Cook's experiment (14.80 and 8.40 mm):
     taylor --length 23.47 --diameter 7.62 --velocity 210 --model jc --wall contact

   The loop in run() is the method, one call per phase. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "taylor_history.h"
#include "report.h"
#include "restart.h"

/* Colours: pressure to a tenth of what the first shock makes, which is gone at once; stress to twice what the metal
   bears at a strain of 1 at a thousand per second. */
static output_range colors(const taylor *s, const taylor_case *c)
{
    const mpm_material *m = &s->material;
    const mpm_material_state flows = {1, 1, m->temperature, m->density, 0};
    output_range r = {3, 0, 0, 0, 0, 0};
    mpm_real p, shear;
    mpm_material_wave_speeds(m, m->density, &p, &shear);
    r.cold = c->temperature;
    r.hot = c->temperature + 500;
    r.pressure = mpm_draw_nice((double)(m->density * p) * c->velocity / 10);
    r.mises = 2 * mpm_draw_nice(fmax((double)mpm_material_flow_stress(m, &flows), 1));
    r.speed = c->velocity;
    return r;
}

/* "cu linear, 227 m/s" */
static void write_title(const taylor_case *c, char *title, size_t n)
{
    snprintf(title, n, "%s %s, %g m/s", c->material, c->model, c->velocity);
}

/* The section through the axis, or the bar from outside. Returns 1, or 0 after a message. */
static int describe_picture(const taylor *s, const taylor_case *c, const output *o, output_picture *p)
{
    const output_range r = colors(s, c);
    if (!output_fields(o, &s->world, s->spacing, &r, p)) return 0;
    output_window(p, 2.6 * s->radius, -0.03 * s->length, 1.05 * s->length);
    write_title(c, p->title, sizeof p->title);
    return 1;
}

/* With the places at which the points began. */
static int write_frame(const taylor *s, const taylor_case *c, const page *sheet, output *o)
{
    const mpm_world *w = &s->world;
    mpm_io_field start[2];
    output_picture p;
    int k, ok;
    for (k = 0; k < 2; k++) start[k] = mpm_io_scalar(w->user_name[k], w->points.user[k], 1);
    if (!page_frame(sheet, o, w, NULL)) return 0;
    ok = describe_picture(s, c, o, &p) && output_frame(o, w, start, 2, &p);
    output_picture_free(&p);
    return ok;
}

/* The last picture, with the sizes that codes compare if the run came to its end; the film; the curves. */
static int write_pictures(const taylor *s, const taylor_case *c, const taylor_result *r, output *o,
                          const history *past)
{
    output_picture p;
    char title[160];
    int ok = describe_picture(s, c, o, &p);
    write_title(c, title, sizeof title);
    if (s->world.steps >= s->steps)
        snprintf(p.title, sizeof p.title, "%.90s: %.2f mm long, foot %.2f mm", title, r->length, r->radius);
    ok = ok && output_png(o, &p, "taylor.png") && output_film(o, title) &&
         taylor_history_png(past, o->folder, p.title);
    output_picture_free(&p);
    return ok;
}

/* report.html, behind the summary and the picture. */
static int write_page(const taylor *s, const taylor_case *c, const taylor_result *r, const output *o,
                      const history *past, page_desc d)
{
    static const page_row row[] = {
        {"final_length_mm", "length", "mm", 3, 1, "height of the far end"},
        {"final_radius_mm", "radius of the foot", "mm", 3, 1, "the largest of the side"},
        {"eps_max", "largest plastic strain", "", 3, 1, "of any point"},
        {"eps_mean", "mean plastic strain", "", 4, 0, "weighted by mass"},
        {"temperature_max", "hottest point", "K", 0, 1, "no heat is conducted"},
        {"v_mean_m_s", "mean velocity", "m/s", 2, 0, "away from the wall"},
        {"energy_wall_fraction", "lost at the wall", "", 4, 0, "of the energy at the start"},
        {"energy_unaccounted", "energy unaccounted", "", 5, 0, "of it, what no account of the ledger explains"},
        {"momentum_error", "momentum error", "", PAGE_TINY, 0, "relative; round-off is some 1e-13"},
        {"points", "points", "", 0, 0, "material points of the model"}, {"steps", "steps", "", 0, 0, "of time"}};
    char verdict[120], lead[300], title[160];
    write_title(c, title, sizeof title);
    snprintf(verdict, sizeof verdict, "The bar is %.2f mm long, the radius of its foot %.2f mm.", r->length, r->radius);
    snprintf(lead, sizeof lead, "A bar of %s, %g mm long and %g mm across, hits a rigid wall at %g m/s; this is after "
             "%.4g " PAGE_MU "s.", c->material, c->length, c->diameter, c->velocity, (double)s->world.time * 1e3);
    d.program = "taylor";
    d.title = title;
    d.verdict = verdict;
    d.lead = lead;
    d.good = 1;
    d.row = row;
    d.rows = (int)(sizeof row / sizeof *row);
    d.past = past;
    d.world = &s->world;
    d.length = o->length;
    d.time = o->time;
    d.spacing = s->spacing;
    d.picture = o->frames > 0 ? "taylor.png" : NULL;
    return page_write(&d, o->folder);
}

static int write_profile(const taylor *s, const taylor_row *row, const output *o)
{
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_csv t;
    mpm_real value[3];
    long k;
    file_in(o->folder, "profile.csv", path, sizeof path);
    mpm_io_csv_begin(&t, path, "start_z_mm,z_mm,radius_mm", NULL, &fault);
    for (k = 0; k < taylor_rows(s); k++) {
        value[0] = (mpm_real)row[k].start;
        value[1] = (mpm_real)row[k].z;
        value[2] = (mpm_real)row[k].radius;
        mpm_io_csv_row(&t, value);
    }
    return mpm_io_csv_end(&t, &fault) >= 0 ? 1 : report(&fault, path);
}

static int write_summary(const taylor *s, const taylor_result *r, const output *o, const option *options, int n)
{
    const mpm_world *w = &s->world;
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_json j;
    mpm_io_json_begin(&j, file_in(o->folder, "summary.json", path, sizeof path), &fault);
    mpm_io_json_number(&j, "final_length_mm", r->length);
    mpm_io_json_number(&j, "final_radius_mm", r->radius);
    mpm_io_json_number(&j, "eps_max", r->eps_max);
    mpm_io_json_number(&j, "eps_mean", r->eps_mean);
    mpm_io_json_number(&j, "temperature_max", r->temperature_max);
    mpm_io_json_number(&j, "v_mean_m_s", r->velocity);
    mpm_io_json_number(&j, "mass_error", r->mass_error);
    mpm_io_json_number(&j, "momentum_error", r->momentum_error);
    mpm_io_json_number(&j, "energy_error", r->energy_error);
    mpm_io_json_number(&j, "energy_unaccounted", r->energy_unaccounted);
    mpm_io_json_number(&j, "energy_wall_fraction", w->ledger.walls / s->start.kinetic);
    mpm_io_json_number(&j, "cell_used_mm", s->cell);
    mpm_io_json_number(&j, "spacing_used_mm", s->spacing);
    mpm_io_json_integer(&j, "points", w->points.count);
    mpm_io_json_integer(&j, "retired_points", w->retired);
    mpm_io_json_integer(&j, "steps", w->steps);
    mpm_io_json_number(&j, "dt_us", (double)s->dt * 1e3);
    mpm_io_json_number(&j, "time_us", (double)w->time * 1e3);
    mpm_io_json_number(&j, "cpu_seconds", o->cpu);
    options_json(&j, options, n);
    if (mpm_io_json_end(&j, &fault) < 0) return report(&fault, path);
    return 1;
}

static void print_table(const taylor *s, const taylor_case *c, const taylor_result *r, double cpu)
{
    const mpm_world *w = &s->world;
    printf("\n  %s (%s), %g x %g mm at %g m/s after %.4g us\n\n", c->material, c->model, c->length, c->diameter,
           c->velocity, (double)w->time * 1e3);
    printf("  length                 %10.3f mm\n", r->length);
    printf("  radius of the foot     %10.3f mm\n", r->radius);
    printf("  largest plastic strain %10.3f     mean %.4f\n", r->eps_max, r->eps_mean);
    printf("  highest temperature    %10.1f K\n", r->temperature_max);
    printf("  mean velocity          %10.3f m/s\n", r->velocity);
    printf("  errors: mass %.1e, momentum %.1e, energy unaccounted %.3f %%\n", r->mass_error, r->momentum_error,
           100 * r->energy_unaccounted);
    printf("  %d points, %lld retired, %lld steps of %.4g ns, %.1f s CPU\n", (int)w->points.count,
           (long long)w->retired, (long long)w->steps, (double)s->dt * 1e6, cpu);
}

/* Time integration: one call per phase. Returns 1; 0 after a message; -1 when stopped before, with a checkpoint. */
static int run(taylor *s, const taylor_case *c, const page *sheet, output *o, restart *again)
{
    mpm_world *w = &s->world;
    int status = 1;
    output_start(o, w);
    for (;;) {
        if (history_due(again->past, w->steps, s->steps) && !taylor_history_sample(again->past, s, c)) return 0;
        if (output_due(o, w, s->steps) && !write_frame(s, c, sheet, o)) return 0;
        if (w->steps >= s->steps) break;
        if ((status = restart_goes_on(again)) <= 0) break;

        if (mpm_locate(w, s->dt) < 0) return report(&w->fault, "locate"); /* points in cell order, their nodes */
        mpm_p2g(w);                          /* mass and momentum to the nodes */
        mpm_forces(w);                       /* of the stress */
        mpm_grid_update(w);                  /* nodal momentum; the wall acts here */
        mpm_g2p(w);                          /* velocity of the points */
        mpm_musl(w);                         /* nodal velocity from it */
        if (mpm_stress(w) < 0) return report(&w->fault, "stress"); /* strain, density, stress */
        mpm_move(w);                         /* position of the points */

        output_progress(o, w, s->steps);
    }
    output_progress_end(o);
    output_cpu(o);
    return status;
}

/* Everything that is written at the end, or where the run is stopped. */
static int finish(const taylor *s, const taylor_case *c, const page *sheet, output *o, const history *past,
                  page_desc d)
{
    taylor_row *row = (taylor_row *)malloc((size_t)taylor_rows(s) * sizeof *row);
    taylor_result r;
    int ok = row && taylor_measure(s, c, row, &r);
    if (!ok) complain("no memory for the profile");
    ok = ok && write_summary(s, &r, o, d.option, d.options) && write_profile(s, row, o) && history_csv(past, o->folder);
    if (ok && o->frames > 0) ok = write_pictures(s, c, &r, o, past);
    if (ok && sheet->on) ok = write_page(s, c, &r, o, past, d);
    if (ok && !o->quiet) {
        print_table(s, c, &r, o->cpu);
        printf("\n  %s/%ssummary.json, profile.csv, history.csv%s\n", o->folder, sheet->on ? "report.html, " : "",
               o->frames > 1   ? ", history.png, taylor.png, film.png, taylor.pvd"
               : o->frames > 0 ? ", history.png, taylor.png, taylor.pvd" : "");
    }
    free(row);
    return ok;
}

static int options_of(taylor_case *c, option *o)
{
    int n = 0;
    option_add(o, &n, "length", OPTION_REAL, &c->length, "mm");
    option_add(o, &n, "diameter", OPTION_REAL, &c->diameter, "mm");
    option_add(o, &n, "velocity", OPTION_REAL, &c->velocity, "impact velocity, m/s");
    option_add(o, &n, "temperature", OPTION_REAL, &c->temperature, "at the start, K");
    option_add(o, &n, "material", OPTION_TEXT, &c->material, "preset; build/material --list shows them");
    option_add_word(o, &n, "model", &c->model, MPM_NAMES(MPM_STRENGTH_LIST), "strength");
    option_add_word(o, &n, "wall", &c->wall, TAYLOR_WALLS, "the foot stays on it, or it may leave");
    option_add(o, &n, "friction", OPTION_REAL, &c->friction, "Coulomb coefficient of a wall in contact");
    option_add_word(o, &n, "geometry", &c->geometry, TAYLOR_GEOMETRIES, "in 3D a quarter");
    option_add_word(o, &n, "functions", &c->functions, MPM_NAMES(MPM_BASIS_LIST), "shape functions");
    option_add(o, &n, "cell", OPTION_REAL, &c->cell, "grid cell edge, mm");
    option_add(o, &n, "spacing", OPTION_REAL, &c->spacing, "distance of material points, mm");
    option_add(o, &n, "time", OPTION_REAL, &c->time, "simulated time, us");
    option_add(o, &n, "dt-factor", OPTION_REAL, &c->dt_factor, "time step over the critical step of the cell");
    return n;
}

static int carry_out(int argc, char **argv)
{
    taylor_case c = taylor_case_default();
    output o = output_of("build/taylor-out", "taylor", "mm", "us", 1e-3);
    option options[28];
    restart again;
    history past;
    page sheet;
    int n = options_of(&c, options), of_case = n, of_run, parsed, status, place;
    const char *about = "A metal cylinder hits a rigid wall end on: Taylor's test.\n"
                        "Writes report.html, summary.json, profile.csv, history.csv, history.png, taylor.png,\n"
                        "film.png, taylor.pvd (ParaView) and frames.";
    char message[300];
    taylor s;
    memset(&again, 0, sizeof again);
    output_options(&o, options, &n);
    output_picture_options(&o, options, &n);
    page_options(&sheet, options, &n);
    of_run = n;
    restart_options(&again, options, &n);
    parsed = options_parse(argc, argv, about, options, n);
    if (parsed) return parsed < 0 ? 1 : 0;
    place = word_place(TAYLOR_GEOMETRIES, c.geometry); /* an unknown one is refused later */
    if (!output_check(&o, message, sizeof message) || !restart_check(&again, message, sizeof message) ||
        !page_check(&sheet, message, sizeof message) ||
        !output_picture_check(&o, place == 1 ? MPM_3D : MPM_AXISYMMETRIC, message, sizeof message) ||
        !taylor_begin(&s, &c, message, sizeof message))
        return !complain(message);
    taylor_history_begin(&past, &s);
    restart_describe(&again, &s.world, NULL, &o, &s.start, &past, s.dt, options, of_case);
    status = restart_begin(&again, s.steps) && page_begin(&sheet, &o, s.spacing) ? run(&s, &c, &sheet, &o, &again) : 0;
    if (status != 0 && !finish(&s, &c, &sheet, &o, &past, page_of(options, of_run, argc, argv))) status = 0;
    if (status < 0) print_again(argc, argv, "--resume", (long long)s.world.steps, (long long)s.steps);
    if (status > 0) {
        restart_end(&again);
        page_end(&sheet, o.folder);
    }
    mpm_free(&s.world);
    return status > 0 ? 0 : status < 0 ? STOPPED : 1;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
