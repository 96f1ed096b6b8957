// SPDX-License-Identifier: AGPL-3.0-or-later
// A libcomedi for tests: a board with three 24-bit counters on subdevice 2 (20 000 counts a metre,
// on three slides) and three outputs of +-10 V in 16 bits on subdevice 1 (1 A/V, 2 N/A).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "tests/unit/runtime/devices/fake_world.hpp"

namespace {

constexpr double kCountsPerMetre = 200000;
constexpr double kNewtonPerVolt = 2;

palpate::test::FakeWorld world;
std::array<bool, 3> reset{}, armed{}, quadrature{};
std::array<double, 3> volts{};

struct Range {
  double low, high;
  unsigned unit;
} range{-10, 10, 0};

struct Instruction {
  unsigned kind, count;
  unsigned* data;
  unsigned subdevice, channel;
  unsigned unused[3];
};

}  // namespace

palpate::test::FakeWorld* fake_world() {
  return &world;
}

extern "C" {

void* comedi_open(const char*) {
  if (!world.present) return nullptr;
  ++world.opened;
  reset = armed = quadrature = {};
  volts = {};
  return &world;
}
int comedi_close(void*) {
  ++world.closed;
  return 0;
}
int comedi_errno() {
  return 19;
}
const char* comedi_strerror(int) {
  return "No such device";
}
int comedi_data_read(void*, unsigned subdevice, unsigned channel, unsigned, unsigned,
                     unsigned* data) {
  world.wait_for_device();
  if (world.unplugged || subdevice != 2 || channel > 2) return -1;
  if (!armed[channel] || !quadrature[channel]) return -1;
  const auto counts = std::llround(kCountsPerMetre * world.position()[channel]);
  *data = static_cast<unsigned>(counts) & 0xFFFFFFU;
  return 1;
}
int comedi_data_write(void*, unsigned subdevice, unsigned channel, unsigned, unsigned,
                      unsigned data) {
  if (world.unplugged || subdevice != 1 || channel > 2 || data > 65535) return -1;
  volts[channel] = range.low + (range.high - range.low) * data / 65535.0;
  if (channel == 2) {
    palpate::Vec3 force{};
    for (std::size_t i = 0; i < 3; ++i) force[i] = kNewtonPerVolt * volts[i];
    world.send_force(force);
  }
  return 1;
}
unsigned comedi_get_maxdata(void*, unsigned, unsigned) {
  return 65535;
}
Range* comedi_get_range(void*, unsigned, unsigned channel, unsigned) {
  return channel < 3 ? &range : nullptr;
}
unsigned comedi_from_phys(double value, Range* r, unsigned largest) {
  const double share = std::clamp((value - r->low) / (r->high - r->low), 0.0, 1.0);
  return static_cast<unsigned>(std::lround(share * largest));
}
int comedi_do_insn(void*, Instruction* insn) {
  if (insn->kind != (3U | 0x4000000U | 0x8000000U) || insn->subdevice != 2) return -1;
  if (insn->channel > 2) return -1;
  const unsigned channel = insn->channel;
  if (insn->data[0] == 34) reset[channel] = true, armed[channel] = quadrature[channel] = false;
  if (insn->data[0] == 1003) quadrature[channel] = reset[channel];
  if (insn->data[0] == 31) armed[channel] = quadrature[channel];
  return 1;
}

}  // extern "C"
