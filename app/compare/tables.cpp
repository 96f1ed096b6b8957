// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "app/json_number.hpp"
#include "format/provenance.hpp"

namespace palpate::app {
namespace {

using Json = nlohmann::ordered_json;

const char* kind_name(PathKind kind) {
  return kind == PathKind::Normal ? "normal" : "lateral";
}

/// An unknown value is an empty field.
std::string field(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

Json point_json(const compare::ComparedPoint& p) {
  return {{"displacement_m", p.displacement},
          {"reference_N", p.reference},
          {"model_N", p.model},
          {"uncertainty_N", json_number(p.uncertainty)},
          {"scatter_N", json_number(p.scatter)},
          {"jnd", p.jnd}};
}

Json curve_json(const compare::CurveComparison& c) {
  Json stiffness = Json::array(), points = Json::array();
  for (const compare::StiffnessAt& s : c.stiffness) {
    stiffness.push_back({{"displacement_m", s.displacement},
                         {"reference_N_per_m", s.reference},
                         {"model_N_per_m", s.model}});
  }
  for (const compare::ComparedPoint& p : c.points) points.push_back(point_json(p));
  return {{"vertex", c.vertex},
          {"model_vertex", c.model_vertex},
          {"distance_m", c.distance},
          {"kind", kind_name(c.kind)},
          {"lateral_depth_m", c.lateral_depth},
          {"range_m", c.range},
          {"rmse_N", c.rmse},
          {"normalised_rmse", json_number(c.normalised_rmse)},
          {"r2", json_number(c.r2)},
          {"bias_N", c.bias},
          {"worst", point_json(c.worst)},
          {"rms_jnd", c.jnd_rms},
          {"noticeable_fraction", c.noticeable},
          {"within_uncertainty_fraction", json_number(c.within_uncertainty)},
          {"uncertainty_N", json_number(c.mean_uncertainty)},
          {"scatter_N", json_number(c.mean_scatter)},
          {"energy_reference_J", c.energy_reference},
          {"energy_model_J", c.energy_model},
          {"stiffness", stiffness},
          {"points", points}};
}

Json summary_json(const compare::Summary& s) {
  return {{"kind", kind_name(s.kind)},
          {"curves", s.curves},
          {"points", s.points},
          {"rmse_N", s.rmse},
          {"normalised_rmse", json_number(s.normalised_rmse)},
          {"bias_N", s.bias},
          {"agreement_low_N", s.agreement_low},
          {"agreement_high_N", s.agreement_high},
          {"rms_jnd", s.jnd_rms},
          {"noticeable_fraction", s.noticeable},
          {"within_uncertainty_fraction", json_number(s.within_uncertainty)},
          {"scatter_N", json_number(s.mean_scatter)},
          {"worst_vertex", s.worst_vertex},
          {"worst", point_json(s.worst)}};
}

}  // namespace

std::string comparison_csv(const compare::Comparison& comparison) {
  std::string out =
      "vertex,model_vertex,kind,lateral_depth_m,range_m,rmse_N,normalised_rmse,r2,bias_N,"
      "worst_difference_N,worst_at_m,rms_jnd,noticeable_fraction,within_uncertainty_fraction,"
      "uncertainty_N,scatter_N,energy_reference_J,energy_model_J\n";
  for (const compare::CurveComparison& c : comparison.curves) {
    fmt::format_to(
        std::back_inserter(out), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
        c.vertex, c.model_vertex, kind_name(c.kind), c.lateral_depth, c.range, c.rmse,
        field(c.normalised_rmse), field(c.r2), c.bias, c.worst.model - c.worst.reference,
        c.worst.displacement, c.jnd_rms, c.noticeable, field(c.within_uncertainty),
        field(c.mean_uncertainty), field(c.mean_scatter), c.energy_reference, c.energy_model);
  }
  return out;
}

std::string comparison_points_csv(const compare::Comparison& comparison) {
  std::string out =
      "vertex,kind,lateral_depth_m,displacement_m,reference_N,model_N,difference_N,uncertainty_N,"
      "scatter_N,difference_jnd\n";
  for (const compare::CurveComparison& c : comparison.curves) {
    for (const compare::ComparedPoint& p : c.points) {
      fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{},{}\n", c.vertex,
                     kind_name(c.kind), c.lateral_depth, p.displacement, p.reference, p.model,
                     p.model - p.reference, field(p.uncertainty), field(p.scatter), p.jnd);
    }
  }
  return out;
}

Json comparison_json(const compare::Comparison& comparison,
                     const compare::CompareSettings& settings) {
  Json summaries = Json::array(), curves = Json::array();
  for (const compare::Summary& s : comparison.summaries) summaries.push_back(summary_json(s));
  for (const compare::CurveComparison& c : comparison.curves) curves.push_back(curve_json(c));
  return {{"artifact", "palpate.comparison"},
          {"schema", 1},
          {"creator", creator_text()},
          {"reference", comparison.reference},
          {"model", comparison.model},
          {"jnd", settings.jnd},
          {"jnd_floor_N", settings.jnd_floor},
          {"confidence", settings.confidence},
          {"summaries", summaries},
          {"unmatched", comparison.unmatched},
          {"curves", curves}};
}

}  // namespace palpate::app
