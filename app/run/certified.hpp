// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "fitting/fitting.hpp"
#include "format/library.hpp"

namespace palpate::app {

/// Rate from which rendering the library on the device is certified passive, Hz: 2 L/b, with L the
/// bound to which the runtime holds the change of force and b the damping of the device. NaN when
/// the library has no certificate or the damping is not known.
double certified_rate(const Library& library, const fitting::DeviceProfile& profile);

/// @throws Error(Configuration) when the rate is not certified: what is missing and what to do.
void require_certified(const Library& library, const std::string& library_file,
                       const fitting::DeviceProfile& profile, double rate);

}  // namespace palpate::app
