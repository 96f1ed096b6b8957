// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/runtime/step_on_sphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Across the press direction, as long as on a liver, turning from node to node.
std::array<float, 3> tangent(const Vec3& inward, std::size_t v, double length) {
  const Vec3 turning{std::cos(static_cast<double>(v)), std::sin(static_cast<double>(v)), 0.3};
  const Vec3 across = turning - dot(turning, inward) * inward;
  const Vec3 t = (length / norm(across)) * across;
  return {static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2])};
}

Library with_axes(Library library) {
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    library.responses[v].lean = tangent(library.inward[v], v, 0.02);
    library.responses[v].soft_axis = tangent(library.inward[v], v + 1, 0.25);
  }
  return library;
}

struct Variant {
  ResponseKind kind;
  bool relaxes, has_axes;
};

/// By range(1).
constexpr Variant kVariants[] = {
    {ResponseKind::Decoupled, false, false}, {ResponseKind::Coupled, false, false},
    {ResponseKind::Decoupled, true, false},  {ResponseKind::Coupled, true, false},
    {ResponseKind::Coupled, false, true},    {ResponseKind::Coupled, true, true}};

/// The libraries are large; each is made once.
const palpate_library& body_of(int n, std::int64_t number) {
  static std::map<std::pair<int, std::int64_t>, std::unique_ptr<palpate_library>> made;
  auto& body = made[{n, number}];
  if (!body) {
    const Variant& variant = kVariants[number];
    Library library = octasphere(n, variant.kind);
    if (variant.relaxes) library = relaxing(std::move(library));
    if (variant.has_axes) library = with_axes(std::move(library));
    body = std::make_unique<palpate_library>(library);
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
