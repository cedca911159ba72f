/* critical.h - the lowest impact velocity that bonds: bracket and bisection over runs that are kept.
   SPDX-License-Identifier: MIT */
#ifndef CRITICAL_H
#define CRITICAL_H

#include "study.h"

/* When a run counts as bonded. "thesis": PBCP at least `pbcp` and the rebound velocity of the points up
   to 60 m/s at most `v_rest` (source A, section 5.2.2: 5 % and 0.6 m/s; up to 14 um 4.8 % and 0.9 m/s).
   "stays": the particle's mean velocity, averaged over the last eighth of the run, leads away from the substrate at
   less than `stays` (drawn back by its bond it may be negative), the bond was at work in that time, and at its end at
   least `pbcp` of what touched is bonded. On surfaces that is 1 or 2 % where the particle has left, however slowly, and
   half where it has not. Velocities are
   relative to the substrate's mean, since large particles drift with it. */
typedef struct critical_rule {
    const char *name;
    double pbcp, v_rest, stays; /* %, m/s, m/s; thesis: pbcp, v_rest 0: source A's for the size */
} critical_rule;

#define CRITICAL_LEFT 10 /* % of PBCP: what stays on its surface has more, see above */
#define CRITICAL_RULES "thesis|stays"

static inline critical_rule critical_rule_default(void)
{
    critical_rule r;
    r.name = "thesis";
    r.pbcp = r.v_rest = 0;
    r.stays = 2;
    return r;
}

static inline int critical_bonds(const critical_rule *r, double diameter, const double *value)
{
    const int smallest = diameter <= 14;
    if (!strcmp(r->name, "stays"))
        return value[STUDY_V_LATE] < r->stays && value[STUDY_HELD_LATE] > 0 && value[STUDY_PBCP] >= r->pbcp;
    return value[STUDY_PBCP] >= (r->pbcp > 0 ? r->pbcp : smallest ? 4.8 : 5.0) &&
           value[STUDY_V_REST] <= (r->v_rest > 0 ? r->v_rest : smallest ? 0.9 : 0.6);
}

/* The velocities to look at: low to high by scan, then halving down to step [m/s]. */
typedef struct critical_range {
    double low, high, scan, step;
} critical_range;

static inline critical_range critical_range_default(void)
{
    critical_range r;
    r.low = 500;
    r.high = 1000;
    r.scan = 50;
    r.step = 5;
    return r;
}

/* A tested velocity. */
typedef struct critical_run {
    double offset, velocity; /* um, m/s */
    int bonds;
    double value[STUDY_VALUES];
} critical_run;

/* What one grid offset gave. */
typedef struct critical_answer {
    double offset;
    double velocity;     /* the lowest tested velocity that bonds; infinite: none did */
    double below;        /* the highest tested one under it, which does not; 0: the range begins bonded */
    double pbcp, v_rest; /* at `velocity`; NaN without one */
    int lost;            /* tested velocities above that do not bond: the threshold is not sharp */
} critical_answer;

#define CRITICAL_RUNS 2000

typedef struct critical_curve {
    critical_run run[CRITICAL_RUNS];
    int runs;
} critical_curve;

static inline int critical_scans(const critical_range *r)
{
    return (int)floor((r->high - r->low) / r->scan + 1e-9) + 1;
}

/* Runs of one search, about. */
static inline int critical_cost(const critical_range *r)
{
    return critical_scans(r) + (int)ceil(log(r->scan / r->step) / log(2.0) - 1e-9);
}

/* One velocity into the curve. As study_need. */
static inline int critical_try(study *s, impact_case c, double velocity, const critical_rule *rule,
                               critical_curve *curve, char *message, size_t n)
{
    critical_run *r = &curve->run[curve->runs];
    int status;
    if (curve->runs == CRITICAL_RUNS) {
        snprintf(message, n, "more than %d runs in one study", CRITICAL_RUNS);
        return 0;
    }
    c.velocity = velocity;
    status = study_need(s, &c, r->value, message, n);
    if (status <= 0) return status;
    r->offset = c.offset;
    r->velocity = velocity;
    r->bonds = critical_bonds(rule, c.diameter, r->value);
    curve->runs++;
    return 1;
}

