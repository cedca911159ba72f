/* 72_method - docs/method.md stays true: its worked point is what examples/00_step.c computes, and its lines of code
   are that file's. `72_method print` writes the worked point. SPDX-License-Identifier: MIT */
#include "check.h"
#include "files.h"

#include <stdarg.h>
#include <stdlib.h>

#define main step_main
#include "00_step.c"
#undef main

static char block[8000];

static void say(const char *format, ...)
{
    const size_t n = strlen(block);
    va_list list;
    va_start(list, format);
    vsnprintf(block + n, sizeof block - n, format, list);
    va_end(list);
}

/* A number whose round-off does not show. */
static double tidy(double a) { return fabs(a) < 1e-9 ? 0 : a; }

/* What the worked point touches, before and after the phases. */
static const point *chosen;
static node *reached[8];
static shape weight[8];
static int touches;

static void note(point *p, node *n, const shape *s)
{
    if (p != chosen) return;
    reached[touches] = n;
    weight[touches++] = *s;
}

/* The point that began at (5.75, 5.25, 4.75): in the ball's lowest layer, off its axis. */
static point *choose(void)
{
    int p;
    fill();
    for (p = 0; p < count; p++)
        if (fabs(points[p].x[0] - 5.75) + fabs(points[p].x[1] - 5.25) + fabs(points[p].x[2] - 4.75) < 1e-9) break;
    return &points[p];
}

static const char *place(const node *n)
{
    static char text[20];
    const int i = (int)((n - nodes) % NODES);
    snprintf(text, sizeof text, "%d %d %d", i % NX, i / NX % NY, i / NX / NY);
    return text;
}

static void say_point(const char *when, const point *p)
{
    say("%s\n", when);
    say("    x     = %.4f %.4f %.4f um, v = %.3f %.3f %.3f m/s, rho = %.6f ng/um3\n", p->x[0], p->x[1], p->x[2],
        tidy(p->v[0]), tidy(p->v[1]), tidy(p->v[2]), p->density);
    say("    sigma = xx %.1f, yy %.1f, zz %.1f, yz %.1f, xz %.1f, xy %.1f MPa\n", p->stress[0][0], p->stress[1][1],
        p->stress[2][2], p->stress[1][2], p->stress[0][2], p->stress[0][1]);
}

/* One row per node: before and after forces, and after contact. */
static void say_nodes(const node *summed, const node *pushed)
{
    int c;
    say("its nodes N       dN/dx    dN/dy    dN/dz    m_I, pg   P_z, pg m/s  f_z, uN    P_z + f_z dt  after contact\n");
    for (c = 0; c < 8; c++)
        say("    %s %.5f %8.5f %8.5f %8.5f  %.5f  %11.4f  %10.4f  %12.4f  %13.4f\n", place(reached[c]), weight[c].N,
            weight[c].G[0], weight[c].G[1], weight[c].G[2], 1e3 * summed[c].mass, 1e3 * summed[c].momentum[2],
            summed[c].force[2], 1e3 * pushed[c].momentum[2], 1e3 * reached[c]->momentum[2]);
}

/* What happened where node a of the ball meets that of the block; pa, pb: their momenta before. */
static void say_contact(const node *a, const double *pa, const double *pb)
{
    const node *b = a + NODES;
    const double size = -sqrt(dot(b->gradient, b->gradient));
    const double n[3] = {b->gradient[0] / size, b->gradient[1] / size, b->gradient[2] / size};
    say("contact at node %s, in pg and pg m/s\n", place(a));
    say("    m_a = %.5f, P_a = %.4f %.4f %.4f\n", 1e3 * a->mass, 1e3 * pa[0], tidy(1e3 * pa[1]), 1e3 * pa[2]);
    say("    m_b = %.5f, P_b = %.4f %.4f %.4f\n", 1e3 * b->mass, 1e3 * pb[0], tidy(1e3 * pb[1]), 1e3 * pb[2]);
    say("    n   = -g_b / |g_b| = %.5f %.5f %.5f\n", n[0], tidy(n[1]), n[2]);
    say("    j   = (m_b P_a - m_a P_b) . n / (m_a + m_b) = %.4f > 0: they approach\n",
        1e3 * (b->mass * dot(pa, n) - a->mass * dot(pb, n)) / (a->mass + b->mass));
    say("    P_a - j n = %.4f %.4f %.4f\n", 1e3 * a->momentum[0], tidy(1e3 * a->momentum[1]), 1e3 * a->momentum[2]);
}

/* Step 101 of the story, phase by phase. */
static void worked_point(void)
{
    node summed[8], pushed[8];
    double other[3];
    point *p = choose();
    int c, i;
    for (c = 0; c < 100; c++) step();
    chosen = p;
    memset(nodes, 0, sizeof nodes);
    each(note);
    say_point("the point after 100 steps, t = 0.8 ns", p);
    each(p2g);
    each(forces);
    for (c = 0; c < 8; c++) summed[c] = *reached[c];
    for (i = 0; i < 2 * NODES; i++) grid_update(&nodes[i]);
    for (c = 0; c < 8; c++) pushed[c] = *reached[c];
    for (i = 0; i < 3; i++) other[i] = reached[1][NODES].momentum[i];
    each(gradient);
    for (i = 0; i < NODES; i++) contact(&nodes[i], &nodes[NODES + i]);
    say_nodes(summed, pushed);
    say_contact(reached[1], pushed[1].momentum, other);
    each(g2p);
    each(musl);
    each(strain);
    say("v_I from the new velocities of the points, z, m/s\n   ");
    for (c = 0; c < 8; c++) say(" %.3f", reached[c]->velocity[2]);
    say("\nL = dt sum v_I grad N, 1e-3\n");
    for (i = 0; i < 3; i++) say("    %8.4f %8.4f %8.4f\n", 1e3 * p->L[i][0], 1e3 * p->L[i][1], 1e3 * p->L[i][2]);
    for (i = 0; i < count; i++) stress(&points[i]);
    each(move);
    say_point("the point after 101 steps", p);
}

/* ---- the page ------------------------------------------------------------------------------------------------- */

static char page[100000], source[20000];

/* Each block of C on the page, from ```c to ```, is to be found in the source. */
static void excerpts(void)
{
    char *from = page, *to;
    int n = 0;
    while ((from = strstr(from, "```c\n")) != NULL && (to = strstr(from + 5, "```")) != NULL) {
        char line[80];
        *to = 0;
        from += 5;
        snprintf(line, sizeof line, "in 00_step.c: %.50s", from);
        if (strchr(line, '\n')) *strchr(line, '\n') = 0;
        CHECK_TRUE(line, strstr(source, from) != NULL);
        from = to + 3;
        n++;
    }
    CHECK_TRUE("the page shows every phase", n >= 9);
}

int main(int n, char **arguments)
{
    worked_point();
    if (n > 1 && !strcmp(arguments[1], "print")) {
        fputs(block, stdout);
        return 0;
    }
    CHECK_TRUE("docs/method.md", contents("docs/method.md", page, sizeof page) > 1000);
    CHECK_TRUE("examples/00_step.c", contents("examples/00_step.c", source, sizeof source) > 1000);
    CHECK_TRUE("the worked point on the page is what the step computes", strstr(page, block) != NULL);
    excerpts();
    return check_end();
}
