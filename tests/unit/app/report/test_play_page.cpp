// SPDX-License-Identifier: AGPL-3.0-or-later
// What the page has of a library alone.
#include "app/report/play_page.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "app/report/report.hpp"
#include "format/base64.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/unit/app/report/skins.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace palpate::report {
namespace {

template <class T>
std::vector<T> numbers(const nlohmann::json& column, const char* type) {
  const std::string bytes = from_base64(column.at(type).get<std::string>()).value();
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(PlayPage, DrawsTheResponseSurfaceWithItsHolesGrey) {
  const Library library = testing::synthetic(2, 0).library;
  const auto data = play_data(library);
  const auto& surface = data.at("surface");
  const auto corners = numbers<std::uint16_t>(surface.at("triangles"), "u2");
  const auto kinds = numbers<std::uint8_t>(surface.at("facet_kind"), "u1");
  ASSERT_EQ(corners.size(), 3 * library.triangles.size());
  ASSERT_EQ(kinds.size(), library.triangles.size());
  int grey = 0;
  for (std::size_t m = 0; m < kinds.size(); ++m) {
    bool hole = false;
    for (std::size_t l = 0; l < 3; ++l) {
      EXPECT_EQ(corners[3 * m + l], library.triangles[m][l]);
      const auto& response = library.responses[to_index(library.triangles[m][l])];
      hole = hole || response.status == ResponseStatus::Hole;
    }
    EXPECT_EQ(kinds[m] != 0, hole);
    grey += hole ? 1 : 0;
  }
  EXPECT_GT(grey, 0);
}

TEST(PlayPage, HasEachPointAtItselfInOneOfTheTriangles) {
  const Library library = testing::synthetic(2, 0).library;
  const auto surface = play_data(library).at("surface");
  const auto points = numbers<float>(surface.at("points"), "f4");
  const auto triangle = numbers<std::uint16_t>(surface.at("point_triangle"), "u2");
  const auto natural = numbers<std::uint16_t>(surface.at("point_natural"), "u2");
  ASSERT_EQ(points.size(), 3 * triangle.size());
  for (std::size_t p = 0; p < triangle.size(); ++p) {
    const double first = natural[2 * p] / 65535.0, second = natural[2 * p + 1] / 65535.0;
    const Triangle& t = library.triangles[triangle[p]];
    const Vec3 at = first * library.positions[to_index(t[0])] +
                    second * library.positions[to_index(t[1])] +
                    (1 - first - second) * library.positions[to_index(t[2])];
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(static_cast<float>(at[k]), points[3 * p + k]);
  }
}

/// The first triangles of the library are taken from it.
Library with_part(std::size_t left_out) {
  Library library = testing::synthetic(2, 0).library;
  library.certificate = {};
  library.triangles.erase(library.triangles.begin(),
                          library.triangles.begin() + static_cast<std::ptrdiff_t>(left_out));
  return library;
}

TEST(PlayPage, DrawsThePartThatCanBePressedWhereNothingElseIsKnown) {
  const Library library = with_part(200);
  const auto surface = play_data(library).at("surface");
  EXPECT_EQ(numbers<std::uint8_t>(surface.at("facet_kind"), "u1").size(), library.triangles.size());
  EXPECT_LT(numbers<float>(surface.at("points"), "f4").size(), 3 * library.positions.size());
}

TEST(PlayPage, DrawsTheRestOfTheSurfaceGrey) {
  const std::vector<Triangle> all = testing::synthetic(2, 0).library.triangles;
  const Library library = with_part(200);
  const auto surface = play_data(library, {nullptr, all}).at("surface");
  const auto kinds = numbers<std::uint8_t>(surface.at("facet_kind"), "u1");
  const auto own = numbers<std::int32_t>(surface.at("library_triangle"), "i4");
  ASSERT_EQ(kinds.size(), all.size());
  for (std::size_t m = 0; m < all.size(); ++m) {
    EXPECT_EQ(own[m], m < 200 ? -1 : static_cast<std::int32_t>(m) - 200);
    if (m < 200) {
      EXPECT_EQ(kinds[m], 1);
    }
  }
}

TEST(PlayPage, DrawsTheBodyWithItsInclusionsAndRefusesAnotherOne) {
  const auto all = testing::synthetic(2, 1);
  const auto data = play_data(all.library, {&all.body});
  const auto kinds = numbers<std::uint8_t>(data.at("surface").at("facet_kind"), "u1");
  EXPECT_EQ(kinds.size(), all.body.boundary.size());
  EXPECT_THROW(play_data(testing::synthetic(1, 1).library, {&all.body}), Error);
}

TEST(PlayPage, IsPressedNoDeeperThanEveryResponseIsKnown) {
  Library library = testing::synthetic(1, 0).library;
  library.certificate.depth = 0.004;
  EXPECT_EQ(play_data(library).at("key").at("depth"), 0.004);
  library.certificate = {};
  double shallowest = 1;
  for (const NodeResponse& node : library.responses)
    if (node.status != ResponseStatus::Hole)
      shallowest = std::min(shallowest, static_cast<double>(node.normal.knot.back()));
  EXPECT_EQ(play_data(library).at("key").at("depth"), shallowest);
  EXPECT_TRUE(play_data(library).at("certificate").is_null());
}

TEST(PlayPage, NeedsOneResponse) {
  Library library = testing::synthetic(1, 0).library;
  for (NodeResponse& node : library.responses) node = {};
  EXPECT_THROW(play_data(library), Error);
}

TEST(WatchPage, MayAskItsOwnServerAndNothingElse) {
  const Library library = testing::synthetic(1, 0).library;
  const std::string page = watch_page(library);
  EXPECT_NE(page.find("content=\"default-src 'none'; connect-src 'self'; style-src"),
            std::string::npos);
  EXPECT_EQ(page_text(play_data(library)).find("connect-src"), std::string::npos);
  EXPECT_TRUE(watch_data(library).at("watch").get<bool>());
}

TEST(WatchPage, HasTheSkinWhereThereIsADeformation) {
  const auto all = testing::synthetic(2, 1);
  const std::string of_body = testing::deformation_bytes(all.body, all.library);
  const std::string of_surface = testing::surface_deformation_bytes(all.body, all.library);
  const std::vector<PlayBody> kinds{
      {.body = &all.body, .deformation = of_body},
      {.triangles = all.body.response.triangles, .deformation = of_surface}};
  for (const PlayBody& drawn : kinds) {
    const auto data = watch_data(all.library, drawn);
    if (data.at("touch").is_null()) GTEST_SKIP() << "built without the WebAssembly toolchain";
    const auto points = numbers<float>(data.at("surface").at("points"), "f4");
    const auto rows = numbers<std::uint16_t>(data.at("touch").at("skin").at("of_point"), "u2");
    EXPECT_EQ(3 * rows.size(), points.size());
  }
  EXPECT_TRUE(watch_data(all.library, {&all.body}).at("touch").at("skin").is_null());
}

}  // namespace
}  // namespace palpate::report
