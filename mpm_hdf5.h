/* mpm_hdf5.h - all frames of a run in one file: VTKHDF for ParaView, with an XDMF file beside it for older readers.
   Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm_hdf5.h"
       #include "mpm_hdf5.h"
     and compile it with -DMPM_HDF5 and the flags of the HDF5 library (1.10.2 or later), on Debian:
       cc -DMPM_HDF5 $(pkg-config --cflags hdf5-serial) program.c $(pkg-config --libs hdf5-serial) -lm
     Without MPM_HDF5 nothing of HDF5 is needed, and every routine that would write or read returns MPM_ERR_FILE and
     says that the program was built without it.

   WHAT IT DOES NOT DO
     It writes from one process only. It reads no more of a file than it needs to go on with it. It never prints (the
     HDF5 library is told to keep quiet while it works here), never exits, and keeps no state between calls: the file
     is closed after every frame, so that others may look at it while the run goes on. A reader that keeps it open
     does not stop the run (from HDF5 1.10.7 and 1.12.1 on), but must open it again to see more.

   WHAT IS IN THE FILE
     The layout that VTK calls VTKHDF, version 2.0: an UnstructuredGrid with steps, which VTK 9.3 and ParaView 5.12
     and later open as they are. Every frame adds its points, cells and fields behind those of the frames before it;
     the tables in VTKHDF/Steps say where each frame begins:
       VTKHDF           Version, Type; NumberOfPoints, NumberOfCells, NumberOfConnectivityIds: one number a frame
         Points         [length], three columns
         Connectivity   numbers of the points of a frame's cells, from 0; Offsets (one more than cells), Types (VTK's)
         PointData/...  one array for each field
         Steps          NSteps; Values: the times; PartOffsets, NumberOfParts, PointOffsets, CellOffsets,
                        ConnectivityIdOffsets and PointDataOffsets/...: first rows of each frame
     HDF5 takes "/" in a name for a folder, so "velocity (m/s)" is called "velocity (m per s)"; the attribute "name" of
     the array has it as it was given, and so has the XDMF file.

   IF THE RUN IS KILLED
     A new file is written under <path>.part and renamed when its first frame is whole. Later frames are added in an
     order that leaves the file sound at every instant (HDF5's SWMR). Killed between frames, it can be read at once.
     Killed while one is being added, it holds the frames before it, but is marked as open, and most readers refuse it:
     `h5clear -s --increment=0 FILE` takes the mark off; mpm_hdf5_frame, when the run goes on, takes the whole frames
     into a new file. What the machine itself loses when it stops - power, disk - is not covered.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm_hdf5.h"
       int main(void) {
           static mpm_real x[2] = {0, 1}, y[2] = {0, 0}, z[2] = {0, 1}, hot[2] = {300, 900};
           mpm_hdf5_field field = mpm_hdf5_scalar("temperature (K)", hot, 1);
           mpm_hdf5_desc d = mpm_hdf5_desc_default();
           mpm_fault fault;
           int k;
           d.count = 2; d.x[0] = x; d.x[1] = y; d.x[2] = z;
           d.fields = &field; d.field_count = 1;
           for (k = 0; k < 3 && mpm_hdf5_built(); k++) {
               d.time = k; z[1] += 1;
               if (mpm_hdf5_frame("two.vtkhdf", k, &d, &fault) < 0) return 1;
               if (mpm_hdf5_xdmf("two.vtkhdf", "two.xmf", &fault) < 0) return 1;
           }
           return 0;
       }

   CONTENTS
     mpm_hdf5_built, mpm_hdf5_scalar .. mpm_hdf5_int32, mpm_hdf5_desc, mpm_hdf5_frame, mpm_hdf5_frames, mpm_hdf5_xdmf

   CONFIGURATION (define before including)
     MPM_FLOAT               GLOBAL  as in mpm.h; public symbols then end in _f32.
     MPM_HDF5                IMPL    with the HDF5 library; without it the routines say that it is not there.
     MPM_MALLOC(n), MPM_FREE(p) IMPL names of files being written, one array at a time.

   CONVENTIONS
     Arrays, fields and their order are those of the VTK writer in mpm_io.h, whose .vtu of the same frame holds the
     same numbers. */
#ifndef MPM_HDF5_H
#define MPM_HDF5_H

#include "mpm.h"
#if MPM_VERSION_NUMBER != 200
#error "mpm_hdf5.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_hdf5_built mpm_hdf5_built_f32
#define mpm_hdf5_scalar mpm_hdf5_scalar_f32
#define mpm_hdf5_vector mpm_hdf5_vector_f32
#define mpm_hdf5_tensor mpm_hdf5_tensor_f32
#define mpm_hdf5_uint8 mpm_hdf5_uint8_f32
#define mpm_hdf5_int32 mpm_hdf5_int32_f32
#define mpm_hdf5_desc_default mpm_hdf5_desc_default_f32
#define mpm_hdf5_frame mpm_hdf5_frame_f32
#define mpm_hdf5_frames mpm_hdf5_frames_f32
#define mpm_hdf5_xdmf mpm_hdf5_xdmf_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* 1 if the implementation was compiled with MPM_HDF5, else 0. Test: 42_hdf5. */
MPM_API int mpm_hdf5_built(void);

/* One named quantity at every point, as plain arrays. Set either data[] or one of the whole-number pointers. Of six
   components the order here is that of mpm.h, xx yy zz yz xz xy; the file gets the XX YY ZZ XY YZ XZ of ParaView. */
typedef struct mpm_hdf5_field {
    const char *name;         /* as shown in ParaView; at most 200 bytes; of no other field */
    int components;           /* 1 .. 9; 3 is a vector, 6 a symmetric tensor */
    const mpm_real *data[9];  /* one array of `count` values per component; NULL: zeros */
    double scale;             /* multiplies on output, for a change of units; 1 leaves the bits alone */
    const uint8_t *bytes;     /* one component of flags or small numbers, or NULL */
    const int32_t *integers;  /* one component of ids or body numbers, or NULL */
} mpm_hdf5_field;

/* Fields from their arrays. Test: 42_hdf5. */
MPM_API mpm_hdf5_field mpm_hdf5_scalar(const char *name, const mpm_real *data, double scale);
MPM_API mpm_hdf5_field mpm_hdf5_vector(const char *name, const mpm_real *x, const mpm_real *y, const mpm_real *z,
                                       double scale);
MPM_API mpm_hdf5_field mpm_hdf5_tensor(const char *name, const mpm_real *xx, const mpm_real *yy, const mpm_real *zz,
                                       const mpm_real *yz, const mpm_real *xz, const mpm_real *xy, double scale);
MPM_API mpm_hdf5_field mpm_hdf5_uint8(const char *name, const uint8_t *bytes);
MPM_API mpm_hdf5_field mpm_hdf5_int32(const char *name, const int32_t *integers);

