// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/certified.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/certificate/soften.hpp"
#include "format/error.hpp"
#include "format/guarantee.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

constexpr const char* kOverride = "or accept a device that may oscillate with --uncertified";

}  // namespace

double certified_rate(const Library& library, const fitting::DeviceProfile& profile) {
  if (library.certificate.triangles.empty() || !(profile.damping > 0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return 2 * certified_lipschitz_bound(library.certificate) / profile.damping;
}

double lipschitz_bound_for(const Library& library, const fitting::DeviceProfile& profile,
                           double rate) {
  const double limit = enforced_lipschitz_bound(library.certificate);
  const double bound = fitting::certifiable_stiffness(profile.damping, rate);
  return bound < limit && bound >= library.certificate.min_lipschitz_bound ? bound : limit;
}

void require_certified(const Library& library, const std::string& library_file,
                       const fitting::DeviceProfile& profile, double rate) {
  const auto refuse = [](const std::string& where, const std::string& problem,
                         const std::string& remedy) {
    throw Error(ErrorKind::Configuration, where, problem, remedy + ", " + kOverride);
  };
  if (library.certificate.triangles.empty()) {
    refuse(library_file, "the library has no certificate", "run `palpate certify`");
  }
  if (!(profile.damping > 0)) {
    refuse(profile.name, "the damping of the device is not known, so no rate is certified",
           "measure it and give it in a profile with --profile");
  }
  const double min_bound = library.certificate.min_lipschitz_bound;
  const double needed = std::isnan(min_bound) ? certified_rate(library, profile)
                                              : std::min(certified_rate(library, profile),
                                                         2 * min_bound / profile.damping);
  if (rate >= needed) return;
  if (std::isinf(needed)) {
    refuse(profile.name, "no rate is certified: the slide has no bound",
           "run `palpate certify` again, which states the reason");
  }
  refuse(profile.name,
         fmt::format("{:g} Hz is not certified: a lipschitz_bound of {} on {:g} N s/m needs {} Hz",
                     rate, lipschitz_bound_text(0.5 * needed * profile.damping), profile.damping,
                     rounded_up_text(needed)),
         "raise --rate, soften the body (palpate certify --rate --soften)");
}

}  // namespace palpate::app
