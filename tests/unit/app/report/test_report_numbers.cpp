// SPDX-License-Identifier: AGPL-3.0-or-later
// The numbers in the written file, read back from its bytes, against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/report/embed.hpp"
#include "app/report/figures.hpp"
#include "app/report/page_data.hpp"
#include "app/report/report.hpp"
#include "app/report/surface_map.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace palpate {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A folder of its own for each test, removed with it.
class Report : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  ReportInput input(bool recording = true) {
    session_ = report::digest(all_.recording);
    return {&all_.body, &all_.curves, &all_.library, recording ? &*session_ : nullptr,
            "Lump",     1234};
  }
  std::string written(const ReportInput& from) {
    write_report(from, folder_ / "report.html");
    return file_text(folder_ / "report.html");
  }
  /// The data element of the written page, parsed.
  json embedded(const ReportInput& from) {
    const std::string html = written(from);
    const std::string open = "<script type=\"application/json\" id=\"data\">";
    const std::size_t begin = html.find(open) + open.size();
    return json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("palpate_report_" + std::to_string(getpid()) + "_" +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
  testing::Synthetic all_ = testing::synthetic(2, 1);
  std::optional<report::SessionDigest> session_;
};

/// Decode base64 bit by bit from its definition, so that it is not the encoder run backwards.
std::string decoded(const std::string& text) {
  std::string bits, bytes;
  for (const char c : text) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t value = digits.find(c);
    EXPECT_NE(value, std::string::npos) << c;
    for (int bit = 5; bit >= 0; --bit) bits += (value >> bit & 1U) != 0 ? '1' : '0';
  }
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8)
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  return bytes;
}

