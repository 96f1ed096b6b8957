// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/site_samples.hpp"

#include <algorithm>

namespace palpate::fitting {
namespace {

/// Relative distance below which two displacements differ only by rounding.
constexpr double kSame = 1e-9;

/// Force of a path at d, linear between its samples and from the origin. @pre d <= its last sample
double interpolate(const std::vector<ForceSample>& path, double d) {
  ForceSample low{0, 0};
  for (const ForceSample& high : path) {
    if (d <= high.displacement) {
      const double length = high.displacement - low.displacement;
      const double t = length > 0 ? (d - low.displacement) / length : 1;
      return low.force + t * (high.force - low.force);
    }
    low = high;
  }
  return low.force;
}

}  // namespace

std::vector<ForceSample> normal_samples(const SiteCurves& site) {
  std::vector<ForceSample> samples;
  for (const CurvePath& path : site.paths) {
    if (path.kind != PathKind::Normal) continue;
    for (const CurveSample& sample : path.samples) {
      if (sample.displacement > 0) {
        samples.push_back({sample.displacement, dot(sample.force, path.direction)});
      }
    }
  }
  return samples;
}

double normal_reach(const SiteCurves& site) {
  double reach = 0;
  for (const ForceSample& sample : normal_samples(site)) {
    reach = std::max(reach, sample.displacement);
  }
  return reach;
}

std::vector<std::vector<ForceSample>> lateral_paths(const SiteCurves& site) {
  std::vector<std::vector<ForceSample>> paths;
  for (const CurvePath& path : site.paths) {
    if (path.kind != PathKind::Lateral || path.samples.empty()) continue;
    const Vec3 first = path.samples.front().force;
    std::vector<ForceSample> samples;
    for (const CurveSample& sample : path.samples) {
      if (sample.displacement > 0) {
        samples.push_back({sample.displacement, dot(sample.force - first, path.direction)});
      }
    }
    std::sort(samples.begin(), samples.end(), [](const ForceSample& a, const ForceSample& b) {
      return a.displacement < b.displacement;
    });
    if (!samples.empty()) paths.push_back(std::move(samples));
  }
  return paths;
}

std::vector<ForceSample> mean_lateral(const std::vector<std::vector<ForceSample>>& paths) {
  std::vector<double> displacements;
  for (const auto& path : paths) {
    for (const ForceSample& sample : path) displacements.push_back(sample.displacement);
  }
  std::sort(displacements.begin(), displacements.end());
  const auto same = [](double a, double b) { return b - a <= kSame * b; };
  displacements.erase(std::unique(displacements.begin(), displacements.end(), same),
                      displacements.end());
  std::vector<ForceSample> mean;
  ForceSample last{0, 0};
  for (const double d : displacements) {
    double rise = 0;
    int count = 0;
    for (const auto& path : paths) {
      if (path.back().displacement < (1 - kSame) * d) continue;
      rise += interpolate(path, d) - interpolate(path, last.displacement);
      ++count;
    }
    last = {d, last.force + rise / count};
    mean.push_back(last);
  }
  return mean;
}

}  // namespace palpate::fitting
