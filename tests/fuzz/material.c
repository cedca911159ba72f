/* Material laws: any preset and any numbers that its check accepts, updated over any finite states: MPM_OK with finite
   results, or a status that names the field. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "mpm.h"
#include "mpm_ptw.h"

static void change_material(fuzz *f, mpm_material *m)
{
    FUZZ_CHOICE(f, m->mark);
    FUZZ_CHOICE(f, m->strength);
    FUZZ_CHOICE(f, m->shear);
    FUZZ_CHOICE(f, m->melt);
    FUZZ_CHOICE(f, m->eos);
    FUZZ_CHOICE(f, m->mapping);
    m->flow_field = fuzz_int(f, 0);
    FUZZ_CHOICE(f, m->rotation);
    FUZZ_CHOICE(f, m->compression_heating);
    fuzz_reals(f, &m->density, 4);
    fuzz_reals(f, &m->young, 8);
    fuzz_reals(f, &m->melt_temperature, 7);
    fuzz_reals(f, &m->jc.a, 7);
    fuzz_reals(f, &m->scg.y0, 4);
    fuzz_reals(f, &m->ptw.theta, 12);
    fuzz_reals(f, &m->viscosity_linear, 2);
}

/* Finite, and of a size that a sum of squares survives half of the time. */
static mpm_real finite(fuzz *f, double x)
{
    const double y = fuzz_double(f, x);
    return (mpm_real)(mpm_finite((mpm_real)y) ? y : x);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { N = 3 };
    fuzz f = {data, size};
    const mpm_units units = mpm_units_um_us_ng();
    mpm_real strain[6][N], spin[3][N], stress[6][N], rho[N], q[5][N], user[N] = {0};
    int64_t tally[MPM_TALLIES] = {0};
    mpm_material_state at;
    mpm_fault fault = {MPM_OK, NULL, 0, -1};
    mpm_material m, other;
    mpm_block b;
    mpm_status s;
    int i, k;
    mpm_real a, c;
    mpm_material_preset(&m, mpm_material_preset_name((int)fuzz_byte(&f) % mpm_material_preset_count()), &units, NULL);
    change_material(&f, &m);
    if (mpm_material_check(&m, &fault) != MPM_OK) {
        FUZZ_WANT(fault.field);
        return 0;
    }
    memset(&b, 0, sizeof b);
    b.count = N;
    b.dt = finite(&f, 1e-4);
    b.cell = finite(&f, 1);
    if (!(b.dt > 0 && b.cell > 0)) return 0;
    for (i = 0; i < N; i++) {
        for (k = 0; k < 6; k++) strain[k][i] = finite(&f, k == 2 ? -1e-3 : 1e-4);
        for (k = 0; k < 3; k++) spin[k][i] = finite(&f, 1e-4);
        for (k = 0; k < 6; k++) stress[k][i] = finite(&f, k < 3 ? -100 : 10);
        rho[i] = finite(&f, (double)m.density);
        if (!(rho[i] > 0)) rho[i] = m.density;
        q[0][i] = finite(&f, 0);
        q[1][i] = finite(&f, 400);
        q[2][i] = finite(&f, 0.1);
        q[3][i] = finite(&f, 1);
        q[4][i] = finite(&f, 0);
    }
    for (k = 0; k < 6; k++) b.strain[k] = strain[k], b.stress[k] = stress[k];
    for (k = 0; k < 3; k++) b.spin[k] = spin[k];
    b.density = rho;
    b.energy = q[0];
    b.temperature = q[1];
    b.plastic_strain = q[2];
    b.plastic_rate = q[3];
    b.plastic_work = q[4];
    if (fuzz_byte(&f) < 200) b.user[0] = user; /* the staged return wants one */
    b.tally = tally;
    b.fault = &fault;
    at.plastic_strain = q[2][0];
    at.plastic_rate = q[3][0];
    at.temperature = q[1][0];
    at.density = rho[0];
    at.pressure = stress[0][0];
    mpm_material_flow(&m, &at);
    mpm_material_attempt_rate(&m, &at);
    mpm_material_melt_temperature(&m, rho[0]);
    other = m;
    if (mpm_material_melts_at(&other, at.temperature, &fault) == MPM_OK)
        FUZZ_WANT(mpm_finite(other.melt_temperature) && other.melt_temperature > 0);
    mpm_material_melting_point(&m);
    mpm_material_wave_speeds(&m, m.density, &a, &c);
    fault.field = NULL;
    s = mpm_material_stress(&m, &b);
    if (s < 0) {
        FUZZ_WANT(fault.field && fault.index >= -1 && fault.index < N);
        return 0;
    }
    for (i = 0; i < N; i++) {
        for (k = 0; k < 6; k++) FUZZ_WANT(mpm_finite(stress[k][i]));
        for (k = 0; k < 5; k++) FUZZ_WANT(mpm_finite(q[k][i]));
    }
    return 0;
}
