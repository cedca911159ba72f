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

#include <string.h>

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
    mpm_real rate_factor;    /* gamma/2 (4 pi/(3 M))^(1/3) rho0^(-1/6): gamma xidot per sqrt(mu) */
    mpm_real cross;          /* ln r beyond which y1 r^y2 >= s0 r^s1 for certain */
} mpm__ptw_shared;

/* What one point needs of its state, before strain and rate are known. */
typedef struct mpm__ptw_point {
    mpm_material_state state;  /* strain and rate are overwritten as the solution tries them */
    mpm_real shear;            /* mu */
    mpm_real melt, hat;        /* T_m and T/T_m */
    mpm_real eta, log_eta;     /* rho/rho0 and its logarithm */
    mpm_real rate_scale;       /* r = rate rate_scale eta^(1/6), from A 2.8 */
} mpm__ptw_point;

/* The plastic strains between which the flow stress is bounded by straight lines. */
enum { MPM__PTW_KNOTS = 6 };
static const mpm_real mpm__ptw_knots[MPM__PTW_KNOTS] = {MPM_R(0.0),  MPM_R(0.02), MPM_R(0.06),
                                                        MPM_R(0.15), MPM_R(0.4),  MPM_R(1.5)};

/* A lower bound of the static flow stress, of a solid point above 0 K: mu times the line between the values of
   `shear` at the knots, plus `stress`. It spares most elastic points the full law. */
typedef struct mpm__ptw_bounds {
    mpm_real shear[MPM__PTW_KNOTS], stress;
} mpm__ptw_bounds;

/* All that is known of one flow stress. To add one: a line in MPM_STRENGTH_LIST, its numbers in mpm_material, the
   functions named here and a row of mpm__ptw_laws. */
typedef struct mpm__ptw_law {
    mpm_strength strength;
    mpm_status (*judge)(const mpm_material *m, mpm_fault *fault);  /* the numbers it reads */
    mpm_flow (*flow)(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p); /* below melting */
    void (*bound)(const mpm_material *m, mpm__ptw_bounds *b);      /* fills zeros; NULL: none is known */
    int (*preset)(mpm_material *m, const char *metal);             /* its set for a metal, 0: none; NULL: no sets */
} mpm__ptw_law;

/* T_m = T_m0 exp(2 a (1 - 1/eta)) eta^(2 (Gamma0 - a - 1/3)) (A 2.9). */
static inline mpm_real mpm__ptw_melt(const mpm_material *m, mpm_real melt_exponent, mpm_real log_eta,
                                     mpm_real eta)
{
    if (m->melt == MPM_MELT_NONE) return mpm__ptw_infinity();
    if (m->melt == MPM_MELT_CONSTANT) return m->melt_temperature;
    return m->melt_temperature *
           mpm_exp(2 * m->melt_a * (1 - 1 / eta) + melt_exponent * log_eta);
}

/* mu0 - D/(exp(T0/T) - 1) (A 2.6); at T = 0 it is mu0 exactly. */
static inline mpm_real mpm__ptw_shear_mts(const mpm_material *m, mpm_real temperature)
{
    if (!(temperature > 0)) return m->shear_modulus;
    return m->shear_modulus - m->shear_d / mpm_expm1(m->shear_t / temperature);
}

