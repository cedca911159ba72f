/* search.c - the cases of a budget, and one search of a critical velocity, repeated. SPDX-License-Identifier: MIT */
#include "reproduction.h"

const bond_pair pairs[2] = {{1503.74, 2.271e5}, {2236.07, 2.8e5}};
const char *const rule_names[2] = {"thesis", "stays"};
const extremes no_extremes = {HUGE_VAL, -HUGE_VAL};

void widen(extremes *e, double v)
{
    e->low = fmin(e->low, v);
    e->high = fmax(e->high, v);
}

impact_case case_on(grid g)
{
    impact_case c = study_case_default();
    c.cell = g.cell;
    c.spacing = g.spacing;
    return c;
}

grid budget_grid(const work *w)
{
    static const grid quick = {1.5, 0.5}, usual = {1, 0.25};
    return w->budget == QUICK ? quick : usual;
}

int budget_times(const work *w) { return w->budget == QUICK ? 4 : 8; }

critical_range budget_range(const work *w)
{
    critical_range r = critical_range_default();
    if (w->budget != FULL) r.scan = 100, r.step = 10;
    return r;
}

void plan(work *w, int early, int64_t runs)
{
    w->s.whole = !early;
    w->s.planned = w->s.done + runs;
}

int need(work *w, impact_case c, double *value)
{
    study_complete(&c, "thesis");
    return study_need(&w->s, &c, value, w->message, sizeof w->message);
}

int critical_repeat(work *w, impact_case c, variation vary, const char *rule_name, critical_range range, int times,
                    critical_outcome *out)
{
    static critical_curve curve;
    critical_answer a[REPEATS];
    critical_rule rule = critical_rule_default();
    int k, status;
    study_complete(&c, "thesis");
    rule.name = rule_name;
    curve.runs = 0;
    out->lost = 0;
    out->cpu = 0;
    for (k = 0; k < times; k++) {
        impact_case one = c;
        const double part = (double)k / times;
        if (vary == VARY_GRID) one.offset = c.cell * k / times;
        if (vary == VARY_GAP) one.gap = c.cell * part;
        if (vary == VARY_STEP) one.dt_factor = c.dt_factor * (1 - 0.1 * part);
        status = critical_search(&w->s, &one, &range, &rule, NULL, &curve, &a[k], w->message, sizeof w->message);
        if (status <= 0) return status;
        out->lost += a[k].lost;
        out->each[k] = a[k].velocity;
    }
    for (k = 0; k < curve.runs; k++) out->cpu += curve.run[k].value[STUDY_CPU];
    out->spread = critical_summary(a, times);
    return 1;
}

void say_spread(work *w, const critical_spread *s, double high)
{
    say_velocity(w, s->median, high);
    say(w, " | ");
    say_velocity(w, s->lowest, high);
    say(w, " - ");
    say_velocity(w, s->highest, high);
}
