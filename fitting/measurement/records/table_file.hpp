// SPDX-License-Identifier: AGPL-3.0-or-later
// The table of a record, whatever kind of file holds it: text, workbook, HDF5 or MAT.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fitting/measurement/records/csv_table.hpp"

namespace palpate::measured {

/// Which table of a file.
struct TableChoice {
  int table = 0;      ///< from 1, of several below each other in a text or sheet; 0: the only one
  std::string sheet;  ///< of a workbook; empty: the only one that has cells
  std::string range;  ///< of the sheet, "B4:E900"; of others rows of numbers, "120:900"
};

/// The table of the file; its kind is told by its first bytes. Texts and sheets are read whole, as
/// parse_csv does. Of HDF5 and MAT files the wanted columns are read, whose names are paths
/// (read_foreign_column, read_mat_column); their units are those of the attribute, of `declared`,
/// or else of the name ("force_N").
/// @param declared  columns in order, instead of a header; of HDF5 and MAT files any, with units.
/// @throws Error(Configuration) as those readers do; for a choice that the kind of file does not
///   have; for old, protected and open-document spreadsheets.
CsvTable read_table(const std::filesystem::path& file, const TableChoice& choice,
                    const std::vector<DeclaredColumn>& declared,
                    const std::vector<std::string>& wanted);

}  // namespace palpate::measured
