// SPDX-License-Identifier: AGPL-3.0-or-later
// One site as an input file of another finite element program, in SI units: mesh, laws, supports,
// and the tool that is pressed in by increments, or a patch of the surface that is moved instead.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fem/campaign/campaign.hpp"
#include "fem/contact/tool_mesh.hpp"
#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::app {

/// A facet of the body: an element and one of its four sides. Side 0 has the corners 0, 1, 2 of the
/// element, then 0, 3, 1; 1, 3, 2; 2, 3, 0.
struct ElementSide {
  std::int32_t element, side;
};
inline constexpr std::array<std::array<std::size_t, 3>, 4> kTetSides{
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

/// The six nodes of a side, as seen from outside.
fem::Facet facet_of(const fem::Tetrahedron10& element, std::int32_t side);

/// A rigid tool at its first touch.
struct PressingTool {
  fem::ToolMesh mesh;
  std::vector<ElementSide> skin;  ///< of the body, where it may meet the tool
  double stiffness = 0;           ///< N/m^3, pressure over penetration
};

/// The tool moved along a tangent after the press, at its depth, without slip.
struct LateralMove {
  Vec3 direction{};   ///< unit
  double travel = 0;  ///< m, at the end
  int increments = 1;
};

/// How the tool is moved into tissue that relaxes: at constant speed, then not at all.
struct PressAndHold {
  double press = 1;  ///< s, from first touch to the depth
  double hold = 0;   ///< s, at the depth
};

struct Deck {
  std::string title;
  fem::QuadraticMesh mesh;          ///< `fixed`: by the supports alone
  std::vector<std::int32_t> patch;  ///< nodes moved together; none where a tool is pressed
  std::optional<PressingTool> tool;
  bool no_slip = false;  ///< of the tool while it is pressed
  std::optional<LateralMove> lateral;
  std::vector<std::string> region_names;
  std::vector<fem::LawConstants> laws;  ///< of each region; instantaneous ones where it relaxes
  std::vector<RelaxationSeries> relaxation;  ///< of each region
  Vec3 direction{};                          ///< of the motion, unit
  double depth = 0;                          ///< m, at the end
  int increments = 1;
  std::optional<PressAndHold> pace;  ///< where a region relaxes

  bool relaxes() const;
};

/// The surface nodes within `radius` of a site moved inward together: no contact, which any program
/// can repeat node by node.
/// @throws Error(Configuration) for linear elements, tissue that relaxes, and as fem::bonded_patch
/// and fem::run_campaign.
Deck make_patch_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex,
                     double radius);

/// The tool of the settings pressed in along the press direction, with the contact stiffness of
/// the campaign. `lateral`: then the first lateral path of the settings, from the end of the press.
/// @throws Error(Configuration) for linear elements, a vertex that is no site, a tool with a sharp
/// edge, as fem::run_campaign.
Deck make_tool_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex,
                    bool lateral = false);

/// Input of CalculiX: C3D10 elements, *HYPERELASTIC, face-to-face contact; the forces of the tool
/// or the patch in each increment go to its .dat file. Its volumetric energy is kappa/2 (J - 1)^2,
/// which agrees with that of palpate to second order in J - 1 (but for Arruda-Boyce, where it is
/// the same). Contact without slip is Coulomb friction with a coefficient of 5, which holds the
/// points of facets that are pressed; palpate ties nodes.
/// @throws Error(Configuration) naming the region and the law where CalculiX has none like it; for
/// tissue that relaxes.
std::string calculix_deck(const Deck& deck);

/// Input of FEBio, file format 4.0: tet10 elements of four points, uncoupled laws with the same
/// volumetric energy as here, sliding-elastic contact; the forces of the tool or the nodes of the
/// patch go to a text file. Regions that relax are `uncoupled viscoelastic`: the convolution of the
/// isochoric stress with the series, as in fem/relaxation. The time of the deck is then that of the
/// press and the hold, which ends in steps that grow.
/// @throws Error(Configuration) naming the region and the law where FEBio has none like it; for
/// contact without slip; for tissue that relaxes without `pace` or with more than six terms.
std::string febio_deck(const Deck& deck);

}  // namespace palpate::app
