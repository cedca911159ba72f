/* 42_hdf5 - frames in one file of HDF5. Where the library is built without it, as by `make test`: every routine says so
   and nothing is written. With it, as by `make hdf5`: frames, their order, errors; it leaves series whose numbers
   tests/hdf5/layout.py and tests/hdf5/readers.py know. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_hdf5.h"
#include "mpm_io.h"

#include "check.h"
#include "files.h"

#ifdef MPM_FLOAT
#define FOLDER "build/test-hdf5-f32"
#else
#define FOLDER "build/test-hdf5"
#endif

#define MOST 50000 /* points: more than one chunk of the file */

typedef struct scene {
    mpm_real x[3][MOST], v[3][MOST], s[6][MOST], hot[MOST];
    uint8_t flag[MOST];
    int32_t id[MOST], cell[3 * MOST];
    mpm_hdf5_field field[5];
} scene;

static scene *made(void) { return (scene *)calloc(1, sizeof(scene)); }

/* A frame whose numbers follow from those of the point and of the frame; halves and whole numbers, exact in float. */
static mpm_hdf5_desc describe(scene *s, int n, int frame)
{
    mpm_hdf5_desc d = mpm_hdf5_desc_default();
    int i, a;
    for (i = 0; i < n; i++) {
        for (a = 0; a < 3; a++) {
            s->x[a][i] = (mpm_real)(i % 100) + (mpm_real)(a * frame) / 2;
            s->v[a][i] = (mpm_real)(100 * a + frame);
        }
        for (a = 0; a < 6; a++) s->s[a][i] = (mpm_real)(a + 1) * (mpm_real)((i % 7) + frame);
        s->hot[i] = (mpm_real)(300 + frame + i % 10);
        s->flag[i] = (uint8_t)(i % 3);
        s->id[i] = n - i;
    }
    s->field[0] = mpm_hdf5_vector("velocity (m/s)", s->v[0], s->v[1], s->v[2], 1);
    s->field[1] = mpm_hdf5_tensor("stress (MPa)", s->s[0], s->s[1], s->s[2], s->s[3], s->s[4], s->s[5], 2);
    s->field[2] = mpm_hdf5_scalar("temperature <K>", s->hot, 1);
    s->field[3] = mpm_hdf5_uint8("flag", s->flag);
    s->field[4] = mpm_hdf5_int32("id", s->id);
    d.count = (size_t)n;
    for (a = 0; a < 3; a++) d.x[a] = s->x[a];
    d.fields = s->field;
    d.field_count = 5;
    d.time = 0.1 * frame;
    d.float32 = 1;
    d.note = "a test";
    return d;
}

/* Cells of `ends` points: 0 1 2, 1 2 3, ... */
static void join(scene *s, mpm_hdf5_desc *d, int ends)
{
    size_t i;
    for (i = 0; i < (d->count - 2) * (size_t)ends; i++) s->cell[i] = (int32_t)(i / (size_t)ends + i % (size_t)ends);
    d->cells = s->cell;
    d->cell_points = ends;
    d->cell_count = d->count - 2;
}