template <class Number>
std::vector<Number> numbers(const json& column, const char* type) {
  const std::string bytes = decoded(column.at(type).get<std::string>());
  std::vector<Number> values(bytes.size() / sizeof(Number));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(Columns, TakeTheNarrowestTypeThatHoldsTheValues) {
  EXPECT_EQ(numbers<std::uint16_t>(report::index_column({0, 65535}), "u2").at(1), 65535);
  EXPECT_EQ(numbers<std::uint32_t>(report::index_column({0, 65536}), "u4").at(1), 65536U);
  EXPECT_EQ(numbers<std::int32_t>(report::index_column({-1, 70000}), "i4").at(0), -1);
  EXPECT_EQ(numbers<std::uint16_t>(report::fraction_column({0, 0.5, 1, 1 + 1e-9}), "u2"),
            (std::vector<std::uint16_t>{0, 32768, 65535, 65535}));
}

TEST_F(Report, EmbedsTheStoredCurvesBitForBit) {
  const json data = embedded(input());
  const auto offset = numbers<std::uint32_t>(data["normal"]["offset"], "u4");
  const auto knot = numbers<float>(data["normal"]["knot"], "f4");
  const auto slope = numbers<float>(data["normal"]["slope"], "f4");
  ASSERT_EQ(offset.size(), all_.library.responses.size() + 1);
  for (std::size_t v = 0; v < all_.library.responses.size(); ++v) {
    const NodeResponse& response = all_.library.responses[v];
    const std::size_t size =
        response.status == ResponseStatus::Hole ? 0 : response.normal.knot.size();
    ASSERT_EQ(offset[v + 1] - offset[v], size);
    for (std::size_t k = 0; k < size; ++k) {
      EXPECT_EQ(knot[offset[v] + k], response.normal.knot[k]);
      EXPECT_EQ(slope[offset[v] + k], response.normal.slope[k]);
    }
  }
}

TEST_F(Report, TheStiffestNodeIsTheOneWithTheLargestClosedForm) {
  // The fixture interpolates c d^1.5, so stiffness ranks as the Hertz factor of the position.
  double largest = 0, smallest = 1e9;
  std::int32_t stiffest = -1, softest = -1;
  for (std::size_t v = 0; v < all_.library.responses.size(); ++v) {
    if (all_.library.responses[v].status == ResponseStatus::Hole) continue;
    const double c = testing::hertz_factor(all_.library.positions[v]);
    if (c > largest) largest = c, stiffest = static_cast<std::int32_t>(v);
    if (c < smallest) smallest = c, softest = static_cast<std::int32_t>(v);
  }
  const json chosen = embedded(input())["chosen"];
  EXPECT_EQ(chosen["stiffest"], stiffest);
  EXPECT_EQ(chosen["softest"], softest);
}

TEST_F(Report, AtMostHalfOfTheNodesAreSofterThanTheMedianAndAtMostHalfStiffer) {
  const auto median = embedded(input())["chosen"]["median"].get<std::int32_t>();
  const double own = testing::hertz_factor(all_.library.positions[to_index(median)]);
  int softer = 0, stiffer = 0, size = 0;
  for (std::size_t v = 0; v < all_.library.responses.size(); ++v) {
    if (all_.library.responses[v].status == ResponseStatus::Hole) continue;
    const double c = testing::hertz_factor(all_.library.positions[v]);
    ++size;
    softer += c < own * (1 - 1e-6) ? 1 : 0;  // slopes are stored in single precision
    stiffer += c > own * (1 + 1e-6) ? 1 : 0;
  }
  ASSERT_GT(size, 50);
  EXPECT_LE(softer, size / 2);
  EXPECT_LE(stiffer, size / 2);
}

/// The device may have the body anywhere: on the page the tool is where it was on the body. The
/// sums are of double precision, the columns of single.
TEST(SessionData, IsInTheFrameOfTheBody) {
  Recording recording = testing::synthetic(1, 1).recording;
  const json there = report::session_data(report::digest(recording));
  recording.settings.body_position = {0.5, -0.25, 1};
  for (RecordedStep& step : recording.steps) {
    step.contact_point = step.contact_point + recording.settings.body_position;
    step.position = step.position + recording.settings.body_position;
  }
  const json moved = report::session_data(report::digest(recording));
  EXPECT_EQ(moved["drawn"]["contact"], there["drawn"]["contact"]);
  EXPECT_EQ(moved["drawn"]["position"], there["drawn"]["position"]);
}

TEST(SecantStiffness, OfAPiecewiseLinearSlopeInClosedForm) {
  NodeResponse response;
  response.status = ResponseStatus::Fitted;
  response.normal = {{0.0F, 0.25F, 0.5F}, {0.0F, 8.0F, 16.0F}};  // f = 16 d^2, then slope 16
  EXPECT_DOUBLE_EQ(report::secant_stiffness(response, ResponseKind::Decoupled, 0.125), 2.0);
  EXPECT_DOUBLE_EQ(report::secant_stiffness(response, ResponseKind::Decoupled, 0.5), 8.0);
  EXPECT_DOUBLE_EQ(report::secant_stiffness(response, ResponseKind::Decoupled, 1.0),
                   12.0);  // 4 + 16 * 0.5 at d = 1
  response.status = ResponseStatus::Hole;
  EXPECT_TRUE(std::isnan(report::secant_stiffness(response, ResponseKind::Decoupled, 0.5)));
}

TEST_F(Report, CountsTheSitesAndTheDeepestPress) {
  const json key = embedded(input())["key"];
  std::array<int, 3> counts{};
  for (const SiteCurves& site : all_.curves.sites) ++counts[static_cast<std::size_t>(site.status)];
  ASSERT_GT(counts[1], 0);
  ASSERT_GT(counts[2], 0);
  EXPECT_EQ(key["complete"], counts[0]);
  EXPECT_EQ(key["partial"], counts[1]);
  EXPECT_EQ(key["failed"], counts[2]);
  EXPECT_DOUBLE_EQ(key["deepest"].get<double>(), testing::kDepth);
  EXPECT_EQ(key["library_bytes"], 1234);
  double largest = 0;  // the Hertz force of the stiffest complete site, at full depth
  for (const SiteCurves& site : all_.curves.sites) {
    if (site.status != SiteStatus::Complete) continue;
    largest =
        std::max(largest, testing::hertz_factor(all_.library.positions[to_index(site.vertex)]) *
                              std::pow(testing::kDepth, 1.5));
  }
  EXPECT_NEAR(key["max_force"].get<double>(), largest, 1e-9 * largest);
  EXPECT_DOUBLE_EQ(key["volume_change"].get<double>(), testing::kLeastVolumeChange);
  EXPECT_DOUBLE_EQ(key["min_jacobian"].get<double>(), 0.5);
}

TEST_F(Report, KnowsNoVolumeChangeOfMeasuredCurves) {
  for (SiteCurves& site : all_.curves.sites)
    for (CurvePath& path : site.paths)
      for (CurveSample& sample : path.samples)
        sample.volume_change = sample.min_jacobian = kUnknown;
  const json key = embedded(input())["key"];
  EXPECT_TRUE(key["volume_change"].is_null());
  EXPECT_TRUE(key["min_jacobian"].is_null());
}

TEST_F(Report, FindsTheWorstEnergyBalance) {
  const json worst = embedded(input())["balance"]["worst"];
  double largest = 0;
  std::int32_t vertex = -1;
  for (const SiteCurves& site : all_.curves.sites) {
    if (site.paths.empty() || testing::balance_gap(site.vertex) <= largest) continue;
    largest = testing::balance_gap(site.vertex);
    vertex = site.vertex;
  }
  EXPECT_EQ(worst["vertex"], vertex);
  EXPECT_EQ(worst["kind"], 0);
  EXPECT_NEAR(worst["difference"].get<double>(), largest, 1e-9);
}

TEST_F(Report, ColoursTheFineBoundaryFromTheTrianglesItRefines) {
  const report::SurfaceMap map = report::map_boundary(all_.body);
  ASSERT_EQ(map.facets.size(), all_.body.boundary.size());
  // The fixture splits each patch in four and keeps the order, so that the truth is known.
  for (std::size_t f = 0; f < map.facets.size(); ++f)
    EXPECT_EQ(map.facet_triangle[f], static_cast<std::int32_t>(f / 4));
  for (std::size_t p = 0; p < map.node.size(); ++p) {
    const auto& natural = map.natural[p];
    EXPECT_NEAR(natural[0] + natural[1] + natural[2], 1, 1e-12);
    if (to_index(map.node[p]) >= all_.library.positions.size()) continue;
    // A point that is a response vertex takes the value of that vertex alone.
    const auto l = std::max_element(natural.begin(), natural.end()) - natural.begin();
    EXPECT_NEAR(natural[static_cast<std::size_t>(l)], 1, 1e-9);
    EXPECT_EQ(all_.body.response.triangles[to_index(map.triangle[p])][static_cast<std::size_t>(l)],
              map.node[p]);
  }
}

TEST(NearestOnTriangle, AgreesWithAFineScanOfTheTriangle) {
  const Vec3 a{0, 0, 0}, b{2, 0, 0}, c{0.5, 1.5, 0.3};
  const int n = 400;
  for (const Vec3& p : {Vec3{0.7, 0.4, 1}, Vec3{-1, -1, 0.2}, Vec3{3, 0.1, -0.5}, Vec3{1, -2, 0},
                        Vec3{2, 2, 1}, Vec3{-1, 1, 0}, Vec3{0.5, 3, 0.3}}) {
    double least = 1e9;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3 q = a + (1.0 * i / n) * (b - a) + (1.0 * j / n) * (c - a);
        least = std::min(least, norm(p - q));
      }
    }
    const auto found = report::nearest_on_triangle(p, a, b, c);
    EXPECT_NEAR(std::sqrt(found.distance2), least, 0.01);
    EXPECT_LE(std::sqrt(found.distance2), least + 1e-12);
    const Vec3 q = found.natural[0] * a + found.natural[1] * b + found.natural[2] * c;
    EXPECT_NEAR(norm(p - q), std::sqrt(found.distance2), 1e-12);
  }
}

