// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/relaxation_account.hpp"

#include <cmath>
#include <numeric>
#include <sstream>

#include "app/calibrate/account.hpp"
#include "app/console.hpp"
#include "app/json_number.hpp"
#include "format/number_text.hpp"

namespace palpate::app {

using Json = nlohmann::ordered_json;
namespace cal = calibrate;

namespace {

Json interval_json(const cal::Interval& i) {
  return {
      {"value", json_number(i.value)}, {"low", json_number(i.low)}, {"high", json_number(i.high)}};
}

Json tried_json(const cal::RelaxationFit& fit) {
  Json tried = Json::array();
  for (const cal::TriedSeries& t : fit.tried)
    tried.push_back({{"terms", t.terms},
                     {"relative_rms", json_number(t.relative_rms)},
                     {"aicc", json_number(t.aicc)},
                     {"bic", json_number(t.bic)},
                     {"refused", t.refused}});
  return tried;
}

cal::Interval modulus_of(const cal::Interval& force, double radius, double depth) {
  return {half_space_modulus(force.value, radius, depth),
          half_space_modulus(force.low, radius, depth),
          half_space_modulus(force.high, radius, depth)};
}

Json record_json(const cal::FittedRecord& fitted, const cal::RelaxationRecord& record,
                 double radius, double depth) {
  const bool creep = record.force_is_held;
  Json json = {{"file", fitted.name},
               {"held", creep ? "force" : "travel"},
               {"ramp_s", record.ramp},
               {"span_s", record.span()},
               {"every_sample", record.stride},
               {"instantaneous_force_N", interval_json(fitted.instantaneous)},
               {"long_term_force_N", interval_json(fitted.long_term)},
               {creep ? "rms_m" : "rms_N", fitted.rms},
               {"relative_rms", fitted.relative_rms},
               {"time_s", record.time},
               {"travel_m", record.travel},
               {"force_N", record.force},
               {creep ? "fitted_m" : "fitted_N", fitted.fitted}};
  if (radius > 0) {
    json["instantaneous_half_space_young_Pa"] =
        interval_json(modulus_of(fitted.instantaneous, radius, depth));
    json["long_term_half_space_young_Pa"] =
        interval_json(modulus_of(fitted.long_term, radius, depth));
  }
  return json;
}

std::string force_interval_text(const cal::Interval& i) {
  return fmt::format("{} ({} to {})", force_text(i.value), force_text(i.low), force_text(i.high));
}

}  // namespace

double half_space_modulus(double force, double radius, double depth) {
  return 9 * force / (16 * std::sqrt(radius) * std::pow(depth, 1.5));
}

std::string relaxation_keys(const RelaxationSeries& series) {
  std::string text = "relaxation = [";
  for (const RelaxationBranch& b : series)
    text += fmt::format("{}{{ fraction = {:.4g}, time = \"{:.4g} s\" }}",
                        text.back() == '[' ? "" : ", ", b.fraction, b.time_s);
  return text + "]\nmoduli = \"instantaneous\"\n";
}

Json relaxation_account(const cal::RelaxationFit& fit, const cal::RelaxationSettings& settings,
                        const std::vector<cal::RelaxationRecord>& records, double radius) {
  Json series = Json::array(), band = Json::array(), fitted = Json::array();
  for (const RelaxationBranch& b : fit.series)
    series.push_back({{"fraction", b.fraction}, {"time_s", b.time_s}});
  for (const cal::BandPoint& point : fit.band)
    band.push_back({{"time_s", point.time},
                    {"value", point.g.value},
                    {"low", json_number(point.g.low)},
                    {"high", json_number(point.g.high)}});
  for (std::size_t i = 0; i < records.size(); ++i)
    fitted.push_back(record_json(fit.records[i], records[i], radius, fit.largest_travel));
  Json account = {{"relaxation", series},
                  {"case_material", relaxation_keys(fit.series)},
                  {"long_term_fraction", interval_json(fit.long_term_fraction)},
                  {"curve", settings.curve == cal::ElasticCurve::Power ? "power" : "two powers"},
                  {"exponent", fit.exponent},
                  {"exponent_fitted", settings.fit_exponent},
                  {"second_power", fit.second_power},
                  {"largest_travel_m", fit.largest_travel},
                  {"shortest_time_shown_s", fit.shortest},
                  {"longest_time_shown_s", fit.longest},
                  {"criterion", settings.criterion == cal::Criterion::Bic ? "BIC" : "AICc"},
                  {"tried", tried_json(fit)}};
  account.update(calibration_account(fit.calibration, settings.confidence));
  account["records"] = fitted;
  account["relaxation_function"] = band;
  return account;
}

void say_relaxation(const cal::RelaxationFit& fit,
                    const std::vector<cal::RelaxationRecord>& records, double radius) {
  for (const cal::TriedSeries& t : fit.tried)
    answer("  {} term{}: {}{}", t.terms, t.terms == 1 ? "" : "s",
           std::isfinite(t.bic) ? fmt::format("rms {}, AICc {:.1f}, BIC {:.1f}",
                                              percent_text(t.relative_rms), t.aicc, t.bic)
                                : std::string(),
           t.refused.empty() ? "" : (std::isfinite(t.bic) ? "; not taken: " : "") + t.refused);
  answer("  as keys of the [[material]] of a case:");
  std::istringstream keys(relaxation_keys(fit.series));
  for (std::string line; std::getline(keys, line);) answer("    {}", line);
  const cal::Interval& g = fit.long_term_fraction;
  answer("  the long-term constants are {:.4g} ({:.4g} to {:.4g}) of the instantaneous ones",
         g.value, g.low, g.high);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const cal::FittedRecord& r = fit.records[i];
    answer("  {}: rms {} ({}); at {} the elastic force is {} at once, {} in the long term", r.name,
           records[i].force_is_held ? length_text(r.rms) : force_text(r.rms),
           percent_text(r.relative_rms), length_text(fit.largest_travel),
           force_interval_text(r.instantaneous), force_interval_text(r.long_term));
    if (radius > 0)
      answer(
          "    of an incompressible half-space under this sphere: E {:.4g} kPa at once, {:.4g} kPa "
          "in the long term",
          1e-3 * half_space_modulus(r.instantaneous.value, radius, fit.largest_travel),
          1e-3 * half_space_modulus(r.long_term.value, radius, fit.largest_travel));
  }
  answer(
      "  the records show what relaxes within {:.3g} s to {:.3g} s, and say nothing of shorter and "
      "longer times",
      fit.shortest, fit.longest);
}

}  // namespace palpate::app
