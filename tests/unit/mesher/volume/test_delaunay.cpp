// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/delaunay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/interfaces.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

Domain solid(const Surface& skin) {
  Domain domain;
  domain.skin = skin;
  domain.region_names = {"matrix"};
  return domain;
}

DelaunaySettings with_size(double element_size) {
  DelaunaySettings settings;
  settings.element_size = element_size;
  return settings;
}

double volume_of(const VolumeMesh& mesh, std::int32_t region) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (mesh.region[t] == region) sum += volume(mesh.nodes, mesh.tetrahedra[t]);
  return sum;
}

double volume_of_ball(double radius) {
  return 4 * std::numbers::pi / 3 * radius * radius * radius;
}

/// The part of the volume of a ball that a polyhedron of edges h, its corners on the ball, lacks at
/// most: triangles of circumradius r lie r^2 / 4 R below it in the mean. The bound on r is 0.8 h,
/// and a seventh more between the sources of the size field.
double inscribed(double h, double radius) {
  return 3 * std::pow(0.92 * h / radius, 2) / 4;
}

/// Every face belongs to one tetrahedron or to two that lie on its two sides, the boundary is
/// closed and manifold, every volume is positive and every node is used.
void expect_conforming(const VolumeMesh& mesh) {
  std::map<Triangle, std::vector<std::size_t>> owners;
  std::vector<int> uses(mesh.nodes.size(), 0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    EXPECT_GT(volume(mesh.nodes, mesh.tetrahedra[t]), 0);
    for (std::size_t k = 0; k < 4; ++k) {
      ++uses[to_index(mesh.tetrahedra[t][k])];
      Triangle face{};
      for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != k) face[n++] = mesh.tetrahedra[t][i];
      std::sort(face.begin(), face.end());
      owners[face].push_back(t);
    }
  }
  std::size_t faces_of_one = 0;
  for (const auto& [face, tetrahedra] : owners) {
    EXPECT_LE(tetrahedra.size(), 2U);
    faces_of_one += tetrahedra.size() == 1 ? 1 : 0;
  }
  const auto boundary = adjacency(mesh.tetrahedra).boundary;
  EXPECT_EQ(boundary.size(), faces_of_one);
  EXPECT_TRUE(pinches(boundary).nodes.empty());
  EXPECT_EQ(*std::min_element(uses.begin(), uses.end()) > 0, true);
  EXPECT_EQ(mesh.region.size(), mesh.tetrahedra.size());
}

VolumeMesh mesh_of(const Domain& domain, double element_size, DelaunayReport& report) {
  VolumeMesh mesh = mesh_domain(domain, with_size(element_size), "domain", report);
  expect_conforming(mesh);
  EXPECT_LT(report.quality.largest_dihedral, 175);
  EXPECT_GT(report.quality.smallest_dihedral, 4);
  return mesh;
}

/// A torus about z, its tube of circles with `around` points.
Surface torus(double radius, double tube, int around) {
  Surface s;
  const int along = 3 * around;
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      const double u = 2 * std::numbers::pi * i / along, v = 2 * std::numbers::pi * j / around;
      const double r = radius + tube * std::cos(v);
      s.points.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
      const auto at = [&](int a, int b) { return (a % along) * around + b % around; };
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return s;
}

/// Two balls of radius 20 mm, 60 mm apart, joined by a rod: a lathed surface about z.
Surface dumbbell(double rod) {
  Surface s = test::sphere({0, 0, 0}, 0.02, 64);
  constexpr double half = 0.03, ball = 0.02;
  for (Vec3& x : s.points) {
    const double z = x[2] > 0 ? 1 : -1;
    const double r = std::hypot(x[0], x[1]);
    const double polar = std::atan2(r, std::abs(x[2]));  // 0 at the pole, pi/2 at the equator
    // The lower half of each ball up to the rod, then the rod.
    const double whole = std::numbers::pi - std::asin(rod / ball);
    const double t = polar / (std::numbers::pi / 2);
    const double angle = std::min(1.0, t / 0.8) * whole;
    const double centre = half, end = centre + ball * std::cos(whole);
    const double height = t <= 0.8 ? centre + ball * std::cos(angle) : end * (1 - t) / 0.2;
    const double radius = t <= 0.8 ? ball * std::sin(angle) : rod;
    const double turn = std::atan2(x[1], x[0]);
    x = {radius * std::cos(turn), radius * std::sin(turn), z * height};
  }
  return s;
}

