/* mpm_io.h - files for mpm.h: VTK, PNG, JSON, CSV, checkpoints, progress.
   Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm_io.h"
       #include "mpm_io.h"
     Then hand it arrays: it writes what it is told about and knows nothing of materials, bonding or
     grids. Link with -lm.

   WHAT IT DOES NOT DO
     It reads nothing but its own checkpoints, .pvd series and pictures. It draws nothing: mpm_draw.h does, and
     its pixels go to mpm_io_png. It never prints to stdout or stderr, never exits, and keeps no
     global state.

   NOTHING HALF-WRITTEN
     Every file is written under a name of its own beside <path>, <path>.<8 digits>.part, which must
     be new: no link is followed, nothing is waited for. It is flushed, brought to the disk (where the
     system can), closed, and only then renamed to <path>. When any of this fails the .part file is
     removed, a file of that name from before is untouched, and the routine returns MPM_ERR_FILE.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm_io.h"
       int main(void) {
           mpm_real x[2] = {0, 1}, y[2] = {0, 0}, z[2] = {0, 1}, hot[2] = {300, 900};
           mpm_io_field field = mpm_io_scalar("temperature (K)", hot, 1);
           mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
           mpm_fault fault;
           d.count = 2; d.x[0] = x; d.x[1] = y; d.x[2] = z;
           d.fields = &field; d.field_count = 1;
           if (mpm_io_make_directory("out", &fault) < 0) return 1;
           return mpm_io_vtu("out/two.vtu", &d, &fault) < 0;
       }

   A FORMAT OF YOUR OWN
     is made of the same routines as those here, and needs no change to this file:
       mpm_status write_xyz(const char *path, const mpm_points *p, mpm_fault *fault) {
           mpm_io_file f;
           mpm_status s = mpm_io_open(&f, path, fault);
           int32_t i;
           int a;
           for (i = 0; i < p->count; i++)
               for (a = 0; a < 3; a++) {
                   mpm_io_put_real(&f, p->x[a][i]);
                   mpm_io_put(&f, a < 2 ? " " : "\n");
               }
           return s < 0 ? s : mpm_io_close(&f, fault);
       }

   CONTENTS
     messages      mpm_io_fault_text, _number_text, _decimal_point, _progress_text
     files         mpm_io_make_directory, mpm_io_open, _put, _put_bytes, _put_number, _put_real,
                   _put_integer, _close, _drop
     text files    mpm_io_json_*, mpm_io_csv_*
     ParaView      mpm_io_scalar .. mpm_io_int32, mpm_io_vtu, mpm_io_body_numbers, mpm_io_pvd_begin, mpm_io_pvd_add
     restart       mpm_io_checkpoint_write, _checkpoint_read, _checkpoint_sizes, _world_text, _line,
                   _line_number
     pictures      mpm_io_png, mpm_io_film_begin, _film_add, _film_add_png, _film_end

   CONFIGURATION (define before including)
     MPM_FLOAT               GLOBAL  as in mpm.h; public symbols then end in _f32.
     MPM_MALLOC(n), MPM_FREE(p) IMPL names of files being written, lines of a .pvd, work memory of mpm_io_png and films.

   CONVENTIONS
     Text is UTF-8. Numbers in text files carry a decimal point under every locale and as many
     digits as bring the value back exactly. */
#ifndef MPM_IO_H
#define MPM_IO_H

#include <stdio.h>
#include "mpm.h"
#if MPM_VERSION_NUMBER != 200
#error "mpm_io.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_io_fault_text mpm_io_fault_text_f32
#define mpm_io_number_text mpm_io_number_text_f32
#define mpm_io_progress_text mpm_io_progress_text_f32
#define mpm_io_make_directory mpm_io_make_directory_f32
#define mpm_io_decimal_point mpm_io_decimal_point_f32
#define mpm_io_open mpm_io_open_f32
#define mpm_io_put mpm_io_put_f32
#define mpm_io_put_bytes mpm_io_put_bytes_f32
#define mpm_io_put_number mpm_io_put_number_f32
#define mpm_io_put_real mpm_io_put_real_f32
#define mpm_io_put_integer mpm_io_put_integer_f32
#define mpm_io_close mpm_io_close_f32
#define mpm_io_drop mpm_io_drop_f32
#define mpm_io_json_begin mpm_io_json_begin_f32
#define mpm_io_json_number mpm_io_json_number_f32
#define mpm_io_json_integer mpm_io_json_integer_f32
#define mpm_io_json_bool mpm_io_json_bool_f32
#define mpm_io_json_string mpm_io_json_string_f32
#define mpm_io_json_open mpm_io_json_open_f32
#define mpm_io_json_close mpm_io_json_close_f32
#define mpm_io_json_end mpm_io_json_end_f32
#define mpm_io_csv_begin mpm_io_csv_begin_f32
#define mpm_io_csv_real mpm_io_csv_real_f32
#define mpm_io_csv_integer mpm_io_csv_integer_f32
#define mpm_io_csv_text mpm_io_csv_text_f32
#define mpm_io_csv_row mpm_io_csv_row_f32
#define mpm_io_csv_end mpm_io_csv_end_f32
#define mpm_io_csv_drop mpm_io_csv_drop_f32
#define mpm_io_scalar mpm_io_scalar_f32
#define mpm_io_vector mpm_io_vector_f32
#define mpm_io_tensor mpm_io_tensor_f32
#define mpm_io_uint8 mpm_io_uint8_f32
#define mpm_io_int32 mpm_io_int32_f32
#define mpm_io_vtu_desc_default mpm_io_vtu_desc_default_f32
#define mpm_io_vtu mpm_io_vtu_f32
#define mpm_io_pvd_begin mpm_io_pvd_begin_f32
#define mpm_io_pvd_add mpm_io_pvd_add_f32
#define mpm_io_checkpoint_write mpm_io_checkpoint_write_f32
#define mpm_io_checkpoint_read mpm_io_checkpoint_read_f32
#define mpm_io_checkpoint_sizes mpm_io_checkpoint_sizes_f32
#define mpm_io_world_text mpm_io_world_text_f32
#define mpm_io_line mpm_io_line_f32
#define mpm_io_line_number mpm_io_line_number_f32
#define mpm_io_png mpm_io_png_f32
#define mpm_io_film_begin mpm_io_film_begin_f32
#define mpm_io_film_add mpm_io_film_add_f32
#define mpm_io_film_add_png mpm_io_film_add_png_f32
#define mpm_io_film_end mpm_io_film_end_f32
#define mpm_io_body_numbers mpm_io_body_numbers_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- messages ------------------------------------------------------------------------------ */

/* Writes "meaning: field = value (index 12)" into buffer[n], cut to fit and always terminated when
   n > 0. The index (a point, a body or an axis: the field's name says which) is left out when
   negative; "= value" is left out for MPM_ERR_FILE and MPM_ERR_VERSION, where the field says what
   of the file was wrong. Returns the length written. Test: 40_io "messages". */
MPM_API size_t mpm_io_fault_text(char *buffer, size_t n, const mpm_fault *fault);

/* Writes `value` into buffer[n] (32 bytes always suffice) with the fewest of 15 to 17 digits that
   bring it back exactly, and a decimal point under every locale. Not finite: "nan", "inf" or
   "-inf". Returns the length written. Test: 40_io "numbers". */
MPM_API size_t mpm_io_number_text(char *buffer, size_t n, double value);

/* Puts a point where printf put the decimal separator of the locale, whatever its bytes: between the
   digits of a printed number there is nothing else. Test: 40_io "numbers". */
MPM_API void mpm_io_decimal_point(char *text);

/* Where a run stands. Counts are of this run: after a restart set first_step. */
typedef struct mpm_io_progress {
    int64_t step, first_step, steps; /* steps done, done before this run, and planned in all */
    double time;                  /* model time, printed as given ... */
    const char *time_unit;        /* ... with this unit; NULL leaves it out */
    double points;                /* points moved in one step */
    double elapsed;               /* seconds since first_step */
} mpm_io_progress;

/* Writes "step 1200/9900  12 %  t = 9.7 ns  1.2e6 points/s  left 0:43" into buffer[n]. The rate and
   the time left appear once a step is done and time has passed. Returns the length written.
   Test: 40_io "messages". */
MPM_API size_t mpm_io_progress_text(char *buffer, size_t n, const mpm_io_progress *p);

/* ---- folders and files --------------------------------------------------------------------- */

/* Makes the folder `path` and every missing folder above it. One that exists is fine.
   Returns MPM_ERR_FILE when it cannot be made (or a file is in its place), MPM_ERR_ARGUMENT for an
   empty path, MPM_ERR_MEMORY. On Windows "\\" parts folders too, and "C:" is a drive; elsewhere both are
   letters like others. `fault` may be NULL here and below. Test: 40_io "folders". */
MPM_API mpm_status mpm_io_make_directory(const char *path, mpm_fault *fault);

/* A file being written: what all formats below are made of, and yours. */
typedef struct mpm_io_file {
    FILE *stream; /* of the temporary file; NULL if it could not be opened */
    char *path;   /* the final name; behind its zero the temporary one. Freed by close and drop */
} mpm_io_file;

/* Begins a file: it must be closed or dropped. MPM_ERR_FILE: it cannot be made; MPM_ERR_ARGUMENT: no path;
   MPM_ERR_MEMORY. Test: 40_io "failures", "format". */
MPM_API mpm_status mpm_io_open(mpm_io_file *f, const char *path, mpm_fault *fault);
/* Adds text, bytes, a number of double precision, an mpm_real or a whole number to it, numbers with
   the fewest digits that bring them back; nothing happens if the file is not open. No checking is
   needed in between: an error sticks, and mpm_io_close finds it. Test: 40_io "format". */
MPM_API void mpm_io_put(mpm_io_file *f, const char *text);
MPM_API void mpm_io_put_bytes(mpm_io_file *f, const void *data, size_t n);
MPM_API void mpm_io_put_number(mpm_io_file *f, double value);
MPM_API void mpm_io_put_real(mpm_io_file *f, mpm_real value);
MPM_API void mpm_io_put_integer(mpm_io_file *f, long long value);
/* Gives the file its name. MPM_ERR_FILE when it is not open or any write failed: then nothing of it
   is left, and a file that had the name before is as it was. Test: 40_io "format". */
MPM_API mpm_status mpm_io_close(mpm_io_file *f, mpm_fault *fault);
/* Instead of close: gives the file up. Test: 40_io "format". */
MPM_API void mpm_io_drop(mpm_io_file *f);

/* ---- JSON ---------------------------------------------------------------------------------- */

/* One JSON object in a file. The calls between begin and end need no checking: an error sticks
   and end returns it. Objects may be nested with open/close. */
typedef struct mpm_io_json {
    mpm_io_file file;
    int depth;         /* open objects */
    int empty;         /* nothing yet in the innermost object */
    mpm_status status; /* first thing that went wrong */
} mpm_io_json;

/* Starts an object whose first key is "mpm_version". Returns MPM_ERR_FILE when the file cannot be
   made, MPM_ERR_ARGUMENT for a bad path. Test: 40_io "json". */
MPM_API mpm_status mpm_io_json_begin(mpm_io_json *j, const char *path, mpm_fault *fault);
/* key: value. A number that is not finite becomes null; others get the digits that a double needs.
   Test: 40_io "json". */
MPM_API void mpm_io_json_number(mpm_io_json *j, const char *key, double value);
MPM_API void mpm_io_json_integer(mpm_io_json *j, const char *key, long long value);
MPM_API void mpm_io_json_bool(mpm_io_json *j, const char *key, int value);
MPM_API void mpm_io_json_string(mpm_io_json *j, const char *key, const char *value);
/* key: { ... } - the pairs between open and close belong to the inner object. Test: 40_io "json". */
MPM_API void mpm_io_json_open(mpm_io_json *j, const char *key);
MPM_API void mpm_io_json_close(mpm_io_json *j);
/* Closes the object and gives the file its name. MPM_ERR_FILE when any write failed, MPM_ERR_ARGUMENT when open and
   close did not match: then there is no file. After a begin that failed: its status again, and the fault stays as
   begin left it, so that one check, here, tells why. Test: 40_io "json", "failures". */
MPM_API mpm_status mpm_io_json_end(mpm_io_json *j, mpm_fault *fault);

/* ---- CSV ----------------------------------------------------------------------------------- */

/* A table with a header line. Errors stick, as with JSON. */
typedef struct mpm_io_csv {
    mpm_io_file file;
    int columns;       /* as counted in the header */
    int cells;         /* written in the present row; the last one of a row ends the line */
    mpm_status status; /* of begin: what end returns if that failed */
} mpm_io_csv;

/* Starts a table. `columns` is the header line: names with commas between. A note other than NULL
   comes first, as a line "# mpm.h <version>: <note>". Errors as for JSON. Test: 40_io "csv". */
MPM_API mpm_status mpm_io_csv_begin(mpm_io_csv *t, const char *path, const char *columns,
                                    const char *note, mpm_fault *fault);
/* The next cell: a number (not finite: nan, inf, -inf), a whole number, or text (quoted when it
   has to be). After the last column the line ends by itself. Test: 40_io "csv". */
