// SPDX-License-Identifier: Apache-2.0
// Settings out of range, refused before the loop starts.
#pragma once

#include <string>

#include "format/error.hpp"

namespace palpate::runtime {

/// Checks the settings of one part of the runtime.
class SettingsCheck {
 public:
  explicit SettingsCheck(std::string where) : where_(std::move(where)) {}

  /// Throws Error(Configuration) unless `good`: "<where>: <what> is <value>; give <range>".
  void operator()(bool good, const char* what, double value, const char* range) const {
    if (good) return;
    refuse(where_, std::string(what) + " is " + std::to_string(value),
           std::string("give ") + range);
  }

 private:
  std::string where_;
};

}  // namespace palpate::runtime