/* One frame: points and what to write of them. */
typedef struct mpm_hdf5_desc {
    unsigned mark;              /* set by mpm_hdf5_desc_default */
    size_t count;               /* points, 1 .. 2^31 - 1 */
    const mpm_real *x[3];       /* positions [length]; a NULL axis is written as zero */
    double scale;               /* of positions */
    const mpm_hdf5_field *fields; /* field_count of them, in every frame the same */
    int field_count;
    double time;                /* [time], in the unit that ParaView shall show */
    int float32;                /* 1: reals as 32 bits, half the size; 0: as mpm_real. By the first frame for all */
    int gzip;                   /* 1 .. 9: packed, 9 best; 0: not. By the first frame for all */
    const char *note;           /* kept as an attribute of the file: what made it; or NULL. Of the first frame */
    size_t cell_count;          /* lines or triangles that join points: surfaces */
    int cell_points;            /* of each: 2 or 3; the same in every frame */
    const int32_t *cells;       /* numbers of their points, cell by cell; NULL: the points stand alone, a vertex each */
} mpm_hdf5_desc;

/* No points, no fields, scale 1, time 0. Test: 42_hdf5. */
MPM_API mpm_hdf5_desc mpm_hdf5_desc_default(void);

/* Writes frame number `frame`, from 0, of a file, conventionally called NAME.vtkhdf. Frame 0 makes a new file, in place
   of any that was there; any other must follow the frames before it. Frames of that number and later ones that the file
   may hold, from a run that went on from an earlier checkpoint, are dropped: for that the file is copied once.
   MPM_ERR_ARGUMENT for a description out of range; MPM_ERR_FILE: it cannot be written, lacks frames, or has other
   fields; then the frames before it are untouched. MPM_ERR_MEMORY. Test: 42_hdf5. */
MPM_API mpm_status mpm_hdf5_frame(const char *path, int64_t frame, const mpm_hdf5_desc *d, mpm_fault *fault);

/* How many whole frames the file holds, to *frames. MPM_ERR_FILE: there is no such file, it is none of ours, or it is
   marked as open. Test: 42_hdf5. */
MPM_API mpm_status mpm_hdf5_frames(const char *path, int64_t *frames, mpm_fault *fault);

/* Writes the XDMF file (.xmf, text) of all frames in `path`, which it names without its folder: both belong into the
   same one. MPM_ERR_FILE as above, or when `xmf` cannot be written; MPM_ERR_MEMORY. Test: 42_hdf5. */
MPM_API mpm_status mpm_hdf5_xdmf(const char *path, const char *xmf, mpm_fault *fault);

#ifdef __cplusplus
}
#endif
#endif /* MPM_HDF5_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__HDF5_IMPLEMENTED)
#define MPM__HDF5_IMPLEMENTED

#include <string.h>

#ifdef MPM_HDF5
#include <hdf5.h>
#include <stdio.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- descriptions -------------------------------------------------------------------------- */

static inline mpm_hdf5_field mpm__hdf5_field(const char *name, int components, double scale)
{
    mpm_hdf5_field f;
    memset(&f, 0, sizeof f);
    f.name = name;
    f.components = components;
    f.scale = scale;
    return f;
}

MPM_API mpm_hdf5_field mpm_hdf5_scalar(const char *name, const mpm_real *data, double scale)
{
    mpm_hdf5_field f = mpm__hdf5_field(name, 1, scale);
    f.data[0] = data;
    return f;
}

MPM_API mpm_hdf5_field mpm_hdf5_vector(const char *name, const mpm_real *x, const mpm_real *y, const mpm_real *z,
                                       double scale)
{
    mpm_hdf5_field f = mpm__hdf5_field(name, 3, scale);
    f.data[0] = x;
    f.data[1] = y;
    f.data[2] = z;
    return f;
}

MPM_API mpm_hdf5_field mpm_hdf5_tensor(const char *name, const mpm_real *xx, const mpm_real *yy, const mpm_real *zz,
                                       const mpm_real *yz, const mpm_real *xz, const mpm_real *xy, double scale)
{
    mpm_hdf5_field f = mpm__hdf5_field(name, 6, scale);
    f.data[0] = xx;
    f.data[1] = yy;
    f.data[2] = zz;
    f.data[3] = yz;
    f.data[4] = xz;
    f.data[5] = xy;
    return f;
}

MPM_API mpm_hdf5_field mpm_hdf5_uint8(const char *name, const uint8_t *bytes)
{
    mpm_hdf5_field f = mpm__hdf5_field(name, 1, 1);
    f.bytes = bytes;
    return f;
}

MPM_API mpm_hdf5_field mpm_hdf5_int32(const char *name, const int32_t *integers)
{
    mpm_hdf5_field f = mpm__hdf5_field(name, 1, 1);
    f.integers = integers;
    return f;
}

MPM_API mpm_hdf5_desc mpm_hdf5_desc_default(void)
{
    mpm_hdf5_desc d;
    memset(&d, 0, sizeof d);
    d.scale = 1;
    d.mark = MPM_MARK;
    return d;
}

#define MPM__HDF5_NAME 256 /* bytes of the name of a field in the file */

static inline mpm_status mpm__hdf5_check_field(const mpm_hdf5_field *fields, int i, mpm_fault *fault)
{
    const mpm_hdf5_field *f = &fields[i];
    int k;
    if (!f->name || !*f->name || strlen(f->name) > 200)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "length of name of field", f->name ? (mpm_real)strlen(f->name) : 0, i);
    if (f->components < 1 || f->components > 9 || ((f->bytes || f->integers) && f->components != 1))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "components of field", (mpm_real)f->components, i);
    for (k = 0; k < i; k++)
        if (!strcmp(fields[k].name, f->name))
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "name of field (of another too, number)", (mpm_real)k, i);
    return MPM_OK;
}

static inline mpm_status mpm__hdf5_check(const mpm_hdf5_desc *d, mpm_fault *fault)
{
    mpm_status status = MPM_OK;
    size_t l;
    int i;
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_hdf5_desc_default)", (mpm_real)d->mark, -1);
    if (d->count < 1 || d->count > 2147483647u)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "count", (mpm_real)d->count, -1);
    if (d->gzip < 0 || d->gzip > 9) return mpm_fail(fault, MPM_ERR_ARGUMENT, "gzip", (mpm_real)d->gzip, -1);
    if (d->cells && (d->cell_points < 2 || d->cell_points > 3))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "cell_points", (mpm_real)d->cell_points, -1);
    for (l = 0; d->cells && l < d->cell_count * (size_t)d->cell_points; l++)
        if (d->cells[l] < 0 || (size_t)d->cells[l] >= d->count)
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "point of cell", (mpm_real)d->cells[l],
                            (int64_t)(l / (size_t)d->cell_points));
    if (d->field_count < 0 || (d->field_count > 0 && !d->fields))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "field_count", (mpm_real)d->field_count, -1);
    for (i = 0; i < d->field_count && status >= 0; i++) status = mpm__hdf5_check_field(d->fields, i, fault);
    return status;
}

