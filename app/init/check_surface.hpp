// SPDX-License-Identifier: AGPL-3.0-or-later
// What is wrong with the surface of a file, and what its repair does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/init/body_file.hpp"
#include "format/error.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::app {

struct SurfaceCheck {
  BodyFile file;                      ///< path, unit and the repaired surface
  std::size_t points = 0, faces = 0;  ///< as listed
  double raw_size = 0;                ///< largest dimension in units of the file
  std::vector<std::string> faults;    ///< number and place of each kind; empty: sound
  std::vector<std::string> repairs;   ///< the steps, with distances, and warnings
  mesher::FaultyFaces faulty;         ///< in the unit of the file
  std::optional<Error> refusal;       ///< what `palpate mesh` would say

  bool is_sound() const { return faults.empty() && !refusal; }
};

/// Reads, examines and repairs as `palpate mesh` does with the defaults of [surface]. Positions in
/// messages are from now on in the unit of the file.
/// @param unit empty: as read_body_file
/// @param largest_part as `parts = "largest"`
/// @throws Error(Geometry) for a file that has no faces to be examined.
SurfaceCheck check_surface(const std::filesystem::path& path, const std::string& unit,
                           bool largest_part);

/// A surface as a PLY file of text, in a unit of so many metres.
std::string ply_text(const mesher::Surface& surface, double unit);

}  // namespace palpate::app
