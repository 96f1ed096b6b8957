// SPDX-License-Identifier: AGPL-3.0-or-later
// Pressures near nu = 1/2: the inf-sup constants of the elements, and checkerboards in a confined
// block.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fem/campaign/indentation.hpp"
#include "fem/solid/pressure_smoothness.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

/// A cube of n x n x n cells, its base fixed.
Body cube(int cells) {
  return test::make_block(test::even(0, 1, cells), test::even(0, 1, cells),
                          test::even(0, 1, cells));
}

/// The stiffness at rest is linear in the bulk modulus; this is its slope, B^T M^-1 B.
Eigen::MatrixXd bulk_stiffness(const Body& body, Dilatation dilatation, const SolidModel& sample) {
  const int n = sample.pattern().n;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (const double kappa : {1.0, 2.0}) {
    const SolidModel model(body, {NeoHookean::from_moduli(1, kappa)}, dilatation);
    std::vector<double> K;
    model.stiffness(Displacement::Zero(3, model.mesh().nodes()), K);
    const SparsePattern& pattern = model.pattern();
    for (int column = 0; column < n; ++column)
      for (int k = pattern.start[to_index(column)]; k < pattern.start[to_index(column + 1)]; ++k)
        dense(pattern.row[to_index(k)], column) += (kappa > 1 ? 1 : -1) * K[to_index(k)];
  }
  return dense.selfadjointView<Eigen::Lower>();
}

/// The matrix of the integral of |grad u|^2 over the body.
Eigen::MatrixXd gradient_norm(const SolidModel& model) {
  const QuadraticMesh& mesh = model.mesh();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(model.pattern().n, model.pattern().n);
  test::for_each_volume_point(mesh, [&](const test::VolumePoint& p) {
    const auto& node = mesh.tetrahedra[p.element];
    for (std::size_t a = 0; a < kTetNodes; ++a)
      for (std::size_t b = 0; b < kTetNodes; ++b) {
        const int i = model.equation(node[a]), j = model.equation(node[b]);
        if (i < 0 || j < 0) continue;
        const double entry = p.volume * p.dN[a].dot(p.dN[b]);
        for (int axis = 0; axis < 3; ++axis) A(i + axis, j + axis) += entry;
      }
  });
  return A;
}

/// The eigenvalues beta^2 of B^T M^-1 B u = beta^2 A u at rest, ascending, one for each pressure.
/// beta is the maximum over u of (p, div u)/(|p| |grad u|) for the pressure p of the eigenvector.
Eigen::VectorXd inf_sup_eigenvalues(const Body& body, Dilatation dilatation) {
  const SolidModel model(body, {NeoHookean::from_moduli(1, 1)}, dilatation);
  const Eigen::LLT<Eigen::MatrixXd> A(gradient_norm(model));
  const Eigen::MatrixXd half = A.matrixL().solve(bulk_stiffness(body, dilatation, model));
  const Eigen::MatrixXd C = A.matrixL().solve(half.transpose());
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C, Eigen::EigenvaluesOnly).eigenvalues();
  return values.tail(static_cast<Eigen::Index>(
      dilatation == Dilatation::Mean ? body.tetrahedra.size() : body.nodes.size()));
}

/// The inf-sup constant: the smallest beta.
double inf_sup(Dilatation dilatation, int cells) {
  return std::sqrt(std::max(0.0, inf_sup_eigenvalues(cube(cells), dilatation)[0]));
}

TEST(InfSup, ConstantFallsWithTheMeshForElementConstantPressuresOnly) {
  const std::string problem = "Inf-sup constant of the cube, base fixed, regular mesh";
  const std::string source = "a separate program, dense algebra";
  const auto row = [&](Dilatation dilatation, int cells, double expected) {
    const double beta = inf_sup(dilatation, cells);
    test::verify({problem,
                  std::string(dilatation == Dilatation::Mean ? "element-constant" : "nodal") +
                      " pressure, " + std::to_string(cells) + " cells an edge",
                  "1", beta, expected, test::Reference::OtherSolver, source, 1e-3});
    return beta;
  };
  const double constant = row(Dilatation::Mean, 3, 0.2299) / row(Dilatation::Mean, 2, 0.3116);
  const double nodal = row(Dilatation::Nodal, 3, 0.2811) / row(Dilatation::Nodal, 2, 0.2810);
  // A constant that falls with the element size makes checkerboards possible.
  EXPECT_LT(constant, 0.8);
  EXPECT_GT(nodal, 0.99);
}

struct Confined {
  double force, alternation;
};

/// A sphere of 5 mm pressed 2 mm into a block of 30 x 30 x 15 mm in a box: only its top is free.
Confined press_confined(Dilatation dilatation, double poisson, int cells) {
  Body body = test::make_block(test::even(-0.015, 0.015, cells), test::even(-0.015, 0.015, cells),
                               test::even(-0.015, 0, cells / 2));
  body.fixed_nodes.clear();
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    const Vec3& x = body.nodes[i];
    if (std::max(std::abs(x[0]), std::abs(x[1])) > 0.0149 || x[2] < -0.0149)
      body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
  }
  std::int32_t centre = 0;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[to_index(body.response.node[v])];
    if (std::hypot(x[0], x[1]) < 1e-9) centre = static_cast<std::int32_t>(v);
  }
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, poisson}}};
  s.dilatation = dilatation;
  s.indentation.depth = 0.002;
  s.indentation.increments = 2;
  s.indentation.lateral_depths.clear();
  const CampaignContext context(body, s, Engine::SharedFactor);
  Displacement u;
  const SiteCurves curves = solve_site(context, centre, &u);
  EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  std::vector<double> energy, pressure;
  context.model.element_fields(u, energy, pressure);
  return {-curves.paths.front().samples.back().force[2],
          smooth_pressure(context.model.mesh(), pressure).alternation};
}

TEST(Checkerboard, AppearsInAConfinedBlockAndNotWithNodalPressures) {
  const double nu = 0.499;
  const Confined constant = press_confined(Dilatation::Mean, nu, 10);
  const Confined nodal = press_confined(Dilatation::Nodal, nu, 10);
  const std::string problem = "Checkerboards: a sphere pressed into a block in a box, nu = 0.499";
  test::verify({problem, "alternation of the pressures over that of a smooth field, nodal pressure",
                "1", nodal.alternation, 1.6, test::Reference::SameSolver,
                "recorded value on this mesh", 0.2, test::Error::Absolute});
  test::verify({problem, "force with element-constant over that with nodal pressure", "1",
                constant.force / nodal.force, 1, test::Reference::SameSolver, "the other element",
                0.05});
  EXPECT_GT(constant.alternation, kAlternating);
}

}  // namespace
}  // namespace palpate::fem
