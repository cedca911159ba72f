/* 63_particles - scenes of several particles: their files; one that was interrupted ends with the same bits as one
   that was not, and a finished one is known by its options and places. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "particles_case.h"
#include "check.h"
#include "files.h"

#define FOLDER "build/tests/particles"

/* Two particles on a grid so coarse that the scene takes a second; three frames. */
static void scene(particles_case *q, const char *method, const char *folder)
{
    char option_name[] = "--method", word[16] = "", *argv[3];
    argv[0] = option_name;
    argv[1] = option_name;
    argv[2] = word;
    snprintf(word, sizeof word, "%s", method);
    *q = particles_default("half", folder);
    particles_method(q, 3, argv);
    q->base.cell = 2;
    q->base.spacing = 1;
    q->base.substrate_diameter = 24;
    q->base.substrate_height = 6;
    q->base.margin = 0.5;
    q->base.time = 8;
    q->count = 2;
    q->center[0][2] = 7;
    q->center[1][0] = 3.1;
    q->center[1][2] = 22;
    q->out.frames = 3;
    q->out.quiet = 1;
    q->base.adhesion_critical = 100;
    q->base.dt_factor = strcmp(method, "surface") ? 0.2 : 0.4;
    particles_complete(q);
}

/* Runs it, at most so many steps (0: all). */
static int run(particles_case *q, long steps)
{
    option o[IMPACT_OPTIONS];
    const int n = particles_options(q, o);
    q->stop_after = steps;
    return particles_main(q, o, n);
}

/* Bytes of folder/name, in memory that the next but one call gives back; NULL if there is no file. */
static unsigned char *bytes_of(const char *folder, const char *name, size_t *n)
{
    static unsigned char *kept[2];
    static int turn;
    char path[PATH_BYTES];
    turn = !turn;
    free(kept[turn]);
    return kept[turn] = slurp(file_in(folder, name, path, sizeof path), n);
}

/* Whether two folders hold the same file; of a summary as far as it does not tell of this very run. */
static int same(const char *a, const char *b, const char *name)
{
    size_t na, nb;
    unsigned char *x = bytes_of(a, name, &na), *y = bytes_of(b, name, &nb);
    const char *end = x ? strstr((char *)x, "\"cpu_seconds\"") : NULL;
    if (!x || !y || na < 40) return 0;
    if (end) na = nb = (size_t)(end - (char *)x);
    return na == nb && !memcmp(x, y, na);
}

/* Stopped, left for dead behind its second frame, gone on with from the first stop, beside one run. */
static void interrupted(const char *method, const char *normal, int touch)
{
    static const char *const file[] = {"particles.csv", "pairs.csv", "summary.json", "particles.pvd",
                                       "points_0000.vtu", "points_0001.vtu", "points_0002.vtu", "frame_0002.png",
                                       "history.csv", "history.png", "film.png", "surface.pvd", "surface_0002.vtu"};
    const int surface = !strcmp(method, "surface"), files = surface ? 13 : 11;
    const long some = surface ? 50 : 100; /* of five times as many steps */
    static particles_case whole, parts;
    int k;
    scene(&whole, method, FOLDER "/whole");
    scene(&parts, method, FOLDER "/parts");
    whole.base.normal = parts.base.normal = normal;
    whole.base.touch = parts.base.touch = touch;
    CHECK_EQUAL(normal, run(&whole, 0), 0);
    CHECK_EQUAL("stopped", run(&parts, some), 3);
    CHECK_TRUE("... with a checkpoint, without a summary",
               exists(FOLDER "/parts/checkpoint.bin") && !exists(FOLDER "/parts/summary.json"));
    CHECK_TRUE("... which is not taken for a finished scene", !particles_finished(&parts));
    scene(&parts, method, FOLDER "/parts");
    parts.base.normal = normal;
    parts.base.touch = touch;
    system("cp " FOLDER "/parts/checkpoint.bin " FOLDER "/first.bin");
    CHECK_EQUAL("stopped again, behind the second frame", run(&parts, 2 * some), 3);
    CHECK_TRUE("... which is there", exists(FOLDER "/parts/points_0001.vtu"));
    system("cp " FOLDER "/first.bin " FOLDER "/parts/checkpoint.bin");
    CHECK_EQUAL("to the end", run(&parts, 0), 0);
    CHECK_TRUE("... at which the checkpoint goes", !exists(FOLDER "/parts/checkpoint.bin"));
    for (k = 0; k < files; k++) {
        char line[80];
        snprintf(line, sizeof line, "the same bits: %s", file[k]);
        CHECK_TRUE(line, same(FOLDER "/whole", FOLDER "/parts", file[k]));
    }
}

