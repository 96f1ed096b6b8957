// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/repeats.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/tangent_frame.hpp"

namespace palpate::measured {
namespace {

/// Between the reaches of presses that repeat each other.
constexpr double kLargestRatio = 5;
/// Samples of a record around a sample of the path, and samples of a path that is made coarser.
constexpr int kFewestAround = 2, kFewestSamples = 4;

double deepest(const PressCurve& press) {
  double depth = 0;
  for (const DepthForce& sample : press.loading) depth = std::max(depth, sample.depth);
  return depth;
}

/// Where the first sample of a press lies: deep, where its record begins in contact.
double shallowest(const PressCurve& press) {
  double depth = deepest(press);
  for (const DepthForce& sample : press.loading) depth = std::min(depth, sample.depth);
  return depth;
}

/// Half of the step of a grid: the samples within it belong to a depth.
double half_step(const std::vector<double>& depths) {
  return 0.5 * (depths.size() > 1 ? depths[1] - depths[0] : depths[0]);
}

bool resolves(const std::vector<PressCurve>& presses, const std::vector<double>& depths) {
  const double half = half_step(depths);
  return std::ranges::all_of(presses, [&](const PressCurve& press) {
    return std::ranges::all_of(depths, [&](double depth) {
      return std::ranges::count_if(press.loading, [&](const DepthForce& sample) {
               return std::abs(sample.depth - depth) <= half;
             }) >= kFewestAround;
    });
  });
}

/// Evenly spaced to the depth that all presses reach, from where all of them have begun. Records
/// that are too coarse for so many samples have fewer.
std::vector<double> grid_of(const std::vector<PressCurve>& presses, double reach, int samples) {
  double begin = 0;
  for (const PressCurve& press : presses) begin = std::max(begin, shallowest(press));
  const auto grid = [&](int count) {
    const double step = reach / count;
    std::vector<double> depths;
    for (int i = 1; i <= count; ++i)
      if (step * i >= std::min(begin, reach - step)) depths.push_back(step * i);
    return depths;
  };
  for (int count = samples; count >= kFewestSamples; --count)
    if (std::vector<double> depths = grid(count); resolves(presses, depths)) return depths;
  return grid(samples);
}

/// Slope of the force over the grid, by differences of neighbours.
std::vector<double> slopes(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> slope(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t a = i > 0 ? i - 1 : i, b = i + 1 < x.size() ? i + 1 : i;
    slope[i] = (y[b] - y[a]) / (x[b] - x[a]);
  }
  return slope;
}

/// Mean and scatter of the presses at one depth, with the uncertainties that belong to it.
void join(const std::vector<GriddedPress>& presses, const std::vector<PressCurve>& curves,
          std::size_t at, double slope, const RepeatSettings& settings, double& force,
          CurveSample& sample) {
  const auto n = static_cast<double>(presses.size());
  std::vector<double> forces;
  double known = 0;  // variance of one press that its own record explains
  for (std::size_t r = 0; r < presses.size(); ++r) {
    forces.push_back(presses[r].force[at]);
    const double rho = curves[r].baseline.autocorrelation, noise = presses[r].uncertainty[at];
    known += (noise * noise * (1 + rho) / (1 - rho) +
              curves[r].common.variance(presses[r].time[at], slope)) /
             n;
  }
  force = mean(forces);
  const double scatter = deviation(forces);
  sample.force_scatter = presses.size() > 1 ? scatter : kUnknown;
  const double common = std::hypot(settings.force_calibration * force,
                                   slope * force * settings.compliance_uncertainty);
  sample.force_uncertainty = std::sqrt(std::max(scatter * scatter, known) / n + common * common);
}

}  // namespace

CurveSample measured_sample() {
  CurveSample sample;
  sample.strain_energy = sample.min_jacobian = kUnknown;
  sample.penetration = sample.contact_area = kUnknown;
  return sample;
}

GriddedPress on_grid(const std::vector<DepthForce>& branch, const std::vector<double>& depths,
                     const std::string& where, double noise) {
  GriddedPress press;
  const double half = half_step(depths);
  for (const double depth : depths) {
    std::vector<double> x, f, t;
    for (const DepthForce& sample : branch) {
      if (std::abs(sample.depth - depth) > half) continue;
      t.push_back(sample.time);
      x.push_back(sample.depth - depth);
      f.push_back(sample.force);
    }
    if (x.size() < kFewestAround) {
      throw Error(ErrorKind::Configuration, where,
                  "too few samples around a depth of " + length_text(depth),
                  "keep every sample of one press with path.as_recorded = true, ask for fewer "
                  "samples of the path, or record more densely");
    }
    const LineFit line = fit_line(x, f);
    // At the end of the branch the samples lie on one side: the line, not the mean, is unbiased.
    const double centre = mean(x);
    double spread = 0;
    for (const double value : x) spread += (value - centre) * (value - centre);
    const double lever = spread > 0 ? centre * centre / spread : 0;
    press.force.push_back(line.offset);
    press.time.push_back(mean(t));
    press.uncertainty.push_back(std::max(line.residual, noise) *
                                std::sqrt(1 / static_cast<double>(x.size()) + lever));
  }
  return press;
}

CurvePath mean_path(const std::vector<PressCurve>& presses, const Vec3& inward,
                    const RepeatSettings& settings, const std::string& where) {
  double reach = deepest(presses.front()), farthest = reach;
  for (const PressCurve& press : presses) {
    reach = std::min(reach, deepest(press));
    farthest = std::max(farthest, deepest(press));
  }
  if (farthest > kLargestRatio * reach) {
    throw Error(
        ErrorKind::Configuration, where,
        "one of its presses reaches " + length_text(reach) + ", another " + length_text(farthest),
        "check their units of length; leave out a press that ended early");
  }
  const std::vector<double> depths = grid_of(presses, reach, settings.samples);
  std::vector<GriddedPress> gridded;
  for (const PressCurve& press : presses)
    gridded.push_back(on_grid(press.loading, depths, where, press.baseline.noise));

  std::vector<double> mean_force;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    double sum = 0;
    for (const GriddedPress& press : gridded) sum += press.force[i];
    mean_force.push_back(sum / static_cast<double>(gridded.size()));
  }
  const std::vector<double> slope = slopes(depths, mean_force);

