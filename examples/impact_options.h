/* impact_options.h - the options that make an impact case, one for every member: the command line of the
   programs, and what a finished run is known by. SPDX-License-Identifier: MIT */
#ifndef IMPACT_OPTIONS_H
#define IMPACT_OPTIONS_H

#include "impact_case.h"
#include "options.h"

#define IMPACT_OPTIONS 96 /* room for them and a program's own */

/* Fills o[]; returns how many there are. Test: 62_studies, that no member is left out. */
static inline int impact_options(impact_case *c, option *o)
{
    int n = 0;
    option_add_word(o, &n, "method", &c->method, IMPACT_METHODS,
                    "sets the other defaults: source A's model, or contact and bond on surfaces (try --method surface "
                    "--help); 0 is then by the diameter");
    option_add(o, &n, "diameter", OPTION_REAL, &c->diameter, "particle diameter, um");
    option_add(o, &n, "velocity", OPTION_REAL, &c->velocity, "impact velocity, m/s");
    option_add(o, &n, "angle", OPTION_REAL, &c->angle,
               "velocity from the surface normal, degrees (with symmetry half, full)");
    option_add_word(o, &n, "shape", &c->shape, IMPACT_SHAPES, "of the particle");
    option_add(o, &n, "aspect", OPTION_REAL, &c->aspect,
               "of an ellipsoid: height over width, at the volume of the sphere");
    option_add(o, &n, "material", OPTION_TEXT, &c->material, "of the particle");
    option_add(o, &n, "substrate-material", OPTION_TEXT, &c->substrate_material,
               "of the substrate; empty: as the particle");
    option_add_word(o, &n, "model", &c->model, IMPACT_MODELS, "strength of both");
    option_add(o, &n, "temperature", OPTION_REAL, &c->temperature, "at the start, K: softens, expands nothing");
    option_add(o, &n, "substrate-temperature", OPTION_REAL, &c->substrate_temperature, "K; 0: as the particle");
    option_add(o, &n, "cell", OPTION_REAL, &c->cell, "grid cell edge, um");
    option_add(o, &n, "spacing", OPTION_REAL, &c->spacing, "distance of material points, um");
    option_add(o, &n, "substrate-diameter", OPTION_REAL, &c->substrate_diameter, "um");
    option_add(o, &n, "substrate-height", OPTION_REAL, &c->substrate_height, "um");
    option_add(o, &n, "time", OPTION_REAL, &c->time, "simulated time, ns");
    option_add(o, &n, "calm", OPTION_REAL, &c->calm,
               "time in which noise that the grid does not see dies out, ns; 0: never (docs/quiet.md)");
    option_add(o, &n, "dt-factor", OPTION_REAL, &c->dt_factor, "time step over the critical step of a 0.5 um cell");
    option_add_word(o, &n, "bond", &c->bond, IMPACT_BONDS, "what makes the bond grow; interface: with contact surface");
    option_add_word(o, &n, "bond-average", &c->bond_average, MPM_NAMES(MPM_BOND_AVERAGE_LIST),
                    "D of a node from its surface points");
    option_add(o, &n, "gc", OPTION_REAL, &c->gc, "critical bond energy, J/m2");
    option_add(o, &n, "gdot", OPTION_REAL, &c->gdot, "critical bond energy rate, J/m2/us");
    option_add(o, &n, "eps-c", OPTION_REAL, &c->eps_c, "strain bond: critical strain");
    option_add(o, &n, "epsdot-c", OPTION_REAL, &c->epsdot_c, "strain bond: critical strain rate, 1/us");
    option_add(o, &n, "shell", OPTION_REAL, &c->shell, "thickness of the surface that contacts and bonds, spacings");
    option_add(o, &n, "floor", OPTION_REAL, &c->floor, "least value of the rate factor of the bond threshold");
    option_add(o, &n, "bond-length", OPTION_REAL, &c->bond_length, "energy bond: regularising length, um; 0: the cell");
    option_add(o, &n, "bond-width", OPTION_REAL, &c->bond_width,
               "softens the threshold D = 1 of a node over this range; 0: sharp");
    option_add_word(o, &n, "symmetry", &c->symmetry, IMPACT_SYMMETRIES, "of the model, with mirrors y = 0, x = 0");
    option_add_word(o, &n, "geometry", &c->geometry, IMPACT_GEOMETRIES, "of grid and points");
    option_add_word(o, &n, "functions", &c->functions, MPM_NAMES(MPM_BASIS_LIST), "shape functions");
    option_add(o, &n, "friction", OPTION_REAL, &c->friction, "Coulomb coefficient between the bodies");
    option_add_word(o, &n, "normal", &c->normal, MPM_NAMES(MPM_NORMAL_LIST), "contact normal");
    option_add_word(o, &n, "scheme", &c->scheme, MPM_NAMES(MPM_SCHEME_LIST), "when contact acts in a step");
    option_add(o, &n, "touch", OPTION_FLAG, &c->touch,
               "contact where the points themselves touch, not where they share a node");
    option_add_word(o, &n, "contact", &c->contact, IMPACT_CONTACTS,
                    "where bodies meet: at shared nodes, or on their surfaces (with bond interface or none)");
    option_add(o, &n, "surface-damping", OPTION_REAL, &c->surface_damping, "damper of contact on surfaces, rho c");
    option_add(o, &n, "adhesion", OPTION_REAL, &c->adhesion, "bond of the interface: W0 of W0 (G/G_c - 1), J/m2");
    option_add(o, &n, "adhesion-critical", OPTION_REAL, &c->adhesion_critical, "... its G_c, J/m2");
    option_add(o, &n, "adhesion-depth", OPTION_REAL, &c->adhesion_depth, "... depth of the layer that G is of, um");
    option_add(o, &n, "adhesion-reach", OPTION_REAL, &c->adhesion_reach, "... how far it is drawn open, um");
    option_add(o, &n, "springs", OPTION_FLAG, &c->springs, "springs beside the substrate's dampers: a half space");
    option_add_word(o, &n, "plasticity", &c->plasticity, MPM_NAMES(MPM_RETURN_LIST), "return mapping");
    option_add(o, &n, "gap", OPTION_REAL, &c->gap, "distance of the bodies at the start, um");
    option_add(o, &n, "margin", OPTION_REAL, &c->margin, "free grid around the bodies, particle diameters");
    option_add(o, &n, "grid-offset", OPTION_REAL, &c->offset, "height of a grid plane above the interface, um");
    return n;
}

#endif
