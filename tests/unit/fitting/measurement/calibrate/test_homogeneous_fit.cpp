// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "format/error.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/unit/fitting/measurement/calibrate/measured_tests.hpp"
#include "tests/unit/fitting/measurement/calibrate/typical_constants.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Data in four modes determine the constants that made them.
TEST(Homogeneous, FitsRecoverTheConstantsThatMadeTheData) {
  for (const auto law : homogeneous_laws()) {
    const auto c = typical(law);
    std::vector<HomogeneousTest> tests;
    for (const Mode mode : kModes) {
      HomogeneousTest test{"synthetic", mode, {}, {}, {}, 1};
      for (int i = 1; i <= 20; ++i) {
        const double s = rest_of(mode) + 0.04 * i;
        test.deformation.push_back(s);
        test.nominal.push_back(1e4 * law_stress(law, c, mode, s));
      }
      tests.push_back(test);
    }
    HomogeneousSettings settings;
    settings.law = law;
    const HomogeneousFit fit = fit_homogeneous(tests, settings);
    for (const TestError& error : fit.errors) EXPECT_LT(error.relative, 2e-4) << law;
    if (law == "ogden-3" || law == "ogden-2") continue;  // several sets fit such data alike
    for (std::size_t i = 0; i < c.size(); ++i) {
      const Estimate& e = fit.calibration.estimates[i];
      const double wanted = e.unit == "Pa" ? 1e4 * c[i] : c[i];
      EXPECT_NEAR(e.value, wanted, 1e-3 * std::abs(wanted)) << law << " " << e.name;
    }
  }
}

/// Published fit of a blood clot in pure shear: 40 x 10 x 3 mm, Cauchy stress, unweighted.
TEST(Homogeneous, BloodClotFitIsThePublishedOne) {
  const auto table =
      measured::read_csv(test::source_folder() / "data/measured/clot-2021/pure-shear.csv");
  const auto x = measured::column_in_si(table, "displacement", Dimension::Length);
  const auto f = measured::column_in_si(table, "force", Dimension::Force);
  constexpr double height = 0.010, area = 0.040 * 0.003;
  HomogeneousTest test{"clot", Mode::PureShear, {}, {}, {}, 1};
  for (std::size_t i = 0; i < x.size(); ++i) {
    test.deformation.push_back(1 + x[i] / height);
    test.nominal.push_back(f[i] / area);
  }
  HomogeneousSettings settings;
  settings.law = "ogden-1";
  settings.weighting = Weighting::Absolute;
  settings.residual = Residual::Cauchy;
  const HomogeneousFit fit = fit_homogeneous({test}, settings);
  EXPECT_NEAR(fit.calibration.estimates[0].value, 2378.17, 0.05);
  EXPECT_NEAR(fit.calibration.estimates[1].value, 4.28007, 5e-5);
  EXPECT_NEAR(fit.errors[0].rms * area * 1e3, 9.9151, 2e-4);  // mN
  // In pure shear the stretches are s, 1, 1/s: alpha and -alpha are the same law.
  EXPECT_THAT(fit.calibration.warnings,
              Contains(HasSubstr("another set of constants fits as well")));
}

/// Three modes of Treloar's rubber. Ogden's constants were found by hand in 1972; least squares
/// must do better on the same data, and the first invariant alone (Yeoh) cannot do as well.
TEST(Homogeneous, TreloarsRubber) {
  const auto tests = three_modes("treloar-1944");
  const std::vector<double> ogden1972{0.5 * 0.63e6 * 1.3, 1.3, 0.5 * 0.0012e6 * 5, 5,
                                      0.5 * 0.01e6 * 2,   -2};
  double by_hand = 0;
  for (const HomogeneousTest& test : tests) {
    for (std::size_t i = 0; i < test.nominal.size(); ++i) {
      const double e =
          law_stress("ogden-3", ogden1972, test.mode, test.deformation[i]) - test.nominal[i];
      by_hand += e * e;
    }
  }
  HomogeneousSettings settings;
  settings.weighting = Weighting::Absolute;
  settings.law = "ogden-3";
  const HomogeneousFit ogden = fit_homogeneous(tests, settings);
  EXPECT_LT(2 * ogden.calibration.cost, by_hand);
  for (const TestError& error : ogden.errors) EXPECT_GT(error.r2, 0.985) << error.name;
  for (const StabilityLimit& limit : ogden.stability) EXPECT_TRUE(std::isnan(limit.unstable_at));
  settings.law = "yeoh";
  const HomogeneousFit yeoh = fit_homogeneous(tests, settings);
  EXPECT_GT(yeoh.calibration.cost, 1.5 * ogden.calibration.cost);
  for (const TestError& error : yeoh.errors) EXPECT_GT(error.r2, 0.9) << error.name;
  // The known signs: softening, then stiffening.
  EXPECT_LT(yeoh.calibration.estimates[1].value, 0);
  EXPECT_GT(yeoh.calibration.estimates[2].value, 0);
  settings.law = "neo-hookean";
  EXPECT_GT(fit_homogeneous(tests, settings).calibration.cost, 5 * yeoh.calibration.cost);
  EXPECT_NEAR(ogden.shear_modulus, 0.39e6, 0.08e6);  // literature: 0.37 to 0.42 MPa
}

