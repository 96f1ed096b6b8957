// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/challenge.hpp"

#include <cmath>
#include <string>

#include "app/console.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "format/error.hpp"
#include "format/library.hpp"

namespace palpate::app {
namespace {

void tell(const char* how, const char* name, const fitting::Steepest& found) {
  if (found.triangle < 0) return say("  {}: nothing to try", how);
  const std::string share = std::isfinite(found.bound)
                                ? fmt::format("{:.2f} of {}", found.quotient / found.bound, name)
                                : fmt::format("{} has no bound", name);
  say("  {}: {:.1f} N/m in triangle {}, {}; nearest to the bound of its own triangle: {:.4f} ({} "
      "tries)",
      how, found.quotient, found.triangle, share, found.nearest, found.tries);
}

}  // namespace

void run_challenge(const Workspace& space, int tries) {
  const Library library = read_input(space.library(), "certify", read_library);
  fitting::ChallengeSettings settings;
  settings.tries = tries;
  const fitting::ChallengeResult result = fitting::challenge(library, settings);
  say("certify: steepest forces found by {} tries in each of {} triangles, mu = {}", tries,
      library.triangles.size(), library.certificate.friction);
  tell("contact point held", "L_stick", result.held);
  tell("sliding", "L_slip", result.sliding);
  if (!result.stands()) {
    throw Error(ErrorKind::Geometry, space.library().string(),
                "a force was found that is steeper than its certificate allows",
                "do not use this certificate, and report the library: it is a fault of palpate");
  }
  say("  the certificate stands");
}

}  // namespace palpate::app
