// SPDX-License-Identifier: AGPL-3.0-or-later
// Errors of rendered forces against direct solutions. Definitions: docs/fidelity.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fitting/fidelity/hold_out.hpp"
#include "fitting/fidelity/rendered_press.hpp"
#include "format/curves.hpp"

namespace palpate::fidelity {

struct FidelitySettings {
  double floor = 0.02;    ///< N: errors are relative to the local direct force or this, if larger
  double friction = 0.3;  ///< mu: within its cone a tool reaches a deflection without slip
};

/// Rendered and direct force at one state.
struct ComparedState {
  std::size_t point = 0;  ///< index of the hold-out point
  PathKind kind = PathKind::Normal;
  double depth = 0;             ///< m
  double lateral = 0;           ///< m
  Vec3 tangent{};               ///< of the lateral deflection; zero on a normal path
  Vec3 direct{};                ///< N
  Vec3 rendered{};              ///< N
  double scale = 0;             ///< N, max(|direct|, floor)
  bool within_friction = true;  ///< |lateral direct force| <= mu normal direct force

  double total() const { return norm(rendered - direct) / scale; }
};

/// Distribution of a relative error over states.
struct ErrorRow {
  std::string what;  ///< "normal press, off node", ...
  std::string part;  ///< "total", "normal", "lateral", "direction"
  std::size_t states = 0;
  double median = 0, p95 = 0, worst = 0;  ///< nearest rank
  double worst_newton = 0;                ///< N, the error of the worst state
  std::size_t worst_point = 0;
};

struct Fidelity {
  std::vector<ComparedState> states;
  std::vector<ErrorRow> rows;
  std::vector<std::string> left_out;  ///< unusable presses, with the reason
};

/// ErrorRow::what of the presses along the press direction off the nodes.
inline constexpr const char* kNormalOffNode = "normal press, off node";

/// A library and the direct solutions it is compared with.
struct FidelityInput {
  const Library& library;
  const RenderedBody& rendered;  ///< the same library in the runtime
  const std::vector<HoldOutPoint>& points;
  /// SiteCurves::vertex is the index of the point. Normal paths run along its press direction,
  /// lateral paths without slip.
  const Curves& direct;
  /// The curves that the library was fitted to. They separate the error of interpolation from that
  /// of the fit; their lateral depths are the reference of the decoupling rows.
  const Curves& sampled;
};

/// N: the fraction of the force of the body, which is the median over the presses of the largest
/// force of their normal paths; 0 without one. A floor for bodies of any stiffness.
double relative_floor(const Curves& direct, double fraction);

/// Presses the library at the points and compares the forces with the direct solutions.
Fidelity measure(const FidelityInput& input, const FidelitySettings& settings);

}  // namespace palpate::fidelity
