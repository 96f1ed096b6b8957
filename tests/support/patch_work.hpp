// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/path_work.hpp"

namespace palpate::test {

/// The force on a bonded patch is a smooth function of its depth: its work is the stored energy, to
/// the error of the integration over the increments.
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
