// SPDX-License-Identifier: Apache-2.0
// The skin as it is pressed. Equations: docs/theory-deformation.md.
#pragma once

#include <cstddef>
#include <vector>

#include "format/deformation.hpp"
#include "format/vec3.hpp"
#include "runtime/touch.hpp"

namespace palpate::runtime {

/// Immutable after construction; shared by any number of threads.
class SkinDeformation {
 public:
  /// `triangles`: those of the library, in its order.
  /// @throws Error(Configuration) where the file has more modes, knots or donors than fit into
  /// the fixed memory of displace().
  SkinDeformation(Deformation deformation, std::vector<Triangle> triangles);

  const std::vector<Vec3>& positions() const noexcept { return d_.positions; }  ///< at rest, m
  const std::vector<Triangle>& triangles() const noexcept { return d_.triangles; }
  const Deformation& data() const noexcept { return d_; }

  /// The displaced vertices in the world, m, three numbers each: 3 W. noexcept, allocation-free;
  /// the time is proportional to the number of vertices times that of modes.
  void displace(Touch touch, double* positions) const noexcept;

  static constexpr std::size_t kMostModes = 512, kMostKnots = 64, kMostDonors = 40;

 private:
  struct Blend;
  struct Shape;
  Blend blend_at(const SurfacePoint& point) const noexcept;
  double contact_growth(double level, double depth) const noexcept;
  double stretch(double level, double depth) const noexcept;
  void add_press(const Blend& blend, const Touch& touch, Shape& shape) const noexcept;
  void add_lateral(const Blend& blend, const Touch& touch, Shape& shape) const noexcept;
  void add_anisotropic(std::size_t site, std::size_t k, double weight, const Touch& touch,
                       double* profiles) const noexcept;
  Vec3 shared_part(const Shape& shape, std::size_t vertex) const noexcept;
  Vec3 at_contact(const Touch& touch, const Shape& shape) const noexcept;
  void add_both(const Blend& blend, const Touch& touch, Shape& shape) const noexcept;
  void add_modes(const Shape& shape, std::size_t begin, std::size_t count, float* u) const noexcept;
  Vec3 local_part(const Touch& touch, const Shape& shape, std::size_t vertex) const noexcept;
  Vec3 outside_of_tool(const Touch& touch, const Vec3& x) const noexcept;

  Deformation d_;
  std::vector<Triangle> surface_;  ///< of the library
  std::vector<Vec3> normals_;      ///< of the skin, into the body
};

}  // namespace palpate::runtime
