// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/csv_table.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "fitting/measurement/records/csv_text.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/text.hpp"

namespace palpate::measured {
namespace {

/// Fewer rows of numbers than this are a table of results, not a record.
constexpr std::size_t kFewestRows = 3;

struct Dialect {
  char separator;
  char decimal;
};
constexpr Dialect kDialects[] = {{'\t', '.'}, {';', '.'}, {',', '.'},     {'\t', ','},
                                 {';', ','},  {',', ','}, {kBlanks, '.'}, {kBlanks, ','}};

/// A run of lines that are all numbers, equally many on each.
struct Run {
  std::size_t begin = 0, end = 0;
  std::size_t width = 0;
  std::size_t rows() const { return end - begin; }
};

/// A row that was cut off in the middle of a number would otherwise pass for a shorter number.
bool ends_within_quotes(const Line& line) {
  return std::count(line.text.begin(), line.text.end(), '"') % 2 != 0;
}

std::size_t width_if_numbers(const Line& line, const Dialect& dialect) {
  if (ends_within_quotes(line)) return 0;
  const auto fields = split(line.text, dialect.separator);
  for (const std::string& field : fields) {
    if (!number_of(field, dialect.decimal)) return 0;
  }
  return fields.size();
}

/// The first run at or after a line; empty when there is none.
Run next_run(const std::vector<Line>& lines, std::size_t from, const Dialect& dialect) {
  Run run{from, from, 0};
  for (std::size_t i = from; i < lines.size(); ++i) {
    const std::size_t width = width_if_numbers(lines[i], dialect);
    if (run.rows() > 0 && width != run.width) break;
    if (width < 2) continue;
    if (run.rows() == 0) run = {i, i, width};
    run.end = i + 1;
  }
  return run;
}

Run longest_run(const std::vector<Line>& lines, const Dialect& dialect) {
  Run longest;
  for (Run run = next_run(lines, 0, dialect); run.rows() > 0;
       run = next_run(lines, run.end, dialect)) {
    if (run.rows() > longest.rows()) longest = run;
  }
  return longest;
}

std::string at_line(const std::string& file, const Line& line) {
  return file + ":" + std::to_string(line.number);
}

/// Refuses a row that interrupts the numbers, by its first field that is no number.
[[noreturn]] void refuse_row(const std::string& file, const Line& line, const Dialect& dialect,
                             std::size_t width) {
  if (ends_within_quotes(line)) {
    refuse(at_line(file, line), "the row ends within quotes",
           "the file was cut off: copy it again");
  }
  const auto fields = split(line.text, dialect.separator);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (number_of(fields[i], dialect.decimal)) continue;
    refuse(at_line(file, line),
           "field " + std::to_string(i + 1) + " ('" + fields[i] + "') is not a number",
           "mend or remove the row; another table needs a header of its own");
  }
  const std::string_view row = trimmed(line.text);
  if (fields.size() + 1 == width && (row.ends_with(dialect.separator) || row.ends_with("\"\""))) {
    refuse(at_line(file, line), "field " + std::to_string(width) + " is empty",
           "mend or remove the row");
  }
  refuse(at_line(file, line),
         "the row has " + std::to_string(fields.size()) + " fields, " + std::to_string(width) +
             " expected",
         "mend or remove the row; another table needs a header of its own");
}

/// The line and the separators with the most numbers beside something else.
struct MixedRow {
  const Line* line = nullptr;
  std::size_t numbers = 0;
  std::string other;  ///< the first that is no number
};

MixedRow most_numbers(const std::vector<Line>& lines) {
  MixedRow best;
  for (const Dialect& dialect : kDialects)
    for (const Line& line : lines) {
      MixedRow row{&line, 0, {}};
      for (const std::string& field : split(line.text, dialect.separator)) {
        if (number_of(field, dialect.decimal))
          ++row.numbers;
        else if (row.other.empty())
          row.other = field;
      }
      if (row.numbers > best.numbers && !row.other.empty()) best = row;
    }
  return best;
}

/// Refuses a file without enough rows of numbers, by what it has instead.
[[noreturn]] void refuse_table(const std::string& file, const std::vector<Line>& lines,
                               const Run& longest) {
  const std::string needed = "give at least " + std::to_string(kFewestRows) +
                             " rows of numbers alone, their columns separated by tabs, "
                             "semicolons, commas or blanks";
  if (longest.rows() > 0)
    refuse(at_line(file, lines[longest.begin]),
           "the table has " + count_text(longest.rows(), "row") + " of numbers", needed);
  const MixedRow row = most_numbers(lines);
  if (row.numbers > 0)
    refuse(at_line(file, *row.line), "'" + row.other + "' is not a number",
           needed + "; remove columns of text");
  refuse(file, "no table of numbers in it", needed);
}

std::string without_brackets(std::string_view text) {
  text = trimmed(text);
  const bool round = text.starts_with('(') && text.ends_with(')');
  const bool square = text.starts_with('[') && text.ends_with(']');
  if (text.size() >= 2 && (round || square)) text = trimmed(text.substr(1, text.size() - 2));
  return std::string(text);
}

bool is_bracketed(std::string_view text) {
  return without_brackets(text) != trimmed(text);
}

/// A row of units: every field that is not empty is one, or stands in brackets.
bool is_unit_row(const std::vector<std::string>& fields) {
  bool any = false;
  for (const std::string& field : fields) {
    if (field.empty()) continue;
    if (!is_bracketed(field) && !is_record_unit(field)) return false;
    any = true;
  }
  return any;
}

/// "Load (N)", "Load [N]", "Load / N", "Load in N", "Load, N", "Load_N" -> name and unit. What
/// follows must be a known unit, except in brackets at the end.
CsvColumn name_and_unit(const std::string& field) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const auto at = field.rfind(open);
    if (at == std::string::npos || at == 0 || !field.ends_with(close)) continue;
    return {std::string(trimmed(std::string_view(field).substr(0, at))),
            without_brackets(field.substr(at)),
            {}};
  }
  for (const std::string_view mark : {" / ", "/", " in ", ", ", "_"}) {
    const auto at = field.rfind(mark);
    if (at == std::string::npos || at == 0) continue;
    const std::string unit(trimmed(std::string_view(field).substr(at + mark.size())));
    if (!is_record_unit(unit)) continue;
    return {std::string(trimmed(std::string_view(field).substr(0, at))), unit, {}};
  }
  return {field, "", {}};
}

