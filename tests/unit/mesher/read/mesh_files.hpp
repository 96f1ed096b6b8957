// SPDX-License-Identifier: AGPL-3.0-or-later
// The mesh files of tests/data/meshes, and what may be said of the meshes read from them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "format/error.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/mesh/read_volume_mesh.hpp"
#include "mesher/volume/boundary.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::mesher::test {

inline constexpr double kMillimetre = 1e-3;

inline std::filesystem::path mesh_file(const std::string& name) {
  return palpate::test::source_folder() / "tests/data/meshes" / name;
}

inline VolumeMesh read_file(const std::string& name, double unit = kMillimetre,
                            const Log& log = {}) {
  return read_volume_mesh({mesh_file(name), unit, "", {}}, log);
}

/// Tetrahedra and volume (mm^3) of a region.
struct RegionSize {
  std::size_t tetrahedra = 0;
  double volume = 0;
};

inline std::map<std::string, RegionSize> region_sizes(const VolumeMesh& mesh) {
  std::map<std::string, RegionSize> sizes;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    RegionSize& size = sizes[mesh.region_names[static_cast<std::size_t>(mesh.region[t])]];
    ++size.tetrahedra;
    size.volume += 1e9 * volume(mesh.nodes, mesh.tetrahedra[t]);
  }
  return sizes;
}

/// The counts and volumes of gmsh/body.geo, as Gmsh and VTK state them.
inline void expect_body(const VolumeMesh& mesh, const std::string& left, const std::string& right,
                        const std::string& nodule) {
  const auto sizes = region_sizes(mesh);
  ASSERT_THAT(mesh.region_names, testing::UnorderedElementsAre(left, right, nodule));
  EXPECT_EQ(sizes.at(left).tetrahedra, 315U);
  EXPECT_EQ(sizes.at(right).tetrahedra, 220U);
  EXPECT_EQ(sizes.at(nodule).tetrahedra, 30U);
  EXPECT_NEAR(sizes.at(left).volume, 11384.457677, 1e-4);
  EXPECT_NEAR(sizes.at(right).volume, 12000, 1e-4);
  EXPECT_NEAR(sizes.at(nodule).volume, 615.542323, 1e-4);
  EXPECT_TRUE(mesh.curved_edges.empty());
  for (const Tetrahedron& t : mesh.tetrahedra) EXPECT_GT(volume(mesh.nodes, t), 0);
}

/// The z of the nodes of a set, mm, to the nanometre: smallest and largest.
inline std::pair<double, double> heights(const VolumeMesh& mesh, const std::string& set) {
  double low = 1e9, high = -1e9;
  for (const std::int32_t node : mesh.node_sets.at(set)) {
    const double z = std::round(1e9 * mesh.nodes[static_cast<std::size_t>(node)][2]) / 1e6;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return {low, high};
}

/// Expects an error of geometry whose parts contain these texts.
template <class Read>
void expect_refusal(const Read& read, const std::string& where, const std::string& problem,
                    const std::string& remedy = "") {
  try {
    read();
    FAIL() << "accepted, expected: " << problem;
  } catch (const Error& error) {
    EXPECT_THAT(error.where(), testing::HasSubstr(where)) << error.what();
    EXPECT_THAT(error.problem(), testing::HasSubstr(problem)) << error.what();
    EXPECT_THAT(error.remedy(), testing::HasSubstr(remedy)) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace palpate::mesher::test
