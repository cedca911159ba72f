/* 68_report - report.html: well-formed, its numbers those of summary.json and its points those of ParaView's files,
   what has a meaning in HTML escaped; a run that was stopped has a page, one that goes on that of the run that was not;
   where the disk is full there is none. SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <signal.h>
#include <sys/resource.h>
#define MPM_IMPLEMENTATION
#include "impact_case.h"
#include "report.h"
#include "check.h"
#include "files.h"

#define FOLDER "build/tests/report"

static int shell(const char *command, const char *options)
{
    char line[600];
    snprintf(line, sizeof line, "%s %s >build/tests/report.out 2>build/tests/report.err", command, options);
    return system(line);
}

/* ---- a small reader of HTML -------------------------------------------------------------------- */

/* Past the quoted values of a tag, to its end; NULL if a quote stays open. */
static const char *tag_end(const char *at)
{
    char quote = 0;
    for (; *at; at++) {
        if (quote) quote = *at == quote ? 0 : quote;
        else if (*at == '"' || *at == '\'') quote = *at;
        else if (*at == '>') return at;
    }
    return NULL;
}

static int is_void(const char *name)
{
    return word_place("!doctype|meta|img|input|br|hr|link", name) >= 0;
}

/* Whether an ampersand begins an entity. */
static int is_entity(const char *at)
{
    const size_t n = strspn(at + 1, "#abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789");
    return n > 0 && n < 10 && at[1 + n] == ';';
}

/* How many elements a page has; -1 - the place where one is closed that is not open, or anything else is wrong. */
static long elements(const char *html)
{
    static char open[64][16];
    const char *at = html;
    long count = 0;
    int depth = 0;
    while (*at) {
        char name[16] = "";
        const char *end;
        size_t n;
        int closing;
        if (*at == '&' && !is_entity(at)) return -1 - (at - html);
        if (*at != '<') { at++; continue; }
        closing = at[1] == '/';
        n = strcspn(at + 1 + closing, " >\n\"");
        end = tag_end(at);
        if (!end || n == 0 || n >= sizeof name) return -1 - (at - html);
        memcpy(name, at + 1 + closing, n);
        if (closing && (depth == 0 || strcmp(open[--depth], name))) return -1 - (at - html);
        if (!closing && !is_void(name)) {
            if (depth == 64) return -1 - (at - html);
            strcpy(open[depth++], name);
        }
        count += !closing;
        at = end + 1;
        if (closing || (strcmp(name, "script") && strcmp(name, "style"))) continue;
        at = strstr(at, strcmp(name, "style") ? "</script" : "</style"); /* what is in between is text */
        if (!at) return -1 - (end - html);
    }
    return depth == 0 ? count : -1 - (at - html);
}

static void reader(void)
{
    CHECK_EQUAL("the reader counts elements", elements("<!doctype html><p a=\"<>\">x &amp; y<br></p>"), 3);
    CHECK_TRUE("... misses an end", elements("<p><b></b>") < 0);
    CHECK_TRUE("... sees a wrong end", elements("<p><b></p></b>") < 0);
    CHECK_TRUE("... sees a bare ampersand", elements("<p>a & b</p>") < 0);
    CHECK_TRUE("... and an open quote", elements("<p a=\"b></p>") < 0);
}

/* The page of a folder in fresh memory, "" if there is none. */
static char *page_in(const char *folder)
{
    char path[200];
    size_t n;
    char *html;
    snprintf(path, sizeof path, "%s/report.html", folder);
    html = (char *)slurp(path, &n);
    return html ? html : (char *)calloc(1, 1);
}

static int has_page(const char *folder)
{
    char path[200];
    snprintf(path, sizeof path, "%s/report.html", folder);
    return exists(path);
}

static int count_of(const char *text, const char *what)
{
    int n = 0;
    for (; (text = strstr(text, what)) != NULL; text += strlen(what)) n++;
    return n;
}

/* ---- base64, by another way than the writer's -------------------------------------------------- */

