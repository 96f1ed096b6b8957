// SPDX-License-Identifier: Apache-2.0
#include "format/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "format/artifact.hpp"
#include "format/columns.hpp"

namespace palpate {
namespace {

constexpr const char* kRecordingArtifact = "palpate.recording";
constexpr const char* kRecordingRemedy = "record it again with 'palpate run'";

// The readings of the device are stored unchanged, NaN included, so that a faulty reading can be
// replayed. What
// palpate answered must be finite.
constexpr auto kStepColumns = std::make_tuple(
    column("time", &RecordedStep::time_ns, "ns", "Since the start of the session, not decreasing.",
           rules::kNonNegative),
    column("position", &RecordedStep::position, "m", "Tool tip, as read from the device.",
           rules::kAnything),
    column("velocity", &RecordedStep::velocity, "m/s", "Of the tool tip, as read from the device.",
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
  visit("lipschitz_bound", s.lipschitz_bound);
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

void check_heading(const Checks& checks, const RecordingHeading& heading) {
  const auto check = [&](const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0)) checks.fail(name, "is not finite and not negative");
  };
  check("/@rate", heading.rate);
  check("/@friction", heading.friction);
  checks.digest("/@library_sha256", heading.library_sha256, true);
  check_settings(checks, heading.settings);
  check_provenance(checks, heading.provenance);
}

/// `before`: the time of the step before the first of these, which is step `first`.
void check_steps(const Checks& checks, const std::vector<RecordedStep>& steps, std::int64_t before,
                 std::size_t first) {
  check_columns(checks, "/step", steps, kStepColumns, first);
  for (std::size_t row = 0; row < steps.size(); ++row) {
    if (steps[row].time_ns < before) checks.fail_row("/step/time", first + row, "goes backwards");
    before = steps[row].time_ns;
  }
}

void write_heading(hdf5::Writer& writer, const RecordingHeading& heading) {
  write_root(writer, kRecordingArtifact, kRecordingSchema, "Every step of a haptic session.");
  writer.set_text("/", "device", heading.device);
  writer.set_text("/", "library_sha256", heading.library_sha256);
  writer.set_real("/", "rate", heading.rate);
  writer.set_real("/", "friction", heading.friction);
  write_settings(writer, heading.settings);
  write_provenance(writer, heading.provenance);
}

/// No recording needs more: HDF5 stores a chunk that does not deflate as it is, and chunks whole.
hdf5::OnDisk room_for(const RecordingHeading& heading, std::uint64_t steps) {
  constexpr std::uint64_t kMetadata = 131072, kChunkEntries = 16384;  // bytes
  constexpr std::uint64_t kStepBytes = sizeof(RecordedStep);
  std::uint64_t texts = 0;
  for (const ProvenanceStep& step : heading.provenance.steps)
    texts += 4096 + 2 * step.resolved_case.size() + 256 * (step.inputs.size() + step.facts.size());
  const std::uint64_t chunks = (steps + hdf5::kChunkRows - 1) / hdf5::kChunkRows;
  const std::uint64_t rows = steps < hdf5::kChunkRows ? steps : chunks * hdf5::kChunkRows;
  return {kMetadata + texts + chunks * kChunkEntries + rows * kStepBytes};
}

}  // namespace

struct RecordingWriter::State {
  State(const std::filesystem::path& path, const RecordingHeading& heading, std::uint64_t steps)
      : checks(path), writer(path, room_for(heading, steps)) {}

  void write_waiting() {
    append_columns(writer, "/step", waiting, kStepColumns);
    waiting.clear();
  }

  Checks checks;
  hdf5::Writer writer;
  std::vector<RecordedStep> waiting;  ///< less than a chunk: each chunk is written whole
  std::int64_t last_time = 0;
  std::size_t appended = 0;
};

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const RecordingHeading& heading,
                                 std::uint64_t steps) {
  check_heading(Checks(path), heading);
  state_ = std::make_unique<State>(path, heading, steps);
  write_heading(state_->writer, heading);
  state_->writer.group("/step", "One row for each step of the force loop.");
  begin_columns(state_->writer, "/step", steps, kStepColumns);
}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::append(const std::vector<RecordedStep>& steps) {
  check_steps(state_->checks, steps, state_->last_time, state_->appended);
  state_->appended += steps.size();
  if (!steps.empty()) state_->last_time = steps.back().time_ns;
  for (const RecordedStep& step : steps) {
    state_->waiting.push_back(step);
    if (state_->waiting.size() == hdf5::kChunkRows) state_->write_waiting();
  }
}

void RecordingWriter::commit() {
  state_->write_waiting();
  state_->writer.commit();
}

void write_recording(const std::filesystem::path& path, const Recording& recording) {
  RecordingWriter writer(path, recording, recording.steps.size());
  writer.append(recording.steps);
  writer.commit();
}

struct RecordingReader::State {
  explicit State(const std::filesystem::path& path) : reader(path, kRecordingRemedy) {
    reader.require_artifact(kRecordingArtifact, {kRecordingSchema});
    heading.device = reader.text("/", "device");
    heading.library_sha256 = reader.text("/", "library_sha256");
    heading.rate = reader.real("/", "rate");
    heading.friction = reader.real("/", "friction");
    heading.settings = read_settings(reader);
    heading.provenance = read_provenance(reader);
    check_heading(Checks(reader), heading);
    rows = rows_of_columns(reader, "/step", kStepColumns);
  }

  hdf5::Reader reader;
  RecordingHeading heading;
  std::size_t rows = 0, read = 0;
  std::int64_t last_time = 0;
};

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : state_(std::make_unique<State>(path)) {}

RecordingReader::~RecordingReader() = default;

const RecordingHeading& RecordingReader::heading() const noexcept {
  return state_->heading;
}

std::uint64_t RecordingReader::steps() const noexcept {
  return state_->rows;
}

std::vector<RecordedStep> RecordingReader::next() {
  State& s = *state_;
  const std::size_t count = std::min<std::size_t>(hdf5::kChunkRows, s.rows - s.read);
  std::vector<RecordedStep> steps = read_rows(s.reader, "/step", kStepColumns, s.read, count);
  check_steps(Checks(s.reader), steps, s.last_time, s.read);
  s.read += count;
  if (!steps.empty()) s.last_time = steps.back().time_ns;
  return steps;
}

Recording read_recording(const std::filesystem::path& path) {
  RecordingReader reader(path);
  Recording recording{reader.heading(), {}};
  recording.steps.reserve(reader.steps());
  for (auto steps = reader.next(); !steps.empty(); steps = reader.next())
    recording.steps.insert(recording.steps.end(), steps.begin(), steps.end());
  return recording;
}

}  // namespace palpate
