// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies that are held, that rest on springs, that sag under their weight, and whose law ceases to
// be elliptic.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/indentation.hpp"
#include "fem/solve/preload.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

/// A wall of one cell between two faces that are held, under its weight along them: what is not
/// held hangs in between, u = rho g x (w - x)/(2 mu), for a neo-Hookean solid so at any strain, if
/// it can only move up and down. Its rim, held too, is felt like exp(-pi r/w).
TEST(Held, TheMiddleOfAWallBetweenTwoHeldFacesIsFree) {
  constexpr double kWidth = 0.01, kSide = 0.12, kWeight = 9810;
  const NeoHookean law = NeoHookean::from_young_poisson(10e3, 0.3, "t");
  Body body = test::make_block(test::even(0, kWidth, 1), test::even(0, kSide, 12),
                               test::even(0, kSide, 12));
  body.fixed_nodes.clear();
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    body.fixed_nodes.push_back(static_cast<std::int32_t>(i));  // they all lie on the two faces
  const SolidModel model(body, {law});
  const QuadraticMesh& mesh = model.mesh();
  std::vector<test::Prescribed> sideways;
  for (int node = 0; node < mesh.nodes(); ++node)
    for (int i = 0; i < 2 && model.equation(node) >= 0; ++i)
      sideways.push_back({model.equation(node) + i, 0});
  Displacement u = Displacement::Zero(3, mesh.nodes());
  const auto weight = [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, -kWeight); };
  test::equilibrate(model, test::body_loads(mesh, weight), sideways, u);
  const double hang = -kWeight * kWidth * kWidth / (8 * law.mu());
  int between = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    const Eigen::Vector3d off = mesh.X.col(node) - Eigen::Vector3d(kWidth, kSide, kSide) / 2;
    if (std::max(std::abs(off[1]), std::abs(off[2])) > 0.6 * kWidth) continue;
    const bool in_the_middle = std::abs(off[0]) < 1e-9;
    between += in_the_middle ? 1 : 0;
    EXPECT_NEAR(u(2, node), in_the_middle ? hang : 0, 3e-3 * std::abs(hang));
  }
  EXPECT_GT(between, 5);
}

/// A column along z from 0 to `height`, its base on springs instead of held.
Body sprung_column(double height, double normal_stiffness, double tangential_stiffness) {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, height, 4));
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    if (body.nodes[to_index(facet[0])][2] + body.nodes[to_index(facet[1])][2] +
            body.nodes[to_index(facet[2])][2] >
        0)
      continue;
    body.foundation.push_back(
        {static_cast<std::int32_t>(f), normal_stiffness, tangential_stiffness});
  }
  return body;
}

/// Prescribe two components everywhere as 0, and the third at the top.
std::vector<test::Prescribed> moved_top(const SolidModel& model, int axis, double value) {
  const double top = model.mesh().X.row(2).maxCoeff();
  std::vector<test::Prescribed> prescribed;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    for (int i = 0; i < 3; ++i) {
      const bool on_top = model.mesh().X(2, node) > top - 1e-9;
      if (i != axis) prescribed.push_back({model.equation(node) + i, 0});
      if (i == axis && on_top) prescribed.push_back({model.equation(node) + i, value});
    }
  return prescribed;
}

