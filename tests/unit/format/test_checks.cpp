// SPDX-License-Identifier: AGPL-3.0-or-later
// Each rule at its ends, and whose fault a broken one is.
#include "format/checks.hpp"
#include "format/hdf5_file.hpp"
#include "format/numbers.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::expect_refusal;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
constexpr double kLargest = std::numeric_limits<double>::max();

class ChecksOfATarget : public testing::Test {
 protected:
  bool allows(const Rule& rule, double value) const {
    try {
      checks_.number("/d", 3, value, rule);
      return true;
    } catch (const Error&) {
      return false;
    }
  }
  void expect_refused(const std::function<void()>& action, const std::string& where,
                      const std::string& problem) const {
    expect_refusal(action, ErrorKind::Internal, "body.h5:" + where, problem);
  }
  const Checks checks_{std::filesystem::path("body.h5")};
};

TEST_F(ChecksOfATarget, RulesHoldAtTheirEndsAndNotBeyond) {
  struct Case {
    const char* name;
    Rule rule;
    std::vector<double> allowed, refused;
  };
  for (const auto& [name, rule, allowed, refused] : {
           Case{"anything", rules::kAnything, {-kInfinity, 0, kInfinity, kNan}, {}},
           Case{"finite", rules::kFinite, {-kLargest, 0, kLargest}, {-kInfinity, kInfinity, kNan}},
           Case{"known finite", rules::kKnownFinite, {-1, kNan}, {kInfinity}},
           Case{"not negative", rules::kNonNegative, {0, kLargest}, {-kSmallest, kInfinity, kNan}},
           Case{"known not negative", rules::kKnownNonNegative, {0, kNan}, {-kSmallest}},
           Case{"positive", rules::kPositive, {1e-300}, {0, -1, kNan, kInfinity}},
           Case{"bound", rules::kBound, {0, kInfinity}, {-1, kNan}},
           Case{"known bound", rules::kKnownBound, {0, kInfinity, kNan}, {-1}},
           Case{"flag", rules::kFlag, {0, 1}, {2, -1, kNan}},
           Case{"cosine", rules::kCosine, {-1, 1}, {1.0000001, kNan}},
           Case{"up to", rules::up_to(3, "at most 3"), {0, 3}, {3.5, -1, kNan}},
       }) {
    for (const double value : allowed) EXPECT_TRUE(allows(rule, value)) << name << ' ' << value;
    for (const double value : refused) EXPECT_FALSE(allows(rule, value)) << name << ' ' << value;
  }
}

TEST_F(ChecksOfATarget, NameFileDatasetRowAndRule) {
  expect_refused([&] { checks_.number("/site/force", 7, -1, rules::kNonNegative); },
                 "/site/force[7]", "is not finite and not negative");
  expect_refused([&] { checks_.same_size("/a", 3, 4); }, "/a", "has 3 rows, 4 expected");
}

TEST_F(ChecksOfATarget, DirectionsHaveUnitLength) {
  const Vec3 along{0.6, 0, 0.8};
  EXPECT_NO_THROW(checks_.vectors("/n", {along, (1 + 0.5e-6) * along}, rules::kUnit));
  expect_refused(
      [&] {
        checks_.vectors("/n", {along, 1.001 * along}, rules::kUnit);
      },
      "/n[1]", "has length 1.001");
}

TEST_F(ChecksOfATarget, IndicesAndCornersReferToWhatThereIs) {
  EXPECT_NO_THROW(checks_.indices("/i", {0, 4}, 5));
  expect_refused([&] { checks_.indices("/i", {0, 5}, 5); }, "/i[1]", "index 5 is not below 5");
  expect_refused([&] { checks_.indices("/i", {-1}, 5); }, "/i[0]", "index -1");
  const std::vector<std::array<std::int32_t, 3>> degenerate{{0, 1, 2}, {3, 1, 3}};
  expect_refused([&] { checks_.corners("/t", degenerate, 5); }, "/t[1]", "names a corner twice");
}

TEST_F(ChecksOfATarget, DigestsAreLowerCaseAndWhole) {
  const std::string digest(64, 'a');
  EXPECT_NO_THROW(checks_.digest("/d", digest, false));
  EXPECT_NO_THROW(checks_.digest("/d", "", true));
  for (const std::string& wrong :
       {std::string(), digest.substr(1), std::string(64, 'A'), std::string(64, 'g')})
    expect_refused([&] { checks_.digest("/d", wrong, false); }, "/d", "is not a SHA-256");
}

TEST_F(ChecksOfATarget, OffsetsAreRunningSums) {
  const auto check = [&](const std::vector<std::int64_t>& first,
                         const std::vector<std::int64_t>& count, std::size_t total) {
    check_offsets(checks_, "/first", "/count", first, count, total);
  };
  EXPECT_NO_THROW(check({0, 2, 2}, {2, 0, 3}, 5));
  expect_refused([&] { check({0, 3}, {2, 3}, 5); }, "/first[1]", "3 is not the sum");
  expect_refused([&] { check({0, 2}, {2, 4}, 5); }, "/count[1]", "leads beyond the 5 rows");
  expect_refused([&] { check({0, 2}, {2, 2}, 5); }, "/count", "sums to 4, 5 rows found");
  // A count that would overflow the sum.
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  expect_refused([&] { check({0, 2}, {2, kMost}, 5); }, "/count[1]", "leads beyond");
}

/// The file is at fault where it was read; inverted elements of it are bad geometry.
TEST(ChecksOfAFile, BlameTheFileAndSayHowToGetAnother) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "a.h5";
  hdf5::Writer(file).commit();
  const hdf5::Reader reader(file, "run palpate mesh again");
  const Checks checks(reader);
  expect_refusal([&] { checks.fail("/x", "is odd"); }, ErrorKind::Configuration, "a.h5:/x",
                 "is odd");
  expect_refusal([&] { checks.fail_geometry("/x", 2, "is flat"); }, ErrorKind::Geometry,
                 "a.h5:/x[2]", "is flat");
  try {
    checks.fail("/x", "is odd");
  } catch (const Error& error) {
    EXPECT_EQ(error.remedy(), "run palpate mesh again");
  }
}

}  // namespace
}  // namespace palpate