TEST(Homogeneous, SiliconeInThreeModes) {
  HomogeneousSettings settings;
  settings.law = "yeoh";
  const HomogeneousFit fit = fit_homogeneous(three_modes("meunier-2008"), settings);
  for (const TestError& error : fit.errors) EXPECT_GT(error.r2, 0.97) << error.name;
}

/// Brain is stiffer in compression than in tension: only a negative exponent can say so.
TEST(Homogeneous, BrainNeedsANegativeExponent) {
  const std::vector<HomogeneousTest> tests{
      measured_test("human-brain-cortex/tension.csv", Mode::Uniaxial),
      measured_test("human-brain-cortex/compression.csv", Mode::Uniaxial),
      measured_test("human-brain-cortex/simple-shear.csv", Mode::SimpleShear)};
  HomogeneousSettings settings;
  settings.law = "ogden-1";
  const HomogeneousFit ogden = fit_homogeneous(tests, settings);
  EXPECT_LT(ogden.calibration.estimates[1].high, 0);
  settings.law = "mooney-rivlin";
  EXPECT_GT(fit_homogeneous(tests, settings).calibration.cost, 3 * ogden.calibration.cost);
}

/// In one mode near rest the constants of Mooney-Rivlin act alike, and the fit warns of it.
TEST(Homogeneous, WarnsOfConstantsThatTheDataCannotDistinguish) {
  HomogeneousTest test{"short", Mode::PureShear, {}, {}, {}, 1};
  for (int i = 1; i <= 10; ++i) {
    test.deformation.push_back(1 + 0.01 * i);
    test.nominal.push_back(law_stress("mooney-rivlin", {400, 100}, test.mode, 1 + 0.01 * i));
  }
  HomogeneousSettings settings;
  settings.law = "mooney-rivlin";
  const auto calibration = fit_homogeneous({test}, settings).calibration;
  EXPECT_THAT(calibration.warnings, Contains(HasSubstr("hardly distinguish them")));
}

/// Uncertainties stated four times too small: the residuals show it, and the intervals still
/// contain the truth as often as stated.
TEST(Homogeneous, IntervalsCoverTheTruthWhereTheStatedUncertaintyIsTooSmall) {
  constexpr int kTrials = 300;
  std::mt19937 engine(9);
  std::normal_distribution<double> noise(0, 1);
  int inside = 0, widened = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    HomogeneousTest test{"synthetic", Mode::PureShear, {}, {}, {}, 1};
    for (int i = 1; i <= 20; ++i) {
      const double s = 1 + 0.025 * i, sigma = 60;
      test.deformation.push_back(s);
      test.nominal.push_back(law_stress("neo-hookean", {2378}, test.mode, s) +
                             sigma * noise(engine));
      test.uncertainty.push_back(sigma / 4);
    }
    HomogeneousSettings settings;
    settings.law = "neo-hookean";
    settings.weighting = Weighting::Uncertainty;
    const Calibration calibration = fit_homogeneous({test}, settings).calibration;
    const Estimate& e = calibration.estimates[0];
    if (e.low <= 2378 && 2378 <= e.high) ++inside;
    if (calibration.widened) ++widened;
  }
  EXPECT_GE(widened, kTrials - 1);
  EXPECT_GE(inside, 273);  // 285 expected, three standard deviations are 11
  EXPECT_LE(inside, 296);
}

