/* 40_io - files and pictures: what is written comes back bit for bit through readers of our own,
   and a file that cannot be written leaves no trace. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_io.h"

#include <locale.h>

#include "check.h"

#ifdef MPM_FLOAT
#define FOLDER "build/test-io-f32"
#else
#define FOLDER "build/test-io"
#endif

/* The checks as functions: an argument that writes a file is then evaluated once. */
static void equal(const char *what, long got, long wanted) { CHECK_EQUAL(what, got, wanted); }
static void holds(const char *what, int condition) { CHECK_TRUE(what, condition); }

/* ---- reading back ---------------------------------------------------------------------------- */

/* The whole of a file in fresh memory, with a zero behind; NULL when it is not there. */
static unsigned char *slurp(const char *path, size_t *n)
{
    FILE *in = fopen(path, "rb");
    unsigned char *data;
    size_t room = (size_t)1 << 24;
    *n = 0;
    if (!in) return NULL;
    data = (unsigned char *)malloc(room);
    if (data) {
        *n = fread(data, 1, room - 1, in);
        data[*n] = 0;
    }
    fclose(in);
    return data;
}

static int exists(const char *path)
{
    FILE *in = fopen(path, "rb");
    if (in) fclose(in);
    return in != NULL;
}

static int contains(const char *path, const char *text)
{
    size_t n;
    unsigned char *data = slurp(path, &n);
    int found = data && strstr((const char *)data, text) != NULL;
    free(data);
    return found;
}

static int file_is(const char *path, const char *text)
{
    size_t n;
    unsigned char *data = slurp(path, &n);
    int same = data && n == strlen(text) && memcmp(data, text, n) == 0;
    free(data);
    return same;
}

static void write_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "wb");
    if (!out) return;
    fputs(text, out);
    fclose(out);
}

static uint32_t random_state = 12345;
static uint32_t random_next(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return random_state >> 8;
}

/* ---- an inflate and a PNG reader that share nothing with the writer ------------------------- */

typedef struct inflater {
    const unsigned char *in;
    size_t n, bit;
} inflater;

static unsigned take(inflater *z, int count)
{
    unsigned value = 0;
    int k;
    for (k = 0; k < count; k++, z->bit++)
        if (z->bit / 8 < z->n) value |= (unsigned)(z->in[z->bit / 8] >> z->bit % 8 & 1) << k;
    return value;
}

/* Decodes one symbol by comparing with the codes of each length in turn. */
static int symbol(inflater *z, const unsigned char *length, int n)
{
    int code = 0, first = 0, bits, i;
    for (bits = 1; bits < 16; bits++) {
        int count = 0, seen = 0;
        code = code << 1 | (int)take(z, 1);
        first <<= 1;
        for (i = 0; i < n; i++) count += length[i] == bits;
        if (code - first < count) {
            for (i = 0; i < n; i++)
                if (length[i] == bits && seen++ == code - first) return i;
        }
        first += count;
    }
    return -1;
}

static void read_trees(inflater *z, unsigned char *literal, unsigned char *distance)
{
    static const int order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    unsigned char meta[19] = {0}, all[320] = {0};
    int literals = (int)take(z, 5) + 257, distances = (int)take(z, 5) + 1, i = 0;
    int metas = (int)take(z, 4) + 4;
    for (i = 0; i < metas; i++) meta[order[i]] = (unsigned char)take(z, 3);
    for (i = 0; i < literals + distances;) {
        int s = symbol(z, meta, 19), times = 1;
        unsigned char value = (unsigned char)s;
        if (s < 0) return;
        if (s == 16) {
            value = i > 0 ? all[i - 1] : 0;
            times = 3 + (int)take(z, 2);
        } else if (s > 16) {
            value = 0;
            times = s == 17 ? 3 + (int)take(z, 3) : 11 + (int)take(z, 7);
        }
        while (times-- > 0 && i < 320) all[i++] = value;
    }
    memcpy(literal, all, (size_t)literals);
    memcpy(distance, all + literals, (size_t)distances);
}

