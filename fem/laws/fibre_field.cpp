// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/fibre_field.hpp"

#include <cmath>
#include <numbers>

#include "fem/laws/require.hpp"
#include "format/error.hpp"

namespace palpate::fem {

namespace {

Vec3 unit(const Vec3& v) {
  return (1 / norm(v)) * v;
}

/// The part of `v` normal to the unit vector `n`.
Vec3 normal_part(const Vec3& v, const Vec3& n) {
  return v - dot(v, n) * n;
}

/// Some unit vector normal to `n`.
Vec3 any_normal(const Vec3& n) {
  const Vec3 axis = std::abs(n[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return unit(normal_part(axis, n));
}

}  // namespace

std::array<Vec3, 2> FibreField::at(const Vec3& X) const {
  Vec3 mean = unit(first), across{};
  if (kind == Kind::Cylindrical) {
    across = unit(first);
    const Vec3 radial = normal_part(X - origin, across);
    const Vec3 outward = norm(radial) > 0 ? unit(radial) : any_normal(across);
    mean = cross(across, outward);
  } else {
    Vec3 in_plane = second;
    if (kind == Kind::Sampled) {
      const FibreSample& sample = samples->nearest(X);
      mean = unit(sample.mean);
      if (norm(sample.across) > 0) in_plane = sample.across;
    }
    const Vec3 part = normal_part(in_plane, mean);
    // Where a sampled direction runs along the plane's second one, any other serves.
    across = norm(part) > 1e-6 * norm(in_plane) ? unit(part) : any_normal(mean);
  }
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec3 plus = c * mean + s * across;
  return {plus, families == 1 ? plus : c * mean - s * across};
}

void FibreField::check(const std::string& where) const {
  require_constant(families == 1 || families == 2, where, "families", families, "1 or 2");
  require_constant(angle >= 0 && angle <= std::numbers::pi / 2, where, "angle (rad)", angle,
                   "0 <= angle <= pi/2");
  if (kind == Kind::Sampled || kind == Kind::Laplace) {
    if (!(std::isfinite(norm(second)) && norm(second) > 0))
      throw Error(ErrorKind::Configuration, where,
                  "the second direction of the plane of the fibres has no length",
                  "give a direction that is finite and not zero");
    return;
  }
  const double length = norm(first);
  if (!(std::isfinite(length) && length > 0))
    throw Error(ErrorKind::Configuration, where, "the direction of the fibres has no length",
                "give a direction that is finite and not zero");
  if (kind == Kind::Cylindrical) return;
  const double part = norm(normal_part(second, unit(first)));
  if (!(std::isfinite(part) && part > 1e-6 * norm(second)))
    throw Error(ErrorKind::Configuration, where,
                "the two directions of the plane of the fibres are parallel or zero",
                "give a second direction that is not along the first");
}

}  // namespace palpate::fem
