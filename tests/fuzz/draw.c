/* Pictures: every description of a cut, a solid, a scatter and a plot, ticks and numbers, into a small canvas.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "mpm.h"
#include "mpm_draw.h"

enum { N = 12 };

static void window(fuzz *f, double *w)
{
    int i;
    for (i = 0; i < 4; i++) w[i] = fuzz_double(f, w[i]);
}

static void ticks(fuzz *f)
{
    mpm_draw_tick tick[MPM_DRAW_TICKS];
    char text[40];
    const double low = fuzz_any(f), high = fuzz_any(f);
    const int is_log = (int)fuzz_byte(f) & 1, want = fuzz_int(f, 5), n = mpm_draw_ticks(low, high, is_log, want, tick);
    FUZZ_WANT(n >= 0 && n <= MPM_DRAW_TICKS);
    mpm_draw_nice(fuzz_any(f));
    mpm_draw_number(text, fuzz_byte(f) % sizeof text, fuzz_any(f), fuzz_int(f, 4));
}

static void primitives(fuzz *f, mpm_draw_canvas *c)
{
    char text[24];
    c->unit = fuzz_double(f, 1);
    mpm_draw_rectangle(c, fuzz_any(f), fuzz_any(f), fuzz_any(f), fuzz_any(f), 255);
    mpm_draw_line(c, fuzz_any(f), fuzz_any(f), fuzz_any(f), fuzz_any(f), fuzz_any(f), 255);
    mpm_draw_disc(c, fuzz_any(f), fuzz_any(f), fuzz_any(f), 255);
    mpm_draw_text(c, fuzz_double(f, 5), fuzz_double(f, 20), fuzz_double(f, 10), MPM_DRAW_LEFT, 0,
                  fuzz_text(f, text, sizeof text));
    mpm_draw_pixel(c, fuzz_int(f, 3), fuzz_int(f, 3));
    mpm_draw_map_color((mpm_draw_map)(fuzz_byte(f) % 3), fuzz_any(f));
    mpm_draw_series_color(fuzz_int(f, 3));
}

/* Balls or triangles. */
static void solid(fuzz *f, mpm_draw_canvas *c, mpm_draw_rect where, mpm_real (*x)[N], const int32_t *body,
                  const char *title)
{
    static int32_t corner[4][3] = {{0, 1, 2}, {2, 3, 4}, {5, 6, 7}, {8, 9, 11}};
    mpm_draw_solid_desc d = mpm_draw_solid_desc_default();
    int k;
    d.count = N;
    for (k = 0; k < 3; k++) d.x[k] = fuzz_byte(f) < 240 ? x[k] : NULL;
    for (k = 0; k < 3; k++) d.mirror[k] = (int)fuzz_byte(f) & 1;
    for (k = 0; k < 6; k++) d.box[k] = fuzz_double(f, d.box[k]);
    d.value = fuzz_byte(f) < 128 ? x[3] : NULL;
    d.body = fuzz_byte(f) < 128 ? body : NULL;
    d.size = fuzz_double(f, 1);
    d.turn = fuzz_double(f, d.turn);
    d.lift = fuzz_double(f, d.lift);
    corner[3][2] = fuzz_int(f, 11);
    d.triangles = fuzz_byte(f) < 128 ? 4 : 0;
    d.triangle = (const int32_t(*)[3])corner;
    FUZZ_CHOICE(f, d.map);
    d.scale = fuzz_double(f, 1);
    d.low = fuzz_double(f, 0);
    d.high = fuzz_double(f, 0);
    d.label = d.title = d.length_unit = title;
    mpm_draw_solid(c, where, &d, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    mpm_real x[4][N];
    int32_t body[N];
    mpm_draw_canvas c;
    mpm_draw_cut_desc cut = mpm_draw_cut_desc_default();
    mpm_draw_scatter_desc dots = mpm_draw_scatter_desc_default();
    mpm_draw_plot_desc plot = mpm_draw_plot_desc_default();
    mpm_draw_curve curve;
    mpm_draw_rect where;
    char title[24];
    const int columns = fuzz_int(&f, 1), rows = fuzz_int(&f, 1), number = fuzz_int(&f, 0);
    int i, k;
    for (i = 0; i < N; i++) {
        for (k = 0; k < 4; k++) {
            x[k][i] = (mpm_real)(i % (k + 2));
            FUZZ_REAL(&f, x[k][i]);
        }
        body[i] = fuzz_int(&f, i % 2);
    }
    fuzz_text(&f, title, sizeof title);
    ticks(&f);
    if (mpm_draw_canvas_init(&c, 160, 120, NULL, 0) < 0) return 0;
    where = mpm_draw_tile(&c, columns, rows, number);
    switch (fuzz_byte(&f) % 5) {
    case 0:
        for (k = 0; k < 3; k++) cut.x[k] = fuzz_byte(&f) < 240 ? x[k] : NULL;
        cut.count = N;
        cut.value = fuzz_byte(&f) < 128 ? x[3] : NULL;
        cut.body = fuzz_byte(&f) < 128 ? body : NULL;
        cut.spacing = fuzz_double(&f, 1);
        cut.normal = fuzz_int(&f, 1);
        cut.at = fuzz_double(&f, 0);
        cut.half_thickness = fuzz_double(&f, 0);
        FUZZ_CHOICE(&f, cut.mirror);
        window(&f, cut.window);
        FUZZ_CHOICE(&f, cut.map);
        FUZZ_CHOICE(&f, cut.style);
        cut.scale = fuzz_double(&f, 1);
        cut.low = fuzz_double(&f, 0);
        cut.high = fuzz_double(&f, 0);
        cut.label = cut.title = cut.length_unit = title;
        cut.length_scale = fuzz_double(&f, 1);
        FUZZ_CHOICE(&f, cut.ticks);
        mpm_draw_cut(&c, where, &cut, NULL);
        break;
    case 1:
        dots.count = N;
        dots.x = x[0];
        dots.y = x[1];
        dots.value = fuzz_byte(&f) < 128 ? x[2] : NULL;
        dots.size = fuzz_byte(&f) < 128 ? NULL : x[3];
        dots.dot = fuzz_double(&f, 5);
        FUZZ_CHOICE(&f, dots.equal);
        window(&f, dots.window);
        FUZZ_CHOICE(&f, dots.map);
        dots.scale = fuzz_double(&f, 1);
        dots.low = fuzz_double(&f, 0);
        dots.high = fuzz_double(&f, 0);
        dots.label = dots.title = dots.x_label = title;
        mpm_draw_scatter(&c, where, &dots, NULL);
        break;
    case 2:
        memset(&curve, 0, sizeof curve);
        curve.name = title;
        curve.count = N;
        curve.x = x[0];
        curve.y = x[1];
        FUZZ_CHOICE(&f, curve.mark);
        FUZZ_CHOICE(&f, curve.color);
        plot.curves = &curve;
        plot.curve_count = 1;
        window(&f, plot.window);
        plot.log_x = (int)fuzz_byte(&f) & 1;
        plot.log_y = (int)fuzz_byte(&f) & 1;
        plot.y_label = title;
        mpm_draw_plot(&c, where, &plot, NULL);
        break;
    case 3: solid(&f, &c, where, x, body, title); break;
    default: primitives(&f, &c); break;
    }
    mpm_draw_canvas_free(&c);
    return 0;
}
