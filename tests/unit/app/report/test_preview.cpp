// SPDX-License-Identifier: AGPL-3.0-or-later
// What the preview shows of a body.
#include "app/report/preview.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/report/repair_file.hpp"
#include "app/report/surface_map.hpp"
#include "format/base64.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace palpate::report {
namespace {

const std::string kSurface(64, 'a');

/// The lump, whose lowest part is fixed; made of a file.
Body lump() {
  Body body = testing::synthetic(1, 1).body;
  ProvenanceStep step;
  step.stage = "mesh";
  step.inputs = {{"lump.off", kSurface}};
  body.provenance.steps = {step};
  return body;
}

template <class T>
std::vector<T> decoded(const nlohmann::json& column) {
  const std::string bytes = from_base64(column.front().get<std::string>()).value();
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(Preview, MarksSupportsPressZonesAndSites) {
  Body body = lump();
  // The press zone is the upper half: of the sites only those above stay.
  for (std::size_t v = 0; v < body.response.node.size(); ++v)
    if (body.nodes[static_cast<std::size_t>(body.response.node[v])][2] < 0)
      body.response.is_site[v] = 0;
  const auto data = preview_data(body, "");
  EXPECT_TRUE(data.at("distance").is_null());
  const auto kinds = decoded<std::uint8_t>(data.at("surface").at("facet_kind"));
  ASSERT_EQ(kinds.size(), body.boundary.size());
  const auto is_fixed = [&](std::int32_t n) {
    return std::binary_search(body.fixed_nodes.begin(), body.fixed_nodes.end(), n);
  };
  std::array<int, 3> count{};
  for (std::size_t f = 0; f < kinds.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    double highest = -1, lowest = 1;
    for (const std::int32_t n : facet) {
      highest = std::max(highest, body.nodes[static_cast<std::size_t>(n)][2]);
      lowest = std::min(lowest, body.nodes[static_cast<std::size_t>(n)][2]);
    }
    ++count.at(kinds[f]);
    EXPECT_EQ(kinds[f] == 2, std::all_of(facet.begin(), facet.end(), is_fixed)) << f;
    if (kinds[f] == 0) {
      EXPECT_GE(highest, 0) << f;
    }
  }
  for (const int of_kind : count) EXPECT_GT(of_kind, 0);
  const auto status = decoded<std::uint8_t>(data.at("vertices").at("response_status"));
  for (std::size_t v = 0; v < status.size(); ++v)
    EXPECT_EQ(status[v] == 0, body.response.is_site[v] != 0) << v;
}

TEST(Preview, FacetsOnSpringsAreSupports) {
  Body body = lump();
  body.fixed_nodes.clear();
  body.foundation = {{3, 1e5, 0}};
  const auto kinds = decoded<std::uint8_t>(preview_data(body, "").at("surface").at("facet_kind"));
  EXPECT_EQ(kinds[3], 2);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), 2), 1);
}

/// A field that is linear on the triangles of the repaired surface comes back at the nodes.
TEST(Preview, ShowsHowFarRepairMovedTheSurface) {
  const Body body = lump();
  DistanceMap repaired;
  repaired.points = body.nodes;
  repaired.triangles = body.boundary;
  for (const Vec3& x : body.nodes) repaired.distance.push_back(0.5 + x[2]);
  const auto data = preview_data(body, repair_text(kSurface, repaired, repaired));
  const auto distance = decoded<float>(data.at("distance"));
  const SurfaceMap map = map_boundary(body);
  ASSERT_EQ(distance.size(), map.node.size());
  for (std::size_t p = 0; p < distance.size(); ++p)
    EXPECT_NEAR(distance[p], 0.5 + body.nodes[static_cast<std::size_t>(map.node[p])][2], 1e-6);
  // The repair of another surface is not shown.
  EXPECT_TRUE(preview_data(body, repair_text(std::string(64, 'c'), repaired, repaired))
                  .at("distance")
                  .is_null());
}

TEST(Preview, IsOneFile) {
  const samples::TemporaryFolder folder;
  Body body = lump();
  body.name = "a <b> & c";
  write_preview(body, "", folder / "preview.html");
  std::ostringstream text;
  text << std::ifstream(folder / "preview.html").rdbuf();
  EXPECT_NE(text.str().find("<title>a &lt;b&gt; &amp; c</title>"), std::string::npos);
  EXPECT_EQ(text.str().find("src=\"http"), std::string::npos);
}

}  // namespace
}  // namespace palpate::report
