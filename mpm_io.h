/* mpm_io.h - files and pictures for mpm.h: VTK, PNG, JSON, CSV, checkpoints, progress.
   Version 0.1.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm_io.h"
       #include "mpm_io.h"
     (or MPM_IO_IMPLEMENTATION, for this header alone). Then hand it arrays: it writes what it is
     told about and knows nothing of materials, bonding or grids. Link with -lm.

   WHAT IT DOES NOT DO
     It reads nothing but its own checkpoints. It draws cuts, scatter plots and curves, not
     surfaces or perspective: for those open the .pvd series in ParaView. It never prints to
     stdout or stderr, never exits, and keeps no global state.

   NOTHING HALF-WRITTEN
     Every file is written as <path>.part, flushed, closed, and only then renamed to <path>. When
     any of this fails the .part file is removed, a file of that name from before is untouched, and
     the routine returns MPM_ERR_FILE.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm_io.h"
       int main(void) {
           mpm_real x[2] = {0, 1}, y[2] = {0, 0}, z[2] = {0, 1}, hot[2] = {300, 900};
           mpm_io_cut_desc cut = mpm_io_cut_desc_default();
           mpm_fault fault;
           cut.count = 2; cut.x[0] = x; cut.x[1] = y; cut.x[2] = z;
           cut.spacing = 1; cut.value = hot;
           cut.label = "temperature [K]"; cut.length_unit = "um";
           if (mpm_io_make_directory("out", &fault) < 0) return 1;
           return mpm_io_cut_png("out/two.png", &cut, 1, 1, 480, &fault) < 0;
       }

   CONTENTS
     messages      mpm_io_status_text, mpm_io_fault_text, mpm_io_number_text, mpm_io_progress_text
     folders       mpm_io_make_directory
     text files    mpm_io_json_*, mpm_io_csv_*
     ParaView      mpm_io_scalar .. mpm_io_uint8, mpm_io_vtu, mpm_io_pvd_begin, mpm_io_pvd_add
     restart       mpm_io_checkpoint_write, mpm_io_checkpoint_read, mpm_io_world_blobs
     pictures      mpm_io_canvas_*, mpm_io_rectangle, _line, _disc, _text, mpm_io_png
     figures       mpm_io_cut, mpm_io_scatter, mpm_io_plot, mpm_io_color_bar, mpm_io_tile

   CONFIGURATION (define before including)
     MPM_FLOAT               GLOBAL  as in mpm.h; public symbols then end in _f32.
     MPM_IO_PATH             GLOBAL  longest path in bytes, with its ending (default 1024).
     MPM_MALLOC(n), MPM_FREE(p) IMPL work memory of pictures and checkpoints.

   CONVENTIONS
     Text is UTF-8. Numbers in text files carry a decimal point under every locale and as many
     digits as bring the value back exactly. Pixels are counted from the top left; pixel (i, j)
     covers [i, i+1) x [j, j+1). Colours are 0xRRGGBB. Sizes of text are cap heights in pixels. */
#ifndef MPM_IO_H
#define MPM_IO_H

#include <stdio.h>
#include "mpm.h"

#ifdef MPM_FLOAT
#define mpm_io_status_text mpm_io_status_text_f32
#define mpm_io_fault_text mpm_io_fault_text_f32
#define mpm_io_number_text mpm_io_number_text_f32
#define mpm_io_progress_text mpm_io_progress_text_f32
#define mpm_io_make_directory mpm_io_make_directory_f32
#define mpm_io_json_begin mpm_io_json_begin_f32
#define mpm_io_json_number mpm_io_json_number_f32
#define mpm_io_json_real mpm_io_json_real_f32
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
#define mpm_io_world_blobs mpm_io_world_blobs_f32
#define mpm_io_canvas_bytes mpm_io_canvas_bytes_f32
#define mpm_io_canvas_init mpm_io_canvas_init_f32
#define mpm_io_canvas_free mpm_io_canvas_free_f32
#define mpm_io_canvas_fill mpm_io_canvas_fill_f32
#define mpm_io_pixel mpm_io_pixel_f32
#define mpm_io_rectangle mpm_io_rectangle_f32
#define mpm_io_line mpm_io_line_f32
#define mpm_io_disc mpm_io_disc_f32
#define mpm_io_text mpm_io_text_f32
#define mpm_io_text_width mpm_io_text_width_f32
#define mpm_io_png mpm_io_png_f32
#define mpm_io_map_color mpm_io_map_color_f32
#define mpm_io_series_color mpm_io_series_color_f32
#define mpm_io_tile mpm_io_tile_f32
#define mpm_io_color_bar mpm_io_color_bar_f32
#define mpm_io_cut_desc_default mpm_io_cut_desc_default_f32
#define mpm_io_cut_of mpm_io_cut_of_f32
#define mpm_io_cut mpm_io_cut_f32
#define mpm_io_body_numbers mpm_io_body_numbers_f32
#define mpm_io_cut_png mpm_io_cut_png_f32
#define mpm_io_scatter_desc_default mpm_io_scatter_desc_default_f32
#define mpm_io_scatter mpm_io_scatter_f32
#define mpm_io_plot_desc_default mpm_io_plot_desc_default_f32
#define mpm_io_plot mpm_io_plot_f32
#endif

#ifndef MPM_IO_PATH
#define MPM_IO_PATH 1024
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- messages ------------------------------------------------------------------------------ */

/* The meaning of a status, as listed in MPM_STATUS_LIST; "unknown status" for any other number.
   Test: 40_io.c "messages". */
MPM_API const char *mpm_io_status_text(mpm_status status);

/* Writes "meaning: field = value (index 12)" into buffer[n], cut to fit and always terminated when
   n > 0. The index (a point, a body or an axis: the field's name says which) is left out when
   negative; "= value" is left out for MPM_ERR_FILE, where the field says what of the file was
   wrong. Returns the length written. Test: 40_io.c "messages". */
MPM_API size_t mpm_io_fault_text(char *buffer, size_t n, const mpm_fault *fault);

/* Writes `value` into buffer[n] (32 bytes always suffice) with the fewest of 15 to 17 digits that
   bring it back exactly, and a decimal point under every locale. Not finite: "nan", "inf" or
   "-inf". Returns the length written. Test: 40_io.c "numbers". */
MPM_API size_t mpm_io_number_text(char *buffer, size_t n, double value);

/* Where a run stands. Counts are of this run: after a restart set first_step. */
typedef struct mpm_io_progress {
    long step, first_step, steps; /* steps done, done before this run, and planned in all */
    double time;                  /* model time, printed as given ... */
    const char *time_unit;        /* ... with this unit; NULL leaves it out */
    double points;                /* points moved in one step */
    double elapsed;               /* seconds since first_step */
} mpm_io_progress;

/* Writes "step 1200/9900  12 %  t = 9.7 ns  1.2e6 points/s  left 0:43" into buffer[n]. The rate and
   the time left appear once a step is done and time has passed. Returns the length written.
   Test: 40_io.c "messages". */
MPM_API size_t mpm_io_progress_text(char *buffer, size_t n, const mpm_io_progress *p);

/* ---- folders ------------------------------------------------------------------------------- */

/* Makes the folder `path` and every missing folder above it. One that exists is fine.
   Returns MPM_ERR_FILE when it cannot be made (or a file is in its place), MPM_ERR_ARGUMENT for an
   empty or too long path. `fault` may be NULL here and below. Test: 40_io.c "folders". */
MPM_API mpm_status mpm_io_make_directory(const char *path, mpm_fault *fault);

/* A file being written: private to the routines below, here because they are held by value. */
typedef struct mpm_io_file {
    FILE *stream;           /* NULL once something failed */
    char path[MPM_IO_PATH]; /* the final name; the stream writes to <path>.part */
} mpm_io_file;

/* ---- JSON ---------------------------------------------------------------------------------- */

/* One JSON object in a file. The calls between begin and end need no checking: an error sticks
   and end returns it. Objects may be nested with open/close, at most eight deep. */
typedef struct mpm_io_json {
    mpm_io_file file;
    int depth;         /* open objects */
    int empty;         /* nothing yet in the innermost object */
    mpm_status status; /* first thing that went wrong */
} mpm_io_json;

/* Starts an object whose first key is "mpm_version". Returns MPM_ERR_FILE when the file cannot be
   made, MPM_ERR_ARGUMENT for a bad path. Test: 40_io.c "json". */
MPM_API mpm_status mpm_io_json_begin(mpm_io_json *j, const char *path, mpm_fault *fault);
/* key: value. A number that is not finite becomes null; `real` prints the digits an mpm_real needs,
   `number` those of a double. */
MPM_API void mpm_io_json_number(mpm_io_json *j, const char *key, double value);
MPM_API void mpm_io_json_real(mpm_io_json *j, const char *key, mpm_real value);
MPM_API void mpm_io_json_integer(mpm_io_json *j, const char *key, long long value);
MPM_API void mpm_io_json_bool(mpm_io_json *j, const char *key, int value);
MPM_API void mpm_io_json_string(mpm_io_json *j, const char *key, const char *value);
/* key: { ... } - the pairs between open and close belong to the inner object. */
MPM_API void mpm_io_json_open(mpm_io_json *j, const char *key);
MPM_API void mpm_io_json_close(mpm_io_json *j);
/* Closes whatever is open and gives the file its name. MPM_ERR_FILE when any write failed,
   MPM_ERR_ARGUMENT when open and close did not match: then there is no file. */
MPM_API mpm_status mpm_io_json_end(mpm_io_json *j, mpm_fault *fault);

/* ---- CSV ----------------------------------------------------------------------------------- */

/* A table with a header line. Errors stick, as with JSON. */
typedef struct mpm_io_csv {
    mpm_io_file file;
    int columns;       /* as counted in the header */
    int cells;         /* written in the present row; the last one of a row ends the line */
    mpm_status status; /* first thing that went wrong */
} mpm_io_csv;

/* Starts a table. `columns` is the header line: names with commas between. A note other than NULL
   comes first, as a line "# mpm.h <version>: <note>". Errors as for JSON. Test: 40_io.c "csv". */
MPM_API mpm_status mpm_io_csv_begin(mpm_io_csv *t, const char *path, const char *columns,
                                    const char *note, mpm_fault *fault);
/* The next cell: a number (not finite: nan, inf, -inf), a whole number, or text (quoted when it
   has to be). After the last column the line ends by itself. */
MPM_API void mpm_io_csv_real(mpm_io_csv *t, mpm_real value);
MPM_API void mpm_io_csv_integer(mpm_io_csv *t, long long value);
MPM_API void mpm_io_csv_text(mpm_io_csv *t, const char *value);
/* A whole row at once: values[columns]. */
MPM_API void mpm_io_csv_row(mpm_io_csv *t, const mpm_real *values);
/* Gives the file its name. MPM_ERR_FILE when a write failed, MPM_ERR_ARGUMENT when the last row is
   not full: then there is no file. */
MPM_API mpm_status mpm_io_csv_end(mpm_io_csv *t, mpm_fault *fault);
/* Instead of end: gives the table up, even in the middle of a row or after an error. What is written so
   far is removed; a file that had the name before stays as it was. Test: 40_io.c "dropped". */
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

/* Fields from their arrays. Test: 40_io.c "vtu". */
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
    size_t count;               /* points, at most 2^31 - 1 */
    const mpm_real *x[3];       /* positions [length]; a NULL axis is written as zero */
    double scale;               /* of positions */
    const mpm_io_field *fields; /* field_count of them */
    int field_count;
    double time;                /* stored as TimeValue */
    int float32;                /* 1: reals as Float32, half the size; 0: as mpm_real */
    const char *note;           /* kept in a comment: what made this file; or NULL */
} mpm_io_vtu_desc;

/* No points, no fields, scale 1, time 0. */
MPM_API mpm_io_vtu_desc mpm_io_vtu_desc_default(void);

/* Writes a VTK XML UnstructuredGrid (.vtu) of one vertex per point, data appended raw.
   MPM_ERR_ARGUMENT for a field without data, name or components; MPM_ERR_FILE. Test: "vtu". */
MPM_API mpm_status mpm_io_vtu(const char *path, const mpm_io_vtu_desc *d, mpm_fault *fault);

/* numbers[world->points.count]: the body of each point, -1 where it is retired. Test: "vtu". */
MPM_API void mpm_io_body_numbers(const mpm_world *world, int32_t *numbers);

/* A time series (.pvd): begin writes an empty one, add appends a frame, given as the name of its
   .vtu relative to the folder of the .pvd. The file is complete after every call. A frame of the
   same name is replaced, so that a restarted run may go on with the series it finds; a missing
   .pvd is begun. MPM_ERR_FILE when it cannot be written or is not one of ours. Test: "pvd". */
MPM_API mpm_status mpm_io_pvd_begin(const char *path, mpm_fault *fault);
MPM_API mpm_status mpm_io_pvd_add(const char *path, const char *frame, double time,
                                  mpm_fault *fault);

/* ---- checkpoints --------------------------------------------------------------------------- */

/* A named stretch of memory. Its bits are stored as they are; a struct that holds pointers must not
   be among them, or its pointers must be set again after reading. */
typedef struct mpm_io_blob {
    const char *name; /* shorter than 64 bytes */
    size_t bytes;
    void *data;       /* read from when writing, written to when reading */
} mpm_io_blob;

/* Writes blobs[count] with version, real size, byte order and a CRC-32 over everything, so that a
   restart is bitwise. Returns MPM_ERR_FILE or MPM_ERR_ARGUMENT. Test: 40_io.c "checkpoint". */
MPM_API mpm_status mpm_io_checkpoint_write(const char *path, const mpm_io_blob *blobs, int count,
                                           mpm_fault *fault);
/* Reads them back: the same names and sizes in the same order. All is verified before the first
   blob is changed. MPM_ERR_VERSION: written by another version of mpm.h, real type or byte order;
   MPM_ERR_FILE: missing, damaged, or holding other blobs (the fault tells which). */
MPM_API mpm_status mpm_io_checkpoint_read(const char *path, const mpm_io_blob *blobs, int count,
                                          mpm_fault *fault);

/* A whole world: fills blobs[MPM_IO_WORLD_BLOBS + world->bodies] with everything its next step
   depends on and returns their number; append blobs of your own behind them. To restart, set the
   world up as before - the same description, the same bodies in the same order - and read.
   Test: 40_io.c "restart": the run goes on bit for bit. */
#define MPM_IO_WORLD_BLOBS 12
MPM_API int mpm_io_world_blobs(mpm_world *world, mpm_io_blob *blobs);

/* ---- pictures ------------------------------------------------------------------------------ */

typedef uint32_t mpm_io_color; /* 0xRRGGBB */

/* An 8-bit RGB picture. `unit` is the size of one design pixel: text, lines and margins of the
   figures scale with it, so that width, height and unit doubled give the same picture, finer. */
typedef struct mpm_io_canvas {
    int width, height;   /* pixels */
    double unit;         /* 1 after init; change at will */
    unsigned char *rgb;  /* 3 width height bytes, row by row from the top */
    unsigned char *mask; /* width height bytes: coverage of the shape being drawn */
    int box[4];          /* the part of the mask in use: left, top, right, bottom */
    int clip[4];         /* where drawing is allowed */
    void *memory;        /* to be freed, or NULL when it is the caller's */
} mpm_io_canvas;

/* Memory needed for width x height pixels; 0 when that is out of range (1 .. 16384 each). */
MPM_API size_t mpm_io_canvas_bytes(int width, int height);
/* A white canvas in the caller's memory, or in allocated memory when `memory` is NULL.
   MPM_ERR_ARGUMENT, MPM_ERR_MEMORY. Test: 40_io.c "png". */
MPM_API mpm_status mpm_io_canvas_init(mpm_io_canvas *c, int width, int height, void *memory,
                                      size_t bytes);
MPM_API void mpm_io_canvas_free(mpm_io_canvas *c);

/* Primitives. Coordinates in pixels; whatever lies outside is cut off. Rectangles have sharp edges
   at the nearest pixel, everything else is smoothed. Test: 40_io.c "drawing". */
MPM_API void mpm_io_canvas_fill(mpm_io_canvas *c, mpm_io_color color);
MPM_API mpm_io_color mpm_io_pixel(const mpm_io_canvas *c, int x, int y);
MPM_API void mpm_io_rectangle(mpm_io_canvas *c, double x, double y, double width, double height,
                              mpm_io_color color);
MPM_API void mpm_io_line(mpm_io_canvas *c, double ax, double ay, double bx, double by,
                         double width, mpm_io_color color);
MPM_API void mpm_io_disc(mpm_io_canvas *c, double x, double y, double radius, mpm_io_color color);

