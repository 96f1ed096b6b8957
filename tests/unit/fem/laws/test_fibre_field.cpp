// SPDX-License-Identifier: AGPL-3.0-or-later
// Directions of fibres: constant in a plane, and around the axis of a cylinder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fem/laws/law.hpp"
#include "fem/laws/law_table.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

TEST(FibreField, GivesUnitVectorsInThePlaneAsked) {
  FibreField field;
  field.first = {2, 0, 0};
  field.second = {5, 3, 0};
  field.angle = M_PI / 6;
  field.families = 2;
  const auto a = field.at({1, 2, 3});
  EXPECT_NEAR(a[0][0], std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(a[0][1], 0.5, 1e-15);
  EXPECT_NEAR(a[1][1], -0.5, 1e-15);
  field.families = 1;
  EXPECT_EQ(field.at({})[1], field.at({})[0]);
}

TEST(FibreField, RunsAroundTheAxisOfACylinder) {
  FibreField field;
  field.kind = FibreField::Kind::Cylindrical;
  field.first = {0, 0, 3};
  field.origin = {0.1, 0, 0};
  field.angle = 0;
  // Around the axis, whichever way is meant by it, and along it at a right angle.
  EXPECT_NEAR(std::abs(field.at({0.2, 0, 0.5})[0][1]), 1, 1e-15);
  EXPECT_NEAR(std::abs(field.at({0.1, -0.3, 0.5})[0][0]), 1, 1e-15);
  field.angle = M_PI / 2;
  EXPECT_NEAR(field.at({0.2, 0, 0.5})[0][2], 1, 1e-15);
  EXPECT_NEAR(norm(field.at(field.origin)[0]), 1, 1e-15);
}

TEST(FibreField, RefusesDirectionsThatSpanNoPlane) {
  const auto with = [](auto change) -> std::string {
    LawConstants law = test::sample_laws(0.45).back();
    change(law.fibres);
    try {
      make_law(law, "liver");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(with([](FibreField& f) { f.first = {}; }), HasSubstr("no length"));
  EXPECT_THAT(with([](FibreField& f) { f.second = f.first; }), HasSubstr("parallel"));
  EXPECT_THAT(with([](FibreField& f) { f.angle = 2; }), HasSubstr("angle (rad) = 2"));
  EXPECT_THAT(with([](FibreField& f) { f.families = 3; }), HasSubstr("families = 3"));
}

}  // namespace
}  // namespace palpate::fem
