/* program.h - what the example programs say and where they write. SPDX-License-Identifier: MIT */
#ifndef PROGRAM_H
#define PROGRAM_H

#include "mpm_io.h"
#include "options.h"

static inline int complain(const char *message)
{
    fprintf(stderr, "error: %s\n", message);
    return 0;
}

/* "what: the fault in words" */
static inline int report(const mpm_fault *fault, const char *what)
{
    char text[256];
    mpm_io_fault_text(text, sizeof text, fault);
    fprintf(stderr, "error: %s: %s\n", *what ? what : "a path that is too long", text);
    return 0;
}

/* The options of a run, as the object "options" of its summary. */
static inline void options_json(mpm_io_json *j, const option *options, int n)
{
    char number[OPTION_NUMBER];
    int i;
    mpm_io_json_open(j, "options");
    for (i = 0; i < n; i++) {
        const option *o = &options[i];
        if (o->type == OPTION_REAL) mpm_io_json_number(j, o->name, *(double *)o->value);
        else if (o->type == OPTION_INTEGER) mpm_io_json_integer(j, o->name, *(int64_t *)o->value);
        else mpm_io_json_string(j, o->name, option_text(o, number));
    }
    mpm_io_json_close(j);
}

/* Whether there is a file to read: 1 or 0; -1, after a message, if it is there and cannot be opened, or its path was
   too long (""). */
static inline int is_there(const char *path)
{
    FILE *f;
    errno = 0;
    f = fopen(path, "rb");
    if (f) return fclose(f), 1;
    if (*path && errno == ENOENT) return 0;
    fprintf(stderr, "error: %s cannot be read\n", *path ? path : "a path that is too long");
    return -1;
}

/* The text of a file, or "" if there is none. Returns 1; 0, with "" too, if the file is there and cannot be read, is
   longer than room - 1 bytes or holds a zero. */
static inline int text_read(const char *path, char *text, size_t room)
{
    FILE *f;
    size_t n;
    int whole;
    text[0] = 0;
    errno = 0;
    f = fopen(path, "rb");
    if (!f) return errno == ENOENT;
    n = fread(text, 1, room - 1, f);
    text[n] = 0;
    whole = strlen(text) == n && fgetc(f) == EOF && !ferror(f);
    fclose(f);
    if (!whole) text[0] = 0;
    return whole;
}

/* The same, where what cannot be read is as good as nothing. Returns text. */
static inline const char *text_in(const char *path, char *text, size_t room)
{
    text_read(path, text, room);
    return text;
}

/* FNV-1a, 64 bits, of a text; `h`: the hash of what goes before it, or HASH_NONE. */
#define HASH_NONE UINT64_C(14695981039346656037)
static inline uint64_t hash_text(uint64_t h, const char *text)
{
    for (; *text; text++) h = (h ^ (uint64_t)(unsigned char)*text) * UINT64_C(1099511628211);
    return h;
}

/* The same of the first `lines` lines of a file. Returns 1; 0 if it has not so many whole ones, or cannot be read. */
static inline int hash_lines(FILE *f, int64_t lines, uint64_t *h)
{
    char one[2] = "";
    for (*h = HASH_NONE; lines > 0; lines -= *one == '\n') {
        const int c = fgetc(f);
        if (c <= 0) return 0; /* a table holds no zero */
        one[0] = (char)c;
        *h = hash_text(*h, one);
    }
    return 1;
}

#define HASH_DIGITS 17 /* bytes of a hash in hexadecimal digits */
static inline const char *hash_digits(uint64_t h, char text[HASH_DIGITS])
{
    snprintf(text, HASH_DIGITS, "%08lx%08lx", (unsigned long)(h >> 32) & 0xffffffffu,
             (unsigned long)(h & 0xffffffffu));
    return text;
}

/* What stands behind "key": in the text of a summary, or NULL. */
static inline const char *json_value(const char *text, const char *key)
{
    char quoted[80];
    const char *at;
    snprintf(quoted, sizeof quoted, "\"%s\": ", key);
    at = strstr(text, quoted);
    return at ? at + strlen(quoted) : NULL;
}

/* Whether a summary was made with these n options: each is there with its value, or is not there and has its
   value of `plain`, the same table with the defaults. */
static inline int options_match(const char *summary, const option *o, const option *plain, int n)
{
    const char *block = json_value(summary, "options");
    char mine[OPTION_NUMBER], theirs[OPTION_NUMBER];
    int k;
    if (!block) return 0;
    for (k = 0; k < n; k++) {
        const char *at = json_value(block, o[k].name);
        const int quoted = o[k].type != OPTION_REAL && o[k].type != OPTION_INTEGER;
        const char *text = option_text(&o[k], mine), *other = theirs;
        const size_t length = strlen(text);
        if (!at) other = option_text(&plain[k], theirs);
        else if (!quoted) snprintf(theirs, sizeof theirs, "%.15g", strtod(at, NULL));
        else if (*at == '"' && !strncmp(at + 1, text, length) && at[1 + length] == '"') continue;
        else return 0;
        if (strcmp(text, other)) return 0;
    }
    return 1;
}

#endif
