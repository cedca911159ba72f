/* files.h - files as tests read and write them. SPDX-License-Identifier: MIT */
#ifndef FILES_H
#define FILES_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- bytes ----------------------------------------------------------------------------------- */

static inline int exists(const char *path)
{
    FILE *f = fopen(path, "rb");
    if (f) fclose(f);
    return f != NULL;
}

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

/* The whole of a file in fresh memory, up to 16 MB, with a zero behind; NULL if there is none. */
static inline unsigned char *slurp(const char *path, size_t *n)
{
    const size_t room = (size_t)1 << 24;
    char *data = exists(path) ? (char *)malloc(room) : NULL;
    *n = data ? contents(path, data, room) : 0;
    return (unsigned char *)data;
}

static inline void write_file(const char *path, const void *data, size_t n)
{
    FILE *f = fopen(path, "wb");
    if (!f) return;
    if (n) fwrite(data, 1, n, f);
    fclose(f);
}

/* ---- ParaView ---------------------------------------------------------------------------------- */

/* The appended array of a given name in a .vtu of n bytes: its bytes and their number, as the tag's offset says. */
static inline const unsigned char *vtu_array(const unsigned char *file, size_t n, const char *name, const char *type,
                                             uint64_t *bytes)
{
    char tag[96];
    const char *text = (const char *)file, *found, *offset;
    size_t start = 0;
    while (start + 22 < n && memcmp(text + start, "encoding=\"raw\">\n_", 17) != 0) start++;
    start += 17;
    snprintf(tag, sizeof tag, "type=\"%s\" Name=\"%s\"", type, name);
    found = strstr(text, tag);
    offset = found ? strstr(found, "offset=\"") : NULL;
    *bytes = 0;
    if (!offset) return NULL;
    start += strtoul(offset + 8, NULL, 10);
    if (start + 8 > n) return NULL;
    memcpy(bytes, file + start, 8);
    return start + 8 + *bytes <= n ? file + start + 8 : NULL;
}

/* ---- text ------------------------------------------------------------------------------------ */

/* The text of a file, up to 20,000 bytes and until the next call; "" if there is none. */
static inline const char *text_of(const char *path)
{
    static char text[20000];
    contents(path, text, sizeof text);
    return text;
}

static inline int lines_of(const char *text)
{
    int n = 0;
    for (; *text; text++) n += *text == '\n';
    return n;
}

/* How many lines a file has, of zeros too; -1 if there is none. */
static inline long lines_in(const char *path)
{
    size_t n, i;
    unsigned char *data = slurp(path, &n);
    long lines = data ? 0 : -1;
    for (i = 0; i < n; i++) lines += data[i] == '\n';
    free(data);
    return lines;
}

/* The number behind `key` in a text; not a number if there is none: that equals nothing and lies in no range. */
static inline double number_behind(const char *text, const char *key)
{
    const char *at = strstr(text, key);
    return at ? strtod(at + strlen(key), NULL) : (double)NAN;
}

/* The number behind "key": in a JSON file; not a number if there is none. */
static inline double number_in(const char *path, const char *key)
{
    char quoted[80];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    return number_behind(text_of(path), quoted);
}

#endif
