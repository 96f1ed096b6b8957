// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds against numerical derivatives of the force and numerical slides.
#include "fitting/certificate/slide_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "fitting/certificate/certify.hpp"
#include "tests/support/units.hpp"
#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

Eigen::Matrix3d jacobian(const PlainModel& model, const Start& start) {
  Eigen::Matrix3d J;
  constexpr double kStep = 1e-7;
  for (int j = 0; j < 3; ++j) {
    Vec3 e{};
    e[static_cast<std::size_t>(j)] = kStep;
    const Vec3 difference = model.at(start.x + e, start.c, start.d0).force -
                            model.at(start.x - e, start.c, start.d0).force;
    for (int i = 0; i < 3; ++i) J(i, j) = difference[static_cast<std::size_t>(i)] / (2 * kStep);
  }
  return J;
}

TEST(Bounds, AreStiffnessesInAnyUnits) {
  // Of every formula of the bounds only those whose dimensions agree pass this.
  std::mt19937 engine(35);
  constexpr double kForce = 1.0 / 64, kLength = 8, kDepth = 0.008;
  int bounded = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Library library = random_triangle(engine, 0.04, 0.1 + 0.1 * (trial % 3));
    if (trial % 2 == 1) couple(library, engine, 0.1);
    const Library other = test::in_units(library, {kForce, kLength});
    const double mu = 0.2 * (trial % 4);
    const ContactElement here = contact_element(library, 0, kDepth, mu);
    const ContactElement there = contact_element(other, 0, kLength * kDepth, mu);
    const auto expect_same = [&](double in_these, double in_others) {
      if (std::isinf(in_these)) {
        EXPECT_TRUE(std::isinf(in_others));
      } else {
        EXPECT_NEAR(in_others * (kLength / kForce), in_these, 1e-9 * in_these);
      }
    };
    expect_same(stick_bound(here), stick_bound(there));
    expect_same(min_lipschitz_bound(here), min_lipschitz_bound(there));
    EXPECT_EQ(slide_lowers_energy(here), slide_lowers_energy(there));
    const SlideBound a = slide_bound(here), b = slide_bound(there);
    expect_same(a.total, b.total);
    expect_same(a.causes.stiffness, b.causes.stiffness);
    expect_same(a.causes.variation, b.causes.variation);
    expect_same(a.causes.slant, b.causes.slant);
    expect_same(a.causes.curvature, b.causes.curvature);
    bounded += std::isfinite(a.total) ? 1 : 0;
    if (!(mu > 0)) continue;
    const Range azimuth{0.4, 0.5}, z{0.0031, 0.0033}, reach{0.0033, 0.006};
    const auto larger = [&](const Range& range) {
      return Range{kLength * range.low, kLength * range.high};
    };
    SlideCell cell, scaled;
    cell.azimuth = scaled.azimuth = azimuth;
    cell.z = z, cell.reach = reach, scaled.z = larger(z), scaled.reach = larger(reach);
    expect_same(SlideJacobian(here).bound(cell), SlideJacobian(there).bound(scaled));
  }
  EXPECT_GT(bounded, 30);
}

TEST(StickBound, NoJacobianIsSteeper) {
  std::mt19937 engine(31);
  std::uniform_real_distribution<double> u(0, 1);
  double closest = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Library library = random_triangle(engine, 0.2, 0.5);
    certify(library, {});
    const PlainModel model(library, 0);
    for (int i = 0; i < 250; ++i) {
      const Start start = random_start(engine, model, 0.012,
                                       [&](const Vec3&, double) { return 0.006 * u(engine); });
      const Eigen::Matrix3d J = jacobian(model, start);
      const double lipschitz_bound = Eigen::JacobiSVD<Eigen::Matrix3d>(J).singularValues()[0];
      EXPECT_LE(lipschitz_bound, library.certificate.stick * (1 + 1e-5));
      closest = std::max(closest, lipschitz_bound / library.certificate.stick);
    }
  }
  EXPECT_GT(closest, 0.95);  // reached at a vertex, where the stiffest curve stands alone
}