static int sign_value(char c)
{
    if (isupper((unsigned char)c)) return c - 'A';
    if (islower((unsigned char)c)) return 26 + c - 'a';
    if (isdigit((unsigned char)c)) return 52 + c - '0';
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/* Up to room bytes of what stands between quotes; returns how many there are. */
static size_t decode(const char *text, unsigned char *out, size_t room)
{
    size_t n = 0;
    unsigned bits = 0;
    int held = 0;
    for (; sign_value(*text) >= 0 && n < room; text++) {
        bits = bits << 6 | (unsigned)sign_value(*text);
        held += 6;
        if (held >= 8) out[n++] = (unsigned char)(bits >> (held -= 8));
    }
    return n;
}

static const char *encoded(const char *bytes)
{
    static char text[40];
    FILE *f = fopen("build/tests/report.code", "wb");
    page_code c = {NULL, 0, 0};
    if (!f) return "";
    for (c.f = f; *bytes; bytes++) page_byte(&c, (unsigned char)*bytes);
    page_code_end(&c);
    fclose(f);
    contents("build/tests/report.code", text, sizeof text);
    return text;
}

static void codes(void)
{
    unsigned char out[8];
    CHECK_TRUE("base64 of 3 bytes", !strcmp(encoded("Man"), "TWFu"));
    CHECK_TRUE("... of 2", !strcmp(encoded("Ma"), "TWE="));
    CHECK_TRUE("... of 1", !strcmp(encoded("M"), "TQ=="));
    CHECK_TRUE("... of none", !strcmp(encoded(""), ""));
    CHECK_EQUAL("it is read back", decode(encoded("light w"), out, 8), 7);
    CHECK_TRUE("... whole", !memcmp(out, "light w", 7));
}

static void choices(void)
{
    int64_t k, taken = 0;
    for (k = 0; k < 5000; k++) taken += page_takes(k, 5000);
    CHECK_EQUAL("of many frames some are shown", taken, PAGE_FRAMES);
    CHECK_EQUAL("... the first", page_takes(0, 5000), 1);
    CHECK_EQUAL("... and the last", page_takes(4999, 5000), 1);
    for (k = 0, taken = 0; k < PAGE_FRAMES; k++) taken += page_takes(k, PAGE_FRAMES);
    CHECK_EQUAL("of few all are", taken, PAGE_FRAMES);
}

/* Of too many points those at the section stay longest. */
static void thinned(void)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_world w;
    int32_t *chosen, n, k, section = 0, all = 0;
    d.cell = 1;
    for (k = 0; k < 3; k++) d.cells[k] = 12, d.origin[k] = -6;
    b.shape = mpm_sphere(0, 0, 0, 5);
    b.spacing = MPM_R(0.4);
    b.density = 1;
    if (mpm_init(&w, &d, NULL, 0) < 0 || mpm_body_add(&w, &b) < 0) return;
    chosen = (int32_t *)malloc((size_t)w.points.count * sizeof *chosen);
    if (!chosen) return;
    CHECK_EQUAL("few points are all shown", page_choose(&w, 0.4, w.points.count, chosen), w.points.count);
    n = page_choose(&w, 0.4, w.points.count / 2, chosen);
    CHECK_RELATIVE("of many about as many as wanted", n, w.points.count / 2, 0.02);
    for (k = 0; k < w.points.count; k++) all += page_place(&w, k, 0.4) == 0;
    for (k = 0; k < n; k++) section += page_place(&w, chosen[k], 0.4) == 0;
    CHECK_EQUAL("... all of the section", section, all);
    free(chosen);
    mpm_free(&w);
}

/* ---- a page of texts --------------------------------------------------------------------------- */

static void write_text(const char *path, const char *text) { write_file(path, text, strlen(text)); }

static page_desc texts(char **argv)
{
    static const page_row row[] = {{"speed_m_s", "speed", "m/s", 2, 1, "how fast"}, {"none", "none", "", 0, 0, ""},
                                   {"lost", "lost", "um2", 1, 0, "a <null>"}};
    page_desc d = page_of(NULL, 0, 2, argv);
    d.program = "pro<gram";
    d.title = "a <title> & \"more\"</script>";
    d.verdict = "It's <so>";
    d.lead = "1 < 2 && 3 > 2";
    d.row = row;
    d.rows = 3;
    return d;
}