/// Two tests that disagree, the second sampled twenty times as densely: by equal weights the
/// modulus is sum_t (g_t . p_t / |p_t|^2) / sum_t (|g_t|^2 / |p_t|^2), whatever the number of
/// samples.
TEST(Homogeneous, TestsCountAlikeWhateverTheNumberOfTheirSamples) {
  const auto curve = [](Mode mode, double mu, int samples) {
    HomogeneousTest test{"t", mode, {}, {}, {}, 1};
    for (int i = 0; i < samples; ++i) {
      const double s = rest_of(mode) + 0.5 * (i / (samples / 10) + 1) / 10;  // ten, each repeated
      test.deformation.push_back(s);
      test.nominal.push_back(mu * (mode == Mode::Uniaxial ? s - 1 / (s * s) : s));
    }
    return test;
  };
  HomogeneousSettings settings;
  settings.law = "neo-hookean";
  double above = 0, below = 0;
  for (const auto& [mode, mu] : {std::pair(Mode::Uniaxial, 600.0), {Mode::SimpleShear, 900.0}}) {
    const HomogeneousTest test = curve(mode, mu, 10);
    double gp = 0, gg = 0, pp = 0;
    for (std::size_t i = 0; i < 10; ++i) {
      const double p = test.nominal[i], g = p / mu;
      gp += g * p;
      gg += g * g;
      pp += p * p;
    }
    above += gp / pp;
    below += gg / pp;
  }
  for (const int samples : {10, 200}) {
    const HomogeneousFit fit = fit_homogeneous(
        {curve(Mode::Uniaxial, 600, 10), curve(Mode::SimpleShear, 900, samples)}, settings);
    EXPECT_NEAR(fit.shear_modulus, above / below, 1e-6 * fit.shear_modulus) << samples;
  }
}

/// Weights that say what counts, not what is noise, leave the intervals their coverage.
TEST(Homogeneous, IntervalsCoverTheTruthOfUnequallySampledTests) {
  constexpr int kTrials = 300;
  std::mt19937 engine(19);
  std::normal_distribution<double> noise(0, 1);
  int inside = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<HomogeneousTest> tests;
    for (const int samples : {8, 160}) {
      HomogeneousTest test{"t", Mode::SimpleShear, {}, {}, {}, 1};
      for (int i = 1; i <= samples; ++i) {
        const double s = 0.5 * i / samples;
        test.deformation.push_back(s);
        test.nominal.push_back(1000 * s + 30 * noise(engine));
      }
      tests.push_back(test);
    }
    HomogeneousSettings settings;
    settings.law = "neo-hookean";
    const Estimate e = fit_homogeneous(tests, settings).calibration.estimates[0];
    const double young = 1000 * 2 * (1 + kCasePoisson);
    inside += e.low <= young && young <= e.high;
  }
  EXPECT_GE(inside, 273);  // 285 expected, three standard deviations are 11
  EXPECT_LE(inside, 296);
}

TEST(Homogeneous, WarnsOfABoundAndOfUnexplainedResiduals) {
  HomogeneousTest test{"t", Mode::Uniaxial, {1.1, 1.2, 1.3, 1.4}, {900, 1700, 2500, 3300}, {}, 1};
  test.uncertainty = {1, 1, 1, 1};
  HomogeneousSettings settings;
  settings.law = "neo-hookean";
  settings.weighting = Weighting::Uncertainty;
  settings.constants = {{"young", true, 1000, 100, 2000}};
  const auto calibration = fit_homogeneous({test}, settings).calibration;
  EXPECT_TRUE(calibration.estimates[0].at_bound);
  EXPECT_THAT(calibration.warnings, Contains(HasSubstr("young is at its bound 2000")));
  EXPECT_THAT(calibration.warnings, Contains(HasSubstr("times the stated uncertainty")));
}

