// SPDX-License-Identifier: Apache-2.0
// palpate.Recording: recording.h5, or the journal of a session.
#include "format/recording.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "format/session_journal.hpp"
#include "python/arrays.hpp"
#include "python/artifacts.hpp"
#include "python/errors.hpp"

namespace py = pybind11;

namespace palpate::python {
namespace {

struct RecordingObject : Recording {
  std::vector<std::string> gaps;  ///< damage of a journal
};

RecordingObject read_whole(const std::filesystem::path& path) {
  return {palpate::read_recording(path), {}};
}

RecordingObject read_journal(const std::filesystem::path& path) {
  SessionJournalReader journal(path);
  RecordingObject made;
  static_cast<RecordingHeading&>(made) = journal.heading();
  for (std::vector<RecordedStep> steps; journal.next(steps);)
    made.steps.insert(made.steps.end(), steps.begin(), steps.end());
  for (const JournalGap& gap : journal.gaps()) made.gaps.push_back(gap_text(gap));
  return made;
}

RecordingObject read_recording(const std::filesystem::path& path) {
  return read_file(path, "a recording (recording.h5)", &read_whole);
}

RecordingObject read_session(const std::filesystem::path& path) {
  return read_file(path, "a recording or the journal of a session", [](const auto& file) {
    return is_session_journal(file) ? read_journal(file) : read_whole(file);
  });
}

py::array_t<double> times(const RecordingObject& recording) {
  py::array_t<double> seconds(static_cast<py::ssize_t>(recording.steps.size()));
  std::transform(recording.steps.begin(), recording.steps.end(), seconds.mutable_data(),
                 [](const RecordedStep& step) { return 1e-9 * static_cast<double>(step.time_ns); });
  return seconds;
}

template <class Field>
auto of_steps(Field RecordedStep::*field) {
  return column_of<RecordingObject>(&Recording::steps, field);
}

template <class Value>
auto of_settings(Value SessionSettings::*field) {
  return [field](const RecordingObject& recording) { return recording.settings.*field; };
}

std::string recording_text(const RecordingObject& recording) {
  return "<palpate.Recording: " + std::to_string(recording.steps.size()) + " steps on " +
         recording.device + ">";
}

using Class = py::class_<RecordingObject>;

void define_columns(Class& recording) {
  recording.def("__len__", [](const RecordingObject& r) { return r.steps.size(); })
      .def_property_readonly("time", &times, "(N,) s, since the start of the session; a copy.")
      .def_property_readonly("time_ns", of_steps(&RecordedStep::time_ns),
                             "(N,) int64, ns, the same.")
      .def_property_readonly("position", of_steps(&RecordedStep::position),
                             "(N, 3) m, tip of the tool.")
      .def_property_readonly("velocity", of_steps(&RecordedStep::velocity), "(N, 3) m/s.")
      .def_property_readonly("force", of_steps(&RecordedStep::force),
                             "(N, 3) N, commanded to the device.")
      .def_property_readonly("contact_point", of_steps(&RecordedStep::contact_point), "(N, 3) m.")
      .def_property_readonly("depth", of_steps(&RecordedStep::depth), "(N,) m.")
      .def_property_readonly("lateral", of_steps(&RecordedStep::lateral),
                             "(N,) m, lateral deflection.")
      .def_property_readonly("offset", of_steps(&RecordedStep::offset), "(N,) m, depth offset.")
      .def_property_readonly("energy", of_steps(&RecordedStep::energy),
                             "(N,) J, stored in the body.")
      .def_property_readonly("tank", of_steps(&RecordedStep::tank), "(N,) J, energy tank.")
      .def_property_readonly("absorbed", of_steps(&RecordedStep::absorbed),
                             "(N,) J, net work of the tool.")
      .def_property_readonly("element", of_steps(&RecordedStep::element),
                             "(N,) int32, triangle; -1: none.")
      .def_property_readonly("status", of_steps(&RecordedStep::status),
                             "(N,) uint32, bits of Status.")
      .def_property_readonly("latency_ns", of_steps(&RecordedStep::latency_ns),
                             "(N,) int64, ns, of each step.");
}

void define_heading(Class& recording) {
  recording.def_readonly("device", &RecordingObject::device, "Name of the device.")
      .def_readonly("library_sha256", &RecordingObject::library_sha256, "Of the library.")
      .def_readonly("rate", &RecordingObject::rate, "Hz; 0: not constant.")
      .def_readonly("friction", &RecordingObject::friction, "Friction coefficient of the state.")
      .def_property_readonly("tank_cap", of_settings(&SessionSettings::tank_cap),
                             "J, of the state.")
      .def_property_readonly("lipschitz_bound", of_settings(&SessionSettings::lipschitz_bound),
                             "N/m, of the state; may be infinite.")
      .def_property_readonly("search_rate", of_settings(&SessionSettings::search_rate),
                             "Hz; 0: each step searched the body itself.")
      .def_property_readonly(
          "body_position",
          [](const py::object& self) {
            return view_of_row(self, self.cast<const RecordingObject&>().settings.body_position);
          },
          "(3,) m, of the body in the frame of the device.")
      .def_property_readonly("guarded", of_settings(&SessionSettings::guarded),
                             "Whether the safety functions of a force loop acted on the forces.")
      .def_property_readonly("ramp", of_settings(&SessionSettings::ramp), "s, of the force loop.")
      .def_property_readonly("watchdog", of_settings(&SessionSettings::watchdog),
                             "s, of the force loop.")
      .def_property_readonly("max_force", of_settings(&SessionSettings::max_force),
                             "N, of the force loop.")
      .def_property_readonly("max_speed", of_settings(&SessionSettings::max_speed),
                             "m/s, of the force loop.")
      .def_readonly("gaps", &RecordingObject::gaps,
                    "Damage of a journal, a line each; empty for a recording that was completed.")
      .def_property_readonly(
          "provenance",
          [](const py::object& self) {
            return references(self, self.cast<const RecordingObject&>().provenance.steps);
          },
          kProvenanceText);
}

}  // namespace

void define_recording(py::module_& module) {
  Class recording(module, "Recording",
                  "Every step of a session, one row a step; made by read_recording or "
                  "read_session. Arrays are\n"
                  "read-only views with strides.");
  define_columns(recording);
  define_heading(recording);
  recording.def("__repr__", &recording_text);
  module.def(
      "read_recording", &read_recording, py::arg("path"),
      "read_recording(path) -> Recording\n\n"
      "Reads and checks recording.h5, about 170 bytes a step. Raises FileError or FormatError.");
  module.def("read_session", &read_session, py::arg("path"),
             "read_session(path) -> Recording\n\n"
             "The same, also of the journal of a session that did not end; Recording.gaps says "
             "what it lost.");
}

}  // namespace palpate::python
