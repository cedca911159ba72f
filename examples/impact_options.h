/* impact_options.h - the options that make an impact case, one for every member: the command line of the
   programs, and what a finished run is known by. SPDX-License-Identifier: MIT */
#ifndef IMPACT_OPTIONS_H
#define IMPACT_OPTIONS_H

#include "impact_case.h"
#include "options.h"

#define IMPACT_OPTIONS 64 /* room for them and a program's own */

/* Fills o[]; returns how many there are. Test: 62_studies, that no member is left out. */
static inline int impact_options(impact_case *c, option *o)
{
    int n = 0;
    option_add(o, &n, "diameter", OPTION_REAL, &c->diameter, "particle diameter, um");
    option_add(o, &n, "velocity", OPTION_REAL, &c->velocity, "impact velocity, m/s");
    option_add(o, &n, "angle", OPTION_REAL, &c->angle,
               "velocity from the surface normal, degrees (with symmetry half, full)");
    option_add(o, &n, "shape", OPTION_TEXT, &c->shape, "of the particle: sphere|ellipsoid");
    option_add(o, &n, "aspect", OPTION_REAL, &c->aspect,
               "of an ellipsoid: height over width, at the volume of the sphere");
    option_add(o, &n, "material", OPTION_TEXT, &c->material, "of the particle");
    option_add(o, &n, "substrate-material", OPTION_TEXT, &c->substrate_material,
               "of the substrate; empty: as the particle");
    option_add(o, &n, "model", OPTION_TEXT, &c->model, "strength of both: preset|elastic|linear|jc|scg|ptw");
    option_add(o, &n, "temperature", OPTION_REAL, &c->temperature, "at the start, K: softens, expands nothing");
    option_add(o, &n, "substrate-temperature", OPTION_REAL, &c->substrate_temperature, "K; 0: as the particle");
    option_add(o, &n, "cell", OPTION_REAL, &c->cell, "grid cell edge, um");
    option_add(o, &n, "spacing", OPTION_REAL, &c->spacing, "distance of material points, um");
    option_add(o, &n, "substrate-diameter", OPTION_REAL, &c->substrate_diameter, "um");
    option_add(o, &n, "substrate-height", OPTION_REAL, &c->substrate_height, "um");
    option_add(o, &n, "time", OPTION_REAL, &c->time, "simulated time, ns");
    option_add(o, &n, "dt-factor", OPTION_REAL, &c->dt_factor, "time step over the critical step of a 0.5 um cell");
    option_add(o, &n, "bond", OPTION_TEXT, &c->bond, "energy|strain|none");
    option_add(o, &n, "bond-average", OPTION_TEXT, &c->bond_average,
               "D of a node from its surface points: mean|weighted|literal");
    option_add(o, &n, "gc", OPTION_REAL, &c->gc, "critical bond energy, J/m2");
    option_add(o, &n, "gdot", OPTION_REAL, &c->gdot, "critical bond energy rate, J/m2/us");
    option_add(o, &n, "eps-c", OPTION_REAL, &c->eps_c, "strain bond: critical strain");
    option_add(o, &n, "epsdot-c", OPTION_REAL, &c->epsdot_c, "strain bond: critical strain rate, 1/us");
    option_add(o, &n, "shell", OPTION_REAL, &c->shell, "thickness of the surface that contacts and bonds, spacings");
    option_add(o, &n, "floor", OPTION_REAL, &c->floor, "least value of the rate factor of the bond threshold");
    option_add(o, &n, "bond-length", OPTION_REAL, &c->bond_length, "energy bond: regularising length, um; 0: the cell");
    option_add(o, &n, "bond-width", OPTION_REAL, &c->bond_width,
               "softens the threshold D = 1 of a node over this range; 0: sharp");
    option_add(o, &n, "symmetry", OPTION_TEXT, &c->symmetry, "full|half (mirror y = 0)|quarter");
    option_add(o, &n, "geometry", OPTION_TEXT, &c->geometry, "3d|axisymmetric");
    option_add(o, &n, "functions", OPTION_TEXT, &c->functions, "shape functions: linear|gimp");
    option_add(o, &n, "friction", OPTION_REAL, &c->friction, "Coulomb coefficient between the bodies");
    option_add(o, &n, "normal", OPTION_TEXT, &c->normal, "contact normal: ranked|mvg|average|vertical|logistic");
    option_add(o, &n, "separation", OPTION_FLAG, &c->separation,
               "contact where the points themselves touch, not where they share a node");
    option_add(o, &n, "plasticity", OPTION_TEXT, &c->plasticity, "return mapping: consistent|staged");
    option_add(o, &n, "gap", OPTION_REAL, &c->gap, "distance of the bodies at the start, um");
    option_add(o, &n, "margin", OPTION_REAL, &c->margin, "free grid around the bodies, particle diameters");
    option_add(o, &n, "grid-offset", OPTION_REAL, &c->offset, "height of a grid plane above the interface, um");
    return n;
}

#endif
