// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/specimen_record.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>

#include "fitting/measurement/records/csv_table.hpp"
#include "fitting/measurement/records/csv_text.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

/// Turns of less than this part of the range are noise, not the end of a branch.
constexpr double kTurn = 0.2;

calibrate::Mode mode_of(const std::string& text) {
  if (text == "uniaxial") return calibrate::Mode::Uniaxial;
  if (text == "equibiaxial") return calibrate::Mode::Equibiaxial;
  if (text == "pure shear") return calibrate::Mode::PureShear;
  return calibrate::Mode::SimpleShear;
}

/// "120 mm^2" in m^2.
double area_of(const std::string& text, const std::string& where) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  std::string unit(end);
  unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
  if (end != text.c_str() && value > 0 && std::isfinite(value) && unit.ends_with("^2")) {
    const auto length = measured::unit_in_si(unit.substr(0, unit.size() - 2), Dimension::Length);
    if (length) return value * *length * *length;
  }
  refuse(where, "'" + text + "' is not an area with its unit", "write for example \"120 mm^2\"");
}

/// Section of the specimen, m^2.
double section_area(const TestSection& s, const std::string& where) {
  const bool rectangle = std::isfinite(s.width) && std::isfinite(s.thickness);
  const int given =
      (s.area.empty() ? 0 : 1) + (rectangle ? 1 : 0) + (std::isfinite(s.diameter) ? 1 : 0);
  if (given != 1)
    refuse(where, "a force needs the section of the specimen, once",
           "give area, or width and thickness, or diameter");
  if (!s.area.empty()) return area_of(s.area, where);
  if (rectangle) return s.width * s.thickness;
  return std::numbers::pi / 4 * s.diameter * s.diameter;
}

void check_columns(const TestSection& s, const std::string& where) {
  if (s.deformation.empty() == s.displacement.empty())
    refuse(where, "the columns are not clear", "name either deformation or displacement");
  if (s.stress.empty() == s.force.empty())
    refuse(where, "the columns are not clear", "name either stress or force");
  if (!s.displacement.empty() && !std::isfinite(s.gauge_length))
    refuse(where, "a travel needs the length that it deforms", "give gauge_length");
  const bool shear = s.mode == "simple shear";
  if (!s.deformation_is.empty() && (shear != (s.deformation_is == "shear")))
    refuse(where, "the deformation of " + s.mode + " is not a " + s.deformation_is,
           shear ? "give the amount of shear" : "give stretch, strain or log strain");
}

/// Columns of both files as the section names them.
struct Columns {
  std::vector<double> deformation, stress, uncertainty;
};

/// A file of bare numbers, one a line, which is no table to read_csv.
measured::CsvTable bare_column(const std::filesystem::path& file, const std::string& name) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(file.string(), "it cannot be read", "check path and permissions");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string utf8 = measured::as_utf8(text);
  measured::CsvTable table{file.string(), 0, {}, {{name, {}, {}}}};
  for (const measured::Line& line : measured::lines_of(utf8)) {
    const auto fields = measured::split(line.text, measured::kBlanks);
    const auto value = fields.size() == 1 ? measured::number_of(fields[0], '.') : std::nullopt;
    if (!value)
      refuse(file.string() + ":" + std::to_string(line.number), "it is not one number",
             "give one number a line, or name all columns in `columns`");
    table.columns[0].values.push_back(*value);
  }
  return table;
}

measured::CsvTable table_of(const std::filesystem::path& file,
                            const std::vector<std::string>& names, int table) {
  if (names.size() == 1) return bare_column(file, names[0]);
  std::vector<measured::DeclaredColumn> declared;
  for (const std::string& name : names) declared.push_back({name, {}});
  return measured::read_csv(file, declared, table);
}

Columns read_columns(const TestSection& s, const std::filesystem::path& folder,
                     const std::string& where) {
  const auto table = table_of(folder / s.file, s.columns, s.table);
  const bool by_force = !s.force.empty();
  const std::string& name = by_force ? s.force : s.stress;
  std::optional<measured::CsvTable> other;
  if (!s.stress_file.empty())
    other = table_of(folder / s.stress_file,
                     s.columns.empty() ? s.columns : std::vector<std::string>{name}, s.table);
  const measured::CsvTable& of_stress = other ? *other : table;
  const Dimension dimension = by_force ? Dimension::Force : Dimension::Pressure;
  Columns c;
  c.deformation =
      s.displacement.empty()
          ? measured::column_in_si(table, s.deformation, Dimension::Ratio, s.deformation_unit)
          : measured::column_in_si(table, s.displacement, Dimension::Length, s.deformation_unit);
  c.stress = measured::column_in_si(of_stress, name, dimension, s.stress_unit);
  if (!s.uncertainty.empty())
    c.uncertainty = measured::column_in_si(of_stress, s.uncertainty, dimension, s.stress_unit);
  if (c.deformation.size() != c.stress.size())
    refuse(where,
           std::to_string(c.deformation.size()) + " deformations do not go with " +
               std::to_string(c.stress.size()) + " stresses",
           "give files with as many rows");
  return c;
}

