// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/inspect/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/unit/format/sample_artifacts.hpp"
#include "tests/unit/format/temporary_folder.hpp"

namespace palpate::app {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::ordered_json summary_of(const Library& library) {
  const samples::TemporaryFolder folder;
  write_library(folder / "library.h5", library);
  return summarize_artifact(folder / "library.h5");
}

TEST(Inspect, SaysWhichDeviceIsCertifiedAndWhichIsNot) {
  const auto summary = summary_of(samples::library(4));
  const auto& devices = summary["certificate"]["devices"];
  ASSERT_EQ(devices.size(), 2u);
  EXPECT_EQ(devices[0]["verdict"], "certified passive from 638 Hz");
  EXPECT_EQ(devices[0]["lowest_certified_rate"]["value"], 637.5);
  EXPECT_EQ(devices[1]["verdict"], "damping unknown: not certified for this device");
  EXPECT_TRUE(devices[1]["damping"]["value"].is_null());
  const std::string text = summary_text(summary);
  EXPECT_THAT(text, HasSubstr("lowest certified rate: 637.5 Hz\n"));
  EXPECT_THAT(text, HasSubstr("damping: unknown\n"));
}

TEST(Inspect, CallsAnInfiniteBoundNotCertified) {
  Library library = samples::library(4);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  library.certificate.slip = kInfinity;
  library.certificate.devices[0].lowest_rate = kInfinity;
  const auto summary = summary_of(library);
  EXPECT_TRUE(summary["certificate"]["L_slip"]["value"].is_null());
  const std::string text = summary_text(summary);
  EXPECT_THAT(text, HasSubstr("L slip: not certified: no bound\n"));
  EXPECT_THAT(text, HasSubstr("verdict: not certified: the slide has no bound\n"));
  EXPECT_THAT(text, HasSubstr("lowest certified rate: not certified: no bound\n"));
  EXPECT_THAT(text, Not(ContainsRegex("[^a-z](inf|nan)[^a-z]")));
}

}  // namespace
}  // namespace palpate::app
