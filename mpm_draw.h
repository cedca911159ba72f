/* mpm_draw.h - pictures for mpm.h: canvas, text, axes, cuts, solids, scatter plots, curves.
   Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm_draw.h"
       #include "mpm_draw.h"
     Make a canvas, draw figures into its tiles; canvas.rgb then holds the pixels, for a window, a
     film or a file (mpm_io_png of mpm_io.h writes them as they are). Link with -lm.

   WHAT IT DOES NOT DO
     It writes no files. It draws cuts, solids, scatter plots and curves, without perspective and without
     glass: for those write .vtu files and open them in ParaView. It never prints, never exits, and keeps
     no global state.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm_draw.h"
       #include "mpm_io.h"
       int main(void) {
           mpm_real x[2] = {0, 1}, y[2] = {0, 0}, z[2] = {0, 1}, hot[2] = {300, 900};
           mpm_draw_cut_desc cut = mpm_draw_cut_desc_default();
           mpm_draw_canvas c;
           mpm_fault fault;
           int bad;
           cut.count = 2; cut.x[0] = x; cut.x[1] = y; cut.x[2] = z;
           cut.spacing = 1; cut.value = hot;
           cut.label = "temperature [K]"; cut.length_unit = "um";
           if (mpm_draw_cuts(&c, &cut, 1, 1, 480, &fault) < 0) return 1;
           bad = mpm_io_png("two.png", c.rgb, c.width, c.height, "two points", &fault) < 0;
           mpm_draw_canvas_free(&c);
           return bad;
       }

   CONTENTS
     canvas        mpm_draw_canvas_bytes, _canvas_init, _canvas_free, _pixel
     primitives    mpm_draw_fill, _rectangle, _line, _disc, _text, _text_width
     colours       mpm_draw_map_color, _series_color
     numbers       mpm_draw_number, _nice, _ticks
     figures       mpm_draw_tile, _color_bar, _cut, _cuts, _solid, _scatter, _plot

   CONFIGURATION: that of mpm.h (MPM_FLOAT, MPM_STATIC, MPM_MALLOC, MPM_FREE). Memory is taken for a
   canvas without any of its own, and inside _cut, _solid and _scatter while they draw.

   CONVENTIONS
     Text is UTF-8. Pixels are counted from the top left; pixel (i, j) covers [i, i+1) x [j, j+1).
     Colours are 0xRRGGBB. Sizes of text are cap heights in pixels. */
#ifndef MPM_DRAW_H
#define MPM_DRAW_H

#include "mpm.h"
#if MPM_VERSION_NUMBER != 200
#error "mpm_draw.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_draw_canvas_bytes mpm_draw_canvas_bytes_f32
#define mpm_draw_canvas_init mpm_draw_canvas_init_f32
#define mpm_draw_canvas_free mpm_draw_canvas_free_f32
#define mpm_draw_fill mpm_draw_fill_f32
#define mpm_draw_pixel mpm_draw_pixel_f32
#define mpm_draw_rectangle mpm_draw_rectangle_f32
#define mpm_draw_line mpm_draw_line_f32
#define mpm_draw_disc mpm_draw_disc_f32
#define mpm_draw_text mpm_draw_text_f32
#define mpm_draw_text_width mpm_draw_text_width_f32
#define mpm_draw_map_color mpm_draw_map_color_f32
#define mpm_draw_series_color mpm_draw_series_color_f32
#define mpm_draw_number mpm_draw_number_f32
#define mpm_draw_nice mpm_draw_nice_f32
#define mpm_draw_ticks mpm_draw_ticks_f32
#define mpm_draw_tile mpm_draw_tile_f32
#define mpm_draw_color_bar mpm_draw_color_bar_f32
#define mpm_draw_cut_desc_default mpm_draw_cut_desc_default_f32
#define mpm_draw_cut_of mpm_draw_cut_of_f32
#define mpm_draw_cut mpm_draw_cut_f32
#define mpm_draw_cuts mpm_draw_cuts_f32
#define mpm_draw_solid_desc_default mpm_draw_solid_desc_default_f32
#define mpm_draw_solid_of mpm_draw_solid_of_f32
#define mpm_draw_solid mpm_draw_solid_f32
#define mpm_draw_scatter_desc_default mpm_draw_scatter_desc_default_f32
#define mpm_draw_scatter mpm_draw_scatter_f32
#define mpm_draw_plot_desc_default mpm_draw_plot_desc_default_f32
#define mpm_draw_plot mpm_draw_plot_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- pictures ------------------------------------------------------------------------------ */

typedef uint32_t mpm_draw_color; /* 0xRRGGBB */

/* An 8-bit RGB picture. `unit` is the size of one design pixel: text, lines and margins of the
   figures scale with it, so that width, height and unit doubled give the same picture, finer. */
typedef struct mpm_draw_canvas {
    int width, height;   /* pixels */
    double unit;         /* 1 after init; change at will */
    unsigned char *rgb;  /* 3 width height bytes, row by row from the top */
    unsigned char *mask; /* width height bytes: coverage of the shape being drawn */
    int box[4];          /* the part of the mask in use: left, top, right, bottom */
    int clip[4];         /* where drawing is allowed, within the picture: left, top, right, bottom; all of it after
                            init; change at will, figures keep to it */
    void *memory;        /* to be freed, or NULL when it is the caller's */
} mpm_draw_canvas;

/* Memory needed for width x height pixels; 0 when that is out of range (1 .. 16384 each).
   Test: 41_draw "canvas". */
MPM_API size_t mpm_draw_canvas_bytes(int width, int height);
/* A white canvas in the caller's memory, or in allocated memory when `memory` is NULL.
   MPM_ERR_ARGUMENT, MPM_ERR_MEMORY. Test: 41_draw "canvas". */
MPM_API mpm_status mpm_draw_canvas_init(mpm_draw_canvas *c, int width, int height, void *memory, size_t bytes);
/* Gives back what init allocated, if it did: the canvas then has no pixels. Harmless once more.
   Test: 41_draw "canvas". */
MPM_API void mpm_draw_canvas_free(mpm_draw_canvas *c);

/* The colour of the pixel in column x, row y; 0, black, outside the picture. Test: 41_draw "canvas". */
MPM_API mpm_draw_color mpm_draw_pixel(const mpm_draw_canvas *c, int x, int y);

/* Primitives. Coordinates in pixels; whatever lies outside is cut off. Rectangles have sharp edges
   at the nearest pixel, everything else is smoothed. Test: 41_draw "drawing". */
MPM_API void mpm_draw_fill(mpm_draw_canvas *c, mpm_draw_color color);
MPM_API void mpm_draw_rectangle(mpm_draw_canvas *c, double x, double y, double width, double height,
                                mpm_draw_color color);
MPM_API void mpm_draw_line(mpm_draw_canvas *c, double ax, double ay, double bx, double by, double width,
                           mpm_draw_color color);
MPM_API void mpm_draw_disc(mpm_draw_canvas *c, double x, double y, double radius, mpm_draw_color color);

/* Which part of a text stands at its x. */
typedef enum mpm_draw_align { MPM_DRAW_LEFT = 0, MPM_DRAW_CENTER = 1, MPM_DRAW_RIGHT = 2 } mpm_draw_align;

/* Text with its baseline at y, in a stroke font of our own: ASCII and the signs for micro, degree,
   minus, times, middle dot, superscript 2 and 3. Unknown characters show as an empty box.
   Test: 41_draw "drawing". */
MPM_API void mpm_draw_text(mpm_draw_canvas *c, double x, double y, double size, mpm_draw_align align,
                           mpm_draw_color color, const char *text);
MPM_API double mpm_draw_text_width(double size, const char *text);

/* Colour maps of even steps in lightness: DEEP dark blue - teal - yellow; HEAT dark violet - red -
   pale yellow; DIVERGING blue - white - red. */
typedef enum mpm_draw_map { MPM_DRAW_DEEP = 0, MPM_DRAW_HEAT = 1, MPM_DRAW_DIVERGING = 2 } mpm_draw_map;

/* The colour at t, clamped to 0 .. 1; grey when t is not a number. Test: 41_draw "colours". */
MPM_API mpm_draw_color mpm_draw_map_color(mpm_draw_map map, double t);
/* Distinct colours for curves and bodies, repeating after eight. Test: 41_draw "colours". */
MPM_API mpm_draw_color mpm_draw_series_color(int number);

/* ---- numbers and ticks --------------------------------------------------------------------- */

/* Writes a number for people into buffer[n]: `digits` significant ones (1 .. 15), no zeros behind, "0.25",
   "1200", "1.2e6"; a decimal point under every locale. 32 bytes always suffice; returns the length written.
   Test: 41_draw "numbers". */
MPM_API size_t mpm_draw_number(char *buffer, size_t n, double value, int digits);

/* A mark on an axis and its text. */
typedef struct mpm_draw_tick {
    double at;     /* in the units of the axis; of a logarithmic one the exponent */
    char text[32]; /* empty for a minor tick; "10^-3" for a power */
} mpm_draw_tick;

#define MPM_DRAW_TICKS 64 /* most ticks of an axis */

/* The 1, 2 or 5 times a power of ten next below or at `value` > 0. Test: 41_draw "ticks". */
MPM_API double mpm_draw_nice(double value);
/* Ticks at nice values between low and high (exponents, if is_log), with at most `want` steps (but two).
   Their texts differ from each other. Returns how many. Test: 41_draw "ticks". */
MPM_API int mpm_draw_ticks(double low, double high, int is_log, int want, mpm_draw_tick ticks[MPM_DRAW_TICKS]);

/* ---- figures ------------------------------------------------------------------------------- */

/* Figures are drawn into a part of a canvas, so that any of them can share one picture. */
typedef struct mpm_draw_rect { double x, y, width, height; } mpm_draw_rect;

/* Tile `number` (row by row from the top left) of a canvas split into columns x rows; all zero where these are below
   1, and then no figure can be drawn. Test: 41_draw "cut", "odd sizes". */
MPM_API mpm_draw_rect mpm_draw_tile(const mpm_draw_canvas *c, int columns, int rows, int number);

/* A horizontal colour bar over the width of `where`, with ticks and its label below. Test: 41_draw "colour bar". */
MPM_API void mpm_draw_color_bar(mpm_draw_canvas *c, mpm_draw_rect where, mpm_draw_map map, double low, double high,
                                const char *label);

/* How a cut is coloured inside a body: each pixel by its nearest point, or by the mean over the
   points of that body around it. Bodies are never mixed. */
typedef enum mpm_draw_style { MPM_DRAW_SMOOTH = 0, MPM_DRAW_NEAREST = 1 } mpm_draw_style;

/* A cut through a set of points: those within half_thickness of a plane normal to an axis. */
typedef struct mpm_draw_cut_desc {
    unsigned mark;          /* set by mpm_draw_cut_desc_default */
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
    mpm_draw_map map;
    mpm_draw_style style;
    double scale;           /* multiplies the value */
    double low, high;       /* colour range, of the scaled value; equal: fit to the points drawn */
    const char *label;      /* of the colour bar, with units; NULL: no bar */
    const char *title;      /* top left; NULL: none */
    const char *time;       /* top right, e.g. "t = 40 ns"; NULL: none */
    const char *length_unit; /* with the scale bar; NULL: no scale bar */
    double length_scale;    /* printed length = length_scale * length; 1 */
    int ticks;              /* 1: coordinates along the frame instead of a scale bar */
    size_t line_count;      /* lines to draw over the points: outlines */
    const double (*lines)[4]; /* from x, z to x, z of the plane [length]; NULL without any */
} mpm_draw_cut_desc;

/* normal 1, scale 1, map DEEP, style SMOOTH; count, x and spacing must be set ... Test: 41_draw "cut". */
MPM_API mpm_draw_cut_desc mpm_draw_cut_desc_default(void);
/* ... or taken from a world, with `value` one of its point arrays, for instance
   world->points.plastic_strain (NULL: coloured by body). Test: 41_draw "world". */
MPM_API mpm_draw_cut_desc mpm_draw_cut_of(const mpm_world *world, const mpm_real *value);

/* Draws the cut into `where`. MPM_ERR_ARGUMENT (the fault names the field) when something needed is
   missing or no point lies in the slab; MPM_ERR_MEMORY. Test: 41_draw "cut". */
MPM_API mpm_status mpm_draw_cut(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_cut_desc *d, mpm_fault *fault);
/* Makes the canvas c, in allocated memory, with `count` cuts in `columns` columns on it, each panel_width
   pixels wide and as high as the windows ask for. On failure there is nothing to free. Test: 41_draw "cut". */
MPM_API mpm_status mpm_draw_cuts(mpm_draw_canvas *c, const mpm_draw_cut_desc *cuts, int count, int columns,
                                 int panel_width, mpm_fault *fault);

/* Bodies in space, seen from afar without perspective: triangles, or a ball at every place. What is nearer hides what
   is behind it. The colour of the value is dimmed by Lambert's law: 0.35 + 0.65 cos of the angle between the normal and
   the light, which comes over the left shoulder: -0.40 to the right, 0.55 upwards, 0.73 from the eye. */