typedef enum mpm_io_align { MPM_IO_LEFT = 0, MPM_IO_CENTER = 1, MPM_IO_RIGHT = 2 } mpm_io_align;

/* Text with its baseline at y, in a stroke font of our own: ASCII and the signs for micro, degree,
   minus, times, middle dot, superscript 2 and 3. Unknown characters show as an empty box. */
MPM_API void mpm_io_text(mpm_io_canvas *c, double x, double y, double size, mpm_io_align align,
                         mpm_io_color color, const char *text);
MPM_API double mpm_io_text_width(double size, const char *text);

/* Writes the picture as PNG; `note` (or NULL) is kept in it as its description. MPM_ERR_FILE,
   MPM_ERR_MEMORY. Test: 40_io.c "png". */
MPM_API mpm_status mpm_io_png(const char *path, const mpm_io_canvas *c, const char *note,
                              mpm_fault *fault);

/* Colour maps of even steps in lightness: DEEP dark blue - teal - yellow; HEAT dark violet - red -
   pale yellow; DIVERGING blue - white - red. */
typedef enum mpm_io_map { MPM_IO_DEEP = 0, MPM_IO_HEAT = 1, MPM_IO_DIVERGING = 2 } mpm_io_map;

/* The colour at t, clamped to 0 .. 1; grey when t is not a number. Test: 40_io.c "colours". */
MPM_API mpm_io_color mpm_io_map_color(mpm_io_map map, double t);
/* Distinct colours for curves and bodies, repeating after eight. */
MPM_API mpm_io_color mpm_io_series_color(int number);

/* ---- figures ------------------------------------------------------------------------------- */

/* Figures are drawn into a part of a canvas, so that any of them can share one picture. */
typedef struct mpm_io_rect { double x, y, width, height; } mpm_io_rect;

/* Tile `number` (row by row from the top left) of a canvas split into columns x rows. */
MPM_API mpm_io_rect mpm_io_tile(const mpm_io_canvas *c, int columns, int rows, int number);

/* A horizontal colour bar over the width of `where`, with ticks and its label below. */
MPM_API void mpm_io_color_bar(mpm_io_canvas *c, mpm_io_rect where, mpm_io_map map, double low,
                              double high, const char *label);

/* How a cut is coloured inside a body: each pixel by its nearest point, or by the mean over the
   points of that body around it. Bodies are never mixed. */
typedef enum mpm_io_style { MPM_IO_SMOOTH = 0, MPM_IO_NEAREST = 1 } mpm_io_style;

/* A cut through a set of points: those within half_thickness of a plane normal to an axis. */
typedef struct mpm_io_cut_desc {
    size_t count;           /* points */
    const mpm_real *x[3];   /* positions [length]; a NULL axis counts as zero */
    const mpm_real *value;  /* colour; NULL colours by body */
    const int32_t *body;    /* body numbers, for edges between bodies; NULL: one body */
    const mpm_world *world; /* the world of these points: body numbers and spacings come from it and
                               retired points are left out; or NULL */
    const mpm_real *size;   /* edge length of each point's cube [length]; NULL: spacing */
    double spacing; /* edge length of a point's cube [length]; 0: that of the point's body */
    int normal;             /* axis normal to the plane: 0 shows y-z, 1 x-z, 2 x-y */
    double at;              /* position of the plane [length] */
    double half_thickness;  /* of the slab [length]; 0: spacing */
    int mirror;             /* 1: also draw the other half, at minus the horizontal coordinate */
    double window[4];       /* xmin, xmax, zmin, zmax to show [length]; all 0: fit to the points */
    mpm_io_map map;
    mpm_io_style style;
    double scale;           /* multiplies the value */
    double low, high;       /* colour range, of the scaled value; equal: fit to the points drawn */
    const char *label;      /* of the colour bar, with units; NULL: no bar */
    const char *title;      /* top left; NULL: none */
    const char *time;       /* top right, e.g. "t = 40 ns"; NULL: none */
    const char *length_unit; /* with the scale bar; NULL: no scale bar */
    double length_scale;    /* printed length = length_scale * length; 1 */
    int ticks;              /* 1: coordinates along the frame instead of a scale bar */
} mpm_io_cut_desc;

/* normal 1, scale 1, map DEEP, style SMOOTH; count, x and spacing must be set ... */
MPM_API mpm_io_cut_desc mpm_io_cut_desc_default(void);
/* ... or taken from a world, with `value` one of its point arrays, for instance
   world->points.plastic_strain (NULL: coloured by body). */
MPM_API mpm_io_cut_desc mpm_io_cut_of(const mpm_world *world, const mpm_real *value);

/* Draws the cut into `where`. MPM_ERR_ARGUMENT (the fault names the field) when something needed is
   missing or no point lies in the slab; MPM_ERR_MEMORY. Test: 40_io.c "cut". */
MPM_API mpm_status mpm_io_cut(mpm_io_canvas *c, mpm_io_rect where, const mpm_io_cut_desc *d,
                              mpm_fault *fault);
/* A picture of `count` cuts in `columns` columns, each panel_width pixels wide and as high as the
   windows ask for. Also MPM_ERR_FILE. Test: 40_io.c "cut". */
MPM_API mpm_status mpm_io_cut_png(const char *path, const mpm_io_cut_desc *d, int count,
                                  int columns, int panel_width, mpm_fault *fault);

/* Discs in a plane, coloured by value: plumes, deposit patterns, correlations. */
typedef struct mpm_io_scatter_desc {
    size_t count;
    const mpm_real *x, *y;
    const mpm_real *value;   /* colour; NULL: one colour */
    const mpm_real *size;    /* diameter of each disc [as x]; NULL: dot pixels for all */
    double dot;              /* diameter in design pixels where size is NULL; 5 */
    int equal;               /* 1: the same scale along x and y */
    double window[4];        /* xmin, xmax, ymin, ymax; all 0: fit */
    mpm_io_map map;
    double scale, low, high; /* as for the cut */
    const char *label, *title, *note; /* colour bar, top left, top right */
    const char *x_label, *y_label;
} mpm_io_scatter_desc;

/* dot 5, equal 1, scale 1. */
MPM_API mpm_io_scatter_desc mpm_io_scatter_desc_default(void);
/* Errors as for the cut. Test: 40_io.c "scatter and plot". */
MPM_API mpm_status mpm_io_scatter(mpm_io_canvas *c, mpm_io_rect where,
                                  const mpm_io_scatter_desc *d, mpm_fault *fault);

typedef enum mpm_io_mark { MPM_IO_CURVE = 0, MPM_IO_DOTS = 1, MPM_IO_DASHED = 2 } mpm_io_mark;

/* One curve or set of dots; not-finite points break it. */
typedef struct mpm_io_curve {
    const char *name; /* in the legend; NULL: not there */
    size_t count;
    const mpm_real *x, *y;
    mpm_io_mark mark;
    int color;        /* number for mpm_io_series_color */
} mpm_io_curve;

typedef struct mpm_io_plot_desc {
    const mpm_io_curve *curves;
    int curve_count;
    double window[4];     /* xmin, xmax, ymin, ymax; a pair of zeros fits that axis */
    int log_x, log_y;     /* 1: decimal logarithm */
    const char *title, *note, *x_label, *y_label; /* note: top right */
} mpm_io_plot_desc;

/* Linear axes, fitted. */
MPM_API mpm_io_plot_desc mpm_io_plot_desc_default(void);
/* MPM_ERR_ARGUMENT when there is nothing to draw. Test: 40_io.c "scatter and plot". */
MPM_API mpm_status mpm_io_plot(mpm_io_canvas *c, mpm_io_rect where, const mpm_io_plot_desc *d,
                               mpm_fault *fault);

#ifdef __cplusplus
}
#endif
#endif /* MPM_IO_H - stop here if you only want the API */

/* ============================================================================================
   IMPLEMENTATION
   ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) || defined(MPM_IO_IMPLEMENTATION)
#ifndef MPM_IO_IMPLEMENTED
#define MPM_IO_IMPLEMENTED

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* C99 cannot make a folder: these are the only lines that know the system. */
#if defined(_WIN32)
#include <direct.h>
#include <errno.h>
#define MPM__IO_MKDIR(path) (_mkdir(path) == 0 || errno == EEXIST)
#elif defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#include <sys/types.h>
static inline int mpm__io_mkdir(const char *path)
{
    struct stat found;
    return mkdir(path, 0777) == 0 || (stat(path, &found) == 0 && S_ISDIR(found.st_mode));
}
#define MPM__IO_MKDIR(path) mpm__io_mkdir(path)
#else
#define MPM__IO_MKDIR(path) ((void)(path), 0)
#endif

#ifndef MPM_MALLOC
#define MPM_MALLOC(n) malloc(n)
#define MPM_FREE(p) free(p)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- messages ------------------------------------------------------------------------------ */

static inline mpm_status mpm__io_fail(mpm_fault *fault, mpm_status status, const char *field,
                                      double value, long number)
{
    if (fault) {
        fault->status = status;
        fault->field = field;
        fault->value = (mpm_real)value;
        fault->index = number;
    }
    return status;
}

/* Copies text to the end of buffer[n], which holds `used` characters; returns the new length. */
static inline size_t mpm__io_append(char *buffer, size_t n, size_t used, const char *text)
{
    while (*text && used + 1 < n) buffer[used++] = *text++;
    if (n) buffer[used] = 0;
    return used;
}

/* Puts a point where the locale put its decimal separator, whatever its bytes: between the digits
   of a printed number there is nothing else. */
static inline void mpm__io_decimal_point(char *text)
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
    if (value != value) return mpm__io_append(buffer, n, 0, "nan");
    if (value - value != 0) return mpm__io_append(buffer, n, 0, value > 0 ? "inf" : "-inf");
    for (digits = most - (single ? 3 : 2); digits <= most; digits++) {
        double back;
        snprintf(text, sizeof text, "%.*g", digits, value);
        back = strtod(text, NULL); /* same locale as snprintf */
        if (single ? (float)back == (float)value : back >= value && back <= value) break;
    }
    mpm__io_decimal_point(text);
    return mpm__io_append(buffer, n, 0, text);
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
    if (value - value == 0) mpm__io_decimal_point(text);
    e = strchr(text, 'e');
    if (e && value - value == 0) {
        long power = strtol(e + 1, NULL, 10);
        snprintf(e + 1, sizeof text - (size_t)(e + 1 - text), "%ld", power);
    }
    mpm__io_append(buffer, n, 0, text);
}

MPM_API const char *mpm_io_status_text(mpm_status status)
{
    switch ((int)status) {
#define MPM__IO_STATUS_CASE(name, number, text) case number: return text;
        MPM_STATUS_LIST(MPM__IO_STATUS_CASE)
#undef MPM__IO_STATUS_CASE
    default: return "unknown status";
    }
}

MPM_API size_t mpm_io_fault_text(char *buffer, size_t n, const mpm_fault *fault)
{
    char number[40];
    size_t used = mpm__io_append(buffer, n, 0, mpm_io_status_text(fault->status));
    if (fault->field) {
        used = mpm__io_append(buffer, n, used, ": ");
        used = mpm__io_append(buffer, n, used, fault->field);
        if (fault->status != MPM_ERR_FILE) {
            mpm__io_print_real(number, sizeof number, fault->value);
            used = mpm__io_append(buffer, n, used, " = ");
            used = mpm__io_append(buffer, n, used, number);
        }
    }
    if (fault->index >= 0) {
        snprintf(number, sizeof number, " (index %ld)", fault->index);
        used = mpm__io_append(buffer, n, used, number);
    }
    return used;
}

/* Seconds as m:ss or h:mm:ss. */
static inline void mpm__io_clock(char *buffer, size_t n, double seconds)
{
    long s = seconds < 1e8 ? (long)(seconds + 0.5) : 100000000L;
    if (s < 3600) snprintf(buffer, n, "%ld:%02ld", s / 60, s % 60);
    else snprintf(buffer, n, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

MPM_API size_t mpm_io_progress_text(char *buffer, size_t n, const mpm_io_progress *p)
{
    char text[96], number[40];
    double done = (double)(p->step - p->first_step);
    size_t used;
    snprintf(text, sizeof text, "step %ld/%ld  %ld %%", p->step, p->steps,
             p->steps > 0 ? (long)(100.0 * (double)p->step / (double)p->steps) : 0L);
    used = mpm__io_append(buffer, n, 0, text);
    if (p->time_unit) {
        mpm__io_short(number, sizeof number, p->time, 4);
        snprintf(text, sizeof text, "  t = %.24s %.24s", number, p->time_unit);
        used = mpm__io_append(buffer, n, used, text);
    }
    if (done > 0 && p->elapsed > 0) {
        mpm__io_short(number, sizeof number, p->points * done / p->elapsed, 2);
        snprintf(text, sizeof text, "  %.32s points/s", number);
        used = mpm__io_append(buffer, n, used, text);
        mpm__io_clock(number, sizeof number, p->elapsed * (double)(p->steps - p->step) / done);
        snprintf(text, sizeof text, "  left %.32s", number);
        used = mpm__io_append(buffer, n, used, text);
    }
    return used;
}

/* ---- folders and files --------------------------------------------------------------------- */

MPM_API mpm_status mpm_io_make_directory(const char *path, mpm_fault *fault)
{
    char part[MPM_IO_PATH];
    size_t i, length = path ? strlen(path) : 0;
    if (length == 0 || length >= sizeof part)
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "length of folder path", (double)length, -1);
    for (i = 1; i <= length; i++) {
        if (path[i] != 0 && path[i] != '/' && path[i] != '\\') continue;
        memcpy(part, path, i);
        part[i] = 0;
        if (part[i - 1] == ':') continue; /* a drive, "C:" */
        if (!MPM__IO_MKDIR(part)) return mpm__io_fail(fault, MPM_ERR_FILE, "folder path", 0, -1);
    }
    return MPM_OK;
}

/* The name a file has until it is complete. */
static inline void mpm__io_part_name(char part[MPM_IO_PATH + 8], const char *path)
{
    size_t used = mpm__io_append(part, MPM_IO_PATH + 8, 0, path);
    mpm__io_append(part, MPM_IO_PATH + 8, used, ".part");
}

static inline mpm_status mpm__io_open(mpm_io_file *f, const char *path, mpm_fault *fault)
{
    char part[MPM_IO_PATH + 8];
    size_t length = path ? strlen(path) : 0;
    f->stream = NULL;
    f->path[0] = 0;
    if (length == 0 || length >= MPM_IO_PATH)
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "length of path", (double)length, -1);
    memcpy(f->path, path, length + 1);
    mpm__io_part_name(part, path);
    f->stream = fopen(part, "wb");
    return f->stream ? MPM_OK : mpm__io_fail(fault, MPM_ERR_FILE, "path: cannot be made", 0, -1);
}

/* Closes the file and, if `keep` and every write went well, gives it its final name. */
static inline mpm_status mpm__io_close(mpm_io_file *f, int keep, mpm_fault *fault)
{
    char part[MPM_IO_PATH + 8];
    int good;
    if (!f->stream) return mpm__io_fail(fault, MPM_ERR_FILE, "path: not open", 0, -1);
    mpm__io_part_name(part, f->path);
    good = fflush(f->stream) == 0 && !ferror(f->stream);
    good = fclose(f->stream) == 0 && good;
    f->stream = NULL;
#ifdef _WIN32
    if (keep && good) remove(f->path); /* rename does not replace there */
#endif
    if (keep && good && rename(part, f->path) == 0) return MPM_OK;
    remove(part);
    if (!keep) return MPM_OK;
    return mpm__io_fail(fault, MPM_ERR_FILE,
                        good ? "path: cannot be renamed" : "path: writing failed", 0, -1);
}

static inline void mpm__io_put(mpm_io_file *f, const char *text)
{
    if (f->stream) fputs(text, f->stream);
}

static inline void mpm__io_put_number(mpm_io_file *f, double value)
{
    char text[40];
    mpm_io_number_text(text, sizeof text, value);
    mpm__io_put(f, text);
}

static inline void mpm__io_put_integer(mpm_io_file *f, long long value)
{
    char text[40];
    snprintf(text, sizeof text, "%lld", value);
    mpm__io_put(f, text);
}

/* ---- JSON ---------------------------------------------------------------------------------- */

/* A JSON string: quotes, backslashes and control characters escaped. */
static inline void mpm__io_json_quoted(mpm_io_json *j, const char *text)
{
    char escape[8];
    FILE *out = j->file.stream;
    if (!out) return;
    fputc('"', out);
    for (; *text; text++) {
        unsigned char ch = (unsigned char)*text;
        if (ch == '"' || ch == '\\') fputc('\\', out);
        if (ch >= 32) fputc(ch, out);
        else {
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)ch);
            fputs(escape, out);
        }
    }
    fputc('"', out);
}

