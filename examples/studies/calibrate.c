/* calibrate - the pair of bond parameters at which two particle sizes just bond (source A, 4.1.2 and 5.1).

   Sweeps (G_c, Gdot_c) for 14 um at 810 m/s and 30 um at 770 m/s, classifies every run, fits the boundary
   of each size by logistic regression and crosses the boundaries. Only where the class changes is the grid
   of pairs run in full (--plain: everywhere, 375 runs a size as source A). Each run is a task of its own:

       build/calibrate                                    all of it, here; started several times, it shares the work
       build/calibrate --list                             the tasks not done yet, one a line
       build/calibrate --task 17                          one of them
       build/calibrate --collect                          fit, cross and draw what is done
       build/calibrate --list | cut -d' ' -f1 | xargs -P 8 -n 1 build/calibrate --quiet --task

   With --method surface the pairs are (G_c, W0) of the interface's bond, at 28 cells in a diameter: hours. Without
   --plain the list grows with what is known: repeat the last line until it is empty. A task writes one
   file, whole or not at all, and is never repeated. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "calibration.h"

static const char *const program = "examples/studies/calibrate.c";

/* ---- what is written --------------------------------------------------------------------------- */

static int list(const calibration *q, const study *s)
{
    static calibration_map map;
    int size;
    int64_t k;
    for (size = 0; size < 2; size++) {
        calibration_look(q, s, size, &map);
        for (k = 0; k < calibration_nodes(q); k++)
            if (map.wanted[k] && map.bonds[k] < 0)
                printf("%lld  %g um at %g m/s, G_c %.6g, %s %.6g\n", (long long)(size * calibration_nodes(q) + k),
                       q->diameter[size], q->velocity[size], calibration_gc(q, k), calibration_second(q),
                       calibration_gdot(q, k));
    }
    return 0;
}

static int write_tasks(const calibration *q, const study *s, mpm_fault *fault)
{
    char path[PATH_BYTES];
    double value[STUDY_VALUES];
    mpm_io_csv t;
    int size;
    int64_t k;
    mpm_io_csv_begin(&t, file_in(s->folder, "tasks.csv", path, sizeof path),
                     calibration_surface(q) ? "task,diameter_um,velocity_m_s,adhesion_critical_J_m2,adhesion_J_m2,"
                                              "pbcp_percent,restitution_ratio,v_late_m_s,bonds"
                                            : "task,diameter_um,velocity_m_s,gc_J_m2,gdot_J_m2_us,pbcp_percent,"
                                              "restitution_ratio,v_late_m_s,bonds", NULL, fault);
    for (size = 0; size < 2; size++)
        for (k = 0; k < calibration_nodes(q); k++) {
            const impact_case c = calibration_case(q, size, k);
            if (!study_find(s, &c, value)) continue;
            mpm_io_csv_integer(&t, size * calibration_nodes(q) + k);
            mpm_io_csv_real(&t, (mpm_real)q->diameter[size]);
            mpm_io_csv_real(&t, (mpm_real)q->velocity[size]);
            mpm_io_csv_real(&t, (mpm_real)calibration_gc(q, k));
            mpm_io_csv_real(&t, (mpm_real)calibration_gdot(q, k));
            mpm_io_csv_real(&t, (mpm_real)value[STUDY_PBCP]);
            mpm_io_csv_real(&t, (mpm_real)calibration_ratio(q, size, value));
            mpm_io_csv_real(&t, (mpm_real)value[STUDY_V_LATE]);
            mpm_io_csv_integer(&t, calibration_bonds(q, size, value));
        }
    return mpm_io_csv_end(&t, fault) >= 0;
}