TEST(Delaunay, VolumeOfASphereConvergesWithTheSquareOfTheElementSize) {
  const Domain domain = solid(test::sphere({0.01, 0, 0}, 0.05, 96));
  const double exact = signed_volume(domain.skin);
  std::vector<double> error;
  for (const double h : {0.008, 0.004}) {
    DelaunayReport report;
    mesh_of(domain, h, report);
    error.push_back(1 - report.quality.volume / exact);
    EXPECT_NEAR(report.volume_change, -error.back(), 1e-7);
  }
  EXPECT_GT(error[1], 0);  // nodes on a convex surface enclose less
  EXPECT_LT(error[1], 0.005);
  EXPECT_GT(error[0] / error[1], 2.8);
}

TEST(Delaunay, VolumesOfABoxAndATorus) {
  DelaunayReport report;
  mesh_of(solid(test::box({0, 0, 0}, {0.05, 0.03, 0.02})), 0.005, report);
  EXPECT_NEAR(report.quality.volume, 3e-5, 0.005 * 3e-5);
  const Surface ring = torus(0.04, 0.012, 96);
  ASSERT_GT(signed_volume(ring), 0);
  const VolumeMesh mesh = mesh_of(solid(ring), 0.004, report);
  const double exact = 2 * std::numbers::pi * std::numbers::pi * 0.04 * 0.012 * 0.012;
  EXPECT_NEAR(report.quality.volume, exact, 0.02 * exact);
  EXPECT_NEAR(signed_volume(ring), 2 * std::numbers::pi * std::numbers::pi * 0.04 * 0.012 * 0.012,
              3e-7);
  // Vertices - edges + facets of a torus.
  const Surface boundary = boundary_surface(mesh);
  EXPECT_EQ(2 * boundary.points.size(), boundary.triangles.size());
}

TEST(Delaunay, ThinPartsKeepTheirVolumeWhateverTheElementSize) {
  DelaunayReport report;
  const double plate = 0.06 * 0.06 * 0.002;
  mesh_of(solid(test::box({0, 0, 0}, {0.06, 0.06, 0.002})), 0.006, report);
  EXPECT_NEAR(report.quality.volume, plate, 0.01 * plate);
  const Surface body = dumbbell(0.003);  // a neck of 6 mm under elements of 10 mm
  const VolumeMesh mesh = mesh_of(solid(body), 0.01, report);
  EXPECT_NEAR(report.quality.volume, signed_volume(body), 0.03 * signed_volume(body));
  // The neck alone: 10 mm of its length, a cylinder.
  double neck = 0;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    double middle = 0;
    for (const std::int32_t v : t) middle += mesh.nodes[to_index(v)][2] / 4;
    if (std::abs(middle) < 0.005) neck += volume(mesh.nodes, t);
  }
  const double cylinder = std::numbers::pi * 0.003 * 0.003 * 0.01;
  EXPECT_NEAR(neck, cylinder, 0.12 * cylinder);
}

TEST(Delaunay, NestedAndTouchingEnclosuresFollowTheLastOne) {
  Domain domain = solid(test::box({-0.03, -0.03, -0.03}, {0.03, 0.03, 0.03}));
  domain.region_names = {"matrix", "shell", "core", "slab"};
  domain.enclosures.push_back({test::sphere({0, 0, 0.005}, 0.018, 64), 1});
  domain.enclosures.push_back({test::sphere({0, 0, 0.005}, 0.01, 64), 2});
  // Touches the skin on five sides, and its top lies below the ball.
  domain.enclosures.push_back({test::box({-0.03, -0.03, -0.03}, {0.03, 0.03, -0.02}), 3});
  DelaunayReport report;
  const VolumeMesh mesh = mesh_of(domain, 0.003, report);
  const double core = volume_of_ball(0.01), shell = volume_of_ball(0.018) - core;
  const double slab = 0.06 * 0.06 * 0.01, whole = 0.06 * 0.06 * 0.06;
  EXPECT_NEAR(volume_of(mesh, 2), core, inscribed(0.003, 0.01) * core);
  EXPECT_NEAR(volume_of(mesh, 1), shell, 0.03 * shell);
  EXPECT_NEAR(volume_of(mesh, 3), slab, 0.02 * slab);
  EXPECT_NEAR(volume_of(mesh, 0), whole - slab - core - shell, 0.01 * whole);
}