MPM_API void mpm_io_csv_real(mpm_io_csv *t, mpm_real value);
MPM_API void mpm_io_csv_integer(mpm_io_csv *t, long long value);
MPM_API void mpm_io_csv_text(mpm_io_csv *t, const char *value);
/* A whole row at once: values[columns]. Test: 40_io "csv". */
MPM_API void mpm_io_csv_row(mpm_io_csv *t, const mpm_real *values);
/* Gives the file its name. MPM_ERR_FILE when a write failed, MPM_ERR_ARGUMENT when the last row is
   not full: then there is no file. After a begin that failed as with JSON. Test: 40_io "csv", "failures". */
MPM_API mpm_status mpm_io_csv_end(mpm_io_csv *t, mpm_fault *fault);
/* Instead of end: gives the table up, even in the middle of a row or after an error. What is written so
   far is removed; a file that had the name before stays as it was. Test: 40_io "dropped". */
MPM_API void mpm_io_csv_drop(mpm_io_csv *t);

/* ---- ParaView ------------------------------------------------------------------------------ */

/* One named quantity at every point, as plain arrays. Set either data[] or one of the whole-number
   pointers. Of six components the order here is that of mpm.h, xx yy zz yz xz xy; the file gets
   the XX YY ZZ XY YZ XZ that ParaView expects. */
typedef struct mpm_io_field {
    const char *name;         /* as shown in ParaView */
    int components;           /* 1 .. 9; 3 is a vector, 6 a symmetric tensor */
    const mpm_real *data[9];  /* one array of `count` values per component */
    double scale; /* multiplies on output, for a change of units; 1 leaves the bits alone */
    const uint8_t *bytes;     /* one component of flags or small numbers, or NULL */
    const int32_t *integers;  /* one component of ids or body numbers, or NULL */
} mpm_io_field;

/* Fields from their arrays. Test: 40_io "vtu". */
MPM_API mpm_io_field mpm_io_scalar(const char *name, const mpm_real *data, double scale);
MPM_API mpm_io_field mpm_io_vector(const char *name, const mpm_real *x, const mpm_real *y,
                                   const mpm_real *z, double scale);
MPM_API mpm_io_field mpm_io_tensor(const char *name, const mpm_real *xx, const mpm_real *yy,
                                   const mpm_real *zz, const mpm_real *yz, const mpm_real *xz,
                                   const mpm_real *xy, double scale);
MPM_API mpm_io_field mpm_io_uint8(const char *name, const uint8_t *bytes);
MPM_API mpm_io_field mpm_io_int32(const char *name, const int32_t *integers);

/* Points and what to write of them. */
typedef struct mpm_io_vtu_desc {
    unsigned mark;              /* set by mpm_io_vtu_desc_default */
    size_t count;               /* points, at most 2^31 - 1 */
    const mpm_real *x[3];       /* positions [length]; a NULL axis is written as zero */
    double scale;               /* of positions */
    const mpm_io_field *fields; /* field_count of them */
    int field_count;
    double time;                /* stored as TimeValue */
    int float32;                /* 1: reals as Float32, half the size; 0: as mpm_real */
    const char *note;           /* kept in a comment: what made this file; or NULL */
    size_t cell_count;          /* lines or triangles that join points: surfaces */
    int cell_points;            /* of each: 2 or 3 */
    const int32_t *cells;       /* numbers of their points, cell by cell; NULL: the points stand alone, a vertex each */
} mpm_io_vtu_desc;

/* No points, no fields, scale 1, time 0. Test: 40_io "vtu". */
MPM_API mpm_io_vtu_desc mpm_io_vtu_desc_default(void);

/* Writes a VTK XML UnstructuredGrid (.vtu) of one vertex per point, or of lines or triangles between them, data
   appended raw. MPM_ERR_ARGUMENT for a field without data, name or components, or a cell of a point that is not there;
   MPM_ERR_FILE. Test: 40_io "vtu". */
MPM_API mpm_status mpm_io_vtu(const char *path, const mpm_io_vtu_desc *d, mpm_fault *fault);

/* numbers[world->points.count]: the body of each point, -1 where it is retired. Test: 40_io "vtu". */
MPM_API void mpm_io_body_numbers(const mpm_world *world, int32_t *numbers);

/* A time series (.pvd): begin writes an empty one, add appends a frame, given as the name of its
   .vtu relative to the folder of the .pvd. The file is complete after every call. A frame of the
   same name is replaced, so that a restarted run may go on with the series it finds; a missing
   .pvd is begun. MPM_ERR_FILE when it cannot be written or is not one of ours. Test: 40_io "pvd". */
MPM_API mpm_status mpm_io_pvd_begin(const char *path, mpm_fault *fault);
MPM_API mpm_status mpm_io_pvd_add(const char *path, const char *frame, double time,
                                  mpm_fault *fault);

/* ---- checkpoints --------------------------------------------------------------------------- */

/* A checkpoint holds blobs (mpm.h) and, as lines of text, what they are of: whatever must be the same for a run
   that goes on from them. The head of the file can be read with any viewer of text.

   Writes text (NULL: none) and blob[count] with version, real size, byte order and a CRC-32 over
   everything, so that a restart is bitwise. MPM_ERR_FILE, MPM_ERR_ARGUMENT. Test: 40_io "checkpoint". */
MPM_API mpm_status mpm_io_checkpoint_write(const char *path, const char *text, const mpm_blob *blob, int count,
                                           mpm_fault *fault);
/* Reads them back: the same names in the same order, of sizes that fit. All is verified before the first byte is
   changed; what the numbers say is for mpm_restored, mpm_spray_restored to check.
   MPM_ERR_VERSION: by another version of mpm.h, real type or byte order, or of another text: then fault.field is
   the first line of yours that the file has not, fault.index its number, from 1.
   MPM_ERR_FILE: missing, damaged, or holding other blobs (the fault tells which). Test: 40_io "checkpoint". */
MPM_API mpm_status mpm_io_checkpoint_read(const char *path, const char *text, mpm_blob *blob, int count,
                                          mpm_fault *fault);
/* How many bytes of each blob are stored, to blob[].bytes, in a file that is verified as for reading: to make room for
   those that grow while a run goes. Errors as there, but for a room that is too small. Test: 40_io "checkpoint". */
MPM_API mpm_status mpm_io_checkpoint_sizes(const char *path, const char *text, mpm_blob *blob, int count,
                                           mpm_fault *fault);

/* A world's description as such a text, into buffer[n], cut to fit: grid, sides, contact rules and bodies, one
   "name value" a line; 1500 bytes, 300 for each rule of mpm_contact_set and 900 for each body suffice. Materials are
   known to you alone: add lines of theirs, and of the time step, behind the length that is returned.
   Test: 40_io "restart", "room". */
MPM_API size_t mpm_io_world_text(char *buffer, size_t n, const mpm_world *world);

/* Adds a line "name value" behind the `used` characters in buffer[n], cut to fit. Returns the new length.
   Test: 40_io "checkpoint". */
MPM_API size_t mpm_io_line(char *buffer, size_t n, size_t used, const char *name, const char *value);
MPM_API size_t mpm_io_line_number(char *buffer, size_t n, size_t used, const char *name, double value);

/* ---- PNG ----------------------------------------------------------------------------------- */

/* Writes pixels as PNG: 3 width height bytes, red green blue, row by row from the top; `note` (or NULL) is
   kept in it as its description (iTXt, UTF-8). MPM_ERR_ARGUMENT without pixels and for sizes out of range
   (1 .. 16384 each), MPM_ERR_FILE, MPM_ERR_MEMORY. Test: 40_io "png". */
MPM_API mpm_status mpm_io_png(const char *path, const unsigned char *pixels, int width, int height,
                              const char *note, mpm_fault *fault);

/* A film: pictures of one size, one after the other for ever, in a PNG that browsers show (APNG). Other programs show
   the first of them. */
typedef struct mpm_io_film {
    mpm_io_file file;
    double seconds;    /* that the next picture is shown, in thousandths, at most 60; change at will */
    const char *note;  /* as for a picture; until the first one is there */
    int width, height; /* of the first picture */
    int pictures;      /* so far */
    uint32_t chunks;   /* ... with a number */
    long place;        /* of the number of pictures in the file */
    mpm_status status; /* first thing that went wrong */
} mpm_io_film;

/* Begins a film: it must be ended. MPM_ERR_FILE, MPM_ERR_ARGUMENT, MPM_ERR_MEMORY. Test: 40_io "film". */
MPM_API mpm_status mpm_io_film_begin(mpm_io_film *f, const char *path, double seconds, const char *note,
                                     mpm_fault *fault);
/* The next picture: pixels as for mpm_io_png, or a file of it. MPM_ERR_ARGUMENT: without pixels, of a size out of
   range, of another size than the first; MPM_ERR_FILE: not written by mpm_io_png, or damaged; MPM_ERR_MEMORY. An error
   sticks. Test: 40_io "film". */
MPM_API mpm_status mpm_io_film_add(mpm_io_film *f, const unsigned char *pixels, int width, int height,
                                   mpm_fault *fault);
MPM_API mpm_status mpm_io_film_add_png(mpm_io_film *f, const char *path, mpm_fault *fault);
/* Gives the film its name. After an error, and without pictures (MPM_ERR_ARGUMENT), there is none, and a file that had
   the name before is as it was; the fault stays as the error left it. Test: 40_io "film". */
MPM_API mpm_status mpm_io_film_end(mpm_io_film *f, mpm_fault *fault);

#ifdef __cplusplus
}
#endif
#endif /* MPM_IO_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__IO_IMPLEMENTED)
#define MPM__IO_IMPLEMENTED

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* C99 can neither make a folder, nor open a file only if it is new, nor wait for the disk, nor replace a file: these
   are the only lines that know the system. */
#if defined(_WIN32)
#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#define MPM__IO_PARTS "/\\" /* what parts folders */
static inline int mpm__io_mkdir(const char *path)
{
    const size_t n = strlen(path);
    struct stat found;
    if (path[n - 1] == ':') return n == 2; /* a drive; elsewhere a colon would name a stream of a file */
    return _mkdir(path) == 0 || (stat(path, &found) == 0 && (found.st_mode & S_IFDIR));
}

