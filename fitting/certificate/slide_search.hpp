// SPDX-License-Identifier: AGPL-3.0-or-later
// Upper and lower bound of the force gradient of the slides over a triangle.
#pragma once

#include <queue>
#include <utility>

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/slide_jacobian.hpp"

namespace palpate::fitting {

/// Branch and bound for the largest norm of df/dx' over a triangle. It lies between `attained`, the
/// norm at one state, and `bound`: the set of states with the largest bound is halved in each step.
/// The bound is valid at every stage. While it is infinite, no bound has been found yet, unless a
/// state without a bound was evaluated. Deterministic.
class SlideSearch {
 public:
  /// @pre element.friction > 0
  explicit SlideSearch(ContactElement element);
  SlideSearch(const SlideSearch&) = delete;
  SlideSearch& operator=(const SlideSearch&) = delete;

  /// Halves sets until the bound is at most kNearEnough max(attained, enough), or `halvings` are
  /// used up.
  void advance(int halvings, double enough);

  double bound() const { return parts_.top().bound; }    ///< N/m
  double attained() const { return attained_; }          ///< N/m
  const SlideCauses& causes() const { return causes_; }  ///< of the state of `attained`
  int spent() const { return spent_; }                   ///< number of halvings so far

  static constexpr double kNearEnough = 1.1;

 private:
  struct Part {
    SlideCell cell;
    double bound = 0;
    int halvings = 0;
    bool operator<(const Part& other) const { return bound < other.bound; }
  };

  std::pair<SlideCell, SlideCell> halves(const Part& part) const;
  void evaluate_middle(const SlideCell& cell);

  ContactElement element_;
  SlideJacobian jacobian_;  // of element_
  std::priority_queue<Part> parts_;
  double attained_ = 0;
  SlideCauses causes_;
  int spent_ = 0;
};

}  // namespace palpate::fitting
