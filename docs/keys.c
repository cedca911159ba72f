/* keys - writes docs/keys.md, what the files of the programs hold: every key of summary.json and every column of the
   tables, with its unit. Those of history.csv are the lists that the programs fill it by; of the others
   tests/69_keys.sh holds the lists to what the programs write. SPDX-License-Identifier: MIT */
#include "impact_history.h"
#include "spray_history.h"
#include "taylor_history.h"

typedef history_column key; /* name with its unit behind it; unit; what it is */

static const key impact_summary[] = {
    {"pbcp_percent", "%", "bonded share: of the surface that touched, what has D >= 1 (PBCP); on surfaces, by area, "
                          "what has adhesion that is not spent"},
    {"pbcp_particle_percent", "%", "the same of the particle's surface alone"},
    {"abp", "", "mean D of the surface that touched (ABP)"},
    {"contacted_points", "", "surface points with D > 0"},
    {"bonded_points", "", "surface points with D >= 1"},
    {"held_pairs", "", "pairs of nodes, or markers, that the bond held in the last step"},
    {"v_rest_filtered_m_s", "m/s", "mean upward velocity of the particle's points up to 60 m/s"},
    {"v_rest_mean_m_s", "m/s", "... of all its points"},
    {"v_rest_filtered_relative_m_s", "m/s", "v_rest_filtered less the substrate's drift"},
    {"v_rest_relative_m_s", "m/s", "v_rest_mean less the substrate's drift"},
    {"v_noise_m_s", "m/s", "standard deviation of the upward velocity of the points up to 60 m/s"},
    {"v_quiet_percent", "%", "share of the particle's points within 5 m/s of its mean velocity"},
    {"p_quiet_percent", "%", "share of the particle's points within 0.5 GPa of no pressure"},
    {"v_tangential_m_s", "m/s", "mean velocity of the particle along x"},
    {"substrate_drift_m_s", "m/s", "mean upward velocity of the substrate"},
    {"restitution_ratio", "", "v_rest_filtered over the impact velocity"},
    {"flattening", "", "1 less the particle's height over that at the start"},
    {"crater_depth_um", "um", "depth of the deepest point of the substrate's face"},
    {"contact_area_um2", "um2", "of the whole particle's surface, what touched"},
    {"bonded_area_um2", "um2", "... what bonded"},
    {"interface_dissipation_J_m2", "J/m2", "mean G of what touched; 0 with contact at nodes"},
    {"interface_adhesion_pJ", "pJ", "what it takes to part what bonded; 0 with contact at nodes"},
    {"ejected_mass_fraction", "", "of the particle's mass, what has left it"},
    {"fast_mass_fraction", "", "of the particle's mass, what is faster than 60 m/s"},
    {"eps_mean", "", "mean plastic strain of the particle, by mass"},
    {"plastic_energy_density_mean_MPa", "MPa", "mean plastic work of the particle, by mass"},
    {"temperature_max_K", "K", "of the hottest point"},
    {"points", "", "material points of the model"},
    {"ejected_points", "", "... that have left the particle"},
    {"fast_points", "", "... of the particle, faster than 60 m/s"},
    {"retired_points", "", "... that left the grid"},
    {"steps", "", "of time, so far"},
    {"dt_ns", "ns", "a step"},
    {"time_ns", "ns", "simulated"},
    {"cpu_seconds", "s", "of the run, without the writing of files"},
    {"point_steps_per_second", "1/s", "points times steps over cpu_seconds"},
    {"bytes_per_point", "B", "memory of the world over points"},
    {"mass_error", "", "relative to the mass at the start"},
    {"momentum_error", "", "relative, less what came from outside"},
    {"energy_error", "", "kinetic, internal and absorbed energy less that at the start, relative to it"},
    {"energy_unaccounted", "", "the same with what contact, bond and walls took"},
    {"energy_kinetic_fraction", "", "of the kinetic energy at the start"},
    {"energy_plastic_fraction", "", "... plastic work"},
    {"energy_elastic_fraction", "", "... internal energy since the start that is no plastic work"},
    {"energy_absorbed_fraction", "", "... taken by the dampers"},
    {"energy_contact_fraction", "", "... lost in contact"},
    {"energy_bond_fraction", "", "... lost in the bond"},
    {"energy_calm_fraction", "", "... of noise that --calm turned into heat; part of the internal"},
    {"floor_hits", "", "times the floor of the bond's threshold acted"},
    {"bond_increments", "", "times a bond grew"},
    {"shear_floor_hits", "", "times the shear modulus was kept from falling further"},
    {"iteration_hits", "", "times an iteration of the stress ended at its limit"},
    {"sorts", "", "times the points were put back in cell order"},
    {"options", "", "those of the run, by their names"}};

