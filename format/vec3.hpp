// SPDX-License-Identifier: Apache-2.0
// Plain geometric records shared by every artifact. No algebra library: the runtime uses them too.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace palpate {

using Vec3 = std::array<double, 3>;
using Edge = std::array<std::int32_t, 2>;
using Triangle = std::array<std::int32_t, 3>;  ///< vertex indices, counter-clockwise from outside
using Tetrahedron = std::array<std::int32_t, 4>;  ///< positively oriented vertex indices

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
constexpr Vec3 operator-(const Vec3& a) {
  return {-a[0], -a[1], -a[2]};
}
constexpr Vec3 operator*(double s, const Vec3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
constexpr double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
/// A vector that is stored in single precision.
constexpr Vec3 vec3_of(const std::array<float, 3>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}
inline bool is_finite(const Vec3& a) noexcept {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

}  // namespace palpate
