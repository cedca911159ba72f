/* many_particles - ten particles, or hundreds, on one substrate (source A, 5.2.3 and Fig. 5.16).

   Places and heights are drawn at random without overlap: the same seed gives the same scene. Source A:
   most of ten bond; one is kept from it by material that others ejected. The whole model at 1.5/0.5 um
   takes some minutes; source A ran 1.0/0.35. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "particles_case.h"

/* The next number in [0, 1): splitmix64. */
static double draw(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

/* Centres in a cylinder over the substrate, at least a diameter and a cell apart, the lowest on the
   substrate. Returns 1, or 0 when there is no room. */
static int place(particles_case *q, double spread, double height, long seed)
{
    const double apart = q->base.diameter + q->base.cell, pi = 3.14159265358979323846;
    uint64_t state = (uint64_t)seed;
    double least = HUGE_VAL;
    long k, other, tries = 0;
    for (k = 0; k < q->count; k++) {
        double *x = q->center[k], r, phi, d2 = HUGE_VAL;
        do {
            if (tries++ > 200000) return 0;
            r = spread / 2 * sqrt(draw(&state));
            phi = 2 * pi * draw(&state);
            x[0] = r * cos(phi);
            x[1] = r * sin(phi);
            x[2] = height * draw(&state);
            for (other = 0, d2 = HUGE_VAL; other < k; other++) {
                const double *y = q->center[other];
                d2 = fmin(d2, (x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) + (x[2] - y[2]) * (x[2] - y[2]));
            }
        } while (d2 < apart * apart);
        least = fmin(least, x[2]);
    }
    for (k = 0; k < q->count; k++) q->center[k][2] += q->base.diameter / 2 - least;
    return 1;
}

int main(int argc, char **argv)
{
    static particles_case q;
    double spread = 36, height = 0;
    long seed = 1;
    option o[IMPACT_OPTIONS];
    char message[200];
    int n, parsed;
    q = particles_default("full", "many-out");
    q.count = 10;
    q.base.substrate_diameter = q.base.time = 0;
    n = particles_options(&q, o);
    option_add(o, &n, "count", OPTION_LONG, &q.count, "particles, 1 .. 500");
    option_add(o, &n, "spread", OPTION_REAL, &spread, "width of the region of their centres, um");
    option_add(o, &n, "height", OPTION_REAL, &height, "of that region, um; 0: particles fill a fifth of it");
    option_add(o, &n, "seed", OPTION_LONG, &seed, "of the places");
    parsed = options_parse(argc, argv, "Particles at random places and heights. --substrate-diameter 0: spread and one diameter;\n"
                           "--time 0: the fall from the full height and 40 ns. Writes particles.csv, pairs.csv,\n"
                           "summary.json and frames.", o, n);
    if (parsed) return parsed < 0;
    if (!case_wants(q.count >= 1 && q.count <= PARTICLES, "count", (double)q.count, "must be 1 .. 500", message, sizeof message) ||
        !case_wants(q.frames >= 0 && q.frames < 10000, "frames", (double)q.frames, "must be 0 .. 9999", message, sizeof message) ||
        !case_wants(spread > 0 && spread < 1e4, "spread", spread, "must be > 0 um", message, sizeof message) ||
        !case_wants(height >= 0 && height < 1e4, "height", height, "must be >= 0 um", message, sizeof message) ||
        !case_wants(q.base.velocity > 0, "velocity", q.base.velocity, "must be > 0 m/s", message, sizeof message))
        return fprintf(stderr, "error: %s\n", message), 1;
    if (!(height > 0)) height = (double)q.count * q.base.diameter * q.base.diameter * q.base.diameter / 6 / 0.2 / (spread * spread / 4);
    if (!(q.base.substrate_diameter > 0)) q.base.substrate_diameter = spread + q.base.diameter;
    if (!(q.base.time > 0)) q.base.time = 1e3 * height / q.base.velocity + 40;
    if (!impact_check(&q.base, message, sizeof message)) return fprintf(stderr, "error: %s\n", message), 1;
    if (!place(&q, spread, height, seed))
        return fprintf(stderr, "error: --count %ld: no room for so many; larger --spread or --height\n", q.count), 1;
    return particles_main(&q, o, n);
}
