/* mpm_ptw.h - the material: strength, melting, equation of state and stress update of metals at
   impact rates. Version 0.2.0. SPDX-License-Identifier: MIT

   DO THIS
     In ONE source file:                          everywhere else:
       #define MPM_IMPLEMENTATION                   #include "mpm_ptw.h"
       #include "mpm_ptw.h"
     Fill a material, check it, and hand mpm_material_stress with a pointer to it to a body. Link with -lm.

   WHAT IT DOES NOT DO
     No heat conduction, no thermal expansion beyond the Grueneisen term, no temperature rise from
     compression unless compression_heating asks for it (otherwise only plastic work heats, as in
     A 3.44), no latent heat, no fracture or spall, no porosity, no phase change other than the loss
     of strength at the melting point, no kinematic hardening, no anisotropy.

   A COMPLETE PROGRAM
       #define MPM_IMPLEMENTATION
       #include "mpm_ptw.h"
       #include <stdio.h>
       int main(void) {
           mpm_material al;
           mpm_material_state s = {0.1, 1e6, 300, 2700, 0};
           mpm_units si = mpm_units_si();
           if (mpm_material_preset(&al, "al", &si, NULL) < 0) return 1;
           printf("%g MPa\n", 1e-6 * mpm_material_flow_stress(&al, &s));
           return 0;
       }

   CONTENTS
     choices                   the lists MPM_STRENGTH_LIST, MPM_SHEAR_LIST, MPM_MELT_LIST, MPM_EOS_LIST, ...
     functions in lanes        mpm_lane_exp, _expm1, _log, _pow, _erf: for laws over arrays
     parameters                mpm_material; laws of your own: mpm_strength_fn, mpm_eos_fn
     presets                   mpm_material_default, _preset, _model, _preset_count, _preset_name, _check
     the laws, one point       _flow, _flow_stress, _shear_modulus, _melt_temperature, _melting_point, _melts_at,
                               _attempt_rate, _pressure, _hugoniot_pressure, _wave_speeds
     the update, a block       mpm_material_stress

   CONVENTIONS
     As in mpm.h: any consistent units, Cauchy stress with tension positive, pressure with
     compression positive, tensors as xx yy zz yz xz xy. Energy is per mass; the equation of state
     (A 3.40 - 3.43) works with energy per initial volume, rho0 times that.

   Equation numbers "A n" are those of source A (see mpm.h). Sources of numbers:
     [A]   source A, tables 2.1 and 2.2
     [PTW] Preston, Tonks, Wallace, J. Appl. Phys. 93 (2003) 211
     [S]   Steinberg, Equation of state and strength properties of selected materials,
           UCRL-MA-106439 (1991, change 1, 1996)
     [H]   melting points of handbooks: fixed points of the ITS-90 (Al, Cu, Zn), CRC Handbook of Chemistry and Physics;
           alloys: their liquidus, from data sheets of the grade
     [JC]  Johnson, Cook, 7th Int. Symp. Ballistics (1983) 541; Eng. Fract. Mech. 21 (1985) 31
     [C]   computed here from numbers of the other sources
     [M]   commonly used, but its printed source was not seen: check before you rely on it */
#ifndef MPM_PTW_H
#define MPM_PTW_H

#include "mpm.h"

#include <string.h>

#if MPM_VERSION_NUMBER != 200
#error "mpm_ptw.h 0.2.0 needs mpm.h 0.2.0"
#endif

#ifdef MPM_FLOAT
#define mpm_material_default mpm_material_default_f32
#define mpm_material_preset mpm_material_preset_f32
#define mpm_material_model mpm_material_model_f32
#define mpm_material_preset_count mpm_material_preset_count_f32
#define mpm_material_preset_name mpm_material_preset_name_f32
#define mpm_material_check mpm_material_check_f32
#define mpm_material_flow mpm_material_flow_f32
#define mpm_material_flow_stress mpm_material_flow_stress_f32
#define mpm_material_shear_modulus mpm_material_shear_modulus_f32
#define mpm_material_melt_temperature mpm_material_melt_temperature_f32
#define mpm_material_melting_point mpm_material_melting_point_f32
#define mpm_material_melts_at mpm_material_melts_at_f32
#define mpm_material_attempt_rate mpm_material_attempt_rate_f32
#define mpm_material_pressure mpm_material_pressure_f32
#define mpm_material_hugoniot_pressure mpm_material_hugoniot_pressure_f32
#define mpm_material_wave_speeds mpm_material_wave_speeds_f32
#define mpm_material_stress mpm_material_stress_f32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- choices ------------------------------------------------------------------------------- */

/* Each choice is a list of X(enum, "name", "text"); MPM_NAMES(MPM_STRENGTH_LIST) is "elastic|linear|...". */

/* The flow stress. */
#define MPM_STRENGTH_LIST(X)                                                               \
    X(MPM_STRENGTH_ELASTIC, "elastic", "never yields")                                     \
    X(MPM_STRENGTH_LINEAR, "linear", "linear hardening, Y + H eps")                        \
    X(MPM_STRENGTH_JC, "jc", "Johnson-Cook")                                               \
    X(MPM_STRENGTH_SCG, "scg", "Steinberg-Cochran-Guinan, rate independent")               \
    X(MPM_STRENGTH_PTW, "ptw", "Preston-Tonks-Wallace (A 2.4 - 2.8)")                      \
    X(MPM_STRENGTH_USER, "user", "the caller's strength_fn")

/* The shear modulus. */
#define MPM_SHEAR_LIST(X)                                                                  \
    X(MPM_SHEAR_CONSTANT, "constant", "shear_modulus")                                     \
    X(MPM_SHEAR_MTS, "mts", "falls with temperature (A 2.6)")                              \
    X(MPM_SHEAR_SCG, "scg", "shear_modulus (1 + A p / eta^(1/3) - B (T - 300 K))")

/* The melting temperature; at and above it the strength is zero. */
#define MPM_MELT_LIST(X)                                                                   \
    X(MPM_MELT_NONE, "none", "never melts")                                                \
    X(MPM_MELT_CONSTANT, "constant", "melt_temperature")                                   \
    X(MPM_MELT_SCG, "scg", "rises with density (A 2.9)")

/* The pressure. */
#define MPM_EOS_LIST(X)                                                                    \
    X(MPM_EOS_LINEAR, "linear", "K (eta - 1), K from young and poisson; no thermal pressure") \
    X(MPM_EOS_MIE_GRUENEISEN, "mie-grueneisen", "shock Hugoniot plus Grueneisen times energy (A 3.42, 3.43)") \
    X(MPM_EOS_USER, "user", "the caller's eos_fn")

/* How a trial stress beyond the flow stress comes back to it. */
#define MPM_RETURN_LIST(X)                                                                 \
    X(MPM_RETURN_CONSISTENT, "consistent", "increment and the rate it implies satisfy the flow law together") \
    X(MPM_RETURN_STAGED, "staged", "A6 - A8: one explicit estimate, factor at most 1; needs a user field")

/* How stress follows a rotating material. */
#define MPM_ROTATION_LIST(X)                                                               \
    X(MPM_ROTATION_PROPER, "proper", "Hughes-Winget: an exact rotation, invariants kept to rounding") \
    X(MPM_ROTATION_JAUMANN, "jaumann", "A2: first order, stretches the deviator at large rotations")

typedef enum mpm_strength { MPM_STRENGTH_LIST(MPM_LIST_ENUM) MPM_STRENGTHS } mpm_strength;
typedef enum mpm_shear { MPM_SHEAR_LIST(MPM_LIST_ENUM) MPM_SHEARS } mpm_shear;
typedef enum mpm_melt { MPM_MELT_LIST(MPM_LIST_ENUM) MPM_MELTS } mpm_melt;
typedef enum mpm_eos { MPM_EOS_LIST(MPM_LIST_ENUM) MPM_EOSES } mpm_eos;
typedef enum mpm_return_mapping { MPM_RETURN_LIST(MPM_LIST_ENUM) MPM_RETURNS } mpm_return_mapping;
typedef enum mpm_rotation { MPM_ROTATION_LIST(MPM_LIST_ENUM) MPM_ROTATIONS } mpm_rotation;

/* ---- functions in lanes -------------------------------------------------------------------- */

/* exp, expm1, log, power and erf without calls or branches: a loop over arrays of them is done several at a time by a
   compiler that may (-O3 -fno-trapping-math), and gives the same bits with any libm. For laws of your own over the
   points of a block. eps is MPM_EPSILON. Test: 13_lanes. */

#ifdef MPM_FLOAT
typedef uint32_t mpm__bits;
enum { MPM__MANTISSA = 23, MPM__BIAS = 127 };
#define MPM__ROUNDER 12582912.0f              /* 3/2 2^23: added, it leaves a whole number in the low bits */
#define MPM__LN2_HIGH 0.693359375f            /* ln 2 in two parts; few bits, so that n times the high one is exact */
#define MPM__LN2_LOW -2.12194440054690583e-4f
#define MPM__EXP_MOST 88.0f                   /* exp is infinite beyond it and 0 below EXP_LEAST */
#define MPM__EXP_LEAST -87.0f
#define MPM__LEAST_NORMAL FLT_MIN
#define MPM__ROOT_HALF 0x3f3504f3u            /* the bits of sqrt(1/2) */
#else
typedef uint64_t mpm__bits;
enum { MPM__MANTISSA = 52, MPM__BIAS = 1023 };
#define MPM__ROUNDER 6755399441055744.0
#define MPM__LN2_HIGH 6.93147180369123816490e-1
#define MPM__LN2_LOW 1.90821492927058770002e-10
#define MPM__EXP_MOST 709.0
#define MPM__EXP_LEAST -708.0
#define MPM__LEAST_NORMAL DBL_MIN
#define MPM__ROOT_HALF ((mpm__bits)0x3fe6a09eu << 32 | 0x667f3bcdu)
#endif

MPM_KERNEL mpm__bits mpm__bits_of(mpm_real x)
{
    mpm__bits b;
    memcpy(&b, &x, sizeof b);
    return b;
}

MPM_KERNEL mpm_real mpm__real_of(mpm__bits b)
{
    mpm_real x;
    memcpy(&x, &b, sizeof x);
    return x;
}

/* exp x = p + *scale: x = n ln 2 + r, *scale = 2^n, p = 2^n (exp r - 1) by Taylor's series, even and odd terms apart.
   x between EXP_LEAST and EXP_MOST. */
MPM_KERNEL mpm_real mpm__exp_parts(mpm_real x, mpm_real *scale)
{
    const mpm__bits turned = mpm__bits_of(x * MPM_R(1.44269504088896340736) + MPM__ROUNDER);
    const mpm_real n = mpm__real_of(turned) - MPM__ROUNDER;
    const mpm_real r = (x - n * MPM__LN2_HIGH) - n * MPM__LN2_LOW, q = r * r;
#ifdef MPM_FLOAT
    const mpm_real even = q * (MPM_R(1.) / 2 + q * (MPM_R(1.) / 24 + q * (MPM_R(1.) / 720)));
    const mpm_real odd = 1 + q * (MPM_R(1.) / 6 + q * (MPM_R(1.) / 120 + q * (MPM_R(1.) / 5040)));
#else
    const mpm_real even = q * (1. / 2 + q * (1. / 24 + q * (1. / 720 + q * (1. / 40320 + q * (1. / 3628800 +
                          q * (1. / 479001600))))));
    const mpm_real odd = 1 + q * (1. / 6 + q * (1. / 120 + q * (1. / 5040 + q * (1. / 362880 + q * (1. / 39916800 +
                         q * (1. / 6227020800.))))));
#endif
    *scale = mpm__real_of((turned + MPM__BIAS) << MPM__MANTISSA);
    return *scale * (even + r * odd);
}

MPM_KERNEL mpm_real mpm__exp_range(mpm_real x)
{
    const mpm_real y = x > MPM__EXP_MOST ? MPM__EXP_MOST : x;
    return y < MPM__EXP_LEAST ? MPM__EXP_LEAST : y;
}

/* exp x within 2 eps. Infinite above 709 (float: 88), 0 below -708 (-87). */
MPM_KERNEL mpm_real mpm_lane_exp(mpm_real x)
{
    mpm_real scale;
    const mpm_real p = mpm__exp_parts(mpm__exp_range(x), &scale);
    return (p + scale) * (x > MPM__EXP_MOST ? (mpm_real)HUGE_VAL : x < MPM__EXP_LEAST ? MPM_R(0.0) : MPM_R(1.0));
}

/* exp x - 1 within 3 eps of itself. Infinite above 709 (88). */
MPM_KERNEL mpm_real mpm_lane_expm1(mpm_real x)
{
    mpm_real scale;
    const mpm_real p = mpm__exp_parts(mpm__exp_range(x), &scale);
    return (p + (scale - 1)) * (x > MPM__EXP_MOST ? (mpm_real)HUGE_VAL : MPM_R(1.0));
}

/* ln x within 2 eps. What is less than the smallest normal number counts as that; no number for infinity. x = 2^n m,
   sqrt(1/2) <= m < sqrt 2; f = m - 1, s = f/(2 + f): ln m = 2 (s + s^3/3 + s^5/5 ...), written as f less what it is too
   much. */
MPM_KERNEL mpm_real mpm_lane_log(mpm_real x)
{
    const mpm__bits one = (mpm__bits)MPM__BIAS << MPM__MANTISSA;
    const mpm__bits b = mpm__bits_of(x < MPM__LEAST_NORMAL ? MPM__LEAST_NORMAL : x);
    const mpm__bits biased = (b - MPM__ROOT_HALF + one) >> MPM__MANTISSA; /* n + BIAS */
    const mpm_real ones = mpm__real_of((mpm__bits)(MPM__MANTISSA + MPM__BIAS) << MPM__MANTISSA); /* 2^MANTISSA */
    const mpm_real n = mpm__real_of(mpm__bits_of(ones) | biased) - ones - (mpm_real)MPM__BIAS;
    const mpm_real f = mpm__real_of(b - (biased << MPM__MANTISSA) + one) - 1;
    const mpm_real s = f / (2 + f), q = s * s, t = q * q, half = f * f / 2;
#ifdef MPM_FLOAT
    const mpm_real even = t * (MPM_R(2.) / 5 + t * (MPM_R(2.) / 9)), odd = q * (MPM_R(2.) / 3 + t * (MPM_R(2.) / 7));
#else
    const mpm_real even = t * (2. / 5 + t * (2. / 9 + t * (2. / 13 + t * (2. / 17 + t * (2. / 21)))));
    const mpm_real odd = q * (2. / 3 + t * (2. / 7 + t * (2. / 11 + t * (2. / 15 + t * (2. / 19)))));
#endif
    return n * MPM__LN2_HIGH - ((half - (s * (half + (even + odd)) + n * MPM__LN2_LOW)) - f) + (x - x);
}

/* x^y, x >= 0, within 2 (1 + |y ln x|) eps; x as in mpm_lane_log. */
MPM_KERNEL mpm_real mpm_lane_pow(mpm_real x, mpm_real y) { return mpm_lane_exp(y * mpm_lane_log(x)); }

/* erf x and, in *bell, exp(-x^2), within 3 and 2 eps of 1. With t = (x - 3)/(x + 3), exp(x^2) erfc(x) (1 + 2 x) is a
   polynomial in t, fitted here in 50 digits at the zeros of a Chebyshev polynomial for 0 <= x <= 6, beyond which
   erf x is 1 (J. L. Schonfelder, Math. Comp. 32 (1978) 1232, for the form). */
MPM_KERNEL mpm_real mpm_lane_erf(mpm_real x, mpm_real *bell)
{
    const mpm_real size = mpm_fabs(x), a = size > 6 ? 6 : size, t = (a - 3) / (a + 3), q = t * t;
    const mpm_real even = MPM_R(1.2530080582697296) + q * (MPM_R(-0.047562294353451905) + q * (
        MPM_R(-0.11927366341519752) + q * (MPM_R(-0.023770514922568674) + q * (MPM_R(0.0018886904170990681) + q * (
        MPM_R(-0.00010515998174219724) + q * (MPM_R(4.945274787290397e-06) + q * (MPM_R(-6.903991867604761e-07) + q * (
        MPM_R(2.914791494113244e-07) + q * (MPM_R(-4.32970612517055e-07) + q * MPM_R(-7.032937476473983e-09))))))))));
    const mpm_real odd = MPM_R(-0.1356211061245812) + q * (MPM_R(0.12964515870276055) + q * (
        MPM_R(0.06830802734417303) + q * (MPM_R(0.0025293918043747515) + q * (MPM_R(-0.000779831994804931) + q * (
        MPM_R(0.00012509640947292898) + q * (MPM_R(-2.0090432504920945e-05) + q * (MPM_R(3.510240705400258e-06) + q * (
        MPM_R(-8.432251489557363e-07) + q * MPM_R(-9.035937829820653e-08)))))))));
    const mpm_real tail = mpm_lane_exp(-a * a), erf_a = 1 - tail * ((even + t * odd) / (1 + 2 * a));
    *bell = tail;
    return x < 0 ? -erf_a : erf_a;
}

/* ---- parameters ---------------------------------------------------------------------------- */

/* Preston-Tonks-Wallace, all dimensionless except the atom's mass. */
typedef struct mpm_ptw {
    mpm_real theta;        /* initial hardening rate, > 0 */
    mpm_real d;            /* hardening curvature (p in [PTW]); 0 is the Voce limit */
    mpm_real y0, yinf;     /* yield stress / (2 mu) at T = 0 and near melting, 0 <= yinf <= y0 */
    mpm_real y1, y2;       /* yield stress of the intermediate rates, y1 r^y2 */
    mpm_real s0, sinf;     /* saturation stress likewise; yinf <= sinf <= s0, y0 <= s0 */
    mpm_real s1;           /* exponent of the overdriven regime, s0 r^s1 (beta in [PTW]) */
    mpm_real kappa;        /* temperature dependence of the rate term, >= 0 */
    mpm_real gamma;        /* rate normalisation, > 0 */
    mpm_real atomic_mass;  /* mass of ONE atom [mass]; source A prints grams as kilograms */
} mpm_ptw;

/* Johnson-Cook: (a + b eps^n) (1 + c ln(rate/rate0)) (1 - T*^m), T* = (T - T0)/(T_m - T0). The
   logarithm and T* are bounded below by 0. */
typedef struct mpm_jc {
    mpm_real a, b;         /* [stress] */
    mpm_real n, c, m;      /* exponents and rate coefficient */
    mpm_real rate;         /* reference rate [1/time] */
    mpm_real temperature;  /* T0 [K] */
} mpm_jc;

/* Steinberg-Cochran-Guinan strength: min(y0 (1 + beta eps)^n, ymax) mu(p,T)/mu0. */
typedef struct mpm_scg {
    mpm_real y0, ymax;  /* [stress] */
    mpm_real beta, n;   /* hardening */
} mpm_scg;

