// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/runtime/devices/backends.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "runtime/devices/comedi.hpp"
#include "runtime/devices/force_dimension.hpp"
#include "runtime/devices/haply.hpp"
#include "runtime/devices/lab_device.hpp"
#include "runtime/devices/open_haptics.hpp"
#include "tests/unit/runtime/devices/fake_haply.hpp"

namespace palpate::test {
namespace {

using runtime::Device;

/// The world inside a fake library; the library stays open, so that the binding gets the same one.
FakeWorld* world_of(const std::string& library) {
  void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw std::runtime_error(dlerror());
  return reinterpret_cast<FakeWorld* (*)()>(dlsym(handle, "fake_world"))();
}

std::unique_ptr<Device> lab_device(const std::string& library) {
  runtime::ComediSettings board;
  board.library = library;
  runtime::LabDeviceSettings settings;
  std::vector<runtime::Joint> joints;
  for (unsigned j = 0; j < 3; ++j) {
    board.channels.push_back({2, j, 1, j, 1.0});
    runtime::LabAxis axis;
    axis.counts_per_turn = 200000;
    axis.torque_constant = 2;
    axis.current_limit = 5;
    settings.axes.push_back(axis);
    Vec3 along{};
    along[j] = 1;
    joints.push_back({runtime::JointKind::Prismatic, along, {}});
  }
  return std::make_unique<runtime::LabDevice>(settings, runtime::SerialChain(joints, {}),
                                              std::make_unique<runtime::ComediElectronics>(board));
}

Backend force_dimension() {
  Backend b{"ForceDimension", world_of(PALPATE_FAKE_DHD), {}, {}, "libdhd"};
  b.make = [] {
    return std::make_unique<runtime::ForceDimensionDevice>(
        runtime::ForceDimensionSettings{PALPATE_FAKE_DHD, -1});
  };
  b.make_without_driver = [] {
    return std::make_unique<runtime::ForceDimensionDevice>(runtime::ForceDimensionSettings{});
  };
  b.reports_late = true;
  return b;
}

Backend open_haptics() {
  Backend b{"OpenHaptics", world_of(PALPATE_FAKE_HD), {}, {}, "libHD"};
  b.make = [] {
    return std::make_unique<runtime::OpenHapticsDevice>(
        runtime::OpenHapticsSettings{PALPATE_FAKE_HD, ""});
  };
  b.make_without_driver = [] {
    return std::make_unique<runtime::OpenHapticsDevice>(runtime::OpenHapticsSettings{});
  };
  return b;
}

Backend comedi() {
  Backend b{"LabOnComedi", world_of(PALPATE_FAKE_COMEDI), {}, {}, "libcomedi"};
  b.make = [] { return lab_device(PALPATE_FAKE_COMEDI); };
  b.make_without_driver = [] { return lab_device("libcomedi-that-is-not-there.so"); };
  b.position_error = 2.6e-6;  // half a count
  b.force_error = 3.2e-4;     // half a step of 16 bits over 20 V, 2 N/V
  b.gives_velocity = false;
  b.saturates_by_itself = false;
  return b;
}

Backend haply() {
  static FakeWorld world;
  static FakeHaplyService service(world);
  Backend b{"Haply", &world, {}, {}, "localhost"};
  b.make = [] {
    return std::make_unique<runtime::HaplyDevice>(
        runtime::HaplySettings{"localhost", service.port(), "", 300});
  };
  b.make_without_driver = [] {
    return std::make_unique<runtime::HaplyDevice>(runtime::HaplySettings{"localhost", 1, "", 300});
  };
  b.reports_late = true;
  b.saturates_by_itself = false;
  return b;
}

}  // namespace

std::vector<Backend>& backends() {
  static std::vector<Backend> all{force_dimension(), open_haptics(), comedi(), haply()};
  return all;
}

}  // namespace palpate::test