typedef struct mpm_draw_solid_desc {
    unsigned mark;           /* set by mpm_draw_solid_desc_default */
    size_t count;            /* places */
    const mpm_real *x[3];    /* [length] */
    const mpm_real *value;   /* colour, of each place; NULL colours by body */
    const int32_t *body;     /* body numbers; NULL: one body */
    const mpm_world *world;  /* the world of these places, if they are its points: body numbers and sizes come from
                                it and retired points are left out; or NULL */
    double size;             /* diameter of a ball [length]; 0: 1.3 times the spacing of the point's body */
    size_t triangles;        /* between the places; 0: balls */
    const int32_t (*triangle)[3]; /* their corners; either side may be in front */
    int mirror[3];           /* 1: also the images in x = 0, y = 0, z = 0 */
    double turn, lift;       /* where the eye is: degrees about z, from -y towards x; degrees above the horizon */
    double box[6];           /* xmin, xmax, ymin, ymax, zmin, zmax that has to be seen [length]; all 0: all there is */
    mpm_draw_map map;
    double scale;            /* multiplies the value */
    double low, high;        /* colour range, of the scaled value; equal: fit to what is seen */
    const char *label, *title, *time, *length_unit; /* as for the cut */
} mpm_draw_solid_desc;

/* From 30 degrees to the right and 25 above, scale 1; count, x and size or triangles must be set ...
   Test: 41_draw "solid". */
MPM_API mpm_draw_solid_desc mpm_draw_solid_desc_default(void);
/* ... or taken from a world, whose points are balls then. Its mirrors are the world's. Test: 41_draw "solid". */
MPM_API mpm_draw_solid_desc mpm_draw_solid_of(const mpm_world *world, const mpm_real *value);
/* MPM_ERR_ARGUMENT (the fault names the field) when something needed is missing or not finite, MPM_ERR_MEMORY.
   Test: 41_draw "solid". */
MPM_API mpm_status mpm_draw_solid(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_solid_desc *d,
                                  mpm_fault *fault);

/* Discs in a plane, coloured by value: plumes, deposit patterns, correlations. */
typedef struct mpm_draw_scatter_desc {
    unsigned mark;           /* set by mpm_draw_scatter_desc_default */
    size_t count;
    const mpm_real *x, *y;
    const mpm_real *value;   /* colour; NULL: one colour */
    const mpm_real *size;    /* diameter of each disc [as x]; NULL: dot pixels for all */
    double dot;              /* diameter in design pixels where size is NULL; 5 */
    int equal;               /* 1: the same scale along x and y */
    double window[4];        /* xmin, xmax, ymin, ymax; all 0: fit */
    mpm_draw_map map;
    double scale, low, high; /* as for the cut */
    const char *label, *title, *note; /* colour bar, top left, top right */
    const char *x_label, *y_label;
} mpm_draw_scatter_desc;

/* dot 5, equal 1, scale 1. Test: 41_draw "scatter and plot". */
MPM_API mpm_draw_scatter_desc mpm_draw_scatter_desc_default(void);
/* MPM_ERR_ARGUMENT (the fault names the field) when something needed is missing or no point has a finite place;
   MPM_ERR_MEMORY. Test: 41_draw "scatter and plot". */
MPM_API mpm_status mpm_draw_scatter(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_scatter_desc *d,
                                    mpm_fault *fault);

/* How a curve is drawn. */
typedef enum mpm_draw_mark { MPM_DRAW_CURVE = 0, MPM_DRAW_DOTS = 1, MPM_DRAW_DASHED = 2 } mpm_draw_mark;

/* One curve or set of dots; not-finite points break it. */
typedef struct mpm_draw_curve {
    const char *name; /* in the legend; NULL: not there */
    size_t count;
    const mpm_real *x, *y;
    mpm_draw_mark mark;
    int color;        /* number for mpm_draw_series_color */
} mpm_draw_curve;

/* Curves in one pair of axes. */
typedef struct mpm_draw_plot_desc {
    unsigned mark;        /* set by mpm_draw_plot_desc_default */
    const mpm_draw_curve *curves;
    int curve_count;
    double window[4];     /* xmin, xmax, ymin, ymax; a pair of zeros fits that axis */
    int log_x, log_y;     /* 1: decimal logarithm */
    const char *title, *note, *x_label, *y_label; /* note: top right */
} mpm_draw_plot_desc;

/* Linear axes, fitted. Test: 41_draw "scatter and plot". */
MPM_API mpm_draw_plot_desc mpm_draw_plot_desc_default(void);
/* MPM_ERR_ARGUMENT when there is nothing to draw. Test: 41_draw "scatter and plot". */
MPM_API mpm_status mpm_draw_plot(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_plot_desc *d,
                                 mpm_fault *fault);

#ifdef __cplusplus
}
#endif
#endif /* MPM_DRAW_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__DRAW_IMPLEMENTED)
#define MPM__DRAW_IMPLEMENTED

#include <math.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- numbers as text ----------------------------------------------------------------------- */

/* value times ten to a power, to the nearest whole number; from the middle to the even one, as printf does.
   fma tells what the rounding of the product hid. */
static inline double mpm__draw_nearest(double value, int power)
{
    double ten = pow(10.0, power < 0 ? -power : power), scaled = power < 0 ? value / ten : value * ten;
    double hidden = power < 0 ? fma(-scaled, ten, value) : fma(value, ten, -scaled);
    double low = floor(scaled), rest = scaled - low;
    if (rest < 0.5) return low;
    if (rest > 0.5 || hidden > 0) return low + 1;
    return hidden < 0 || fmod(low, 2) < 0.5 ? low : low + 1;
}

/* The digits of 0 <= whole < 1e15 into text[32], with a point before the last `decimals` <= 15 of them. */
static inline void mpm__draw_digits(char *text, int negative, double whole, int decimals)
{
    uint64_t rest = (uint64_t)whole;
    char digit[32];
    int n = 0;
    for (; n <= decimals || rest > 0; rest /= 10) digit[n++] = (char)('0' + rest % 10);
    if (negative) *text++ = '-';
    while (n > 0) {
        if (n == decimals) *text++ = '.';
        *text++ = digit[--n];
    }
    *text = 0;
}

/* With `decimals` digits behind the point; below 1e15 times ten to minus them. */
static inline void mpm__draw_fixed(char text[32], double value, int decimals)
{
    mpm__draw_digits(text, value < 0, mpm__draw_nearest(fabs(value), decimals), decimals);
}

/* The `digits` leading digits of size > 0 as a whole number; size is that times 10^(*exponent - digits + 1). */
static inline double mpm__draw_leading(double size, int digits, int *exponent)
{
    double whole, full = pow(10.0, digits);
    *exponent = (int)floor(log10(size));
    whole = mpm__draw_nearest(size, digits - 1 - *exponent);
    if (whole >= full) ++*exponent;          /* 9.996 to three digits is 10.0 */
    else if (whole < full / 10) --*exponent; /* the logarithm was rounded up */
    else return whole;
    return mpm__draw_nearest(size, digits - 1 - *exponent);
}

/* A finite value with its significant digits, the zeros behind left out. */
static inline void mpm__draw_general(char text[64], double value, int digits)
{
    const int wanted = digits, negative = value < 0;
    int exponent;
    double whole = mpm__draw_leading(fabs(value), digits, &exponent);
    for (; digits > 1 && fmod(whole, 10) < 0.5; digits--) whole /= 10;
    if (exponent < -4 || exponent >= wanted) {
        mpm__draw_digits(text, negative, whole, digits - 1);
        text += strlen(text);
        *text++ = 'e';
        mpm__draw_fixed(text, exponent, 0);
    } else if (exponent < digits) mpm__draw_digits(text, negative, whole, digits - 1 - exponent);
    else mpm__draw_digits(text, negative, mpm__draw_nearest(whole, exponent - digits + 1), 0);
}

MPM_API size_t mpm_draw_number(char *buffer, size_t n, double value, int digits)
{
    char text[64];
    digits = digits < 1 ? 1 : digits > 15 ? 15 : digits;
    if (value - value != 0) strcpy(text, value != value ? "nan" : value > 0 ? "inf" : "-inf");
    else if (fabs(value) > 1e-290) mpm__draw_general(text, value, digits);
    else strcpy(text, "0");
    return mpm_append(buffer, n, 0, text);
}

/* ---- canvas -------------------------------------------------------------------------------- */

MPM_API size_t mpm_draw_canvas_bytes(int width, int height)
{
    if (width < 1 || height < 1 || width > 16384 || height > 16384) return 0;
    return (size_t)width * (size_t)height * 4;
}

MPM_API mpm_status mpm_draw_canvas_init(mpm_draw_canvas *c, int width, int height, void *memory, size_t bytes)
{
    size_t need = mpm_draw_canvas_bytes(width, height), pixels = need / 4;
    memset(c, 0, sizeof *c);
    if (need == 0) return MPM_ERR_ARGUMENT;
    if (memory && bytes < need) return MPM_ERR_MEMORY;
    if (!memory) c->memory = memory = MPM_MALLOC(need);
    if (!memory) return MPM_ERR_MEMORY;
    c->width = c->box[0] = c->clip[2] = width;
    c->height = c->box[1] = c->clip[3] = height;
    c->unit = 1;
    c->rgb = (unsigned char *)memory;
    c->mask = c->rgb + 3 * pixels;
    memset(c->rgb, 255, 3 * pixels);
    memset(c->mask, 0, pixels);
    return MPM_OK;
}

MPM_API void mpm_draw_canvas_free(mpm_draw_canvas *c)
{
    if (c->memory) MPM_FREE(c->memory);
    memset(c, 0, sizeof *c);
}

/* The nearest whole number, kept within low .. high whatever the value. */
static inline int mpm__draw_whole(double value, int low, int high)
{
    if (!(value > low)) return low;
    return value < high ? (int)(value + 0.5) : high;
}

static inline void mpm__draw_set(unsigned char *p, mpm_draw_color color)
{
    p[0] = (unsigned char)(color >> 16);
    p[1] = (unsigned char)(color >> 8);
    p[2] = (unsigned char)color;
}

/* From a to b as t goes from 0 to 1. */
static inline mpm_draw_color mpm__draw_blend(mpm_draw_color a, mpm_draw_color b, double t)
{
    mpm_draw_color result = 0;
    int shift;
    for (shift = 16; shift >= 0; shift -= 8) {
        double from = (double)(a >> shift & 255), to = (double)(b >> shift & 255);
        result |= (mpm_draw_color)(from + (to - from) * t + 0.5) << shift;
    }
    return result;
}

MPM_API void mpm_draw_rectangle(mpm_draw_canvas *c, double x, double y, double width, double height,
                                mpm_draw_color color)
{
    int left = mpm__draw_whole(x, c->clip[0], c->clip[2]);
    int right = mpm__draw_whole(x + width, c->clip[0], c->clip[2]);
    int top = mpm__draw_whole(y, c->clip[1], c->clip[3]);
    int bottom = mpm__draw_whole(y + height, c->clip[1], c->clip[3]), i, j;
    for (j = top; j < bottom; j++)
        for (i = left; i < right; i++) mpm__draw_set(c->rgb + 3 * ((size_t)j * (size_t)c->width + (size_t)i), color);
}

MPM_API void mpm_draw_fill(mpm_draw_canvas *c, mpm_draw_color color)
{
    mpm_draw_rectangle(c, 0, 0, c->width, c->height, color);
}

MPM_API mpm_draw_color mpm_draw_pixel(const mpm_draw_canvas *c, int x, int y)
{
    const unsigned char *p;
    if (x < 0 || y < 0 || x >= c->width || y >= c->height) return 0;
    p = c->rgb + 3 * ((size_t)y * (size_t)c->width + (size_t)x);
    return (mpm_draw_color)p[0] << 16 | (mpm_draw_color)p[1] << 8 | p[2];
}

/* Lines, discs and letters are all thick segments with round ends. Their coverage goes into the
   mask, where overlapping parts of one shape keep the greater, and is inked once at the end: so
   joints are no darker than the rest. */
static inline void mpm__draw_segment(mpm_draw_canvas *c, double ax, double ay, double bx, double by, double radius)
{
    double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy, reach = radius + 1;
    int left = mpm__draw_whole((ax < bx ? ax : bx) - reach, c->clip[0], c->clip[2]);
    int right = mpm__draw_whole((ax < bx ? bx : ax) + reach, c->clip[0], c->clip[2]);
    int top = mpm__draw_whole((ay < by ? ay : by) - reach, c->clip[1], c->clip[3]);
    int bottom = mpm__draw_whole((ay < by ? by : ay) + reach, c->clip[1], c->clip[3]), i, j;
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
static inline void mpm__draw_ink(mpm_draw_canvas *c, mpm_draw_color color)
{
    int i, j;
    for (j = c->box[1]; j < c->box[3]; j++)
        for (i = c->box[0]; i < c->box[2]; i++) {
            size_t at = (size_t)j * (size_t)c->width + (size_t)i;
            if (c->mask[at] == 0) continue;
            mpm__draw_set(c->rgb + 3 * at, mpm__draw_blend(mpm_draw_pixel(c, i, j), color, c->mask[at] / 255.0));
            c->mask[at] = 0;
        }
    c->box[0] = c->width;
    c->box[1] = c->height;
    c->box[2] = c->box[3] = 0;
}

MPM_API void mpm_draw_line(mpm_draw_canvas *c, double ax, double ay, double bx, double by, double width,
                           mpm_draw_color color)
{
    mpm__draw_segment(c, ax, ay, bx, by, 0.5 * width);
    mpm__draw_ink(c, color);
}

MPM_API void mpm_draw_disc(mpm_draw_canvas *c, double x, double y, double radius, mpm_draw_color color)
{
    mpm__draw_segment(c, x, y, x, y, radius);
    mpm__draw_ink(c, color);
}

/* ---- text ---------------------------------------------------------------------------------- */

/* The font. Each glyph is its width and its strokes; a stroke is a list of points, x as a digit
   and y as a letter ('d' the baseline, 'j' the height of x, 'm' of capitals, 'a' the descender).
   The points steer a quadratic B-spline: two make a straight line, a repeated one a corner, and
   the rest is round. So "6 0m0g0d6d6g6m" is a U: down, round the bottom, up again. */
static inline const char *mpm__draw_glyph(uint32_t code)
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
    case 0xb5:
    case 0x3bc: return "5 0j0a 0g0d5d5g 5j5d"; /* micro, mu */
    case 0xb0: return "4 0k0m4m4i0i0k";        /* degree */
    case 0xb2: return "3 0l0n3n3k0h0h3h";      /* squared */
    case 0xb3: return "3 0n3n3k1k 1k3k3h0h";   /* cubed */
    case 0xb7: return "0 0h0h";                /* middle dot */
    case 0xd7: return "5 0j5e 5j0e";           /* times */
    case 0x2212: return "6 0h6h";              /* minus */
    default: return "5 0m0m5m5m5d5d0d0d0m";
    }
}

