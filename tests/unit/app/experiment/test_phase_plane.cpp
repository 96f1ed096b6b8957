// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/phase_plane.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The points of each curve of the picture.
std::vector<std::vector<std::pair<double, double>>> curves_of(const std::string& svg) {
  const std::string mark = "<polyline points=\"";
  std::vector<std::vector<std::pair<double, double>>> curves;
  for (auto at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1)) {
    const auto first = at + mark.size();
    std::istringstream points(svg.substr(first, svg.find('"', first) - first));
    curves.emplace_back();
    char comma = 0;
    for (double x = 0, y = 0; points >> x >> comma >> y;) curves.back().emplace_back(x, y);
  }
  return curves;
}

class PhasePlanes : public testing::Test {
 protected:
  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "out";
};

TEST_F(PhasePlanes, CsvHasEverySampleInSi) {
  write_phase_csv(file_, {{-0.03, 0}, {0.0123456789, 1.05}});
  EXPECT_EQ(text_of(file_), "position_m,velocity_m_per_s\n-0.03,0\n0.0123456789,1.05\n");
}

/// A panel a plane; position to the right, velocity upwards, and both to scale.
TEST_F(PhasePlanes, DrawThePositionToTheRightAndTheVelocityUpwards) {
  const std::vector<PhasePoint> cross{{0, 0}, {0.01, 0}, {0.02, 0}, {0, 0.5}, {0, 1}};
  write_phase_planes(file_, {{"first", cross}, {"second", {{0, 0}}}});
  const std::string svg = text_of(file_);
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 2u);
  ASSERT_EQ(curves[0].size(), 5u);
  const auto [x, y] = curves[0][0];
  EXPECT_GT(curves[0][1].first, x);
  EXPECT_NEAR(curves[0][2].first - x, 2 * (curves[0][1].first - x), 0.02);
  EXPECT_EQ(curves[0][2].second, y);
  EXPECT_LT(curves[0][3].second, y);  // SVG counts downwards
  EXPECT_NEAR(curves[0][4].second - y, 2 * (curves[0][3].second - y), 0.02);
  EXPECT_EQ(curves[1][0], curves[0][0]);  // each panel has the same axes
  EXPECT_NE(svg.find(">first</text>"), std::string::npos);
  EXPECT_NE(svg.find(">second</text>"), std::string::npos);
}

TEST_F(PhasePlanes, AreThinnedToWhatAPictureCanShow) {
  const std::vector<PhasePoint> many(200000, {0.001, 0.1});
  write_phase_planes(file_, {{"many", many}});
  EXPECT_LE(curves_of(text_of(file_))[0].size(), 20001u);
  EXPECT_GE(curves_of(text_of(file_))[0].size(), 10000u);
}

TEST_F(PhasePlanes, AreRefusedWhereTheyCannotBeWritten) {
  EXPECT_THROW(write_phase_csv(folder_ / "none" / "a.csv", {}), Error);
}

}  // namespace
}  // namespace palpate::app
