/* report.h - report.html: what a run gave as one page that any browser opens from the disk. Its looks are in
   web/report; here it is filled.

   A program that steps a world says page_options, page_begin before the first step, page_frame before output_frame, and
   page_write at the end; a study the last alone. Frames wait in report.part, a line each, until the page is written: a
   run that is stopped has a page of what it did, and one that goes on has them all. Numbers are taken from the text of
   summary.json. Nothing in it depends on time or speed: the same run writes the same bytes.
   SPDX-License-Identifier: MIT */
#ifndef REPORT_H
#define REPORT_H

#include "history.h"
#include "output.h"
#include "report_page.h"

/* ---- text ------------------------------------------------------------------------------------ */

#define PAGE_MU "\xc2\xb5"        /* of micrometres, in UTF-8 */
#define PAGE_MINUS "\xe2\x88\x92"

/* Into HTML, what has a meaning there escaped. Test: 68_report. */
static inline void page_letter(FILE *f, char c)
{
    switch (c) {
    case '&': fputs("&amp;", f); break;
    case '<': fputs("&lt;", f); break;
    case '>': fputs("&gt;", f); break;
    case '"': fputs("&quot;", f); break;
    case '\'': fputs("&#39;", f); break;
    default: fputc(c, f);
    }
}

static inline void page_text(FILE *f, const char *text)
{
    while (*text) page_letter(f, *text++);
}

/* A unit as people write it: um2 with a mu and a raised two. */
static inline void page_unit(FILE *f, const char *unit)
{
    for (; *unit; unit++) {
        if (*unit == 'u' && unit[1] == 'm') fputs("&micro;", f);
        else if (*unit == '2' || *unit == '3') fprintf(f, "&sup%c;", *unit);
        else page_letter(f, *unit);
    }
}

/* As a string of JSON inside a script, which a "<" could end. Test: 68_report. */
static inline void page_string(FILE *f, const char *text)
{
    fputc('"', f);
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < 0x20 || c == '<' || c == '"' || c == '\\') fprintf(f, "\\u%04x", c);
        else fputc(c, f);
    }
    fputc('"', f);
}

/* As a number of JSON; null if it is none. */
static inline void page_number(FILE *f, double value)
{
    char text[32];
    mpm_io_number_text(text, sizeof text, value);
    fputs(isfinite(value) ? text : "null", f);
}

static inline void page_numbers(FILE *f, const double *value, int n)
{
    int k;
    fputc('[', f);
    for (k = 0; k < n; k++) {
        if (k) fputc(',', f);
        page_number(f, value[k]);
    }
    fputc(']', f);
}

/* With so many decimals, for reading; PAGE_TINY: as a power of ten. */
#define PAGE_TINY (-1)
static inline void page_rounded(FILE *f, double value, int decimals)
{
    const double unit = decimals < 0 ? 0 : pow(10, -decimals);
    char text[400];
    if (!isfinite(value)) {
        fputs("none", f);
        return;
    }
    if (decimals < 0) snprintf(text, sizeof text, "%.1e", fabs(value));
    else snprintf(text, sizeof text, "%.*f", decimals, fabs(value) < unit / 2 ? 0 : fabs(value));
    mpm_io_decimal_point(text);
    fprintf(f, "%s%s", value < 0 && fabs(value) >= unit / 2 ? "&minus;" : "", text);
}

/* ---- numbers in base64 ----------------------------------------------------------------------- */

typedef struct page_code {
    FILE *f;
    unsigned long bits;
    int held; /* bytes that wait for the third */
} page_code;

