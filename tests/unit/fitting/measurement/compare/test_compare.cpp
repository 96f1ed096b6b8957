// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fitting/measurement/compare/compare.hpp"
#include "format/error.hpp"

namespace palpate::compare {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

const Vec3 kInward{0, 0, -1};
constexpr double kDepth = 0.006;

double law(double d) {
  return 1200 * std::pow(d, 1.5);
}

CurvePath path_of(double scale, double offset, int samples, PathKind kind = PathKind::Normal) {
  CurvePath path;
  path.kind = kind;
  path.direction = kind == PathKind::Normal ? kInward : Vec3{1, 0, 0};
  path.lateral_depth = kind == PathKind::Normal ? 0 : 0.003;
  for (int i = 0; i <= samples; ++i) {
    CurveSample sample;
    sample.displacement = kDepth * i / samples;
    const double start = kind == PathKind::Normal ? 0 : 0.3;
    sample.force = (scale * law(sample.displacement) + (i > 0 ? offset : 0)) * path.direction +
                   start * kInward;
    path.samples.push_back(sample);
  }
  return path;
}

Curves curves_of(double scale, double offset = 0, int samples = 24) {
  Curves curves;
  for (std::int32_t v : {3, 5, 9}) {
    curves.sites.push_back({v, SiteStatus::Complete, "", 0, {path_of(scale, offset, samples)}});
    curves.sites.back().paths.push_back(path_of(scale, offset, samples, PathKind::Lateral));
  }
  return curves;
}

Comparison compared(const Curves& reference, const Curves& model, CompareSettings settings = {}) {
  return compare(set_of(reference, "measured"), set_of(model, "simulated"), settings);
}

TEST(Compare, ACurveAgainstItselfIsZero) {
  const Comparison c = compared(curves_of(1), curves_of(1));
  ASSERT_EQ(c.curves.size(), 6U);
  EXPECT_THAT(c.unmatched, IsEmpty());
  for (const CurveComparison& curve : c.curves) {
    EXPECT_EQ(curve.rmse, 0);
    EXPECT_EQ(curve.bias, 0);
    EXPECT_EQ(curve.r2, 1);
    EXPECT_EQ(curve.energy_model, curve.energy_reference);
    EXPECT_TRUE(std::isnan(curve.within_uncertainty));
  }
}

/// A model that is stiffer by a constant fraction: every figure has a closed form.
TEST(Compare, AStifferModelIsToldInClosedForm) {
  const double more = 0.1;
  const Comparison c = compared(curves_of(1), curves_of(1 + more));
  const CurveComparison& curve = c.curves.front();
  double squares = 0, sum = 0, mean = 0, total = 0;
  const int n = 24;
  for (int i = 1; i <= n; ++i) {
    const double f = law(kDepth * i / n);
    squares += more * more * f * f / n;
    sum += more * f / n;
    mean += f / n;
  }
  for (int i = 1; i <= n; ++i) total += std::pow(law(kDepth * i / n) - mean, 2) / n;
  EXPECT_NEAR(curve.rmse, std::sqrt(squares), 1e-12);
  EXPECT_NEAR(curve.normalised_rmse, std::sqrt(squares) / law(kDepth), 1e-12);
  EXPECT_NEAR(curve.bias, sum, 1e-12);
  EXPECT_NEAR(curve.r2, 1 - squares / total, 1e-12);
  EXPECT_NEAR(curve.worst.displacement, kDepth, 1e-12);
  EXPECT_NEAR(curve.worst.jnd, more / 0.07, 1e-9);
  const double energy = 1200 * std::pow(kDepth, 2.5) / 2.5;
  EXPECT_NEAR(curve.energy_reference, energy, 1e-3 * energy);
  EXPECT_NEAR(curve.energy_model, 1.1 * energy, 1.1e-3 * energy);
  for (const StiffnessAt& s : curve.stiffness) {
    const double k = 1.5 * 1200 * std::sqrt(s.displacement);
    EXPECT_NEAR(s.reference, k, 0.02 * k);
    EXPECT_NEAR(s.model / s.reference, 1.1, 1e-9);
  }
}

/// The normal force of a lateral path is no lateral response.
TEST(Compare, LateralPathsAreComparedAlongTheirDirection) {
  Curves model = curves_of(1);
  for (CurveSample& s : model.sites[0].paths[1].samples) s.force[2] += 5;
  const Comparison c = compared(curves_of(1), model);
  EXPECT_NEAR(c.curves[1].rmse, 0, 1e-12);
}

/// Different samples and ranges: the model is interpolated, the common range counts.
TEST(Compare, GridsAndRangesNeedNotAgree) {
  Curves model = curves_of(1, 0, 17);
  for (SiteCurves& site : model.sites) {
    for (CurvePath& path : site.paths) path.samples.resize(13);
  }
  const Comparison c = compared(curves_of(1), model);
  EXPECT_NEAR(c.curves.front().range, kDepth * 12 / 17, 1e-12);
  EXPECT_LT(c.curves.front().normalised_rmse, 1e-3);
}

TEST(Compare, SharesWithinTheUncertaintyAreThoseOfTheNormalDistribution) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0, 0.01);
  Curves reference;
  for (std::int32_t v = 0; v < 400; ++v) {
    CurvePath path = path_of(1, 0, 24);
    for (CurveSample& s : path.samples) {
      if (s.displacement > 0) s.force[2] += noise(engine);
      s.force_uncertainty = 0.01;
      s.force_scatter = 0.02;
    }
    reference.sites.push_back({v, SiteStatus::Complete, "", 0, {path}});
  }
  Curves model;
  for (std::int32_t v = 0; v < 400; ++v) {
    model.sites.push_back({v, SiteStatus::Complete, "", 0, {path_of(1, 0, 24)}});
  }
  const Comparison c = compared(reference, model);
  const Summary& s = c.summaries.front();
  EXPECT_EQ(s.points, 9600U);
  EXPECT_NEAR(s.within_uncertainty, 0.95, 0.009);  // four standard deviations
  EXPECT_NEAR(s.mean_scatter, 0.02, 1e-12);
  EXPECT_NEAR(s.rmse, 0.01, 0.0004);
  EXPECT_NEAR(s.agreement_high - s.agreement_low, 2 * 1.96 * 0.01, 0.001);
}

