// SPDX-License-Identifier: AGPL-3.0-or-later
// Fields of fibres from samples and from a potential.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/campaign/indentation.hpp"
#include "fem/solid/fibre_potential.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

std::vector<FibreSample> random_samples(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<FibreSample> samples;
  for (int i = 0; i < count; ++i)
    samples.push_back({{unit(random), unit(random), unit(random)},
                       {unit(random), unit(random), unit(random)},
                       {}});
  return samples;
}

TEST(FibreSamples, FindTheNearest) {
  const std::vector<FibreSample> samples = random_samples(500);
  const FibreSamples field(samples);
  for (const FibreSample& probe : random_samples(700)) {
    const Vec3 X = 1.2 * probe.mean;
    double nearest = 10;
    for (const FibreSample& s : samples) nearest = std::min(nearest, norm(s.at - X));
    EXPECT_EQ(norm(field.nearest(X).at - X), nearest);
  }
}

TEST(FibreSamples, RefuseAZeroDirection) {
  using Samples = std::vector<FibreSample>;
  EXPECT_THROW(FibreSamples(Samples{}), Error);
  EXPECT_THROW(FibreSamples(Samples{{{0, 0, 0}, {0, 0, 0}, {}}}), Error);
  EXPECT_THROW(FibreSamples(Samples{{{0, NAN, 0}, {1, 0, 0}, {}}}), Error);
}

TEST(FibreField, OfSamplesLiesInTheirPlane) {
  FibreField field;
  field.kind = FibreField::Kind::Sampled;
  field.families = 2;
  field.angle = 0.5;
  field.second = {0, 0, 1};
  field.samples = std::make_shared<const FibreSamples>(
      std::vector<FibreSample>{{{0, 0, 0}, {2, 0, 0}, {}}, {{1, 0, 0}, {0, 3, 0}, {1, 1, 0}}});
  const auto here = field.at({0.1, 0, 0}), there = field.at({0.9, 0, 0});
  EXPECT_NEAR(norm(here[0] - Vec3{std::cos(0.5), 0, std::sin(0.5)}), 0, 1e-15);
  EXPECT_NEAR(norm(here[1] - Vec3{std::cos(0.5), 0, -std::sin(0.5)}), 0, 1e-15);
  EXPECT_NEAR(norm(there[0] - Vec3{std::sin(0.5), std::cos(0.5), 0}), 0, 1e-15);
}

LawConstants muscle(const FibreField& field) {
  return {"holzapfel-gasser-ogden",
          {{"c", 3e3}, {"k1", 20e3}, {"k2", 1}, {"kappa", 0.05}, {"poisson", 0.45}},
          field};
}

FibreField constant_field() {
  FibreField field;
  field.first = {1, 1, 0};
  field.second = {0, 1, 0};
  field.angle = 0.3;
  field.families = 2;
  return field;
}

double pressed_force(const Body& body, const FibreField& field) {
  CampaignSettings s;
  s.materials = {{"tissue", muscle(field)}};
  s.indentation.depth = 0.001;
  s.indentation.increments = 2;
  s.indentation.lateral_depths.clear();
  const CampaignContext context(body, s, Engine::Direct);
  std::int32_t site = 0;
  while (body.response.is_site[to_index(site)] == 0) ++site;
  const SiteCurves curves = solve_site(context, site, nullptr);
  EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  return norm(curves.paths.front().samples.back().force);
}

TEST(FibreField, OfEqualSamplesPressesAsTheConstantOne) {
  const Body body = test::make_block(test::even(-0.01, 0.01, 4), test::even(-0.01, 0.01, 4),
                                     test::even(-0.01, 0, 2));
  const FibreField constant = constant_field();
  FibreField sampled = constant;
  sampled.kind = FibreField::Kind::Sampled;
  std::vector<FibreSample> samples = random_samples(50);
  for (FibreSample& s : samples) s = {0.01 * s.at, constant.first, {}};
  sampled.samples = std::make_shared<const FibreSamples>(samples);
  const double force = pressed_force(body, constant);
  EXPECT_NEAR(pressed_force(body, sampled) / force, 1, 1e-9);
  sampled.samples =
      std::make_shared<const FibreSamples>(std::vector<FibreSample>{{{0, 0, 0}, {0, 0, 1}, {}}});
  EXPECT_GT(std::abs(pressed_force(body, sampled) / force - 1), 0.01);  // directions matter
}