TEST(Delaunay, LayersAreShellsOfTheirThickness) {
  Domain domain = solid(test::sphere({0, 0, 0}, 0.03, 96));
  domain.region_names = {"muscle", "skin", "fat"};
  domain.layers = {{0.004, 1}, {0.006, 2}};
  DelaunayReport report;
  const VolumeMesh mesh = mesh_of(domain, 0.004, report);
  const double skin = volume_of_ball(0.03) - volume_of_ball(0.026);
  const double fat = volume_of_ball(0.026) - volume_of_ball(0.02);
  EXPECT_NEAR(volume_of(mesh, 1), skin, 0.03 * skin);
  EXPECT_NEAR(volume_of(mesh, 2), fat, 0.03 * fat);
  EXPECT_NEAR(volume_of(mesh, 0), volume_of_ball(0.02),
              inscribed(0.004, 0.02) * volume_of_ball(0.02));
}

TEST(Delaunay, ARegionWithoutTetrahedraIsRefusedByName) {
  Domain domain = solid(test::box({0, 0, 0}, {0.04, 0.04, 0.04}));
  domain.region_names.emplace_back("stone");
  domain.enclosures.push_back({test::sphere({0.1, 0.02, 0.02}, 0.01, 32), 1});
  DelaunayReport report;
  try {
    mesh_domain(domain, with_size(0.008), "box", report);
    FAIL() << "meshed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.problem(), testing::HasSubstr("'stone'"));
    EXPECT_THAT(error.remedy(), testing::HasSubstr("inside the skin"));
  }
}

/// A pyramid upside down, its faces at 34 degrees to the square on top.
TEST(Delaunay, AcuteEdgesEnd) {
  Surface pyramid;
  pyramid.points = {{0, 0, 0},
                    {-0.075, -0.075, 0.05},
                    {0.075, -0.075, 0.05},
                    {0.075, 0.075, 0.05},
                    {-0.075, 0.075, 0.05}};
  pyramid.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  const double exact = 0.15 * 0.15 * 0.05 / 3;
  ASSERT_NEAR(signed_volume(pyramid), exact, 1e-15);
  DelaunayReport report;
  mesh_of(solid(pyramid), 0.015, report);
  EXPECT_NEAR(report.quality.volume, exact, 0.01 * exact);
}

TEST(Delaunay, VoidsAreEmpty) {
  Domain domain = solid(test::box({0, 0, 0}, {0.04, 0.04, 0.04}));
  domain.enclosures.push_back({test::sphere({0.02, 0.02, 0.02}, 0.01, 64), kVoid});
  DelaunayReport report;
  const VolumeMesh mesh = mesh_of(domain, 0.004, report);
  const double exact = 6.4e-5 - volume_of_ball(0.01);
  EXPECT_NEAR(report.quality.volume, exact, 0.01 * exact);
  EXPECT_NEAR(report.volume_of_domain, exact, 0.005 * exact);
  // Two closed surfaces without handles: V - E + F = 4, and E = 3 F / 2.
  const Surface boundary = boundary_surface(mesh);
  EXPECT_EQ(2 * boundary.points.size(), boundary.triangles.size() + 8);
}

TEST(Delaunay, EqualArgumentsGiveEqualMeshesAndTheScaleDoesNotMatter) {
  const Surface skin = torus(0.04, 0.012, 24);
  DelaunayReport report;
  const VolumeMesh first = mesh_domain(solid(skin), with_size(0.009), "first", report);
  const VolumeMesh second = mesh_domain(solid(skin), with_size(0.009), "second", report);
  EXPECT_EQ(first.nodes, second.nodes);
  EXPECT_EQ(first.tetrahedra, second.tetrahedra);
  for (const double scale : {1e-3, 1e3}) {
    Surface other = skin;
    for (Vec3& x : other.points) x = scale * x;
    const VolumeMesh mesh = mesh_domain(solid(other), with_size(scale * 0.009), "other", report);
    EXPECT_EQ(mesh.tetrahedra, first.tetrahedra);
    ASSERT_EQ(mesh.nodes.size(), first.nodes.size());
    for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
      EXPECT_LT(norm(mesh.nodes[v] - scale * first.nodes[v]), scale * 1e-9);
  }
}

// The first nodes, two elements apart, touch no common tetrahedron inside the rod.
TEST(Delaunay, ARodThinnerThanTheElementsIsMeshedBySmallerOnes) {
  const Surface rod = test::cylinder(0.002, 0.0975, 12);
  DelaunayReport report;
  testing::internal::CaptureStderr();
  const VolumeMesh mesh = mesh_domain(solid(rod), with_size(0.0055), "rod", report);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  expect_conforming(mesh);
  EXPECT_GT(report.attempts, 1);
  EXPECT_NEAR(report.quality.volume, signed_volume(rod), 0.03 * signed_volume(rod));
}

