// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/leave_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/measurement/nearest_rank.hpp"
#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/to_index.hpp"
#include "mesher/patch/patch.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::app {
namespace {

using Json = nlohmann::ordered_json;

/// A relative error and the vertex that it belongs to.
using VertexError = std::pair<double, std::int32_t>;

ErrorDistribution distribution_of(std::vector<VertexError> errors) {
  ErrorDistribution d;
  d.count = errors.size();
  if (errors.empty()) return d;
  std::sort(errors.begin(), errors.end());
  d.median = errors[fitting::nearest_rank(errors.size(), 0.5)].first;
  d.p95 = errors[fitting::nearest_rank(errors.size(), 0.95)].first;
  std::tie(d.worst, d.worst_vertex) = errors.back();
  return d;
}

/// The sites with a response and a measured press.
class Sites {
 public:
  Sites(const Library& library, const Curves& curves) : library_(library) {
    for (const SiteCurves& site : curves.sites) {
      const NodeResponse& response = library.responses.at(to_index(site.vertex));
      if (response.status != ResponseStatus::Fitted || site.paths.empty()) continue;
      points_.push_back({fmt::format("site {}", site.vertex),
                         library.positions[to_index(site.vertex)],
                         -library.inward[to_index(site.vertex)]});
      responses_.emplace_back(response.normal);
      presses_.push_back(press_of(site));
    }
  }

  LeaveOut run() const {
    LeaveOut result;
    result.floor = floor();
    for (std::size_t i = 0; i < points_.size(); ++i) result.sites.push_back(prediction(i));
    std::vector<VertexError> deepest, all;
    for (const LeftOutSite& site : result.sites) {
      for (std::size_t k = 0; k < site.predicted.size(); ++k) {
        const double error = std::abs(site.predicted[k] - site.measured[k]) /
                             std::max(std::abs(site.measured[k]), result.floor);
        all.emplace_back(error, site.vertex);
        if (k + 1 == site.predicted.size()) deepest.emplace_back(error, site.vertex);
      }
    }
    if (all.empty()) {
      refuse(library_.name, "no site has others all around it, so that none is predicted",
             "measure three rows of sites or more");
    }
    result.deepest = distribution_of(std::move(deepest));
    result.all = distribution_of(std::move(all));
    compare_neighbours(result);
    return result;
  }

 private:
  static LeftOutSite press_of(const SiteCurves& site) {
    LeftOutSite press;
    press.vertex = site.vertex;
    const CurvePath& path = site.paths.front();
    for (const CurveSample& sample : path.samples) {
      if (!(sample.displacement > 0)) continue;
      press.depth.push_back(sample.displacement);
      press.measured.push_back(dot(sample.force, path.direction));
    }
    return press;
  }

  double floor() const {
    std::vector<double> largest;
    for (const LeftOutSite& press : presses_) {
      largest.push_back(*std::max_element(press.measured.begin(), press.measured.end()));
    }
    if (largest.empty()) return 0;
    std::sort(largest.begin(), largest.end());
    return kLeaveOutFloor * largest[fitting::nearest_rank(largest.size(), 0.5)];
  }

  LeftOutSite prediction(std::size_t left_out) const {
    LeftOutSite site = presses_[left_out];
    std::vector<mesher::ContactPoint> others = points_;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const mesher::Patch patch = mesher::make_patch(others, library_.name);
    const auto place = mesher::place_on(patch, others, points_[left_out].position);
    if (!place) return site;
    const Triangle& corners = patch.triangles[place->triangle];
    std::vector<std::size_t> index;
    for (const std::int32_t corner : corners) {
      index.push_back(to_index(corner) + (to_index(corner) >= left_out ? 1 : 0));
      site.from.push_back(presses_[index.back()].vertex);
    }
    for (const double depth : site.depth) {
      double force = 0;
      for (std::size_t l = 0; l < 3; ++l)
        force += place->natural[l] * responses_[index[l]].force(depth);
      site.predicted.push_back(force);
    }
    return site;
  }

  /// Along the edges of the patch of all sites.
  void compare_neighbours(LeaveOut& result) const {
    std::vector<VertexError> deepest, all;
    for (const Edge& edge : edges_of(mesher::make_patch(points_, library_.name).triangles)) {
      const LeftOutSite &a = presses_[to_index(edge[0])], &b = presses_[to_index(edge[1])];
      std::vector<double> x{0}, y{0};
      x.insert(x.end(), b.depth.begin(), b.depth.end());
      y.insert(y.end(), b.measured.begin(), b.measured.end());
      const compare::MonotoneCubic other(x, y);
      for (std::size_t k = 0; k < a.depth.size(); ++k) {
        const double f = a.measured[k], g = other.value(a.depth[k]);
        const double error =
            std::abs(f - g) / std::max(0.5 * (std::abs(f) + std::abs(g)), result.floor);
        all.emplace_back(error, a.vertex);
        if (k + 1 == a.depth.size()) deepest.emplace_back(error, a.vertex);
      }
    }
    result.neighbours_deepest = distribution_of(std::move(deepest));
    result.neighbours_all = distribution_of(std::move(all));
  }