/* The next UTF-8 character; a broken one counts as unknown. */
static inline uint32_t mpm__draw_next_character(const char **text)
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
typedef struct mpm__draw_pen {
    double x, y, unit, radius;
    int up;
} mpm__draw_pen;

#define MPM__DRAW_NARROW 0.86 /* widths of the table, as drawn */
#define MPM__DRAW_GAP 2.5     /* between glyphs, centre line to centre line [design units] */

static inline void mpm__draw_pen_segment(mpm_draw_canvas *c, const mpm__draw_pen *p, const double a[2],
                                         const double b[2])
{
    double u = p->unit;
    if (p->up) mpm__draw_segment(c, p->x - u * a[1], p->y - u * a[0], p->x - u * b[1], p->y - u * b[0], p->radius);
    else mpm__draw_segment(c, p->x + u * a[0], p->y - u * a[1], p->x + u * b[0], p->y - u * b[1], p->radius);
}

/* One stroke: from the middle of each pair of points to the middle of the next, bent towards the
   point between. Returns the character after it. */
static inline const char *mpm__draw_stroke(mpm_draw_canvas *c, const mpm__draw_pen *pen, const char *s)
{
    enum { PIECES = 6 };
    double from[2], to[2], a[2], b[2];
    int i, k;
    from[0] = MPM__DRAW_NARROW * (s[0] - '0');
    from[1] = s[1] - 'd';
    if (s[4] == 0 || s[4] == ' ') { /* two points: a straight line */
        to[0] = MPM__DRAW_NARROW * (s[2] - '0');
        to[1] = s[3] - 'd';
        mpm__draw_pen_segment(c, pen, from, to);
        return s + 4;
    }
    for (s += 2; s[2] != 0 && s[2] != ' '; s += 2) {
        int last = s[4] == 0 || s[4] == ' ';
        double bend[2], next[2];
        bend[0] = MPM__DRAW_NARROW * (s[0] - '0');
        bend[1] = s[1] - 'd';
        next[0] = MPM__DRAW_NARROW * (s[2] - '0');
        next[1] = s[3] - 'd';
        for (k = 0; k < 2; k++) {
            to[k] = last ? next[k] : 0.5 * (bend[k] + next[k]);
            a[k] = from[k];
        }
        for (i = 1; i <= PIECES; i++) {
            double t = (double)i / (double)PIECES, r = 1 - t;
            for (k = 0; k < 2; k++) b[k] = r * r * from[k] + 2 * r * t * bend[k] + t * t * to[k];
            mpm__draw_pen_segment(c, pen, a, b);
            for (k = 0; k < 2; k++) a[k] = b[k];
        }
        for (k = 0; k < 2; k++) from[k] = to[k];
    }
    return s + 2;
}

MPM_API double mpm_draw_text_width(double size, const char *text)
{
    double width = 0;
    if (!*text) return 0;
    while (*text)
        width += MPM__DRAW_NARROW * (mpm__draw_glyph(mpm__draw_next_character(&text))[0] - '0') + MPM__DRAW_GAP;
    return (width - MPM__DRAW_GAP) * size / 9;
}

/* Text along x, or upwards, with a stroke of `weight` design units (capitals are 9 high). */
static inline void mpm__draw_write(mpm_draw_canvas *c, double x, double y, double size, mpm_draw_align align, int up,
                                   double weight, mpm_draw_color color, const char *text)
{
    double shift = 0.5 * (double)align * mpm_draw_text_width(size, text);
    mpm__draw_pen pen;
    pen.x = up ? x : x - shift;
    pen.y = up ? y + shift : y;
    pen.unit = size / 9;
    pen.radius = 0.5 * weight * pen.unit;
    pen.up = up;
    while (*text) {
        const char *glyph = mpm__draw_glyph(mpm__draw_next_character(&text)), *s = glyph + 1;
        double step = (MPM__DRAW_NARROW * (glyph[0] - '0') + MPM__DRAW_GAP) * pen.unit;
        while (*s == ' ') s = mpm__draw_stroke(c, &pen, s + 1);
        if (up) pen.y -= step;
        else pen.x += step;
    }
    mpm__draw_ink(c, color);
}

MPM_API void mpm_draw_text(mpm_draw_canvas *c, double x, double y, double size, mpm_draw_align align,
                           mpm_draw_color color, const char *text)
{
    mpm__draw_write(c, x, y, size, align, 0, 1.15, color, text);
}

/* ---- colours ------------------------------------------------------------------------------- */

MPM_API mpm_draw_color mpm_draw_map_color(mpm_draw_map map, double t)
{
    /* Control points of even steps in CIELAB lightness along a path of hues we chose. */
    static const mpm_draw_color points[3][11] = {
        {0x083271, 0x014486, 0x03579a, 0x076e9c, 0x0284a4, 0x029aa9, 0x0cb1a9, 0x08c99b, 0x72db83, 0xb1eb65, 0xf7f449},
        {0x2c274d, 0x542b67, 0x882375, 0xbb1263, 0xde2843, 0xf14e38, 0xff702c, 0xff963a, 0xffb851, 0xffd580, 0xfff0c2},
        {0x055987, 0x0177b3, 0x3a95d5, 0x83b2e0, 0xb8cfea, 0xf4eceb, 0xecc4be, 0xe09c93, 0xd1756a, 0xbe4c44, 0xa02626}};
    int k;
    if (t != t || (unsigned)map > 2) return 0x9aa0a6; /* grey: no number, or no such map */
    t = 10 * (t < 0 ? 0 : t > 1 ? 1 : t);
    k = t < 10 ? (int)t : 9;
    return mpm__draw_blend(points[map][k], points[map][k + 1], t - k);
}

MPM_API mpm_draw_color mpm_draw_series_color(int number)
{
    static const mpm_draw_color colors[8] = {0x17669e, 0xd9541e, 0x2a8f5c, 0x8a4fa3,
                                             0xc9930a, 0x3aa6b9, 0xb8325a, 0x6b7785};
    return colors[(unsigned)number % 8];
}

/* ---- axes ---------------------------------------------------------------------------------- */

/* Design sizes, in units of the canvas. */
#define MPM__DRAW_INK 0x1f2933u    /* text */
#define MPM__DRAW_SOFT 0x52606du   /* secondary text */
#define MPM__DRAW_FRAME 0x9aa5b1u  /* frames and ticks */
#define MPM__DRAW_GRID 0xe8ecf0u   /* grid lines */
#define MPM__DRAW_PAD 16.0         /* around a figure */
#define MPM__DRAW_TITLE 10.5       /* cap heights */
#define MPM__DRAW_LABEL 9.0
#define MPM__DRAW_NUMBER 8.0
#define MPM__DRAW_HEADING 24.0     /* height of the line above the frame */
#define MPM__DRAW_BAR 60.0         /* height of colour bar, numbers and label below the frame */

/* A frame on the canvas and what it shows; on a logarithmic axis low and high are exponents. */
typedef struct mpm__draw_axes {
    double left, top, right, bottom; /* pixels */
    double low[2], high[2];
    int log[2];
} mpm__draw_axes;

static inline double mpm__draw_at_x(const mpm__draw_axes *a, double x)
{
    return a->left + (a->right - a->left) * (x - a->low[0]) / (a->high[0] - a->low[0]);
}

static inline double mpm__draw_at_y(const mpm__draw_axes *a, double y)
{
    return a->bottom - (a->bottom - a->top) * (y - a->low[1]) / (a->high[1] - a->low[1]);
}

MPM_API double mpm_draw_nice(double value)
{
    double power = pow(10.0, floor(log10(value) + 1e-9)), digit = value / power;
    return power * (digit > 5 - 1e-9 ? 5 : digit > 2 - 1e-9 ? 2 : 1);
}

/* A tick's number: plain where that is short, with the decimals of the step; else with so many digits that it
   differs from its neighbours. */
static inline void mpm__draw_tick_number(char text[32], double value, double step, double largest)
{
    const int place = (int)floor(log10(step) + 1e-9), decimals = place < 0 ? -place : 0;
    int digits;
    if (fabs(value) < 1e-9 * step) value = 0;
    if (largest < 1e5 && step >= 1e-4) {
        mpm__draw_fixed(text, value, decimals);
        return;
    }
    digits = (int)floor(log10(largest)) - place + 1;
    mpm_draw_number(text, 32, value, digits < 4 ? 4 : digits > 15 ? 15 : digits);
}

/* Ticks closer than a number has digits keep the first of equal texts. */
static inline void mpm__draw_tick_differs(mpm_draw_tick *ticks, int n)
{
    int k = n - 1;
    while (k >= 0 && !ticks[k].text[0]) k--;
    if (k >= 0 && strcmp(ticks[k].text, ticks[n].text) == 0) ticks[n].text[0] = 0;
}

static inline int mpm__draw_log_ticks(double low, double high, mpm_draw_tick *ticks)
{
    int n = 0, decade, digit, skip;
    if (low < -400 || high > 400) return 0; /* beyond all numbers there are */
    skip = 1 + (int)((high - low) / 8);
    for (decade = (int)floor(low); decade <= (int)ceil(high); decade++)
        for (digit = 1; digit < 10 && n < MPM_DRAW_TICKS; digit++) {
            double at = decade + log10((double)digit);
            int named = digit == 1 ? decade % skip == 0 : high - low < 1.5 && (digit == 2 || digit == 5);
            if (at < low - 1e-9 || at > high + 1e-9 || (skip > 1 && digit > 1)) continue;
            ticks[n].at = at;
            ticks[n].text[0] = 0;
            if (named && ((decade > -4 && decade < 4) || digit > 1))
                mpm_draw_number(ticks[n].text, 32, digit * pow(10.0, decade), 3);
            else if (named) mpm_draw_number(ticks[n].text + mpm_append(ticks[n].text, 32, 0, "10^"), 16, decade, 4);
            n++;
        }
    return n;
}

MPM_API int mpm_draw_ticks(double low, double high, int is_log, int want, mpm_draw_tick ticks[MPM_DRAW_TICKS])
{
    double step = mpm_draw_nice((high - low) / (want > 2 ? want : 2)), k;
    double largest = fabs(low) > fabs(high) ? fabs(low) : fabs(high);
    int n = 0;
    if (!(low < high && high - low < 1e300)) return 0; /* NaN too */
    if (is_log) return mpm__draw_log_ticks(low, high, ticks);
    if (!(step > 0)) return 0; /* the range is smaller than any number's last digit */
    if (step * (want > 2 ? want : 2) < 0.999 * (high - low)) step = mpm_draw_nice(2.51 * step);
    for (k = ceil(low / step - 1e-6); k * step <= high + 1e-6 * step && n < MPM_DRAW_TICKS; k++) {
        ticks[n].at = k * step;
        mpm__draw_tick_number(ticks[n].text, k * step, step, largest);
        mpm__draw_tick_differs(ticks, n++);
    }
    return n;
}

/* The width of a tick's text; the exponent of a power is smaller. */
static inline double mpm__draw_tick_width(double size, const char *text)
{
    const char *power = strchr(text, '^');
    char base[32] = "";
    if (!power) return mpm_draw_text_width(size, text);
    mpm_append(base, (size_t)(power - text) + 1, 0, text);
    return mpm_draw_text_width(size, base) + 0.3 * size + mpm_draw_text_width(0.72 * size, power + 1);
}

static inline void mpm__draw_tick_text(mpm_draw_canvas *c, double x, double y, double size, mpm_draw_align align,
                                       const char *text)
{
    const char *power = strchr(text, '^');
    char base[32] = "";
    if (!power) {
        mpm_draw_text(c, x, y, size, align, MPM__DRAW_SOFT, text);
        return;
    }
    x -= 0.5 * (double)align * mpm__draw_tick_width(size, text);
    mpm_append(base, (size_t)(power - text) + 1, 0, text);
    mpm_draw_text(c, x, y, size, MPM_DRAW_LEFT, MPM__DRAW_SOFT, base);
    mpm_draw_text(c, x + mpm_draw_text_width(size, base) + 0.3 * size, y - 0.55 * size, 0.72 * size, MPM_DRAW_LEFT,
                  MPM__DRAW_SOFT, power + 1);
}

