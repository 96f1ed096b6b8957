// SPDX-License-Identifier: AGPL-3.0-or-later
// The steepest slide over a triangle, enclosed from both sides.
#pragma once

#include "fitting/contact_element.hpp"
#include "fitting/slide_jacobian.hpp"

namespace palpate::fitting {

/// The largest norm of df/dx' over a triangle lies between `reached`, that of one state, and
/// `bound`, N/m. Both are infinite where a state has an unbounded slide.
struct SteepestSlide {
  double reached = 0;
  double bound = 0;
  SlideCauses causes{};  ///< of the state that was reached
};

/// Sets of states are halved where their bound is the largest, until it is within a twentieth of
/// what is reached or of `enough`, or until so much was spent that more gains little: the bound
/// holds at every stage, an infinite one says only that none was found.
/// Deterministic. @pre element.friction > 0
SteepestSlide steepest_slide(const ContactElement& element, double enough);

}  // namespace palpate::fitting
