// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/site_samples.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::fitting {
namespace {

/// Relative distance below which two displacements differ only by rounding.
constexpr double kSamePlace = 1e-9;
/// Unit vectors whose difference is shorter are one direction.
constexpr double kSameDirection = 1e-6;

/// J, what body and contact have stored; NaN when unknown.
double stored(const CurveSample& sample) {
  return sample.strain_energy + sample.contact_energy;
}

/// Where body and contact store less of the work of the tool than this fraction, a part of the body
/// has snapped on the way, and the rest of the work is lost.
constexpr double kStoredOfWork = 0.8;

bool snapped(const CurveSample& before, const CurveSample& here) {
  const double work = here.tool_work - before.tool_work;
  return stored(here) - stored(before) < kStoredOfWork * work;
}

/// The samples of a path beyond its start, with the mean of the force since the sample before: the
/// tool does the work that body and contact store. It is unknown where a part of the body snaps.
std::vector<ForceSample> samples_of(const CurvePath& path) {
  std::vector<ForceSample> samples;
  const CurveSample* before = nullptr;
  for (const CurveSample& here : path.samples) {
    if (here.displacement > 0) {
      ForceSample sample{here.displacement, response_force(path, here)};
      if (before != nullptr && here.displacement > before->displacement &&
          !snapped(*before, here)) {
        sample.since = before->displacement;
        const double force =
            (stored(here) - stored(*before)) / (here.displacement - before->displacement);
        // Less the force of the start, as response_force.
        sample.mean = force - (dot(here.force, path.direction) - sample.force);
      }
      samples.push_back(sample);
    }
    before = &here;
  }
  return samples;
}

/// The mean of the force of a path from one displacement to another, if there is a sample that
/// knows it; else NaN.
double mean_between(const std::vector<ForceSample>& path, double low, double high) {
  for (const ForceSample& sample : path)
    if (std::abs(sample.displacement - high) <= kSamePlace * high &&
        std::abs(sample.since - low) <= kSamePlace * high)
      return sample.mean;
  return std::numeric_limits<double>::quiet_NaN();
}

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
    const std::vector<ForceSample> more = samples_of(path);
    samples.insert(samples.end(), more.begin(), more.end());
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

std::vector<double> lateral_depths(const SiteCurves& site) {
  std::vector<double> depths;
  for (const CurvePath& path : site.paths) {
    if (path.kind == PathKind::Lateral && path.lateral_depth > 0)
      depths.push_back(path.lateral_depth);
  }
  std::sort(depths.begin(), depths.end());
  const auto same = [](double a, double b) { return b - a <= kSamePlace * b; };
  depths.erase(std::unique(depths.begin(), depths.end(), same), depths.end());
  return depths;
}

SiteCurves paths_at(const SiteCurves& site, double lateral_depth) {
  SiteCurves there;
  for (const CurvePath& path : site.paths)
    if (path.kind == PathKind::Lateral &&
        std::abs(path.lateral_depth - lateral_depth) <= kSamePlace * lateral_depth)
      there.paths.push_back(path);
  return there;
}

SiteCurves at_every_depth(const SiteCurves& site) {
  const std::vector<double> depths = lateral_depths(site);
  const auto recurs = [&](const CurvePath& path) {
    return std::all_of(depths.begin(), depths.end(), [&](double depth) {
      const SiteCurves there = paths_at(site, depth);
      return std::any_of(there.paths.begin(), there.paths.end(), [&](const CurvePath& other) {
        return norm(other.direction - path.direction) < kSameDirection;
      });
    });
  };
  SiteCurves recurring;
  for (const CurvePath& path : site.paths)
    if (path.kind == PathKind::Lateral && recurs(path)) recurring.paths.push_back(path);
  return recurring.paths.empty() ? site : recurring;
}

std::vector<std::vector<ForceSample>> lateral_paths(const SiteCurves& site) {
  std::vector<std::vector<ForceSample>> paths;
  for (const CurvePath& path : site.paths) {
    if (path.kind != PathKind::Lateral) continue;
    std::vector<ForceSample> samples = samples_of(path);
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
  const auto same = [](double a, double b) { return b - a <= kSamePlace * b; };
  displacements.erase(std::unique(displacements.begin(), displacements.end(), same),
                      displacements.end());
  std::vector<ForceSample> mean;
  ForceSample last{0, 0};
  for (const double d : displacements) {
    double rise = 0, mean_rise = 0;  // both since the last displacement
    int count = 0;
    for (const auto& path : paths) {
      if (path.back().displacement < (1 - kSamePlace) * d) continue;
      const double before = interpolate(path, last.displacement);
      rise += interpolate(path, d) - before;
      mean_rise += mean_between(path, last.displacement, d) - before;
      ++count;
    }
    last = {d, last.force + rise / count, last.force + mean_rise / count, last.displacement};
    mean.push_back(last);
  }
  return mean;
}

}  // namespace palpate::fitting