/// A quarter of a ring of radii 10 and 20 mm around the z axis, bent from a block.
Body quarter_ring(int cells) {
  Body body =
      test::make_block(test::even(0, 1, 2 * cells), test::even(0, 1, cells), test::even(0, 1, 2));
  test::deform(body, [](const Vec3& x) {
    const double r = 0.010 * (1 + x[1]), angle = 0.5 * M_PI * x[0];
    return Vec3{r * std::cos(angle), -r * std::sin(angle), 0.005 * x[2]};
  });
  return body;
}

FibreField between_the_ends() {
  FibreField field;
  field.kind = FibreField::Kind::Laplace;
  field.second = {0, 0, 1};
  field.from = {{0, -1e-6, -1}, {1, 1, 1}};
  field.to = {{-1e-6, -1, -1}, {1e-6, 1, 1}};
  return field;
}

/// phi = angle/(pi/2) is the potential between the ends: the fibres run around the axis.
TEST(FibreField, OfAPotentialRunsAroundABentBar) {
  double before = 1;
  for (const int cells : {3, 6}) {
    const Body body = quarter_ring(cells);
    const FibreField field = fibres_of_potential(body, 0, between_the_ends(), "ring");
    double worst = 0;
    for (const Tetrahedron& t : body.tetrahedra) {
      Vec3 X{};
      for (const std::int32_t node : t) X = X + 0.25 * body.nodes[to_index(node)];
      const Vec3 around = (1 / std::hypot(X[0], X[1])) * Vec3{X[1], -X[0], 0};
      worst = std::max(worst, 1 - dot(field.at(X)[0], around));
    }
    EXPECT_LT(std::acos(1 - worst), cells == 3 ? 0.25 : 0.13) << "rad";
    EXPECT_LT(std::acos(1 - worst), 0.7 * before);  // the gradient of linear elements: first order
    before = std::acos(1 - worst);
  }
}

TEST(FibreField, OfAPotentialPressesAsTheCylindricalOne) {
  const Body body = quarter_ring(6);
  FibreField around;
  around.kind = FibreField::Kind::Cylindrical;
  around.first = {0, 0, 1};
  const double force = pressed_force(body, around);
  EXPECT_NEAR(pressed_force(body, between_the_ends()) / force, 1, 0.01);
}

TEST(FibreField, OfAPotentialNeedsTwoSeparateEnds) {
  const Body body = quarter_ring(2);
  const auto message = [&](const FibreField& field) -> std::string {
    try {
      fibres_of_potential(body, 0, field, "ring");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  FibreField field = between_the_ends();
  field.to = {{1, 1, 1}, {2, 2, 2}};
  EXPECT_NE(message(field).find("where the fibres end"), std::string::npos) << message(field);
  field.to = field.from;
  EXPECT_NE(message(field).find("same part of the surface"), std::string::npos) << message(field);
  field = between_the_ends();
  field.from = {{1, 1, 1}, {2, 2, 2}};
  EXPECT_NE(message(field).find("where the fibres begin"), std::string::npos) << message(field);
}

TEST(FibreField, OfAPotentialReachesEveryPartOfTheRegion) {
  Body body =
      test::make_block(test::even(0, 0.04, 4), test::even(0, 0.01, 1), test::even(0, 0.01, 1));
  FibreField field;
  field.kind = FibreField::Kind::Laplace;
  field.from = {{-1, -1, -1}, {1e-6, 1, 1}};
  field.to = {{0.0099, -1, -1}, {0.0101, 1, 1}};
  EXPECT_NO_THROW(fibres_of_potential(body, 0, field, "bar"));
  // Without its second quarter the rest of the bar is an island.
  std::vector<Tetrahedron> outer;
  for (const Tetrahedron& t : body.tetrahedra) {
    double x = 0;
    for (const std::int32_t node : t) x += 0.25 * body.nodes[to_index(node)][0];
    if (x < 0.01 || x > 0.02) outer.push_back(t);
  }
  body.tetrahedra = outer;
  body.tetrahedron_region.resize(outer.size());
  EXPECT_THROW(fibres_of_potential(body, 0, field, "bar"), Error);
}

}  // namespace
}  // namespace palpate::fem
