// SPDX-License-Identifier: AGPL-3.0-or-later
// The world of one vendor, from rest, for the tests of its binding alone.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "tests/unit/runtime/devices/backends.hpp"

namespace palpate::test {

inline FakeWorld& fresh_world_of(std::string_view backend) {
  auto& all = backends();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Backend& b) { return b.name == backend; });
  if (found == all.end()) throw std::logic_error("no such backend");
  found->world->reset();
  return *found->world;
}

}  // namespace palpate::test
