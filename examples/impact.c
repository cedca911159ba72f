/* impact - a metal particle hits a plate: does it bond? (source A, chapters 4 and 5)

   The main job is an aluminium sphere of 14 um at 810 m/s on an aluminium plate, a quarter of it,
   80 ns. Expect: without bonding it rebounds at some tens of m/s; with the defaults it stays
   (mean rebound velocity under 1 m/s), about one contacting point in ten bonded, mean plastic strain
   about 0.75, hottest at the rim. Source A: critical velocity 824 m/s, PBCP 4.8 %.

   The loop in main() is the method, one call per phase. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_history.h"
#include "impact_options.h"
#include "impact_report.h"
#include "restart.h"

/* "al", or "al on cu". */
static const char *metals(const impact *s, char *text, size_t n)
{
    const char *a = s->material[IMPACT_PARTICLE].name, *b = s->material[IMPACT_SUBSTRATE].name;
    if (strcmp(a, b)) snprintf(text, n, "%s on %s", a, b);
    else snprintf(text, n, "%s", a);
    return text;
}

/* "al, 14 um at 810 m/s" */
static void write_title(const impact *s, const impact_case *c, char *title, size_t n)
{
    char name[64];
    snprintf(title, n, "%s, %g um at %g m/s", metals(s, name, sizeof name), c->diameter, c->velocity);
}

/* Colours: to the melting point; pressure to half of what the first shock makes; stress to what the harder metal bears
   at a strain of 1 at a million per second. */
static output_range colors(const impact *s, const impact_case *c)
{
    output_range r = {4, 0, 0, 0, 0, 0};
    double melt = 0;
    int k;
    r.cold = HUGE_VAL;
    for (k = 0; k < 2; k++) {
        const mpm_material *m = &s->material[k];
        const mpm_material_state flows = {1, 1, m->temperature, m->density, 0};
        mpm_real p, shear;
        mpm_material_wave_speeds(m, m->density, &p, &shear);
        r.cold = fmin(r.cold, (double)m->temperature);
        melt = fmax(melt, (double)m->melt_temperature);
        r.pressure = fmax(r.pressure, (double)(m->density * p) * fabs(c->velocity) / 4);
        r.mises = fmax(r.mises, (double)mpm_material_flow_stress(m, &flows));
    }
    r.hot = melt > r.cold ? melt : r.cold + 600;
    r.pressure = mpm_draw_nice(fmax(r.pressure, 100));
    r.mises = 2 * mpm_draw_nice(fmax(r.mises, 1));
    r.speed = fmax(fabs(c->velocity), 1);
    return r;
}

/* What was asked for of the whole cross-section, or from outside. Returns 1, or 0 after a message. */
static int describe_picture(const impact *s, const impact_case *c, const output *o, output_picture *p)
{
    const output_range r = colors(s, c);
    if (!output_fields(o, &s->world, c->spacing, &r, p)) return 0;
    output_window(p, 1.1 * c->substrate_diameter / 2, -1.05 * c->substrate_height,
                  1.1 * (2 * impact_half_height(c) + (c->gap > 0 ? c->gap : 0)));
    write_title(s, c, p->title, sizeof p->title);
    return output_outline(o, p, &s->world, &s->surfaces);
}

static int write_frame(const impact *s, const impact_case *c, const page *sheet, output *o)
{
    output_picture p;
    int ok;
    if (!page_frame(sheet, o, &s->world, &s->surfaces)) return 0;
    ok = describe_picture(s, c, o, &p) && output_surfaces(o, &s->world, &s->surfaces) &&
         output_frame(o, &s->world, NULL, 0, &p);
    output_picture_free(&p);
    return ok;
}

/* The last picture, with the verdict if the run came to its end; the film; the curves. */
static int write_pictures(const impact *s, const impact_case *c, const impact_result *r, output *o,
                          const history *past)
{
    output_picture p;
    char title[160];
    int ok = describe_picture(s, c, o, &p);
    write_title(s, c, title, sizeof title);
    if (s->world.steps >= s->steps)
        snprintf(p.title, sizeof p.title, "%.130s: %s", title, impact_verdict(s, r));
    ok = ok && output_png(o, &p, "impact.png") && output_film(o, title) &&
         impact_history_png(past, o->folder, p.title);
    output_picture_free(&p);
    return ok;
}