TEST(Delaunay, CoarserWhereTheSurfaceMayBeCoarser) {
  const Domain domain = solid(test::box({0, 0, 0}, {0.06, 0.03, 0.03}));
  DelaunaySettings settings = with_size(0.004);
  settings.surface_coarsening = [](const Vec3& x) { return x[0] > 0.03 ? 2.5 : 1; };
  DelaunayReport report;
  const VolumeMesh mesh = mesh_domain(domain, settings, "box", report);
  expect_conforming(mesh);
  const Surface boundary = boundary_surface(mesh);
  double fine = 0, coarse = 0;  // mean areas of the facets on the two end faces
  for (const auto& [plane, mean] : {std::pair(0.0, &fine), std::pair(0.06, &coarse)}) {
    int count = 0;
    for (const Triangle& t : boundary.triangles) {
      const bool on_plane = std::all_of(t.begin(), t.end(), [&, at = plane](std::int32_t v) {
        return std::abs(boundary.points[to_index(v)][0] - at) < 1e-6;
      });
      if (!on_plane) continue;
      *mean += norm(area_vector(boundary.points, t)) / 2;
      ++count;
    }
    ASSERT_GT(count, 0);
    *mean /= count;
  }
  EXPECT_GT(coarse, 2.5 * fine);
}

/// A spheroid of semi-axes a = 15 mm and c = 60 mm: the radius of curvature is a^2/c = 3.75 mm at
/// the poles, where a facet of circumradius r lies r^2/(2 R) from the surface, and 15 mm and 240 mm
/// at the equator. Elements of 8 mm would cut the tips off.
TEST(Delaunay, FacetsAreSmallerWhereTheSurfaceCurves) {
  Surface spheroid = test::sphere({0, 0, 0}, 0.015, 128);
  for (Vec3& x : spheroid.points) x[2] *= 4;
  DelaunayReport report;
  const Surface boundary = boundary_surface(mesh_of(solid(spheroid), 0.008, report));
  double pole = 0, equator = 0;  // mean areas of the facets
  int at_pole = 0, at_equator = 0;
  for (const Triangle& t : boundary.triangles) {
    const double area = norm(area_vector(boundary.points, t)) / 2;
    const double z = std::abs(boundary.points[to_index(t[0])][2]);
    if (z > 0.055) pole += area, ++at_pole;
    if (z < 0.03) equator += area, ++at_equator;
  }
  ASSERT_GT(at_pole, 20);
  ASSERT_GT(at_equator, 20);
  EXPECT_LT(pole / at_pole, 0.5 * equator / at_equator);
}

TEST(Delaunay, LabelsOfAFieldBecomeRegions) {
  LabelField field;
  field.box = {{-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}};
  field.resolution = 0.001;
  field.region_names = {"matrix", "core"};
  field.region = [](const Vec3& x) {
    const double r = norm(x);
    return r > 0.018 ? kVoid : r > 0.009 ? 0 : 1;
  };
  DelaunayReport report;
  const VolumeMesh mesh = mesh_labels(field, with_size(0.003), "image", report);
  expect_conforming(mesh);
  EXPECT_EQ(mesh.region_names, field.region_names);
  const double core = volume_of_ball(0.009), whole = volume_of_ball(0.018);
  EXPECT_NEAR(volume_of(mesh, 1), core, inscribed(0.003, 0.009) * core);
  EXPECT_NEAR(report.quality.volume, whole, inscribed(0.003, 0.018) * whole);
  field.region = [](const Vec3&) { return kVoid; };
  EXPECT_THROW(mesh_labels(field, with_size(0.003), "image", report), Error);
}

TEST(Delaunay, AWallThatNoElementResolvesIsRefusedWithItsPlace) {
  DelaunaySettings settings = with_size(0.02);
  settings.most_nodes = 500;
  DelaunayReport report;
  try {
    mesh_domain(solid(test::box({0, 0, 0}, {0.1, 0.1, 0.0002})), settings, "foil", report);
    FAIL() << "meshed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_EQ(error.where(), "foil");
    EXPECT_THAT(error.remedy(), testing::HasSubstr("element_size"));
  }
}

}  // namespace
}  // namespace palpate::mesher