static inline FILE *mpm__io_create(const char *path)
{
    const int file = _open(path, _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
    return file < 0 ? NULL : _fdopen(file, "wb");
}

static inline int mpm__io_reach_disk(const char *path)
{
    const int file = _open(path, _O_WRONLY | _O_BINARY), good = file >= 0 && _commit(file) == 0;
    return file >= 0 && _close(file) == 0 && good;
}

/* rename does not replace there. Declared as windows.h has it, whose macros are no business of who includes this. */
#ifdef __cplusplus
extern "C"
#endif
__declspec(dllimport) int __stdcall MoveFileExA(const char *from, const char *to, unsigned long flags);

static inline int mpm__io_replace(const char *from, const char *to)
{
    const unsigned long replace_existing = 1;
    return MoveFileExA(from, to, replace_existing) != 0;
}
#elif defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>
#define MPM__IO_PARTS "/"
static inline int mpm__io_mkdir(const char *path)
{
    struct stat found;
    return mkdir(path, 0777) == 0 || (stat(path, &found) == 0 && S_ISDIR(found.st_mode));
}

/* x: fails if anything has that name, a link that leads nowhere and a FIFO included. */
static inline FILE *mpm__io_create(const char *path) { return fopen(path, "wbx"); }

/* EINVAL: the file system has no such thing. */
static inline int mpm__io_reach_disk(const char *path)
{
    const int file = open(path, O_WRONLY), good = file >= 0 && (fsync(file) == 0 || errno == EINVAL);
    return file >= 0 && close(file) == 0 && good;
}

/* Gives a file the name of another, which it replaces at once: there is always one of the two. */
static inline int mpm__io_replace(const char *from, const char *to) { return rename(from, to) == 0; }
#else
#define MPM__IO_PARTS "/"
static inline int mpm__io_mkdir(const char *path) { return (void)path, 0; }
static inline FILE *mpm__io_create(const char *path) { return fopen(path, "wbx"); } /* C11 */
static inline int mpm__io_reach_disk(const char *path) { return (void)path, 1; }
static inline int mpm__io_replace(const char *from, const char *to) { return rename(from, to) == 0; }
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- messages ------------------------------------------------------------------------------ */

MPM_API void mpm_io_decimal_point(char *text)
{
    char *from = text;
    size_t length;
    while (*from && strchr("+-0123456789", *from)) from++;
    if (*from == 0 || strchr("eE.", *from)) return;
    length = strcspn(from, "0123456789eE");
    *from = '.';
    memmove(from + 1, from + length, strlen(from + length) + 1);
}

/* The fewest digits, of most - 2 to most, that read back as the same double or float. */
static inline size_t mpm__io_print(char *buffer, size_t n, double value, int most, int single)
{
    char text[64];
    int digits;
    if (value != value) return mpm_append(buffer, n, 0, "nan");
    if (value - value != 0) return mpm_append(buffer, n, 0, value > 0 ? "inf" : "-inf");
    for (digits = most - (single ? 3 : 2); digits <= most; digits++) {
        double back;
        snprintf(text, sizeof text, "%.*g", digits, value);
        back = strtod(text, NULL); /* same locale as snprintf */
        if (single ? (float)back == (float)value : back >= value && back <= value) break;
    }
    mpm_io_decimal_point(text);
    return mpm_append(buffer, n, 0, text);
}

MPM_API size_t mpm_io_number_text(char *buffer, size_t n, double value)
{
    return mpm__io_print(buffer, n, value, 17, 0);
}

/* The same for an mpm_real, with its MPM_DIGITS. */
static inline size_t mpm__io_print_real(char *buffer, size_t n, mpm_real value)
{
    return mpm__io_print(buffer, n, (double)value, MPM_DIGITS, sizeof(mpm_real) == sizeof(float));
}

/* A number for people: `digits` significant digits, "1.2e6" rather than "1.2e+06". */
static inline void mpm__io_short(char *buffer, size_t n, double value, int digits)
{
    char text[64], *e;
    snprintf(text, sizeof text, "%.*g", digits, value);
    if (value - value == 0) mpm_io_decimal_point(text);
    e = strchr(text, 'e');
    if (e && value - value == 0) {
        long power = strtol(e + 1, NULL, 10);
        snprintf(e + 1, sizeof text - (size_t)(e + 1 - text), "%ld", power);
    }
    mpm_append(buffer, n, 0, text);
}

MPM_API size_t mpm_io_fault_text(char *buffer, size_t n, const mpm_fault *fault)
{
    char number[40];
    size_t used = mpm_append(buffer, n, 0, mpm_status_text(fault->status)), room;
    if (fault->field) {
        used = mpm_append(buffer, n, used, ": ");
        room = used + strcspn(fault->field, "\n") + 1; /* a line of a text ends there */
        used = mpm_append(buffer, room < n ? room : n, used, fault->field);
        if (fault->status != MPM_ERR_FILE && fault->status != MPM_ERR_VERSION) {
            mpm__io_print_real(number, sizeof number, fault->value);
            used = mpm_append(buffer, n, used, " = ");
            used = mpm_append(buffer, n, used, number);
        }
    }
    if (fault->index >= 0) {
        snprintf(number, sizeof number, " (index %lld)", (long long)fault->index);
        used = mpm_append(buffer, n, used, number);
    }
    return used;
}

/* Seconds as m:ss or h:mm:ss, from 0 to 1e8. */
static inline void mpm__io_clock(char *buffer, size_t n, double seconds)
{
    const long s = !(seconds > 0) ? 0 : seconds < 1e8 ? (long)(seconds + 0.5) : 100000000L;
    if (s < 3600) snprintf(buffer, n, "%ld:%02ld", s / 60, s % 60);
    else snprintf(buffer, n, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

/* How much of the steps is done, %: 0 .. 100 whatever the counts. */
static inline int mpm__io_percent(const mpm_io_progress *p)
{
    const double part = p->steps > 0 ? 100.0 * (double)p->step / (double)p->steps : 0;
    return part > 100 ? 100 : part > 0 ? (int)part : 0;
}

MPM_API size_t mpm_io_progress_text(char *buffer, size_t n, const mpm_io_progress *p)
{
    char text[96], number[40];
    double done = (double)p->step - (double)p->first_step;
    size_t used;
    snprintf(text, sizeof text, "step %lld/%lld  %d %%", (long long)p->step, (long long)p->steps, mpm__io_percent(p));
    used = mpm_append(buffer, n, 0, text);
    if (p->time_unit) {
        mpm__io_short(number, sizeof number, p->time, 4);
        used = mpm_append(buffer, n, used, "  t = ");
        used = mpm_append(buffer, n, used, number);
        used = mpm_append(buffer, n, used, " ");
        used = mpm_append(buffer, n, used, p->time_unit);
    }
    if (done > 0 && p->elapsed > 0) {
        mpm__io_short(number, sizeof number, p->points * done / p->elapsed, 2);
        used = mpm_append(buffer, n, used, "  ");
        used = mpm_append(buffer, n, used, number);
        used = mpm_append(buffer, n, used, " points/s  left ");
        mpm__io_clock(number, sizeof number, p->elapsed * ((double)p->steps - (double)p->step) / done);
        used = mpm_append(buffer, n, used, number);
    }
    return used;
}

/* ---- folders and files --------------------------------------------------------------------- */

MPM_API mpm_status mpm_io_make_directory(const char *path, mpm_fault *fault)
{
    const size_t length = path ? strlen(path) : 0;
    char *part;
    size_t i;
    int good = 1;
    if (length == 0) return mpm_fail(fault, MPM_ERR_ARGUMENT, "length of folder path", 0, -1);
    part = (char *)MPM_MALLOC(length + 1);
    if (!part) return mpm_fail(fault, MPM_ERR_MEMORY, "bytes for folder path", (mpm_real)length, -1);
    for (i = 1; i <= length && good; i++) {
        if (path[i] != 0 && !strchr(MPM__IO_PARTS, path[i])) continue;
        memcpy(part, path, i);
        part[i] = 0;
        good = mpm__io_mkdir(part);
    }
    MPM_FREE(part);
    return good ? MPM_OK : mpm_fail(fault, MPM_ERR_FILE, "folder path", 0, -1);
}

#define MPM__IO_PART 15 /* bytes of ".01234567.part" */

/* The name a file has until it is complete. */
static inline char *mpm__io_part(const mpm_io_file *f) { return f->path + strlen(f->path) + 1; }

/* Opens a new file beside the final one. Each try has another name, in which time and address keep apart those
   who write the same file at once. */
static inline FILE *mpm__io_open_part(const mpm_io_file *f)
{
    uint64_t mix = (uint64_t)time(NULL) ^ (uint64_t)clock() << 20 ^ (uint64_t)(uintptr_t)f->path;
    char *part = mpm__io_part(f);
    const size_t at = mpm_append(part, strlen(f->path) + 1, 0, f->path);
    FILE *stream = NULL;
    int tries;
    for (tries = 0; tries < 100 && !stream; tries++) {
        mix = mix * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        snprintf(part + at, MPM__IO_PART, ".%08lx.part", (unsigned long)(mix >> 32));
        stream = mpm__io_create(part);
        if (!stream && errno != EEXIST) break;
    }
    return stream;
}

/* Gives name and stream up. */
static inline void mpm__io_forget(mpm_io_file *f)
{
    MPM_FREE(f->path);
    f->stream = NULL;
    f->path = NULL;
}

MPM_API mpm_status mpm_io_open(mpm_io_file *f, const char *path, mpm_fault *fault)
{
    const size_t length = path ? strlen(path) : 0, bytes = 2 * length + 1 + MPM__IO_PART;
    f->stream = NULL;
    f->path = NULL;
    if (length == 0) return mpm_fail(fault, MPM_ERR_ARGUMENT, "length of path", 0, -1);
    f->path = (char *)MPM_MALLOC(bytes);
    if (!f->path) return mpm_fail(fault, MPM_ERR_MEMORY, "bytes for path", (mpm_real)bytes, -1);
    memcpy(f->path, path, length + 1);
    f->stream = mpm__io_open_part(f);
    if (f->stream) return MPM_OK;
    mpm__io_forget(f);
    return mpm_fail(fault, MPM_ERR_FILE, "path: cannot be made", 0, -1);
}

MPM_API mpm_status mpm_io_close(mpm_io_file *f, mpm_fault *fault)
{
    const char *part;
    int good, named;
    if (!f->stream) return mpm_fail(fault, MPM_ERR_FILE, "path: not open", 0, -1);
    part = mpm__io_part(f);
    good = fflush(f->stream) == 0 && !ferror(f->stream);
    good = fclose(f->stream) == 0 && good;
    good = good && mpm__io_reach_disk(part);
    named = good && mpm__io_replace(part, f->path);
    if (!named) remove(part);
    mpm__io_forget(f);
    if (named) return MPM_OK;
    return mpm_fail(fault, MPM_ERR_FILE, good ? "path: cannot be renamed" : "path: writing failed", 0, -1);
}

MPM_API void mpm_io_drop(mpm_io_file *f)
{
    if (!f->stream) return;
    fclose(f->stream);
    remove(mpm__io_part(f));
    mpm__io_forget(f);
}

MPM_API void mpm_io_put(mpm_io_file *f, const char *text)
{
    if (f->stream && text) fputs(text, f->stream);
}

MPM_API void mpm_io_put_bytes(mpm_io_file *f, const void *data, size_t n)
{
    if (f->stream && n > 0) fwrite(data, 1, n, f->stream);
}

MPM_API void mpm_io_put_number(mpm_io_file *f, double value)
{
    char text[40];
    mpm_io_number_text(text, sizeof text, value);
    mpm_io_put(f, text);
}

MPM_API void mpm_io_put_real(mpm_io_file *f, mpm_real value)
{
    char text[40];
    mpm__io_print_real(text, sizeof text, value);
    mpm_io_put(f, text);
}

MPM_API void mpm_io_put_integer(mpm_io_file *f, long long value)
{
    char text[40];
    snprintf(text, sizeof text, "%lld", value);
    mpm_io_put(f, text);
}

/* ---- characters ---------------------------------------------------------------------------- */

/* The bytes of the UTF-8 character at p, 1 .. 4 (RFC 3629: no longer than need be, no surrogates); 0 if there is
   none. */
static inline size_t mpm__io_utf8(const char *p)
{
    const unsigned char *c = (const unsigned char *)p;
    const size_t n = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : c[0] < 0xf5 ? 4 : 0;
    size_t i;
    for (i = 1; i < n; i++)
        if ((c[i] & 0xc0) != 0x80) return 0;
    if ((c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] > 0x9f)) return 0;
    if ((c[0] == 0xf0 && c[1] < 0x90) || (c[0] == 0xf4 && c[1] > 0x8f)) return 0;
    return n;
}

#define MPM__IO_UNKNOWN "\xef\xbf\xbd" /* U+FFFD stands for what is no character */

/* The next character of a text, *n bytes; moves the text past it. */
static inline const char *mpm__io_character(const char **text, size_t *n)
{
    const char *c = *text;
    *n = mpm__io_utf8(c);
    *text += *n ? *n : 1;
    if (*n) return c;
    *n = 3;
    return MPM__IO_UNKNOWN;
}

/* ---- JSON ---------------------------------------------------------------------------------- */

/* A JSON string: quotes, backslashes and control characters escaped. */
static inline void mpm__io_json_quoted(mpm_io_json *j, const char *text)
{
    char escape[8];
    size_t n;
    mpm_io_put(&j->file, "\"");
    while (*text) {
        const char *c = mpm__io_character(&text, &n);
        if (*c == '"' || *c == '\\') mpm_io_put(&j->file, "\\");
        if (n > 1 || (unsigned char)*c >= 32) mpm_io_put_bytes(&j->file, c, n);
        else {
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)*c);
            mpm_io_put(&j->file, escape);
        }
    }
    mpm_io_put(&j->file, "\"");
}

/* Comma, new line, indentation and the key of the next pair. */
static inline void mpm__io_json_key(mpm_io_json *j, const char *key)
{
    int i;
    mpm_io_put(&j->file, j->empty ? "\n" : ",\n");
    for (i = 0; i < j->depth; i++) mpm_io_put(&j->file, "  ");
    mpm__io_json_quoted(j, key ? key : "");
    mpm_io_put(&j->file, ": ");
    j->empty = 0;
}

MPM_API mpm_status mpm_io_json_begin(mpm_io_json *j, const char *path, mpm_fault *fault)
{
    j->depth = 1;
    j->empty = 1;
    j->status = mpm_io_open(&j->file, path, fault);
    if (j->status < 0) return j->status;
    mpm_io_put(&j->file, "{");
    mpm_io_json_string(j, "mpm_version", MPM_VERSION);
    return MPM_OK;
}

MPM_API void mpm_io_json_number(mpm_io_json *j, const char *key, double value)
{
    mpm__io_json_key(j, key);
    if (value - value != 0) mpm_io_put(&j->file, "null");
    else mpm_io_put_number(&j->file, value);
}

MPM_API void mpm_io_json_integer(mpm_io_json *j, const char *key, long long value)
{
    mpm__io_json_key(j, key);
    mpm_io_put_integer(&j->file, value);
}

MPM_API void mpm_io_json_bool(mpm_io_json *j, const char *key, int value)
{
    mpm__io_json_key(j, key);
    mpm_io_put(&j->file, value ? "true" : "false");
}

MPM_API void mpm_io_json_string(mpm_io_json *j, const char *key, const char *value)
{
    mpm__io_json_key(j, key);
    if (value) mpm__io_json_quoted(j, value);
    else mpm_io_put(&j->file, "null");
}

MPM_API void mpm_io_json_open(mpm_io_json *j, const char *key)
{
    mpm__io_json_key(j, key);
    mpm_io_put(&j->file, "{");
    j->empty = 1;
    j->depth++;
}

MPM_API void mpm_io_json_close(mpm_io_json *j)
{
    int i;
    if (--j->depth < 1 && j->status == MPM_OK) j->status = MPM_ERR_ARGUMENT;
    mpm_io_put(&j->file, j->empty ? "" : "\n");
    for (i = 0; i < j->depth && !j->empty; i++) mpm_io_put(&j->file, "  ");
    mpm_io_put(&j->file, "}");
    j->empty = 0;
}