  CurvePath path;
  path.kind = PathKind::Normal;
  path.direction = inward;
  path.repeats = static_cast<std::int32_t>(presses.size());
  double squares = 0;
  for (const PressCurve& press : presses) {
    squares += press.contact.uncertainty * press.contact.uncertainty;
  }
  path.contact_uncertainty = std::sqrt(squares) / static_cast<double>(presses.size());
  path.samples.push_back(measured_sample());
  path.samples.back().force_uncertainty = 0;
  double work = 0, last_force = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    CurveSample sample = measured_sample();
    double force = 0;
    join(gridded, presses, i, slope[i], settings, force, sample);
    sample.displacement = depths[i];
    sample.force = force * inward;
    work += 0.5 * (force + last_force) * (depths[i] - (i > 0 ? depths[i - 1] : 0));
    sample.tool_work = work;
    last_force = force;
    path.samples.push_back(sample);
  }
  return path;
}

CurvePath lateral_from_normal(const CurvePath& normal, double ratio) {
  const std::size_t middle = std::max<std::size_t>(1, normal.samples.size() / 2);
  const CurveSample& start = normal.samples[middle];
  const CurveSample &before = normal.samples[middle - 1],
                    &after = normal.samples[std::min(middle + 1, normal.samples.size() - 1)];
  const double stiffness = dot(after.force - before.force, normal.direction) /
                           (after.displacement - before.displacement);
  CurvePath path;
  path.kind = PathKind::Lateral;
  path.lateral_depth = start.displacement;
  path.direction = tangent_frame(normal.direction)[0];
  constexpr int steps = 4;
  for (int i = 0; i <= steps; ++i) {
    CurveSample sample = measured_sample();
    sample.displacement = 0.5 * start.displacement * i / steps;
    const double f = ratio * stiffness * sample.displacement;
    sample.force = start.force + f * path.direction;
    sample.tool_work = start.tool_work + 0.5 * f * sample.displacement;
    path.samples.push_back(sample);
  }
  return path;
}

}  // namespace palpate::measured
