// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fem/campaign/campaign_cache.hpp"
#include "fem/campaign/indentation.hpp"
#include "fem/campaign/sensitivity.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/tangent_solver.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A soft block on a stiffer base layer.
Body layered() {
  Body body = test::make_block(test::even(-0.02, 0.02, 6), test::even(-0.02, 0.02, 6),
                               test::even(-0.018, 0, 4));
  body.region_names = {"top", "base"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    double z = 0;
    for (const std::int32_t n : body.tetrahedra[t]) {
      z += 0.25 * body.nodes[static_cast<std::size_t>(n)][2];
    }
    body.tetrahedron_region[t] = z < -0.009 ? 1 : 0;
  }
  return body;
}

CampaignSettings settings_of(const Body& body, double top, double base, double poisson) {
  CampaignSettings settings;
  settings.materials = {{"top", {top, poisson}}, {"base", {base, 0.45}}};
  settings.indentation.tool.radius = 0.008;
  settings.indentation.depth = 0.003;
  settings.indentation.increments = 3;
  settings.indentation.force_tolerance = 1e-8;
  settings.sites = {test::site_nearest(body)};
  return settings;
}

const std::vector<double> kDepths{0.001, 0.003};

const std::vector<RegionConstant> kConstants{
    {"top", "young"}, {"base", "young"}, {"top", "poisson"}};
constexpr double kTop = 8e3, kBase = 20e3, kPoisson = 0.45;

/// A site with the derivatives by kConstants, and without them with one constant at a time slightly
/// larger and slightly smaller.
struct Differences {
  SiteSensitivity exact;
  std::array<std::array<SiteSensitivity, 2>, 3> varied;
  std::array<double, 3> width;  ///< between the two
};

/// `run(top, base, poisson, constants)`; moduli differ by the fraction h, Poisson's ratio by k.
template <typename Run>
Differences by_differences(const Run& run, double h, double k) {
  return {run(kTop, kBase, kPoisson, kConstants),
          {{{run(kTop * (1 + h), kBase, kPoisson, {}), run(kTop * (1 - h), kBase, kPoisson, {})},
            {run(kTop, kBase * (1 + h), kPoisson, {}), run(kTop, kBase * (1 - h), kPoisson, {})},
            {run(kTop, kBase, kPoisson + k, {}), run(kTop, kBase, kPoisson - k, {})}}},
          {2 * h * kTop, 2 * h * kBase, 2 * k}};
}

TEST(Sensitivity, IsTheDerivativeByDifferences) {
  const Body body = layered();
  const double top = kTop, base = kBase, nu = kPoisson;
  const auto exact =
      run_sensitivity(body, settings_of(body, top, base, nu), kDepths, kConstants).front();
  ASSERT_EQ(exact.samples.size(), 2U);
  const auto force = [&](double a, double b, double c, std::size_t sample) {
    return run_sensitivity(body, settings_of(body, a, b, c), kDepths, {})
        .front()
        .samples[sample]
        .force;
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const double h = 1e-3;
    const double by_top =
        (force(top * (1 + h), base, nu, i) - force(top * (1 - h), base, nu, i)) / (2 * h * top);
    const double by_base =
        (force(top, base * (1 + h), nu, i) - force(top, base * (1 - h), nu, i)) / (2 * h * base);
    const double by_nu = (force(top, base, nu + 1e-4, i) - force(top, base, nu - 1e-4, i)) / 2e-4;
    EXPECT_NEAR(exact.samples[i].slope[0], by_top, 1e-4 * std::abs(by_top));
    EXPECT_NEAR(exact.samples[i].slope[1], by_base, 1e-4 * std::abs(by_base));
    EXPECT_NEAR(exact.samples[i].slope[2], by_nu, 1e-3 * std::abs(by_nu));
  }
}

/// Euler's theorem: the forces are homogeneous of degree one in the moduli of all regions.
TEST(Sensitivity, OfRefinedElementsIsHomogeneous) {
  const Body body = layered();
  CampaignSettings settings = settings_of(body, kTop, kBase, kPoisson);
  const auto coarse = run_sensitivity(body, settings, kDepths, {}).front();
  settings.indentation.refine_under_tool = IndentationSettings::kByContact;
  settings.indentation.force_tolerance = 1e-7;
  // A mesh on which no point of a facet enters the contact between the states that are compared.
  settings.indentation.size_over_contact = 1.5;
  const auto fine = run_sensitivity(body, settings, kDepths, kConstants).front();
  ASSERT_EQ(fine.samples.size(), 2U) << fine.reason;
  for (std::size_t i = 0; i < 2; ++i) {
    const ForceSensitivity& s = fine.samples[i];
    EXPECT_NEAR(kTop * s.slope[0] + kBase * s.slope[1], s.force, 2e-4 * s.force);
    EXPECT_GT(std::abs(s.force - coarse.samples[i].force), 1e-3 * s.force);  // another mesh
    EXPECT_GT(s.slope[2], 0);  // a tool in a thin layer meets its bulk
  }
  // No slip: the ties of all increments are made anew for each difference.
  settings.indentation.friction = ToolFriction::NoSlip;
  const auto tied = run_sensitivity(body, settings, kDepths, kConstants).front();
  ASSERT_EQ(tied.samples.size(), 2U) << tied.reason;
  const ForceSensitivity& s = tied.samples[1];
  EXPECT_NEAR(kTop * s.slope[0] + kBase * s.slope[1], s.force, 1e-3 * s.force);
}

