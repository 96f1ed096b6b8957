// SPDX-License-Identifier: AGPL-3.0-or-later
// One site as an input file of another finite element program, in SI units: mesh, laws, supports
// and a patch of the surface that is moved inward in increments.
#pragma once

#include <string>
#include <vector>

#include "fem/campaign.hpp"
#include "fem/stuck_patch.hpp"

namespace palpate::app {

struct Deck {
  std::string title;
  fem::StuckPatch patch;
  std::vector<std::string> region_names;
  std::vector<fem::LawConstants> laws;  ///< of each region
  Vec3 direction{};                     ///< of the motion of the patch, unit
  double depth = 0;                     ///< m, at the end
  int increments = 1;
};

/// @throws Error(Configuration) as fem::stuck_patch and fem::run_campaign.
Deck make_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex,
               double radius);

/// Input of CalculiX: C3D10 elements, *HYPERELASTIC; the forces of the patch in each increment
/// go to its .dat file. Its volumetric energy is kappa/2 (J - 1)^2, which agrees with that of
/// palpate to second order in J - 1 (but for Arruda-Boyce, where it is the same).
/// @throws Error(Configuration) naming the region and the law where CalculiX has none like it.
std::string calculix_deck(const Deck& deck);

/// Input of FEBio, file format 4.0: tet10 elements of four points, uncoupled laws with the same
/// volumetric energy as here; the nodal forces of the patch go to a text file.
/// @throws Error(Configuration) naming the region and the law where FEBio has none like it.
std::string febio_deck(const Deck& deck);

}  // namespace palpate::app
