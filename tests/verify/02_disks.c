/* 02_disks - two elastic disks collide (Sulsky, Chen, Schreyer 1994). SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "elastic.h"

static const double radius = 0.2, speed = 0.1; /* of each component of each disk's velocity */
static const double touch = 1.08579;           /* (sqrt(0.5) - 2 radius) / (2 sqrt(2) speed) */

/* How the disks meet. */
typedef struct method {
    const char *name;
    mpm_basis basis;
    mpm_contact_law law;
    int points; /* contact of points: logistic normals and touch; else of nodes */
} method;

typedef struct collision {
    double kinetic_start;           /* per depth */
    double begin, end;              /* when 0.1 % and 99 % of the impulse exchanged have been */
    double least;                   /* least kinetic energy, over the first */
    double kinetic, internal, loss; /* at the end, over the first kinetic energy; lost in contact */
    double restitution;             /* of the mean velocity along the line of centres */
    double momentum;                /* total, over a disk's */
} collision;

/* The disks in the unit square of n x n cells, plane strain, two points per cell and direction. */
static void disks_begin(mpm_world *w, mpm_material *m, int n, const method *how)
{
    const double cell = 1.0 / n;
    mpm_desc d = scene_grid(cell, n, 1, n, 0, 0, 0);
    mpm_body_desc b = scene_body(m, mpm_sphere(MPM_R(0.25), 0, MPM_R(0.25), (mpm_real)radius), cell / 2, speed);
    d.geometry = MPM_PLANE_STRAIN;
    d.basis = how->basis;
    d.scheme = MPM_SCHEME_THESIS;
    d.contact.law = how->law;
    d.contact.touch = how->points;
    if (how->points) d.contact.normal = MPM_NORMAL_LOGISTIC;
    mpm_init(w, &d, NULL, 0);
    b.velocity[0] = (mpm_real)speed;
    mpm_body_add(w, &b);
    b.shape.center[0] = b.shape.center[2] = MPM_R(0.75);
    b.velocity[0] = b.velocity[2] = (mpm_real)-speed;
    mpm_body_add(w, &b);
}

/* Mean velocity of the first disk along the line of centres, over its first. */
static double forward(const mpm_world *w)
{
    return (mean_velocity(w, 0, 0) + mean_velocity(w, 0, 2)) / (2 * speed);
}

static collision collide(int n, const method *how)
{
    enum { MOMENTS = 40000 };
    static double history[MOMENTS];
    mpm_material m = elastic(1000, 0.3, 1000);
    const double dt = 0.17 / n;
    collision r;
    mpm_totals t;
    mpm_world w;
    long i, last = 0;
    memset(&r, 0, sizeof r);
    disks_begin(&w, &m, n, how);
    t = mpm_body_totals(&w, -1);
    r.kinetic_start = t.kinetic;
    r.least = 1;
    while ((double)w.time < 3 && last < MOMENTS && mpm_step(&w, (mpm_real)dt) >= 0) {
        t = mpm_body_totals(&w, -1);
        history[last++] = forward(&w);
        if (t.kinetic < r.least * r.kinetic_start) r.least = t.kinetic / r.kinetic_start;
    }
    r.restitution = -forward(&w);
    for (i = 0; i < last; i++) {
        const double part = (1 - history[i]) / (1 + r.restitution);
        if (part < 0.001) r.begin = dt * (double)(i + 1);
        if (part < 0.99) r.end = dt * (double)(i + 1);
    }
    r.kinetic = t.kinetic / r.kinetic_start;
    r.internal = t.internal / r.kinetic_start;
    r.loss = w.ledger.contact / r.kinetic_start;
    r.momentum = (fabs(t.momentum[0]) + fabs(t.momentum[2])) / (t.mass * speed);
    mpm_free(&w);
    return r;
}

/* Rows for one method and grid. Bodies feel each other when they share a node, from more than a cell; when
   their points touch, to a fraction of one. The disks close a cell, along the diagonal, in `cell`. */
static void rows(const method *how, int n, const collision *r)
{
    const double cell = 1 / (2 * speed * n);
    char line[200];
    snprintf(line, sizeof line, "%s, %d x %d: contact begins", how->name, n, n);
    verify_near(line, "geometry", touch, r->begin, how->points ? cell / 4 : cell);
    verify_near("... kinetic + internal energy afterwards over before", "elastic", 1, r->kinetic + r->internal, 0.02);
    verify_near("... with what the ledger says contact lost", "conserved", 1, r->kinetic + r->internal + r->loss, 0.01);
}

