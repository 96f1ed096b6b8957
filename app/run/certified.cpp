// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/certified.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "format/error.hpp"
#include "runtime/handles.hpp"

namespace palpate::app {
namespace {

constexpr const char* kOverride = "or accept a device that may oscillate with --uncertified";

}  // namespace

double certified_rate(const Library& library, const fitting::DeviceProfile& profile) {
  if (library.certificate.triangles.empty() || !(profile.damping > 0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return 2 * palpate_library::limit_of(library) / profile.damping;
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
  const double needed = certified_rate(library, profile);
  if (rate >= needed) return;
  refuse(profile.name,
         fmt::format("{:g} Hz is not certified: a steepness of {:.1f} N/m on {:g} N s/m needs "
                     "{:.0f} Hz",
                     rate, palpate_library::limit_of(library), profile.damping, needed),
         "raise --rate, soften the body");
}

}  // namespace palpate::app