/* Comma, new line, indentation and the key of the next pair. */
static inline void mpm__io_json_key(mpm_io_json *j, const char *key)
{
    int i;
    mpm__io_put(&j->file, j->empty ? "\n" : ",\n");
    for (i = 0; i < j->depth; i++) mpm__io_put(&j->file, "  ");
    mpm__io_json_quoted(j, key ? key : "");
    mpm__io_put(&j->file, ": ");
    j->empty = 0;
}

MPM_API mpm_status mpm_io_json_begin(mpm_io_json *j, const char *path, mpm_fault *fault)
{
    j->depth = 1;
    j->empty = 1;
    j->status = mpm__io_open(&j->file, path, fault);
    if (j->status < 0) return j->status;
    mpm__io_put(&j->file, "{");
    mpm_io_json_string(j, "mpm_version", MPM_VERSION);
    return MPM_OK;
}

MPM_API void mpm_io_json_number(mpm_io_json *j, const char *key, double value)
{
    mpm__io_json_key(j, key);
    if (value - value != 0) mpm__io_put(&j->file, "null");
    else mpm__io_put_number(&j->file, value);
}

MPM_API void mpm_io_json_real(mpm_io_json *j, const char *key, mpm_real value)
{
    char text[40];
    mpm__io_print_real(text, sizeof text, value);
    mpm__io_json_key(j, key);
    mpm__io_put(&j->file, value - value != 0 ? "null" : text);
}

MPM_API void mpm_io_json_integer(mpm_io_json *j, const char *key, long long value)
{
    mpm__io_json_key(j, key);
    mpm__io_put_integer(&j->file, value);
}

MPM_API void mpm_io_json_bool(mpm_io_json *j, const char *key, int value)
{
    mpm__io_json_key(j, key);
    mpm__io_put(&j->file, value ? "true" : "false");
}

MPM_API void mpm_io_json_string(mpm_io_json *j, const char *key, const char *value)
{
    mpm__io_json_key(j, key);
    if (value) mpm__io_json_quoted(j, value);
    else mpm__io_put(&j->file, "null");
}

MPM_API void mpm_io_json_open(mpm_io_json *j, const char *key)
{
    mpm__io_json_key(j, key);
    mpm__io_put(&j->file, "{");
    j->empty = 1;
    if (++j->depth > 8) j->status = MPM_ERR_ARGUMENT;
}

MPM_API void mpm_io_json_close(mpm_io_json *j)
{
    int i;
    if (--j->depth < 1) j->status = MPM_ERR_ARGUMENT;
    mpm__io_put(&j->file, j->empty ? "" : "\n");
    for (i = 0; i < j->depth && !j->empty; i++) mpm__io_put(&j->file, "  ");
    mpm__io_put(&j->file, "}");
    j->empty = 0;
}

MPM_API mpm_status mpm_io_json_end(mpm_io_json *j, mpm_fault *fault)
{
    if (j->file.stream && (j->status < 0 || j->depth != 1)) {
        mpm__io_close(&j->file, 0, NULL);
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "depth of json object", j->depth, -1);
    }
    mpm__io_put(&j->file, "\n}\n");
    return mpm__io_close(&j->file, 1, fault);
}

/* ---- CSV ----------------------------------------------------------------------------------- */

MPM_API mpm_status mpm_io_csv_begin(mpm_io_csv *t, const char *path, const char *columns,
                                    const char *note, mpm_fault *fault)
{
    const char *p;
    t->columns = 1;
    t->cells = 0;
    t->status = mpm__io_open(&t->file, path, fault);
    if (t->status < 0) return t->status;
    for (p = columns; *p; p++) t->columns += *p == ',';
    if (note) {
        mpm__io_put(&t->file, "# mpm.h " MPM_VERSION ": ");
        for (p = note; *p; p++) fputc(*p == '\n' || *p == '\r' ? ' ' : *p, t->file.stream);
        mpm__io_put(&t->file, "\n");
    }
    mpm__io_put(&t->file, columns);
    mpm__io_put(&t->file, "\n");
    return MPM_OK;
}

static inline void mpm__io_csv_cell(mpm_io_csv *t, const char *text)
{
    mpm__io_put(&t->file, text);
    t->cells = (t->cells + 1) % t->columns;
    mpm__io_put(&t->file, t->cells == 0 ? "\n" : ",");
}

MPM_API void mpm_io_csv_real(mpm_io_csv *t, mpm_real value)
{
    char text[40];
    mpm__io_print_real(text, sizeof text, value);
    mpm__io_csv_cell(t, text);
}

MPM_API void mpm_io_csv_integer(mpm_io_csv *t, long long value)
{
    mpm__io_put_integer(&t->file, value);
    mpm__io_csv_cell(t, "");
}

MPM_API void mpm_io_csv_text(mpm_io_csv *t, const char *value)
{
    int quote = strpbrk(value, ",\"\r\n") != NULL;
    if (quote) mpm__io_put(&t->file, "\"");
    for (; *value && t->file.stream; value++) {
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
    if (t->file.stream && t->cells != 0) {
        mpm__io_close(&t->file, 0, NULL);
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "cells in the last row", t->cells, -1);
    }
    return mpm__io_close(&t->file, 1, fault);
}

MPM_API void mpm_io_csv_drop(mpm_io_csv *t) { mpm__io_close(&t->file, 0, NULL); }

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
    return d;
}

/* XML text: the five reserved characters escaped, "--" broken up so that a comment stays one. */
static inline void mpm__io_put_xml(mpm_io_file *f, const char *text)
{
    for (; *text && f->stream; text++) {
        switch (*text) {
        case '&': mpm__io_put(f, "&amp;"); break;
        case '<': mpm__io_put(f, "&lt;"); break;
        case '>': mpm__io_put(f, "&gt;"); break;
        case '"': mpm__io_put(f, "&quot;"); break;
        case '\'': mpm__io_put(f, "&apos;"); break;
        case '-': mpm__io_put(f, text[1] == '-' ? "- " : "-"); break;
        default: fputc(*text, f->stream);
        }
    }
}

/* One real of a field, converted and scaled, as the bytes of the file. */
static inline void mpm__io_put_real(mpm_io_file *f, mpm_real value, double scale, int float32)
{
    float small;
    if (scale < 1 || scale > 1) value = (mpm_real)((double)value * scale);
    small = (float)value;
    if (float32) fwrite(&small, sizeof small, 1, f->stream);
    else fwrite(&value, sizeof value, 1, f->stream);
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
    if (f->bytes) fwrite(f->bytes, 1, count, file->stream);
    else if (f->integers) fwrite(f->integers, 4, count, file->stream);
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
    mpm__io_put(f, "        <DataArray type=\"");
    mpm__io_put(f, type);
    mpm__io_put(f, "\" Name=\"");
    mpm__io_put_xml(f, name);
    mpm__io_put(f, "\" NumberOfComponents=\"");
    mpm__io_put_integer(f, components);
    mpm__io_put(f, "\" format=\"appended\" offset=\"");
    mpm__io_put_integer(f, (long long)*offset);
    mpm__io_put(f, "\"/>\n");
    *offset += 8 + bytes;
}

static inline mpm_status mpm__io_vtu_check(const mpm_io_vtu_desc *d, mpm_fault *fault)
{
    int i, k;
    if (d->count > 2147483647u)
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "count", (double)d->count, -1);
    if (d->field_count < 0 || (d->field_count > 0 && !d->fields))
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "field_count", d->field_count, -1);
    for (i = 0; i < d->field_count; i++) {
        const mpm_io_field *f = &d->fields[i];
        if (!f->name) return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "name of field", 0, i);
        if (f->components < 1 || f->components > 9)
            return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "components of field", f->components, i);
        if ((f->bytes || f->integers) && f->components != 1)
            return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "components of field", f->components, i);
        for (k = 0; k < f->components && !f->bytes && !f->integers && d->count > 0; k++)
            if (!f->data[k]) return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "data of field", k, i);
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
    uint64_t n = d->count, offset = 0;
    int i;
    mpm__io_put(f, "<?xml version=\"1.0\"?>\n<!-- mpm.h " MPM_VERSION " ");
    if (d->note) mpm__io_put_xml(f, d->note);
    mpm__io_put(f, " -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"");
    mpm__io_put(f, mpm__io_little_endian() ? "LittleEndian" : "BigEndian");
    mpm__io_put(f, "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <FieldData>\n"
                   "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\""
                   " format=\"ascii\">");
    mpm__io_put_number(f, d->time);
    mpm__io_put(f, "</DataArray>\n    </FieldData>\n    <Piece NumberOfPoints=\"");
    mpm__io_put_integer(f, (long long)n);
    mpm__io_put(f, "\" NumberOfCells=\"");
    mpm__io_put_integer(f, (long long)n);
    mpm__io_put(f, "\">\n      <Points>\n");
    mpm__io_data_tag(f, type, "Points", 3, 3 * n * real, &offset);
    mpm__io_put(f, "      </Points>\n      <Cells>\n");
    mpm__io_data_tag(f, "Int32", "connectivity", 1, 4 * n, &offset);
    mpm__io_data_tag(f, "Int32", "offsets", 1, 4 * n, &offset);
    mpm__io_data_tag(f, "UInt8", "types", 1, n, &offset);
    mpm__io_put(f, "      </Cells>\n      <PointData>\n");
    for (i = 0; i < d->field_count; i++) {
        const mpm_io_field *a = &d->fields[i];
        mpm__io_data_tag(f, a->bytes ? "UInt8" : a->integers ? "Int32" : type, a->name,
                         a->components, mpm__io_field_bytes(a, d->count, real), &offset);
    }
    mpm__io_put(f, "      </PointData>\n    </Piece>\n  </UnstructuredGrid>\n"
                   "  <AppendedData encoding=\"raw\">\n_");
}

/* The appended data, in the order of the tags. */
static inline void mpm__io_vtu_body(mpm_io_file *f, const mpm_io_vtu_desc *d, size_t real)
{
    mpm_io_field points = mpm_io_vector("Points", d->x[0], d->x[1], d->x[2], d->scale);
    uint64_t bytes = mpm__io_field_bytes(&points, d->count, real);
    int32_t i, n = (int32_t)d->count;
    int k;
    fwrite(&bytes, 8, 1, f->stream);
    mpm__io_field_values(f, &points, d->count, d->float32);
    for (k = 0; k < 2; k++) { /* connectivity 0 .. n - 1, then offsets 1 .. n */
        bytes = 4 * (uint64_t)d->count;
        fwrite(&bytes, 8, 1, f->stream);
        for (i = 0; i < n; i++) {
            int32_t number = i + k;
            fwrite(&number, 4, 1, f->stream);
        }
    }
    bytes = d->count;
    fwrite(&bytes, 8, 1, f->stream);
    for (i = 0; i < n; i++) fputc(1, f->stream); /* VTK_VERTEX */
    for (k = 0; k < d->field_count; k++) {
        bytes = mpm__io_field_bytes(&d->fields[k], d->count, real);
        fwrite(&bytes, 8, 1, f->stream);
        mpm__io_field_values(f, &d->fields[k], d->count, d->float32);
    }
}

MPM_API mpm_status mpm_io_vtu(const char *path, const mpm_io_vtu_desc *d, mpm_fault *fault)
{
    mpm_io_file f;
    size_t real = d->float32 ? sizeof(float) : sizeof(mpm_real);
    mpm_status status = mpm__io_vtu_check(d, fault);
    if (status < 0) return status;
    status = mpm__io_open(&f, path, fault);
    if (status < 0) return status;
    mpm__io_vtu_head(&f, d, real);
    mpm__io_vtu_body(&f, d, real);
    mpm__io_put(&f, "\n  </AppendedData>\n</VTKFile>\n");
    return mpm__io_close(&f, 1, fault);
}

#define MPM__IO_PVD_HEAD                                                            \
    "<?xml version=\"1.0\"?>\n<!-- mpm.h " MPM_VERSION " -->\n"                       \
    "<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n"
#define MPM__IO_PVD_TAIL "  </Collection>\n</VTKFile>\n"

MPM_API mpm_status mpm_io_pvd_begin(const char *path, mpm_fault *fault)
{
    mpm_io_file f;
    mpm_status status = mpm__io_open(&f, path, fault);
    if (status < 0) return status;
    mpm__io_put(&f, MPM__IO_PVD_HEAD MPM__IO_PVD_TAIL);
    return mpm__io_close(&f, 1, fault);
}

/* Copies the frames of an earlier file, all but the one of the same name. Each is one line that
   ends in file="name"/>; returns 0 when the file is not of that make. */
static inline int mpm__io_pvd_copy(mpm_io_file *to, FILE *from, const char *ending)
{
    char line[2 * MPM_IO_PATH + 128];
    int in_collection = 0;
    while (fgets(line, (int)sizeof line, from)) {
        size_t length = strlen(line), tail = strlen(ending);
        if (strstr(line, "</Collection>")) return in_collection;
        if (in_collection && line[length - 1] != '\n') return 0;
        if (in_collection && (length < tail || strcmp(line + length - tail, ending) != 0))
            mpm__io_put(to, line);
        if (strstr(line, "<Collection>")) in_collection = 1;
    }
    return 0;
}

MPM_API mpm_status mpm_io_pvd_add(const char *path, const char *frame, double time,
                                  mpm_fault *fault)
{
    char ending[MPM_IO_PATH + 16];
    mpm_io_file f;
    FILE *old;
    size_t used;
    mpm_status status;
    if (!frame || frame[0] == 0 || strlen(frame) >= MPM_IO_PATH || strpbrk(frame, "<>&\"'\n"))
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "name of frame", 0, -1);
    status = mpm__io_open(&f, path, fault);
    if (status < 0) return status;
    used = mpm__io_append(ending, sizeof ending, 0, "file=\"");
    used = mpm__io_append(ending, sizeof ending, used, frame);
    mpm__io_append(ending, sizeof ending, used, "\"/>\n");
    mpm__io_put(&f, MPM__IO_PVD_HEAD);
    old = fopen(path, "rb");
    if (old) {
        int good = mpm__io_pvd_copy(&f, old, ending);
        fclose(old);
        if (!good) {
            mpm__io_close(&f, 0, NULL);
            return mpm__io_fail(fault, MPM_ERR_FILE, "path: not a series of ours", 0, -1);
        }
    }
    mpm__io_put(&f, "    <DataSet timestep=\"");
    mpm__io_put_number(&f, time);
    mpm__io_put(&f, "\" part=\"0\" ");
    mpm__io_put(&f, ending);
    mpm__io_put(&f, MPM__IO_PVD_TAIL);
    return mpm__io_close(&f, 1, fault);
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

/* The head of each blob; its bytes follow. */
typedef struct mpm__io_blob_head {
    char name[64];
    uint64_t bytes;
} mpm__io_blob_head;

static inline mpm__io_stamp mpm__io_stamp_make(int count)
{
    mpm__io_stamp s;
    memset(&s, 0, sizeof s);
    mpm__io_append(s.magic, sizeof s.magic, 0, "mpm checkpoint");
    mpm__io_append(s.version, sizeof s.version, 0, MPM_VERSION);
    s.order = 0x01020304;
    s.real_size = (uint32_t)sizeof(mpm_real);
    s.count = (uint32_t)count;
    s.size_size = (uint32_t)sizeof(size_t);
    return s;
}

static inline mpm__io_blob_head mpm__io_blob_head_make(const mpm_io_blob *b)
{
    mpm__io_blob_head h;
    memset(&h, 0, sizeof h);
    mpm__io_append(h.name, sizeof h.name, 0, b->name);
    h.bytes = b->bytes;
    return h;
}

static inline mpm_status mpm__io_blobs_check(const mpm_io_blob *blobs, int count, mpm_fault *fault)
{
    int i;
    if (count < 0 || (count > 0 && !blobs))
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "count of blobs", count, -1);
    for (i = 0; i < count; i++) {
        if (!blobs[i].name || strlen(blobs[i].name) >= 64)
            return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "name of blob", 0, i);
        if (!blobs[i].data && blobs[i].bytes > 0)
            return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "data of blob", 0, i);
    }
    return MPM_OK;
}

/* Writes bytes and carries the checksum along. */
static inline uint32_t mpm__io_put_summed(mpm_io_file *f, uint32_t crc, const void *data, size_t n)
{
    if (n > 0) fwrite(data, 1, n, f->stream);
    return mpm__io_crc(crc, data, n);
}

