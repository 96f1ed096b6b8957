// SPDX-License-Identifier: AGPL-3.0-or-later
// What a body with given constants would have shown in a recorded history, with derivatives.
#pragma once

#include <vector>

#include "fitting/measurement/relaxation/relaxation_record.hpp"

namespace palpate::calibrate {

/// Constants of one record.
template <class T>
struct BodyConstants {
  T force, exponent, second_power;  ///< N, p, w
  std::vector<T> fraction, time;    ///< g_i; tau_i, s
};

/// Refers to the record.
class HistoryModel {
 public:
  HistoryModel(const RelaxationRecord& record, double largest_travel);

  const RelaxationRecord& record() const { return record_; }
  const std::vector<double>& measured() const {
    return record_.force_is_held ? record_.travel : record_.force;
  }
  /// Largest measured value, N or m.
  double scale() const { return scale_; }

  /// Force at each sample, N, never negative: a body does not pull. Where the force is held the
  /// travel, m.
  std::vector<double> predict(const BodyConstants<double>& c) const;

  /// Residuals over the scale, and their derivatives by force, exponent, second power, fractions
  /// and logarithms of the times, `columns` of them a sample.
  void differentiate(const BodyConstants<double>& c, double* r, std::vector<double>& slopes) const;
  static std::size_t columns(std::size_t terms) { return 3 + 2 * terms; }

  /// For unit forces and exponents alone: e at each sample, and the memory of a term of fraction 1
  /// with this time, from the measured travel.
  std::vector<double> elastic(double exponent) const;
  std::vector<double> memory(double exponent, double time) const;

 private:
  template <class T>
  std::vector<T> predicted(const BodyConstants<T>& c) const;

  const RelaxationRecord& record_;
  double largest_travel_, scale_;
  std::vector<double> time_, depth_;  ///< s, x: the samples and points between them
  std::vector<std::size_t> sample_;   ///< of each sample, among these
};

/// Terms at most, so that derivatives have a fixed size.
inline constexpr std::size_t kMostTerms = 4;

}  // namespace palpate::calibrate
