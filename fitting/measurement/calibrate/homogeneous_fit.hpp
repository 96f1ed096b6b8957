// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of a law from tests in homogeneous deformations, alone or several together.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"
#include "fitting/measurement/calibrate/stability.hpp"
#include "fitting/measurement/calibrate/starts.hpp"

namespace palpate::calibrate {

/// One test: stress over deformation, both as measured.
struct HomogeneousTest {
  std::string name;
  Mode mode = Mode::Uniaxial;
  std::vector<double> deformation;    ///< stretch, or amount of shear
  std::vector<double> nominal;        ///< Pa
  std::vector<double> uncertainty{};  ///< Pa, standard, of the nominal stress; empty: unknown
  double weight = 1;                  ///< of its residuals, beside that of the weighting
  bool offset = false;  ///< whether a constant stress, an error of the zero, is fitted as well
  /// What the law's stress is multiplied by, for each sample, where the specimen is not
  /// homogeneous; empty: it is. Such a test has no offset.
  std::vector<double> effect{};
};

enum class Weighting {
  Absolute,  ///< residuals in Pa: large stresses decide
  PerTest,   ///< over root mean square stress and root of the number of samples: tests count alike
  Relative,  ///< over the stress itself, at least 5 % of the largest of its test
  Uncertainty  ///< over the stated standard uncertainty
};

enum class Residual { Nominal, Cauchy };  ///< the stress in which misfit is measured

struct HomogeneousSettings {
  std::string law;
  Weighting weighting = Weighting::PerTest;
  Residual residual = Residual::Nominal;
  double poisson = kCasePoisson;  ///< of the case that receives the constants; not fitted
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

struct HomogeneousFit {
  Calibration calibration;
  fem::LawConstants law;     ///< as a case declares it, Poisson's ratio included
  double shear_modulus = 0;  ///< Pa, at rest
  std::vector<TestError> errors;
  std::vector<StabilityLimit> stability;
  StabilityOfStates all_states;
  /// Nominal stress at the points of each test, Pa, with its offset.
  std::vector<std::vector<double>> predicted;
};

/// Joint least squares over all tests. Starts follow from the data (scan.hpp). The bounds first
/// make the law stable in every deformation; where one of them holds the fit, constants within the
/// table of laws are taken that fit better and are stable in Drucker's sense in the range of every
/// test.
/// @throws Error(Configuration) for a law that is unknown or cannot be calibrated from such tests,
///   no data, a stretch that is not positive, a fit that does not converge or explains nothing,
///   constants that a case refuses.
HomogeneousFit fit_homogeneous(const std::vector<HomogeneousTest>& tests,
                               const HomogeneousSettings& settings);

}  // namespace palpate::calibrate