/* The scene on surfaces, of which the particles are added in one order or the other. */
static void surface_scene(int order, double *v, double *area)
{
    static particles_case q;
    char message[300];
    particles_meeting m[3];
    impact s;
    double x[3];
    int32_t k;
    scene(&q, "surface", FOLDER "/none");
    q.base.dt_factor = 0.5;
    q.center[1][0] = 2;
    q.center[1][2] = 21;
    memcpy(x, q.center[0], sizeof x);
    if (order) {
        memcpy(q.center[0], q.center[1], sizeof x);
        memcpy(q.center[1], x, sizeof x);
    }
    CHECK_EQUAL("three bodies with surfaces", particles_begin(&s, &q, message, sizeof message), 1);
    CHECK_EQUAL("... each its own", s.surfaces.surfaces, 3);
    while (s.world.steps < s.steps)
        if (impact_step(&s) < 0) break;
    CHECK_EQUAL("... to the end", s.world.steps, s.steps);
    for (k = 0; k < 3; k++) {
        const int32_t body = order && k < 2 ? 1 - k : k;
        v[k] = mpm_body_totals(&s.world, body).momentum[2] / mpm_body_totals(&s.world, body).mass;
    }
    m[0] = particles_meet(&s, 0, 1); /* of the two, of the lower and the substrate, of the upper and that */
    m[1] = particles_meet(&s, order, 2);
    m[2] = particles_meet(&s, 1 - order, 2);
    for (k = 0; k < 3; k++) area[k] = m[k].touched;
    CHECK_TRUE("... a bond is of the pair that met", m[1].area > 0 && m[1].linked && !m[2].linked);
    impact_end(&s);
}

/* Contact and bond of any pair, however they are numbered. */
static void surfaces(void)
{
    double v[2][3], area[2][3];
    int k;
    for (k = 0; k < 2; k++) surface_scene(k, v[k], area[k]);
    printf("# on surfaces: %.3f, %.3f, %.3f m/s, areas %.2f, %.2f, %.2f um2\n", v[0][0], v[0][1], v[0][2], area[0][0],
           area[0][1], area[0][2]);
    CHECK_TRUE("the particles meet", area[0][0] > 1);
    CHECK_TRUE("... the lower one the substrate", area[0][1] > 1);
    CHECK_NEAR("... and not the upper", area[0][2], 0, 0);
    for (k = 0; k < 3; k++) CHECK_NEAR("... however they are numbered [m/s]", v[1][k], v[0][k], 1e8 * MPM_EPSILON);
    for (k = 0; k < 2; k++) CHECK_RELATIVE("... areas", area[1][k], area[0][k], 1e6 * (double)MPM_EPSILON);
}

static void refused(const char *command, const char *said)
{
    char line[300];
    snprintf(line, sizeof line, "build/%s --out " FOLDER "/bad >" FOLDER "/out 2>&1", command);
    CHECK_TRUE(command, system(line) != 0);
    CHECK_TRUE("... with a message naming it", strstr(text_of(FOLDER "/out"), said) != NULL);
}

