// SPDX-License-Identifier: AGPL-3.0-or-later
// The steepest slide over a triangle, enclosed from both sides.
#pragma once

#include <queue>
#include <utility>

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/slide_jacobian.hpp"

namespace palpate::fitting {

/// The largest norm of df/dx' over a triangle lies between `reached`, that of one state, and
/// `bound`: sets of states are halved where their bound is the largest. The bound holds at every
/// stage; an infinite one says only that none was found yet, unless a state without a bound was
/// reached. Deterministic.
class SlideSearch {
 public:
  /// @pre element.friction > 0
  explicit SlideSearch(ContactElement element);
  SlideSearch(const SlideSearch&) = delete;
  SlideSearch& operator=(const SlideSearch&) = delete;

  /// Halves sets until the bound is no larger than what is near enough to `enough` or to what is
  /// reached, or `halvings` are spent.
  void advance(int halvings, double enough);

  double bound() const { return parts_.top().bound; }    ///< N/m
  double reached() const { return reached_; }            ///< N/m
  const SlideCauses& causes() const { return causes_; }  ///< of the state that was reached
  int spent() const { return spent_; }                   ///< halvings

  static constexpr double kNearEnough = 1.1;

 private:
  struct Part {
    SlideCell cell;
    double bound = 0;
    int halvings = 0;
    bool operator<(const Part& other) const { return bound < other.bound; }
  };

  std::pair<SlideCell, SlideCell> halves(const Part& part) const;
  void reach_in(const SlideCell& cell);

  ContactElement element_;
  SlideJacobian jacobian_;  // of element_
  std::priority_queue<Part> parts_;
  double reached_ = 0;
  SlideCauses causes_;
  int spent_ = 0;
};

}  // namespace palpate::fitting
