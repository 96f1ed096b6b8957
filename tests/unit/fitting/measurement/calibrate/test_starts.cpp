// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/calibrate/starts.hpp"

namespace palpate::calibrate {
namespace {

/// A case accepts whatever the fit may find, and the fit starts within its bounds.
TEST(Starts, LieWithinBoundsThatLieWithinTheTable) {
  for (const auto name : homogeneous_laws()) {
    const IncompressibleLaw law(name);
    const auto constants = default_constants(law, {1e3, 0});
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
  }
}

/// The modulus of the default start is the one that the data suggest.
TEST(Starts, HaveTheModulusOfTheData) {
  for (const auto name : homogeneous_laws()) {
    const IncompressibleLaw law(name);
    std::vector<double> start;
    for (const ConstantInfo& constant : default_constants(law, {1e3, 0}))
      start.push_back(constant.start);
    if (name == "veronda-westmann") continue;  // C1 C2 is half of it
    EXPECT_NEAR(fem::rest_moduli(law.for_case(start)).mu(), 1e3, 1) << name;
  }
}

/// Wide bounds are those of the table; the others are narrower only where a sign makes the law
/// stable.
TEST(Starts, AreBoundedAsTheTableWhereWide) {
  for (const auto name : homogeneous_laws()) {
    const IncompressibleLaw law(name);
    const auto narrow = default_constants(law, {1e3, 0}), wide = wide_constants(law, {1e3, 0});
    for (std::size_t i = 0; i < wide.size(); ++i) {
      if (law.constants()[i].is_stress && law.constants()[i].low != 0) {
        EXPECT_EQ(wide[i].low, law.constants()[i].low) << name << " " << wide[i].name;
      }
      EXPECT_LE(wide[i].low, narrow[i].low) << name;
    }
  }
}

/// A limit of I1 - 3 below that of the data leaves the law without a stress there.
TEST(Starts, HaveTheLimitOfGentBeyondTheData) {
  const IncompressibleLaw law("gent");
  const ConstantInfo limit = default_constants(law, {1e3, 286.2})[1];
  EXPECT_GT(limit.low, 286.2);
  EXPECT_GT(limit.start, limit.low);
  const double constants[2] = {1e3, limit.low};
  EXPECT_TRUE(std::isfinite(law.stress(constants, Mode::Uniaxial, 17)));  // I1 - 3 = 286.12
}

}  // namespace
}  // namespace palpate::calibrate
