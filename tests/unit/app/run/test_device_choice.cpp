// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/device_choice.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "format/error.hpp"

namespace palpate::app {
namespace {

TEST(DeviceChoice, KnowsEveryNameItLists) {
  for (const DeviceName& device : device_names()) {
    DeviceChoice choice;
    choice.name = device.name;
    if (device.name == "lab") continue;  // below
    EXPECT_NE(make_device(choice, [](double) { return runtime::HandTarget{}; }), nullptr);
  }
  DeviceChoice typo;
  typo.name = "simulatd";
  try {
    make_device(typo, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.remedy().find("'simulated'"), std::string::npos);
  }
  for (const auto& [product, binding] :
       {std::pair{"Falcon", "'force-dimension'"}, std::pair{"touch", "'openhaptics'"},
        std::pair{"inverse3", "'haply'"}}) {
    try {
      require_known_device(product);
      ADD_FAILURE() << product;
    } catch (const Error& error) {
      EXPECT_NE(error.remedy().find(binding), std::string::npos) << error.remedy();
    }
  }
  DeviceChoice number;
  number.name = "force-dimension";
  number.unit = "left";
  EXPECT_THROW(make_device(number, {}), Error);
}

}  // namespace
}  // namespace palpate::app