/* The first n of the four signs of three bytes, "=" for the others. */
static inline void page_signs(page_code *c, int n)
{
    static const char sign[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    int k;
    for (k = 0; k < 4; k++) fputc(k < n ? sign[c->bits >> (18 - 6 * k) & 63] : '=', c->f);
    c->bits = 0;
    c->held = 0;
}

static inline void page_byte(page_code *c, unsigned byte)
{
    c->bits = c->bits << 8 | (byte & 255);
    if (++c->held == 3) page_signs(c, 4);
}

/* Writes what waits. Test: 68_report. */
static inline void page_code_end(page_code *c)
{
    const int held = c->held;
    if (held == 0) return;
    c->bits <<= 8 * (3 - held);
    page_signs(c, held + 1);
}

/* A number of low .. high as 16 bits, the low byte first. */
static inline void page_short(page_code *c, double value, double low, double high)
{
    const double part = high > low ? (value - low) / (high - low) : 0;
    const unsigned n = (unsigned)(65535 * (part > 0 ? part < 1 ? part : 1 : 0) + 0.5);
    page_byte(c, n);
    page_byte(c, n >> 8);
}

/* ---- frames ---------------------------------------------------------------------------------- */

#define PAGE_FRAMES 101    /* at most on a page; of more, some evenly in time */
#define PAGE_POINTS 30000  /* of a frame, at most */
#define PAGE_NUMBERS 480000 /* points of all frames together, at most about: 9 MB */

typedef struct page {
    int wanted, unwanted; /* --report, --no-report */
    int on;
    double spacing;       /* of the points */
} page;

static inline void page_options(page *p, option *o, int *n)
{
    memset(p, 0, sizeof *p);
    option_add(o, n, "report", OPTION_FLAG, &p->wanted, "report.html without frames too; with frames it is written");
    option_add(o, n, "no-report", OPTION_FLAG, &p->unwanted, "none");
}

static inline int page_check(const page *p, char *message, size_t n)
{
    if (!p->wanted || !p->unwanted) return 1;
    snprintf(message, n, "--report and --no-report: one of them");
    return 0;
}

static inline int page_lost(void) { return complain("report.part cannot be written"); }

/* Puts the frames before number `frame` from one file into another; they are of a run that was left there. */
static inline void page_keep(FILE *from, FILE *to, int64_t frame)
{
    int c = 0, keep, at;
    while (c != EOF) {
        char head[40] = "";
        for (at = 0; at < 39 && (c = fgetc(from)) != EOF && c != ',' && c != '\n'; at++) head[at] = (char)c;
        keep = !strncmp(head, "{\"frame\":", 9) && strtoll(head + 9, NULL, 10) < frame;
        if (keep) fprintf(to, "%s%c", head, c == EOF ? '\n' : c);
        while (c != EOF && c != '\n') {
            c = fgetc(from);
            if (keep && c != EOF) fputc(c, to);
        }
    }
}

/* Before the first step: no frames yet, or those that the run had written where it goes on. Returns 1, or 0 after a
   message, as all that write. Test: 68_report. */
static inline int page_begin(page *p, const output *o, double spacing)
{
    char path[PATH_BYTES], old[PATH_BYTES];
    FILE *from, *to;
    int ok;
    p->on = !p->unwanted && (p->wanted || o->frames > 0);
    p->spacing = spacing;
    if (!p->on) return 1;
    file_in(o->folder, "report.part", path, sizeof path);
    file_in(o->folder, "report.old.part", old, sizeof old);
    remove(old);
    rename(path, old);
    from = o->frame > 0 ? fopen(old, "rb") : NULL;
    to = fopen(path, "wb");
    if (from && to) page_keep(from, to, o->frame);
    if (from) fclose(from);
    ok = to && !ferror(to);
    if (to) ok = fclose(to) == 0 && ok;
    remove(old);
    return ok || page_lost();
}

/* A frame of the run that belongs on the page. */
static inline int page_takes(int64_t frame, int64_t frames)
{
    const int64_t most = PAGE_FRAMES - 1, last = frames - 1;
    if (frames <= PAGE_FRAMES || frame == 0) return 1;
    return frame * most / last > (frame - 1) * most / last;
}

/* A quantity that the page can colour. */
typedef struct page_field {
    const char *name, *label, *unit, *map;
    double (*of)(const mpm_points *p, int32_t i);
} page_field;

static inline double page_strain(const mpm_points *p, int32_t i) { return (double)p->plastic_strain[i]; }
static inline double page_heat(const mpm_points *p, int32_t i) { return (double)p->temperature[i]; }
static inline double page_bond(const mpm_points *p, int32_t i) { return (double)p->bond[i]; }

static inline double page_pressure(const mpm_points *p, int32_t i)
{
    return point_pressure(p, i) / 1000; /* GPa */
}

static inline double page_mises(const mpm_points *p, int32_t i)
{
    return point_mises(p, i) / 1000;
}

static inline double page_speed(const mpm_points *p, int32_t i)
{
    return sqrt((double)(p->v[0][i] * p->v[0][i] + p->v[1][i] * p->v[1][i] + p->v[2][i] * p->v[2][i]));
}

#define PAGE_FIELDS 6
static inline const page_field *page_fields(void)
{
    static const page_field field[PAGE_FIELDS] = {
        {"strain", "plastic strain", "", "deep", page_strain},
        {"temperature", "temperature", "K", "heat", page_heat},
        {"pressure", "pressure", "GPa", "diverging", page_pressure},
        {"mises", "equivalent stress (von Mises)", "GPa", "deep", page_mises},
        {"speed", "speed", "m/s", "deep", page_speed},
        {"bond", "bond variable D", "", "heat", page_bond}};
    return field;
}

/* Where a point can be seen: 0 in a section through the axis, 1 at a surface, 2 inside. */
static inline int page_place(const mpm_world *w, int32_t i, double near_to)
{
    const mpm_points *p = &w->points;
    if (w->desc.geometry != MPM_3D || fabs((double)p->x[0][i]) < near_to || fabs((double)p->x[1][i]) < near_to)
        return 0;
    return p->flags[i] & MPM_POINT_SURFACE ? 1 : 2;
}

/* Puts down the points to show: all, or of too many those of the section first, then of surfaces. A point is chosen by
   its number, so that it stays from frame to frame. Returns how many. */
static inline int32_t page_choose(const mpm_world *w, double near_to, int64_t most, int32_t *chosen)
{
    double count[3] = {0, 0, 0}, share[3], left = (double)most;
    int32_t b, i, n = 0;
    int k;
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) count[page_place(w, i, near_to)]++;
    for (k = 0; k < 3; k++) {
        const double room = k == 0 && count[1] > 0 ? fmax(0.6 * left, left - count[1] - count[2]) : left;
        share[k] = count[k] > room ? room / count[k] : 1;
        left -= share[k] * count[k];
    }
    for (b = 0; b < w->bodies; b++)
        for (i = w->body[b].first; i < w->body[b].first + w->body[b].active; i++) {
            const double draw = (double)((uint32_t)w->points.id[i] * 2654435761u & 0xffffffffu) / 4294967296.0;
            if (draw < share[page_place(w, i, near_to)]) chosen[n++] = i;
        }
    return n;
}

