// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/comedi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "runtime/devices/dynamic_library.hpp"

namespace palpate::runtime {
namespace {

constexpr unsigned kReferenceGround = 0;
constexpr unsigned kInstructionConfigure = 3U | 0x4000000U | 0x8000000U;
constexpr unsigned kQuadratureEncoder = 1003;
constexpr unsigned kReset = 34;
constexpr unsigned kArm = 31;

struct Range {
  double low, high;
  unsigned unit;
};

struct Instruction {
  unsigned kind, count;
  unsigned* data;
  unsigned subdevice, channel;
  unsigned unused[3];
};

}  // namespace

struct ComediElectronics::Driver {
  explicit Driver(const std::string& path)
      : library(path.empty() ? std::vector<std::string>{"libcomedi.so.0"}
                             : std::vector<std::string>{path},
                "Comedi", "install libcomedi0, or give the library with --driver PATH") {
    library.bind(open, "comedi_open");
    library.bind(close, "comedi_close");
    library.bind(error, "comedi_errno");
    library.bind(error_text, "comedi_strerror");
    library.bind(read, "comedi_data_read");
    library.bind(write, "comedi_data_write");
    library.bind(largest, "comedi_get_maxdata");
    library.bind(range, "comedi_get_range");
    library.bind(from_physical, "comedi_from_phys");
    library.bind(instruct, "comedi_do_insn");
  }

  DynamicLibrary library;
  void* (*open)(const char*);
  int (*close)(void*);
  int (*error)(void);
  const char* (*error_text)(int);
  int (*read)(void*, unsigned, unsigned, unsigned, unsigned, unsigned*);
  int (*write)(void*, unsigned, unsigned, unsigned, unsigned, unsigned);
  unsigned (*largest)(void*, unsigned, unsigned);
  Range* (*range)(void*, unsigned, unsigned, unsigned);
  unsigned (*from_physical)(double, Range*, unsigned);
  int (*instruct)(void*, Instruction*);
};

/// Data that are read from the board once, outside the loop.
struct ComediElectronics::Output {
  Range* range = nullptr;
  unsigned largest = 0;
};

ComediElectronics::ComediElectronics(ComediSettings settings) : settings_(std::move(settings)) {
  for (const ComediChannel& channel : settings_.channels) {
    if (std::isfinite(channel.amplifier) && channel.amplifier != 0) continue;
    throw Error(ErrorKind::Configuration, "Comedi", "the amplifier of a channel has no A/V",
                "give a finite value other than 0");
  }
}

ComediElectronics::~ComediElectronics() {
  close();
}

void ComediElectronics::fail(const std::string& what) const {
  const char* text = driver_->error_text(driver_->error());
  throw Error(ErrorKind::Configuration, "Comedi " + settings_.device,
              what + ": " + (text != nullptr ? text : "unknown error"),
              "check the board, its driver (comedi_config) and the permissions of the device file");
}

void ComediElectronics::open() {
  driver_ = std::make_unique<Driver>(settings_.library);
  board_ = driver_->open(settings_.device.c_str());
  if (board_ == nullptr) fail("the board was not opened");
  outputs_.clear();
  try {
    for (const ComediChannel& channel : settings_.channels) prepare(channel);
  } catch (...) {
    close();
    throw;
  }
}

/// Resets the counter, starts it in quadrature mode, and reads the range of the output.
void ComediElectronics::prepare(const ComediChannel& channel) {
  std::array<unsigned, 2> data{};
  for (const unsigned configure : {kReset, kQuadratureEncoder, kArm}) {
    data = {configure, 0};
    Instruction instruction{
        kInstructionConfigure,   2,        data.data(), channel.counter_subdevice,
        channel.counter_channel, {0, 0, 0}};
    if (driver_->instruct(board_, &instruction) < 0) fail("a counter does not take an encoder");
  }
  Output output;
  output.range = driver_->range(board_, channel.output_subdevice, channel.output_channel, 0);
  output.largest = driver_->largest(board_, channel.output_subdevice, channel.output_channel);
  if (output.range == nullptr || output.largest == 0) fail("an output channel does not exist");
  outputs_.push_back(output);
}

void ComediElectronics::close() noexcept {
  if (board_ == nullptr) return;
  driver_->close(board_);
  board_ = nullptr;
}

bool ComediElectronics::read_counts(std::span<std::int32_t> counts) noexcept {
  if (board_ == nullptr || counts.size() != settings_.channels.size()) return false;
  for (std::size_t j = 0; j < counts.size(); ++j) {
    const ComediChannel& channel = settings_.channels[j];
    unsigned raw = 0;
    if (driver_->read(board_, channel.counter_subdevice, channel.counter_channel, 0,
                      kReferenceGround, &raw) < 0) {
      return false;
    }
    counts[j] = static_cast<std::int32_t>(raw);
  }
  return true;
}

bool ComediElectronics::write_current(std::span<const double> current) noexcept {
  if (board_ == nullptr || current.size() != settings_.channels.size()) return false;
  for (std::size_t j = 0; j < current.size(); ++j) {
    const ComediChannel& channel = settings_.channels[j];
    const Output& output = outputs_[j];
    const double volts =
        std::clamp(current[j] / channel.amplifier, output.range->low, output.range->high);
    const unsigned raw = driver_->from_physical(volts, output.range, output.largest);
    if (driver_->write(board_, channel.output_subdevice, channel.output_channel, 0,
                       kReferenceGround, raw) < 0) {
      return false;
    }
  }
  return true;
}

}  // namespace palpate::runtime
