// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "format/vec3.hpp"

namespace palpate::fem {

/// What is known of the fibres at a point at rest.
struct FibreSample {
  Vec3 at{};      ///< m
  Vec3 mean{};    ///< direction, of any length but zero
  Vec3 across{};  ///< second direction of the plane of the fibres; zero where it is not known
};

/// Samples that are found by their places. Immutable: may be read from several threads.
class FibreSamples {
 public:
  /// @throws Error(Configuration) where there is none, or one is not finite or has no direction.
  explicit FibreSamples(std::vector<FibreSample> samples);

  const FibreSample& nearest(const Vec3& X) const;

 private:
  /// A k-d tree without pointers: the middle sample of a range divides the others along the axis
  /// of its level.
  void arrange(std::size_t first, std::size_t last, std::size_t axis);
  void search(std::size_t first, std::size_t last, std::size_t axis, const Vec3& X,
              const FibreSample*& best, double& distance) const;

  std::vector<FibreSample> samples_;
};

}  // namespace palpate::fem
