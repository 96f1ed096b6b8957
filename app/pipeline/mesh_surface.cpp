// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/mesh_surface.hpp"

#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/mesher.hpp"

namespace palpate::app {

Body mesh_surface(const mesher::Settings& settings, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "faulty-faces.vtp";
  std::filesystem::remove(file);
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

}  // namespace palpate::app
