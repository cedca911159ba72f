/* 40_io - files: what is written comes back bit for bit through readers of our own,
   and a file that cannot be written leaves no trace. SPDX-License-Identifier: MIT */
#ifdef __linux__
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
/* What mpm_io.h asks of the system goes through these, which see it and can stand in its way. */
static FILE *watched_fopen(const char *path, const char *mode);
static int watched_fsync(int file);
static int watched_rename(const char *from, const char *to);
#define fopen(path, mode) watched_fopen(path, mode)
#define fsync(file) watched_fsync(file)
#define rename(from, to) watched_rename(from, to)
#endif
#define MPM_IMPLEMENTATION
#include "mpm_io.h"
#undef fopen
#undef fsync
#undef rename

#include <locale.h>

#include "check.h"
#include "png.h"
#include "xyz.h"

#ifdef MPM_FLOAT
#define FOLDER "build/test-io-f32"
#else
#define FOLDER "build/test-io"
#endif

/* ---- reading back ---------------------------------------------------------------------------- */

static int contains(const char *path, const char *text)
{
    size_t n;
    unsigned char *data = slurp(path, &n);
    int found = data && strstr((const char *)data, text) != NULL;
    free(data);
    return found;
}

/* The same for bytes with zeros among them. */
static int contains_bytes(const char *path, const char *bytes, size_t length)
{
    size_t n, i;
    unsigned char *data = slurp(path, &n);
    int found = 0;
    for (i = 0; data && i + length <= n && !found; i++) found = memcmp(data + i, bytes, length) == 0;
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

static void write_text(const char *path, const char *text) { write_file(path, text, strlen(text)); }

/* How many entries of a folder end in ".part"; 0 where folders cannot be read. */
static int parts_in(const char *folder)
{
    int n = 0;
#ifdef __linux__
    DIR *d = opendir(folder);
    const struct dirent *e;
    while (d && (e = readdir(d)) != NULL) {
        const size_t length = strlen(e->d_name);
        n += length > 5 && strcmp(e->d_name + length - 5, ".part") == 0;
    }
    if (d) closedir(d);
#else
    (void)folder;
#endif
    return n;
}

static uint32_t random_state = 12345;
static uint32_t random_next(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return random_state >> 8;
}

/* ---- messages and numbers ------------------------------------------------------------------ */

static void test_messages(void)
{
    char text[160];
    mpm_fault f = {MPM_ERR_ARGUMENT, "spacing", MPM_R(-0.5), 12};
    mpm_io_progress p = {1200, 0, 9900, 9.7, "ns", 5900, 5.9};
    CHECK_TRUE("status text", strcmp(mpm_status_text(MPM_OK), "done") == 0);
    CHECK_TRUE("unknown status", strcmp(mpm_status_text((mpm_status)99), "unknown status") == 0);
    mpm_io_fault_text(text, sizeof text, &f);
    CHECK_TRUE("fault text", strcmp(text, "an argument is out of its valid range: spacing = -0.5 "
                                          "(index 12)") == 0);
    CHECK_EQUAL("fault text is cut to fit", (long)mpm_io_fault_text(text, 8, &f), 7);
    CHECK_TRUE("... and terminated", strcmp(text, "an argu") == 0);
    CHECK_EQUAL("no room at all", (long)mpm_io_fault_text(text, 0, &f), 0);
    f.index = INT64_C(5000000000);
    mpm_io_fault_text(text, sizeof text, &f);
    CHECK_TRUE("a number beyond 32 bits", strstr(text, "(index 5000000000)") != NULL);
    mpm_io_progress_text(text, sizeof text, &p);
    CHECK_TRUE("progress",
               strcmp(text, "step 1200/9900  12 %  t = 9.7 ns  1.2e6 points/s  left 0:43") == 0);
    p.steps = 2400000;
    mpm_io_progress_text(text, sizeof text, &p);
    CHECK_TRUE("progress, hours", strstr(text, "left 3:16:34") != NULL);
    p.step = 0;
    mpm_io_progress_text(text, sizeof text, &p);
    CHECK_TRUE("progress before the first step", strcmp(text, "step 0/2400000  0 %  t = 9.7 ns") == 0);
    p.step = INT64_C(3000000000);
    p.steps = INT64_C(4000000000);
    mpm_io_progress_text(text, sizeof text, &p);
    CHECK_TRUE("progress beyond 32 bits", strncmp(text, "step 3000000000/4000000000  75 %", 32) == 0);
    p.step = 2;
    p.steps = 1;
    p.elapsed = 1e300;
    mpm_io_progress_text(text, sizeof text, &p);
    CHECK_TRUE("progress past the end", strncmp(text, "step 2/1  100 %", 15) == 0 && strstr(text, "left 0:00"));
    p.step = INT64_MAX;
    p.first_step = INT64_MIN;
    mpm_io_progress_text(text, sizeof text, &p);
    CHECK_TRUE("progress of any counts", strstr(text, "/1  100 %") != NULL && strstr(text, "left 0:00") != NULL);
}

static void test_numbers(void)
{
    static const double values[] = {0.1,      1.0 / 3,  -2.5e-300, 1.7976931348623157e308,
                                    4.9e-324, 123456789};
    static const char *const comma[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8",
                                        "fr_FR.utf8", "German"};
    char text[40];
    size_t i;
    int bad = 0, point = 1, locales = 0;
    for (i = 0; i < sizeof values / sizeof values[0]; i++) {
        mpm_io_number_text(text, sizeof text, values[i]);
        if (!(strtod(text, NULL) <= values[i] && strtod(text, NULL) >= values[i])) bad++;
    }
    CHECK_EQUAL("numbers that do not come back", bad, 0);
    mpm_io_number_text(text, sizeof text, 0.1);
    CHECK_TRUE("0.1 is short", strcmp(text, "0.1") == 0);
    mpm_io_number_text(text, sizeof text, -INFINITY);
    CHECK_TRUE("infinity", strcmp(text, "-inf") == 0);
    mpm_io_number_text(text, sizeof text, NAN);
    CHECK_TRUE("not a number", strcmp(text, "nan") == 0);
    strcpy(text, "-1,25e-07");
    mpm_io_decimal_point(text);
    CHECK_TRUE("comma to point", strcmp(text, "-1.25e-07") == 0);
    strcpy(text, "3\xd9\xab" "5");
    mpm_io_decimal_point(text);
    CHECK_TRUE("separator of two bytes to point", strcmp(text, "3.5") == 0);
    strcpy(text, "12e+20");
    mpm_io_decimal_point(text);
    CHECK_TRUE("no separator, no change", strcmp(text, "12e+20") == 0);
    for (i = 0; i < sizeof comma / sizeof comma[0] && point; i++)
        if (setlocale(LC_NUMERIC, comma[i])) {
            mpm_io_number_text(text, sizeof text, 0.1);
            point = strcmp(text, "0.1") == 0;
            locales++;
        }
    setlocale(LC_NUMERIC, "C");
    if (locales) CHECK_TRUE("a point under every locale there is", point);
    else printf("skip - a point under a locale that has a comma: none is installed\n");
}

/* ---- folders and failures ------------------------------------------------------------------ */

static void test_folders(void)
{
    mpm_fault f;
    CHECK_EQUAL("folder made", mpm_io_make_directory(FOLDER "/a/b/c", NULL), MPM_OK);
    CHECK_EQUAL("folder there already", mpm_io_make_directory(FOLDER "/a/b/", NULL), MPM_OK);
    write_text(FOLDER "/a/file", "x");
    CHECK_EQUAL("file in the way", mpm_io_make_directory(FOLDER "/a/file/d", &f), MPM_ERR_FILE);
    CHECK_TRUE("fault names it", strcmp(f.field, "folder path") == 0 && f.status == MPM_ERR_FILE);
    CHECK_EQUAL("empty path", mpm_io_make_directory("", &f), MPM_ERR_ARGUMENT);
}

#ifdef __linux__
/* Letters of a name that part folders or name drives elsewhere; the names a file is made in. */
static void test_names(void)
{
    static const char *const name[] = {"run 12:", "12:30:", "case:/frames", "T=300K:v=800", "odd\\name", "back\\"};
    static char lengthy[3000];
    char path[200];
    mpm_io_csv t;
    int k;
    for (k = 0; k < 6; k++) {
        snprintf(path, sizeof path, FOLDER "/names/%s", name[k]);
        CHECK_EQUAL(path, mpm_io_make_directory(path, NULL), MPM_OK);
        CHECK_TRUE("... is there, by that name", exists(path));
    }
    CHECK_TRUE("nothing else", !exists(FOLDER "/names/odd") && !exists(FOLDER "/names/back"));
    strcpy(lengthy, FOLDER "/names");
    while (strlen(lengthy) < 2900) strcat(lengthy, "/0123456789012345678901234567890123456789");
    CHECK_EQUAL("a folder whose path has 2900 bytes", mpm_io_make_directory(lengthy, NULL), MPM_OK);
    strcat(lengthy, "/impact.json");
    CHECK_EQUAL("... and a file in it", mpm_io_csv_begin(&t, lengthy, "a", NULL, NULL), MPM_OK);
    CHECK_EQUAL("... is written", mpm_io_csv_end(&t, NULL), MPM_OK);
    CHECK_TRUE("... under its whole name", exists(lengthy));
    strcat(lengthy, "2");
    CHECK_TRUE("... and no other", !exists(lengthy));
}

static struct {
    const char *plant; /* command that makes something of a name ending in .part just before a file of it is made */
    int plants;        /* how often still */
    char planted[300], part[300]; /* the last such names: taken first, made */
    int calls, synced, renamed;   /* calls of fsync and rename; which of them was that of the .part file */
    long size;                    /* of the file when it was brought to the disk */
    int refusal;                  /* errno of fsync; 0: none */
} watch;

static FILE *watched_fopen(const char *path, const char *mode)
{
    const size_t n = strlen(path);
    const int part = n > 5 && n < sizeof watch.part && !strcmp(path + n - 5, ".part");
    char command[700];
    FILE *f;
    if (part && watch.plants > 0) {
        watch.plants--;
        strcpy(watch.planted, path);
        snprintf(command, sizeof command, "%s '%s'", watch.plant, path);
        if (system(command)) return NULL;
    }
    f = fopen(path, mode);
    if (part && f) strcpy(watch.part, path);
    return f;
}

static int watched_fsync(int file)
{
    struct stat this_one, part;
    watch.calls++;
    if (fstat(file, &this_one) == 0 && stat(watch.part, &part) == 0 && this_one.st_ino == part.st_ino) {
        watch.synced = watch.calls;
        watch.size = (long)this_one.st_size;
    }
    errno = watch.refusal;
    return watch.refusal ? -1 : fsync(file);
}

static int watched_rename(const char *from, const char *to)
{
    watch.calls++;
    if (!strcmp(from, watch.part)) watch.renamed = watch.calls;
    return rename(from, to);
}

/* A table of one row, whole or not at all. */
static mpm_status one_row(const char *path)
{
    mpm_io_csv t;
    const mpm_status s = mpm_io_csv_begin(&t, path, "a", NULL, NULL);
    if (s < 0) return s;
    mpm_io_csv_integer(&t, 5);
    return mpm_io_csv_end(&t, NULL);
}

/* Something stands at the very name that a file is made under: it is let be, and another name is found. */
static void planted(const char *plant, const char *test)
{
    const char *path = FOLDER "/planted.csv";
    char command[700];
    remove(path);
    remove(FOLDER "/victim");
    memset(&watch, 0, sizeof watch);
    watch.plant = plant;
    watch.plants = 1;
    CHECK_EQUAL(plant, one_row(path), MPM_OK);
    CHECK_TRUE("... stood in the way", watch.planted[0] && strcmp(watch.planted, watch.part));
    CHECK_TRUE("... the row is where it should be", file_is(path, "a\n5\n"));
    CHECK_TRUE("... and nowhere else", !exists(FOLDER "/victim"));
    snprintf(command, sizeof command, "test %s '%s'", test, watch.planted);
    CHECK_EQUAL("... what was planted is still there", system(command), 0);
    remove(watch.planted);
}

/* The name of a file that is not complete, and the way from there to its own. */
static void test_parts(void)
{
    const char *path = FOLDER "/planted.csv";
    planted("ln -s victim", "-L");
    planted("echo mine >", "-s");
    fflush(stdout);
    alarm(20); /* whoever waits for a reader of the FIFO is ended */
    planted("mkfifo", "-p");
    alarm(0);
    memset(&watch, 0, sizeof watch);
    watch.plant = "echo mine >";
    watch.plants = 1000;
    CHECK_EQUAL("each name is taken: no file", one_row(path), MPM_ERR_FILE);
    CHECK_EQUAL("... after 100 of them", 1000 - watch.plants, 100);
    CHECK_EQUAL("... which stay", parts_in(FOLDER), 100);
    CHECK_EQUAL("... until they are swept away", system("rm " FOLDER "/planted.csv.*.part"), 0);

    memset(&watch, 0, sizeof watch);
    CHECK_EQUAL("a file", one_row(path), MPM_OK);
    CHECK_EQUAL("... is brought to the disk first", watch.synced, 1);
    CHECK_EQUAL("... whole", watch.size, 4);
    CHECK_EQUAL("... and then named", watch.renamed, 2);
    write_text(path, "precious");
    memset(&watch, 0, sizeof watch);
    watch.refusal = EIO;
    CHECK_EQUAL("one that the disk does not take", one_row(path), MPM_ERR_FILE);
    CHECK_TRUE("... is not named, nor left", watch.renamed == 0 && parts_in(FOLDER) == 0);
    CHECK_TRUE("... and the one before stays", file_is(path, "precious"));
    watch.refusal = EINVAL;
    CHECK_EQUAL("a file system that knows no such thing", one_row(path), MPM_OK);
    memset(&watch, 0, sizeof watch);
}

/* A disc that is full, descriptors that are used up. */
static void test_hostile(void)
{
    const char *series = FOLDER "/ten.pvd";
    struct rlimit usual, few;
    mpm_io_csv t;
    mpm_fault f;
    int k, status;
    mpm_io_csv_begin(&t, FOLDER "/keep.csv", "a", NULL, NULL);
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &usual);
    few = usual;
    few.rlim_cur = 0;
    setrlimit(RLIMIT_FSIZE, &few);
    mpm_io_csv_integer(&t, 1);
    status = mpm_io_csv_end(&t, &f);
    setrlimit(RLIMIT_FSIZE, &usual);
    CHECK_EQUAL("disc full", status, MPM_ERR_FILE);
    CHECK_TRUE("untouched on a full disc", file_is(FOLDER "/keep.csv", "precious"));
    CHECK_EQUAL("no .part on a full disc", parts_in(FOLDER), 0);

    mpm_io_pvd_begin(series, &f);
    for (k = 0; k < 10; k++) {
        char frame[20];
        snprintf(frame, sizeof frame, "p%d.vtu", k);
        mpm_io_pvd_add(series, frame, k, &f);
    }
    getrlimit(RLIMIT_NOFILE, &usual);
    few = usual;
    for (few.rlim_cur = 3; few.rlim_cur < 6; few.rlim_cur++) { /* none, one, two more files may be open */
        setrlimit(RLIMIT_NOFILE, &few);
        status = mpm_io_pvd_add(series, "last.vtu", 99, &f);
        setrlimit(RLIMIT_NOFILE, &usual);
        CHECK_TRUE("a series is whole whatever can be opened",
                   contains(series, "p0.vtu") && contains(series, "p9.vtu"));
        CHECK_TRUE("... and says whether it took the frame", (status == MPM_OK) == contains(series, "last.vtu"));
    }
    CHECK_EQUAL("no .part of a series", parts_in(FOLDER), 0);
}
#endif

