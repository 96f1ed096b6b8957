// SPDX-License-Identifier: AGPL-3.0-or-later
// Whether a force loop is fast enough for the tissue that it renders.
#pragma once

#include <string>

#include "format/library.hpp"

namespace palpate::app {

/// A step relaxes at its end, which is wrong by about the period over the relaxation time. What a
/// user must know where the shortest time is below five periods of the rate (Hz); else empty.
std::string short_relaxation_warning(const Library& library, double rate);

}  // namespace palpate::app
