// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fitting/response/fit.hpp"
#include "fitting/response/fit_errors.hpp"
#include "fitting/response/lean.hpp"
#include "format/error.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr double kDepth = 0.006;
constexpr double kTravel = 0.003;
const Vec3 kInward{0, 0, -1};

/// A flat fan: vertex 0 in the middle of a hexagon, all in the plane z = 0.
Body hexagon() {
  Body body;
  body.name = "plate";
  body.nodes.push_back({0, 0, -0.03});  // response vertices are not the first nodes
  body.nodes.push_back({0, 0, 0});
  for (int i = 0; i < 6; ++i) {
    const double angle = i * 1.0471975511965976;
    body.nodes.push_back({0.01 * std::cos(angle), 0.01 * std::sin(angle), 0});
  }
  for (std::int32_t v = 0; v < 7; ++v) {
    body.response.node.push_back(v + 1);
    body.response.inward.push_back(kInward);
    body.response.is_site.push_back(1);
  }
  for (std::int32_t i = 0; i < 6; ++i) {
    body.response.triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
  }
  return body;
}

double normal_law(double d) {
  return 1200 * std::pow(d, 1.5);
}

CurvePath normal_path(double reach, double scale) {
  CurvePath path{PathKind::Normal, 0, kInward, {}};
  for (int i = 0; i <= 12; ++i) {
    CurveSample sample;
    sample.displacement = reach * i / 12;
    // Some force across the path, as on an uneven body: the press leans.
    sample.force = {0.01, 0.02, -scale * normal_law(sample.displacement)};
    path.samples.push_back(sample);
  }
  return path;
}

/// A lateral path of a bonded contact at a depth; its normal force is not part of the response.
CurvePath lateral_path(const Vec3& direction, double lateral_depth, double stiffness,
                       double reach = kTravel) {
  CurvePath path{PathKind::Lateral, lateral_depth, direction, {}};
  const Vec3 first{0.004, -0.003, -normal_law(lateral_depth)};
  for (int i = 0; i <= 6; ++i) {
    CurveSample sample;
    sample.displacement = reach * i / 6;
    sample.force = first + (stiffness * sample.displacement) * direction;
    path.samples.push_back(sample);
  }
  return path;
}

SiteCurves complete_site(std::int32_t vertex, double scale = 1) {
  SiteCurves site;
  site.vertex = vertex;
  site.status = SiteStatus::Complete;
  site.paths = {normal_path(kDepth, scale), lateral_path({1, 0, 0}, 0.003, 60 * scale)};
  return site;
}

Curves complete_curves(const Body& body) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  curves.depth = kDepth;
  curves.lateral_travel = kTravel;
  curves.provenance.steps.push_back({"precompute", "0", "0", "0", "", {}, {}});
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    curves.sites.push_back(complete_site(static_cast<std::int32_t>(v)));
  }
  return curves;
}

std::string problem_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.where() + ": " + error.problem();
  }
  return "no error";
}

TEST(Fit, EveryCompleteSiteHasItsResponses) {
  const Body body = hexagon();
  const Library library = fit(body, complete_curves(body), {});
  EXPECT_EQ(library.name, "plate");
  EXPECT_EQ(library.tool_shape, "sphere");
  EXPECT_EQ(library.tool_radius, 0.005);
  EXPECT_EQ(library.triangles, body.response.triangles);
  EXPECT_LT(norm(library.positions[2] - body.nodes[3]), 2e-9);
  ASSERT_EQ(library.provenance.steps.size(), 1u);
  ASSERT_EQ(library.responses.size(), 7u);
  std::size_t floats = 0;
  for (const NodeResponse& node : library.responses) {
    EXPECT_EQ(node.status, ResponseStatus::Fitted);
    const runtime::CompiledCurve normal(node.normal);
    const runtime::CompiledCurve lateral(node.lateral);
    const LeaningResponse lean(node, library.kind);
    for (int i = 1; i <= 12; ++i) {
      const double d = kDepth * i / 12;
      EXPECT_NEAR(normal.force(d) + lean.normal_force(d), normal_law(d),
                  std::max(0.01 * normal_law(d), 0.005));
    }
    EXPECT_NEAR(lateral.force(0.002), 0.12, 0.005);
    EXPECT_LE(node.lateral_error, 0.005);
    floats += 2 * (node.normal.knot.size() + node.lateral.knot.size());
  }
  EXPECT_LE(4 * floats / 7, 64u);
}