MPM_API mpm_status mpm_io_json_end(mpm_io_json *j, mpm_fault *fault)
{
    if (!j->file.stream && j->status < 0) return j->status;
    if (j->file.stream && (j->status < 0 || j->depth != 1)) {
        j->status = MPM_ERR_ARGUMENT;
        mpm_io_drop(&j->file);
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "depth of json object", (mpm_real)j->depth, -1);
    }
    mpm_io_put(&j->file, "\n}\n");
    return mpm_io_close(&j->file, fault);
}

/* ---- CSV ----------------------------------------------------------------------------------- */

MPM_API mpm_status mpm_io_csv_begin(mpm_io_csv *t, const char *path, const char *columns,
                                    const char *note, mpm_fault *fault)
{
    const char *p;
    t->columns = 1;
    t->cells = 0;
    t->file.stream = NULL;
    if (!columns) return t->status = mpm_fail(fault, MPM_ERR_ARGUMENT, "columns", 0, -1);
    t->status = mpm_io_open(&t->file, path, fault);
    if (t->status < 0) return t->status;
    for (p = columns; *p; p++) t->columns += *p == ',';
    if (note) {
        mpm_io_put(&t->file, "# mpm.h " MPM_VERSION ": ");
        for (p = note; *p; p++) fputc(strchr("\n\r", *p) ? ' ' : *p, t->file.stream);
        mpm_io_put(&t->file, "\n");
    }
    mpm_io_put(&t->file, columns);
    mpm_io_put(&t->file, "\n");
    return MPM_OK;
}

static inline void mpm__io_csv_cell(mpm_io_csv *t, const char *text)
{
    mpm_io_put(&t->file, text);
    t->cells = (t->cells + 1) % t->columns;
    mpm_io_put(&t->file, t->cells == 0 ? "\n" : ",");
}

MPM_API void mpm_io_csv_real(mpm_io_csv *t, mpm_real value)
{
    mpm_io_put_real(&t->file, value);
    mpm__io_csv_cell(t, "");
}

MPM_API void mpm_io_csv_integer(mpm_io_csv *t, long long value)
{
    mpm_io_put_integer(&t->file, value);
    mpm__io_csv_cell(t, "");
}

MPM_API void mpm_io_csv_text(mpm_io_csv *t, const char *value)
{
    int quote = value && strpbrk(value, ",\"\r\n") != NULL;
    if (quote) mpm_io_put(&t->file, "\"");
    for (; value && *value && t->file.stream; value++) {
        if (*value == '"') fputc('"', t->file.stream);
        fputc(*value, t->file.stream);
    }
    mpm__io_csv_cell(t, quote ? "\"" : "");
}

MPM_API void mpm_io_csv_row(mpm_io_csv *t, const mpm_real *values)
{
    int i;
    for (i = 0; i < t->columns; i++) mpm_io_csv_real(t, values[i]);
}

MPM_API mpm_status mpm_io_csv_end(mpm_io_csv *t, mpm_fault *fault)
{
    if (t->status < 0) return t->status;
    if (t->file.stream && t->cells != 0) {
        mpm_io_drop(&t->file);
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "cells in the last row", (mpm_real)t->cells, -1);
    }
    return mpm_io_close(&t->file, fault);
}

MPM_API void mpm_io_csv_drop(mpm_io_csv *t) { mpm_io_drop(&t->file); }

/* ---- ParaView ------------------------------------------------------------------------------ */

static inline mpm_io_field mpm__io_field_named(const char *name, int components, double scale)
{
    mpm_io_field f;
    memset(&f, 0, sizeof f);
    f.name = name;
    f.components = components;
    f.scale = scale;
    return f;
}

MPM_API mpm_io_field mpm_io_scalar(const char *name, const mpm_real *data, double scale)
{
    mpm_io_field f = mpm__io_field_named(name, 1, scale);
    f.data[0] = data;
    return f;
}

MPM_API mpm_io_field mpm_io_vector(const char *name, const mpm_real *x, const mpm_real *y,
                                   const mpm_real *z, double scale)
{
    mpm_io_field f = mpm__io_field_named(name, 3, scale);
    f.data[0] = x;
    f.data[1] = y;
    f.data[2] = z;
    return f;
}

MPM_API mpm_io_field mpm_io_tensor(const char *name, const mpm_real *xx, const mpm_real *yy,
                                   const mpm_real *zz, const mpm_real *yz, const mpm_real *xz,
                                   const mpm_real *xy, double scale)
{
    mpm_io_field f = mpm__io_field_named(name, 6, scale);
    f.data[0] = xx;
    f.data[1] = yy;
    f.data[2] = zz;
    f.data[3] = yz;
    f.data[4] = xz;
    f.data[5] = xy;
    return f;
}

MPM_API mpm_io_field mpm_io_uint8(const char *name, const uint8_t *bytes)
{
    mpm_io_field f = mpm__io_field_named(name, 1, 1.0);
    f.bytes = bytes;
    return f;
}

MPM_API mpm_io_field mpm_io_int32(const char *name, const int32_t *integers)
{
    mpm_io_field f = mpm__io_field_named(name, 1, 1.0);
    f.integers = integers;
    return f;
}

MPM_API mpm_io_vtu_desc mpm_io_vtu_desc_default(void)
{
    mpm_io_vtu_desc d;
    memset(&d, 0, sizeof d);
    d.scale = 1;
    d.mark = MPM_MARK;
    return d;
}

/* Whether XML has the character: no control character but tab and ends of line, not U+FFFE and U+FFFF. */
static inline int mpm__io_xml_has(const char *c, size_t n)
{
    if (n == 3 && (memcmp(c, "\xef\xbf\xbe", 3) == 0 || memcmp(c, "\xef\xbf\xbf", 3) == 0)) return 0;
    return n > 1 || (unsigned char)*c >= 32 || strchr("\t\n\r", *c) != NULL;
}

/* XML text: the five reserved characters escaped, "--" broken up so that a comment stays one. */
static inline void mpm__io_put_xml(mpm_io_file *f, const char *text)
{
    size_t n;
    while (*text) {
        const char *c = mpm__io_character(&text, &n);
        switch (*c) {
        case '&': mpm_io_put(f, "&amp;"); break;
        case '<': mpm_io_put(f, "&lt;"); break;
        case '>': mpm_io_put(f, "&gt;"); break;
        case '"': mpm_io_put(f, "&quot;"); break;
        case '\'': mpm_io_put(f, "&apos;"); break;
        case '-': mpm_io_put(f, *text == '-' ? "- " : "-"); break;
        default:
            if (mpm__io_xml_has(c, n)) mpm_io_put_bytes(f, c, n);
            else mpm_io_put(f, MPM__IO_UNKNOWN);
        }
    }
}

/* Whether a name can stand in a series as it is. */
static inline int mpm__io_frame_name(const char *name)
{
    size_t n;
    if (!name || !*name) return 0;
    for (; *name; name += n) {
        n = mpm__io_utf8(name);
        if (n == 0 || !mpm__io_xml_has(name, n)) return 0;
        if (n == 1 && ((unsigned char)*name < 32 || strchr("<>&\"'", *name))) return 0;
    }
    return 1;
}

/* One real of a field, converted and scaled, as the bytes of the file. */
static inline void mpm__io_put_real(mpm_io_file *f, mpm_real value, double scale, int float32)
{
    float single;
    if (scale < 1 || scale > 1) value = (mpm_real)((double)value * scale);
    single = (float)value;
    if (float32) mpm_io_put_bytes(f, &single, sizeof single);
    else mpm_io_put_bytes(f, &value, sizeof value);
}

/* The length in bytes of a field's values. */
static inline uint64_t mpm__io_field_bytes(const mpm_io_field *f, size_t count, size_t real)
{
    size_t each = f->bytes ? 1 : f->integers ? 4 : real * (size_t)f->components;
    return (uint64_t)count * each;
}

static inline void mpm__io_field_values(mpm_io_file *file, const mpm_io_field *f, size_t count,
                                        int float32)
{
    static const int order[9] = {0, 1, 2, 5, 3, 4, 6, 7, 8}; /* xy before yz and xz */
    size_t p;
    int k;
    if (f->bytes) mpm_io_put_bytes(file, f->bytes, count);
    else if (f->integers) mpm_io_put_bytes(file, f->integers, 4 * count);
    else
        for (p = 0; p < count; p++)
            for (k = 0; k < f->components; k++) {
                const mpm_real *a = f->data[f->components == 6 ? order[k] : k];
                mpm__io_put_real(file, a ? a[p] : 0, f->scale, float32);
            }
}

/* The tag of one appended array; moves the offset past it. Each array is a 64-bit length and its
   bytes. */
static inline void mpm__io_data_tag(mpm_io_file *f, const char *type, const char *name,
                                    int components, uint64_t bytes, uint64_t *offset)
{
    mpm_io_put(f, "        <DataArray type=\"");
    mpm_io_put(f, type);
    mpm_io_put(f, "\" Name=\"");
    mpm__io_put_xml(f, name);
    mpm_io_put(f, "\" NumberOfComponents=\"");
    mpm_io_put_integer(f, components);
    mpm_io_put(f, "\" format=\"appended\" offset=\"");
    mpm_io_put_integer(f, (long long)*offset);
    mpm_io_put(f, "\"/>\n");
    *offset += 8 + bytes;
}

static inline mpm_status mpm__io_vtu_check(const mpm_io_vtu_desc *d, mpm_fault *fault)
{
    size_t l;
    int i, k;
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_io_vtu_desc_default)", (mpm_real)d->mark, -1);
    if (d->count > 2147483647u)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "count", (mpm_real)d->count, -1);
    if (d->cells && (d->cell_points < 2 || d->cell_points > 3))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "cell_points", (mpm_real)d->cell_points, -1);
    for (l = 0; d->cells && l < d->cell_count * (size_t)d->cell_points; l++)
        if (d->cells[l] < 0 || (size_t)d->cells[l] >= d->count)
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "point of cell", (mpm_real)d->cells[l],
                            (int64_t)(l / (size_t)d->cell_points));
    if (d->field_count < 0 || (d->field_count > 0 && !d->fields))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "field_count", (mpm_real)d->field_count, -1);
    for (i = 0; i < d->field_count; i++) {
        const mpm_io_field *f = &d->fields[i];
        if (!f->name) return mpm_fail(fault, MPM_ERR_ARGUMENT, "name of field", 0, i);
        if (f->components < 1 || f->components > 9)
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "components of field", (mpm_real)f->components, i);
        if ((f->bytes || f->integers) && f->components != 1)
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "components of field", (mpm_real)f->components, i);
        for (k = 0; k < f->components && !f->bytes && !f->integers && d->count > 0; k++)
            if (!f->data[k]) return mpm_fail(fault, MPM_ERR_ARGUMENT, "data of field", (mpm_real)k, i);
    }
    return MPM_OK;
}