/* Coordinate a of n points, from end to end of the grid. */
static inline void page_axis(FILE *f, const mpm_world *w, int a, const int32_t *chosen, int32_t n)
{
    const double low = (double)w->desc.origin[a], size = w->desc.cells[a] * (double)w->desc.cell;
    page_code c = {f, 0, 0};
    int32_t k;
    fprintf(f, ",\"%c\":\"", "xyz"[a]);
    for (k = 0; k < n; k++) page_short(&c, (double)w->points.x[a][chosen[k]], low, low + size);
    page_code_end(&c);
    fputc('"', f);
}

/* "name":[low, high, "numbers between"] */
static inline void page_values(FILE *f, const mpm_world *w, const page_field *field, const int32_t *chosen, int32_t n)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    page_code c = {f, 0, 0};
    int32_t k;
    for (k = 0; k < n; k++) {
        const double value = field->of(&w->points, chosen[k]);
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    fprintf(f, ",\"%s\":[", field->name);
    page_number(f, low);
    fputc(',', f);
    page_number(f, high);
    fputs(",\"", f);
    for (k = 0; k < n; k++) page_short(&c, field->of(&w->points, chosen[k]), low, high);
    page_code_end(&c);
    fputs("\"]", f);
}

/* The body of each point. */
static inline void page_bodies(FILE *f, const mpm_world *w, const int32_t *chosen, int32_t n)
{
    page_code c = {f, 0, 0};
    int32_t k, b = 0;
    fputs(",\"body\":\"", f);
    for (k = 0; k < n; k++) {
        while (b + 1 < w->bodies && chosen[k] >= w->body[b + 1].first) b++;
        page_byte(&c, (unsigned)(b < 255 ? b : 255));
    }
    page_code_end(&c);
    fputc('"', f);
}

