// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "fitting/response/fit.hpp"
#include "fitting/response/interpolate.hpp"
#include "fitting/response/surface_interpolation.hpp"
#include "fitting/sampling/site_choice.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr double kStep = 0.005;
constexpr double kDepth = 0.006, kTravel = 0.003;
const Vec3 kInward{0, 0, -1};

using Field = std::function<double(const Vec3&)>;

/// A square plate of (n+1)^2 response vertices, `kStep` apart, in the plane z = 0.
Body plate(int n) {
  Body body;
  body.name = "plate";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      body.response.node.push_back(static_cast<std::int32_t>(body.nodes.size()));
      body.nodes.push_back({i * kStep, j * kStep, 0});
      body.response.inward.push_back(kInward);
      body.response.is_site.push_back(1);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      body.response.triangles.push_back({a, b, d});
      body.response.triangles.push_back({a, d, c});
    }
  return body;
}

const Vec3& position(const Body& body, std::int32_t vertex) {
  return body.nodes[static_cast<std::size_t>(vertex)];
}

/// Curves of a body that is stiffer where the field is larger: 500 N/m^1.5 times it.
SiteCurves press(const Body& body, std::int32_t vertex, const Field& field) {
  const double scale = field(position(body, vertex));
  SiteCurves site;
  site.vertex = vertex;
  site.status = SiteStatus::Complete;
  CurvePath normal{PathKind::Normal, 0, kInward, {}};
  for (int i = 0; i <= 12; ++i) {
    CurveSample sample;
    sample.displacement = kDepth * i / 12;
    sample.force = 500 * scale * std::pow(sample.displacement, 1.5) * kInward;
    normal.samples.push_back(sample);
  }
  CurvePath lateral{PathKind::Lateral, kDepth, {1, 0, 0}, {}};
  for (int i = 0; i <= 6; ++i) {
    CurveSample sample;
    sample.displacement = kTravel * i / 6;
    sample.force = normal.samples.back().force + Vec3{40 * scale * sample.displacement, 0, 0};
    lateral.samples.push_back(sample);
  }
  site.paths = {normal, lateral};
  return site;
}

Curves press_all(const Body& body, const std::vector<std::int32_t>& vertices, const Field& field) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  curves.depth = kDepth;
  curves.lateral_travel = kTravel;
  for (const std::int32_t vertex : vertices) curves.sites.push_back(press(body, vertex, field));
  return curves;
}

FitSettings interpolating() {
  FitSettings settings;
  settings.relative_tolerance = 3e-3;
  settings.absolute_tolerance = 1e-4;
  settings.interpolate = true;
  return settings;
}

double deepest_force(const Library& library, std::size_t vertex) {
  return runtime::CompiledCurve(library.responses[vertex].normal).force(kDepth);
}

double law(double scale) {
  return 500 * scale * std::pow(kDepth, 1.5);
}

double interpolated(const SurfaceInterpolation& field, const std::vector<Vec3>& positions,
                    std::size_t at, const Field& value) {
  double sum = 0;
  for (const Donor& donor : field.weights(at)) sum += donor.weight * value(positions[donor.vertex]);
  return sum;
}

/// Vertex 0 at the origin, then a square grid of side `h` in which it lies off the nodes.
std::vector<Vec3> grid_around(double h, double x = 0.41, double y = 0.23) {
  std::vector<Vec3> positions{{0, 0, 0}};
  for (int j = -3; j <= 3; ++j)
    for (int i = -3; i <= 3; ++i) positions.push_back({(i + x) * h, (j + y) * h, 0});
  return positions;
}

std::vector<std::size_t> all_but_first(std::size_t count) {
  std::vector<std::size_t> donors;
  for (std::size_t v = 1; v < count; ++v) donors.push_back(v);
  return donors;
}

