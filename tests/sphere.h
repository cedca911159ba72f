/* sphere.h - the elastic sphere that is pressed on a smooth rigid plane: Hertz's theory takes it for a half space, here
   it has its size. Its surface moves under a pressure on a cap as a series of spherical harmonics says (Lur'e,
   Three-dimensional Problems of the Theory of Elasticity, 1964, chapter 6), with the force borne by inertia, as in an
   impact. SPDX-License-Identifier: MIT */
#ifndef SPHERE_H
#define SPHERE_H

#include <math.h>
#include <string.h>

#define SPHERE_MODES 1500
#define SPHERE_SHAPES 4    /* pressures (1 - s^2/a^2)^(k + 1/2) on the cap s < a */
#define SPHERE_PLACES 800  /* rings of the cap */

/* Surface displacement u_r P_n, u_t dP_n/dt (t: the angle from the pole) under tractions p P_n and q dP_n/dt, for
   radius 1 and shear modulus 1, seen from the centre of mass. */
static inline void sphere_mode(double nu, int n, double p, double q, double *u_r, double *u_t)
{
    const double m = (double)n * n;
    if (n == 0) { /* uniform pressure */
        *u_r = p * (1 - 2 * nu) / (2 * (1 + nu));
        *u_t = 0;
    } else if (n == 1) { /* c r^2 along the axis for the body force, B: the mode of no body force; less their mean */
        const double c = (p + 2 * q) * (1 - 2 * nu) / (8 - 12 * nu), B = (q / 2 - c) / (2 + 2 * nu);
        const double mean = 0.6 * c + 2 * B;
        *u_r = c + B * (8 * nu - 2) - mean;
        *u_t = c + B * (6 - 4 * nu) - mean;
    } else { /* A grad(r^n P_n), and B: the one of dilatation */
        const double shear_B = m + 2 * n - 1 + 2 * nu, normal_A = (double)n * (n - 1);
        const double normal_B = (n + 1) * (m - n - 2 - 2 * nu), det = (n - 1) * normal_B - shear_B * normal_A;
        const double A = (q * normal_B - shear_B * p) / (2 * det), B = ((n - 1) * p - normal_A * q) / (2 * det);
        *u_r = A * n + B * (n + 1) * (n - 2 + 4 * nu);
        *u_t = A + B * (n + 5 - 4 * nu);
    }
}

/* P_n and dP_n/dt at angle t, from those of n - 1 and n - 2 in P. */
static inline void sphere_legendre(int n, double t, double *P, double *slope)
{
    const double x = cos(t), next = n == 0 ? 1 : n == 1 ? x : ((2 * n - 1) * x * P[0] - (n - 1) * P[1]) / n;
    *slope = n == 0 ? 0 : sin(t) * n * (x * next - P[0]) / (1 - x * x);
    P[1] = P[0];
    P[0] = next;
}

/* Harmonics of unit pressures along the axis on the cap of half angle `edge`, and their forces. */
static inline void sphere_pressures(double edge, double (*p)[SPHERE_MODES], double (*q)[SPHERE_MODES], double *force)
{
    const double half_pi = 2 * atan(1.0);
    int i, k, n;
    for (i = 0; i < SPHERE_PLACES; i++) {
        const double turn = half_pi * (i + 0.5) / SPHERE_PLACES, t = edge * sin(turn);
        const double ring = edge * cos(turn) * half_pi / SPHERE_PLACES * sin(t), s = sin(t) / sin(edge);
        double P[2] = {0, 0}, slope, shape[SPHERE_SHAPES];
        for (k = 0; k < SPHERE_SHAPES; k++) {
            shape[k] = ring * pow(1 - s * s, k + 0.5);
            force[k] += 4 * half_pi * shape[k];
        }
        for (n = 0; n < SPHERE_MODES; n++) {
            sphere_legendre(n, t, P, &slope);
            for (k = 0; k < SPHERE_SHAPES; k++) {
                p[k][n] -= (2 * n + 1) / 2.0 * shape[k] * P[0] * cos(t);
                if (n > 0) q[k][n] += (2 * n + 1) / (2.0 * n * (n + 1)) * shape[k] * slope * sin(t);
            }
        }
    }
}