/// Lateral stiffness of a bonded contact, proportional to the contact radius of a sphere.
double contact_width(double depth) {
  return std::sqrt(depth / 0.003);
}

TEST(Fit, TheLateralErrorOfTheMeshIsTheLargestOfTheLateralCurves) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  CurvePath& path = curves.sites[2].paths[1];
  ASSERT_EQ(path.kind, PathKind::Lateral);
  path.samples.back().mesh_error = 0.004;
  const Library library = fit(body, curves, {});
  EXPECT_EQ(library.responses[2].lateral_mesh_error, 0.004);
  EXPECT_TRUE(std::isnan(library.responses[2].normal_mesh_error));
  const auto errors = fit_errors(library, curves);
  const FitErrorSummary summary = summary_of(errors, &SiteFitError::lateral_mesh);
  EXPECT_EQ(summary.vertex, 2);
  EXPECT_GT(summary.worst, 0);
}

TEST(Fit, TheErrorOfTheMeshIsTheLargestOfTheNormalCurve) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  curves.sites[2].paths[0].samples[3].mesh_error = 0.03;
  curves.sites[2].paths[0].samples[4].mesh_error = 0.02;
  const Library library = fit(body, curves, {});
  EXPECT_EQ(library.responses[2].normal_mesh_error, 0.03);
  EXPECT_TRUE(std::isnan(library.responses[3].normal_mesh_error));
  EXPECT_TRUE(std::isnan(library.responses[2].lateral_mesh_error));
  const auto errors = fit_errors(library, curves);
  const FitErrorSummary summary = summary_of(errors, &SiteFitError::mesh);
  EXPECT_EQ(summary.vertex, 2);
  EXPECT_NEAR(summary.worst, 0.03 / dot(curves.sites[2].paths[0].samples.back().force, kInward),
              1e-12);
}

TEST(Fit, CoupledResponsesFollowTheDepth) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  for (SiteCurves& site : curves.sites) {
    site.paths = {normal_path(kDepth, 1)};
    for (const double z : {0.0015, 0.003, 0.005})
      site.paths.push_back(lateral_path({1, 0, 0}, z, 70 * contact_width(z)));
  }
  FitSettings settings;
  settings.kind = ResponseKind::Coupled;
  const Library library = fit(body, curves, settings);
  EXPECT_EQ(library.kind, ResponseKind::Coupled);
  const NodeResponse& node = library.responses[0];
  const runtime::CompiledCurve h(node.lateral);
  const runtime::CompiledCurve w(node.coupling.curve, static_cast<double>(node.coupling.base));
  EXPECT_NEAR(h.force(0.002), 0.14, 0.001);  // at the middle depth w is 1
  for (const double z : {0.0004, 0.001, 0.002, 0.003, 0.004, 0.006})
    EXPECT_NEAR(w.force(z), contact_width(z), 0.02) << z;
  EXPECT_EQ(node.coupling.curve.slope[0], 0.0F);  // the normal force is continuous at touch
  EXPECT_LT(node.lateral_error, 0.004);
  // A single response for all depths cannot represent the dependence on depth.
  const Library decoupled = fit(body, curves, {});
  EXPECT_GT(decoupled.responses[0].lateral_error, 10 * node.lateral_error);
  const std::size_t bytes = 4 + 8 * (node.normal.knot.size() + node.lateral.knot.size() +
                                     node.coupling.curve.knot.size());
  EXPECT_LE(bytes, 160u);
}