/* The state of one point, as the laws below see it. Each law reads what it needs. */
typedef struct mpm_material_state {
    mpm_real plastic_strain;  /* effective plastic strain, >= 0 */
    mpm_real plastic_rate;    /* its rate [1/time], >= 0 */
    mpm_real temperature;     /* [K], >= 0 */
    mpm_real density;         /* [mass/length^3], > 0 */
    mpm_real pressure;        /* compression positive [stress]; for the SCG shear modulus only */
} mpm_material_state;

/* A flow stress and its slopes. The slopes guide the solution: wrong ones cost iterations, not
   correctness (except that the staged return uses strain_slope as its E_p). */
typedef struct mpm_flow {
    mpm_real stress;        /* flow stress, >= 0 */
    mpm_real strain_slope;  /* d stress / d plastic strain */
    mpm_real rate_slope;    /* d stress / d ln(plastic rate) */
} mpm_flow;

struct mpm_material;

/* A caller's flow stress: must not fall with rate or strain faster than the elastic slope 3 mu
   rises, or the return is not unique (it still returns). A NaN stops the step with MPM_ERR_NAN.
   It is not asked at and above melting, where strength is zero. Zerilli and Armstrong's law for fcc
   metals, c0 + c2 sqrt(eps) exp(-c3 T + c4 T ln rate), would be
       typedef struct zerilli { mpm_real c0, c2, c3, c4; } zerilli;
       static mpm_flow zerilli_flow(const void *context, const mpm_material *m, const mpm_material_state *s)
       {
           const zerilli *c = (const zerilli *)context; (void)m;
           mpm_real heat = s->temperature * (c->c4 * mpm_log(s->plastic_rate) - c->c3);
           mpm_real hard = s->plastic_rate > 0 ? c->c2 * mpm_sqrt(s->plastic_strain) * mpm_exp(heat) : 0;
           mpm_flow f;
           f.stress = c->c0 + hard;
           f.strain_slope = s->plastic_strain > 0 ? hard / (2 * s->plastic_strain) : 0;
           f.rate_slope = hard * c->c4 * s->temperature;
           return f;
       }
   and is chosen by material.strength = MPM_STRENGTH_USER, strength_fn = zerilli_flow and
   strength_context = &its_numbers. Test: 11_update "user strength". */
typedef mpm_flow (*mpm_strength_fn)(const void *context, const struct mpm_material *m,
                                    const mpm_material_state *s);

/* A pressure and what goes with it. */
typedef struct mpm_pressure {
    mpm_real pressure;      /* compression positive [stress] */
    mpm_real energy_slope;  /* d pressure / d energy at constant density [mass/length^3], Gamma rho; >= 0. Guides
                               the solution, and heats by compression: Gamma of compression_heating */
    mpm_real sound_speed;   /* for the linear bulk viscosity [velocity], >= 0; not asked for without it */
} mpm_pressure;

/* A caller's equation of state: the pressure at a density > 0 and an internal energy per mass. The update asks for
   it until pressure and energy at the end of a step agree: twice a step where pressure is linear in energy. A NaN
   says that the state is out of range, and stops the step with MPM_ERR_NAN. young and poisson still give the wave
   speeds, of which the time step is made: let K = young/(3 (1 - 2 poisson)) be its bulk modulus. A stiffened gas,
   p = (g - 1) rho e + g P (rho/rho0 - 1) with c^2 = g (p + P)/rho, for water at impact, would be
       typedef struct stiffened { mpm_real g, P; } stiffened;
       static mpm_pressure stiffened_gas(const void *context, const mpm_material *m, mpm_real density, mpm_real energy)
       {
           const stiffened *c = (const stiffened *)context;
           mpm_pressure p;
           p.energy_slope = (c->g - 1) * density;
           p.pressure = p.energy_slope * energy + c->g * c->P * (density / m->density - 1);
           p.sound_speed = mpm_sqrt(c->g * (p.pressure + c->P) / density);
           return p;
       }
   and is chosen by material.eos = MPM_EOS_USER, eos_fn = stiffened_gas and eos_context = &its_numbers.
   Test: 11_update "an equation of state of one's own". */
typedef mpm_pressure (*mpm_eos_fn)(const void *context, const struct mpm_material *m, mpm_real density,
                                   mpm_real energy);

/* One material, every number in the caller's units. Fill it with mpm_material_default or
   mpm_material_preset, change fields, then call mpm_material_check. */
typedef struct mpm_material {
    unsigned mark;     /* set by mpm_material_default: a material that never saw it is refused */
    const char *name;  /* of the preset; "" for none */
    mpm_units units;   /* those the preset was converted to */

    mpm_strength strength;
    mpm_shear shear;
    mpm_melt melt;
    mpm_eos eos;
    mpm_return_mapping mapping;
    mpm_rotation rotation;
    int flow_field;   /* of a staged return: the points' user field that keeps their flow stress (mpm_field_take);
                         -1 (default): none */
    int erf_literal;  /* 0: the argument of erf in A 2.7 is at least 0 (default); 1: as printed */

    mpm_real density;        /* rho0 [mass/length^3], > 0 */
    mpm_real specific_heat;  /* Cp [energy/(mass K)], > 0 where plastic work heats */
    mpm_real temperature;    /* initial [K], >= 0 */
    mpm_real heat_fraction;  /* chi, the part of plastic work that heats (A 3.44), 0 .. 1 */
    int compression_heating; /* 1: compression (dT = -Gamma0 T dV/V0, for any equation of state but the linear one)
                                and the work of the bulk viscosity heat too; 0: they do not, as in source A (default).
                                Test: 11_update "compression", 24_manufactured "shocks" */
    mpm_real young, poisson; /* for wave speeds and the linear equation of state */

    mpm_real shear_modulus;        /* mu0: at T = 0 for MTS, at 300 K and p = 0 otherwise [stress] */
    mpm_real shear_d, shear_t;     /* D [stress] and T0 [K] of A 2.6 */
    mpm_real shear_a, shear_b;     /* A [1/stress] and B [1/K] of SCG */
    mpm_real shear_floor;          /* mu never falls below this fraction of shear_modulus, > 0 */

    mpm_real melt_temperature;     /* T_m0 [K]: that at rho0. Hot metal has less, see mpm_material_melting_point */
    mpm_real melt_a;               /* a of A 2.9; its Gamma0 is gruneisen */

    mpm_real sound_speed;          /* c0 of Us = c0 + s up [velocity] */
    mpm_real hugoniot_slope;       /* s */
    mpm_real gruneisen;            /* Gamma0 */

    mpm_real linear_yield, linear_hardening;  /* Y and H [stress] */
    mpm_jc jc;
    mpm_scg scg;
    mpm_ptw ptw;
    mpm_strength_fn strength_fn;    /* MPM_STRENGTH_USER */
    const void *strength_context;
    mpm_eos_fn eos_fn;              /* MPM_EOS_USER */
    const void *eos_context;

    /* artificial bulk viscosity, added to the pressure while the material is compressed at rate D:
       rho cell D (viscosity_quadratic cell D + viscosity_linear c_bulk). Both 0: none. */
    mpm_real viscosity_linear, viscosity_quadratic;
} mpm_material;

/* What mpm_material_stress counts in the world's tally. */
enum {
    MPM_TALLY_SHEAR_FLOOR = 0, /* points whose shear modulus was bounded */
    MPM_TALLY_ITERATION,       /* returns, and pressures of a caller's, that ended at the iteration cap */
    MPM_TALLY_ERF_CLIP         /* yielding points beyond r = 1, where the erf bound acts */
};

/* ---- presets ------------------------------------------------------------------------------- */

/* An elastic material with nothing set: chi 0.9, shear_floor 1e-3, temperature 298 K, consistent
   return, proper rotation. Set at least density, young, poisson and shear_modulus. Test: 10_material "check". */
MPM_API mpm_material mpm_material_default(void);

/* Fills *m with the named metal and its preferred strength, in the given units.
   name   one of mpm_material_preset_name
   fault  may be NULL
   Returns MPM_OK, MPM_ERR_UNKNOWN (no such name) or MPM_ERR_ARGUMENT (units not > 0); *m is then
   unchanged. Test: 10_material "presets". */
MPM_API mpm_status mpm_material_preset(mpm_material *m, const char *name, const mpm_units *units, mpm_fault *fault);

/* Changes the strength of a preset: "elastic", "linear", "jc", "scg" or "ptw", together with the
   shear modulus and melting law that its published set belongs to. "elastic" and "linear" are the
   textbook solids: constant moduli, linear equation of state, no melting.
   Returns MPM_OK, or MPM_ERR_UNKNOWN when the model does not exist (field "model") or this
   material has no published set for it (field "model of material"); MPM_ERR_ARGUMENT for a material
   that mpm_material_default never filled; *m is then unchanged. Test: 10_material "presets". */
MPM_API mpm_status mpm_material_model(mpm_material *m, const char *model, mpm_fault *fault);

/* How many presets there are. Test: 10_material "presets". */
MPM_API int mpm_material_preset_count(void);

/* The name of the i-th preset; NULL outside 0 .. count-1. Test: 10_material "presets". */
MPM_API const char *mpm_material_preset_name(int i);

/* Checks every number the chosen laws read. Bounds are inclusive where published sets sit on them.
   Returns MPM_OK, MPM_ERR_NAN or MPM_ERR_ARGUMENT with the field and its value; a material that
   mpm_material_default never filled is refused as such. Test: 10_material "check". */
MPM_API mpm_status mpm_material_check(const mpm_material *m, mpm_fault *fault);

/* ---- the laws, for one point ----------------------------------------------------------------- */

/* Flow stress and slopes. Zero at and above melting; infinite for an elastic material. No errors: a
   state out of range gives what the formula gives. With r = rate/(gamma xidot), T^ = T/T_m, PTW is
     sigma = 2 mu (tau_s + alpha ln(1 - psi exp(-beta - theta eps/(alpha psi))))               (A 2.4)
     alpha = (s0 - tau_y)/d,  beta = (tau_s - tau_y)/alpha,  psi = exp(beta) - 1               (A 2.5)
     tau_s = max(s0 - (s0 - sinf) erf(kappa T^ ln(1/r)), s0 r^s1)                              (A 2.7)
     tau_y = max(y0 - (y0 - yinf) erf(kappa T^ ln(1/r)), min(y1 r^y2, s0 r^s1))                (A 2.7)
   Test: 10_material "flow stress against long double", "limits", "slopes". */
MPM_API mpm_flow mpm_material_flow(const mpm_material *m, const mpm_material_state *s);

/* The flow stress alone. Test: 10_material "published and precomputed numbers". */
MPM_API mpm_real mpm_material_flow_stress(const mpm_material *m, const mpm_material_state *s);

/* Shear modulus [stress], at least shear_floor * shear_modulus: mu0, mu0 - D/(exp(T0/T) - 1) for MTS (A 2.6) or
   mu0 (1 + A p/eta^(1/3) - B (T - 300 K)) for SCG. Test: 10_material "limits". */
MPM_API mpm_real mpm_material_shear_modulus(const mpm_material *m, const mpm_material_state *s);

/* Melting temperature [K] at a density > 0: infinite, T_m0 or, for SCG,
   T_m0 exp(2 a (1 - 1/eta)) eta^(2 (Gamma0 - a - 1/3)) (A 2.9).
   Test: 10_material "published and precomputed numbers". */
MPM_API mpm_real mpm_material_melt_temperature(const mpm_material *m, mpm_real density);

/* The temperature [K] at which it melts at zero pressure, heated from `temperature` at rho0: where T = T_m(rho) and
   0 = p(rho, Cp (T - temperature)), rho = rho0 (1 - Gamma0 Cp (T - temperature)/c0^2). That is below T_m0: aluminium
   with 933.5 K at rho0 melts at 835 K. rho stays at rho0 below `temperature`, and here with any equation of state but
   Mie-Grueneisen; only SCG melting looks at it. Infinite where nothing melts. Test: 10_material "melting points". */
MPM_API mpm_real mpm_material_melting_point(const mpm_material *m);

/* Sets T_m0 such that it melts at T [K] at zero pressure: mpm_material_melting_point is then T. The presets do so with
   the melting points of handbooks; call it again after a change of temperature, specific heat, equation of state or
   melt_a. Returns MPM_OK; MPM_ERR_NAN or MPM_ERR_ARGUMENT for a T that is not > 0 ("melting point"), or so high that
   nothing is left there of the density or of T_m ("melt_temperature"); *m is then unchanged.
   Test: 10_material "melting points". */
MPM_API mpm_status mpm_material_melts_at(mpm_material *m, mpm_real T, mpm_fault *fault);

/* xidot = (4 pi rho/(3 M))^(1/3) (mu/rho)^(1/2)/2 [1/time], the rate at which atoms attempt to pass an
   obstacle (A 2.8). PTW only. Test: 10_material "published and precomputed numbers". */
MPM_API mpm_real mpm_material_attempt_rate(const mpm_material *m, const mpm_material_state *s);

/* Pressure at a density and an internal energy per mass, to *pressure: K mu, or p = A + Gamma0 rho0 e
   (A 3.42) with A = p_H (1 - Gamma0 mu/(2 (1 + mu))), mu = rho/rho0 - 1, p_H as below, or the caller's.
   Returns MPM_OK; MPM_ERR_STATE for a density <= 0 or past the range of the Hugoniot
   (1 - (s-1) mu <= 0); MPM_ERR_NAN, also where a caller's equation of state says so. *pressure is
   then unchanged. Test: 10_material "pressure and waves". */
MPM_API mpm_status mpm_material_pressure(const mpm_material *m, mpm_real density, mpm_real energy,
                                         mpm_real *pressure, mpm_fault *fault);

/* Pressure of the reference curve, behind a shock that compresses the material from rest to the
   given density: p_H = rho0 c0^2 mu (1 + mu)/(1 - (s - 1) mu)^2; in tension the line rho0 c0^2 mu.
   A caller's equation of state is solved for it, p = p(rho, (p + p0) (1/rho0 - 1/rho)/2), p0 its
   pressure at rest; in tension it is p(rho, 0). MPM_NOT_CONVERGED if that ended at the iteration cap.
   Other errors as mpm_material_pressure. Test: 10_material "pressure and waves". */
MPM_API mpm_status mpm_material_hugoniot_pressure(const mpm_material *m, mpm_real density,
                                                  mpm_real *pressure, mpm_fault *fault);

/* Speeds of longitudinal and shear waves at a density, V_p = ((1 - nu) E/((1 - 2 nu) (1 + nu) rho))^(1/2) and
   V_s = (E/(2 (1 + nu) rho))^(1/2) (A 3.45). Either pointer may be NULL. Test: 10_material "pressure and waves". */
MPM_API void mpm_material_wave_speeds(const mpm_material *m, mpm_real density, mpm_real *longitudinal,
                                      mpm_real *shear);

/* ---- the update, for a block ----------------------------------------------------------------- */

/* The constitutive update (A 3.38 - 3.44, A1 - A11), an mpm_stress_fn: rotation, elastic trial,
   yield, return to the flow stress, equation of state with implicit energy, adiabatic heating,
   plastic work (A 4.15).
   material  a const mpm_material *, valid under mpm_material_check; only read, so that bodies, worlds
             and threads may share one
   The block's tally, unless it is NULL, counts under MPM_TALLY_*.
   A staged return keeps each point's flow stress in a user field of the points: material.flow_field.
   Returns MPM_OK; MPM_CLAMPED if a shear modulus was bounded; MPM_NOT_CONVERGED if a return ended
   at its iteration cap (bracketed: the value is usable), or a caller's equation of
   state did; MPM_ERR_ARGUMENT (count < 0, dt <= 0, a material that mpm_material_default never filled, a
   staged return without a user field);
   MPM_ERR_NAN, MPM_ERR_STATE with the first bad point in block->fault, also of finite numbers so far out
   that the laws would make an infinite one of them. Blocks of up to 64 points
   are unchanged on failure; of longer ones, the points before the bad group of 64 are updated.
   Test: 11_update. */
MPM_API mpm_status mpm_material_stress(const void *material, const mpm_block *block);

#ifdef __cplusplus
}
#endif

#endif /* MPM_PTW_H - stop here if you only want the API */

/* ============================================================================================ */
#if defined(MPM_IMPLEMENTATION) && !defined(MPM__PTW_IMPLEMENTED)
#define MPM__PTW_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

/* ---- small tools --------------------------------------------------------------------------- */

static inline mpm_real mpm__ptw_min(mpm_real a, mpm_real b) { return a < b ? a : b; }
static inline mpm_real mpm__ptw_max(mpm_real a, mpm_real b) { return a > b ? a : b; }
static inline mpm_real mpm__ptw_infinity(void) { return (mpm_real)HUGE_VAL; }

/* low <= value <= high (inclusive; finite), or a fault that names the field. */
static inline mpm_status mpm__ptw_within(const char *field, mpm_real value, mpm_real low, mpm_real high,
                                         mpm_fault *fault)
{
    return mpm_want(value >= low && value <= high, fault, field, value, -1);
}

static inline mpm_status mpm__ptw_positive(const char *field, mpm_real value, mpm_fault *fault)
{
    return mpm_want(value > 0, fault, field, value, -1);
}

/* A material of zeros would divide by them in silence: this names what was forgotten. */
static inline mpm_status mpm__ptw_marked(const mpm_material *m, mpm_fault *fault)
{
    return mpm_want(m->mark == MPM_MARK, fault, "material (not from mpm_material_default)", (mpm_real)m->mark, -1);
}

/* Returns from the calling check at its first fault. */
#define MPM__PTW_REQUIRE(check)          \
    do {                                 \
        mpm_status require_ = (check);   \
        if (require_ < 0) return require_; \
    } while (0)

/* ---- what the laws share ------------------------------------------------------------------- */

/* Combinations of parameters that no point changes: computed once per block. */
typedef struct mpm__ptw_shared {
    const struct mpm__ptw_law *law; /* row of its strength */
    mpm_real melt_exponent;  /* 2 (Gamma0 - a - 1/3) of A 2.9 */
    mpm_real cold;           /* below this temperature nothing in the range eta_low..eta_high melts */
    mpm_real eta_low, eta_high;
    mpm_real melt;           /* T_m where it is one for all */
    mpm_real rate_factor;    /* gamma/2 (4 pi/(3 M))^(1/3) rho0^(-1/6): gamma xidot per sqrt(mu); 1 without PTW */
} mpm__ptw_shared;

/* Points are worked on in groups of this many, as plain arrays on the stack: MPM_BLOCK of them, but no fewer than the
   knots below, nor more than the caches like. */
enum { MPM__PTW_LANES = MPM_BLOCK < 8 ? 8 : MPM_BLOCK < 64 ? MPM_BLOCK : 64 };

