/* 41_draw - pictures: pixels are where they belong, numbers on axes are those of printf, and a canvas written by
   mpm_io.h comes back. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_draw.h"
#include "mpm_io.h"

#include "check.h"
#include "png.h"

#ifdef MPM_FLOAT
#define FOLDER "build/test-draw-f32"
#else
#define FOLDER "build/test-draw"
#endif

static int png_matches(const char *path, const mpm_draw_canvas *c)
{
    int width = 0, height = 0, same;
    unsigned char *rgb = read_png(path, &width, &height);
    same = rgb && width == c->width && height == c->height &&
           memcmp(rgb, c->rgb, 3 * (size_t)width * (size_t)height) == 0;
    free(rgb);
    return same;
}

/* ---- canvas and primitives ----------------------------------------------------------------- */

static void test_canvas(void)
{
    static unsigned char own[4 * 20 * 10];
    mpm_draw_canvas c;
    mpm_fault f;
    CHECK_EQUAL("canvas too large", mpm_draw_canvas_init(&c, 16385, 1, NULL, 0), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("canvas without pixels", (long)mpm_draw_canvas_bytes(0, 5), 0);
    CHECK_EQUAL("memory too small", mpm_draw_canvas_init(&c, 20, 10, own, sizeof own - 1), MPM_ERR_MEMORY);
    CHECK_EQUAL("canvas in own memory", mpm_draw_canvas_init(&c, 20, 10, own, sizeof own), MPM_OK);
    mpm_draw_line(&c, 1, 1, 19, 9, 1.5, 0xff0000);
    CHECK_EQUAL("written", mpm_io_png(FOLDER "/line.png", c.rgb, c.width, c.height, "a note", &f), MPM_OK);
    CHECK_TRUE("... and back", png_matches(FOLDER "/line.png", &c));
    CHECK_EQUAL("a pixel outside", mpm_draw_pixel(&c, 20, 0), 0);
    mpm_draw_canvas_free(&c);
    CHECK_EQUAL("freed: no pixels", mpm_draw_pixel(&c, 0, 0), 0);
    mpm_draw_canvas_free(&c);
}

static int darkness(const mpm_draw_canvas *c, int left, int top, int right, int bottom)
{
    int x, y, n = 0;
    for (y = top; y < bottom; y++)
        for (x = left; x < right; x++) n += mpm_draw_pixel(c, x, y) != 0xffffff;
    return n;
}

static void test_drawing(void)
{
    mpm_draw_canvas c;
    /* degree, squared, cubed, middle dot, times, minus */
    static const char *const sign[6] = {"\xc2\xb0", "\xc2\xb2", "\xc2\xb3", "\xc2\xb7", "\xc3\x97", "\xe2\x88\x92"};
    int ink[6], twice = 0;
    char every[96];
    double sum = 0;
    int x, y, k;
    mpm_draw_canvas_init(&c, 200, 100, NULL, 0);
    mpm_draw_rectangle(&c, 10, 20, 30, 5, 0x123456);
    CHECK_EQUAL("pixels of a rectangle", darkness(&c, 0, 0, 200, 100), 150);
    CHECK_EQUAL("its colour", mpm_draw_pixel(&c, 39, 24), 0x123456);
    CHECK_EQUAL("beside it", mpm_draw_pixel(&c, 40, 24), 0xffffff);
    mpm_draw_fill(&c, 0xffffff);
    mpm_draw_disc(&c, 100, 50, 30, 0);
    for (y = 0; y < 100; y++)
        for (x = 0; x < 200; x++) sum += 1 - (mpm_draw_pixel(&c, x, y) & 255) / 255.0;
    CHECK_RELATIVE("area of a smooth disc", sum, 3.14159265 * 900, 0.005);
    mpm_draw_fill(&c, 0xffffff);
    mpm_draw_disc(&c, -1e30, NAN, 1e30, 0);
    mpm_draw_line(&c, -1e9, 50.5, 1e9, 50.5, 1, 0);
    CHECK_EQUAL("a line far beyond the edges", mpm_draw_pixel(&c, 100, 50), 0);
    mpm_draw_fill(&c, 0xffffff);
    for (k = 0; k < 95; k++) every[k] = (char)(32 + k);
    every[95] = 0;
    for (k = 1; k < 95; k++) {
        char one[2] = {0, 0};
        one[0] = every[k];
        mpm_draw_fill(&c, 0xffffff);
        mpm_draw_text(&c, 50, 60, 18, MPM_DRAW_LEFT, 0, one);
        if (darkness(&c, 0, 0, 200, 100) == 0) break;
        if (darkness(&c, 0, 0, 46, 100) > 0 || darkness(&c, 0, 0, 200, 35) > 0) break;
    }
    CHECK_EQUAL("every character leaves ink in its place", k, 95);
    for (k = 0; k < 6; k++) {
        mpm_draw_fill(&c, 0xffffff);
        mpm_draw_text(&c, 50, 60, 18, MPM_DRAW_LEFT, 0, sign[k]);
        ink[k] = darkness(&c, 46, 35, 200, 100);
        for (x = 0; x < k; x++) twice += ink[x] == ink[k];
        CHECK_TRUE("signs beyond ASCII leave ink", ink[k] > 0);
    }
    CHECK_EQUAL("... each its own", twice, 0);
    CHECK_NEAR("micro is one character", mpm_draw_text_width(9, "\xc2\xb5"),
               mpm_draw_text_width(9, "u"), 1e-9);
    CHECK_NEAR("broken text ends", mpm_draw_text_width(9, "\xe2"), mpm_draw_text_width(9, "\x80"),
               1e-9);
    mpm_draw_canvas_free(&c);
}

/* CIELAB lightness of a colour. */
static double lightness(mpm_draw_color color)
{
    static const double weight[3] = {0.0722, 0.7152, 0.2126};
    double y = 0;
    int k;
    for (k = 0; k < 3; k++) {
        double v = (double)(color >> 8 * k & 255) / 255;
        y += weight[k] * (v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static void test_colours(void)
{
    double even[2] = {0, 0}, turn = 0;
    int map, k;
    for (map = 0; map < 2; map++)
        for (k = 1; k <= 20; k++) {
            mpm_draw_map m = (mpm_draw_map)map;
            double whole = lightness(mpm_draw_map_color(m, 1)) - lightness(mpm_draw_map_color(m, 0));
            double step = lightness(mpm_draw_map_color(m, k / 20.0)) -
                          lightness(mpm_draw_map_color(m, (k - 1) / 20.0));
            double off = fabs(step / whole * 20 - 1);
            if (off > even[map]) even[map] = off;
        }
    CHECK_NEAR("DEEP: steps of lightness, off the mean", even[0], 0, 0.2);
    CHECK_NEAR("HEAT: steps of lightness, off the mean", even[1], 0, 0.2);
    for (k = 0; k <= 10; k++) {
        double off = fabs(lightness(mpm_draw_map_color(MPM_DRAW_DIVERGING, k / 20.0)) -
                          lightness(mpm_draw_map_color(MPM_DRAW_DIVERGING, 1 - k / 20.0)));
        if (off > turn) turn = off;
    }
    CHECK_NEAR("DIVERGING: both sides as light", turn, 0, 3);
    CHECK_EQUAL("clamped below", mpm_draw_map_color(MPM_DRAW_DEEP, -5), mpm_draw_map_color(MPM_DRAW_DEEP, 0));
    CHECK_EQUAL("clamped above", mpm_draw_map_color(MPM_DRAW_DEEP, 5), mpm_draw_map_color(MPM_DRAW_DEEP, 1));
    CHECK_TRUE("neighbouring series differ", mpm_draw_series_color(0) != mpm_draw_series_color(1));
    CHECK_EQUAL("the ninth series is the first", mpm_draw_series_color(8), mpm_draw_series_color(0));
    CHECK_EQUAL("not a number is grey", mpm_draw_map_color(MPM_DRAW_DEEP, NAN), 0x9aa0a6);
}

/* ---- figures ------------------------------------------------------------------------------- */

enum { SIDE = 40 };

/* Two bodies of SIDE x SIDE points for x > 0, one above the other, in two layers along y. */
static mpm_real cut_x[3][4 * SIDE * SIDE], cut_value[4 * SIDE * SIDE];
static int32_t cut_body[4 * SIDE * SIDE];

static mpm_draw_cut_desc make_cut(void)
{
    mpm_draw_cut_desc d = mpm_draw_cut_desc_default();
    int i, j, layer, n = 0;
    for (layer = 0; layer < 2; layer++)
        for (j = 0; j < 2 * SIDE; j++)
            for (i = 0; i < SIDE; i++, n++) {
                cut_x[0][n] = (mpm_real)i + MPM_R(0.5);
                cut_x[1][n] = (mpm_real)layer * 5;
                cut_x[2][n] = (mpm_real)j + MPM_R(0.5) - SIDE;
                cut_value[n] = layer ? 100 : j < SIDE ? MPM_R(0.25) : MPM_R(0.75);
                cut_body[n] = j < SIDE ? 7 : 3;
            }
    for (i = 0; i < 3; i++) d.x[i] = cut_x[i];
    d.count = 4 * SIDE * SIDE;
    d.value = cut_value;
    d.body = cut_body;
    d.spacing = 1;
    d.low = 0;
    d.high = 1;
    return d;
}

static void test_cut(void)
{
    static const double window[4] = {-50, 50, -50, 50}, line[1][4] = {{10, -20, 90, -20}};
    mpm_draw_cut_desc d = make_cut(), panels[2];
    mpm_draw_canvas c;
    mpm_fault f;
    mpm_draw_color low = mpm_draw_map_color(MPM_DRAW_DEEP, 0.25),
                 high = mpm_draw_map_color(MPM_DRAW_DEEP, 0.75);
    int left;
    memcpy(d.window, window, sizeof window);
    mpm_draw_canvas_init(&c, 432, 432, NULL, 0); /* the frame: 400 pixels wide, 4 to a unit */
    CHECK_EQUAL("cut", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f), MPM_OK);
    CHECK_EQUAL("upper body at its place", mpm_draw_pixel(&c, 216 + 80, 216 - 80), high);
    CHECK_EQUAL("lower body at its place", mpm_draw_pixel(&c, 216 + 80, 216 + 80), low);
    CHECK_EQUAL("nothing on the other side", mpm_draw_pixel(&c, 216 - 80, 216 + 80), 0xffffff);
    CHECK_EQUAL("nothing outside the bodies", mpm_draw_pixel(&c, 216 + 80, 216 - 175), 0xffffff);
    CHECK_TRUE("a line between the bodies", mpm_draw_pixel(&c, 216 + 80, 216) != low &&
                                                     mpm_draw_pixel(&c, 216 + 80, 216) != high);
    CHECK_EQUAL("the surface within a spacing", mpm_draw_pixel(&c, 216 + 80, 216 - 164), 0xffffff);
    d.mirror = 1;
    d.style = MPM_DRAW_NEAREST;
    mpm_draw_fill(&c, 0xffffff);
    CHECK_EQUAL("mirrored cut", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f), MPM_OK);
    CHECK_EQUAL("the other half", mpm_draw_pixel(&c, 216 - 80, 216 + 80), low);
    for (left = 0;
         left < 216 && mpm_draw_pixel(&c, 215 - left, 100) == mpm_draw_pixel(&c, 216 + left, 100);)
        left++;
    CHECK_EQUAL("pixels that mirror each other, up to the frame", left, 199);
    d.lines = line;
    d.line_count = 1;
    mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f);
    CHECK_TRUE("a line over the points", mpm_draw_pixel(&c, 216 + 80, 216 + 80) < 0x404040 &&
                                             mpm_draw_pixel(&c, 216 + 80, 216 + 60) == low);
    CHECK_TRUE("... and its mirror image", mpm_draw_pixel(&c, 216 - 80, 216 + 80) < 0x404040);
    CHECK_EQUAL("... not beyond the frame", mpm_draw_pixel(&c, 425, 216 + 80), 0xffffff);
    d.line_count = 0;
    d.at = 5;
    mpm_draw_fill(&c, 0xffffff);
    mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f);
    CHECK_EQUAL("the other layer, clamped", mpm_draw_pixel(&c, 216 + 80, 216 + 80),
                mpm_draw_map_color(MPM_DRAW_DEEP, 1));
    d.at = 2.5;
    CHECK_EQUAL("no points in the slab", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f),
                MPM_ERR_ARGUMENT);
    CHECK_TRUE("fault names it", strcmp(f.field, "points in the slab") == 0);
    d.at = 0;
    d.spacing = 0;
    CHECK_EQUAL("no spacing", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("fault names it", strcmp(f.field, "spacing") == 0);
    mpm_draw_canvas_free(&c);

    panels[0] = make_cut();
    panels[0].mirror = 1;
    panels[0].title = "two bodies";
    panels[0].time = "t = 1 ns";
    panels[0].label = "value";
    panels[0].length_unit = "\xc2\xb5m";
    panels[1] = panels[0];
    panels[1].map = MPM_DRAW_HEAT;
    panels[1].ticks = 1;
    panels[1].value = NULL;
    CHECK_EQUAL("two cuts beside each other", mpm_draw_cuts(&c, panels, 2, 2, 400, &f), MPM_OK);
    CHECK_EQUAL("... each of its width", c.width, 800);
    CHECK_TRUE("... and as high as the window asks for", c.height > 440 && c.height < 520);
    CHECK_TRUE("... with ink in both halves",
               darkness(&c, 0, 0, 400, c.height) > 20000 && darkness(&c, 400, 0, 800, c.height) > 20000);
    CHECK_EQUAL("... into a file", mpm_io_png(FOLDER "/cut.png", c.rgb, c.width, c.height, "two bodies", &f), MPM_OK);
    CHECK_TRUE("... and back", png_matches(FOLDER "/cut.png", &c));
    mpm_draw_canvas_free(&c);
    panels[0].window[0] = -2;
    panels[0].window[1] = panels[0].window[3] = 2;
    panels[0].at = 99;
    CHECK_EQUAL("a window given, and nothing in it", mpm_draw_cuts(&c, panels, 1, 1, 400, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is said", strcmp(f.field, "points in the slab") == 0);
    panels[0] = make_cut();
    CHECK_EQUAL("no panels", mpm_draw_cuts(&c, panels, 0, 2, 400, &f), MPM_ERR_ARGUMENT);
    panels[1].spacing = 0;
    CHECK_EQUAL("a panel without spacing", mpm_draw_cuts(&c, panels, 2, 2, 400, &f), MPM_ERR_ARGUMENT);
}

/* The longest row of ink in a line of pixels. */
static int longest(const mpm_draw_canvas *c, int y)
{
    int x, run = 0, most = 0;
    for (x = 0; x < c->width; x++) {
        run = mpm_draw_pixel(c, x, y) != 0xffffff ? run + 1 : 0;
        most = run > most ? run : most;
    }
    return most;
}

/* The colour bar below a cut is pointed where values lie beyond its numbers, and square where none do. */
static void test_ends(void)
{
    int pointed, y, last, most;
    mpm_draw_canvas c;
    mpm_fault f;
    for (pointed = 0; pointed < 2; pointed++) {
        mpm_draw_cut_desc d = make_cut();
        d.label = "value";
        if (pointed) {
            d.low = 0.4;
            d.high = 0.6;
        }
        mpm_draw_canvas_init(&c, 432, 432, NULL, 0);
        CHECK_EQUAL("a cut with a bar", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &d, &f), MPM_OK);
        for (y = 431; y > 0 && longest(&c, y) < 150;) y--;
        for (last = most = longest(&c, y); y > 0 && longest(&c, y) >= 150; y--)
            most = longest(&c, y) > most ? longest(&c, y) : most;
        CHECK_EQUAL("... whose ends are pointed or square", most > last + 5, pointed);
        mpm_draw_canvas_free(&c);
    }
}

/* A cut through a world knows its bodies, their spacings and who is retired. */
static void test_world(void)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_draw_cut_desc cut;
    mpm_draw_canvas c;
    mpm_world w;
    mpm_fault f;
    d.cell = MPM_R(0.1);
    d.cells[0] = d.cells[1] = d.cells[2] = 10;
    d.points = 2000;
    d.bodies = 2;
    CHECK_EQUAL("a world", mpm_init(&w, &d, NULL, 0), MPM_OK);
    b.density = 1;
    b.spacing = MPM_R(0.05);
    b.shape = mpm_box(MPM_R(0.2), MPM_R(0.3), MPM_R(0.6), MPM_R(0.8), MPM_R(0.7), MPM_R(0.8));
    CHECK_EQUAL("... its upper body", mpm_body_add(&w, &b), MPM_OK);
    b.spacing = MPM_R(0.1);
    b.shape = mpm_box(MPM_R(0.1), MPM_R(0.2), MPM_R(0.1), MPM_R(0.9), MPM_R(0.8), MPM_R(0.5));
    CHECK_EQUAL("... its lower body", mpm_body_add(&w, &b), MPM_OK);
    cut = mpm_draw_cut_of(&w, NULL);
    cut.at = 0.5;
    cut.half_thickness = 0.06;
    cut.window[1] = cut.window[3] = 1;
    mpm_draw_canvas_init(&c, 432, 432, NULL, 0); /* the frame: 400 pixels for the length 1 */
    CHECK_EQUAL("cut of a world", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &cut, &f), MPM_OK);
    CHECK_TRUE("each body in a colour of its own",
               mpm_draw_pixel(&c, 216, 136) != 0xffffff && mpm_draw_pixel(&c, 216, 296) != 0xffffff &&
                   mpm_draw_pixel(&c, 216, 136) != mpm_draw_pixel(&c, 216, 296));
    CHECK_EQUAL("nothing between them", mpm_draw_pixel(&c, 216, 196), 0xffffff);
    w.body[0].active = 0;
    mpm_draw_fill(&c, 0xffffff);
    CHECK_EQUAL("the upper body retired", mpm_draw_cut(&c, mpm_draw_tile(&c, 1, 1, 0), &cut, &f), MPM_OK);
    CHECK_EQUAL("... is not drawn", mpm_draw_pixel(&c, 216, 136), 0xffffff);
    mpm_draw_canvas_free(&c);
    mpm_free(&w);
}