/* Solves rows of SPHERE_SHAPES + 1 unknowns and a right hand side, which becomes the solution. */
static inline void sphere_solve(double (*row)[SPHERE_SHAPES + 2])
{
    enum { SIZE = SPHERE_SHAPES + 1 };
    int i, j, k;
    for (i = 0; i < SIZE; i++) {
        double swap[SIZE + 1];
        for (j = k = i; j < SIZE; j++)
            if (fabs(row[j][i]) > fabs(row[k][i])) k = j;
        memcpy(swap, row[i], sizeof swap);
        memcpy(row[i], row[k], sizeof swap);
        if (k != i) memcpy(row[k], swap, sizeof swap);
        for (k = SIZE; k >= i; k--) row[i][k] /= row[i][i];
        for (j = 0; j < SIZE; j++)
            for (k = SIZE; j != i && k >= i; k--) row[j][k] -= row[j][i] * row[i][k];
    }
}

/* The sphere of radius 1 and shear modulus 1 that touches the plane within the half angle `edge`: force, and approach
   of its centre of mass to the plane. */
static inline void sphere_pressed(double nu, double edge, double *force, double *approach)
{
    static double p[SPHERE_SHAPES][SPHERE_MODES], q[SPHERE_SHAPES][SPHERE_MODES];
    double row[SPHERE_SHAPES + 1][SPHERE_SHAPES + 2], of[SPHERE_SHAPES] = {0}, u_r, u_t, slope;
    int i, k, n;
    memset(p, 0, sizeof p);
    memset(q, 0, sizeof q);
    memset(row, 0, sizeof row);
    sphere_pressures(edge, p, q, of);
    for (i = 0; i <= SPHERE_SHAPES; i++) { /* places where the surface lies on the plane */
        const double t = edge * (0.02 + 0.93 * i / SPHERE_SHAPES);
        double P[2] = {0, 0};
        for (n = 0; n < SPHERE_MODES; n++) {
            sphere_legendre(n, t, P, &slope);
            for (k = 0; k < SPHERE_SHAPES; k++) {
                sphere_mode(nu, n, p[k][n], q[k][n], &u_r, &u_t);
                row[i][k] += u_r * P[0] * cos(t) - u_t * slope * sin(t);
            }
        }
        row[i][SPHERE_SHAPES] = 1;
        row[i][SPHERE_SHAPES + 1] = 1 - cos(t);
    }
    sphere_solve(row);
    *approach = row[SPHERE_SHAPES][SPHERE_SHAPES + 1];
    for (*force = 0, k = 0; k < SPHERE_SHAPES; k++) *force += of[k] * row[k][SPHERE_SHAPES + 1];
}

/* kappa: by how much the approach is less than Hertz's, d = d_Hertz (1 - kappa a/R) with his a for the same force; that
   part is in proportion to the force. */
static inline double sphere_stiffening(double nu, double edge)
{
    const double reduced = 2 / (1 - nu); /* E/(1 - nu^2) over the shear modulus */
    double force, approach, a;
    sphere_pressed(nu, edge, &force, &approach);
    a = cbrt(0.75 * force / reduced);
    return (1 - approach / (a * a)) / a;
}

/* Impact on the plane: greatest force and duration over Hertz's, where he has the contact radius a/R at the end. With
   s^3 the force over his greatest one: approach s^2 - k s^3, energy s^5 - (5/4) k s^6 over the kinetic one. */
static inline void sphere_impact(double nu, double a, double *force, double *duration)
{
    const double k = a * sphere_stiffening(nu, a);
    const int steps = 20000;
    double s = 1, time = 0;
    int i;
    for (i = 0; i < 50; i++) s -= (pow(s, 5) - 1.25 * k * pow(s, 6) - 1) / (5 * pow(s, 4) - 7.5 * k * pow(s, 5));
    *force = s * s * s;
    for (i = 0; i < steps; i++) { /* at s sin(x): evenly, where the speed goes to 0 */
        const double x = 2 * atan(1.0) * (i + 0.5) / steps, y = s * sin(x);
        const double speed = sqrt(1 - pow(y, 5) + 1.25 * k * pow(y, 6));
        time += (2 * y - 3 * k * y * y) * s * cos(x) / speed * (2 * atan(1.0) / steps);
    }
    *duration = 2 * time / 2.94327;
}

#endif
