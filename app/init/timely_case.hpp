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

/// The case with about as many sites as wanted. A few of them are pressed to tell how long all take
/// (press_trial_sites). Where that is longer than wanted, sites are pressed less deep if thin parts
/// take most of the time, and patches are larger if the number of sites was left open; a few
/// times, until it fits or neither helps. At the end elements are not refined under the tool.
/// Remarks and comments say what was chosen and why.
/// @throws Error(Configuration) where the case itself would be refused
FirstCase timely_case(const CaseOf& made, const FirstWishes& wishes);

}  // namespace palpate::app