/* Text made smaller until it fits a width. */
static inline void mpm__draw_write_fit(mpm_draw_canvas *c, double x, double y, double size, mpm_draw_align align,
                                       double weight, mpm_draw_color color, const char *text, double room)
{
    double width = mpm_draw_text_width(size, text);
    if (width > room && width > 0) size *= room / width;
    mpm__draw_write(c, x, y, size, align, 0, weight, color, text);
}

/* A hairline along whole pixels. */
static inline void mpm__draw_hair(mpm_draw_canvas *c, double ax, double ay, double bx, double by, mpm_draw_color color)
{
    double w = floor(c->unit + 0.5) < 1 ? 1 : floor(c->unit + 0.5);
    if (ax < bx) mpm_draw_rectangle(c, ax, by - 0.5 * w, bx - ax, w, color);
    else mpm_draw_rectangle(c, ax - 0.5 * w, ay < by ? ay : by, w, fabs(by - ay), color);
}

/* Limits drawing to the frame, as far as the clip lets it; that goes to `before`, to be put back. */
static inline void mpm__draw_clip(mpm_draw_canvas *c, const mpm__draw_axes *a, int before[4])
{
    int frame[4], k;
    frame[0] = mpm__draw_whole(a->left, 0, c->width);
    frame[1] = mpm__draw_whole(a->top, 0, c->height);
    frame[2] = mpm__draw_whole(a->right, 0, c->width);
    frame[3] = mpm__draw_whole(a->bottom, 0, c->height);
    memcpy(before, c->clip, sizeof c->clip);
    for (k = 0; k < 2; k++) {
        if (frame[k] > c->clip[k]) c->clip[k] = frame[k];
        if (frame[k + 2] < c->clip[k + 2]) c->clip[k + 2] = frame[k + 2];
        if (c->clip[k + 2] < c->clip[k]) c->clip[k + 2] = c->clip[k]; /* nothing of it can be seen */
    }
}

static inline void mpm__draw_frame(mpm_draw_canvas *c, const mpm__draw_axes *a)
{
    double h = 0.5 * c->unit;
    mpm__draw_hair(c, a->left - h, a->top, a->right + h, a->top, MPM__DRAW_FRAME);
    mpm__draw_hair(c, a->left - h, a->bottom, a->right + h, a->bottom, MPM__DRAW_FRAME);
    mpm__draw_hair(c, a->left, a->top - h, a->left, a->bottom + h, MPM__DRAW_FRAME);
    mpm__draw_hair(c, a->right, a->top - h, a->right, a->bottom + h, MPM__DRAW_FRAME);
}

/* Whole steps between ticks, of any room. */
static inline int mpm__draw_steps(double room) { return mpm__draw_whole(floor(room), 0, MPM_DRAW_TICKS); }

static inline int mpm__draw_ticks_x(const mpm_draw_canvas *c, const mpm__draw_axes *a, mpm_draw_tick *ticks)
{
    const int want = mpm__draw_steps((a->right - a->left) / (62 * c->unit));
    return mpm_draw_ticks(a->low[0], a->high[0], a->log[0], want, ticks);
}

static inline int mpm__draw_ticks_y(const mpm_draw_canvas *c, const mpm__draw_axes *a, mpm_draw_tick *ticks)
{
    const int want = mpm__draw_steps((a->bottom - a->top) / (42 * c->unit));
    return mpm_draw_ticks(a->low[1], a->high[1], a->log[1], want, ticks);
}

/* Light lines behind the data, at the named ticks. */
static inline void mpm__draw_grid(mpm_draw_canvas *c, const mpm__draw_axes *a)
{
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    int i, n = mpm__draw_ticks_x(c, a, ticks);
    for (i = 0; i < n; i++) {
        double x = mpm__draw_at_x(a, ticks[i].at);
        if (ticks[i].text[0]) mpm__draw_hair(c, x, a->top, x, a->bottom, MPM__DRAW_GRID);
    }
    n = mpm__draw_ticks_y(c, a, ticks);
    for (i = 0; i < n; i++) {
        double y = mpm__draw_at_y(a, ticks[i].at);
        if (ticks[i].text[0]) mpm__draw_hair(c, a->left, y, a->right, y, MPM__DRAW_GRID);
    }
}

/* What a figure has around its frame. */
typedef struct mpm__draw_furniture {
    const char *title, *note, *x_label, *y_label;
    const char *bar;      /* label of the colour bar; NULL: none */
    int numbers, equal;
    double length_scale;  /* of the numbers along linear axes: printed over drawn */
} mpm__draw_furniture;

/* The axes as their numbers are printed. */
static inline mpm__draw_axes mpm__draw_printed(const mpm__draw_axes *a, const mpm__draw_furniture *f)
{
    mpm__draw_axes printed = *a;
    int k;
    for (k = 0; k < 2; k++) {
        printed.low[k] *= f->length_scale;
        printed.high[k] *= f->length_scale;
    }
    return printed;
}

/* Ticks, their numbers and the labels of both axes, as printed. */
static inline void mpm__draw_numbers(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm__draw_furniture *f)
{
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    double u = c->unit, size = MPM__DRAW_NUMBER * u, widest = 0;
    int i, n = mpm__draw_ticks_x(c, a, ticks);
    for (i = 0; i < n; i++) {
        double x = mpm__draw_at_x(a, ticks[i].at), length = ticks[i].text[0] ? 5 * u : 3 * u;
        mpm__draw_hair(c, x, a->bottom, x, a->bottom + length, MPM__DRAW_FRAME);
        mpm__draw_tick_text(c, x, a->bottom + 9 * u + size, size, MPM_DRAW_CENTER, ticks[i].text);
    }
    n = mpm__draw_ticks_y(c, a, ticks);
    for (i = 0; i < n; i++) {
        double y = mpm__draw_at_y(a, ticks[i].at), length = ticks[i].text[0] ? 5 * u : 3 * u;
        double width = mpm__draw_tick_width(size, ticks[i].text);
        mpm__draw_hair(c, a->left - length, y, a->left, y, MPM__DRAW_FRAME);
        mpm__draw_tick_text(c, a->left - 9 * u, y + 0.5 * size, size, MPM_DRAW_RIGHT, ticks[i].text);
        if (width > widest) widest = width;
    }
    if (f->x_label)
        mpm__draw_write_fit(c, 0.5 * (a->left + a->right), a->bottom + (9 + 12) * u + size + MPM__DRAW_LABEL * u,
                            MPM__DRAW_LABEL * u, MPM_DRAW_CENTER, 1.15, MPM__DRAW_INK, f->x_label, a->right - a->left);
    if (f->y_label)
        mpm__draw_write(c, a->left - (9 + 10) * u - widest, 0.5 * (a->top + a->bottom), MPM__DRAW_LABEL * u,
                        MPM_DRAW_CENTER, 1, 1.15, MPM__DRAW_INK, f->y_label);
}

/* Room beside the frame for the numbers and label of the y axis [pixels]. */
static inline double mpm__draw_left_room(const mpm_draw_canvas *c, const mpm__draw_axes *a,
                                         const mpm__draw_furniture *f)
{
    const mpm__draw_axes printed = mpm__draw_printed(a, f);
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    double widest = 0;
    int i, n;
    if (!f->numbers) return 0;
    n = mpm__draw_ticks_y(c, &printed, ticks);
    for (i = 0; i < n; i++) {
        double width = mpm__draw_tick_width(MPM__DRAW_NUMBER * c->unit, ticks[i].text);
        if (width > widest) widest = width;
    }
    return widest + (9 + (f->y_label ? 10 + MPM__DRAW_LABEL : 0)) * c->unit;
}

/* Room above and below the frame [design pixels]. */
static inline double mpm__draw_top_room(const mpm__draw_furniture *f)
{
    return f->title || f->note ? MPM__DRAW_HEADING : 0;
}

static inline double mpm__draw_bottom_room(const mpm__draw_furniture *f)
{
    double room = f->numbers ? 9 + MPM__DRAW_NUMBER : 0;
    if (f->numbers && f->x_label) room += 12 + MPM__DRAW_LABEL + 2;
    return f->bar ? room + MPM__DRAW_BAR : room;
}

/* Whether a figure can have that place: a unit and sizes that pictures have. */
static inline int mpm__draw_has_room(const mpm_draw_canvas *c, mpm_draw_rect r)
{
    return c->unit > 1e-3 && c->unit < 1e3 && fabs(r.x) < 1e5 && fabs(r.y) < 1e5 && r.width > 0 && r.width < 1e5 &&
           r.height > 0 && r.height < 1e5;
}

/* Places the frame inside `where`, leaving room for the rest; with `equal` its sides follow the
   window and the whole is centred. Returns 0 where place or window allow none. */
static inline int mpm__draw_place(const mpm_draw_canvas *c, mpm_draw_rect where, const mpm__draw_furniture *f,
                                   mpm__draw_axes *a)
{
    double u = c->unit, wide = a->high[0] - a->low[0], high = a->high[1] - a->low[1];
    double spare_x, spare_y, scale;
    if (!mpm__draw_has_room(c, where)) return 0;
    if (!(wide > 1e-300 && wide < 1e300 && high > 1e-300 && high < 1e300)) return 0; /* pixels for it are finite */
    a->left = where.x + MPM__DRAW_PAD * u;
    a->right = where.x + where.width - MPM__DRAW_PAD * u;
    a->top = where.y + (MPM__DRAW_PAD + mpm__draw_top_room(f)) * u;
    a->bottom = where.y + where.height - (MPM__DRAW_PAD + mpm__draw_bottom_room(f)) * u;
    if (a->bottom < a->top + 8) a->bottom = a->top + 8;
    a->left += mpm__draw_left_room(c, a, f);
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
    return 1;
}

static inline mpm_status mpm__draw_no_place(mpm_draw_rect where, mpm_fault *fault)
{
    return mpm_fail(fault, MPM_ERR_ARGUMENT, "place, unit or window of the figure", (mpm_real)where.width, -1);
}

/* Title at the left, note at the right, above the frame. */
static inline void mpm__draw_heading(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm__draw_furniture *f)
{
    double u = c->unit, room = a->right - a->left, y = a->top - 10 * u;
    if (f->note) {
        mpm__draw_write_fit(c, a->right, y, MPM__DRAW_LABEL * u, MPM_DRAW_RIGHT, 1.15, MPM__DRAW_SOFT, f->note, room);
        room -= mpm_draw_text_width(MPM__DRAW_LABEL * u, f->note) + 14 * u;
    }
    if (f->title && room > 0)
        mpm__draw_write_fit(c, a->left, y, MPM__DRAW_TITLE * u, MPM_DRAW_LEFT, 1.6, MPM__DRAW_INK, f->title, room);
}

/* ---- colour bar ---------------------------------------------------------------------------- */

/* A range of values, and whether there are some below or above it. */
typedef struct mpm__draw_span {
    double low, high;
    int below, above;
} mpm__draw_span;

/* A bar from x1 to x2 below y, with pointed ends where values lie outside the range. */
static inline void mpm__draw_bar(mpm_draw_canvas *c, double x1, double x2, double y, mpm_draw_map map,
                                 const mpm__draw_span *s, const char *label)
{
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    double u = c->unit, size = MPM__DRAW_NUMBER * u, thick = floor(10 * u + 0.5), x, tip = 0.8 * thick;
    double left = floor(x1) + (s->below ? tip : 0), right = floor(x2) - (s->above ? tip : 0);
    int i, n = mpm_draw_ticks(s->low, s->high, 0, mpm__draw_steps((right - left) / (54 * u)), ticks);
    if (!(right > left)) return;
    for (x = left; x < right; x++)
        mpm_draw_rectangle(c, x, y, 1, thick, mpm_draw_map_color(map, (x + 0.5 - left) / (right - left)));
    for (x = 0; x < tip; x++) {
        double half = 0.5 * thick * (1 - x / tip);
        if (s->below)
            mpm_draw_rectangle(c, left - x - 1, y + 0.5 * thick - half, 1, 2 * half, mpm_draw_map_color(map, 0));
        if (s->above)
            mpm_draw_rectangle(c, right + x, y + 0.5 * thick - half, 1, 2 * half, mpm_draw_map_color(map, 1));
    }
    for (i = 0; i < n; i++) {
        x = left + (right - left) * (ticks[i].at - s->low) / (s->high - s->low);
        x = x < left + 0.5 ? left + 0.5 : x > right - 0.5 ? right - 0.5 : x;
        mpm__draw_hair(c, x, y + thick, x, y + thick + 4 * u, MPM__DRAW_FRAME);
        mpm__draw_tick_text(c, x, y + thick + 8 * u + size, size, MPM_DRAW_CENTER, ticks[i].text);
    }
    if (label)
        mpm__draw_write_fit(c, 0.5 * (left + right), y + thick + (8 + 10 + MPM__DRAW_LABEL) * u + size,
                            MPM__DRAW_LABEL * u, MPM_DRAW_CENTER, 1.15, MPM__DRAW_INK, label, right - left);
}

/* The bar of a figure, below its frame. */
static inline void mpm__draw_bar_below(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm__draw_furniture *f,
                                       mpm_draw_map map, const mpm__draw_span *s)
{
    const double y = a->bottom + (mpm__draw_bottom_room(f) - MPM__DRAW_BAR + 16) * c->unit;
    if (f->bar) mpm__draw_bar(c, a->left, a->right, y, map, s, f->bar);
}

