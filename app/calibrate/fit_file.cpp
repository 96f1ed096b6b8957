// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/fit_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/calibrate/specimen_record.hpp"
#include "app/case/reader.hpp"
#include "format/error.hpp"

namespace palpate::app {

template <class V>
void describe_record(V& v, TestSection& s) {
  v.text(s.file, {"file", "record, relative to this file", kRequired});
  v.text(s.stress_file, {"stress_file", "record of the stress or force, where it stands apart"});
  v.texts(s.columns, {"columns", "names in order, of a file without a header"});
  describe_table_choice(v, s.choice);
  v.integer(s.first_row, {"first_row", "first row of numbers, from 1", kOptional, {.low = 1}});
  v.integer(s.last_row, {"last_row", "last one; 0: of the record", kOptional, kNotNegative});
  v.integer(s.cycle, {"cycle",
                      "which cycle away from rest and back; 0 is all, -1 the last",
                      kOptional,
                      {.low = -1, .high = 1e6}});
  v.text(s.branch, {"branch", "of the cycle"}, {"both", "loading", "unloading"});
}

template <class V>
void describe_columns(V& v, TestSection& s) {
  v.text(s.measure, {"measure", "which stress the record holds"}, {"nominal", "cauchy"});
  v.text(s.deformation, {"deformation", "column"});
  v.text(s.deformation_is, {"deformation_is", "what the column holds"},
         {"stretch", "strain", "log strain", "shear"});
  v.text(s.stress, {"stress", "column"});
  v.text(s.displacement, {"displacement", "column of the travel, instead of the deformation"});
  v.text(s.force, {"force", "column, instead of the stress"});
  v.text(s.uncertainty, {"uncertainty", "column: standard uncertainty of stress or force"});
  v.text(s.deformation_unit,
         {"deformation_unit", "of deformation or travel, where the file has none"});
  v.text(s.stress_unit, {"stress_unit", "of stress or force, where the file has none"});
  v.text(s.deformation_sign, {"deformation_sign", "of strain, travel or shear"},
         {"as recorded", "reversed"});
  v.text(s.stress_sign, {"stress_sign", "of stress or force"}, {"as recorded", "reversed"});
  v.text(s.load, {"load", "of the specimen, whatever the signs of the record"},
         {"tension", "compression"});
  v.text(s.zero, {"zero", "where the deformation is zero"}, {"as recorded", "first row"});
}

template <class V>
void describe(V& v, TestSection& s) {
  describe_record(v, s);
  v.text(s.mode, {"mode", "deformation of the test", kRequired},
         {"uniaxial", "equibiaxial", "pure shear", "simple shear", "confined compression"});
  describe_columns(v, s);
  describe_specimen(v, s.size);
  v.number(s.weight, {"weight", "of the residuals of this test", kOptional, kPositive});
  v.flag(s.offset,
         {"offset", "whether a constant stress, an error of the zero, is fitted as well"});
  v.flag(s.clamped, {"clamped",
                     "whether glued clamps or plates hold both ends: the specimen is computed by "
                     "finite elements"});
}

namespace {

struct LawSection {
  std::string law, weighting = "per test", residual = "nominal";
  double poisson = calibrate::kCasePoisson, confidence = 0.95;
};

struct ConstantSection {
  std::string name, start, low, high;
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
void describe(V& v, FitDocument& d) {
  v.text(d.name, {"name", "of the material", kRequired});
  v.text(d.source, {"source", "of the data", kRequired});
  v.text(d.licence, {"licence", "of the data", kRequired});
  v.text(d.description, {"description", "anything else"});
  v.section("fit", d.law, kRequired, "[fit], the law whose constants are identified");
  v.sections("constant", d.constants, kOptional, "");
  v.sections("test", d.tests, kRequired, "[[test]], a record and how it was tested");
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

/// The specimen of a clamped test.
std::optional<fem::ClampedSpecimen> specimen_of(const TestSection& s, const std::string& where) {
  if (!s.clamped) return std::nullopt;
  if (s.mode != "uniaxial" && s.mode != "pure shear")
    refuse(where, "a clamped specimen is not in " + s.mode,
           "choose the mode uniaxial or pure shear, or leave `clamped` out");
  if (s.offset)
    refuse(where, "an offset is not fitted to a clamped specimen", "leave `offset` out");
  const SpecimenSize& size = s.size;
  const bool round = std::isfinite(size.diameter);
  if (!std::isfinite(size.gauge_length) ||
      !(round || (std::isfinite(size.width) && std::isfinite(size.thickness))))
    refuse(where, "the shape of the clamped specimen is not known",
           "give gauge_length, and width and thickness or a diameter");
  fem::ClampedSpecimen specimen;
  specimen.length = size.gauge_length;
  if (round) specimen.diameter = size.diameter;
  if (!round) specimen.width = size.width;
  if (!round) specimen.thickness = size.thickness;
  return specimen;
}

calibrate::Weighting weighting_of(const std::string& text) {
  if (text == "absolute") return calibrate::Weighting::Absolute;
  if (text == "relative") return calibrate::Weighting::Relative;
  if (text == "uncertainty") return calibrate::Weighting::Uncertainty;
  return calibrate::Weighting::PerTest;
}

}  // namespace

FitFile read_fit_file(const std::filesystem::path& path) {
  const toml::table table = read_toml(path, "the fit file");
  SourceMap sources(path.string());
  FitDocument document;
  TableReader reader(table, "the fit file", "", sources);
  describe(reader, document);
  reader.finish();
  FitFile fit{document.name, document.source, document.licence, {}, {}, {}, {}, {}};
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
    for (const std::string& file : {test.file, test.stress_file})
      if (!file.empty()) fit.files.push_back(path.parent_path() / file);
    const std::string where = sources.where(fmt::format("test[{}].", i));
    fit.specimens.push_back(specimen_of(test, where));
    SpecimenTest specimen = read_test(test, path.parent_path(), where);
    fit.tests.push_back(std::move(specimen.test));
    fit.statements.push_back(std::move(specimen.statement));
  }
  return fit;
}

}  // namespace palpate::app
