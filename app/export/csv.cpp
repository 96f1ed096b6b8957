// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/export/csv.hpp"

#include <fmt/format.h>

#include <iterator>

#include "format/crash_safe_file.hpp"
#include "format/status_name.hpp"
#include "format/step_columns.hpp"

namespace palpate::app {
namespace {

void add_rows(const SiteCurves& site, std::size_t index, std::string& out) {
  const CurvePath& path = site.paths[index];
  const char* kind = path.kind == PathKind::Normal ? "normal" : "lateral";
  for (const CurveSample& s : path.samples) {
    fmt::format_to(
        std::back_inserter(out),
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
        site.vertex, status_name(site.status), index, kind, path.lateral_depth, path.direction[0],
        path.direction[1], path.direction[2], s.displacement, s.force[0], s.force[1], s.force[2],
        s.strain_energy, s.tool_work, s.min_jacobian, s.penetration, s.contact_area, s.iterations,
        s.force_scatter, s.force_uncertainty, s.contact_energy, s.tension, s.facets_in_contact,
        s.mesh_difference, s.mesh_error, s.volume_change);
  }
}

}  // namespace

std::string curves_csv(const Curves& curves) {
  std::string out =
      "vertex,status,path,kind,lateral_depth_m,direction_x,direction_y,direction_z,displacement_m,"
      "force_x_N,force_y_N,force_z_N,strain_energy_J,tool_work_J,min_jacobian,penetration_m,"
      "contact_area_m2,iterations,force_scatter_N,force_uncertainty_N,contact_energy_J,tension_N,"
      "facets_in_contact,mesh_difference_N,mesh_error_N,volume_change_m3\n";
  for (const SiteCurves& site : curves.sites) {
    for (std::size_t i = 0; i < site.paths.size(); ++i) add_rows(site, i, out);
  }
  return out;
}

void write_recording_csv(RecordingReader& recording, const std::filesystem::path& file) {
  CrashSafeFile csv(file);
  csv.write(std::string(kStepColumns) + "\n");
  const auto vector = [](const Vec3& v) { return fmt::format("{},{},{}", v[0], v[1], v[2]); };
  for (auto steps = recording.next(); !steps.empty(); steps = recording.next()) {
    std::string rows;
    for (const RecordedStep& s : steps) {
      fmt::format_to(std::back_inserter(rows), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                     s.time_ns, vector(s.position), vector(s.velocity), vector(s.force),
                     vector(s.contact_point), s.depth, s.lateral, s.offset, s.energy, s.tank,
                     s.absorbed, s.element, s.status, s.latency_ns);
    }
    csv.write(rows);
  }
  csv.commit();
}

void write_curves_csv(const Curves& curves, const std::filesystem::path& file) {
  write_file_crash_safely(file, curves_csv(curves));
}

}  // namespace palpate::app