MPM_API void mpm_draw_color_bar(mpm_draw_canvas *c, mpm_draw_rect where, mpm_draw_map map, double low, double high,
                                const char *label)
{
    mpm__draw_span s = {0, 0, 0, 0};
    s.low = low;
    s.high = high;
    if (high > low && mpm__draw_has_room(c, where))
        mpm__draw_bar(c, where.x, where.x + where.width, where.y, map, &s, label);
}

MPM_API mpm_draw_rect mpm_draw_tile(const mpm_draw_canvas *c, int columns, int rows, int number)
{
    mpm_draw_rect r = {0, 0, 0, 0};
    int row;
    if (columns < 1 || rows < 1) return r;
    row = number / columns;
    r.width = (double)c->width / columns;
    r.height = (double)c->height / rows;
    r.x = r.width * (number % columns);
    r.y = r.height * row;
    return r;
}

/* ---- dots: what cuts and scatter plots draw ------------------------------------------------ */

typedef struct mpm__draw_dot {
    double x, y, value, size;
    int32_t body;
} mpm__draw_dot;

/* The colour range: as given, or that of the dots within the frame. A constant field gets a
   range around it. */
static inline mpm__draw_span mpm__draw_value_span(const mpm__draw_dot *dots, size_t n, const mpm__draw_axes *a,
                                                  double low, double high)
{
    mpm__draw_span s = {0, 0, 0, 0};
    double least = 1, most = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        const mpm__draw_dot *p = &dots[i];
        if (p->x < a->low[0] || p->x > a->high[0] || p->y < a->low[1] || p->y > a->high[1]) continue;
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
static inline void mpm__draw_fit(mpm__draw_axes *a, const double window[4], const mpm__draw_dot *dots, size_t n,
                                 double margin)
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

MPM_API mpm_draw_cut_desc mpm_draw_cut_desc_default(void)
{
    mpm_draw_cut_desc d;
    memset(&d, 0, sizeof d);
    d.mark = MPM_MARK;
    d.normal = 1;
    d.scale = 1;
    d.length_scale = 1;
    return d;
}

MPM_API mpm_draw_cut_desc mpm_draw_cut_of(const mpm_world *world, const mpm_real *value)
{
    mpm_draw_cut_desc d = mpm_draw_cut_desc_default();
    int k;
    d.world = world;
    d.count = (size_t)world->points.count;
    for (k = 0; k < 3; k++) d.x[k] = world->points.x[k];
    d.value = value;
    return d;
}

static inline mpm_status mpm__draw_cut_check(const mpm_draw_cut_desc *d, mpm_fault *fault)
{
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_draw_cut_desc_default)", (mpm_real)d->mark, -1);
    if (d->count < 1) return mpm_fail(fault, MPM_ERR_ARGUMENT, "count", 0, -1);
    if (!(d->spacing > 0) && !(d->world && d->spacing >= 0))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "spacing", (mpm_real)d->spacing, -1);
    if (d->normal < 0 || d->normal > 2) return mpm_fail(fault, MPM_ERR_ARGUMENT, "normal", (mpm_real)d->normal, -1);
    if (!d->x[0] && !d->x[1] && !d->x[2]) return mpm_fail(fault, MPM_ERR_ARGUMENT, "x", 0, -1);
    return MPM_OK;
}

/* The body of point i, given that of point i - 1; -1 when it is retired. */
static inline int32_t mpm__draw_body_at(const mpm_world *w, int32_t i, int32_t *body)
{
    const mpm_body *b;
    while (*body + 1 < w->bodies && i >= w->body[*body].first + w->body[*body].count) ++*body;
    b = &w->body[*body];
    return i < b->first + b->active ? *body : -1;
}

/* Point i as a dot in the plane of the cut; 0 when it is not to be seen. */
static inline int mpm__draw_cut_dot(const mpm_draw_cut_desc *d, size_t i, int32_t body, mpm__draw_dot *dot)
{
    const mpm_real *across = d->x[d->normal];
    const mpm_real *x = d->x[d->normal == 0 ? 1 : 0], *y = d->x[d->normal == 2 ? 1 : 2];
    double size = d->spacing > 0 || !d->world || body < 0 ? d->spacing : (double)d->world->body[body].desc.spacing;
    double half = d->half_thickness > 0 ? d->half_thickness : size;
    dot->x = x ? (double)x[i] : 0;
    dot->y = y ? (double)y[i] : 0;
    dot->value = d->value ? d->scale * (double)d->value[i] : 0;
    dot->size = d->size ? (double)d->size[i] : size;
    dot->body = d->body ? d->body[i] : body;
    if (d->world && body < 0) return 0;
    return dot->x - dot->x == 0 && dot->y - dot->y == 0 && fabs((across ? (double)across[i] : 0) - d->at) <= half;
}