/* What is known of a point whose flow stress is sought, and how far the search for its increment is. */
#define MPM__PTW_LANE_LIST(X)                                                                    \
    X(strain)       /* plastic strain of level k */                                              \
    X(temperature)  /* of level k, */                                                            \
    X(density)      /* of k+1, */                                                                \
    X(pressure)     /* of k: as a caller's law sees them */                                      \
    X(shear)        /* mu */                                                                     \
    X(melt)         /* T_m */                                                                    \
    X(hat)          /* T/T_m */                                                                  \
    X(log_eta)      /* ln(rho/rho0) */                                                           \
    X(rate_scale)   /* r = rate rate_scale eta^(1/6), from A 2.8 */                              \
    X(soft)         /* JC: 1 - T*^m */                                                           \
    X(mises)        /* trial von Mises stress */                                                 \
    X(least)        /* the smallest increment that counts */                                     \
    X(d)            /* the increment: next to be tried, then the answer */                       \
    X(low) X(high)  /* bracket of d */                                                           \
    X(step)         /* the last change of d; more than high before the first */                  \
    X(slope)        /* d flow stress / d d at the last d */                                      \
    X(yields)       /* 1 where the flow stress at least is known to be exceeded */

/* Points side by side: what is known of them, the state that a law is asked at, and its answer. */
typedef struct mpm__ptw_group {
    int count, lane[MPM__PTW_LANES]; /* whose they are */
#define MPM__PTW_MEMBER(name) mpm_real name[MPM__PTW_LANES];
    MPM__PTW_LANE_LIST(MPM__PTW_MEMBER)
#undef MPM__PTW_MEMBER
    mpm_real plastic_strain[MPM__PTW_LANES], plastic_rate[MPM__PTW_LANES];
    mpm_real stress[MPM__PTW_LANES], strain_slope[MPM__PTW_LANES], rate_slope[MPM__PTW_LANES]; /* as mpm_flow */
} mpm__ptw_group;

/* The plastic strains between which the flow stress is bounded by straight lines. */
enum { MPM__PTW_KNOTS = 6 };
static const mpm_real mpm__ptw_knots[MPM__PTW_KNOTS] = {MPM_R(0.0),  MPM_R(0.02), MPM_R(0.06),
                                                        MPM_R(0.15), MPM_R(0.4),  MPM_R(1.5)};

/* A lower bound of the static flow stress, of a solid point above 0 K: (mu a + b)(1 - soften (T - from)) with a and b
   on the lines between the values of `shear` and `stress` at the knots, T no less than `from`. It spares most elastic
   points the full law. */
typedef struct mpm__ptw_bounds {
    mpm_real shear[MPM__PTW_KNOTS], stress[MPM__PTW_KNOTS];
    mpm_real soften, from;
} mpm__ptw_bounds;

/* All that is known of one flow stress. To add one: a line in MPM_STRENGTH_LIST, its numbers in mpm_material, the
   functions named here and a row of mpm__ptw_laws. */
typedef struct mpm__ptw_law {
    mpm_strength strength;
    mpm_status (*judge)(const mpm_material *m, mpm_fault *fault);  /* the numbers it reads */
    void (*flow)(const mpm_material *m, mpm__ptw_group *g);        /* below melting */
    void (*bound)(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_bounds *b); /* fills zeros; NULL: none */
    int (*preset)(mpm_material *m, const char *metal);             /* its set for a metal, 0: none; NULL: no sets */
} mpm__ptw_law;

/* T_m = T_m0 exp(2 a (1 - 1/eta)) eta^(2 (Gamma0 - a - 1/3)) (A 2.9). */
static inline mpm_real mpm__ptw_melt(const mpm_material *m, mpm_real melt_exponent, mpm_real log_eta,
                                     mpm_real eta)
{
    if (m->melt == MPM_MELT_NONE) return mpm__ptw_infinity();
    if (m->melt == MPM_MELT_CONSTANT) return m->melt_temperature;
    return m->melt_temperature *
           mpm_lane_exp(2 * m->melt_a * (1 - 1 / eta) + melt_exponent * log_eta);
}

/* mu0 - D/(exp(T0/T) - 1) (A 2.6); at T = 0 it is mu0 exactly. */
static inline mpm_real mpm__ptw_shear_mts(const mpm_material *m, mpm_real temperature)
{
    return m->shear_modulus - m->shear_d / mpm_lane_expm1(m->shear_t / temperature);
}

/* mu0 (1 + A p/eta^(1/3) - B (T - 300 K)) [S]. */
static inline mpm_real mpm__ptw_shear_scg(const mpm_material *m, mpm_real temperature, mpm_real pressure,
                                          mpm_real eta)
{
    mpm_real cold = 1 + m->shear_a * pressure / mpm_lane_pow(eta, MPM_R(1.0) / 3);
    return m->shear_modulus * (cold - m->shear_b * (temperature - 300));
}

static inline mpm_real mpm__ptw_shear_raw(const mpm_material *m, mpm_real temperature,
                                          mpm_real pressure, mpm_real eta)
{
    switch (m->shear) {
    case MPM_SHEAR_MTS: return mpm__ptw_shear_mts(m, temperature);
    case MPM_SHEAR_SCG: return mpm__ptw_shear_scg(m, temperature, pressure, eta);
    default: return m->shear_modulus;
    }
}

static inline mpm_real mpm__ptw_shear_floor(const mpm_material *m)
{
    return m->shear_floor * m->shear_modulus;
}

/* A 2.9 rises with eta up to eta_high (everywhere, unless Gamma0 - a - 1/3 < 0), so a point
   denser than eta_low and colder than T_m(eta_low) is solid, without a further look. */
static inline void mpm__ptw_cold(const mpm_material *m, mpm__ptw_shared *h)
{
    mpm_real half = m->gruneisen - m->melt_a - MPM_R(1.0) / 3;
    h->melt_exponent = 2 * half;
    h->eta_low = 0;
    h->eta_high = mpm__ptw_infinity();
    if (m->melt == MPM_MELT_SCG) {
        h->eta_low = MPM_R(0.875);
        if (half < 0) h->eta_high = -m->melt_a / half;
    }
    h->cold = mpm__ptw_melt(m, h->melt_exponent, mpm_log(h->eta_low > 0 ? h->eta_low : 1),
                            h->eta_low);
    h->cold *= 1 - 64 * MPM_EPSILON;
}

/* The share of Johnson and Cook's strength that heat leaves, 1 - T*^m, T* = (T - T0)/(T_m - T0). */
static inline void mpm__ptw_soften_jc(const mpm_material *m, mpm__ptw_group *g)
{
    const mpm_jc c = m->jc; /* by value: known not to be what the loop writes */
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real T_star = (g->temperature[i] - c.temperature) / (g->melt[i] - c.temperature);
        g->soft[i] = T_star > 0 ? 1 - mpm_lane_pow(T_star, c.m) : 1;
    }
}

/* What the laws need of strain, temperature and density, that does not change while an increment is sought. */
static inline void mpm__ptw_prepare(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_group *g)
{
    const mpm_real per_density = 1 / m->density;
    int i;
    for (i = 0; i < g->count; i++) g->log_eta[i] = mpm_lane_log(g->density[i] * per_density);
    if (m->melt == MPM_MELT_SCG)
        for (i = 0; i < g->count; i++)
            g->melt[i] = mpm__ptw_melt(m, h->melt_exponent, g->log_eta[i], g->density[i] * per_density);
    else
        for (i = 0; i < g->count; i++) g->melt[i] = h->melt;
    for (i = 0; i < g->count; i++) g->hat[i] = g->temperature[i] / g->melt[i];
    for (i = 0; i < g->count; i++) g->rate_scale[i] = 1 / (h->rate_factor * mpm_sqrt(g->shear[i]));
    if (m->strength == MPM_STRENGTH_JC) mpm__ptw_soften_jc(m, g);
}

/* ---- Preston-Tonks-Wallace ------------------------------------------------------------------- */

/* Saturation and yield stress over 2 mu, and their slopes with respect to L = ln r. */
typedef struct mpm__ptw_levels {
    mpm_real s[MPM__PTW_LANES], y[MPM__PTW_LANES], s_slope[MPM__PTW_LANES], y_slope[MPM__PTW_LANES];
    mpm_real x[MPM__PTW_LANES], x_slope[MPM__PTW_LANES]; /* argument of the erf */
} mpm__ptw_levels;

/* The power laws of A 2.7, s0 r^s1 and min(y1 r^y2, s0 r^s1), and the argument of its erf, x = kappa T_hat ln(1/r).
   s0 r^s1 is computed once, so that tau_s = tau_y exactly where both follow it. A rate of 0 lets heat do all it can,
   erf = 1; at T = 0 there is no heat: erf = 0 at any rate. */
static inline void mpm__ptw_powers(const mpm_material *m, const mpm__ptw_group *g, mpm__ptw_levels *v)
{
    const mpm_ptw c = m->ptw;
    const mpm_real least = m->erf_literal ? -mpm__ptw_infinity() : 0;
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real moves = g->plastic_rate[i] > 0 ? MPM_R(1.0) : MPM_R(0.0);
        const mpm_real heat = g->temperature[i] > 0 ? MPM_R(6.0) : MPM_R(0.0);
        const mpm_real L = mpm_lane_log(g->plastic_rate[i] * g->rate_scale[i]) + g->log_eta[i] / 6;
        const mpm_real shock = moves * c.s0 * mpm_lane_exp(c.s1 * L);
        const mpm_real power = moves * c.y1 * mpm_lane_exp(c.y2 * L), slope = -c.kappa * g->hat[i], x = slope * L;
        v->s[i] = shock;
        v->s_slope[i] = c.s1 * shock;
        v->y[i] = power < shock ? power : shock;
        v->y_slope[i] = power < shock ? c.y2 * power : c.s1 * shock;
        v->x[i] = moves > 0 ? (x < least ? 0 : x) : heat;
        v->x_slope[i] = moves > 0 ? (x < least ? 0 : slope) : 0;
    }
}

/* Whether both erf terms certainly stay below the power laws, for all. For x >= 0, 1 - erf x <= exp(-x^2) <=
   1/(1 + x^2 + x^4/2 + x^6/6), which needs neither erf nor exp. */
static inline int mpm__ptw_thermal_hidden(const mpm_ptw *c, mpm__ptw_levels *v, int n)
{
    const mpm_real safe = 1 + 8 * MPM_EPSILON;
    mpm_real shown = 0;
    int i;
    for (i = 0; i < n; i++) {
        const mpm_real q = v->x[i] * v->x[i], tail = safe / (1 + q * (1 + q * (MPM_R(0.5) + q / 6)));
        const mpm_real s = (c->sinf + (c->s0 - c->sinf) * tail) * safe;
        const mpm_real y = (c->yinf + (c->y0 - c->yinf) * tail) * safe;
        shown = v->x[i] >= 0 && s < v->s[i] && y < v->y[i] ? shown : 1;
    }
    return !(shown > 0);
}

/* tau_s = max(s0 - (s0 - sinf) erf x, s0 r^s1), tau_y = max(y0 - (y0 - yinf) erf x, min(y1 r^y2, s0 r^s1)) (A 2.7). */
static inline void mpm__ptw_thermal(const mpm_ptw *c, mpm__ptw_levels *v, int n)
{
    const mpm_real two_over_root_pi = MPM_R(1.12837916709551257390);
    int i;
    for (i = 0; i < n; i++) {
        mpm_real bell;
        const mpm_real erf_x = mpm_lane_erf(v->x[i], &bell), tilt = -v->x_slope[i] * two_over_root_pi * bell;
        const mpm_real s = c->s0 - (c->s0 - c->sinf) * erf_x, y = c->y0 - (c->y0 - c->yinf) * erf_x;
        const mpm_real s_tilt = (c->s0 - c->sinf) * tilt, y_tilt = (c->y0 - c->yinf) * tilt;
        v->s_slope[i] = v->s[i] >= s ? v->s_slope[i] : s_tilt;
        v->y_slope[i] = v->y[i] >= y ? v->y_slope[i] : y_tilt;
        v->s[i] = v->s[i] >= s ? v->s[i] : s;
        v->y[i] = v->y[i] >= y ? v->y[i] : y;
    }
}

/* The Voce limit d = 0 of A 2.4: tau = tau_s - (tau_s - tau_y) exp(-theta eps/(tau_s - tau_y)). */
static inline void mpm__ptw_voce(const mpm_ptw *c, mpm__ptw_levels *v, mpm__ptw_group *g)
{
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real gap = v->s[i] - v->y[i], gap_slope = v->s_slope[i] - v->y_slope[i];
        const mpm_real u = c->theta * g->plastic_strain[i] / gap, e = gap > 0 ? mpm_lane_exp(-u) : 0;
        g->stress[i] = v->s[i] - (gap > 0 ? gap * e : 0);
        g->strain_slope[i] = c->theta * e;
        g->rate_slope[i] = v->s_slope[i] - (gap > 0 ? gap_slope * e * (1 + u) : 0);
    }
}

/* A 2.4 over 2 mu for tau_s > tau_y, written as tau = tau_y + alpha ln W with W = 1 + psi (1 - exp(-z)), z =
   theta eps/(alpha psi), alpha = (s0 - tau_y)/d: the same number, exactly tau_y at zero strain. Saturated where
   beta = (tau_s - tau_y)/alpha and psi = exp(beta) - 1 vanish. */
static inline void mpm__ptw_harden(const mpm_ptw *c, mpm__ptw_levels *v, mpm__ptw_group *g)
{
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real s = v->s[i], y = v->y[i], gap = s - y, alpha = (c->s0 - y) / c->d;
        const mpm_real per_alpha = 1 / alpha, beta = gap * per_alpha, psi = mpm_lane_expm1(beta), per_psi = 1 / psi;
        const mpm_real z = c->theta * g->plastic_strain[i] * per_alpha * per_psi, gone = -mpm_lane_expm1(-z);
        const mpm_real left = 1 - gone, W = 1 + psi * gone, log_W = mpm_lane_log(W), per_W = 1 / W;
        const mpm_real alpha_slope = -v->y_slope[i] / c->d;
        const mpm_real beta_slope = (v->s_slope[i] - v->y_slope[i] - beta * alpha_slope) * per_alpha;
        const mpm_real psi_slope = (1 + psi) * beta_slope;
        const mpm_real z_slope = -z * (alpha_slope * per_alpha + psi_slope * per_psi);
        const mpm_real W_slope = psi_slope * gone + psi * left * z_slope;
        const mpm_real stress = y + alpha * log_W, strain_slope = c->theta * left * per_W;
        const mpm_real rate_slope = v->y_slope[i] + alpha_slope * log_W + alpha * W_slope * per_W;
        const mpm_real hardens = gap > 0 && !(gap < alpha * MPM_EPSILON) ? MPM_R(1.0) : MPM_R(0.0);
        g->stress[i] = hardens > 0 ? stress : s;
        g->strain_slope[i] = hardens > 0 ? strain_slope : 0;
        g->rate_slope[i] = hardens > 0 ? rate_slope : v->s_slope[i];
    }
}

/* alpha < 0 (tau_y > s0): tau_s + alpha ln(1 - psi exp t), t = -beta - theta eps/(alpha psi) (A 2.4) as printed, the
   exponential taken out where it would overflow. */
static inline mpm_flow mpm__ptw_harden_negative(const mpm_ptw *c, mpm_real s, mpm_real y, mpm_real s_slope,
                                                mpm_real strain)
{
    mpm_real alpha = (c->s0 - y) / c->d, beta = (s - y) / alpha, psi = mpm_expm1(beta);
    mpm_real t = -beta - c->theta * strain / (alpha * psi);
    mpm_real e = mpm_exp(-mpm_fabs(t));
    mpm_flow f;
    f.stress = s + alpha * (t > 0 ? t + mpm_log(e - psi) : mpm_log(1 - psi * e));
    f.strain_slope = t > 0 ? c->theta / (e - psi) : c->theta * e / (1 - psi * e);
    f.rate_slope = s_slope;
    return f;
}

/* alpha -> 0 from above (or beta too large for exp): psi (1 - exp(-z)) -> theta eps/alpha, so that
   tau = tau_y + alpha ln(1 + theta eps/alpha). */
static inline mpm_flow mpm__ptw_harden_steep(const mpm_ptw *c, mpm_real y, mpm_real y_slope, mpm_real strain)
{
    mpm_flow f;
    mpm_real alpha = (c->s0 - y) / c->d, w = alpha > 0 ? c->theta * strain / alpha : 0;
    f.stress = y + (alpha > 0 ? alpha * mpm_log(1 + w) : 0);
    f.strain_slope = c->theta / (1 + w);
    f.rate_slope = y_slope;
    return f;
}

/* The rare limits of A 2.4, at alpha <= 0 and near it, one by one. */
static inline void mpm__ptw_harden_limits(const mpm_ptw *c, mpm__ptw_levels *v, mpm__ptw_group *g)
{
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real gap = v->s[i] - v->y[i], alpha = (c->s0 - v->y[i]) / c->d;
        mpm_flow f;
        if (!(gap > 0) || gap < 80 * alpha) continue;
        f = alpha < 0 ? mpm__ptw_harden_negative(c, v->s[i], v->y[i], v->s_slope[i], g->plastic_strain[i])
                      : mpm__ptw_harden_steep(c, v->y[i], v->y_slope[i], g->plastic_strain[i]);
        g->stress[i] = f.stress;
        g->strain_slope[i] = f.strain_slope;
        g->rate_slope[i] = f.rate_slope;
    }
}

/* tau = tau_s + alpha ln(1 - psi exp(-beta - theta eps/(alpha psi))) (A 2.4, 2.5), sigma over 2 mu, with all its
   limits. */
static inline void mpm__ptw_stress_over_2_mu(const mpm_ptw *c, mpm__ptw_levels *v, mpm__ptw_group *g)
{
    if (!(c->d > 0)) {
        mpm__ptw_voce(c, v, g);
    } else {
        mpm__ptw_harden(c, v, g);
        mpm__ptw_harden_limits(c, v, g);
    }
}

/* sigma = 2 mu tau(eps, ln r, T_hat), r = rate/(gamma xidot) (A 2.4 - 2.8). */
static inline void mpm__ptw_flow_ptw(const mpm_material *m, mpm__ptw_group *g)
{
    mpm__ptw_levels v;
    int i;
    mpm__ptw_powers(m, g, &v);
    if (!mpm__ptw_thermal_hidden(&m->ptw, &v, g->count)) mpm__ptw_thermal(&m->ptw, &v, g->count);
    mpm__ptw_stress_over_2_mu(&m->ptw, &v, g);
    for (i = 0; i < g->count; i++) {
        g->stress[i] *= 2 * g->shear[i];
        g->strain_slope[i] *= 2 * g->shear[i];
        g->rate_slope[i] *= 2 * g->shear[i];
    }
}