static void check_arguments(scene *s)
{
    const char *path = FOLDER "/refused.vtkhdf";
    mpm_hdf5_desc d = describe(s, 10, 0);
    mpm_fault fault;
    d.mark = 0;
    CHECK_EQUAL("a description of zeros", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    d = describe(s, 10, 0);
    d.gzip = 10;
    CHECK_EQUAL("gzip 10", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... by name and value", !strcmp(fault.field, "gzip") && fault.value > 9);
    d = describe(s, 10, 0);
    d.count = 0;
    CHECK_EQUAL("no points", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    d = describe(s, 10, 0);
    join(s, &d, 3);
    s->cell[4] = 10;
    CHECK_EQUAL("a cell of a point that is not there", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    d.cell_points = 4;
    CHECK_EQUAL("cells of four points", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    d = describe(s, 10, 0);
    s->field[3].components = 2;
    CHECK_EQUAL("two bytes a point", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... of field 3", fault.index, 3);
    d = describe(s, 10, 0);
    s->field[2].name = "";
    CHECK_EQUAL("a field without a name", mpm_hdf5_frame(path, 0, &d, NULL), MPM_ERR_ARGUMENT);
    d = describe(s, 10, 0);
    s->field[2].name = s->field[1].name;
    CHECK_EQUAL("two fields of one name", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... which ones", fault.index == 2 && fault.value > 0 && fault.value < 2);
    CHECK_TRUE("nothing was written", !exists(path) && !exists(FOLDER "/refused.vtkhdf.part"));
}

static void check_without(scene *s)
{
    const mpm_hdf5_desc d = describe(s, 10, 0);
    const char *path = FOLDER "/none.vtkhdf";
    int64_t frames = 7;
    mpm_fault fault;
    char text[200];
    CHECK_EQUAL("built without HDF5", mpm_hdf5_built(), 0);
    CHECK_EQUAL("a frame", mpm_hdf5_frame(path, 0, &d, &fault), MPM_ERR_FILE);
    mpm_io_fault_text(text, sizeof text, &fault);
    CHECK_TRUE("... says why", strstr(text, "built without HDF5") != NULL);
    CHECK_TRUE("... and leaves nothing", !exists(path) && !exists(FOLDER "/none.vtkhdf.part"));
    CHECK_EQUAL("frames of a file", mpm_hdf5_frames(path, &frames, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("... none", frames, 0);
    CHECK_EQUAL("an XDMF file", mpm_hdf5_xdmf(path, FOLDER "/none.xmf", &fault), MPM_ERR_FILE);
    CHECK_TRUE("... is not made", !exists(FOLDER "/none.xmf"));
}

#define FRAMES 5
static const int counts[FRAMES] = {50000, 50000, 120, 33000, 7}; /* points of the frames */

/* The series that the readers are given. */
static void write_series(scene *s, const char *path, const char *xmf, int ends, int gzip)
{
    mpm_status status = MPM_OK;
    mpm_fault fault;
    int64_t frames = -1;
    int k;
    for (k = 0; k < FRAMES && status >= 0; k++) {
        mpm_hdf5_desc d = describe(s, ends > 1 ? 50 + 10 * k : counts[k], k);
        if (ends > 1) join(s, &d, ends);
        d.gzip = gzip;
        d.float32 = gzip > 0;
        status = mpm_hdf5_frame(path, k, &d, &fault);
        if (status >= 0) status = mpm_hdf5_xdmf(path, xmf, &fault);
    }
    CHECK_EQUAL(path, status, MPM_OK);
    CHECK_EQUAL("... can be read", mpm_hdf5_frames(path, &frames, &fault), MPM_OK);
    CHECK_EQUAL("... has its frames", frames, FRAMES);
}

static int64_t frames_of(const char *path)
{
    int64_t frames = -1;
    return mpm_hdf5_frames(path, &frames, NULL) < 0 ? -1 : frames;
}

/* Frames out of order, and from a run that went on from an earlier checkpoint. */
static void check_order(scene *s)
{
    const char *path = FOLDER "/order.vtkhdf";
    mpm_fault fault;
    mpm_hdf5_desc d;
    int k;
    remove(path);
    d = describe(s, 20, 1);
    CHECK_EQUAL("frame 1 of no file", mpm_hdf5_frame(path, 1, &d, &fault), MPM_ERR_FILE);
    CHECK_TRUE("... makes none", !exists(path) && !exists(FOLDER "/order.vtkhdf.part"));
    CHECK_EQUAL("frame -1", mpm_hdf5_frame(path, -1, &d, &fault), MPM_ERR_ARGUMENT);
    for (k = 0; k < 4; k++) {
        d = describe(s, 20 + 1000 * k, k + 40); /* 1, 2 and 3 to be written again */
        if (k == 0) d = describe(s, 20, 0);
        mpm_hdf5_frame(path, k, &d, &fault);
    }
    CHECK_EQUAL("frame 6 of a file with 4", mpm_hdf5_frame(path, 6, &d, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("... names the frame", fault.index, 6);
    CHECK_EQUAL("... and leaves the 4", frames_of(path), 4);
    for (k = 1; k < 3; k++) {
        d = describe(s, 20 + k, k);
        CHECK_EQUAL("a frame again", mpm_hdf5_frame(path, k, &d, &fault), MPM_OK);
        CHECK_EQUAL("... drops the later ones", frames_of(path), k + 1);
    }
    d = describe(s, 20, 3);
    s->field[4].name = "number";
    CHECK_EQUAL("a frame of other fields", mpm_hdf5_frame(path, 3, &d, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("... names the field", fault.index, 4);
    d = describe(s, 20, 3);
    d.field_count = 4;
    CHECK_EQUAL("a frame of fewer fields", mpm_hdf5_frame(path, 3, &d, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("... leaves what there was", frames_of(path), 3);
    d = describe(s, 20, 0);
    CHECK_EQUAL("frame 0 again", mpm_hdf5_frame(path, 0, &d, &fault), MPM_OK);
    CHECK_EQUAL("... begins anew", frames_of(path), 1);
    CHECK_TRUE("no .part is left", !exists(FOLDER "/order.vtkhdf.part"));
}

static void check_failures(scene *s)
{
    mpm_hdf5_desc d = describe(s, 20, 0);
    mpm_fault fault;
    FILE *f = fopen(FOLDER "/words.vtkhdf", "wb");
    if (f) {
        fputs("no file of HDF5", f);
        fclose(f);
    }
    CHECK_EQUAL("frames of a text", frames_of(FOLDER "/words.vtkhdf"), -1);
    CHECK_EQUAL("frame 1 of a text", mpm_hdf5_frame(FOLDER "/words.vtkhdf", 1, &d, &fault), MPM_ERR_FILE);
    CHECK_TRUE("... leaves the text alone", exists(FOLDER "/words.vtkhdf") && !exists(FOLDER "/words.vtkhdf.part"));
    CHECK_EQUAL("XDMF of a text", mpm_hdf5_xdmf(FOLDER "/words.vtkhdf", FOLDER "/words.xmf", &fault), MPM_ERR_FILE);
    CHECK_TRUE("... is not made", !exists(FOLDER "/words.xmf") && !exists(FOLDER "/words.xmf.part"));
    CHECK_EQUAL("a folder that is not there", mpm_hdf5_frame(FOLDER "/no/x.vtkhdf", 0, &d, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("XDMF into it", mpm_hdf5_xdmf(FOLDER "/points.vtkhdf", FOLDER "/no/x.xmf", &fault), MPM_ERR_FILE);
}

static void check_with(scene *s)
{
    CHECK_EQUAL("built with HDF5", mpm_hdf5_built(), 1);
    write_series(s, FOLDER "/points.vtkhdf", FOLDER "/points.xmf", 1, 0);
    write_series(s, FOLDER "/packed.vtkhdf", FOLDER "/packed.xmf", 1, 6);
    write_series(s, FOLDER "/lines.vtkhdf", FOLDER "/lines.xmf", 2, 0);
    write_series(s, FOLDER "/triangles.vtkhdf", FOLDER "/triangles.xmf", 3, 9);
    check_order(s);
    check_failures(s);
}

int main(void)
{
    scene *s = made();
    mpm_fault fault;
    if (!s || mpm_io_make_directory(FOLDER, &fault) < 0) return 1;
    check_arguments(s);
    if (mpm_hdf5_built()) check_with(s);
    else check_without(s);
    free(s);
    return check_end();
}