static inline int mpm__io_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* Everything of the .vtu before the appended data. */
static inline void mpm__io_vtu_head(mpm_io_file *f, const mpm_io_vtu_desc *d, size_t real)
{
    const char *type = real == 4 ? "Float32" : "Float64";
    uint64_t n = d->count, cells = d->cells ? d->cell_count : d->count, offset = 0;
    int i;
    mpm_io_put(f, "<?xml version=\"1.0\"?>\n<!-- mpm.h " MPM_VERSION " ");
    if (d->note) mpm__io_put_xml(f, d->note);
    mpm_io_put(f, " -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"");
    mpm_io_put(f, mpm__io_little_endian() ? "LittleEndian" : "BigEndian");
    mpm_io_put(f, "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <FieldData>\n"
                   "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\""
                   " format=\"ascii\">");
    mpm_io_put_number(f, d->time);
    mpm_io_put(f, "</DataArray>\n    </FieldData>\n    <Piece NumberOfPoints=\"");
    mpm_io_put_integer(f, (long long)n);
    mpm_io_put(f, "\" NumberOfCells=\"");
    mpm_io_put_integer(f, (long long)cells);
    mpm_io_put(f, "\">\n      <Points>\n");
    mpm__io_data_tag(f, type, "Points", 3, 3 * n * real, &offset);
    mpm_io_put(f, "      </Points>\n      <Cells>\n");
    mpm__io_data_tag(f, "Int32", "connectivity", 1, 4 * cells * (d->cells ? (uint64_t)d->cell_points : 1), &offset);
    mpm__io_data_tag(f, "Int32", "offsets", 1, 4 * cells, &offset);
    mpm__io_data_tag(f, "UInt8", "types", 1, cells, &offset);
    mpm_io_put(f, "      </Cells>\n      <PointData>\n");
    for (i = 0; i < d->field_count; i++) {
        const mpm_io_field *a = &d->fields[i];
        mpm__io_data_tag(f, a->bytes ? "UInt8" : a->integers ? "Int32" : type, a->name,
                         a->components, mpm__io_field_bytes(a, d->count, real), &offset);
    }
    mpm_io_put(f, "      </PointData>\n    </Piece>\n  </UnstructuredGrid>\n"
                   "  <AppendedData encoding=\"raw\">\n_");
}

/* Connectivity, offsets and types: vertices 0 .. n - 1, or lines or triangles. */
static inline void mpm__io_vtu_cells(mpm_io_file *f, const mpm_io_vtu_desc *d)
{
    static const int type[4] = {0, 1, 3, 5}; /* VTK_VERTEX, VTK_LINE, VTK_TRIANGLE */
    const size_t cells = d->cells ? d->cell_count : d->count;
    const int32_t ends = d->cells ? d->cell_points : 1;
    uint64_t bytes = 4 * (uint64_t)cells * (uint64_t)ends;
    int32_t number;
    size_t i;
    mpm_io_put_bytes(f, &bytes, sizeof bytes);
    for (i = 0; i < cells * (size_t)ends; i++) {
        number = d->cells ? d->cells[i] : (int32_t)i;
        mpm_io_put_bytes(f, &number, sizeof number);
    }
    bytes = 4 * (uint64_t)cells;
    mpm_io_put_bytes(f, &bytes, sizeof bytes);
    for (number = ends, i = 0; i < cells; i++, number += ends) mpm_io_put_bytes(f, &number, sizeof number);
    bytes = cells;
    mpm_io_put_bytes(f, &bytes, sizeof bytes);
    for (i = 0; i < cells; i++) fputc(type[ends], f->stream);
}

/* The appended data, in the order of the tags. */
static inline void mpm__io_vtu_body(mpm_io_file *f, const mpm_io_vtu_desc *d, size_t real)
{
    mpm_io_field points = mpm_io_vector("Points", d->x[0], d->x[1], d->x[2], d->scale);
    uint64_t bytes = mpm__io_field_bytes(&points, d->count, real);
    int k;
    mpm_io_put_bytes(f, &bytes, sizeof bytes);
    mpm__io_field_values(f, &points, d->count, d->float32);
    mpm__io_vtu_cells(f, d);
    for (k = 0; k < d->field_count; k++) {
        bytes = mpm__io_field_bytes(&d->fields[k], d->count, real);
        mpm_io_put_bytes(f, &bytes, sizeof bytes);
        mpm__io_field_values(f, &d->fields[k], d->count, d->float32);
    }
}

MPM_API mpm_status mpm_io_vtu(const char *path, const mpm_io_vtu_desc *d, mpm_fault *fault)
{
    mpm_io_file f;
    size_t real = d->float32 ? sizeof(float) : sizeof(mpm_real);
    mpm_status status = mpm__io_vtu_check(d, fault);
    if (status < 0) return status;
    status = mpm_io_open(&f, path, fault);
    if (status < 0) return status;
    mpm__io_vtu_head(&f, d, real);
    mpm__io_vtu_body(&f, d, real);
    mpm_io_put(&f, "\n  </AppendedData>\n</VTKFile>\n");
    return mpm_io_close(&f, fault);
}

MPM_API void mpm_io_body_numbers(const mpm_world *world, int32_t *numbers)
{
    int32_t b, i;
    for (b = 0; b < world->bodies; b++) {
        const mpm_body *body = &world->body[b];
        for (i = 0; i < body->count; i++) numbers[body->first + i] = i < body->active ? b : -1;
    }
}

#define MPM__IO_PVD_HEAD                                                            \
    "<?xml version=\"1.0\"?>\n<!-- mpm.h " MPM_VERSION " -->\n"                       \
    "<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n"
#define MPM__IO_PVD_TAIL "  </Collection>\n</VTKFile>\n"

MPM_API mpm_status mpm_io_pvd_begin(const char *path, mpm_fault *fault)
{
    mpm_io_file f;
    mpm_status status = mpm_io_open(&f, path, fault);
    if (status < 0) return status;
    mpm_io_put(&f, MPM__IO_PVD_HEAD MPM__IO_PVD_TAIL);
    return mpm_io_close(&f, fault);
}

/* Reads a line of any length, its end included, into *line[*room], which grows. Returns its length; 0 at the end of
   the file and without memory. */
static inline size_t mpm__io_read_line(FILE *from, char **line, size_t *room)
{
    size_t n = 0;
    int c = 0;
    while (c != '\n' && (c = fgetc(from)) != EOF) {
        if (n + 2 > *room) {
            const size_t more = 2 * *room + 256;
            char *wider = (char *)MPM_MALLOC(more);
            if (!wider) return 0;
            if (n > 0) memcpy(wider, *line, n);
            MPM_FREE(*line);
            *line = wider;
            *room = more;
        }
        (*line)[n++] = (char)c;
    }
    if (n > 0) (*line)[n] = 0;
    return n;
}

/* Whether a line is the entry of this frame. */
static inline int mpm__io_pvd_names(const char *line, const char *frame)
{
    const char *at = strstr(line, "file=\"");
    const size_t n = strlen(frame);
    return at && strncmp(at + 6, frame, n) == 0 && strcmp(at + 6 + n, "\"/>\n") == 0;
}

/* Copies the frames of an earlier file, all but the one of the same name. Each is one line that
   ends in file="name"/>; returns 0 when the file is not of that make. */
static inline int mpm__io_pvd_copy(mpm_io_file *to, FILE *from, const char *frame)
{
    char *line = NULL;
    size_t room = 0, n;
    int in_collection = 0, good = 0;
    while ((n = mpm__io_read_line(from, &line, &room)) > 0) {
        if (strlen(line) != n || line[n - 1] != '\n') break; /* a zero inside, or cut short */
        good = in_collection && strstr(line, "</Collection>") != NULL;
        if (good) break;
        if (in_collection && !mpm__io_pvd_names(line, frame)) mpm_io_put(to, line);
        if (strstr(line, "<Collection>")) in_collection = 1;
    }
    MPM_FREE(line);
    return good && !ferror(from);
}

/* The frames of the series there is. Only one that does not exist is new: what cannot be read must not be lost. */
static inline mpm_status mpm__io_pvd_take(mpm_io_file *to, const char *path, const char *frame, mpm_fault *fault)
{
    FILE *old;
    int good;
    errno = 0;
    old = fopen(path, "rb");
    if (!old && errno == ENOENT) return MPM_OK;
    if (!old) return mpm_fail(fault, MPM_ERR_FILE, "path: cannot be read", 0, -1);
    good = mpm__io_pvd_copy(to, old, frame);
    fclose(old);
    return good ? MPM_OK : mpm_fail(fault, MPM_ERR_FILE, "path: not a series of ours", 0, -1);
}

MPM_API mpm_status mpm_io_pvd_add(const char *path, const char *frame, double time,
                                  mpm_fault *fault)
{
    mpm_io_file f;
    mpm_status status;
    if (!mpm__io_frame_name(frame)) return mpm_fail(fault, MPM_ERR_ARGUMENT, "name of frame", 0, -1);
    status = mpm_io_open(&f, path, fault);
    if (status < 0) return status;
    mpm_io_put(&f, MPM__IO_PVD_HEAD);
    status = mpm__io_pvd_take(&f, path, frame, fault);
    if (status < 0) {
        mpm_io_drop(&f);
        return status;
    }
    mpm_io_put(&f, "    <DataSet timestep=\"");
    mpm_io_put_number(&f, time);
    mpm_io_put(&f, "\" part=\"0\" file=\"");
    mpm_io_put(&f, frame);
    mpm_io_put(&f, "\"/>\n" MPM__IO_PVD_TAIL);
    return mpm_io_close(&f, fault);
}

/* ---- checksums ----------------------------------------------------------------------------- */

/* CRC-32 of PNG and checkpoints (polynomial 0xEDB88320, reflected): start with crc 0 and pass the
   result on. The table holds the remainders of the 16 half bytes. */
static inline uint32_t mpm__io_crc(uint32_t crc, const void *data, size_t n)
{
    static const uint32_t table[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
        0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
        0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    const unsigned char *p = (const unsigned char *)data;
    crc = ~crc;
    while (n--) {
        crc ^= *p++;
        crc = (crc >> 4) ^ table[crc & 15];
        crc = (crc >> 4) ^ table[crc & 15];
    }
    return ~crc;
}

/* Adler-32 of a zlib stream: start with 1. */
static inline uint32_t mpm__io_adler(uint32_t adler, const unsigned char *p, size_t n)
{
    uint32_t a = adler & 0xffff, b = adler >> 16;
    while (n--) {
        a = (a + *p++) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

/* ---- checkpoints --------------------------------------------------------------------------- */

/* The fixed start of a checkpoint, in the machine's own byte order. */
typedef struct mpm__io_stamp {
    char magic[16];
    char version[16];
    uint32_t order;     /* 0x01020304 as this machine stores it */
    uint32_t real_size;
    uint32_t count;     /* of blobs */
    uint32_t size_size; /* of size_t: stored structs may hold it */
} mpm__io_stamp;

/* The head of each blob and of the text before them; its bytes follow. */
typedef struct mpm__io_blob_head {
    char name[64];
    uint64_t bytes;
} mpm__io_blob_head;

static inline mpm__io_stamp mpm__io_stamp_make(int count)
{
    mpm__io_stamp s;
    memset(&s, 0, sizeof s);
    mpm_append(s.magic, sizeof s.magic, 0, "mpm checkpoint");
    mpm_append(s.version, sizeof s.version, 0, MPM_VERSION);
    s.order = 0x01020304;
    s.real_size = (uint32_t)sizeof(mpm_real);
    s.count = (uint32_t)count;
    s.size_size = (uint32_t)sizeof(size_t);
    return s;
}

static inline mpm__io_blob_head mpm__io_blob_head_make(const char *name, size_t bytes)
{
    mpm__io_blob_head h;
    memset(&h, 0, sizeof h);
    mpm_append(h.name, sizeof h.name, 0, name);
    h.bytes = bytes;
    return h;
}

static inline mpm_status mpm__io_blobs_check(const mpm_blob *blob, int count, mpm_fault *fault)
{
    int i;
    if (count < 0 || (count > 0 && !blob))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "count of blobs", (mpm_real)count, -1);
    for (i = 0; i < count; i++) {
        if (!blob[i].name || strlen(blob[i].name) >= 64) return mpm_fail(fault, MPM_ERR_ARGUMENT, "name of blob", 0, i);
        if (!blob[i].data && (blob[i].bytes > 0 || blob[i].room > 0))
            return mpm_fail(fault, MPM_ERR_ARGUMENT, "data of blob", 0, i);
    }
    return MPM_OK;
}

/* A head and its bytes; carries the checksum along. */
static inline uint32_t mpm__io_put_blob(mpm_io_file *f, uint32_t crc, const char *name, const void *data, size_t n)
{
    mpm__io_blob_head head = mpm__io_blob_head_make(name, n);
    mpm_io_put_bytes(f, &head, sizeof head);
    mpm_io_put_bytes(f, data, n);
    return mpm__io_crc(mpm__io_crc(crc, &head, sizeof head), data, n);
}

MPM_API mpm_status mpm_io_checkpoint_write(const char *path, const char *text, const mpm_blob *blob, int count,
                                           mpm_fault *fault)
{
    mpm_io_file f;
    mpm__io_stamp stamp = mpm__io_stamp_make(count);
    uint32_t crc = mpm__io_crc(0, &stamp, sizeof stamp);
    int i;
    mpm_status status = mpm__io_blobs_check(blob, count, fault);
    if (status < 0) return status;
    status = mpm_io_open(&f, path, fault);
    if (status < 0) return status;
    mpm_io_put_bytes(&f, &stamp, sizeof stamp);
    crc = mpm__io_put_blob(&f, crc, "text", text ? text : "", text ? strlen(text) : 0);
    for (i = 0; i < count; i++) crc = mpm__io_put_blob(&f, crc, blob[i].name, blob[i].data, blob[i].bytes);
    mpm_io_put_bytes(&f, &crc, sizeof crc);
    return mpm_io_close(&f, fault);
}

/* Reads n bytes past, adding them to the checksum; 0 when the file ends early. */
static inline int mpm__io_skip_summed(FILE *in, uint64_t n, uint32_t *crc)
{
    unsigned char buffer[4096];
    while (n > 0) {
        size_t part = n < sizeof buffer ? (size_t)n : sizeof buffer;
        if (fread(buffer, 1, part, in) != part) return 0;
        *crc = mpm__io_crc(*crc, buffer, part);
        n -= part;
    }
    return 1;
}

/* Compares n bytes of the file with a text. Returns the beginning of the text's first line that differs, and its
   number; NULL if there is none. */
static inline const char *mpm__io_text_differs(FILE *in, uint64_t n, const char *text, int64_t *line, uint32_t *crc)
{
    const char *start = text, *at = text;
    for (*line = 1; n > 0; n--) {
        const int c = fgetc(in);
        const unsigned char octet = (unsigned char)c;
        if (c == EOF || *at == 0 || octet != (unsigned char)*at) return start;
        *crc = mpm__io_crc(*crc, &octet, 1);
        if (*at++ != '\n') continue;
        start = at;
        ++*line;
    }
    return *at ? start : NULL;
}

/* The stamp: who wrote the file. */
static inline mpm_status mpm__io_stamp_verify(const mpm__io_stamp *found, const mpm__io_stamp *mine, mpm_fault *fault)
{
    if (memcmp(found->magic, mine->magic, 16) != 0)
        return mpm_fail(fault, MPM_ERR_FILE, "path: not a checkpoint", 0, -1);
    if (memcmp(found->version, mine->version, 16) != 0)
        return mpm_fail(fault, MPM_ERR_VERSION, "version of checkpoint", 0, -1);
    if (found->order != mine->order) return mpm_fail(fault, MPM_ERR_VERSION, "byte order of checkpoint", 0, -1);
    if (found->real_size != mine->real_size)
        return mpm_fail(fault, MPM_ERR_VERSION, "real size of checkpoint", (mpm_real)found->real_size, -1);
    if (found->size_size != mine->size_size)
        return mpm_fail(fault, MPM_ERR_VERSION, "word size of checkpoint", (mpm_real)found->size_size, -1);
    return MPM_OK;
}

/* The text behind the stamp: what the file is of. */
static inline mpm_status mpm__io_text_verify(FILE *in, const char *text, uint32_t *crc, mpm_fault *fault)
{
    mpm__io_blob_head head, wanted = mpm__io_blob_head_make("text", 0);
    const char *differs;
    int64_t line;
    if (fread(&head, sizeof head, 1, in) != 1 || memcmp(head.name, wanted.name, sizeof head.name) != 0)
        return mpm_fail(fault, MPM_ERR_FILE, "text of checkpoint", 0, -1);
    *crc = mpm__io_crc(*crc, &head, sizeof head);
    differs = mpm__io_text_differs(in, head.bytes, text, &line, crc);
    if (!differs) return MPM_OK;
    return mpm_fail(fault, MPM_ERR_VERSION, *differs ? differs : "more lines in the file", 0, line);
}

/* Whether a stored blob is the one asked for and fits; with `any` also if its room is too small. */
static inline int mpm__io_blob_fits(const mpm__io_blob_head *head, const mpm_blob *b, int any)
{
    mpm__io_blob_head wanted = mpm__io_blob_head_make(b->name, 0);
    if (memcmp(head->name, wanted.name, sizeof head->name) != 0) return 0;
    return b->room > 0 ? any || head->bytes <= b->room : head->bytes == b->bytes;
}

/* Compares stamp, text, names, sizes (with `any`: not with the room) and checksum with what is asked for; changes
   nothing. */
static inline mpm_status mpm__io_checkpoint_verify(FILE *in, const char *text, const mpm_blob *blob, int count, int any,
                                                   mpm_fault *fault)
{
    mpm__io_stamp found, mine = mpm__io_stamp_make(count);
    uint32_t crc, stored;
    mpm_status status;
    int i;
    if (fread(&found, sizeof found, 1, in) != 1) return mpm_fail(fault, MPM_ERR_FILE, "path: not a checkpoint", 0, -1);
    if ((status = mpm__io_stamp_verify(&found, &mine, fault)) < 0) return status;
    crc = mpm__io_crc(0, &found, sizeof found);
    if ((status = mpm__io_text_verify(in, text, &crc, fault)) < 0) return status;
    if (found.count != mine.count)
        return mpm_fail(fault, MPM_ERR_FILE, "count of blobs differs", (mpm_real)found.count, -1);
    for (i = 0; i < count; i++) {
        mpm__io_blob_head head;
        if (fread(&head, sizeof head, 1, in) != 1)
            return mpm_fail(fault, MPM_ERR_FILE, "checkpoint ends early", 0, i);
        if (!mpm__io_blob_fits(&head, &blob[i], any))
            return mpm_fail(fault, MPM_ERR_FILE, "name or size of blob differs", 0, i);
        crc = mpm__io_crc(crc, &head, sizeof head);
        if (!mpm__io_skip_summed(in, head.bytes, &crc))
            return mpm_fail(fault, MPM_ERR_FILE, "checkpoint ends early", 0, i);
    }
    if (fread(&stored, sizeof stored, 1, in) != 1 || fgetc(in) != EOF)
        return mpm_fail(fault, MPM_ERR_FILE, "length of checkpoint", 0, -1);
    if (stored != crc) return mpm_fail(fault, MPM_ERR_FILE, "checksum of checkpoint", 0, -1);
    return MPM_OK;
}

/* The sizes of the blobs (sizes = 1), or their bytes, into their places. */
static inline int mpm__io_read_blobs(FILE *in, const char *text, mpm_blob *blob, int count, int sizes)
{
    long skip = (long)(sizeof(mpm__io_stamp) + sizeof(mpm__io_blob_head) + strlen(text));
    int i;
    if (fseek(in, skip, SEEK_SET) != 0) return 0;
    for (i = 0; i < count; i++) {
        mpm__io_blob_head head;
        uint32_t unused = 0;
        if (fread(&head, sizeof head, 1, in) != 1 || !mpm__io_blob_fits(&head, &blob[i], sizes)) return 0;
        blob[i].bytes = (size_t)head.bytes;
        if (sizes ? !mpm__io_skip_summed(in, head.bytes, &unused)
                  : blob[i].bytes > 0 && fread(blob[i].data, 1, blob[i].bytes, in) != blob[i].bytes)
            return 0;
    }
    return 1;
}

/* Verifies a checkpoint, then takes its bytes or their sizes. */
static inline mpm_status mpm__io_checkpoint_take(const char *path, const char *text, mpm_blob *blob, int count,
                                                 int sizes, mpm_fault *fault)
{
    FILE *in;
    int good = 1;
    mpm_status status = mpm__io_blobs_check(blob, count, fault);
    if (status < 0) return status;
    in = path ? fopen(path, "rb") : NULL;
    if (!in) return mpm_fail(fault, MPM_ERR_FILE, "path: cannot be read", 0, -1);
    if (!text) text = "";
    status = mpm__io_checkpoint_verify(in, text, blob, count, sizes, fault);
    if (status == MPM_OK) good = mpm__io_read_blobs(in, text, blob, count, sizes);
    fclose(in);
    return good ? status : mpm_fail(fault, MPM_ERR_FILE, "path: reading failed", 0, -1);
}

MPM_API mpm_status mpm_io_checkpoint_read(const char *path, const char *text, mpm_blob *blob, int count,
                                          mpm_fault *fault)
{
    return mpm__io_checkpoint_take(path, text, blob, count, 0, fault);
}

MPM_API mpm_status mpm_io_checkpoint_sizes(const char *path, const char *text, mpm_blob *blob, int count,
                                           mpm_fault *fault)
{
    return mpm__io_checkpoint_take(path, text, blob, count, 1, fault);
}

/* ---- descriptions as text ------------------------------------------------------------------- */

MPM_API size_t mpm_io_line(char *buffer, size_t n, size_t used, const char *name, const char *value)
{
    used = mpm_append(buffer, n, used, name);
    used = mpm_append(buffer, n, used, " ");
    used = mpm_append(buffer, n, used, value);
    return mpm_append(buffer, n, used, "\n");
}

MPM_API size_t mpm_io_line_number(char *buffer, size_t n, size_t used, const char *name, double value)
{
    char text[40];
    mpm_io_number_text(text, sizeof text, value);
    return mpm_io_line(buffer, n, used, name, text);
}

/* A text being written, line by line. */
typedef struct mpm__io_page {
    char *buffer;
    size_t n, used;
    const char *of; /* stands before the names, with a number: "body 2 spacing"; or NULL */
    int32_t number;
} mpm__io_page;

static inline void mpm__io_say(mpm__io_page *t, const char *text)
{
    t->used = mpm_append(t->buffer, t->n, t->used, text);
}

/* The beginning of a line. */
static inline void mpm__io_name(mpm__io_page *t, const char *name)
{
    char text[40];
    if (t->of) {
        snprintf(text, sizeof text, " %ld ", (long)t->number);
        mpm__io_say(t, t->of);
        mpm__io_say(t, text);
    }
    mpm__io_say(t, name);
}

/* A line of `count` choices, whose words stand in a list. */
#define MPM__IO_WORD(name, word, text) " " word,
static inline void mpm__io_words(mpm__io_page *t, const char *name, const char *const *word, const int32_t *choice,
                                 int count)
{
    int i;
    mpm__io_name(t, name);
    for (i = 0; i < count; i++) mpm__io_say(t, word[choice[i]]);
    mpm__io_say(t, "\n");
}

/* A line of `count` values: reals or whole numbers; the others are NULL. */
static inline void mpm__io_values(mpm__io_page *t, const char *name, const mpm_real *real, const int32_t *whole,
                                  int count)
{
    char text[40] = "";
    int i;
    mpm__io_name(t, name);
    for (i = 0; i < count; i++) {
        if (real) mpm__io_print_real(text, sizeof text, real[i]);
        if (whole) snprintf(text, sizeof text, "%ld", (long)whole[i]);
        mpm__io_say(t, " ");
        mpm__io_say(t, text);
    }
    mpm__io_say(t, "\n");
}

static inline void mpm__io_real(mpm__io_page *t, const char *name, mpm_real value)
{
    mpm__io_values(t, name, &value, NULL, 1);
}

static inline void mpm__io_whole(mpm__io_page *t, const char *name, int32_t value)
{
    mpm__io_values(t, name, NULL, &value, 1);
}

static inline void mpm__io_contact_text(mpm__io_page *t, const mpm_contact *c)
{
    static const char *const laws[] = {MPM_CONTACT_LIST(MPM__IO_WORD)};
    static const char *const normals[] = {MPM_NORMAL_LIST(MPM__IO_WORD)};
    const int32_t law = (int32_t)c->law, normal = (int32_t)c->normal;
    mpm__io_words(t, "contact.law", laws, &law, 1);
    mpm__io_words(t, "contact.normal", normals, &normal, 1);
    mpm__io_real(t, "contact.friction", c->friction);
    mpm__io_real(t, "contact.cutoff", c->cutoff);
    mpm__io_whole(t, "contact.touch", c->touch);
}

/* The grid and what holds for all bodies. Capacities are left out: they may differ. */
static inline void mpm__io_desc_text(mpm__io_page *t, const mpm_desc *d)
{
    static const char *const geometries[] = {MPM_GEOMETRY_LIST(MPM__IO_WORD)};
    static const char *const bases[] = {MPM_BASIS_LIST(MPM__IO_WORD)};
    static const char *const sides[] = {MPM_SIDE_LIST(MPM__IO_WORD)};
    static const char *const schemes[] = {MPM_SCHEME_LIST(MPM__IO_WORD)};
    const int32_t geometry = (int32_t)d->geometry, basis = (int32_t)d->basis, scheme = (int32_t)d->scheme;
    int32_t side[6];
    int i;
    for (i = 0; i < 6; i++) side[i] = (int32_t)d->side[i];
    mpm__io_words(t, "geometry", geometries, &geometry, 1);
    mpm__io_words(t, "basis", bases, &basis, 1);
    mpm__io_values(t, "origin", d->origin, NULL, 3);
    mpm__io_real(t, "cell", d->cell);
    mpm__io_values(t, "cells", NULL, d->cells, 3);
    mpm__io_words(t, "side", sides, side, 6);
    mpm__io_real(t, "wall_friction", d->wall_friction);
    mpm__io_contact_text(t, &d->contact);
    mpm__io_words(t, "scheme", schemes, &scheme, 1);
    mpm__io_values(t, "gravity", d->gravity, NULL, 3);
    mpm__io_real(t, "mass_cutoff", d->mass_cutoff);
    mpm__io_real(t, "calm", d->calm);
    mpm__io_whole(t, "user_fields", d->user_fields);
}

#undef MPM__IO_WORD

static inline void mpm__io_body_text(mpm__io_page *t, const mpm_body_desc *b)
{
    mpm__io_whole(t, "shape", (int32_t)b->shape.kind);
    mpm__io_values(t, "center", b->shape.center, NULL, 3);
    mpm__io_values(t, "half", b->shape.half, NULL, 3);
    mpm__io_real(t, "spacing", b->spacing);
    mpm__io_real(t, "density", b->density);
    mpm__io_values(t, "velocity", b->velocity, NULL, 3);
    mpm__io_real(t, "temperature", b->temperature);
    mpm__io_whole(t, "stress", b->stress != NULL);
    mpm__io_real(t, "wave_p", b->wave_p);
    mpm__io_real(t, "wave_s", b->wave_s);
    mpm__io_whole(t, "absorb", b->absorb);
    mpm__io_real(t, "absorb_normal", b->absorb_normal);
    mpm__io_real(t, "absorb_shear", b->absorb_shear);
    mpm__io_real(t, "absorb_spring", b->absorb_spring);
    mpm__io_real(t, "shell", b->shell);
    mpm__io_whole(t, "id", b->id);
}

MPM_API size_t mpm_io_world_text(char *buffer, size_t n, const mpm_world *w)
{
    mpm__io_page t = {NULL, 0, 0, NULL, 0};
    int32_t i;
    t.buffer = buffer;
    t.n = n;
    t.used = mpm_io_line(buffer, n, 0, "mpm.h", MPM_VERSION);
    mpm__io_desc_text(&t, &w->desc);
    t.of = "rule";
    for (i = 0; i < w->rules; i++) {
        int32_t pair[2];
        t.number = i;
        pair[0] = w->rule[i].a;
        pair[1] = w->rule[i].b;
        mpm__io_values(&t, "bodies", NULL, pair, 2);
        mpm__io_contact_text(&t, &w->rule[i].contact);
    }
    t.of = "body";
    for (t.number = 0; t.number < w->bodies; t.number++) mpm__io_body_text(&t, &w->body[t.number].desc);
    return t.used;
}

/* ---- deflate: LZ77 matches, Huffman codes -------------------------------------------------- */

enum { MPM__IO_WINDOW = 32768, MPM__IO_TOKENS = 32768 };

/* A zlib stream on its way into the IDAT chunks of a PNG. */
typedef struct mpm__io_zip {
    mpm_io_file *file;
    unsigned char out[MPM__IO_WINDOW]; /* body of the next chunk */
    size_t used;
    uint32_t bits;                     /* bits not yet a whole byte, first one lowest */
    int bit_count;
    uint32_t tokens[MPM__IO_TOKENS];   /* literal byte, or length << 16 | distance */
    int token_count;
    int32_t head[MPM__IO_WINDOW];      /* by hash of three bytes: their last position + 1 */
    int32_t previous[MPM__IO_WINDOW];  /* by position: the one before with the same hash, + 1 */
    uint32_t *number;                  /* of the next chunk of a film's later pictures; NULL: IDAT, which have none */
} mpm__io_zip;

static inline void mpm__io_big_endian(unsigned char out[4], uint32_t value)
{
    out[0] = (unsigned char)(value >> 24);
    out[1] = (unsigned char)(value >> 16);
    out[2] = (unsigned char)(value >> 8);
    out[3] = (unsigned char)value;
}

/* One PNG chunk: length, type, body, CRC of type and body. */
static inline void mpm__io_png_chunk(mpm_io_file *f, const char *type, const void *body, size_t n)
{
    unsigned char number[4];
    mpm__io_big_endian(number, (uint32_t)n);
    mpm_io_put_bytes(f, number, 4);
    mpm_io_put_bytes(f, type, 4);
    mpm_io_put_bytes(f, body, n);
    mpm__io_big_endian(number, mpm__io_crc(mpm__io_crc(0, type, 4), body, n));
    mpm_io_put_bytes(f, number, 4);
}

/* The head of a chunk of n bytes of compressed rows: IDAT, or fdAT with its number. Returns the CRC so far. */
static inline uint32_t mpm__io_rows_head(mpm_io_file *f, uint32_t *number, size_t n)
{
    unsigned char size[4], count[4];
    const char *type = number ? "fdAT" : "IDAT";
    const size_t more = number ? 4 : 0;
    if (number) mpm__io_big_endian(count, (*number)++);
    mpm__io_big_endian(size, (uint32_t)(n + more));
    mpm_io_put_bytes(f, size, 4);
    mpm_io_put_bytes(f, type, 4);
    if (number) mpm_io_put_bytes(f, count, 4);
    return mpm__io_crc(mpm__io_crc(0, type, 4), count, more);
}

/* What is ready of the compressed rows, as a chunk. */
static inline void mpm__io_zip_out(mpm__io_zip *z)
{
    unsigned char sum[4];
    const uint32_t crc = mpm__io_rows_head(z->file, z->number, z->used);
    mpm_io_put_bytes(z->file, z->out, z->used);
    mpm__io_big_endian(sum, mpm__io_crc(crc, z->out, z->used));
    mpm_io_put_bytes(z->file, sum, 4);
    z->used = 0;
}

static inline void mpm__io_zip_byte(mpm__io_zip *z, unsigned value)
{
    z->out[z->used++] = (unsigned char)value;
    if (z->used == sizeof z->out) mpm__io_zip_out(z);
}

/* Appends the low `count` bits of value, lowest first. */
static inline void mpm__io_zip_bits(mpm__io_zip *z, uint32_t value, int count)
{
    z->bits |= value << z->bit_count;
    z->bit_count += count;
    while (z->bit_count >= 8) {
        mpm__io_zip_byte(z, z->bits & 255);
        z->bits >>= 8;
        z->bit_count -= 8;
    }
}

/* Depths of a Huffman tree over frequency[n], n <= 286: the two rarest nodes are joined until one
   is left. Returns the greatest depth. Symbols of frequency 0 get depth 0. */
static inline int mpm__io_huffman_depths(const uint32_t *frequency, int n, unsigned char *depth)
{
    uint32_t weight[2 * 286];
    int parent[2 * 286], nodes = n, i, deepest = 0;
    for (i = 0; i < n; i++) {
        weight[i] = frequency[i];
        parent[i] = -1;
    }
    for (;;) {
        int a = -1, b = -1; /* rarest and second rarest node without a parent */
        for (i = 0; i < nodes; i++) {
            if (weight[i] == 0 || parent[i] >= 0) continue;
            if (a < 0 || weight[i] < weight[a]) {
                b = a;
                a = i;
            } else if (b < 0 || weight[i] < weight[b])
                b = i;
        }
        if (b < 0) break;
        parent[a] = parent[b] = nodes;
        parent[nodes] = -1;
        weight[nodes++] = weight[a] + weight[b];
    }
    for (i = 0; i < n; i++) {
        int up = i, steps = 0;
        while (parent[up] >= 0) {
            up = parent[up];
            steps++;
        }
        depth[i] = (unsigned char)steps;
        if (steps > deepest) deepest = steps;
    }
    return deepest;
}

/* Code lengths of at most `limit` bits. A tree too deep is made flatter by halving frequencies.
   At least two symbols get a code, so that every tree is complete. */
static inline void mpm__io_huffman_lengths(uint32_t *frequency, int n, int limit,
                                           unsigned char *length)
{
    int i, used = 0;
    for (i = 0; i < n; i++) used += frequency[i] > 0;
    for (i = 0; used < 2; i++)
        if (frequency[i] == 0) {
            frequency[i] = 1;
            used++;
        }
    while (mpm__io_huffman_depths(frequency, n, length) > limit)
        for (i = 0; i < n; i++) frequency[i] = (frequency[i] + 1) / 2;
}

/* Canonical codes from lengths (RFC 1951, 3.2.2), bits reversed because they go out first bit
   lowest. */
static inline void mpm__io_huffman_codes(const unsigned char *length, int n, uint16_t *code)
{
    uint32_t next[16], total = 0;
    int bits, i, k;
    for (bits = 1; bits < 16; bits++) {
        next[bits] = total;
        for (i = 0; i < n; i++) total += length[i] == bits;
        total <<= 1;
    }
    for (i = 0; i < n; i++) {
        uint32_t reversed = 0, value = length[i] ? next[length[i]]++ : 0;
        for (k = 0; k < length[i]; k++) reversed |= (value >> k & 1) << (length[i] - 1 - k);
        code[i] = (uint16_t)reversed;
    }
}

/* The symbol whose range holds value, from the table of range starts. */
static inline int mpm__io_range(const uint16_t *start, int n, uint32_t value)
{
    int k = n - 1;
    while (start[k] > value) k--;
    return k;
}

/* Ranges of match lengths (symbols 257 ..) and of distances, with their extra bits (RFC 1951,
   3.2.5). */
static inline int mpm__io_length_symbol(uint32_t length, int *extra, uint32_t *rest)
{
    static const uint16_t start[29] = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                       15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                       67, 83, 99, 115, 131, 163, 195, 227, 258};
    int k = mpm__io_range(start, 29, length);
    *extra = k < 8 || k == 28 ? 0 : (k - 4) / 4;
    *rest = length - start[k];
    return 257 + k;
}

static inline int mpm__io_distance_symbol(uint32_t distance, int *extra, uint32_t *rest)
{
    static const uint16_t start[30] = {
        1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
        193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    int k = mpm__io_range(start, 30, distance);
    *extra = k < 4 ? 0 : (k - 2) / 2;
    *rest = distance - start[k];
    return k;
}

/* The tables of a block: code lengths of both trees, themselves Huffman coded, without run
   lengths - some hundred bytes a block that are not worth more code. */
static inline void mpm__io_zip_trees(mpm__io_zip *z, const unsigned char *literal,
                                     const unsigned char *distance)
{
    static const unsigned char order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13,
                                            2, 14, 1, 15};
    uint32_t frequency[19] = {0};
    unsigned char length[19];
    uint16_t code[19];
    int i;
    for (i = 0; i < 286; i++) frequency[literal[i]]++;
    for (i = 0; i < 30; i++) frequency[distance[i]]++;
    mpm__io_huffman_lengths(frequency, 19, 7, length);
    mpm__io_huffman_codes(length, 19, code);
    mpm__io_zip_bits(z, 286 - 257, 5);
    mpm__io_zip_bits(z, 30 - 1, 5);
    mpm__io_zip_bits(z, 19 - 4, 4);
    for (i = 0; i < 19; i++) mpm__io_zip_bits(z, length[order[i]], 3);
    for (i = 0; i < 286; i++) mpm__io_zip_bits(z, code[literal[i]], length[literal[i]]);
    for (i = 0; i < 30; i++) mpm__io_zip_bits(z, code[distance[i]], length[distance[i]]);
}

/* Writes the gathered tokens as one block with its own Huffman codes. */
static inline void mpm__io_zip_block(mpm__io_zip *z, int last)
{
    uint32_t literals[286] = {0}, distances[30] = {0}, rest;
    unsigned char literal_length[286], distance_length[30];
    uint16_t literal_code[286], distance_code[30];
    int i, extra, symbol;
    literals[256] = 1; /* end of block */
    for (i = 0; i < z->token_count; i++) {
        uint32_t token = z->tokens[i];
        if (token < 256) literals[token]++;
        else {
            literals[mpm__io_length_symbol(token >> 16, &extra, &rest)]++;
            distances[mpm__io_distance_symbol(token & 65535, &extra, &rest)]++;
        }
    }
    mpm__io_huffman_lengths(literals, 286, 15, literal_length);
    mpm__io_huffman_lengths(distances, 30, 15, distance_length);
    mpm__io_huffman_codes(literal_length, 286, literal_code);
    mpm__io_huffman_codes(distance_length, 30, distance_code);
    mpm__io_zip_bits(z, (uint32_t)last | 2u << 1, 3);
    mpm__io_zip_trees(z, literal_length, distance_length);
    for (i = 0; i < z->token_count; i++) {
        uint32_t token = z->tokens[i];
        if (token < 256) {
            mpm__io_zip_bits(z, literal_code[token], literal_length[token]);
            continue;
        }
        symbol = mpm__io_length_symbol(token >> 16, &extra, &rest);
        mpm__io_zip_bits(z, literal_code[symbol], literal_length[symbol]);
        mpm__io_zip_bits(z, rest, extra);
        symbol = mpm__io_distance_symbol(token & 65535, &extra, &rest);
        mpm__io_zip_bits(z, distance_code[symbol], distance_length[symbol]);
        mpm__io_zip_bits(z, rest, extra);
    }
    mpm__io_zip_bits(z, literal_code[256], literal_length[256]);
    z->token_count = 0;
}

static inline uint32_t mpm__io_hash(const unsigned char *p)
{
    uint32_t three = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16;
    return three * 2654435761u >> 17;
}

/* The longest earlier match for data[at ..], among the last few with the same hash. Returns its
   length, 0 when under three, and its distance. */
static inline int32_t mpm__io_match(const mpm__io_zip *z, const unsigned char *data, int32_t n,
                                    int32_t at, int32_t *distance)
{
    int32_t best = 2, most = n - at < 258 ? n - at : 258, candidate, length;
    int tries = 32;
    if (most < 3) return 0;
    candidate = z->head[mpm__io_hash(data + at)] - 1;
    while (candidate >= 0 && at - candidate < MPM__IO_WINDOW && tries-- > 0 && best < most) {
        int32_t older = z->previous[candidate % MPM__IO_WINDOW] - 1;
        if (data[candidate + best] == data[at + best]) {
            for (length = 0; length < most && data[candidate + length] == data[at + length];)
                length++;
            if (length > best) {
                best = length;
                *distance = at - candidate;
            }
        }
        if (older >= candidate) break; /* the slot has been used again */
        candidate = older;
    }
    return best > 2 ? best : 0;
}

/* Compresses data[n] into a zlib stream. */
static inline void mpm__io_zip_all(mpm__io_zip *z, const unsigned char *data, int32_t n)
{
    unsigned char number[4];
    int32_t at = 0, i, distance = 0;
    mpm__io_zip_byte(z, 0x78); /* deflate, 32 kB window */
    mpm__io_zip_byte(z, 0x9c);
    while (at < n) {
        int32_t length = mpm__io_match(z, data, n, at, &distance), end = at + (length ? length : 1);
        z->tokens[z->token_count++] =
            length ? (uint32_t)length << 16 | (uint32_t)distance : (uint32_t)data[at];
        for (; at < end; at++) {
            if (at + 3 > n) continue;
            z->previous[at % MPM__IO_WINDOW] = z->head[mpm__io_hash(data + at)];
            z->head[mpm__io_hash(data + at)] = at + 1;
        }
        if (z->token_count == MPM__IO_TOKENS) mpm__io_zip_block(z, 0);
    }
    mpm__io_zip_block(z, 1);
    if (z->bit_count > 0) mpm__io_zip_bits(z, 0, 8 - z->bit_count);
    mpm__io_big_endian(number, mpm__io_adler(1, data, (size_t)n));
    for (i = 0; i < 4; i++) mpm__io_zip_byte(z, number[i]);
    if (z->used > 0) mpm__io_zip_out(z);
}

/* ---- PNG ----------------------------------------------------------------------------------- */

/* PNG's predictor 4: whichever of left, above, above left is nearest to left + above - corner. */
static inline int mpm__io_paeth(int left, int above, int corner)
{
    int a = abs(above - corner), b = abs(left - corner), c = abs(left + above - 2 * corner);
    return a <= b && a <= c ? left : b <= c ? above : corner;
}

/* Filters one row of n bytes (above: the row before, or NULL) into out[1 + n], kind first. Returns
   the sum of the magnitudes left over. */
static inline long mpm__io_filter(int kind, const unsigned char *row, const unsigned char *above,
                                  int n, unsigned char *out)
{
    long sum = 0;
    int i;
    out[0] = (unsigned char)kind;
    for (i = 0; i < n; i++) {
        int left = i >= 3 ? row[i - 3] : 0, up = above ? above[i] : 0;
        int corner = above && i >= 3 ? above[i - 3] : 0, guess = 0, rest;
        switch (kind) {
        case 1: guess = left; break;
        case 2: guess = up; break;
        case 3: guess = (left + up) / 2; break;
        case 4: guess = mpm__io_paeth(left, up, corner); break;
        default: break;
        }
        rest = (row[i] - guess) & 255;
        out[1 + i] = (unsigned char)rest;
        sum += rest < 128 ? rest : 256 - rest;
    }
    return sum;
}

/* All rows, each by the filter that leaves least. */
static inline void mpm__io_filter_all(const unsigned char *pixels, int width, int height, unsigned char *out)
{
    int n = 3 * width, y, kind;
    for (y = 0; y < height; y++) {
        const unsigned char *row = pixels + (size_t)y * (size_t)n;
        const unsigned char *above = y > 0 ? row - n : NULL;
        unsigned char *target = out + (size_t)y * ((size_t)n + 1);
        long least = -1;
        int best = 0;
        for (kind = 0; kind < 5; kind++) {
            long sum = mpm__io_filter(kind, row, above, n, target);
            if (least < 0 || sum < least) {
                least = sum;
                best = kind;
            }
        }
        mpm__io_filter(best, row, above, n, target);
    }
}

/* An iTXt chunk: keyword, zero, "not compressed" twice, no language, no translation, UTF-8 of any length. */
static inline void mpm__io_png_text(mpm_io_file *f, const char *keyword, const char *text)
{
    unsigned char number[4];
    const char *at;
    const size_t key = strlen(keyword);
    size_t n, length = key + 5;
    uint32_t crc = mpm__io_crc(mpm__io_crc(mpm__io_crc(0, "iTXt", 4), keyword, key), "\0\0\0\0", 5);
    for (at = text; *at; length += n) {
        const char *c = mpm__io_character(&at, &n);
        crc = mpm__io_crc(crc, c, n);
    }
    mpm__io_big_endian(number, (uint32_t)length);
    mpm_io_put_bytes(f, number, 4);
    mpm_io_put(f, "iTXt");
    mpm_io_put(f, keyword);
    mpm_io_put_bytes(f, "\0\0\0\0", 5);
    while (*text) {
        const char *c = mpm__io_character(&text, &n);
        mpm_io_put_bytes(f, c, n);
    }
    mpm__io_big_endian(number, crc);
    mpm_io_put_bytes(f, number, 4);
}

/* What stands before the rows: of what size, by whom, what it shows. */
static inline void mpm__io_png_head(mpm_io_file *f, int width, int height, const char *note)
{
    unsigned char header[13] = {0};
    mpm_io_put(f, "\x89PNG\r\n\x1a\n");
    mpm__io_big_endian(header, (uint32_t)width);
    mpm__io_big_endian(header + 4, (uint32_t)height);
    header[8] = 8; /* bits per sample */
    header[9] = 2; /* RGB */
    mpm__io_png_chunk(f, "IHDR", header, sizeof header);
    mpm__io_png_text(f, "Software", "mpm.h " MPM_VERSION);
    if (note) mpm__io_png_text(f, "Description", note);
}

static inline mpm_status mpm__io_png_check(const unsigned char *pixels, int width, int height, mpm_fault *fault)
{
    if (!pixels) return mpm_fail(fault, MPM_ERR_ARGUMENT, "pixels (none)", 0, -1);
    if (width < 1 || width > 16384)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "width of picture", (mpm_real)width, -1);
    if (height < 1 || height > 16384)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "height of picture", (mpm_real)height, -1);
    return MPM_OK;
}