MPM_API mpm_status mpm_io_checkpoint_write(const char *path, const mpm_io_blob *blobs, int count,
                                           mpm_fault *fault)
{
    mpm_io_file f;
    mpm__io_stamp stamp = mpm__io_stamp_make(count);
    uint32_t crc;
    int i;
    mpm_status status = mpm__io_blobs_check(blobs, count, fault);
    if (status < 0) return status;
    status = mpm__io_open(&f, path, fault);
    if (status < 0) return status;
    crc = mpm__io_put_summed(&f, 0, &stamp, sizeof stamp);
    for (i = 0; i < count; i++) {
        mpm__io_blob_head head = mpm__io_blob_head_make(&blobs[i]);
        crc = mpm__io_put_summed(&f, crc, &head, sizeof head);
        crc = mpm__io_put_summed(&f, crc, blobs[i].data, blobs[i].bytes);
    }
    fwrite(&crc, sizeof crc, 1, f.stream);
    return mpm__io_close(&f, 1, fault);
}

/* Reads n bytes past, adding them to the checksum; 0 when the file ends early. */
static inline int mpm__io_skip_summed(FILE *in, size_t n, uint32_t *crc)
{
    unsigned char buffer[4096];
    while (n > 0) {
        size_t part = n < sizeof buffer ? n : sizeof buffer;
        if (fread(buffer, 1, part, in) != part) return 0;
        *crc = mpm__io_crc(*crc, buffer, part);
        n -= part;
    }
    return 1;
}

/* Compares stamp, names, sizes and checksum with what is asked for; changes nothing. */
static inline mpm_status mpm__io_checkpoint_verify(FILE *in, const mpm_io_blob *blobs, int count,
                                                   mpm_fault *fault)
{
    mpm__io_stamp found, mine = mpm__io_stamp_make(count);
    uint32_t crc, stored;
    int i;
    if (fread(&found, sizeof found, 1, in) != 1 || memcmp(found.magic, mine.magic, 16) != 0)
        return mpm__io_fail(fault, MPM_ERR_FILE, "path: not a checkpoint", 0, -1);
    if (memcmp(found.version, mine.version, 16) != 0)
        return mpm__io_fail(fault, MPM_ERR_VERSION, "version of checkpoint", 0, -1);
    if (found.order != mine.order)
        return mpm__io_fail(fault, MPM_ERR_VERSION, "byte order of checkpoint", 0, -1);
    if (found.real_size != mine.real_size)
        return mpm__io_fail(fault, MPM_ERR_VERSION, "real size of checkpoint", found.real_size, -1);
    if (found.size_size != mine.size_size)
        return mpm__io_fail(fault, MPM_ERR_VERSION, "word size of checkpoint", found.size_size, -1);
    if (found.count != mine.count)
        return mpm__io_fail(fault, MPM_ERR_FILE, "count of blobs differs", found.count, -1);
    crc = mpm__io_crc(0, &found, sizeof found);
    for (i = 0; i < count; i++) {
        mpm__io_blob_head head, want = mpm__io_blob_head_make(&blobs[i]);
        if (fread(&head, sizeof head, 1, in) != 1)
            return mpm__io_fail(fault, MPM_ERR_FILE, "checkpoint ends early", 0, i);
        if (memcmp(head.name, want.name, sizeof head.name) != 0 || head.bytes != want.bytes)
            return mpm__io_fail(fault, MPM_ERR_FILE, "name or size of blob differs", 0, i);
        crc = mpm__io_crc(crc, &head, sizeof head);
        if (!mpm__io_skip_summed(in, blobs[i].bytes, &crc))
            return mpm__io_fail(fault, MPM_ERR_FILE, "checkpoint ends early", 0, i);
    }
    if (fread(&stored, sizeof stored, 1, in) != 1 || fgetc(in) != EOF)
        return mpm__io_fail(fault, MPM_ERR_FILE, "length of checkpoint", 0, -1);
    if (stored != crc) return mpm__io_fail(fault, MPM_ERR_FILE, "checksum of checkpoint", 0, -1);
    return MPM_OK;
}

MPM_API mpm_status mpm_io_checkpoint_read(const char *path, const mpm_io_blob *blobs, int count,
                                          mpm_fault *fault)
{
    FILE *in;
    int i, good = 1;
    mpm_status status = mpm__io_blobs_check(blobs, count, fault);
    if (status < 0) return status;
    in = path ? fopen(path, "rb") : NULL;
    if (!in) return mpm__io_fail(fault, MPM_ERR_FILE, "path: cannot be read", 0, -1);
    status = mpm__io_checkpoint_verify(in, blobs, count, fault);
    if (status == MPM_OK) {
        good = fseek(in, (long)sizeof(mpm__io_stamp), SEEK_SET) == 0;
        for (i = 0; i < count && good; i++) {
            good = fseek(in, (long)sizeof(mpm__io_blob_head), SEEK_CUR) == 0;
            if (good && blobs[i].bytes > 0)
                good = fread(blobs[i].data, 1, blobs[i].bytes, in) == blobs[i].bytes;
        }
    }
    fclose(in);
    if (!good) return mpm__io_fail(fault, MPM_ERR_FILE, "path: reading failed", 0, -1);
    return status;
}

static inline mpm_io_blob mpm__io_blob(const char *name, void *data, size_t bytes)
{
    mpm_io_blob b;
    b.name = name;
    b.bytes = bytes;
    b.data = data;
    return b;
}

MPM_API int mpm_io_world_blobs(mpm_world *w, mpm_io_blob *blobs)
{
    size_t points = (size_t)w->points.capacity, reals = w->stride * (size_t)w->fields;
    int n = 0;
    int32_t i;
    blobs[n++] = mpm__io_blob("point fields", w->field, reals * sizeof(mpm_real));
    blobs[n++] = mpm__io_blob("point flags", w->points.flags, points);
    blobs[n++] = mpm__io_blob("point ids", w->points.id, points * sizeof(int32_t));
    blobs[n++] = mpm__io_blob("point count", &w->points.count, sizeof w->points.count);
    blobs[n++] = mpm__io_blob("time", &w->time, sizeof w->time);
    blobs[n++] = mpm__io_blob("steps", &w->steps, sizeof w->steps);
    blobs[n++] = mpm__io_blob("ledger", &w->ledger, sizeof w->ledger);
    blobs[n++] = mpm__io_blob("retired", &w->retired, sizeof w->retired);
    blobs[n++] = mpm__io_blob("sorts", &w->sorts, sizeof w->sorts);
    blobs[n++] = mpm__io_blob("notices", &w->notices, sizeof w->notices);
    blobs[n++] = mpm__io_blob("held", &w->held, sizeof w->held);
    blobs[n++] = mpm__io_blob("sorted runs", &w->sorted_runs, sizeof w->sorted_runs);
    for (i = 0; i < w->bodies; i++)
        blobs[n++] = mpm__io_blob("active points", &w->body[i].active, sizeof w->body[i].active);
    return n;
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
    fwrite(number, 1, 4, f->stream);
    fwrite(type, 1, 4, f->stream);
    if (n > 0) fwrite(body, 1, n, f->stream);
    mpm__io_big_endian(number, mpm__io_crc(mpm__io_crc(0, type, 4), body, n));
    fwrite(number, 1, 4, f->stream);
}