/* ---- numbers and ticks --------------------------------------------------------------------- */

/* What printf says of a number with so many significant digits, in our spelling. */
static void by_printf(char text[64], double value, int digits)
{
    char *e;
    snprintf(text, 64, "%.*g", digits, value);
    e = strchr(text, 'e');
    if (e) snprintf(e + 1, (size_t)(text + 64 - e - 1), "%ld", strtol(e + 1, NULL, 10));
}

static void test_numbers(void)
{
    char text[64], wanted[64];
    uint32_t random = 12345;
    long i, bad = 0;
    for (i = 0; i < 200000; i++) {
        const int digits = 1 + (int)(i % 6), power = (int)(i / 6 % 41) - 20;
        double value;
        random = random * 1664525u + 1013904223u;
        value = (double)(random >> 8) - 8388608; /* with ties: halves, quarters, fives */
        value = i % 3 == 0 ? value / 64 : (i % 3 == 1 ? floor(value / 8192) * 5 : value) * pow(10, power);
        by_printf(wanted, value, digits);
        mpm_draw_number(text, sizeof text, value, digits);
        if (strcmp(text, wanted) != 0 && bad++ < 5) printf("# %.17g: %s, by printf %s\n", value, text, wanted);
    }
    CHECK_EQUAL("numbers that printf writes otherwise", bad, 0);
    CHECK_EQUAL("a number cut to fit", (long)mpm_draw_number(text, 4, -12345, 5), 3);
    CHECK_TRUE("... and terminated", strcmp(text, "-12") == 0);
    mpm_draw_number(text, sizeof text, -INFINITY, 3);
    CHECK_TRUE("infinity", strcmp(text, "-inf") == 0);
    mpm_draw_number(text, sizeof text, NAN, 3);
    CHECK_TRUE("not a number", strcmp(text, "nan") == 0);
    mpm_draw_number(text, sizeof text, 0, 3);
    CHECK_TRUE("zero", strcmp(text, "0") == 0);
}