TEST_F(Report, GreysWhatCannotBeTouched) {
  const json surface = embedded(input())["surface"];
  const auto kind = numbers<std::uint8_t>(surface["facet_kind"], "u1");
  ASSERT_EQ(kind.size(), all_.body.boundary.size());
  for (std::size_t f = 0; f < kind.size(); ++f) {
    bool touchable = true;
    for (const std::int32_t v : all_.body.response.triangles[f / 4])
      touchable = touchable && all_.library.responses[to_index(v)].status != ResponseStatus::Hole;
    EXPECT_EQ(kind[f] == 0, touchable) << f;
    bool fixed = true;
    for (const std::int32_t n : all_.body.boundary[f])
      fixed = fixed && all_.body.nodes[to_index(n)][2] <= -0.018;
    EXPECT_EQ(kind[f] == 2, fixed && !touchable) << f;
  }
}

TEST_F(Report, KeepsThePeaksOfALongSession) {
  Recording& recording = all_.recording;
  recording.steps[4321].force = {9, 0, 0};
  recording.steps[1234].latency_ns = 5000000;
  const json session = embedded(input())["session"];
  const auto fx = numbers<float>(session["drawn"]["fx"], "f4");
  EXPECT_LT(fx.size(), recording.steps.size());
  EXPECT_EQ(*std::max_element(fx.begin(), fx.end()), 9.0F);
  EXPECT_DOUBLE_EQ(session["max_force"], 9);
  EXPECT_DOUBLE_EQ(session["latency"]["max"], 5e-3);
  const auto time = numbers<float>(session["drawn"]["time"], "f4");
  EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
  EXPECT_EQ(session["steps"], recording.steps.size());
  const auto in_contact = [](const RecordedStep& s) { return s.depth > 0; };
  EXPECT_EQ(session["counts"]["contact"],
            std::count_if(recording.steps.begin(), recording.steps.end(), in_contact));
}

