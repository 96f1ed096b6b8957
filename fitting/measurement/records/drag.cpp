// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/drag.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fitting/measurement/records/cycles.hpp"
#include "fitting/measurement/records/repeats.hpp"
#include "fitting/measurement/records/statistics.hpp"

namespace palpate::measured {
namespace {

constexpr double kSlipSlope = 0.2;  ///< of the first lateral stiffness
constexpr double kSameDepth = 0.1;
constexpr double kSameDirection = 0.985;  ///< cosine of 10 degrees

std::vector<double> even_steps(double end, int steps) {
  std::vector<double> grid;
  for (int i = 0; i <= steps; ++i) grid.push_back(end * i / steps);
  return grid;
}

/// The force along one axis over the travel.
GriddedPress along(const DragCurve& drag, const Vec3& axis, const std::vector<double>& grid,
                   const std::string& where) {
  std::vector<DepthForce> branch;
  std::vector<double> force;
  for (std::size_t i = 0; i < drag.travel.size(); ++i) {
    force.push_back(dot(drag.force[i], axis));
    branch.push_back({drag.travel[i], force.back()});
  }
  return on_grid(branch, grid, where, noise_of(force));
}

/// Stiffness along the travel at each grid step, to see the slip.
std::size_t slip_step(const std::vector<double>& force, double step) {
  double first = 0;
  for (std::size_t i = 1; i < force.size(); ++i) {
    const double slope = (force[i] - force[i - 1]) / step;
    if (i <= 2) {
      first = std::max(first, slope);
    } else if (slope < kSlipSlope * first) {
      return i;
    }
  }
  return force.size();
}

bool repeat_each_other(const DragCurve& a, const DragCurve& b) {
  return std::abs(a.lateral_depth - b.lateral_depth) <=
             kSameDepth * std::max(a.lateral_depth, b.lateral_depth) &&
         dot(a.direction, b.direction) >= kSameDirection;
}

std::vector<std::vector<DragCurve>> groups_of(const std::vector<DragCurve>& drags) {
  std::vector<std::vector<DragCurve>> groups;
  for (const DragCurve& drag : drags) {
    const auto same = [&](const auto& group) { return repeat_each_other(group.front(), drag); };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end()) {
      groups.push_back({drag});
    } else {
      found->push_back(drag);
    }
  }
  return groups;
}

/// Lateral depth, direction and uncertainty of the depth, of the mean of a group.
CurvePath frame_of(const std::vector<DragCurve>& group, const Vec3& inward) {
  const double n = static_cast<double>(group.size());
  CurvePath path;
  path.kind = PathKind::Lateral;
  path.repeats = static_cast<std::int32_t>(group.size());
  Vec3 way{};
  double squares = 0;
  for (const DragCurve& drag : group) {
    path.lateral_depth += drag.lateral_depth / n;
    way = way + drag.direction;
    squares += drag.contact_uncertainty * drag.contact_uncertainty;
  }
  const Vec3 tangent = way - dot(way, inward) * inward;
  path.direction = (1 / norm(tangent)) * tangent;
  path.contact_uncertainty = std::sqrt(squares) / n;
  return path;
}

/// The standard uncertainty of the mean of `forces`, of which each has its own variance.
double uncertainty_of(const std::vector<double>& forces, double own_variance, double calibration) {
  const double scatter = deviation(forces), f = mean(forces);
  const double n = static_cast<double>(forces.size());
  return std::sqrt(std::max(scatter * scatter, own_variance) / n +
                   calibration * calibration * f * f);
}

CurvePath mean_of(const std::vector<DragCurve>& group, const Vec3& inward,
                  const DragSettings& settings, const std::string& where) {
  CurvePath path = frame_of(group, inward);
  double reach = group.front().travel.back(), work = 0;
  for (const DragCurve& drag : group) {
    reach = std::min(reach, drag.travel.back());
    work += drag.work_before / static_cast<double>(group.size());
  }
  const std::vector<double> grid = even_steps(reach, settings.samples);
  // Along the path, and the three axes.
  const std::array<Vec3, 4> axes{path.direction, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  std::array<std::vector<GriddedPress>, 4> parts;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (const DragCurve& drag : group) parts[axis].push_back(along(drag, axes[axis], grid, where));
  }
  double last = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::array<std::vector<double>, 4> forces;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      for (const GriddedPress& part : parts[axis]) forces[axis].push_back(part.force[i]);
    }
    double own = 0;
    for (std::size_t r = 0; r < group.size(); ++r) {
      const double of_depth =
          forces[0][r] * group[r].contact_uncertainty / (2 * group[r].lateral_depth);
      const double noise = parts[0][r].uncertainty[i];
      own += (noise * noise + of_depth * of_depth) / static_cast<double>(group.size());
    }
    CurveSample sample = measured_sample();
    sample.displacement = grid[i];
    sample.force = {mean(forces[1]), mean(forces[2]), mean(forces[3])};
    sample.force_scatter = group.size() > 1 ? deviation(forces[0]) : kUnknown;
    sample.force_uncertainty = uncertainty_of(forces[0], own, settings.force_calibration);
    const double now = mean(forces[0]);
    if (i > 0) work += 0.5 * (now + last) * (grid[i] - grid[i - 1]);
    sample.tool_work = work;
    last = now;
    path.samples.push_back(sample);
  }
  return path;
}

}  // namespace

bool cut_at_slip(DragCurve& drag, int steps, const std::string& where) {
  const std::vector<double> grid = even_steps(drag.travel.back(), steps);
  const std::size_t count = slip_step(along(drag, drag.direction, grid, where).force, grid[1]);
  if (count < grid.size()) drag.slip = grid[count - 1];
  const auto end = std::upper_bound(drag.travel.begin(), drag.travel.end(), grid[count - 1]);
  drag.force.resize(static_cast<std::size_t>(end - drag.travel.begin()));
  drag.travel.erase(end, drag.travel.end());
  return count >= 3;
}

std::vector<CurvePath> lateral_paths(const std::vector<DragCurve>& drags, const Vec3& inward,
                                     const DragSettings& settings, const std::string& where) {
  std::vector<CurvePath> paths;
  for (const auto& group : groups_of(drags)) {
    paths.push_back(mean_of(group, inward, settings, where));
  }
  return paths;
}

}  // namespace palpate::measured