/* The dots of the slab, each twice with `mirror`. With dots == NULL only counts. */
static inline size_t mpm__draw_cut_dots(const mpm_draw_cut_desc *d, mpm__draw_dot *dots)
{
    mpm__draw_dot dot;
    int32_t body = 0;
    size_t i, n = 0;
    int side;
    for (i = 0; i < d->count; i++) {
        int32_t of = d->world ? mpm__draw_body_at(d->world, (int32_t)i, &body) : 0;
        if (!mpm__draw_cut_dot(d, i, of, &dot)) continue;
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
typedef struct mpm__draw_paint {
    int width, height;    /* in half pixels */
    float *weight;        /* layer: sum of the kernels, a measure of how much body there is */
    float *closest;         /* layer: squared distance of the nearest dot, in its size */
    float *norm, *sum;    /* layer: weights of the values, and weighted values */
    float *best, *value;  /* visible: weight and value */
    int32_t *body;        /* visible: body, counted from 1, or 0 for none */
    int box[4];           /* part of the layer in use */
} mpm__draw_paint;

#define MPM__DRAW_FINE 2       /* half pixels per pixel */
#define MPM__DRAW_REACH 2.0    /* radius of a dot's kernel, in its size */
#define MPM__DRAW_FULL 4.19    /* sum of the kernels inside a lattice of dots: pi REACH^2 / 3 */
#define MPM__DRAW_SURFACE 0.42 /* share of it at the surface; one half would be exact on a plane */
#define MPM__DRAW_CORE 0.36    /* radius around each dot that is always shown, in its size */

/* Adds a dot to the layer: weight w = (1 - r^2 / R^2)^2 within R, and w^2 for its value.
   (x, y) and size in half pixels. */
static inline void mpm__draw_splat(mpm__draw_paint *p, double x, double y, double size, double value, int nearest)
{
    double radius = MPM__DRAW_REACH * size < 1.5 ? 1.5 : MPM__DRAW_REACH * size;
    int left = mpm__draw_whole(x - radius, 0, p->width);
    int right = mpm__draw_whole(x + radius, 0, p->width);
    int top = mpm__draw_whole(y - radius, 0, p->height), i, j;
    int bottom = mpm__draw_whole(y + radius, 0, p->height);
    for (j = top; j < bottom; j++)
        for (i = left; i < right; i++) {
            size_t at = (size_t)j * (size_t)p->width + (size_t)i;
            double dx = i + 0.5 - x, dy = j + 0.5 - y, q = dx * dx + dy * dy;
            double w = 1 - q / (radius * radius);
            int nearer;
            if (w <= 0) continue;
            w *= w;
            q *= MPM__DRAW_REACH * MPM__DRAW_REACH / (radius * radius);
            nearer = q < (double)p->closest[at];
            if (nearer) p->closest[at] = (float)q;
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
static inline double mpm__draw_surface(const mpm__draw_paint *p)
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
    return MPM__DRAW_SURFACE * (mean > MPM__DRAW_FULL ? mean : MPM__DRAW_FULL);
}

/* Shows the layer where it outweighs what is visible, and clears it for the next body. The
   core of each dot is always shown, so that single points do not vanish. */
static inline void mpm__draw_show_layer(mpm__draw_paint *p, int32_t body)
{
    float surface = (float)mpm__draw_surface(p);
    int i, j;
    for (j = p->box[1]; j < p->box[3]; j++)
        for (i = p->box[0]; i < p->box[2]; i++) {
            size_t at = (size_t)j * (size_t)p->width + (size_t)i;
            float w = p->weight[at];
            if ((w > surface || p->closest[at] < (float)(MPM__DRAW_CORE * MPM__DRAW_CORE)) && w > p->best[at]) {
                p->best[at] = w;
                p->value[at] = p->sum[at] / p->norm[at];
                p->body[at] = body;
            }
            p->weight[at] = p->norm[at] = p->sum[at] = 0;
            p->closest[at] = 1e30f;
        }
    p->box[0] = p->width;
    p->box[1] = p->height;
    p->box[2] = p->box[3] = 0;
}

/* Paints body after body, in the order of their numbers. Bodies are shown as 1, 2, ... */
static inline void mpm__draw_paint_dots(mpm__draw_paint *p, const mpm__draw_axes *a, const mpm__draw_dot *dots,
                                        size_t n, int nearest)
{
    double scale = MPM__DRAW_FINE * (a->right - a->left) / (a->high[0] - a->low[0]);
    int32_t body = dots[0].body, next, shown = 1;
    size_t i;
    int more = 1;
    for (i = 1; i < n; i++)
        if (dots[i].body < body) body = dots[i].body;
    for (; more; body = next, shown++) {
        more = 0;
        next = body;
        for (i = 0; i < n; i++) {
            const mpm__draw_dot *d = &dots[i];
            if (d->body == body)
                mpm__draw_splat(p, scale * (d->x - a->low[0]), scale * (a->high[1] - d->y), scale * d->size, d->value,
                                nearest);
            else if (d->body > body && (!more || d->body < next)) {
                next = d->body;
                more = 1;
            }
        }
        mpm__draw_show_layer(p, shown);
    }
}

/* What begins within `reach` half pixels: 0 nothing new, 1 the surface, 2 another body. */
static inline int mpm__draw_edge_kind(const mpm__draw_paint *p, int i, int j, int reach)
{
    static const int around[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
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

static inline int mpm__draw_is_dark(mpm_draw_color color)
{
    return 3 * (color >> 16 & 255) + 6 * (color >> 8 & 255) + (color & 255) < 10 * 70;
}

/* The colour of one half pixel. Values come in 96 steps: not to be seen, but flat areas pack well.
   A line marks the edge of each body, light where two dark bodies meet. */
static inline mpm_draw_color mpm__draw_fine_color(const mpm__draw_paint *p, int i, int j, int edge,
                                                  const mpm__draw_span *s, const mpm_draw_cut_desc *d)
{
    size_t at = (size_t)j * (size_t)p->width + (size_t)i;
    double t = ((double)p->value[at] - s->low) / (s->high - s->low);
    mpm_draw_color color = 0xffffff;
    int kind;
    if (p->body[at] > 0 && d->value) color = mpm_draw_map_color(d->map, t == t ? floor(t * 96 + 0.5) / 96 : t);
    else if (p->body[at] > 0) color = mpm__draw_blend(mpm_draw_series_color(p->body[at] - 1), 0xffffff, 0.35);
    kind = mpm__draw_edge_kind(p, i, j, edge);
    if (kind == 0) return color;
    return mpm__draw_blend(color, kind == 2 && mpm__draw_is_dark(color) ? 0xffffff : MPM__DRAW_INK, 0.85);
}

/* Averages the half pixels into the canvas at the frame. */
static inline void mpm__draw_paint_out(mpm_draw_canvas *c, const mpm__draw_paint *p, const mpm__draw_axes *a,
                                       const mpm__draw_span *s, const mpm_draw_cut_desc *d)
{
    int edge = mpm__draw_whole(0.5 * c->unit, 1, 8), x, y, i, j;
    for (y = 0; y < p->height / MPM__DRAW_FINE; y++)
        for (x = 0; x < p->width / MPM__DRAW_FINE; x++) {
            int red = 0, green = 0, blue = 0, n = MPM__DRAW_FINE * MPM__DRAW_FINE;
            for (j = MPM__DRAW_FINE * y; j < MPM__DRAW_FINE * (y + 1); j++)
                for (i = MPM__DRAW_FINE * x; i < MPM__DRAW_FINE * (x + 1); i++) {
                    mpm_draw_color color = mpm__draw_fine_color(p, i, j, edge, s, d);
                    red += (int)(color >> 16 & 255);
                    green += (int)(color >> 8 & 255);
                    blue += (int)(color & 255);
                }
            mpm_draw_rectangle(
                c, floor(a->left) + x, floor(a->top) + y, 1, 1,
                (mpm_draw_color)((red + n / 2) / n << 16 | (green + n / 2) / n << 8 | (blue + n / 2) / n));
        }
}

/* The bodies within the frame. Returns MPM_ERR_MEMORY when the layers cannot be had. */
static inline mpm_status mpm__draw_cut_bodies(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm__draw_dot *dots,
                                              size_t n, const mpm__draw_span *s, const mpm_draw_cut_desc *d)
{
    mpm__draw_paint p;
    size_t i, pixels;
    float *memory;
    memset(&p, 0, sizeof p);
    p.width = MPM__DRAW_FINE * mpm__draw_whole(a->right - a->left, 1, 16384);
    p.height = MPM__DRAW_FINE * mpm__draw_whole(a->bottom - a->top, 1, 16384);
    pixels = (size_t)p.width * (size_t)p.height;
    if (pixels == 0) return MPM_OK; /* nothing of it can be seen */
    memory = (float *)MPM_MALLOC(mpm_size_mul(pixels, 7 * sizeof(float)));
    if (!memory) return MPM_ERR_MEMORY;
    memset(memory, 0, pixels * 7 * sizeof(float));
    p.weight = memory;
    p.closest = memory + pixels;
    p.norm = memory + 2 * pixels;
    p.sum = memory + 3 * pixels;
    p.best = memory + 4 * pixels;
    p.value = memory + 5 * pixels;
    p.body = (int32_t *)(void *)(memory + 6 * pixels);
    for (i = 0; i < pixels; i++) p.closest[i] = 1e30f;
    p.box[0] = p.width;
    p.box[1] = p.height;
    mpm__draw_paint_dots(&p, a, dots, n, d->style == MPM_DRAW_NEAREST);
    mpm__draw_paint_out(c, &p, a, s, d);
    MPM_FREE(memory);
    return MPM_OK;
}

/* Whether a part of the picture is still white. */
static inline int mpm__draw_blank(const mpm_draw_canvas *c, double x, double y, double width, double height)
{
    int i, j, right = mpm__draw_whole(x + width, 0, c->width);
    int bottom = mpm__draw_whole(y + height, 0, c->height);
    for (j = mpm__draw_whole(y, 0, c->height); j < bottom; j++)
        for (i = mpm__draw_whole(x, 0, c->width); i < right; i++)
            if (mpm_draw_pixel(c, i, j) != 0xffffff) return 0;
    return 1;
}

/* A nice length, in the first blank corner of the frame (lower ones first), or else on a white
   plate at the lower left. */
static inline void mpm__draw_scale_bar(mpm_draw_canvas *c, const mpm__draw_axes *a, double length_scale,
                                       const char *unit)
{
    char text[80];
    double u = c->unit, size = MPM__DRAW_NUMBER * u, wide = a->right - a->left;
    double whole = (a->high[0] - a->low[0]) * length_scale, nice = mpm_draw_nice(0.28 * whole);
    double bar = wide * nice / whole, width, height = size + 19 * u, x = 0, y = 0;
    size_t used;
    int corner;
    used = mpm_draw_number(text, sizeof text, nice, 3);
    used = mpm_append(text, sizeof text, used, " ");
    mpm_append(text, sizeof text, used, unit);
    width = mpm_draw_text_width(size, text);
    width = (width < bar ? bar : width) + 16 * u;
    for (corner = 0; corner < 5; corner++) {
        x = corner % 4 % 2 ? a->right - 9 * u - width : a->left + 9 * u;
        y = corner % 4 / 2 ? a->top + 9 * u : a->bottom - 9 * u - height;
        if (mpm__draw_blank(c, x, y, width, height)) break;
    }
    mpm_draw_rectangle(c, x, y, width, height, 0xffffff);
    mpm_draw_rectangle(c, x + 0.5 * (width - bar), y + height - 9 * u, bar, 3 * u, MPM__DRAW_INK);
    mpm_draw_text(c, x + 0.5 * width, y + 6 * u + size, size, MPM_DRAW_CENTER, MPM__DRAW_INK, text);
}

/* What surrounds a cut. */
static inline mpm__draw_furniture mpm__draw_cut_furniture(const mpm_draw_cut_desc *d)
{
    mpm__draw_furniture f = {NULL, NULL, NULL, NULL, NULL, 0, 1, 1};
    f.title = d->title;
    f.note = d->time;
    f.numbers = d->ticks;
    f.bar = d->value ? d->label : NULL;
    f.length_scale = d->length_scale;
    return f;
}

/* The dots of a cut in fresh memory; NULL with the reason in *status. */
static inline mpm__draw_dot *mpm__draw_cut_gather(const mpm_draw_cut_desc *d, size_t *n, mpm_status *status,
                                                  mpm_fault *fault)
{
    mpm__draw_dot *dots;
    *status = mpm__draw_cut_check(d, fault);
    if (*status < 0) return NULL;
    *n = mpm__draw_cut_dots(d, NULL);
    if (*n == 0) {
        *status = mpm_fail(fault, MPM_ERR_ARGUMENT, "points in the slab", 0, -1);
        return NULL;
    }
    dots = (mpm__draw_dot *)MPM_MALLOC(*n * sizeof *dots);
    if (!dots) *status = mpm_fail(fault, MPM_ERR_MEMORY, "dots of the cut", (mpm_real)*n, -1);
    else mpm__draw_cut_dots(d, dots);
    return dots;
}

/* The lines of a cut, and their mirror images, within its frame. */
static inline void mpm__draw_cut_lines(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm_draw_cut_desc *d)
{
    int before[4], side;
    size_t i;
    mpm__draw_clip(c, a, before);
    for (i = 0; i < d->line_count; i++)
        for (side = 0; side <= (d->mirror ? 1 : 0); side++) {
            const double *l = d->lines[i], sign = side ? -1 : 1;
            mpm_draw_line(c, mpm__draw_at_x(a, sign * l[0]), mpm__draw_at_y(a, l[1]), mpm__draw_at_x(a, sign * l[2]),
                          mpm__draw_at_y(a, l[3]), 1.6 * c->unit, MPM__DRAW_INK);
        }
    memcpy(c->clip, before, sizeof c->clip);
}

MPM_API mpm_status mpm_draw_cut(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_cut_desc *d, mpm_fault *fault)
{
    mpm__draw_furniture f = mpm__draw_cut_furniture(d);
    mpm__draw_axes a, printed;
    mpm__draw_span s;
    mpm_status status;
    size_t n;
    mpm__draw_dot *dots = mpm__draw_cut_gather(d, &n, &status, fault);
    if (!dots) return status;
    mpm__draw_fit(&a, d->window, dots, n, 0.02);
    if (!mpm__draw_place(c, where, &f, &a)) {
        MPM_FREE(dots);
        return mpm__draw_no_place(where, fault);
    }
    s = mpm__draw_value_span(dots, n, &a, d->low, d->high);
    status = mpm__draw_cut_bodies(c, &a, dots, n, &s, d);
    MPM_FREE(dots);
    if (status < 0) return mpm_fail(fault, status, "layers of the cut", 0, -1);
    mpm__draw_cut_lines(c, &a, d);
    mpm__draw_frame(c, &a);
    mpm__draw_heading(c, &a, &f);
    printed = mpm__draw_printed(&a, &f);
    if (f.numbers) mpm__draw_numbers(c, &printed, &f);
    else if (d->length_unit) mpm__draw_scale_bar(c, &a, d->length_scale, d->length_unit);
    mpm__draw_bar_below(c, &a, &f, d->map, &s);
    return MPM_OK;
}

/* The height of a panel of a given width: its window's sides, and the rest. The points are looked at only where
   the window is theirs. */
static inline mpm_status mpm__draw_cut_height(const mpm_draw_cut_desc *d, int width, double *height, mpm_fault *fault)
{
    mpm__draw_furniture f = mpm__draw_cut_furniture(d);
    mpm__draw_axes a;
    const int given = d->window[1] > d->window[0] && d->window[3] > d->window[2];
    mpm__draw_dot *dots = NULL;
    mpm_status status;
    size_t n = 0;
    if (given) status = mpm__draw_cut_check(d, fault);
    else dots = mpm__draw_cut_gather(d, &n, &status, fault);
    if (status < 0) return status;
    mpm__draw_fit(&a, d->window, dots, n, 0.02);
    if (dots) MPM_FREE(dots);
    *height = (width - 2 * MPM__DRAW_PAD) * (a.high[1] - a.low[1]) / (a.high[0] - a.low[0]) + 2 * MPM__DRAW_PAD +
              mpm__draw_top_room(&f) + mpm__draw_bottom_room(&f);
    return MPM_OK;
}

MPM_API mpm_status mpm_draw_cuts(mpm_draw_canvas *c, const mpm_draw_cut_desc *cuts, int count, int columns,
                                 int panel_width, mpm_fault *fault)
{
    mpm_status status = MPM_OK;
    double height = 0, most = 0;
    int i, rows;
    if (count < 1 || columns < 1 || columns > 16384 || panel_width < 1 || panel_width > 16384 / columns)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "panels", (mpm_real)count, -1);
    for (i = 0; i < count; i++) {
        status = mpm__draw_cut_height(&cuts[i], panel_width, &height, fault);
        if (status < 0) return status;
        if (height > most) most = height;
    }
    rows = (count - 1) / columns + 1;
    if (rows > 16384) return mpm_fail(fault, MPM_ERR_ARGUMENT, "panels", (mpm_real)count, -1);
    status = mpm_draw_canvas_init(c, panel_width * columns, mpm__draw_whole(most, 1, 16384) * rows, NULL, 0);
    if (status < 0) return mpm_fail(fault, status, "size of picture", (mpm_real)most, -1);
    for (i = 0; i < count && status >= 0; i++)
        status = mpm_draw_cut(c, mpm_draw_tile(c, columns, rows, i), &cuts[i], fault);
    if (status < 0) mpm_draw_canvas_free(c);
    return status;
}

/* ---- solids -------------------------------------------------------------------------------- */

MPM_API mpm_draw_solid_desc mpm_draw_solid_desc_default(void)
{
    mpm_draw_solid_desc d;
    memset(&d, 0, sizeof d);
    d.mark = MPM_MARK;
    d.turn = 30;
    d.lift = 25;
    d.scale = 1;
    return d;
}

MPM_API mpm_draw_solid_desc mpm_draw_solid_of(const mpm_world *world, const mpm_real *value)
{
    mpm_draw_solid_desc d = mpm_draw_solid_desc_default();
    int k;
    d.world = world;
    d.count = (size_t)world->points.count;
    for (k = 0; k < 3; k++) {
        d.x[k] = world->points.x[k];
        d.mirror[k] = world->desc.side[2 * k] == MPM_SIDE_SYMMETRY;
    }
    d.value = value;
    return d;
}

static inline mpm_status mpm__draw_solid_check(const mpm_draw_solid_desc *d, mpm_fault *fault)
{
    size_t i;
    int k;
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_draw_solid_desc_default)", (mpm_real)d->mark, -1);
    if (d->count < 1 || !d->x[0] || !d->x[1] || !d->x[2])
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "places of the solid", (mpm_real)d->count, -1);
    if (d->triangles > 0 && !d->triangle) return mpm_fail(fault, MPM_ERR_ARGUMENT, "triangle", 0, -1);
    if (!(d->size >= 0 && d->size < 1e300) || (d->triangles == 0 && !(d->size > 0) && !d->world))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "size of the balls", (mpm_real)d->size, -1);
    if (!(fabs(d->turn) < 1e6)) return mpm_fail(fault, MPM_ERR_ARGUMENT, "turn", (mpm_real)d->turn, -1);
    if (!(fabs(d->lift) < 1e6)) return mpm_fail(fault, MPM_ERR_ARGUMENT, "lift", (mpm_real)d->lift, -1);
    for (i = 0; i < d->triangles; i++)
        for (k = 0; k < 3; k++)
            if (d->triangle[i][k] < 0 || (size_t)d->triangle[i][k] >= d->count)
                return mpm_fail(fault, MPM_ERR_ARGUMENT, "corner of a triangle", (mpm_real)d->triangle[i][k],
                                (int64_t)i);
    return MPM_OK;
}

/* To the right, upwards and to the eye, as unit vectors. */
static inline void mpm__draw_view(const mpm_draw_solid_desc *d, double to[3][3])
{
    const double turn = d->turn * (double)MPM_PI / 180, lift = d->lift * (double)MPM_PI / 180;
    to[0][0] = cos(turn);
    to[0][1] = sin(turn);
    to[0][2] = 0;
    to[1][0] = -sin(lift) * sin(turn);
    to[1][1] = sin(lift) * cos(turn);
    to[1][2] = cos(lift);
    to[2][0] = cos(lift) * sin(turn);
    to[2][1] = -cos(lift) * cos(turn);
    to[2][2] = sin(lift);
}

/* A place as it is seen: where in the picture and how near [length], and the normal there, of any length. */
typedef struct mpm__draw_seen {
    double at[3], normal[3];
} mpm__draw_seen;

static inline void mpm__draw_turned(double to[3][3], const double x[3], double at[3])
{
    int k;
    for (k = 0; k < 3; k++) at[k] = to[k][0] * x[0] + to[k][1] * x[1] + to[k][2] * x[2];
}

/* Normals at the corners: of the triangles around, by their areas; in a mirror's plane, along it. */
static inline void mpm__draw_normals(const mpm_draw_solid_desc *d, double (*normal)[3])
{
    size_t i;
    int k;
    memset(normal, 0, d->count * sizeof *normal);
    for (i = 0; i < d->triangles; i++) {
        const int32_t *t = d->triangle[i];
        double a[3], b[3], n[3];
        for (k = 0; k < 3; k++) {
            a[k] = (double)d->x[k][t[1]] - (double)d->x[k][t[0]];
            b[k] = (double)d->x[k][t[2]] - (double)d->x[k][t[0]];
        }
        n[0] = a[1] * b[2] - a[2] * b[1];
        n[1] = a[2] * b[0] - a[0] * b[2];
        n[2] = a[0] * b[1] - a[1] * b[0];
        for (k = 0; k < 9; k++) normal[t[k / 3]][k % 3] += n[k % 3];
    }
    for (i = 0; i < d->count; i++)
        for (k = 0; k < 3; k++)
            if (d->mirror[k] && !(fabs((double)d->x[k][i]) > 0)) normal[i][k] = 0;
}

/* Place i, seen as its image in the mirrors of `image`. */
static inline void mpm__draw_see(const mpm_draw_solid_desc *d, size_t i, int image, double to[3][3],
                                 const double (*normal)[3], mpm__draw_seen *seen)
{
    double x[3], n[3];
    int k;
    for (k = 0; k < 3; k++) {
        const double sign = image >> k & 1 ? -1 : 1;
        x[k] = sign * (double)d->x[k][i];
        n[k] = normal ? sign * normal[i][k] : 0;
    }
    mpm__draw_turned(to, x, seen->at);
    mpm__draw_turned(to, n, seen->normal);
}

static inline int mpm__draw_has_image(const mpm_draw_solid_desc *d, int image)
{
    const int mirrors = (d->mirror[0] ? 1 : 0) | (d->mirror[1] ? 2 : 0) | (d->mirror[2] ? 4 : 0);
    return (image & ~mirrors) == 0;
}

/* What has been painted, at twice the resolution: nearness, value, brightness and the body's colour (from 1; 0:
   nothing). */
typedef struct mpm__draw_scene {
    int width, height;
    float *depth, *value, *shade;
    int32_t *body;
} mpm__draw_scene;

/* The nearest so far at a half pixel. The normal is of unit length, towards the eye. */
static inline void mpm__draw_put(mpm__draw_scene *s, int i, int j, double depth, const double normal[3], double value,
                                 int32_t body)
{
    const size_t at = (size_t)j * (size_t)s->width + (size_t)i;
    const double light = -0.40 * normal[0] + 0.55 * normal[1] + 0.73 * normal[2];
    if (s->body[at] && depth <= (double)s->depth[at]) return;
    s->depth[at] = (float)depth;
    s->value[at] = (float)value;
    s->shade[at] = (float)(0.35 + 0.65 * (light > 0 ? light : 0));
    s->body[at] = body;
}

/* A ball around (x, y), in half pixels, of that radius; `length`: of a half pixel. */
static inline void mpm__draw_ball(mpm__draw_scene *s, double x, double y, double depth, double radius, double length,
                                  double value, int32_t body)
{
    int left = mpm__draw_whole(floor(x - radius), 0, s->width), right = mpm__draw_whole(ceil(x + radius), 0, s->width);
    int top = mpm__draw_whole(floor(y - radius), 0, s->height), i, j;
    int bottom = mpm__draw_whole(ceil(y + radius), 0, s->height);
    for (j = top; j < bottom; j++)
        for (i = left; i < right; i++) {
            double n[3], q;
            n[0] = (i + 0.5 - x) / radius;
            n[1] = (y - j - 0.5) / radius;
            q = 1 - n[0] * n[0] - n[1] * n[1];
            if (!(q >= 0)) continue;
            n[2] = sqrt(q);
            mpm__draw_put(s, i, j, depth + n[2] * radius * length, n, value, body);
        }
}

/* The unit normal of a triangle, towards the eye, and the sign that took. 0 if it has none. */
static inline double mpm__draw_facing(const mpm__draw_seen t[3], double n[3])
{
    double a[3], b[3], size, sign;
    int k;
    for (k = 0; k < 3; k++) {
        a[k] = t[1].at[k] - t[0].at[k];
        b[k] = t[2].at[k] - t[0].at[k];
    }
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
    size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(size > 0)) return 0;
    sign = n[2] < 0 ? -1 : 1;
    for (k = 0; k < 3; k++) n[k] *= sign / size;
    return sign;
}

