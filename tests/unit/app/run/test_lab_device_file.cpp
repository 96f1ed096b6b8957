// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "app/run/device_choice.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

class LabDeviceFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  std::unique_ptr<runtime::Device> read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_lab_device(file_.string(), "");
  }
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("lab_" + std::to_string(getpid()) + ".toml");
  const std::string good_ = R"(
name = "plane arm"
home = ["300 mm", "0 mm", "0 mm"]
[[joint]]
axis = [0, 0, 1]
counts_per_turn = 4000
torque_constant = 0.05
current_limit = 2
amplifier = 0.4
counter_subdevice = 2
counter_channel = 0
output_subdevice = 1
output_channel = 0
)";
};

TEST_F(LabDeviceFile, IsRead) {
  EXPECT_EQ(read(good_)->name(), "plane arm");
}

TEST_F(LabDeviceFile, IsRefusedWithTheReason) {
  const auto reason = [&](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(reason(good_ + "gaer = 3\n").find("gear"), std::string::npos);
  EXPECT_NE(reason(good_ + "counter_bits = 64\n").find("counter_bits"), std::string::npos);
  EXPECT_NE(reason("name = \"x\"\nhome = [\"0 mm\", \"0 mm\", \"0 mm\"]\n").find("joint"),
            std::string::npos);
  EXPECT_THROW(read_lab_device("", ""), Error);
  EXPECT_THROW(read_lab_device("/nonexistent/lab.toml", ""), Error);
}

TEST_F(LabDeviceFile, TakesRevoluteAndPrismaticJoints) {
  EXPECT_NO_THROW(read(good_ + "kind = \"prismatic\"\n"));
  EXPECT_NO_THROW(read(good_ + "kind = \"revolute\"\n"));
  EXPECT_THROW(read(good_ + "kind = \"spherical\"\n"), Error);
}

}  // namespace
}  // namespace palpate::app