TEST(StickBound, NoCoupledJacobianWithinTheSlipLimitIsSteeper) {
  std::mt19937 engine(33);
  std::uniform_real_distribution<double> u(0, 1);
  double closest = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Library library = random_triangle(engine, 0.2, 0.5);
    couple(library, engine, 0.2);
    CertifySettings settings;
    settings.friction = 0.1 + 0.2 * (trial % 4);
    certify(library, settings);
    const PlainModel model(library, 0);
    double steepest = 0;
    for (int i = 0; i < 250; ++i) {
      const auto up_to_slip = [&](const Vec3& c, double z) {
        const Vec3 n = model.direction(c);
        return u(engine) * model.slip_limit(c, z, settings.friction * model.at(c + z * n, c, 0).g);
      };
      const Start start = random_start(engine, model, library.certificate.depth, up_to_slip);
      const Eigen::Matrix3d J = jacobian(model, start);
      steepest = std::max(steepest, Eigen::JacobiSVD<Eigen::Matrix3d>(J).singularValues()[0]);
    }
    EXPECT_LE(steepest, library.certificate.stick * (1 + 1e-5));
    EXPECT_GE(steepest, 0.5 * library.certificate.stick);  // no idle bound
    closest = std::max(closest, steepest / library.certificate.stick);
  }
}

TEST(SlipBound, NoSlidingPathIsSteeper) {
  std::mt19937 engine(37);
  SlideCensus census;
  for (const double mu : {0.1, 0.3, 0.6}) {
    for (int trial = 0; trial < 40; ++trial) {
      Library library = random_triangle(engine, 0.03, 0.1 + 0.2 * (trial % 3));
      CertifySettings settings;
      settings.friction = mu;
      certify(library, settings);
      if (std::isinf(library.certificate.slip)) continue;
      try_slides(engine, library, mu, census);
    }
  }
  EXPECT_GT(census.slides, 10000);
  EXPECT_GT(census.closest, 0.85);  // and the bound is not idle
}

TEST(SlipBound, NoCoupledSlidingPathIsSteeper) {
  std::mt19937 engine(39);
  SlideCensus census;
  int bounded = 0;
  for (const double mu : {0.1, 0.3, 0.6}) {
    for (int trial = 0; trial < 40; ++trial) {
      Library library = random_triangle(engine, 0.03, 0.05 + 0.1 * (trial % 3));
      couple(library, engine, 0.1);
      CertifySettings settings;
      settings.friction = mu;
      certify(library, settings);
      if (std::isinf(library.certificate.slip)) continue;
      ++bounded;
      try_slides(engine, library, mu, census);
    }
  }
  EXPECT_GT(census.slides, 10000);
  EXPECT_GT(census.closest, 0.85);
}

TEST(SlipBound, SlantedPlateHasAClosedForm) {
  // Equal springs k (normal) and r (lateral), all directions leaning by theta against the facet:
  // nothing changes along the surface, yet the contact point runs down the slope. With t along the
  // slope, q = n . tau = sin(theta) (tau downhill), p = cos(theta):
  //   f' = k (n + mu t)(n - q w) . x',  w = (r t - mu k n)/(r p - mu k q).
  constexpr double kTheta = 0.15;
  constexpr double k = 200;
  constexpr double r = 120;
  constexpr double mu = 0.4;
  Library library = flat_triangle();
  library.inward.assign(3, {std::sin(kTheta), 0, -std::cos(kTheta)});
  set_equal_responses(library, node_response(linear_curve(k), linear_curve(r)));
  CertifySettings settings;
  settings.friction = mu;
  certify(library, settings);

  const double q = std::sin(kTheta);
  const double scale = 1 / (r * std::cos(kTheta) - mu * k * q);
  const double along_n = 1 + q * mu * k * scale;
  const double along_t = -q * r * scale;
  const double steepest = k * std::hypot(1.0, mu) * std::hypot(along_n, along_t);

  const PlainModel model(library, 0);
  const Vec3 n = model.direction({0.003, 0.003, 0});
  const Vec3 t{std::cos(kTheta), 0, std::sin(kTheta)};
  const Start start{
      {0.003, 0.003, 0}, Vec3{0.003, 0.003, 0} + 0.004 * n + (mu * k * 0.004 / r) * t, 0};
  // The steepest direction, or its opposite, makes the contact point slide forward.
  const Vec3 step = -1e-7 * unit(along_n * n + along_t * t);
  const auto c = model.slid(start.x + step, start.c, 0, mu);
  ASSERT_TRUE(c);
  ASSERT_GT(norm(*c - start.c), 1e-9);
  const Vec3 difference =
      model.at(start.x + step, *c, 0).force - model.at(start.x, start.c, 0).force;
  EXPECT_NEAR(norm(difference) / norm(step), steepest, 1e-3 * steepest);
  EXPECT_GT(steepest, 1.05 * k * std::hypot(1.0, mu));  // steeper than the level plate
  EXPECT_GE(library.certificate.slip, steepest);
  // Slides aslant are a little steeper than down the slope; sets of states are halved to 1.1.
  const ContactElement element = contact_element(library, 0, library.certificate.depth, mu);
  std::mt19937 engine(29);
  double steepest_anywhere = steepest;
  for (int i = 0; i < 60; ++i) {
    const SlidingState state = random_slide(engine, model, element);
    steepest_anywhere =
        std::max(steepest_anywhere, steepest_step(engine, model, state.start, settings.friction));
  }
  EXPECT_LE(library.certificate.slip, 1.11 * steepest_anywhere);
}