static void escaped(void)
{
    char program[] = "some where/pro", value[] = "--x=<&\"'>", *argv[2];
    char *html;
    page_desc d;
    argv[0] = program;
    argv[1] = value;
    d = texts(argv);
    mpm_io_make_directory(FOLDER "_text", NULL);
    write_text(FOLDER "_text/summary.json", "{\n  \"speed_m_s\": -1.236,\n  \"lost\": null,\n  \"options\": {\n"
                                            "    \"x\": 1\n  }\n}\n");
    remove(FOLDER "_text/report.part");
    CHECK_EQUAL("a page of texts", page_write(&d, FOLDER "_text"), 1);
    html = page_in(FOLDER "_text");
    CHECK_TRUE("... is well-formed", elements(html) > 50);
    CHECK_TRUE("... its title escaped",
               strstr(html, "<title>a &lt;title&gt; &amp; &quot;more&quot;&lt;/script&gt;: It&#39;s"));
    CHECK_EQUAL("... nowhere as it is", count_of(html, "a <title>"), 0);
    CHECK_TRUE("... in the data too",
               strstr(html, "\"title\":\"a \\u003ctitle> & \\u0022more\\u0022\\u003c/script>\""));
    CHECK_TRUE("... the lead", strstr(html, "1 &lt; 2 &amp;&amp; 3 &gt; 2"));
    CHECK_TRUE("... the command as a shell takes it",
               strstr(html, ">&#39;some where/pro&#39; &#39;--x=&lt;&amp;&quot;&#39;\\&#39;&#39;&gt;&#39;<"));
    CHECK_TRUE("a number is rounded", strstr(html, "data-value=\"-1.236\">&minus;1.24<"));
    CHECK_TRUE("... null is none", strstr(html, "data-value=\"null\">none<"));
    CHECK_TRUE("... what is not there is left out", !strstr(html, "data-key=\"none\""));
    CHECK_EQUAL("no place is left open", count_of(html, "{{"), 0);
    CHECK_TRUE("nothing is fetched",
               !strstr(html, "src=\"http") && !strstr(html, "href=\"http") && !strstr(html, "@import"));
    free(html);
}

/* The page has no room on a disk that is full. */
static void full_disk(void)
{
    struct rlimit usual, few;
    char *argv[1], program[] = "p";
    page_desc d;
    argv[0] = program;
    d = texts(argv);
    d.argc = 1;
    remove(FOLDER "_text/report.html");
    fflush(NULL);
    getrlimit(RLIMIT_FSIZE, &usual);
    few = usual;
    few.rlim_cur = 20000;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &few);
    CHECK_EQUAL("a page that does not fit on the disk", page_write(&d, FOLDER "_text"), 0);
    setrlimit(RLIMIT_FSIZE, &usual);
    CHECK_EQUAL("... is not there", has_page(FOLDER "_text"), 0);
    CHECK_TRUE("... nor a part of it", shell("ls", FOLDER "_text/*.part") != 0);
    CHECK_TRUE("a run whose frames do not fit ends", shell("rm -rf " FOLDER "_full; trap '' XFSZ; ulimit -f 8; "
               "build/impact", "--geometry axisymmetric --time 0.5 --quiet --out " FOLDER "_full") != 0);
    CHECK_TRUE("... with a message", strstr(text_of("build/tests/report.err"), "report.part") != NULL);
    CHECK_EQUAL("... without a page", has_page(FOLDER "_full"), 0);
}

/* ---- a run ------------------------------------------------------------------------------------- */

#define RUN "--geometry axisymmetric --time 1.5 --frames 3 --quiet --out "

