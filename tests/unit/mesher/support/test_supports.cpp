// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <sstream>

#include "mesher/mesher.hpp"
#include "mesher/support/supports.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::cube;
using test::expect_refused;
using test::off_text;
using test::settings_for;
using test::TemporaryFile;

TEST(Supports, ShapesContainTheirInside) {
  const PlaneSupport plane{{0, 0, 1}, {0, 0, 2}};
  EXPECT_TRUE(contains(plane, {5, 5, 1.5}, 0));
  EXPECT_FALSE(contains(plane, {5, 5, 0.5}, 0));
  EXPECT_TRUE(contains(plane, {5, 5, 1 - 1e-9}, 1e-6));
  const BoxSupport box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(contains(box, {1, 0.5, 0}, 0));
  EXPECT_FALSE(contains(box, {1.1, 0.5, 0}, 0));
  const SphereSupport ball{{1, 0, 0}, 0.5};
  EXPECT_TRUE(contains(ball, {1.4, 0, 0}, 0));
  EXPECT_FALSE(contains(ball, {1.4, 0.4, 0}, 0));
}

TEST(Supports, IsNearCountsTheInsideAndTheDistance) {
  const SurfaceQuery box(test::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(is_near(box, {0.5, 0.5, 0.5}, 0));
  EXPECT_TRUE(is_near(box, {0.5, 0.5, 1.2}, 0.21));
  EXPECT_FALSE(is_near(box, {0.5, 0.5, 1.2}, 0.19));
}

TEST(Supports, NodesNearASecondSurfaceAreFixed) {
  const Vec3 centre{0, 0, 0}, bone{0, 0, -0.033};
  const test::TemporaryFile skin("skin.off", test::off_text(test::sphere(centre, 0.030, 120)));
  const test::TemporaryFile ball("bone.off", test::off_text(test::sphere(1000 * bone, 8, 120)));
  Settings s;
  s.surface = {skin.path(), 1.0, ""};
  s.supports = {SurfaceSupport{{ball.path(), 0.001, ""}, 0.002}};
  s.patch_spacing = 0.006;
  s.element_size = 0.003;
  const Body body = mesh(s);
  std::vector<std::uint8_t> fixed(body.nodes.size(), 0);
  for (const auto node : body.fixed_nodes) fixed[static_cast<std::size_t>(node)] = 1;
  int inside = 0;
  for (const Triangle& facet : body.boundary) {
    for (const auto node : facet) {
      const auto i = static_cast<std::size_t>(node);
      const double distance = norm(body.nodes[i] - bone) - 0.008;
      if (std::abs(distance - 0.002) < 2e-5) continue;  // the ball is a polyhedron
      EXPECT_EQ(fixed[i] != 0, distance < 0.002) << distance;
      if (distance < -0.002) ++inside;
    }
  }
  EXPECT_GT(inside, 0);  // the bone reaches through the skin
}

/// A box of quadrilaterals. Each side is a group; one side also has a material.
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

TEST(Supports, NodesOnNamedFacesAreFixed) {
  const Vec3 size{0.04, 0.03, 0.02};
  const test::TemporaryFile file("labelled.obj", labelled_box(size));
  Settings s;
  s.surface = {file.path(), 1.0, ""};
  s.patch_spacing = 0.005;
  s.element_size = 0.005;
  const auto expect_fixed = [&](const std::string& label, const auto& on_face) {
    s.supports = {LabelSupport{label}};
    const Body body = mesh(s);
    test::expect_sound(body);
    std::vector<bool> fixed(body.nodes.size(), false), on_boundary(fixed);
    for (const auto node : body.fixed_nodes) fixed[static_cast<std::size_t>(node)] = true;
    for (const Triangle& t : body.boundary)
      for (const auto node : t) on_boundary[static_cast<std::size_t>(node)] = true;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      EXPECT_EQ(fixed[i], on_boundary[i] && on_face(body.nodes[i])) << label;
    EXPECT_GT(body.fixed_nodes.size(), 20u);
  };
  expect_fixed("base", [&](const Vec3& x) { return x[2] < 1e-9; });
  expect_fixed("outside", [&](const Vec3& x) { return x[2] < 1e-9 || x[2] > size[2] - 1e-9; });
  expect_fixed("glue", [&](const Vec3& x) { return x[0] < 1e-9; });
  // Foundations use the same faces.
  s.supports.clear();
  s.foundation = {{LabelSupport{"base"}, 1e6, 1e6}};
  EXPECT_GT(mesh(s).foundation.size(), 50u);
}

TEST(Supports, FacetsInsideASupportWithSpringsRestOnThem) {
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

TEST(Supports, AreRefusedWhereTheyLeaveRigidMotionsOrNoSite) {
  const TemporaryFile file("supported.off", off_text(cube()));
  Settings s = settings_for(file.path());
  s.supports.clear();
  expect_refused(s, "supported.off", "rigid-body motion is not constrained",
                 "(0, 0, 0) mm to (50, 50, 50) mm");
  s.supports = {SphereSupport{{1, 1, 1}, 0.01}};
  expect_refused(s, "supported.off", "0 fixed nodes of", "place a support");
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 0, 0}}};  // one edge: the body can turn about it
  expect_refused(s, "supported.off", "rigid-body motion is not constrained", "place a support");
  const BoxSupport base{{-1, -1, -1}, {1, 1, 0}};
  s.supports.clear();
  s.foundation = {{base, 1e6, 0}};  // springs in one direction only: it can slide
  expect_refused(s, "supported.off", "on springs", "tangential_stiffness");
  s.foundation = {{SphereSupport{{1, 1, 1}, 0.01}, 1e6, 1e6}};
  expect_refused(s, "supported.off", "contain no facet", "place them on the body");
  s.foundation = {{base, 0, 0}};
  expect_refused(s, "mesh", "springs of 0", "one of them positive", ErrorKind::Configuration);
  s.foundation.clear();
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 1, 1}}};
  expect_refused(s, "supported.off", "no response vertex is a site", "smaller");
  s.supports = {base};
  s.tool_radius = 0.09;  // every response vertex is within it of the support
  expect_refused(s, "supported.off", "within the tool radius, 90 mm", "tool smaller");
}

TEST(Supports, LabelsOfNoFaceAreRefused) {
  const TemporaryFile file("unnamed.off", off_text(cube()));
  Settings s = settings_for(file.path());
  s.supports = {LabelSupport{"bone"}};
  expect_refused(s, "unnamed.off", "no face has the name 'bone'", "in an OBJ file",
                 ErrorKind::Configuration);
  const TemporaryFile named("named.obj",
                            "v 0 0 0\nv 0.05 0 0\nv 0 0.05 0\nv 0 0 0.05\ng skin\nf 1 3 2\nf 1 2 "
                            "4\ng bed # below\nf 2 3 4\nf 3 1 4\n");
  s.surface.path = named.path();
  expect_refused(s, "named.obj", "no face has the name 'bone'", "use one of bed, skin",
                 ErrorKind::Configuration);
}

}  // namespace
}  // namespace palpate::mesher