static void write_side(mpm_io_json *j, const calibration *q, int size, const calibration_side *side)
{
    double theta[6];
    char name[40];
    int k;
    snprintf(name, sizeof name, "size_%d", size + 1);
    mpm_io_json_open(j, name);
    mpm_io_json_number(j, "diameter_um", q->diameter[size]);
    mpm_io_json_number(j, "velocity_m_s", q->velocity[size]);
    mpm_io_json_integer(j, "tests", side->tests);
    mpm_io_json_integer(j, "bonded", side->bonded);
    mpm_io_json_string(j, "fit", side->why);
    if (side->status >= 0) {
        mpm_logistic_theta(&side->fit, theta);
        for (k = 0; k < 6; k++) {
            snprintf(name, sizeof name, "theta_%d", k);
            mpm_io_json_number(j, name, theta[k]);
        }
        mpm_io_json_integer(j, "tests_on_the_wrong_side", side->fit.wrong);
    }
    mpm_io_json_close(j);
}

static int write_summary(const calibration *q, const calibration_result *r, const study *s, const option *o, int n,
                         mpm_fault *fault)
{
    char path[PATH_BYTES], name[40];
    mpm_io_json j;
    int k;
    mpm_io_json_begin(&j, file_in(s->folder, "summary.json", path, sizeof path), fault);
    mpm_io_json_integer(&j, "crossings", r->points);
    mpm_io_json_bool(&j, "same_boundary", r->same);
    for (k = 0; k < r->points; k++) {
        snprintf(name, sizeof name, "crossing_%d_gc_J_m2", k + 1);
        mpm_io_json_number(&j, name, r->point[k][0]);
        snprintf(name, sizeof name, "crossing_%d_%s", k + 1, calibration_surface(q) ? "adhesion_J_m2" : "gdot_J_m2_us");
        mpm_io_json_number(&j, name, r->point[k][1]);
    }
    for (k = 0; k < 2; k++) write_side(&j, q, k, &r->side[k]);
    snprintf(name, sizeof name, strcmp(q->scale, "log") ? "G_c, %s" : "log10 G_c, log10 %s", calibration_second(q));
    mpm_io_json_string(&j, "fit_parameters", name);
    options_json(&j, o, n);
    return mpm_io_json_end(&j, fault) >= 0;
}

static void print_result(const calibration *q, const calibration_result *r, const study *s)
{
    int k;
    printf("\n");
    for (k = 0; k < 2; k++) {
        const calibration_side *side = &r->side[k];
        printf("  %g um at %g m/s: %lld of %lld runs bonded, ", q->diameter[k], q->velocity[k],
               (long long)side->bonded, (long long)side->tests);
        if (side->status < 0) printf("no boundary: %s\n", side->why);
        else printf("%lld on the wrong side of the fitted boundary\n", (long long)side->fit.wrong);
        if (side->status > 0) printf("    the fit: %s\n", side->why);
    }
    for (k = 0; k < r->points; k++)
        printf("  the boundaries cross at G_c %.6g J/m2, %s %.4g %s\n", r->point[k][0], calibration_second(q),
               r->point[k][1], calibration_unit(q));
    if (r->same) printf("  the two sizes have the same classes: one boundary\n");
    else if (!r->points && r->side[0].status >= 0 && r->side[1].status >= 0)
        printf("  the boundaries do not cross in this range\n");
    printf("  %s/tasks.csv, classes.png, summary.json\n", s->folder);
}

static int collect(const calibration *q, const study *s, const option *o, int n, char *message, size_t room)
{
    static calibration_result r;
    char path[PATH_BYTES];
    mpm_fault fault;
    calibration_collect(q, s, &r);
    if (r.side[0].tests + r.side[1].tests == 0) {
        snprintf(message, room, "no finished task in %.300s/runs with these options", s->folder);
        return 0;
    }
    file_in(s->folder, "classes.png", path, sizeof path);
    if (!write_tasks(q, s, &fault) || !calibration_draw(q, &r, path, program, &fault) ||
        !write_summary(q, &r, s, o, n, &fault)) {
        mpm_io_fault_text(message, room, &fault);
        return 0;
    }
    if (!s->quiet) print_result(q, &r, s);
    return 1;
}

/* ---- main ---------------------------------------------------------------------------------- */

/* What to do with the sweep. */
typedef struct errand {
    int list, collect;
    int64_t task; /* < 0: all */
} errand;