static void test_failures(void)
{
    static char lengthy[6000];
    mpm_io_csv t;
    mpm_io_json j;
    mpm_io_file file;
    const unsigned char c[3] = {0, 0, 0};
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_fault f;
    const char *nowhere = FOLDER "/missing/file";
    memset(lengthy, 'a', sizeof lengthy - 1);
    CHECK_EQUAL("csv nowhere", mpm_io_csv_begin(&t, nowhere, "a", NULL, &f), MPM_ERR_FILE);
    CHECK_TRUE("fault is about the path", strncmp(f.field, "path", 4) == 0);
    mpm_io_csv_integer(&t, 1);
    CHECK_EQUAL("csv: the error sticks", mpm_io_csv_end(&t, &f), MPM_ERR_FILE);
    CHECK_TRUE("... and so does its reason", strcmp(f.field, "path: cannot be made") == 0);
    CHECK_EQUAL("json nowhere", mpm_io_json_begin(&j, nowhere, &f), MPM_ERR_FILE);
    mpm_io_json_number(&j, "a", 1);
    CHECK_EQUAL("json: the error sticks", mpm_io_json_end(&j, &f), MPM_ERR_FILE);
    CHECK_TRUE("... and so does its reason", strcmp(f.field, "path: cannot be made") == 0);
    CHECK_EQUAL("json without a path", mpm_io_json_begin(&j, "", &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... sticks as such", mpm_io_json_end(&j, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... by name", strcmp(f.field, "length of path") == 0);
    CHECK_EQUAL("vtu nowhere", mpm_io_vtu(nowhere, &d, &f), MPM_ERR_FILE);
    CHECK_EQUAL("pvd nowhere", mpm_io_pvd_add(nowhere, "x.vtu", 0, &f), MPM_ERR_FILE);
    CHECK_EQUAL("png nowhere", mpm_io_png(nowhere, c, 1, 1, NULL, &f), MPM_ERR_FILE);
    CHECK_EQUAL("checkpoint nowhere", mpm_io_checkpoint_write(nowhere, NULL, NULL, 0, &f), MPM_ERR_FILE);
    CHECK_TRUE("nothing is left", !exists(nowhere) && !exists(FOLDER "/missing"));
    CHECK_EQUAL("path too long for any system", mpm_io_png(lengthy, c, 1, 1, NULL, &f), MPM_ERR_FILE);

    mpm_io_make_directory(FOLDER "/taken", NULL); /* a folder has the name: renaming must fail */
    CHECK_EQUAL("name taken by a folder", mpm_io_png(FOLDER "/taken", c, 1, 1, NULL, &f), MPM_ERR_FILE);
    CHECK_EQUAL("its .part is removed", parts_in(FOLDER), 0);
    CHECK_TRUE("the folder stays", mpm_io_open(&file, FOLDER "/taken/x", &f) == MPM_OK);
    mpm_io_drop(&file);
    write_text(FOLDER "/old.csv", "old");
    CHECK_EQUAL("a file that was there", mpm_io_open(&file, FOLDER "/old.csv", &f), MPM_OK);
    mpm_io_put(&file, "new");
    CHECK_EQUAL("... is replaced", mpm_io_close(&file, &f), MPM_OK);
    CHECK_TRUE("... as a whole", file_is(FOLDER "/old.csv", "new"));

    write_text(FOLDER "/keep.csv", "precious");
    mpm_io_csv_begin(&t, FOLDER "/keep.csv", "a,b", NULL, NULL);
    mpm_io_csv_integer(&t, 1);
    CHECK_TRUE("untouched while writing", file_is(FOLDER "/keep.csv", "precious"));
    CHECK_EQUAL("half a row", mpm_io_csv_end(&t, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("untouched after failing", file_is(FOLDER "/keep.csv", "precious"));
    CHECK_EQUAL("no .part stays", parts_in(FOLDER), 0);
    mpm_io_csv_begin(&t, FOLDER "/keep.csv", "a,b", NULL, NULL);
    mpm_io_csv_integer(&t, 1);
#ifdef __linux__
    CHECK_EQUAL("a table being written", parts_in(FOLDER), 1);
#endif
    mpm_io_csv_drop(&t);
    CHECK_TRUE("dropped: untouched", file_is(FOLDER "/keep.csv", "precious"));
    CHECK_EQUAL("dropped: no .part stays", parts_in(FOLDER), 0);
    mpm_io_csv_begin(&t, nowhere, "a", NULL, NULL);
    mpm_io_csv_drop(&t); /* one that could not be begun */
    CHECK_TRUE("dropped: nothing is left", !exists(nowhere));
    CHECK_EQUAL("a table without columns", mpm_io_csv_begin(&t, FOLDER "/none.csv", NULL, NULL, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... ends as it began", mpm_io_csv_end(&t, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... for the same reason", strcmp(f.field, "columns") == 0 && !exists(FOLDER "/none.csv"));
}

/* ---- a world ------------------------------------------------------------------------------- */

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
    b.absorb = MPM_FACE_BOTTOM;
    b.wave_p = b.wave_s = mpm_sqrt(young);
    if (status >= 0) status = mpm_body_add(w, &b);
    return status;
}

static int run(mpm_world *w, int steps)
{
    while (steps-- > 0)
        if (mpm_step(w, MPM_R(0.0005)) < 0) return 0;
    return 1;
}

/* ---- a format of one's own ------------------------------------------------------------------- */

/* Every number of a file comes back: those behind the second line of an .xyz. */
static int xyz_differs(const char *path, const mpm_world *w)
{
    const mpm_points *p = &w->points;
    size_t n;
    char *data = (char *)slurp(path, &n), *at = data ? strchr(strchr(data, '\n') + 1, '\n') : NULL;
    int bad = 0, a;
    int32_t i;
    for (i = 0; at && i < p->count; i++) {
        const mpm_real *const column[7] = {p->x[0], p->x[1], p->x[2], p->v[0], p->v[1], p->v[2], p->temperature};
        bad += strtol(at, &at, 10) != p->id[i];
        for (a = 0; a < 7; a++) {
            mpm_real got = (mpm_real)strtod(at, &at);
            bad += memcmp(&got, &column[a][i], sizeof got) != 0;
        }
    }
    bad += !at || strcmp(at, "\n") != 0;
    free(data);
    return bad;
}

static void test_format(void)
{
    const char *path = FOLDER "/points.xyz";
    const unsigned char three[3] = {1, 0, 2};
    mpm_io_file f;
    mpm_world w;
    mpm_fault fault;
    CHECK_EQUAL("a world", make_world(&w), MPM_OK);
    CHECK_TRUE("... that moves", run(&w, 3));
    CHECK_EQUAL("a format of one's own", write_xyz(path, &w, &fault), MPM_OK);
    CHECK_TRUE("... with its first line", contains(path, "2432\nProperties=id:I:1:pos:R:3:velo:R:3:temperature:R:1 "
                                                         "Time=0.0015\n"));
    CHECK_EQUAL("... comes back in every number", xyz_differs(path, &w), 0);
    CHECK_EQUAL("... nowhere", write_xyz(FOLDER "/missing/file", &w, &fault), MPM_ERR_FILE);
    mpm_free(&w);
    CHECK_EQUAL("a file of bytes", mpm_io_open(&f, FOLDER "/bytes", &fault), MPM_OK);
    mpm_io_put_bytes(&f, three, 3);
    mpm_io_put_bytes(&f, NULL, 0);
    mpm_io_put_number(&f, 1.0 / 3);
    CHECK_EQUAL("... is closed", mpm_io_close(&f, &fault), MPM_OK);
    CHECK_TRUE("... and holds them, and a number", contains_bytes(FOLDER "/bytes", "\1\0\2" "0.3333333333333333", 21));
    CHECK_EQUAL("closed again", mpm_io_close(&f, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("the same file again", mpm_io_open(&f, FOLDER "/bytes", &fault), MPM_OK);
    mpm_io_put(&f, "other");
    mpm_io_drop(&f);
    mpm_io_drop(&f); /* harmless */
    CHECK_TRUE("... dropped: as it was", contains_bytes(FOLDER "/bytes", (const char *)three, 3));
    CHECK_EQUAL("... without a .part", parts_in(FOLDER), 0);
}

/* ---- JSON and CSV -------------------------------------------------------------------------- */

static void test_json(void)
{
    const char *path = FOLDER "/summary.json";
    mpm_io_json j;
    mpm_fault f;
    double third = 1.0 / 3;
    int k;
    CHECK_EQUAL("json begins", mpm_io_json_begin(&j, path, &f), MPM_OK);
    mpm_io_json_number(&j, "third", third);
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
    CHECK_EQUAL("json ends", mpm_io_json_end(&j, &f), MPM_OK);
    CHECK_EQUAL("... once", mpm_io_json_end(&j, &f), MPM_ERR_FILE);
    CHECK_TRUE("double comes back",
               number_in(path, "third") >= third && number_in(path, "third") <= third);
    CHECK_TRUE("text", contains(path, "  \"nothing\": null,\n  \"steps\": -9007199254740993,\n"
                                           "  \"bonded\": true,\n"
                                           "  \"name\": \"a \\\"b\\\" \\\\ \\u000a \xc2\xb5m\",\n"
                                           "  \"options\": {\n    \"speed\": 810\n  },\n"
                                           "  \"empty\": {},\n  \"last\": null\n}\n"));
    CHECK_TRUE("version first", contains(path, "{\n  \"mpm_version\": \"" MPM_VERSION "\",\n"));
    mpm_io_json_begin(&j, path, &f);
    for (k = 0; k < 20; k++) mpm_io_json_open(&j, "deep");
    while (k-- > 0) mpm_io_json_close(&j);
    CHECK_EQUAL("twenty objects in each other", mpm_io_json_end(&j, &f), MPM_OK);
    mpm_io_json_begin(&j, FOLDER "/open.json", &f);
    mpm_io_json_open(&j, "left open");
    CHECK_EQUAL("an open object", mpm_io_json_end(&j, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... makes no file", !exists(FOLDER "/open.json") && parts_in(FOLDER) == 0);
    mpm_io_json_begin(&j, path, &f);
    mpm_io_json_string(&j, "k\xe4y", "latin \xe4, cut \xc3, far \xf4\x90\x80\x80, half \xed\xa0\x80, "
                                     "long \xc0\xaf, \x7f\x01");
    mpm_io_json_string(&j, "good", "\xc2\xb5 \xe2\x88\x9a \xf0\x9f\x98\x80");
    CHECK_EQUAL("json of bytes that are no text", mpm_io_json_end(&j, &f), MPM_OK);
    CHECK_TRUE("... is UTF-8", contains(path, "\"k\xef\xbf\xbdy\": \"latin \xef\xbf\xbd, cut \xef\xbf\xbd, "
                                              "far \xef\xbf\xbd"));
    CHECK_TRUE("... and nothing else", !contains(path, "\xed\xa0") && !contains(path, "\xc0\xaf") &&
                                           contains(path, "\x7f\\u0001\"") &&
                                           contains(path, "\"\xc2\xb5 \xe2\x88\x9a \xf0\x9f\x98\x80\""));
}

static void test_csv(void)
{
    const char *path = FOLDER "/table.csv";
    mpm_io_csv t;
    mpm_real row[2] = {MPM_R(0.1), MPM_R(-3.0)};
    CHECK_EQUAL("csv begins", mpm_io_csv_begin(&t, path, "a,b", "why\nso", NULL), MPM_OK);
    CHECK_EQUAL("columns", t.columns, 2);
    mpm_io_csv_row(&t, row);
    mpm_io_csv_integer(&t, 7);
    mpm_io_csv_text(&t, "a,\"b\"");
    mpm_io_csv_real(&t, (mpm_real)NAN);
    mpm_io_csv_text(&t, "plain");
    CHECK_EQUAL("csv ends", mpm_io_csv_end(&t, NULL), MPM_OK);
    CHECK_EQUAL("... once", mpm_io_csv_end(&t, NULL), MPM_ERR_FILE);
    CHECK_TRUE("csv text", file_is(path, "# mpm.h " MPM_VERSION ": why so\na,b\n0.1,-3\n"
                                              "7,\"a,\"\"b\"\"\"\nnan,plain\n"));
}

/* ---- ParaView ------------------------------------------------------------------------------ */

enum { POINTS = 37 };
static mpm_real field_data[9][POINTS];

/* Each point is a cell of its own: cell i holds point i, ends at i + 1, is of VTK's type 1. Returns how many do not. */
static int cells_differ(const unsigned char *file, size_t n)
{
    uint64_t bytes[3];
    const unsigned char *point = vtu_array(file, n, "connectivity", "Int32", &bytes[0]);
    const unsigned char *end = vtu_array(file, n, "offsets", "Int32", &bytes[1]);
    const unsigned char *kind = vtu_array(file, n, "types", "UInt8", &bytes[2]);
    int bad = 0;
    int32_t i, next;
    if (!point || !end || !kind || bytes[0] != 4 * POINTS || bytes[1] != 4 * POINTS || bytes[2] != POINTS) return -1;
    for (i = 0; i < POINTS; i++) {
        next = i + 1;
        bad += memcmp(point + 4 * i, &i, 4) != 0 || memcmp(end + 4 * i, &next, 4) != 0 || kind[i] != 1;
    }
    return bad;
}

/* Lines or triangles between points, of VTK's types 3 and 5, instead of a vertex per point. */
static void test_vtu_cells(mpm_io_vtu_desc d, int points)
{
    static const int32_t cells[9] = {0, 1, 2, 5, 0, 3, 4, 1, 5}, none[3] = {0, POINTS, 1};
    const int32_t ends[3] = {points, 2 * points, 3 * points};
    const size_t all = 3 * (size_t)points * sizeof cells[0];
    const unsigned char kind = points == 2 ? 3 : 5;
    const char *path = FOLDER "/cells.vtu";
    const unsigned char *a;
    unsigned char *file;
    mpm_fault f;
    uint64_t bytes;
    size_t n;
    d.cells = cells;
    d.cell_points = points;
    d.cell_count = 3;
    CHECK_EQUAL("lines or triangles written", mpm_io_vtu(path, &d, &f), MPM_OK);
    CHECK_TRUE("... three cells", contains(path, "NumberOfCells=\"3\""));
    file = slurp(path, &n);
    a = vtu_array(file, n, "connectivity", "Int32", &bytes);
    CHECK_TRUE("... their points", a && bytes == all && memcmp(a, cells, all) == 0);
    a = vtu_array(file, n, "offsets", "Int32", &bytes);
    CHECK_TRUE("... their ends", a && bytes == sizeof ends && memcmp(a, ends, sizeof ends) == 0);
    a = vtu_array(file, n, "types", "UInt8", &bytes);
    CHECK_TRUE("... their type", a && bytes == 3 && a[0] == kind && a[1] == kind && a[2] == kind);
    free(file);
    d.cells = none;
    d.cell_count = 1;
    CHECK_EQUAL("a cell to nowhere", mpm_io_vtu(path, &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", strcmp(f.field, "point of cell") == 0 && f.index == 0);
    d.cell_points = 4;
    CHECK_EQUAL("cells of four", mpm_io_vtu(path, &d, &f), MPM_ERR_ARGUMENT);
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
    fields[0].name = "odd \x02\xe4\xef\xbf\xbf \xc2\xb5 ---";
    CHECK_EQUAL("vtu of bytes that are no text", mpm_io_vtu(path, &d, &f), MPM_OK);
    CHECK_TRUE("... is valid XML", contains(path, "\"odd \xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd \xc2\xb5 - - -\""));
    fields[0].name = "temperature";
    CHECK_EQUAL("vtu written", mpm_io_vtu(path, &d, &f), MPM_OK);
    file = slurp(path, &n);
    a = vtu_array(file, n, "Points", type, &bytes);
    CHECK_EQUAL("bytes of points", bytes, 3 * POINTS * sizeof(mpm_real));
    bad += !a;
    for (i = 0; a && i < 3 * POINTS; i++)
        bad += memcmp(a + (size_t)i * sizeof(mpm_real), &field_data[i % 3][i / 3], sizeof(mpm_real)) != 0;
    a = vtu_array(file, n, "stress", type, &bytes);
    CHECK_TRUE("tensor there", a != NULL);
    for (i = 0; a && i < 6 * POINTS; i++)
        bad += memcmp(a + (size_t)i * sizeof(mpm_real), &field_data[3 + vtk_order[i % 6]][i / 6],
                      sizeof(mpm_real)) != 0;
    a = vtu_array(file, n, "velocity &lt;m/s&gt;", type, &bytes);
    CHECK_TRUE("vector there, name escaped", a != NULL);
    for (i = 0; a && i < 3 * POINTS; i++) {
        mpm_real twice = 2 * field_data[i % 3][i / 3];
        bad += memcmp(a + (size_t)i * sizeof(mpm_real), &twice, sizeof(mpm_real)) != 0;
    }
    a = vtu_array(file, n, "flags", "UInt8", &bytes);
    bad += !a || bytes != POINTS || memcmp(a, flags, POINTS) != 0;
    a = vtu_array(file, n, "id", "Int32", &bytes);
    bad += !a || bytes != sizeof ids || memcmp(a, ids, sizeof ids) != 0;
    CHECK_TRUE("data end where the file goes on", a && memcmp(a + sizeof ids, "\n  </AppendedData>", 18) == 0);
    bad += cells_differ(file, n);
    CHECK_EQUAL("values that differ", bad, 0);
    CHECK_TRUE("time", contains(path, "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.1<"));
    CHECK_TRUE("comment stays one", contains(path, "<!-- mpm.h " MPM_VERSION " a - - b -->"));
    free(file);
    d.float32 = 1;
    mpm_io_vtu(path, &d, &f);
    file = slurp(path, &n);
    a = vtu_array(file, n, "temperature", "Float32", &bytes);
    for (i = 0, bad = 0; a && i < POINTS; i++) {
        float small = (float)field_data[3][i];
        bad += memcmp(a + 4 * i, &small, 4) != 0;
    }
    CHECK_EQUAL("float32 values that differ", a ? bad : -1, 0);
    free(file);
    test_vtu_cells(d, 2);
    test_vtu_cells(d, 3);
    fields[2].data[4] = NULL;
    CHECK_EQUAL("missing component", mpm_io_vtu(path, &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("fault names it", strcmp(f.field, "data of field") == 0 && f.index == 2);
    d.count = 0;
    CHECK_EQUAL("no points", mpm_io_vtu(FOLDER "/empty.vtu", &d, &f), MPM_OK);
}

/* What no VTU can hold is refused by name; what XML has its own signs for is written with theirs. */
static void test_vtu_refused(void)
{
    static const struct { int components; size_t count; int fields; const char *field; } bad[] = {
        {0, 1, 1, "components of field"}, {10, 1, 1, "components of field"}, {-2, 1, 1, "components of field"},
        {1, 2147483648u, 1, "count"},     {1, 1, -1, "field_count"},
    };
    static mpm_real x[1];
    static uint8_t flag[1];
    const char *path = FOLDER "/signs.vtu";
    mpm_io_vtu_desc d = mpm_io_vtu_desc_default();
    mpm_io_field field = mpm_io_scalar("a & \"b\" 'c' <d>", x, 1);
    mpm_fault f;
    size_t k;
    d.count = 1;
    d.x[0] = d.x[1] = d.x[2] = x;
    d.fields = &field;
    d.field_count = 1;
    CHECK_EQUAL("signs of XML in a name", mpm_io_vtu(path, &d, &f), MPM_OK);
    CHECK_TRUE("... are written out", contains(path, "\"a &amp; &quot;b&quot; &apos;c&apos; &lt;d&gt;\""));
    for (k = 0; k < sizeof bad / sizeof *bad; k++) {
        mpm_io_field wrong = bad[k].components < 0 ? mpm_io_uint8("flags", flag) : mpm_io_scalar("one", x, 1);
        mpm_io_vtu_desc e = d;
        wrong.components = bad[k].components < 0 ? -bad[k].components : bad[k].components;
        e.fields = &wrong;
        e.count = bad[k].count;
        e.field_count = bad[k].fields;
        CHECK_EQUAL(bad[k].field, mpm_io_vtu(FOLDER "/refused.vtu", &e, &f), MPM_ERR_ARGUMENT);
        CHECK_TRUE("... is named", strcmp(f.field, bad[k].field) == 0);
    }
    d.mark = 0;
    CHECK_EQUAL("a description of one's own", mpm_io_vtu(FOLDER "/refused.vtu", &d, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... nothing is written", !exists(FOLDER "/refused.vtu") && parts_in(FOLDER) == 0);
}

static void test_pvd(void)
{
    static const unsigned char zero[] = "<?xml?>\n<VTKFile>\n  <Collection>\n\0\n  </Collection>\n</VTKFile>\n";
    static char lengthy[5001];
    const char *path = FOLDER "/series.pvd";
    mpm_fault f;
    memset(lengthy, 'n', sizeof lengthy - 1);
    CHECK_EQUAL("pvd begins", mpm_io_pvd_begin(path, &f), MPM_OK);
    CHECK_EQUAL("first frame", mpm_io_pvd_add(path, "f-000.vtu", 0, &f), MPM_OK);
    CHECK_EQUAL("second frame", mpm_io_pvd_add(path, "f-001.vtu", 0.5, &f), MPM_OK);
    CHECK_EQUAL("second frame again", mpm_io_pvd_add(path, "f-001.vtu", 0.25, &f), MPM_OK);
    CHECK_TRUE("the series",
               contains(path, "<Collection>\n"
                              "    <DataSet timestep=\"0\" part=\"0\" file=\"f-000.vtu\"/>\n"
                              "    <DataSet timestep=\"0.25\" part=\"0\" file=\"f-001.vtu\"/>\n"
                              "  </Collection>\n</VTKFile>\n"));
    remove(FOLDER "/fresh.pvd");
    CHECK_EQUAL("a missing one is begun", mpm_io_pvd_add(FOLDER "/fresh.pvd", "x.vtu", 1, &f), MPM_OK);
    write_text(FOLDER "/other.pvd", "<VTKFile>\n");
    CHECK_EQUAL("a foreign one is refused", mpm_io_pvd_add(FOLDER "/other.pvd", "x.vtu", 1, &f),
                MPM_ERR_FILE);
    CHECK_TRUE("... and kept", file_is(FOLDER "/other.pvd", "<VTKFile>\n"));
    CHECK_EQUAL("a name that is no name", mpm_io_pvd_add(path, "a\"b", 1, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... nor one of control characters", mpm_io_pvd_add(path, "a\x01", 1, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("... nor one that is not UTF-8", mpm_io_pvd_add(path, "a\xe4", 1, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("one of 5000 bytes", mpm_io_pvd_add(path, lengthy, 1, &f), MPM_OK);
    CHECK_EQUAL("... that is replaced", mpm_io_pvd_add(path, lengthy, 2, &f), MPM_OK);
    CHECK_TRUE("... as others are", contains(path, "timestep=\"2\"") && !contains(path, "timestep=\"1\""));
    write_file(FOLDER "/zero.pvd", zero, sizeof zero - 1);
    CHECK_EQUAL("a line that begins with a zero", mpm_io_pvd_add(FOLDER "/zero.pvd", "x.vtu", 1, &f), MPM_ERR_FILE);
    CHECK_EQUAL("no .part", parts_in(FOLDER), 0);
}

/* ---- checkpoints --------------------------------------------------------------------------- */

static void test_checkpoint(void)
{
    const char *path = FOLDER "/state.mpm", *damaged = FOLDER "/damaged.mpm", *text = "material al\ndt 0.001\n";
    mpm_real a[50], back[60];
    int32_t steps = 42, steps_back = 0;
    mpm_blob out[3], in[3];
    mpm_fault f;
    unsigned char *file;
    size_t n, i, undetected = 0, changed = 0;
    for (i = 0; i < 50; i++) a[i] = (mpm_real)random_next() / MPM_R(3.0);
    memset(back, 0, sizeof back);
    out[0] = mpm_blob_array("a", a, 50, 50, sizeof *a);
    out[1] = mpm_blob_of("steps", &steps, sizeof steps);
    out[2] = mpm_blob_of("nothing", NULL, 0);
    in[0] = mpm_blob_array("a", back, 0, 60, sizeof *back);
    in[1] = mpm_blob_of("steps", &steps_back, sizeof steps_back);
    in[2] = out[2];
    CHECK_EQUAL("checkpoint written", mpm_io_checkpoint_write(path, text, out, 3, &f), MPM_OK);
    CHECK_EQUAL("checkpoint read, where there is more room", mpm_io_checkpoint_read(path, text, in, 3, &f), MPM_OK);
    CHECK_TRUE("same bits", memcmp(a, back, sizeof a) == 0 && steps_back == 42);
    CHECK_EQUAL("as many as were stored", (long)in[0].bytes, (long)sizeof a);
    CHECK_TRUE("the text can be read in the file", contains_bytes(path, text, strlen(text)));

    memset(back, 0, sizeof back);
    file = slurp(path, &n);
    for (i = 0; i < n; i++) { /* one bit flipped anywhere */
        file[i] ^= 16;
        write_file(damaged, file, n);
        undetected += mpm_io_checkpoint_read(damaged, text, in, 3, &f) >= 0;
        file[i] ^= 16;
    }
    for (i = 0; i < n; i += 7) { /* cut short */
        write_file(damaged, file, i);
        undetected += mpm_io_checkpoint_read(damaged, text, in, 3, &f) >= 0;
    }
    for (i = 0; i < 50; i++) changed += memcmp(&back[i], "\0\0\0\0\0\0\0\0", sizeof back[i]) != 0;
    CHECK_EQUAL("damage not detected", (long)undetected, 0);
    CHECK_EQUAL("values changed by a damaged file", (long)changed, 0);
    file[16] ^= 1; /* the version */
    write_file(damaged, file, n);
    CHECK_EQUAL("another version", mpm_io_checkpoint_read(damaged, text, in, 3, &f), MPM_ERR_VERSION);
    file[16] ^= 1;
    file[36] = file[36] == 8 ? 4 : 8; /* the size of reals, or its high byte */
    write_file(damaged, file, n);
    CHECK_EQUAL("another real type", mpm_io_checkpoint_read(damaged, text, in, 3, &f), MPM_ERR_VERSION);
    free(file);
    in[0].room = sizeof a - 1;
    in[0].bytes = 7;
    CHECK_EQUAL("too little room", mpm_io_checkpoint_read(path, text, in, 3, &f), MPM_ERR_FILE);
    CHECK_TRUE("fault says so", strcmp(f.field, "name or size of blob differs") == 0 && f.index == 0);
    CHECK_EQUAL("... how much is stored can be asked for", mpm_io_checkpoint_sizes(path, text, in, 3, &f), MPM_OK);
    CHECK_EQUAL("... it is", (long)in[0].bytes, (long)sizeof a);
    CHECK_EQUAL("... of a damaged file it cannot", mpm_io_checkpoint_sizes(damaged, text, in, 3, &f), MPM_ERR_VERSION);
    in[1].bytes = 2;
    CHECK_EQUAL("... nor where a fixed size differs", mpm_io_checkpoint_sizes(path, text, in, 3, &f), MPM_ERR_FILE);
    in[1].bytes = sizeof steps_back;
    in[0] = mpm_blob_of("a", back, sizeof back);
    CHECK_EQUAL("another size", mpm_io_checkpoint_read(path, text, in, 3, &f), MPM_ERR_FILE);
    CHECK_EQUAL("no such file", mpm_io_checkpoint_read(FOLDER "/none", text, in, 3, &f), MPM_ERR_FILE);
    CHECK_EQUAL("fewer blobs than none", mpm_io_checkpoint_write(damaged, text, out, -1, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... are named", strcmp(f.field, "count of blobs") == 0);
    out[2].bytes = 1;
    CHECK_EQUAL("a byte that is nowhere", mpm_io_checkpoint_write(damaged, text, out, 3, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", strcmp(f.field, "data of blob") == 0 && f.index == 2);
}

/* A file of another text is told by the first line that differs. */
static void test_text(void)
{
    static const struct { const char *text, *field; long line; } other[] = {
        {"cell 0.5\nmaterial cu\ndt 0.001\n", "material cu", 2},
        {"cell 0.5\nmaterial al\ndt 0.0011\n", "dt 0.0011", 3},
        {"cell 0.5\nmaterial al\ndt 0.001\nmore 1\n", "more 1", 4},
        {"cell 0.5\nmaterial al\n", "more lines in the file", 3},
        {NULL, "more lines in the file", 1},
    };
    const char *path = FOLDER "/text.mpm";
    char text[60], said[200], wanted[200];
    int32_t number = 7;
    mpm_blob blob = mpm_blob_of("number", &number, sizeof number);
    mpm_fault f;
    size_t used = mpm_io_line_number(text, sizeof text, 0, "cell", 0.5);
    int k;
    used = mpm_io_line(text, sizeof text, used, "material", "al");
    used = mpm_io_line_number(text, sizeof text, used, "dt", 0.001);
    CHECK_TRUE("lines", strcmp(text, "cell 0.5\nmaterial al\ndt 0.001\n") == 0 && used == strlen(text));
    CHECK_EQUAL("a line cut to fit", (long)mpm_io_line_number(said, 6, 0, "cell", 0.5), 5);
    CHECK_EQUAL("written", mpm_io_checkpoint_write(path, text, &blob, 1, &f), MPM_OK);
    CHECK_EQUAL("of the same text", mpm_io_checkpoint_read(path, text, &blob, 1, &f), MPM_OK);
    for (k = 0; k < 5; k++) {
        number = 8;
        CHECK_EQUAL("of another text", mpm_io_checkpoint_read(path, other[k].text, &blob, 1, &f), MPM_ERR_VERSION);
        mpm_io_fault_text(said, sizeof said, &f);
        snprintf(wanted, sizeof wanted, "a file is of another version, real type or description: %s (index %ld)",
                 other[k].field, other[k].line);
        CHECK_TRUE("... whose line is named", strcmp(said, wanted) == 0);
        CHECK_EQUAL("... and nothing is read", number, 8);
    }
}

/* ---- restart ------------------------------------------------------------------------------- */

/* Everything a step depends on, of two worlds. */
static int worlds_differ(mpm_world *a, mpm_world *b)
{
    mpm_blob of_a[MPM_BLOBS(2)], of_b[MPM_BLOBS(2)];
    int n = mpm_blobs(a, of_a), bad = mpm_blobs(b, of_b) != n, k;
    for (k = 0; k < n && !bad; k++)
        bad = of_a[k].bytes != of_b[k].bytes || memcmp(of_a[k].data, of_b[k].data, of_a[k].bytes) != 0;
    return bad;
}

static mpm_status save(const char *path, mpm_world *w)
{
    char text[4000];
    mpm_blob blob[MPM_BLOBS(2)];
    mpm_fault f;
    mpm_io_world_text(text, sizeof text, w);
    return mpm_io_checkpoint_write(path, text, blob, mpm_blobs(w, blob), &f);
}

static mpm_status load(const char *path, mpm_world *w, mpm_fault *f)
{
    static char text[4000]; /* the fault may point into it */
    mpm_blob blob[MPM_BLOBS(2)];
    mpm_status status;
    mpm_io_world_text(text, sizeof text, w);
    status = mpm_io_checkpoint_read(path, text, blob, mpm_blobs(w, blob), f);
    if (status == MPM_OK && (status = mpm_restored(w, blob)) != MPM_OK) *f = w->fault;
    return status;
}

/* Counters of any length of run, in as many bytes on every platform. */
static void test_counters(void)
{
    static const char *const counters[] = {"steps", "retired", "sorts", "notices", "held"};
    const char *path = FOLDER "/counters.mpm";
    mpm_blob blob[MPM_BLOBS(2)];
    mpm_world far_on, again;
    mpm_fault f;
    size_t i;
    int n, k, eight = 0;
    CHECK_EQUAL("a world", make_world(&far_on), MPM_OK);
    CHECK_EQUAL("another", make_world(&again), MPM_OK);
    n = mpm_blobs(&far_on, blob);
    for (i = 0; i < sizeof counters / sizeof *counters; i++)
        for (k = 0; k < n; k++) eight += !strcmp(blob[k].name, counters[i]) && blob[k].bytes == 8;
    CHECK_EQUAL("counters of eight bytes", eight, 5);
    far_on.steps = far_on.sorts = INT64_C(5000000000);
    far_on.retired = far_on.notices = far_on.held = INT64_C(6000000000);
    CHECK_EQUAL("saved after 5e9 steps", save(path, &far_on), MPM_OK);
    CHECK_EQUAL("loaded", load(path, &again, &f), MPM_OK);
    CHECK_TRUE("they are all there", !worlds_differ(&far_on, &again));
    CHECK_EQUAL("a step", mpm_step(&again, MPM_R(1e-6)), MPM_OK);
    CHECK_EQUAL("... counted", again.steps, INT64_C(5000000001));
    mpm_free(&far_on);
    mpm_free(&again);
}

static void test_restart(void)
{
    static int32_t numbers[4000];
    const char *path = FOLDER "/world.mpm";
    char text[4000];
    mpm_contact rule = mpm_desc_default().contact;
    mpm_world whole, first, second;
    mpm_fault f;
    CHECK_EQUAL("a world", make_world(&whole), MPM_OK);
    CHECK_EQUAL("a second", make_world(&first), MPM_OK);
    CHECK_EQUAL("a third", make_world(&second), MPM_OK);
    CHECK_EQUAL("a point less in one", mpm_point_take(&whole, 5), MPM_OK);
    CHECK_EQUAL("... and the other", mpm_point_take(&first, 5), MPM_OK);
    CHECK_EQUAL("a point of a damped face less in one", mpm_point_take(&whole, whole.body[1].first + 1), MPM_OK);
    CHECK_EQUAL("... and the other", mpm_point_take(&first, first.body[1].first + 1), MPM_OK);
    CHECK_TRUE("... whose face is lighter", first.body[1].mass[0] < second.body[1].mass[0]);
    CHECK_TRUE("run in one", run(&whole, 60));
    CHECK_TRUE("run to half", run(&first, 31));
    CHECK_TRUE("they differ", worlds_differ(&whole, &first));
    CHECK_EQUAL("saved", save(path, &first), MPM_OK);
    CHECK_EQUAL("loaded", load(path, &second, &f), MPM_OK);
    CHECK_TRUE("run on", run(&second, 29));
    CHECK_EQUAL("steps", second.steps, whole.steps);
    CHECK_TRUE("bodies have met", whole.ledger.contact > 0);
    CHECK_TRUE("the damper works", whole.ledger.absorbed > 0);
    CHECK_TRUE("same bits in everything", !worlds_differ(&whole, &second));
    mpm_io_body_numbers(&whole, numbers);
    CHECK_EQUAL("number of the first point", numbers[0], 0);
    CHECK_EQUAL("last of the first body", numbers[whole.body[1].first - 1], 0);
    CHECK_EQUAL("first of the second body", numbers[whole.body[1].first], 1);

    CHECK_TRUE("the text fits well", mpm_io_world_text(text, sizeof text, &second) < 1500 + 2 * 800);
    CHECK_TRUE("... and speaks of the grid",
               strstr(text, "\ncells 12 12 12\nside open open open open open open\n") != NULL);
    second.body[1].desc.density = 2;
    CHECK_EQUAL("another density", load(path, &second, &f), MPM_ERR_VERSION);
    CHECK_TRUE("... is named", strncmp(f.field, "body 1 density 2\n", 17) == 0);
    second.body[1].desc.density = 1;
    second.desc.contact.friction = MPM_R(0.5);
    CHECK_EQUAL("another friction", load(path, &second, &f), MPM_ERR_VERSION);
    CHECK_TRUE("... is named", strncmp(f.field, "contact.friction 0.5\n", 21) == 0);
    second.desc.contact.friction = 0;
    second.desc.scheme = (mpm_scheme)(MPM_SCHEMES - 1 - (int)second.desc.scheme);
    CHECK_EQUAL("another scheme", load(path, &second, &f), MPM_ERR_VERSION);
    CHECK_TRUE("... is named", strncmp(f.field, "scheme ", 7) == 0);
    rule.friction = MPM_R(0.25);
    CHECK_EQUAL("a rule for one pair", mpm_contact_set(&first, 0, 1, &rule), MPM_OK);
    mpm_io_world_text(text, sizeof text, &first);
    CHECK_TRUE("... is in the text", strstr(text, "\nrule 0 bodies 0 1\n") && strstr(text, "contact.friction 0.25\n"));
    CHECK_EQUAL("... without it the file is another's", load(path, &first, &f), MPM_ERR_VERSION);
    mpm_free(&whole);
    mpm_free(&first);
    mpm_free(&second);
}

/* Puts the same number, or the longest word, wherever a contact rule has one. */
static void lengthen_contact(mpm_contact *c, mpm_real longest)
{
    c->law = MPM_CONTACT_FRICTION;
    c->normal = MPM_NORMAL_FIXED;
    c->friction = c->cutoff = longest;
    c->touch = -2147483647;
}

/* ... and a body. */
static void lengthen_body(mpm_body_desc *b, mpm_real longest)
{
    int d;
    for (d = 0; d < 3; d++) b->shape.center[d] = b->shape.half[d] = b->velocity[d] = longest;
    b->spacing = b->density = b->temperature = b->wave_p = b->wave_s = longest;
    b->absorb_normal = b->absorb_shear = b->absorb_spring = b->shell = longest;
    b->absorb = b->id = -2147483647;
}

/* How long a world's text can become: with the longest numbers in it, and rules for its pairs. */
static void test_room(void)
{
    static char text[8000];
    const mpm_real longest = sizeof(mpm_real) == 4 ? MPM_R(-1.17549435e-38) : (mpm_real)-2.2250738585072014e-308;
    mpm_contact rule = mpm_desc_default().contact;
    mpm_world w;
    mpm_fault f;
    size_t used[3];
    int d, k;
    CHECK_EQUAL("a world", make_world(&w), MPM_OK);
    CHECK_EQUAL("a rule", mpm_contact_set(&w, 0, 1, &rule), MPM_OK);
    CHECK_EQUAL("another", mpm_contact_set(&w, 0, -1, &rule), MPM_OK);
    CHECK_EQUAL("saved with its rules", save(FOLDER "/rules.mpm", &w), MPM_OK);
    CHECK_EQUAL("... and loaded", load(FOLDER "/rules.mpm", &w, &f), MPM_OK);
    w.rule[1].contact.friction = MPM_R(0.25);
    CHECK_EQUAL("with another rule", load(FOLDER "/rules.mpm", &w, &f), MPM_ERR_VERSION);
    CHECK_TRUE("... it is named", strncmp(f.field, "rule 1 contact.friction 0.25\n", 29) == 0);
    lengthen_contact(&w.desc.contact, longest);
    for (k = 0; k < 2; k++) lengthen_contact(&w.rule[k].contact, longest);
    for (k = 0; k < 2; k++) lengthen_body(&w.body[k].desc, longest);
    for (d = 0; d < 3; d++) w.desc.origin[d] = w.desc.gravity[d] = longest;
    for (d = 0; d < 3; d++) w.desc.cells[d] = -2147483647;
    for (d = 0; d < 6; d++) w.desc.side[d] = MPM_SIDE_SYMMETRY;
    w.desc.geometry = MPM_AXISYMMETRIC;
    w.desc.cell = w.desc.wall_friction = w.desc.mass_cutoff = w.desc.calm = longest;
    used[2] = mpm_io_world_text(text, sizeof text, &w);
    w.bodies = 0;
    used[1] = mpm_io_world_text(text, sizeof text, &w);
    w.rules = 0;
    used[0] = mpm_io_world_text(text, sizeof text, &w);
    w.bodies = w.rules = 2;
    CHECK_TRUE("the longest head fits", used[0] > 450 && used[0] < 1500);
    CHECK_TRUE("... rules", used[1] - used[0] > 2 * 150 && used[1] - used[0] < 2 * (300 - 6 * 9));
    CHECK_TRUE("... and bodies, of numbers of ten digits too", used[2] - used[1] < 2 * (900 - 15 * 9));
    printf("# %d, %d a rule, %d a body\n", (int)used[0], (int)(used[1] - used[0]) / 2, (int)(used[2] - used[1]) / 2);
    mpm_free(&w);
}

/* Numbers that would lead out of the memory, in files whose checksums are right: case k, and the field that the
   fault must name. */
static const char *const crafted[] = {"points",         "points",  "points",         "points of body",
                                      "points of body", "next id", "points of body", "active points of body",
                                      "id of point",    "mass of point"};

static void spoil(mpm_world *w, int k)
{
    switch (k) {
    case 3: w->body[0].first = -4; break;
    case 4: w->body[1].count = 2147483647; break;
    case 5: w->next_id = -7; break;
    case 6: w->body[1].first++; break;
    case 7: w->body[0].active = w->body[0].count + 1; break;
    case 8: w->points.id[3] = -1; break;
    case 9: w->points.mass[3] = 0; break;
    default: break;
    }
}

static mpm_status write_crafted(const char *path, int k)
{
    const int32_t counts[3] = {-1, 100000000, 2147483647};
    mpm_blob blob[MPM_BLOBS(2)];
    char text[4000];
    mpm_world w;
    mpm_status status = make_world(&w);
    int32_t count = k < 3 ? counts[k] : w.points.count;
    mpm_fault f;
    int n, i;
    spoil(&w, k);
    n = mpm_blobs(&w, blob);
    for (i = 0; i < n; i++)
        if (strcmp(blob[i].name, "points") == 0) blob[i].data = &count;
    mpm_io_world_text(text, sizeof text, &w);
    if (status == MPM_OK) status = mpm_io_checkpoint_write(path, text, blob, n, &f);
    mpm_free(&w);
    return status;
}

static void test_crafted(void)
{
    const char *path = FOLDER "/crafted.mpm";
    mpm_world w;
    mpm_fault f;
    int k;
    for (k = 0; k < 10; k++) {
        CHECK_EQUAL("a crafted file", write_crafted(path, k), MPM_OK);
        CHECK_EQUAL("a world to go on", make_world(&w), MPM_OK);
        CHECK_EQUAL("... refuses it", load(path, &w, &f), MPM_ERR_ARGUMENT);
        CHECK_TRUE("... by name", strcmp(f.field, crafted[k]) == 0);
        CHECK_TRUE("... is left without points", w.points.count == 0 && w.body[0].count == 0 && w.body[1].active == 0);
        CHECK_EQUAL("... and steps", mpm_step(&w, MPM_R(0.0005)), MPM_OK);
        mpm_free(&w);
    }
}

/* ---- PNG ----------------------------------------------------------------------------------- */

/* Whether a picture written with a note comes back pixel by pixel. */
static int comes_back(const char *path, const unsigned char *pixels, int width, int height)
{
    int w = 0, h = 0, same;
    unsigned char *rgb;
    mpm_fault f;
    if (mpm_io_png(path, pixels, width, height, "a note", &f) != MPM_OK) return 0;
    rgb = read_png(path, &w, &h);
    same = rgb && w == width && h == height && memcmp(rgb, pixels, 3 * (size_t)width * (size_t)height) == 0;
    free(rgb);
    return same;
}

static void test_png(void)
{
    enum { WIDE = 1200, HIGH = 900 };
    static unsigned char pixels[3 * WIDE * HIGH];
    static char lengthy[3001];
    const char *path = FOLDER "/picture.png";
    unsigned char *rgb;
    mpm_fault f;
    size_t n, i;
    int x, y;
    CHECK_TRUE("crc of 123456789, by the reader", crc_bitwise((const unsigned char *)"123456789", 9) == 0xcbf43926u);
    CHECK_TRUE("adler of Wikipedia, by the reader", adler((const unsigned char *)"Wikipedia", 9) == 0x11e60398u);
    CHECK_EQUAL("a picture without width", mpm_io_png(path, pixels, 0, 5, NULL, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... is named", strcmp(f.field, "width of picture") == 0);
    CHECK_EQUAL("a picture too high", mpm_io_png(path, pixels, 1, 16385, NULL, &f), MPM_ERR_ARGUMENT);
    CHECK_EQUAL("no pixels", mpm_io_png(path, NULL, 1, 1, NULL, &f), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... are named", strncmp(f.field, "pixels", 6) == 0);
    for (i = 0; i < (size_t)20 * 10 * 3; i++) pixels[i] = (unsigned char)(i % 60 < 30 ? 255 : i / 60 * 20);
    CHECK_TRUE("a small picture comes back", comes_back(path, pixels, 20, 10));
    CHECK_TRUE("its note is kept", contains_bytes(path, "iTXtDescription\0\0\0\0\0a note", 26));
    memset(lengthy, 'n', sizeof lengthy - 1);
    memcpy(lengthy + 995, "\xc2\xb5\xe4", 3);
    CHECK_EQUAL("a note of 3000 bytes", mpm_io_png(path, pixels, 20, 10, lengthy, &f), MPM_OK);
    CHECK_TRUE("... is whole and UTF-8", contains_bytes(path, "n\xc2\xb5\xef\xbf\xbdnnnn", 10));
    rgb = read_png(path, &x, &y); /* checks the sums */
    CHECK_TRUE("... in a picture that reads", rgb && x == 20 && y == 10);
    free(rgb);
    CHECK_TRUE("a single pixel comes back", comes_back(path, pixels, 1, 1));

    for (i = 0; i < (size_t)333 * 257 * 3; i++) pixels[i] = (unsigned char)(random_next() >> 12);
    CHECK_TRUE("noise comes back", comes_back(path, pixels, 333, 257));
    for (i = 0; i < (size_t)333 * 257 * 3; i++) /* repeats at many distances, rare symbols */
        pixels[i] = (unsigned char)(random_next() % 50 ? pixels[i > 4000 ? i - random_next() % 4000 : 0]
                                                        : (random_next() & random_next()));
    CHECK_TRUE("patterns come back", comes_back(path, pixels, 333, 257));

    for (y = 0; y < HIGH; y++) /* discs of one colour each */
        for (x = 0; x < WIDE; x++) {
            const int dx = x % 120 - 60, dy = y % 90 - 45, inside = dx * dx + dy * dy < 1600;
            for (i = 0; i < 3; i++)
                pixels[3 * (WIDE * (size_t)y + (size_t)x) + i] =
                    (unsigned char)(inside ? 20 * (x / 120) + 10 * (y / 90) * (int)i : 255);
        }
    CHECK_TRUE("a large picture comes back", comes_back(path, pixels, WIDE, HIGH));
    free(slurp(path, &n));
    CHECK_TRUE("1200 x 900 of flat areas in under 60 kB", n < 60000);
}

/* ---- films ------------------------------------------------------------------------------------ */

enum { FILM_WIDE = 300, FILM_HIGH = 200, FILM_PICTURES = 4 };

/* Picture k: stripes, or (2) noise, which takes several chunks. */
static void film_picture(unsigned char *pixels, int k)
{
    size_t i;
    for (i = 0; i < (size_t)3 * FILM_WIDE * FILM_HIGH; i++)
        pixels[i] = (unsigned char)(k == 2 ? random_next() >> 12 : i / 60 * (size_t)(k + 1));
}

/* Two pictures as pixels, two as files. */
static void test_film(void)
{
    static unsigned char pixels[FILM_PICTURES][3 * FILM_WIDE * FILM_HIGH];
    const char *path = FOLDER "/film.png";
    mpm_io_film f;
    mpm_fault fault;
    film_said said;
    unsigned char *rgb;
    int k, x, y;
    remove(path);
    CHECK_EQUAL("a film", mpm_io_film_begin(&f, path, 0.25, "a film", &fault), MPM_OK);
    for (k = 0; k < FILM_PICTURES; k++) {
        film_picture(pixels[k], k);
        CHECK_EQUAL("a picture for it", mpm_io_png(FOLDER "/one.png", pixels[k], FILM_WIDE, FILM_HIGH, "one", &fault),
                    MPM_OK);
        if (k == FILM_PICTURES - 1) f.seconds = 2;
        if (k % 2) mpm_io_film_add(&f, pixels[k], FILM_WIDE, FILM_HIGH, &fault);
        else mpm_io_film_add_png(&f, FOLDER "/one.png", &fault);
        CHECK_EQUAL("... goes into it", f.status, MPM_OK);
    }
    CHECK_TRUE("until it is ended it has no name", !exists(path));
    CHECK_EQUAL("its end", mpm_io_film_end(&f, &fault), MPM_OK);
    for (k = 0; k < FILM_PICTURES; k++) {
        rgb = read_picture(path, k, &x, &y, &said);
        CHECK_TRUE("each picture comes back", rgb && x == FILM_WIDE && y == FILM_HIGH &&
                                                  !memcmp(rgb, pixels[k], sizeof pixels[k]));
        CHECK_EQUAL("... shown for", said.ms, k < FILM_PICTURES - 1 ? 250 : 2000);
        free(rgb);
    }
    CHECK_TRUE("as many as there are, for ever", said.pictures == FILM_PICTURES && said.plays == 0);
    CHECK_TRUE("its note is kept", contains_bytes(path, "iTXtDescription\0\0\0\0\0a film", 26));
    rgb = read_png(path, &x, &y);
    CHECK_TRUE("who knows no films sees the first picture", rgb && !memcmp(rgb, pixels[0], sizeof pixels[0]));
    free(rgb);
}

/* What goes wrong ends the film, and the one of before stays. */
static void film_refused(const char *what, const char *picture, int width, mpm_status wanted, const char *field)
{
    static const unsigned char pixels[3 * FILM_WIDE * 2];
    const char *path = FOLDER "/film.png";
    unsigned char *before, *after;
    size_t n[2];
    mpm_io_film f;
    mpm_fault fault;
    before = slurp(path, &n[0]);
    mpm_io_film_begin(&f, path, 1, NULL, &fault);
    mpm_io_film_add(&f, pixels, 20, 2, &fault);
    if (picture) mpm_io_film_add_png(&f, picture, &fault);
    else mpm_io_film_add(&f, pixels, width, 2, &fault);
    CHECK_EQUAL(what, f.status, wanted);
    CHECK_TRUE("... is named", strstr(fault.field, field) != NULL);
    CHECK_EQUAL("... it sticks", mpm_io_film_add(&f, pixels, 20, 2, &fault), wanted);
    CHECK_EQUAL("... to the end", mpm_io_film_end(&f, &fault), wanted);
    after = slurp(path, &n[1]);
    CHECK_TRUE("... and the film of before stays", before && after && n[0] == n[1] && !memcmp(before, after, n[0]));
    free(before);
    free(after);
}

static void test_film_refused(void)
{
    mpm_io_film f;
    mpm_fault fault;
    unsigned char *file;
    size_t n;
    film_refused("another width", NULL, 30, MPM_ERR_ARGUMENT, "width");
    film_refused("no width", NULL, 0, MPM_ERR_ARGUMENT, "width");
    film_refused("a file that is not there", FOLDER "/none.png", 0, MPM_ERR_FILE, "cannot be opened");
    write_file(FOLDER "/other.png", "\x89PNG\r\n", 6);
    film_refused("a file that is no picture", FOLDER "/other.png", 0, MPM_ERR_FILE, "mpm_io_png");
    film_refused("a picture of another size", FOLDER "/one.png", 0, MPM_ERR_ARGUMENT, "width");
    file = slurp(FOLDER "/one.png", &n);
    if (file) {
        memcpy(file + 16, "\0\0\0\x14\0\0\0\2", 8); /* 20 x 2: of another size, but says not so */
        file[n - 40] ^= 1;
        write_file(FOLDER "/other.png", file, n);
    }
    film_refused("a damaged picture", FOLDER "/other.png", 0, MPM_ERR_FILE, "damaged");
    if (file) write_file(FOLDER "/other.png", file, n / 2);
    film_refused("half a picture", FOLDER "/other.png", 0, MPM_ERR_FILE, "damaged");
    if (file) {
        memset(file + 16, 0, 4);
        write_file(FOLDER "/other.png", file, n);
    }
    film_refused("a picture without width", FOLDER "/other.png", 0, MPM_ERR_FILE, "mpm_io_png");
    free(file);
    write_file(FOLDER "/other.png", "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x14\0\0\0\2\x8\2\0\0\0"
               "\0\0\0\0\0\0\0\0IEND\0\0\0\0", 45);
    film_refused("a picture without rows", FOLDER "/other.png", 0, MPM_ERR_FILE, "damaged");
    CHECK_EQUAL("a film without pictures", mpm_io_film_begin(&f, FOLDER "/empty.png", 1, NULL, &fault), MPM_OK);
    CHECK_EQUAL("... is none", mpm_io_film_end(&f, &fault), MPM_ERR_ARGUMENT);
    CHECK_TRUE("... there is no file", !exists(FOLDER "/empty.png"));
    CHECK_EQUAL("a film nowhere", mpm_io_film_begin(&f, FOLDER "/no/film.png", 1, NULL, &fault), MPM_ERR_FILE);
    CHECK_EQUAL("... says so again", mpm_io_film_end(&f, &fault), MPM_ERR_FILE);
}

int main(void)
{
    test_messages();
    test_numbers();
    test_folders();
    test_failures();
#ifdef __linux__
    test_names();
    test_parts();
    test_hostile();
#endif
    test_format();
    test_json();
    test_csv();
    test_vtu();
    test_vtu_refused();
    test_pvd();
    test_checkpoint();
    test_text();
    test_counters();
    test_restart();
    test_room();
    test_crafted();
    test_png();
    test_film();
    test_film_refused();
    return check_end();
}
