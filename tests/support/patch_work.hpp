// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/indentation.hpp"

namespace palpate::test {

/// Without the steps that a contact makes in the force, the work done on a stuck patch is the
/// stored energy, to the error of the integration over the increments of the press.
inline void expect_work_is_stored(const fem::PatchCurve& curve) {
  ASSERT_EQ(curve.reason, "");
  std::vector<double> depth, force;
  for (const fem::PatchForce& sample : curve.samples) {
    depth.push_back(sample.depth);
    force.push_back(-sample.force[2]);
  }
  const double work = fem::running_integral(depth, force).back();
  EXPECT_NEAR(work, curve.samples.back().strain_energy, 1e-3 * work);
}

}  // namespace palpate::test
