// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/discretize.hpp"
#include "mesher/geometry/quality.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

/// A thin shell that patches of 30 mm do not resolve: two walls that are 2 mm apart.
Surface shell() {
  Surface shell = test::sphere({0, 0, 0}, 0.050, 60);
  Surface hollow = test::sphere({0, 0, 0}, 0.048, 60);
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  append(shell, hollow);
  return shell;
}

TEST(Discretize, ABoxIsMadeByRemeshingAndKeepsItsVolume) {
  Settings s = test::settings_for("box.off");
  s.surface.path = "box.off";
  std::string log;
  s.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
  const Discretization d = discretize(s, test::cube(), {});
  EXPECT_NEAR(measure_quality(d.volume.nodes, d.volume.tetrahedra).volume, 0.05 * 0.05 * 0.05,
              1e-15);
  EXPECT_THAT(log, testing::Not(testing::HasSubstr("Delaunay")));
}

TEST(Discretize, BothWaysMakeTheSameVolumeOfASphere) {
  const Surface sphere = test::sphere({0, 0, 0}, 0.05, 80);
  Settings s = test::settings_for("sphere.off");
  double volumes[2];
  for (const MeshMethod method : {MeshMethod::Isotropic, MeshMethod::Delaunay}) {
    s.method = method;
    const Discretization d = discretize(s, sphere, {});
    volumes[method == MeshMethod::Delaunay] =
        measure_quality(d.volume.nodes, d.volume.tetrahedra).volume;
  }
  EXPECT_NEAR(volumes[0], volumes[1], 0.02 * volumes[0]);
}

/// Facets of the boundary whose corners lie at this height.
std::size_t facets_at(const Surface& boundary, double height) {
  std::size_t count = 0;
  for (const Triangle& t : boundary.triangles) {
    bool all = true;
    for (const std::int32_t v : t)
      all = all && std::abs(boundary.points[to_index(v)][2] - height) < 1e-6;
    count += all ? 1 : 0;
  }
  return count;
}

TEST(Discretize, SupportsMayBeCoarserThanTheRest) {
  Settings s = test::settings_for("plate.off");
  s.element_size = s.patch_spacing = 0.005;
  s.interior_coarsening = 2.5;
  s.method = MeshMethod::Delaunay;
  const Surface plate = test::box({0, 0, 0}, {0.1, 0.1, 0.03});
  const auto bottom_over_top = [](const Discretization& d) {
    return static_cast<double>(facets_at(d.skin.boundary, 0)) /
           static_cast<double>(facets_at(d.skin.boundary, 0.03));
  };
  EXPECT_NEAR(bottom_over_top(discretize(s, plate, {})), 1, 0.1);
  // The bottom is fixed. From its rim, sizes grow by 0.3 of the way to 12.5 mm: the integral of
  // 1/size^2 is 0.38 of that of the top, to which the shapes of the facets add.
  s.support_coarsening = 2.5;
  const Discretization d = discretize(s, plate, {});
  EXPECT_LT(bottom_over_top(d), 0.6);
  EXPECT_NEAR(measure_quality(d.volume.nodes, d.volume.tetrahedra).volume, 3e-4, 0.01 * 3e-4);
  // Springs under the bottom do the same.
  s.foundation = {{s.supports.front(), 1e6, 1e6}};
  s.supports.clear();
  EXPECT_EQ(discretize(s, plate, {}).skin.boundary.triangles, d.skin.boundary.triangles);
  s.method = MeshMethod::Isotropic;
  EXPECT_THROW(discretize(s, plate, {}), Error);
}

TEST(Discretize, LayersAndVoidsAreRefinedAndIsotropicRemeshingRefusesThem) {
  Settings s = test::settings_for("ball.off");
  s.patch_spacing = s.element_size = 0.008;
  s.surface.region_name = "muscle";
  s.layers = {{0.008, "skin"}};
  s.inclusions.resize(2);
  s.inclusions[0].is_void = true;
  s.inclusions[1].region_name = "stone";
  const std::vector<Surface> inclusions = {test::sphere({0.012, 0, 0}, 0.01, 32),
                                           test::sphere({-0.03, 0, 0}, 0.01, 32)};
  const Surface ball = test::sphere({0, 0, 0}, 0.05, 64);
  const Discretization d = discretize(s, ball, inclusions);
  EXPECT_THAT(d.volume.region_names, testing::ElementsAre("muscle", "skin", "stone"));
  std::vector<double> volumes(3);
  for (std::size_t t = 0; t < d.volume.tetrahedra.size(); ++t)
    volumes[to_index(d.volume.region[t])] += volume(d.volume.nodes, d.volume.tetrahedra[t]);
  const double skin = signed_volume(ball) * (1 - std::pow(0.042 / 0.05, 3));
  const double stone = signed_volume(inclusions[1]);
  EXPECT_NEAR(volumes[1], skin, 0.06 * skin);
  EXPECT_NEAR(volumes[2], stone, 0.3 * stone);  // its radius is 1.2 elements
  EXPECT_NEAR(volumes[0] + volumes[1] + volumes[2], signed_volume(ball) - stone,
              0.03 * signed_volume(ball));
  s.method = MeshMethod::Isotropic;
  EXPECT_THROW(discretize(s, ball, inclusions), Error);
}

TEST(Discretize, StatesTheReasonOfEachWayThatFails) {
  Settings s = test::settings_for("shell.off");
  s.patch_spacing = s.element_size = 0.03;
  s.method = MeshMethod::Isotropic;
  try {
    discretize(s, shell(), {});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.problem(), testing::HasSubstr("isotropic remeshing: "));
    EXPECT_FALSE(error.remedy().empty());
  }
}

}  // namespace
}  // namespace palpate::mesher