static const key taylor_summary[] = {
    {"final_length_mm", "mm", "of the bar"},
    {"final_radius_mm", "mm", "largest of the side"},
    {"eps_max", "", "largest plastic strain of a point"},
    {"eps_mean", "", "mean plastic strain, by mass"},
    {"temperature_max", "K", "of the hottest point"},
    {"v_mean_m_s", "m/s", "mean velocity, away from the wall"},
    {"mass_error", "", "relative to the mass at the start"},
    {"momentum_error", "", "relative, less what the wall gave"},
    {"energy_error", "", "kinetic and internal energy less that at the start, relative to it"},
    {"energy_unaccounted", "", "the same with what the wall took"},
    {"energy_wall_fraction", "", "of the kinetic energy at the start, lost at the wall"},
    {"cell_used_mm", "mm", "edge of a cell, after scaling to whole spacings"},
    {"spacing_used_mm", "mm", "distance of points, after scaling"},
    {"points", "", "material points of the model"},
    {"retired_points", "", "... that left the grid"},
    {"steps", "", "of time, so far"},
    {"dt_us", "us", "a step"},
    {"time_us", "us", "simulated"},
    {"cpu_seconds", "s", "of the run, without the writing of files"},
    {"options", "", "those of the run, by their names"}};

static const key taylor_profile[] = {
    {"start_z_mm", "mm", "height of a layer of points at the start"},
    {"z_mm", "mm", "its height at the side now"},
    {"radius_mm", "mm", "its radius now"}};

static const key pull_summary[] = {
    {"strength_MPa", "MPa", "largest nominal stress of the pull"},
    {"peak_force_uN", "uN", "... the force then, of the whole particle"},
    {"peak_way_um", "um", "... the way of the grip then"},
    {"contact_area_um2", "um2", "where the grid, or the surfaces, have both bodies at the end of the impact"},
    {"bonded_node_area_um2", "um2", "... at bonded nodes, or with adhesion"},
    {"work_pJ", "pJ", "of the grip"},
    {"end_way_um", "um", "way of the grip at the end"},
    {"end_stress_MPa", "MPa", "nominal stress at the end"},
    {"samples", "", "rows of pull.csv"},
    {"steps", "", "of time, of impact and pull"},
    {"impact", "", "of the impact before the pull:"},
    {"pbcp_percent", "%", "bonded share, as in impact's summary"},
    {"v_rest_relative_m_s", "m/s", "mean rebound velocity less the substrate's drift"},
    {"contacted_surface_um2", "um2", "of the whole particle's surface, what touched"},
    {"bonded_surface_um2", "um2", "... what bonded"},
    {"nodes_met", "", "nodes of the model where the grid has both bodies"},
    {"nodes_bonded", "", "... that are held by half or more"},
    {"options", "", "those of the run, by their names"}};

static const key pull_table[] = {
    {"time_ns", "ns", "since the grips began"},
    {"way_um", "um", "of the grip"},
    {"force_uN", "uN", "between the bodies, mean of the sample"},
    {"grip_force_uN", "uN", "of the upper grip"},
    {"stress_MPa", "MPa", "force over the area of contact"},
    {"nodes_met", "", "nodes of the model where the grid has both bodies"},
    {"nodes_bonded", "", "... that are held by half or more"},
    {"nodes_held", "", "... where the hold gave force in the last step"}};