/// Confined to its cross-section a column is a spring of its own, and a Winkler foundation one in
/// series with it: P(lambda) = k w, w + (1 - lambda) H = d, with the neo-Hookean
/// P = mu/2 (2/3 lambda^(-5/3) (2 + lambda^2) - 2 lambda^(1/3)) + kappa/2 (1/lambda - lambda).
TEST(Foundation, UnderAConfinedColumnIsASpringInSeriesWithIt) {
  constexpr double kHeight = 0.04, kStiffness = 5e5, kArea = 4e-4;
  const double mu = 10e3 / 2.6, kappa = 10e3 / (3 * 0.4);
  const auto stress = [&](double l) {
    return mu * (std::pow(l, -5.0 / 3) * (2 + l * l) / 3 - std::cbrt(l)) +
           0.5 * kappa * (1 / l - l);
  };
  const auto energy = [&](double l) {
    return 0.5 * mu * (std::pow(l, -2.0 / 3) * (2 + l * l) - 3) +
           0.25 * kappa * (l * l - 1 - 2 * std::log(l));
  };
  const Body body = sprung_column(kHeight, kStiffness, 0);
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.3, "t")});
  for (const double d : {1e-5, 0.004, 0.012}) {
    double low = 0.2, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double l = 0.5 * (low + high);
      (stress(l) < kStiffness * (d - (1 - l) * kHeight) ? high : low) = l;
    }
    const double sunk = d - (1 - low) * kHeight;
    Displacement u = Displacement::Zero(3, model.mesh().nodes());
    test::equilibrate(model, test::Loads::Zero(3, model.mesh().nodes()), moved_top(model, 2, -d),
                      u);
    Eigen::VectorXd f;
    const double stored = model.forces(u, f).energy;
    double pushed = 0;
    for (int node = 0; node < model.mesh().nodes(); ++node) {
      if (model.mesh().X(2, node) < 1e-9) {
        EXPECT_NEAR(u(2, node), -sunk, 1e-6 * d) << d;
      }
      if (model.mesh().X(2, node) > kHeight - 1e-9) pushed -= f[model.equation(node) + 2];
    }
    EXPECT_NEAR(pushed, kArea * kStiffness * sunk, 1e-5 * pushed) << d;
    const double expected = kArea * (kHeight * energy(low) + 0.5 * kStiffness * sunk * sunk);
    EXPECT_NEAR(stored, expected, 1e-5 * expected) << d;
  }
}

/// At small strain: the sides of the column bear no load then.
TEST(Foundation, TangentialSpringsAreInSeriesWithAShearedColumn) {
  constexpr double kHeight = 0.04, kStiffness = 8e4, kShift = 1e-5;
  const double mu = 10e3 / 2.6;
  const SolidModel model(sprung_column(kHeight, 0, kStiffness),
                         {NeoHookean::from_young_poisson(10e3, 0.3, "t")});
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  test::equilibrate(model, test::Loads::Zero(3, model.mesh().nodes()), moved_top(model, 0, kShift),
                    u);
  const double expected = kShift * (mu / kHeight) / (mu / kHeight + kStiffness);
  for (int node = 0; node < model.mesh().nodes(); ++node) {
    if (model.mesh().X(2, node) > 1e-9) continue;
    EXPECT_NEAR(u(0, node), expected, 1e-4 * kShift);
  }
}

Body sprung_block(double stiffness) {
  Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                               test::even(-0.012, 0, 3));
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    const auto z = [&](std::size_t c) { return body.nodes[to_index(facet[c])][2]; };
    if (z(0) + z(1) + z(2) > -0.0359) continue;
    body.foundation.push_back({static_cast<std::int32_t>(f), stiffness, stiffness});
  }
  return body;
}

CampaignSettings pressing(const LawConstants& law) {
  CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  settings.indentation.tool.radius = 0.008;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = 20;
  settings.indentation.lateral_depths = {0.001};
  settings.indentation.lateral_travel = 0.001;
  settings.indentation.lateral_increments = 10;
  return settings;
}

SiteCurves press(const Body& body, const CampaignSettings& settings, Engine engine,
                 Displacement* pressed = nullptr) {
  return solve_site(CampaignContext(body, settings, engine), test::site_nearest(body), pressed);
}

void expect_same_forces(const SiteCurves& a, const SiteCurves& b, double tolerance) {
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t p = 0; p < a.paths.size(); ++p) {
    ASSERT_EQ(a.paths[p].samples.size(), b.paths[p].samples.size());
    const Vec3 x = a.paths[p].samples.back().force, y = b.paths[p].samples.back().force;
    EXPECT_LT(norm(x - y), tolerance * norm(x));
  }
}