/// Costs by another method, in numpy: moduli that are not negative from all subsets of linear least
/// squares, exponents by a search on grids that are halved around the best.
TEST(Homogeneous, TermsOfOgdenEndInTheBestMinimum) {
  const auto all = three_modes("treloar-1944");
  HomogeneousSettings settings;
  const auto cost = [&](const std::vector<HomogeneousTest>& tests, const char* law) {
    settings.law = law;
    return fit_homogeneous(tests, settings).calibration.cost;
  };
  const std::vector<HomogeneousTest> uniaxial{all[0]};
  EXPECT_LT(cost(all, "ogden-1"), 1.2262030809 * (1 + 1e-6));
  EXPECT_LT(cost(all, "ogden-2"), 0.1890408259 * (1 + 1e-6));
  EXPECT_LT(cost(all, "ogden-3"), 0.0202895978 * (1 + 1e-6));
  EXPECT_LT(cost(uniaxial, "ogden-1"), 0.1435796844 * (1 + 1e-6));
  EXPECT_LT(cost(uniaxial, "ogden-2"), 0.0058591276 * (1 + 1e-6));
  settings.weighting = Weighting::Absolute;
  EXPECT_LT(cost(all, "ogden-3"), 104245012409.18661 * (1 + 1e-6));
}

/// The terms of Ogden's law are one solution in every order.
TEST(Homogeneous, TermsOfOgdenHaveOneOrder) {
  HomogeneousSettings settings;
  settings.law = "ogden-3";
  const auto calibration = fit_homogeneous(three_modes("treloar-1944"), settings).calibration;
  EXPECT_LT(calibration.estimates[1].value, calibration.estimates[3].value);
  EXPECT_LT(calibration.estimates[3].value, calibration.estimates[5].value);
  EXPECT_THAT(calibration.warnings, testing::Not(Contains(HasSubstr("another set"))));
  for (const auto& row : calibration.correlation)
    for (const double c : row) EXPECT_LE(std::abs(c), 1);
}

/// Gent's law to 97 % of its limit: no start below the limit that the data have passed.
TEST(Homogeneous, GentIsFoundUpToItsLimit) {
  for (const double limit : {5.0, 80.0, 400.0}) {
    HomogeneousTest test{"gent", Mode::Equibiaxial, {}, {}, {}, 1};
    for (int i = 1; i <= 20; ++i) {
      const double s = 1 + (std::sqrt(0.97 * limit / 2 + 1) - 1) * i / 20;
      test.deformation.push_back(s);
      test.nominal.push_back(law_stress("gent", {3e3, limit}, test.mode, s));
    }
    HomogeneousSettings settings;
    settings.law = "gent";
    const HomogeneousFit fit = fit_homogeneous({test}, settings);
    EXPECT_NEAR(fit.calibration.estimates[0].value, 3e3, 1e-2) << limit;
    EXPECT_NEAR(fit.calibration.estimates[1].value, limit, 1e-5 * limit);
  }
}

/// A fit of a law to data of another shape converges, and says by how much it misses them.
TEST(Homogeneous, WarnsOfALawThatMissesTheData) {
  HomogeneousTest test{"stiffening", Mode::Uniaxial, {}, {}, {}, 1};
  for (int i = 1; i <= 20; ++i) {
    const double s = 1 + 0.05 * i;
    test.deformation.push_back(s);
    test.nominal.push_back(law_stress("ogden-1", {1000, 14}, test.mode, s));
  }
  HomogeneousSettings settings;
  settings.law = "neo-hookean";
  const HomogeneousFit missed = fit_homogeneous({test}, settings);
  EXPECT_GT(missed.errors[0].relative, 0.25);
  EXPECT_THAT(missed.calibration.warnings,
              Contains(HasSubstr("the fitted law misses stiffening by")));
  settings.law = "ogden-1";
  EXPECT_THAT(fit_homogeneous({test}, settings).calibration.warnings,
              testing::Not(Contains(HasSubstr("misses stiffening"))));
}

/// A signal with the wrong sign is no law, and a fit of it is refused instead of written.
TEST(Homogeneous, RefusesAFitThatExplainsNothing) {
  HomogeneousTest test{"pulled", Mode::Uniaxial, {1.1, 1.2, 1.3, 1.4}, {-1, -2, -3, -4}, {}, 1};
  for (const auto law : homogeneous_laws()) {
    if (law == "mooney-rivlin-5" || law == "yeoh" || law == "ogden-3") continue;  // 4 values
    HomogeneousSettings settings;
    settings.law = law;
    try {
      fit_homogeneous({test}, settings);
      FAIL() << law << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration) << law << ": " << error.what();
      EXPECT_THAT(error.where(), HasSubstr(std::string(law)));
    }
  }
}