static int write_summary(const impact *s, const impact_result *r, const output *o, const option *options, int n)
{
    const mpm_world *w = &s->world;
    const double start = s->start.kinetic, cpu = o->cpu;
    char path[PATH_BYTES];
    mpm_fault fault;
    mpm_io_json j;
    mpm_io_json_begin(&j, file_in(o->folder, "summary.json", path, sizeof path), &fault);
    mpm_io_json_number(&j, "pbcp_percent", r->bond.pbcp);
    mpm_io_json_number(&j, "pbcp_particle_percent", r->particle_bond.pbcp);
    mpm_io_json_number(&j, "abp", r->bond.abp);
    mpm_io_json_integer(&j, "contacted_points", r->bond.contacted);
    mpm_io_json_integer(&j, "bonded_points", r->bond.bonded);
    mpm_io_json_integer(&j, "held_pairs", w->held);
    mpm_io_json_number(&j, "v_rest_filtered_m_s", r->rebound.filtered);
    mpm_io_json_number(&j, "v_rest_mean_m_s", r->rebound.mean);
    mpm_io_json_number(&j, "v_rest_filtered_relative_m_s", r->filtered_relative);
    mpm_io_json_number(&j, "v_rest_relative_m_s", r->relative);
    mpm_io_json_number(&j, "v_noise_m_s", r->rebound.noise);
    mpm_io_json_number(&j, "v_quiet_percent", 100 * r->quiet_velocity);
    mpm_io_json_number(&j, "p_quiet_percent", 100 * r->quiet_pressure);
    mpm_io_json_number(&j, "v_tangential_m_s", r->tangential);
    mpm_io_json_number(&j, "substrate_drift_m_s", r->substrate_drift);
    mpm_io_json_number(&j, "restitution_ratio", r->restitution);
    mpm_io_json_number(&j, "flattening", r->flattening);
    mpm_io_json_number(&j, "crater_depth_um", r->crater);
    mpm_io_json_number(&j, "contact_area_um2", r->contact_area);
    mpm_io_json_number(&j, "bonded_area_um2", r->bonded_area);
    mpm_io_json_number(&j, "interface_dissipation_J_m2", r->meeting.dissipated);
    mpm_io_json_number(&j, "interface_adhesion_pJ", r->meeting.adhesion);
    mpm_io_json_number(&j, "ejected_mass_fraction", r->ejected_fraction);
    mpm_io_json_number(&j, "fast_mass_fraction", r->fast_fraction);
    mpm_io_json_number(&j, "eps_mean", r->particle.plastic_strain_mean);
    mpm_io_json_number(&j, "plastic_energy_density_mean_MPa", r->particle.plastic_work_mean);
    mpm_io_json_number(&j, "temperature_max_K", r->all.temperature_max);
    mpm_io_json_integer(&j, "points", r->all.points);
    mpm_io_json_integer(&j, "ejected_points", r->pieces.apart);
    mpm_io_json_integer(&j, "fast_points", r->rebound.fast);
    mpm_io_json_integer(&j, "retired_points", w->retired);
    mpm_io_json_integer(&j, "steps", w->steps);
    mpm_io_json_number(&j, "dt_ns", (double)s->dt * 1e3);
    mpm_io_json_number(&j, "time_ns", (double)w->time * 1e3);
    mpm_io_json_number(&j, "cpu_seconds", cpu);
    mpm_io_json_number(&j, "point_steps_per_second", cpu > 0 ? (double)w->steps * (double)r->all.points / cpu : 0);
    mpm_io_json_number(&j, "bytes_per_point", (double)mpm_bytes_used(w) / (double)r->all.points);
    mpm_io_json_number(&j, "mass_error", r->mass_error);
    mpm_io_json_number(&j, "momentum_error", r->momentum_error);
    mpm_io_json_number(&j, "energy_error", r->energy_error);
    mpm_io_json_number(&j, "energy_unaccounted", r->energy_unaccounted);
    mpm_io_json_number(&j, "energy_kinetic_fraction", case_share(r->all.kinetic, start));
    mpm_io_json_number(&j, "energy_plastic_fraction", case_share(r->all.plastic, start));
    mpm_io_json_number(&j, "energy_elastic_fraction",
                       case_share(r->all.internal - s->start.internal - r->all.plastic, start));
    mpm_io_json_number(&j, "energy_absorbed_fraction", case_share(w->ledger.absorbed, start));
    mpm_io_json_number(&j, "energy_contact_fraction", case_share(w->ledger.contact, start));
    mpm_io_json_number(&j, "energy_bond_fraction", case_share(w->ledger.hold, start));
    mpm_io_json_number(&j, "energy_calm_fraction", case_share(w->ledger.calm, start));
    mpm_io_json_integer(&j, "floor_hits", (long long)w->tally[MPM_TALLY_BOND_FLOOR]);
    mpm_io_json_integer(&j, "bond_increments", (long long)w->tally[MPM_TALLY_BOND_GROWTH]);
    mpm_io_json_integer(&j, "shear_floor_hits", (long long)w->tally[MPM_TALLY_SHEAR_FLOOR]);
    mpm_io_json_integer(&j, "iteration_hits", (long long)w->tally[MPM_TALLY_ITERATION]);
    mpm_io_json_integer(&j, "sorts", w->sorts);
    options_json(&j, options, n);
    if (mpm_io_json_end(&j, &fault) < 0) return report(&fault, path);
    return 1;
}

