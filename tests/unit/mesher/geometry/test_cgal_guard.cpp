// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/cgal_guard.hpp"

#include <CGAL/exceptions.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "format/error.hpp"

namespace palpate::mesher {
namespace {

TEST(CgalGuard, RunsTheWork) {
  int runs = 0;
  guard_cgal("body.stl", "mend it", [&] { ++runs; });
  EXPECT_EQ(runs, 1);
}

template <typename Failure>
void expect_refused(const Failure& failure, const std::string& reason) {
  try {
    guard_cgal("body.stl", "mend it", [&] { throw failure; });
    FAIL() << "passed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_EQ(error.where(), "body.stl");
    EXPECT_EQ(error.remedy(), "mend it");
    EXPECT_EQ(error.problem(), "a geometric computation fails: " + reason);
  }
}

TEST(CgalGuard, TurnsEveryFailureIntoARefusalOfTheGeometry) {
  expect_refused(CGAL::Assertion_exception("CGAL", "ok", "cgal.h", 1, ""), "ok");
  expect_refused(CGAL::Precondition_exception("CGAL", "! flat", "cgal.h", 1, ""), "! flat");
  expect_refused(CGAL::Failure_exception("CGAL", "", "cgal.h", 1, "no way out"), "no way out");
}

TEST(CgalGuard, LeavesOtherErrorsAlone) {
  EXPECT_THROW(guard_cgal("a", "b", [] { throw std::length_error("c"); }), std::length_error);
}

}  // namespace
}  // namespace palpate::mesher
