// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "fitting/certificate/device_profile.hpp"
#include "format/library.hpp"

namespace palpate::app {

/// Rate from which rendering the library on the device is certified passive, Hz: 2 L/b, with L the
/// enforced Lipschitz bound and b the damping of the device. NaN when the library has no
/// certificate or the damping is not known; infinite where it is not certain that L can be
/// enforced.
double certified_rate(const Library& library, const fitting::DeviceProfile& profile);

/// The Lipschitz bound to enforce, N/m: that of the certificate, or, where that is not certified at
/// this rate, the largest that is, if the library allows it.
double lipschitz_bound_for(const Library& library, const fitting::DeviceProfile& profile,
                           double rate);

/// @throws Error(Configuration) when the rate is not certified.
void require_certified(const Library& library, const std::string& library_file,
                       const fitting::DeviceProfile& profile, double rate);

}  // namespace palpate::app
