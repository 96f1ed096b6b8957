// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/point_text.hpp"

#include <gtest/gtest.h>

namespace palpate::fem {
namespace {

TEST(PointText, IsInMillimetres) {
  EXPECT_EQ(point_text({0.001, -0.0025, 0.03}), "(1, -2.5, 30) mm");
}

}  // namespace
}  // namespace palpate::fem
