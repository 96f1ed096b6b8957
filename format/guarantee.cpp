// SPDX-License-Identifier: Apache-2.0
#include "format/guarantee.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

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

// Against the rounding of the arithmetic: 4000.0000000001 Hz is 4000 Hz.
constexpr double kExact = 1 - 1e-12;

std::string from(double rate) {
  return "from " + rounded_up_text(kExact * rate) + " Hz on";
}

std::string not_certified_without(const std::vector<std::string>& unknown, double rate) {
  return "no guarantee: its " + list_in_words(unknown) +
         (unknown.size() == 1 ? " is unknown" : " are unknown") +
         (std::isfinite(rate) ? "; its damping suffices " + from(rate) : "");
}

/// Empty where no rate is certified with this bound.
std::string certified_from(const DeviceConstants& device, const RenderedForce& force, double rate) {
  const bool holds = std::isfinite(rate) && judge_passivity(device, force, rate).by_friction;
  return holds ? from(rate) : "";
}

/// All constants are known, and a condition does not hold at any rate.
std::string why_not(const DeviceConstants& constants, double bound,
                    const DeviceCertificate& device) {
  if (std::isinf(device.lowest_rate))
    return "no guarantee at any rate: its damping does not make up for its delay";
  return "no guarantee at any rate: its dry friction allows positions in steps of " +
         number_text(1e6 * largest_position_step(constants, bound)) + " um, not of " +
         number_text(1e6 * device.position_resolution) + " um";
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
      return "guaranteed by the runtime, which rate-limits slides: " + change + "; " +
             curves_alone(certificate);
    case GuaranteedBy::Nothing:
      break;
  }
  if (certificate.triangles.empty()) return "nothing is guaranteed: the library is not certified";
  return "nothing is guaranteed: " + curves_alone(certificate) +
         ", and no bound is known that the runtime can enforce";
}

std::string verdict(const Certificate& certificate, const DeviceCertificate& device) {
  const DeviceConstants constants = device.constants();
  const std::vector<std::string> unknown = unknown_constants(constants);
  if (!unknown.empty()) return not_certified_without(unknown, device.lowest_rate);
  const double bound = certified_lipschitz_bound(certificate);
  if (std::isinf(bound)) return "no guarantee at any rate: slides have no bound";
  const double smallest = certificate.min_lipschitz_bound;
  const std::string by = guaranteed_by(certificate) == GuaranteedBy::Curves
                             ? ", by the curves themselves"
                             : ", with slides rate-limited";
  const std::string whole =
      certified_from(constants, rendered_force(certificate, bound), device.lowest_rate);
  const RenderedForce softest = rendered_force(certificate, smallest);
  const double rate_limited = lowest_rate(constants, softest);
  std::string rate_limited_from;  // not where it gains nothing or is not known
  if (whole.empty() || rate_limited < 0.995 * device.lowest_rate) {
    rate_limited_from = certified_from(constants, softest, rate_limited);
    if (!rate_limited_from.empty())
      rate_limited_from += " with lipschitz_bound = " + lipschitz_bound_text(smallest);
  }
  if (whole.empty() && rate_limited_from.empty()) return why_not(constants, bound, device);
  std::string said = "certified passive " + (whole.empty() ? rate_limited_from : whole + by);
  if (!whole.empty() && !rate_limited_from.empty()) said += "; " + rate_limited_from;
  return said +
         " (Mahvash & Hayward 2005, eq. 5: " + rounded_up_text(kExact * device.published_rate) +
         " Hz)";
}

bool is_certified(const Certificate& certificate, const DeviceCertificate& device) {
  constexpr double kFrom = 1 + 1e-9;  // the lowest rate itself is rounded
  const RenderedForce force = rendered_force(certificate, certified_lipschitz_bound(certificate));
  return judge_passivity(device.constants(), force, kFrom * device.lowest_rate).certified();
}

CertifiedRange certified_range(const Library& library) {
  const Certificate& c = library.certificate;
  if (c.triangles.empty()) return {};
  const bool known = std::isfinite(c.min_lipschitz_bound);
  return {known ? 0 : c.friction, c.friction, std::max(c.stick, c.slip),
          known ? c.min_lipschitz_bound : kInfinity, c.relaxation_rate};
}

std::string lipschitz_bound_text(double lipschitz_bound) {
  return rounded_up_text(lipschitz_bound) + " N/m";
}

}  // namespace palpate
