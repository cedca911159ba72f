/* 08_absorbing - what the viscous damper of a cut face gives back (A 3.45, 3.46): plane P and S waves
   against their angle of incidence, the damper factors, and the area the dampers stand for.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "scene.h"
#include "verify.h"

#include <complex.h>

#define PI 3.14159265358979323846

enum { P_WAVE, S_WAVE, WAVES = 60 };

/* One case: a packet of P or S waves that falls on the bottom of a plate between two mirrors. */
typedef struct packet {
    int wave;
    double angle;      /* of incidence, degrees, of the packet's middle */
    int width;         /* of the plate, cells: half a wave length along the surface; angle 0: any */
    double length;     /* wave length in cells where the angle is 0 */
    double a, b;       /* damper factors */
} packet;

/* A solid in units where its P speed, density and the cell are 1. */
typedef struct solid {
    double lambda, mu, vp, vs;
} solid;

/* ---- theory ---------------------------------------------------------------------------------- */

/* Plane waves exp(i w (t - s.x)) at z = 0, the solid above. With slowness sx along the surface:
   incident P (sin, -cos), reflected P (sin, cos), SV with displacement (cos, -sin) going up. Each has,
   per amplitude and per i w, the velocity d and the stress - C : (d s). The damper wants
   s_zz = a rho Vp v_z and s_xz = b rho Vs v_x, two equations for the two reflected amplitudes. */
typedef struct mode {
    double complex vx, vz, szz, sxz, flux;
} mode;

static mode mode_of(const solid *m, int wave, int up, double sx)
{
    const double slowness = 1 / (wave == P_WAVE ? m->vp : m->vs);
    const double complex root = csqrt(slowness * slowness - sx * sx); /* -i beyond the critical angle: */
    const double complex sz = cimag(root) > 0 ? -root : root;        /* the wave dies away upwards */
    const double complex kz = up ? sz : -sz;
    mode w;
    w.vx = (wave == P_WAVE ? sx : up ? kz : -kz) / slowness;
    w.vz = (wave == P_WAVE ? kz : up ? -sx : sx) / slowness;
    w.szz = -(m->lambda * (w.vx * sx + w.vz * kz) + 2 * m->mu * w.vz * kz);
    w.sxz = -m->mu * (w.vx * kz + w.vz * sx);
    w.flux = creal(sz) / slowness / slowness; /* of energy, along z: speed times cosine */
    return w;
}

/* Share of the incident energy that comes back, as P and SV together. */
static double returned(const solid *m, const packet *k, double sine)
{
    const double sx = sine / (k->wave == P_WAVE ? m->vp : m->vs), zp = k->a * m->vp, zs = k->b * m->vs;
    const mode in = mode_of(m, k->wave, 0, sx), p = mode_of(m, P_WAVE, 1, sx), s = mode_of(m, S_WAVE, 1, sx);
    const double complex ip = zp * in.vz - in.szz, is = zs * in.vx - in.sxz;
    const double complex pp = p.szz - zp * p.vz, ps = s.szz - zp * s.vz;
    const double complex sp = p.sxz - zs * p.vx, ss = s.sxz - zs * s.vx;
    const double complex det = pp * ss - ps * sp;
    const double P = cabs((ip * ss - ps * is) / det), S = cabs((pp * is - ip * sp) / det);
    return (P * P * creal(p.flux) + S * S * creal(s.flux)) / creal(in.flux);
}

/* ---- the packet ------------------------------------------------------------------------------ */

/* A Gaussian sum of plane waves of one kx, each exact: its field, and the theory's answer for it. */
typedef struct spectrum {
    double kx, kz[WAVES], weight[WAVES];
    double middle, deviation;          /* of the packet along z, at the start */
    double returned;
} spectrum;