/* A bar has the map's colours from end to end, and its numbers below. */
static void test_color_bar(void)
{
    mpm_draw_rect where = {20, 10, 160, 60};
    mpm_draw_canvas c;
    mpm_draw_canvas_init(&c, 200, 80, NULL, 0);
    mpm_draw_color_bar(&c, where, MPM_DRAW_HEAT, 0, 1, "K");
    CHECK_EQUAL("the bar's lower end", mpm_draw_pixel(&c, 20, 12), mpm_draw_map_color(MPM_DRAW_HEAT, 0.5 / 160));
    CHECK_EQUAL("its middle", mpm_draw_pixel(&c, 100, 12), mpm_draw_map_color(MPM_DRAW_HEAT, 80.5 / 160));
    CHECK_EQUAL("its upper end", mpm_draw_pixel(&c, 179, 12), mpm_draw_map_color(MPM_DRAW_HEAT, 159.5 / 160));
    CHECK_EQUAL("nothing beside it", darkness(&c, 181, 0, 200, 20), 0);
    CHECK_TRUE("numbers and a label below", darkness(&c, 0, 25, 200, 80) > 30);
    mpm_draw_fill(&c, 0xffffff);
    mpm_draw_color_bar(&c, where, MPM_DRAW_HEAT, 1, 1, "K");
    CHECK_EQUAL("no range, no bar", darkness(&c, 0, 0, 200, 80), 0);
    mpm_draw_canvas_free(&c);
}

