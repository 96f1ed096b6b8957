// SPDX-License-Identifier: Apache-2.0
#include "format/recording.hpp"

#include <array>
#include <cmath>
#include <string>

#include "format/artifact.hpp"
#include "format/columns.hpp"

namespace palpate {
namespace {

constexpr const char* kArtifact = "palpate.recording";
constexpr const char* kRemedy = "record it again with 'palpate run'";

// What the device told is kept as it was, NaN included: a faulty reading is worth replaying. What
// palpate answered must be finite.
constexpr auto kStepColumns = std::make_tuple(
    column("time", &RecordedStep::time_ns, "ns", "Since the start of the session, not decreasing.",
           rules::kNonNegative),
    column("position", &RecordedStep::position, "m", "Tool tip, as the device told it.",
           rules::kAnything),
    column("velocity", &RecordedStep::velocity, "m/s", "Of the tool tip, as the device told it.",
           rules::kAnything),
    column("force", &RecordedStep::force, "N", "Commanded to the device.", rules::kFinite),
    column("contact_point", &RecordedStep::contact_point, "m",
           "Point of initial contact c on the undeformed surface.", rules::kFinite),
    column("depth", &RecordedStep::depth, "m", "Normal deflection delta^z.", rules::kFinite),
    column("lateral", &RecordedStep::lateral, "m", "Lateral deflection delta^r.", rules::kFinite),
    column("offset", &RecordedStep::offset, "m", "Offset d0 along the normal.", rules::kFinite),
    column("energy", &RecordedStep::energy, "J", "Stored in the active local model.",
           rules::kFinite),
    column("tank", &RecordedStep::tank, "J", "Energy tank of the sliding rule.", rules::kFinite),
    column("absorbed", &RecordedStep::absorbed, "J",
           "Net work of the tool on the virtual body since the start.", rules::kFinite),
    column("element", &RecordedStep::element, "1", "Active triangle, -1 without contact.",
           Rule{-1, rules::kLargest, false, false, "-1 or a triangle"}),
    column("status", &RecordedStep::status, "1", "Status bits of the step, as in palpate.h.",
           rules::kNonNegative),
    column("latency", &RecordedStep::latency_ns, "ns", "Compute time of the step.",
           rules::kNonNegative));

constexpr std::array<const char*, 3> kAxes{"body_x", "body_y", "body_z"};

/// The settings that are numbers, with their names in the file.
template <class Settings, class Visit>
void visit_numbers(Settings& s, Visit&& visit) {
  visit("tank_cap", s.tank_cap);
  visit("steepness", s.steepness);
  visit("search_rate", s.search_rate);
  visit("ramp", s.ramp);
  visit("watchdog", s.watchdog);
  visit("max_force", s.max_force);
  visit("max_speed", s.max_speed);
}

void write_settings(hdf5::Writer& writer, const SessionSettings& settings) {
  writer.group("/settings", "What the forces depend on besides the library and the motion.");
  visit_numbers(settings,
                [&](const char* name, double value) { writer.set_real("/settings", name, value); });
  for (std::size_t i = 0; i < 3; ++i)
    writer.set_real("/settings", kAxes[i], settings.body_position[i]);
  writer.set_integer("/settings", "guarded", settings.guarded ? 1 : 0);
}

SessionSettings read_settings(const hdf5::Reader& reader) {
  SessionSettings settings;
  visit_numbers(settings,
                [&](const char* name, double& value) { value = reader.real("/settings", name); });
  for (std::size_t i = 0; i < 3; ++i)
    settings.body_position[i] = reader.real("/settings", kAxes[i]);
  settings.guarded = reader.integer("/settings", "guarded") != 0;
  return settings;
}

void check_settings(const Checks& checks, const SessionSettings& settings) {
  visit_numbers(settings, [&](const char* name, double value) {
    if (!(value >= 0)) checks.fail(std::string("/settings@") + name, "is negative or no number");
  });
  for (std::size_t i = 0; i < 3; ++i)
    if (!std::isfinite(settings.body_position[i]))
      checks.fail(std::string("/settings@") + kAxes[i], "is not finite");
}

void check_recording(const Checks& checks, const Recording& recording) {
  const auto check = [&](const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0)) checks.fail(name, "is not finite and not negative");
  };
  check("/@rate", recording.rate);
  check("/@friction", recording.friction);
  checks.digest("/@library_sha256", recording.library_sha256, true);
  check_settings(checks, recording.settings);
  check_columns(checks, "/step", recording.steps, kStepColumns);
  for (std::size_t row = 1; row < recording.steps.size(); ++row) {
    if (recording.steps[row].time_ns < recording.steps[row - 1].time_ns) {
      checks.fail_row("/step/time", row, "goes backwards");
    }
  }
  check_provenance(checks, recording.provenance);
}

}  // namespace

void write_recording(const std::filesystem::path& path, const Recording& recording) {
  check_recording(Checks(path), recording);
  hdf5::Writer writer(path);
  write_root(writer, kArtifact, kRecordingSchema, "Every step of a haptic session.");
  writer.set_text("/", "device", recording.device);
  writer.set_text("/", "library_sha256", recording.library_sha256);
  writer.set_real("/", "rate", recording.rate);
  writer.set_real("/", "friction", recording.friction);
  write_settings(writer, recording.settings);
  writer.group("/step", "One row for each step of the force loop.");
  write_columns(writer, "/step", recording.steps, kStepColumns, hdf5::Storage::Deflated);
  write_provenance(writer, recording.provenance);
  writer.commit();
}

Recording read_recording(const std::filesystem::path& path) {
  hdf5::Reader reader(path, kRemedy);
  reader.require_artifact(kArtifact, kRecordingSchema);
  Recording recording;
  recording.device = reader.text("/", "device");
  recording.library_sha256 = reader.text("/", "library_sha256");
  recording.rate = reader.real("/", "rate");
  recording.friction = reader.real("/", "friction");
  recording.settings = read_settings(reader);
  recording.steps = read_columns(reader, "/step", kStepColumns);
  recording.provenance = read_provenance(reader);
  check_recording(Checks(reader), recording);
  return recording;
}

}  // namespace palpate
