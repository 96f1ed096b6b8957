// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/runtime/step_on_sphere.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "bench/runtime/octasphere.hpp"
#include "bench/runtime/passes.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"

namespace palpate::bench {
namespace {

/// The libraries are large; each is made once.
const palpate_library& body_of(int n, ResponseKind kind) {
  static std::map<std::pair<int, ResponseKind>, std::unique_ptr<palpate_library>> made;
  auto& body = made[{n, kind}];
  if (!body) body = std::make_unique<palpate_library>(octasphere(n, kind));
  return *body;
}

}  // namespace

void step_on_sphere(benchmark::State& state) {
  const auto kind = state.range(1) == 0 ? ResponseKind::Decoupled : ResponseKind::Coupled;
  const palpate_library& body = body_of(static_cast<int>(state.range(0)), kind);
  std::unique_ptr<palpate_state> tool;
  const auto step = [&](const Vec3& x) {
    static constexpr double kVelocity[3] = {0, 0, 0};
    Felt felt;
    felt.status = palpate_step(tool.get(), x.data(), kVelocity, 1 / kRate, felt.force.data());
    return felt;
  };
  const Pass pass = time_passes(state, [&] {
    tool = std::make_unique<palpate_state>(
        body, runtime::ContactSettings{.friction = 0.3, .tank_cap = 5e-3, .lipschitz_bound = 1200});
    step(outside());
    return step;
  });
  const auto sliding = std::count_if(pass.felt.begin(), pass.felt.end(), [](const Felt& felt) {
    return (felt.status & PALPATE_SLIDING) != 0;
  });
  state.counters["triangles"] = static_cast<double>(8 * state.range(0) * state.range(0));
  state.counters["sliding"] = static_cast<double>(sliding) / kSteps;
}

}  // namespace palpate::bench
