// SPDX-License-Identifier: Apache-2.0
#include "format/flat_library.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/flat_file.hpp"
#include "format/library_checks.hpp"
#include "format/library_columns.hpp"

namespace palpate {
namespace {

constexpr const char* kRemedy = "make it again with 'palpate export runtime'";

template <class Record, class... Fields>
void put_columns(FlatWriter& writer, const std::string& group, const std::vector<Record>& records,
                 const std::tuple<Column<Record, Fields>...>& columns) {
  const auto put_one = [&]<class Field>(const Column<Record, Field>& column) {
    std::vector<Stored<Field>> values;
    values.reserve(records.size());
    for (const Record& record : records)
      values.push_back(static_cast<Stored<Field>>(record.*column.member));
    writer.array(group + "/" + column.name, values);
  };
  std::apply([&](const auto&... column) { (put_one(column), ...); }, columns);
}

/// Checks each column before it enters a record: an enumeration never holds an unknown value.
template <class Record, class... Fields>
std::vector<Record> get_columns(const FlatReader& reader, const std::string& group,
                                const std::tuple<Column<Record, Fields>...>& columns,
                                std::size_t rows = flat::kAnyRows) {
  const Checks checks(reader);
  std::vector<Record> records;
  bool sized = false;
  const auto get_one = [&]<class Field>(const Column<Record, Field>& column) {
    const std::string name = group + "/" + column.name;
    const auto values = reader.array<Stored<Field>>(name, sized ? records.size() : rows);
    check_column(checks, group, values, column);
    if (!sized) records.resize(values.size());
    sized = true;
    for (std::size_t row = 0; row < values.size(); ++row)
      records[row].*column.member = static_cast<Field>(values[row]);
  };
  std::apply([&](const auto&... column) { (get_one(column), ...); }, columns);
  return records;
}

void put_curves(FlatWriter& writer, const std::string& stem,
                const std::vector<NodeResponse>& responses, CurveMember which) {
  const FlatCurves curves = flatten(responses, which);
  writer.array(stem + "offset", curves.offset);
  writer.array(stem + "knot", curves.knot);
  writer.array(stem + "slope", curves.slope);
}

void get_curves(const FlatReader& reader, const std::string& stem,
                std::vector<NodeResponse>& responses, CurveMember which) {
  FlatCurves curves;
  curves.offset = reader.array<std::int64_t>(stem + "offset", responses.size() + 1);
  curves.knot = reader.array<float>(stem + "knot");
  curves.slope = reader.array<float>(stem + "slope", curves.knot.size());
  check_curves(Checks(reader), stem, curves, responses);
  unflatten(curves, which, responses);
}

void put_certificate(FlatWriter& writer, const Certificate& c) {
  writer.array("/certificate/bounds",
               std::vector<double>{c.friction, c.depth, c.stick, c.slip, c.min_lipschitz_bound,
                                   c.lipschitz_bound});
  writer.array("/certificate/counts",
               std::vector<std::int32_t>{c.worst_triangle, c.holes, c.interpolated});
  writer.texts("/certificate/words", {c.limited_by, c.basis});
  put_columns(writer, "/certificate/triangle", c.triangles, kTriangleColumns);
  put_columns(writer, "/certificate/device", c.devices, kDeviceColumns);
  std::vector<std::string> names;
  for (const DeviceCertificate& device : c.devices) names.push_back(device.device);
  writer.texts("/certificate/device/name", names);
}

Certificate get_certificate(const FlatReader& reader) {
  Certificate c;
  const auto bounds = reader.array<double>("/certificate/bounds", 6);
  c.friction = bounds[0];
  c.depth = bounds[1];
  c.stick = bounds[2];
  c.slip = bounds[3];
  c.min_lipschitz_bound = bounds[4];
  c.lipschitz_bound = bounds[5];
  const auto counts = reader.array<std::int32_t>("/certificate/counts", 3);
  c.worst_triangle = counts[0];
  c.holes = counts[1];
  c.interpolated = counts[2];
  const auto words = reader.texts("/certificate/words", 2);
  c.limited_by = words[0];
  c.basis = words[1];
  c.triangles = get_columns(reader, "/certificate/triangle", kTriangleColumns);
  c.devices = get_columns(reader, "/certificate/device", kDeviceColumns);
  const auto names = reader.texts("/certificate/device/name", c.devices.size());
  for (std::size_t i = 0; i < names.size(); ++i) c.devices[i].device = names[i];
  return c;
}

/// Names and values of pairs of texts, one after the other.
template <class Pairs>
std::vector<std::string> pairs_in_line(const Pairs& pairs) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : pairs) {
    texts.push_back(name);
    texts.push_back(value);
  }
  return texts;
}

std::string step_name(std::size_t step, const char* what) {
  return "/provenance/" + std::to_string(step) + "/" + what;
}

void put_provenance(FlatWriter& writer, const Provenance& provenance) {
  const auto& steps = provenance.steps;
  writer.array("/provenance/steps",
               std::vector<std::int32_t>{static_cast<std::int32_t>(steps.size())});
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const ProvenanceStep& s = steps[i];
    writer.texts(step_name(i, "run"), {s.stage, s.version, s.git_revision, s.utc, s.resolved_case});
    writer.texts(step_name(i, "inputs"), pairs_in_line(s.inputs));
    writer.texts(step_name(i, "facts"), pairs_in_line(s.facts));
  }
}

/// An even number of texts, name and value in turn.
std::vector<std::string> get_pairs(const FlatReader& reader, const std::string& name) {
  std::vector<std::string> texts = reader.texts(name);
  if (texts.size() % 2 != 0) reader.fail(name, "has a name without a value");
  return texts;
}

