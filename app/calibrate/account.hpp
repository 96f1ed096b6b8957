// SPDX-License-Identifier: AGPL-3.0-or-later
// What is said of a calibration, on the terminal and in JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "app/calibrate/press_fit.hpp"
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

namespace palpate::app {

nlohmann::ordered_json calibration_account(const calibrate::Calibration& calibration,
                                           double confidence);
nlohmann::ordered_json homogeneous_account(const calibrate::HomogeneousFit& fit,
                                           const calibrate::HomogeneousSettings& settings,
                                           const std::vector<calibrate::HomogeneousTest>& tests);

nlohmann::ordered_json press_account(const PressFit& fit, double confidence);

/// A line for each constant, lengths in units that fit, and the warnings.
void say_calibration(const calibrate::Calibration& calibration, double confidence);
void say_homogeneous(const calibrate::HomogeneousFit& fit);

}  // namespace palpate::app