/* The table's words, a line each. */
static void print_words(const impact *s)
{
    if (s->surfaces.surfaces > 0) {
        printf("\n  bonded: of the area that touched, the part with adhesion that is not spent\n");
        printf("  held:   markers that adhesion drew to the other surface in the last step\n");
        return;
    }
    printf("\n  PBCP: of the surface that touched the other body, the part whose bond variable D is 1 or more\n");
    printf("  ABP:  D of that surface on the mean\n");
    printf("  held: pairs of nodes that the bond kept from parting in the last step\n");
}

static void print_table(const impact *s, const impact_case *c, const impact_result *r, double cpu)
{
    const mpm_world *w = &s->world;
    const double start = s->start.kinetic;
    char name[64];
    printf("\n  %s, %g um at %g m/s after %.4g ns: %s\n\n", metals(s, name, sizeof name), c->diameter, c->velocity,
           (double)w->time * 1e3, impact_verdict(s, r));
    printf("  rebound velocity, mean          %10.3f m/s\n", r->rebound.mean);
    printf("  rebound velocity, |v| <= 60 m/s %10.3f m/s  (%.4f of the impact velocity)\n", r->rebound.filtered,
           r->restitution);
    printf("  velocity noise in the particle  %10.3f m/s; %.2f %% of its points within 5 m/s, %.2f %% within 0.5 GPa\n",
           r->rebound.noise, 100 * r->quiet_velocity, 100 * r->quiet_pressure);
    if (fabs(c->angle) > 0)
        printf("  tangential velocity, mean       %10.3f m/s\n", r->tangential);
    printf("  substrate drift                 %10.3f m/s\n", r->substrate_drift);
    if (s->surfaces.surfaces > 0) {
        printf("  bonded share of what touched    %10.3f %%\n", r->bond.pbcp);
        printf("  meetings of markers held        %10lld\n", (long long)w->held);
    } else {
        printf("  PBCP                            %10.3f %%    (%ld of %ld contacted points)\n", r->bond.pbcp,
               r->bond.bonded, r->bond.contacted);
        printf("  ABP                             %10.4f\n", r->bond.abp);
        printf("  node pairs held by the bond     %10lld\n", (long long)w->held);
    }
    printf("  mean plastic strain             %10.4f\n", r->particle.plastic_strain_mean);
    printf("  mean plastic energy density     %10.2f MPa\n", r->particle.plastic_work_mean);
    printf("  flattening                      %10.4f     crater %.3f um deep\n", r->flattening, r->crater);
    printf("  area of the particle, contact   %10.3f um2, bonded %.3f um2\n", r->contact_area, r->bonded_area);
    if (r->meeting.touched > 0)
        printf("  dissipated at the interface     %10.1f J/m2  adhesion %.1f J/m2 where bonded\n",
               r->meeting.dissipated, case_share(r->meeting.adhesion, r->meeting.bonded));
    printf("  highest temperature             %10.1f K\n", r->all.temperature_max);
    printf("  points ejected, retired         %10ld, %lld of %ld; %ld faster than 60 m/s\n", (long)r->pieces.apart,
           (long long)w->retired, r->all.points, r->rebound.fast);
    printf("  energy: kinetic                 %10.3f %%    plastic work %.3f %%, elastic %.3f %%\n",
           100 * case_share(r->all.kinetic, start), 100 * case_share(r->all.plastic, start),
           100 * case_share(r->all.internal - s->start.internal - r->all.plastic, start));
    printf("  energy: absorbed by dampers     %10.3f %%    lost in contact %.3f %%, in the bond %.3f %%\n",
           100 * case_share(w->ledger.absorbed, start), 100 * case_share(w->ledger.contact, start),
           100 * case_share(w->ledger.hold, start));
    if (c->calm > 0)
        printf("  energy: of noise, now heat      %10.3f %%\n", 100 * case_share(w->ledger.calm, start));
    printf("  errors: mass %.1e, momentum %.1e, energy unaccounted %.3f %%\n", r->mass_error, r->momentum_error,
           100 * r->energy_unaccounted);
    printf("  bond floor acted                %10lld times of %lld\n", (long long)w->tally[MPM_TALLY_BOND_FLOOR],
           (long long)w->tally[MPM_TALLY_BOND_GROWTH]);
    printf("  %lld steps of %.4g ps, %.1f s CPU, %.2f million point-steps/s, %.0f bytes per point\n",
           (long long)w->steps, (double)s->dt * 1e6, cpu,
           cpu > 0 ? 1e-6 * (double)w->steps * (double)r->all.points / cpu : 0,
           (double)mpm_bytes_used(w) / (double)r->all.points);
    print_words(s);
}

