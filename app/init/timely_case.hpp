// SPDX-License-Identifier: AGPL-3.0-or-later
// A first case whose campaign ends within a given time.
#pragma once

#include <optional>

#include "app/init/counted_case.hpp"
#include "app/init/first_case.hpp"

namespace palpate::app {

struct FirstWishes {
  std::optional<int> sites;  ///< none: some 200, or as many fewer as the time asks for
  double minutes = 15;       ///< that the campaign may take; 0: any time, and nothing is tried
  int threads = 1;           ///< of the campaign

  static constexpr int kUsualSites = 200;
};

/// What makes a campaign shorter, the cheapest loss first.
enum class Saving {
  LargerPatches,  ///< fewer sites
  OneRefinement,  ///< the elements under the tool divided once: shallow forces some percent off
  NoRefinement,   ///< tens of percent off, where the contact is no larger than the elements
  SmallerDepth,   ///< what is deeper is unknown
  None
};

/// The next saving that the sizes leave.
/// @param may_enlarge whether the number of sites is left open and larger patches save time
/// @param may_refine_less whether less refinement saves time
Saving cheapest_saving(const FirstSizes& sizes, bool may_enlarge, bool may_refine_less);

/// The case with about as many sites as wanted. A few of them are pressed to tell how long all take
/// (press_trial_sites). Where that is longer than wanted, the cheapest loss comes first
/// (`cheapest_saving`), a few times, until it fits or none is left.
/// Remarks and comments say what was chosen and why.
/// @throws Error(Configuration) where the case itself would be refused
FirstCase timely_case(const CaseOf& made, const FirstWishes& wishes);

}  // namespace palpate::app
