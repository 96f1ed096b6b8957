// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/vtkhdf/grids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "format/error.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::vtkhdf {
namespace {

template <class T>
const std::vector<T>& values(const std::vector<DataArray>& arrays, const std::string& name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(),
                                  [&](const DataArray& array) { return array.name == name; });
  EXPECT_NE(found, arrays.end()) << name;
  return std::get<std::vector<T>>(found->values);
}

TEST(VtkGrids, TheBodyMarksFixedNodesAndSites) {
  const Body body = samples::body(1);
  const Grid grid = body_grid(body);
  EXPECT_EQ(grid.points, body.nodes);
  EXPECT_EQ(grid.types.size(), body.tetrahedra.size());
  EXPECT_EQ(grid.offsets.back(), static_cast<std::int64_t>(4 * body.tetrahedra.size()));
  const auto& fixed = values<std::int32_t>(grid.point_data, "fixed");
  EXPECT_EQ(std::count(fixed.begin(), fixed.end(), 1),
            static_cast<std::ptrdiff_t>(body.fixed_nodes.size()));
  const auto& site = values<std::int32_t>(grid.point_data, "site");
  EXPECT_EQ(std::count(site.begin(), site.end(), 1),
            std::count(body.response.is_site.begin(), body.response.is_site.end(), 1));
  EXPECT_EQ(values<std::int32_t>(grid.cell_data, "region"), body.tetrahedron_region);
}

TEST(VtkGrids, TheDeformedBodyHasTheGivenFields) {
  const Body body = samples::body(1);
  const std::size_t n = body.nodes.size(), t = body.tetrahedra.size();
  DeformedFields fields{std::vector<Vec3>(n, Vec3{1, 2, 3}), std::vector<double>(t, 4),
                        std::vector<double>(t, 5), std::vector<double>(t, 6)};
  const Grid grid = deformed_grid(body, fields);
  EXPECT_EQ(values<Vec3>(grid.point_data, "displacement"), fields.displacement);
  EXPECT_EQ(values<double>(grid.cell_data, "pressure"), fields.pressure);
  fields.pressure.pop_back();
  EXPECT_THROW(deformed_grid(body, fields), Error);
}

TEST(VtkGrids, TheLibraryHasNoForceAtHoles) {
  const Library library = samples::library(2);
  const Grid grid = library_grid(library, 0.001);
  const auto& force = values<double>(grid.point_data, "normal_force");
  ASSERT_EQ(force.size(), library.responses.size());
  for (std::size_t v = 0; v < force.size(); ++v)
    EXPECT_EQ(std::isnan(force[v]), library.responses[v].status == ResponseStatus::Hole) << v;
  EXPECT_EQ(values<double>(grid.cell_data, "stick").size(), library.triangles.size());
  EXPECT_THROW(library_grid(library, 0), Error);
  EXPECT_THROW(library_grid(library, std::numeric_limits<double>::infinity()), Error);
}

/// Coupled responses grow with depth: a drag at 1 mm has w(1 mm) = 0.5 + 0.1 times f^r.
TEST(VtkGrids, TheLibraryHasTheForcesThatAreRendered) {
  Library library = samples::library(2);
  const Grid decoupled = library_grid(library, 0.001);
  library.kind = ResponseKind::Coupled;
  for (NodeResponse& response : library.responses)
    response.coupling = {0.5F, {{0, 0.01F}, {100, 100}}};
  const Grid coupled = library_grid(library, 0.001);
  const auto &before = values<double>(decoupled.point_data, "lateral_force"),
             &now = values<double>(coupled.point_data, "lateral_force");
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (library.responses[v].status == ResponseStatus::Hole) continue;
    EXPECT_NEAR(now[v], 0.6 * before[v], 1e-6 * before[v]) << v;
  }
}

TEST(VtkHdf, RejectsGridsThatAreInconsistent) {
  const samples::TemporaryFolder folder;
  Grid grid = body_grid(samples::body(1));
  EXPECT_NO_THROW(write_vtkhdf(folder / "good.vtkhdf", grid));
  Grid other = grid;
  other.connectivity.front() = static_cast<std::int64_t>(grid.points.size());
  EXPECT_THROW(write_vtkhdf(folder / "bad.vtkhdf", other), Error);
  other = grid;
  other.points.front()[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_vtkhdf(folder / "bad.vtkhdf", other), Error);
  other = grid;
  other.point_data.push_back(other.point_data.front());
  EXPECT_THROW(write_vtkhdf(folder / "bad.vtkhdf", other), Error);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"good.vtkhdf"});
}

}  // namespace
}  // namespace palpate::vtkhdf
