// SPDX-License-Identifier: AGPL-3.0-or-later
// Sizes of a mesh, a tool and its paths that suit a body.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "app/init/base.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::app {

/// Area of an equilateral triangle over its edge squared, twice: a vertex for two triangles.
inline constexpr double kAreaOfVertex = 0.866;

/// Depth over patch below which a contact is too small to be resolved by the elements.
inline constexpr double kShallowestOverPatch = 0.12;

/// How the elements under the tool are refined.
enum class Refinement {
  ByContact,  ///< as the contact asks for
  Once,
  None
};

/// Lengths in m, rounded to two digits.
struct FirstSizes {
  double patch_spacing = 0;
  double element_size = 0;
  double tool_radius = 0;
  double depth = 0;
  double lateral_travel = 0;
  double pressable_area = 0;        ///< m^2, that off the base
  double thickness = 0;             ///< m, of the body below the surface, in the median
  double thin_parts = 0;            ///< m, the thickness that a twentieth of the area is below
  bool is_thin = false;             ///< the thickness, not the number of sites, sets the patches
  bool is_coarsest = false;         ///< fewer sites would need patches that do not show the shape
  bool is_shallow = false;          ///< pressed less deep than the shape allows, to save time
  bool is_slow_where_thin = false;  ///< where it is shallow: thin parts take most of the time
  Refinement refinement = Refinement::ByContact;
  std::optional<std::int64_t> sites;           ///< of the meshed body, where it was meshed
  std::optional<std::int64_t> sites_too_slow;  ///< as many were tried, and took longer than wanted
  std::optional<double> seconds;               ///< that the campaign takes, where it was tried
};

/// Two digits of a length or a time.
double two_digits(double value);

/// Patches so large that about `sites` response vertices lie off the base, but at most a sixth of
/// the extent, and down to half as large where the body is thin; elements of half a patch; a tool
/// that covers more than one element; a depth that keeps the contact smaller than the tool and the
/// strain below a third of the thickness and 0.6 of that of thin parts, as long as it can
/// be resolved; lateral paths of half the depth.
/// @param surface closed, oriented outward
/// @param inward unit vector into the body at a point of the surface, or zero; empty: across its
///   faces
FirstSizes first_sizes(const mesher::Surface& surface, const Base& base, int sites,
                       const std::function<Vec3(const Vec3&)>& inward = {});

}  // namespace palpate::app
