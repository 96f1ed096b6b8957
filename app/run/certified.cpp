// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/certified.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "format/error.hpp"
#include "format/guarantee.hpp"
#include "format/number_text.hpp"
#include "format/passivity.hpp"

namespace palpate::app {
namespace {

constexpr const char* kOverride = "or accept a device that may oscillate with --uncertified";

/// What the library lacks, whatever the device.
std::optional<NotCertified> fault_of(const Library& library, const std::string& file,
                                     double friction) {
  const Certificate& c = library.certificate;
  if (c.triangles.empty())
    return NotCertified{file, "the library has no certificate", "run `palpate certify`"};
  if (!certified_range(library).covers(friction)) {
    return NotCertified{
        file,
        fmt::format("its bounds are not valid at a friction coefficient of {:g}, only {} {:g}",
                    friction, certified_range(library).low_friction < c.friction ? "up to" : "at",
                    c.friction),
        fmt::format("set friction = {:g} in [certify] of the case and run `palpate certify`",
                    friction)};
  }
  return std::nullopt;
}

std::optional<NotCertified> fault_of(const fitting::DeviceProfile& profile) {
  const std::vector<std::string> unknown = unknown_constants(profile.constants());
  if (unknown.empty()) return std::nullopt;
  return NotCertified{profile.name,
                      fmt::format("its {} {} unknown, so nothing is certified",
                                  list_in_words(unknown), unknown.size() == 1 ? "is" : "are"),
                      "measure what is missing and give it in a profile with --profile"};
}

NotCertified too_slow(const Library& library, const fitting::DeviceProfile& profile, double rate) {
  const Certificate& c = library.certificate;
  const double bound = std::isfinite(c.min_lipschitz_bound)
                           ? std::min(c.min_lipschitz_bound, certified_lipschitz_bound(c))
                           : certified_lipschitz_bound(c);
  const DeviceConstants device = profile.constants();
  if (std::isinf(bound)) {
    return {profile.name, "no rate is certified: the slide has no bound",
            "run `palpate certify` again, which states the reason"};
  }
  const RenderedForce force = rendered_force(c, bound);
  if (!judge_passivity(device, force, rate).by_friction) {
    return {profile.name,
            fmt::format("{:g} N of dry friction allow positions in steps of {} um with a "
                        "Lipschitz bound of {}, not of {} um",
                        device.coulomb_friction,
                        number_text(1e6 * largest_position_step(device, bound)),
                        lipschitz_bound_text(bound), number_text(1e6 * device.position_resolution)),
            "soften the body (palpate certify --rate --soften)"};
  }
  const double needed = lowest_rate(device, force);
  if (std::isinf(needed)) {
    return {profile.name, "no rate is certified: the damping does not make up for the delay",
            "soften the body (palpate certify --rate --soften)"};
  }
  return {profile.name,
          fmt::format("{:g} Hz is not certified: a Lipschitz bound of {} on {:g} N s/m needs {} Hz",
                      rate, lipschitz_bound_text(bound), device.damping, rounded_up_text(needed)),
          "raise --rate, soften the body (palpate certify --rate --soften)"};
}

}  // namespace

double lipschitz_bound_for(const Library& library, const fitting::DeviceProfile& profile,
                           double rate) {
  const DeviceConstants device = profile.constants();
  const double limit = enforced_lipschitz_bound(library.certificate);
  const double by_damping =
      certifiable_stiffness(device, rate, library.certificate.relaxation_rate);
  const double bound = std::min(by_damping, certifiable_stiffness_by_friction(device));
  return bound < limit && bound >= library.certificate.min_lipschitz_bound ? bound : limit;
}

std::optional<NotCertified> why_not_certified(const Library& library,
                                              const std::string& library_file,
                                              const fitting::DeviceProfile& profile, double rate,
                                              double friction) {
  if (auto fault = fault_of(library, library_file, friction)) return fault;
  if (auto fault = fault_of(profile)) return fault;
  const double bound = lipschitz_bound_for(library, profile, rate);
  const bool enforced = certified_range(library).enforces(bound);
  if (enforced &&
      judge_passivity(profile.constants(), rendered_force(library.certificate, bound), rate)
          .certified())
    return std::nullopt;
  return too_slow(library, profile, rate);
}

void require_certified(const std::optional<NotCertified>& reason) {
  if (!reason) return;
  throw Error(ErrorKind::Configuration, reason->where, reason->problem,
              reason->remedy + ", " + kOverride);
}

}  // namespace palpate::app