static inline void mpm__io_zip_byte(mpm__io_zip *z, unsigned value)
{
    z->out[z->used++] = (unsigned char)value;
    if (z->used < sizeof z->out) return;
    mpm__io_png_chunk(z->file, "IDAT", z->out, z->used);
    z->used = 0;
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
    if (z->used > 0) mpm__io_png_chunk(z->file, "IDAT", z->out, z->used);
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
static inline void mpm__io_filter_all(const mpm_io_canvas *c, unsigned char *out)
{
    int n = 3 * c->width, y, kind;
    for (y = 0; y < c->height; y++) {
        const unsigned char *row = c->rgb + (size_t)y * (size_t)n;
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

/* A tEXt chunk: keyword, zero, text of at most 900 bytes. */
static inline void mpm__io_png_text(mpm_io_file *f, const char *keyword, const char *text)
{
    char body[1000];
    size_t key = strlen(keyword) + 1;
    memcpy(body, keyword, key);
    mpm__io_png_chunk(f, "tEXt", body, key + mpm__io_append(body + key, 900, 0, text));
}

MPM_API mpm_status mpm_io_png(const char *path, const mpm_io_canvas *c, const char *note,
                              mpm_fault *fault)
{
    unsigned char header[13] = {0};
    size_t raw = ((size_t)c->width * 3 + 1) * (size_t)c->height;
    mpm_io_file f;
    mpm__io_zip *z;
    mpm_status status = mpm__io_open(&f, path, fault);
    if (status < 0) return status;
    z = (mpm__io_zip *)MPM_MALLOC(sizeof *z + raw);
    if (!z) {
        mpm__io_close(&f, 0, NULL);
        return mpm__io_fail(fault, MPM_ERR_MEMORY, "bytes for picture", (double)(sizeof *z + raw),
                            -1);
    }
    memset(z, 0, sizeof *z);
    z->file = &f;
    mpm__io_filter_all(c, (unsigned char *)(z + 1));
    mpm__io_put(&f, "\x89PNG\r\n\x1a\n");
    mpm__io_big_endian(header, (uint32_t)c->width);
    mpm__io_big_endian(header + 4, (uint32_t)c->height);
    header[8] = 8; /* bits per sample */
    header[9] = 2; /* RGB */
    mpm__io_png_chunk(&f, "IHDR", header, sizeof header);
    mpm__io_png_text(&f, "Software", "mpm.h " MPM_VERSION);
    if (note) mpm__io_png_text(&f, "Description", note);
    mpm__io_zip_all(z, (const unsigned char *)(z + 1), (int32_t)raw);
    mpm__io_png_chunk(&f, "IEND", NULL, 0);
    MPM_FREE(z);
    return mpm__io_close(&f, 1, fault);
}

/* ---- canvas -------------------------------------------------------------------------------- */

MPM_API size_t mpm_io_canvas_bytes(int width, int height)
{
    if (width < 1 || height < 1 || width > 16384 || height > 16384) return 0;
    return (size_t)width * (size_t)height * 4;
}

static inline void mpm__io_clip(mpm_io_canvas *c, double left, double top, double right,
                                double bottom);

MPM_API mpm_status mpm_io_canvas_init(mpm_io_canvas *c, int width, int height, void *memory,
                                      size_t bytes)
{
    size_t need = mpm_io_canvas_bytes(width, height), pixels = need / 4;
    memset(c, 0, sizeof *c);
    if (need == 0) return MPM_ERR_ARGUMENT;
    if (memory && bytes < need) return MPM_ERR_MEMORY;
    if (!memory) c->memory = memory = MPM_MALLOC(need);
    if (!memory) return MPM_ERR_MEMORY;
    c->width = width;
    c->height = height;
    c->unit = 1;
    c->rgb = (unsigned char *)memory;
    c->mask = c->rgb + 3 * pixels;
    memset(c->rgb, 255, 3 * pixels);
    memset(c->mask, 0, pixels);
    mpm__io_clip(c, 0, 0, width, height);
    return MPM_OK;
}

MPM_API void mpm_io_canvas_free(mpm_io_canvas *c)
{
    if (c->memory) MPM_FREE(c->memory);
    memset(c, 0, sizeof *c);
}

/* The nearest whole number, kept within low .. high whatever the value. */
static inline int mpm__io_whole(double value, int low, int high)
{
    if (!(value > low)) return low;
    return value < high ? (int)(value + 0.5) : high;
}

/* Limits drawing to a part of the canvas, and forgets the box in use. */
static inline void mpm__io_clip(mpm_io_canvas *c, double left, double top, double right,
                                double bottom)
{
    c->clip[0] = mpm__io_whole(left, 0, c->width);
    c->clip[1] = mpm__io_whole(top, 0, c->height);
    c->clip[2] = mpm__io_whole(right, 0, c->width);
    c->clip[3] = mpm__io_whole(bottom, 0, c->height);
    c->box[0] = c->width;
    c->box[1] = c->height;
    c->box[2] = c->box[3] = 0;
}

static inline void mpm__io_clip_none(mpm_io_canvas *c)
{
    mpm__io_clip(c, 0, 0, c->width, c->height);
}

static inline void mpm__io_set(unsigned char *p, mpm_io_color color)
{
    p[0] = (unsigned char)(color >> 16);
    p[1] = (unsigned char)(color >> 8);
    p[2] = (unsigned char)color;
}

/* From a to b as t goes from 0 to 1. */
static inline mpm_io_color mpm__io_blend(mpm_io_color a, mpm_io_color b, double t)
{
    mpm_io_color result = 0;
    int shift;
    for (shift = 16; shift >= 0; shift -= 8) {
        double from = (double)(a >> shift & 255), to = (double)(b >> shift & 255);
        result |= (mpm_io_color)(from + (to - from) * t + 0.5) << shift;
    }
    return result;
}

MPM_API void mpm_io_rectangle(mpm_io_canvas *c, double x, double y, double width, double height,
                              mpm_io_color color)
{
    int left = mpm__io_whole(x, c->clip[0], c->clip[2]);
    int right = mpm__io_whole(x + width, c->clip[0], c->clip[2]);
    int top = mpm__io_whole(y, c->clip[1], c->clip[3]);
    int bottom = mpm__io_whole(y + height, c->clip[1], c->clip[3]), i, j;
    for (j = top; j < bottom; j++)
        for (i = left; i < right; i++)
            mpm__io_set(c->rgb + 3 * ((size_t)j * (size_t)c->width + (size_t)i), color);
}

MPM_API void mpm_io_canvas_fill(mpm_io_canvas *c, mpm_io_color color)
{
    mpm_io_rectangle(c, 0, 0, c->width, c->height, color);
}

MPM_API mpm_io_color mpm_io_pixel(const mpm_io_canvas *c, int x, int y)
{
    const unsigned char *p;
    if (x < 0 || y < 0 || x >= c->width || y >= c->height) return 0;
    p = c->rgb + 3 * ((size_t)y * (size_t)c->width + (size_t)x);
    return (mpm_io_color)p[0] << 16 | (mpm_io_color)p[1] << 8 | p[2];
}

/* Lines, discs and letters are all thick segments with round ends. Their coverage goes into the
   mask, where overlapping parts of one shape keep the greater, and is inked once at the end: so
   joints are no darker than the rest. */
static inline void mpm__io_segment(mpm_io_canvas *c, double ax, double ay, double bx, double by,
                                   double radius)
{
    double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy, reach = radius + 1;
    int left = mpm__io_whole((ax < bx ? ax : bx) - reach, c->clip[0], c->clip[2]);
    int right = mpm__io_whole((ax < bx ? bx : ax) + reach, c->clip[0], c->clip[2]);
    int top = mpm__io_whole((ay < by ? ay : by) - reach, c->clip[1], c->clip[3]);
    int bottom = mpm__io_whole((ay < by ? by : ay) + reach, c->clip[1], c->clip[3]), i, j;
    for (j = top; j < bottom; j++)
        for (i = left; i < right; i++) {
            unsigned char *mask = c->mask + (size_t)j * (size_t)c->width + (size_t)i;
            double px = i + 0.5 - ax, py = j + 0.5 - ay, t = 0, cover;
            if (square > 0) t = (px * dx + py * dy) / square;
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            px -= t * dx;
            py -= t * dy;
            cover = radius + 0.5 - sqrt(px * px + py * py);
            cover = cover < 0 ? 0 : cover > 1 ? 1 : cover;
            if (255 * cover + 0.5 > *mask) *mask = (unsigned char)(255 * cover + 0.5);
        }
    if (left < c->box[0]) c->box[0] = left;
    if (top < c->box[1]) c->box[1] = top;
    if (right > c->box[2]) c->box[2] = right;
    if (bottom > c->box[3]) c->box[3] = bottom;
}

/* Paints what the mask covers and clears it. */
static inline void mpm__io_ink(mpm_io_canvas *c, mpm_io_color color)
{
    int i, j;
    for (j = c->box[1]; j < c->box[3]; j++)
        for (i = c->box[0]; i < c->box[2]; i++) {
            size_t at = (size_t)j * (size_t)c->width + (size_t)i;
            if (c->mask[at] == 0) continue;
            mpm__io_set(c->rgb + 3 * at,
                        mpm__io_blend(mpm_io_pixel(c, i, j), color, c->mask[at] / 255.0));
            c->mask[at] = 0;
        }
    c->box[0] = c->width;
    c->box[1] = c->height;
    c->box[2] = c->box[3] = 0;
}

MPM_API void mpm_io_line(mpm_io_canvas *c, double ax, double ay, double bx, double by,
                         double width, mpm_io_color color)
{
    mpm__io_segment(c, ax, ay, bx, by, 0.5 * width);
    mpm__io_ink(c, color);
}

MPM_API void mpm_io_disc(mpm_io_canvas *c, double x, double y, double radius, mpm_io_color color)
{
    mpm__io_segment(c, x, y, x, y, radius);
    mpm__io_ink(c, color);
}

/* ---- text ---------------------------------------------------------------------------------- */

/* The font. Each glyph is its width and its strokes; a stroke is a list of points, x as a digit
   and y as a letter ('d' the baseline, 'j' the height of x, 'm' of capitals, 'a' the descender).
   The points steer a quadratic B-spline: two make a straight line, a repeated one a corner, and
   the rest is round. So "6 0m0g0d6d6g6m" is a U: down, round the bottom, up again. */
static inline const char *mpm__io_glyph(uint32_t code)
{
    static const char *const ascii[95] = {
        "2",                                         /* space */
        "0 0m0g 0d0d",                               /* ! */
        "2 0m0k 2m2k",                               /* " */
        "6 2m1d 5m4d 0j6j 0g6g",                     /* # */
        "6 6k6m0m0i6i6d0d0f 3n3c",                   /* $ */
        "8 2m0m0i4i4m2m 6h4h4d8d8h6h 7m1d",          /* % */
        "7 7d7d1k1m5m5j0h0d3d6d7h",                  /* & */
        "0 0m0k",                                    /* ' */
        "2 2n0k0e2b",                                /* ( */
        "2 0n2k2e0b",                                /* ) */
        "4 2m2i 0l4j 4l0j",                          /* * */
        "6 3k3e 0h6h",                               /* + */
        "1 1d1d0b",                                  /* , */
        "4 0h4h",                                    /* - */
        "0 0d0d",                                    /* . */
        "4 4n0c",                                    /* / */
        "6 3m0m0j0g0d6d6g6j6m3m",                    /* 0 */
        "6 1k3m3m3d",                                /* 1 */
        "6 0k0m6m6i4h0d0d6d",                        /* 2 */
        "6 0k0m6m6i2i 2i6i6d0d0f",                   /* 3 */
        "6 4d4m4m0f0f6f",                            /* 4 */
        "6 5m1m1m0i0i1j6j6d0d0f",                    /* 5 */
        "6 5m0m0j0d6d6j0j0g",                        /* 6 */
        "6 0m6m6m2d",                                /* 7 */
        "6 3m0m0i6i6m3m 3i0i0d6d6i3i",               /* 8 */
        "6 1d6d6g6m0m0g6g6j",                        /* 9 */
        "0 0d0d 0i0i",                               /* : */
        "1 1i1i 1d1d0b",                             /* ; */
        "5 5k0h0h5e",                                /* < */
        "6 0i6i 0f6f",                               /* = */
        "5 0k5h5h0e",                                /* > */
        "5 0k0m5m5i2i2g 2d2d",                       /* ? */
        "8 6j2j2f6f6j 6j6f8f8j8m0m0c7c",             /* @ */
        "6 0d3m3m6d 1g5g",                           /* A */
        "6 0d0d0m0m3m6m6i3i0i 3i6i6d3d0d",           /* B */
        "6 6k6m0m0j0g0d6d6f",                        /* C */
        "6 0d0d0m0m2m6m6j6g6d2d0d",                  /* D */
        "5 5m0m0m0d0d5d 0i4i",                       /* E */
        "5 5m0m0m0d 0i4i",                           /* F */
        "6 6k6m0m0j0g0d6d6h6h3h",                    /* G */
        "6 0m0d 6m6d 0i6i",                          /* H */
        "0 0m0d",                                    /* I */
        "4 4m4g4d0d0f",                              /* J */
        "6 0m0d 6m0g 2i6d",                          /* K */
        "5 0m0d0d5d",                                /* L */
        "7 0d0m0m3f4f7m7m7d",                        /* M */
        "6 0d0m0m6d6d6m",                            /* N */
        "6 3m0m0j0g0d6d6g6j6m3m",                    /* O */
        "6 0d0d0m0m3m6m6h3h0h",                      /* P */
        "6 3m0m0j0g0d6d6g6j6m3m 4f6c",               /* Q */
        "6 0d0d0m0m3m6m6h3h0h 3h6d",                 /* R */
        "6 6k6m0m0i6i6d0d0f",                        /* S */
        "6 0m6m 3m3d",                               /* T */
        "6 0m0g0d6d6g6m",                            /* U */
        "6 0m3d3d6m",                                /* V */
        "8 0m2d2d4k4k6d6d8m",                        /* W */
        "6 0m6d 6m0d",                               /* X */
        "6 0m3h3h6m 3h3d",                           /* Y */
        "6 0m6m6m0d0d6d",                            /* Z */
        "2 2n0n0n0b0b2b",                            /* [ */
        "4 0n4c",                                    /* \ */
        "2 0n2n2n2b2b0b",                            /* ] */
        "4 0j2m2m4j",                                /* ^ */
        "6 0b6b",                                    /* _ */
        "2 0m2k",                                    /* ` */
        "5 0i1j5j5g5d 5h2h0h0d5d5g",                 /* a */
        "5 0m0d 0g0j5j5d0d0g",                       /* b */
        "5 5i5j0j0d5d5e",                            /* c */
        "5 5m5d 5g5j0j0d5d5g",                       /* d */
        "5 0g5g5g5j0j0d5d5e",                        /* e */
        "3 3m1m1k1d 0j3j",                           /* f */
        "5 5g5j0j0d5d5g 5j5d5a0a0b",                 /* g */
        "5 0m0d 0g0j5j5g5d",                         /* h */
        "0 0j0d 0m0m",                               /* i */
        "2 2j2d2a0a 2m2m",                           /* j */
        "5 0m0d 5j0e 2g5d",                          /* k */
        "2 0m0f0d2d",                                /* l */
        "8 0j0d 0g0j4j4g4d 4g4j8j8g8d",              /* m */
        "5 0j0d 0g0j5j5g5d",                         /* n */
        "5 0g0j5j5d0d0g",                            /* o */
        "5 0j0a 0g0j5j5d0d0g",                       /* p */
        "5 5j5a 5g5j0j0d5d5g",                       /* q */
        "3 0j0d 0g0j3j",                             /* r */
        "4 4i4j0j0g4g4d0d0e",                        /* s */
        "3 1l1f1d3d 0j3j",                           /* t */
        "5 0j0g0d5d5g 5j5d",                         /* u */
        "4 0j2d2d4j",                                /* v */
        "8 0j2d2d4i4i6d6d8j",                        /* w */
        "5 0j5d 5j0d",                               /* x */
        "4 0j2d 4j1a",                               /* y */
        "5 0j5j5j0d0d5d",                            /* z */
        "3 3n1n1h0h 0h1h1b3b",                       /* { */
        "0 0n0b",                                    /* | */
        "3 0n2n2h3h 3h2h2b0b",                       /* } */
        "6 0g2j4e6h",                                /* ~ */
    };
    if (code >= 32 && code < 127) return ascii[code - 32];
    switch (code) {
    case 0xb5: case 0x3bc: return "5 0j0a 0g0d5d5g 5j5d"; /* micro, mu */
    case 0xb0: return "4 0k0m4m4i0i0k";                   /* degree */
    case 0xb2: return "3 0l0n3n3k0h0h3h";                 /* squared */
    case 0xb3: return "3 0n3n3k1k 1k3k3h0h";              /* cubed */
    case 0xb7: return "0 0h0h";                           /* middle dot */
    case 0xd7: return "5 0j5e 5j0e";                      /* times */
    case 0x2212: return "6 0h6h";                         /* minus */
    default: return "5 0m0m5m5m5d5d0d0d0m";
    }
}

/* The next UTF-8 character; a broken one counts as unknown. */
static inline uint32_t mpm__io_next_character(const char **text)
{
    const unsigned char *p = (const unsigned char *)*text;
    uint32_t code = *p++;
    int more = code < 0xc0 ? 0 : code < 0xe0 ? 1 : code < 0xf0 ? 2 : 3;
    if (more > 0) code &= 0x3fu >> more;
    for (; more > 0 && (*p & 0xc0) == 0x80; more--) code = code << 6 | (*p++ & 0x3fu);
    *text = (const char *)p;
    return code;
}

/* Where glyphs are drawn: origin, design units, and whether the line runs upwards. */
typedef struct mpm__io_pen {
    double x, y, unit, radius;
    int up;
} mpm__io_pen;

#define MPM__IO_NARROW 0.86 /* widths of the table, as drawn */
#define MPM__IO_GAP 2.5     /* between glyphs, centre line to centre line [design units] */

static inline void mpm__io_pen_segment(mpm_io_canvas *c, const mpm__io_pen *p, const double a[2],
                                       const double b[2])
{
    double u = p->unit;
    if (p->up)
        mpm__io_segment(c, p->x - u * a[1], p->y - u * a[0], p->x - u * b[1], p->y - u * b[0],
                        p->radius);
    else
        mpm__io_segment(c, p->x + u * a[0], p->y - u * a[1], p->x + u * b[0], p->y - u * b[1],
                        p->radius);
}

/* One stroke: from the middle of each pair of points to the middle of the next, bent towards the
   point between. Returns the character after it. */
static inline const char *mpm__io_stroke(mpm_io_canvas *c, const mpm__io_pen *pen, const char *s)
{
    enum { PIECES = 6 };
    double from[2], to[2], a[2], b[2];
    int i, k;
    from[0] = MPM__IO_NARROW * (s[0] - '0');
    from[1] = s[1] - 'd';
    if (s[4] == 0 || s[4] == ' ') { /* two points: a straight line */
        to[0] = MPM__IO_NARROW * (s[2] - '0');
        to[1] = s[3] - 'd';
        mpm__io_pen_segment(c, pen, from, to);
        return s + 4;
    }
    for (s += 2; s[2] != 0 && s[2] != ' '; s += 2) {
        int last = s[4] == 0 || s[4] == ' ';
        double bend[2], next[2];
        bend[0] = MPM__IO_NARROW * (s[0] - '0');
        bend[1] = s[1] - 'd';
        next[0] = MPM__IO_NARROW * (s[2] - '0');
        next[1] = s[3] - 'd';
        for (k = 0; k < 2; k++) {
            to[k] = last ? next[k] : 0.5 * (bend[k] + next[k]);
            a[k] = from[k];
        }
        for (i = 1; i <= PIECES; i++) {
            double t = (double)i / PIECES, r = 1 - t;
            for (k = 0; k < 2; k++) b[k] = r * r * from[k] + 2 * r * t * bend[k] + t * t * to[k];
            mpm__io_pen_segment(c, pen, a, b);
            for (k = 0; k < 2; k++) a[k] = b[k];
        }
        for (k = 0; k < 2; k++) from[k] = to[k];
    }
    return s + 2;
}

MPM_API double mpm_io_text_width(double size, const char *text)
{
    double width = 0;
    if (!*text) return 0;
    while (*text)
        width +=
            MPM__IO_NARROW * (mpm__io_glyph(mpm__io_next_character(&text))[0] - '0') + MPM__IO_GAP;
    return (width - MPM__IO_GAP) * size / 9;
}

/* Text along x, or upwards, with a stroke of `weight` design units (capitals are 9 high). */
static inline void mpm__io_write(mpm_io_canvas *c, double x, double y, double size,
                                 mpm_io_align align, int up, double weight, mpm_io_color color,
                                 const char *text)
{
    double shift = 0.5 * (double)align * mpm_io_text_width(size, text);
    mpm__io_pen pen;
    pen.x = up ? x : x - shift;
    pen.y = up ? y + shift : y;
    pen.unit = size / 9;
    pen.radius = 0.5 * weight * pen.unit;
    pen.up = up;
    while (*text) {
        const char *glyph = mpm__io_glyph(mpm__io_next_character(&text)), *s = glyph + 1;
        double step = (MPM__IO_NARROW * (glyph[0] - '0') + MPM__IO_GAP) * pen.unit;
        while (*s == ' ') s = mpm__io_stroke(c, &pen, s + 1);
        if (up) pen.y -= step;
        else pen.x += step;
    }
    mpm__io_ink(c, color);
}

MPM_API void mpm_io_text(mpm_io_canvas *c, double x, double y, double size, mpm_io_align align,
                         mpm_io_color color, const char *text)
{
    mpm__io_write(c, x, y, size, align, 0, 1.15, color, text);
}

/* ---- colours ------------------------------------------------------------------------------- */

MPM_API mpm_io_color mpm_io_map_color(mpm_io_map map, double t)
{
    /* Control points of even steps in CIELAB lightness along a path of hues we chose. */
    static const mpm_io_color points[3][11] = {
        {0x083271, 0x014486, 0x03579a, 0x076e9c, 0x0284a4, 0x029aa9,
         0x0cb1a9, 0x08c99b, 0x72db83, 0xb1eb65, 0xf7f449},
        {0x2c274d, 0x542b67, 0x882375, 0xbb1263, 0xde2843, 0xf14e38,
         0xff702c, 0xff963a, 0xffb851, 0xffd580, 0xfff0c2},
        {0x055987, 0x0177b3, 0x3a95d5, 0x83b2e0, 0xb8cfea, 0xf4eceb,
         0xecc4be, 0xe09c93, 0xd1756a, 0xbe4c44, 0xa02626}};
    int k;
    if (t != t) return 0x9aa0a6;
    t = 10 * (t < 0 ? 0 : t > 1 ? 1 : t);
    k = t < 10 ? (int)t : 9;
    return mpm__io_blend(points[map][k], points[map][k + 1], t - k);
}

MPM_API mpm_io_color mpm_io_series_color(int number)
{
    static const mpm_io_color colors[8] = {0x17669e, 0xd9541e, 0x2a8f5c, 0x8a4fa3,
                                           0xc9930a, 0x3aa6b9, 0xb8325a, 0x6b7785};
    return colors[(unsigned)number % 8];
}

/* ---- axes ---------------------------------------------------------------------------------- */

/* Design sizes, in units of the canvas. */
#define MPM__IO_INK 0x1f2933u    /* text */
#define MPM__IO_SOFT 0x52606du   /* secondary text */
#define MPM__IO_FRAME 0x9aa5b1u  /* frames and ticks */
#define MPM__IO_GRID 0xe8ecf0u   /* grid lines */
#define MPM__IO_PAD 16.0         /* around a figure */
#define MPM__IO_TITLE 10.5       /* cap heights */
#define MPM__IO_LABEL 9.0
#define MPM__IO_NUMBER 8.0
#define MPM__IO_HEADING 24.0     /* height of the line above the frame */
#define MPM__IO_BAR 60.0         /* height of colour bar, numbers and label below the frame */

/* A frame on the canvas and what it shows; on a logarithmic axis low and high are exponents. */
typedef struct mpm__io_axes {
    double left, top, right, bottom; /* pixels */
    double low[2], high[2];
    int log[2];
} mpm__io_axes;

static inline double mpm__io_at_x(const mpm__io_axes *a, double x)
{
    return a->left + (a->right - a->left) * (x - a->low[0]) / (a->high[0] - a->low[0]);
}

static inline double mpm__io_at_y(const mpm__io_axes *a, double y)
{
    return a->bottom - (a->bottom - a->top) * (y - a->low[1]) / (a->high[1] - a->low[1]);
}

/* The 1, 2 or 5 times a power of ten next below or at `value` > 0. */
static inline double mpm__io_nice(double value)
{
    double power = pow(10.0, floor(log10(value) + 1e-9)), digit = value / power;
    return power * (digit > 5 - 1e-9 ? 5 : digit > 2 - 1e-9 ? 2 : 1);
}

typedef struct mpm__io_tick {
    double at;     /* in the units of the axes */
    char text[32]; /* empty for a minor tick; "10^-3" for a power */
} mpm__io_tick;

enum { MPM__IO_TICKS = 64 };

/* A tick's number: plain where that is short, with the decimals of the step. */
static inline void mpm__io_tick_number(char text[32], double value, double step, double largest)
{
    int decimals = (int)-floor(log10(step) + 1e-9);
    if (fabs(value) < 1e-9 * step) value = 0;
    if (largest >= 1e5 || step < 1e-4) {
        mpm__io_short(text, 32, value, 4);
        return;
    }
    snprintf(text, 32, "%.*f", decimals < 0 ? 0 : decimals, value);
    mpm__io_decimal_point(text);
}

static inline int mpm__io_log_ticks(double low, double high, mpm__io_tick *ticks)
{
    int n = 0, decade, digit, skip = 1 + (int)((high - low) / 8);
    for (decade = (int)floor(low); decade <= (int)ceil(high); decade++)
        for (digit = 1; digit < 10 && n < MPM__IO_TICKS; digit++) {
            double at = decade + log10((double)digit);
            int named =
                digit == 1 ? decade % skip == 0 : high - low < 1.5 && (digit == 2 || digit == 5);
            if (at < low - 1e-9 || at > high + 1e-9 || (skip > 1 && digit > 1)) continue;
            ticks[n].at = at;
            ticks[n].text[0] = 0;
            if (named && ((decade > -4 && decade < 4) || digit > 1))
                mpm__io_short(ticks[n].text, 32, digit * pow(10.0, decade), 3);
            else if (named) snprintf(ticks[n].text, 32, "10^%d", decade);
            n++;
        }
    return n;
}

/* Ticks at nice values between low and high, with at most `want` steps (but two). */
static inline int mpm__io_ticks(double low, double high, int is_log, int want, mpm__io_tick *ticks)
{
    double step = mpm__io_nice((high - low) / (want > 2 ? want : 2)), k;
    double largest = fabs(low) > fabs(high) ? fabs(low) : fabs(high);
    int n = 0;
    if (is_log) return mpm__io_log_ticks(low, high, ticks);
    if (step * (want > 2 ? want : 2) < 0.999 * (high - low)) step = mpm__io_nice(2.51 * step);
    for (k = ceil(low / step - 1e-6); k * step <= high + 1e-6 * step && n < MPM__IO_TICKS; k++) {
        ticks[n].at = k * step;
        mpm__io_tick_number(ticks[n++].text, k * step, step, largest);
    }
    return n;
}

/* The width of a tick's text; the exponent of a power is smaller. */
static inline double mpm__io_tick_width(double size, const char *text)
{
    const char *power = strchr(text, '^');
    char base[32] = "";
    if (!power) return mpm_io_text_width(size, text);
    mpm__io_append(base, (size_t)(power - text) + 1, 0, text);
    return mpm_io_text_width(size, base) + 0.3 * size + mpm_io_text_width(0.72 * size, power + 1);
}

static inline void mpm__io_tick_text(mpm_io_canvas *c, double x, double y, double size,
                                     mpm_io_align align, const char *text)
{
    const char *power = strchr(text, '^');
    char base[32] = "";
    if (!power) {
        mpm_io_text(c, x, y, size, align, MPM__IO_SOFT, text);
        return;
    }
    x -= 0.5 * (double)align * mpm__io_tick_width(size, text);
    mpm__io_append(base, (size_t)(power - text) + 1, 0, text);
    mpm_io_text(c, x, y, size, MPM_IO_LEFT, MPM__IO_SOFT, base);
    mpm_io_text(c, x + mpm_io_text_width(size, base) + 0.3 * size, y - 0.55 * size, 0.72 * size,
                MPM_IO_LEFT, MPM__IO_SOFT, power + 1);
}

/* Text made smaller until it fits a width. */
static inline void mpm__io_write_fit(mpm_io_canvas *c, double x, double y, double size,
                                     mpm_io_align align, double weight, mpm_io_color color,
                                     const char *text, double room)
{
    double width = mpm_io_text_width(size, text);
    if (width > room && width > 0) size *= room / width;
    mpm__io_write(c, x, y, size, align, 0, weight, color, text);
}

/* A hairline along whole pixels. */
static inline void mpm__io_hair(mpm_io_canvas *c, double ax, double ay, double bx, double by,
                                mpm_io_color color)
{
    double w = floor(c->unit + 0.5) < 1 ? 1 : floor(c->unit + 0.5);
    if (ax < bx) mpm_io_rectangle(c, ax, by - 0.5 * w, bx - ax, w, color);
    else mpm_io_rectangle(c, ax - 0.5 * w, ay < by ? ay : by, w, fabs(by - ay), color);
}

static inline void mpm__io_frame(mpm_io_canvas *c, const mpm__io_axes *a)
{
    double h = 0.5 * c->unit;
    mpm__io_hair(c, a->left - h, a->top, a->right + h, a->top, MPM__IO_FRAME);
    mpm__io_hair(c, a->left - h, a->bottom, a->right + h, a->bottom, MPM__IO_FRAME);
    mpm__io_hair(c, a->left, a->top - h, a->left, a->bottom + h, MPM__IO_FRAME);
    mpm__io_hair(c, a->right, a->top - h, a->right, a->bottom + h, MPM__IO_FRAME);
}

static inline int mpm__io_ticks_x(const mpm_io_canvas *c, const mpm__io_axes *a,
                                  mpm__io_tick *ticks)
{
    return mpm__io_ticks(a->low[0], a->high[0], a->log[0],
                         (int)((a->right - a->left) / (62 * c->unit)), ticks);
}

static inline int mpm__io_ticks_y(const mpm_io_canvas *c, const mpm__io_axes *a,
                                  mpm__io_tick *ticks)
{
    return mpm__io_ticks(a->low[1], a->high[1], a->log[1],
                         (int)((a->bottom - a->top) / (42 * c->unit)), ticks);
}

/* Light lines behind the data, at the named ticks. */
static inline void mpm__io_grid(mpm_io_canvas *c, const mpm__io_axes *a)
{
    mpm__io_tick ticks[MPM__IO_TICKS];
    int i, n = mpm__io_ticks_x(c, a, ticks);
    for (i = 0; i < n; i++) {
        double x = mpm__io_at_x(a, ticks[i].at);
        if (ticks[i].text[0]) mpm__io_hair(c, x, a->top, x, a->bottom, MPM__IO_GRID);
    }
    n = mpm__io_ticks_y(c, a, ticks);
    for (i = 0; i < n; i++) {
        double y = mpm__io_at_y(a, ticks[i].at);
        if (ticks[i].text[0]) mpm__io_hair(c, a->left, y, a->right, y, MPM__IO_GRID);
    }
}

/* Ticks, their numbers and the labels of both axes. */
static inline void mpm__io_numbers(mpm_io_canvas *c, const mpm__io_axes *a, const char *x_label,
                                   const char *y_label)
{
    mpm__io_tick ticks[MPM__IO_TICKS];
    double u = c->unit, size = MPM__IO_NUMBER * u, widest = 0;
    int i, n = mpm__io_ticks_x(c, a, ticks);
    for (i = 0; i < n; i++) {
        double x = mpm__io_at_x(a, ticks[i].at), length = ticks[i].text[0] ? 5 * u : 3 * u;
        mpm__io_hair(c, x, a->bottom, x, a->bottom + length, MPM__IO_FRAME);
        mpm__io_tick_text(c, x, a->bottom + 9 * u + size, size, MPM_IO_CENTER, ticks[i].text);
    }
    n = mpm__io_ticks_y(c, a, ticks);
    for (i = 0; i < n; i++) {
        double y = mpm__io_at_y(a, ticks[i].at), length = ticks[i].text[0] ? 5 * u : 3 * u;
        double width = mpm__io_tick_width(size, ticks[i].text);
        mpm__io_hair(c, a->left - length, y, a->left, y, MPM__IO_FRAME);
        mpm__io_tick_text(c, a->left - 9 * u, y + 0.5 * size, size, MPM_IO_RIGHT, ticks[i].text);
        if (width > widest) widest = width;
    }
    if (x_label)
        mpm__io_write_fit(c, 0.5 * (a->left + a->right),
                          a->bottom + (9 + 12) * u + size + MPM__IO_LABEL * u, MPM__IO_LABEL * u,
                          MPM_IO_CENTER, 1.15, MPM__IO_INK, x_label, a->right - a->left);
    if (y_label)
        mpm__io_write(c, a->left - (9 + 10) * u - widest, 0.5 * (a->top + a->bottom),
                      MPM__IO_LABEL * u, MPM_IO_CENTER, 1, 1.15, MPM__IO_INK, y_label);
}

/* What a figure has around its frame. */
typedef struct mpm__io_furniture {
    const char *title, *note, *x_label, *y_label;
    int numbers, bar, equal;
} mpm__io_furniture;

/* Room beside the frame for the numbers and label of the y axis [pixels]. */
static inline double mpm__io_left_room(const mpm_io_canvas *c, const mpm__io_axes *a,
                                       const mpm__io_furniture *f)
{
    mpm__io_tick ticks[MPM__IO_TICKS];
    double widest = 0;
    int i, n;
    if (!f->numbers) return 0;
    n = mpm__io_ticks_y(c, a, ticks);
    for (i = 0; i < n; i++) {
        double width = mpm__io_tick_width(MPM__IO_NUMBER * c->unit, ticks[i].text);
        if (width > widest) widest = width;
    }
    return widest + (9 + (f->y_label ? 10 + MPM__IO_LABEL : 0)) * c->unit;
}

/* Room above and below the frame [design pixels]. */
static inline double mpm__io_top_room(const mpm__io_furniture *f)
{
    return f->title || f->note ? MPM__IO_HEADING : 0;
}

static inline double mpm__io_bottom_room(const mpm__io_furniture *f)
{
    double room = f->numbers ? 9 + MPM__IO_NUMBER : 0;
    if (f->numbers && f->x_label) room += 12 + MPM__IO_LABEL + 2;
    return f->bar ? room + MPM__IO_BAR : room;
}

/* Places the frame inside `where`, leaving room for the rest; with `equal` its sides follow the
   window and the whole is centred. */
static inline void mpm__io_place(const mpm_io_canvas *c, mpm_io_rect where,
                                 const mpm__io_furniture *f, mpm__io_axes *a)
{
    double u = c->unit, wide = a->high[0] - a->low[0], high = a->high[1] - a->low[1];
    double spare_x, spare_y, scale;
    a->left = where.x + MPM__IO_PAD * u;
    a->right = where.x + where.width - MPM__IO_PAD * u;
    a->top = where.y + (MPM__IO_PAD + mpm__io_top_room(f)) * u;
    a->bottom = where.y + where.height - (MPM__IO_PAD + mpm__io_bottom_room(f)) * u;
    if (a->bottom < a->top + 8) a->bottom = a->top + 8;
    a->left += mpm__io_left_room(c, a, f);
    if (a->right < a->left + 8) a->right = a->left + 8;
    if (f->equal) {
        scale = (a->right - a->left) / wide;
        if (scale * high > a->bottom - a->top) scale = (a->bottom - a->top) / high;
        spare_x = 0.5 * (a->right - a->left - scale * wide);
        spare_y = 0.5 * (a->bottom - a->top - scale * high);
        a->left += spare_x;
        a->right -= spare_x;
        a->top += spare_y;
        a->bottom -= spare_y;
    }
    a->left = floor(a->left) + 0.5; /* hairlines fill whole pixels */
    a->right = floor(a->right) + 0.5;
    a->top = floor(a->top) + 0.5;
    a->bottom = floor(a->bottom) + 0.5;
}

/* Title at the left, note at the right, above the frame. */
static inline void mpm__io_heading(mpm_io_canvas *c, const mpm__io_axes *a,
                                   const mpm__io_furniture *f)
{
    double u = c->unit, room = a->right - a->left, y = a->top - 10 * u;
    if (f->note) {
        mpm__io_write_fit(c, a->right, y, MPM__IO_LABEL * u, MPM_IO_RIGHT, 1.15, MPM__IO_SOFT,
                          f->note, room);
        room -= mpm_io_text_width(MPM__IO_LABEL * u, f->note) + 14 * u;
    }
    if (f->title && room > 0)
        mpm__io_write_fit(c, a->left, y, MPM__IO_TITLE * u, MPM_IO_LEFT, 1.6, MPM__IO_INK, f->title,
                          room);
}

/* ---- colour bar ---------------------------------------------------------------------------- */

/* A bar with pointed ends where values lie below low or above high. */
static inline void mpm__io_bar(mpm_io_canvas *c, mpm_io_rect where, mpm_io_map map, double low,
                               double high, int below, int above, const char *label)
{
    mpm__io_tick ticks[MPM__IO_TICKS];
    double u = c->unit, size = MPM__IO_NUMBER * u, thick = floor(10 * u + 0.5), x,
           tip = 0.8 * thick;
    double left = floor(where.x) + (below ? tip : 0);
    double right = floor(where.x + where.width) - (above ? tip : 0);
    int i, n = mpm__io_ticks(low, high, 0, (int)((right - left) / (54 * u)), ticks);
    if (!(right > left)) return;
    for (x = left; x < right; x++)
        mpm_io_rectangle(c, x, where.y, 1, thick,
                         mpm_io_map_color(map, (x + 0.5 - left) / (right - left)));
    for (x = 0; x < tip; x++) {
        double half = 0.5 * thick * (1 - x / tip);
        if (below)
            mpm_io_rectangle(c, left - x - 1, where.y + 0.5 * thick - half, 1, 2 * half,
                             mpm_io_map_color(map, 0));
        if (above)
            mpm_io_rectangle(c, right + x, where.y + 0.5 * thick - half, 1, 2 * half,
                             mpm_io_map_color(map, 1));
    }
    for (i = 0; i < n; i++) {
        x = left + (right - left) * (ticks[i].at - low) / (high - low);
        x = x < left + 0.5 ? left + 0.5 : x > right - 0.5 ? right - 0.5 : x;
        mpm__io_hair(c, x, where.y + thick, x, where.y + thick + 4 * u, MPM__IO_FRAME);
        mpm__io_tick_text(c, x, where.y + thick + 8 * u + size, size, MPM_IO_CENTER, ticks[i].text);
    }
    if (label)
        mpm__io_write_fit(c, 0.5 * (left + right),
                          where.y + thick + (8 + 10 + MPM__IO_LABEL) * u + size, MPM__IO_LABEL * u,
                          MPM_IO_CENTER, 1.15, MPM__IO_INK, label, right - left);
}

MPM_API void mpm_io_color_bar(mpm_io_canvas *c, mpm_io_rect where, mpm_io_map map, double low,
                              double high, const char *label)
{
    if (high > low) mpm__io_bar(c, where, map, low, high, 0, 0, label);
}

MPM_API mpm_io_rect mpm_io_tile(const mpm_io_canvas *c, int columns, int rows, int number)
{
    mpm_io_rect r;
    r.width = (double)c->width / columns;
    r.height = (double)c->height / rows;
    r.x = r.width * (number % columns);
    r.y = r.height * (number / columns);
    return r;
}

/* ---- dots: what cuts and scatter plots draw ------------------------------------------------ */

typedef struct mpm__io_dot {
    double x, y, value, size;
    int32_t body;
} mpm__io_dot;

/* A range being found, and what falls outside a given one. */
typedef struct mpm__io_span {
    double low, high;
    int below, above;
} mpm__io_span;

/* The colour range: as given, or that of the dots within the frame. A constant field gets a
   range around it. */
static inline mpm__io_span mpm__io_value_span(const mpm__io_dot *dots, size_t n,
                                              const mpm__io_axes *a, double low, double high)
{
    mpm__io_span s = {0, 0, 0, 0};
    double least = 1, most = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        const mpm__io_dot *p = &dots[i];
        if (p->x < a->low[0] || p->x > a->high[0] || p->y < a->low[1] || p->y > a->high[1])
            continue;
        if (!(p->value - p->value == 0)) continue;
        if (least > most) least = most = p->value;
        if (p->value < least) least = p->value;
        if (p->value > most) most = p->value;
    }
    s.low = low;
    s.high = high;
    if (!(high > low)) {
        s.low = least;
        s.high = most;
    } else if (least <= most) {
        s.below = least < low - 1e-6 * (high - low);
        s.above = most > high + 1e-6 * (high - low);
    }
    if (!(s.high - s.low > 1e-9 * fabs(s.low))) {
        s.low -= s.low != 0 ? 0.5 * fabs(s.low) : 0.5;
        s.high += s.high != 0 ? 0.5 * fabs(s.high) : 0.5;
    }
    return s;
}

/* Sets the window as given, or to fit the dots with `margin` of their extent around. */
static inline void mpm__io_fit(mpm__io_axes *a, const double window[4], const mpm__io_dot *dots,
                               size_t n, double margin)
{
    size_t i;
    int k;
    for (k = 0; k < 2; k++) {
        double low = 0, high = 0, pad;
        a->log[k] = 0;
        a->low[k] = window[2 * k];
        a->high[k] = window[2 * k + 1];
        if (a->high[k] > a->low[k]) continue;
        for (i = 0; i < n; i++) {
            double at = k == 0 ? dots[i].x : dots[i].y, half = 0.5 * dots[i].size;
            if (i == 0 || at - half < low) low = at - half;
            if (i == 0 || at + half > high) high = at + half;
        }
        pad = margin * (high - low);
        if (!(pad > 0)) pad = low != 0 ? 0.1 * fabs(low) : 0.5;
        a->low[k] = low - pad;
        a->high[k] = high + pad;
    }
}

/* ---- cut ----------------------------------------------------------------------------------- */

MPM_API mpm_io_cut_desc mpm_io_cut_desc_default(void)
{
    mpm_io_cut_desc d;
    memset(&d, 0, sizeof d);
    d.normal = 1;
    d.scale = 1;
    d.length_scale = 1;
    return d;
}

MPM_API mpm_io_cut_desc mpm_io_cut_of(const mpm_world *world, const mpm_real *value)
{
    mpm_io_cut_desc d = mpm_io_cut_desc_default();
    int k;
    d.world = world;
    d.count = (size_t)world->points.count;
    for (k = 0; k < 3; k++) d.x[k] = world->points.x[k];
    d.value = value;
    return d;
}

static inline mpm_status mpm__io_cut_check(const mpm_io_cut_desc *d, mpm_fault *fault)
{
    if (d->count < 1) return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "count", 0, -1);
    if (!(d->spacing > 0) && !(d->world && d->spacing >= 0))
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "spacing", d->spacing, -1);
    if (d->normal < 0 || d->normal > 2)
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "normal", d->normal, -1);
    if (!d->x[0] && !d->x[1] && !d->x[2]) return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "x", 0, -1);
    return MPM_OK;
}