/* At rate 0 the stress over mu is a rising concave function of strain alone: the chords lie below it. */
static inline void mpm__ptw_bound_ptw(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_bounds *b)
{
    mpm__ptw_group g;
    mpm__ptw_levels v;
    int i;
    (void)h;
    g.count = MPM__PTW_KNOTS;
    for (i = 0; i < MPM__PTW_KNOTS; i++) {
        g.plastic_strain[i] = mpm__ptw_knots[i];
        v.s[i] = v.y[i] = v.s_slope[i] = v.y_slope[i] = v.x_slope[i] = 0;
        v.x[i] = 6;
    }
    mpm__ptw_thermal(&m->ptw, &v, g.count);
    mpm__ptw_stress_over_2_mu(&m->ptw, &v, &g);
    for (i = 0; i < MPM__PTW_KNOTS; i++) b->shear[i] = 2 * g.stress[i];
}

/* ---- the other strengths ------------------------------------------------------------------- */

/* sigma = infinity. */
static inline void mpm__ptw_flow_elastic(const mpm_material *m, mpm__ptw_group *g)
{
    int i;
    (void)m;
    for (i = 0; i < g->count; i++) {
        g->stress[i] = mpm__ptw_infinity();
        g->strain_slope[i] = g->rate_slope[i] = 0;
    }
}

/* sigma = strength_fn(point). */
static inline void mpm__ptw_flow_user(const mpm_material *m, mpm__ptw_group *g)
{
    int i;
    for (i = 0; i < g->count; i++) {
        mpm_material_state s;
        mpm_flow f;
        s.plastic_strain = g->plastic_strain[i];
        s.plastic_rate = g->plastic_rate[i];
        s.temperature = g->temperature[i];
        s.density = g->density[i];
        s.pressure = g->pressure[i];
        f = m->strength_fn(m->strength_context, m, &s);
        g->stress[i] = f.stress;
        g->strain_slope[i] = f.strain_slope;
        g->rate_slope[i] = f.rate_slope;
    }
}

/* sigma = Y + H eps, at least 0. */
static inline void mpm__ptw_flow_linear(const mpm_material *m, mpm__ptw_group *g)
{
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real stress = m->linear_yield + m->linear_hardening * g->plastic_strain[i];
        g->stress[i] = stress < 0 ? 0 : stress; /* softened to nothing */
        g->strain_slope[i] = stress < 0 ? 0 : m->linear_hardening;
        g->rate_slope[i] = 0;
    }
}

/* sigma >= Y where it hardens. */
static inline void mpm__ptw_bound_linear(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_bounds *b)
{
    int i;
    (void)h;
    for (i = 0; i < MPM__PTW_KNOTS; i++) b->stress[i] = m->linear_hardening >= 0 ? m->linear_yield : 0;
}

/* sigma = (a + b eps^n) (1 + c ln(rate/rate0)) (1 - T*^m) [JC]. With n < 1 its slope b n
   eps^(n-1) starts at infinity; at zero strain (only) it is therefore taken at the elastic strain of first yield,
   a/(3 mu). */
static inline void mpm__ptw_flow_jc(const mpm_material *m, mpm__ptw_group *g)
{
    const mpm_jc c = m->jc; /* by value: known not to be what the loop writes */
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real soft = g->soft[i], strain = g->plastic_strain[i], first = c.a / (3 * g->shear[i]);
        const mpm_real at = strain > 0 ? strain : first, raised = c.b * mpm_lane_pow(at, c.n);
        const mpm_real log_rate = mpm_lane_log(g->plastic_rate[i] / c.rate), above = log_rate > 0 ? 1 : 0;
        const mpm_real fast = 1 + c.c * (log_rate > 0 ? log_rate : 0), hard = c.a + (strain > 0 ? raised : 0);
        g->stress[i] = hard * fast * soft;
        g->strain_slope[i] = (at > 0 ? c.n * raised / at : 0) * fast * soft;
        g->rate_slope[i] = above * hard * soft * c.c;
    }
}

/* The law at its reference rate, concave in strain for n <= 1, so that chords lie below it; for more, the value at zero
   strain. 1 - T*^m >= 1 - T* for m >= 1, with the lowest T_m there is. */
static inline void mpm__ptw_bound_jc(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_bounds *b)
{
    const mpm_jc *c = &m->jc;
    int i;
    if (c->m < 1) return;
    for (i = 0; i < MPM__PTW_KNOTS; i++) {
        const mpm_real strain = c->n > 1 ? 0 : mpm__ptw_knots[i];
        b->stress[i] = c->a + (strain > 0 ? c->b * mpm_lane_pow(strain, c->n) : 0);
    }
    b->from = c->temperature;
    b->soften = 1 / mpm__ptw_max(h->cold - c->temperature, 0);
}

/* sigma = min(y0 (1 + beta eps)^n, ymax) mu/mu0 [S]. */
static inline void mpm__ptw_flow_scg(const mpm_material *m, mpm__ptw_group *g)
{
    const mpm_scg c = m->scg;
    const mpm_real per_modulus = 1 / m->shear_modulus;
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real stretch = 1 + c.beta * g->plastic_strain[i], hard = c.y0 * mpm_lane_pow(stretch, c.n);
        const mpm_real scale = g->shear[i] * per_modulus, slope = c.n * c.beta * hard / stretch * scale;
        g->stress[i] = mpm__ptw_min(hard, c.ymax) * scale;
        g->strain_slope[i] = hard < c.ymax ? slope : 0;
        g->rate_slope[i] = 0;
    }
}

/* min(y0 (1 + beta eps)^n, ymax)/mu0: concave for n <= 1, so that chords lie below it; for more, the value at zero
   strain. */
static inline void mpm__ptw_bound_scg(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_bounds *b)
{
    const mpm_scg *c = &m->scg;
    int i;
    (void)h;
    for (i = 0; i < MPM__PTW_KNOTS; i++) {
        mpm_real strain = c->n > 1 ? 0 : mpm__ptw_knots[i];
        b->shear[i] = mpm__ptw_min(c->y0 * mpm_lane_pow(1 + c->beta * strain, c->n), c->ymax) / m->shear_modulus;
    }
}

/* ---- the numbers of metals ----------------------------------------------------------------- */

/* All in SI; the tags are those of the header's list of sources. The range of a set is that of its
   source: [PTW] 1e-3 .. 1e12 /s, T < T_m; [S] strength 1e5 /s and above, [JC] up to about 1e5 /s
   and strains of order 1; Hugoniots up to the pressures of the cited shock data (tens of GPa). */

/* What every model of a metal shares. E = nu = 0: from G0 of [S] and K = rho c0^2 [C].
   c0 = 0: no Hugoniot was found; the equation of state is then the linear one. */
typedef struct mpm__ptw_metal {
    const char *name, *model;                /* preferred strength */
    double density, heat, melt;              /* kg/m^3, J/(kg K), melting point at p = 0 [K] [H] */
    double young, poisson;                   /* Pa, 1 */
    double sound, slope, gruneisen;          /* m/s, 1, 1 */
} mpm__ptw_metal;

static const mpm__ptw_metal mpm__ptw_metals[] = {
    /* rho, Cp, E, nu, c0, s, Gamma0 of the Al of source A, which prints none of the last three:
       the values are those of the shock data for 1100-O [S] */
    {"al", "ptw", 2700, 900, 933.5, 70e9, 0.33, 5386, 1.339, 1.97},
    {"al-thesis", "ptw", 2700, 900, 933.5, 70e9, 0.33, 5386, 1.339, 1.97}, /* ... melting at 933.5 K at rho0 */
    {"al1100", "scg", 2707, 884, 930, 0, 0, 5386, 1.339, 1.97},        /* [S] */
    {"al6061-t6", "scg", 2703, 885, 925, 0, 0, 5240, 1.40, 1.97},      /* [S] */
    {"al7075-t6", "scg", 2803, 848, 908, 0, 0, 5200, 1.36, 2.20},      /* [S] */
    {"cu", "ptw", 8930, 383, 1357.8, 0, 0, 3940, 1.489, 2.02},         /* [S], OFHC half hard */
    {"ni", "scg", 8900, 440, 1728, 0, 0, 4650, 1.445, 1.93},           /* [S]; Cp [M] */
    /* [S]; its Hugoniot has further terms (S2 = -5.138), so this line is for mu up to about 0.05 */
    {"ti", "scg", 4510, 500, 1941, 0, 0, 5020, 1.536, 1.23},
    {"ti-6al-4v", "scg", 4419, 525, 1933, 0, 0, 5130, 1.028, 1.23},    /* [S] */
    {"ta", "ptw", 16690, 135, 3290, 0, 0, 3410, 1.20, 1.67},           /* [S] */
    {"zn", "scg", 7139, 389, 692.7, 0, 0, 3030, 1.55, 2.24},           /* [S] */
    {"304", "ptw", 7900, 500, 1673, 193e9, 0.29, 0, 0, 0},             /* data sheets of the grade */
    {"4340", "jc", 7830, 477, 1793, 200e9, 0.29, 0, 0, 0}              /* [JC] and data sheets */
};

/* Steinberg-Cochran-Guinan: shear modulus, melting and strength. T_m0, the melting temperature at rho0, is made of
   the metal's melting point. [S] prints fits of T_m0 that belong to its own expansion: 1220 (Al), 1790 (Cu), 2330 (Ni),
   2260 (Ti), 2110 (Ti-6Al-4V), 4340 (Ta), 900 K (Zn); with the equation of state here they melt 7 to 13 % too hot at
   p = 0 (Ti-6Al-4V: 1 %). */
typedef struct mpm__ptw_set_scg {
    const char *name;
    double shear, a, b;          /* G0 [Pa], A [1/Pa], B [1/K] */
    double melt_a;               /* a */
    double y0, ymax, beta, n;    /* [Pa, Pa, 1, 1] */
} mpm__ptw_set_scg;

static const mpm__ptw_set_scg mpm__ptw_sets_scg[] = {
    /* all [S]; y0 of al1100 is [M] (0.04 GPa; a deck that circulates has ten times that) */
    {"al1100", 27.1e9, 6.52e-11, 6.16e-4, 1.5, 0.04e9, 0.48e9, 400, 0.27},
    {"al6061-t6", 27.6e9, 6.52e-11, 6.16e-4, 1.5, 0.29e9, 0.68e9, 125, 0.10},
    {"al7075-t6", 26.7e9, 6.52e-11, 6.16e-4, 1.7, 0.42e9, 0.81e9, 965, 0.10},
    {"cu", 47.7e9, 2.83e-11, 3.77e-4, 1.5, 0.12e9, 0.64e9, 36, 0.45},
    {"ni", 85.5e9, 1.63e-11, 3.26e-4, 1.4, 0.14e9, 1.20e9, 46, 0.53},
    {"ti", 43.4e9, 1.15e-11, 6.22e-4, 1.0, 0.71e9, 1.45e9, 780, 0.065},
    {"ti-6al-4v", 41.9e9, 1.15e-11, 6.44e-4, 1.0, 1.33e9, 2.12e9, 12, 0.10},
    {"ta", 69.0e9, 1.45e-11, 1.30e-4, 1.3, 0.77e9, 1.10e9, 10, 0.1},
    {"zn", 39.5e9, 5.95e-11, 7.60e-4, 1.7, 0.15e9, 0.92e9, 100, 0.20}
};

/* Johnson-Cook; reference rate 1/s, reference temperature 298 K. */
typedef struct mpm__ptw_set_jc {
    const char *name;
    double a, b, n, c, m, melt;  /* Pa, Pa, 1, 1, 1, K */
} mpm__ptw_set_jc;

static const mpm__ptw_set_jc mpm__ptw_sets_jc[] = {
    {"al1100", 148.4e6, 345.5e6, 0.183, 0.001, 0.895, 916},  /* [M] */
    {"al6061-t6", 324e6, 114e6, 0.42, 0.002, 1.34, 925},     /* [JC] */
    {"cu", 90e6, 292e6, 0.31, 0.025, 1.09, 1356},            /* [JC], OFHC */
    {"ni", 163e6, 648e6, 0.33, 0.006, 1.44, 1726},           /* [M] */
    {"ti-6al-4v", 862e6, 331e6, 0.34, 0.012, 0.8, 1878},     /* [M] */
    {"304", 310e6, 1000e6, 0.65, 0.07, 1.0, 1673},           /* 304L, [JC] form */
    {"4340", 792e6, 510e6, 0.26, 0.014, 1.03, 1793}          /* [JC] */
};

/* Preston-Tonks-Wallace with the shear modulus and melting law it is used with. */
typedef struct mpm__ptw_set_ptw {
    const char *name;
    double theta, d, s0, sinf, kappa, gamma, y0, yinf, y1, y2, s1;
    double atom;                 /* mass of one atom [kg] */
    mpm_shear shear;             /* MTS: mu0, D [Pa], T0 [K]; SCG: the table above; constant: mu0 */
    double mu0, mts_d, mts_t;
    mpm_melt melt;
    double melt0, melt_a;        /* T_m0 [K], 0: made of the metal's melting point; 1 */
} mpm__ptw_set_ptw;

static const mpm__ptw_set_ptw mpm__ptw_sets_ptw[] = {
    /* [A] table 2.1. The table prints 4.48039e-23 kg per atom, which is grams: 26.98 u is
       4.48039e-26 kg. a: [S]. */
    {"al", 0.01156, 3, 0.01489, 0.002819, 1.3, 2.04e-5, 0.0115, 0.002003, 0.0168, 0.2339, 0.2034,
     4.48039e-26, MPM_SHEAR_MTS, 28.8e9, 3.44e9, 215, MPM_MELT_SCG, 0, 1.5},
    /* ... with which source A's results were reproduced: the melting point at p = 0 taken as T_m0, so that it
       melts at 835 K there. Source A prints no T_m0. */
    {"al-thesis", 0.01156, 3, 0.01489, 0.002819, 1.3, 2.04e-5, 0.0115, 0.002003, 0.0168, 0.2339, 0.2034,
     4.48039e-26, MPM_SHEAR_MTS, 28.8e9, 3.44e9, 215, MPM_MELT_SCG, 933.5, 1.5},
    /* [PTW]; shear modulus: MTS fit of Cu in use with it; a [S]; 63.546 u */
    {"cu", 0.025, 2, 0.0085, 0.00055, 0.11, 1e-5, 1e-4, 1e-4, 0.094, 0.575, 0.25,
     1.055206e-25, MPM_SHEAR_MTS, 51.3e9, 3.0e9, 165, MPM_MELT_SCG, 0, 1.5},
    /* [PTW]; shear modulus and a [S]; 180.948 u */
    {"ta", 0.02, 0, 0.012, 0.00325, 0.6, 4e-5, 0.01, 0.00125, 0.012, 0.4, 0.23,
     3.004712e-25, MPM_SHEAR_SCG, 0, 0, 0, MPM_MELT_SCG, 0, 1.3},
    /* [PTW], which prints G0 = 89.5 GPa at T = 0 with a fall towards melting that was not seen; instead
       the room temperature shear modulus of data sheets, held constant; melting: solidus of 304; the
       atom is that of iron, 55.845 u */
    {"304", 0.02, 10, 0.05, 0.0075, 0.3, 1e-3, 0.0069, 0.0015, 0.05, 0.46, 0.25,
     9.273280e-26, MPM_SHEAR_CONSTANT, 77e9, 0, 0, MPM_MELT_CONSTANT, 1673, 0}
};

/* Linear isotropic hardening: the Taylor bar benchmark's copper, with its own moduli. */
typedef struct mpm__ptw_set_linear {
    const char *name;
    double yield, hardening, young, poisson;  /* Pa, Pa, Pa, 1 */
} mpm__ptw_set_linear;

static const mpm__ptw_set_linear mpm__ptw_sets_linear[] = {
    {"cu", 400e6, 100e6, 117e9, 0.35}
};

/* The entry of a table whose first member is the name, or NULL. */
#define MPM__PTW_FIND(type, table, wanted) \
    ((const type *)mpm__ptw_find(table, sizeof(type), sizeof(table) / sizeof(type), wanted))

static inline const void *mpm__ptw_find(const void *table, size_t size, size_t count, const char *name)
{
    const char *entry = (const char *)table;
    size_t i;
    for (i = 0; name && i < count; i++, entry += size)
        if (!strcmp(*(const char *const *)(const void *)entry, name)) return entry;
    return NULL;
}

/* A stress in Pa, in the caller's units. */
static inline mpm_real mpm__ptw_stress_in(const mpm_material *m, double si)
{
    return (mpm_real)(si / mpm_units_stress(&m->units));
}

/* Constant moduli, linear equation of state, no melting: what a preset starts from. E in Pa. */
static inline void mpm__ptw_use_textbook(mpm_material *m, double young, double nu)
{
    m->shear = MPM_SHEAR_CONSTANT;
    m->melt = MPM_MELT_NONE;
    m->eos = MPM_EOS_LINEAR;
    m->young = mpm__ptw_stress_in(m, young);
    m->poisson = (mpm_real)nu;
    m->shear_modulus = mpm__ptw_stress_in(m, young / (2 * (1 + nu)));
}

static inline int mpm__ptw_use_elastic(mpm_material *m, const char *metal)
{
    (void)metal;
    m->eos = MPM_EOS_LINEAR;
    return 1;
}

static inline int mpm__ptw_use_linear(mpm_material *m, const char *metal)
{
    const mpm__ptw_set_linear *t = MPM__PTW_FIND(mpm__ptw_set_linear, mpm__ptw_sets_linear, metal);
    if (!t) return 0;
    mpm__ptw_use_textbook(m, t->young, t->poisson);
    m->linear_yield = mpm__ptw_stress_in(m, t->yield);
    m->linear_hardening = mpm__ptw_stress_in(m, t->hardening);
    return 1;
}

static inline int mpm__ptw_use_jc(mpm_material *m, const char *metal)
{
    const mpm__ptw_set_jc *t = MPM__PTW_FIND(mpm__ptw_set_jc, mpm__ptw_sets_jc, metal);
    if (!t) return 0;
    m->shear_modulus = m->young / (2 * (1 + m->poisson));
    m->melt = MPM_MELT_CONSTANT;
    m->melt_temperature = (mpm_real)t->melt;
    m->jc.a = mpm__ptw_stress_in(m, t->a);
    m->jc.b = mpm__ptw_stress_in(m, t->b);
    m->jc.n = (mpm_real)t->n;
    m->jc.c = (mpm_real)t->c;
    m->jc.m = (mpm_real)t->m;
    m->jc.rate = (mpm_real)m->units.time; /* 1/s */
    m->jc.temperature = 298;
    return 1;
}

static inline void mpm__ptw_use_shear_scg(mpm_material *m, const mpm__ptw_set_scg *t)
{
    m->shear = MPM_SHEAR_SCG;
    m->shear_modulus = mpm__ptw_stress_in(m, t->shear);
    m->shear_a = (mpm_real)(t->a * mpm_units_stress(&m->units));
    m->shear_b = (mpm_real)t->b;
}