/* Inflates raw deflate data into out[room]; returns the length, or room + 1 on any error. */
static size_t inflate_all(inflater *z, unsigned char *out, size_t room)
{
    static unsigned char literal[288], distance[32];
    size_t n = 0;
    int last = 0, i;
    while (!last) {
        int kind;
        last = (int)take(z, 1);
        kind = (int)take(z, 2);
        if (kind == 0 || kind == 3) return room + 1; /* our writer makes neither */
        memset(literal, 0, sizeof literal);
        memset(distance, 0, sizeof distance);
        if (kind == 2) read_trees(z, literal, distance);
        else {
            for (i = 0; i < 288; i++) literal[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
            for (i = 0; i < 30; i++) distance[i] = 5;
        }
        for (;;) {
            int s = symbol(z, literal, 288);
            size_t length = 3, back = 1;
            if (s < 0 || z->bit / 8 > z->n) return room + 1;
            if (s == 256) break;
            if (s < 256) {
                if (n == room) return room + 1;
                out[n++] = (unsigned char)s;
                continue;
            }
            for (i = 257; i < s; i++) length += (size_t)1 << (i < 265 ? 0 : (i - 261) / 4);
            if (s == 285) length = 258;
            else length += take(z, s < 265 ? 0 : (s - 261) / 4);
            s = symbol(z, distance, 30);
            if (s < 0) return room + 1;
            for (i = 0; i < s; i++) back += (size_t)1 << (i < 4 ? 0 : (i - 2) / 2);
            back += take(z, s < 4 ? 0 : (s - 2) / 2);
            if (back > n || n + length > room) return room + 1;
            while (length-- > 0) {
                out[n] = out[n - back];
                n++;
            }
        }
    }
    return n;
}

static uint32_t crc_bitwise(const unsigned char *p, size_t n)
{
    uint32_t crc = 0xffffffffu;
    int k;
    while (n--)
        for (crc ^= *p++, k = 0; k < 8; k++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    return ~crc;
}

static uint32_t big(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static void unfilter(unsigned char *raw, int width, int height)
{
    size_t n = 3 * (size_t)width, i;
    int y;
    for (y = 0; y < height; y++) {
        unsigned char *row = raw + (size_t)y * (n + 1) + 1, *up = y > 0 ? row - n - 1 : NULL;
        for (i = 0; i < n; i++) {
            int a = i >= 3 ? row[i - 3] : 0, b = up ? up[i] : 0, c = up && i >= 3 ? up[i - 3] : 0;
            int p = a + b - c, pa = abs(p - a), pb = abs(p - b), pc = abs(p - c), guess = 0;
            if (row[-1] == 1) guess = a;
            if (row[-1] == 2) guess = b;
            if (row[-1] == 3) guess = (a + b) / 2;
            if (row[-1] == 4) guess = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
            row[i] = (unsigned char)(row[i] + guess);
        }
    }
    for (y = 0; y < height; y++) memmove(raw + (size_t)y * n, raw + (size_t)y * (n + 1) + 1, n);
}

/* Reads a PNG, checking every chunk; returns its 8-bit RGB pixels or NULL. */
static unsigned char *read_png(const char *path, int *width, int *height)
{
    size_t n, at = 8, packed = 0, raw;
    unsigned char *file = slurp(path, &n), *data, *out = NULL;
    inflater z;
    int good = file && n > 57 && memcmp(file, "\x89PNG\r\n\x1a\n", 8) == 0, ended = 0;
    data = (unsigned char *)malloc(n + 1);
    while (good && data && !ended) {
        size_t length = big(file + at);
        good = at + length + 12 <= n &&
               crc_bitwise(file + at + 4, length + 4) == big(file + at + 8 + length);
        if (!good) break;
        if (memcmp(file + at + 4, "IDAT", 4) == 0) {
            memcpy(data + packed, file + at + 8, length);
            packed += length;
        }
        ended = memcmp(file + at + 4, "IEND", 4) == 0;
        at += length + 12;
        if (!ended && at + 12 > n) good = 0;
    }
    good = good && at == n && memcmp(file + 12, "IHDR", 4) == 0;
    good =
        good && file[24] == 8 && file[25] == 2 && file[26] == 0 && file[27] == 0 && file[28] == 0;
    if (good) {
        *width = (int)big(file + 16);
        *height = (int)big(file + 20);
        raw = (3 * (size_t)*width + 1) * (size_t)*height;
        out = (unsigned char *)malloc(raw);
        z.in = data + 2;
        z.n = packed - 6;
        z.bit = 0;
        good = out && (data[0] * 256 + data[1]) % 31 == 0 && inflate_all(&z, out, raw) == raw &&
               (z.bit + 7) / 8 == z.n && mpm__io_adler(1, out, raw) == big(data + packed - 4);
        if (good) unfilter(out, *width, *height);
    }
    free(file);
    free(data);
    if (good) return out;
    free(out);
    return NULL;
}

static int png_matches(const char *path, const mpm_io_canvas *c)
{
    int width = 0, height = 0, same;
    unsigned char *rgb = read_png(path, &width, &height);
    same = rgb && width == c->width && height == c->height &&
           memcmp(rgb, c->rgb, 3 * (size_t)width * (size_t)height) == 0;
    free(rgb);
    return same;
}

/* ---- messages and numbers ------------------------------------------------------------------ */

static void test_messages(void)
{
    char text[160];
    mpm_fault f = {MPM_ERR_ARGUMENT, "spacing", MPM_R(-0.5), 12};
    mpm_io_progress p = {1200, 0, 9900, 9.7, "ns", 5900, 5.9};
    holds("status text", strcmp(mpm_io_status_text(MPM_OK), "done") == 0);
    holds("unknown status", strcmp(mpm_io_status_text((mpm_status)99), "unknown status") == 0);
    mpm_io_fault_text(text, sizeof text, &f);
    holds("fault text", strcmp(text, "an argument is out of its valid range: spacing = -0.5 "
                                          "(index 12)") == 0);
    equal("fault text is cut to fit", (long)mpm_io_fault_text(text, 8, &f), 7);
    holds("... and terminated", strcmp(text, "an argu") == 0);
    equal("no room at all", (long)mpm_io_fault_text(text, 0, &f), 0);
    mpm_io_progress_text(text, sizeof text, &p);
    holds("progress",
          strcmp(text, "step 1200/9900  12 %  t = 9.7 ns  1.2e6 points/s  left 0:43") == 0);
    p.steps = 2400000;
    mpm_io_progress_text(text, sizeof text, &p);
    holds("progress, hours", strstr(text, "left 3:16:34") != NULL);
    p.step = 0;
    mpm_io_progress_text(text, sizeof text, &p);
    holds("progress before the first step", strcmp(text, "step 0/2400000  0 %  t = 9.7 ns") == 0);
}

static void test_numbers(void)
{
    static const double values[] = {0.1,      1.0 / 3,  -2.5e-300, 1.7976931348623157e308,
                                    4.9e-324, 123456789};
    static const char *const comma[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8",
                                        "fr_FR.utf8", "German"};
    char text[40];
    size_t i;
    int bad = 0, point = 1;
    for (i = 0; i < sizeof values / sizeof values[0]; i++) {
        mpm_io_number_text(text, sizeof text, values[i]);
        if (!(strtod(text, NULL) <= values[i] && strtod(text, NULL) >= values[i])) bad++;
    }
    equal("numbers that do not come back", bad, 0);
    mpm_io_number_text(text, sizeof text, 0.1);
    holds("0.1 is short", strcmp(text, "0.1") == 0);
    mpm_io_number_text(text, sizeof text, -INFINITY);
    holds("infinity", strcmp(text, "-inf") == 0);
    mpm_io_number_text(text, sizeof text, NAN);
    holds("not a number", strcmp(text, "nan") == 0);
    strcpy(text, "-1,25e-07");
    mpm__io_decimal_point(text);
    holds("comma to point", strcmp(text, "-1.25e-07") == 0);
    strcpy(text, "3\xd9\xab" "5");
    mpm__io_decimal_point(text);
    holds("separator of two bytes to point", strcmp(text, "3.5") == 0);
    strcpy(text, "12e+20");
    mpm__io_decimal_point(text);
    holds("no separator, no change", strcmp(text, "12e+20") == 0);
    for (i = 0; i < sizeof comma / sizeof comma[0] && point; i++)
        if (setlocale(LC_NUMERIC, comma[i])) {
            mpm_io_number_text(text, sizeof text, 0.1);
            point = strcmp(text, "0.1") == 0;
        }
    setlocale(LC_NUMERIC, "C");
    holds("a point under every locale there is", point);
}

/* ---- folders and failures ------------------------------------------------------------------ */

static void test_folders(void)
{
    mpm_fault f;
    equal("folder made", mpm_io_make_directory(FOLDER "/a/b/c", NULL), MPM_OK);
    equal("folder there already", mpm_io_make_directory(FOLDER "/a/b/", NULL), MPM_OK);
    write_text(FOLDER "/a/file", "x");
    equal("file in the way", mpm_io_make_directory(FOLDER "/a/file/d", &f), MPM_ERR_FILE);
    holds("fault names it", strcmp(f.field, "folder path") == 0 && f.status == MPM_ERR_FILE);
    equal("empty path", mpm_io_make_directory("", &f), MPM_ERR_ARGUMENT);
}

static void test_failures(void)
{
    static char lengthy[MPM_IO_PATH + 10];
    mpm_io_csv t;
    mpm_io_json j;
    mpm_io_canvas c;
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_fault f;
    const char *nowhere = FOLDER "/missing/file";
    memset(lengthy, 'a', sizeof lengthy - 1);
    mpm_io_canvas_init(&c, 4, 4, NULL, 0);
    equal("csv nowhere", mpm_io_csv_begin(&t, nowhere, "a", NULL, &f), MPM_ERR_FILE);
    holds("fault is about the path", strncmp(f.field, "path", 4) == 0);
    mpm_io_csv_integer(&t, 1);
    equal("csv: the error sticks", mpm_io_csv_end(&t, &f), MPM_ERR_FILE);
    equal("json nowhere", mpm_io_json_begin(&j, nowhere, &f), MPM_ERR_FILE);
    mpm_io_json_number(&j, "a", 1);
    equal("json: the error sticks", mpm_io_json_end(&j, &f), MPM_ERR_FILE);
    equal("vtu nowhere", mpm_io_vtu(nowhere, &d, &f), MPM_ERR_FILE);
    equal("pvd nowhere", mpm_io_pvd_add(nowhere, "x.vtu", 0, &f), MPM_ERR_FILE);
    equal("png nowhere", mpm_io_png(nowhere, &c, NULL, &f), MPM_ERR_FILE);
    equal("checkpoint nowhere", mpm_io_checkpoint_write(nowhere, NULL, 0, &f), MPM_ERR_FILE);
    holds("nothing is left", !exists(nowhere) && !exists(FOLDER "/missing/file.part"));
    equal("path too long", mpm_io_png(lengthy, &c, NULL, &f), MPM_ERR_ARGUMENT);

    mpm_io_make_directory(FOLDER "/taken", NULL); /* a folder has the name: renaming must fail */
    equal("name taken by a folder", mpm_io_png(FOLDER "/taken", &c, NULL, &f), MPM_ERR_FILE);
    holds("its .part is removed", !exists(FOLDER "/taken.part"));
    mpm_io_canvas_free(&c);

    write_text(FOLDER "/keep.csv", "precious");
    mpm_io_csv_begin(&t, FOLDER "/keep.csv", "a,b", NULL, NULL);
    mpm_io_csv_integer(&t, 1);
    holds("untouched while writing", file_is(FOLDER "/keep.csv", "precious"));
    equal("half a row", mpm_io_csv_end(&t, &f), MPM_ERR_ARGUMENT);
    holds("untouched after failing", file_is(FOLDER "/keep.csv", "precious"));
    holds("no .part stays", !exists(FOLDER "/keep.csv.part"));
    mpm_io_csv_begin(&t, FOLDER "/keep.csv", "a,b", NULL, NULL);
    mpm_io_csv_integer(&t, 1);
    holds("a table being written", exists(FOLDER "/keep.csv.part"));
    mpm_io_csv_drop(&t);
    holds("dropped: untouched", file_is(FOLDER "/keep.csv", "precious"));
    holds("dropped: no .part stays", !exists(FOLDER "/keep.csv.part"));
    mpm_io_csv_begin(&t, nowhere, "a", NULL, NULL);
    mpm_io_csv_drop(&t); /* one that could not be begun */
    holds("dropped: nothing is left", !exists(nowhere));
#ifdef __linux__
    if (system("ln -sf /dev/full " FOLDER "/keep.csv.part") == 0) { /* a disc without room */
        mpm_io_csv_begin(&t, FOLDER "/keep.csv", "a", NULL, NULL);
        mpm_io_csv_integer(&t, 1);
        equal("disc full", mpm_io_csv_end(&t, &f), MPM_ERR_FILE);
        holds("untouched on a full disc", file_is(FOLDER "/keep.csv", "precious"));
        holds("no .part on a full disc", !exists(FOLDER "/keep.csv.part"));
    }
#endif
}

/* ---- JSON and CSV -------------------------------------------------------------------------- */

/* The number behind a key of a JSON file. */
static double json_value(const char *path, const char *key)
{
    size_t n;
    unsigned char *data = slurp(path, &n);
    char quoted[64];
    const char *found;
    double value = NAN;
    snprintf(quoted, sizeof quoted, "\"%s\": ", key);
    found = data ? strstr((const char *)data, quoted) : NULL;
    if (found) value = strtod(found + strlen(quoted), NULL);
    free(data);
    return value;
}

static void test_json(void)
{
    const char *path = FOLDER "/summary.json";
    mpm_io_json j;
    mpm_fault f;
    double third = 1.0 / 3;
    mpm_real real = (mpm_real)third;
    equal("json begins", mpm_io_json_begin(&j, path, &f), MPM_OK);
    mpm_io_json_number(&j, "third", third);
    mpm_io_json_real(&j, "real", real);
    mpm_io_json_number(&j, "nothing", NAN);
    mpm_io_json_integer(&j, "steps", -9007199254740993LL);
    mpm_io_json_bool(&j, "bonded", 1);
    mpm_io_json_string(&j, "name", "a \"b\" \\ \n \xc2\xb5m");
    mpm_io_json_open(&j, "options");
    mpm_io_json_number(&j, "speed", 810.0);
    mpm_io_json_close(&j);
    mpm_io_json_open(&j, "empty");
    mpm_io_json_close(&j);
    mpm_io_json_string(&j, "last", NULL);
    equal("json ends", mpm_io_json_end(&j, &f), MPM_OK);
    holds("double comes back",
          json_value(path, "third") >= third && json_value(path, "third") <= third);
    holds("real comes back",
          (mpm_real)json_value(path, "real") >= real && (mpm_real)json_value(path, "real") <= real);
    holds("text", contains(path, "  \"nothing\": null,\n  \"steps\": -9007199254740993,\n"
                                      "  \"bonded\": true,\n"
                                      "  \"name\": \"a \\\"b\\\" \\\\ \\u000a \xc2\xb5m\",\n"
                                      "  \"options\": {\n    \"speed\": 810\n  },\n"
                                      "  \"empty\": {},\n  \"last\": null\n}\n"));
    holds("version first", contains(path, "{\n  \"mpm_version\": \"" MPM_VERSION "\",\n"));
    mpm_io_json_begin(&j, FOLDER "/open.json", &f);
    mpm_io_json_open(&j, "left open");
    equal("an open object", mpm_io_json_end(&j, &f), MPM_ERR_ARGUMENT);
    holds("... makes no file", !exists(FOLDER "/open.json") && !exists(FOLDER "/open.json.part"));
}

static void test_csv(void)
{
    const char *path = FOLDER "/table.csv";
    mpm_io_csv t;
    mpm_real row[2] = {MPM_R(0.1), MPM_R(-3.0)};
    equal("csv begins", mpm_io_csv_begin(&t, path, "a,b", "why\nso", NULL), MPM_OK);
    equal("columns", t.columns, 2);
    mpm_io_csv_row(&t, row);
    mpm_io_csv_integer(&t, 7);
    mpm_io_csv_text(&t, "a,\"b\"");
    mpm_io_csv_real(&t, (mpm_real)NAN);
    mpm_io_csv_text(&t, "plain");
    equal("csv ends", mpm_io_csv_end(&t, NULL), MPM_OK);
    holds("csv text", file_is(path, "# mpm.h " MPM_VERSION ": why so\na,b\n0.1,-3\n"
                                         "7,\"a,\"\"b\"\"\"\nnan,plain\n"));
}

/* ---- ParaView ------------------------------------------------------------------------------ */

enum { POINTS = 37 };
static mpm_real field_data[9][POINTS];

/* The appended array of a given name: its bytes and their number, as the tag's offset says. */
static const unsigned char *vtu_array(const unsigned char *file, size_t n, const char *name,
                                      const char *type, uint64_t *bytes)
{
    char tag[96];
    const char *text = (const char *)file, *found, *offset;
    size_t start = 0;
    while (start + 22 < n && memcmp(text + start, "encoding=\"raw\">\n_", 17) != 0) start++;
    start += 17;
    snprintf(tag, sizeof tag, "type=\"%s\" Name=\"%s\"", type, name);
    found = strstr(text, tag);
    offset = found ? strstr(found, "offset=\"") : NULL;
    *bytes = 0;
    if (!offset) return NULL;
    start += strtoul(offset + 8, NULL, 10);
    if (start + 8 > n) return NULL;
    memcpy(bytes, file + start, 8);
    return start + 8 + *bytes <= n ? file + start + 8 : NULL;
}

static void test_vtu(void)
{
    static const int vtk_order[6] = {0, 1, 2, 5, 3, 4};
    const char *path = FOLDER "/points.vtu", *type = sizeof(mpm_real) == 4 ? "Float32" : "Float64";
    static uint8_t flags[POINTS];
    static int32_t ids[POINTS];
    mpm_io_field fields[5];
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_fault f;
    const unsigned char *a;
    unsigned char *file;
    uint64_t bytes;
    size_t n;
    int i, k, bad = 0;
    for (i = 0; i < POINTS; i++) {
        for (k = 0; k < 9; k++) field_data[k][i] = (mpm_real)random_next() / MPM_R(777.0);
        flags[i] = (uint8_t)random_next();
        ids[i] = (int32_t)random_next() - 1000000;
    }
    fields[0] = mpm_io_scalar("temperature", field_data[3], 1);
    fields[1] = mpm_io_vector("velocity <m/s>", field_data[0], field_data[1], field_data[2], 2);
    fields[2] = mpm_io_tensor("stress", field_data[3], field_data[4], field_data[5], field_data[6],
                              field_data[7], field_data[8], 1);
    fields[3] = mpm_io_uint8("flags", flags);
    fields[4] = mpm_io_int32("id", ids);
    d.count = POINTS;
    for (k = 0; k < 3; k++) d.x[k] = field_data[k];
    d.fields = fields;
    d.field_count = 5;
    d.time = 0.1;
    d.note = "a -- b";
    equal("vtu written", mpm_io_vtu(path, &d, &f), MPM_OK);
    file = slurp(path, &n);
    a = vtu_array(file, n, "Points", type, &bytes);
    equal("bytes of points", (long)bytes, (long)(3 * POINTS * sizeof(mpm_real)));
    for (i = 0; a && i < 3 * POINTS; i++)
        bad += memcmp(a + (size_t)i * sizeof(mpm_real), &field_data[i % 3][i / 3],
                      sizeof(mpm_real)) != 0;
    a = vtu_array(file, n, "stress", type, &bytes);
    for (i = 0; a && i < 6 * POINTS; i++)
        bad += memcmp(a + (size_t)i * sizeof(mpm_real), &field_data[3 + vtk_order[i % 6]][i / 6],
                      sizeof(mpm_real)) != 0;
    holds("tensor there", a != NULL);
    a = vtu_array(file, n, "velocity &lt;m/s&gt;", type, &bytes);
    for (i = 0; a && i < 3 * POINTS; i++) {
        mpm_real twice = 2 * field_data[i % 3][i / 3];
        bad += memcmp(a + (size_t)i * sizeof(mpm_real), &twice, sizeof(mpm_real)) != 0;
    }
    holds("vector there, name escaped", a != NULL);
    a = vtu_array(file, n, "flags", "UInt8", &bytes);
    bad += !a || bytes != POINTS || memcmp(a, flags, POINTS) != 0;
    a = vtu_array(file, n, "id", "Int32", &bytes);
    bad += !a || bytes != sizeof ids || memcmp(a, ids, sizeof ids) != 0;
    holds("data end where the file goes on",
               a && memcmp(a + sizeof ids, "\n  </AppendedData>", 18) == 0);
    a = vtu_array(file, n, "offsets", "Int32", &bytes);
    for (i = 0; a && i < POINTS; i++) {
        int32_t want = i + 1;
        bad += memcmp(a + 4 * i, &want, 4) != 0;
    }
    a = vtu_array(file, n, "types", "UInt8", &bytes);
    for (i = 0; a && i < POINTS; i++) bad += a[i] != 1;
    equal("values that differ", bad, 0);
    holds("time", contains(path, "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.1<"));
    holds("comment stays one", contains(path, "<!-- mpm.h " MPM_VERSION " a - - b -->"));
    free(file);
    d.float32 = 1;
    mpm_io_vtu(path, &d, &f);
    file = slurp(path, &n);
    a = vtu_array(file, n, "temperature", "Float32", &bytes);
    for (i = 0, bad = 0; a && i < POINTS; i++) {
        float small = (float)field_data[3][i];
        bad += memcmp(a + 4 * i, &small, 4) != 0;
    }
    equal("float32 values that differ", a ? bad : -1, 0);
    free(file);
    fields[2].data[4] = NULL;
    equal("missing component", mpm_io_vtu(path, &d, &f), MPM_ERR_ARGUMENT);
    holds("fault names it", strcmp(f.field, "data of field") == 0 && f.index == 2);
    d.count = 0;
    equal("no points", mpm_io_vtu(FOLDER "/empty.vtu", &d, &f), MPM_OK);
}

static void test_pvd(void)
{
    const char *path = FOLDER "/series.pvd";
    mpm_fault f;
    equal("pvd begins", mpm_io_pvd_begin(path, &f), MPM_OK);
    equal("first frame", mpm_io_pvd_add(path, "f-000.vtu", 0, &f), MPM_OK);
    equal("second frame", mpm_io_pvd_add(path, "f-001.vtu", 0.5, &f), MPM_OK);
    equal("second frame again", mpm_io_pvd_add(path, "f-001.vtu", 0.25, &f), MPM_OK);
    holds("the series",
          contains(path, "<Collection>\n"
                         "    <DataSet timestep=\"0\" part=\"0\" file=\"f-000.vtu\"/>\n"
                         "    <DataSet timestep=\"0.25\" part=\"0\" file=\"f-001.vtu\"/>\n"
                         "  </Collection>\n</VTKFile>\n"));
    remove(FOLDER "/fresh.pvd");
    equal("a missing one is begun", mpm_io_pvd_add(FOLDER "/fresh.pvd", "x.vtu", 1, &f), MPM_OK);
    write_text(FOLDER "/other.pvd", "<VTKFile>\n");
    equal("a foreign one is refused", mpm_io_pvd_add(FOLDER "/other.pvd", "x.vtu", 1, &f),
          MPM_ERR_FILE);
    holds("... and kept", file_is(FOLDER "/other.pvd", "<VTKFile>\n"));
    equal("a name that is no name", mpm_io_pvd_add(path, "a\"b", 1, &f), MPM_ERR_ARGUMENT);
}

/* ---- checkpoints --------------------------------------------------------------------------- */

static void write_bytes(const char *path, const unsigned char *data, size_t n)
{
    FILE *out = fopen(path, "wb");
    if (!out) return;
    fwrite(data, 1, n, out);
    fclose(out);
}

static void test_checkpoint(void)
{
    const char *path = FOLDER "/state.mpm", *damaged = FOLDER "/damaged.mpm";
    mpm_real a[50], back[50];
    int32_t steps = 42, steps_back = 0;
    mpm_io_blob out[3], in[3];
    mpm_fault f;
    unsigned char *file;
    size_t n, i, undetected = 0, changed = 0;
    for (i = 0; i < 50; i++) a[i] = (mpm_real)random_next() / MPM_R(3.0);
    memset(back, 0, sizeof back);
    out[0] = mpm__io_blob("a", a, sizeof a);
    out[1] = mpm__io_blob("steps", &steps, sizeof steps);
    out[2] = mpm__io_blob("nothing", NULL, 0);
    in[0] = mpm__io_blob("a", back, sizeof back);
    in[1] = mpm__io_blob("steps", &steps_back, sizeof steps_back);
    in[2] = out[2];
    equal("checkpoint written", mpm_io_checkpoint_write(path, out, 3, &f), MPM_OK);
    equal("checkpoint read", mpm_io_checkpoint_read(path, in, 3, &f), MPM_OK);
    holds("same bits", memcmp(a, back, sizeof a) == 0 && steps_back == 42);

    memset(back, 0, sizeof back);
    file = slurp(path, &n);
    for (i = 0; i < n; i++) { /* one bit flipped anywhere */
        file[i] ^= 16;
        write_bytes(damaged, file, n);
        undetected += mpm_io_checkpoint_read(damaged, in, 3, &f) >= 0;
        file[i] ^= 16;
    }
    for (i = 0; i < n; i += 7) { /* cut short */
        write_bytes(damaged, file, i);
        undetected += mpm_io_checkpoint_read(damaged, in, 3, &f) >= 0;
    }
    for (i = 0; i < 50; i++) changed += memcmp(&back[i], "\0\0\0\0\0\0\0\0", sizeof back[i]) != 0;
    equal("damage not detected", (long)undetected, 0);
    equal("values changed by a damaged file", (long)changed, 0);
    file[16] ^= 1; /* the version */
    write_bytes(damaged, file, n);
    equal("another version", mpm_io_checkpoint_read(damaged, in, 3, &f), MPM_ERR_VERSION);
    file[16] ^= 1;
    file[36] = file[36] == 8 ? 4 : 8; /* the size of reals, or its high byte */
    write_bytes(damaged, file, n);
    equal("another real type", mpm_io_checkpoint_read(damaged, in, 3, &f), MPM_ERR_VERSION);
    free(file);
    in[0].bytes -= sizeof a[0];
    equal("another size", mpm_io_checkpoint_read(path, in, 3, &f), MPM_ERR_FILE);
    holds("fault says so", strcmp(f.field, "name or size of blob differs") == 0 && f.index == 0);
    equal("no such file", mpm_io_checkpoint_read(FOLDER "/none", in, 3, &f), MPM_ERR_FILE);
}

/* ---- a world: restart and cut --------------------------------------------------------------- */

/* A linear elastic response, stress += E strain: enough to make the points interact. */
static mpm_status elastic(const void *material, const mpm_block *b)
{
    mpm_real young = *(const mpm_real *)material;
    int p, k;
    for (k = 0; k < 6; k++)
        for (p = 0; p < b->count; p++) b->stress[k][p] += young * b->strain[k][p];
    return MPM_OK;
}

static mpm_real young = 1000;

static mpm_status make_world(mpm_world *w)
{
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_status status;
    d.cell = MPM_R(0.1);
    d.cells[0] = d.cells[1] = d.cells[2] = 12;
    d.points = 2600;
    d.bodies = 2;
    status = mpm_init(w, &d, NULL, 0);
    b.spacing = MPM_R(0.05);
    b.density = 1;
    b.stress = elastic;
    b.material = &young;
    b.shape = mpm_box(MPM_R(0.4), MPM_R(0.4), MPM_R(0.61), MPM_R(0.8), MPM_R(0.8), MPM_R(0.9));
    b.velocity[0] = 3;
    b.velocity[2] = -10;
    if (status >= 0) status = mpm_body_add(w, &b);
    b.shape = mpm_box(MPM_R(0.2), MPM_R(0.2), MPM_R(0.2), MPM_R(1.0), MPM_R(1.0), MPM_R(0.6));
    b.velocity[0] = b.velocity[2] = 0;
    if (status >= 0) status = mpm_body_add(w, &b);
    return status;
}

static int run(mpm_world *w, int steps)
{
    while (steps-- > 0)
        if (mpm_step(w, MPM_R(0.0005)) < 0) return 0;
    return 1;
}

static void test_restart(void)
{
    static int32_t numbers[4000];
    mpm_world whole, first, second;
    mpm_io_blob blobs[MPM_IO_WORLD_BLOBS + 2];
    mpm_io_cut_desc d;
    mpm_fault f;
    int n;
    equal("a world", make_world(&whole), MPM_OK);
    equal("a second", make_world(&first), MPM_OK);
    equal("a third", make_world(&second), MPM_OK);
    holds("run in one", run(&whole, 60));
    holds("run to half", run(&first, 31));
    n = mpm_io_world_blobs(&first, blobs);
    equal("blobs", n, MPM_IO_WORLD_BLOBS + 2);
    equal("saved", mpm_io_checkpoint_write(FOLDER "/world.mpm", blobs, n, &f), MPM_OK);
    n = mpm_io_world_blobs(&second, blobs);
    equal("loaded", mpm_io_checkpoint_read(FOLDER "/world.mpm", blobs, n, &f), MPM_OK);
    holds("run on", run(&second, 29));
    equal("steps", second.steps, whole.steps);
    holds("bodies have met", whole.ledger.contact > 0);
    holds("same bits in every field",
          memcmp(whole.field, second.field,
                 whole.stride * (size_t)whole.fields * sizeof(mpm_real)) == 0);
    holds("same ledger", memcmp(&whole.ledger, &second.ledger, sizeof whole.ledger) == 0);
    mpm_io_body_numbers(&whole, numbers);
    equal("number of the first point", numbers[0], 0);
    equal("last of the first body", numbers[whole.body[1].first - 1], 0);
    equal("first of the second body", numbers[whole.body[1].first], 1);
    d = mpm_io_cut_of(&whole, whole.points.v[2]);
    d.at = MPM_R(0.6);
    d.label = "velocity";
    equal("picture of a world", mpm_io_cut_png(FOLDER "/world.png", &d, 1, 1, 400, &f), MPM_OK);
    mpm_free(&whole);
    mpm_free(&first);
    mpm_free(&second);
}

/* ---- pictures ------------------------------------------------------------------------------ */

static void test_png(void)
{
    const char *path = FOLDER "/picture.png";
    static unsigned char own[4 * 20 * 10];
    mpm_io_canvas c;
    mpm_fault f;
    size_t n, i;
    int k;
    holds("crc of 123456789", mpm__io_crc(0, "123456789", 9) == 0xcbf43926u);
    holds("adler of Wikipedia",
          mpm__io_adler(1, (const unsigned char *)"Wikipedia", 9) == 0x11e60398u);
    equal("canvas too large", mpm_io_canvas_init(&c, 16385, 1, NULL, 0), MPM_ERR_ARGUMENT);
    equal("canvas without pixels", (long)mpm_io_canvas_bytes(0, 5), 0);
    equal("memory too small", mpm_io_canvas_init(&c, 20, 10, own, sizeof own - 1), MPM_ERR_MEMORY);
    equal("canvas in own memory", mpm_io_canvas_init(&c, 20, 10, own, sizeof own), MPM_OK);
    mpm_io_line(&c, 1, 1, 19, 9, 1.5, 0xff0000);
    equal("small picture", mpm_io_png(path, &c, "a note", &f), MPM_OK);
    holds("small picture comes back", png_matches(path, &c));
    mpm_io_canvas_free(&c);

    mpm_io_canvas_init(&c, 1, 1, NULL, 0);
    mpm_io_png(path, &c, NULL, &f);
    holds("a single pixel comes back", png_matches(path, &c));
    mpm_io_canvas_free(&c);

    mpm_io_canvas_init(&c, 333, 257, NULL, 0);
    for (i = 0; i < (size_t)333 * 257 * 3; i++) c.rgb[i] = (unsigned char)(random_next() >> 12);
    mpm_io_png(path, &c, NULL, &f);
    holds("noise comes back", png_matches(path, &c));
    for (i = 0; i < (size_t)333 * 257 * 3; i++) /* repeats at many distances, rare symbols */
        c.rgb[i] =
            (unsigned char)(random_next() % 50 ? c.rgb[i > 4000 ? i - random_next() % 4000 : 0]
                                               : (random_next() & random_next()));
    mpm_io_png(path, &c, NULL, &f);
    holds("patterns come back", png_matches(path, &c));
    mpm_io_canvas_free(&c);

    mpm_io_canvas_init(&c, 1200, 900, NULL, 0);
    for (k = 0; k < 40; k++)
        mpm_io_disc(&c, 30 * k, 20 * k, 10 + 2 * k, mpm_io_map_color(MPM_IO_DEEP, k / 39.0));
    mpm_io_png(path, &c, NULL, &f);
    holds("large picture comes back", png_matches(path, &c));
    free(slurp(path, &n));
    holds("1200 x 900 of flat areas in under 60 kB", n < 60000);
    mpm_io_canvas_free(&c);
}

static int darkness(const mpm_io_canvas *c, int left, int top, int right, int bottom)
{
    int x, y, n = 0;
    for (y = top; y < bottom; y++)
        for (x = left; x < right; x++) n += mpm_io_pixel(c, x, y) != 0xffffff;
    return n;
}

static void test_drawing(void)
{
    mpm_io_canvas c;
    char every[96];
    double sum = 0;
    int x, y, k;
    mpm_io_canvas_init(&c, 200, 100, NULL, 0);
    mpm_io_rectangle(&c, 10, 20, 30, 5, 0x123456);
    equal("pixels of a rectangle", darkness(&c, 0, 0, 200, 100), 150);
    equal("its colour", mpm_io_pixel(&c, 39, 24), 0x123456);
    equal("beside it", mpm_io_pixel(&c, 40, 24), 0xffffff);
    mpm_io_canvas_fill(&c, 0xffffff);
    mpm_io_disc(&c, 100, 50, 30, 0);
    for (y = 0; y < 100; y++)
        for (x = 0; x < 200; x++) sum += 1 - (mpm_io_pixel(&c, x, y) & 255) / 255.0;
    CHECK_RELATIVE("area of a smooth disc", sum, 3.14159265 * 900, 0.005);
    mpm_io_canvas_fill(&c, 0xffffff);
    mpm_io_disc(&c, -1e30, NAN, 1e30, 0);
    mpm_io_line(&c, -1e9, 50.5, 1e9, 50.5, 1, 0);
    equal("a line far beyond the edges", mpm_io_pixel(&c, 100, 50), 0);
    mpm_io_canvas_fill(&c, 0xffffff);
    for (k = 0; k < 95; k++) every[k] = (char)(32 + k);
    every[95] = 0;
    for (k = 1; k < 95; k++) {
        char one[2] = {0, 0};
        one[0] = every[k];
        mpm_io_canvas_fill(&c, 0xffffff);
        mpm_io_text(&c, 50, 60, 18, MPM_IO_LEFT, 0, one);
        if (darkness(&c, 0, 0, 200, 100) == 0) break;
        if (darkness(&c, 0, 0, 46, 100) > 0 || darkness(&c, 0, 0, 200, 35) > 0) break;
    }
    equal("every character leaves ink in its place", k, 95);
    CHECK_NEAR("micro is one character", mpm_io_text_width(9, "\xc2\xb5"),
               mpm_io_text_width(9, "u"), 1e-9);
    CHECK_NEAR("broken text ends", mpm_io_text_width(9, "\xe2"), mpm_io_text_width(9, "\x80"),
               1e-9);
    mpm_io_canvas_free(&c);
}

/* CIELAB lightness of a colour. */
static double lightness(mpm_io_color color)
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
            mpm_io_map m = (mpm_io_map)map;
            double whole = lightness(mpm_io_map_color(m, 1)) - lightness(mpm_io_map_color(m, 0));
            double step = lightness(mpm_io_map_color(m, k / 20.0)) -
                          lightness(mpm_io_map_color(m, (k - 1) / 20.0));
            double off = fabs(step / whole * 20 - 1);
            if (off > even[map]) even[map] = off;
        }
    CHECK_NEAR("DEEP: steps of lightness, off the mean", even[0], 0, 0.2);
    CHECK_NEAR("HEAT: steps of lightness, off the mean", even[1], 0, 0.2);
    for (k = 0; k <= 10; k++) {
        double off = fabs(lightness(mpm_io_map_color(MPM_IO_DIVERGING, k / 20.0)) -
                          lightness(mpm_io_map_color(MPM_IO_DIVERGING, 1 - k / 20.0)));
        if (off > turn) turn = off;
    }
    CHECK_NEAR("DIVERGING: both sides as light", turn, 0, 3);
    equal("clamped below", mpm_io_map_color(MPM_IO_DEEP, -5), mpm_io_map_color(MPM_IO_DEEP, 0));
    equal("clamped above", mpm_io_map_color(MPM_IO_DEEP, 5), mpm_io_map_color(MPM_IO_DEEP, 1));
    equal("not a number is grey", mpm_io_map_color(MPM_IO_DEEP, NAN), 0x9aa0a6);
}

/* ---- figures ------------------------------------------------------------------------------- */

enum { SIDE = 40 };

/* Two bodies of SIDE x SIDE points for x > 0, one above the other, in two layers along y. */
static mpm_real cut_x[3][4 * SIDE * SIDE], cut_value[4 * SIDE * SIDE];
static int32_t cut_body[4 * SIDE * SIDE];

static mpm_io_cut_desc make_cut(void)
{
    mpm_io_cut_desc d = mpm_io_cut_desc_default();
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
    static const double window[4] = {-50, 50, -50, 50};
    mpm_io_cut_desc d = make_cut(), panels[2];
    mpm_io_canvas c;
    mpm_fault f;
    mpm_io_color low = mpm_io_map_color(MPM_IO_DEEP, 0.25),
                 high = mpm_io_map_color(MPM_IO_DEEP, 0.75);
    size_t n;
    int left;
    memcpy(d.window, window, sizeof window);
    mpm_io_canvas_init(&c, 432, 432, NULL, 0); /* the frame: 400 pixels wide, 4 to a unit */
    equal("cut", mpm_io_cut(&c, mpm_io_tile(&c, 1, 1, 0), &d, &f), MPM_OK);
    equal("upper body at its place", mpm_io_pixel(&c, 216 + 80, 216 - 80), high);
    equal("lower body at its place", mpm_io_pixel(&c, 216 + 80, 216 + 80), low);
    equal("nothing on the other side", mpm_io_pixel(&c, 216 - 80, 216 + 80), 0xffffff);
    equal("nothing outside the bodies", mpm_io_pixel(&c, 216 + 80, 216 - 175), 0xffffff);
    holds("a line between the bodies", mpm_io_pixel(&c, 216 + 80, 216) != low &&
                                                mpm_io_pixel(&c, 216 + 80, 216) != high);
    equal("the surface within a spacing", mpm_io_pixel(&c, 216 + 80, 216 - 164), 0xffffff);
    d.mirror = 1;
    d.style = MPM_IO_NEAREST;
    mpm_io_canvas_fill(&c, 0xffffff);
    equal("mirrored cut", mpm_io_cut(&c, mpm_io_tile(&c, 1, 1, 0), &d, &f), MPM_OK);
    equal("the other half", mpm_io_pixel(&c, 216 - 80, 216 + 80), low);
    for (left = 0;
         left < 216 && mpm_io_pixel(&c, 215 - left, 100) == mpm_io_pixel(&c, 216 + left, 100);)
        left++;
    equal("pixels that mirror each other, up to the frame", left, 199);
    d.at = 5;
    mpm_io_canvas_fill(&c, 0xffffff);
    mpm_io_cut(&c, mpm_io_tile(&c, 1, 1, 0), &d, &f);
    equal("the other layer, clamped", mpm_io_pixel(&c, 216 + 80, 216 + 80),
          mpm_io_map_color(MPM_IO_DEEP, 1));
    d.at = 2.5;
    equal("no points in the slab", mpm_io_cut(&c, mpm_io_tile(&c, 1, 1, 0), &d, &f),
          MPM_ERR_ARGUMENT);
    holds("fault names it", strcmp(f.field, "points in the slab") == 0);
    d.at = 0;
    d.spacing = 0;
    equal("no spacing", mpm_io_cut(&c, mpm_io_tile(&c, 1, 1, 0), &d, &f), MPM_ERR_ARGUMENT);
    holds("fault names it", strcmp(f.field, "spacing") == 0);
    mpm_io_canvas_free(&c);

    panels[0] = make_cut();
    panels[0].mirror = 1;
    panels[0].title = "two bodies";
    panels[0].time = "t = 1 ns";
    panels[0].label = "value";
    panels[0].length_unit = "\xc2\xb5m";
    panels[1] = panels[0];
    panels[1].map = MPM_IO_HEAT;
    panels[1].ticks = 1;
    panels[1].value = NULL;
    equal("picture of two cuts", mpm_io_cut_png(FOLDER "/cut.png", panels, 2, 2, 400, &f), MPM_OK);
    free(slurp(FOLDER "/cut.png", &n));
    holds("... of a decent size", n > 3000 && n < 100000);
    equal("no panels", mpm_io_cut_png(FOLDER "/cut.png", panels, 0, 2, 400, &f), MPM_ERR_ARGUMENT);
}

static void test_ticks(void)
{
    mpm__io_tick ticks[MPM__IO_TICKS];
    CHECK_NEAR("nice 0.28", mpm__io_nice(0.28), 0.2, 1e-12);
    CHECK_NEAR("nice 5", mpm__io_nice(5), 5, 1e-12);
    CHECK_NEAR("nice 999", mpm__io_nice(999), 500, 1e-12);
    equal("ticks of -1 .. 1", mpm__io_ticks(-1, 1, 0, 6, ticks), 5);
    holds("the first", strcmp(ticks[0].text, "-1.0") == 0);
    holds("zero without a sign", strcmp(ticks[2].text, "0.0") == 0);
    mpm__io_ticks(-6, 3, 1, 6, ticks);
    holds("powers of ten", strcmp(ticks[0].text, "10^-6") == 0);
    mpm__io_ticks(0, 3e6, 0, 3, ticks);
    holds("large numbers", strcmp(ticks[1].text, "1e6") == 0);
}

static void test_plots(void)
{
    static mpm_real x[200], y[200], z[200];
    mpm_io_curve curves[2];
    mpm_io_plot_desc p = mpm_io_plot_desc_default();
    mpm_io_scatter_desc s = mpm_io_scatter_desc_default();
    mpm_io_canvas c;
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
    curves[1].mark = MPM_IO_DASHED;
    curves[1].color = 1;
    p.curves = curves;
    p.curve_count = 2;
    p.x_label = "time [\xc2\xb5s]";
    p.y_label = "velocity [m/s]";
    mpm_io_canvas_init(&c, 800, 400, NULL, 0);
    equal("plot", mpm_io_plot(&c, mpm_io_tile(&c, 2, 1, 0), &p, &f), MPM_OK);
    holds("ink in its tile", darkness(&c, 0, 0, 400, 400) > 2000);
    equal("none beyond it", darkness(&c, 400, 0, 800, 400), 0);
    s.count = 200;
    s.x = y;
    s.y = z;
    s.value = x;
    s.label = "time [\xc2\xb5s]";
    s.note = "not equal";
    equal("scatter", mpm_io_scatter(&c, mpm_io_tile(&c, 2, 1, 1), &s, &f), MPM_OK);
    holds("ink in the other tile", darkness(&c, 400, 0, 800, 400) > 2000);
    equal("written", mpm_io_png(FOLDER "/plots.png", &c, NULL, &f), MPM_OK);
    p.log_x = p.log_y = 1;
    equal("logarithmic, where positive", mpm_io_plot(&c, mpm_io_tile(&c, 2, 1, 0), &p, &f), MPM_OK);
    curves[0].count = curves[1].count = 0;
    equal("nothing to plot", mpm_io_plot(&c, mpm_io_tile(&c, 2, 1, 0), &p, &f), MPM_ERR_ARGUMENT);
    s.count = 0;
    equal("nothing to scatter", mpm_io_scatter(&c, mpm_io_tile(&c, 2, 1, 1), &s, &f),
          MPM_ERR_ARGUMENT);
    mpm_io_canvas_free(&c);
}

int main(void)
{
    test_messages();
    test_numbers();
    test_folders();
    test_failures();
    test_json();
    test_csv();
    test_vtu();
    test_pvd();
    test_checkpoint();
    test_restart();
    test_png();
    test_drawing();
    test_colours();
    test_cut();
    test_ticks();
    test_plots();
    return check_end();
}