TEST(SurfaceInterpolation, IsExactForLinearFieldsOnAPlane) {
  const auto positions = grid_around(0.01);
  const std::vector<Vec3> inward(positions.size(), kInward);
  const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
  const Field linear = [](const Vec3& x) { return 3 + 40 * x[0] - 70 * x[1]; };
  EXPECT_NEAR(interpolated(field, positions, 0, linear), 3, 1e-9);
}

TEST(SurfaceInterpolation, ErrorFallsWithTheSquareOfTheGapAtLeast) {
  const Field smooth = [](const Vec3& x) { return std::exp(30 * x[0]) * std::cos(50 * x[1]); };
  std::vector<double> errors;
  for (const double h : {0.01, 0.005, 0.0025}) {
    double sum = 0;
    for (const double shift : {0.1, 0.2, 0.3, 0.4, 0.5}) {
      const auto positions = grid_around(h, shift, 0.5 - shift);
      const std::vector<Vec3> inward(positions.size(), kInward);
      const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
      sum += std::pow(interpolated(field, positions, 0, smooth) - smooth({0, 0, 0}), 2);
    }
    errors.push_back(std::sqrt(sum));
  }
  EXPECT_LT(errors[1], errors[0] / 3.5);
  EXPECT_LT(errors[2], errors[1] / 3.5);
}