/* What a person does: other options, or a damaged file, begin afresh. */
static void afresh(void)
{
    static const struct {
        const char *options;
        const char *said, *stopped;
    } turn[] = {{"--velocity 800", "stopped at step 5 ", "stopped at step 5 "},
                {"--velocity 800", "going on from step 5 of", "stopped at step 10 "},
                {"--velocity 801", "starting afresh", "stopped at step 5 "},
                {"--velocity 801 --offset 0.5", "starting afresh", "stopped at step 5 "},
                {"--velocity 801 --offset 0.5 --frames 0", "starting afresh", "stopped at step 5 "},
                {"--velocity 801 --offset 0.5 --frames 0", "going on from step 5 of", "stopped at step 10 "}};
    char command[400];
    FILE *f;
    int k;
    for (k = 0; k < 7; k++) {
        const int again = k < 6 ? k : 5; /* once more, with a damaged file */
        if (k == 6) {
            f = fopen(FOLDER "/turns/checkpoint.bin", "ab");
            if (f) fputc('x', f);
            if (f) fclose(f);
        }
        snprintf(command, sizeof command,
                 "build/two_particles --cell 2 --spacing 1 --substrate-diameter 24 --substrate-height 6 --frames 1 "
                 "--stop-after 5 --out " FOLDER "/turns %s >" FOLDER "/out 2>&1", turn[again].options);
        CHECK_TRUE(turn[again].options, system(command) != 0);
        CHECK_TRUE("... says so", strstr(text_of(FOLDER "/out"), k < 6 ? turn[k].said : "starting afresh") != NULL);
        CHECK_TRUE("... and where", strstr(text_of(FOLDER "/out"), k < 6 ? turn[k].stopped : "at step 5 ") != NULL);
    }
    k = system("cd " FOLDER "/turns && rm checkpoint.bin && ln -s checkpoint.bin checkpoint.bin");
    CHECK_EQUAL("a checkpoint that cannot be opened", k, 0);
    CHECK_TRUE("... is no reason to start afresh", system(command) != 0);
    CHECK_TRUE("... which is said", strstr(text_of(FOLDER "/out"), "checkpoint.bin cannot be read") != NULL);
    CHECK_EQUAL("... and it stays", system("test -L " FOLDER "/turns/checkpoint.bin"), 0);
    k = system("rm " FOLDER "/turns/checkpoint.bin");
    CHECK_EQUAL("... until it is swept away", k, 0);
}

/* Whose surface sets the normal between two particles: that one has the higher number. */
static void leaders(void)
{
    static const char *const leader[2] = {"top", "bottom"};
    char command[400], wanted[2][20] = {"\n1,1,0,30,", "\n0,1,0,30,"};
    int k;
    for (k = 0; k < 2; k++) {
        snprintf(command, sizeof command,
                 "build/two_particles --cell 2 --spacing 1 --substrate-diameter 24 --substrate-height 6 --time 0.05 "
                 "--frames 0 --offset 1 --leads %s --quiet --out " FOLDER "/leads_%s", leader[k], leader[k]);
        CHECK_EQUAL(leader[k], system(command), 0);
        snprintf(command, sizeof command, FOLDER "/leads_%s/particles.csv", leader[k]);
        CHECK_TRUE("... leads", strstr(text_of(command), wanted[k]) != NULL);
    }
    refused("two_particles --leads left", "--leads left");
}

/* Takes the lines that name an option out of a summary, as if it were older than the option. */
static void forget(const char *folder, const char *option_name)
{
    size_t n;
    char *text = (char *)bytes_of(folder, "summary.json", &n), path[PATH_BYTES], *at, *end;
    FILE *f;
    at = text ? strstr(text, option_name) : NULL;
    CHECK_TRUE(option_name, at != NULL);
    if (!at) return;
    while (*at != '\n') at--;
    end = strchr(at + 1, '\n');
    f = fopen(file_in(folder, "summary.json", path, sizeof path), "wb");
    if (!f) return;
    fwrite(text, 1, (size_t)(at - text), f);
    fputs(end, f);
    fclose(f);
}

