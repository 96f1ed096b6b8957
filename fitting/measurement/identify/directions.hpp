// SPDX-License-Identifier: AGPL-3.0-or-later
// From the constants along single directions to those of the worst one.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "fitting/measurement/identify/measured.hpp"
#include "format/vec3.hpp"

namespace palpate::identify {

/// The axes and the diagonals between them, as unit vectors: 1, 4 or 13 for one, two or three axes.
/// A direction and its opposite are one.
std::vector<Vec3> directions_between(const std::vector<std::size_t>& axes);

/// "x", "x-y", "x+y-z", ...
std::string direction_name(const Vec3& direction);

/// Three unit vectors at right angles.
using Frame = std::array<Vec3, 3>;

/// A frame whose first vector is the direction.
Frame frame_along(const Vec3& direction) noexcept;

/// Components of a vector in a frame.
Vec3 in_frame(const Frame& frame, const Vec3& vector) noexcept;

/// A constant along a direction.
struct Directional {
  Vec3 direction{};
  Measured value;
};

/// sigma_0(B): the smallest eigenvalue of the symmetric matrix B whose values n . B n are nearest
/// to those along the directions, weighted by their deviations. Its deviation is the root of the
/// sum of the squares of those of all entries, as an eigenvalue moves by at most the Frobenius norm
/// of the error [Weyl 1912], times the misfit in deviations where that is above one.
Measured smallest_damping(const std::vector<Directional>& damping);

/// sigma_0(S): the friction along the direction whose lower bound is smallest.
/// A motion along n of joints with constant dry friction dissipates p(n) a metre, a convex function
/// [Moreau 1974]. A tip that a force along n moves in another direction v shows n . grad p(v),
/// which is at most p(n): its estimate is on the safe side.
/// Between the directions p can be smaller still: by a factor of 0.7 for three joints alike at
/// right angles (0.58 for the axes alone), without a bound for joints nearly in a plane.
/// @param friction  at least one
Measured smallest_friction(const std::vector<Directional>& friction);

}  // namespace palpate::identify