TEST(Fit, CoupledResponsesOfASingleDepthGrowLikeTheContactRadiusOfASphere) {
  const Body body = hexagon();
  FitSettings settings;
  settings.kind = ResponseKind::Coupled;
  const Library library = fit(body, complete_curves(body), settings);  // lateral depth 3 mm
  const NodeResponse& node = library.responses[0];
  const runtime::CompiledCurve w(node.coupling.curve, static_cast<double>(node.coupling.base));
  for (const double z : {0.0004, 0.001, 0.003, 0.006})
    EXPECT_NEAR(w.force(z), contact_width(z), 0.02) << z;
  EXPECT_NEAR(runtime::CompiledCurve(node.lateral).force(kTravel), 60 * kTravel, 1e-3);
}

TEST(Fit, TheLateralResponseIsTheMeanOverAzimuthsAndDepths) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  curves.sites[0].paths = {normal_path(kDepth, 1), lateral_path({1, 0, 0}, 0.002, 40),
                           lateral_path({0, 1, 0}, 0.002, 60), lateral_path({1, 0, 0}, 0.004, 80)};
  const Library library = fit(body, curves, {});
  const NodeResponse& node = library.responses[0];
  EXPECT_NEAR(runtime::CompiledCurve(node.lateral).force(kTravel), 60 * kTravel, 1e-6);
  // The stated error is the loss by averaging: 20 N/m over 3 mm.
  EXPECT_NEAR(node.lateral_error, 20 * kTravel, 1e-6);
}

TEST(Fit, AFailedSiteIsAHole) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  curves.sites[3].status = SiteStatus::Failed;
  curves.sites[5].paths.pop_back();  // no lateral response
  curves.sites.pop_back();           // never run
  const Library library = fit(body, curves, {});
  EXPECT_EQ(library.responses[3].status, ResponseStatus::Hole);
  EXPECT_EQ(library.responses[5].status, ResponseStatus::Hole);
  EXPECT_EQ(library.responses[6].status, ResponseStatus::Hole);
  EXPECT_TRUE(library.responses[3].normal.knot.empty());
  EXPECT_EQ(library.responses[2].status, ResponseStatus::Fitted);
  EXPECT_EQ(library.triangles.size(), 6u);  // a hole is a border, its triangles stay
}

TEST(Fit, APartialSiteIsUsableFromHalfOfTheDepth) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  for (const std::size_t v : {1u, 2u}) curves.sites[v].status = SiteStatus::Partial;
  curves.sites[1].paths[0] = normal_path(0.5 * kDepth, 1);
  curves.sites[2].paths[0] = normal_path(0.4 * kDepth, 1);
  const Library library = fit(body, curves, {});
  EXPECT_EQ(library.responses[1].status, ResponseStatus::Fitted);
  EXPECT_FLOAT_EQ(library.responses[1].normal.knot.back(), 0.003f);
  EXPECT_EQ(library.responses[2].status, ResponseStatus::Hole);
}

TEST(Fit, FillingAHoleTakesTheMeanOfItsNeighbours) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  curves.sites[0].status = SiteStatus::Failed;
  // Neighbours of the middle: three with half, three with one and a half of the law.
  for (std::size_t v = 1; v < 7; ++v) {
    curves.sites[v] = complete_site(static_cast<std::int32_t>(v), v % 2 == 0 ? 0.5 : 1.5);
  }
  FitSettings settings;
  settings.fill_holes = true;
  const Library library = fit(body, curves, settings);
  const NodeResponse& node = library.responses[0];
  EXPECT_EQ(node.status, ResponseStatus::Interpolated);
  const runtime::CompiledCurve normal(node.normal);
  const double felt =
      normal.force(kDepth) + LeaningResponse(node, library.kind).normal_force(kDepth);
  EXPECT_NEAR(felt, normal_law(kDepth), 0.02 * normal_law(kDepth));
  EXPECT_NEAR(runtime::CompiledCurve(node.lateral).force(kTravel), 60 * kTravel, 0.005);
  // The error is the distance to a neighbour: half of the law.
  EXPECT_NEAR(node.normal_error, 0.5 * normal_law(kDepth), 0.03 * normal_law(kDepth));
}

