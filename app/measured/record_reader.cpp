// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/record_reader.hpp"

#include "fitting/measurement/records/table_file.hpp"

namespace palpate::app {

namespace fs = std::filesystem;
namespace m = palpate::measured;

RecordReader::RecordReader(const fs::path& sidecar_file)
    : sidecar_file_(sidecar_file), sidecar_(read_sidecar(sidecar_file)) {
  for (const auto& column : sidecar_.declared) declared_.push_back({column.name, column.unit});
  if (sidecar_.batches.empty() || sidecar_.placement.frame == "body") return;
  std::vector<m::Fiducial> fiducials;
  for (const FiducialSection& f : sidecar_.fiducials) fiducials.push_back({f.robot, f.body});
  registration_ = m::register_fiducials(fiducials, sidecar_file_.string());
}

fs::path RecordReader::path_of(const std::string& file) const {
  return sidecar_file_.parent_path() / file;
}

m::CsvTable RecordReader::table(const BatchFileSection& section) const {
  const ColumnsSection& c = sidecar_.columns;
  std::vector<std::string> wanted{c.time,      c.site,      c.normal_x,  c.normal_y, c.normal_z,
                                  c.contact_x, c.contact_y, c.contact_z, c.x,        c.y,
                                  c.z,         c.fx,        c.fy,        c.fz};
  std::erase(wanted, "");
  return m::read_table(path_of(section.file), section.choice, declared_, wanted);
}

std::vector<double> RecordReader::column(const m::CsvTable& table, const std::string& name,
                                         Dimension dimension) const {
  const ColumnsSection& c = sidecar_.columns;
  const std::string& unit = dimension == Dimension::Time       ? c.time_unit
                            : dimension == Dimension::Length   ? c.length_unit
                            : dimension == Dimension::Ratio    ? c.strain_unit
                            : dimension == Dimension::Pressure ? c.stress_unit
                                                               : c.force_unit;
  if (name.empty()) return {};
  return m::column_in_si(table, name, dimension, unit);
}

m::PressSettings RecordReader::press_settings(int cycle) const {
  const Sidecar& s = sidecar_;
  m::PressSettings settings;
  settings.compliance = s.machine.compliance;
  settings.compliance_uncertainty = s.machine.compliance_uncertainty;
  settings.cycle = cycle;
  settings.exponent = s.contact.exponent;
  settings.method = s.contact.method == "fit"         ? m::ContactMethod::Fit
                    : s.contact.method == "threshold" ? m::ContactMethod::Threshold
                                                      : m::ContactMethod::Given;
  settings.threshold = s.contact.threshold;
  settings.contact_uncertainty = s.contact.position_uncertainty;
  settings.baseline =
      s.baseline.method == "fit" ? m::BaselineMethod::Fit : m::BaselineMethod::Zeroed;
  settings.zero_uncertainty = s.baseline.uncertainty;
  return settings;
}

std::vector<Vec3> RecordReader::vectors(const m::CsvTable& table,
                                        const std::array<std::string, 3>& names,
                                        Dimension dimension) const {
  const auto x = column(table, names[0], dimension);
  const auto y = column(table, names[1], dimension);
  const auto z = column(table, names[2], dimension);
  std::vector<Vec3> vectors;
  for (std::size_t i = 0; i < x.size(); ++i) vectors.push_back({x[i], y[i], z[i]});
  return vectors;
}

std::vector<Vec3> RecordReader::normals(const m::CsvTable& table) const {
  const ColumnsSection& c = sidecar_.columns;
  const auto x = m::column_without_unit(table, c.normal_x);
  const auto y = m::column_without_unit(table, c.normal_y);
  const auto z = m::column_without_unit(table, c.normal_z);
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < x.size(); ++i)
    normals.push_back(registration_.motion.rotate({x[i], y[i], z[i]}));
  return normals;
}

std::vector<m::BatchSite> RecordReader::batch(const BatchFileSection& section,
                                              const m::CsvTable& table) const {
  const ColumnsSection& c = sidecar_.columns;
  m::BatchLog batch;
  batch.name = path_of(section.file).string();
  batch.site = m::column_without_unit(table, c.site);
  batch.time = column(table, c.time, Dimension::Time);
  batch.position = vectors(table, {c.x, c.y, c.z}, Dimension::Length);
  for (Vec3& position : batch.position) position = registration_.motion(position);
  batch.force = vectors(table, {c.fx, c.fy, c.fz}, Dimension::Force);
  const double sign = sidecar_.placement.force_is == "on body" ? 1 : -1;
  for (Vec3& force : batch.force) force = registration_.motion.rotate(sign * force);
  batch.outward = normals(table);
  batch.contact = vectors(table, {c.contact_x, c.contact_y, c.contact_z}, Dimension::Length);
  for (Vec3& contact : batch.contact) contact = registration_.motion(contact);
  batch.position_to_skin = sidecar_.tool.reference == "centre" ? sidecar_.tool.radius : 0;
  return m::split_batch(batch, {press_settings(1), section.leave_out});
}

}  // namespace palpate::app