void keep(Columns& c, std::size_t first, std::size_t last) {
  for (std::vector<double>* column : {&c.deformation, &c.stress, &c.uncertainty}) {
    if (column->empty()) continue;
    column->resize(last + 1);
    column->erase(column->begin(), column->begin() + static_cast<std::ptrdiff_t>(first));
  }
}

void keep_rows(const TestSection& s, const std::string& where, Columns& c) {
  const std::size_t rows = c.deformation.size();
  const std::size_t last = s.last_row == 0 ? rows : static_cast<std::size_t>(s.last_row);
  const auto first = static_cast<std::size_t>(s.first_row);
  if (first > last || last > rows)
    refuse(where,
           "the record has " + std::to_string(rows) + " rows of numbers, not " +
               std::to_string(first) + " to " + std::to_string(last),
           "give first_row and last_row within them");
  keep(c, first - 1, last - 1);
}

/// Stretches, or amounts of shear, from what the record has.
void deform(const TestSection& s, double rest, std::vector<double>& x) {
  const double sign = s.deformation_sign == "reversed" ? -1 : 1;
  const bool travel = !s.displacement.empty();
  const bool is_stretch =
      !travel && rest == 1 && (s.deformation_is.empty() || s.deformation_is == "stretch");
  const double zero = s.zero == "first row" ? x.front() - (is_stretch ? 1 : 0) : 0;
  for (double& value : x) {
    value -= zero;
    if (travel)
      value = rest + sign * value / s.gauge_length;
    else if (is_stretch)
      value = 1 + sign * (value - 1);
    else if (s.deformation_is == "log strain")
      value = std::exp(sign * value);
    else
      value = rest + sign * value;
  }
}

void keep_branch(const TestSection& s, double rest, const std::string& where, Columns& c) {
  if (s.cycle == 0 && s.branch == "both") return;
  const std::vector<Branch> branches = branches_of(c.deformation, rest);
  std::vector<std::size_t> loadings;
  for (std::size_t i = 0; i < branches.size(); ++i)
    if (branches[i].loading) loadings.push_back(i);
  const int cycle = s.cycle == 0 && loadings.size() == 1 ? 1 : s.cycle;
  const std::size_t number = cycle < 0 ? loadings.size() : static_cast<std::size_t>(cycle);
  if (number == 0 || number > loadings.size())
    refuse(where,
           "the record has " + std::to_string(loadings.size()) + " cycles, and no cycle " +
               std::to_string(s.cycle),
           "give cycle, from 1, or -1 for the last");
  const std::size_t loading = loadings[number - 1];
  const bool returns = loading + 1 < branches.size();
  if (s.branch == "unloading" && !returns)
    refuse(where, "cycle " + std::to_string(number) + " does not unload", "choose another cycle");
  const std::size_t begin = s.branch == "unloading" ? loading + 1 : loading;
  const std::size_t end = s.branch == "loading" || !returns ? loading : loading + 1;
  keep(c, branches[begin].first, branches[end].last);
}

}  // namespace

std::vector<Branch> branches_of(const std::vector<double>& deformation, double rest) {
  std::vector<double> x;
  for (const double s : deformation) x.push_back(std::abs(s - rest));
  std::vector<Branch> branches;
  if (x.size() < 2) return branches;
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double turn = kTurn * (*high - *low);
  std::size_t first = 0, extreme = 0;
  bool loading = true;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (loading ? x[i] >= x[extreme] : x[i] <= x[extreme]) extreme = i;
    const double back = loading ? x[extreme] - x[i] : x[i] - x[extreme];
    if (!(back > turn)) continue;
    if (extreme > first) branches.push_back({first, extreme, loading});
    first = extreme;
    extreme = i;
    loading = !loading;
  }
  if (extreme > first) branches.push_back({first, extreme, loading});
  return branches;
}

calibrate::HomogeneousTest read_test(const TestSection& s, const std::filesystem::path& folder,
                                     const std::string& where) {
  check_columns(s, where);
  const double area = s.force.empty() ? 1 : section_area(s, where);
  Columns c = read_columns(s, folder, where);
  keep_rows(s, where, c);
  calibrate::HomogeneousTest test;
  test.name = s.file;
  test.mode = mode_of(s.mode);
  test.weight = s.weight;
  test.offset = s.offset;
  const double rest = calibrate::rest_of(test.mode);
  deform(s, rest, c.deformation);
  keep_branch(s, rest, where, c);
  test.deformation = c.deformation;
  test.uncertainty = c.uncertainty;
  const double sign = s.stress_sign == "reversed" ? -1 : 1;
  for (std::size_t i = 0; i < c.stress.size(); ++i) {
    const double ratio = s.measure == "cauchy" && s.force.empty()
                             ? calibrate::cauchy_over_nominal(test.mode, test.deformation[i])
                             : 1;
    test.nominal.push_back(sign * c.stress[i] / (area * ratio));
    if (!test.uncertainty.empty()) test.uncertainty[i] /= area * ratio;
  }
  return test;
}

}  // namespace palpate::app
