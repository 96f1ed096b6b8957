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

  /// What the rounding of S to single precision leaves of it, N.
  double rounding() const { return 1e-6 * residual(zero()); }

  std::vector<char> marks(const Eigen::VectorXd& d) const {
    std::vector<char> marks(static_cast<std::size_t>(d.size()), 0);
    patch.mark_touched(contact, d, marks);
    return marks;
  }

  Eigen::Index touched(const Eigen::VectorXd& d) const {
    const std::vector<char> all = marks(d);
    return std::count(all.begin(), all.end(), 1);
  }
};

TEST(PatchSolver, TheGradientVanishesOnTheWholePatch) {
  Pushed p;
  p.solver.use(p.stiffness);
  const Eigen::VectorXd d = p.solver.minimum(p.patch, p.contact, p.load, p.zero(), 1e-10).value();
  EXPECT_LT(p.residual(d), p.rounding());
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
  EXPECT_LT(p.residual(d), p.rounding());
  EXPECT_GT(p.touched(d), 0);
}

/// One unknown has a stiffness of its own.
struct PushedBesideASpring : Pushed {
  Eigen::Index free = 0;
  std::vector<char> core = marks(zero());

  /// Outside of the contact, or that which the contact holds the least: a sphere without friction
  /// hardly holds the surface along itself.
  explicit PushedBesideASpring(bool in_contact) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(patch.size(), patch.size());
    patch.add_hessian(contact, zero(), false, H);
    free = -1;
    for (Eigen::Index i = 0; i < patch.size(); ++i)
      if (is_core(i) == in_contact && (free < 0 || H(i, i) < H(free, free))) free = i;
    EXPECT_LT(H(free, free), 0.1);  // N/m, far less than the springs
    stiffness.S.row(free).setZero();
    stiffness.S.col(free).setZero();
  }

  bool is_core(Eigen::Index i) const { return core[static_cast<std::size_t>(i)] != 0; }

  /// The residual of the minimum with the spring as stiff as this, over what rounding leaves, where
  /// the fraction `added` of the stiffening is added.
  double residual_with(double spring, double added) {
    stiffness.S(free, free) = spring;
    solver.use(stiffness);
    const Eigen::VectorXd d = solver.minimum(patch, contact, load, zero(), 1e-10).value();
    Eigen::VectorXd g;
    patch.gradient(contact, d, g);
    g += stiffness.S * d + added * stiffness.stiffening.cwiseProduct(d) - load;
    return g.norm() / rounding();
  }
};

/// An S that is indefinite has no minimum: the steps are those of the smallest stiffening that
/// gives one, in the contact or outside of it.
TEST(PatchSolver, StiffensWhatIsIndefinite) {
  for (const bool in_contact : {false, true}) {
    PushedBesideASpring p(in_contact);
    EXPECT_LT(p.residual_with(-20, 0.03), 1) << in_contact;  // a 50th of the stiffening
  }
}

TEST(PatchSolver, StiffensNoFurtherOnceSIsPositiveDefinite) {
  for (const bool in_contact : {false, true}) {
    PushedBesideASpring p(in_contact);
    EXPECT_LT(p.residual_with(-20, 0.03), 1) << in_contact;
    EXPECT_LT(p.residual_with(20, 0), 1) << in_contact;
  }
}

/// The fraction that an S needed is where the next one that needs any begins, one below; an S in
/// between that needs none changes nothing.
TEST(PatchSolver, ComesDownToTheSmallestStiffeningFromOneSToTheNext) {
  for (const bool in_contact : {false, true}) {
    PushedBesideASpring p(in_contact);
    EXPECT_LT(p.residual_with(-20, 0.03), 1) << in_contact;
    for (const double fraction : {0.015, 0.008, 0.004, 0.002, 0.002})
      EXPECT_LT(p.residual_with(-1.5, fraction), 1) << in_contact << " " << fraction;
    EXPECT_LT(p.residual_with(-20, 0.03), 1) << in_contact;
    EXPECT_LT(p.residual_with(20, 0), 1) << in_contact;
    EXPECT_LT(p.residual_with(-1.5, 0.015), 1) << in_contact;
  }
}

TEST(PatchSolver, FindsNoMinimumWhereTheStiffeningDoesNotSuffice) {
  Pushed p;
  p.stiffness.S.diagonal().array() -= 1e6;
  p.solver.use(p.stiffness);
  EXPECT_FALSE(p.solver.minimum(p.patch, p.contact, p.load, p.zero(), 1e-10));
}

}  // namespace
}  // namespace palpate::fem
