// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/runtime/step_on_sphere.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "bench/runtime/octasphere.hpp"
#include "bench/runtime/passes.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"

namespace palpate::bench {
namespace {

Library relaxing(Library library) {
  library.tool_radius = 0.005;
  library.relaxation_times = {0.01, 0.1, 1};
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const float fraction = 0.1F + 0.05F * static_cast<float>(v % 3);
    library.responses[v].relaxation.assign(3, fraction);
  }
  return library;
}

/// The libraries are large; each is made once.
const palpate_library& body_of(int n, std::int64_t variant) {
  static std::map<std::pair<int, std::int64_t>, std::unique_ptr<palpate_library>> made;
  auto& body = made[{n, variant}];
  if (!body) {
    const auto kind = variant % 2 == 0 ? ResponseKind::Decoupled : ResponseKind::Coupled;
    Library library = octasphere(n, kind);
    body = std::make_unique<palpate_library>(variant < 2 ? library : relaxing(library));
  }
  return *body;
}

}  // namespace

void step_on_sphere(benchmark::State& state) {
  const palpate_library& body = body_of(static_cast<int>(state.range(0)), state.range(1));
  const auto motion = static_cast<Motion>(state.range(2));
  std::unique_ptr<palpate_state> tool;
  const auto step = [&](const Vec3& x) {
    static constexpr double kVelocity[3] = {0, 0, 0};
    Felt felt;
    felt.status = palpate_step(tool.get(), x.data(), kVelocity, 1 / kRate, felt.force.data());
    return felt;
  };
  const Pass pass = time_passes(
      state,
      [&] {
        tool = std::make_unique<palpate_state>(
            body,
            runtime::ContactSettings{.friction = 0.3, .tank_cap = 5e-3, .lipschitz_bound = 1200});
        step(outside());
        if (motion == Motion::Press)
          for (const Vec3& x : approach()) step(x);
        return step;
      },
      motion);
  const auto sliding = std::count_if(pass.felt.begin(), pass.felt.end(), [](const Felt& felt) {
    return (felt.status & PALPATE_SLIDING) != 0;
  });
  state.counters["triangles"] = static_cast<double>(8 * state.range(0) * state.range(0));
  state.counters["sliding"] = static_cast<double>(sliding) / kSteps;
}

}  // namespace palpate::bench
