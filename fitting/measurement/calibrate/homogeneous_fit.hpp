// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of a law from tests in homogeneous deformations, alone or several together.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/measurement/calibrate/energies.hpp"
#include "fitting/measurement/calibrate/homogeneous.hpp"
#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {

/// Names of the laws that can be fitted: "neo-hookean", "mooney-rivlin", "yeoh", "ogden-1",
/// "ogden-2", "ogden-3", "demiray-fung", "veronda-westmann", "gent", "arruda-boyce".
std::vector<std::string_view> homogeneous_laws();

/// The constants of a law with their default bounds; the starts are for a modulus of `scale`, Pa.
/// @throws Error(Configuration) for an unknown law.
std::vector<ConstantInfo> constants_of(std::string_view law, double scale);

/// One test: stress over deformation, both as measured.
struct HomogeneousTest {
  std::string name;
  Mode mode = Mode::Uniaxial;
  std::vector<double> deformation;    ///< stretch, or amount of shear
  std::vector<double> nominal;        ///< Pa
  std::vector<double> uncertainty{};  ///< Pa, standard, of the nominal stress; empty: unknown
  double weight = 1;                  ///< of its residuals
};

enum class Weighting {
  Absolute,    ///< residuals in Pa: large stresses decide
  PerTest,     ///< over the root mean square stress of the test: tests count alike
  Relative,    ///< over the stress itself, at least 5 % of the largest of its test
  Uncertainty  ///< over the stated standard uncertainty
};

enum class Residual { Nominal, Cauchy };  ///< the stress in which misfit is measured

struct HomogeneousSettings {
  std::string law;
  Weighting weighting = Weighting::PerTest;
  Residual residual = Residual::Nominal;
  double confidence = 0.95;
  bool profiles = false;                ///< intervals by profile likelihoods as well
  std::vector<ConstantInfo> constants;  ///< starts and bounds in place of the defaults, by name
};

/// How well the law meets one test, in nominal stress.
struct TestError {
  std::string name;
  double rms = 0;       ///< Pa
  double relative = 0;  ///< rms over the root mean square of the measured stress
  double r2 = 0;        ///< 1 - residual over total sum of squares
  double worst = 0;     ///< Pa, largest error
  double worst_at = 0;  ///< deformation there
};

/// Where the law stops resisting: the first deformation, going away from rest within the range,
/// with a tangent that is not positive.
struct StabilityLimit {
  Mode mode = Mode::Uniaxial;
  double low = 0, high = 0;  ///< range that was looked at
  double unstable_at = 0;    ///< NaN when none
};

/// The same over all states whose principal logarithmic strains stay within the largest of the
/// tests: what a body in contact goes through is none of the modes of a test.
struct StabilityOfStates {
  double largest_strain = 0;  ///< logarithmic
  /// Principal stretches of the unstable state of least strain; NaN when there is none.
  std::array<double, 3> unstable_at{};
};

struct HomogeneousFit {
  Calibration calibration;
  double shear_modulus = 0;  ///< Pa, at rest
  std::vector<TestError> errors;
  std::vector<StabilityLimit> stability;
  StabilityOfStates all_states;
  std::vector<std::vector<double>> predicted;  ///< nominal stress at the points of each test, Pa
};

/// Joint least squares over all tests. Starts are scaled to the data; laws with several minima
/// (Ogden) are started from several exponents, and the best is kept.
/// @throws Error(Configuration) for an unknown law, no data, a stretch that is not positive.
HomogeneousFit fit_homogeneous(const std::vector<HomogeneousTest>& tests,
                               const HomogeneousSettings& settings);

/// Nominal stress of a law at given constants, Pa.
double law_stress(std::string_view law, const std::vector<double>& constants, Mode mode, double s);

/// Smaller eigenvalue of the tangent, Pa; see least_tangent.
double law_tangent(std::string_view law, const std::vector<double>& constants, Mode mode, double s);

}  // namespace palpate::calibrate