TEST(Sensitivity, HoldsForConstantsOfAnyLaw) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.012, 0, 3));
  const auto settings = [&](double alpha, double mu) {
    CampaignSettings s = settings_of(body, 1, 1, 0.45);
    s.materials = {{"tissue", {"ogden-1", {{"mu_1", mu}, {"alpha_1", alpha}, {"poisson", 0.45}}}}};
    return s;
  };
  const auto force = [&](double alpha, double mu) {
    return run_sensitivity(body, settings(alpha, mu), {0.003}, {}).front().samples.front().force;
  };
  const double alpha = -4.7, mu = 3e3, h = 1e-3;
  const auto exact = run_sensitivity(body, settings(alpha, mu), {0.003},
                                     {{"tissue", "alpha_1"}, {"tissue", "mu_1"}})
                         .front();
  ASSERT_EQ(exact.samples.size(), 1U) << exact.reason;
  const double by_alpha = (force(alpha + h, mu) - force(alpha - h, mu)) / (2 * h);
  EXPECT_NEAR(exact.samples[0].slope[0], by_alpha, 1e-3 * std::abs(by_alpha));
  // The force is proportional to the only modulus.
  EXPECT_NEAR(mu * exact.samples[0].slope[1], exact.samples[0].force,
              1e-6 * exact.samples[0].force);
}

/// Scale all moduli and the force scales: Euler's theorem for a homogeneous function of degree one.
TEST(Sensitivity, ModuliObeyEulersTheorem) {
  const Body body = layered();
  const double top = 8e3, base = 20e3;
  const auto site = run_sensitivity(body, settings_of(body, top, base, 0.45), kDepths,
                                    {{"top", "young"}, {"base", "young"}})
                        .front();
  for (const ForceSensitivity& s : site.samples) {
    EXPECT_GT(s.force, 0);
    EXPECT_NEAR(top * s.slope[0] + base * s.slope[1], s.force, 1e-6 * s.force);
    EXPECT_GT(s.slope[0], 0);
    EXPECT_GT(s.slope[1], 0);
  }
}

/// A lateral path starts from a state that depends on the constants as well: leave that out and the
/// differences tell.
TEST(Sensitivity, OfALateralPathIsTheDerivativeByDifferences) {
  const Body body = layered();
  const std::vector<std::vector<LateralPlan>> plans{
      {{0.002, {0.6, 0.8, 0}, {0.0005, 0.001}}, {0.003, {-1, 0, 0}, {0.001}}}};
  const auto run = [&](double top, double base, double nu,
                       const std::vector<RegionConstant>& constants) {
    CampaignSettings settings = settings_of(body, top, base, nu);
    settings.indentation.force_tolerance = 1e-6;
    return run_sensitivity(body, settings, {0.003}, constants, plans).front();
  };
  const Differences both = by_differences(run, 1e-3, 1e-3);
  const SiteSensitivity& exact = both.exact;
  ASSERT_EQ(exact.lateral.size(), 2U) << exact.reason;
  ASSERT_EQ(exact.lateral[0].size(), 2U) << exact.reason;
  ASSERT_EQ(exact.lateral[1].size(), 1U) << exact.reason;
  for (std::size_t path = 0; path < 2; ++path) {
    for (std::size_t i = 0; i < exact.lateral[path].size(); ++i) {
      const ForceSensitivity& s = exact.lateral[path][i];
      EXPECT_GT(s.force, 0);
      for (std::size_t c = 0; c < 3; ++c) {
        const double wanted =
            (both.varied[c][0].lateral[path][i].force - both.varied[c][1].lateral[path][i].force) /
            both.width[c];
        // Beside the truncation: the forces are known to three tolerances of the solver.
        const double noise = 2 * 3e-6 * s.force / both.width[c];
        EXPECT_NEAR(s.slope[c], wanted, 2e-3 * std::abs(wanted) + noise) << path << i << c;
      }
      EXPECT_NEAR(kTop * s.slope[0] + kBase * s.slope[1], s.force, 1e-4 * s.force);  // Euler
    }
  }
}

