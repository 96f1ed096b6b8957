// SPDX-License-Identifier: AGPL-3.0-or-later
// What a script leaves to be derived follows from the library that it is played on.
#pragma once

#include "app/case/case.hpp"
#include "app/simulate/hand_path.hpp"
#include "format/library.hpp"

namespace palpate::app {

/// The depth to which every response of the library is known, m: the smallest last knot.
/// @throws Error(Configuration) where no vertex has a response.
double depth_of_responses(const Library& library);

/// The script with a value for everything that is `auto`, as docs/cases.md states: depth and slide
/// from the responses and their surface, the device and the hand from the stiffness and the forces
/// at the last knots, so that a session has the same shape on a body of every size.
/// @throws Error(Configuration) where no vertex has a response.
SimulateSection settled(SimulateSection script, const Library& library);

/// The path of the hand of a settled script.
/// @throws Error(Configuration) where the surface with responses does not have it.
HandPath scripted_path(const SimulateSection& script, const Library& library);

}  // namespace palpate::app
