// SPDX-License-Identifier: AGPL-3.0-or-later
// The displacement with which the solver starts an increment.
#pragma once

#include <vector>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The last equilibria of a path, at most four, extrapolated along it.
class Predictor {
 public:
  /// The equilibrium `u` at travel `s`, larger than all before.
  void add(double s, const Displacement& u);
  /// Another equilibrium at the travel of the last one.
  void replace_last(const Displacement& u) { states_.back().u = u; }

  /// Polynomial extrapolation to `s` through as many states as keep det F above 0.3 everywhere; the
  /// last state where none does.
  Displacement predict(const SolidModel& model, double s) const;

  const Displacement& last() const { return states_.back().u; }

 private:
  struct State {
    double s;
    Displacement u;
  };

  Displacement extrapolate(double s, std::size_t count) const;

  std::vector<State> states_;
};

}  // namespace palpate::fem
