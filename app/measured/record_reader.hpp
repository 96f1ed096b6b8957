// SPDX-License-Identifier: AGPL-3.0-or-later
// Records as a sidecar describes them: columns in SI, in the frame of the body.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/measured/sidecar.hpp"
#include "fitting/measurement/records/batch.hpp"
#include "fitting/measurement/records/csv_table.hpp"
#include "fitting/measurement/records/history.hpp"
#include "fitting/measurement/records/placement.hpp"
#include "fitting/measurement/records/press.hpp"
#include "fitting/measurement/records/robot.hpp"

namespace palpate::app {

class RecordReader {
 public:
  /// @throws Error as read_sidecar and measured::register_fiducials.
  /// @param tool  whose records are read, see read_sidecar.
  explicit RecordReader(const std::filesystem::path& sidecar_file, const std::string& tool = {});

  const Sidecar& sidecar() const { return sidecar_; }
  const measured::Registration& registration() const { return registration_; }
  std::filesystem::path path_of(const std::string& file) const;

  /// The table of a section, whatever kind of file holds it.
  measured::CsvTable table(const PressFileSection& section) const;
  measured::CsvTable table(const HistoryFileSection& section) const;
  measured::CsvTable table(const RobotFileSection& section) const;
  measured::CsvTable table(const BatchFileSection& section) const;

  /// @throws Error as measured::column_in_si and measured::analyse_press.
  measured::PressCurve press(const PressFileSection& section,
                             const measured::CsvTable& table) const;
  /// @throws Error as measured::column_in_si and measured::analyse_history.
  measured::History history(const HistoryFileSection& section) const;
  measured::RobotLog robot_log(const RobotFileSection& section,
                               const measured::CsvTable& table) const;
  /// The presses of a batch. A site whose press makes no curve is refused.
  /// @throws Error as measured::column_in_si and measured::split_batch.
  measured::Batch batch(const BatchFileSection& section, const measured::CsvTable& table) const;
  /// The press as the tissue would answer before it relaxes, where the sidecar has a series.
  measured::PressCurve before_relaxing(const measured::PressCurve& press,
                                       const std::string& where) const;

  measured::PressSettings press_settings(int cycle) const;
  /// How the columns became displacement and force; empty where they are those.
  std::string conversion() const;

 private:
  std::vector<double> column(const measured::CsvTable& table, const std::string& name,
                             Dimension dimension) const;
  template <class Section>
  measured::CsvTable read(const Section& section, std::vector<std::string> wanted) const;
  std::vector<std::string> columns_of_press() const;
  std::vector<double> displacement(const measured::CsvTable& table) const;
  std::vector<double> force(const measured::CsvTable& table) const;
  measured::Signs orient(measured::PressRecord& record) const;
  measured::PressRecord record(const std::string& file, const measured::CsvTable& table,
                               measured::Signs& signs) const;
  std::vector<Vec3> vectors(const measured::CsvTable& table,
                            const std::array<std::string, 3>& names, Dimension dimension) const;
  std::vector<Vec3> positions(const measured::CsvTable& table,
                              const std::array<std::string, 3>& names) const;
  std::vector<Vec3> readings(const measured::CsvTable& table) const;
  std::vector<Vec3> forces(const measured::CsvTable& table) const;
  std::vector<Vec3> normals(const measured::CsvTable& table) const;

  std::filesystem::path sidecar_file_;
  Sidecar sidecar_;
  std::vector<measured::DeclaredColumn> declared_;
  measured::Registration registration_;
};

}  // namespace palpate::app
