// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/clamped_fit.hpp"

#include <algorithm>
#include <cmath>

#include "format/error.hpp"

namespace palpate::app {
namespace {

constexpr int kPoints = 4;  ///< stretches that are computed to either side of rest
constexpr int kMostRounds = 12;
constexpr double kSettled = 2e-4;  ///< change of a ratio

/// Evenly spaced from rest to `end`, without rest; nothing where the test does not go there.
std::vector<double> points_to(double end) {
  constexpr double kNone = 1e-6;
  std::vector<double> points;
  for (int i = 1; i <= kPoints && std::abs(end - 1) > kNone; ++i)
    points.push_back(1 + (end - 1) * i / kPoints);
  return points;
}

double formula(const fem::LawConstants& law, calibrate::Mode mode, double stretch) {
  std::vector<double> constants;
  const calibrate::IncompressibleLaw incompressible(law.law, law.at("poisson"));
  for (const fem::LawConstant& constant : incompressible.constants())
    constants.push_back(law.at(constant.name));
  return incompressible.stress(constants.data(), mode, stretch);
}

using Effects = std::vector<std::optional<ClampEffect>>;

Effects effects_of(const std::vector<calibrate::HomogeneousTest>& tests,
                   const std::vector<std::optional<fem::ClampedSpecimen>>& specimens,
                   const fem::LawConstants& law) {
  Effects effects(tests.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (!specimens[i]) continue;
    fem::ClampedSpecimen specimen = *specimens[i];
    specimen.law = law;
    effects[i].emplace(specimen, tests[i].mode, tests[i].deformation);
  }
  return effects;
}

double ratio_at(const std::optional<ClampEffect>& effect, double stretch) {
  return effect ? effect->at(stretch) : 1;
}

std::vector<calibrate::HomogeneousTest> with(std::vector<calibrate::HomogeneousTest> tests,
                                             const Effects& effects) {
  for (std::size_t i = 0; i < tests.size(); ++i)
    for (std::size_t k = 0; effects[i] && k < tests[i].deformation.size(); ++k)
      tests[i].effect.push_back(effects[i]->at(tests[i].deformation[k]));
  return tests;
}

double change(const std::vector<calibrate::HomogeneousTest>& tests, const Effects& before,
              const Effects& after) {
  double largest = 0;
  for (std::size_t i = 0; i < tests.size(); ++i)
    for (const double stretch : tests[i].deformation)
      largest = std::max(largest,
                         std::abs(ratio_at(after[i], stretch) / ratio_at(before[i], stretch) - 1));
  return largest;
}

void check(const std::vector<calibrate::HomogeneousTest>& tests,
           const std::vector<std::optional<fem::ClampedSpecimen>>& specimens) {
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (!specimens[i]) continue;
    if (tests[i].mode != calibrate::Mode::Uniaxial && tests[i].mode != calibrate::Mode::PureShear)
      refuse(tests[i].name, "a clamped specimen is pulled or pressed along one axis",
             "choose the mode uniaxial or pure shear");
    if (tests[i].offset)
      refuse(tests[i].name, "an offset is not fitted to a clamped specimen", "leave `offset` out");
  }
}

}  // namespace

ClampEffect::ClampEffect(const fem::ClampedSpecimen& specimen, calibrate::Mode mode,
                         const std::vector<double>& stretches) {
  const auto [low, high] = std::minmax_element(stretches.begin(), stretches.end());
  for (const double end : {std::min(1.0, *low), std::max(1.0, *high)}) {
    const std::vector<double> points = points_to(end);
    if (points.empty()) continue;
    const std::vector<double> stress = fem::clamped_stress(specimen, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double ratio = stress[i] / formula(specimen.law, mode, points[i]);
      const auto at = std::lower_bound(stretch_.begin(), stretch_.end(), points[i]);
      ratio_.insert(ratio_.begin() + (at - stretch_.begin()), ratio);
      stretch_.insert(at, points[i]);
    }
  }
}

/// The polynomial of degree three through the nearest points, constant beyond the ends.
double ClampEffect::at(double stretch) const {
  if (stretch_.empty()) return 1;
  const auto count = static_cast<std::ptrdiff_t>(stretch_.size());
  // Only the points on the same side of rest: the ratio may jump there with the sign of the load.
  std::ptrdiff_t begin = 0, end = count;
  const auto rest = std::lower_bound(stretch_.begin(), stretch_.end(), 1.0) - stretch_.begin();
  if (stretch >= 1 && rest < count) begin = rest;
  if (stretch < 1 && rest > 0) end = rest;
  const double x = std::clamp(stretch, stretch_[static_cast<std::size_t>(begin)],
                              stretch_[static_cast<std::size_t>(end - 1)]);
  double sum = 0;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    double basis = 1;
    for (std::ptrdiff_t j = begin; j < end; ++j) {
      const double xi = stretch_[static_cast<std::size_t>(i)];
      const double xj = stretch_[static_cast<std::size_t>(j)];
      if (i != j) basis *= (x - xj) / (xi - xj);
    }
    sum += basis * ratio_[static_cast<std::size_t>(i)];
  }
  return sum;
}

ClampedFit fit_clamped(const std::vector<calibrate::HomogeneousTest>& tests,
                       const std::vector<std::optional<fem::ClampedSpecimen>>& specimens,
                       const calibrate::HomogeneousSettings& settings) {
  check(tests, specimens);
  ClampedFit result;
  Effects effects(tests.size());
  calibrate::HomogeneousSettings quick = settings;
  quick.profiles = false;
  const auto is_clamped = [](const auto& specimen) { return specimen.has_value(); };
  bool settled = std::none_of(specimens.begin(), specimens.end(), is_clamped);
  while (!settled) {
    if (++result.rounds > kMostRounds)
      refuse("fit of " + settings.law, "the effect of the clamps does not settle",
             "use a smaller range of the record, or a law with fewer constants");
    const auto fit = calibrate::fit_homogeneous(with(tests, effects), quick);
    Effects next = effects_of(tests, specimens, fit.law);
    settled = change(tests, effects, next) < kSettled;
    effects = std::move(next);
  }
  result.fit = calibrate::fit_homogeneous(with(tests, effects), settings);
  for (std::string& warning : result.fit.calibration.warnings)
    if (result.rounds > 0 && warning.starts_with("another set of constants"))
      warning += "; it was not computed between clamps";
  for (std::size_t i = 0; i < tests.size(); ++i) {
    double& largest = result.largest_effect.emplace_back(0);
    for (const double stretch : tests[i].deformation)
      largest = std::max(largest, std::abs(ratio_at(effects[i], stretch) - 1));
  }
  return result;
}

}  // namespace palpate::app