/* How a marker meets others: 0 not at all, 1 pressed, 2 with adhesion that is not spent. */
static inline unsigned page_mark(const mpm_surfaces *s, const mpm_marker *m)
{
    unsigned mark = 0;
    int k;
    for (k = 0; k < MPM_SURFACE_MEETS; k++) {
        if (m->meet[k].other == MPM_SURFACE_NONE) continue;
        if (mpm_surface_adhesion(s, &m->meet[k]) > 0) return 2;
        if (m->meet[k].pressure > 0) mark = 1;
    }
    return mark;
}

/* The surface of one body: places and marks of its markers, three bytes for each number of a face. */
static inline void page_surface(FILE *f, const mpm_world *w, const mpm_surfaces *s, const mpm_surface *c)
{
    page_code code = {f, 0, 0};
    int32_t i;
    int a;
    fprintf(f, "{\"body\":%d,\"corners\":%d", (int)c->body, c->corners);
    for (a = 0; a < 3; a++) {
        const double low = (double)w->desc.origin[a], size = w->desc.cells[a] * (double)w->desc.cell;
        if (a == 1 && c->corners == 2) continue;
        fprintf(f, ",\"%c\":\"", "xyz"[a]);
        for (i = 0; i < c->markers; i++) page_short(&code, (double)c->marker[i].x[a], low, low + size);
        page_code_end(&code);
        fputc('"', f);
    }
    fputs(",\"mark\":\"", f);
    for (i = 0; i < c->markers; i++) page_byte(&code, page_mark(s, &c->marker[i]));
    page_code_end(&code);
    fputs("\",\"face\":\"", f);
    for (i = 0; i < c->faces; i++)
        for (a = 0; a < c->corners; a++) {
            page_byte(&code, (unsigned)c->face[i][a]);
            page_byte(&code, (unsigned)c->face[i][a] >> 8);
            page_byte(&code, (unsigned)c->face[i][a] >> 16);
        }
    fputs("\"}", f);
}

/* One line: a frame as an object of JSON. */
static inline void page_line(FILE *f, const mpm_world *w, const mpm_surfaces *s, const output *o,
                             const int32_t *chosen, int32_t n)
{
    const page_field *field = page_fields();
    int32_t b;
    int k;
    fprintf(f, "{\"frame\":%lld,\"time\":", (long long)o->frame);
    page_number(f, (double)w->time * 1e3);
    fprintf(f, ",\"points\":%ld", (long)n);
    for (k = 0; k < 3; k++)
        if (k != 1 || w->desc.geometry == MPM_3D) page_axis(f, w, k, chosen, n);
    page_bodies(f, w, chosen, n);
    for (k = 0; k < PAGE_FIELDS; k++) page_values(f, w, &field[k], chosen, n);
    fputs(",\"surfaces\":[", f);
    for (b = 0; s && b < s->surfaces; b++) {
        if (b) fputc(',', f);
        page_surface(f, w, s, &s->surface[b]);
    }
    fputs("]}\n", f);
}