/* Changes a text in the summary of a scene. */
static void change(const char *folder, const char *from, const char *to)
{
    size_t n;
    char *text = (char *)bytes_of(folder, "summary.json", &n), path[PATH_BYTES];
    const char *at = text ? strstr(text, from) : NULL;
    FILE *f = at ? fopen(file_in(folder, "summary.json", path, sizeof path), "wb") : NULL;
    CHECK_TRUE(from, f != NULL);
    if (!f) return;
    fwrite(text, 1, (size_t)(at - text), f);
    fputs(to, f);
    fputs(at + strlen(from), f);
    fclose(f);
}

/* A table of the scene in FOLDER/whole that lost a bit. */
static void damaged(const particles_case *q)
{
    const char *path = FOLDER "/whole/pairs.csv";
    FILE *f;
    int byte;
    for (byte = 0; byte < 2; byte++) { /* there and back */
        f = fopen(path, "rb+");
        if (f && fseek(f, -3, SEEK_END) == 0) {
            const int c = fgetc(f);
            fseek(f, -3, SEEK_END);
            fputc(c ^ 1, f);
        }
        if (f) fclose(f);
        CHECK_EQUAL("finished but for a changed byte of a table, and with it again", particles_finished(q), byte);
    }
}

/* Of the scene in FOLDER/whole. */
static void finished(void)
{
    static particles_case q;
    scene(&q, "thesis", FOLDER "/whole");
    q.base.normal = "logistic";
    q.base.touch = 1;
    CHECK_TRUE("a finished scene is known", particles_finished(&q));
    q.out.frames = 9;
    q.out.quiet = 0;
    CHECK_TRUE("... whatever else it wrote", particles_finished(&q));
    q.base.gc += 1e-6;
    CHECK_TRUE("... not with another number", !particles_finished(&q));
    q.base.gc = impact_case_default().gc;
    q.base.normal = "log";
    CHECK_TRUE("... another word", !particles_finished(&q));
    q.base.normal = "logistic";
    q.base.touch = 0;
    CHECK_TRUE("... another switch", !particles_finished(&q));
    q.base.touch = 1;
    q.center[1][0] = 3.2;
    CHECK_TRUE("... another place", !particles_finished(&q));
    q.center[1][0] = 3.1;
    q.count = 1;
    CHECK_TRUE("... another number of particles", !particles_finished(&q));
    q.count = 2;
    q.out.folder = FOLDER "/none";
    CHECK_TRUE("... another folder", !particles_finished(&q));
    q.out.folder = FOLDER "/whole";
    CHECK_TRUE("known again", particles_finished(&q));
    forget(FOLDER "/whole", "\"bond-width\"");
    CHECK_TRUE("an option it does not have has its default", particles_finished(&q));
    q.base.bond_width = 0.5;
    CHECK_TRUE("... and no other value", !particles_finished(&q));
    q.base.bond_width = 0;
    change(FOLDER "/whole", "\"" MPM_VERSION "\"", "\"" MPM_VERSION "0\"");
    CHECK_TRUE("not of another version", !particles_finished(&q));
    change(FOLDER "/whole", "\"" MPM_VERSION "0\"", "\"" MPM_VERSION "\"");
    CHECK_TRUE("known again", particles_finished(&q));
    change(FOLDER "/whole", MPM_DIGITS == 17 ? "\"mpm_digits\": 17" : "\"mpm_digits\": 9", "\"mpm_digits\": 12");
    CHECK_TRUE("not of another number type", !particles_finished(&q));
    forget(FOLDER "/whole", "\"mpm_digits\"");
    CHECK_EQUAL("without the number type it is of double", particles_finished(&q), MPM_DIGITS == 17);
    change(FOLDER "/whole", "\"particles\"", MPM_DIGITS == 17 ? "\"mpm_digits\": 17,\n  \"particles\""
                                                            : "\"mpm_digits\": 9,\n  \"particles\"");
    CHECK_TRUE("known again", particles_finished(&q));
    damaged(&q);
    forget(FOLDER "/whole", "\"normal\"");
    CHECK_TRUE("... for a word too", !particles_finished(&q));
}

