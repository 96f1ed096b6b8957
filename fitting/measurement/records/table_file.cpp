// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/table_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>

#include "fitting/measurement/records/mat_file.hpp"
#include "fitting/measurement/records/workbook.hpp"
#include "format/error.hpp"
#include "format/foreign_hdf5.hpp"
#include "format/matrix_path.hpp"

namespace palpate::measured {
namespace {

enum class FileKind { Text, Hdf5, Mat, Workbook };

/// Excel files of before 2007, and newer ones under a password.
bool is_compound_document(const std::filesystem::path& file) {
  constexpr std::string_view mark = "\xD0\xCF\x11\xE0";
  std::array<char, mark.size()> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  return std::string_view(head.data(), head.size()) == mark;
}

FileKind kind_of(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return FileKind::Text;  // says what is wrong
  if (std::filesystem::is_empty(file, none)) return FileKind::Text;
  if (is_compound_document(file))
    refuse(file.string(), "it is a spreadsheet of before 2007, or under a password",
           "save it as .xlsx without a password, or as CSV");
  if (is_zip(file)) return FileKind::Workbook;
  if (hdf5::is_hdf5(file)) return FileKind::Hdf5;
  return is_mat_file(file) ? FileKind::Mat : FileKind::Text;
}

void check_choice(const std::filesystem::path& file, const TableChoice& choice, FileKind kind) {
  if (kind != FileKind::Workbook && !choice.sheet.empty())
    refuse(file.string(), "a sheet is chosen, and the file is no workbook", "leave `sheet` out");
  const bool by_path = kind == FileKind::Hdf5 || kind == FileKind::Mat;
  if (by_path && choice.table != 0)
    refuse(file.string(), "a table is chosen by its number",
           "name the columns by their paths, as \"/run1/force\" or \"run.force\"");
}

std::string unit_in_name(const std::string& path) {
  const std::string base = matrix_path(path, path).base;
  return unit_of_name(base.substr(base.find_last_of("./") + 1));
}

/// Columns of a file in which each has a path.
CsvTable columns_by_path(const std::filesystem::path& file, FileKind kind,
                         const std::vector<DeclaredColumn>& declared,
                         const std::vector<std::string>& wanted) {
  CsvTable table;
  table.file = file.string();
  table.first_data_line = 1;
  for (const std::string& path : std::set<std::string>(wanted.begin(), wanted.end())) {
    CsvColumn column{path, "", {}};
    if (kind == FileKind::Hdf5) {
      hdf5::ForeignColumn found = hdf5::read_foreign_column(file, path);
      column.values = std::move(found.values);
      column.unit = std::move(found.unit);
    } else {
      column.values = read_mat_column(file, path);
    }
    const auto known = std::find_if(declared.begin(), declared.end(),
                                    [&](const DeclaredColumn& d) { return d.name == path; });
    if (column.unit.empty() && known != declared.end()) column.unit = known->unit;
    if (column.unit.empty()) column.unit = unit_in_name(path);
    table.columns.push_back(std::move(column));
  }
  return table;
}

/// A number of a range of rows; `missing` where it is left out.
std::size_t row_number(std::string_view text, std::size_t missing, const std::string& where,
                       const std::string& range) {
  if (text.empty()) return missing;
  std::size_t row = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), row);
  if (fault != std::errc{} || end != text.data() + text.size() || row == 0)
    refuse(where, "'" + range + "' is no range of rows",
           "count the rows of numbers from 1: \"120:900\", \"120:\" or \":900\"");
  return row;
}

/// Keeps the rows "FIRST:LAST" of numbers; either end may be left out.
void keep_rows(const std::string& range, CsvTable& table) {
  if (range.empty()) return;
  const std::size_t rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  const std::string_view text = range;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) row_number("?", 0, table.file, range);
  const std::size_t first = row_number(text.substr(0, colon), 1, table.file, range);
  const std::size_t last = row_number(text.substr(colon + 1), rows, table.file, range);
  if (first > last || last > rows)
    refuse(table.file,
           "it has " + std::to_string(rows) + " rows of numbers, not those of '" + range + "'",
           "give rows from 1 to " + std::to_string(rows));
  for (CsvColumn& column : table.columns) {
    column.values.resize(std::min(last, column.values.size()));
    column.values.erase(column.values.begin(),
                        column.values.begin() +
                            static_cast<std::ptrdiff_t>(std::min(first - 1, column.values.size())));
  }
}

}  // namespace

CsvTable read_table(const std::filesystem::path& file, const TableChoice& choice,
                    const std::vector<DeclaredColumn>& declared,
                    const std::vector<std::string>& wanted) {
  const FileKind kind = kind_of(file);
  check_choice(file, choice, kind);
  if (kind != FileKind::Workbook) {
    CsvTable table = kind == FileKind::Text ? read_csv(file, declared, choice.table)
                                            : columns_by_path(file, kind, declared, wanted);
    keep_rows(choice.range, table);
    return table;
  }
  const SheetText sheet = read_sheet(file, {choice.sheet, choice.range});
  return parse_csv(sheet.text, file.string() + ", sheet '" + sheet.sheet + "'", declared,
                   choice.table);
}

}  // namespace palpate::measured
