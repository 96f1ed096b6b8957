// SPDX-License-Identifier: Apache-2.0
#include "format/guarantee.hpp"

#include <algorithm>
#include <cmath>

#include "format/number_text.hpp"

namespace palpate {
namespace {

/// What the responses alone do while the contact point slides.
std::string curves_alone(const Certificate& c) {
  const auto unbounded =
      std::count_if(c.triangles.begin(), c.triangles.end(),
                    [](const TriangleCertificate& t) { return std::isinf(t.slip); });
  if (unbounded > 0)
    return "the curves alone have no bound while sliding in " + std::to_string(unbounded) + " of " +
           std::to_string(c.triangles.size()) + " triangles";
  return "the curves alone reach " + lipschitz_bound_text(std::max(c.stick, c.slip));
}

/// Rounded up, but for the rounding of the arithmetic: 4000.0000000001 Hz is 4000 Hz.
std::string from(double rate) {
  constexpr double kExact = 1 - 1e-12;
  return "from " + rounded_up_text(kExact * rate) + " Hz on";
}

}  // namespace

GuaranteedBy guaranteed_by(const Certificate& certificate) {
  const double bound = certified_lipschitz_bound(certificate);
  if (!std::isfinite(bound)) return GuaranteedBy::Nothing;
  return bound >= std::max(certificate.stick, certificate.slip) ? GuaranteedBy::Curves
                                                                : GuaranteedBy::Limiter;
}

std::string guarantee_text(const Certificate& certificate) {
  const std::string bound = lipschitz_bound_text(certified_lipschitz_bound(certificate));
  const std::string change =
      "the force changes by at most " + bound + " times the travel of the tool";
  switch (guaranteed_by(certificate)) {
    case GuaranteedBy::Curves:
      return "guaranteed by the curves themselves: " + change;
    case GuaranteedBy::Limiter:
      return "guaranteed by the runtime, which throttles slides: " + change + "; " +
             curves_alone(certificate);
    case GuaranteedBy::Nothing:
      break;
  }
  if (certificate.triangles.empty()) return "nothing is guaranteed: the library is not certified";
  return "nothing is guaranteed: " + curves_alone(certificate) +
         ", and no bound is known that the runtime can enforce";
}

std::string verdict(const Certificate& certificate, const DeviceCertificate& device) {
  if (std::isnan(device.lowest_rate)) return "no guarantee: its damping is unknown";
  if (std::isinf(device.lowest_rate)) return "no guarantee at any rate: slides have no bound";
  const bool by_curves = guaranteed_by(certificate) == GuaranteedBy::Curves;
  std::string said = "passive " + from(device.lowest_rate) +
                     (by_curves ? ", by the curves themselves" : ", with slides throttled");
  const double throttled_rate = 2 * certificate.min_lipschitz_bound / device.damping;
  if (!(throttled_rate < 0.995 * device.lowest_rate)) return said;  // also when it is not known
  return said + "; " + from(throttled_rate) +
         " with lipschitz_bound = " + lipschitz_bound_text(certificate.min_lipschitz_bound);
}

std::string lipschitz_bound_text(double lipschitz_bound) {
  return rounded_up_text(lipschitz_bound) + " N/m";
}

}  // namespace palpate