/* Melting after A 2.9 with the metal's melting point at p = 0; m has its equation of state. */
static inline int mpm__ptw_use_melt_scg(mpm_material *m, const char *metal, double a)
{
    const mpm__ptw_metal *t = MPM__PTW_FIND(mpm__ptw_metal, mpm__ptw_metals, metal);
    m->melt = MPM_MELT_SCG;
    m->melt_a = (mpm_real)a;
    return t && mpm_material_melts_at(m, (mpm_real)t->melt, NULL) == MPM_OK;
}

static inline int mpm__ptw_use_scg(mpm_material *m, const char *metal)
{
    const mpm__ptw_set_scg *t = MPM__PTW_FIND(mpm__ptw_set_scg, mpm__ptw_sets_scg, metal);
    if (!t) return 0;
    mpm__ptw_use_shear_scg(m, t);
    m->scg.y0 = mpm__ptw_stress_in(m, t->y0);
    m->scg.ymax = mpm__ptw_stress_in(m, t->ymax);
    m->scg.beta = (mpm_real)t->beta;
    m->scg.n = (mpm_real)t->n;
    return mpm__ptw_use_melt_scg(m, metal, t->melt_a);
}

/* The shear modulus and melting law that a set of PTW belongs to; 0: there is no such melting point. */
static inline int mpm__ptw_use_moduli_of(mpm_material *m, const mpm__ptw_set_ptw *t)
{
    const mpm__ptw_set_scg *scg = MPM__PTW_FIND(mpm__ptw_set_scg, mpm__ptw_sets_scg, t->name);
    m->shear = t->shear;
    m->shear_modulus = mpm__ptw_stress_in(m, t->mu0);
    m->shear_d = mpm__ptw_stress_in(m, t->mts_d);
    m->shear_t = (mpm_real)t->mts_t;
    if (t->shear == MPM_SHEAR_SCG && scg) mpm__ptw_use_shear_scg(m, scg);
    m->melt = t->melt;
    m->melt_temperature = (mpm_real)t->melt0;
    m->melt_a = (mpm_real)t->melt_a;
    return t->melt0 > 0 || mpm__ptw_use_melt_scg(m, t->name, t->melt_a);
}

static inline int mpm__ptw_use_ptw(mpm_material *m, const char *metal)
{
    const mpm__ptw_set_ptw *t = MPM__PTW_FIND(mpm__ptw_set_ptw, mpm__ptw_sets_ptw, metal);
    mpm_ptw *c = &m->ptw;
    if (!t || !mpm__ptw_use_moduli_of(m, t)) return 0;
    c->theta = (mpm_real)t->theta;
    c->d = (mpm_real)t->d;
    c->s0 = (mpm_real)t->s0;
    c->sinf = (mpm_real)t->sinf;
    c->kappa = (mpm_real)t->kappa;
    c->gamma = (mpm_real)t->gamma;
    c->y0 = (mpm_real)t->y0;
    c->yinf = (mpm_real)t->yinf;
    c->y1 = (mpm_real)t->y1;
    c->y2 = (mpm_real)t->y2;
    c->s1 = (mpm_real)t->s1;
    c->atomic_mass = (mpm_real)(t->atom / m->units.mass);
    return 1;
}

/* ---- checks of the strengths --------------------------------------------------------------- */

static inline mpm_status mpm__ptw_check_elastic(const mpm_material *m, mpm_fault *fault)
{
    (void)m;
    (void)fault;
    return MPM_OK;
}

static inline mpm_status mpm__ptw_check_linear(const mpm_material *m, mpm_fault *fault)
{
    const mpm_real big = mpm__ptw_infinity();
    MPM__PTW_REQUIRE(mpm__ptw_within("linear_yield", m->linear_yield, 0, big, fault));
    return mpm__ptw_within("linear_hardening", m->linear_hardening, -m->shear_modulus, big, fault);
}