static spectrum spectrum_of(const solid *m, const packet *k)
{
    const double angle = k->angle * PI / 180, kx = angle > 0 ? PI / k->width : 0;
    const double kz = angle > 0 ? kx / tan(angle) : 2 * PI / k->length;
    double energy = 0;
    spectrum s;
    int i;
    s.kx = kx;
    s.deviation = 2 * PI / kz;
    s.middle = 4 * s.deviation;
    s.returned = 0;
    for (i = 0; i < WAVES; i++) {
        const double off = 5.0 * (2 * i + 1 - WAVES) / WAVES; /* in deviations of the spectrum */
        const double here = s.kz[i] = kz + off / s.deviation;
        const double k2 = kx * kx + here * here;
        s.weight[i] = exp(-off * off / 2);
        energy += s.weight[i] * s.weight[i] * k2;
        s.returned += s.weight[i] * s.weight[i] * k2 * returned(m, k, kx / sqrt(k2));
    }
    s.returned /= energy;
    return s;
}

/* Displacement and velocity, both x then z, at (x, z): mirror pairs of downward waves. */
static void field_at(const solid *m, const packet *k, const spectrum *s, double x, double z, double *u)
{
    const double cx = cos(s->kx * x), sx = sin(s->kx * x);
    int i;
    memset(u, 0, 4 * sizeof *u);
    for (i = 0; i < WAVES; i++) {
        const double kz = s->kz[i], kk = sqrt(s->kx * s->kx + kz * kz), alpha = kz * (z - s->middle);
        const double omega = kk * (k->wave == P_WAVE ? m->vp : m->vs), A = 1e-6 / WAVES * s->weight[i];
        const double dx = k->wave == P_WAVE ? s->kx / kk : kz / kk, dz = k->wave == P_WAVE ? -kz / kk : s->kx / kk;
        const double ca = cos(alpha), sa = sin(alpha);
        /* u = A (dx sin(alpha + omega t) sin(kx x), dz cos(alpha + omega t) cos(kx x)) */
        u[0] += A * dx * sa * sx;
        u[1] += A * dz * ca * cx;
        u[2] += A * omega * dx * ca * sx;
        u[3] -= A * omega * dz * sa * cx;
    }
}

/* The points' state, as the grid would have made it from its nodes: sampled from the waves themselves,
   velocity and stress would hold variations within a cell that the grid does not see and cannot move.
   Strains near 1e-6: linear elasticity. */
static void load(mpm_world *w, const solid *m, const packet *k, const spectrum *s)
{
    mpm_points *p = &w->points;
    int32_t i;
    for (i = 0; i < p->count; i++) {
        const double x = floor((double)p->x[0][i]), z = floor((double)p->x[2][i]);
        const double fx = (double)p->x[0][i] - x, fz = (double)p->x[2][i] - z;
        double v[2] = {0, 0}, xx = 0, zz = 0, xz = 0, trace;
        int n;
        for (n = 0; n < 4; n++) {
            const int right = n & 1, up = n >> 1;
            const double nx = right ? fx : 1 - fx, nz = up ? fz : 1 - fz;
            const double gx = (right ? 1 : -1) * nz, gz = (up ? 1 : -1) * nx;
            double u[4];
            field_at(m, k, s, x + right, z + up, u);
            xx += gx * u[0];
            zz += gz * u[1];
            xz += (gz * u[0] + gx * u[1]) / 2;
            v[0] += nx * nz * u[2];
            v[1] += nx * nz * u[3];
        }
        trace = xx + zz;
        p->v[0][i] = (mpm_real)v[0];
        p->v[2][i] = (mpm_real)v[1];
        p->stress[0][i] = (mpm_real)(m->lambda * trace + 2 * m->mu * xx);
        p->stress[1][i] = (mpm_real)(m->lambda * trace);
        p->stress[2][i] = (mpm_real)(m->lambda * trace + 2 * m->mu * zz);
        p->stress[4][i] = (mpm_real)(2 * m->mu * xz);
        p->density[i] /= (mpm_real)(1 + trace);
        p->energy[i] = (mpm_real)(m->lambda * trace * trace / 2 + m->mu * (xx * xx + zz * zz + 2 * xz * xz));
    }
}