static int options(calibration *q, study *s, errand *e, option *o)
{
    const int surface = calibration_surface(q);
    int n = study_case_options(&q->base, o);
    option_drop(o, &n, "diameter"); /* what the sweep sets */
    option_drop(o, &n, "velocity");
    option_drop(o, &n, surface ? "adhesion-critical" : "gc");
    option_drop(o, &n, surface ? "adhesion" : "gdot");
    option_add_word(o, &n, "substrate", &q->substrate, STUDY_SUBSTRATES, "source A's sizes, or 5 x 2.5 diameters");
    option_add(o, &n, "gc-low", OPTION_REAL, &q->gc[0], "range of G_c, J/m2");
    option_add(o, &n, "gc-high", OPTION_REAL, &q->gc[1], "");
    option_add(o, &n, surface ? "adhesion-low" : "gdot-low", OPTION_REAL, &q->gdot[0],
               surface ? "range of W0, J/m2" : "range of Gdot_c, J/m2/us");
    option_add(o, &n, surface ? "adhesion-high" : "gdot-high", OPTION_REAL, &q->gdot[1], "");
    option_add(o, &n, "columns", OPTION_INTEGER, &q->columns, "values of G_c");
    option_add(o, &n, "rows", OPTION_INTEGER, &q->rows, surface ? "values of W0" : "values of Gdot_c");
    option_add_word(o, &n, "scale", &q->scale, CALIBRATION_SCALES, "the steps, and what the fit sees");
    option_add(o, &n, "plain", OPTION_FLAG, &q->plain, "run every pair, not only where the class changes");
    option_add(o, &n, "diameter-1", OPTION_REAL, &q->diameter[0], "um");
    option_add(o, &n, "velocity-1", OPTION_REAL, &q->velocity[0], "m/s");
    option_add(o, &n, "diameter-2", OPTION_REAL, &q->diameter[1], "um");
    option_add(o, &n, "velocity-2", OPTION_REAL, &q->velocity[1], "m/s");
    option_add_word(o, &n, "rule", &q->rule, CRITICAL_RULES, "what counts as bonded, see critical_velocity");
    option_add(o, &n, "pbcp-1", OPTION_REAL, &q->pbcp[0], "least PBCP, %; 0: source A's for the grid");
    option_add(o, &n, "pbcp-2", OPTION_REAL, &q->pbcp[1], "");
    option_add(o, &n, "restitution-1", OPTION_REAL, &q->restitution[0],
               "rule thesis: highest rebound ratio; 0: source A's");
    option_add(o, &n, "restitution-2", OPTION_REAL, &q->restitution[1], "");
    option_add(o, &n, "stays", OPTION_REAL, &q->stays, "rule stays: the late mean velocity is below, m/s");
    option_add(o, &n, "ridge", OPTION_REAL, &q->ridge, "of the fits: holds those of separable classes back");
    option_add(o, &n, "list", OPTION_FLAG, &e->list, "print the tasks that are not done");
    option_add(o, &n, "task", OPTION_INTEGER, &e->task, "do this task only; < 0: all");
    option_add(o, &n, "collect", OPTION_FLAG, &e->collect, "fit and draw what is done, run nothing");
    study_options(s, o, &n);
    return n;
}