std::vector<CsvColumn> header_columns(const std::string& file, const std::vector<Line>& lines,
                                      const Run& run, const Dialect& dialect,
                                      std::size_t& header_begin) {
  const std::string remedy = "declare the columns with [[column]] in the sidecar";
  if (run.begin == 0) refuse(file, "the table has no header", remedy);
  std::size_t names_at = run.begin - 1;
  auto names = split(lines[names_at].text, dialect.separator);
  std::vector<std::string> units;
  if (is_unit_row(names) && names_at > 0) {
    units = std::exchange(names, split(lines[--names_at].text, dialect.separator));
    units.resize(run.width);
  }
  if (names.size() != run.width) {
    refuse(at_line(file, lines[names_at]),
           "the header has " + std::to_string(names.size()) + " names for " +
               std::to_string(run.width) + " columns of numbers",
           remedy);
  }
  std::vector<CsvColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (number_of(names[i], dialect.decimal)) refuse_row(file, lines[names_at], dialect, run.width);
    columns.push_back(units.empty() ? name_and_unit(names[i])
                                    : CsvColumn{names[i], without_brackets(units[i]), {}});
  }
  header_begin = names_at;
  return columns;
}

std::vector<CsvColumn> declared_columns(const std::string& file, const Run& run,
                                        const std::vector<DeclaredColumn>& declared) {
  if (declared.size() != run.width) {
    refuse(file,
           std::to_string(declared.size()) + " columns are declared, the table has " +
               std::to_string(run.width),
           "declare each column of the file, in order");
  }
  std::vector<CsvColumn> columns;
  for (const DeclaredColumn& column : declared) columns.push_back({column.name, column.unit, {}});
  return columns;
}

void read_rows(const std::vector<Line>& lines, const Run& run, const Dialect& dialect,
               std::vector<CsvColumn>& columns) {
  for (std::size_t row = run.begin; row < run.end; ++row) {
    const auto fields = split(lines[row].text, dialect.separator);
    for (std::size_t i = 0; i < run.width; ++i) {
      columns[i].values.push_back(*number_of(fields[i], dialect.decimal));
    }
  }
}

}  // namespace

