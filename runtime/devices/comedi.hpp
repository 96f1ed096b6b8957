// SPDX-License-Identifier: Apache-2.0
// Data-acquisition boards with a Comedi driver, through libcomedi, bound at run time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/devices/lab_device.hpp"

namespace palpate::runtime {

/// One joint on the board.
struct ComediChannel {
  unsigned counter_subdevice = 0, counter_channel = 0;  ///< quadrature encoder
  unsigned output_subdevice = 0, output_channel = 0;    ///< voltage to the amplifier
  double amplifier = 0;                                 ///< A/V
};

struct ComediSettings {
  std::string library;  ///< path of libcomedi; empty: libcomedi.so.0
  std::string device = "/dev/comedi0";
  std::vector<ComediChannel> channels;  ///< one for each joint
};

/// Counts by comedi_data_read, currents as voltages by comedi_data_write in the first range of the
/// channel, limited to that range. Each read and write is a system call of the driver.
class ComediElectronics : public LabElectronics {
 public:
  explicit ComediElectronics(ComediSettings settings);
  ~ComediElectronics() override;
  void open() override;
  void close() noexcept override;
  bool read_counts(std::span<std::int32_t> counts) noexcept override;
  bool write_current(std::span<const double> current) noexcept override;

 private:
  struct Driver;
  struct Output;
  void prepare(const ComediChannel& channel);
  [[noreturn]] void fail(const std::string& what) const;

  ComediSettings settings_;
  std::unique_ptr<Driver> driver_;
  std::vector<Output> outputs_;
  void* board_ = nullptr;
};

}  // namespace palpate::runtime