/* The programs do not repeat a finished scene, and do when the frames are others or the folder is gone. */
static void repeated(void)
{
    static const struct {
        const char *options;
        int again;
    } turn[] = {{"--frames 0", 1}, {"--frames 0", 0}, {"--frames 1", 1}, {"--frames 1", 0}, {"--frames 0", 0},
                {"--frames 0 --velocity 801", 1}, {"--frames 0 --velocity 801 --seed 2", 1}};
    char command[400];
    int k;
    for (k = 0; k < 7; k++) {
        if (k > 0) change(FOLDER "/repeated", "\"particles\"", "\"seen\": 1,\n  \"particles\"");
        snprintf(command, sizeof command,
                 "build/many_particles --count 2 --spread 20 --cell 2 --spacing 1 --substrate-height 6 --time 0.1 "
                 "--quiet --out " FOLDER "/repeated %s >" FOLDER "/out 2>&1", turn[k].options);
        CHECK_EQUAL(turn[k].options, system(command), 0);
        CHECK_EQUAL("... is run", !strstr(text_of(FOLDER "/repeated/summary.json"), "seen"), turn[k].again);
        CHECK_EQUAL("... or said to be finished", strstr(text_of(FOLDER "/out"), "delete the folder") != NULL,
                    !turn[k].again);
    }
}

/* Of many particles: the lowest on the substrate, none in another, all land in the region. */
static void places(const char *shape, double aspect, double angle)
{
    const double tilt = angle * (double)MPM_PI / 180;
    static particles_case q;
    char message[300];
    double closest = HUGE_VAL, farthest = 0, high, low;
    long i, j, lowest = 0;
    impact s;
    q = particles_default("full", FOLDER "/places");
    q.count = 10;
    q.base.cell = 2;
    q.base.spacing = 1;
    q.base.shape = shape;
    q.base.aspect = aspect;
    q.base.angle = angle;
    q.base.substrate_diameter = q.base.time = 0;
    CHECK_EQUAL(shape, particles_place(&q, 60, 40, 1, message, sizeof message), 1);
    high = impact_half_height(&q.base);
    for (i = 0; i < q.count; i++) {
        const double *x = q.center[i];
        if (x[2] < q.center[lowest][2]) lowest = i;
        for (j = 0; j < i; j++) {
            const double *y = q.center[j];
            closest = fmin(closest, hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]));
        }
        farthest = fmax(farthest, hypot(x[0] + tan(tilt) * (x[2] - high), x[1]));
    }
    CHECK_NEAR("the lowest touches the substrate", q.center[lowest][2], high, 1e-12);
    CHECK_TRUE("none is within a particle and a cell of another",
               closest >= 2 * fmax(impact_half_width(&q.base), high) + q.base.cell - 1e-12);
    CHECK_TRUE("all land in the region", farthest <= 30 + 1e-12);
    CHECK_RELATIVE("the time to fall, and 40 ns", q.base.time, 1e3 * 40 / (810 * cos(tilt)) + 40, 1e-12);
    CHECK_EQUAL("the scene", particles_begin(&s, &q, message, sizeof message), 1);
    low = mpm_body_totals(&s.world, (int32_t)lowest).low[2];
    CHECK_NEAR("... begins on the face, up to the lattice", low, 0.75 * q.base.spacing, 0.75 * q.base.spacing);
    mpm_free(&s.world);
}

