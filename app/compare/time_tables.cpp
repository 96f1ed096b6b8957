// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/time_tables.hpp"

#include <cmath>

#include "app/console.hpp"
#include "app/json_number.hpp"
#include "format/number_text.hpp"

namespace palpate::app {

using Json = nlohmann::ordered_json;

namespace {

/// A name as a field: in quotes where it holds a separator.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

}  // namespace

Json time_comparison_json(const std::vector<ComparedHistory>& compared) {
  Json records = Json::array();
  for (const ComparedHistory& h : compared) {
    const compare::TimeComparison& c = h.comparison;
    Json holds = Json::array();
    for (const compare::HeldForce& hold : c.holds)
      holds.push_back({{"from_s", hold.from},
                       {"to_s", hold.to},
                       {"measured_left", json_number(hold.measured)},
                       {"model_left", json_number(hold.model)}});
    records.push_back({{"record", h.record},
                       {"vertex", h.vertex},
                       {"model", h.model},
                       {"rmse_N", c.rmse},
                       {"normalised_rmse", json_number(c.normalised_rmse)},
                       {"bias_N", c.bias},
                       {"worst_N", c.worst},
                       {"worst_at_s", c.worst_time},
                       {"peak_error_N", c.peak_error},
                       {"measured_loss_J", json_number(c.measured_loss)},
                       {"model_loss_J", json_number(c.model_loss)},
                       {"holds", holds},
                       {"time_s", c.time},
                       {"travel_m", c.travel},
                       {"measured_N", c.measured},
                       {"model_N", c.model}});
  }
  return records;
}

std::string time_comparison_csv(const std::vector<ComparedHistory>& compared) {
  std::string text = "record,vertex,model,time_s,travel_m,measured_N,model_N,error_N\n";
  for (const ComparedHistory& h : compared) {
    const compare::TimeComparison& c = h.comparison;
    for (std::size_t i = 0; i < c.time.size(); ++i)
      text += fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", quoted(h.record),
                          h.vertex, h.model, c.time[i], c.travel[i], c.measured[i], c.model[i],
                          c.model[i] - c.measured[i]);
  }
  return text;
}

void say_time_comparison(const std::vector<ComparedHistory>& compared) {
  for (const ComparedHistory& h : compared) {
    const compare::TimeComparison& c = h.comparison;
    answer(
        "  {} at vertex {}, {}: RMSE {} ({} of the largest force), bias {}, worst {} at {:.4g} s",
        h.record, h.vertex, h.model, force_text(c.rmse), percent_text(c.normalised_rmse),
        force_text(c.bias), force_text(c.worst), c.worst_time);
    for (const compare::HeldForce& hold : c.holds)
      answer("    hold from {:.4g} s to {:.4g} s: {} of the force is left, {} of the model",
             hold.from, hold.to, percent_text(hold.measured), percent_text(hold.model));
    if (std::isfinite(c.measured_loss))
      answer("    lost over the record: {} measured, {} by the model ({:+.1f} %)",
             energy_text(c.measured_loss), energy_text(c.model_loss),
             100 * (c.model_loss / c.measured_loss - 1));
  }
}

}  // namespace palpate::app
