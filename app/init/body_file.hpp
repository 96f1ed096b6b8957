// SPDX-License-Identifier: AGPL-3.0-or-later
// The file of a body before there is a case: what kind it is, its unit, and its shape.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "format/units.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::app {

enum class BodyKind { Surface, VolumeMesh, Image };

/// Where the unit of a file is from.
enum class UnitSource {
  Given,   ///< by the user
  Stated,  ///< by the file
  Guessed  ///< from the size
};

struct BodyFile {
  BodyKind kind = BodyKind::Surface;
  std::filesystem::path path;
  Unit unit{"mm", 1e-3};
  UnitSource unit_source = UnitSource::Guessed;
  std::optional<Unit> other_unit;  ///< nearly as likely
  mesher::Surface surface;         ///< m, closed and outward; of an image the faces of its voxels
  double area_excess = 1;          ///< area of `surface` over that of the body
  /// Unit vector into the body at a point of `surface`, or zero; empty where the faces tell it.
  std::function<Vec3(const Vec3&)> inward;
  bool was_repaired = false;         ///< the surface of the file has faults
  bool has_parts = false;            ///< several; `surface` is the largest
  std::vector<std::string> regions;  ///< of a volume mesh; empty otherwise
  std::vector<std::int32_t> labels;  ///< of an image, ascending, without 0
};

/// The unit of length of this name. @throws Error(Configuration) for another word.
Unit length_unit(const std::string& symbol);

/// Writes the unit of a body and where it is from.
/// @param given by the user, or empty
/// @param raw largest dimension in units of the file
void find_unit(BodyFile& body, const std::string& given, double raw);

/// Reads a surface, a volume mesh or a segmentation by its ending.
/// @param unit empty: what the file states, or else a guess (mesher::guess_unit)
/// @throws Error as the readers of the mesher; Error(Configuration) for an unknown unit.
BodyFile read_body_file(const std::filesystem::path& path, const std::string& unit);

}  // namespace palpate::app
