/* step - speed of the whole step on the default impact (quarter, PTW, contact, bonding, dampers), one
   thread: point-steps per CPU second, bytes per point, and the time of each phase beside a memory
   sweep over the same points, measured in the same run. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "impact_case.h"

#include <time.h>

enum { LOCATE, P2G, FORCES, GRID, CONTACT, G2P, MUSL, STRESS, MOVE, PHASES };
static const char *const names[PHASES] = {"locate", "p2g", "forces", "grid_update", "contact and bond",
                                          "g2p", "musl", "stress", "move"};

int main(void)
{
    impact_case c = impact_case_default();
    double spent[PHASES] = {0}, whole = 0, sweep = 0, sum = 0;
    char message[300];
    clock_t t[PHASES + 1];
    long n, sweeps = 0;
    impact s;
    int i;
    if (!impact_begin(&s, &c, message, sizeof message)) {
        fprintf(stderr, "error: %s\n", message);
        return 1;
    }
    for (n = 0; n < s.steps; n++) {
        mpm_world *w = &s.world;
        t[LOCATE] = clock();
        if (mpm_locate(w, s.dt) < 0) return 1;
        t[P2G] = clock();
        mpm_p2g(w);
        t[FORCES] = clock();
        mpm_forces(w);
        t[GRID] = clock();
        mpm_grid_update(w);
        t[CONTACT] = clock();
        mpm_contact_find(w);
        mpm_bond_grow(&s.bond, w);
        mpm_bond_nodes(&s.bond, w);
        mpm_contact_apply(w);
        t[G2P] = clock();
        mpm_g2p(w);
        t[MUSL] = clock();
        mpm_musl(w);
        t[STRESS] = clock();
        if (mpm_stress(w) < 0) return 1;
        t[MOVE] = clock();
        mpm_move(w);
        t[PHASES] = clock();
        for (i = 0; i < PHASES; i++) spent[i] += (double)(t[i + 1] - t[i]) / (double)CLOCKS_PER_SEC;
        if (n % 10 == 0) { /* every field of every point read once */
            size_t k, all = s.world.stride * (size_t)s.world.fields;
            t[0] = clock();
            for (k = 0; k < all; k++) sum += (double)s.world.field[k];
            sweep += (double)(clock() - t[0]) / (double)CLOCKS_PER_SEC;
            sweeps++;
        }
    }
    for (i = 0; i < PHASES; i++) whole += spent[i];
    sweep /= (double)sweeps * (double)s.world.points.count;
    printf("default impact, %.0f ns: %ld steps of %d points (checksum %.3g)\n", c.time, n, s.world.points.count, sum);
    for (i = 0; i < PHASES; i++)
        printf("  %-18s %7.2f ns per point-step  %5.1f %%\n", names[i],
               1e9 * spent[i] / ((double)n * s.world.points.count), 100 * spent[i] / whole);
    printf("  %-18s %7.2f ns per point-step: %.2f million point-steps per CPU second\n", "whole step",
           1e9 * whole / ((double)n * s.world.points.count), 1e-6 * (double)n * s.world.points.count / whole);
    printf("  %-18s %7.2f ns per point; the step takes %.1f of them\n", "one memory sweep", 1e9 * sweep,
           whole / ((double)n * s.world.points.count) / sweep);
    printf("  %.0f bytes per point\n", (double)mpm_bytes_used(&s.world) / s.world.points.count);
    mpm_free(&s.world);
    return 0;
}