TEST(SlipBound, HoldsOnTheTrianglesOfASphere) {
  std::mt19937 engine(41);
  Library library = sphere(0.04, 2);
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    library.responses.push_back(random_response(engine, 0.1));
  }
  CertifySettings settings;
  settings.friction = 0.3;
  certify(library, settings);
  SlideCensus census;
  for (std::size_t m = 0; m < library.triangles.size(); m += 7) {
    Library one = library;
    one.triangles = {library.triangles[m]};
    one.certificate.stick = library.certificate.triangles[m].stick;
    one.certificate.slip = library.certificate.triangles[m].slip;
    if (std::isinf(one.certificate.slip)) continue;
    try_slides(engine, one, settings.friction, census);
  }
  EXPECT_GT(census.slides, 1000);
}

/// Energy before and after a slide at a fixed tool position: c moves by rho - rho_s.
struct EnergyStep {
  double before = 0, after = 0;
};

std::optional<EnergyStep> slide_once(std::mt19937& engine, const PlainModel& model, double depth,
                                     double mu) {
  constexpr double kExcess = 1e-6;
  const Start start = random_start(engine, model, depth, [&](const Vec3& c, double z) {
    const Vec3 n = model.direction(c);
    return model.slip_limit(c, z, mu * model.at(c + z * n, c, 0).g) + kExcess;
  });
  const Contact before = model.at(start.x, start.c, start.d0);
  const Vec3 c = start.c + kExcess * model.in_plane(before.t);
  if (!model.inside(c)) return std::nullopt;
  return EnergyStep{before.energy, model.at(start.x, c, start.d0).energy};
}

TEST(SlidingPassive, NoSlideRaisesTheEnergyWhereItIsCertified) {
  std::mt19937 engine(43);
  int certified = 0;
  int slides = 0;
  int rises_elsewhere = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double mu = 0.2 + 0.2 * (trial % 3);
    Library library = random_triangle(engine, 0.02, 0.05 + 0.15 * (trial % 4));
    CertifySettings settings;
    settings.friction = mu;
    certify(library, settings);
    const PlainModel model(library, 0);
    const bool passive = library.certificate.triangles[0].sliding_passive;
    certified += passive ? 1 : 0;
    for (int i = 0; i < 200; ++i) {
      const auto step = slide_once(engine, model, library.certificate.depth, mu);
      if (!step) continue;
      if (passive) {
        EXPECT_LE(step->after, step->before + 1e-16);
        ++slides;
      } else if (step->after > step->before) {
        ++rises_elsewhere;
      }
    }
  }
  EXPECT_GT(certified, 30);
  EXPECT_GT(slides, 5000);
  EXPECT_GT(rises_elsewhere, 0);  // the condition distinguishes triangles
}

}  // namespace
}  // namespace palpate::fitting
