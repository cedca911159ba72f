/* Text writers: numbers come back as they were, JSON and XML hold no byte they must not, whatever names, values and
   texts are given. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "mpm.h"
#include "mpm_io.h"

#define PATH "build/fuzz/text"

/* Whether a file is UTF-8 without control characters but line breaks and tabs, as JSON and XML want. */
static int clean(const char *path)
{
    FILE *f = fopen(path, "rb");
    int c, more = 0, good = 1;
    if (!f) return 1;
    while ((c = fgetc(f)) != EOF) {
        if (more) good = good && (c & 0xc0) == 0x80, more--;
        else if (c < 0x80) good = good && (c >= 32 || c == '\n' || c == '\t');
        else if (c >= 0xc2 && c < 0xf5) more = c < 0xe0 ? 1 : c < 0xf0 ? 2 : 3;
        else good = 0;
    }
    fclose(f);
    return good && !more;
}

static void numbers(fuzz *f)
{
    char text[40], cut[40];
    const double x = fuzz_any(f);
    const size_t n = mpm_io_number_text(text, sizeof text, x), room = fuzz_byte(f) % sizeof cut;
    double back;
    FUZZ_WANT(n == strlen(text) && n < 32);
    back = strtod(text, NULL);
    FUZZ_WANT(isnan(x) ? isnan(back) : memcmp(&x, &back, sizeof x) == 0);
    FUZZ_WANT(mpm_io_number_text(cut, room, x) == n || room <= n);
}

static void messages(fuzz *f)
{
    char text[200], field[40];
    mpm_fault fault;
    mpm_io_progress p;
    const size_t n = fuzz_byte(f) % sizeof text;
    memset(&p, 0, sizeof p);
    memset(&fault, 0, sizeof fault);
    FUZZ_CHOICE(f, fault.status);
    fault.field = fuzz_text(f, field, sizeof field);
    fault.value = (mpm_real)fuzz_any(f);
    fault.index = fuzz_int(f, -1);
    mpm_io_fault_text(text, n, &fault);
    p.step = fuzz_int(f, 5);
    p.first_step = fuzz_int(f, 0);
    p.steps = fuzz_int(f, 10);
    if (fuzz_byte(f) & 1) fuzz_bytes(f, &p.step, sizeof p.step);
    if (fuzz_byte(f) & 1) fuzz_bytes(f, &p.steps, sizeof p.steps);
    p.time = fuzz_any(f);
    p.points = fuzz_any(f);
    p.elapsed = fuzz_any(f);
    mpm_io_progress_text(text, n, &p);
}

static void json(fuzz *f)
{
    mpm_io_json j;
    char key[20], value[60];
    int i;
    if (mpm_io_json_begin(&j, PATH ".json", NULL) < 0) return;
    for (i = 0; i < 12; i++) {
        fuzz_text(f, key, sizeof key);
        switch (fuzz_byte(f) % 6) {
        case 0: mpm_io_json_number(&j, key, fuzz_any(f)); break;
        case 1: mpm_io_json_string(&j, key, fuzz_text(f, value, sizeof value)); break;
        case 2: mpm_io_json_open(&j, key); break;
        case 3: mpm_io_json_close(&j); break;
        case 4: mpm_io_json_integer(&j, key, fuzz_int(f, 1)); break;
        default: mpm_io_json_string(&j, key, NULL); break;
        }
    }
    if (mpm_io_json_end(&j, NULL) == MPM_OK) FUZZ_WANT(clean(PATH ".json"));
}

static void table(fuzz *f)
{
    mpm_io_csv t;
    char columns[40], value[40];
    int i;
    if (mpm_io_csv_begin(&t, PATH ".csv", fuzz_text(f, columns, sizeof columns),
                         fuzz_byte(f) & 1 ? fuzz_text(f, value, sizeof value) : NULL, NULL) < 0)
        return;
    for (i = 0; i < 8; i++) {
        if (fuzz_byte(f) & 1) mpm_io_csv_real(&t, (mpm_real)fuzz_any(f));
        else mpm_io_csv_text(&t, fuzz_byte(f) < 250 ? fuzz_text(f, value, sizeof value) : NULL);
    }
    mpm_io_csv_end(&t, NULL);
}

static void frames(fuzz *f)
{
    mpm_io_vtu_desc v = mpm_io_vtu_desc_default();
    mpm_io_field field[3];
    mpm_real x[5];
    char name[20], note[40];
    int i;
    for (i = 0; i < 5; i++) x[i] = (mpm_real)fuzz_any(f);
    field[0] = mpm_io_scalar(fuzz_text(f, name, sizeof name), x, fuzz_double(f, 1));
    field[1] = mpm_io_vector("v", x, fuzz_byte(f) < 250 ? x : NULL, x, 1);
    field[2] = field[0];
    FUZZ_CHOICE(f, field[2].components);
    FUZZ_CHOICE(f, v.mark);
    v.count = fuzz_byte(f) % 6;
    v.x[0] = x;
    v.fields = field;
    v.field_count = (int)fuzz_byte(f) % 4;
    v.time = fuzz_any(f);
    v.scale = fuzz_double(f, 1);
    FUZZ_CHOICE(f, v.float32);
    v.note = fuzz_text(f, note, sizeof note);
    mpm_io_vtu(PATH ".vtu", &v, NULL);
    if (fuzz_byte(f) < 20) mpm_io_pvd_begin(PATH ".pvd", NULL);
    if (mpm_io_pvd_add(PATH ".pvd", fuzz_text(f, name, sizeof name), fuzz_any(f), NULL) == MPM_OK)
        FUZZ_WANT(clean(PATH ".pvd"));
    else mpm_io_pvd_begin(PATH ".pvd", NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    static int calls;
    if (calls++ % 1000 == 0) remove(PATH ".pvd"); /* it grows with every frame */
    numbers(&f);
    messages(&f);
    switch (fuzz_byte(&f) % 3) {
    case 0: json(&f); break;
    case 1: table(&f); break;
    default: frames(&f); break;
    }
    return 0;
}
