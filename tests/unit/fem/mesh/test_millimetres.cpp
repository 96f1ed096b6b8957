// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/millimetres.hpp"

#include <gtest/gtest.h>

namespace palpate::fem {
namespace {

TEST(Millimetres, AreWrittenFromMetres) {
  EXPECT_EQ(in_millimetres(0.0025), "2.500 mm");
  EXPECT_EQ(point_text({0.001, -0.0025, 0.03}), "(1, -2.5, 30) mm");
}

}  // namespace
}  // namespace palpate::fem
