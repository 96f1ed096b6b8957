// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/fit_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/response/fit.hpp"
#include "tests/unit/fitting/plate_body.hpp"

namespace palpate::fitting {
namespace {

const Field kSofterToOneSide = [](const Vec3& x) { return 0.01 + 40 * x[0]; };

std::vector<std::int32_t> all_vertices(const Body& body) {
  std::vector<std::int32_t> vertices;
  for (std::size_t v = 0; v < body.response.node.size(); ++v)
    vertices.push_back(static_cast<std::int32_t>(v));
  return vertices;
}

/// One site is a hundredfold softer than its neighbours: by default it is fitted as well as they
/// are; with one tolerance in newtons for all it is not, and it is named.
TEST(FitErrors, NameTheSoftSiteThatAToleranceInNewtonsMisses) {
  const Body body = plate(3);
  const Curves curves = press_all(body, all_vertices(body), kSofterToOneSide);
  const auto by_default = fit_errors(fit(body, curves, {}), curves);
  ASSERT_EQ(by_default.size(), curves.sites.size());
  EXPECT_LE(summary_of(by_default, &SiteFitError::normal).worst, 0.01);
  EXPECT_LE(summary_of(by_default, &SiteFitError::lateral).worst, 0.01);

  FitSettings coarse;
  coarse.absolute_tolerance = 0.005;
  const auto missed = fit_errors(fit(body, curves, coarse), curves);
  const FitErrorSummary normal = summary_of(missed, &SiteFitError::normal);
  EXPECT_GT(normal.worst, kVisibleFitError);
  EXPECT_LT(normal.median, 0.02);
  EXPECT_EQ(position(body, normal.vertex)[0], 0);  // on the soft side
}

/// Independent of the stored errors: evaluated from the curves.
TEST(FitErrors, AreThoseOfTheRenderedCurvesAtTheSamples) {
  const Body body = plate(2);
  const Curves curves = press_all(body, all_vertices(body), kSofterToOneSide);
  FitSettings settings;
  settings.max_knots = 2;
  const Library library = fit(body, curves, settings);
  for (const SiteFitError& error : fit_errors(library, curves)) {
    const SiteCurves& site = curves.sites[static_cast<std::size_t>(error.vertex)];
    const runtime::CompiledCurve curve(
        library.responses[static_cast<std::size_t>(error.vertex)].normal);
    double largest = 0, peak = 0;
    for (const CurveSample& sample : site.paths[0].samples) {
      const double force = dot(sample.force, kInward);
      peak = std::max(peak, force);
      largest = std::max(largest, std::abs(curve.force(sample.displacement) - force));
    }
    EXPECT_GT(error.normal, 0.01);  // two knots are a parabola, the samples have a power of 1.5
    EXPECT_NEAR(error.normal, largest / peak, 1e-6);
  }
}

/// Two azimuths, 30 % stiffer in one: without soft axes their mean is fitted exactly, and each path
/// is missed by 15 %.
TEST(FitErrors, TellTheLossByAveragingFromAMisfit) {
  const Body body = plate(1);
  Curves curves = press_all(body, all_vertices(body), [](const Vec3&) { return 1.0; });
  for (SiteCurves& site : curves.sites) {
    CurvePath across = site.paths[1];
    across.direction = {0, 1, 0};
    for (CurveSample& sample : across.samples)
      sample.force = {0, 1.3 * 40 * sample.displacement, sample.force[2]};
    site.paths.push_back(across);
  }
  for (const ResponseKind kind : {ResponseKind::Decoupled, ResponseKind::Coupled}) {
    FitSettings settings;
    settings.kind = kind;
    settings.soft_axes = false;
    const auto errors = fit_errors(fit(body, curves, settings), curves);
    EXPECT_LT(summary_of(errors, &SiteFitError::lateral).worst, 0.02);
    EXPECT_NEAR(summary_of(errors, &SiteFitError::spread).median, 0.15 / 1.3, 0.02);
  }
  FitSettings settings;
  settings.kind = ResponseKind::Coupled;
  const auto errors = fit_errors(fit(body, curves, settings), curves);
  EXPECT_LT(summary_of(errors, &SiteFitError::lateral).worst, 0.01);
  EXPECT_LT(summary_of(errors, &SiteFitError::spread).worst, 0.01);
}

TEST(FitErrors, OfNoSiteAreNone) {
  const FitErrorSummary none = summary_of({}, &SiteFitError::normal);
  EXPECT_EQ(none.vertex, -1);
  EXPECT_EQ(none.worst, 0);
}

}  // namespace
}  // namespace palpate::fitting