TEST(Foundation, CarriesTheWholeForceOfTheToolAndStoresItsPartOfTheWork) {
  constexpr double kStiffness = 3e5;
  const Body body = sprung_block(kStiffness);
  const CampaignSettings settings = pressing({10e3, 0.45});
  Displacement u;
  const SiteCurves shared = press(body, settings, Engine::SharedFactor, &u);
  ASSERT_EQ(shared.status, SiteStatus::Complete) << shared.reason;
  expect_same_forces(press(body, settings, Engine::Direct), shared, 1e-3);
  const CurveSample& end = shared.paths.front().samples.back();
  // The mean of a quadratic field over a facet is that of its mid-edge values.
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  double carried = 0, stored = 0;
  for (const SprungFacet& sprung : body.foundation) {
    const Facet& facet = mesh.facets[to_index(sprung.facet)];
    constexpr double kFacet = 0.008 * 0.008 / 2;
    for (const std::size_t m : {3u, 4u, 5u}) {
      carried -= kStiffness * kFacet / 3 * u(2, facet[m]);
      stored += 0.5 * kStiffness * kFacet / 3 * u.col(facet[m]).squaredNorm();
    }
  }
  EXPECT_NEAR(-end.force[2], carried, 2e-3 * carried);
  EXPECT_GT(stored, 0.1 * end.tool_work);  // or the balance below would say nothing of it
  for (const CurvePath& path : shared.paths) {
    const CurveSample& last = path.samples.back();
    EXPECT_NEAR(last.tool_work, last.strain_energy + last.contact_energy, 5e-3 * last.tool_work);
  }
}

/// On springs far softer than itself a body moves as a rigid one: F = k A depth, but for what the
/// tool dents it.
TEST(Foundation, UnderAStiffBodyIsTheOnlySpring) {
  constexpr double kStiffness = 2e4, kArea = 0.032 * 0.032;
  CampaignSettings settings = pressing({1e6, 0.45});
  settings.indentation.increments = 5;
  settings.indentation.lateral_depths.clear();
  const SiteCurves site = press(sprung_block(kStiffness), settings, Engine::SharedFactor);
  ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
  // The tool passes 20 um before a point of the coarse facets meets it: slopes, not the first
  // force.
  const auto& samples = site.paths.front().samples;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    const double slope = (samples[i - 1].force[2] - samples[i].force[2]) /
                         (samples[i].displacement - samples[i - 1].displacement);
    EXPECT_LE(slope, kStiffness * kArea * (1 + 2e-3));
    EXPECT_GE(slope, 0.97 * kStiffness * kArea);
  }
}

Body column(double width, double height) {
  return test::make_block(test::even(0, width, 1), test::even(0, width, 1),
                          test::even(0, height, 8));
}

Displacement sagged(const Body& body, const LawConstants& law, const Gravity& gravity) {
  const SolidModel model(body, {make_law(law, "t")}, Dilatation::Pointwise, gravity);
  return equilibrium_under_weight(model, nested_dissection(model.pattern()), body.name);
}

/// Mean displacement of the top along z.
double top_displacement(const Body& body, const Displacement& u) {
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  double sum = 0;
  int count = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (mesh.X(2, node) < mesh.X.row(2).maxCoeff() - 1e-9) continue;
    sum += u(2, node);
    ++count;
  }
  return sum / count;
}

/// With nu = 0 and small strains u = -rho g/E (H Z - Z^2/2), which the elements hold exactly.
TEST(Gravity, AStandingColumnShortensAsInClosedForm) {
  constexpr double kHeight = 0.08, kYoung = 10e6, kDensity = 1000, kGravity = 9.81;
  const Body body = column(0.06, kHeight);
  const Displacement u = sagged(body, {kYoung, 0.0}, {{0, 0, -kGravity}, kDensity});
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  const double scale = kDensity * kGravity / kYoung * kHeight * kHeight / 2;
  for (int node = 0; node < mesh.nodes(); ++node) {
    const double Z = mesh.X(2, node);
    const double expected = -kDensity * kGravity / kYoung * (kHeight * Z - Z * Z / 2);
    EXPECT_NEAR(u(2, node), expected, 2e-4 * scale);
    EXPECT_NEAR(u(0, node), 0, 2e-4 * scale);
  }
}

