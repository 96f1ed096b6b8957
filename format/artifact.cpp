// SPDX-License-Identifier: Apache-2.0
#include "format/artifact.hpp"

#include "format/flat_file.hpp"

namespace palpate {
namespace {

void write_step(hdf5::Writer& writer, const std::string& group, const ProvenanceStep& step) {
  writer.group(group, "One stage of the pipeline, as it was run.");
  writer.set_text(group, "stage", step.stage);
  writer.set_text(group, "version", step.version);
  writer.set_text(group, "git_revision", step.git_revision);
  writer.set_text(group, "utc", step.utc);
  writer.set_text(group, "resolved_case", step.resolved_case);
  std::vector<std::string> names, values;
  for (const InputDigest& input : step.inputs) {
    names.push_back(input.name);
    values.push_back(input.sha256);
  }
  writer.set_texts(group, "input_name", names);
  writer.set_texts(group, "input_sha256", values);
  names.clear(), values.clear();
  for (const auto& [name, value] : step.facts) {
    names.push_back(name);
    values.push_back(value);
  }
  writer.set_texts(group, "fact_name", names);
  writer.set_texts(group, "fact_value", values);
}

ProvenanceStep read_step(const hdf5::Reader& reader, const std::string& group) {
  ProvenanceStep step;
  step.stage = reader.text(group, "stage");
  step.version = reader.text(group, "version");
  step.git_revision = reader.text(group, "git_revision");
  step.utc = reader.text(group, "utc");
  step.resolved_case = reader.text(group, "resolved_case");
  const std::vector<std::string> inputs = reader.text_list(group, "input_name");
  const std::vector<std::string> digests = reader.text_list(group, "input_sha256");
  const std::vector<std::string> facts = reader.text_list(group, "fact_name");
  const std::vector<std::string> values = reader.text_list(group, "fact_value");
  if (inputs.size() != digests.size()) {
    reader.fail(group, "input_name and input_sha256 differ in length");
  }
  if (facts.size() != values.size()) {
    reader.fail(group, "fact_name and fact_value differ in length");
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) step.inputs.push_back({inputs[i], digests[i]});
  for (std::size_t i = 0; i < facts.size(); ++i) step.facts.emplace_back(facts[i], values[i]);
  return step;
}

}  // namespace

std::string artifact_kind(const std::filesystem::path& file, const std::string& remedy) {
  if (is_flat_file(file)) return "palpate.library";
  return hdf5::Reader(file, remedy).text("/", "artifact");
}

std::int64_t schema_of_file(const std::filesystem::path& file, const std::string& remedy) {
  if (is_flat_file(file)) return version_of_flat_file(file);
  return hdf5::Reader(file, remedy).integer("/", "schema");
}

void write_root(hdf5::Writer& writer, const std::string& artifact, int schema,
                const std::string& description) {
  writer.set_text("/", "artifact", artifact);
  writer.set_integer("/", "schema", schema);
  writer.set_text("/", "description", description);
  writer.set_text("/", "creator", creator_text());
}

void write_provenance(hdf5::Writer& writer, const Provenance& provenance) {
  writer.group("/provenance", "Every stage the artifact has been through, oldest first.");
  for (std::size_t i = 0; i < provenance.steps.size(); ++i) {
    write_step(writer, provenance_group(i, provenance.steps[i].stage), provenance.steps[i]);
  }
}

Provenance read_provenance(const hdf5::Reader& reader) {
  Provenance provenance;
  for (const std::string& name : reader.children("/provenance")) {
    const std::string group = "/provenance/" + name;
    ProvenanceStep step = read_step(reader, group);
    if (group != provenance_group(provenance.steps.size(), step.stage)) {
      reader.fail(group, "is out of order: <two digits>_<stage> expected, counted from 00");
    }
    provenance.steps.push_back(std::move(step));
  }
  check_provenance(Checks(reader), provenance);
  return provenance;
}

}  // namespace palpate