Provenance get_provenance(const FlatReader& reader) {
  Provenance provenance;
  const std::int32_t steps = reader.array<std::int32_t>("/provenance/steps", 1).front();
  for (std::size_t i = 0; static_cast<std::int64_t>(i) < steps; ++i) {
    const auto run = reader.texts(step_name(i, "run"), 5);
    ProvenanceStep step{run[0], run[1], run[2], run[3], run[4], {}, {}};
    const auto inputs = get_pairs(reader, step_name(i, "inputs"));
    for (std::size_t k = 0; k < inputs.size(); k += 2)
      step.inputs.push_back({inputs[k], inputs[k + 1]});
    const auto facts = get_pairs(reader, step_name(i, "facts"));
    for (std::size_t k = 0; k < facts.size(); k += 2)
      step.facts.emplace_back(facts[k], facts[k + 1]);
    provenance.steps.push_back(std::move(step));
  }
  check_provenance(Checks(reader), provenance);
  return provenance;
}

void get_responses(const FlatReader& reader, Library& library) {
  library.responses = get_columns(reader, "/response", kResponseColumns, library.positions.size());
  get_curves(reader, "/response/normal_", library.responses, normal_of);
  get_curves(reader, "/response/lateral_", library.responses, lateral_of);
  if (library.kind == ResponseKind::Decoupled) return;
  get_curves(reader, "/response/coupling_", library.responses, coupling_of);
  const auto bases = reader.array<float>("/response/coupling_base", library.responses.size());
  Checks(reader).numbers("/response/coupling_base", bases, rules::kPositive);
  for (std::size_t v = 0; v < bases.size(); ++v) library.responses[v].coupling.base = bases[v];
}

std::uint32_t version_of(const Library& library) {
  const bool coupled = library.kind == ResponseKind::Coupled, leans = library.leans();
  if (library.has_soft_axes()) return kLatestFlatVersion;
  if (coupled && leans) return kLeaningFlatVersion;
  if (coupled || leans) return kGrippingFlatVersion;
  return library.relaxes() ? kRelaxingFlatVersion : kFlatVersion;
}

}  // namespace

std::string flat_bytes(const Library& library, const std::filesystem::path& target) {
  check_for_writing(Checks(target), library);
  FlatWriter writer(version_of(library));
  const bool coupled = library.kind == ResponseKind::Coupled;
  writer.texts("/words", {library.name, library.tool_shape});
  writer.array("/coupled", std::vector<std::uint8_t>{coupled});
  writer.number("/tool_radius", library.tool_radius);
  writer.array("/surface/position", library.positions);
  writer.array("/surface/inward", library.inward);
  writer.array("/surface/triangles", library.triangles);
  put_columns(writer, "/response", library.responses, kResponseColumns);
  put_curves(writer, "/response/normal_", library.responses, normal_of);
  put_curves(writer, "/response/lateral_", library.responses, lateral_of);
  if (coupled) {
    put_curves(writer, "/response/coupling_", library.responses, coupling_of);
    writer.array("/response/coupling_base", coupling_bases(library.responses));
  }
  if (library.relaxes()) {
    writer.array("/relaxation/time", library.relaxation_times);
    writer.array("/response/relaxation_fraction", relaxation_fractions(library));
    writer.number("/certificate/relaxation_rate", library.certificate.relaxation_rate);
  }
  if (library.leans()) writer.array(kLeans.name, rows_of(library.responses, kLeans));
  if (library.has_soft_axes()) writer.array(kSoftAxes.name, rows_of(library.responses, kSoftAxes));
  put_certificate(writer, library.certificate);
  put_provenance(writer, library.provenance);
  return writer.file();
}

void write_flat_library(const std::filesystem::path& path, const Library& library) {
  write_file_crash_safely(path, flat_bytes(library, path));
}

Library read_flat_library(std::string_view bytes, const std::filesystem::path& file) {
  const FlatReader reader(bytes, file, kRemedy);
  const Checks checks(reader);
  Library library;
  const auto words = reader.texts("/words", 2);
  library.name = words[0];
  library.tool_shape = words[1];
  const auto coupled = reader.array<std::uint8_t>("/coupled", 1);
  checks.numbers("/coupled", coupled, rules::kFlag);
  if (coupled.front() == 1 && reader.version() < kGrippingFlatVersion)
    reader.fail("/coupled", kFormerCoupled);
  if (coupled.front() == 1 && reader.version() < kLeaningFlatVersion && reader.has(kLeans.name))
    reader.fail(kLeans.name, kFormerLean);
  if (coupled.front() == 1) library.kind = ResponseKind::Coupled;
  library.tool_radius = reader.number("/tool_radius");
  library.positions = reader.array<Vec3>("/surface/position");
  library.inward = reader.array<Vec3>("/surface/inward", library.positions.size());
  library.triangles = reader.array<Triangle>("/surface/triangles");
  get_responses(reader, library);
  library.certificate = get_certificate(reader);
  if (reader.has("/relaxation/time")) {
    library.certificate.relaxation_rate = reader.number("/certificate/relaxation_rate");
    library.relaxation_times = reader.array<double>("/relaxation/time");
    const auto fractions = reader.array<float>("/response/relaxation_fraction");
    check_relaxation(checks, library, fractions);
    set_relaxation_fractions(fractions, library);
  }
  if (reader.has(kSoftAxes.name) && library.kind == ResponseKind::Decoupled)
    reader.fail(kSoftAxes.name, kSoftAndDecoupled);
  for (const NodeVector& vector : {kLeans, kSoftAxes})
    if (reader.has(vector.name))
      set_rows(checks, reader.array<std::array<float, 3>>(vector.name), vector, library);
  library.provenance = get_provenance(reader);
  check_library(checks, library);
  return library;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) refuse(file.string(), "cannot be read", "check path and permissions");
  return content;
}

}  // namespace palpate
