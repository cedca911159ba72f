/* 07_body_from_points - bodies from anything. A ring from a function that says what is inside; a heap of grains from a
   file of points, x,y,z,radius in each line; and a ball that joins while the run is under way. The file is written by
   this program first, where it is called or to the path given, and removed at the end. Then all fall onto the floor.
   Expected: of the exact masses, 97.787 % (ring, filled with a lattice four points wide), 100 % (grains: each weighs
   what its sphere does) and 104.445 % (ball, eight points wide); and nothing is lost until the end. Units m, kg, s.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_ptw.h"

#include <stdio.h>

enum { MOST = 1000 };
static const double pi = (double)MPM_PI, density = 1000;

/* ---- inside(x): a torus about the z axis --------------------------------------------------------- */

typedef struct torus { mpm_real x[3], far, thick; } torus; /* centre; radii of the ring and of its section [m] */

static int in_torus(void *context, const mpm_real x[3])
{
    const torus *t = (const torus *)context;
    const mpm_real dx = x[0] - t->x[0], dy = x[1] - t->x[1], dz = x[2] - t->x[2];
    const mpm_real off = mpm_sqrt(dx * dx + dy * dy) - t->far;
    return off * off + dz * dz < t->thick * t->thick;
}

/* ---- a file of points ------------------------------------------------------------------------------- */

/* Grains of two sizes in layers. Returns 0 on failure. */
static int write_points(const char *path)
{
    FILE *f = fopen(path, "w");
    int i, j, k;
    if (!f) return 0;
    fprintf(f, "x,y,z,radius\n");
    for (k = 0; k < 3; k++)
        for (j = 0; j < 8 - k; j++)
            for (i = 0; i < 8 - k; i++)
                fprintf(f, "%.4f,%.4f,%.4f,%.4f\n", 0.3 + 0.05 * i + 0.025 * k, 0.3 + 0.05 * j + 0.025 * k,
                        0.05 + 0.04 * k, (i + j) % 2 ? 0.025 : 0.02);
    return fclose(f) == 0;
}

/* Their places and volumes; *mass gets the exact one. Returns how many, 0 on failure. */
static int read_points(const char *path, mpm_real x[3][MOST], mpm_real *volume, double *mass)
{
    FILE *f = fopen(path, "r");
    double place[3], radius;
    int n = 0, d;
    if (!f) return 0;
    *mass = 0;
    if (fscanf(f, "x,y,z,radius\n") == 0)
        while (n < MOST && fscanf(f, "%lf,%lf,%lf,%lf", &place[0], &place[1], &place[2], &radius) == 4) {
            for (d = 0; d < 3; d++) x[d][n] = (mpm_real)place[d];
            volume[n] = (mpm_real)(4 * pi / 3 * radius * radius * radius);
            *mass += density * (double)volume[n++];
        }
    fclose(f);
    return n;
}

/* ---- the run ------------------------------------------------------------------------------------------ */

static int failed(const mpm_world *w)
{
    printf("%s: %g, number %lld\n", w->fault.field, (double)w->fault.value, (long long)w->fault.index);
    return 1;
}

static void weigh(const mpm_world *w, int body, const char *name, double exact)
{
    const mpm_totals t = mpm_body_totals(w, body);
    printf("%s: %.4f %% of the exact mass, %.5f kg in %ld points\n", name, 100 * t.mass / exact, t.mass, t.points);
}

int main(int argc, char **argv)
{
    static mpm_real x[3][MOST], volume[MOST];
    static torus ring = {{0.5, 0.5, 0.5}, MPM_R(0.25), MPM_R(0.08)};
    const char *path = argc > 1 ? argv[1] : "07_points.csv";
    const mpm_real low[3] = {MPM_R(0.1), MPM_R(0.1), MPM_R(0.4)}, high[3] = {MPM_R(0.9), MPM_R(0.9), MPM_R(0.6)};
    mpm_desc d = mpm_desc_default();
    mpm_body_desc b = mpm_body_desc_default();
    mpm_material rubber = mpm_material_default();
    double mass;
    mpm_cloud grains = {0, {x[0], x[1], x[2]}, {NULL, NULL, NULL}, NULL, volume, NULL};
    mpm_world w;
    mpm_real dt;
    int k;

    rubber.young = 1e5;
    rubber.poisson = MPM_R(0.3);
    rubber.shear_modulus = rubber.young / MPM_R(2.6);
    rubber.density = (mpm_real)density;
    d.basis = MPM_GIMP;
    d.cell = 0.0625;
    d.cells[0] = d.cells[1] = d.cells[2] = 16;
    d.side[4] = MPM_SIDE_WALL;
    d.gravity[2] = MPM_R(-9.81);
    b.spacing = d.cell / 2;
    b.density = rubber.density;
    b.stress = mpm_material_stress;
    b.material = &rubber;
    b.wave_p = mpm_wave_speed_p(rubber.young, rubber.poisson, rubber.density);
    if (mpm_init(&w, &d, NULL, 0) < 0) return failed(&w);

    b.shape = mpm_shape_user(in_torus, &ring, low, high);
    if (mpm_body_add(&w, &b) < 0) return failed(&w);
    weigh(&w, 0, "ring", density * 2 * pi * pi * 0.25 * 0.08 * 0.08);

    if (!write_points(path)) return 1;
    grains.count = read_points(path, x, volume, &mass);
    remove(path);
    if (grains.count == 0) return 1;
    if (mpm_body_add_points(&w, &b, &grains) < 0) return failed(&w); /* density and all else as b says */
    weigh(&w, 1, "grains", mass);

    dt = mpm_time_step(&w, MPM_R(0.3));
    while (w.time < MPM_R(0.4)) {
        if (w.bodies < 3 && w.time > MPM_R(0.1)) {
            b.shape = mpm_sphere(0.5, 0.5, MPM_R(0.8), MPM_R(0.125));
            if (mpm_body_add(&w, &b) < 0) return failed(&w);
            weigh(&w, 2, "ball, after 0.1 s", density * 4 * pi / 3 * 0.125 * 0.125 * 0.125);
        }
        if (mpm_step(&w, dt) < 0) return failed(&w);
    }
    for (k = 0; k < 3; k++)
        printf("%s now lies between %.3f and %.3f m\n", k == 0 ? "ring" : k == 1 ? "grains" : "ball",
               mpm_body_totals(&w, k).low[2], mpm_body_totals(&w, k).high[2]);
    printf("in all: %.5f kg, %lld points have left\n", mpm_body_totals(&w, -1).mass, (long long)w.retired);
    mpm_free(&w);
    return fflush(stdout) || ferror(stdout); /* 1 if what was printed is lost */
}