/* The frame to come, before output_frame counts it; s: surfaces, or NULL. */
static inline int page_frame(const page *p, output *o, const mpm_world *w, const mpm_surfaces *s)
{
    const clock_t mark = clock();
    const int64_t frames = o->frames < 1 ? 1 : o->frames > PAGE_FRAMES ? PAGE_FRAMES : o->frames;
    const int64_t most = PAGE_NUMBERS / frames < PAGE_POINTS ? PAGE_NUMBERS / frames : PAGE_POINTS;
    char path[PATH_BYTES];
    int32_t *chosen;
    FILE *f;
    int ok;
    if (!p->on || !page_takes(o->frame, o->frames)) return 1;
    chosen = (int32_t *)malloc(((size_t)w->points.count + 1) * sizeof *chosen);
    if (!chosen) return complain("no memory for the report");
    f = fopen(file_in(o->folder, "report.part", path, sizeof path), "ab");
    if (f) page_line(f, w, s, o, chosen, page_choose(w, p->spacing, most, chosen));
    free(chosen);
    ok = f && !ferror(f);
    if (f) ok = fclose(f) == 0 && ok;
    o->writing += clock() - mark;
    return ok || page_lost();
}

/* ---- the page -------------------------------------------------------------------------------- */

/* A number of summary.json that the page shows. */
typedef struct page_row {
    const char *key, *label, *unit;
    int decimals, tile;   /* tile: among the few large ones too */
    const char *words;    /* what it says */
} page_row;

/* A curve or places of a study. */
typedef struct page_series {
    const char *name;
    const double *x, *y, *full; /* full: 1, a filled place, or 0, an open one; NULL: all filled */
    int count, line;      /* line: 1 joined, 0 places alone */
} page_series;

/* Curves over one axis, with a band of x that is known no better: low .. high, most likely `at`. */
typedef struct page_panel {
    const char *title, *x, *y, *band;
    const page_series *series;
    int count;
    double low, high, at; /* not numbers: none */
} page_panel;

/* All that a page says. Texts are plain: they are escaped here. */
typedef struct page_desc {
    const char *program, *title, *verdict, *lead;
    int good;                       /* the verdict is the one to be hoped for */
    const page_row *row;
    int rows;
    const option *option;           /* of the run */
    int options;
    int argc;
    char **argv;
    const history *past;            /* or NULL */
    const page_panel *panel;
    int panels;
    const mpm_world *world;         /* of the frames, or NULL: there are none */
    const char *length, *time;      /* units */
    double spacing;
    const char *picture;            /* of the folder, for browsers without scripts; or NULL */
} page_desc;

/* A page of nothing yet, of a program with these options and this command line. */
static inline page_desc page_of(const option *options, int n, int argc, char **argv)
{
    page_desc d;
    memset(&d, 0, sizeof d);
    d.option = options;
    d.options = n;
    d.argc = argc;
    d.argv = argv;
    return d;
}

/* Options that say how a run goes, not what comes out. */
static inline int page_passes(const char *name)
{
    return word_place("out|quiet|resume|checkpoint|stop-after|report|no-report", name) >= 0;
}

/* The number of a key, not a number if it is null or not there. */
static inline double page_value(const char *summary, const char *key)
{
    const char *at = json_value(summary, key);
    char *end;
    const double value = at ? strtod(at, &end) : NAN;
    return at && end > at ? value : (double)NAN;
}

static inline void page_tiles(FILE *f, const page_desc *d, const char *summary)
{
    int k;
    for (k = 0; k < d->rows; k++) {
        if (!d->row[k].tile) continue;
        fputs("<li><span class=\"value\">", f);
        page_rounded(f, page_value(summary, d->row[k].key), d->row[k].decimals);
        fputs(" <small>", f);
        page_unit(f, d->row[k].unit);
        fputs("</small></span><span class=\"label\">", f);
        page_text(f, d->row[k].label);
        fputs("</span></li>\n", f);
    }
}