/// Compression that Mooney-Rivlin meets with C01 below zero, where it is stable as far as the test
/// goes: the constants are those of the normal equations, not those at a bound.
TEST(Homogeneous, MooneyRivlinIsBoundedByStabilityInTheRangeOfTheData) {
  std::mt19937 engine(21);
  std::normal_distribution<double> noise(0, 5);
  HomogeneousTest test{"compression", Mode::Uniaxial, {}, {}, {}, 1};
  double aa = 0, ab = 0, bb = 0, ap = 0, bp = 0;
  for (int i = 1; i <= 30; ++i) {
    const double s = 1 - 0.6 / 30 * i, a = 2 * (s - 1 / (s * s)), b = a / s;
    const double p = 1000 * a - 100 * b + noise(engine);
    test.deformation.push_back(s);
    test.nominal.push_back(p);
    aa += a * a, ab += a * b, bb += b * b, ap += a * p, bp += b * p;
  }
  HomogeneousSettings settings;
  settings.law = "mooney-rivlin";
  const HomogeneousFit fit = fit_homogeneous({test}, settings);
  const double det = aa * bb - ab * ab;
  EXPECT_NEAR(fit.calibration.estimates[0].value, (bb * ap - ab * bp) / det, 1e-3);
  EXPECT_NEAR(fit.calibration.estimates[1].value, (aa * bp - ab * ap) / det, 1e-3);
  EXPECT_LT(fit.calibration.estimates[1].high, 0);
  EXPECT_TRUE(std::isnan(fit.stability[0].unstable_at));
}

/// The same law stretched in two directions until it softens: its constants are not taken, the law
/// stays one that is stable, and the fit says why.
TEST(Homogeneous, MooneyRivlinThatIsUnstableInTheRangeOfTheDataIsNotTaken) {
  HomogeneousTest test{"inflation", Mode::Equibiaxial, {}, {}, {}, 1};
  for (int i = 1; i <= 20; ++i) {
    const double s = 1 + 0.1 * i;
    test.deformation.push_back(s);
    test.nominal.push_back(2 * (s - std::pow(s, -5)) * (1000 - 100 * s * s));
  }
  HomogeneousSettings settings;
  settings.law = "mooney-rivlin";
  const HomogeneousFit fit = fit_homogeneous({test}, settings);
  EXPECT_TRUE(fit.calibration.estimates[1].at_bound);
  EXPECT_TRUE(std::isnan(fit.stability[0].unstable_at));
  EXPECT_THAT(fit.calibration.warnings,
              Contains(HasSubstr("constants beyond the bounds fit better")));
  EXPECT_THAT(fit.calibration.warnings, Contains(HasSubstr("unstable in the range of inflation")));
}

/// Stresses a billion times smaller have constants a billion times smaller, to the last digits, and
/// the same intervals relative to them: no tolerance or bound has a size of its own.
TEST(Homogeneous, FitsScaleWithTheirStresses) {
  const auto large = three_modes("treloar-1944");
  for (const auto law : homogeneous_laws()) {
    HomogeneousSettings settings;
    settings.law = law;
    const HomogeneousFit fit = fit_homogeneous(large, settings);
    auto small = large;
    for (HomogeneousTest& test : small)
      for (double& stress : test.nominal) stress *= 1e-9;
    const HomogeneousFit scaled = fit_homogeneous(small, settings);
    EXPECT_NEAR(scaled.shear_modulus / fit.shear_modulus, 1e-9, 1e-14) << law;
    for (std::size_t i = 0; i < large.size(); ++i)
      EXPECT_NEAR(scaled.errors[i].relative, fit.errors[i].relative, 1e-6) << law;
    for (std::size_t i = 0; i < fit.calibration.estimates.size(); ++i)
      EXPECT_EQ(scaled.calibration.estimates[i].at_bound, fit.calibration.estimates[i].at_bound)
          << law;
  }
}

