/* fuzz.h - what the fuzz targets share: numbers drawn from the fuzzer's bytes. A byte below 160 leaves a value as it
   is, so that no bytes at all give a plain valid case and a few give one that is wrong in a few places. Built without
   libFuzzer but with FUZZ_CORPUS it is the generator of the first inputs. SPDX-License-Identifier: MIT */
#ifndef FUZZ_H
#define FUZZ_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Memory as a small machine would have it: a case that asks for more is refused, not served. */
#define FUZZ_MEMORY ((size_t)1 << 25)
static inline void *fuzz_malloc(size_t n) { return n <= FUZZ_MEMORY ? malloc(n) : NULL; }
#define MPM_MALLOC(n) fuzz_malloc(n)
#define MPM_FREE(p) free(p)
#include "mpm.h"

typedef struct fuzz {
    const uint8_t *at;
    size_t left;
} fuzz;

static inline unsigned fuzz_byte(fuzz *f)
{
    if (!f->left) return 0;
    f->left--;
    return *f->at++;
}

static inline void fuzz_bytes(fuzz *f, void *to, size_t n)
{
    size_t i;
    for (i = 0; i < n; i++) ((unsigned char *)to)[i] = (unsigned char)fuzz_byte(f);
}

/* Any number: a special one, a small one, a power of ten, or eight bytes as they come. */
static inline double fuzz_any(fuzz *f)
{
    static const double special[] = {0,     -0.0,   1,    -1,   0.5,   1e-300, -1e-300, 1e300,   -1e300, NAN,
                                     INFINITY, -INFINITY, 5e-324, 2147483647.0, -2147483648.0, 9.3e18, 1e-30, 1e30};
    const unsigned kind = fuzz_byte(f), b = fuzz_byte(f);
    double x;
    if (kind < 80) return special[b % (sizeof special / sizeof *special)];
    if (kind < 140) return ((double)b - 128) / 16;
    if (kind < 200) return (kind & 1 ? -1 : 1) * pow(10, ((double)b - 128) / 4);
    fuzz_bytes(f, &x, sizeof x);
    return x;
}

static inline double fuzz_double(fuzz *f, double x)
{
    const unsigned b = fuzz_byte(f);
    if (b < 160) return x;
    return b < 200 ? x * (1 + ((double)b - 180) / 32) : fuzz_any(f);
}
#define FUZZ_REAL(f, x) ((x) = (mpm_real)fuzz_double(f, (double)(x)))

static inline void fuzz_reals(fuzz *f, mpm_real *x, int n)
{
    int i;
    for (i = 0; i < n; i++) FUZZ_REAL(f, x[i]);
}

static inline int32_t fuzz_int(fuzz *f, int32_t x)
{
    static const int32_t special[] = {0, 1, -1, 2, 3, INT32_MAX, INT32_MIN, INT32_MAX - 1, 65536, 1000, -7, 8};
    const unsigned b = fuzz_byte(f);
    if (b < 160) return x;
    if (b < 190) return (int32_t)(b - 160);
    if (b < 230) return special[b % 12];
    fuzz_bytes(f, &x, sizeof x);
    return x;
}

/* An enum or another int, through its bits: any value may come. */
#define FUZZ_CHOICE(f, x) do { int fuzz_v; memcpy(&fuzz_v, &(x), sizeof fuzz_v); \
    fuzz_v = fuzz_int(f, fuzz_v); memcpy(&(x), &fuzz_v, sizeof fuzz_v); } while (0)

/* A text of up to n - 1 bytes, any but 0. */
static inline const char *fuzz_text(fuzz *f, char *text, size_t n)
{
    size_t length = fuzz_byte(f) % n, i;
    for (i = 0; i < length; i++) {
        const unsigned b = fuzz_byte(f);
        text[i] = (char)(b ? b : 'x');
    }
    text[length] = 0;
    return text;
}

/* A condition that must hold whatever comes: the fuzzer keeps the input that breaks it. */
#define FUZZ_WANT(condition) do { if (!(condition)) { \
    fprintf(stderr, "broken: %s:%d: %s\n", __FILE__, __LINE__, #condition); abort(); } } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n);

#ifdef FUZZ_CORPUS
/* Inputs to begin with: nothing, and bytes of which a few, many or all are random. */
int main(int argc, char **argv)
{
    uint64_t state = 1;
    int k;
    for (k = 0; k < 24; k++) {
        char path[500];
        size_t i, n = (size_t)32 << k % 6;
        FILE *out;
        snprintf(path, sizeof path, "%s/%02d", argc > 1 ? argv[1] : ".", k);
        if (!(out = fopen(path, "wb"))) return 1;
        for (i = 0; k > 0 && i < n; i++) {
            const unsigned rare = k % 3 == 0 ? 1 : k % 3 == 1 ? 8 : 40;
            unsigned b, chance;
            state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            b = (unsigned)(state >> 40) & 255;
            chance = (unsigned)(state >> 33) % rare;
            fputc(chance == 0 ? (int)b : 0, out);
        }
        if (fclose(out)) return 1;
    }
    return 0;
}
#endif

#endif
