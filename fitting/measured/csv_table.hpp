// SPDX-License-Identifier: AGPL-3.0-or-later
// Tables as testing machines write them: a preamble of any kind, a row of names, a row of units or
// units beside the names, then numbers. Instron Bluehill, MTS TestSuite and plain files differ in
// the separator, the decimal sign and where the units stand; the numbers tell where they begin.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/measured/lab_units.hpp"

namespace palpate::measured {

struct CsvColumn {
  std::string name;
  std::string unit;            ///< as written, without brackets; empty when the file has none
  std::vector<double> values;  ///< in that unit
};

/// Name and unit of a column, declared by the user for a file that has no header.
struct DeclaredColumn {
  std::string name;
  std::string unit;
};

struct CsvTable {
  std::string file;                   ///< for messages
  std::size_t first_data_line = 0;    ///< counted from 1
  std::vector<std::string> preamble;  ///< non-blank lines before the header, as written
  std::vector<CsvColumn> columns;
};

/// The separator (tab, semicolon, comma, blanks) and the decimal sign are those under which the
/// longest run of rows is all numbers. A file holds one table: a row after it that is not of
/// numbers is an error, never skipped.
/// @param declared  columns in order, in place of a header; empty to read the header.
/// @throws Error(Configuration) with file and line: no table of numbers, a broken row, a header of
///   another length.
CsvTable parse_csv(std::string_view text, const std::string& file,
                   const std::vector<DeclaredColumn>& declared = {});
CsvTable read_csv(const std::filesystem::path& path,
                  const std::vector<DeclaredColumn>& declared = {});

/// The column with this name, in SI. `declared_unit` serves a column for which the file gives none;
/// where both are given they must agree.
/// @throws Error(Configuration) for an unknown name (the present ones are listed), a column without
///   a unit, a unit that is not one of the quantity.
std::vector<double> column_in_si(const CsvTable& table, const std::string& name, Quantity quantity,
                                 const std::string& declared_unit = {});

}  // namespace palpate::measured
