/* A picture file with bytes changed anywhere, its chunks' sums made right again or not, goes into a film: it is
   refused, or the film is whole: chunk after chunk with its sum, and as many pictures as it says.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "mpm_io.h"

#define PICTURE "build/fuzz/film-picture.png"
#define FILM "build/fuzz/film.png"

static uint32_t crc_of(const unsigned char *p, size_t n)
{
    uint32_t crc = 0xffffffffu;
    int k;
    for (; n--; p++)
        for (crc ^= *p, k = 0; k < 8; k++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    return ~crc;
}

static size_t big(const unsigned char *p)
{
    return (size_t)p[0] << 24 | (size_t)p[1] << 16 | (size_t)p[2] << 8 | (size_t)p[3];
}

static size_t contents(const char *path, unsigned char *to, size_t room)
{
    FILE *f = fopen(path, "rb");
    size_t n = 0;
    if (!f) return 0;
    n = fread(to, 1, room, f);
    fclose(f);
    return n;
}

static void put(const char *path, const unsigned char *bytes, size_t n)
{
    FILE *f = fopen(path, "wb");
    FUZZ_WANT(f != NULL);
    fwrite(bytes, 1, n, f);
    fclose(f);
}

/* Makes the sums of all whole chunks right. */
static void repair(unsigned char *file, size_t n)
{
    size_t at = 8, k;
    while (at + 12 <= n && big(file + at) <= n - at - 12) {
        const size_t length = big(file + at);
        const uint32_t crc = crc_of(file + at + 4, length + 4);
        for (k = 0; k < 4; k++) file[at + 8 + length + k] = (unsigned char)(crc >> (24 - 8 * k));
        at += length + 12;
    }
}

static void whole(int wanted)
{
    static unsigned char file[1 << 16];
    const size_t n = contents(FILM, file, sizeof file);
    size_t at = 8;
    int pictures = 0, said = -1;
    while (at + 12 <= n && big(file + at) <= n - at - 12) {
        const size_t length = big(file + at);
        FUZZ_WANT(crc_of(file + at + 4, length + 4) == big(file + at + 8 + length));
        if (!memcmp(file + at + 4, "acTL", 4)) said = (int)big(file + at + 8);
        pictures += !memcmp(file + at + 4, "fcTL", 4);
        at += length + 12;
    }
    FUZZ_WANT(at == n && said == wanted && pictures == wanted);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static unsigned char pixels[3 * 8 * 4], file[4096];
    fuzz f = {data, size};
    mpm_io_film film;
    size_t n, k;
    unsigned changes;
    int first, ended;
    for (k = 0; k < sizeof pixels; k++) pixels[k] = (unsigned char)(k * 7);
    FUZZ_WANT(mpm_io_png(PICTURE, pixels, 8, 4, "a note", NULL) >= 0);
    n = contents(PICTURE, file, sizeof file);
    for (changes = fuzz_byte(&f) % 8; changes > 0; changes--) {
        k = (fuzz_byte(&f) << 8 | fuzz_byte(&f)) % n;
        file[k] = (unsigned char)fuzz_byte(&f);
    }
    if (fuzz_byte(&f) & 1) repair(file, n);
    if (fuzz_byte(&f) > 200) n = fuzz_byte(&f) % n;
    put(PICTURE, file, n);
    remove(FILM);
    first = (int)fuzz_byte(&f) & 1;
    FUZZ_WANT(mpm_io_film_begin(&film, FILM, fuzz_double(&f, 0.1), NULL, NULL) >= 0);
    if (first) mpm_io_film_add(&film, pixels, 8, 4, NULL);
    mpm_io_film_add_png(&film, PICTURE, NULL);
    ended = mpm_io_film_end(&film, NULL) >= 0;
    if (ended) whole(first + 1);
    else FUZZ_WANT(contents(FILM, file, 1) == 0);
    return 0;
}
