/* material.c - the numbers behind a material: flow stress, moduli, melting, pressure.
   SPDX-License-Identifier: MIT

   Shows how to call the laws of mpm_ptw.h without a grid. Inputs and outputs are SI except where
   the key says MPa. --curve FILE writes the stress-strain curve up to --strain at that rate and
   temperature as CSV, isothermal and adiabatic (plastic work heats, A 3.44). Expected: `material`
   alone prints flow_stress_MPa = 259.09 and xidot_per_s = 9.714e12, the values of the aluminium of
   source A at strain 0.1, 1e6 /s, 300 K. */
#define MPM_IMPLEMENTATION
#include "mpm_ptw.h"
#include "mpm_io.h"
#include "options.h"

static int refuse(const char *what, const char *name)
{
    fprintf(stderr, "error: %s '%s'; --list shows what there is\n", what, name);
    return 1;
}

/* Every material with the models it has a published set for, then what the models are. */
static int list(void)
{
#define NAME_AND_TEXT(strength, name, text) {name, text},
    static const char *const models[][2] = {MPM_STRENGTH_LIST(NAME_AND_TEXT)};
    enum { MODELS = (int)(sizeof models / sizeof models[0]) };
    const mpm_units si = mpm_units_si();
    int i, j, sets[MODELS] = {0};
    for (i = 0; i < mpm_material_preset_count(); i++) {
        mpm_material m;
        if (mpm_material_preset(&m, mpm_material_preset_name(i), &si, NULL) < 0) return 1;
        printf("%-10s", m.name);
        for (j = 0; j < MODELS; j++)
            if (mpm_material_model(&m, models[j][0], NULL) == MPM_OK) {
                printf(" %s", models[j][0]);
                sets[j]++;
            }
        printf("\n");
    }
    for (j = 0; j < MODELS; j++)
        if (sets[j]) printf("%s: %s\n", models[j][0], models[j][1]);
    return 0;
}

/* Refuses a number the laws are not made for. */
static int check_input(const char *name, double value, double least, int inclusive)
{
    if (value - value == 0 && (inclusive ? value >= least : value > least)) return 0;
    fprintf(stderr, "error: --%s must be a finite number %s %g, not %g\n", name,
            inclusive ? "of at least" : "above", least, value);
    return 1;
}

/* The curve up to the strain of s in 200 steps. The adiabatic stress is at the temperature to which its
   own work has heated the material, by the midpoint rule. */
static int write_curve(const char *path, const mpm_material *m, const mpm_material_state *s)
{
    enum { STEPS = 200 };
    const mpm_real step = s->plastic_strain / STEPS, heat = m->heat_fraction / (s->density * m->specific_heat);
    mpm_material_state cold = *s, hot = *s, half;
    mpm_fault fault;
    mpm_io_csv t;
    char text[256];
    int i;
    hot.plastic_strain = 0;
    mpm_io_csv_begin(&t, path, "strain,isothermal_MPa,adiabatic_MPa,adiabatic_K", NULL, &fault);
    for (i = 0; i <= STEPS; i++) {
        cold.plastic_strain = hot.plastic_strain = (mpm_real)i * step;
        mpm_io_csv_real(&t, cold.plastic_strain);
        mpm_io_csv_real(&t, mpm_material_flow_stress(m, &cold) / 1000000);
        mpm_io_csv_real(&t, mpm_material_flow_stress(m, &hot) / 1000000);
        mpm_io_csv_real(&t, hot.temperature);
        if (!(heat > 0)) continue;
        half = hot;
        half.plastic_strain += step / 2;
        half.temperature += heat * step / 2 * mpm_material_flow_stress(m, &hot);
        hot.temperature += heat * step * mpm_material_flow_stress(m, &half);
    }
    if (mpm_io_csv_end(&t, &fault) >= 0) return 0;
    mpm_io_fault_text(text, sizeof text, &fault);
    fprintf(stderr, "error: --curve %s: %s\n", path, text);
    return 1;
}

static void print(const char *key, double value) { printf("%s = %.17g\n", key, value); }

/* The properties at one state. */
static void print_all(const mpm_material *m, const mpm_material_state *s, double hugoniot)
{
    print("flow_stress_MPa", 1e-6 * (double)mpm_material_flow_stress(m, s));
    print("shear_modulus_MPa", 1e-6 * (double)mpm_material_shear_modulus(m, s));
    print("melt_temperature_K", (double)mpm_material_melt_temperature(m, s->density));
    if (m->strength == MPM_STRENGTH_PTW) print("xidot_per_s", (double)mpm_material_attempt_rate(m, s));
    print("pressure_MPa", 1e-6 * (double)s->pressure);
    print("hugoniot_pressure_MPa", 1e-6 * hugoniot);
}

static int carry_out(int argc, char **argv)
{
    const char *name = "al", *model = "", *curve = "";
    double strain = 0.1, rate = 1e6, temperature = 300, density = 0, energy = 0;
    int show_list = 0, n = 0, status;
    option options[9];
    const mpm_units si = mpm_units_si();
    mpm_material m;
    mpm_material_state s;
    mpm_fault fault;
    mpm_real pressure, hugoniot;

    option_add(options, &n, "material", OPTION_TEXT, &name, "preset");
    option_add(options, &n, "model", OPTION_TEXT, &model, "see --list; empty: the preset's own");
    option_add(options, &n, "strain", OPTION_REAL, &strain, "effective plastic strain");
    option_add(options, &n, "rate", OPTION_REAL, &rate, "effective plastic strain rate, 1/s");
    option_add(options, &n, "temperature", OPTION_REAL, &temperature, "K");
    option_add(options, &n, "density", OPTION_REAL, &density, "kg/m^3; 0: the material's own");
    option_add(options, &n, "energy", OPTION_REAL, &energy, "internal energy, J/kg");
    option_add(options, &n, "curve", OPTION_TEXT, &curve, "file for the stress-strain curve");
    option_add(options, &n, "list", OPTION_FLAG, &show_list, "materials and their models");
    status = options_parse(argc, argv, "Prints the properties of a material at one state.", options, n);
    if (status) return status < 0;
    if (show_list) return list();
    if (check_input("strain", strain, 0, 1) || check_input("rate", rate, 0, 1) ||
        check_input("temperature", temperature, 0, 1) || check_input("density", density, 0, 1) ||
        check_input("energy", energy, -HUGE_VAL, 0))
        return 1;
    if (mpm_material_preset(&m, name, &si, &fault) < 0) return refuse("unknown material", name);
    if (*model && mpm_material_model(&m, model, &fault) < 0)
        return refuse(strcmp(fault.field, "model") ? "this material has no set for the model"
                                                     : "unknown model", model);

    s.plastic_strain = (mpm_real)strain;
    s.plastic_rate = (mpm_real)rate;
    s.temperature = (mpm_real)temperature;
    s.density = density > 0 ? (mpm_real)density : m.density;
    if (mpm_material_pressure(&m, s.density, (mpm_real)energy, &pressure, &fault) < 0 ||
        mpm_material_hugoniot_pressure(&m, s.density, &hugoniot, &fault) < 0) {
        fprintf(stderr, "error: %s: %g\n", fault.field, (double)fault.value);
        return 1;
    }
    s.pressure = pressure;
    if (*curve && m.strength == MPM_STRENGTH_ELASTIC) return refuse("a curve needs a strength, not the model", model);
    if (*curve && write_curve(curve, &m, &s)) return 1;
    print_all(&m, &s, (double)hugoniot);
    return 0;
}

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
