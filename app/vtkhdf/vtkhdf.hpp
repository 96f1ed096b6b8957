// SPDX-License-Identifier: AGPL-3.0-or-later
// Unstructured grids for ParaView, as VTKHDF files (no VTK library needed to write them).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "format/provenance.hpp"
#include "format/vec3.hpp"

namespace palpate::vtkhdf {

/// Cell types by their number in VTK.
enum class CellType : std::uint8_t { Triangle = 5, Tetrahedron = 10 };

/// One value per point or per cell, of 1 component (numbers) or 3 (vectors). NaN means "no value"
/// to ParaView.
struct DataArray {
  std::string name;         ///< as ParaView lists it; unique, without '/'
  std::string units;        ///< SI, "1" when dimensionless
  std::string description;  ///< one sentence
  std::variant<std::vector<double>, std::vector<Vec3>, std::vector<std::int32_t>> values;
};

/// Points in metres, cells of one or several types, named arrays on both.
struct Grid {
  std::string description;  ///< one sentence
  std::vector<Vec3> points;
  std::vector<std::int64_t> connectivity;  ///< point indices of all cells, end to end
  std::vector<std::int64_t> offsets{0};    ///< (cells + 1) where each cell begins in it
  std::vector<std::uint8_t> types;         ///< (cells) CellType of each
  std::vector<DataArray> point_data;
  std::vector<DataArray> cell_data;
  Provenance provenance;  ///< written to /provenance

  /// Appends cells given as rows of point indices: triangles or tetrahedra.
  template <std::size_t N>
  void add_cells(const std::vector<std::array<std::int32_t, N>>& cells) {
    static_assert(N == 3 || N == 4, "triangles or tetrahedra");
    const CellType type = N == 3 ? CellType::Triangle : CellType::Tetrahedron;
    for (const auto& cell : cells) {
      connectivity.insert(connectivity.end(), cell.begin(), cell.end());
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      types.push_back(static_cast<std::uint8_t>(type));
    }
  }
};

/// Writes the grid as a VTKHDF 1.0 UnstructuredGrid of one partition, for VTK 9.1 and ParaView 5.10
/// or later. Crash-safe; the file should be named *.vtkhdf or *.hdf.
/// @throws Error(Internal) for an inconsistent grid (sizes, indices, repeated names, points that
/// are
///   not finite), else as CrashSafeFile.
void write_vtkhdf(const std::filesystem::path& path, const Grid& grid);

}  // namespace palpate::vtkhdf
