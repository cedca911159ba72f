/* options.h - the examples' command line: one table, parsed, printed as help and as provenance.
   SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "mpm.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- words ----------------------------------------------------------------------------------- */

/* The place of a word in a list "one|two|three", or -1. */
static inline int word_place(const char *list, const char *word)
{
    int place = 0;
    while (*list) {
        const size_t n = strcspn(list, "|");
        if (n == strlen(word) && !strncmp(list, word, n)) return place;
        place++;
        list += n + (list[n] == '|');
    }
    return -1;
}

/* Whether a command line may choose a word of a list. "user" wants a function, which only a program can give. */
static inline int word_known(const char *list, const char *word)
{
    return word_place(list, word) >= 0 && strcmp(word, "user");
}

/* How many characters of a list to show: all but a last "|user". */
static inline int words_shown(const char *list)
{
    const size_t n = strlen(list);
    return (int)(n > 5 && !strcmp(list + n - 5, "|user") ? n - 5 : n);
}

/* ---- the table ------------------------------------------------------------------------------- */

typedef enum option_type { OPTION_REAL, OPTION_INTEGER, OPTION_TEXT, OPTION_WORD, OPTION_FLAG } option_type;

/* One option: --name VALUE (or --name alone for a flag). `value` points to a double, an int64_t, a
   const char * (of a text or a word) or an int, holding the default. */
typedef struct option {
    const char *name;
    option_type type;
    void *value;
    const char *help;
    const char *words; /* of OPTION_WORD: "one|two|three" */
} option;

/* Puts an option behind the n of a table. */
static inline void option_add(option *o, int *n, const char *name, option_type type, void *value, const char *help)
{
    o[*n].name = name;
    o[*n].type = type;
    o[*n].value = value;
    o[*n].help = help;
    o[*n].words = "";
    (*n)++;
}

/* The same of an option whose value is one of some words. */
static inline void option_add_word(option *o, int *n, const char *name, const char **value, const char *words,
                                   const char *help)
{
    option_add(o, n, name, OPTION_WORD, value, help);
    o[*n - 1].words = words;
}

/* The option of that name among n. */
static inline int option_find(const option *o, int n, const char *name)
{
    int k = 0;
    while (k < n && strcmp(o[k].name, name)) k++;
    return k;
}

/* Takes an option out of a table of n, so that a command line cannot set it. */
static inline void option_drop(option *o, int *n, const char *name)
{
    int k = option_find(o, *n, name);
    if (k < *n)
        for ((*n)--; k < *n; k++) o[k] = o[k + 1];
}

#define OPTION_NUMBER 40 /* bytes of a number as text */

/* The current value of o as text, of any length; a number is put into the buffer. */
static inline const char *option_text(const option *o, char number[OPTION_NUMBER])
{
    switch (o->type) {
    case OPTION_REAL: snprintf(number, OPTION_NUMBER, "%.15g", *(double *)o->value); return number;
    case OPTION_INTEGER: snprintf(number, OPTION_NUMBER, "%lld", (long long)*(int64_t *)o->value); return number;
    case OPTION_FLAG: return *(int *)o->value ? "on" : "off";
    case OPTION_TEXT:
    case OPTION_WORD: break;
    }
    return *(const char **)o->value;
}

static inline void options_help(const char *program, const char *about, const option *o, int n)
{
    int i;
    printf("usage: %s [options]\n%s\n\noptions (default in brackets):\n", program, about);
    for (i = 0; i < n; i++) {
        char number[OPTION_NUMBER];
        printf("  --%-20s ", o[i].name);
        if (o[i].type == OPTION_WORD) printf("%.*s: ", words_shown(o[i].words), o[i].words);
        printf("%s [%s]\n", o[i].help, option_text(&o[i], number));
    }
    printf("  --%-20s %s\n", "version", "of the library");
    printf("  --%-20s %s\n", "help", "this text");
}

/* Sets one option from its text. Returns 0, or -1 after a message naming the value. */
static inline int option_set(const option *o, const char *text)
{
    char *end = NULL;
    errno = 0;
    if (o->type == OPTION_WORD && !word_known(o->words, text)) {
        fprintf(stderr, "error: --%s %s: not one of %.*s\n", o->name, text, words_shown(o->words), o->words);
        return -1;
    }
    if (o->type == OPTION_REAL) {
        double v = strtod(text, &end);
        if (end == text || *end || isnan(v)) goto bad;
        *(double *)o->value = v;
    } else if (o->type == OPTION_INTEGER) {
        long long v = strtoll(text, &end, 10);
        if (end == text || *end || errno) goto bad;
        *(int64_t *)o->value = v;
    } else {
        *(const char **)o->value = text;
    }
    return 0;
bad:
    fprintf(stderr, "error: --%s needs a%s number, not '%s'\n", o->name,
            o->type == OPTION_INTEGER ? " whole" : "", text);
    return -1;
}

/* Reads argv into the table. Returns 0 to go on, 1 after --help or --version, -1 after an error message. */
static inline int options_parse(int argc, char **argv, const char *about, const option *o, int n)
{
    int a, i;
    for (a = 1; a < argc; a++) {
        const char *name = argv[a];
        if (!strcmp(name, "--help") || !strcmp(name, "-h")) {
            options_help(argv[0], about, o, n);
            return 1;
        }
        if (!strcmp(name, "--version")) {
            printf("mpm.h %s\n", mpm_version());
            return 1;
        }
        i = strncmp(name, "--", 2) ? n : option_find(o, n, name + 2);
        if (i == n) {
            fprintf(stderr, "error: unknown option '%s' (see --help)\n", name);
            return -1;
        }
        if (o[i].type == OPTION_FLAG) {
            *(int *)o[i].value = 1;
        } else if (a + 1 == argc) {
            fprintf(stderr, "error: %s needs a value\n", name);
            return -1;
        } else if (option_set(&o[i], argv[++a])) {
            return -1;
        }
    }
    return 0;
}

/* ---- names and the end ------------------------------------------------------------------------ */

#define PATH_BYTES 4096 /* longest path that a system opens */

/* folder/name, or "" where that is too long: all that opens files refuses it, nothing is cut. Returns path. */
static inline const char *file_in(const char *folder, const char *name, char *path, size_t n)
{
    const int length = snprintf(path, n, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= n) path[0] = 0;
    return path;
}

/* What main returns: the status so far, but 1 after a message if something printed was lost. Test: 74_programs. */
static inline int program_end(int status)
{
    const int lost = fflush(stdout) != 0 || ferror(stdout);
    if (!lost) return status;
    fprintf(stderr, "error: standard output cannot be written\n");
    return status ? status : 1;
}

#endif
