// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/record_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/measured/site_records.hpp"
#include "fitting/measurement/records/table_file.hpp"
#include "fitting/measurement/relaxation/before_relaxing.hpp"
#include "format/number_text.hpp"

namespace palpate::app {

namespace fs = std::filesystem;
namespace m = palpate::measured;

namespace {

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// The displacement at the contact point that is given, as the record counts it, m.
template <class Section>
double contact_of(const Section& section, const Sidecar& sidecar) {
  return std::isfinite(section.contact) ? section.contact : sidecar.contact.position;
}

}  // namespace

RecordReader::RecordReader(const fs::path& sidecar_file, const std::string& tool)
    : sidecar_file_(sidecar_file), sidecar_(read_sidecar(sidecar_file, tool)) {
  for (const auto& column : sidecar_.declared) declared_.push_back({column.name, column.unit});
  const bool has_frame = !sidecar_.robot_logs.empty() || !sidecar_.batches.empty();
  if (!has_frame || sidecar_.placement.frame == "body") return;
  std::vector<m::Fiducial> fiducials;
  for (const FiducialSection& f : sidecar_.fiducials) fiducials.push_back({f.robot, f.body});
  registration_ = m::register_fiducials(fiducials, sidecar_file_.string());
}

fs::path RecordReader::path_of(const std::string& file) const {
  return sidecar_file_.parent_path() / file;
}

template <class Section>
m::CsvTable RecordReader::read(const Section& section, std::vector<std::string> wanted) const {
  std::erase(wanted, "");
  return m::read_table(path_of(section.file), section.choice, declared_, wanted);
}

std::vector<std::string> RecordReader::columns_of_press() const {
  const ColumnsSection& c = sidecar_.columns;
  return {c.time, c.displacement, c.strain, c.force, c.stress};
}

m::CsvTable RecordReader::table(const PressFileSection& section) const {
  return read(section, columns_of_press());
}

m::CsvTable RecordReader::table(const HistoryFileSection& section) const {
  return read(section, columns_of_press());
}

m::CsvTable RecordReader::table(const RobotFileSection& section) const {
  const ColumnsSection& c = sidecar_.columns;
  return read(section, {c.time, c.x, c.y, c.z, c.fx, c.fy, c.fz});
}

m::CsvTable RecordReader::table(const BatchFileSection& section) const {
  const ColumnsSection& c = sidecar_.columns;
  return read(section, {c.time, c.site, c.normal_x, c.normal_y, c.normal_z, c.contact_x,
                        c.contact_y, c.contact_z, c.x, c.y, c.z, c.fx, c.fy, c.fz});
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
  settings.contact_uncertainty = stated_or_zero(s.contact.position_uncertainty);
  settings.baseline =
      s.baseline.method == "fit" ? m::BaselineMethod::Fit : m::BaselineMethod::Zeroed;
  settings.zero_uncertainty = stated_or_zero(s.baseline.uncertainty);
  return settings;
}

/// The travel, or the strain times the length by which the machine had divided it.
std::vector<double> RecordReader::displacement(const m::CsvTable& table) const {
  if (sidecar_.columns.strain.empty())
    return column(table, sidecar_.columns.displacement, Dimension::Length);
  return scaled(column(table, sidecar_.columns.strain, Dimension::Ratio),
                sidecar_.machine.size.gauge_length);
}

std::vector<double> RecordReader::force(const m::CsvTable& table) const {
  if (sidecar_.columns.stress.empty())
    return column(table, sidecar_.columns.force, Dimension::Force);
  return scaled(column(table, sidecar_.columns.stress, Dimension::Pressure),
                section_area(sidecar_.machine.size, sidecar_file_.string()));
}

/// Signs that are found in the record, or those that the sidecar states.
m::Signs RecordReader::orient(m::PressRecord& record) const {
  const std::string &of_displacement = sidecar_.columns.displacement_sign,
                    &of_force = sidecar_.columns.force_sign;
  m::PressRecord turned = record;
  m::Signs signs = m::orient(turned);
  if (of_displacement != "found") signs.displacement = of_displacement == "reversed" ? -1 : 1;
  if (of_force != "found") signs.force = of_force == "reversed" ? -1 : 1;
  record.displacement = scaled(std::move(record.displacement), signs.displacement);
  record.force = scaled(std::move(record.force), signs.force);
  return signs;
}

std::string RecordReader::conversion() const {
  std::string text;
  if (!sidecar_.columns.strain.empty())
    text = fmt::format("displacement = '{}' x {}", sidecar_.columns.strain,
                       length_text(sidecar_.machine.size.gauge_length));
  if (!sidecar_.columns.stress.empty())
    text += fmt::format("{}force = '{}' x {}", text.empty() ? "" : ", ", sidecar_.columns.stress,
                        area_text(section_area(sidecar_.machine.size, sidecar_file_.string())));
  return text;
}

/// The record with growing displacements and forces, and the signs that made it so.
m::PressRecord RecordReader::record(const std::string& file, const m::CsvTable& table,
                                    m::Signs& signs) const {
  m::PressRecord record{path_of(file).string(),
                        column(table, sidecar_.columns.time, Dimension::Time),
                        displacement(table),
                        force(table),
                        {}};
  signs = orient(record);
  return record;
}

m::PressCurve RecordReader::press(const PressFileSection& section, const m::CsvTable& table) const {
  m::Signs signs;
  const m::PressRecord recorded = record(section.file, table, signs);
  m::PressSettings settings = press_settings(section.cycle);
  settings.contact = signs.displacement * contact_of(section, sidecar_);
  return m::analyse_press(recorded, settings);
}

m::History RecordReader::history(const HistoryFileSection& section) const {
  m::Signs signs;
  const m::PressRecord recorded = record(section.file, table(section), signs);
  m::HistorySettings settings{press_settings(1), std::nullopt, {}};
  settings.press.contact = signs.displacement * contact_of(section, sidecar_);
  if (section.held == "travel") settings.control = m::Control::Travel;
  if (section.held == "force") settings.control = m::Control::Force;
  for (const PhaseSection& phase : section.phases)
    settings.declared.push_back({m::phase_of_name(phase.kind).value(), phase.from, phase.to});
  m::History history = m::analyse_history(recorded, settings);
  history.name = section.file;
  return history;
}

m::RobotLog RecordReader::robot_log(const RobotFileSection& section,
                                    const m::CsvTable& table) const {
  const ColumnsSection& c = sidecar_.columns;
  m::RobotLog log;
  log.name = path_of(section.file).string();
  log.time = column(table, c.time, Dimension::Time);
  log.tip = positions(table, {c.x, c.y, c.z});
  log.force = forces(table);
  log.readings = readings(table);
  return log;
}

/// Points in the frame of the body.
std::vector<Vec3> RecordReader::positions(const m::CsvTable& table,
                                          const std::array<std::string, 3>& names) const {
  std::vector<Vec3> points = vectors(table, names, Dimension::Length);
  for (Vec3& point : points) point = registration_.motion(point);
  return points;
}

/// Forces as the channels of the sensor read them.
std::vector<Vec3> RecordReader::readings(const m::CsvTable& table) const {
  const ColumnsSection& c = sidecar_.columns;
  return vectors(table, {c.fx, c.fy, c.fz}, Dimension::Force);
}

/// Forces of the tool on the body, in the body's frame.
std::vector<Vec3> RecordReader::forces(const m::CsvTable& table) const {
  std::vector<Vec3> forces = readings(table);
  const double sign = sidecar_.placement.force_is == "on body" ? 1 : -1;
  for (Vec3& force : forces) force = registration_.motion.rotate(sign * force);
  return forces;
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

m::PressCurve RecordReader::before_relaxing(const m::PressCurve& press,
                                            const std::string& where) const {
  const RelaxationSeries& series = sidecar_.path.relaxation;
  return series.empty() ? press : m::before_relaxing(press, series, where);
}

m::Batch RecordReader::batch(const BatchFileSection& section, const m::CsvTable& table) const {
  const ColumnsSection& c = sidecar_.columns;
  m::BatchLog batch;
  batch.name = path_of(section.file).string();
  batch.site = m::column_without_unit(table, c.site);
  batch.time = column(table, c.time, Dimension::Time);
  batch.position = positions(table, {c.x, c.y, c.z});
  batch.force = forces(table);
  batch.readings = readings(table);
  batch.outward = normals(table);
  batch.contact = positions(table, {c.contact_x, c.contact_y, c.contact_z});
  batch.position_to_skin = sidecar_.tool.reference == "centre" ? sidecar_.tool.radius : 0;
  const auto makes_a_curve = [&](const m::BatchSite& site, const std::string& where) {
    site_curves({-1, -site.outward, {before_relaxing(site.press, where)}, {}, where}, sidecar_);
  };
  return m::split_batch(batch, {press_settings(1), section.leave_out, makes_a_curve});
}

}  // namespace palpate::app