enum { GRIDS = 3 }; /* of 20, 40, 80 cells */

static void remark_table(const method *how, collision (*r)[GRIDS], int all)
{
    char text[4000];
    size_t n = (size_t)snprintf(text, sizeof text,
                                "| method | cells | contact begins | 99 %% of the impulse | least kinetic energy "
                                "| kinetic after | internal after | contact loss | velocity after |\n"
                                "|---|---|---|---|---|---|---|---|---|");
    int i, g;
    for (i = 0; i < all; i++)
        for (g = 0; g < GRIDS; g++) {
            const collision *c = &r[i][g];
            n += (size_t)snprintf(text + n, sizeof text - n,
                                  "\n| %s | %d | %.3f | %.3f | %.3f | %.3f | %.3f | %.4f | %.3f |", how[i].name,
                                  20 << g, c->begin, c->end, c->least, c->kinetic, c->internal, c->loss,
                                  c->restitution);
        }
    verify_remark(text);
}

int main(void)
{
    static const method how[] = {
        {"linear, contact of nodes", MPM_LINEAR, MPM_CONTACT_FRICTION, 0},
        {"GIMP, contact of nodes", MPM_GIMP, MPM_CONTACT_FRICTION, 0},
        {"linear, contact of points", MPM_LINEAR, MPM_CONTACT_FRICTION, 1},
        {"GIMP, contact of points", MPM_GIMP, MPM_CONTACT_FRICTION, 1},
        {"linear, one velocity field", MPM_LINEAR, MPM_CONTACT_WELD, 0},
        {"GIMP, one velocity field", MPM_GIMP, MPM_CONTACT_WELD, 0},
    };
    enum { ALL = sizeof how / sizeof how[0] };
    collision r[ALL][GRIDS], finest;
    double momentum = 0;
    int i, g;
    verify_begin("Two elastic disks",
                 "Two disks (R 0.2, E 1000, nu 0.3, rho 1000) cross a unit square along its diagonal, each at 0.1\n"
                 "sqrt(2), and bounce off each other (Sulsky, Chen and Schreyer 1994; plane strain, frictionless, 2\n"
                 "x 2 points per cell). They touch at t = 1.086. Contact of nodes is the library's default, contact\n"
                 "of points its option (normals by logistic regression, `touch`), one velocity field what MPM\n"
                 "does without contact. Contact begins when a thousandth of the impulse has been exchanged; energies\n"
                 "are over the first kinetic energy. No outside answer is known for the vibration that stays in the\n"
                 "disks: grids are compared.");
    for (i = 0; i < ALL; i++)
        for (g = 0; g < GRIDS; g++) {
            r[i][g] = collide(20 << g, &how[i]);
            momentum = r[i][g].momentum > momentum ? r[i][g].momentum : momentum;
        }
    verify_percent("kinetic energy of the disks per depth, 20 x 20", "m v^2 / 2", 2.51327, r[0][0].kinetic_start, 1);
    verify_percent("... 80 x 80", "m v^2 / 2", 2.51327, r[0][2].kinetic_start, 1);
    verify_near("total momentum over a disk's, worst of 18 runs", "conserved", 0, momentum, 1e-12);
    for (i = 0; i < ALL; i++) {
        rows(&how[i], 20, &r[i][0]);
        rows(&how[i], 80, &r[i][2]);
    }
    finest = collide(160, &how[3]);
    verify_percent("GIMP, contact of points, 80 x 80: velocity after over before", "160 x 160", finest.restitution,
                   r[3][2].restitution, 2);
    remark_table(how, r, ALL);
    verify_remark("On the grid of 20 cells the lattice of points has 3.4 % too much mass, hence energy. Bodies that\n"
                  "share a node feel each other: contact begins more than a cell early there, with real contact as\n"
                  "with one velocity field, and the pair then returns more energy than it took, 3 to 6 %. All of it\n"
                  "falls in proportion to the cell, and the ledger accounts for it. With contact of points the time\n"
                  "is right to a quarter of a cell, the coarse grid loses 2 to 3 % instead, and with GIMP the energy\n"
                  "is right to 0.1 % from 40 cells on. The velocity after is then that of the finest grid to 1 %;\n"
                  "linear functions leave more vibration, from points that cross cells.");
    return verify_end();
}
