// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/realtime/ride.hpp"

#include <cmath>
#include <limits>

#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {

const palpate_library& ride_body() {
  static const palpate_library body([] {
    Library library = bumpy_sphere(4, 0.03, 0.2, [](const Vec3& x) {
      return wall_response(170 * (1 + 0.6 * std::sin(150 * x[2])), 100);
    });
    for (std::size_t v = 0; v < 12; ++v) library.responses[200 + v] = {};
    return library;
  }());
  return body;
}

std::uint32_t ride(palpate_state& state) {
  const double velocity[3] = {0, 0, 0};
  double force[3];
  std::uint32_t seen = 0;
  const auto step = [&](const Vec3& x) {
    seen |= palpate_step(&state, x.data(), velocity, 1e-3, force);
  };
  for (int i = 0; i < 60000; ++i) {
    const double a = 2e-3 * i;
    const double r = 0.031 + 0.008 * std::cos(5e-4 * i);
    step(r * Vec3{std::cos(a), 0.8 * std::sin(a), 0.6 * std::sin(a + 1e-4 * i)});
    if (i % 7000 == 6999) step({std::numeric_limits<double>::quiet_NaN(), 0, 0});
    if (i % 9000 == 8999) step({1e300, 0, 0});
  }
  palpate_observation observation{};
  observation.size = sizeof observation;
  palpate_observe(&state, &observation);
  return seen;
}

std::uint32_t ride_bits() {
  return PALPATE_CONTACT | PALPATE_ACTIVATED | PALPATE_RELEASED | PALPATE_SLIDING |
         PALPATE_AT_BORDER | PALPATE_ENERGY_LIMITED | PALPATE_BAD_INPUT | PALPATE_DROPPED |
         PALPATE_FORCE_LIMITED;
}

}  // namespace palpate::test