static mpm_material unit_solid(solid *m)
{
    mpm_material al = mpm_material_default();
    al.density = 1;
    al.poisson = MPM_R(0.33);
    al.young = (1 + al.poisson) * (1 - 2 * al.poisson) / (1 - al.poisson);
    al.shear_modulus = al.young / (2 * (1 + al.poisson));
    m->mu = al.shear_modulus;
    m->lambda = al.young * al.poisson / ((1 + al.poisson) * (1 - 2 * al.poisson));
    m->vp = 1;
    m->vs = sqrt(m->mu);
    return al;
}

static double energy_of(const mpm_world *w)
{
    const mpm_totals t = mpm_body_totals(w, -1);
    return t.kinetic + t.internal;
}

/* A plate with the packet in it, on a damped bottom z = 0, between mirrors. Returns 1, or 0. */
static int plate(mpm_world *w, const solid *m, mpm_material *al, const packet *k, const spectrum *s)
{
    const int height = (int)ceil((k->wave == P_WAVE ? 8 : 10) * s->deviation);
    mpm_desc d = scene_grid(1, k->width, 1, height + 4, 0, 0, -2);
    mpm_body_desc b = scene_body(al, mpm_box(0, 0, 0, (mpm_real)k->width, 1, (mpm_real)height), 0.5, 0);
    d.geometry = MPM_PLANE_STRAIN;
    d.side[0] = d.side[1] = MPM_SIDE_SYMMETRY;
    b.absorb = MPM_FACE_BOTTOM;
    b.absorb_normal = (mpm_real)k->a;
    b.absorb_shear = (mpm_real)k->b;
    if (mpm_init(w, &d, NULL, 0) != MPM_OK || mpm_body_add(w, &b) != MPM_OK) return 0;
    load(w, m, k, s);
    return 1;
}

/* Runs while the packet goes `way` deviations along z: after 8 all of it has met the bottom (9 with the
   grid's slower waves); after 10 nothing that came back has met it again. */
static int bounce(mpm_world *w, const solid *m, const packet *k, const spectrum *s, double way)
{
    const double speed = (k->wave == P_WAVE ? m->vp : m->vs) * cos(k->angle * PI / 180);
    while ((double)w->time * speed < way * s->deviation)
        if (mpm_step(w, MPM_R(0.3)) < 0) return 0;
    return 1;
}

/* Measured: the share of the packet's energy that comes back. */
static double energy_back(const solid *m, mpm_material *al, const packet *k)
{
    const spectrum s = spectrum_of(m, k);
    mpm_world w;
    double before, after = NAN;
    if (!plate(&w, m, al, k, &s)) return NAN;
    before = energy_of(&w);
    if (bounce(&w, m, k, &s, 10)) after = energy_of(&w);
    mpm_free(&w);
    return after / before;
}

/* Measured at normal incidence: the signed ratio of the velocities that come and go, by projection on
   the wave that a free face sends back, g(t - z) for g(t + z). */
static double amplitude_back(const solid *m, mpm_material *al, const packet *k)
{
    const spectrum s = spectrum_of(m, k);
    double product = 0, square = 0, u[4];
    mpm_world w;
    int32_t i;
    if (!plate(&w, m, al, k, &s)) return NAN;
    if (!bounce(&w, m, k, &s, 8)) square = NAN;
    for (i = 0; i < w.points.count; i++) {
        field_at(m, k, &s, 0, (double)w.time - (double)w.points.x[2][i], u);
        product += u[3] * (double)w.points.v[2][i];
        square += u[3] * u[3];
    }
    mpm_free(&w);
    return product / square;
}

/* ---- areas ----------------------------------------------------------------------------------- */

/* The damping force on a cylinder that moves as a whole with velocity 1 along `axis`, per rho V and
   velocity: the area that acts. Factors a and b choose normal and tangential dampers. */
