// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/repair_file.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"

namespace palpate::report {
namespace {

const DistanceMap kFile{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {0, 0.25, 0.5}};
const std::string kDigest(64, 'a');

Provenance made_of(const std::string& sha256) {
  Provenance body;
  ProvenanceStep step;
  step.stage = "mesh";
  step.inputs = {{"bone.off", std::string(64, 'b')}, {"skin.off", sha256}};
  body.steps.push_back(step);
  return body;
}

TEST(RepairFile, PageReceivesBothSurfaces) {
  const auto data = repair_data(repair_text(kDigest, kFile, kFile), made_of(kDigest));
  for (const char* name : {"file", "repaired"}) {
    const auto& map = data.at(name);
    EXPECT_EQ(map.at("facets").at("u2"), "AAABAAIA");            // 0 1 2, two bytes each
    EXPECT_EQ(map.at("distance").at("f4"), "AAAAAAAAgD4AAAA/");  // 0, 1/4, 1/2 in four bytes
    EXPECT_TRUE(map.contains("points"));
  }
}

TEST(RepairFile, IsAbsentOrOfAnotherSurface) {
  EXPECT_TRUE(repair_data("", made_of(kDigest)).is_null());
  const auto data = repair_data(repair_text(kDigest, kFile, kFile), made_of(std::string(64, 'c')));
  EXPECT_EQ(data, nlohmann::json({{"other_surface", true}}));
}

TEST(RepairFile, RefusesWhatItDidNotWrite) {
  const std::string sound = repair_text(kDigest, kFile, kFile);
  for (std::string text : {std::string("{"), std::string("[1]"), std::string("{\"kind\": 1}"),
                           sound.substr(0, sound.size() / 2)}) {
    EXPECT_THROW(repair_data(text, made_of(kDigest)), Error) << text;
  }
  auto json = nlohmann::json::parse(sound);
  json["repaired"].erase("distance");
  EXPECT_THROW(repair_data(json.dump(), made_of(kDigest)), Error);
  json = nlohmann::json::parse(sound);
  json["surface_sha256"] = 5;
  EXPECT_THROW(repair_data(json.dump(), made_of(kDigest)), Error);
}

}  // namespace
}  // namespace palpate::report
