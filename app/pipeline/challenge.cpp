// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/challenge.hpp"

#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "format/error.hpp"
#include "format/library.hpp"

namespace palpate::app {
namespace {

SteepestForce steepest_force(const char* contact, const fitting::Steepest& found) {
  return {contact, found.quotient, found.bound, found.triangle, found.max_ratio, found.tries};
}

}  // namespace

void run_challenge(const Workspace& space, int tries, const EventSink& emit) {
  const Library library = read_input(space.library(), "certify", read_library);
  fitting::ChallengeSettings settings;
  settings.tries = tries;
  const fitting::ChallengeResult result = fitting::challenge(library, settings);
  emit(steepest_force("sticking", result.sticking));
  emit(steepest_force("sliding", result.sliding));
  if (!result.confirms()) {
    throw Error(ErrorKind::Geometry, space.library().string(),
                "a force gradient exceeds the bound of the certificate",
                "do not use this certificate; report the library, this is a defect of palpate");
  }
  emit(ChallengeVerdict{"certify", "the search confirms the certificate"});
}

}  // namespace palpate::app