/* What came out; a number that the summary does not have is left out. */
static inline void page_table(FILE *f, const page_desc *d, const char *summary)
{
    int k;
    for (k = 0; k < d->rows; k++) {
        const page_row *r = &d->row[k];
        if (!json_value(summary, r->key)) continue;
        fputs("<tr><th scope=\"row\">", f);
        page_text(f, r->label);
        fprintf(f, "</th><td class=\"number\" data-key=\"%s\" data-value=\"", r->key);
        page_number(f, page_value(summary, r->key));
        fputs("\">", f);
        page_rounded(f, page_value(summary, r->key), r->decimals);
        fputs("</td><td class=\"unit\">", f);
        page_unit(f, r->unit);
        fputs("</td><td>", f);
        page_text(f, r->words);
        fputs("</td></tr>\n", f);
    }
}

/* Every number of the summary before its options, but those of time and speed. */
static inline void page_every(FILE *f, const char *summary)
{
    const char *at = summary, *end = strstr(summary, "\"options\":");
    while ((at = strstr(at, "\n  \"")) != NULL && (!end || at < end)) {
        char key[70] = "";
        const size_t n = strcspn(at += 4, "\"");
        if (n < sizeof key) memcpy(key, at, n);
        if (isfinite(page_value(summary, key)) && !strstr(key, "second") && !strstr(key, "_now")) {
            fprintf(f, "<tr><th scope=\"row\">%s</th><td class=\"number\" data-every=\"%s\">", key, key);
            page_number(f, page_value(summary, key));
            fputs("</td></tr>\n", f);
        }
        at += n;
    }
}

static inline void page_parameters(FILE *f, const page_desc *d)
{
    char number[OPTION_NUMBER];
    int k;
    for (k = 0; k < d->options; k++) {
        const option *o = &d->option[k];
        if (page_passes(o->name)) continue;
        fprintf(f, "<tr><th scope=\"row\">--%s</th><td>", o->name);
        page_text(f, option_text(o, number));
        fputs("</td><td>", f);
        page_text(f, o->help);
        fputs("</td></tr>\n", f);
    }
}

/* As a shell takes it, in HTML. */
static inline void page_argument(FILE *f, const char *a)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
    if (*a && a[strspn(a, plain)] == 0) {
        fputs(a, f);
        return;
    }
    page_letter(f, '\'');
    for (; *a; a++)
        if (*a == '\'') page_text(f, "'\\''");
        else page_letter(f, *a);
    page_letter(f, '\'');
}

/* The command line, without what says where to and how it goes on. */
static inline void page_command(FILE *f, const page_desc *d)
{
    int a;
    for (a = 0; a < d->argc; a++) {
        const int named = a > 0 && !strncmp(d->argv[a], "--", 2);
        if (named && page_passes(d->argv[a] + 2)) {
            a += word_place("quiet|resume|report|no-report", d->argv[a] + 2) < 0; /* its value */
            continue;
        }
        if (a) fputc(' ', f);
        page_argument(f, d->argv[a]);
    }
}

/* What made the page. */
static inline void page_provenance(FILE *f)
{
    fprintf(f, "mpm.h %s, %s precision", mpm_version(), sizeof(mpm_real) == sizeof(double) ? "double" : "single");
#ifdef __VERSION__
    fputs(", compiled by ", f);
#if defined(__GNUC__) && !defined(__clang__)
    fputs("gcc ", f);
#endif
    page_text(f, __VERSION__);
#endif
#if defined(__x86_64__)
    fputs(", x86_64", f);
#elif defined(__aarch64__)
    fputs(", aarch64", f);
#endif
}

/* For browsers without scripts, and on paper. */
static inline void page_picture(FILE *f, const page_desc *d, const char *folder)
{
    char path[PATH_BYTES];
    page_code c = {f, 0, 0};
    FILE *from = d->picture ? fopen(file_in(folder, d->picture, path, sizeof path), "rb") : NULL;
    int byte;
    if (!from) return;
    fputs("<p class=\"note\">This browser runs no scripts: here is the last picture.</p>\n<img alt=\"", f);
    page_text(f, d->title);
    fputs("\" src=\"data:image/png;base64,", f);
    while ((byte = fgetc(from)) != EOF) page_byte(&c, (unsigned)byte);
    page_code_end(&c);
    fputs("\">", f);
    fclose(from);
}

