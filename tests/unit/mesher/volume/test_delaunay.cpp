// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/delaunay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "format/error.hpp"
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

TEST(Delaunay, VolumeOfASphereConvergesWithTheSquareOfTheElementSize) {
  const Domain domain = solid(test::sphere({0.01, 0, 0}, 0.05, 96));
  const double exact = signed_volume(domain.skin);
  std::vector<double> error;
  for (const double h : {0.012, 0.006}) {
    DelaunayReport report;
    const VolumeMesh mesh = mesh_domain(domain, with_size(h), "sphere", report);
    EXPECT_TRUE(non_manifold_nodes(boundary_facets(mesh.tetrahedra)).empty());
    EXPECT_LT(report.quality.largest_dihedral, 170);
    EXPECT_GT(report.quality.smallest_dihedral, 8);
    error.push_back(1 - report.quality.volume / exact);
  }
  EXPECT_LT(error[1], 0.01);
  EXPECT_GT(error[0] / error[1], 2.5);
}

}  // namespace
}  // namespace palpate::mesher