#ifndef MPM_HDF5

/* ---- without HDF5 -------------------------------------------------------------------------- */

static inline mpm_status mpm__hdf5_missing(mpm_fault *fault)
{
    return mpm_fail(fault, MPM_ERR_FILE, "this program was built without HDF5 (MPM_HDF5)", 0, -1);
}

MPM_API int mpm_hdf5_built(void) { return 0; }

MPM_API mpm_status mpm_hdf5_frame(const char *path, int64_t frame, const mpm_hdf5_desc *d, mpm_fault *fault)
{
    const mpm_status status = mpm__hdf5_check(d, fault);
    (void)path;
    (void)frame;
    return status < 0 ? status : mpm__hdf5_missing(fault);
}

MPM_API mpm_status mpm_hdf5_frames(const char *path, int64_t *frames, mpm_fault *fault)
{
    (void)path;
    *frames = 0;
    return mpm__hdf5_missing(fault);
}

MPM_API mpm_status mpm_hdf5_xdmf(const char *path, const char *xmf, mpm_fault *fault)
{
    (void)path;
    (void)xmf;
    return mpm__hdf5_missing(fault);
}

#else

/* ---- names --------------------------------------------------------------------------------- */

/* path and an ending in new memory, or NULL. */
static inline char *mpm__hdf5_path(const char *path, const char *ending)
{
    const size_t n = strlen(path) + strlen(ending) + 1;
    char *text = (char *)MPM_MALLOC(n);
    if (text) mpm_append(text, n, mpm_append(text, n, 0, path), ending);
    return text;
}

/* Gives a file its final name. Where rename does not replace, the old file goes first. */
static inline int mpm__hdf5_rename(const char *from, const char *to)
{
    if (rename(from, to) == 0) return 1;
#ifdef _WIN32
    remove(to);
    if (rename(from, to) == 0) return 1;
#endif
    remove(from);
    return 0;
}

/* The name of a field as HDF5 can have it: " per " for "/". */
static inline void mpm__hdf5_name(const char *name, char text[MPM__HDF5_NAME])
{
    size_t used = 0;
    char one[2] = "";
    for (text[0] = 0; *name; name++) {
        one[0] = *name;
        used = mpm_append(text, MPM__HDF5_NAME, used, *name == '/' ? " per " : one);
    }
}

/* ---- the library's arrays and attributes --------------------------------------------------- */

/* All below return 1, or 0 where the library failed: handles that are negative fail in the next call. */

typedef struct mpm__hdf5_say { /* what the library would print errors with */
    H5E_auto2_t say;
    void *to;
} mpm__hdf5_say;

static inline mpm__hdf5_say mpm__hdf5_hush(void)
{
    mpm__hdf5_say s;
    H5Eget_auto2(H5E_DEFAULT, &s.say, &s.to);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return s;
}

static inline void mpm__hdf5_speak(mpm__hdf5_say s) { H5Eset_auto2(H5E_DEFAULT, s.say, s.to); }

static inline int mpm__hdf5_attribute(hid_t at, const char *name, hid_t type, int count, const void *value)
{
    const hsize_t size = (hsize_t)count;
    const hid_t space = count > 0 ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR);
    const hid_t a = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const int good = H5Awrite(a, type, value) >= 0;
    H5Aclose(a);
    H5Sclose(space);
    return good;
}

static inline int mpm__hdf5_text(hid_t at, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    const int good = *text == 0 || (H5Tset_size(type, strlen(text)) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0 &&
                                    mpm__hdf5_attribute(at, name, type, 0, text));
    H5Tclose(type);
    return good;
}

/* A new empty array that can grow, in chunks of so many rows. `given`: its name as it was given, or NULL. */
static inline int mpm__hdf5_create(hid_t at, const char *name, const char *given, int columns, size_t rows, hid_t type,
                                   int gzip)
{
    const hsize_t size[2] = {0, (hsize_t)columns}, most[2] = {H5S_UNLIMITED, (hsize_t)columns};
    const hsize_t chunk[2] = {rows, (hsize_t)columns};
    const int rank = columns > 1 ? 2 : 1;
    const hid_t space = H5Screate_simple(rank, size, most), how = H5Pcreate(H5P_DATASET_CREATE);
    int good = H5Pset_chunk(how, rank, chunk) >= 0 && (gzip == 0 || H5Pset_deflate(how, (unsigned)gzip) >= 0);
    const hid_t set = H5Dcreate2(at, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    good = good && set >= 0 && (!given || mpm__hdf5_text(set, "name", given));
    H5Dclose(set);
    H5Pclose(how);
    H5Sclose(space);
    return good;
}

/* Rows of an array, or 0 where there is none. */
static inline hsize_t mpm__hdf5_rows(hid_t at, const char *name, hsize_t *columns)
{
    const hid_t set = H5Dopen2(at, name, H5P_DEFAULT), space = H5Dget_space(set);
    hsize_t size[2] = {0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space, size, NULL) < 0) size[0] = 0;
    if (columns) *columns = size[1];
    H5Sclose(space);
    H5Dclose(set);
    return size[0];
}

/* Adds rows behind an array of that many columns; *first: the number of the first. */
static inline int mpm__hdf5_put(hid_t at, const char *name, int columns, size_t rows, hid_t type, const void *data,
                                hsize_t *first)
{
    const int rank = columns > 1 ? 2 : 1;
    const hsize_t count[2] = {rows, (hsize_t)columns};
    const hid_t set = H5Dopen2(at, name, H5P_DEFAULT), memory = H5Screate_simple(rank, count, NULL);
    hsize_t there, start[2] = {0, 0}, size[2];
    hid_t space;
    int good;
    start[0] = mpm__hdf5_rows(at, name, &there);
    size[0] = start[0] + rows;
    size[1] = there;
    good = there == (hsize_t)columns && H5Dset_extent(set, size) >= 0;
    space = H5Dget_space(set);
    good = good && (rows == 0 || (H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                                  H5Dwrite(set, type, memory, space, H5P_DEFAULT, data) >= 0));
    if (first) *first = start[0];
    H5Sclose(space);
    H5Sclose(memory);
    H5Dclose(set);
    return good;
}

static inline int mpm__hdf5_put_number(hid_t at, const char *name, hsize_t value)
{
    const int64_t number = (int64_t)value;
    return mpm__hdf5_put(at, name, 1, 1, H5T_NATIVE_INT64, &number, NULL);
}