TEST(SurfaceInterpolation, WithDonorsOnALineItStaysBetweenThem) {
  std::vector<Vec3> positions{{0, 0.004, 0}};
  for (int i = -4; i <= 4; ++i) positions.push_back({0.01 * i, 0, 0});
  const std::vector<Vec3> inward(positions.size(), kInward);
  const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
  double sum = 0;
  for (const Donor& donor : field.weights(0)) {
    EXPECT_GE(donor.weight, 0);
    sum += donor.weight;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(SurfaceInterpolation, DoesNotSeeTheOtherSideOfAThinBody) {
  auto positions = grid_around(0.01);
  std::vector<Vec3> inward(positions.size(), kInward);
  const std::size_t one_side = positions.size();
  for (const Vec3& x : grid_around(0.01)) {
    positions.push_back(x + Vec3{0, 0, -0.002});
    inward.push_back({0, 0, 1});
  }
  const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
  for (const Donor& donor : field.weights(0)) EXPECT_LT(donor.vertex, one_side);
}

TEST(SiteChoice, FirstSitesAreSpreadOverTheSurface) {
  const Body body = plate(12);
  const double spacing = 0.018;
  const auto sites = spread_sites(body, spacing);
  for (const std::int32_t a : sites)
    for (const std::int32_t b : sites)
      EXPECT_TRUE(a == b || norm(position(body, a) - position(body, b)) >= spacing);
  for (const Vec3& x : body.nodes) {
    double nearest = 1;
    for (const std::int32_t a : sites) nearest = std::min(nearest, norm(x - position(body, a)));
    EXPECT_LT(nearest, spacing);
  }
}

TEST(SiteChoice, LinearStiffnessIsInterpolatedAndAsksForNothingMore) {
  const Body body = plate(12);
  const Field linear = [](const Vec3& x) { return 1 + 10 * x[0] + 5 * x[1]; };
  const auto sites = spread_sites(body, 0.012);
  const Library library = fit(body, press_all(body, sites, linear), interpolating());
  for (std::size_t v = 0; v < body.nodes.size(); ++v) {
    const bool computed =
        std::binary_search(sites.begin(), sites.end(), static_cast<std::int32_t>(v));
    const auto status = library.responses[v].status;
    EXPECT_EQ(status, computed ? ResponseStatus::Fitted : ResponseStatus::Filled);
    const Vec3& x = body.nodes[v];
    const double border = std::min({x[0], x[1], 0.06 - x[0], 0.06 - x[1]});
    if (border < 0.01) continue;  // outside of the donors a spline would extrapolate
    EXPECT_NEAR(deepest_force(library, v), law(linear(x)), 0.01 * law(linear(x))) << v;
  }
  for (const std::int32_t v : next_sites(body, sites, library, 0.02, 1000)) {
    const Vec3& x = position(body, v);
    EXPECT_LT(std::min({x[0], x[1], 0.06 - x[0], 0.06 - x[1]}), 0.01) << "inside";
  }
}

TEST(SiteChoice, LeavingOutTellsTheErrorOfTheNeighbours) {
  const Body body = plate(9);
  const Field bump = [](const Vec3& x) {
    const Vec3 r = x - Vec3{0.02, 0.02, 0};
    return 1 + 2 * std::exp(-dot(r, r) / (2 * 0.006 * 0.006));
  };
  const auto sites = spread_sites(body, 0.012);
  const Library library = fit(body, press_all(body, sites, bump), interpolating());
  const auto misses = leave_one_out(library);
  ASSERT_EQ(misses.size(), sites.size());
  // Independently: without its curves the site is interpolated by the fit.
  for (std::size_t i = 0; i < misses.size(); i += 5) {
    const LeaveOneOutError& miss = misses[i];
    auto others = sites;
    others.erase(std::find(others.begin(), others.end(), miss.vertex));
    const Library without = fit(body, press_all(body, others, bump), interpolating());
    const auto v = static_cast<std::size_t>(miss.vertex);
    const double direct = law(bump(body.nodes[v]));
    EXPECT_NEAR(miss.normal, std::abs(deepest_force(without, v) - direct), 0.01 * direct) << v;
  }
}

TEST(SiteChoice, NewSitesGoWhereTheBodyChanges) {
  const Body body = plate(20);
  const Vec3 centre{0.07, 0.03, 0};
  const Field nodule = [&](const Vec3& x) {
    const Vec3 r = x - centre;
    return 1 + 3 * std::exp(-dot(r, r) / (2 * 0.008 * 0.008));
  };
  auto sites = spread_sites(body, 0.02);
  const Curves before = press_all(body, sites, nodule);
  const Library coarse = fit(body, before, interpolating());
  const auto added = next_sites(body, sites, coarse, 0.05, 12);
  ASSERT_EQ(added.size(), 12U);
  for (const std::int32_t v : added) {
    EXPECT_LT(norm(position(body, v) - centre), 0.045) << "far from the nodule";
    EXPECT_FALSE(std::binary_search(sites.begin(), sites.end(), v));
  }
  const auto worst = [&](const Library& library) {
    double largest = 0;
    for (std::size_t v = 0; v < body.nodes.size(); ++v) {
      const double direct = law(nodule(body.nodes[v]));
      largest = std::max(largest, std::abs(deepest_force(library, v) - direct) / direct);
    }
    return largest;
  };
  sites.insert(sites.end(), added.begin(), added.end());
  std::sort(sites.begin(), sites.end());
  const Library fine = fit(body, press_all(body, sites, nodule), interpolating());
  EXPECT_LT(worst(fine), 0.5 * worst(coarse));
}

TEST(SiteChoice, ASiteThatFailedStaysAHoleAndIsNotAskedForAgain) {
  const Body body = plate(12);
  const Field even = [](const Vec3&) { return 1.0; };
  const auto sites = spread_sites(body, 0.012);
  Curves curves = press_all(body, sites, even);
  SiteCurves& failed = curves.sites[sites.size() / 2];
  failed.status = SiteStatus::Failed;
  failed.reason = "inverted element";
  failed.paths.clear();
  const Library library = fit(body, curves, interpolating());
  const auto hole = static_cast<std::size_t>(failed.vertex);
  EXPECT_EQ(library.responses[hole].status, ResponseStatus::Hole);
  const auto added = next_sites(body, sites, library, 1e-6, 1000);
  EXPECT_EQ(std::count(added.begin(), added.end(), failed.vertex), 0);
}

}  // namespace
}  // namespace palpate::fitting
