// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/specimen_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "fitting/measurement/records/csv_text.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

/// Turns of less than this part of the range are noise, not the end of a branch.
constexpr double kTurn = 0.2;

calibrate::Mode mode_of(const std::string& text) {
  if (text == "uniaxial") return calibrate::Mode::Uniaxial;
  if (text == "equibiaxial") return calibrate::Mode::Equibiaxial;
  if (text == "pure shear") return calibrate::Mode::PureShear;
  if (text == "confined compression") return calibrate::Mode::Confined;
  return calibrate::Mode::SimpleShear;
}

void check_columns(const TestSection& s, const std::string& where) {
  if (s.deformation.empty() == s.displacement.empty())
    refuse(where, "the columns are not clear", "name either deformation or displacement");
  if (s.stress.empty() == s.force.empty())
    refuse(where, "the columns are not clear", "name either stress or force");
  if (!s.displacement.empty() && !std::isfinite(s.size.gauge_length))
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

/// The columns that a test names, of its record or of that of the stress alone.
std::vector<std::string> wanted_of(const TestSection& s, bool of_deformation, bool of_stress) {
  std::vector<std::string> names;
  if (of_deformation) names = {s.deformation, s.displacement};
  if (of_stress) names.insert(names.end(), {s.stress, s.force, s.uncertainty});
  std::erase(names, "");
  return names;
}

measured::CsvTable table_of(const std::filesystem::path& file,
                            const std::vector<std::string>& names,
                            const measured::TableChoice& choice,
                            const std::vector<std::string>& wanted) {
  if (names.size() == 1) return bare_column(file, names[0]);
  std::vector<measured::DeclaredColumn> declared;
  for (const std::string& name : names) declared.push_back({name, {}});
  return measured::read_table(file, choice, declared, wanted);
}

Columns read_columns(const TestSection& s, const std::filesystem::path& folder,
                     const std::string& where) {
  const bool apart = !s.stress_file.empty();
  const auto table = table_of(folder / s.file, s.columns, s.choice, wanted_of(s, true, !apart));
  const bool by_force = !s.force.empty();
  const std::string& name = by_force ? s.force : s.stress;
  std::optional<measured::CsvTable> other;
  if (apart)
    other = table_of(folder / s.stress_file,
                     s.columns.empty() ? s.columns : std::vector<std::string>{name}, s.choice,
                     wanted_of(s, false, true));
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

/// What the signs of the record are multiplied by.
struct SpecimenSigns {
  double deformation = 1, stress = 1;
};

bool is_stretch(const TestSection& s) {
  return s.displacement.empty() && s.mode != "simple shear" &&
         (s.deformation_is.empty() || s.deformation_is == "stretch");
}

/// The value of the column where the deformation is zero.
double zero_of(const TestSection& s, const std::vector<double>& x) {
  const double rest = is_stretch(s) ? 1 : 0;
  return s.zero == "first row" ? x.front() : rest;
}

double farthest(const std::vector<double>& values, double from) {
  double far = 0;
  for (const double value : values)
    if (std::abs(value - from) > std::abs(far)) far = value - from;
  return far;
}

/// A load is on one side of rest: what reaches farther to the other than this part is another one.
void check_one_side(const std::vector<double>& x, double zero, double far,
                    const std::string& where) {
  constexpr double kOtherSide = 0.25;
  for (const double value : x)
    if ((value - zero) * far < 0 && std::abs(value - zero) > kOtherSide * std::abs(far))
      refuse(where, "the record goes to both sides of rest, and `load` says one",
             "give deformation_sign and stress_sign, or rows of one load");
}

SpecimenSigns signs_of(const TestSection& s, const Columns& c, const std::string& where) {
  if (s.load.empty())
    return {s.deformation_sign == "reversed" ? -1.0 : 1.0,
            s.stress_sign == "reversed" ? -1.0 : 1.0};
  if (!s.deformation_sign.empty() || !s.stress_sign.empty())
    refuse(where, "both a load and signs are given", "give `load`, or the signs");
  if (s.mode == "simple shear")
    refuse(where, "simple shear is neither tension nor compression", "leave `load` out");
  const double zero = zero_of(s, c.deformation);
  const double far = farthest(c.deformation, zero);
  check_one_side(c.deformation, zero, far, where);
  const double wanted = s.load == "tension" ? 1 : -1;
  const SpecimenSigns signs{far * wanted < 0 ? -1.0 : 1.0,
                            farthest(c.stress, 0) * wanted < 0 ? -1.0 : 1.0};
  if (is_stretch(s) && signs.deformation < 0)
    refuse(where, fmt::format("stretches that reach {:.4g} are no {}", 1 + far, s.load),
           "correct `load`; a column that counts strain needs deformation_is = \"strain\"");
  return signs;
}

/// Stretches, or amounts of shear, from what the record has.
void deform(const TestSection& s, double rest, double sign, std::vector<double>& x) {
  const double zero = zero_of(s, x);
  for (double& value : x) {
    const double e = sign * (value - zero);
    if (!s.displacement.empty())
      value = rest + e / s.size.gauge_length;
    else if (s.deformation_is == "log strain")
      value = std::exp(e);
    else
      value = rest + e;
  }
}

/// How deformation and stress follow from the columns.
std::string statement_of(const TestSection& s, const SpecimenSigns& signs, double area) {
  const bool shear = s.mode == "simple shear";
  const std::string name = s.displacement.empty() ? s.deformation : s.displacement;
  const std::string shifted = s.zero == "first row" ? "(" + name + " - its first)" : name;
  const char* sign = signs.deformation < 0 ? "-" : "+";
  std::string text = shear ? "shear = " : "stretch = ";
  const std::string lead = shear ? (signs.deformation < 0 ? "-" : "") : fmt::format("1 {} ", sign);
  if (!s.displacement.empty())
    text += fmt::format("{}{}/({})", lead, shifted, length_text(s.size.gauge_length));
  else if (s.deformation_is == "log strain")
    text += fmt::format("exp({}{})", signs.deformation < 0 ? "-" : "", shifted);
  else if (is_stretch(s) && s.zero != "first row" && signs.deformation > 0)
    text += name;
  else
    text += lead + (is_stretch(s) && s.zero != "first row" ? "(" + name + " - 1)" : shifted);
  const char* minus = signs.stress < 0 ? "-" : "";
  if (!s.force.empty())
    return text + fmt::format(", nominal stress = {}{}/({})", minus, s.force, area_text(area));
  if (s.measure == "cauchy")
    return text + fmt::format(", Cauchy stress = {}{}, converted to nominal", minus, s.stress);
  return text + fmt::format(", nominal stress = {}{}", minus, s.stress);
}

/// @return what is kept of a record with several cycles, in words
std::string keep_branch(const TestSection& s, double rest, const std::string& where, Columns& c) {
  const std::vector<Branch> branches = branches_of(c.deformation, rest);
  std::vector<std::size_t> loadings;
  for (std::size_t i = 0; i < branches.size(); ++i)
    if (branches[i].loading) loadings.push_back(i);
  const bool has_several = loadings.size() > 1;
  if (s.cycle == 0 && s.branch == "both")
    return has_several ? fmt::format(", all {} cycles", loadings.size()) : "";
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
  return has_several ? fmt::format(", cycle {} of {}", number, loadings.size()) : "";
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

SpecimenTest read_test(const TestSection& s, const std::filesystem::path& folder,
                       const std::string& where) {
  check_columns(s, where);
  const double area = s.force.empty() ? 1 : section_area(s.size, where);
  Columns c = read_columns(s, folder, where);
  keep_rows(s, where, c);
  SpecimenTest specimen;
  calibrate::HomogeneousTest& test = specimen.test;
  test.name = s.file;
  test.mode = mode_of(s.mode);
  test.weight = s.weight;
  test.offset = s.offset;
  const double rest = calibrate::rest_of(test.mode);
  const SpecimenSigns signs = signs_of(s, c, where);
  specimen.statement = statement_of(s, signs, area);
  deform(s, rest, signs.deformation, c.deformation);
  specimen.statement += keep_branch(s, rest, where, c);
  test.deformation = c.deformation;
  test.uncertainty = c.uncertainty;
  for (std::size_t i = 0; i < c.stress.size(); ++i) {
    const double ratio = s.measure == "cauchy" && s.force.empty()
                             ? calibrate::cauchy_over_nominal(test.mode, test.deformation[i])
                             : 1;
    test.nominal.push_back(signs.stress * c.stress[i] / (area * ratio));
    if (!test.uncertainty.empty()) test.uncertainty[i] /= area * ratio;
  }
  return specimen;
}

}  // namespace palpate::app
