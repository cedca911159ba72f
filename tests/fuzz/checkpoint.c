/* A checkpoint of a world with bytes changed anywhere and its checksum made right again: it is refused, or the world
   goes on. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "scene.h"

#define PATH "build/fuzz/checkpoint.mpm"

static uint32_t crc_of(const unsigned char *p, size_t n)
{
    uint32_t crc = 0xffffffffu;
    int k;
    for (; n--; p++)
        for (crc ^= *p, k = 0; k < 8; k++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    return ~crc;
}

/* The file of a world five steps on, made once. */
static unsigned char *original(size_t *n)
{
    static unsigned char *bytes;
    static size_t length;
    if (!bytes) {
        static scene s;
        mpm_blob blob[MPM_BLOBS(2)];
        FILE *f;
        int i;
        scene_describe(&s);
        FUZZ_WANT(scene_begin(&s));
        for (i = 0; i < 5; i++) FUZZ_WANT(mpm_bond_step(&s.bond, &s.world, mpm_time_step(&s.world, MPM_R(0.2))) >= 0);
        FUZZ_WANT(mpm_io_checkpoint_write(PATH, "text\n", blob, mpm_blobs(&s.world, blob), NULL) >= 0);
        mpm_free(&s.world);
        bytes = (unsigned char *)malloc(1 << 22);
        f = fopen(PATH, "rb");
        FUZZ_WANT(bytes && f);
        length = fread(bytes, 1, 1 << 22, f);
        fclose(f);
    }
    *n = length;
    return bytes;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    mpm_blob blob[MPM_BLOBS(2)];
    unsigned char *copy;
    size_t n;
    uint32_t crc;
    FILE *out;
    scene s;
    int count, i;
    const unsigned char *bytes = original(&n);
    copy = (unsigned char *)malloc(n);
    FUZZ_WANT(copy);
    memcpy(copy, bytes, n);
    while (f.left) { /* patches: place from either end, since the counts stand at the end; then bytes */
        const size_t back = fuzz_byte(&f) & 1, place = fuzz_byte(&f) | (size_t)fuzz_byte(&f) << 8;
        const size_t at = back ? n - 4 - place % 1200 : place * 7 % n, length = 1 + fuzz_byte(&f) % 12;
        fuzz_bytes(&f, copy + at, at + length < n ? length : n - at);
    }
    crc = crc_of(copy, n - 4);
    memcpy(copy + n - 4, &crc, 4);
    out = fopen(PATH, "wb");
    FUZZ_WANT(out && fwrite(copy, 1, n, out) == n && fclose(out) == 0);
    free(copy);
    scene_describe(&s);
    FUZZ_WANT(scene_begin(&s));
    count = mpm_blobs(&s.world, blob);
    if (mpm_io_checkpoint_read(PATH, "text\n", blob, count, NULL) >= 0) {
        mpm_restored(&s.world, blob);
        scene_measure(&s, 0);
        for (i = 0; i < 3; i++)
            if (mpm_bond_step(&s.bond, &s.world, mpm_time_step(&s.world, MPM_R(0.2))) < 0) break;
        scene_measure(&s, 1);
    }
    mpm_free(&s.world);
    return 0;
}