namespace {

/// Whether the lines before a run end in a header of its own: names for all its columns, none of
/// them a number.
bool has_header(const std::vector<Line>& lines, std::size_t begin, const Run& run,
                const Dialect& dialect) {
  if (run.begin <= begin) return false;
  std::size_t names_at = run.begin - 1;
  auto names = split(lines[names_at].text, dialect.separator);
  if (is_unit_row(names) && names_at > begin)
    names = split(lines[--names_at].text, dialect.separator);
  return names.size() == run.width &&
         std::none_of(names.begin(), names.end(), [&](const auto& name) {
           return name.empty() || number_of(name, dialect.decimal);
         });
}

/// "<END DATA>" of a tester that puts its blocks between marks.
bool is_mark(const Line& line) {
  const std::string_view text = trimmed(line.text);
  return text.starts_with('<') && text.ends_with('>');
}

/// The tables of a file: the first run that is long enough, and every later one under a header.
std::vector<Run> tables_of(const std::vector<Line>& lines, const std::string& file,
                           const Run& longest, const Dialect& dialect) {
  std::vector<Run> tables;
  std::size_t from = 0;
  while (from < lines.size()) {
    Run run = next_run(lines, from, dialect);
    if (run.rows() == 0) break;
    const bool is_first = tables.empty();
    const bool is_table =
        run.rows() >= kFewestRows &&
        (is_first ? run.width == longest.width || has_header(lines, from, run, dialect)
                  : has_header(lines, from, run, dialect));
    if (is_table) tables.push_back(run);
    if (!is_table && !is_first) break;
    from = run.end;
  }
  // What follows the last table is neither a table nor numbers of one.
  std::size_t end = tables.empty() ? lines.size() : tables.back().end;
  while (end < lines.size() && is_mark(lines[end])) ++end;
  if (end < lines.size()) refuse_row(file, lines[end], dialect, tables.back().width);
  return tables;
}

const Run& chosen(const std::vector<Run>& tables, int table, const std::string& file) {
  const std::string count = std::to_string(tables.size());
  if (table == 0 && tables.size() > 1) {
    refuse(file, "it holds " + count + " tables", "choose one with `table` = 1 to " + count);
  }
  if (table < 0 || static_cast<std::size_t>(table) > tables.size()) {
    refuse(file, "there is no table " + std::to_string(table) + ", the file has " + count,
           "choose one with `table` = 1 to " + count);
  }
  return tables[table == 0 ? 0 : static_cast<std::size_t>(table - 1)];
}

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& file,
                   const std::vector<DeclaredColumn>& declared, int table_number) {
  const std::string utf8 = as_utf8(text);
  const std::vector<Line> lines = lines_of(utf8);
  Run longest;
  Dialect dialect = kDialects[0];
  for (const Dialect& candidate : kDialects) {
    const Run found = longest_run(lines, candidate);
    if (found.rows() <= longest.rows()) continue;
    longest = found;
    dialect = candidate;
  }
  if (longest.rows() < kFewestRows) refuse_table(file, lines, longest);
  const std::vector<Run> tables = tables_of(lines, file, longest, dialect);
  const Run& run = chosen(tables, table_number, file);
  CsvTable table;
  table.file = file;
  table.first_data_line = lines[run.begin].number;
  std::size_t header_begin = run.begin;
  table.columns = declared.empty() ? header_columns(file, lines, run, dialect, header_begin)
                                   : declared_columns(file, run, declared);
  // The preamble of a later table starts after the table before it.
  std::size_t first = 0;
  for (const Run& other : tables) {
    if (other.end <= header_begin) first = other.end;
  }
  for (std::size_t i = first; i < header_begin; ++i) {
    table.preamble.emplace_back(trimmed(lines[i].text));
  }
  read_rows(lines, run, dialect, table.columns);
  return table;
}

CsvTable read_csv(const std::filesystem::path& path, const std::vector<DeclaredColumn>& declared,
                  int table) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  std::error_code none;
  if (stream && std::filesystem::is_regular_file(path, none) &&
      std::filesystem::is_empty(path, none)) {
    refuse(path.string(), "the file is empty", "copy or record it again");
  }
  if (!stream || !(text << stream.rdbuf())) {
    refuse(path.string(), "the record cannot be read", "check path and permissions");
  }
  return parse_csv(text.str(), path.string(), declared, table);
}

std::string unit_of_name(const std::string& name) {
  return name_and_unit(name).unit;
}

namespace {

const CsvColumn& column_of(const CsvTable& table, const std::string& name) {
  const auto is_it = [&](const CsvColumn& column) { return column.name == name; };
  const auto count = std::count_if(table.columns.begin(), table.columns.end(), is_it);
  if (count != 1) {
    std::string names;
    for (const CsvColumn& column : table.columns) {
      names += (names.empty() ? "'" : ", '") + column.name + "'";
    }
    refuse(table.file,
           count == 0 ? "no column is named '" + name + "'"
                      : "several columns are named '" + name + "'",
           "the columns are " + names);
  }
  return *std::find_if(table.columns.begin(), table.columns.end(), is_it);
}

}  // namespace

std::vector<double> column_in_si(const CsvTable& table, const std::string& name,
                                 Dimension dimension, const std::string& declared_unit) {
  const CsvColumn& column = column_of(table, name);
  const std::string where = table.file + ", column '" + name + "'";
  const std::string units =
      "units of " + std::string(dimension_name(dimension)) + " are " + record_unit_list(dimension);
  if (column.unit.empty() && declared_unit.empty()) {
    refuse(where, "its unit is not given, neither in the file nor in the sidecar",
           "declare it in the sidecar; " + units);
  }
  const std::string& symbol = column.unit.empty() ? declared_unit : column.unit;
  const auto si = unit_in_si(symbol, dimension);
  if (!si) {
    refuse(where, "'" + symbol + "' is not a unit of " + std::string(dimension_name(dimension)),
           units);
  }
  if (!column.unit.empty() && !declared_unit.empty() &&
      unit_in_si(declared_unit, dimension) != si) {
    refuse(where, "the file says '" + column.unit + "', the sidecar says '" + declared_unit + "'",
           "correct the one that is wrong");
  }
  std::vector<double> values = column.values;
  for (double& value : values) value *= *si;
  return values;
}

std::vector<double> column_without_unit(const CsvTable& table, const std::string& name) {
  const CsvColumn& column = column_of(table, name);
  if (!column.unit.empty() && column.unit != "1" && column.unit != "-") {
    refuse(table.file + ", column '" + name + "'",
           "it has the unit '" + column.unit + "', and is a pure number",
           "name the column of the site, or of a component of the unit normal");
  }
  return column.values;
}

}  // namespace palpate::measured
