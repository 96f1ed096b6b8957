// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "fitting/certificate/device_profile.hpp"
#include "format/library.hpp"

namespace palpate::app {

/// Rate from which rendering the library on the device is certified passive, Hz: 2 L/b, with L the
/// limit of its certificate, to which the runtime holds the change of force, and b the damping of
/// the device. NaN when the library has no certificate or the damping is not known; infinite where
/// that limit is not certain to be kept.
double certified_rate(const Library& library, const fitting::DeviceProfile& profile);

/// What to hold the change of force to, N/m: the limit of the certificate; or, where that is not
/// certified at this rate, what is, as long as slides can be held back to it.
double lipschitz_bound_for(const Library& library, const fitting::DeviceProfile& profile,
                           double rate);

/// @throws Error(Configuration) when the rate is not certified: what is missing and what to do.
void require_certified(const Library& library, const std::string& library_file,
                       const fitting::DeviceProfile& profile, double rate);

}  // namespace palpate::app
