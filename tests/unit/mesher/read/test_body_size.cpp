// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/body_size.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

std::string logged(double raw, double unit) {
  std::string log;
  check_body_size(raw, unit, "a.stl", [&](std::string_view line) { log += line; });
  return log;
}

TEST(BodySize, SamplesAndOrgansPass) {
  EXPECT_EQ(logged(180, 1e-3), "");
  EXPECT_THAT(logged(300, 1e-6), testing::HasSubstr("0.3 mm with a unit of 1e-06 m, unusual"));
  EXPECT_THAT(logged(3, 1), testing::HasSubstr("'in' would be that of an organ"));
}

TEST(BodySize, OthersAreRefusedWithTheUnitThatLooksLikely) {
  expect_refusal([] { logged(180, 1); }, "a.stl", "180000 mm with a unit of 1 m",
                 "'mm' looks likely");
  expect_refusal([] { logged(0.15, 1e-6); }, "a.stl", "outside", "'m' looks likely");
  // The limits themselves are allowed.
  EXPECT_THAT(logged(1, 10e-6), testing::HasSubstr("unusual"));
  EXPECT_THAT(logged(10, 1), testing::HasSubstr("unusual"));
  expect_refusal([] { logged(10.5, 1); }, "a.stl", "10500 mm", "'");
  expect_refusal([] { logged(0, 1); }, "a.stl", "outside", "no extent");
}

}  // namespace
}  // namespace palpate::mesher
