/* many_particles - ten particles, or hundreds, on one substrate (source A, 5.2.3 and Fig. 5.16).

   Places and heights are drawn at random without overlap: the same seed gives the same scene. Source A:
   most of ten bond; one is kept from it by material that others ejected. The whole model at 1.5/0.5 um
   takes eight minutes of one core; source A ran 1.0/0.35. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "particles_case.h"

static int carry_out(int argc, char **argv)
{
    static particles_case q;
    particles_random places = particles_random_default();
    option o[IMPACT_OPTIONS];
    char message[300];
    int n, parsed;
    q = particles_many(argc, argv, "build/many_particles-out");
    n = particles_many_options(&q, &places, o);
    parsed = options_parse(argc, argv,
                           "Particles at random places and heights. --substrate-diameter 0: spread and one particle;\n"
                           "--time 0: the fall from the full height and 40 ns. Writes report.html, particles.csv,\n"
                           "pairs.csv, summary.json, history.csv, history.png, film.png, particles.pvd (ParaView)\n"
                           "and frames; run again with the same options after an interruption, it goes on; a\n"
                           "finished scene is not repeated: delete the folder for that.",
                           o, n);
    if (parsed) return parsed < 0;
    if (!particles_many_place(&q, &places, message, sizeof message)) return !complain(message);
    return particles_done(&q) ? 0 : particles_main(&q, o, n);
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
