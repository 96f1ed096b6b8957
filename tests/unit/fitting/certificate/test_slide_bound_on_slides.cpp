// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds against numerical derivatives of the force and numerical slides.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "fitting/certificate/certify.hpp"
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

TEST(StickBound, NoJacobianIsSteeper) {
  std::mt19937 engine(31);
  std::uniform_real_distribution<double> u(0, 1);
  double closest = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Library library = random_triangle(engine, 0.2, 0.5);
    if (trial % 2 == 1) lean(library, engine, 0.2);
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
    if (trial % 2 == 1) lean(library, engine, 0.2);
    if (trial % 4 >= 2) soften(library, engine, 0.4);
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

/// Random slides over random triangles, whose responses `shape` makes of another kind; it is given
/// the number of the triangle.
template <class Shape>
SlideCensus census_of(unsigned seed, double spread, const Shape& shape) {
  std::mt19937 engine(seed);
  SlideCensus census;
  for (const double mu : {0.1, 0.3, 0.6}) {
    for (int trial = 0; trial < 40; ++trial) {
      Library library = random_triangle(engine, 0.03, spread + 2 * spread * (trial % 3));
      shape(library, engine, trial);
      CertifySettings settings;
      settings.friction = mu;
      certify(library, settings);
      if (std::isinf(library.certificate.slip)) continue;
      try_slides(engine, library, mu, census);
    }
  }
  EXPECT_GT(census.slides, 10000);
  return census;
}

TEST(SlipBound, NoSlidingPathIsSteeper) {
  const SlideCensus census = census_of(37, 0.1, [](Library&, std::mt19937&, int) {});
  EXPECT_GT(census.closest, 0.85);  // and the bound is not idle
}

TEST(SlipBound, NoCoupledSlidingPathIsSteeper) {
  const SlideCensus census = census_of(
      39, 0.05, [](Library& library, std::mt19937& engine, int) { couple(library, engine, 0.1); });
  EXPECT_GT(census.closest, 0.85);
}

TEST(SlipBound, NoSlidingPathIsSteeperWherePressesLean) {
  const SlideCensus census =
      census_of(40, 0.05, [](Library& library, std::mt19937& engine, int trial) {
        if (trial % 2 == 0) couple(library, engine, 0.1);
        lean(library, engine, 0.1);
      });
  EXPECT_GT(census.closest, 0.75);
}

TEST(SlipBound, NoSlidingPathIsSteeperWhereResponsesHaveSoftAxes) {
  const SlideCensus census =
      census_of(42, 0.05, [](Library& library, std::mt19937& engine, int trial) {
        couple(library, engine, 0.1);
        if (trial % 2 == 0) lean(library, engine, 0.1);
        soften(library, engine, 0.4);
      });
  EXPECT_GT(census.closest, 0.75);
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
    if (trial % 5 == 0) lean(library, engine, 0.02);
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