/// On a no-slip path the positions at which the surface is tied depend on the constants, too.
TEST(Sensitivity, OfANoSlipPathIsTheDerivativeByDifferences) {
  const Body body = layered();
  const std::vector<std::vector<LateralPlan>> plans{{{0.002, {0.6, 0.8, 0}, {0.001}}}};
  const auto run = [&](double top, double base, double nu,
                       const std::vector<RegionConstant>& constants) {
    CampaignSettings settings = settings_of(body, top, base, nu);
    settings.indentation.friction = ToolFriction::NoSlip;
    settings.indentation.force_tolerance = 1e-7;
    return run_sensitivity(body, settings, kDepths, constants, plans).front();
  };
  const Differences both = by_differences(run, 1e-4, 1e-4);
  const SiteSensitivity& exact = both.exact;
  ASSERT_EQ(exact.samples.size(), 2U) << exact.reason;
  ASSERT_EQ(exact.lateral[0].size(), 1U) << exact.reason;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto compare = [&](const ForceSensitivity& s, double more, double less) {
      const double wanted = (more - less) / both.width[c];
      const double noise = 2 * 3e-7 * s.force / both.width[c];
      EXPECT_NEAR(s.slope[c], wanted, 2e-3 * std::abs(wanted) + noise) << c << ' ' << s.depth;
    };
    for (std::size_t i = 0; i < 2; ++i)
      compare(exact.samples[i], both.varied[c][0].samples[i].force,
              both.varied[c][1].samples[i].force);
    compare(exact.lateral[0][0], both.varied[c][0].lateral[0][0].force,
            both.varied[c][1].lateral[0][0].force);
  }
  for (const ForceSensitivity& s : exact.samples)
    EXPECT_NEAR(kTop * s.slope[0] + kBase * s.slope[1], s.force, 1e-4 * s.force);  // Euler
}

/// In a deep press the tangent is far from that at rest.
TEST(Sensitivity, SolvesWithTheTangentAsAFactorOfItDoes) {
  const Body body = layered();
  CampaignSettings settings = settings_of(body, 8e3, 20e3, 0.49);
  settings.indentation.azimuths.clear();
  settings.indentation.lateral_depths.clear();
  const CampaignContext context(body, settings, Engine::SharedFactor);
  SolvePool pool(*context.rest_factor, 1);
  SolvePool::Member member(pool);
  const Vec3 site = context.press_point(settings.sites.front()).position;
  const SolidModel window = window_at(context.model, to_eigen(site), context.indentation.tool);
  TangentSolver solver(context.model, window,
                       [&](const Eigen::VectorXd& b, Eigen::VectorXd& x) { member.solve(b, x); });
  SiteSolver paths(context, &member);
  int compared = 0;
  paths.observe([&](const ToolContact& contact, const Displacement& u, const CurveSample&) {
    ASSERT_TRUE(solver.linearize(contact, u));
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(context.model.pattern().n, -1, 2);
    Eigen::VectorXd x, exact(b.size());
    ASSERT_TRUE(solver.solve(b, x));
    Cholesky factor(context.model.pattern(), &context.permutation);
    ASSERT_TRUE(factor.factorize(solver.values()));
    SolveWorkspace workspace;
    factor.solve(b.data(), exact.data(), workspace);
    EXPECT_LT((x - exact).norm(), 1e-5 * exact.norm());
    ++compared;
  });
  paths.solve(settings.sites.front());
  EXPECT_EQ(compared, 3);
  EXPECT_LT(solver.iterations(), 30 * compared);
}

/// Constants are tried one after the other with what was made for the first: the answers are those
/// of calls that know nothing of each other, and the body is factorized only where it must be.
TEST(Sensitivity, ReusesAFactorWhileItServes) {
  const Body body = layered();
  const std::vector<RegionConstant> constants{{"top", "young"}, {"base", "young"}};
  struct Trial {
    double top, base, poisson;
    int factorizations;
  };
  CampaignCache cache;
  for (const Trial& t :
       {Trial{8e3, 20e3, 0.45, 1}, Trial{24e3, 60e3, 0.45, 1}, Trial{24e3, 70e3, 0.45, 1},
        Trial{24e3, 70e3, 0.49, 2}, Trial{6e3, 70e3, 0.49, 3}, Trial{0.6e3, 7e3, 0.49, 3}}) {
    const CampaignSettings settings = settings_of(body, t.top, t.base, t.poisson);
    const auto reused = run_sensitivity(body, settings, kDepths, constants, {}, &cache).front();
    const auto alone = run_sensitivity(body, settings, kDepths, constants).front();
    EXPECT_EQ(cache.factors.factorizations(), t.factorizations) << t.top << ' ' << t.base;
    ASSERT_EQ(reused.samples.size(), kDepths.size()) << reused.reason;
    for (std::size_t i = 0; i < kDepths.size(); ++i) {
      const ForceSensitivity &a = reused.samples[i], &b = alone.samples[i];
      EXPECT_NEAR(a.force, b.force, 1e-7 * b.force);
      for (std::size_t c = 0; c < constants.size(); ++c)
        EXPECT_NEAR(a.slope[c], b.slope[c], 1e-5 * std::abs(b.slope[c]));
    }
  }
}

TEST(Sensitivity, RefusesARegionWithoutMaterial) {
  const Body body = layered();
  EXPECT_THROW(
      run_sensitivity(body, settings_of(body, 1e4, 1e4, 0.4), kDepths, {{"skin", "young"}}), Error);
}

}  // namespace
}  // namespace palpate::fem
