/* case.h - what the cases of the examples share: checks of a description, whose messages name option
   and value. SPDX-License-Identifier: MIT */
#ifndef CASE_H
#define CASE_H

#include "mpm_io.h"
#include "mpm_ptw.h"
#include "options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A word of a list X(enum, "name", "text") of the library: CASE_BAR puts all of them behind a program's own,
   "preset" MPM_STRENGTH_LIST(CASE_BAR). */
#define CASE_BAR(constant, word, text) "|" word

/* One check of a description: on failure writes a message naming option and value. */
static inline int case_wants(int ok, const char *name, double value, const char *rule, char *message, size_t n)
{
    char text[32];
    if (ok) return 1;
    mpm_io_number_text(text, sizeof text, value);
    snprintf(message, n, "--%s %s: %s", name, text, rule);
    return 0;
}

static inline int case_knows(const char *list, const char *name, const char *word, char *message, size_t n)
{
    if (word_known(list, word)) return 1;
    snprintf(message, n, "--%s %s: not one of %.*s", name, word, words_shown(list), list);
    return 0;
}

/* A preset at another temperature than its own. Pressure and density start as at 298 K, without the energy of the heat:
   it melts at the point of metal that was heated from there. */
static inline void case_heat(mpm_material *m, double kelvin)
{
    const mpm_real point = mpm_material_melting_point(m);
    if (!(fabs(kelvin - (double)m->temperature) > 0)) return;
    m->temperature = (mpm_real)kelvin;
    mpm_material_melts_at(m, point, NULL); /* refuses what never melts, and leaves it */
}

/* part / whole, and 0 of nothing. */
static inline double case_share(double part, double whole) { return whole > 0 ? part / whole : 0; }

#endif