/* Every number of the table stands in the summary, and is shown to its decimals. */
static void numbers(const char *html, const char *summary)
{
    const char *at = html;
    int same = 0, found = 0, near_to = 0;
    while ((at = strstr(at, "data-key=\"")) != NULL) {
        char key[64] = "";
        const char *shown;
        double value, read;
        memcpy(key, at + 10, strcspn(at + 10, "\"") % sizeof key);
        value = number_behind(at, "data-value=\"");
        shown = strchr(strstr(at, "data-value=\""), '>') + 1;
        read = strncmp(shown, "&minus;", 7) ? strtod(shown, NULL) : -strtod(shown + 7, NULL);
        same += !(value < number_in(summary, key) || value > number_in(summary, key));
        near_to += fabs(read - value) <= 0.06 * fabs(value) || fabs(read - value) <= 0.51;
        found++;
        at++;
    }
    CHECK_TRUE("numbers of the table", found > 15);
    CHECK_EQUAL("... are those of the summary", same, found);
    CHECK_EQUAL("... rounded", near_to, found);
    for (at = html, found = same = 0; (at = strstr(at, "data-every=\"")) != NULL; at++, found++) {
        char key[64] = "";
        memcpy(key, at + 12, strcspn(at + 12, "\"") % sizeof key);
        same += !(fabs(strtod(strchr(at, '>') + 1, NULL) - number_in(summary, key)) > 0);
    }
    CHECK_TRUE("the list of all numbers", found > 30);
    CHECK_EQUAL("... are those of the summary", same, found);
    CHECK_TRUE("... but not of time and speed", !strstr(html, "data-every=\"cpu_seconds") &&
                                                    !strstr(html, "data-every=\"point_steps_per_second"));
}

/* Largest difference between 16-bit numbers of the last frame, low .. high, and one component of ParaView's floats. */
static double apart(const unsigned char *code, size_t bytes, const unsigned char *array, size_t stride, size_t from,
                    double low, double high)
{
    double worst = 0;
    size_t i;
    for (i = 0; 2 * i < bytes; i++) {
        float value;
        memcpy(&value, array + 4 * (stride * i + from), 4);
        worst = check_worst(worst, fabs(low + (high - low) * (code[2 * i] + 256 * code[2 * i + 1]) / 65535 -
                                        (double)value));
    }
    return worst;
}

/* Places and temperatures of the last frame, beside points_0002.vtu. */
static void points(const char *html)
{
    const size_t room = 200000;
    unsigned char *code = (unsigned char *)malloc(room), *file;
    const char *last = strstr(html, "{\"frame\":2,"), *heat = last ? strstr(last, "\"temperature\":[") : NULL;
    const double count = number_behind(last ? last : "", "\"points\":");
    const unsigned char *array;
    const double low = number_behind(html, "\"low\":["), size = number_behind(html, "\"size\":[");
    char *end;
    double from, to;
    size_t n, bytes;
    uint64_t length;
    file = slurp(FOLDER "/points_0002.vtu", &n);
    CHECK_TRUE("the last frame and its file", code && file && heat);
    if (!code || !file || !heat) return;
    bytes = decode(strstr(last, "\"x\":\"") + 5, code, room);
    CHECK_EQUAL("its places", bytes, 2 * count);
    array = vtu_array(file, n, "Points", "Float32", &length);
    CHECK_EQUAL("... are as many as in the file", length, 12 * count);
    CHECK_TRUE("... where they are there", array && apart(code, bytes, array, 3, 0, low, low + size) < size / 1e5);
    from = strtod(heat + 15, &end);
    to = strtod(end + 1, &end);
    bytes = decode(strchr(end, '"') + 1, code, room);
    array = vtu_array(file, n, "temperature (K)", "Float32", &length);
    CHECK_EQUAL("its temperatures", bytes, 2 * count);
    CHECK_TRUE("... as hot as there", array && apart(code, bytes, array, 1, 0, from, to) < (to - from) / 1e5);
    free(code);
    free(file);
}

static void a_run(void)
{
    char *html;
    shell("rm -rf", FOLDER);
    CHECK_EQUAL("a run", shell("build/impact", RUN FOLDER), 0);
    html = page_in(FOLDER);
    CHECK_TRUE("its page is well-formed", elements(html) > 100);
    CHECK_EQUAL("... has its frames", count_of(html, "{\"frame\":"), 3);
    CHECK_TRUE("... says how to repeat it", strstr(html, "<code id=\"command\">build/impact --geometry axisymmetric "
                                                         "--time 1.5 --frames 3</code>"));
    CHECK_TRUE("... what made it", strstr(html, "mpm.h " MPM_VERSION ", double precision"));
    CHECK_TRUE("... has the history", strstr(html, "[\"energy_kinetic\",\"pJ\","));
    CHECK_TRUE("... and a picture for who runs no scripts", strstr(html, "src=\"data:image/png;base64,iVBORw0KGgo"));
    CHECK_EQUAL("no parts are left", exists(FOLDER "/report.part"), 0);
    numbers(html, FOLDER "/summary.json");
    points(html);
    free(html);
}