/* Normals at the corners become unit ones on the triangle's side; where a corner is of an edge, the triangle's own. */
static inline void mpm__draw_soften(mpm__draw_seen t[3], const double n[3], double sign)
{
    int c, k;
    for (c = 0; c < 3; c++) {
        double *m = t[c].normal, size = sign * sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]), with = 0;
        for (k = 0; k < 3 && fabs(size) > 0; k++) with += m[k] / size * n[k];
        for (k = 0; k < 3; k++) m[k] = with > 0.7 ? m[k] / size : n[k];
    }
}

/* Shares of the corners at (x, y) of a triangle of that doubled area; 0 outside it. */
static inline int mpm__draw_shares(const mpm__draw_seen t[3], double area, double x, double y, double share[3])
{
    int k;
    for (k = 0; k < 3; k++) {
        const double *a = t[(k + 1) % 3].at, *b = t[(k + 2) % 3].at;
        share[k] = ((a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)) / area;
        if (!(share[k] >= 0)) return 0;
    }
    return 1;
}

/* A triangle whose corners are in half pixels. */
static inline void mpm__draw_triangle(mpm__draw_scene *s, const mpm__draw_seen t[3], const double value[3],
                                      int32_t body)
{
    const double area = (t[1].at[0] - t[0].at[0]) * (t[2].at[1] - t[0].at[1]) -
                        (t[1].at[1] - t[0].at[1]) * (t[2].at[0] - t[0].at[0]);
    double low[2], high[2], share[3], n[3];
    int i, j, k, c;
    if (!(fabs(area) > 0)) return;
    for (k = 0; k < 2; k++) {
        low[k] = fmin(fmin(t[0].at[k], t[1].at[k]), t[2].at[k]);
        high[k] = fmax(fmax(t[0].at[k], t[1].at[k]), t[2].at[k]);
    }
    for (j = mpm__draw_whole(floor(low[1]), 0, s->height); j < mpm__draw_whole(ceil(high[1]), 0, s->height); j++)
        for (i = mpm__draw_whole(floor(low[0]), 0, s->width); i < mpm__draw_whole(ceil(high[0]), 0, s->width); i++) {
            double depth = 0, mean = 0, size = 0;
            if (!mpm__draw_shares(t, area, i + 0.5, j + 0.5, share)) continue;
            for (k = 0; k < 3; k++) {
                for (n[k] = 0, c = 0; c < 3; c++) n[k] += share[c] * t[c].normal[k];
                depth += share[k] * t[k].at[2];
                mean += share[k] * value[k];
                size += n[k] * n[k];
            }
            for (k = 0; k < 3; k++) n[k] /= sqrt(size);
            mpm__draw_put(s, i, j, depth, n, mean, body);
        }
}

/* Where the window must reach: corner i of the box, or place i as an image. 0 if it is not drawn, as retired points are
   not; `walk` as for mpm__draw_body_at. */
static inline int mpm__draw_solid_reach(const mpm_draw_solid_desc *d, int given, size_t i, int image, double to[3][3],
                                        int32_t *walk, double at[3])
{
    mpm__draw_seen seen;
    double corner[3];
    int k;
    if (given) {
        for (k = 0; k < 3; k++) corner[k] = d->box[2 * k + (int)(i >> k & 1)];
        mpm__draw_turned(to, corner, at);
        return 1;
    }
    if (!d->triangles && d->world && mpm__draw_body_at(d->world, (int32_t)i, walk) < 0) return 0;
    mpm__draw_see(d, i, image, to, NULL, &seen);
    memcpy(at, seen.at, sizeof seen.at);
    return at[0] - at[0] == 0 && at[1] - at[1] == 0;
}

/* The window: of the box, or of all places that are drawn and their images. */
static inline void mpm__draw_solid_fit(const mpm_draw_solid_desc *d, double to[3][3], mpm__draw_axes *a)
{
    const int given = d->box[1] > d->box[0] && d->box[3] > d->box[2] && d->box[5] > d->box[4];
    const size_t places = given ? 8 : d->count;
    const double half = given || d->triangles ? 0 : d->size / 2;
    double at[3];
    size_t i;
    int32_t walk;
    int image, k, first = 1;
    memset(a, 0, sizeof *a);
    for (image = 0; image < (given ? 1 : 8); image++)
        for (walk = 0, i = 0; i < places && mpm__draw_has_image(d, image); i++) {
            if (!mpm__draw_solid_reach(d, given, i, image, to, &walk, at)) continue;
            for (k = 0; k < 2; k++) {
                if (first || at[k] - half < a->low[k]) a->low[k] = at[k] - half;
                if (first || at[k] + half > a->high[k]) a->high[k] = at[k] + half;
                first = first && k == 0;
            }
        }
    for (k = 0; k < 2; k++) {
        const double pad = a->high[k] > a->low[k] ? 0.02 * (a->high[k] - a->low[k]) : 0.5;
        a->low[k] -= pad;
        a->high[k] += pad;
    }
}

/* All balls of one image. */
static inline void mpm__draw_balls(mpm__draw_scene *s, const mpm_draw_solid_desc *d, int image, double to[3][3],
                                   const mpm__draw_axes *a, double scale)
{
    mpm__draw_seen seen;
    int32_t walk = 0;
    size_t i;
    for (i = 0; i < d->count; i++) {
        const int32_t of = d->world ? mpm__draw_body_at(d->world, (int32_t)i, &walk) : 0;
        double size = d->size;
        if (of < 0) continue;
        if (!(size > 0)) size = 1.3 * (double)d->world->body[of].desc.spacing;
        mpm__draw_see(d, i, image, to, NULL, &seen);
        if (!(seen.at[0] - seen.at[0] == 0 && seen.at[1] - seen.at[1] == 0)) continue;
        mpm__draw_ball(s, scale * (seen.at[0] - a->low[0]), scale * (a->high[1] - seen.at[1]), seen.at[2],
                       scale * size / 2, 1 / scale, d->value ? d->scale * (double)d->value[i] : 0,
                       1 + ((d->body ? d->body[i] : of) & 7));
    }
}

/* All triangles of one image. */
static inline void mpm__draw_faces(mpm__draw_scene *s, const mpm_draw_solid_desc *d, int image, double to[3][3],
                                   const mpm__draw_axes *a, double scale, const double (*normal)[3])
{
    size_t i;
    int k;
    for (i = 0; i < d->triangles; i++) {
        mpm__draw_seen t[3];
        double value[3], n[3], sign;
        for (k = 0; k < 3; k++) {
            const int32_t p = d->triangle[i][k];
            mpm__draw_see(d, (size_t)p, image, to, normal, &t[k]);
            value[k] = d->value ? d->scale * (double)d->value[p] : 0;
        }
        if (!((sign = mpm__draw_facing(t, n)) != 0)) continue;
        if (image == 1 || image == 2 || image == 4 || image == 7) sign = -sign; /* seen in a mirror, they turn round */
        mpm__draw_soften(t, n, sign);
        for (k = 0; k < 3; k++) {
            t[k].at[0] = scale * (t[k].at[0] - a->low[0]);
            t[k].at[1] = scale * (a->high[1] - t[k].at[1]);
        }
        mpm__draw_triangle(s, t, value, 1 + ((d->body ? d->body[d->triangle[i][0]] : 0) & 7));
    }
}

/* The range of colours: as given, or that of what is seen. */
static inline mpm__draw_span mpm__draw_solid_span(const mpm__draw_scene *s, const mpm_draw_solid_desc *d)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    mpm__draw_dot dot[2];
    mpm__draw_axes all;
    size_t i;
    int found = 0;
    memset(dot, 0, sizeof dot);
    memset(&all, 0, sizeof all);
    for (i = 0; i < pixels; i++) {
        const double v = (double)s->value[i];
        if (!s->body[i] || !(v - v == 0)) continue;
        if (!found || v < dot[0].value) dot[0].value = v;
        if (!found || v > dot[1].value) dot[1].value = v;
        found = 1;
    }
    return mpm__draw_value_span(dot, 2, &all, d->low, d->high);
}

/* The colour of a half pixel: steps as in a cut, dimmed. */
static inline mpm_draw_color mpm__draw_lit(const mpm__draw_scene *s, size_t at, const mpm__draw_span *span,
                                           const mpm_draw_solid_desc *d)
{
    const double t = ((double)s->value[at] - span->low) / (span->high - span->low);
    mpm_draw_color color;
    if (!s->body[at]) return 0xffffff;
    if (d->value) color = mpm_draw_map_color(d->map, t == t ? floor(t * 96 + 0.5) / 96 : t);
    else color = mpm__draw_blend(mpm_draw_series_color(s->body[at] - 1), 0xffffff, 0.35);
    return mpm__draw_blend(0, color, (double)s->shade[at]);
}

/* Averages the half pixels into the canvas at the frame. */
static inline void mpm__draw_scene_out(mpm_draw_canvas *c, const mpm__draw_scene *s, const mpm__draw_axes *a,
                                       const mpm__draw_span *span, const mpm_draw_solid_desc *d)
{
    const int n = MPM__DRAW_FINE * MPM__DRAW_FINE;
    int x, y, k, b;
    for (y = 0; y < s->height / MPM__DRAW_FINE; y++)
        for (x = 0; x < s->width / MPM__DRAW_FINE; x++) {
            int sum[3] = {0, 0, 0};
            for (k = 0; k < n; k++) {
                const size_t row = (size_t)(MPM__DRAW_FINE * y + k / MPM__DRAW_FINE) * (size_t)s->width;
                const mpm_draw_color color =
                    mpm__draw_lit(s, row + (size_t)(MPM__DRAW_FINE * x + k % MPM__DRAW_FINE), span, d);
                for (b = 0; b < 3; b++) sum[b] += (int)(color >> (16 - 8 * b) & 255);
            }
            mpm_draw_rectangle(c, floor(a->left) + x, floor(a->top) + y, 1, 1,
                               (mpm_draw_color)((sum[0] + n / 2) / n << 16 | (sum[1] + n / 2) / n << 8 |
                                                (sum[2] + n / 2) / n));
        }
}

