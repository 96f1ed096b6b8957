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

void report(const char* how, const char* name, const fitting::Steepest& found) {
  if (found.triangle < 0) return say("  {}: no state to try", how);
  const std::string ratio = std::isfinite(found.bound)
                                ? fmt::format("{:.2f} of {}", found.quotient / found.bound, name)
                                : fmt::format("{} has no bound", name);
  say("  {}: {:.1f} N/m in triangle {}, {}; largest ratio to the bound of its triangle: {:.4f} ({} "
      "tries)",
      how, found.quotient, found.triangle, ratio, found.max_ratio, found.tries);
}

}  // namespace

void run_challenge(const Workspace& space, int tries) {
  const Library library = read_input(space.library(), "certify", read_library);
  fitting::ChallengeSettings settings;
  settings.tries = tries;
  const fitting::ChallengeResult result = fitting::challenge(library, settings);
  say("certify: largest force gradients found by {} tries in each of {} triangles, mu = {}", tries,
      library.triangles.size(), library.certificate.friction);
  report("fixed contact point", "L_stick", result.sticking);
  report("sliding", "L_slip", result.sliding);
  if (!result.confirms()) {
    throw Error(ErrorKind::Geometry, space.library().string(),
                "a force gradient exceeds the bound of the certificate",
                "do not use this certificate; report the library, this is a defect of palpate");
  }
  say("  the certificate is confirmed");
}

}  // namespace palpate::app