TEST(Fit, TrianglesAtASupportAreOmitted) {
  Body body = hexagon();
  body.response.is_site[4] = 0;
  Curves curves = complete_curves(body);
  curves.sites.erase(curves.sites.begin() + 4);
  const Library library = fit(body, curves, {});
  EXPECT_EQ(library.triangles.size(), 4u);
  for (const Triangle& triangle : library.triangles) {
    for (const std::int32_t v : triangle) EXPECT_NE(v, 4);
  }
}

TEST(Fit, RefusesCurvesOfAnotherBody) {
  const Body body = hexagon();
  Curves beyond = complete_curves(body);
  beyond.sites[2].vertex = 7;
  EXPECT_NE(problem_of([&] { fit(body, beyond, {}); }).find("only 7 response vertices"),
            std::string::npos);
  Curves turned = complete_curves(body);
  turned.sites[2].paths[0].direction = {0, 0.1, -0.995};
  EXPECT_NE(problem_of([&] { fit(body, turned, {}); }).find("press direction"), std::string::npos);
  Curves twice = complete_curves(body);
  twice.sites[2].vertex = 1;
  EXPECT_NE(problem_of([&] { fit(body, twice, {}); }).find("twice"), std::string::npos);
  Body supported = body;
  supported.response.is_site[6] = 0;
  EXPECT_NE(problem_of([&] { fit(supported, complete_curves(body), {}); }).find("vertex 6"),
            std::string::npos);
}

TEST(Fit, RefusesCurvesWithoutAUsableSite) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  for (SiteCurves& site : curves.sites) site.status = SiteStatus::Failed;
  EXPECT_NE(problem_of([&] { fit(body, curves, {}); }).find("no site"), std::string::npos);
}

TEST(Fit, RefusesSettingsOutOfRange) {
  const Body body = hexagon();
  const Curves curves = complete_curves(body);
  FitSettings settings;
  settings.max_knots = 1;
  EXPECT_NE(problem_of([&] { fit(body, curves, settings); }).find("max_knots"), std::string::npos);
  settings = {};
  settings.absolute_tolerance = 0;
  EXPECT_NE(problem_of([&] { fit(body, curves, settings); }).find("tolerance"), std::string::npos);
}

/// The middle of the hexagon is softer than its rim, so linear interpolation is too stiff.
TEST(Fit, BetweenNodesScalesAndStatesTheErrorAtNodes) {
  const Body body = hexagon();
  Curves curves = complete_curves(body);
  for (std::int32_t v = 1; v < 7; ++v)
    curves.sites[static_cast<std::size_t>(v)] = complete_site(v, 1.2);
  FitSettings settings;
  const Library at_nodes = fit(body, curves, settings);
  settings.between_nodes = true;
  const Library between = fit(body, curves, settings);
  const runtime::CompiledCurve before(at_nodes.responses[0].normal);
  const runtime::CompiledCurve after(between.responses[0].normal);
  // f = f_0 (1 + 0.2 (r/R)^2): over each triangle the mean of e . H e / 24 is 3 R^2 (0.4/R^2)/24.
  for (const double z : {0.001, 0.003, 0.006})
    EXPECT_NEAR(after.force(z), 0.95 * before.force(z), 2e-3 * before.force(z));
  EXPECT_EQ(between.responses[0].normal.knot, at_nodes.responses[0].normal.knot);
  const double end = normal_law(kDepth);
  EXPECT_NEAR(between.responses[0].normal_error, 0.05 * end, 0.012 * end);
  EXPECT_GT(between.responses[0].lateral_error, at_nodes.responses[0].lateral_error);
}

}  // namespace
}  // namespace palpate::fitting