/// Small strains in a chamber are resisted by the modulus M = E (1 - nu)/((1 + nu)(1 - 2 nu)), also
/// where no row is at rest.
TEST(Homogeneous, ConfinedCompressionNeedsNoRowAtRest) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    constexpr double kYoung = 12e3;
    const double M = kYoung * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    HomogeneousTest test{"chamber", Mode::Confined, {}, {}, {}, 1};
    for (int i = 5; i <= 20; ++i) {
      test.deformation.push_back(1 - 1e-5 * i);
      test.nominal.push_back(-M * 1e-5 * i);
    }
    HomogeneousSettings settings;
    settings.law = "neo-hookean";
    settings.poisson = nu;
    const Estimate young = fit_homogeneous({test}, settings).calibration.estimates.at(0);
    EXPECT_NEAR(young.value, kYoung, 1e-3 * kYoung) << nu;
  }
}

TEST(Homogeneous, SaysWhereTheUnitsAreThoseOfNothingSoft) {
  HomogeneousSettings settings;
  settings.law = "neo-hookean";
  HomogeneousTest test{"bar", Mode::Uniaxial, {}, {}, {}, 1};
  for (int i = 1; i <= 20; ++i) {
    const double s = 1 + 0.01 * i;
    test.deformation.push_back(s);
    test.nominal.push_back(1e4 * (s - 1 / (s * s)));
  }
  EXPECT_THAT(fit_homogeneous({test}, settings).calibration.warnings, testing::IsEmpty());
  HomogeneousTest in_percent = test;
  for (double& s : in_percent.deformation) s = 1 + 100 * (s - 1);
  EXPECT_THAT(fit_homogeneous({in_percent}, settings).calibration.warnings,
              Contains(HasSubstr("check the unit of its strain")));
  for (double& stress : test.nominal) stress *= 1e-6;
  EXPECT_THAT(fit_homogeneous({test}, settings).calibration.warnings,
              Contains(HasSubstr("check the units of force, area")));
}

TEST(Homogeneous, RefusesWhatCannotBeFitted) {
  const auto refusal = [](const std::vector<HomogeneousTest>& tests, HomogeneousSettings settings) {
    try {
      fit_homogeneous(tests, settings);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  HomogeneousSettings settings;
  settings.law = "yeoh";
  HomogeneousTest test{"t", Mode::Uniaxial, {1.1, 1.2}, {1, 2}, {}, 1};
  EXPECT_THAT(refusal({test}, settings), HasSubstr("2 values cannot determine 3 constants"));
  EXPECT_THAT(refusal({}, settings), HasSubstr("there are no tests"));
  test = {"t", Mode::Uniaxial, {0.1, -0.2, 0.3, 0.4}, {1, 2, 3, 4}, {}, 1};
  EXPECT_THAT(refusal({test}, settings), HasSubstr("give stretches, not strains"));
  test.deformation = {1.1, 1.2, 1.3, 1.4};
  settings.poisson = 0.3;
  HomogeneousTest confined = test;
  confined.mode = Mode::Confined;
  EXPECT_THAT(refusal({test, confined}, settings),
              HasSubstr("confined compression with poisson = 0.3"));
  settings.poisson = kCasePoisson;
  test.effect = {1, 1, 1, 1};
  test.offset = true;
  EXPECT_THAT(refusal({test}, settings), HasSubstr("an offset is not fitted"));
  test.effect.clear();
  test.offset = false;
  settings.weighting = Weighting::Uncertainty;
  EXPECT_THAT(refusal({test}, settings), HasSubstr("it states no uncertainty"));
  settings.weighting = Weighting::PerTest;
  settings.law = "hooke";
  EXPECT_THAT(refusal({test}, settings), HasSubstr("law 'hooke': it is not known"));
  settings.law = "saint-venant-kirchhoff";
  EXPECT_THAT(refusal({test}, settings), HasSubstr("it has no incompressible form"));
  settings.law = "holzapfel-gasser-ogden";
  EXPECT_THAT(refusal({test}, settings), HasSubstr("they do not say how its fibres lie"));
  settings.law = "yeoh";
  settings.constants = {{"C11", true, 1, 0, 2}};
  EXPECT_THAT(refusal({test}, settings), HasSubstr("constant 'C11'"));
  settings.constants = {{"C10", true, 3, 0, 2}};
  EXPECT_THAT(refusal({test}, settings),
              HasSubstr("the start 3.00 of C10 is not within 0 .. 2.00"));
}

}  // namespace
}  // namespace palpate::calibrate
