// SPDX-License-Identifier: AGPL-3.0-or-later
// Random responses of three nodes, and random points between them.
#pragma once

#include <array>
#include <cstddef>
#include <random>

#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"

namespace palpate::runtime {

inline ResponseCurve random_curve(std::mt19937& random, bool with_plateaus) {
  std::uniform_real_distribution<float> step(0.0001F, 0.002F);
  std::uniform_real_distribution<float> slope(0.0F, 900.0F);
  ResponseCurve curve;
  float d = 0;
  const int knots = 2 + static_cast<int>(random() % 9);
  for (int k = 0; k < knots; ++k) {
    curve.knot.push_back(d);
    curve.slope.push_back(with_plateaus && random() % 3 == 0 ? 0.0F : slope(random));
    d += step(random);
  }
  return curve;
}

/// Three nodes with random curves.
struct RandomNodes {
  explicit RandomNodes(std::mt19937& random, bool with_plateaus = false) {
    for (std::size_t l = 0; l < 3; ++l) {
      for (const std::size_t kind : {0U, 1U}) {
        curves[l][kind] = CompiledCurve(random_curve(random, with_plateaus));
      }
      packed[l] = NodeCurves::write(memory[l].data(), curves[l][0], curves[l][1]);
      curves[l][2] = CompiledCurve(random_curve(random, with_plateaus), 0.3);
      coupled[l] = NodeCurves::write(more[l].data(), curves[l][0], curves[l][1], curves[l][2]);
    }
  }
  InterpolatedResponse at(const Vec3& natural) const {
    return {{&packed[0], &packed[1], &packed[2]}, natural};
  }
  InterpolatedResponse coupled_at(const Vec3& natural) const {
    return {{&coupled[0], &coupled[1], &coupled[2]}, natural};
  }
  std::array<std::array<CompiledCurve, 3>, 3> curves;  // normal, lateral, coupling
  std::array<std::array<CacheLine, 24>, 3> memory, more;
  std::array<NodeCurves, 3> packed, coupled;
};

inline Vec3 random_natural(std::mt19937& random) {
  std::uniform_real_distribution<double> any(0, 1);
  Vec3 n{any(random), any(random), any(random)};
  if (random() % 4 == 0) n[random() % 3] = 0;  // on an edge
  return (1.0 / (n[0] + n[1] + n[2])) * n;
}

}  // namespace palpate::runtime
