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
#include "fitting/measurement/records/placement.hpp"

namespace palpate::app {

class RecordReader {
 public:
  /// @throws Error as read_sidecar and measured::register_fiducials.
  explicit RecordReader(const std::filesystem::path& sidecar_file);

  const Sidecar& sidecar() const { return sidecar_; }
  const measured::Registration& registration() const { return registration_; }
  std::filesystem::path path_of(const std::string& file) const;

  /// The table of a batch, whatever kind of file holds it.
  measured::CsvTable table(const BatchFileSection& section) const;
  /// Empty where the sidecar names no column. @throws Error as measured::column_in_si.
  std::vector<double> column(const measured::CsvTable& table, const std::string& name,
                             Dimension dimension) const;
  /// The presses of a batch. @throws Error as measured::split_batch.
  std::vector<measured::BatchSite> batch(const BatchFileSection& section,
                                         const measured::CsvTable& table) const;

 private:
  measured::PressSettings press_settings(int cycle) const;
  std::vector<Vec3> vectors(const measured::CsvTable& table,
                            const std::array<std::string, 3>& names, Dimension dimension) const;
  std::vector<Vec3> normals(const measured::CsvTable& table) const;

  std::filesystem::path sidecar_file_;
  Sidecar sidecar_;
  std::vector<measured::DeclaredColumn> declared_;
  measured::Registration registration_;
};

}  // namespace palpate::app
