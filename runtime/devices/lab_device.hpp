// SPDX-License-Identifier: Apache-2.0
// A device built in a laboratory: encoders, motors and the kinematics between them and the tip.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/device.hpp"
#include "runtime/devices/serial_chain.hpp"

namespace palpate::runtime {

/// The electronics: reads counts, writes currents.
class LabElectronics {
 public:
  LabElectronics() = default;
  virtual ~LabElectronics() = default;
  LabElectronics(const LabElectronics&) = delete;
  LabElectronics& operator=(const LabElectronics&) = delete;

  virtual void open() = 0;  ///< @throws Error
  virtual void close() noexcept = 0;
  /// One raw count of the counter for each joint. False: the board does not answer.
  virtual bool read_counts(std::span<std::int32_t> counts) noexcept = 0;
  /// One current for each joint, A.
  virtual bool write_current(std::span<const double> current) noexcept = 0;
};

/// From a joint to its encoder and its motor.
struct LabAxis {
  double counts_per_turn = 0;  ///< of the encoder; for a prismatic joint: counts per metre
  int counter_bits = 24;       ///< the counter wraps around at 2^bits; 8 to 32
  double sign = 1;             ///< 1 or -1: direction of the encoder relative to the joint
  double offset = 0;           ///< rad or m, of the joint where the counter is 0
  double gear = 1;             ///< N, turns of encoder and motor for one turn of the joint
  double torque_constant = 0;  ///< k_t, N m/A (N/A for a joint that slides)
  double motor_sign = 1;       ///< 1 or -1: direction of the motor relative to the joint
  double current_limit = 0;    ///< A
};

struct LabDeviceSettings {
  std::string name = "lab-built device";
  std::vector<LabAxis> axes;    ///< one for each joint of the chain
  double velocity_cutoff = 80;  ///< Hz, of the first-order filter of the velocity
};

/// Counts -> joints (with wrap-around of the counters) -> tip; force -> torques J^T f -> currents
/// torque/(N k_t). When a current would exceed its limit all are scaled equally, so that the force
/// keeps its direction, and the step is reported as saturated. The velocity is the filtered
/// difference of positions over the time between reads.
class LabDevice : public Device {
 public:
  /// @throws Error(Configuration) naming the constant that is out of range.
  LabDevice(LabDeviceSettings settings, SerialChain chain,
            std::unique_ptr<LabElectronics> electronics);
  ~LabDevice() override;

  std::string name() const override { return settings_.name; }
  void open() override;
  void close() noexcept override;
  DeviceStatus read(DeviceReading& reading) noexcept override;
  DeviceStatus command(const Vec3& force) noexcept override;
  void halt() noexcept override { halted_ = true; }

 private:
  static constexpr std::size_t kMost = SerialChain::kMostJoints;
  void follow(std::size_t j, std::int32_t count) noexcept;
  void filter_velocity(const Vec3& position) noexcept;

  LabDeviceSettings settings_;
  SerialChain chain_;
  std::unique_ptr<LabElectronics> electronics_;
  bool open_ = false;
  std::array<std::int32_t, kMost> last_count_{};
  std::array<std::int64_t, kMost> total_count_{};
  std::array<double, kMost> q_{};
  SerialChain::Pose pose_;
  Vec3 last_position_{}, velocity_{};
  std::int64_t last_time_ = 0;  ///< monotonic, ns; 0 before the first read
  std::atomic<bool> halted_{false};
};

}  // namespace palpate::runtime
