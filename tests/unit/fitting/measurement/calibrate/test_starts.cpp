// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/measurement/calibrate/starts.hpp"

namespace palpate::calibrate {
namespace {

/// A case accepts whatever the fit may find, and the fit starts within its bounds.
TEST(Starts, LieWithinBoundsThatLieWithinTheTable) {
  for (const auto name : homogeneous_laws()) {
    const IncompressibleLaw law(name);
    const auto constants = default_constants(law, 1e3);
    const auto table = law.constants();
    ASSERT_EQ(constants.size(), table.size()) << name;
    for (std::size_t i = 0; i < table.size(); ++i) {
      EXPECT_EQ(constants[i].name, table[i].name);
      EXPECT_EQ(constants[i].is_stress, table[i].is_stress);
      EXPECT_TRUE(table[i].holds(constants[i].start)) << name << " " << table[i].name;
      EXPECT_GE(constants[i].low, table[i].low) << name;
      EXPECT_LE(constants[i].high, table[i].high) << name;
      EXPECT_LE(constants[i].low, constants[i].start) << name;
      EXPECT_LE(constants[i].start, constants[i].high) << name;
    }
    for (const auto& start : several_starts(law, 1e3)) {
      ASSERT_EQ(start.size(), table.size()) << name;
      for (std::size_t i = 0; i < table.size(); ++i)
        EXPECT_TRUE(table[i].holds(start[i])) << name << " " << table[i].name;
    }
  }
}

/// The modulus of the default start is the one that the data suggest.
TEST(Starts, HaveTheModulusOfTheData) {
  for (const auto name : homogeneous_laws()) {
    const IncompressibleLaw law(name);
    std::vector<double> start;
    for (const ConstantInfo& constant : default_constants(law, 1e3))
      start.push_back(constant.start);
    if (name == "veronda-westmann") continue;  // C1 C2 is half of it
    EXPECT_NEAR(fem::rest_moduli(law.for_case(start)).mu(), 1e3, 1) << name;
  }
}

}  // namespace
}  // namespace palpate::calibrate