static void test_ticks(void)
{
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    CHECK_NEAR("nice 0.28", mpm_draw_nice(0.28), 0.2, 1e-12);
    CHECK_NEAR("nice 5", mpm_draw_nice(5), 5, 1e-12);
    CHECK_NEAR("nice 999", mpm_draw_nice(999), 500, 1e-12);
    CHECK_EQUAL("ticks of -1 .. 1", mpm_draw_ticks(-1, 1, 0, 6, ticks), 5);
    CHECK_TRUE("the first", strcmp(ticks[0].text, "-1.0") == 0);
    CHECK_TRUE("zero without a sign", strcmp(ticks[2].text, "0.0") == 0);
    mpm_draw_ticks(-6, 3, 1, 6, ticks);
    CHECK_TRUE("powers of ten", strcmp(ticks[0].text, "10^-6") == 0);
    mpm_draw_ticks(0, 3e6, 0, 3, ticks);
    CHECK_TRUE("large numbers", strcmp(ticks[1].text, "1e6") == 0);
    mpm_draw_ticks(0.001, 0.0016, 0, 4, ticks);
    CHECK_TRUE("small ones with the decimals of their step", strcmp(ticks[1].text, "0.0012") == 0);
    CHECK_EQUAL("no axis, no ticks: not a number", mpm_draw_ticks(mpm_sqrt(-1), 1, 1, 4, ticks), 0);
    CHECK_EQUAL("... narrower than any step", mpm_draw_ticks(0, 5e-324, 0, 4, ticks), 0);
    CHECK_EQUAL("a colour map that is none: grey", (int)mpm_draw_map_color((mpm_draw_map)77, 0), 0x9aa0a6);
    CHECK_EQUAL("more digits than a number has", (int)mpm_draw_number(ticks[0].text, 32, 0.1, 2147483647), 3);
    CHECK_EQUAL("... from high to low", mpm_draw_ticks(1, 0, 0, 4, ticks), 0);
    CHECK_EQUAL("... powers beyond any number", mpm_draw_ticks(-1e300, 1e300, 1, 4, ticks), 0);
}

/* Far from zero, two ticks bear different numbers, each within a hundredth of a step of its place. */
static void test_far_ticks(void)
{
    static const double range[][2] = {{1e6, 1e6 + 100},     {101275, 101375},         {250000, 250400},
                                      {300e6, 300.5e6},     {123400, 123460},         {0.01, 0.0100005},
                                      {0.3, 0.300014},      {99990, 100010},          {99000, 99990},
                                      {0, 250400},          {298, 298.002},           {298, 298.0000001},
                                      {-1e6 - 3, -1e6},     {1e15, 1e15 + 40},        {1e-200, 1.0001e-200}};
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    size_t r;
    for (r = 0; r < sizeof range / sizeof range[0]; r++) {
        const int n = mpm_draw_ticks(range[r][0], range[r][1], 0, 6, ticks);
        const double step = n > 1 ? ticks[1].at - ticks[0].at : 0;
        char what[80];
        int i, k, same = 0, off = 0;
        for (i = 0; i < n; i++) {
            for (k = 0; k < i; k++) same += strcmp(ticks[i].text, ticks[k].text) == 0;
            off += !(fabs(strtod(ticks[i].text, NULL) - ticks[i].at) <= 0.01 * step);
        }
        sprintf(what, "ticks of %.10g .. %.10g that repeat another or are off", range[r][0], range[r][1]);
        CHECK_EQUAL(what, same + off + (n < 3 || n > 10), 0);
    }
    mpm_draw_ticks(1e15, 1e15 + 1, 0, 6, ticks);
    CHECK_TRUE("closer than numbers have digits: one of them only", ticks[0].text[0] && !ticks[1].text[0]);
}

