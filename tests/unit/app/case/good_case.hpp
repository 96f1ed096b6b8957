// SPDX-License-Identifier: AGPL-3.0-or-later
// A complete case, and the messages of cases made from it by replacing a part.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "app/case/case.hpp"
#include "format/error.hpp"

namespace palpate::app {

using ::testing::HasSubstr;

inline const std::string kGood = R"(name = "ball"

[surface]
file = "ball.off"
unit = "mm"
region = "gel"

[[inclusion]]
file = "nodule.off"
unit = "cm"
region = "nodule"

[mesh]
patch_spacing = "8 mm"
element_size = "4 mm"

[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "-15 mm"]
normal = [0, 0, -1]

[[support]]
shape = "sphere"
centre = ["1 mm", "2 cm", "0 m"]
radius = "5 mm"

[[support]]
shape = "surface"
file = "bone.stl"
unit = "mm"
distance = "500 um"

[[support]]
shape = "box"
low = ["-1 mm", "-1 mm", "-1 mm"]
high = ["1 mm", "1 mm", "1 mm"]

[[material]]
region = "gel"
young = "10 kPa"
poisson = 0.49

[[material]]
region = "nodule"
young = "0.1 MPa"
poisson = 0.45

[indentation]
depth = "4 mm"
lateral_depths = ["1 mm", "3.3 mm"]
azimuths = ["0 deg", "33.3 deg"]
)";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The message of the error that reading `text` must raise.
inline std::string message_of(const std::string& text) {
  try {
    parse_case(text, "ball.toml");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "accepted:\n" << text;
  return {};
}

inline std::string message_with(const std::string& from, const std::string& to) {
  return message_of(replaced(kGood, from, to));
}

}  // namespace palpate::app
