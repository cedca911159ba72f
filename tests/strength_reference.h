/* strength_reference.h - melting, shear moduli and flow stresses once more, as printed in their sources and
   in long double, sharing nothing with mpm_ptw.h but the parameters. SPDX-License-Identifier: MIT */
#ifndef STRENGTH_REFERENCE_H
#define STRENGTH_REFERENCE_H

#include "mpm_ptw.h"

#include <math.h>

typedef long double real;

static inline mpm_material_state state(double strain, double rate, double T, double density, double pressure)
{
    mpm_material_state s;
    s.plastic_strain = (mpm_real)strain;
    s.plastic_rate = (mpm_real)rate;
    s.temperature = (mpm_real)T;
    s.density = (mpm_real)density;
    s.pressure = (mpm_real)pressure;
    return s;
}

static inline real ref_melt(const mpm_material *m, real density)
{
    real eta = density / (real)m->density, a = (real)m->melt_a;
    if (m->melt == MPM_MELT_CONSTANT) return (real)m->melt_temperature;
    return (real)m->melt_temperature * expl(2 * a * (1 - 1 / eta)) *
           powl(eta, 2 * ((real)m->gruneisen - a - 1.0L / 3));
}

static inline real ref_shear(const mpm_material *m, const mpm_material_state *s)
{
    real T = (real)s->temperature, eta = (real)s->density / (real)m->density;
    real mu0 = (real)m->shear_modulus, mu = mu0;
    if (m->shear == MPM_SHEAR_MTS) mu = mu0 - (real)m->shear_d / (expl((real)m->shear_t / T) - 1);
    if (m->shear == MPM_SHEAR_SCG)
        mu = mu0 * (1 + (real)m->shear_a * (real)s->pressure * powl(eta, -1.0L / 3) -
                    (real)m->shear_b * (T - 300));
    return mu > (real)m->shear_floor * mu0 ? mu : (real)m->shear_floor * mu0;
}

static inline real ref_xidot(const mpm_material *m, const mpm_material_state *s)
{
    real rho = (real)s->density, pi = acosl(-1.0L);
    return 0.5L * cbrtl(4 * pi * rho / (3 * (real)m->ptw.atomic_mass)) * sqrtl(ref_shear(m, s) / rho);
}

static inline real ref_ptw(const mpm_material *m, const mpm_material_state *s)
{
    const mpm_ptw *c = &m->ptw;
    real s0 = (real)c->s0, sinf = (real)c->sinf, y0 = (real)c->y0, yinf = (real)c->yinf;
    real strain = (real)s->plastic_strain, theta = (real)c->theta;
    real r = (real)s->plastic_rate / ((real)c->gamma * ref_xidot(m, s));
    real T_hat = (real)s->temperature / ref_melt(m, (real)s->density);
    real x = (real)c->kappa * T_hat * logl(1 / r), shock = s0 * powl(r, (real)c->s1);
    real tau_s, tau_y, low, alpha, beta, psi;
    if (T_hat >= 1) return 0;
    if (x < 0 && !m->erf_literal) x = 0;
    low = (real)c->y1 * powl(r, (real)c->y2);
    tau_s = s0 - (s0 - sinf) * erfl(x);
    if (tau_s < shock) tau_s = shock;
    if (low > shock) low = shock;
    tau_y = y0 - (y0 - yinf) * erfl(x);
    if (tau_y < low) tau_y = low;
    if (tau_s <= tau_y) return 2 * ref_shear(m, s) * tau_s;
    if (c->d <= 0) /* Voce */
        return 2 * ref_shear(m, s) * (tau_s - (tau_s - tau_y) * expl(-strain * theta / (tau_s - tau_y)));
    alpha = (s0 - tau_y) / (real)c->d;
    beta = (tau_s - tau_y) / alpha;
    psi = expl(beta) - 1;
    return 2 * ref_shear(m, s) *
           (tau_s + alpha * logl(1 - psi * expl(-beta - theta * strain / (alpha * psi))));
}

static inline real ref_jc(const mpm_material *m, const mpm_material_state *s)
{
    const mpm_jc *c = &m->jc;
    real rate = (real)s->plastic_rate / (real)c->rate, T = (real)s->temperature;
    real hat = (T - (real)c->temperature) / (ref_melt(m, (real)s->density) - (real)c->temperature);
    if (hat >= 1) return 0;
    if (hat < 0) hat = 0;
    if (rate < 1) rate = 1;
    return ((real)c->a + (real)c->b * powl((real)s->plastic_strain, (real)c->n)) *
           (1 + (real)c->c * logl(rate)) * (1 - powl(hat, (real)c->m));
}

static inline real ref_scg(const mpm_material *m, const mpm_material_state *s)
{
    real y = (real)m->scg.y0 * powl(1 + (real)m->scg.beta * (real)s->plastic_strain, (real)m->scg.n);
    if (y > (real)m->scg.ymax) y = (real)m->scg.ymax;
    if ((real)s->temperature >= ref_melt(m, (real)s->density)) return 0;
    return y * ref_shear(m, s) / (real)m->shear_modulus;
}

static inline real reference(const mpm_material *m, const mpm_material_state *s)
{
    switch (m->strength) {
    case MPM_STRENGTH_PTW: return ref_ptw(m, s);
    case MPM_STRENGTH_JC: return ref_jc(m, s);
    case MPM_STRENGTH_SCG: return ref_scg(m, s);
    default: return (real)m->linear_yield + (real)m->linear_hardening * (real)s->plastic_strain;
    }
}

#endif