static const key particles_summary[] = {
    {"mpm_digits", "", "decimal digits that bring back a number of the program's type"},
    {"particles", "", "how many there are, of which"},
    {"arriving", "", "on their way down"},
    {"bonded", "", "held by a chain of bonds to the substrate, and as slow as it to 5 m/s"},
    {"resting", "", "as slow, without such a chain"},
    {"rebounded", "", "faster upwards than along the face"},
    {"sheared off", "", "faster along the face"},
    {"pbcp_percent", "%", "bonded share of all surfaces that touched"},
    {"points", "", "material points of the model"},
    {"steps", "", "of time"},
    {"time_ns", "ns", "simulated"},
    {"mass_error", "", "relative to the mass at the start"},
    {"energy_unaccounted", "", "what no account of the ledger explains, of the kinetic energy at the start; null "
                              "with MPI"},
    {"floor_hits", "", "times the floor of the bond's threshold acted"},
    {"bond_increments", "", "times a bond grew"},
    {"cpu_seconds", "s", "of the run, without the writing of files"},
    {"tables", "", "checksum of particles.csv and pairs.csv"},
    {"options", "", "those of the run, by their names"}};

static const key particles_table[] = {
    {"particle", "", "its number"},
    {"x_um", "um", "its centre at the start"},
    {"y_um", "um", ""},
    {"z_um", "um", "... over the substrate's face"},
    {"fate", "", "one of the five of the summary"},
    {"pbcp_percent", "%", "bonded share of its surface that touched"},
    {"contacted_points", "", "surface points with D > 0"},
    {"bonded_points", "", "surface points with D >= 1"},
    {"bonded_nodes", "", "nodes where it is held by half or more"},
    {"v_z_m_s", "m/s", "of its points up to 60 m/s, from the substrate's mean: up"},
    {"v_along_m_s", "m/s", "... along the face"},
    {"ejected_mass_share", "", "of its mass, faster than 60 m/s"},
    {"contact_um2", "um2", "its surface that touched, in the model"},
    {"bonded_um2", "um2", "... that bonded"},
    {"height_um", "um", "of its centre of mass now"}};

static const key particles_pairs[] = {
    {"a", "", "number of a body"},
    {"b", "", "... of one that it met; the last body is the substrate"},
    {"pbcp_percent", "%", "bonded share of what touched of both"},
    {"contacted_points", "", "surface points with D > 0"},
    {"bonded_points", "", "surface points with D >= 1"},
    {"bonded_nodes", "", "nodes that are held by half or more"},
    {"held_nodes", "", "... where the hold gave force in the last step"},
    {"contact_um2", "um2", "surface of both that touched, in the model"},
    {"bonded_um2", "um2", "... that bonded"}};

static const key critical_summary[] = {
    {"critical_velocity_m_s", "m/s", "lowest that bonded: median over the positions of the grid; null where nothing "
                                     "bonded at half of them or more"},
    {"not_bonded_below_m_s", "m/s", "at the middle position, the velocity tried next below, which did not bond"},
    {"lowest_m_s", "m/s", "critical velocity at the position where it is lowest"},
    {"highest_m_s", "m/s", "... at that where it is highest"},
    {"uncertainty_m_s", "m/s", "how far the answer may be off: root of the sum of the squares of the next three"},
    {"uncertainty_of_bracket_m_s", "m/s", "half the distance to not_bonded_below_m_s"},
    {"uncertainty_of_position_m_s", "m/s", "half the distance from lowest to highest"},
    {"uncertainty_of_grid_m_s", "m/s", "what --grids 2 moves it by; null with one grid"},
    {"coarser_grid_m_s", "m/s", "the critical velocity on that other grid; not there with one grid"},
    {"offsets_without_bond", "", "positions where nothing bonded at any velocity"},
    {"pbcp_percent", "%", "bonded share at the critical velocity of the middle position"},
    {"v_rest_m_s", "m/s", "mean rebound velocity there"},
    {"runs", "", "impacts of the search"},
    {"runs_made_now", "", "... that were not kept from before"},
    {"cpu_seconds_now", "s", "of these"},
    {"by_offset", "", "for each position of the grid, by its height in um:"},
    {"grid_offset_0_um", "", "one of them"},
    {"critical_velocity_m_s", "m/s", "there"},
    {"not_bonded_below_m_s", "m/s", "... the velocity tried next below"},
    {"pbcp_percent", "%", "... bonded share at the critical velocity"},
    {"v_rest_m_s", "m/s", "... mean rebound velocity at it"},
    {"not_bonded_above", "", "velocities above that did not bond"},
    {"options", "", "those of the search, by their names"}};