/* Stopped and gone on, twice: the same bytes. */
static void stopped(void)
{
    char *html;
    shell("rm -rf", FOLDER "_parts");
    CHECK_TRUE("a run that is stopped", shell("build/impact", "--stop-after 60 " RUN FOLDER "_parts") != 0);
    html = page_in(FOLDER "_parts");
    CHECK_TRUE("... has a page", elements(html) > 100);
    CHECK_EQUAL("... of the frames so far", count_of(html, "{\"frame\":"), 1);
    CHECK_TRUE("... that says so", strstr(html, "the run was stopped"));
    free(html);
    shell("build/impact", "--stop-after 60 --resume " RUN FOLDER "_parts");
    CHECK_EQUAL("it goes on", shell("build/impact", "--resume " RUN FOLDER "_parts"), 0);
    CHECK_EQUAL("... to the same page", shell("cmp", FOLDER "/report.html " FOLDER "_parts/report.html"), 0);
    CHECK_EQUAL("... and leaves no parts", exists(FOLDER "_parts/report.part"), 0);
}

/* Frames that were written after the checkpoint are not of the run that goes on from it. */
static void kept(void)
{
    output o = output_of(FOLDER "_text", "x", "um", "ns", 1);
    page p;
    const char *text;
    memset(&p, 0, sizeof p);
    write_text(FOLDER "_text/report.part", "{\"frame\":0,\"a\":1}\n{\"frame\":1,\"a\":2}\n{\"frame\":2,\"a\":3}\n");
    o.frame = 2;
    CHECK_EQUAL("frames of a run that goes on", page_begin(&p, &o, 1), 1);
    text = text_of(FOLDER "_text/report.part");
    CHECK_TRUE("... are kept up to there", !strcmp(text, "{\"frame\":0,\"a\":1}\n{\"frame\":1,\"a\":2}\n"));
    o.frame = 0;
    CHECK_EQUAL("one that begins", page_begin(&p, &o, 1), 1);
    CHECK_TRUE("... has none", !strcmp(text_of(FOLDER "_text/report.part"), ""));
    page_end(&p, FOLDER "_text");
    CHECK_EQUAL("... and in the end no file of them", exists(FOLDER "_text/report.part"), 0);
}

static void choice(void)
{
    char *html;
    shell("rm -rf", FOLDER "_none " FOLDER "_bare");
    CHECK_TRUE("both of --report and --no-report are refused",
               shell("build/impact", "--report --no-report --out " FOLDER "_none") != 0);
    CHECK_TRUE("... in words", strstr(text_of("build/tests/report.err"), "--no-report") != NULL);
    shell("build/impact", "--no-report --time 0.2 " RUN FOLDER "_none");
    CHECK_EQUAL("without one if asked", has_page(FOLDER "_none"), 0);
    shell("build/impact", "--geometry axisymmetric --time 0.2 --frames 0 --quiet --out " FOLDER "_none");
    CHECK_EQUAL("... and without frames", has_page(FOLDER "_none"), 0);
    shell("build/impact", "--report --geometry axisymmetric --time 0.2 --frames 0 --quiet --out " FOLDER "_bare");
    html = page_in(FOLDER "_bare");
    CHECK_TRUE("with --report there is one even so", elements(html) > 100);
    CHECK_EQUAL("... of no frames", count_of(html, "{\"frame\":"), 0);
    free(html);
}

int main(void)
{
    reader();
    codes();
    choices();
    thinned();
    CHECK_EQUAL("report_page.h is made of web/report",
                shell("sh web/report/embed.sh | cmp - examples/report_page.h", ""), 0);
    escaped();
    kept();
    full_disk();
    a_run();
    stopped();
    choice();
    return check_end();
}