/* Of two_particles: the first touches the substrate whatever its shape. */
static void first_place(const char *options, double height)
{
    char command[400];
    const char *row;
    snprintf(command, sizeof command,
             "rm -rf " FOLDER "/first && build/two_particles --cell 2 --spacing 1 --substrate-height 6 --time 0.05 "
             "--quiet --frames 0 --height 40 --out " FOLDER "/first %s >" FOLDER "/out 2>&1", options);
    CHECK_EQUAL(options, system(command), 0);
    row = strstr(text_of(FOLDER "/first/particles.csv"), "\n0,0,0,");
    CHECK_NEAR("... touches the substrate", row ? strtod(row + 7, NULL) : -1, height, 1e-5);
}

/* The last field of the last frame: the points that name a partner are those in pairs.csv. */
static void partners(void)
{
    const double points = number_in(FOLDER "/whole/summary.json", "points");
    long found[4] = {0, 0, 0, 0}, counted = 0, k;
    int32_t value;
    size_t n;
    unsigned char *file = bytes_of(FOLDER "/whole", "points_0002.vtu", &n), *end = NULL, *at;
    const char *row = text_of(FOLDER "/whole/pairs.csv");
    CHECK_TRUE("the field is there", file && strstr((char *)file, "Name=\"bonded to\"") && points > 0);
    for (at = file; file && at < file + n; at++)
        if (*at == '\n' && (size_t)(file + n - at) > 20 && !memcmp(at + 1, "  </AppendedData>", 17)) end = at;
    CHECK_TRUE("... to its end", end != NULL);
    if (!end) return;
    for (k = 1; k <= (long)points; k++) {
        memcpy(&value, end - 4 * k, 4);
        if (value >= -1 && value <= 2) found[value + 1]++;
    }
    for (row = strstr(row, "bonded_um2\n"); row && (row = strchr(row, '\n')) != NULL && row[1]; row++) {
        long contacted = 0;
        if (sscanf(row, "\n%*d,%*d,%*f,%ld", &contacted) == 1) counted += contacted;
    }
    CHECK_EQUAL("every point has a body or none", found[0] + found[1] + found[2] + found[3], points);
    CHECK_EQUAL("those with a body are the contacted ones", found[1] + found[2] + found[3], counted);
    CHECK_TRUE("... of all three bodies", found[1] > 0 && found[2] > 0 && found[3] > 0);
}

/* The next frame is due evenly in time, also where steps times frames pass 32 bits. */
static void evenly(void)
{
    output o = output_of(FOLDER, "none", "um", "ns", 1);
    mpm_world w;
    int early = 0;
    memset(&w, 0, sizeof w);
    o.frames = 1001;
    for (w.steps = 0; w.steps <= 3000000; w.steps += 100)
        if (output_due(&o, &w, 3000000)) early += w.steps != 3000 * o.frame++;
    CHECK_EQUAL("frames of 3,000,000 steps", o.frame, 1001);
    CHECK_EQUAL("... at other steps than every 3000th", early, 0);
}

int main(void)
{
    evenly();
    CHECK_EQUAL("an empty folder", system("rm -rf " FOLDER " && mkdir -p " FOLDER), 0);
    interrupted("thesis", "ranked", 0);
    partners();
    interrupted("surface", "ranked", 0);
    surfaces();
    interrupted("thesis", "logistic", 1);
    finished();
    repeated();
    places("sphere", 1, 0);
    places("ellipsoid", 0.7, 0);
    places("ellipsoid", 2, 0);
    places("sphere", 1, 30);
    first_place("--shape sphere", 7);
    first_place("--shape ellipsoid --aspect 0.7", 7 / cbrt(0.7) * 0.7);
    first_place("--shape ellipsoid --aspect 2", 7 / cbrt(2.0) * 2);
    afresh();
    leaders();
    refused("many_particles --cell 1e9", "--cell 1000000000");
    refused("many_particles --cell 100 --spread 20", "smaller --cell");
    refused("many_particles --time -1", "--time -1");
    refused("two_particles --stop-after -2", "--stop-after -2");
    refused("two_particles --frames 10000", "--frames 10000");
    return check_end();
}
