// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/mean_response.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fitting/response/couple.hpp"
#include "fitting/response/curve_fit.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

struct WeightedCurve {
  runtime::CompiledCurve curve;
  double weight = 0;
};
using CurveList = std::vector<WeightedCurve>;

template <class Curve>
CurveList curves_of(const std::vector<WeightedResponse>& sources, Curve curve) {
  CurveList list;
  for (const WeightedResponse& source : sources)
    list.push_back({runtime::CompiledCurve(curve(*source.response)), source.weight});
  return list;
}

double mean_force(const CurveList& curves, double d) {
  double sum = 0;
  for (const auto& [curve, weight] : curves) sum += weight * curve.force(d);
  return sum;
}

/// The curve with the largest weight; the first of equal ones.
const WeightedCurve& heaviest(const CurveList& curves) {
  return *std::max_element(
      curves.begin(), curves.end(),
      [](const WeightedCurve& a, const WeightedCurve& b) { return a.weight < b.weight; });
}

/// Samples in each piece of the heaviest curve. The others belong to the same body and tool and are
/// as smooth.
std::vector<ForceSample> mean_samples(const CurveList& curves) {
  constexpr int kPerPiece = 4;
  const auto& pieces = heaviest(curves).curve.pieces();
  std::vector<ForceSample> samples;
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const double low = pieces[k].start, high = pieces[k + 1].start;
    for (int i = 1; i <= kPerPiece; ++i) {
      const double d = low + (high - low) * i / kPerPiece;
      samples.push_back({d, mean_force(curves, d)});
    }
  }
  return samples;
}

bool within_tolerance(const ResponseCurve& curve, const std::vector<ForceSample>& samples,
                      const CurveFitSettings& settings) {
  const runtime::CompiledCurve rendered(curve);
  return std::all_of(samples.begin(), samples.end(), [&](const ForceSample& sample) {
    const double allowed =
        std::max(settings.relative_tolerance * std::abs(sample.force), settings.absolute_tolerance);
    return std::abs(rendered.force(sample.displacement) - sample.force) <= allowed;
  });
}

/// On the knots of the heaviest curve if that is within tolerance, else on knots of its own.
ResponseCurve mean_curve(const CurveList& curves, const CurveFitSettings& given,
                         const std::string& where) {
  const std::vector<ForceSample> samples = mean_samples(curves);
  const CurveFitSettings settings = settled(given, samples);
  std::vector<double> knots;
  for (const auto& piece : heaviest(curves).curve.pieces()) knots.push_back(piece.start);
  ResponseCurve curve;
  curve.knot.assign(knots.begin(), knots.end());
  const std::vector<double> slopes = fit_slopes(samples, knots, settings);
  curve.slope.assign(slopes.begin(), slopes.end());
  return within_tolerance(curve, samples, settings) ? curve
                                                    : fit_curve(samples, settings, where).curve;
}

CouplingCurve mean_coupling(const std::vector<WeightedResponse>& sources, CurveFitSettings settings,
                            const std::string& where) {
  CouplingCurve mean;
  double base = 0;
  for (const WeightedResponse& source : sources)
    base += source.weight * static_cast<double>(source.response->coupling.base);
  mean.base = static_cast<float>(std::max(0.0, base));
  settings.zero_first_slope = true;
  settings.absolute_tolerance = settings.relative_tolerance;  // of w, which is about 1
  const auto curves = curves_of(sources, [](const NodeResponse& r) { return r.coupling.curve; });
  mean.curve = mean_curve(curves, settings, where);
  level_off(mean);
  return mean;
}

double largest_difference(const ResponseCurve& a, const ResponseCurve& b) {
  const CurveList both{{runtime::CompiledCurve(a), 1}, {runtime::CompiledCurve(b), -1}};
  double largest = 0;
  for (const ForceSample& difference : mean_samples(both))
    largest = std::max(largest, std::abs(difference.force));
  return largest;
}

}  // namespace

namespace {

/// The weighted mean of the fractions that relax, kept where a model allows them: not negative, and
/// below 1 in sum.
std::vector<float> mean_relaxation(const std::vector<WeightedResponse>& sources) {
  constexpr double kMostRelaxed = 0.999;
  std::vector<double> mean(sources.empty() ? 0 : sources.front().response->relaxation.size());
  for (const WeightedResponse& source : sources)
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += source.weight * static_cast<double>(source.response->relaxation[i]);
  double sum = 0;
  for (double& fraction : mean) sum += fraction = std::max(fraction, 0.0);
  const double factor = sum > kMostRelaxed ? kMostRelaxed / sum : 1;
  std::vector<float> fractions;
  for (const double fraction : mean) fractions.push_back(static_cast<float>(factor * fraction));
  return fractions;
}

/// Leans are shorter than the longest one: that of a weighted mean may not be.
std::array<float, 3> mean_lean(const std::vector<WeightedResponse>& sources) {
  Vec3 mean{};
  double longest = 0;
  for (const WeightedResponse& source : sources) {
    const Vec3 lean = vec3_of(source.response->lean);
    mean = mean + source.weight * lean;
    longest = std::max(longest, norm(lean));
  }
  const double length = norm(mean);
  if (length > longest) mean = (longest / length) * mean;
  return {static_cast<float>(mean[0]), static_cast<float>(mean[1]), static_cast<float>(mean[2])};
}

/// B of the mean is the mean of the b b^T, of which the longer axis is kept; it is not longer than
/// the longest b.
std::array<float, 3> mean_soft_axis(const std::vector<WeightedResponse>& sources) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double longest = 0;
  for (const WeightedResponse& source : sources) {
    const Vec3 b = vec3_of(source.response->soft_axis);
    const Eigen::Map<const Eigen::Vector3d> axis(b.data());
    mean += source.weight * axis * axis.transpose();
    longest = std::max(longest, norm(b));
  }
  if (longest == 0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(mean);
  // Weights may be negative, and so may be the mean.
  const double length = std::min(std::sqrt(std::max(0.0, eigen.eigenvalues()[2])), longest);
  const Eigen::Vector3f b = (length * eigen.eigenvectors().col(2)).cast<float>();
  return {b[0], b[1], b[2]};
}

}  // namespace

NodeResponse mean_response(const std::vector<WeightedResponse>& sources,
                           const FitSettings& settings, const std::string& where) {
  CurveFitSettings curve{settings.relative_tolerance, settings.absolute_tolerance,
                         settings.max_knots, true};
  NodeResponse response;
  response.status = ResponseStatus::Interpolated;
  const auto normal = curves_of(sources, [](const NodeResponse& r) { return r.normal; });
  response.normal = mean_curve(normal, curve, where);
  curve.zero_first_slope = false;
  const auto lateral = curves_of(sources, [](const NodeResponse& r) { return r.lateral; });
  response.lateral = mean_curve(lateral, curve, where);
  if (settings.kind == ResponseKind::Coupled)
    response.coupling = mean_coupling(sources, curve, where);
  response.relaxation = mean_relaxation(sources);
  response.lean = mean_lean(sources);
  response.soft_axis = mean_soft_axis(sources);
  for (const auto error : {&NodeResponse::normal_mesh_error, &NodeResponse::lateral_mesh_error})
    for (const WeightedResponse& source : sources)
      response.*error = std::fmax(response.*error, source.response->*error);
  return response;
}

ResponseDifference largest_difference(const NodeResponse& a, const NodeResponse& b) {
  return {largest_difference(a.normal, b.normal), largest_difference(a.lateral, b.lateral)};
}

}  // namespace palpate::fitting