/* ---- scatter and plot ---------------------------------------------------------------------- */

static void test_plots(void)
{
    static mpm_real x[200], y[200], z[200];
    mpm_draw_curve curves[2];
    mpm_draw_plot_desc p = mpm_draw_plot_desc_default();
    mpm_draw_scatter_desc s = mpm_draw_scatter_desc_default();
    mpm_draw_canvas c;
    mpm_fault f;
    int i;
    for (i = 0; i < 200; i++) {
        x[i] = (mpm_real)i / 100;
        y[i] = (mpm_real)sin(i / 20.0);
        z[i] = (mpm_real)cos(i / 20.0);
    }
    z[100] = (mpm_real)NAN;
    memset(curves, 0, sizeof curves);
    curves[0].name = "sine";
    curves[0].count = 200;
    curves[0].x = x;
    curves[0].y = y;
    curves[1] = curves[0];
    curves[1].name = "cosine";
    curves[1].y = z;
    curves[1].mark = MPM_DRAW_DASHED;
    curves[1].color = 1;
    p.curves = curves;
    p.curve_count = 2;
    p.x_label = "time [\xc2\xb5s]";
    p.y_label = "velocity [m/s]";
    mpm_draw_canvas_init(&c, 800, 400, NULL, 0);
    CHECK_EQUAL("plot", mpm_draw_plot(&c, mpm_draw_tile(&c, 2, 1, 0), &p, &f), MPM_OK);
    CHECK_TRUE("ink in its tile", darkness(&c, 0, 0, 400, 400) > 2000);
    CHECK_EQUAL("none beyond it", darkness(&c, 400, 0, 800, 400), 0);
    s.count = 200;
    s.x = y;
    s.y = z;
    s.value = x;
    s.label = "time [\xc2\xb5s]";
    s.note = "not equal";
    CHECK_EQUAL("scatter", mpm_draw_scatter(&c, mpm_draw_tile(&c, 2, 1, 1), &s, &f), MPM_OK);
    CHECK_TRUE("ink in the other tile", darkness(&c, 400, 0, 800, 400) > 2000);
    CHECK_EQUAL("written", mpm_io_png(FOLDER "/plots.png", c.rgb, c.width, c.height, NULL, &f), MPM_OK);
    p.log_x = p.log_y = 1;
    CHECK_EQUAL("logarithmic, where positive", mpm_draw_plot(&c, mpm_draw_tile(&c, 2, 1, 0), &p, &f), MPM_OK);
    p.window[0] = p.window[2] = 1e-6;
    p.window[1] = p.window[3] = 1e3;
    mpm_draw_fill(&c, 0xffffff);
    CHECK_EQUAL("... over nine powers of ten", mpm_draw_plot(&c, mpm_draw_tile(&c, 2, 1, 0), &p, &f), MPM_OK);
    CHECK_TRUE("... written at its axes", darkness(&c, 0, 0, 60, 380) > 100);
    memset(p.window, 0, sizeof p.window);
    p.mark = 0;
    CHECK_EQUAL("a plot of one's own description", mpm_draw_plot(&c, mpm_draw_tile(&c, 2, 1, 0), &p, &f),
                MPM_ERR_ARGUMENT);
    p.mark = MPM_MARK;
    c.unit = 1e300;
    CHECK_EQUAL("a scatter plot without place", mpm_draw_scatter(&c, mpm_draw_tile(&c, 2, 1, 1), &s, &f),
                MPM_ERR_ARGUMENT);
    c.unit = 1;
    s.mark = 0;
    CHECK_EQUAL("... of one's own description", mpm_draw_scatter(&c, mpm_draw_tile(&c, 2, 1, 1), &s, &f),
                MPM_ERR_ARGUMENT);
    s.mark = MPM_MARK;
    curves[0].count = curves[1].count = 0;
    CHECK_EQUAL("nothing to plot", mpm_draw_plot(&c, mpm_draw_tile(&c, 2, 1, 0), &p, &f), MPM_ERR_ARGUMENT);
    for (i = 0; i < 3; i++) {
        x[i] = i == 1 ? (mpm_real)INFINITY : (mpm_real)NAN;
        y[i] = i == 1 ? 0 : (mpm_real)NAN;
    }
    s.x = x;
    s.y = y;
    s.count = 3;
    CHECK_EQUAL("nothing finite to scatter", mpm_draw_scatter(&c, mpm_draw_tile(&c, 2, 1, 1), &s, &f),
                MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is said", strcmp(f.field, "points of the scatter plot that are finite") == 0);
    s.count = 0;
    CHECK_EQUAL("nothing to scatter", mpm_draw_scatter(&c, mpm_draw_tile(&c, 2, 1, 1), &s, &f),
                MPM_ERR_ARGUMENT);
    mpm_draw_canvas_free(&c);
}

/* Numbers along a cut are wider in other units of length, and have their room. */
static void test_ticks_room(void)
{
    mpm_draw_cut_desc d = make_cut();
    mpm_draw_canvas c;
    mpm_fault f;
    d.window[0] = d.window[2] = -50;
    d.window[1] = d.window[3] = 50;
    d.ticks = 1;
    d.length_scale = 1e3;
    mpm_draw_canvas_init(&c, 800, 400, NULL, 0);
    CHECK_EQUAL("a cut with long numbers", mpm_draw_cut(&c, mpm_draw_tile(&c, 4, 1, 1), &d, &f), MPM_OK);
    CHECK_TRUE("... in its tile", darkness(&c, 200, 0, 400, 400) > 1000);
    CHECK_EQUAL("... and not in that beside it", darkness(&c, 0, 0, 205, 400), 0);
    mpm_draw_canvas_free(&c);
}

/* Figures draw where the caller lets them, and leave that as it was. */
/* A window so small that its pixels were infinitely many (the bar below it then never ended) has no place. */
static void test_tiny_window(void)
{
    const mpm_real x[2] = {0, 1};
    mpm_draw_scatter_desc s = mpm_draw_scatter_desc_default();
    mpm_draw_canvas c;
    mpm_fault f;
    int k;
    s.count = 2;
    s.x = s.y = s.value = x;
    s.equal = 1;
    s.label = "value";
    CHECK_EQUAL("canvas", mpm_draw_canvas_init(&c, 160, 120, NULL, 0), MPM_OK);
    for (k = 0; k < 2; k++) {
        s.window[1] = s.window[3] = k ? 1e-299 : 1e-309;
        mpm_draw_fill(&c, 0xffffff);
        CHECK_EQUAL("a window of 1e-309, of 1e-299", mpm_draw_scatter(&c, mpm_draw_tile(&c, 1, 1, 0), &s, &f),
                    k ? MPM_OK : MPM_ERR_ARGUMENT);
        CHECK_EQUAL("... is drawn or not", darkness(&c, 0, 0, 160, 120) > 0, k);
    }
    mpm_draw_canvas_free(&c);
}

static void test_clip(void)
{
    static const int box[4] = {90, 40, 150, 120};
    static const mpm_real x[3] = {0, 1, 2}, y[3] = {0, 2, 1};
    mpm_draw_scatter_desc s = mpm_draw_scatter_desc_default();
    mpm_draw_plot_desc p = mpm_draw_plot_desc_default();
    mpm_draw_cut_desc cut = make_cut();
    mpm_draw_curve curve;
    mpm_draw_canvas c;
    mpm_fault f;
    int k;
    memset(&curve, 0, sizeof curve);
    curve.count = s.count = 3;
    curve.x = s.x = x;
    curve.y = s.y = y;
    p.curves = &curve;
    p.curve_count = 1;
    s.dot = 200;
    for (k = 0; k < 3; k++) {
        mpm_draw_rect all;
        mpm_draw_canvas_init(&c, 200, 160, NULL, 0);
        all = mpm_draw_tile(&c, 1, 1, 0);
        memcpy(c.clip, box, sizeof box);
        if (k == 0) CHECK_EQUAL("a plot within a clip", mpm_draw_plot(&c, all, &p, &f), MPM_OK);
        if (k == 1) CHECK_EQUAL("a scatter plot within a clip", mpm_draw_scatter(&c, all, &s, &f), MPM_OK);
        if (k == 2) CHECK_EQUAL("a cut within a clip", mpm_draw_cut(&c, all, &cut, &f), MPM_OK);
        CHECK_TRUE("... draws there", darkness(&c, 90, 40, 150, 120) > 0);
        CHECK_EQUAL("... and nowhere else", darkness(&c, 0, 0, 200, 160) - darkness(&c, 90, 40, 150, 120), 0);
        CHECK_TRUE("... and leaves it as it was", memcmp(c.clip, box, sizeof box) == 0);
        mpm_draw_canvas_free(&c);
    }
    mpm_draw_canvas_init(&c, 200, 160, NULL, 0);
    c.clip[2] = c.clip[3] = 3; /* left of and above any frame */
    CHECK_EQUAL("a clip beside the frame", mpm_draw_scatter(&c, mpm_draw_tile(&c, 1, 1, 0), &s, &f), MPM_OK);
    CHECK_EQUAL("... lets nothing through", darkness(&c, 0, 0, 200, 160), 0);
    mpm_draw_canvas_free(&c);
}

/* Sizes that no picture has: a status, or nothing drawn. */
/* Cuts and scatters of zeros, and whole ones that are not made from the defaults. */
static void test_unmarked(void)
{
    const mpm_real x[2] = {0, 1};
    mpm_draw_cut_desc cut;
    mpm_draw_scatter_desc dots;
    mpm_draw_canvas c;
    mpm_draw_rect all;
    mpm_fault f;
    int k;
    mpm_draw_canvas_init(&c, 300, 200, NULL, 0);
    all = mpm_draw_tile(&c, 1, 1, 0);
    memset(&cut, 0, sizeof cut);
    memset(&dots, 0, sizeof dots);
    for (k = 0; k < 2; k++) {
        CHECK_EQUAL("a cut of one's own description", mpm_draw_cut(&c, all, &cut, &f), MPM_ERR_ARGUMENT);
        CHECK_TRUE("... is named", !strcmp(f.field, "desc (not from mpm_draw_cut_desc_default)"));
        CHECK_EQUAL("... nor beside others", mpm_draw_cuts(&c, &cut, 1, 1, 1, &f), MPM_ERR_ARGUMENT);
        CHECK_EQUAL("a scatter of one's own description", mpm_draw_scatter(&c, all, &dots, &f), MPM_ERR_ARGUMENT);
        CHECK_TRUE("... is named", !strcmp(f.field, "desc (not from mpm_draw_scatter_desc_default)"));
        cut = make_cut();
        dots = mpm_draw_scatter_desc_default();
        dots.count = 2;
        dots.x = dots.y = x;
        cut.mark = dots.mark = 0;
    }
    CHECK_EQUAL("nothing is drawn", darkness(&c, 0, 0, 300, 200), 0);
    cut.mark = dots.mark = MPM_MARK;
    CHECK_EQUAL("with the mark it is", mpm_draw_cut(&c, all, &cut, &f), MPM_OK);
    CHECK_EQUAL("... and so are the dots", mpm_draw_scatter(&c, all, &dots, &f), MPM_OK);
    mpm_draw_canvas_free(&c);
}

static void test_odd_sizes(void)
{
    static const double units[4] = {0, 1e-300, 1e300, (double)NAN};
    mpm_draw_cut_desc d = make_cut(), two[2];
    mpm_draw_tick ticks[MPM_DRAW_TICKS];
    mpm_draw_canvas c;
    mpm_draw_rect r, whole;
    mpm_fault f;
    int k;
    mpm_draw_canvas_init(&c, 300, 200, NULL, 0);
    whole = mpm_draw_tile(&c, 1, 1, 0);
    r = mpm_draw_tile(&c, 0, 1, 0);
    CHECK_TRUE("a tile of no columns is empty", !(r.width > 0) && !(r.height > 0));
    CHECK_EQUAL("... and holds no figure", mpm_draw_cut(&c, r, &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... which is said", strncmp(f.field, "place", 5) == 0);
    r = mpm_draw_tile(&c, 1, -1, 3);
    CHECK_TRUE("nor has one of no rows a size", !(r.width > 0));
    for (k = 0; k < 4; k++) {
        c.unit = units[k];
        CHECK_EQUAL("a unit that no picture has", mpm_draw_cut(&c, whole, &d, &f), MPM_ERR_ARGUMENT);
        mpm_draw_color_bar(&c, whole, MPM_DRAW_HEAT, 0, 1, "l");
        c.unit = 1;
        r = whole;
        if (k % 2) r.x = 1e17;
        else r.width = units[k] > 0 ? 1e12 : (double)INFINITY;
        CHECK_EQUAL("a place that no picture has", mpm_draw_cut(&c, r, &d, &f), MPM_ERR_ARGUMENT);
        mpm_draw_color_bar(&c, r, MPM_DRAW_HEAT, 0, 1, "l");
    }
    CHECK_EQUAL("nothing is drawn", darkness(&c, 0, 0, 300, 200), 0);
    d.window[0] = -1e308;
    d.window[1] = 1e308;
    d.window[3] = 1;
    CHECK_EQUAL("a window wider than numbers", mpm_draw_cut(&c, whole, &d, &f), MPM_ERR_ARGUMENT);
    d.window[0] = 0;
    d.window[1] = 1e-300;
    d.window[3] = 1e299;
    CHECK_TRUE("a window of extreme sides comes to an end", mpm_draw_cut(&c, whole, &d, &f) <= 0);
    mpm_draw_canvas_free(&c);
    two[0] = two[1] = make_cut();
    CHECK_EQUAL("columns without end", mpm_draw_cuts(&c, two, 2, 156128629, 1521821875, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("columns by the billion", mpm_draw_cuts(&c, two, 2, 2147483647, 1, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("powers that no number has", mpm_draw_ticks(-1e300, 1e300, 1, 6, ticks), 0);
    CHECK_EQUAL("ticks of nothing", mpm_draw_ticks((double)NAN, 1, 0, 6, ticks), 0);
    CHECK_EQUAL("a map that there is not", (long)mpm_draw_map_color((mpm_draw_map)77, 0.5), 0x9aa0a6);
}

/* ---- solids ----------------------------------------------------------------------------------- */

#define RINGS 40
#define ROUND 80

/* A sphere of radius 1 around the origin, as triangles. Returns how many. */
static int round_triangles(mpm_real (*x)[RINGS * ROUND], int32_t (*t)[3])
{
    const double pi = (double)MPM_PI;
    int i, j, n = 0;
    for (i = 0; i < RINGS; i++)
        for (j = 0; j < ROUND; j++) {
            const double down = pi * i / (RINGS - 1), turn = 2 * pi * j / ROUND;
            x[0][ROUND * i + j] = (mpm_real)(sin(down) * cos(turn));
            x[1][ROUND * i + j] = (mpm_real)(sin(down) * sin(turn));
            x[2][ROUND * i + j] = (mpm_real)cos(down);
            if (i == 0) continue;
            t[n][0] = ROUND * (i - 1) + j;
            t[n][1] = ROUND * i + j;
            t[n++][2] = ROUND * i + (j + 1) % ROUND;
            t[n][0] = ROUND * (i - 1) + j;
            t[n][1] = ROUND * i + (j + 1) % ROUND;
            t[n++][2] = ROUND * (i - 1) + (j + 1) % ROUND;
        }
    return n;
}

/* A solid of one place, a ball of radius 1, seen from the side. */
static mpm_draw_solid_desc make_ball(void)
{
    static const mpm_real zero[1] = {0};
    static const double box[6] = {-1.5, 1.5, -1.5, 1.5, -1.5, 1.5};
    mpm_draw_solid_desc d = mpm_draw_solid_desc_default();
    d.count = 1;
    d.x[0] = d.x[1] = d.x[2] = zero;
    d.size = 2;
    d.turn = d.lift = 0;
    memcpy(d.box, box, sizeof box);
    return d;
}

static double brightness(const mpm_draw_canvas *c, int x, int y)
{
    const mpm_draw_color color = mpm_draw_pixel(c, x, y);
    return (double)((color >> 16 & 255) + (color >> 8 & 255) + (color & 255));
}

/* The largest departure of a drawn ball from Lambert's law, of the brightest; its middle and radius are found on the
   picture. */
static double lambert(const mpm_draw_canvas *c)
{
    int x, y, left = 10000, right = 0, top = 10000, bottom = 0;
    double most = 0, worst = 0, r;
    for (y = 0; y < c->height; y++)
        for (x = 0; x < c->width; x++) {
            if (mpm_draw_pixel(c, x, y) == 0xffffff) continue;
            if (x < left) left = x;
            if (x > right) right = x;
            if (y < top) top = y;
            if (y > bottom) bottom = y;
        }
    r = (right - left + 1) / 2.0;
    most = brightness(c, (int)(left + r - 0.40 * r), (int)(top + r - 0.55 * r));
    for (y = top; y <= bottom; y++)
        for (x = left; x <= right; x++) {
            const double u = (x + 0.5 - left - r) / r, v = (top + r - y - 0.5) / r, q = 1 - u * u - v * v;
            const double light = q > 0.05 ? -0.40 * u + 0.55 * v + 0.73 * sqrt(q) : 0;
            if (q <= 0.05) continue;
            worst = check_worst(worst, fabs(brightness(c, x, y) / most - 0.35 - 0.65 * (light > 0 ? light : 0)));
        }
    return worst;
}

/* A ball, a square and a sphere of triangles: areas of their silhouettes, and Lambert's law. */
static void test_solid(void)
{
    static mpm_real x[3][RINGS * ROUND], square[3][4] = {{-1, 1, 1, -1}, {0, 0, 0, 0}, {-1, -1, 1, 1}};
    static int32_t t[2 * RINGS * ROUND][3], halves[2][3] = {{0, 1, 2}, {0, 2, 3}};
    mpm_draw_solid_desc ball = make_ball(), plate = make_ball(), sphere = make_ball();
    mpm_draw_canvas c;
    mpm_draw_rect all;
    double area[3], bend;
    mpm_fault f;
    int k;
    plate.count = 4;
    plate.triangles = 2;
    plate.triangle = (const int32_t(*)[3])halves;
    sphere.count = RINGS * ROUND;
    sphere.triangles = (size_t)round_triangles(x, t);
    sphere.triangle = (const int32_t(*)[3])t;
    for (k = 0; k < 3; k++) {
        plate.x[k] = square[k];
        sphere.x[k] = x[k];
    }
    for (k = 0; k < 3; k++) {
        mpm_draw_canvas_init(&c, 800, 800, NULL, 0);
        all = mpm_draw_tile(&c, 1, 1, 0);
        CHECK_EQUAL("a solid", mpm_draw_solid(&c, all, k == 0 ? &ball : k == 1 ? &plate : &sphere, &f), MPM_OK);
        area[k] = darkness(&c, 0, 0, 800, 800);
        bend = lambert(&c);
        if (k != 1) CHECK_NEAR("Lambert's law", bend, 0, 0.03);
        mpm_draw_canvas_free(&c);
    }
    CHECK_RELATIVE("the silhouette of a ball, of its square", area[0] / area[1], 0.25 * (double)MPM_PI, 0.005);
    CHECK_RELATIVE("... of one of triangles", area[2] / area[1], 0.25 * (double)MPM_PI, 0.005);
}

/* What is nearer hides what is behind, whatever comes first; mirrors; points of a world. */
static void test_solid_order(void)
{
    mpm_real x[2] = {0, 0}, y[2] = {-1, 1};
    int32_t body[2] = {0, 1};
    mpm_draw_solid_desc d = make_ball();
    mpm_draw_color seen[2];
    mpm_draw_canvas c;
    mpm_draw_rect all;
    mpm_fault f;
    int k;
    mpm_draw_canvas_init(&c, 400, 400, NULL, 0);
    all = mpm_draw_tile(&c, 1, 1, 0);
    d.count = 2;
    d.x[0] = d.x[2] = x;
    d.x[1] = y;
    d.body = body;
    for (k = 0; k < 3; k++) {
        d.turn = k == 2 ? 180 : 0;
        if (k == 1) y[0] = 1, y[1] = -1, body[0] = 1, body[1] = 0;
        mpm_draw_solid(&c, all, &d, &f);
        if (k < 2) seen[k] = mpm_draw_pixel(&c, 200, 200);
    }
    CHECK_EQUAL("the nearer one is seen, whichever comes first", seen[0], seen[1]);
    CHECK_TRUE("... from behind it is the other", mpm_draw_pixel(&c, 200, 200) != seen[0]);
    mpm_draw_fill(&c, 0xffffff);
    x[0] = 1;
    d = make_ball();
    d.x[0] = x;
    d.size = 0.5;
    d.mirror[0] = 1;
    mpm_draw_solid(&c, all, &d, &f);
    CHECK_TRUE("a mirror shows it on the other side", darkness(&c, 200, 0, 400, 400) > 100);
    CHECK_EQUAL("... as large", darkness(&c, 0, 0, 200, 400), darkness(&c, 200, 0, 400, 400));
    mpm_draw_canvas_free(&c);
}

static void solid_refused(const mpm_draw_solid_desc *d, const char *field)
{
    mpm_draw_canvas c;
    mpm_fault f;
    mpm_draw_canvas_init(&c, 40, 40, NULL, 0);
    CHECK_EQUAL(field, mpm_draw_solid(&c, mpm_draw_tile(&c, 1, 1, 0), d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", strstr(f.field, field) != NULL);
    CHECK_EQUAL("... and nothing drawn", darkness(&c, 0, 0, 40, 40), 0);
    mpm_draw_canvas_free(&c);
}

static void test_solid_refused(void)
{
    static const int32_t wild[1][3] = {{0, 0, 1}};
    mpm_draw_solid_desc d = make_ball();
    d.mark = 0;
    solid_refused(&d, "mpm_draw_solid_desc_default");
    d = make_ball();
    d.count = 0;
    solid_refused(&d, "places");
    d = make_ball();
    d.size = 0;
    solid_refused(&d, "size");
    d = make_ball();
    d.turn = (double)NAN;
    solid_refused(&d, "turn");
    d = make_ball();
    d.lift = (double)INFINITY;
    solid_refused(&d, "lift");
    d = make_ball();
    d.triangles = 1;
    solid_refused(&d, "triangle");
    d.triangle = wild;
    solid_refused(&d, "corner");
    d = make_ball();
    d.box[0] = -1e308;
    d.box[1] = 1e308;
    solid_refused(&d, "window");
}

/* A quarter of a world, whose mirrors make it whole. */
static void test_solid_world(void)
{
    mpm_desc g = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_draw_solid_desc d;
    mpm_draw_canvas c, both[2];
    mpm_draw_rect all;
    mpm_world w;
    mpm_fault f;
    int k;
    g.cell = 1;
    g.cells[0] = g.cells[1] = g.cells[2] = 6;
    g.side[0] = g.side[2] = MPM_SIDE_SYMMETRY;
    b.shape = mpm_sphere(0, 0, 3, 2);
    b.spacing = MPM_R(0.5);
    b.density = 1;
    CHECK_EQUAL("a world", mpm_init(&w, &g, NULL, 0), MPM_OK);
    CHECK_EQUAL("... of a quarter of a sphere", mpm_body_add(&w, &b), MPM_OK);
    mpm_draw_canvas_init(&c, 400, 300, NULL, 0);
    all = mpm_draw_tile(&c, 1, 1, 0);
    d = mpm_draw_solid_of(&w, w.points.temperature);
    d.turn = d.lift = 0;
    d.label = "temperature (K)";
    CHECK_EQUAL("its points as balls", mpm_draw_solid(&c, all, &d, &f), MPM_OK);
    CHECK_RELATIVE("... on both sides of the mirror", darkness(&c, 0, 0, 200, 200), darkness(&c, 200, 0, 400, 200),
                   0.01);
    CHECK_EQUAL("written", mpm_io_png(FOLDER "/solid.png", c.rgb, c.width, c.height, NULL, &f), MPM_OK);
    w.body[0].active--;
    for (k = 0; k < 2; k++) {
        mpm_draw_canvas_init(&both[k], 400, 300, NULL, 0);
        CHECK_EQUAL("a point less", mpm_draw_solid(&both[k], all, &d, &f), MPM_OK);
        w.points.x[0][w.body[0].active] = 600;
    }
    CHECK_TRUE("wherever it was retired, the picture is the same", !memcmp(both[0].rgb, both[1].rgb, 400 * 300 * 3));
    for (k = 0; k < 2; k++) mpm_draw_canvas_free(&both[k]);
    mpm_draw_canvas_free(&c);
    mpm_free(&w);
}

int main(void)
{
    if (mpm_io_make_directory(FOLDER, NULL) < 0) return 1;
    test_canvas();
    test_drawing();
    test_colours();
    test_cut();
    test_ends();
    test_world();
    test_numbers();
    test_ticks();
    test_far_ticks();
    test_odd_sizes();
    test_unmarked();
    test_color_bar();
    test_plots();
    test_clip();
    test_tiny_window();
    test_ticks_room();
    test_solid();
    test_solid_order();
    test_solid_refused();
    test_solid_world();
    return check_end();
}
