/* case.h - what the cases of the examples share: checks of a description, whose messages name option
   and value. SPDX-License-Identifier: MIT */
#ifndef CASE_H
#define CASE_H

#include "mpm_io.h"

#include <stdio.h>
#include <string.h>

/* Looks a word up in a list "one|two|three". Returns its place, or -1. */
static inline int case_word(const char *list, const char *word)
{
    size_t n = strlen(word);
    int place = 0;
    while (*list) {
        const char *end = strchr(list, '|');
        size_t m = end ? (size_t)(end - list) : strlen(list);
        if (m == n && !strncmp(list, word, n)) return place;
        place++;
        list += m + (end ? 1 : 0);
    }
    return -1;
}

/* One check of a description: on failure writes a message naming option and value. */
static inline int case_wants(int ok, const char *option, double value, const char *rule, char *message, size_t n)
{
    char text[32];
    if (ok) return 1;
    mpm_io_number_text(text, sizeof text, value);
    snprintf(message, n, "--%s %s: %s", option, text, rule);
    return 0;
}

static inline int case_knows(const char *list, const char *option, const char *word, char *message, size_t n)
{
    if (case_word(list, word) >= 0) return 1;
    snprintf(message, n, "--%s %s: not one of %s", option, word, list);
    return 0;
}

/* part / whole, and 0 of nothing. */
static inline double case_share(double part, double whole) { return whole > 0 ? part / whole : 0; }

#endif