TEST_F(Report, TellsABrokenEnergyAccount) {
  all_.recording.steps[2500].absorbed = all_.recording.steps[2500].energy - 1e-5;
  const json margin = embedded(input())["session"]["margin"];
  EXPECT_NEAR(margin["least"].get<double>(), -1e-5, 1e-12);
  EXPECT_NEAR(margin["time"].get<double>(), 2.5, 1e-9);
}

TEST(Percentile, IsNearestRank) {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(report::percentile(values, 0.5), 500);
  EXPECT_EQ(report::percentile(values, 0.99), 990);
  EXPECT_EQ(report::percentile(values, 0.999), 999);
  EXPECT_EQ(report::percentile(values, 1.0), 1000);
  values = {7};
  EXPECT_EQ(report::percentile(values, 0.999), 7);
}

TEST_F(Report, WhatIsMissingIsNullNotZero) {
  all_.library.certificate = {};
  const json data = embedded(input(false));
  EXPECT_TRUE(data["session"].is_null());
  EXPECT_TRUE(data["certificate"].is_null());
}

TEST_F(Report, ReadsTheMaterialsOfTheResolvedCase) {
  const json chain = embedded(input())["provenance"];
  ASSERT_EQ(chain.size(), 5U);  // mesh, precompute, fit, certify, simulate: each once
  EXPECT_EQ(chain[1]["stage"], "precompute");
  EXPECT_EQ(chain[4]["stage"], "simulate");
  EXPECT_EQ(chain[1]["materials"][1],
            json::parse(R"([["region","nodule"],["law","neo-hookean"],["young","60 kPa"],)"
                        R"(["poisson","0.45"]])"));
}

TEST_F(Report, NamesFromFilesAreNeverMarkup) {
  const std::string hostile = "</script><script>alert(1)</script><b>&\"'\xff";
  all_.body.name = all_.curves.tool.shape = hostile;
  all_.library.provenance.steps[0].facts = {{hostile, hostile}};
  ReportInput from = input();
  from.title = hostile;
  const std::string html = written(from);
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, Not(HasSubstr("<b>&")));
  EXPECT_THAT(html, HasSubstr("<title>&lt;/script&gt;&lt;script&gt;alert(1)"));
  EXPECT_EQ(embedded(from)["body"]["name"],
            "</script><script>alert(1)</script><b>&\"'\xEF\xBF\xBD");
}

TEST_F(Report, AsksNothingOfTheNetwork) {
  const std::string html = written(input());
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  for (const char* reference : {"src=\"http", "href=\"http", "url(http", "@import", "fetch("})
    EXPECT_THAT(html, Not(HasSubstr(reference)));
}

TEST_F(Report, RefusesArtifactsThatDoNotFitTogether) {
  const auto problem = [&] {
    try {
      write_report(input(), folder_ / "refused.html");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.html"));
      return error.problem();
    }
    return std::string("accepted");
  };
  const testing::Synthetic sound = all_;
  all_.library.responses.pop_back();
  EXPECT_THAT(problem(), HasSubstr("numbers of vertices"));
  all_ = sound;
  all_.curves.sites[3].vertex = 100000;
  EXPECT_THAT(problem(), HasSubstr("a vertex of the curves is not in the body"));
  all_ = sound;
  all_.library.certificate.triangles.pop_back();
  EXPECT_THAT(problem(), HasSubstr("numbers of triangles"));
  ReportInput none = input();
  none.library = nullptr;
  EXPECT_THROW(write_report(none, folder_ / "refused.html"), Error);
}

TEST_F(Report, AFailedWriteLeavesTheOldReport) {
  const std::string before = written(input());
  all_.library.responses.pop_back();
  EXPECT_THROW(write_report(input(), folder_ / "report.html"), Error);
  EXPECT_EQ(file_text(folder_ / "report.html"), before);
  EXPECT_THROW(write_report({}, "/nonexistent/folder/report.html"), Error);
}

}  // namespace
}  // namespace palpate
