// SPDX-License-Identifier: AGPL-3.0-or-later
// Recorded histories as a least squares problem.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fitting/measurement/relaxation/history_model.hpp"
#include "fitting/measurement/relaxation/relaxation_fit.hpp"

namespace palpate::calibrate {

/// Where the constants of a problem stand: the force of each record, then exponent and second power
/// where they are fitted, fractions, and the logarithms of the times where they are free.
struct ConstantPlaces {
  std::size_t records = 0, terms = 0;
  std::optional<std::size_t> exponent, second_power;
  std::size_t fraction = 0;
  std::optional<std::size_t> time;
  std::size_t count = 0;
};

/// Refers to the records. One thread at a time.
class RelaxationProblem {
 public:
  /// @throws Error(Configuration) for no record, and settings out of range.
  RelaxationProblem(const std::vector<RelaxationRecord>& records,
                    const RelaxationSettings& settings);
  RelaxationProblem(const RelaxationProblem&) = delete;
  RelaxationProblem& operator=(const RelaxationProblem&) = delete;

  ConstantPlaces places(std::size_t terms) const;
  /// Refers to this problem.
  LeastSquares squares(std::size_t terms) const;
  std::vector<std::vector<double>> starts(std::size_t terms) const;
  BodyConstants<double> body(const ConstantPlaces& places, const double* constants,
                             std::size_t record) const;

  const std::vector<HistoryModel>& models() const { return models_; }
  double largest_travel() const { return largest_travel_; }
  double shortest_time() const { return shortest_time_; }  ///< s, that is sought
  double longest_time() const { return longest_time_; }
  double shortest_seen() const { return shortest_seen_; }  ///< s, see RelaxationFit
  double longest_seen() const { return longest_seen_; }
  std::vector<std::size_t> series() const;

 private:
  bool evaluate(const ConstantPlaces& places, const double* c, double* r, double* J) const;
  std::vector<double> full_start(const ConstantPlaces& places, std::size_t from,
                                 const std::vector<double>& fraction,
                                 const std::vector<double>& time, double exponent) const;

  RelaxationSettings settings_;
  std::vector<HistoryModel> models_;
  double largest_travel_ = 0, shortest_time_ = 0, longest_time_ = 0;
  double shortest_seen_ = 0, longest_seen_ = 0;
  std::size_t longest_record_ = 0;
};

}  // namespace palpate::calibrate