static double area_acting(mpm_material *al, int absorb, double a, double b, int axis, double radius, double height,
                          double spacing, int quarter)
{
    mpm_desc d = scene_grid(1.5, 24, 24, 12, -18, -18, -15);
    const mpm_shape shape = mpm_cylinder(0, 0, (mpm_real)-height, (mpm_real)radius, (mpm_real)height);
    mpm_body_desc c = scene_body(al, shape, spacing, 0);
    double force = NAN;
    mpm_world w;
    if (quarter) {
        d.cells[0] = d.cells[1] = 12;
        d.origin[0] = d.origin[1] = 0;
        d.side[0] = d.side[2] = MPM_SIDE_SYMMETRY;
    }
    c.velocity[axis] = 1;
    c.absorb = absorb;
    c.absorb_normal = (mpm_real)(a / (double)c.wave_p);
    c.absorb_shear = (mpm_real)(b / (double)c.wave_s);
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK) return NAN;
    if (mpm_body_add(&w, &c) == MPM_OK && mpm_locate(&w, 1) == MPM_OK) {
        mpm_p2g(&w);
        mpm_forces(&w);
        force = -w.ledger.impulse[axis] / (double)c.density;
    }
    mpm_free(&w);
    return quarter ? 4 * force : force;
}

static void areas(mpm_material *al)
{
    const double R = 15, H = 10, bottom = PI * R * R, side = 2 * PI * R * H;
    verify_percent("bottom, moved along z: pi R^2", "geometry", bottom,
                   area_acting(al, MPM_FACE_BOTTOM, 1, 0, 2, R, H, 0.75, 0), 1e-10);
    verify_percent("circumference, moved along z: 2 pi R H", "geometry", side,
                   area_acting(al, MPM_FACE_RIM, 0, 1, 2, R, H, 0.75, 0), 1e-10);
    verify_percent("both: 2 pi R H + pi R^2", "geometry", side + bottom,
                   area_acting(al, MPM_FACE_RIM | MPM_FACE_BOTTOM, 1, 1, 2, R, H, 0.75, 0), 1e-10);
    verify_percent("both, of a quarter, times 4", "geometry", side + bottom,
                   area_acting(al, MPM_FACE_RIM | MPM_FACE_BOTTOM, 1, 1, 2, R, H, 0.75, 1), 1e-10);
    verify_percent("both, R = 13.3, H = 9.1, spacing 1.1", "geometry", 2 * PI * 13.3 * 9.1 + PI * 13.3 * 13.3,
                   area_acting(al, MPM_FACE_RIM | MPM_FACE_BOTTOM, 1, 1, 2, 13.3, 9.1, 1.1, 0), 1e-10);
    verify_percent("circumference, moved along x: normal part, pi R H", "integral of cos^2", side / 2,
                   area_acting(al, MPM_FACE_RIM, 1, 0, 0, R, H, 0.75, 0), 1e-10);
    verify_percent("circumference, moved along y: tangential part, pi R H", "integral of sin^2", side / 2,
                   area_acting(al, MPM_FACE_RIM, 0, 1, 1, R, H, 0.75, 0), 1e-10);
}

/* ---- the section ----------------------------------------------------------------------------- */

/* One angle, on two grids: the shortest wave, the shear wave, spans 10 and 20 cells. */
static void oblique(const solid *m, mpm_material *al, packet k)
{
    const double exact = returned(m, &k, sin(k.angle * PI / 180));
    char what[100], source[100];
    double coarse, fine, theory = spectrum_of(m, &k).returned;
    coarse = energy_back(m, al, &k);
    k.width *= 2;
    k.length *= 2;
    fine = energy_back(m, al, &k);
    snprintf(what, sizeof what, "%s wave at %g degrees%s, cell to 0", k.wave == P_WAVE ? "P" : "S", k.angle,
             k.b < 1 ? ", b = 0.5" : "");
    snprintf(source, sizeof source, "theory of this packet; of one plane wave: %.5f", exact);
    verify_near(what, source, theory, (4 * fine - coarse) / 3, 0.005);
    verify_measured("... 10 cells per shear wave", "", coarse);
    verify_measured("... 20 cells per shear wave", "", fine);
}