/// Saint Venant-Kirchhoff with nu = 0 has no lateral stress: E/2 lambda (lambda^2 - 1) = +-rho g (H
/// - Z) at every height, at any strain.
TEST(Gravity, AHangingAndAStandingColumnAsInClosedFormAtLargeStrain) {
  constexpr double kHeight = 0.08, kYoung = 10e3, kDensity = 1000;
  const Body body = column(0.06, kHeight);
  const LawConstants law("saint-venant-kirchhoff", {{"young", kYoung}, {"poisson", 0}});
  for (const double g : {20.0, -10.0}) {
    const auto stretch = [&](double Z) {
      double low = 1 / std::sqrt(3.0), high = 3;
      for (int i = 0; i < 100; ++i) {
        const double l = 0.5 * (low + high);
        (0.5 * kYoung * l * (l * l - 1) < kDensity * g * (kHeight - Z) ? low : high) = l;
      }
      return low;
    };
    double expected = 0;
    constexpr int kSteps = 2000;  // by the midpoint rule
    for (int i = 0; i < kSteps; ++i)
      expected += (stretch((i + 0.5) * kHeight / kSteps) - 1) * kHeight / kSteps;
    const double found = top_displacement(body, sagged(body, law, {{0, 0, g}, kDensity}));
    EXPECT_NEAR(found, expected, 1e-3 * std::abs(expected)) << g;
    EXPECT_GT(std::abs(expected), 0.02 * kHeight);
  }
}

/// A slender column buckles under its own weight beyond H^3 = 7.837 E I/(rho g A) [Greenhill 1881].
TEST(Gravity, OfAColumnThatCannotStandIsAnErrorThatSaysSo) {
  constexpr double kWidth = 0.01, kYoung = 1e6, kDensity = 1000, kGravity = 9.81;
  const double greatest = std::cbrt(7.837 * kYoung * kWidth * kWidth / 12 / (kDensity * kGravity));
  const Gravity gravity{{0, 0, -kGravity}, kDensity};
  EXPECT_NO_THROW(sagged(column(kWidth, 0.9 * greatest), {kYoung, 0.0}, gravity));
  try {
    sagged(column(kWidth, 1.1 * greatest), {kYoung, 0.0}, gravity);
    FAIL() << "a column stood that cannot";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.what(), HasSubstr("no equilibrium beyond"));
  }
}

/// A press on a body that has sagged: work of the tool = change of the strain energy less the work
/// of gravity, both computed here by other means; forces count the tool alone.
TEST(Gravity, APressStartsFromTheSaggedBodyAndBalancesItsEnergy) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.024, 0, 4));
  CampaignSettings settings = pressing({4e3, 0.45});
  const SiteCurves light = press(body, settings, Engine::SharedFactor);
  settings.gravity = {{0, 3, -9.81}, 1000};
  const CampaignContext context(body, settings, Engine::SharedFactor);
  const double sag = -top_displacement(body, context.rest);
  EXPECT_GT(sag, 2e-4);
  Displacement u;
  const SiteCurves heavy = solve_site(context, test::site_nearest(body), &u);
  ASSERT_EQ(heavy.status, SiteStatus::Complete) << heavy.reason;
  expect_same_forces(press(body, settings, Engine::Direct), heavy, 1e-3);

  const SolidModel weightless(body, {make_law({4e3, 0.45}, "t")});
  const auto loads = test::body_loads(make_quadratic_mesh(body), [](const Eigen::Vector3d&) {
    return Eigen::Vector3d(0, 3000, -9810);
  });
  const double gravity_work = loads.cwiseProduct(u - context.rest).sum();
  const double strain = weightless.energy(u).energy - weightless.energy(context.rest).energy;
  const CurvePath& path = heavy.paths.front();
  const CurveSample& end = path.samples.back();
  EXPECT_GT(gravity_work, 0.02 * end.tool_work);  // or the balance would not see it
  EXPECT_NEAR(end.tool_work + gravity_work, strain + end.contact_energy, 5e-3 * end.tool_work);
  EXPECT_NEAR(end.strain_energy, strain - gravity_work, 1e-6 * end.tool_work);
  for (const CurvePath& each : heavy.paths) {
    const CurveSample& last = each.samples.back();
    EXPECT_NEAR(last.tool_work, last.strain_energy + last.contact_energy, 5e-3 * last.tool_work);
  }
  // From the sagged surface on, not from where it was: there the tool would have met nothing.
  EXPECT_EQ(path.samples.front().displacement, 0);
  EXPECT_EQ(norm(path.samples.front().force), 0);
  EXPECT_EQ(path.samples.front().strain_energy, 0);
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    const double without = norm(light.paths.front().samples[i].force);
    EXPECT_NEAR(norm(path.samples[i].force), without, 0.15 * without);
    EXPECT_NE(norm(path.samples[i].force), without);
  }
}