/* Reads `rows` numbers of an array of one column from `first` on. */
static inline int mpm__hdf5_get(hid_t at, const char *name, hsize_t first, hsize_t rows, hid_t type, void *data)
{
    const hid_t set = H5Dopen2(at, name, H5P_DEFAULT), space = H5Dget_space(set);
    const hid_t memory = H5Screate_simple(1, &rows, NULL);
    const int good = H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, NULL, &rows, NULL) >= 0 &&
                     H5Dread(set, type, memory, space, H5P_DEFAULT, data) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(set);
    return good;
}

/* ---- the file ------------------------------------------------------------------------------ */

/* One entry for each frame, in Steps and beside it. */
static const char *const mpm__hdf5_step[] = {"PartOffsets", "NumberOfParts", "PointOffsets", "CellOffsets",
                                             "ConnectivityIdOffsets"};
static const char *const mpm__hdf5_part[] = {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"};
#define MPM__HDF5_SERIES 64 /* rows of a chunk of such a table */

typedef struct mpm__hdf5_file {
    hid_t file, root, points, steps, offsets; /* groups VTKHDF, PointData, Steps, PointDataOffsets */
} mpm__hdf5_file;

/* How a file is opened: in the format of HDF5 1.10, which has SWMR; without waiting long for what is not there; also
   while a reader has it open, whose lock would end the run (HDF5 1.10.7, 1.12.1 and later can be told so). */
static inline hid_t mpm__hdf5_access(void)
{
    const hid_t how = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(how, H5F_LIBVER_V110, H5F_LIBVER_LATEST);
    H5Pset_metadata_read_attempts(how, 10);
#if (H5_VERS_MAJOR == 1 && H5_VERS_MINOR == 10 && H5_VERS_RELEASE >= 7) || H5_VERSION_GE(1, 12, 1)
    H5Pset_file_locking(how, 0, 1);
#endif
    return how;
}

static inline int mpm__hdf5_groups(mpm__hdf5_file *f)
{
    f->root = H5Gopen2(f->file, "VTKHDF", H5P_DEFAULT);
    f->points = H5Gopen2(f->root, "PointData", H5P_DEFAULT);
    f->steps = H5Gopen2(f->root, "Steps", H5P_DEFAULT);
    f->offsets = H5Gopen2(f->steps, "PointDataOffsets", H5P_DEFAULT);
    return f->offsets >= 0 && f->points >= 0;
}

static inline int mpm__hdf5_open(mpm__hdf5_file *f, const char *path, unsigned flags)
{
    const hid_t how = mpm__hdf5_access();
    f->file = H5Fopen(path, flags, how);
    H5Pclose(how);
    return mpm__hdf5_groups(f);
}

static inline int mpm__hdf5_close(mpm__hdf5_file *f)
{
    H5Gclose(f->offsets);
    H5Gclose(f->steps);
    H5Gclose(f->points);
    H5Gclose(f->root);
    return H5Fclose(f->file) >= 0;
}

static inline int mpm__hdf5_steps(const mpm__hdf5_file *f, int64_t *n)
{
    const hid_t a = H5Aopen(f->steps, "NSteps", H5P_DEFAULT);
    const int good = H5Aread(a, H5T_NATIVE_INT64, n) >= 0 && *n >= 0;
    H5Aclose(a);
    return good;
}

static inline int mpm__hdf5_set_steps(const mpm__hdf5_file *f, int64_t n)
{
    const hid_t a = H5Aopen(f->steps, "NSteps", H5P_DEFAULT);
    const int good = H5Awrite(a, H5T_NATIVE_INT64, &n) >= 0;
    H5Aclose(a);
    return good;
}

/* Types of a field: in memory, and in the file. */
static inline hid_t mpm__hdf5_native(const mpm_hdf5_field *f, int float32)
{
    if (f->bytes) return H5T_NATIVE_UINT8;
    if (f->integers) return H5T_NATIVE_INT32;
    return float32 || sizeof(mpm_real) == sizeof(float) ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
}

static inline hid_t mpm__hdf5_stored(const mpm_hdf5_field *f, int float32)
{
    if (f->bytes) return H5T_STD_U8LE;
    if (f->integers) return H5T_STD_I32LE;
    return float32 || sizeof(mpm_real) == sizeof(float) ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
}

/* Its arrays, without rows: chunks as long as a frame or 32768 rows. */
static inline int mpm__hdf5_tables(mpm__hdf5_file *f, const mpm_hdf5_desc *d)
{
    const mpm_hdf5_field points = mpm_hdf5_vector("Points", d->x[0], d->x[1], d->x[2], d->scale);
    const size_t rows = d->count < 32768 ? d->count : 32768;
    char name[MPM__HDF5_NAME];
    int good, k;
    good = mpm__hdf5_create(f->root, "Points", NULL, 3, rows, mpm__hdf5_stored(&points, d->float32), d->gzip) &&
           mpm__hdf5_create(f->root, "Connectivity", NULL, 1, rows, H5T_STD_I64LE, d->gzip) &&
           mpm__hdf5_create(f->root, "Offsets", NULL, 1, rows + 1, H5T_STD_I64LE, d->gzip) &&
           mpm__hdf5_create(f->root, "Types", NULL, 1, rows, H5T_STD_U8LE, d->gzip) &&
           mpm__hdf5_create(f->steps, "Values", NULL, 1, MPM__HDF5_SERIES, H5T_IEEE_F64LE, 0);
    for (k = 0; k < 3; k++)
        good = good && mpm__hdf5_create(f->root, mpm__hdf5_part[k], NULL, 1, MPM__HDF5_SERIES, H5T_STD_I64LE, 0);
    for (k = 0; k < 5; k++)
        good = good && mpm__hdf5_create(f->steps, mpm__hdf5_step[k], NULL, 1, MPM__HDF5_SERIES, H5T_STD_I64LE, 0);
    for (k = 0; good && k < d->field_count; k++) {
        const mpm_hdf5_field *a = &d->fields[k];
        mpm__hdf5_name(a->name, name);
        good = mpm__hdf5_create(f->points, name, a->name, a->components, rows, mpm__hdf5_stored(a, d->float32),
                                d->gzip) &&
               mpm__hdf5_create(f->offsets, name, NULL, 1, MPM__HDF5_SERIES, H5T_STD_I64LE, 0);
    }
    return good;
}

/* A file without arrays. */
static inline int mpm__hdf5_begin(mpm__hdf5_file *f, const char *path, const char *note)
{
    const hid_t how = mpm__hdf5_access();
    const int64_t version[2] = {2, 0}, none = 0;
    f->file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, how);
    H5Pclose(how);
    f->root = H5Gcreate2(f->file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    f->points = H5Gcreate2(f->root, "PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    f->steps = H5Gcreate2(f->root, "Steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    f->offsets = H5Gcreate2(f->steps, "PointDataOffsets", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    return f->offsets >= 0 && mpm__hdf5_attribute(f->root, "Version", H5T_NATIVE_INT64, 2, version) &&
           mpm__hdf5_text(f->root, "Type", "UnstructuredGrid") &&
           mpm__hdf5_attribute(f->steps, "NSteps", H5T_NATIVE_INT64, 0, &none) &&
           mpm__hdf5_text(f->file, "mpm.h", MPM_VERSION) && mpm__hdf5_text(f->file, "note", note);
}

/* ---- a frame ------------------------------------------------------------------------------- */

/* The values of a field as the file has them, row by row, into `buffer`. Returns where they are. */
static inline const void *mpm__hdf5_values(const mpm_hdf5_field *f, size_t count, int float32, void *buffer)
{
    static const int order[9] = {0, 1, 2, 5, 3, 4, 6, 7, 8}; /* xy before yz and xz */
    const int single = float32 || sizeof(mpm_real) == sizeof(float);
    size_t p, at;
    int k;
    if (f->bytes) return f->bytes;
    if (f->integers) return f->integers;
    for (p = 0, at = 0; p < count; p++)
        for (k = 0; k < f->components; k++, at++) {
            const mpm_real *a = f->data[f->components == 6 ? order[k] : k];
            mpm_real value = a ? a[p] : 0;
            if (f->scale < 1 || f->scale > 1) value = (mpm_real)((double)value * f->scale);
            if (single) ((float *)buffer)[at] = (float)value;
            else ((double *)buffer)[at] = (double)value;
        }
    return buffer;
}

/* Points of a cell: 1, 2 or 3. */
static inline int mpm__hdf5_ends(const mpm_hdf5_desc *d) { return d->cells ? d->cell_points : 1; }

/* Connectivity, offsets and types, and where they begin in the tables of the steps. */
static inline int mpm__hdf5_cells(const mpm__hdf5_file *f, const mpm_hdf5_desc *d, void *buffer)
{
    static const uint8_t type[4] = {0, 1, 3, 5}; /* VTK_VERTEX, VTK_LINE, VTK_TRIANGLE */
    const size_t n = d->cells ? d->cell_count : d->count, ends = (size_t)mpm__hdf5_ends(d);
    int64_t *number = (int64_t *)buffer;
    hsize_t at = 0, from = 0;
    size_t i;
    int good;
    for (i = 0; i < n * ends; i++) number[i] = d->cells ? d->cells[i] : (int64_t)i;
    good = mpm__hdf5_put(f->root, "Connectivity", 1, n * ends, H5T_NATIVE_INT64, number, &from);
    for (i = 0; i <= n; i++) number[i] = (int64_t)(i * ends);
    good = good && mpm__hdf5_put(f->root, "Offsets", 1, n + 1, H5T_NATIVE_INT64, number, NULL);
    memset(buffer, type[ends], n);
    return good && mpm__hdf5_put(f->root, "Types", 1, n, H5T_NATIVE_UINT8, buffer, &at) &&
           mpm__hdf5_put_number(f->root, "NumberOfCells", n) &&
           mpm__hdf5_put_number(f->root, "NumberOfConnectivityIds", n * ends) &&
           mpm__hdf5_put_number(f->steps, "CellOffsets", at) &&
           mpm__hdf5_put_number(f->steps, "ConnectivityIdOffsets", from);
}

/* Fields, each with its offset. */
static inline int mpm__hdf5_fields(const mpm__hdf5_file *f, const mpm_hdf5_desc *d, void *buffer)
{
    char name[MPM__HDF5_NAME];
    int k, good = 1;
    for (k = 0; good && k < d->field_count; k++) {
        const mpm_hdf5_field *a = &d->fields[k];
        const void *values = mpm__hdf5_values(a, d->count, d->float32, buffer);
        hsize_t at = 0;
        mpm__hdf5_name(a->name, name);
        good = mpm__hdf5_put(f->points, name, a->components, d->count, mpm__hdf5_native(a, d->float32), values, &at) &&
               mpm__hdf5_put_number(f->offsets, name, at);
    }
    return good;
}

/* Adds everything of one frame; NSteps, which makes it count, when the rest is in the file. */
static inline int mpm__hdf5_add(const mpm__hdf5_file *f, int64_t frame, const mpm_hdf5_desc *d, void *buffer)
{
    const mpm_hdf5_field points = mpm_hdf5_vector("Points", d->x[0], d->x[1], d->x[2], d->scale);
    const void *values = mpm__hdf5_values(&points, d->count, d->float32, buffer);
    hsize_t at = 0;
    return mpm__hdf5_put(f->root, "Points", 3, d->count, mpm__hdf5_native(&points, d->float32), values, &at) &&
           mpm__hdf5_put_number(f->steps, "PointOffsets", at) &&
           mpm__hdf5_put_number(f->root, "NumberOfPoints", d->count) && mpm__hdf5_cells(f, d, buffer) &&
           mpm__hdf5_fields(f, d, buffer) && mpm__hdf5_put_number(f->steps, "PartOffsets", (hsize_t)frame) &&
           mpm__hdf5_put_number(f->steps, "NumberOfParts", 1) &&
           mpm__hdf5_put(f->steps, "Values", 1, 1, H5T_NATIVE_DOUBLE, &d->time, NULL) &&
           H5Fflush(f->file, H5F_SCOPE_GLOBAL) >= 0 && mpm__hdf5_set_steps(f, frame + 1);
}

/* Room for the largest array of a frame. */
static inline void *mpm__hdf5_buffer(const mpm_hdf5_desc *d)
{
    const size_t cells = d->cells ? d->cell_count : d->count;
    size_t bytes = mpm_size_mul(mpm_size_add(mpm_size_mul(cells, (size_t)mpm__hdf5_ends(d)), 1), sizeof(int64_t));
    int k, most = 3;
    for (k = 0; k < d->field_count; k++)
        if (d->fields[k].components > most) most = d->fields[k].components;
    if (bytes < mpm_size_mul(mpm_size_mul(d->count, (size_t)most), sizeof(double)))
        bytes = mpm_size_mul(mpm_size_mul(d->count, (size_t)most), sizeof(double));
    return MPM_MALLOC(bytes);
}

/* ---- dropping frames ----------------------------------------------------------------------- */

/* The name of a group's member number i. */
static inline int mpm__hdf5_member(hid_t group, hsize_t i, char name[MPM__HDF5_NAME])
{
    return H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, MPM__HDF5_NAME, H5P_DEFAULT) > 0;
}

/* A text attribute, into text[MPM__HDF5_NAME]; "" where there is none. */
static inline void mpm__hdf5_get_text(hid_t at, const char *name, char *text)
{
    const hid_t a = H5Aopen(at, name, H5P_DEFAULT), type = H5Aget_type(a);
    memset(text, 0, MPM__HDF5_NAME);
    if (a < 0 || H5Tget_size(type) >= MPM__HDF5_NAME || H5Aread(a, type, text) < 0) text[0] = 0;
    H5Tclose(type);
    H5Aclose(a);
}

/* Copies rows from one array to another, a chunk's length at a time. */
static inline int mpm__hdf5_rows_over(hid_t from, hid_t to, hid_t type, hsize_t rows, hsize_t columns)
{
    const hid_t there = H5Dget_space(from), here = H5Dget_space(to);
    const hsize_t most = rows < 32768 ? rows : 32768;
    void *buffer = MPM_MALLOC(mpm_size_mul((size_t)(most * columns), H5Tget_size(type)) + 1);
    const int rank = columns > 1 ? 2 : 1;
    hsize_t first[2] = {0, 0}, count[2];
    int good = buffer != NULL;
    for (count[1] = columns; good && first[0] < rows; first[0] += most) {
        hid_t memory;
        count[0] = rows - first[0] < most ? rows - first[0] : most;
        memory = H5Screate_simple(rank, count, NULL);
        good = H5Sselect_hyperslab(there, H5S_SELECT_SET, first, NULL, count, NULL) >= 0 &&
               H5Sselect_hyperslab(here, H5S_SELECT_SET, first, NULL, count, NULL) >= 0 &&
               H5Dread(from, type, memory, there, H5P_DEFAULT, buffer) >= 0 &&
               H5Dwrite(to, type, memory, here, H5P_DEFAULT, buffer) >= 0;
        H5Sclose(memory);
    }
    MPM_FREE(buffer);
    H5Sclose(here);
    H5Sclose(there);
    return good;
}

/* Makes an array like one of another file, of its first rows. */
static inline int mpm__hdf5_over(hid_t from, hid_t to, const char *name, hsize_t rows)
{
    const hid_t set = H5Dopen2(from, name, H5P_DEFAULT), type = H5Dget_type(set), how = H5Dget_create_plist(set);
    hsize_t columns;
    const hsize_t there = mpm__hdf5_rows(from, name, &columns);
    const hsize_t size[2] = {rows, columns}, most[2] = {H5S_UNLIMITED, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, size, most);
    const hid_t made = H5Dcreate2(to, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    char text[MPM__HDF5_NAME];
    int good = there >= rows && mpm__hdf5_rows_over(set, made, type, rows, columns);
    mpm__hdf5_get_text(set, "name", text);
    good = good && mpm__hdf5_text(made, "name", text);
    H5Dclose(made);
    H5Sclose(space);
    H5Pclose(how);
    H5Tclose(type);
    H5Dclose(set);
    return good;
}

/* Where frame number `frame` begins: the sum of an array of counts before it. */
static inline int mpm__hdf5_before(hid_t at, const char *name, int64_t frame, hsize_t *sum)
{
    int64_t one = 0, i;
    for (*sum = 0, i = 0; i < frame; i++, *sum += (hsize_t)one)
        if (!mpm__hdf5_get(at, name, (hsize_t)i, 1, H5T_NATIVE_INT64, &one) || one < 0) return 0;
    return 1;
}

/* The first `frames` of an open file, into one without arrays. */
static inline int mpm__hdf5_keep(const mpm__hdf5_file *f, const mpm__hdf5_file *to, int64_t frames)
{
    char name[MPM__HDF5_NAME];
    hsize_t points = 0, cells = 0, ids = 0, i, n = (hsize_t)frames;
    int good = mpm__hdf5_before(f->root, "NumberOfPoints", frames, &points) &&
               mpm__hdf5_before(f->root, "NumberOfCells", frames, &cells) &&
               mpm__hdf5_before(f->root, "NumberOfConnectivityIds", frames, &ids);
    int k;
    for (k = 0; k < 3; k++) good = good && mpm__hdf5_over(f->root, to->root, mpm__hdf5_part[k], n);
    for (k = 0; k < 5; k++) good = good && mpm__hdf5_over(f->steps, to->steps, mpm__hdf5_step[k], n);
    good = good && mpm__hdf5_over(f->steps, to->steps, "Values", n) &&
           mpm__hdf5_over(f->root, to->root, "Points", points) &&
           mpm__hdf5_over(f->root, to->root, "Connectivity", ids) &&
           mpm__hdf5_over(f->root, to->root, "Types", cells) &&
           mpm__hdf5_over(f->root, to->root, "Offsets", cells + n);
    for (i = 0; good && mpm__hdf5_member(f->points, i, name); i++)
        good = mpm__hdf5_over(f->points, to->points, name, points) &&
               mpm__hdf5_over(f->offsets, to->offsets, name, n);
    return good && mpm__hdf5_set_steps(to, frames);
}

/* Puts a copy with the first `frames` in the place of a file that has more, or is marked as open: nothing is changed
   in what a killed process left. */
static inline int mpm__hdf5_repair(const char *path, const char *part, int64_t frames)
{
    mpm__hdf5_file f, to;
    char note[MPM__HDF5_NAME];
    int64_t there = 0;
    int good = mpm__hdf5_open(&f, path, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ) && mpm__hdf5_steps(&f, &there) &&
               there >= frames;
    if (good) {
        mpm__hdf5_get_text(f.file, "note", note);
        good = mpm__hdf5_begin(&to, part, note) && mpm__hdf5_keep(&f, &to, frames);
        good = mpm__hdf5_close(&to) && good;
        if (!good) remove(part);
    }
    mpm__hdf5_close(&f);
    return good && mpm__hdf5_rename(part, path);
}

/* Where the last of so many frames ends, by the tables of beginnings and lengths. */
static inline int mpm__hdf5_end(const mpm__hdf5_file *f, const char *first, const char *count, int64_t frames,
                                hsize_t *end)
{
    int64_t at = 0, n = 0;
    const int good = mpm__hdf5_get(f->steps, first, (hsize_t)(frames - 1), 1, H5T_NATIVE_INT64, &at) &&
                     mpm__hdf5_get(f->root, count, (hsize_t)(frames - 1), 1, H5T_NATIVE_INT64, &n);
    *end = (hsize_t)(at + n);
    return good;
}

/* Whether every array ends with the last of so many frames: one that could not be added, as on a full disk, may leave
   rows. */
static inline int mpm__hdf5_exact(const mpm__hdf5_file *f, int64_t frames)
{
    const hsize_t n = (hsize_t)frames;
    hsize_t points = 0, cells = 0, ids = 0, i;
    char name[MPM__HDF5_NAME];
    int k, good = frames > 0 && mpm__hdf5_end(f, "PointOffsets", "NumberOfPoints", frames, &points) &&
                  mpm__hdf5_end(f, "CellOffsets", "NumberOfCells", frames, &cells) &&
                  mpm__hdf5_end(f, "ConnectivityIdOffsets", "NumberOfConnectivityIds", frames, &ids);
    for (k = 0; k < 3; k++) good = good && mpm__hdf5_rows(f->root, mpm__hdf5_part[k], NULL) == n;
    for (k = 0; k < 5; k++) good = good && mpm__hdf5_rows(f->steps, mpm__hdf5_step[k], NULL) == n;
    good = good && mpm__hdf5_rows(f->steps, "Values", NULL) == n && mpm__hdf5_rows(f->root, "Points", NULL) == points &&
           mpm__hdf5_rows(f->root, "Connectivity", NULL) == ids && mpm__hdf5_rows(f->root, "Types", NULL) == cells &&
           mpm__hdf5_rows(f->root, "Offsets", NULL) == cells + n;
    for (i = 0; good && mpm__hdf5_member(f->points, i, name); i++)
        good = mpm__hdf5_rows(f->points, name, NULL) == points && mpm__hdf5_rows(f->offsets, name, NULL) == n;
    return good;
}

/* Whether a file can be gone on with as it is: so many frames, and nothing behind them. */
static inline int mpm__hdf5_ready(const char *path, int64_t frames)
{
    mpm__hdf5_file f;
    int64_t there = -1;
    const int good = mpm__hdf5_open(&f, path, H5F_ACC_RDONLY) && mpm__hdf5_steps(&f, &there) && there == frames &&
                     mpm__hdf5_exact(&f, frames);
    mpm__hdf5_close(&f);
    return good;
}

/* ---- writing ------------------------------------------------------------------------------- */

static inline mpm_status mpm__hdf5_first(const char *path, const char *part, const mpm_hdf5_desc *d, void *buffer,
                                         mpm_fault *fault)
{
    mpm__hdf5_file f;
    int good = mpm__hdf5_begin(&f, part, d->note ? d->note : "") && mpm__hdf5_tables(&f, d) &&
               mpm__hdf5_add(&f, 0, d, buffer);
    good = mpm__hdf5_close(&f) && good;
    if (good && mpm__hdf5_rename(part, path)) return MPM_OK;
    remove(part);
    return mpm_fail(fault, MPM_ERR_FILE, "a file of HDF5 to write", 0, -1);
}

/* The field that the file does not have like this, or -1. */
static inline int mpm__hdf5_other(const mpm__hdf5_file *f, const mpm_hdf5_desc *d)
{
    char name[MPM__HDF5_NAME];
    H5G_info_t info;
    hsize_t columns;
    int k;
    if (H5Gget_info(f->points, &info) < 0 || info.nlinks != (hsize_t)d->field_count) return d->field_count;
    for (k = 0; k < d->field_count; k++) {
        mpm__hdf5_name(d->fields[k].name, name);
        if (H5Lexists(f->points, name, H5P_DEFAULT) <= 0) return k;
        mpm__hdf5_rows(f->points, name, &columns);
        if (columns != (hsize_t)d->fields[k].components) return k;
    }
    return -1;
}

static inline mpm_status mpm__hdf5_next(const char *path, const char *part, int64_t frame, const mpm_hdf5_desc *d,
                                        void *buffer, mpm_fault *fault)
{
    mpm__hdf5_file f;
    int good, other;
    if (!mpm__hdf5_ready(path, frame) && !mpm__hdf5_repair(path, part, frame))
        return mpm_fail(fault, MPM_ERR_FILE, "a file of HDF5 that holds all frames before number", 0, frame);
    good = mpm__hdf5_open(&f, path, H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE);
    other = good ? mpm__hdf5_other(&f, d) : -1;
    good = good && other < 0 && mpm__hdf5_add(&f, frame, d, buffer);
    good = mpm__hdf5_close(&f) && good;
    if (other >= 0) return mpm_fail(fault, MPM_ERR_FILE, "fields of the frames before: other ones", 0, other);
    return good ? MPM_OK : mpm_fail(fault, MPM_ERR_FILE, "a file of HDF5 to add to", 0, frame);
}

MPM_API int mpm_hdf5_built(void) { return 1; }

MPM_API mpm_status mpm_hdf5_frame(const char *path, int64_t frame, const mpm_hdf5_desc *d, mpm_fault *fault)
{
    mpm_status status = mpm__hdf5_check(d, fault);
    mpm__hdf5_say say;
    char *part;
    void *buffer;
    if (status < 0) return status;
    if (frame < 0) return mpm_fail(fault, MPM_ERR_ARGUMENT, "frame", (mpm_real)frame, -1);
    say = mpm__hdf5_hush();
    part = mpm__hdf5_path(path, ".part");
    buffer = mpm__hdf5_buffer(d);
    if (!part || !buffer) status = mpm_fail(fault, MPM_ERR_MEMORY, "frame of a file of HDF5", 0, frame);
    else if (frame == 0) status = mpm__hdf5_first(path, part, d, buffer, fault);
    else status = mpm__hdf5_next(path, part, frame, d, buffer, fault);
    MPM_FREE(buffer);
    MPM_FREE(part);
    mpm__hdf5_speak(say);
    return status;
}

MPM_API mpm_status mpm_hdf5_frames(const char *path, int64_t *frames, mpm_fault *fault)
{
    const mpm__hdf5_say say = mpm__hdf5_hush();
    mpm__hdf5_file f;
    const int good = mpm__hdf5_open(&f, path, H5F_ACC_RDONLY) && mpm__hdf5_steps(&f, frames);
    mpm__hdf5_close(&f);
    mpm__hdf5_speak(say);
    if (good) return MPM_OK;
    *frames = 0;
    return mpm_fail(fault, MPM_ERR_FILE, "a file of HDF5 that can be read", 0, -1);
}

/* ---- XDMF ---------------------------------------------------------------------------------- */

/* XML text, with the reserved characters escaped. */
static inline void mpm__hdf5_xml(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (*text == '&') fputs("&amp;", out);
        else if (*text == '<') fputs("&lt;", out);
        else if (*text == '>') fputs("&gt;", out);
        else if (*text == '"') fputs("&quot;", out);
        else if ((unsigned char)*text >= 32) fputc(*text, out);
    }
}

/* A number with a decimal point under every locale. */
static inline void mpm__hdf5_number(FILE *out, double value)
{
    char text[64], *c;
    snprintf(text, sizeof text, "%.17g", value);
    for (c = text; *c; c++)
        if (!strchr("+-0123456789einfa", *c)) *c = '.';
    fputs(text, out);
}

/* Some rows of an array of the file, as a DataItem; an array of one column in lines of `width`. */
static inline void mpm__hdf5_slab(FILE *out, const char *file, hid_t at, const char *folder, const char *name,
                                  int64_t first, int64_t rows, int width)
{
    hsize_t columns, all = mpm__hdf5_rows(at, name, &columns);
    const hid_t set = H5Dopen2(at, name, H5P_DEFAULT), type = H5Dget_type(set);
    const int bytes = (int)H5Tget_size(type), c = (int)columns;
    const char *kind = H5Tget_class(type) == H5T_FLOAT ? "Float" : bytes == 1 ? "UChar" : "Int";
    const long long n = rows, from = first, whole = (long long)all;
    fprintf(out, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%lld %d\" NumberType=\"%s\" Precision=\"%d\">",
            n / width, c * width, kind, bytes);
    if (c > 1) fprintf(out, "<DataItem Dimensions=\"3 2\" Format=\"XML\">%lld 0 1 1 %lld %d</DataItem>", from, n, c);
    else fprintf(out, "<DataItem Dimensions=\"3 1\" Format=\"XML\">%lld 1 %lld</DataItem>", from, n);
    fprintf(out, "<DataItem Dimensions=\"%lld", whole);
    if (c > 1) fprintf(out, " %d", c);
    fprintf(out, "\" NumberType=\"%s\" Precision=\"%d\" Format=\"HDF\">", kind, bytes);
    mpm__hdf5_xml(out, file);
    fprintf(out, ":/VTKHDF/%s", folder);
    mpm__hdf5_xml(out, name);
    fprintf(out, "</DataItem></DataItem>\n");
    H5Tclose(type);
    H5Dclose(set);
}

/* A field's name as it was given. */
static inline void mpm__hdf5_given(hid_t points, const char *name, char text[MPM__HDF5_NAME])
{
    const hid_t set = H5Dopen2(points, name, H5P_DEFAULT);
    mpm__hdf5_get_text(set, "name", text);
    if (!text[0]) mpm_append(text, MPM__HDF5_NAME, 0, name);
    H5Dclose(set);
}

/* Where a frame's parts begin and how long they are. */
typedef struct mpm__hdf5_place {
    int64_t point, id, cell, points, cells, ids;
    uint8_t type; /* of its cells */
    double time;                /* [time], in the unit that ParaView shall show */
} mpm__hdf5_place;

static inline int mpm__hdf5_place_of(const mpm__hdf5_file *f, hsize_t frame, mpm__hdf5_place *p)
{
    const hid_t number = H5T_NATIVE_INT64;
    p->type = 1;
    return mpm__hdf5_get(f->steps, "PointOffsets", frame, 1, number, &p->point) &&
           mpm__hdf5_get(f->steps, "ConnectivityIdOffsets", frame, 1, number, &p->id) &&
           mpm__hdf5_get(f->steps, "CellOffsets", frame, 1, number, &p->cell) &&
           mpm__hdf5_get(f->root, "NumberOfPoints", frame, 1, number, &p->points) &&
           mpm__hdf5_get(f->root, "NumberOfCells", frame, 1, number, &p->cells) &&
           mpm__hdf5_get(f->root, "NumberOfConnectivityIds", frame, 1, number, &p->ids) &&
           mpm__hdf5_get(f->steps, "Values", frame, 1, H5T_NATIVE_DOUBLE, &p->time) &&
           (p->cells == 0 || mpm__hdf5_get(f->root, "Types", (hsize_t)p->cell, 1, H5T_NATIVE_UINT8, &p->type));
}

static inline void mpm__hdf5_grid(FILE *out, const char *file, const mpm__hdf5_file *f, const mpm__hdf5_place *p)
{
    const char *kind = p->type == 5 ? "Triangle" : p->type == 3 ? "Polyline" : "Polyvertex";
    const int ends = p->type == 5 ? 3 : p->type == 3 ? 2 : 1;
    char name[MPM__HDF5_NAME], given[MPM__HDF5_NAME];
    hsize_t i, columns;
    fprintf(out, "<Grid Name=\"frame\" GridType=\"Uniform\">\n<Time Value=\"");
    mpm__hdf5_number(out, p->time);
    fprintf(out, "\"/>\n<Topology TopologyType=\"%s\" NumberOfElements=\"%lld\" NodesPerElement=\"%d\">\n", kind,
            (long long)p->cells, ends);
    mpm__hdf5_slab(out, file, f->root, "", "Connectivity", p->id, p->ids, ends);
    fprintf(out, "</Topology>\n<Geometry GeometryType=\"XYZ\">\n");
    mpm__hdf5_slab(out, file, f->root, "", "Points", p->point, p->points, 1);
    fprintf(out, "</Geometry>\n");
    for (i = 0; mpm__hdf5_member(f->points, i, name); i++) {
        mpm__hdf5_given(f->points, name, given);
        mpm__hdf5_rows(f->points, name, &columns);
        fprintf(out, "<Attribute Name=\"");
        mpm__hdf5_xml(out, given);
        fprintf(out, "\" AttributeType=\"%s\" Center=\"Node\">\n",
                columns == 1 ? "Scalar" : columns == 3 ? "Vector" : "Matrix");
        mpm__hdf5_slab(out, file, f->points, "PointData/", name, p->point, p->points, 1);
        fprintf(out, "</Attribute>\n");
    }
    fprintf(out, "</Grid>\n");
}

/* The text of all frames. */
static inline int mpm__hdf5_series(FILE *out, const char *file, const mpm__hdf5_file *f)
{
    int64_t frames = 0, k;
    mpm__hdf5_place p;
    int good = mpm__hdf5_steps(f, &frames);
    fprintf(out, "<?xml version=\"1.0\"?>\n<!-- mpm.h " MPM_VERSION " -->\n<Xdmf Version=\"2.0\">\n<Domain>\n"
                 "<Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
    for (k = 0; good && k < frames; k++) {
        good = mpm__hdf5_place_of(f, (hsize_t)k, &p);
        if (good) mpm__hdf5_grid(out, file, f, &p);
    }
    fprintf(out, "</Grid>\n</Domain>\n</Xdmf>\n");
    return good && !ferror(out);
}

/* What follows the last "/" of a path. */
static inline const char *mpm__hdf5_base(const char *path)
{
    const char *base = strrchr(path, '/');
    return base ? base + 1 : path;
}

MPM_API mpm_status mpm_hdf5_xdmf(const char *path, const char *xmf, mpm_fault *fault)
{
    const mpm__hdf5_say say = mpm__hdf5_hush();
    char *part = mpm__hdf5_path(xmf, ".part");
    FILE *out = part ? fopen(part, "wb") : NULL;
    mpm__hdf5_file f;
    int good = mpm__hdf5_open(&f, path, H5F_ACC_RDONLY);
    const int readable = good;
    if (out) {
        good = good && mpm__hdf5_series(out, mpm__hdf5_base(path), &f);
        good = fclose(out) == 0 && good;
        if (!good) remove(part);
        good = good && mpm__hdf5_rename(part, xmf);
    }
    mpm__hdf5_close(&f);
    mpm__hdf5_speak(say);
    MPM_FREE(part);
    if (good && out) return MPM_OK;
    return mpm_fail(fault, MPM_ERR_FILE, readable ? "an XDMF file to write" : "a file of HDF5 that can be read", 0, -1);
}

#endif /* MPM_HDF5 */

#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */
