// SPDX-License-Identifier: AGPL-3.0-or-later
// A ride through everything that a force step can do, for tests of what it must never do.
#pragma once

#include <cstdint>

#include "runtime/handles.hpp"

namespace palpate::test {

/// A bumpy ball with a hole in it, so that there are borders.
const palpate_library& ride_body();

/// 60 000 steps through the C interface: in, sliding all around, over the border, out, and input
/// that is none. Returns all status bits that were seen.
std::uint32_t ride(palpate_state& state);

/// The bits that the ride must have met to mean anything.
std::uint32_t ride_bits();

}  // namespace palpate::test
