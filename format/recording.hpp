// SPDX-License-Identifier: Apache-2.0
// recording.h5: every step of a haptic session. Normative page: format/schema/recording.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "format/provenance.hpp"
#include "format/vec3.hpp"

namespace palpate {

inline constexpr int kRecordingSchema = 2;

struct RecordedStep {
  std::int64_t time_ns = 0;  ///< since the start of the session
  Vec3 position{};           ///< m, tool tip
  Vec3 velocity{};           ///< m/s
  Vec3 force{};              ///< N, commanded to the device
  Vec3 contact_point{};      ///< m
  double depth = 0;          ///< m, delta^z
  double lateral = 0;        ///< m, delta^r
  double offset = 0;         ///< m, d0
  double energy = 0;         ///< J, stored in the active local model
  double tank = 0;           ///< J
  double absorbed = 0;       ///< J, net work of the tool on the virtual body since the start
  std::int32_t element = -1;
  std::uint32_t status = 0;     ///< bits of palpate.h
  std::int64_t latency_ns = 0;  ///< compute time of the step
};

/// What the forces of a session depend on besides the library and the motion.
struct SessionSettings {
  double tank_cap = 0;            ///< J
  double lipschitz_bound = 0;     ///< N/m, may be infinite
  double search_rate = 0;         ///< Hz; 0 = each step searched the body itself
  Vec3 body_position{};           ///< m, of the origin of the body in the frame of the device
  bool guarded = false;           ///< the safety functions of a force loop acted on the forces:
  double ramp = 0, watchdog = 0;  ///< s
  double max_force = 0, max_speed = 0;  ///< N, may be infinite; m/s
};

/// A recording without its steps.
struct RecordingHeading {
  std::string device;
  std::string library_sha256;
  double rate = 0;  ///< Hz
  double friction = 0;
  SessionSettings settings;
  Provenance provenance;
};

struct Recording : RecordingHeading {
  std::vector<RecordedStep> steps;
};

/// Writes a recording of any length in the memory of a few thousand steps, crash-safely. It
/// reserves the disk space that it may need at the beginning, so that a full disk is reported
/// there.
/// @throws Error as hdf5::Writer, and Internal for a step that the schema does not allow.
class RecordingWriter {
 public:
  RecordingWriter(const std::filesystem::path& path, const RecordingHeading& heading,
                  std::uint64_t steps);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  void append(const std::vector<RecordedStep>& steps);
  void commit();  ///< after exactly the promised number of steps

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads a recording of any length in the memory of a few thousand steps. Steps are checked as
/// they come. @throws Error as hdf5::Reader.
class RecordingReader {
 public:
  explicit RecordingReader(const std::filesystem::path& path);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  const RecordingHeading& heading() const noexcept;
  std::uint64_t steps() const noexcept;  ///< of the whole recording
  /// The steps that follow, some thousands; none when all were read.
  std::vector<RecordedStep> next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

void write_recording(const std::filesystem::path& path, const Recording& recording);
/// All of it in memory: about 170 bytes a step.
Recording read_recording(const std::filesystem::path& path);

}  // namespace palpate