/* The sweep without its sizes' cases. */
static int check_sweep(const calibration *q, char *m, size_t n)
{
    const int surface = calibration_surface(q);
    int k;
    for (k = 0; k < 2; k++)
        if (!case_wants(q->pbcp[k] >= 0, k ? "pbcp-2" : "pbcp-1", q->pbcp[k], "must be >= 0 %", m, n) ||
            !case_wants(q->restitution[k] >= 0, k ? "restitution-2" : "restitution-1", q->restitution[k],
                        "must be >= 0", m, n) ||
            !case_wants(q->velocity[k] > 0, k ? "velocity-2" : "velocity-1", q->velocity[k], "must be > 0 m/s", m, n))
            return 0;
    return case_wants(q->gc[0] > 0, "gc-low", q->gc[0], "must be > 0 J/m2", m, n) &&
           case_wants(q->gc[1] > q->gc[0] && q->gc[1] < 1e30, "gc-high", q->gc[1], "must be over --gc-low", m, n) &&
           case_wants(q->gdot[0] > 0, surface ? "adhesion-low" : "gdot-low", q->gdot[0], "must be > 0", m, n) &&
           case_wants(q->gdot[1] > q->gdot[0] && q->gdot[1] < 1e30, surface ? "adhesion-high" : "gdot-high", q->gdot[1],
                      "must be over the range's low end", m, n) &&
           case_wants(q->columns >= 5, "columns", (double)q->columns, "must be 5 or more", m, n) &&
           case_wants(q->rows >= 5, "rows", (double)q->rows, "must be 5 or more", m, n) &&
           case_wants(q->columns < CALIBRATION_NODES && q->rows < CALIBRATION_NODES &&
                          calibration_nodes(q) <= CALIBRATION_NODES,
                      "columns", (double)q->columns, "makes more than 4000 pairs", m, n) &&
           case_wants(q->stays > 0, "stays", q->stays, "must be > 0 m/s", m, n) &&
           case_wants(q->ridge >= 0 && q->ridge < 1e6, "ridge", q->ridge, "must be >= 0", m, n);
}

static int check(const calibration *q, const errand *e, char *m, size_t n)
{
    impact_case c;
    int k;
    if (!check_sweep(q, m, n)) return 0;
    if (strcmp(q->base.bond, calibration_surface(q) ? "interface" : "energy")) {
        snprintf(m, n, "--bond %s: the sweep is over G_c and %s, which only --bond %s has", q->base.bond,
                 calibration_second(q), calibration_surface(q) ? "interface" : "energy");
        return 0;
    }
    for (k = 0; k < 2; k++) { /* behind the others: it divides by the columns */
        c = calibration_case(q, k, 0);
        if (!impact_check(&c, m, n)) return 0;
    }
    if (e->task < 2 * calibration_nodes(q)) return 1;
    snprintf(m, n, "--task %lld: there are %lld, from 0", (long long)e->task,
             2 * (long long)calibration_nodes(q));
    return 0;
}

/* The runs that the errand wants. As study_need. */
static int run(const calibration *q, study *s, const errand *e, char *message, size_t n)
{
    const int64_t nodes = calibration_nodes(q);
    double value[STUDY_VALUES];
    impact_case c;
    int status;
    if (e->task < 0) status = calibration_run(q, s, message, n);
    else {
        c = calibration_case(q, (int)(e->task / nodes), e->task % nodes);
        s->planned = 1;
        status = study_need(s, &c, value, message, n);
    }
    study_progress_end(s);
    return status;
}

static int carry_out(int argc, char **argv)
{
    const int surface = !strcmp(impact_method(argc, argv, "thesis"), "surface");
    calibration q = surface ? calibration_of_surfaces() : calibration_default();
    study s = study_of("build/calibrate-out");
    errand e = {0, 0, -1};
    option o[IMPACT_OPTIONS];
    char message[400];
    const int n = options(&q, &s, &e, o);
    int status = options_parse(argc, argv, "The bond parameters at which two sizes just bond: sweep, boundaries, "
                               "crossing.\nWrites tasks.csv, classes.png and summary.json; run again after an "
                               "interruption, it goes on.", o, n);
    if (status) return status < 0;
    if (!check(&q, &e, message, sizeof message)) return !complain(message);
    calibration_tolerances(q.base.cell, q.base.spacing, q.pbcp, q.restitution);
    if (e.list) return list(&q, &s);
    status = e.collect && e.task < 0 ? 1 : run(&q, &s, &e, message, sizeof message);
    if (status < 0) return study_stopped(&s);
    if (status > 0 && e.task < 0) status = collect(&q, &s, o, n, message, sizeof message);
    return status > 0 ? 0 : !complain(message);
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
