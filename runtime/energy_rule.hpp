// SPDX-License-Identifier: Apache-2.0
// The rule by which a slide creates no energy.
#pragma once

#include "format/vec3.hpp"
#include "runtime/local_model.hpp"

namespace palpate::runtime {

/// Smallest offset in [low, high] at which the energy of the model at x does not exceed `budget`.
/// The energy falls as the offset rises (dE/dd0 = -g <= 0), and must not exceed the budget at
/// `high`. Newton steps inside a shrinking bracket, at most 64; the energy at the result never
/// exceeds the budget, and equals it to 1e-9 unless `low` already satisfies it. noexcept,
/// allocation-free.
double least_offset(const LocalModel& model, const Vec3& x, double budget, double low,
                    double high) noexcept;

/// Energy that was absorbed before and is available to an activation.
class EnergyTank {
 public:
  explicit EnergyTank(double cap) noexcept : cap_(cap) {}
  double level() const noexcept { return level_; }  ///< J
  /// E_{i-1}(x_i) + tank: the most energy that the next model may store.
  double budget(double energy_before) const noexcept { return energy_before + level_; }
  /// tank := clamp(tank + E_{i-1}(x_i) - E_i(x_i), 0, cap)
  void settle(double energy_before, double energy_after) noexcept;
  void empty() noexcept { level_ = 0; }

 private:
  double cap_;
  double level_ = 0;
};

/// Outcome of the rule for a model moved by a slide.
struct EnergyVerdict {
  bool fix_contact_point = false;  ///< no offset is enough: the contact point must not move
  bool limited = false;            ///< the offset was raised
  double offset = 0;               ///< m
};

/// Rules 2 and 3. `moved` is the model after the slide, with the offset of the step before, and
/// `at` its response at x. When its energy exceeds the budget the offset is raised until they are
/// equal; otherwise it is lowered towards `goal` (its value at the collision) by at most
/// `recovery`, as far as the budget allows.
EnergyVerdict judge(const LocalModel& moved, const Vec3& x, const LocalResponse& at, double budget,
                    double goal, double recovery) noexcept;

}  // namespace palpate::runtime
