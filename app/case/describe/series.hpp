// SPDX-License-Identifier: AGPL-3.0-or-later
// Keys of a Prony series.
#pragma once

#include <string_view>

#include "app/case/describe/key.hpp"
#include "format/relaxation.hpp"

namespace palpate::app {

/// `about`: of the key `fraction`.
template <class V>
void describe_series(V& v, RelaxationSeries& series, const Key& key, std::string_view about) {
  v.tables(series, key, [about](auto& in, RelaxationBranch& branch) {
    in.number(
        branch.fraction,
        {"fraction", about, kRequired, {.low = 0, .high = 1, .low_open = true, .high_open = true}});
    in.quantity(branch.time_s, Dimension::Time,
                {"time", "time in which that part falls to 1/e", kRequired, kPositive});
  });
}

}  // namespace palpate::app