/// The tool passes 20 um before a point of the coarse facets meets it: the sagged body, whose
/// forces balance but for round-off, is in equilibrium all the same.
TEST(Gravity, AToolThatMeetsNothingYetHasNoForce) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.024, 0, 4));
  CampaignSettings settings = pressing({4e3, 0.45});
  settings.gravity = {{0, 0, -9.81}, 1000};
  settings.indentation.depth = 5e-6;
  settings.indentation.increments = 2;
  settings.indentation.lateral_depths.clear();
  for (const Engine engine : {Engine::Direct, Engine::SharedFactor}) {
    const SiteCurves site = press(body, settings, engine);
    ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
    EXPECT_EQ(norm(site.paths.front().samples.back().force), 0);
  }
}

/// I1 alone, softening: simple shear loses ellipticity at k = 0.35. The neo-Hookean solid of the
/// same modulus keeps it at every depth.
TEST(Indentation, EndsWhereTheLawLosesEllipticity) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.012, 0, 3));
  CampaignSettings settings =
      pressing({"yeoh", {{"C10", 1.5e3}, {"C20", -2.5e3}, {"C30", 1.6e3}, {"poisson", 0.45}}});
  settings.indentation.depth = 0.005;
  settings.indentation.lateral_depths.clear();
  const SiteCurves softening = press(body, settings, Engine::SharedFactor);
  EXPECT_EQ(softening.status, SiteStatus::Partial);
  EXPECT_THAT(softening.reason, HasSubstr("strong ellipticity is lost in the element at ("));
  EXPECT_THAT(softening.reason, HasSubstr("normal path at "));
  const auto& kept = softening.paths.front().samples;
  EXPECT_GT(kept.size(), 2u);
  EXPECT_LT(kept.back().displacement, 0.005);
  settings.materials[0].law = {2 * 1.45 * 3e3, 0.45};
  const SiteCurves sound = press(body, settings, Engine::SharedFactor);
  EXPECT_EQ(sound.status, SiteStatus::Complete) << sound.reason;
}

/// The same of a patch that is moved as a whole, as decks for other programs have it.
TEST(Indentation, OfAPatchEndsThereToo) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.012, 0, 3));
  CampaignSettings settings =
      pressing({"yeoh", {{"C10", 1.5e3}, {"C20", -2.5e3}, {"C30", 1.6e3}, {"poisson", 0.45}}});
  settings.indentation.depth = 0.005;
  const PatchCurve softening = press_patch(body, settings, test::site_nearest(body), 0.0081);
  EXPECT_THAT(softening.reason, HasSubstr("strong ellipticity is lost in the element at ("));
  EXPECT_GT(softening.samples.size(), 2u);
  EXPECT_LT(softening.samples.back().depth, 0.005);
  settings.materials[0].law = {2 * 1.45 * 3e3, 0.45};
  const PatchCurve sound = press_patch(body, settings, test::site_nearest(body), 0.0081);
  EXPECT_EQ(sound.reason, "");
  EXPECT_EQ(sound.samples.size(), 21u);
}

}  // namespace
}  // namespace palpate::fem
