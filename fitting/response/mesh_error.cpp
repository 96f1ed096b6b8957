// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/mesh_error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "format/to_index.hpp"

namespace palpate::fitting {

namespace {

/// Least force that errors are relative to, over the largest of the path.
constexpr double kLeastForce = 0.01;
/// The resolution of a contact that no quadrature point feels.
constexpr double kLeastFacets = 0.01;

double largest_force(const CurvePath& path) {
  double largest = 0;
  for (const CurveSample& sample : path.samples)
    largest = std::max(largest, std::abs(response_force(path, sample)));
  return largest;
}

/// N, what the errors of a sample are relative to.
double scale_of(const CurvePath& path, const CurveSample& sample, double largest) {
  return std::max(std::abs(response_force(path, sample)), kLeastForce * largest);
}

/// A relative error, and the resolution of the contact that it belongs to.
struct Difference {
  double resolution, relative;
};

double resolution_of(const CurveSample& sample) {
  return std::log(std::max(kLeastFacets, sample.facets_in_contact));
}

using IsChosen = std::function<bool(const SiteCurves&)>;

std::vector<Difference> differences(const Curves& curves, PathKind kind, const IsChosen& chosen) {
  std::vector<Difference> found;
  for (const SiteCurves& site : curves.sites)
    for (const CurvePath& path : site.paths) {
      if (path.kind != kind || !chosen(site)) continue;
      const double largest = largest_force(path);
      for (const CurveSample& sample : path.samples)
        if (!std::isnan(sample.mesh_difference) && largest > 0)
          found.push_back({resolution_of(sample),
                           std::abs(sample.mesh_difference) / scale_of(path, sample, largest)});
    }
  return found;
}

/// The largest of the differences that are nearest in resolution.
double bound_at(double resolution, std::vector<Difference>& all) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(kDifferencesOfBound, all.size()));
  std::nth_element(all.begin(), all.begin() + count - 1, all.end(),
                   [&](const Difference& a, const Difference& b) {
                     return std::abs(a.resolution - resolution) <
                            std::abs(b.resolution - resolution);
                   });
  double largest = 0;
  for (auto d = all.begin(); d != all.begin() + count; ++d)
    largest = std::max(largest, d->relative);
  return largest;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The bounds of the paths of one kind at the chosen sites. @return their confidence; NaN where
/// they stay unknown or there is no such path.
double bound_paths(Curves& curves, PathKind kind, const IsChosen& chosen) {
  std::vector<Difference> all = differences(curves, kind, chosen);
  const auto count = static_cast<double>(std::min(kDifferencesOfBound, all.size()));
  if (all.empty()) all = differences(curves, kind, [](const SiteCurves&) { return true; });
  if (all.empty()) return kUnknown;
  bool any = false;
  for (SiteCurves& site : curves.sites)
    for (CurvePath& path : site.paths) {
      if (path.kind != kind || !chosen(site)) continue;
      any = true;
      const double largest = largest_force(path);
      for (std::size_t i = 0; i < path.samples.size(); ++i) {
        CurveSample& sample = path.samples[i];
        sample.mesh_error =
            i == 0 ? 0 : bound_at(resolution_of(sample), all) * scale_of(path, sample, largest);
      }
    }
  return any ? count / (count + 1) : kUnknown;
}

}  // namespace

void bound_mesh_errors(Curves& curves, const std::vector<bool>& at_edge) {
  curves.mesh_error_confidence = kUnknown;
  for (const bool edge : {false, true}) {
    const auto chosen = [&](const SiteCurves& site) {
      return (!at_edge.empty() && at_edge[to_index(site.vertex)]) == edge;
    };
    for (const PathKind kind : {PathKind::Normal, PathKind::Lateral})
      curves.mesh_error_confidence =
          std::fmin(curves.mesh_error_confidence, bound_paths(curves, kind, chosen));
  }
}

MeshErrorSummary mesh_error_summary(const Curves& curves, PathKind kind) {
  std::vector<double> at_end, at_first;
  for (const SiteCurves& site : curves.sites)
    for (const CurvePath& path : site.paths) {
      if (path.kind != kind || path.samples.size() < 2) continue;
      const double largest = largest_force(path);
      const auto relative = [&](const CurveSample& sample) {
        return sample.mesh_error / scale_of(path, sample, largest);
      };
      if (!(largest > 0) || std::isnan(path.samples.back().mesh_error)) continue;
      at_end.push_back(relative(path.samples.back()));
      at_first.push_back(relative(path.samples[1]));
    }
  if (at_end.empty()) return {};
  return {median_of(at_end), *std::max_element(at_end.begin(), at_end.end()), median_of(at_first),
          *std::max_element(at_first.begin(), at_first.end())};
}

}  // namespace palpate::fitting