/* "past":{"column":[[name, unit, words], ...],"row":[[...], ...]} */
static inline void page_past(FILE *f, const history *h)
{
    int64_t i;
    int k;
    fputs(",\n\"past\":{\"column\":[", f);
    for (k = 0; k < h->columns; k++) {
        fputs(k ? ",\n[" : "[", f);
        page_string(f, h->column[k].name);
        fputc(',', f);
        page_string(f, h->column[k].unit);
        fputc(',', f);
        page_string(f, h->column[k].about);
        fputc(']', f);
    }
    fputs("],\"row\":[", f);
    for (i = 0; i < h->rows; i++) {
        if (i) fputs(",\n", f);
        page_numbers(f, h->row[i], h->columns);
    }
    fputs("]}", f);
}

/* "text":"...", */
static inline void page_pair(FILE *f, const char *key, const char *text)
{
    fprintf(f, "\"%s\":", key);
    page_string(f, text);
    fputc(',', f);
}

static inline void page_curves(FILE *f, const page_panel *p)
{
    const double band[3] = {p->low, p->at, p->high};
    int k;
    fputc('{', f);
    page_pair(f, "title", p->title);
    page_pair(f, "x", p->x);
    page_pair(f, "y", p->y);
    page_pair(f, "words", p->band ? p->band : "");
    fputs("\"band\":", f);
    page_numbers(f, band, 3);
    fputs(",\"series\":[", f);
    for (k = 0; k < p->count; k++) {
        const page_series *s = &p->series[k];
        fputs(k ? ",\n{" : "{", f);
        page_pair(f, "name", s->name);
        fprintf(f, "\"line\":%d,\"x\":", s->line);
        page_numbers(f, s->x, s->count);
        fputs(",\"y\":", f);
        page_numbers(f, s->y, s->count);
        if (s->full) {
            fputs(",\"full\":", f);
            page_numbers(f, s->full, s->count);
        }
        fputc('}', f);
    }
    fputs("]}", f);
}

/* The grid that the frames are of. */
static inline void page_scene(FILE *f, const page_desc *d)
{
    const mpm_desc *g = &d->world->desc;
    const page_field *field = page_fields();
    double low[3], size[3];
    int k;
    for (k = 0; k < 3; k++) {
        low[k] = (double)g->origin[k];
        size[k] = g->cells[k] * (double)g->cell;
    }
    fprintf(f, ",\n\"geometry\":\"%s\",\"mirror\":[%d,%d],\"bodies\":%d,\"low\":",
            g->geometry == MPM_3D ? "3d" : g->geometry == MPM_AXISYMMETRIC ? "axisymmetric" : "plane",
            g->side[0] == MPM_SIDE_SYMMETRY, g->geometry == MPM_3D && g->side[2] == MPM_SIDE_SYMMETRY,
            (int)d->world->bodies);
    page_numbers(f, low, 3);
    fputs(",\"size\":", f);
    page_numbers(f, size, 3);
    fputs(",\"spacing\":", f);
    page_number(f, d->spacing);
    fputs(",\n\"field\":[", f);
    for (k = 0; k < PAGE_FIELDS; k++) {
        fputs(k ? ",\n{" : "{", f);
        page_pair(f, "name", field[k].name);
        page_pair(f, "label", field[k].label);
        page_pair(f, "unit", field[k].unit);
        fprintf(f, "\"map\":\"%s\"}", field[k].map);
    }
    fputc(']', f);
}

static inline void page_meta(FILE *f, const page_desc *d)
{
    int k;
    fputc('{', f);
    page_pair(f, "length", d->length ? d->length : "");
    page_pair(f, "time", d->time ? d->time : "");
    page_pair(f, "title", d->title);
    fputs("\"panel\":[", f);
    for (k = 0; k < d->panels; k++) {
        if (k) fputs(",\n", f);
        page_curves(f, &d->panel[k]);
    }
    fputc(']', f);
    if (d->world) page_scene(f, d);
    if (d->past) page_past(f, d->past);
    fputs("}\n", f);
}

