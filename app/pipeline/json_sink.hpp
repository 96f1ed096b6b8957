// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <functional>
#include <string_view>

#include "app/pipeline/events.hpp"

namespace palpate::app {

/// Prints each event as one JSON object on a line, for programs. Numbers that are not finite are
/// null. Not thread-safe.
class JsonSink {
 public:
  explicit JsonSink(std::function<void(std::string_view)> print_line)
      : print_line_(std::move(print_line)) {}
  void operator()(const Event& event) const;

 private:
  std::function<void(std::string_view)> print_line_;
};

}  // namespace palpate::app
