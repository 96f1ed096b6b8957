// SPDX-License-Identifier: AGPL-3.0-or-later
// The configuration of a lab-built device.
#include <algorithm>
#include <cmath>

#include "app/case/reader.hpp"
#include "app/run/device_choice.hpp"
#include "format/error.hpp"
#include "runtime/devices/comedi.hpp"
#include "runtime/devices/lab_device.hpp"

namespace palpate::app {
namespace {

struct JointSection {
  std::string kind = "revolute";
  Vec3 axis{};
  Vec3 point{};
  double counts_per_turn = 0, offset = 0, gear = 1, torque_constant = 0, current_limit = 0;
  double amplifier = 0;
  int counter_bits = 24, encoder_sign = 1, motor_sign = 1;
  int counter_subdevice = 0, counter_channel = 0, output_subdevice = 0, output_channel = 0;
};

struct LabFile {
  std::string name;
  std::string board = "/dev/comedi0";
  Vec3 home{};
  double velocity_cutoff = 80;
  std::vector<JointSection> joints;
};

template <class V>
void describe(V& v, JointSection& j) {
  constexpr Range kChannel{.low = 0, .high = 65535};
  v.text(j.kind, {"kind", "of the joint"}, {"revolute", "prismatic"});
  v.direction(j.axis, {"axis", "of the joint with the device at home", kRequired});
  v.point(j.point, Dimension::Length, {"point", "on the axis, with the device at home"});
  v.number(j.counts_per_turn,
           {"counts_per_turn", "of the encoder; counts per metre of a prismatic joint", kRequired,
            kPositive});
  v.integer(
      j.counter_bits,
      {"counter_bits", "the counter wraps around at 2^bits", kOptional, {.low = 8, .high = 32}});
  v.integer(j.encoder_sign, {"encoder_sign",
                             "1 or -1: of the encoder against the joint",
                             kOptional,
                             {.low = -1, .high = 1}});
  v.number(j.offset, {"offset", "of the joint where the counter is 0, rad or m"});
  v.number(j.gear, {"gear", "turns of the motor for one turn of the joint", kOptional, kPositive});
  v.number(j.torque_constant, {"torque_constant", "N m/A, or N/A", kRequired, kPositive});
  v.integer(
      j.motor_sign,
      {"motor_sign", "1 or -1: of the motor against the joint", kOptional, {.low = -1, .high = 1}});
  v.number(j.current_limit, {"current_limit", "A", kRequired, kPositive});
  v.number(j.amplifier, {"amplifier", "A/V", kRequired});
  v.integer(j.counter_subdevice, {"counter_subdevice", "of the board", kRequired, kChannel});
  v.integer(j.counter_channel, {"counter_channel", "of the board", kRequired, kChannel});
  v.integer(j.output_subdevice, {"output_subdevice", "of the board", kRequired, kChannel});
  v.integer(j.output_channel, {"output_channel", "of the board", kRequired, kChannel});
}

template <class V>
void describe(V& v, LabFile& f) {
  v.text(f.name, {"name", "of the device", kRequired});
  v.text(f.board, {"board", "device file of Comedi"});
  v.point(f.home, Dimension::Length, {"home", "the tip with all joints at zero", kRequired});
  v.quantity(f.velocity_cutoff, Dimension::Frequency,
             {"velocity_cutoff", "of the filter of the velocity", kOptional, kPositive});
  v.sections("joint", f.joints, kRequired, "from the base to the tip");
}

runtime::Joint joint_of(const JointSection& j) {
  const auto kind =
      j.kind == "prismatic" ? runtime::JointKind::Prismatic : runtime::JointKind::Revolute;
  return {kind, j.axis, j.point};
}

runtime::LabAxis axis_of(const JointSection& j) {
  runtime::LabAxis axis;
  axis.counts_per_turn = j.counts_per_turn;
  axis.counter_bits = j.counter_bits;
  axis.sign = j.encoder_sign;
  axis.offset = j.offset;
  axis.gear = j.gear;
  axis.torque_constant = j.torque_constant;
  axis.motor_sign = j.motor_sign;
  axis.current_limit = j.current_limit;
  return axis;
}

runtime::ComediChannel channel_of(const JointSection& j) {
  const auto number = [](int n) { return static_cast<unsigned>(n); };
  return {number(j.counter_subdevice), number(j.counter_channel), number(j.output_subdevice),
          number(j.output_channel), j.amplifier};
}

}  // namespace

std::unique_ptr<runtime::Device> read_lab_device(const std::string& file,
                                                 const std::string& driver) {
  if (file.empty()) {
    throw Error(ErrorKind::Configuration, "--device lab", "its configuration is missing",
                "give it with --lab FILE; see docs/devices.md");
  }
  const toml::table table = read_toml(file, "the lab-built device");
  SourceMap sources(file);
  LabFile lab;
  TableReader reader(table, "the lab-built device", "", sources);
  describe(reader, lab);
  reader.finish();

  runtime::ComediSettings board;
  board.library = driver;
  board.device = lab.board;
  runtime::LabDeviceSettings settings;
  settings.name = lab.name;
  settings.velocity_cutoff = lab.velocity_cutoff;
  std::vector<runtime::Joint> joints;
  for (const JointSection& j : lab.joints) {
    joints.push_back(joint_of(j));
    settings.axes.push_back(axis_of(j));
    board.channels.push_back(channel_of(j));
  }
  return std::make_unique<runtime::LabDevice>(settings, runtime::SerialChain(joints, lab.home),
                                              std::make_unique<runtime::ComediElectronics>(board));
}

}  // namespace palpate::app