/* The answer that the runs of the curve from `first` on give together. */
static inline critical_answer critical_read(const critical_curve *curve, int first, double offset)
{
    critical_answer a;
    int k;
    memset(&a, 0, sizeof a);
    a.offset = offset;
    a.velocity = HUGE_VAL;
    a.pbcp = a.v_rest = NAN;
    for (k = first; k < curve->runs; k++) {
        const critical_run *r = &curve->run[k];
        if (!r->bonds || r->velocity >= a.velocity) continue;
        a.velocity = r->velocity;
        a.pbcp = r->value[STUDY_PBCP];
        a.v_rest = r->value[STUDY_V_REST];
    }
    for (k = first; k < curve->runs; k++) {
        const critical_run *r = &curve->run[k];
        if (r->velocity < a.velocity && r->velocity > a.below) a.below = r->velocity;
        a.lost += r->velocity > a.velocity && !r->bonds;
    }
    return a;
}

/* Runs of one search from a guess, about: its ends, two steps aside, the bisection. */
static inline int critical_cost_near(const critical_range *range)
{
    return 4 + (int)ceil(log(range->scan / range->step) / log(2.0) - 1e-9);
}

/* The whole range, scan by scan. As study_need. */
static inline int critical_scan(study *s, const impact_case *c, const critical_range *range, const critical_rule *rule,
                                critical_curve *curve, char *message, size_t n)
{
    const int scans = critical_scans(range);
    int k, status = 1;
    for (k = 0; k < scans && status > 0; k++)
        status = critical_try(s, *c, range->low + k * range->scan, rule, curve, message, n);
    return status;
}

/* From a guess of the answer outwards, by steps that double, within the range: down while it bonds, else up until it
   does. As study_need. */
static inline int critical_near(study *s, const impact_case *c, const critical_range *range, const critical_rule *rule,
                                const critical_answer *guess, critical_curve *curve, char *message, size_t n)
{
    double wide = guess->velocity - guess->below, v = fmax(guess->below, range->low);
    int status = critical_try(s, *c, v, rule, curve, message, n);
    const int down = status > 0 && curve->run[curve->runs - 1].bonds;
    if (!down) v = guess->velocity - wide;
    while (status > 0 && (down ? v > range->low : v < range->high)) {
        v = down ? fmax(v - wide, range->low) : fmin(v + wide, range->high);
        status = critical_try(s, *c, v, rule, curve, message, n);
        if (status > 0 && curve->run[curve->runs - 1].bonds != down) break;
        wide *= 2;
    }
    return status;
}

/* Brackets the lowest velocity that bonds - by the whole range, or from a guess of the answer if there is one - and
   halves the gap under it. As study_need. */
static inline int critical_search(study *s, const impact_case *c, const critical_range *range,
                                  const critical_rule *rule, const critical_answer *guess, critical_curve *curve,
                                  critical_answer *a, char *message, size_t n)
{
    const int first = curve->runs;
    int status = guess ? critical_near(s, c, range, rule, guess, curve, message, n)
                       : critical_scan(s, c, range, rule, curve, message, n);
    if (status <= 0) return status;
    *a = critical_read(curve, first, c->offset);
    while (a->velocity < HUGE_VAL && a->below > 0 && a->velocity - a->below > range->step * (1 + 1e-9)) {
        status = critical_try(s, *c, (a->velocity + a->below) / 2, rule, curve, message, n);
        if (status <= 0) return status;
        *a = critical_read(curve, first, c->offset);
    }
    return 1;
}

/* Median and extremes of the answers; infinite ones count as highest. */
typedef struct critical_spread {
    double median, lowest, highest;
    critical_answer middle; /* the answer at the median, the lower of two */
    int none;               /* offsets at which nothing bonded */
} critical_spread;

static inline int critical_order(const void *a, const void *b)
{
    const critical_answer *x = (const critical_answer *)a, *y = (const critical_answer *)b;
    if (x->velocity < y->velocity || x->velocity > y->velocity) return x->velocity > y->velocity ? 1 : -1;
    return (x->offset > y->offset) - (x->offset < y->offset);
}

/* Sorts the answers. */
static inline critical_spread critical_summary(critical_answer *a, int count)
{
    critical_spread s;
    int k;
    qsort(a, (size_t)count, sizeof *a, critical_order);
    s.middle = a[(count - 1) / 2];
    s.median = (s.middle.velocity + a[count / 2].velocity) / 2;
    s.lowest = a[0].velocity;
    s.highest = a[count - 1].velocity;
    s.none = 0;
    for (k = 0; k < count; k++) s.none += !(a[k].velocity < HUGE_VAL);
    return s;
}

#endif
