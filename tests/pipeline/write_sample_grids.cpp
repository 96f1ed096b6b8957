// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes grids for ParaView and the artifacts they were made from, for vtkhdf_test.py to compare.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "app/vtkhdf/grids.hpp"
#include "format/error.hpp"
#include "tests/support/sample_artifacts.hpp"

namespace {

namespace fs = std::filesystem;
namespace vtkhdf = palpate::vtkhdf;

/// Fields the test can state on its own: linear in the position and in the row.
vtkhdf::DeformedFields known_fields(const palpate::Body& body) {
  vtkhdf::DeformedFields fields;
  for (const palpate::Vec3& X : body.nodes) {
    fields.displacement.push_back({0.5 * X[2], -0.25 * X[0], 2 * X[1]});
  }
  for (std::size_t row = 0; row < body.tetrahedra.size(); ++row) {
    fields.strain_energy_density.push_back(0.5 * static_cast<double>(row));
    fields.pressure.push_back(-3.0 * static_cast<double>(row));
    fields.smooth_pressure.push_back(-2.0 * static_cast<double>(row));
  }
  return fields;
}

/// Triangles and tetrahedra in one grid.
vtkhdf::Grid mixed_grid(const palpate::Body& body) {
  vtkhdf::Grid grid = vtkhdf::body_grid(body);
  grid.cell_data.clear();
  grid.add_cells(body.boundary);
  return grid;
}

void write_all(const fs::path& folder) {
  const palpate::Body body = palpate::samples::body(1);
  const palpate::Library library = palpate::samples::library(1);
  palpate::Library uncertified = library;
  uncertified.certificate = palpate::Certificate{};
  palpate::write_body(folder / "body.h5", body);
  palpate::write_library(folder / "library.h5", library);
  vtkhdf::write_vtkhdf(folder / "body.vtkhdf", vtkhdf::body_grid(body));
  vtkhdf::write_vtkhdf(folder / "deformed.vtkhdf", vtkhdf::deformed_grid(body, known_fields(body)));
  vtkhdf::write_vtkhdf(folder / "library.vtkhdf", vtkhdf::library_grid(library, 0.003));
  vtkhdf::write_vtkhdf(folder / "uncertified.vtkhdf", vtkhdf::library_grid(uncertified, 0.003));
  vtkhdf::write_vtkhdf(folder / "mixed.vtkhdf", mixed_grid(body));
}

template <class Change>
void expect_refusal(const fs::path& folder, Change change) {
  vtkhdf::Grid grid = vtkhdf::body_grid(palpate::samples::body(1));
  change(grid);
  try {
    vtkhdf::write_vtkhdf(folder / "refused.vtkhdf", grid);
  } catch (const palpate::Error& error) {
    std::printf("refused: %s\n", error.what());
    return;
  }
  throw std::runtime_error("a broken grid was written");
}

void refuse_broken_grids(const fs::path& folder) {
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.connectivity[3] = 64; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.connectivity[3] = -1; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.points[0][1] = NAN; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.types[5] = 12; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.offsets[2] = 7; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.cell_data[0].values = std::vector{1.0}; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.point_data[0].name = "a/b"; });
  expect_refusal(folder, [](vtkhdf::Grid& g) { g.point_data[0].name = "site"; });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s <folder>\n", argv[0]);
    return 2;
  }
  try {
    write_all(argv[1]);
    refuse_broken_grids(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