static const key critical_curve[] = {
    {"grid_offset_um", "um", "height of a grid plane over the interface"},
    {"velocity_m_s", "m/s", "of the impact"},
    {"bonds", "", "1: it counts as bonded"},
    {"pbcp_percent", "%", "bonded share of the surface that touched"},
    {"abp", "", "mean D of it"},
    {"contacted_points", "", "surface points with D > 0"},
    {"v_rest_m_s", "m/s", "mean upward velocity of the particle's points up to 60 m/s at the end; of all of them where "
                          "more than half of its mass is faster"},
    {"v_mean_m_s", "m/s", "... of all of them, by mass"},
    {"v_late_m_s", "m/s", "... the same over the last eighth of the time"},
    {"substrate_drift_m_s", "m/s", "mean upward velocity of the substrate"},
    {"held_pairs", "", "pairs of nodes, or markers, that the bond held in the last step"},
    {"held_late_share", "", "of the steps of the last eighth, those in which any was held"},
    {"flattening", "", "share of its height that the particle lost"},
    {"eps_mean", "", "mean plastic strain of the particle"},
    {"plastic_energy_density_MPa", "MPa", "mean plastic work of the particle"},
    {"temperature_max_K", "K", "of the hottest point"},
    {"ejected_mass_share", "", "of the particle's mass, what is faster than 60 m/s"},
    {"rim_um", "um", "height of the substrate's rim over its face"},
    {"sheared_mass_share", "", "mass strained beyond 3, of both bodies, over the particle's"},
    {"contact_radius_um", "um", "median distance from the axis of the particle's points with D > 0"},
    {"bonded_radius_um", "um", "... with D >= 1; 0 without any"},
    {"bonded_inner_share", "", "of the bonded points, by mass, those within half the contact's radius"},
    {"energy_unaccounted", "", "what no account of the ledger explains, of the energy at the start"},
    {"end_ns", "ns", "simulated"},
    {"steps", "", "of time"},
    {"points", "", "material points of the model"}};

static const key ranks_totals[] = {
    {"ranks", "", "how many there were"},
    {"steps", "", "of time"},
    {"cuts_moved", "", "times the slabs were cut anew"},
    {"points", "", "material points of the scene, each counted once"},
    {"ghosts", "", "copies of them on other ranks"},
    {"mass_ng", "ng", "of all points"},
    {"momentum_x_ng_m_s", "ng m/s", "of all points"},
    {"momentum_y_ng_m_s", "ng m/s", ""},
    {"momentum_z_ng_m_s", "ng m/s", "... upwards"},
    {"kinetic_pJ", "pJ", "kinetic energy of all points"},
    {"internal_pJ", "pJ", "internal energy of all points"}};

static const key ranks_table[] = {
    {"rank", "", "its number"},
    {"first_cell", "", "of its slab, along the direction that is cut"},
    {"end_cell", "", "... the first one behind it"},
    {"points", "", "that it owns"},
    {"ghosts", "", "copies of its neighbours' points"},
    {"bytes", "B", "memory of its world"},
    {"cpu_s", "s", "processor time"},
    {"waited_s", "s", "... of messages, by the clock"},
    {"sent_bytes_per_step", "B", "to its neighbours"}};

