// SPDX-License-Identifier: Apache-2.0
// The part of the displacement of the skin that moves with the contact point.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "format/deformation.hpp"
#include "format/vec3.hpp"

namespace palpate::runtime {

/// A skin vertex as the contact sees it. noexcept, allocation-free.
struct FromContact {
  double distance = 0;  ///< s = |X - c|, m
  Vec3 radial{};        ///< e_r, unit, across n; zero at the contact point
  Vec3 around{};        ///< e_phi = n x e_r
  /// 1 on the side of the contact, 0 from where the skin faces away by more than 90 degrees: the
  /// other side of a thin body has no part of the dimple.
  double facing = 0;

  FromContact(const Vec3& contact, const Vec3& n, const Vec3& x, const Vec3& skin_normal) noexcept {
    constexpr double kFullyFacing = 0.5;  // cosine
    const Vec3 r = x - contact;
    distance = norm(r);
    facing = std::clamp(dot(skin_normal, n) / kFullyFacing, 0.0, 1.0);
    const Vec3 across = r - dot(r, n) * n;
    const double length = norm(across);
    if (!(length > 1e-12 * (1 + distance))) return;
    radial = (1.0 / length) * across;
    around = cross(n, radial);
  }

  /// The displacement of a press, m: `normal` along n, `outward` along e_r.
  Vec3 press(const Vec3& n, double normal, double outward) const noexcept {
    return facing * (normal * n + outward * radial);
  }
  /// The displacement, m, of a lateral deflection q across n:
  ///   A (e_r . q) e_r + B (e_phi . q) e_phi + C (e_r . q) n,  and A q at the contact point.
  Vec3 lateral(const Vec3& n, const Vec3& q, double a, double b, double c) const noexcept {
    if (dot(radial, radial) == 0) return facing * a * q;
    const double along = dot(radial, q), across = dot(around, q);
    return facing * (a * along * radial + b * across * around + c * along * n);
  }

  /// 1, cos phi, sin phi, cos 2 phi, sin 2 phi of the azimuth phi of the vertex from the unit
  /// tangent t; at the contact point all but the first are 0.
  std::array<double, kHarmonics> harmonics(const Vec3& t) const noexcept {
    const double cos = dot(radial, t), sin = -dot(around, t);
    return {1, cos, sin, cos * cos - sin * sin, 2 * sin * cos};
  }
  /// The displacement, m, with these components: Fourier series of the azimuth from the unit
  /// tangent t, along t, n x t and n.
  Vec3 anisotropic(const Vec3& n, const Vec3& t,
                   const std::array<double, kAnisotropicComponents>& p) const noexcept {
    const auto h = harmonics(t);
    double along = 0, across = 0, normal = 0;
    for (std::size_t i = 0; i < kHarmonics; ++i) {
      along += p[i] * h[i];
      across += p[kHarmonics + i] * h[i];
    }
    for (std::size_t i = 0; i < kNormalHarmonics; ++i) normal += p[2 * kHarmonics + i] * h[i];
    return facing * (along * t + across * cross(n, t) + normal * n);
  }
};

/// Weights of a piecewise linear function of the distance at s: knots i and i + 1.
struct KnotWeights {
  std::size_t below = 0;
  double above_weight = 0;  ///< that of knot below + 1
};
/// `knots` ascending, at least 2; s beyond them takes the end.
template <class Knots>
KnotWeights knot_weights(const Knots& knots, double s) noexcept {
  const auto next = std::upper_bound(knots.begin() + 1, knots.end() - 1, s);
  const auto below = static_cast<std::size_t>(next - knots.begin()) - 1;
  const double t = (s - knots[below]) / (knots[below + 1] - knots[below]);
  return {below, std::clamp(t, 0.0, 1.0)};
}

}  // namespace palpate::runtime
