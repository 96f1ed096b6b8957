// SPDX-License-Identifier: AGPL-3.0-or-later
// Sheets of workbooks (.xlsx), as Excel, LibreOffice and scripts write them.
#pragma once

#include <filesystem>
#include <string>

namespace palpate::measured {

/// Which cells of which sheet.
struct SheetPart {
  std::string sheet;  ///< its name; empty: the only one that has cells
  std::string range;  ///< "B4:E900", or whole columns, "B:E"; empty: all cells
};

/// The cells of a sheet as a text of fields that are separated by tabs, a line for each row, so
/// that line numbers are those of the sheet.
struct SheetText {
  std::string sheet;
  std::string text;
};

/// Whether the file begins as a ZIP archive does, which workbooks are.
bool is_zip(const std::filesystem::path& file);

/// Numbers have the point as their decimal sign, whatever the language of the sheet; of a formula
/// the value counts that was stored with it. Dates, times, percentages, errors and formulas without
/// a value become texts that say so, since none of them is the number of a column with a unit.
/// @throws Error(Configuration) naming file and sheet: no workbook, a damaged or cut off one, no
///   such sheet, several and none chosen, no cells, a range that is none; or when palpate was built
///   without minizip and pugixml.
SheetText read_sheet(const std::filesystem::path& file, const SheetPart& part);

}  // namespace palpate::measured
