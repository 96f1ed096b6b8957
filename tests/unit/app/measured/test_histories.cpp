// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/histories.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

Histories sample() {
  Histories h{"gel", "gel", "nobody", "CC0-1.0", "abc", {"sphere", 5e-3, "frictionless"}, {}};
  SiteHistory site;
  site.vertex = 4;
  site.history.name = "a.csv";
  site.history.control = measured::Control::Force;
  site.history.time = {0, 0.1, 0.3};
  site.history.travel = {-1e-4, 1.0 / 3, 2};
  site.history.force = {0, 0.1, 0.2};
  site.history.phases = {{measured::PhaseKind::Ramp, 1, 3}};
  h.records.push_back(site);
  return h;
}

class HistoriesFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(folder_ / "histories.json") << text;
    return folder_ / "histories.json";
  }
  std::string refusal(const std::string& text) const {
    try {
      read_histories(write(text));
    } catch (const Error& error) {
      return error.what();
    }
    return "read";
  }
  const samples::TemporaryFolder folder_;
};

TEST_F(HistoriesFile, IsReadAsItWasWritten) {
  const Histories read = read_histories(write(histories_json(sample()).dump()));
  EXPECT_EQ(read.body_sha256, "abc");
  EXPECT_EQ(read.tool.radius, 5e-3);
  ASSERT_EQ(read.records.size(), 1u);
  const measured::History &a = read.records[0].history, b = sample().records[0].history;
  EXPECT_EQ(read.records[0].vertex, 4);
  EXPECT_EQ(a.control, b.control);
  EXPECT_EQ(a.travel, b.travel);
  EXPECT_EQ(a.phases, b.phases);
}

TEST_F(HistoriesFile, IsRefusedWhereItIsDamaged) {
  EXPECT_THAT(refusal("{"), HasSubstr("no histories.json"));
  auto json = histories_json(sample());
  json["records"][0]["force_N"] = {1, 2};
  EXPECT_THAT(refusal(json.dump()), HasSubstr("different lengths"));
  json = histories_json(sample());
  json["records"][0]["time_s"] = {0, 2, 1};
  EXPECT_THAT(refusal(json.dump()), HasSubstr("does not increase"));
  json = histories_json(sample());
  json["records"][0]["phases"][0]["end"] = 9;
  EXPECT_THAT(refusal(json.dump()), HasSubstr("a phase is not one of the record"));
  json = histories_json(sample());
  json["records"][0].erase("vertex");
  EXPECT_NE(refusal(json.dump()), "read");
}

}  // namespace
}  // namespace palpate::app