static inline mpm_status mpm__ptw_check_scg(const mpm_material *m, mpm_fault *fault)
{
    const mpm_real big = mpm__ptw_infinity();
    MPM__PTW_REQUIRE(mpm__ptw_within("scg.y0", m->scg.y0, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("scg.ymax", m->scg.ymax, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("scg.beta", m->scg.beta, 0, big, fault));
    return mpm__ptw_within("scg.n", m->scg.n, 0, big, fault);
}

static inline mpm_status mpm__ptw_check_ptw(const mpm_material *m, mpm_fault *fault)
{
    const mpm_ptw *c = &m->ptw;
    const mpm_real big = mpm__ptw_infinity();
    MPM__PTW_REQUIRE(mpm__ptw_positive("ptw.theta", c->theta, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.d", c->d, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("ptw.s0", c->s0, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.sinf", c->sinf, 0, c->s0, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.y0", c->y0, 0, c->s0, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.yinf", c->yinf, 0, mpm__ptw_min(c->y0, c->sinf), fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("ptw.y1", c->y1, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.y2", c->y2, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.s1", c->s1, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("ptw.kappa", c->kappa, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("ptw.gamma", c->gamma, fault));
    return mpm__ptw_positive("ptw.atomic_mass", c->atomic_mass, fault);
}

static inline mpm_status mpm__ptw_check_jc(const mpm_material *m, mpm_fault *fault)
{
    const mpm_jc *c = &m->jc;
    const mpm_real big = mpm__ptw_infinity();
    MPM__PTW_REQUIRE(mpm__ptw_within("jc.a", c->a, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("jc.b", c->b, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("jc.n", c->n, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("jc.c", c->c, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("jc.m", c->m, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("jc.rate", c->rate, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("jc.temperature", c->temperature, 0, big, fault));
    if (m->melt != MPM_MELT_NONE && !(m->melt_temperature > c->temperature))
        return mpm_fail(fault, MPM_ERR_ARGUMENT, "melt_temperature", m->melt_temperature, -1);
    return MPM_OK;
}

static inline mpm_status mpm__ptw_check_user(const mpm_material *m, mpm_fault *fault)
{
    return m->strength_fn ? MPM_OK : mpm_fail(fault, MPM_ERR_ARGUMENT, "strength_fn", 0, -1);
}

/* ---- the table of strengths ---------------------------------------------------------------- */

static const mpm__ptw_law mpm__ptw_laws[] = {
    {MPM_STRENGTH_ELASTIC, mpm__ptw_check_elastic, mpm__ptw_flow_elastic, NULL, mpm__ptw_use_elastic},
    {MPM_STRENGTH_LINEAR, mpm__ptw_check_linear, mpm__ptw_flow_linear, mpm__ptw_bound_linear, mpm__ptw_use_linear},
    {MPM_STRENGTH_JC, mpm__ptw_check_jc, mpm__ptw_flow_jc, mpm__ptw_bound_jc, mpm__ptw_use_jc},
    {MPM_STRENGTH_SCG, mpm__ptw_check_scg, mpm__ptw_flow_scg, mpm__ptw_bound_scg, mpm__ptw_use_scg},
    {MPM_STRENGTH_PTW, mpm__ptw_check_ptw, mpm__ptw_flow_ptw, mpm__ptw_bound_ptw, mpm__ptw_use_ptw},
    {MPM_STRENGTH_USER, mpm__ptw_check_user, mpm__ptw_flow_user, NULL, NULL}
};

/* The row of a strength; the first for one that is in no list, which mpm_material_check refuses. */
static inline const mpm__ptw_law *mpm__ptw_law_of(mpm_strength strength)
{
    size_t i, n = sizeof mpm__ptw_laws / sizeof mpm__ptw_laws[0];
    for (i = 0; i < n; i++)
        if (mpm__ptw_laws[i].strength == strength) return &mpm__ptw_laws[i];
    return &mpm__ptw_laws[0];
}

/* The row of a name in MPM_STRENGTH_LIST, or NULL. */
static inline const mpm__ptw_law *mpm__ptw_law_named(const char *name)
{
#define MPM__PTW_NAMED(strength, word, text) \
    if (!strcmp(name, word)) return mpm__ptw_law_of(strength);
    if (name) {
        MPM_STRENGTH_LIST(MPM__PTW_NAMED)
    }
#undef MPM__PTW_NAMED
    return NULL;
}

static inline mpm__ptw_shared mpm__ptw_share(const mpm_material *m)
{
    const mpm_ptw *c = &m->ptw;
    mpm__ptw_shared h;
    h.law = mpm__ptw_law_of(m->strength);
    mpm__ptw_cold(m, &h);
    h.melt = m->melt == MPM_MELT_SCG ? 0 : mpm__ptw_melt(m, 0, 0, 1);
    h.rate_factor = 1;
    if (m->strength == MPM_STRENGTH_PTW) {
        mpm_real atoms = mpm_cbrt(4 * MPM_PI * m->density / (3 * c->atomic_mass));
        h.rate_factor = c->gamma * atoms / (2 * mpm_sqrt(m->density));
    }
    return h;
}

/* The flow stress of a group, 0 where molten. */
static inline void mpm__ptw_flow(const mpm_material *m, const mpm__ptw_shared *h, mpm__ptw_group *g)
{
    int i;
    h->law->flow(m, g);
    for (i = 0; i < g->count; i++)
        if (g->temperature[i] >= g->melt[i]) g->stress[i] = g->strain_slope[i] = g->rate_slope[i] = 0;
}

/* The bound of the material's strength. The staged return yields at the flow stress of an earlier step: only the value
   at zero strain (tau_y >= yinf of PTW) is used there. The factor below 1 covers rounding. */
static inline mpm__ptw_bounds mpm__ptw_bound(const mpm_material *m, const mpm__ptw_shared *h)
{
    const mpm_real safe = 1 - 64 * MPM_EPSILON;
    mpm__ptw_bounds b;
    int i;
    memset(&b, 0, sizeof b);
    if (h->law->bound) h->law->bound(m, h, &b);
    for (i = MPM__PTW_KNOTS - 1; i >= 0; i--) {
        b.shear[i] = safe * b.shear[m->mapping == MPM_RETURN_STAGED ? 0 : i];
        b.stress[i] = safe * b.stress[m->mapping == MPM_RETURN_STAGED ? 0 : i];
    }
    return b;
}

/* ---- equation of state --------------------------------------------------------------------- */

/* K = E/(3 (1 - 2 nu)). */
static inline mpm_real mpm__ptw_bulk_modulus(const mpm_material *m)
{
    return m->young / (3 * (1 - 2 * m->poisson));
}

/* The reference curve: p_H = rho0 c0^2 mu (1 + mu)/(1 - (s - 1) mu)^2, in tension rho0 c0^2 mu. */
static inline mpm_real mpm__ptw_hugoniot(const mpm_material *m, mpm_real mu)
{
    mpm_real stiff = m->density * m->sound_speed * m->sound_speed;
    mpm_real range = 1 - (m->hugoniot_slope - 1) * mu;
    if (mu < 0) return stiff * mu;
    return stiff * mu * (1 + mu) / (range * range);
}

/* The part of it that is not thermal, A = p_H (1 - Gamma0 mu/(2 (1 + mu))) of A 3.42. */
static inline mpm_real mpm__ptw_cold_pressure(const mpm_material *m, mpm_real mu)
{
    mpm_real p = mpm__ptw_hugoniot(m, mu);
    return mu < 0 ? p : p * (1 - m->gruneisen * mu / (2 * (1 + mu)));
}

static inline mpm_status mpm__ptw_eos_range(const mpm_material *m, mpm_real density, int64_t index,
                                            mpm_fault *fault)
{
    mpm_real mu = density / m->density - 1;
    if (!mpm_finite(density))
        return mpm_fail(fault, MPM_ERR_NAN, "density of point", density, index);
    if (!(density > 0))
        return mpm_fail(fault, MPM_ERR_STATE, "density of point", density, index);
    if (m->eos == MPM_EOS_MIE_GRUENEISEN && mu > 0 && !(1 - (m->hugoniot_slope - 1) * mu > 0))
        return mpm_fail(fault, MPM_ERR_STATE, "density of point past the Hugoniot's range",
                             density, index);
    return MPM_OK;
}

enum { MPM__PTW_ITERATIONS = 100 };

/* A caller's pressure and the energy per mass that satisfy e + h p(rho, e) = start together, by Newton's method from
   the given energy. The energy returned is start - h p to the last bit, so that it is the work of the pressures that
   were used. MPM_NOT_CONVERGED at the cap; MPM_ERR_NAN; MPM_ERR_STATE where 1 + h dp/de <= 0: more compression than
   any pressure can bring about. */
static inline mpm_status mpm__ptw_close_energy(const mpm_material *m, mpm_real density, mpm_real h, mpm_real start,
                                               mpm_real *energy, mpm_pressure *p)
{
    int tries;
    for (tries = 0; tries < MPM__PTW_ITERATIONS; tries++) {
        mpm_real left, slope, last = *energy;
        *p = m->eos_fn(m->eos_context, m, density, last);
        *energy = start - h * p->pressure;
        left = *energy - last;
        slope = 1 + h * p->energy_slope;
        if (!mpm_finite(left) || !mpm_finite(slope)) return MPM_ERR_NAN;
        if (!(slope > 0)) return MPM_ERR_STATE;
        if (mpm_fabs(left) <= 8 * MPM_EPSILON * (mpm_fabs(last) + mpm_fabs(h * p->pressure))) return MPM_OK;
        if (tries < MPM__PTW_ITERATIONS - 1) *energy = last + left / slope;
    }
    return MPM_NOT_CONVERGED;
}

/* The reference curve of a caller's equation of state: p = p(rho, e), e = (p + p0) (1/rho0 - 1/rho)/2. */
static inline mpm_status mpm__ptw_hugoniot_user(const mpm_material *m, mpm_real density, mpm_real *pressure,
                                                mpm_fault *fault)
{
    mpm_real h = mpm__ptw_min((1 / density - 1 / m->density) / 2, 0);
    mpm_real rest = m->eos_fn(m->eos_context, m, m->density, 0).pressure, energy = -h * rest;
    mpm_pressure p;
    mpm_status status = mpm__ptw_close_energy(m, density, h, energy, &energy, &p);
    if (status == MPM_ERR_STATE)
        return mpm_fail(fault, status, "density of point past the Hugoniot's range", density, -1);
    if (status < 0) return mpm_fail(fault, status, "pressure of point", p.pressure, -1);
    *pressure = p.pressure;
    return status;
}

/* ---- the public laws ----------------------------------------------------------------------- */

MPM_API mpm_real mpm_material_shear_modulus(const mpm_material *m, const mpm_material_state *s)
{
    mpm_real mu = mpm__ptw_shear_raw(m, s->temperature, s->pressure, s->density / m->density);
    return mpm__ptw_max(mu, mpm__ptw_shear_floor(m));
}

MPM_API mpm_real mpm_material_melt_temperature(const mpm_material *m, mpm_real density)
{
    mpm_real eta = density / m->density;
    mpm__ptw_shared h = mpm__ptw_share(m);
    return mpm__ptw_melt(m, h.melt_exponent, mpm_log(eta), eta);
}

/* rho/rho0 at zero pressure after heating to T from `temperature`, 1 - Gamma0 Cp (T - temperature)/c0^2. */
static inline mpm_real mpm__ptw_expanded(const mpm_material *m, mpm_real T)
{
    const mpm_real heat = m->specific_heat * mpm__ptw_max(T - m->temperature, 0);
    return m->eos == MPM_EOS_MIE_GRUENEISEN ? 1 - m->gruneisen * heat / (m->sound_speed * m->sound_speed) : 1;
}

MPM_API mpm_real mpm_material_melting_point(const mpm_material *m)
{
    mpm_real low = m->temperature, high = m->melt_temperature;
    int i;
    if (m->melt != MPM_MELT_SCG || !(high > low)) return mpm_material_melt_temperature(m, m->density);
    for (i = 0; i < 200; i++) { /* T - T_m grows with T */
        const mpm_real T = low + (high - low) / 2, eta = mpm__ptw_expanded(m, T);
        if (eta > 0 && T < mpm_material_melt_temperature(m, eta * m->density)) low = T;
        else high = T;
    }
    return high;
}

MPM_API mpm_status mpm_material_melts_at(mpm_material *m, mpm_real T, mpm_fault *fault)
{
    const mpm_real eta = mpm__ptw_expanded(m, T);
    mpm_material next = *m;
    MPM__PTW_REQUIRE(mpm__ptw_positive("melting point", T, fault));
    next.melt_temperature = 1;
    if (m->melt == MPM_MELT_SCG && eta > 0)
        next.melt_temperature = mpm_material_melt_temperature(&next, eta * m->density);
    next.melt_temperature = eta > 0 ? T / next.melt_temperature : 0;
    MPM__PTW_REQUIRE(mpm_want(next.melt_temperature > 0 && mpm_finite(next.melt_temperature), fault, "melt_temperature",
                              next.melt_temperature, -1));
    *m = next;
    return MPM_OK;
}

MPM_API mpm_real mpm_material_attempt_rate(const mpm_material *m, const mpm_material_state *s)
{
    mpm_real mu = mpm_material_shear_modulus(m, s);
    return MPM_R(0.5) * mpm_cbrt(4 * MPM_PI * s->density / (3 * m->ptw.atomic_mass)) *
           mpm_sqrt(mu / s->density);
}

MPM_API mpm_flow mpm_material_flow(const mpm_material *m, const mpm_material_state *s)
{
    mpm__ptw_shared h = mpm__ptw_share(m);
    mpm__ptw_group g;
    mpm_flow f;
    g.count = 1;
    g.plastic_strain[0] = s->plastic_strain;
    g.plastic_rate[0] = s->plastic_rate;
    g.temperature[0] = s->temperature;
    g.density[0] = s->density;
    g.pressure[0] = s->pressure;
    g.shear[0] = mpm_material_shear_modulus(m, s);
    mpm__ptw_prepare(m, &h, &g);
    mpm__ptw_flow(m, &h, &g);
    f.stress = g.stress[0];
    f.strain_slope = g.strain_slope[0];
    f.rate_slope = g.rate_slope[0];
    return f;
}

MPM_API mpm_real mpm_material_flow_stress(const mpm_material *m, const mpm_material_state *s)
{
    return mpm_material_flow(m, s).stress;
}

MPM_API mpm_status mpm_material_pressure(const mpm_material *m, mpm_real density, mpm_real energy,
                                         mpm_real *pressure, mpm_fault *fault)
{
    mpm_real mu = density / m->density - 1, p;
    mpm_status status = mpm__ptw_eos_range(m, density, -1, fault);
    if (status < 0) return status;
    if (!mpm_finite(energy)) return mpm_fail(fault, MPM_ERR_NAN, "energy", energy, -1);
    switch (m->eos) {
    case MPM_EOS_LINEAR: p = mpm__ptw_bulk_modulus(m) * mu; break;
    case MPM_EOS_USER: p = m->eos_fn(m->eos_context, m, density, energy).pressure; break;
    default: p = mpm__ptw_cold_pressure(m, mu) + m->gruneisen * m->density * energy;
    }
    if (!mpm_finite(p)) return mpm_fail(fault, MPM_ERR_NAN, "pressure of point", p, -1);
    *pressure = p;
    return MPM_OK;
}

MPM_API mpm_status mpm_material_hugoniot_pressure(const mpm_material *m, mpm_real density,
                                                  mpm_real *pressure, mpm_fault *fault)
{
    mpm_real mu = density / m->density - 1, p;
    mpm_status status = mpm__ptw_eos_range(m, density, -1, fault);
    if (status < 0) return status;
    if (m->eos == MPM_EOS_USER) return mpm__ptw_hugoniot_user(m, density, pressure, fault);
    p = m->eos == MPM_EOS_LINEAR ? mpm__ptw_bulk_modulus(m) * mu : mpm__ptw_hugoniot(m, mu);
    if (!mpm_finite(p)) return mpm_fail(fault, MPM_ERR_STATE, "density of point", density, -1);
    *pressure = p;
    return MPM_OK;
}

MPM_API void mpm_material_wave_speeds(const mpm_material *m, mpm_real density, mpm_real *longitudinal,
                                      mpm_real *shear)
{
    if (longitudinal) *longitudinal = mpm_wave_speed_p(m->young, m->poisson, density);
    if (shear) *shear = mpm_wave_speed_s(m->young, m->poisson, density);
}

/* ---- the update ---------------------------------------------------------------------------- */

/* A group of points in the update. */
typedef struct mpm__ptw_lanes {
    int first, count;
    mpm_real rotated[6][MPM__PTW_LANES];  /* deviator of level k, rotated */
    mpm_real trial[6][MPM__PTW_LANES];    /* trial deviator, then the new one */
    mpm_real strain[6][MPM__PTW_LANES];   /* deviatoric strain increment */
    mpm_real mean[MPM__PTW_LANES];        /* mean stress of level k, then k+1 */
    mpm_real energy[MPM__PTW_LANES];      /* internal energy per mass of level k+1 */
    mpm_real viscous[MPM__PTW_LANES];     /* pressure of the bulk viscosity */
    mpm_real thermal[MPM__PTW_LANES];     /* d pressure / d energy per initial volume: Gamma rho/rho0 */
    mpm_real volume[MPM__PTW_LANES];      /* trace of the strain increment */
    mpm_real shear[MPM__PTW_LANES];       /* mu */
    mpm_real mises2[MPM__PTW_LANES];      /* square of the trial von Mises stress */
    mpm_real increment[MPM__PTW_LANES];   /* plastic strain increment, 0 where elastic */
    mpm_real dissipated[MPM__PTW_LANES];  /* plastic work per volume of the increment */
    mpm_real temperature[MPM__PTW_LANES]; /* of level k+1 */
    mpm_real flow[MPM__PTW_LANES];        /* flow stress that a point was returned to */
    mpm_real staged[MPM__PTW_LANES];      /* flow stress that a staged return leaves to the next step */
    int suspects;                         /* points that might yield; the increments of all others are 0 */
} mpm__ptw_lanes;

/* Names the first value of point i that is not a finite number. */
static inline mpm_status mpm__ptw_diagnose_numbers(const mpm_block *b, int i)
{
    static const char *const name[5] = {"energy of point", "temperature of point", "plastic strain of point",
                                        "plastic rate of point", "plastic work of point"};
    const mpm_real *value[5];
    int j;
    value[0] = b->energy;
    value[1] = b->temperature;
    value[2] = b->plastic_strain;
    value[3] = b->plastic_rate;
    value[4] = b->plastic_work;
    for (j = 0; j < 6; j++) {
        MPM__PTW_REQUIRE(mpm_want(1, b->fault, "strain increment of point", b->strain[j][i], i));
        MPM__PTW_REQUIRE(mpm_want(1, b->fault, "stress of point", b->stress[j][i], i));
        if (j < 3) MPM__PTW_REQUIRE(mpm_want(1, b->fault, "rotation of point", b->spin[j][i], i));
    }
    for (j = 0; j < 5; j++) MPM__PTW_REQUIRE(mpm_want(1, b->fault, name[j], value[j][i], i));
    return MPM_OK;
}

/* Names what is wrong with point i, slowly; MPM_OK if nothing is. */
static inline mpm_status mpm__ptw_diagnose(const mpm_material *m, const mpm_block *b, int i)
{
    mpm_real volume = b->strain[0][i] + b->strain[1][i] + b->strain[2][i];
    mpm_real old = b->density[i] * (1 + volume);
    int gruneisen = m->eos == MPM_EOS_MIE_GRUENEISEN;
    MPM__PTW_REQUIRE(mpm__ptw_diagnose_numbers(b, i));
    MPM__PTW_REQUIRE(mpm__ptw_eos_range(m, b->density[i], i, b->fault));
    if (!(b->temperature[i] >= 0))
        return mpm_fail(b->fault, MPM_ERR_STATE, "temperature of point", b->temperature[i], i);
    if (!(b->plastic_strain[i] >= 0))
        return mpm_fail(b->fault, MPM_ERR_STATE, "plastic strain of point", b->plastic_strain[i], i);
    /* A 3.43 divides by 1 + Gamma0 dV/(2 V0) */
    if (!(volume > -1) || (gruneisen && !(old + m->gruneisen / 2 * m->density * volume > 0)))
        return mpm_fail(b->fault, MPM_ERR_STATE, "volume increment of point", volume, i);
    return MPM_OK;
}

/* The one of larger size. */
static inline mpm_real mpm__ptw_larger(mpm_real a, mpm_real b) { return mpm_fabs(a) < mpm_fabs(b) ? b : a; }

static inline mpm_real mpm__ptw_largest(const mpm_real *const *x, int i)
{
    return mpm__ptw_larger(mpm__ptw_larger(x[0][i], x[1][i]), x[2][i]);
}

/* A point all of whose numbers pass, but of which the laws make one that is not finite: names the number that is
   furthest from what a material can hold. */
static inline mpm_status mpm__ptw_blame(const mpm_material *m, const mpm_block *b, int i)
{
    static const char *const name[8] = {"strain increment of point", "stress of point", "rotation of point",
                                        "energy of point", "temperature of point", "plastic strain of point",
                                        "plastic rate of point", "plastic work of point"};
    const mpm_real hot = 10000, rho = b->density[i];
    mpm_real scale[8] = {1, 0, 1, 0, 0, 1, 0, 0}, value[8], most = mpm__ptw_max(m->density / rho, rho / m->density);
    int j, worst = -1;
    value[0] = mpm__ptw_larger(mpm__ptw_largest(b->strain, i), mpm__ptw_largest(b->strain + 3, i));
    value[1] = mpm__ptw_larger(b->stress[0][i], b->stress[1][i]);
    for (j = 2; j < 6; j++) value[1] = mpm__ptw_larger(value[1], b->stress[j][i]);
    value[2] = mpm__ptw_largest(b->spin, i);
    value[3] = b->energy[i];
    value[4] = b->temperature[i];
    value[5] = b->plastic_strain[i];
    value[6] = b->plastic_rate[i];
    value[7] = b->plastic_work[i];
    scale[1] = scale[7] = m->young;
    scale[3] = m->young / m->density;
    scale[4] = hot;
    scale[6] = 1 / b->dt;
    for (j = 0; j < 8; j++)
        if (mpm_fabs(value[j]) / scale[j] > most) {
            most = mpm_fabs(value[j]) / scale[j];
            worst = j;
        }
    if (worst < 0) return mpm_fail(b->fault, MPM_ERR_STATE, "density of point", rho, i);
    return mpm_fail(b->fault, MPM_ERR_STATE, name[worst], value[worst], i);
}

/* The same conditions, quickly, for a whole group: only a suspect one is diagnosed. x * 0 is 0 for
   finite numbers only, and the trial's von Mises stress holds every component of stress, strain
   and rotation. */
static inline mpm_status mpm__ptw_screen(const mpm_material *m, const mpm_block *b,
                                         const mpm__ptw_lanes *a)
{
    mpm_real limit = mpm__ptw_infinity(), half = 0, rho0 = m->density;
    int i, n = a->count, bad = 0;
    if (m->eos == MPM_EOS_MIE_GRUENEISEN) {
        half = m->gruneisen / 2;
        if (m->hugoniot_slope > 1) limit = rho0 * (1 + 1 / (m->hugoniot_slope - 1));
    }
    limit *= 1 - 8 * MPM_EPSILON;
    for (i = 0; i < n; i++) {
        int k = a->first + i;
        mpm_real volume = a->volume[i], rho = b->density[k], T = b->temperature[k];
        mpm_real strain = b->plastic_strain[k], old = rho * (1 + volume);
        mpm_real none = (a->mises2[i] + a->mean[i] + b->energy[k] + b->plastic_rate[k] + b->plastic_work[k] + T +
                         strain + volume) * 0;
        bad |= !((none == 0) & (rho > 0) & (rho < limit) & (T >= 0) & (strain >= 0) & (volume > -1) &
                 (old + half * rho0 * volume > 0));
    }
    if (!bad) return MPM_OK;
    for (i = a->first; i < a->first + n; i++) {
        mpm_status status = mpm__ptw_diagnose(m, b, i);
        if (status < 0) return status;
    }
    return MPM_OK;
}

static inline void mpm__ptw_count(const mpm_block *b, int what, int n)
{
    if (b->tally) b->tally[what] += n;
}

/* The shear modulus of every point; returns how many were bounded. Where heat has not come yet, all have one
   temperature to the last bit. */
static inline int mpm__ptw_shear_lanes(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a)
{
    const mpm_real least = mpm__ptw_shear_floor(m), *T = b->temperature + a->first, *rho = b->density + a->first;
    int i, hits = 0, uniform = m->shear != MPM_SHEAR_SCG;
    for (i = 1; i < a->count && m->shear == MPM_SHEAR_MTS; i++) uniform &= !(T[i] < T[0] || T[i] > T[0]);
    if (uniform) a->shear[0] = mpm__ptw_shear_raw(m, T[0], 0, 1);
    if (uniform)
        for (i = 1; i < a->count; i++) a->shear[i] = a->shear[0];
    else if (m->shear == MPM_SHEAR_MTS)
        for (i = 0; i < a->count; i++) a->shear[i] = mpm__ptw_shear_mts(m, T[i]);
    else
        for (i = 0; i < a->count; i++) a->shear[i] = mpm__ptw_shear_scg(m, T[i], -a->mean[i], rho[i] / m->density);
    for (i = 0; i < a->count; i++) hits += a->shear[i] < least;
    for (i = 0; i < a->count; i++) a->shear[i] = mpm__ptw_max(a->shear[i], least);
    mpm__ptw_count(b, MPM_TALLY_SHEAR_FLOOR, hits);
    return hits;
}

/* Splits stress and strain increment into mean and deviator: s = sigma - tr(sigma)/3 I (A3),
   dEps' = dEps - tr(dEps)/3 I (A4). */
static inline void mpm__ptw_split(const mpm_block *b, mpm__ptw_lanes *a)
{
    int i, j, k = a->first, n = a->count;
    for (i = 0; i < n; i++) {
        mpm_real mean = (b->stress[0][k + i] + b->stress[1][k + i] + b->stress[2][k + i]) / 3;
        mpm_real volume = b->strain[0][k + i] + b->strain[1][k + i] + b->strain[2][k + i];
        a->mean[i] = mean;
        a->volume[i] = volume;
    }
    for (j = 0; j < 3; j++)
        for (i = 0; i < n; i++) {
            a->rotated[j][i] = b->stress[j][k + i] - a->mean[i];
            a->strain[j][i] = b->strain[j][k + i] - a->volume[i] / 3;
        }
    for (j = 3; j < 6; j++)
        for (i = 0; i < n; i++) {
            a->rotated[j][i] = b->stress[j][k + i];
            a->strain[j][i] = b->strain[j][k + i];
        }
}

/* s <- R s R^T with R of Hughes and Winget: mpm_rotate. */
static inline void mpm__ptw_rotate_proper(const mpm_block *b, mpm__ptw_lanes *a)
{
    int i, j, k = a->first;
    for (i = 0; i < a->count; i++) {
        mpm_real w[3], s[6];
        for (j = 0; j < 3; j++) w[j] = b->spin[j][k + i];
        for (j = 0; j < 6; j++) s[j] = a->rotated[j][i];
        mpm_rotate(w, s);
        for (j = 0; j < 6; j++) a->rotated[j][i] = s[j];
    }
}

/* s <- s + W s + s W^T (A2) with W the spin increment itself. */
static inline void mpm__ptw_rotate_jaumann(const mpm_block *b, mpm__ptw_lanes *a)
{
    int i, k = a->first;
    for (i = 0; i < a->count; i++) {
        mpm_real x = b->spin[0][k + i], y = b->spin[1][k + i], z = b->spin[2][k + i];
        mpm_real sxx = a->rotated[0][i], syy = a->rotated[1][i], szz = a->rotated[2][i];
        mpm_real syz = a->rotated[3][i], sxz = a->rotated[4][i], sxy = a->rotated[5][i];
        a->rotated[0][i] += 2 * (y * sxz - z * sxy);
        a->rotated[1][i] += 2 * (z * sxy - x * syz);
        a->rotated[2][i] += 2 * (x * syz - y * sxz);
        a->rotated[3][i] += x * (syy - szz) + z * sxz - y * sxy;
        a->rotated[4][i] += y * (szz - sxx) + x * sxy - z * syz;
        a->rotated[5][i] += z * (sxx - syy) + y * syz - x * sxz;
    }
}

/* Trial deviator s* = s^R + 2 mu dEps' (A1.3) and the square of its von Mises stress, 3/2 s*:s* (A5). */
static inline void mpm__ptw_try(mpm__ptw_lanes *a)
{
    int i, j, n = a->count;
    for (j = 0; j < 6; j++)
        for (i = 0; i < n; i++) a->trial[j][i] = a->rotated[j][i] + 2 * a->shear[i] * a->strain[j][i];
    for (i = 0; i < n; i++) {
        mpm_real n2 = a->trial[0][i] * a->trial[0][i] + a->trial[1][i] * a->trial[1][i] +
                      a->trial[2][i] * a->trial[2][i];
        mpm_real t2 = a->trial[3][i] * a->trial[3][i] + a->trial[4][i] * a->trial[4][i] +
                      a->trial[5][i] * a->trial[5][i];
        a->mises2[i] = MPM_R(1.5) * n2 + 3 * t2;
    }
}

/* (mu a + b)(1 - soften (T - from)) of the bounds, a and b on the lines between the knots: what each interval adds. */
static inline void mpm__ptw_least_stress(const mpm__ptw_bounds *bounds, const mpm_block *b, const mpm__ptw_lanes *a,
                                         mpm_real *least)
{
    const mpm_real *x = mpm__ptw_knots, *y = bounds->shear, *z = bounds->stress;
    int i, j;
    for (i = 0; i < a->count; i++) least[i] = y[0] * a->shear[i] + z[0];
    for (j = 1; j < MPM__PTW_KNOTS; j++) {
        const mpm_real width = x[j] - x[j - 1], rise = (y[j] - y[j - 1]) / width, lift = (z[j] - z[j - 1]) / width;
        if (!(rise > 0 || lift > 0)) continue;
        for (i = 0; i < a->count; i++) {
            const mpm_real over = mpm__ptw_max(b->plastic_strain[a->first + i] - x[j - 1], 0);
            least[i] += (rise * a->shear[i] + lift) * mpm__ptw_min(over, width);
        }
    }
    for (i = 0; i < a->count && bounds->soften > 0; i++) {
        const mpm_real hot = mpm__ptw_max(b->temperature[a->first + i] - bounds->from, 0);
        least[i] = mpm__ptw_max(least[i] * (1 - bounds->soften * hot), 0);
    }
}

/* Lists the lanes that may yield, skipping solid ones below any flow stress. */
static inline int mpm__ptw_suspects(const mpm_material *m, const mpm__ptw_shared *h,
                                    const mpm__ptw_bounds *bounds, const mpm_block *b,
                                    const mpm__ptw_lanes *a, int *list)
{
    mpm_real rho_low = h->eta_low * m->density, rho_high = h->eta_high * m->density, least[MPM__PTW_LANES];
    int i, n = 0;
    mpm__ptw_least_stress(bounds, b, a, least);
    for (i = 0; i < a->count; i++) {
        mpm_real T = b->temperature[a->first + i], rho = b->density[a->first + i];
        int spared = (a->mises2[i] <= least[i] * least[i]) & (T > 0) & (T < h->cold) & (rho >= rho_low) &
                     (rho <= rho_high);
        list[n] = i;
        n += !spared;
    }
    return n;
}

#ifdef MPM_FLOAT
#define MPM__PTW_TOLERANCE (32 * MPM_EPSILON)
#else
#define MPM__PTW_TOLERANCE 1e-10
#endif

/* Gathers the listed lanes of the block in a group, with all that the laws ask for. */
static inline void mpm__ptw_gather(const mpm_material *m, const mpm__ptw_shared *h, const mpm_block *b,
                                   const mpm__ptw_lanes *a, const int *list, int n, mpm__ptw_group *g)
{
    int i;
    g->count = n;
    for (i = 0; i < n; i++) {
        const int lane = list[i], k = a->first + lane;
        g->lane[i] = lane;
        g->strain[i] = g->plastic_strain[i] = b->plastic_strain[k];
        g->plastic_rate[i] = b->plastic_rate[k];
        g->temperature[i] = b->temperature[k];
        g->density[i] = b->density[k];
        g->pressure[i] = -a->mean[lane];
        g->shear[i] = a->shear[lane];
        g->mises[i] = mpm_sqrt(a->mises2[lane]);
    }
    mpm__ptw_prepare(m, h, g);
}

/* The consistent return: the increment d that solves
       mises - 3 mu d = sigma_y(eps + d, d/dt, T),
   or 0 if the trial stress does not exceed the flow stress at `least`, the smallest increment that
   is not lost in the rounding of the elastic strain mises/(3 mu). (At least, not at 0: some metals'
   flow stress falls without end as the rate goes to 0, and creep of 1e-20 per step is no flow.)
   The left side falls and the right side rises, so the root is bracketed by least and mises/(3 mu).
   The bracket shrinks around it; a step that would leave the bracket, or is not half as long as the
   one before, becomes a bisection. The search starts from the rate of the last step: if the
   residual is positive there, the point yields, and the flow stress at least need not be looked at.
   Flow stress grows with the logarithm of the rate, so Newton's step is corrected with the second
   derivative of S ln d (Halley). Of a relative step x it leaves the order of (S + H d) x^2, H the
   hardening slope: once that is within tolerance, the law is not evaluated again. (Where a branch
   of A 2.7 ends within that last step, the flow law is met to about 1e-6 instead.) A caller's law
   is always evaluated at its root, for its slopes are not trusted.
   The points of a group are searched side by side, one evaluation of the law for all in a round. */
static inline void mpm__ptw_search_begin(mpm__ptw_group *g, mpm_real dt)
{
    int i;
    for (i = 0; i < g->count; i++) {
        g->d[i] = g->plastic_rate[i] * dt;
        g->high[i] = g->mises[i] / (3 * g->shear[i]);
        g->low[i] = g->least[i] = MPM_EPSILON * g->high[i];
        g->step[i] = mpm__ptw_infinity();
        g->slope[i] = g->yields[i] = 0;
    }
}

/* A better start than the rate of the last step: the old von Mises stress is the flow stress of that step, so with a
   guess S of d stress/d ln rate the new increment follows from one linear equation. PTW: S = s1 stress, exact where
   s0 r^s1 rules; other laws: S = 0. */
static inline void mpm__ptw_search_guess(const mpm_material *m, const mpm__ptw_lanes *a, mpm__ptw_group *g)
{
    const mpm_real s1 = m->strength == MPM_STRENGTH_PTW ? m->ptw.s1 : 0;
    mpm_real old[MPM__PTW_LANES];
    int i;
    for (i = 0; i < a->count; i++)
        old[i] = mpm_sqrt(MPM_R(1.5) * (a->rotated[0][i] * a->rotated[0][i] + a->rotated[1][i] * a->rotated[1][i] +
                                        a->rotated[2][i] * a->rotated[2][i]) +
                          3 * (a->rotated[3][i] * a->rotated[3][i] + a->rotated[4][i] * a->rotated[4][i] +
                               a->rotated[5][i] * a->rotated[5][i]));
    for (i = 0; i < g->count; i++) {
        const mpm_real was = old[g->lane[i]], S = s1 * was;
        const mpm_real d = g->d[i] * (g->mises[i] - was + S) / (3 * g->shear[i] * g->d[i] + S);
        if (g->d[i] > g->least[i] && d > g->least[i] && d < g->high[i]) g->d[i] = d;
    }
}

/* The state in which the law is asked next: at the least increment where nothing is known yet, else at d, which is kept
   within its bracket. */
static inline void mpm__ptw_search_try(mpm__ptw_group *g, mpm_real per_step)
{
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real d = g->d[i], low = g->low[i], high = g->high[i], middle = low + (high - low) / 2;
        const mpm_real inside = d > low && d <= high ? d : middle;
        const mpm_real at = g->yields[i] > 0 || d > g->least[i] ? inside : g->least[i];
        g->plastic_strain[i] = g->strain[i] + at;
        g->plastic_rate[i] = at * per_step;
        g->d[i] = at;
    }
}

/* Moves the searches on by the law's answers at d. over[i]: 1 where d is the answer, or NaN if the law gave NaN. */
static inline void mpm__ptw_search_step(const mpm_material *m, mpm__ptw_group *g, mpm_real *over)
{
    const int user = m->strength == MPM_STRENGTH_USER;
    int i;
    for (i = 0; i < g->count; i++) {
        const mpm_real d = g->d[i], stiff = 3 * g->shear[i], close = MPM__PTW_TOLERANCE * g->mises[i];
        const mpm_real E = g->strain_slope[i], S = g->rate_slope[i], residual = g->mises[i] - stiff * d - g->stress[i];
        const mpm_real first = g->step[i] > g->high[i] ? MPM_R(1.0) : MPM_R(0.0);
        /* where only the least increment was tried: does it yield at all? */
        const mpm_real asked = g->yields[i] > 0 || d > g->least[i] ? MPM_R(0.0) : MPM_R(1.0);
        const mpm_real start = first > 0 ? residual / (stiff + E) : g->high[i];
        /* else Newton's step x d, corrected */
        const mpm_real inverse = 1 / ((stiff + E) * d + S), slope = E + S / d, x_newton = residual * inverse;
        const mpm_real low = residual > 0 ? d : g->low[i], high = residual > 0 ? g->high[i] : d;
        const mpm_real x_halley = x_newton / mpm__ptw_max(1 - x_newton * S * inverse / 2, MPM_R(0.25));
        const mpm_real met = mpm_fabs(residual) <= close ? MPM_R(1.0) : MPM_R(0.0);
        const mpm_real x = user && met > 0 ? 0 : x_halley, xd = x * d;
        /* the last step: by the curvature S + E d of the law, and by what the slope changed in the step before */
        const mpm_real left = (S + E * d) * x * x, seen = mpm_fabs(slope - g->slope[i]) * xd * xd;
        const mpm_real short_one = mpm_fabs(x) <= (first > 0 ? MPM_R(5e-6) : MPM_R(1e-4)) ? MPM_R(1.0) : MPM_R(0.0);
        const mpm_real known = first > 0 || seen <= close * g->step[i] ? MPM_R(1.0) : MPM_R(0.0);
        const mpm_real last = left <= close && !user ? short_one * known : MPM_R(0.0);
        const mpm_real narrow = high - low <= g->least[i] ? MPM_R(1.0) : MPM_R(0.0), done = met + last + narrow;
        const mpm_real next = d + xd, kept = mpm__ptw_min(mpm__ptw_max(next, low), high);
        const mpm_real halved = 2 * mpm_fabs(xd) > g->step[i] ? low + (high - low) / 2 : next;
        const mpm_real moved = done > 0 ? kept : halved, yields = residual > 0 ? MPM_R(1.0) : g->yields[i];
        /* so small an increment that its residual proves nothing: asks whether there is any flow */
        const mpm_real doubt = done > 0 && !(yields > 0) && !(stiff * d > close) ? MPM_R(1.0) : MPM_R(0.0);
        const mpm_real wrong = residual != residual ? MPM_R(1.0) : MPM_R(0.0);
        const mpm_real none = residual <= 0 ? MPM_R(0.0) : residual; /* no flow; or no number */
        over[i] = asked > 0 ? (residual > 0 ? 0 : 1) : (doubt > 0 ? 0 : done + wrong);
        g->d[i] = asked > 0 ? (residual > 0 ? start : none) : (doubt > 0 ? 0 : moved);
        g->low[i] = asked > 0 ? g->low[i] : low;
        g->high[i] = asked > 0 ? g->high[i] : high;
        g->slope[i] = asked > 0 ? g->slope[i] : slope;
        g->step[i] = asked > 0 ? g->step[i] : mpm_fabs(moved - d);
        g->yields[i] = yields;
    }
}

/* Takes the answers of the searches that are over to *a; the others close up. */
static inline void mpm__ptw_search_close(mpm__ptw_group *g, const mpm_real *over, mpm__ptw_lanes *a)
{
    int keep[MPM__PTW_LANES], i, n = 0;
    for (i = 0; i < g->count; i++) {
        keep[n] = i;
        n += !(over[i] > 0);
        a->increment[g->lane[i]] = g->d[i];
    }
    if (n == g->count) return;
    g->count = n;
    for (i = 0; i < n; i++) g->lane[i] = g->lane[keep[i]];
#define MPM__PTW_CLOSE_UP(name) \
    for (i = 0; i < n; i++) g->name[i] = g->name[keep[i]];
    MPM__PTW_LANE_LIST(MPM__PTW_CLOSE_UP)
#undef MPM__PTW_CLOSE_UP
}

/* Molten points have no strength: all of the deviator goes, without a search. */
static inline void mpm__ptw_search_molten(mpm__ptw_group *g, mpm__ptw_lanes *a)
{
    mpm_real over[MPM__PTW_LANES];
    int i, molten = 0;
    for (i = 0; i < g->count; i++) {
        over[i] = g->temperature[i] >= g->melt[i] ? MPM_R(1.0) : MPM_R(0.0);
        molten += over[i] > 0;
    }
    if (!molten) return;
    for (i = 0; i < g->count; i++) g->d[i] = over[i] > 0 ? g->high[i] : g->d[i];
    mpm__ptw_search_close(g, over, a);
}

/* The increments of a group, to *a. Returns how many were still open at the cap. */
static inline int mpm__ptw_search(const mpm_material *m, const mpm__ptw_shared *h, const mpm_block *b,
                                  mpm__ptw_group *g, mpm__ptw_lanes *a)
{
    const mpm_real per_step = 1 / b->dt;
    mpm_real over[MPM__PTW_LANES];
    int tries;
    mpm__ptw_search_begin(g, b->dt);
    mpm__ptw_search_guess(m, a, g);
    mpm__ptw_search_molten(g, a);
    for (tries = 0; tries < MPM__PTW_ITERATIONS && g->count > 0; tries++) {
        mpm__ptw_search_try(g, per_step);
        h->law->flow(m, g);
        mpm__ptw_search_step(m, g, over);
        mpm__ptw_search_close(g, over, a);
    }
    return g->count;
}

/* The stress to which consistent returns have come: sigma* - 3 mu d, and none where that is lost in rounding. */
static inline void mpm__ptw_returned(mpm__ptw_lanes *a)
{
    int i;
    for (i = 0; i < a->count; i++) {
        const mpm_real mises = mpm_sqrt(a->mises2[i]), flow = mises - 3 * a->shear[i] * a->increment[i];
        a->flow[i] = flow <= 4 * MPM_EPSILON * mises ? 0 : flow;
    }
}

/* sqrt(2/3 e:e): the effective size of lane i's deviatoric strain increment. */
static inline mpm_real mpm__ptw_effective(const mpm__ptw_lanes *a, int i)
{
    mpm_real n2 = 0, t2 = 0;
    int j;
    for (j = 0; j < 3; j++) {
        n2 += a->strain[j][i] * a->strain[j][i];
        t2 += a->strain[j + 3][i] * a->strain[j + 3][i];
    }
    return mpm_sqrt((n2 + 2 * t2) * 2 / 3);
}

/* The staged return of a group: d = (sigma* - sigma_y)/(3 mu + E_p) (A6) with the flow stress sigma_y that the last
   return left, then the flow stress at the strain and rate it gives (A7), s = min(sigma_y/sigma*, 1) s* (A8). Before
   its first return a point has none: the flow stress at the rate of the whole deviatoric strain stands for it. Sets
   increment, flow and staged of *a. */
static inline void mpm__ptw_stage(const mpm_material *m, const mpm__ptw_shared *h, const mpm_block *b,
                                  mpm__ptw_group *g, mpm__ptw_lanes *a)
{
    const mpm_real per_step = 1 / b->dt, *left = b->user[m->flow_field] + a->first;
    int i;
    for (i = 0; i < g->count; i++)
        if (!(g->plastic_rate[i] > 0)) g->plastic_rate[i] = mpm__ptw_effective(a, g->lane[i]) * per_step;
    mpm__ptw_flow(m, h, g);
    for (i = 0; i < g->count; i++) {
        const mpm_real yield = left[g->lane[i]] > 0 && g->stress[i] > 0 ? left[g->lane[i]] : g->stress[i];
        const mpm_real over = g->mises[i] - yield, d = over / (3 * g->shear[i] + g->strain_slope[i]);
        g->d[i] = over <= 0 ? 0 : d;
        g->plastic_strain[i] = g->strain[i] + g->d[i];
        g->plastic_rate[i] = g->d[i] * per_step;
    }
    mpm__ptw_flow(m, h, g);
    for (i = 0; i < g->count; i++) {
        a->increment[g->lane[i]] = g->d[i];
        a->staged[g->lane[i]] = g->stress[i];
        a->flow[g->lane[i]] = mpm__ptw_min(g->stress[i], g->mises[i]);
    }
}

/* Plastic work per volume of lane i whose deviator comes back to factor s*: what the strain puts in less what stays
   elastic, (s_k + s_k+1) : (s* - s_k+1)/(4 mu). sigma d is another amount: sigma* - sigma is not 3 mu d here. */
static inline mpm_real mpm__ptw_staged_work(const mpm__ptw_lanes *a, int i, mpm_real factor)
{
    mpm_real normal = 0, shear = 0;
    int j;
    for (j = 0; j < 3; j++) {
        normal += (a->rotated[j][i] + factor * a->trial[j][i]) * a->trial[j][i];
        shear += (a->rotated[j + 3][i] + factor * a->trial[j + 3][i]) * a->trial[j + 3][i];
    }
    return (1 - factor) * (normal + 2 * shear) / (4 * a->shear[i]);
}

/* The scaled deviator s = sigma_y/sigma* s* (A8) of the points that yield, and their plastic work. */
static inline void mpm__ptw_scale(const mpm_material *m, mpm__ptw_lanes *a)
{
    mpm_real factor[MPM__PTW_LANES];
    int i, j;
    for (i = 0; i < a->count; i++) {
        const mpm_real mises = mpm_sqrt(a->mises2[i]), f = a->flow[i] / mises;
        factor[i] = a->increment[i] > 0 ? f : 1;
        a->dissipated[i] = a->increment[i] > 0 ? a->flow[i] * a->increment[i] : 0;
    }
    for (i = 0; i < a->count && m->mapping == MPM_RETURN_STAGED; i++)
        if (a->increment[i] > 0) a->dissipated[i] = mpm__ptw_staged_work(a, i, factor[i]);
    for (j = 0; j < 6; j++)
        for (i = 0; i < a->count; i++) a->trial[j][i] *= factor[i];
}

/* Whether increments and flow stresses are finite; else the fault. */
static inline mpm_status mpm__ptw_found(const mpm_material *m, const mpm_block *b, const mpm__ptw_lanes *a,
                                        const int *list, int n)
{
    int i;
    for (i = 0; i < n; i++) {
        const int lane = list[i];
        const mpm_real d = a->increment[lane], flow = a->flow[lane];
        if (mpm_finite(d * flow * a->mises2[lane])) continue;
        if (!mpm_finite(mpm_sqrt(a->mises2[lane]))) return mpm__ptw_blame(m, b, a->first + lane);
        if (!mpm_finite(d) || !mpm_finite(flow))
            return mpm_fail(b->fault, MPM_ERR_NAN, "flow stress of point", d, a->first + lane);
    }
    return MPM_OK;
}

/* Counts the yielding points beyond r = 1. */
static inline void mpm__ptw_count_overdriven(const mpm_material *m, const mpm_block *b, const mpm__ptw_lanes *a,
                                             const mpm__ptw_shared *h)
{
    int i, n = 0;
    if (m->strength != MPM_STRENGTH_PTW || m->erf_literal) return;
    for (i = 0; i < a->count; i++) { /* r^2 = (rate/(rate_factor sqrt mu))^2 eta^(1/3): cubed, no root is left */
        const mpm_real r = a->increment[i] / (b->dt * h->rate_factor), square = r * r / a->shear[i];
        n += square * square * square * (b->density[a->first + i] / m->density) > 1;
    }
    mpm__ptw_count(b, MPM_TALLY_ERF_CLIP, n);
}

/* Sorts out the points that may yield and returns them to the flow stress. Touches only *a (and
   counters), so that a failure leaves the block as it was. */
static inline mpm_status mpm__ptw_yield(const mpm_material *m, const mpm__ptw_shared *h,
                                        const mpm__ptw_bounds *bounds, const mpm_block *b,
                                        mpm__ptw_lanes *a)
{
    mpm__ptw_group g;
    int list[MPM__PTW_LANES + 1], i, n, capped = 0;
    for (i = 0; i < a->count; i++) a->increment[i] = a->flow[i] = a->dissipated[i] = 0;
    n = m->strength == MPM_STRENGTH_ELASTIC ? 0 : mpm__ptw_suspects(m, h, bounds, b, a, list);
    a->suspects = n;
    if (n == 0) return MPM_OK;
    mpm__ptw_gather(m, h, b, a, list, n, &g);
    if (m->mapping == MPM_RETURN_STAGED) {
        mpm__ptw_stage(m, h, b, &g, a);
    } else {
        capped = mpm__ptw_search(m, h, b, &g, a);
        mpm__ptw_returned(a);
    }
    MPM__PTW_REQUIRE(mpm__ptw_found(m, b, a, list, n));
    mpm__ptw_scale(m, a);
    mpm__ptw_count_overdriven(m, b, a, h);
    mpm__ptw_count(b, MPM_TALLY_ITERATION, capped);
    return capped ? MPM_NOT_CONVERGED : MPM_OK;
}

/* Plastic strain, its rate and plastic work dW = sigma d (A 4.15), to the block. */
static inline void mpm__ptw_commit(const mpm_material *m, const mpm_block *b, const mpm__ptw_lanes *a)
{
    const mpm_real per_step = 1 / b->dt;
    int i, k = a->first;
    for (i = 0; i < a->count; i++) b->plastic_rate[k + i] = a->increment[i] * per_step;
    if (a->suspects == 0) return;
    for (i = 0; i < a->count; i++) b->plastic_strain[k + i] += a->increment[i];
    for (i = 0; i < a->count; i++) b->plastic_work[k + i] += a->dissipated[i];
    for (i = 0; i < a->count && m->mapping == MPM_RETURN_STAGED; i++)
        if (a->increment[i] > 0) b->user[m->flow_field][k + i] = a->staged[i];
}

/* (s of level k + s of level k+1) : dEps', twice the deviator's work per volume. */
static inline void mpm__ptw_work(const mpm__ptw_lanes *a, mpm_real *work)
{
    int i;
    for (i = 0; i < a->count; i++)
        work[i] = (a->rotated[0][i] + a->trial[0][i]) * a->strain[0][i] +
                  (a->rotated[1][i] + a->trial[1][i]) * a->strain[1][i] +
                  (a->rotated[2][i] + a->trial[2][i]) * a->strain[2][i] +
                  2 * ((a->rotated[3][i] + a->trial[3][i]) * a->strain[3][i] +
                       (a->rotated[4][i] + a->trial[4][i]) * a->strain[4][i] +
                       (a->rotated[5][i] + a->trial[5][i]) * a->strain[5][i]);
}

/* Energy before the new pressure's share of the work, per initial volume (A 3.41):
   E* = E + V_half s_half : dEps - dV/2 (p + q), v and dv being V and dV over V0. */
static inline mpm_real mpm__ptw_trial_energy(mpm_real E, mpm_real v, mpm_real dv, mpm_real work, mpm_real mean,
                                             mpm_real q)
{
    return E + (v - dv / 2) * work / 2 + dv / 2 * (mean - q);
}

/* Bulk viscosity q = rho cell D (quadratic cell D + linear c), D the rate of compression; squeeze is cell D and first
   is linear c. */
static inline mpm_real mpm__ptw_viscous(const mpm_material *m, mpm_real rho, mpm_real squeeze, mpm_real first)
{
    return rho * squeeze * (m->viscosity_quadratic * squeeze + first);
}

/* Pressure with the energy that its own work changes, p = (A + B E*)/(1 + B dV/(2 V0)), E = E* - dV p/2
   (A 3.40 - 3.43). All energies and volumes here are per initial volume. */
static inline void mpm__ptw_pressure_known(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a,
                                           const mpm_real *work)
{
    int linear = m->eos == MPM_EOS_LINEAR, i, k = a->first;
    mpm_real B = linear ? 0 : m->gruneisen, slope = m->hugoniot_slope - 1;
    mpm_real stiff = linear ? mpm__ptw_bulk_modulus(m) : m->density * m->sound_speed * m->sound_speed;
    mpm_real rho0 = m->density, inverse_rho0 = 1 / rho0, cell_per_step = b->cell / b->dt;
    mpm_real first = m->viscosity_linear * mpm_sqrt(stiff / rho0);
    const mpm_real *density = b->density + k, *energy = b->energy + k;
    for (i = 0; i < a->count; i++) {
        mpm_real rho = density[i], mu = (rho - rho0) * inverse_rho0, v = rho0 / rho;
        mpm_real dv = v * a->volume[i] / (1 + a->volume[i]);
        mpm_real range = 1 - slope * mu;
        mpm_real shock = stiff * mu * (1 + mu - B / 2 * mu) / (range * range);
        mpm_real A = mu < 0 || linear ? stiff * mu : shock;
        mpm_real q = mpm__ptw_viscous(m, rho, cell_per_step * mpm__ptw_max(-a->volume[i], 0), first);
        mpm_real E = mpm__ptw_trial_energy(rho0 * energy[i], v, dv, work[i], a->mean[i], q);
        mpm_real p = (A + B * E) / (1 + B * dv / 2);
        a->energy[i] = (E - dv / 2 * p) * inverse_rho0;
        a->mean[i] = -(p + q);
        a->viscous[i] = q;
        a->thermal[i] = B;
    }
}

/* The same for lane i of a caller's equation of state: e = e* - dV p(rho, e)/2, all per mass. */
static inline mpm_status mpm__ptw_pressure_user(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a, int i,
                                                mpm_real work)
{
    mpm_real rho0 = m->density, rho = b->density[a->first + i], e = b->energy[a->first + i], v = rho0 / rho;
    mpm_real dv = v * a->volume[i] / (1 + a->volume[i]), h = dv / (2 * rho0), first = 0, q, start;
    mpm_real squeeze = b->cell / b->dt * mpm__ptw_max(-a->volume[i], 0);
    mpm_pressure p;
    mpm_status status;
    if (squeeze > 0 && m->viscosity_linear > 0)
        first = m->viscosity_linear * m->eos_fn(m->eos_context, m, rho, e).sound_speed;
    q = mpm__ptw_viscous(m, rho, squeeze, first);
    start = mpm__ptw_trial_energy(rho0 * e, v, dv, work, a->mean[i], q) / rho0;
    a->energy[i] = start;
    status = mpm__ptw_close_energy(m, rho, h, start, &a->energy[i], &p);
    if (status == MPM_ERR_STATE)
        return mpm_fail(b->fault, status, "volume increment of point", a->volume[i], a->first + i);
    if (status < 0) return mpm_fail(b->fault, status, "pressure of point", p.pressure, a->first + i);
    a->mean[i] = -(p.pressure + q);
    a->viscous[i] = q;
    a->thermal[i] = p.energy_slope / rho0;
    return status;
}

/* Mean stress and energy of level k+1. Touches only *a (and counters). */
static inline mpm_status mpm__ptw_pressure(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a)
{
    mpm_real work[MPM__PTW_LANES];
    int i, capped = 0;
    mpm__ptw_work(a, work);
    if (m->eos != MPM_EOS_USER) {
        mpm__ptw_pressure_known(m, b, a, work);
        return MPM_OK;
    }
    for (i = 0; i < a->count; i++) {
        mpm_status status = mpm__ptw_pressure_user(m, b, a, i, work[i]);
        if (status < 0) return status;
        capped += status > 0;
    }
    mpm__ptw_count(b, MPM_TALLY_ITERATION, capped);
    return capped ? MPM_NOT_CONVERGED : MPM_OK;
}

/* Temperature along the isentrope of Gamma rho = Gamma0 rho0, T exp(Gamma0 V/V0) = constant, and the heat of the bulk
   viscosity, dT = -q dV/(V0 rho0 Cp). */
static inline void mpm__ptw_heat_volume(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a)
{
    int i, k = a->first;
    for (i = 0; i < a->count; i++) {
        mpm_real dv = m->density / b->density[k + i] * a->volume[i] / (1 + a->volume[i]);
        a->temperature[i] += a->temperature[i] * mpm_lane_expm1(-a->thermal[i] * dv);
        a->temperature[i] -= a->viscous[i] * dv / (m->density * m->specific_heat);
    }
}

/* Temperature of level k+1 with the heat of plastic work, dT = chi sigma d/(rho Cp) (A 3.44). Touches only *a. */
static inline void mpm__ptw_heat(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a)
{
    const mpm_real share = m->heat_fraction / m->specific_heat;
    int i, k = a->first;
    for (i = 0; i < a->count; i++) a->temperature[i] = b->temperature[k + i];
    if (m->heat_fraction > 0 && a->suspects > 0)
        for (i = 0; i < a->count; i++) a->temperature[i] += share * a->dissipated[i] / b->density[k + i];
    if (m->compression_heating) mpm__ptw_heat_volume(m, b, a);
}

/* Whether all that would go to the block is finite; else the fault. x * 0 is 0 for finite numbers only. */
static inline mpm_status mpm__ptw_settled(const mpm_material *m, const mpm_block *b, const mpm__ptw_lanes *a)
{
    mpm_real per_step = 1 / b->dt, wrong[MPM__PTW_LANES];
    int i, k = a->first, bad = 0;
    for (i = 0; i < a->count; i++) {
        mpm_real t = (a->trial[0][i] + a->mean[i]) * 0 + (a->trial[1][i] + a->mean[i]) * 0 +
                     (a->trial[2][i] + a->mean[i]) * 0;
        t += a->trial[3][i] * 0 + a->trial[4][i] * 0 + a->trial[5][i] * 0 + a->energy[i] * 0 + a->temperature[i] * 0;
        t += (a->increment[i] * per_step) * 0 + (b->plastic_strain[k + i] + a->increment[i]) * 0 +
             (b->plastic_work[k + i] + a->dissipated[i]) * 0;
        bad |= !(t == 0);
        wrong[i] = t;
    }
    for (i = 0; bad && i < a->count; i++)
        if (!(wrong[i] == 0)) return mpm__ptw_blame(m, b, k + i);
    return MPM_OK;
}

/* Energy, temperature and full stress, sigma = s - (p + q) I, to the block. */
static inline void mpm__ptw_close(const mpm_block *b, const mpm__ptw_lanes *a)
{
    int i, j, k = a->first;
    for (i = 0; i < a->count; i++) b->energy[k + i] = a->energy[i];
    for (i = 0; i < a->count; i++) b->temperature[k + i] = a->temperature[i];
    for (j = 0; j < 3; j++)
        for (i = 0; i < a->count; i++) b->stress[j][k + i] = a->trial[j][i] + a->mean[i];
    for (j = 3; j < 6; j++)
        for (i = 0; i < a->count; i++) b->stress[j][k + i] = a->trial[j][i];
}

/* One group of points. A failure leaves the block as it was: only the last two touch it. */
static inline mpm_status mpm__ptw_update(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_bounds *bounds,
                                         const mpm_block *b, mpm__ptw_lanes *a)
{
    mpm_status yield, pressure;
    int bounded;
    mpm__ptw_split(b, a);
    bounded = mpm__ptw_shear_lanes(m, b, a);
    if (m->rotation == MPM_ROTATION_PROPER) mpm__ptw_rotate_proper(b, a);
    else mpm__ptw_rotate_jaumann(b, a);
    mpm__ptw_try(a);
    MPM__PTW_REQUIRE(mpm__ptw_screen(m, b, a));
    yield = mpm__ptw_yield(m, h, bounds, b, a);
    if (yield < 0) return yield;
    pressure = mpm__ptw_pressure(m, b, a);
    if (pressure < 0) return pressure;
    mpm__ptw_heat(m, b, a);
    MPM__PTW_REQUIRE(mpm__ptw_settled(m, b, a));
    mpm__ptw_commit(m, b, a);
    mpm__ptw_close(b, a);
    if (yield > 0 || pressure > 0) return MPM_NOT_CONVERGED;
    return bounded ? MPM_CLAMPED : MPM_OK;
}

/* Whether the points have the field that a staged return keeps their flow stress in. */
static inline int mpm__ptw_has_field(const mpm_material *m, const mpm_block *b)
{
    return m->flow_field >= 0 && m->flow_field < MPM_USER_FIELDS && b->user[m->flow_field];
}

MPM_API mpm_status mpm_material_stress(const void *material, const mpm_block *block)
{
    const mpm_material *m = (const mpm_material *)material;
    mpm_status worst = MPM_OK, status;
    mpm__ptw_shared h;
    mpm__ptw_bounds bounds;
    mpm__ptw_lanes a;
    if (block->count < 0) return mpm_fail(block->fault, MPM_ERR_ARGUMENT, "count", (mpm_real)block->count, -1);
    if (!(block->dt > 0)) return mpm_fail(block->fault, MPM_ERR_ARGUMENT, "dt", block->dt, -1);
    MPM__PTW_REQUIRE(mpm__ptw_marked(m, block->fault));
    if (m->mapping == MPM_RETURN_STAGED && !mpm__ptw_has_field(m, block))
        return mpm_fail(block->fault, MPM_ERR_ARGUMENT, "user_fields (a staged return needs its flow_field)",
                        (mpm_real)m->flow_field, -1);
    h = mpm__ptw_share(m);
    bounds = mpm__ptw_bound(m, &h);
    for (a.first = 0; a.first < block->count; a.first += MPM__PTW_LANES) {
        a.count = block->count - a.first < MPM__PTW_LANES ? block->count - a.first : MPM__PTW_LANES;
        status = mpm__ptw_update(m, &h, &bounds, block, &a);
        if (status < 0) return status;
        if (status > worst) worst = status; /* MPM_NOT_CONVERGED rather than MPM_CLAMPED */
    }
    return worst;
}

/* ---- presets ------------------------------------------------------------------------------- */

/* Moduli and equation of state of a metal. E = 9 K G/(3 K + G), nu = (3 K - 2 G)/(2 (3 K + G)), with K = rho c0^2 and
   G0 of the SCG table, where they are not given. */
static inline void mpm__ptw_use_metal(mpm_material *m, const mpm__ptw_metal *t)
{
    const mpm__ptw_set_scg *g = MPM__PTW_FIND(mpm__ptw_set_scg, mpm__ptw_sets_scg, t->name);
    double young = t->young, nu = t->poisson;
    if (t->young <= 0 && g) {
        double bulk = t->density * t->sound * t->sound, shear = g->shear;
        young = 9 * bulk * shear / (3 * bulk + shear);
        nu = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear));
    }
    mpm__ptw_use_textbook(m, young, nu);
    m->eos = t->sound > 0 ? MPM_EOS_MIE_GRUENEISEN : MPM_EOS_LINEAR;
}

/* Sets strength, shear modulus, melting and equation of state of a metal. */
static inline mpm_status mpm__ptw_use(mpm_material *m, const mpm__ptw_metal *t, const char *model, mpm_fault *fault)
{
    const mpm__ptw_law *law = mpm__ptw_law_named(model);
    mpm_material next = *m;
    if (!law) return mpm_fail(fault, MPM_ERR_UNKNOWN, "model", 0, -1);
    mpm__ptw_use_metal(&next, t);
    next.strength = law->strength;
    if (!law->preset || !law->preset(&next, t->name))
        return mpm_fail(fault, MPM_ERR_UNKNOWN, "model of material", 0, -1);
    *m = next;
    return MPM_OK;
}

MPM_API mpm_material mpm_material_default(void)
{
    mpm_material m;
    memset(&m, 0, sizeof m); /* every choice's first value is 0: elastic, constant, none, linear */
    m.mark = MPM_MARK;
    m.name = "";
    m.units = mpm_units_si();
    m.flow_field = -1;
    m.temperature = 298;
    m.heat_fraction = MPM_R(0.9);
    m.shear_floor = MPM_R(1e-3);
    return m;
}

MPM_API mpm_status mpm_material_preset(mpm_material *m, const char *name, const mpm_units *units,
                                       mpm_fault *fault)
{
    const mpm__ptw_metal *t = MPM__PTW_FIND(mpm__ptw_metal, mpm__ptw_metals, name);
    mpm_material next = mpm_material_default();
    mpm_status status;
    if (!t) return mpm_fail(fault, MPM_ERR_UNKNOWN, "material", 0, -1);
    MPM__PTW_REQUIRE(mpm__ptw_positive("units.length", (mpm_real)units->length, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("units.mass", (mpm_real)units->mass, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("units.time", (mpm_real)units->time, fault));
    next.name = t->name;
    next.units = *units;
    next.density = (mpm_real)(t->density / mpm_units_density(units));
    next.specific_heat = (mpm_real)(t->heat / mpm_units_specific_energy(units));
    next.sound_speed = (mpm_real)(t->sound / mpm_units_velocity(units));
    next.hugoniot_slope = (mpm_real)t->slope;
    next.gruneisen = (mpm_real)t->gruneisen;
    status = mpm__ptw_use(&next, t, t->model, fault);
    if (status == MPM_OK) *m = next;
    return status;
}

MPM_API mpm_status mpm_material_model(mpm_material *m, const char *model, mpm_fault *fault)
{
    const mpm__ptw_metal *t;
    MPM__PTW_REQUIRE(mpm__ptw_marked(m, fault));
    t = MPM__PTW_FIND(mpm__ptw_metal, mpm__ptw_metals, m->name);
    if (!t) return mpm_fail(fault, MPM_ERR_UNKNOWN, "material", 0, -1);
    return mpm__ptw_use(m, t, model, fault);
}

MPM_API int mpm_material_preset_count(void)
{
    return (int)(sizeof mpm__ptw_metals / sizeof mpm__ptw_metals[0]);
}

MPM_API const char *mpm_material_preset_name(int i)
{
    return i >= 0 && i < mpm_material_preset_count() ? mpm__ptw_metals[i].name : NULL;
}

/* ---- the check ----------------------------------------------------------------------------- */

static inline mpm_status mpm__ptw_check_shear(const mpm_material *m, mpm_fault *fault)
{
    const mpm_real big = mpm__ptw_infinity();
    MPM__PTW_REQUIRE(mpm__ptw_positive("shear_modulus", m->shear_modulus, fault));
    MPM__PTW_REQUIRE(mpm_want(m->shear_floor > 0 && m->shear_floor <= 1, fault, "shear_floor", m->shear_floor, -1));
    if (m->shear == MPM_SHEAR_MTS) {
        MPM__PTW_REQUIRE(mpm__ptw_within("shear_d", m->shear_d, 0, big, fault));
        MPM__PTW_REQUIRE(mpm__ptw_positive("shear_t", m->shear_t, fault));
    } else if (m->shear == MPM_SHEAR_SCG) {
        MPM__PTW_REQUIRE(mpm__ptw_within("shear_a", m->shear_a, 0, big, fault));
        MPM__PTW_REQUIRE(mpm__ptw_within("shear_b", m->shear_b, 0, big, fault));
    }
    return MPM_OK;
}

static inline mpm_status mpm__ptw_check_melt_and_eos(const mpm_material *m, mpm_fault *fault)
{
    const mpm_real big = mpm__ptw_infinity();
    if (m->melt != MPM_MELT_NONE)
        MPM__PTW_REQUIRE(mpm__ptw_positive("melt_temperature", m->melt_temperature, fault));
    if (m->melt == MPM_MELT_SCG) {
        MPM__PTW_REQUIRE(mpm__ptw_within("melt_a", m->melt_a, 0, big, fault));
        /* With less, T_m would fall on compression from rho0. */
        MPM__PTW_REQUIRE(mpm__ptw_within("gruneisen", m->gruneisen, MPM_R(1.0) / 3, big, fault));
    }
    if (m->eos == MPM_EOS_USER && !m->eos_fn) return mpm_fail(fault, MPM_ERR_ARGUMENT, "eos_fn", 0, -1);
    if (m->eos == MPM_EOS_MIE_GRUENEISEN) {
        MPM__PTW_REQUIRE(mpm__ptw_positive("sound_speed", m->sound_speed, fault));
        MPM__PTW_REQUIRE(mpm__ptw_within("hugoniot_slope", m->hugoniot_slope, 0, big, fault));
        MPM__PTW_REQUIRE(mpm__ptw_within("gruneisen", m->gruneisen, 0, big, fault));
    }
    return MPM_OK;
}

static inline mpm_status mpm__ptw_choice(const char *field, int choice, int count, mpm_fault *fault)
{
    return mpm_want(choice >= 0 && choice < count, fault, field, (mpm_real)choice, -1);
}

static inline mpm_status mpm__ptw_check_choices(const mpm_material *m, mpm_fault *fault)
{
    MPM__PTW_REQUIRE(mpm__ptw_choice("strength", (int)m->strength, MPM_STRENGTHS, fault));
    MPM__PTW_REQUIRE(mpm__ptw_choice("shear", (int)m->shear, MPM_SHEARS, fault));
    MPM__PTW_REQUIRE(mpm__ptw_choice("melt", (int)m->melt, MPM_MELTS, fault));
    MPM__PTW_REQUIRE(mpm__ptw_choice("eos", (int)m->eos, MPM_EOSES, fault));
    MPM__PTW_REQUIRE(mpm__ptw_choice("mapping", (int)m->mapping, MPM_RETURNS, fault));
    return mpm__ptw_choice("rotation", (int)m->rotation, MPM_ROTATIONS, fault);
}

MPM_API mpm_status mpm_material_check(const mpm_material *m, mpm_fault *fault)
{
    const mpm_real big = mpm__ptw_infinity();
    MPM__PTW_REQUIRE(mpm__ptw_marked(m, fault));
    MPM__PTW_REQUIRE(mpm__ptw_check_choices(m, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("density", m->density, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("temperature", m->temperature, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("heat_fraction", m->heat_fraction, 0, 1, fault));
    if ((m->strength != MPM_STRENGTH_ELASTIC && m->heat_fraction > 0) || m->compression_heating)
        MPM__PTW_REQUIRE(mpm__ptw_positive("specific_heat", m->specific_heat, fault));
    MPM__PTW_REQUIRE(mpm__ptw_positive("young", m->young, fault));
    MPM__PTW_REQUIRE(mpm_want(m->poisson > -1 && m->poisson < MPM_R(0.5), fault, "poisson", m->poisson, -1));
    MPM__PTW_REQUIRE(mpm__ptw_within("viscosity_linear", m->viscosity_linear, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_within("viscosity_quadratic", m->viscosity_quadratic, 0, big, fault));
    MPM__PTW_REQUIRE(mpm__ptw_check_shear(m, fault));
    MPM__PTW_REQUIRE(mpm__ptw_check_melt_and_eos(m, fault));
    return mpm__ptw_law_of(m->strength)->judge(m, fault);
}

#ifdef __cplusplus
}
#endif

#endif /* MPM__PTW_IMPLEMENTED */
