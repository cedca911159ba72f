/* taylor - a metal cylinder hits a rigid wall end on (Taylor's test).

   The defaults are the benchmark that codes compare on: copper, 32.4 mm long, 6.4 mm in diameter, at
   227 m/s, flow stress 400 + 100 eps MPa, 80 us. Published: length 21.42 - 21.43 mm, foot radius
   7.12 - 7.23 mm. Expect 21.43 and 7.19 mm in about a quarter of a minute. The OFHC copper of Johnson
   and Cook's experiment (14.80 and 8.40 mm):
     taylor --length 23.47 --diameter 7.62 --velocity 210 --model jc --wall contact

   The loop in run() is the method, one call per phase. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "taylor_case.h"
#include "program.h"

#include <time.h>

typedef struct output {
    const char *folder;
    long frames;
    int quiet;
} output;

/* Two cuts through the axis: plastic strain and temperature. */
static int write_picture(const taylor *s, const taylor_case *c, const char *path)
{
    const mpm_world *w = &s->world;
    mpm_io_cut_desc cut[2];
    mpm_fault fault;
    char time[32], title[96];
    int i;
    snprintf(time, sizeof time, "t = %.1f us", (double)w->time * 1e3);
    snprintf(title, sizeof title, "%s %s, %g m/s", c->material, c->model, c->velocity);
    for (i = 0; i < 2; i++) {
        cut[i] = mpm_io_cut_of(w, i == 0 ? w->points.plastic_strain : w->points.temperature);
        cut[i].at = w->desc.geometry == MPM_3D ? s->spacing / 2 : 0;
        cut[i].mirror = 1;
        cut[i].window[0] = -2.6 * s->radius;
        cut[i].window[1] = 2.6 * s->radius;
        cut[i].window[2] = -0.03 * s->length;
        cut[i].window[3] = 1.05 * s->length;
        cut[i].length_unit = "mm";
        cut[i].time = time;
    }
    cut[0].title = title;
    cut[0].label = "effective plastic strain";
    cut[0].low = 0;
    cut[0].high = 3;
    cut[1].label = "temperature (K)";
    cut[1].map = MPM_IO_HEAT;
    cut[1].low = c->temperature;
    cut[1].high = c->temperature + 500;
    if (mpm_io_cut_png(path, cut, 2, 2, 800, &fault) < 0) return report(&fault, path);
    return 1;
}

/* All that ParaView can show, in mm, m/s, MPa, K. */
static int write_points(const taylor *s, const char *path)
{
    const mpm_points *p = &s->world.points;
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_io_field field[9];
    mpm_fault fault;
    int a;
    field[0] = mpm_io_vector("velocity (m/s)", p->v[0], p->v[1], p->v[2], 1);
    field[1] = mpm_io_tensor("stress (MPa)", p->stress[0], p->stress[1], p->stress[2], p->stress[3], p->stress[4],
                             p->stress[5], 1);
    field[2] = mpm_io_scalar("density (g/cm3)", p->density, 1e3);
    field[3] = mpm_io_scalar("temperature (K)", p->temperature, 1);
    field[4] = mpm_io_scalar("plastic strain", p->plastic_strain, 1);
    field[5] = mpm_io_scalar("plastic strain rate (1/us)", p->plastic_rate, 1e-3);
    field[6] = mpm_io_scalar("plastic energy density (MPa)", p->plastic_work, 1);
    field[7] = mpm_io_scalar("radius at the start (mm)", p->user[0], 1);
    field[8] = mpm_io_scalar("height at the start (mm)", p->user[1], 1);
    d.count = (size_t)p->count;
    for (a = 0; a < 3; a++) d.x[a] = p->x[a];
    d.fields = field;
    d.field_count = 9;
    d.time = (double)s->world.time * 1e3;
    d.float32 = 1;
    d.note = "taylor: lengths mm, time us";
    return mpm_io_vtu(path, &d, &fault) >= 0 ? 1 : report(&fault, path);
}

/* Frame number `frame` of the series: points for ParaView and a picture. */
static int write_frame(const taylor *s, const taylor_case *c, const output *o, long frame)
{
    char name[64], path[1024];
    mpm_fault fault;
    snprintf(name, sizeof name, "points_%04ld.vtu", frame);
    if (!write_points(s, file_in(o->folder, name, path, sizeof path))) return 0;
    if (mpm_io_pvd_add(file_in(o->folder, "taylor.pvd", path, sizeof path), name, (double)s->world.time * 1e3,
                       &fault) < 0)
        return report(&fault, path);
    snprintf(name, sizeof name, "frame_%04ld.png", frame);
    return write_picture(s, c, file_in(o->folder, name, path, sizeof path));
}

static int write_profile(const taylor *s, const taylor_row *row, const output *o)
{
    char path[1024];
    mpm_fault fault;
    mpm_io_csv t;
    mpm_real value[3];
    long k;
    file_in(o->folder, "profile.csv", path, sizeof path);
    mpm_io_csv_begin(&t, path, "start_z_mm,z_mm,radius_mm", "taylor: side of the bar", &fault);
    for (k = 0; k < taylor_rows(s); k++) {
        value[0] = (mpm_real)row[k].start;
        value[1] = (mpm_real)row[k].z;
        value[2] = (mpm_real)row[k].radius;
        mpm_io_csv_row(&t, value);
    }
    return mpm_io_csv_end(&t, &fault) >= 0 ? 1 : report(&fault, path);
}

