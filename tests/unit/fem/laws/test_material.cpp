// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fem/laws/material.hpp"
#include "format/error.hpp"

namespace palpate::fem {
namespace {

TEST(NeoHookean, RefusesConstantsOutOfRangeByName) {
  const auto message = [](double E, double nu) -> std::string {
    try {
      NeoHookean::from_young_poisson(E, nu, "liver");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(-1, 0.4), testing::HasSubstr("young"));
  EXPECT_NE(message(std::nan(""), 0.4).find("nan"), std::string::npos);
  EXPECT_NE(message(1e3, 0.5).find("poisson (nu) = 0.5"), std::string::npos);
  EXPECT_NE(message(1e3, -0.1).find("0 <= nu < 0.5"), std::string::npos);
  EXPECT_NE(message(1e3, 0.5).find("liver"), std::string::npos);
}

TEST(NeoHookean, HasTheModuliOfYoungAndPoisson) {
  const auto law = NeoHookean::from_young_poisson(3e3, 0.25, "test");
  EXPECT_DOUBLE_EQ(law.mu(), 1.2e3);
  EXPECT_DOUBLE_EQ(law.kappa(), 2e3);
}

}  // namespace
}  // namespace palpate::fem
