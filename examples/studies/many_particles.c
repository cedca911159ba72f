/* many_particles - ten particles, or hundreds, on one substrate (source A, 5.2.3 and Fig. 5.16).

   Places and heights are drawn at random without overlap: the same seed gives the same scene. Source A:
   most of ten bond; one is kept from it by material that others ejected. The whole model at 1.5/0.5 um
   takes eight minutes of one core; source A ran 1.0/0.35. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "particles_case.h"

static int carry_out(int argc, char **argv)
{
    static particles_case q;
    double spread = 60, height = 0;
    int64_t seed = 1;
    option o[IMPACT_OPTIONS];
    char message[300];
    int n, parsed;
    q = particles_default("full", "build/many_particles-out");
    q.count = 10;
    q.base.substrate_diameter = q.base.time = 0;
    particles_method(&q, argc, argv);
    q.argc = argc;
    q.argv = argv;
    n = particles_options(&q, o);
    option_add(o, &n, "count", OPTION_INTEGER, &q.count, "particles, 1 .. 500");
    option_add(o, &n, "spread", OPTION_REAL, &spread, "width of the region of their centres, um");
    option_add(o, &n, "height", OPTION_REAL, &height, "of that region, um; 0: particles fill a fifth of it");
    option_add(o, &n, "seed", OPTION_INTEGER, &seed, "of the places");
    parsed = options_parse(argc, argv,
                           "Particles at random places and heights. --substrate-diameter 0: spread and one particle;\n"
                           "--time 0: the fall from the full height and 40 ns. Writes report.html, particles.csv,\n"
                           "pairs.csv, summary.json, particles.pvd (ParaView) and frames; run again with the same\n"
                           "options after an interruption, it goes on; a finished scene is not repeated: delete the\n"
                           "folder for that.",
                           o, n);
    if (parsed) return parsed < 0;
    if (!case_wants(q.count >= 1 && q.count <= PARTICLES, "count", (double)q.count, "must be 1 .. 500", message,
                    sizeof message) ||
        !particles_check(&q, message, sizeof message) ||
        !case_wants(spread > 0 && spread < 1e4, "spread", spread, "must be > 0 um", message, sizeof message) ||
        !case_wants(height >= 0 && height < 1e4, "height", height, "must be >= 0 um", message, sizeof message) ||
        !case_wants(q.base.velocity > 0, "velocity", q.base.velocity, "must be > 0 m/s", message, sizeof message))
        return !complain(message);
    if (!(height > 0)) height = particles_height(&q, spread);
    if (!particles_place(&q, spread, height, seed, message, sizeof message)) return !complain(message);
    return particles_done(&q) ? 0 : particles_main(&q, o, n);
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
