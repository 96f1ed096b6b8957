// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/contact/contact.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {

/// A sphere of 5 mm above the block.
inline Tool sphere(const Eigen::Vector3d& centre) {
  return {{}, centre - 0.005 * Eigen::Vector3d::UnitZ()};
}

/// A sphere of 5 mm pressed 1 mm into the middle of the top of an undeformed block, so that some
/// points are in contact and some are not.
struct Pressed {
  Body body = test::make_block(test::even(-0.01, 0.01, 4), test::even(-0.01, 0.01, 4),
                               test::even(-0.02, 0, 3));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  ToolContact contact{model.mesh(), Eigen::Vector3d::Zero(), 0.01, {1e8, 1e4}};
  Displacement u = Displacement::Zero(3, model.mesh().nodes());

  Pressed() { contact.move_to(sphere(Eigen::Vector3d(2e-4, 1e-4, 0.004))); }
};

}  // namespace palpate::fem