/* mu0 (1 + A p/eta^(1/3) - B (T - 300 K)) [S]. */
static inline mpm_real mpm__ptw_shear_scg(const mpm_material *m, mpm_real temperature, mpm_real pressure,
                                          mpm_real eta)
{
    mpm_real cold = 1 + m->shear_a * pressure / mpm_cbrt(eta);
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

/* Everything about a point that does not depend on strain and rate, its shear modulus given. ln(rho/rho0) is needed
   by the melting law and by xidot only. */
static inline mpm__ptw_point mpm__ptw_prepare(const mpm_material *m, const mpm__ptw_shared *h,
                                              const mpm_material_state *s, mpm_real shear)
{
    mpm__ptw_point p;
    mpm_real eta = s->density / m->density;
    p.state = *s;
    p.shear = shear;
    p.eta = eta;
    p.log_eta = 0;
    p.rate_scale = 0;
    if (m->melt == MPM_MELT_SCG || m->strength == MPM_STRENGTH_PTW) p.log_eta = mpm_log(eta);
    p.melt = mpm__ptw_melt(m, h->melt_exponent, p.log_eta, eta);
    p.hat = s->temperature / p.melt;
    if (m->strength == MPM_STRENGTH_PTW)
        p.rate_scale = 1 / (h->rate_factor * mpm_sqrt(shear));
    return p;
}

/* ---- Preston-Tonks-Wallace ------------------------------------------------------------------- */

/* Saturation and yield stress over 2 mu, and their slopes with respect to L = ln r. */
typedef struct mpm__ptw_levels {
    mpm_real s, y, s_slope, y_slope;
} mpm__ptw_levels;

/* The erf terms of A 2.7, s0 - (s0 - sinf) erf x and y0 - (y0 - yinf) erf x, with dx/dL = slope (<= 0). */
static inline void mpm__ptw_thermal(const mpm_ptw *c, mpm_real x, mpm_real slope, mpm__ptw_levels *v)
{
    const mpm_real two_over_root_pi = MPM_R(1.12837916709551257390);
    /* erf is 1 to the last bit of a double from 5.93 on, and of a float well before. */
    mpm_real erf_x = x >= 6 ? 1 : mpm_erf(x);
    mpm_real bell = x >= 6 ? 0 : -slope * two_over_root_pi * mpm_exp(-x * x);
    v->s = c->s0 - (c->s0 - c->sinf) * erf_x;
    v->y = c->y0 - (c->y0 - c->yinf) * erf_x;
    v->s_slope = (c->s0 - c->sinf) * bell;
    v->y_slope = (c->y0 - c->yinf) * bell;
}

/* Whether both erf terms certainly stay below the power laws `shock` and `low`. For x >= 0,
   1 - erf x <= exp(-x^2) <= 1/(1 + x^2 + x^4/2 + x^6/6), which needs neither erf nor exp. */
static inline int mpm__ptw_thermal_hidden(const mpm_ptw *c, mpm_real x, mpm_real shock, mpm_real low)
{
    mpm_real q = x * x;
    mpm_real tail = (1 + 8 * MPM_EPSILON) / (1 + q * (1 + q * (MPM_R(0.5) + q / 6)));
    mpm_real s = (c->sinf + (c->s0 - c->sinf) * tail) * (1 + 8 * MPM_EPSILON);
    mpm_real y = (c->yinf + (c->y0 - c->yinf) * tail) * (1 + 8 * MPM_EPSILON);
    return x >= 0 && s < shock && y < low;
}

/* tau_s = max(s0 - (s0 - sinf) erf x, s0 r^s1), tau_y = max(y0 - (y0 - yinf) erf x, min(y1 r^y2, s0 r^s1)) (A 2.7)
   with x = kappa T_hat ln(1/r), T_hat = T/T_m, L = ln r. The shock term s0 r^s1 is computed once, so that
   tau_s = tau_y exactly where both follow it. */
static inline mpm__ptw_levels mpm__ptw_saturation(const mpm_material *m, const mpm__ptw_shared *h,
                                                  mpm_real T_hat, mpm_real L)
{
    const mpm_ptw *c = &m->ptw;
    mpm_real shock = c->s0 * mpm_exp(c->s1 * L);
    mpm_real low = shock, low_slope = c->s1 * shock;
    mpm_real x = -c->kappa * T_hat * L, x_slope = -c->kappa * T_hat;
    mpm__ptw_levels v;
    if (L < h->cross) {
        mpm_real power = c->y1 * mpm_exp(c->y2 * L);
        if (power < shock) {
            low = power;
            low_slope = c->y2 * power;
        }
    }
    if (x < 0 && !m->erf_literal) x = x_slope = 0;
    if (mpm__ptw_thermal_hidden(c, x, shock, low)) {
        v.s = v.y = 0;
        v.s_slope = v.y_slope = 0;
    } else {
        mpm__ptw_thermal(c, x, x_slope, &v);
    }
    if (shock >= v.s) {
        v.s = shock;
        v.s_slope = c->s1 * shock;
    }
    if (low >= v.y) {
        v.y = low;
        v.y_slope = low_slope;
    }
    return v;
}

/* A rate of zero lets heat do all it can: erf = 1. At T = 0 there is no heat: erf = 0 at any rate. */
static inline mpm__ptw_levels mpm__ptw_static_levels(const mpm_ptw *c, mpm_real temperature)
{
    mpm__ptw_levels v;
    mpm__ptw_thermal(c, temperature > 0 ? MPM_R(6.0) : MPM_R(0.0), 0, &v);
    return v;
}

/* The Voce limit d = 0 of A 2.4: tau = tau_s - (tau_s - tau_y) exp(-theta eps/(tau_s - tau_y)). */
static inline mpm_flow mpm__ptw_voce(const mpm_ptw *c, const mpm__ptw_levels *v, mpm_real strain)
{
    mpm_real gap = v->s - v->y, gap_slope = v->s_slope - v->y_slope;
    mpm_real u = c->theta * strain / gap, e = mpm_exp(-u);
    mpm_flow f;
    f.stress = v->s - gap * e;
    f.strain_slope = c->theta * e;
    f.rate_slope = v->s_slope - gap_slope * e * (1 + u);
    return f;
}

/* alpha < 0 (tau_y > s0): tau_s + alpha ln(1 - psi exp t), t = -beta - theta eps/(alpha psi) (A 2.4) as printed, the
   exponential taken out where it would overflow. */
static inline mpm_flow mpm__ptw_harden_negative(const mpm_ptw *c, const mpm__ptw_levels *v,
                                                mpm_real strain, mpm_real alpha)
{
    mpm_real beta = (v->s - v->y) / alpha, psi = mpm_expm1(beta);
    mpm_real t = -beta - c->theta * strain / (alpha * psi);
    mpm_real e = mpm_exp(-mpm_fabs(t));
    mpm_flow f;
    f.stress = v->s + alpha * (t > 0 ? t + mpm_log(e - psi) : mpm_log(1 - psi * e));
    f.strain_slope = t > 0 ? c->theta / (e - psi) : c->theta * e / (1 - psi * e);
    f.rate_slope = v->s_slope;
    return f;
}

/* A 2.4 over 2 mu for tau_s > tau_y, written as tau = tau_y + alpha ln W with
   W = 1 + psi (1 - exp(-z)), z = theta eps/(alpha psi): the same number, exactly tau_y at zero
   strain. */
static inline mpm_flow mpm__ptw_harden_positive(const mpm_ptw *c, const mpm__ptw_levels *v,
                                                mpm_real strain, mpm_real alpha)
{
    mpm_real beta = (v->s - v->y) / alpha;
    mpm_real psi = mpm_expm1(beta), z = c->theta * strain / (alpha * psi);
    mpm_real gone = -mpm_expm1(-z), left = 1 - gone;
    mpm_real W = 1 + psi * gone, log_W = mpm_log(W);
    mpm_real alpha_slope = -v->y_slope / c->d;
    mpm_real beta_slope = (v->s_slope - v->y_slope - beta * alpha_slope) / alpha;
    mpm_real psi_slope = (1 + psi) * beta_slope;
    mpm_real z_slope = -z * (alpha_slope / alpha + psi_slope / psi);
    mpm_real W_slope = psi_slope * gone + psi * left * z_slope;
    mpm_flow f;
    f.stress = v->y + alpha * log_W;
    f.strain_slope = c->theta * left / W;
    f.rate_slope = v->y_slope + alpha_slope * log_W + alpha * W_slope / W;
    return f;
}

/* alpha -> 0 from above (or beta too large for exp): psi (1 - exp(-z)) -> theta eps/alpha, so that
   tau = tau_y + alpha ln(1 + theta eps/alpha). */
static inline mpm_flow mpm__ptw_harden_steep(const mpm_ptw *c, const mpm__ptw_levels *v,
                                             mpm_real strain, mpm_real alpha)
{
    mpm_flow f;
    mpm_real w = alpha > 0 ? c->theta * strain / alpha : 0;
    f.stress = v->y + (alpha > 0 ? alpha * mpm_log(1 + w) : 0);
    f.strain_slope = c->theta / (1 + w);
    f.rate_slope = v->y_slope;
    return f;
}

/* tau = tau_s + alpha ln(1 - psi exp(-beta - theta eps/(alpha psi))) (A 2.4, 2.5), sigma over 2 mu, with all its
   limits. */
static inline mpm_flow mpm__ptw_harden(const mpm_ptw *c, const mpm__ptw_levels *v, mpm_real strain)
{
    mpm_flow f;
    mpm_real gap = v->s - v->y, alpha;
    f.stress = v->s;
    f.strain_slope = 0;
    f.rate_slope = v->s_slope;
    if (!(gap > 0)) return f; /* beta = psi = 0: saturated */
    if (!(c->d > 0)) return mpm__ptw_voce(c, v, strain);
    alpha = (c->s0 - v->y) / c->d;
    if (alpha < 0) return mpm__ptw_harden_negative(c, v, strain, alpha);
    if (!(gap < 80 * alpha)) return mpm__ptw_harden_steep(c, v, strain, alpha);
    if (gap < alpha * MPM_EPSILON) return f;
    return mpm__ptw_harden_positive(c, v, strain, alpha);
}

/* sigma = 2 mu tau(eps, ln r, T_hat), r = rate/(gamma xidot) (A 2.4 - 2.8). */
static inline mpm_flow mpm__ptw_flow_ptw(const mpm_material *m, const mpm__ptw_shared *h,
                                         const mpm__ptw_point *p)
{
    mpm_real strain = p->state.plastic_strain, rate = p->state.plastic_rate;
    mpm__ptw_levels v;
    mpm_flow f;
    if (rate > 0)
        v = mpm__ptw_saturation(m, h, p->hat, mpm_log(rate * p->rate_scale) + p->log_eta / 6);
    else
        v = mpm__ptw_static_levels(&m->ptw, p->state.temperature);
    f = mpm__ptw_harden(&m->ptw, &v, strain);
    f.stress *= 2 * p->shear;
    f.strain_slope *= 2 * p->shear;
    f.rate_slope *= 2 * p->shear;
    return f;
}

/* At rate 0 the stress over mu is a rising concave function of strain alone: the chords lie below it. */
static inline void mpm__ptw_bound_ptw(const mpm_material *m, mpm__ptw_bounds *b)
{
    const mpm__ptw_levels v = mpm__ptw_static_levels(&m->ptw, 1);
    int i;
    for (i = 0; i < MPM__PTW_KNOTS; i++) b->shear[i] = 2 * mpm__ptw_harden(&m->ptw, &v, mpm__ptw_knots[i]).stress;
}

/* Whether a rate lies beyond r = 1: r^6 = (rate rate_scale)^6 eta needs no logarithm. */
static inline int mpm__ptw_overdriven(const mpm__ptw_point *p, mpm_real rate)
{
    mpm_real r = rate * p->rate_scale, cube = r * r * r;
    return cube * cube * p->eta > 1;
}

/* ---- the other strengths ------------------------------------------------------------------- */

/* sigma = infinity. */
static inline mpm_flow mpm__ptw_flow_elastic(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p)
{
    mpm_flow f;
    (void)m;
    (void)h;
    (void)p;
    f.stress = mpm__ptw_infinity();
    f.strain_slope = f.rate_slope = 0;
    return f;
}

/* sigma = strength_fn(point). */
static inline mpm_flow mpm__ptw_flow_user(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p)
{
    (void)h;
    return m->strength_fn(m->strength_context, m, &p->state);
}

/* sigma = Y + H eps, at least 0. */
static inline mpm_flow mpm__ptw_flow_linear(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p)
{
    mpm_flow f;
    (void)h;
    f.stress = m->linear_yield + m->linear_hardening * p->state.plastic_strain;
    f.strain_slope = m->linear_hardening;
    f.rate_slope = 0;
    if (f.stress < 0) f.stress = f.strain_slope = 0; /* softened to nothing */
    return f;
}

/* sigma >= Y where it hardens. */
static inline void mpm__ptw_bound_linear(const mpm_material *m, mpm__ptw_bounds *b)
{
    if (m->linear_hardening >= 0) b->stress = m->linear_yield;
}

/* d (b eps^n)/d eps. With n < 1 it starts at infinity; at zero strain (only) it is therefore taken at the elastic
   strain of first yield, a/(3 mu). */
static inline mpm_real mpm__ptw_slope_jc(const mpm_jc *c, mpm_real strain, mpm_real hardened, mpm_real shear)
{
    mpm_real first = c->a / (3 * shear);
    if (!(c->b > 0)) return 0;
    if (strain > 0) return c->n * hardened / strain;
    return first > 0 ? c->n * (c->b * mpm_pow(first, c->n)) / first : 0;
}

/* sigma = (a + b eps^n) (1 + c ln(rate/rate0)) (1 - T*^m), T* = (T - T0)/(T_m - T0) [JC]. */
static inline mpm_flow mpm__ptw_flow_jc(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p)
{
    const mpm_jc *c = &m->jc;
    mpm_real strain = p->state.plastic_strain, rate = p->state.plastic_rate;
    mpm_real T_star = (p->state.temperature - c->temperature) / (p->melt - c->temperature);
    mpm_real soft = T_star > 0 ? 1 - mpm_pow(T_star, c->m) : 1;
    mpm_real hard = c->a + (strain > 0 ? c->b * mpm_pow(strain, c->n) : 0);
    mpm_real fast = rate > c->rate ? 1 + c->c * mpm_log(rate / c->rate) : 1;
    mpm_flow f;
    (void)h;
    f.stress = hard * fast * soft;
    f.strain_slope = mpm__ptw_slope_jc(c, strain, hard - c->a, p->shear) * fast * soft;
    f.rate_slope = rate > c->rate ? hard * soft * c->c : 0;
    return f;
}

/* sigma = min(y0 (1 + beta eps)^n, ymax) mu/mu0 [S]. */
static inline mpm_flow mpm__ptw_flow_scg(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p)
{
    const mpm_scg *c = &m->scg;
    mpm_real stretch = 1 + c->beta * p->state.plastic_strain;
    mpm_real hard = c->y0 * mpm_pow(stretch, c->n), scale = p->shear / m->shear_modulus;
    mpm_flow f;
    (void)h;
    f.stress = mpm__ptw_min(hard, c->ymax) * scale;
    f.strain_slope = hard < c->ymax ? c->n * c->beta * hard / stretch * scale : 0;
    f.rate_slope = 0;
    return f;
}

/* min(y0 (1 + beta eps)^n, ymax)/mu0: concave for n <= 1, so that chords lie below it; for more, the value at zero
   strain. */
static inline void mpm__ptw_bound_scg(const mpm_material *m, mpm__ptw_bounds *b)
{
    const mpm_scg *c = &m->scg;
    int i;
    for (i = 0; i < MPM__PTW_KNOTS; i++) {
        mpm_real strain = c->n > 1 ? 0 : mpm__ptw_knots[i];
        b->shear[i] = mpm__ptw_min(c->y0 * mpm_pow(1 + c->beta * strain, c->n), c->ymax) / m->shear_modulus;
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
    {MPM_STRENGTH_JC, mpm__ptw_check_jc, mpm__ptw_flow_jc, NULL, mpm__ptw_use_jc},
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
    h.rate_factor = 0;
    h.cross = mpm__ptw_infinity();
    if (m->strength == MPM_STRENGTH_PTW) {
        mpm_real atoms = mpm_cbrt(4 * MPM_PI * m->density / (3 * c->atomic_mass));
        h.rate_factor = c->gamma * atoms / (2 * mpm_sqrt(m->density));
        if (c->y2 > c->s1)
            h.cross = mpm_log(c->s0 / c->y1) / (c->y2 - c->s1) + MPM_R(0.01);
    }
    return h;
}

static inline mpm_flow mpm__ptw_flow(const mpm_material *m, const mpm__ptw_shared *h, const mpm__ptw_point *p)
{
    mpm_flow f;
    f.stress = f.strain_slope = f.rate_slope = 0;
    return p->state.temperature >= p->melt ? f : h->law->flow(m, h, p);
}

/* The bound of the material's strength. The staged return yields at the flow stress of an earlier step: only the value
   at zero strain (tau_y >= yinf of PTW) is used there. The factor below 1 covers rounding. */
static inline mpm__ptw_bounds mpm__ptw_bound(const mpm_material *m, const mpm__ptw_shared *h)
{
    const mpm_real safe = 1 - 64 * MPM_EPSILON;
    mpm__ptw_bounds b;
    int i;
    memset(&b, 0, sizeof b);
    if (h->law->bound) h->law->bound(m, &b);
    b.stress *= safe;
    for (i = MPM__PTW_KNOTS - 1; i >= 0; i--) b.shear[i] = safe * b.shear[m->mapping == MPM_RETURN_STAGED ? 0 : i];
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
    mpm__ptw_point p = mpm__ptw_prepare(m, &h, s, mpm_material_shear_modulus(m, s));
    return mpm__ptw_flow(m, &h, &p);
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

/* Points are worked on in groups of this many, as plain arrays on the stack. */
enum { MPM__PTW_LANES = 64 };

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
    mpm_real increment[MPM__PTW_LANES];   /* plastic strain increment */
    mpm_real dissipated[MPM__PTW_LANES];  /* plastic work per volume of the increment */
    mpm_real temperature[MPM__PTW_LANES]; /* of level k+1 */
    mpm_real staged[MPM__PTW_LANES];      /* flow stress that a staged return leaves to the next step */
    int yielding[MPM__PTW_LANES], yield_count;  /* points that were returned */
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
    mpm_real limit = mpm__ptw_infinity(), half = 0, rho0 = m->density, sum = 0;
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
        sum += (a->mises2[i] + a->mean[i] + b->energy[k] + b->plastic_rate[k] + b->plastic_work[k] + T +
                strain + volume) * 0;
        bad |= !(rho > 0 && rho < limit && T >= 0 && strain >= 0 && volume > -1 &&
                 old + half * rho0 * volume > 0);
    }
    if (!bad && sum == 0) return MPM_OK;
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

/* The shear modulus of every point; returns how many were bounded. Neighbours often share a temperature to the
   last bit. */
static inline int mpm__ptw_shear_lanes(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a)
{
    mpm_real least = mpm__ptw_shear_floor(m), last = -1, mu = 0;
    int i, hits = 0;
    for (i = 0; i < a->count; i++) {
        mpm_real T = b->temperature[a->first + i];
        if (T != last || m->shear == MPM_SHEAR_SCG)
            mu = mpm__ptw_shear_raw(m, T, -a->mean[i], b->density[a->first + i] / m->density);
        last = T;
        hits += mu < least;
        a->shear[i] = mpm__ptw_max(mu, least);
    }
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

/* s <- R s R^T with R of Hughes and Winget: R = I + u (H + H^2), H v = h x v, h half the rotation
   increment, u = 2/(1 + h.h). R is orthogonal for any h, so invariants are kept to rounding. */
static inline void mpm__ptw_rotate_proper(const mpm_block *b, mpm__ptw_lanes *a)
{
    int i, k = a->first;
    for (i = 0; i < a->count; i++) {
        mpm_real x = b->spin[0][k + i] / 2, y = b->spin[1][k + i] / 2, z = b->spin[2][k + i] / 2;
        mpm_real u = 2 / (1 + x * x + y * y + z * z);
        mpm_real r00 = 1 - u * (y * y + z * z), r01 = u * (x * y - z), r02 = u * (x * z + y);
        mpm_real r10 = u * (x * y + z), r11 = 1 - u * (x * x + z * z), r12 = u * (y * z - x);
        mpm_real r20 = u * (x * z - y), r21 = u * (y * z + x), r22 = 1 - u * (x * x + y * y);
        mpm_real sxx = a->rotated[0][i], syy = a->rotated[1][i], szz = a->rotated[2][i];
        mpm_real syz = a->rotated[3][i], sxz = a->rotated[4][i], sxy = a->rotated[5][i];
        mpm_real m00 = r00 * sxx + r01 * sxy + r02 * sxz, m01 = r00 * sxy + r01 * syy + r02 * syz;
        mpm_real m02 = r00 * sxz + r01 * syz + r02 * szz, m10 = r10 * sxx + r11 * sxy + r12 * sxz;
        mpm_real m11 = r10 * sxy + r11 * syy + r12 * syz, m12 = r10 * sxz + r11 * syz + r12 * szz;
        mpm_real m20 = r20 * sxx + r21 * sxy + r22 * sxz, m21 = r20 * sxy + r21 * syy + r22 * syz;
        mpm_real m22 = r20 * sxz + r21 * syz + r22 * szz;
        a->rotated[0][i] = m00 * r00 + m01 * r01 + m02 * r02;
        a->rotated[1][i] = m10 * r10 + m11 * r11 + m12 * r12;
        a->rotated[2][i] = m20 * r20 + m21 * r21 + m22 * r22;
        a->rotated[3][i] = m10 * r20 + m11 * r21 + m12 * r22;
        a->rotated[4][i] = m00 * r20 + m01 * r21 + m02 * r22;
        a->rotated[5][i] = m00 * r10 + m01 * r11 + m02 * r12;
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

/* The line between the knots at a strain >= 0. */
static inline mpm_real mpm__ptw_chord(const mpm__ptw_bounds *bounds, mpm_real strain)
{
    const mpm_real *x = mpm__ptw_knots, *y = bounds->shear;
    int i = 1;
    if (strain >= x[MPM__PTW_KNOTS - 1]) return y[MPM__PTW_KNOTS - 1];
    while (strain >= x[i]) i++;
    return y[i - 1] + (y[i] - y[i - 1]) * ((strain - x[i - 1]) / (x[i] - x[i - 1]));
}

/* One search for a return: what is sought and what is known of it. */
typedef struct mpm__ptw_search {
    mpm__ptw_point point;
    mpm_real mises;      /* trial von Mises stress */
    mpm_real strain;     /* plastic strain at level k */
    mpm_real d;          /* the increment: next to be tried, then the answer */
    mpm_real least;      /* the smallest increment that counts */
    mpm_real low, high;  /* bracket of d */
    mpm_real step;       /* the last change of d; more than high before the first */
    mpm_real slope;      /* d flow stress / d d at the last d */
    int yields;          /* whether the flow stress at least is known to be exceeded */
    int lane;            /* whose search it is */
} mpm__ptw_search;

/* The flow law at plastic strain eps + d and rate d/dt. */
static inline mpm_flow mpm__ptw_flow_at(const mpm_material *m, const mpm__ptw_shared *h,
                                        mpm__ptw_search *q, mpm_real d, mpm_real per_step)
{
    q->point.state.plastic_strain = q->strain + d;
    q->point.state.plastic_rate = d * per_step;
    return mpm__ptw_flow(m, h, &q->point);
}

#ifdef MPM_FLOAT
#define MPM__PTW_TOLERANCE (32 * MPM_EPSILON)
#else
#define MPM__PTW_TOLERANCE 1e-10
#endif

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
   is always evaluated at its root, for its slopes are not trusted. */
static inline void mpm__ptw_search_begin(mpm__ptw_search *q, mpm_real mises, mpm_real dt, int lane)
{
    q->mises = mises;
    q->strain = q->point.state.plastic_strain;
    q->d = q->point.state.plastic_rate * dt;
    q->high = mises / (3 * q->point.shear);
    q->low = q->least = MPM_EPSILON * q->high;
    q->step = mpm__ptw_infinity();
    q->slope = 0;
    q->yields = 0;
    q->lane = lane;
}

/* A better start than the rate of the last step: the old von Mises stress of lane i is the flow
   stress of that step, so with a guess S of d stress/d ln rate the new increment follows from one
   linear equation. PTW: S = s1 stress, exact where s0 r^s1 rules; other laws: S = 0. */
static inline void mpm__ptw_search_guess(const mpm_material *m, const mpm__ptw_lanes *a,
                                         mpm__ptw_search *q)
{
    int i = q->lane;
    mpm_real n2 = a->rotated[0][i] * a->rotated[0][i] + a->rotated[1][i] * a->rotated[1][i] +
                  a->rotated[2][i] * a->rotated[2][i];
    mpm_real t2 = a->rotated[3][i] * a->rotated[3][i] + a->rotated[4][i] * a->rotated[4][i] +
                  a->rotated[5][i] * a->rotated[5][i];
    mpm_real old = mpm_sqrt(MPM_R(1.5) * n2 + 3 * t2);
    mpm_real S = m->strength == MPM_STRENGTH_PTW ? m->ptw.s1 * old : 0;
    mpm_real d = q->d * (q->mises - old + S) / (3 * q->point.shear * q->d + S);
    if (d > q->least && d < q->high) q->d = d;
}

/* Whether the point yields at all; if so, a first guess of the increment unless there is one. */
static inline int mpm__ptw_search_yields(const mpm_material *m, const mpm__ptw_shared *h,
                                         mpm__ptw_search *q, mpm_real per_step)
{
    mpm_real stiff = 3 * q->point.shear, least = q->least, over;
    mpm_flow f = mpm__ptw_flow_at(m, h, q, least, per_step);
    over = q->mises - stiff * least - f.stress;
    q->yields = over > 0;
    q->d = over <= 0 ? 0 : q->step > q->high ? over / (stiff + f.strain_slope) : q->high;
    if (over != over) q->d = over;
    return q->yields;
}

/* Whether the relative step x leaves a residual within `close`, so that no further evaluation is
   needed: by the curvature S + H d of the law, and by what the slope changed in the step before. */
static inline int mpm__ptw_is_last(const mpm__ptw_search *q, const mpm_flow *f, mpm_real slope,
                                   mpm_real x, mpm_real close)
{
    int first = q->step > q->high;
    mpm_real left = (f->rate_slope + f->strain_slope * q->d) * x * x;
    mpm_real seen = mpm_fabs(slope - q->slope) * (x * q->d) * (x * q->d);
    return mpm_fabs(x) <= (first ? MPM_R(5e-6) : MPM_R(1e-4)) && left <= close &&
           (first || seen <= close * q->step);
}

/* Moves a search on by f, the law at its increment d: x is the relative step. Returns whether it is over. */
static inline int mpm__ptw_search_step(const mpm_material *m, mpm__ptw_search *q, const mpm_flow *f)
{
    mpm_real stiff = 3 * q->point.shear, close = MPM__PTW_TOLERANCE * q->mises, d = q->d;
    mpm_real residual = q->mises - stiff * d - f->stress;
    mpm_real inverse = 1 / ((stiff + f->strain_slope) * d + f->rate_slope);
    mpm_real slope = f->strain_slope + f->rate_slope / d, x = residual * inverse;
    int over = mpm_fabs(residual) <= close;
    if (residual > 0) {
        q->yields = 1;
        q->low = d;
    } else {
        q->high = d;
    }
    x /= mpm__ptw_max(1 - x * f->rate_slope * inverse / 2, MPM_R(0.25));
    if (m->strength == MPM_STRENGTH_USER) x = over ? 0 : x;
    else over = over || mpm__ptw_is_last(q, f, slope, x, close);
    over = over || q->high - q->low <= q->least;
    q->slope = slope;
    q->d = d + x * d;
    if (over)
        q->d = mpm__ptw_min(mpm__ptw_max(q->d, q->low), q->high);
    else if (2 * mpm_fabs(x * d) > q->step)
        q->d = q->low + (q->high - q->low) / 2;
    q->step = mpm_fabs(q->d - d);
    /* So small an increment that its residual proves nothing: is there any flow? */
    if (over && !q->yields && !(stiff * d > close)) {
        q->d = 0;
        return 0;
    }
    return over || residual != residual;
}

/* One round of the search. Returns whether it is over; then q->d is the answer, or NaN if the law
   gave NaN. */
static inline int mpm__ptw_search_on(const mpm_material *m, const mpm__ptw_shared *h,
                                     mpm__ptw_search *q, mpm_real per_step)
{
    mpm_flow f;
    if (q->point.state.temperature >= q->point.melt) {
        q->d = q->high; /* no strength: all of the deviator goes */
        return 1;
    }
    if (!q->yields && !(q->d > q->least) && !mpm__ptw_search_yields(m, h, q, per_step)) return 1;
    if (!(q->d > q->low && q->d <= q->high)) q->d = q->low + (q->high - q->low) / 2;
    f = mpm__ptw_flow_at(m, h, q, q->d, per_step);
    return mpm__ptw_search_step(m, q, &f);
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

/* The staged return of one lane: d = (sigma* - sigma_y)/(3 mu + E_p) (A6) with the flow stress sigma_y that the last
   return left, then the flow stress at the strain and rate it gives (A7), s = min(sigma_y/sigma*, 1) s* (A8). Before
   its first return a point has none: the flow stress at the rate `total` of the whole deviatoric strain stands for it.
   Sets q->d and a->staged; returns the stress returned to. */
static inline mpm_real mpm__ptw_stage(const mpm_material *m, const mpm__ptw_shared *h, const mpm_block *b,
                                      mpm__ptw_lanes *a, mpm__ptw_search *q)
{
    mpm_real per_step = 1 / b->dt, left = b->user[m->flow_field][a->first + q->lane];
    mpm_flow f;
    if (!(q->point.state.plastic_rate > 0))
        q->point.state.plastic_rate = mpm__ptw_effective(a, q->lane) * per_step;
    f = mpm__ptw_flow(m, h, &q->point);
    if (left > 0 && f.stress > 0) f.stress = left;
    q->d = 0;
    if (q->mises <= f.stress) return q->mises;
    q->d = (q->mises - f.stress) / (3 * q->point.shear + f.strain_slope);
    a->staged[q->lane] = mpm__ptw_flow_at(m, h, q, q->d, per_step).stress;
    return mpm__ptw_min(a->staged[q->lane], q->mises);
}

/* Lists the lanes that may yield, skipping solid ones below any flow stress. */
static inline int mpm__ptw_suspects(const mpm_material *m, const mpm__ptw_shared *h,
                                    const mpm__ptw_bounds *bounds, const mpm_block *b,
                                    const mpm__ptw_lanes *a, int *list)
{
    mpm_real rho_low = h->eta_low * m->density, rho_high = h->eta_high * m->density;
    int i, n = 0;
    for (i = 0; i < a->count; i++) {
        int k = a->first + i;
        mpm_real bound = mpm__ptw_chord(bounds, b->plastic_strain[k]) * a->shear[i] + bounds->stress;
        mpm_real T = b->temperature[k], rho = b->density[k];
        int spared = a->mises2[i] <= bound * bound && T > 0 && T < h->cold && rho >= rho_low &&
                     rho <= rho_high;
        list[n] = i;
        n += !spared;
    }
    return n;
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

/* Takes the answer of a search: increment, flow stress and the scaled deviator s = sigma_y/sigma* s* (A8) go to *a. */
static inline void mpm__ptw_take(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a,
                                 const mpm__ptw_search *q, mpm_real flow, mpm_real per_step)
{
    int j, i = q->lane;
    mpm_real factor;
    if (!(q->d > 0)) return;
    factor = flow / q->mises;
    a->increment[i] = q->d;
    a->dissipated[i] = m->mapping == MPM_RETURN_STAGED ? mpm__ptw_staged_work(a, i, factor) : flow * q->d;
    for (j = 0; j < 6; j++) a->trial[j][i] *= factor;
    a->yielding[a->yield_count++] = i;
    if (m->strength == MPM_STRENGTH_PTW && !m->erf_literal &&
        mpm__ptw_overdriven(&q->point, q->d * per_step))
        mpm__ptw_count(b, MPM_TALLY_ERF_CLIP, 1);
}

/* Runs the searches of one group side by side, so that the processor can overlap them: each round
   tries every open one once. Returns how many were still open at the cap. */
static inline int mpm__ptw_search_all(const mpm_material *m, const mpm__ptw_shared *h,
                                      mpm__ptw_search *q, int n, mpm_real per_step)
{
    int open[MPM__PTW_LANES], i, left, tries;
    for (i = 0; i < n; i++) open[i] = i;
    for (tries = 0; tries < MPM__PTW_ITERATIONS && n > 0; tries++) {
        for (i = left = 0; i < n; i++) {
            open[left] = open[i];
            left += !mpm__ptw_search_on(m, h, &q[open[i]], per_step);
        }
        n = left;
    }
    return n;
}

/* The state of lane i, as the laws see it. */
static inline mpm_material_state mpm__ptw_state(const mpm_block *b, const mpm__ptw_lanes *a, int i)
{
    int k = a->first + i;
    mpm_material_state s;
    s.plastic_strain = b->plastic_strain[k];
    s.plastic_rate = b->plastic_rate[k];
    s.temperature = b->temperature[k];
    s.density = b->density[k];
    s.pressure = -a->mean[i];
    return s;
}

/* The stress to which a consistent return has come: sigma* - 3 mu d, or none where molten. */
static inline mpm_real mpm__ptw_returned(const mpm__ptw_search *q)
{
    if (!(q->point.state.temperature < q->point.melt)) return 0;
    return mpm__ptw_max(q->mises - 3 * q->point.shear * q->d, 0);
}

/* Sorts out the points that may yield and returns them to the flow stress. Touches only *a (and
   counters), so that a failure leaves the block as it was. */
static inline mpm_status mpm__ptw_yield(const mpm_material *m, const mpm__ptw_shared *h,
                                        const mpm__ptw_bounds *bounds, const mpm_block *b,
                                        mpm__ptw_lanes *a)
{
    mpm__ptw_search search[MPM__PTW_LANES], *q;
    mpm_real per_step = 1 / b->dt;
    int list[MPM__PTW_LANES + 1], i, n, capped = 0, staged = m->mapping == MPM_RETURN_STAGED;
    a->yield_count = 0;
    if (m->strength == MPM_STRENGTH_ELASTIC) return MPM_OK;
    n = mpm__ptw_suspects(m, h, bounds, b, a, list);
    for (i = 0, q = search; i < n; i++, q++) {
        mpm_material_state s = mpm__ptw_state(b, a, list[i]);
        q->point = mpm__ptw_prepare(m, h, &s, a->shear[list[i]]);
        mpm__ptw_search_begin(q, mpm_sqrt(a->mises2[list[i]]), b->dt, list[i]);
        if (q->d > q->least) mpm__ptw_search_guess(m, a, q);
    }
    if (!staged) capped = mpm__ptw_search_all(m, h, search, n, per_step);
    for (i = 0, q = search; i < n; i++, q++) {
        mpm_real flow = staged ? mpm__ptw_stage(m, h, b, a, q) : mpm__ptw_returned(q);
        if (!mpm_finite(q->mises)) return mpm__ptw_blame(m, b, a->first + q->lane);
        if (!mpm_finite(q->d) || !mpm_finite(flow))
            return mpm_fail(b->fault, MPM_ERR_NAN, "flow stress of point", q->d, a->first + q->lane);
        mpm__ptw_take(m, b, a, q, flow, per_step);
    }
    mpm__ptw_count(b, MPM_TALLY_ITERATION, capped);
    return capped ? MPM_NOT_CONVERGED : MPM_OK;
}

/* Plastic strain, its rate and plastic work dW = sigma d (A 4.15), to the block. */
static inline void mpm__ptw_commit(const mpm_material *m, const mpm_block *b, const mpm__ptw_lanes *a)
{
    mpm_real per_step = 1 / b->dt;
    int i, y;
    for (i = 0; i < a->count; i++) b->plastic_rate[a->first + i] = 0;
    for (y = 0; y < a->yield_count; y++) {
        int lane = a->yielding[y], k = a->first + lane;
        b->plastic_rate[k] = a->increment[lane] * per_step;
        b->plastic_strain[k] += a->increment[lane];
        b->plastic_work[k] += a->dissipated[lane];
        if (m->mapping == MPM_RETURN_STAGED) b->user[m->flow_field][k] = a->staged[lane];
    }
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
        a->temperature[i] += a->temperature[i] * mpm_expm1(-a->thermal[i] * dv);
        a->temperature[i] -= a->viscous[i] * dv / (m->density * m->specific_heat);
    }
}

/* Temperature of level k+1 with the heat of plastic work, dT = chi sigma d/(rho Cp) (A 3.44). Touches only *a. */
static inline void mpm__ptw_heat(const mpm_material *m, const mpm_block *b, mpm__ptw_lanes *a)
{
    int i, y;
    for (i = 0; i < a->count; i++) a->temperature[i] = b->temperature[a->first + i];
    for (y = 0; m->heat_fraction > 0 && y < a->yield_count; y++) {
        mpm_real work = a->dissipated[a->yielding[y]];
        i = a->yielding[y];
        a->temperature[i] += m->heat_fraction * work / (b->density[a->first + i] * m->specific_heat);
    }
    if (m->compression_heating) mpm__ptw_heat_volume(m, b, a);
}

/* Whether all that would go to the block is finite; else the fault. x * 0 is 0 for finite numbers only. */
static inline mpm_status mpm__ptw_settled(const mpm_material *m, const mpm_block *b, const mpm__ptw_lanes *a)
{
    mpm_real per_step = 1 / b->dt, wrong[MPM__PTW_LANES];
    int i, y, k = a->first, bad = 0;
    for (i = 0; i < a->count; i++) {
        mpm_real t = (a->trial[0][i] + a->mean[i]) * 0 + (a->trial[1][i] + a->mean[i]) * 0 +
                     (a->trial[2][i] + a->mean[i]) * 0;
        t += a->trial[3][i] * 0 + a->trial[4][i] * 0 + a->trial[5][i] * 0 + a->energy[i] * 0 + a->temperature[i] * 0;
        bad |= !(t == 0);
        wrong[i] = t;
    }
    for (i = 0; bad && i < a->count; i++)
        if (!(wrong[i] == 0)) return mpm__ptw_blame(m, b, k + i);
    for (y = 0; y < a->yield_count; y++) {
        mpm_real d = a->increment[a->yielding[y]], work = a->dissipated[a->yielding[y]];
        i = k + a->yielding[y];
        if (!mpm_finite(d * per_step) || !mpm_finite(b->plastic_strain[i] + d) ||
            !mpm_finite(b->plastic_work[i] + work))
            return mpm__ptw_blame(m, b, i);
    }
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
