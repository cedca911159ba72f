/* png.h - a PNG reader that shares nothing with the writer: an inflate and all checksums of its own.
   SPDX-License-Identifier: MIT */
#ifndef PNG_H
#define PNG_H

#include "files.h"

#include <stdint.h>

typedef struct inflater {
    const unsigned char *in;
    size_t n, bit;
} inflater;

static inline unsigned take(inflater *z, int count)
{
    unsigned value = 0;
    int k;
    for (k = 0; k < count; k++, z->bit++)
        if (z->bit / 8 < z->n) value |= (unsigned)(z->in[z->bit / 8] >> z->bit % 8 & 1) << k;
    return value;
}

/* Decodes one symbol by comparing with the codes of each length in turn. */
static inline int symbol(inflater *z, const unsigned char *length, int n)
{
    int code = 0, first = 0, bits, i;
    for (bits = 1; bits < 16; bits++) {
        int count = 0, seen = 0;
        code = code << 1 | (int)take(z, 1);
        first <<= 1;
        for (i = 0; i < n; i++) count += length[i] == bits;
        if (code - first < count) {
            for (i = 0; i < n; i++)
                if (length[i] == bits && seen++ == code - first) return i;
        }
        first += count;
    }
    return -1;
}

static inline void read_trees(inflater *z, unsigned char *literal, unsigned char *distance)
{
    static const int order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    unsigned char meta[19] = {0}, all[320] = {0};
    int literals = (int)take(z, 5) + 257, distances = (int)take(z, 5) + 1, i = 0;
    int metas = (int)take(z, 4) + 4;
    for (i = 0; i < metas; i++) meta[order[i]] = (unsigned char)take(z, 3);
    for (i = 0; i < literals + distances;) {
        int s = symbol(z, meta, 19), times = 1;
        unsigned char value = (unsigned char)s;
        if (s < 0) return;
        if (s == 16) {
            value = i > 0 ? all[i - 1] : 0;
            times = 3 + (int)take(z, 2);
        } else if (s > 16) {
            value = 0;
            times = s == 17 ? 3 + (int)take(z, 3) : 11 + (int)take(z, 7);
        }
        while (times-- > 0 && i < 320) all[i++] = value;
    }
    memcpy(literal, all, (size_t)literals);
    memcpy(distance, all + literals, (size_t)distances);
}