/* Everything within the frame; *span becomes the range of its colours. MPM_ERR_MEMORY. */
static inline mpm_status mpm__draw_solid_scene(mpm_draw_canvas *c, const mpm__draw_axes *a, double to[3][3],
                                               const mpm_draw_solid_desc *d, mpm__draw_span *span)
{
    const double scale = MPM__DRAW_FINE * (a->right - a->left) / (a->high[0] - a->low[0]);
    double (*normal)[3] = d->triangles ? (double(*)[3])MPM_MALLOC(mpm_size_mul(d->count, sizeof *normal)) : NULL;
    mpm__draw_scene s;
    float *memory;
    size_t pixels;
    int image;
    s.width = MPM__DRAW_FINE * mpm__draw_whole(a->right - a->left, 1, 16384);
    s.height = MPM__DRAW_FINE * mpm__draw_whole(a->bottom - a->top, 1, 16384);
    pixels = (size_t)s.width * (size_t)s.height;
    memory = (float *)MPM_MALLOC(mpm_size_mul(pixels, 4 * sizeof(float)));
    if (memory && (normal || d->triangles == 0)) {
        memset(memory, 0, pixels * 4 * sizeof(float));
        s.depth = memory;
        s.value = memory + pixels;
        s.shade = memory + 2 * pixels;
        s.body = (int32_t *)(void *)(memory + 3 * pixels);
        if (normal) mpm__draw_normals(d, normal);
        for (image = 0; image < 8; image++)
            if (!mpm__draw_has_image(d, image)) continue;
            else if (normal) mpm__draw_faces(&s, d, image, to, a, scale, (const double(*)[3])normal);
            else mpm__draw_balls(&s, d, image, to, a, scale);
        *span = mpm__draw_solid_span(&s, d);
        mpm__draw_scene_out(c, &s, a, span, d);
        pixels = 0;
    }
    if (normal) MPM_FREE(normal);
    if (memory) MPM_FREE(memory);
    return pixels ? MPM_ERR_MEMORY : MPM_OK;
}

MPM_API mpm_status mpm_draw_solid(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_solid_desc *d,
                                  mpm_fault *fault)
{
    mpm__draw_furniture f = {NULL, NULL, NULL, NULL, NULL, 0, 1, 1};
    mpm__draw_axes a;
    mpm__draw_span s = {0, 1, 0, 0};
    double to[3][3];
    mpm_status status = mpm__draw_solid_check(d, fault);
    if (status < 0) return status;
    f.title = d->title;
    f.note = d->time;
    f.bar = d->value ? d->label : NULL;
    mpm__draw_view(d, to);
    mpm__draw_solid_fit(d, to, &a);
    if (!mpm__draw_place(c, where, &f, &a)) return mpm__draw_no_place(where, fault);
    status = mpm__draw_solid_scene(c, &a, to, d, &s);
    if (status < 0) return mpm_fail(fault, status, "scene of the solid", 0, -1);
    mpm__draw_heading(c, &a, &f);
    if (d->length_unit) mpm__draw_scale_bar(c, &a, 1, d->length_unit);
    mpm__draw_bar_below(c, &a, &f, d->map, &s);
    return MPM_OK;
}

/* ---- scatter ------------------------------------------------------------------------------- */

MPM_API mpm_draw_scatter_desc mpm_draw_scatter_desc_default(void)
{
    mpm_draw_scatter_desc d;
    memset(&d, 0, sizeof d);
    d.mark = MPM_MARK;
    d.dot = 5;
    d.equal = 1;
    d.scale = 1;
    return d;
}

/* The finite points as dots. */
static inline size_t mpm__draw_scatter_dots(const mpm_draw_scatter_desc *d, mpm__draw_dot *dots)
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

MPM_API mpm_status mpm_draw_scatter(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_scatter_desc *d,
                                    mpm_fault *fault)
{
    mpm__draw_furniture f = {NULL, NULL, NULL, NULL, NULL, 1, 0, 1};
    mpm__draw_axes a;
    mpm__draw_span s;
    mpm__draw_dot *dots;
    double scale;
    size_t i, n;
    int before[4];
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_draw_scatter_desc_default)",
                        (mpm_real)d->mark, -1);
    if (d->count < 1 || !d->x || !d->y)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "points of the scatter plot", (mpm_real)d->count, -1);
    dots = (mpm__draw_dot *)MPM_MALLOC(d->count * sizeof *dots);
    if (!dots) return mpm_fail(fault, MPM_ERR_MEMORY, "dots of the scatter plot", (mpm_real)d->count, -1);
    n = mpm__draw_scatter_dots(d, dots);
    if (n == 0) {
        MPM_FREE(dots);
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "points of the scatter plot that are finite", 0, -1);
    }
    f.title = d->title;
    f.note = d->note;
    f.x_label = d->x_label;
    f.y_label = d->y_label;
    f.bar = d->value ? d->label : NULL;
    f.equal = d->equal;
    mpm__draw_fit(&a, d->window, dots, n, 0.05);
    if (!mpm__draw_place(c, where, &f, &a)) {
        MPM_FREE(dots);
        return mpm__draw_no_place(where, fault);
    }
    s = mpm__draw_value_span(dots, n, &a, d->low, d->high);
    scale = (a.right - a.left) / (a.high[0] - a.low[0]);
    mpm__draw_grid(c, &a);
    mpm__draw_clip(c, &a, before);
    for (i = 0; i < n; i++) {
        double radius = d->size ? 0.5 * dots[i].size * scale : 0.5 * d->dot * c->unit;
        mpm_draw_color color = d->value ? mpm_draw_map_color(d->map, (dots[i].value - s.low) / (s.high - s.low))
                                        : mpm_draw_series_color(0);
        mpm_draw_disc(c, mpm__draw_at_x(&a, dots[i].x), mpm__draw_at_y(&a, dots[i].y), radius, color);
    }
    MPM_FREE(dots);
    memcpy(c->clip, before, sizeof c->clip);
    mpm__draw_frame(c, &a);
    mpm__draw_heading(c, &a, &f);
    mpm__draw_numbers(c, &a, &f);
    mpm__draw_bar_below(c, &a, &f, d->map, &s);
    return MPM_OK;
}

/* ---- plot ---------------------------------------------------------------------------------- */

MPM_API mpm_draw_plot_desc mpm_draw_plot_desc_default(void)
{
    mpm_draw_plot_desc d;
    memset(&d, 0, sizeof d);
    d.mark = MPM_MARK;
    return d;
}

/* Sets one axis: the window given, or the extent of all curves and a little more. Returns 0 when
   there is nothing to show. */
static inline int mpm__draw_plot_range(const mpm_draw_plot_desc *d, int axis, mpm__draw_axes *a)
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
static inline int mpm__draw_curve_point(const mpm__draw_axes *a, const mpm_draw_curve *curve, size_t i, double at[2])
{
    double x = (double)curve->x[i], y = (double)curve->y[i];
    if (a->log[0]) x = x > 0 ? log10(x) : NAN;
    if (a->log[1]) y = y > 0 ? log10(y) : NAN;
    at[0] = mpm__draw_at_x(a, x);
    at[1] = mpm__draw_at_y(a, y);
    return at[0] - at[0] == 0 && at[1] - at[1] == 0;
}

/* A segment in dashes; `phase` [pixels along the curve] is carried on to the next one. */
static inline void mpm__draw_dashes(mpm_draw_canvas *c, const double a[2], const double b[2], double radius,
                                    double *phase)
{
    double on = 7 * c->unit, period = 12 * c->unit, at = 0;
    double length = sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]));
    while (at < length && length < 1e5) {
        double inside = fmod(*phase + at, period), step = (inside < on ? on : period) - inside, end;
        if (step < 1e-6 * period) step = 1e-6 * period;
        end = at + step < length ? at + step : length;
        if (inside < on)
            mpm__draw_segment(c, a[0] + (b[0] - a[0]) * at / length, a[1] + (b[1] - a[1]) * at / length,
                              a[0] + (b[0] - a[0]) * end / length, a[1] + (b[1] - a[1]) * end / length, radius);
        at += step;
    }
    *phase = fmod(*phase + length, period);
}

static inline void mpm__draw_one_curve(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm_draw_curve *curve)
{
    double last[2] = {0, 0}, at[2], phase = 0, radius = 0.95 * c->unit;
    int joined = 0;
    size_t i;
    for (i = 0; i < curve->count; i++) {
        int good = mpm__draw_curve_point(a, curve, i, at);
        if (good && curve->mark == MPM_DRAW_DOTS) mpm__draw_segment(c, at[0], at[1], at[0], at[1], 3 * c->unit);
        else if (good && joined && curve->mark == MPM_DRAW_DASHED) mpm__draw_dashes(c, last, at, radius, &phase);
        else if (good && joined) mpm__draw_segment(c, last[0], last[1], at[0], at[1], radius);
        joined = good;
        last[0] = at[0];
        last[1] = at[1];
    }
    mpm__draw_ink(c, mpm_draw_series_color(curve->color));
}

/* How many points of the curves fall into a box. */
static inline size_t mpm__draw_points_inside(const mpm_draw_plot_desc *d, const mpm__draw_axes *a, double x, double y,
                                             double width, double height)
{
    size_t i, n = 0;
    double at[2];
    int k;
    for (k = 0; k < d->curve_count; k++)
        for (i = 0; i < d->curves[k].count; i++)
            n += mpm__draw_curve_point(a, &d->curves[k], i, at) && at[0] > x && at[0] < x + width && at[1] > y &&
                 at[1] < y + height;
    return n;
}

/* The legend, where it hides the fewest points: in a corner, or in the middle of a side where that hides fewer. */
static inline void mpm__draw_legend(mpm_draw_canvas *c, const mpm__draw_axes *a, const mpm_draw_plot_desc *d)
{
    double u = c->unit, size = MPM__DRAW_NUMBER * u, row = size + 9 * u, widest = 0, width, height;
    double gap = 10 * u, x = 0, y = 0;
    size_t least = 0;
    static const double place[8][2] = {{1, 0}, {0, 0}, {1, 1}, {0, 1}, {1, 0.5}, {0, 0.5}, {0.5, 0}, {0.5, 1}};
    int k, names = 0;
    for (k = 0; k < d->curve_count; k++) {
        double w = d->curves[k].name ? mpm_draw_text_width(size, d->curves[k].name) : 0;
        if (w > widest) widest = w;
        names += d->curves[k].name != NULL;
    }
    if (names == 0) return;
    width = widest + 50 * u;
    height = names * row + 9 * u;
    for (k = 0; k < 8; k++) {
        double left = a->left + gap + place[k][0] * (a->right - a->left - 2 * gap - width);
        double top = a->top + gap + place[k][1] * (a->bottom - a->top - 2 * gap - height);
        size_t hidden = mpm__draw_points_inside(d, a, left, top, width, height);
        if (k > 0 && hidden >= least) continue;
        least = hidden;
        x = left;
        y = top;
    }
    mpm_draw_rectangle(c, x, y, width, height, MPM__DRAW_GRID);
    mpm_draw_rectangle(c, x + u, y + u, width - 2 * u, height - 2 * u, 0xffffff);
    y += 9 * u;
    for (k = 0; k < d->curve_count; k++) {
        double from[2], to[2], phase = 0;
        if (!d->curves[k].name) continue;
        from[0] = x + 10 * u;
        to[0] = x + 33 * u;
        from[1] = to[1] = y + 0.5 * size;
        if (d->curves[k].mark == MPM_DRAW_DOTS) mpm__draw_segment(c, x + 21 * u, to[1], x + 21 * u, to[1], 3 * u);
        else if (d->curves[k].mark == MPM_DRAW_DASHED) mpm__draw_dashes(c, from, to, 0.95 * u, &phase);
        else mpm__draw_segment(c, from[0], from[1], to[0], to[1], 0.95 * u);
        mpm__draw_ink(c, mpm_draw_series_color(d->curves[k].color));
        mpm_draw_text(c, x + 40 * u, y + size, size, MPM_DRAW_LEFT, MPM__DRAW_INK, d->curves[k].name);
        y += row;
    }
}

MPM_API mpm_status mpm_draw_plot(mpm_draw_canvas *c, mpm_draw_rect where, const mpm_draw_plot_desc *d, mpm_fault *fault)
{
    mpm__draw_furniture f = {NULL, NULL, NULL, NULL, NULL, 1, 0, 1};
    mpm__draw_axes a;
    int before[4], k;
    if (d->mark != MPM_MARK)
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "desc (not from mpm_draw_plot_desc_default)", (mpm_real)d->mark, -1);
    if (!mpm__draw_plot_range(d, 0, &a) || !mpm__draw_plot_range(d, 1, &a))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "points of the curves", 0, -1);
    f.title = d->title;
    f.note = d->note;
    f.x_label = d->x_label;
    f.y_label = d->y_label;
    if (!mpm__draw_place(c, where, &f, &a)) return mpm__draw_no_place(where, fault);
    mpm__draw_grid(c, &a);
    mpm__draw_clip(c, &a, before);
    for (k = 0; k < d->curve_count; k++) mpm__draw_one_curve(c, &a, &d->curves[k]);
    memcpy(c->clip, before, sizeof c->clip);
    mpm__draw_frame(c, &a);
    mpm__draw_heading(c, &a, &f);
    mpm__draw_numbers(c, &a, &f);
    mpm__draw_legend(c, &a, d);
    return MPM_OK;
}
#ifdef __cplusplus
}
#endif
#endif /* MPM_IMPLEMENTATION */

/* MIT License: see LICENSE. */