  const Library& library_;
  std::vector<mesher::ContactPoint> points_;
  std::vector<runtime::CompiledCurve> responses_;
  std::vector<LeftOutSite> presses_;
};

std::string row(const char* what, const ErrorDistribution& d) {
  return fmt::format("  {:<46} {:>6} {:>8} {:>8} {:>8}   {}\n", what, d.count,
                     percent_text(d.median), percent_text(d.p95), percent_text(d.worst),
                     d.worst_vertex);
}

Json distribution_json(const ErrorDistribution& d) {
  return {{"count", d.count},
          {"median", d.median},
          {"p95", d.p95},
          {"worst", d.worst},
          {"worst_vertex", d.worst_vertex}};
}

std::size_t predicted_sites(const LeaveOut& result) {
  return static_cast<std::size_t>(
      std::count_if(result.sites.begin(), result.sites.end(),
                    [](const LeftOutSite& site) { return !site.predicted.empty(); }));
}

}  // namespace

LeaveOut leave_sites_out(const Library& library, const Curves& curves) {
  return Sites(library, curves).run();
}

LeaveOutSets sets_of(const LeaveOut& result, const Library& library, const Curves& curves) {
  LeaveOutSets sets{compare::set_of(curves, "each site as measured"), {}};
  for (compare::ComparedSite& site : sets.measured.sites) {
    site.position = library.positions.at(to_index(site.vertex));
    std::erase_if(site.curves, [](const compare::ComparedCurve& curve) {
      return curve.kind != PathKind::Normal;
    });
  }
  sets.predicted = {.name = "the site left out, from those around it",
                    .body_sha256 = curves.body_sha256,
                    .sites = {},
                    .tool_shape = sets.measured.tool_shape,
                    .tool_radius = sets.measured.tool_radius,
                    .tool_friction = sets.measured.tool_friction};
  for (const LeftOutSite& site : result.sites) {
    if (site.predicted.empty()) continue;
    compare::ComparedCurve curve;
    curve.displacement = {0};
    curve.force = {0};
    curve.displacement.insert(curve.displacement.end(), site.depth.begin(), site.depth.end());
    curve.force.insert(curve.force.end(), site.predicted.begin(), site.predicted.end());
    curve.uncertainty.assign(curve.force.size(), kUnknown);
    curve.scatter = curve.uncertainty;
    sets.predicted.sites.push_back(
        {site.vertex, library.positions.at(to_index(site.vertex)), {curve}});
  }
  return sets;
}

std::string leave_out_text(const LeaveOut& result) {
  const std::size_t predicted = predicted_sites(result);
  std::string text = fmt::format(
      "{} of {} predicted from those around them; the others lie at the border\n"
      "errors are relative to the measured force, or to {} where that is larger\n",
      predicted, count_text(result.sites.size(), "site"), force_text(result.floor));
  text += fmt::format("  {:<46} {:>6} {:>8} {:>8} {:>8}   {}\n", "relative force error", "count",
                      "median", "95 %", "worst", "at site");
  text += row("site left out, deepest sample", result.deepest);
  text += row("site left out, all samples", result.all);
  text += row("difference of neighbours, deepest sample", result.neighbours_deepest);
  text += row("difference of neighbours, all samples", result.neighbours_all);
  return text;
}

Json leave_out_json(const LeaveOut& result, const Library& library) {
  Json sites = Json::array();
  for (const LeftOutSite& site : result.sites) {
    sites.push_back({{"vertex", site.vertex},
                     {"position_m", library.positions.at(to_index(site.vertex))},
                     {"from", site.from},
                     {"depth_m", site.depth},
                     {"measured_N", site.measured},
                     {"predicted_N", site.predicted}});
  }
  return {{"kind", "palpate.leave_out"},
          {"relative_to", "max(|measured force|, floor)"},
          {"floor_N", result.floor},
          {"sites", result.sites.size()},
          {"predicted_sites", predicted_sites(result)},
          {"deepest", distribution_json(result.deepest)},
          {"all", distribution_json(result.all)},
          {"neighbours_deepest", distribution_json(result.neighbours_deepest)},
          {"neighbours_all", distribution_json(result.neighbours_all)},
          {"presses", sites}};
}

}  // namespace palpate::app
