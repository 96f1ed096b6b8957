// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "mesher/geometry/queries.hpp"
#include "mesher/mesher.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/response/slide_directions.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using std::numbers::pi;

constexpr double R = 0.040, L = 0.074;  // m, the cylinder of the paper

Settings cylinder_settings(const std::filesystem::path& path, double patch, double element) {
  Settings s;
  s.name = "cylinder";
  s.surface = {path, 1.0, "gel"};
  s.supports = {PlaneSupport{{0, 0, 0}, {0, 0, -1}}, PlaneSupport{{0, 0, L}, {0, 0, 1}}};
  s.patch_spacing = patch;
  s.element_size = element;
  return s;
}

/// The observed order of convergence of two errors on meshes with this ratio of sizes.
double observed_order(double coarse_error, double fine_error, double ratio) {
  return std::log(coarse_error / fine_error) / std::log(ratio);
}

TEST(Mesh, CylinderHasItsClosedFormVolumeAndAreaToSecondOrder) {
  const test::TemporaryFile file("cylinder.off", test::off_text(test::cylinder(R, L, 720)));
  std::array<double, 3> volume_error{}, area_error{};
  for (std::size_t level = 0; level < 3; ++level) {
    const double element = 0.010 / std::pow(2, level);
    const Body body = mesh(cylinder_settings(file.path(), 0.010, element));
    test::expect_sound(body);
    test::expect_nested(body, 1 << level);
    volume_error[level] = 1 - test::volume_of_region(body, -1) / (pi * R * R * L);
    area_error[level] = 1 - test::boundary_area(body) / (2 * pi * R * L + 2 * pi * R * R);
  }
  // A regular polygon of chord h in a circle of radius R lacks the part (h/R)^2/6 of its area,
  // 0.0104 at h = 10 mm; edges across the chords lack less.
  EXPECT_GT(volume_error[0], 0);
  EXPECT_LT(volume_error[0], 0.0104);
  EXPECT_NEAR(observed_order(volume_error[0], volume_error[1], 2), 2, 0.15);
  EXPECT_NEAR(observed_order(volume_error[1], volume_error[2], 2), 2, 0.15);
  EXPECT_GT(area_error[0], 0);
  EXPECT_LT(area_error[0], 0.0104);
  EXPECT_NEAR(observed_order(area_error[0], area_error[1], 2), 2, 0.25);
}

TEST(Mesh, CylinderSitesAreItsLateralSurfaceAndPointRadially) {
  const Body body = mesh([] {
    Settings s = cylinder_settings(palpate::test::source_folder() / "data/bodies/cylinder.off",
                                   0.010, 0.005);
    s.surface.unit = 0.001;
    return s;
  }());
  test::expect_sound(body);
  test::expect_nested(body, 2);
  std::size_t lateral = 0;
  for (const Triangle& t : body.response.triangles) {
    bool on_lateral = true;
    for (const std::int32_t v : t) {
      const Vec3& x = body.nodes[static_cast<std::size_t>(v)];
      on_lateral = on_lateral && std::abs(std::hypot(x[0], x[1]) - R) < 0.05e-3;
    }
    const Vec3& a = body.nodes[static_cast<std::size_t>(t[0])];
    const Vec3& b = body.nodes[static_cast<std::size_t>(t[1])];
    const Vec3& c = body.nodes[static_cast<std::size_t>(t[2])];
    if (on_lateral && (a[2] != b[2] || b[2] != c[2])) ++lateral;
  }
  // About 500 patches of about 10 mm [Mahvash & Hayward 2005].
  EXPECT_GT(lateral, 450U);
  EXPECT_LT(lateral, 550U);
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    const bool on_cap = x[2] < 1e-9 || x[2] > L - 1e-9;
    EXPECT_EQ(body.response.is_site[v] != 0, !on_cap);
    if (on_cap) continue;
    EXPECT_NEAR(std::hypot(x[0], x[1]), R, 0.02e-3);
    // Facets of 5 mm are inclined by up to asin(2.5/40) = 3.6 degrees.
    EXPECT_GT(-(body.response.inward[v][0] * x[0] + body.response.inward[v][1] * x[1]) / R,
              std::cos(2 * pi / 180));
  }
}

