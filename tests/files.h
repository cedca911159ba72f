/* files.h - what a program wrote, as tests read it. SPDX-License-Identifier: MIT */
#ifndef FILES_H
#define FILES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a file holds, up to room - 1 bytes, in `text`. Returns its length; 0 if there is none. */
static inline size_t contents(const char *path, char *text, size_t room)
{
    FILE *f = fopen(path, "rb");
    size_t n = 0;
    if (f) {
        n = fread(text, 1, room - 1, f);
        fclose(f);
    }
    text[n] = 0;
    return n;
}

/* The text of a file, up to 20,000 bytes and until the next call; "" if there is none. */
static inline const char *text_of(const char *path)
{
    static char text[20000];
    contents(path, text, sizeof text);
    return text;
}

/* The number behind "key": in a JSON file; -1e300 if there is none. */
static inline double number_in(const char *path, const char *key)
{
    char quoted[64];
    const char *at;
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    at = strstr(text_of(path), quoted);
    return at ? strtod(at + strlen(quoted), NULL) : -1e300;
}

#endif