/* Time integration: one call per phase. Returns 1; 0 after a message; -1 when stopped before, with a checkpoint. */
static int run(impact *s, const impact_case *c, const page *sheet, output *o, restart *again)
{
    mpm_world *w = &s->world;
    int status = 1;
    output_start(o, w);
    for (;;) {
        if (history_due(again->past, w->steps, s->steps)) impact_history_sample(again->past, s);
        if (output_due(o, w, s->steps) && !write_frame(s, c, sheet, o)) return 0;
        if (w->steps >= s->steps) break;
        if ((status = restart_goes_on(again)) <= 0) break;

        if (s->surfaces.surfaces > 0) { /* contact on surfaces: mpm_surface.h */
            if (mpm_surface_step(&s->surfaces, w, s->dt) < 0) return report(&w->fault, "step");
            output_progress(o, w, s->steps);
            continue;
        }
        if (mpm_locate(w, s->dt) < 0) return report(&w->fault, "locate"); /* points in cell order, their nodes */
        mpm_calm(w);                                 /* with --calm */
        mpm_p2g(w);                                  /* A 3.23, 3.24 */
        mpm_forces(w);                               /* A 3.25 - 3.27, 3.45, 3.46 */
        mpm_grid_update(w);                          /* A 3.28 */
        mpm_contact_find(w);                         /* A 3.30 */
        mpm_bond_grow(&s->bond, w);                  /* A 4.16, 4.17 */
        mpm_bond_nodes(&s->bond, w);                 /* A 4.6, 4.7 */
        mpm_contact_apply(w);                        /* A 3.29, 3.31 */
        mpm_g2p(w);                                  /* A 3.32, velocities */
        mpm_musl(w);                                 /* A 3.33, 3.34 */
        if (mpm_stress(w) < 0) return report(&w->fault, "stress"); /* A 3.35 - 3.44 */
        mpm_move(w);                                 /* A 3.32, positions */

        output_progress(o, w, s->steps);
    }
    output_progress_end(o);
    output_cpu(o);
    return status;
}