/* What compresses a picture, its filtered rows of width * 3 + 1 bytes each behind it; MPM_FREE it. NULL: no memory. */
static inline mpm__io_zip *mpm__io_zip_of(mpm_io_file *f, const unsigned char *pixels, int width, int height,
                                          mpm_fault *fault)
{
    const size_t bytes = sizeof(mpm__io_zip) + ((size_t)width * 3 + 1) * (size_t)height;
    mpm__io_zip *z = (mpm__io_zip *)MPM_MALLOC(bytes);
    if (!z) {
        mpm_fail(fault, MPM_ERR_MEMORY, "bytes for picture", (mpm_real)bytes, -1);
        return NULL;
    }
    memset(z, 0, sizeof *z);
    z->file = f;
    mpm__io_filter_all(pixels, width, height, (unsigned char *)(z + 1));
    return z;
}

static inline void mpm__io_zip_rows(mpm__io_zip *z, int width, int height)
{
    mpm__io_zip_all(z, (const unsigned char *)(z + 1), (int32_t)((width * 3 + 1) * height));
}

MPM_API mpm_status mpm_io_png(const char *path, const unsigned char *pixels, int width, int height,
                              const char *note, mpm_fault *fault)
{
    mpm_io_file f;
    mpm__io_zip *z;
    mpm_status status = mpm__io_png_check(pixels, width, height, fault);
    if (status < 0 || (status = mpm_io_open(&f, path, fault)) < 0) return status;
    z = mpm__io_zip_of(&f, pixels, width, height, fault);
    if (!z) {
        mpm_io_drop(&f);
        return MPM_ERR_MEMORY;
    }
    mpm__io_png_head(&f, width, height, note);
    mpm__io_zip_rows(z, width, height);
    mpm__io_png_chunk(&f, "IEND", NULL, 0);
    MPM_FREE(z);
    return mpm_io_close(&f, fault);
}

