// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/verification/record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

namespace palpate::test {

namespace {

std::string text(Reference kind) {
  switch (kind) {
    case Reference::ClosedForm:
      return "closed form";
    case Reference::Theory:
      return "theory";
    case Reference::Published:
      return "published value";
    case Reference::Recalled:
      return "recalled value";
    case Reference::OtherSolver:
      return "other solver";
    case Reference::SameSolver:
      return "same solver";
    case Reference::Calibration:
      return "calibration";
  }
  return "";
}

/// Appends to the file of the running test; the first call truncates it.
void append(const nlohmann::ordered_json& row) {
  static std::set<std::string> begun;
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "." + info->name() + ".jsonl";
  std::replace(name.begin(), name.end(), '/', '_');
  const std::filesystem::path folder = PALPATE_VERIFICATION_ROWS;
  std::filesystem::create_directories(folder);
  const bool first = begun.insert(name).second;
  std::ofstream out(folder / name, first ? std::ios::trunc : std::ios::app);
  out << row.dump() << "\n" << std::flush;
  ASSERT_TRUE(out.good()) << "cannot write the row to " << folder / name;
}

}  // namespace

void verify(const Comparison& c) {
  const bool relative = c.error == Error::Relative;
  const double error = relative ? c.computed / c.reference - 1 : c.computed - c.reference;
  EXPECT_LE(std::abs(error), c.bound)
      << c.problem << ", " << c.quantity << ": " << c.computed << " against " << c.reference;
  append({{"problem", c.problem},
          {"quantity", c.quantity},
          {"unit", c.unit},
          {"computed", c.computed},
          {"reference", c.reference},
          {"kind", text(c.kind)},
          {"source", c.source},
          {"error", error},
          {"bound", c.bound},
          {"relative", relative}});
}

}  // namespace palpate::test