/* The body of point i, given that of point i - 1; -1 when it is retired. */
static inline int32_t mpm__io_body_at(const mpm_world *w, int32_t i, int32_t *body)
{
    const mpm_body *b;
    while (*body + 1 < w->bodies && i >= w->body[*body].first + w->body[*body].count) ++*body;
    b = &w->body[*body];
    return i < b->first + b->active ? *body : -1;
}

MPM_API void mpm_io_body_numbers(const mpm_world *world, int32_t *numbers)
{
    int32_t i, body = 0;
    for (i = 0; i < world->points.count; i++) numbers[i] = mpm__io_body_at(world, i, &body);
}

/* Point i as a dot in the plane of the cut; 0 when it is not to be seen. */
static inline int mpm__io_cut_dot(const mpm_io_cut_desc *d, size_t i, int32_t body,
                                  mpm__io_dot *dot)
{
    const mpm_real *across = d->x[d->normal];
    const mpm_real *x = d->x[d->normal == 0 ? 1 : 0], *y = d->x[d->normal == 2 ? 1 : 2];
    double size = d->spacing > 0 || !d->world || body < 0
                      ? d->spacing
                      : (double)d->world->body[body].desc.spacing;
    double half = d->half_thickness > 0 ? d->half_thickness : size;
    dot->x = x ? (double)x[i] : 0;
    dot->y = y ? (double)y[i] : 0;
    dot->value = d->value ? d->scale * (double)d->value[i] : 0;
    dot->size = d->size ? (double)d->size[i] : size;
    dot->body = d->body ? d->body[i] : body;
    if (d->world && body < 0) return 0;
    return dot->x - dot->x == 0 && dot->y - dot->y == 0 &&
           fabs((across ? (double)across[i] : 0) - d->at) <= half;
}

