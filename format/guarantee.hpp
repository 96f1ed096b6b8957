// SPDX-License-Identifier: Apache-2.0
// What a certificate guarantees, in plain words.
#pragma once

#include <string>

#include "format/library.hpp"

namespace palpate {

/// What keeps the change of the force within the enforced bound.
enum class GuaranteedBy {
  Curves,   ///< the responses themselves, wherever the tool moves
  Limiter,  ///< the runtime, which throttles slides; the responses alone exceed the bound
  Nothing   ///< no bound is certain
};

GuaranteedBy guaranteed_by(const Certificate& certificate);

/// One line: what is guaranteed of the force, and by what. Nothing stands before a missing bound.
std::string guarantee_text(const Certificate& certificate);

/// One line for a device: the rate from which it is passive and by what, also with slides throttled
/// as far as possible; or that there is no guarantee, and why.
std::string verdict(const Certificate& certificate, const DeviceCertificate& device);

/// A Lipschitz bound as text in N/m, rounded up, so that the text is a valid setting.
std::string lipschitz_bound_text(double lipschitz_bound);

}  // namespace palpate
