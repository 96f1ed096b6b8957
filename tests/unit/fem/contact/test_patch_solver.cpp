// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/patch_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <vector>

#include "tests/unit/fem/contact/pressed_block.hpp"

namespace palpate::fem {
namespace {

/// A patch with a stiffness by which every unknown feels every other.
struct Pushed : Pressed {
  ContactPatch patch{contact, model, u};
  PatchStiffness stiffness;
  Eigen::VectorXd load;
  PatchSolver solver;

  Pushed() {
    patch.start_from(contact, u);
    const Eigen::Index n = patch.size();
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const Eigen::MatrixXd G = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
    stiffness.S =
        200 * Eigen::MatrixXd::Identity(n, n) + 100 * G * G.transpose() / static_cast<double>(n);
    stiffness.stiffening = Eigen::VectorXd::Constant(n, 1e3);
    load = 1e-3 * Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
  }

  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(patch.size()); }

  /// Norm of the gradient on the whole patch, N.
  double residual(const Eigen::VectorXd& d) const {
    Eigen::VectorXd g;
    patch.gradient(contact, d, g);
    return (stiffness.S * d - load + g).norm();
  }

  Eigen::Index touched(const Eigen::VectorXd& d) const {
    std::vector<char> marks(static_cast<std::size_t>(d.size()), 0);
    patch.mark_touched(contact, d, marks);
    return std::count(marks.begin(), marks.end(), 1);
  }
};

TEST(PatchSolver, TheGradientVanishesOnTheWholePatch) {
  Pushed p;
  p.solver.use(p.stiffness);
  const Eigen::VectorXd d = p.solver.minimum(p.patch, p.contact, p.load, p.zero(), 1e-10).value();
  EXPECT_LT(p.residual(d), 1e-10);
  EXPECT_GT(p.touched(d), 0);
  EXPECT_LT(p.touched(d), p.patch.size());
}

/// The tool starts above the surface, which a load lifts towards it: what it meets joins the core.
TEST(PatchSolver, FindsTheContactWhereItWasNotExpected) {
  Pushed p;
  p.contact.move_to(sphere(Eigen::Vector3d(2e-4, 1e-4, 0.0051)));
  for (Eigen::Index i = 2; i < p.patch.size(); i += 3) p.load[i] = 0.3;
  ASSERT_EQ(p.touched(p.zero()), 0);
  p.solver.use(p.stiffness);
  const Eigen::VectorXd d = p.solver.minimum(p.patch, p.contact, p.load, p.zero(), 1e-10).value();
  EXPECT_LT(p.residual(d), 1e-10);
  EXPECT_GT(p.touched(d), 0);
}

/// One unknown outside the contact has a stiffness of its own.
struct PushedBesideASpring : Pushed {
  Eigen::Index free = 0;

  PushedBesideASpring() {
    std::vector<char> marks(static_cast<std::size_t>(patch.size()), 0);
    patch.mark_touched(contact, zero(), marks);
    free = std::find(marks.begin(), marks.end(), 0) - marks.begin();
    EXPECT_LT(free, patch.size());
    stiffness.S.row(free).setZero();
    stiffness.S.col(free).setZero();
  }

  /// The residual of the minimum with the spring as stiff as this, N, where the fraction `added` of
  /// the stiffening is added.
  double residual_with(double spring, double added) {
    stiffness.S(free, free) = spring;
    solver.use(stiffness);
    const Eigen::VectorXd d = solver.minimum(patch, contact, load, zero(), 1e-10).value();
    Eigen::VectorXd g;
    patch.gradient(contact, d, g);
    return (stiffness.S * d + added * stiffness.stiffening.cwiseProduct(d) - load + g).norm();
  }
};

/// An S that is indefinite outside the contact has no minimum: the steps are those of the smallest
/// stiffening that gives one.
TEST(PatchSolver, StiffensWhatIsIndefiniteOutsideTheContact) {
  PushedBesideASpring p;
  EXPECT_LT(p.residual_with(-20, 0.03), 1e-10);  // a 50th of the stiffening
}

TEST(PatchSolver, StiffensNoFurtherOnceSIsPositiveDefinite) {
  PushedBesideASpring p;
  EXPECT_LT(p.residual_with(-20, 0.03), 1e-10);
  EXPECT_LT(p.residual_with(20, 0), 1e-10);
}

/// The fraction that the last S needed is where the next one begins.
TEST(PatchSolver, ComesDownToTheSmallestStiffeningFromOneSToTheNext) {
  PushedBesideASpring p;
  EXPECT_LT(p.residual_with(-20, 0.03), 1e-10);
  for (const double fraction : {0.015, 0.008, 0.004, 0.002, 0.002})
    EXPECT_LT(p.residual_with(-1.5, fraction), 1e-10) << fraction;
  EXPECT_LT(p.residual_with(-20, 0.03), 1e-10);
}

TEST(PatchSolver, FindsNoMinimumWhereTheStiffeningDoesNotSuffice) {
  Pushed p;
  p.stiffness.S.diagonal().array() -= 1e6;
  p.solver.use(p.stiffness);
  EXPECT_FALSE(p.solver.minimum(p.patch, p.contact, p.load, p.zero(), 1e-10));
}

}  // namespace
}  // namespace palpate::fem