/* Inflates raw deflate data into out[room]; returns the length, or room + 1 on any error. */
static inline size_t inflate_all(inflater *z, unsigned char *out, size_t room)
{
    static unsigned char literal[288], distance[32];
    size_t n = 0;
    int last = 0, i;
    while (!last) {
        int kind;
        last = (int)take(z, 1);
        kind = (int)take(z, 2);
        if (kind == 0 || kind == 3) return room + 1; /* our writer makes neither */
        memset(literal, 0, sizeof literal);
        memset(distance, 0, sizeof distance);
        if (kind == 2) read_trees(z, literal, distance);
        else {
            for (i = 0; i < 288; i++) literal[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
            for (i = 0; i < 30; i++) distance[i] = 5;
        }
        for (;;) {
            int s = symbol(z, literal, 288);
            size_t length = 3, back = 1;
            if (s < 0 || z->bit / 8 > z->n) return room + 1;
            if (s == 256) break;
            if (s < 256) {
                if (n == room) return room + 1;
                out[n++] = (unsigned char)s;
                continue;
            }
            for (i = 257; i < s; i++) length += (size_t)1 << (i < 265 ? 0 : (i - 261) / 4);
            if (s == 285) length = 258;
            else length += take(z, s < 265 ? 0 : (s - 261) / 4);
            s = symbol(z, distance, 30);
            if (s < 0) return room + 1;
            for (i = 0; i < s; i++) back += (size_t)1 << (i < 4 ? 0 : (i - 2) / 2);
            back += take(z, s < 4 ? 0 : (s - 2) / 2);
            if (back > n || n + length > room) return room + 1;
            while (length-- > 0) {
                out[n] = out[n - back];
                n++;
            }
        }
    }
    return n;
}

static inline uint32_t crc_bitwise(const unsigned char *p, size_t n)
{
    uint32_t crc = 0xffffffffu;
    int k;
    while (n--)
        for (crc ^= *p++, k = 0; k < 8; k++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    return ~crc;
}

static inline uint32_t adler(const unsigned char *p, size_t n)
{
    uint32_t a = 1, b = 0;
    for (; n > 0; n--) {
        a = (a + *p++) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

static inline uint32_t big(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static inline void unfilter(unsigned char *raw, int width, int height)
{
    size_t n = 3 * (size_t)width, i;
    int y;
    for (y = 0; y < height; y++) {
        unsigned char *row = raw + (size_t)y * (n + 1) + 1, *up = y > 0 ? row - n - 1 : NULL;
        for (i = 0; i < n; i++) {
            int a = i >= 3 ? row[i - 3] : 0, b = up ? up[i] : 0, c = up && i >= 3 ? up[i - 3] : 0;
            int p = a + b - c, pa = abs(p - a), pb = abs(p - b), pc = abs(p - c), guess = 0;
            if (row[-1] == 1) guess = a;
            if (row[-1] == 2) guess = b;
            if (row[-1] == 3) guess = (a + b) / 2;
            if (row[-1] == 4) guess = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
            row[i] = (unsigned char)(row[i] + guess);
        }
    }
    for (y = 0; y < height; y++) memmove(raw + (size_t)y * n, raw + (size_t)y * (n + 1) + 1, n);
}

/* The pixels of compressed rows, packed bytes of them, or NULL. */
static inline unsigned char *read_rows(const unsigned char *data, size_t packed, int width, int height)
{
    const size_t raw = (3 * (size_t)width + 1) * (size_t)height;
    unsigned char *out = (unsigned char *)malloc(raw);
    inflater z;
    z.in = data + 2;
    z.n = packed < 6 ? 0 : packed - 6;
    z.bit = 0;
    if (out && packed > 6 && (data[0] * 256 + data[1]) % 31 == 0 && inflate_all(&z, out, raw) == raw &&
        (z.bit + 7) / 8 == z.n && adler(out, raw) == big(data + packed - 4)) {
        unfilter(out, width, height);
        return out;
    }
    free(out);
    return NULL;
}

/* What a film says of itself: pictures, times it is shown (0: for ever), thousandths of a second of the one read. */
typedef struct film_said {
    int pictures, plays, ms;
} film_said;

/* Reads a PNG, or picture `number` of a film (said: not NULL), checking every chunk: sums, a picture's head before its
   rows, numbers in a row. Returns its 8-bit RGB pixels or NULL. */
static inline unsigned char *read_picture(const char *path, int number, int *width, int *height, film_said *said)
{
    size_t n, at = 8, packed = 0;
    uint32_t chunks = 0;
    unsigned char *file = slurp(path, &n), *data, *out = NULL;
    int good = file && n > 57 && memcmp(file, "\x89PNG\r\n\x1a\n", 8) == 0, ended = 0, pictures = 0, heads = -1;
    data = (unsigned char *)malloc(n + 1);
    if (said) said->pictures = said->plays = said->ms = -1;
    while (good && data && !ended) {
        const unsigned char *type = file + at + 4, *body = file + at + 8;
        size_t length = big(file + at), from = 0;
        good = at + length + 12 <= n && crc_bitwise(type, length + 4) == big(body + length);
        if (!good) break;
        if (said && memcmp(type, "acTL", 4) == 0) {
            good = length == 8 && heads < 0;
            heads = 0;
            said->pictures = (int)big(body);
            said->plays = (int)big(body + 4);
        }
        if (said && memcmp(type, "fcTL", 4) == 0) {
            good = length == 26 && heads >= 0 && big(body) == chunks++ && memcmp(body + 4, file + 16, 8) == 0 &&
                   big(body + 12) == 0 && big(body + 16) == 0 && body[22] * 256 + body[23] == 1000 && body[24] == 0 &&
                   body[25] == 0;
            if (heads++ == number) said->ms = body[20] * 256 + body[21];
        }
        if (said && memcmp(type, "fdAT", 4) == 0) good = heads > 1 && length > 4 && big(body) == chunks++;
        if (memcmp(type, "fdAT", 4) == 0) from = 4;
        if (memcmp(type, "IDAT", 4) == 0) good = !said || heads == 1;
        if ((memcmp(type, "IDAT", 4) == 0 && (!said || number == 0)) ||
            (said && from && heads == number + 1)) {
            memcpy(data + packed, body + from, length - from);
            packed += length - from;
        }
        pictures = heads;
        ended = memcmp(type, "IEND", 4) == 0;
        at += length + 12;
        if (!ended && at + 12 > n) good = 0;
    }
    good = good && at == n && memcmp(file + 12, "IHDR", 4) == 0 && (!said || pictures == said->pictures);
    if (good && file[24] == 8 && file[25] == 2 && file[26] == 0 && file[27] == 0 && file[28] == 0) {
        *width = (int)big(file + 16);
        *height = (int)big(file + 20);
        out = read_rows(data, packed, *width, *height);
    }
    free(file);
    free(data);
    return out;
}

static inline unsigned char *read_png(const char *path, int *width, int *height)
{
    return read_picture(path, 0, width, height, NULL);
}

#endif