static const key spray_summary[] = {
    {"injected", "", "particles that left the nozzle"},
    {"deposited", "", "... on the target"},
    {"escaped", "", "... that left the domain"},
    {"in_flight", "", "... in flight"},
    {"deposit_fraction", "", "deposited over injected"},
    {"late_rate_over_feed", "", "growth of the deposit in the last part of the time over the feed"},
    {"mean_spread_m", "m", "mean distance of the deposit from the axis"},
    {"scatter_m", "m", "its standard deviation"},
    {"thickness_m", "m", "of the deposit, from its lowest centre to its highest"},
    {"volume_fraction", "", "of the pellet, what is filled"},
    {"volume_r5mm_m3", "m3", "of the deposit within 5 mm of the axis"},
    {"volume_r10mm_m3", "m3", "... within 10 mm"},
    {"collisions_per_particle", "", "in flight, two for each, over injected"},
    {"collided_fraction", "", "of the injected, those that had one"},
    {"impact_speed_mean_m_s", "m/s", "at the first touch of target or deposit"},
    {"impact_speed_sd_m_s", "m/s", "its standard deviation"},
    {"first_hit_stuck_fraction", "", "of the first touches, those that stuck"},
    {"fixed_point_not_converged", "", "particle-steps whose iteration ended at its limit"},
    {"particle_steps_per_second", "1/s", "per CPU second"},
    {"simulated_particle_seconds_per_cpu_second", "", "the same times a step"},
    {"end_time_s", "s", "simulated"},
    {"options", "", "those of the run, by their names"}};

static const key spray_impacts[] = {
    {"time_s", "s", "of a particle's first touch of target or deposit"},
    {"x_m", "m", "where it was"},
    {"y_m", "m", ""},
    {"z_m", "m", ""},
    {"vx_m_s", "m/s", "its velocity"},
    {"vy_m_s", "m/s", ""},
    {"vz_m_s", "m/s", ""},
    {"diameter_m", "m", ""},
    {"stuck", "", "1: it stayed"},
    {"id", "", "its number"},
    {"on_deposit", "", "1: it met the deposit, 0: the target"}};

static const key impact_past[] = {IMPACT_HISTORY(HISTORY_COLUMN)};
static const key taylor_past[] = {TAYLOR_HISTORY(HISTORY_COLUMN)};
static const key spray_past[] = {SPRAY_HISTORY(HISTORY_COLUMN)};

/* A table of the page. past: names are without their units. */
static void section(const char *title, const key *k, size_t n, int past)
{
    char text[HISTORY_KEY];
    size_t i;
    printf("\n## %s\n\n| key | unit | what it is |\n|---|---|---|\n", title);
    for (i = 0; i < n; i++)
        printf("| `%s` | %s | %s |\n", past ? history_key(&k[i], text) : k[i].name, k[i].unit, k[i].about);
}

#define SECTION(title, list, past) section(title, list, sizeof list / sizeof *list, past)

int main(void)
{
    printf("# What the files hold\n\n"
           "Made by `make keys`. Every key of the programs' `summary.json` and every column of their tables, in the\n"
           "order in which they stand there. Before all keys stands `mpm_version`; what is not finite is null. A\n"
           "summary ends with the options of the run, so that it can be repeated. Tables have a line of names and no\n"
           "comment: any reader of CSV takes them as they are. `history.csv` has some two hundred rows of a run.\n");
    SECTION("impact: summary.json", impact_summary, 0);
    SECTION("impact, pull, two_particles, many_particles: history.csv", impact_past, 1);
    SECTION("taylor: summary.json", taylor_summary, 0);
    SECTION("taylor: history.csv", taylor_past, 1);
    SECTION("taylor: profile.csv", taylor_profile, 0);
    SECTION("pull: summary.json", pull_summary, 0);
    SECTION("pull: pull.csv", pull_table, 0);
    SECTION("two_particles, many_particles, mpi/many_particles: summary.json", particles_summary, 0);
    SECTION("two_particles, many_particles, mpi/many_particles: particles.csv", particles_table, 0);
    SECTION("two_particles, many_particles, mpi/many_particles: pairs.csv", particles_pairs, 0);
    SECTION("mpi/many_particles: totals.json", ranks_totals, 0);
    SECTION("mpi/many_particles: ranks.csv", ranks_table, 0);
    SECTION("critical_velocity: summary.json", critical_summary, 0);
    SECTION("critical_velocity: curve.csv", critical_curve, 0);
    SECTION("spray: summary.json", spray_summary, 0);
    SECTION("spray: history.csv", spray_past, 1);
    SECTION("spray: impacts.csv", spray_impacts, 0);
    return fflush(stdout) || ferror(stdout);
}
