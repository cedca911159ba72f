/* two_particles - a second particle hits the first (source A, 5.2.2 and Table 5.5).

   Two 14 um aluminium particles at 810 m/s; the first starts on the substrate, the centre of the second
   30 um above it and --offset to the side. Half a model, mirrored at y = 0. Source A, for offsets of
   0, 2.5, 5 and 7.5 um: PBCP 5.73, 5.47, 4.71, 3.91 %; the last one rebounds. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "particles_case.h"

static int carry_out(int argc, char **argv)
{
    static particles_case q;
    const char *leads = "top";
    double offset = 0, height = 30;
    int64_t top;
    option o[IMPACT_OPTIONS];
    char message[200];
    int n, parsed;
    q = particles_default("half", "build/two_particles-out");
    particles_method(&q, argc, argv);
    q.argc = argc;
    q.argv = argv;
    n = particles_options(&q, o);
    option_add(o, &n, "offset", OPTION_REAL, &offset, "of the second particle along x, at the start, um");
    option_add(o, &n, "height", OPTION_REAL, &height, "of its centre over the substrate, at the start, um");
    option_add_word(o, &n, "leads", &leads, "top|bottom",
                    "whose surface sets the (ranked) normal between the two, and is number 1 in the report");
    parsed = options_parse(argc, argv, "Two particles, one after the other, on one spot or beside it.\n"
                           "Writes report.html, particles.csv, pairs.csv, summary.json, history.csv, history.png,\n"
                           "film.png, particles.pvd (ParaView) and frames; run again with the same options\n"
                           "after an interruption, it goes on; a finished scene is not repeated: delete the folder\n"
                           "for that.", o, n);
    if (parsed) return parsed < 0;
    particles_complete(&q);
    if (!particles_check(&q, message, sizeof message) ||
        !case_wants(fabs(offset) < 1e3, "offset", offset, "must be a length in um", message, sizeof message) ||
        !case_wants(height > 0 && height < 1e4, "height", height, "must be > 0 um", message, sizeof message))
        return !complain(message);
    q.count = 2;
    top = !strcmp(leads, "top"); /* its number: the higher one leads */
    q.center[1 - top][2] = impact_half_height(&q.base);
    q.center[top][0] = offset;
    q.center[top][2] = height;
    return particles_done(&q) ? 0 : particles_main(&q, o, n);
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
