// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "fitting/certificate/device_profile.hpp"
#include "format/library.hpp"

namespace palpate::app {

/// The Lipschitz bound to enforce, N/m: that of the certificate, or, where that is not certified at
/// this rate, the largest that is, if the library allows it.
double lipschitz_bound_for(const Library& library, const fitting::DeviceProfile& profile,
                           double rate);

/// Why a session is not certified passive.
struct NotCertified {
  std::string where, problem, remedy;
};

/// Judges a session at a rate (Hz) with a friction coefficient, by (C1) and (C2) of
/// docs/theory-certificate.md and the bound of lipschitz_bound_for(). Empty: it is certified.
std::optional<NotCertified> why_not_certified(const Library& library,
                                              const std::string& library_file,
                                              const fitting::DeviceProfile& profile, double rate,
                                              double friction);

/// @throws Error(Configuration) when it is not certified, with the option that renders all the
/// same.
void require_certified(const std::optional<NotCertified>& reason);

}  // namespace palpate::app