TEST(Compare, BlandAltmanLimitsAreAroundTheBias) {
  const Comparison c = compared(curves_of(1), curves_of(1, 0.05));
  const Summary& s = c.summaries.front();
  EXPECT_NEAR(s.bias, 0.05, 1e-12);
  EXPECT_NEAR(s.agreement_low, 0.05, 1e-9);
  EXPECT_NEAR(s.agreement_high, 0.05, 1e-9);
}

TEST(Compare, JustNoticeableDifferencesHaveAFloor) {
  CompareSettings settings;
  settings.jnd = 0.1;
  settings.jnd_floor = 0.05;
  const Comparison c = compared(curves_of(1), curves_of(1, 0.05), settings);
  for (const ComparedPoint& p : c.curves.front().points) {
    EXPECT_NEAR(p.jnd, 0.05 / std::max(0.1 * p.reference, 0.05), 1e-9);
  }
}

/// A sphere of 25 um that meets 8 uN: 5 mN would make nothing noticeable, and 2 mm every site one.
TEST(Compare, FloorAndToleranceFitTheSizeOfTheReference) {
  Curves micro = curves_of(1);
  const ComparedSet large = set_of(micro, "large");
  double largest = 0;
  for (SiteCurves& site : micro.sites)
    for (CurvePath& path : site.paths)
      for (CurveSample& sample : path.samples) {
        for (double& f : sample.force) f *= 1e-6;
        largest = std::max(largest, std::abs(dot(sample.force, path.direction)));
      }
  micro.tool = {"sphere", 25e-6, "frictionless"};
  const ComparedSet small = set_of(micro, "small");
  EXPECT_EQ(jnd_floor_of(large, 0.07), 0.005);
  EXPECT_NEAR(jnd_floor_of(small, 0.07), 0.07 * largest, 1e-6 * largest);
  EXPECT_EQ(site_tolerance_of(small), 50e-6);
  EXPECT_EQ(site_tolerance_of(ComparedSet{}), 0.002);
  CompareSettings settings;
  settings.jnd_floor = jnd_floor_of(small, settings.jnd);
  Curves stiffer = micro;
  for (SiteCurves& site : stiffer.sites)
    for (CurvePath& path : site.paths)
      for (CurveSample& sample : path.samples)
        for (double& f : sample.force) f *= 1.1;
  const Comparison c = compared(micro, stiffer, settings);
  EXPECT_NEAR(c.curves.front().worst.jnd, 0.1 / 0.07, 0.05);
}

