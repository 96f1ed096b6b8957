// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/account.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "app/case/material.hpp"
#include "app/console.hpp"
#include "app/json_number.hpp"
#include "format/number_text.hpp"

namespace palpate::app {

using Json = nlohmann::ordered_json;

Json calibration_account(const calibrate::Calibration& calibration, double confidence) {
  Json constants = Json::array(), correlation = Json::array();
  for (const calibrate::Estimate& e : calibration.estimates) {
    Json profile = Json::array();
    for (const auto& [value, rise] : e.profile) profile.push_back({value, rise});
    constants.push_back({{"name", e.name},
                         {"unit", e.unit},
                         {"value", e.value},
                         {"standard_error", json_number(e.standard_error)},
                         {"low", json_number(e.low)},
                         {"high", json_number(e.high)},
                         {"profile_low", json_number(e.profile_low)},
                         {"profile_high", json_number(e.profile_high)},
                         {"profile", profile},
                         {"at_bound", e.at_bound}});
  }
  for (const auto& row : calibration.correlation) {
    Json numbers = Json::array();
    for (const double value : row) numbers.push_back(json_number(value));
    correlation.push_back(numbers);
  }
  return {{"converged", calibration.converged},
          {"confidence", confidence},
          {"constants", constants},
          {"correlation", correlation},
          {"condition", json_number(calibration.condition)},
          {"degrees_of_freedom", calibration.freedom},
          {"residual_scatter", calibration.scatter},
          {"intervals_widened", calibration.widened},
          {"residual_lag_one_correlation", calibration.lag_one},
          {"residual_durbin_watson", calibration.durbin_watson},
          {"noise_autocorrelation", calibration.autocorrelation},
          {"misfit_smoother_than_noise", calibration.beyond_noise},
          {"intervals_widened_for_correlation", calibration.correlation_widening},
          {"effective_degrees_of_freedom", calibration.effective_freedom},
          {"iterations", calibration.iterations},
          {"warnings", calibration.warnings}};
}

Json homogeneous_account(const calibrate::HomogeneousFit& fit,
                         const calibrate::HomogeneousSettings& settings,
                         const std::vector<calibrate::HomogeneousTest>& tests) {
  Json account = {{"law", settings.law},
                  {"shear_modulus_Pa", fit.shear_modulus},
                  {"case_material", material_keys(fit.law)}};
  account.update(calibration_account(fit.calibration, settings.confidence));
  Json errors = Json::array();
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const calibrate::TestError& e = fit.errors[i];
    const calibrate::StabilityLimit& limit = fit.stability[i];
    errors.push_back({{"test", e.name},
                      {"mode", calibrate::mode_name(tests[i].mode)},
                      {"rms_Pa", e.rms},
                      {"relative_rms", e.relative},
                      {"r2", json_number(e.r2)},
                      {"worst_Pa", e.worst},
                      {"worst_at", e.worst_at},
                      {"stable_from", limit.low},
                      {"stable_to", limit.high},
                      {"unstable_at", json_number(limit.unstable_at)},
                      {"deformation", tests[i].deformation},
                      {"measured_nominal_Pa", tests[i].nominal},
                      {"fitted_nominal_Pa", fit.predicted[i]}});
  }
  account["tests"] = errors;
  Json unstable = nullptr;
  if (std::isfinite(fit.all_states.unstable_at[0])) unstable = fit.all_states.unstable_at;
  account["stability_of_all_states"] = {{"largest_log_strain", fit.all_states.largest_strain},
                                        {"unstable_at_stretches", unstable}};
  return account;
}

Json press_account(const PressFit& fit, double confidence) {
  Json account = calibration_account(fit.calibration, confidence);
  account["rms_N"] = fit.rms;
  account["relative_rms"] = fit.relative_rms;
  account["evaluations"] = fit.evaluations;
  account["profile_evaluations"] = fit.profile_evaluations;
  Json paths = Json::array();
  for (const FittedPath& path : fit.paths) {
    Json uncertainty = Json::array();
    for (const double u : path.uncertainty) {
      uncertainty.push_back(std::isfinite(u) ? Json(u) : Json(nullptr));
    }
    const bool normal = path.kind == PathKind::Normal;
    paths.push_back({{"curves", path.set + 1},
                     {"vertex", path.vertex},
                     {"kind", normal ? "normal" : "lateral"},
                     {"lateral_depth_m", normal ? Json(nullptr) : Json(path.lateral_depth)},
                     {"contact_shift_m", path.contact_shift},
                     {"displacement_m", path.depth},
                     {"measured_N", path.measured},
                     {"fitted_N", path.fitted},
                     {"uncertainty_N", uncertainty}});
  }
  account["paths"] = paths;
  return account;
}

namespace {

/// A value of a constant with its unit; lengths in one that fits.
std::string value_text(double value, const std::string& unit) {
  if (unit == "m") return length_text(value);
  return fmt::format("{:.6g}{}", value, unit == "1" ? "" : " " + unit);
}

}  // namespace

void say_calibration(const calibrate::Calibration& calibration, double confidence) {
  for (const calibrate::Estimate& e : calibration.estimates) {
    const std::string value = value_text(e.value, e.unit);
    // Lengths carry their own units; other intervals have that of the value.
    const std::string unit = e.unit == "m" ? e.unit : "1";
    const auto interval = [&](double low, double high) {
      return value_text(low, unit) + " to " + value_text(high, unit);
    };
    const std::string profile = std::isnan(e.profile_low)
                                    ? ""
                                    : ", by its profile " + interval(e.profile_low, e.profile_high);
    if (e.at_bound)
      answer("  {} = {}, at its bound{}", e.name, value, profile);
    else
      answer("  {} = {}, {:.4g} % interval {}{}", e.name, value, 100 * confidence,
             interval(e.low, e.high), profile);
  }
  for (const std::string& warning : calibration.warnings) warn(warning);
}

namespace {

/// "12.4 kPa", "0.124 Pa" or "1.24 mPa".
std::string pressure_text(double pascal) {
  const double size = std::abs(pascal);
  if (size >= 1e6) return number_text(1e-6 * pascal) + " MPa";
  if (size >= 1e3) return number_text(1e-3 * pascal) + " kPa";
  if (size >= 1e-1 || size == 0) return number_text(pascal) + " Pa";
  return number_text(1e3 * pascal) + " mPa";
}

}  // namespace

void say_homogeneous(const calibrate::HomogeneousFit& fit) {
  answer("  for a case:");
  answer("    [[material]]");
  std::istringstream keys(material_keys(fit.law));
  for (std::string line; std::getline(keys, line);) answer("    {}", line);
  answer("  shear modulus at rest: {}", pressure_text(fit.shear_modulus));
  for (const calibrate::TestError& e : fit.errors) {
    answer("  {}: rms {} ({}), R2 {:.5f}, worst {} at {:.4g}", e.name, pressure_text(e.rms),
           percent_text(e.relative), e.r2, pressure_text(e.worst), e.worst_at);
  }
}

}  // namespace palpate::app