static int write_summary(const taylor *s, const taylor_result *r, const output *o, const option *options, int n,
                         double cpu)
{
    const mpm_world *w = &s->world;
    char path[1024];
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
    mpm_io_json_number(&j, "cpu_seconds", cpu);
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
    printf("  %d points, %ld retired, %ld steps of %.4g ns, %.1f s CPU\n", (int)w->points.count, w->retired, w->steps,
           (double)s->dt * 1e6, cpu);
}

/* Time integration: one call per phase. */
static int run(taylor *s, const taylor_case *c, const output *o, double *cpu)
{
    mpm_world *w = &s->world;
    const mpm_real dt = s->dt;
    clock_t begun = clock(), writing = 0, mark;
    long frame = 0;
    for (;;) {
        if (o->frames > 0 && w->steps * (o->frames > 1 ? o->frames - 1 : 1) >= frame * s->steps) {
            mark = clock();
            if (!write_frame(s, c, o, frame)) return 0;
            frame++;
            writing += clock() - mark;
        }
        if (w->steps >= s->steps) break;

        mpm_status status = mpm_locate(w);   /* points in cell order, nodes for the body */
        if (status == MPM_ERR_FULL) {        /* a spreading foot touches ever more nodes */
            if (mpm_grow(w, NULL, 0) < 0) return report(&w->fault, "growing the grid");
            continue;
        }
        if (status < 0) return report(&w->fault, "locate");
        mpm_p2g(w);                          /* mass and momentum to the nodes */
        mpm_forces(w, dt);                   /* of the stress */
        mpm_grid_update(w, dt);              /* nodal momentum; the wall acts here */
        mpm_g2p(w, dt);                      /* velocity of the points */
        mpm_musl(w, dt);                     /* nodal velocity from it */
        if (mpm_stress(w, dt) < 0) return report(&w->fault, "stress"); /* strain, density, stress */
        mpm_move(w, dt);                     /* position of the points */
    }
    *cpu = (double)(clock() - begun - writing) / (double)CLOCKS_PER_SEC;
    return 1;
}

/* Everything that is written at the end. */
static int finish(const taylor *s, const taylor_case *c, const output *o, const option *options, int n, double cpu)
{
    taylor_row *row = (taylor_row *)malloc((size_t)taylor_rows(s) * sizeof *row);
    taylor_result r;
    char path[1024];
    int ok = row && taylor_measure(s, c, row, &r);
    if (!ok) complain("no memory for the profile");
    ok = ok && write_summary(s, &r, o, options, n, cpu) && write_profile(s, row, o);
    if (ok && o->frames > 0) ok = write_picture(s, c, file_in(o->folder, "taylor.png", path, sizeof path));
    if (ok && !o->quiet) {
        print_table(s, c, &r, cpu);
        printf("\n  %s/summary.json, profile.csv%s\n", o->folder, o->frames > 0 ? ", taylor.png, taylor.pvd" : "");
    }
    free(row);
    return ok;
}

int main(int argc, char **argv)
{
    taylor_case c = taylor_case_default();
    output o = {"taylor-out", 9, 0};
    const option options[] = {
        {"length", OPTION_REAL, &c.length, "mm"},
        {"diameter", OPTION_REAL, &c.diameter, "mm"},
        {"velocity", OPTION_REAL, &c.velocity, "impact velocity, m/s"},
        {"temperature", OPTION_REAL, &c.temperature, "at the start, K"},
        {"material", OPTION_TEXT, &c.material, "preset; build/material --list shows them"},
        {"model", OPTION_TEXT, &c.model, "elastic|linear|jc|scg|ptw"},
        {"wall", OPTION_TEXT, &c.wall, "sliding: the foot stays on it; contact: it may leave"},
        {"friction", OPTION_REAL, &c.friction, "Coulomb coefficient of a wall in contact"},
        {"geometry", OPTION_TEXT, &c.geometry, "axisymmetric|3d (a quarter)"},
        {"functions", OPTION_TEXT, &c.functions, "shape functions: linear|gimp"},
        {"cell", OPTION_REAL, &c.cell, "grid cell edge, mm"},
        {"spacing", OPTION_REAL, &c.spacing, "distance of material points, mm"},
        {"time", OPTION_REAL, &c.time, "simulated time, us"},
        {"dt-factor", OPTION_REAL, &c.dt_factor, "time step over the critical step of the cell"},
        {"frames", OPTION_LONG, &o.frames, "pictures and ParaView files, evenly in time, both ends included"},
        {"out", OPTION_TEXT, &o.folder, "output folder"},
        {"quiet", OPTION_FLAG, &o.quiet, "no table"},
    };
    const int n = (int)(sizeof options / sizeof options[0]);
    const char *about = "A metal cylinder hits a rigid wall end on: Taylor's test.\n"
                        "Writes summary.json, profile.csv, taylor.png, taylor.pvd (ParaView) and frames.";
    char message[300], path[1024];
    mpm_fault fault;
    taylor s;
    double cpu = 0;
    int parsed = options_parse(argc, argv, about, options, n), ok;
    if (parsed) return parsed < 0 ? 1 : 0;
    if (!case_wants(o.frames >= 0 && o.frames <= 9999, "frames", (double)o.frames, "must be 0 .. 9999", message,
                    sizeof message) ||
        !taylor_begin(&s, &c, message, sizeof message)) {
        complain(message);
        return 1;
    }
    ok = mpm_io_make_directory(o.folder, &fault) >= 0 || report(&fault, o.folder);
    if (ok && o.frames > 0)
        ok = mpm_io_pvd_begin(file_in(o.folder, "taylor.pvd", path, sizeof path), &fault) >= 0 || report(&fault, path);
    ok = ok && run(&s, &c, &o, &cpu) && finish(&s, &c, &o, options, n, cpu);
    mpm_free(&s.world);
    return ok ? 0 : 1;
}
