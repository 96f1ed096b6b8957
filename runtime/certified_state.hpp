// SPDX-License-Identifier: Apache-2.0
// Whether rendering a state is certified passive.
#pragma once

#include <string>

#include "format/passivity.hpp"
#include "runtime/handles.hpp"

namespace palpate::runtime {

/// Why a loop of this state is not certified passive on a device at a rate (Hz), in words; empty
/// when it is: the library covers the friction and the Lipschitz bound of the state, every constant
/// of the device is known, and (C7) and (C8) of docs/theory-certificate.md hold. The certificate
/// does not cover a clamped or ramped force and missed steps. Allocates; any thread.
std::string why_not_certified(const palpate_state& state, const DeviceConstants& device,
                              double rate);

}  // namespace palpate::runtime
