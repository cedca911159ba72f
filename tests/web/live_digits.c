/* live_digits - an impact of the live page as the desktop computes it: takes the words of a command line of
   build/impact, prints the numbers of live_digits in web/live/live.c, one a line. tests/web/live_digits.mjs compares
   the two.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_options.h"

static void print(double value) { printf("%.17g\n", value); }

int main(int argc, char **argv)
{
    const int surface = !strcmp(impact_method(argc, argv, "thesis"), "surface");
    impact_case c = surface ? impact_case_surface() : impact_case_default();
    option options[IMPACT_OPTIONS];
    char message[300];
    double x = 0, z = 0;
    mpm_totals all;
    impact s;
    int32_t i;
    if (options_parse(argc, argv, "The sums of an impact.", options, impact_options(&c, options))) return 1;
    impact_complete(&c);
    if (!impact_begin(&s, &c, message, sizeof message)) return fprintf(stderr, "error: %s\n", message), 1;
    while (s.world.steps < s.steps)
        if (impact_step(&s) < 0) return 1;
    all = mpm_body_totals(&s.world, -1);
    for (i = 0; i < s.world.points.count; i++) {
        x += s.world.points.x[0][i];
        z += s.world.points.x[2][i];
    }
    print(all.kinetic);
    print(all.internal);
    print(all.plastic);
    print(all.momentum[2]);
    print(x);
    print(z);
    print(s.world.ledger.absorbed);
    print(s.world.ledger.contact);
    print(s.world.ledger.hold);
    impact_end(&s);
    return program_end(0);
}
