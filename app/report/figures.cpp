// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/report/straight_press.hpp"
#include "fitting/measurement/nearest_rank.hpp"
#include "format/edge.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::report {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double along(const CurveSample& sample, const CurvePath& path, const Vec3& inward) {
  return dot(sample.force, path.kind == PathKind::Normal ? inward : path.direction);
}

}  // namespace

double secant_stiffness(const NodeResponse& response, ResponseKind kind, double d) {
  if (response.status == ResponseStatus::Hole || response.normal.knot.size() < 2) return kNaN;
  return runtime::CompiledCurve(straight_press(response, kind)).force(d) / d;
}

double relative_error(double error, double peak) {
  return peak > 0 ? error / peak : kNaN;
}

PeakForce peak_force(const SiteCurves& site, const Vec3& inward) {
  PeakForce peak;
  for (const CurvePath& path : site.paths) {
    double& target = path.kind == PathKind::Normal ? peak.normal : peak.lateral;
    for (const CurveSample& sample : path.samples)
      target = std::max(target, std::abs(along(sample, path, inward)));
  }
  return peak;
}

ChosenVertices choose_vertices(const Library& library, const std::vector<PeakForce>& peaks,
                               double d) {
  ChosenVertices chosen;
  std::vector<std::pair<double, std::int32_t>> order;
  double worst = -1;
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const NodeResponse& response = library.responses[v];
    const double stiffness = secant_stiffness(response, library.kind, d);
    if (!std::isfinite(stiffness)) continue;
    order.emplace_back(stiffness, static_cast<std::int32_t>(v));
    if (response.status != ResponseStatus::Fitted) continue;
    for (const double error : {relative_error(response.normal_error, peaks[v].normal),
                               relative_error(response.lateral_error, peaks[v].lateral)}) {
      if (!(error > worst)) continue;  // also false for NaN
      worst = error;
      chosen.worst_fit = static_cast<std::int32_t>(v);
    }
  }
  if (order.empty()) return chosen;
  std::sort(order.begin(), order.end());
  chosen.softest = order.front().second;
  chosen.median = order[(order.size() - 1) / 2].second;
  chosen.stiffest = order.back().second;
  return chosen;
}

std::vector<PathBalance> path_balances(const Curves& curves) {
  std::vector<PathBalance> balances;
  for (const SiteCurves& site : curves.sites) {
    for (const CurvePath& path : site.paths) {
      if (path.samples.empty()) continue;
      const CurveSample& end = path.samples.back();
      const double springs = std::isfinite(end.contact_energy) ? end.contact_energy : 0;
      const double stored = end.strain_energy + springs;
      const double scale = std::max(std::abs(end.tool_work), std::abs(stored));
      // A measured path has no stored energy to compare with.
      if (!(scale > 0) || !std::isfinite(stored)) continue;
      balances.push_back(
          {site.vertex, path.kind, end.tool_work, stored, (end.tool_work - stored) / scale});
    }
  }
  return balances;
}

CampaignFigures campaign_figures(const Curves& curves) {
  CampaignFigures figures;
  for (const SiteCurves& site : curves.sites) {
    if (site.status == SiteStatus::Complete) ++figures.complete;
    if (site.status == SiteStatus::Partial) ++figures.partial;
    if (site.status == SiteStatus::Failed) ++figures.failed;
    figures.cpu_seconds += site.cpu_seconds;
    for (const CurvePath& path : site.paths) {
      for (const CurveSample& sample : path.samples) {
        if (path.kind == PathKind::Normal)
          figures.deepest = std::max(figures.deepest, sample.displacement);
        figures.max_force = std::max(figures.max_force, norm(sample.force));
        figures.min_jacobian = std::fmin(figures.min_jacobian, sample.min_jacobian);
        if (std::isnan(figures.volume_change) ||
            std::abs(sample.volume_change) > std::abs(figures.volume_change))
          figures.volume_change = sample.volume_change;
      }
    }
  }
  return figures;
}

double percentile(std::vector<double>& values, double fraction) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(fitting::nearest_rank(values.size(), fraction));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

double median_edge(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<double> lengths;
  for (const auto& [a, b] : edges_of(triangles))
    lengths.push_back(
        norm(points[static_cast<std::size_t>(a)] - points[static_cast<std::size_t>(b)]));
  return percentile(lengths, 0.5);
}

}  // namespace palpate::report
