// SPDX-License-Identifier: AGPL-3.0-or-later
// Least squares without the constants that are linear in them.
#pragma once

#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {

/// A problem in the constants that bend its residuals; those over which they are straight lines
/// have their best values within their bounds [Golub & Pereyra 1973]. Where terms of a law can
/// stand for each other, the valley of the misfit is long, narrow and bent in all constants
/// together, and short in these alone. The Jacobian is that of [Kaufman 1975].
class Projection {
 public:
  /// The problem must outlive it.
  explicit Projection(const LeastSquares& problem);

  /// Whether there are constants of both kinds.
  bool is_useful() const { return !linear_.empty() && !bent_.empty(); }
  /// From the starts of the whole problem. The projection must outlive it.
  LeastSquares reduced() const;
  /// All constants, the linear ones at their best. False where the model has no value.
  bool expand(const double* bent, std::vector<double>& all) const;

 private:
  struct Best;
  bool solve(const double* bent, Best& best) const;

  const LeastSquares& problem_;
  std::vector<std::size_t> linear_, bent_;
};

}  // namespace palpate::calibrate
