// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/fit_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/case/reader.hpp"
#include "fitting/measurement/records/csv_table.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

struct LawSection {
  std::string law, weighting = "per test", residual = "nominal";
  double poisson = calibrate::kCasePoisson, confidence = 0.95;
};

struct ConstantSection {
  std::string name, start, low, high;
};

struct TestSection {
  std::string file, mode, measure = "nominal";
  std::string deformation, stress;  ///< columns of stretch (or shear) and stress
  std::string displacement, force;  ///< or of displacement and force, with a specimen
  std::string uncertainty;          ///< column, of the stress or the force
  double height = std::numeric_limits<double>::quiet_NaN();
  double width = std::numeric_limits<double>::quiet_NaN();
  double thickness = std::numeric_limits<double>::quiet_NaN();
  double weight = 1;
};

struct FitDocument {
  std::string name, source, licence, description;
  LawSection law;
  std::vector<ConstantSection> constants;
  std::vector<TestSection> tests;
};

template <class V>
void describe(V& v, LawSection& s) {
  Choices laws;
  for (const fem::LawEntry& law : fem::law_table()) laws.push_back(law.name);
  v.text(s.law, {"law", "hyperelastic law", kRequired}, laws);
  v.number(s.poisson, {"poisson",
                       "Poisson's ratio of the case that receives the constants; not fitted",
                       kOptional,
                       {.low = 0, .high = 0.5, .high_open = true}});
  v.text(s.weighting, {"weighting", "scale of the residuals"},
         {"per test", "absolute", "relative", "uncertainty"});
  v.text(s.residual, {"residual", "stress in which misfit is measured"}, {"nominal", "cauchy"});
  v.number(s.confidence,
           {"confidence", "of the intervals", kOptional, {.low = 0.5, .high = 0.9999}});
}

template <class V>
void describe(V& v, ConstantSection& s) {
  v.text(s.name, {"name", "of the constant", kRequired});
  v.text(s.start, {"start", "first guess, with its unit", kRequired});
  v.text(s.low, {"low", "lower bound, with its unit", kRequired});
  v.text(s.high, {"high", "upper bound, with its unit", kRequired});
}

template <class V>
void describe(V& v, TestSection& s) {
  v.text(s.file, {"file", "record, relative to this file", kRequired});
  v.text(s.mode, {"mode", "deformation of the test", kRequired},
         {"uniaxial", "equibiaxial", "pure shear", "simple shear"});
  v.text(s.measure, {"measure", "which stress the record holds"}, {"nominal", "cauchy"});
  v.text(s.deformation, {"deformation", "column of the stretch, or of the amount of shear"});
  v.text(s.stress, {"stress", "column"});
  v.text(s.displacement, {"displacement", "column, instead of the deformation"});
  v.text(s.force, {"force", "column, instead of the stress"});
  v.text(s.uncertainty, {"uncertainty", "column: standard uncertainty of stress or force"});
  v.quantity(s.height, Dimension::Length,
             {"height", "of the specimen along the displacement", kOptional, kPositive});
  v.quantity(s.width, Dimension::Length, {"width", "of the section", kOptional, kPositive});
  v.quantity(s.thickness, Dimension::Length, {"thickness", "of the section", kOptional, kPositive});
  v.number(s.weight, {"weight", "of the residuals of this test", kOptional, kPositive});
}

template <class V>
void describe(V& v, FitDocument& d) {
  v.text(d.name, {"name", "of the material", kRequired});
  v.text(d.source, {"source", "of the data", kRequired});
  v.text(d.licence, {"licence", "of the data", kRequired});
  v.text(d.description, {"description", "anything else"});
  v.section("fit", d.law, kRequired, "");
  v.sections("constant", d.constants, kOptional, "");
  v.sections("test", d.tests, kRequired, "");
}

double bound_of(const std::string& text, bool is_stress, const std::string& where) {
  if (text == "none") return std::numeric_limits<double>::infinity();
  if (!is_stress) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0' && std::isfinite(value)) return value;
    refuse(where, "'" + text + "' is not a number", "this constant has no unit: write \"4.5\"");
  }
  const ParsedQuantity parsed = parse_quantity(text, Dimension::Pressure);
  if (parsed.fault == QuantityFault::None) return parsed.value;
  refuse(where, "'" + text + "' is not a pressure with its unit", "write for example \"10 kPa\"");
}

