// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/contact_patch.hpp"

#include <gtest/gtest.h>

#include "format/to_index.hpp"
#include "tests/unit/fem/contact/pressed_block.hpp"

namespace palpate::fem {
namespace {

/// The patch against the whole contact, moved by d.
TEST(ContactPatch, IsTheContactOnItsUnknowns) {
  Pressed p;
  for (const bool bonded : {false, true}) {
    if (bonded) {
      p.contact.bond(p.u);
      p.contact.move_to(sphere(Eigen::Vector3d(5e-4, 1e-4, 0.004)));
    }
    ContactPatch patch(p.contact, p.model, p.u);
    EXPECT_TRUE(patch.covers(p.contact, p.u));
    patch.start_from(p.contact, p.u);
    const auto count = static_cast<Eigen::Index>(patch.unknowns().size());
    ASSERT_GT(count, 20);
    const Eigen::VectorXd d = 2e-5 * Eigen::VectorXd::Random(count);
    Displacement moved = p.u;
    for (int node = 0; node < p.model.mesh().nodes(); ++node)
      for (Eigen::Index i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
          if (p.model.equation(node) + c == patch.unknowns()[static_cast<std::size_t>(i)] &&
              p.model.equation(node) >= 0)
            moved(c, node) += d[i];
    EXPECT_NEAR(patch.energy(p.contact, d), p.contact.energy(moved),
                1e-12 * p.contact.energy(moved));

    Eigen::VectorXd g, full = Eigen::VectorXd::Zero(p.model.pattern().n);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(count, count);
    patch.gradient(p.contact, d, g);
    patch.add_hessian(p.contact, d, true, H);
    p.contact.add_forces(p.model, moved, full);
    EXPECT_NEAR(g.norm(), full.norm(), 1e-10 * full.norm());  // no force outside the patch
    for (Eigen::Index i = 0; i < count; ++i)
      EXPECT_NEAR(g[i], full[patch.unknowns()[static_cast<std::size_t>(i)]], 1e-10 * full.norm());

    std::vector<double> K(to_index(p.model.pattern().nonzeros()), 0.0);
    p.contact.add_stiffness(p.model, moved, true, K);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        if (H(i, j) == 0) continue;
        const int row = patch.unknowns()[static_cast<std::size_t>(i)];
        const int column = patch.unknowns()[static_cast<std::size_t>(j)];
        EXPECT_NEAR(H(i, j), K[to_index(p.model.pattern().position(row, column))], 1e-9 * H.norm());
      }
  }
}

TEST(ContactPatch, DetectsContactBeyondItsFacets) {
  const Body body = test::make_block(test::even(-0.01, 0.01, 10), test::even(-0.01, 0.01, 10),
                                     test::even(-0.004, 0, 2));
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")});
  ToolContact contact(model.mesh(), Eigen::Vector3d::Zero(), 0.02, {1e8, 1e4});
  const Displacement u = Displacement::Zero(3, model.mesh().nodes());
  const auto press = [&](double depth) {
    contact.move_to(sphere(Eigen::Vector3d(0, 0, 0.005 - depth)));
  };
  press(1e-4);  // a circle of 1 mm radius on facets of 2 mm
  const ContactPatch patch(contact, model, u);
  press(3e-4);
  EXPECT_TRUE(patch.covers(contact, u));
  press(4e-3);  // a circle of 4.9 mm
  EXPECT_FALSE(patch.covers(contact, u));
}

}  // namespace
}  // namespace palpate::fem
