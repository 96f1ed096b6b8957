// SPDX-License-Identifier: AGPL-3.0-or-later
// The element and the assembled body: forces and stiffness are derivatives of the energy.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "fem/laws/law_table.hpp"
#include "fem/solid/solid_model.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {
namespace {

/// A small block, its inner nodes moved about, half of it of a second, stiffer material.
Body distorted_block() {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.02, 2));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-1e-3, 1e-3);
  for (auto& x : body.nodes) x = x + Vec3{shift(random), shift(random), shift(random)};
  body.region_names = {"tissue", "nodule"};
  for (std::size_t e = 0; e < body.tetrahedra.size(); e += 3) body.tetrahedron_region[e] = 1;
  return body;
}

SolidModel two_laws(const Body& body, Dilatation dilatation = Dilatation::Mean) {
  return {body,
          {NeoHookean::from_young_poisson(10e3, 0.49, "tissue"),
           make_law({"mooney-rivlin", {{"C10", 5e3}, {"C01", 2e3}, {"poisson", 0.45}}}, "nodule")},
          dilatation};
}

constexpr std::array<Dilatation, 4> kEach{Dilatation::Mean, Dilatation::Nodal,
                                          Dilatation::Pointwise, Dilatation::LinearNodal};

Displacement random_displacement(const SolidModel& model, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-size, size);
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  for (int node = 0; node < model.mesh().nodes(); ++node)
    for (int i = 0; i < 3; ++i) u(i, node) = entry(random);
  return u;
}

TEST(SolidModel, VolumeOfTheElementsIsThatOfTheBlock) {
  const Body body =
      test::make_block(test::even(0, 0.03, 3), test::even(0, 0.02, 2), test::even(0, 0.01, 1));
  // A uniform dilatation has the energy V U(J): it measures the volume.
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.4, "t")});
  const Displacement u = 0.1 * model.mesh().X;
  const auto law = NeoHookean::from_young_poisson(10e3, 0.4, "t");
  EXPECT_NEAR(model.energy(u).energy, 6e-6 * law.volumetric_energy(1.331), 1e-12);
}

/// Every element has the fibres at its centroid: in a homogeneous stretch the energy is the sum of
/// those of its elements.
TEST(SolidModel, FibresRunAroundTheirAxisElementByElement) {
  const Body body = distorted_block();
  LawConstants constants = test::sample_laws(0.45).back();
  constants.fibres.kind = FibreField::Kind::Cylindrical;
  constants.fibres.first = {0, 0.2, 1};
  constants.fibres.origin = {0.01, 0.01, 0};
  const Law law = make_law(constants, "wall");
  const SolidModel model(body, {law, law});
  const Eigen::Vector3d stretch(1.2, 0.9, 1.0);
  const Displacement u = stretch.asDiagonal() * model.mesh().X - model.mesh().X;
  Tensor2<Lanes> F;
  for (std::size_t i = 0; i < 9; ++i)
    F[i] = Lanes::Constant(i % 4 == 0 ? stretch[int(i / 4)] : 0.0);
  const Lanes J = Lanes::Constant(stretch.prod());
  double sum = 0;
  for (const Tetrahedron& t : body.tetrahedra) {
    const auto corner = [&](int c) -> const Vec3& { return body.nodes[to_index(t[to_index(c)])]; };
    const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0), c = corner(3) - corner(0);
    const auto directions =
        constants.fibres.at(0.25 * (corner(0) + corner(1) + corner(2) + corner(3)));
    Fibres<Lanes> fibres;
    for (std::size_t f = 0; f < 2; ++f)
      for (std::size_t i = 0; i < 3; ++i) fibres[f][i] = Lanes::Constant(directions[f][i]);
    const double density = law.psi(F, J, fibres)[0] + law.volumetric_energy(J)[0];
    sum += dot(cross(a, b), c) / 6 * density;
  }
  EXPECT_NEAR(model.energy(u).energy, sum, 1e-10 * sum);
}

TEST(SolidModel, ForcesAreTheDerivativeOfTheEnergy) {
  const Body body = distorted_block();
  for (const Dilatation dilatation : kEach) {
    const SolidModel model = two_laws(body, dilatation);
    Displacement u = random_displacement(model, 3e-4, 11);
    Eigen::VectorXd f;
    model.forces(u, f);
    for (int node = 0; node < model.mesh().nodes(); node += 3) {
      const int first = model.equation(node);
      if (first < 0) continue;
      for (int i = 0; i < 3; ++i) {
        const double h = 1e-7, at = u(i, node);
        u(i, node) = at + h;
        const double high = model.energy(u).energy;
        u(i, node) = at - h;
        const double low = model.energy(u).energy;
        u(i, node) = at;
        EXPECT_NEAR(f[first + i], (high - low) / (2 * h), 1e-6 * f.lpNorm<Eigen::Infinity>());
      }
    }
  }
}

TEST(SolidModel, StiffnessIsTheDerivativeOfTheForces) {
  const Body body = distorted_block();
  for (const Dilatation dilatation : kEach) {
    const SolidModel model = two_laws(body, dilatation);
    const Displacement u = random_displacement(model, 3e-4, 12);
    std::vector<double> K;
    model.stiffness(u, K);
    std::mt19937 random(13);
    std::uniform_real_distribution<double> entry(-1, 1);
    for (int trial = 0; trial < 5; ++trial) {
      Eigen::VectorXd d(model.pattern().n), product(model.pattern().n), high, low;
      for (auto& value : d) value = entry(random);
      symmetric_multiply(model.pattern(), K, d.data(), product.data());
      Displacement direction = Displacement::Zero(3, model.mesh().nodes());
      for (int node = 0; node < model.mesh().nodes(); ++node)
        if (model.equation(node) >= 0) direction.col(node) = d.segment<3>(model.equation(node));
      const double h = 1e-8;
      model.forces(u + h * direction, high);
      model.forces(u - h * direction, low);
      EXPECT_LT((product - (high - low) / (2 * h)).norm(), 1e-5 * product.norm());
    }
  }
}

TEST(SolidModel, RigidMotionStoresNothing) {
  const Body body = distorted_block();
  const SolidModel model = two_laws(body);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Displacement u = R * model.mesh().X - model.mesh().X;
  u.colwise() += Eigen::Vector3d(0.1, -0.2, 0.3);
  Eigen::VectorXd f;
  EXPECT_NEAR(model.forces(u, f).energy, 0, 1e-14);
  // Forces of round-off size: E times an area of 1 cm^2 is 1 N.
  EXPECT_LT(f.lpNorm<Eigen::Infinity>(), 1e-10);
}

TEST(SolidModel, ReportsInversion) {
  const Body body = distorted_block();
  const SolidModel model = two_laws(body);
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  u.row(2) = -1.5 * model.mesh().X.row(2);
  EXPECT_LT(model.energy(u).min_J, 0);
}

}  // namespace
}  // namespace palpate::fem
