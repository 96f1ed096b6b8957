// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "format/error.hpp"
#include "mesher/mesher.hpp"
#include "mesher/queries.hpp"
#include "mesher/read_surface.hpp"
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

/// 2 at second order: the error falls by the square of the ratio of sizes.
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

TEST(Mesh, NodesNearASecondSurfaceAreHeld) {
  const Vec3 centre{0, 0, 0}, bone{0, 0, -0.033};
  const test::TemporaryFile skin("skin.off", test::off_text(test::sphere(centre, 0.030, 120)));
  const test::TemporaryFile ball("bone.off", test::off_text(test::sphere(1000 * bone, 8, 120)));
  Settings s;
  s.surface = {skin.path(), 1.0, ""};
  s.supports = {SurfaceSupport{{ball.path(), 0.001, ""}, 0.002}};
  s.patch_spacing = 0.006;
  s.element_size = 0.003;
  const Body body = mesh(s);
  std::vector<std::uint8_t> held(body.nodes.size(), 0);
  for (const auto node : body.fixed_nodes) held[static_cast<std::size_t>(node)] = 1;
  int inside = 0;
  for (const Triangle& facet : body.boundary) {
    for (const auto node : facet) {
      const auto i = static_cast<std::size_t>(node);
      const double distance = norm(body.nodes[i] - bone) - 0.008;
      if (std::abs(distance - 0.002) < 2e-5) continue;  // the ball is a polyhedron
      EXPECT_EQ(held[i] != 0, distance < 0.002) << distance;
      if (distance < -0.002) ++inside;
    }
  }
  EXPECT_GT(inside, 0);  // the bone reaches through the skin
}

/// A box of quadrilaterals, each side a group of its own; one of them of a material too.
std::string labelled_box(const Vec3& size) {
  std::ostringstream obj;
  obj << "o tissue\n";
  for (int i = 0; i < 8; ++i)
    obj << "v " << (i & 1 ? size[0] : 0) << ' ' << (i & 2 ? size[1] : 0) << ' '
        << (i & 4 ? size[2] : 0) << '\n';
  obj << "g base outside\nf 1 3 4 2\ng top outside\nf 5 6 8 7\ng left\nusemtl glue\n"
      << "f 1 5 7 3\nusemtl none\ng right\nf 2 4 8 6\ng front\nf 1 2 6 5\ng back\nf 3 7 8 4\n";
  return obj.str();
}

TEST(Mesh, NodesOnFacesThatBearANameAreHeld) {
  const Vec3 size{0.04, 0.03, 0.02};
  const test::TemporaryFile file("labelled.obj", labelled_box(size));
  Settings s;
  s.surface = {file.path(), 1.0, ""};
  s.patch_spacing = 0.005;
  s.element_size = 0.005;
  const auto expect_held = [&](const std::string& label, const auto& on_face) {
    s.supports = {LabelSupport{label}};
    const Body body = mesh(s);
    test::expect_sound(body);
    std::vector<bool> held(body.nodes.size(), false), on_boundary(held);
    for (const auto node : body.fixed_nodes) held[static_cast<std::size_t>(node)] = true;
    for (const Triangle& t : body.boundary)
      for (const auto node : t) on_boundary[static_cast<std::size_t>(node)] = true;
    for (std::size_t i = 0; i < held.size(); ++i)
      EXPECT_EQ(held[i], on_boundary[i] && on_face(body.nodes[i])) << label;
    EXPECT_GT(body.fixed_nodes.size(), 20u);
  };
  expect_held("base", [&](const Vec3& x) { return x[2] < 1e-9; });
  expect_held("outside", [&](const Vec3& x) { return x[2] < 1e-9 || x[2] > size[2] - 1e-9; });
  expect_held("glue", [&](const Vec3& x) { return x[0] < 1e-9; });
  // Springs go by the same faces.
  s.supports.clear();
  s.foundation = {{LabelSupport{"base"}, 1e6, 1e6}};
  EXPECT_GT(mesh(s).foundation.size(), 50u);
}

