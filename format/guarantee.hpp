// SPDX-License-Identifier: Apache-2.0
// What a certificate guarantees, in plain words.
#pragma once

#include <string>

#include "format/library.hpp"

namespace palpate {

/// What keeps the change of the force within the enforced bound.
enum class GuaranteedBy {
  Curves,   ///< the responses themselves, wherever the tool moves
  Limiter,  ///< the runtime, which rate-limits slides; the responses alone exceed the bound
  Nothing   ///< no bound is certain
};

GuaranteedBy guaranteed_by(const Certificate& certificate);

/// One line: what is guaranteed of the force, and by what. Nothing stands before a missing bound.
std::string guarantee_text(const Certificate& certificate);

/// One line for a device: the rate from which it is certified passive and by what, also with slides
/// rate-limited as far as possible; or that it is not certified, with every unknown constant.
std::string verdict(const Certificate& certificate, const DeviceCertificate& device);

/// Is the device certified from its lowest rate on, with the enforced bound?
bool is_certified(const Certificate& certificate, const DeviceCertificate& device);

/// For which settings of a state the runtime keeps the change of the force within its bound.
struct CertifiedRange {
  /// Friction coefficients: from 0 to that of the certificate, as L_min grows with it; where L_min
  /// is not known, that of the certificate alone.
  double low_friction = 1, high_friction = 0;
  double curves = kInfinity;  ///< N/m: from there on the responses keep the bound by themselves
  double min_lipschitz_bound = kInfinity;  ///< N/m, L_min: from there on by rate-limited slides
  double relaxation_rate = kInfinity;      ///< K of (C9), 1/s

  bool covers(double friction) const noexcept {
    return friction >= low_friction && friction <= high_friction;
  }
  bool enforces(double lipschitz_bound) const noexcept {
    return lipschitz_bound < kInfinity &&
           (lipschitz_bound >= curves || lipschitz_bound >= min_lipschitz_bound);
  }
};

/// Without a certificate it contains nothing.
CertifiedRange certified_range(const Library& library);

/// A Lipschitz bound as text in N/m, rounded up, so that the text is a valid setting.
std::string lipschitz_bound_text(double lipschitz_bound);

}  // namespace palpate
