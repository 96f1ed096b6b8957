// SPDX-License-Identifier: AGPL-3.0-or-later
// How far the rendered force is from the solid that it stands for. Definitions: docs/fidelity.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fitting/fidelity/hold_out.hpp"
#include "fitting/fidelity/rendered_press.hpp"
#include "format/curves.hpp"

namespace palpate::fidelity {

struct FidelitySettings {
  double floor = 0.02;  ///< N: an error is relative to the local direct force, or to this if larger
  double friction = 0.3;  ///< mu that tells which deflections a tool reaches without slipping
};

/// Rendered and direct force at one state.
struct ComparedState {
  std::size_t point = 0;  ///< of the held-out points
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
  std::vector<std::string> left_out;  ///< presses that could not be used, and why
};

/// ErrorRow::what of the presses along the inward direction where no node is.
inline constexpr const char* kNormalOffNode = "normal press, off node";

/// Presses of the library at the points against direct solutions `direct` (its `vertex` counts the
/// points; normal paths along the inward direction, lateral paths with the contact stuck).
/// `sampled` are the curves that the library was fitted to: they separate what interpolation costs
/// from what the fit costs, and their held depths are those that the decoupling is judged from.
Fidelity measure(const Library& library, const RenderedBody& body,
                 const std::vector<HoldOutPoint>& points, const Curves& direct,
                 const Curves& sampled, const FidelitySettings& settings);

}  // namespace palpate::fidelity