/* The dots of the slab, each twice with `mirror`. With dots == NULL only counts. */
static inline size_t mpm__io_cut_dots(const mpm_io_cut_desc *d, mpm__io_dot *dots)
{
    mpm__io_dot dot;
    int32_t body = 0;
    size_t i, n = 0;
    int side;
    for (i = 0; i < d->count; i++) {
        int32_t of = d->world ? mpm__io_body_at(d->world, (int32_t)i, &body) : 0;
        if (!mpm__io_cut_dot(d, i, of, &dot)) continue;
        for (side = 0; side <= (d->mirror ? 1 : 0); side++, n++) {
            if (!dots) continue;
            dots[n] = dot;
            if (side) dots[n].x = -dot.x;
        }
    }
    return n;
}

/* A cut is painted at twice the resolution and averaged: `layer` is what one body contributes,
   `best` what is visible so far. */
typedef struct mpm__io_paint {
    int width, height;    /* in half pixels */
    float *weight;        /* layer: sum of the kernels, a measure of how much body there is */
    float *near;          /* layer: squared distance of the nearest dot, in its size */
    float *norm, *sum;    /* layer: weights of the values, and weighted values */
    float *best, *value;  /* visible: weight and value */
    int32_t *body;        /* visible: body, counted from 1, or 0 for none */
    int box[4];           /* part of the layer in use */
} mpm__io_paint;

#define MPM__IO_FINE 2       /* half pixels per pixel */
#define MPM__IO_REACH 2.0    /* radius of a dot's kernel, in its size */
#define MPM__IO_FULL 4.19    /* sum of the kernels inside a lattice of dots: pi REACH^2 / 3 */
#define MPM__IO_SURFACE 0.42 /* share of it at the surface; one half would be exact on a plane */
#define MPM__IO_CORE 0.36    /* radius around each dot that is always shown, in its size */

/* Adds a dot to the layer: weight w = (1 - r^2 / R^2)^2 within R, and w^2 for its value.
   (x, y) and size in half pixels. */
static inline void mpm__io_splat(mpm__io_paint *p, double x, double y, double size, double value,
                                 int nearest)
{
    double radius = MPM__IO_REACH * size < 1.5 ? 1.5 : MPM__IO_REACH * size;
    int left = mpm__io_whole(x - radius, 0, p->width);
    int right = mpm__io_whole(x + radius, 0, p->width);
    int top = mpm__io_whole(y - radius, 0, p->height), i, j;
    int bottom = mpm__io_whole(y + radius, 0, p->height);
    for (j = top; j < bottom; j++)
        for (i = left; i < right; i++) {
            size_t at = (size_t)j * (size_t)p->width + (size_t)i;
            double dx = i + 0.5 - x, dy = j + 0.5 - y, q = dx * dx + dy * dy;
            double w = 1 - q / (radius * radius);
            int nearer;
            if (w <= 0) continue;
            w *= w;
            q *= MPM__IO_REACH * MPM__IO_REACH / (radius * radius);
            nearer = q < (double)p->near[at];
            if (nearer) p->near[at] = (float)q;
            p->weight[at] += (float)w;
            if (!nearest) {
                p->norm[at] += (float)(w * w);
                p->sum[at] += (float)(w * w * value);
            } else if (nearer) {
                p->norm[at] = 1;
                p->sum[at] = (float)value;
            }
        }
    if (left < p->box[0]) p->box[0] = left;
    if (top < p->box[1]) p->box[1] = top;
    if (right > p->box[2]) p->box[2] = right;
    if (bottom > p->box[3]) p->box[3] = bottom;
}

/* The weight at the surface of the layer. A slab that holds several dots behind each other weighs
   more throughout: then the body's own mean weight counts. */
static inline double mpm__io_surface(const mpm__io_paint *p)
{
    double sum = 0, square = 0, mean;
    int i, j;
    for (j = p->box[1]; j < p->box[3]; j++)
        for (i = p->box[0]; i < p->box[2]; i++) {
            double w = (double)p->weight[(size_t)j * (size_t)p->width + (size_t)i];
            sum += w;
            square += w * w;
        }
    mean = sum > 0 ? square / sum : 0;
    return MPM__IO_SURFACE * (mean > MPM__IO_FULL ? mean : MPM__IO_FULL);
}

/* Shows the layer where it outweighs what is visible, and clears it for the next body. The
   core of each dot is always shown, so that single points do not vanish. */
static inline void mpm__io_show_layer(mpm__io_paint *p, int32_t body)
{
    float surface = (float)mpm__io_surface(p);
    int i, j;
    for (j = p->box[1]; j < p->box[3]; j++)
        for (i = p->box[0]; i < p->box[2]; i++) {
            size_t at = (size_t)j * (size_t)p->width + (size_t)i;
            float w = p->weight[at];
            if ((w > surface || p->near[at] < (float)(MPM__IO_CORE * MPM__IO_CORE)) &&
                w > p->best[at]) {
                p->best[at] = w;
                p->value[at] = p->sum[at] / p->norm[at];
                p->body[at] = body;
            }
            p->weight[at] = p->norm[at] = p->sum[at] = 0;
            p->near[at] = 1e30f;
        }
    p->box[0] = p->width;
    p->box[1] = p->height;
    p->box[2] = p->box[3] = 0;
}

/* Paints body after body, in the order of their numbers. Bodies are shown as 1, 2, ... */
static inline void mpm__io_paint_dots(mpm__io_paint *p, const mpm__io_axes *a,
                                      const mpm__io_dot *dots, size_t n, int nearest)
{
    double scale = MPM__IO_FINE * (a->right - a->left) / (a->high[0] - a->low[0]);
    int32_t body = dots[0].body, next, shown = 1;
    size_t i;
    int more = 1;
    for (i = 1; i < n; i++)
        if (dots[i].body < body) body = dots[i].body;
    for (; more; body = next, shown++) {
        more = 0;
        next = body;
        for (i = 0; i < n; i++) {
            const mpm__io_dot *d = &dots[i];
            if (d->body == body)
                mpm__io_splat(p, scale * (d->x - a->low[0]), scale * (a->high[1] - d->y),
                              scale * d->size, d->value, nearest);
            else if (d->body > body && (!more || d->body < next)) {
                next = d->body;
                more = 1;
            }
        }
        mpm__io_show_layer(p, shown);
    }
}