calibrate::ConstantInfo constant_of(const ConstantSection& s, const std::string& law,
                                    const std::string& where) {
  std::string names;
  for (calibrate::ConstantInfo info :
       calibrate::default_constants(calibrate::IncompressibleLaw(law), {})) {
    names += (names.empty() ? "" : ", ") + info.name;
    if (info.name != s.name) continue;
    info.start = bound_of(s.start, info.is_stress, where);
    const double low = bound_of(s.low, info.is_stress, where);
    info.low = s.low == "none" ? -low : low;
    info.high = bound_of(s.high, info.is_stress, where);
    return info;
  }
  refuse(where, "the law " + law + " has no constant '" + s.name + "'",
         "its constants are " + names);
}

calibrate::Mode mode_of(const std::string& text) {
  if (text == "uniaxial") return calibrate::Mode::Uniaxial;
  if (text == "equibiaxial") return calibrate::Mode::Equibiaxial;
  if (text == "pure shear") return calibrate::Mode::PureShear;
  return calibrate::Mode::SimpleShear;
}

calibrate::Weighting weighting_of(const std::string& text) {
  if (text == "absolute") return calibrate::Weighting::Absolute;
  if (text == "relative") return calibrate::Weighting::Relative;
  if (text == "uncertainty") return calibrate::Weighting::Uncertainty;
  return calibrate::Weighting::PerTest;
}

void check_columns(const TestSection& s, const std::string& where) {
  const bool by_stress = !s.deformation.empty() && !s.stress.empty();
  const bool by_force = !s.displacement.empty() && !s.force.empty();
  if (by_stress == by_force) {
    refuse(where, "the columns are not clear",
           "name either deformation and stress, or displacement and force");
  }
  if (!by_force) return;
  if (std::isfinite(s.height) && std::isfinite(s.width) && std::isfinite(s.thickness)) return;
  refuse(where, "a force needs the size of the specimen", "give height, width and thickness");
}

calibrate::HomogeneousTest test_of(const TestSection& s, const std::filesystem::path& file) {
  const auto table = measured::read_csv(file);
  calibrate::HomogeneousTest test;
  test.name = s.file;
  test.mode = mode_of(s.mode);
  test.weight = s.weight;
  const double rest = calibrate::rest_of(test.mode);
  double area = 1;
  if (!s.force.empty()) {
    area = s.width * s.thickness;
    test.deformation = measured::column_in_si(table, s.displacement, Dimension::Length);
    for (double& x : test.deformation) x = rest + x / s.height;
    test.nominal = measured::column_in_si(table, s.force, Dimension::Force);
  } else {
    test.deformation = measured::column_in_si(table, s.deformation, Dimension::Ratio);
    test.nominal = measured::column_in_si(table, s.stress, Dimension::Pressure);
  }
  if (!s.uncertainty.empty()) {
    test.uncertainty = measured::column_in_si(
        table, s.uncertainty, s.force.empty() ? Dimension::Pressure : Dimension::Force);
  }
  for (std::size_t i = 0; i < test.nominal.size(); ++i) {
    const double ratio = s.measure == "cauchy" && s.force.empty()
                             ? calibrate::cauchy_over_nominal(test.mode, test.deformation[i])
                             : 1;
    test.nominal[i] /= area * ratio;
    if (!test.uncertainty.empty()) test.uncertainty[i] /= area * ratio;
  }
  return test;
}

}  // namespace

FitFile read_fit_file(const std::filesystem::path& path) {
  const toml::table table = read_toml(path, "the fit file");
  SourceMap sources(path.string());
  FitDocument document;
  TableReader reader(table, "the fit file", "", sources);
  describe(reader, document);
  reader.finish();
  FitFile fit{document.name, document.source, document.licence, {}, {}, {}};
  fit.settings.law = calibrate::IncompressibleLaw(document.law.law).name();
  fit.settings.poisson = document.law.poisson;
  fit.settings.weighting = weighting_of(document.law.weighting);
  fit.settings.residual = document.law.residual == "cauchy" ? calibrate::Residual::Cauchy
                                                            : calibrate::Residual::Nominal;
  fit.settings.confidence = document.law.confidence;
  fit.settings.profiles = true;
  for (std::size_t i = 0; i < document.constants.size(); ++i) {
    fit.settings.constants.push_back(constant_of(document.constants[i], fit.settings.law,
                                                 sources.where(fmt::format("constant[{}].", i))));
  }
  for (std::size_t i = 0; i < document.tests.size(); ++i) {
    const TestSection& test = document.tests[i];
    check_columns(test, sources.where(fmt::format("test[{}].", i)));
    fit.files.push_back(path.parent_path() / test.file);
    fit.tests.push_back(test_of(test, fit.files.back()));
  }
  return fit;
}

}  // namespace palpate::app