/* What the grid adds, and what the theory says where no packet was sent. */
static void returned_beyond(const solid *m)
{
    const packet p = {P_WAVE, 0, 1, 0, 1, 1}, v = {S_WAVE, 0, 1, 0, 1, 1};
    char text[800];
    snprintf(text, sizeof text,
             "The dampers act half a spacing inside the face, on the grid's smoothed velocity: at normal incidence "
             "a wave of k radians per unit length comes back with amplitude 0.165 k h (h the cell), its energy with "
             "h^2, on top of what theory sends back. Theory at 75 and 85 degrees: P %.1f and %.1f %%, S %.1f and "
             "%.1f %% of the energy: dampers are good up to about 60 degrees and no absorbers of surface waves.",
             100 * returned(m, &p, sin(75 * PI / 180)), 100 * returned(m, &p, sin(85 * PI / 180)),
             100 * returned(m, &v, sin(75 * PI / 180)), 100 * returned(m, &v, sin(85 * PI / 180)));
    verify_remark(text);
}

int main(void)
{
    const packet angles[] = {
        {P_WAVE, 0, 1, 20, 1, 1},  {P_WAVE, 15, 38, 0, 1, 1}, {P_WAVE, 30, 20, 0, 1, 1}, {P_WAVE, 45, 14, 0, 1, 1},
        {P_WAVE, 60, 12, 0, 1, 1}, {S_WAVE, 10, 29, 0, 1, 1}, {S_WAVE, 20, 15, 0, 1, 1}, {S_WAVE, 40, 8, 0, 1, 1},
        {S_WAVE, 60, 6, 0, 1, 1},  {S_WAVE, 10, 29, 0, 1, 0.5}};
    const double factor[] = {0, 0.5, 1, 2};
    solid m;
    mpm_material al = unit_solid(&m);
    char text[64];
    int i;
    verify_begin(
        "Viscous dampers of a cut face",
        "A damper pulls at the points of a cut face with -a rho Vp v_n and -b rho Vs v_t times the area they stand for "
        "(A 3.45, 3.46). It swallows a plane P wave at normal incidence whole; at an angle it cannot. Elastic waves of "
        "small amplitude (Poisson's ratio 0.33) fall on the damped bottom of a plate in plane strain. Two mirrors make "
        "the plate endless: a packet of pairs of plane waves with one wave number along the face, Gaussian in the "
        "other direction. Expected is the share of energy that the boundary conditions s_zz = a rho Vp v_z, "
        "s_xz = b rho Vs v_x send back as P and SV waves, for each plane wave of the packet, summed. Tolerance: "
        "0.5 % of the incident energy once the cell is extrapolated to 0. Not shown: strong waves, yielding "
        "material, waves on the curved "
        "face.");
    for (i = 0; i < 4; i++) {
        packet k = {P_WAVE, 0, 1, 160, 0, 1};
        k.a = factor[i];
        snprintf(text, sizeof text, "velocity returned, normal P wave, a = %g", k.a);
        verify_near(text, "(1 - a)/(1 + a)", (1 - k.a) / (1 + k.a), amplitude_back(&m, &al, &k), 0.002);
    }
    verify_remark("Waves of 160 cells; a free face (a = 0) sends everything back.");
    for (i = 0; i < 10; i++) oblique(&m, &al, angles[i]);
    returned_beyond(&m);
    areas(&al);
    verify_remark("The force on a whole stair-stepped cylinder (cell 1.5) in uniform motion, divided by rho V and "
                  "by the velocity: dampers act on the true area, and round the circumference on its true normals.");
    return verify_end();
}