TEST(Compare, WhatHasNoPartnerIsNamed) {
  Curves model = curves_of(1);
  model.sites.erase(model.sites.begin());
  model.sites[0].paths[1].lateral_depth = 0.005;
  const Comparison c = compared(curves_of(1), model);
  EXPECT_EQ(c.curves.size(), 3U);
  EXPECT_THAT(c.unmatched, Contains(HasSubstr("site 3 of measured has no partner")));
  EXPECT_THAT(c.unmatched, Contains(HasSubstr("site 5 of measured: its lateral path at 3.00 mm")));
  for (SiteCurves& site : model.sites) site.vertex += 100;
  EXPECT_THROW(compared(curves_of(1), model), Error);
}

TEST(Compare, CurvesOfDifferentBodiesAreNotMatchedByNumber) {
  Curves a = curves_of(1), b = curves_of(1);
  a.body_sha256 = std::string(64, 'a');
  b.body_sha256 = std::string(64, 'b');
  EXPECT_THROW(compared(a, b), Error);
  b.body_sha256 = a.body_sha256;
  EXPECT_NO_THROW(compared(a, b));
}

/// The force of a sphere at a depth grows as the root of its radius: curves of 0.1 and 0.25 mm
/// differ by 58 % on one specimen.
TEST(Compare, OtherToolsAreRefused) {
  const auto refusal = [](const Curves& a, const Curves& b) -> std::string {
    try {
      compared(a, b);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  Curves a = curves_of(1), b = curves_of(1);
  a.tool = {"sphere", 0.1e-3, "frictionless"};
  b.tool = {"sphere", 0.25e-3, "frictionless"};
  EXPECT_THAT(refusal(a, b), HasSubstr("radius of 0.250 mm, that of measured 0.100 mm"));
  b.tool.radius = 0.1005e-3;
  EXPECT_EQ(refusal(a, b), "accepted");
  b.tool.shape = "disc";
  EXPECT_THAT(refusal(a, b), HasSubstr("its tool is a disc, that of measured a sphere"));
  b.tool = {};  // unknown
  EXPECT_EQ(refusal(a, b), "accepted");
}

Library library_of(double shift, float stiffness) {
  Library library;
  for (int v = 0; v < 4; ++v) {
    library.positions.push_back({0.01 * v + shift, 0, 0});
    library.inward.push_back(kInward);
    NodeResponse response;
    response.status = v == 2 ? ResponseStatus::Hole : ResponseStatus::Fitted;
    response.normal = {{0, 0.004F}, {0, stiffness}};
    response.lateral = {{0, 0.002F}, {50, 50}};
    library.responses.push_back(response);
  }
  return library;
}

TEST(Compare, TwoLibrariesAreMatchedByPosition) {
  const auto a = set_of(library_of(0, 400), "a"), b = set_of(library_of(0.001, 400), "b");
  CompareSettings settings;
  const Comparison c = compare(a, b, settings);
  EXPECT_EQ(c.curves.size(), 6U);  // the hole has none
  EXPECT_NEAR(c.curves.front().distance, 0.001, 1e-12);
  EXPECT_NEAR(c.summaries.front().rmse, 0, 1e-9);
  // f = s d^2/(2 L): 0.8 N at the last knot.
  const Comparison stiffer = compare(a, set_of(library_of(0, 440), "b"), settings);
  EXPECT_NEAR(stiffer.curves.front().worst.reference, 0.8, 1e-6);
  EXPECT_NEAR(stiffer.curves.front().worst.model, 0.88, 1e-6);
  settings.site_tolerance = 0.0005;
  EXPECT_THROW(compare(a, b, settings), Error);
}

/// A library against the measured curves it was made of: by vertex, for curves have no position.
TEST(Compare, ALibraryAndCurvesAreMatchedByVertex) {
  Curves measured;
  measured.sites.push_back({1, SiteStatus::Complete, "", 0, {path_of(1, 0, 24)}});
  const Comparison c = compare(set_of(measured, "m"), set_of(library_of(0, 400), "l"), {});
  ASSERT_EQ(c.curves.size(), 1U);
  EXPECT_NEAR(c.curves[0].range, 0.004, 1e-6);
  EXPECT_NEAR(c.curves[0].position[0], 0.01, 1e-12);
}

/// A coupled library renders a drag at a depth z by w(z) f^r.
TEST(Compare, ALibraryIsComparedAsItIsRendered) {
  Library library = library_of(0, 400);
  library.kind = ResponseKind::Coupled;
  for (NodeResponse& response : library.responses)
    response.coupling = {0.5F, {{0, 0.004F}, {125, 125}}};
  Curves curves;
  curves.sites.push_back({1, SiteStatus::Complete, "", 0, {path_of(1, 0, 24)}});
  for (const double depth : {0.002, 0.004}) {
    CurvePath drag{PathKind::Lateral, depth, {1, 0, 0}, {}};
    for (int i = 0; i <= 8; ++i) {
      CurveSample sample;
      sample.displacement = 0.002 * i / 8;
      sample.force = {50 * (0.5 + 125 * depth) * sample.displacement, 0, 0};
      drag.samples.push_back(sample);
    }
    curves.sites[0].paths.push_back(drag);
  }
  for (const bool forth : {true, false}) {
    const ComparedSet measured = set_of(curves, "m"), rendered = set_of(library, "l");
    const Comparison c = forth ? compare(measured, rendered, {}) : compare(rendered, measured, {});
    ASSERT_EQ(c.curves.size(), 3U);
    EXPECT_EQ(c.summaries.at(1).curves, 2U);
    EXPECT_LT(c.summaries.at(1).rmse, 1e-6) << forth;  // of 0.1 N
  }
}

TEST(MonotoneCubic, IsExactForLinesAndNeverOvershoots) {
  const MonotoneCubic line({0, 1, 3}, {0, 2, 6});
  EXPECT_NEAR(line.value(2.2), 4.4, 1e-12);
  EXPECT_NEAR(line.slope(0.3), 2, 1e-12);
  EXPECT_NEAR(line.integral(2), 4, 1e-12);
  const MonotoneCubic step({0, 1, 2, 3}, {0, 0, 1, 1});
  for (double x = 0; x <= 3; x += 0.01) {
    EXPECT_GE(step.value(x), -1e-12);
    EXPECT_LE(step.value(x), 1 + 1e-12);
    EXPECT_GE(step.slope(x), -1e-12);
  }
  std::vector<double> x, y;
  for (int i = 0; i <= 20; ++i) {
    x.push_back(0.1 * i);
    y.push_back(std::pow(0.1 * i, 3));
  }
  const MonotoneCubic cubic(x, y);
  EXPECT_NEAR(cubic.value(1.53), std::pow(1.53, 3), 2e-3);
  EXPECT_NEAR(cubic.slope(1.5), 3 * 2.25, 0.02);
}

}  // namespace
}  // namespace palpate::compare