/* Everything that is written at the end, or where the run is stopped. */
static int finish(const impact *s, const impact_case *c, const page *sheet, output *o, const history *past,
                  page_desc d)
{
    const impact_result r = impact_measure(s, c);
    char title[160];
    if (!write_summary(s, &r, o, d.option, d.options) || !history_csv(past, o->folder)) return 0;
    if (o->frames > 0 && !write_pictures(s, c, &r, o, past)) return 0;
    write_title(s, c, title, sizeof title);
    d.title = title;
    if (sheet->on && !impact_page(s, c, &r, o, past, d)) return 0;
    if (o->quiet) return 1;
    print_table(s, c, &r, o->cpu);
    printf("\n  %s/%ssummary.json, history.csv%s\n", o->folder, sheet->on ? "report.html, " : "",
           o->frames > 1   ? ", history.png, impact.png, film.png, impact.pvd"
           : o->frames > 0 ? ", history.png, impact.png, impact.pvd" : "");
    return 1;
}

/* Checks what pictures are to show. */
static int shows(const impact_case *c, const output *o, char *message, size_t n)
{
    const int place = word_place(IMPACT_GEOMETRIES, c->geometry); /* an unknown one is refused later */
    char word[32];
    int k;
    if (!output_picture_check(o, place == 1 ? MPM_AXISYMMETRIC : MPM_3D, message, n)) return 0;
    for (k = 0; output_shown(o, k, word) >= 0; k++) {
        if (strcmp(c->contact, "surface") || output_shown(o, k, word) != SHOWN_BOND) continue;
        snprintf(message, n, "--fields %s: bond is the D of contact at nodes; of surfaces look into surface.pvd",
                 o->shown);
        return 0;
    }
    return 1;
}

static int carry_out(int argc, char **argv)
{
    const int surface = !strcmp(impact_method(argc, argv, "thesis"), "surface");
    impact_case c = surface ? impact_case_surface() : impact_case_default();
    output o = output_of("build/impact-out", "impact", "um", "ns", 1);
    option options[IMPACT_OPTIONS];
    int n = impact_options(&c, options);
    const char *about = "A metal particle hits a metal plate: material point method with bonding.\n"
                        "Writes report.html, summary.json, history.csv, history.png, impact.png, film.png, impact.pvd\n"
                        "(ParaView) and frames into the output folder.";
    char message[300];
    restart again;
    history past;
    page sheet;
    impact s;
    int of_case = n, of_run, parsed, status;
    memset(&again, 0, sizeof again);
    output_options(&o, options, &n);
    output_picture_options(&o, options, &n);
    page_options(&sheet, options, &n);
    of_run = n;
    restart_options(&again, options, &n);
    parsed = options_parse(argc, argv, about, options, n);
    if (parsed) return parsed < 0 ? 1 : 0;
    impact_complete(&c);
    if (!output_check(&o, message, sizeof message) || !restart_check(&again, message, sizeof message) ||
        !page_check(&sheet, message, sizeof message) || !shows(&c, &o, message, sizeof message) ||
        !impact_begin(&s, &c, message, sizeof message))
        return !complain(message);
    impact_history_begin(&past, s.steps);
    restart_describe(&again, &s.world, &s.surfaces, &o, &s.start, &past, s.dt, options, of_case);
    status = restart_begin(&again, s.steps) && page_begin(&sheet, &o, c.spacing) ? run(&s, &c, &sheet, &o, &again) : 0;
    if (status != 0 && !finish(&s, &c, &sheet, &o, &past, page_of(options, of_run, argc, argv))) status = 0;
    if (status < 0) print_again(argc, argv, "--resume", (long long)s.world.steps, (long long)s.steps);
    if (status > 0) {
        restart_end(&again);
        page_end(&sheet, o.folder);
    }
    impact_end(&s);
    return status > 0 ? 0 : status < 0 ? STOPPED : 1;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