/* ---- films ----------------------------------------------------------------------------------- */

MPM_API mpm_status mpm_io_film_begin(mpm_io_film *f, const char *path, double seconds, const char *note,
                                     mpm_fault *fault)
{
    memset(f, 0, sizeof *f);
    f->seconds = seconds;
    f->note = note;
    return f->status = mpm_io_open(&f->file, path, fault);
}

/* Number and loops of a film's pictures. */
static inline void mpm__io_film_control(mpm_io_film *f)
{
    unsigned char control[8] = {0};
    mpm__io_big_endian(control, (uint32_t)f->pictures);
    mpm__io_png_chunk(&f->file, "acTL", control, sizeof control);
}

/* What stands before the rows of each picture; before those of the first what stands before all. */
static inline void mpm__io_film_next(mpm_io_film *f, int width, int height)
{
    unsigned char control[26] = {0};
    const double ms = f->seconds > 0 ? f->seconds < 60 ? floor(1000 * f->seconds + 0.5) : 60000 : 0;
    if (f->pictures == 0) {
        mpm__io_png_head(&f->file, f->width = width, f->height = height, f->note);
        f->place = f->file.stream ? ftell(f->file.stream) : -1;
        mpm__io_film_control(f);
    }
    mpm__io_big_endian(control, f->chunks++);
    mpm__io_big_endian(control + 4, (uint32_t)width);
    mpm__io_big_endian(control + 8, (uint32_t)height);
    control[20] = (unsigned char)((unsigned)ms >> 8);
    control[21] = (unsigned char)((unsigned)ms & 255);
    control[22] = 1000 >> 8;
    control[23] = 1000 & 255;
    mpm__io_png_chunk(&f->file, "fcTL", control, sizeof control);
    f->pictures++;
}