TEST(Mesh, FacetsInsideASupportWithSpringsRestOnThem) {
  const test::TemporaryFile skin("box.off",
                                 test::off_text(test::box({-0.03, -0.02, 0}, {0.03, 0.02, 0.02})));
  Settings s;
  s.surface = {skin.path(), 1.0, ""};
  s.patch_spacing = 0.006;
  s.element_size = 0.006;
  const BoxSupport base{{-1, -1, -1}, {1, 1, 0}}, half{{-1, -1, -1}, {0, 1, 0}};
  s.foundation = {{base, 2e6, 1e6}, {half, 3e6, 0}};
  const Body body = mesh(s);
  test::expect_sound(body);
  EXPECT_TRUE(body.fixed_nodes.empty());
  double area = 0, doubled = 0;
  for (const SprungFacet& sprung : body.foundation) {
    const Triangle& t = body.boundary[static_cast<std::size_t>(sprung.facet)];
    const auto x = [&](std::size_t c) { return body.nodes[static_cast<std::size_t>(t[c])]; };
    const double part = 0.5 * norm(cross(x(1) - x(0), x(2) - x(0)));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(x(c)[2], 0, 1e-9);
    EXPECT_EQ(sprung.tangential_stiffness, 1e6);
    area += part;
    if (sprung.normal_stiffness == 5e6) doubled += part;
  }
  EXPECT_NEAR(area, 0.06 * 0.04, 1e-9);
  EXPECT_GT(doubled, 0.3 * area);
  EXPECT_LT(doubled, 0.5 * area + 1e-9);
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    double nearest = 1;
    for (const SprungFacet& sprung : body.foundation)
      for (const auto node : body.boundary[static_cast<std::size_t>(sprung.facet)])
        nearest = std::min(nearest, norm(x - body.nodes[static_cast<std::size_t>(node)]));
    EXPECT_EQ(body.response.is_site[v] != 0, nearest > s.tool_radius);
  }
}

TEST(Mesh, InclusionIsItsOwnRegionAndVolumesAddUp) {
  constexpr double radius = 0.012;
  const test::TemporaryFile skin("skin.off",
                                 test::off_text(test::box({-0.03, -0.03, 0}, {0.03, 0.03, 0.04})));
  const test::TemporaryFile ball("ball.off",
                                 test::off_text(test::sphere({0, 0, 0.022}, radius, 120)));
  Settings s;
  s.surface = {skin.path(), 1.0, "fat"};
  s.inclusions = {{ball.path(), 1.0, "nodule"}};
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 1, 0}}};
  s.patch_spacing = 0.006;
  s.element_size = 0.003;
  const Body body = mesh(s);
  test::expect_sound(body);
  EXPECT_EQ(body.region_names, (std::vector<std::string>{"fat", "nodule"}));
  EXPECT_NEAR(test::volume_of_region(body, -1) / (0.06 * 0.06 * 0.04), 1, 1e-9);
  // Short by 3 h^2/8r^2 = 2.3 % at h = 3 mm or a little less; no triangle lies outside.
  const double part = test::volume_of_region(body, 1) / (4 * pi / 3 * std::pow(radius, 3));
  EXPECT_GT(part, 0.97);
  EXPECT_LT(part, 1);
  EXPECT_NEAR(test::volume_of_region(body, 0) + test::volume_of_region(body, 1),
              test::volume_of_region(body, -1), 1e-15);
}

TEST(Mesh, OrganCarriesItsNoduleUnderSixMillimetres) {
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
  // Equilateral triangles of edge h in a sphere of radius r lie h^2/8r inside it in the mean, so
  // that the part 3 h^2/8r^2 of the volume is missing; the mean edge is within a tenth of h.
  const double part = test::volume_of_region(body, 1) / (4 * pi / 3 * std::pow(0.011, 3));
  EXPECT_GT(part, 1 - 3 * std::pow(1.1 * 0.005 / 0.011, 2) / 8);
  EXPECT_LT(part, 1 - 3 * std::pow(0.9 * 0.005 / 0.011, 2) / 8);

  const SurfaceQuery skin(read_surface(s.surface, {}));
  double cover = 1;
  for (const Vec3& x : read_surface(s.inclusions[0], {}).points) {
    cover = std::min(cover, norm(skin.closest(x).point - x));
  }
  EXPECT_NEAR(cover, 0.006, 0.0002);
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
