/* reproduction - the results of source A's chapters 4 and 5 again, beside its numbers.

   Runs the cases A-conv, A-dt, A-jet, A-crit, A-cal, A-site, A-two and A-ten, and what explains them, at a stated
   budget: "quick" on the coarsest grid (an hour of one core), "desk" at 1.0/0.25 um in axisymmetry with
   checks at 0.7/0.175 um and in 3D (some nine hours), "full" with every row of the tables (days). Writes tables and
   plots into --data and replaces its part of --page.
   Every finished run is kept in --out and never repeated (but for the first nanoseconds of sixteen impacts, which take
   a second or two); delete the folder after changing the headers.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "reproduction.h"

#define BUDGETS "quick|desk|full" /* QUICK, DESK, FULL */

/* X(name, what says it), in the order of the page. */
#define PART_LIST(X)                                                                                   \
    X(conv, convergence) X(dt, time_steps) X(jet, jets) X(substrate, substrates) X(crit, critical)     \
    X(scatter, scatter) X(held, held_out) X(unit, rate_unit) X(length, regularisation)                 \
    X(pairs, other_pairs) X(size, steep_fall) X(points, points_touch) X(cal, calibrations)             \
    X(site, sites) X(two, two_particles) X(ten, ten_particles)

#define PART_NAME(name, run) "," #name
#define PART_ROW(name, run) {#name, run},
#define PARTS PART_LIST(PART_NAME) /* ",conv,dt" */

/* Whether a word is in a list "conv,dt,jet". */
static int listed(const char *list, const char *word)
{
    const size_t n = strlen(word);
    while (*list) {
        const size_t length = strcspn(list, ",");
        if (length == n && !strncmp(list, word, n)) return 1;
        list += length + (list[length] == ',');
    }
    return 0;
}

/* Whether a list names parts only, or "none". */
static int parts_known(work *w, const char *name, const char *list)
{
    char word[40];
    while (*list) {
        const size_t n = strcspn(list, ",");
        snprintf(word, sizeof word, "%.*s", n < sizeof word ? (int)n : (int)sizeof word - 1, list);
        if (!listed("none" PARTS, word)) {
            snprintf(w->message, sizeof w->message, "--%s %s: no such part; there are %s", name, word, &PARTS[1]);
            return 0;
        }
        list += n + (list[n] == ',');
    }
    return 1;
}

/* All parts, or those that --only names. As need. */
static int parts(work *w)
{
    static const struct {
        const char *name;
        int (*run)(work *w);
    } part[] = {PART_LIST(PART_ROW)};
    const int count = (int)(sizeof part / sizeof part[0]), budget = w->budget;
    int k, status;
    say(w,
        "## Source A's results again\n\nMade by `build/reproduction --budget %s%s%s%s%s` (mpm.h %s). Pictures, and the "
        "tables of A-conv, A-crit, the scatter, A-cal and A-two as CSV, are in [data](data).\n\n",
        w->budget_name, *w->desk ? " --desk " : "", w->desk, *w->only ? " --only " : "", w->only, MPM_VERSION);
    for (k = 0; k < count; k++) {
        if (*w->only && !listed(w->only, part[k].name)) continue;
        if (!w->s.quiet) fprintf(stderr, "A-%s\n", part[k].name);
        w->budget = budget == QUICK && listed(w->desk, part[k].name) ? DESK : budget;
        status = part[k].run(w);
        study_progress_end(&w->s);
        if (status <= 0) return status;
    }
    return 1;
}

/* Reads the command line: as options_parse. */
static int options(work *w, int argc, char **argv)
{
    option o[9];
    int n = 0;
    w->s = study_of("build/reproduction-out");
    w->budget_name = "quick";
    w->data = "docs/data";
    w->page = "docs/reproduction.md";
    w->only = w->desk = "";
    option_add_word(o, &n, "budget", &w->budget_name, BUDGETS, "how much of it: an hour, nine hours, days");
    option_add(o, &n, "only", OPTION_TEXT, &w->only, "parts that the page then holds: none" PARTS "; empty: all");
    option_add(o, &n, "desk", OPTION_TEXT, &w->desk, "parts that a quick budget runs as desk does");
    option_add(o, &n, "limit", OPTION_INTEGER, &w->s.limit, "stop after so many new runs; < 0: never");
    option_add(o, &n, "out", OPTION_TEXT, &w->s.folder, "finished runs, to go on from");
    option_add(o, &n, "data", OPTION_TEXT, &w->data, "folder for tables and plots");
    option_add(o, &n, "page", OPTION_TEXT, &w->page, "the page whose part is replaced");
    option_add(o, &n, "quiet", OPTION_FLAG, &w->s.quiet, "no progress");
    return options_parse(argc, argv, "Source A's results again, beside its numbers; run again after an interruption, "
                                     "it goes on.", o, n);
}

static int carry_out(int argc, char **argv)
{
    static char text[200000];
    static work w;
    const int parsed = options(&w, argc, argv);
    int status;
    if (parsed) return parsed < 0;
    w.text = text;
    w.room = sizeof text;
    w.budget = word_place(BUDGETS, w.budget_name);
    if (!parts_known(&w, "only", w.only) || !parts_known(&w, "desk", w.desk)) return !complain(w.message);
    if (mpm_io_make_directory(w.data, &w.fault) < 0) return !report(&w.fault, w.data);
    status = parts(&w);
    if (status > 0) status = write_page(&w);
    if (status == 0) return !complain(w.message);
    if (status < 0) printf("stopped after %lld new runs; run again to go on\n", (long long)w.s.fresh);
    return status < 0 ? 3 : 0;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