/* Whether a picture may come next. */
static inline mpm_status mpm__io_film_takes(mpm_io_film *f, int width, int height, mpm_fault *fault)
{
    if (f->pictures > 0 && width != f->width)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "width of a later picture", (mpm_real)width, f->pictures);
    if (f->pictures > 0 && height != f->height)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "height of a later picture", (mpm_real)height, f->pictures);
    return MPM_OK;
}

MPM_API mpm_status mpm_io_film_add(mpm_io_film *f, const unsigned char *pixels, int width, int height,
                                   mpm_fault *fault)
{
    mpm__io_zip *z;
    if (f->status < 0) return f->status;
    f->status = mpm__io_png_check(pixels, width, height, fault);
    if (f->status >= 0) f->status = mpm__io_film_takes(f, width, height, fault);
    if (f->status < 0) return f->status;
    z = mpm__io_zip_of(&f->file, pixels, width, height, fault);
    if (!z) return f->status = MPM_ERR_MEMORY;
    mpm__io_film_next(f, width, height);
    z->number = f->pictures > 1 ? &f->chunks : NULL;
    mpm__io_zip_rows(z, width, height);
    MPM_FREE(z);
    return MPM_OK;
}

static inline uint32_t mpm__io_from_big_endian(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | (uint32_t)p[3];
}

/* Copies a chunk of n bytes of rows whose head has been read, with a new head. Returns 0 if it is damaged. */
static inline int mpm__io_film_rows(mpm_io_film *f, FILE *in, size_t n)
{
    unsigned char block[4096], sum[4];
    uint32_t was = mpm__io_crc(0, "IDAT", 4), is;
    is = mpm__io_rows_head(&f->file, f->pictures > 1 ? &f->chunks : NULL, n);
    while (n > 0) {
        const size_t part = n < sizeof block ? n : sizeof block;
        if (fread(block, 1, part, in) != part) return 0;
        mpm_io_put_bytes(&f->file, block, part);
        was = mpm__io_crc(was, block, part);
        is = mpm__io_crc(is, block, part);
        n -= part;
    }
    if (fread(sum, 1, 4, in) != 4 || mpm__io_from_big_endian(sum) != was) return 0;
    mpm__io_big_endian(sum, is);
    mpm_io_put_bytes(&f->file, sum, 4);
    return 1;
}

/* All its rows; what else is in it is passed over. Returns 0 if it is damaged. */
static inline int mpm__io_film_copy(mpm_io_film *f, FILE *in)
{
    unsigned char head[8];
    int rows = 0;
    while (fread(head, 1, 8, in) == 8) {
        const uint32_t n = mpm__io_from_big_endian(head);
        if (!memcmp(head + 4, "IEND", 4)) return n == 0 && rows;
        if (n > 0x7fffffffu - 4) return 0;
        if (memcmp(head + 4, "IDAT", 4)) {
            if (fseek(in, (long)n + 4, SEEK_CUR) != 0) return 0;
        } else if (!(rows = mpm__io_film_rows(f, in, n))) {
            return 0;
        }
    }
    return 0;
}

/* Reads the head of a picture of mpm_io_png: its size. Returns 0 if it is none. */
static inline int mpm__io_film_head(FILE *in, int *width, int *height)
{
    static const unsigned char kind[5] = {8, 2, 0, 0, 0}; /* 8 bits, RGB, the one way to compress and filter, in rows */
    unsigned char head[33];
    uint32_t across, down;
    if (fread(head, 1, 33, in) != 33 || memcmp(head, "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16) ||
        memcmp(head + 24, kind, 5))
        return 0;
    across = mpm__io_from_big_endian(head + 16);
    down = mpm__io_from_big_endian(head + 20);
    if (across < 1 || across > 16384 || down < 1 || down > 16384) return 0;
    *width = (int)across;
    *height = (int)down;
    return 1;
}

MPM_API mpm_status mpm_io_film_add_png(mpm_io_film *f, const char *path, mpm_fault *fault)
{
    int width, height;
    FILE *in;
    if (f->status < 0) return f->status;
    in = path ? fopen(path, "rb") : NULL;
    if (!in) return f->status = mpm_fail(fault, MPM_ERR_FILE, "picture (cannot be opened)", 0, -1);
    if (!mpm__io_film_head(in, &width, &height))
        f->status = mpm_fail(fault, MPM_ERR_FILE, "picture: none of mpm_io_png", 0, -1);
    else
        f->status = mpm__io_film_takes(f, width, height, fault);
    if (f->status >= 0) {
        mpm__io_film_next(f, width, height);
        if (!mpm__io_film_copy(f, in)) f->status = mpm_fail(fault, MPM_ERR_FILE, "picture: damaged", 0, -1);
    }
    fclose(in);
    return f->status;
}

MPM_API mpm_status mpm_io_film_end(mpm_io_film *f, mpm_fault *fault)
{
    FILE *out = f->file.stream;
    if (f->status >= 0 && f->pictures == 0)
        f->status = mpm_fail(fault, MPM_ERR_ARGUMENT, "pictures of the film", 0, -1);
    if (f->status < 0) {
        mpm_io_drop(&f->file);
        return f->status;
    }
    mpm__io_png_chunk(&f->file, "IEND", NULL, 0);
    if (f->place < 0 || fseek(out, f->place, SEEK_SET) != 0) {
        mpm_io_drop(&f->file);
        return mpm_fail(fault, MPM_ERR_FILE, "film (cannot go back in it)", 0, -1);
    }
    mpm__io_film_control(f); /* now their number is known */
    return mpm_io_close(&f->file, fault);
}

#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */

/* References: PNG Specification, W3C (third edition: APNG); RFC 1950 and 1951 for zlib and deflate; the XML formats of
   the VTK file format documentation.

   MIT License: see LICENSE. */
