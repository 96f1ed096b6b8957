// SPDX-License-Identifier: AGPL-3.0-or-later
// Where on the body something was measured.
#pragma once

#include <string>
#include <vector>

#include "format/body.hpp"

namespace palpate::measured {

/// x_body = R x + t.
struct RigidMotion {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< of R
  Vec3 translation{};                                                     ///< m

  Vec3 rotate(const Vec3& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vec3 operator()(const Vec3& x) const { return rotate(x) + translation; }
};

/// A point as the robot and as the body know it.
struct Fiducial {
  Vec3 robot{}, body{};
};

/// The rotation and translation that bring the fiducials together best, without scale
/// [Arun, Huang & Blostein 1987], and what they miss.
struct Registration {
  RigidMotion motion;
  double rms = 0;  ///< m, root mean square distance of the fiducials after it
};

/// @throws Error(Configuration) for fewer than three fiducials, or fiducials on one line.
Registration register_fiducials(const std::vector<Fiducial>& fiducials, const std::string& where);

struct NearestSite {
  int vertex = -1;      ///< of the response surface
  double distance = 0;  ///< m, from the point to the vertex
};

/// The site whose vertex is nearest to the point.
/// @throws Error(Configuration) when it is farther than `tolerance`, or the body has no site.
NearestSite nearest_site(const Body& body, const Vec3& point, double tolerance,
                         const std::string& where);

}  // namespace palpate::measured
