// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "app/pipeline/device_profile.hpp"
#include "format/error.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kDevices = test::source_folder() / "data/devices";

struct Published {
  double damping, peak_force;  ///< NaN where the table has a dash
};

/// "0.081 N s/m, identified" -> 0.081; "-" -> NaN.
double figure(const std::string& cell) {
  return cell.find('-') == 1 ? std::nan("") : std::stod(cell);
}

/// The table of files that ends the README of the profiles.
std::map<std::string, Published> published() {
  std::map<std::string, Published> table;
  std::ifstream readme(kDevices / "README.md");
  for (std::string line; std::getline(readme, line);) {
    std::istringstream cells(line);
    std::string before, file, damping, peak_force;
    for (auto* cell : {&before, &file, &damping, &peak_force}) std::getline(cells, *cell, '|');
    if (file.find(".toml") == std::string::npos) continue;
    const auto first = file.find('`') + 1;
    table[file.substr(first, file.rfind('`') - first)] = {figure(damping), figure(peak_force)};
  }
  return table;
}

void expect_same(double read, double stated) {
  if (std::isnan(stated)) {
    EXPECT_TRUE(std::isnan(read)) << read;
  } else {
    EXPECT_DOUBLE_EQ(read, stated);
  }
}

TEST(DeviceProfile, EveryProfileLoadsAndSaysWhatTheTableSays) {
  const auto table = published();
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kDevices)) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename());
    const auto row = table.find(entry.path().filename().string());
    ASSERT_NE(row, table.end());
    const fitting::DeviceProfile profile = read_device_profile(entry.path());
    expect_same(profile.damping, row->second.damping);
    expect_same(profile.peak_force, row->second.peak_force);
    EXPECT_FALSE(profile.name.empty());
    EXPECT_FALSE(profile.source.empty());
    ++read;
  }
  EXPECT_EQ(read, table.size());
  EXPECT_EQ(read, 6u);
}

std::string refusal(const std::string& text) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "device.toml";
  std::ofstream(file) << text;
  try {
    read_device_profile(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

TEST(DeviceProfile, ReadsDelayAndResolutionsAndLeavesThemUnknown) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "device.toml";
  std::ofstream(file) << "name = \"x\"\nsource = \"y\"\ndelay = \"0.2 ms\"\n"
                         "position_resolution = \"30 um\"\n";
  const DeviceConstants device = read_device_profile(file).constants();
  EXPECT_DOUBLE_EQ(device.delay, 2e-4);
  EXPECT_DOUBLE_EQ(device.position_resolution, 3e-5);
  EXPECT_TRUE(std::isnan(device.force_resolution));
  const std::string head = "name = \"x\"\nsource = \"y\"\n";
  EXPECT_EQ(refusal(head + "delay = \"0 s\"\n"), "accepted");
  EXPECT_THAT(refusal(head + "delay = \"-1 ms\"\n"), HasSubstr("delay"));
}

TEST(DeviceProfile, RefusesADampingThatIsNone) {
  const std::string head = "name = \"x\"\nsource = \"y\"\ndamping = ";
  EXPECT_EQ(refusal(head + "\"0.1 N s/m\"\n"), "accepted");
  EXPECT_THAT(refusal(head + "\"0 N s/m\"\n"), HasSubstr("device.toml:3"));
  EXPECT_THAT(refusal(head + "\"-1 N s/m\"\n"), HasSubstr("damping"));
  EXPECT_THAT(refusal(head + "0.1\n"), HasSubstr("N s/m"));
  EXPECT_THAT(refusal("name = \"x\"\n"), HasSubstr("source"));
}

}  // namespace
}  // namespace palpate::app