/* The lines of report.part as the elements of an array. */
static inline void page_film(FILE *f, const char *folder)
{
    char path[PATH_BYTES];
    FILE *from = fopen(file_in(folder, "report.part", path, sizeof path), "rb");
    int c, last = 0;
    fputc('[', f);
    while (from && (c = fgetc(from)) != EOF) {
        if (last == '\n') fputs(",\n", f);
        if (c != '\n') fputc(c, f);
        last = c;
    }
    fputs("]\n", f);
    if (from) fclose(from);
}

static inline void page_lines(FILE *f, const char *const *line)
{
    while (*line) fputs(*line++, f);
}

/* Fills one {{place}} of the page. */
static inline void page_fill(FILE *f, const char *place, const page_desc *d, const char *folder, const char *summary)
{
    if (!strcmp(place, "title")) page_text(f, d->title);
    else if (!strcmp(place, "program")) page_text(f, d->program);
    else if (!strcmp(place, "verdict")) page_text(f, d->verdict);
    else if (!strcmp(place, "mood")) fputs(d->good ? "good" : "other", f);
    else if (!strcmp(place, "lead")) page_text(f, d->lead);
    else if (!strcmp(place, "tiles")) page_tiles(f, d, summary);
    else if (!strcmp(place, "rows")) page_table(f, d, summary);
    else if (!strcmp(place, "every")) page_every(f, summary);
    else if (!strcmp(place, "options")) page_parameters(f, d);
    else if (!strcmp(place, "command")) page_command(f, d);
    else if (!strcmp(place, "provenance")) page_provenance(f);
    else if (!strcmp(place, "picture")) page_picture(f, d, folder);
    else if (!strcmp(place, "meta")) page_meta(f, d);
    else if (!strcmp(place, "frames")) page_film(f, folder);
    else if (!strcmp(place, "style")) page_lines(f, page_css());
    else if (!strcmp(place, "script")) page_lines(f, page_js());
}

/* A line of the page, its {{places}} filled. */
static inline void page_skeleton(FILE *f, const char *line, const page_desc *d, const char *folder,
                                 const char *summary)
{
    while (*line) {
        char place[20] = "";
        const char *end = strncmp(line, "{{", 2) ? NULL : strstr(line, "}}");
        if (end && (size_t)(end - line - 2) < sizeof place) {
            memcpy(place, line + 2, (size_t)(end - line - 2));
            page_fill(f, place, d, folder, summary);
            line = end + 2;
        } else {
            fputc(*line++, f);
        }
    }
}

/* Writes folder/report.html, behind summary.json. Returns 1, or 0 after a message: then nothing has the name.
   Test: 68_report. */
static inline int page_write(const page_desc *d, const char *folder)
{
    const char *const *line = page_html();
    const size_t room = 200000;
    char path[PATH_BYTES], *summary = (char *)malloc(room);
    mpm_io_file file;
    mpm_fault fault;
    if (!summary) return complain("no memory for the report");
    if (!text_read(file_in(folder, "summary.json", path, sizeof path), summary, room)) {
        free(summary);
        return complain("summary.json cannot be read");
    }
    if (mpm_io_open(&file, file_in(folder, "report.html", path, sizeof path), &fault) < 0) {
        free(summary);
        return report(&fault, path);
    }
    for (; *line; line++) page_skeleton(file.stream, *line, d, folder, summary);
    free(summary);
    return mpm_io_close(&file, &fault) >= 0 || report(&fault, path);
}

/* After the end the frames are in the page. */
static inline void page_end(const page *p, const char *folder)
{
    char path[PATH_BYTES];
    if (p->on) remove(file_in(folder, "report.part", path, sizeof path));
}

#endif