/* What begins within `reach` half pixels: 0 nothing new, 1 the surface, 2 another body. */
static inline int mpm__io_edge_kind(const mpm__io_paint *p, int i, int j, int reach)
{
    static const int around[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                     {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    int32_t here = p->body[(size_t)j * (size_t)p->width + (size_t)i];
    int k, kind = 0;
    for (k = 0; k < 8; k++) {
        int x = i + reach * around[k][0], y = j + reach * around[k][1];
        int32_t there;
        if (x < 0 || y < 0 || x >= p->width || y >= p->height) continue;
        there = p->body[(size_t)y * (size_t)p->width + (size_t)x];
        if (there != here && (there == 0 || here == 0)) return 1;
        if (there != here) kind = 2;
    }
    return kind;
}

static inline int mpm__io_is_dark(mpm_io_color color)
{
    return 3 * (color >> 16 & 255) + 6 * (color >> 8 & 255) + (color & 255) < 10 * 70;
}

/* The colour of one half pixel. Values come in 96 steps: not to be seen, but flat areas pack well.
   A line marks the edge of each body, light where two dark bodies meet. */
static inline mpm_io_color mpm__io_fine_color(const mpm__io_paint *p, int i, int j, int edge,
                                              const mpm__io_span *s, const mpm_io_cut_desc *d)
{
    size_t at = (size_t)j * (size_t)p->width + (size_t)i;
    double t = ((double)p->value[at] - s->low) / (s->high - s->low);
    mpm_io_color color = 0xffffff;
    int kind;
    if (p->body[at] > 0 && d->value)
        color = mpm_io_map_color(d->map, t == t ? floor(t * 96 + 0.5) / 96 : t);
    else if (p->body[at] > 0)
        color = mpm__io_blend(mpm_io_series_color(p->body[at] - 1), 0xffffff, 0.35);
    kind = mpm__io_edge_kind(p, i, j, edge);
    if (kind == 0) return color;
    return mpm__io_blend(color, kind == 2 && mpm__io_is_dark(color) ? 0xffffff : MPM__IO_INK, 0.85);
}

/* Averages the half pixels into the canvas at the frame. */
static inline void mpm__io_paint_out(mpm_io_canvas *c, const mpm__io_paint *p,
                                     const mpm__io_axes *a, const mpm__io_span *s,
                                     const mpm_io_cut_desc *d)
{
    int edge = mpm__io_whole(0.5 * c->unit, 1, 8), x, y, i, j;
    for (y = 0; y < p->height / MPM__IO_FINE; y++)
        for (x = 0; x < p->width / MPM__IO_FINE; x++) {
            int red = 0, green = 0, blue = 0, n = MPM__IO_FINE * MPM__IO_FINE;
            for (j = MPM__IO_FINE * y; j < MPM__IO_FINE * (y + 1); j++)
                for (i = MPM__IO_FINE * x; i < MPM__IO_FINE * (x + 1); i++) {
                    mpm_io_color color = mpm__io_fine_color(p, i, j, edge, s, d);
                    red += (int)(color >> 16 & 255);
                    green += (int)(color >> 8 & 255);
                    blue += (int)(color & 255);
                }
            mpm_io_rectangle(c, floor(a->left) + x, floor(a->top) + y, 1, 1,
                             (mpm_io_color)((red + n / 2) / n << 16 | (green + n / 2) / n << 8 |
                                            (blue + n / 2) / n));
        }
}

/* The bodies within the frame. Returns MPM_ERR_MEMORY when the layers cannot be had. */
static inline mpm_status mpm__io_cut_bodies(mpm_io_canvas *c, const mpm__io_axes *a,
                                            const mpm__io_dot *dots, size_t n,
                                            const mpm__io_span *s, const mpm_io_cut_desc *d)
{
    mpm__io_paint p;
    size_t i, pixels;
    float *memory;
    memset(&p, 0, sizeof p);
    p.width = MPM__IO_FINE * (int)(a->right - a->left + 0.5);
    p.height = MPM__IO_FINE * (int)(a->bottom - a->top + 0.5);
    pixels = (size_t)p.width * (size_t)p.height;
    memory = (float *)MPM_MALLOC(pixels * 7 * sizeof(float));
    if (!memory) return MPM_ERR_MEMORY;
    memset(memory, 0, pixels * 7 * sizeof(float));
    p.weight = memory;
    p.near = memory + pixels;
    p.norm = memory + 2 * pixels;
    p.sum = memory + 3 * pixels;
    p.best = memory + 4 * pixels;
    p.value = memory + 5 * pixels;
    p.body = (int32_t *)(void *)(memory + 6 * pixels);
    for (i = 0; i < pixels; i++) p.near[i] = 1e30f;
    p.box[0] = p.width;
    p.box[1] = p.height;
    mpm__io_paint_dots(&p, a, dots, n, d->style == MPM_IO_NEAREST);
    mpm__io_paint_out(c, &p, a, s, d);
    MPM_FREE(memory);
    return MPM_OK;
}

/* Whether a part of the picture is still white. */
static inline int mpm__io_blank(const mpm_io_canvas *c, double x, double y, double width,
                                double height)
{
    int i, j, right = mpm__io_whole(x + width, 0, c->width);
    int bottom = mpm__io_whole(y + height, 0, c->height);
    for (j = mpm__io_whole(y, 0, c->height); j < bottom; j++)
        for (i = mpm__io_whole(x, 0, c->width); i < right; i++)
            if (mpm_io_pixel(c, i, j) != 0xffffff) return 0;
    return 1;
}

/* A nice length, in the first blank corner of the frame (lower ones first), or else on a white
   plate at the lower left. */
static inline void mpm__io_scale_bar(mpm_io_canvas *c, const mpm__io_axes *a, double length_scale,
                                     const char *unit)
{
    char number[32], text[80];
    double u = c->unit, size = MPM__IO_NUMBER * u, wide = a->right - a->left;
    double whole = (a->high[0] - a->low[0]) * length_scale, nice = mpm__io_nice(0.28 * whole);
    double bar = wide * nice / whole, width, height = size + 19 * u, x = 0, y = 0;
    int corner;
    mpm__io_short(number, sizeof number, nice, 3);
    snprintf(text, sizeof text, "%.30s %.40s", number, unit);
    width = mpm_io_text_width(size, text);
    width = (width < bar ? bar : width) + 16 * u;
    for (corner = 0; corner < 5; corner++) {
        x = corner % 4 % 2 ? a->right - 9 * u - width : a->left + 9 * u;
        y = corner % 4 / 2 ? a->top + 9 * u : a->bottom - 9 * u - height;
        if (mpm__io_blank(c, x, y, width, height)) break;
    }
    mpm_io_rectangle(c, x, y, width, height, 0xffffff);
    mpm_io_rectangle(c, x + 0.5 * (width - bar), y + height - 9 * u, bar, 3 * u, MPM__IO_INK);
    mpm_io_text(c, x + 0.5 * width, y + 6 * u + size, size, MPM_IO_CENTER, MPM__IO_INK, text);
}

/* What surrounds a cut. */
static inline mpm__io_furniture mpm__io_cut_furniture(const mpm_io_cut_desc *d)
{
    mpm__io_furniture f = {NULL, NULL, NULL, NULL, 0, 0, 1};
    f.title = d->title;
    f.note = d->time;
    f.numbers = d->ticks;
    f.bar = d->label && d->value;
    return f;
}

/* The dots of a cut in fresh memory; NULL with the reason in *status. */
static inline mpm__io_dot *mpm__io_cut_gather(const mpm_io_cut_desc *d, size_t *n,
                                              mpm_status *status, mpm_fault *fault)
{
    mpm__io_dot *dots;
    *status = mpm__io_cut_check(d, fault);
    if (*status < 0) return NULL;
    *n = mpm__io_cut_dots(d, NULL);
    if (*n == 0) {
        *status = mpm__io_fail(fault, MPM_ERR_ARGUMENT, "points in the slab", 0, -1);
        return NULL;
    }
    dots = (mpm__io_dot *)MPM_MALLOC(*n * sizeof *dots);
    if (!dots) *status = mpm__io_fail(fault, MPM_ERR_MEMORY, "dots of the cut", (double)*n, -1);
    else mpm__io_cut_dots(d, dots);
    return dots;
}

MPM_API mpm_status mpm_io_cut(mpm_io_canvas *c, mpm_io_rect where, const mpm_io_cut_desc *d,
                              mpm_fault *fault)
{
    mpm__io_furniture f = mpm__io_cut_furniture(d);
    mpm__io_axes a;
    mpm__io_span s;
    mpm_io_rect bar;
    mpm_status status;
    size_t n;
    mpm__io_dot *dots = mpm__io_cut_gather(d, &n, &status, fault);
    if (!dots) return status;
    mpm__io_fit(&a, d->window, dots, n, 0.02);
    mpm__io_place(c, where, &f, &a);
    s = mpm__io_value_span(dots, n, &a, d->low, d->high);
    status = mpm__io_cut_bodies(c, &a, dots, n, &s, d);
    MPM_FREE(dots);
    if (status < 0) return mpm__io_fail(fault, status, "layers of the cut", 0, -1);
    mpm__io_frame(c, &a);
    mpm__io_heading(c, &a, &f);
    if (f.numbers) {
        mpm__io_axes printed = a;
        printed.low[0] *= d->length_scale;
        printed.high[0] *= d->length_scale;
        printed.low[1] *= d->length_scale;
        printed.high[1] *= d->length_scale;
        mpm__io_numbers(c, &printed, NULL, NULL);
    } else if (d->length_unit)
        mpm__io_scale_bar(c, &a, d->length_scale, d->length_unit);
    bar.x = a.left;
    bar.width = a.right - a.left;
    bar.y = a.bottom + (mpm__io_bottom_room(&f) - MPM__IO_BAR + 16) * c->unit;
    bar.height = MPM__IO_BAR * c->unit;
    if (f.bar) mpm__io_bar(c, bar, d->map, s.low, s.high, s.below, s.above, d->label);
    return MPM_OK;
}

/* The height of a panel of a given width: its window's sides, and the rest. */
static inline mpm_status mpm__io_cut_height(const mpm_io_cut_desc *d, int width, double *height,
                                            mpm_fault *fault)
{
    mpm__io_furniture f = mpm__io_cut_furniture(d);
    mpm__io_axes a;
    mpm_status status;
    size_t n;
    mpm__io_dot *dots = mpm__io_cut_gather(d, &n, &status, fault);
    if (!dots) return status;
    mpm__io_fit(&a, d->window, dots, n, 0.02);
    MPM_FREE(dots);
    *height = (width - 2 * MPM__IO_PAD) * (a.high[1] - a.low[1]) / (a.high[0] - a.low[0]) +
              2 * MPM__IO_PAD + mpm__io_top_room(&f) + mpm__io_bottom_room(&f);
    return MPM_OK;
}

MPM_API mpm_status mpm_io_cut_png(const char *path, const mpm_io_cut_desc *d, int count,
                                  int columns, int panel_width, mpm_fault *fault)
{
    mpm_io_canvas c;
    mpm_status status = MPM_OK;
    double height = 0, most = 0;
    int i, rows;
    if (count < 1 || columns < 1 || panel_width < 1)
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "panels", count, -1);
    for (i = 0; i < count; i++) {
        status = mpm__io_cut_height(&d[i], panel_width, &height, fault);
        if (status < 0) return status;
        if (height > most) most = height;
    }
    rows = (count + columns - 1) / columns;
    status = mpm_io_canvas_init(&c, panel_width * columns, mpm__io_whole(most, 1, 16384) * rows,
                                NULL, 0);
    if (status < 0) return mpm__io_fail(fault, status, "size of picture", most, -1);
    for (i = 0; i < count && status >= 0; i++)
        status = mpm_io_cut(&c, mpm_io_tile(&c, columns, rows, i), &d[i], fault);
    if (status >= 0) status = mpm_io_png(path, &c, d[0].title, fault);
    mpm_io_canvas_free(&c);
    return status;
}

/* ---- scatter ------------------------------------------------------------------------------- */

MPM_API mpm_io_scatter_desc mpm_io_scatter_desc_default(void)
{
    mpm_io_scatter_desc d;
    memset(&d, 0, sizeof d);
    d.dot = 5;
    d.equal = 1;
    d.scale = 1;
    return d;
}

/* The finite points as dots. */
static inline size_t mpm__io_scatter_dots(const mpm_io_scatter_desc *d, mpm__io_dot *dots)
{
    size_t i, n = 0;
    for (i = 0; i < d->count; i++) {
        double x = (double)d->x[i], y = (double)d->y[i];
        if (x - x != 0 || y - y != 0) continue;
        dots[n].x = x;
        dots[n].y = y;
        dots[n].value = d->value ? d->scale * (double)d->value[i] : 0;
        dots[n].size = d->size ? (double)d->size[i] : 0;
        dots[n++].body = 0;
    }
    return n;
}

MPM_API mpm_status mpm_io_scatter(mpm_io_canvas *c, mpm_io_rect where,
                                  const mpm_io_scatter_desc *d, mpm_fault *fault)
{
    mpm__io_furniture f = {NULL, NULL, NULL, NULL, 1, 0, 0};
    mpm__io_axes a;
    mpm__io_span s;
    mpm__io_dot *dots;
    mpm_io_rect bar;
    double scale;
    size_t i, n;
    if (d->count < 1 || !d->x || !d->y)
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "points of the scatter plot", (double)d->count,
                            -1);
    dots = (mpm__io_dot *)MPM_MALLOC(d->count * sizeof *dots);
    if (!dots)
        return mpm__io_fail(fault, MPM_ERR_MEMORY, "dots of the scatter plot", (double)d->count,
                            -1);
    n = mpm__io_scatter_dots(d, dots);
    f.title = d->title;
    f.note = d->note;
    f.x_label = d->x_label;
    f.y_label = d->y_label;
    f.bar = d->label && d->value;
    f.equal = d->equal;
    mpm__io_fit(&a, d->window, dots, n, 0.05);
    mpm__io_place(c, where, &f, &a);
    s = mpm__io_value_span(dots, n, &a, d->low, d->high);
    scale = (a.right - a.left) / (a.high[0] - a.low[0]);
    mpm__io_grid(c, &a);
    mpm__io_clip(c, a.left, a.top, a.right, a.bottom);
    for (i = 0; i < n; i++) {
        double radius = d->size ? 0.5 * dots[i].size * scale : 0.5 * d->dot * c->unit;
        mpm_io_color color =
            d->value ? mpm_io_map_color(d->map, (dots[i].value - s.low) / (s.high - s.low))
                     : mpm_io_series_color(0);
        mpm_io_disc(c, mpm__io_at_x(&a, dots[i].x), mpm__io_at_y(&a, dots[i].y), radius, color);
    }
    MPM_FREE(dots);
    mpm__io_clip_none(c);
    mpm__io_frame(c, &a);
    mpm__io_heading(c, &a, &f);
    mpm__io_numbers(c, &a, d->x_label, d->y_label);
    bar.x = a.left;
    bar.width = a.right - a.left;
    bar.y = a.bottom + (mpm__io_bottom_room(&f) - MPM__IO_BAR + 16) * c->unit;
    bar.height = MPM__IO_BAR * c->unit;
    if (f.bar) mpm__io_bar(c, bar, d->map, s.low, s.high, s.below, s.above, d->label);
    return MPM_OK;
}

/* ---- plot ---------------------------------------------------------------------------------- */

MPM_API mpm_io_plot_desc mpm_io_plot_desc_default(void)
{
    mpm_io_plot_desc d;
    memset(&d, 0, sizeof d);
    return d;
}

/* Sets one axis: the window given, or the extent of all curves and a little more. Returns 0 when
   there is nothing to show. */
static inline int mpm__io_plot_range(const mpm_io_plot_desc *d, int axis, mpm__io_axes *a)
{
    int is_log = axis == 0 ? d->log_x : d->log_y, found = 0, k;
    double low = d->window[2 * axis], high = d->window[2 * axis + 1], pad;
    size_t i;
    a->log[axis] = is_log;
    if (high > low && (!is_log || low > 0)) {
        a->low[axis] = is_log ? log10(low) : low;
        a->high[axis] = is_log ? log10(high) : high;
        return 1;
    }
    for (k = 0; k < d->curve_count; k++)
        for (i = 0; i < d->curves[k].count; i++) {
            double v = (double)(axis == 0 ? d->curves[k].x[i] : d->curves[k].y[i]);
            if (is_log) v = v > 0 ? log10(v) : NAN;
            if (v - v != 0) continue;
            if (!found || v < low) low = v;
            if (!found || v > high) high = v;
            found = 1;
        }
    if (!found) return 0;
    pad = (axis == 0 ? 0.02 : 0.06) * (high - low);
    if (!(pad > 0)) pad = low != 0 ? 0.1 * fabs(low) : 0.5;
    a->low[axis] = low - pad;
    a->high[axis] = high + pad;
    return 1;
}

/* Point i of a curve in pixels; 0 when it cannot be shown. */
static inline int mpm__io_curve_point(const mpm__io_axes *a, const mpm_io_curve *curve, size_t i,
                                      double at[2])
{
    double x = (double)curve->x[i], y = (double)curve->y[i];
    if (a->log[0]) x = x > 0 ? log10(x) : NAN;
    if (a->log[1]) y = y > 0 ? log10(y) : NAN;
    at[0] = mpm__io_at_x(a, x);
    at[1] = mpm__io_at_y(a, y);
    return at[0] - at[0] == 0 && at[1] - at[1] == 0;
}

/* A segment in dashes; `phase` [pixels along the curve] is carried on to the next one. */
static inline void mpm__io_dashes(mpm_io_canvas *c, const double a[2], const double b[2],
                                  double radius, double *phase)
{
    double on = 7 * c->unit, period = 12 * c->unit, at = 0;
    double length = sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]));
    while (at < length && length < 1e5) {
        double inside = fmod(*phase + at, period), step = (inside < on ? on : period) - inside, end;
        if (step < 1e-6 * period) step = 1e-6 * period;
        end = at + step < length ? at + step : length;
        if (inside < on)
            mpm__io_segment(c, a[0] + (b[0] - a[0]) * at / length,
                            a[1] + (b[1] - a[1]) * at / length, a[0] + (b[0] - a[0]) * end / length,
                            a[1] + (b[1] - a[1]) * end / length, radius);
        at += step;
    }
    *phase = fmod(*phase + length, period);
}

static inline void mpm__io_draw_curve(mpm_io_canvas *c, const mpm__io_axes *a,
                                      const mpm_io_curve *curve)
{
    double last[2] = {0, 0}, at[2], phase = 0, radius = 0.95 * c->unit;
    int joined = 0;
    size_t i;
    for (i = 0; i < curve->count; i++) {
        int good = mpm__io_curve_point(a, curve, i, at);
        if (good && curve->mark == MPM_IO_DOTS)
            mpm__io_segment(c, at[0], at[1], at[0], at[1], 3 * c->unit);
        else if (good && joined && curve->mark == MPM_IO_DASHED)
            mpm__io_dashes(c, last, at, radius, &phase);
        else if (good && joined) mpm__io_segment(c, last[0], last[1], at[0], at[1], radius);
        joined = good;
        last[0] = at[0];
        last[1] = at[1];
    }
    mpm__io_ink(c, mpm_io_series_color(curve->color));
}

/* How many points of the curves fall into a box. */
static inline size_t mpm__io_points_inside(const mpm_io_plot_desc *d, const mpm__io_axes *a,
                                           double x, double y, double width, double height)
{
    size_t i, n = 0;
    double at[2];
    int k;
    for (k = 0; k < d->curve_count; k++)
        for (i = 0; i < d->curves[k].count; i++)
            n += mpm__io_curve_point(a, &d->curves[k], i, at) && at[0] > x && at[0] < x + width &&
                 at[1] > y && at[1] < y + height;
    return n;
}

/* The legend, in the corner that hides the fewest points. */
static inline void mpm__io_legend(mpm_io_canvas *c, const mpm__io_axes *a,
                                  const mpm_io_plot_desc *d)
{
    double u = c->unit, size = MPM__IO_NUMBER * u, row = size + 9 * u, widest = 0, width, height;
    double gap = 10 * u, x = 0, y = 0;
    size_t least = 0;
    int k, corner, names = 0;
    for (k = 0; k < d->curve_count; k++) {
        double w = d->curves[k].name ? mpm_io_text_width(size, d->curves[k].name) : 0;
        if (w > widest) widest = w;
        names += d->curves[k].name != NULL;
    }
    if (names == 0) return;
    width = widest + 50 * u;
    height = names * row + 9 * u;
    for (corner = 0; corner < 4; corner++) {
        double left = corner % 2 ? a->left + gap : a->right - gap - width;
        double top = corner / 2 ? a->bottom - gap - height : a->top + gap;
        size_t hidden = mpm__io_points_inside(d, a, left, top, width, height);
        if (corner > 0 && hidden >= least) continue;
        least = hidden;
        x = left;
        y = top;
    }
    mpm_io_rectangle(c, x, y, width, height, MPM__IO_GRID);
    mpm_io_rectangle(c, x + u, y + u, width - 2 * u, height - 2 * u, 0xffffff);
    y += 9 * u;
    for (k = 0; k < d->curve_count; k++) {
        double from[2], to[2], phase = 0;
        if (!d->curves[k].name) continue;
        from[0] = x + 10 * u;
        to[0] = x + 33 * u;
        from[1] = to[1] = y + 0.5 * size;
        if (d->curves[k].mark == MPM_IO_DOTS)
            mpm__io_segment(c, x + 21 * u, to[1], x + 21 * u, to[1], 3 * u);
        else if (d->curves[k].mark == MPM_IO_DASHED) mpm__io_dashes(c, from, to, 0.95 * u, &phase);
        else mpm__io_segment(c, from[0], from[1], to[0], to[1], 0.95 * u);
        mpm__io_ink(c, mpm_io_series_color(d->curves[k].color));
        mpm_io_text(c, x + 40 * u, y + size, size, MPM_IO_LEFT, MPM__IO_INK, d->curves[k].name);
        y += row;
    }
}

MPM_API mpm_status mpm_io_plot(mpm_io_canvas *c, mpm_io_rect where, const mpm_io_plot_desc *d,
                               mpm_fault *fault)
{
    mpm__io_furniture f = {NULL, NULL, NULL, NULL, 1, 0, 0};
    mpm__io_axes a;
    int k;
    if (!mpm__io_plot_range(d, 0, &a) || !mpm__io_plot_range(d, 1, &a))
        return mpm__io_fail(fault, MPM_ERR_ARGUMENT, "points of the curves", 0, -1);
    f.title = d->title;
    f.note = d->note;
    f.x_label = d->x_label;
    f.y_label = d->y_label;
    mpm__io_place(c, where, &f, &a);
    mpm__io_grid(c, &a);
    mpm__io_clip(c, a.left, a.top, a.right, a.bottom);
    for (k = 0; k < d->curve_count; k++) mpm__io_draw_curve(c, &a, &d->curves[k]);
    mpm__io_clip_none(c);
    mpm__io_frame(c, &a);
    mpm__io_heading(c, &a, &f);
    mpm__io_numbers(c, &a, d->x_label, d->y_label);
    mpm__io_legend(c, &a, d);
    return MPM_OK;
}

#ifdef __cplusplus
}
#endif
#endif /* MPM_IO_IMPLEMENTED */
#endif /* MPM_IMPLEMENTATION || MPM_IO_IMPLEMENTATION */

/* References: PNG Specification, W3C; RFC 1950 and 1951 for zlib and deflate; the XML formats of
   the VTK file format documentation.

   MIT License: see LICENSE. */
