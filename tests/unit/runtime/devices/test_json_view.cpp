// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/json_view.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>

namespace palpate::test {
namespace {

using runtime::JsonView;

TEST(JsonView, FindsValuesInNestedText) {
  const JsonView json(R"( {"a": [1, {"b": "x]}\"y", "c": -2.5e-3}], "d": true, "e": {}} )");
  double value = 0;
  ASSERT_TRUE(json["a"][1]["c"].number(value));
  EXPECT_EQ(value, -2.5e-3);
  EXPECT_EQ(json["a"][1]["b"].string(), R"(x]}\"y)");
  EXPECT_TRUE(json["a"][0].number(value));
  EXPECT_EQ(value, 1);
  EXPECT_FALSE(json["a"][2]);
  EXPECT_FALSE(json["f"]);
  EXPECT_FALSE(json["e"]["f"]);
  EXPECT_FALSE(json["d"].number(value));
  EXPECT_EQ(value, 1);  // untouched
}

TEST(JsonView, SurvivesWhatIsNoJson) {
  const std::string whole = R"({"inverse3":[{"device_id":"049D","state":{"x":{"y":[1,2,3]}}}]})";
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    const JsonView json(std::string_view(whole).substr(0, cut));
    EXPECT_FALSE(json["inverse3"][0]["state"]["x"]["y"][2]) << cut;
  }
  EXPECT_FALSE(JsonView(std::string(100000, '[')));
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {  // any damage: an answer or none, never a crash
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    double value = 0;
    JsonView(damaged)["inverse3"][0]["state"]["x"]["y"][1].number(value);
  }
}

}  // namespace
}  // namespace palpate::test