TEST(Mesh, SphereOfEachSizeConvergesAndPointsToItsCentre) {
  const Vec3 centre{0.1, -0.05, 0.02};
  constexpr double radius = 0.030;
  const test::TemporaryFile file("sphere.off", test::off_text(test::sphere(centre, radius, 180)));
  std::array<double, 2> error{};
  std::array<double, 2> worst_angle{};
  for (std::size_t level = 0; level < 2; ++level) {
    Settings s;
    s.surface = {file.path(), 1.0, ""};
    s.supports = {SphereSupport{centre + Vec3{0, 0, -radius}, 0.010}};
    s.patch_spacing = 0.008 / std::pow(2, level);
    s.element_size = 0.004 / std::pow(2, level);
    const Body body = mesh(s);
    test::expect_sound(body);
    test::expect_nested(body, 2);
    error[level] = 1 - test::volume_of_region(body, -1) / (4 * pi / 3 * std::pow(radius, 3));
    for (std::size_t v = 0; v < body.response.node.size(); ++v) {
      const Vec3 exact =
          (1 / radius) * (centre - body.nodes[static_cast<std::size_t>(body.response.node[v])]);
      worst_angle[level] =
          std::max(worst_angle[level], norm(cross(exact, body.response.inward[v])));
    }
  }
  EXPECT_LT(error[0], 0.01);
  EXPECT_NEAR(observed_order(error[0], error[1], 2), 2, 0.3);
  EXPECT_LT(worst_angle[0], std::sin(3 * pi / 180));
  EXPECT_LT(worst_angle[1], worst_angle[0]);
}

TEST(Mesh, OrganHasItsNoduleSixMillimetresUnderTheSkin) {
  const std::string folder = (palpate::test::source_folder() / "data/bodies/").string();
  Settings s;
  s.surface = {folder + "organ.off", 0.001, "parenchyma"};
  s.inclusions = {{folder + "nodule.off", 0.001, "nodule"}};
  s.supports = {PlaneSupport{{0, 0, -0.0259}, {0, 0, -1}}};
  s.depth = 0.010;
  const Body body = mesh(s);
  test::expect_sound(body);
  test::expect_nested(body, 2);
  EXPECT_EQ(test::euler_characteristic(body), 2);
  const double nodule = signed_volume(read_surface(s.inclusions[0], {}));
  EXPECT_NEAR(test::volume_of_region(body, 1), nodule, 1e-6 * nodule);

  const SurfaceQuery skin(read_surface(s.surface, {}));
  double cover = 1;
  for (const Vec3& x : read_surface(s.inclusions[0], {}).points) {
    cover = std::min(cover, norm(skin.closest(x).point - x));
  }
  EXPECT_NEAR(cover, 0.006, 0.0002);
}

/// Triangles of sites whose slides have no bound by the shape, at a depth.
std::size_t unbounded_slides(const Body& body, double depth) {
  std::size_t count = 0;
  for (const Triangle& t : body.response.triangles) {
    std::array<Vec3, 3> x{}, inward{};
    bool free = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(t[k]);
      x[k] = body.nodes[static_cast<std::size_t>(body.response.node[v])];
      inward[k] = body.response.inward[v];
      free = free && body.response.is_site[v] != 0;
    }
    count += free && slide_rate(x, inward, {.depth = depth}) <= 0 ? 1 : 0;
  }
  return count;
}

TEST(Mesh, PressDirectionsForSlidesTurnAtTheEdgesOfABoxAndSayHowFar) {
  const test::TemporaryFile file("box.off",
                                 test::off_text(test::box({0, 0, 0}, {0.05, 0.04, 0.03})));
  std::string log;
  Settings s;
  s.name = "box";
  s.surface = {file.path(), 1.0, "gel"};
  s.supports = {PlaneSupport{{0, 0, 0}, {0, 0, -1}}};
  s.patch_spacing = 0.008;
  s.element_size = 0.008;
  s.tool_radius = 0.002;
  s.depth = 0.006;
  s.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
  const Body normal = mesh(s);
  EXPECT_EQ(log.find("slides"), std::string::npos);
  log.clear();
  s.directions = PressDirections::Sliding;
  const Body sliding = mesh(s);
  test::expect_sound(sliding);
  EXPECT_EQ(sliding.nodes, normal.nodes);
  const std::size_t before = unbounded_slides(normal, s.depth);
  EXPECT_GT(before, 5U);
  EXPECT_LT(unbounded_slides(sliding, s.depth), before / 2);
  double least = 1;
  for (std::size_t v = 0; v < normal.response.inward.size(); ++v)
    least = std::min(least, dot(normal.response.inward[v], sliding.response.inward[v]));
  const auto degrees = std::to_string(std::lround(std::acos(least) * 180 / pi));
  EXPECT_NE(log.find("adjusted for interpolation and slides, by " + degrees + " degrees at most"),
            std::string::npos)
      << log;
  EXPECT_NE(log.find("slides: by its shape, "), std::string::npos) << log;
  EXPECT_NE(log.find("warning: with press_directions = \"sliding\" a tool is pressed up to " +
                     degrees + " degrees off the normal"),
            std::string::npos)
      << log;
}

TEST(Mesh, TwoRunsAreEqualToTheLastBit) {
  const test::TemporaryFile file("twice.off", test::off_text(test::cylinder(R, L, 128)));
  const Body a = mesh(cylinder_settings(file.path(), 0.010, 0.005));
  const Body b = mesh(cylinder_settings(file.path(), 0.010, 0.005));
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.boundary, b.boundary);
  EXPECT_EQ(a.response.inward, b.response.inward);
}

}  // namespace
}  // namespace palpate::mesher
