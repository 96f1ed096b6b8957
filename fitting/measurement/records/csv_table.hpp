// SPDX-License-Identifier: AGPL-3.0-or-later
// Tables as testing machines write them: a preamble of any kind, a row of names, a row of units or
// units beside the names, then numbers. Instron Bluehill, MTS TestSuite and plain files differ in
// the separator, the decimal sign and where the units stand; the numbers show where they begin.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/measurement/records/record_units.hpp"

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
/// longest run of rows is all numbers. Digits may stand in groups where that is unmistakable:
/// "1,234.5", "1.234,5", "1 234", "1'234", but "1,234" is the decimal 1.234 or refused. Text is
/// UTF-8, UTF-16 with its mark, or else taken as Latin-1. A file may hold several tables, each
/// under its own full header; any other row that is not of numbers is an error, never skipped.
/// @param declared  columns in order, instead of a header; empty to read the header.
/// @param table     counted from 1; 0: the only one.
/// @throws Error(Configuration) with file and line: no table of numbers, a broken row, a header of
///   another length, no such table, several and none chosen.
CsvTable parse_csv(std::string_view text, const std::string& file,
                   const std::vector<DeclaredColumn>& declared = {}, int table = 0);
CsvTable read_csv(const std::filesystem::path& path,
                  const std::vector<DeclaredColumn>& declared = {}, int table = 0);

/// The unit that stands in the name of a column: "Load (N)", "Load [N]", "Load / N", "Load in N",
/// "Load_N". Empty where none does.
std::string unit_of_name(const std::string& name);

/// The column with this name, in SI. `declared_unit` serves a column for which the file gives none;
/// where both are given they must agree.
/// @throws Error(Configuration) for an unknown name (the present ones are listed), a column without
///   a unit, a unit that is not one of the dimension.
std::vector<double> column_in_si(const CsvTable& table, const std::string& name,
                                 Dimension dimension, const std::string& declared_unit = {});

/// The column with this name, of numbers that have no unit: of sites, of components of a direction.
/// @throws Error(Configuration) as column_in_si; for a column with a unit.
std::vector<double> column_without_unit(const CsvTable& table, const std::string& name);

}  // namespace palpate::measured
