// SPDX-License-Identifier: Apache-2.0
// palpate.ProvenanceStep.
#include <pybind11/pybind11.h>

#include "format/provenance.hpp"
#include "python/artifacts.hpp"

namespace py = pybind11;

namespace palpate::python {

void define_provenance(py::module_& module) {
  py::class_<ProvenanceStep>(module, "ProvenanceStep", "A stage of the pipeline, as it was run.")
      .def_readonly("stage", &ProvenanceStep::stage,
                    "\"mesh\", \"precompute\", \"fit\", \"certify\", ...")
      .def_readonly("version", &ProvenanceStep::version, "Version of palpate.")
      .def_readonly("git_revision", &ProvenanceStep::git_revision, "Of the build.")
      .def_readonly("utc", &ProvenanceStep::utc, "When the stage ended, ISO 8601.")
      .def_readonly("resolved_case", &ProvenanceStep::resolved_case,
                    "The case as understood, with every default, as TOML.")
      .def_property_readonly(
          "inputs",
          [](const ProvenanceStep& step) {
            py::dict inputs;
            for (const InputDigest& input : step.inputs) inputs[py::str(input.name)] = input.sha256;
            return inputs;
          },
          "SHA-256 of each input file, by its name.")
      .def_property_readonly(
          "facts",
          [](const ProvenanceStep& step) {
            py::dict facts;
            for (const auto& [name, value] : step.facts) facts[py::str(name)] = value;
            return facts;
          },
          "Versions of libraries and the like, by name.");
}

}  // namespace palpate::python
