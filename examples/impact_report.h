/* impact_report.h - what report.html says of one impact, from the numbers of its summary.
   SPDX-License-Identifier: MIT */
#ifndef IMPACT_REPORT_H
#define IMPACT_REPORT_H

#include "impact_case.h"
#include "report.h"

#define IMPACT_ROWS 24

/* The numbers of the page in their order; the words are those of the end table, and more. */
static inline int impact_rows(const impact *s, page_row *row)
{
    static const page_row nodes[] = {
        {"pbcp_percent", "PBCP, bonded share", "%", 2, 1,
         "of the surface that touched the other body, the part whose bond variable D is 1 or more"},
        {"abp", "ABP", "", 3, 0, "D of the surface that touched, on the mean"},
        {"held_pairs", "held", "pairs", 0, 0, "pairs of nodes that the bond kept from parting in the last step"}};
    static const page_row surfaces[] = {
        {"pbcp_percent", "bonded share", "%", 2, 1,
         "of the area that touched, the part with adhesion that is not spent"},
        {"interface_dissipation_J_m2", "G, dissipated at the interface", "J/m2", 0, 0,
         "plastic work in the layer under both surfaces since they touched: where it is above G_c it makes adhesion"},
        {"held_pairs", "held", "markers", 0, 0, "markers that adhesion drew to the other surface in the last step"}};
    static const page_row common[] = {
        {"eps_mean", "mean plastic strain", "", 3, 1, "of the particle, weighted by mass"},
        {"temperature_max_K", "hottest point", "K", 0, 1, "of both bodies; no heat is conducted in such a short time"},
        {"flattening", "flattening", "", 3, 0, "1 less the particle's height over that at the start"},
        {"crater_depth_um", "crater", "um", 2, 0, "depth of the deepest point of the substrate's face"},
        {"contact_area_um2", "contact area", "um2", 1, 0, "of the particle's surface, what touched"},
        {"bonded_area_um2", "bonded area", "um2", 1, 0, "... what of it bonded"},
        {"v_noise_m_s", "noise of velocity", "m/s", 1, 0,
         "standard deviation of the points' velocity: what still rings in the particle"},
        {"substrate_drift_m_s", "drift of the substrate", "m/s", 3, 0, "its mean velocity"},
        {"ejected_points", "ejected", "points", 0, 0, "that have left the particle"},
        {"energy_unaccounted", "energy unaccounted", "", 5, 0,
         "of the energy at the start, what no account of the ledger explains: how well the books close"},
        {"momentum_error", "momentum error", "", PAGE_TINY, 0, "relative; round-off is some 1e-13"},
        {"points", "points", "", 0, 0, "material points of the model"},
        {"steps", "steps", "", 0, 0, "of time"}};
    static const page_row rebound = {"v_rest_mean_m_s", "rebound velocity", "m/s", 2, 1,
                                     "mean velocity of the particle, away from the substrate; near 0 it stays"};
    const int rest = (int)(sizeof common / sizeof *common);
    row[0] = rebound;
    memcpy(row + 1, s->surfaces.surfaces > 0 ? surfaces : nodes, sizeof nodes);
    memcpy(row + 4, common, sizeof common);
    return 4 + rest;
}

/* "stays", "rebounds", or that the run ended too early to tell. */
static inline const char *impact_verdict(const impact *s, const impact_result *r)
{
    if (impact_stays(s, r)) return "stays";
    return r->relative < -5 ? "is still on its way in" : "rebounds";
}

/* "A sphere of al, 14 um across, hits al at 810 m/s. ..." */
static inline void impact_lead(const impact *s, const impact_case *c, const impact_result *r, char *text, size_t n)
{
    const char *what = strcmp(c->shape, "sphere") ? "An ellipsoid" : "A sphere";
    char aside[60] = "";
    if (fabs(c->angle) > 0) snprintf(aside, sizeof aside, ", %g degrees from the normal", c->angle);
    snprintf(text, n, "%s of %s, %g " PAGE_MU "m across, hits %s at %g m/s%s. After %.4g ns its mean velocity is "
             "%s%.2f m/s; %.1f %% of what touched is bonded.", what, s->material[IMPACT_PARTICLE].name, c->diameter,
             s->material[IMPACT_SUBSTRATE].name, c->velocity, aside, (double)s->world.time * 1e3,
             r->rebound.mean < 0 ? PAGE_MINUS : "", fabs(r->rebound.mean), r->bond.pbcp);
}

/* Writes report.html, behind the summary and the picture. title: of the picture. Returns 1, or 0 after a message. */
static inline int impact_page(const impact *s, const impact_case *c, const impact_result *r, const output *o,
                              const history *past, page_desc d)
{
    page_row row[IMPACT_ROWS];
    char lead[400], verdict[80];
    const int whole = s->world.steps >= s->steps;
    snprintf(verdict, sizeof verdict, "The particle %s.%s", impact_verdict(s, r),
             whole ? "" : " So far: the run was stopped.");
    impact_lead(s, c, r, lead, sizeof lead);
    d.program = "impact";
    d.verdict = verdict;
    d.lead = lead;
    d.good = impact_stays(s, r);
    d.row = row;
    d.rows = impact_rows(s, row);
    d.past = past;
    d.world = &s->world;
    d.length = o->length;
    d.time = o->time;
    d.spacing = c->spacing;
    d.picture = o->frames > 0 ? "impact.png" : NULL;
    return page_write(&d, o->folder);
}

#endif
