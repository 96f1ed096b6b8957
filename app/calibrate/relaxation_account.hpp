// SPDX-License-Identifier: AGPL-3.0-or-later
// What is said of a fitted Prony series, on the terminal and in JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fitting/measurement/relaxation/relaxation_fit.hpp"

namespace palpate::app {

/// The keys `relaxation` and `moduli` of a [[material]] of a case.
std::string relaxation_keys(const RelaxationSeries& series);

/// Young's modulus of an incompressible half-space that resists a sphere with this force at this
/// depth, Pa: E = 9 F/(16 sqrt(R) d^1.5) [Hertz 1882].
double half_space_modulus(double force, double radius, double depth);

/// @param radius  of the tool, m; 0: no sphere.
nlohmann::ordered_json relaxation_account(const calibrate::RelaxationFit& fit,
                                          const calibrate::RelaxationSettings& settings,
                                          const std::vector<calibrate::RelaxationRecord>& records,
                                          double radius);

void say_relaxation(const calibrate::RelaxationFit& fit,
                    const std::vector<calibrate::RelaxationRecord>& records, double radius);

}  // namespace palpate::app
