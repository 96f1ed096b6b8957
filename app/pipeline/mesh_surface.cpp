// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/mesh_surface.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "app/report/repair_file.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/mesher.hpp"
#include "mesher/repair/picture.hpp"

namespace palpate::app {
namespace {

/// Cells of the picture along the largest dimension: finer than what the page draws.
constexpr int kPictureCells = 64;

report::DistanceMap distance_map(mesher::ColouredSurface surface) {
  return {std::move(surface.points), std::move(surface.triangles), std::move(surface.distance)};
}

/// Whether a point of either surface lies farther from the other one than rounding explains.
bool shows_a_change(const mesher::RepairPicture& picture) {
  const double least = 1e-6 * mesher::largest_dimension(picture.file.points);
  const auto is_far = [=](double distance) { return distance > least; };
  return std::any_of(picture.file.distance.begin(), picture.file.distance.end(), is_far) ||
         std::any_of(picture.repaired.distance.begin(), picture.repaired.distance.end(), is_far);
}

/// @throws Error as mesher::mesh, with the name of the file of the faulty faces.
Body mesh_or_write_faults(const mesher::Settings& settings, const std::filesystem::path& file) {
  try {
    return mesher::mesh(settings);
  } catch (const mesher::FaultySurface& fault) {
    if (fault.faces().faults.empty()) throw;
    write_file_crash_safely(file, mesher::vtp_text(fault.faces()));
    throw Error(fault.kind(), fault.where(),
                fault.problem() + " (its faulty faces are in " + file.string() + ")",
                fault.remedy());
  }
}

}  // namespace

Body mesh_surface(mesher::Settings settings, const std::filesystem::path& folder) {
  const std::filesystem::path faults = folder / "faulty-faces.vtp", repair = folder / "repair.json";
  std::filesystem::remove(faults);
  std::filesystem::remove(repair);
  std::filesystem::remove(folder / "preview.html");  // of another body
  std::optional<mesher::RepairPicture> picture;
  settings.on_repair = [&](const mesher::Surface& kept, const mesher::Surface& repaired) {
    picture = mesher::picture_of_repair(kept, repaired, kPictureCells);
  };
  Body body = mesh_or_write_faults(settings, faults);
  if (picture && shows_a_change(*picture)) {
    write_file_crash_safely(repair,
                            report::repair_text(sha256_of_file(settings.surface.path),
                                                distance_map(std::move(picture->file)),
                                                distance_map(std::move(picture->repaired))));
  }
  return body;
}

}  // namespace palpate::app
